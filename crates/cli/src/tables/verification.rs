//! The outcome of a verification suite.

use catenix_results::{Verification, VerifiedCase};
use catenix_study::VerificationCase;

use super::grid::Grid;
use super::number::number;
use super::{heading, paragraph};

/// Names and titles of the cases.
pub(crate) fn suite_text(cases: &[&VerificationCase]) -> String {
    let mut grid = Grid::new(&[0, 1]);
    grid.header(["case", "title"]);
    for case in cases {
        grid.row([case.name.as_str(), case.title()]);
    }
    grid.text()
}

/// For each case: reference, computed value, error, tolerance and verdict.
pub(crate) fn verification_text(verification: &Verification) -> String {
    let mut text = String::new();
    for case in &verification.cases {
        text.push_str(&case_text(case));
    }
    if let Some(share) = verification.estimates_that_hold {
        let estimates = || verification.cases.iter().flat_map(|case| &case.estimates);
        text.push_str(&heading("Error estimates"));
        text.push_str(&paragraph(&format!(
            "The true error is within twice the estimate in {:.1} % of {} estimates ({:.0} % must be).",
            100.0 * share,
            estimates().count(),
            100.0 * Verification::ESTIMATES_THAT_MUST_HOLD
        )));
        let mut grid = Grid::new(&[0]);
        grid.header(["exceptions", "asked for", "estimated", "true"]);
        for estimate in estimates().filter(|estimate| !estimate.holds) {
            grid.row([
                estimate.name.clone(),
                small(estimate.target),
                small(estimate.estimated),
                small(estimate.actual),
            ]);
        }
        if share < 1.0 {
            text.push_str(&grid.text());
        }
    }
    let failed: Vec<String> = verification
        .cases
        .iter()
        .filter(|case| !case.passed)
        .map(VerifiedCase::label)
        .collect();
    let refused = verification
        .cases
        .iter()
        .filter(|case| case.is_refused())
        .count();
    let count = verification.cases.len() - refused;
    let time: f64 = verification.cases.iter().map(|case| case.cpu_seconds).sum();
    text.push_str(&match failed.as_slice() {
        [] if !verification.passed => "\nToo many error estimates FAILED.\n".to_owned(),
        [] if count == 1 => format!("\nThe case passed, in {time:.1} s of processor time.\n"),
        [] => format!("\nAll {count} cases passed, in {time:.1} s of processor time.\n"),
        failed => format!(
            "\n{} of {count} cases FAILED: {}.\n",
            failed.len(),
            failed.join("; ")
        ),
    });
    if refused > 0 {
        text.push_str(&format!(
            "{refused} more could not be computed by their formulation, for the reasons above.\n"
        ));
    }
    text
}

fn case_text(case: &VerifiedCase) -> String {
    let mut text = heading(&format!("{}: {}", case.label(), case.title));
    if !case.refused.is_empty() {
        let reasons = case.refused.join("; ");
        text.push_str(&paragraph(&format!("Not by this formulation: {reasons}")));
    }
    if case.is_refused() {
        return text;
    }
    let mut grid = Grid::new(&[0, 1]);
    grid.header([
        "",
        "unit",
        "reference",
        "computed",
        "error",
        "allowed",
        "verdict",
    ]);
    for item in &case.numbers {
        grid.row([
            item.name.clone(),
            item.unit.clone(),
            digits(item.reference),
            item.computed.map_or_else(|| "-".to_owned(), digits),
            item.error.map_or_else(|| "-".to_owned(), small),
            small(item.tolerance),
            verdict(item.passed),
        ]);
    }
    for item in &case.curves {
        grid.row([
            item.name.clone(),
            "curve".to_owned(),
            String::new(),
            String::new(),
            small(item.error),
            small(item.tolerance),
            verdict(item.passed),
        ]);
    }
    for item in &case.convergences {
        grid.row([
            item.name.clone(),
            "order".to_owned(),
            format!("{:.2}", item.least_order),
            format!("{:.2}", item.order),
            item.errors.last().copied().map_or_else(String::new, small),
            String::new(),
            verdict(Some(item.passed)),
        ]);
    }
    text.push_str(&grid.text());
    if let Some(error) = &case.error {
        text.push_str(&paragraph(&format!("Not computed: {error}")));
    }
    text
}

fn verdict(passed: Option<bool>) -> String {
    match passed {
        Some(true) => "passed",
        Some(false) => "FAILED",
        None => "shown",
    }
    .to_owned()
}

/// Seven significant digits, for numbers that agree in most of them.
fn digits(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 || !(1e-4..1e7).contains(&size) {
        return if size == 0.0 {
            "0".to_owned()
        } else {
            format!("{value:.6e}")
        };
    }
    let decimals = (6.0 - size.log10().floor()).clamp(0.0, 10.0) as usize;
    format!("{value:.decimals$}")
}

/// A relative error.
fn small(value: f64) -> String {
    if value == 0.0 {
        number(0.0)
    } else {
        format!("{value:.1e}")
    }
}
