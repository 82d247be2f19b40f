//! Lays out curves, axes, legend, title and note.

use super::axis::Axis;
use super::decimate::decimate;
use super::drawing::{Anchor, Colour, Drawing, Mark, Stroke, Text};
use super::font;
use super::legend::{Legend, stroke};
use crate::store::StoredFigure;
use crate::{StoreError, StoredStudy};

pub(crate) const INK: Colour = [0x1a, 0x1a, 0x1a];
const GREY: Colour = [0x55, 0x55, 0x55];
const GRID: Colour = [0xdd, 0xdd, 0xdd];
const ZERO: Colour = [0x99, 0x99, 0x99];

/// Font size of tick labels, legend and axis titles.
pub(crate) const SMALL: f64 = 13.0;
const TITLE: f64 = 17.0;
const NOTE: f64 = 11.0;

const WIDTH: f64 = 900.0;
const PLOT_HEIGHT: f64 = 380.0;
const MARGIN: f64 = 18.0;
const RIGHT: f64 = 26.0;

/// Curves, mostly against time, with everything that explains them.
#[derive(Debug, Clone, PartialEq)]
pub struct Chart {
    /// Title above the axes.
    pub title: String,
    /// What the horizontal axis is, with its unit.
    pub x_label: String,
    /// What the vertical axis is, without its unit.
    pub y_label: String,
    /// Unit of the values, empty for none; newtons, newton metres and pascals are drawn in thousands or millions
    /// where the numbers are long.
    pub y_unit: String,
    /// Remark below the legend; may be empty.
    pub note: String,
    /// The curves.
    pub curves: Vec<Curve>,
}

/// One curve.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// Text in the legend.
    pub label: String,
    /// Points in the order in which they are joined; NaN leaves a gap.
    pub points: Vec<(f64, f64)>,
}

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
        let description = case.summary()?.description;
        let label = if description.is_empty() {
            name.clone()
        } else {
            format!("{name}: {description}")
        };
        let points = history.times_s.into_iter().zip(history.values).collect();
        curves.push(Curve { label, points });
    }
    Ok(Chart {
        title: figure.title.clone(),
        x_label: "Time [s]".to_owned(),
        y_label: channel_label(&figure.channel),
        y_unit: figure.unit.clone(),
        note: study.note(),
        curves,
    })
}

/// `hose.end_b.force_x` as "hose, end B, force x".
pub(crate) fn channel_label(channel: &str) -> String {
    channel
        .replace("end_a", "end A")
        .replace("end_b", "end B")
        .replace('.', ", ")
        .replace('_', " ")
}

impl Chart {
    /// Lays the chart out.
    pub fn draw(&self) -> Drawing {
        let (unit, factor) = readable_unit(&self.y_unit, self.largest_value());
        let finite = self
            .curves
            .iter()
            .flat_map(|curve| &curve.points)
            .filter(|p| p.1.is_finite());
        let range = |values: &mut dyn Iterator<Item = f64>| {
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), v| {
                (lo.min(v), hi.max(v))
            })
        };
        let (x_min, x_max) = range(&mut finite.clone().map(|point| point.0));
        let (y_min, y_max) = range(&mut finite.map(|point| point.1 * factor));
        let x_axis = Axis::new(x_min, x_max, 9, false);
        let y_axis = Axis::new(y_min, y_max, 7, true);

        let label_width = |tick: &f64| font::text_width(&y_axis.label(*tick), SMALL, false);
        let widest = y_axis.ticks.iter().map(label_width).fold(0.0, f64::max);
        let left = MARGIN + SMALL + 14.0 + widest + 8.0;
        let title_lines = wrap_bold(&self.title, WIDTH - left - RIGHT);
        let top = MARGIN + title_lines.len() as f64 * (TITLE + 6.0) + 8.0;
        let frame = Frame {
            left,
            right: WIDTH - RIGHT,
            top,
            bottom: top + PLOT_HEIGHT,
        };

        let mut marks = Vec::new();
        for (index, line) in title_lines.into_iter().enumerate() {
            let y = MARGIN + TITLE + index as f64 * (TITLE + 6.0);
            marks.push(text((left, y), Anchor::Start, TITLE, INK, line, true));
        }
        frame.axes(&x_axis, &y_axis, &mut marks);
        let middle = (
            0.5 * (frame.left + frame.right),
            0.5 * (frame.top + frame.bottom),
        );
        let below = frame.bottom + 44.0;
        marks.push(text(
            (middle.0, below),
            Anchor::Middle,
            SMALL,
            INK,
            self.x_label.clone(),
            false,
        ));
        if let Mark::Text(mut label) = text(
            (MARGIN + SMALL, middle.1),
            Anchor::Middle,
            SMALL,
            INK,
            match unit.as_str() {
                "" => self.y_label.clone(),
                unit => format!("{} [{unit}]", self.y_label),
            },
            false,
        ) {
            label.upwards = true;
            marks.push(Mark::Text(label));
        }
        for (index, curve) in self.curves.iter().enumerate() {
            frame.curve(curve, factor, &x_axis, &y_axis, stroke(index), &mut marks);
        }

        let labels: Vec<&str> = self
            .curves
            .iter()
            .map(|curve| curve.label.as_str())
            .collect();
        let legend = Legend::new(&labels, frame.right - frame.left);
        let legend_top = below + 14.0;
        marks.extend(legend.marks(frame.left, legend_top));
        let mut bottom = legend_top + legend.height();
        if !self.note.is_empty() {
            bottom += 8.0;
            for line in font::wrap(&self.note, NOTE, frame.right - frame.left) {
                bottom += NOTE + 4.0;
                marks.push(text(
                    (frame.left, bottom),
                    Anchor::Start,
                    NOTE,
                    GREY,
                    line,
                    false,
                ));
            }
        }
        Drawing {
            width: WIDTH,
            height: (bottom + MARGIN).ceil(),
            title: self.title.clone(),
            marks,
        }
    }

    fn largest_value(&self) -> f64 {
        let points = self.curves.iter().flat_map(|curve| &curve.points);
        points
            .map(|point| point.1.abs())
            .filter(|y| y.is_finite())
            .fold(0.0, f64::max)
    }
}

/// The rectangle of the axes.
struct Frame {
    left: f64,
    right: f64,
    top: f64,
    bottom: f64,
}

impl Frame {
    fn x(&self, axis: &Axis, value: f64) -> f64 {
        self.left + (value - axis.min) / (axis.max - axis.min) * (self.right - self.left)
    }

    fn y(&self, axis: &Axis, value: f64) -> f64 {
        self.bottom - (value - axis.min) / (axis.max - axis.min) * (self.bottom - self.top)
    }

    /// Grid, frame and tick labels.
    fn axes(&self, x_axis: &Axis, y_axis: &Axis, marks: &mut Vec<Mark>) {
        for tick in &x_axis.ticks {
            let x = self.x(x_axis, *tick);
            marks.push(line((x, self.top), (x, self.bottom), GRID, 0.8));
            marks.push(line((x, self.bottom), (x, self.bottom + 5.0), INK, 1.0));
            let at = (x, self.bottom + 9.0 + SMALL);
            marks.push(text(
                at,
                Anchor::Middle,
                SMALL,
                INK,
                x_axis.label(*tick),
                false,
            ));
        }
        for tick in &y_axis.ticks {
            let y = self.y(y_axis, *tick);
            let is_zero = tick.abs() < 1e-12 * (y_axis.max - y_axis.min);
            let (colour, width) = if is_zero { (ZERO, 1.2) } else { (GRID, 0.8) };
            marks.push(line((self.left, y), (self.right, y), colour, width));
            marks.push(line((self.left - 5.0, y), (self.left, y), INK, 1.0));
            let at = (self.left - 9.0, y + 0.36 * SMALL);
            marks.push(text(
                at,
                Anchor::End,
                SMALL,
                INK,
                y_axis.label(*tick),
                false,
            ));
        }
        let corners = [
            (self.left, self.top),
            (self.right, self.top),
            (self.right, self.bottom),
            (self.left, self.bottom),
            (self.left, self.top),
        ];
        let stroke = Stroke {
            colour: INK,
            width: 1.0,
            dash: &[],
        };
        marks.push(Mark::Path {
            points: corners.to_vec(),
            stroke,
        });
    }

    /// A curve, in as many pieces as gaps ask for.
    fn curve(
        &self,
        curve: &Curve,
        factor: f64,
        x_axis: &Axis,
        y_axis: &Axis,
        stroke: Stroke,
        marks: &mut Vec<Mark>,
    ) {
        let buckets = (self.right - self.left) as usize;
        let placed: Vec<(f64, f64)> = decimate(&curve.points, buckets)
            .into_iter()
            .map(|(x, y)| (self.x(x_axis, x), self.y(y_axis, y * factor)))
            .collect();
        for piece in placed.split(|(x, y)| !(x.is_finite() && y.is_finite())) {
            if piece.len() > 1 {
                marks.push(Mark::Path {
                    points: piece.to_vec(),
                    stroke: stroke.clone(),
                });
            }
        }
    }
}

/// A unit that keeps tick labels short, and the factor to it.
fn readable_unit(unit: &str, largest: f64) -> (String, f64) {
    match unit {
        "N" | "N m" | "Pa" if largest >= 1e7 => (format!("M{unit}"), 1e-6),
        "N" | "N m" | "Pa" if largest >= 1e4 => (format!("k{unit}"), 1e-3),
        _ => (unit.to_owned(), 1.0),
    }
}

fn wrap_bold(title: &str, width: f64) -> Vec<String> {
    // Bold letters are about a tenth wider than the regular ones that `wrap` measures.
    font::wrap(title, TITLE * 1.1, width)
}

fn line(from: (f64, f64), to: (f64, f64), colour: Colour, width: f64) -> Mark {
    Mark::Path {
        points: vec![from, to],
        stroke: Stroke {
            colour,
            width,
            dash: &[],
        },
    }
}

fn text(
    at: (f64, f64),
    anchor: Anchor,
    size: f64,
    colour: Colour,
    content: String,
    bold: bool,
) -> Mark {
    Mark::Text(Text {
        at,
        anchor,
        size,
        bold,
        colour,
        upwards: false,
        content,
    })
}
