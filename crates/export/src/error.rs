//! What can go wrong between a store and the files made of it.

use std::io;
use std::path::{Path, PathBuf};

use catenix_results::StoreError;

/// An error of an export.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ExportError {
    /// The store could not be read.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// A file or directory could not be written.
    #[error("cannot write {path}: {source}{}", remedy(.source))]
    Write {
        /// The file or directory.
        path: PathBuf,
        /// What the operating system says.
        source: io::Error,
    },
    /// A file of an earlier export is in the way.
    #[error(
        "{path} exists, so nothing was exported; write --force to replace it, or choose another \
         directory with --out"
    )]
    Exists {
        /// The first file or directory that is in the way.
        path: PathBuf,
    },
    /// The store has no load case or line of that name.
    #[error("the store has no {what} `{name}`; {suggestion}")]
    UnknownName {
        /// `load case` or `line`.
        what: &'static str,
        /// The name that was asked for.
        name: String,
        /// The nearest names, or all of them.
        suggestion: String,
    },
    /// Nothing was stored yet.
    #[error(
        "there is nothing to export in {path}: {what}; run the model, or wait until its static \
         state is found"
    )]
    Empty {
        /// The store.
        path: PathBuf,
        /// Which cases were looked at, and how far they came.
        what: String,
    },
    /// The wanted times are outside of what was stored.
    #[error(
        "load case `{case}` has no stored row from {from_s} s to {to_s} s; its rows reach from \
         {first_s} s to {last_s} s"
    )]
    NoRows {
        /// Load case.
        case: String,
        /// Begin of the wanted stretch [s].
        from_s: f64,
        /// End of the wanted stretch [s].
        to_s: f64,
        /// First stored time [s].
        first_s: f64,
        /// Last stored time [s].
        last_s: f64,
    },
    /// The file format has no room for so much.
    #[error("{path} would not fit its format: {what}; thin it with --every, or write --to parquet")]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// What is too large, and for which limit.
        what: String,
    },
    /// The user stopped it.
    #[error("interrupted; files that were not finished are removed")]
    Interrupted,
}

impl ExportError {
    pub(crate) fn write(path: &Path, source: io::Error) -> Self {
        ExportError::Write {
            path: path.to_path_buf(),
            source,
        }
    }

    /// Stable identifier for scripts, of the form `export::kind`.
    pub fn code(&self) -> &'static str {
        match self {
            ExportError::Store(error) => error.code(),
            ExportError::Write { .. } => "export::write",
            ExportError::Exists { .. } => "export::exists",
            ExportError::UnknownName { .. } => "export::unknown_name",
            ExportError::Empty { .. } => "export::empty",
            ExportError::NoRows { .. } => "export::no_rows",
            ExportError::TooLarge { .. } => "export::too_large",
            ExportError::Interrupted => "export::interrupted",
        }
    }
}

fn remedy(source: &io::Error) -> &'static str {
    match source.kind() {
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => {
            "; free some space, thin with --every, or choose another disk with --out"
        }
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => {
            "; choose another directory with --out"
        }
        _ => "",
    }
}
