//! A band of frequencies as one text: `0.1 Hz..2 Hz`.

use super::dimension::{Frequency, Measure};
use super::units::{QuantityError, parse_quantity};
use crate::ModeRange;

/// Reads a band of frequencies such as `0.1 Hz..2 Hz`; a bare number is in hertz, and a missing
/// start is 0.
///
/// # Errors
/// What is wrong, and what to write instead.
pub fn parse_band(text: &str) -> Result<ModeRange, String> {
    let Some((from, to)) = text.split_once("..") else {
        return Err("a band has a start and an end: write, for example, \"0.1 Hz..2 Hz\"".into());
    };
    let from_hz = match from.trim() {
        "" => 0.0,
        from => frequency(from)?,
    };
    let to_hz = frequency(to.trim())?;
    if !(0.0 <= from_hz && from_hz < to_hz) {
        return Err(format!(
            "a band goes from a lower to a higher frequency, not from {from_hz} Hz to {to_hz} Hz"
        ));
    }
    Ok(ModeRange::Band { from_hz, to_hz })
}

fn frequency(text: &str) -> Result<f64, String> {
    let number = parse_quantity(text).map_err(|error| match error {
        QuantityError::Number(message, help) | QuantityError::Unit(message, help) => {
            format!("{message}; {help}")
        }
    })?;
    let accepted = |powers| Frequency::ACCEPTED.iter().any(|d| d.accepts(powers));
    match number.powers {
        Some(powers) if !accepted(powers) => Err(format!(
            "`{text}` is not a frequency: write, for example, \"0.5 Hz\""
        )),
        _ => Ok(number.si),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bands_with_and_without_units() {
        let band = |from_hz, to_hz| Ok(ModeRange::Band { from_hz, to_hz });
        assert_eq!(parse_band("0.1 Hz..2 Hz"), band(0.1, 2.0));
        assert_eq!(parse_band("0.1..2"), band(0.1, 2.0));
        assert_eq!(parse_band("..60 min^-1"), band(0.0, 1.0));
        for wrong in [
            "2",
            "2..1",
            "-1..1",
            "1 m..2 m",
            "1..2 rad/s",
            "a..b",
            "1..",
        ] {
            assert!(parse_band(wrong).is_err(), "{wrong}");
        }
    }
}
