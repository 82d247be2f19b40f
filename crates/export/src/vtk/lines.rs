//! The lines of a case: one polyline each, with every quantity at its nodes.

use std::borrow::Cow;
use std::ops::Range;

use catenix_results::StoredRows;

use super::poly_data::{Cells, Data, DataArray, PolyData};
use crate::ExportError;
use crate::contents::CaseContents;
use crate::tables::{pieces, quantities};

/// Quantities that become the points.
const POSITION: [&str; 3] = ["x", "y", "z"];

/// Quantity by which the lines are coloured first.
const SHOWN_FIRST: &str = "effective_tension";

/// The stored fields of the wanted lines, and what does not change over time.
pub(crate) struct LineSeries {
    rows: Vec<usize>,
    pieces: Vec<Range<usize>>,
    names: Vec<String>,
    nodes: Vec<usize>,
    cell_ends: Vec<i64>,
    arc_length_m: Vec<f64>,
    line_of_point: Vec<i32>,
    line_of_cell: Vec<i32>,
    /// Per axis and line.
    position: Vec<Vec<Option<StoredRows>>>,
    quantities: Vec<QuantityFields>,
}

struct QuantityFields {
    /// Name with unit.
    label: String,
    shown_first: bool,
    /// Per line; none where the line has it not.
    lines: Vec<Option<StoredRows>>,
}

/// Some times of all fields.
pub(crate) struct Block {
    times: usize,
    position: Vec<Vec<Vec<f32>>>,
    quantities: Vec<Vec<Vec<f32>>>,
}

impl LineSeries {
    pub(crate) fn open(contents: &CaseContents) -> Result<Self, ExportError> {
        let lines = &contents.lines;
        let open = |name: &str| -> Result<Vec<Option<StoredRows>>, ExportError> {
            let of_line = |line: &catenix_results::LinePlace| match line
                .quantities
                .iter()
                .any(|quantity| quantity.name == name)
            {
                true => Ok(Some(contents.stored.field_rows(&line.name, name)?)),
                false => Ok(None),
            };
            lines.iter().map(of_line).collect()
        };
        let nodes: Vec<usize> = lines.iter().map(|line| line.arc_length.rows).collect();
        let mut arc_length_m = Vec::new();
        for line in lines {
            arc_length_m.extend(contents.stored.arc_length_m(&line.name)?);
        }
        let ends = nodes.iter().scan(0, |sum, nodes| {
            *sum += *nodes as i64;
            Some(*sum)
        });
        let indices = 0..lines.len() as i32;
        let others = quantities(lines)
            .into_iter()
            .filter(|quantity| !POSITION.contains(&quantity.name))
            .map(|quantity| {
                Ok(QuantityFields {
                    label: format!("{} [{}]", quantity.name, quantity.unit),
                    shown_first: quantity.name == SHOWN_FIRST,
                    lines: open(quantity.name)?,
                })
            })
            .collect::<Result<_, ExportError>>()?;
        let chunk_rows = lines.first().map_or(1, |line| line.field_time.chunk_rows);
        Ok(LineSeries {
            pieces: pieces(&contents.field_rows, chunk_rows),
            rows: contents.field_rows.clone(),
            names: lines.iter().map(|line| line.name.clone()).collect(),
            cell_ends: ends.collect(),
            arc_length_m,
            line_of_point: indices
                .clone()
                .zip(&nodes)
                .flat_map(|(index, nodes)| std::iter::repeat_n(index, *nodes))
                .collect(),
            line_of_cell: indices.collect(),
            nodes,
            position: POSITION.into_iter().map(open).collect::<Result<_, _>>()?,
            quantities: others,
        })
    }

    /// Wanted times, cut so that each piece lies in one chunk.
    pub(crate) fn pieces(&self) -> Vec<Range<usize>> {
        self.pieces.clone()
    }

    /// Arrays of each file.
    pub(crate) fn arrays(&self) -> usize {
        self.quantities.len() + 2
    }

    /// Reads a piece.
    pub(crate) fn read(&self, piece: &Range<usize>) -> Result<Block, ExportError> {
        let rows = &self.rows[piece.clone()];
        let read = |fields: &Vec<Option<StoredRows>>| -> Result<Vec<Vec<f32>>, ExportError> {
            let of_line = |(stored, nodes): (&Option<StoredRows>, &usize)| match stored {
                // The fields are stored in single precision.
                Some(stored) => Ok(stored.read(rows)?.iter().map(|v| *v as f32).collect()),
                None => Ok(vec![f32::NAN; rows.len() * nodes]),
            };
            fields.iter().zip(&self.nodes).map(of_line).collect()
        };
        Ok(Block {
            times: rows.len(),
            position: self.position.iter().map(read).collect::<Result<_, _>>()?,
            quantities: self
                .quantities
                .iter()
                .map(|quantity| read(&quantity.lines))
                .collect::<Result<_, _>>()?,
        })
    }

    /// The lines at one of the times of a block.
    pub(crate) fn poly_data(&self, block: &Block, time: usize, time_s: f64) -> PolyData<'_> {
        let row = |values: &Vec<f32>| -> Vec<f32> {
            let nodes = values.len() / block.times;
            values[time * nodes..(time + 1) * nodes].to_vec()
        };
        let all_lines = |lines: &Vec<Vec<f32>>| lines.iter().flat_map(row).collect::<Vec<f32>>();
        let axes: Vec<Vec<f32>> = block.position.iter().map(all_lines).collect();
        let points = (0..self.line_of_point.len()).flat_map(|point| {
            let axes = &axes;
            (0..3).map(move |axis| axes[axis][point])
        });
        let mut point_arrays = vec![
            DataArray::scalars(
                "arc_length [m]",
                Data::Float64(Cow::Borrowed(&self.arc_length_m)),
            ),
            DataArray::scalars(
                "line_index",
                Data::Int32(Cow::Borrowed(&self.line_of_point)),
            ),
        ];
        for (quantity, values) in self.quantities.iter().zip(&block.quantities) {
            let values = Data::Float32(Cow::Owned(all_lines(values)));
            point_arrays.push(DataArray::scalars(&quantity.label, values));
        }
        let first = self.quantities.iter().find(|quantity| quantity.shown_first);
        PolyData {
            time_s,
            points: Data::Float32(Cow::Owned(points.collect())),
            cells: Cells::Lines,
            cell_ends: &self.cell_ends,
            point_arrays,
            cell_arrays: vec![
                DataArray::scalars("line_index", Data::Int32(Cow::Borrowed(&self.line_of_cell))),
                DataArray::scalars("line", Data::Text(&self.names)),
            ],
            shown_first: first.map(|quantity| quantity.label.as_str()),
        }
    }
}
