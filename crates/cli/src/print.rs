//! The only place that writes to the terminal.

use std::io::Write;

use serde::Serialize;

/// Prints text to standard output. A reader that has gone away, such as `head`, is no error.
pub(crate) fn text(text: &str) {
    let mut out = std::io::stdout().lock();
    let _ = out.write_all(text.as_bytes()).and_then(|()| out.flush());
}

/// Prints a JSON document to standard output.
pub(crate) fn json(document: &impl Serialize) {
    // What the documents are made of always becomes JSON.
    text(&(serde_json::to_string_pretty(document).unwrap_or_default() + "\n"));
}

/// Prints a message to standard error.
pub(crate) fn error(message: &str) {
    let mut err = std::io::stderr().lock();
    let _ = writeln!(err, "{}", message.trim_end());
}
