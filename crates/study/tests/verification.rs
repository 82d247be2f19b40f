//! The verification suite of the repository passes, and a suite that is wrong says how.

// A panic is how a test fails, in its helpers too.
#![allow(clippy::unwrap_used)]

use std::path::{Path, PathBuf};

use catenix_model::FormulationKind;
use catenix_results::{Verification, VerifiedCase};
use catenix_study::{in_parallel, read_suite};

fn repository_suite() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../verification")
}

/// What did not pass, in words.
fn failures(case: &VerifiedCase) -> Vec<String> {
    let mut found: Vec<String> = case.error.iter().cloned().collect();
    found.extend(
        case.numbers
            .iter()
            .filter(|n| n.passed == Some(false))
            .map(|n| {
                format!(
                    "{}: {:?} instead of {} {} (error {:?}, allowed {})",
                    n.name, n.computed, n.reference, n.unit, n.error, n.tolerance
                )
            }),
    );
    found.extend(
        case.curves
            .iter()
            .filter(|c| c.passed == Some(false))
            .map(|c| format!("{}: error {}, allowed {}", c.name, c.error, c.tolerance)),
    );
    found.extend(case.convergences.iter().filter(|c| !c.passed).map(|c| {
        format!(
            "{}: order {}, expected {}: {:?}",
            c.name, c.order, c.least_order, c.errors
        )
    }));
    found
}

fn assert_passed(results: &[VerifiedCase]) {
    let failed: Vec<String> = results
        .iter()
        .filter(|case| !case.passed)
        .map(|case| format!("{}:\n  {}", case.label(), failures(case).join("\n  ")))
        .collect();
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}

/// Cases that a formulation cannot do at all are in `refused`, by name; it does all the others.
fn check_formulation(formulation: FormulationKind, refused: &[&str]) {
    let suite = read_suite(&repository_suite()).unwrap();
    let results = in_parallel(&suite, None, |case| case.verify(formulation, &|| false));
    assert_passed(&results);
    let found: Vec<&str> = results
        .iter()
        .filter(|case| case.is_refused())
        .map(|case| case.name.as_str())
        .collect();
    assert_eq!(found, refused);
}

#[test]
fn every_case_that_lumped_mass_can_do_passes_under_it() {
    // Sections with directions or a stress-free shape, shear, torsion, moments on lines.
    let refused = [
        "bend-45-degrees",
        "cantilever-frequencies",
        "cantilever-tip-load",
        "deep-arch",
        "exudyn-cantilever",
        "flying-spaghetti",
        "geradin-cantilever",
        "helix",
        "roll-up",
        "spin-up",
        "timoshenko-beam",
        "torsional-vibration",
    ];
    check_formulation(FormulationKind::Lumped, &refused);
}

#[test]
fn every_case_passes_under_beam_elements() {
    check_formulation(FormulationKind::Fem, &[]);
}

#[test]
fn every_case_passes_under_geometrically_exact_elements() {
    check_formulation(FormulationKind::FemExact, &[]);
}

#[test]
fn every_case_passes() {
    let suite = read_suite(&repository_suite()).unwrap();
    let results = in_parallel(&suite, None, |case| {
        case.verify(FormulationKind::Dem, &|| false)
    });
    assert_passed(&results);
    let verification = Verification::new("", results);
    assert!(
        verification.passed,
        "only {:?} of the error estimates hold",
        verification.estimates_that_hold
    );
    let results = &verification.cases;
    // Nothing passes by comparing nothing.
    for case in results {
        let compared = case.numbers.len() + case.curves.len() + case.convergences.len();
        assert!(compared > 0, "{} compares nothing", case.name);
        assert!(case.source.len() > 50, "{} names no source", case.name);
    }
}

/// A copy of a case of the repository, with one text replaced in one of its files.
fn changed(file: &str, from: &str, to: &str) -> tempfile::TempDir {
    let directory = tempfile::tempdir().unwrap();
    let case = directory.path().join("case");
    std::fs::create_dir(&case).unwrap();
    for name in ["case.toml", "model.toml", "SOURCE.md"] {
        let original = repository_suite()
            .join("pinned-beam-frequencies")
            .join(name);
        let mut text = std::fs::read_to_string(original).unwrap();
        if name == file {
            assert!(text.contains(from));
            text = text.replace(from, to);
        }
        std::fs::write(case.join(name), text).unwrap();
    }
    directory
}

#[test]
fn a_wrong_reference_fails_and_a_wrong_file_says_where() {
    let wrong = changed("case.toml", "reference = 7.070254568", "reference = 7.07");
    let case = &read_suite(wrong.path()).unwrap()[0];
    let result = case.verify(FormulationKind::Dem, &|| false);
    assert!(!result.passed && result.numbers[0].passed == Some(false));
    assert!(result.numbers[1].passed == Some(true));

    let wrong = changed("case.toml", "unit = \"Hz\"", "unit = \"rad/s\"");
    let case = &read_suite(wrong.path()).unwrap()[0];
    let result = case.verify(FormulationKind::Dem, &|| false);
    assert!(result.error.unwrap().contains("\"rad/s\""));

    let wrong = changed("case.toml", "tolerance", "tolerence");
    let error = read_suite(wrong.path()).unwrap_err().to_string();
    assert!(
        error.contains("tolerance") && error.contains("line"),
        "{error}"
    );

    let wrong = changed("model.toml", "[line_types.bar]", "[line_types.rod]");
    let error = read_suite(wrong.path()).unwrap_err().to_string();
    assert!(error.contains("bar"), "{error}");

    let empty = tempfile::tempdir().unwrap();
    assert!(read_suite(empty.path()).is_err());
}
