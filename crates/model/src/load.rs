//! Forces and moments on points of lines and bodies.

/// A force and a moment on a point, with their variation over time.
#[derive(Debug, Clone, PartialEq)]
pub struct PointLoad {
    /// Name in the model file.
    pub name: String,
    /// Where it acts.
    pub place: LoadPlace,
    /// Force (3) [N]: global, or in local axes when it follows.
    pub force: [f64; 3],
    /// Moment (3) [N m]: global, or in local axes when it follows.
    pub moment: [f64; 3],
    /// Whether it turns with the element or body. Local axes are those of the body; of an element,
    /// in the first shape: x along the line from A to B, y horizontal (global y where the line is
    /// vertical), z = x x y.
    pub follows: bool,
    /// Factor over time.
    pub variation: LoadVariation,
}

/// What a load acts on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LoadPlace {
    /// A point of a line.
    Line {
        /// Index into [`crate::Model::lines`].
        line: usize,
        /// Unstretched distance from end A [m].
        arc_length: f64,
    },
    /// A point of a body.
    Body {
        /// Index into [`crate::Model::bodies`].
        body: usize,
        /// The point in the body's local axes (3) [m].
        point_local: [f64; 3],
    },
}

/// Factor on a load over time.
#[derive(Debug, Clone, PartialEq)]
pub enum LoadVariation {
    /// Always 1.
    Constant,
    /// s(t) sin(w t + phase), with s the quintic smooth step from 0 to 1 over `ramp`.
    Harmonic {
        /// Angular frequency w [rad/s].
        angular_frequency: f64,
        /// Phase [rad].
        phase: f64,
        /// Time over which the load is raised [s]; 0 is at once.
        ramp: f64,
    },
    /// (time [s], factor [-]) by non-decreasing time, at least one: linear between, constant
    /// outside; two entries at one time are a step, the later one holding from that time on.
    Table(Vec<(f64, f64)>),
}
