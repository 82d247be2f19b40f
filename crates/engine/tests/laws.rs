//! Laws of mechanics, and of arithmetic: rotation, mirroring, energy, action and reaction, and the
//! same bits every time.

mod common;

use std::f64::consts::PI;

use catenix_model::{LineQuantity, Model, Motion, StepControl};
use common::{Fields, G, Run, WATER, assert_near, distance, model, run, statics};

/// A small mining system: ship, pipe, buffer, hose with a float, miner, current, motion. The whole
/// of it can be turned about z.
fn small_system(turn_deg: f64, current_deg: f64) -> Model {
    let (sin, cos) = turn_deg.to_radians().sin_cos();
    let place = |x: f64, y: f64, z: f64| {
        format!("[{:?}, {:?}, {z:?}]", cos * x - sin * y, sin * x + cos * y)
    };
    model(&format!(
        r#"
        [environment]
        water.depth = "300 m"
        current.heading = "{current} deg"
        current.profile = [{{ depth = 0, speed = "0.7 m/s" }}, {{ depth = 150, speed = "0.2 m/s" }}]
        [line_types.pipe]
        kind = "pipe"
        outer_diameter = "0.2 m"
        inner_diameter = "0.16 m"
        content_density = "1025 kg/m^3"
        [line_types.hose]
        kind = "general"
        outer_diameter = "0.2 m"
        mass = "57.7 kg/m"
        axial_stiffness = "5 MN"
        bending_stiffness = "10 kN m^2"
        structural_damping = "0.02 s"
        [motions.tow]
        kind = "tow"
        heading = "{turn_deg} deg"
        speed = "0.5 m/s"
        ramp = "5 s"
        [motions.heave]
        kind = "harmonic"
        degree = "heave"
        amplitude = "2 m"
        period = "8 s"
        [vessels.ship]
        position = {ship}
        heading = "{turn_deg} deg"
        motions = ["tow", "heave"]
        [vessels.miner]
        position = {miner}
        heading = "{turn_deg} deg"
        motions = ["tow"]
        [bodies.buffer]
        mass = "10 t"
        wet_weight = "80 kN"
        length = "3 m"
        drag_area = "3 m^2"
        normal_added_mass = "4 t"
        [lines.pipe]
        sections = [{{ type = "pipe", length = "200 m", elements = 20 }}]
        end_a = {{ to = "ship", at = [1, 2, -1], joint = "universal", direction = [0, 0, -1] }}
        end_b = {{ to = "buffer", joint = "fixed", at = [0, 0, 1.5] }}
        [lines.hose]
        sections = [{{ type = "hose", length = "120 m", elements = 40 }}]
        attachments.float = {{ at = 50, mass = "1 t", net_lift = "12 kN", drag_area = 1 }}
        end_a = {{ to = "buffer", joint = "fixed", at = [0, 0, -1.5] }}
        end_b = {{ to = "miner", joint = "hinge", direction = [0, 0, -1] }}
        [dynamics]
        duration = "20 s"
        [output]
        channels = ["hose.x@60m", "hose.y@60m"]
        "#,
        current = current_deg + turn_deg,
        ship = place(3.0, -2.0, 0.0),
        miner = place(-60.0, 15.0, -290.0),
    ))
}

#[test]
fn a_turned_problem_has_the_turned_solution() {
    let turn = 37.0f64;
    let (straight, turned) = (
        run(&small_system(0.0, 50.0)),
        run(&small_system(turn, 50.0)),
    );
    straight.assert_sound(20.0, 1e-3);
    let (sin, cos) = turn.to_radians().sin_cos();
    // Rounding errors, enlarged by the stiffness of the pipe against its weight.
    for (line, fields) in straight.fields.iter().enumerate() {
        for node in 0..fields.get(LineQuantity::X).len() {
            let [x, y, z] = fields.position(node);
            let expected = [cos * x - sin * y, sin * x + cos * y, z];
            let found = turned.fields[line].position(node);
            assert_near("position", distance(found, expected), 0.0, 1e-8 * 200.0);
        }
    }
    for end in ["pipe.end_a", "pipe.end_b", "hose.end_a", "hose.end_b"] {
        let vector =
            |run: &Run| ["x", "y", "z"].map(|axis| run.last(&format!("{end}.force_{axis}")));
        let [x, y, z] = vector(&straight);
        let expected = [cos * x - sin * y, sin * x + cos * y, z];
        assert_near(end, distance(vector(&turned), expected), 0.0, 1e-8 * 200e3);
    }
}

#[test]
fn opposed_currents_give_mirrored_solutions() {
    let text = |heading: f64| {
        format!(
            r#"
            [environment]
            water.depth = "300 m"
            current.heading = "{heading} deg"
            current.profile = [{{ depth = 0, speed = "0.7 m/s" }}, {{ depth = 150, speed = 0.2 }}]
            [line_types.pipe]
            kind = "pipe"
            outer_diameter = "0.2 m"
            inner_diameter = "0.16 m"
            [motions.heave]
            kind = "harmonic"
            degree = "heave"
            amplitude = "2 m"
            period = "8 s"
            [vessels.ship]
            position = [0, 0, 0]
            motions = ["heave"]
            [lines.pipe]
            sections = [{{ type = "pipe", length = "250 m", elements = 25 }}]
            end_a = {{ to = "ship", joint = "fixed" }}
            [dynamics]
            duration = "20 s"
            "#
        )
    };
    let (with, against) = (run(&model(&text(0.0))), run(&model(&text(180.0))));
    with.assert_sound(20.0, 1e-3);
    for node in 0..=25 {
        let ([x, _, z], [mx, my, mz]) = (
            with.fields[0].position(node),
            against.fields[0].position(node),
        );
        // Rounding errors; sin(180 deg) is 1e-16.
        assert_near(
            "mirrored",
            distance([mx, my, mz], [-x, 0.0, z]),
            0.0,
            1e-8 * 250.0,
        );
    }
    assert!(with.fields[0].position(25)[0] > 1.0, "the current bends it");
}

#[test]
fn end_forces_balance_weight_buoyancy_and_drag() {
    // A hose across a sheared current that turns with depth: drag by hand on every element.
    let text = r#"
        [environment]
        water.depth = "300 m"
        current.profile = [
            { depth = 0, speed = 1, heading = "90 deg" },
            { depth = 200, speed = 0.4, heading = "10 deg" },
        ]
        [line_types.hose]
        kind = "general"
        outer_diameter = "0.3 m"
        mass = "110 kg/m"
        axial_stiffness = "20 MN"
        bending_stiffness = "20 kN m^2"
        normal_drag = 1.1
        axial_drag = 0.03
        [anchors.left]
        position = [0, 0, -20]
        [anchors.right]
        position = [60, 20, -90]
        [lines.hose]
        sections = [{ type = "hose", length = "180 m", elements = 360 }]
        attachments.clump = { at = 90.25, mass = "500 kg", wet_weight = "4 kN", drag_area = "0.8 m^2" }
        end_a = { to = "left", joint = "fixed" }
        end_b = { to = "right", joint = "fixed", direction = [0, 0, 1] }
    "#;
    let statics = statics(&model(text));
    let current = |z: f64| {
        let share = (-z / 200.0).clamp(0.0, 1.0);
        let (sin, cos) = 10f64.to_radians().sin_cos();
        [share * 0.4 * cos, 1.0 - share + share * 0.4 * sin, 0.0]
    };
    let fields = &statics.fields[0];
    let mut load = [
        0.0,
        0.0,
        -(110.0 - WATER * 0.25 * PI * 0.09) * G * 180.0 - 4e3,
    ];
    for k in 0..360 {
        let (a, b) = (fields.position(k), fields.position(k + 1));
        let length = distance(a, b);
        let axis = [0, 1, 2].map(|i| (b[i] - a[i]) / length);
        let water = current(0.5 * (a[2] + b[2]));
        let along: f64 = (0..3).map(|i| water[i] * axis[i]).sum();
        let across = [0, 1, 2].map(|i| water[i] - along * axis[i]);
        let speed = across.iter().map(|u| u * u).sum::<f64>().sqrt();
        // The clump has the 181st node: elements are 90.25 m / 181 before it, and 89.75 m / 179.
        let own = if k <= 180 {
            90.25 / 181.0
        } else {
            89.75 / 179.0
        };
        let area = 0.5 * WATER * 0.3 * own;
        for i in 0..3 {
            load[i] += area * (1.1 * speed * across[i] + 0.03 * PI * along.abs() * along * axis[i]);
        }
        if k == 180 {
            // At the node between this element and the next.
            let water = current(b[2]);
            let speed = water.iter().map(|u| u * u).sum::<f64>().sqrt();
            for i in 0..3 {
                load[i] += 0.5 * WATER * 0.8 * speed * water[i];
            }
        }
    }
    let (a, b) = (
        statics.vector("hose.end_a.force_"),
        statics.vector("hose.end_b.force_"),
    );
    for i in 0..3 {
        // Elements against chords of nodes, (l / radius)^2 / 24 below 1e-4 of drags of 10 kN; and
        // residuals of 360 elements, 1e-7 of 200 kN each.
        assert_near("balance", a[i] + b[i], load[i], 4.0);
    }
}

/// Without water, damping and algorithmic damping: a heavy line between two hooks is shaken for two
/// seconds and then left alone.
fn free_chain(step: f64) -> Run {
    let mut model = model(
        r#"
        environment.water = { density = 1e-9, depth = "100 m" }
        [line_types.hose]
        kind = "general"
        outer_diameter = "0.1 m"
        mass = "20 kg/m"
        axial_stiffness = "100 kN"
        bending_stiffness = "500 N m^2"
        normal_drag = 0
        axial_drag = 0
        normal_added_mass = 0
        [motions.shake]
        kind = "tow"
        legs = [
            { start = 0, ramp = "1 s", speed = "1 m/s", heading = "60 deg" },
            { start = 1, ramp = "1 s", speed = 0 },
        ]
        [vessels.left]
        position = [0, 0, -10]
        motions = ["shake"]
        [anchors.right]
        position = [15, 0, -10]
        [lines.hose]
        sections = [{ type = "hose", length = "20 m", elements = 12 }]
        end_a = { to = "left" }
        end_b = { to = "right" }
        [dynamics]
        duration = "12 s"
        spectral_radius = 1
        tolerance = 1e-9
        [output]
        interval = "1 s"
        "#,
    );
    if let Some(dynamics) = &mut model.dynamics {
        dynamics.step = StepControl::Fixed(step);
    }
    run(&model)
}

#[test]
fn energy_is_kept_up_to_the_square_of_the_step() {
    let steps = [0.02, 0.01, 0.005];
    let errors = steps.map(|step| {
        let energy = free_chain(step).report.energy;
        assert_eq!(
            [energy.work_drag_j, energy.work_structural_damping_j],
            [0.0, 0.0]
        );
        assert!(energy.kinetic_j > 1.0, "it swings on: {energy:?}");
        energy.imbalance.abs()
    });
    // A drift of a thousandth of all the energy that was moved at 100 steps per second.
    assert!(errors[1] < 1e-3, "{errors:?}");
    for pair in errors.windows(2) {
        // Second order is a factor of 4; what is left of the largest frequencies spoils a little.
        assert!(pair[0] / pair[1] > 3.4, "{errors:?}");
    }
}

#[test]
fn the_energy_account_closes_with_the_square_of_the_step() {
    let imbalance = |step: f64| {
        let mut model = small_system(0.0, 50.0);
        for vessel in &mut model.vessels {
            for motion in &mut vessel.motions {
                // A motion with continuous third derivatives: long ramps.
                if let Motion::Harmonic { ramp, .. } = motion {
                    *ramp = 16.0;
                }
            }
        }
        if let Some(dynamics) = &mut model.dynamics {
            dynamics.step = StepControl::Fixed(step);
            dynamics.tolerance = 1e-9;
        }
        model.output.interval = 0.4;
        let run = run(&model);
        run.report.energy.imbalance.abs()
    };
    let found = [0.2, 0.1, 0.05].map(imbalance);
    assert!(found[1] < 1e-3, "{found:?}");
    assert!(
        found[0] / found[1] > 3.0 && found[1] / found[2] > 3.0,
        "{found:?}"
    );
}

#[test]
fn the_same_bits_every_time_and_in_any_thread() {
    let model = small_system(10.0, 50.0);
    let alone = run(&model);
    let together: Vec<Run> = std::thread::scope(|scope| {
        let handles: Vec<_> = (0..4).map(|_| scope.spawn(|| run(&model))).collect();
        let join = |handle: std::thread::ScopedJoinHandle<'_, Run>| handle.join().expect("it runs");
        handles.into_iter().map(join).collect()
    });
    for other in &together {
        assert_eq!(alone.report, other.report);
        assert_eq!(alone.values, other.values);
        // As bits: stresses of a hose without a wall are NaN.
        let bits = |run: &Run| run.fields.iter().map(Fields::bits).collect::<Vec<_>>();
        assert!(bits(&alone) == bits(other), "the fields differ");
    }
}
