//! Inertia of a rigid body whose tensors turn with it.
//!
//! Source: docs/theory/dem.md, eqs. (23) and (24).

use catenix_numerics::{Matrix3, Vector3, so3::hat};

/// Tensors of a body in global axes: structure plus added mass.
#[derive(Debug, Clone, Copy)]
pub struct Tensors {
    /// Mass [kg].
    pub mass: Matrix3,
    /// Moment of inertia about the centre [kg m2].
    pub inertia: Matrix3,
}

/// Force and moment that inertia opposes to the motion: M a, and J alpha + w x J w.
#[inline]
pub fn inertia_force(
    tensors: &Tensors,
    spin: &Vector3,
    acceleration: &Vector3,
    angular_acceleration: &Vector3,
) -> (Vector3, Vector3) {
    (
        tensors.mass * acceleration,
        tensors.inertia * angular_acceleration + spin.cross(&(tensors.inertia * spin)),
    )
}

/// Derivatives of [`inertia_force`].
#[derive(Debug, Clone, Copy)]
pub struct InertiaTangent {
    /// Force by a rotation of the body.
    pub force_rotation: Matrix3,
    /// Moment by a rotation of the body.
    pub moment_rotation: Matrix3,
    /// Moment by the angular velocity.
    pub moment_spin: Matrix3,
}

/// Exact derivatives of [`inertia_force`]; those by the accelerations are the tensors themselves.
#[inline]
pub fn inertia_tangent(
    tensors: &Tensors,
    spin: &Vector3,
    acceleration: &Vector3,
    angular_acceleration: &Vector3,
) -> InertiaTangent {
    // A tensor T that turns with the body: d(T a) = theta x (T a) - T (theta x a).
    let turned = |tensor: &Matrix3, v: &Vector3| tensor * hat(v) - hat(&(tensor * v));
    let momentum = tensors.inertia * spin;
    InertiaTangent {
        force_rotation: turned(&tensors.mass, acceleration),
        moment_rotation: turned(&tensors.inertia, angular_acceleration)
            + hat(spin) * turned(&tensors.inertia, spin),
        moment_spin: hat(spin) * tensors.inertia - hat(&momentum),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use catenix_numerics::so3;

    #[test]
    fn derivatives_match_finite_differences() {
        let local = |r: &Matrix3| Tensors {
            mass: r * Matrix3::from_diagonal(&Vector3::new(2.0, 5.0, 5.5)) * r.transpose(),
            inertia: r * Matrix3::from_diagonal(&Vector3::new(0.5, 4.0, 3.0)) * r.transpose(),
        };
        let r = so3::exp(&Vector3::new(0.4, -0.3, 0.9));
        let (w, a, alpha) = (
            Vector3::new(0.7, -1.0, 0.4),
            Vector3::new(1.0, 2.0, -0.5),
            Vector3::new(-0.3, 0.8, 1.2),
        );
        let exact = inertia_tangent(&local(&r), &w, &a, &alpha);
        let h = 1e-6;
        for k in 0..3 {
            let mut d = Vector3::zeros();
            d[k] = h;
            let at =
                |sign: f64| inertia_force(&local(&(so3::exp(&(d * sign)) * r)), &w, &a, &alpha);
            let force = (at(1.0).0 - at(-1.0).0) / (2.0 * h);
            let moment = (at(1.0).1 - at(-1.0).1) / (2.0 * h);
            assert!((exact.force_rotation.column(k) - force).norm() < 1e-7);
            assert!((exact.moment_rotation.column(k) - moment).norm() < 1e-7);
            let at = |sign: f64| inertia_force(&local(&r), &(w + d * sign), &a, &alpha).1;
            let moment = (at(1.0) - at(-1.0)) / (2.0 * h);
            assert!((exact.moment_spin.column(k) - moment).norm() < 1e-7);
        }
    }
}
