//! Generalised-alpha and BDF share no formula: they must reach the same motion, and each its order.

mod common;

use catenix_model::{IntegratorSettings, Model, StepControl};
use common::{Run, assert_near, distance, model, run};

const ALPHA: IntegratorSettings = IntegratorSettings::GeneralisedAlpha {
    spectral_radius: 0.8,
};
const BDF: IntegratorSettings = IntegratorSettings::Bdf { max_order: 2 };

/// A pipe towed through a current that is turned off at once, as `factor` says, with a heaving
/// ship. Output times are far apart, so that they hardly bind the step.
fn towed_pipe(integrator: IntegratorSettings, step: StepControl, factor: &str) -> Run {
    let mut model = model(&format!(
        r#"
        [environment]
        water.depth = "300 m"
        current.heading = "70 deg"
        current.profile = [{{ depth = 0, speed = "0.8 m/s" }}]
        current.factor = {factor}
        [line_types.pipe]
        kind = "pipe"
        outer_diameter = "0.2 m"
        inner_diameter = "0.16 m"
        content_density = "1025 kg/m^3"
        structural_damping = "0.02 s"
        [motions.tow]
        kind = "tow"
        speed = "0.5 m/s"
        ramp = "10 s"
        [motions.heave]
        kind = "harmonic"
        degree = "heave"
        amplitude = "1 m"
        period = "9 s"
        ramp = "18 s"
        [vessels.ship]
        position = [0, 0, -5]
        motions = ["tow", "heave"]
        [bodies.weight]
        mass = "5 t"
        wet_weight = "40 kN"
        length = "2 m"
        drag_area = "2 m^2"
        [lines.pipe]
        sections = [{{ type = "pipe", length = "200 m", elements = 12 }}]
        end_a = {{ to = "ship" }}
        end_b = {{ to = "weight", joint = "fixed", at = [0, 0, 1] }}
        [dynamics]
        duration = "24 s"
        # Newton's error must not hide the step's.
        tolerance = 1e-9
        [output]
        interval = "2 s"
        field_interval = "8 s"
        "#
    ));
    set(&mut model, integrator, step);
    run(&model)
}

fn set(model: &mut Model, integrator: IntegratorSettings, step: StepControl) {
    if let Some(dynamics) = &mut model.dynamics {
        dynamics.integrator = integrator;
        dynamics.step = step;
    }
}

/// Largest distance of the nodes at the end [m].
fn apart(a: &Run, b: &Run) -> f64 {
    let nodes = (0..=12).map(|k| distance(a.fields[0].position(k), b.fields[0].position(k)));
    nodes.fold(0.0, f64::max)
}

const STEADY: &str = "[{ time = 0, factor = 1 }]";
/// Full until 8 s, then nothing.
const TURNED_OFF: &str =
    "[{ time = 0, factor = 1 }, { time = 8, factor = 1 }, { time = 8, factor = 0 }]";

#[test]
fn both_integrators_reach_the_same_motion() {
    let accurate = StepControl::Adaptive {
        accuracy: 1e-9,
        min: 1e-4,
        max: 0.5,
    };
    let alpha = towed_pipe(ALPHA, accurate, STEADY);
    let bdf = towed_pipe(BDF, accurate, STEADY);
    // Steps of 1e-9 of 200 m each: some thousand steps add up to a few times 0.1 mm at worst.
    assert!(apart(&alpha, &bdf) < 2e-4, "{} m", apart(&alpha, &bdf));
    for channel in ["pipe.end_a.effective_tension", "pipe.end_a.force_y"] {
        let (low, high) = alpha.range_since(channel, 0.0);
        for (found, expected) in bdf.history(channel).iter().zip(alpha.history(channel)) {
            // A thousandth of the swing: axial vibrations are the last to settle.
            assert_near(channel, *found, *expected, 1e-3 * (high - low));
        }
    }
    let orders = bdf.report.statistics.steps_of_order;
    assert_eq!(orders.iter().sum::<usize>(), bdf.report.statistics.steps);
    assert_eq!(orders[2..], [0, 0, 0]);
    assert_eq!(
        alpha.report.statistics.steps_of_order[1],
        alpha.report.statistics.steps
    );
}

#[test]
fn both_keep_second_order_across_a_jump_of_the_current() {
    for integrator in [ALPHA, BDF] {
        let at = |step: f64| towed_pipe(integrator, StepControl::Fixed(step), TURNED_OFF);
        let fine = at(0.1 / 16.0);
        let errors = [0.1, 0.05, 0.025].map(|step| apart(&at(step), &fine));
        let order = (errors[0] / errors[1])
            .log2()
            .min((errors[1] / errors[2]).log2());
        assert!(order > 1.8, "{integrator:?}: {errors:?}, order {order}");
    }
}
