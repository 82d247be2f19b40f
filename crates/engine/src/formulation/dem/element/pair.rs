//! What every connector sees of the two frames it joins, and what it gives back.

use catenix_numerics::{Matrix3, Vector3, Vector6, six};

/// One side of a connector: the frame it is fixed to, seen at the connection point.
#[derive(Debug, Clone, Copy)]
pub struct Side {
    /// Position of the connection point, global (3) [m].
    pub point: Vector3,
    /// From the frame's origin to the connection point, global (3) [m].
    pub lever: Vector3,
    /// Connection axes to global axes: the first column points along the line from A to B.
    pub rotation: Matrix3,
    /// Velocity of the connection point, global (3) [m/s].
    pub velocity: Vector3,
    /// Angular velocity of the frame, global (3) [rad/s].
    pub spin: Vector3,
}

/// Generalised internal forces on the two frames, at their origins: the force, then the moment.
///
/// They are gradients of the stored energy (plus damping), so the frame *feels* their opposite.
#[derive(Debug, Clone, Copy)]
pub struct PairForces {
    /// On the first frame (6) [N, N m].
    pub first: Vector6,
    /// On the second frame (6) [N, N m].
    pub second: Vector6,
}

impl PairForces {
    pub(crate) fn new(force: &Vector3, first_moment: &Vector3, second_moment: &Vector3) -> Self {
        PairForces {
            first: six(&-force, first_moment),
            second: six(force, second_moment),
        }
    }
}

/// Derivative of a vector by the four increments of the pair.
///
/// The derivative by the first frame's translation is minus that by the second's.
#[derive(Debug, Clone, Copy)]
pub struct Sensitivity {
    /// By the second frame's translation.
    pub translation: Matrix3,
    /// By the first frame's rotation increment.
    pub first_rotation: Matrix3,
    /// By the second frame's rotation increment.
    pub second_rotation: Matrix3,
}

impl Sensitivity {
    pub(crate) const ZERO: Sensitivity = {
        let zero = Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
        Sensitivity {
            translation: zero,
            first_rotation: zero,
            second_rotation: zero,
        }
    };

    /// `matrix` times this.
    #[inline]
    pub(crate) fn led_by(&self, matrix: &Matrix3) -> Sensitivity {
        Sensitivity {
            translation: matrix * self.translation,
            first_rotation: matrix * self.first_rotation,
            second_rotation: matrix * self.second_rotation,
        }
    }

    #[inline]
    pub(crate) fn scaled(&self, factor: f64) -> Sensitivity {
        Sensitivity {
            translation: self.translation * factor,
            first_rotation: self.first_rotation * factor,
            second_rotation: self.second_rotation * factor,
        }
    }

    #[inline]
    pub(crate) fn plus(&self, other: &Sensitivity) -> Sensitivity {
        Sensitivity {
            translation: self.translation + other.translation,
            first_rotation: self.first_rotation + other.first_rotation,
            second_rotation: self.second_rotation + other.second_rotation,
        }
    }
}

/// Derivatives of [`PairForces`] by the increments of both frames.
#[derive(Debug, Clone, Copy)]
pub struct PairTangent {
    /// Of the force on the second frame; the first feels the opposite.
    pub force: Sensitivity,
    /// Of the moment on the first frame.
    pub first_moment: Sensitivity,
    /// Of the moment on the second frame.
    pub second_moment: Sensitivity,
}

impl PairTangent {
    /// Adds what moments (3) [N m] on the two frames do when they turn with these.
    ///
    /// Source: docs/theory/solver.md, eq. (6b).
    #[inline]
    pub(crate) fn turn_with(&mut self, [first, second]: [Vector3; 2]) {
        self.first_moment.first_rotation += first.cross_matrix();
        self.second_moment.second_rotation += second.cross_matrix();
    }
}

/// How velocities follow increments, for the damping part of a tangent.
#[derive(Debug, Clone, Copy)]
pub struct RateWeights {
    /// d velocity / d increment [1/s].
    pub velocity: f64,
    /// Factor on the rotation increments of the first and second frame.
    pub rotation: [Matrix3; 2],
}
