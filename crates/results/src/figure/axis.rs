//! Round tick positions and their labels.

/// Range of an axis and its ticks.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Axis {
    pub(crate) min: f64,
    pub(crate) max: f64,
    pub(crate) ticks: Vec<f64>,
    /// Decimals that tell neighbouring ticks apart.
    decimals: usize,
}

impl Axis {
    /// An axis over `min..max` with about `target` ticks at 1, 2 or 5 times a power of ten.
    ///
    /// With `margin` there is a little space beyond the data, else the axis ends where they end.
    pub(crate) fn new(min: f64, max: f64, target: usize, margin: bool) -> Self {
        let (min, max) = widen(min, max);
        let raw = (max - min) / target.max(1) as f64;
        let power = 10_f64.powf(raw.log10().floor());
        let step = [1.0, 2.0, 5.0, 10.0]
            .into_iter()
            .map(|factor| factor * power)
            .find(|step| *step >= raw * (1.0 - 1e-9))
            .unwrap_or(10.0 * power);
        let (min, max) = if margin {
            let space = 0.04 * (max - min);
            (min - space, max + space)
        } else {
            (min, max)
        };
        let first = (min / step - 1e-6).ceil() as i64;
        let last = (max / step + 1e-6).floor() as i64;
        let decimals = (-step.log10().floor()).clamp(0.0, 12.0) as usize;
        Axis {
            min,
            max,
            ticks: (first..=last).map(|i| i as f64 * step).collect(),
            decimals,
        }
    }

    /// Label of a tick, with a real minus sign.
    pub(crate) fn label(&self, tick: f64) -> String {
        let text = format!("{:.*}", self.decimals, tick.abs());
        let is_zero = text.chars().all(|c| c == '0' || c == '.');
        if tick < 0.0 && !is_zero {
            format!("\u{2212}{text}")
        } else {
            text
        }
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

    fn labels(min: f64, max: f64) -> Vec<String> {
        let axis = Axis::new(min, max, 6, true);
        axis.ticks.iter().map(|tick| axis.label(*tick)).collect()
    }

    #[test]
    fn ticks_are_round_and_lie_within_the_axis() {
        assert_eq!(
            labels(-96.2, 0.0),
            ["−100", "−80", "−60", "−40", "−20", "0"]
        );
        assert_eq!(labels(0.0, 0.31), ["0.0", "0.1", "0.2", "0.3"]);
        assert_eq!(labels(5.0, 5.0), ["4.6", "4.8", "5.0", "5.2", "5.4"]);
    }

    #[test]
    fn nothing_to_draw_still_gives_an_axis() {
        assert_eq!(labels(f64::INFINITY, f64::NEG_INFINITY).len(), 6);
    }
}
