//! The configuration of a set of blocks, and the increments that change it.

use crate::lanes::{self, Kernel, Lane, Mat3, Vec3, gather, put_records, vectorised};
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
    /// What rounding leaves of a rotation beside the rotations is removed.
    /// Source: docs/theory/rotations.md, eqs. (5), (5a) and (7).
    pub fn retract(&mut self, increment: &[Vector6]) {
        vectorised(Retraction {
            base: None,
            moved: self,
            increment,
        });
    }

    /// Becomes `base`, of the same blocks, moved by its increment: [`Self::retract`] of a copy.
    pub fn retract_from(&mut self, base: &Configuration, increment: &[Vector6]) {
        vectorised(Retraction {
            base: Some(base),
            moved: self,
            increment,
        });
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

struct Retraction<'a> {
    /// What is moved; `None` where that is `moved` itself.
    base: Option<&'a Configuration>,
    moved: &'a mut Configuration,
    increment: &'a [Vector6],
}

impl Kernel for Retraction<'_> {
    type Output = ();

    #[inline(always)]
    fn run<T: Lane>(self, token: T::Token) {
        let Retraction {
            base,
            moved,
            increment,
        } = self;
        let pairs = moved.pair_count();
        let mut k = 0;
        while k < increment.len() {
            let (d, x) = (&increment[k], base.unwrap_or(moved).position[k]);
            moved.position[k] = Vector3::new(x[0] + d[0], x[1] + d[1], x[2] + d[2]);
            k += 1;
        }
        let mut k = 0;
        while k < pairs {
            let (d, x) = (&increment[k], base.unwrap_or(moved).second[k]);
            moved.second[k] = Vector3::new(x[0] + d[3], x[1] + d[4], x[2] + d[5]);
            k += 1;
        }
        let mut first = pairs;
        while first < increment.len() {
            let count = (increment.len() - first).min(T::COUNT);
            let [_, _, _, a, b, c] = gather::<T, _, 6>(token, increment, first);
            let rotation = &base.unwrap_or(moved).rotation;
            let rotation = Mat3::<T>::of(gather(token, rotation, first));
            let turned = lanes::exp(Vec3::new(a, b, c)).product(rotation);
            let entries = lanes::orthonormalise(turned).entries();
            put_records(&entries, &mut moved.rotation, first, count);
            first += T::COUNT;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::on_every_instruction_set;
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

    /// Moves of `pairs` pairs and some frames, small and large.
    fn moves(pairs: usize, n: usize) -> (Configuration, Vec<Vector6>) {
        let vector = |k: usize, seed: f64| {
            let k = k as f64 + seed;
            Vector3::new((1.3 * k).sin(), (2.1 * k).cos(), (0.7 * k).sin())
        };
        let base = Configuration {
            position: (0..n).map(|k| vector(k, 0.1) * 1e3).collect(),
            rotation: (0..n)
                .map(|k| match k < pairs {
                    true => Matrix3::identity(),
                    false => so3::exp(&(vector(k, 0.2) * 1.5)),
                })
                .collect(),
            second: (0..pairs).map(|k| vector(k, 0.3) * 1e3).collect(),
        };
        let of = |k: usize| {
            let (way, turn) = (vector(k, 0.4), vector(k, 0.5) * 10f64.powi(-(k as i32 % 7)));
            Vector6::new(way.x, way.y, way.z, turn.x, turn.y, turn.z)
        };
        (base, (0..n).map(of).collect())
    }

    #[test]
    fn lanes_move_blocks_as_they_move_one_by_one() {
        for (pairs, n) in [(0, 1), (0, 8), (0, 21), (3, 3), (5, 18), (1, 9)] {
            let (base, increment) = moves(pairs, n);
            let alone = |k: usize| -> Matrix3 {
                let turn = increment[k].fixed_rows::<3>(3).into_owned();
                match k < pairs {
                    true => base.rotation[k],
                    false => so3::orthonormalise(&(so3::exp(&turn) * base.rotation[k])),
                }
            };
            for in_place in [false, true] {
                let moved = on_every_instruction_set(|| Moving {
                    base: &base,
                    increment: &increment,
                    in_place,
                });
                for moved in moved {
                    for (k, d) in increment.iter().enumerate() {
                        let (first, second) = (d.fixed_rows::<3>(0), d.fixed_rows::<3>(3));
                        assert_eq!(moved.position[k], base.position[k] + first);
                        // A few roundings of entries of size 1.
                        assert!((moved.rotation[k] - alone(k)).amax() < 3e-15);
                        if k < pairs {
                            assert_eq!(moved.second[k], base.second[k] + second);
                        }
                    }
                }
            }
        }
    }

    /// A retraction of a copy, or of the blocks themselves.
    struct Moving<'a> {
        base: &'a Configuration,
        increment: &'a [Vector6],
        in_place: bool,
    }

    impl Kernel for Moving<'_> {
        type Output = Configuration;

        #[inline(always)]
        fn run<T: Lane>(self, token: T::Token) -> Configuration {
            let mut moved = self.base.clone();
            let base = match self.in_place {
                true => None,
                false => {
                    moved.position.fill(Vector3::zeros());
                    moved.second.fill(Vector3::zeros());
                    Some(self.base)
                }
            };
            let retraction = Retraction {
                base,
                moved: &mut moved,
                increment: self.increment,
            };
            retraction.run::<T>(token);
            moved
        }
    }
}
