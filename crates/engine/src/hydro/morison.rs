//! Morison drag on a slender body, normal and axial, and its exact derivatives.
//!
//! Source: docs/theory/hydrodynamics.md, eqs. (2) to (6a).

use catenix_numerics::lanes::{Lane, Mat3, Vec3};
use catenix_numerics::{Matrix3, Vector3};

/// Drag coefficients of a whole element or body.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct DragCoefficients {
    /// Force per squared normal speed: rho Cd D l / 2, or rho CdA / 2 [N s2/m2].
    pub normal: f64,
    /// Force per squared axial speed: rho Ct pi D l / 2, or rho CdA / 2 [N s2/m2].
    pub axial: f64,
    /// Root of the mean square distance from the centre along the axis: l / sqrt(12) [m].
    pub radius: f64,
}

/// Drag on one body or several in lanes: half of it at each of two points of the axis, at the
/// radius of [`DragCoefficients`] from the centre.
#[derive(Debug, Clone, Copy)]
pub struct StripDrag<T> {
    /// The three coefficients of [`DragCoefficients`].
    coefficients: [T; 3],
    axis: Vec3<T>,
    relative_velocity: Vec3<T>,
    spin: Vec3<T>,
    along: T,
    /// Normal velocity of the water against each point, and its size.
    normals: [Vec3<T>; 2],
    speeds: [T; 2],
}

/// Force and moment of [`StripDrag`], or their derivatives by one thing.
#[derive(Debug, Clone, Copy)]
pub struct Wrench<V> {
    /// Force, global [N].
    pub force: V,
    /// Moment about the centre, global [N m].
    pub moment: V,
}

/// Derivatives of drag, in lanes.
#[derive(Debug, Clone, Copy)]
pub struct DragDerivatives<T> {
    /// By the relative velocity [N s/m, N s].
    pub velocity: Wrench<Mat3<T>>,
    /// By the spin [N s, N m s].
    pub spin: Wrench<Mat3<T>>,
    /// By a rotation of the body, at the same velocities [N, N m].
    pub rotation: Wrench<Mat3<T>>,
}

impl<T: Lane> StripDrag<T> {
    /// With the coefficients for normal and axial flow and the radius of [`DragCoefficients`], the
    /// axis (unit), the velocity of the water minus that of the centre, and the angular velocity of
    /// the body, global.
    #[inline(always)]
    pub fn new(
        coefficients: [T; 3],
        axis: Vec3<T>,
        relative_velocity: Vec3<T>,
        spin: Vec3<T>,
    ) -> Self {
        let along = axis.dot(relative_velocity);
        let normal = relative_velocity.minus(along, axis);
        let sweep = spin.cross(axis) * coefficients[2];
        let normals = [normal - sweep, normal + sweep];
        StripDrag {
            coefficients,
            axis,
            relative_velocity,
            spin,
            along,
            normals,
            speeds: [
                normals[0].norm_squared().sqrt(),
                normals[1].norm_squared().sqrt(),
            ],
        }
    }

    /// Force and moment on the structure.
    ///
    /// Source: docs/theory/hydrodynamics.md, eqs. (2) to (4).
    #[inline(always)]
    pub fn load(&self) -> Wrench<Vec3<T>> {
        let [normal, axial, radius] = self.coefficients;
        let half = normal * normal.same(0.5);
        let [fore, aft] = self.normals;
        let (fore, aft) = (
            fore * (half * self.speeds[0]),
            aft * (half * self.speeds[1]),
        );
        Wrench {
            force: (fore + aft).plus(axial * self.along.abs() * self.along, self.axis),
            moment: (self.axis * radius).cross(fore - aft),
        }
    }

    /// Exact derivatives of [`Self::load`], which is handed in again.
    ///
    /// Source: docs/theory/hydrodynamics.md, eqs. (5) to (6a).
    #[inline(always)]
    pub fn derivatives(&self, load: &Wrench<Vec3<T>>) -> DragDerivatives<T> {
        let [normal, axial, radius] = self.coefficients;
        let half = normal * normal.same(0.5);
        let [fore, aft] = [self.by_normal(0, half), self.by_normal(1, half)];
        let (both, difference) = (fore + aft, fore - aft);
        let lever = self.axis * radius;
        // The points' velocities are normal to the axis, so that it is an eigenvector of both.
        let across = half * (self.speeds[0] + self.speeds[1]);
        let steep = axial * self.along.abs();
        let by_spin = difference.crossing(lever);
        let velocity = Wrench {
            force: both.plus_outer(self.axis * (steep + steep - across), self.axis),
            moment: -by_spin.transposed(),
        };
        // [e] S [e], of a symmetric S with the eigenvector e.
        let trace = both.0[0].x + both.0[1].y + both.0[2].z - across;
        let turned = both
            .plus_outer(self.axis * (trace - across), self.axis)
            .plus_diagonal(-trace);
        let spin = Wrench {
            force: by_spin,
            moment: turned * (radius * radius),
        };
        DragDerivatives {
            velocity,
            spin,
            rotation: Wrench {
                force: self.turned(velocity.force, spin.force, load.force),
                moment: self.turned(velocity.moment, spin.moment, load.moment),
            },
        }
    }

    /// Derivative of a vector of the load by a rotation: it turns along, but for the velocities,
    /// which turn back as seen from the body.
    ///
    /// Source: docs/theory/hydrodynamics.md, eq. (6a).
    #[inline(always)]
    fn turned(&self, by_velocity: Mat3<T>, by_spin: Mat3<T>, load: Vec3<T>) -> Mat3<T> {
        (by_velocity.crossing(self.relative_velocity) + by_spin.crossing(self.spin)).plus_hat(-load)
    }

    /// Derivative of the force at one of the points by its normal velocity; none at no speed.
    #[inline(always)]
    fn by_normal(&self, point: usize, coefficient: T) -> Mat3<T> {
        let (normal, speed) = (self.normals[point], self.speeds[point]);
        let zero = speed.same(0.0);
        let moving = zero.less(speed);
        let still = T::select(moving, speed, zero.same(1.0));
        let inverse = T::select(moving, coefficient / still, zero);
        (normal * inverse)
            .outer(normal)
            .plus_diagonal(coefficient * speed)
    }
}

/// Drag on points of lines, which does not know of their rotation: [`StripDrag`] without spin.
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
    /// Source: docs/theory/hydrodynamics.md, eqs. (2) and (4).
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

/// Added mass as a tensor: `normal` across the axis, `axial` along it [kg].
///
/// Source: docs/theory/hydrodynamics.md, eq. (7).
#[inline]
pub fn added_mass(axis: &Vector3, normal: f64, axial: f64) -> Matrix3 {
    Matrix3::identity() * normal + axis * axis.transpose() * (axial - normal)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use catenix_numerics::so3::{exp, hat};
    use proptest::prelude::*;

    /// Force and moment by the axis, the relative velocity and the spin.
    fn strips(axis: Vector3, water: Vector3, spin: Vector3) -> StripDrag<f64> {
        StripDrag::new(
            [3.0, 0.7, 0.9],
            (&axis).into(),
            (&water).into(),
            (&spin).into(),
        )
    }

    fn load(axis: Vector3, water: Vector3, spin: Vector3) -> [Vector3; 2] {
        let Wrench { force, moment } = strips(axis, water, spin).load();
        [force.into(), moment.into()]
    }

    fn vector() -> impl Strategy<Value = Vector3> {
        prop::array::uniform3(-1.0..1.0f64).prop_map(Vector3::from)
    }

    fn numeric(f: impl Fn(Vector3) -> [Vector3; 2]) -> [Matrix3; 2] {
        let h = 1e-6;
        let columns = [0, 1, 2].map(|k| {
            let mut d = Vector3::zeros();
            d[k] = h;
            let (more, less) = (f(d), f(-d));
            [0, 1].map(|part| (more[part] - less[part]) / (2.0 * h))
        });
        [0, 1].map(|part| Matrix3::from_columns(&columns.map(|column| column[part])))
    }

    proptest! {
        #[test]
        fn derivatives_match_finite_differences(a in vector(), u in vector(), w in vector()) {
            prop_assume!(a.norm() > 0.1);
            let e = a.normalize();
            // Both points are in motion across the axis.
            let points = strips(e, u, w).speeds;
            prop_assume!(points[0] > 0.05 && points[1] > 0.05 && u.dot(&e).abs() > 1e-3);
            let drag = strips(e, u, w);
            let d = drag.derivatives(&drag.load());
            for (found, by) in [
                (d.velocity, numeric(|du| load(e, u + du, w))),
                (d.spin, numeric(|dw| load(e, u, w + dw))),
                (d.rotation, numeric(|turn| load(exp(&turn) * e, u, w))),
            ] {
                assert_relative_eq!(Matrix3::from(found.force), by[0], epsilon = 1e-6);
                assert_relative_eq!(Matrix3::from(found.moment), by[1], epsilon = 1e-6);
            }
        }

        #[test]
        fn points_feel_what_bodies_do(a in vector(), u in vector()) {
            prop_assume!(a.norm() > 0.1 && u.norm() > 0.05);
            let e = a.normalize();
            let point = PointDrag::new([3.0, 0.7], (&e).into(), (&u).into());
            let [by_velocity, by_axis] = point.derivatives().map(Matrix3::from);
            let body = strips(e, u, Vector3::zeros());
            let d = body.derivatives(&body.load());
            let [force, moment] = load(e, u, Vector3::zeros());
            assert_relative_eq!(Vector3::from(point.force()), force, epsilon = 1e-12);
            assert_relative_eq!(by_velocity, d.velocity.force.into(), epsilon = 1e-12);
            assert_relative_eq!(by_axis * -hat(&e), d.rotation.force.into(), epsilon = 1e-12);
            assert_relative_eq!(moment, Vector3::zeros(), epsilon = 1e-12);
        }

        #[test]
        fn drag_in_still_water_takes_energy(a in vector(), v in vector(), w in vector()) {
            prop_assume!(a.norm() > 0.1);
            let [force, moment] = load(a.normalize(), -v, w);
            prop_assert!(force.dot(&v) + moment.dot(&w) <= 0.0);
        }

        /// Against equation (3), for bodies of which no part moves against the rest of the water.
        #[test]
        fn the_integral_over_the_length_is_exact_in_the_plane_of_the_flow(
            a in vector(), turn in -1.0..1.0f64, flow in 0.1..1.0f64
        ) {
            prop_assume!(a.norm() > 0.1);
            let e = a.normalize();
            let across = catenix_numerics::so3::any_normal(&e);
            let spin = e.cross(&across);
            // Half the length is sqrt(3) times the radius; the end stands still or drifts along.
            let half_length = 0.9 * 3.0f64.sqrt();
            let [force, moment] = load(e, across * flow, spin * (turn * flow / half_length));
            // The mean of (u - w x)^2, and of x times it, over the length.
            let w = turn * flow / half_length;
            let square = flow * flow + w * w * half_length * half_length / 3.0;
            let lever = -2.0 * flow * w * half_length * half_length / 3.0;
            assert_relative_eq!(force, across * (3.0 * square), epsilon = 1e-12);
            assert_relative_eq!(moment, spin * (3.0 * lever), epsilon = 1e-12);
        }
    }

    #[test]
    fn a_cylinder_across_the_flow() {
        let (z, still) = (Vector3::z(), Vector3::zeros());
        let [force, _] = load(z, Vector3::new(2.0, 0.0, 0.0), still);
        assert_relative_eq!(force, Vector3::new(12.0, 0.0, 0.0));
        let [force, _] = load(z, Vector3::new(0.0, 0.0, -2.0), still);
        assert_relative_eq!(force, Vector3::new(0.0, 0.0, -2.8));
    }

    #[test]
    fn still_water_at_rest_gives_finite_zeros() {
        let drag = strips(Vector3::z(), Vector3::zeros(), Vector3::zeros());
        let d = drag.derivatives(&drag.load());
        assert_eq!(Vector3::from(drag.load().force), Vector3::zeros());
        for by in [d.velocity, d.spin, d.rotation] {
            assert_eq!(Matrix3::from(by.force), Matrix3::zeros());
            assert_eq!(Matrix3::from(by.moment), Matrix3::zeros());
        }
    }
}
