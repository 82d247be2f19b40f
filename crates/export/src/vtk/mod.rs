//! A load case as a series of VTK poly-data: the lines at every time, the vessels and bodies beside
//! them, and a collection that tells ParaView the times.

mod bodies;
mod collection;
mod lines;
mod poly_data;

use std::path::{Path, PathBuf};

use catenix_results::path_component;

use self::bodies::BodyPoints;
use self::collection::Collection;
use self::lines::LineSeries;
use crate::ExportError;
use crate::contents::CaseContents;
use crate::meter::Meter;
use crate::output::{ExportedFile, PartialFile, PartialFolder};
use crate::provenance::Provenance;
use crate::request::CaseExport;

/// The files of one load case.
pub(crate) struct CaseSeries<'a> {
    contents: &'a CaseContents,
    made_by: String,
    directory: PathBuf,
}

impl<'a> CaseSeries<'a> {
    pub(crate) fn new(
        contents: &'a CaseContents,
        provenance: &Provenance,
        directory: &Path,
    ) -> Self {
        CaseSeries {
            contents,
            made_by: provenance.made_by(),
            directory: directory.to_path_buf(),
        }
    }

    fn stem(&self) -> String {
        path_component(self.contents.name())
    }

    /// The file that is opened in ParaView.
    fn collection_path(&self) -> PathBuf {
        self.directory.join(format!("{}.pvd", self.stem()))
    }

    /// Folder of the poly-data, as named in the collection.
    fn folder_name(&self) -> String {
        format!("{}_vtk", self.stem())
    }
}

impl CaseExport for CaseSeries<'_> {
    fn targets(&self) -> Vec<PathBuf> {
        vec![
            self.collection_path(),
            self.directory.join(self.folder_name()),
        ]
    }

    fn values(&self) -> u64 {
        (self.contents.field_rows.len() * self.contents.field_values()) as u64
    }

    fn write(&self, meter: &Meter<'_>) -> Result<Vec<ExportedFile>, ExportError> {
        let times = self.contents.field_times_s.len();
        let folder = PartialFolder::create(self.directory.join(self.folder_name()))?;
        let mut collection = Collection::new(&self.folder_name());
        let mut bytes = 0;
        let lines = LineSeries::open(self.contents)?;
        let bodies = BodyPoints::read(self.contents)?;
        // Names of one length sort by time.
        let digits = times.saturating_sub(1).to_string().len();
        let mut index = 0;
        for piece in lines.pieces() {
            let block = lines.read(&piece)?;
            for within in 0..piece.len() {
                let time_s = self.contents.field_times_s[index];
                let name = format!("lines_{index:0digits$}.vtp");
                let data = lines
                    .poly_data(&block, within, time_s)
                    .to_bytes(&self.made_by);
                folder.put(&name, &data)?;
                collection.add(time_s, 0, "lines", &name);
                bytes += data.len() as u64;
                if !bodies.is_empty() {
                    let name = format!("bodies_{index:0digits$}.vtp");
                    let data = bodies.poly_data(index, time_s).to_bytes(&self.made_by);
                    folder.put(&name, &data)?;
                    collection.add(time_s, 1, "bodies", &name);
                    bytes += data.len() as u64;
                }
                index += 1;
                meter.add(&name, self.contents.field_values())?;
            }
        }
        let mut file = PartialFile::create(self.collection_path())?;
        file.put(collection.text(&self.made_by).as_bytes())?;
        folder.commit()?;
        bytes += file.commit()?;
        let parts = if bodies.is_empty() { 1 } else { 2 };
        Ok(vec![ExportedFile {
            path: self.collection_path(),
            case: Some(self.contents.name().to_owned()),
            content: "series",
            rows: times,
            columns: lines.arrays(),
            files: 1 + times * parts,
            bytes,
        }])
    }
}
