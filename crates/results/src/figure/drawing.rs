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

/// One element of a drawing, painted in order.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Mark {
    Path {
        points: Vec<(f64, f64)>,
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

/// A line of text.
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
