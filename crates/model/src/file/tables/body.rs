//! `[bodies.*]`, `[vessels.*]` and `[anchors.*]`.

use crate::file::define::{choice, table};
use crate::file::dimension::{Angle, Area, Force, Length, Mass, MassMoment, Volume};
use crate::file::quantity::{NonNegative, Positive, Real};
use crate::file::read::{Text, Vector};

table! {
    /// A free rigid body: buffer, pump, clump weight, buoy, or the connection of several lines. It
    /// is round about its local z axis, with the origin at the centre of mass. Exactly one of
    /// `volume`, `net_lift` and `wet_weight` is given.
    pub(super) struct BodyTable {
        /// Mass.
        mass: Positive<Mass>,
        /// Displaced volume.
        volume: Option<NonNegative<Volume>>,
        /// Buoyancy less weight.
        net_lift: Option<Real<Force>>,
        /// Weight less buoyancy.
        wet_weight: Option<Real<Force>>,
        /// Length along local z, for drag and added mass against rotation; 0 for a compact body.
        length: NonNegative<Length> = "0 m",
        /// Moments of inertia about the local axes through the centre of mass. Absent: those of a
        /// solid cylinder of the body's length and volume, or of a solid sphere of its volume when
        /// it has no length (the volume that steel of its mass has, if it displaces less).
        inertia: Option<Vector<Positive<MassMoment>>>,
        /// Centre of buoyancy in local axes.
        centre_of_buoyancy: Vector<Real<Length>> = [0, 0, 0],
        /// Drag coefficient times area in all directions, where the next two keys give none.
        drag_area: NonNegative<Area> = "0 m^2",
        /// Drag coefficient times area across the local z axis; absent: `drag_area`.
        normal_drag_area: Option<NonNegative<Area>>,
        /// Drag coefficient times area along the local z axis; absent: `drag_area`.
        axial_drag_area: Option<NonNegative<Area>>,
        /// Added mass in all directions, where the next two keys give none.
        added_mass: NonNegative<Mass> = "0 kg",
        /// Added mass across the local z axis; absent: `added_mass`.
        normal_added_mass: Option<NonNegative<Mass>>,
        /// Added mass along the local z axis; absent: `added_mass`.
        axial_added_mass: Option<NonNegative<Mass>>,
        /// Where to start looking for the static position of the origin, in global axes; absent:
        /// found from the lines.
        initial_position: Option<Vector<Real<Length>>>,
        /// Vessel or anchor against which offsets of this body are reported; absent: the first of
        /// `vessels`, if there is one.
        offset_from: Option<Text>,
    }
}

table! {
    /// A body whose motion is prescribed: ship or towed miner.
    pub(super) struct VesselTable {
        /// Position of the origin at rest, in global axes: z is up, 0 at the mean surface.
        position: Vector<Real<Length>>,
        /// Heading at rest: rotation about global z from global x to local x.
        heading: Real<Angle> = "0 deg",
        /// Names from `motions`, added together; absent: it stays where it is.
        motions: Option<Vec<Text>>,
        /// What it looks like in the viewer; absent: a ship, or a crawler where it lies in the
        /// lower half of the water. Nothing is computed from it.
        shape: Option<ShapeChoice>,
        /// Length from end to end, for the viewer; absent: a usual one. Nothing is computed from it.
        length: Option<Positive<Length>>,
    }
}

choice! {
    /// Shapes of vessels in the viewer, bow towards local x, waterline at the origin.
    pub(super) enum ShapeChoice {
        /// A ship with a derrick over the origin.
        Ship = "ship",
        /// A semi-submersible platform.
        Platform = "platform",
        /// A buoy.
        Buoy = "buoy",
        /// A vehicle on the seabed.
        Crawler = "crawler",
    }
}

table! {
    /// A fixed point to which lines are connected.
    pub(super) struct AnchorTable {
        /// Position, in global axes: z is up, 0 at the mean surface.
        position: Vector<Real<Length>>,
    }
}
