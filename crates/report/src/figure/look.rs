//! Colours, dashes and markers of curves.

use super::chart::Look;
use super::drawing::{Colour, INK, Mark, PAPER, Stroke, TINT};

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

/// Curves with more points than this carry markers at some of them only.
const MOST_MARKERS: usize = 40;
/// Markers along a curve that has many points.
const SPARSE_MARKERS: usize = 7;

/// How a curve is drawn.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Pen {
    pub(crate) stroke: Stroke,
    pub(crate) marker: Option<Marker>,
    /// Where markers stand.
    pub(crate) spread: Spread,
}

/// Where along a curve markers stand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Spread {
    /// On every point.
    Every,
    /// On some points; the first one after this share of the distance between two, so that markers
    /// of curves that coincide do not.
    Some { after: f64 },
}

/// The sign on points of a curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Marker {
    /// A filled disc in the colour of the curve.
    Disc,
    /// An open square, larger than the disc, so that both are seen where they meet.
    Square,
    /// A filled triangle that points up.
    Triangle,
    /// A filled square on its corner.
    Diamond,
    /// A cross of two strokes.
    Cross,
    /// An open circle.
    Circle,
    /// A filled triangle that points down.
    Wedge,
    /// A filled square.
    Block,
}

/// Markers of numbered curves; as many as dashes.
const MARKERS: [Marker; 8] = [
    Marker::Disc,
    Marker::Square,
    Marker::Triangle,
    Marker::Cross,
    Marker::Diamond,
    Marker::Circle,
    Marker::Wedge,
    Marker::Block,
];

/// The pen for a curve: `index` among the curves of its panel, with so many points.
pub(crate) fn pen(look: Look, index: usize, points: usize) -> Pen {
    let few = (points <= MOST_MARKERS).then_some(());
    let (colour, width, dash, marker) = match look {
        Look::Numbered => {
            let dash = DASHES[index % DASHES.len()];
            let marker = Some(MARKERS[index % MARKERS.len()]);
            (COLOURS[index % COLOURS.len()], 1.6, dash, marker)
        }
        Look::Plain => {
            let dash = DASHES[index % DASHES.len()];
            (COLOURS[index % COLOURS.len()], 1.6, dash, None)
        }
        Look::Computed => (BLUE, 1.6, DASHES[0], few.map(|()| Marker::Disc)),
        Look::Reference => (INK, 1.4, LONG_DASH, few.map(|()| Marker::Square)),
        Look::Difference => (VERMILION, 1.2, DASHES[0], few.map(|()| Marker::Disc)),
        Look::Bound => (INK, 1.2, DOTS, None),
        Look::Between => (TINT, 0.0, DASHES[0], None),
    };
    let sparse = look == Look::Numbered && points > MOST_MARKERS;
    let turn = index % MARKERS.len();
    Pen {
        stroke: Stroke {
            colour,
            width,
            dash,
        },
        marker,
        spread: match sparse {
            false => Spread::Every,
            true => Spread::Some {
                after: (turn as f64 + 0.5) / MARKERS.len() as f64,
            },
        },
    }
}

impl Spread {
    /// Indices of the points that carry a marker.
    pub(crate) fn places(self, points: usize) -> Vec<usize> {
        match self {
            Spread::Every => (0..points).collect(),
            Spread::Some { after } => {
                let gap = points as f64 / SPARSE_MARKERS as f64;
                let place = |k: usize| ((k as f64 + after) * gap) as usize;
                (0..SPARSE_MARKERS).map(place).collect()
            }
        }
    }
}

impl Marker {
    /// The marks around a point.
    pub(crate) fn marks(self, at: (f64, f64), colour: Colour) -> Vec<Mark> {
        let filled = |points| Mark::Shape {
            points,
            fill: colour,
            stroke: Stroke::solid(PAPER, 0.6),
        };
        let open = |mut points: Vec<(f64, f64)>| {
            points.extend(points.first().copied());
            Mark::Path {
                points,
                stroke: Stroke::solid(colour, 1.2),
            }
        };
        let (x, y) = at;
        let stroke = |d: f64, e: f64| Mark::Path {
            points: vec![(x - d, y - e), (x + d, y + e)],
            stroke: Stroke::solid(colour, 1.4),
        };
        match self {
            Marker::Disc => vec![filled(polygon(at, 3.2, 16, 0.0))],
            Marker::Square => vec![open(polygon(at, 6.4, 4, 0.5))],
            Marker::Triangle => vec![filled(polygon(at, 4.8, 3, -0.25))],
            Marker::Wedge => vec![filled(polygon(at, 4.8, 3, 0.25))],
            Marker::Diamond => vec![filled(polygon(at, 4.8, 4, 0.0))],
            Marker::Block => vec![filled(polygon(at, 4.6, 4, 0.5))],
            Marker::Circle => vec![open(polygon(at, 4.2, 16, 0.0))],
            Marker::Cross => vec![stroke(3.4, 3.4), stroke(3.4, -3.4)],
        }
    }
}

/// Corners of a regular polygon; `turn` in parts of the angle between two corners.
pub(crate) fn polygon(
    (x, y): (f64, f64),
    radius: f64,
    corners: usize,
    turn: f64,
) -> Vec<(f64, f64)> {
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
