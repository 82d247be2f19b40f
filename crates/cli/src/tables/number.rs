//! Numbers for people: as many digits as mean something.

/// A number with four or so significant digits and no exponent where it can be avoided.
pub(crate) fn number(value: f64) -> String {
    let size = value.abs();
    match size {
        _ if !value.is_finite() => "-".to_owned(),
        0.0 => "0".to_owned(),
        _ if !(1e-3..1e9).contains(&size) => format!("{value:.2e}"),
        _ if size >= 1000.0 => format!("{value:.0}"),
        _ if size >= 100.0 => format!("{value:.1}"),
        _ if size >= 1.0 => format!("{value:.2}"),
        _ => format!("{value:.4}"),
    }
}

/// The same for a number that may not exist.
pub(crate) fn maybe(value: Option<f64>) -> String {
    value.map_or_else(|| "-".to_owned(), number)
}

/// A count that may not exist.
pub(crate) fn count(value: Option<usize>) -> String {
    value.map_or_else(|| "-".to_owned(), |value| value.to_string())
}

/// A number with a fixed number of decimals.
pub(crate) fn fixed(value: Option<f64>, decimals: usize) -> String {
    match value.filter(|value| value.is_finite()) {
        // Adding zero turns -0 into 0.
        Some(value) => format!("{:.decimals$}", clean(value, decimals)),
        None => "-".to_owned(),
    }
}

/// Zero instead of a negative number that would be printed as -0.
fn clean(value: f64, decimals: usize) -> f64 {
    let half_unit = 0.5 * 10_f64.powi(-i32::try_from(decimals).unwrap_or(0));
    if value.abs() < half_unit { 0.0 } else { value }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_that_mean_something() {
        assert_eq!(number(4031.4), "4031");
        assert_eq!(number(-22.53), "-22.53");
        assert_eq!(number(0.012), "0.0120");
        assert_eq!(number(1.5e-7), "1.50e-7");
        assert_eq!(number(f64::NAN), "-");
        assert_eq!(fixed(Some(-0.001), 2), "0.00");
        assert_eq!(fixed(Some(-0.006), 2), "-0.01");
    }
}
