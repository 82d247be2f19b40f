//! Lines that bodies and joints put together: trees, loops, moorings, hinges, floats.

mod common;

use std::f64::consts::PI;

use common::{G, WATER, assert_near, distance, model, run, statics};

const ROPE: &str = r#"
    [line_types.rope]
    kind = "general"
    outer_diameter = "0.04 m"
    mass = "6.5 kg/m"
    axial_stiffness = "40 MN"
    bending_stiffness = "300 N m^2"
    structural_damping = "0.02 s"
"#;
const HOSE: &str = r#"
    [line_types.hose]
    kind = "general"
    outer_diameter = "0.2 m"
    inner_diameter = "0.15 m"
    mass = "57.7 kg/m"
    axial_stiffness = "5 MN"
    bending_stiffness = "10 kN m^2"
    structural_damping = "0.02 s"
"#;
const HEAVE: &str = r#"
    [motions.heave]
    kind = "harmonic"
    degree = "heave"
    amplitude = "1 m"
    period = "10 s"
"#;

#[test]
fn a_buffer_with_two_hoses_stays_between_them() {
    let text = format!(
        r#"
        environment.water.depth = "500 m"
        environment.current = {{ heading = "90 deg", profile = [{{ depth = 0, speed = "1 kn" }}] }}
        [line_types.riser]
        kind = "pipe"
        outer_diameter = "219 mm"
        inner_diameter = "179 mm"
        content_density = "1100 kg/m^3"
        {HOSE}{HEAVE}
        [vessels.ship]
        position = ["0 m", "0 m", "0 m"]
        motions = ["heave"]
        [anchors.miner_1]
        position = ["-150 m", "0 m", "-498 m"]
        [anchors.miner_2]
        position = ["150 m", "0 m", "-498 m"]
        [bodies.buffer]
        mass = "20 t"
        wet_weight = "160 kN"
        length = "4 m"
        drag_area = "3 m^2"
        added_mass = "8 t"
        [lines.riser]
        sections = [{{ type = "riser", length = "420 m", elements = 42 }}]
        end_a = {{ to = "ship" }}
        end_b = {{ to = "buffer", joint = "fixed", at = [0, 0, "2 m"] }}
        [lines.hose_1]
        sections = [{{ type = "hose", length = "250 m", element_length = "2.5 m" }}]
        attachments.float = {{ at = "100 m", net_lift = "25 kN", mass = "1.3 t", drag_area = 1.5 }}
        end_a = {{ to = "buffer", joint = "fixed", at = ["-0.5 m", 0, "-2 m"] }}
        end_b = {{ to = "miner_1", joint = "universal" }}
        [lines.hose_2]
        sections = [{{ type = "hose", length = "250 m", element_length = "2.5 m" }}]
        attachments.float = {{ at = "100 m", net_lift = "25 kN", mass = "1.3 t", drag_area = 1.5 }}
        end_a = {{ to = "buffer", joint = "fixed", at = ["0.5 m", 0, "-2 m"] }}
        end_b = {{ to = "miner_2", joint = "universal" }}
        [dynamics]
        duration = "60 s"
        "#
    );
    let run = run(&model(&text));
    run.assert_sound(60.0, 1e-3);
    assert!(
        run.statics.get("buffer.offset_y") > 1.0,
        "it drifts with the current"
    );
    let (low, high) = run.range_since("buffer.offset_x", 0.0);
    // Mirror images up to the residuals: 1 N on a hanging stiffness of some 500 N/m.
    assert!(
        low.abs().max(high.abs()) < 2e-3,
        "offset x from {low} to {high}"
    );
    let (left, right) = (
        run.last("hose_1.end_b.effective_tension"),
        run.last("hose_2.end_b.effective_tension"),
    );
    assert_near("tensions", left, right, 1e-3 * right);
}

#[test]
fn a_bridle_of_three_lines_tows_straight() {
    let text = format!(
        r#"
        environment.water.depth = "200 m"
        {ROPE}
        [motions.tow]
        kind = "tow"
        speed = "2 kn"
        ramp = "30 s"
        [vessels.ship]
        position = ["0 m", "0 m", "0 m"]
        motions = ["tow"]
        [bodies.port]
        mass = "2 t"
        wet_weight = "16 kN"
        drag_area = "0.4 m^2"
        added_mass = "0.3 t"
        [bodies.starboard]
        mass = "2 t"
        wet_weight = "16 kN"
        drag_area = "0.4 m^2"
        added_mass = "0.3 t"
        [lines.leg_port]
        sections = [{{ type = "rope", length = "60 m", element_length = "3 m" }}]
        end_a = {{ to = "ship", at = ["-20 m", "6 m", "-2 m"] }}
        end_b = {{ to = "port", at = [0, 0, "0.5 m"] }}
        [lines.leg_starboard]
        sections = [{{ type = "rope", length = "60 m", element_length = "3 m" }}]
        end_a = {{ to = "ship", at = ["-20 m", "-6 m", "-2 m"] }}
        end_b = {{ to = "starboard", at = [0, 0, "0.5 m"] }}
        [lines.spreader]
        sections = [{{ type = "rope", length = "15 m", element_length = "1.5 m" }}]
        end_a = {{ to = "port", at = [0, 0, "0.5 m"], direction = [0, -1, 0] }}
        end_b = {{ to = "starboard", at = [0, 0, "0.5 m"], direction = [0, -1, 0] }}
        [dynamics]
        duration = "200 s"
        "#
    );
    let run = run(&model(&text));
    run.assert_sound(200.0, 1e-3);
    let (port, starboard) = (run.last("port.y"), run.last("starboard.y"));
    assert_near("mirror images", port, -starboard, 1e-3);
    assert_near("abreast", run.last("port.x"), run.last("starboard.x"), 1e-3);
    assert!(
        run.last("port.offset_x") < -20.5,
        "they trail behind the stern"
    );
    // Each leg carries its depressor, itself and half the spreader, the weight of them in water.
    let wet = (6.5 - WATER * 0.25 * PI * 0.0016) * G;
    let expected = -(16e3 + 67.5 * wet);
    let force = run.mean_since("leg_port.end_a.force_z", 150.0);
    // Towing lifts the leg by its inclined drag.
    assert_near("leg", force, expected, 0.02 * expected.abs());
}

#[test]
fn three_buoys_in_a_ring_of_three_lines() {
    let radius = 20.0;
    let mut text = format!(
        r#"
        environment.water.depth = "100 m"
        environment.current = {{ profile = [{{ depth = 0, speed = "0.3 m/s" }}], factor = [{{ time = 0, factor = 0 }}, {{ time = 10, factor = 0 }}, {{ time = 20, factor = 1 }}] }}
        {ROPE}
        [dynamics]
        duration = "60 s"
        "#
    );
    for k in 0..3 {
        let (sin, cos) = (2.0 * PI * k as f64 / 3.0).sin_cos();
        let (ax, ay) = (60.0 * cos, 60.0 * sin);
        let next = (k + 1) % 3;
        text += &format!(
            r#"
            [anchors.anchor_{k}]
            position = [{ax}, {ay}, -90]
            [bodies.buoy_{k}]
            mass = "1 t"
            net_lift = "20 kN"
            drag_area = "1 m^2"
            initial_position = [{bx}, {by}, -40]
            [lines.leg_{k}]
            sections = [{{ type = "rope", length = "64 m", elements = 16 }}]
            end_a = {{ to = "anchor_{k}" }}
            end_b = {{ to = "buoy_{k}" }}
            [lines.side_{k}]
            sections = [{{ type = "rope", length = "34 m", elements = 17 }}]
            end_a = {{ to = "buoy_{k}" }}
            end_b = {{ to = "buoy_{next}" }}
            "#,
            bx = radius * cos,
            by = radius * sin,
        );
    }
    let run = run(&model(&text));
    run.assert_sound(60.0, 1e-3);
    let tension = |k: usize| {
        run.statics
            .get(&format!("side_{k}.end_a.effective_tension"))
    };
    let buoy = |k: usize| run.statics.vector(&format!("buoy_{k}."));
    for k in 1..3 {
        // Three times the same, up to the residuals.
        assert_near("side", tension(k), tension(0), 1e-4 * tension(0));
        assert_near("height", buoy(k)[2], buoy(0)[2], 1e-4);
    }
    // The vertical forces on the anchors are the whole lift.
    let wet = (6.5 - WATER * 0.25 * PI * 0.0016) * G;
    let lift: f64 = (0..3)
        .map(|k| run.statics.get(&format!("leg_{k}.end_a.force_z")))
        .sum();
    let expected = 3.0 * (20e3 - 98.0 * wet);
    assert_near("lift", lift, expected, 1e-4 * expected);
    // With the current the ring stays mirrored about the x axis.
    assert_near("on the axis", run.last("buoy_0.y"), 0.0, 1e-3);
    assert_near(
        "mirrored",
        run.last("buoy_1.y"),
        -run.last("buoy_2.y"),
        1e-3,
    );
    assert!(
        run.last("buoy_0.x") > buoy(0)[0] + 0.1,
        "the current takes it along"
    );
}

#[test]
fn a_line_with_both_ends_on_one_body() {
    let text = format!(
        r#"
        environment.water.depth = "300 m"
        {ROPE}{HEAVE}
        [vessels.ship]
        position = ["0 m", "0 m", "0 m"]
        motions = ["heave"]
        [bodies.frame]
        mass = "5 t"
        wet_weight = "40 kN"
        drag_area = "4 m^2"
        added_mass = "2 t"
        [lines.hanger]
        sections = [{{ type = "rope", length = "100 m", elements = 20 }}]
        end_a = {{ to = "ship" }}
        end_b = {{ to = "frame", at = [0, 0, "1 m"] }}
        [lines.jumper]
        sections = [{{ type = "rope", length = "12 m", elements = 24 }}]
        end_a = {{ to = "frame", at = ["-2 m", 0, 0] }}
        end_b = {{ to = "frame", at = ["2 m", 0, 0] }}
        [dynamics]
        duration = "60 s"
        "#
    );
    let run = run(&model(&text));
    run.assert_sound(60.0, 1e-3);
    let wet = (6.5 - WATER * 0.25 * PI * 0.0016) * G;
    for end in ["jumper.end_a.force_z", "jumper.end_b.force_z"] {
        assert_near(end, run.statics.get(end), -6.0 * wet, 0.05);
    }
    let top = run.statics.get("hanger.end_a.force_z");
    assert_near("all of it", top, -40e3 - 112.0 * wet, 0.5);
    // Nothing pulls sideways and nothing tilts the frame.
    let (low, high) = run.range_since("frame.tilt", 0.0);
    assert!(low >= 0.0 && high < 0.01, "tilt from {low} to {high} deg");
    let apart = distance(
        run.statics.fields[1].position(0),
        run.statics.fields[1].position(24),
    );
    assert_near("ends of the jumper", apart, 4.0, 1e-4);
}

#[test]
fn a_hinge_holds_two_rotations_and_frees_one() {
    let text = |axis: &str| {
        format!(
            r#"
            [environment]
            water.depth = "200 m"
            current.profile = [{{ depth = 0, speed = "1 m/s" }}]
            [line_types.pipe]
            kind = "pipe"
            outer_diameter = "0.2 m"
            inner_diameter = "0.16 m"
            content_density = "1025 kg/m^3"
            {HEAVE}
            [vessels.ship]
            position = ["0 m", "0 m", "0 m"]
            motions = ["heave"]
            [lines.pipe]
            sections = [{{ type = "pipe", length = "40 m", elements = 40 }}]
            end_a = {{ to = "ship", joint = "hinge", axis = {axis} }}
            [dynamics]
            duration = "30 s"
            "#
        )
    };
    // Hinged about y it swings freely with the current along x: no moment about y.
    let free = run(&model(&text("[0, 1, 0]")));
    free.assert_sound(30.0, 1e-3);
    assert_near("free", free.statics.get("pipe.end_a.moment_y"), 0.0, 1.0);
    // Hinged about x the same current bends it at the joint, as it bends a clamped pipe.
    let held = run(&model(&text("[1, 0, 0]")));
    held.assert_sound(30.0, 1e-3);
    let clamped = model(
        &text("[1, 0, 0]").replace("joint = \"hinge\", axis = [1, 0, 0]", "joint = \"fixed\""),
    );
    let moment = statics(&clamped).get("pipe.end_a.moment_y");
    assert!(moment.abs() > 1e4, "the clamp carries {moment} N m");
    // The hinge's half element is a plain half spring: second order, (1 m)^2 / 24 lambda^2 with
    // lambda^2 = EI / T of some 100 m2, and more of it at the end.
    assert_near(
        "held",
        held.statics.get("pipe.end_a.moment_y"),
        moment,
        5e-3 * moment.abs(),
    );
}

#[test]
fn a_float_held_by_three_moorings() {
    let mut text = format!(
        r#"
        environment.water.depth = "100 m"
        environment.current = {{ heading = "20 deg", profile = [{{ depth = 0, speed = "0.5 m/s" }}], factor = [{{ time = 0, factor = 1 }}, {{ time = 20, factor = 2 }}] }}
        {ROPE}
        [bodies.float]
        mass = "10 t"
        net_lift = "100 kN"
        drag_area = "10 m^2"
        added_mass = "8 t"
        [dynamics]
        duration = "60 s"
        "#
    );
    for k in 0..3 {
        let (sin, cos) = (2.0 * PI * k as f64 / 3.0).sin_cos();
        text += &format!(
            r#"
            [anchors.anchor_{k}]
            position = [{x}, {y}, -100]
            [lines.leg_{k}]
            sections = [{{ type = "rope", length = "100 m", elements = 20 }}]
            end_a = {{ to = "float", at = [{a}, {b}, -1] }}
            end_b = {{ to = "anchor_{k}" }}
            "#,
            x = 60.0 * cos,
            y = 60.0 * sin,
            a = cos,
            b = sin,
        );
    }
    let run = run(&model(&text));
    run.assert_sound(60.0, 1e-3);
    let pull = |axis: &str| -> f64 {
        let legs = (0..3).map(|k| run.statics.get(&format!("leg_{k}.end_a.force_{axis}")));
        legs.sum()
    };
    // Tilted by half a degree, the drag lifts or presses it a little: 1281 N times the angle.
    assert_near("lift", pull("z"), -100e3, 20.0);
    // 1/2 rho CdA u^2 along the current.
    let drag = 0.5 * WATER * 10.0 * 0.25;
    assert_near("drag x", pull("x"), -drag * 20f64.to_radians().cos(), 1.0);
    assert_near("drag y", pull("y"), -drag * 20f64.to_radians().sin(), 1.0);
    // Held taut, it hardly moves when the current doubles.
    let (low, high) = run.range_since("float.x", 0.0);
    assert!(
        high - low > 1e-3 && high - low < 0.5,
        "it moves by {}",
        high - low
    );
}

#[test]
fn a_body_on_ball_joints_may_spin_freely() {
    let text = format!(
        r#"
        environment.water.depth = "200 m"
        environment.current.profile = [{{ depth = 0, speed = "0.5 m/s" }}]
        {ROPE}{HEAVE}
        [vessels.crane]
        position = ["0 m", "0 m", "5 m"]
        motions = ["heave"]
        [bodies.load]
        mass = "3 t"
        wet_weight = "20 kN"
        drag_area = "2 m^2"
        added_mass = "1 t"
        [lines.wire]
        sections = [{{ type = "rope", length = "80 m", elements = 20 }}]
        end_a = {{ to = "crane" }}
        end_b = {{ to = "load" }}
        [dynamics]
        duration = "60 s"
        "#
    );
    let run = run(&model(&text));
    run.assert_sound(60.0, 1e-3);
    // The wire meets the load's centre: nothing turns the load, in whichever way it may spin.
    let (_, tilt) = run.range_since("load.tilt", 0.0);
    assert!(tilt < 1e-3, "tilt {tilt} deg");
    // Its drag pulls the wire aside.
    let drag = 0.5 * WATER * 2.0 * 0.25;
    assert_near("drag", run.statics.get("wire.end_b.force_x"), -drag, 0.5);
    assert_near("weight", run.statics.get("wire.end_b.force_z"), 20e3, 0.5);
}

#[test]
fn a_buoy_at_the_surface_carries_its_line() {
    let text = format!(
        r#"
        [environment]
        water.depth = "50 m"
        seabed = {{}}
        current.profile = [{{ depth = 0, speed = "0.3 m/s" }}]
        current.factor = [{{ time = 0, factor = 1 }}, {{ time = 20, factor = 2 }}]
        {ROPE}
        [anchors.anchor]
        position = ["0 m", "0 m", "-50 m"]
        [bodies.buoy]
        mass = "500 kg"
        volume = "2 m^3"
        length = "2 m"
        drag_area = "2 m^2"
        added_mass = "500 kg"
        initial_position = [0, 0, 0]
        [lines.pendant]
        sections = [{{ type = "rope", length = "60 m", elements = 30 }}]
        end_a = {{ to = "anchor" }}
        end_b = {{ to = "buoy", at = [0, 0, "-1 m"] }}
        [dynamics]
        duration = "60 s"
        "#
    );
    let run = run(&model(&text));
    run.assert_sound(60.0, 1e-3);
    // Partly under water it carries itself and the line that is off the ground.
    let pull = run.statics.get("pendant.end_b.force_z");
    let sunk = (500.0 * G - pull) / (WATER * G * 2.0);
    assert!(sunk > 0.2 && sunk < 0.6, "sunk by {sunk}");
    // Upright, it sinks in over its length and its diameter: share = 1/2 - z / (2 m + diameter).
    let diameter = (4.0f64 / PI).sqrt();
    let z = run.statics.get("buoy.z");
    assert_near("draught", z, (0.5 - sunk) * (2.0 + diameter), 1e-3);
    let moved = run.last("buoy.x") - run.statics.get("buoy.x");
    assert!(moved > 0.1, "the stronger current moves it by {moved} m");
}
