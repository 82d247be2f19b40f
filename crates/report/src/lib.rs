//! Figures and pages made of results, to read and to print.
//!
//! [`figure`] draws curves as SVG and PNG; [`study_chart`], [`path_chart`] and [`mode_charts`] say
//! what to draw of the results of a study. [`write_verification`] makes the page of a verification
//! suite. Pages are single HTML files that open without a network, and print on A4.

mod charts;
mod error;
pub mod figure;
mod markdown;
mod number;
mod page;
mod picture;
mod study;
mod verification;
mod words;

pub use charts::{cost_chart, mode_charts, path_chart, study_chart};
pub use error::ReportError;
pub use picture::{PNG_SCALE, write_figure};
pub use study::{Report, ReportFigure, ReportOptions, write_report};
pub use verification::write_verification;
pub use words::Language;
