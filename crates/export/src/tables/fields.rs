//! Every quantity at every node and time: one row each.

use std::ops::Range;

use catenix_results::StoredRows;

use super::curves::quantities;
use super::pieces;
use crate::ExportError;
use crate::contents::CaseContents;
use crate::table::{Column, Kind, Table, Values};

/// Line, time, arc length, then every quantity.
pub(crate) struct FieldTable {
    columns: Vec<Column>,
    lines: Vec<LineFields>,
    rows: Vec<usize>,
    times_s: Vec<f64>,
    pieces: Vec<(usize, Range<usize>)>,
    piece_rows: Vec<usize>,
}

struct LineFields {
    name: String,
    arc_length_m: Vec<f64>,
    /// Per quantity; none where the line has it not.
    quantities: Vec<Option<StoredRows>>,
}

impl FieldTable {
    /// Opens the fields of the wanted lines of a case.
    pub(crate) fn open(contents: &CaseContents) -> Result<Self, ExportError> {
        let mut columns = vec![
            Column::text("line", "line"),
            Column::number("time", "s", "time", Kind::Float64),
            Column::number(
                "arc_length",
                "m",
                "unstretched distance from end A",
                Kind::Float64,
            ),
        ];
        let quantities = quantities(&contents.lines);
        columns.extend(quantities.iter().map(|quantity| {
            Column::number(
                quantity.name,
                quantity.unit,
                &quantity.long_name,
                Kind::Float32,
            )
        }));
        let mut lines = Vec::new();
        let mut all_pieces = Vec::new();
        let mut piece_rows = Vec::new();
        for (index, line) in contents.lines.iter().enumerate() {
            let arc_length_m = contents.stored.arc_length_m(&line.name)?;
            for piece in pieces(&contents.field_rows, line.field_time.chunk_rows) {
                piece_rows.push(piece.len() * arc_length_m.len());
                all_pieces.push((index, piece));
            }
            let open = |name: &str| -> Result<Option<StoredRows>, ExportError> {
                match line.quantities.iter().any(|quantity| quantity.name == name) {
                    true => Ok(Some(contents.stored.field_rows(&line.name, name)?)),
                    false => Ok(None),
                }
            };
            lines.push(LineFields {
                name: line.name.clone(),
                arc_length_m,
                quantities: quantities
                    .iter()
                    .map(|quantity| open(quantity.name))
                    .collect::<Result<_, _>>()?,
            });
        }
        Ok(FieldTable {
            columns,
            lines,
            rows: contents.field_rows.clone(),
            times_s: contents.field_times_s.clone(),
            pieces: all_pieces,
            piece_rows,
        })
    }
}

impl Table for FieldTable {
    fn content(&self) -> &'static str {
        "fields"
    }

    fn columns(&self) -> &[Column] {
        &self.columns
    }

    fn pieces(&self) -> &[usize] {
        &self.piece_rows
    }

    fn read(&self, column: usize, piece: usize) -> Result<Values<'_>, ExportError> {
        let (line, range) = &self.pieces[piece];
        let line = &self.lines[*line];
        let nodes = line.arc_length_m.len();
        let times = &self.times_s[range.clone()];
        Ok(match column {
            0 => Values::Texts(vec![line.name.as_str(); times.len() * nodes]),
            1 => {
                let repeated = times
                    .iter()
                    .flat_map(|time| std::iter::repeat_n(*time, nodes));
                Values::Numbers(repeated.collect())
            }
            2 => Values::Numbers(line.arc_length_m.repeat(times.len())),
            _ => Values::Numbers(match &line.quantities[column - 3] {
                Some(stored) => stored.read(&self.rows[range.clone()])?,
                None => vec![f64::NAN; times.len() * nodes],
            }),
        })
    }
}
