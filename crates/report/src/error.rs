//! What can go wrong between the results and the page.

use std::io;
use std::path::PathBuf;

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
    #[error("cannot fill in the template `{template}`: {what}")]
    Template {
        /// Name of the template.
        template: String,
        /// What the template engine says.
        what: String,
    },
}

impl ReportError {
    /// Stable identifier for scripts, of the form `report::kind`.
    pub fn code(&self) -> &'static str {
        match self {
            ReportError::Write { .. } => "report::write",
            ReportError::Figure { .. } => "report::figure",
            ReportError::Template { .. } => "report::template",
        }
    }
}
