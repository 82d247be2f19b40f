//! A picture as a list of marks, independent of the file format.

/// A laid-out picture; coordinates in pixels, y down.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawing {
    pub(crate) width: f64,
    pub(crate) height: f64,
    pub(crate) title: String,
    pub(crate) marks: Vec<Mark>,
}

/// Colour as `[red, green, blue]`.
pub(crate) type Colour = [u8; 3];

/// The ground of every drawing.
pub(crate) const PAPER: Colour = [0xff, 0xff, 0xff];
pub(crate) const INK: Colour = [0x1a, 0x1a, 0x1a];
pub(crate) const GREY: Colour = [0x55, 0x55, 0x55];
pub(crate) const GRID: Colour = [0xdd, 0xdd, 0xdd];
pub(crate) const ZERO: Colour = [0x99, 0x99, 0x99];
/// Between the smallest and the largest value.
pub(crate) const TINT: Colour = [0xd6, 0xe6, 0xf2];

/// One element of a drawing, painted in order.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Mark {
    /// An open line.
    Path {
        points: Vec<(f64, f64)>,
        stroke: Stroke,
    },
    /// A closed outline, filled.
    Shape {
        points: Vec<(f64, f64)>,
        fill: Colour,
        stroke: Stroke,
    },
    Text(Text),
}

/// How a path is drawn.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Stroke {
    pub(crate) colour: Colour,
    pub(crate) width: f64,
    /// Lengths of dashes and gaps; empty for a solid line.
    pub(crate) dash: &'static [f64],
}

impl Stroke {
    pub(crate) fn solid(colour: Colour, width: f64) -> Self {
        Stroke {
            colour,
            width,
            dash: &[],
        }
    }
}

/// A line of text; superscript characters are drawn as raised plain ones.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Text {
    /// Where the baseline starts, is centred, or ends.
    pub(crate) at: (f64, f64),
    pub(crate) anchor: Anchor,
    pub(crate) size: f64,
    pub(crate) bold: bool,
    pub(crate) colour: Colour,
    /// Reads from bottom to top.
    pub(crate) upwards: bool,
    pub(crate) content: String,
}

/// Which part of a text is at its position.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Anchor {
    Start,
    Middle,
    End,
}
