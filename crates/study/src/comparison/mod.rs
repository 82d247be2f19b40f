//! Formulations of one model side by side: at equal mesh, and at equal error.
//!
//! Every formulation computes the load case on a family of meshes; a fine computation tells the
//! error of each. Runs follow each other on one thread, so that their times compare.
//!
//! Source: docs/theory/formulations.md, eqs. (3) and (4).

mod mesh;

use catenix_engine::simulate;
use catenix_model::{FormulationKind, Line, LoadCase, Model, StepControl};
use catenix_results::{
    ComparedCase, ComparedFormulation, ComparedResult, ComparedRun, ReferenceRun,
};
use cpu_time::ThreadTime;

use crate::accuracy::{Collector, Headline};
use crate::case::{Halt, UNUSABLE, dynamics_halt, flow, settle, system_of};
use crate::equilibria::Equilibria;
use crate::watch::Watch;
use mesh::scaled;

/// Processor time up to which a run is repeated, for the shortest time [s].
const SHORT: f64 = 0.5;
/// How often a short run is computed.
const REPEATS: usize = 3;

/// How formulations are compared.
#[derive(Debug, Clone, PartialEq)]
pub struct ComparisonSettings {
    /// The formulations.
    pub formulations: Vec<FormulationKind>,
    /// The formulation of the reference.
    pub reference: FormulationKind,
    /// Elements of the reference over those of the model file [-].
    pub reference_mesh: f64,
    /// Steps of the reference over those of the model file [-].
    pub reference_step: f64,
    /// Elements of the meshes over those of the model file, increasing [-].
    pub meshes: Vec<f64>,
    /// Relative error at which costs are compared [-].
    pub target: f64,
}

/// Measures the memory of a run.
pub trait MemoryMeter {
    /// Starts anew: the peak is what is in use now.
    fn begin(&self);
    /// Largest memory in use since then, beyond what was in use then [bytes].
    fn peak(&self) -> Option<usize>;
}

/// Nobody measures.
impl MemoryMeter for () {
    fn begin(&self) {}

    fn peak(&self) -> Option<usize> {
        None
    }
}

/// Computes a load case under every formulation, on every mesh.
pub fn compare_formulations(
    case: &LoadCase,
    settings: &ComparisonSettings,
    watch: &dyn Watch,
    memory: &dyn MemoryMeter,
) -> ComparedCase {
    Comparison {
        case,
        settings,
        watch,
        memory,
        trials: 0,
    }
    .compare()
}

struct Comparison<'a> {
    case: &'a LoadCase,
    settings: &'a ComparisonSettings,
    watch: &'a dyn Watch,
    memory: &'a dyn MemoryMeter,
    trials: usize,
}

/// What a run gave, and what it cost.
struct Measured {
    headlines: Vec<Headline>,
    run: ComparedRun,
}

impl Comparison<'_> {
    fn compare(&mut self) -> ComparedCase {
        let settings = self.settings;
        let mut compared = ComparedCase {
            name: self.case.name.clone(),
            interrupted: false,
            reference: None,
            results: Vec::new(),
            formulations: Vec::new(),
        };
        let mut model = scaled(&self.case.model, settings.reference_mesh);
        shorten_steps(&mut model, settings.reference_step);
        let fine = self.measure(model, settings.reference, settings.reference_mesh, 1);
        let (truth, problem) = match fine {
            Ok(fine) => {
                compared.reference = Some(ReferenceRun {
                    formulation: settings.reference.word().to_owned(),
                    run: fine.run,
                });
                (fine.headlines, None)
            }
            Err(Halt::Interrupted) => {
                compared.interrupted = true;
                return compared;
            }
            Err(Halt::Failed(error)) => (Vec::new(), Some(error.message)),
        };
        compared.results = truth.iter().map(result).collect();
        for &kind in &settings.formulations {
            if let Some(problem) = &problem {
                let problem = format!("no reference to hold it against: {problem}");
                compared.formulations.push(none_of(kind, problem));
                continue;
            }
            match self.formulation(kind, &truth, &mut compared.results) {
                Ok(formulation) => compared.formulations.push(formulation),
                Err(Interrupted) => {
                    compared.interrupted = true;
                    break;
                }
            }
        }
        compared
    }

    /// All runs of a formulation; its values on the mesh of the model file go into `results`.
    fn formulation(
        &mut self,
        kind: FormulationKind,
        truth: &[Headline],
        results: &mut [ComparedResult],
    ) -> Result<ComparedFormulation, Interrupted> {
        let mut found = none_of(kind, String::new());
        found.problem = None;
        let mut on_equal_mesh: Vec<Headline> = Vec::new();
        for &factor in &self.settings.meshes {
            let model = scaled(&self.case.model, factor);
            match self.measure(model, kind, factor, REPEATS) {
                Ok(Measured { headlines, mut run }) => {
                    let worst = worst(&headlines, truth);
                    run.error = worst.as_ref().map(|(error, _)| *error);
                    run.error_per_cpu_second = run.error.map(|error| error / run.cpu_seconds);
                    run.worst = worst.map(|(_, name)| name);
                    if factor == 1.0 {
                        found.equal_mesh = Some(found.runs.len());
                        on_equal_mesh = headlines;
                    }
                    found.runs.push(run);
                }
                Err(Halt::Interrupted) => return Err(Interrupted),
                Err(Halt::Failed(error)) => {
                    found.problem = Some(format!("at {factor} x the elements: {}", error.message));
                    // What a formulation cannot do it cannot do on any mesh.
                    if error.code == UNUSABLE {
                        found.problem = Some(error.message);
                        break;
                    }
                }
            }
        }
        let met = |run: &ComparedRun| run.error.is_some_and(|e| e <= self.settings.target);
        let cheapest = found.runs.iter().enumerate().filter(|(_, run)| met(run));
        found.at_target = cheapest
            .min_by(|(_, a), (_, b)| a.cpu_seconds.total_cmp(&b.cpu_seconds))
            .map(|(index, _)| index);
        for result in results {
            let value = value_of(&on_equal_mesh, &result.name);
            result.values.push(value);
            let difference = value.map(|v| 100.0 * (v - result.reference) / result.scale);
            result.differences_percent.push(difference);
        }
        Ok(found)
    }

    /// Computes a model under a formulation; a short run several times, for the shortest time.
    fn measure(
        &mut self,
        mut model: Model,
        kind: FormulationKind,
        mesh: f64,
        repeats: usize,
    ) -> Result<Measured, Halt> {
        model.formulation = kind;
        self.trials += 1;
        self.watch.trial(self.trials, elements(&model));
        let mut best = self.run(&model, mesh)?;
        for _ in 1..repeats {
            if best.run.cpu_seconds > SHORT {
                break;
            }
            let again = self.run(&model, mesh)?;
            if again.run.cpu_seconds < best.run.cpu_seconds {
                best = again;
            }
        }
        Ok(best)
    }

    fn run(&self, model: &Model, mesh: f64) -> Result<Measured, Halt> {
        self.memory.begin();
        let clock = ThreadTime::now();
        let system = system_of(model, &Equilibria::default(), self.watch)?;
        let start = settle(&system, self.watch)?;
        let statics_cpu_seconds = clock.elapsed().as_secs_f64();
        let mut collector = Collector::new(model, &self.case.references);
        let mut run = ComparedRun {
            mesh,
            elements: elements(model),
            unknowns: 6 * system.frame_count(),
            cpu_seconds: 0.0,
            statics_cpu_seconds,
            steps: 0,
            iterations: start.iterations,
            factorisations: 0,
            peak_memory_bytes: None,
            error: None,
            worst: None,
            error_per_cpu_second: None,
        };
        // The results are read for the error; that is the same for all, and not their cost.
        let mut reading = 0.0;
        let mut read = |view: &catenix_engine::StepView<'_>| {
            let clock = ThreadTime::now();
            collector.add(view);
            reading += clock.elapsed().as_secs_f64();
        };
        if model.dynamics.is_none() {
            read(&start.view());
        } else {
            let report = simulate(&system, &start, &mut |view| {
                read(view);
                flow(self.watch.stop())
            })
            .map_err(dynamics_halt)?;
            if report.interrupted {
                return Err(Halt::Interrupted);
            }
            run.steps = report.statistics.steps;
            run.iterations += report.statistics.iterations;
            run.factorisations = report.statistics.factorisations;
        }
        run.cpu_seconds = clock.elapsed().as_secs_f64() - reading;
        run.peak_memory_bytes = self.memory.peak();
        Ok(Measured {
            headlines: collector.headlines(),
            run,
        })
    }
}

/// The user stopped it.
struct Interrupted;

fn none_of(kind: FormulationKind, problem: String) -> ComparedFormulation {
    ComparedFormulation {
        formulation: kind.word().to_owned(),
        problem: Some(problem),
        runs: Vec::new(),
        equal_mesh: None,
        at_target: None,
    }
}

fn result(headline: &Headline) -> ComparedResult {
    ComparedResult {
        name: headline.name.clone(),
        unit: headline.unit.to_owned(),
        scale: headline.scale,
        counts: headline.steers,
        reference: headline.value,
        values: Vec::new(),
        differences_percent: Vec::new(),
    }
}

fn elements(model: &Model) -> usize {
    model.lines.iter().map(Line::element_count).sum()
}

fn value_of(headlines: &[Headline], name: &str) -> Option<f64> {
    let found = headlines.iter().find(|headline| headline.name == name);
    found.map(|headline| headline.value)
}

/// Largest relative error of the results that count, and which it is.
///
/// Source: docs/theory/formulations.md, eq. (3).
fn worst(headlines: &[Headline], truth: &[Headline]) -> Option<(f64, String)> {
    let errors = truth
        .iter()
        .filter(|truth| truth.steers)
        .filter_map(|truth| {
            let value = value_of(headlines, &truth.name)?;
            Some(((value - truth.value).abs() / truth.scale, &truth.name))
        });
    errors
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(error, name)| (error, name.clone()))
}

/// Steps `factor` times as long.
fn shorten_steps(model: &mut Model, factor: f64) {
    let Some(dynamics) = &mut model.dynamics else {
        return;
    };
    match &mut dynamics.step {
        StepControl::Fixed(step) => *step *= factor,
        StepControl::Adaptive { accuracy, max, min } => {
            // The local error of a second-order method falls with the cube of the step.
            *accuracy *= factor.powi(3);
            *max *= factor;
            *min = min.min(*max);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn meshes_keep_their_grading_and_their_length() {
        let text = r#"
            environment.water = { density = 1025, depth = "100 m" }
            [line_types.pipe]
            kind = "general"
            outer_diameter = "0.2 m"
            mass = "50 kg/m"
            axial_stiffness = "1 GN"
            [anchors.top]
            position = [0, 0, 0]
            [lines.riser]
            sections = [{ type = "pipe", length = "40 m", element_length = "8 m", element_length_a = "1 m", growth = 0.3 }]
            end_a = { to = "top", joint = "ball" }
        "#;
        let study = catenix_model::file::parse_study(text, "m.toml", std::path::Path::new("."));
        let Ok(study) = study else {
            panic!("{study:?}")
        };
        let model = &study.cases[0].model;
        let lengths = |model: &Model| model.lines[0].sections[0].element_lengths.clone();
        for factor in [0.5, 2.0, 4.0] {
            let scaled = lengths(&scaled(model, factor));
            assert_eq!(
                scaled.len(),
                (lengths(model).len() as f64 * factor) as usize
            );
            assert!((scaled.iter().sum::<f64>() - 40.0).abs() < 1e-12);
        }
        let halves = lengths(&scaled(model, 2.0));
        for (k, whole) in lengths(model).iter().enumerate() {
            assert!((halves[2 * k] + halves[2 * k + 1] - whole).abs() < 1e-12);
        }
        assert_eq!(lengths(&scaled(model, 1.0)), lengths(model));
    }
}
