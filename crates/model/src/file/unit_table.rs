//! The units that a model file can use.

use super::log::closest;
use super::units::{Powers, QuantityError};

/// A unit: one of it is `numerator / denominator` SI units.
///
/// Kept as a fraction so that `"219 mm"` is exactly the number nearest to 0.219.
#[derive(Debug, Clone, Copy)]
pub(super) struct Unit {
    symbol: &'static str,
    /// SI units times this ...
    pub numerator: f64,
    /// ... divided by this.
    pub denominator: f64,
    /// Powers of the base dimensions.
    pub powers: Powers,
    prefixes: bool,
}

/// The unit of a plain number.
pub(super) const ONE: Unit = plain("", 1.0, 1.0, Powers::new(0, 0, 0, 0));

const MASS: Powers = Powers::new(1, 0, 0, 0);
const LENGTH: Powers = Powers::new(0, 1, 0, 0);
const TIME: Powers = Powers::new(0, 0, 1, 0);
const ANGLE: Powers = Powers::new(0, 0, 0, 1);
const SPEED: Powers = Powers::new(0, 1, -1, 0);
const FORCE: Powers = Powers::new(1, 1, -2, 0);
const PRESSURE: Powers = Powers::new(1, -1, -2, 0);
const ENERGY: Powers = Powers::new(1, 2, -2, 0);

const fn plain(symbol: &'static str, numerator: f64, denominator: f64, powers: Powers) -> Unit {
    Unit {
        symbol,
        numerator,
        denominator,
        powers,
        prefixes: false,
    }
}

const fn metric(symbol: &'static str, numerator: f64, denominator: f64, powers: Powers) -> Unit {
    Unit {
        symbol,
        numerator,
        denominator,
        powers,
        prefixes: true,
    }
}

/// Pound, exactly [kg].
const POUND: f64 = 0.453_592_37;
/// Standard gravity, exactly [m/s2].
const STANDARD_GRAVITY: f64 = 9.806_65;
/// Pound-force per square inch [Pa].
const PSI: f64 = POUND * STANDARD_GRAVITY / (0.0254 * 0.0254);

/// All units. Those of one symbol each; a whole symbol goes before a prefix and a symbol, so that
/// `min` is a minute, `ft` a foot and `kn` a knot.
const UNITS: &[Unit] = &[
    metric("m", 1.0, 1.0, LENGTH),
    plain("in", 254.0, 10_000.0, LENGTH),
    plain("ft", 3048.0, 10_000.0, LENGTH),
    plain("yd", 9144.0, 10_000.0, LENGTH),
    plain("nmi", 1852.0, 1.0, LENGTH),
    metric("g", 1.0, 1000.0, MASS),
    plain("kg", 1.0, 1.0, MASS),
    plain("t", 1000.0, 1.0, MASS),
    plain("te", 1000.0, 1.0, MASS),
    plain("lb", POUND, 1.0, MASS),
    metric("s", 1.0, 1.0, TIME),
    plain("min", 60.0, 1.0, TIME),
    plain("h", 3600.0, 1.0, TIME),
    plain("d", 86_400.0, 1.0, TIME),
    plain("Hz", 1.0, 1.0, Powers::new(0, 0, -1, 0)),
    plain("rad", 1.0, 1.0, ANGLE),
    plain("mrad", 1.0, 1000.0, ANGLE),
    plain("deg", std::f64::consts::PI, 180.0, ANGLE),
    plain("°", std::f64::consts::PI, 180.0, ANGLE),
    plain("kn", 1852.0, 3600.0, SPEED),
    plain("knot", 1852.0, 3600.0, SPEED),
    plain("knots", 1852.0, 3600.0, SPEED),
    metric("N", 1.0, 1.0, FORCE),
    plain("kgf", STANDARD_GRAVITY, 1.0, FORCE),
    plain("tf", STANDARD_GRAVITY * 1000.0, 1.0, FORCE),
    plain("lbf", POUND * STANDARD_GRAVITY, 1.0, FORCE),
    plain("kip", POUND * STANDARD_GRAVITY * 1000.0, 1.0, FORCE),
    metric("Pa", 1.0, 1.0, PRESSURE),
    plain("bar", 1e5, 1.0, PRESSURE),
    plain("psi", PSI, 1.0, PRESSURE),
    plain("ksi", PSI * 1000.0, 1.0, PRESSURE),
    metric("J", 1.0, 1.0, ENERGY),
];

const PREFIXES: &[(char, f64, f64)] = &[
    ('m', 1.0, 1e3),
    ('c', 1.0, 1e2),
    ('d', 1.0, 1e1),
    ('k', 1e3, 1.0),
    ('M', 1e6, 1.0),
    ('G', 1e9, 1.0),
    ('T', 1e12, 1.0),
    ('µ', 1.0, 1e6),
    ('μ', 1.0, 1e6),
];

/// Names that people write for a unit's symbol.
const SPELLED_OUT: &[(&str, &str)] = &[
    ("metre", "m"),
    ("metres", "m"),
    ("meter", "m"),
    ("meters", "m"),
    ("feet", "ft"),
    ("foot", "ft"),
    ("inch", "in"),
    ("inches", "in"),
    ("tonne", "t"),
    ("tonnes", "t"),
    ("ton", "t"),
    ("kilogram", "kg"),
    ("lbs", "lb"),
    ("sec", "s"),
    ("second", "s"),
    ("seconds", "s"),
    ("minute", "min"),
    ("minutes", "min"),
    ("hr", "h"),
    ("hour", "h"),
    ("hours", "h"),
    ("degree", "deg"),
    ("degrees", "deg"),
    ("radians", "rad"),
    ("newton", "N"),
    ("pascal", "Pa"),
    ("kt", "kn"),
    ("kts", "kn"),
];

/// The unit of a symbol with an optional SI prefix.
pub(super) fn find_unit(symbol: &str) -> Result<Unit, QuantityError> {
    if let Some(unit) = UNITS.iter().find(|unit| unit.symbol == symbol) {
        return Ok(*unit);
    }
    for (prefix, numerator, denominator) in PREFIXES {
        let base = symbol.strip_prefix(*prefix);
        let found = UNITS
            .iter()
            .find(|unit| unit.prefixes && Some(unit.symbol) == base);
        if let Some(unit) = found {
            let numerator = unit.numerator * numerator;
            return Ok(Unit {
                numerator,
                denominator: unit.denominator * denominator,
                ..*unit
            });
        }
    }
    let help = match suggestion(symbol) {
        Some(known) => format!("did you mean `{known}`?"),
        None => {
            "units are for example m, mm, ft, kg, t, s, h, N, kN, MPa, deg, kn (knot), lbf, psi"
                .to_owned()
        }
    };
    Err(QuantityError::Unit(
        format!("unknown unit `{symbol}`"),
        help,
    ))
}

fn suggestion(symbol: &str) -> Option<&'static str> {
    let lower = symbol.to_lowercase();
    let spelled = SPELLED_OUT.iter().find(|(name, _)| *name == lower);
    let common = [
        "m", "mm", "kg", "t", "s", "kN", "MN", "N", "MPa", "GPa", "kPa", "Pa", "deg", "rad",
    ];
    let other_case = || {
        common
            .into_iter()
            .find(|known| known.to_lowercase() == lower)
    };
    let near = || {
        closest(
            symbol,
            UNITS.iter().map(|unit| unit.symbol).filter(|s| s.len() > 2),
        )
    };
    spelled
        .map(|(_, known)| *known)
        .or_else(other_case)
        .or_else(near)
}
