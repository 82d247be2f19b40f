//! Extremes, mean and standard deviation over time of many values at once.

use crate::curve::Stretch;

/// Values that are looked at together.
const BLOCK: usize = 32;

/// Smallest and largest of `n` values over time; NaN where no sample was a number.
///
/// Crests between two samples count: where the samples around them show one, it is the extreme of
/// a parabola. Source: docs/theory/results.md, eq. (13).
#[derive(Debug, Clone)]
pub struct Extremes {
    /// Smallest of each value (n).
    pub min: Vec<f64>,
    /// Largest of each value (n).
    pub max: Vec<f64>,
    /// The latest three samples, oldest first: times [s] and values (n each).
    times: [f64; 3],
    samples: [Vec<f64>; 3],
}

impl Extremes {
    /// Extremes of `n` values without samples.
    pub fn new(n: usize) -> Self {
        Extremes::of(vec![f64::NAN; n], vec![f64::NAN; n])
    }

    /// Extremes that are known, (n) each.
    pub fn of(min: Vec<f64>, max: Vec<f64>) -> Self {
        Extremes {
            times: [f64::NAN; 3],
            samples: std::array::from_fn(|_| vec![f64::NAN; min.len()]),
            min,
            max,
        }
    }

    /// Adds the sample `values` (n) at `time` [s]; times increase.
    pub fn add(&mut self, time: f64, values: &[f64]) {
        let times = [self.times[0], self.times[1], self.times[2], time];
        let stretch = Stretch::new(&times);
        let n = values.len();
        let [oldest, old, last] = self.samples.each_ref().map(|sample| &sample[..n]);
        let (min, max) = (&mut self.min[..n], &mut self.max[..n]);
        // Few values have a crest, so most blocks do without its divisions.
        for start in (0..n).step_by(BLOCK) {
            let mut crests = false;
            for k in start..n.min(start + BLOCK) {
                // The smaller of NaN and a number is the number: the first sample needs no care.
                min[k] = min[k].min(values[k]);
                max[k] = max[k].max(values[k]);
                crests |= stretch.has_extreme([oldest[k], old[k], last[k], values[k]]);
            }
            if crests {
                for k in start..n.min(start + BLOCK) {
                    let around = [oldest[k], old[k], last[k], values[k]];
                    if stretch.has_extreme(around) {
                        let crest = stretch.extreme(around);
                        min[k] = min[k].min(crest);
                        max[k] = max[k].max(crest);
                    }
                }
            }
        }
        self.samples.rotate_left(1);
        self.samples[2].copy_from_slice(values);
        self.times = [times[1], times[2], times[3]];
    }
}

/// Running statistics of `n` values that are sampled at uneven times.
///
/// The mean and the variance are integrals over time by the trapezoidal rule, so a step of twice
/// the length counts twice; minimum and maximum are those of [`Extremes`]. The update is the weighted
/// form of Welford's: West (1979), "Updating mean and variance estimates: an improved method",
/// Communications of the ACM 22(9), 532-535. NaN anywhere makes the mean of that value NaN.
/// Source: docs/theory/results.md, eq. (9).
#[derive(Debug, Clone)]
pub struct WindowStatistics {
    /// Extremes of each value (n).
    extremes: Extremes,
    /// Mean of each value over the committed samples (n).
    mean: Vec<f64>,
    /// Weighted sum of squared deviations from the mean (n).
    squares: Vec<f64>,
    /// Weight of the committed samples [s].
    weight: f64,
    /// Latest sample, whose weight is known only when the next one arrives (n).
    pending: Vec<f64>,
    /// Time of the latest sample and the weight it has so far [s].
    last: Option<(f64, f64)>,
    /// Time of the first sample [s].
    first_time: f64,
}

impl WindowStatistics {
    /// Statistics of `n` values without samples.
    pub fn new(n: usize) -> Self {
        WindowStatistics {
            extremes: Extremes::new(n),
            mean: vec![0.0; n],
            squares: vec![0.0; n],
            weight: 0.0,
            pending: vec![0.0; n],
            last: None,
            first_time: f64::NAN,
        }
    }

    /// Adds the sample `values` (n) at `time` [s]; times must not decrease.
    pub fn add(&mut self, time: f64, values: &[f64]) {
        match self.last {
            None => {
                self.first_time = time;
                self.last = Some((time, 0.0));
            }
            Some((previous, weight)) => {
                let half = 0.5 * (time - previous).max(0.0);
                self.commit(weight + half);
                self.last = Some((time, half));
            }
        }
        self.pending.copy_from_slice(values);
        self.extremes.add(time, values);
    }

    /// Times of the first and the last sample [s]; `None` without samples.
    pub fn window_s(&self) -> Option<[f64; 2]> {
        self.last.map(|(time, _)| [self.first_time, time])
    }

    /// The statistics of the samples so far; all NaN without samples. A single sample is its own
    /// mean.
    pub fn range_graph(&self) -> RangeGraph {
        let n = self.mean.len();
        let Some((_, last_weight)) = self.last else {
            let nan = || vec![f64::NAN; n];
            return RangeGraph {
                min: nan(),
                mean: nan(),
                max: nan(),
                std: nan(),
            };
        };
        let mut all = self.clone();
        all.commit(if self.weight + last_weight > 0.0 {
            last_weight
        } else {
            1.0
        });
        let weight = all.weight;
        RangeGraph {
            min: all.extremes.min,
            mean: all.mean,
            max: all.extremes.max,
            std: all
                .squares
                .iter()
                .map(|s| (s.max(0.0) / weight).sqrt())
                .map(|v| if v.is_finite() { v } else { f64::NAN })
                .collect(),
        }
    }

    /// Gives the pending sample its final weight [s].
    fn commit(&mut self, weight: f64) {
        self.weight += weight;
        if self.weight <= 0.0 {
            return;
        }
        let fraction = weight / self.weight;
        let moments = self.mean.iter_mut().zip(&mut self.squares);
        for ((mean, squares), value) in moments.zip(&self.pending) {
            let deviation = value - *mean;
            *mean += fraction * deviation;
            *squares += weight * deviation * (value - *mean);
        }
    }
}

/// Minimum, mean, maximum and standard deviation over time of one quantity at each node of a line.
#[derive(Debug, Clone, PartialEq)]
pub struct RangeGraph {
    /// Smallest value (n).
    pub min: Vec<f64>,
    /// Mean over time (n).
    pub mean: Vec<f64>,
    /// Largest value (n).
    pub max: Vec<f64>,
    /// Standard deviation over time (n).
    pub std: Vec<f64>,
}

impl RangeGraph {
    /// Statistics of rows of samples: `values` is (times x n).
    pub fn from_rows(times: &[f64], values: &[f64], n: usize) -> Self {
        let mut statistics = WindowStatistics::new(n);
        for (time, row) in times.iter().zip(values.chunks_exact(n.max(1))) {
            statistics.add(*time, row);
        }
        statistics.range_graph()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_weighs_samples_by_time() {
        // Piecewise linear through (0, 0), (1, 1), (3, 1): integral 0.5 + 2 over 3 s.
        let graph = RangeGraph::from_rows(&[0.0, 1.0, 3.0], &[0.0, 1.0, 1.0], 1);
        assert!((graph.mean[0] - 2.5 / 3.0).abs() < 1e-15);
        assert_eq!((graph.min[0], graph.max[0]), (0.0, 1.0));
    }

    #[test]
    fn uneven_steps_leave_a_sine_its_mean_and_deviation() {
        let mut times: Vec<f64> = (0..=2000).map(|i| f64::from(i) * 1e-3).collect();
        times.retain(|t| *t < 0.7 || ((t * 1e3).round() as i64) % 4 == 0);
        let values: Vec<f64> = times
            .iter()
            .map(|t| 1e6 + (std::f64::consts::TAU * t).sin())
            .collect();
        let graph = RangeGraph::from_rows(&times, &values, 1);
        // The trapezoidal rule on steps of 4 ms has errors of (2 pi 0.004)^2 / 12 = 5e-5.
        assert!((graph.mean[0] - 1e6).abs() < 5e-5);
        assert!((graph.std[0] - 0.5_f64.sqrt()).abs() < 1e-4);
    }

    #[test]
    fn one_sample_is_its_own_mean_and_none_is_nan() {
        let graph = RangeGraph::from_rows(&[5.0], &[2.0, f64::NAN], 2);
        assert_eq!((graph.min[0], graph.mean[0], graph.max[0]), (2.0, 2.0, 2.0));
        assert_eq!(graph.std[0], 0.0);
        assert!(graph.mean[1].is_nan() && graph.min[1].is_nan());
        assert!(WindowStatistics::new(1).range_graph().mean[0].is_nan());
    }

    #[test]
    fn extremes_are_over_all_samples_and_skip_what_is_no_number() {
        let mut extremes = Extremes::new(3);
        assert!(extremes.min[0].is_nan());
        extremes.add(0.0, &[1.0, f64::NAN, f64::NAN]);
        extremes.add(1.0, &[-2.0, 5.0, f64::NAN]);
        assert_eq!((extremes.min[0], extremes.max[0]), (-2.0, 1.0));
        assert_eq!((extremes.min[1], extremes.max[1]), (5.0, 5.0));
        assert!(extremes.min[2].is_nan() && extremes.max[2].is_nan());
    }

    /// Largest error of the extremes of a sine of amplitude 1 and period 1, sampled `per_period`
    /// times a period, wherever the samples lie about its crests.
    fn error_of_a_sine(per_period: f64) -> f64 {
        let mut largest = 0.0f64;
        for shift in 0..40 {
            let mut extremes = Extremes::new(1);
            for k in 0..(3.0 * per_period) as usize {
                let time = (k as f64 + f64::from(shift) / 40.0) / per_period;
                extremes.add(time, &[(std::f64::consts::TAU * time).sin()]);
            }
            let errors = [extremes.max[0] - 1.0, extremes.min[0] + 1.0];
            largest = errors.into_iter().fold(largest, |a, b| a.max(b.abs()));
        }
        largest
    }

    #[test]
    fn crests_between_samples_are_found_to_fourth_order() {
        // The samples alone would miss 1 - cos(pi / n): 1.2 % at 20 a period, 4.9 % at 10.
        let (coarse, fine) = (error_of_a_sine(10.0), error_of_a_sine(20.0));
        assert!(fine < 4e-4, "{fine}");
        assert!(coarse / fine > 12.0, "{coarse} and {fine}");
    }
}
