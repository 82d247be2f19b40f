//! Tick positions and their labels, on linear and on logarithmic axes.

use super::chart::Scale;
use crate::number::{minus, raised, shortest};

/// Fewest ticks of a linear axis, where round numbers allow it.
const LEAST_TICKS: i64 = 3;
/// Most decades that are labelled one by one.
const MOST_DECADES: i32 = 9;
/// Tick values on logarithmic axes outside these limits are written as powers of ten.
const PLAIN: (f64, f64) = (1e-3, 1e5);

/// Range of an axis and its ticks.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Axis {
    scale: Scale,
    /// Ends, as exponents of ten on a logarithmic axis.
    ends: (f64, f64),
    pub(crate) ticks: Vec<Tick>,
    /// Ticks without label and grid line.
    pub(crate) minor: Vec<f64>,
}

/// A labelled tick.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Tick {
    pub(crate) value: f64,
    pub(crate) label: String,
}

impl Axis {
    /// An axis over the values with about `target` ticks.
    ///
    /// With `margin` there is a little space beyond the data, else a linear axis ends where they
    /// end; logarithmic axes always have a margin. Values that are not finite, and on a
    /// logarithmic axis those that are not positive, do not count.
    pub(crate) fn new(
        scale: Scale,
        values: impl Iterator<Item = f64>,
        target: usize,
        margin: bool,
    ) -> Self {
        let (min, max) = values
            .filter(|value| scale.holds(*value))
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), value| {
                (lo.min(value), hi.max(value))
            });
        match scale {
            Scale::Linear => linear(min, max, target, margin),
            Scale::Logarithmic => logarithmic(min, max, target),
        }
    }

    /// Distance between the ends; in decades on a logarithmic axis.
    pub(crate) fn length(&self) -> f64 {
        self.ends.1 - self.ends.0
    }

    /// A linear axis of this length about the same middle.
    pub(crate) fn stretched(&self, length: f64, target: usize) -> Axis {
        let middle = 0.5 * (self.ends.0 + self.ends.1);
        linear(middle - 0.5 * length, middle + 0.5 * length, target, false)
    }

    /// Puts the labelled ticks where they are wanted; those beyond the ends are left out.
    pub(crate) fn set_ticks(&mut self, values: impl Iterator<Item = f64>) {
        let ticks = values.map(|value| Tick {
            value,
            label: shortest(value, 6),
        });
        self.ticks = ticks
            .filter(|tick| (0.0..=1.0).contains(&self.place(tick.value)))
            .collect();
        self.minor.clear();
    }

    /// Place of a value: 0 at the beginning of the axis, 1 at its end; NaN where it has none.
    pub(crate) fn place(&self, value: f64) -> f64 {
        let (first, last) = self.ends;
        let at = match self.scale {
            Scale::Linear => value,
            Scale::Logarithmic if value > 0.0 => value.log10(),
            Scale::Logarithmic => f64::NAN,
        };
        (at - first) / (last - first)
    }

    /// Whether a tick stands at zero.
    pub(crate) fn is_zero(&self, tick: &Tick) -> bool {
        let (first, last) = self.ends;
        self.scale == Scale::Linear && tick.value.abs() < 1e-12 * (last - first)
    }
}

/// Ticks at 1, 2 or 5 times a power of ten.
fn linear(min: f64, max: f64, target: usize, margin: bool) -> Axis {
    let (min, max) = widen(min, max);
    let raw = (max - min) / target.max(1) as f64;
    let power = 10_f64.powf(raw.log10().floor());
    let space = if margin { 0.04 * (max - min) } else { 0.0 };
    let (min, max) = (min - space, max + space);
    let ends = |step: f64| {
        let first = (min / step - 1e-6).ceil() as i64;
        let last = (max / step + 1e-6).floor() as i64;
        (first, last)
    };
    // The shortest step with no more ticks than wanted, or a shorter one where these are too few.
    let steps = [10.0, 5.0, 2.0, 1.0, 0.5, 0.2].map(|factor| factor * power);
    let shortest = steps.iter().rposition(|step| *step >= raw * (1.0 - 1e-9));
    let has_enough = |step: &f64| {
        let (first, last) = ends(*step);
        last - first + 1 >= LEAST_TICKS
    };
    let mut choices = steps.into_iter().skip(shortest.unwrap_or(0));
    let step = choices.find(has_enough).unwrap_or(0.2 * power);
    let (first, last) = ends(step);
    let decimals = (-(step * (1.0 + 1e-9)).log10().floor()).clamp(0.0, 12.0) as usize;
    let ticks = (first..=last).map(|i| i as f64 * step).map(|value| Tick {
        value,
        label: minus(&format!("{value:.decimals$}")),
    });
    Axis {
        scale: Scale::Linear,
        ends: (min, max),
        ticks: ticks.collect(),
        minor: Vec::new(),
    }
}

/// Ticks at powers of ten, or at 1, 2 and 5 times a power of ten where there are few of these.
fn logarithmic(min: f64, max: f64, target: usize) -> Axis {
    let (min, max) = if min <= max { (min, max) } else { (1.0, 10.0) };
    let (mut low, mut high) = (min.log10(), max.log10());
    let space = (0.05 * (high - low)).max(0.06);
    low -= space;
    high += space;
    let inside = |value: &f64| (low..=high).contains(&value.log10());
    let decades = low.floor() as i32..=high.ceil() as i32;
    let multiples = |factors: &'static [f64]| {
        decades
            .clone()
            .flat_map(move |decade| {
                let power = 10_f64.powi(decade);
                factors.iter().map(move |factor| factor * power)
            })
            .filter(inside)
    };
    let count = |factors: &'static [f64]| multiples(factors).count();
    let all: &[f64] = &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0];
    let wanted = target.max(3);
    let choices: [&'static [f64]; 3] = [
        &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0],
        &[1.0, 2.0, 5.0],
        &[1.0],
    ];
    let factors = choices
        .into_iter()
        .find(|factors| count(factors) <= wanted)
        .unwrap_or(&[1.0]);
    let every = if factors.len() > 1 {
        1
    } else {
        (*decades.end() - *decades.start()) / MOST_DECADES + 1
    };
    let plain = min >= PLAIN.0 && max < PLAIN.1 && (factors.len() > 1 || high - low <= 4.0);
    let ticks = multiples(factors)
        .filter(|value| (value.log10().floor() as i32).rem_euclid(every) == 0)
        .map(|value| Tick {
            value,
            label: if plain {
                plain_label(value)
            } else {
                power_label(value)
            },
        });
    let ticks: Vec<Tick> = ticks.collect();
    let minor = if every > 1 { &[1.0] } else { all };
    Axis {
        scale: Scale::Logarithmic,
        ends: (low, high),
        ticks,
        minor: multiples(minor).collect(),
    }
}

/// The largest of 1, 2 and 5 times a power of ten that is not above `length`.
pub(crate) fn nice_length(length: f64) -> f64 {
    let power = 10_f64.powf(length.log10().floor());
    let factors = [5.0, 2.0, 1.0].into_iter();
    let mut fitting = factors.filter(|factor| factor * power <= length * (1.0 + 1e-9));
    fitting.next().unwrap_or(1.0) * power
}

fn plain_label(value: f64) -> String {
    let decimals = (-(value * (1.0 + 1e-9)).log10().floor()).clamp(0.0, 12.0) as usize;
    format!("{value:.decimals$}")
}

/// `10⁻³` or `2×10⁻³`.
fn power_label(value: f64) -> String {
    let exponent = (value * (1.0 + 1e-9)).log10().floor() as i32;
    let factor = (value / 10_f64.powi(exponent)).round();
    let power = format!("10{}", raised(exponent));
    if factor == 1.0 {
        power
    } else {
        format!("{factor}×{power}")
    }
}

/// A range that is not empty.
fn widen(min: f64, max: f64) -> (f64, f64) {
    if !(min.is_finite() && max.is_finite()) {
        return (0.0, 1.0);
    }
    // Curves that are constant up to rounding are drawn flat, not as magnified rounding noise.
    let least = 1e-9 * min.abs().max(max.abs());
    if max - min > least {
        (min, max)
    } else {
        let half = (0.05 * max.abs()).max(0.5);
        (min - half, max + half)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(scale: Scale, values: &[f64]) -> Vec<String> {
        let axis = Axis::new(scale, values.iter().copied(), 6, true);
        axis.ticks.into_iter().map(|tick| tick.label).collect()
    }

    #[test]
    fn ticks_are_round_and_lie_within_the_axis() {
        assert_eq!(
            labels(Scale::Linear, &[-96.2, 0.0]),
            ["−100", "−80", "−60", "−40", "−20", "0"]
        );
        assert_eq!(
            labels(Scale::Linear, &[0.0, 0.31]),
            ["0.0", "0.1", "0.2", "0.3"]
        );
        assert_eq!(
            labels(Scale::Linear, &[5.0, 5.0]),
            ["4.6", "4.8", "5.0", "5.2", "5.4"]
        );
        // Where one round number falls between the ends, shorter steps are taken.
        let axis = Axis::new(Scale::Linear, [-4.0, 4.0].into_iter(), 2, false);
        assert_eq!(axis.ticks.len(), 5);
    }

    #[test]
    fn logarithmic_ticks_are_decades_or_round_numbers_between() {
        assert_eq!(
            labels(Scale::Logarithmic, &[3e-7, 4e-3]),
            ["10⁻⁶", "10⁻⁵", "10⁻⁴", "10⁻³"]
        );
        assert_eq!(
            labels(Scale::Logarithmic, &[5.0, 80.0]),
            ["5", "10", "20", "50"]
        );
        assert_eq!(
            labels(Scale::Logarithmic, &[0.001, 0.1]),
            ["0.001", "0.01", "0.1"]
        );
        assert_eq!(
            labels(Scale::Logarithmic, &[2e-6, 5e-6]),
            ["2×10⁻⁶", "3×10⁻⁶", "4×10⁻⁶", "5×10⁻⁶"]
        );
        let long = labels(Scale::Logarithmic, &[1e-16, 1e6]);
        assert!(
            long.len() <= 10 && long.contains(&"10⁰".to_owned()),
            "{long:?}"
        );
    }

    #[test]
    fn places_run_from_one_end_to_the_other() {
        let axis = Axis::new(Scale::Logarithmic, [1.0, 100.0].into_iter(), 6, true);
        assert!((axis.place(10.0) - 0.5).abs() < 1e-12);
        assert!(axis.place(1.0) > 0.0 && axis.place(100.0) < 1.0);
        assert!(axis.place(0.0).is_nan() && axis.place(-1.0).is_nan());
    }

    #[test]
    fn ticks_stand_where_they_are_wanted() {
        let mut axis = Axis::new(Scale::Logarithmic, [3.0, 48.0].into_iter(), 6, true);
        axis.set_ticks([3.0, 6.0, 12.0, 24.0, 48.0, 960.0, f64::NAN].into_iter());
        let labels: Vec<&str> = axis.ticks.iter().map(|tick| tick.label.as_str()).collect();
        assert_eq!(labels, ["3", "6", "12", "24", "48"]);
    }

    #[test]
    fn nothing_to_draw_still_gives_an_axis() {
        assert_eq!(labels(Scale::Linear, &[]).len(), 6);
        assert!(!labels(Scale::Logarithmic, &[0.0, f64::NAN]).is_empty());
    }
}
