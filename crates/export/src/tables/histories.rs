//! All time histories of a load case side by side.

use std::ops::Range;

use catenix_results::StoredRows;

use super::pieces;
use crate::ExportError;
use crate::contents::CaseContents;
use crate::table::{Column, Kind, Table, Values};

/// Time, then every channel.
pub(crate) struct HistoryTable {
    columns: Vec<Column>,
    stored: Vec<StoredRows>,
    rows: Vec<usize>,
    pieces: Vec<Range<usize>>,
    piece_rows: Vec<usize>,
}

impl HistoryTable {
    /// Opens the histories of a case; the table has no rows where none are stored.
    pub(crate) fn open(contents: &CaseContents) -> Result<Self, ExportError> {
        let mut columns = Vec::new();
        let mut stored = Vec::new();
        if contents.description.time.is_some() {
            columns.push(Column::number("time", "s", "time", Kind::Float64));
            stored.push(contents.stored.history_time()?);
            for channel in &contents.description.channels {
                let rows = contents.stored.channel_rows(&channel.name)?;
                let text = rows.long_name();
                columns.push(Column::number(
                    &channel.name,
                    &channel.unit,
                    &text,
                    Kind::Float64,
                ));
                stored.push(rows);
            }
        }
        let chunk_rows = stored.first().map_or(1, StoredRows::chunk_rows);
        let rows = contents.history_rows.clone();
        let pieces = pieces(&rows, chunk_rows);
        Ok(HistoryTable {
            piece_rows: pieces.iter().map(Range::len).collect(),
            columns,
            stored,
            rows,
            pieces,
        })
    }
}

impl Table for HistoryTable {
    fn content(&self) -> &'static str {
        "histories"
    }

    fn columns(&self) -> &[Column] {
        &self.columns
    }

    fn pieces(&self) -> &[usize] {
        &self.piece_rows
    }

    fn read(&self, column: usize, piece: usize) -> Result<Values<'_>, ExportError> {
        let rows = &self.rows[self.pieces[piece].clone()];
        Ok(Values::Numbers(self.stored[column].read(rows)?))
    }
}
