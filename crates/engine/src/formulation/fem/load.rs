//! Weight, buoyancy, drag, added mass and seabed on a metre of line.
//!
//! Source: docs/theory/hydrodynamics.md, eqs. (2) to (8), per unit length.

use catenix_model::{LineType, Model};
use catenix_numerics::{Matrix3, Vector3};

use super::element::field::{LoadTangent, SpreadLoad, Station};
use crate::contact::seabed::{self, Contact};
use crate::hydro::morison::{self, DragCoefficients, PointDrag};
use crate::hydro::submergence::Submergence;
use crate::system::frames::{LoadPowers, Sea};

/// Properties of a line per unit length.
#[derive(Debug, Clone, Copy)]
pub(super) struct Spread {
    /// Mass with content [kg/m].
    pub mass: f64,
    /// Weight in air [N/m].
    pub weight: f64,
    /// Buoyancy under water [N/m].
    pub buoyancy: f64,
    /// Drag under water, force per length.
    pub drag: DragCoefficients,
    /// Added mass across and along the line, under water [kg/m].
    pub added_normal: f64,
    pub added_axial: f64,
    /// Outer diameter [m].
    pub diameter: f64,
}

impl Spread {
    pub fn new(model: &Model, line_type: &LineType) -> Spread {
        let water = model.environment.fluid_density();
        let displaced = water * 0.25 * std::f64::consts::PI * line_type.outer_diameter.powi(2);
        let flow = 0.5 * water * line_type.outer_diameter;
        Spread {
            mass: line_type.mass,
            weight: line_type.mass * model.environment.gravity,
            buoyancy: displaced * model.environment.gravity,
            drag: DragCoefficients {
                normal: line_type.normal_drag * flow,
                axial: line_type.axial_drag * flow * std::f64::consts::PI,
                radius: 0.0,
            },
            added_normal: line_type.normal_added_mass * displaced,
            added_axial: line_type.axial_added_mass * displaced,
            diameter: line_type.outer_diameter,
        }
    }

    /// Weight and full buoyancy (3) [N/m].
    pub fn uniform(&self) -> Vector3 {
        Vector3::z() * (self.buoyancy - self.weight)
    }

    fn submergence(&self, s: &Station) -> Submergence {
        Submergence::new(s.position.z, s.axis.z, s.length, self.diameter)
    }

    /// Added mass at a station [kg/m].
    pub fn added_mass(&self, s: &Station) -> Matrix3 {
        let share = self.submergence(s).share;
        morison::added_mass(&s.axis, self.added_normal, self.added_axial) * share
    }
}

/// The sea on a line.
#[derive(Clone, Copy)]
pub(super) struct SeaLoad<'a> {
    pub spread: &'a Spread,
    pub sea: &'a Sea<'a>,
}

/// What of the load is common to its value and its derivatives.
struct Parts {
    wet: Submergence,
    water: PointDrag<f64>,
    current_slope: Vector3,
    drag: Vector3,
    added: Matrix3,
    contact: Option<Contact>,
}

impl SeaLoad<'_> {
    #[inline]
    fn parts(&self, s: &Station) -> Parts {
        let spread = self.spread;
        let (water, current_slope) = self.sea.current.at(s.position.z, self.sea.current_factor);
        let coefficients = [spread.drag.normal, spread.drag.axial];
        let relative = (&(water - s.velocity)).into();
        let water = PointDrag::new(coefficients, (&s.axis).into(), relative);
        let height = s.position.z + self.sea.depth;
        Parts {
            wet: spread.submergence(s),
            drag: water.force().into(),
            water,
            current_slope,
            added: morison::added_mass(&s.axis, spread.added_normal, spread.added_axial),
            contact: self
                .sea
                .seabed
                .and_then(|seabed| seabed::contact(seabed, 1.0, height, &s.velocity)),
        }
    }

    #[inline]
    fn sum(&self, s: &Station, parts: &Parts) -> Vector3 {
        let spread = self.spread;
        let share = parts.wet.share;
        // Weight and full buoyancy are a uniform load; here is what the surface takes off.
        let lift = Vector3::z() * (spread.buoyancy * (share - 1.0));
        let water = (parts.drag - parts.added * s.acceleration) * share;
        let contact = parts
            .contact
            .as_ref()
            .map_or_else(Vector3::zeros, |c| c.force);
        water + lift + contact
    }

    /// Energy of the seabed's springs per length [J/m], and the powers per length [W/m].
    pub fn energy(&self, s: &Station) -> (f64, LoadPowers) {
        let parts = self.parts(s);
        let share = parts.wet.share;
        let mut powers = LoadPowers {
            drag: share * parts.drag.dot(&s.velocity),
            added_mass: -share * s.velocity.dot(&(parts.added * s.acceleration)),
            buoyancy: (share - 1.0) * self.spread.buoyancy * s.velocity.z,
            seabed_damping: 0.0,
        };
        let mut energy = 0.0;
        if let (Some(seabed), Some(contact)) = (self.sea.seabed, &parts.contact) {
            let height = s.position.z + self.sea.depth;
            let still = seabed::contact(seabed, 1.0, height, &Vector3::zeros());
            let spring = still.map_or_else(Vector3::zeros, |contact| contact.force);
            energy = contact.energy;
            powers.seabed_damping = (contact.force - spring).dot(&s.velocity);
        }
        (energy, powers)
    }
}

impl SpreadLoad for SeaLoad<'_> {
    #[inline]
    fn force(&self, s: &Station) -> Vector3 {
        self.sum(s, &self.parts(s))
    }

    fn linearised(&self, s: &Station) -> (Vector3, LoadTangent) {
        let spread = self.spread;
        let parts = self.parts(s);
        let share = parts.wet.share;
        let [drag_by_velocity, drag_by_axis] = parts.water.derivatives().map(Matrix3::from);
        let difference = spread.added_axial - spread.added_normal;
        let along = s.axis.dot(&s.acceleration);
        let mut by_height = drag_by_velocity * parts.current_slope * share;
        let mut by_axis = drag_by_axis * share;
        if difference != 0.0 {
            by_axis -= (Matrix3::identity() * along + s.axis * s.acceleration.transpose())
                * (difference * share);
        }
        if parts.wet.by_height != 0.0 {
            let whole = parts.drag - parts.added * s.acceleration + Vector3::z() * spread.buoyancy;
            by_height += whole * parts.wet.by_height;
            by_axis += whole * Vector3::z().transpose() * parts.wet.by_slope;
        }
        let mut by_velocity = drag_by_velocity * -share;
        if let Some(contact) = &parts.contact {
            by_height += contact.by_height;
            by_velocity += contact.by_velocity;
        }
        let tangent = LoadTangent {
            position: by_height * Vector3::z().transpose(),
            axis: by_axis,
            velocity: by_velocity,
            acceleration: parts.added * -share,
        };
        (self.sum(s, &parts), tangent)
    }
}
