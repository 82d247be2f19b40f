//! Tables for the terminal, at most 100 columns wide where the names allow it.

mod check;
mod grid;
mod number;
mod statics;
mod summary;

pub(crate) use check::check_text;
pub(crate) use statics::statics_text;
pub(crate) use summary::{files_text, summary_text};

/// Most columns of a terminal that a table fills.
const WIDTH: usize = 100;

/// Load cases beside each other in one table; more go into further tables.
const CASES_PER_TABLE: usize = 6;

/// A title, underlined.
fn heading(text: &str) -> String {
    format!(
        "\n{text}\n{}\n",
        "=".repeat(unicode_width::UnicodeWidthStr::width(text))
    )
}

/// A remark under a table, wrapped.
fn remark(text: &str) -> String {
    let mut lines = String::new();
    let mut width = 0;
    for word in text.split_whitespace() {
        let word_width = unicode_width::UnicodeWidthStr::width(word);
        if width > 0 && width + 1 + word_width > WIDTH - 6 {
            lines.push_str("\n      ");
            width = 0;
        } else if width > 0 {
            lines.push(' ');
            width += 1;
        }
        lines.push_str(word);
        width += word_width;
    }
    if lines.is_empty() {
        lines
    } else {
        format!("Note: {lines}\n")
    }
}
