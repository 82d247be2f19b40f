//! Curves around a quantity along a line, of a case at any stage, and its history at one node.

use catenix_model::LineQuantity;
use serde::Serialize;

use crate::layout::FIELD_ROWS_KEY;
use crate::store_reader::{StoredCase, rows};
use crate::{History, RangeGraph, StoreError};

/// What a quantity along a line keeps within.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Envelope {
    /// Whether the curves are of every step, as written at the end of the case; otherwise they are
    /// of the rows stored so far, which can miss a peak between two of them.
    pub every_step: bool,
    /// First and last time of `min`, `mean` and `max` [s]; null when nothing is stored.
    pub window_s: Option<[f64; 2]>,
    /// Smallest value in the window (n_nodes).
    pub min: Vec<f64>,
    /// Mean over the window (n_nodes).
    pub mean: Vec<f64>,
    /// Largest value in the window (n_nodes).
    pub max: Vec<f64>,
    /// Smallest value over the whole run (n_nodes).
    pub run_min: Vec<f64>,
    /// Largest value over the whole run (n_nodes).
    pub run_max: Vec<f64>,
}

impl StoredCase {
    /// The envelope of a quantity: as written at the end of the case, or else of the stored rows.
    pub fn envelope(&self, line: &str, quantity: LineQuantity) -> Result<Envelope, StoreError> {
        let written = self.range_graph(line, quantity).and_then(|graph| {
            let extremes = self.run_extremes(line, quantity)?;
            Ok((graph, extremes))
        });
        match written {
            Ok((RangeGraph { min, mean, max, .. }, extremes)) => Ok(Envelope {
                every_step: true,
                window_s: self.summary()?.window_s,
                min,
                mean,
                max,
                run_min: extremes.min,
                run_max: extremes.max,
            }),
            Err(StoreError::UnknownLineResult { .. }) => self.stored_envelope(line, quantity),
            Err(error) => Err(error),
        }
    }

    /// The envelope of the stored rows. Their spacing is even, so the mean is that of the rows.
    fn stored_envelope(&self, line: &str, quantity: LineQuantity) -> Result<Envelope, StoreError> {
        let array = self.line_array(line, quantity.name())?;
        let nodes = array.shape().row_len();
        let stored = rows(&self.group().attributes()?, FIELD_ROWS_KEY).min(array.shape().rows);
        let times = self.line_array(line, "field_time")?.read_rows(0, stored)?;
        let mut min = vec![f64::NAN; nodes];
        let mut max = vec![f64::NAN; nodes];
        let mut sum = vec![0.0; nodes];
        self.for_each_stored_row(line, quantity, &mut |row| {
            for (node, value) in row.iter().enumerate() {
                min[node] = value.min(min[node]);
                max[node] = value.max(max[node]);
                sum[node] += value;
            }
        })?;
        let window_s = times.first().zip(times.last()).map(|(a, b)| [*a, *b]);
        Ok(Envelope {
            every_step: false,
            window_s,
            mean: sum.iter().map(|sum| sum / stored as f64).collect(),
            run_min: min.clone(),
            run_max: max.clone(),
            min,
            max,
        })
    }

    /// History of a quantity at one node of a line, of the stored rows.
    ///
    /// Reads and checks the whole field chunk by chunk, and keeps one value of each row.
    pub fn node_history(
        &self,
        line: &str,
        quantity: LineQuantity,
        node: usize,
    ) -> Result<History, StoreError> {
        let stored = rows(&self.group().attributes()?, FIELD_ROWS_KEY);
        let times_s = self.line_array(line, "field_time")?.read_rows(0, stored)?;
        let array = self.line_array(line, quantity.name())?;
        let values = array.read_column(node, times_s.len())?;
        Ok(History {
            unit: quantity.unit().to_owned(),
            times_s,
            values,
        })
    }

    /// Shows every stored row of a field (n_nodes), one chunk in memory at a time.
    pub(crate) fn for_each_stored_row(
        &self,
        line: &str,
        quantity: LineQuantity,
        visit: &mut dyn FnMut(&[f64]),
    ) -> Result<(), StoreError> {
        let array = self.line_array(line, quantity.name())?;
        let (nodes, chunk_rows) = (array.shape().row_len(), array.shape().chunk_rows);
        let stored = rows(&self.group().attributes()?, FIELD_ROWS_KEY).min(array.shape().rows);
        for start in (0..stored).step_by(chunk_rows) {
            let end = (start + chunk_rows).min(stored);
            for row in array.read_rows(start, end)?.chunks_exact(nodes.max(1)) {
                visit(row);
            }
        }
        Ok(())
    }
}
