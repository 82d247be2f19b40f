//! What the page of a verification says, as texts in the places of the template.

use std::collections::BTreeSet;

use catenix_results::{
    Verification, VerifiedCase, VerifiedConvergence, VerifiedCurve, VerifiedEstimate,
    VerifiedNumber,
};
use minijinja::Value;
use serde::Serialize;

use super::charts::{convergence_chart, curve_chart, estimates_chart};
use crate::figure::{Chart, Drawing};
use crate::markdown;
use crate::number::{shortest, significant};
use crate::picture::file_stem;

/// Stands where there is no number.
const NONE: &str = "–";

/// The whole page.
#[derive(Debug, Serialize)]
pub(super) struct Page {
    version: String,
    verdict: Verdict,
    counts: Vec<Count>,
    cpu_time: String,
    estimates: Option<Estimates>,
    topics: Vec<Topic>,
}

/// How well errors are estimated where the answer is known.
#[derive(Debug, Serialize)]
struct Estimates {
    count: usize,
    /// Share that holds [%].
    share: String,
    /// Share that must hold [%].
    least_share: String,
    verdict: Verdict,
    svg: Value,
    exceptions: Vec<EstimateRow>,
}

#[derive(Debug, Serialize)]
struct EstimateRow {
    case: String,
    name: String,
    target: String,
    estimated: String,
    actual: String,
}

/// Cases of one kind of problem.
#[derive(Debug, Serialize)]
struct Topic {
    id: String,
    name: String,
    cases: Vec<Case>,
}

/// How many there are of one kind, by verdict.
#[derive(Debug, Serialize)]
struct Count {
    what: &'static str,
    passed: usize,
    failed: usize,
    shown: usize,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
enum Verdict {
    Passed,
    Failed,
    Shown,
}

#[derive(Debug, Serialize)]
struct Case {
    id: String,
    name: String,
    title: String,
    summary: String,
    source: Value,
    verdict: Verdict,
    error: Option<String>,
    worst: Option<Worst>,
    cpu_time: String,
    numbers: Vec<Number>,
    /// What all errors of the table are relative to, where that is one thing.
    relative_to: Option<String>,
    reasons: Vec<String>,
    curves: Vec<Figure>,
    convergences: Vec<Figure>,
}

/// The item of a case that uses most of its tolerance.
#[derive(Debug, Clone, Serialize)]
struct Worst {
    name: String,
    error: String,
    tolerance: String,
    share: String,
}

#[derive(Debug, Serialize)]
struct Number {
    name: String,
    /// What the error is relative to, where that is not the reference.
    relative_to: Option<String>,
    unit: String,
    reference: String,
    computed: String,
    error: String,
    tolerance: String,
    share: String,
    verdict: Verdict,
    /// Number of its reason among the reasons of the table, from 1; 0 where there is none.
    reason: usize,
}

#[derive(Debug, Serialize)]
struct Figure {
    id: String,
    name: String,
    svg: Value,
    /// Files below the page's directory, without their extension.
    file: String,
    verdict: Verdict,
    /// Names and values that belong to the verdict.
    facts: Vec<(&'static str, String)>,
    reason: String,
    /// Rows of numbers under the figure, each with its name.
    rows: Vec<(String, Vec<String>)>,
}

/// The page, and the names and drawings of the files beside it.
pub(super) fn page(report: &Verification) -> (Page, Vec<(String, Drawing)>) {
    let mut names = Names::default();
    let mut drawings = Vec::new();
    let mut topics: Vec<Topic> = Vec::new();
    for case in &report.cases {
        let view = Case::new(case, &mut names, &mut drawings);
        match topics.iter_mut().find(|topic| topic.name == case.topic) {
            Some(topic) => topic.cases.push(view),
            None => topics.push(Topic {
                id: names.unique(&format!("topic-{}", case.topic)),
                name: case.topic.clone(),
                cases: vec![view],
            }),
        }
    }
    let cases = &report.cases;
    let count = |what, verdicts: Vec<Verdict>| {
        let of = |wanted| {
            verdicts
                .iter()
                .filter(|verdict| **verdict == wanted)
                .count()
        };
        Count {
            what,
            passed: of(Verdict::Passed),
            failed: of(Verdict::Failed),
            shown: of(Verdict::Shown),
        }
    };
    let numbers = cases.iter().flat_map(|case| &case.numbers);
    let curves = cases.iter().flat_map(|case| &case.curves);
    let orders = cases.iter().flat_map(|case| &case.convergences);
    let page = Page {
        version: report.catenix_version.clone(),
        verdict: Verdict::of(Some(report.passed)),
        counts: vec![
            count("Cases", cases.iter().map(Verdict::of_case).collect()),
            count("Numbers", numbers.map(|n| Verdict::of(n.passed)).collect()),
            count("Curves", curves.map(|c| Verdict::of(c.passed)).collect()),
            count(
                "Orders of convergence",
                orders.map(|o| Verdict::of(Some(o.passed))).collect(),
            ),
        ],
        cpu_time: cpu_time(cases.iter().map(|case| case.cpu_seconds).sum()),
        estimates: Estimates::new(report, &mut drawings),
        topics,
    };
    (page, drawings)
}

impl Estimates {
    fn new(report: &Verification, drawings: &mut Vec<(String, Drawing)>) -> Option<Self> {
        let share = report.estimates_that_hold?;
        let cases = &report.cases;
        let estimates: Vec<&VerifiedEstimate> =
            cases.iter().flat_map(|case| &case.estimates).collect();
        let drawing = estimates_chart(&estimates).draw();
        let svg = Value::from_safe_string(drawing.to_svg());
        drawings.push(("error-estimates".to_owned(), drawing));
        let exceptions = cases.iter().flat_map(|case| {
            let failed = case.estimates.iter().filter(|estimate| !estimate.holds);
            failed.map(|estimate| EstimateRow {
                case: case.name.clone(),
                name: estimate.name.clone(),
                target: significant(estimate.target, 2),
                estimated: significant(estimate.estimated, 2),
                actual: significant(estimate.actual, 2),
            })
        });
        let least = Verification::ESTIMATES_THAT_MUST_HOLD;
        Some(Estimates {
            count: estimates.len(),
            share: format!("{:.1}", 100.0 * share),
            least_share: format!("{:.0}", 100.0 * least),
            verdict: Verdict::of(Some(share >= least)),
            svg,
            exceptions: exceptions.collect(),
        })
    }
}

/// Names that were given to parts of the page and to files.
#[derive(Default)]
struct Names(BTreeSet<String>);

impl Names {
    /// A name like the wanted one that nothing else has, on file systems without case either.
    fn unique(&mut self, wanted: &str) -> String {
        let stem = file_stem(wanted);
        let numbered = (2..).map(|number| format!("{stem}_{number}"));
        let mut free = std::iter::once(stem.clone())
            .chain(numbered)
            .filter(|name| self.0.insert(name.to_lowercase()));
        free.next().unwrap_or(stem)
    }
}

impl Verdict {
    fn of(passed: Option<bool>) -> Self {
        match passed {
            Some(true) => Verdict::Passed,
            Some(false) => Verdict::Failed,
            None => Verdict::Shown,
        }
    }

    /// A case without any verdict in it only shows something.
    fn of_case(case: &VerifiedCase) -> Self {
        let judges = case.numbers.iter().any(|number| number.passed.is_some())
            || case.curves.iter().any(|curve| curve.passed.is_some())
            || !case.convergences.is_empty();
        match (case.passed, judges) {
            (false, _) => Verdict::Failed,
            (true, true) => Verdict::Passed,
            (true, false) => Verdict::Shown,
        }
    }
}

impl Case {
    fn new(case: &VerifiedCase, names: &mut Names, drawings: &mut Vec<(String, Drawing)>) -> Self {
        let id = names.unique(&format!("case-{}", case.label().replace(", ", "-")));
        let mut drawn = 0;
        let mut figure = |chart: Chart, about: Figure| {
            drawn += 1;
            let stem = names.unique(&format!("{}-{drawn}", case.label().replace(", ", "-")));
            let drawing = chart.draw();
            let figure = Figure {
                id: format!("figure-{stem}"),
                svg: Value::from_safe_string(drawing.to_svg()),
                file: format!("figures/{stem}"),
                ..about
            };
            drawings.push((stem, drawing));
            figure
        };
        let curves = case.curves.iter();
        let curves = curves.map(|curve| figure(curve_chart(curve), Figure::of_curve(curve)));
        let curves = curves.collect();
        let convergences = case.convergences.iter();
        let convergences = convergences
            .map(|found| figure(convergence_chart(found), Figure::of_convergence(found)))
            .collect();
        let mut reasons: Vec<String> = Vec::new();
        let numbers = case.numbers.iter().map(|number| {
            let reason = match number.reason.as_str() {
                "" => 0,
                text => match reasons.iter().position(|known| known == text) {
                    Some(index) => index + 1,
                    None => {
                        reasons.push(text.to_owned());
                        reasons.len()
                    }
                },
            };
            Number::new(number, reason)
        });
        let mut numbers: Vec<Number> = numbers.collect();
        let relative_to = common_scale(&mut numbers);
        Case {
            id,
            name: case.label(),
            title: case.title.clone(),
            summary: case.summary.clone(),
            source: Value::from_safe_string(markdown::to_html(&case.source)),
            verdict: Verdict::of_case(case),
            error: case.error.clone().or_else(|| {
                let reasons = case.refused.join("; ");
                (!reasons.is_empty()).then(|| format!("not by this formulation: {reasons}"))
            }),
            worst: worst(case),
            cpu_time: cpu_time(case.cpu_seconds),
            numbers,
            relative_to,
            reasons,
            curves,
            convergences,
        }
    }
}

impl Number {
    fn new(number: &VerifiedNumber, reason: usize) -> Self {
        let VerifiedNumber {
            reference,
            computed,
            scale,
            ..
        } = *number;
        let digits = digits(reference, computed).max(given_digits(reference));
        let error = number.error.unwrap_or(f64::NAN);
        let relative_to = format!("{} {}", shortest(scale, 6), number.unit);
        let needs_saying = !is_by_reference(number) && !is_absolute(number);
        Number {
            name: number.name.clone(),
            relative_to: needs_saying.then(|| relative_to.trim_end().to_owned()),
            unit: number.unit.clone(),
            reference: shortest(reference, digits),
            computed: computed.map_or_else(|| NONE.to_owned(), |value| significant(value, digits)),
            error: error_of(number, error),
            tolerance: match number.passed {
                Some(_) => error_of(number, number.tolerance),
                None => NONE.to_owned(),
            },
            share: match number.passed {
                Some(_) => share(error / number.tolerance),
                None => NONE.to_owned(),
            },
            verdict: Verdict::of(number.passed),
            reason,
        }
    }
}

impl Figure {
    fn of_curve(curve: &VerifiedCurve) -> Self {
        let mut facts = vec![(
            "largest difference over the largest reference",
            relative(curve.error),
        )];
        if curve.passed.is_some() {
            facts.push(("tolerance", relative(curve.tolerance)));
            facts.push((
                "share of the tolerance",
                share(curve.error / curve.tolerance),
            ));
        }
        Figure::new(&curve.name, Verdict::of(curve.passed), facts, &curve.reason)
    }

    fn of_convergence(found: &VerifiedConvergence) -> Self {
        let facts = vec![
            ("observed order", significant(found.order, 3)),
            ("least order that passes", shortest(found.least_order, 3)),
        ];
        let verdict = Verdict::of(Some(found.passed));
        let x = found.x.iter().map(|x| shortest(*x, 6)).collect();
        let errors = found.errors.iter().map(|error| relative(*error)).collect();
        Figure {
            rows: vec![
                (found.x_label.clone(), x),
                ("relative error [-]".to_owned(), errors),
            ],
            ..Figure::new(&found.name, verdict, facts, &found.reason)
        }
    }

    fn new(name: &str, verdict: Verdict, facts: Vec<(&'static str, String)>, reason: &str) -> Self {
        Figure {
            id: String::new(),
            name: name.to_owned(),
            svg: Value::UNDEFINED,
            file: String::new(),
            verdict,
            facts,
            reason: reason.to_owned(),
            rows: Vec::new(),
        }
    }
}

/// The item that uses most of its tolerance; failed ones before others, and an order of
/// convergence, which has no tolerance, where it failed or nothing else has a verdict.
fn worst(case: &VerifiedCase) -> Option<Worst> {
    let numbers = case.numbers.iter().filter_map(|number| {
        let error = number.error.unwrap_or(f64::NAN);
        let texts = [error, number.tolerance].map(|value| error_of(number, value));
        Some((
            &number.name,
            texts,
            error / number.tolerance,
            number.passed?,
        ))
    });
    let curves = case.curves.iter().filter_map(|curve| {
        let texts = [curve.error, curve.tolerance].map(relative);
        let ratio = curve.error / curve.tolerance;
        Some((&curve.name, texts, ratio, curve.passed?))
    });
    let measured = numbers
        .chain(curves)
        .map(|(name, [error, tolerance], ratio, passed)| {
            let worst = Worst {
                name: name.clone(),
                error,
                tolerance,
                share: share(ratio),
            };
            // No number at all is worse than any.
            let ratio = if ratio.is_nan() { f64::INFINITY } else { ratio };
            (!passed, ratio, worst)
        });
    let orders = case.convergences.iter().map(|found| {
        let worst = Worst {
            name: found.name.clone(),
            error: format!("order {}", significant(found.order, 3)),
            tolerance: format!("at least {}", shortest(found.least_order, 3)),
            share: NONE.to_owned(),
        };
        (!found.passed, -1.0, worst)
    });
    measured
        .chain(orders)
        .max_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)))
        .map(|found| found.2)
}

/// Whether the error is relative to the reference; that may stand as scale with the digits that a
/// file keeps.
fn is_by_reference(number: &VerifiedNumber) -> bool {
    let (scale, reference) = (number.scale.abs(), number.reference.abs());
    (scale - reference).abs() <= 1e-9 * reference
}

/// Whether the error is one in the unit of the number itself.
fn is_absolute(number: &VerifiedNumber) -> bool {
    number.scale.abs() == 1.0 && !is_by_reference(number)
}

/// An error or tolerance of a number, with its unit where it has one.
fn error_of(number: &VerifiedNumber, error: f64) -> String {
    if !is_absolute(number) || number.unit.is_empty() || !error.is_finite() {
        return relative(error);
    }
    let text = match error {
        _ if (1e-3..1e5).contains(&error) => significant(error, 2),
        _ => relative(error),
    };
    format!("{text} {}", number.unit)
}

/// Takes what all errors are relative to out of the rows, where it is the same in all of several.
fn common_scale(numbers: &mut [Number]) -> Option<String> {
    let first = numbers.first()?.relative_to.clone()?;
    let is_common = |number: &Number| number.relative_to.as_deref() == Some(first.as_str());
    if numbers.len() < 2 || !numbers.iter().all(is_common) {
        return None;
    }
    for number in numbers {
        number.relative_to = None;
    }
    Some(first)
}

/// Digits that show where two numbers differ.
fn digits(reference: f64, computed: Option<f64>) -> usize {
    let difference = computed.map_or(0.0, |computed| (computed - reference).abs());
    let size = computed.map_or(0.0, f64::abs).max(reference.abs());
    if !(difference.is_finite() && difference > 0.0) {
        return 6;
    }
    let shown = size.log10().floor() - difference.log10().floor() + 2.0;
    shown.clamp(5.0, 10.0) as usize
}

/// Digits that a reference is given with, up to the seven that are enough for people.
fn given_digits(reference: f64) -> usize {
    let parse = |digits: &usize| format!("{reference:.*e}", digits - 1).parse::<f64>();
    let exact = |digits: &usize| parse(digits).is_ok_and(|rounded| rounded == reference);
    (1..=7).find(exact).unwrap_or(7)
}

/// An error in two digits.
fn relative(error: f64) -> String {
    match error {
        _ if !error.is_finite() => NONE.to_owned(),
        0.0 => "0".to_owned(),
        _ => power(error),
    }
}

/// Always as a power of ten, so that numbers below each other compare at a glance.
fn power(value: f64) -> String {
    let text = format!("{value:.1e}");
    let exponent = text
        .split_once('e')
        .and_then(|(_, e)| e.parse::<i32>().ok());
    let mantissa = text.split('e').next().unwrap_or_default();
    format!(
        "{mantissa}×10{}",
        crate::number::raised(exponent.unwrap_or_default())
    )
}

/// Error over tolerance in percent.
fn share(ratio: f64) -> String {
    let percent = 100.0 * ratio;
    match percent {
        _ if !percent.is_finite() => NONE.to_owned(),
        _ if percent < 0.1 => "< 0.1 %".to_owned(),
        _ if percent < 10.0 => format!("{percent:.1} %"),
        _ if percent < 1e4 => format!("{percent:.0} %"),
        _ => format!("{} %", power(percent)),
    }
}

fn cpu_time(seconds: f64) -> String {
    match seconds {
        _ if !seconds.is_finite() => NONE.to_owned(),
        _ if seconds < 0.1 => "< 0.1 s".to_owned(),
        _ if seconds < 100.0 => format!("{seconds:.1} s"),
        _ => format!("{seconds:.0} s"),
    }
}
