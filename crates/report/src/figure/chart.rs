//! What a chart shows.

/// Font size of tick labels, legend and axis titles.
pub(crate) const SMALL: f64 = 13.0;

/// Curves over one horizontal axis, with everything that explains them.
#[derive(Debug, Clone, PartialEq)]
pub struct Chart {
    /// Title above the axes.
    pub title: String,
    /// The horizontal axis, which all panels share.
    pub x: ChartAxis,
    /// Panels from top to bottom.
    pub panels: Vec<Panel>,
    /// Remark below the legend; may be empty.
    pub note: String,
    /// Width of the whole drawing, in pixels.
    pub width: f64,
    /// Whether a unit is as long across as it is up, in charts of one panel; its height then follows
    /// from what is drawn.
    pub true_to_scale: bool,
}

/// What an axis shows.
#[derive(Debug, Clone, PartialEq)]
pub struct ChartAxis {
    /// Name of the quantity, without its unit.
    pub label: String,
    /// Unit of the values, empty for none. Units are drawn with prefixes or powers of ten where
    /// that keeps the numbers short.
    pub unit: String,
    /// How values are spread over the axis.
    pub scale: Scale,
    /// Whether zero stands on the axis even where no value is near it.
    pub from_zero: bool,
    /// Where ticks are wanted, in `unit`; empty for round numbers.
    pub ticks: Vec<f64>,
}

/// How values are spread over an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scale {
    /// Equal differences are equally long.
    Linear,
    /// Equal ratios are equally long; values that are not positive leave gaps.
    Logarithmic,
}

/// A vertical axis with its curves.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// The vertical axis.
    pub y: ChartAxis,
    /// The curves, painted in order.
    pub curves: Vec<Curve>,
    /// Height between the axes, in pixels.
    pub height: f64,
}

/// One curve.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// Text in the legend; a curve without is not in it.
    pub label: String,
    /// Points in the order in which they are joined; NaN leaves a gap.
    pub points: Vec<(f64, f64)>,
    /// How it is drawn.
    pub look: Look,
}

/// How a curve is drawn: told apart by dashes and markers, not by colour alone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Look {
    /// Colour, dash and marker by its place among the curves of the panel.
    Numbered,
    /// The same without markers.
    Plain,
    /// A solid line, with discs where there are few points.
    Computed,
    /// A dashed line, with open squares where there are few points.
    Reference,
    /// A thin line.
    Difference,
    /// A dotted line.
    Bound,
    /// A tinted surface inside the points.
    Between,
}

impl Chart {
    /// A chart of one panel, in the size of a figure across a page.
    pub fn new(title: &str, x: ChartAxis, y: ChartAxis, curves: Vec<Curve>) -> Self {
        Chart {
            title: title.to_owned(),
            x,
            panels: vec![Panel {
                y,
                curves,
                height: 380.0,
            }],
            note: String::new(),
            width: 900.0,
            true_to_scale: false,
        }
    }

    /// The same with a remark below.
    pub fn with_note(mut self, note: &str) -> Self {
        note.clone_into(&mut self.note);
        self
    }
}

impl ChartAxis {
    /// A linear axis.
    pub fn linear(label: &str, unit: &str) -> Self {
        ChartAxis {
            label: label.to_owned(),
            unit: unit.to_owned(),
            scale: Scale::Linear,
            from_zero: false,
            ticks: Vec::new(),
        }
    }

    /// A logarithmic axis.
    pub fn logarithmic(label: &str, unit: &str) -> Self {
        ChartAxis {
            scale: Scale::Logarithmic,
            ..ChartAxis::linear(label, unit)
        }
    }

    /// The same axis with ticks at these values instead of round numbers.
    pub fn with_ticks(mut self, ticks: Vec<f64>) -> Self {
        self.ticks = ticks;
        self
    }
}

impl Scale {
    /// Whether the value has a place on the axis.
    pub(crate) fn holds(self, value: f64) -> bool {
        value.is_finite() && (self == Scale::Linear || value > 0.0)
    }
}

impl Curve {
    /// A curve that is drawn by its place among the others.
    pub fn new(label: &str, points: Vec<(f64, f64)>) -> Self {
        Curve {
            label: label.to_owned(),
            points,
            look: Look::Numbered,
        }
    }

    /// The same curve, drawn otherwise.
    pub fn with_look(mut self, look: Look) -> Self {
        self.look = look;
        self
    }
}
