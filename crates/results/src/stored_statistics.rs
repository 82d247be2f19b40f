//! Statistics out of stored rows, for cases that never reached their statistics window.

use catenix_model::LineQuantity;

use crate::store_reader::{History, StoredCase};
use crate::summarise::StatisticsSource;
use crate::{Extent, Extremes, RangeGraph};

/// Statistics of a stored case: means over its last stretch, extremes over all of it.
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

    /// Mean of a channel over the window.
    pub(crate) fn mean(&self, channel: &str) -> Option<f64> {
        self.mean_of(&self.case.channel(channel).ok()?)
    }

    /// Range graph of a quantity along a line over the window.
    pub(crate) fn range_graph(&self, line: &str, quantity: LineQuantity) -> Option<RangeGraph> {
        let field = self.case.field(line, quantity, self.window_s?[0]).ok()?;
        let nodes = field.arc_length_m.len();
        Some(RangeGraph::from_rows(&field.times_s, &field.values, nodes))
    }

    fn mean_of(&self, history: &History) -> Option<f64> {
        let times = history.times_s.get(self.first_row..)?;
        let values = history.values.get(self.first_row..)?;
        RangeGraph::from_rows(times, values, 1)
            .mean
            .first()
            .copied()
    }
}

impl StatisticsSource for StoredStatistics<'_> {
    fn channel(&self, name: &str) -> Option<Extent> {
        let history = self.case.channel(name).ok()?;
        let mean = self.mean_of(&history)?;
        let mut extremes = Extremes::new(1);
        for (time, value) in history.times_s.iter().zip(&history.values) {
            extremes.add(*time, &[*value]);
        }
        Some(Extent::new(extremes.min[0], mean, extremes.max[0]))
    }

    fn line(&self, line: &str, quantity: LineQuantity) -> Option<(Vec<f64>, Extremes)> {
        let arc_length = self.case.arc_length_m(line).ok()?;
        let extremes = self.case.stored_extremes(line, quantity).ok()?;
        Some((arc_length, extremes))
    }
}
