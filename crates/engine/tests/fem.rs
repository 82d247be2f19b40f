//! Systems of beam elements against closed forms.

mod common;

use catenix_engine::{ModeKind, PathEvent};
use catenix_model::{ModeRange, ModeSettings};
use common::path::follow;
use common::{assert_near, lowest_modes, model, modes, statics};

const CHAIN: &str = r#"
formulation = "fem"
title = "hanging chain"
environment.gravity = "9.80665 m/s^2"
[line_types.line]
kind = "general"
outer_diameter = "0.05 m"
mass = "20 kg/m"
axial_stiffness = "4 GN"
[anchors.top]
position = [0, 0, 0]
[lines.line]
sections = [{ type = "line", length = "100 m", elements = 40 }]
end_a = { to = "top", joint = "ball", direction = [0, 0, -1] }
"#;

/// No bending stiffness, and no tension at the free end, which must not turn over.
#[test]
fn a_hanging_chain_swings_at_the_zeros_of_a_bessel_function() {
    let found = lowest_modes(&model(CHAIN), 8);
    let vibrations: Vec<f64> = found.modes.iter().map(|mode| mode.frequency_hz()).collect();
    assert!(
        found
            .modes
            .iter()
            .all(|mode| mode.kind == ModeKind::Vibration)
    );
    // j0n sqrt(g / L) / 4 pi, with the zeros j0n of J0. Cubics on 40 elements; the tip, where the
    // tension vanishes, leaves second order, 1 / 12 of (half the zero / 40)^2 at most.
    for (mode, zero) in [2.404_825_558, 5.520_078_110, 8.653_727_913]
        .into_iter()
        .enumerate()
    {
        let want = zero * (9.80665f64 / 100.0).sqrt() / (4.0 * std::f64::consts::PI);
        let allowed = want * (0.5 * zero / 40.0).powi(2) / 12.0;
        assert_near("frequency", vibrations[2 * mode], want, allowed);
        assert_near("the same across", vibrations[2 * mode + 1], want, allowed);
    }
}

#[test]
fn axial_frequencies_of_a_line_with_a_mass() {
    let text = CHAIN
        .replace("9.80665 m/s^2", "0.1 m/s^2")
        .replace("elements = 40", "elements = 80")
        + "end_b = { to = \"clump\" }\n[bodies.clump]\nmass = \"3 t\"\n";
    let settings = ModeSettings {
        range: ModeRange::Band {
            from_hz: 13.0,
            to_hz: 151.0,
        },
        added_mass: true,
    };
    let found = modes(&model(&text), &settings);
    let vibrations: Vec<f64> = found
        .modes
        .iter()
        .filter(|mode| mode.kind == ModeKind::Vibration)
        .map(|mode| mode.frequency_hz())
        .collect();
    // k tan(k L) = mu L / M, verification/axial-vibration. Flat cubics along the line: (k l)^2 / 44.
    for (found, (want, k)) in vibrations.iter().zip([
        (16.565_937_102, 0.739),
        (75.146_706_79, 3.338),
        (143.762_158_36, 6.387),
    ]) {
        let step: f64 = k / 80.0;
        assert_near("frequency", *found, want, 1.2 * want * step * step / 44.0);
    }
}

/// Joints on a body are springs, but they take from the bars what they add.
#[test]
fn two_bars_on_a_body_snap_through_at_the_limit_load_of_bars() {
    let text = r#"
formulation = "fem"
title = "Two-bar truss"
environment.gravity = 0
[line_types.bar]
kind = "general"
outer_diameter = "0.05 m"
mass = "10 kg/m"
axial_stiffness = "1 MN"
bending_stiffness = "10 MN m^2"
[anchors.left]
position = [-2, 0, 0]
[anchors.right]
position = [2, 0, 0]
[bodies.top]
mass = "1 kg"
initial_position = [0, 0, 0.5]
[lines.first]
sections = [{ type = "bar", length = 2.0615528128088303, elements = 3 }]
end_a = { to = "left", joint = "hinge", direction = [2, 0, 0.5] }
end_b = { to = "top", joint = "hinge", direction = [2, 0, 0.5] }
[lines.second]
sections = [{ type = "bar", length = 2.0615528128088303, elements = 3 }]
end_a = { to = "top", joint = "hinge", direction = [2, 0, -0.5] }
end_b = { to = "right", joint = "hinge", direction = [2, 0, -0.5] }
[loads.weight]
on = "top"
force = [0, 0, "-1 kN"]
[path]
range = [-8.0, 8.0]
"#;
    let found = follow(text);
    let limits = found
        .points
        .iter()
        .filter(|point| point.event == Some(PathEvent::Limit));
    let highest = limits
        .map(|point| point.factor)
        .fold(f64::NEG_INFINITY, f64::max);
    // 2 EA (L0 - L) / L0 z / L at its largest over z, verification/truss-snap-through.
    assert_near("limit load", highest, 5.659_141, 1e-6);
}

/// Plastic hinges in the making: the second slope of the law is a two-hundredth of the first.
#[test]
fn a_bilinear_law_with_a_sharp_kink_finds_its_equilibrium() {
    let text = |elements: usize| {
        format!(
            r#"
formulation = "fem"
title = "bilinear"
environment.gravity = 0
[line_types.bar]
kind = "general"
outer_diameter = "0.1 m"
mass = "1 kg/m"
axial_stiffness = "1 MN"
bending_law = [{{ curvature = 0.002, moment = "20 N m" }}, {{ curvature = 0.004, moment = "20.1 N m" }}]
[anchors.wall]
position = ["2 m", 0, 0]
[lines.beam]
sections = [{{ type = "bar", length = "2 m", elements = {elements} }}]
end_a = {{ to = "wall", joint = "fixed", direction = [-1, 0, 0] }}
[loads.tip]
on = "beam"
at = "2 m"
force = [0, 0, "20 N"]
[statics]
tolerance = 1e-10
[output]
channels = ["beam.z@2m"]
"#
        )
    };
    for elements in [10, 80, 160] {
        let found = statics(&model(&text(elements)));
        // The kink lies within an element, whose two points see it or not: first order in how much
        // of the element is beyond, of a deflection that the kink makes eight times the elastic one.
        let z = found.get("beam.z@2m");
        assert_near("deflection", z, 0.319_808_3, 0.32 / elements as f64 * 0.5);
    }
}
