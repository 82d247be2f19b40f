//! Cubic spline through points in time, at rest at both ends: continuous second derivative inside,
//! continuous first derivative everywhere.

/// A cubic spline with zero slope at its ends, constant outside its points.
#[derive(Debug, Clone, PartialEq)]
pub struct Spline {
    x: Vec<f64>,
    y: Vec<f64>,
    /// Second derivative at each point.
    second: Vec<f64>,
}

impl Spline {
    /// `x` strictly increasing, at least two points, `y` of the same length.
    ///
    /// Source: docs/theory/motions.md, eq. (4).
    pub fn at_rest_at_ends(x: &[f64], y: &[f64]) -> Spline {
        let n = x.len();
        let width = |k: usize| x[k + 1] - x[k];
        let slope = |k: usize| (y[k + 1] - y[k]) / width(k);
        // Tridiagonal equations of continuous slope; the outer slopes are zero.
        let mut second = vec![0.0; n];
        let mut upper = vec![0.0; n];
        for k in 0..n {
            let (before, after) = (
                if k > 0 { width(k - 1) } else { 0.0 },
                if k + 1 < n { width(k) } else { 0.0 },
            );
            let jump =
                if k + 1 < n { slope(k) } else { 0.0 } - if k > 0 { slope(k - 1) } else { 0.0 };
            let carried = if k > 0 { before * upper[k - 1] } else { 0.0 };
            let pivot = 2.0 * (before + after) - carried;
            upper[k] = after / pivot;
            let previous = if k > 0 { before * second[k - 1] } else { 0.0 };
            second[k] = (6.0 * jump - previous) / pivot;
        }
        for k in (0..n - 1).rev() {
            second[k] -= upper[k] * second[k + 1];
        }
        Spline {
            x: x.to_vec(),
            y: y.to_vec(),
            second,
        }
    }

    /// Value, first and second derivative at `x`.
    pub fn at(&self, x: f64) -> [f64; 3] {
        let last = self.x.len() - 1;
        if x <= self.x[0] {
            return [self.y[0], 0.0, 0.0];
        }
        if x >= self.x[last] {
            return [self.y[last], 0.0, 0.0];
        }
        let k = self.x.partition_point(|&point| point <= x) - 1;
        let h = self.x[k + 1] - self.x[k];
        let b = (x - self.x[k]) / h;
        let a = 1.0 - b;
        let (m0, m1) = (self.second[k], self.second[k + 1]);
        [
            a * self.y[k]
                + b * self.y[k + 1]
                + (a * (a * a - 1.0) * m0 + b * (b * b - 1.0) * m1) * h * h / 6.0,
            (self.y[k + 1] - self.y[k]) / h
                + ((3.0 * b * b - 1.0) * m1 - (3.0 * a * a - 1.0) * m0) * h / 6.0,
            a * m0 + b * m1,
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fourth_order_on_a_wave() {
        let error = |n: usize| {
            let x: Vec<f64> = (0..=n)
                .map(|k| k as f64 * std::f64::consts::PI / n as f64)
                .collect();
            let y: Vec<f64> = x.iter().map(|x| x.cos()).collect();
            let spline = Spline::at_rest_at_ends(&x, &y);
            (0..1000)
                .map(|k| 0.001 * k as f64 * std::f64::consts::PI)
                .map(|x| (spline.at(x)[0] - x.cos()).abs())
                .fold(0.0, f64::max)
        };
        let order = (error(20) / error(40)).log2();
        assert!(order > 3.8, "observed order {order}");
    }

    #[test]
    fn derivatives_match_finite_differences_and_ends_hold() {
        let spline = Spline::at_rest_at_ends(&[0.0, 1.0, 3.0, 4.0], &[0.0, 2.0, -1.0, 1.0]);
        for x in [0.3, 1.7, 3.4] {
            let [_, first, second] = spline.at(x);
            let h = 1e-5;
            let (plus, minus, mid) = (spline.at(x + h)[0], spline.at(x - h)[0], spline.at(x)[0]);
            assert!((first - (plus - minus) / (2.0 * h)).abs() < 1e-8);
            assert!((second - (plus - 2.0 * mid + minus) / (h * h)).abs() < 1e-4);
        }
        for (end, value) in [(0.0, 0.0), (4.0, 1.0)] {
            let [at, slope, _] = spline.at(end);
            assert!((at - value).abs() < 1e-15 && slope.abs() < 1e-14);
        }
        let inside = spline.at(1e-9)[1].abs() + spline.at(4.0 - 1e-9)[1].abs();
        assert!(inside < 1e-7, "no jump of velocity at the ends: {inside}");
        assert_eq!(spline.at(-1.0), [0.0, 0.0, 0.0]);
        assert_eq!(spline.at(9.0), [1.0, 0.0, 0.0]);
    }
}
