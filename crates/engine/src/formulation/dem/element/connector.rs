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

use catenix_numerics::lanes::{Lane, Mat3, Vec3};
use catenix_numerics::{Vector3, so3::hat};

use super::bend::Bend;
use super::pair::{PairForces, PairTangent, RateWeights, Sensitivity, Side};
use super::pair_kernel::{PairGeometry, PairLaw, PairRates, PairTangents, PairWeights};
use super::stiffness::ConnectorStiffness;

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
        let (tension, _) = stiffness.tension(forward * self.extension);
        let across = Vec3::from(&self.across);
        predicted_force(axis.into(), forward * tension, stiffness.shear, across).into()
    }
}

/// The force that stands in the geometric part of the tangent when the mixed form has predicted the
/// gap along the axis, which gives `tension` [N], and across it (3) [m].
///
/// Source: docs/theory/solver.md, eq. (6).
#[inline(always)]
pub fn predicted_force<T: Lane>(axis: Vec3<T>, tension: T, shear: T, across: Vec3<T>) -> Vec3<T> {
    let flat = across.plus(-axis.dot(across), axis);
    (axis * tension).plus(shear, flat)
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
    geometry: PairGeometry<f64>,
    rates: PairRates<f64>,
    /// (axial - shear stiffness) x extension: the stretching force beyond the shear stiffness [N].
    stretch: f64,
}

/// The four stiffnesses of a connector, with the axial one at an extension.
fn law_of(stiffness: &ConnectorStiffness, axial: f64) -> PairLaw<f64> {
    PairLaw {
        axial,
        shear: stiffness.shear,
        torsion: stiffness.torsion,
        bending: stiffness.bending,
        damping: stiffness.damping,
    }
}

impl ConnectorState {
    /// Measures the deformation between two sides and the stress that follows.
    ///
    /// Source: docs/theory/dem.md, eqs. (1) to (5) and (9).
    #[inline]
    pub fn new(stiffness: &ConnectorStiffness, first: &Side, second: &Side) -> ConnectorState {
        let column = |side: &Side, k: usize| Vec3::from(&side.rotation.column(k).into_owned());
        let gap = second.point - first.point;
        let sides = [first, second];
        let geometry = PairGeometry::new(sides.map(|side| column(side, 0)), (&gap).into());
        let extension = geometry.extension();
        let stretch = match &stiffness.general {
            None => (stiffness.axial - stiffness.shear) * extension,
            Some(_) => stiffness.tension(extension).0 - stiffness.shear * extension,
        };
        let twist = if stiffness.torsion > 0.0 || stiffness.general.is_some() {
            geometry.twist(sides.map(|side| column(side, 1)))
        } else {
            0.0
        };
        let law = law_of(stiffness, stiffness.axial);
        let rates = geometry.rates(
            sides.map(|side| (&side.spin).into()),
            (&(second.velocity - first.velocity)).into(),
        );
        let [damping_force, round_damping] = geometry.damping(&law, &rates);
        let (moment, damping_moment) = match &stiffness.general {
            None => (
                geometry.round_moment(&law, twist).into(),
                round_damping.into(),
            ),
            Some(general) => {
                let torque = stiffness.torsion * (twist - general.rest_twist);
                let [a, b] = stiffness.turned_stiffness(general, sides);
                let bend_rate = Vector3::from(rates.bend);
                (
                    Bend::new(first, second, twist).moment(general, torque),
                    (a + b) * bend_rate * (0.5 * stiffness.damping),
                )
            }
        };
        ConnectorState {
            gap,
            axis: geometry.mean.into(),
            twist,
            elastic: Stress {
                force: (geometry.gap * stiffness.shear)
                    .plus(stretch, geometry.mean)
                    .into(),
                moment,
            },
            damping: Stress {
                force: damping_force.into(),
                moment: damping_moment,
            },
            geometry,
            rates,
            stretch,
        }
    }

    /// Generalised forces on the two frames.
    ///
    /// Source: docs/theory/dem.md, eqs. (6) and (10).
    #[inline]
    pub fn forces(&self, first: &Side, second: &Side) -> PairForces {
        let force = self.elastic.force + self.damping.force;
        let moment = self.elastic.moment + self.damping.moment;
        let [first_moment, second_moment] = self.geometry.moments(
            [&first.lever, &second.lever].map(Vec3::from),
            (&force).into(),
            (&moment).into(),
            (&self.damping.force).into(),
            self.geometry.turning(self.stretch),
        );
        PairForces::new(&force, &first_moment.into(), &second_moment.into())
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
        let (_, axial) = stiffness.tension(self.geometry.extension());
        // Tension and shear force of the geometric part.
        let geometric = match prediction {
            Some(prediction) => prediction.force(stiffness, &self.axis, 1.0),
            None => self.elastic.force,
        };
        let law = law_of(stiffness, axial);
        let moment_by = match &stiffness.general {
            None => self.geometry.round_moment_by_rotations(&law, self.twist),
            Some(general) => {
                let torque = stiffness.torsion * (self.twist - general.rest_twist);
                Bend::new(first, second, self.twist)
                    .moment_by_spins(general, torque, stiffness.torsion)
                    .map(|by| Mat3::from(&by))
            }
        };
        // About the connection points, and from there to the origins of the frames.
        let about_points =
            self.geometry
                .elastic_tangent(&law, (&geometric).into(), [0.0; 2], &moment_by);
        let lever = [hat(&first.lever), hat(&second.lever)];
        let force_hat = hat(&geometric);
        let [force, mut first_moment, mut second_moment] = sensitivities(&about_points);
        first_moment = first_moment.plus(&force.led_by(&-lever[0]));
        second_moment = second_moment.plus(&force.led_by(&lever[1]));
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
        let change = geometric - self.elastic.force;
        let levers = [&first.lever, &second.lever].map(Vec3::from);
        let moments = self.geometry.moments_by_force(levers, (&change).into());
        tangent.turn_with(moments.map(Vector3::from));
        if stiffness.damping > 0.0 && rates.velocity > 0.0 {
            self.add_damping(stiffness, first, second, rates, &mut tangent);
        }
        tangent
    }

    /// Adds the derivatives of the damping stress.
    fn add_damping(
        &self,
        stiffness: &ConnectorStiffness,
        first: &Side,
        second: &Side,
        weights: &RateWeights,
        tangent: &mut PairTangent,
    ) {
        let law = law_of(stiffness, stiffness.axial);
        let by = match &stiffness.general {
            None => self.geometry.round_damping_by(&law, &self.rates),
            Some(general) => {
                let each = stiffness.turned_stiffness(general, [first, second]);
                let d = Vector3::from(self.rates.bend);
                let turned = each.map(|own| (own * hat(&d) - hat(&(own * d))) * 0.5);
                let by_rate = (each[0] + each[1]) * 0.5;
                ((&by_rate).into(), turned.map(|by| Mat3::from(&by)))
            }
        };
        let mut damping = PairTangents::zeros(());
        self.geometry.add_damping_tangent(
            &law,
            [&first.lever, &second.lever].map(Vec3::from),
            &self.rates,
            (&self.damping.force).into(),
            &by,
            &PairWeights {
                velocity: weights.velocity,
                rotation: [&weights.rotation[0], &weights.rotation[1]].map(Mat3::from),
            },
            &mut damping,
        );
        let [force, first_moment, second_moment] = sensitivities(&damping);
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
        let (extension, across) = self.geometry.predicted(
            [&first.lever, &second.lever].map(Vec3::from),
            (&(second_move.0 - first_move.0)).into(),
            [first_move.1.into(), second_move.1.into()],
        );
        Prediction {
            extension,
            across: across.into(),
        }
    }

    /// Elastic energy [J].
    ///
    /// Source: docs/theory/dem.md, eq. (5); docs/theory/sections.md, eq. (5).
    pub fn energy(&self, stiffness: &ConnectorStiffness, first: &Side, second: &Side) -> f64 {
        if let Some(law) = &stiffness.general {
            let twist = self.twist - law.rest_twist;
            let bend = Bend::new(first, second, self.twist).change(law);
            return 0.5 * stiffness.shear * self.geometry.across().norm_squared()
                + stiffness.axial_energy(self.geometry.extension())
                + law.bending.at(bend).energy
                + 0.5 * stiffness.torsion * twist * twist;
        }
        let law = law_of(stiffness, stiffness.axial);
        self.geometry.round_energy(&law, self.twist)
    }

    /// Power of the damping stress on the two frames, negative [W].
    pub fn damping_power(&self) -> f64 {
        let gap_rate = Vector3::from(self.rates.gap);
        let bend_rate = Vector3::from(self.rates.bend);
        -(self.damping.force.dot(&gap_rate) + self.damping.moment.dot(&bend_rate))
    }
}

/// Derivatives of the force and of the first and the second moment.
fn sensitivities(tangents: &PairTangents<f64>) -> [Sensitivity; 3] {
    [&tangents.force, &tangents.moment[0], &tangents.moment[1]].map(|derivative| Sensitivity {
        translation: derivative.translation.into(),
        first_rotation: derivative.rotation[0].into(),
        second_rotation: derivative.rotation[1].into(),
    })
}
