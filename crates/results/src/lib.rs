//! Results of a study: statistics, the result store and summaries.
//!
//! Data flows in from a solver through the [`Sample`] trait: a [`ResultStore`] hands out one
//! [`CaseRecorder`] per load case, which writes histories, line fields, range graphs, the static
//! state and the solver's account while the case runs. [`StoredStudy`] reads a store back, whether
//! it was finished, interrupted or killed, and makes the same [`Summary`] from it. [`StudyPaths`]
//! holds equilibrium paths, [`CaseModes`] natural modes, [`Verification`] a verification suite,
//! [`FormulationStudy`] formulations side by side.
//!
//! The layout of the store is in docs/results.md; it opens in xarray as it is.

mod case_arrays;
mod curve;
mod date;
mod description;
mod details;
mod envelope;
mod error;
mod formulations;
mod layout;
mod modes;
mod outcome;
mod overview;
mod path;
mod recorder;
mod rows;
mod sample;
mod scene;
mod series;
mod static_summary;
mod statistics;
mod store;
mod store_reader;
mod stored_modes;
mod stored_statistics;
mod summarise;
mod summary;
mod verification;
mod zarr;

pub use curve::{Curve, OutputTimes};
pub use description::{
    ArrayPlace, CaseDescription, CaseProgress, ChannelPlace, LinePlace, QuantityPlace, read_vector,
    stored_file,
};
pub use details::{Setting, SettingValue};
pub use envelope::Envelope;
pub use error::StoreError;
pub use formulations::{
    ComparedCase, ComparedFormulation, ComparedResult, ComparedRun, FormulationStudy, ReferenceRun,
};
pub use layout::{STORE_FORMAT, STORE_NAME, component as path_component};
pub use modes::{CaseModes, ModeReport, ModeShapes, ModesReport, MotionShare};
pub use outcome::{CaseOutcome, DynamicsFacts, StaticsFacts, mean_order};
pub use overview::{
    BodyOverview, CurrentOverview, LineOverview, LoadOverview, ModelOverview, VesselOverview,
};
pub use path::{CasePath, PathChannel, PathPointFacts, StudyPaths};
pub use recorder::CaseRecorder;
pub use rows::StoredRows;
pub use sample::Sample;
pub use scene::{
    Scene, SceneAttachment, SceneBody, SceneCurrent, SceneEnd, SceneLine, SceneSection, SceneVessel,
};
pub use statistics::{Extremes, RangeGraph, WindowStatistics};
pub use store::{Provenance, ResultStore, StoredFigure};
pub use store_reader::{Field, History, StoredCase, StoredStudy};
pub use summary::{
    BodySummary, CaseError, CaseSummary, Comparison, Discretisation, EndSummary, ErrorEstimate,
    Extent, LineSummary, Located, Status, Summary,
};
pub use verification::{
    Verification, VerifiedCase, VerifiedConvergence, VerifiedCurve, VerifiedEstimate,
    VerifiedNumber,
};
