//! Observed orders of convergence, in the step and in the element length.

mod common;

use std::f64::consts::PI;

use catenix_model::StepControl;
use common::{G, Run, WATER, distance, model, run, statics};

/// Observed order between successive halvings, from their errors.
fn orders(errors: &[f64]) -> Vec<f64> {
    errors
        .windows(2)
        .map(|pair| (pair[0] / pair[1]).log2())
        .collect()
}

/// A pipe of 200 m, swayed and heaved from rest by smooth motions, with one step size all through.
fn swayed_pipe(step: f64) -> Run {
    let mut model = model(
        r#"
        [environment]
        water.depth = "300 m"
        current.profile = [{ depth = 0, speed = "0.5 m/s" }]
        [line_types.pipe]
        kind = "pipe"
        outer_diameter = "0.2 m"
        inner_diameter = "0.16 m"
        content_density = "1025 kg/m^3"
        [motions.sway]
        kind = "harmonic"
        degree = "sway"
        amplitude = "2 m"
        period = "12 s"
        ramp = "24 s"
        [motions.heave]
        kind = "harmonic"
        degree = "heave"
        amplitude = "1 m"
        period = "9 s"
        ramp = "24 s"
        [vessels.ship]
        position = [0, 0, -5]
        motions = ["sway", "heave"]
        [lines.pipe]
        sections = [{ type = "pipe", length = "200 m", elements = 10 }]
        end_a = { to = "ship" }
        [dynamics]
        duration = "24 s"
        # Newton's error must not hide the step's.
        tolerance = 1e-9
        [output]
        interval = "24 s"
        field_interval = "24 s"
        "#,
    );
    if let Some(dynamics) = &mut model.dynamics {
        dynamics.step = StepControl::Fixed(step);
    }
    run(&model)
}

#[test]
fn the_step_is_of_second_order() {
    let fine = swayed_pipe(0.1 / 32.0);
    let of = |error: &dyn Fn(&Run) -> f64| [0.1, 0.05, 0.025].map(|step| error(&swayed_pipe(step)));
    let positions = of(&|run| {
        let nodes =
            (0..=10).map(|k| distance(run.fields[0].position(k), fine.fields[0].position(k)));
        nodes.fold(0.0, f64::max)
    });
    let force = "pipe.end_a.force_y";
    let forces = of(&|run| (run.last(force) - fine.last(force)).abs());
    assert!(
        orders(&positions).iter().all(|&order| order > 1.9),
        "{positions:?}"
    );
    // Forces end in the rounding errors of the stiff connectors: 0.05 N of 70 kN.
    assert!(orders(&forces)[0] > 1.9, "{forces:?}");
}

#[test]
fn a_catenary_is_of_second_order_in_the_element() {
    // The elastic catenary, from its horizontal tension, by bisection on the span.
    let (wet, stiffness) = (20.0 * G - WATER * G * 0.25 * PI * 0.0025, 1e9);
    let along = |tension: f64, s: f64| {
        tension / wet * (s * wet / tension).asinh() + tension * s / stiffness
    };
    let (mut low, mut high) = (1.0, 1e6);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if along(middle, 200.0) < 150.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    let tension = low;
    let height = |s: f64| (tension / wet).hypot(s) + 0.5 * wet * s * s / stiffness;
    let errors = [10, 20, 40, 80].map(|elements| {
        let statics = statics(&model(&format!(
            r#"
            environment.water.depth = "500 m"
            [line_types.chain]
            kind = "general"
            outer_diameter = "0.05 m"
            mass = "20 kg/m"
            axial_stiffness = "1 GN"
            [anchors.left]
            position = [0, 0, -1]
            [anchors.right]
            position = [300, 0, -1]
            [lines.chain]
            sections = [{{ type = "chain", length = "400 m", elements = {elements} }}]
            end_a = {{ to = "left" }}
            end_b = {{ to = "right" }}
            "#
        )));
        let fields = &statics.fields[0];
        // Largest distance of a node from its place on the catenary.
        let errors = (0..=elements).map(|node| {
            let s = 400.0 * node as f64 / elements as f64 - 200.0;
            let place = [
                150.0 + along(tension, s),
                0.0,
                height(s) - height(200.0) - 1.0,
            ];
            distance(fields.position(node), place)
        });
        errors.fold(0.0, f64::max)
    });
    for order in orders(&errors) {
        assert!(order > 1.9, "{errors:?}");
    }
}
