//! Velocity of the water.

use catenix_model::Current;
use catenix_numerics::Vector3;
use catenix_numerics::time_table::{events, piecewise_linear};

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
    ///
    /// Source: docs/theory/hydrodynamics.md, eq. (1).
    #[inline]
    pub fn at(&self, z: f64, factor: f64) -> (Vector3, Vector3) {
        let profile = &self.current.profile;
        let depth = -z;
        let constant = |k: usize| {
            let [x, y] = profile[k].velocity;
            (Vector3::new(x, y, 0.0) * factor, Vector3::zeros())
        };
        if profile.is_empty() {
            return (Vector3::zeros(), Vector3::zeros());
        }
        let below = profile.partition_point(|point| point.depth <= depth);
        if below == 0 {
            return constant(0);
        }
        if below == profile.len() {
            return constant(profile.len() - 1);
        }
        let (upper, lower) = (&profile[below - 1], &profile[below]);
        let span = lower.depth - upper.depth;
        let share = (depth - upper.depth) / span;
        let blend = |k: usize| upper.velocity[k] + (lower.velocity[k] - upper.velocity[k]) * share;
        let slope = |k: usize| -(lower.velocity[k] - upper.velocity[k]) / span;
        (
            Vector3::new(blend(0), blend(1), 0.0) * factor,
            Vector3::new(slope(0), slope(1), 0.0) * factor,
        )
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
