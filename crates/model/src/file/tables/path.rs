//! `[path]`: static path following.

use crate::file::define::table;
use crate::file::dimension::{AnyMeasure, Dimensionless};
use crate::file::quantity::{Positive, Real};
use crate::file::read::{Count, Pair, Text};

table! {
    /// The equilibrium path of the system as loads are scaled by one factor, beyond limit points
    /// and buckling. Lengths of steps are fractions of a scale in which the whole range of the
    /// factor, a motion of all elements by the longest line's length, and a turn of all by 1 rad
    /// count 1 each.
    pub(super) struct PathTable {
        /// Loads that the factor scales, whatever their variation over time; absent: all.
        loads: Option<Vec<Text>>,
        /// Factor of the first point, which is found as in statics.
        start: Real<Dimensionless> = 0,
        /// The path ends where the factor leaves this range; it starts towards the end that is
        /// further away.
        range: Pair<Real<Dimensionless>>,
        /// Factors at which the path has a point.
        at: Option<Vec<Real<Dimensionless>>>,
        /// Ends the path where a channel leaves its range.
        stop: Option<PathStopTable>,
        /// Most points.
        max_points: Count = 200,
        /// Length of the first step.
        first_step: Positive<Dimensionless> = 0.02,
        /// Length of the largest step.
        max_step: Positive<Dimensionless> = 0.1,
        /// Largest residual force at any element, as a fraction of the system's reference force.
        tolerance: Positive<Dimensionless> = 1e-8,
        /// Most Newton iterations per point before the step is cut.
        max_iterations: Count = 12,
    }
}

table! {
    /// A channel that ends the path when it leaves its range.
    pub(super) struct PathStopTable {
        /// The channel, for example `beam.z@10 m`.
        channel: Text,
        /// Its range.
        range: Pair<Real<AnyMeasure>>,
    }
}
