//! The configuration of a set of blocks, and the increments that change it.

use crate::{Matrix3, Vector3, Vector6, so3};

/// Where n blocks of six freedoms are. A block is a frame (a position and a rotation), or a pair of
/// points; all pairs come before all frames. Increments live in another type: (n) [`Vector6`].
///
/// Source: docs/theory/rotations.md, eqs. (5) and (5a).
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Configuration {
    /// Position of each frame, first point of each pair, global, (n) [m].
    pub position: Vec<Vector3>,
    /// Rotation of each frame from its own axes to the global ones, (n); the identity at pairs.
    pub rotation: Vec<Matrix3>,
    /// Second point of each pair, global, (n_pairs) [m]: the first n_pairs blocks are pairs.
    pub second: Vec<Vector3>,
}

impl Configuration {
    /// Frames only.
    pub fn of_frames(position: Vec<Vector3>, rotation: Vec<Matrix3>) -> Configuration {
        Configuration {
            position,
            rotation,
            second: Vec::new(),
        }
    }

    /// Number of blocks: pairs of points and frames.
    pub fn len(&self) -> usize {
        self.position.len()
    }

    /// Whether there are no blocks.
    pub fn is_empty(&self) -> bool {
        self.position.is_empty()
    }

    /// Number of pairs of points, which are the first blocks.
    pub fn pair_count(&self) -> usize {
        self.second.len()
    }

    /// A point of a pair: its first (0) or second (1) (3) [m].
    pub fn point(&self, pair: usize, half: usize) -> Vector3 {
        [self.position[pair], self.second[pair]][half]
    }

    /// Moves every frame by its increment, x + dx and exp(dtheta) R, and every pair by its two.
    ///
    /// Source: docs/theory/rotations.md, eqs. (5) and (5a).
    pub fn retract(&mut self, increment: &[Vector6]) {
        let pairs = self.pair_count();
        for (position, d) in self.position.iter_mut().zip(increment) {
            *position += d.fixed_rows::<3>(0);
        }
        for (second, d) in self.second.iter_mut().zip(increment) {
            *second += d.fixed_rows::<3>(3);
        }
        for (rotation, d) in self.rotation.iter_mut().zip(increment).skip(pairs) {
            *rotation = so3::exp(&d.fixed_rows::<3>(3).into_owned()) * *rotation;
        }
    }

    /// The increments that lead from `base` to `self`: the inverse of [`Self::retract`].
    pub fn difference(&self, base: &Configuration) -> Vec<Vector6> {
        (0..self.len())
            .map(|k| self.difference_at(base, k))
            .collect()
    }

    /// [`Self::difference`] of one block.
    pub fn difference_at(&self, base: &Configuration, k: usize) -> Vector6 {
        let dx = self.position[k] - base.position[k];
        let rest = if k < self.pair_count() {
            self.second[k] - base.second[k]
        } else {
            so3::log(&(self.rotation[k] * base.rotation[k].transpose()))
        };
        Vector6::new(dx.x, dx.y, dx.z, rest.x, rest.y, rest.z)
    }

    /// Copies `other` without allocating.
    pub fn copy_from(&mut self, other: &Configuration) {
        self.position.clone_from(&other.position);
        self.rotation.clone_from(&other.rotation);
        self.second.clone_from(&other.second);
    }

    /// Removes the round-off that repeated products leave in the rotations.
    pub fn orthonormalise(&mut self) {
        let pairs = self.pair_count();
        for rotation in &mut self.rotation[pairs..] {
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
        let base = Configuration::of_frames(
            vec![Vector3::new(1.0, 2.0, 3.0); 2],
            vec![so3::exp(&Vector3::new(0.3, -0.4, 1.0)); 2],
        );
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

    #[test]
    fn pairs_move_as_points_and_frames_behind_them_turn() {
        let turned = so3::exp(&Vector3::new(0.3, -0.4, 1.0));
        let base = Configuration {
            position: vec![Vector3::new(1.0, 2.0, 3.0); 2],
            rotation: vec![Matrix3::identity(), turned],
            second: vec![Vector3::new(4.0, 5.0, 6.0)],
        };
        // A "rotation" of more than half a turn: at a pair it is a way, and comes back whole.
        let increment = vec![
            Vector6::new(1.0, -1.0, 0.5, 20.0, 10.0, -7.0),
            Vector6::new(1.0, -1.0, 0.5, 0.2, 0.1, -0.7),
        ];
        let mut moved = base.clone();
        moved.retract(&increment);
        assert_eq!(moved.point(0, 0), Vector3::new(2.0, 1.0, 3.5));
        assert_eq!(moved.point(0, 1), Vector3::new(24.0, 15.0, -1.0));
        assert_eq!(moved.rotation[0], Matrix3::identity());
        for (got, want) in moved.difference(&base).iter().zip(&increment) {
            assert_relative_eq!(got, want, epsilon = 1e-13);
        }
    }
}
