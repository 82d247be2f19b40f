//! Inertia and loads of one node: that of half of each element beside it.
//!
//! Source: docs/theory/lumped.md, eqs. (18) to (22).

use catenix_model::LineType;
use catenix_numerics::{Matrix3, Vector3};

use crate::contact::seabed::{self, Contact};
use crate::hydro::morison::{self, DragCoefficients, PointDrag};
use crate::hydro::submergence::Submergence;
use crate::system::frames::{LoadPowers, Sea};

/// Properties of a node.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct NodeProperties {
    /// Half of the unstretched lengths beside the node [m].
    pub length: f64,
    /// Diameter, for the passage through the surface [m].
    pub diameter: f64,
    /// Mass of the structure [kg].
    pub mass: f64,
    /// Weight in air [N].
    pub weight: f64,
    /// Buoyancy, fully under water [N].
    pub buoyancy: f64,
    /// Drag, fully under water.
    pub drag: DragCoefficients,
    /// Added mass across the line, fully under water [kg].
    pub added_normal: f64,
    /// Added mass along the line [kg].
    pub added_axial: f64,
}

impl NodeProperties {
    /// Adds half of an element of `length`.
    ///
    /// Source: docs/theory/lumped.md, eq. (18).
    pub fn add_half(&mut self, line_type: &LineType, length: f64, water: f64, gravity: f64) {
        let half = 0.5 * length;
        let area = 0.25 * std::f64::consts::PI * line_type.outer_diameter.powi(2);
        let displaced = water * area * half;
        let flow = 0.5 * water * line_type.outer_diameter * half;
        self.length += half;
        self.diameter = self.diameter.max(line_type.outer_diameter);
        self.mass += line_type.mass * half;
        self.weight += line_type.mass * half * gravity;
        self.buoyancy += displaced * gravity;
        self.drag.normal += line_type.normal_drag * flow;
        self.drag.axial += line_type.axial_drag * flow * std::f64::consts::PI;
        self.added_normal += line_type.normal_added_mass * displaced;
        self.added_axial += line_type.axial_added_mass * displaced;
    }
}

/// Motion of a node, global.
#[derive(Debug, Clone, Copy)]
pub(super) struct NodeMotion {
    pub position: Vector3,
    pub velocity: Vector3,
    pub acceleration: Vector3,
    /// From the node before to the node after (3) [m].
    pub chord: Vector3,
}

/// Derivatives of [`NodeLoad::force`].
#[derive(Debug, Clone, Copy)]
pub(super) struct NodeTangent {
    pub position: Matrix3,
    pub chord: Matrix3,
    pub velocity: Matrix3,
    pub acceleration: Matrix3,
}

/// A node in the water, on the way to its force.
pub(super) struct NodeLoad {
    axis: Vector3,
    chord: f64,
    wet: Submergence,
    current_slope: Vector3,
    water: PointDrag<f64>,
    drag: Vector3,
    added: Matrix3,
    contact: Option<Contact>,
}

impl NodeLoad {
    /// Source: docs/theory/lumped.md, eqs. (19) to (21).
    #[inline]
    pub fn new(node: &NodeProperties, m: &NodeMotion, sea: &Sea<'_>) -> NodeLoad {
        let chord = m.chord.norm();
        let axis = m.chord / chord;
        let wet = Submergence::new(m.position.z, axis.z, node.length, node.diameter);
        let (water, current_slope) = sea.current.at(m.position.z, sea.current_factor);
        let relative = (&(water - m.velocity)).into();
        let coefficients = [node.drag.normal, node.drag.axial];
        let water = PointDrag::new(coefficients, (&axis).into(), relative);
        let height = m.position.z + sea.depth;
        NodeLoad {
            axis,
            chord,
            wet,
            current_slope,
            drag: water.force().into(),
            water,
            added: morison::added_mass(&axis, node.added_normal, node.added_axial),
            contact: sea
                .seabed
                .and_then(|bed| seabed::contact(bed, node.length, height, &m.velocity)),
        }
    }

    /// Mass with the added mass of what is under water (3 x 3) [kg].
    #[inline]
    pub fn mass(&self, node: &NodeProperties, in_water: bool) -> Matrix3 {
        let share = if in_water { self.wet.share } else { 0.0 };
        Matrix3::identity() * node.mass + self.added * share
    }

    /// Inertia minus loads (3) [N].
    #[inline]
    pub fn force(&self, node: &NodeProperties, m: &NodeMotion) -> Vector3 {
        let share = self.wet.share;
        let mut force = m.acceleration * node.mass
            + (self.added * m.acceleration - self.drag) * share
            - Vector3::z() * (node.buoyancy * share - node.weight);
        if let Some(contact) = &self.contact {
            force -= contact.force;
        }
        force
    }

    /// Exact derivatives of [`Self::force`].
    ///
    /// Source: docs/theory/lumped.md, eq. (22).
    pub fn tangent(&self, node: &NodeProperties, m: &NodeMotion) -> NodeTangent {
        let share = self.wet.share;
        // By the axis, nothing along it.
        let [by_velocity, drag_by_axis] = self.water.derivatives().map(Matrix3::from);
        let up = Vector3::z().transpose();
        let along = self.axis.dot(&m.acceleration);
        let turned = Matrix3::identity() * along + self.axis * m.acceleration.transpose();
        let mut by_axis = (turned * (node.added_axial - node.added_normal) - drag_by_axis) * share;
        let mut position = by_velocity * self.current_slope * up * -share;
        let mut velocity = by_velocity * share;
        if self.wet.by_height != 0.0 {
            let wetted = self.added * m.acceleration - self.drag - Vector3::z() * node.buoyancy;
            position += wetted * up * self.wet.by_height;
            by_axis += wetted * up * self.wet.by_slope;
        }
        if let Some(contact) = &self.contact {
            position -= contact.by_height * up;
            velocity -= contact.by_velocity;
        }
        let across = Matrix3::identity() - self.axis * self.axis.transpose();
        NodeTangent {
            position,
            chord: by_axis * across / self.chord,
            velocity,
            acceleration: self.mass(node, true),
        }
    }

    /// Kinetic, gravity and contact energy and the powers of the loads.
    pub fn energy(
        &self,
        node: &NodeProperties,
        m: &NodeMotion,
        sea: &Sea<'_>,
    ) -> (f64, f64, LoadPowers) {
        let share = self.wet.share;
        let mut potential = node.weight * m.position.z;
        let mut powers = LoadPowers {
            drag: share * self.drag.dot(&m.velocity),
            added_mass: -share * m.velocity.dot(&(self.added * m.acceleration)),
            buoyancy: share * node.buoyancy * m.velocity.z,
            seabed_damping: 0.0,
        };
        if let (Some(contact), Some(bed)) = (&self.contact, sea.seabed) {
            let height = m.position.z + sea.depth;
            let still = seabed::contact(bed, node.length, height, &Vector3::zeros());
            let spring = still.map_or_else(Vector3::zeros, |still| still.force);
            potential += contact.energy;
            powers.seabed_damping = (contact.force - spring).dot(&m.velocity);
        }
        let kinetic = 0.5 * node.mass * m.velocity.norm_squared();
        (kinetic, potential, powers)
    }

    /// Share of the node under water, 0 to 1.
    pub fn share(&self) -> f64 {
        self.wet.share
    }
}
