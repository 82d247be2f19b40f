//! The summary of a run.

use std::path::{Path, PathBuf};

use catenix_results::mean_order;
use catenix_results::{
    BodySummary, CaseSummary, EndSummary, Extent, LineSummary, Located, Status, Summary,
};

use super::discretisation::discretisation_text;
use super::grid::Grid;
use super::number::{count, fixed, maybe};
use super::references::references_text;
use super::{CASES_PER_TABLE, heading, paragraph, remark};

/// Computed beside references, then results and solver statistics of each case.
pub(crate) fn summary_text(summary: &Summary) -> String {
    let mut text = heading(&summary.title);
    if summary.status != Status::Complete {
        text.push_str(&format!("{}\n", status_sentence(summary.status)));
    }
    let cases: Vec<(&String, &CaseSummary)> = summary.cases.iter().collect();
    for cases in cases.chunks(CASES_PER_TABLE) {
        text.push_str(&references_text(cases));
    }
    if !summary.note.is_empty() {
        text.push('\n');
        text.push_str(&remark(&summary.note));
    }
    text.push('\n');
    for cases in cases.chunks(CASES_PER_TABLE) {
        text.push_str(&results(cases));
        text.push('\n');
        text.push_str(&discretisation_text(cases));
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

/// Results with the cases beside each other: means, extremes, the solver's account.
fn results(cases: &[(&String, &CaseSummary)]) -> String {
    let mut grid = Grid::new(&[0, 1]);
    let names = cases.iter().map(|(name, _)| (*name).clone());
    grid.header(["".to_owned(), "unit".to_owned()].into_iter().chain(names));
    let mut rows = CaseRows {
        grid: &mut grid,
        cases,
    };
    // Cases have the same bodies and lines; a case that failed early lists none.
    let model = cases
        .iter()
        .map(|(_, case)| *case)
        .find(|case| !case.lines.is_empty());
    if let Some(model) = model {
        rows.grid.group(format!("mean {}", mean_time(cases)));
        rows.add_means(model);
        rows.grid
            .group(format!("min and max {}", extremes_time(cases)));
        rows.add_extremes(model);
    }
    rows.grid.group("solver");
    rows.add("  status", "", |case| case.status.word().to_owned());
    rows.add("  simulated time", "s", |case| fixed(case.simulated_s, 1));
    rows.add("  steps", "", |case| count(case.steps));
    rows.add("  rejected steps", "", |case| count(case.rejected_steps));
    rows.add("  mean order", "", |case| {
        fixed(case.steps_of_order.as_ref().map(mean_order), 2)
    });
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

/// One of the located extremes of a line.
type LineExtreme = fn(&LineSummary) -> Option<Located>;

/// One of the ends of a line.
type LineEndOf = fn(&LineSummary) -> &EndSummary;

/// The ends of a line with their names.
const ENDS: [(&str, LineEndOf); 2] = [("end A", end_a), ("end B", end_b)];

/// Adds rows with one cell per case.
struct CaseRows<'a> {
    grid: &'a mut Grid,
    cases: &'a [(&'a String, &'a CaseSummary)],
}

impl CaseRows<'_> {
    fn add_means(&mut self, model: &CaseSummary) {
        for name in model.bodies.keys() {
            let mut offset = |axis: &str, value: fn(&BodySummary) -> Option<f64>| {
                self.add(&format!("  {name} offset {axis}"), "m", |case| {
                    fixed(case.bodies.get(name).and_then(value), 2)
                });
            };
            offset("x", |body| body.offset_x_m);
            offset("y", |body| body.offset_y_m);
        }
        for name in model.lines.keys() {
            for (label, end) in ENDS {
                let mut force = |axis: &str, value: fn(&EndSummary) -> Extent| {
                    let label = format!("  {name} {label} force {axis}");
                    self.add(&label, "kN", |case| {
                        let line = case.lines.get(name);
                        fixed(line.map(|line| value(end(line)).mean * 1e-3), 2)
                    });
                };
                force("x", |end| end.force_x_n);
                force("y", |end| end.force_y_n);
                force("z", |end| end.force_z_n);
            }
        }
    }

    fn add_extremes(&mut self, model: &CaseSummary) {
        for (name, line) in &model.lines {
            for (label, end) in ENDS {
                let mut tension = |what: &str, value: fn(Extent) -> f64| {
                    let label = format!("  {name} {label} tension, {what}");
                    self.add(&label, "kN", |case| {
                        let line = case.lines.get(name);
                        let tension = line.map(|line| end(line).effective_tension_n);
                        fixed(tension.map(|tension| value(tension) * 1e-3), 1)
                    });
                };
                tension("min", |extent| extent.min);
                tension("max", |extent| extent.max);
            }
            let mut located = |what: &str, unit: &str, scale: f64, value: LineExtreme| {
                self.add(&format!("  {name} {what}"), unit, |case| {
                    let located = case.lines.get(name).and_then(value);
                    fixed(located.map(|located| located.value * scale), 1)
                });
            };
            located("tension, min", "kN", 1e-3, |line| {
                line.min_effective_tension_n
            });
            located("tension, max", "kN", 1e-3, |line| {
                line.max_effective_tension_n
            });
            located("bending moment, max", "kN m", 1e-3, |line| {
                line.max_bend_moment_n_m
            });
            if line.max_von_mises_stress_pa.is_some() {
                located("stress, max", "MPa", 1e-6, |line| {
                    line.max_von_mises_stress_pa
                });
            }
        }
    }

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

/// Over which time the means are taken.
pub(super) fn mean_time(cases: &[(&String, &CaseSummary)]) -> String {
    let mut lengths = cases
        .iter()
        .filter_map(|(_, case)| case.window_s)
        .map(|[start, end]| end - start);
    match lengths.next() {
        Some(first) if lengths.all(|length| (length - first).abs() <= 1e-6 * first) => {
            // Differences of times have rounding errors in their last digits.
            let length = format!("{first:.6}");
            let length = length.trim_end_matches('0').trim_end_matches('.');
            let of_what = if complete(cases) {
                ""
            } else {
                " that were computed"
            };
            format!("over the last {length} s{of_what}")
        }
        _ if complete(cases) => "over the statistics window".to_owned(),
        _ => "over the statistics window, or less where a case ended early".to_owned(),
    }
}

/// Over which time the extremes are taken.
pub(super) fn extremes_time(cases: &[(&String, &CaseSummary)]) -> &'static str {
    if complete(cases) {
        "over the whole run"
    } else {
        "over all that was computed"
    }
}

fn complete(cases: &[(&String, &CaseSummary)]) -> bool {
    cases
        .iter()
        .all(|(_, case)| case.status == Status::Complete)
}
