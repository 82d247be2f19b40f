//! Tables that programs write into documents, between two markers.

use std::fs;
use std::path::{Path, PathBuf};

use cargo_metadata::MetadataCommand;

use crate::steps::{cargo, run_command};

/// Puts `text` between the markers of a document, in place of what stands there.
pub(crate) fn write_between(
    root: &Path,
    document: &str,
    markers: [&str; 2],
    text: &str,
) -> Result<(), String> {
    let path = root.join(document);
    let old = fs::read_to_string(&path).map_err(|error| format!("{document}: {error}"))?;
    let new = between(&old, markers, text).ok_or_else(|| {
        format!(
            "{document} needs the lines {} and {}",
            markers[0], markers[1]
        )
    })?;
    fs::write(&path, new).map_err(|error| format!("{document}: {error}"))
}

fn between(old: &str, [begin, end]: [&str; 2], text: &str) -> Option<String> {
    let (before, rest) = old.split_once(begin)?;
    let (_, after) = rest.split_once(end)?;
    Some(format!("{before}{begin}\n{text}{end}{after}"))
}

/// Builds the `catenix` command, optimised; returns the program and the target folder.
pub(crate) fn build_catenix(root: &Path) -> Result<(PathBuf, PathBuf), String> {
    run_command(&mut cargo(
        root,
        &["build", "--release", "--bin", "catenix"],
    ))?;
    let target = MetadataCommand::new()
        .manifest_path(root.join("Cargo.toml"))
        .no_deps()
        .exec()
        .map_err(|error| format!("`cargo metadata` failed: {error}"))?
        .target_directory
        .into_std_path_buf();
    let program = format!("catenix{}", std::env::consts::EXE_SUFFIX);
    Ok((target.join("release").join(program), target))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_takes_the_place_of_the_old_one() {
        let text = "one\n<begin>\nold\n<end>\ntwo\n";
        let found = between(text, ["<begin>", "<end>"], "| new |\n");
        let wanted = "one\n<begin>\n| new |\n<end>\ntwo\n";
        assert_eq!(found.as_deref(), Some(wanted));
        assert!(between("no markers", ["<begin>", "<end>"], "").is_none());
    }
}
