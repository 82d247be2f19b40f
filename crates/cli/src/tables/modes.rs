//! Natural modes, one table per load case.

use catenix_results::{ModeReport, ModesReport};

use super::grid::Grid;
use super::number::number;
use super::{heading, paragraph, remark};
use crate::commands::{CaseModesReport, ModesDocument};

/// Share of the kinetic energy from which on a second way to move is told.
const WORTH_TELLING: f64 = 0.1;

/// The modes of each case, with what proves that none is missing.
pub(crate) fn modes_text(document: &ModesDocument<'_>) -> String {
    let mut text = String::new();
    for (name, case) in &document.cases {
        let place = match document.cases.len() {
            1 => String::new(),
            _ => format!(", {name}"),
        };
        text.push_str(&heading(&format!(
            "{}{place}: natural modes",
            document.title
        )));
        text.push_str(&case_text(case));
    }
    text.push_str(&remark(document.note));
    text
}

fn case_text(case: &CaseModesReport<'_>) -> String {
    let Some(report) = case.report else {
        return String::new();
    };
    let mut text = table(report);
    text.push('\n');
    text.push_str(&paragraph(&proof(report)));
    text
}

fn table(report: &ModesReport) -> String {
    let mut grid = Grid::new(&[0, 1, 5, 6]);
    grid.header([
        "mode",
        "",
        "frequency",
        "period",
        "damping",
        "moves most",
        "motion",
        "mass",
    ]);
    grid.row(["", "", "Hz", "s", "%", "", "% of energy", "% x, y, z"]);
    for mode in &report.modes {
        grid.row(row(mode, &report.total_mass_kg));
    }
    grid.text()
}

fn row(mode: &ModeReport, total_mass_kg: &[f64; 3]) -> Vec<String> {
    let moves_most = match mode.arc_length_m {
        Some(arc_length) => format!("{} at {arc_length:.0} m", mode.moves_most),
        None => mode.moves_most.clone(),
    };
    let motions: Vec<String> = mode
        .motions
        .iter()
        .enumerate()
        .filter(|(place, share)| *place == 0 || share.share >= WORTH_TELLING)
        .map(|(_, share)| format!("{} {:.0}", share.motion, 100.0 * share.share))
        .collect();
    let frequency = match (&*mode.kind, mode.frequency_hz) {
        ("unstable", _) => "grows".to_owned(),
        ("free", _) => "free".to_owned(),
        (_, hz) => hz.map_or_else(String::new, digits),
    };
    let damping = mode.damping_ratio.filter(|_| mode.kind == "vibration");
    let mut cells = vec![
        mode.number.to_string(),
        if mode.equals_previous { "=" } else { "" }.to_owned(),
        frequency,
        mode.period_s.map_or_else(|| "-".to_owned(), number),
        damping.map_or_else(|| "-".to_owned(), |ratio| number(100.0 * ratio)),
        moves_most,
        motions.join(", "),
    ];
    let shares = mode.effective_mass_kg.iter().zip(total_mass_kg);
    let shares: Vec<String> = shares
        .map(|(mass, total)| format!("{:.0}", 100.0 * mass / total))
        .collect();
    cells.push(shares.join(", "));
    cells
}

/// Five significant digits.
fn digits(hz: f64) -> String {
    let decimals = (4.0 - hz.abs().max(1e-12).log10().floor()).clamp(0.0, 9.0) as usize;
    format!("{hz:.decimals$}")
}

fn proof(report: &ModesReport) -> String {
    let surroundings = if report.added_mass {
        "With the added mass of the water, where there is any"
    } else {
        "Without added mass, about the same equilibrium"
    };
    let [low, high] = report.counted_between_hz;
    let below = match report.below_band {
        0 => String::new(),
        1 => "; one vibration lies below the band".to_owned(),
        many => format!("; {many} vibrations lie below the band"),
    };
    let low = if low <= 0.0 { 0.0 } else { low };
    format!(
        "{surroundings}, undamped. {} modes were counted up to {} Hz{}, and all were found{below}; \
         those beyond the request are left out. = marks a frequency that equals the one before. \
         Mass: effective mass over all mass that moves along x, y and z ({}, {} and {} kg). \
         Damping: that of the structure alone, over the critical one.",
        report.counted,
        digits(high),
        if low > 0.0 {
            format!(" from {} Hz", digits(low))
        } else {
            String::new()
        },
        number(report.total_mass_kg[0]),
        number(report.total_mass_kg[1]),
        number(report.total_mass_kg[2]),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frequencies_have_five_digits() {
        assert_eq!(digits(0.003_345_123), "0.0033451");
        assert_eq!(digits(123.456_78), "123.46");
        assert_eq!(digits(1_234_567.0), "1234567");
    }
}
