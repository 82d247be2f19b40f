//! Records one load case while it is computed.

use std::time::{Duration, Instant};

use catenix_model::{Channel, LineQuantity, LoadCase, all_channels};

use crate::case_arrays::{CaseArrays, LineArrays};
use crate::curve::time_tolerance;
use crate::layout;
use crate::outcome::CaseOutcome;
use crate::store_reader::StoredCase;
use crate::summarise::{CaseLayout, StatisticsSource};
use crate::zarr::{Attributes, Group};
use crate::{
    CaseModes, CaseSummary, Curve, Extent, Extremes, OutputTimes, Sample, Status, StoreError,
    WindowStatistics,
};

/// Longest elapsed time between two flushes. A killed run loses at most this much of its work.
const FLUSH_INTERVAL: Duration = Duration::from_secs(2);

/// Writes the histories, fields, statistics and static state of one load case into the store.
///
/// Give it the static state, then every accepted step, then the outcome:
/// [`record_static`](Self::record_static), [`record`](Self::record), [`finish`](Self::finish).
#[derive(Debug)]
pub struct CaseRecorder {
    name: String,
    group: Group,
    attributes: Attributes,
    layout: CaseLayout,
    channels: Vec<Channel>,
    arrays: Option<CaseArrays>,
    /// Time at which the statistics window of a complete run starts [s].
    window_start_s: f64,
    /// End of a complete run [s].
    duration_s: f64,
    /// Over the statistics window.
    channel_statistics: WindowStatistics,
    line_statistics: Vec<WindowStatistics>,
    /// Over the whole run.
    channel_extremes: Extremes,
    line_extremes: Vec<Extremes>,
    /// Through the latest samples: rows are taken from it at the output times.
    channel_curve: Curve,
    line_curves: Vec<Curve>,
    /// Room for a row: values of all channels (n_channels), and along each line
    /// (quantities x nodes).
    channel_values: Vec<f64>,
    line_values: Vec<Vec<f64>>,
    history_times: OutputTimes,
    field_times: OutputTimes,
    /// Time of the latest sample [s].
    latest_s: Option<f64>,
    last_flush: Instant,
}

impl CaseRecorder {
    pub(crate) fn new(group: Group, mut attributes: Attributes, case: &LoadCase) -> Self {
        let model = &case.model;
        let channels = all_channels(model);
        let (duration_s, window) = match &model.dynamics {
            Some(dynamics) => (dynamics.duration, dynamics.statistics_window),
            None => (0.0, 0.0),
        };
        let line_values: Vec<Vec<f64>> = model
            .lines
            .iter()
            .map(|line| vec![0.0; LineQuantity::ALL.len() * (line.element_count() + 1)])
            .collect();
        attributes.insert(layout::STATUS_KEY.into(), Status::Running.word().into());
        CaseRecorder {
            name: case.name.clone(),
            group,
            attributes,
            layout: layout::case_layout(case),
            channel_statistics: WindowStatistics::new(channels.len()),
            line_statistics: line_values
                .iter()
                .map(|v| WindowStatistics::new(v.len()))
                .collect(),
            channel_extremes: Extremes::new(channels.len()),
            line_extremes: line_values.iter().map(|v| Extremes::new(v.len())).collect(),
            channel_curve: Curve::new(channels.len()),
            line_curves: line_values.iter().map(|v| Curve::new(v.len())).collect(),
            history_times: OutputTimes::new(model.output.interval, duration_s),
            field_times: OutputTimes::new(model.output.field_interval, duration_s),
            latest_s: None,
            channel_values: vec![0.0; channels.len()],
            line_values,
            channels,
            arrays: None,
            window_start_s: (duration_s - window).max(0.0),
            duration_s,
            last_flush: Instant::now(),
        }
    }

    /// Records the static state, and makes the arrays that the motion will fill.
    pub fn record_static(
        &mut self,
        case: &LoadCase,
        sample: &impl Sample,
    ) -> Result<(), StoreError> {
        let mut arrays = CaseArrays::create(self.group.place(), &case.model, &self.channels)?;
        for (line, arrays) in arrays.lines.iter().enumerate() {
            sample.line_quantities(line, &mut self.line_values[line]);
            arrays.write_static(&self.line_values[line])?;
        }
        if case.model.dynamics.is_none() {
            // The static state is all there is: it stands for the history and the statistics too.
            self.add_sample(&mut arrays, sample, true)?;
        }
        self.arrays = Some(arrays);
        self.flush_if_due()
    }

    /// Records the natural modes about the static state.
    pub fn record_modes(&mut self, modes: &CaseModes) -> Result<(), StoreError> {
        modes.write(&self.group)
    }

    /// Records an accepted state: the start, then the end of every step.
    ///
    /// Output times may lie anywhere between: their rows are interpolated as soon as the step after
    /// them is known ([`Curve`]).
    pub fn record(&mut self, sample: &impl Sample) -> Result<(), StoreError> {
        let Some(mut arrays) = self.arrays.take() else {
            return Ok(());
        };
        let in_window = sample.time() >= self.window_start_s - time_tolerance(self.duration_s);
        let result = self.add_sample(&mut arrays, sample, in_window);
        self.arrays = Some(arrays);
        result?;
        self.flush_if_due()
    }

    /// Evaluates a sample and stores the rows that it makes known.
    ///
    /// Every sample is evaluated as a whole, because every one may hold an extreme of the run.
    fn add_sample(
        &mut self,
        arrays: &mut CaseArrays,
        sample: &impl Sample,
        in_window: bool,
    ) -> Result<(), StoreError> {
        let time = sample.time();
        let channels = &self.channels;
        self.channel_curve
            .push_with(time, |values| sample.channels(channels, values));
        self.channel_extremes.follow(&self.channel_curve);
        let lines = self.line_curves.iter_mut().zip(&mut self.line_extremes);
        for (line, (curve, extremes)) in lines.enumerate() {
            curve.push_with(time, |values| sample.line_quantities(line, values));
            extremes.follow(curve);
        }
        if in_window {
            self.channel_statistics
                .add(time, self.channel_curve.latest());
            for (statistics, curve) in self.line_statistics.iter_mut().zip(&self.line_curves) {
                statistics.add(time, curve.latest());
            }
        }
        // How the last stretch bends shows only at the next sample; its end is known now.
        let known = self.latest_s.replace(time).unwrap_or(f64::NEG_INFINITY);
        self.write_rows(arrays, known, time)
    }

    /// Writes the rows up to a time, and one at the latest sample if that is the next.
    fn write_rows(
        &mut self,
        arrays: &mut CaseArrays,
        known: f64,
        latest: f64,
    ) -> Result<(), StoreError> {
        while let Some(time) = self.history_times.due(known, latest) {
            self.channel_curve.at(time, &mut self.channel_values);
            arrays.push_history(time, &self.channel_values)?;
        }
        while let Some(time) = self.field_times.due(known, latest) {
            for (curve, values) in self.line_curves.iter().zip(&mut self.line_values) {
                curve.at(time, values);
            }
            arrays.push_fields(time, &self.line_values)?;
        }
        Ok(())
    }

    /// Brings the folder of the case up to date where that has not been done for a while. A case
    /// that is done before has no folder, only its archive.
    fn flush_if_due(&mut self) -> Result<(), StoreError> {
        if self.last_flush.elapsed() >= FLUSH_INTERVAL || self.group.place().is_full() {
            self.flush()?;
        }
        Ok(())
    }

    /// Brings the folder of the case up to date: first the data, then the attributes that count the
    /// rows. While samples come in this happens by itself every few seconds.
    pub fn flush(&mut self) -> Result<(), StoreError> {
        if let Some(mut arrays) = self.arrays.take() {
            let flushed = arrays.history.flush().and_then(|()| arrays.fields.flush());
            let written = flushed.and_then(|()| self.write_attributes(&arrays));
            self.arrays = Some(arrays);
            written?;
        }
        self.group.place().flush()?;
        self.last_flush = Instant::now();
        Ok(())
    }

    /// Writes everything that is left and returns the summary of the case.
    ///
    /// Extremes are those of every step. A complete case reports the means of every step in the
    /// window. One that stopped early never saw its window: it reports the last stretch of that
    /// length, from what is stored.
    pub fn finish(mut self, outcome: &CaseOutcome) -> Result<CaseSummary, StoreError> {
        outcome.write_to(&mut self.attributes);
        let mut summary = outcome.summary(&self.layout.description);
        let mut arrays = self.arrays.take();
        if let Some(arrays) = &mut arrays {
            if let Some(latest) = self.latest_s {
                self.write_rows(arrays, latest, latest)?;
            }
            arrays.history.finish()?;
            arrays.fields.finish()?;
            self.write_attributes(arrays)?;
            self.write_run_extremes(&arrays.lines)?;
            let means;
            if outcome.status == Status::Complete && self.channel_statistics.window_s().is_some() {
                self.write_range_graphs(&arrays.lines)?;
                summary.window_s = self.channel_statistics.window_s();
                means = self.channel_statistics.range_graph().mean;
            } else {
                let stored = StoredCase::new(self.group.clone(), self.name.clone());
                let statistics = stored.statistics_of_last(self.layout.window_s)?;
                for line in &arrays.lines {
                    for quantity in line.quantities() {
                        if let Some(graph) = statistics.range_graph(&line.name, quantity) {
                            line.write_range_graph(quantity, &graph)?;
                        }
                    }
                }
                summary.window_s = statistics.window_s();
                means = self
                    .channels
                    .iter()
                    .map(|channel| statistics.mean(&channel.name).unwrap_or(f64::NAN))
                    .collect();
            }
            let statistics = RecordedStatistics {
                recorder: &self,
                means,
                lines: &arrays.lines,
            };
            summary.fill(&self.layout, &statistics);
        }
        // A summary is plain numbers and strings: it always becomes JSON.
        let text = serde_json::to_string(&summary).unwrap_or_default();
        self.attributes
            .insert(layout::SUMMARY_KEY.into(), text.into());
        self.group.set_attributes(&self.attributes)?;
        self.group.place().pack()?;
        Ok(summary)
    }

    fn write_range_graphs(&self, lines: &[LineArrays]) -> Result<(), StoreError> {
        for (line, statistics) in lines.iter().zip(&self.line_statistics) {
            let graph = statistics.range_graph();
            for quantity in line.quantities() {
                line.write_range_graph(quantity, &line.part_of(&graph, quantity))?;
            }
        }
        Ok(())
    }

    fn write_run_extremes(&self, lines: &[LineArrays]) -> Result<(), StoreError> {
        for (line, extremes) in lines.iter().zip(&self.line_extremes) {
            for quantity in line.quantities() {
                line.write_run_extremes(quantity, &line.extremes_of(extremes, quantity))?;
            }
        }
        Ok(())
    }

    fn write_attributes(&mut self, arrays: &CaseArrays) -> Result<(), StoreError> {
        let (history, fields) = (arrays.history.flushed_rows(), arrays.fields.flushed_rows());
        self.attributes
            .insert(layout::HISTORY_ROWS_KEY.into(), history.into());
        self.attributes
            .insert(layout::FIELD_ROWS_KEY.into(), fields.into());
        self.group.set_attributes(&self.attributes)
    }
}

/// What a recorder knows at its end.
struct RecordedStatistics<'a> {
    recorder: &'a CaseRecorder,
    /// Mean of each channel over the window (n_channels).
    means: Vec<f64>,
    lines: &'a [LineArrays],
}

impl StatisticsSource for RecordedStatistics<'_> {
    fn channel(&self, name: &str) -> Option<Extent> {
        let recorder = self.recorder;
        let index = recorder
            .channels
            .iter()
            .position(|channel| channel.name == name)?;
        let extremes = &recorder.channel_extremes;
        Some(Extent::new(
            extremes.min[index],
            self.means[index],
            extremes.max[index],
        ))
    }

    fn line(&self, line: &str, quantity: LineQuantity) -> Option<(Vec<f64>, Extremes)> {
        let index = self.lines.iter().position(|arrays| arrays.name == line)?;
        let arrays = &self.lines[index];
        let extremes = &self.recorder.line_extremes[index];
        Some((
            arrays.arc_length.clone(),
            arrays.extremes_of(extremes, quantity),
        ))
    }
}
