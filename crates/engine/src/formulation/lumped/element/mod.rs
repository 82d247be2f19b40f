//! The lumped-mass method: mass points joined by springs against stretching, and springs against
//! the angle between neighbouring segments. Points do not turn, so there is no torsion.
//!
//! Kernels only: each sees a vector or two between points and knows neither lines nor water.
//!
//! Source: docs/theory/lumped.md.

pub mod bend;
pub mod guide;
pub mod spring;

#[cfg(test)]
mod tangent_tests;

use catenix_numerics::{Matrix3, Vector3};

/// Direction and length of a segment.
#[derive(Debug, Clone, Copy, Default)]
pub struct Segment {
    /// Unit (3).
    pub direction: Vector3,
    /// Length [m].
    pub length: f64,
}

impl Segment {
    /// Of the vector between two points. One without length has no direction: the state is lost,
    /// the numbers are not finite, and the step is cut.
    #[inline]
    pub fn new(between: &Vector3) -> Segment {
        let length = between.norm();
        Segment {
            direction: between / length,
            length,
        }
    }

    /// I - t t^T.
    #[inline]
    pub fn across(&self) -> Matrix3 {
        Matrix3::identity() - self.direction * self.direction.transpose()
    }
}

/// Value at `x` of a piecewise linear curve that goes on beyond its ends, with its slope there and
/// its integral from 0. `points` (n x 2): both columns strictly increasing, through (0, 0).
///
/// Source: docs/theory/lumped.md, eq. (4).
pub(crate) fn piecewise(points: &[[f64; 2]], x: f64) -> (f64, f64, f64) {
    let piece = |k: usize| {
        let [a, b] = [points[k - 1], points[k]];
        (a, (b[1] - a[1]) / (b[0] - a[0]))
    };
    let at = |x: f64| points.partition_point(|point| point[0] < x);
    let last = points.len() - 1;
    let own = at(x).clamp(1, last);
    let (start, slope) = piece(own);
    let value = start[1] + slope * (x - start[0]);
    // Piece by piece from the origin to x.
    let origin = at(0.0).clamp(1, last);
    let mut integral = 0.0;
    let (mut from, mut from_value) = (0.0, 0.0);
    let mut add = |to: [f64; 2]| {
        integral += 0.5 * (from_value + to[1]) * (to[0] - from);
        [from, from_value] = to;
    };
    if x >= 0.0 {
        for &point in points[origin..own].iter().filter(|point| point[0] > 0.0) {
            add(point);
        }
    } else {
        for &point in points[own..origin]
            .iter()
            .rev()
            .filter(|point| point[0] < 0.0)
        {
            add(point);
        }
    }
    add([x, value]);
    (value, slope, integral)
}
