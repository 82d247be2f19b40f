//! The verification report: complete, well formed, self-contained, and robust against odd data.
// A panic is how a test fails, and this file is nothing but tests.
#![allow(clippy::unwrap_used)]

mod pages;

use std::collections::BTreeSet;
use std::path::Path;

use catenix_report::write_verification;
use catenix_results::{
    Verification, VerifiedCase, VerifiedConvergence, VerifiedCurve, VerifiedEstimate,
    VerifiedNumber,
};
use pages::{parse, text};
use roxmltree::{Document, Node};

const HOSTILE: &str = "<b>&\"'提升管</b>\u{7}";

fn number(name: &str, error: f64, passed: Option<bool>) -> VerifiedNumber {
    VerifiedNumber {
        name: name.into(),
        unit: "m²".into(),
        reference: 2.0,
        computed: Some(2.0 * (1.0 + error)),
        error: Some(error),
        scale: 2.0,
        tolerance: 1e-3,
        reason: "Error of the mesh.".into(),
        passed,
    }
}

fn curve(name: &str, points: usize, passed: Option<bool>) -> VerifiedCurve {
    let x: Vec<f64> = (0..points).map(|i| 0.01 * i as f64).collect();
    VerifiedCurve {
        name: name.into(),
        x_label: "time [s]".into(),
        y_label: "deflection [m]".into(),
        computed: x.iter().map(|x| x.sin() + 3e-6).collect(),
        reference: x.iter().map(|x| x.sin()).collect(),
        x,
        error: 1e-5,
        tolerance: 1e-4,
        reason: "Error of the step.".into(),
        passed,
    }
}

fn convergence(name: &str, passed: bool) -> VerifiedConvergence {
    VerifiedConvergence {
        name: name.into(),
        x_label: "elements".into(),
        x: vec![5.0, 10.0, 20.0],
        errors: vec![1e-2, 2.5e-3, 6.25e-4],
        order: 2.0,
        least_order: 1.9,
        reason: "Second order at the ends.".into(),
        passed,
    }
}

fn estimate(name: &str, actual: f64, holds: bool) -> VerifiedEstimate {
    VerifiedEstimate {
        name: name.into(),
        target: 0.01,
        elements: 20,
        estimated: 1e-3,
        actual,
        holds,
    }
}

#[test]
fn estimates_that_do_not_hold_are_listed_beside_the_share_that_does() {
    let directory = tempfile::tempdir().unwrap();
    let page = written(&suite(), directory.path());
    let words = text(parse(&page).root_element());
    assert!(
        words.contains("50.0 % of 2 estimates; 95 % must be"),
        "{words}"
    );
    assert!(
        words.contains("tip <x>") && !words.contains("tip.z"),
        "{words}"
    );
    assert!(
        directory
            .path()
            .join("figures/error-estimates.svg")
            .is_file()
    );
}

fn case(name: &str, topic: &str) -> VerifiedCase {
    VerifiedCase {
        name: name.into(),
        title: format!("Title of {name}"),
        topic: topic.into(),
        summary: "What is computed.".into(),
        source: "A *source*.".into(),
        passed: true,
        error: None,
        numbers: Vec::new(),
        curves: Vec::new(),
        convergences: Vec::new(),
        estimates: Vec::new(),
        formulation: "dem".into(),
        refused: Vec::new(),
        cpu_seconds: 1.5,
    }
}

/// A suite with everything that a report may meet.
fn suite() -> Verification {
    let good = VerifiedCase {
        numbers: vec![
            number("small", 1.5e-5, Some(true)),
            number("worst", 5e-4, Some(true)),
            number("shown", 0.2, None),
        ],
        curves: vec![curve("history", 1000, Some(true)), curve("few", 5, None)],
        convergences: vec![convergence("mesh", true)],
        estimates: vec![
            estimate("tip.z", 1e-4, true),
            estimate("tip <x>", 5e-3, false),
        ],
        ..case("good", "Vibration")
    };
    let nothing = VerifiedNumber {
        computed: None,
        error: None,
        passed: Some(false),
        ..number("no value", 0.0, None)
    };
    let nan = VerifiedNumber {
        reference: 0.0,
        computed: Some(f64::NAN),
        error: Some(f64::NAN),
        scale: 1.5,
        tolerance: 0.0,
        ..number("not a number", 0.0, Some(false))
    };
    let odd = VerifiedCurve {
        x: vec![0.0, f64::NAN, 2.0, 3.0],
        computed: vec![1.0, f64::INFINITY, f64::NAN, 2.0],
        reference: vec![1.0],
        ..curve(HOSTILE, 0, Some(false))
    };
    let absolute = VerifiedCase {
        numbers: vec![VerifiedNumber {
            unit: "N".into(),
            reference: 47140.0,
            computed: Some(47112.0),
            error: Some(28.0),
            scale: 1.0,
            tolerance: 60.0,
            ..number("tension", 0.0, Some(true))
        }],
        ..case("absolute", "Risers")
    };
    let hostile = VerifiedCase {
        title: HOSTILE.into(),
        summary: HOSTILE.into(),
        source: format!("{HOSTILE} <script>alert(1)</script> ![x](http://a.b/c.png)"),
        error: Some(HOSTILE.into()),
        passed: false,
        numbers: vec![
            VerifiedNumber {
                unit: HOSTILE.into(),
                reason: HOSTILE.into(),
                ..nothing
            },
            nan,
        ],
        curves: vec![odd, curve("no points", 0, Some(false))],
        convergences: vec![
            VerifiedConvergence {
                x: vec![1.0, 0.0, 3.0],
                errors: vec![0.0, f64::NAN, -1.0],
                order: f64::NAN,
                ..convergence(HOSTILE, false)
            },
            VerifiedConvergence {
                x: Vec::new(),
                errors: Vec::new(),
                ..convergence("empty", false)
            },
        ],
        ..case("../<&\"提升", HOSTILE)
    };
    let of_length = |name: &str| VerifiedNumber {
        scale: 40.0,
        ..number(name, 0.3, None)
    };
    let only_shown = VerifiedCase {
        numbers: vec![of_length("shown"), of_length("another")],
        ..case("only-shown", "Vibration")
    };
    Verification {
        catenix_version: "1.2.3".into(),
        passed: false,
        estimates_that_hold: Some(0.5),
        // A name that differs by letters which are no part of file names, and an empty case.
        cases: vec![
            good,
            hostile,
            only_shown,
            case("../??\"提升", ""),
            case("GOOD", "Vibration"),
            absolute,
        ],
    }
}

fn written(report: &Verification, directory: &Path) -> String {
    let files = write_verification(report, directory).unwrap();
    for file in &files {
        assert!(file.is_file() && file.starts_with(directory), "{file:?}");
        assert!(!file.display().to_string().contains(".."), "{file:?}");
    }
    let unique: BTreeSet<String> = files
        .iter()
        .map(|file| file.display().to_string().to_lowercase())
        .collect();
    assert_eq!(unique.len(), files.len());
    assert_eq!(files[0], directory.join("index.html"));
    std::fs::read_to_string(&files[0]).unwrap()
}

fn with_class<'a>(document: &'a Document<'a>, tag: &str, class: &str) -> Vec<Node<'a, 'a>> {
    let has = |node: &Node<'_, '_>| {
        let classes = node.attribute("class").unwrap_or_default();
        node.has_tag_name(tag) && classes.split(' ').any(|found| found == class)
    };
    document.descendants().filter(has).collect()
}

#[test]
fn a_page_with_everything_is_well_formed_and_loads_nothing() {
    let directory = tempfile::tempdir().unwrap();
    let page = written(&suite(), directory.path());
    let document = parse(&page);
    let mut ids = BTreeSet::new();
    for node in document.descendants().filter(Node::is_element) {
        if let Some(id) = node.attribute("id") {
            assert!(ids.insert(id), "the id {id} stands twice");
        }
        for name in ["src", "srcset", "data", "xlink:href"] {
            assert_eq!(node.attribute(name), None, "{node:?}");
        }
        let handlers = node
            .attributes()
            .any(|found| found.name().starts_with("on"));
        assert!(!handlers, "{node:?}");
        let tag = node.tag_name().name();
        assert!(
            !["script", "img", "link", "iframe", "image"].contains(&tag),
            "{tag}"
        );
    }
    for link in document
        .descendants()
        .filter_map(|node| node.attribute("href"))
    {
        match link.strip_prefix('#') {
            Some(id) => assert!(ids.contains(id), "{link} leads nowhere"),
            None => assert!(directory.path().join(link).is_file(), "{link}"),
        }
    }
    for word in [
        "url(",
        "@import",
        "@font-face",
        "NaN",
        "&amp;amp;",
        "&amp;lt;",
    ] {
        assert!(!page.contains(word), "{word}");
    }
    assert!(page.contains("&lt;b&gt;&amp;&quot;&#39;提升管&lt;/b&gt;"));
    assert!(page.contains("&lt;script&gt;"));
    assert!(page.contains("<td>m<sup>2</sup></td>"));
}

#[test]
fn verdicts_are_counted_and_the_worst_quantities_named() {
    let directory = tempfile::tempdir().unwrap();
    let page = written(&suite(), directory.path());
    let document = parse(&page);
    let rows = |class: &str| -> Vec<String> {
        with_class(&document, "table", class)
            .into_iter()
            .flat_map(|table| table.descendants())
            .filter(|node| node.has_tag_name("tr"))
            .map(|row| {
                let cells = row.children().filter(Node::is_element).map(text);
                cells.collect::<Vec<_>>().join(" | ")
            })
            .collect()
    };
    assert_eq!(
        rows("counts"),
        [
            "Kind | passed | failed | only shown",
            "Cases | 2 | 1 | 3",
            "Numbers | 3 | 2 | 3",
            "Curves | 1 | 2 | 1",
            "Orders of convergence | 1 | 2 | 0",
        ]
    );
    let summary = rows("summary");
    for row in [
        "good | worst | 5.0×10−4 | 1.0×10−3 | 50 % | passed | 1.5 s",
        "absolute | tension | 28 N | 60 N | 47 % | passed | 1.5 s",
        "only-shown | – | – | – | – | only shown | 1.5 s",
    ] {
        assert!(
            summary.iter().any(|found| found == row),
            "{row} in {summary:#?}"
        );
    }
    let numbers = rows("numbers");
    for row in [
        "small | 2 | 2.000030 | m2 | 1.5×10−5 | 1.0×10−3 | 1.5 % | passed",
        "shown | 2 | 2.4000 | m2 | 2.0×10−1 | – | – | only shown",
        "not a numbererror relative to 1.5 m2 | 0 | not a number | m2 | – | 0 [2] | – | failed",
    ] {
        assert!(
            numbers.iter().any(|found| found == row),
            "{row} in {numbers:#?}"
        );
    }
    let remarks: Vec<String> = with_class(&document, "p", "reasons")
        .into_iter()
        .map(text)
        .collect();
    assert!(
        remarks
            .iter()
            .any(|found| found == "Errors are relative to 40 m2."),
        "{remarks:?}"
    );
    let figures = with_class(&document, "figure", "failed");
    assert_eq!(figures.len(), 4);
    // Cases of one topic stand together.
    let titles = document
        .descendants()
        .filter(|node| node.has_tag_name("h3"));
    let titles: Vec<String> = titles.map(text).collect();
    assert!(titles[0].contains("good") && titles[1].contains("only-shown"));
    assert!(titles[2].contains("GOOD"), "{titles:?}");
}

#[test]
fn curves_are_drawn_with_their_difference_and_errors_with_the_least_order() {
    let directory = tempfile::tempdir().unwrap();
    written(&suite(), directory.path());
    let svg = |stem: &str| {
        let file = directory.path().join("figures").join(stem);
        std::fs::read_to_string(file.with_extension("svg")).unwrap()
    };
    let history = svg("good-1");
    for label in [
        "computed",
        "reference",
        "difference [µm]",
        "deflection [m]",
        "time [s]",
    ] {
        assert!(history.contains(&format!(">{label}<")), "{label}");
    }
    let mesh = svg("good-3");
    for label in [
        "computed, observed order 2.00",
        "least order that passes, 1.9",
        "elements",
    ] {
        assert!(mesh.contains(&format!(">{label}<")), "{label}");
    }
}

#[test]
fn an_empty_suite_is_a_page_too() {
    let directory = tempfile::tempdir().unwrap();
    let report = Verification {
        catenix_version: "1.2.3".into(),
        passed: true,
        estimates_that_hold: None,
        cases: Vec::new(),
    };
    let page = written(&report, directory.path());
    assert!(text(parse(&page).root_element()).contains("There are no cases."));
}

/// The dark screen and the figures agree about colours: every colour of a figure has a counterpart.
#[test]
fn every_colour_of_a_figure_has_a_counterpart_on_dark_screens() {
    let directory = tempfile::tempdir().unwrap();
    let page = written(&suite(), directory.path());
    for attribute in ["fill", "stroke"] {
        for piece in page.split(&format!(" {attribute}=\"#")).skip(1) {
            let colour = &piece[..6];
            let rule = format!("[{attribute}=\"#{colour}\"]");
            assert!(page.contains(&rule), "{rule} is missing in style.css");
        }
    }
}
