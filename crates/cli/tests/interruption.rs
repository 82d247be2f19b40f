//! Runs that end early leave a store with everything up to the last flush.
#![cfg(unix)]
// A panic is how a test fails, in its helpers too.
#![allow(clippy::unwrap_used)]

mod common;

use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use catenix_results::{Status, StoredStudy};
use common::Bench;

/// The motion of the small model for a day: minutes of computing.
const LONG: &str = "
[cases.long]
dynamics.duration = '86400 s'
";

#[test]
fn ctrl_c_stops_at_the_next_step_and_keeps_the_results() {
    let bench = Bench::new(LONG);
    let child = start(&bench);
    wait_for_rows(&bench.path("out"));
    signal(&child, "INT");
    let output = child.wait_with_output().unwrap();
    let stdout = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(130), "{stdout}");
    let document: serde_json::Value = serde_json::from_str(&stdout).unwrap();
    assert_eq!(document["status"], "interrupted");
    let reached = document["cases"]["long"]["simulated_s"].as_f64().unwrap();
    assert!(document["cases"]["long"]["bodies"]["pump"]["offset_x_m"].is_f64());

    let stored = StoredStudy::open(&bench.path("out")).unwrap();
    let case = stored.case("long").unwrap();
    assert_eq!(case.status().unwrap(), Status::Interrupted);
    let history = case.channel("pump.offset_x").unwrap();
    // Everything is there, to the last output time before the step that was the last.
    assert!(reached - history.times_s.last().unwrap() < 0.11);
    assert!(history.values.iter().all(|value| value.is_finite()));
    assert!(bench.path("out/figures/offset.png").is_file());
}

#[test]
fn a_killed_run_keeps_everything_up_to_the_last_flush() {
    let bench = Bench::new(LONG);
    let mut child = start(&bench);
    wait_for_rows(&bench.path("out"));
    child.kill().unwrap();
    child.wait().unwrap();
    let stored = StoredStudy::open(&bench.path("out")).unwrap();
    let case = stored.case("long").unwrap();
    assert_eq!(case.status().unwrap(), Status::Running);
    for name in case.channel_names().unwrap() {
        let history = case.channel(&name).unwrap();
        assert!(history.times_s.len() > 1);
        assert!(
            history.values.iter().all(|value| value.is_finite()),
            "{name}"
        );
    }
    let (code, document) = bench.json(&["summary", "out"]);
    assert_eq!((code, document["status"].as_str()), (0, Some("running")));
    assert!(document["cases"]["long"]["bodies"]["pump"]["offset_x_m"].is_f64());
    let (code, stdout, _) = bench.run(&["summary", "out/results.zarr"]);
    assert_eq!(code, 0);
    assert!(stdout.contains("its process was killed"), "{stdout}");
    // And the next run takes its place.
    let (code, _, stderr) = bench.run(&["run", "model.toml", "--out", "out", "--case", "one"]);
    assert_eq!(code, 0, "{stderr}");
}

fn start(bench: &Bench) -> Child {
    bench
        .command(&[
            "run",
            "model.toml",
            "--case",
            "long",
            "--out",
            "out",
            "--json",
        ])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

/// Waits until the case has flushed some rows of its motion.
fn wait_for_rows(out: &Path) {
    let begin = Instant::now();
    while begin.elapsed() < Duration::from_secs(120) {
        std::thread::sleep(Duration::from_millis(50));
        let rows = StoredStudy::open(out)
            .and_then(|study| study.case("long")?.channel("pump.offset_x"))
            .map_or(0, |history| history.times_s.len());
        if rows > 1 {
            return;
        }
    }
    panic!("no rows within two minutes");
}

fn signal(child: &Child, name: &str) {
    let status = Command::new("kill")
        .args([&format!("-{name}"), &child.id().to_string()])
        .status()
        .unwrap();
    assert!(status.success());
}
