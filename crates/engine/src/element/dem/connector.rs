//! The flexible connector between two rigid elements, or between an element and a clamp.
//!
//! Deformation is measured in the frame half-way between the two sides: the gap between the two
//! connection points (extension and two shears) and the rotation vector from one side to the other
//! (torsion and two bendings). Forces are the exact gradient of the stored energy, so that
//! momentum and energy are kept for any rotation; the tangent is exact.
//!
//! Source: docs/theory/dem.md, eqs. (1) to (12). Deviation from Li et al. 2011: rotations are
//! finite (rotation vector), where the paper's six springs are written for small ones.

use catenix_numerics::{Matrix3, Vector3, so3};

use super::pair::{PairForces, PairTangent, RateWeights, Sensitivity, Side};
use super::stiffness::ConnectorStiffness;
use so3::hat;

/// Force and moment in a connector, global components.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Stress {
    /// Force of the second side on the first [N].
    pub force: Vector3,
    /// Moment, work-conjugate to the rotation vector [N m].
    pub moment: Vector3,
}

/// A connector at one configuration: geometry, elastic stress and damping stress.
#[derive(Debug, Clone, Copy)]
pub struct ConnectorState {
    /// From the first connection point to the second (3) [m].
    pub gap: Vector3,
    /// Rotation vector from the first side's axes to the second's, global (3) [rad].
    pub bend: Vector3,
    /// Axes half-way between the sides; first column along the line.
    pub middle: Matrix3,
    /// Elastic stress.
    pub elastic: Stress,
    /// Damping stress.
    pub damping: Stress,
    /// Rate of the gap in the middle frame, global components (3) [m/s].
    gap_rate: Vector3,
    /// Difference of the angular velocities (3) [rad/s].
    bend_rate: Vector3,
}

/// Coefficients of the half-angle maps as functions of the squared angle, with derivatives.
struct HalfAngle {
    /// h / sin h with h half the angle.
    alpha: f64,
    /// (1 - alpha) / angle^2.
    beta: f64,
    /// tan(h/2) / h.
    k: f64,
    alpha_s: f64,
    beta_s: f64,
    k_s: f64,
}

impl HalfAngle {
    fn new(s: f64) -> HalfAngle {
        if s < 0.02 {
            return HalfAngle {
                alpha: 1.0 + s * (1.0 / 24.0 + s * (7.0 / 5760.0 + s * (31.0 / 967680.0))),
                beta: -1.0 / 24.0
                    - s * (7.0 / 5760.0 + s * (31.0 / 967680.0 + s * (127.0 / 154828800.0))),
                k: 0.5 + s * (1.0 / 96.0 + s * (1.0 / 3840.0 + s * (17.0 / 2580480.0))),
                alpha_s: 1.0 / 24.0 + s * (7.0 / 2880.0 + s * (31.0 / 322560.0)),
                beta_s: -7.0 / 5760.0 - s * (31.0 / 483840.0 + s * (127.0 / 51609600.0)),
                k_s: 1.0 / 96.0 + s * (1.0 / 1920.0 + s * (17.0 / 860160.0)),
            };
        }
        let h = 0.5 * s.sqrt();
        let (sin, cos) = h.sin_cos();
        let alpha = h / sin;
        let per_s = 1.0 / (8.0 * h);
        let alpha_s = (sin - h * cos) / (sin * sin) * per_s;
        let tan = (0.5 * h).tan();
        HalfAngle {
            alpha,
            beta: (1.0 - alpha) / s,
            k: tan / h,
            alpha_s,
            beta_s: (-alpha_s - (1.0 - alpha) / s) / s,
            k_s: (0.5 * (1.0 + tan * tan) / h - tan / (h * h)) * per_s,
        }
    }
}

impl ConnectorState {
    /// Measures the deformation between two sides and the stress that follows.
    ///
    /// Source: docs/theory/dem.md, eqs. (1) to (4) and (9).
    #[inline]
    pub fn new(stiffness: &ConnectorStiffness, first: &Side, second: &Side) -> ConnectorState {
        let bend = so3::log(&(second.rotation * first.rotation.transpose()));
        let middle = so3::exp(&(bend * 0.5)) * first.rotation;
        let axis: Vector3 = middle.column(0).into();
        let gap = second.point - first.point;
        let mean_spin = (first.spin + second.spin) * 0.5;
        let gap_rate = second.velocity - first.velocity - mean_spin.cross(&gap);
        let bend_rate = second.spin - first.spin;
        ConnectorState {
            gap,
            bend,
            middle,
            elastic: stiffness.stress(&axis, &gap, &bend),
            damping: stiffness.stress(
                &axis,
                &(gap_rate * stiffness.damping),
                &(bend_rate * stiffness.damping),
            ),
            gap_rate,
            bend_rate,
        }
    }

    /// Generalised forces on the two frames.
    ///
    /// Source: docs/theory/dem.md, eqs. (5) to (7) and (10).
    #[inline]
    pub fn forces(&self, first: &Side, second: &Side) -> PairForces {
        let half = HalfAngle::new(self.bend.norm_squared());
        let couple = self.gap.cross(&self.elastic.force);
        let skew = couple.cross(&self.bend) * (0.25 * half.k);
        let moment = self.conjugate_moment(&half, &self.elastic.moment);
        let force = self.elastic.force + self.damping.force;
        let shared = (couple + self.gap.cross(&self.damping.force)) * -0.5;
        let opposed = skew + moment + self.damping.moment;
        PairForces::new(
            &force,
            &(shared - first.lever.cross(&force) - opposed),
            &(shared + second.lever.cross(&force) + opposed),
        )
    }

    /// S^-1 times the moment: what is conjugate to the difference of rotation increments.
    fn conjugate_moment(&self, half: &HalfAngle, moment: &Vector3) -> Vector3 {
        moment * half.alpha + self.bend * (half.beta * self.bend.dot(moment))
    }

    /// Exact derivative of [`Self::forces`]. `stress` takes the place of the elastic stress in the
    /// geometric part: the elastic stress itself for the exact tangent, or the stress predicted by
    /// the last linear solution (the mixed form).
    ///
    /// Source: docs/theory/dem.md, eqs. (8), (11) and (12).
    pub fn tangent(
        &self,
        stiffness: &ConnectorStiffness,
        first: &Side,
        second: &Side,
        stress: &Stress,
        rates: &RateWeights,
    ) -> PairTangent {
        let half = HalfAngle::new(self.bend.norm_squared());
        let axis: Vector3 = self.middle.column(0).into();
        let k = stiffness.matrices(&axis);
        let gap_hat = hat(&self.gap);
        let bend_hat = hat(&self.bend);
        let map = Matrix3::identity() * half.alpha + self.bend * self.bend.transpose() * half.beta;
        let quarter = 0.25 * half.k;
        let middle_by = Sensitivity {
            translation: Matrix3::zeros(),
            first_rotation: Matrix3::identity() * 0.5 + bend_hat * quarter,
            second_rotation: Matrix3::identity() * 0.5 - bend_hat * quarter,
        };

        // Derivatives by gap (slot "translation") and by rotations at fixed gap.
        let by_middle = k.force_gap * gap_hat - hat(&stress.force);
        let force = Sensitivity {
            translation: k.force_gap,
            first_rotation: by_middle * middle_by.first_rotation,
            second_rotation: by_middle * middle_by.second_rotation,
        };
        let conjugate = self.conjugate_moment(&half, &stress.moment);
        let moment_by_middle = -hat(&conjugate);
        let bend_dot_moment = self.bend.dot(&stress.moment);
        let bend_outer = self.bend * self.bend.transpose();
        let stretch = stress.moment * self.bend.transpose() * (2.0 * half.alpha_s)
            + bend_outer * (2.0 * half.beta_s * bend_dot_moment)
            + (Matrix3::identity() * bend_dot_moment + self.bend * stress.moment.transpose())
                * half.beta;
        let moment_bend = (map * k.moment_bend + stretch) * map;
        let moment = Sensitivity {
            translation: Matrix3::zeros(),
            first_rotation: moment_by_middle * middle_by.first_rotation - moment_bend,
            second_rotation: moment_by_middle * middle_by.second_rotation + moment_bend,
        };
        let mut couple = force.led_by(&gap_hat);
        couple.translation -= hat(&stress.force);
        let couple_vector = self.gap.cross(&stress.force);
        let couple_hat = hat(&couple_vector);
        let mut skew = couple.led_by(&(bend_hat * -quarter));
        let by_angle = couple_vector.cross(&self.bend) * self.bend.transpose() * (0.5 * half.k_s);
        let bend_by_difference = couple_hat * map * quarter + by_angle;
        let bend_by_middle = couple_hat * bend_hat * -quarter;
        skew.first_rotation += bend_by_middle * middle_by.first_rotation - bend_by_difference;
        skew.second_rotation += bend_by_middle * middle_by.second_rotation + bend_by_difference;

        let lever = [hat(&first.lever), hat(&second.lever)];
        let shared = couple.scaled(-0.5);
        let opposed = skew.plus(&moment);
        let mut first_moment = shared
            .plus(&force.led_by(&-lever[0]))
            .plus(&opposed.scaled(-1.0));
        let mut second_moment = shared.plus(&force.led_by(&lever[1])).plus(&opposed);
        let force_hat = hat(&stress.force);
        first_moment.first_rotation -= force_hat * lever[0];
        second_moment.second_rotation += force_hat * lever[1];
        let close = |mut d: Sensitivity| {
            d.first_rotation += d.translation * lever[0];
            d.second_rotation -= d.translation * lever[1];
            d
        };
        let mut tangent = PairTangent {
            force: close(force),
            first_moment: close(first_moment),
            second_moment: close(second_moment),
        };
        if stiffness.damping > 0.0 && rates.velocity > 0.0 {
            self.add_damping(stiffness, first, second, &middle_by, rates, &mut tangent);
        }
        tangent
    }

    fn add_damping(
        &self,
        stiffness: &ConnectorStiffness,
        first: &Side,
        second: &Side,
        middle_by: &Sensitivity,
        rates: &RateWeights,
        tangent: &mut PairTangent,
    ) {
        let tau = stiffness.damping;
        let axis: Vector3 = self.middle.column(0).into();
        let k = stiffness.matrices(&axis);
        let (q, d) = (&self.gap_rate, &self.bend_rate);
        let along = stiffness.axial - stiffness.shear;
        let twist = stiffness.torsion - stiffness.bending;
        let axis_hat = hat(&axis);
        let turn = |v: &Vector3, factor: f64| {
            (Matrix3::identity() * axis.dot(v) + axis * v.transpose()) * factor
        };
        let force_turn = turn(q, along) * axis_hat;
        let moment_turn = turn(d, twist) * axis_hat;

        let lever = [hat(&first.lever), hat(&second.lever)];
        let gap_hat = hat(&self.gap);
        let mean_spin = (first.spin + second.spin) * 0.5;
        let gap_by_first = lever[0];
        let gap_by_second = -lever[1];
        let spin_hat = hat(&mean_spin);
        // Rate of the gap, by configuration and through the velocities, increments of both frames.
        let v = rates.velocity;
        let rate_first = hat(&first.spin) * lever[0] - spin_hat * gap_by_first
            + (lever[0] + gap_hat * 0.5) * rates.rotation[0] * v;
        let rate_second = -hat(&second.spin) * lever[1] - spin_hat * gap_by_second
            + (gap_hat * 0.5 - lever[1]) * rates.rotation[1] * v;
        let rate_translation = Matrix3::identity() * v - spin_hat;
        let spin_first = -rates.rotation[0] * v;
        let spin_second = rates.rotation[1] * v;
        let force = Sensitivity {
            translation: k.force_gap * rate_translation * tau,
            first_rotation: (k.force_gap * rate_first - force_turn * middle_by.first_rotation)
                * tau,
            second_rotation: (k.force_gap * rate_second - force_turn * middle_by.second_rotation)
                * tau,
        };
        let moment = Sensitivity {
            translation: Matrix3::zeros(),
            first_rotation: (k.moment_bend * spin_first - moment_turn * middle_by.first_rotation)
                * tau,
            second_rotation: (k.moment_bend * spin_second
                - moment_turn * middle_by.second_rotation)
                * tau,
        };
        let force_hat = hat(&self.damping.force);
        let mut couple = force.led_by(&gap_hat);
        couple.translation -= force_hat;
        couple.first_rotation -= force_hat * gap_by_first;
        couple.second_rotation -= force_hat * gap_by_second;
        let shared = couple.scaled(-0.5);
        let mut first_moment = shared
            .plus(&force.led_by(&-lever[0]))
            .plus(&moment.scaled(-1.0));
        let mut second_moment = shared.plus(&force.led_by(&lever[1])).plus(&moment);
        first_moment.first_rotation -= force_hat * lever[0];
        second_moment.second_rotation += force_hat * lever[1];
        tangent.force = tangent.force.plus(&force);
        tangent.first_moment = tangent.first_moment.plus(&first_moment);
        tangent.second_moment = tangent.second_moment.plus(&second_moment);
    }

    /// Elastic stress after a small move, from the linear solution: the mixed force unknown.
    /// Components in the connector's middle axes, so that they survive its rotation.
    ///
    /// Source: docs/theory/solver.md, eq. (6); Magisano, Leonetti and Garcea 2017.
    pub fn predicted_stress(
        &self,
        stiffness: &ConnectorStiffness,
        first: &Side,
        second: &Side,
        first_move: (&Vector3, &Vector3),
        second_move: (&Vector3, &Vector3),
    ) -> Stress {
        let half = HalfAngle::new(self.bend.norm_squared());
        let axis: Vector3 = self.middle.column(0).into();
        let gap_move = second_move.0 - first_move.0 + second_move.1.cross(&second.lever)
            - first_move.1.cross(&first.lever);
        let difference = second_move.1 - first_move.1;
        let middle_move =
            (first_move.1 + second_move.1) * 0.5 - self.bend.cross(&difference) * (0.25 * half.k);
        let gap = self.gap + gap_move - middle_move.cross(&self.gap);
        let bend = self.bend + self.conjugate_moment(&half, &difference);
        let stress = stiffness.stress(&axis, &gap, &bend);
        let back = self.middle.transpose();
        Stress {
            force: back * stress.force,
            moment: back * stress.moment,
        }
    }

    /// Elastic energy [J].
    pub fn energy(&self) -> f64 {
        0.5 * (self.elastic.force.dot(&self.gap) + self.elastic.moment.dot(&self.bend))
    }

    /// Power of the damping stress on the two frames, negative [W].
    pub fn damping_power(&self) -> f64 {
        -(self.damping.force.dot(&self.gap_rate) + self.damping.moment.dot(&self.bend_rate))
    }
}
