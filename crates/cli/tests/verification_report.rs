//! `catenix verify --report`: the page and its figures.
// A panic is how a test fails, and this file is nothing but tests.
#![allow(clippy::unwrap_used)]

mod common;

use common::Bench;

#[test]
fn the_report_of_a_case_is_written_and_told() {
    let bench = Bench::new("");
    let case = "truss-snap-through";
    let (code, stdout, stderr) = bench.run(&["verify", "--case", case, "--report", "out/report"]);
    assert_eq!(code, 0, "{stderr}");
    assert!(stdout.contains("out/report/index.html"), "{stdout}");
    let page = std::fs::read_to_string(bench.path("out/report/index.html")).unwrap();
    assert!(page.contains(env!("CARGO_PKG_VERSION")) && page.contains(case));

    // A file stands where the directory would be made.
    let (code, _, stderr) = bench.run(&["verify", "--case", case, "--report", "model.toml"]);
    assert_eq!(code, 4, "{stderr}");
    assert!(stderr.contains("cannot write model.toml"), "{stderr}");
}
