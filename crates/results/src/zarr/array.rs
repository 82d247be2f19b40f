//! Arrays of floats, chunked along their first axis.

use serde_json::{Value, json};

use super::Place;
use super::chunk::{self, ChunkFault};
use super::node::{self, Attributes, damaged};
use crate::StoreError;

/// Width of the stored floats.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum FloatKind {
    /// Single precision: fields, where seven digits are plenty and size matters.
    F32,
    /// Double precision: histories and range graphs.
    F64,
}

impl FloatKind {
    /// Bytes per value.
    pub(crate) fn size(self) -> usize {
        match self {
            FloatKind::F32 => 4,
            FloatKind::F64 => 8,
        }
    }

    /// Zarr's name of the type.
    pub(crate) fn name(self) -> &'static str {
        match self {
            FloatKind::F32 => "float32",
            FloatKind::F64 => "float64",
        }
    }
}

/// Shape of an array with one or two axes: rows, and values per row.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct ArrayShape {
    /// Length of the first axis.
    pub(crate) rows: usize,
    /// Length of the second axis; `None` for an array with one axis.
    pub(crate) columns: Option<usize>,
    /// Rows per chunk; a chunk always spans the whole second axis.
    pub(crate) chunk_rows: usize,
    /// Name of each axis.
    pub(crate) dimensions: Vec<String>,
}

impl ArrayShape {
    /// An array with one axis, in one chunk.
    pub(crate) fn vector(rows: usize, dimension: &str) -> Self {
        ArrayShape {
            rows,
            columns: None,
            chunk_rows: rows.max(1),
            dimensions: vec![dimension.to_owned()],
        }
    }

    /// Values per row.
    pub(crate) fn row_len(&self) -> usize {
        self.columns.unwrap_or(1)
    }
}

/// An array of the store.
#[derive(Debug, Clone)]
pub(crate) struct Array {
    place: Place,
    kind: FloatKind,
    shape: ArrayShape,
    attributes: Attributes,
}

impl Array {
    /// Writes the metadata; all values read as NaN until written.
    pub(crate) fn create(
        place: Place,
        kind: FloatKind,
        shape: ArrayShape,
        attributes: Attributes,
    ) -> Result<Self, StoreError> {
        let array = Array {
            place,
            kind,
            shape,
            attributes,
        };
        array.write_metadata()?;
        Ok(array)
    }

    /// Opens an array that this crate wrote; arrays of any other layout are refused.
    pub(crate) fn open(place: Place) -> Result<Self, StoreError> {
        let metadata = node::read_metadata(&place, "array")?;
        let parsed = parse_metadata(&metadata);
        let (kind, shape) = parsed.ok_or_else(|| {
            damaged(
                &place.path(),
                "its zarr.json is not in the layout that this version writes",
            )
        })?;
        let attributes = match metadata.get("attributes") {
            Some(Value::Object(attributes)) => attributes.clone(),
            _ => Attributes::new(),
        };
        Ok(Array {
            place,
            kind,
            shape,
            attributes,
        })
    }

    /// Shape and chunks.
    pub(crate) fn shape(&self) -> &ArrayShape {
        &self.shape
    }

    /// Width of the floats.
    pub(crate) fn kind(&self) -> FloatKind {
        self.kind
    }

    /// Attributes, `units` among them.
    pub(crate) fn attributes(&self) -> &Attributes {
        &self.attributes
    }

    /// Writes chunk `index` from its first row on; rows that are not given read as NaN.
    ///
    /// `values`: (rows x row length), at most one chunk.
    pub(crate) fn write_chunk(&self, index: usize, values: &[f64]) -> Result<(), StoreError> {
        let len = self.shape.chunk_rows * self.shape.row_len();
        self.chunk(index)
            .write(chunk::encode(values, len, self.kind))
    }

    /// Writes all values, cut into chunks.
    pub(crate) fn write_all(&self, values: &[f64]) -> Result<(), StoreError> {
        let len = self.shape.chunk_rows * self.shape.row_len();
        values
            .chunks(len.max(1))
            .enumerate()
            .try_for_each(|(i, chunk)| self.write_chunk(i, chunk))
    }

    /// Changes the number of rows.
    pub(crate) fn set_rows(&mut self, rows: usize) -> Result<(), StoreError> {
        if rows != self.shape.rows {
            self.shape.rows = rows;
            self.write_metadata()?;
        }
        Ok(())
    }

    /// Reads rows `start..end` (clamped to the array), (rows x row length).
    pub(crate) fn read_rows(&self, start: usize, end: usize) -> Result<Vec<f64>, StoreError> {
        let end = end.min(self.shape.rows);
        let row_len = self.shape.row_len();
        let mut values = Vec::new();
        let mut row = start;
        while row < end {
            let index = row / self.shape.chunk_rows;
            let first = index * self.shape.chunk_rows;
            let last = (first + self.shape.chunk_rows).min(end);
            let chunk = self.read_chunk(index)?;
            values.extend_from_slice(&chunk[(row - first) * row_len..(last - first) * row_len]);
            row = last;
        }
        Ok(values)
    }

    /// Reads everything.
    pub(crate) fn read(&self) -> Result<Vec<f64>, StoreError> {
        self.read_rows(0, self.shape.rows)
    }

    /// Reads one value of each of the first `rows` rows.
    pub(crate) fn read_column(&self, column: usize, rows: usize) -> Result<Vec<f64>, StoreError> {
        let (rows, row_len) = (rows.min(self.shape.rows), self.shape.row_len());
        let mut values = Vec::with_capacity(rows);
        if column >= row_len {
            return Ok(vec![f64::NAN; rows]);
        }
        for index in 0..rows.div_ceil(self.shape.chunk_rows) {
            values.extend(self.read_every(index, column, row_len)?);
        }
        values.truncate(rows);
        Ok(values)
    }

    fn read_chunk(&self, index: usize) -> Result<Vec<f64>, StoreError> {
        self.read_every(index, 0, 1)
    }

    /// Reads a chunk that must be there.
    pub(crate) fn read_written_chunk(&self, index: usize) -> Result<Vec<f64>, StoreError> {
        let chunk = self.chunk(index);
        if chunk.is_file() {
            self.read_chunk(index)
        } else {
            Err(damaged(&chunk.path(), "the file is missing"))
        }
    }

    /// Every `step`-th value of a chunk, from the one at `first` on.
    fn read_every(&self, index: usize, first: usize, step: usize) -> Result<Vec<f64>, StoreError> {
        let len = self.shape.chunk_rows * self.shape.row_len();
        let chunk = self.chunk(index);
        let Some(bytes) = chunk.read()? else {
            // A chunk that was never written holds the fill value.
            return Ok(vec![f64::NAN; (len - first).div_ceil(step)]);
        };
        chunk::decode_every(&bytes, len, self.kind, first, step).map_err(|fault| {
            let what = match fault {
                ChunkFault::Size => "the file does not have the size of a chunk",
                ChunkFault::Checksum => "the checksum does not fit the data",
            };
            damaged(&chunk.path(), what)
        })
    }

    /// The file of a chunk.
    fn chunk(&self, index: usize) -> Place {
        let across = if self.shape.columns.is_some() {
            "/0"
        } else {
            ""
        };
        self.place.join(&format!("c/{index}{across}"))
    }

    fn write_metadata(&self) -> Result<(), StoreError> {
        let ArrayShape {
            rows,
            columns,
            chunk_rows,
            dimensions,
        } = &self.shape;
        let axes =
            |first: usize| -> Vec<usize> { std::iter::once(first).chain(*columns).collect() };
        let metadata = json!({
            "zarr_format": 3,
            "node_type": "array",
            "shape": axes(*rows),
            "data_type": self.kind.name(),
            "chunk_grid": { "name": "regular", "configuration": { "chunk_shape": axes(*chunk_rows) } },
            "chunk_key_encoding": { "name": "default", "configuration": { "separator": "/" } },
            "fill_value": "NaN",
            "codecs": [
                { "name": "bytes", "configuration": { "endian": "little" } },
                { "name": "crc32c" },
            ],
            "dimension_names": dimensions,
            "attributes": self.attributes,
        });
        node::write_metadata(&self.place, &metadata)
    }
}

/// Kind and shape out of an array's metadata; `None` where it is not as written above.
fn parse_metadata(metadata: &Attributes) -> Option<(FloatKind, ArrayShape)> {
    let kind = match metadata.get("data_type")?.as_str()? {
        "float32" => FloatKind::F32,
        "float64" => FloatKind::F64,
        _ => return None,
    };
    let codecs: Vec<&str> = metadata
        .get("codecs")?
        .as_array()?
        .iter()
        .map(|c| c["name"].as_str())
        .collect::<Option<_>>()?;
    if codecs != ["bytes", "crc32c"] {
        return None;
    }
    let axes = |value: &Value| -> Option<Vec<usize>> {
        value
            .as_array()?
            .iter()
            .map(|v| usize::try_from(v.as_u64()?).ok())
            .collect()
    };
    let shape = axes(metadata.get("shape")?)?;
    let chunk = axes(
        metadata
            .get("chunk_grid")?
            .get("configuration")?
            .get("chunk_shape")?,
    )?;
    let names = metadata.get("dimension_names")?.as_array()?;
    let dimensions: Vec<String> = names
        .iter()
        .map(|name| name.as_str().map(str::to_owned))
        .collect::<Option<_>>()?;
    let whole_rows = match (shape.len(), chunk.len()) {
        (1, 1) => true,
        (2, 2) => shape[1] == chunk[1],
        _ => false,
    };
    if !whole_rows || chunk[0] == 0 || dimensions.len() != shape.len() {
        return None;
    }
    // A damaged shape must not ask for more memory than a machine has.
    let len = |axes: &[usize]| {
        axes.iter()
            .try_fold(1_usize, |product, n| product.checked_mul(*n))
    };
    if len(&chunk)? > 1 << 28 || len(&shape)? > 1 << 34 {
        return None;
    }
    let columns = shape.get(1).copied();
    Some((
        kind,
        ArrayShape {
            rows: shape[0],
            columns,
            chunk_rows: chunk[0],
            dimensions,
        },
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_come_back_across_chunks_and_unwritten_ones_are_nan() {
        let dir = tempfile::tempdir().unwrap();
        let shape = ArrayShape {
            rows: 5,
            columns: Some(2),
            chunk_rows: 2,
            dimensions: vec!["time".into(), "node".into()],
        };
        let place = Place::folder(dir.path().join("a"));
        let array = Array::create(place.clone(), FloatKind::F64, shape, Attributes::new()).unwrap();
        array.write_all(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0]).unwrap();
        let mut array = Array::open(place).unwrap();
        assert_eq!(array.read_rows(1, 3).unwrap(), [2.0, 3.0, 4.0, 5.0]);
        assert_eq!(array.read_column(1, 2).unwrap(), [1.0, 3.0]);
        assert_eq!(array.read_column(0, 3).unwrap(), [0.0, 2.0, 4.0]);
        assert!(array.read_column(2, 3).unwrap().iter().all(|v| v.is_nan()));
        assert!(array.read_rows(3, 9).unwrap().iter().all(|v| v.is_nan()));
        array.set_rows(3).unwrap();
        assert_eq!(array.read().unwrap().len(), 6);
    }
}
