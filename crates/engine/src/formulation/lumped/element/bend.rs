//! The spring against the angle between two neighbouring segments: bending of a round section.
//!
//! Source: docs/theory/lumped.md, eqs. (7) to (13); the discrete curvature is that of
//! Bergou et al. 2008, with the angle itself in place of twice the tangent of its half.

use catenix_numerics::{Matrix3, Vector3};

use super::{Segment, piecewise};

/// Stiffness against the angle at a point.
#[derive(Debug, Clone, PartialEq)]
pub enum BendStiffness {
    /// Moment per angle [N m/rad].
    Linear(f64),
    /// A law of curvature.
    Law {
        /// Curvature [1/m] and moment [N m] (n_points x 2), from (0, 0) on.
        points: Vec<[f64; 2]>,
        /// Length over which the angle is spread: half of both segments [m].
        length: f64,
    },
}

impl BendStiffness {
    /// Moment over angle, derivative of the moment by the angle [N m/rad], and energy [J].
    #[inline]
    pub fn moment(&self, angle: f64) -> (f64, f64, f64) {
        match self {
            BendStiffness::Linear(stiffness) => {
                (*stiffness, *stiffness, 0.5 * stiffness * angle * angle)
            }
            BendStiffness::Law { points, length } => {
                let (moment, slope, area) = piecewise(points, angle / length);
                let ratio = if angle > 0.0 {
                    moment / angle
                } else {
                    slope / length
                };
                (ratio, slope / length, area * length)
            }
        }
    }

    /// Moment per angle at no angle [N m/rad].
    pub fn initial(&self) -> f64 {
        self.moment(0.0).1
    }
}

/// Angle over its sine as a function of the cosine, with its derivative.
///
/// Source: docs/theory/lumped.md, eq. (9); the series is that of the quotient in 1 - cosine.
#[inline]
fn angle_over_sine(cosine: f64) -> (f64, f64) {
    let y = 1.0 - cosine;
    if y < 2e-3 {
        // Each coefficient is the one before times n / (2 n + 1); five of them reach round-off.
        let [a, b, c, d, e] = [1.0 / 3.0, 2.0 / 15.0, 2.0 / 35.0, 8.0 / 315.0, 8.0 / 693.0];
        let value = 1.0 + y * (a + y * (b + y * (c + y * (d + y * e))));
        let slope = a + y * (2.0 * b + y * (3.0 * c + y * (4.0 * d + y * 5.0 * e)));
        return (value, -slope);
    }
    // A segment that is folded back on the one before has no plane of bending.
    let sine_squared = ((1.0 - cosine) * (1.0 + cosine)).max(1e-12);
    let value = cosine.clamp(-1.0, 1.0).acos() / sine_squared.sqrt();
    (value, (cosine * value - 1.0) / sine_squared)
}

/// Energy of the angle as a function of its cosine.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct CosineLaw {
    /// First derivative of the energy [J].
    pub slope: f64,
    /// Second derivative [J].
    pub curve: f64,
    /// Angle [rad].
    pub angle: f64,
    /// Energy [J].
    pub energy: f64,
    /// Moment [N m].
    pub moment: f64,
}

impl CosineLaw {
    /// Source: docs/theory/lumped.md, eqs. (8) and (9).
    #[inline]
    pub fn of_angle(stiffness: &BendStiffness, cosine: f64, sine: f64) -> CosineLaw {
        let (ratio, ratio_slope) = angle_over_sine(cosine);
        let angle = if cosine > 0.0 {
            ratio * sine
        } else {
            sine.atan2(cosine)
        };
        let (secant, tangent, energy) = stiffness.moment(angle);
        CosineLaw {
            slope: -secant * ratio,
            // The second term is that of a law whose tangent is not its secant.
            curve: -secant * ratio_slope
                + if tangent == secant {
                    0.0
                } else {
                    (tangent - secant) * ratio / (angle * sine).max(1e-300)
                },
            angle,
            energy,
            moment: secant * angle,
        }
    }
}

/// The angle at a point, at one state.
#[derive(Debug, Clone, Copy, Default)]
pub struct BendState {
    law: CosineLaw,
    cosine: f64,
    /// Direction of the other segment, across this one (2 x 3).
    across: [Vector3; 2],
}

impl BendState {
    /// For the segments before and after the point.
    #[inline]
    pub fn new(stiffness: &BendStiffness, before: &Segment, after: &Segment) -> BendState {
        let cosine = before.direction.dot(&after.direction);
        let across = [
            after.direction - before.direction * cosine,
            before.direction - after.direction * cosine,
        ];
        let sine = across[0].norm();
        BendState {
            law: CosineLaw::of_angle(stiffness, cosine, sine),
            cosine,
            across,
        }
    }

    /// Derivatives of the energy by the vectors of the two segments, (2 x 3) [N].
    ///
    /// Source: docs/theory/lumped.md, eq. (10).
    #[inline]
    pub fn forces(&self, before: &Segment, after: &Segment) -> [Vector3; 2] {
        [
            self.across[0] * (self.law.slope / before.length),
            self.across[1] * (self.law.slope / after.length),
        ]
    }

    /// Second derivatives of the energy by the vectors of the segments: before and before, before
    /// and after, after and after [N/m].
    ///
    /// Source: docs/theory/lumped.md, eqs. (11) to (13).
    #[inline]
    pub fn tangent(&self, before: &Segment, after: &Segment) -> [Matrix3; 3] {
        let CosineLaw { slope, curve, .. } = self.law;
        let [n, o] = &self.across;
        let (t, u) = (&before.direction, &after.direction);
        let (p, q) = (1.0 / before.length, 1.0 / after.length);
        let own = |across: &Vector3, direction: &Vector3, inverse: f64| -> Matrix3 {
            // curve n n^T - slope (n t^T + t n^T + c (I - t t^T)), over the squared length.
            let c = self.cosine * slope;
            let left = across * curve - direction * slope;
            let right = direction * c - across * slope;
            let sum = left * across.transpose() + right * direction.transpose();
            (sum - Matrix3::identity() * c) * (inverse * inverse)
        };
        let mixed = {
            let first = n * curve - t * slope;
            let sum = first * o.transpose() - (u * slope) * u.transpose();
            (sum + Matrix3::identity() * slope) * (p * q)
        };
        [own(n, t, p), mixed, own(o, u, q)]
    }

    /// Angle [rad].
    #[inline]
    pub fn angle(&self) -> f64 {
        self.law.angle
    }

    /// Moment [N m].
    #[inline]
    pub fn moment(&self) -> f64 {
        self.law.moment
    }

    /// Stored energy [J].
    #[inline]
    pub fn energy(&self) -> f64 {
        self.law.energy
    }
}
