//! Charts of a verification: computed against reference, and errors on refined meshes.

use catenix_results::{VerifiedConvergence, VerifiedCurve, VerifiedEstimate};

use crate::figure::{Chart, ChartAxis, Curve, Look, Panel, Scale};
use crate::number::{significant, split_unit};

/// Width of a drawing across the page [pixels].
const WIDTH: f64 = 780.0;
/// Width of a drawing of errors [pixels].
const ERRORS_WIDTH: f64 = 470.0;
/// Most meshes or steps that are named along the axis; more would not have room.
const MOST_NAMED: usize = 6;
/// How far the line of the least order stands above the error on the coarsest mesh [-].
const BOUND_ABOVE: f64 = 1.6;

/// Computed curve and reference, with their difference below.
pub(super) fn curve_chart(curve: &VerifiedCurve) -> Chart {
    let axis = |label: &str| {
        let (name, unit) = split_unit(label);
        ChartAxis::linear(name, unit)
    };
    let points = |values: &[f64]| {
        let pairs = curve.x.iter().copied().zip(values.iter().copied());
        pairs.collect::<Vec<_>>()
    };
    let difference: Vec<f64> = curve
        .computed
        .iter()
        .zip(&curve.reference)
        .map(|(computed, reference)| computed - reference)
        .collect();
    let y = axis(&curve.y_label);
    let curves = vec![
        Curve::new("computed", points(&curve.computed)).with_look(Look::Computed),
        Curve::new("reference", points(&curve.reference)).with_look(Look::Reference),
    ];
    let mut chart = Chart::new(&curve.name, axis(&curve.x_label), y.clone(), curves);
    chart.width = WIDTH;
    chart.panels[0].height = 230.0;
    let differs = |value: &f64| value.is_finite() && *value != 0.0;
    if difference.iter().any(differs) {
        chart.panels.push(Panel {
            y: ChartAxis {
                label: "difference".to_owned(),
                from_zero: true,
                ..y
            },
            curves: vec![Curve::new("", points(&difference)).with_look(Look::Difference)],
            height: 80.0,
        });
    }
    chart
}

/// Errors on doubly logarithmic axes, beside the slope of the least order that passes.
pub(super) fn convergence_chart(found: &VerifiedConvergence) -> Chart {
    let (label, unit) = split_unit(&found.x_label);
    let points: Vec<(f64, f64)> = found
        .x
        .iter()
        .copied()
        .zip(found.errors.iter().copied())
        .collect();
    let observed = format!("computed, observed order {}", significant(found.order, 3));
    let least = format!(
        "least order that passes, {}",
        significant(found.least_order, 2)
    );
    let mut curves = vec![Curve::new(&observed, points.clone()).with_look(Look::Computed)];
    if let Some(bound) = bound(&points, found) {
        curves.push(Curve::new(&least, bound).with_look(Look::Bound));
    }
    let ticks = match found.x.len() <= MOST_NAMED {
        true => found.x.clone(),
        false => Vec::new(),
    };
    let mut chart = Chart::new(
        &found.name,
        ChartAxis::logarithmic(label, unit).with_ticks(ticks),
        ChartAxis::logarithmic("relative error", "-"),
        curves,
    );
    chart.width = ERRORS_WIDTH;
    chart.panels[0].height = 250.0;
    chart
}

/// True over estimated errors by size, against the share of the estimates that are as good or better.
pub(super) fn estimates_chart(estimates: &[&VerifiedEstimate]) -> Chart {
    let mut ratios: Vec<f64> = estimates
        .iter()
        .map(|estimate| estimate.actual / estimate.estimated)
        .filter(|ratio| Scale::Logarithmic.holds(*ratio))
        .collect();
    ratios.sort_by(f64::total_cmp);
    // Estimates that are not drawn, because the true error is zero, are the best ones.
    let undrawn = estimates.len() - ratios.len();
    let share = |k: usize| 100.0 * (undrawn + k + 1) as f64 / estimates.len() as f64;
    let points = ratios
        .iter()
        .enumerate()
        .map(|(k, ratio)| (share(k), *ratio));
    let curves = vec![
        Curve::new("all estimates, by size", points.collect()).with_look(Look::Computed),
        Curve::new("twice the estimate", vec![(0.0, 2.0), (100.0, 2.0)]).with_look(Look::Bound),
    ];
    let mut chart = Chart::new(
        "True errors and their estimates",
        ChartAxis::linear("share of the estimates", "%"),
        ChartAxis::logarithmic("true error / estimated error", "-"),
        curves,
    );
    chart.width = WIDTH;
    chart.panels[0].height = 230.0;
    chart
}

/// A line of the least order, from the coarsest to the finest mesh or step.
fn bound(points: &[(f64, f64)], found: &VerifiedConvergence) -> Option<Vec<(f64, f64)>> {
    let held = |value: f64| Scale::Logarithmic.holds(value);
    let drawn = points.iter().filter(|(x, error)| held(*x) && held(*error));
    // Meshes are told by a number that grows, steps by one that falls.
    let refined_upwards = found.x_label.starts_with("element");
    let sign = if refined_upwards { -1.0 } else { 1.0 };
    let by_size = |a: &&(f64, f64), b: &&(f64, f64)| (sign * a.0).total_cmp(&(sign * b.0));
    let (coarsest, finest) = (drawn.clone().max_by(by_size)?, drawn.min_by(by_size)?);
    let start = BOUND_ABOVE * coarsest.1;
    let end = start * (finest.0 / coarsest.0).powf(sign * found.least_order);
    let is_line = coarsest.0 != finest.0 && held(end);
    is_line.then(|| vec![(coarsest.0, start), (finest.0, end)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bound_falls_with_refinement_by_the_least_order() {
        let found = |x_label: &str| VerifiedConvergence {
            name: String::new(),
            x_label: x_label.into(),
            x: vec![1.0, 10.0],
            errors: vec![0.1, 0.001],
            order: 2.0,
            least_order: 2.0,
            reason: String::new(),
            passed: true,
        };
        let slope = |x_label: &str, points: &[(f64, f64)]| {
            let line = bound(points, &found(x_label)).unwrap();
            (line[1].1 / line[0].1).log10() / (line[1].0 / line[0].0).log10()
        };
        assert!((slope("elements", &[(1.0, 0.1), (10.0, 0.001)]) + 2.0).abs() < 1e-12);
        assert!((slope("step [s]", &[(1.0, 0.1), (0.1, 0.001)]) - 2.0).abs() < 1e-12);
        assert_eq!(bound(&[], &found("elements")), None);
        assert_eq!(
            bound(&[(1.0, f64::NAN), (2.0, 0.1)], &found("elements")),
            None
        );
    }
}
