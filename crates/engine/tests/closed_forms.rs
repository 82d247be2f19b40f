//! Whole systems against answers that are known in closed form or published.

mod common;

use std::f64::consts::PI;

use common::{assert_near, model, run};

#[test]
fn a_twisted_shaft_carries_gj_theta_over_l() {
    let text = r#"
        environment.water.depth = "200 m"
        [line_types.shaft]
        kind = "general"
        outer_diameter = "0.2 m"
        mass = "60 kg/m"
        axial_stiffness = "50 MN"
        bending_stiffness = "400 kN m^2"
        torsional_stiffness = "300 kN m^2"
        structural_damping = "0.1 s"
        [motions.yaw]
        kind = "harmonic"
        degree = "yaw"
        amplitude = "60 deg"
        period = "400 s"
        ramp = "20 s"
        [vessels.ship]
        position = [0, 0, -5]
        motions = ["yaw"]
        [anchors.anchor]
        position = [0, 0, -105]
        [lines.shaft]
        sections = [{ type = "shaft", length = "99.9 m", elements = 20 }]
        end_a = { to = "ship", joint = "fixed" }
        end_b = { to = "anchor", joint = "fixed" }
        [dynamics]
        duration = "100 s"
    "#;
    let run = run(&model(text));
    let torque = 300e3 * (PI / 3.0) / 99.9;
    // At the peak of a yaw that is slow against the shaft's own period of 0.2 s: 2e-6 of inertia,
    // and what is left of the start.
    assert_near(
        "at A",
        run.last("shaft.end_a.moment_z"),
        -torque,
        1e-3 * torque,
    );
    assert_near(
        "at B",
        run.last("shaft.end_b.moment_z"),
        torque,
        1e-3 * torque,
    );
}

/// Lowe and Langley 2006: a flexible hose over 100 m of span and 50 m of rise; the top end is
/// forced by 10 m at 27 s. End tensions of the elastic catenary and of OrcaFlex, and OrcaFlex's
/// range of the top tension over the last period, as quoted in MoorDyn's own test of this case.
/// Drag and added mass of 1 across the hose and none along it are assumed.
fn lowe_and_langley(degree: &str) -> String {
    format!(
        r#"
        [environment]
        gravity = 9.807
        water = {{ density = 1000, depth = "200 m" }}
        [line_types.hose]
        kind = "general"
        outer_diameter = "0.396 m"
        mass = "165 kg/m"
        axial_stiffness = "500 MN"
        bending_stiffness = "120.8 kN m^2"
        normal_drag = 1.0
        axial_drag = 0.0
        normal_added_mass = 1.0
        [motions.forced]
        kind = "harmonic"
        degree = "{degree}"
        amplitude = "10 m"
        period = "27 s"
        ramp = "27 s"
        [vessels.top]
        position = [100, 0, -100]
        motions = ["forced"]
        [anchors.bottom]
        position = [0, 0, -150]
        [lines.hose]
        sections = [{{ type = "hose", length = "170 m", elements = 60 }}]
        end_a = {{ to = "bottom" }}
        end_b = {{ to = "top" }}
        [dynamics]
        duration = "108 s"
        "#
    )
}

#[test]
fn val_lowe_and_langley_2006_hose() {
    for (degree, largest, least) in [
        ("surge", 52.24, 41.58),
        ("sway", 49.12, 44.38),
        ("heave", 57.78, 36.78),
    ] {
        let run = run(&model(&lowe_and_langley(degree)));
        // Static: 47.14 and 26.63 kN for the elastic catenary; bending adds a little.
        assert_near(
            "top",
            run.statics.get("hose.end_b.effective_tension"),
            47.14e3,
            200.0,
        );
        assert_near(
            "bottom",
            run.statics.get("hose.end_a.effective_tension"),
            26.63e3,
            200.0,
        );
        let tension = run.history("hose.end_b.effective_tension");
        let last: Vec<f64> = run
            .time
            .iter()
            .zip(tension)
            .filter(|(time, _)| **time > 81.0)
            .map(|(_, tension)| *tension)
            .collect();
        let high = last.iter().copied().fold(f64::MIN, f64::max);
        let low = last.iter().copied().fold(f64::MAX, f64::min);
        // The kN of the published comparison between codes.
        assert_near(degree, high, largest * 1e3, 1e3);
        assert_near(degree, low, least * 1e3, 1e3);
    }
}
