//! The report of a store: complete, well formed, self-contained, in both languages, true to what is
//! stored, and robust against odd names and unfinished runs.
// A panic is how a test fails, and this file is nothing but tests.
#![allow(clippy::unwrap_used)]

mod pages;
#[path = "../../results/tests/common/mod.rs"]
mod synthetic;

use std::fs;
use std::path::Path;

use catenix_model::LoadCase;
use catenix_report::{Language, Report, ReportError, ReportOptions, write_report};
use catenix_results::{ResultStore, Status, StoredStudy, Summary};
use pages::{is_self_contained, parse, rows, text};
use synthetic::{DURATION_S, Moment, STEP_S, provenance, study, unpack, write_store};

const HOSTILE: &str = "<b>&\"'{{ 7 }}提升管</b>";

fn report(store: &Path, options: &ReportOptions) -> Result<(Report, String), ReportError> {
    let file = store.join("report.html");
    let written = write_report(&StoredStudy::open(store).unwrap(), &file, options)?;
    let page = fs::read_to_string(file).unwrap();
    assert_eq!(written.bytes, page.len());
    Ok((written, page))
}

fn in_chinese() -> ReportOptions {
    ReportOptions {
        language: Language::Chinese,
        ..ReportOptions::default()
    }
}

#[test]
fn a_report_has_every_section_and_loads_nothing() {
    let directory = tempfile::tempdir().unwrap();
    write_store(
        directory.path(),
        &study(&["a", "b"]),
        DURATION_S,
        Status::Complete,
    );
    let options = ReportOptions {
        figures: Some(directory.path().join("pictures")),
        ..ReportOptions::default()
    };
    let (written, page) = report(directory.path(), &options).unwrap();
    is_self_contained(&page);
    for id in [
        "system",
        "environment",
        "results",
        "shapes",
        "histories",
        "ranges",
        "modes",
        "accuracy",
        "solver",
        "provenance",
    ] {
        assert!(page.contains(&format!("<section id=\"{id}\"")), "{id}");
    }
    assert_eq!((written.cases, written.complete_cases), (2, 2));
    assert_eq!(page.matches("<svg").count(), written.figures.len());
    let document = parse(&page);
    let captions = document
        .descendants()
        .filter(|n| n.has_tag_name("figcaption"));
    let captions: Vec<String> = captions.map(text).collect();
    for figure in &written.figures {
        let caption = format!("Figure {}. {}.", figure.number, figure.title);
        assert!(
            captions.iter().any(|found| found.starts_with(&caption)),
            "{caption}"
        );
        let [svg, png] = &figure.files[..] else {
            panic!("two files per figure: {:?}", figure.files);
        };
        let svg = fs::read_to_string(svg).unwrap();
        assert!(svg.contains("xmlns") && parse(&svg).root_element().has_tag_name("svg"));
        assert_eq!(&fs::read(png).unwrap()[1..4], b"PNG");
    }
    assert!(page.contains("catenix run synthetic.toml --accuracy 1%"));
    assert!(
        !page.contains("not recorded"),
        "the store says when it was made"
    );
}

/// A number as the page prints it, and half of its last digit.
fn number(text: &str) -> (f64, f64) {
    let plain = text.replace('−', "-");
    let decimals = plain.split_once('.').map_or(0, |(_, behind)| behind.len());
    (
        plain.parse().unwrap(),
        0.5001 * 10_f64.powi(-(decimals as i32)),
    )
}

#[test]
fn every_number_is_the_one_in_the_store() {
    let directory = tempfile::tempdir().unwrap();
    let summary = write_store(
        directory.path(),
        &study(&["a"]),
        DURATION_S,
        Status::Complete,
    );
    let (_, page) = report(directory.path(), &ReportOptions::default()).unwrap();
    let document = parse(&page);
    let case = &summary.cases["a"];
    let (body, line) = (&case.bodies["buffer"], &case.lines["pipe"]);
    let factor = |unit: &str| match unit {
        "kN" | "kN m" | "kPa" => 1e3,
        "MPa" => 1e6,
        "10³ m" | "103 m" | "103 1/m" => 1e3,
        "m" | "deg" | "N" | "N m" | "Pa" | "1/m" => 1.0,
        other => panic!("unit {other}"),
    };
    let end = |end: &catenix_results::EndSummary| {
        vec![
            ("force x, mean", end.force_x_n.mean),
            ("force y, mean", end.force_y_n.mean),
            ("force z, mean", end.force_z_n.mean),
            ("effective tension, smallest", end.effective_tension_n.min),
            ("effective tension, mean", end.effective_tension_n.mean),
            ("effective tension, largest", end.effective_tension_n.max),
        ]
    };
    let located = |name, value: Option<catenix_results::Located>| (name, value.unwrap().value);
    let mut expected = vec![
        ("offset x, mean", body.offset_x_m.unwrap()),
        ("offset y, mean", body.offset_y_m.unwrap()),
        ("offset z, mean", body.offset_z_m.unwrap()),
        ("tilt, mean", body.tilt_deg.unwrap()),
    ];
    expected.extend(end(&line.end_a));
    expected.extend(end(&line.end_b));
    expected.extend([
        located("effective tension, smallest", line.min_effective_tension_n),
        located("effective tension, largest", line.max_effective_tension_n),
        located("bending moment, largest", line.max_bend_moment_n_m),
        located("curvature, largest", line.max_curvature_1_m),
        located("von Mises stress, largest", line.max_von_mises_stress_pa),
    ]);
    let found: Vec<Vec<String>> = rows(&document, "Key results")
        .into_iter()
        .filter(|row| row.len() == 3 && row[0] != "Result")
        .collect();
    assert_eq!(found.len(), expected.len(), "{found:#?}");
    for (row, (name, value)) in found.iter().zip(expected) {
        let (shown, half) = number(&row[2]);
        let factor = factor(&row[1]);
        assert_eq!(row[0], name);
        assert!(
            (shown * factor - value).abs() <= half * factor,
            "{row:?} is {value}"
        );
    }
    let solver = rows(&document, "The solver's account");
    for (name, value) in [
        ("Iterations of the static solution", "7".to_owned()),
        ("Time steps", case.steps.unwrap().to_string()),
        ("Rejected steps", "1".to_owned()),
        ("Newton iterations", "160".to_owned()),
        ("Largest residual of a step", "0.250".to_owned()),
        ("Processor time", "0.500".to_owned()),
        ("Real-time factor", "40.0".to_owned()),
    ] {
        let row = solver.iter().find(|row| row[0] == name).unwrap();
        assert_eq!(row[2], value, "{name}");
    }
    let origin = rows(&document, "Program, model and store");
    assert!(origin.iter().any(|row| row[1] == summary.model_sha256));
    let references = rows(&document, "Results from elsewhere");
    let reference: Vec<&str> = references
        .last()
        .unwrap()
        .iter()
        .map(String::as_str)
        .collect();
    assert_eq!(reference[3..], ["−14.000 to −12.000", "−10.000", "2.000"]);
    let inside = references
        .iter()
        .any(|row| row.last().is_some_and(|cell| cell == "inside"));
    assert!(inside, "{references:?}");
    let modes = rows(&document, "Natural modes");
    assert_eq!(modes[2][..3], ["2", "0.50000", "2.000"]);
    assert_eq!(modes[1][1], "free");
}

#[test]
fn names_of_any_kind_are_shown_as_they_are() {
    let directory = tempfile::tempdir().unwrap();
    let mut study = study(&["a", HOSTILE]);
    study.title = HOSTILE.into();
    study.note = HOSTILE.into();
    study.figures[0].title = HOSTILE.into();
    study.figures[0].name = "../<x>".into();
    for case in &mut study.cases {
        case.description = HOSTILE.into();
        case.model.lines[0].name = "软管 <&>".into();
        case.model.bodies[0].name = "buffer".into();
        case.model.vessels[0].name = "\"采矿船\"".into();
    }
    write_store_as(directory.path(), &study, Status::Complete);
    for options in [ReportOptions::default(), in_chinese()] {
        let options = ReportOptions {
            figures: Some(directory.path().join("pictures")),
            ..options
        };
        let (written, page) = report(directory.path(), &options).unwrap();
        is_self_contained(&page);
        let words = text(parse(&page).root_element());
        for name in [HOSTILE, "软管 <&>", "\"采矿船\""] {
            assert!(words.contains(name), "{name}");
        }
        assert!(!page.contains("<b>&") && !page.contains(" 7提升管"));
        for figure in &written.figures {
            for file in &figure.files {
                assert_eq!(file.parent().unwrap(), directory.path().join("pictures"));
            }
        }
    }
}

/// Writes a store without modes: their names in the synthetic one are fixed.
fn write_store_as(directory: &Path, study: &catenix_model::Study, status: Status) -> Summary {
    let cases: Vec<&LoadCase> = study.cases.iter().collect();
    let store = ResultStore::create(directory, study, &cases, &provenance()).unwrap();
    let mut summaries = indexmap::IndexMap::new();
    for case in &study.cases {
        let mut recorder = store.record_case(case);
        recorder.record_static(case, &Moment { time: 0.0 }).unwrap();
        for step in 0..=(DURATION_S / STEP_S) as usize {
            let time = step as f64 * STEP_S;
            recorder.record(&Moment { time }).unwrap();
        }
        let outcome = synthetic::outcome(status, DURATION_S);
        summaries.insert(case.name.clone(), recorder.finish(&outcome).unwrap());
    }
    let provenance = provenance();
    let summary = Summary {
        catenix_version: provenance.version.clone(),
        title: study.title.clone(),
        note: study.note.clone(),
        model_file: provenance.model_file.clone(),
        model_sha256: provenance.model_sha256(),
        status,
        cases: summaries,
    };
    store.finish(&summary).unwrap();
    summary
}

#[test]
fn both_languages_have_the_same_sections_figures_and_numbers() {
    let directory = tempfile::tempdir().unwrap();
    write_store(
        directory.path(),
        &study(&["a", "b"]),
        DURATION_S,
        Status::Complete,
    );
    let (english, page) = report(directory.path(), &ReportOptions::default()).unwrap();
    let (chinese, seite) = report(directory.path(), &in_chinese()).unwrap();
    assert!(seite.starts_with("<!DOCTYPE html>\n<html lang=\"zh-CN\">"));
    assert_eq!(english.tables, chinese.tables);
    assert_eq!(english.figures.len(), chinese.figures.len());
    for word in [
        "有效张力",
        "弯矩",
        "冯·米塞斯应力",
        "曲率",
        "求解统计",
        "图 1",
    ] {
        assert!(seite.contains(word), "{word}");
    }
    for word in ["Figure", "Table", "tension", "Key results", "Solver"] {
        assert!(page.contains(word) || word == "Solver", "{word}");
        assert!(!seite.contains(word), "{word} in the Chinese page");
    }
    let numbers = |page: &str| -> Vec<String> {
        let document = parse(page);
        let is_number = |node: &roxmltree::Node<'_, '_>| {
            node.has_tag_name("td") && node.attribute("class") == Some("number")
        };
        let cells = document.descendants().filter(is_number).map(text);
        // Words among the numbers differ: "at", "inside", "to".
        let digits = |cell: String| {
            cell.chars()
                .filter(char::is_ascii_digit)
                .collect::<String>()
        };
        cells.map(digits).collect()
    };
    assert_eq!(numbers(&page), numbers(&seite));
}

#[test]
fn an_unfinished_run_says_so() {
    let directory = tempfile::tempdir().unwrap();
    let stopped = directory.path().join("stopped");
    write_store(&stopped, &study(&["a"]), 10.0, Status::Interrupted);
    let (written, page) = report(&stopped, &ReportOptions::default()).unwrap();
    let words = text(parse(&page).root_element());
    assert!(words.contains("The run was interrupted."));
    assert!(
        words.contains("Load case a: interrupted, results up to 10 s."),
        "{words}"
    );
    assert_eq!(
        (written.complete_cases, written.status),
        (0, Status::Interrupted)
    );

    // A process that was killed leaves the store as it was at its last flush.
    let killed = directory.path().join("killed");
    let study = study(&["a", "b"]);
    let cases: Vec<&LoadCase> = study.cases.iter().collect();
    let store = ResultStore::create(&killed, &study, &cases, &provenance()).unwrap();
    let mut recorder = store.record_case(cases[0]);
    recorder
        .record_static(cases[0], &Moment { time: 0.0 })
        .unwrap();
    for step in 0..60 {
        let time = f64::from(step) * STEP_S;
        recorder.record(&Moment { time }).unwrap();
    }
    std::thread::sleep(std::time::Duration::from_millis(2100));
    recorder.record(&Moment { time: 15.0 }).unwrap();
    drop(recorder);
    for options in [ReportOptions::default(), in_chinese()] {
        let (_, page) = report(&killed, &options).unwrap();
        is_self_contained(&page);
        let words = text(parse(&page).root_element());
        match options.language {
            Language::English => {
                assert!(words.contains("The run has not ended"));
                assert!(
                    words.contains("Load case b: not begun, no results."),
                    "{words}"
                );
                assert!(words.contains("all values are over the last stored stretch"));
            }
            Language::Chinese => assert!(words.contains("计算尚未结束")),
        }
    }
}

#[test]
fn a_store_without_anything_in_it_is_an_error_and_a_failed_one_a_report() {
    let directory = tempfile::tempdir().unwrap();
    let study = study(&["a"]);
    let cases: Vec<&LoadCase> = study.cases.iter().collect();
    let empty = directory.path().join("empty");
    ResultStore::create(&empty, &study, &cases, &provenance()).unwrap();
    let error = report(&empty, &ReportOptions::default()).unwrap_err();
    assert_eq!(error.code(), "report::empty");
    assert!(
        error.to_string().contains("catenix run synthetic.toml"),
        "{error}"
    );
    assert!(!empty.join("report.html").exists());

    let failed = directory.path().join("failed");
    let store = ResultStore::create(&failed, &study, &cases, &provenance()).unwrap();
    let error = catenix_results::CaseError {
        code: "statics::no_equilibrium".into(),
        message: "no <equilibrium>".into(),
    };
    let outcome = catenix_results::CaseOutcome::without_results(Status::Failed, Some(error));
    store.record_case(cases[0]).finish(&outcome).unwrap();
    let (_, page) = report(&failed, &ReportOptions::default()).unwrap();
    is_self_contained(&page);
    let words = text(parse(&page).root_element());
    assert!(
        words.contains("The solver's message: no <equilibrium>"),
        "{words}"
    );
}

#[test]
fn a_damaged_store_is_an_error_that_names_the_file() {
    let directory = tempfile::tempdir().unwrap();
    write_store(
        directory.path(),
        &study(&["a"]),
        DURATION_S,
        Status::Complete,
    );
    let chunk = unpack(directory.path(), "a").join("buffer.offset_x/c/0");
    let mut bytes = fs::read(&chunk).unwrap();
    bytes[5] ^= 1;
    fs::write(&chunk, bytes).unwrap();
    let error = report(directory.path(), &ReportOptions::default()).unwrap_err();
    assert_eq!(error.code(), "results::damaged");
    assert!(error.to_string().contains("offset_x") && error.to_string().contains("run the model"));
    assert!(!directory.path().join("report.html").exists());
}

#[test]
fn templates_replace_built_in_ones_and_tell_their_errors() {
    let directory = tempfile::tempdir().unwrap();
    write_store(
        directory.path(),
        &study(&["a"]),
        DURATION_S,
        Status::Complete,
    );
    let folder = directory.path().join("mine");
    fs::create_dir(&folder).unwrap();
    let options = ReportOptions {
        templates: Some(folder.clone()),
        ..ReportOptions::default()
    };
    let failed = || report(directory.path(), &options).unwrap_err();
    let error = failed();
    assert_eq!(error.code(), "report::template");
    assert!(error.to_string().contains("report-figure.html"), "{error}");

    fs::write(folder.join("own.html"), "<p>{{ t(\"page.contents\") }}</p>").unwrap();
    fs::write(
        folder.join("report.html"),
        "<html><body>{{ title|text }}{% include \"own.html\" %}{% for s in sections %}\
         {% for block in s.blocks if block.kind == \"table\" %}{% set table = block %}\
         {% include \"report-table.html\" %}{% endfor %}{% endfor %}</body></html>",
    )
    .unwrap();
    let (written, page) = report(directory.path(), &options).unwrap();
    assert_eq!(written.templates, ["report.html"]);
    let words = text(parse(&page).root_element());
    assert!(words.starts_with("SyntheticContents") && words.contains("offset x, mean"));

    for (content, line, what) in [
        ("<p>\n\n{{ titel }}</p>", 3, "undefined value"),
        ("<p>\n{% for x in %}</p>", 2, "syntax error"),
        ("{{ t('no.such') }}", 1, "no text with the key `no.such`"),
        ("\n{{ title|nofilter }}", 2, "unknown filter"),
        ("{% include 'gone.html' %}", 1, "gone.html"),
    ] {
        fs::write(folder.join("report.html"), content).unwrap();
        let error = failed().to_string();
        let place = format!("{}, line {line}: ", folder.join("report.html").display());
        assert!(error.contains(&place) && error.contains(what), "{error}");
    }
    fs::write(folder.join("report.html"), "{% include 'own.html' %}").unwrap();
    fs::write(folder.join("own.html"), "\n\n\n{{ wrong }}").unwrap();
    let error = failed().to_string();
    assert!(error.contains("own.html, line 4"), "{error}");
}

#[test]
fn every_colour_of_a_figure_has_a_counterpart_on_dark_screens() {
    let directory = tempfile::tempdir().unwrap();
    let names: Vec<String> = (0..9).map(|index| format!("case {index}")).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let single = directory.path().join("single");
    write_store(&single, &study(&["a"]), DURATION_S, Status::Complete);
    let many = directory.path().join("many");
    write_store(&many, &study(&names), DURATION_S, Status::Complete);
    for store in [single, many] {
        let (_, page) = report(&store, &ReportOptions::default()).unwrap();
        for attribute in ["fill", "stroke"] {
            for piece in page.split(&format!(" {attribute}=\"#")).skip(1) {
                let rule = format!("[{attribute}=\"#{}\"]", &piece[..6]);
                assert!(page.contains(&rule), "{rule} is missing in style.css");
            }
        }
    }
}
