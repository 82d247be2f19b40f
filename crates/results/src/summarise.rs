//! Makes the summary of a case out of statistics, wherever these come from.

use catenix_model::{Axis, LineQuantity, Statistic};
use serde::{Deserialize, Serialize};

use crate::{
    BodySummary, CaseSummary, Comparison, EndSummary, Extent, Extremes, LineSummary, Located,
    Status,
};

/// What a summary needs to know about a case besides its results; kept in the store, so that the
/// summary of a killed run can still be made.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct CaseLayout {
    pub(crate) description: String,
    pub(crate) window_s: f64,
    /// Name of each body and of the vessel that its offset is taken against.
    pub(crate) bodies: Vec<(String, Option<String>)>,
    pub(crate) lines: Vec<LineLayout>,
    pub(crate) references: Vec<ReferenceLayout>,
}

/// A line in [`CaseLayout`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct LineLayout {
    pub(crate) name: String,
    pub(crate) length_m: f64,
    pub(crate) elements: usize,
}

/// A reference in [`CaseLayout`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct ReferenceLayout {
    pub(crate) channel: String,
    pub(crate) statistic: Statistic,
    pub(crate) unit: String,
    pub(crate) low: f64,
    pub(crate) high: f64,
    pub(crate) source: String,
}

/// Where a summary takes its statistics from.
pub(crate) trait StatisticsSource {
    /// Mean over the window and extremes over the run of a channel; `None` when there are none.
    fn channel(&self, name: &str) -> Option<Extent>;
    /// Arc length of the nodes of a line and extremes over the run of a quantity there; `None` when
    /// there are none.
    fn line(&self, line: &str, quantity: LineQuantity) -> Option<(Vec<f64>, Extremes)>;
}

impl CaseSummary {
    /// Fills bodies, lines and comparisons from statistics.
    pub(crate) fn fill(&mut self, layout: &CaseLayout, source: &dyn StatisticsSource) {
        self.description = layout.description.clone();
        self.bodies = layout
            .bodies
            .iter()
            .map(|(name, vessel)| (name.clone(), body_summary(name, vessel, source)))
            .collect();
        self.lines = layout
            .lines
            .iter()
            .map(|line| (line.name.clone(), line_summary(line, source)))
            .collect();
        self.references = layout
            .references
            .iter()
            .map(|reference| comparison(reference, source))
            .collect();
        if self.status != Status::Complete {
            // References are about the whole motion, not about a part of it.
            for comparison in &mut self.references {
                comparison.computed = None;
                comparison.difference = None;
            }
        }
    }
}

fn mean(source: &dyn StatisticsSource, channel: &str) -> Option<f64> {
    source
        .channel(channel)
        .map(|extent| extent.mean)
        .filter(|mean| mean.is_finite())
}

fn body_summary(name: &str, vessel: &Option<String>, source: &dyn StatisticsSource) -> BodySummary {
    let position = |axis: Axis| mean(source, &format!("{name}.{}", axis.letter()));
    let offset = |axis: Axis| mean(source, &format!("{name}.offset_{}", axis.letter()));
    BodySummary {
        offset_vessel: vessel.clone(),
        offset_x_m: offset(Axis::X),
        offset_y_m: offset(Axis::Y),
        offset_z_m: offset(Axis::Z),
        x_m: position(Axis::X),
        y_m: position(Axis::Y),
        z_m: position(Axis::Z),
        tilt_deg: mean(source, &format!("{name}.tilt")),
    }
}

fn line_summary(line: &LineLayout, source: &dyn StatisticsSource) -> LineSummary {
    let end = |label: &str| {
        let get = |quantity: &str| {
            source
                .channel(&format!("{}.{label}.{quantity}", line.name))
                .unwrap_or(Extent::NONE)
        };
        EndSummary {
            force_x_n: get("force_x"),
            force_y_n: get("force_y"),
            force_z_n: get("force_z"),
            effective_tension_n: get("effective_tension"),
            declination_deg: get("declination"),
        }
    };
    let tension = source.line(&line.name, LineQuantity::EffectiveTension);
    let largest = |quantity| {
        let (arc_length, extremes) = source.line(&line.name, quantity)?;
        locate(&arc_length, &extremes.max, f64::max)
    };
    LineSummary {
        length_m: line.length_m,
        elements: line.elements,
        end_a: end("end_a"),
        end_b: end("end_b"),
        min_effective_tension_n: tension
            .as_ref()
            .and_then(|(arc_length, extremes)| locate(arc_length, &extremes.min, f64::min)),
        max_effective_tension_n: tension
            .as_ref()
            .and_then(|(arc_length, extremes)| locate(arc_length, &extremes.max, f64::max)),
        max_bend_moment_n_m: largest(LineQuantity::BendMoment),
        max_curvature_1_m: largest(LineQuantity::Curvature),
        max_von_mises_stress_pa: largest(LineQuantity::VonMisesStress),
    }
}

/// The extreme of `values` that `choose` prefers, and where it is.
fn locate(arc_length: &[f64], values: &[f64], choose: fn(f64, f64) -> f64) -> Option<Located> {
    let value = values
        .iter()
        .copied()
        .reduce(choose)
        .filter(|value| value.is_finite())?;
    let index = values.iter().position(|v| *v == value)?;
    Some(Located {
        value,
        arc_length_m: *arc_length.get(index)?,
    })
}

fn comparison(reference: &ReferenceLayout, source: &dyn StatisticsSource) -> Comparison {
    let computed = source
        .channel(&reference.channel)
        .map(|extent| match reference.statistic {
            Statistic::Mean => extent.mean,
            Statistic::Min => extent.min,
            Statistic::Max => extent.max,
        })
        .filter(|value| value.is_finite());
    Comparison {
        channel: reference.channel.clone(),
        statistic: reference.statistic,
        unit: reference.unit.clone(),
        low: reference.low,
        high: reference.high,
        computed,
        // Zero inside the range, else the signed distance from its nearer end.
        difference: computed.map(|value| value - value.max(reference.low).min(reference.high)),
        source: reference.source.clone(),
    }
}
