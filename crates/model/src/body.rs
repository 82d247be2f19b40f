//! Free bodies and bodies with prescribed motion.

use crate::motion::Motion;

/// A free rigid body: buffer, pump, miner, clump weight, buoy, or the connection of several lines.
///
/// Local axes are parallel to the global axes in the body's reference orientation, with the origin
/// at the centre of mass; the body is round about its local z axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    /// Name in the model file.
    pub name: String,
    /// Mass [kg], positive.
    pub mass: f64,
    /// Moments of inertia about the local x, y, z axes through the centre of mass (3) [kg m2].
    pub inertia: [f64; 3],
    /// Displaced volume [m3].
    pub volume: f64,
    /// Centre of buoyancy in local axes (3) [m].
    pub centre_of_buoyancy: [f64; 3],
    /// Length along local z, for the drag and added mass against rotation about x and y [m].
    pub length: f64,
    /// Drag coefficient times area across the local z axis [m2].
    pub normal_drag_area: f64,
    /// Drag coefficient times area along the local z axis [m2].
    pub axial_drag_area: f64,
    /// Added mass across the local z axis [kg].
    pub normal_added_mass: f64,
    /// Added mass along the local z axis [kg].
    pub axial_added_mass: f64,
    /// Where to start looking for the static position of the origin, global (3) [m]; `None`: found
    /// from the lines.
    pub initial_position: Option<[f64; 3]>,
    /// Vessel against which offsets of this body are reported; `None`: no vessel in the model.
    pub offset_vessel: Option<usize>,
}

/// A body whose motion is prescribed: ship, towed miner, or an anchor when it does not move.
#[derive(Debug, Clone, PartialEq)]
pub struct Vessel {
    /// Name in the model file.
    pub name: String,
    /// Position of the origin at rest, global (3) [m].
    pub position: [f64; 3],
    /// Heading at rest: rotation about global z from global x to local x [rad].
    pub heading: f64,
    /// Motions, added together; empty for an anchor.
    pub motions: Vec<Motion>,
    /// What it looks like in pictures; nothing is computed from it.
    pub appearance: Appearance,
}

/// What a vessel looks like in pictures, as far as the model file says.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Appearance {
    /// What kind of thing it is.
    pub shape: Option<VesselShape>,
    /// Length from end to end [m].
    pub length: Option<f64>,
}

/// Kinds of vessels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VesselShape {
    /// A ship with a derrick amidships.
    Ship,
    /// A semi-submersible platform.
    Platform,
    /// A buoy.
    Buoy,
    /// A vehicle on the seabed.
    Crawler,
    /// A fixed point.
    Anchor,
}

impl VesselShape {
    /// Its name in files.
    pub fn word(self) -> &'static str {
        match self {
            VesselShape::Ship => "ship",
            VesselShape::Platform => "platform",
            VesselShape::Buoy => "buoy",
            VesselShape::Crawler => "crawler",
            VesselShape::Anchor => "anchor",
        }
    }
}
