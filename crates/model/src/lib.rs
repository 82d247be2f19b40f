//! What the user wrote: the TOML model file, its units and diagnostics, and the validated [`Model`].
//!
//! The file is parsed, resolved and validated once ([`mod@file`]); everything after that sees only the
//! immutable types of this crate, in SI units and radians, axes x, y horizontal and z up with the
//! origin in the mean sea surface. Names are kept for messages and results; cross references are
//! indices, so that nothing downstream can meet a name that does not exist.

mod analysis;
mod body;
mod environment;
pub mod file;
mod line;
mod load;
mod motion;
mod output;
mod path;

pub use analysis::{
    DynamicsSettings, FormulationKind, IntegratorSettings, ModeRange, ModeSettings,
    StaticsSettings, StepControl,
};
pub use body::{Appearance, Body, Vessel, VesselShape};
pub use environment::{Current, CurrentPoint, Environment, Seabed, Water};
pub use line::{
    Attachment, EndConnection, Joint, Line, LineEnd, LineType, NaturalShape, PipeWall, Section,
    SupportRef,
};
pub use load::{LoadPlace, LoadVariation, PointLoad};
pub use motion::{Degree, Motion, TowLeg};
pub use output::{
    Angle, Axis, Channel, ChannelTarget, Figure, LineQuantity, OutputSettings, Reference,
    Statistic, all_channels,
};
pub use path::{PathSettings, PathStop};

/// One system in one environment with its motions: a load case, ready to be assembled.
///
/// Everything is SI, every index is valid: [`file::read_study`] guarantees it.
#[derive(Debug, Clone, PartialEq)]
pub struct Model {
    /// Title of the model file.
    pub title: String,
    /// How lines become unknowns.
    pub formulation: FormulationKind,
    /// Water, current and seabed.
    pub environment: Environment,
    /// Cross sections that the lines' sections refer to by index.
    pub line_types: Vec<LineType>,
    /// Pipes, hoses, cables and moorings.
    pub lines: Vec<Line>,
    /// Free rigid bodies.
    pub bodies: Vec<Body>,
    /// Bodies with prescribed motion, anchors (no motion) included.
    pub vessels: Vec<Vessel>,
    /// Forces and moments on points of lines and bodies.
    pub loads: Vec<PointLoad>,
    /// How static equilibrium is sought.
    pub statics: StaticsSettings,
    /// Which natural modes are sought, where the caller does not say.
    pub modes: ModeSettings,
    /// How the motion is integrated; `None` when the file describes statics only.
    pub dynamics: Option<DynamicsSettings>,
    /// Which equilibrium path is followed; `None` when the file asks for none.
    pub path: Option<PathSettings>,
    /// What is recorded.
    pub output: OutputSettings,
}

/// A named [`Model`]: the base model with one load case's overrides applied.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadCase {
    /// Key of the case in the model file; `"base"` when the file has no cases.
    pub name: String,
    /// One sentence for tables and legends; may be empty.
    pub description: String,
    /// The case's complete model.
    pub model: Model,
    /// Results from elsewhere that this case's own are compared with.
    pub references: Vec<Reference>,
}

/// A model file: its load cases and the figures that draw them together.
#[derive(Debug, Clone, PartialEq)]
pub struct Study {
    /// Title of the model file.
    pub title: String,
    /// Remark printed under tables and figures, for example that the input is a calibration.
    pub note: String,
    /// All load cases, in file order; at least one.
    pub cases: Vec<LoadCase>,
    /// Figures over all cases.
    pub figures: Vec<Figure>,
}
