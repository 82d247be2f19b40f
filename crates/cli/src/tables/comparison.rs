//! Formulations side by side.

use catenix_results::{ComparedCase, ComparedRun, FormulationStudy};

use super::grid::Grid;
use super::number::{maybe, number};
use super::{heading, paragraph};

/// For each load case: results at equal mesh, cost and error on all meshes, cost at equal error.
pub(crate) fn comparison_text(study: &FormulationStudy) -> String {
    let mut text = String::new();
    for case in &study.cases {
        text.push_str(&case_text(case, &study.title, study.target));
    }
    text
}

fn case_text(case: &ComparedCase, title: &str, target: f64) -> String {
    let mut text = heading(&format!("{title}, case {}", case.name));
    if let Some(reference) = &case.reference {
        text.push_str(&paragraph(&format!(
            "Reference: {} with {} elements and {} steps, {} s of processor time. Errors are relative \
             to the scale of each result: for a force the tension there, for an offset its length.",
            reference.formulation,
            reference.run.elements,
            reference.run.steps,
            number(reference.run.cpu_seconds),
        )));
    }
    if case.formulations.iter().any(|f| f.equal_mesh.is_some()) {
        text.push_str(&results_text(case));
    }
    text.push_str(&costs_text(case));
    text.push_str(&target_text(case, target));
    for formulation in &case.formulations {
        if let Some(problem) = &formulation.problem {
            let problem = format!("{}: {problem}", formulation.formulation);
            text.push_str(&paragraph(&problem));
        }
    }
    if case.interrupted {
        text.push_str("Stopped by the user.\n");
    }
    text
}

/// Results on the mesh of the model file, as differences from the reference in per cent.
fn results_text(case: &ComparedCase) -> String {
    let mut grid = Grid::new(&[0, 1]);
    let words = case
        .formulations
        .iter()
        .map(|f| format!("{} %", f.formulation));
    let head = ["on equal mesh", "unit", "reference"].map(str::to_owned);
    grid.header(head.into_iter().chain(words));
    for result in case.results.iter().filter(|result| result.counts) {
        let differences = result.differences_percent.iter().map(|&d| percent(d));
        let first = [
            result.name.clone(),
            result.unit.clone(),
            number(result.reference),
        ];
        grid.row(first.into_iter().chain(differences));
    }
    format!("{}\n", grid.text())
}

/// What every run cost, and its error.
fn costs_text(case: &ComparedCase) -> String {
    let mut grid = Grid::new(&[0, 9]);
    grid.header([
        "formulation",
        "elements",
        "steps",
        "iterations",
        "factorisations",
        "CPU s",
        "MB",
        "error %",
        "error/CPU 1/s",
        "largest error",
    ]);
    for formulation in &case.formulations {
        for (index, run) in formulation.runs.iter().enumerate() {
            let mark = if formulation.equal_mesh == Some(index) {
                " ="
            } else {
                ""
            };
            grid.row([
                format!("{}{mark}", formulation.formulation),
                run.elements.to_string(),
                run.steps.to_string(),
                run.iterations.to_string(),
                run.factorisations.to_string(),
                format!("{:.4}", run.cpu_seconds),
                maybe(run.peak_memory_bytes.map(|bytes| bytes as f64 / 1e6)),
                percent(run.error.map(|error| 100.0 * error)),
                maybe(run.error_per_cpu_second),
                run.worst.clone().unwrap_or_default(),
            ]);
        }
    }
    format!("{}= the mesh of the model file\n\n", grid.text())
}

/// Costs relative to the first formulation, at equal mesh and at equal error.
fn target_text(case: &ComparedCase, target: f64) -> String {
    let first_of = |pick: &dyn Fn(&catenix_results::ComparedFormulation) -> Option<f64>| {
        case.formulations.first().and_then(pick)
    };
    let cost = |run: &ComparedRun| run.cpu_seconds;
    let equal_mesh = first_of(&|f| f.on_equal_mesh().map(cost));
    let equal_error = first_of(&|f| f.meeting_target().map(cost));
    let ratio = |own: Option<f64>, first: Option<f64>| maybe(own.zip(first).map(|(a, b)| a / b));
    let mut grid = Grid::new(&[0]);
    grid.header([
        "formulation".to_owned(),
        "CPU s at equal mesh".to_owned(),
        "over the first".to_owned(),
        format!("elements at {} %", 100.0 * target),
        format!("CPU s at {} %", 100.0 * target),
        "over the first".to_owned(),
    ]);
    for formulation in &case.formulations {
        let (mesh, met) = (formulation.on_equal_mesh(), formulation.meeting_target());
        let seconds = |run: Option<&ComparedRun>| {
            run.map_or_else(|| "-".to_owned(), |run| format!("{:.4}", run.cpu_seconds))
        };
        grid.row([
            formulation.formulation.clone(),
            seconds(mesh),
            ratio(mesh.map(cost), equal_mesh),
            met.map_or_else(|| "-".to_owned(), |run| run.elements.to_string()),
            seconds(met),
            ratio(met.map(cost), equal_error),
        ]);
    }
    format!("{}\n", grid.text())
}

fn percent(value: Option<f64>) -> String {
    value.map_or_else(|| "-".to_owned(), |value| format!("{value:.3}"))
}
