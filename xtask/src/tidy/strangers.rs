//! Rules on which parts of the engine must not know each other: force kernels and the water, and
//! one formulation and another.

use super::tokens::{self, Token};
use super::{TextFile, Violation};

/// Where the formulations of lines are, one folder each; their force kernels in `element` below.
const FORMULATIONS: &str = "crates/engine/src/formulation/";

/// Checks all sources of the engine.
pub(crate) fn check(files: &[TextFile]) -> Vec<Violation> {
    let formulations = formulation_names(files);
    let sources = files.iter().filter(|file| file.has_ending("rs"));
    sources
        .filter_map(|file| Some((file, tokens::tokenize(&file.text).ok()?)))
        .flat_map(|(file, tokens)| check_strangers(&file.path, &tokens, &formulations))
        .collect()
}

/// Names of the folders of the formulations.
fn formulation_names(files: &[TextFile]) -> Vec<&str> {
    let below = |file: &'_ TextFile| file.path.starts_with(FORMULATIONS);
    let inside = files.iter().filter(|file| below(file));
    let mut names: Vec<&str> = inside
        .filter_map(|file| file.path[FORMULATIONS.len()..].split_once('/'))
        .map(|(name, _)| name)
        .collect();
    names.sort_unstable();
    names.dedup();
    names
}

/// What a file of the engine must not name, in tests either, so that formulations agree for no
/// other reason than physics: force kernels and the water do not know each other, and no
/// formulation knows another.
fn check_strangers(path: &str, tokens: &[Token], formulations: &[&str]) -> Vec<Violation> {
    let Some(inside) = path.strip_prefix("crates/engine/src/") else {
        return Vec::new();
    };
    let own = path
        .strip_prefix(FORMULATIONS)
        .and_then(|below| below.split_once('/'));
    let is_kernel = own
        .is_some_and(|(_, below)| below.starts_with("element/") || below.starts_with("element."));
    let is_water = inside.starts_with("hydro/") || inside.starts_with("hydro.");
    let names = |segments: &[String], before: &[&str], name: &str| {
        let is_before = |segment: &String| before.contains(&segment.as_str());
        let mut pairs = segments.windows(2);
        pairs.any(|pair| is_before(&pair[0]) && pair[1] == name)
    };
    let top = ["crate", "super", "catenix_engine"];
    let below = ["formulation", "super"];
    let broken = |segments: &[String]| {
        if is_water && names(segments, &top, "formulation") {
            Some((
                "element-hydro-strangers",
                "the water does not know who it loads, so that it is the same for every \
                 formulation; join them in the formulation's folder or in `system`",
            ))
        } else if is_kernel && names(segments, &top, "hydro") {
            Some((
                "element-hydro-strangers",
                "force kernels do not know the water, so that it is the same for every \
                 formulation; join them in the formulation's folder or in `system`",
            ))
        } else {
            let (own, _) = own?;
            let mut others = formulations.iter().filter(|&&name| name != own);
            let other = others.any(|name| names(segments, &below, name));
            other.then_some((
                "formulations-are-strangers",
                "formulations share no code but what stands beside their folders, otherwise their \
                 agreement would prove nothing; move what both need there",
            ))
        }
    };
    tokens::paths(tokens)
        .into_iter()
        .filter_map(|found| {
            let (rule, why) = broken(&found.segments)?;
            Some(Violation {
                file: path.to_owned(),
                line: found.line,
                rule,
                message: format!("`{}`: {why}.", found.segments.join("::")),
            })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(path: &str, text: &str) -> TextFile {
        TextFile {
            path: path.to_owned(),
            text: text.to_owned(),
        }
    }

    /// Names of the rules that a snippet at `path` breaks, beside other files.
    fn broken(path: &str, text: &str, others: &[TextFile]) -> Vec<&'static str> {
        let mut files = vec![file(path, text)];
        files.extend_from_slice(others);
        check(&files).iter().map(|found| found.rule).collect()
    }

    #[test]
    fn kernels_and_water_are_strangers() {
        let water = "crates/engine/src/hydro/morison.rs";
        let kernel = "crates/engine/src/formulation/dem/element/connector.rs";
        let glue = "crates/engine/src/formulation/dem/evaluation.rs";
        let system = "crates/engine/src/system/assembly.rs";
        for (path, snippet, expected) in [
            (water, "use crate::formulation::dem::element::Connector;", 1),
            (water, "use crate::{body, formulation::fem};", 1),
            (water, "fn f() { super::super::formulation::g() }", 1),
            ("crates/engine/src/hydro.rs", "use crate::formulation;", 1),
            (kernel, "use crate::hydro::morison;", 1),
            (
                kernel,
                "fn f() { super::super::super::super::hydro::g() }",
                1,
            ),
            (kernel, "use catenix_numerics::so3;", 0),
            (kernel, "fn f(hydro: f64) -> f64 { hydro }", 0),
            (glue, "use crate::hydro::morison;", 0),
            (water, "//! Joined with crate::formulation by system.", 0),
            (system, "use crate::{formulation, hydro};", 0),
        ] {
            let expected = vec!["element-hydro-strangers"; expected];
            assert_eq!(broken(path, snippet, &[]), expected, "{path}: {snippet}");
        }
    }

    #[test]
    fn formulations_are_strangers() {
        let kernel = "crates/engine/src/formulation/dem/element/connector.rs";
        let glue = "crates/engine/src/formulation/dem/evaluation.rs";
        let registry = "crates/engine/src/formulation/mod.rs";
        let system = "crates/engine/src/system/assembly.rs";
        let other = file("crates/engine/src/formulation/fem/mod.rs", "");
        for (path, snippet, expected) in [
            (kernel, "use crate::formulation::fem::element::exact;", 1),
            (glue, "use super::super::{Situation, fem};", 1),
            (glue, "use crate::{system, formulation::{fem, curve}};", 1),
            (glue, "use super::super::fem::element::joint;", 1),
            (glue, "use super::element::joint;", 0),
            (kernel, "use crate::formulation::curve::Curve;", 0),
            (registry, "const ALL: [Family; 1] = [fem::FAMILY];", 0),
            (system, "use crate::formulation::fem;", 0),
        ] {
            let expected = vec!["formulations-are-strangers"; expected];
            assert_eq!(
                broken(path, snippet, std::slice::from_ref(&other)),
                expected,
                "{path}: {snippet}"
            );
        }
    }
}
