//! The seam between solvers and systems: what a solver needs to know, and nothing of physics.

use crate::explicit::ExplicitSystem;
use crate::{Configuration, Matrix3, Vector6};

/// Configuration with its velocity and acceleration, all global.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct MotionState {
    /// Positions and rotations.
    pub configuration: Configuration,
    /// Velocity and angular velocity, (n) [m/s, rad/s]; of pairs, the velocities of both points.
    pub velocity: Vec<Vector6>,
    /// Acceleration and angular acceleration, (n) [m/s2, rad/s2].
    pub acceleration: Vec<Vector6>,
}

impl MotionState {
    /// At rest in `configuration`.
    pub fn at_rest(configuration: Configuration) -> MotionState {
        let zeros = vec![Vector6::zeros(); configuration.len()];
        MotionState {
            configuration,
            velocity: zeros.clone(),
            acceleration: zeros,
        }
    }
}

/// How velocity and acceleration follow an increment of the configuration.
#[derive(Debug, Clone, Copy)]
pub struct TangentWeights<'a> {
    /// d velocity / d increment [1/s].
    pub velocity: f64,
    /// d acceleration / d increment [1/s2].
    pub acceleration: f64,
    /// Per frame: d (rotation of the step) / d (rotation increment), the factor on the rotational
    /// part of both, (n); the identity at pairs of points. `None` stands for identities throughout.
    pub rotation: Option<&'a [Matrix3]>,
}

impl TangentWeights<'_> {
    /// Factor on the rotational part for frame `k`.
    #[inline]
    pub fn turn(&self, k: usize) -> Matrix3 {
        self.rotation.map_or(Matrix3::identity(), |list| list[k])
    }
}

/// A motion that is known beforehand, (n) each.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct CarriedMotion {
    /// Travel since the start; of a frame only the translation [m].
    pub travel: Vec<Vector6>,
    /// Its rate [m/s].
    pub velocity: Vec<Vector6>,
    /// Its second rate [m/s2].
    pub acceleration: Vec<Vector6>,
}

impl CarriedMotion {
    /// No motion of `n` blocks.
    pub fn none(n: usize) -> CarriedMotion {
        let zeros = vec![Vector6::zeros(); n];
        CarriedMotion {
            travel: zeros.clone(),
            velocity: zeros.clone(),
            acceleration: zeros,
        }
    }
}

/// The largest residual and where it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ResidualSize {
    /// Force, or moment over the frame's length [N].
    pub newtons: f64,
    /// Frame at which it occurs.
    pub frame: usize,
}

/// What a solver needs of a system.
pub trait ImplicitSystem {
    /// Number of frames.
    fn frame_count(&self) -> usize;

    /// Writes a motion that the supports of the system impose on it, as far as it is known
    /// beforehand, at `time`; returns whether there is any.
    ///
    /// Any twice differentiable motion is right. The closer it is to the true one, the smaller are
    /// the errors of a step: only the difference is integrated.
    ///
    /// Source: docs/theory/integration.md, eq. (17).
    fn carry(&mut self, time: f64, carried: &mut CarriedMotion) -> bool {
        let _ = (time, carried);
        false
    }

    /// Called before the first iteration of a solution, unless the last one converged and this one
    /// follows it in time.
    fn begin(&mut self);

    /// Writes the residual (inertia + internal - external forces, (n) [N, N m]) at `time` and,
    /// with `weights`, prepares the iteration matrix K + weights.velocity C + weights.acceleration M.
    fn assemble(
        &mut self,
        time: f64,
        state: &MotionState,
        weights: Option<&TangentWeights<'_>>,
        residual: &mut [Vector6],
    );

    /// increment <- -S^-1 residual, with the matrix of the last assembly.
    ///
    /// # Errors
    /// The frame whose pivot is singular.
    fn solve(&mut self, residual: &[Vector6], increment: &mut [Vector6]) -> Result<(), usize>;

    /// increment <- -S^-1 residual, with the matrix of the last [`Self::solve`].
    fn solve_again(&mut self, residual: &[Vector6], increment: &mut [Vector6]);

    /// Told of the increment that is about to be applied (the last solution, perhaps shortened).
    fn moving(&mut self, increment: &[Vector6]) {
        let _ = increment;
    }

    /// Told how far the first guess of a step is from the last solution, (n), where the matrix of
    /// that solution is to serve again.
    fn stepping(&mut self, travel: &[Vector6]) {
        let _ = travel;
    }

    /// The largest residual.
    fn residual_size(&self, residual: &[Vector6]) -> ResidualSize;

    /// How far an increment moves any point, at most [m]: the size of an error of the configuration.
    fn increment_size(&self, increment: &[Vector6]) -> f64;

    /// What an explicit integrator needs, where the system has it.
    fn explicit(&mut self) -> Option<&mut dyn ExplicitSystem> {
        None
    }
}
