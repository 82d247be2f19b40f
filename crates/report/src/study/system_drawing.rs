//! The system at rest, to scale, seen from the side.

use catenix_results::{Scene, StoreError};

use super::builder::WIDTH;
use super::data::CaseData;
use super::format::with_unit;
use super::labels::{self, Label, ROW, column, ground, rows, rows_height, text};
use crate::figure::Drawing;
use crate::figure::drawing::{Anchor, Colour, GREY, INK, Mark, PAPER, Stroke};
use crate::figure::font::text_width;
use crate::figure::look::polygon;
use crate::figure::nice_length;
use crate::figure::simplify;
use crate::words::Language;

const SEA: Colour = [0x00, 0x72, 0xb2];
const GROUND: Colour = [0x8a, 0x6d, 0x3b];
/// Strokes of lines, so that neighbours differ without colour.
const LINES: [(Colour, f64, &[f64]); 4] = [
    (INK, 2.4, &[]),
    ([0xd5, 0x5e, 0x00], 1.8, &[]),
    ([0x00, 0x9e, 0x73], 1.8, &[9.0, 3.0]),
    ([0xcc, 0x79, 0xa7], 1.8, &[3.0, 2.0]),
];
const MARGIN: f64 = 14.0;
/// Most pixels from the highest to the lowest thing drawn.
const MOST_HEIGHT: f64 = 600.0;
/// A drawing wider than this many times its height has its labels above.
const WIDE: f64 = 1.3;

/// A point with what it is.
struct Thing {
    at: [f64; 3],
    label: String,
    symbol: Symbol,
}

#[derive(Clone, Copy, PartialEq)]
enum Symbol {
    /// A moving vessel at the surface.
    Hull,
    /// A moving vessel elsewhere.
    Block,
    Anchor,
    /// With its length [m].
    Body(f64),
    Float,
    Weight,
    /// The middle of a line, which has no sign of its own.
    Nothing,
}

/// The drawing, and whether it looks along y (across x) or along x.
pub(super) struct SystemDrawing {
    pub(super) drawing: Drawing,
    /// Horizontal axis of the drawing: 0 for x, 1 for y.
    pub(super) axis: usize,
}

/// Draws the case; `None` where the store has no scene or nothing was found at rest.
pub(super) fn draw(
    case: &CaseData,
    language: Language,
) -> Result<Option<SystemDrawing>, StoreError> {
    let Some(scene) = &case.scene else {
        return Ok(None);
    };
    let mut lines = Vec::new();
    for line in &scene.lines {
        let Some(points) = case.static_positions(&line.name)? else {
            return Ok(None);
        };
        if points.iter().flatten().all(|value| value.is_finite()) {
            lines.push(points);
        } else {
            return Ok(None);
        }
    }
    let things = things(case, scene, &lines, language)?;
    let points = lines.iter().flatten().copied();
    let points: Vec<[f64; 3]> = points.chain(things.iter().map(|thing| thing.at)).collect();
    let extent = |axis: usize| {
        let range = points.iter().map(|point| point[axis]);
        range.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (low.min(value), high.max(value))
        })
    };
    if points.is_empty() {
        return Ok(None);
    }
    let length = |axis: usize| extent(axis).1 - extent(axis).0;
    let axis = usize::from(length(1) > 1.001 * length(0));
    let (mut bottom, mut top) = extent(2);
    if let Some(depth) = scene.water_depth_m {
        // The surface and the seabed are shown where they are not far off.
        let size = (top - bottom).max(length(axis)).max(1e-9);
        if top > -2.0 * size {
            top = top.max(0.0);
        }
        if bottom + depth < 0.75 * size.max(top - bottom) {
            bottom = bottom.min(-depth);
        }
    }
    let frame = Frame::new(extent(axis), (bottom, top), &things, scene, language);
    let mut marks = Vec::new();
    frame.sea(scene, language, &mut marks);
    for (index, line) in lines.iter().enumerate() {
        let (colour, width, dash) = LINES[index % LINES.len()];
        let placed: Vec<(f64, f64)> = line.iter().map(|point| frame.place(point, axis)).collect();
        marks.push(Mark::Path {
            points: simplify(&placed, 0.1),
            stroke: Stroke {
                colour,
                width,
                dash,
            },
        });
    }
    let labels: Vec<Label> = things
        .iter()
        .map(|thing| Label {
            text: thing.label.clone(),
            at: frame.place(&thing.at, axis),
        })
        .collect();
    frame.labels(labels, &mut marks);
    for thing in &things {
        symbol(
            thing.symbol,
            frame.place(&thing.at, axis),
            frame.scale,
            &mut marks,
        );
    }
    frame.dimensions(extent(axis), axis, language, &mut marks);
    Ok(Some(SystemDrawing {
        drawing: Drawing {
            width: WIDTH,
            height: frame.height.ceil(),
            title: String::new(),
            marks,
        },
        axis,
    }))
}

/// Everything that has a label.
fn things(
    case: &CaseData,
    scene: &Scene,
    lines: &[Vec<[f64; 3]>],
    language: Language,
) -> Result<Vec<Thing>, StoreError> {
    let mut things = Vec::new();
    for vessel in &scene.vessels {
        let at = vessel.position_m;
        let (symbol, word) = match (vessel.moves, scene.water_depth_m) {
            (false, _) => (Symbol::Anchor, "drawing.anchor"),
            (true, Some(depth)) if at[2] > -0.05 * depth => (Symbol::Hull, "drawing.vessel"),
            (true, _) => (Symbol::Block, "drawing.vessel"),
        };
        things.push(Thing {
            at,
            label: language.fill(word, &[("name", &vessel.name)]),
            symbol,
        });
    }
    for body in &scene.bodies {
        let mut at = [f64::NAN; 3];
        for (value, axis) in at.iter_mut().zip(["x", "y", "z"]) {
            let history = case.history(&format!("{}.{axis}", body.name))?;
            *value = history
                .and_then(|h| h.values.first().copied())
                .unwrap_or(f64::NAN);
        }
        if !at.iter().all(|value| value.is_finite()) {
            continue;
        }
        let mass = with_unit(body.mass_kg / 1000.0, "t");
        things.push(Thing {
            at,
            label: language.fill("drawing.body", &[("name", &body.name), ("mass", &mass)]),
            symbol: Symbol::Body(body.length_m),
        });
    }
    for (line, points) in scene.lines.iter().zip(lines) {
        let Ok(arc_length) = case.stored.arc_length_m(&line.name) else {
            continue;
        };
        // A little off the middle, so that the label does not meet that of a float there.
        let length = with_unit(line.length_m, "m");
        things.push(Thing {
            at: point_at(&arc_length, points, 0.45 * line.length_m),
            label: language.fill("drawing.line", &[("name", &line.name), ("length", &length)]),
            symbol: Symbol::Nothing,
        });
        for lump in &line.attachments {
            let is_float = lump.wet_weight_n < 0.0;
            let word = match is_float {
                true => "drawing.float",
                false => "drawing.weight",
            };
            let values = [
                ("name", lump.name.as_str()),
                ("weight", &with_unit(lump.wet_weight_n.abs(), "N")),
                ("place", &with_unit(lump.arc_length_m, "m")),
            ];
            things.push(Thing {
                at: point_at(&arc_length, points, lump.arc_length_m),
                label: language.fill(word, &values),
                symbol: if is_float {
                    Symbol::Float
                } else {
                    Symbol::Weight
                },
            });
        }
    }
    Ok(things)
}

/// The point of a line at a distance from end A.
fn point_at(arc_length: &[f64], points: &[[f64; 3]], at: f64) -> [f64; 3] {
    let next = arc_length.partition_point(|length| *length < at);
    let next = next.clamp(1, points.len().saturating_sub(1).max(1));
    let (Some(from), Some(to)) = (points.get(next - 1), points.get(next)) else {
        return points.first().copied().unwrap_or_default();
    };
    let [start, end] = [next - 1, next].map(|k| arc_length.get(k).copied().unwrap_or(0.0));
    let share = ((at - start) / (end - start)).clamp(0.0, 1.0);
    std::array::from_fn(|axis| from[axis] + share * (to[axis] - from[axis]))
}

/// Where metres are on the paper.
struct Frame {
    /// Pixels per metre.
    scale: f64,
    /// Pixels of the origin.
    origin: (f64, f64),
    /// The drawing without labels: left, right, top, bottom [pixels].
    inner: [f64; 4],
    /// Heights of the lowest and highest thing [m].
    heights: (f64, f64),
    height: f64,
    is_wide: bool,
}

impl Frame {
    fn new(
        (from, to): (f64, f64),
        heights: (f64, f64),
        things: &[Thing],
        scene: &Scene,
        language: Language,
    ) -> Self {
        let (across, up) = ((to - from).max(1e-9), (heights.1 - heights.0).max(1e-9));
        let is_wide = across > WIDE * up;
        let widths = things
            .iter()
            .map(|t| text_width(&t.label, labels::SIZE, false));
        let widest = widths.fold(0.0, f64::max);
        let depth_room = match scene.water_depth_m {
            Some(depth) => 30.0 + text_width(&depth_text(depth, language), labels::SIZE, false),
            None => 10.0,
        };
        let above = if is_wide {
            rows_height(things.len()) + 22.0
        } else {
            14.0
        };
        let below = 62.0;
        let side = if is_wide { 26.0 } else { widest + 58.0 };
        let room = WIDTH - 2.0 * MARGIN - depth_room - 2.0 * side;
        let scale = (room.max(80.0) / across).min((MOST_HEIGHT / up).min(1e9));
        let (width, tall) = (scale * across, (scale * up).max(40.0));
        let middle = MARGIN + depth_room + 0.5 * (WIDTH - 2.0 * MARGIN - depth_room);
        let top = MARGIN + above + 10.0;
        let inner = [middle - 0.5 * width, middle + 0.5 * width, top, top + tall];
        let slack = 0.5 * (tall - scale * up);
        Frame {
            scale,
            origin: (inner[0] - scale * from, top + slack + scale * heights.1),
            inner,
            heights,
            height: top + tall + below + MARGIN,
            is_wide,
        }
    }

    fn place(&self, point: &[f64; 3], axis: usize) -> (f64, f64) {
        (
            self.origin.0 + self.scale * point[axis],
            self.origin.1 - self.scale * point[2],
        )
    }

    fn y(&self, height: f64) -> f64 {
        self.origin.1 - self.scale * height
    }

    /// Surface, seabed and depth, where they are in the picture.
    fn sea(&self, scene: &Scene, language: Language, marks: &mut Vec<Mark>) {
        let Some(depth) = scene.water_depth_m else {
            return;
        };
        let [left, right, ..] = self.inner;
        let (from, to) = (left - 24.0, right + 24.0);
        let shown = |z: f64| (self.heights.0 - 1e-9..=self.heights.1 + 1e-9).contains(&z);
        let line = |y: f64, colour, width| Mark::Path {
            points: vec![(from, y), (to, y)],
            stroke: Stroke::solid(colour, width),
        };
        let end = from - 6.0;
        let name = |key: &'static str| language.text(key).to_owned();
        if shown(0.0) {
            let y = self.y(0.0);
            marks.push(line(y, SEA, 1.2));
            for (width, below) in [(9.0, 3.0), (5.0, 6.0)] {
                marks.push(Mark::Path {
                    points: vec![
                        (from + 10.0 - width, y + below),
                        (from + 10.0 + width, y + below),
                    ],
                    stroke: Stroke::solid(SEA, 1.0),
                });
            }
            let at = (end, y + 0.36 * labels::SIZE);
            marks.push(text(name("drawing.surface"), at, Anchor::End));
        }
        if shown(-depth) {
            let y = self.y(-depth);
            marks.push(line(y, GROUND, 1.6));
            let hatches = ((to - from) / 12.0) as usize;
            for k in 0..hatches {
                let x = from + 12.0 * k as f64 + 8.0;
                marks.push(Mark::Path {
                    points: vec![(x, y), (x - 6.0, y + 7.0)],
                    stroke: Stroke::solid(GROUND, 0.9),
                });
            }
            let at = (end, y + 0.36 * labels::SIZE);
            marks.push(text(name("drawing.seabed"), at, Anchor::End));
        }
        if shown(0.0) && shown(-depth) {
            let x = from - 14.0;
            let (top, bottom) = (self.y(0.0) + 12.0, self.y(-depth) - 12.0);
            if bottom - top > 3.0 * ROW {
                arrow((x, top), (x, bottom), marks);
                let content = depth_text(depth, language);
                let width = text_width(&content, labels::SIZE, false);
                let y = 0.5 * (top + bottom);
                marks.push(ground(x - 8.0 - width, y, width + 4.0));
                marks.push(text(
                    content,
                    (x - 6.0, y + 0.36 * labels::SIZE),
                    Anchor::End,
                ));
            }
        }
    }

    fn labels(&self, all: Vec<Label>, marks: &mut Vec<Mark>) {
        let [left, right, top, bottom] = self.inner;
        if self.is_wide {
            let room = (MARGIN, WIDTH - MARGIN);
            marks.extend(rows(all, room, top - 22.0));
            return;
        }
        // Both columns stand clear of the sea's lines and the dimension of the depth on the left.
        marks.extend(column(all, right + 40.0, false, (top - 14.0, bottom)));
        let _ = left;
    }

    /// Horizontal length and scale bar, below the drawing.
    fn dimensions(
        &self,
        (from, to): (f64, f64),
        axis: usize,
        language: Language,
        marks: &mut Vec<Mark>,
    ) {
        let bottom = self.inner[3] + 24.0;
        let [start, end] = [from, to].map(|value| self.origin.0 + self.scale * value);
        if end - start > 30.0 {
            arrow((start, bottom), (end, bottom), marks);
            let content = with_unit(rounded(to - from), "m");
            let at = (0.5 * (start + end), bottom - 6.0);
            marks.push(text(content, at, Anchor::Middle));
        }
        let length = nice_length(110.0 / self.scale);
        let bar = self.scale * length;
        let y = bottom + 26.0;
        let x = WIDTH - MARGIN - bar - 90.0;
        marks.push(Mark::Path {
            points: vec![(x, y - 5.0), (x, y), (x + bar, y), (x + bar, y - 5.0)],
            stroke: Stroke::solid(INK, 1.2),
        });
        let at = (x + bar + 8.0, y);
        marks.push(text(with_unit(length, "m"), at, Anchor::Start));
        let name = if axis == 0 { "x" } else { "y" };
        self.axes(name, language, marks);
    }

    /// A pair of axes in the lower left corner.
    fn axes(&self, name: &str, _language: Language, marks: &mut Vec<Mark>) {
        let corner = (MARGIN + 14.0, self.height - MARGIN - 6.0);
        arrow_head(corner, (corner.0 + 34.0, corner.1), marks);
        arrow_head(corner, (corner.0, corner.1 - 34.0), marks);
        let x = (corner.0 + 40.0, corner.1 + 4.0);
        marks.push(text(name.to_owned(), x, Anchor::Start));
        let z = (corner.0 + 6.0, corner.1 - 30.0);
        marks.push(text("z".to_owned(), z, Anchor::Start));
    }
}

fn depth_text(depth: f64, language: Language) -> String {
    language.fill("drawing.depth", &[("depth", &with_unit(depth, "m"))])
}

/// A length with at most four digits.
fn rounded(length: f64) -> f64 {
    let power = 10_f64.powf(length.abs().max(1e-12).log10().floor() - 3.0);
    (length / power).round() * power
}

/// A dimension line with a head at both ends.
fn arrow(from: (f64, f64), to: (f64, f64), marks: &mut Vec<Mark>) {
    arrow_head(from, to, marks);
    arrow_head(to, from, marks);
}

fn arrow_head(from: (f64, f64), to: (f64, f64), marks: &mut Vec<Mark>) {
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let length = dx.hypot(dy).max(1e-9);
    let (ux, uy) = (dx / length, dy / length);
    let base = (to.0 - 7.0 * ux, to.1 - 7.0 * uy);
    marks.push(Mark::Path {
        points: vec![from, base],
        stroke: Stroke::solid(GREY, 1.0),
    });
    marks.push(Mark::Shape {
        points: vec![
            to,
            (base.0 - 2.6 * uy, base.1 + 2.6 * ux),
            (base.0 + 2.6 * uy, base.1 - 2.6 * ux),
        ],
        fill: GREY,
        stroke: Stroke::solid(GREY, 0.4),
    });
}

fn symbol(symbol: Symbol, (x, y): (f64, f64), scale: f64, marks: &mut Vec<Mark>) {
    let shape = |points: Vec<(f64, f64)>, fill| Mark::Shape {
        points,
        fill,
        stroke: Stroke::solid(INK, 1.2),
    };
    let rectangle = |half_width: f64, half_height: f64, fill| {
        let points = vec![
            (x - half_width, y - half_height),
            (x + half_width, y - half_height),
            (x + half_width, y + half_height),
            (x - half_width, y + half_height),
        ];
        shape(points, fill)
    };
    match symbol {
        Symbol::Hull => {
            let points = [(-24.0, -9.0), (26.0, -9.0), (18.0, 4.0), (-20.0, 4.0)];
            let moved = points.map(|(dx, dy)| (x + dx, y + dy));
            marks.push(shape(moved.to_vec(), PAPER));
            let house = [(-19.0, -9.0), (-19.0, -18.0), (-8.0, -18.0), (-8.0, -9.0)];
            let moved = house.map(|(dx, dy)| (x + dx, y + dy));
            marks.push(shape(moved.to_vec(), PAPER));
        }
        Symbol::Block => marks.push(rectangle(10.0, 6.0, PAPER)),
        Symbol::Anchor => {
            marks.push(shape(polygon((x, y + 3.5), 7.0, 3, -0.25), INK));
        }
        Symbol::Body(length) => {
            let half_height = (0.5 * length * scale).clamp(5.0, 60.0);
            marks.push(rectangle(5.0, half_height, GREY));
        }
        Symbol::Float => marks.push(shape(polygon((x, y), 5.0, 20, 0.0), PAPER)),
        Symbol::Weight => marks.push(shape(polygon((x, y), 4.0, 20, 0.0), INK)),
        Symbol::Nothing => {}
    }
}
