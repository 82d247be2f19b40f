//! Each kind of system that people bring: it runs with default solver settings, and it is right.

mod common;

use std::f64::consts::{PI, TAU};

use catenix_model::LineQuantity;
use common::{G, WATER, assert_near, catenary_parameter, distance, model, run, statics};

/// Wet weight of [`HOSE`] [N/m].
const HOSE_WET_WEIGHT: f64 = (75.0 - WATER * 0.25 * PI * 0.0625) * G;
const HOSE: &str = r#"
    [line_types.hose]
    kind = "general"
    outer_diameter = "0.25 m"
    mass = "75 kg/m"
    axial_stiffness = "20 MN"
    bending_stiffness = "2 kN m^2"
    structural_damping = "0.05 s"
"#;

/// 200 m of hose between a heaving ship and a tower 50 m away, both 5 m under the surface.
fn sagging_hose(environment: &str) -> String {
    format!(
        r#"{environment}{HOSE}
        [motions.heave]
        kind = "harmonic"
        degree = "heave"
        amplitude = "1 m"
        period = "8 s"
        [vessels.ship]
        position = ["0 m", "0 m", "-5 m"]
        motions = ["heave"]
        [anchors.tower]
        position = ["50 m", "0 m", "-5 m"]
        [lines.hose]
        sections = [{{ type = "hose", length = "200 m", element_length = "2.5 m" }}]
        end_a = {{ to = "ship" }}
        end_b = {{ to = "tower" }}
        [dynamics]
        duration = "60 s"
        "#
    )
}

#[test]
fn a_slack_hose_hangs_in_a_deep_sag() {
    let run = run(&model(&sagging_hose("environment.water.depth = \"300 m\"")));
    run.assert_sound(60.0, 1e-3);
    let a = catenary_parameter(50.0, 200.0);
    let lowest = -5.0 - a * ((25.0 / a).cosh() - 1.0);
    let z = run.statics.fields[0].get(LineQuantity::Z)[40];
    // The bend at the bottom is stiff over sqrt(EI / H) = 1 m, a seventh of its radius.
    assert_near("lowest point", z, lowest, 0.3);
    for end in ["hose.end_a.force_z", "hose.end_b.force_z"] {
        let force = run.statics.get(end);
        // Half the weight each, up to the residual that statics leaves.
        assert_near(end, force, -100.0 * HOSE_WET_WEIGHT, 1.0);
    }
}

#[test]
fn a_slack_hose_lies_on_the_seabed() {
    let text = sagging_hose("environment = { water.depth = \"85 m\", seabed = {} }");
    let run = run(&model(&text));
    run.assert_sound(60.0, 1e-3);
    let fields = &run.statics.fields[0];
    // In the middle the springs of the seabed carry the hose alone: penetration w / k, and 1 cm for
    // the soft start of the spring. From element to element the bend at the touch-down leaves 1 mm.
    let middle = fields.get(LineQuantity::Z)[40];
    assert_near("rest", middle, -85.01 - HOSE_WET_WEIGHT / 10e3, 2e-3);
    let carried = -run.statics.get("hose.end_a.force_z") - run.statics.get("hose.end_b.force_z");
    // Each end carries the 80 m to the ground and the bend at the touch-down, w a with a = 1.3 m.
    assert_near(
        "carried by the ends",
        carried,
        162.5 * HOSE_WET_WEIGHT,
        2.0 * HOSE_WET_WEIGHT,
    );
}

#[test]
fn a_pipe_of_6000_m_follows_a_heaving_ship() {
    let text = r#"
        [environment.water]
        depth = "6500 m"
        [environment.current]
        heading = "60 deg"
        profile = [{ depth = "0 m", speed = "0.8 m/s" }, { depth = "1000 m", speed = "0.1 m/s" }]
        [line_types.pipe]
        kind = "pipe"
        outer_diameter = "0.25 m"
        inner_diameter = "0.2 m"
        content_density = "1025 kg/m^3"
        axial_drag = 0
        [motions.heave]
        kind = "harmonic"
        degree = "heave"
        amplitude = "2 m"
        period = "10 s"
        ramp = "40 s"
        [vessels.ship]
        position = ["0 m", "0 m", "0 m"]
        motions = ["heave"]
        [lines.pipe]
        sections = [{ type = "pipe", length = "6000 m", elements = 120 }]
        attachments.clump = { at = "6000 m", mass = "40 t", volume = "5 m^3", drag_area = "2 m^2" }
        end_a = { to = "ship" }
        [dynamics]
        duration = "100 s"
        statistics_window = "20 s"
    "#;
    let run = run(&model(text));
    run.assert_sound(100.0, 1e-3);
    let steel = 0.25 * PI * (0.25f64.powi(2) - 0.2f64.powi(2));
    let weight = ((7850.0 - WATER) * steel * 6000.0 + 40e3 - WATER * 5.0) * G;
    // Weight in water hangs at the top, less the residuals of 120 elements, up to 1e-7 of the weight
    // in air each; axial drag there is none.
    let top = -run.statics.get("pipe.end_a.force_z");
    assert_near("top force", top, weight, 2e-5 * weight);
    let stiffness = 206e9 * steel;
    let tension = run.statics.fields[0].get(LineQuantity::EffectiveTension);
    let mean = (1..120).map(|k| tension[k]).sum::<f64>() + 0.5 * (tension[0] + tension[120]);
    let stretch = mean * 50.0 / stiffness;
    // The chord of a bent element is shorter than its arc by (angle)^2 / 24: below 1 cm in all.
    let length = run.statics.fields[0].polygon_length();
    assert_near("length", length, 6000.0 + stretch, 0.02);

    // Forced axial vibration of a rod with a mass at its end, u = cos(k x) + b sin(k x).
    let mass = 7850.0 * steel + WATER * 0.25 * PI * 0.04;
    let omega = TAU / 10.0;
    let k = omega * (mass / stiffness).sqrt();
    let load = 40e3 * omega * omega;
    let (sin, cos) = (k * 6000.0).sin_cos();
    let b = (load * cos + stiffness * k * sin) / (stiffness * k * cos - load * sin);
    let amplitude = (2.0 * stiffness * k * b).abs();
    let (low, high) = run.range_since("pipe.end_a.effective_tension", 80.0);
    // Without axial drag the transient of the ramp stays, a few per cent of the amplitude.
    assert_near(
        "heave force",
        0.5 * (high - low),
        amplitude,
        0.05 * amplitude,
    );
}

#[test]
fn a_taut_mooring_line_pulls_with_its_strain() {
    let text = r#"
        [environment.water]
        depth = "300 m"
        [line_types.rope]
        kind = "general"
        outer_diameter = "0.16 m"
        mass = "21 kg/m"
        axial_stiffness = "60 MN"
        bending_stiffness = "1 kN m^2"
        structural_damping = "0.02 s"
        [motions.heave]
        kind = "harmonic"
        degree = "heave"
        amplitude = "1 m"
        period = "12 s"
        [vessels.buoy]
        position = ["0 m", "0 m", "-1 m"]
        motions = ["heave"]
        [anchors.anchor]
        position = ["300 m", "0 m", "-250 m"]
        [lines.mooring]
        sections = [{ type = "rope", length = "386 m", elements = 40 }]
        end_a = { to = "buoy" }
        end_b = { to = "anchor" }
        [dynamics]
        duration = "60 s"
    "#;
    let run = run(&model(text));
    run.assert_sound(60.0, 1e-3);
    let span = distance([0.0, 0.0, -1.0], [300.0, 0.0, -250.0]);
    let expected = 60e6 * (span / 386.0 - 1.0);
    let wet = (21.0 - WATER * 0.25 * PI * 0.16f64.powi(2)) * G * 386.0;
    // The ends share the component of the weight along the line, w h / 2 each.
    let half = 0.5 * wet * 249.0 / span;
    for (end, share) in [("a", half), ("b", -half)] {
        let tension = run
            .statics
            .get(&format!("mooring.end_{end}.effective_tension"));
        // Sag lengthens the line by (w l)^2 / 24 T^2: 4e-7 of strain 1e-2.
        assert_near(end, tension, expected + share, 1e-4 * expected);
    }
    // A rod shaken at one end pulls with EA k / tan(k l) per metre.
    let wave = TAU / 12.0 * (21.0f64 / 60e6).sqrt() * 386.0;
    let amplitude = 60e6 / 386.0 * wave / wave.tan() * 249.0 / span;
    let (low, high) = run.range_since("mooring.end_a.effective_tension", 36.0);
    // The line turns by 0.8 m / 390 m while it stretches: relative effects of that size.
    assert_near("swing", 0.5 * (high - low), amplitude, 5e-3 * amplitude);
}

fn neutral_hose(current: &str) -> String {
    let mass = WATER * 0.25 * PI * 0.04;
    format!(
        r#"
        [environment]
        water.depth = "100 m"
        {current}
        [line_types.hose]
        kind = "general"
        outer_diameter = "0.2 m"
        mass = {mass}
        axial_stiffness = "5 MN"
        bending_stiffness = "10 kN m^2"
        structural_damping = "0.02 s"
        axial_drag = 0
        [motions.surge]
        kind = "harmonic"
        degree = "surge"
        amplitude = "1 m"
        period = "10 s"
        [vessels.ship]
        position = ["0 m", "0 m", "-50 m"]
        motions = ["surge"]
        [anchors.tower]
        position = ["80 m", "0 m", "-50 m"]
        [lines.hose]
        sections = [{{ type = "hose", length = "100 m", elements = 50 }}]
        end_a = {{ to = "ship" }}
        end_b = {{ to = "tower" }}
        [dynamics]
        duration = "60 s"
        "#
    )
}

#[test]
fn a_neutrally_buoyant_hose_in_still_water_is_an_elastica() {
    let run = run(&model(&neutral_hose("")));
    run.assert_sound(60.0, 1e-3);
    let push: f64 = run
        .statics
        .vector("hose.end_a.force_")
        .iter()
        .map(|f| f * f)
        .sum();
    // Euler load times (2 K / pi)^2, with 2 E / K - 1 = 0.8 at k^2 = 0.19365: K = 1.655703.
    let expected = (2.0 * 1.655_703 / 100.0f64).powi(2) * 10e3;
    // 50 elements: (pi / 50)^2 / 12 = 3e-4; and 1e-7 of the weight in air, 3e-3 N of 11 N.
    assert_near(
        "push of the bent hose",
        push.sqrt(),
        expected,
        2e-3 * expected,
    );
}

#[test]
fn a_neutrally_buoyant_hose_bows_with_the_current() {
    let current =
        "current = { heading = \"90 deg\", profile = [{ depth = \"0 m\", speed = \"0.5 m/s\" }] }";
    let run = run(&model(&neutral_hose(current)));
    run.assert_sound(60.0, 1e-3);
    let fields = &run.statics.fields[0];
    let mut drag = [0.0; 3];
    for k in 0..50 {
        let (a, b) = (fields.position(k), fields.position(k + 1));
        let length = distance(a, b);
        let along = [0, 1, 2].map(|i| (b[i] - a[i]) / length);
        let across = [0, 1, 2].map(|i| 0.5 * (f64::from(i == 1) - along[1] * along[i]));
        let speed = across.iter().map(|u| u * u).sum::<f64>().sqrt();
        for i in 0..3 {
            drag[i] += 0.5 * WATER * 1.2 * 0.2 * 2.0 * speed * across[i];
        }
    }
    let (a, b) = (
        run.statics.vector("hose.end_a.force_"),
        run.statics.vector("hose.end_b.force_"),
    );
    // Elements against chords of nodes: second order in 1/50.
    let total = drag[1];
    assert_near("sum of end forces", a[1] + b[1], total, 2e-3 * total);
    assert_near("shared alike", a[1], b[1], 1e-3 * total);
    assert_near("no weight", a[2] + b[2], 0.0, 1e-3 * total);
}

/// 400 m of chain over a span of 300 m, with a bending stiffness in N m2.
fn chain(bending_stiffness: f64) -> String {
    format!(
        r#"
        [environment.water]
        depth = "500 m"
        [line_types.chain]
        kind = "general"
        outer_diameter = "0.05 m"
        mass = "20 kg/m"
        axial_stiffness = "1 GN"
        bending_stiffness = {bending_stiffness}
        [motions.surge]
        kind = "harmonic"
        degree = "surge"
        amplitude = "3 m"
        period = "10 s"
        [vessels.ship]
        position = ["0 m", "0 m", "0 m"]
        motions = ["surge"]
        [anchors.tower]
        position = ["300 m", "0 m", "0 m"]
        [lines.chain]
        sections = [{{ type = "chain", length = "400 m", elements = 100 }}]
        end_a = {{ to = "ship" }}
        end_b = {{ to = "tower" }}
        [dynamics]
        duration = "60 s"
        "#
    )
}

#[test]
fn chains_with_little_or_no_bending_stiffness_are_catenaries() {
    let wet = (20.0 - WATER * 0.25 * PI * 0.0025) * G;
    let a = catenary_parameter(300.0, 400.0);
    // 0.1 N m2 is under 1e-3 of the weight of a metre, 177 N, times a metre.
    for stiffness in [0.0, 0.1] {
        let run = run(&model(&chain(stiffness)));
        run.assert_sound(60.0, 1e-3);
        let sag = -run.statics.fields[0].get(LineQuantity::Z)[50];
        let expected = a * ((150.0 / a).cosh() - 1.0);
        // A polygon of 100 elements: (l / a)^2 / 24 = 5e-5, and a strain of 4e-5.
        assert_near("sag", sag, expected, 2e-4 * expected);
        let tension = run.statics.get("chain.end_a.effective_tension");
        let expected = wet * a.hypot(200.0);
        assert_near("tension", tension, expected, 2e-3 * expected);
        let pull = run.statics.get("chain.end_a.force_x");
        assert_near("pull", pull, wet * a, 5e-4 * wet * a);
    }
}

#[test]
fn a_vertical_pipe_in_still_water_stays_vertical() {
    let text = r#"
        [environment.water]
        depth = "1500 m"
        [line_types.pipe]
        kind = "pipe"
        outer_diameter = "0.3 m"
        inner_diameter = "0.26 m"
        content_density = "1025 kg/m^3"
        [anchors.platform]
        position = ["0 m", "0 m", "-5 m"]
        [lines.pipe]
        sections = [{ type = "pipe", length = "1000 m", elements = 50 }]
        end_a = { to = "platform" }
        [dynamics]
        duration = "60 s"
    "#;
    let run = run(&model(text));
    run.assert_sound(60.0, 1e-3);
    let wet = (7850.0 - WATER) * 0.25 * PI * (0.09 - 0.0676) * G;
    let weight_in_air = (wet + WATER * G * 0.25 * PI * 0.09) * 1000.0;
    // Each of 50 elements may keep the residual that the analysis allows, all with one sign.
    for (fields, residual) in [(&run.statics.fields[0], 1e-7), (&run.fields[0], 1e-5)] {
        for node in 0..=50 {
            let [x, y, _] = fields.position(node);
            assert_near("x", x, 0.0, 1e-9);
            assert_near("y", y, 0.0, 1e-9);
            let below = wet * (1000.0 - 20.0 * node as f64);
            let tension = fields.get(LineQuantity::EffectiveTension)[node];
            assert_near("tension", tension, below, 50.0 * residual * weight_in_air);
        }
    }
}

#[test]
fn statics_of_a_free_end_is_the_same_from_either_end() {
    // The same pipe built from its other end.
    let text = |ends: &str, clump: &str| {
        format!(
            r#"
            [environment]
            water.depth = "600 m"
            current.profile = [{{ depth = "0 m", speed = "0.8 m/s" }}]
            [line_types.pipe]
            kind = "pipe"
            outer_diameter = "0.25 m"
            inner_diameter = "0.21 m"
            [anchors.platform]
            position = ["0 m", "0 m", "-10 m"]
            [lines.pipe]
            sections = [{{ type = "pipe", length = "500 m", elements = 50 }}]
            attachments.clump = {{ at = "{clump}", mass = "10 t", wet_weight = "85 kN" }}
            {ends}
            "#
        )
    };
    let down = statics(&model(&text("end_a = { to = \"platform\" }", "500 m")));
    let up = statics(&model(&text("end_b = { to = \"platform\" }", "0 m")));
    for node in 0..=50 {
        let (a, b) = (
            down.fields[0].position(node),
            up.fields[0].position(50 - node),
        );
        // Both leave a residual of 1e-7 of the weight: 0.1 N on a hanging stiffness of 1 kN/m.
        assert!(distance(a, b) < 1e-3, "node {node}: {a:?} and {b:?}");
    }
}
