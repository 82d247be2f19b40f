//! Figures made of results, to read and to print.
//!
//! [`figure`] draws curves as SVG and PNG; [`study_chart`], [`path_chart`] and [`mode_charts`] say
//! what to draw of the results of a study.

mod charts;
mod error;
pub mod figure;
mod number;
mod picture;

pub use charts::{mode_charts, path_chart, study_chart};
pub use error::ReportError;
pub use picture::{PNG_SCALE, write_figure};
