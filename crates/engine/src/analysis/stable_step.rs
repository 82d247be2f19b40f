//! The largest stable step of explicit integration, measured against theory.
//!
//! Source: docs/theory/lumped.md, eqs. (25) to (28).

use catenix_numerics::{CentralDifferences, ExplicitSystem, MotionState, Vector6};

use super::statics::StaticSolution;
use crate::system::{System, SystemSolver};

/// Steps after which an unstable motion must have shown itself: 1 % beyond the limit it grows by 30 %
/// in each, or by 1 % where damping is heavy.
const TRIAL_STEPS: usize = 1500;
/// Largest growth of a stable motion.
const BOUNDED: f64 = 1e3;
/// Size of the disturbance, over the length of the longest line.
const DISTURBANCE: f64 = 1e-9;
/// Halvings of the bracket of a factor of 4.
const HALVINGS: usize = 12;

/// A measured limit beside that of theory.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StableStep {
    /// Largest step with which a small disturbance of the equilibrium stays small [s].
    pub measured_s: f64,
    /// The limit by theory [s].
    pub theory_s: f64,
}

/// Measures the largest step with which central differences stay stable about an equilibrium, by
/// bisection: a disturbance of all points either stays small or grows. Vessels stand still.
/// `None` where the formulation has no explicit integration.
pub fn measure_stable_step(
    system: &System,
    equilibrium: &StaticSolution<'_>,
) -> Option<StableStep> {
    if !system.formulation.has_mass_of_blocks() {
        return None;
    }
    let mut solver = SystemSolver::at_rest(system, system.model().statics.current);
    let still = MotionState::at_rest(equilibrium.configuration().clone());
    let mut start = still.clone();
    solver.accelerate(0.0, &mut start).ok()?;
    let theory_s = ExplicitSystem::stable_step(&mut solver, 0.0, &start);
    let size = DISTURBANCE * system.reference_length();
    // A velocity without any symmetry, so that no vibration is left out.
    for (k, velocity) in start.velocity.iter_mut().enumerate() {
        let x = k as f64;
        let noise = |row: usize| (12.9898 * x + 78.233 * row as f64 + 0.7).sin();
        *velocity = Vector6::from_fn(|row, _| noise(row) * size / theory_s);
    }
    solver.accelerate(0.0, &mut start).ok()?;
    let mut stable = |step: f64| {
        let mut integrator = CentralDifferences::new(f64::INFINITY, start.clone());
        integrator
            .advance_steps(&mut solver, 0.0, step, TRIAL_STEPS)
            .is_ok_and(|end| {
                let moved = end.configuration.difference(&still.configuration);
                moved
                    .iter()
                    .all(|d| d.amax() <= BOUNDED * size * TRIAL_STEPS as f64)
            })
    };
    let (mut low, mut high) = (0.5 * theory_s, 2.0 * theory_s);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if stable(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    Some(StableStep {
        measured_s: low,
        theory_s,
    })
}
