//! Section with the time histories: every figure of the model file, then what matters of each body,
//! line and vessel. Cases stand together in each figure.

use std::collections::BTreeSet;

use catenix_results::{Scene, StoreError};

use super::builder::{Builder, NewFigure};
use super::data::{CaseData, StudyData};
use crate::figure::{Chart, ChartAxis, Curve, Panel};

/// Most cases in one figure: as many as there are dashes and markers.
pub(super) const CASES_PER_FIGURE: usize = 8;
/// Most panels of one figure.
const MOST_PANELS: usize = 4;
/// A channel that varies less than this share of the largest value in its figure is left out.
const VARIES: f64 = 1e-6;

/// Channels that are drawn below each other.
struct Wanted {
    file: String,
    title: String,
    channels: Vec<String>,
    /// What the title says already and the axes need not repeat: `hose.end_a.`.
    object: String,
}

pub(super) fn add(data: &StudyData<'_>, builder: &mut Builder) -> Result<(), StoreError> {
    builder.section("histories", builder.text("section.histories"));
    let computed = data.computed();
    let mut drawn: BTreeSet<String> = BTreeSet::new();
    for figure in data.study.figures() {
        drawn.insert(figure.channel.clone());
        let wanted = Wanted {
            file: figure.name,
            title: figure.title,
            channels: vec![figure.channel],
            object: String::new(),
        };
        draw(&wanted, &computed, builder)?;
    }
    let Some(scene) = computed.iter().find_map(|case| case.scene.as_ref()) else {
        return Ok(());
    };
    for mut wanted in wanted(scene, &computed, builder) {
        wanted
            .channels
            .retain(|channel| drawn.insert(channel.clone()));
        draw(&wanted, &computed, builder)?;
    }
    Ok(())
}

/// What matters, in the order of the model.
fn wanted(scene: &Scene, cases: &[&CaseData], builder: &Builder) -> Vec<Wanted> {
    let mut all = Vec::new();
    let mut push = |file: String, title: String, object: &str, quantities: &[&str]| {
        let channels = quantities
            .iter()
            .map(|quantity| format!("{object}.{quantity}"));
        all.push(Wanted {
            file,
            title,
            channels: channels.collect(),
            object: format!("{object}."),
        });
    };
    for body in &scene.bodies {
        let name = body.name.as_str();
        match &body.offset_vessel {
            Some(vessel) => push(
                format!("offset-{name}"),
                builder.fill("histories.offset", &[("body", name), ("vessel", vessel)]),
                name,
                &["offset_x", "offset_y", "offset_z", "tilt"],
            ),
            None => push(
                format!("position-{name}"),
                builder.fill("histories.position", &[("body", name)]),
                name,
                &["x", "y", "z", "tilt"],
            ),
        }
    }
    for line in &scene.lines {
        let name = line.name.as_str();
        push(
            format!("tension-{name}"),
            builder.fill("histories.tension", &[("line", name)]),
            name,
            &["end_a.effective_tension", "end_b.effective_tension"],
        );
        for (end, label) in line.ends.iter().zip(["end_a", "end_b"]) {
            let Some(end) = end else {
                continue;
            };
            if scene.vessels.iter().any(|vessel| vessel.name == end.to) {
                let object = format!("{name}.{label}");
                let values = [("line", name), ("support", end.to.as_str())];
                push(
                    format!("force-{name}-{label}"),
                    builder.fill("histories.force", &values),
                    &object,
                    &["force_x", "force_y", "force_z"],
                );
            }
        }
    }
    // Points along lines are in the store because somebody asked for them.
    let mut points: BTreeSet<&String> = BTreeSet::new();
    for case in cases {
        points.extend(case.channels.iter().filter(|channel| channel.contains('@')));
    }
    if !points.is_empty() {
        all.push(Wanted {
            file: "points".to_owned(),
            title: builder.text("histories.points"),
            channels: points.into_iter().cloned().collect(),
            object: String::new(),
        });
    }
    for vessel in scene.vessels.iter().filter(|vessel| vessel.moves) {
        let name = vessel.name.as_str();
        all.push(Wanted {
            file: format!("motion-{name}"),
            title: builder.fill("histories.motion", &[("vessel", name)]),
            channels: ["x", "y", "z", "roll", "pitch", "heading"]
                .map(|quantity| format!("{name}.{quantity}"))
                .to_vec(),
            object: format!("{name}."),
        });
    }
    all
}

/// One figure per group of cases, with a panel for each channel that varies.
fn draw(wanted: &Wanted, cases: &[&CaseData], builder: &mut Builder) -> Result<(), StoreError> {
    let language = builder.language;
    for (part, cases) in cases.chunks(CASES_PER_FIGURE).enumerate() {
        let mut panels: Vec<(Panel, f64, f64)> = Vec::new();
        for channel in &wanted.channels {
            let mut curves = Vec::new();
            let mut unit = String::new();
            for case in cases {
                let Some(history) = case.history(channel)? else {
                    continue;
                };
                // A state at rest has one time and no history.
                if history.times_s.len() < 2 {
                    continue;
                }
                unit = history.unit;
                let points = history.times_s.into_iter().zip(history.values);
                // One case needs no legend.
                let label = if cases.len() > 1 {
                    case.label()
                } else {
                    String::new()
                };
                curves.push(match cases.len() {
                    1 => Curve::new(&label, points.collect()).with_look(crate::figure::Look::Plain),
                    _ => Curve::new(&label, points.collect()),
                });
            }
            if curves.is_empty() {
                continue;
            }
            let (least, most) = extent(&curves);
            let label = channel
                .strip_prefix(wanted.object.as_str())
                .unwrap_or(channel);
            let panel = Panel {
                y: ChartAxis::linear(&language.channel(label), &unit),
                curves,
                height: 0.0,
            };
            panels.push((panel, most - least, least.abs().max(most.abs())));
        }
        // Panels of one unit are held against each other.
        let largest = |unit: &str| {
            let same = panels.iter().filter(|(panel, ..)| panel.y.unit == unit);
            same.map(|(.., largest)| *largest).fold(0.0, f64::max)
        };
        let varies: Vec<bool> = panels
            .iter()
            .map(|(panel, range, _)| *range > VARIES * largest(&panel.y.unit))
            .collect();
        let kept = panels.into_iter().zip(varies).filter(|(_, varies)| *varies);
        let panels: Vec<Panel> = kept.map(|((panel, ..), _)| panel).collect();
        for (sheet, panels) in panels.chunks(MOST_PANELS).enumerate() {
            let mut file = wanted.file.clone();
            if part > 0 {
                file = format!("{file}-cases-{}", part + 1);
            }
            if sheet > 0 {
                file = format!("{file}-{}", sheet + 1);
            }
            let figure = NewFigure {
                name: &file,
                title: &wanted.title,
                caption: "",
            };
            builder.chart(&figure, stacked(panels, language.text("axis.time")));
        }
    }
    Ok(())
}

/// Panels below each other, with one legend.
fn stacked(panels: &[Panel], time: &str) -> Chart {
    let height = match panels.len() {
        1 => 270.0,
        2 => 170.0,
        _ => 140.0,
    };
    let mut chart = Chart::new(
        "",
        ChartAxis::linear(time, "s"),
        ChartAxis::linear("", ""),
        Vec::new(),
    );
    chart.panels = panels.to_vec();
    let last = chart.panels.len().saturating_sub(1);
    for (index, panel) in chart.panels.iter_mut().enumerate() {
        panel.height = height;
        if index < last {
            // The legend is about all panels.
            panel
                .curves
                .iter_mut()
                .for_each(|curve| curve.label.clear());
        }
    }
    chart
}

/// Smallest and largest value of the curves.
fn extent(curves: &[Curve]) -> (f64, f64) {
    let points = curves.iter().flat_map(|curve| &curve.points);
    let finite = points
        .map(|point| point.1)
        .filter(|value| value.is_finite());
    finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
        (low.min(value), high.max(value))
    })
}
