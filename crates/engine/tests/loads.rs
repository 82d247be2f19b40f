//! Point loads, and ends that slide, against closed forms.

mod common;

use std::f64::consts::PI;

use common::{assert_near, model, run, statics};

/// What round-off leaves in the forces of the test beam [N].
const FORCE_NOISE: f64 = 1e-6;

/// A weightless beam of 2 m along x from the origin, EI = 2000, EA = 4e6: stiffer, and the round-off
/// of positions would show in forces of a newton. As it is, 2e-16 m in a spring of 1.2e9 N/m leave
/// 1e-7 N, which add up to FORCE_NOISE along the beam, and to moments alike.
fn beam(elements: usize, ends: &str, rest: &str) -> String {
    format!(
        r#"
        environment.gravity = 0
        [line_types.beam]
        kind = "general"
        outer_diameter = "0.02 m"
        mass = "3 kg/m"
        axial_stiffness = "4 MN"
        bending_stiffness = "2 kN m^2"
        [anchors.left]
        position = [0, 0, 0]
        [anchors.right]
        position = ["2 m", 0, 0]
        [lines.beam]
        sections = [{{ type = "beam", length = "2 m", elements = {elements} }}]
        start_shape = [[0, 0, 0], ["2 m", 0, 0]]
        {ends}
        {rest}
        [statics]
        tolerance = 1e-12
        [output]
        channels = ["beam.x@2m", "beam.y@2m", "beam.z@2m", "beam.z@1m", "beam.bend_moment@1m"]
        "#
    )
}

const CLAMPED_LEFT: &str = r#"end_a = { to = "left", joint = "fixed", direction = [1, 0, 0] }"#;

#[test]
fn loads_within_an_element_at_a_node_and_at_the_end() {
    // Small loads: deflections of linear theory, off by (w / L)^2, 1e-8 here. What counts is the
    // kink of the curvature under the load, which the chain sees to second order: 0.4 / N^2.
    for (at, elements) in [(2.0, 20), (1.0, 20), (1.03, 20), (1.03, 21)] {
        let rest = format!(
            "[loads]\npush = {{ on = \"beam\", at = {at:?}, force = [0, \"0.3 N\", \"-0.4 N\"] }}"
        );
        let found = statics(&model(&beam(elements, CLAMPED_LEFT, &rest)));
        let w = 0.5 * at * at / (6.0 * 2000.0) * (3.0 * 2.0 - at);
        assert_near("z", found.get("beam.z@2m"), -0.8 * w, 2e-3 * w);
        assert_near("y", found.get("beam.y@2m"), 0.6 * w, 2e-3 * w);
        assert_near("wall", found.get("beam.end_a.force_z"), -0.4, FORCE_NOISE);
        assert_near(
            "wall",
            found.get("beam.end_a.moment_y"),
            0.4 * at,
            FORCE_NOISE,
        );
        assert_near(
            "wall",
            found.get("beam.end_a.moment_z"),
            0.3 * at,
            FORCE_NOISE,
        );
    }
}

#[test]
fn a_moment_bends_the_beam_into_a_circle() {
    // Half a circle: M = EI pi / L. A chain bends every connector alike, so its tip lies on a
    // polygon: off by 1 / N^2, and 8e-4 here.
    let moment = -2000.0 * PI / 2.0;
    for follows in [false, true] {
        let rest = format!(
            "[loads]\nbend = {{ on = \"beam\", at = 2, moment = [0, {moment:?}, 0], follows = {follows} }}"
        );
        let found = statics(&model(&beam(40, CLAMPED_LEFT, &rest)));
        assert_near("x", found.get("beam.x@2m"), 0.0, 2e-3);
        assert_near("z", found.get("beam.z@2m"), 4.0 / PI, 2e-3);
        assert_near("moment", found.get("beam.bend_moment@1m"), -moment, 1e-6);
    }
}

#[test]
fn a_follower_force_turns_with_the_end() {
    // The work of a follower depends on the way; the equilibrium does not. By shooting from the
    // tip, where the load is known in the tip's axes: theta'' = -(F / EI) sin(theta_tip-relative).
    let force = 4000.0;
    let rest = format!(
        "[loads]\npush = {{ on = \"beam\", at = 2, force = [0, 0, {force:?}], follows = true }}"
    );
    let found = statics(&model(&beam(40, CLAMPED_LEFT, &rest)));
    // From the tip inwards, in the tip's axes: the load F across, M(s) = F x(s).
    let (mut angle, mut x, mut z, n) = (0.0f64, 0.0, 0.0, 20_000);
    let h = 2.0 / n as f64;
    for _ in 0..n {
        // Midpoint rule.
        let half = angle + 0.5 * h * force * x / 2000.0;
        let middle = x + 0.5 * h * angle.cos();
        x += h * half.cos();
        z += h * half.sin();
        angle += h * force * middle / 2000.0;
    }
    // Turned so that the wall is level: the tip as seen from the wall.
    let (sin, cos) = angle.sin_cos();
    let tip = [x * cos + z * sin, x * sin - z * cos];
    // The polygon of 40 elements, second order: 1e-3 of the length.
    assert_near("x", found.get("beam.x@2m"), tip[0], 3e-3);
    assert_near("z", found.get("beam.z@2m"), tip[1], 3e-3);
}

#[test]
fn a_beam_on_a_roller_shortens_its_span() {
    let ends = r#"
        end_a = { to = "left", joint = "hinge", direction = [1, 0, 0] }
        end_b = { to = "right", joint = "hinge", direction = [1, 0, 0], slides_along = [1, 0, 0] }
    "#;
    let push = |force: f64| {
        let rest =
            format!("[loads]\npush = {{ on = \"beam\", at = 1, force = [0, 0, {force:?}] }}");
        statics(&model(&beam(20, ends, &rest)))
    };
    let small = push(-1.0);
    let w = 1.0 * 8.0 / (48.0 * 2000.0);
    // Between pins nothing needs correction: what is left is the kink of the curvature under the
    // load, 1 / N^2, and the place of a node on its polygon, 1 / N^2 too.
    assert_near("middle", small.get("beam.z@1m"), -w, 6e-3 * w);
    assert_near("roller", small.get("beam.end_b.force_z"), -0.5, FORCE_NOISE);
    for end in ["end_a", "end_b"] {
        // Nothing holds the beam lengthwise.
        assert_near(
            end,
            small.get(&format!("beam.{end}.force_x")),
            0.0,
            FORCE_NOISE,
        );
    }
    // The roller moves by as much as the bent line is shorter than straight: its length stays.
    let large = push(-2000.0);
    let fields = &large.fields[0];
    assert_near("length", fields.polygon_length(), 2.0, 2e-4);
    let span = large.get("beam.x@2m");
    assert!(span < 1.975, "the roller has moved in to {span} m");
    assert_near("height", large.get("beam.z@2m"), 0.0, FORCE_NOISE);
    // The shape is symmetric, though one end slides and the other does not.
    let (x, z) = (fields.position(5), fields.position(15));
    assert_near("symmetry", x[2], z[2], FORCE_NOISE);
    assert_near("symmetry", x[0] + z[0], span, FORCE_NOISE);
}

#[test]
fn a_guide_holds_what_it_does_not_let_slide() {
    // Clamped at one end, and at the other in a guide that keeps its direction and slides across
    // the beam: w = F L^3 / 12 EI at the guide, moments F L / 2.
    let ends = r#"
        end_a = { to = "left", joint = "fixed", direction = [1, 0, 0] }
        end_b = { to = "right", joint = "fixed", direction = [1, 0, 0], slides_along = [0, 0, 1] }
    "#;
    let rest = "[loads]\npush = { on = \"beam\", at = 2, force = [0, 0, -1] }";
    let found = statics(&model(&beam(20, ends, rest)));
    let w = 8.0 / (12.0 * 2000.0);
    // The load acts on the last element and not in the guide, so the guide's correction does not
    // see it: second order, 0.8 / N^2.
    assert_near("guide", found.get("beam.z@2m"), -w, 3e-3 * w);
    assert_near("force", found.get("beam.end_b.force_z"), 0.0, FORCE_NOISE);
    assert_near("wall", found.get("beam.end_a.force_z"), -1.0, FORCE_NOISE);
    assert_near("wall", found.get("beam.end_a.moment_y"), 1.0, 2e-3);
    assert_near("guide", found.get("beam.end_b.moment_y").abs(), 1.0, 2e-3);
}

#[test]
fn a_harmonic_load_swings_a_beam_as_the_modal_series_says() {
    // Pinned and sliding, F sin(W t) at the middle, from rest: the sum over the odd modes.
    let ends = r#"
        end_a = { to = "left", joint = "hinge", direction = [1, 0, 0] }
        end_b = { to = "right", joint = "hinge", direction = [1, 0, 0], slides_along = [1, 0, 0] }
    "#;
    let rest = r#"
        [loads]
        shake = { on = "beam", at = 1, force = [0, 0, 1], harmonic = { angular_frequency = 20 } }
        [dynamics]
        duration = "2 s"
        step = "0.0005 s"
        spectral_radius = 1
        tolerance = 1e-9
    "#;
    let run = run(&model(&beam(20, ends, rest)));
    let series = |time: f64| {
        (0..8)
            .map(|k| 2.0 * k as f64 + 1.0)
            .map(|n| {
                let own = (n * PI / 2.0).powi(2) * (2000.0f64 / 3.0).sqrt();
                let load = 20.0f64;
                2.0 / (3.0 * 2.0) * ((load * time).sin() - load / own * (own * time).sin())
                    / (own * own - load * load)
            })
            .sum::<f64>()
    };
    let largest = 4e-4;
    for (time, z) in run.time.iter().zip(run.history("beam.z@1m")) {
        assert_near("middle", *z, series(*time), 1e-2 * largest);
    }
    assert!(
        run.report.energy.imbalance.abs() < 1e-5,
        "{:?}",
        run.report.energy
    );
}

#[test]
fn a_load_on_a_body_turns_it_by_its_arm() {
    // A buoyant body on a short vertical line: a sideways force at its top tilts it.
    let text = r#"
        environment.gravity = 0
        [line_types.rod]
        kind = "general"
        outer_diameter = "0.05 m"
        mass = "5 kg/m"
        axial_stiffness = "100 MN"
        bending_stiffness = "10 kN m^2"
        [anchors.foot]
        position = [0, 0, 0]
        [bodies.head]
        mass = "10 kg"
        initial_position = [0, 0, "3 m"]
        [lines.rod]
        sections = [{ type = "rod", length = "3 m", elements = 30 }]
        end_a = { to = "foot", joint = "fixed", direction = [0, 0, 1] }
        end_b = { to = "head", joint = "fixed", direction = [0, 0, 1] }
        [loads.side]
        on = "head"
        point = [0, 0, "0.5 m"]
        force = ["1 N", 0, 0]
    "#;
    let found = statics(&model(text));
    let (l, ei) = (3.0f64, 10e3);
    let deflection = l.powi(3) / (3.0 * ei) + 0.5 * l * l / (2.0 * ei);
    let slope = l * l / (2.0 * ei) + 0.5 * l / ei;
    // Two clamps, third order in the element.
    assert_near("head", found.get("head.x"), deflection, 1e-4 * deflection);
    assert_near(
        "tilt",
        found.get("head.tilt").to_radians(),
        slope,
        1e-4 * slope,
    );
}
