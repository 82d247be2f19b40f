//! Bodies that nothing holds, and bodies that are spun up: momentum, energy, and published motions.

// A panic is how a test fails, in its helpers too.
#![allow(clippy::unwrap_used)]

mod common;

use std::f64::consts::PI;
use std::fmt::Write;
use std::ops::ControlFlow;
use std::path::Path;

use catenix_engine::{StepView, System, simulate, solve_statics};
use catenix_model::file::parse_study;
use common::model;

/// The "flying spaghetti" of J. C. Simo and L. Vu-Quoc, "On the dynamics in space of rods undergoing
/// large motions", Computer Methods in Applied Mechanics and Engineering 66 (1988) 125-161: a free
/// beam of length 10, EA = GA = 1e4, EI = 500, rho A = 1, rho I = 10, at rest from (6, 0, 0) to
/// (0, 8, 0); its lower end is loaded by a force of 8 along x and a moment of -80 about z, both
/// rising to 2.5 s and gone at 5 s. In space a second moment makes it leave the plane.
fn flying_spaghetti(moment: [f64; 3], elements: usize, step: f64, duration: f64) -> String {
    let [mx, my, mz] = moment;
    format!(
        r#"
        title = "Flying spaghetti"
        environment.gravity = 0
        [line_types.beam]
        kind = "general"
        outer_diameter = "0.1 m"
        mass = "1 kg/m"
        axial_stiffness = "10 kN"
        shear_stiffness = "10 kN"
        bending_stiffness = "500 N m^2"
        torsional_stiffness = "500 N m^2"
        polar_inertia = "10 kg m"
        rotary_inertia = "10 kg m"
        [lines.beam]
        sections = [{{ type = "beam", length = "10 m", elements = {elements} }}]
        start_shape = [["6 m", 0, 0], [0, "8 m", 0]]
        [loads.pulse]
        on = "beam"
        at = "0 m"
        force = ["8 N", 0, 0]
        moment = [{mx:?}, {my:?}, {mz:?}]
        factor = [{{ time = "0 s", factor = 0 }}, {{ time = "2.5 s", factor = 1 }}, {{ time = "5 s", factor = 0 }}]
        [statics]
        equilibrium = false
        [dynamics]
        duration = {duration:?}
        step = {step:?}
        spectral_radius = 1
        tolerance = 1e-12
        [output]
        interval = 0.5
        "#
    )
}

/// Drift after the load has ended, over the values then: linear and angular momentum and energy.
fn drift(text: &str, since: f64) -> [f64; 3] {
    let model = model(text);
    let system = System::new(&model).unwrap();
    let start = solve_statics(&system, &mut |_| ControlFlow::Continue(())).unwrap();
    let mut reference = None;
    let mut drift = [0.0f64; 3];
    simulate(&system, &start, &mut |view: &StepView<'_>| {
        if view.time() >= since - 1e-9 {
            let (momentum, energy) = (view.momentum(), view.energy().stored());
            let (first, start_energy) = *reference.get_or_insert((momentum, energy));
            let change = [
                (momentum.linear - first.linear).norm() / first.linear.norm(),
                (momentum.angular - first.angular).norm() / first.angular.norm(),
                (energy - start_energy).abs() / start_energy,
            ];
            for (largest, change) in drift.iter_mut().zip(change) {
                *largest = largest.max(change);
            }
        }
        ControlFlow::Continue(())
    })
    .unwrap();
    drift
}

#[test]
fn val_simo_vu_quoc_1988_flying_spaghetti_keeps_momentum_and_energy() {
    let plane = [0.0, 0.0, -80.0];
    let space = [0.0, -100.0, -80.0];
    for moment in [plane, space] {
        let [coarse, fine] =
            [0.05, 0.025].map(|step| drift(&flying_spaghetti(moment, 20, step, 15.0), 5.0));
        for (name, k) in [("angular momentum", 1), ("energy", 2)] {
            let (coarse, fine) = (coarse[k], fine[k]);
            // Undamped generalised-alpha is of second order in both; the drift is of the motion
            // after the load, whose stiffest parts are the axial waves of the elements.
            assert!(
                fine < 1e-4 && coarse / fine > 3.2,
                "{name}: drift {coarse:.2e} at 0.05 s and {fine:.2e} at 0.025 s"
            );
        }
        // Kept by the method itself, to what Newton's method leaves: 1e-12 of the load per step.
        assert!(
            coarse[0].max(fine[0]) < 1e-9,
            "linear momentum: {coarse:?}, {fine:?}"
        );
    }
}

#[test]
fn the_pulse_gives_its_impulse() {
    let text = flying_spaghetti([0.0, 0.0, -80.0], 10, 0.025, 5.0);
    let model = model(&text);
    let system = System::new(&model).unwrap();
    let start = solve_statics(&system, &mut |_| ControlFlow::Continue(())).unwrap();
    let mut last = None;
    let report = simulate(&system, &start, &mut |view: &StepView<'_>| {
        last = Some(view.momentum().linear);
        ControlFlow::Continue(())
    })
    .unwrap();
    // Half of 5 s times 8 N. Steps end on the kinks of the pulse, and the trapezoidal rule that
    // the undamped method amounts to is exact between them.
    let expected = [20.0, 0.0, 0.0];
    for (k, expected) in expected.into_iter().enumerate() {
        common::assert_near("impulse", last.unwrap()[k], expected, 1e-9);
    }
    let energy = report.energy;
    assert!(energy.work_loads_j > 50.0, "{energy:?}");
    // Second order in the step; 5e-6 at half of it.
    assert!(energy.imbalance.abs() < 1e-4, "{energy:?}");
}

/// Kane, Ryan and Banerjee 1987, "Dynamics of a cantilever beam attached to a moving base", as
/// Simo and Vu-Quoc 1986 give its numbers: EA = 2.8e7, GA = 1e7, EI = 1.4e4, rho A = 1.2,
/// rho I = 6e-4, length 10; spun up to 6 rad/s in 15 s.
fn spin_up(elements: usize) -> String {
    format!(
        r#"
        title = "Spin-up"
        environment.gravity = 0
        [line_types.beam]
        kind = "general"
        outer_diameter = "0.05 m"
        mass = "1.2 kg/m"
        axial_stiffness = "28 MN"
        shear_stiffness = "10 MN"
        bending_stiffness = "14 kN m^2"
        rotary_inertia = "6e-4 kg m"
        [motions.spin]
        kind = "history"
        file = "spin_up.csv"
        [vessels.hub]
        position = [0, 0, 0]
        motions = ["spin"]
        [lines.beam]
        sections = [{{ type = "beam", length = "10 m", elements = {elements} }}]
        end_a = {{ to = "hub", joint = "fixed", direction = [1, 0, 0] }}
        [dynamics]
        duration = "20 s"
        step = "0.01 s"
        [output]
        interval = "0.05 s"
        channels = ["beam.x@10 m", "beam.y@10 m"]
        "#
    )
}

/// Angle of the hub [rad]: the integral of omega(t) = (6/15) (t - (15/2 pi) sin(2 pi t/15)) up to
/// 15 s, and of 6 rad/s after that.
fn hub_angle(time: f64) -> f64 {
    let k = 2.0 * PI / 15.0;
    if time < 15.0 {
        0.4 * (0.5 * time * time + ((k * time).cos() - 1.0) / (k * k))
    } else {
        6.0 * time - 45.0
    }
}

#[test]
fn val_kane_1987_spin_up() {
    // Beyond the end of the run, because a history ends at rest.
    let mut csv = "time_s,yaw_deg\n".to_owned();
    for k in 0..=600 {
        let time = 0.05 * k as f64;
        let _ = writeln!(csv, "{time},{}", hub_angle(time).to_degrees());
    }
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("spin_up");
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("spin_up.csv"), csv).unwrap();
    let mut study = parse_study(&spin_up(20), "spin_up.toml", &folder).unwrap();
    study.cases[0].model.output.interpolate = false;
    let run = common::run(&study.cases[0].model);
    let tip = run.fields[0].position(20);
    let extension = tip[0].hypot(tip[1]) - 10.0;
    // Steady stretch of a rod in rotation, u = L (tan(a) / a - 1) with a = omega L sqrt(rho A/EA):
    // 5.1432e-4. The chain's sum over 20 elements is off by 1 / 8 N^2 of it, 3e-4; what is left of
    // the bending vibration shortens the tip's distance by 1e-7 at most.
    let a = 6.0 * 10.0 * (1.2f64 / 2.8e7).sqrt();
    let exact = 10.0 * (a.tan() / a - 1.0);
    common::assert_near("closed form", exact, 5.1432e-4, 1e-8);
    common::assert_near("tip", extension, exact, 1e-3 * exact);
    // The largest lag of the tip behind the hub, 0.57 to 0.58 in the published curves.
    let worst = run
        .time
        .iter()
        .zip(
            run.history("beam.y@10m")
                .iter()
                .zip(run.history("beam.x@10m")),
        )
        .map(|(&time, (&y, &x))| {
            let (sin, cos) = hub_angle(time).sin_cos();
            -x * sin + y * cos
        })
        .fold(0.0, f64::min);
    common::assert_near("lag", worst, -0.575, 0.006);
}
