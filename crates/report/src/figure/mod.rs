//! Figures: curves on linear and logarithmic axes, as SVG and PNG.
//!
//! A [`Chart`] says what to draw, [`Chart::draw`] lays it out as a [`Drawing`] of lines and texts,
//! and the drawing becomes SVG text or PNG pixels. Both come from the same list of marks, with the
//! same font metrics; the font is part of the program, so that a machine without fonts draws the
//! same picture.

mod axis;
mod chart;
mod decimate;
pub(crate) mod drawing;
pub(crate) mod font;
mod layout;
mod legend;
pub(crate) mod look;
mod png;
mod svg;

pub(crate) use axis::nice_length;
pub use chart::{Chart, ChartAxis, Curve, Look, Panel, Scale};
pub(crate) use decimate::simplify;
pub use drawing::Drawing;
