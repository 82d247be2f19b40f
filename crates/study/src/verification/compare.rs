//! Computed results against references.

use std::path::Path;

use catenix_results::{VerifiedConvergence, VerifiedCurve, VerifiedNumber};

use super::results::{Computation, Missing, Results};
use super::spec::{Convergence, Curve, Number};

/// Errors below this are round-off, which has no order.
const ROUND_OFF: f64 = 1e-12;

/// A number beside its reference.
pub(super) fn verified_number(
    number: &Number,
    results: &mut Results<'_>,
) -> Result<VerifiedNumber, Missing> {
    let computation = Computation {
        analysis: number.origin.analysis,
        load_case: number.origin.load_case.clone(),
        split: number.split,
        step_s: number.step,
    };
    let (value, unit) = results.value(&computation, &number.origin)?;
    if unit != number.unit {
        return Err(Missing::Failed(format!(
            "`{}`: the reference is in \"{}\", but the result is in \"{unit}\"",
            number.name, number.unit
        )));
    }
    let mut verified = number.not_computed();
    let error = (value - number.reference).abs() / verified.scale;
    verified.computed = Some(value);
    verified.error = Some(error);
    verified.passed = (!number.shown).then_some(error <= number.tolerance);
    Ok(verified)
}

/// A curve beside its reference.
pub(super) fn verified_curve(
    curve: &Curve,
    directory: &Path,
    results: &mut Results<'_>,
) -> Result<VerifiedCurve, Missing> {
    let [x, reference] = read_columns(&directory.join(&curve.file))?;
    let computation = Computation {
        analysis: curve.analysis,
        load_case: curve.load_case.clone(),
        split: curve.split,
        step_s: curve.step,
    };
    let computed_x = results.column(&computation, &curve.x)?;
    let computed_y = results.column(&computation, &curve.y)?;
    let computed = x
        .iter()
        .map(|&x| interpolated(&computed_x.0, &computed_y.0, x))
        .collect::<Option<Vec<f64>>>()
        .ok_or_else(|| {
            format!(
                "`{}`: the computed curve does not cover its reference",
                curve.name
            )
        })?;
    let largest = reference.iter().fold(0.0, |max: f64, v| max.max(v.abs()));
    let error = computed
        .iter()
        .zip(&reference)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max)
        / largest;
    let label = |given: &Option<String>, name: &str, unit: &str| {
        given.clone().unwrap_or_else(|| match unit {
            "" => name.to_owned(),
            unit => format!("{name} [{unit}]"),
        })
    };
    Ok(VerifiedCurve {
        name: curve.name.clone(),
        x_label: label(&curve.x_label, &curve.x, computed_x.1),
        y_label: label(&curve.y_label, &curve.y, computed_y.1),
        x,
        computed,
        reference,
        error,
        tolerance: curve.tolerance,
        reason: curve.reason.clone(),
        passed: (!curve.shown).then_some(error <= curve.tolerance),
    })
}

/// Errors on a series of meshes or steps, and their order.
pub(super) fn verified_convergence(
    convergence: &Convergence,
    results: &mut Results<'_>,
) -> Result<VerifiedConvergence, Missing> {
    let origin = &convergence.origin;
    let of_mesh = convergence.steps.is_empty();
    let count = convergence.splits.len().max(convergence.steps.len());
    if of_mesh == convergence.splits.is_empty() || count < 3 {
        return Err(Missing::Failed(format!(
            "`{}` needs at least three `splits`, or three `steps`",
            convergence.name
        )));
    }
    let mut sizes = Vec::new();
    let mut values = Vec::new();
    for k in 0..count {
        let computation = Computation {
            analysis: origin.analysis,
            load_case: origin.load_case.clone(),
            split: convergence.splits.get(k).copied().unwrap_or(1),
            step_s: convergence.steps.get(k).copied().or(convergence.step),
        };
        values.push(results.value(&computation, origin)?.0);
        sizes.push(match of_mesh {
            true => results.element_count(&computation)? as f64,
            false => convergence.steps[k],
        });
    }
    let reference = match convergence.reference {
        Some(reference) => reference,
        None => {
            sizes.pop();
            values.pop().unwrap_or(f64::NAN)
        }
    };
    let scale = convergence.scale.unwrap_or(reference.abs());
    let errors: Vec<f64> = values
        .iter()
        .map(|value| (value - reference).abs() / scale)
        .collect();
    let floor = convergence.floor.max(ROUND_OFF);
    let order = observed_order(&sizes, &errors, of_mesh, floor);
    // Where all but one error are at the floor, there is no order to see, and none to ask for.
    let at_floor = errors.iter().filter(|&&error| error <= floor).count();
    let exact = at_floor + 1 >= errors.len();
    Ok(VerifiedConvergence {
        name: convergence.name.clone(),
        x_label: if of_mesh { "elements" } else { "step [s]" }.to_owned(),
        x: sizes,
        errors,
        order,
        least_order: convergence.least_order,
        reason: convergence.reason.clone(),
        passed: exact || order >= convergence.least_order,
    })
}

/// Slope of log error over log size by least squares; errors of at most `floor` are left out.
fn observed_order(sizes: &[f64], errors: &[f64], of_mesh: bool, floor: f64) -> f64 {
    let sign = if of_mesh { -1.0 } else { 1.0 };
    let points: Vec<(f64, f64)> = sizes
        .iter()
        .zip(errors)
        .filter(|(_, error)| **error > floor)
        .map(|(size, error)| (sign * size.ln(), error.ln()))
        .collect();
    let n = points.len() as f64;
    let mean = |part: fn(&(f64, f64)) -> f64| points.iter().map(part).sum::<f64>() / n;
    let (mean_x, mean_y) = (mean(|p| p.0), mean(|p| p.1));
    let covariance: f64 = points
        .iter()
        .map(|(x, y)| (x - mean_x) * (y - mean_y))
        .sum();
    let variance: f64 = points.iter().map(|(x, _)| (x - mean_x).powi(2)).sum();
    covariance / variance
}

/// Value at `x` of a piecewise linear curve whose abscissas need not increase: the first stretch
/// that contains `x` counts.
fn interpolated(xs: &[f64], ys: &[f64], x: f64) -> Option<f64> {
    let slack = 1e-9 * (xs.last()? - xs.first()?).abs();
    if let Some(k) = xs.iter().position(|&known| (known - x).abs() <= slack) {
        return Some(ys[k]);
    }
    let k = (1..xs.len()).find(|&k| (xs[k - 1] - x) * (xs[k] - x) <= 0.0)?;
    let share = (x - xs[k - 1]) / (xs[k] - xs[k - 1]);
    Some(ys[k - 1] + share * (ys[k] - ys[k - 1]))
}

/// The first two columns of a CSV file below its header.
fn read_columns(path: &Path) -> Result<[Vec<f64>; 2], String> {
    let text = std::fs::read_to_string(path)
        .map_err(|error| format!("cannot read {}: {error}", path.display()))?;
    let mut columns = [Vec::new(), Vec::new()];
    for (number, line) in text.lines().enumerate().skip(1) {
        if line.trim().is_empty() {
            continue;
        }
        let mut cells = line.split(',').map(|cell| cell.trim().parse::<f64>());
        for column in &mut columns {
            match cells.next() {
                Some(Ok(value)) if value.is_finite() => column.push(value),
                _ => {
                    return Err(format!(
                        "{}, line {}: two numbers with a comma between them",
                        path.display(),
                        number + 1
                    ));
                }
            }
        }
    }
    Ok(columns)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_order_of_a_power_is_its_exponent() {
        let sizes = [5.0, 10.0, 20.0, 40.0];
        let errors = sizes.map(|n: f64| 3.0 * n.powf(-3.5));
        assert!((observed_order(&sizes, &errors, true, ROUND_OFF) - 3.5).abs() < 1e-12);
        let errors = sizes.map(|h: f64| 1e-3 * h * h);
        assert!((observed_order(&sizes, &errors, false, ROUND_OFF) - 2.0).abs() < 1e-12);
    }

    #[test]
    fn curves_are_read_between_their_points_also_on_the_way_back() {
        let (xs, ys) = ([0.0, 1.0, 0.5], [0.0, 2.0, 4.0]);
        assert_eq!(interpolated(&xs, &ys, 0.75), Some(1.5));
        assert_eq!(interpolated(&xs, &ys, 1.0), Some(2.0));
        assert_eq!(interpolated(&xs, &ys, 1.5), None);
    }
}
