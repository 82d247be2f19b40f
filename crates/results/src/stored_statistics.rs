//! Statistics out of stored rows, for cases that never reached their statistics window.

use catenix_model::LineQuantity;

use crate::store_reader::StoredCase;
use crate::summarise::StatisticsSource;
use crate::{Extent, RangeGraph};

/// Statistics over the last stretch of a stored case.
pub(crate) struct StoredStatistics<'a> {
    case: &'a StoredCase,
    /// First row of the histories in the window.
    first_row: usize,
    window_s: Option<[f64; 2]>,
}

impl<'a> StoredStatistics<'a> {
    /// The window is the last `window_s` seconds of the stored times.
    pub(crate) fn new(case: &'a StoredCase, times_s: &[f64], window_s: f64) -> Self {
        let end = times_s.last().copied();
        let start = end.map_or(0.0, |end| end - window_s * (1.0 + 1e-9));
        let first_row = times_s.partition_point(|time| *time < start);
        let window_s = end.map(|end| [times_s[first_row], end]);
        StoredStatistics {
            case,
            first_row,
            window_s,
        }
    }

    /// First and last time of the window [s]; `None` when nothing is stored.
    pub(crate) fn window_s(&self) -> Option<[f64; 2]> {
        self.window_s
    }
}

impl StatisticsSource for StoredStatistics<'_> {
    fn channel(&self, name: &str) -> Option<Extent> {
        let history = self.case.channel(name).ok()?;
        let times = history.times_s.get(self.first_row..)?;
        let graph = RangeGraph::from_rows(times, history.values.get(self.first_row..)?, 1);
        Some(graph.extent(0))
    }

    fn line(&self, line: &str, quantity: LineQuantity) -> Option<(Vec<f64>, RangeGraph)> {
        let field = self.case.field(line, quantity, self.window_s?[0]).ok()?;
        let graph = RangeGraph::from_rows(&field.times_s, &field.values, field.arc_length_m.len());
        Some((field.arc_length_m, graph))
    }
}
