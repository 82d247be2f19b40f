//! Kinds that need a search for equilibrium that knows its rounding errors and where floats float.

mod common;

use std::f64::consts::PI;
use std::ops::ControlFlow;

use catenix_engine::{StaticsError, System, solve_statics};
use catenix_model::ChannelTarget;

use common::{G, WATER, assert_near, model, run, statics};

#[test]
fn a_stiff_jumper_in_deep_water_is_a_beam() {
    for depth in [50.0, 3000.0] {
        for elements in [30, 60, 120] {
            let text = format!(
                r#"
                environment.water.depth = "4000 m"
                [line_types.pipe]
                kind = "pipe"
                outer_diameter = "0.3 m"
                inner_diameter = "0.26 m"
                content_density = "1025 kg/m^3"
                [anchors.left]
                position = [0, 0, {z:?}]
                [anchors.right]
                position = [20, 0, {z:?}]
                [lines.jumper]
                sections = [{{ type = "pipe", length = "20 m", elements = {elements} }}]
                end_a = {{ to = "left", joint = "fixed", direction = [1, 0, 0] }}
                end_b = {{ to = "right", joint = "fixed", direction = [1, 0, 0] }}
                [dynamics]
                duration = "2 s"
                "#,
                z = -depth,
            );
            let run = run(&model(&text));
            let load = (7850.0 - WATER) * 0.25 * PI * (0.09 - 0.0676) * G;
            let expected = load * 400.0 / 12.0;
            let moment = run.statics.get("jumper.end_a.moment_y").abs();
            // Sagging by 4 mm it stretches a little and carries 0.1 % as a cable.
            assert_near("moment", moment, expected, 5e-3 * expected);
        }
    }
}

#[test]
fn a_buoy_finds_the_surface_by_itself() {
    let text = r#"
        [environment]
        water.depth = "50 m"
        seabed = {}
        current.profile = [{ depth = 0, speed = "0.3 m/s" }]
        [line_types.rope]
        kind = "general"
        outer_diameter = "0.04 m"
        mass = "6.5 kg/m"
        axial_stiffness = "40 MN"
        bending_stiffness = "300 N m^2"
        structural_damping = "0.02 s"
        [anchors.anchor]
        position = [0, 0, -50]
        [bodies.buoy]
        mass = "500 kg"
        volume = "2 m^3"
        length = "2 m"
        drag_area = "2 m^2"
        added_mass = "500 kg"
        [lines.pendant]
        sections = [{ type = "rope", length = "60 m", elements = 30 }]
        end_a = { to = "anchor" }
        end_b = { to = "buoy", at = [0, 0, -1] }
        [dynamics]
        duration = "10 s"
    "#;
    let run = run(&model(text));
    let z = run.statics.get("buoy.z");
    assert!((-0.6..0.6).contains(&z), "it floats at {z} m");
    let share = 0.5 - z / (2.0 + (4.0f64 / PI).sqrt());
    let pull = run.statics.get("pendant.end_b.force_z");
    assert!(pull < 0.0, "the line hangs from the buoy: {pull} N");
    assert_near("float", WATER * G * 2.0 * share, 500.0 * G - pull, 1.0);
}

#[test]
fn a_hinge_about_the_vertical_leaves_a_motion_free() {
    let boom = |axis: &str| {
        format!(
            r#"
            environment.water.depth = "100 m"
            [line_types.boom]
            kind = "pipe"
            outer_diameter = "0.3 m"
            inner_diameter = "0.28 m"
            content_density = "1025 kg/m^3"
            [vessels.ship]
            position = [0, 0, -5]
            [lines.boom]
            sections = [{{ type = "boom", length = "10 m", elements = 10 }}]
            end_a = {{ to = "ship", joint = "hinge", direction = [1, 0, 0], axis = {axis} }}
            "#
        )
    };
    let free = System::new(&model(&boom("[0, 0, 1]"))).unwrap();
    let refused = solve_statics(&free, &mut |_| ControlFlow::Continue(())).err();
    let error = refused.expect("nothing holds the boom's azimuth");
    let message = error.to_string();
    assert!(
        matches!(error, StaticsError::FreeMotion { .. })
            && message.contains("line 'boom'")
            && message.contains("along global y"),
        "{message}"
    );
    // About the horizontal the weight holds it, straight down.
    let held = System::new(&model(&boom("[0, 1, 0]"))).unwrap();
    let hanging = solve_statics(&held, &mut |_| ControlFlow::Continue(())).unwrap();
    let declination = hanging.view().channel(ChannelTarget::EndDeclination(0, 1));
    assert!(
        declination < 1e-3 && hanging.warnings.is_empty(),
        "{declination} deg"
    );
}

#[test]
fn a_stiff_line_under_small_loads_is_warned_of_round_off() {
    let beam = |stiffness: &str| {
        let text = format!(
            r#"
            environment.gravity = 0
            [line_types.bar]
            kind = "general"
            outer_diameter = "0.01 m"
            mass = "1 kg/m"
            axial_stiffness = "{stiffness}"
            bending_stiffness = "100 N m^2"
            [anchors.wall]
            position = [0, 0, 0]
            [lines.beam]
            sections = [{{ type = "bar", length = "2 m", elements = 40 }}]
            end_a = {{ to = "wall", joint = "fixed", direction = [1, 0, 0] }}
            [loads.tip]
            on = "beam"
            at = "2 m"
            force = [0, 0, "1 N"]
            "#
        );
        statics(&model(&text)).warnings
    };
    // 4 epsilon x 2 m x 30 EA / l is 1e-3 N, and 1e-6 N with a thousandth of the stiffness.
    let told = beam("1 GN");
    assert!(
        told.iter().any(|text| text.contains("round-off")),
        "{told:?}"
    );
    assert!(beam("1 MN").is_empty());
}
