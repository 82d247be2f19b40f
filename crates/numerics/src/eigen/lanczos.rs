//! Lanczos iteration about a shift, for the eigenvalues of one slice.
//!
//! The operator is (K - sigma M)^-1 M, which turns the eigenvalues nearest to the shift into the
//! largest. Several starting vectors advance in turn (band Lanczos), so that equal eigenvalues are
//! met together, with full orthogonalisation in the metric of M.
//!
//! Source: docs/theory/modes.md, eqs. (9) to (12).

use nalgebra::{DMatrix, DVector, SymmetricEigen};

use super::pencil::Pencil;
use super::{Eigenpair, add_scaled, dot};
use crate::Vector6;

/// Starting vectors: pairs of round lines, and one to spare.
const STARTS: usize = 3;
/// Vectors at the end of the basis that (operator x vector) has a share in.
const BAND: usize = 2 * STARTS + 1;
/// Residual at which a pair counts as found, over its own eigenvalue of the operator. The step
/// of inverse iteration that follows leaves round-off.
const CONVERGED: f64 = 1e-9;
/// What is left of a vector, over what it was, when it lies in the basis already.
const NOTHING_LEFT: f64 = 1e-12;
/// New basis vectors between two looks at the eigenvalues.
const STRIDE: usize = 6;
/// Basis vectors beyond twice the wanted number before a new start is tried.
const SPARE: usize = 40;

/// Random numbers in -1 .. 1, the same in every run.
pub(super) struct Random(u64);

impl Random {
    pub(super) fn new(seed: u64) -> Random {
        Random(seed.wrapping_mul(2).wrapping_add(1))
    }

    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self, frames: usize) -> Vec<Vector6> {
        (0..frames)
            .map(|_| Vector6::from_fn(|_, _| self.next()))
            .collect()
    }
}

/// The basis with what the operator does to it.
struct Basis<'p, 'a> {
    pencil: &'p mut Pencil<'a>,
    /// Eigenvectors found before, kept out of the basis.
    known: Vec<Vec<Vector6>>,
    vectors: Vec<Vec<Vector6>>,
    /// Coefficients of (operator x vector j) in the basis, for each vector j that was advanced.
    columns: Vec<Vec<f64>>,
    inertia: Vec<Vector6>,
}

impl Basis<'_, '_> {
    /// x <- (K - sigma M)^-1 M x
    fn operate(&mut self, x: &mut [Vector6]) {
        self.pencil.mass_times(x, &mut self.inertia);
        x.copy_from_slice(&self.inertia);
        self.pencil.solve(x);
    }

    /// Appends what is new in `x`; returns its coefficients in the basis, the new one included.
    fn append(&mut self, mut x: Vec<Vector6>) -> Vec<f64> {
        let before = self.pencil.product(&x, &x).max(0.0).sqrt();
        let known = self.known.len();
        let mut coefficients = vec![0.0; known + self.vectors.len()];
        // In exact arithmetic only the last few vectors share anything; with those taken out, one
        // pass over all leaves no more than round-off.
        let recent = self.vectors.len().saturating_sub(BAND);
        for first in [known + recent, 0] {
            let all = self.known.iter().chain(&self.vectors).skip(first);
            let part = &mut coefficients[first..];
            self.pencil
                .orthogonalise(&mut x, &mut self.inertia, all, part);
        }
        coefficients.drain(..known);
        let norm = self.pencil.normalise(&mut x);
        if norm > NOTHING_LEFT * before {
            coefficients.push(norm);
            self.vectors.push(x);
        }
        coefficients
    }

    /// Appends a random vector, if there is a direction left.
    fn start(&mut self, random: &mut Random) {
        // Once through the operator: the basis is then free of what has no inertia.
        let mut x = random.vector(self.inertia.len());
        self.operate(&mut x);
        self.append(x);
    }

    fn advance(&mut self) {
        let mut x = self.vectors[self.columns.len()].clone();
        self.operate(&mut x);
        let column = self.append(x);
        self.columns.push(column);
    }

    /// Eigenvalues and vectors of the operator in the advanced part of the basis, with the
    /// residual of each.
    fn ritz(&self) -> Vec<(f64, DVector<f64>, f64)> {
        let m = self.columns.len();
        let entry = |row: usize, column: usize| -> f64 {
            self.columns[column].get(row).copied().unwrap_or(0.0)
        };
        let projected =
            DMatrix::from_fn(m, m, |row, column| entry(row.min(column), row.max(column)));
        let eigen = SymmetricEigen::new(projected);
        (0..m)
            .map(|k| {
                let s = eigen.eigenvectors.column(k).into_owned();
                let residual = (m..self.vectors.len())
                    .map(|row| (0..m).map(|j| entry(row, j) * s[j]).sum::<f64>().powi(2))
                    .sum::<f64>()
                    .sqrt();
                (eigen.eigenvalues[k], s, residual)
            })
            .collect()
    }

    /// The vector with coefficients `s`, after one more step of inverse iteration.
    fn eigenpair(&mut self, s: &DVector<f64>) -> Eigenpair {
        let mut x = vec![Vector6::zeros(); self.inertia.len()];
        for (vector, &factor) in self.vectors.iter().zip(s.iter()) {
            add_scaled(&mut x, factor, vector);
        }
        self.pencil.normalise(&mut x);
        self.pencil.mass_times(&x, &mut self.inertia);
        let mut y = self.inertia.clone();
        self.pencil.solve(&mut y);
        let theta = dot(&y, &self.inertia);
        self.pencil.normalise(&mut y);
        Eigenpair {
            value: self.pencil.shift() + 1.0 / theta,
            vector: y,
        }
    }
}

/// Eigenpairs with values in `low .. high` about the pencil's last shift, beyond the `known` ones:
/// `missing` of them, or fewer if they do not show up in one run.
pub(super) fn about_shift(
    pencil: &mut Pencil<'_>,
    [low, high]: [f64; 2],
    missing: usize,
    known: &[Eigenpair],
    random: &mut Random,
) -> Vec<Eigenpair> {
    let frames = pencil.dimension() / 6;
    let limit = (2 * missing + SPARE).min(pencil.dimension());
    let sigma = pencil.shift();
    let mut basis = Basis {
        pencil,
        known: known.iter().map(|pair| pair.vector.clone()).collect(),
        vectors: Vec::new(),
        columns: Vec::new(),
        inertia: vec![Vector6::zeros(); frames],
    };
    for _ in 0..STARTS {
        basis.start(random);
    }
    loop {
        while basis.columns.len() < basis.vectors.len() {
            basis.advance();
            if basis.columns.len().is_multiple_of(STRIDE) {
                break;
            }
        }
        // An invariant subspace is exhausted: go on from somewhere else, if anything is left.
        let exhausted = basis.columns.len() == basis.vectors.len();
        if exhausted {
            basis.start(random);
        }
        let complete = exhausted && basis.columns.len() == basis.vectors.len();
        let inside = |theta: f64| {
            let value = sigma + 1.0 / theta;
            theta != 0.0 && low < value && value < high
        };
        let found: Vec<_> = basis
            .ritz()
            .into_iter()
            .filter(|(theta, _, residual)| inside(*theta) && *residual <= CONVERGED * theta.abs())
            .collect();
        if found.len() >= missing || complete || basis.columns.len() >= limit {
            return found.iter().map(|(_, s, _)| basis.eigenpair(s)).collect();
        }
    }
}
