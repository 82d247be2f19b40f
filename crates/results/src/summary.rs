//! The summary of a study: the numbers that tables, JSON documents and reports print.
//!
//! The keys are a public interface, described in docs/results.md: names carry their unit, a number
//! that does not exist is null, and keys are added but not renamed.

use catenix_model::Statistic;
use indexmap::IndexMap;
use serde::{Deserialize, Deserializer, Serialize};

/// How far a study or a load case came.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Status {
    /// Not begun.
    Pending,
    /// Being computed; or its process was killed, and the store ends at the last flush.
    Running,
    /// Computed to the end.
    Complete,
    /// Stopped by the user.
    Interrupted,
    /// The solver gave up.
    Failed,
}

impl Status {
    /// The word that is stored and printed.
    pub fn word(self) -> &'static str {
        match self {
            Status::Pending => "pending",
            Status::Running => "running",
            Status::Complete => "complete",
            Status::Interrupted => "interrupted",
            Status::Failed => "failed",
        }
    }

    pub(crate) fn from_word(word: &str) -> Option<Self> {
        use Status::{Complete, Failed, Interrupted, Pending, Running};
        [Pending, Running, Complete, Interrupted, Failed]
            .into_iter()
            .find(|s| s.word() == word)
    }

    /// Status of a study from those of its cases: the worst news first.
    pub fn of_study(cases: impl IntoIterator<Item = Status>) -> Self {
        let rank = |status| match status {
            Status::Complete => 0,
            Status::Pending => 1,
            Status::Running => 2,
            Status::Failed => 3,
            Status::Interrupted => 4,
        };
        cases
            .into_iter()
            .max_by_key(|status| rank(*status))
            .unwrap_or(Status::Complete)
    }
}

/// Minimum and maximum over the whole run, and mean over the statistics window.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Extent {
    /// Smallest value over the whole run, t = 0 included.
    #[serde(deserialize_with = "null_as_nan")]
    pub min: f64,
    /// Mean over the statistics window.
    #[serde(deserialize_with = "null_as_nan")]
    pub mean: f64,
    /// Largest value over the whole run, t = 0 included.
    #[serde(deserialize_with = "null_as_nan")]
    pub max: f64,
}

impl Extent {
    /// No value.
    pub const NONE: Extent = Extent {
        min: f64::NAN,
        mean: f64::NAN,
        max: f64::NAN,
    };

    /// The extent of one value.
    pub fn of(value: f64) -> Self {
        Extent::new(value, value, value)
    }

    pub(crate) fn new(min: f64, mean: f64, max: f64) -> Self {
        // Adding zero turns -0 into 0, which reads better.
        Extent {
            min: min + 0.0,
            mean: mean + 0.0,
            max: max + 0.0,
        }
    }
}

/// An extreme over the whole run and where along its line it occurs.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Located {
    /// The value, in the unit that the key names.
    #[serde(deserialize_with = "null_as_nan")]
    pub value: f64,
    /// Unstretched distance from end A [m].
    #[serde(deserialize_with = "null_as_nan")]
    pub arc_length_m: f64,
}

/// Summary of a study.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Version of Catenix that computed the results.
    pub catenix_version: String,
    /// Title of the model file.
    pub title: String,
    /// The study's remark, for example that its input is a calibration.
    pub note: String,
    /// Model file, as given.
    pub model_file: String,
    /// SHA-256 of the model file's text, in hexadecimal.
    pub model_sha256: String,
    /// How far the study came.
    pub status: Status,
    /// Load cases by name, in file order.
    pub cases: IndexMap<String, CaseSummary>,
}

/// Summary of one load case.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CaseSummary {
    /// One sentence; may be empty.
    pub description: String,
    /// How far the case came.
    pub status: Status,
    /// Why it failed.
    pub error: Option<CaseError>,
    /// Remarks of the solver, for example on a motion that nothing resists.
    #[serde(default)]
    pub warnings: Vec<String>,
    /// Simulated time that was reached [s]; null when only statics ran.
    pub simulated_s: Option<f64>,
    /// First and last time of the window over which means are taken [s].
    pub window_s: Option<[f64; 2]>,
    /// Bodies by name.
    pub bodies: IndexMap<String, BodySummary>,
    /// Lines by name.
    pub lines: IndexMap<String, LineSummary>,
    /// Results from elsewhere beside the computed ones.
    pub references: Vec<Comparison>,
    /// Mesh, step and estimated errors, where an accuracy was asked for.
    #[serde(default)]
    pub discretisation: Option<Discretisation>,
    /// Iterations of the static solution.
    pub static_iterations: Option<usize>,
    /// Largest residual force of the static solution [N].
    pub static_residual_n: Option<f64>,
    /// Accepted time steps.
    pub steps: Option<usize>,
    /// Time steps that were tried and discarded.
    pub rejected_steps: Option<usize>,
    /// Accepted steps of each order of the integrator, from 1 to 5.
    #[serde(default)]
    pub steps_of_order: Option<[usize; 5]>,
    /// Newton iterations over all time steps.
    pub iterations: Option<usize>,
    /// Factorisations of the Newton matrix over all time steps.
    pub factorisations: Option<usize>,
    /// Largest residual force left by an accepted step [N].
    pub residual_n: Option<f64>,
    /// Energy that the account does not explain, as a fraction of the work done [-].
    pub energy_imbalance: Option<f64>,
    /// Processor time of the case, statics and recording included [s].
    pub cpu_seconds: Option<f64>,
    /// Elapsed time of the case [s].
    pub wall_seconds: Option<f64>,
    /// Simulated time over processor time [-]: what the case costs, however busy the machine is.
    pub real_time_factor: Option<f64>,
}

/// Mesh and step that were chosen for a wanted accuracy, and the errors that are left.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Discretisation {
    /// Relative error that was asked for [-].
    pub target: f64,
    /// Whether every estimate meets it.
    pub reached: bool,
    /// Elements of all lines.
    pub elements: usize,
    /// Largest time step [s]; null for statics.
    pub largest_step_s: Option<f64>,
    /// Local error allowed per step, over the reference length [-]; null for statics.
    pub step_error: Option<f64>,
    /// Trial computations that the choice took.
    pub trials: usize,
    /// Processor time of the trials [s].
    pub cpu_seconds: Option<f64>,
    /// Estimated errors of the headline results.
    pub estimates: Vec<ErrorEstimate>,
}

/// The estimated discretisation error of a headline result.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ErrorEstimate {
    /// Channel or line quantity, and what of it: `hose.end_b.force_x, mean`.
    pub result: String,
    /// Unit of value, scale and errors.
    pub unit: String,
    /// Its value on the chosen mesh, with the chosen steps.
    pub value: f64,
    /// What the relative error refers to: for a force the tension there, for an offset its length.
    pub scale: f64,
    /// Estimated error of the mesh.
    pub space_error: f64,
    /// Estimated error of the time step.
    pub time_error: f64,
    /// Whether the target holds for it; peaks along a line are only reported with their error.
    pub steers: bool,
}

impl ErrorEstimate {
    /// Both errors over the scale [-].
    pub fn relative(&self) -> f64 {
        (self.space_error + self.time_error) / self.scale
    }

    /// Whether the target is met, or does not hold for this result.
    pub fn meets(&self, target: f64) -> bool {
        !self.steers || self.relative() <= target
    }
}

/// Why a case failed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CaseError {
    /// Stable identifier, of the form `statics::kind`.
    pub code: String,
    /// What happened: time, element, residual.
    pub message: String,
}

/// Results of a free body: means over the window.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BodySummary {
    /// Vessel against which the offsets are taken.
    pub offset_vessel: Option<String>,
    /// Position less that of the vessel, global x [m].
    pub offset_x_m: Option<f64>,
    /// The same along y [m].
    pub offset_y_m: Option<f64>,
    /// The same along z [m].
    pub offset_z_m: Option<f64>,
    /// Position of the origin, global x [m].
    pub x_m: Option<f64>,
    /// Position of the origin, global y [m].
    pub y_m: Option<f64>,
    /// Position of the origin, global z [m].
    pub z_m: Option<f64>,
    /// Angle of the body's axis from the vertical [deg].
    pub tilt_deg: Option<f64>,
}

/// Results of a line.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LineSummary {
    /// Unstretched length [m].
    pub length_m: f64,
    /// Number of elements.
    pub elements: usize,
    /// What the line does to its support at end A.
    pub end_a: EndSummary,
    /// What the line does to its support at end B.
    pub end_b: EndSummary,
    /// Smallest effective tension over the run and the line [N].
    pub min_effective_tension_n: Option<Located>,
    /// Largest effective tension over the run and the line [N].
    pub max_effective_tension_n: Option<Located>,
    /// Largest bending moment over the run and the line [N m].
    pub max_bend_moment_n_m: Option<Located>,
    /// Largest curvature over the run and the line [1/m].
    pub max_curvature_1_m: Option<Located>,
    /// Largest von Mises stress over the run and the line [Pa]; null without a wall.
    pub max_von_mises_stress_pa: Option<Located>,
}

/// Force and direction at an end of a line.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EndSummary {
    /// Force of the line on its support, global x [N].
    pub force_x_n: Extent,
    /// Force of the line on its support, global y [N].
    pub force_y_n: Extent,
    /// Force of the line on its support, global z [N].
    pub force_z_n: Extent,
    /// Effective tension [N].
    pub effective_tension_n: Extent,
    /// Angle between the line and the vertical [deg].
    pub declination_deg: Extent,
}

/// A result from elsewhere and the computed one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Comparison {
    /// Channel that is compared.
    pub channel: String,
    /// What of the channel: mean over the window, or an extreme over the whole run.
    pub statistic: Statistic,
    /// Unit of the numbers.
    pub unit: String,
    /// Lower end of the reference.
    pub low: f64,
    /// Upper end of the reference; the lower one when it is a single value.
    pub high: f64,
    /// The computed number; null unless the case is complete.
    pub computed: Option<f64>,
    /// Zero inside the range, else computed less the nearer end.
    pub difference: Option<f64>,
    /// Where the reference is from.
    pub source: String,
}

impl CaseSummary {
    /// A case without results.
    pub fn empty(description: &str, status: Status) -> Self {
        CaseSummary {
            description: description.to_owned(),
            status,
            error: None,
            warnings: Vec::new(),
            simulated_s: None,
            window_s: None,
            bodies: IndexMap::new(),
            lines: IndexMap::new(),
            references: Vec::new(),
            discretisation: None,
            static_iterations: None,
            static_residual_n: None,
            steps: None,
            rejected_steps: None,
            steps_of_order: None,
            iterations: None,
            factorisations: None,
            residual_n: None,
            energy_imbalance: None,
            cpu_seconds: None,
            wall_seconds: None,
            real_time_factor: None,
        }
    }
}

/// JSON has no NaN: it is written as null and comes back as NaN.
fn null_as_nan<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    Ok(Option::<f64>::deserialize(deserializer)?.unwrap_or(f64::NAN))
}
