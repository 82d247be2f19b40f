//! The numbers that an accuracy is asked of, and their collection while a case runs.

use catenix_engine::StepView;
use catenix_model::{
    Axis, Channel, ChannelTarget, LineQuantity, Model, Reference, Statistic, all_channels,
};
use catenix_results::{Extremes, RangeGraph, WindowStatistics};

/// Snapshots of the lines that a run keeps to see where they bend.
const SNAPSHOTS: f64 = 40.0;
/// Smallest horizontal offset that errors of positions are relative to, over the longest line.
const LEAST_OFFSET: f64 = 1e-3;
/// Smallest range of a tension that its error is relative to, over the largest tension.
const LEAST_RANGE: f64 = 0.05;
/// Smallest bending moment that its error is relative to, over the largest of any line.
const LEAST_MOMENT: f64 = 0.05;

/// A headline result of a case.
#[derive(Debug, Clone, PartialEq)]
pub struct Headline {
    /// Channel or line quantity, and what of it: `hose.end_b.force_x, mean`.
    pub name: String,
    /// Unit of value and scale.
    pub unit: &'static str,
    /// The value.
    pub value: f64,
    /// What an error of it is relative to: for a force the tension, for an offset its length.
    pub scale: f64,
    /// Whether a wanted accuracy holds for it.
    pub steers: bool,
}

/// What a run without a store keeps: statistics of all channels and snapshots of all lines.
pub(crate) struct Collector<'m> {
    model: &'m Model,
    references: &'m [Reference],
    channels: Vec<Channel>,
    values: Vec<f64>,
    extremes: Extremes,
    window: WindowStatistics,
    window_start_s: f64,
    /// Per line: values (quantities x nodes) and their extremes.
    lines: Vec<(Vec<f64>, Extremes)>,
    snapshot_interval_s: f64,
    next_snapshot_s: f64,
    /// Per line: curvature at the nodes, one row per snapshot [1/m].
    curvatures: Vec<Vec<Vec<f64>>>,
}

impl<'m> Collector<'m> {
    pub(crate) fn new(model: &'m Model, references: &'m [Reference]) -> Collector<'m> {
        let mut channels = all_channels(model);
        for reference in references {
            if !channels.contains(&reference.channel) {
                channels.push(reference.channel.clone());
            }
        }
        let (duration, window) = model.dynamics.as_ref().map_or((0.0, 0.0), |dynamics| {
            (dynamics.duration, dynamics.statistics_window)
        });
        let lines = model.lines.iter().map(|line| {
            let size = LineQuantity::ALL.len() * (line.element_count() + 1);
            (vec![0.0; size], Extremes::new(size))
        });
        Collector {
            model,
            references,
            values: vec![0.0; channels.len()],
            extremes: Extremes::new(channels.len()),
            window: WindowStatistics::new(channels.len()),
            window_start_s: (duration - window) * (1.0 - 1e-9),
            lines: lines.collect(),
            snapshot_interval_s: duration / SNAPSHOTS,
            next_snapshot_s: 0.0,
            curvatures: vec![Vec::new(); model.lines.len()],
            channels,
        }
    }

    /// Takes in a state: the static one, or one that a step ended with.
    pub(crate) fn add(&mut self, view: &StepView<'_>) {
        for (value, channel) in self.values.iter_mut().zip(&self.channels) {
            *value = view.channel(channel.target);
        }
        self.extremes.add(view.time(), &self.values);
        if view.time() >= self.window_start_s {
            self.window.add(view.time(), &self.values);
        }
        let snapshot = view.time() >= self.next_snapshot_s;
        if snapshot {
            self.next_snapshot_s = view.time() + self.snapshot_interval_s;
        }
        for (index, (values, extremes)) in self.lines.iter_mut().enumerate() {
            view.line_quantities(index, values);
            extremes.add(view.time(), values);
            if snapshot {
                let nodes = values.len() / LineQuantity::ALL.len();
                let first = LineQuantity::Curvature.index() * nodes;
                self.curvatures[index].push(values[first..first + nodes].to_vec());
            }
        }
    }

    /// Curvature at the nodes of each line, one row per snapshot [1/m].
    pub(crate) fn curvatures(&self) -> &[Vec<Vec<f64>>] {
        &self.curvatures
    }

    /// The headline results of the states so far.
    ///
    /// Bodies give their mean positions or offsets; ends of lines their mean forces and the
    /// extremes and range of their tension; lines their extreme tensions and bending moment; and
    /// whatever the model records beyond the standard channels gives mean and extremes.
    pub(crate) fn headlines(&self) -> Vec<Headline> {
        let mut list = Headlines {
            collector: self,
            window: self.window.range_graph(),
            top: self.most_loaded_end(),
            found: Vec::new(),
        };
        list.add_bodies();
        for line in 0..self.model.lines.len() {
            list.add_line(line);
        }
        for channel in &self.model.output.channels {
            list.add_own(channel);
        }
        for reference in self.references {
            list.add_statistic(&reference.channel, reference.statistic);
        }
        list.found
    }

    /// Line and end with the largest tension of all.
    fn most_loaded_end(&self) -> Option<(usize, usize)> {
        let channels = self.channels.iter().zip(&self.extremes.max);
        let ends = channels.filter_map(|(channel, tension)| match channel.target {
            ChannelTarget::EndTension(line, end) if tension.is_finite() => {
                Some(((line, end), *tension))
            }
            _ => None,
        });
        ends.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(end, _)| end)
    }
}

struct Headlines<'a, 'm> {
    collector: &'a Collector<'m>,
    /// Mean and extremes of each channel over the window (n_channels).
    window: RangeGraph,
    /// Line and end with the largest tension of all.
    top: Option<(usize, usize)>,
    found: Vec<Headline>,
}

/// Behind the name of a line: its smallest effective tension.
pub(super) const SMALLEST_TENSION: &str = ", smallest effective_tension";

impl Headlines<'_, '_> {
    fn push(&mut self, name: String, unit: &'static str, value: f64, scale: f64) {
        let known = self.found.iter().any(|headline| headline.name == name);
        if value.is_finite() && scale > 0.0 && !known {
            self.found.push(Headline {
                name,
                unit,
                value,
                scale,
                steers: true,
            });
        }
    }

    /// A statistic of a channel; a static state has one value, which needs no statistic.
    fn push_statistic(
        &mut self,
        channel: &str,
        statistic: Statistic,
        unit: &'static str,
        value: f64,
        scale: f64,
    ) {
        let name = if self.collector.model.dynamics.is_some() {
            format!("{channel}, {}", statistic.word())
        } else {
            channel.to_owned()
        };
        self.push(name, unit, value, scale);
    }

    fn index(&self, target: ChannelTarget) -> Option<usize> {
        let mut channels = self.collector.channels.iter();
        channels.position(|channel| channel.target == target)
    }

    fn mean(&self, target: ChannelTarget) -> f64 {
        self.index(target).map_or(f64::NAN, |k| self.window.mean[k])
    }

    fn add_bodies(&mut self) {
        let longest = self
            .collector
            .model
            .lines
            .iter()
            .map(|line| line.length())
            .fold(0.0, f64::max);
        for (index, body) in self.collector.model.bodies.iter().enumerate() {
            let (prefix, target): (&str, fn(usize, Axis) -> ChannelTarget) =
                if body.offset_vessel.is_some() {
                    ("offset_", ChannelTarget::BodyOffset)
                } else {
                    ("", ChannelTarget::BodyPosition)
                };
            let position = Axis::ALL.map(|axis| self.mean(target(index, axis)));
            let scale = position[0].hypot(position[1]).max(LEAST_OFFSET * longest);
            for (axis, value) in Axis::ALL.into_iter().zip(position) {
                let name = format!("{}.{prefix}{}", body.name, axis.letter());
                self.push_statistic(&name, Statistic::Mean, "m", value, scale);
            }
        }
    }

    fn add_line(&mut self, line: usize) {
        let model = self.collector.model;
        let name = &model.lines[line].name;
        let extremes = &self.collector.extremes;
        let moves = model.dynamics.is_some();
        let largest_tension = self.largest_end_tension(line);
        for (end, label) in ["end_a", "end_b"].into_iter().enumerate() {
            let Some(tension) = self.index(ChannelTarget::EndTension(line, end)) else {
                continue;
            };
            let force = Axis::ALL.map(|axis| self.mean(ChannelTarget::EndForce(line, end, axis)));
            let (low, high) = (extremes.min[tension], extremes.max[tension]);
            let norm = force.iter().map(|f| f * f).sum::<f64>().sqrt();
            let scale = largest_tension.max(norm);
            if norm == 0.0 {
                continue;
            }
            for (axis, value) in Axis::ALL.into_iter().zip(force) {
                let name = format!("{name}.{label}.force_{}", axis.letter());
                self.push_statistic(&name, Statistic::Mean, "N", value, scale);
            }
            let first_extreme = self.found.len();
            let tension = format!("{name}.{label}.effective_tension");
            self.push_statistic(&tension, Statistic::Min, "N", low, scale);
            self.push_statistic(&tension, Statistic::Max, "N", high, scale);
            // The main load of the system steers; the extremes of a slack hose at its joints hang
            // on how it bends there.
            let main = self.top == Some((line, end));
            self.steer_last(self.found.len() - first_extreme, !moves || main);
            let range = high - low;
            if range > LEAST_RANGE * scale {
                self.push(format!("{tension}, range"), "N", range, range);
                self.steer_last(1, !moves || main);
            }
        }
        let (_, extremes) = &self.collector.lines[line];
        let low = smallest(&extremes.min, LineQuantity::EffectiveTension);
        let high = largest(&extremes.max, LineQuantity::EffectiveTension);
        let scale = low.abs().max(high.abs());
        let first_peak = self.found.len();
        self.push(format!("{name}{SMALLEST_TENSION}"), "N", low, scale);
        let name = |what: &str| format!("{name}, {what}");
        self.push(name("largest effective_tension"), "N", high, scale);
        let moment = largest(&extremes.max, LineQuantity::BendMoment);
        let any_line = self.collector.lines.iter();
        let least = any_line
            .map(|(_, extremes)| LEAST_MOMENT * largest(&extremes.max, LineQuantity::BendMoment))
            .fold(0.0, f64::max);
        self.push(
            name("largest bend_moment"),
            "N m",
            moment,
            moment.max(least),
        );
        // Peaks of a motion along a line are often those of a moment and a place, a slack hose that
        // snaps: they get their estimates, but the mesh is not made for them.
        for peak in &mut self.found[first_peak..] {
            peak.steers = model.dynamics.is_none();
        }
    }

    /// Says of the last `count` results whether they steer.
    fn steer_last(&mut self, count: usize, steers: bool) {
        let first = self.found.len() - count.min(self.found.len());
        for headline in &mut self.found[first..] {
            headline.steers = steers;
        }
    }

    /// The largest tension at either end of a line [N]; 0 where it has none.
    fn largest_end_tension(&self, line: usize) -> f64 {
        let extremes = &self.collector.extremes;
        let ends = [0, 1].map(|end| self.index(ChannelTarget::EndTension(line, end)));
        let of_end = |k: usize| extremes.min[k].abs().max(extremes.max[k].abs());
        ends.into_iter().flatten().map(of_end).fold(0.0, f64::max)
    }

    /// A channel that the model asks for beyond the standard ones.
    fn add_own(&mut self, channel: &Channel) {
        for statistic in [Statistic::Mean, Statistic::Min, Statistic::Max] {
            self.add_statistic(channel, statistic);
        }
    }

    fn add_statistic(&mut self, channel: &Channel, statistic: Statistic) {
        let Some(k) = self.index(channel.target) else {
            return;
        };
        let extremes = &self.collector.extremes;
        let (low, high) = (extremes.min[k], extremes.max[k]);
        let value = match statistic {
            Statistic::Mean => self.window.mean[k],
            Statistic::Min => low,
            Statistic::Max => high,
        };
        let scale = low.abs().max(high.abs());
        self.push_statistic(&channel.name, statistic, channel.unit, value, scale);
    }
}

/// The smallest number of a quantity among values along a line (quantities x nodes).
fn smallest(values: &[f64], quantity: LineQuantity) -> f64 {
    part(values, quantity).fold(f64::NAN, f64::min)
}

/// The largest number of a quantity among values along a line (quantities x nodes).
fn largest(values: &[f64], quantity: LineQuantity) -> f64 {
    part(values, quantity).fold(f64::NAN, f64::max)
}

fn part(values: &[f64], quantity: LineQuantity) -> impl Iterator<Item = f64> {
    let nodes = values.len() / LineQuantity::ALL.len();
    let row = &values[quantity.index() * nodes..(quantity.index() + 1) * nodes];
    row.iter().copied()
}
