use approx::assert_relative_eq;

use super::*;
use crate::test_systems::{FIXED, Tumbler, assert_pairs_move_like_frames, distance, drive};

/// An integrator whose past are states of the exact motion, `step` apart, oldest first; it starts
/// at the last of them and at the highest order.
fn seeded(max_order: usize, states: &[MotionState], step: f64) -> Bdf {
    let (current, before) = states.split_last().expect("at least one state");
    let mut bdf = Bdf::new(max_order, current.clone());
    for (past, state) in bdf.past.iter_mut().zip(before.iter().rev()) {
        past.configuration.copy_from(&state.configuration);
        past.velocity.clone_from(&state.velocity);
        past.step = step;
    }
    bdf.past_count = before.len().min(bdf.past.len());
    bdf.steps = 10;
    bdf.order = max_order;
    bdf.next_order = max_order;
    bdf.move_chart();
    bdf
}

/// Error after 2 s of a tumbling body in `n` steps of a fixed order; with `stretch` the steps
/// grow and shrink by that share.
fn error_at_order(order: usize, n: usize, stretch: f64) -> f64 {
    let mut system = Tumbler::tied();
    let start = system.start();
    let mean = 2.0 / n as f64;
    // Back in time as well: the past lies before the start.
    let states: Vec<MotionState> = (0..=order)
        .rev()
        .map(|k| system.runge_kutta(&start, -(k as f64) * mean, 400))
        .collect();
    let mut bdf = seeded(order, &states, mean);
    let steps: Vec<f64> = (0..n)
        .map(|k| {
            mean * (1.0 + stretch * (std::f64::consts::TAU * (k as f64 + 0.5) / n as f64).sin())
        })
        .collect();
    let (orders, _) = drive(&mut bdf, &mut system, &steps);
    assert!(orders.iter().all(|&used| used == order), "{orders:?}");
    let exact = system.runge_kutta(&start, steps.iter().sum(), 8000);
    distance(bdf.state(), &exact)
}

#[test]
fn orders_one_to_five_on_rotations_for_constant_and_for_varying_steps() {
    for stretch in [0.0, 0.4] {
        for order in 1..=5 {
            let errors = [80, 160, 320].map(|n| error_at_order(order, n, stretch));
            let observed = (errors[1] / errors[2]).log2();
            // The observed order tends to the true one from either side.
            assert!(
                (observed - order as f64).abs() < 0.2,
                "order {order}, stretch {stretch}: errors {errors:?}, observed {observed}"
            );
        }
    }
}

#[test]
fn starts_at_second_order_from_one_state() {
    let error = |n: usize| {
        let mut system = Tumbler::tied();
        let start = system.start();
        let mut bdf = Bdf::new(2, start.clone());
        drive(&mut bdf, &mut system, &vec![2.0 / n as f64; n]);
        distance(bdf.state(), &system.runge_kutta(&start, 2.0, 8000))
    };
    let errors = [100, 200, 400].map(error);
    let observed = (errors[1] / errors[2]).log2();
    assert!(observed > 1.9, "errors {errors:?}, observed {observed}");
}

#[test]
fn weights_are_the_derivative_of_velocity_and_acceleration() {
    let system = Tumbler::tied();
    let start = system.start();
    let states: Vec<MotionState> = (0..=3)
        .map(|k| system.runge_kutta(&start, 0.3 * f64::from(k), 400))
        .collect();
    let mut bdf = seeded(3, &states, 0.3);
    let times = bdf.times(0.3);
    bdf.prepare(&times);
    let stage = &mut bdf.stage;
    stage.linearise();
    let weights = stage.weights();
    let (velocity, acceleration) = (weights.velocity, weights.acceleration);
    let turn = stage.rotation_weights[0];
    let before = stage.travel[0];
    assert!(before.fixed_rows::<3>(3).norm() > 0.3, "a large rotation");
    let h = 1e-6;
    for column in 0..3 {
        let mut theta = Vector3::zeros();
        theta[column] = h;
        let mut moved = |sign: f64| {
            let old = so3::exp(&before.fixed_rows::<3>(3).into_owned());
            let new = so3::log(&(so3::exp(&(theta * sign)) * old));
            stage.travel[0].fixed_rows_mut::<3>(3).copy_from(&new);
            stage.update();
            let rows = |list: &[Vector6]| -> Vector3 { list[0].fixed_rows::<3>(3).into() };
            (rows(&stage.trial.velocity), rows(&stage.trial.acceleration))
        };
        let (up, down) = (moved(1.0), moved(-1.0));
        // Central differences of numbers of the order of 1 to 100.
        let by_velocity: Vector3 = (up.0 - down.0) / (2.0 * h);
        let by_acceleration: Vector3 = (up.1 - down.1) / (2.0 * h);
        let turned: Vector3 = turn.column(column).into();
        assert_relative_eq!(by_velocity, turned * velocity, epsilon = 1e-7);
        assert_relative_eq!(by_acceleration, turned * acceleration, epsilon = 1e-6);
    }
}

/// Drives with the step that the error asks for; returns the error at the end, the number of
/// steps, and the highest order that was used.
fn controlled(max_order: usize, allowed: f64) -> (f64, usize, usize) {
    let mut system = Tumbler::tied();
    let start = system.start();
    let mut bdf = Bdf::new(max_order, start.clone());
    let settings = StepSettings {
        allowed_error: Some(allowed),
        ..FIXED
    };
    let (mut time, mut size, mut steps, mut highest) = (0.0, 1e-3, 0, 0);
    let end = 5.0;
    while time < end - 1e-9 {
        let step = f64::min(size, end - time);
        let outcome = bdf
            .advance(&mut system, time + step, step, &settings)
            .expect("it converges");
        size = step * outcome.growth.clamp(0.2, 2.0);
        if outcome.local_error > allowed {
            continue;
        }
        bdf.accept();
        time += step;
        steps += 1;
        highest = highest.max(outcome.order);
    }
    let exact = system.runge_kutta(&start, end, 20_000);
    (distance(bdf.state(), &exact), steps, highest)
}

#[test]
fn the_error_follows_what_is_allowed_and_high_orders_take_fewer_steps() {
    let (loose, ..) = controlled(5, 1e-5);
    let (tight, steps, order) = controlled(5, 1e-8);
    // A thousandth of the error per step; errors of all steps add up, so some margin.
    assert!(tight < 1e-2 * loose, "{tight} and {loose}");
    assert!(tight < 1e-4, "{tight}");
    assert!(order >= 4, "order {order}");
    let (_, steps_of_two, _) = controlled(2, 1e-8);
    assert!(2 * steps < steps_of_two, "{steps} and {steps_of_two}");
}

#[test]
fn second_order_only_takes_energy_from_what_it_does_not_resolve() {
    // A spring of 1000 periods per step: A-stable, so it dies out and never grows.
    let mut system = Tumbler {
        stiffness: 1e8,
        ..Tumbler::free()
    };
    let mut state = system.start();
    state.configuration.position[0] = Vector3::zeros();
    state.acceleration[0] = Vector6::zeros();
    state.velocity[0] = Vector6::new(0.0, 1.0, 0.0, 0.0, 0.0, 0.0);
    let first = system.energy(&state);
    let mut bdf = Bdf::new(2, state);
    let mut last = first;
    for k in 1..=20 {
        bdf.advance(&mut system, 0.9 * f64::from(k), 0.9, &FIXED)
            .expect("it converges");
        bdf.accept();
        last = system.energy(bdf.state());
        assert!(last <= first, "step {k}: {last} of {first}");
    }
    assert!(last < 1e-6 * first, "{last} of {first}");
}

#[test]
fn a_step_that_does_not_converge_leaves_the_state_alone() {
    let mut system = Tumbler::tied();
    let state = system.start();
    let mut bdf = Bdf::new(5, state.clone());
    let mut settings = FIXED;
    settings.newton.tolerance_newtons = 0.0;
    settings.newton.max_iterations = 2;
    let failure = bdf.advance(&mut system, 0.1, 0.1, &settings).unwrap_err();
    assert_eq!(failure.iterations, 2);
    assert_eq!(bdf.state(), &state);
}

#[test]
fn pairs_of_points_move_like_frames() {
    assert_pairs_move_like_frames(|state| Box::new(Bdf::new(5, state)));
}
