//! A strictly increasing law through the origin, straight from point to point.
//!
//! Source: docs/theory/sections.md, eqs. (9) to (11).

/// A piecewise linear, strictly increasing function with f(0) = 0.
///
/// Beyond the outermost points it goes on with the slope there.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// Where the slope changes; the origin is always among them.
    kinks: Vec<Kink>,
    /// Slope before each kink, and after the last one (n_kinks + 1).
    slopes: Vec<f64>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Kink {
    x: f64,
    y: f64,
    /// Integral of the function from 0 to `x`.
    energy: f64,
}

/// A curve at one place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurvePoint {
    /// Integral from 0.
    pub energy: f64,
    /// The function.
    pub value: f64,
    /// Its slope.
    pub slope: f64,
}

impl Curve {
    /// A straight line.
    pub fn line(slope: f64) -> Curve {
        Curve {
            kinks: vec![Kink {
                x: 0.0,
                y: 0.0,
                energy: 0.0,
            }],
            slopes: vec![slope; 2],
        }
    }

    /// Through points with both coordinates strictly increasing, the origin among them, with the
    /// first coordinate times `stretch`, (n_points x 2), at least two.
    pub fn through(points: &[[f64; 2]], stretch: f64) -> Curve {
        let slope = |k: usize| {
            let [a, b] = [points[k], points[k + 1]];
            (b[1] - a[1]) / ((b[0] - a[0]) * stretch)
        };
        let last = points.len() - 2;
        // The outermost points are no kinks, unless one is the origin.
        let inner = |k: usize| (1..=last).contains(&k) || points[k][0] == 0.0;
        let kept: Vec<usize> = (0..points.len()).filter(|&k| inner(k)).collect();
        let corners = kept
            .iter()
            .map(|&k| [points[k][0] * stretch, points[k][1]])
            .collect();
        let mut slopes: Vec<f64> = kept.iter().map(|&k| slope(k.max(1) - 1)).collect();
        slopes.push(slope(kept.last().map_or(0, |&k| k.min(last))));
        Curve::new(corners, slopes)
    }

    fn new(corners: Vec<[f64; 2]>, slopes: Vec<f64>) -> Curve {
        let origin = corners.iter().position(|c| c[0] == 0.0).unwrap_or(0);
        let mut energy = vec![0.0; corners.len()];
        let area = |a: [f64; 2], b: [f64; 2]| 0.5 * (a[1] + b[1]) * (b[0] - a[0]);
        for k in origin + 1..corners.len() {
            energy[k] = energy[k - 1] + area(corners[k - 1], corners[k]);
        }
        for k in (0..origin).rev() {
            energy[k] = energy[k + 1] - area(corners[k], corners[k + 1]);
        }
        let kinks = corners.iter().zip(&energy);
        Curve {
            kinks: kinks
                .map(|(&[x, y], &energy)| Kink { x, y, energy })
                .collect(),
            slopes,
        }
    }

    /// The curve at `x`.
    pub fn at(&self, x: f64) -> CurvePoint {
        let segment = self.kinks.partition_point(|kink| kink.x <= x);
        let (kink, slope) = (self.kinks[segment.max(1) - 1], self.slopes[segment]);
        let d = x - kink.x;
        CurvePoint {
            energy: kink.energy + d * (kink.y + 0.5 * slope * d),
            value: kink.y + slope * d,
            slope,
        }
    }

    /// The place where the curve has the value `y`.
    pub fn inverse(&self, y: f64) -> f64 {
        let segment = self.kinks.partition_point(|kink| kink.y <= y);
        let kink = self.kinks[segment.max(1) - 1];
        kink.x + (y - kink.y) / self.slopes[segment]
    }

    /// Slope where the curve leaves the origin upwards.
    pub fn initial_slope(&self) -> f64 {
        self.at(0.0).slope
    }

    /// Largest slope.
    pub fn largest_slope(&self) -> f64 {
        self.slopes.iter().copied().fold(0.0, f64::max)
    }

    /// Both in a row: the same value in each, and the places add.
    pub fn in_series(&self, other: &Curve) -> Curve {
        let mut levels: Vec<f64> = [self, other]
            .iter()
            .flat_map(|curve| curve.kinks.iter().map(|kink| kink.y))
            .collect();
        levels.sort_by(f64::total_cmp);
        levels.dedup();
        let place = |y: f64| self.inverse(y) + other.inverse(y);
        // Slope of the piece that starts at a level, or ends at the lowest.
        let slope_above = |y: f64| {
            let slope =
                |curve: &Curve| curve.slopes[curve.kinks.partition_point(|kink| kink.y <= y)];
            1.0 / (1.0 / slope(self) + 1.0 / slope(other))
        };
        let mut slopes = vec![1.0 / (1.0 / self.slopes[0] + 1.0 / other.slopes[0])];
        slopes.extend(levels.iter().map(|&y| slope_above(y)));
        // The origin stays exactly where it is.
        let corner = |&y: &f64| if y == 0.0 { [0.0, 0.0] } else { [place(y), y] };
        Curve::new(levels.iter().map(corner).collect(), slopes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn laws() -> [Curve; 2] {
        [
            Curve::through(
                &[
                    [-2.0, -1.0],
                    [-1.0, -0.9],
                    [0.0, 0.0],
                    [1.0, 4.0],
                    [3.0, 5.0],
                ],
                0.5,
            ),
            Curve::through(&[[0.0, 0.0], [0.5, 2.0], [4.0, 2.5], [5.0, 6.0]], 2.0),
        ]
    }

    #[test]
    fn points_lie_on_the_curve_and_slopes_go_on() {
        let [curve, half] = laws();
        for (x, y) in [
            (-1.0, -1.0),
            (-0.5, -0.9),
            (0.0, 0.0),
            (0.5, 4.0),
            (1.5, 5.0),
            (2.5, 6.0),
        ] {
            assert!(
                (curve.at(x).value - y).abs() < 1e-14,
                "{x}: {:?}",
                curve.at(x)
            );
            assert!((curve.inverse(y) - x).abs() < 1e-14);
        }
        assert!((curve.at(-1.5).slope - 0.2).abs() < 1e-15);
        assert!((curve.at(9.0).slope - 1.0).abs() < 1e-15);
        // Without points below zero the first slope holds there.
        assert_eq!((half.at(-1.0).value, half.initial_slope()), (-2.0, 2.0));
        assert_eq!(half.largest_slope(), 2.0);
    }

    #[test]
    fn the_value_is_the_derivative_of_the_energy() {
        for curve in laws() {
            for k in -30..60 {
                let x = 0.11 * f64::from(k) + 0.013;
                let h = 1e-6;
                let numeric = (curve.at(x + h).energy - curve.at(x - h).energy) / (2.0 * h);
                assert!((numeric - curve.at(x).value).abs() < 1e-8, "at {x}");
            }
            assert_eq!(curve.at(0.0).energy, 0.0);
        }
    }

    #[test]
    fn places_add_in_series() {
        let [first, second] = laws();
        let both = first.in_series(&second);
        for k in -30..80 {
            let y = 0.1 * f64::from(k);
            let place = first.inverse(y) + second.inverse(y);
            assert!((both.at(place).value - y).abs() < 1e-12, "{y}");
            assert!((both.inverse(y) - place).abs() < 1e-12, "{y}");
        }
        let line = Curve::line(3.0).in_series(&Curve::line(6.0));
        assert!((line.at(5.0).value - 10.0).abs() < 1e-14);
    }
}
