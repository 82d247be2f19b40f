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
    /// Share of the error estimates of all cases that hold [-]; null without any.
    pub estimates_that_hold: Option<f64>,
    /// Cases in the order of their folders' names.
    pub cases: Vec<VerifiedCase>,
}

impl Verification {
    /// Share of estimates that must hold [-].
    pub const ESTIMATES_THAT_MUST_HOLD: f64 = 0.95;

    /// The outcome of a suite from those of its cases.
    ///
    /// It passes when every case does, and when the true error is within twice the estimate in
    /// 95 % of the estimates.
    pub fn new(catenix_version: &str, cases: Vec<VerifiedCase>) -> Verification {
        let estimates = || cases.iter().flat_map(|case| &case.estimates);
        let count = estimates().count();
        let share = estimates().filter(|estimate| estimate.holds).count() as f64 / count as f64;
        let estimates_that_hold = (count > 0).then_some(share);
        Verification {
            catenix_version: catenix_version.to_owned(),
            passed: cases.iter().all(|case| case.passed)
                && estimates_that_hold.is_none_or(|share| share >= Self::ESTIMATES_THAT_MUST_HOLD),
            estimates_that_hold,
            cases,
        }
    }
}

/// Outcome of one case.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct VerifiedCase {
    /// Name of the folder.
    pub name: String,
    /// Formulation under which it was computed, as in a model file.
    #[serde(default = "dem")]
    pub formulation: String,
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
    /// Why the formulation cannot do all of it; what it cannot do is not judged.
    #[serde(default)]
    pub refused: Vec<String>,
    /// Single numbers.
    pub numbers: Vec<VerifiedNumber>,
    /// Curves.
    pub curves: Vec<VerifiedCurve>,
    /// Orders of convergence.
    pub convergences: Vec<VerifiedConvergence>,
    /// Estimated errors beside the true ones.
    #[serde(default)]
    pub estimates: Vec<VerifiedEstimate>,
    /// Processor time [s].
    pub cpu_seconds: f64,
}

fn dem() -> String {
    "dem".to_owned()
}

impl VerifiedCase {
    /// Name with the formulation, where that is not discrete elements.
    pub fn label(&self) -> String {
        match self.formulation.as_str() {
            "dem" => self.name.clone(),
            formulation => format!("{}, {formulation}", self.name),
        }
    }

    /// Whether the formulation cannot do any of it.
    pub fn is_refused(&self) -> bool {
        let nothing = self.numbers.is_empty() && self.curves.is_empty();
        nothing && self.convergences.is_empty() && !self.refused.is_empty()
    }
}

/// The estimated error of a number with a known answer, on the mesh and with the step that a wanted
/// accuracy chose.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct VerifiedEstimate {
    /// Name of the number.
    pub name: String,
    /// Relative error that was asked for [-].
    pub target: f64,
    /// Elements that were chosen.
    pub elements: usize,
    /// Estimated error, of mesh and step together, over the scale of the result [-].
    pub estimated: f64,
    /// Difference from the reference over the same scale [-].
    pub actual: f64,
    /// Whether the true error is within twice the estimate, or as small as the digits of the
    /// reference.
    pub holds: bool,
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
