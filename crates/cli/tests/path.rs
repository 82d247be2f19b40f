//! `catenix path`: what it prints, writes and exits with.

// A panic is how a test fails, in its helpers too.
#![allow(clippy::unwrap_used)]

mod common;

use common::{Bench, repository_file};

/// A light mast that is pressed down beyond its buckling load.
const MAST: &str = r#"
title = "Mast"
environment.gravity = 0
[line_types.mast]
kind = "general"
outer_diameter = "0.05 m"
mass = "5 kg/m"
axial_stiffness = "10 MN"
bending_stiffness = "1 kN m^2"
[anchors.foot]
position = [0, 0, 0]
[lines.mast]
sections = [{ type = "mast", length = "2 m", elements = 10 }]
end_a = { to = "foot", joint = "fixed", direction = [0, 0, 1] }
[loads.press]
on = "mast"
at = "2 m"
force = [0, 0, "-600 N"]
[loads.wind]
on = "mast"
at = "2 m"
force = ["1 N", 0, 0]
[output]
channels = ["mast.x@2 m", "mast.z@2 m"]
[path]
loads = ["press"]
range = [0, 1.5]
at = [1]
"#;

fn bench(more: &str) -> Bench {
    let bench = Bench::new("");
    std::fs::write(bench.path("mast.toml"), format!("{MAST}{more}")).unwrap();
    bench
}

#[test]
fn a_path_is_printed_written_and_drawn() {
    let bench = bench("");
    let arguments = [
        "path",
        "mast.toml",
        "--csv",
        "mast.csv",
        "--figure",
        "mast.svg",
    ];
    let (code, stdout, stderr) = bench.run(&arguments);
    assert_eq!(code, 0, "{stderr}");
    for text in [
        "Mast: equilibrium path",
        "until the factor left its range; the factor scales press",
        "mast.x@2m m",
        "1.500000",
        "Written: mast.csv",
    ] {
        assert!(stdout.contains(text), "{text} is missing in\n{stdout}");
    }
    let csv = std::fs::read_to_string(bench.path("mast.csv")).unwrap();
    let header = csv.lines().next().unwrap();
    assert!(header.starts_with("case,factor [-],distance [-],event,unstable,residual [N],"));
    assert!(header.contains("mast.z@2m [m]"), "{header}");
    assert!(
        csv.lines()
            .all(|row| row.split(',').count() == header.split(',').count())
    );
    let figure = std::fs::read_to_string(bench.path("mast.svg")).unwrap();
    assert!(figure.contains("Load factor") && figure.contains("mast, x at 2 m [m]"));
    let (code, ..) = bench.run(&[
        "path",
        "mast.toml",
        "--figure",
        "mast.png",
        "--channel",
        "mast.z@2m",
    ]);
    assert_eq!(code, 0);
    assert!(
        std::fs::read(bench.path("mast.png"))
            .unwrap()
            .starts_with(b"\x89PNG")
    );
    let (code, _, stderr) = bench.run(&[
        "path",
        "mast.toml",
        "--figure",
        "a.png",
        "--channel",
        "mast.w",
    ]);
    assert_eq!(code, 2);
    assert!(
        stderr.contains("no figure can be drawn of the channel `mast.w`"),
        "{stderr}"
    );
}

#[test]
fn a_path_is_one_json_document_with_the_documented_keys() {
    let (code, document) = bench("").json(&["path", "mast.toml"]);
    assert_eq!(code, 0);
    assert_eq!(document["command"], "path");
    let case = &document["cases"]["base"];
    assert_eq!(case["end"], "range");
    let factors = case["factor"].as_array().unwrap();
    assert!(factors.iter().any(|factor| factor == 1.0), "{factors:?}");
    let values = case["channels"]["mast.x@2m"]["values"].as_array().unwrap();
    assert_eq!(values.len(), factors.len());
    let guide = repository_file("docs/cli.md");
    for key in case.as_object().unwrap().keys() {
        assert!(
            guide.contains(&format!("`{key}`")),
            "`{key}` is not in docs/cli.md"
        );
    }
}

#[test]
fn a_lost_path_keeps_its_points_and_fails() {
    // Steps that are far too long, and may not be cut enough.
    let more = "\n[cases.lost]\npath.first_step = 1e9\npath.max_step = 1e9\n";
    let bench = bench(more);
    let (code, document) = bench.json(&["path", "mast.toml"]);
    assert_eq!(code, 1);
    let case = &document["cases"]["lost"];
    assert_eq!(case["status"], "failed");
    assert_eq!(case["error"]["code"], "path::lost");
    assert_eq!(case["factor"].as_array().unwrap().len(), 1);
    let (code, stdout, _) = bench.run(&["path", "mast.toml"]);
    assert_eq!(code, 1);
    assert!(
        stdout.contains("Case lost failed: the path is lost"),
        "{stdout}"
    );
}

#[test]
fn a_model_without_a_path_says_what_to_add() {
    let bench = Bench::new("");
    let (code, stdout, _) = bench.run(&["path", "model.toml"]);
    assert_eq!(code, 1);
    assert!(stdout.contains("add a [path] table"), "{stdout}");
}
