//! Numbers as people write them: real minus signs, powers of ten, and units that keep them short.
//!
//! Powers are written with the superscript characters of Unicode; figures and pages raise them.

/// Characters of raised numbers, and what they stand for.
const RAISED: [(char, char); 11] = [
    ('⁰', '0'),
    ('¹', '1'),
    ('²', '2'),
    ('³', '3'),
    ('⁴', '4'),
    ('⁵', '5'),
    ('⁶', '6'),
    ('⁷', '7'),
    ('⁸', '8'),
    ('⁹', '9'),
    ('⁻', '−'),
];

/// A number in superscript characters.
pub(crate) fn raised(number: i32) -> String {
    let characters = number.to_string();
    let raise = |character: char| {
        let plain = if character == '-' { '−' } else { character };
        let found = RAISED.iter().find(|(_, from)| *from == plain);
        found.map_or(character, |(to, _)| *to)
    };
    characters.chars().map(raise).collect()
}

/// Pieces of a text in their order: plain ones, and raised ones in plain characters.
///
/// Raised are superscript characters, and what a caret says: `R^2`, `10^-3`.
pub(crate) fn pieces(text: &str) -> Vec<(String, bool)> {
    let mut pieces: Vec<(String, bool)> = Vec::new();
    let mut rest = text.chars().peekable();
    let mut in_power = false;
    while let Some(character) = rest.next() {
        if character == '^' {
            let mut after = rest.clone();
            let is_negative = after.next_if_eq(&'-').is_some();
            if after.peek().is_some_and(char::is_ascii_digit) {
                rest = after;
                in_power = true;
                pieces.push((if is_negative { "−" } else { "" }.to_owned(), true));
                continue;
            }
        }
        in_power &= character.is_ascii_digit();
        let plain = RAISED.iter().find(|(from, _)| *from == character);
        let (character, is_raised) = plain.map_or((character, in_power), |(_, to)| (*to, true));
        match pieces.last_mut() {
            Some((piece, same)) if *same == is_raised => piece.push(character),
            _ => pieces.push((character.to_string(), is_raised)),
        }
    }
    pieces
}

/// A formatted number with a real minus sign, and none before zero.
pub(crate) fn minus(number: &str) -> String {
    match number.strip_prefix('-') {
        Some(rest) if rest.chars().all(|c| c == '0' || c == '.') => rest.to_owned(),
        Some(rest) => format!("−{rest}"),
        None => number.to_owned(),
    }
}

/// A number with the given count of significant digits, as power of ten where it is long.
pub(crate) fn significant(value: f64, digits: usize) -> String {
    if !value.is_finite() {
        return "not a number".to_owned();
    }
    if value == 0.0 {
        return "0".to_owned();
    }
    let digits = digits.max(1);
    let scientific = format!("{value:.*e}", digits - 1);
    let Some((mantissa, exponent)) = scientific.split_once('e') else {
        return minus(&scientific);
    };
    // The exponent after rounding: 9.996 with three digits is 10.0.
    let exponent: i32 = exponent.parse().unwrap_or_default();
    if (-4..7).contains(&exponent) {
        let decimals = (digits as i32 - 1 - exponent).max(0) as usize;
        return minus(&format!("{value:.decimals$}"));
    }
    format!("{}×10{}", minus(mantissa), raised(exponent))
}

/// The same, but with fewer digits where fewer give the same number.
pub(crate) fn shortest(value: f64, most_digits: usize) -> String {
    (1..=most_digits.max(1))
        .map(|digits| significant(value, digits))
        .zip(1..)
        .find(|(_, digits)| {
            let rounded: f64 = format!("{value:.*e}", digits - 1).parse().unwrap_or(value);
            rounded == value
        })
        .map_or_else(|| significant(value, most_digits), |(text, _)| text)
}

/// A unit in which numbers up to `largest` are short, and the factor to it.
pub(crate) fn readable_unit(unit: &str, largest: f64) -> (String, f64) {
    let prefixed = match unit {
        "N" | "N m" | "Pa" if largest >= 1e7 => Some(("M", 1e-6)),
        "N" | "N m" | "Pa" if largest >= 1e4 => Some(("k", 1e-3)),
        "m" if (1e-5..1e-2).contains(&largest) => Some(("m", 1e3)),
        "m" if (1e-8..1e-5).contains(&largest) => Some(("µ", 1e6)),
        _ => None,
    };
    if let Some((prefix, factor)) = prefixed {
        return (format!("{prefix}{unit}"), factor);
    }
    let is_short = (1e-2..1e6).contains(&largest) || largest == 0.0 || !largest.is_finite();
    if is_short {
        return (unit.to_owned(), 1.0);
    }
    let exponent = 3 * (largest.log10() / 3.0).floor() as i32;
    let power = format!("10{}", raised(exponent));
    let unit = match unit {
        "" | "-" => power,
        unit => format!("{power} {unit}"),
    };
    (unit, 10_f64.powi(-exponent))
}

/// `tip deflection [mm]` as name and unit; the unit is empty where there is none.
pub(crate) fn split_unit(label: &str) -> (&str, &str) {
    let label = label.trim();
    label
        .strip_suffix(']')
        .and_then(|rest| rest.rsplit_once('['))
        .map_or((label, ""), |(name, unit)| (name.trim_end(), unit.trim()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn significant_digits_and_powers() {
        assert_eq!(significant(2.90841, 5), "2.9084");
        assert_eq!(significant(-0.000123456, 3), "−0.000123");
        assert_eq!(significant(9.996, 3), "10.0");
        assert_eq!(significant(3.8234e-7, 2), "3.8×10⁻⁷");
        assert_eq!(significant(2.07e11, 4), "2.070×10¹¹");
        assert_eq!(significant(f64::NAN, 4), "not a number");
        assert_eq!(shortest(0.5, 6), "0.5");
        assert_eq!(shortest(1e-3, 3), "0.001");
        assert_eq!(shortest(1.0 / 3.0, 4), "0.3333");
    }

    #[test]
    fn pieces_join_to_the_text() {
        let expected = [("3×10", false), ("−12", true), (" m", false), ("2", true)];
        let expected = expected.map(|(text, raised)| (text.to_owned(), raised));
        assert_eq!(pieces("3×10⁻¹² m²"), expected);
        assert_eq!(pieces(""), []);
        let expected = [("P R", false), ("2", true), (" / 10", false), ("−3", true)];
        let expected = expected.map(|(text, raised)| (text.to_owned(), raised));
        assert_eq!(pieces("P R^2 / 10^-3"), expected);
        assert_eq!(pieces("a ^ b^-c^"), [("a ^ b^-c^".to_owned(), false)]);
    }

    #[test]
    fn units_keep_numbers_short() {
        assert_eq!(readable_unit("N", 2e4), ("kN".to_owned(), 1e-3));
        assert_eq!(readable_unit("m", 2e-3), ("mm".to_owned(), 1e3));
        assert_eq!(readable_unit("rad", 2e-5).0, "10⁻⁶ rad");
        assert_eq!(readable_unit("-", 2e-5).0, "10⁻⁶");
        assert_eq!(readable_unit("Hz", 0.2), ("Hz".to_owned(), 1.0));
    }

    #[test]
    fn labels_split_into_name_and_unit() {
        assert_eq!(split_unit("time [s]"), ("time", "s"));
        assert_eq!(split_unit("load factor"), ("load factor", ""));
        assert_eq!(split_unit("x[3] [m]"), ("x[3]", "m"));
    }
}
