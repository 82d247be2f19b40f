//! Figures: curves on linear and logarithmic axes, as SVG and PNG.
//!
//! A [`Chart`] says what to draw, [`Chart::draw`] lays it out as a [`Drawing`] of lines and texts,
//! and the drawing becomes SVG text or PNG pixels. Both come from the same list of marks, with the
//! same font metrics; the font is part of the program, so that a machine without fonts draws the
//! same picture.

mod axis;
mod chart;
mod decimate;
mod drawing;
mod font;
mod layout;
mod legend;
mod look;
mod png;
mod svg;

pub use chart::{Chart, ChartAxis, Curve, Look, Panel, Scale};
pub use drawing::Drawing;
