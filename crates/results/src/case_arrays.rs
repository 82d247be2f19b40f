//! The arrays of one load case: histories, and per line the fields, range graphs and static state.

use catenix_model::{Channel, Line, LineQuantity, Model};

use crate::layout::{self, RANGE_SUFFIXES, RUN_SUFFIXES, array_attributes, component, long_name};
use crate::series::Series;
use crate::zarr::{Array, ArrayShape, Attributes, FloatKind, Group, Place};
use crate::{Extremes, RangeGraph, StoreError};

/// Most rows of a history in one chunk.
const HISTORY_CHUNK_ROWS: usize = 4096;

/// Most values of a field in one chunk: half a mebibyte of single-precision numbers, small enough
/// to rewrite at every flush and to fetch while scrubbing through time.
const FIELD_CHUNK_VALUES: usize = 1 << 17;

/// Most rows that are laid out ahead. A longer run grows its arrays while it goes on.
const MOST_PLANNED_ROWS: usize = 1 << 22;

/// All arrays of a load case that grow with time.
#[derive(Debug)]
pub(crate) struct CaseArrays {
    /// Time, then every channel.
    pub(crate) history: Series,
    /// Per line: time, then every quantity.
    pub(crate) fields: Series,
    pub(crate) lines: Vec<LineArrays>,
}

/// The arrays of a line that are written once, and where its fields are in the series.
#[derive(Debug)]
pub(crate) struct LineArrays {
    pub(crate) name: String,
    /// Unstretched distance of each node from end A (n_elements + 1) [m].
    pub(crate) arc_length: Vec<f64>,
    time_column: usize,
    fields: Vec<(LineQuantity, usize)>,
    group: Group,
}

impl CaseArrays {
    /// Makes the groups and arrays of a case.
    pub(crate) fn create(
        case: &Place,
        model: &Model,
        channels: &[Channel],
    ) -> Result<Self, StoreError> {
        let duration = model
            .dynamics
            .as_ref()
            .map_or(0.0, |dynamics| dynamics.duration);
        let output = &model.output;
        let history = create_history(case, planned_times(duration, output.interval), channels)?;
        let times = planned_times(duration, output.field_interval);
        let most_nodes = model
            .lines
            .iter()
            .map(|line| line.element_count() + 1)
            .max();
        let chunk_rows = chunk_rows(times.len(), FIELD_CHUNK_VALUES / most_nodes.unwrap_or(1));
        let mut fields = Series::new(chunk_rows, times);
        Group::create(layout::lines_place(case), &Attributes::new())?;
        let lines = model
            .lines
            .iter()
            .map(|line| LineArrays::create(case, model, line, chunk_rows, &mut fields))
            .collect::<Result<_, _>>()?;
        Ok(CaseArrays {
            history,
            fields,
            lines,
        })
    }

    /// Appends a row to the histories.
    pub(crate) fn push_history(&mut self, time: f64, values: &[f64]) -> Result<(), StoreError> {
        self.history.push(0, &[time]);
        for (index, value) in values.iter().enumerate() {
            self.history.push(index + 1, &[*value]);
        }
        self.history.end_row()
    }

    /// Appends a row to the fields.
    ///
    /// `values`: per line (quantities x nodes).
    pub(crate) fn push_fields(&mut self, time: f64, values: &[Vec<f64>]) -> Result<(), StoreError> {
        for (line, values) in self.lines.iter().zip(values) {
            self.fields.push(line.time_column, &[time]);
            for (quantity, column) in &line.fields {
                self.fields.push(*column, line.part(values, *quantity));
            }
        }
        self.fields.end_row()
    }
}

impl LineArrays {
    fn create(
        case: &Place,
        model: &Model,
        line: &Line,
        chunk_rows: usize,
        series: &mut Series,
    ) -> Result<Self, StoreError> {
        let mut attributes = Attributes::new();
        attributes.insert("name".into(), line.name.as_str().into());
        attributes.insert("length_m".into(), line.length().into());
        attributes.insert("elements".into(), line.element_count().into());
        let group = Group::create(layout::line_place(case, &line.name), &attributes)?;
        let arc_length = node_arc_length(line);
        let nodes = arc_length.len();
        Array::create(
            group.place().join("arc_length"),
            FloatKind::F64,
            ArrayShape::vector(nodes, "arc_length"),
            array_attributes("m", "unstretched distance from end A"),
        )?
        .write_all(&arc_length)?;
        let rows = series.planned_rows();
        let time_array = Array::create(
            group.place().join("field_time"),
            FloatKind::F64,
            ArrayShape {
                rows,
                columns: None,
                chunk_rows,
                dimensions: vec!["field_time".into()],
            },
            array_attributes("s", "time"),
        )?;
        let time_column = series.add_time(time_array)?;
        let has_wall = line
            .sections
            .iter()
            .any(|section| model.line_types[section.line_type].wall.is_some());
        let mut fields = Vec::new();
        for quantity in LineQuantity::ALL {
            if quantity == LineQuantity::VonMisesStress && !has_wall {
                continue;
            }
            let shape = ArrayShape {
                rows,
                columns: Some(nodes),
                chunk_rows,
                dimensions: vec!["field_time".into(), "arc_length".into()],
            };
            let attributes = array_attributes(quantity.unit(), &long_name(quantity));
            let place = group.place().join(quantity.name());
            let array = Array::create(place, FloatKind::F32, shape, attributes)?;
            fields.push((quantity, series.add_values(array)));
        }
        Ok(LineArrays {
            name: line.name.clone(),
            arc_length,
            time_column,
            fields,
            group,
        })
    }

    /// Quantities that are stored for this line.
    pub(crate) fn quantities(&self) -> impl Iterator<Item = LineQuantity> {
        self.fields.iter().map(|(quantity, _)| *quantity)
    }

    /// One quantity out of (quantities x nodes).
    fn part<'a>(&self, values: &'a [f64], quantity: LineQuantity) -> &'a [f64] {
        let nodes = self.arc_length.len();
        &values[quantity.index() * nodes..(quantity.index() + 1) * nodes]
    }

    /// One quantity out of a range graph of (quantities x nodes).
    pub(crate) fn part_of(&self, graph: &RangeGraph, quantity: LineQuantity) -> RangeGraph {
        let part = |values: &[f64]| self.part(values, quantity).to_vec();
        RangeGraph {
            min: part(&graph.min),
            mean: part(&graph.mean),
            max: part(&graph.max),
            std: part(&graph.std),
        }
    }

    /// One quantity out of extremes of (quantities x nodes).
    pub(crate) fn extremes_of(&self, extremes: &Extremes, quantity: LineQuantity) -> Extremes {
        Extremes::of(
            self.part(&extremes.min, quantity).to_vec(),
            self.part(&extremes.max, quantity).to_vec(),
        )
    }

    /// Writes the static state: (quantities x nodes).
    pub(crate) fn write_static(&self, values: &[f64]) -> Result<(), StoreError> {
        for quantity in self.quantities() {
            let name = format!("static_{}", quantity.name());
            let text = format!("{}, static", long_name(quantity));
            self.write_vector(&name, quantity, &text, self.part(values, quantity))?;
        }
        Ok(())
    }

    /// Writes the four curves of a range graph.
    pub(crate) fn write_range_graph(
        &self,
        quantity: LineQuantity,
        graph: &RangeGraph,
    ) -> Result<(), StoreError> {
        let curves = [&graph.min, &graph.mean, &graph.max, &graph.std];
        for (suffix, curve) in RANGE_SUFFIXES.into_iter().zip(curves) {
            let name = format!("{}_{suffix}", quantity.name());
            let text = format!(
                "{}, {suffix} over the statistics window",
                long_name(quantity)
            );
            self.write_vector(&name, quantity, &text, curve)?;
        }
        Ok(())
    }

    /// Writes the two curves of the extremes over the whole run.
    pub(crate) fn write_run_extremes(
        &self,
        quantity: LineQuantity,
        extremes: &Extremes,
    ) -> Result<(), StoreError> {
        let words = ["smallest", "largest"];
        let curves = [&extremes.min, &extremes.max];
        for ((suffix, word), curve) in RUN_SUFFIXES.into_iter().zip(words).zip(curves) {
            let name = format!("{}_{suffix}", quantity.name());
            let text = format!("{}, {word} over the whole run", long_name(quantity));
            self.write_vector(&name, quantity, &text, curve)?;
        }
        Ok(())
    }

    fn write_vector(
        &self,
        name: &str,
        quantity: LineQuantity,
        text: &str,
        values: &[f64],
    ) -> Result<(), StoreError> {
        Array::create(
            self.group.place().join(name),
            FloatKind::F64,
            ArrayShape::vector(values.len(), "arc_length"),
            array_attributes(quantity.unit(), text),
        )?
        .write_all(values)
    }
}

fn create_history(
    case: &Place,
    times: Vec<f64>,
    channels: &[Channel],
) -> Result<Series, StoreError> {
    let rows = times.len();
    let shape = ArrayShape {
        rows,
        columns: None,
        chunk_rows: chunk_rows(rows, HISTORY_CHUNK_ROWS),
        dimensions: vec!["time".into()],
    };
    let mut series = Series::new(shape.chunk_rows, times);
    series.add_time(Array::create(
        case.join("time"),
        FloatKind::F64,
        shape.clone(),
        array_attributes("s", "time"),
    )?)?;
    for channel in channels {
        let mut attributes = array_attributes(channel.unit, &channel.name.replace(['.', '_'], " "));
        attributes.insert("channel".into(), channel.name.as_str().into());
        let place = case.join(&component(&channel.name));
        series.add_values(Array::create(
            place,
            FloatKind::F64,
            shape.clone(),
            attributes,
        )?);
    }
    Ok(series)
}

/// Output times from 0 to `duration` at `interval` [s].
fn planned_times(duration: f64, interval: f64) -> Vec<f64> {
    // The small addition keeps the last time when the division comes out a hair below a whole
    // number, as in 0.3 / 0.1.
    let intervals = (duration / interval + 1e-6).floor();
    let intervals = if intervals.is_finite() && intervals > 0.0 {
        intervals as usize
    } else {
        0
    };
    let intervals = intervals.min(MOST_PLANNED_ROWS);
    (0..=intervals)
        .map(|index| index as f64 * interval)
        .collect()
}

fn chunk_rows(rows: usize, most: usize) -> usize {
    rows.min(most).max(1)
}

/// Unstretched distance of each node from end A [m].
pub(crate) fn node_arc_length(line: &Line) -> Vec<f64> {
    let lengths = line
        .sections
        .iter()
        .flat_map(|section| &section.element_lengths);
    let ends = lengths.scan(0.0, |sum, length| {
        *sum += length;
        Some(*sum)
    });
    std::iter::once(0.0).chain(ends).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn planned_times_reach_the_end_despite_rounding() {
        assert_eq!(planned_times(0.3, 0.1).len(), 4);
        assert_eq!(planned_times(1.0, 0.3).len(), 4);
        assert_eq!(planned_times(0.0, 0.1), [0.0]);
        assert_eq!(planned_times(1e12, 1e-3).len(), MOST_PLANNED_ROWS + 1);
    }
}
