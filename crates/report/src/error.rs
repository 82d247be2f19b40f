//! What can go wrong between the results and the page.

use std::io;
use std::path::{Path, PathBuf};

use catenix_results::StoreError;

/// An error of a figure or a report.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReportError {
    /// A file or directory could not be written.
    #[error("cannot write {path}: {source}")]
    Write {
        /// The file or directory.
        path: PathBuf,
        /// What the operating system says.
        source: io::Error,
    },
    /// A figure could not be turned into pixels.
    #[error("cannot draw the figure `{name}`: {what}")]
    Figure {
        /// Title of the figure.
        name: String,
        /// What went wrong.
        what: String,
    },
    /// A page could not be made from its template.
    #[error("{}", template_text(.file, .line, .what))]
    Template {
        /// Its file, or its name where it is part of the program.
        file: PathBuf,
        /// Line in it, from 1; 0 where the file as a whole is meant.
        line: usize,
        /// What the template engine says.
        what: String,
    },
    /// The folder of templates replaces nothing.
    #[error(
        "no file in {path} has the name of a template, so nothing would change; the names are \
         {names}"
    )]
    NoTemplates {
        /// The folder.
        path: PathBuf,
        /// Names of the built-in templates, joined.
        names: String,
    },
    /// A file could not be read.
    #[error("cannot read {path}: {source}")]
    Read {
        /// The file or folder.
        path: PathBuf,
        /// What the operating system says.
        source: io::Error,
    },
    /// The folder that the report is to be in does not exist.
    #[error("there is no folder {path} to write the report into; make it first, or name another")]
    NoFolder {
        /// The folder.
        path: PathBuf,
    },
    /// A folder stands where the report is to be.
    #[error("{path} is a folder; give the name of a file, for example {}", example(.path))]
    IsFolder {
        /// The folder.
        path: PathBuf,
    },
    /// No load case has got results.
    #[error(
        "no load case in {path} has begun, so there is nothing to report; run it first: \
         catenix run {model_file}"
    )]
    Empty {
        /// The store.
        path: PathBuf,
        /// The model file that it was made for.
        model_file: String,
    },
    /// The results could not be read.
    #[error(transparent)]
    Store(#[from] StoreError),
}

impl ReportError {
    /// Stable identifier for scripts, of the form `report::kind`.
    pub fn code(&self) -> &'static str {
        match self {
            ReportError::Write { .. } => "report::write",
            ReportError::Figure { .. } => "report::figure",
            ReportError::Template { .. } | ReportError::NoTemplates { .. } => "report::template",
            ReportError::Read { .. } => "report::read",
            ReportError::NoFolder { .. } => "report::no_folder",
            ReportError::IsFolder { .. } => "report::is_folder",
            ReportError::Empty { .. } => "report::empty",
            ReportError::Store(error) => error.code(),
        }
    }
}

fn template_text(file: &Path, line: &usize, what: &str) -> String {
    match line {
        0 => format!("error in the template {}: {what}", file.display()),
        line => format!(
            "error in the template {}, line {line}: {what}",
            file.display()
        ),
    }
}

fn example(folder: &Path) -> String {
    folder.join("report.html").display().to_string()
}
