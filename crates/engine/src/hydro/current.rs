//! Velocity of the water.

use catenix_model::Current;
use catenix_numerics::Vector3;
use catenix_numerics::time_table::{events, piecewise_linear};

/// A piece of a profile in which the velocity changes evenly with height.
#[derive(Debug, Clone, Copy)]
pub struct CurrentPiece {
    /// Where it begins [m].
    pub bottom: f64,
    /// Where it ends [m].
    pub top: f64,
    /// A height in or at the end of it [m].
    pub height: f64,
    /// Velocity at that height (2) [m/s].
    pub velocity: [f64; 2],
    /// Its derivative by height (2) [1/s].
    pub slope: [f64; 2],
}

/// A current profile ready for evaluation.
#[derive(Debug, Clone)]
pub struct CurrentField {
    current: Current,
}

impl CurrentField {
    /// Takes the profile of the model as it is.
    pub fn new(current: &Current) -> CurrentField {
        CurrentField {
            current: current.clone(),
        }
    }

    /// Factor on the profile at a time (the later entry of a step holds from its time on).
    pub fn factor(&self, time: f64) -> f64 {
        piecewise_linear(&self.current.factor, time).unwrap_or(1.0)
    }

    /// Times at which the current bends or jumps, and whether it jumps: a step should end there.
    pub fn events(&self) -> impl Iterator<Item = (f64, bool)> + '_ {
        events(&self.current.factor)
    }

    /// Velocity at height `z` and its derivative by z, both times `factor`, (3) [m/s], [1/s].
    #[inline]
    pub fn at(&self, z: f64, factor: f64) -> (Vector3, Vector3) {
        let piece = self.piece(z);
        let ([u, v], [x, y]) = (piece.velocity, piece.slope);
        let above = z - piece.height;
        (
            Vector3::new(u + x * above, v + y * above, 0.0) * factor,
            Vector3::new(x, y, 0.0) * factor,
        )
    }

    /// The piece of the profile around height `z`.
    ///
    /// Source: docs/theory/hydrodynamics.md, eq. (1).
    #[inline]
    pub fn piece(&self, z: f64) -> CurrentPiece {
        let profile = &self.current.profile;
        let below = profile.partition_point(|point| point.depth <= -z);
        let (upper, lower) = (
            below.checked_sub(1).map(|k| &profile[k]),
            profile.get(below),
        );
        let top = upper.map_or(f64::INFINITY, |point| -point.depth);
        let bottom = lower.map_or(f64::NEG_INFINITY, |point| -point.depth);
        let (height, velocity, slope) = match (upper, lower) {
            (None, None) => (0.0, [0.0; 2], [0.0; 2]),
            (Some(only), None) | (None, Some(only)) => (0.0, only.velocity, [0.0; 2]),
            (Some(upper), Some(lower)) => {
                let slope =
                    [0, 1].map(|k| (upper.velocity[k] - lower.velocity[k]) / (top - bottom));
                (top, upper.velocity, slope)
            }
        };
        CurrentPiece {
            bottom,
            top,
            height,
            velocity,
            slope,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use catenix_model::CurrentPoint;

    fn field(factor: Vec<(f64, f64)>) -> CurrentField {
        let point = |depth, x, y| CurrentPoint {
            depth,
            velocity: [x, y],
        };
        let profile = vec![point(0.0, 0.8, 0.0), point(100.0, 0.2, 0.4)];
        CurrentField::new(&Current { profile, factor })
    }

    #[test]
    fn linear_inside_constant_outside() {
        let field = field(Vec::new());
        assert_eq!(field.at(5.0, 1.0).0, Vector3::new(0.8, 0.0, 0.0));
        assert_eq!(field.at(-400.0, 2.0).0, Vector3::new(0.4, 0.8, 0.0));
        let (velocity, slope) = field.at(-50.0, 1.0);
        assert!((velocity - Vector3::new(0.5, 0.2, 0.0)).norm() < 1e-15);
        let ahead = field.at(-49.0, 1.0).0;
        assert!((ahead - velocity - slope).norm() < 1e-15);
    }

    #[test]
    fn without_factors_the_current_is_steady() {
        assert_eq!(field(Vec::new()).factor(3.0), 1.0);
        assert_eq!(field(vec![(10.0, 0.0), (20.0, 1.0)]).factor(15.0), 0.5);
    }
}
