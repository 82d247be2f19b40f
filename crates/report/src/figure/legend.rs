//! The legend below the axes, where it covers no curve.

use super::drawing::{Anchor, INK, Mark, Stroke, Text};
use super::font;
use super::look::Pen;

const SAMPLE_WIDTH: f64 = 40.0;
const GAP: f64 = 8.0;
const COLUMN_GAP: f64 = 18.0;
const ROW_HEIGHT: f64 = 18.0;
/// Size of the labels.
const SIZE: f64 = 12.0;

/// Entries in columns as wide as the widest label.
pub(crate) struct Legend {
    entries: Vec<(String, Pen)>,
    column_width: f64,
    rows: usize,
}

impl Legend {
    /// Arranges the entries within `width`; labels that are too long are cut.
    pub(crate) fn new(entries: Vec<(&str, Pen)>, width: f64) -> Self {
        let room = width - SAMPLE_WIDTH - GAP;
        let entries: Vec<(String, Pen)> = entries
            .into_iter()
            .map(|(label, pen)| (cut(label, room), pen))
            .collect();
        let widest = entries
            .iter()
            .map(|(label, _)| font::text_width(label, SIZE, false))
            .fold(0.0, f64::max);
        let column_width = SAMPLE_WIDTH + GAP + widest + COLUMN_GAP;
        let columns = ((width + COLUMN_GAP) / column_width).floor().max(1.0) as usize;
        let rows = entries.len().div_ceil(columns);
        Legend {
            entries,
            column_width,
            rows,
        }
    }

    /// Width of a legend of one column.
    pub(crate) fn width(&self) -> f64 {
        self.column_width - COLUMN_GAP
    }

    /// Height of the whole legend.
    pub(crate) fn height(&self) -> f64 {
        self.rows as f64 * ROW_HEIGHT
    }

    /// The marks, with the upper left corner at (`left`, `top`).
    pub(crate) fn marks(&self, left: f64, top: f64) -> Vec<Mark> {
        let mut marks = Vec::new();
        for (index, (label, pen)) in self.entries.iter().enumerate() {
            let x = left + (index / self.rows) as f64 * self.column_width;
            let y = top + ((index % self.rows) as f64 + 0.5) * ROW_HEIGHT;
            marks.push(match pen.stroke.width {
                // A surface, not a line.
                0.0 => Mark::Shape {
                    points: vec![
                        (x, y - 5.0),
                        (x + SAMPLE_WIDTH, y - 5.0),
                        (x + SAMPLE_WIDTH, y + 5.0),
                        (x, y + 5.0),
                    ],
                    fill: pen.stroke.colour,
                    stroke: pen.stroke.clone(),
                },
                width => Mark::Path {
                    points: vec![(x, y), (x + SAMPLE_WIDTH, y)],
                    stroke: Stroke {
                        width: width + 0.4,
                        ..pen.stroke.clone()
                    },
                },
            });
            if let Some(marker) = pen.marker {
                let at = (x + 0.5 * SAMPLE_WIDTH, y);
                marks.extend(marker.marks(at, pen.stroke.colour));
            }
            marks.push(Mark::Text(Text {
                at: (x + SAMPLE_WIDTH + GAP, y + 0.35 * SIZE),
                anchor: Anchor::Start,
                size: SIZE,
                bold: false,
                colour: INK,
                upwards: false,
                content: label.clone(),
            }));
        }
        marks
    }
}

/// A label no wider than `room`, with an ellipsis where something is missing.
fn cut(label: &str, room: f64) -> String {
    if font::text_width(label, SIZE, false) <= room {
        return label.to_owned();
    }
    let mut short = label.to_owned();
    while !short.is_empty() && font::text_width(&format!("{short}…"), SIZE, false) > room {
        short.pop();
    }
    format!("{short}…")
}
