//! Water, current and seabed.

/// The sea around the system.
#[derive(Debug, Clone, PartialEq)]
pub struct Environment {
    /// Gravity [m/s2].
    pub gravity: f64,
    /// The water; `None` for a system in air or space: nothing is ever wet.
    pub water: Option<Water>,
    /// The current.
    pub current: Current,
    /// Contact with the seabed; `None` leaves the seabed out (lines may pass through it).
    pub seabed: Option<Seabed>,
}

/// Water of one density under a mean surface at z = 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Water {
    /// Density [kg/m3].
    pub density: f64,
    /// Depth below the mean surface [m].
    pub depth: f64,
}

impl Environment {
    /// Density of what surrounds the system: the water's, or zero [kg/m3].
    pub fn fluid_density(&self) -> f64 {
        self.water.map_or(0.0, |water| water.density)
    }

    /// Height of a seabed that acts [m].
    pub fn seabed_height(&self) -> Option<f64> {
        self.seabed?;
        self.water.map(|water| -water.depth)
    }
}

/// Horizontal current: a profile over depth, times a factor over time.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Current {
    /// Profile, by increasing depth. Velocity is interpolated linearly between points (component
    /// by component) and held constant above the first and below the last. Empty: no current.
    pub profile: Vec<CurrentPoint>,
    /// Factor on the whole profile over time: (time [s], factor [-]), by non-decreasing time.
    /// Linear between entries, constant outside; two entries at one time are a step, the later
    /// one holding from that time on. Empty: 1.
    pub factor: Vec<(f64, f64)>,
}

/// One point of a current profile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurrentPoint {
    /// Depth below the mean surface, positive down [m].
    pub depth: f64,
    /// Velocity towards which the water flows, global x and y [m/s].
    pub velocity: [f64; 2],
}

/// A flat seabed at the water depth, with a linear spring, damper and Coulomb friction per metre
/// of line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seabed {
    /// Normal stiffness per metre of line and metre of penetration [N/m2].
    pub normal_stiffness: f64,
    /// Normal damping per metre of line [N s/m2].
    pub normal_damping: f64,
    /// Coulomb friction coefficient, the same in every horizontal direction [-].
    pub friction: f64,
    /// Sliding speed at which friction is fully developed (regularisation) [m/s].
    pub friction_speed: f64,
}
