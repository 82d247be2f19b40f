//! Morison drag on a slender body: normal and axial, with the resistance to rotation that a finite
//! length has, and the exact derivatives.
//!
//! Source: docs/theory/hydrodynamics.md, eqs. (2) to (6).

use catenix_numerics::{Matrix3, Vector3, so3::hat};

/// Drag coefficients of a whole element or body.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct DragCoefficients {
    /// Force per squared normal speed: rho Cd D l / 2, or rho CdA / 2 [N s2/m2].
    pub normal: f64,
    /// Force per squared axial speed: rho Ct pi D l / 2, or rho CdA / 2 [N s2/m2].
    pub axial: f64,
    /// Mean square distance from the centre along the axis: l^2 / 12 [m2].
    pub radius_squared: f64,
}

/// What drag depends on.
#[derive(Debug, Clone, Copy)]
pub struct DragMotion {
    /// Axis of the element, unit, global (3).
    pub axis: Vector3,
    /// Velocity of the water minus that of the centre, global (3) [m/s].
    pub relative_velocity: Vector3,
    /// Angular velocity of the element, global (3) [rad/s].
    pub spin: Vector3,
}

/// Drag on the structure.
#[derive(Debug, Clone, Copy)]
pub struct Drag {
    /// Force, global (3) [N].
    pub force: Vector3,
    /// Moment about the centre, global (3) [N m].
    pub moment: Vector3,
}

/// Derivatives of [`Drag`].
#[derive(Debug, Clone, Copy)]
pub struct DragTangent {
    /// Force by the relative velocity [N s/m].
    pub force_velocity: Matrix3,
    /// Force by the axis [N].
    pub force_axis: Matrix3,
    /// Force by the spin [N s].
    pub force_spin: Matrix3,
    /// Moment by the relative velocity [N s].
    pub moment_velocity: Matrix3,
    /// Moment by the axis [N m].
    pub moment_axis: Matrix3,
    /// Moment by the spin [N m s].
    pub moment_spin: Matrix3,
}

/// Normal parts and the mean speed over the length.
struct Parts {
    along: f64,
    normal: Vector3,
    spin_along: f64,
    spin_normal: Vector3,
    speed: f64,
}

impl Parts {
    #[inline]
    fn new(c: &DragCoefficients, m: &DragMotion) -> Parts {
        let along = m.axis.dot(&m.relative_velocity);
        let normal = m.relative_velocity - m.axis * along;
        let spin_along = m.axis.dot(&m.spin);
        let spin_normal = m.spin - m.axis * spin_along;
        let speed = (normal.norm_squared() + c.radius_squared * spin_normal.norm_squared()).sqrt();
        Parts {
            along,
            normal,
            spin_along,
            spin_normal,
            speed,
        }
    }
}

/// Drag force and moment on the structure.
///
/// Valid without lift, for a diameter small against the scale of the flow.
/// Source: docs/theory/hydrodynamics.md, eqs. (2) to (4).
#[inline]
pub fn drag(c: &DragCoefficients, m: &DragMotion) -> Drag {
    let p = Parts::new(c, m);
    Drag {
        force: p.normal * (c.normal * p.speed) + m.axis * (c.axial * p.along.abs() * p.along),
        moment: p.spin_normal * (-c.normal * c.radius_squared * p.speed),
    }
}

/// Exact derivatives of [`drag`].
///
/// Source: docs/theory/hydrodynamics.md, eqs. (5) and (6).
#[inline]
pub fn drag_tangent(c: &DragCoefficients, m: &DragMotion) -> DragTangent {
    let p = Parts::new(c, m);
    let along = |v: &Vector3, dot: f64| Matrix3::identity() * dot + m.axis * v.transpose();
    let project = Matrix3::identity() - m.axis * m.axis.transpose();
    let axial = 2.0 * c.axial * p.along.abs();
    let mut tangent = DragTangent {
        force_velocity: project * (c.normal * p.speed) + m.axis * m.axis.transpose() * axial,
        force_axis: along(&m.relative_velocity, p.along) * (-c.normal * p.speed)
            + Matrix3::identity() * (c.axial * p.along.abs() * p.along)
            + m.axis * m.relative_velocity.transpose() * axial,
        force_spin: Matrix3::zeros(),
        moment_velocity: Matrix3::zeros(),
        moment_axis: along(&m.spin, p.spin_along) * (c.normal * c.radius_squared * p.speed),
        moment_spin: project * (-c.normal * c.radius_squared * p.speed),
    };
    if p.speed > 0.0 {
        // Derivatives of the mean speed; the normal parts are normal to the axis.
        let by_velocity = p.normal / p.speed;
        let by_spin = p.spin_normal * (c.radius_squared / p.speed);
        let by_axis = -(by_velocity * p.along + by_spin * p.spin_along);
        let force = p.normal * c.normal;
        let moment = p.spin_normal * (-c.normal * c.radius_squared);
        tangent.force_velocity += force * by_velocity.transpose();
        tangent.force_axis += force * by_axis.transpose();
        tangent.force_spin += force * by_spin.transpose();
        tangent.moment_velocity += moment * by_velocity.transpose();
        tangent.moment_axis += moment * by_axis.transpose();
        tangent.moment_spin += moment * by_spin.transpose();
    }
    tangent
}

/// Added mass as a tensor: `normal` across the axis, `axial` along it [kg].
///
/// Source: docs/theory/hydrodynamics.md, eq. (7).
#[inline]
pub fn added_mass(axis: &Vector3, normal: f64, axial: f64) -> Matrix3 {
    Matrix3::identity() * normal + axis * axis.transpose() * (axial - normal)
}

/// Derivative of a vector function of the axis by a rotation of the body: the axis turns.
#[inline]
pub fn by_rotation(by_axis: &Matrix3, axis: &Vector3) -> Matrix3 {
    by_axis * -hat(axis)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use proptest::prelude::*;

    const C: DragCoefficients = DragCoefficients {
        normal: 3.0,
        axial: 0.7,
        radius_squared: 0.8,
    };

    fn vector() -> impl Strategy<Value = Vector3> {
        prop::array::uniform3(-1.0..1.0f64).prop_map(Vector3::from)
    }

    fn numeric(f: impl Fn(&Vector3) -> Vector3, x: &Vector3) -> Matrix3 {
        let h = 1e-6;
        let columns = [0, 1, 2].map(|k| {
            let mut d = Vector3::zeros();
            d[k] = h;
            (f(&(x + d)) - f(&(x - d))) / (2.0 * h)
        });
        Matrix3::from_columns(&columns)
    }

    proptest! {
        #[test]
        fn derivatives_match_finite_differences(a in vector(), u in vector(), w in vector()) {
            prop_assume!(a.norm() > 0.1 && u.norm() > 0.05);
            let m = DragMotion { axis: a.normalize(), relative_velocity: u, spin: w };
            let t = drag_tangent(&C, &m);
            let by_velocity = |f: fn(Drag) -> Vector3| {
                numeric(|u| f(drag(&C, &DragMotion { relative_velocity: *u, ..m })), &u)
            };
            let by_spin = |f: fn(Drag) -> Vector3| {
                numeric(|w| f(drag(&C, &DragMotion { spin: *w, ..m })), &w)
            };
            // The axis stays unit: only its turning counts.
            let by_turn = |f: fn(Drag) -> Vector3| {
                numeric(
                    |theta| {
                        let axis = catenix_numerics::so3::exp(theta) * m.axis;
                        f(drag(&C, &DragMotion { axis, ..m }))
                    },
                    &Vector3::zeros(),
                )
            };
            assert_relative_eq!(t.force_velocity, by_velocity(|d| d.force), epsilon = 1e-6);
            assert_relative_eq!(t.moment_velocity, by_velocity(|d| d.moment), epsilon = 1e-6);
            assert_relative_eq!(t.force_spin, by_spin(|d| d.force), epsilon = 1e-6);
            assert_relative_eq!(t.moment_spin, by_spin(|d| d.moment), epsilon = 1e-6);
            let turned = by_rotation(&t.force_axis, &m.axis);
            assert_relative_eq!(turned, by_turn(|d| d.force), epsilon = 1e-6);
            let turned = by_rotation(&t.moment_axis, &m.axis);
            assert_relative_eq!(turned, by_turn(|d| d.moment), epsilon = 1e-6);
        }

        #[test]
        fn drag_in_still_water_takes_energy(a in vector(), v in vector(), w in vector()) {
            prop_assume!(a.norm() > 0.1);
            let m = DragMotion { axis: a.normalize(), relative_velocity: -v, spin: w };
            let d = drag(&C, &m);
            prop_assert!(d.force.dot(&v) + d.moment.dot(&w) <= 0.0);
        }
    }

    #[test]
    fn a_cylinder_across_the_flow() {
        let m = DragMotion {
            axis: Vector3::z(),
            relative_velocity: Vector3::new(2.0, 0.0, 0.0),
            spin: Vector3::zeros(),
        };
        assert_relative_eq!(drag(&C, &m).force, Vector3::new(12.0, 0.0, 0.0));
        let along = DragMotion {
            relative_velocity: Vector3::new(0.0, 0.0, -2.0),
            ..m
        };
        assert_relative_eq!(drag(&C, &along).force, Vector3::new(0.0, 0.0, -2.8));
    }

    #[test]
    fn still_water_at_rest_gives_finite_zeros() {
        let m = DragMotion {
            axis: Vector3::z(),
            relative_velocity: Vector3::zeros(),
            spin: Vector3::zeros(),
        };
        let t = drag_tangent(&C, &m);
        assert_eq!(drag(&C, &m).force, Vector3::zeros());
        assert_eq!(
            (t.force_velocity, t.moment_spin),
            (Matrix3::zeros(), Matrix3::zeros())
        );
    }
}
