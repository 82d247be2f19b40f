//! Lays out panels, axes, curves, legend, title and note.

use super::axis::Axis;
use super::chart::{Chart, ChartAxis, Panel, SMALL, Scale};
use super::decimate::{decimate, simplify};
use super::drawing::{Anchor, Colour, Drawing, GREY, GRID, INK, Mark, Stroke, Text, ZERO};
use super::font;
use super::legend::Legend;
use super::look::{Pen, pen};
use crate::number::readable_unit;

const TITLE: f64 = 17.0;
const NOTE: f64 = 11.0;
const MARGIN: f64 = 18.0;
const RIGHT: f64 = 26.0;
/// Least height of a panel that is true to scale.
const LEAST_HEIGHT: f64 = 90.0;
/// Least width of one.
const LEAST_WIDTH: f64 = 260.0;
/// Lines may leave out points that lie so near to them; the eye sees no less at 300 dots per inch.
const DRAWN_EXACTLY: f64 = 0.12;
/// Between two panels.
const PANEL_GAP: f64 = 16.0;

impl Chart {
    /// Lays the chart out.
    pub fn draw(&self) -> Drawing {
        let mut x = Ruler::new(
            &self.x,
            self.x_values(),
            (self.width / 100.0) as usize,
            false,
        );
        let mut rulers: Vec<Ruler> = self
            .panels
            .iter()
            .map(|panel| {
                let target = (panel.height / 25.0).clamp(3.0, 7.0) as usize;
                let values = self.points(panel).map(|point| point.1);
                Ruler::new(&panel.y, values, target, true)
            })
            .collect();
        let mut right = self.width - RIGHT;
        let left = |rulers: &[Ruler]| {
            let ticks = rulers.iter().flat_map(|ruler| &ruler.axis.ticks);
            let widths = ticks.map(|tick| font::text_width(&tick.label, SMALL, false));
            MARGIN + SMALL + 14.0 + widths.fold(0.0, f64::max) + 8.0
        };
        let mut heights: Vec<f64> = self.panels.iter().map(|panel| panel.height).collect();
        if let (1, true) = (rulers.len(), self.true_to_scale) {
            // The ticks of the new axis may take another width, which changes its scale again.
            let most = self.panels[0].height;
            for _ in 0..2 {
                let width = right - left(&rulers);
                let height = Ruler::share_scale(&mut x, &mut rulers[0], width, most);
                (right, heights[0]) = (left(&rulers) + height.0, height.1);
            }
        }
        let left = left(&rulers);
        let mut marks = Vec::new();

        // Bold letters are about a tenth wider than the regular ones that `wrap` measures.
        let mut top = MARGIN;
        for line in font::wrap(&self.title, TITLE * 1.1, self.width - RIGHT - left) {
            let at = (left, top + TITLE);
            marks.push(text(at, Anchor::Start, TITLE, INK, line, true));
            top += TITLE + 6.0;
        }
        top += if self.title.is_empty() { 0.0 } else { 8.0 };

        let last = self.panels.len().saturating_sub(1);
        let mut bottom = top;
        let sized = self.panels.iter().zip(&heights);
        for (index, ((panel, height), y)) in sized.zip(&rulers).enumerate() {
            let frame = Frame {
                left,
                right,
                top,
                bottom: top + height,
            };
            frame.axes(&x.axis, &y.axis, index == last, &mut marks);
            let room = height + if index == last { 0.0 } else { PANEL_GAP };
            frame.y_title(&y.title, room, &mut marks);
            for (curve, pen) in panel.curves.iter().zip(pens(panel)) {
                frame.curve(&curve.points, &x, y, &pen, &mut marks);
            }
            bottom = frame.bottom;
            top = frame.bottom + PANEL_GAP;
        }

        let middle = 0.5 * (left + right);
        let below = bottom + 44.0;
        let title = text((middle, below), Anchor::Middle, SMALL, INK, x.title, false);
        marks.push(title);
        let beside = self.width - RIGHT - right - 24.0;
        let mut legend = self.legend(self.width - RIGHT - left);
        let mut bottom = below + 14.0;
        if legend.width() <= beside && self.true_to_scale {
            // Beside a narrow panel, in one column.
            legend = self.legend(legend.width());
            marks.extend(legend.marks(right + 24.0, top - PANEL_GAP - heights[0] - 4.0));
        } else {
            marks.extend(legend.marks(left, bottom));
            bottom += legend.height();
        }
        if !self.note.is_empty() {
            bottom += 8.0;
            for line in font::wrap(&self.note, NOTE, self.width - RIGHT - left) {
                bottom += NOTE + 4.0;
                let at = (left, bottom);
                marks.push(text(at, Anchor::Start, NOTE, GREY, line, false));
            }
        }
        Drawing {
            width: self.width,
            height: (bottom + MARGIN).ceil(),
            title: self.title.clone(),
            marks,
        }
    }

    /// Points that both axes hold.
    fn points<'a>(&'a self, panel: &'a Panel) -> impl Iterator<Item = (f64, f64)> + 'a {
        panel
            .curves
            .iter()
            .flat_map(|curve| curve.points.iter().copied())
            .filter(|(x, y)| self.x.scale.holds(*x) && panel.y.scale.holds(*y))
    }

    fn x_values(&self) -> impl Iterator<Item = f64> + '_ {
        self.panels
            .iter()
            .flat_map(|panel| self.points(panel))
            .map(|point| point.0)
    }

    fn legend(&self, width: f64) -> Legend {
        let entries = self
            .panels
            .iter()
            .flat_map(|panel| panel.curves.iter().zip(pens(panel)))
            .filter(|(curve, _)| !curve.label.is_empty())
            .map(|(curve, pen)| (curve.label.as_str(), pen));
        Legend::new(entries.collect(), width)
    }
}

fn pens(panel: &Panel) -> impl Iterator<Item = Pen> + '_ {
    let curves = panel.curves.iter().enumerate();
    curves.map(|(index, curve)| pen(curve.look, index, curve.points.len()))
}

/// An axis in the unit that it is drawn in.
struct Ruler {
    axis: Axis,
    factor: f64,
    title: String,
}

impl Ruler {
    fn new(
        what: &ChartAxis,
        values: impl Iterator<Item = f64>,
        target: usize,
        margin: bool,
    ) -> Self {
        let zero = what.from_zero.then_some(0.0);
        let values: Vec<f64> = values.chain(zero).collect();
        let (unit, factor) = match what.scale {
            Scale::Linear => {
                let largest = values.iter().map(|value| value.abs()).fold(0.0, f64::max);
                readable_unit(&what.unit, largest)
            }
            // The labels are short as they are.
            Scale::Logarithmic => (what.unit.clone(), 1.0),
        };
        let title = match unit.as_str() {
            "" => what.label.clone(),
            unit => format!("{} [{unit}]", what.label),
        };
        let values = values.into_iter().map(|value| value * factor);
        let mut axis = Axis::new(what.scale, values, target, margin);
        if !what.ticks.is_empty() {
            axis.set_ticks(what.ticks.iter().map(|tick| tick * factor));
        }
        Ruler {
            axis,
            factor,
            title,
        }
    }

    fn place(&self, value: f64) -> f64 {
        self.axis.place(value * self.factor)
    }

    /// Makes a unit equally long on both axes of a panel; returns its width and height, at most
    /// `width` and `most` pixels.
    fn share_scale(x: &mut Ruler, y: &mut Ruler, width: f64, most: f64) -> (f64, f64) {
        let metres = |ruler: &Ruler| ruler.axis.length() / ruler.factor;
        let (across, up) = (metres(x), metres(y));
        let pixels = (width / across).min(most / up);
        let height = (pixels * up).max(LEAST_HEIGHT);
        let width = (1.08 * pixels * across).max(LEAST_WIDTH).min(width);
        x.stretch(width / pixels, (width / 70.0) as usize);
        y.stretch(height / pixels, (height / 40.0).clamp(3.0, 12.0) as usize);
        (width, height)
    }

    /// Lengthens the axis about its middle to `length`, in the unit of the values.
    fn stretch(&mut self, length: f64, target: usize) {
        self.axis = self.axis.stretched(length * self.factor, target);
    }
}

/// The rectangle of a panel.
struct Frame {
    left: f64,
    right: f64,
    top: f64,
    bottom: f64,
}

impl Frame {
    fn x(&self, place: f64) -> f64 {
        self.left + place * (self.right - self.left)
    }

    fn y(&self, place: f64) -> f64 {
        self.bottom - place * (self.bottom - self.top)
    }

    /// Grid, frame and tick labels; those of the horizontal axis below the last panel only.
    fn axes(&self, x_axis: &Axis, y_axis: &Axis, last: bool, marks: &mut Vec<Mark>) {
        for tick in &x_axis.ticks {
            let x = self.x(x_axis.place(tick.value));
            marks.push(line((x, self.top), (x, self.bottom), GRID, 0.8));
            marks.push(line((x, self.bottom), (x, self.bottom + 5.0), INK, 1.0));
            if last {
                let at = (x, self.bottom + 9.0 + SMALL);
                let label = tick.label.clone();
                marks.push(text(at, Anchor::Middle, SMALL, INK, label, false));
            }
        }
        for value in &x_axis.minor {
            let x = self.x(x_axis.place(*value));
            marks.push(line((x, self.bottom), (x, self.bottom + 3.0), INK, 0.7));
        }
        for tick in &y_axis.ticks {
            let y = self.y(y_axis.place(tick.value));
            let (colour, width) = match y_axis.is_zero(tick) {
                true => (ZERO, 1.2),
                false => (GRID, 0.8),
            };
            marks.push(line((self.left, y), (self.right, y), colour, width));
            marks.push(line((self.left - 5.0, y), (self.left, y), INK, 1.0));
            let at = (self.left - 9.0, y + 0.36 * SMALL);
            let label = tick.label.clone();
            marks.push(text(at, Anchor::End, SMALL, INK, label, false));
        }
        for value in &y_axis.minor {
            let y = self.y(y_axis.place(*value));
            marks.push(line((self.left - 3.0, y), (self.left, y), INK, 0.7));
        }
        let corners = [
            (self.left, self.top),
            (self.right, self.top),
            (self.right, self.bottom),
            (self.left, self.bottom),
            (self.left, self.top),
        ];
        marks.push(Mark::Path {
            points: corners.to_vec(),
            stroke: Stroke::solid(INK, 1.0),
        });
    }

    /// The title of the vertical axis beside it, smaller where it is longer than the axis.
    fn y_title(&self, title: &str, room: f64, marks: &mut Vec<Mark>) {
        let width = font::text_width(title, SMALL, false);
        let size = SMALL * (room / width.max(1.0)).clamp(0.6, 1.0);
        marks.push(Mark::Text(Text {
            at: (MARGIN + SMALL, 0.5 * (self.top + self.bottom)),
            anchor: Anchor::Middle,
            size,
            bold: false,
            colour: INK,
            upwards: true,
            content: title.to_owned(),
        }));
    }

    /// A curve, in as many pieces as gaps ask for, with its markers.
    fn curve(&self, points: &[(f64, f64)], x: &Ruler, y: &Ruler, pen: &Pen, marks: &mut Vec<Mark>) {
        let buckets = (0.5 * (self.right - self.left)) as usize;
        let place = |(at, value): (f64, f64)| (self.x(x.place(at)), self.y(y.place(value)));
        let is_drawn = |(x, y): &(f64, f64)| x.is_finite() && y.is_finite();
        let placed: Vec<(f64, f64)> = decimate(points, buckets).into_iter().map(place).collect();
        for piece in placed.split(|point| !is_drawn(point)) {
            if piece.len() > 1 {
                let points = simplify(piece, DRAWN_EXACTLY);
                marks.push(match pen.stroke.width {
                    0.0 => Mark::Shape {
                        points,
                        fill: pen.stroke.colour,
                        stroke: pen.stroke.clone(),
                    },
                    _ => Mark::Path {
                        points,
                        stroke: pen.stroke.clone(),
                    },
                });
            }
        }
        let Some(marker) = pen.marker else {
            return;
        };
        let places = pen.spread.places(points.len()).into_iter();
        let marked = places.filter_map(|index| points.get(index).copied());
        for at in marked.map(place).filter(is_drawn) {
            marks.extend(marker.marks(at, pen.stroke.colour));
        }
    }
}

fn line(from: (f64, f64), to: (f64, f64), colour: Colour, width: f64) -> Mark {
    Mark::Path {
        points: vec![from, to],
        stroke: Stroke::solid(colour, width),
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
