//! Finds motions that a static equilibrium does not resist.
//!
//! Inverse iteration on the tangent gives the softest motion. Spinning about the axis of a round
//! line, and turning of a body about its own centre, are held by a touch of stiffness: nothing
//! loads them, so they are no defect.
//!
//! Source: docs/theory/statics.md, eqs. (5) and (6).

use catenix_numerics::{
    ImplicitSystem, Matrix3, MotionState, TangentWeights, Vector3, Vector6, so3,
};
use nalgebra::Matrix6;

use crate::system::{System, SystemSolver};

/// Squared frequency below which a motion counts as free [rad2/s2]: a period of two days.
const FREE: f64 = 1e-9;
/// Squared frequency that spins are given, over the one that counts as free.
const SPIN: f64 = 1e3;
/// Share of the squared motion that may be left unexplained by a rigid motion.
const RIGID: f64 = 1e-4;
/// Rounds of inverse iteration; each separates a free motion from the next by many decades.
const ROUNDS: usize = 4;

/// A motion without resistance.
#[derive(Debug, Clone)]
pub(super) struct FreeMotion {
    /// Frame that moves most.
    pub frame: usize,
    /// Direction in which it moves.
    motion: Vector3,
    /// Whether the moving parts are weightless in water.
    weightless: bool,
    /// Whether they move as one rigid body.
    rigid: bool,
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

    /// Whether a joint leaves a rigid motion free, rather than the water or the weights leaving a
    /// soft one.
    pub(super) fn blames_a_joint(&self) -> bool {
        self.rigid && !self.weightless
    }

    pub(super) fn warning(&self, system: &System) -> String {
        format!(
            "the equilibrium is one of many: {} can move without resistance{}, since neither weight \
             nor water bring it back; its static position follows from the first shape",
            system.owner(self.frame),
            self.direction()
        )
    }
}

/// The softest motion about the equilibrium in `state`, if nothing resists it.
pub(super) fn find(solver: &mut SystemSolver<'_>, state: &mut MotionState) -> Option<FreeMotion> {
    let n = state.configuration.len();
    // Round-off in the matrix alone makes a free motion look as stiff as this.
    let free = solver.system().frequency_round_off().max(FREE);
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
            acceleration: 0.01 * free,
            rotation: None,
        };
        solver.begin();
        solver.assemble(0.0, state, Some(&weights), &mut residual);
        solver.hold_spins(state, SPIN * free, 0.0);
        let norm = dot(&mode, &forces).sqrt();
        let mut softest: Vec<Vector6> = forces.iter().map(|f| f / norm).collect();
        if solver.solve_carefully(&mut softest).is_err() {
            break;
        }
        mode = softest;
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
    if softest.abs() > free {
        return None;
    }
    let (frame, motion) = mode
        .iter()
        .map(|d| d.fixed_rows::<3>(0).into_owned())
        .enumerate()
        .max_by(|a, b| a.1.norm().total_cmp(&b.1.norm()))?;
    let largest = motion.norm();
    let moving: Vec<usize> = (0..n)
        .filter(|&k| mode[k].fixed_rows::<3>(0).norm() > 0.01 * largest)
        .collect();
    let weightless = moving.iter().all(|&k| solver.system().is_weightless(k));
    let rigid = moves_rigidly(&mode, &moving, state);
    Some(FreeMotion {
        frame,
        motion,
        weightless,
        rigid,
    })
}

/// Whether the translations of the moving frames are those of one rigid body, by least squares.
fn moves_rigidly(mode: &[Vector6], moving: &[usize], state: &MotionState) -> bool {
    let position = |k: usize| state.configuration.position[k];
    let centre = moving.iter().map(|&k| position(k)).sum::<Vector3>() / moving.len() as f64;
    let mut normal = Matrix6::zeros();
    let mut right = Vector6::zeros();
    let mut total = 0.0;
    for &k in moving {
        let mut map = nalgebra::Matrix3x6::<f64>::zeros();
        map.fixed_columns_mut::<3>(0)
            .copy_from(&Matrix3::identity());
        map.fixed_columns_mut::<3>(3)
            .copy_from(&-so3::hat(&(position(k) - centre)));
        let translation: Vector3 = mode[k].fixed_rows::<3>(0).into();
        normal += map.transpose() * map;
        right += map.transpose() * translation;
        total += translation.norm_squared();
    }
    // A straight line of frames leaves the rotation about itself open: pseudo-inverse.
    let scale = normal.diagonal().max();
    let Ok(solution) = normal.svd(true, true).solve(&right, 1e-10 * scale) else {
        return false;
    };
    let unexplained = total - solution.dot(&right);
    unexplained < RIGID * total
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
