//! Rows that grow with time, over several arrays that must stay in step.

use crate::StoreError;
use crate::zarr::Array;

/// Arrays that get one row each per output time, with the rows of the unfinished chunk in memory.
///
/// The arrays have their full planned length from the start, unwritten rows read as NaN and the
/// times are filled in ahead. So a reader finds one consistent set of shapes at any moment, however
/// the process ends.
#[derive(Debug)]
pub(crate) struct Series {
    columns: Vec<Column>,
    chunk_rows: usize,
    planned_times: Vec<f64>,
    rows: usize,
    flushed_rows: usize,
}

#[derive(Debug)]
struct Column {
    array: Array,
    /// Whether the array holds the times of the rows.
    is_time: bool,
    /// Rows of the unfinished chunk (rows x row length).
    buffer: Vec<f64>,
}

impl Series {
    /// A series without columns.
    pub(crate) fn new(chunk_rows: usize, planned_times: Vec<f64>) -> Self {
        Series {
            columns: Vec::new(),
            chunk_rows,
            planned_times,
            rows: 0,
            flushed_rows: 0,
        }
    }

    /// Adds an array for the times, and fills in the planned ones.
    pub(crate) fn add_time(&mut self, array: Array) -> Result<usize, StoreError> {
        array.write_all(&self.planned_times)?;
        Ok(self.add(array, true))
    }

    /// Adds an array for values and returns its column number.
    pub(crate) fn add_values(&mut self, array: Array) -> usize {
        self.add(array, false)
    }

    fn add(&mut self, array: Array, is_time: bool) -> usize {
        self.columns.push(Column {
            array,
            is_time,
            buffer: Vec::new(),
        });
        self.columns.len() - 1
    }

    /// Appends one column's values of the row that is being made.
    pub(crate) fn push(&mut self, column: usize, values: &[f64]) {
        self.columns[column].buffer.extend_from_slice(values);
    }

    /// Ends the row, after every column has got its values. A chunk that is full is written.
    pub(crate) fn end_row(&mut self) -> Result<(), StoreError> {
        self.rows += 1;
        if self.rows.is_multiple_of(self.chunk_rows) {
            self.flush()?;
        }
        Ok(())
    }

    /// Writes the rows that are not on disk yet.
    pub(crate) fn flush(&mut self) -> Result<(), StoreError> {
        if self.rows == self.flushed_rows {
            return Ok(());
        }
        let chunk = (self.rows - 1) / self.chunk_rows;
        let chunk_end = (chunk + 1) * self.chunk_rows;
        let ahead = self
            .planned_times
            .get(self.rows..chunk_end.min(self.planned_times.len()));
        for column in &mut self.columns {
            if column.is_time {
                let times: Vec<f64> = column
                    .buffer
                    .iter()
                    .chain(ahead.unwrap_or_default())
                    .copied()
                    .collect();
                column.array.write_chunk(chunk, &times)?;
            } else {
                column.array.write_chunk(chunk, &column.buffer)?;
            }
            if self.rows == chunk_end {
                column.buffer.clear();
            }
        }
        if self.rows > self.planned_times.len() {
            self.set_rows()?;
        }
        self.flushed_rows = self.rows;
        Ok(())
    }

    /// Writes what is left and cuts the arrays to the rows that there are.
    pub(crate) fn finish(&mut self) -> Result<(), StoreError> {
        self.flush()?;
        self.set_rows()
    }

    /// Rows that the whole run will have.
    pub(crate) fn planned_rows(&self) -> usize {
        self.planned_times.len()
    }

    /// Rows on disk.
    pub(crate) fn flushed_rows(&self) -> usize {
        self.flushed_rows
    }

    fn set_rows(&mut self) -> Result<(), StoreError> {
        self.columns
            .iter_mut()
            .try_for_each(|column| column.array.set_rows(self.rows))
    }
}
