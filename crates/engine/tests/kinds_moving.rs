//! Systems that a motion or a change of the current takes from one state to another.

mod common;

use std::f64::consts::PI;

use catenix_model::{LineQuantity, StepControl};
use common::{assert_near, model, run, statics};

const PIPE: &str = r#"
    [line_types.pipe]
    kind = "pipe"
    outer_diameter = "0.3 m"
    inner_diameter = "0.26 m"
    content_density = "1025 kg/m^3"
"#;

#[test]
fn a_tow_that_reverses_comes_back() {
    let text = format!(
        r#"
        environment.water.depth = "500 m"
        {PIPE}
        [motions.track]
        kind = "tow"
        legs = [
            {{ start = "0 s", ramp = "20 s", speed = "0.8 m/s" }},
            {{ start = "240 s", ramp = "40 s", speed = "-0.8 m/s" }},
            {{ start = "500 s", ramp = "20 s", speed = "0 m/s" }},
        ]
        [vessels.ship]
        position = ["0 m", "0 m", "0 m"]
        motions = ["track"]
        [lines.pipe]
        sections = [{{ type = "pipe", length = "200 m", elements = 40 }}]
        end_a = {{ to = "ship" }}
        [dynamics]
        duration = "900 s"
        [output]
        channels = ["pipe.x@200m", "pipe.y@200m"]
        "#
    );
    let run = run(&model(&text));
    run.assert_sound(900.0, 1e-3);
    let offset = |from: f64, to: f64| {
        let picked = run
            .time
            .iter()
            .enumerate()
            .filter(|(_, t)| (from..to).contains(*t));
        let (x, ship) = (run.history("pipe.x@200m"), run.history("ship.x"));
        let offsets: Vec<f64> = picked.map(|(k, _)| x[k] - ship[k]).collect();
        offsets.iter().sum::<f64>() / offsets.len() as f64
    };
    let (out, back) = (offset(200.0, 240.0), offset(460.0, 500.0));
    assert!(out < -5.0, "towed forward it trails behind: {out}");
    // What is left of the swing after 180 s of towing.
    assert_near(
        "trails as far on the way back",
        back,
        -out,
        0.03 * out.abs(),
    );
    assert_near("the ship is back", run.last("ship.x"), 0.0, 1e-9);
    // Drag of a slow swing dies out with its square: after 380 s some per cent are left.
    assert_near(
        "the pipe is back",
        run.last("pipe.x@200m"),
        0.0,
        0.05 * out.abs(),
    );
    let sideways = run.range_since("pipe.y@200m", 0.0);
    assert!(
        sideways.0.abs().max(sideways.1.abs()) < 1e-9,
        "{sideways:?}"
    );
}

#[test]
fn a_step_of_the_current_leads_to_the_equilibrium_of_the_new_current() {
    let text = |speed: f64, factor: &str| {
        format!(
            r#"
            [environment]
            water.depth = "400 m"
            current.profile = [{{ depth = "0 m", speed = {speed} }}, {{ depth = "400 m", speed = 0.2 }}]
            current.factor = {factor}
            {PIPE}
            [anchors.platform]
            position = ["0 m", "0 m", "-10 m"]
            [lines.pipe]
            sections = [{{ type = "pipe", length = "200 m", elements = 40 }}]
            end_a = {{ to = "platform" }}
            [dynamics]
            duration = "400 s"
            [output]
            channels = ["pipe.x@200m"]
            "#
        )
    };
    let step = |to: f64| {
        format!(
            "[{{ time = 0, factor = 1 }}, {{ time = 60, factor = 1 }}, {{ time = 60, factor = {to} }}]"
        )
    };
    for to in [2.0, -1.0] {
        let run = run(&model(&text(0.6, &step(to))));
        run.assert_sound(400.0, 1e-3);
        let start = run.statics.get("pipe.x@200m");
        let before = run.history("pipe.x@200m")[590];
        assert_near("at rest until the step", before, start, 1e-3 * start);
        let constant = format!("[{{ time = 0, factor = {to} }}]");
        let expected = statics(&model(&text(0.6, &constant))).get("pipe.x@200m");
        // The current itself damps: 340 s leave less than a thousandth of the move.
        let tolerance = 2e-3 * (expected - start).abs();
        assert_near("at the end", run.last("pipe.x@200m"), expected, tolerance);
    }
}

#[test]
fn a_pipe_on_a_rolling_ship_keeps_its_flex_joint_moment() {
    let text = format!(
        r#"
        environment.water.depth = "300 m"
        {PIPE}
        [motions.pitch]
        kind = "harmonic"
        degree = "pitch"
        amplitude = "5 deg"
        period = "200 s"
        ramp = "200 s"
        [vessels.ship]
        position = ["0 m", "0 m", "0 m"]
        motions = ["pitch"]
        [lines.pipe]
        sections = [{{ type = "pipe", length = "200 m", elements = 80 }}]
        end_a = {{ to = "ship", joint = "ball", rotational_stiffness = "100 N m/deg" }}
        [dynamics]
        duration = "450 s"
        "#
    );
    let run = run(&model(&text));
    run.assert_sound(450.0, 1e-3);
    let (low, high) = run.range_since("pipe.end_a.moment_y", 250.0);
    // So soft a joint takes all of the angle: stiffness times 5 degrees on either side, less what
    // the pipe follows (k / sqrt(EI T) of the angle, about 0.1 %) and its slow swing.
    for moment in [-low, high] {
        assert_near("flex joint", moment, 500.0, 15.0);
    }
}

#[test]
fn a_line_of_one_element_swings_like_a_rod() {
    let text = r#"
        environment.water = { density = 1e-6, depth = "50 m" }
        [line_types.rod]
        kind = "general"
        outer_diameter = "0.1 m"
        mass = "20 kg/m"
        axial_stiffness = "1 GN"
        bending_stiffness = "1 MN m^2"
        normal_drag = 0
        axial_drag = 0
        [motions.push]
        kind = "tow"
        legs = [
            { start = "0 s", ramp = "2 s", speed = "0.1 m/s" },
            { start = "2 s", ramp = "2 s", speed = "0 m/s" },
        ]
        [vessels.hook]
        position = ["0 m", "0 m", "-2 m"]
        motions = ["push"]
        [lines.rod]
        sections = [{ type = "rod", length = "6 m", elements = 1 }]
        end_a = { to = "hook" }
        [dynamics]
        duration = "60 s"
        [output]
        interval = "0.01 s"
        channels = ["rod.x@6m"]
    "#;
    let mut model = model(text);
    let run = run(&model);
    run.assert_sound(60.0, 1e-3);
    // T = 2 pi sqrt(2 l / 3 g), with a small amplitude.
    let period = 2.0 * PI * (12.0f64 / (3.0 * common::G)).sqrt();
    let found = mean_period(&run, "rod.x@6m", 5.0);
    // The default step, at most 0.5 s, chosen by its error, lengthens the period of 4 s.
    assert_near("period", found, period, 2e-2 * period);
    if let Some(dynamics) = &mut model.dynamics {
        dynamics.step = StepControl::Fixed(0.01);
    }
    let fine = common::run(&model);
    let found = mean_period(&fine, "rod.x@6m", 5.0);
    // (omega h)^2 / 12 and some: 4e-5, and 1e-4 of crossings read off a polygon.
    assert_near("period", found, period, 2e-4 * period);
}

/// Mean period from the upward crossings of a channel through its last mean.
fn mean_period(run: &common::Run, channel: &str, from: f64) -> f64 {
    let values = run.since(channel, from);
    let time = &run.time[run.time.len() - values.len()..];
    let (low, high) = common::range(values);
    let middle = 0.5 * (low + high);
    let crossings: Vec<f64> = (1..values.len())
        .filter(|&k| values[k - 1] < middle && values[k] >= middle)
        .map(|k| {
            let share = (middle - values[k - 1]) / (values[k] - values[k - 1]);
            time[k - 1] + share * (time[k] - time[k - 1])
        })
        .collect();
    (crossings[crossings.len() - 1] - crossings[0]) / (crossings.len() - 1) as f64
}

#[test]
fn a_heavy_end_swings_out_of_plane_without_twisting_the_ship() {
    // A circular tow: sway and surge a quarter apart; the end follows on a circle.
    let text = format!(
        r#"
        environment.water.depth = "300 m"
        {PIPE}
        [motions.surge]
        kind = "harmonic"
        degree = "surge"
        amplitude = "2 m"
        period = "100 s"
        phase = "90 deg"
        ramp = "100 s"
        [motions.sway]
        kind = "harmonic"
        degree = "sway"
        amplitude = "2 m"
        period = "100 s"
        ramp = "100 s"
        [vessels.ship]
        position = ["0 m", "0 m", "0 m"]
        motions = ["surge", "sway"]
        [lines.pipe]
        sections = [{{ type = "pipe", length = "200 m", elements = 20 }}]
        end_a = {{ to = "ship" }}
        [dynamics]
        duration = "500 s"
        [output]
        channels = ["pipe.x@200m", "pipe.y@200m"]
        "#
    );
    let run = run(&model(&text));
    run.assert_sound(500.0, 1e-3);
    let (x, y) = (
        run.since("pipe.x@200m", 400.0),
        run.since("pipe.y@200m", 400.0),
    );
    let radius: Vec<f64> = x.iter().zip(y).map(|(x, y)| x.hypot(*y)).collect();
    let (low, high) = common::range(&radius);
    // A circle: what the ramp left has died out to some per cent.
    assert!(low > 1.8 && high - low < 0.05 * high, "{low} to {high}");
    let torque = run.fields[0].get(LineQuantity::Torque);
    assert!(torque.iter().all(|t| t.abs() < 1e-3), "{torque:?}");
}
