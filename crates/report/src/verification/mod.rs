//! The report of a verification suite.

mod charts;
mod view;

use std::path::{Path, PathBuf};

use catenix_results::Verification;

use crate::ReportError;
use crate::page::render;
use crate::picture::{write, write_figure};

/// Writes index.html and its figures into `directory`; returns the files.
pub fn write_verification(
    report: &Verification,
    directory: &Path,
) -> Result<Vec<PathBuf>, ReportError> {
    let (page, figures) = view::page(report);
    let index = directory.join("index.html");
    write(&index, render("verification.html", &page)?.as_bytes())?;
    let mut files = vec![index];
    for (stem, drawing) in figures {
        files.extend(write_figure(&drawing, &stem, directory)?);
    }
    Ok(files)
}
