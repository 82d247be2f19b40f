//! ARCHITECTURE.md names every crate and every top-level module folder.
//!
//! That it names none that does not exist is the `named-paths` rule, which holds for all documents.

use std::collections::BTreeSet;

use super::{TextFile, Violation};

const DOCUMENT: &str = "ARCHITECTURE.md";

/// Checks ARCHITECTURE.md against the folders that hold sources.
pub(crate) fn check(files: &[TextFile]) -> Vec<Violation> {
    let violation = |message| Violation {
        file: DOCUMENT.to_owned(),
        line: 1,
        rule: "architecture-map",
        message,
    };
    let Some(document) = files.iter().find(|file| file.path == DOCUMENT) else {
        return vec![violation(
            "does not exist; it holds the map and the invariants.".to_owned(),
        )];
    };
    places(files)
        .into_iter()
        .filter(|place| !names(&document.text, place))
        .map(|place| {
            violation(format!(
                "does not name `{place}`; say in a sentence what it does and what it must not do."
            ))
        })
        .collect()
}

/// Crates (`crates/engine`, `xtask`) and their top-level module folders (`crates/engine/src/hydro`).
fn places(files: &[TextFile]) -> BTreeSet<&str> {
    let mut places = BTreeSet::new();
    for manifest in files
        .iter()
        .filter(|file| file.path.ends_with("/Cargo.toml"))
    {
        let crate_folder = manifest.folder();
        places.insert(crate_folder);
        for source in files.iter().filter(|file| file.has_ending("rs")) {
            let inside = source
                .path
                .strip_prefix(crate_folder)
                .and_then(|rest| rest.strip_prefix("/src/"))
                .and_then(|rest| rest.split_once('/'));
            if let Some((folder, _)) = inside {
                places.insert(&source.path[..crate_folder.len() + "/src/".len() + folder.len()]);
            }
        }
    }
    places
}

/// Whether the text holds the path itself, not only a longer one.
fn names(text: &str, place: &str) -> bool {
    text.match_indices(place).any(|(start, _)| {
        let before = text[..start].chars().next_back();
        let mut after = text[start + place.len()..].chars();
        let ends = match after.next() {
            Some('/') => !after.next().is_some_and(char::is_alphanumeric),
            Some(c) => !(c.is_alphanumeric() || "_-".contains(c)),
            None => true,
        };
        ends && !before.is_some_and(|c| c.is_alphanumeric() || "/_-".contains(c))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn missing(architecture: &str) -> Vec<String> {
        let file = |path: &str, text: &str| TextFile {
            path: path.to_owned(),
            text: text.to_owned(),
        };
        let files = [
            file("ARCHITECTURE.md", architecture),
            file("Cargo.toml", ""),
            file("crates/engine/Cargo.toml", ""),
            file("crates/engine/src/lib.rs", ""),
            file("crates/engine/src/hydro/morison.rs", ""),
            file("crates/engine/src/body/lump.rs", ""),
            file("crates/engine/tests/statics/main.rs", ""),
        ];
        let found = check(&files);
        found
            .into_iter()
            .map(|violation| violation.message)
            .collect()
    }

    #[test]
    fn a_complete_map_passes() {
        let map = "`crates/engine`: `crates/engine/src/hydro`, `crates/engine/src/body/`.";
        assert_eq!(missing(map), [""; 0]);
    }

    #[test]
    fn a_missing_crate_or_folder_is_named() {
        let found = missing("`crates/engine` with `crates/engine/src/hydro`");
        assert_eq!(found.len(), 1);
        assert!(found[0].contains("crates/engine/src/body"), "{found:?}");
        assert_eq!(missing("").len(), 3);
    }

    #[test]
    fn a_longer_path_does_not_name_the_shorter() {
        assert_eq!(
            missing("`crates/engine/src/hydro/morison.rs` in crates/engine-two").len(),
            3
        );
    }
}
