//! The table of `catenix export`: what was written.

use catenix_export::Exported;

use super::grid::Grid;

/// Files with their sizes, then what the user should know.
pub(crate) fn export_text(exported: &Exported) -> String {
    let mut grid = Grid::new(&[0]);
    grid.header(["written", "rows", "columns", "files", "size"]);
    for file in &exported.files {
        let count = |number: usize| match number {
            0 => String::new(),
            n => n.to_string(),
        };
        grid.row([
            file.path.display().to_string(),
            count(file.rows),
            count(file.columns),
            file.files.to_string(),
            size(file.bytes),
        ]);
    }
    let mut text = grid.text();
    for note in &exported.notes {
        text.push_str(&format!("Note: {note}\n"));
    }
    text
}

/// A size in the largest unit that leaves a number above 1.
fn size(bytes: u64) -> String {
    const UNITS: [&str; 4] = ["kB", "MB", "GB", "TB"];
    if bytes < 1000 {
        return format!("{bytes} B");
    }
    let mut value = bytes as f64;
    let mut unit = "";
    for larger in UNITS {
        if value < 999.95 {
            break;
        }
        value /= 1000.0;
        unit = larger;
    }
    format!("{value:.1} {unit}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_have_three_digits_or_so() {
        assert_eq!(size(0), "0 B");
        assert_eq!(size(999), "999 B");
        assert_eq!(size(1000), "1.0 kB");
        assert_eq!(size(999_960), "1.0 MB");
        assert_eq!(size(4_400_000_000), "4.4 GB");
    }
}
