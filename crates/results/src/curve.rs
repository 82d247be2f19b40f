//! The smooth curve through the samples of many values, for what happens between two of them.
//!
//! Source: docs/theory/results.md, eqs. (11) to (13).

/// The latest samples of `n` values, and the curve through them.
///
/// Steps are as long as the motion allows, so they meet neither the crests of a wave nor the times
/// at which results are wanted. Between two samples each value follows a parabola through both,
/// whose curvature comes from the samples before and after.
#[derive(Debug, Clone)]
pub struct Curve {
    /// Times of the samples, oldest first; the last `count` are in use [s].
    times: [f64; SAMPLES],
    /// Values of the samples, oldest first (n each).
    values: [Vec<f64>; SAMPLES],
    count: usize,
}

/// Samples that a stretch of the curve takes: its two ends, one before and one after.
const SAMPLES: usize = 4;

impl Curve {
    /// A curve of `n` values without samples.
    pub fn new(n: usize) -> Self {
        Curve {
            times: [f64::NAN; SAMPLES],
            values: std::array::from_fn(|_| vec![f64::NAN; n]),
            count: 0,
        }
    }

    /// Adds the sample `values` (n) at `time` [s]; times increase.
    pub fn push(&mut self, time: f64, values: &[f64]) {
        self.push_with(time, |sample| sample.copy_from_slice(values));
    }

    /// Adds a sample at `time` [s], which `write` writes (n); times increase.
    pub fn push_with(&mut self, time: f64, write: impl FnOnce(&mut [f64])) {
        self.times.rotate_left(1);
        self.values.rotate_left(1);
        self.times[SAMPLES - 1] = time;
        write(&mut self.values[SAMPLES - 1]);
        self.count = (self.count + 1).min(SAMPLES);
    }

    /// Times [s] and values (n each) of the latest four samples, oldest first; NaN where there is
    /// none yet.
    pub(crate) fn samples(&self) -> (&[f64; SAMPLES], [&[f64]; SAMPLES]) {
        (&self.times, self.values.each_ref().map(Vec::as_slice))
    }

    /// The latest sample (n).
    pub fn latest(&self) -> &[f64] {
        &self.values[SAMPLES - 1]
    }

    /// Writes the values (n) at `time` [s] into `out`; a time outside the last three stretches takes
    /// the nearest sample.
    ///
    /// The last stretch bends as the one before does, until the next sample arrives.
    ///
    /// Source: docs/theory/results.md, eqs. (11) and (12).
    pub fn at(&self, time: f64, out: &mut [f64]) {
        let first = SAMPLES - self.count.max(1);
        let last = SAMPLES - 1;
        let stretch = (first..last).find(|&k| time <= self.times[k + 1]);
        let Some(a) = stretch else {
            out.copy_from_slice(self.latest());
            return;
        };
        let b = a + 1;
        if time >= self.times[b] || time <= self.times[a] {
            let end = if time >= self.times[b] { b } else { a };
            out.copy_from_slice(&self.values[end]);
            return;
        }
        let before = (a > first).then(|| a - 1);
        let after = (b < last).then(|| b + 1);
        let (start, end) = (self.times[a], self.times[b]);
        let share = (time - start) / (end - start);
        let bulge = (time - start) * (time - end);
        for (k, out) in out.iter_mut().enumerate() {
            let bend_of = |outer: usize| self.bend(k, [a, b, outer]);
            let bend = match (before.map(bend_of), after.map(bend_of)) {
                (Some(before), Some(after)) => before + (after - before) * share,
                (Some(one), None) | (None, Some(one)) => one,
                (None, None) => 0.0,
            };
            let (from, to) = (self.values[a][k], self.values[b][k]);
            *out = from + (to - from) * share + bend * bulge;
        }
    }

    /// Half of the second derivative of the parabola through three samples of a value.
    fn bend(&self, value: usize, [a, b, outer]: [usize; 3]) -> f64 {
        let (t, v) = (&self.times, &self.values);
        let slope = (v[b][value] - v[a][value]) / (t[b] - t[a]);
        let other = (v[outer][value] - v[b][value]) / (t[outer] - t[b]);
        (other - slope) / (t[outer] - t[a])
    }
}

/// Times at which results are wanted: every multiple of an interval, and the end of the run.
#[derive(Debug, Clone)]
pub struct OutputTimes {
    interval_s: f64,
    duration_s: f64,
    /// Rows so far.
    rows: usize,
}

impl OutputTimes {
    /// At `interval_s` up to `duration_s`.
    pub fn new(interval_s: f64, duration_s: f64) -> OutputTimes {
        OutputTimes {
            interval_s,
            duration_s,
            rows: 0,
        }
    }

    /// The next time, and never again, if it is not after `known`, or is `latest` [s].
    pub fn due(&mut self, known: f64, latest: f64) -> Option<f64> {
        let tolerance = time_tolerance(self.duration_s);
        let last = (self.rows as f64 - 1.0) * self.interval_s;
        let mut next = self.rows as f64 * self.interval_s;
        if last < self.duration_s - tolerance {
            next = next.min(self.duration_s);
        }
        let due = next <= known + tolerance || (next - latest).abs() <= tolerance;
        self.rows += usize::from(due);
        due.then_some(next)
    }
}

/// Difference of two times that counts as none [s].
pub(crate) fn time_tolerance(duration_s: f64) -> f64 {
    1e-9 * duration_s.max(1.0)
}

/// The stretch between the second and the third of four samples, where many values may have an
/// extreme of the curve through them.
///
/// The two parabolas through three of the samples must agree about the sense of the bend; its
/// amount is their harmonic mean, which is close to the smaller one where they differ. So a kink
/// that only one of them sees makes no extreme.
///
/// Source: docs/theory/results.md, eq. (13).
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stretch {
    /// Length [s].
    step: f64,
    /// One over the time between neighbours, and between the first and last three [1/s].
    per_step: [f64; 3],
    per_two: [f64; 2],
}

impl Stretch {
    /// From the times of the four samples [s].
    pub(crate) fn new(times: &[f64; 4]) -> Stretch {
        let per = |from: usize, to: usize| 1.0 / (times[to] - times[from]);
        Stretch {
            step: times[2] - times[1],
            per_step: [per(0, 1), per(1, 2), per(2, 3)],
            per_two: [per(0, 2), per(1, 3)],
        }
    }

    /// Slope along the stretch, and half the second derivatives of both parabolas.
    #[inline(always)]
    fn shape(&self, values: [f64; 4]) -> (f64, f64, f64) {
        let [before, slope, after] = [
            (values[1] - values[0]) * self.per_step[0],
            (values[2] - values[1]) * self.per_step[1],
            (values[3] - values[2]) * self.per_step[2],
        ];
        let left = (slope - before) * self.per_two[0];
        let right = (after - slope) * self.per_two[1];
        (slope, left, right)
    }

    /// Whether there is an extreme inside; not on a straight line, nor where a value is no number.
    #[inline(always)]
    pub(crate) fn has_extreme(&self, values: [f64; 4]) -> bool {
        let (slope, left, right) = self.shape(values);
        let agreement = left * right;
        // |slope| < |bend| step, without the division in the bend.
        (agreement > 0.0) & (slope.abs() * (left + right).abs() < 2.0 * agreement * self.step)
    }

    /// The extreme, where there is one.
    pub(crate) fn extreme(&self, values: [f64; 4]) -> f64 {
        let (slope, left, right) = self.shape(values);
        let bend = 2.0 * left * right / (left + right);
        0.5 * (values[1] + values[2]) - 0.25 * (bend * self.step * self.step + slope * slope / bend)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Uneven times with steps about `step`, from 0 to 8.
    fn times(step: f64) -> Vec<f64> {
        let count = (8.0 / step) as usize;
        let wobble = |k: usize| 0.3 * step * (2.0 * k as f64).sin();
        (0..=count).map(|k| k as f64 * step + wobble(k)).collect()
    }

    /// Largest distance of the curve from a sine of period 6.
    fn error(step: f64) -> f64 {
        let sine = |t: f64| (std::f64::consts::TAU * t / 6.0).sin();
        let times = times(step);
        let mut curve = Curve::new(1);
        let mut largest = 0.0f64;
        for (k, &time) in times.iter().enumerate() {
            curve.push(time, &[sine(time)]);
            if k < 3 {
                continue;
            }
            for share in 0..=10 {
                let (from, to) = (times[k - 2], times[k - 1]);
                let at = from + (to - from) * f64::from(share) / 10.0;
                let mut value = [0.0];
                curve.at(at, &mut value);
                largest = largest.max((value[0] - sine(at)).abs());
            }
        }
        largest
    }

    #[test]
    fn the_curve_is_of_third_order() {
        let errors = [0.4, 0.2, 0.1].map(error);
        let order = (errors[1] / errors[2]).log2();
        assert!(order > 2.8, "errors {errors:?}, observed order {order}");
        // (2 pi 0.4 / 6)^3 / 16 and more, since steps are up to half as long again.
        assert!(errors[0] < 0.02, "{errors:?}");
    }

    #[test]
    fn a_parabola_is_met_by_every_stretch() {
        let parabola = |t: f64| 1.0 - 2.0 * t + 0.5 * t * t;
        let mut curve = Curve::new(1);
        let mut value = [0.0];
        for time in [0.0, 0.5, 1.5, 1.8] {
            curve.push(time, &[parabola(time)]);
        }
        for time in [0.0, 0.2, 0.5, 1.0, 1.6, 1.8] {
            curve.at(time, &mut value);
            assert!((value[0] - parabola(time)).abs() < 1e-14, "{time}");
        }
    }

    #[test]
    fn few_samples_are_a_point_and_a_straight_line() {
        let mut curve = Curve::new(1);
        let mut value = [0.0];
        curve.push(1.0, &[3.0]);
        curve.at(0.0, &mut value);
        assert_eq!(value, [3.0]);
        curve.push(2.0, &[5.0]);
        for (time, expected) in [(0.5, 3.0), (1.5, 4.0), (2.0, 5.0), (3.0, 5.0)] {
            curve.at(time, &mut value);
            assert_eq!(value, [expected], "{time}");
        }
    }

    #[test]
    fn a_kink_makes_no_extreme() {
        // Flat, then rising: only one of the two parabolas would dip below.
        let stretch = Stretch::new(&[0.0, 1.0, 2.0, 3.0]);
        assert!(!stretch.has_extreme([0.0, 0.0, 0.0, 1.0]));
        assert!(!stretch.has_extreme([0.0, 0.0, 1.0, 2.0]));
        assert!(!stretch.has_extreme([f64::NAN; 4]));
        assert!(stretch.has_extreme([0.0, 1.0, 1.0, 0.0]));
        assert_eq!(stretch.extreme([0.0, 1.0, 1.0, 0.0]), 1.125);
        // Before the fourth sample there is no stretch.
        let stretch = Stretch::new(&[f64::NAN, 1.0, 2.0, 3.0]);
        assert!(!stretch.has_extreme([0.0, 1.0, 1.0, 0.0]));
    }
}
