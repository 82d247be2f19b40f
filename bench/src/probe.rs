//! One load case, computed by the engine alone: what it costs, and what comes out.
//!
//! Nothing is written to a disk and only the compared channels are read at each step, as the
//! programs around the peers do it. Runs as a process of its own, so that its memory is its own.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::process::Command;

use catenix_engine::{StaticSolution, System, simulate, solve_statics};
use catenix_model::file::read_study;
use catenix_model::{Channel, LoadCase, Model, all_channels};
use catenix_results::Extremes;
use catenix_study::choose_for_accuracy;
use cpu_time::ThreadTime;
use serde::{Deserialize, Serialize};

use crate::child;
use crate::context::Context;

/// What to compute.
#[derive(Debug, Clone)]
pub(crate) struct Task {
    /// Model file.
    pub model: PathBuf,
    /// Load case.
    pub case: String,
    /// Channels whose statistics are wanted.
    pub channels: Vec<String>,
    /// Whether to stop at the equilibrium.
    pub statics_only: bool,
    /// Accuracy for which mesh and step are chosen first, instead of those in the file [-].
    pub accuracy: Option<f64>,
}

/// What a load case cost, and what came out.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Probe {
    /// Elements of all lines.
    pub elements: usize,
    /// Processor time of assembling the model [s].
    #[serde(alias = "reading_cpu_s")]
    pub assembling_cpu_s: f64,
    /// Processor time of the static equilibrium [s].
    pub statics_cpu_s: f64,
    /// Iterations of the static equilibrium.
    pub statics_iterations: usize,
    /// Processor time of the motion [s].
    pub motion_cpu_s: f64,
    /// Simulated time [s].
    pub simulated_s: f64,
    /// Accepted steps.
    pub steps: usize,
    /// Steps repeated with a smaller size.
    pub rejected_steps: usize,
    /// Newton iterations.
    pub iterations: usize,
    /// Factorisations of the iteration matrix.
    pub factorisations: usize,
    /// Largest resident memory of the process [bytes].
    pub peak_bytes: Option<f64>,
    /// Of each channel that was asked for.
    pub statistics: Vec<Statistics>,
}

/// Of one channel over all steps.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct Statistics {
    /// Smallest value over the whole motion.
    pub min: f64,
    /// Largest value over the whole motion.
    pub max: f64,
    /// Mean over the statistics window.
    pub mean: f64,
}

impl Probe {
    /// Elapsed work of one iteration [s].
    pub(crate) fn per_iteration(&self) -> f64 {
        self.motion_cpu_s / self.iterations as f64
    }

    /// Processor time per simulated second [-].
    pub(crate) fn per_simulated_second(&self) -> f64 {
        self.motion_cpu_s / self.simulated_s
    }

    /// The statistics of a norm cannot be had from those of its parts, so a channel named `|a|`
    /// is the length of the vector of `a_x`, `a_y` and `a_z`.
    fn parts(model: &Model, name: &str) -> Result<Vec<Channel>, String> {
        let find = |name: &str| {
            let channels = all_channels(model);
            let found = channels.into_iter().find(|channel| channel.name == name);
            found.ok_or_else(|| format!("the model has no channel `{name}`"))
        };
        match name
            .strip_prefix('|')
            .and_then(|rest| rest.strip_suffix('|'))
        {
            Some(stem) => ["x", "y", "z"]
                .iter()
                .map(|axis| find(&format!("{stem}_{axis}")))
                .collect(),
            None => Ok(vec![find(name)?]),
        }
    }
}

impl Task {
    /// Computes it in a process of its own.
    pub(crate) fn run(&self, context: &Context) -> Result<Probe, String> {
        child::json_of(&mut self.command(context))
    }

    /// The process of its own.
    pub(crate) fn command(&self, context: &Context) -> Command {
        let mut command = Command::new(&context.own);
        command.arg("probe").arg(&self.model).arg(&self.case);
        command.arg(match (self.statics_only, self.accuracy) {
            (true, _) => "statics".to_owned(),
            (false, None) => "motion".to_owned(),
            (false, Some(accuracy)) => format!("{ACCURACY}{accuracy}"),
        });
        command.args(&self.channels);
        command
    }

    /// The task that [`Task::command`] describes.
    pub(crate) fn from_arguments(arguments: &[String]) -> Result<Task, String> {
        match arguments {
            [model, case, extent, channels @ ..] => Ok(Task {
                model: PathBuf::from(model),
                case: case.clone(),
                channels: channels.to_vec(),
                statics_only: extent == "statics",
                accuracy: match extent.strip_prefix(ACCURACY) {
                    Some(number) => Some(number.parse().map_err(|_| USAGE)?),
                    None => None,
                },
            }),
            _ => Err(USAGE.to_owned()),
        }
    }

    /// Computes it here.
    pub(crate) fn compute(&self) -> Result<Probe, String> {
        let case = read_case(&self.model, &self.case)?;
        let model = match self.accuracy {
            // The choice costs some runs of its own; what counts here is the run that it leads to.
            Some(accuracy) => {
                choose_for_accuracy(&case, accuracy, &())
                    .map_err(|error| error.map_or_else(String::new, |error| error.message))?
                    .model
            }
            None => case.model,
        };
        let clock = ThreadTime::now();
        let mut columns = Vec::new();
        for name in &self.channels {
            columns.push(Probe::parts(&model, name)?);
        }
        let mut system = System::new(&model).map_err(|error| error.to_string())?;
        let mut probe = Probe {
            elements: model.lines.iter().map(|line| line.element_count()).sum(),
            assembling_cpu_s: clock.elapsed().as_secs_f64(),
            ..Probe::default()
        };
        let clock = ThreadTime::now();
        if system.wants_tension() {
            let start = settle(&system)?;
            probe.statics_iterations = start.iterations;
            system = start.tightened().map_err(|error| error.to_string())?;
        }
        let start = settle(&system)?;
        probe.statics_cpu_s = clock.elapsed().as_secs_f64();
        probe.statics_iterations += start.iterations;
        if let (false, Some(settings)) = (self.statics_only, &model.dynamics) {
            // With the elements that an accuracy asks for a motion takes some milliseconds, which
            // whatever else the machine does can double.
            let repeats = if self.accuracy.is_some() {
                SHORT_REPEATS
            } else {
                1
            };
            probe.motion_cpu_s = f64::INFINITY;
            for _ in 0..repeats {
                let mut history = History::new(columns.clone());
                let clock = ThreadTime::now();
                let report = simulate(&system, &start, &mut |view| {
                    history.add(view.time(), |channel| view.channel(channel.target));
                    ControlFlow::Continue(())
                })
                .map_err(|error| error.to_string())?;
                probe.motion_cpu_s = probe.motion_cpu_s.min(clock.elapsed().as_secs_f64());
                probe.simulated_s = report.end_time_s;
                probe.steps = report.statistics.steps;
                probe.rejected_steps = report.statistics.rejected_steps;
                probe.iterations = report.statistics.iterations;
                probe.factorisations = report.statistics.factorisations;
                probe.statistics = history.statistics(settings.statistics_window);
            }
        }
        probe.peak_bytes = child::own_peak_bytes();
        Ok(probe)
    }
}

fn settle(system: &System) -> Result<StaticSolution<'_>, String> {
    solve_statics(system, &mut |_| ControlFlow::Continue(())).map_err(|error| error.to_string())
}

/// How often a short motion is computed.
const SHORT_REPEATS: usize = 5;
/// What stands before an accuracy in the arguments of a probe.
const ACCURACY: &str = "accuracy=";
const USAGE: &str =
    "usage: catenix-bench probe MODEL CASE statics|motion|accuracy=SHARE CHANNEL...";

fn read_case(file: &Path, name: &str) -> Result<LoadCase, String> {
    let study = read_study(file).map_err(|errors| errors.to_string())?;
    let mut cases = study.cases.into_iter();
    let found = cases.find(|case| case.name == name);
    found.ok_or_else(|| format!("{}: no case `{name}`", file.display()))
}

/// Values over all steps.
struct History {
    columns: Vec<Vec<Channel>>,
    times: Vec<f64>,
    values: Vec<Vec<f64>>,
    extremes: Extremes,
}

impl History {
    fn new(columns: Vec<Vec<Channel>>) -> History {
        let values = vec![Vec::new(); columns.len()];
        History {
            extremes: Extremes::new(columns.len()),
            columns,
            times: Vec::new(),
            values,
        }
    }

    fn add(&mut self, time: f64, read: impl Fn(&Channel) -> f64) {
        self.times.push(time);
        let mut latest = Vec::with_capacity(self.columns.len());
        for (parts, values) in self.columns.iter().zip(&mut self.values) {
            let value = match parts.as_slice() {
                [one] => read(one),
                parts => parts
                    .iter()
                    .map(|part| read(part).powi(2))
                    .sum::<f64>()
                    .sqrt(),
            };
            values.push(value);
            latest.push(value);
        }
        self.extremes.add(time, &latest);
    }

    fn statistics(&self, window: f64) -> Vec<Statistics> {
        let start = self.times.last().map_or(0.0, |end| end - window);
        let of = |(k, values): (usize, &Vec<f64>)| Statistics {
            min: self.extremes.min[k],
            max: self.extremes.max[k],
            mean: mean_from(&self.times, values, start),
        };
        self.values.iter().enumerate().map(of).collect()
    }
}

/// Mean of the curve through the points from `start` on.
fn mean_from(times: &[f64], values: &[f64], start: f64) -> f64 {
    let (mut area, mut span) = (0.0, 0.0);
    for k in 1..times.len() {
        let (t0, t1) = (times[k - 1].max(start), times[k]);
        if t1 <= t0 {
            continue;
        }
        let slope = (values[k] - values[k - 1]) / (times[k] - times[k - 1]);
        let first = values[k - 1] + slope * (t0 - times[k - 1]);
        area += 0.5 * (first + values[k]) * (t1 - t0);
        span += t1 - t0;
    }
    area / span
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mean_cuts_the_step_that_the_window_begins_in() {
        let (times, values) = ([0.0, 1.0, 3.0], [5.0, 0.0, 4.0]);
        // From t = 2 on the line goes from 2 to 4; round-off only.
        assert!((mean_from(&times, &values, 2.0) - 3.0).abs() < 1e-12);
        // The whole: areas 2.5 and 4 over 3 s.
        assert!((mean_from(&times, &values, -1.0) - 6.5 / 3.0).abs() < 1e-12);
    }
}
