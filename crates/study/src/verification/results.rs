//! Computes what the comparisons need, each thing once.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use catenix_engine::{
    ModeKind, StaticSolution, System, SystemError, find_modes, follow_path, simulate, solve_statics,
};
use catenix_model::{FormulationKind, Line, LoadCase, Model, StepControl, Study, all_channels};

use catenix_results::{Curve, Extremes, OutputTimes};

use super::spec::{Analysis, Origin, Value};
use crate::case::flow;

/// One computation.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Computation {
    pub analysis: Analysis,
    pub load_case: Option<String>,
    /// Into how many each element is split.
    pub split: usize,
    /// Constant step [s]; `None`: that of the model file.
    pub step_s: Option<f64>,
}

/// Why a result is missing.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Missing {
    /// The formulation cannot do what the model asks for, and says so.
    Refused(String),
    /// Something went wrong.
    Failed(String),
}

impl From<String> for Missing {
    fn from(text: String) -> Missing {
        Missing::Failed(text)
    }
}

/// Rows of everything that changes along an analysis.
#[derive(Debug, Clone, Default)]
struct Table {
    /// Name and unit of each column.
    names: Vec<(String, &'static str)>,
    /// (rows x columns): output times, points of the path, or the static state.
    rows: Vec<Vec<f64>>,
    /// The same between the rows, for extremes: every step.
    steps: Vec<Vec<f64>>,
    /// Frequencies that count, in order [Hz].
    frequencies_hz: Vec<f64>,
    /// Frequencies of rotations about the own axis, in order [Hz].
    rotations_hz: Vec<f64>,
    /// Factors of limit points and of bifurcations.
    events: BTreeMap<&'static str, Vec<f64>>,
}

/// Results of one study, computed when they are asked for.
pub(super) struct Results<'a> {
    study: &'a Study,
    formulation: FormulationKind,
    stop: &'a dyn Fn() -> bool,
    computed: BTreeMap<String, Result<Table, Missing>>,
}

impl<'a> Results<'a> {
    pub(super) fn new(
        study: &'a Study,
        formulation: FormulationKind,
        stop: &'a dyn Fn() -> bool,
    ) -> Results<'a> {
        Results {
            study,
            formulation,
            stop,
            computed: BTreeMap::new(),
        }
    }

    /// A number and its unit.
    pub(super) fn value(
        &mut self,
        computation: &Computation,
        origin: &Origin,
    ) -> Result<(f64, &'static str), Missing> {
        let formulation = self.formulation;
        let table = self.table(computation)?;
        let (word, number) = match origin.result.split_once(' ') {
            Some((word, number)) => (word, number.parse::<usize>().unwrap_or(0)),
            None => ("", 0),
        };
        let pick = |list: Option<&Vec<f64>>, unit| match list.and_then(|l| l.get(number - 1)) {
            Some(value) => Ok((value + origin.offset, unit)),
            None => Err(Missing::Failed(format!("there is no {word} {number}"))),
        };
        match (computation.analysis, word) {
            (Analysis::Modes, "frequency") if number > 0 => {
                return pick(Some(&table.frequencies_hz), "Hz");
            }
            (Analysis::Modes, "rotation") if !formulation.has_torsion() => {
                return Err(Missing::Refused("lumped mass has no torsion".to_owned()));
            }
            (Analysis::Modes, "rotation") if number > 0 => {
                return pick(Some(&table.rotations_hz), "Hz");
            }
            (Analysis::Path, "limit" | "bifurcation") if number > 0 => {
                return pick(table.events.get(word), "");
            }
            _ => {}
        }
        let (value, unit) = table.value(computation.analysis, origin)?;
        if value.is_nan() && !formulation.has_torsion() {
            let text = format!("lumped mass has no `{}`", origin.result);
            return Err(Missing::Refused(text));
        }
        Ok((value + origin.offset, unit))
    }

    /// A column and its unit: a channel, `time` or `factor`.
    pub(super) fn column(
        &mut self,
        computation: &Computation,
        name: &str,
    ) -> Result<(Vec<f64>, &'static str), Missing> {
        let table = self.table(computation)?;
        let k = table.index(name)?;
        let values = table.rows.iter().map(|row| row[k]).collect();
        Ok((values, table.names[k].1))
    }

    /// Elements of all lines.
    pub(super) fn element_count(&self, computation: &Computation) -> Result<usize, Missing> {
        let model = self.model(computation)?;
        Ok(model.lines.iter().map(Line::element_count).sum())
    }

    fn table(&mut self, computation: &Computation) -> Result<&Table, Missing> {
        let model = self.model(computation)?;
        let stop = self.stop;
        let key = format!("{computation:?}");
        let table = match self.computed.entry(key) {
            Entry::Occupied(known) => known.into_mut(),
            Entry::Vacant(place) => place.insert(compute(&model, computation.analysis, stop)),
        };
        table.as_ref().map_err(Clone::clone)
    }

    fn model(&self, computation: &Computation) -> Result<Model, String> {
        let case = load_case(self.study, computation.load_case.as_deref())?;
        let mut model = case.model.clone();
        model.formulation = self.formulation;
        for section in model.lines.iter_mut().flat_map(|line| &mut line.sections) {
            let parts = computation.split.max(1);
            let lengths = section.element_lengths.iter();
            section.element_lengths = lengths
                .flat_map(|length| std::iter::repeat_n(length / parts as f64, parts))
                .collect();
        }
        if let (Some(step), Some(dynamics)) = (computation.step_s, &mut model.dynamics) {
            dynamics.step = StepControl::Fixed(step);
        }
        Ok(model)
    }
}

/// A load case by its name, or the first.
pub(super) fn load_case<'s>(study: &'s Study, name: Option<&str>) -> Result<&'s LoadCase, String> {
    let mut cases = study.cases.iter();
    let case = match name {
        None => cases.next(),
        Some(name) => cases.find(|case| case.name == name),
    };
    case.ok_or_else(|| {
        let name = name.unwrap_or_default();
        format!("the model file has no load case '{name}'")
    })
}

fn compute(model: &Model, analysis: Analysis, stop: &dyn Fn() -> bool) -> Result<Table, Missing> {
    let text = |error: &dyn std::error::Error| error.to_string();
    let system = System::new(model).map_err(|error| match (model.formulation, &error) {
        (FormulationKind::Dem, _) => Missing::Failed(text(&error)),
        (_, SystemError::Unusable { .. }) => Missing::Refused(text(&error)),
        _ => Missing::Failed(text(&error)),
    })?;
    let channels = all_channels(model);
    let mut table = Table {
        names: channels.iter().map(|c| (c.name.clone(), c.unit)).collect(),
        ..Table::default()
    };
    if analysis == Analysis::Path {
        table.names.push(("factor".to_owned(), ""));
        follow_path(&system, &mut |_| flow(stop()), &mut |point, view| {
            let mut row: Vec<f64> = channels.iter().map(|c| view.channel(c.target)).collect();
            row.push(point.factor);
            table.rows.push(row);
            if let Some(event) = point.event {
                let name = match event {
                    catenix_engine::PathEvent::Limit => "limit",
                    catenix_engine::PathEvent::Bifurcation => "bifurcation",
                };
                table.events.entry(name).or_default().push(point.factor);
            }
            flow(stop())
        })
        .map_err(|error| text(&error))?;
        return Ok(table);
    }
    let system = if system.wants_tension() {
        let start = settle(&system, stop)?;
        start.tightened().map_err(|error| text(&error))?
    } else {
        system
    };
    let start = settle(&system, stop)?;
    match analysis {
        Analysis::Statics => {
            let view = start.view();
            let row = channels.iter().map(|c| view.channel(c.target));
            table.rows.push(row.collect());
        }
        Analysis::Modes => {
            let modes = find_modes(&system, &start, &model.modes, &mut |_| flow(stop()))
                .map_err(|error| text(&error))?;
            table.frequencies_hz = modes
                .modes
                .iter()
                .filter(|mode| !mode.equals_previous && !mode.is_rotation())
                .map(|mode| mode.frequency_hz())
                .collect();
            table.rotations_hz = modes
                .modes
                .iter()
                .filter(|mode| mode.is_rotation() && mode.kind == ModeKind::Vibration)
                .map(|mode| mode.frequency_hz())
                .collect();
        }
        Analysis::Dynamics | Analysis::Path => {
            for (name, unit) in [("time", "s"), ("energy", "J")] {
                table.names.push((name.to_owned(), unit));
            }
            for (name, unit) in [("momentum", "kg m/s"), ("angular_momentum", "kg m2/s")] {
                for _ in 0..3 {
                    table.names.push((name.to_owned(), unit));
                }
            }
            let report = simulate(&system, &start, &mut |view| {
                let mut row: Vec<f64> = channels.iter().map(|c| view.channel(c.target)).collect();
                let momentum = view.momentum();
                row.push(view.time());
                row.push(view.energy().stored());
                row.extend(momentum.linear.iter());
                row.extend(momentum.angular.iter());
                table.steps.push(row);
                flow(stop())
            })
            .map_err(|error| text(&error))?;
            table.rows = at_output_times(&table.steps, channels.len(), model);
            if report.interrupted {
                return Err(Missing::Failed("interrupted".to_owned()));
            }
        }
    }
    Ok(table)
}

fn settle<'a>(system: &'a System, stop: &dyn Fn() -> bool) -> Result<StaticSolution<'a>, String> {
    solve_statics(system, &mut |_| flow(stop())).map_err(|error| error.to_string())
}

/// Rows at the output times out of the rows of all steps, which have the time in column `time`.
fn at_output_times(steps: &[Vec<f64>], time: usize, model: &Model) -> Vec<Vec<f64>> {
    let columns = steps.first().map_or(0, Vec::len);
    let duration = model.dynamics.as_ref().map_or(0.0, |d| d.duration);
    let mut times = OutputTimes::new(model.output.interval, duration);
    let mut curve = Curve::new(columns);
    let mut rows = Vec::new();
    let mut known = f64::NEG_INFINITY;
    for step in steps {
        let latest = step[time];
        curve.push(latest, step);
        // A stretch is known when the step after it is, and the last one at the end.
        if latest >= duration * (1.0 - 1e-9) {
            known = latest;
        }
        while let Some(at) = times.due(known, latest) {
            let mut row = vec![0.0; columns];
            curve.at(at, &mut row);
            row[time] = at;
            rows.push(row);
        }
        known = latest;
    }
    rows
}

impl Table {
    fn index(&self, name: &str) -> Result<usize, String> {
        self.names
            .iter()
            .position(|(known, _)| known == name)
            .ok_or_else(|| format!("there is no result '{name}'"))
    }

    fn value(&self, analysis: Analysis, origin: &Origin) -> Result<(f64, &'static str), String> {
        let k = self.index(&origin.result)?;
        let unit = self.names[k].1;
        let missing = || format!("'{}' has no value there", origin.result);
        match analysis {
            Analysis::Path => {
                let factor = self.index("factor")?;
                let at = origin.at_factor.unwrap_or(f64::NAN);
                let row = self.rows.iter().find(|row| (row[factor] - at).abs() < 1e-9);
                row.map(|row| (row[k], unit)).ok_or_else(missing)
            }
            Analysis::Statics => {
                let row = self.rows.first();
                row.map(|row| (row[k], unit)).ok_or_else(missing)
            }
            Analysis::Modes => Err(missing()),
            Analysis::Dynamics => {
                let value = origin.value.ok_or_else(|| {
                    format!(
                        "'{}' needs a `value`: mean, min, max, last or drift",
                        origin.result
                    )
                })?;
                let time = self.index("time")?;
                let since = |row: &&Vec<f64>| row[time] >= origin.since - 1e-9;
                let found = match value {
                    Value::Min | Value::Max => {
                        let mut extremes = Extremes::new(1);
                        for row in self.steps.iter().filter(since) {
                            extremes.add(row[time], &[row[k]]);
                        }
                        let [min, max] = [extremes.min[0], extremes.max[0]];
                        Some(if value == Value::Min { min } else { max })
                    }
                    Value::Last => self.steps.last().map(|row| row[k]),
                    Value::Mean => self.mean(k, time, origin.since),
                    Value::Drift => self.drift(&origin.result, time, origin.since),
                };
                let unit = if value == Value::Drift { "" } else { unit };
                found.map(|value| (value, unit)).ok_or_else(missing)
            }
        }
    }

    /// Mean over time since a time, by the trapezoidal rule over the steps.
    fn mean(&self, k: usize, time: usize, since: f64) -> Option<f64> {
        // The start may lie inside a step; there an output time is likely.
        let start = self.rows.iter().find(|row| row[time] >= since - 1e-9);
        let steps = self.steps.iter();
        let rows: Vec<&Vec<f64>> = start
            .into_iter()
            .chain(steps.filter(|row| Some(row[time]) > start.map(|start| start[time] + 1e-9)))
            .collect();
        let integral: f64 = rows
            .windows(2)
            .map(|pair| 0.5 * (pair[0][k] + pair[1][k]) * (pair[1][time] - pair[0][time]))
            .sum();
        Some(integral / (rows.last()?[time] - rows.first()?[time]))
    }

    /// Largest change of a number or vector since a time, over its size then.
    fn drift(&self, name: &str, time: usize, since: f64) -> Option<f64> {
        let columns: Vec<usize> = (0..self.names.len())
            .filter(|&k| self.names[k].0 == name)
            .collect();
        let rows = self.steps.iter().filter(|row| row[time] >= since - 1e-9);
        let mut vectors = rows.map(|row| columns.iter().map(|&k| row[k]).collect::<Vec<f64>>());
        let first = vectors.next()?;
        let size = norm(&first);
        let change = vectors.map(|v| {
            let difference: Vec<f64> = v.iter().zip(&first).map(|(a, b)| a - b).collect();
            norm(&difference)
        });
        Some(change.fold(0.0, f64::max) / size)
    }
}

fn norm(v: &[f64]) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}
