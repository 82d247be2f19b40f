//! `[environment]`: water, current and seabed.

use crate::file::define::table;
use crate::file::dimension::{
    Acceleration, Angle, ContactDamping, ContactStiffness, Density, Dimensionless, Length, Speed,
    Time,
};
use crate::file::node::NodeValue;
use crate::file::quantity::{NonNegative, Positive, Real};

table! {
    /// The sea around the system, or air, or nothing.
    pub(super) struct EnvironmentTable {
        /// Acceleration of gravity; 0 for a system in space.
        gravity: NonNegative<Acceleration> = "9.80665 m/s^2",
        /// The water; without this table there is none: no buoyancy, no drag, no added mass, no
        /// pressure, and no surface.
        water: Option<WaterTable>,
        /// The current; without it the water is still.
        current: CurrentTable = NodeValue::empty_table(),
        /// Contact with a flat seabed at the water's depth; without this table lines may pass
        /// through the bottom.
        seabed: Option<SeabedTable>,
    }
}

table! {
    /// The water.
    pub(super) struct WaterTable {
        /// Density of the water.
        density: Positive<Density> = "1025 kg/m^3",
        /// Depth of the water below the mean surface.
        depth: Positive<Length>,
    }
}

table! {
    /// Horizontal current: a profile over depth, times a factor over time.
    pub(super) struct CurrentTable {
        /// Direction towards which the water flows, from +x towards +y, at the points of the
        /// profile that give none.
        heading: Real<Angle> = "0 deg",
        /// Points by increasing depth; linear between them (each component of the velocity),
        /// constant above the first and below the last.
        profile: Option<Vec<CurrentPointTable>>,
        /// Factor on the whole profile over time; linear between entries, constant outside. Two
        /// entries at one time are a step.
        factor: Option<Vec<FactorTable>>,
    }
}

table! {
    /// One point of a current profile.
    pub(super) struct CurrentPointTable {
        /// Depth below the mean surface, positive down.
        depth: NonNegative<Length>,
        /// Speed of the water; negative flows the other way.
        speed: Real<Speed>,
        /// Direction towards which the water flows at this depth; absent: that of the profile.
        heading: Option<Real<Angle>>,
    }
}

table! {
    /// The factor on a current or a load at one time.
    pub(super) struct FactorTable {
        /// Time.
        time: NonNegative<Time>,
        /// Factor on the profile or the load.
        factor: Real<Dimensionless>,
    }
}

table! {
    /// A flat seabed with a linear spring, damper and Coulomb friction per metre of line.
    pub(super) struct SeabedTable {
        /// Whether the seabed acts; `false` lets a load case leave it out.
        contact: bool = true,
        /// Normal stiffness per metre of line and metre of penetration.
        normal_stiffness: Positive<ContactStiffness> = "10 kPa",
        /// Normal damping per metre of line.
        normal_damping: NonNegative<ContactDamping> = "1 kN s/m^2",
        /// Coulomb friction coefficient, the same in every horizontal direction.
        friction: NonNegative<Dimensionless> = 0.5,
        /// Sliding speed at which friction is fully developed; below it friction grows in
        /// proportion to the speed.
        friction_speed: Positive<Speed> = "0.05 m/s",
    }
}
