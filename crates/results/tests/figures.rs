//! Figures: drawn from a store, readable as SVG and PNG, and robust against odd data.

mod common;

use catenix_results::figure::{Chart, Curve, study_chart};
use catenix_results::{Status, StoredStudy};

#[test]
fn a_figure_of_the_study_has_a_curve_and_a_legend_entry_per_case() {
    let dir = tempfile::tempdir().unwrap();
    let study = common::study(&["a", "b"]);
    common::write_store(dir.path(), &study, 20.0, Status::Complete);
    let stored = StoredStudy::open(dir.path()).unwrap();
    let figures = stored.figures();
    let drawing = study_chart(&stored, &figures[0]).unwrap().draw();
    let svg = drawing.to_svg();
    for text in [
        "Offset",
        "a: case a",
        "b: case b",
        "Made up.",
        "buffer, offset x [m]",
        "Time [s]",
    ] {
        assert!(svg.contains(&format!(">{text}<")), "{text} is missing");
    }
    let png = drawing.to_png(2.0).unwrap();
    assert_eq!(&png[1..4], b"PNG");
    assert_eq!(
        u32::from_be_bytes([png[16], png[17], png[18], png[19]]),
        1800
    );
    // The font is built in: an empty picture would compress to a few kilobytes.
    assert!(png.len() > 20_000, "{} bytes", png.len());
}

#[test]
fn gaps_empty_curves_and_hostile_labels_are_drawn() {
    let chart = Chart {
        title: "<script> & \u{7} a title that is far too long for one line ".repeat(4),
        x_label: "Time [s]".into(),
        y_label: "提升管".into(),
        y_unit: "N".into(),
        note: String::new(),
        curves: vec![
            Curve {
                label: "nothing at all".into(),
                points: Vec::new(),
            },
            Curve {
                label: "x".repeat(400),
                points: vec![(0.0, 1e8), (1.0, f64::NAN), (2.0, -1e8), (3.0, 0.0)],
            },
        ],
    };
    let drawing = chart.draw();
    let svg = drawing.to_svg();
    assert!(!svg.contains("<script>") && !svg.contains("NaN") && !svg.contains('\u{7}'));
    assert!(svg.contains("[MN]"));
    assert!(drawing.to_png(1.0).is_ok());
    let empty = Chart {
        curves: Vec::new(),
        ..chart
    };
    assert!(empty.draw().to_png(1.0).is_ok());
}
