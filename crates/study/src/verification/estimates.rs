//! Estimated errors against true ones, where the answer is known.

use catenix_model::{DynamicsSettings, Study};
use catenix_results::VerifiedEstimate;

use super::results::load_case;
use super::spec::{Analysis, Number, Value};
use crate::accuracy::{Wanted, refined};
use crate::case::Halt;
use crate::watch::Watch;

/// How far the true error may exceed the estimate.
const MARGIN: f64 = 2.0;
/// Relative error below which the digits of the references say nothing.
const REFERENCE_DIGITS: f64 = 2e-6;

/// Can only stop.
struct Stop<'a>(&'a dyn Fn() -> bool);

impl Watch for Stop<'_> {
    fn statics(&self, _iteration: usize, _residual_n: f64) {}

    fn trial(&self, _number: usize, _elements: usize) {}

    fn modes(&self, _found: usize) {}

    fn motion(&self, _time_s: f64, _duration_s: f64) {}

    fn stop(&self) -> bool {
        (self.0)()
    }
}

/// The numbers of a case whose errors are estimated when the accuracy `target` is asked for: those
/// of statics and dynamics that are headline results there.
pub(super) fn verified_estimates(
    target: f64,
    numbers: &[Number],
    study: &Study,
    stop: &dyn Fn() -> bool,
) -> Result<Vec<VerifiedEstimate>, String> {
    let mut found = Vec::new();
    let mut load_cases: Vec<(Option<&str>, Wanted)> = Vec::new();
    let wanted_of = |number: &Number| match number.origin.analysis {
        Analysis::Statics => Some(Wanted::Statics),
        Analysis::Dynamics => Some(Wanted::Everything),
        Analysis::Modes | Analysis::Path => None,
    };
    for number in numbers.iter().filter(|number| !number.shown) {
        let name = number.origin.load_case.as_deref();
        if let Some(wanted) = wanted_of(number)
            && !load_cases.contains(&(name, wanted))
        {
            load_cases.push((name, wanted));
        }
    }
    for (name, wanted) in load_cases {
        let case = load_case(study, name)?;
        let (_, chosen) = refined(case, target, wanted, &Stop(stop)).map_err(in_words)?;
        let of_case = numbers.iter().filter(|number| {
            !number.shown
                && number.origin.load_case.as_deref() == name
                && wanted_of(number) == Some(wanted)
        });
        for number in of_case {
            let result = headline_name(number, wanted, case.model.dynamics.as_ref());
            let Some(estimate) = chosen.estimates.iter().find(|e| e.result == result) else {
                continue;
            };
            let difference = estimate.value + number.origin.offset - number.reference;
            let actual = difference.abs() / estimate.scale;
            let known = found
                .iter()
                .any(|known: &VerifiedEstimate| known.name == result && known.actual == actual);
            if known {
                continue;
            }
            found.push(VerifiedEstimate {
                name: result,
                target,
                elements: chosen.elements,
                estimated: estimate.relative(),
                actual,
                holds: actual <= MARGIN * estimate.relative() || actual <= REFERENCE_DIGITS,
            });
        }
    }
    Ok(found)
}

/// The name that a number has among headline results.
fn headline_name(number: &Number, wanted: Wanted, dynamics: Option<&DynamicsSettings>) -> String {
    let channel = &number.origin.result;
    let since = number.origin.since;
    let window_start = match dynamics {
        Some(dynamics) if wanted == Wanted::Everything => {
            dynamics.duration - dynamics.statistics_window
        }
        _ => return channel.clone(),
    };
    let statistic = match number.origin.value {
        Some(Value::Min) if since == 0.0 => "min",
        Some(Value::Max) if since == 0.0 => "max",
        Some(Value::Mean) if (since - window_start).abs() < 1e-6 => "mean",
        // The others are no headline results.
        _ => return String::new(),
    };
    format!("{channel}, {statistic}")
}

fn in_words(halt: Halt) -> String {
    match halt {
        Halt::Interrupted => "interrupted".to_owned(),
        Halt::Failed(error) => error.message,
    }
}
