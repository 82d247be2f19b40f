//! What can go wrong between the results and the disk.

use std::io;
use std::path::{Path, PathBuf};

/// An error of the result store.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StoreError {
    /// A file or directory could not be written.
    #[error("cannot write {path}: {source}")]
    Write {
        /// The file or directory.
        path: PathBuf,
        /// What the operating system says.
        source: io::Error,
    },
    /// A file or directory could not be read.
    #[error("cannot read {path}: {source}")]
    Read {
        /// The file or directory.
        path: PathBuf,
        /// What the operating system says.
        source: io::Error,
    },
    /// The output directory holds something that is not a result, so it is not replaced.
    #[error(
        "{path} exists and holds no Catenix results, so it is left alone; \
         choose another output directory or remove it yourself"
    )]
    NotOurs {
        /// The output directory.
        path: PathBuf,
    },
    /// There is no result store at the path.
    #[error(
        "there is no Catenix result store at {path}; \
         give a directory that `catenix run` wrote, or the results.zarr inside it"
    )]
    NoStore {
        /// The path that was given.
        path: PathBuf,
    },
    /// The store's metadata or data cannot be what was written.
    #[error("the result store is damaged: {path}: {what}; run the model again")]
    Damaged {
        /// The group, array or chunk.
        path: PathBuf,
        /// What is wrong with it.
        what: String,
    },
    /// The store was written by a later version of Catenix.
    #[error(
        "{path} has store format {found}, and this version reads up to {supported}; \
         it was written by Catenix {written_by}: use that version or a later one"
    )]
    Newer {
        /// The store.
        path: PathBuf,
        /// Format number in the store.
        found: u64,
        /// Highest format number that this version reads.
        supported: u64,
        /// Version of Catenix that wrote the store.
        written_by: String,
    },
    /// The store has no load case of that name.
    #[error("the store has no load case `{name}`; it has {available}")]
    UnknownCase {
        /// The name that was asked for.
        name: String,
        /// The names that there are, joined.
        available: String,
    },
    /// The case has no channel of that name.
    #[error("load case `{case}` has no channel `{name}`{}", suggestion(.similar))]
    UnknownChannel {
        /// Load case.
        case: String,
        /// The name that was asked for.
        name: String,
        /// The nearest name that there is.
        similar: Option<String>,
    },
    /// The case has no line of that name, or the line lacks the quantity.
    #[error("load case `{case}` has no {quantity} along a line `{line}`")]
    UnknownLineResult {
        /// Load case.
        case: String,
        /// Line.
        line: String,
        /// Quantity or range graph.
        quantity: String,
    },
}

impl StoreError {
    pub(crate) fn write(path: &Path, source: io::Error) -> Self {
        StoreError::Write {
            path: path.to_path_buf(),
            source,
        }
    }

    pub(crate) fn read(path: &Path, source: io::Error) -> Self {
        StoreError::Read {
            path: path.to_path_buf(),
            source,
        }
    }

    /// Stable identifier for scripts, of the form `results::kind`.
    pub fn code(&self) -> &'static str {
        match self {
            StoreError::Write { .. } => "results::write",
            StoreError::Read { .. } => "results::read",
            StoreError::NotOurs { .. } => "results::not_ours",
            StoreError::NoStore { .. } => "results::no_store",
            StoreError::Damaged { .. } => "results::damaged",
            StoreError::Newer { .. } => "results::newer",
            StoreError::UnknownCase { .. } => "results::unknown_case",
            StoreError::UnknownChannel { .. } => "results::unknown_channel",
            StoreError::UnknownLineResult { .. } => "results::unknown_line_result",
        }
    }
}

fn suggestion(similar: &Option<String>) -> String {
    similar
        .as_ref()
        .map(|name| format!("; did you mean `{name}`?"))
        .unwrap_or_default()
}
