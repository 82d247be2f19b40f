//! Every tangent against central differences, every force against the energy.

use catenix_numerics::{Matrix3, Vector3, Vector6, so3};

use super::connector::{ConnectorState, Prediction};
use super::joint::{DotLaw, DotSpring, JointState, JointStiffness};
use super::law::{BendLaw, GeneralLaw};
use super::pair::{PairForces, PairTangent, RateWeights, Sensitivity, Side};
use super::stiffness::ConnectorStiffness;
use crate::formulation::curve::Curve;

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

/// Pairs of frames: one as systems have them, and some far out.
fn pairs() -> Vec<[Frame; 2]> {
    let mut pairs = vec![frames()];
    for (turn, gap) in [
        (Vector3::new(-1.4, 0.9, -1.1), Vector3::new(0.3, 0.2, -0.4)),
        (Vector3::new(1.9, 0.3, 0.2), Vector3::new(-0.5, 0.1, 0.2)),
        (Vector3::new(0.1, -1.2, 1.7), Vector3::new(0.1, -0.6, 0.3)),
        (
            Vector3::new(0.02, 0.01, -0.03),
            Vector3::new(0.01, 0.0, 0.0),
        ),
    ] {
        let [first, mut second] = frames();
        second.rotation = so3::exp(&turn) * first.rotation;
        second.position = first.side().point + gap - second.rotation * second.lever;
        pairs.push([first, second]);
    }
    pairs
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
        general: None,
    }
}

/// The plain connector, and one of every general kind.
fn stiffnesses() -> Vec<ConnectorStiffness> {
    let radial = Curve::through(&[[0.0, 0.0], [0.15, 20.0], [0.5, 25.0], [0.9, 90.0]], 1.0);
    let points = [
        [-0.5, -300.0],
        [0.0, 0.0],
        [0.01, 50.0],
        [0.4, 900.0],
        [0.5, 950.0],
    ];
    let general = |bending, axial| {
        let law = GeneralLaw {
            rest_bend: [0.2, -0.3],
            rest_twist: 0.4,
            bending,
            initial_bending: [60.0, 160.0],
            axial,
        };
        ConnectorStiffness {
            general: Some(Box::new(law)),
            ..stiffness()
        }
    };
    vec![
        stiffness(),
        general(BendLaw::Planes([60.0, 160.0]), None),
        general(
            BendLaw::Radial(radial.clone()),
            Some(Curve::through(&points, 1.0)),
        ),
        general(
            BendLaw::Mixed {
                radial,
                compliance: [0.004, 0.012],
            },
            None,
        ),
    ]
}

fn joints() -> Vec<JointStiffness> {
    let joint = |half| [-1.0, 1.0].map(|forward| joint(half, forward));
    stiffnesses().iter().flat_map(joint).collect()
}

fn joint(half: &ConnectorStiffness, forward: f64) -> JointStiffness {
    JointStiffness {
        half: half.clone(),
        forward,
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
    for frames in pairs() {
        check_tangent_at(&frames, &evaluate, &tangent);
    }
}

fn check_tangent_at(
    frames: &[Frame; 2],
    evaluate: impl Fn(&Side, &Side) -> PairForces,
    tangent: impl Fn(&Side, &Side, &RateWeights) -> PairTangent,
) {
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
    for stiffness in stiffnesses() {
        check_tangent(
            |a, b| ConnectorState::new(&stiffness, a, b).forces(a, b),
            |a, b, rates| {
                let state = ConnectorState::new(&stiffness, a, b);
                state.tangent(&stiffness, a, b, None, rates)
            },
        );
    }
}

#[test]
fn joint_tangent_matches_finite_differences() {
    for joint in joints() {
        check_tangent(
            |a, b| JointState::new(&joint, a, b).forces(a, b),
            |a, b, rates| {
                let state = JointState::new(&joint, a, b);
                state.tangent(&joint, a, b, None, rates)
            },
        );
    }
}

/// Elastic forces are the gradient of the energy.
/// Where levers lie along the axes, a force has no torque about them, however large the predicted
/// one is: moments in own axes show that, those in global axes do not.
#[test]
fn the_torque_about_an_axis_does_not_know_the_predicted_force() {
    let rates = RateWeights {
        velocity: 4.0,
        rotation: [Matrix3::identity(); 2],
    };
    let [mut first, mut second] = frames();
    (first.lever, second.lever) = (Vector3::x(), Vector3::x() * -0.8);
    let [first, second] = [first.side(), second.side()];
    let stiffness = stiffness();
    let state = ConnectorState::new(&stiffness, &first, &second);
    let forces = state.forces(&first, &second);
    let torques = |prediction: Option<&Prediction>| {
        let mut tangent = state.tangent(&stiffness, &first, &second, prediction, &rates);
        tangent.turn_with(
            [forces.first, forces.second].map(|force| force.fixed_rows::<3>(3).into_owned()),
        );
        let about = |side: &Side, moment: &Sensitivity| {
            let axis = side.rotation.column(0).transpose();
            [
                axis * moment.translation,
                axis * moment.first_rotation,
                axis * moment.second_rotation,
            ]
        };
        [
            about(&first, &tangent.first_moment),
            about(&second, &tangent.second_moment),
        ]
    };
    let own = torques(None);
    let predicted = torques(Some(&Prediction {
        extension: 0.7,
        across: Vector3::new(0.4, -0.9, 0.3),
    }));
    for (own, predicted) in own.iter().flatten().zip(predicted.iter().flatten()) {
        // Roundings of stiffness times lengths of the order of one.
        assert!(
            (own - predicted).norm() < 1e-12 * stiffness.axial,
            "{own} {predicted}"
        );
    }
}

fn check_gradient(
    energy: impl Fn(&Side, &Side) -> f64,
    forces: impl Fn(&Side, &Side) -> PairForces,
) {
    for pair in pairs() {
        check_gradient_at(pair, &energy, &forces);
    }
}

fn check_gradient_at(
    pair: [Frame; 2],
    energy: impl Fn(&Side, &Side) -> f64,
    forces: impl Fn(&Side, &Side) -> PairForces,
) {
    let still = pair.map(|frame| Frame {
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
    for stiffness in stiffnesses() {
        check_gradient(
            |a, b| ConnectorState::new(&stiffness, a, b).energy(&stiffness, a, b),
            |a, b| ConnectorState::new(&stiffness, a, b).forces(a, b),
        );
    }
    for joint in joints() {
        check_gradient(
            |a, b| JointState::new(&joint, a, b).energy(&joint, b),
            |a, b| JointState::new(&joint, a, b).forces(a, b),
        );
    }
}

#[test]
fn forces_turn_with_the_system_and_keep_momentum() {
    for pair in pairs() {
        check_objectivity(pair);
    }
}

fn check_objectivity([first, second]: [Frame; 2]) {
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
        let beams = stiffnesses();
        let beams = beams
            .iter()
            .map(|s| ConnectorState::new(s, &a, &b).forces(&a, &b));
        let joints = joints();
        let joints = joints
            .iter()
            .map(|joint| JointState::new(joint, &a, &b).forces(&a, &b));
        beams.chain(joints).collect::<Vec<_>>()
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
    for stiffness in stiffnesses() {
        let state = ConnectorState::new(&stiffness, &first.side(), &second.side());
        assert!(state.damping.force.norm() < 1e-12 && state.damping.moment.norm() < 1e-12);
    }
    let [first, second] = frames();
    let (a, b) = (first.side(), second.side());
    for stiffness in stiffnesses() {
        assert!(ConnectorState::new(&stiffness, &a, &b).damping_power() < 0.0);
    }
    for joint in joints() {
        assert!(JointState::new(&joint, &a, &b).damping_power() < 0.0);
    }
}

#[test]
fn a_connector_at_rest_carries_no_moment() {
    for stiffness in stiffnesses() {
        let [first, mut second] = frames();
        second.rotation = first.rotation * stiffness.rest_rotation();
        let state = ConnectorState::new(&stiffness, &first.side(), &second.side());
        assert!(state.elastic.moment.norm() < 1e-13 * stiffness.bending);
    }
}

#[test]
fn the_general_law_of_a_round_straight_section_is_the_plain_one() {
    let plain = stiffness();
    let general = ConnectorStiffness {
        general: Some(Box::new(GeneralLaw {
            rest_bend: [0.0; 2],
            rest_twist: 0.0,
            bending: BendLaw::Planes([plain.bending; 2]),
            initial_bending: [plain.bending; 2],
            axial: Some(Curve::line(plain.axial)),
        })),
        ..plain.clone()
    };
    for [first, second] in pairs() {
        let (a, b) = (first.side(), second.side());
        let [x, y] = [&plain, &general].map(|s| ConnectorState::new(s, &a, &b));
        assert!((x.elastic.moment - y.elastic.moment).norm() < 1e-12 * x.elastic.moment.norm());
        assert!((x.elastic.force - y.elastic.force).norm() < 1e-12 * x.elastic.force.norm());
        let energies = [x.energy(&plain, &a, &b), y.energy(&general, &a, &b)];
        assert!((energies[0] - energies[1]).abs() < 1e-12 * energies[0]);
    }
}
