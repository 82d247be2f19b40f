//! Numbers of a table: one unit per row, and decimals that fit each other.

use super::document::Cell;
use crate::number::{minus, readable_unit};

/// Stands where there is no number.
pub(super) const NONE: &str = "–";
/// Significant digits of the largest number of a row.
const DIGITS: i32 = 5;

/// Values of one quantity in one unit, ready for the cells of a row.
pub(super) struct Scaled {
    /// The unit that keeps the numbers short.
    pub(super) unit: String,
    factor: f64,
    decimals: usize,
}

impl Scaled {
    /// The common format of values in `unit`.
    pub(super) fn new(unit: &str, values: impl Iterator<Item = f64>) -> Self {
        let largest = values
            .filter(|value| value.is_finite())
            .map(f64::abs)
            .fold(0.0, f64::max);
        let (unit, factor) = readable_unit(unit, largest);
        let shown = largest * factor;
        let before = if shown > 0.0 {
            shown.log10().floor() as i32 + 1
        } else {
            DIGITS
        };
        Scaled {
            unit,
            factor,
            decimals: (DIGITS - before).clamp(0, 5) as usize,
        }
    }

    /// A value as text.
    pub(super) fn text(&self, value: f64) -> String {
        if !value.is_finite() {
            return NONE.to_owned();
        }
        let decimals = self.decimals;
        minus(&format!("{:.decimals$}", value * self.factor))
    }

    /// A value that may be missing.
    pub(super) fn cell(&self, value: Option<f64>) -> Cell {
        value
            .map_or_else(|| NONE.to_owned(), |value| self.text(value))
            .into()
    }
}

/// One number with its unit.
pub(super) fn with_unit(value: f64, unit: &str) -> String {
    if !value.is_finite() {
        return NONE.to_owned();
    }
    let scaled = Scaled::new(unit, std::iter::once(value));
    let text = scaled.text(value);
    // Zeros behind the point say nothing in a single number.
    let text = match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.'),
        false => &text,
    };
    match scaled.unit.as_str() {
        "" | "-" => text.to_owned(),
        "deg" => format!("{text}°"),
        unit => format!("{text} {unit}"),
    }
}

/// A count that may be missing.
pub(super) fn count(count: Option<usize>) -> Cell {
    count
        .map_or_else(|| NONE.to_owned(), |count| count.to_string())
        .into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_has_one_unit_and_the_digits_of_its_largest_number() {
        let forces = [4328.0, 518.4, -16_050.4];
        let scaled = Scaled::new("N", forces.into_iter());
        assert_eq!(scaled.unit, "kN");
        let texts = forces.map(|force| scaled.text(force));
        assert_eq!(texts, ["4.328", "0.518", "−16.050"]);
        assert_eq!(scaled.text(f64::NAN), NONE);
        assert_eq!(Scaled::new("m", std::iter::empty()).text(0.0), "0");
        assert_eq!(Scaled::new("m", [1e-9].into_iter()).unit, "10⁻⁹ m");
    }

    #[test]
    fn single_numbers_are_short() {
        assert_eq!(with_unit(1000.0, "m"), "1000 m");
        assert_eq!(with_unit(0.219, "m"), "0.219 m");
        assert_eq!(with_unit(90.0, "deg"), "90°");
        assert_eq!(with_unit(-231.0, "m"), "−231 m");
        assert_eq!(with_unit(f64::INFINITY, "m"), NONE);
    }
}
