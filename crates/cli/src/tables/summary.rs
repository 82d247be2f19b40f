//! The summary of a run.

use std::path::{Path, PathBuf};

use catenix_results::{CaseSummary, EndSummary, Extent, LineSummary, Status, Summary};

use super::grid::Grid;
use super::number::{count, fixed, maybe, number};
use super::{CASES_PER_TABLE, heading, paragraph, remark};

/// Published against computed figures, then results and solver statistics of each case.
pub(crate) fn summary_text(summary: &Summary) -> String {
    let mut text = heading(&summary.title);
    if summary.status != Status::Complete {
        text.push_str(&format!("{}\n", status_sentence(summary.status)));
    }
    let compared = published(summary);
    if !compared.is_empty() {
        text.push_str(&compared);
    }
    if !summary.note.is_empty() {
        text.push('\n');
        text.push_str(&remark(&summary.note));
    }
    text.push('\n');
    let cases: Vec<(&String, &CaseSummary)> = summary.cases.iter().collect();
    for cases in cases.chunks(CASES_PER_TABLE) {
        text.push_str(&results(cases));
        text.push('\n');
    }
    text.push_str(&errors_text(summary));
    text
}

/// Paths that were written; a figure's two formats share a line.
pub(crate) fn files_text(results: &Path, files: &[PathBuf]) -> String {
    let mut text = format!("Written: {}\n", results.display());
    for file in files
        .iter()
        .filter(|file| file.extension().is_none_or(|end| end != "png"))
    {
        let and_png = if file.extension().is_some_and(|end| end == "svg") {
            ", .png"
        } else {
            ""
        };
        text.push_str(&format!("         {}{and_png}\n", file.display()));
    }
    text
}

/// Errors and remarks of the cases, one paragraph each.
pub(crate) fn errors_text(summary: &Summary) -> String {
    let mut text = String::new();
    for (name, case) in &summary.cases {
        if let Some(error) = &case.error {
            text.push_str(&paragraph(&format!(
                "Case {name} failed: {}",
                error.message
            )));
        }
    }
    // The cases of a study often share a remark: print it once.
    let mut remarks: Vec<(&String, Vec<&str>)> = Vec::new();
    for (name, case) in &summary.cases {
        for warning in &case.warnings {
            match remarks.iter_mut().find(|(known, _)| *known == warning) {
                Some((_, names)) => names.push(name),
                None => remarks.push((warning, vec![name])),
            }
        }
    }
    for (warning, names) in remarks {
        text.push_str(&paragraph(&format!("Case {}: {warning}", names.join(", "))));
    }
    text
}

fn status_sentence(status: Status) -> &'static str {
    match status {
        Status::Complete => "",
        Status::Failed => "Not complete: the solver gave up in at least one case, see below.",
        Status::Interrupted => "Not complete: the run was interrupted.",
        Status::Running | Status::Pending => {
            "Not complete: the run is still going on, or its process was killed."
        }
    }
}

fn published(summary: &Summary) -> String {
    let mut grid = Grid::new(&[0, 1, 6]);
    let mut any = false;
    grid.header([
        "case",
        "result",
        "unit",
        "published",
        "computed",
        "difference",
        "source",
    ]);
    for (name, case) in &summary.cases {
        for value in &case.published {
            any = true;
            grid.row([
                name.clone(),
                value.channel.clone(),
                value.unit.clone(),
                number(value.published),
                maybe(value.computed),
                maybe(value.difference),
                value.source.clone(),
            ]);
        }
    }
    if any { grid.text() } else { String::new() }
}

/// Results with the cases beside each other.
fn results(cases: &[(&String, &CaseSummary)]) -> String {
    let mut grid = Grid::new(&[0, 1]);
    let names = cases.iter().map(|(name, _)| (*name).clone());
    grid.header(
        [window_label(cases), "unit".to_owned()]
            .into_iter()
            .chain(names),
    );
    let mut rows = CaseRows {
        grid: &mut grid,
        cases,
    };
    // Cases have the same bodies and lines; a case that failed early lists none.
    let model = cases
        .iter()
        .map(|(_, case)| *case)
        .find(|case| !case.lines.is_empty());
    for name in model.iter().flat_map(|case| case.bodies.keys()) {
        let body = |case: &CaseSummary| case.bodies.get(name).cloned();
        rows.add(&format!("{name} offset x"), "m", |case| {
            fixed(body(case).and_then(|body| body.offset_x_m), 2)
        });
        rows.add(&format!("{name} offset y"), "m", |case| {
            fixed(body(case).and_then(|body| body.offset_y_m), 2)
        });
    }
    for name in model.iter().flat_map(|case| case.lines.keys()) {
        rows.grid.group(name.as_str());
        for (label, end) in [
            ("end A", end_a as fn(&LineSummary) -> &EndSummary),
            ("end B", end_b),
        ] {
            let mut force = |axis: &str, value: fn(&EndSummary) -> Extent| {
                rows.add(&format!("  {label} force {axis}, mean"), "kN", |case| {
                    fixed(
                        case.lines
                            .get(name)
                            .map(|line| value(end(line)).mean * 1e-3),
                        2,
                    )
                });
            };
            force("x", |end| end.force_x_n);
            force("y", |end| end.force_y_n);
            force("z", |end| end.force_z_n);
            let mut tension = |what: &str, value: fn(Extent) -> f64| {
                rows.add(&format!("  {label} tension, {what}"), "kN", |case| {
                    let line = case.lines.get(name);
                    fixed(
                        line.map(|line| value(end(line).effective_tension_n) * 1e-3),
                        1,
                    )
                });
            };
            tension("least", |extent| extent.min);
            tension("largest", |extent| extent.max);
        }
        rows.add("  whole line tension, least", "kN", |case| {
            let line = case.lines.get(name);
            fixed(
                line.and_then(|l| l.min_effective_tension_n)
                    .map(|t| t.value * 1e-3),
                1,
            )
        });
        rows.add("  whole line tension, largest", "kN", |case| {
            let line = case.lines.get(name);
            fixed(
                line.and_then(|l| l.max_effective_tension_n)
                    .map(|t| t.value * 1e-3),
                1,
            )
        });
    }
    rows.grid.group("solver");
    rows.add("  status", "", |case| case.status.word().to_owned());
    rows.add("  simulated time", "s", |case| fixed(case.simulated_s, 1));
    rows.add("  steps", "", |case| count(case.steps));
    rows.add("  rejected steps", "", |case| count(case.rejected_steps));
    rows.add("  iterations", "", |case| count(case.iterations));
    rows.add("  largest residual", "N", |case| maybe(case.residual_n));
    rows.add("  energy imbalance", "%", |case| {
        fixed(case.energy_imbalance.map(|imbalance| 100.0 * imbalance), 4)
    });
    rows.add("  processor time", "s", |case| fixed(case.cpu_seconds, 2));
    rows.add("  times real time", "", |case| {
        fixed(case.real_time_factor, 0)
    });
    grid.text()
}

/// Adds rows with one cell per case.
struct CaseRows<'a> {
    grid: &'a mut Grid,
    cases: &'a [(&'a String, &'a CaseSummary)],
}

impl CaseRows<'_> {
    fn add(&mut self, label: &str, unit: &str, value: impl Fn(&CaseSummary) -> String) {
        let head = [label.to_owned(), unit.to_owned()];
        self.grid.row(
            head.into_iter()
                .chain(self.cases.iter().map(|(_, case)| value(case))),
        );
    }
}

fn end_a(line: &LineSummary) -> &EndSummary {
    &line.end_a
}

fn end_b(line: &LineSummary) -> &EndSummary {
    &line.end_b
}

/// Over which time the results are taken.
fn window_label(cases: &[(&String, &CaseSummary)]) -> String {
    let lengths: Vec<f64> = cases
        .iter()
        .filter(|(_, case)| case.status == Status::Complete)
        .filter_map(|(_, case)| case.window_s)
        .map(|[start, end]| end - start)
        .collect();
    match lengths.first() {
        Some(first)
            if lengths
                .iter()
                .all(|length| (length - first).abs() < 1e-6 * first) =>
        {
            format!("over the last {first:.6} s").replace(".000000", "")
        }
        _ => String::new(),
    }
}
