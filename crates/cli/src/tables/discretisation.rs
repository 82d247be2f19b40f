//! Estimated discretisation errors, where an accuracy was asked for.

use catenix_results::{CaseSummary, Discretisation, ErrorEstimate};

use super::grid::Grid;
use super::number::number;
use super::paragraph;

/// Estimated errors of the headline results, with the cases beside each other; empty where no
/// accuracy was asked for.
pub(crate) fn discretisation_text(cases: &[(&String, &CaseSummary)]) -> String {
    let chosen: Vec<(&String, &Discretisation)> = cases
        .iter()
        .filter_map(|(name, case)| Some((*name, case.discretisation.as_ref()?)))
        .collect();
    let Some((_, first)) = chosen.first() else {
        return String::new();
    };
    let mut grid = Grid::new(&[0, 1]);
    let names = chosen.iter().map(|(name, _)| (*name).clone());
    grid.header(["".to_owned(), "unit".to_owned()].into_iter().chain(names));
    let mut row = |label: &str, unit: &str, cell: &dyn Fn(&Discretisation) -> String| {
        let cells = chosen.iter().map(|(_, chosen)| cell(chosen));
        grid.row([label.to_owned(), unit.to_owned()].into_iter().chain(cells));
    };
    row("elements", "", &|d| d.elements.to_string());
    row("largest step", "s", &|d| {
        d.largest_step_s.map_or_else(|| "-".to_owned(), number)
    });
    row("trial runs", "", &|d| d.trials.to_string());
    row("their processor time", "s", &|d| {
        d.cpu_seconds.map_or_else(|| "-".to_owned(), number)
    });
    grid.group("estimated error of mesh + step");
    let mut rows: Vec<(&str, bool)> = Vec::new();
    for estimate in chosen.iter().flat_map(|(_, d)| &d.estimates) {
        if !rows.iter().any(|(known, _)| *known == estimate.result) {
            rows.push((&estimate.result, estimate.steers));
        }
    }
    for (result, steers) in rows {
        let cells = chosen.iter().map(|(_, d)| {
            let found = d.estimates.iter().find(|e| e.result == result);
            found.map_or_else(|| "-".to_owned(), errors)
        });
        let mark = if steers { "" } else { " *" };
        grid.row(
            [format!("  {result}{mark}"), "%".to_owned()]
                .into_iter()
                .chain(cells),
        );
    }
    let mut text = format!(
        "Accuracy of {} % asked for. Errors are relative to the largest tension at an end of a \
         line, to the horizontal offset of a body, or to the largest value of the result itself.",
        number(100.0 * first.target)
    );
    let has_peaks = chosen
        .iter()
        .any(|(_, d)| d.estimates.iter().any(|e| !e.steers));
    if has_peaks {
        text.push_str(
            " * Peaks of the motion along a line: estimated, but the mesh is not made for them.",
        );
    }
    let missed: Vec<&str> = chosen
        .iter()
        .filter(|(_, d)| !d.reached)
        .map(|(name, _)| name.as_str())
        .collect();
    if !missed.is_empty() {
        text.push_str(&format!(
            " NOT REACHED in {}: the finest mesh or step that was tried is not enough.",
            missed.join(", ")
        ));
    }
    format!("{}\n{}", paragraph(&text), grid.text())
}

/// Relative errors of mesh and step [%].
fn errors(estimate: &ErrorEstimate) -> String {
    let percent = |error: f64| format!("{:.2}", 100.0 * error / estimate.scale);
    format!(
        "{} + {}",
        percent(estimate.space_error),
        percent(estimate.time_error)
    )
}
