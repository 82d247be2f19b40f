//! Explicit integration of lumped masses: how large its steps may be, and that it reaches the same
//! motion as implicit integration.

mod common;

use std::ops::ControlFlow;

use catenix_engine::{StableStep, System, measure_stable_step, solve_statics};
use catenix_model::{FormulationKind, IntegratorSettings, Model, StepControl};
use common::{assert_near, model, run};

/// A pipe that hangs from a ship, in water, with a weight at its end; `EXTRA` goes to its type.
const HANGING: &str = r#"
title = "hanging pipe"
formulation = "lumped"
[environment]
water.depth = "400 m"
[environment.current]
profile = [{ depth = "0 m", speed = "0.8 m/s" }]
[line_types.pipe]
kind = "general"
outer_diameter = "0.2 m"
mass = "80 kg/m"
axial_stiffness = "40 MN"
bending_stiffness = "BENDING"
structural_damping = "DAMPING"
[vessels.ship]
position = ["0 m", "0 m", "-5 m"]
motions = ["heave"]
[motions.heave]
kind = "harmonic"
degree = "heave"
amplitude = "1 m"
period = "8 s"
ramp = "4 s"
[lines.pipe]
sections = [SECTIONS]
attachments.weight = { at = "200 m", mass = "900 kg", volume = "0.1 m^3", drag_area = "1 m^2" }
end_a = { to = "ship", joint = "ball" }
[dynamics]
duration = "20 s"
[output]
interval = "0.1 s"
channels = ["pipe.x@200m", "pipe.z@200m"]
"#;

const EVEN: &str = r#"{ type = "pipe", length = "200 m", elements = 40 }"#;

fn hanging(sections: &str, bending: &str, damping: &str) -> Model {
    model(
        &HANGING
            .replace("SECTIONS", sections)
            .replace("BENDING", bending)
            .replace("DAMPING", damping),
    )
}

fn measured(model: &Model) -> Option<StableStep> {
    let system = System::new(model).unwrap_or_else(|error| panic!("{error}"));
    let equilibrium = solve_statics(&system, &mut |_| ControlFlow::Continue(()));
    let equilibrium = equilibrium.unwrap_or_else(|error| panic!("{error}"));
    measure_stable_step(&system, &equilibrium)
}

fn assert_within(what: &str, found: StableStep, expected_s: f64, share: f64) {
    assert_near(what, found.theory_s, expected_s, share * expected_s);
    let error = found.measured_s / found.theory_s - 1.0;
    // The fastest part by itself is never slower than the whole.
    assert!(
        (-1e-3..share).contains(&error),
        "{what}: {found:?}, off by {error}"
    );
}

/// The step in which a wave passes one element: l sqrt(m / EA), docs/theory/lumped.md, eq. (28).
#[test]
fn the_largest_stable_step_is_that_of_a_wave_through_one_element() {
    let wave = |length: f64| length * (80.0f64 / 40e6).sqrt();
    let even = measured(&hanging(EVEN, "100 kN m^2", "0 s")).expect("lumped mass has a limit");
    // A chain of 40 elements vibrates a little slower than one by itself.
    assert_within("even", even, wave(5.0), 0.01);
    // A single short element among long ones decides. Its neighbours' masses slow it down, which
    // the bound by elements leaves out: it is on the safe side.
    let sections = r#"{ type = "pipe", length = "100 m", elements = 20 }, { type = "pipe", length = "2.5 m", elements = 1 }, { type = "pipe", length = "97.5 m", elements = 19 }"#;
    let short = measured(&hanging(sections, "100 kN m^2", "0 s")).expect("lumped mass has a limit");
    assert!(short.measured_s > wave(2.5), "{short:?}");
    assert!(short.measured_s < wave(5.0), "{short:?}");
}

/// docs/theory/lumped.md, eq. (27): damping proportional to stiffness shortens the step.
#[test]
fn internal_damping_shortens_the_step() {
    let wave = 5.0 * (80.0f64 / 40e6).sqrt();
    // Just beyond the limit a heavily damped motion grows slowly: 1 % in 1500 steps.
    for damping in [0.001, 0.02] {
        let text = format!("{damping} s");
        let found = measured(&hanging(EVEN, "100 kN m^2", &text)).expect("lumped mass has a limit");
        let share = damping / wave;
        let expected = wave * ((1.0 + 4.0 * share * share).sqrt() - 2.0 * share);
        assert_within("damped", found, expected, 0.02);
    }
}

/// docs/theory/lumped.md, eq. (26): in short elements bending is faster than stretching.
#[test]
fn bending_limits_short_elements() {
    let sections = r#"{ type = "pipe", length = "200 m", elements = 800 }"#;
    let found = measured(&hanging(sections, "20 MN m^2", "0 s")).expect("lumped mass has a limit");
    let across: f64 = 80.0 + 1025.0 * 0.25 * std::f64::consts::PI * 0.04;
    let expected = 0.5 * 0.25f64.powi(2) * (across / 20e6).sqrt();
    // Tension adds a little; so does the pattern's distance from the fastest one.
    assert_within("bending", found, expected, 0.02);
}

#[test]
fn other_formulations_have_no_explicit_integration() {
    let mut model = hanging(EVEN, "100 kN m^2", "0 s");
    model.formulation = FormulationKind::Dem;
    assert_eq!(measured(&model), None);
    if let Some(dynamics) = &mut model.dynamics {
        dynamics.integrator = IntegratorSettings::Explicit;
    }
    let error = System::new(&model).expect_err("it is refused").to_string();
    assert!(
        error.contains("'dem'") && error.contains("'lumped'"),
        "{error}"
    );
}

#[test]
fn explicit_and_implicit_integration_reach_the_same_motion() {
    let mut model = hanging(EVEN, "100 kN m^2", "0.001 s");
    let mut results = Vec::new();
    for integrator in [
        IntegratorSettings::Explicit,
        IntegratorSettings::GeneralisedAlpha {
            spectral_radius: 0.8,
        },
    ] {
        if let Some(dynamics) = &mut model.dynamics {
            dynamics.integrator = integrator;
            dynamics.step = StepControl::Fixed(0.01);
        }
        results.push(run(&model));
    }
    let [explicit, implicit] = [&results[0], &results[1]];
    // Each step of 0.01 s is split: 7.07 ms is stable, less damping.
    let statistics = &explicit.report.statistics;
    assert_eq!(statistics.rejected_steps, 0);
    assert!(
        statistics.iterations >= 2 * statistics.steps,
        "{statistics:?}"
    );
    for channel in ["pipe.x@200m", "pipe.z@200m"] {
        let pairs = explicit
            .history(channel)
            .iter()
            .zip(implicit.history(channel));
        let error = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        // Second order both; steps of 0.01 s and a motion of 1 m in 8 s, axial waves of 0.5 s.
        assert!(error < 2e-3, "{channel}: {error} m");
    }
    let tension = "pipe.end_a.effective_tension";
    let (a, b) = (
        explicit.range_since(tension, 10.0),
        implicit.range_since(tension, 10.0),
    );
    assert_near("smallest tension", a.0, b.0, 0.01 * (b.1 - b.0));
    assert_near("largest tension", a.1, b.1, 0.01 * (b.1 - b.0));
}
