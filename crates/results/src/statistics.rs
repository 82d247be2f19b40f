//! Extremes, mean and standard deviation over time of many values at once.

use pulp::{Arch, Simd, WithSimd};

use crate::Curve;
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
    /// The latest samples that were added: empty where somebody else keeps them.
    latest: Option<Curve>,
}

impl Extremes {
    /// Extremes of `n` values without samples.
    pub fn new(n: usize) -> Self {
        Extremes::of(vec![f64::NAN; n], vec![f64::NAN; n])
    }

    /// Extremes that are known, (n) each.
    pub fn of(min: Vec<f64>, max: Vec<f64>) -> Self {
        Extremes {
            min,
            max,
            latest: None,
        }
    }

    /// Adds the sample `values` (n) at `time` [s]; times increase.
    pub fn add(&mut self, time: f64, values: &[f64]) {
        let n = self.min.len();
        let mut curve = self.latest.take().unwrap_or_else(|| Curve::new(n));
        curve.push_with(time, |sample| sample.copy_from_slice(&values[..n]));
        self.follow(&curve);
        self.latest = Some(curve);
    }

    /// Adds the latest sample of a curve of as many values, all of whose samples were added.
    pub(crate) fn follow(&mut self, curve: &Curve) {
        let (times, samples) = curve.samples();
        Arch::new().dispatch(Widen {
            min: &mut self.min,
            max: &mut self.max,
            stretch: Stretch::new(times),
            samples,
        });
    }
}

/// Takes the latest of four samples into extremes, and the crests between the second and the third.
struct Widen<'a> {
    min: &'a mut [f64],
    max: &'a mut [f64],
    stretch: Stretch,
    samples: [&'a [f64]; 4],
}

/// Compiled for every instruction set: the loops become vectors.
impl WithSimd for Widen<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let n = self.min.len();
        let stretch = self.stretch;
        let (min, min_rest) = self.min.as_chunks_mut::<BLOCK>();
        let (max, max_rest) = self.max.as_chunks_mut::<BLOCK>();
        let blocks = self.samples.map(|sample| sample.as_chunks::<BLOCK>().0);
        for (index, (min, max)) in min.iter_mut().zip(max).enumerate() {
            widen(min, max, blocks.map(|blocks| &blocks[index][..]), &stretch);
        }
        let start = n - min_rest.len();
        let rest = self.samples.map(|sample| &sample[start..n]);
        widen(min_rest, max_rest, rest, &stretch);
    }
}

/// [`Widen`] for a few values. Few have a crest, so most blocks do without its divisions.
#[inline(always)]
fn widen(min: &mut [f64], max: &mut [f64], samples: [&[f64]; 4], stretch: &Stretch) {
    let n = min.len();
    let (max, [oldest, old, last, values]) = (&mut max[..n], samples.map(|sample| &sample[..n]));
    let around = |k: usize| [oldest[k], old[k], last[k], values[k]];
    let mut crests = 0u64;
    for k in 0..n {
        // The smaller of NaN and a number is the number: the first sample needs no care.
        min[k] = min[k].min(values[k]);
        max[k] = max[k].max(values[k]);
        crests |= u64::from(stretch.has_extreme(around(k)));
    }
    if crests == 0 {
        return;
    }
    for k in 0..n {
        // Without a branch, so that the divisions of a block are made at once.
        let found = stretch.extreme(around(k));
        let crest = if stretch.has_extreme(around(k)) {
            found
        } else {
            values[k]
        };
        min[k] = min[k].min(crest);
        max[k] = max[k].max(crest);
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
    /// Time of the latest sample, whose weight is known only when the next one arrives, and the
    /// weight it has so far [s].
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
        if let Some(latest) = &self.extremes.latest {
            Arch::new().dispatch(Commit {
                mean: &mut self.mean,
                squares: &mut self.squares,
                sample: latest.latest(),
                weight,
                fraction: weight / self.weight,
            });
        }
    }
}

/// Takes a sample of some weight into means and squares, see [`WindowStatistics`].
struct Commit<'a> {
    mean: &'a mut [f64],
    squares: &'a mut [f64],
    sample: &'a [f64],
    weight: f64,
    /// Share of the weight in the weight of all samples so far.
    fraction: f64,
}

impl WithSimd for Commit<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let moments = self.mean.iter_mut().zip(self.squares);
        for ((mean, squares), value) in moments.zip(self.sample) {
            let deviation = value - *mean;
            *mean += self.fraction * deviation;
            *squares += self.weight * deviation * (value - *mean);
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
