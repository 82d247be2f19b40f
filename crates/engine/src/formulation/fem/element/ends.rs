//! What every element sees of its two ends, and what it gives back.

use catenix_numerics::{Matrix3, Vector3};

/// The end of an element, and how it moves; all global.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct End {
    /// Position (3) [m].
    pub position: Vector3,
    /// Section axes to global axes: the first column points along the line from A to B.
    pub rotation: Matrix3,
    /// Velocity (3) [m/s].
    pub velocity: Vector3,
    /// Angular velocity (3) [rad/s].
    pub spin: Vector3,
    /// Acceleration (3) [m/s2].
    pub acceleration: Vector3,
    /// Angular acceleration (3) [rad/s2].
    pub angular_acceleration: Vector3,
}

/// Internal forces of an element on its ends, elastic and damping, as gradients of the stored
/// energy: an end *feels* their opposite.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ElementForces {
    /// Force on the second end; the first has the opposite (3) [N].
    pub force: Vector3,
    /// Moment on each end (2 x 3) [N m].
    pub moment: [Vector3; 2],
}

/// Derivatives of [`ElementForces`]: row 0 the force, rows 1 and 2 the moments; column 0 by the
/// second end's translation less the first's, columns 1 and 2 by the spins of the two ends.
pub type Blocks = [[Matrix3; 3]; 3];

/// All zeros.
pub const NO_BLOCKS: Blocks = {
    let zero = Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    [[zero; 3]; 3]
};

/// Derivatives of [`ElementForces`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ElementTangent {
    /// By increments of the configuration, with velocities and spins held.
    pub configuration: Blocks,
    /// By increments of velocities and spins; `None` without damping.
    pub rates: Option<Blocks>,
}

/// What the mixed Newton method predicts of an element: its deformation after the linear solution.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Prediction {
    /// Extension and, in the exact element, shear along local y and z (3) [-].
    pub strain: Vector3,
    /// Turns of the two ends against the corotational element's axes; in the exact element, first
    /// the rotation vector from end to end (2 x 3) [rad].
    pub turn: [Vector3; 2],
}

/// Turns blocks in the axes `e` to global axes.
#[inline]
pub(super) fn turned(blocks: &Blocks, e: &Matrix3) -> Blocks {
    let back = e.transpose();
    blocks.map(|row| row.map(|block| e * block * back))
}
