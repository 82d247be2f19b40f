//! Tables for the terminal, at most 100 columns wide where the names allow it.

mod check;
mod comparison;
mod discretisation;
mod export;
mod grid;
mod modes;
mod number;
mod path;
mod references;
mod statics;
mod summary;
mod verification;

pub(crate) use check::check_text;
pub(crate) use comparison::comparison_text;
pub(crate) use export::export_text;
pub(crate) use modes::modes_text;
pub(crate) use path::path_text;
pub(crate) use statics::statics_text;
pub(crate) use summary::{errors_text, files_text, summary_text};

pub(crate) use verification::{suite_text, verification_text};

use unicode_width::UnicodeWidthStr;

/// Most columns of a terminal that a table fills.
const WIDTH: usize = 100;

/// Load cases beside each other in one table; more go into further tables.
const CASES_PER_TABLE: usize = 6;

/// A title, underlined.
fn heading(text: &str) -> String {
    format!("\n{text}\n{}\n", "=".repeat(text.width()))
}

/// A remark under a table, wrapped.
fn remark(text: &str) -> String {
    if text.trim().is_empty() {
        return String::new();
    }
    format!("Note: {}\n", wrapped(text, WIDTH - 6).join("\n      "))
}

/// A paragraph, wrapped, with an empty line below.
fn paragraph(text: &str) -> String {
    format!("{}\n\n", wrapped(text, WIDTH).join("\n"))
}

/// Lines no wider than `width`, broken between words; a longer word stays whole.
fn wrapped(text: &str, width: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.width() + 1 + word.width() <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}
