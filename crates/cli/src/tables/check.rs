//! What a model consists of.

use catenix_results::ModelOverview;

use super::grid::Grid;
use super::number::{fixed, maybe, number};
use super::{heading, remark};
use crate::commands::CheckReport;

/// Overview of a model file without errors.
pub(crate) fn check_text(report: &CheckReport<'_>) -> String {
    let mut text = heading(report.title);
    text.push_str(&format!("{}: no errors\n", report.model_file));
    if let Some((name, first)) = report.cases.first() {
        if report.cases.len() > 1 {
            text.push_str(&format!("The system, as in load case {name}:\n"));
        }
        text.push('\n');
        text.push_str(&lines(&first.overview));
        text.push('\n');
        text.push_str(&supports(&first.overview));
        text.push('\n');
        if !first.overview.loads.is_empty() {
            text.push_str(&loads(&first.overview));
            text.push('\n');
        }
    }
    text.push_str(&cases(report));
    if !report.figures.is_empty() {
        text.push_str(&format!("\nFigures: {}\n", report.figures.join(", ")));
    }
    if !report.note.is_empty() {
        text.push('\n');
        text.push_str(&remark(report.note));
    }
    text
}

fn lines(overview: &ModelOverview) -> String {
    let mut grid = Grid::new(&[0, 7]);
    grid.header([
        "line",
        "length m",
        "elements",
        "element m",
        "attached",
        "mass t",
        "in water kN",
        "ends A, B",
    ]);
    for (name, line) in &overview.lines {
        let [shortest, longest] = line.element_length_m;
        let element = if longest - shortest < 1e-6 * longest {
            number(longest)
        } else {
            format!("{} to {}", number(shortest), number(longest))
        };
        grid.row([
            name.clone(),
            number(line.length_m),
            line.elements.to_string(),
            element,
            line.attachments.to_string(),
            number(line.mass_kg / 1e3),
            number(line.wet_weight_n / 1e3),
            format!("{}, {}", line.end_a, line.end_b),
        ]);
    }
    grid.text()
}

fn supports(overview: &ModelOverview) -> String {
    let mut grid = Grid::new(&[0, 3]);
    grid.header(["body", "mass t", "in water kN", "remark"]);
    for (name, body) in &overview.bodies {
        let remark = match &body.offset_vessel {
            Some(vessel) => format!("offsets from {vessel}"),
            None => String::new(),
        };
        grid.row([
            name.clone(),
            number(body.mass_kg / 1e3),
            number(body.wet_weight_n / 1e3),
            remark,
        ]);
    }
    for (name, vessel) in &overview.vessels {
        let [x, y, z] = vessel.position_m.map(|value| fixed(Some(value), 1));
        let kind = if vessel.motions == 0 {
            "anchored"
        } else {
            "moved"
        };
        let remark = format!("{kind}, at rest at x {x}, y {y}, z {z} m");
        grid.row([name.as_str(), "-", "-", &remark]);
    }
    grid.text()
}

fn loads(overview: &ModelOverview) -> String {
    let mut grid = Grid::new(&[0, 1, 4]);
    grid.header(["load", "on", "force kN", "moment kN m", "remark"]);
    for (name, load) in &overview.loads {
        let place = match load.arc_length_m {
            Some(at) => format!("{} at {} m", load.on, number(at)),
            None => load.on.clone(),
        };
        let vector = |v: &[f64; 3]| v.map(|part| number(part / 1e3)).join(", ");
        let remarks: Vec<&str> = [
            (load.follows, "turns with it"),
            (load.varies, "varies over time"),
        ]
        .into_iter()
        .filter_map(|(holds, remark)| holds.then_some(remark))
        .collect();
        grid.row([
            name.clone(),
            place,
            vector(&load.force_n),
            vector(&load.moment_n_m),
            remarks.join(", "),
        ]);
    }
    grid.text()
}

fn cases(report: &CheckReport<'_>) -> String {
    let mut grid = Grid::new(&[0, 6]);
    grid.header([
        "case",
        "elements",
        "time s",
        "step s",
        "current m/s",
        "heading deg",
        "description",
    ]);
    for (name, case) in &report.cases {
        let overview = &case.overview;
        let current = overview.surface_current;
        grid.row([
            (*name).to_owned(),
            overview.elements.to_string(),
            maybe(overview.duration_s),
            maybe(overview.step_s),
            fixed(current.map(|current| current.speed_m_s), 3),
            fixed(current.map(|current| current.heading_deg), 0),
            case.description.to_owned(),
        ]);
    }
    grid.text()
}
