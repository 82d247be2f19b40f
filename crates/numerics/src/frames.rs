//! The configuration of a set of frames, and the increments that change it.

use crate::{Matrix3, Vector3, Vector6, so3};

/// Positions and rotations of n frames. Increments live in another type: (n) [`Vector6`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Configuration {
    /// Position of each frame, global, (n) [m].
    pub position: Vec<Vector3>,
    /// Rotation of each frame from its own axes to the global ones, (n).
    pub rotation: Vec<Matrix3>,
}

impl Configuration {
    /// Number of frames.
    pub fn len(&self) -> usize {
        self.position.len()
    }

    /// Whether there are no frames.
    pub fn is_empty(&self) -> bool {
        self.position.is_empty()
    }

    /// Moves every frame by its increment: x + dx, exp(dtheta) R.
    ///
    /// Source: docs/theory/rotations.md, eq. (5).
    pub fn retract(&mut self, increment: &[Vector6]) {
        for ((position, rotation), d) in self
            .position
            .iter_mut()
            .zip(&mut self.rotation)
            .zip(increment)
        {
            *position += d.fixed_rows::<3>(0);
            *rotation = so3::exp(&d.fixed_rows::<3>(3).into_owned()) * *rotation;
        }
    }

    /// The increments that lead from `base` to `self`: the inverse of [`Self::retract`].
    pub fn difference(&self, base: &Configuration) -> Vec<Vector6> {
        (0..self.len())
            .map(|k| {
                let dx = self.position[k] - base.position[k];
                let theta = so3::log(&(self.rotation[k] * base.rotation[k].transpose()));
                Vector6::new(dx.x, dx.y, dx.z, theta.x, theta.y, theta.z)
            })
            .collect()
    }

    /// Copies `other` without allocating.
    pub fn copy_from(&mut self, other: &Configuration) {
        self.position.clone_from(&other.position);
        self.rotation.clone_from(&other.rotation);
    }

    /// Removes the round-off that repeated products leave in the rotations.
    pub fn orthonormalise(&mut self) {
        for rotation in &mut self.rotation {
            *rotation = so3::orthonormalise(rotation);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn difference_undoes_retract() {
        let base = Configuration {
            position: vec![Vector3::new(1.0, 2.0, 3.0); 2],
            rotation: vec![so3::exp(&Vector3::new(0.3, -0.4, 1.0)); 2],
        };
        let increment = vec![
            Vector6::new(1.0, -1.0, 0.5, 0.2, 0.1, -0.7),
            Vector6::repeat(1e-7),
        ];
        let mut moved = base.clone();
        moved.retract(&increment);
        for (got, want) in moved.difference(&base).iter().zip(&increment) {
            assert_relative_eq!(got, want, epsilon = 1e-13);
        }
    }
}
