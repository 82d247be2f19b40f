//! Two symmetric matrices on a topology, K and M, and the factors of K - sigma M.

use super::{add_scaled, dot};
use crate::{BlockMatrix, Factorisation, Topology, Vector6};

/// Relative move of a shift that hit an eigenvalue, and how often it is tried.
const NUDGE: f64 = 1e-7;
const NUDGES: usize = 8;

/// K and M, with the factors of K - sigma M for the last shift sigma.
#[derive(Debug, Clone)]
pub struct Pencil<'a> {
    topology: &'a Topology,
    stiffness: BlockMatrix,
    mass: BlockMatrix,
    shifted: BlockMatrix,
    factors: Factorisation,
    shift: f64,
}

impl<'a> Pencil<'a> {
    /// The pencil of the symmetric part of `stiffness` and the symmetric `mass`.
    pub fn new(topology: &'a Topology, stiffness: &BlockMatrix, mass: BlockMatrix) -> Pencil<'a> {
        let stiffness = stiffness.symmetric_part();
        Pencil {
            topology,
            shifted: stiffness.clone(),
            stiffness,
            mass,
            factors: Factorisation::new(topology),
            shift: f64::NAN,
        }
    }

    /// Number of unknowns.
    pub fn dimension(&self) -> usize {
        6 * self.topology.frame_count()
    }

    /// The shift of the factors.
    pub fn shift(&self) -> f64 {
        self.shift
    }

    /// Factorises K - sigma M and counts the eigenvalues below sigma.
    ///
    /// A shift that hits an eigenvalue is moved by a hair. `None` when nothing helps.
    ///
    /// Source: docs/theory/modes.md, eqs. (7) and (8).
    pub fn factorise(&mut self, sigma: f64) -> Option<usize> {
        for nudge in 0..NUDGES {
            let sigma = sigma + NUDGE * nudge as f64 * sigma.abs().max(f64::MIN_POSITIVE);
            self.shifted.set_sum(&self.stiffness, -sigma, &self.mass);
            if self.factors.factorise(self.topology, &self.shifted).is_ok() {
                self.shift = sigma;
                return Some(self.factors.negative_eigenvalues());
            }
        }
        None
    }

    /// x <- (K - sigma M)^-1 x with the last factors.
    pub fn solve(&mut self, x: &mut [Vector6]) {
        self.factors.solve(self.topology, x);
    }

    /// y <- M x
    pub fn mass_times(&self, x: &[Vector6], y: &mut [Vector6]) {
        self.mass.times(self.topology, x, y);
    }

    /// K x - lambda M x (frame_count).
    pub fn residual(&self, lambda: f64, x: &[Vector6]) -> Vec<Vector6> {
        let mut residual = vec![Vector6::zeros(); x.len()];
        self.mass_times(x, &mut residual);
        residual.iter_mut().for_each(|force| *force *= lambda);
        self.stiffness
            .subtract_times(self.topology, x, &mut residual);
        residual.iter_mut().for_each(|force| *force *= -1.0);
        residual
    }

    /// K x (frame_count).
    pub fn stiffness_times(&self, x: &[Vector6]) -> Vec<Vector6> {
        self.residual(0.0, x)
    }

    /// x^T M y
    pub fn product(&self, x: &[Vector6], y: &[Vector6]) -> f64 {
        let mut inertia = vec![Vector6::zeros(); y.len()];
        self.mass_times(y, &mut inertia);
        dot(x, &inertia)
    }

    /// Makes x^T M x = 1; returns what its root was.
    pub(super) fn normalise(&self, x: &mut [Vector6]) -> f64 {
        let norm = self.product(x, x).max(0.0).sqrt();
        if norm > 0.0 {
            x.iter_mut().for_each(|d| *d /= norm);
        }
        norm
    }

    /// Takes from `x` what it shares with M-orthonormal vectors; adds the coefficients to
    /// `coefficients`.
    pub(super) fn orthogonalise<'v>(
        &self,
        x: &mut [Vector6],
        inertia: &mut [Vector6],
        against: impl Iterator<Item = &'v Vec<Vector6>>,
        coefficients: &mut [f64],
    ) {
        self.mass_times(x, inertia);
        for (vector, coefficient) in against.zip(coefficients) {
            let share = dot(vector, inertia);
            *coefficient += share;
            add_scaled(x, -share, vector);
        }
    }
}
