//! Errors of TOML itself.

use super::diagnostic::DiagnosticCode as Code;
use super::log::Finding;

/// The parser's errors with our remedies.
pub(super) fn findings(text: &str, errors: &[toml::de::Error]) -> Vec<Finding> {
    let mut findings: Vec<Finding> = Vec::new();
    let mut repeated_table: Option<usize> = None;
    for error in errors {
        let span = error.span().unwrap_or(0..0);
        if error.message().contains("duplicate key") {
            // Inside a table that is there twice, the parser blames each key again.
            if repeated_table.is_some_and(|header| !has_header(text, header, span.start)) {
                continue;
            }
            repeated_table = is_header(text, span.start).then_some(span.end);
        }
        findings.push(finding(text, error.message(), span));
    }
    findings
}

fn finding(text: &str, message: &str, span: std::ops::Range<usize>) -> Finding {
    let written = text.get(span.clone()).unwrap_or("").trim();
    let (message, help) = if message.contains("duplicate key") {
        let help = "a key or table is written once; remove or rename one of them, or merge them";
        (format!("`{written}` is there twice"), Some(help.to_owned()))
    } else if message.contains("must be quoted") {
        let help = "texts, and numbers with a unit, stand in quotes: \"0.219 m\"";
        (message.to_owned(), Some(help.to_owned()))
    } else {
        (message.to_owned(), None)
    };
    Finding {
        span,
        code: Code::Syntax,
        message,
        help,
    }
}

/// Whether the line of a byte is a table's header.
fn is_header(text: &str, at: usize) -> bool {
    let before = text.get(..at).unwrap_or("");
    let line = before
        .rfind('\n')
        .map_or(before, |line_break| &before[line_break + 1..]);
    line.trim_start().starts_with('[')
}

/// Whether another table's header starts between two bytes.
fn has_header(text: &str, from: usize, to: usize) -> bool {
    let between = text.get(from..to).unwrap_or("");
    between
        .lines()
        .skip(1)
        .any(|line| line.trim_start().starts_with('['))
}
