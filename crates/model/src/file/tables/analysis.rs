//! `formulation`, `[statics]`, `[modes]` and `[dynamics]`.

use crate::file::define::{choice, table};
use crate::file::dimension::{Dimensionless, Frequency, Time};
use crate::file::quantity::{NonNegative, Positive};
use crate::file::read::Count;

table! {
    /// How static equilibrium is sought.
    pub(super) struct StaticsTable {
        /// Whether an equilibrium is sought. With `false` the motion starts at rest from the first
        /// shape of the lines: a body that flies freely has no equilibrium.
        equilibrium: bool = true,
        /// Whether the current acts in the static equilibrium. With `false` it acts from t = 0 on.
        current: bool = true,
        /// Largest residual force at any element, as a fraction of the system's reference force.
        tolerance: Positive<Dimensionless> = 1e-7,
        /// Most iterations before giving up.
        max_iterations: Count = 10000,
    }
}

table! {
    /// Which natural modes `catenix modes` seeks: the lowest `count`, or all between `from` and
    /// `to`.
    pub(super) struct ModesTable {
        /// Number of modes, the lowest; absent: 10.
        count: Option<Count>,
        /// Lower end of a band of frequencies; absent, with `to`: 0.
        from: Option<NonNegative<Frequency>>,
        /// Upper end of a band of frequencies.
        to: Option<Positive<Frequency>>,
        /// Whether the structure moves its added mass along. With `false` the modes are those in
        /// air, about the same equilibrium.
        added_mass: bool = true,
    }
}

table! {
    /// How the motion is integrated. The step is chosen by its error; `step` fixes it instead.
    pub(super) struct DynamicsTable {
        /// Simulated time.
        duration: Positive<Time>,
        /// Method of integration. The first two are implicit; all reach the same answers. With the
        /// explicit one `step` or `max_step` only say how often results are looked at.
        integrator: IntegratorChoice = "generalised-alpha",
        /// Constant step; absent: the step is chosen so that its error stays below `accuracy`.
        step: Option<Positive<Time>>,
        /// Error allowed per step, as a fraction of the system's reference length; absent: 1e-4
        /// with generalised-alpha, else 2e-5.
        accuracy: Option<Positive<Dimensionless>>,
        /// Smallest step; absent: 1e-4 s.
        min_step: Option<Positive<Time>>,
        /// Largest step; absent: with generalised-alpha 1 s, or a twelfth of the shortest period of
        /// the harmonic motions if that is less, else 0.5 s.
        max_step: Option<Positive<Time>>,
        /// Of generalised-alpha: spectral radius at infinite frequency; 1 keeps, 0 removes what is
        /// too fast for the step; absent: 0.4.
        spectral_radius: Option<NonNegative<Dimensionless>>,
        /// Of bdf: the highest order, 1 to 5; absent: 2. From 3 on, oscillations that are hardly
        /// damped may grow.
        max_order: Option<Count>,
        /// Largest residual force at any element, as a fraction of the system's reference force. Ten
        /// times as much where steps control their error and what is left to move is a hundredth of
        /// it.
        tolerance: Positive<Dimensionless> = 1e-5,
        /// Most Newton iterations per step before the step is cut.
        max_iterations: Count = 12,
        /// Time at the end over which means and extremes are reported; absent: the longest period
        /// of the harmonic motions that act, or else the last 10 % of the duration.
        statistics_window: Option<Positive<Time>>,
    }
}

choice! {
    /// Formulations of lines.
    pub(super) enum FormulationChoice {
        /// Discrete elements: rigid elements, joined by springs of six components.
        Dem = "dem",
        /// Finite elements: corotational beams of two nodes.
        Fem = "fem",
        /// Finite elements: geometrically exact beams of two nodes.
        FemExact = "fem-exact",
        /// Lumped masses, joined by axial springs, with bending over three nodes; no torsion.
        Lumped = "lumped",
    }
}

choice! {
    /// Methods of integration in time.
    pub(super) enum IntegratorChoice {
        /// Second order, with a damping of what is too fast for the step that can be chosen.
        GeneralisedAlpha = "generalised-alpha",
        /// Backward differentiation, Gear's method.
        Bdf = "bdf",
        /// Central differences, in as many steps as stability needs; with lumped masses only.
        Explicit = "explicit",
    }
}
