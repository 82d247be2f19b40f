//! `catenix report` from a run to a page, and its errors.
// A panic is how a test fails, and this file is nothing but tests.
#![allow(clippy::unwrap_used)]

mod common;

use common::Bench;

#[test]
fn a_run_becomes_one_page_with_figures_in_both_languages() {
    let bench = Bench::new("");
    let (code, _, stderr) = bench.run(&["run", "model.toml"]);
    assert_eq!(code, 0, "{stderr}");
    let (code, stdout, stderr) = bench.run(&["report", "results/model"]);
    assert_eq!((code, stderr.as_str()), (0, ""));
    assert!(
        stdout.starts_with("Written: results/model/report.html ("),
        "{stdout}"
    );
    assert!(stdout.lines().count() == 1, "{stdout}");
    let page = std::fs::read_to_string(bench.path("results/model/report.html")).unwrap();
    for text in ["Hanging pipe", "Offset of the pump", "A test.", "pump, 2 t"] {
        assert!(page.contains(text), "{text}");
    }
    let arguments = [
        "report",
        "results/model/results.zarr",
        "--lang",
        "zh",
        "--figures",
        "pictures",
        "--output",
        "zh.html",
    ];
    let (code, json) = bench.json(&arguments);
    assert_eq!(
        (code, &json["ok"], &json["error"]),
        (0, &true.into(), &().into())
    );
    assert_eq!(json["report"], "zh.html");
    assert_eq!(json["language"], "zh");
    assert_eq!(json["complete_cases"], json["cases"]);
    assert_eq!(json["status"], "complete");
    let figures = json["figures"].as_array().unwrap();
    assert!(figures.len() > 5);
    for file in figures
        .iter()
        .flat_map(|figure| figure["files"].as_array().unwrap())
    {
        assert!(bench.path(file.as_str().unwrap()).is_file(), "{file}");
    }
    assert!(bench.path("pictures/01-system.svg").is_file());
    let page = std::fs::read_to_string(bench.path("zh.html")).unwrap();
    assert!(page.contains("有效张力") && json["bytes"] == page.len());
    // A report is part of the results: a new run removes it with them.
    let (code, _, _) = bench.run(&["run", "model.toml", "--quiet"]);
    assert_eq!(code, 0);
    assert!(!bench.path("results/model/report.html").exists());
}

#[test]
fn errors_say_what_to_do_and_exit_with_4() {
    let bench = Bench::new("");
    let (code, _, stderr) = bench.run(&["report", "nowhere"]);
    assert_eq!(code, 4);
    assert!(stderr.contains("catenix run"), "{stderr}");
    let (code, _, stderr) = bench.run(&["run", "model.toml", "--quiet"]);
    assert_eq!(code, 0, "{stderr}");
    for (arguments, expected) in [
        (
            vec!["-o", "no/such/report.html"],
            "there is no folder no/such",
        ),
        (
            vec!["-o", "results"],
            "results is a folder; give the name of a file",
        ),
        (
            vec!["--templates", "no-templates"],
            "cannot read no-templates",
        ),
    ] {
        let mut all = vec!["report", "results/model"];
        all.extend(arguments);
        let (code, stdout, stderr) = bench.run(&all);
        assert_eq!((code, stdout.as_str()), (4, ""), "{all:?}");
        assert!(stderr.contains(expected), "{stderr}");
    }
    let (code, _, stderr) = bench.run(&["report", "results/model", "--lang", "de"]);
    assert_eq!(code, 2);
    assert!(stderr.contains("write en or zh"), "{stderr}");

    let root = bench.path("results/model/results.zarr/zarr.json");
    let text = std::fs::read_to_string(&root).unwrap();
    let newer = text.replace("\"catenix_store_format\":2", "\"catenix_store_format\":99");
    assert_ne!(text, newer);
    std::fs::write(&root, newer).unwrap();
    let (code, json) = bench.json(&["report", "results/model"]);
    assert_eq!(
        (code, &json["error"]["code"]),
        (4, &"results::newer".into())
    );
    std::fs::write(&root, &text[..text.len() / 2]).unwrap();
    let (code, json) = bench.json(&["report", "results/model"]);
    assert_eq!(
        (code, &json["error"]["code"]),
        (4, &"results::damaged".into())
    );
}
