//! Section with range graphs: smallest, mean and largest value along each line.

use catenix_results::{Extremes, RangeGraph, StoreError};

use super::builder::{Builder, NewFigure};
use super::data::{CaseData, StudyData};
use super::histories::CASES_PER_FIGURE;
use crate::figure::{Chart, ChartAxis, Curve, Look, Panel};

/// Quantities that are drawn, in this order, and whether their smallest value matters.
const QUANTITIES: [(&str, &str, bool); 4] = [
    ("effective_tension", "N", true),
    ("bend_moment", "N m", false),
    ("von_mises_stress", "Pa", false),
    ("curvature", "1/m", false),
];
/// A bending moment smaller than this share of tension times length is rounding: the line has no
/// bending stiffness.
const ROUNDING: f64 = 1e-9;

/// A quantity along a line in one case.
struct Range {
    label: String,
    arc_length_m: Vec<f64>,
    /// Over the statistics window.
    window: RangeGraph,
    /// Over the whole run; `None` while the case runs.
    run: Option<Extremes>,
}

pub(super) fn add(data: &StudyData<'_>, builder: &mut Builder) -> Result<(), StoreError> {
    builder.section("ranges", builder.text("section.ranges"));
    let computed = data.computed();
    let mut lines: Vec<&String> = Vec::new();
    for line in computed.iter().flat_map(|case| case.summary.lines.keys()) {
        if !lines.contains(&line) {
            lines.push(line);
        }
    }
    for line in lines {
        builder.block(super::document::Block::Heading { text: line.clone() });
        for (quantity, unit, smallest_matters) in QUANTITIES {
            let mut all = Vec::new();
            for case in &computed {
                if !is_negligible(case, line, quantity) {
                    all.extend(range(case, line, quantity)?);
                }
            }
            let groups = all.chunks(CASES_PER_FIGURE).enumerate();
            for (part, cases) in groups {
                let chart = match cases {
                    [case] if all.len() == 1 => single(case, quantity, unit, builder),
                    cases => several(cases, quantity, unit, smallest_matters, builder),
                };
                let name = match part {
                    0 => format!("{line}-{quantity}"),
                    part => format!("{line}-{quantity}-{}", part + 1),
                };
                let quantity = builder.language.quantity(quantity);
                let title = [("line", line.as_str()), ("quantity", quantity.as_str())];
                let caption = match cases.iter().any(|case| case.run.is_none()) {
                    true => builder.text("ranges.unfinished"),
                    false => builder.text("ranges.caption"),
                };
                let figure = NewFigure {
                    name: &name,
                    title: &builder.fill("ranges.title", &title),
                    caption: &caption,
                };
                builder.chart(&figure, chart);
            }
        }
        // A line of which nothing is known has no heading either.
        if let Some(section) = builder.sections.last_mut() {
            let heading = |block: &super::document::Block| {
                matches!(block, super::document::Block::Heading { .. })
            };
            section.blocks.pop_if(|block| heading(block));
        }
    }
    Ok(())
}

fn is_negligible(case: &CaseData, line: &str, quantity: &str) -> bool {
    let Some(summary) = case.summary.lines.get(line) else {
        return true;
    };
    let tension = summary.max_effective_tension_n;
    let moment = summary.max_bend_moment_n_m;
    match (quantity, tension, moment) {
        ("bend_moment", Some(tension), Some(moment)) => {
            moment.value.abs() <= ROUNDING * tension.value.abs() * summary.length_m
        }
        _ => false,
    }
}

/// The range of a quantity; `None` where the line does not have it or nothing was stored.
fn range(case: &CaseData, line: &str, quantity: &str) -> Result<Option<Range>, StoreError> {
    let missing = |error: &StoreError| matches!(error, StoreError::UnknownLineResult { .. });
    let known = match case.stored.quantity(line, quantity) {
        Err(error) if missing(&error) => return Ok(None),
        other => other?,
    };
    let window = match case.stored.range_graph(line, known) {
        Err(error) if missing(&error) => {
            let length = case.summary.window_s.map_or(0.0, |[from, to]| to - from);
            match case.stored.range_graph_of_last(line, known, length)? {
                Some(graph) => graph,
                None => return Ok(None),
            }
        }
        other => other?,
    };
    let run = match case.stored.run_extremes(line, known) {
        Err(error) if missing(&error) => None,
        other => Some(other?),
    };
    let all = window.min.iter().chain(&window.max);
    if all
        .filter(|value| value.is_finite())
        .all(|value| *value == 0.0)
    {
        return Ok(None);
    }
    Ok(Some(Range {
        label: case.label(),
        arc_length_m: case.stored.arc_length_m(line)?,
        window,
        run,
    }))
}

impl Range {
    fn points(&self, values: &[f64]) -> Vec<(f64, f64)> {
        let places = self.arc_length_m.iter().copied();
        places.zip(values.iter().copied()).collect()
    }

    fn smallest(&self) -> &[f64] {
        self.run.as_ref().map_or(&self.window.min, |run| &run.min)
    }

    fn largest(&self) -> &[f64] {
        self.run.as_ref().map_or(&self.window.max, |run| &run.max)
    }

    /// Whether anything changes over time.
    fn varies(&self) -> bool {
        let both = self.smallest().iter().zip(self.largest());
        let size = self
            .largest()
            .iter()
            .fold(0.0_f64, |size, v| size.max(v.abs()));
        both.into_iter().any(|(low, high)| high - low > 1e-9 * size)
    }
}

/// One case: the band of the window, its mean, and the extremes of the run around it.
fn single(case: &Range, quantity: &str, unit: &str, builder: &Builder) -> Chart {
    let text = |key: &'static str| builder.language.text(key);
    let mut curves = Vec::new();
    if case.varies() {
        let mut band = case.points(&case.window.min);
        band.extend(case.points(&case.window.max).into_iter().rev());
        curves.push(Curve::new(text("ranges.window"), band).with_look(Look::Between));
        let mean = case.points(&case.window.mean);
        curves.push(Curve::new(text("ranges.mean"), mean).with_look(Look::Computed));
        if let Some(run) = &case.run {
            for (key, values) in [("ranges.largest", &run.max), ("ranges.smallest", &run.min)] {
                curves.push(Curve::new(text(key), case.points(values)).with_look(Look::Plain));
            }
        }
    } else {
        let mean = case.points(&case.window.mean);
        curves.push(Curve::new("", mean).with_look(Look::Computed));
    }
    let y = ChartAxis::linear(&builder.language.quantity(quantity), unit);
    let mut chart = Chart::new(
        "",
        ChartAxis::linear(text("axis.arc_length"), "m"),
        y,
        curves,
    );
    chart.panels[0].height = 260.0;
    chart
}

/// Several cases: largest, mean and smallest in panels below each other.
fn several(
    cases: &[Range],
    quantity: &str,
    unit: &str,
    smallest_matters: bool,
    builder: &Builder,
) -> Chart {
    let text = |key: &'static str| builder.language.text(key);
    let name = builder.language.quantity(quantity);
    let panel = |key: &'static str, values: &dyn Fn(&Range) -> Vec<f64>, is_last: bool| {
        let label = builder.fill(key, &[("quantity", &name)]);
        Panel {
            y: ChartAxis::linear(&label, unit),
            curves: cases
                .iter()
                .map(|case| {
                    let label = if is_last { case.label.as_str() } else { "" };
                    Curve::new(label, case.points(&values(case)))
                })
                .collect(),
            height: 170.0,
        }
    };
    let x = ChartAxis::linear(text("axis.arc_length"), "m");
    let moving = cases.iter().any(Range::varies);
    let mean = |is_last| panel("ranges.mean_of", &|case| case.window.mean.clone(), is_last);
    let mut panels = Vec::new();
    if moving {
        panels.push(panel(
            "ranges.largest_of",
            &|case| case.largest().to_vec(),
            false,
        ));
        panels.push(mean(!smallest_matters));
        if smallest_matters {
            panels.push(panel(
                "ranges.smallest_of",
                &|case| case.smallest().to_vec(),
                true,
            ));
        }
    } else {
        let mut only = mean(true);
        only.y.label = name.clone();
        only.height = 260.0;
        panels.push(only);
    }
    let y = ChartAxis::linear("", unit);
    let mut chart = Chart::new("", x, y, Vec::new());
    chart.panels = panels;
    chart
}
