//! Groups, attributes, and the atomic write under every file of the store.

use std::fs;
use std::io::{ErrorKind, Write};
use std::path::Path;

use serde_json::{Map, Value, json};

use super::Place;
use crate::StoreError;

/// Attributes of a group or array. Only numbers and strings are used, so that xarray can copy them
/// into every format it knows.
pub(crate) type Attributes = Map<String, Value>;

/// A group: a node with attributes and no values.
#[derive(Debug, Clone)]
pub(crate) struct Group {
    place: Place,
}

impl Group {
    /// Writes its metadata, replacing earlier attributes.
    pub(crate) fn create(place: Place, attributes: &Attributes) -> Result<Self, StoreError> {
        let group = Group { place };
        group.set_attributes(attributes)?;
        Ok(group)
    }

    /// A group that is expected to exist.
    pub(crate) fn at(place: Place) -> Self {
        Group { place }
    }

    /// Where the group lies.
    pub(crate) fn place(&self) -> &Place {
        &self.place
    }

    /// Replaces the attributes in one step.
    pub(crate) fn set_attributes(&self, attributes: &Attributes) -> Result<(), StoreError> {
        write_metadata(
            &self.place,
            &json!({ "zarr_format": 3, "node_type": "group", "attributes": attributes }),
        )
    }

    /// Reads the attributes.
    pub(crate) fn attributes(&self) -> Result<Attributes, StoreError> {
        let mut metadata = read_metadata(&self.place, "group")?;
        match metadata.remove("attributes") {
            Some(Value::Object(attributes)) => Ok(attributes),
            None => Ok(Attributes::new()),
            Some(_) => Err(damaged(
                &self.place.path(),
                "its attributes are not a JSON object",
            )),
        }
    }
}

/// Reads `zarr.json` of a node of the given type.
pub(crate) fn read_metadata(place: &Place, node_type: &str) -> Result<Attributes, StoreError> {
    let file = place.join("zarr.json");
    let missing = || StoreError::read(&file.path(), ErrorKind::NotFound.into());
    let text = file.read()?.ok_or_else(missing)?;
    let Ok(Value::Object(metadata)) = serde_json::from_slice(&text) else {
        return Err(damaged(&place.path(), "its zarr.json is not a JSON object"));
    };
    if metadata.get("node_type").and_then(Value::as_str) != Some(node_type) {
        return Err(damaged(
            &place.path(),
            &format!("its zarr.json does not describe a Zarr {node_type}"),
        ));
    }
    Ok(metadata)
}

/// Writes `zarr.json` of a node.
pub(crate) fn write_metadata(place: &Place, metadata: &Value) -> Result<(), StoreError> {
    place
        .join("zarr.json")
        .write(metadata.to_string().into_bytes())
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
