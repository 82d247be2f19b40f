//! The tables of the model file, each defined once: reader, schema and reference page follow.

mod analysis;
mod body;
mod environment;
mod line;
mod line_type;
mod load;
mod motion;
mod output;
mod path;
mod study;

pub(super) use analysis::{
    DynamicsTable, FormulationChoice, IntegratorChoice, ModesTable, StaticsTable,
};
pub(super) use body::{AnchorTable, BodyTable, ShapeChoice, VesselTable};
pub(super) use environment::{
    CurrentPointTable, CurrentTable, EnvironmentTable, FactorTable, SeabedTable,
};
pub(super) use line::{
    AttachmentTable, ConnectionTable, EndTable, JointChoice, LineTable, SectionTable,
};
pub(super) use line_type::{GeneralTable, LineTypeTable, PipeTable, RectangleTable};
pub(super) use load::{LoadHarmonicTable, LoadTable};
pub(super) use motion::{DegreeChoice, HarmonicTable, LegTable, MotionTable, TowTable};
pub(super) use output::{FigureTable, OutputTable, ReferenceTable, StatisticChoice};
pub(super) use path::{PathStopTable, PathTable};
pub(super) use study::{CaseTable, ModelTable, StudyTable};
