//! Colours, dashes, and the legend below the axes.

use super::chart::{INK, SMALL};
use super::drawing::{Anchor, Colour, Mark, Stroke, Text};
use super::font;

/// Colours that stay apart for colour-blind readers and in grey print: Okabe and Ito (2008),
/// "Color Universal Design", darkest first.
const COLOURS: [Colour; 7] = [
    [0x00, 0x72, 0xb2],
    [0xd5, 0x5e, 0x00],
    [0x00, 0x9e, 0x73],
    [0x00, 0x00, 0x00],
    [0xcc, 0x79, 0xa7],
    [0xe6, 0x9f, 0x00],
    [0x56, 0xb4, 0xe9],
];

/// Dashes, so that curves stay apart without colour.
const DASHES: [&[f64]; 5] = [
    &[],
    &[9.0, 3.0],
    &[3.0, 2.0],
    &[10.0, 3.0, 2.5, 3.0],
    &[14.0, 3.0, 2.5, 3.0, 2.5, 3.0],
];

const SAMPLE_WIDTH: f64 = 44.0;
const GAP: f64 = 8.0;
const COLUMN_GAP: f64 = 28.0;
const ROW_HEIGHT: f64 = 19.0;

/// Stroke of the curve with the given number.
pub(crate) fn stroke(index: usize) -> Stroke {
    Stroke {
        colour: COLOURS[index % COLOURS.len()],
        width: 1.6,
        dash: DASHES[index % DASHES.len()],
    }
}

/// Places of the legend's entries: columns of equal width, filled downwards.
pub(crate) struct Legend {
    labels: Vec<String>,
    column_width: f64,
    rows: usize,
}

impl Legend {
    /// Lays out labels in as many columns as fit into `width`; a label that is wider is cut.
    pub(crate) fn new(labels: &[&str], width: f64) -> Self {
        let room = width - SAMPLE_WIDTH - GAP;
        let labels: Vec<String> = labels.iter().map(|label| cut(label, room)).collect();
        let widest = labels
            .iter()
            .map(|l| font::text_width(l, SMALL, false))
            .fold(0.0, f64::max);
        let column_width = SAMPLE_WIDTH + GAP + widest + COLUMN_GAP;
        let columns = ((width + COLUMN_GAP) / column_width).floor().max(1.0) as usize;
        let rows = labels.len().div_ceil(columns);
        Legend {
            labels,
            column_width,
            rows,
        }
    }

    /// Height of the whole legend.
    pub(crate) fn height(&self) -> f64 {
        self.rows as f64 * ROW_HEIGHT
    }

    /// The marks, with the upper left corner at (`left`, `top`).
    pub(crate) fn marks(&self, left: f64, top: f64) -> Vec<Mark> {
        let mut marks = Vec::new();
        for (index, label) in self.labels.iter().enumerate() {
            let x = left + (index / self.rows) as f64 * self.column_width;
            let y = top + ((index % self.rows) as f64 + 0.5) * ROW_HEIGHT;
            marks.push(Mark::Path {
                points: vec![(x, y), (x + SAMPLE_WIDTH, y)],
                stroke: Stroke {
                    width: 2.2,
                    ..stroke(index)
                },
            });
            marks.push(Mark::Text(Text {
                at: (x + SAMPLE_WIDTH + GAP, y + 0.35 * SMALL),
                anchor: Anchor::Start,
                size: SMALL,
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
    if font::text_width(label, SMALL, false) <= room {
        return label.to_owned();
    }
    let mut short = label.to_owned();
    while !short.is_empty() && font::text_width(&format!("{short}…"), SMALL, false) > room {
        short.pop();
    }
    format!("{short}…")
}
