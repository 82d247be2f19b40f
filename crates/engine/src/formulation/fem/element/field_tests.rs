//! Inertia and spread loads against central differences and laws of mechanics.

use catenix_numerics::{Matrix3, Vector3, Vector6, so3};

use super::ends::End;
use super::field::{
    Carried, ElementBlocks, Field, FieldWeights, LoadTangent, POINT_COUNT, SpreadLoad, Station,
};

const LENGTH: f64 = 1.3;
const MASS: f64 = 2.5;

/// Nothing but inertia.
struct NoLoad;

impl SpreadLoad for NoLoad {
    fn force(&self, _: &Station) -> Vector3 {
        Vector3::zeros()
    }

    fn linearised(&self, _: &Station) -> (Vector3, LoadTangent) {
        let zero = Matrix3::zeros();
        let tangent = LoadTangent {
            position: zero,
            axis: zero,
            velocity: zero,
            acceleration: zero,
        };
        (Vector3::zeros(), tangent)
    }
}

/// A load that depends on everything that it may.
struct AnyLoad;

const P: Vector3 = Vector3::new(0.3, -0.8, 0.5);
const Q: Vector3 = Vector3::new(1.1, 0.4, -0.6);

impl SpreadLoad for AnyLoad {
    fn force(&self, s: &Station) -> Vector3 {
        s.axis * (s.velocity.dot(&s.axis) * s.position.dot(&P))
            + s.velocity * s.velocity.norm_squared()
            - s.acceleration * 0.7
            - s.axis * (0.4 * s.axis.dot(&s.acceleration))
            + Q
    }

    fn linearised(&self, s: &Station) -> (Vector3, LoadTangent) {
        let (a, along, depth) = (&s.axis, s.velocity.dot(&s.axis), s.position.dot(&P));
        let identity = Matrix3::identity();
        let tangent = LoadTangent {
            position: a * P.transpose() * along,
            axis: (identity * along + a * s.velocity.transpose()) * depth
                - (identity * a.dot(&s.acceleration) + a * s.acceleration.transpose()) * 0.4,
            velocity: a * a.transpose() * depth
                + identity * s.velocity.norm_squared()
                + s.velocity * s.velocity.transpose() * 2.0,
            acceleration: identity * -0.7 - a * a.transpose() * 0.4,
        };
        (self.force(s), tangent)
    }
}

/// A frame that carries an end at a distance.
#[derive(Clone, Copy)]
struct Carrier {
    frame: End,
    arm: Vector3,
}

impl Carrier {
    fn carried(&self) -> Carried {
        let f = &self.frame;
        let lever = f.rotation * self.arm;
        let end = End {
            position: f.position + lever,
            velocity: f.velocity + f.spin.cross(&lever),
            acceleration: f.acceleration
                + f.angular_acceleration.cross(&lever)
                + f.spin.cross(&f.spin.cross(&lever)),
            ..*f
        };
        Carried { end, lever }
    }

    fn moved(&self, d: &Vector6, weights: &FieldWeights, k: usize) -> Carrier {
        let (u, theta) = (
            d.fixed_rows::<3>(0).into_owned(),
            d.fixed_rows::<3>(3).into_owned(),
        );
        let turned = weights.rotation[k] * theta;
        let f = &self.frame;
        Carrier {
            frame: End {
                position: f.position + u,
                rotation: so3::exp(&theta) * f.rotation,
                velocity: f.velocity + u * weights.velocity,
                spin: f.spin + turned * weights.velocity,
                acceleration: f.acceleration + u * weights.acceleration,
                angular_acceleration: f.angular_acceleration + turned * weights.acceleration,
            },
            ..*self
        }
    }
}

fn carriers(arms: [Vector3; 2]) -> [Carrier; 2] {
    let base = so3::exp(&Vector3::new(0.7, -1.9, 0.4));
    let first = End {
        position: Vector3::new(0.3, -0.5, 0.8),
        rotation: base,
        velocity: Vector3::new(0.3, -0.6, 0.2),
        spin: Vector3::new(0.4, 0.8, -0.3),
        acceleration: Vector3::new(-0.5, 0.1, 0.6),
        angular_acceleration: Vector3::new(0.9, -0.7, 0.3),
    };
    let second = End {
        position: first.position + base * Vector3::new(1.1, 0.3, -0.2),
        rotation: base * so3::exp(&Vector3::new(0.3, -0.6, 0.9)),
        velocity: Vector3::new(-0.4, 0.2, 1.0),
        spin: Vector3::new(-0.5, 0.1, 0.9),
        acceleration: Vector3::new(0.8, 0.4, -0.2),
        angular_acceleration: Vector3::new(-0.3, 0.5, 0.2),
    };
    [(first, arms[0]), (second, arms[1])].map(|(frame, arm)| Carrier { frame, arm })
}

fn no_arms() -> [Vector3; 2] {
    [Vector3::zeros(); 2]
}

fn arms() -> [Vector3; 2] {
    [Vector3::new(0.4, 0.1, -0.3), Vector3::new(-0.2, 0.5, 0.1)]
}

fn evaluate(
    carriers: &[Carrier; 2],
    load: &impl SpreadLoad,
    weights: Option<&FieldWeights>,
) -> ElementBlocks {
    let carried = carriers.map(|carrier| carrier.carried());
    let field = Field::new([&carried[0].end, &carried[1].end], LENGTH);
    let mut blocks = ElementBlocks::zeros();
    field.add(
        [&carried[0], &carried[1]],
        MASS,
        &Vector3::zeros(),
        load,
        weights,
        &mut blocks,
    );
    blocks
}

#[test]
fn tangent_matches_finite_differences() {
    let weights = FieldWeights {
        velocity: 3.0,
        acceleration: 11.0,
        rotation: [
            so3::left_jacobian_inverse(&Vector3::new(0.1, -0.2, 0.15)),
            so3::left_jacobian_inverse(&Vector3::new(-0.2, 0.1, 0.05)),
        ],
    };
    let h = 1e-5;
    for arms in [no_arms(), arms()] {
        let base = carriers(arms);
        let exact = evaluate(&base, &AnyLoad, Some(&weights));
        assert_eq!(exact.force, evaluate(&base, &AnyLoad, None).force);
        for index in 0..12 {
            let at = |sign: f64| {
                let mut d = [Vector6::zeros(); 2];
                d[index / 6][index % 6] = h * sign;
                let moved = [0, 1].map(|k: usize| base[k].moved(&d[k], &weights, k));
                evaluate(&moved, &AnyLoad, None).force
            };
            let (plus, minus) = (at(1.0), at(-1.0));
            for row in 0..12 {
                let (r, c) = (row / 6, index / 6);
                let want = (plus[r][row % 6] - minus[r][row % 6]) / (2.0 * h);
                let got = exact.block[r][c].at(row % 6, index % 6);
                // Rounding of forces of 10 over the step: 1e-10; truncation: 1e-10 of third
                // derivatives that the weights make as large as 1e3.
                assert!(
                    (got - want).abs() < 1e-6 * (1.0 + want.abs()),
                    "row {row}, column {index}: {got} for {want}"
                );
            }
        }
    }
}

#[test]
fn the_power_of_inertia_is_the_rate_of_the_kinetic_energy() {
    for arms in [no_arms(), arms()] {
        let base = carriers(arms);
        let forces = evaluate(&base, &NoLoad, None).force;
        let power: f64 = (0..2)
            .map(|k| {
                let f = &base[k].frame;
                forces[k].fixed_rows::<3>(0).dot(&f.velocity)
                    + forces[k].fixed_rows::<3>(3).dot(&f.spin)
            })
            .sum();
        let h = 1e-5;
        let at = |t: f64| {
            let moved = base.map(|carrier| {
                let f = &carrier.frame;
                Carrier {
                    frame: End {
                        position: f.position + f.velocity * t,
                        rotation: so3::exp(&(f.spin * t)) * f.rotation,
                        velocity: f.velocity + f.acceleration * t,
                        spin: f.spin + f.angular_acceleration * t,
                        ..*f
                    },
                    ..carrier
                }
            });
            let carried = moved.map(|carrier| carrier.carried());
            let field = Field::new([&carried[0].end, &carried[1].end], LENGTH);
            (field.kinetic_energy(MASS), field.momentum(MASS))
        };
        let (plus, minus) = (at(h), at(-h));
        let rate = (plus.0 - minus.0) / (2.0 * h);
        // Truncation of the central difference: 1e-10 of third derivatives of order ten.
        assert!(
            (power - rate).abs() < 1e-8 * (1.0 + rate.abs()),
            "{power} for {rate}"
        );

        // Forces and moments about the origin are the rates of the momenta.
        let force = forces[0].fixed_rows::<3>(0) + forces[1].fixed_rows::<3>(0);
        let moment: Vector3 = (0..2)
            .map(|k| {
                forces[k].fixed_rows::<3>(3)
                    + base[k]
                        .frame
                        .position
                        .cross(&forces[k].fixed_rows::<3>(0).into_owned())
            })
            .sum();
        let rates = [0, 1].map(|k: usize| (plus.1[k] - minus.1[k]) / (2.0 * h));
        assert!((force - rates[0]).norm() < 1e-8, "{force} for {}", rates[0]);
        assert!(
            (moment - rates[1]).norm() < 1e-8,
            "{moment} for {}",
            rates[1]
        );
    }
}

#[test]
fn the_mass_matrix_is_the_derivative_by_accelerations_and_gives_the_kinetic_energy() {
    struct Added;
    let tensor = |s: &Station| Matrix3::identity() * 0.7 + s.axis * s.axis.transpose() * 0.4;
    impl SpreadLoad for Added {
        fn force(&self, s: &Station) -> Vector3 {
            -s.acceleration * 0.7 - s.axis * (0.4 * s.axis.dot(&s.acceleration))
        }

        fn linearised(&self, s: &Station) -> (Vector3, LoadTangent) {
            (self.force(s), AnyLoad.linearised(s).1)
        }
    }
    for arms in [no_arms(), arms()] {
        let still = carriers(arms).map(|carrier| Carrier {
            frame: End {
                velocity: Vector3::zeros(),
                spin: Vector3::zeros(),
                acceleration: Vector3::zeros(),
                angular_acceleration: Vector3::zeros(),
                ..carrier.frame
            },
            ..carrier
        });
        let carried = still.map(|carrier| carrier.carried());
        let field = Field::new([&carried[0].end, &carried[1].end], LENGTH);
        let mut mass = ElementBlocks::zeros().block;
        field.add_mass([&carried[0], &carried[1]], MASS, tensor, &mut mass);
        // At rest, forces are linear in the accelerations.
        for index in 0..12 {
            let mut d = [Vector6::zeros(); 2];
            d[index / 6][index % 6] = 1.0;
            let moved = [0, 1].map(|k: usize| Carrier {
                frame: End {
                    acceleration: d[k].fixed_rows::<3>(0).into_owned(),
                    angular_acceleration: d[k].fixed_rows::<3>(3).into_owned(),
                    ..still[k].frame
                },
                ..still[k]
            });
            let forces = evaluate(&moved, &Added, None).force;
            for row in 0..12 {
                let got = mass[row / 6][index / 6].at(row % 6, index % 6);
                let want = forces[row / 6][row % 6];
                assert!(
                    (got - want).abs() < 1e-13 * (1.0 + want.abs()),
                    "{got} for {want}"
                );
            }
        }
        let dry = {
            let mut dry = ElementBlocks::zeros().block;
            field.add_mass(
                [&carried[0], &carried[1]],
                MASS,
                |_| Matrix3::zeros(),
                &mut dry,
            );
            dry
        };
        let moving = carriers(arms);
        let v = moving.map(|carrier| {
            let (v, w) = (&carrier.frame.velocity, &carrier.frame.spin);
            Vector6::new(v.x, v.y, v.z, w.x, w.y, w.z)
        });
        let mut twice = 0.0;
        for i in 0..2 {
            for j in 0..2 {
                let mut y = Vector6::zeros();
                dry[i][j].add_times(&v[j], &mut y);
                twice += v[i].dot(&y);
            }
        }
        let carried = moving.map(|carrier| carrier.carried());
        let energy = Field::new([&carried[0].end, &carried[1].end], LENGTH).kinetic_energy(MASS);
        assert!((0.5 * twice - energy).abs() < 1e-13 * energy);
    }
}

#[test]
fn a_straight_line_in_rigid_motion_has_its_textbook_inertia() {
    let spin = Vector3::new(0.2, 0.9, -0.4);
    let rotation = so3::exp(&Vector3::new(0.3, 0.2, 0.5));
    let along: Vector3 = rotation.column(0).into();
    let at = |x: f64| End {
        position: along * x,
        rotation,
        velocity: spin.cross(&(along * x)),
        spin,
        acceleration: Vector3::zeros(),
        angular_acceleration: Vector3::zeros(),
    };
    let field = Field::new([&at(-0.5 * LENGTH), &at(0.5 * LENGTH)], LENGTH);
    let inertia = MASS * LENGTH.powi(3) / 12.0;
    let across = spin - along * along.dot(&spin);
    let energy = 0.5 * inertia * across.norm_squared();
    assert!((field.kinetic_energy(MASS) - energy).abs() < 1e-14);
    let [linear, angular] = field.momentum(MASS);
    assert!(linear.norm() < 1e-14 && (angular - across * inertia).norm() < 1e-14);
    for point in 0..POINT_COUNT {
        assert!((field.station(point).axis - along).norm() < 1e-14);
    }
    let total: f64 = (0..POINT_COUNT).map(|k| field.station(k).length).sum();
    assert!((total - LENGTH).abs() < 1e-14);
}
