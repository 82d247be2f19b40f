//! The ends of lines: on their supports, or tied to them, with what holds the line's direction.
//!
//! Source: docs/theory/lumped.md, eqs. (23) and (24), and "Ends".

use catenix_numerics::{Matrix3, TangentWeights, Vector3, so3::hat};

use super::super::Situation;
use super::element::guide::Guide;
use crate::body::motion::RigidMotion;
use crate::system::Carrier;

/// How an end is held.
#[derive(Debug, Clone)]
pub(super) struct Held {
    /// Vessel or body.
    pub carrier: Carrier,
    /// Connection point, own axes of the support (3) [m].
    pub arm: Vector3,
    /// Vector in the support's axes, unit, and how it holds the line's direction.
    pub guide: Option<(Vector3, Guide)>,
    /// The spring that ties the end, where it is a point of the state.
    pub tie: Option<Tie>,
}

/// A stiff spring between the end of a line and its support.
#[derive(Debug, Clone)]
pub(super) struct Tie {
    /// Stiffness [N/m].
    pub stiffness: f64,
    /// Direction in which the end moves freely, support's axes, unit (3).
    pub slides_along: Option<Vector3>,
}

/// A point of a support in motion.
#[derive(Debug, Clone, Copy)]
pub(super) struct Seat {
    pub motion: RigidMotion,
    /// From the support's origin, global (3) [m].
    pub arm: Vector3,
}

impl Held {
    /// Where the connection point is.
    pub fn seat(&self, at: &Situation<'_>) -> Seat {
        let motion = at.carrier(self.carrier);
        Seat {
            arm: motion.rotation * self.arm,
            motion,
        }
    }

    /// The vector of the guide, global.
    pub fn direction(&self, seat: &Seat) -> Vector3 {
        let own = self.guide.as_ref().map_or_else(Vector3::x, |guide| guide.0);
        seat.motion.rotation * own
    }
}

impl Seat {
    pub fn position(&self) -> Vector3 {
        self.motion.position + self.arm
    }

    pub fn velocity(&self) -> Vector3 {
        self.motion.velocity + self.motion.spin.cross(&self.arm)
    }

    pub fn acceleration(&self) -> Vector3 {
        let RigidMotion {
            acceleration,
            angular_acceleration,
            spin,
            ..
        } = &self.motion;
        acceleration + angular_acceleration.cross(&self.arm) + spin.cross(&spin.cross(&self.arm))
    }

    /// Derivatives of position, velocity and acceleration of the point by the rotation of its body.
    ///
    /// Source: docs/theory/lumped.md, eq. (24).
    pub fn by_rotation(&self, weights: &TangentWeights<'_>, body: usize) -> [Matrix3; 3] {
        let (arm, spin) = (hat(&self.arm), hat(&self.motion.spin));
        let turn = weights.turn(body);
        let rate = arm * turn * weights.velocity;
        let swept = hat(&self.motion.spin.cross(&self.arm)) * turn * weights.velocity;
        [
            -arm,
            -rate - spin * arm,
            -(arm * turn * weights.acceleration)
                - hat(&self.motion.angular_acceleration) * arm
                - swept
                - spin * rate
                - spin * spin * arm,
        ]
    }
}

/// The force of a tie.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct TieState {
    /// Derivative of the energy by the end's position (3) [N].
    pub force: Vector3,
    /// From the support's origin to where the end is held (3) [m].
    pub arm: Vector3,
    /// Stored energy [J].
    pub energy: f64,
    axis: Vector3,
    slid: f64,
    seat: Vector3,
    stiffness: f64,
}

/// Derivatives of a tie: of the force by the end's position and the support's rotation, and of the
/// moment on the support by both.
pub(super) struct TieTangent {
    pub force: Matrix3,
    pub force_rotation: Matrix3,
    pub moment: Matrix3,
    pub moment_rotation: Matrix3,
}

impl Tie {
    /// For the end at `position`.
    pub fn at(&self, seat: &Seat, position: &Vector3) -> TieState {
        let gap = position - seat.position();
        let axis = self
            .slides_along
            .map_or_else(Vector3::zeros, |axis| seat.motion.rotation * axis);
        let slid = axis.dot(&gap);
        let force = (gap - axis * slid) * self.stiffness;
        TieState {
            force,
            arm: seat.arm + axis * slid,
            energy: 0.5 * force.norm_squared() / self.stiffness,
            axis,
            slid,
            seat: seat.arm,
            stiffness: self.stiffness,
        }
    }
}

impl TieState {
    /// Derivative of the energy by a rotation of the support (3) [N m].
    pub fn moment(&self) -> Vector3 {
        -self.arm.cross(&self.force)
    }

    /// Exact derivatives; those by the support's position are minus those by the end's.
    pub fn tangent(&self) -> TieTangent {
        let s = &self.axis;
        let project = Matrix3::identity() - s * s.transpose();
        // A turn moves the seat and the axis; the slide follows.
        let gap = self.force / self.stiffness + s * self.slid;
        let slid_by = (gap.transpose() * -hat(s)) + s.transpose() * hat(&self.seat);
        let axis_by = -hat(s);
        let force_rotation = (hat(&self.seat) - axis_by * self.slid - s * slid_by) * self.stiffness;
        let arm_by = -hat(&self.seat) + axis_by * self.slid + s * slid_by;
        let force = project * self.stiffness;
        let (arm, pull) = (hat(&self.arm), hat(&self.force));
        TieTangent {
            force,
            force_rotation,
            moment: pull * s * s.transpose() - arm * force,
            moment_rotation: pull * arm_by - arm * force_rotation,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use catenix_numerics::so3;

    #[test]
    fn the_tie_is_the_gradient_of_its_energy_and_its_tangent_is_exact() {
        let held = Vector3::new(0.4, -0.3, 0.8);
        let end = Vector3::new(1.9, 2.4, 3.7);
        let rotation = so3::exp(&Vector3::new(0.3, 0.8, -0.4));
        for slides_along in [None, Some(Vector3::new(0.6, 0.0, 0.8))] {
            let tie = Tie {
                stiffness: 3.0,
                slides_along,
            };
            let at = |u: &Vector3, turn: &Vector3| {
                let rotation = so3::exp(turn) * rotation;
                let seat = Seat {
                    motion: RigidMotion {
                        position: Vector3::new(1.0, 2.0, 3.0),
                        rotation,
                        velocity: Vector3::zeros(),
                        spin: Vector3::zeros(),
                        acceleration: Vector3::zeros(),
                        angular_acceleration: Vector3::zeros(),
                    },
                    arm: rotation * held,
                };
                tie.at(&seat, &(end + u))
            };
            let zero = Vector3::zeros();
            let state = at(&zero, &zero);
            let exact = state.tangent();
            let h = 1e-6;
            for k in 0..3 {
                let mut d = Vector3::zeros();
                d[k] = h;
                let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-7, "{a} and {b}");
                close(
                    state.force[k],
                    (at(&d, &zero).energy - at(&-d, &zero).energy) / (2.0 * h),
                );
                close(
                    state.moment()[k],
                    (at(&zero, &d).energy - at(&zero, &-d).energy) / (2.0 * h),
                );
                let by = |f: &dyn Fn(&TieState) -> Vector3, turned: bool| {
                    let state = |sign: f64| match turned {
                        true => at(&zero, &(d * sign)),
                        false => at(&(d * sign), &zero),
                    };
                    (f(&state(1.0)) - f(&state(-1.0))) / (2.0 * h)
                };
                let force = |state: &TieState| state.force;
                let moment = |state: &TieState| state.moment();
                for (matrix, numeric) in [
                    (exact.force, by(&force, false)),
                    (exact.force_rotation, by(&force, true)),
                    (exact.moment, by(&moment, false)),
                    (exact.moment_rotation, by(&moment, true)),
                ] {
                    assert!((matrix.column(k) - numeric).norm() < 1e-7);
                }
            }
        }
    }
}
