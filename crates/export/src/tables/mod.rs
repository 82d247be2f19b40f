//! The tables of a load case, and the files that they become.

mod curves;
mod fields;
mod histories;
mod modes;

use std::path::{Path, PathBuf};

use catenix_results::path_component;

pub(crate) use self::curves::quantities;
use self::curves::{range_graphs, static_shape};
use self::fields::FieldTable;
use self::histories::HistoryTable;
use crate::contents::CaseContents;
use crate::meter::Meter;
use crate::output::{ExportedFile, PartialFile};
use crate::provenance::Provenance;
use crate::request::CaseExport;
use crate::table::Table;
use crate::{ExportError, csv, parquet};

/// File format of tables.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum TableFormat {
    Csv,
    Parquet,
}

/// The tables of one load case.
pub(crate) struct CaseTables {
    case: String,
    directory: PathBuf,
    format: TableFormat,
    provenance: Provenance,
    tables: Vec<Box<dyn Table>>,
}

impl CaseTables {
    /// The tables of a case: what there is of histories, range graphs, static shape and modes; the
    /// fields where they are asked for.
    pub(crate) fn new(
        contents: &CaseContents,
        provenance: Provenance,
        directory: &Path,
        format: TableFormat,
        with_fields: bool,
    ) -> Result<Self, ExportError> {
        let mut tables: Vec<Box<dyn Table>> = vec![Box::new(HistoryTable::open(contents)?)];
        if with_fields {
            tables.push(Box::new(FieldTable::open(contents)?));
        }
        tables.push(Box::new(range_graphs(contents)?));
        tables.push(Box::new(static_shape(contents)?));
        if let Some(modes) = contents.stored.modes()? {
            tables.push(Box::new(modes::modes(&modes)));
            tables.push(Box::new(modes::mode_shapes(&modes, &contents.lines)));
        }
        tables.retain(|table| table.rows() > 0);
        Ok(CaseTables {
            case: contents.name().to_owned(),
            directory: directory.to_path_buf(),
            format,
            provenance,
            tables,
        })
    }

    fn path(&self, what: &str, ending: &str) -> PathBuf {
        let case = path_component(&self.case);
        self.directory.join(format!("{case}_{what}.{ending}"))
    }

    fn table_path(&self, table: &dyn Table) -> PathBuf {
        let ending = match self.format {
            TableFormat::Csv => "csv",
            TableFormat::Parquet => "parquet",
        };
        self.path(table.content(), ending)
    }

    /// Of comma-separated values the description stands in a file beside them.
    fn description_path(&self) -> Option<PathBuf> {
        (self.format == TableFormat::Csv).then(|| self.path("columns", "json"))
    }
}

impl CaseExport for CaseTables {
    fn targets(&self) -> Vec<PathBuf> {
        let tables = self
            .tables
            .iter()
            .map(|table| self.table_path(table.as_ref()));
        tables.chain(self.description_path()).collect()
    }

    fn values(&self) -> u64 {
        let values = |table: &dyn Table| (table.rows() * table.columns().len()) as u64;
        self.tables.iter().map(|table| values(table.as_ref())).sum()
    }

    fn write(&self, meter: &Meter<'_>) -> Result<Vec<ExportedFile>, ExportError> {
        let mut written = Vec::new();
        for table in &self.tables {
            let table = table.as_ref();
            let path = self.table_path(table);
            let file = PartialFile::create(path.clone())?;
            let bytes = match self.format {
                TableFormat::Csv => csv::write(table, file, meter)?,
                TableFormat::Parquet => parquet::write(table, file, &self.provenance, meter)?,
            };
            written.push(ExportedFile {
                path,
                case: Some(self.case.clone()),
                content: table.content(),
                rows: table.rows(),
                columns: table.columns().len(),
                files: 1,
                bytes,
            });
        }
        if let Some(path) = self.description_path() {
            let tables = self.tables.iter().map(|table| {
                let path = self.table_path(table.as_ref());
                let name = path.file_name().unwrap_or_default().to_string_lossy();
                (name.into_owned(), table.columns())
            });
            let tables: Vec<_> = tables.collect();
            let mut file = PartialFile::create(path.clone())?;
            file.put(self.provenance.with_tables(&tables).as_bytes())?;
            written.push(ExportedFile {
                path,
                case: Some(self.case.clone()),
                content: "description",
                rows: 0,
                columns: 0,
                files: 1,
                bytes: file.commit()?,
            });
        }
        Ok(written)
    }
}

/// Cuts wanted rows into pieces that lie in one chunk each.
pub(crate) fn pieces(rows: &[usize], chunk_rows: usize) -> Vec<std::ops::Range<usize>> {
    let mut start = 0;
    rows.chunk_by(|a, b| a / chunk_rows == b / chunk_rows)
        .map(|part| {
            let piece = start..start + part.len();
            start = piece.end;
            piece
        })
        .collect()
}
