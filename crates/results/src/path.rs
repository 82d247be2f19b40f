//! Equilibrium paths: the factor on the loads and the channels at every point.
//!
//! The keys are a public interface, described in docs/cli.md.

use std::fmt::Write;

use catenix_model::{Channel, LoadCase, all_channels};
use indexmap::IndexMap;
use serde::Serialize;

use crate::{CaseError, Sample, Status};

/// The paths of a study.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StudyPaths {
    /// Version of Catenix that computed them.
    pub catenix_version: String,
    /// Title of the model file.
    pub title: String,
    /// The study's remark.
    pub note: String,
    /// Model file, as given.
    pub model_file: String,
    /// SHA-256 of the model file's text, in hexadecimal.
    pub model_sha256: String,
    /// How far the study came.
    pub status: Status,
    /// Load cases by name, in file order.
    pub cases: IndexMap<String, CasePath>,
}

/// The path of one load case; all lists have one entry per point.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CasePath {
    /// One sentence; may be empty.
    pub description: String,
    /// How far the case came.
    pub status: Status,
    /// Why it failed; the points until then are kept.
    pub error: Option<CaseError>,
    /// Why the path ended: `range`, `channel` or `points`; null where it did not.
    pub end: Option<&'static str>,
    /// Names of the loads that the factor scales.
    pub loads: Vec<String>,
    /// Factor on these loads.
    pub factor: Vec<f64>,
    /// Distance along the path, in its scale.
    pub distance: Vec<f64>,
    /// `limit`, `bifurcation` or null.
    pub event: Vec<Option<&'static str>>,
    /// Number of motions in which the equilibrium is unstable.
    pub unstable: Vec<usize>,
    /// Newton iterations from the point before.
    pub iterations: Vec<usize>,
    /// Largest residual force [N].
    pub residual_n: Vec<f64>,
    /// Channels by name.
    pub channels: IndexMap<String, PathChannel>,
    /// Channels that the model file asks for, or else the positions of bodies.
    #[serde(skip)]
    pub main_channels: Vec<String>,
    /// Processor time of the case [s].
    pub cpu_seconds: Option<f64>,
}

/// A channel along a path.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PathChannel {
    /// Unit of the values.
    pub unit: &'static str,
    /// Value at every point; null where there is none.
    pub values: Vec<f64>,
}

/// What the solver says of a point, beside its state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathPointFacts {
    /// Factor on the loads.
    pub factor: f64,
    /// Distance along the path.
    pub distance: f64,
    /// `limit` or `bifurcation`.
    pub event: Option<&'static str>,
    /// Number of unstable motions.
    pub unstable: usize,
    /// Newton iterations.
    pub iterations: usize,
    /// Largest residual force [N].
    pub residual_n: f64,
}

impl CasePath {
    /// A path without points.
    pub fn new(case: &LoadCase) -> Self {
        let model = &case.model;
        let columns = all_channels(model).into_iter().map(|channel| {
            let column = PathChannel {
                unit: channel.unit,
                values: Vec::new(),
            };
            (channel.name, column)
        });
        let channels: IndexMap<String, PathChannel> = columns.collect();
        let asked = model.output.channels.iter();
        let mut main_channels: Vec<String> = asked.map(|channel| channel.name.clone()).collect();
        if let Some(stop) = model.path.as_ref().and_then(|path| path.stop.as_ref())
            && !main_channels.contains(&stop.channel.name)
        {
            main_channels.push(stop.channel.name.clone());
        }
        if main_channels.is_empty() {
            let axes = ["x", "y", "z"];
            let bodies = model.bodies.iter();
            main_channels = bodies
                .flat_map(|body| axes.map(|axis| format!("{}.{axis}", body.name)))
                .collect();
        }
        let loads = model.path.iter().flat_map(|path| &path.loads);
        CasePath {
            description: case.description.clone(),
            status: Status::Pending,
            error: None,
            end: None,
            loads: loads.map(|&load| model.loads[load].name.clone()).collect(),
            factor: Vec::new(),
            distance: Vec::new(),
            event: Vec::new(),
            unstable: Vec::new(),
            iterations: Vec::new(),
            residual_n: Vec::new(),
            channels,
            main_channels,
            cpu_seconds: None,
        }
    }

    /// Adds a point; `channels` are those of [`all_channels`], in their order.
    pub fn push(&mut self, facts: &PathPointFacts, channels: &[Channel], sample: &impl Sample) {
        self.factor.push(facts.factor);
        self.distance.push(facts.distance);
        self.event.push(facts.event);
        self.unstable.push(facts.unstable);
        self.iterations.push(facts.iterations);
        self.residual_n.push(facts.residual_n);
        for (column, channel) in self.channels.values_mut().zip(channels) {
            column.values.push(sample.channel(channel.target));
        }
    }
}

impl StudyPaths {
    /// All points of all cases as comma-separated values, one row per point; the names of the
    /// columns carry their unit in brackets.
    pub fn to_csv(&self) -> String {
        let mut text = "case,factor [-],distance [-],event,unstable,residual [N]".to_owned();
        // Cases have the same lines and bodies; where one has more, its columns are added.
        let mut columns: IndexMap<&str, &str> = IndexMap::new();
        for case in self.cases.values() {
            let named = case.channels.iter();
            columns.extend(named.map(|(name, column)| (name.as_str(), column.unit)));
        }
        for (name, unit) in &columns {
            let _ = write!(text, ",{name} [{unit}]");
        }
        text.push('\n');
        for (name, case) in &self.cases {
            for (k, factor) in case.factor.iter().enumerate() {
                let event = case.event[k].unwrap_or_default();
                let _ = write!(
                    text,
                    "{name},{factor},{},{event},{},{}",
                    case.distance[k], case.unstable[k], case.residual_n[k]
                );
                for column in columns.keys() {
                    text.push(',');
                    let value = case.channels.get(*column).map(|column| column.values[k]);
                    if let Some(value) = value.filter(|value| value.is_finite()) {
                        let _ = write!(text, "{value}");
                    }
                }
                text.push('\n');
            }
        }
        text
    }

    /// The channel that is drawn where none is named: the first main one.
    pub fn default_channel(&self) -> Option<&str> {
        let mut names = self.cases.values().flat_map(|case| &case.main_channels);
        names.next().map(String::as_str)
    }
}
