//! Finds motions that a static equilibrium does not resist.
//!
//! Inverse iteration on the tangent gives the softest motion. Spinning about the axis of a round
//! line, and turning of a body about its own centre, are held by a touch of stiffness: nothing
//! loads them, so they are no defect.
//!
//! Source: docs/theory/statics.md, eqs. (5) and (6).

use catenix_numerics::{ImplicitSystem, MotionState, TangentWeights, Vector3, Vector6};

use crate::system::{System, SystemSolver};

/// Squared frequency below which a motion counts as free [rad2/s2]: a period of two days.
const FREE: f64 = 1e-9;
/// Squared frequency that spins are given [rad2/s2].
const SPIN: f64 = 1e-6;
/// Rounds of inverse iteration; each separates a free motion from the next by many decades.
const ROUNDS: usize = 4;

/// A motion without resistance.
#[derive(Debug, Clone)]
pub(super) struct FreeMotion {
    /// Frame that moves most.
    pub frame: usize,
    /// Direction in which it moves.
    motion: Vector3,
    /// Whether the moving parts are weightless in water: then no joint is to blame.
    pub without_load: bool,
}

impl FreeMotion {
    /// Direction in words.
    pub(super) fn direction(&self) -> String {
        let names = ["x", "y", "z"];
        match self
            .motion
            .iter()
            .position(|c| c.abs() > 0.7 * self.motion.norm())
        {
            Some(axis) => format!(" along global {}", names[axis]),
            None => String::new(),
        }
    }

    pub(super) fn warning(&self, system: &System) -> String {
        format!(
            "the equilibrium is one of many: {} is weightless in water and can move without \
             resistance{}; its static position follows from the first shape",
            system.owner(self.frame),
            self.direction()
        )
    }
}

/// The softest motion about the equilibrium in `state`, if nothing resists it.
pub(super) fn find(solver: &mut SystemSolver<'_>, state: &mut MotionState) -> Option<FreeMotion> {
    let n = state.configuration.len();
    let mut residual = vec![Vector6::zeros(); n];
    let mut mode: Vec<Vector6> = (0..n)
        .map(|k| {
            // Any start without symmetry.
            let x = k as f64;
            Vector6::new(
                1.0 + (0.7 * x).sin(),
                (1.3 * x).cos(),
                0.4 + (0.9 * x).sin(),
                0.0,
                0.0,
                0.0,
            )
        })
        .collect();
    let mut softness = 0.0;
    for _ in 0..ROUNDS {
        let forces = inertia_of(solver, state, &mode, &mut residual);
        let weights = TangentWeights {
            velocity: 0.0,
            acceleration: 0.01 * FREE,
            rotation: None,
        };
        solver.begin();
        solver.assemble(0.0, state, Some(&weights), &mut residual);
        solver.hold_spins(state, SPIN);
        let norm = dot(&mode, &forces).sqrt();
        let load: Vec<Vector6> = forces.iter().map(|f| -f / norm).collect();
        if solver.solve(&load, &mut mode).is_err() {
            break;
        }
        let forces = inertia_of(solver, state, &mode, &mut residual);
        softness = dot(&mode, &forces).sqrt();
        if !softness.is_finite() {
            break;
        }
        mode.iter_mut().for_each(|d| *d /= softness);
    }
    solver.begin();
    solver.assemble(0.0, state, None, &mut residual);
    let softest = 1.0 / softness;
    if softest.abs() > FREE {
        return None;
    }
    let (frame, motion) = mode
        .iter()
        .map(|d| d.fixed_rows::<3>(0).into_owned())
        .enumerate()
        .max_by(|a, b| a.1.norm().total_cmp(&b.1.norm()))?;
    let largest = motion.norm();
    let without_load = mode
        .iter()
        .enumerate()
        .filter(|(_, d)| d.fixed_rows::<3>(0).norm() > 0.01 * largest)
        .all(|(k, _)| solver.system().is_weightless(k));
    Some(FreeMotion {
        frame,
        motion,
        without_load,
    })
}

/// Mass matrix times `acceleration`.
fn inertia_of(
    solver: &mut SystemSolver<'_>,
    state: &mut MotionState,
    acceleration: &[Vector6],
    residual: &mut [Vector6],
) -> Vec<Vector6> {
    solver.assemble(0.0, state, None, residual);
    let still = residual.to_vec();
    state.acceleration.copy_from_slice(acceleration);
    solver.assemble(0.0, state, None, residual);
    state.acceleration.fill(Vector6::zeros());
    residual
        .iter()
        .zip(&still)
        .map(|(with, without)| with - without)
        .collect()
}

fn dot(a: &[Vector6], b: &[Vector6]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(b)).sum::<f64>().abs()
}
