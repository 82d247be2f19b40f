//! Groups, attributes, and the atomic write under every file of the store.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use serde_json::{Map, Value, json};

use crate::StoreError;

/// Attributes of a group or array. Only numbers and strings are used, so that xarray can copy them
/// into every format it knows.
pub(crate) type Attributes = Map<String, Value>;

/// A group: a directory with a `zarr.json`.
#[derive(Debug, Clone)]
pub(crate) struct Group {
    path: PathBuf,
}

impl Group {
    /// Makes the directory and writes its metadata, replacing earlier attributes.
    pub(crate) fn create(path: PathBuf, attributes: &Attributes) -> Result<Self, StoreError> {
        fs::create_dir_all(&path).map_err(|source| StoreError::write(&path, source))?;
        let group = Group { path };
        group.set_attributes(attributes)?;
        Ok(group)
    }

    /// A group that is expected to exist.
    pub(crate) fn at(path: PathBuf) -> Self {
        Group { path }
    }

    /// Directory of the group.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Replaces the attributes in one step.
    pub(crate) fn set_attributes(&self, attributes: &Attributes) -> Result<(), StoreError> {
        write_metadata(
            &self.path,
            &json!({ "zarr_format": 3, "node_type": "group", "attributes": attributes }),
        )
    }

    /// Reads the attributes.
    pub(crate) fn attributes(&self) -> Result<Attributes, StoreError> {
        let mut metadata = read_metadata(&self.path, "group")?;
        match metadata.remove("attributes") {
            Some(Value::Object(attributes)) => Ok(attributes),
            None => Ok(Attributes::new()),
            Some(_) => Err(damaged(&self.path, "its attributes are not a JSON object")),
        }
    }
}

/// Reads `zarr.json` of a node of the given type.
pub(crate) fn read_metadata(directory: &Path, node_type: &str) -> Result<Attributes, StoreError> {
    let path = directory.join("zarr.json");
    let text = fs::read(&path).map_err(|source| StoreError::read(&path, source))?;
    let Ok(Value::Object(metadata)) = serde_json::from_slice(&text) else {
        return Err(damaged(directory, "its zarr.json is not a JSON object"));
    };
    if metadata.get("node_type").and_then(Value::as_str) != Some(node_type) {
        return Err(damaged(
            directory,
            &format!("its zarr.json does not describe a Zarr {node_type}"),
        ));
    }
    Ok(metadata)
}

/// Writes `zarr.json` of a node.
pub(crate) fn write_metadata(directory: &Path, metadata: &Value) -> Result<(), StoreError> {
    write_atomically(
        &directory.join("zarr.json"),
        metadata.to_string().as_bytes(),
    )
}

/// Writes a file so that a reader, or a restart after a kill, finds the old content or the new one
/// and nothing in between: write a neighbour, then rename it over.
///
/// The content is not forced to the disk (fsync): it survives the death of the process at any
/// instant, not the loss of power.
pub(crate) fn write_atomically(path: &Path, content: &[u8]) -> Result<(), StoreError> {
    let mut name = path.file_name().unwrap_or_default().to_os_string();
    name.push(".partial");
    let partial = path.with_file_name(name);
    let write = || -> std::io::Result<()> {
        let mut file = fs::File::create(&partial)?;
        file.write_all(content)?;
        drop(file);
        fs::rename(&partial, path)
    };
    write().map_err(|source| StoreError::write(path, source))
}

/// The error for a node whose content makes no sense.
pub(crate) fn damaged(path: &Path, what: &str) -> StoreError {
    StoreError::Damaged {
        path: path.to_path_buf(),
        what: what.to_owned(),
    }
}
