//! The keys of `case.toml`.

use std::collections::BTreeMap;

use catenix_model::FormulationKind;
use catenix_results::VerifiedNumber;
use serde::Deserialize;

/// A verification case.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Spec {
    /// Title.
    pub title: String,
    /// Kind of problem; cases of one topic stand together.
    pub topic: String,
    /// What is computed, and what for.
    pub summary: String,
    /// Relative errors that are asked for, to hold the estimated errors against the true ones.
    #[serde(default)]
    pub accuracies: Vec<f64>,
    /// Single numbers.
    #[serde(default)]
    pub numbers: Vec<Number>,
    /// Curves.
    #[serde(default)]
    pub curves: Vec<Curve>,
    /// Orders of convergence.
    #[serde(default)]
    pub convergences: Vec<Convergence>,
}

/// Which analysis a result comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Analysis {
    Statics,
    Modes,
    Path,
    Dynamics,
}

/// What of a channel's history is taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Value {
    /// Time-weighted mean of the output times since `since`.
    Mean,
    /// Smallest value of all steps since `since`.
    Min,
    /// Largest value of all steps since `since`.
    Max,
    /// Last value.
    Last,
    /// Largest change since `since`, over the size then: what should be kept.
    Drift,
}

/// Where a number comes from.
#[derive(Debug, Clone, Deserialize)]
pub(super) struct Origin {
    /// The analysis.
    pub analysis: Analysis,
    /// Load case of the model file; absent: its first.
    pub load_case: Option<String>,
    /// A channel; or `frequency N` of the modes, equal pairs and rotations about the own axis
    /// counted once and not at all; or `rotation N`, among those rotations; or `limit N` or `bifurcation N`, a factor of the path; or
    /// `momentum`, `angular_momentum` and `energy` of the motion, for their drift.
    pub result: String,
    /// Which value of a history; needed for dynamics.
    pub value: Option<Value>,
    /// Time from which the value is taken [s].
    #[serde(default)]
    pub since: f64,
    /// Factor at which a channel of the path is read; the path must have a point there.
    pub at_factor: Option<f64>,
    /// Added to the computed value: what takes a position to a displacement, for example.
    #[serde(default)]
    pub offset: f64,
}

/// A number with its reference.
#[derive(Debug, Clone, Deserialize)]
pub(super) struct Number {
    /// What it is.
    pub name: String,
    #[serde(flatten)]
    pub origin: Origin,
    /// Into how many each element of the model file is split.
    #[serde(default = "one")]
    pub split: usize,
    /// Constant step [s]; absent: that of the model file.
    pub step: Option<f64>,
    /// The reference.
    pub reference: f64,
    /// Its unit, the one that the result has.
    #[serde(default)]
    pub unit: String,
    /// What the error is relative to; absent: the reference.
    pub scale: Option<f64>,
    /// Largest relative error that passes.
    pub tolerance: f64,
    /// Why this tolerance.
    pub reason: String,
    /// Only shown, without a verdict.
    #[serde(default)]
    pub shown: bool,
    /// What is different under other formulations than discrete elements.
    #[serde(default)]
    pub under: Under,
}

/// A curve with its reference.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Curve {
    /// What it is.
    pub name: String,
    /// `dynamics` or `path`.
    pub analysis: Analysis,
    /// Load case; absent: the first.
    pub load_case: Option<String>,
    /// Abscissa: `time`, `factor` or a channel.
    pub x: String,
    /// Ordinate: a channel or `factor`.
    pub y: String,
    /// Label of the abscissa; absent: made of `x`.
    pub x_label: Option<String>,
    /// Label of the ordinate; absent: made of `y`.
    pub y_label: Option<String>,
    /// CSV file with the reference: a header, then abscissa and ordinate.
    pub file: String,
    /// Into how many each element of the model file is split.
    #[serde(default = "one")]
    pub split: usize,
    /// Constant step [s]; absent: that of the model file.
    pub step: Option<f64>,
    /// Largest difference over the largest reference that passes.
    pub tolerance: f64,
    /// Why this tolerance, or what the curve shows.
    pub reason: String,
    /// Only shown, without a verdict.
    #[serde(default)]
    pub shown: bool,
    /// What is different under other formulations than discrete elements.
    #[serde(default)]
    pub under: Under,
}

/// A number on a series of meshes, or with a series of steps.
#[derive(Debug, Clone, Deserialize)]
pub(super) struct Convergence {
    /// What converges.
    pub name: String,
    #[serde(flatten)]
    pub origin: Origin,
    /// Into how many each element of the model file is split, coarse to fine.
    #[serde(default)]
    pub splits: Vec<usize>,
    /// Constant steps [s], long to short; instead of `splits`.
    #[serde(default)]
    pub steps: Vec<f64>,
    /// Constant step of a series of meshes [s]; absent: that of the model file.
    pub step: Option<f64>,
    /// The reference; absent: the last of the series, which then has no error of its own.
    pub reference: Option<f64>,
    /// What errors are relative to; absent: the reference.
    pub scale: Option<f64>,
    /// Smallest order that passes.
    pub least_order: f64,
    /// Errors of at most this size show no order: what is left is not of the mesh or step.
    #[serde(default)]
    pub floor: f64,
    /// Why this order is expected.
    pub reason: String,
    /// What is different under other formulations than discrete elements.
    #[serde(default)]
    pub under: Under,
}

/// What a comparison has its own of under other formulations, by their words; what stands under the
/// word before a hyphen holds for every formulation of that family which has no own.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(try_from = "BTreeMap<String, Special>")]
pub(super) struct Under(BTreeMap<String, Special>);

/// The part of a formulation's word before a hyphen.
fn family(word: &str) -> &str {
    word.split_once('-').map_or(word, |(family, _)| family)
}

impl TryFrom<BTreeMap<String, Special>> for Under {
    type Error = String;

    fn try_from(specials: BTreeMap<String, Special>) -> Result<Self, String> {
        let words = FormulationKind::ALL.map(FormulationKind::word);
        let known = |word: &String| words.iter().any(|own| own == word || family(own) == word);
        match specials.keys().find(|word| !known(word)) {
            Some(word) => Err(format!(
                "no formulation is called `{word}`; write one of {}",
                words.join(", ")
            )),
            None => Ok(Under(specials)),
        }
    }
}

/// What is different under a formulation: each key that is given replaces that of the comparison.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Special {
    pub tolerance: Option<f64>,
    pub least_order: Option<f64>,
    pub floor: Option<f64>,
    pub split: Option<usize>,
    pub splits: Option<Vec<usize>>,
    /// Why it is different.
    pub reason: Option<String>,
    /// Why the formulation cannot do this at all.
    pub refused: Option<String>,
}

impl Under {
    fn of(&self, formulation: FormulationKind) -> Option<&Special> {
        let word = formulation.word();
        self.0.get(word).or_else(|| self.0.get(family(word)))
    }
}

/// Puts what is given in place of what is there.
fn replace<T: Clone>(value: &mut T, given: &Option<T>) {
    if let Some(given) = given {
        value.clone_from(given);
    }
}

/// A comparison under a formulation, or why there is none.
pub(super) trait Comparison: Clone {
    fn under(&self) -> &Under;

    fn apply(&mut self, special: &Special);

    /// What is compared under `formulation`.
    ///
    /// # Errors
    /// Why the formulation cannot do it.
    fn adapted(&self, formulation: FormulationKind) -> Result<Self, String> {
        let mut adapted = self.clone();
        if let Some(special) = self.under().of(formulation) {
            if let Some(reason) = &special.refused {
                return Err(reason.clone());
            }
            adapted.apply(special);
        }
        Ok(adapted)
    }
}

impl Comparison for Number {
    fn under(&self) -> &Under {
        &self.under
    }

    fn apply(&mut self, special: &Special) {
        replace(&mut self.tolerance, &special.tolerance);
        replace(&mut self.split, &special.split);
        replace(&mut self.reason, &special.reason);
    }
}

impl Comparison for Curve {
    fn under(&self) -> &Under {
        &self.under
    }

    fn apply(&mut self, special: &Special) {
        replace(&mut self.tolerance, &special.tolerance);
        replace(&mut self.split, &special.split);
        replace(&mut self.reason, &special.reason);
    }
}

impl Comparison for Convergence {
    fn under(&self) -> &Under {
        &self.under
    }

    fn apply(&mut self, special: &Special) {
        replace(&mut self.least_order, &special.least_order);
        replace(&mut self.floor, &special.floor);
        replace(&mut self.splits, &special.splits);
        replace(&mut self.reason, &special.reason);
    }
}

fn one() -> usize {
    1
}

impl Number {
    /// The number where nothing could be computed.
    pub(super) fn not_computed(&self) -> VerifiedNumber {
        VerifiedNumber {
            name: self.name.clone(),
            unit: self.unit.clone(),
            reference: self.reference,
            computed: None,
            error: None,
            scale: self.scale.unwrap_or(self.reference.abs()),
            tolerance: self.tolerance,
            reason: self.reason.clone(),
            passed: (!self.shown).then_some(false),
        }
    }
}
