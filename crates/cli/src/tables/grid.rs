//! Rows and columns as text.

use unicode_width::UnicodeWidthStr;

use super::{WIDTH, wrapped};

/// A table whose columns are as wide as their content.
#[derive(Debug, Default)]
pub(crate) struct Grid {
    rows: Vec<Row>,
    /// Columns whose text starts at the left; the others end at the right.
    left: Vec<usize>,
}

#[derive(Debug)]
enum Row {
    /// Names of the columns, with a rule below.
    Header(Vec<String>),
    /// A line of its own above the rows that belong to it.
    Group(String),
    Cells(Vec<String>),
}

impl Grid {
    /// A table in which the given columns are aligned to the left.
    pub(crate) fn new(left: &[usize]) -> Self {
        Grid {
            rows: Vec::new(),
            left: left.to_vec(),
        }
    }

    /// Adds the names of the columns.
    pub(crate) fn header<S: Into<String>>(&mut self, cells: impl IntoIterator<Item = S>) {
        self.rows
            .push(Row::Header(cells.into_iter().map(Into::into).collect()));
    }

    /// Adds a line above rows that belong together.
    pub(crate) fn group(&mut self, name: impl Into<String>) {
        self.rows.push(Row::Group(name.into()));
    }

    /// Adds a row.
    pub(crate) fn row<S: Into<String>>(&mut self, cells: impl IntoIterator<Item = S>) {
        self.rows
            .push(Row::Cells(cells.into_iter().map(Into::into).collect()));
    }

    /// The table as text; the last column is broken into lines where the table is too wide.
    pub(crate) fn text(&self) -> String {
        let widths = self.widths();
        let mut text = String::new();
        for row in &self.rows {
            match row {
                Row::Group(name) => text.push_str(&format!("{name}\n")),
                Row::Cells(cells) => self.push_cells(&mut text, cells, &widths),
                Row::Header(cells) => {
                    self.push_cells(&mut text, cells, &widths);
                    let rule: Vec<String> = widths.iter().map(|width| "-".repeat(*width)).collect();
                    text.push_str(&format!("{}\n", rule.join("  ")));
                }
            }
        }
        text
    }

    fn widths(&self) -> Vec<usize> {
        let mut widths: Vec<usize> = Vec::new();
        for row in &self.rows {
            let (Row::Header(cells) | Row::Cells(cells)) = row else {
                continue;
            };
            for (index, cell) in cells.iter().enumerate() {
                if index == widths.len() {
                    widths.push(0);
                }
                widths[index] = widths[index].max(cell.width());
            }
        }
        let total: usize = widths
            .iter()
            .map(|width| width + 2)
            .sum::<usize>()
            .saturating_sub(2);
        let last_is_text = self.left.contains(&widths.len().saturating_sub(1));
        if let Some(last) = widths.last_mut().filter(|_| last_is_text && total > WIDTH) {
            *last = last.saturating_sub(total - WIDTH).max(20);
        }
        widths
    }

    fn push_cells(&self, text: &mut String, cells: &[String], widths: &[usize]) {
        let mut line = String::new();
        let mut rest: Vec<String> = Vec::new();
        for (index, (cell, width)) in cells.iter().zip(widths).enumerate() {
            if index > 0 {
                line.push_str("  ");
            }
            let pieces = if cell.width() <= *width {
                vec![cell.clone()]
            } else {
                wrapped(cell, *width)
            };
            let mut pieces = pieces.into_iter();
            let first = pieces.next().unwrap_or_default();
            let space = " ".repeat(width.saturating_sub(first.width()));
            if self.left.contains(&index) {
                line.push_str(&first);
                line.push_str(&space);
            } else {
                line.push_str(&space);
                line.push_str(&first);
            }
            rest.extend(pieces);
        }
        text.push_str(line.trim_end());
        text.push('\n');
        let indent: usize = widths.iter().rev().skip(1).map(|width| width + 2).sum();
        for piece in rest {
            text.push_str(&format!("{}{piece}\n", " ".repeat(indent)));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_line_up_and_long_text_wraps() {
        let mut grid = Grid::new(&[0, 2]);
        grid.header(["case", "offset", "description"]);
        grid.row(["a".to_owned(), "-22.5".to_owned(), "word ".repeat(30)]);
        grid.group("more");
        grid.row(["  b", "2", "y"]);
        grid.row(["软管", "1", "x"]);
        let text = grid.text();
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[2].find("-22.5"), Some(7));
        assert!(lines.iter().all(|line| line.width() <= WIDTH), "{text}");
        assert_eq!(lines[3].find("word"), lines[2].find("word"));
        assert!(lines[lines.len() - 2].starts_with("  b"), "{text}");
        assert_eq!(lines[lines.len() - 1].width(), 15);
    }
}
