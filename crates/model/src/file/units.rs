//! Numbers with units: `"0.219 m"`, `"10 kN m^2"`, `"57.7 kg/m"`.
//!
//! A quantity is a number, optional space, and a product of units: symbols with optional SI prefix
//! and optional whole power (`m^2`, `m2`, `m²`, `s^-1`), separated by spaces, `*`, `.` or `/`. A
//! slash divides by the next unit only: `kg/m/s` and `N s/m`.

use super::unit_table::{ONE, Unit, find_unit};

/// Powers of the base dimensions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Powers {
    /// Power of mass.
    pub mass: i32,
    /// Power of length.
    pub length: i32,
    /// Power of time.
    pub time: i32,
    /// Power of angle.
    pub angle: i32,
}

impl Powers {
    /// From mass, length, time, angle.
    pub const fn new(mass: i32, length: i32, time: i32, angle: i32) -> Self {
        Powers {
            mass,
            length,
            time,
            angle,
        }
    }

    fn plus(self, other: Powers, times: i32) -> Powers {
        Powers {
            mass: self.mass + times * other.mass,
            length: self.length + times * other.length,
            time: self.time + times * other.time,
            angle: self.angle + times * other.angle,
        }
    }
}

/// A number as written, in SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct WrittenNumber {
    /// Value in SI units.
    pub si: f64,
    /// Powers of its unit; `None` for a bare number.
    pub powers: Option<Powers>,
}

/// Why a text is not a number with a unit.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum QuantityError {
    /// The number is wrong: message and remedy.
    Number(String, String),
    /// The unit is wrong: message and remedy.
    Unit(String, String),
}

/// Reads a number with an optional unit.
pub(super) fn parse_quantity(text: &str) -> Result<WrittenNumber, QuantityError> {
    let text = text.trim();
    let (number, unit) = text.split_at(number_length(text));
    let value: f64 = number.parse().map_err(|_| not_a_number(text))?;
    if unit.starts_with(',') {
        let message = format!("`{text}` is not a number: a comma is no part of a number");
        return Err(QuantityError::Number(
            message,
            "write a decimal point".to_owned(),
        ));
    }
    if !value.is_finite() {
        let message = format!("`{number}` is too large for a number");
        return Err(QuantityError::Number(message, String::new()));
    }
    let unit = unit.trim_start();
    if unit.is_empty() {
        return Ok(WrittenNumber {
            si: value,
            powers: None,
        });
    }
    let unit = parse_unit(unit)?;
    let si = value * unit.numerator / unit.denominator;
    if !si.is_finite() {
        let message = format!("`{text}` is too large for a number");
        return Err(QuantityError::Number(message, String::new()));
    }
    Ok(WrittenNumber {
        si,
        powers: Some(unit.powers),
    })
}

fn not_a_number(text: &str) -> QuantityError {
    let lower = text.to_lowercase();
    let bare = lower.trim_start_matches(['+', '-']);
    if bare.starts_with("inf") || bare.starts_with("nan") {
        let message = format!("`{text}` is not a finite number");
        return QuantityError::Number(message, "write a finite number".to_owned());
    }
    let message = format!("`{text}` does not start with a number");
    QuantityError::Number(message, String::new())
}

/// Length in bytes of the decimal number at the start of `text`.
fn number_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let digits_from = |mut at: usize| {
        while bytes.get(at).is_some_and(u8::is_ascii_digit) {
            at += 1;
        }
        at
    };
    let is_sign = |at: usize| matches!(bytes.get(at), Some(b'+' | b'-'));
    let mut end = digits_from(usize::from(is_sign(0)));
    if bytes.get(end) == Some(&b'.') {
        end = digits_from(end + 1);
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let exponent = end + 1 + usize::from(is_sign(end + 1));
        if digits_from(exponent) > exponent {
            end = digits_from(exponent);
        }
    }
    end
}

fn parse_unit(text: &str) -> Result<Unit, QuantityError> {
    let mut product = ONE;
    let mut rest = text;
    let mut sign = 1;
    loop {
        let (symbol, after) = rest.split_at(rest.find(|c| !is_symbol(c)).unwrap_or(rest.len()));
        if symbol.is_empty() {
            return Err(bad_expression(text));
        }
        let unit = find_unit(symbol)?;
        let (power, after) = parse_power(after).ok_or_else(|| bad_expression(text))?;
        let times = sign * power;
        product.numerator *=
            unit.numerator.powi(times.max(0)) * unit.denominator.powi((-times).max(0));
        product.denominator *=
            unit.denominator.powi(times.max(0)) * unit.numerator.powi((-times).max(0));
        product.powers = product.powers.plus(unit.powers, times);
        let trimmed = after.trim_start();
        if trimmed.is_empty() {
            return Ok(product);
        }
        rest = match trimmed.chars().next() {
            Some(separator @ ('*' | '·' | '⋅' | '.' | '/')) => {
                sign = if separator == '/' { -1 } else { 1 };
                trimmed[separator.len_utf8()..].trim_start()
            }
            _ if trimmed.len() < after.len() => {
                sign = 1;
                trimmed
            }
            _ => return Err(bad_expression(text)),
        };
    }
}

fn is_symbol(c: char) -> bool {
    c.is_alphabetic() || c == '°'
}

/// A whole power after a unit's symbol: `2`, `^2`, `^-1`, `²`; 1 when there is none.
fn parse_power(text: &str) -> Option<(i32, &str)> {
    let superscript = ['¹', '²', '³'];
    if let Some(first) = text.chars().next()
        && let Some(position) = superscript.iter().position(|&c| c == first)
    {
        return Some((position as i32 + 1, &text[first.len_utf8()..]));
    }
    let (marked, digits) = match text.strip_prefix('^') {
        Some(digits) => (true, digits),
        None => (false, text),
    };
    let negative = digits.starts_with('-');
    let unsigned = if negative { &digits[1..] } else { digits };
    let length = unsigned.bytes().take_while(u8::is_ascii_digit).count();
    match length {
        0 if marked || negative => None,
        0 => Some((1, text)),
        1 => {
            let power: i32 = unsigned[..1].parse().ok()?;
            Some((if negative { -power } else { power }, &unsigned[1..]))
        }
        _ => None,
    }
}

fn bad_expression(text: &str) -> QuantityError {
    QuantityError::Unit(
        format!("the unit `{text}` cannot be read"),
        "write units as a product such as `kg/m`, `kN m^2` or `N s/m`, without brackets".to_owned(),
    )
}

/// The powers as a unit, for messages: `kg m^-1 s^-2`.
pub(super) fn describe_powers(powers: Powers) -> String {
    let named = [
        ("kg", powers.mass),
        ("m", powers.length),
        ("s", powers.time),
        ("rad", powers.angle),
    ];
    let factors: Vec<String> = named
        .into_iter()
        .filter(|(_, power)| *power != 0)
        .map(|(unit, power)| {
            if power == 1 {
                unit.to_owned()
            } else {
                format!("{unit}^{power}")
            }
        })
        .collect();
    if factors.is_empty() {
        "1".to_owned()
    } else {
        factors.join(" ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn si(text: &str) -> f64 {
        parse_quantity(text).unwrap().si
    }

    #[test]
    fn decimal_units_are_exact() {
        for (text, expected) in [
            ("0.219 m", 0.219),
            ("219mm", 0.219),
            ("1 km", 1000.0),
            ("206 GPa", 2.06e11),
            ("2.06e11 Pa", 2.06e11),
            ("2.06E11Pa", 2.06e11),
            ("57.7 kg/m", 57.7),
            ("10 kN m^2", 1e4),
            ("10 kN*m^2", 1e4),
            ("10 kN·m²", 1e4),
            ("10 kN.m2", 1e4),
            ("5 MN", 5e6),
            ("35.57 kN", 35_570.0),
            ("1025 kg/m^3", 1025.0),
            ("1025 kg/m3", 1025.0),
            ("1.025 t/m³", 1025.0),
            ("1025 kg m^-3", 1025.0),
            ("19.5 t", 19_500.0),
            ("-22.5 m", -22.5),
            ("+3 m", 3.0),
            (".5 m", 0.5),
            ("5. m", 5.0),
            ("2 min", 120.0),
            ("1.5 h", 5400.0),
            ("250 N/m", 250.0),
            ("9.80665 m/s^2", 9.80665),
            ("9.80665 m/s/s", 9.80665),
            ("1 in", 0.0254),
            ("10 ft", 3.048),
            ("1 bar", 1e5),
            ("42", 42.0),
        ] {
            assert_eq!(si(text), expected, "{text}");
        }
    }

    #[test]
    fn other_units() {
        for (text, expected) in [
            ("90 deg", std::f64::consts::FRAC_PI_2),
            ("90°", std::f64::consts::FRAC_PI_2),
            ("2 knots", 2.0 * 1852.0 / 3600.0),
            ("2 kn", 2.0 * 1852.0 / 3600.0),
            ("1 lbf", 4.448_221_615_260_5),
            ("1 psi", 6_894.757_293_168_361),
            ("1 ksi", 6_894_757.293_168_361),
            ("1 deg/s", std::f64::consts::PI / 180.0),
            ("1 kN m/deg", 180e3 / std::f64::consts::PI),
            ("1 lb/ft", 1.488_163_943_569_553),
            ("0.1 Hz", 0.1),
            ("21.9cm", 0.219),
        ] {
            approx::assert_relative_eq!(si(text), expected, max_relative = 1e-14);
        }
    }

    #[test]
    fn powers_of_units() {
        let powers = |text: &str| parse_quantity(text).unwrap().powers.unwrap();
        assert_eq!(powers("1 N m/rad"), Powers::new(1, 2, -2, -1));
        assert_eq!(powers("1 N s/m"), Powers::new(1, 0, -1, 0));
        assert_eq!(powers("1 J"), powers("1 N m"));
        assert_eq!(powers("1 m/m"), Powers::default());
        assert_eq!(parse_quantity("1").unwrap().powers, None);
    }

    #[test]
    fn bad_text_is_refused_with_a_remedy() {
        use QuantityError::{Number, Unit};
        for text in [
            "",
            "m",
            "abc",
            "nan",
            "NaN m",
            "-inf",
            "infinity m",
            "1e999 m",
            "1,5 m",
            "--3 m",
        ] {
            assert!(matches!(parse_quantity(text), Err(Number(..))), "{text}");
        }
        for text in [
            "3 furlong",
            "3 m^",
            "3 m^-",
            "3 m^22",
            "3 m//s",
            "3 /s",
            "3 (m)",
            "3 m s^",
            "3 kg/(m s)",
            "3 m 4",
        ] {
            assert!(matches!(parse_quantity(text), Err(Unit(..))), "{text}");
        }
        for (text, known) in [
            ("3 metres", "`m`"),
            ("3 KN", "`kN`"),
            ("3 Mpa", "`MPa`"),
            ("3 degrees", "`deg`"),
            ("9 sec", "`s`"),
        ] {
            let Err(Unit(_, help)) = parse_quantity(text) else {
                panic!("{text}")
            };
            assert!(help.contains(known), "{text}: {help}");
        }
    }
}
