//! Figures for reports: curves against time, as SVG and PNG.
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
mod legend;
mod png;
mod svg;

pub(crate) use chart::channel_label;
pub use chart::{Chart, Curve, study_chart};
pub use drawing::Drawing;
