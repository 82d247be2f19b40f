//! Equilibrium paths, read out.

use std::ops::ControlFlow;

use catenix_engine::{PathError, PathPoint, PathReport, System, follow_path};
use catenix_model::all_channels;

use super::model;

/// A path, read out.
pub struct Found {
    /// The points.
    pub points: Vec<PathPoint>,
    /// Per point, by the channels' order.
    pub values: Vec<Vec<f64>>,
    /// Names of the channels.
    pub names: Vec<String>,
    /// What the engine says of the whole.
    pub report: Result<PathReport, PathError>,
}

impl Found {
    /// A channel at every point.
    pub fn channel(&self, name: &str) -> Vec<f64> {
        let index = self.names.iter().position(|found| found == name);
        let index = index.unwrap_or_else(|| panic!("no channel {name} in {:?}", self.names));
        self.values.iter().map(|values| values[index]).collect()
    }

    /// Value of a channel at the first point with this factor.
    pub fn at(&self, factor: f64, name: &str) -> f64 {
        let point = self
            .points
            .iter()
            .position(|point| (point.factor - factor).abs() < 1e-12 * (1.0 + factor.abs()))
            .unwrap_or_else(|| panic!("no point at the factor {factor}"));
        self.channel(name)[point]
    }
}

/// Follows the path of a model.
pub fn follow(text: &str) -> Found {
    let model = model(text);
    let system = System::new(&model).unwrap_or_else(|error| panic!("{error}"));
    let channels = all_channels(&model);
    let mut points = Vec::new();
    let mut values = Vec::new();
    let report = follow_path(
        &system,
        &mut |_| ControlFlow::Continue(()),
        &mut |point, view| {
            points.push(*point);
            let read = channels.iter().map(|channel| view.channel(channel.target));
            values.push(read.collect());
            ControlFlow::Continue(())
        },
    );
    let names = channels.into_iter().map(|channel| channel.name).collect();
    Found {
        points,
        values,
        names,
        report,
    }
}
