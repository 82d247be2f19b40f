//! Every tangent against central differences, every force against the energy.

use catenix_numerics::{Matrix3, Vector3, Vector6, so3};

use super::connector::ConnectorState;
use super::joint::{DotLaw, DotSpring, JointState, JointStiffness};
use super::pair::{PairForces, PairTangent, RateWeights, Sensitivity, Side};
use super::stiffness::ConnectorStiffness;

/// A frame with a connection point, as the system holds it.
#[derive(Clone, Copy)]
struct Frame {
    position: Vector3,
    rotation: Matrix3,
    lever: Vector3,
    velocity: Vector3,
    spin: Vector3,
}

impl Frame {
    fn side(&self) -> Side {
        let lever = self.rotation * self.lever;
        Side {
            point: self.position + lever,
            lever,
            rotation: self.rotation,
            velocity: self.velocity + self.spin.cross(&lever),
            spin: self.spin,
        }
    }

    fn moved(&self, d: &Vector6, velocity: f64, turn: &Matrix3) -> Frame {
        let theta = d.fixed_rows::<3>(3).into_owned();
        Frame {
            position: self.position + d.fixed_rows::<3>(0),
            rotation: so3::exp(&theta) * self.rotation,
            velocity: self.velocity + d.fixed_rows::<3>(0) * velocity,
            spin: self.spin + turn * theta * velocity,
            ..*self
        }
    }
}

fn frames() -> [Frame; 2] {
    let first = Frame {
        position: Vector3::new(0.3, -0.2, 1.0),
        rotation: so3::exp(&Vector3::new(0.4, 1.1, -0.3)),
        lever: Vector3::new(1.0, 0.1, -0.05),
        velocity: Vector3::new(0.5, -1.0, 2.0),
        spin: Vector3::new(0.3, 0.8, -0.6),
    };
    let rotation = so3::exp(&Vector3::new(0.2, -0.5, 0.35)) * first.rotation;
    let lever = Vector3::new(-0.8, 0.0, 0.02);
    let gap = Vector3::new(0.03, -0.02, 0.04);
    let second = Frame {
        position: first.side().point + gap - rotation * lever,
        rotation,
        lever,
        velocity: Vector3::new(-0.4, 0.2, 1.0),
        spin: Vector3::new(-0.5, 0.1, 0.9),
    };
    [first, second]
}

fn stiffness() -> ConnectorStiffness {
    ConnectorStiffness {
        axial: 5000.0,
        shear: 900.0,
        torsion: 70.0,
        bending: 110.0,
        shift: 0.0,
        damping: 0.05,
    }
}

fn joint() -> JointStiffness {
    JointStiffness {
        half: stiffness(),
        springs: vec![
            DotSpring {
                support_axis: Vector3::y(),
                element_axis: Vector3::z(),
                law: DotLaw::Perpendicular(300.0),
            },
            DotSpring {
                support_axis: Vector3::x(),
                element_axis: Vector3::x(),
                law: DotLaw::Parallel(200.0),
            },
        ],
    }
}

fn stacked(forces: &PairForces) -> [f64; 12] {
    let mut all = [0.0; 12];
    for k in 0..6 {
        all[k] = forces.first[k];
        all[k + 6] = forces.second[k];
    }
    all
}

fn column(tangent: &PairTangent, index: usize) -> [f64; 12] {
    let pick = |d: &Sensitivity| -> Vector3 {
        match index / 3 {
            0 => -d.translation.column(index % 3),
            1 => d.first_rotation.column(index % 3).into(),
            2 => d.translation.column(index % 3).into(),
            _ => d.second_rotation.column(index % 3).into(),
        }
    };
    let force = pick(&tangent.force);
    stacked(&PairForces::new(
        &force,
        &pick(&tangent.first_moment),
        &pick(&tangent.second_moment),
    ))
}

fn check_tangent(
    evaluate: impl Fn(&Side, &Side) -> PairForces,
    tangent: impl Fn(&Side, &Side, &RateWeights) -> PairTangent,
) {
    let frames = frames();
    let rates = RateWeights {
        velocity: 3.0,
        rotation: [
            so3::left_jacobian_inverse(&Vector3::new(0.1, -0.2, 0.15)),
            so3::left_jacobian_inverse(&Vector3::new(-0.2, 0.1, 0.05)),
        ],
    };
    let exact = tangent(&frames[0].side(), &frames[1].side(), &rates);
    let h = 1e-6;
    for index in 0..12 {
        let at = |sign: f64| {
            let mut d = [Vector6::zeros(), Vector6::zeros()];
            d[index / 6][index % 6] = h * sign;
            let sides: Vec<Side> = (0..2)
                .map(|k| {
                    frames[k]
                        .moved(&d[k], rates.velocity, &rates.rotation[k])
                        .side()
                })
                .collect();
            stacked(&evaluate(&sides[0], &sides[1]))
        };
        let (plus, minus) = (at(1.0), at(-1.0));
        let got = column(&exact, index);
        for row in 0..12 {
            let want = (plus[row] - minus[row]) / (2.0 * h);
            assert!(
                (got[row] - want).abs() < 1e-5 * (1.0 + want.abs()),
                "row {row}, column {index}: {} instead of {want}",
                got[row]
            );
        }
    }
}

#[test]
fn connector_tangent_matches_finite_differences() {
    let stiffness = stiffness();
    check_tangent(
        |a, b| ConnectorState::new(&stiffness, a, b).forces(a, b),
        |a, b, rates| {
            let state = ConnectorState::new(&stiffness, a, b);
            state.tangent(&stiffness, a, b, None, rates)
        },
    );
}

#[test]
fn joint_tangent_matches_finite_differences() {
    let joint = joint();
    check_tangent(
        |a, b| JointState::new(&joint, a, b).forces(a, b),
        |a, b, rates| {
            let state = JointState::new(&joint, a, b);
            state.tangent(&joint, a, b, None, rates)
        },
    );
}

/// Elastic forces are the gradient of the energy.
fn check_gradient(
    energy: impl Fn(&Side, &Side) -> f64,
    forces: impl Fn(&Side, &Side) -> PairForces,
) {
    let still = frames().map(|frame| Frame {
        velocity: Vector3::zeros(),
        spin: Vector3::zeros(),
        ..frame
    });
    let got = stacked(&forces(&still[0].side(), &still[1].side()));
    let h = 1e-6;
    for (index, got) in got.iter().enumerate() {
        let at = |sign: f64| {
            let mut d = [Vector6::zeros(), Vector6::zeros()];
            d[index / 6][index % 6] = h * sign;
            let sides = [0, 1].map(|k| still[k].moved(&d[k], 0.0, &Matrix3::identity()).side());
            energy(&sides[0], &sides[1])
        };
        let want = (at(1.0) - at(-1.0)) / (2.0 * h);
        assert!(
            (got - want).abs() < 1e-6 * (1.0 + want.abs()),
            "{index}: {got}, not {want}"
        );
    }
}

#[test]
fn elastic_forces_are_the_gradient_of_the_energy() {
    let stiffness = stiffness();
    check_gradient(
        |a, b| ConnectorState::new(&stiffness, a, b).energy(&stiffness),
        |a, b| ConnectorState::new(&stiffness, a, b).forces(a, b),
    );
    let joint = joint();
    check_gradient(
        |a, b| JointState::new(&joint, a, b).energy(),
        |a, b| JointState::new(&joint, a, b).forces(a, b),
    );
}

#[test]
fn forces_turn_with_the_system_and_keep_momentum() {
    let [first, second] = frames();
    let turn = so3::exp(&Vector3::new(2.0, -1.0, 0.7));
    let turned = |frame: &Frame| Frame {
        position: turn * frame.position,
        rotation: turn * frame.rotation,
        velocity: turn * frame.velocity,
        spin: turn * frame.spin,
        ..*frame
    };
    let evaluate = |a: &Frame, b: &Frame| {
        let (a, b) = (a.side(), b.side());
        let beam = ConnectorState::new(&stiffness(), &a, &b).forces(&a, &b);
        let joint = JointState::new(&joint(), &a, &b).forces(&a, &b);
        [beam, joint]
    };
    let before = evaluate(&first, &second);
    let after = evaluate(&turned(&first), &turned(&second));
    for (before, after) in before.iter().zip(&after) {
        for (old, new) in [(before.first, after.first), (before.second, after.second)] {
            for rows in [0, 3] {
                let want = turn * old.fixed_rows::<3>(rows);
                assert!((new.fixed_rows::<3>(rows) - want).norm() < 1e-10 * want.norm());
            }
        }
        let force = before.first.fixed_rows::<3>(0) + before.second.fixed_rows::<3>(0);
        let moment = |forces: &Vector6, frame: &Frame| -> Vector3 {
            forces.fixed_rows::<3>(3)
                + frame
                    .position
                    .cross(&forces.fixed_rows::<3>(0).into_owned())
        };
        let total = moment(&before.first, &first) + moment(&before.second, &second);
        assert!(
            force.norm() < 1e-12 && total.norm() < 1e-10,
            "force {force}, moment {total}"
        );
    }
}

#[test]
fn rigid_motion_meets_no_damping_and_damping_takes_energy() {
    let [mut first, mut second] = frames();
    let spin = Vector3::new(0.3, -0.7, 1.1);
    for frame in [&mut first, &mut second] {
        frame.spin = spin;
        frame.velocity = spin.cross(&frame.position);
    }
    let state = ConnectorState::new(&stiffness(), &first.side(), &second.side());
    assert!(state.damping.force.norm() < 1e-12 && state.damping.moment.norm() < 1e-12);
    let [first, second] = frames();
    let (a, b) = (first.side(), second.side());
    assert!(ConnectorState::new(&stiffness(), &a, &b).damping_power() < 0.0);
    assert!(JointState::new(&joint(), &a, &b).damping_power() < 0.0);
}
