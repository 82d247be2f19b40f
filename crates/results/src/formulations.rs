//! Formulations of one model side by side: results, errors and cost.
//!
//! The keys are a public interface, described in docs/compare.md.

use serde::Serialize;

/// The load cases of a model under several formulations.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FormulationStudy {
    /// Version of Catenix that computed it.
    pub catenix_version: String,
    /// Title of the model file.
    pub title: String,
    /// Relative error at which costs are compared [-].
    pub target: f64,
    /// Load cases, in file order.
    pub cases: Vec<ComparedCase>,
}

/// A load case under several formulations.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ComparedCase {
    /// Name of the load case.
    pub name: String,
    /// Whether it was stopped before its end.
    pub interrupted: bool,
    /// What errors are measured against; null where it could not be computed.
    pub reference: Option<ReferenceRun>,
    /// Results of the reference and, on the mesh of the model file, of every formulation.
    pub results: Vec<ComparedResult>,
    /// The formulations, in the order asked for.
    pub formulations: Vec<ComparedFormulation>,
}

/// The fine computation that errors are measured against.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ReferenceRun {
    /// Its formulation.
    pub formulation: String,
    /// Its mesh and cost.
    pub run: ComparedRun,
}

/// A headline result under the formulations.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ComparedResult {
    /// Channel or line quantity, and what of it.
    pub name: String,
    /// Unit of values and scale.
    pub unit: String,
    /// What errors are relative to: for a force the tension, for an offset its length.
    pub scale: f64,
    /// Whether the error of a run counts it.
    pub counts: bool,
    /// Value of the reference.
    pub reference: f64,
    /// Value of each formulation on the mesh of the model file; null where there is none.
    pub values: Vec<Option<f64>>,
    /// Difference from the reference, over the scale, in per cent.
    pub differences_percent: Vec<Option<f64>>,
}

/// What a formulation gave on a family of meshes.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ComparedFormulation {
    /// The word of the model file.
    pub formulation: String,
    /// Why it cannot compute this model, or what failed; null where every run ended well.
    pub problem: Option<String>,
    /// Runs, from the coarsest mesh to the finest.
    pub runs: Vec<ComparedRun>,
    /// Index of the run on the mesh of the model file.
    pub equal_mesh: Option<usize>,
    /// Index of the cheapest run that meets the target.
    pub at_target: Option<usize>,
}

impl ComparedFormulation {
    /// The run on the mesh of the model file.
    pub fn on_equal_mesh(&self) -> Option<&ComparedRun> {
        self.equal_mesh.and_then(|index| self.runs.get(index))
    }

    /// The cheapest run that meets the target.
    pub fn meeting_target(&self) -> Option<&ComparedRun> {
        self.at_target.and_then(|index| self.runs.get(index))
    }
}

/// One run on one mesh.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ComparedRun {
    /// Elements over those of the model file [-].
    pub mesh: f64,
    /// Elements.
    pub elements: usize,
    /// Unknowns in the solver's blocks.
    pub unknowns: usize,
    /// Processor time of statics and motion [s].
    pub cpu_seconds: f64,
    /// Processor time of statics alone [s].
    pub statics_cpu_seconds: f64,
    /// Accepted steps.
    pub steps: usize,
    /// Newton iterations of statics and motion.
    pub iterations: usize,
    /// Factorisations of the motion.
    pub factorisations: usize,
    /// Largest memory in use, beyond what was in use before; null where it is not measured [bytes].
    pub peak_memory_bytes: Option<usize>,
    /// Largest relative error of the results that count [-]; null for the reference.
    pub error: Option<f64>,
    /// Result with that error.
    pub worst: Option<String>,
    /// Error over processor time [1/s].
    pub error_per_cpu_second: Option<f64>,
}
