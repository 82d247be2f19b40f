//! Elements side by side against the same elements one by one.

use catenix_model::{Current, CurrentPoint, Seabed};
use catenix_numerics::lanes::{Kernel as Work, Lane, MOST_LANES, Mat3, Row, Vec3, vectorised};
use catenix_numerics::{Block6, Matrix3, Vector3, Vector6, so3};

use super::assembly::add_internal;
use super::element::corotational::{Corotational, CorotationalState};
use super::element::ends::{Blocks, End, Prediction};
use super::element::field::{Carried, ElementBlocks, Field, FieldWeights};
use super::element::lanes::corotational::CorotationalLanes;
use super::element::lanes::field::{Fields, Room};
use super::element::lanes::{Assembled, Ends, Weights};
use super::element::section::ElementSection;
use super::element::weight::Couples;
use super::load::{SeaLoad, Spread};
use super::load_lanes::{SeaLoads, SpreadRows};
use crate::hydro::current::CurrentField;
use crate::hydro::morison::DragCoefficients;
use crate::system::frames::Sea;

/// Residual, matrix, elastic energy and power of the damping of an element.
type Result = (ElementBlocks, [f64; 2]);

/// An element, and how it lies and moves.
#[derive(Clone)]
struct Case {
    element: Corotational,
    spread: Spread,
    ends: [End; 2],
    weights: FieldWeights,
    /// How its ends have moved since the prediction began.
    moves: [(Vector3, Vector3); 2],
}

fn noise(seed: usize) -> f64 {
    let x = (seed as f64 * 12.9898).sin() * 43758.5453;
    2.0 * (x - x.floor()) - 1.0
}

fn noisy(seed: usize, size: f64) -> Vector3 {
    Vector3::from_fn(|k, _| size * noise(3 * seed + k))
}

/// Elements of all kinds that lanes know, bent a little and (`bend` 1) far.
fn cases(bend: f64) -> Vec<Case> {
    let case = |k: usize| {
        let section = ElementSection {
            length: 1.0 + 0.1 * k as f64,
            axial: 9e4,
            torsion: 70.0,
            bending: [110.0, 60.0 + 20.0 * k as f64],
            shear: k.is_multiple_of(3).then_some(700.0),
            rest: if k < 4 {
                noisy(k, 0.2)
            } else {
                Vector3::zeros()
            },
            damping: if k < 6 { 0.05 } else { 0.0 },
            laws: None,
        };
        let base = so3::exp(&noisy(40 + k, 1.5));
        let length = section.length;
        // Near the surface, near the seabed, and between.
        let height = [0.1, -0.2, -9.9, -10.1, -4.0, -6.0, -3.0, -5.0][k];
        let first = End {
            position: Vector3::new(3.0, -1.0, height),
            rotation: base,
            velocity: noisy(50 + k, 0.5),
            spin: noisy(60 + k, 0.5),
            acceleration: noisy(70 + k, 1.0),
            angular_acceleration: noisy(80 + k, 1.0),
        };
        let second = End {
            position: first.position + base * (Vector3::x() * length + noisy(90 + k, 0.2 * bend)),
            rotation: base * so3::exp(&noisy(100 + k, 1.2 * bend)),
            velocity: noisy(110 + k, 0.5),
            spin: noisy(120 + k, 0.5),
            acceleration: noisy(130 + k, 1.0),
            angular_acceleration: noisy(140 + k, 1.0),
        };
        Case {
            element: Corotational::new(section),
            spread: Spread {
                mass: 90.0,
                weight: 880.0,
                buoyancy: 700.0,
                drag: DragCoefficients {
                    normal: 180.0,
                    axial: 20.0,
                    radius: 0.0,
                },
                added_normal: 70.0,
                added_axial: 8.0,
                diameter: 0.3,
            },
            ends: [first, second],
            weights: FieldWeights {
                velocity: 4.0,
                acceleration: 30.0,
                rotation: [0, 1]
                    .map(|end: usize| so3::left_jacobian_inverse(&noisy(150 + 2 * k + end, 0.2))),
            },
            moves: [0, 1].map(|end: usize| {
                let seed = 180 + 4 * k + 2 * end;
                (noisy(seed, 0.01), noisy(seed + 1, 0.05))
            }),
        }
    };
    (0..MOST_LANES).map(case).collect()
}

fn one_by_one(case: &Case, sea: &Sea<'_>, predicts: bool) -> Result {
    let carried = case.ends.map(|end| Carried {
        end,
        lever: Vector3::zeros(),
    });
    let length = case.element.section().length;
    let uniform = case.spread.uniform();
    let mut out = ElementBlocks::zeros();
    let ends = [&carried[0], &carried[1]];
    let load = SeaLoad {
        spread: &case.spread,
        sea,
    };
    let field = Field::new([&case.ends[0], &case.ends[1]], length);
    let (mass, weights) = (case.spread.mass, Some(&case.weights));
    field.add(ends, mass, &uniform, &load, weights, &mut out);
    let state = CorotationalState::new(&case.element, &case.ends);
    let predicted: Prediction = state.predicted(&case.element, &case.moves);
    let mut tangent = state.tangent(&case.element, predicts.then_some(&predicted));
    let couples = Couples::new([&case.ends[0], &case.ends[1]], length, &uniform);
    let also: Blocks = couples.tangent();
    for (sum, other) in tangent
        .configuration
        .iter_mut()
        .flatten()
        .zip(also.iter().flatten())
    {
        *sum += other;
    }
    let forces = state.forces(&case.element).plus(&couples.forces());
    add_internal(&forces, Some((&tangent, &case.weights)), &carried, &mut out);
    (out, [state.energy(&case.element), state.damping_power()])
}

struct SideBySide<'a> {
    cases: &'a [Case],
    sea: &'a Sea<'a>,
    predicts: bool,
}

/// One row per number.
fn rows<const R: usize>(cases: &[Case], of: impl Fn(&Case) -> [f64; R]) -> [Row; R] {
    let mut rows = [[0.0; MOST_LANES]; R];
    for lane in 0..MOST_LANES {
        let values = of(&cases[lane.min(cases.len() - 1)]);
        for (row, value) in rows.iter_mut().zip(values) {
            row[lane] = value;
        }
    }
    rows
}

fn vector<T: Lane>(token: T::Token, cases: &[Case], of: impl Fn(&Case) -> Vector3) -> Vec3<T> {
    Vec3::read(token, &rows(cases, |case| of(case).into()))
}

fn matrix<T: Lane>(token: T::Token, cases: &[Case], of: impl Fn(&Case) -> Matrix3) -> Mat3<T> {
    Mat3::read(
        token,
        &rows(cases, |case| {
            std::array::from_fn::<f64, 9, _>(|k| of(case)[k])
        }),
    )
}

impl Work for SideBySide<'_> {
    type Output = Vec<Result>;

    fn run<T: Lane>(self, token: T::Token) -> Vec<Result> {
        let mut results = Vec::new();
        for cases in self.cases.chunks(T::COUNT) {
            let end = |k: usize| Ends::<T> {
                position: vector(token, cases, |case| case.ends[k].position),
                rotation: matrix(token, cases, |case| case.ends[k].rotation),
                velocity: vector(token, cases, |case| case.ends[k].velocity),
                spin: vector(token, cases, |case| case.ends[k].spin),
                acceleration: vector(token, cases, |case| case.ends[k].acceleration),
                angular_acceleration: vector(token, cases, |case| {
                    case.ends[k].angular_acceleration
                }),
            };
            let ends = [end(0), end(1)];
            let weights = Weights {
                velocity: T::splat(token, cases[0].weights.velocity),
                acceleration: T::splat(token, cases[0].weights.acceleration),
                rotation: [0, 1].map(|k| matrix(token, cases, |case| case.weights.rotation[k])),
            };
            let elements: Vec<&Corotational> = cases.iter().map(|case| &case.element).collect();
            let mut beams = CorotationalLanes::new(&elements);
            let spread: Vec<_> = cases
                .iter()
                .map(|case| (&case.spread, case.element.section().length))
                .collect();
            let spread = SpreadRows::new(&spread);
            let length = rows(cases, |case| [case.element.section().length]);
            let mut out = Assembled::zeros(token);
            let uniform = T::read(token, &spread.buoyancy) - T::read(token, &spread.weight);
            if self.predicts {
                beams.add(token, &ends, uniform, false, None, &mut out);
                let shift = |k: usize| vector(token, cases, |case| case.moves[k].0);
                let turn = |k: usize| vector(token, cases, |case| case.moves[k].1);
                beams.predict::<T>(token, [[shift(0), turn(0)], [shift(1), turn(1)]]);
            }
            let fields = Fields::new(&ends, T::read(token, &length[0]));
            let mut loads = SeaLoads::<T> {
                rows: &spread,
                sea: self.sea,
                token,
            };
            let mass = T::read(token, &spread.mass);
            let weights = Some(&weights);
            let room = &mut Room::new(token);
            fields.put(&ends, mass, uniform, &mut loads, weights, room, &mut out);
            beams.add(token, &ends, uniform, self.predicts, weights, &mut out);
            for lane in 0..cases.len() {
                let [elastic, damping] = beams.energy();
                results.push((taken(&out, lane), [elastic[lane], damping[lane]]));
            }
        }
        results
    }
}

/// What one lane holds.
fn taken<T: Lane>(out: &Assembled<T>, lane: usize) -> ElementBlocks {
    let vector = |v: Vec3<T>| {
        let mut rows = [[0.0; MOST_LANES]; 3];
        v.write(&mut rows);
        Vector3::new(rows[0][lane], rows[1][lane], rows[2][lane])
    };
    let mut blocks = ElementBlocks::zeros();
    for i in 0..2 {
        let [force, moment] = out.force[i].map(vector);
        blocks.force[i] = Vector6::from_iterator(force.iter().chain(&moment).copied());
        for j in 0..2 {
            for (k, quadrant) in out.block[i][j].iter().enumerate() {
                let quadrant = Matrix3::from_columns(&quadrant.0.map(vector));
                blocks.block[i][j].add_quadrant(k / 2, k % 2, &quadrant);
            }
        }
    }
    blocks
}

fn compare(got: &[Result], want: &[Result]) {
    assert_eq!(got.len(), want.len());
    for (k, ((got, energies), (want, want_energies))) in got.iter().zip(want).enumerate() {
        for (got, want) in energies.iter().zip(want_energies) {
            assert!((got - want).abs() < 1e-12 * (1.0 + want.abs()));
        }
        // Roundings of the largest entries, which come from extension.
        let size = |block: &Block6| block.0.iter().fold(0.0f64, |size, x| size.max(x.abs()));
        let largest = want.block.iter().flatten().map(size).fold(0.0, f64::max);
        for i in 0..2 {
            let (got_force, force) = (&got.force[i], &want.force[i]);
            assert!(
                (got_force - force).norm() < 1e-12 * largest,
                "element {k}, force {i}"
            );
            for j in 0..2 {
                for (entry, (a, b)) in got.block[i][j]
                    .0
                    .iter()
                    .zip(&want.block[i][j].0)
                    .enumerate()
                {
                    assert!(
                        (a - b).abs() < 1e-12 * largest,
                        "element {k}, block {i} {j}, entry {entry}: {a} instead of {b}"
                    );
                }
            }
        }
    }
}

#[test]
fn elements_side_by_side_are_what_they_are_one_by_one() {
    let point = |depth, x, y| CurrentPoint {
        depth,
        velocity: [x, y],
    };
    let current = CurrentField::new(&Current {
        profile: vec![
            point(0.0, 0.8, 0.0),
            point(4.5, 0.5, 0.3),
            point(12.0, 0.2, 0.4),
        ],
        factor: Vec::new(),
    });
    let seabed = Seabed {
        normal_stiffness: 2e4,
        normal_damping: 300.0,
        friction: 0.6,
        friction_speed: 0.01,
    };
    let sea = Sea {
        current: &current,
        current_factor: 1.2,
        depth: 10.0,
        seabed: Some(&seabed),
    };
    for bend in [0.02, 0.2, 1.0] {
        let cases = cases(bend);
        for predicts in [false, true] {
            let want: Vec<Result> = cases
                .iter()
                .map(|case| one_by_one(case, &sea, predicts))
                .collect();
            let work = || SideBySide {
                cases: &cases,
                sea: &sea,
                predicts,
            };
            compare(&work().run::<f64>(()), &want);
            compare(&vectorised(work()), &want);
        }
    }
}
