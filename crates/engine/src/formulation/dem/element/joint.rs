//! The end of a line on a ball, universal or hinge joint.
//!
//! The half element between the last element's centre and the joint is the joint's compliance, so
//! the joint is exact: its free rotations carry no moment and its held ones have the stiffness of
//! half an element, no penalty. The position is held by the half element's axial and shear
//! stiffness in the element's own axes; held rotations by springs on the scalar product of two
//! directions, which have the exact kinematics of a cross.
//!
//! Source: docs/theory/dem.md, eqs. (18) to (21).

use catenix_numerics::{Matrix3, Vector3, so3};

use super::connector::Prediction;
use super::pair::{PairForces, PairTangent, RateWeights, Sensitivity, Side};
use super::stiffness::ConnectorStiffness;
use so3::hat;

/// A spring on e = a . b, with `a` fixed to the support and `b` to the element.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DotSpring {
    /// Direction a in the support's connection axes, unit (3).
    pub support_axis: Vector3,
    /// Direction b in the element's axes, unit (3).
    pub element_axis: Vector3,
    /// How e becomes energy.
    pub law: DotLaw,
}

/// Energy of a [`DotSpring`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DotLaw {
    /// k e^2 / 2: keeps a and b perpendicular [N m/rad].
    Perpendicular(f64),
    /// k angle^2 / 2: keeps a and b parallel [N m/rad].
    Parallel(f64),
}

impl DotLaw {
    /// Energy and its first and second derivative by e.
    fn at(self, e: f64) -> [f64; 3] {
        match self {
            DotLaw::Perpendicular(k) => [0.5 * k * e * e, k * e, k],
            DotLaw::Parallel(k) => {
                let e = e.clamp(-0.999_999, 1.0);
                let angle = e.acos();
                let sin2 = 1.0 - e * e;
                if sin2 < 1e-4 {
                    // Series about e = 1 with y = 1 - e: angle^2 = 2 y + y^2 / 3 + 4 y^3 / 45 + ..
                    let y = 1.0 - e;
                    let first = 1.0 + y / 3.0 + 2.0 * y * y / 15.0;
                    return [
                        0.5 * k * angle * angle,
                        -k * first,
                        k * (1.0 / 3.0 + 4.0 * y / 15.0),
                    ];
                }
                let sin = sin2.sqrt();
                [
                    0.5 * k * angle * angle,
                    -k * angle / sin,
                    k * (1.0 - e * angle / sin) / sin2,
                ]
            }
        }
    }
}

impl DotLaw {
    /// Stiffness that the structural damping is proportional to. The spring of a flex joint is
    /// part of the joint, not of the line, and has none.
    fn damped_stiffness(self) -> f64 {
        match self {
            DotLaw::Perpendicular(k) => k,
            DotLaw::Parallel(_) => 0.0,
        }
    }
}

/// A line's end on a joint.
#[derive(Debug, Clone, PartialEq)]
pub struct JointStiffness {
    /// Stiffness of the half element; only its axial and shear parts are used.
    pub half: ConnectorStiffness,
    /// 1 where the element's axis points to the support (end B), -1 at end A.
    pub forward: f64,
    /// Springs of the held rotations.
    pub springs: Vec<DotSpring>,
}

/// A joint at one configuration.
#[derive(Debug, Clone, Copy)]
pub struct JointState {
    /// From the element's end to the joint's point on the support, global (3) [m].
    pub gap: Vector3,
    /// Elastic force of the support on the element's end (3) [N].
    pub elastic: Vector3,
    /// Damping force (3) [N].
    pub damping: Vector3,
    /// Moment of the springs on the element, damping included, as gradient (3) [N m].
    pub moment: Vector3,
    gap_rate: Vector3,
    spring_energy: f64,
    spring_damping_power: f64,
}

fn axial(half: &ConnectorStiffness, axis: &Vector3, gap: &Vector3) -> Vector3 {
    gap * half.shear + axis * ((half.axial - half.shear) * axis.dot(gap))
}

impl JointStiffness {
    /// Force of the half element at a gap; its axial part may follow a law given by points.
    #[inline]
    fn elastic(&self, axis: &Vector3, gap: &Vector3) -> Vector3 {
        if self.half.general.is_none() {
            return axial(&self.half, axis, gap);
        }
        let extension = axis.dot(gap);
        let (tension, _) = self.half.tension(self.forward * extension);
        gap * self.half.shear + axis * (self.forward * tension - self.half.shear * extension)
    }

    /// Energy of the half element at a gap, along `axis` (unit) [J].
    fn energy(&self, axis: &Vector3, gap: &Vector3) -> f64 {
        let extension = axis.dot(gap);
        0.5 * self.half.shear * (gap.norm_squared() - extension * extension)
            + self.half.axial_energy(self.forward * extension)
    }
}

impl JointState {
    /// Measures the joint. `support` comes first, `element` second.
    pub fn new(joint: &JointStiffness, support: &Side, element: &Side) -> JointState {
        let axis: Vector3 = element.rotation.column(0).into();
        let gap = support.point - element.point;
        let gap_rate = support.velocity - element.velocity - element.spin.cross(&gap);
        let relative_spin = element.spin - support.spin;
        let tau = joint.half.damping;
        let mut state = JointState {
            gap,
            elastic: joint.elastic(&axis, &gap),
            damping: axial(&joint.half, &axis, &gap_rate) * tau,
            moment: Vector3::zeros(),
            gap_rate,
            spring_energy: 0.0,
            spring_damping_power: 0.0,
        };
        for spring in &joint.springs {
            let (a, b) = spring.directions(support, element);
            let turn = b.cross(&a);
            let [energy, slope, _] = spring.law.at(a.dot(&b));
            let rate = turn.dot(&relative_spin);
            let damping = tau * spring.law.damped_stiffness();
            state.moment += turn * (slope + damping * rate);
            state.spring_energy += energy;
            state.spring_damping_power -= damping * rate * rate;
        }
        state
    }

    /// Generalised forces: `first` on the support, `second` on the element.
    ///
    /// Source: docs/theory/dem.md, eqs. (18) and (19).
    pub fn forces(&self, support: &Side, element: &Side) -> PairForces {
        let force = self.elastic + self.damping;
        let about_element = element.lever + self.gap;
        PairForces::new(
            &-force,
            &(support.lever.cross(&force) - self.moment),
            &(-about_element.cross(&force) + self.moment),
        )
    }

    /// Exact derivative of [`Self::forces`]. With a `prediction`, its force takes the place of the
    /// elastic one in the geometric part, as in the connector.
    pub fn tangent(
        &self,
        joint: &JointStiffness,
        support: &Side,
        element: &Side,
        prediction: Option<&Prediction>,
        rates: &RateWeights,
    ) -> PairTangent {
        let axis: Vector3 = element.rotation.column(0).into();
        let half = &joint.half;
        let along = half.axial - half.shear;
        let elastic = prediction.map_or(self.elastic, |p| p.force(half, &axis, joint.forward));
        let (_, slope) = half.tension(joint.forward * axis.dot(&self.gap));
        let outer = axis * axis.transpose();
        let matrix = Matrix3::identity() * half.shear + outer * (slope - half.shear);
        let lever = [hat(&support.lever), hat(&element.lever)];
        let gap_hat = hat(&self.gap);
        // The gap moves with the support (first) and against the element (second).
        let gap = Sensitivity {
            translation: -Matrix3::identity(),
            first_rotation: -lever[0],
            second_rotation: lever[1],
        };
        // Force of the joint on the support's side of the pair: K gap in the element's axes.
        let mut force = gap.led_by(&matrix);
        force.second_rotation += matrix * gap_hat - hat(&elastic);
        let tau = half.damping;
        let mut total = elastic;
        if tau > 0.0 && rates.velocity > 0.0 {
            let v = rates.velocity;
            let q = &self.gap_rate;
            let spin_hat = hat(&element.spin);
            let rate = Sensitivity {
                translation: Matrix3::identity() * -v + spin_hat,
                first_rotation: -hat(&support.spin) * lever[0] + spin_hat * lever[0]
                    - lever[0] * rates.rotation[0] * v,
                second_rotation: (lever[1] + gap_hat) * rates.rotation[1] * v,
            };
            let turn = (Matrix3::identity() * axis.dot(q) + axis * q.transpose()) * along;
            let damping_matrix = Matrix3::identity() * half.shear + outer * along;
            let mut damping = rate.led_by(&damping_matrix);
            damping.second_rotation -= turn * hat(&axis);
            force = force.plus(&damping.scaled(tau));
            total += self.damping;
        }
        let total_hat = hat(&total);
        let mut first_moment = force.led_by(&lever[0]);
        first_moment.first_rotation += total_hat * lever[0];
        let mut second_moment = force.led_by(&-(lever[1] + gap_hat));
        // d (lever + gap) x force: the lever turns with the element, the gap as above.
        let mut arm = gap;
        arm.second_rotation -= lever[1];
        second_moment = second_moment.plus(&arm.led_by(&total_hat));
        let spring = self.spring_tangent(joint, support, element, rates);
        let mut tangent = PairTangent {
            force: force.scaled(-1.0),
            first_moment: first_moment.plus(&spring.scaled(-1.0)),
            second_moment: second_moment.plus(&spring),
        };
        let change = elastic - self.elastic;
        let arms = [support.lever, -(element.lever + self.gap)];
        tangent.turn_with(arms.map(|arm| arm.cross(&change)));
        tangent
    }

    fn spring_tangent(
        &self,
        joint: &JointStiffness,
        support: &Side,
        element: &Side,
        rates: &RateWeights,
    ) -> Sensitivity {
        let relative_spin = element.spin - support.spin;
        let tau = joint.half.damping;
        let mut moment = Sensitivity::ZERO;
        for spring in &joint.springs {
            let (a, b) = spring.directions(support, element);
            let turn = b.cross(&a);
            let (a_hat, b_hat) = (hat(&a), hat(&b));
            let turn_by_element = a_hat * b_hat;
            let turn_by_support = -(b_hat * a_hat);
            let [_, slope, curvature] = spring.law.at(a.dot(&b));
            let stiffness = spring.law.damped_stiffness();
            let rate = turn.dot(&relative_spin);
            let outer = turn * turn.transpose();
            let along = turn * relative_spin.transpose() * (tau * stiffness);
            let level = slope + tau * stiffness * rate;
            let v = rates.velocity * tau * stiffness;
            moment.second_rotation += outer * curvature
                + turn_by_element * level
                + along * turn_by_element
                + outer * rates.rotation[1] * v;
            moment.first_rotation +=
                -outer * curvature + turn_by_support * level + along * turn_by_support
                    - outer * rates.rotation[0] * v;
        }
        moment
    }

    /// Gap after a small move, from the linear solution (see the connector).
    pub fn predicted(
        &self,
        support: &Side,
        element: &Side,
        support_move: (&Vector3, &Vector3),
        element_move: (&Vector3, &Vector3),
    ) -> Prediction {
        let axis: Vector3 = element.rotation.column(0).into();
        let gap_move = support_move.0 - element_move.0 + support_move.1.cross(&support.lever)
            - element_move.1.cross(&element.lever);
        // In the element's axes, so that its rotation changes nothing.
        let gap = self.gap + gap_move - element_move.1.cross(&self.gap);
        let extension = axis.dot(&gap);
        Prediction {
            extension,
            across: gap - axis * extension,
        }
    }

    /// Elastic energy [J].
    pub fn energy(&self, joint: &JointStiffness, element: &Side) -> f64 {
        if joint.half.general.is_none() {
            return 0.5 * self.elastic.dot(&self.gap) + self.spring_energy;
        }
        let axis: Vector3 = element.rotation.column(0).into();
        joint.energy(&axis, &self.gap) + self.spring_energy
    }

    /// Power of the damping, negative [W].
    pub fn damping_power(&self) -> f64 {
        self.spring_damping_power - self.damping.dot(&self.gap_rate)
    }
}

impl DotSpring {
    fn directions(&self, support: &Side, element: &Side) -> (Vector3, Vector3) {
        (
            support.rotation * self.support_axis,
            element.rotation * self.element_axis,
        )
    }
}
