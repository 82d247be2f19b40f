//! What each command prints, writes and exits with.

mod common;

use common::{Bench, key_paths, repository_file};

const BAD_CASE: &str = "
[cases.bad]
description = 'asks for the impossible'
motions.heave.amplitude = '1e12 m'
";

#[test]
fn run_writes_results_figures_and_a_comparison() {
    let bench = Bench::new("");
    let (code, stdout, stderr) = bench.run(&["run", "model.toml"]);
    assert_eq!(code, 0, "{stderr}");
    assert!(
        stderr.is_empty(),
        "no progress where nobody looks: {stderr}"
    );
    for text in [
        "Compared with nobody",
        "pump.offset_x, mean",
        "Compared with elsewhere",
        "pipe.end_a.force_z, max, from",
        "a mean is over the last 8 s, min and max are over the whole run",
        "mean over the last 8 s",
        "min and max over the whole run",
        "Note: A test.",
        "times real time",
        "energy imbalance",
    ] {
        assert!(stdout.contains(text), "{text} is missing in\n{stdout}");
    }
    assert!(stdout.lines().all(|line| line.chars().count() <= 100));
    for file in [
        "results.zarr/zarr.json",
        "summary.json",
        "figures/offset.svg",
        "figures/offset.png",
    ] {
        assert!(bench.path("results/model").join(file).is_file(), "{file}");
    }
    let figure = std::fs::read_to_string(bench.path("results/model/figures/offset.svg")).unwrap();
    for text in ["pump, offset x [m]", "Time [s]", "A test."] {
        assert!(figure.contains(&format!(">{text}<")), "{text}");
    }
    let (code, again, _) = bench.run(&["summary", "results/model"]);
    assert_eq!(code, 0);
    assert!(stdout.starts_with(&again), "summary prints the same tables");
    let (code, _, stderr) = bench.run(&["run", "model.toml", "--threads", "1", "--quiet"]);
    assert_eq!(code, 0, "earlier results are replaced: {stderr}");
}

#[test]
fn modes_are_told_proved_stored_and_drawn() {
    let bench = Bench::new("");
    let (code, stdout, stderr) = bench.run(&["modes", "model.toml", "--out", "out"]);
    assert_eq!(code, 0, "{stderr}");
    for text in [
        "Hanging pipe: natural modes",
        "moves most",
        "modes were counted up to",
        "With the added mass of the water",
        "Note: A test.",
        "modes_one_pipe.svg, .png",
    ] {
        assert!(stdout.contains(text), "{text} is missing in\n{stdout}");
    }
    assert!(
        stdout.lines().all(|line| line.chars().count() <= 100),
        "{stdout}"
    );
    for file in ["results.zarr/cases/one.zip", "figures/modes_one_pipe.png"] {
        assert!(bench.path("out").join(file).is_file(), "{file}");
    }
    let (_, all) = bench.json(&["modes", "model.toml"]);
    let (_, band) = bench.json(&["modes", "model.toml", "--band", "0.1 Hz..1 Hz"]);
    let (_, air) = bench.json(&["modes", "model.toml", "--air", "--count", "2"]);
    let modes = |document: &serde_json::Value| {
        let modes = document["cases"]["one"]["modes"].as_array();
        modes.cloned().unwrap_or_default()
    };
    let vibrations = |document: &serde_json::Value| -> Vec<f64> {
        let modes = modes(document);
        let shaking = modes.iter().filter(|mode| mode["kind"] == "vibration");
        shaking
            .filter_map(|mode| mode["frequency_hz"].as_f64())
            .collect()
    };
    assert!(vibrations(&all).len() >= 10, "ten, where nothing is said");
    let inside = vibrations(&band);
    assert!(!inside.is_empty() && inside.iter().all(|hz| (0.1..1.0).contains(hz)));
    assert!(vibrations(&air)[0] > vibrations(&all)[0]);
    let (code, document) = bench.json(&["modes", "model.toml", "--count", "1000"]);
    assert_eq!(code, 1);
    assert_eq!(document["cases"]["one"]["error"]["code"], "modes::too_many");
    let (code, _, stderr) = bench.run(&["modes", "model.toml", "--band", "2..1"]);
    assert_eq!(code, 2);
    assert!(stderr.contains("from a lower to a higher"), "{stderr}");
}

#[test]
fn json_documents_have_the_keys_that_the_guide_lists() {
    let bench = Bench::new(BAD_CASE);
    let guide = repository_file("docs/cli.md");
    let mut missing = Vec::new();
    for arguments in [
        &["check", "model.toml"][..],
        &["statics", "model.toml"],
        &["modes", "model.toml", "--count", "4"],
        &["run", "model.toml", "--out", "out"],
        &["summary", "out"],
        &["export", "out", "--to", "csv"],
        &["check", "nothing.toml"],
    ] {
        let (_, document) = bench.json(arguments);
        for key in ["command", "ok", "exit_code", "error"] {
            assert!(document.get(key).is_some(), "{key} in {arguments:?}");
        }
        let mut keys = Vec::new();
        key_paths(&document, "", &mut keys);
        missing.extend(keys.into_iter().filter(|key| {
            let last = key.rsplit('.').next().unwrap_or_default();
            last != "*" && !guide.contains(&format!("`{last}`"))
        }));
    }
    missing.sort();
    missing.dedup();
    assert!(missing.is_empty(), "not in docs/cli.md: {missing:#?}");
}

#[test]
fn a_failing_case_does_not_stop_the_others() {
    let bench = Bench::new(BAD_CASE);
    let (code, document) = bench.json(&["run", "model.toml", "--out", "out"]);
    assert_eq!(code, 1);
    assert_eq!(document["ok"], false);
    let (one, bad) = (&document["cases"]["one"], &document["cases"]["bad"]);
    assert_eq!(
        (one["status"].as_str(), bad["status"].as_str()),
        (Some("complete"), Some("failed"))
    );
    assert!(one["bodies"]["pump"]["offset_x_m"].is_f64());
    assert_eq!(bad["error"]["code"], "dynamics::not_converged");
    // Where the solver gave up: an element of the pipe, or the pump below it.
    let message = bad["error"]["message"].as_str().unwrap();
    assert!(
        message.contains("line 'pipe'") || message.contains("body 'pump'"),
        "{message}"
    );
    let (code, document) = bench.json(&["summary", "out"]);
    assert_eq!((code, document["status"].as_str()), (0, Some("failed")));
    let (code, _) = bench.json(&["run", "model.toml", "--out", "out", "--case", "one"]);
    assert_eq!(code, 0);
}

#[test]
fn references_and_extremes_reach_the_document() {
    let bench = Bench::new("");
    let (code, document) = bench.json(&["run", "model.toml", "--out", "out"]);
    assert_eq!(code, 0);
    let case = &document["cases"]["one"];
    let [offset, force] = case["references"].as_array().unwrap().as_slice() else {
        panic!("two references")
    };
    let number = |value: &serde_json::Value| value.as_f64().unwrap();
    assert_eq!(offset["statistic"], "mean");
    assert_eq!(
        (number(&offset["low"]), number(&offset["high"])),
        (1.0, 1.0)
    );
    let mean = number(&case["bodies"]["pump"]["offset_x_m"]);
    assert_eq!(number(&offset["computed"]), mean);
    assert!((number(&offset["difference"]) - (mean - 1.0)).abs() < 1e-12);

    assert_eq!(force["statistic"], "max");
    let end = &case["lines"]["pipe"]["end_a"]["force_z_n"];
    assert_eq!(force["computed"], end["max"]);
    assert_eq!(number(&force["difference"]), 0.0, "inside its range");
    // The run starts at rest and the heave grows, but the mean lies between the extremes.
    assert!(number(&end["min"]) < number(&end["mean"]));
    assert!(number(&end["mean"]) < number(&end["max"]));
    let factor = number(&case["simulated_s"]) / number(&case["cpu_seconds"]);
    assert!((number(&case["real_time_factor"]) / factor - 1.0).abs() < 1e-12);
}

#[test]
fn statics_reports_end_forces_in_balance() {
    let bench = Bench::new("");
    let (code, document) = bench.json(&["statics", "model.toml"]);
    assert_eq!(code, 0);
    let case = &document["cases"]["one"];
    let pipe = &case["lines"]["pipe"];
    let force = |end: &str| pipe[end]["force_z_n"]["mean"].as_f64().unwrap();
    let (_, overview) = bench.json(&["check", "model.toml"]);
    let weight = overview["cases"]["one"]["lines"]["pipe"]["wet_weight_n"]
        .as_f64()
        .unwrap();
    // Ten kilonewtons of pipe balance to the static tolerance, 1e-7 of the system's weight.
    assert!((force("end_a") + force("end_b") + weight).abs() < 1e-6 * weight.abs());
    assert!((force("end_b") - 15e3).abs() < 0.1);
    assert_eq!(case["steps"], serde_json::Value::Null);
    let (code, stdout, _) = bench.run(&["statics", "model.toml"]);
    assert_eq!(code, 0);
    assert!(stdout.contains("effective tension"), "{stdout}");
}

#[test]
fn a_wanted_accuracy_chooses_the_mesh_and_states_the_errors() {
    let bench = Bench::new("");
    let (code, document) = bench.json(&["run", "model.toml", "--out", "out", "--accuracy", "5%"]);
    assert_eq!(code, 0);
    let chosen = &document["cases"]["one"]["discretisation"];
    assert_eq!(chosen["reached"], true, "{chosen}");
    let estimates = chosen["estimates"].as_array().unwrap();
    let tension = "pipe.end_a.effective_tension, max";
    assert!(estimates.iter().any(|e| e["result"] == tension), "{chosen}");
    for estimate in estimates.iter().filter(|e| e["steers"] == true) {
        let number = |key: &str| estimate[key].as_f64().unwrap();
        let error = number("space_error") + number("time_error");
        assert!(error <= 0.05 * number("scale"), "{estimate}");
    }
    // The store tells the same.
    let (_, stored) = bench.json(&["summary", "out"]);
    assert_eq!(stored["cases"]["one"]["discretisation"], *chosen);
    let (code, stdout, _) = bench.run(&["statics", "model.toml", "--accuracy", "0.02"]);
    assert_eq!(code, 0);
    assert!(stdout.contains("Accuracy of 2.00 % asked for"), "{stdout}");
    assert_eq!(bench.run(&["run", "model.toml", "--accuracy", "much"]).0, 2);
}

#[test]
fn wrong_input_ends_with_the_code_that_the_help_lists() {
    let bench = Bench::new("[output]\n");
    let (code, _, stderr) = bench.run(&["check", "model.toml"]);
    assert_eq!(code, 3);
    assert!(stderr.contains("model.toml:"), "{stderr}");
    let (code, document) = bench.json(&["run", "model.toml"]);
    assert_eq!(code, 3);
    assert!(
        document["error"]["diagnostics"][0]["line"]
            .as_u64()
            .unwrap()
            > 1
    );

    let bench = Bench::new("");
    assert_eq!(bench.run(&[]).0, 2);
    assert_eq!(bench.run(&["run"]).0, 2);
    let (code, _, stderr) = bench.run(&["run", "model.toml", "--case", "two"]);
    assert_eq!(code, 2);
    assert!(stderr.contains("it has one"), "{stderr}");
    assert_eq!(bench.run(&["run", "nothing.toml"]).0, 4);
    assert_eq!(bench.run(&["summary", "nothing"]).0, 4);
    std::fs::create_dir(bench.path("thesis")).unwrap();
    std::fs::write(bench.path("thesis/chapter.tex"), "keep").unwrap();
    let (code, _, stderr) = bench.run(&["run", "model.toml", "--out", "thesis"]);
    assert_eq!(code, 4);
    assert!(stderr.contains("left alone"), "{stderr}");
    let help = bench.run(&["--help"]).1;
    for code in ["  0  ", "  1  ", "  2  ", "  3  ", "  4  ", "130  "] {
        assert!(help.contains(code), "{help}");
    }
}

#[test]
fn check_prints_the_system_and_schema_is_json() {
    let bench = Bench::new("");
    let (code, stdout, _) = bench.run(&["check", "model.toml"]);
    assert_eq!(code, 0);
    for text in [
        "no errors",
        "ship (ball), pump (fixed)",
        "offsets from ship",
        "Figures: offset",
    ] {
        assert!(stdout.contains(text), "{text} is missing in\n{stdout}");
    }
    assert!(stdout.lines().all(|line| line.chars().count() <= 100));
    let (code, stdout, _) = bench.run(&["schema"]);
    assert_eq!(code, 0);
    let schema: serde_json::Value = serde_json::from_str(&stdout).unwrap();
    assert!(schema["properties"]["lines"].is_object());
}
