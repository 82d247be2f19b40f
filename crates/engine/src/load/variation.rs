//! How a load varies over time.

use catenix_model::LoadVariation;
use catenix_numerics::time_table::{self, piecewise_linear, smooth_step};

/// Factor on a load at a time.
///
/// Source: docs/theory/loads.md, eqs. (1) and (2).
pub fn factor(variation: &LoadVariation, time: f64) -> f64 {
    match variation {
        LoadVariation::Constant => 1.0,
        LoadVariation::Harmonic {
            angular_frequency,
            phase,
            ramp,
        } => {
            let raised = if *ramp > 0.0 {
                smooth_step(time / ramp)[0]
            } else {
                1.0
            };
            raised * (angular_frequency * time + phase).sin()
        }
        LoadVariation::Table(points) => piecewise_linear(points, time).unwrap_or(1.0),
    }
}

/// Times at which a load bends or jumps, and whether it jumps: a step should end there.
pub fn events(variation: &LoadVariation) -> impl Iterator<Item = (f64, bool)> + '_ {
    let points: &[(f64, f64)] = match variation {
        LoadVariation::Table(points) => points,
        LoadVariation::Constant | LoadVariation::Harmonic { .. } => &[],
    };
    time_table::events(points)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_load_has_its_own_value_at_the_start() {
        assert_eq!(factor(&LoadVariation::Constant, 0.0), 1.0);
        let harmonic = |phase, ramp| LoadVariation::Harmonic {
            angular_frequency: 20.0,
            phase,
            ramp,
        };
        assert_eq!(factor(&harmonic(0.0, 0.0), 0.0), 0.0);
        let quarter = 0.5 * std::f64::consts::PI;
        assert_eq!(factor(&harmonic(quarter, 0.0), 0.0), 1.0);
        assert_eq!(factor(&harmonic(quarter, 3.0), 0.0), 0.0);
        assert!((factor(&harmonic(0.0, 3.0), 4.0) - 80f64.sin()).abs() < 1e-15);
        let triangle = LoadVariation::Table(vec![(0.0, 0.0), (2.5, 1.0), (5.0, 0.0)]);
        assert_eq!(
            [0.0, 1.25, 2.5, 3.75, 9.0].map(|time| factor(&triangle, time)),
            [0.0, 0.5, 1.0, 0.5, 0.0]
        );
        let bends = [(0.0, false), (2.5, false), (5.0, false)];
        assert_eq!(events(&triangle).collect::<Vec<_>>(), bends);
    }
}
