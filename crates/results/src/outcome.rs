//! How a load case ended, as the adapter tells it after the solver has returned.

use crate::layout;
use crate::summary::{CaseError, CaseSummary, Discretisation, Status};
use crate::zarr::Attributes;

/// End of a load case: status, error, and the solver's own account.
#[derive(Debug, Clone, PartialEq)]
pub struct CaseOutcome {
    /// How far the case came.
    pub status: Status,
    /// Why it failed.
    pub error: Option<CaseError>,
    /// Remarks of the solver.
    pub warnings: Vec<String>,
    /// The static solution, when there is one.
    pub statics: Option<StaticsFacts>,
    /// The motion, when there was one.
    pub dynamics: Option<DynamicsFacts>,
    /// Mesh, step and estimated errors, where an accuracy was asked for.
    pub discretisation: Option<Discretisation>,
    /// Processor time of the case [s].
    pub cpu_seconds: f64,
    /// Elapsed time of the case [s].
    pub wall_seconds: f64,
}

/// Account of a static solution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StaticsFacts {
    /// Iterations.
    pub iterations: usize,
    /// Largest residual force [N].
    pub residual_n: f64,
}

/// Account of a motion.
#[derive(Debug, Clone, PartialEq)]
pub struct DynamicsFacts {
    /// Simulated time that was reached [s].
    pub end_time_s: f64,
    /// Accepted steps.
    pub steps: usize,
    /// Steps that were tried and discarded.
    pub rejected_steps: usize,
    /// Accepted steps of each order of the integrator, from 1 to 5.
    pub steps_of_order: [usize; 5],
    /// Newton iterations.
    pub iterations: usize,
    /// Factorisations of the Newton matrix.
    pub factorisations: usize,
    /// Largest residual force left by an accepted step [N].
    pub residual_n: f64,
    /// The energy account: name with unit, for example `kinetic_j`, and value.
    pub energy: Vec<(&'static str, f64)>,
    /// Energy that the account does not explain, as a fraction [-].
    pub energy_imbalance: f64,
}

impl CaseOutcome {
    /// The outcome of a case that did not get to its static solution.
    pub fn without_results(status: Status, error: Option<CaseError>) -> Self {
        CaseOutcome {
            status,
            error,
            warnings: Vec::new(),
            statics: None,
            dynamics: None,
            discretisation: None,
            cpu_seconds: 0.0,
            wall_seconds: 0.0,
        }
    }

    /// The summary of the case as far as the solver's account goes, without results.
    pub fn summary(&self, description: &str) -> CaseSummary {
        let mut summary = CaseSummary::empty(description, self.status);
        summary.error = self.error.clone();
        summary.warnings = self.warnings.clone();
        summary.discretisation = self.discretisation.clone();
        summary.cpu_seconds = finite(self.cpu_seconds);
        summary.wall_seconds = finite(self.wall_seconds);
        if let Some(statics) = &self.statics {
            summary.static_iterations = Some(statics.iterations);
            summary.static_residual_n = finite(statics.residual_n);
        }
        if let Some(dynamics) = &self.dynamics {
            summary.simulated_s = finite(dynamics.end_time_s);
            summary.steps = Some(dynamics.steps);
            summary.rejected_steps = Some(dynamics.rejected_steps);
            summary.steps_of_order = Some(dynamics.steps_of_order);
            summary.iterations = Some(dynamics.iterations);
            summary.factorisations = Some(dynamics.factorisations);
            summary.residual_n = finite(dynamics.residual_n);
            summary.energy_imbalance = finite(dynamics.energy_imbalance);
            summary.real_time_factor = finite(dynamics.end_time_s / self.cpu_seconds);
        }
        summary
    }

    /// Writes the account into the attributes of the case.
    pub(crate) fn write_to(&self, attributes: &mut Attributes) {
        attributes.insert(layout::STATUS_KEY.into(), self.status.word().into());
        if let Some(error) = &self.error {
            attributes.insert("error_code".into(), error.code.as_str().into());
            attributes.insert("error_message".into(), error.message.as_str().into());
        }
        let mut insert = |key: &str, value: f64| attributes.insert(key.to_owned(), value.into());
        insert("cpu_seconds", self.cpu_seconds);
        insert("wall_seconds", self.wall_seconds);
        if let Some(statics) = &self.statics {
            insert("static_iterations", statics.iterations as f64);
            insert("static_residual_n", statics.residual_n);
        }
        if let Some(dynamics) = &self.dynamics {
            insert("simulated_s", dynamics.end_time_s);
            insert("solver_steps", dynamics.steps as f64);
            insert("solver_rejected_steps", dynamics.rejected_steps as f64);
            insert("solver_iterations", dynamics.iterations as f64);
            insert("solver_factorisations", dynamics.factorisations as f64);
            insert("solver_residual_n", dynamics.residual_n);
            insert("solver_mean_order", mean_order(&dynamics.steps_of_order));
            for (name, value) in &dynamics.energy {
                insert(&format!("energy_{name}"), *value);
            }
            insert("energy_imbalance", dynamics.energy_imbalance);
        }
    }
}

/// Mean order of the integrator over all steps; NaN without steps.
pub fn mean_order(steps_of_order: &[usize; 5]) -> f64 {
    let steps: usize = steps_of_order.iter().sum();
    let total: usize = steps_of_order
        .iter()
        .zip(1..)
        .map(|(count, order)| count * order)
        .sum();
    total as f64 / steps as f64
}

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}
