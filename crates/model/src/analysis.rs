//! Settings of the analyses.

/// How lines become unknowns.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum FormulationKind {
    /// Discrete elements: rigid elements, joined by springs of six components.
    Dem,
    /// Finite elements: corotational beams of two nodes.
    Fem,
    /// Finite elements: geometrically exact beams of two nodes.
    FemExact,
    /// Lumped masses, joined by axial springs, with bending over three nodes; no torsion.
    Lumped,
}

impl FormulationKind {
    /// All of them.
    pub const ALL: [FormulationKind; 4] = [
        FormulationKind::Dem,
        FormulationKind::Fem,
        FormulationKind::FemExact,
        FormulationKind::Lumped,
    ];

    /// The word in the model file.
    pub fn word(self) -> &'static str {
        match self {
            FormulationKind::Dem => "dem",
            FormulationKind::Fem => "fem",
            FormulationKind::FemExact => "fem-exact",
            FormulationKind::Lumped => "lumped",
        }
    }

    /// Whether its lines resist being twisted, so that torque and rotations about the line exist.
    pub fn has_torsion(self) -> bool {
        self != FormulationKind::Lumped
    }

    /// Whether every point has a mass for itself, which explicit integrators need.
    pub fn has_point_masses(self) -> bool {
        self == FormulationKind::Lumped
    }
}

/// How static equilibrium is sought.
#[derive(Debug, Clone, PartialEq)]
pub struct StaticsSettings {
    /// Whether an equilibrium is sought; if not, the motion starts at rest from the first shape.
    pub equilibrium: bool,
    /// Whether the current acts in the static equilibrium.
    pub current: bool,
    /// Largest residual force at any element, as a fraction of the system's reference force [-].
    pub tolerance: f64,
    /// Most iterations before giving up.
    pub max_iterations: usize,
}

/// Which natural modes are sought.
#[derive(Debug, Clone, PartialEq)]
pub struct ModeSettings {
    /// Which of them.
    pub range: ModeRange,
    /// Whether the structure moves its added mass along: modes in water, not in air.
    pub added_mass: bool,
}

/// Which natural modes are sought: so many, or all in a band.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ModeRange {
    /// The lowest ones, this many.
    Lowest(usize),
    /// All between two frequencies.
    Band {
        /// Lower end [Hz].
        from_hz: f64,
        /// Upper end [Hz].
        to_hz: f64,
    },
}

/// How the motion is integrated.
#[derive(Debug, Clone, PartialEq)]
pub struct DynamicsSettings {
    /// Simulated time [s].
    pub duration: f64,
    /// Step size.
    pub step: StepControl,
    /// Method of integration.
    pub integrator: IntegratorSettings,
    /// Largest residual force at any element, as a fraction of the system's reference force [-].
    pub tolerance: f64,
    /// Most Newton iterations per step before the step is cut.
    pub max_iterations: usize,
    /// Length of the window at the end over which means and extremes are reported [s].
    pub statistics_window: f64,
}

/// Method of integration in time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum IntegratorSettings {
    /// Generalised-alpha, of second order.
    GeneralisedAlpha {
        /// Spectral radius at infinite frequency, 0 to 1 [-].
        spectral_radius: f64,
    },
    /// Backward differentiation (Gear's method).
    Bdf {
        /// Highest order, 1 to 5.
        max_order: usize,
    },
    /// Central differences in as many steps as stability needs; of lumped mass only.
    Explicit,
}

impl IntegratorSettings {
    /// The word in the model file.
    pub fn word(&self) -> &'static str {
        match self {
            IntegratorSettings::GeneralisedAlpha { .. } => "generalised-alpha",
            IntegratorSettings::Bdf { .. } => "bdf",
            IntegratorSettings::Explicit => "explicit",
        }
    }
}

/// Choice of the time step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StepControl {
    /// Constant step [s] (shortened only to end where loads jump, or cut when Newton fails).
    Fixed(f64),
    /// Step chosen so that the local error of one step stays below `accuracy` (a fraction of the
    /// reference length of the system), between `min` and `max` [s].
    Adaptive {
        /// Relative local error allowed per step [-].
        accuracy: f64,
        /// Smallest step [s].
        min: f64,
        /// Largest step [s].
        max: f64,
    },
}
