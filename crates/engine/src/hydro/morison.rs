//! Morison drag on a slender body: normal and axial, with the resistance to rotation that a finite
//! length has, and the exact derivatives.
//!
//! Source: docs/theory/hydrodynamics.md, eqs. (2) to (6).

use catenix_numerics::lanes::{Lane, Mat3, Vec3};
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

/// Drag on one body or several in lanes: normal parts and the mean speed over the length.
#[derive(Debug, Clone, Copy)]
pub struct DragKernel<T> {
    /// The three coefficients of [`DragCoefficients`].
    coefficients: [T; 3],
    axis: Vec3<T>,
    relative_velocity: Vec3<T>,
    spin: Vec3<T>,
    along: T,
    normal: Vec3<T>,
    spin_along: T,
    spin_normal: Vec3<T>,
    speed: T,
}

/// Derivatives of drag, in lanes; see [`DragTangent`].
#[derive(Debug, Clone, Copy)]
pub struct DragDerivatives<T> {
    /// Force by the relative velocity, the axis and the spin.
    pub force: [Mat3<T>; 3],
    /// Moment by the same.
    pub moment: [Mat3<T>; 3],
}

impl<T: Lane> DragKernel<T> {
    /// With the coefficients for normal and axial flow and the squared radius of
    /// [`DragCoefficients`].
    #[inline(always)]
    pub fn new(
        coefficients: [T; 3],
        axis: Vec3<T>,
        relative_velocity: Vec3<T>,
        spin: Vec3<T>,
    ) -> Self {
        let along = axis.dot(relative_velocity);
        let normal = relative_velocity.minus(along, axis);
        let spin_along = axis.dot(spin);
        let spin_normal = spin.minus(spin_along, axis);
        let turning = coefficients[2] * spin_normal.norm_squared();
        DragKernel {
            coefficients,
            axis,
            relative_velocity,
            spin,
            along,
            normal,
            spin_along,
            spin_normal,
            speed: (normal.norm_squared() + turning).sqrt(),
        }
    }

    /// Force and moment on the structure.
    ///
    /// Source: docs/theory/hydrodynamics.md, eqs. (2) to (4).
    #[inline(always)]
    pub fn load(&self) -> [Vec3<T>; 2] {
        let [normal, axial, radius_squared] = self.coefficients;
        let normal = normal * self.speed;
        [
            (self.normal * normal).plus(axial * self.along.abs() * self.along, self.axis),
            self.spin_normal * -(normal * radius_squared),
        ]
    }

    /// Exact derivatives of [`Self::load`].
    ///
    /// Source: docs/theory/hydrodynamics.md, eqs. (5) and (6).
    #[inline(always)]
    pub fn derivatives(&self) -> DragDerivatives<T> {
        let [coefficient, axial, radius_squared] = self.coefficients;
        let (axis, zero) = (self.axis, self.speed.same(0.0));
        let normal = coefficient * self.speed;
        let turning = normal * radius_squared;
        let steep = (axial + axial) * self.along.abs();
        // Derivatives of the mean speed; the normal parts are normal to the axis. At no speed at all
        // it has none that matters.
        let moving = zero.less(self.speed);
        let still = T::select(moving, self.speed, zero.same(1.0));
        let inverse = T::select(moving, zero.same(1.0) / still, zero);
        let by_velocity = self.normal * inverse;
        let by_spin = self.spin_normal * (radius_squared * inverse);
        let by_axis = -(by_velocity * self.along).plus(self.spin_along, by_spin);
        let force = self.normal * coefficient;
        let moment = self.spin_normal * -(coefficient * radius_squared);
        DragDerivatives {
            force: [
                (axis * (steep - normal))
                    .outer(axis)
                    .plus_diagonal(normal)
                    .plus_outer(force, by_velocity),
                (axis * (steep - normal))
                    .outer(self.relative_velocity)
                    .plus_diagonal((axial * self.along.abs() - normal) * self.along)
                    .plus_outer(force, by_axis),
                force.outer(by_spin),
            ],
            moment: [
                moment.outer(by_velocity),
                (axis * turning)
                    .outer(self.spin)
                    .plus_diagonal(turning * self.spin_along)
                    .plus_outer(moment, by_axis),
                (axis * turning)
                    .outer(axis)
                    .plus_diagonal(-turning)
                    .plus_outer(moment, by_spin),
            ],
        }
    }
}

/// Drag on points of lines, which does not know of their rotation: [`DragKernel`] without spin.
#[derive(Debug, Clone, Copy)]
pub struct PointDrag<T> {
    /// For normal and axial flow.
    coefficients: [T; 2],
    axis: Vec3<T>,
    along: T,
    normal: Vec3<T>,
    speed: T,
}

impl<T: Lane> PointDrag<T> {
    /// With the coefficients for normal and axial flow.
    #[inline(always)]
    pub fn new(coefficients: [T; 2], axis: Vec3<T>, relative_velocity: Vec3<T>) -> Self {
        let along = axis.dot(relative_velocity);
        let normal = relative_velocity.minus(along, axis);
        PointDrag {
            coefficients,
            axis,
            along,
            normal,
            speed: normal.norm_squared().sqrt(),
        }
    }

    /// Force on the structure.
    ///
    /// Source: docs/theory/hydrodynamics.md, eqs. (2) and (3).
    #[inline(always)]
    pub fn force(&self) -> Vec3<T> {
        let [normal, axial] = self.coefficients;
        (self.normal * (normal * self.speed)).plus(axial * self.along.abs() * self.along, self.axis)
    }

    /// Exact derivatives of [`Self::force`]: by the relative velocity, and by the axis, which stays
    /// unit: nothing along it.
    ///
    /// Source: docs/theory/hydrodynamics.md, eqs. (5) and (6).
    #[inline(always)]
    pub fn derivatives(&self) -> [Mat3<T>; 2] {
        let [coefficient, axial] = self.coefficients;
        let (axis, zero) = (self.axis, self.speed.same(0.0));
        let normal = coefficient * self.speed;
        let sliding = axial * self.along.abs();
        let steep = axis * (sliding + sliding - normal);
        let moving = zero.less(self.speed);
        let still = T::select(moving, self.speed, zero.same(1.0));
        let inverse = T::select(moving, coefficient / still, zero);
        let growing = self.normal * inverse;
        let turned = (sliding - normal) * self.along;
        [
            steep
                .outer(axis)
                .plus_diagonal(normal)
                .plus_outer(growing, self.normal),
            // (I - axis axis^T) on the right.
            (steep - growing * self.along)
                .outer(self.normal)
                .plus_diagonal(turned)
                .plus_outer(axis * -turned, axis),
        ]
    }
}

impl DragKernel<f64> {
    fn of(c: &DragCoefficients, m: &DragMotion) -> Self {
        DragKernel::new(
            [c.normal, c.axial, c.radius_squared],
            (&m.axis).into(),
            (&m.relative_velocity).into(),
            (&m.spin).into(),
        )
    }
}

/// Drag force and moment on the structure.
///
/// Valid without lift, for a diameter small against the scale of the flow.
/// Source: docs/theory/hydrodynamics.md, eqs. (2) to (4).
#[inline]
pub fn drag(c: &DragCoefficients, m: &DragMotion) -> Drag {
    let [force, moment] = DragKernel::of(c, m).load();
    Drag {
        force: force.into(),
        moment: moment.into(),
    }
}

/// Exact derivatives of [`drag`].
///
/// Source: docs/theory/hydrodynamics.md, eqs. (5) and (6).
#[inline]
pub fn drag_tangent(c: &DragCoefficients, m: &DragMotion) -> DragTangent {
    let DragDerivatives { force, moment } = DragKernel::of(c, m).derivatives();
    let [force_velocity, force_axis, force_spin] = force.map(Matrix3::from);
    let [moment_velocity, moment_axis, moment_spin] = moment.map(Matrix3::from);
    DragTangent {
        force_velocity,
        force_axis,
        force_spin,
        moment_velocity,
        moment_axis,
        moment_spin,
    }
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
        fn points_feel_what_bodies_do(a in vector(), u in vector()) {
            prop_assume!(a.norm() > 0.1 && u.norm() > 0.05);
            let axis = a.normalize();
            let m = DragMotion { axis, relative_velocity: u, spin: Vector3::zeros() };
            let point = PointDrag::new([C.normal, C.axial], (&axis).into(), (&u).into());
            let t = drag_tangent(&C, &m);
            let [by_velocity, by_axis] = point.derivatives().map(Matrix3::from);
            let across = Matrix3::identity() - axis * axis.transpose();
            assert_relative_eq!(Vector3::from(point.force()), drag(&C, &m).force, epsilon = 1e-12);
            assert_relative_eq!(by_velocity, t.force_velocity, epsilon = 1e-12);
            assert_relative_eq!(by_axis, t.force_axis * across, epsilon = 1e-12);
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
