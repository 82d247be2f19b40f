//! The static equilibrium.

use catenix_results::{CaseSummary, EndSummary, Summary};

use super::discretisation::discretisation_text;
use super::grid::Grid;
use super::number::{count, fixed, maybe};
use super::summary::errors_text;
use super::{CASES_PER_TABLE, heading};

/// Body positions, end forces, tensions and angles of each case.
pub(crate) fn statics_text(summary: &Summary) -> String {
    let mut text = heading(&format!("{}: static equilibrium", summary.title));
    let cases: Vec<(&String, &CaseSummary)> = summary.cases.iter().collect();
    for cases in cases.chunks(CASES_PER_TABLE) {
        text.push_str(&table(cases));
        text.push('\n');
        text.push_str(&discretisation_text(cases));
    }
    text.push_str(&errors_text(summary));
    text
}

fn table(cases: &[(&String, &CaseSummary)]) -> String {
    let mut grid = Grid::new(&[0, 1]);
    let names = cases.iter().map(|(name, _)| (*name).clone());
    grid.header(["".to_owned(), "unit".to_owned()].into_iter().chain(names));
    let mut row = |label: &str, unit: &str, value: &dyn Fn(&CaseSummary) -> String| {
        let head = [format!("  {label}"), unit.to_owned()];
        grid.row(
            head.into_iter()
                .chain(cases.iter().map(|(_, case)| value(case))),
        );
    };
    // Cases have the same bodies and lines; a case that failed lists none.
    let model = cases
        .iter()
        .map(|(_, case)| *case)
        .find(|case| !case.lines.is_empty());
    for name in model.iter().flat_map(|case| case.bodies.keys()) {
        let body = |case: &CaseSummary| case.bodies.get(name).cloned();
        row(&format!("{name}: x"), "m", &|case| {
            fixed(body(case).and_then(|b| b.x_m), 2)
        });
        row(&format!("{name}: y"), "m", &|case| {
            fixed(body(case).and_then(|b| b.y_m), 2)
        });
        row(&format!("{name}: z"), "m", &|case| {
            fixed(body(case).and_then(|b| b.z_m), 2)
        });
        row(&format!("{name}: tilt"), "deg", &|case| {
            fixed(body(case).and_then(|b| b.tilt_deg), 2)
        });
    }
    for name in model.iter().flat_map(|case| case.lines.keys()) {
        for (index, label) in ["end A", "end B"].into_iter().enumerate() {
            let end = |case: &CaseSummary, value: fn(&EndSummary) -> f64, scale: f64| {
                let line = case.lines.get(name);
                let end = line.map(|l| if index == 0 { &l.end_a } else { &l.end_b });
                end.map(|end| value(end) * scale)
            };
            let mut force = |what: &str, unit: &str, value: fn(&EndSummary) -> f64, scale| {
                row(&format!("{name}, {label}: {what}"), unit, &|case| {
                    fixed(end(case, value, scale), 2)
                });
            };
            force("force x", "kN", |end| end.force_x_n.mean, 1e-3);
            force("force y", "kN", |end| end.force_y_n.mean, 1e-3);
            force("force z", "kN", |end| end.force_z_n.mean, 1e-3);
            force(
                "effective tension",
                "kN",
                |end| end.effective_tension_n.mean,
                1e-3,
            );
            force(
                "angle from vertical",
                "deg",
                |end| end.declination_deg.mean,
                1.0,
            );
        }
        row(&format!("{name}: least tension"), "kN", &|case| {
            let line = case.lines.get(name);
            fixed(
                line.and_then(|l| l.min_effective_tension_n)
                    .map(|t| t.value * 1e-3),
                2,
            )
        });
        row(&format!("{name}: largest tension"), "kN", &|case| {
            let line = case.lines.get(name);
            fixed(
                line.and_then(|l| l.max_effective_tension_n)
                    .map(|t| t.value * 1e-3),
                2,
            )
        });
    }
    row("status", "", &|case| case.status.word().to_owned());
    row("iterations", "", &|case| count(case.static_iterations));
    row("residual", "N", &|case| maybe(case.static_residual_n));
    row("processor time", "s", &|case| fixed(case.cpu_seconds, 2));
    grid.text()
}
