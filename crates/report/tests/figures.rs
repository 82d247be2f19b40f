//! Figures: complete as SVG and PNG, and robust against odd data.

use catenix_report::figure::{Chart, ChartAxis, Curve, Look, Panel};

#[test]
fn curves_legend_titles_and_note_are_drawn() {
    let points = |scale: f64| {
        (0..40)
            .map(|i| (f64::from(i), scale * f64::from(i)))
            .collect()
    };
    let chart = Chart::new(
        "Offset",
        ChartAxis::linear("Time", "s"),
        ChartAxis::linear("buffer, offset x", "m"),
        vec![
            Curve::new("a: case a", points(1.0)),
            Curve::new("b: case b", points(-2.0)),
        ],
    );
    let drawing = chart.with_note("Made up.").draw();
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
    let chart = Chart::new(
        &"<script> & \u{7} a title that is far too long for one line ".repeat(4),
        ChartAxis::linear("Time", "s"),
        ChartAxis::linear("提升管", "N"),
        vec![
            Curve::new("nothing at all", Vec::new()),
            Curve::new(
                &"x".repeat(400),
                vec![(0.0, 1e8), (1.0, f64::NAN), (2.0, -1e8), (3.0, 0.0)],
            ),
        ],
    );
    let drawing = chart.draw();
    let svg = drawing.to_svg();
    assert!(!svg.contains("<script>") && !svg.contains("NaN") && !svg.contains('\u{7}'));
    assert!(svg.contains("[MN]"));
    assert!(drawing.to_png(1.0).is_ok());
    let empty = Chart {
        panels: Vec::new(),
        ..chart
    };
    assert!(empty.draw().to_png(1.0).is_ok());
}

#[test]
fn logarithmic_axes_raise_their_exponents_and_leave_out_what_has_no_place() {
    let errors = [1e-2, 2.5e-3, 0.0, -1.0, f64::NAN, 4e-5];
    let meshes = [5.0, 10.0, 20.0, 40.0, 80.0, 160.0];
    let points: Vec<_> = meshes.into_iter().zip(errors).collect();
    let chart = Chart::new(
        "Convergence",
        ChartAxis::logarithmic("elements", ""),
        ChartAxis::logarithmic("relative error", "-"),
        vec![
            Curve::new("error", points).with_look(Look::Computed),
            Curve::new("bound", vec![(5.0, 1e-2), (160.0, 1e-5)]).with_look(Look::Bound),
        ],
    );
    let drawing = chart.draw();
    let svg = drawing.to_svg();
    assert!(svg.contains("10<tspan dy=\"-4.9\" font-size=\"9.4\">−3</tspan></text>"));
    assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
    assert_eq!(svg.matches("<polygon").count(), 3 + 1);
    assert!(drawing.to_png(1.0).is_ok());
}

#[test]
fn panels_stand_below_each_other_over_one_axis() {
    let curve = |scale: f64| {
        let points = (0..500).map(|i| {
            let t = 0.02 * f64::from(i);
            (t, scale * t.sin())
        });
        points.collect::<Vec<_>>()
    };
    let mut chart = Chart::new(
        "Midspan",
        ChartAxis::linear("time", "s"),
        ChartAxis::linear("deflection", "m"),
        vec![
            Curve::new("computed", curve(1.0)).with_look(Look::Computed),
            Curve::new("reference", curve(1.0)).with_look(Look::Reference),
        ],
    );
    let height = |svg: &str| -> f64 {
        let (_, rest) = svg.split_once("height=\"").unwrap();
        rest.split('"').next().unwrap().parse().unwrap()
    };
    let one = chart.draw().to_svg();
    chart.panels.push(Panel {
        y: ChartAxis::linear("difference", "m"),
        curves: vec![Curve::new("", curve(3e-4)).with_look(Look::Difference)],
        height: 100.0,
    });
    let two = chart.draw().to_svg();
    assert!(two.contains(">difference [mm]<"));
    assert_eq!(two.matches(">time [s]<").count(), 1);
    assert!((100.0..130.0).contains(&(height(&two) - height(&one))));
}
