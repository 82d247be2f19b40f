//! A load case as one NetCDF file.

mod classic;
mod dataset;

use std::path::{Path, PathBuf};

use catenix_results::path_component;

use self::dataset::Dataset;
use crate::ExportError;
use crate::contents::CaseContents;
use crate::meter::Meter;
use crate::output::{ExportedFile, PartialFile};
use crate::provenance::Provenance;
use crate::request::CaseExport;

/// The file of one load case.
pub(crate) struct CaseDataset {
    case: String,
    path: PathBuf,
    dataset: Dataset,
}

impl CaseDataset {
    /// Looks at the case, and refuses what would not fit the format.
    pub(crate) fn new(
        contents: &CaseContents,
        provenance: &Provenance,
        directory: &Path,
    ) -> Result<Self, ExportError> {
        let case = contents.name().to_owned();
        let path = directory.join(format!("{}.nc", path_component(&case)));
        let dataset = Dataset::open(contents, provenance)?;
        match dataset.too_large() {
            Some(what) => Err(ExportError::TooLarge { path, what }),
            None => Ok(CaseDataset {
                case,
                path,
                dataset,
            }),
        }
    }
}

impl CaseExport for CaseDataset {
    fn targets(&self) -> Vec<PathBuf> {
        vec![self.path.clone()]
    }

    fn values(&self) -> u64 {
        self.dataset.values()
    }

    fn write(&self, meter: &Meter<'_>) -> Result<Vec<ExportedFile>, ExportError> {
        let mut file = PartialFile::create(self.path.clone())?;
        self.dataset.write(&mut file, meter)?;
        Ok(vec![ExportedFile {
            path: self.path.clone(),
            case: Some(self.case.clone()),
            content: "dataset",
            rows: self.dataset.records(),
            columns: self.dataset.variables(),
            files: 1,
            bytes: file.commit()?,
        }])
    }
}
