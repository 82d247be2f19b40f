//! The summary of a static solution that is not stored.

use catenix_model::{Channel, LineQuantity, LoadCase, all_channels};

use crate::case_arrays::node_arc_length;
use crate::layout;
use crate::summarise::StatisticsSource;
use crate::{CaseOutcome, CaseSummary, Extent, Extremes, Sample};

impl CaseSummary {
    /// The summary of a static state: every minimum, mean and maximum is the static value.
    ///
    /// References are left out, for they belong to the motion.
    pub fn of_static_state(case: &LoadCase, sample: &impl Sample, outcome: &CaseOutcome) -> Self {
        let channels = all_channels(&case.model);
        let values = channels
            .iter()
            .map(|channel| sample.channel(channel.target))
            .collect();
        let lines = case.model.lines.iter().enumerate().map(|(index, line)| {
            let nodes = line.element_count() + 1;
            let mut values = vec![0.0; LineQuantity::ALL.len() * nodes];
            sample.line_quantities(index, &mut values);
            StaticLine {
                name: line.name.clone(),
                arc_length: node_arc_length(line),
                values,
            }
        });
        let state = StaticState {
            channels,
            values,
            lines: lines.collect(),
        };
        let mut layout = layout::case_layout(case);
        layout.references.clear();
        let mut summary = outcome.summary(&case.description);
        summary.fill(&layout, &state);
        summary
    }
}

struct StaticState {
    channels: Vec<Channel>,
    /// Values of the channels (n_channels).
    values: Vec<f64>,
    lines: Vec<StaticLine>,
}

struct StaticLine {
    name: String,
    arc_length: Vec<f64>,
    /// (quantities x nodes)
    values: Vec<f64>,
}

impl StatisticsSource for StaticState {
    fn channel(&self, name: &str) -> Option<Extent> {
        let index = self
            .channels
            .iter()
            .position(|channel| channel.name == name)?;
        Some(Extent::of(self.values[index]))
    }

    fn line(&self, line: &str, quantity: LineQuantity) -> Option<(Vec<f64>, Extremes)> {
        let line = self.lines.iter().find(|candidate| candidate.name == line)?;
        let nodes = line.arc_length.len();
        let row = &line.values[quantity.index() * nodes..(quantity.index() + 1) * nodes];
        let mut extremes = Extremes::new(nodes);
        extremes.add(0.0, row);
        Some((line.arc_length.clone(), extremes))
    }
}
