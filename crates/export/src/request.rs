//! An export from beginning to end: what is asked for, what can be had, what was written.

use std::fs;
use std::path::PathBuf;

use catenix_results::{Status, StoredStudy};
use serde::Serialize;

use crate::contents::CaseContents;
use crate::meter::{ExportWatch, Meter};
use crate::netcdf::CaseDataset;
use crate::output::ExportedFile;
use crate::provenance::Provenance;
use crate::tables::{CaseTables, TableFormat};
use crate::vtk::CaseSeries;
use crate::{ExportError, Thinning, names};

/// File format of an export.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ExportFormat {
    /// Comma-separated values.
    Csv,
    /// Apache Parquet.
    Parquet,
    /// Series of VTK poly-data with a collection, for ParaView.
    Vtk,
    /// NetCDF, classic format with 64-bit offsets.
    Netcdf,
}

impl ExportFormat {
    /// All of them.
    pub const ALL: [ExportFormat; 4] = [
        ExportFormat::Csv,
        ExportFormat::Parquet,
        ExportFormat::Vtk,
        ExportFormat::Netcdf,
    ];

    /// The word on the command line.
    pub fn word(self) -> &'static str {
        match self {
            ExportFormat::Csv => "csv",
            ExportFormat::Parquet => "parquet",
            ExportFormat::Vtk => "vtk",
            ExportFormat::Netcdf => "netcdf",
        }
    }
}

/// What is asked for.
#[derive(Debug, Clone, PartialEq)]
pub struct ExportRequest {
    /// File format.
    pub format: ExportFormat,
    /// Where the files go; made where it does not exist.
    pub directory: PathBuf,
    /// Load cases; empty: all.
    pub cases: Vec<String>,
    /// Lines; empty: all. Vessels, bodies and channels are exported whatever the lines.
    pub lines: Vec<String>,
    /// Which of the stored rows.
    pub thinning: Thinning,
    /// Whether tables of every quantity at every node and time are written (CSV and Parquet).
    pub fields: bool,
    /// Whether files of an earlier export are replaced.
    pub force: bool,
}

/// What was written. The keys are a public interface, described in docs/cli.md.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Exported {
    /// Load cases that were exported, and how far each had come.
    pub cases: Vec<ExportedCase>,
    /// Files, in the order in which they were written.
    pub files: Vec<ExportedFile>,
    /// What the user should know: cases that were not complete, or had nothing yet.
    pub notes: Vec<String>,
}

/// A load case that was exported.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ExportedCase {
    /// Name.
    pub name: String,
    /// How far it had come.
    pub status: Status,
    /// Last exported time [s]; null without histories.
    pub end_time_s: Option<f64>,
}

/// The files of one load case in one format.
pub(crate) trait CaseExport {
    /// Files and folders that it will write, for a look whether they exist.
    fn targets(&self) -> Vec<PathBuf>;

    /// Values that it will write.
    fn values(&self) -> u64;

    /// Writes them.
    fn write(&self, meter: &Meter<'_>) -> Result<Vec<ExportedFile>, ExportError>;
}

/// Exports what there is of a study. A file gets its name when it is whole: after an error or an
/// interruption there is no half of one.
pub fn export(
    study: &StoredStudy,
    request: &ExportRequest,
    watch: &dyn ExportWatch,
) -> Result<Exported, ExportError> {
    names::check("load case", &request.cases, study.case_names())?;
    let asked = |name: &&String| request.cases.is_empty() || request.cases.contains(name);
    let mut contents = Vec::new();
    for name in study.case_names().iter().filter(asked) {
        let case = study.case(name)?;
        contents.push(CaseContents::read(case, &request.lines, &request.thinning)?);
    }
    check_lines(&contents, &request.lines)?;
    let notes = notes(&contents);
    if contents.iter().all(CaseContents::is_empty) {
        return Err(ExportError::Empty {
            path: study.path().to_path_buf(),
            what: notes.join("; "),
        });
    }
    contents.retain(|case| !case.is_empty());
    let exports = contents
        .iter()
        .map(|case| case_export(study, case, request))
        .collect::<Result<Vec<_>, _>>()?;
    prepare(&exports, request)?;
    let meter = Meter::new(watch, exports.iter().map(|export| export.values()).sum());
    let mut files = Vec::new();
    for export in &exports {
        files.extend(export.write(&meter)?);
    }
    let cases = contents.iter().map(|case| ExportedCase {
        name: case.name().to_owned(),
        status: case.status(),
        end_time_s: case.history_times_s.last().copied(),
    });
    Ok(Exported {
        cases: cases.collect(),
        files,
        notes,
    })
}

fn case_export<'a>(
    study: &StoredStudy,
    case: &'a CaseContents,
    request: &ExportRequest,
) -> Result<Box<dyn CaseExport + 'a>, ExportError> {
    let provenance = Provenance::new(study, case);
    let directory = &request.directory;
    let tables = |provenance, format| -> Result<Box<dyn CaseExport + 'a>, ExportError> {
        let tables = CaseTables::new(case, provenance, directory, format, request.fields)?;
        Ok(Box::new(tables))
    };
    match request.format {
        ExportFormat::Csv => tables(provenance, TableFormat::Csv),
        ExportFormat::Parquet => tables(provenance, TableFormat::Parquet),
        ExportFormat::Vtk => Ok(Box::new(CaseSeries::new(case, &provenance, directory))),
        ExportFormat::Netcdf => Ok(Box::new(CaseDataset::new(case, &provenance, directory)?)),
    }
}

/// Makes the directory, and makes sure that nothing is overwritten unasked.
fn prepare(
    exports: &[Box<dyn CaseExport + '_>],
    request: &ExportRequest,
) -> Result<(), ExportError> {
    let mut targets = exports.iter().flat_map(|export| export.targets());
    if !request.force
        && let Some(path) = targets.find(|path| path.exists())
    {
        return Err(ExportError::Exists { path });
    }
    fs::create_dir_all(&request.directory)
        .map_err(|source| ExportError::write(&request.directory, source))
}

/// A line must be in one of the cases at least.
fn check_lines(contents: &[CaseContents], lines: &[String]) -> Result<(), ExportError> {
    let mut available: Vec<String> = Vec::new();
    for name in contents.iter().flat_map(|case| &case.line_names) {
        if !available.contains(name) {
            available.push(name.clone());
        }
    }
    // A study of which nothing is stored yet has no lines to compare with.
    if available.is_empty() {
        return Ok(());
    }
    names::check("line", lines, &available)
}

fn notes(contents: &[CaseContents]) -> Vec<String> {
    let mut notes = Vec::new();
    for case in contents {
        let name = case.name();
        let until = match case.history_times_s.last() {
            Some(time) => format!("its rows end at {time} s"),
            None => "it has no history".to_owned(),
        };
        match case.status() {
            Status::Complete => {}
            _ if case.is_empty() => {
                let word = case.status().word();
                notes.push(format!(
                    "load case `{name}` is {word} and has no results yet"
                ));
            }
            Status::Pending | Status::Running => notes.push(format!(
                "load case `{name}` is still running, or its process was killed: {until}"
            )),
            Status::Interrupted => {
                notes.push(format!("load case `{name}` was interrupted: {until}"));
            }
            Status::Failed => {
                notes.push(format!("the solver gave up in load case `{name}`: {until}"))
            }
        }
    }
    notes
}
