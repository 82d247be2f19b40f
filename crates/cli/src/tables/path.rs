//! Equilibrium paths.

use std::path::PathBuf;

use catenix_results::{CasePath, Status, StudyPaths};

use super::grid::Grid;
use super::number::number;
use super::{heading, paragraph, remark};

/// Most channels beside each other in one table.
const CHANNELS: usize = 5;

/// The points of each case, and the files that were written.
pub(crate) fn path_text(paths: &StudyPaths, files: &[PathBuf]) -> String {
    let mut text = heading(&format!("{}: equilibrium path", paths.title));
    for (name, case) in &paths.cases {
        text.push_str(&format!("\n{}\n", title(name, case)));
        text.push_str(&table(case));
        text.push('\n');
        if let Some(error) = &case.error {
            text.push_str(&paragraph(&format!(
                "Case {name} failed: {}",
                error.message
            )));
        }
    }
    text.push_str(&remark(&paths.note));
    for file in files {
        text.push_str(&format!("Written: {}\n", file.display()));
    }
    text
}

fn title(name: &str, case: &CasePath) -> String {
    let end = match (case.status, case.end) {
        (_, Some("range")) => "until the factor left its range",
        (_, Some("channel")) => "until the channel left its range",
        (_, Some(_)) => "as many as were asked for",
        (Status::Interrupted, None) => "interrupted",
        (_, None) => "then the path was lost",
    };
    let points = case.factor.len();
    let loads = case.loads.join(", ");
    format!("{name}: {points} points, {end}; the factor scales {loads}")
}

fn table(case: &CasePath) -> String {
    let mut grid = Grid::new(&[2]);
    let shown: Vec<_> = case
        .main_channels
        .iter()
        .filter_map(|name| Some((name, case.channels.get(name)?)))
        .take(CHANNELS)
        .collect();
    let head = ["point", "factor", "event", "unstable"].map(str::to_owned);
    let columns = shown
        .iter()
        .map(|(name, column)| format!("{name} {}", column.unit));
    grid.header(head.into_iter().chain(columns));
    for (k, factor) in case.factor.iter().enumerate() {
        let head = [
            k.to_string(),
            format!("{factor:.6}"),
            case.event[k].unwrap_or_default().to_owned(),
            case.unstable[k].to_string(),
        ];
        let values = shown.iter().map(|(_, column)| number(column.values[k]));
        grid.row(head.into_iter().chain(values));
    }
    grid.text()
}
