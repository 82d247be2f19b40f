//! Files and folders that get their final name when they are whole.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use serde::Serialize;

use crate::ExportError;

/// What was written. The keys are a public interface, described in docs/cli.md.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ExportedFile {
    /// Path; of a series the file that lists it.
    pub path: PathBuf,
    /// Load case; null where the file is about all of them.
    pub case: Option<String>,
    /// `histories`, `fields`, `range_graphs`, `static_shape`, `modes`, `mode_shapes`, `series`,
    /// `dataset` or `description`.
    pub content: &'static str,
    /// Rows of a table, times of a series or dataset.
    pub rows: usize,
    /// Columns of a table, arrays of a series, variables of a dataset.
    pub columns: usize,
    /// Number of files; more than one for a series.
    pub files: usize,
    /// Bytes of all its files.
    pub bytes: u64,
}

/// A path beside the final one, on the same disk.
fn partial(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_os_string();
    name.push(".partial");
    path.with_file_name(name)
}

/// A file beside its final name. Dropped before [`commit`](Self::commit), it vanishes.
#[derive(Debug)]
pub(crate) struct PartialFile {
    path: PathBuf,
    partial: PathBuf,
    file: Option<Counted>,
}

/// Counts what passes.
#[derive(Debug)]
struct Counted {
    writer: BufWriter<File>,
    bytes: u64,
}

impl PartialFile {
    /// Begins the file that will be at `path`.
    pub(crate) fn create(path: PathBuf) -> Result<Self, ExportError> {
        let partial = partial(&path);
        let file = File::create(&partial).map_err(|source| ExportError::write(&path, source))?;
        Ok(PartialFile {
            path,
            partial,
            file: Some(Counted {
                writer: BufWriter::with_capacity(1 << 18, file),
                bytes: 0,
            }),
        })
    }

    /// The final path.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// The error for a write that failed.
    pub(crate) fn failed(&self, source: io::Error) -> ExportError {
        ExportError::write(&self.path, source)
    }

    /// Writes bytes.
    pub(crate) fn put(&mut self, bytes: &[u8]) -> Result<(), ExportError> {
        self.write_all(bytes).map_err(|error| self.failed(error))
    }

    /// Gives the file its final name, in place of an earlier one; returns its size.
    pub(crate) fn commit(mut self) -> Result<u64, ExportError> {
        let Some(Counted { mut writer, bytes }) = self.file.take() else {
            return Ok(0);
        };
        let written = writer.flush();
        // A file that is open cannot be renamed everywhere.
        drop(writer);
        let committed = written.and_then(|()| fs::rename(&self.partial, &self.path));
        committed.map_err(|source| {
            let _ = fs::remove_file(&self.partial);
            self.failed(source)
        })?;
        Ok(bytes)
    }
}

impl Write for PartialFile {
    fn write(&mut self, buffer: &[u8]) -> io::Result<usize> {
        let Some(file) = &mut self.file else {
            return Err(io::Error::other("the file is finished"));
        };
        let written = file.writer.write(buffer)?;
        file.bytes += written as u64;
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file
            .as_mut()
            .map_or(Ok(()), |file| file.writer.flush())
    }
}

impl Drop for PartialFile {
    fn drop(&mut self) {
        if let Some(file) = self.file.take() {
            // What is still in the buffer is not worth writing.
            drop(file.writer.into_parts());
            let _ = fs::remove_file(&self.partial);
        }
    }
}

/// A folder beside its final name. Dropped before [`commit`](Self::commit), it vanishes.
#[derive(Debug)]
pub(crate) struct PartialFolder {
    path: PathBuf,
    partial: PathBuf,
    committed: bool,
}

impl PartialFolder {
    /// Begins the folder that will be at `path`.
    pub(crate) fn create(path: PathBuf) -> Result<Self, ExportError> {
        let partial = partial(&path);
        let failed = |source| ExportError::write(&path, source);
        remove(&partial).map_err(failed)?;
        fs::create_dir_all(&partial).map_err(failed)?;
        Ok(PartialFolder {
            path,
            partial,
            committed: false,
        })
    }

    /// Writes one file in it.
    pub(crate) fn put(&self, name: &str, bytes: &[u8]) -> Result<(), ExportError> {
        fs::write(self.partial.join(name), bytes)
            .map_err(|source| ExportError::write(&self.path.join(name), source))
    }

    /// Gives the folder its final name, in place of an earlier one.
    pub(crate) fn commit(mut self) -> Result<(), ExportError> {
        let moved = remove(&self.path).and_then(|()| fs::rename(&self.partial, &self.path));
        moved.map_err(|source| ExportError::write(&self.path, source))?;
        self.committed = true;
        Ok(())
    }
}

impl Drop for PartialFolder {
    fn drop(&mut self) {
        if !self.committed {
            let _ = fs::remove_dir_all(&self.partial);
        }
    }
}

fn remove(path: &Path) -> io::Result<()> {
    let removed = if path.is_dir() {
        fs::remove_dir_all(path)
    } else {
        fs::remove_file(path)
    };
    match removed {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        other => other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_has_its_name_only_when_it_is_whole() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a.csv");
        let entries = || fs::read_dir(dir.path()).unwrap().count();
        let mut file = PartialFile::create(path.clone()).unwrap();
        file.put(b"half").unwrap();
        assert!(!path.exists());
        drop(file);
        assert_eq!(entries(), 0, "what was not finished is gone");
        let mut file = PartialFile::create(path.clone()).unwrap();
        file.put(b"whole").unwrap();
        assert_eq!(file.commit().unwrap(), 5);
        assert_eq!(fs::read(&path).unwrap(), b"whole");
        assert_eq!(entries(), 1);
    }

    #[test]
    fn a_folder_replaces_the_one_before_as_a_whole() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a_vtk");
        for name in ["old.vtp", "new.vtp"] {
            let folder = PartialFolder::create(path.clone()).unwrap();
            folder.put(name, b"x").unwrap();
            folder.commit().unwrap();
        }
        assert!(path.join("new.vtp").is_file() && !path.join("old.vtp").exists());
        let folder = PartialFolder::create(path.clone()).unwrap();
        folder.put("half.vtp", b"x").unwrap();
        drop(folder);
        assert!(path.join("new.vtp").is_file());
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_directory_that_is_not_there_is_named() {
        let error = PartialFile::create(PathBuf::from("/nowhere/a.csv")).expect_err("no folder");
        assert!(error.to_string().starts_with("cannot write /nowhere/a.csv"));
    }
}
