//! Shapes of the lines, at rest and at the end, and the ways of the bodies.

use catenix_results::StoreError;

use super::builder::{Builder, NewFigure};
use super::data::{CaseData, Positions, StudyData};
use super::format::with_unit;
use super::histories::CASES_PER_FIGURE;
use crate::figure::{Chart, ChartAxis, Curve, Panel};
use crate::words::Language;

/// Displacements smaller than this share of the system's size are not seen in a figure.
const MOVED: f64 = 5e-3;

/// An extent smaller than this share of the largest is not worth a view.
const LEAST_SEEN: f64 = 0.03;

/// The lines of a case, nodes with gaps between lines (n x 3) [m].
struct Shape {
    label: String,
    nodes: Vec<[f64; 3]>,
    time_s: f64,
}

pub(super) fn add(data: &StudyData<'_>, builder: &mut Builder) -> Result<(), StoreError> {
    let computed = data.computed();
    builder.section("shapes", builder.text("section.shapes"));
    let mut at_rest = Vec::new();
    let mut at_end = Vec::new();
    for case in &computed {
        at_rest.extend(shape(case, |line| {
            Ok(case.static_positions(line)?.map(|nodes| (0.0, nodes)))
        })?);
        at_end.extend(shape(case, |line| case.last_positions(line))?);
    }
    let differs = |a: &Shape, b: &Shape| !agree(&a.nodes, &b.nodes);
    if at_rest.windows(2).any(|pair| differs(&pair[0], &pair[1])) {
        let title = builder.text("shapes.at_rest");
        figures(builder, &at_rest, "static-shape", &title, "");
    }
    let moved: Vec<bool> = at_end
        .iter()
        .map(|end| {
            let rest = at_rest.iter().find(|rest| rest.label == end.label);
            rest.is_none_or(|rest| differs(rest, end))
        })
        .collect();
    if moved.iter().any(|moved| *moved) {
        let title = builder.text("shapes.at_end");
        let times: Vec<String> = at_end
            .iter()
            .map(|shape| with_unit(shape.time_s, "s"))
            .collect();
        let same_time = times.windows(2).all(|pair| pair[0] == pair[1]);
        let caption = match (times.first(), same_time) {
            (Some(time), true) => builder.fill("shapes.time", &[("time", time)]),
            _ => builder.text("shapes.each_end"),
        };
        // One case is shown with its shape at rest, several with each other.
        if let ([rest], [end]) = (&mut at_rest[..], &mut at_end[..]) {
            rest.label = builder.text("shapes.rest");
            end.label = builder.fill("shapes.end", &[("time", &with_unit(end.time_s, "s"))]);
            at_rest.append(&mut at_end);
            figures(builder, &at_rest, "final-shape", &title, "");
        } else {
            figures(builder, &at_end, "final-shape", &title, &caption);
        }
    }
    trajectories(&computed, builder)
}

/// All lines of a case as one sequence of nodes; `None` where a line has no positions.
fn shape(
    case: &CaseData,
    positions: impl Fn(&str) -> Result<Option<Positions>, StoreError>,
) -> Result<Option<Shape>, StoreError> {
    let mut nodes = Vec::new();
    let mut time_s = 0.0;
    for line in case.summary.lines.keys() {
        let Some((time, line)) = positions(line)? else {
            return Ok(None);
        };
        nodes.extend(line);
        nodes.push([f64::NAN; 3]);
        time_s = time;
    }
    Ok((!nodes.is_empty()).then(|| Shape {
        label: case.label(),
        nodes,
        time_s,
    }))
}

/// Smallest and largest finite value along an axis.
fn extent(nodes: &[[f64; 3]], axis: usize) -> (f64, f64) {
    let values = nodes.iter().map(|node| node[axis]);
    values
        .filter(|value| value.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (low.min(value), high.max(value))
        })
}

/// Largest side of the box around the nodes [m].
fn size(nodes: &[[f64; 3]]) -> f64 {
    let side = |axis| {
        let (low, high) = extent(nodes, axis);
        high - low
    };
    side(0).max(side(1)).max(side(2))
}

fn agree(a: &[[f64; 3]], b: &[[f64; 3]]) -> bool {
    let limit = MOVED * size(a).max(size(b));
    let near = |(a, b): (&[f64; 3], &[f64; 3])| {
        // Gaps stand in the same places.
        a.iter()
            .zip(b)
            .all(|(a, b)| a.is_nan() || (a - b).abs() <= limit)
    };
    a.len() == b.len() && a.iter().zip(b).all(near)
}

/// Views of shapes: from the side along y and x, and from above, as far as there is anything to see.
fn figures(builder: &mut Builder, shapes: &[Shape], file: &str, title: &str, caption: &str) {
    let all: Vec<[f64; 3]> = shapes
        .iter()
        .flat_map(|shape| &shape.nodes)
        .copied()
        .collect();
    let whole = size(&all);
    let is_seen = |axis: usize| {
        let (low, high) = extent(&all, axis);
        high - low > LEAST_SEEN * whole
    };
    let views = [(0, 2, "side"), (1, 2, "front"), (0, 1, "plan")];
    // A view of a line in itself says nothing; the side view stands for a vertical line.
    let seen = views.into_iter().filter(|(a, b, name)| {
        (is_seen(*a) && is_seen(*b)) || (*name == "side" && !(is_seen(1) && is_seen(2)))
    });
    for (across, up, view) in seen {
        for (part, shapes) in shapes.chunks(CASES_PER_FIGURE).enumerate() {
            let curves = shapes.iter().map(|shape| {
                let points = shape.nodes.iter().map(|node| (node[across], node[up]));
                Curve::new(&shape.label, points.collect())
            });
            let axis = |axis: usize| {
                let key = ["axis.x", "axis.y", "axis.z"][axis];
                ChartAxis::linear(builder.language.text(key), "m")
            };
            let mut chart = Chart::new("", axis(across), axis(up), curves.collect());
            chart.true_to_scale = true;
            chart.panels[0].height = 540.0;
            let key = match view {
                "side" => "shapes.side",
                "front" => "shapes.front",
                _ => "shapes.plan",
            };
            let view_text = builder.text(key);
            let name = match part {
                0 => format!("{file}-{view}"),
                part => format!("{file}-{view}-{}", part + 1),
            };
            let title = builder.fill("shapes.seen", &[("what", title), ("view", &view_text)]);
            let scale = builder.text("shapes.to_scale");
            let caption = [caption, &scale].join(" ");
            let figure = NewFigure {
                name: &name,
                title: &title,
                caption: caption.trim(),
            };
            builder.chart(&figure, chart);
        }
    }
}

/// The ways of the bodies, against the vessel that their offset is taken from where there is one.
fn trajectories(cases: &[&CaseData], builder: &mut Builder) -> Result<(), StoreError> {
    let mut bodies: Vec<(String, Option<String>)> = Vec::new();
    for case in cases {
        for (name, body) in &case.summary.bodies {
            if !bodies.iter().any(|(known, _)| known == name) {
                bodies.push((name.clone(), body.offset_vessel.clone()));
            }
        }
    }
    for (body, vessel) in &bodies {
        for (part, cases) in cases.chunks(CASES_PER_FIGURE).enumerate() {
            let channels = match vessel {
                Some(_) => ["offset_x", "offset_y", "offset_z"],
                None => ["x", "y", "z"],
            };
            let mut ways: Vec<(String, [Vec<f64>; 3])> = Vec::new();
            for case in cases {
                let mut axes = Vec::new();
                for channel in channels {
                    axes.extend(case.history(&format!("{body}.{channel}"))?);
                }
                if let Ok([x, y, z]) = <[_; 3]>::try_from(axes) {
                    ways.push((case.label(), [x.values, y.values, z.values]));
                }
            }
            if let Some(chart) = way_chart(&ways, body, &channels, builder.language) {
                let name = match part {
                    0 => format!("trajectory-{body}"),
                    part => format!("trajectory-{body}-{}", part + 1),
                };
                let title = match vessel {
                    Some(vessel) => {
                        builder.fill("shapes.way_from", &[("body", body), ("vessel", vessel)])
                    }
                    None => builder.fill("shapes.way", &[("body", body)]),
                };
                let figure = NewFigure {
                    name: &name,
                    title: &title,
                    caption: &builder.text("shapes.way_note"),
                };
                builder.chart(&figure, chart);
            }
        }
    }
    Ok(())
}

/// Heights and transverse places against the place along x; `None` where nothing moves.
fn way_chart(
    ways: &[(String, [Vec<f64>; 3])],
    body: &str,
    channels: &[&str; 3],
    language: Language,
) -> Option<Chart> {
    let range = |axis: usize| {
        let each = ways.iter().map(|(_, way)| {
            let finite = way[axis].iter().filter(|value| value.is_finite());
            let fold = |(low, high): (f64, f64), value: &f64| (low.min(*value), high.max(*value));
            let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), fold);
            high - low
        });
        each.filter(|range| range.is_finite()).fold(0.0, f64::max)
    };
    let ranges = [range(0), range(1), range(2)];
    let largest = ranges.iter().copied().fold(0.0, f64::max);
    let moves = |axis: usize| ranges[axis] > 1e-3 * largest && ranges[axis] > 1e-6;
    // The horizontal axis is x, or y where only y moves.
    let across = (0..2).find(|axis| moves(*axis))?;
    let axis = |axis: usize| {
        let channel = format!("{body}.{}", channels[axis]);
        ChartAxis::linear(&language.channel(&channel), "m")
    };
    let panels = (across + 1..3).filter(|up| moves(*up)).map(|up| Panel {
        y: axis(up),
        curves: ways
            .iter()
            .map(|(label, way)| {
                let points = way[across].iter().copied().zip(way[up].iter().copied());
                let label = if up == 2 || !moves(2) {
                    label.as_str()
                } else {
                    ""
                };
                Curve::new(label, points.collect())
            })
            .collect(),
        height: 220.0,
    });
    let panels: Vec<Panel> = panels.collect();
    let first = panels.first()?;
    let mut chart = Chart::new("", axis(across), first.y.clone(), Vec::new());
    chart.panels = panels;
    Some(chart)
}
