//! No text makes the reader panic, and what it accepts is consistent.

use std::path::Path;

use catenix_model::file::parse_study;
use catenix_model::{LineEnd, SupportRef, all_channels};
use proptest::prelude::*;

const SEA_TRIAL: &str = include_str!("../../../examples/sea-trial-1km.toml");
const BUFFER: &str = include_str!("../../../examples/two-hose-buffer.toml");
const MOORING: &str = include_str!("../../../examples/mooring-line.toml");

/// Fragments that mean something to the reader.
const FRAGMENTS: &[&str] = &[
    "nan",
    "inf",
    "-1",
    "0",
    "1e308",
    "1e-308",
    "\"-1 m\"",
    "\"1 kg\"",
    "true",
    "[]",
    "{}",
    "\"\"",
    "[[1]]",
    "1979-05-27",
    "\n[cases.x]\n",
    "\n[lines.new]\n",
    "\"free\"",
    "\"buffer\"",
    "=",
    "\"",
    "[",
    "]",
    "{",
    "}",
    "#",
    "\n",
    "\u{0}",
    "\u{feff}",
    "µm²",
    "elements = 1000000",
    "1e6",
    "element_length_a = 1e-9",
    "99999999999999999999",
];

fn read(text: &str) {
    let Ok(study) = parse_study(text, "fuzz.toml", Path::new("/nonexistent")) else {
        return;
    };
    assert!(!study.cases.is_empty());
    for case in &study.cases {
        let model = &case.model;
        for line in &model.lines {
            let length = line.length();
            assert!(length.is_finite() && length > 0.0);
            for section in &line.sections {
                assert!(section.line_type < model.line_types.len());
                assert!(section.element_lengths.iter().all(|&length| length > 0.0));
            }
            for end in &line.ends {
                let LineEnd::Connected(connection) = end else {
                    continue;
                };
                match connection.to {
                    SupportRef::Vessel(index) => assert!(index < model.vessels.len()),
                    SupportRef::Body(index) => assert!(index < model.bodies.len()),
                }
            }
        }
        for line_type in &model.line_types {
            let derived = [
                line_type.mass,
                line_type.axial_stiffness,
                line_type.polar_inertia,
            ];
            assert!(
                derived
                    .iter()
                    .all(|value| value.is_finite() && *value > 0.0)
            );
            assert!(line_type.bending_stiffness.iter().all(|k| k.is_finite()));
        }
        for body in &model.bodies {
            assert!(
                body.inertia
                    .iter()
                    .all(|value| value.is_finite() && *value > 0.0)
            );
            assert!(body.volume.is_finite());
        }
        assert!(!all_channels(model).is_empty());
    }
}

/// Text of the examples, cut and glued at random.
fn mutated() -> impl Strategy<Value = String> {
    let base = prop::sample::select(vec![SEA_TRIAL, BUFFER, MOORING]);
    let edit = (
        any::<prop::sample::Index>(),
        0..30usize,
        prop::sample::select(FRAGMENTS),
    );
    (base, prop::collection::vec(edit, 1..4)).prop_map(|(base, edits)| {
        let mut characters: Vec<char> = base.chars().collect();
        for (at, removed, fragment) in edits {
            let at = at.index(characters.len());
            let end = (at + removed).min(characters.len());
            characters.splice(at..end, fragment.chars());
        }
        characters.into_iter().collect()
    })
}

/// Text of the examples with whole values replaced: most of it still parses as TOML.
fn revalued() -> impl Strategy<Value = String> {
    let base = prop::sample::select(vec![SEA_TRIAL, BUFFER, MOORING]);
    let edit = (
        any::<prop::sample::Index>(),
        prop::sample::select(FRAGMENTS),
    );
    (base, prop::collection::vec(edit, 1..6)).prop_map(|(base, edits)| {
        let mut lines: Vec<String> = base.lines().map(str::to_owned).collect();
        for (at, fragment) in edits {
            let at = at.index(lines.len());
            if let Some((key, _)) = lines[at].split_once(" = ") {
                lines[at] = format!("{key} = {fragment}");
            }
        }
        lines.join("\n")
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn mutated_text_never_panics(text in mutated()) {
        read(&text);
    }

    #[test]
    fn replaced_values_never_panic(text in revalued()) {
        read(&text);
    }

    #[test]
    fn any_text_never_panics(text in any::<String>()) {
        read(&text);
    }
}

/// Found by the properties above: a length that cannot be read, in a graded section.
#[test]
fn graded_section_of_unknown_length() {
    for value in ["nan", "-1", "\"1 kg\"", "1e308"] {
        read(&MOORING.replacen("length = \"470 m\"", &format!("length = {value}"), 1));
        read(&MOORING.replacen(
            "element_length = \"10 m\"",
            &format!("element_length = {value}"),
            1,
        ));
        read(&MOORING.replacen("\"2 m\"", value, 1));
    }
}

#[test]
fn deep_and_wide_text_is_survived() {
    for deep in [
        "a.".repeat(100_000) + "a = 1",
        "a = ".to_owned() + &"[".repeat(100_000),
    ] {
        assert!(parse_study(&deep, "deep.toml", Path::new("")).is_err());
    }
    let wide: String = (0..100_000)
        .map(|index| format!("k{index} = 1\n"))
        .collect();
    assert!(parse_study(&wide, "wide.toml", Path::new("")).is_err());
    let long_key = "k".repeat(10_000_000) + " = 1\n";
    assert!(parse_study(&long_key, "long.toml", Path::new("")).is_err());
}
