//! Figures as files.

use std::path::{Path, PathBuf};

use crate::ReportError;
use crate::figure::Drawing;

/// Pixels per unit of a figure: 1800 across, 300 dots per inch at the width of a page.
pub const PNG_SCALE: f64 = 2.0;

/// Writes a drawing as `figures/NAME.svg` and `.png` into a directory; returns both files.
///
/// Characters of the name that file systems or links trip over become `_`.
pub fn write_figure(
    drawing: &Drawing,
    name: &str,
    directory: &Path,
) -> Result<Vec<PathBuf>, ReportError> {
    let stem = directory.join("figures").join(file_stem(name));
    let svg = stem.with_extension("svg");
    let png = stem.with_extension("png");
    write(&svg, drawing.to_svg().as_bytes())?;
    write(&png, &drawing.to_png(PNG_SCALE)?)?;
    Ok(vec![svg, png])
}

/// A name that is safe as part of a path and of a link.
pub(crate) fn file_stem(name: &str) -> String {
    let keep = |c: char| c.is_alphanumeric() || matches!(c, '-' | '_');
    name.chars()
        .map(|c| if keep(c) { c } else { '_' })
        .collect()
}

/// Writes a file, and the folder that it is in.
pub(crate) fn write(path: &Path, content: &[u8]) -> Result<(), ReportError> {
    let folder = path.parent().unwrap_or(path);
    std::fs::create_dir_all(folder)
        .and_then(|()| std::fs::write(path, content))
        .map_err(|source| ReportError::Write {
            path: path.to_owned(),
            source,
        })
}
