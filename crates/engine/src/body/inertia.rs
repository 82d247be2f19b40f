//! Inertia of a rigid body whose tensors turn with it.
//!
//! Source: docs/theory/dem.md, eqs. (23) and (24).

use catenix_numerics::lanes::{Lane, Mat3, Vec3};

/// Tensors of a body in global axes: structure plus added mass.
#[derive(Debug, Clone, Copy)]
pub struct Tensors<T = f64> {
    /// Mass [kg].
    pub mass: Mat3<T>,
    /// Moment of inertia about the centre [kg m2].
    pub inertia: Mat3<T>,
}

/// Motion of a body that inertia opposes, global.
#[derive(Debug, Clone, Copy)]
pub struct BodyMotion<T> {
    /// Angular velocity (3) [rad/s].
    pub spin: Vec3<T>,
    /// Acceleration (3) [m/s2].
    pub acceleration: Vec3<T>,
    /// Angular acceleration (3) [rad/s2].
    pub angular_acceleration: Vec3<T>,
}

/// Force and moment that inertia opposes to the motion: M a, and J alpha + w x J w.
#[inline(always)]
pub fn inertia_force<T: Lane>(tensors: &Tensors<T>, motion: &BodyMotion<T>) -> [Vec3<T>; 2] {
    let momentum = tensors.inertia.times(motion.spin);
    [
        tensors.mass.times(motion.acceleration),
        tensors.inertia.times(motion.angular_acceleration) + motion.spin.cross(momentum),
    ]
}

/// Derivatives of [`inertia_force`].
#[derive(Debug, Clone, Copy)]
pub struct InertiaTangent<T> {
    /// Force by a rotation of the body.
    pub force_rotation: Mat3<T>,
    /// Moment by a rotation of the body.
    pub moment_rotation: Mat3<T>,
    /// Moment by the angular velocity.
    pub moment_spin: Mat3<T>,
}

/// Exact derivatives of [`inertia_force`]; those by the accelerations are the tensors themselves.
#[inline(always)]
pub fn inertia_tangent<T: Lane>(tensors: &Tensors<T>, motion: &BodyMotion<T>) -> InertiaTangent<T> {
    let spin = motion.spin;
    let momentum = tensors.inertia.times(spin);
    InertiaTangent {
        force_rotation: turned(tensors.mass, motion.acceleration),
        moment_rotation: turned(tensors.inertia, motion.angular_acceleration)
            + turned(tensors.inertia, spin).crossed_by(spin),
        moment_spin: tensors.inertia.crossed_by(spin).plus_hat(-momentum),
    }
}

/// Derivative of T v by a rotation of the tensor T: theta x (T v) - T (theta x v).
#[inline(always)]
fn turned<T: Lane>(tensor: Mat3<T>, v: Vec3<T>) -> Mat3<T> {
    tensor.crossing(v).plus_hat(-tensor.times(v))
}

#[cfg(test)]
mod tests {
    use super::*;
    use catenix_numerics::{Matrix3, Vector3, so3};

    #[test]
    fn derivatives_match_finite_differences() {
        let tensor =
            |r: &Matrix3, d: [f64; 3]| r * Matrix3::from_diagonal(&d.into()) * r.transpose();
        let local = |r: &Matrix3| Tensors {
            mass: (&tensor(r, [2.0, 5.0, 5.5])).into(),
            inertia: (&tensor(r, [0.5, 4.0, 3.0])).into(),
        };
        let r = so3::exp(&Vector3::new(0.4, -0.3, 0.9));
        let motion = |w: Vector3| BodyMotion {
            spin: (&w).into(),
            acceleration: Vec3::new(1.0, 2.0, -0.5),
            angular_acceleration: Vec3::new(-0.3, 0.8, 1.2),
        };
        let w = Vector3::new(0.7, -1.0, 0.4);
        let exact = inertia_tangent(&local(&r), &motion(w));
        let load =
            |tensors: &Tensors, w: Vector3| inertia_force(tensors, &motion(w)).map(Vector3::from);
        let h = 1e-6;
        for k in 0..3 {
            let mut d = Vector3::zeros();
            d[k] = h;
            let at = |sign: f64| load(&local(&(so3::exp(&(d * sign)) * r)), w);
            let force = (at(1.0)[0] - at(-1.0)[0]) / (2.0 * h);
            let moment = (at(1.0)[1] - at(-1.0)[1]) / (2.0 * h);
            assert!((Matrix3::from(exact.force_rotation).column(k) - force).norm() < 1e-7);
            assert!((Matrix3::from(exact.moment_rotation).column(k) - moment).norm() < 1e-7);
            let at = |sign: f64| load(&local(&r), w + d * sign)[1];
            let moment = (at(1.0) - at(-1.0)) / (2.0 * h);
            assert!((Matrix3::from(exact.moment_spin).column(k) - moment).norm() < 1e-7);
        }
    }
}
