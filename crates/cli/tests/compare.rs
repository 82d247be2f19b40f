//! `catenix compare`: formulations side by side.

// A panic is how a test fails, in its helpers too.
#![allow(clippy::unwrap_used)]

mod common;

use common::Bench;
use serde_json::Value;

#[test]
fn formulations_are_compared_at_equal_mesh_and_at_equal_error() {
    let bench = Bench::new("");
    let arguments = [
        "compare",
        "model.toml",
        "--formulations",
        "dem,fem,fem-exact,lumped",
        "--meshes",
        "0.5,1,2",
        "--target",
        "5%",
        "--out",
        "compared",
        "--json",
    ];
    let (code, stdout, stderr) = bench.run(&arguments);
    assert_eq!(code, 0, "{stderr}");
    let document: Value = serde_json::from_str(&stdout).unwrap();
    let case = &document["cases"][0];
    assert_eq!(case["reference"]["run"]["elements"], 40);
    let formulations = case["formulations"].as_array().unwrap();
    assert_eq!(formulations.len(), 4);
    for (index, formulation) in formulations.iter().enumerate() {
        assert_eq!(formulation["problem"], Value::Null, "{formulation}");
        let runs = formulation["runs"].as_array().unwrap();
        assert_eq!(runs.len(), 3);
        let met = formulation["at_target"].as_u64().unwrap() as usize;
        assert!(runs[met]["error"].as_f64().unwrap() <= 0.05);
        for run in runs {
            assert!(run["cpu_seconds"].as_f64().unwrap() > 0.0);
            assert!(run["peak_memory_bytes"].as_u64().unwrap() > 10_000);
            assert!(run["iterations"].as_u64() > run["steps"].as_u64());
        }
        // The largest difference at equal mesh is the error of that run.
        let equal = formulation["equal_mesh"].as_u64().unwrap() as usize;
        let results = case["results"].as_array().unwrap().iter();
        let largest = results
            .filter(|result| result["counts"] == true)
            .filter_map(|result| result["differences_percent"][index].as_f64())
            .fold(0.0, |largest: f64, d| largest.max(d.abs()));
        let error = 100.0 * runs[equal]["error"].as_f64().unwrap();
        assert!((largest - error).abs() < 1e-9, "{largest} and {error}");
    }
    let files = document["files"].as_array().unwrap();
    assert_eq!(files.len(), 2, "{files:?}");
    for file in files {
        assert!(bench.path(file.as_str().unwrap()).is_file(), "{file}");
    }
}

#[test]
fn tables_name_every_formulation_and_unknown_words_are_refused() {
    let bench = Bench::new("");
    let arguments = [
        "compare",
        "model.toml",
        "--formulations",
        "dem",
        "--meshes",
        "1",
    ];
    let (code, stdout, stderr) = bench.run(&arguments);
    assert_eq!(code, 0, "{stderr}");
    for text in [
        "Reference: dem with 40 elements",
        "on equal mesh",
        "CPU s at 1 %",
    ] {
        assert!(stdout.contains(text), "{text} is not in\n{stdout}");
    }
    let (code, _, stderr) = bench.run(&["compare", "model.toml", "--formulations", "dem,spectral"]);
    assert_eq!(code, 2);
    assert!(stderr.contains("dem, fem, fem-exact, lumped"), "{stderr}");
}
