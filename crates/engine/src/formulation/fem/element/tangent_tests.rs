//! Every tangent against central differences, every force against the energy.

use catenix_numerics::{Matrix3, Vector3, Vector6, so3};

use super::corotational::{Corotational, CorotationalState};
use super::ends::{ElementForces, ElementTangent, End};
use super::exact::{Exact, ExactState};
use super::joint::{Direction, Hold, JointSprings, JointState, Support};
use super::section::{ElementSection, SectionLaws};
use super::weight::Couples;
use crate::formulation::curve::Curve;

/// An end of a small element, moved by an increment; velocities follow with a factor.
fn moved(end: &End, d: &Vector6, velocity: f64) -> End {
    let theta = d.fixed_rows::<3>(3).into_owned();
    End {
        position: end.position + d.fixed_rows::<3>(0),
        rotation: so3::exp(&theta) * end.rotation,
        velocity: end.velocity + d.fixed_rows::<3>(0) * velocity,
        spin: end.spin + theta * velocity,
        ..*end
    }
}

/// Pairs of ends: one as systems have them, and some far out.
fn pairs() -> Vec<[End; 2]> {
    let base = so3::exp(&Vector3::new(0.7, -1.9, 0.4));
    let cases = [
        (Vector3::new(0.3, -0.2, 0.4), Vector3::new(1.1, 0.3, -0.2)),
        (Vector3::new(-1.1, 0.7, -0.8), Vector3::new(0.9, -0.4, 0.5)),
        (Vector3::new(0.2, 1.2, 1.0), Vector3::new(1.2, 0.1, -0.6)),
        (
            Vector3::new(0.02, 0.01, -0.03),
            Vector3::new(1.01, 0.01, 0.02),
        ),
        // Just where series and closed forms meet, on both sides.
        (
            Vector3::new(0.0, 0.1, 0.17),
            Vector3::new(0.97, 0.02, -0.01),
        ),
        (Vector3::new(0.1, 0.1, 0.14), Vector3::new(0.98, 0.04, 0.03)),
    ];
    cases
        .into_iter()
        .map(|(turn, span)| {
            let first = End {
                position: Vector3::new(3.0, -1.0, 2.0),
                rotation: base,
                velocity: Vector3::new(0.3, -0.6, 0.2),
                spin: Vector3::new(0.4, 0.8, -0.3),
                acceleration: Vector3::zeros(),
                angular_acceleration: Vector3::zeros(),
            };
            let second = End {
                position: first.position + base * span,
                rotation: base * so3::exp(&turn),
                velocity: Vector3::new(-0.4, 0.2, 1.0),
                spin: Vector3::new(-0.5, 0.1, 0.9),
                ..first
            };
            [first, second]
        })
        .collect()
}

/// A round straight section, and one of every other kind.
fn sections() -> Vec<ElementSection> {
    let plain = ElementSection {
        length: 1.05,
        axial: 900.0,
        torsion: 70.0,
        bending: [110.0; 2],
        shear: None,
        rest: Vector3::zeros(),
        damping: 0.05,
        laws: None,
    };
    let radial = Curve::through(&[[0.0, 0.0], [0.15, 20.0], [0.5, 25.0], [0.9, 90.0]], 1.0);
    let points = [
        [-0.5, -300.0],
        [0.0, 0.0],
        [0.01, 9.0],
        [0.4, 250.0],
        [0.5, 260.0],
    ];
    vec![
        plain.clone(),
        ElementSection {
            bending: [60.0, 160.0],
            rest: Vector3::new(0.4, 0.2, -0.3),
            shear: Some(700.0),
            ..plain.clone()
        },
        ElementSection {
            rest: Vector3::new(0.1, -0.1, 0.2),
            laws: Some(Box::new(SectionLaws {
                axial: Some(Curve::through(&points, 1.0)),
                bending: Some(radial),
            })),
            ..plain
        },
    ]
}

type Evaluate = Box<dyn Fn(&[End; 2]) -> (ElementForces, ElementTangent, f64, f64)>;

/// Forces, tangent, energy and power of damping of every element with every section.
fn elements() -> Vec<(String, Evaluate)> {
    let mut elements: Vec<(String, Evaluate)> = Vec::new();
    for (k, section) in sections().into_iter().enumerate() {
        let element = Corotational::new(section.clone());
        elements.push((
            format!("corotational, section {k}"),
            Box::new(move |ends| {
                let state = CorotationalState::new(&element, ends);
                (
                    state.forces(&element),
                    state.tangent(&element, None),
                    state.energy(&element),
                    state.damping_power(),
                )
            }),
        ));
        let element = Exact::new(section);
        elements.push((
            format!("exact, section {k}"),
            Box::new(move |ends| {
                let state = ExactState::new(&element, ends);
                (
                    state.forces(&element),
                    state.tangent(&element, None),
                    state.energy(&element),
                    state.damping_power(),
                )
            }),
        ));
    }
    let load = Vector3::new(40.0, -70.0, 110.0);
    elements.push((
        "uniform load".into(),
        Box::new(move |ends| {
            let couples = Couples::new([&ends[0], &ends[1]], 1.05, &load);
            let tangent = ElementTangent {
                configuration: couples.tangent(),
                rates: None,
            };
            (couples.forces(), tangent, couples.potential(), -1.0)
        }),
    ));
    elements
}

fn stacked(forces: &ElementForces) -> [f64; 12] {
    let parts = [
        -forces.force,
        forces.moment[0],
        forces.force,
        forces.moment[1],
    ];
    std::array::from_fn(|k| parts[k / 3][k % 3])
}

/// A column of the whole tangent, with velocities that follow.
fn column(tangent: &ElementTangent, index: usize, velocity: f64) -> [f64; 12] {
    let (sign, from) = match index / 3 {
        0 => (-1.0, 0),
        1 => (1.0, 1),
        2 => (1.0, 0),
        _ => (1.0, 2),
    };
    let part = |row: usize| -> Vector3 {
        let mut block = tangent.configuration[row][from];
        if let Some(rates) = &tangent.rates {
            block += rates[row][from] * velocity;
        }
        block.column(index % 3) * sign
    };
    stacked(&ElementForces {
        force: part(0),
        moment: [part(1), part(2)],
    })
}

fn step(index: usize, size: f64) -> [Vector6; 2] {
    let mut d = [Vector6::zeros(); 2];
    d[index / 6][index % 6] = size;
    d
}

#[test]
fn tangents_match_finite_differences() {
    let (h, velocity) = (1e-6, 3.0);
    for (name, evaluate) in elements() {
        for (case, ends) in pairs().iter().enumerate() {
            let exact = evaluate(ends).1;
            for index in 0..12 {
                let at = |sign: f64| {
                    let d = step(index, h * sign);
                    let ends = [0, 1].map(|k: usize| moved(&ends[k], &d[k], velocity));
                    stacked(&evaluate(&ends).0)
                };
                let (plus, minus) = (at(1.0), at(-1.0));
                let got = column(&exact, index, velocity);
                for row in 0..12 {
                    let want = (plus[row] - minus[row]) / (2.0 * h);
                    // Rounding of forces of 1e3 over the step of 1e-6 is 1e-7 of stiffnesses of 1e3;
                    // truncation is 1e-12 of their third derivatives.
                    assert!(
                        (got[row] - want).abs() < 1e-6 * (100.0 + want.abs()),
                        "{name}, pair {case}, row {row}, column {index}: {} for {want}",
                        got[row]
                    );
                }
            }
        }
    }
}

#[test]
fn elastic_forces_are_the_gradient_of_the_energy() {
    let h = 1e-6;
    for (name, evaluate) in elements() {
        for ends in pairs() {
            let still = ends.map(|end| End {
                velocity: Vector3::zeros(),
                spin: Vector3::zeros(),
                ..end
            });
            let got = stacked(&evaluate(&still).0);
            for (index, got) in got.iter().enumerate() {
                let at = |sign: f64| {
                    let d = step(index, h * sign);
                    evaluate(&[0, 1].map(|k: usize| moved(&still[k], &d[k], 0.0))).2
                };
                let want = (at(1.0) - at(-1.0)) / (2.0 * h);
                // Rounding of an energy of 100 J over the step is 1e-8 N.
                assert!(
                    (got - want).abs() < 1e-6 * (1.0 + want.abs()),
                    "{name}, {index}: {got}, not {want}"
                );
            }
        }
    }
}

#[test]
fn forces_turn_with_the_system_and_keep_momentum() {
    let turn = so3::exp(&Vector3::new(2.0, -1.0, 0.7));
    // A dead load does not turn.
    for (name, evaluate) in elements()
        .into_iter()
        .filter(|(name, _)| name != "uniform load")
    {
        for ends in pairs() {
            let turned = ends.map(|end| End {
                position: turn * end.position,
                rotation: turn * end.rotation,
                velocity: turn * end.velocity,
                spin: turn * end.spin,
                ..end
            });
            let (before, after) = (evaluate(&ends).0, evaluate(&turned).0);
            let pairs = [
                (before.force, after.force),
                (before.moment[0], after.moment[0]),
                (before.moment[1], after.moment[1]),
            ];
            for (old, new) in pairs {
                // Rounding only.
                assert!(
                    (turn * old - new).norm() < 1e-11 * (1.0 + old.norm()),
                    "{name}"
                );
            }
            let arm = ends[1].position - ends[0].position;
            let total = before.moment[0] + before.moment[1] + arm.cross(&before.force);
            assert!(
                total.norm() < 1e-11 * before.force.norm(),
                "{name}: moment {total}"
            );
        }
    }
}

#[test]
fn rigid_motion_meets_no_damping_and_damping_takes_energy() {
    let spin = Vector3::new(0.3, -0.7, 1.1);
    for (name, evaluate) in elements()
        .into_iter()
        .filter(|(name, _)| name != "uniform load")
    {
        for ends in pairs() {
            assert!(evaluate(&ends).3 < 0.0, "{name}");
            let with = |spin: Vector3| {
                ends.map(|end| End {
                    velocity: spin.cross(&end.position),
                    spin,
                    ..end
                })
            };
            let (rigid, still) = (evaluate(&with(spin)), evaluate(&with(Vector3::zeros())));
            for (a, b) in stacked(&rigid.0).iter().zip(stacked(&still.0)) {
                assert!(
                    (a - b).abs() < 1e-11 * (1.0 + b.abs()),
                    "{name}: {a} for {b}"
                );
            }
            // The power of the forces is what the damping takes.
            let (moving, still) = (evaluate(&ends), evaluate(&with(Vector3::zeros())));
            let damping = stacked(&moving.0).map(|f| f);
            let elastic = stacked(&still.0);
            let power: f64 = (0..12)
                .map(|k| {
                    let end = &ends[k / 6];
                    let rate = if k % 6 < 3 { end.velocity } else { end.spin };
                    -(damping[k] - elastic[k]) * rate[k % 3]
                })
                .sum();
            assert!((power - moving.3).abs() < 1e-11 * power.abs(), "{name}");
        }
    }
}

#[test]
fn an_element_in_its_stress_free_shape_carries_nothing() {
    for section in sections() {
        let rest = section.rest;
        let first = pairs()[0][0];
        let still = End {
            velocity: Vector3::zeros(),
            spin: Vector3::zeros(),
            ..first
        };
        let span = so3::left_jacobian(&rest) * Vector3::x() * section.length;
        let arc = |span: Vector3| {
            [
                still,
                End {
                    position: still.position + still.rotation * span,
                    rotation: still.rotation * so3::exp(&rest),
                    ..still
                },
            ]
        };
        let element = Corotational::new(section.clone());
        let forces = CorotationalState::new(&element, &arc(span)).forces(&element);
        assert!(
            stacked(&forces).iter().all(|f| f.abs() < 1e-9),
            "{forces:?}"
        );
        let element = Exact::new(section.clone());
        let forces = ExactState::new(&element, &arc(span)).forces(&element);
        assert!(
            stacked(&forces).iter().all(|f| f.abs() < 1e-9),
            "{forces:?}"
        );
    }
}

fn joints() -> Vec<JointSprings> {
    let directions = vec![
        Direction {
            on_support: Vector3::y(),
            on_node: Vector3::z(),
            hold: Hold::Perpendicular(300.0),
        },
        Direction {
            on_support: Vector3::x(),
            on_node: Vector3::x(),
            hold: Hold::Parallel(200.0),
        },
    ];
    let along = Vector3::new(0.6, 0.0, 0.8);
    [None, Some(along)]
        .map(|slide| JointSprings {
            stiffness: 900.0,
            slide,
            directions: directions.clone(),
        })
        .to_vec()
}

/// The support's side of an end with a lever.
fn support(end: &End) -> Support {
    let lever = end.rotation * Vector3::new(0.4, -0.1, 0.2);
    Support {
        point: end.position + lever,
        lever,
        rotation: end.rotation * so3::exp(&Vector3::new(0.3, 0.2, -0.5)),
    }
}

#[test]
fn joint_tangent_and_energy_match_finite_differences() {
    let h = 1e-6;
    for joint in joints() {
        for ends in pairs() {
            let evaluate = |ends: &[End; 2]| {
                let side = support(&ends[0]);
                let state = JointState::new(&joint, &side, &ends[1].position, &ends[1].rotation);
                (state, side)
            };
            let (state, side) = evaluate(&ends);
            let exact = state.tangent(&joint, &side, &ends[1].rotation, None);
            let forces = state.forces(&side);
            for index in 0..12 {
                let at = |sign: f64| {
                    let d = step(index, h * sign);
                    let (state, side) =
                        evaluate(&[0, 1].map(|k: usize| moved(&ends[k], &d[k], 0.0)));
                    (state.forces(&side), state.energy())
                };
                let (plus, minus) = (at(1.0), at(-1.0));
                let slope = (plus.1 - minus.1) / (2.0 * h);
                let got = forces[index / 6][index % 6];
                assert!((got - slope).abs() < 1e-6 * (1.0 + slope.abs()), "{index}");
                for row in 0..12 {
                    let (r, c) = (row / 6, index / 6);
                    let want = (plus.0[r][row % 6] - minus.0[r][row % 6]) / (2.0 * h);
                    let got = exact[r][c].at(row % 6, index % 6);
                    assert!(
                        (got - want).abs() < 1e-6 * (100.0 + want.abs()),
                        "row {row}, column {index}: {got} for {want}"
                    );
                }
            }
            let moves = [
                (Vector3::new(0.3, -0.2, 0.1), Vector3::new(0.1, 0.4, -0.2)),
                (Vector3::new(-0.1, 0.2, 0.3), Vector3::new(0.2, -0.3, 0.1)),
            ];
            let linear = state.predicted(&joint, &side, &moves) - state.force;
            let at = |sign: f64| {
                let d = moves.map(|(u, t)| Vector6::new(u.x, u.y, u.z, t.x, t.y, t.z) * (h * sign));
                evaluate(&[0, 1].map(|k: usize| moved(&ends[k], &d[k], 0.0)))
                    .0
                    .force
            };
            let want = (at(1.0) - at(-1.0)) / (2.0 * h);
            assert!((linear - want).norm() < 1e-6 * (1.0 + want.norm()));
        }
    }
}

#[test]
fn predictions_are_linear_in_the_move() {
    let h = 1e-6;
    let moves = [
        (Vector3::new(0.3, -0.2, 0.1), Vector3::new(0.1, 0.4, -0.2)),
        (Vector3::new(-0.1, 0.2, 0.3), Vector3::new(0.2, -0.3, 0.1)),
    ];
    for section in sections() {
        for ends in pairs() {
            let after = |sign: f64| {
                [0, 1].map(|k: usize| {
                    let (u, t) = moves[k];
                    let d = Vector6::new(u.x, u.y, u.z, t.x, t.y, t.z) * (h * sign);
                    moved(&ends[k], &d, 0.0)
                })
            };
            let element = Exact::new(section.clone());
            let strain = |sign: f64| ExactState::new(&element, &after(sign)).strain();
            let want = (strain(1.0) - strain(-1.0)) / (2.0 * h);
            let state = ExactState::new(&element, &ends);
            let got = state.predicted(&element, &moves).strain - state.strain();
            assert!((got - want).norm() < 1e-7, "{got} for {want}");
            let element = Corotational::new(section.clone());
            let tension = |sign: f64| CorotationalState::new(&element, &after(sign)).tension;
            let want = (tension(1.0) - tension(-1.0)) / (2.0 * h);
            let state = CorotationalState::new(&element, &ends);
            let strain = state.predicted(&element, &moves).strain.x;
            let there = CorotationalState::new(&element, &after(0.0));
            let slope = element.section().tension(there.strain()).1;
            let got = (strain - there.strain()) * slope;
            assert!(
                (got - want).abs() < 1e-4 * (1.0 + want.abs()),
                "{got} for {want}"
            );
        }
    }
}

#[test]
fn a_prediction_of_the_true_stress_changes_nothing() {
    let rest = [(Vector3::zeros(), Vector3::zeros()); 2];
    let same = |a: &ElementTangent, b: &ElementTangent| {
        let flat = |t: &ElementTangent| -> Vec<f64> {
            let blocks = t.configuration.iter().flatten();
            blocks
                .flat_map(|m: &Matrix3| m.iter().copied().collect::<Vec<_>>())
                .collect()
        };
        flat(a)
            .iter()
            .zip(flat(b))
            .all(|(a, b)| (a - b).abs() < 1e-9 * (1.0 + b.abs()))
    };
    for section in sections() {
        for ends in pairs() {
            let element = Exact::new(section.clone());
            let state = ExactState::new(&element, &ends);
            let predicted = state.predicted(&element, &rest);
            assert!(same(
                &state.tangent(&element, Some(&predicted)),
                &state.tangent(&element, None)
            ));
            let element = Corotational::new(section.clone());
            let state = CorotationalState::new(&element, &ends);
            let predicted = state.predicted(&element, &rest);
            assert!(same(
                &state.tangent(&element, Some(&predicted)),
                &state.tangent(&element, None)
            ));
        }
    }
}
