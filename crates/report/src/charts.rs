//! Charts of what the results hold.

use catenix_results::{
    CaseModes, ComparedCase, ModeReport, ModeShapes, StoreError, StoredFigure, StoredStudy,
    StudyPaths,
};

use crate::figure::{Chart, ChartAxis, Curve, Look};
use crate::words::Language;

/// Most curves of a figure of modes.
const MOST_MODES: usize = 6;
/// Largest displacement along a line, over the largest of the mode, below which the line takes no
/// part in the mode.
const TAKES_PART: f64 = 0.05;

/// The chart of a figure of the model file: its channel in every case that has got one.
pub fn study_chart(study: &StoredStudy, figure: &StoredFigure) -> Result<Chart, StoreError> {
    let mut curves = Vec::new();
    for name in study.case_names() {
        let case = study.case(name)?;
        let history = match case.channel(&figure.channel) {
            Ok(history) => history,
            // A case that failed before its first step has no channels.
            Err(StoreError::UnknownChannel { .. }) => continue,
            Err(error) => return Err(error),
        };
        let points = history.times_s.into_iter().zip(history.values).collect();
        let label = case_label(name, &case.summary()?.description);
        curves.push(Curve::new(&label, points));
    }
    let x = ChartAxis::linear("Time", "s");
    let y = ChartAxis::linear(&Language::English.channel(&figure.channel), &figure.unit);
    Ok(Chart::new(&figure.title, x, y, curves).with_note(&study.note()))
}

/// The load factor against a channel, one curve per case; `None` when no case has the channel.
pub fn path_chart(paths: &StudyPaths, channel: &str) -> Option<Chart> {
    let mut unit = None;
    let mut curves = Vec::new();
    for (name, case) in &paths.cases {
        let Some(column) = case.channels.get(channel) else {
            continue;
        };
        unit = Some(column.unit);
        let values = column.values.iter().copied();
        let points = values.zip(case.factor.iter().copied()).collect();
        curves.push(Curve::new(&case_label(name, &case.description), points));
    }
    let title = format!("{}: equilibrium path", paths.title);
    let x = ChartAxis::linear(&Language::English.channel(channel), unit?);
    let y = ChartAxis::linear("Load factor", "");
    Some(Chart::new(&title, x, y, curves).with_note(&paths.note))
}

/// Charts of the first modes that move each line, by the line's name: the component of the
/// displacement that is largest, against arc length.
pub fn mode_charts(modes: &CaseModes, title: &str, note: &str) -> Vec<(String, Chart)> {
    let charts = line_modes_charts(modes, Language::English).into_iter();
    let titled = charts.map(|(line, mut chart)| {
        chart.title = format!("{title}: modes of {line}");
        (line, chart.with_note(note))
    });
    titled.collect()
}

/// The same without titles, in any language.
pub(crate) fn line_modes_charts(modes: &CaseModes, language: Language) -> Vec<(String, Chart)> {
    let charts = modes.lines.iter().filter_map(|line| {
        let chart = line_modes_chart(modes, line, language)?;
        Some((line.name.clone(), chart))
    });
    charts.collect()
}

fn line_modes_chart(modes: &CaseModes, line: &ModeShapes, language: Language) -> Option<Chart> {
    let arc_length = line.arc_length.as_ref()?;
    let curves: Vec<Curve> = modes
        .report
        .modes
        .iter()
        .zip(&line.motion)
        .filter_map(|(mode, motion)| {
            let size = |axis: usize| motion.iter().map(|d| d[axis].abs()).fold(0.0, f64::max);
            let axis = (0..3).max_by(|&a, &b| size(a).total_cmp(&size(b)))?;
            let shown = mode.kind == "vibration" && !mode.equals_previous && !turns(mode);
            if !shown || size(axis) < TAKES_PART {
                return None;
            }
            let frequency = frequency_text(mode.frequency_hz.unwrap_or(f64::NAN));
            let values = [
                ("number", mode.number.to_string()),
                ("frequency", frequency),
                ("axis", ["x", "y", "z"][axis].to_owned()),
            ];
            let values = values
                .each_ref()
                .map(|(name, value)| (*name, value.as_str()));
            let label = language.fill("modes.curve", &values);
            let heights = motion.iter().map(|d| d[axis]);
            let points = arc_length.iter().copied().zip(heights).collect();
            Some(Curve::new(&label, points))
        })
        .take(MOST_MODES)
        .collect();
    if curves.is_empty() {
        return None;
    }
    let x = ChartAxis::linear(language.text("axis.arc_length"), "m");
    let y = ChartAxis::linear(language.text("modes.displacement"), "-");
    Some(Chart::new("", x, y, curves))
}

/// Whether the mode is mostly torsion of lines or rotation of bodies.
fn turns(mode: &ModeReport) -> bool {
    let first = mode.motions.first().map(|share| &*share.motion);
    matches!(first, Some("torsion" | "rotation"))
}

/// A frequency with its unit, four digits.
fn frequency_text(hz: f64) -> String {
    match hz {
        _ if hz >= 100.0 => format!("{hz:.1} Hz"),
        _ if hz >= 1.0 => format!("{hz:.3} Hz"),
        _ if hz >= 0.01 => format!("{hz:.4} Hz"),
        _ => format!("{:.3} mHz", hz * 1e3),
    }
}

/// Error against processor time of each formulation, one point per mesh; `None` without errors.
pub fn cost_chart(case: &ComparedCase, title: &str, target: f64) -> Option<Chart> {
    let mut curves: Vec<Curve> = case
        .formulations
        .iter()
        .map(|formulation| {
            let points = formulation.runs.iter().filter_map(|run| {
                let percent = 100.0 * run.error?;
                Some((run.cpu_seconds, percent))
            });
            Curve::new(&formulation.formulation, points.collect())
        })
        .filter(|curve| !curve.points.is_empty())
        .collect();
    let costs = curves.iter().flat_map(|curve| &curve.points).map(|p| p.0);
    let (low, high) = costs.fold((f64::INFINITY, 0.0), |(low, high): (f64, f64), cost| {
        (low.min(cost), high.max(cost))
    });
    if curves.is_empty() {
        return None;
    }
    let wanted = 100.0 * target;
    let line = vec![(low, wanted), (high, wanted)];
    curves.push(Curve::new(&format!("{wanted} %"), line).with_look(Look::Bound));
    let title = format!("{title}, case {}: error against cost", case.name);
    let x = ChartAxis::logarithmic("Processor time", "s");
    let y = ChartAxis::logarithmic("Largest error of the results that count", "%");
    Some(Chart::new(&title, x, y, curves))
}

fn case_label(name: &str, description: &str) -> String {
    if description.is_empty() {
        name.to_owned()
    } else {
        format!("{name}: {description}")
    }
}
