//! The seam between time integrators and those who drive them.

use crate::implicit::{ImplicitSystem, MotionState, ResidualSize};
use crate::newton::{NewtonFailure, NewtonSettings};
use crate::{Matrix3, Vector6};

/// What a step must meet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepSettings {
    /// When Newton's method stops.
    pub newton: NewtonSettings,
    /// Local error of a step that is aimed at [m]; `None` where the steps are fixed.
    pub allowed_error: Option<f64>,
}

/// What a converged step took.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepOutcome {
    /// Newton iterations (matrix solutions).
    pub iterations: usize,
    /// Residual at the end.
    pub residual: ResidualSize,
    /// Order of the formula.
    pub order: usize,
    /// Estimated local error of the configuration, as [`ImplicitSystem::increment_size`] [m].
    pub local_error: f64,
    /// Factor on this step's size that the next step should have, or this one when its error is
    /// more than allowed; infinite where no error is set.
    pub growth: f64,
}

/// An implicit integrator with its current state.
pub trait Integrator {
    /// The state at the end of the last accepted step.
    fn state(&self) -> &MotionState;

    /// Tries a step of size `step` to `end_time`; [`Self::accept`] makes it the current state.
    ///
    /// # Errors
    /// [`NewtonFailure`]; the current state is untouched.
    fn advance(
        &mut self,
        system: &mut dyn ImplicitSystem,
        end_time: f64,
        step: f64,
        settings: &StepSettings,
    ) -> Result<StepOutcome, NewtonFailure>;

    /// Makes the last converged trial the current state.
    fn accept(&mut self);

    /// Forgets the past and starts from the current state with this acceleration, (n): the loads
    /// have jumped.
    fn restart(&mut self, acceleration: &[Vector6]);
}

/// Share of the step with just the allowed error that the next step aims at.
const SAFETY: f64 = 0.85;

/// Size of the next step over this one, from the error of a method of order `order`.
///
/// Source: docs/theory/integration.md, eq. (9).
pub(crate) fn growth(allowed_error: Option<f64>, local_error: f64, order: usize) -> f64 {
    let root = 1.0 / (order as f64 + 1.0);
    allowed_error.map_or(f64::INFINITY, |allowed| {
        SAFETY * (allowed / local_error.max(f64::MIN_POSITIVE)).powf(root)
    })
}

/// Adds a Newton increment to the travel of a step; `turns` are the inverse left Jacobians of its
/// rotations.
///
/// Source: docs/theory/integration.md, below eq. (6).
pub(crate) fn add_to_travel(travel: &mut [Vector6], increment: &[Vector6], turns: &[Matrix3]) {
    for ((travel, increment), turn) in travel.iter_mut().zip(increment).zip(turns) {
        let rotation = turn * increment.fixed_rows::<3>(3);
        for row in 0..3 {
            travel[row] += increment[row];
            travel[row + 3] += rotation[row];
        }
    }
}
