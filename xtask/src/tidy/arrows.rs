//! The arrows between the crates, and the lints that every crate inherits.

use std::path::Path;

use cargo_metadata::{Metadata, MetadataCommand};

use super::{TextFile, Violation};

/// What each crate may depend on among ours: the arrows of ARCHITECTURE.md, and no others.
const ALLOWED: &[(&str, &[&str])] = &[
    ("catenix-numerics", &[]),
    ("catenix-model", &[]),
    ("catenix-engine", &["catenix-numerics", "catenix-model"]),
    ("catenix-results", &["catenix-model"]),
    ("catenix-viewer", &["catenix-results", "catenix-model"]),
    ("catenix-report", &["catenix-results", "catenix-model"]),
    ("catenix-export", &["catenix-results", "catenix-model"]),
    (
        "catenix-study",
        &["catenix-engine", "catenix-results", "catenix-model"],
    ),
    (
        "catenix",
        &[
            "catenix-study",
            "catenix-viewer",
            "catenix-engine",
            "catenix-export",
            "catenix-report",
            "catenix-results",
            "catenix-model",
        ],
    ),
    // It measures everything from below the adapters, so nothing may depend on it.
    (
        "catenix-bench",
        &[
            "catenix-numerics",
            "catenix-engine",
            "catenix-results",
            "catenix-study",
            "catenix-report",
            "catenix-model",
        ],
    ),
    ("xtask", &[]),
];

/// Checks the manifests of all workspace crates.
pub(crate) fn check(root: &Path, files: &[TextFile]) -> Result<Vec<Violation>, String> {
    let metadata = MetadataCommand::new()
        .manifest_path(root.join("Cargo.toml"))
        .no_deps()
        .exec()
        .map_err(|error| format!("`cargo metadata` failed: {error}"))?;
    let mut violations = Vec::new();
    for crate_arrows in read_arrows(root, &metadata) {
        let manifest = files.iter().find(|file| file.path == crate_arrows.manifest);
        let text = manifest.map_or("", |file| file.text.as_str());
        violations.extend(check_arrows(&crate_arrows, text));
        violations.extend(check_lints(&crate_arrows.manifest, text));
    }
    Ok(violations)
}

/// A crate and its dependencies of every kind (normal, build, dev) that are crates of ours.
struct CrateArrows {
    name: String,
    /// Path of the manifest from the workspace root.
    manifest: String,
    ours: Vec<String>,
}

fn read_arrows(root: &Path, metadata: &Metadata) -> Vec<CrateArrows> {
    let members = metadata.workspace_packages();
    let is_ours = |name: &str| members.iter().any(|member| member.name.as_str() == name);
    members
        .iter()
        .map(|member| CrateArrows {
            name: member.name.to_string(),
            manifest: member
                .manifest_path
                .strip_prefix(root.to_string_lossy().as_ref())
                .map_or_else(
                    |_| member.manifest_path.to_string(),
                    |path| path.to_string(),
                )
                .replace('\\', "/"),
            ours: member
                .dependencies
                .iter()
                .map(|dependency| dependency.name.clone())
                .filter(|name| is_ours(name))
                .collect(),
        })
        .collect()
}

fn check_arrows(found: &CrateArrows, manifest_text: &str) -> Vec<Violation> {
    let violation = |line, message| Violation {
        file: found.manifest.clone(),
        line,
        rule: "crate-arrows",
        message,
    };
    let Some((_, allowed)) = ALLOWED.iter().find(|(name, _)| *name == found.name) else {
        let message = format!(
            "crate `{}` has no place in the map: add it with its allowed arrows to ARCHITECTURE.md \
             and to xtask/src/tidy/arrows.rs.",
            found.name
        );
        return vec![violation(1, message)];
    };
    found
        .ours
        .iter()
        .filter(|to| !allowed.contains(&to.as_str()))
        .map(|to| {
            let may = match allowed {
                [] => "none of our crates".to_owned(),
                _ => allowed.join(", "),
            };
            let message = format!(
                "`{}` depends on `{to}`, but may depend on {may}. Data flows one way (model file -> \
                 model -> engine -> results -> cli); move what is needed to a lower crate, or pass \
                 it in from the caller.",
                found.name
            );
            violation(dependency_line(manifest_text, to), message)
        })
        .collect()
}

/// Line of the manifest that declares the dependency; 1 when it is spelled in an unusual way.
fn dependency_line(manifest_text: &str, name: &str) -> usize {
    let declares = |line: &str| {
        line.trim_start()
            .strip_prefix(name)
            .is_some_and(|rest| rest.starts_with(['.', ' ', '=']))
    };
    manifest_text
        .lines()
        .position(declares)
        .map_or(1, |index| index + 1)
}

fn check_lints(manifest: &str, text: &str) -> Option<Violation> {
    let inherits = toml::from_str::<toml::Table>(text)
        .ok()
        .and_then(|table| table.get("lints")?.get("workspace")?.as_bool())
        .unwrap_or(false);
    (!inherits).then(|| Violation {
        file: manifest.to_owned(),
        line: 1,
        rule: "workspace-lints",
        message: "the crate does not inherit the workspace's lints: write `[lints]` and \
                  `workspace = true`. Lints live in the root Cargo.toml once, with their reasons."
            .to_owned(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn arrows(name: &str, ours: &[&str]) -> CrateArrows {
        CrateArrows {
            name: name.to_owned(),
            manifest: "crates/x/Cargo.toml".to_owned(),
            ours: ours.iter().map(|&to| to.to_owned()).collect(),
        }
    }

    #[test]
    fn allowed_arrows_pass() {
        for (name, allowed) in ALLOWED {
            assert_eq!(check_arrows(&arrows(name, allowed), ""), []);
        }
    }

    #[test]
    fn every_other_arrow_is_a_violation() {
        for (name, allowed) in ALLOWED {
            for (to, _) in ALLOWED {
                let expected = usize::from(!allowed.contains(to));
                let found = check_arrows(&arrows(name, &[to]), "").len();
                assert_eq!(found, expected, "{name} -> {to}");
            }
        }
    }

    #[test]
    fn violation_points_at_the_line_of_the_dependency() {
        let manifest = "[package]\n\n[dev-dependencies]\ncatenix-engine.workspace = true\n";
        let found = check_arrows(&arrows("catenix-model", &["catenix-engine"]), manifest);
        assert_eq!(found[0].line, 4);
        assert!(
            found[0].message.contains("none of our crates"),
            "{}",
            found[0]
        );
    }

    #[test]
    fn a_crate_outside_the_map_is_a_violation() {
        assert_eq!(check_arrows(&arrows("catenix-mystery", &[]), "").len(), 1);
    }

    #[test]
    fn lints_must_be_inherited() {
        let manifest = "crates/x/Cargo.toml";
        assert_eq!(check_lints(manifest, "[lints]\nworkspace = true\n"), None);
        assert_eq!(check_lints(manifest, "lints.workspace = true\n"), None);
        assert!(check_lints(manifest, "[package]\nname = \"x\"\n").is_some());
        assert!(check_lints(manifest, "[lints]\nworkspace = false\n").is_some());
        assert!(check_lints(manifest, "# lints.workspace = true\n").is_some());
    }

    #[test]
    fn dev_and_build_dependencies_are_arrows_too() {
        let root = crate::workspace_root();
        let metadata = MetadataCommand::new()
            .manifest_path(root.join("Cargo.toml"))
            .no_deps()
            .exec()
            .expect("cargo metadata runs");
        let engine = read_arrows(&root, &metadata)
            .into_iter()
            .find(|found| found.name == "catenix-engine")
            .expect("the engine is a workspace crate");
        assert_eq!(engine.manifest, "crates/engine/Cargo.toml");
        assert!(engine.ours.iter().any(|to| to == "catenix-numerics"));
    }
}
