//! Weights of interpolation on any points in time: derivatives, extrapolation, divided differences.
//!
//! Source: docs/theory/integration.md, eqs. (11), (13) and (14).

/// Most points that a formula uses.
pub(crate) const MOST_POINTS: usize = 7;

/// One weight per point; those beyond the points in use are zero.
pub(crate) type Weights = [f64; MOST_POINTS];

/// Weights w of the derivative at `times[0]` of the polynomial through all points [1/s].
pub(crate) fn derivative(times: &[f64]) -> Weights {
    let mut weights = [0.0; MOST_POINTS];
    for j in 1..times.len() {
        let mut weight = 1.0 / (times[j] - times[0]);
        for (i, time) in times.iter().enumerate().skip(1) {
            if i != j {
                weight *= (times[0] - time) / (times[j] - time);
            }
        }
        weights[j] = weight;
        weights[0] += 1.0 / (times[0] - times[j]);
    }
    weights
}

/// Weights of the value at `time` of the polynomial through all points.
pub(crate) fn extrapolation(time: f64, times: &[f64]) -> Weights {
    let mut weights = [0.0; MOST_POINTS];
    for (j, own) in times.iter().enumerate() {
        weights[j] = 1.0;
        for (i, other) in times.iter().enumerate() {
            if i != j {
                weights[j] *= (time - other) / (own - other);
            }
        }
    }
    weights
}

/// Weights of the divided difference over all points [1/s^(n - 1)].
pub(crate) fn divided_difference(times: &[f64]) -> Weights {
    let mut weights = [0.0; MOST_POINTS];
    for (j, own) in times.iter().enumerate() {
        weights[j] = 1.0;
        for (i, other) in times.iter().enumerate() {
            if i != j {
                weights[j] /= own - other;
            }
        }
    }
    weights
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    const TIMES: [f64; 5] = [0.9, 0.7, 0.65, 0.2, -0.1];

    fn apply(weights: &Weights, times: &[f64], f: impl Fn(f64) -> f64) -> f64 {
        times.iter().zip(weights).map(|(&t, w)| w * f(t)).sum()
    }

    #[test]
    fn exact_for_polynomials_through_the_points() {
        for points in 2..=TIMES.len() {
            let times = &TIMES[..points];
            let degree = points as i32 - 1;
            let power = |t: f64| t.powi(degree);
            // Five points 0.05 apart amplify rounding some thousand times.
            let found = apply(&derivative(times), times, power);
            let exact = f64::from(degree) * times[0].powi(degree - 1);
            assert_relative_eq!(found, exact, epsilon = 1e-11);
            let found = apply(&extrapolation(1.3, times), times, power);
            assert_relative_eq!(found, 1.3f64.powi(degree), epsilon = 1e-11);
            // The leading coefficient of the polynomial.
            let found = apply(&divided_difference(times), times, power);
            assert_relative_eq!(found, 1.0, epsilon = 1e-10);
        }
    }
}
