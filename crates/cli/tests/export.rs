//! `catenix export`: what it writes, prints and exits with.

mod common;

use common::Bench;

#[test]
fn results_are_exported_in_every_format_beside_the_store() {
    let bench = Bench::new("");
    assert_eq!(bench.run(&["run", "model.toml", "--out", "out"]).0, 0);
    for (format, file) in [
        ("csv", "one_histories.csv"),
        ("parquet", "one_histories.parquet"),
        ("vtk", "one.pvd"),
        ("netcdf", "one.nc"),
    ] {
        let (code, stdout, stderr) = bench.run(&["export", "out", "--to", format]);
        assert_eq!(code, 0, "{stderr}");
        assert!(stderr.is_empty(), "no progress where nobody looks");
        assert!(stdout.contains(file), "{stdout}");
        assert!(bench.path("out/export").join(format).join(file).is_file());
    }
    let (code, _, stderr) = bench.run(&["run", "model.toml", "--out", "out"]);
    assert_eq!(
        code, 0,
        "exports do not stand in the way of a new run: {stderr}"
    );
}

#[test]
fn the_document_tells_files_rows_and_sizes() {
    let bench = Bench::new("");
    assert_eq!(bench.run(&["run", "model.toml", "--out", "out"]).0, 0);
    let arguments = [
        "export", "out", "--to", "csv", "-o", "tables", "--times", "8:16:2", "--line", "pipe",
    ];
    let (code, document) = bench.json(&arguments);
    assert_eq!(code, 0);
    assert_eq!(document["command"], "export");
    assert_eq!(document["cases"][0]["status"], "complete");
    assert_eq!(document["cases"][0]["end_time_s"], 16.0);
    let histories = &document["files"][0];
    assert_eq!(histories["content"], "histories");
    assert_eq!(histories["rows"], 5);
    let text = std::fs::read_to_string(bench.path("tables/one_histories.csv")).unwrap();
    assert_eq!(text.lines().count(), 6);
    assert_eq!(histories["bytes"], text.len());

    let (code, document) = bench.json(&arguments);
    assert_eq!(code, 4);
    assert_eq!(document["error"]["code"], "export::exists");
}

#[test]
fn what_cannot_be_done_ends_with_the_code_that_the_help_lists() {
    let bench = Bench::new("");
    assert_eq!(bench.run(&["run", "model.toml", "--out", "out"]).0, 0);
    for (arguments, code, text) in [
        (&["export", "out"][..], 2, "--to"),
        (
            &["export", "out", "--to", "xls"],
            2,
            "csv, parquet, vtk, netcdf",
        ),
        (
            &["export", "out", "--to", "csv", "--case", "One"],
            2,
            "did you mean `one`?",
        ),
        (
            &["export", "out", "--to", "csv", "--line", "pip"],
            2,
            "did you mean `pipe`?",
        ),
        (
            &["export", "out", "--to", "csv", "--every", "0"],
            2,
            "--every",
        ),
        (
            &["export", "out", "--to", "csv", "--times", "5"],
            2,
            "FROM:TO",
        ),
        (
            &["export", "out", "--to", "csv", "--times", "99:100"],
            2,
            "0 s to 16 s",
        ),
        (
            &["export", "nothing", "--to", "csv"],
            4,
            "no Catenix result store",
        ),
        (
            &["export", "out", "--to", "csv", "-o", "model.toml"],
            4,
            "cannot write",
        ),
    ] {
        let (found, stdout, stderr) = bench.run(arguments);
        assert_eq!(found, code, "{arguments:?}: {stderr}");
        assert!(stderr.contains(text), "{arguments:?}: {stderr}");
        assert!(stdout.is_empty());
    }
    // A store of a later version names that version.
    let root = bench.path("out/results.zarr/zarr.json");
    let metadata = std::fs::read_to_string(&root).unwrap();
    let newer = metadata.replace("\"catenix_store_format\":2", "\"catenix_store_format\":99");
    assert_ne!(newer, metadata);
    std::fs::write(&root, newer).unwrap();
    let (code, document) = bench.json(&["export", "out", "--to", "csv"]);
    assert_eq!(
        (code, document["error"]["code"].as_str()),
        (4, Some("results::newer"))
    );
}
