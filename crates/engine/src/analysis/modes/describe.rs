//! What an eigenvector means: where it moves, how, with which mass and damping.
//!
//! Source: docs/theory/modes.md, eqs. (14) to (17).

use catenix_numerics::eigen::{Eigenpair, Pencil, dot};
use catenix_numerics::{MotionState, Vector3, Vector6};
use nalgebra::{DMatrix, SymmetricEigen};

use super::{Mode, ModeKind};
use crate::system::System;

/// A way to move.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Motion {
    /// Elements across their axis, or bodies: along global x.
    X,
    /// Along global y.
    Y,
    /// Along global z.
    Z,
    /// Elements along their axis.
    Axial,
    /// Elements about their axis.
    Torsion,
    /// Bodies, about any axis.
    Rotation,
}

impl Motion {
    const ALL: [Motion; 6] = [
        Motion::X,
        Motion::Y,
        Motion::Z,
        Motion::Axial,
        Motion::Torsion,
        Motion::Rotation,
    ];
}

/// Share of the largest motion from which on another counts as large.
const ALIKE: f64 = 0.999;

/// Weights of the directions by which vectors of equal frequency are told apart: unlike each
/// other, x before y before z.
const DIRECTIONS: [f64; 3] = [1.0, 0.5, 0.25];

/// Turns the vectors of equal eigenvalues, which are any basis of their space, so that each moves
/// in one direction and in few lines, if such there are.
///
/// Source: docs/theory/modes.md, eq. (14).
pub(super) fn align_equal(
    system: &System,
    pencil: &Pencil<'_>,
    pairs: &mut [Eigenpair],
    equal: f64,
) {
    let mut start = 0;
    while start < pairs.len() {
        let first = pairs[start].value;
        let same = |pair: &Eigenpair| (pair.value - first).abs() <= equal * first.abs();
        let len = pairs[start..].iter().take_while(|pair| same(pair)).count();
        if len > 1 {
            align(system, pencil, &mut pairs[start..start + len]);
        }
        start += len.max(1);
    }
}

fn align(system: &System, pencil: &Pencil<'_>, group: &mut [Eigenpair]) {
    let line_weight = line_weights(system);
    let weighted = |vector: &[Vector6]| -> Vec<Vector6> {
        let moved: Vec<Vector6> = vector
            .iter()
            .zip(&line_weight)
            .enumerate()
            .map(|(k, (u, weight))| {
                let own = |axis: usize| {
                    // The second point of a pair, like the first.
                    let axis = if k < system.pair_count() {
                        axis % 3
                    } else {
                        axis
                    };
                    DIRECTIONS.get(axis).unwrap_or(&1.0) * weight
                };
                Vector6::from_fn(|axis, _| own(axis) * u[axis])
            })
            .collect();
        let mut forces = vec![Vector6::zeros(); moved.len()];
        pencil.mass_times(&moved, &mut forces);
        forces
    };
    let forces: Vec<Vec<Vector6>> = group.iter().map(|pair| weighted(&pair.vector)).collect();
    let n = group.len();
    let pair_len = group[0].vector.len();
    let matrix = DMatrix::from_fn(n, n, |row, column| {
        0.5 * (dot(&group[row].vector, &forces[column]) + dot(&group[column].vector, &forces[row]))
    });
    let eigen = SymmetricEigen::new(matrix);
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
    let turned: Vec<Vec<Vector6>> = order
        .iter()
        .map(|&column| {
            let mut vector = vec![Vector6::zeros(); pair_len];
            for (row, pair) in group.iter().enumerate() {
                let share = eigen.eigenvectors[(row, column)];
                catenix_numerics::eigen::add_scaled(&mut vector, share, &pair.vector);
            }
            vector
        })
        .collect();
    for (pair, vector) in group.iter_mut().zip(turned) {
        pair.vector = vector;
    }
}

/// A weight for each line and body, so that equal lines side by side are told apart.
fn line_weights(system: &System) -> Vec<f64> {
    let mut weights = vec![1.0; system.frame_count()];
    for (index, layout) in system.lines.iter().enumerate() {
        weights[layout.frames()].fill(1.0 + 0.01 * (system.lines.len() - index) as f64);
    }
    weights
}

/// Describes eigenpairs of one system.
pub(super) struct Describer<'s, 'p> {
    system: &'s System,
    state: MotionState,
    pencil: &'s Pencil<'p>,
    /// M r for r one along x, y and z.
    inertia_along: [Vec<Vector6>; 3],
}

impl<'s, 'p> Describer<'s, 'p> {
    pub(super) fn new(system: &'s System, state: &MotionState, pencil: &'s Pencil<'p>) -> Self {
        let inertia_along = [0, 1, 2].map(|axis| {
            let n = system.frame_count();
            let mut along = vec![Vector6::zeros(); n];
            for (k, along) in along.iter_mut().enumerate() {
                along[axis] = 1.0;
                if k < system.pair_count() {
                    along[axis + 3] = 1.0;
                }
            }
            let mut inertia = vec![Vector6::zeros(); n];
            pencil.mass_times(&along, &mut inertia);
            inertia
        });
        Describer {
            system,
            state: state.clone(),
            pencil,
            inertia_along,
        }
    }

    /// Mass that a shaking along x, y and z moves (3) [kg].
    pub(super) fn total_mass(&self) -> [f64; 3] {
        let pairs = self.system.pair_count();
        [0, 1, 2].map(|axis| {
            let forces = self.inertia_along[axis].iter().enumerate();
            let of = |(k, force): (usize, &Vector6)| match k < pairs {
                true => force[axis] + force[axis + 3],
                false => force[axis],
            };
            forces.map(of).sum()
        })
    }

    /// The mode of an eigenpair, whose structural damping is `damping` = x^T C x.
    pub(super) fn describe(&self, pair: Eigenpair, damping: f64) -> Mode {
        let Eigenpair { value, vector } = pair;
        let participation = |axis: usize| dot(&vector, &self.inertia_along[axis]);
        let effective_mass_kg = [0, 1, 2].map(|axis| participation(axis).powi(2));
        let motions = self.motions(&vector);
        let residual = self.residual(value, &vector);
        let turns = matches!(motions[0].0, Motion::Torsion | Motion::Rotation);
        let part = if turns { 3 } else { 0 };
        let pairs = self.system.pair_count();
        let motion = |k: usize, d: &Vector6| -> Vector3 {
            let own: Vector3 = d.fixed_rows::<3>(part).into();
            let other: Vector3 = d.fixed_rows::<3>(3).into();
            // Of a pair, the point that moves more; a pair does not turn.
            match (k < pairs, turns) {
                (true, true) => Vector3::zeros(),
                (true, false) if other.norm() > own.norm() => other,
                _ => own,
            }
        };
        let sizes = vector.iter().enumerate();
        let size = sizes.map(|(k, d)| motion(k, d).norm()).fold(0.0, f64::max);
        // Where many move alike, the last is named: a body, or the lower end of a line.
        let frame = (0..vector.len())
            .rfind(|&k| motion(k, &vector[k]).norm() >= ALIKE * size)
            .unwrap_or(0);
        let largest = motion(frame, &vector[frame]);
        // The largest component of the largest motion is positive.
        let sign = largest[largest.iamax()].signum();
        let scale = sign / size.max(f64::MIN_POSITIVE);
        Mode {
            kind: ModeKind::Vibration,
            omega_squared: value,
            damping_ratio: if value > 0.0 {
                0.5 * damping.max(0.0) / value.sqrt()
            } else {
                f64::NAN
            },
            effective_mass_kg,
            equals_previous: false,
            largest_at: self.system.owner(frame),
            motions,
            residual,
            shape: vector.iter().map(|d| d * scale).collect(),
        }
    }

    /// Shares of the kinetic energy, the largest first.
    fn motions(&self, x: &[Vector6]) -> Vec<(Motion, f64)> {
        let mut energy = [0.0; 6];
        let first_body = self.system.body_frame(0);
        let mut forces = vec![Vector6::zeros(); x.len()];
        self.pencil.mass_times(x, &mut forces);
        for (k, (d, force)) in x.iter().zip(&forces).enumerate() {
            let part = |d: &Vector6, row: usize| -> Vector3 { d.fixed_rows::<3>(row).into() };
            let (u, turn) = (part(d, 0), part(d, 3));
            let (f, moment) = (part(force, 0), part(force, 3));
            let translate = |energy: &mut [f64; 6], u: &Vector3, f: &Vector3| {
                for (share, product) in energy.iter_mut().zip(u.component_mul(f).iter()) {
                    *share += product;
                }
            };
            if k >= first_body {
                translate(&mut energy, &u, &f);
                energy[5] += turn.dot(&moment);
                continue;
            }
            let axis = self.system.formulation.axis(&self.state, k);
            if k < self.system.pair_count() {
                for (u, f) in [(u, f), (turn, moment)] {
                    let (along, force_along) = (axis.dot(&u), axis.dot(&f));
                    translate(&mut energy, &(u - axis * along), &(f - axis * force_along));
                    energy[3] += along * force_along;
                }
                continue;
            }
            let (along, force_along) = (axis.dot(&u), axis.dot(&f));
            translate(&mut energy, &(u - axis * along), &(f - axis * force_along));
            energy[3] += along * force_along;
            energy[4] += axis.dot(&turn) * axis.dot(&moment);
        }
        let energy = energy.map(|share| share.max(0.0));
        let total = energy.iter().sum::<f64>().max(f64::MIN_POSITIVE);
        let mut shares: Vec<(Motion, f64)> = Motion::ALL
            .into_iter()
            .zip(energy.map(|share| share / total))
            .collect();
        shares.sort_by(|a, b| b.1.total_cmp(&a.1));
        shares
    }

    /// Largest force or moment of K x - lambda M x, over the largest of lambda M x.
    fn residual(&self, value: f64, x: &[Vector6]) -> f64 {
        let mut inertia = vec![Vector6::zeros(); x.len()];
        self.pencil.mass_times(x, &mut inertia);
        let residual = self.pencil.residual(value, x);
        let (frames, pairs) = (&self.system.frames, self.system.pair_count());
        let size = |forces: &[Vector6]| {
            let newtons = |k: usize| {
                let force = forces[k].fixed_rows::<3>(0).norm();
                let rest = forces[k].fixed_rows::<3>(3).norm();
                let length = if k < pairs {
                    1.0
                } else {
                    frames[k].residual_length
                };
                force.max(rest / length)
            };
            (0..forces.len()).map(newtons).fold(0.0, f64::max)
        };
        size(&residual) / (value.abs() * size(&inertia)).max(f64::MIN_POSITIVE)
    }
}
