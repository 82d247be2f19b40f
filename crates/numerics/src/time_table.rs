//! Functions of time without history: points joined by straight lines, and a smooth step.

/// Value at `x` of a function given by points (x, y) with non-decreasing x: linear between them,
/// constant outside. Of two points at one x the later one holds from there on: a step.
/// `None` without points.
pub fn piecewise_linear(points: &[(f64, f64)], x: f64) -> Option<f64> {
    let after = points.partition_point(|&(t, _)| t <= x);
    match (after.checked_sub(1).map(|k| points[k]), points.get(after)) {
        (None, None) => None,
        (None, Some(&(_, y))) | (Some((_, y)), None) => Some(y),
        (Some((x0, y0)), Some(&(x1, y1))) => Some(y0 + (y1 - y0) * (x - x0) / (x1 - x0)),
    }
}

/// The times of the points, each with whether the function jumps there.
pub fn events(points: &[(f64, f64)]) -> impl Iterator<Item = (f64, bool)> + '_ {
    points.iter().map(|&(time, value)| {
        let jumps = |&(other, at): &(f64, f64)| other == time && at != value;
        (time, points.iter().any(jumps))
    })
}

/// Quintic smooth step from 0 to 1 with its derivative and its integral from 0.
///
/// Source: docs/theory/motions.md, eq. (1).
pub fn smooth_step(s: f64) -> [f64; 3] {
    if s <= 0.0 {
        return [0.0, 0.0, 0.0];
    }
    if s >= 1.0 {
        return [1.0, 0.0, 0.5 + (s - 1.0)];
    }
    let cube = s * s * s;
    [
        cube * (10.0 + s * (-15.0 + 6.0 * s)),
        30.0 * s * s * (1.0 - s) * (1.0 - s),
        cube * s * (2.5 + s * (-3.0 + s)),
    ]
}

/// Second derivative of [`smooth_step`].
///
/// Source: docs/theory/motions.md, eq. (1), differentiated twice.
pub fn smooth_step_curve(s: f64) -> f64 {
    if (0.0..=1.0).contains(&s) {
        60.0 * s * (1.0 - s) * (1.0 - 2.0 * s)
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ramps_and_steps() {
        let points = [(10.0, 0.0), (20.0, 1.0), (30.0, 1.0), (30.0, 0.5)];
        assert_eq!(
            [0.0, 15.0, 25.0, 30.0, 99.0].map(|t| piecewise_linear(&points, t)),
            [0.0, 0.5, 1.0, 0.5, 0.5].map(Some)
        );
        assert_eq!(piecewise_linear(&[], 3.0), None);
    }

    #[test]
    fn the_smooth_step_has_its_derivative_and_its_integral() {
        let h = 1e-5;
        for s in [0.1, 0.5, 0.8] {
            let [value, slope, _] = smooth_step(s);
            let (plus, minus) = (smooth_step(s + h), smooth_step(s - h));
            assert!((slope - (plus[0] - minus[0]) / (2.0 * h)).abs() < 1e-8);
            assert!((value - (plus[2] - minus[2]) / (2.0 * h)).abs() < 1e-8);
            let curve = (plus[1] - minus[1]) / (2.0 * h);
            assert!((smooth_step_curve(s) - curve).abs() < 1e-7);
        }
        assert_eq!(smooth_step(1.5), [1.0, 0.0, 1.0]);
    }
}
