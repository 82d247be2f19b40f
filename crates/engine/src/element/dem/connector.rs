//! The flexible connector between two rigid elements, or between an element and a clamp.
//!
//! Six deformations: the gap between the two connection points, along the mean of the two axes
//! (extension) and across it (two shears); the angle between the axes (two bendings); and the twist
//! between the sections, against parallel transport from one axis to the other (torsion). For a
//! round section these need the axes and one direction fixed to each section, no rotation vector,
//! and a spin of the elements meets torsion only.
//!
//! Forces are the exact gradient of the stored energy, so that momentum and energy are kept for any
//! rotation; the tangent is exact.
//!
//! Lines whose sections have directions, a stress-free bend or a law given by points differ in the
//! moment (`bend.rs`) and the tension only; see docs/theory/sections.md.
//!
//! Source: docs/theory/dem.md, eqs. (1) to (12). Deviation from Li et al. 2011: rotations are
//! finite, where the paper's six springs are written for small ones; the twist is that of
//! Bergou et al. 2008 (discrete elastic rods).

use catenix_numerics::{Matrix3, Vector3, so3};

use super::bend::Bend;
use super::pair::{PairForces, PairTangent, RateWeights, Sensitivity, Side};
use super::stiffness::ConnectorStiffness;
use so3::hat;

/// Force and moment in a connector, global components.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Stress {
    /// Force of the second side on the first [N].
    pub force: Vector3,
    /// Moment of the second side on the first [N m].
    pub moment: Vector3,
}

/// What the mixed Newton method predicts of a connector: its gap after the linear solution, split
/// into parts that survive a rotation of the pair.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Prediction {
    /// Gap along the axis [m].
    pub extension: f64,
    /// Gap across the axis (3) [m].
    pub across: Vector3,
}

impl Prediction {
    /// The force that belongs to the prediction, about the axis of the new configuration.
    /// `forward`: 1 where a positive extension stretches, -1 where it compresses.
    #[inline]
    pub fn force(&self, stiffness: &ConnectorStiffness, axis: &Vector3, forward: f64) -> Vector3 {
        let across = self.across - axis * axis.dot(&self.across);
        let (tension, _) = stiffness.tension(forward * self.extension);
        axis * (forward * tension) + across * stiffness.shear
    }
}

/// A connector at one configuration: geometry, elastic stress and damping stress.
#[derive(Debug, Clone, Copy)]
pub struct ConnectorState {
    /// From the first connection point to the second (3) [m].
    pub gap: Vector3,
    /// Mean of the two axes, unit (3).
    pub axis: Vector3,
    /// Twist of the second section against the first [rad].
    pub twist: f64,
    /// Elastic stress.
    pub elastic: Stress,
    /// Damping stress.
    pub damping: Stress,
    /// Axes of the two sides, unit.
    axes: [Vector3; 2],
    /// Length of the sum of the two axes, 2 cos(half the angle between them).
    sum: f64,
    /// (axial - shear stiffness) x extension: the stretching force beyond the shear stiffness [N].
    stretch: f64,
    /// Gap across the mean axis (3) [m].
    across: Vector3,
    /// Rate of the gap, less its turning with the mean spin (3) [m/s].
    gap_rate: Vector3,
    /// Difference of the angular velocities (3) [rad/s].
    bend_rate: Vector3,
}

/// Angle over its sine as a function of the cosine, with its derivative.
#[inline]
fn angle_over_sine(cos: f64) -> (f64, f64) {
    let y = 1.0 - cos;
    if y < 5e-3 {
        let value = 1.0 + y * (1.0 / 3.0 + y * (2.0 / 15.0 + y * (2.0 / 35.0 + y * (8.0 / 315.0))));
        let slope = 1.0 / 3.0
            + y * (4.0 / 15.0 + y * (6.0 / 35.0 + y * (32.0 / 315.0 + y * (40.0 / 693.0))));
        return (value, -slope);
    }
    let sin2 = (1.0 - cos * cos).max(1e-12);
    let value = cos.clamp(-1.0, 1.0).acos() / sin2.sqrt();
    (value, (cos * value - 1.0) / sin2)
}

/// Angle from the first section's direction, carried along to the second axis, to the second's.
///
/// Source: docs/theory/dem.md, eq. (3).
#[inline]
fn twist(first: &Side, second: &Side, cross: &Vector3, one_plus_cos: f64) -> f64 {
    let start: Vector3 = first.rotation.column(1).into();
    let end: Vector3 = second.rotation.column(1).into();
    let axis: Vector3 = second.rotation.column(0).into();
    let turned = cross.cross(&start);
    let carried = start + turned + cross.cross(&turned) / one_plus_cos;
    axis.dot(&carried.cross(&end)).atan2(carried.dot(&end))
}

impl ConnectorState {
    /// Measures the deformation between two sides and the stress that follows.
    ///
    /// Source: docs/theory/dem.md, eqs. (1) to (5) and (9).
    #[inline]
    pub fn new(stiffness: &ConnectorStiffness, first: &Side, second: &Side) -> ConnectorState {
        let a: Vector3 = first.rotation.column(0).into();
        let b: Vector3 = second.rotation.column(0).into();
        let total = a + b;
        // Opposite axes have no mean; such a state is lost, and the step is cut.
        let sum = total.norm().max(1e-6);
        let axis = total / sum;
        let one_plus_cos = 0.5 * sum * sum;
        let gap = second.point - first.point;
        let extension = axis.dot(&gap);
        let stretch = match &stiffness.general {
            None => (stiffness.axial - stiffness.shear) * extension,
            Some(_) => stiffness.tension(extension).0 - stiffness.shear * extension,
        };
        let cross = a.cross(&b);
        let twist = if stiffness.torsion > 0.0 || stiffness.general.is_some() {
            twist(first, second, &cross, one_plus_cos)
        } else {
            0.0
        };
        let moment = match &stiffness.general {
            None => {
                let (ratio, _) = angle_over_sine(one_plus_cos - 1.0);
                cross * (stiffness.bending * ratio)
                    + total * (stiffness.torsion * twist / one_plus_cos)
            }
            Some(law) => {
                let torque = stiffness.torsion * (twist - law.rest_twist);
                Bend::new(first, second, twist).moment(law, torque)
            }
        };
        let mean_spin = (first.spin + second.spin) * 0.5;
        let gap_rate = second.velocity - first.velocity - mean_spin.cross(&gap);
        let bend_rate = second.spin - first.spin;
        ConnectorState {
            gap,
            axis,
            twist,
            elastic: Stress {
                force: gap * stiffness.shear + axis * stretch,
                moment,
            },
            damping: stiffness.damping_stress(&axis, [first, second], &gap_rate, &bend_rate),
            axes: [a, b],
            sum,
            stretch,
            across: gap - axis * extension,
            gap_rate,
            bend_rate,
        }
    }

    /// Generalised forces on the two frames.
    ///
    /// Source: docs/theory/dem.md, eqs. (6) and (10).
    #[inline]
    pub fn forces(&self, first: &Side, second: &Side) -> PairForces {
        let force = self.elastic.force + self.damping.force;
        let moment = self.elastic.moment + self.damping.moment;
        let turning = self.across * (self.stretch / self.sum);
        let shared = self.gap.cross(&self.damping.force) * -0.5;
        PairForces::new(
            &force,
            &(self.axes[0].cross(&turning) + shared - first.lever.cross(&force) - moment),
            &(self.axes[1].cross(&turning) + shared + second.lever.cross(&force) + moment),
        )
    }

    /// Exact derivative of [`Self::forces`]. With a `prediction`, its stress takes the place of the
    /// elastic stress in the geometric part (the mixed form).
    ///
    /// Source: docs/theory/dem.md, eqs. (7), (8), (11) and (12).
    pub fn tangent(
        &self,
        stiffness: &ConnectorStiffness,
        first: &Side,
        second: &Side,
        prediction: Option<&Prediction>,
        rates: &RateWeights,
    ) -> PairTangent {
        let [a, b] = &self.axes;
        let m = &self.axis;
        let inverse = 1.0 / self.sum;
        let shear = stiffness.shear;
        let extension = m.dot(&self.gap);
        let (_, axial) = stiffness.tension(extension);
        let across = &self.across;
        // Tension and shear force of the geometric part.
        let force_vector = match prediction {
            Some(prediction) => prediction.force(stiffness, m, 1.0),
            None => self.elastic.force,
        };
        let tension = m.dot(&force_vector);
        let shear_force = force_vector - m * tension;
        let (a_hat, b_hat) = (hat(a), hat(b));
        let outer = m * m.transpose();
        let project = Matrix3::identity() - outer;

        // By the gap, and by the sum of the axes.
        let force_by_gap = Matrix3::identity() * shear + outer * (axial - shear);
        let force_by_sum = (m * (across * axial - shear_force).transpose()
            + project * (tension - shear * extension))
            * inverse;
        let turning = (across * tension - shear_force * extension) * inverse;
        let turning_by_gap = force_by_sum.transpose();
        let skewed = m * turning.transpose() * self.sum;
        let turning_by_sum = ((across * axial - shear_force) * across.transpose()
            + project * (extension * (shear * extension - tension))
            - skewed
            - skewed.transpose())
            * (inverse * inverse);

        let moment_by_spins = match &stiffness.general {
            None => self.round_moment_by_spins(stiffness, &a_hat, &b_hat, &outer),
            Some(law) => {
                let torque = stiffness.torsion * (self.twist - law.rest_twist);
                Bend::new(first, second, self.twist).moment_by_spins(law, torque, stiffness.torsion)
            }
        };

        let force = Sensitivity {
            translation: force_by_gap,
            first_rotation: -(force_by_sum * a_hat),
            second_rotation: -(force_by_sum * b_hat),
        };
        let turn = Sensitivity {
            translation: turning_by_gap,
            first_rotation: -(turning_by_sum * a_hat),
            second_rotation: -(turning_by_sum * b_hat),
        };
        let moment = Sensitivity {
            translation: Matrix3::zeros(),
            first_rotation: moment_by_spins[0],
            second_rotation: moment_by_spins[1],
        };
        let lever = [hat(&first.lever), hat(&second.lever)];
        let mut first_moment = turn
            .led_by(&a_hat)
            .plus(&force.led_by(&-lever[0]))
            .plus(&moment.scaled(-1.0));
        let mut second_moment = turn
            .led_by(&b_hat)
            .plus(&force.led_by(&lever[1]))
            .plus(&moment);
        let (force_hat, turning_hat) = (hat(&force_vector), hat(&turning));
        first_moment.first_rotation += turning_hat * a_hat - force_hat * lever[0];
        second_moment.second_rotation += turning_hat * b_hat + force_hat * lever[1];
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
            let axis_by_sum = project * inverse;
            let axis_by = [-(axis_by_sum * a_hat), -(axis_by_sum * b_hat)];
            self.add_damping(stiffness, first, second, &axis_by, rates, &mut tangent);
        }
        tangent
    }

    /// Derivatives of the moment of a round straight section by the spins of the two frames.
    ///
    /// Source: docs/theory/dem.md, eq. (8).
    #[inline]
    fn round_moment_by_spins(
        &self,
        stiffness: &ConnectorStiffness,
        a_hat: &Matrix3,
        b_hat: &Matrix3,
        outer: &Matrix3,
    ) -> [Matrix3; 2] {
        let [a, b] = &self.axes;
        // By the two axes, and by the difference of rotations.
        let one_plus_cos = 0.5 * self.sum * self.sum;
        let (ratio, slope) = angle_over_sine(one_plus_cos - 1.0);
        let cross = a.cross(b);
        let along_sum = self.axis * self.sum;
        let torque = stiffness.torsion * self.twist / one_plus_cos;
        let by_cos = cross * (stiffness.bending * slope) - along_sum * (torque / one_plus_cos);
        let bend = stiffness.bending * ratio;
        let torsion = outer * (2.0 * stiffness.torsion / one_plus_cos);
        let by_first_axis = by_cos * b.transpose() - b_hat * bend + Matrix3::identity() * torque;
        let by_second_axis = by_cos * a.transpose() + a_hat * bend + Matrix3::identity() * torque;
        [
            -(by_first_axis * a_hat) - torsion,
            -(by_second_axis * b_hat) + torsion,
        ]
    }

    /// Adds the derivatives of the damping stress. `axis_by`: of the mean axis by the rotations.
    fn add_damping(
        &self,
        stiffness: &ConnectorStiffness,
        first: &Side,
        second: &Side,
        axis_by: &[Matrix3; 2],
        rates: &RateWeights,
        tangent: &mut PairTangent,
    ) {
        let tau = stiffness.damping;
        let m = &self.axis;
        let outer = m * m.transpose();
        let along = stiffness.axial - stiffness.shear;
        let twist = stiffness.torsion - stiffness.bending;
        let by_rate = Matrix3::identity() * stiffness.shear + outer * along;
        let by_axis = |v: &Vector3, factor: f64| {
            (Matrix3::identity() * m.dot(v) + m * v.transpose()) * factor
        };
        let force_by_axis = by_axis(&self.gap_rate, along);

        let lever = [hat(&first.lever), hat(&second.lever)];
        let gap_hat = hat(&self.gap);
        let mean_spin = (first.spin + second.spin) * 0.5;
        let spin_hat = hat(&mean_spin);
        // Rate of the gap by the increments: by configuration, and through the velocities.
        let v = rates.velocity;
        let rate_first = hat(&first.spin) * lever[0] - spin_hat * lever[0]
            + (lever[0] + gap_hat * 0.5) * rates.rotation[0] * v;
        let rate_second = -hat(&second.spin) * lever[1]
            + spin_hat * lever[1]
            + (gap_hat * 0.5 - lever[1]) * rates.rotation[1] * v;
        let rate_translation = Matrix3::identity() * v - spin_hat;
        let force = Sensitivity {
            translation: by_rate * rate_translation * tau,
            first_rotation: (by_rate * rate_first + force_by_axis * axis_by[0]) * tau,
            second_rotation: (by_rate * rate_second + force_by_axis * axis_by[1]) * tau,
        };
        // The moment by rates of rotation, and by the rotations that turn this matrix.
        let (by_bend, turned) = match &stiffness.general {
            None => {
                let moment_by_axis = by_axis(&self.bend_rate, twist);
                (
                    Matrix3::identity() * stiffness.bending + outer * twist,
                    [
                        moment_by_axis * axis_by[0] * tau,
                        moment_by_axis * axis_by[1] * tau,
                    ],
                )
            }
            Some(law) => {
                let each = stiffness.turned_stiffness(law, [first, second]);
                let d = &self.bend_rate;
                let turned = each.map(|own| (own * hat(d) - hat(&(own * d))) * (0.5 * tau));
                ((each[0] + each[1]) * 0.5, turned)
            }
        };
        let spin = by_bend * (v * tau);
        let moment = Sensitivity {
            translation: Matrix3::zeros(),
            first_rotation: turned[0] - spin * rates.rotation[0],
            second_rotation: turned[1] + spin * rates.rotation[1],
        };
        let force_hat = hat(&self.damping.force);
        let mut couple = force.led_by(&gap_hat);
        couple.translation -= force_hat;
        couple.first_rotation -= force_hat * lever[0];
        couple.second_rotation += force_hat * lever[1];
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

    /// Gap after a small move, from the linear solution: the mixed unknowns.
    ///
    /// Source: docs/theory/solver.md, eq. (6); Magisano, Leonetti and Garcea 2017.
    pub fn predicted(
        &self,
        first: &Side,
        second: &Side,
        first_move: (&Vector3, &Vector3),
        second_move: (&Vector3, &Vector3),
    ) -> Prediction {
        let [a, b] = &self.axes;
        let gap_move = second_move.0 - first_move.0 + second_move.1.cross(&second.lever)
            - first_move.1.cross(&first.lever);
        let m = &self.axis;
        let sum_move = first_move.1.cross(a) + second_move.1.cross(b);
        let axis_move = (sum_move - m * m.dot(&sum_move)) / self.sum;
        let extension = m.dot(&self.gap);
        let across_move = gap_move - m * m.dot(&gap_move) - axis_move * extension;
        Prediction {
            extension: extension + m.dot(&gap_move) + self.across.dot(&axis_move),
            across: self.across + across_move,
        }
    }

    /// Elastic energy [J].
    ///
    /// Source: docs/theory/dem.md, eq. (5); docs/theory/sections.md, eq. (5).
    pub fn energy(&self, stiffness: &ConnectorStiffness, first: &Side, second: &Side) -> f64 {
        if let Some(law) = &stiffness.general {
            let twist = self.twist - law.rest_twist;
            let bend = Bend::new(first, second, self.twist).change(law);
            return 0.5 * stiffness.shear * self.across.norm_squared()
                + stiffness.axial_energy(self.axis.dot(&self.gap))
                + law.bending.at(bend).energy
                + 0.5 * stiffness.torsion * twist * twist;
        }
        let angle = self.axes[0]
            .cross(&self.axes[1])
            .norm()
            .atan2(self.axes[0].dot(&self.axes[1]));
        0.5 * (self.elastic.force.dot(&self.gap)
            + stiffness.bending * angle * angle
            + stiffness.torsion * self.twist * self.twist)
    }

    /// Power of the damping stress on the two frames, negative [W].
    pub fn damping_power(&self) -> f64 {
        -(self.damping.force.dot(&self.gap_rate) + self.damping.moment.dot(&self.bend_rate))
    }
}
