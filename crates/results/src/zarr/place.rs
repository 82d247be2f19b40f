//! Where a node of the store lies: in a folder, in the archive of a case that has ended, or in the
//! memory of the run that makes it.

use std::collections::BTreeMap;
use std::fs;
use std::io::{BufWriter, ErrorKind};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::archive::{Archive, ArchiveWriter};
use super::node::write_atomically;
use crate::StoreError;

/// Most bytes that wait in memory for the next flush.
const MOST_WAITING: usize = 1 << 26;

/// Buffer of an archive that is written [bytes].
const BUFFER: usize = 1 << 20;

/// A node of the store: a group or an array, as a folder has it or would have it.
#[derive(Debug, Clone)]
pub(crate) struct Place {
    root: Root,
    /// Way from the root, with forward slashes; empty at the root.
    inside: String,
}

#[derive(Debug, Clone)]
enum Root {
    Folder(PathBuf),
    Archive(Arc<Archive>),
    Staged(Arc<Staged>),
}

/// A tree of files that is being made: in memory until the first flush, from then on in a folder
/// too, in the end in an archive.
#[derive(Debug)]
struct Staged {
    folder: PathBuf,
    files: Mutex<Files>,
}

#[derive(Debug, Default)]
struct Files {
    /// By name: the content, or `None` where it is in the folder.
    content: BTreeMap<String, Option<Vec<u8>>>,
    /// Bytes that are in memory only.
    waiting: usize,
}

impl Place {
    /// A node in a folder.
    pub(crate) fn folder(path: PathBuf) -> Place {
        Place {
            root: Root::Folder(path),
            inside: String::new(),
        }
    }

    /// A tree that stands in `folder` while it grows and beside it, in one archive, when it is
    /// whole.
    pub(crate) fn staged(folder: PathBuf) -> Place {
        let files = Mutex::default();
        Place {
            root: Root::Staged(Arc::new(Staged { folder, files })),
            inside: String::new(),
        }
    }

    /// The tree of `folder`, out of the archive beside it where there is one.
    pub(crate) fn stored(folder: PathBuf) -> Result<Place, StoreError> {
        let root = match Archive::open(&archive_path(&folder))? {
            Some(archive) => Root::Archive(Arc::new(archive)),
            None => Root::Folder(folder),
        };
        Ok(Place {
            root,
            inside: String::new(),
        })
    }

    /// A node or file below this one.
    pub(crate) fn join(&self, name: &str) -> Place {
        let root = self.root.clone();
        let inside = match (self.inside.is_empty(), name.is_empty()) {
            (true, _) => name.to_owned(),
            (_, true) => self.inside.clone(),
            _ => format!("{}/{name}", self.inside),
        };
        Place { root, inside }
    }

    /// What to call it in messages; the path of the folder where it is one.
    pub(crate) fn path(&self) -> PathBuf {
        let root = match &self.root {
            Root::Folder(path) => path,
            Root::Archive(archive) => archive.path(),
            Root::Staged(staged) => &staged.folder,
        };
        if self.inside.is_empty() {
            root.to_path_buf()
        } else {
            root.join(&self.inside)
        }
    }

    /// Way from the root of the tree, with forward slashes.
    pub(crate) fn inside(&self) -> &str {
        &self.inside
    }

    /// Whether this is a file.
    pub(crate) fn is_file(&self) -> bool {
        match &self.root {
            Root::Folder(_) => self.path().is_file(),
            Root::Archive(archive) => archive.has(&self.inside),
            Root::Staged(staged) => staged.lock().content.contains_key(&self.inside),
        }
    }

    /// Whether there is a group or an array.
    pub(crate) fn is_node(&self) -> bool {
        self.join("zarr.json").is_file()
    }

    /// Content of this file; `None` where there is no such file.
    pub(crate) fn read(&self) -> Result<Option<Vec<u8>>, StoreError> {
        match &self.root {
            Root::Folder(_) => read_file(&self.path()),
            Root::Archive(archive) => archive.read(&self.inside),
            Root::Staged(staged) => {
                let files = staged.lock();
                match files.content.get(&self.inside) {
                    None => Ok(None),
                    Some(Some(content)) => Ok(Some(content.clone())),
                    Some(None) => read_file(&staged.folder.join(&self.inside)),
                }
            }
        }
    }

    /// Writes this file, in one step.
    pub(crate) fn write(&self, content: Vec<u8>) -> Result<(), StoreError> {
        match &self.root {
            Root::Staged(staged) => {
                let mut files = staged.lock();
                files.waiting += content.len();
                let old = files.content.insert(self.inside.clone(), Some(content));
                files.waiting -= old.flatten().map_or(0, |content| content.len());
                Ok(())
            }
            Root::Folder(_) | Root::Archive(_) => write_file(&self.path(), &content),
        }
    }

    /// Nodes right below this one.
    pub(crate) fn children(&self) -> Result<Vec<Place>, StoreError> {
        let mut names = Vec::new();
        match &self.root {
            Root::Folder(_) => {
                let path = self.path();
                let entries = match fs::read_dir(&path) {
                    Err(error) if error.kind() == ErrorKind::NotFound => return Ok(Vec::new()),
                    other => other.map_err(|source| StoreError::read(&path, source))?,
                };
                let entries = entries.flatten().map(|entry| entry.file_name());
                names.extend(entries.map(|name| name.to_string_lossy().into_owned()));
            }
            Root::Archive(archive) => {
                let prefix = prefix_of(&self.inside);
                names_below(&prefix, archive.names_from(&prefix), &mut names);
            }
            Root::Staged(staged) => {
                let (prefix, files) = (prefix_of(&self.inside), staged.lock());
                let range = files.content.range(prefix.clone()..);
                names_below(&prefix, range.map(|(name, _)| name.as_str()), &mut names);
            }
        }
        let children = names.iter().map(|name| self.join(name));
        Ok(children.filter(Place::is_node).collect())
    }

    /// Whether so much waits in memory that it should be flushed.
    pub(crate) fn is_full(&self) -> bool {
        match &self.root {
            Root::Staged(staged) => staged.lock().waiting > MOST_WAITING,
            Root::Folder(_) | Root::Archive(_) => false,
        }
    }

    /// Brings the folder of a staged tree up to date; the metadata of its root, which counts what
    /// there is, comes last.
    pub(crate) fn flush(&self) -> Result<(), StoreError> {
        let Root::Staged(staged) = &self.root else {
            return Ok(());
        };
        let mut files = staged.lock();
        let mut last = None;
        for (name, content) in &mut files.content {
            if name == "zarr.json" {
                last = content.take();
            } else if let Some(content) = content.take() {
                write_file(&staged.folder.join(name), &content)?;
            }
        }
        files.waiting = 0;
        match last {
            Some(content) => write_file(&staged.folder.join("zarr.json"), &content),
            None => Ok(()),
        }
    }

    /// Packs a staged tree, in one step, into the archive beside its folder, which is removed.
    pub(crate) fn pack(&self) -> Result<(), StoreError> {
        let Root::Staged(staged) = &self.root else {
            return Ok(());
        };
        let path = archive_path(&staged.folder);
        let partial = path.with_added_extension("partial");
        let failed = |source| StoreError::write(&path, source);
        let file = fs::File::create(&partial).map_err(failed)?;
        let mut writer = ArchiveWriter::new(BufWriter::with_capacity(BUFFER, file));
        for (name, content) in &staged.lock().content {
            match content {
                Some(content) => writer.add(name, content).map_err(failed)?,
                None => {
                    let own = staged.folder.join(name);
                    let content = fs::read(&own).map_err(|error| StoreError::read(&own, error))?;
                    writer.add(name, &content).map_err(failed)?;
                }
            }
        }
        let out = writer.finish().map_err(failed)?;
        drop(out.into_inner().map_err(|error| failed(error.into()))?);
        fs::rename(&partial, &path).map_err(failed)?;
        match fs::remove_dir_all(&staged.folder) {
            Err(error) if error.kind() != ErrorKind::NotFound => {
                Err(StoreError::write(&staged.folder, error))
            }
            _ => Ok(()),
        }
    }
}

impl Staged {
    fn lock(&self) -> MutexGuard<'_, Files> {
        self.files.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The archive that takes the place of a folder.
pub(crate) fn archive_path(folder: &Path) -> PathBuf {
    folder.with_added_extension("zip")
}

/// What the names of all files below a node begin with.
fn prefix_of(inside: &str) -> String {
    if inside.is_empty() {
        String::new()
    } else {
        format!("{inside}/")
    }
}

/// Names of the folders right below a prefix, once each.
fn names_below<'a>(prefix: &str, files: impl Iterator<Item = &'a str>, names: &mut Vec<String>) {
    for rest in files.map_while(|file| file.strip_prefix(prefix)) {
        if let Some((name, _)) = rest.split_once('/')
            && names.last().is_none_or(|last| last != name)
        {
            names.push(name.to_owned());
        }
    }
}

fn read_file(path: &Path) -> Result<Option<Vec<u8>>, StoreError> {
    match fs::read(path) {
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
        other => other
            .map(Some)
            .map_err(|source| StoreError::read(path, source)),
    }
}

fn write_file(path: &Path, content: &[u8]) -> Result<(), StoreError> {
    if let Some(parent) = path.parent().filter(|parent| !parent.is_dir()) {
        fs::create_dir_all(parent).map_err(|source| StoreError::write(parent, source))?;
    }
    write_atomically(path, content)
}
