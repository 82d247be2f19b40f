//! Mathematics without physics: rotations, 6 x 6 blocks, the block solver for chains that meet at
//! junctions, its eigenvalues, and the implicit time integrator.
//!
//! Every unknown is a block of six: a *frame*, three translations and three rotations, or a pair of
//! points. Vectors over frames are slices of [`Vector6`], translation (or first point) first, all
//! components in the global axes. Rotations are updated by left multiplication: an increment
//! `theta` turns `R` into `exp(theta) R`.

mod alpha_passes;
mod bdf;
mod block;
mod chains;
mod column;
mod differences;
mod dispatch;
pub mod eigen;
mod explicit;
mod forecast;
mod frames;
mod generalised_alpha;
mod implicit;
mod integrator;
mod junctions;
pub mod lanes;
mod measure;
mod newton;
mod order;
mod passes;
pub mod so3;
pub mod spline;
mod sweep;
#[cfg(test)]
mod test_systems;
pub mod time_table;

pub use bdf::Bdf;
pub use block::{Block6, BlockLu, SingularBlock};
pub use chains::{BlockMatrix, Chain, FactorError, Factorisation, Topology};
pub use explicit::{CentralDifferences, ExplicitSystem, stability_limit};
pub use frames::Configuration;
pub use generalised_alpha::{AlphaParameters, GeneralisedAlpha};
pub use implicit::{CarriedMotion, ImplicitSystem, MotionState, ResidualSize, TangentWeights};
pub use integrator::{Integrator, StepOutcome, StepSettings};
pub use measure::BlockMeasure;
pub use newton::{NewtonFailure, NewtonSettings};
pub use sweep::Elimination;

/// Three components, global axes unless said otherwise.
pub type Vector3 = nalgebra::Vector3<f64>;
/// Three by three.
pub type Matrix3 = nalgebra::Matrix3<f64>;
/// Translation part first, then rotation part; at pairs of points, one after the other.
pub type Vector6 = nalgebra::Vector6<f64>;

/// Force and moment, or another pair of three components, as one vector.
#[inline]
pub fn six(upper: &Vector3, lower: &Vector3) -> Vector6 {
    Vector6::new(upper.x, upper.y, upper.z, lower.x, lower.y, lower.z)
}
