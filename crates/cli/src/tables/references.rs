//! Results from elsewhere beside the computed ones.

use catenix_results::{CaseSummary, Comparison, Status};

use super::grid::Grid;
use super::number::fixed;
use super::summary::{extremes_time, mean_time};

/// What the rows of one reference share: source, channel, statistic, and a count where a case has
/// several of these.
type Key<'a> = (&'a str, &'a str, &'static str, usize);

/// The references of some load cases, one block per source; the cases stand beside each other.
/// Empty where nothing is compared: without references, or before any case is complete.
pub(crate) fn references_text(cases: &[(&String, &CaseSummary)]) -> String {
    let mut comparisons = cases.iter().flat_map(|(_, case)| &case.references);
    if comparisons.all(|comparison| comparison.computed.is_none()) {
        return String::new();
    }
    let columns: Vec<Vec<(Key<'_>, &Comparison)>> =
        cases.iter().map(|(_, case)| keyed(case)).collect();
    let mut keys: Vec<Key<'_>> = Vec::new();
    for (key, _) in columns.iter().flatten() {
        if !keys.contains(key) {
            keys.push(*key);
        }
    }
    // Sources in the order in which they first occur, and so are the rows of each.
    let mut sources: Vec<&str> = Vec::new();
    for (source, ..) in &keys {
        if !sources.contains(source) {
            sources.push(source);
        }
    }
    // What is compared is complete, whatever became of the other cases.
    let complete: Vec<(&String, &CaseSummary)> = cases
        .iter()
        .filter(|(_, case)| case.status == Status::Complete)
        .copied()
        .collect();
    let mut text = format!(
        "\nReferences: a mean is {}, min and max are {}.\n",
        mean_time(&complete),
        extremes_time(&complete)
    );
    for source in sources {
        let mut grid = Grid::new(&[0, 1]);
        let names = cases.iter().map(|(name, _)| (*name).clone());
        grid.header(["".to_owned(), "unit".to_owned()].into_iter().chain(names));
        for key in keys.iter().filter(|key| key.0 == source) {
            let row: Vec<Option<&Comparison>> = columns
                .iter()
                .map(|column| {
                    let found = column.iter().find(|(candidate, _)| candidate == key);
                    found.map(|(_, comparison)| *comparison)
                })
                .collect();
            add_rows(&mut grid, &row);
        }
        text.push_str(&format!("\nCompared with {source}\n\n{}", grid.text()));
    }
    text
}

/// The references of a case with their keys.
fn keyed(case: &CaseSummary) -> Vec<(Key<'_>, &Comparison)> {
    let mut keyed: Vec<(Key<'_>, &Comparison)> = Vec::new();
    for comparison in &case.references {
        let mut key: Key<'_> = (
            &comparison.source,
            &comparison.channel,
            comparison.statistic.word(),
            0,
        );
        while keyed.iter().any(|(known, _)| *known == key) {
            key.3 += 1;
        }
        keyed.push((key, comparison));
    }
    keyed
}

/// Reference, computed value and difference, with one comparison or none per case.
fn add_rows(grid: &mut Grid, comparisons: &[Option<&Comparison>]) {
    let Some(first) = comparisons.iter().flatten().next() else {
        return;
    };
    let largest = comparisons
        .iter()
        .flatten()
        .flat_map(|c| [c.low, c.high, c.computed.unwrap_or(0.0)])
        .fold(0.0, |largest: f64, value| largest.max(value.abs()));
    let (unit, scale) = printed_unit(&first.unit, largest);
    let decimals = decimals(largest * scale);
    let print = |value: Option<f64>| fixed(value.map(|value| value * scale), decimals);
    let mut row = |label: &str, unit: &str, cell: &dyn Fn(&Comparison) -> String| {
        // A case that has nothing to compare leaves the place empty.
        let cells = comparisons.iter().map(|c| c.map_or_else(String::new, cell));
        grid.row([label.to_owned(), unit.to_owned()].into_iter().chain(cells));
    };
    let name = format!("{}, {}", first.channel, first.statistic.word());
    if comparisons.iter().flatten().all(|c| c.low == c.high) {
        row(&name, unit, &|c| as_given(&print(Some(c.low))));
    } else {
        let from = format!("{name}, from");
        row(&from, unit, &|c| as_given(&print(Some(c.low))));
        row("  to", "", &|c| as_given(&print(Some(c.high))));
    }
    row("  computed", "", &|c| print(c.computed));
    row("  difference", "", &|c| {
        if c.difference == Some(0.0) && c.low < c.high {
            "inside".to_owned()
        } else {
            print(c.difference)
        }
    });
}

/// A number without the decimals that its source did not give; the points stay below each other.
fn as_given(number: &str) -> String {
    if !number.contains('.') {
        return number.to_owned();
    }
    let short = number.trim_end_matches('0').trim_end_matches('.');
    format!("{short:width$}", width = number.len())
}

/// The unit in which numbers up to `largest` read well, and the factor that leads to it.
fn printed_unit(unit: &str, largest: f64) -> (&str, f64) {
    match unit {
        "N" if largest >= 1e3 => ("kN", 1e-3),
        "N m" if largest >= 1e3 => ("kN m", 1e-3),
        "Pa" if largest >= 1e6 => ("MPa", 1e-6),
        _ => (unit, 1.0),
    }
}

/// Decimals that leave the largest number of a row four significant digits, and one at least.
fn decimals(largest: f64) -> usize {
    if largest <= 0.0 || !largest.is_finite() {
        return 1;
    }
    let digits_before_point = largest.log10().floor() + 1.0;
    (4.0 - digits_before_point).clamp(1.0, 9.0) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    fn comparison(json: &str) -> Comparison {
        serde_json::from_str(json).unwrap()
    }

    #[test]
    fn cases_stand_beside_each_other_and_sources_below_each_other() {
        let paper = r#"{"channel": "buoy.x", "statistic": "mean", "unit": "m", "low": -22.5,
            "high": -22.5, "computed": -22.75, "difference": -0.25, "source": "A paper"}"#;
        let codes = r#"{"channel": "line.end_a.force_z", "statistic": "min", "unit": "N",
            "low": -1558000, "high": -1557000, "computed": -1557500, "difference": 0,
            "source": "two codes"}"#;
        let mut one = CaseSummary::empty("", Status::Complete);
        one.references = vec![comparison(codes), comparison(codes)];
        one.window_s = Some([12.0, 20.0]);
        let mut two = CaseSummary::empty("", Status::Interrupted);
        two.references = vec![comparison(paper)];
        two.references[0].computed = None;
        two.references[0].difference = None;
        let (a, b) = ("one".to_owned(), "two".to_owned());
        let text = references_text(&[(&a, &one), (&b, &two)]);
        let expected = "
References: a mean is over the last 8 s, min and max are over the whole run.

Compared with two codes

                               unit      one  two
-----------------------------  ----  -------  ---
line.end_a.force_z, min, from  kN    -1558
  to                                 -1557
  computed                           -1557.5
  difference                          inside
line.end_a.force_z, min, from  kN    -1558
  to                                 -1557
  computed                           -1557.5
  difference                          inside

Compared with A paper

              unit  one     two
------------  ----  ---  ------
buoy.x, mean  m          -22.5
  computed                    -
  difference                  -
";
        assert_eq!(text, expected);
        assert_eq!(references_text(&[(&b, &two)]), "");
    }

    #[test]
    fn four_digits_in_the_unit_that_suits_them() {
        assert_eq!((decimals(1558.0), decimals(96.2), decimals(7.8)), (1, 2, 3));
        assert_eq!((decimals(0.02), decimals(0.0)), (5, 1));
        assert_eq!(printed_unit("N", 500.0), ("N", 1.0));
        assert_eq!(printed_unit("Pa", 2e8), ("MPa", 1e-6));
    }
}
