//! What the engine's integration tests share: from the text of a model file to its results.

#![allow(dead_code, reason = "every test file uses another part of this module")]

pub mod path;
pub mod sea_trial;

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::path::Path;

use catenix_engine::{
    DynamicsReport, Modes, StaticSolution, StepView, System, find_modes, simulate, solve_statics,
};
use catenix_model::file::parse_study;
use catenix_model::{Channel, LineQuantity, ModeRange, ModeSettings, Model, Study, all_channels};

/// Gravity of all test models [m/s2].
pub const G: f64 = 9.80665;
/// Density of the water of all test models that give none [kg/m3].
pub const WATER: f64 = 1025.0;

/// Reads a model file from its text. Steps end on output times, so that runs are read there.
pub fn study(text: &str) -> Study {
    let mut study = parse_study(text, "test.toml", Path::new(""))
        .unwrap_or_else(|errors| panic!("the model file of this test is wrong:\n{errors}\n{text}"));
    for case in &mut study.cases {
        case.model.output.interpolate = false;
    }
    study
}

/// The only case of a model file.
pub fn model(text: &str) -> Model {
    study(text).cases.remove(0).model
}

/// The model of a case by its name.
pub fn model_of_case(text: &str, case: &str) -> Model {
    let cases = study(text).cases;
    let found = cases.into_iter().find(|found| found.name == case);
    found.expect("the case is in the file").model
}

/// Every quantity at the nodes of one line, at one time.
#[derive(Debug, Clone)]
pub struct Fields {
    values: Vec<f64>,
}

impl Fields {
    fn read(view: &StepView<'_>, line: usize, nodes: usize) -> Fields {
        let mut values = vec![0.0; nodes * LineQuantity::ALL.len()];
        view.line_quantities(line, &mut values);
        Fields { values }
    }

    /// One quantity at all nodes, end A to end B (n_elements + 1).
    pub fn get(&self, quantity: LineQuantity) -> &[f64] {
        let nodes = self.values.len() / LineQuantity::ALL.len();
        &self.values[quantity.index() * nodes..(quantity.index() + 1) * nodes]
    }

    /// All values as bits, for comparisons that take NaN for equal to itself.
    pub fn bits(&self) -> Vec<u64> {
        self.values.iter().map(|value| value.to_bits()).collect()
    }

    /// Position of a node, global (3) [m].
    pub fn position(&self, node: usize) -> [f64; 3] {
        [LineQuantity::X, LineQuantity::Y, LineQuantity::Z].map(|axis| self.get(axis)[node])
    }

    /// Length of the polygon through the nodes [m].
    pub fn polygon_length(&self) -> f64 {
        let nodes = self.get(LineQuantity::X).len();
        (1..nodes)
            .map(|node| distance(self.position(node), self.position(node - 1)))
            .sum()
    }
}

/// Distance of two points [m].
pub fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt()
}

/// A static solution, read out.
#[derive(Debug, Clone)]
pub struct Statics {
    /// Channels by name.
    pub values: BTreeMap<String, f64>,
    /// Per line.
    pub fields: Vec<Fields>,
    /// Unstretched distance of the nodes from end A, per line [m].
    pub arc_length: Vec<Vec<f64>>,
    /// Largest residual force over the reference force [-].
    pub residual: f64,
    /// Newton iterations.
    pub iterations: usize,
    /// Remarks for the user.
    pub warnings: Vec<String>,
}

impl Statics {
    /// A channel by its name.
    pub fn get(&self, channel: &str) -> f64 {
        *self.values.get(channel).unwrap_or_else(|| {
            panic!(
                "no channel '{channel}' among {:?}",
                self.values.keys().collect::<Vec<_>>()
            )
        })
    }

    /// A vector of channels, `<prefix>x` to `<prefix>z`.
    pub fn vector(&self, prefix: &str) -> [f64; 3] {
        ["x", "y", "z"].map(|axis| self.get(&format!("{prefix}{axis}")))
    }
}

/// A simulation, read out.
#[derive(Debug, Clone)]
pub struct Run {
    /// Where it started.
    pub statics: Statics,
    /// Output times [s].
    pub time: Vec<f64>,
    /// Channels at the output times, by name.
    pub values: BTreeMap<String, Vec<f64>>,
    /// Per line, at the end.
    pub fields: Vec<Fields>,
    /// The engine's own report.
    pub report: DynamicsReport,
    /// Largest residual of any step over the reference force [-].
    pub residual: f64,
}

impl Run {
    /// History of a channel.
    pub fn history(&self, channel: &str) -> &[f64] {
        self.values
            .get(channel)
            .unwrap_or_else(|| panic!("no channel '{channel}'"))
    }

    /// Last value of a channel.
    pub fn last(&self, channel: &str) -> f64 {
        self.history(channel)[self.time.len() - 1]
    }

    /// Values of a channel from a time on.
    pub fn since(&self, channel: &str, time: f64) -> &[f64] {
        let first = self.time.partition_point(|&t| t < time - 1e-6);
        &self.history(channel)[first..]
    }

    /// Mean of a channel from a time on.
    pub fn mean_since(&self, channel: &str, time: f64) -> f64 {
        let values = self.since(channel, time);
        values.iter().sum::<f64>() / values.len() as f64
    }

    /// Smallest and largest value of a channel from a time on.
    pub fn range_since(&self, channel: &str, time: f64) -> (f64, f64) {
        range(self.since(channel, time))
    }

    /// Every run ends where it should, with finite results, small residuals and a closed energy
    /// account.
    ///
    /// `imbalance` is 1e-3 for moving systems: steps that end on outputs every 0.1 s leave 7e-4 at
    /// most in what these tests do, and mostly under 1e-4.
    pub fn assert_sound(&self, duration: f64, imbalance: f64) {
        assert!(
            (self.report.end_time_s - duration).abs() < 1e-6 * duration,
            "ends at {} s",
            self.report.end_time_s
        );
        for (name, values) in &self.values {
            assert!(values.iter().all(|v| v.is_finite()), "{name} is not finite");
        }
        // The default of [statics], and ten times that of [dynamics]: docs/theory/solver.md,
        // eq. (7a), for steps that control their error.
        assert!(self.statics.residual <= 1e-7, "{}", self.statics.residual);
        assert!(self.residual <= 1e-4, "residual {:.1e}", self.residual);
        let energy = self.report.energy;
        assert!(
            energy.imbalance.abs() < imbalance,
            "energy imbalance {:.2e} over {imbalance:.0e}: {energy:?}",
            energy.imbalance
        );
    }
}

/// Smallest and largest of some values.
pub fn range(values: &[f64]) -> (f64, f64) {
    let start = (f64::INFINITY, f64::NEG_INFINITY);
    values
        .iter()
        .fold(start, |(low, high), &v| (low.min(v), high.max(v)))
}

/// Asserts that two numbers agree within `tolerance`, with both in the message.
#[track_caller]
pub fn assert_near(what: &str, found: f64, expected: f64, tolerance: f64) {
    assert!(
        (found - expected).abs() <= tolerance,
        "{what}: {found} instead of {expected} (off by {:.3e}, allowed {tolerance:.1e})",
        found - expected
    );
}

/// The system of a model, which knows the tension of its equilibrium where it wants to.
pub fn system(model: &Model) -> System {
    let system = System::new(model).unwrap_or_else(|error| panic!("{error}"));
    if system.wants_tension() {
        settle(&system)
            .tightened()
            .unwrap_or_else(|error| panic!("{error}"))
    } else {
        system
    }
}

/// The equilibrium of a system.
pub fn settle(system: &System) -> StaticSolution<'_> {
    solve_statics(system, &mut |_| ControlFlow::Continue(()))
        .unwrap_or_else(|error| panic!("{error}"))
}

/// Solves the statics of a model.
pub fn statics(model: &Model) -> Statics {
    let system = system(model);
    read_statics(&system, &settle(&system))
}

fn read_statics(system: &System, solution: &StaticSolution<'_>) -> Statics {
    let model = system.model();
    let view = solution.view();
    let read = |channel: &Channel| (channel.name.clone(), view.channel(channel.target));
    let lines = 0..model.lines.len();
    Statics {
        values: all_channels(model).iter().map(read).collect(),
        fields: lines
            .clone()
            .map(|line| Fields::read(&view, line, system.arc_length(line).len()))
            .collect(),
        arc_length: lines.map(|line| system.arc_length(line).to_vec()).collect(),
        residual: solution.residual_n / system.reference_force(),
        iterations: solution.iterations,
        warnings: solution.warnings.clone(),
    }
}

/// Solves statics and dynamics of a model.
pub fn run(model: &Model) -> Run {
    let system = system(model);
    let start = settle(&system);
    let channels = all_channels(model);
    let mut values: Vec<Vec<f64>> = vec![Vec::new(); channels.len()];
    let mut time = Vec::new();
    let mut fields = Vec::new();
    let duration = model.dynamics.as_ref().map_or(0.0, |d| d.duration);
    let report = simulate(&system, &start, &mut |view| {
        if view.at_output_time() {
            time.push(view.time());
            for (list, channel) in values.iter_mut().zip(&channels) {
                list.push(view.channel(channel.target));
            }
        }
        if view.time() > duration * (1.0 - 1e-9) {
            fields = (0..model.lines.len())
                .map(|line| Fields::read(view, line, system.arc_length(line).len()))
                .collect();
        }
        ControlFlow::Continue(())
    })
    .unwrap_or_else(|error| panic!("{error}"));
    let names = channels.into_iter().map(|channel| channel.name);
    Run {
        statics: read_statics(&system, &start),
        time,
        values: names.zip(values).collect(),
        fields,
        report,
        residual: report.statistics.largest_residual_n / system.reference_force(),
    }
}

/// Sag parameter a of a catenary (horizontal tension over weight per length) from the span and
/// the length of a symmetric hanging line: length = 2 a sinh(span / 2 a), by bisection [m].
pub fn catenary_parameter(span: f64, length: f64) -> f64 {
    let (mut low, mut high) = (1e-6f64, 700.0f64);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        // sinh(x) / x rises with x = span / 2 a.
        if middle.sinh() / middle < length / span {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * span / low
}

/// The lowest modes about the equilibrium of a model, with added mass where it has any.
pub fn lowest_modes(model: &Model, count: usize) -> Modes<'static> {
    let settings = ModeSettings {
        range: ModeRange::Lowest(count),
        added_mass: true,
    };
    modes(model, &settings)
}

/// The modes about the equilibrium of a model. The system is leaked: a test is short.
pub fn modes(model: &Model, settings: &ModeSettings) -> Modes<'static> {
    let system: &'static System = Box::leak(Box::new(system(model)));
    find_modes(system, &settle(system), settings, &mut |_| {
        ControlFlow::Continue(())
    })
    .unwrap_or_else(|error| panic!("{error}"))
}
