//! Lines whose make-up varies: clamped ends, sections of unlike cross sections, attachments.

mod common;

use std::f64::consts::PI;

use catenix_model::LineQuantity;
use common::{G, WATER, assert_near, distance, model, run, statics};

#[test]
fn a_line_clamped_at_both_ends_is_a_beam() {
    let text = r#"
        environment.water.depth = "100 m"
        [line_types.beam]
        kind = "general"
        outer_diameter = "0.1 m"
        mass = "8.2 kg/m"
        axial_stiffness = "1 MN"
        bending_stiffness = "10 kN m^2"
        [motions.heave]
        kind = "harmonic"
        degree = "heave"
        amplitude = "1 mm"
        period = "5 s"
        [vessels.left]
        position = ["0 m", "0 m", "-5 m"]
        motions = ["heave"]
        [anchors.right]
        position = ["10 m", "0 m", "-5 m"]
        [lines.beam]
        sections = [{ type = "beam", length = "10 m", elements = 20 }]
        end_a = { to = "left", joint = "fixed", direction = [1, 0, 0] }
        end_b = { to = "right", joint = "fixed", direction = [1, 0, 0] }
        [dynamics]
        duration = "30 s"
    "#;
    let run = run(&model(text));
    run.assert_sound(30.0, 1e-3);
    let load = (8.2 - WATER * 0.25 * PI * 0.01) * G;
    // w L^4 / 384 EI and w L^2 / 12; the load in twenty pieces leaves some (1/20)^2, and the sag of 4 mm no tension to speak of.
    let sag = -5.0 - run.statics.fields[0].get(LineQuantity::Z)[10];
    let expected = load * 1e4 / 384e4;
    assert_near("sag", sag, expected, 1e-2 * expected);
    for end in ["a", "b"] {
        let moment = run.statics.get(&format!("beam.end_{end}.moment_y"));
        assert_near(
            "moment",
            moment.abs(),
            load * 100.0 / 12.0,
            1e-2 * load * 100.0 / 12.0,
        );
    }
}

/// A line that hangs straight down from a hook, of the given sections and attachments.
fn hanging(sections: &str, attachments: &str) -> String {
    format!(
        r#"
        environment.water.depth = "200 m"
        [line_types.hose]
        kind = "general"
        outer_diameter = "0.2 m"
        mass = "50 kg/m"
        axial_stiffness = "10 MN"
        bending_stiffness = "10 kN m^2"
        structural_damping = "0.02 s"
        [line_types.chain]
        kind = "general"
        outer_diameter = "0.1 m"
        mass = "80 kg/m"
        axial_stiffness = "300 MN"
        structural_damping = "0.01 s"
        [line_types.pipe]
        kind = "pipe"
        outer_diameter = "0.3 m"
        inner_diameter = "0.25 m"
        [motions.surge]
        kind = "harmonic"
        degree = "surge"
        amplitude = "1 m"
        period = "10 s"
        [vessels.hook]
        position = ["0 m", "0 m", "-10 m"]
        motions = ["surge"]
        [lines.string]
        sections = {sections}
        attachments = {attachments}
        end_a = {{ to = "hook" }}
        [dynamics]
        duration = "40 s"
        "#
    )
}

/// Wet weights of the three cross sections of [`hanging`] [N/m].
fn wet_weights() -> [f64; 3] {
    let displaced = |d: f64| WATER * 0.25 * PI * d * d;
    let steel = 7850.0 * 0.25 * PI * (0.09 - 0.0625);
    [
        50.0 - displaced(0.2),
        80.0 - displaced(0.1),
        steel - displaced(0.3),
    ]
    .map(|mass| mass * G)
}

#[test]
fn sections_of_unlike_types_hang_one_below_the_other() {
    let text = hanging(
        r#"[
            { type = "hose", length = "30 m", elements = 10 },
            { type = "chain", length = "20 m", elements = 20 },
            { type = "hose", length = "10 m", element_length = "2 m", element_length_a = "0.5 m" },
            { type = "pipe", length = "40 m", elements = 8 },
        ]"#,
        "{}",
    );
    let run = run(&model(&text));
    run.assert_sound(40.0, 1e-3);
    let [hose, chain, pipe] = wet_weights();
    let below = |s: f64| {
        let share = |from: f64, to: f64| (to - s.max(from)).max(0.0);
        hose * (share(0.0, 30.0) + share(50.0, 60.0))
            + chain * share(30.0, 50.0)
            + pipe * share(60.0, 100.0)
    };
    let tension = run.statics.fields[0].get(LineQuantity::EffectiveTension);
    for (s, tension) in run.statics.arc_length[0].iter().zip(tension) {
        // Residuals of 50 elements, 1e-7 of 100 kN each.
        assert_near("tension", *tension, below(*s), 0.5);
    }
    // Each stretch is longer by the integral of its tension over its stiffness.
    let pipe_stiffness = 206e9 * 0.25 * PI * (0.09 - 0.0625);
    let stretch = 30.0 * below(15.0) / 10e6
        + 20.0 * below(40.0) / 300e6
        + 10.0 * below(55.0) / 10e6
        + 40.0 * below(80.0) / pipe_stiffness;
    let length = run.statics.fields[0].polygon_length();
    assert_near("length", length, 100.0 + stretch, 1e-3 * stretch + 1e-6);
}

#[test]
fn attachments_pull_where_they_sit() {
    // At an end of the line, between two elements, just beside, inside an element, at end B.
    for at in [0.0, 20.0, 20.0001, 21.3, 50.0] {
        let text = hanging(
            r#"[{ type = "hose", length = "50 m", elements = 20 }]"#,
            &format!(r#"{{ clump = {{ at = {at}, mass = "3 t", wet_weight = "25 kN" }} }}"#),
        );
        let run = run(&model(&text));
        run.assert_sound(40.0, 1e-3);
        let [hose, ..] = wet_weights();
        let tension = run.statics.fields[0].get(LineQuantity::EffectiveTension);
        for (s, tension) in run.statics.arc_length[0].iter().zip(tension) {
            // At the clump's own node, half of it hangs on either side.
            let above = *s < at + 1e-9;
            let share = if (s - at).abs() < 1e-9 && at > 0.0 && at < 50.0 {
                0.5
            } else {
                f64::from(above)
            };
            if (at - 50.0).abs() < 1e-9 && (s - at).abs() < 1e-9 {
                // The free end itself: what hangs on it hangs on the last element.
                continue;
            }
            let below = hose * (50.0 - s) + share * 25e3;
            // Residuals of 20 elements, 1e-7 of 60 kN each.
            assert_near(
                &format!("clump at {at}, tension at {s}"),
                *tension,
                below,
                0.2,
            );
        }
        assert!(distance(run.fields[0].position(0), [0.0; 3]) < 12.0);
    }
}

#[test]
fn a_float_inside_an_element_bends_a_line_as_two_halves_at_its_ends() {
    // A float lifts a horizontal hose; moving it by a fraction of an element hardly matters.
    let sag = |at: f64| {
        let text = format!(
            r#"
            environment.water.depth = "100 m"
            [line_types.hose]
            kind = "general"
            outer_diameter = "0.2 m"
            mass = "50 kg/m"
            axial_stiffness = "10 MN"
            bending_stiffness = "10 kN m^2"
            [anchors.left]
            position = [0, 0, -50]
            [anchors.right]
            position = [40, 0, -50]
            [lines.hose]
            sections = [{{ type = "hose", length = "42 m", elements = 42 }}]
            attachments.float = {{ at = {at}, mass = "100 kg", net_lift = "5 kN" }}
            end_a = {{ to = "left" }}
            end_b = {{ to = "right" }}
            "#
        );
        let statics = statics(&model(&text));
        let (a, b) = (
            statics.vector("hose.end_a.force_"),
            statics.vector("hose.end_b.force_"),
        );
        let wet = wet_weights()[0] * 42.0;
        // Residuals of 42 elements, 1e-7 of 26 kN each.
        assert_near("balance", a[2] + b[2], 5e3 - wet, 0.1);
        statics.fields[0].get(LineQuantity::Z)[21]
    };
    let (on_node, beside, inside) = (sag(21.0), sag(21.00001), sag(21.25));
    assert_near("beside a node", beside, on_node, 1e-2);
    assert_near("inside", inside, on_node, 5e-2);
}
