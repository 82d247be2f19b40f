//! Building the binary needs nothing but cargo and a C compiler: no cmake, libclang or node.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use cargo_metadata::{DependencyKind, MetadataCommand, PackageId};

use super::Violation;

/// Packages that call a tool which a user may not have, and that tool.
const NEED_TOOLS: [(&str, &str); 6] = [
    ("cmake", "cmake"),
    ("bindgen", "libclang"),
    ("clang-sys", "libclang"),
    ("openssl-sys", "an OpenSSL installation"),
    ("pyo3-ffi", "Python"),
    ("aws-lc-sys", "cmake"),
];

/// Checks everything that `cargo build` compiles for the `catenix` binary, on any platform.
pub(crate) fn check(root: &Path) -> Result<Vec<Violation>, String> {
    let metadata = MetadataCommand::new()
        .manifest_path(root.join("Cargo.toml"))
        .exec()
        .map_err(|error| format!("`cargo metadata` failed: {error}"))?;
    let resolve = metadata
        .resolve
        .as_ref()
        .ok_or("`cargo metadata` gave no dependency graph")?;
    let name = |id: &PackageId| metadata[id].name.to_string();
    let mut graph: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for node in &resolve.nodes {
        let built = node.deps.iter().filter(|dependency| {
            dependency
                .dep_kinds
                .iter()
                .any(|kind| kind.kind != DependencyKind::Development)
        });
        graph
            .entry(name(&node.id))
            .or_default()
            .extend(built.map(|to| name(&to.pkg)));
    }
    Ok(check_graph(&graph))
}

fn check_graph(graph: &BTreeMap<String, BTreeSet<String>>) -> Vec<Violation> {
    NEED_TOOLS
        .iter()
        .filter_map(|(package, tool)| Some((path_to(graph, "catenix", package)?, tool)))
        .map(|(path, tool)| Violation {
            file: "Cargo.lock".to_owned(),
            line: 1,
            rule: "cargo-alone-builds",
            message: format!(
                "{} needs {tool} on the user's machine; cargo alone must build everything. Choose \
                 other features or another package.",
                path.join(" -> ")
            ),
        })
        .collect()
}

/// The packages on a way from one package to another.
fn path_to(
    graph: &BTreeMap<String, BTreeSet<String>>,
    from: &str,
    to: &str,
) -> Option<Vec<String>> {
    let mut ways = vec![vec![from.to_owned()]];
    let mut seen = BTreeSet::from([from.to_owned()]);
    while let Some(way) = ways.pop() {
        let last = way.last()?;
        if last == to {
            return Some(way);
        }
        for next in graph.get(last).into_iter().flatten() {
            if seen.insert(next.clone()) {
                ways.push([way.as_slice(), std::slice::from_ref(next)].concat());
            }
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn graph(arrows: &[(&str, &str)]) -> BTreeMap<String, BTreeSet<String>> {
        let mut graph: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
        for (from, to) in arrows {
            graph
                .entry((*from).to_owned())
                .or_default()
                .insert((*to).to_owned());
        }
        graph
    }

    #[test]
    fn a_tool_below_the_binary_is_found_with_the_way_to_it() {
        let found = check_graph(&graph(&[("catenix", "a"), ("a", "b"), ("b", "cmake")]));
        assert_eq!(found.len(), 1);
        assert!(
            found[0]
                .message
                .starts_with("catenix -> a -> b -> cmake needs cmake")
        );
    }

    #[test]
    fn a_tool_beside_the_binary_is_not() {
        assert_eq!(
            check_graph(&graph(&[("catenix", "a"), ("xtask", "cmake")])),
            []
        );
    }
}
