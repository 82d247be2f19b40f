//! The symmetric eigenproblem K x = lambda M x on chains that meet at junctions.
//!
//! Factorising K - sigma M costs little here, so the spectrum is cut into slices by counting
//! eigenvalues below shifts, and each slice is solved about a shift of its own. The counts prove
//! that no eigenvalue is missing, also where several are equal.
//!
//! Source: docs/theory/modes.md, eqs. (6) to (13).

mod lanczos;
mod pencil;
mod slices;
#[cfg(test)]
mod tests;

pub use pencil::Pencil;
pub use slices::{Count, EigenError, Spectrum};

use crate::Vector6;

/// An eigenvalue with its vector.
#[derive(Debug, Clone)]
pub struct Eigenpair {
    /// lambda in K x = lambda M x.
    pub value: f64,
    /// x, with x^T M x = 1, (frame_count).
    pub vector: Vec<Vector6>,
}

/// a . b
pub fn dot(a: &[Vector6], b: &[Vector6]) -> f64 {
    let mut sum = Vector6::zeros();
    for (a, b) in a.iter().zip(b) {
        sum += a.component_mul(b);
    }
    sum.sum()
}

/// y += factor x
pub fn add_scaled(y: &mut [Vector6], factor: f64, x: &[Vector6]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y += x * factor;
    }
}
