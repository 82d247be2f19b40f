//! Prescribed motion of vessels: position, rotation, velocities and accelerations at a time.
//!
//! Source: docs/theory/motions.md, eqs. (1) to (5).

use std::f64::consts::TAU;

use catenix_model::{Motion, TowLeg, Vessel};
use catenix_numerics::time_table::{smooth_step, smooth_step_curve};
use catenix_numerics::{Matrix3, Vector3, so3, spline::Spline};

/// State of a prescribed body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RigidMotion {
    /// Position of the origin, global (3) [m].
    pub position: Vector3,
    /// Local to global axes.
    pub rotation: Matrix3,
    /// Velocity of the origin (3) [m/s].
    pub velocity: Vector3,
    /// Angular velocity, global (3) [rad/s].
    pub spin: Vector3,
    /// Acceleration of the origin, global (3) [m/s2].
    pub acceleration: Vector3,
    /// Angular acceleration, global (3) [rad/s2].
    pub angular_acceleration: Vector3,
}

impl RigidMotion {
    /// In the same place, not moving.
    pub fn stopped(self) -> RigidMotion {
        RigidMotion {
            velocity: Vector3::zeros(),
            spin: Vector3::zeros(),
            acceleration: Vector3::zeros(),
            angular_acceleration: Vector3::zeros(),
            ..self
        }
    }
}

/// A vessel ready for evaluation.
#[derive(Debug, Clone)]
pub struct PrescribedMotion {
    position: Vector3,
    heading: f64,
    parts: Vec<Part>,
}

#[derive(Debug, Clone)]
enum Part {
    Tow(Vec<TowLeg>),
    Harmonic {
        degree: usize,
        amplitude: f64,
        period: f64,
        phase: f64,
        ramp: f64,
    },
    History(Box<[Option<Spline>; 6]>),
}

impl PrescribedMotion {
    /// Prepares the motions of a vessel.
    pub fn new(vessel: &Vessel) -> PrescribedMotion {
        let parts = vessel
            .motions
            .iter()
            .map(|motion| match motion {
                Motion::Tow { legs } => Part::Tow(legs.clone()),
                Motion::Harmonic {
                    degree,
                    amplitude,
                    period,
                    phase,
                    ramp,
                } => Part::Harmonic {
                    degree: degree.index(),
                    amplitude: *amplitude,
                    period: *period,
                    phase: *phase,
                    ramp: *ramp,
                },
                Motion::History { time, values } => Part::History(Box::new(
                    values
                        .each_ref()
                        .map(|y| (!y.is_empty()).then(|| Spline::at_rest_at_ends(time, y))),
                )),
            })
            .collect();
        PrescribedMotion {
            position: Vector3::from(vessel.position),
            heading: vessel.heading,
            parts,
        }
    }

    /// Position of the origin without any motion (3) [m].
    pub fn position_at_rest(&self) -> Vector3 {
        self.position
    }

    /// The six displacements, their rates and the rates of these at a time.
    fn displacement(&self, time: f64) -> [[f64; 6]; 3] {
        let mut value = [0.0; 6];
        let mut rate = [0.0; 6];
        let mut curve = [0.0; 6];
        for part in &self.parts {
            match part {
                Part::Tow(legs) => {
                    let mut before = [0.0; 2];
                    for leg in legs {
                        let [step, slope, integral] = smooth_step((time - leg.start) / leg.ramp);
                        for k in 0..2 {
                            let change = leg.velocity[k] - before[k];
                            value[k] += change * leg.ramp * integral;
                            rate[k] += change * step;
                            if leg.ramp > 0.0 {
                                curve[k] += change * slope / leg.ramp;
                            }
                        }
                        before = leg.velocity;
                    }
                }
                Part::Harmonic {
                    degree,
                    amplitude,
                    period,
                    phase,
                    ramp,
                } => {
                    let [step, slope, bend] = if *ramp > 0.0 {
                        let [step, slope, _] = smooth_step(time / ramp);
                        [
                            step,
                            slope / ramp,
                            smooth_step_curve(time / ramp) / (ramp * ramp),
                        ]
                    } else {
                        [1.0, 0.0, 0.0]
                    };
                    let frequency = TAU / period;
                    let (sin, cos) = (frequency * time + phase).sin_cos();
                    value[*degree] += amplitude * step * sin;
                    rate[*degree] += amplitude * (slope * sin + step * frequency * cos);
                    let grown = bend - step * frequency * frequency;
                    curve[*degree] += amplitude * (grown * sin + 2.0 * slope * frequency * cos);
                }
                Part::History(splines) => {
                    for (k, spline) in splines.iter().enumerate() {
                        if let Some(spline) = spline {
                            let [v, first, second] = spline.at(time);
                            value[k] += v;
                            rate[k] += first;
                            curve[k] += second;
                        }
                    }
                }
            }
        }
        [value, rate, curve]
    }

    /// Motion at a time; before t = 0 as at t = 0.
    pub fn at(&self, time: f64) -> RigidMotion {
        let [value, rate, curve] = self.displacement(time.max(0.0));
        let [surge, sway, heave, roll, pitch, yaw] = value;
        let turn_z = so3::exp(&(Vector3::z() * (yaw + self.heading)));
        let turn_y = turn_z * so3::exp(&(Vector3::y() * pitch));
        let rotation = turn_y * so3::exp(&(Vector3::x() * roll));
        let [x, y, z] = [turn_y * Vector3::x(), turn_z * Vector3::y(), Vector3::z()];
        let [spin_y, spin_z] = [y * rate[4], z * rate[5]];
        RigidMotion {
            position: self.position + Vector3::new(surge, sway, heave),
            rotation,
            velocity: Vector3::new(rate[0], rate[1], rate[2]),
            spin: spin_z + spin_y + x * rate[3],
            acceleration: Vector3::new(curve[0], curve[1], curve[2]),
            // Each axis turns with the rotations before it.
            angular_acceleration: z * curve[5]
                + y * curve[4]
                + x * curve[3]
                + spin_z.cross(&spin_y)
                + (spin_z + spin_y).cross(&(x * rate[3])),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use catenix_model::{Appearance, Degree};

    fn vessel() -> PrescribedMotion {
        let harmonic = |degree, amplitude, period| Motion::Harmonic {
            degree,
            amplitude,
            period,
            phase: 0.3,
            ramp: 5.0,
        };
        let leg = |start, x| TowLeg {
            start,
            ramp: 2.0,
            velocity: [x, 0.1],
        };
        PrescribedMotion::new(&Vessel {
            name: "ship".into(),
            position: [1.0, 2.0, 3.0],
            heading: 0.4,
            motions: vec![
                harmonic(Degree::Heave, 4.0, 8.0),
                harmonic(Degree::Roll, 0.2, 7.0),
                harmonic(Degree::Pitch, 0.1, 9.0),
                harmonic(Degree::Yaw, 0.3, 11.0),
                Motion::Tow {
                    legs: vec![leg(0.0, 0.5), leg(20.0, -0.5)],
                },
                Motion::History {
                    time: vec![0.0, 10.0, 20.0, 40.0],
                    values: [
                        vec![],
                        vec![0.0, 1.0, -1.0, 0.0],
                        vec![],
                        vec![],
                        vec![],
                        vec![],
                    ],
                },
            ],
            appearance: Appearance::default(),
        })
    }

    #[test]
    fn velocities_are_the_derivatives() {
        let vessel = vessel();
        let h = 1e-5;
        for time in [0.7, 3.0, 12.0, 21.3, 33.0] {
            let (plus, minus, mid) = (vessel.at(time + h), vessel.at(time - h), vessel.at(time));
            let velocity = (plus.position - minus.position) / (2.0 * h);
            assert!((mid.velocity - velocity).norm() < 1e-7);
            let spin = so3::log(&(plus.rotation * minus.rotation.transpose())) / (2.0 * h);
            assert!((mid.spin - spin).norm() < 1e-7);
            let acceleration = (plus.velocity - minus.velocity) / (2.0 * h);
            assert!((mid.acceleration - acceleration).norm() < 1e-7);
            let angular = (plus.spin - minus.spin) / (2.0 * h);
            assert!((mid.angular_acceleration - angular).norm() < 1e-7);
        }
    }

    #[test]
    fn a_tow_covers_its_distance_and_reverses() {
        let leg = |start, x| TowLeg {
            start,
            ramp: 2.0,
            velocity: [x, 0.0],
        };
        let tow = PrescribedMotion::new(&Vessel {
            name: "ship".into(),
            position: [0.0; 3],
            heading: 0.0,
            motions: vec![Motion::Tow {
                legs: vec![leg(0.0, 0.5), leg(100.0, -0.5)],
            }],
            appearance: Appearance::default(),
        });
        // Half the ramp's distance is lost, by symmetry.
        assert!((tow.at(100.0).position.x - 0.5 * 99.0).abs() < 1e-12);
        assert!((tow.at(200.0).position.x - (0.5 * 99.0 - 0.5 * 98.0)).abs() < 1e-12);
        assert_eq!(tow.at(150.0).velocity.x, -0.5);
    }

    #[test]
    fn starts_from_rest() {
        let motion = vessel().at(0.0);
        assert!(motion.velocity.z.abs() < 1e-12);
    }
}
