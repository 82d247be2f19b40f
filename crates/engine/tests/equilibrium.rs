//! An equilibrium that load cases have in common is the one that each would find by itself.

// A panic is how a test fails.
#![allow(clippy::unwrap_used)]

use std::ops::ControlFlow;

use catenix_engine::{Equilibrium, StaticSolution, System, simulate, solve_statics};
use catenix_model::{LineQuantity, Model};
use common::model_of_case;
use common::sea_trial::SEA_TRIAL;

mod common;

fn solve(system: &System) -> StaticSolution<'_> {
    solve_statics(system, &mut |_| ControlFlow::Continue(())).unwrap()
}

/// Static results along both lines, and the buffer's position at the end of the motion.
fn results(model: &Model, start: &StaticSolution<'_>, system: &System) -> Vec<u64> {
    let mut all = Vec::new();
    for (line, own) in model.lines.iter().enumerate() {
        let nodes = own.element_count() + 1;
        let mut values = vec![0.0; nodes * LineQuantity::ALL.len()];
        start.view().line_quantities(line, &mut values);
        all.extend(values);
    }
    simulate(system, start, &mut |view| {
        all.push(view.tension_range(0).1);
        ControlFlow::Continue(())
    })
    .unwrap();
    // A stress where there is no wall is no number, always the same one.
    all.into_iter().map(f64::to_bits).collect()
}

/// A case of the sea trial on a coarse mesh, for a short while.
fn case(name: &str) -> Model {
    let text = SEA_TRIAL
        .replace("elements = 90 ", "elements = 12 ")
        .replace("elements = 200 ", "elements = 25 ")
        .replace("duration = \"320 s\"", "duration = \"16 s\"")
        .replace("duration = \"160 s\"", "duration = \"16 s\"");
    model_of_case(&text, name)
}

#[test]
fn cases_that_differ_in_motion_and_current_share_their_equilibrium() {
    let (first, second) = (case("a"), case("e"));
    assert_ne!(first.environment.current, second.environment.current);
    let systems = [&first, &second].map(|model| System::new(model).unwrap());
    let kept = Equilibrium::new(&solve(&systems[0]));
    let (own, shared) = (solve(&systems[1]), kept.of(&systems[1]).unwrap());
    assert_eq!(
        (own.iterations, own.residual_n, &own.warnings),
        (shared.iterations, shared.residual_n, &shared.warnings)
    );
    assert!(results(&second, &own, &systems[1]) == results(&second, &shared, &systems[1]));
}

#[test]
fn what_statics_sees_is_not_shared() {
    let first = case("a");
    let system = System::new(&first).unwrap();
    let kept = Equilibrium::new(&solve(&system));
    assert!(kept.of(&system).is_some());
    let changes: [fn(&mut Model); 5] = [
        |model| model.statics.current = true,
        |model| model.environment.gravity *= 1.0 + 1e-15,
        |model| model.vessels[0].position[0] += 1e-9,
        |model| model.bodies[0].mass += 1.0,
        |model| model.lines[0].sections[0].element_lengths[0] += 1e-9,
    ];
    for (index, change) in changes.into_iter().enumerate() {
        let mut model = first.clone();
        change(&mut model);
        assert!(kept.of(&System::new(&model).unwrap()).is_none(), "{index}");
    }
}
