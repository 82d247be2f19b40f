//! Builds the documentation and refuses every warning but one kind.
//!
//! Documentation comments carry units in brackets: `Simulated time [s]`. Rustdoc takes `[s]` for a
//! link to an item `s` that does not exist. Here such links are told from true broken links by
//! the list of units, so that comments stay readable and links stay checked.

use std::io::BufReader;
use std::path::Path;
use std::process::Stdio;

use cargo_metadata::Message;

use crate::steps::cargo;

/// Units that stand alone in brackets; longer ones (`[N m]`, `[m/s]`) are no links to rustdoc.
const UNITS: [&str; 17] = [
    "s", "ns", "m", "N", "kg", "rad", "deg", "Pa", "Hz", "W", "J", "K", "m2", "m3", "m4", "kN",
    "bytes",
];

/// Runs `cargo doc` on the workspace; any warning that is not a unit in brackets is an error.
pub(crate) fn build(root: &Path) -> Result<(), String> {
    let arguments = [
        "doc",
        "--workspace",
        "--no-deps",
        "--message-format",
        "json",
    ];
    let flags = "-D warnings --force-warn rustdoc::broken_intra_doc_links";
    let failed = |error: std::io::Error| format!("`cargo doc` could not be followed: {error}");
    let mut child = cargo(root, &arguments)
        .env("RUSTDOCFLAGS", flags)
        .stdout(Stdio::piped())
        .spawn()
        .map_err(failed)?;
    let mut count = 0;
    if let Some(output) = child.stdout.take() {
        for message in Message::parse_stream(BufReader::new(output)) {
            if let Message::CompilerMessage(found) = message.map_err(failed)?
                && !is_unit(&found.message.message)
                && !is_count(&found.message.message)
            {
                count += 1;
                println!("{}", found.message);
            }
        }
    }
    let status = child.wait().map_err(failed)?;
    match count {
        0 if status.success() => Ok(()),
        0 => Err(format!("`cargo doc` ended with {status}")),
        _ => Err(format!("`cargo doc` has {count} complaints")),
    }
}

/// Whether a complaint is about a unit in brackets.
fn is_unit(message: &str) -> bool {
    message
        .strip_prefix("unresolved link to `")
        .and_then(|rest| rest.strip_suffix('`'))
        .is_some_and(|link| UNITS.contains(&link))
}

/// "12 warnings emitted", which follows the complaints of a crate.
fn is_count(message: &str) -> bool {
    message.ends_with(" warning emitted") || message.ends_with(" warnings emitted")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_told_from_broken_links() {
        assert!(is_unit("unresolved link to `s`"));
        assert!(!is_unit("unresolved link to `NoSuchType`"));
        assert!(!is_unit("missing documentation for a function"));
        assert!(is_count("1 warning emitted") && is_count("12 warnings emitted"));
    }
}
