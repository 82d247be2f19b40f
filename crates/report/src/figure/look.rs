//! Colours, dashes and markers of curves.

use super::chart::Look;
use super::drawing::{Colour, INK, Mark, PAPER, Stroke};

/// Colours that stay apart for colour-blind readers and in grey print: Okabe and Ito (2008),
/// "Color Universal Design", darkest first.
const COLOURS: [Colour; 7] = [
    BLUE,
    VERMILION,
    [0x00, 0x9e, 0x73],
    [0x00, 0x00, 0x00],
    [0xcc, 0x79, 0xa7],
    [0xe6, 0x9f, 0x00],
    [0x56, 0xb4, 0xe9],
];
const BLUE: Colour = [0x00, 0x72, 0xb2];
const VERMILION: Colour = [0xd5, 0x5e, 0x00];

/// Dashes, so that curves stay apart without colour. Their count has no factor in common with that
/// of the colours, so that both together repeat late.
const DASHES: [&[f64]; 8] = [
    &[],
    &[9.0, 3.0],
    &[3.0, 2.0],
    &[10.0, 3.0, 2.5, 3.0],
    &[14.0, 3.0, 2.5, 3.0, 2.5, 3.0],
    &[18.0, 5.0],
    &[2.0, 5.0],
    &[8.0, 2.5, 8.0, 8.0],
];
const LONG_DASH: &[f64] = &[7.0, 5.0];
const DOTS: &[f64] = &[2.0, 3.0];

/// Curves with more points than this carry no markers.
const MOST_MARKERS: usize = 40;

/// How a curve is drawn.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Pen {
    pub(crate) stroke: Stroke,
    pub(crate) marker: Option<Marker>,
}

/// The sign on every point of a curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Marker {
    /// A filled disc in the colour of the curve.
    Disc,
    /// An open square, larger than the disc, so that both are seen where they meet.
    Square,
}

/// The pen for a curve: `index` among the curves of its panel, with so many points.
pub(crate) fn pen(look: Look, index: usize, points: usize) -> Pen {
    let few = (points <= MOST_MARKERS).then_some(());
    let (colour, width, dash, marker) = match look {
        Look::Numbered => {
            let dash = DASHES[index % DASHES.len()];
            let marker = [Marker::Disc, Marker::Square][index % 2];
            (COLOURS[index % COLOURS.len()], 1.6, dash, few.map(|()| marker))
        }
        Look::Computed => (BLUE, 1.6, DASHES[0], few.map(|()| Marker::Disc)),
        Look::Reference => (INK, 1.4, LONG_DASH, few.map(|()| Marker::Square)),
        Look::Difference => (VERMILION, 1.2, DASHES[0], few.map(|()| Marker::Disc)),
        Look::Bound => (INK, 1.2, DOTS, None),
    };
    Pen {
        stroke: Stroke {
            colour,
            width,
            dash,
        },
        marker,
    }
}

impl Marker {
    /// The marker around a point.
    pub(crate) fn mark(self, (x, y): (f64, f64), colour: Colour) -> Mark {
        match self {
            Marker::Disc => Mark::Shape {
                points: polygon((x, y), 3.2, 16, 0.0),
                fill: colour,
                stroke: Stroke::solid(PAPER, 0.6),
            },
            Marker::Square => Mark::Path {
                points: {
                    let mut corners = polygon((x, y), 6.4, 4, 0.5);
                    corners.push(corners[0]);
                    corners
                },
                stroke: Stroke::solid(colour, 1.2),
            },
        }
    }
}

/// Corners of a regular polygon; `turn` in parts of the angle between two corners.
fn polygon((x, y): (f64, f64), radius: f64, corners: usize, turn: f64) -> Vec<(f64, f64)> {
    let angle = std::f64::consts::TAU / corners as f64;
    (0..corners)
        .map(|corner| (corner as f64 + turn) * angle)
        .map(|angle| (x + radius * angle.cos(), y + radius * angle.sin()))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eight_curves_differ_without_colour_and_fifty_with_it() {
        let pens: Vec<Pen> = (0..56)
            .map(|index| pen(Look::Numbered, index, 100))
            .collect();
        for (index, one) in pens.iter().enumerate() {
            for (other, another) in pens.iter().enumerate().take(index) {
                assert_ne!(one, another, "{index} and {other}");
                let near = index < DASHES.len();
                assert!(
                    !near || one.stroke.dash != another.stroke.dash,
                    "{index} and {other}"
                );
            }
        }
    }
}
