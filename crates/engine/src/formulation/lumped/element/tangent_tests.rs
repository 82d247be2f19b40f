//! Laws and derivatives of the springs between points.

use approx::assert_relative_eq;
use catenix_numerics::{Matrix3, Vector3, so3};
use proptest::prelude::*;

use super::Segment;
use super::bend::{BendState, BendStiffness};
use super::guide::{Guide, GuideState};
use super::piecewise;
use super::spring::{Spring, SpringState};

/// Step of central differences: the error of the differences is its square, round-off over it is
/// 1e-10 of numbers of the order of 1.
const STEP: f64 = 1e-6;
/// Error of central differences of these functions, with third derivatives of up to 1e3.
const CLOSE: f64 = 1e-6;

fn vector() -> impl Strategy<Value = Vector3> {
    prop::array::uniform3(-1.0..1.0f64).prop_map(Vector3::from)
}

fn numeric(f: impl Fn(&Vector3) -> Vector3) -> Matrix3 {
    let columns = [0, 1, 2].map(|k| {
        let mut d = Vector3::zeros();
        d[k] = STEP;
        (f(&d) - f(&-d)) / (2.0 * STEP)
    });
    Matrix3::from_columns(&columns)
}

fn gradient(f: impl Fn(&Vector3) -> f64) -> Vector3 {
    Vector3::from_fn(|k, _| {
        let mut d = Vector3::zeros();
        d[k] = STEP;
        (f(&d) - f(&-d)) / (2.0 * STEP)
    })
}

fn springs() -> [Spring; 2] {
    let linear = Spring {
        rest: 0.8,
        stiffness: 5.0,
        law: None,
        damping: 0.3,
    };
    let law = Spring {
        law: Some(vec![[-1.0, -0.5], [0.0, 0.0], [0.3, 2.0], [0.9, 7.0]]),
        ..linear.clone()
    };
    [linear, law]
}

fn bends() -> [BendStiffness; 2] {
    [
        BendStiffness::Linear(3.0),
        BendStiffness::Law {
            points: vec![[0.0, 0.0], [0.5, 4.0], [1.1, 5.0], [4.0, 6.0]],
            length: 0.7,
        },
    ]
}

/// Whether an angle is away from the kinks of the law and from a segment folded back, where
/// differences tell nothing.
fn smooth(angle: f64) -> bool {
    angle < 2.8
        && [0.5, 1.1, 4.0]
            .iter()
            .all(|kink| (angle - kink * 0.7).abs() > 1e-4)
}

#[test]
fn a_piecewise_curve_has_its_slope_and_its_integral() {
    let points = [[-1.0, -0.5], [0.0, 0.0], [0.3, 2.0], [0.9, 7.0]];
    for x in [-1.7, -0.4, 0.0, 0.1, 0.5, 1.4] {
        let (_, slope, integral) = piecewise(&points, x);
        let at = |x: f64| piecewise(&points, x).0;
        assert_relative_eq!(slope, (at(x - 1e-7) - at(x - 2e-7)) / 1e-7, epsilon = 1e-6);
        // The trapezoidal rule with kinks between its points.
        let n = 20_000;
        let sum: f64 = (0..n)
            .map(|k| at(x * (f64::from(k) + 0.5) / f64::from(n)) * x / f64::from(n))
            .sum();
        assert_relative_eq!(integral, sum, epsilon = 1e-7);
    }
}

#[test]
fn a_long_stiff_spring_keeps_its_digits() {
    // 10 m at 3000 m depth, stretched by 1 nanometre: what is left is the rounding of the points.
    let spring = Spring {
        rest: 10.0,
        stiffness: 1.0,
        law: None,
        damping: 0.0,
    };
    let between = Vector3::new(0.0, 0.0, -(10.0 + 1e-9));
    let state = SpringState::new(&spring, &between, &Vector3::zeros());
    assert!((state.extension - 1e-9).abs() < 4.0 * f64::EPSILON * 10.0);
}

/// A small angle, at which the series is used, and one at which it is not.
#[test]
fn the_angle_is_smooth_through_zero() {
    let stiffness = BendStiffness::Linear(1.0);
    let before = Segment::new(&Vector3::x());
    for angle in [0.0, 1e-9, 1e-4, 0.0632, 0.0633, 0.5, 2.0, 3.0] {
        let after = Segment::new(&Vector3::new(f64::cos(angle), f64::sin(angle), 0.0));
        let state = BendState::new(&stiffness, &before, &after);
        assert!((state.angle() - angle).abs() < 1e-15 + 1e-13 * angle);
        assert!((state.energy() - 0.5 * angle * angle).abs() < 1e-13);
        // The gradient turns the segment by its moment over its length.
        assert!((state.forces(&before, &after)[1].norm() - angle).abs() < 1e-13 * (1.0 + angle));
    }
}

proptest! {
    #[test]
    fn the_spring_tangent_matches_finite_differences(
        d in vector(), v in vector(), weight in 0.0..5.0f64,
    ) {
        prop_assume!(d.norm() > 0.3);
        for spring in springs() {
            let strain = (d.norm() - spring.rest) / spring.rest;
            prop_assume!([0.0, 0.3].iter().all(|kink: &f64| (strain - kink).abs() > 1e-4));
            let state = SpringState::new(&spring, &d, &v);
            // The rate follows the increment by the weight, as an integrator makes it.
            let by = numeric(|u| SpringState::new(&spring, &(d + u), &(v + u * weight)).force());
            let exact = state.tangent(&spring, &v, None, weight);
            assert_relative_eq!(exact, by, epsilon = CLOSE, max_relative = CLOSE);
            // With its own extension as the prediction it is the same.
            let mixed = state.tangent(&spring, &v, Some(state.extension), weight);
            assert_relative_eq!(exact, mixed, epsilon = 1e-12);
            let energy = |u: &Vector3| {
                spring.tension(SpringState::new(&spring, &(d + u), &v).extension).2
            };
            let elastic = state.segment.direction * state.tension;
            assert_relative_eq!(elastic, gradient(energy), epsilon = CLOSE);
        }
    }

    #[test]
    fn the_bend_tangent_matches_finite_differences(d in vector(), e in vector()) {
        prop_assume!(d.norm() > 0.3 && e.norm() > 0.3);
        for stiffness in bends() {
            let at = |u: &Vector3, w: &Vector3| {
                let (before, after) = (Segment::new(&(d + u)), Segment::new(&(e + w)));
                let state = BendState::new(&stiffness, &before, &after);
                (state.energy(), state.forces(&before, &after))
            };
            let zero = Vector3::zeros();
            let (before, after) = (Segment::new(&d), Segment::new(&e));
            let state = BendState::new(&stiffness, &before, &after);
            prop_assume!(smooth(state.angle()));
            let [first, second] = state.forces(&before, &after);
            assert_relative_eq!(first, gradient(|u| at(u, &zero).0), epsilon = CLOSE);
            assert_relative_eq!(second, gradient(|u| at(&zero, u).0), epsilon = CLOSE);
            let [own, mixed, other] = state.tangent(&before, &after);
            let pairs = [
                (own, numeric(|u| at(u, &zero).1[0])),
                (mixed, numeric(|u| at(&zero, u).1[0])),
                (mixed.transpose(), numeric(|u| at(u, &zero).1[1])),
                (other, numeric(|u| at(&zero, u).1[1])),
            ];
            for (exact, by) in pairs {
                // Close to a fold the derivatives grow, and their differences lose digits.
                assert_relative_eq!(exact, by, epsilon = 1e-5, max_relative = 1e-5);
            }
            // No force and no moment on the three points together.
            let moment = d.cross(&first) + e.cross(&second);
            assert!(moment.norm() < 1e-12 * (1.0 + first.norm() + second.norm()));
        }
    }

    #[test]
    fn the_guide_tangent_matches_finite_differences(h in vector(), d in vector()) {
        prop_assume!(d.norm() > 0.3 && h.norm() > 0.3);
        let h = h.normalize();
        let guides = bends().map(Guide::Along).into_iter().chain([Guide::Across(2.0)]);
        for guide in guides {
            let at = |turn: &Vector3, u: &Vector3| {
                let segment = Segment::new(&(d + u));
                let state = GuideState::new(&guide, &(so3::exp(turn) * h), &segment);
                (state.energy(), state.force(&segment), state.moment())
            };
            let zero = Vector3::zeros();
            let segment = Segment::new(&d);
            prop_assume!(smooth(h.dot(&segment.direction).acos()));
            let state = GuideState::new(&guide, &h, &segment);
            assert_relative_eq!(
                state.force(&segment), gradient(|u| at(&zero, u).0), epsilon = CLOSE
            );
            assert_relative_eq!(state.moment(), gradient(|u| at(u, &zero).0), epsilon = CLOSE);
            let exact = state.tangent(&segment);
            let pairs = [
                (exact.force, numeric(|u| at(&zero, u).1)),
                (exact.force_rotation, numeric(|u| at(u, &zero).1)),
                (exact.moment, numeric(|u| at(&zero, u).2)),
                (exact.moment_rotation, numeric(|u| at(u, &zero).2)),
            ];
            for (exact, by) in pairs {
                assert_relative_eq!(exact, by, epsilon = 1e-5, max_relative = 1e-5);
            }
            // Support and segment together feel no moment.
            let total = d.cross(&state.force(&segment)) + state.moment();
            assert!(total.norm() < 1e-12 * (1.0 + state.moment().norm()));
        }
    }

    #[test]
    fn forces_turn_with_the_points(d in vector(), e in vector(), turn in vector()) {
        prop_assume!(d.norm() > 0.3 && e.norm() > 0.3);
        let r = so3::exp(&(turn * 3.0));
        for stiffness in bends() {
            let forces = |r: &Matrix3| {
                let (before, after) = (Segment::new(&(r * d)), Segment::new(&(r * e)));
                BendState::new(&stiffness, &before, &after).forces(&before, &after)
            };
            prop_assume!(d.angle(&e) < 2.8);
            let (still, turned) = (forces(&Matrix3::identity()), forces(&r));
            for (a, b) in still.iter().zip(&turned) {
                assert_relative_eq!(r * a, *b, epsilon = 1e-10);
            }
        }
        for spring in springs() {
            let force = |r: &Matrix3| SpringState::new(&spring, &(r * d), &(r * e)).force();
            assert_relative_eq!(r * force(&Matrix3::identity()), force(&r), epsilon = 1e-12);
        }
    }

    #[test]
    fn a_rigid_motion_meets_no_damping_and_damping_takes_energy(
        d in vector(), v in vector(), spin in vector(),
    ) {
        prop_assume!(d.norm() > 0.3);
        let [spring, _] = springs();
        prop_assert!(SpringState::new(&spring, &d, &spin.cross(&d)).damping.abs() < 1e-14);
        prop_assert!(SpringState::new(&spring, &d, &v).damping_power(&v) <= 0.0);
    }
}
