//! Catenix beside MoorDyn and EXUDYN on the sea trial: each at its cheapest set-up that is right.

use std::path::{Path, PathBuf};
use std::process::Command;

use catenix_report::figure::{Chart, ChartAxis, Curve};
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::{Figures, Section, kept, recalled};
use crate::context::Context;
use crate::markdown::{Table, digits};
use crate::trial::{self, Errors, MESH, MODEL, Outcome, Reference, Stepping};
use crate::{child, python};

pub(crate) const SECTION: Section = Section {
    name: "peers",
    title: "Peers",
    measure,
    markdown,
    charts,
};

/// With the current and against it.
const CASES: [&str; 2] = ["a", "f"];
/// Errors that count as right: offset, top tension, hose force.
const ALLOWED: Errors = Errors {
    offset: 0.01,
    top: 0.01,
    hose: 0.02,
};

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
enum Program {
    Catenix,
    MoorDyn,
    Exudyn,
}

const PROGRAMS: [Program; 3] = [Program::Catenix, Program::MoorDyn, Program::Exudyn];

impl Program {
    fn name(self) -> &'static str {
        match self {
            Program::Catenix => "Catenix",
            Program::MoorDyn => "MoorDyn",
            Program::Exudyn => "EXUDYN",
        }
    }

    /// Meshes (elements of pipe and hose) and steps [s] that are tried; `None` for those that
    /// Catenix chooses as it goes.
    fn grid(self, quick: bool) -> Vec<SetUp> {
        let (meshes, steps): (&[[usize; 2]], &[Option<f64>]) = match self {
            Program::Catenix => (
                &[
                    MESH,
                    [30, 66],
                    [15, 33],
                    [10, 21],
                    [8, 15],
                    [6, 12],
                    [4, 12],
                ],
                &[Some(0.1), Some(0.2), Some(0.4), Some(0.5), Some(0.64), None],
            ),
            Program::Exudyn => (
                &[MESH, [30, 66], [15, 33], [8, 18], [6, 12], [4, 9]],
                &[Some(0.2), Some(0.32), Some(0.4)],
            ),
            // Explicit steps go with the mesh: shares of the time that a sound wave takes through
            // an element, near the largest that is stable.
            Program::MoorDyn => {
                let meshes = [
                    MESH,
                    [30, 60],
                    [15, 36],
                    [10, 33],
                    [8, 40],
                    [6, 30],
                    [6, 18],
                    [5, 24],
                    [4, 12],
                ];
                let chosen = if quick { &meshes[5..6] } else { &meshes[..] };
                let steps = |mesh: &[usize; 2]| {
                    let mesh = *mesh;
                    [0.7, 0.95].map(|share| (mesh, Some(share * sound_time(mesh))))
                };
                return chosen.iter().flat_map(steps).collect();
            }
        };
        if quick {
            pairs(&meshes[2..3], &steps[2..])
        } else {
            pairs(meshes, steps)
        }
    }
}

/// A mesh and a step.
type SetUp = ([usize; 2], Option<f64>);

fn pairs(meshes: &[[usize; 2]], steps: &[Option<f64>]) -> Vec<SetUp> {
    let each = |mesh: &[usize; 2]| {
        let mesh = *mesh;
        steps.iter().map(move |step| (mesh, *step))
    };
    meshes.iter().flat_map(each).collect()
}

/// Time of a sound wave through one element, in the quicker of the two lines [s].
fn sound_time(mesh: [usize; 2]) -> f64 {
    // Wave speeds sqrt(EA/m) of the example's pipe and hose [m/s], rounded up.
    let pipe = 900.0 / mesh[0] as f64 / 4600.0;
    let hose = 400.0 / mesh[1] as f64 / 295.0;
    pipe.min(hose)
}

#[derive(Debug, Serialize, Deserialize)]
struct Data {
    versions: Vec<String>,
    references: Vec<(String, Reference)>,
    trials: Vec<Trial>,
}

/// One program with one set-up on one case.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct Trial {
    program: Program,
    case: String,
    mesh: [usize; 2],
    /// `None`: as the program chooses.
    step_s: Option<f64>,
    /// Processor time of the motion, in the fastest repeat [s].
    cpu_s: f64,
    /// Repeats.
    repeats: usize,
    /// Time that was simulated [s].
    simulated_s: f64,
    /// `None` where the program failed or was unstable.
    errors: Option<Errors>,
}

impl Trial {
    fn cost(&self) -> f64 {
        self.cpu_s / self.simulated_s
    }

    /// The largest error over what is allowed.
    fn worst(&self) -> f64 {
        self.errors.map_or(f64::INFINITY, |e| {
            (e.offset / ALLOWED.offset)
                .max(e.top / ALLOWED.top)
                .max(e.hose / ALLOWED.hose)
        })
    }

    fn is_right(&self) -> bool {
        self.worst() <= 1.0
    }

    fn setting(&self) -> String {
        let step = self.step_s.map_or_else(
            || Stepping::Default.words(),
            |step| format!("{} s", digits(step)),
        );
        format!("{} + {}, {step}", self.mesh[0], self.mesh[1])
    }
}

/// What a peer's script prints.
#[derive(Debug, Deserialize)]
struct Answer {
    status: String,
    cpu_s: Option<f64>,
    step_s: Option<f64>,
    simulated_s: Option<f64>,
    version: Option<String>,
    outcome: Option<Outcome>,
}

struct Runner<'a> {
    context: &'a Context,
    python: PathBuf,
    versions: Vec<String>,
}

impl Runner<'_> {
    /// Runs a set-up once.
    fn run(
        &mut self,
        program: Program,
        case: &str,
        (mesh, step): SetUp,
        right: &Outcome,
    ) -> Result<Trial, String> {
        let mut trial = Trial {
            program,
            case: case.to_owned(),
            mesh,
            step_s: step,
            cpu_s: f64::NAN,
            repeats: 1,
            simulated_s: f64::NAN,
            errors: None,
        };
        match program {
            Program::Catenix => {
                // A mesh or step that does not converge is a finding, as it is for the peers.
                let stepping = step.map_or(Stepping::Default, Stepping::Fixed);
                let task = trial::task(self.context, case, mesh, stepping)?;
                match task.run(self.context) {
                    Ok(probe) => {
                        trial.cpu_s = probe.motion_cpu_s;
                        trial.simulated_s = probe.simulated_s;
                        trial.errors = Some(Outcome::of(&probe)?.errors(right));
                    }
                    Err(message) => eprintln!("    Catenix {}: {message}", trial.setting()),
                }
            }
            Program::MoorDyn => self.ask("run_moordyn.py", &mut trial, right)?,
            Program::Exudyn => self.ask("run_exudyn.py", &mut trial, right)?,
        }
        Ok(trial)
    }

    fn ask(&mut self, script: &str, trial: &mut Trial, right: &Outcome) -> Result<(), String> {
        let root: &Path = &self.context.root;
        let mut command = Command::new(&self.python);
        command
            .env("PYTHONDONTWRITEBYTECODE", "1")
            .env("NUMBA_CACHE_DIR", self.context.work.join("numba"))
            .arg(root.join("bench/peers").join(script))
            .arg(root.join(MODEL))
            .arg(&trial.case)
            .args(trial.mesh.map(|count| count.to_string()))
            .args(trial.step_s.map(|step| step.to_string()));
        let answer: Answer = child::json_of(&mut command)?;
        if let Some(version) = answer.version
            && !self.versions.contains(&version)
        {
            self.versions.push(version);
        }
        let found = (answer.cpu_s, answer.simulated_s, answer.outcome);
        if let (Some(cpu), Some(simulated), Some(outcome)) = found {
            trial.cpu_s = cpu;
            trial.simulated_s = simulated;
            trial.step_s = answer.step_s.or(trial.step_s);
            trial.errors = Some(outcome.errors(right));
        } else {
            eprintln!(
                "    {} {}: {}",
                trial.program.name(),
                trial.setting(),
                answer.status
            );
        }
        Ok(())
    }
}

fn measure(context: &Context) -> Result<Value, String> {
    let cases: &[&str] = if context.quick { &["f"] } else { &CASES };
    let references = trial::references(context, cases)?;
    let mut runner = Runner {
        context,
        python: python::environment(context)?,
        versions: Vec::new(),
    };
    let mut trials = Vec::new();
    for (case, reference) in cases.iter().zip(&references) {
        // First all set-ups once, then those that are compared, in turns.
        for program in PROGRAMS {
            eprintln!("  case {case}: {} ...", program.name());
            for set_up in program.grid(context.quick) {
                trials.push(runner.run(program, case, set_up, &reference.outcome)?);
            }
        }
        for repeat in 1..context.repeats() {
            eprintln!(
                "  case {case}: repeat {} of what is compared ...",
                repeat + 1
            );
            for index in compared(&trials, case) {
                let Trial {
                    program,
                    mesh,
                    step_s,
                    ..
                } = trials[index];
                let again = runner.run(program, case, (mesh, step_s), &reference.outcome)?;
                let trial = &mut trials[index];
                trial.repeats += 1;
                trial.cpu_s = trial.cpu_s.min(again.cpu_s);
            }
        }
    }
    kept(&Data {
        versions: runner.versions,
        references: cases
            .iter()
            .map(|case| (*case).to_owned())
            .zip(references)
            .collect(),
        trials,
    })
}

/// The cheapest set-up of a program that is right, on one mesh or on any.
fn cheapest<'t>(
    trials: &'t [Trial],
    case: &str,
    program: Program,
    mesh: Option<[usize; 2]>,
) -> Option<(usize, &'t Trial)> {
    let fitting = trials.iter().enumerate().filter(|(_, trial)| {
        trial.case == case
            && trial.program == program
            && trial.is_right()
            && mesh.is_none_or(|mesh| trial.mesh == mesh)
    });
    fitting.min_by(|(_, a), (_, b)| a.cost().total_cmp(&b.cost()))
}

/// Indices of the set-ups that the page compares, each once.
fn compared(trials: &[Trial], case: &str) -> Vec<usize> {
    let mut list: Vec<usize> = [Some(MESH), None]
        .into_iter()
        .flat_map(|mesh| PROGRAMS.map(|program| cheapest(trials, case, program, mesh)))
        .flatten()
        .map(|(index, _)| index)
        .collect();
    list.sort_unstable();
    list.dedup();
    list
}

fn markdown(data: &Value) -> Result<String, String> {
    let data: Data = recalled(data)?;
    let mut text = format!(
        "{}, on {MODEL}. Processor time of the motion alone, on one thread. A set-up is right when\n\
         its offset and top tension are within {} % and its hose force within {} % of the reference.\n",
        data.versions.join(" and "),
        100.0 * ALLOWED.top,
        100.0 * ALLOWED.hose
    );
    for (title, mesh) in [
        ("At the same mesh, 90 + 200 elements", Some(MESH)),
        ("At equal accuracy, each at its cheapest", None),
    ] {
        text.push_str(&format!("\n### {title}\n\n"));
        let mut table = Table::new(&[
            "case, program",
            "elements, step",
            "CPU ms per simulated s",
            "times real time",
            "cost over Catenix's",
            "offset error, %",
            "top tension error, %",
            "hose force error, %",
        ]);
        for (case, _) in &data.references {
            let ours = cheapest(&data.trials, case, Program::Catenix, mesh);
            for program in PROGRAMS {
                let first = format!("{case}, {}", program.name());
                let Some((_, trial)) = cheapest(&data.trials, case, program, mesh) else {
                    let mut cells = vec![first, "none is right".to_owned()];
                    cells.resize(8, "-".to_owned());
                    table.row(cells);
                    continue;
                };
                let ratio = match ours {
                    Some((_, ours)) if program != Program::Catenix => {
                        digits(trial.cost() / ours.cost())
                    }
                    _ => "-".to_owned(),
                };
                let [offset, top, hose] = shown(trial.errors);
                table.row([
                    first,
                    trial.setting(),
                    digits(1e3 * trial.cost()),
                    digits(1.0 / trial.cost()),
                    ratio,
                    offset,
                    top,
                    hose,
                ]);
            }
        }
        text.push_str(&table.text());
    }
    text.push_str("\n### All set-ups that were tried\n\n");
    let mut table = Table::new(&[
        "case, program",
        "elements, step",
        "CPU ms per simulated s",
        "offset error, %",
        "top tension error, %",
        "hose force error, %",
        "right",
    ]);
    for trial in &data.trials {
        let [offset, top, hose] = shown(trial.errors);
        table.row([
            format!("{}, {}", trial.case, trial.program.name()),
            trial.setting(),
            digits(1e3 * trial.cost()),
            offset,
            top,
            hose,
            match trial.errors {
                None => "failed".to_owned(),
                Some(_) if trial.is_right() => "yes".to_owned(),
                Some(_) => "no".to_owned(),
            },
        ]);
    }
    text.push_str(&table.text());
    for (case, _) in &data.references {
        text.push_str(&format!(
            "\n![Case {case}: cost against error](figures/peers-{case}.svg)\n"
        ));
    }
    Ok(text)
}

fn shown(errors: Option<Errors>) -> [String; 3] {
    errors.map_or(["-"; 3].map(str::to_owned), |e| {
        [e.offset, e.top, e.hose].map(|error| digits(100.0 * error))
    })
}

fn charts(data: &Value) -> Result<Figures, String> {
    let data: Data = recalled(data)?;
    let chart = |case: &String| {
        let mut curves: Vec<Curve> = PROGRAMS
            .iter()
            .map(|program| Curve::new(program.name(), best(&data.trials, case, *program)))
            .collect();
        let costs = curves.iter().flat_map(|curve| &curve.points).map(|p| p.0);
        let ends = costs.fold((f64::INFINITY, 0.0_f64), |(low, high), x| {
            (low.min(x), high.max(x))
        });
        curves.push(Curve::new("allowed", vec![(ends.0, 1.0), (ends.1, 1.0)]));
        let chart = Chart::new(
            &format!("Sea trial, case {case}: cost against error"),
            ChartAxis::logarithmic("Processor time per simulated second", "ms"),
            ChartAxis::logarithmic("Largest error, over what is allowed", ""),
            curves,
        )
        .with_note(
            "Of each program those set-ups that no cheaper one beats. Allowed: 1 % in offset and \
             top tension, 2 % in hose force.",
        );
        (format!("peers-{case}"), chart)
    };
    Ok(data
        .references
        .iter()
        .map(|(case, _)| chart(case))
        .collect())
}

/// Cost [ms/s] and error of the set-ups that no cheaper one beats, by increasing cost.
fn best(trials: &[Trial], case: &str, program: Program) -> Vec<(f64, f64)> {
    let mut points: Vec<(f64, f64)> = trials
        .iter()
        .filter(|t| t.case == case && t.program == program && t.errors.is_some())
        .map(|trial| (1e3 * trial.cost(), trial.worst()))
        .collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut smallest = f64::INFINITY;
    points.retain(|&(_, error)| {
        let better = error < smallest;
        smallest = smallest.min(error);
        better
    });
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    fn trial(program: Program, mesh: [usize; 2], cpu_s: f64, error: f64) -> Trial {
        Trial {
            program,
            case: "a".to_owned(),
            mesh,
            step_s: Some(0.1),
            cpu_s,
            repeats: 1,
            simulated_s: 1.0,
            errors: Some(Errors {
                offset: error,
                top: error,
                hose: error,
            }),
        }
    }

    #[test]
    fn the_cheapest_set_up_is_one_that_is_right() {
        let trials = [
            trial(Program::Catenix, MESH, 3.0, 0.001),
            trial(Program::Catenix, [6, 12], 1.0, 0.02),
            trial(Program::Catenix, [8, 15], 2.0, 0.009),
            trial(Program::MoorDyn, MESH, 0.5, 0.001),
        ];
        let index = |mesh| cheapest(&trials, "a", Program::Catenix, mesh).map(|(index, _)| index);
        assert_eq!((index(None), index(Some(MESH))), (Some(2), Some(0)));
        assert!(cheapest(&trials, "f", Program::Catenix, None).is_none());
        assert_eq!(compared(&trials, "a"), [0, 2, 3]);
        let better = best(&trials, "a", Program::Catenix);
        assert_eq!(better.len(), 3);
    }
}
