//! Draws a chart of made-up curves, to look at: `cargo run --example sample_figure -- DIR`.
// An example that fails may do so loudly.
#![allow(clippy::unwrap_used, clippy::expect_used)]

use std::path::PathBuf;

use catenix_report::figure::{Chart, ChartAxis, Curve};

fn main() {
    let directory = PathBuf::from(std::env::args().nth(1).expect("usage: sample_figure DIR"));
    let cases = [
        ("a: current along, 0.5 m/s", 22.5, 320.0),
        ("b: current across, 0.5 m/s", 36.0, 320.0),
        ("c: current against, 0.5 m/s", 51.0, 320.0),
        ("d: current along, 1.0 m/s", 61.9, 160.0),
        ("e: current across, 1.0 m/s", 78.5, 160.0),
        ("f: current against, 1.0 m/s", 96.2, 160.0),
    ];
    let chart = |title: &str, y: ChartAxis, scale: f64, sway: f64| {
        let curves = cases.iter().map(|(label, offset, end)| {
            let points = (0..=(end * 10.0) as usize).map(|i| {
                let t = i as f64 * 0.1;
                let rise = 1.0 - (-t / 40.0_f64).exp();
                let swing = sway * (std::f64::consts::TAU * t / 8.0).sin();
                (t, scale * (-offset * rise + swing))
            });
            Curve::new(label, points.collect())
        });
        Chart::new(title, ChartAxis::linear("Time", "s"), y, curves.collect()).with_note(
            "Input calibrated so that a rigid-segment chain reproduces the published figures: \
             agreement with the paper is a calibration, not a validation.",
        )
    };
    let offset = ChartAxis::linear("buffer, offset x", "m");
    let force = ChartAxis::linear("hose, end B, force x", "N");
    for (name, chart) in [
        (
            "offset",
            chart("Buffer x-offset from the ship", offset, 1.0, 1.0),
        ),
        (
            "force",
            chart("Force of the hose on the miner, X", force, 150.0, 9.0),
        ),
    ] {
        catenix_report::write_figure(&chart.draw(), name, &directory).unwrap();
    }
}
