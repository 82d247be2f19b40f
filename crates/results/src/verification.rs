//! The outcome of a verification suite: reference, computed value, error, tolerance and verdict.
//!
//! The keys are a public interface, described in docs/verification.md.

use serde::{Deserialize, Serialize};

/// Outcome of a suite.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Verification {
    /// Version of Catenix that computed it.
    pub catenix_version: String,
    /// Whether every verdict is "passed".
    pub passed: bool,
    /// Cases in the order of their folders' names.
    pub cases: Vec<VerifiedCase>,
}

/// Outcome of one case.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct VerifiedCase {
    /// Name of the folder.
    pub name: String,
    /// Title.
    pub title: String,
    /// What kind of problem it is, for example "Vibration"; cases of one topic stand together.
    pub topic: String,
    /// What is computed and what for, in a few sentences.
    pub summary: String,
    /// Text of the SOURCE note, Markdown.
    pub source: String,
    /// Whether everything in it passed.
    pub passed: bool,
    /// Why nothing, or not everything, could be computed.
    pub error: Option<String>,
    /// Single numbers.
    pub numbers: Vec<VerifiedNumber>,
    /// Curves.
    pub curves: Vec<VerifiedCurve>,
    /// Orders of convergence.
    pub convergences: Vec<VerifiedConvergence>,
    /// Processor time [s].
    pub cpu_seconds: f64,
}

/// A number beside its reference.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct VerifiedNumber {
    /// What it is.
    pub name: String,
    /// Unit of reference and computed value; empty for a pure number.
    pub unit: String,
    /// The reference.
    pub reference: f64,
    /// The computed value; null when there is none.
    pub computed: Option<f64>,
    /// Error over `scale` [-].
    pub error: Option<f64>,
    /// What the error is relative to, in `unit`: the reference unless the case says otherwise.
    pub scale: f64,
    /// Largest error that passes [-].
    pub tolerance: f64,
    /// Why this tolerance.
    pub reason: String,
    /// Whether it passed; `None` where it is only shown.
    pub passed: Option<bool>,
}

/// A computed curve beside its reference.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct VerifiedCurve {
    /// What it is.
    pub name: String,
    /// Abscissa with its unit, for example `time [s]`.
    pub x_label: String,
    /// Ordinate with its unit.
    pub y_label: String,
    /// Computed points (n).
    pub x: Vec<f64>,
    /// Computed points (n).
    pub computed: Vec<f64>,
    /// The reference at the same abscissas (n).
    pub reference: Vec<f64>,
    /// Largest difference over the largest reference [-].
    pub error: f64,
    /// Largest error that passes [-].
    pub tolerance: f64,
    /// Why this tolerance, or what the curve shows.
    pub reason: String,
    /// Whether it passed; `None` where it is only shown.
    pub passed: Option<bool>,
}

/// Errors on a series of meshes or steps, and their order.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct VerifiedConvergence {
    /// What converges.
    pub name: String,
    /// What is refined: `elements` or `step [s]`.
    pub x_label: String,
    /// Number of elements, or step [s] (n).
    pub x: Vec<f64>,
    /// Relative error (n) [-].
    pub errors: Vec<f64>,
    /// Order by least squares through the errors [-].
    pub order: f64,
    /// Smallest order that passes [-].
    pub least_order: f64,
    /// Why this order is expected.
    pub reason: String,
    /// Whether it passed.
    pub passed: bool,
}
