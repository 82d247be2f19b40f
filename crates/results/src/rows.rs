//! Stored rows of one array, read piece by piece: for readers that copy a whole store.

use crate::StoreError;
use crate::layout::component;
use crate::store_reader::{StoredCase, text};
use crate::zarr::Array;

/// An array of a case that grows with time, opened once; it is never read as a whole.
#[derive(Debug, Clone)]
pub struct StoredRows {
    array: Array,
}

impl StoredRows {
    /// Values per row: 1 for histories, the number of nodes for fields.
    pub fn row_len(&self) -> usize {
        self.array.shape().row_len()
    }

    /// Rows of one chunk, the least that is read at a time.
    pub fn chunk_rows(&self) -> usize {
        self.array.shape().chunk_rows
    }

    /// Unit of the values.
    pub fn unit(&self) -> String {
        text(self.array.attributes(), "units")
    }

    /// What the values are, in words.
    pub fn long_name(&self) -> String {
        text(self.array.attributes(), "long_name")
    }

    /// Reads the given rows, which ascend: (n_rows x row length).
    ///
    /// Every chunk that they touch is read once and its checksum is tested. A chunk that should be
    /// there and is not is damage: the caller asks only for rows that were written.
    pub fn read(&self, rows: &[usize]) -> Result<Vec<f64>, StoreError> {
        let (row_len, chunk_rows) = (self.row_len(), self.chunk_rows());
        let mut values = Vec::with_capacity(rows.len() * row_len);
        for part in rows.chunk_by(|a, b| a / chunk_rows == b / chunk_rows) {
            let index = part[0] / chunk_rows;
            let chunk = self.array.read_written_chunk(index)?;
            for row in part {
                let start = (row - index * chunk_rows) * row_len;
                values.extend_from_slice(&chunk[start..start + row_len]);
            }
        }
        Ok(values)
    }
}

impl StoredCase {
    /// Times of the histories [s].
    pub fn history_time(&self) -> Result<StoredRows, StoreError> {
        self.history_rows("time")
    }

    /// A history by the name of its channel.
    pub fn channel_rows(&self, name: &str) -> Result<StoredRows, StoreError> {
        self.history_rows(&component(name))
    }

    fn history_rows(&self, folder: &str) -> Result<StoredRows, StoreError> {
        let array = Array::open(self.group().place().join(folder))?;
        Ok(StoredRows { array })
    }

    /// Times of the fields of a line [s].
    pub fn field_time(&self, line: &str) -> Result<StoredRows, StoreError> {
        let array = self.line_array(line, "field_time")?;
        Ok(StoredRows { array })
    }

    /// A quantity along a line: (times x nodes).
    pub fn field_rows(&self, line: &str, quantity: &str) -> Result<StoredRows, StoreError> {
        let array = self.line_array(line, quantity)?;
        Ok(StoredRows { array })
    }
}
