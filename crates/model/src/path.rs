//! Settings of static path following.

use crate::Channel;

/// The equilibrium path of the system as chosen loads are scaled by one factor.
#[derive(Debug, Clone, PartialEq)]
pub struct PathSettings {
    /// Loads that the factor scales: indices into [`crate::Model::loads`], at least one.
    pub loads: Vec<usize>,
    /// Factor of the first point.
    pub start: f64,
    /// The path ends where the factor leaves this range, which contains `start`.
    pub range: [f64; 2],
    /// Factors within the range at which the path has a point, increasing.
    pub at: Vec<f64>,
    /// What else ends the path.
    pub stop: Option<PathStop>,
    /// Most points.
    pub max_points: usize,
    /// First step, as a fraction of the path's scale [-].
    pub first_step: f64,
    /// Largest step, as a fraction of the path's scale [-].
    pub max_step: f64,
    /// Largest residual force at any element, as a fraction of the system's reference force [-].
    pub tolerance: f64,
    /// Most Newton iterations per point before the step is cut.
    pub max_iterations: usize,
}

/// A channel that ends the path when it leaves its range.
#[derive(Debug, Clone, PartialEq)]
pub struct PathStop {
    /// The channel.
    pub channel: Channel,
    /// Its range, in the channel's unit.
    pub range: [f64; 2],
}
