//! Rotations: exponential map, logarithm and their derivatives.
//!
//! A rotation vector `phi` has the direction of the axis and the length of the angle [rad].
//! Source of the closed forms: docs/theory/rotations.md.

use crate::{Matrix3, Vector3};

/// Below this squared angle the series are used; their first dropped terms are then under 1e-16.
const SMALL_ANGLE_SQUARED: f64 = 1e-3;

/// The matrix of the cross product: `hat(a) * b == a.cross(&b)`.
#[inline]
pub fn hat(a: &Vector3) -> Matrix3 {
    Matrix3::new(0.0, -a.z, a.y, a.z, 0.0, -a.x, -a.y, a.x, 0.0)
}

/// Rotation matrix of a rotation vector (Rodrigues).
///
/// Source: docs/theory/rotations.md, eq. (1).
#[inline]
pub fn exp(phi: &Vector3) -> Matrix3 {
    let s = phi.norm_squared();
    let (a, b) = if s < SMALL_ANGLE_SQUARED {
        (
            1.0 - s / 6.0 * (1.0 - s / 20.0 * (1.0 - s / 42.0)),
            0.5 - s / 24.0 * (1.0 - s / 30.0 * (1.0 - s / 56.0)),
        )
    } else {
        let angle = s.sqrt();
        (angle.sin() / angle, (1.0 - angle.cos()) / s)
    };
    let h = hat(phi);
    Matrix3::identity() + h * a + h * h * b
}

/// Rotation vector of a rotation matrix, with an angle in 0..pi.
///
/// Source: docs/theory/rotations.md, eq. (2).
pub fn log(r: &Matrix3) -> Vector3 {
    let axis_sin = 0.5
        * Vector3::new(
            r[(2, 1)] - r[(1, 2)],
            r[(0, 2)] - r[(2, 0)],
            r[(1, 0)] - r[(0, 1)],
        );
    let cos = (0.5 * (r.trace() - 1.0)).clamp(-1.0, 1.0);
    let sin = axis_sin.norm();
    if cos > 0.0 {
        // sin^2 = q; angle / sin as a series where the division loses digits.
        let q = sin * sin;
        let factor = if q < 1e-4 {
            1.0 + q / 6.0 * (1.0 + q * (9.0 / 20.0) * (1.0 + q * (25.0 / 42.0)))
        } else {
            sin.atan2(cos) / sin
        };
        return axis_sin * factor;
    }
    let angle = sin.atan2(cos);
    if sin > 1e-4 {
        return axis_sin * (angle / sin);
    }
    // Near pi the antisymmetric part vanishes: the axis is the largest column of R + I.
    let symmetric = 0.5 * (r + r.transpose()) + Matrix3::identity() * (-cos);
    let column = (0..3)
        .map(|k| symmetric.column(k).into_owned())
        .max_by(|a, b| a.norm_squared().total_cmp(&b.norm_squared()))
        .unwrap_or_else(Vector3::zeros);
    let axis = column.normalize();
    if axis.dot(&axis_sin) < 0.0 {
        -axis * angle
    } else {
        axis * angle
    }
}

/// Left Jacobian: `exp(phi + d) = exp(left_jacobian(phi) d) exp(phi)` to first order in `d`.
///
/// Source: docs/theory/rotations.md, eq. (3).
pub fn left_jacobian(phi: &Vector3) -> Matrix3 {
    let s = phi.norm_squared();
    let (a, b) = if s < SMALL_ANGLE_SQUARED {
        (
            0.5 - s / 24.0 * (1.0 - s / 30.0 * (1.0 - s / 56.0)),
            1.0 / 6.0 - s / 120.0 * (1.0 - s / 42.0 * (1.0 - s / 72.0)),
        )
    } else {
        let angle = s.sqrt();
        ((1.0 - angle.cos()) / s, (angle - angle.sin()) / (s * angle))
    };
    let h = hat(phi);
    Matrix3::identity() + h * a + h * h * b
}

/// Inverse of [`left_jacobian`].
///
/// Source: docs/theory/rotations.md, eq. (4).
pub fn left_jacobian_inverse(phi: &Vector3) -> Matrix3 {
    let s = phi.norm_squared();
    let b = if s < SMALL_ANGLE_SQUARED {
        1.0 / 12.0 + s / 720.0 * (1.0 + s / 42.0 * (1.0 + s / 40.0))
    } else {
        let half = 0.5 * s.sqrt();
        (1.0 - half / half.tan()) / s
    };
    let h = hat(phi);
    Matrix3::identity() - h * 0.5 + h * h * b
}

/// Derivative by `phi` of `left_jacobian(phi) * u`, with `u` held.
///
/// Source: docs/theory/rotations.md, eq. (9).
pub fn left_jacobian_derivative(phi: &Vector3, u: &Vector3) -> Matrix3 {
    let s = phi.norm_squared();
    // The coefficients of the left Jacobian and their derivatives by s.
    let (a, b, a_s, b_s) = if s < SMALL_ANGLE_SQUARED {
        (
            0.5 - s / 24.0 * (1.0 - s / 30.0 * (1.0 - s / 56.0)),
            1.0 / 6.0 - s / 120.0 * (1.0 - s / 42.0 * (1.0 - s / 72.0)),
            -1.0 / 24.0 + s / 360.0 * (1.0 - s * (3.0 / 112.0)),
            -1.0 / 120.0 + s / 2520.0 * (1.0 - s / 48.0),
        )
    } else {
        let angle = s.sqrt();
        let a = (1.0 - angle.cos()) / s;
        let b = (angle - angle.sin()) / (s * angle);
        let a_s = (0.5 * angle.sin() / angle - a) / s;
        (a, b, a_s, 0.5 * (a - 3.0 * b) / s)
    };
    let along = phi.dot(u);
    let turned = phi.cross(u) * a_s + (phi * along - u * s) * b_s;
    hat(u) * -a
        + (Matrix3::identity() * along + phi * u.transpose() - u * phi.transpose() * 2.0) * b
        + turned * phi.transpose() * 2.0
}

/// Pulls a matrix that drifted off SO(3) by round-off back on (one Newton step).
///
/// Source: docs/theory/rotations.md, eq. (7).
#[inline]
pub fn orthonormalise(r: &Matrix3) -> Matrix3 {
    r * (Matrix3::identity() * 1.5 - r.transpose() * r * 0.5)
}

/// The rotation whose first column is `direction` and whose second is as close as possible to
/// `reference` (both unit; not parallel).
pub fn frame_from_direction(direction: &Vector3, reference: &Vector3) -> Matrix3 {
    let second = (reference - direction * direction.dot(reference)).normalize();
    Matrix3::from_columns(&[*direction, second, direction.cross(&second)])
}

/// A unit vector normal to `direction` (unit).
pub fn any_normal(direction: &Vector3) -> Vector3 {
    let trial = if direction.y.abs() < 0.7 {
        Vector3::y()
    } else {
        Vector3::x()
    };
    (trial - direction * direction.dot(&trial)).normalize()
}

/// The smallest rotation that turns `from` into `to` (unit vectors), as a matrix.
///
/// Source: docs/theory/rotations.md, eq. (8).
pub fn shortest_arc(from: &Vector3, to: &Vector3) -> Matrix3 {
    let cross = from.cross(to);
    let sin = cross.norm();
    let cos = from.dot(to);
    if sin < 1e-12 {
        return if cos > 0.0 {
            Matrix3::identity()
        } else {
            exp(&(any_normal(from) * std::f64::consts::PI))
        };
    }
    exp(&(cross * (sin.atan2(cos) / sin)))
}

/// Angles a, b, c of R = Rz(c) Ry(b) Rx(a), (3) [rad]: a and c in -pi..pi, b in -pi/2..pi/2.
///
/// At b = pi/2 only the difference of c and a means anything; a is then taken as zero.
/// Source: docs/theory/rotations.md, eq. (10).
pub fn angles(r: &Matrix3) -> [f64; 3] {
    let across = r[(0, 0)].hypot(r[(1, 0)]);
    let b = (-r[(2, 0)]).atan2(across);
    // Nearer to the pole than this, the entries that hold a and c are mostly rounding.
    if across < 1e-12 {
        return [0.0, b, (-r[(0, 1)]).atan2(r[(1, 1)])];
    }
    [r[(2, 1)].atan2(r[(2, 2)]), b, r[(1, 0)].atan2(r[(0, 0)])]
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use proptest::prelude::*;

    fn vector(limit: f64) -> impl Strategy<Value = Vector3> {
        prop::array::uniform3(-1.0..1.0f64).prop_map(move |a| Vector3::from(a) * limit)
    }

    proptest! {
        #[test]
        fn exp_is_a_rotation_and_log_inverts_it(phi in vector(1.8)) {
            let r = exp(&phi);
            assert_relative_eq!(r.transpose() * r, Matrix3::identity(), epsilon = 1e-14);
            assert_relative_eq!(log(&r), phi, epsilon = 1e-12);
        }

        #[test]
        fn tiny_rotations_lose_no_digits(phi in vector(1e-9)) {
            let back = log(&exp(&phi));
            prop_assert!((back - phi).norm() <= 1e-15 * phi.norm() + 1e-24);
        }

        #[test]
        fn log_near_pi(axis in vector(1.0), below in 0.0..1e-5f64) {
            prop_assume!(axis.norm() > 0.1);
            let phi = axis.normalize() * (std::f64::consts::PI - below);
            let r = exp(&phi);
            assert_relative_eq!(exp(&log(&r)), r, epsilon = 1e-9);
        }

        #[test]
        fn left_jacobian_matches_finite_differences(phi in vector(1.7), d in vector(1.0)) {
            let step = 1e-6;
            let forward = exp(&(phi + d * step)) * exp(&phi).transpose();
            let backward = exp(&(phi - d * step)) * exp(&phi).transpose();
            let numeric = (log(&forward) - log(&backward)) / (2.0 * step);
            assert_relative_eq!(left_jacobian(&phi) * d, numeric, epsilon = 1e-8);
            assert_relative_eq!(
                left_jacobian_inverse(&phi) * left_jacobian(&phi),
                Matrix3::identity(),
                epsilon = 1e-12
            );
        }

        #[test]
        fn left_jacobian_derivative_matches_finite_differences(
            phi in vector(1.7), u in vector(3.0), d in vector(1.0), small in 0.0..1.0f64,
        ) {
            // Half of the angles are in the range of the series.
            let phi = if small < 0.5 { phi * 0.01 } else { phi };
            let step = 1e-5;
            let numeric = (left_jacobian(&(phi + d * step)) - left_jacobian(&(phi - d * step)))
                * u / (2.0 * step);
            // Central differences: 1e-16 / 1e-5 of rounding, 1e-10 of truncation.
            assert_relative_eq!(left_jacobian_derivative(&phi, &u) * d, numeric, epsilon = 1e-8);
        }

        #[test]
        fn angles_compose_to_the_rotation(phi in vector(1.8), pole in prop::bool::ANY) {
            // At the pole the composition must hold too, though its angles are not unique.
            let r = if pole {
                exp(&(Vector3::z() * phi.z))
                    * exp(&(Vector3::y() * std::f64::consts::FRAC_PI_2))
                    * exp(&(Vector3::x() * phi.x))
            } else {
                exp(&phi)
            };
            let [a, b, c] = angles(&r);
            let back = exp(&(Vector3::z() * c)) * exp(&(Vector3::y() * b)) * exp(&(Vector3::x() * a));
            // Where a and c come from entries of 1e-12 (the bound in the code), rounding leaves
            // 1e-16 / 1e-12 of each; their sum, which the matrix shows, is good to that.
            assert_relative_eq!(back, r, epsilon = 1e-3);
            if !pole {
                assert_relative_eq!(back, r, epsilon = 1e-12);
            }
        }

        #[test]
        fn shortest_arc_turns_one_into_the_other(a in vector(1.0), b in vector(1.0)) {
            prop_assume!(a.norm() > 0.1 && b.norm() > 0.1);
            let (a, b) = (a.normalize(), b.normalize());
            assert_relative_eq!(shortest_arc(&a, &b) * a, b, epsilon = 1e-9);
        }
    }
}
