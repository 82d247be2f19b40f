//! The whole iteration matrix against central differences of the whole residual.

use std::path::Path;

use catenix_model::file::parse_study;
use catenix_model::{FormulationKind, LoadPlace, Model, NaturalShape};
use catenix_numerics::{ImplicitSystem, Matrix3, MotionState, TangentWeights, Vector6, so3};

use super::{System, SystemSolver};
use crate::formulation::Situation;

/// Every kind of load and connection in one model: surface, seabed, sheared current, lumps,
/// unlike neighbours, all joints, sliding ends, a loop over two bodies, structural damping, shear
/// flexibility, point loads that stay and that follow.
const MODEL: &str = r#"
title = "everything"
[environment]
water.depth = "12 m"
water.density = "1025 kg/m^3"
[environment.current]
profile = [{ depth = "0 m", speed = "1.2 m/s" }, { depth = "12 m", speed = "0.3 m/s", heading = "70 deg" }]
[environment.seabed]
normal_stiffness = "20 kPa"
[line_types.soft]
kind = "general"
outer_diameter = "0.3 m"
mass = "90 kg/m"
axial_stiffness = "2 MN"
bending_stiffness = "20 kN m^2"
torsional_stiffness = "10 kN m^2"
shear_stiffness = "1 MN"
structural_damping = "0.03 s"
axial_drag = 0.05
axial_added_mass = 0.1
[line_types.stiff]
kind = "general"
outer_diameter = "0.25 m"
mass = "60 kg/m"
axial_stiffness = "5 MN"
bending_stiffness = "60 kN m^2"
[line_types.strip]
kind = "general"
outer_diameter = "0.25 m"
mass = "60 kg/m"
axial_stiffness = "5 MN"
bending_stiffness_y = "60 kN m^2"
bending_stiffness_z = "20 kN m^2"
structural_damping = "0.02 s"
[line_types.yielding]
kind = "general"
outer_diameter = "0.25 m"
mass = "60 kg/m"
axial_law = [{ strain = -0.01, tension = "-20 kN" }, { strain = 0.002, tension = "8 kN" }, { strain = 0.05, tension = "60 kN" }]
bending_law = [{ curvature = 0.05, moment = "3 kN m" }, { curvature = 0.2, moment = "5 kN m" }]
[vessels.ship]
position = ["0 m", "0 m", "0 m"]
motions = ["roll"]
[motions.roll]
kind = "harmonic"
degree = "roll"
amplitude = "5 deg"
period = "6 s"
[anchors.anchor]
position = ["14 m", "3 m", "-11.9 m"]
[bodies.buffer]
mass = "900 kg"
volume = "0.4 m^3"
length = "1.5 m"
centre_of_buoyancy = ["0.05 m", "0 m", "0.2 m"]
normal_drag_area = "1 m^2"
axial_drag_area = "0.4 m^2"
normal_added_mass = "300 kg"
axial_added_mass = "50 kg"
[bodies.buoy]
mass = "300 kg"
volume = "0.6 m^3"
length = "1 m"
drag_area = "1 m^2"
added_mass = "100 kg"
initial_position = ["6 m", "1 m", "-0.1 m"]
[lines.riser]
sections = [{ type = "soft", length = "4 m", elements = 2 }, { type = "stiff", length = "4 m", elements = 3 }]
attachments.float = { at = "2 m", mass = "30 kg", net_lift = "400 N", drag_area = "0.3 m^2", added_mass = "20 kg" }
attachments.pump = { at = "4.9 m", mass = "80 kg", volume = "0.02 m^3", drag_area = "0.1 m^2" }
end_a = { to = "ship", joint = "ball", at = ["0.3 m", "0 m", "0 m"], rotational_stiffness = "3 kN m/rad" }
end_b = { to = "buffer", joint = "fixed", at = ["0 m", "0 m", "0.75 m"] }
[lines.hose]
sections = [{ type = "soft", length = "16 m", elements = 4 }]
end_a = { to = "buffer", joint = "hinge", at = ["0.1 m", "0 m", "-0.75 m"] }
end_b = { to = "anchor", joint = "universal", direction = [1, 0, 0] }
[lines.tether]
sections = [{ type = "stiff", length = "9 m", elements = 3 }]
end_a = { to = "buffer", joint = "ball", at = ["0.2 m", "0 m", "0 m"] }
end_b = { to = "buoy", joint = "universal", at = ["0 m", "0 m", "-0.5 m"], direction = [0, 0, 1] }
[lines.tail]
sections = [{ type = "soft", length = "2 m", elements = 1 }]
end_a = { to = "buoy", joint = "fixed", at = ["0.5 m", "0 m", "0 m"], direction = [1, 0, 0] }
[lines.guyed]
sections = [{ type = "soft", length = "6 m", elements = 2 }]
end_a = { to = "ship", joint = "fixed", direction = [0, 1, 0], slides_along = [1, 2, 0.5] }
end_b = { to = "buoy", joint = "hinge", direction = [0, 1, 0], slides_along = [0.3, 1, -0.4] }
[lines.strut]
sections = [{ type = "stiff", length = "5 m", elements = 2 }]
end_a = { to = "anchor", joint = "universal", direction = [1, 0, 1], slides_along = [0, 1, 0.2] }
end_b = { to = "buffer", joint = "fixed", at = ["0.1 m", 0, 0], direction = [1, 0, 1], slides_along = [0, 0, 1] }
[loads.still]
on = "riser"
at = "4 m"
force = ["2 kN", "-1 kN", "3 kN"]
moment = ["1 kN m", "2 kN m", 0]
harmonic = { angular_frequency = "2 rad/s", phase = "20 deg", ramp = "1 s" }
[loads.follower]
on = "hose"
at = "16 m"
force = [0, "4 kN", "1 kN"]
moment = ["1 kN m", "-2 kN m", "3 kN m"]
follows = true
[loads.pull]
on = "buffer"
point = ["0.3 m", "0.1 m", "0.7 m"]
force = ["5 kN", 0, "2 kN"]
factor = [{ time = 0, factor = 0.5 }, { time = 1, factor = 2 }]
[loads.push]
on = "buoy"
point = [0, "0.4 m", 0]
force = [0, "5 kN", "2 kN"]
moment = ["1 kN m", 0, 0]
follows = true
[lines.whip]
sections = [{ type = "strip", length = "4 m", elements = 2, natural_curvature_y = 0.1, natural_curvature_z = -0.05, natural_twist = "8 deg/m" }, { type = "yielding", length = "4 m", elements = 3, natural_curvature_z = 0.1 }]
end_a = { to = "ship", joint = "fixed", at = ["0 m", "4 m", "-2 m"], axis = [0, 1, 0] }
end_b = { to = "buffer", joint = "hinge", at = ["0.1 m", "0.2 m", "0.75 m"] }
[lines.goose]
sections = [{ type = "strip", length = "6 m", elements = 3, natural_curvature_y = 0.3 }]
end_a = { to = "buffer", joint = "ball", at = ["0.1 m", "0.2 m", "0.75 m"], direction = [0, 0, 1], rotational_stiffness = "5 kN m/rad" }
[dynamics]
duration = "1 s"
"#;

fn noise(seed: usize) -> f64 {
    let x = (seed as f64 * 12.9898).sin() * 43758.5453;
    2.0 * (x - x.floor()) - 1.0
}

pub(crate) fn noisy(n: usize, seed: usize, translation: f64, rotation: f64) -> Vec<Vector6> {
    (0..n)
        .map(|k| {
            Vector6::from_fn(|row, _| {
                let size = if row < 3 { translation } else { rotation };
                size * noise(seed + 6 * k + row)
            })
        })
        .collect()
}

fn everything() -> Model {
    let study = parse_study(MODEL, "everything.toml", Path::new(".")).unwrap();
    study.cases[0].model.clone()
}

/// What lumped mass can do of it: round straight sections without shear flexibility, and no
/// moments on lines.
fn everything_lumped() -> Model {
    let mut model = everything();
    model.formulation = FormulationKind::Lumped;
    let laws = model
        .line_types
        .iter()
        .find_map(|own| own.bending_law.clone());
    for own in &mut model.line_types {
        own.shear_stiffness = None;
        own.bending_stiffness[1] = own.bending_stiffness[0];
        if own.name == "strip" {
            own.bending_law.clone_from(&laws);
        }
    }
    for line in &mut model.lines {
        for section in &mut line.sections {
            section.natural = NaturalShape::default();
        }
    }
    for load in &mut model.loads {
        if matches!(load.place, LoadPlace::Line { .. }) {
            load.moment = [0.0; 3];
            load.follows = false;
        }
    }
    model
}

#[test]
fn iteration_matrix_matches_finite_differences() {
    check(&everything(), 0);
}

#[test]
fn iteration_matrix_of_lumped_mass_matches_finite_differences() {
    // Each line has an idle point at most.
    check(&everything_lumped(), 9);
}

/// Calls `use_it` for the system with everything in it, out of balance and moving.
pub(crate) fn moving_system(use_it: impl Fn(&Situation<'_>, &TangentWeights<'_>)) {
    let system = System::new(&everything()).unwrap();
    let n = system.frame_count();
    let mut state = MotionState::at_rest(system.first_shape().clone());
    state.configuration.retract(&noisy(n, 1, 0.05, 0.1));
    state.configuration.position[system.lines[1].frames().end - 1].z = -12.05;
    state.velocity = noisy(n, 1000, 0.8, 0.3);
    state.acceleration = noisy(n, 2000, 2.0, 1.0);
    let turn = |d: &Vector6| so3::left_jacobian_inverse(&d.fixed_rows::<3>(3).into());
    let turns: Vec<Matrix3> = noisy(n, 3000, 0.0, 0.2).iter().map(turn).collect();
    let weights = TangentWeights {
        velocity: 4.0,
        acceleration: 30.0,
        rotation: Some(&turns),
    };
    let solver = SystemSolver::moving(&system);
    use_it(&solver.situation(0.7, &state), &weights);
}

#[test]
fn iteration_matrix_of_beam_elements_matches_finite_differences() {
    for formulation in [FormulationKind::Fem, FormulationKind::FemExact] {
        let model = Model {
            formulation,
            ..everything()
        };
        check(&model, 0);
    }
}

/// Compares all columns but those of points that move nothing, of which there may be so many.
fn check(model: &Model, most_idle: usize) {
    let system = System::new(model).unwrap();
    let n = system.frame_count();
    let pairs = system.pair_count();
    let mut state = MotionState::at_rest(system.first_shape().clone());
    state.configuration.retract(&noisy(n, 1, 0.05, 0.1));
    // The last element of the hose lies on the seabed.
    let last = system.lines[1].frames().end - 1;
    state.configuration.position[last].z = -12.05;
    if let Some(second) = state.configuration.second.get_mut(last) {
        second.z = -12.05;
    }
    state.velocity = noisy(n, 1000, 0.8, 0.3);
    state.acceleration = noisy(n, 2000, 2.0, 1.0);
    let turns: Vec<Matrix3> = (0..n)
        .map(|k| match k < pairs {
            true => Matrix3::identity(),
            false => {
                so3::left_jacobian_inverse(&noisy(n, 3000, 0.0, 0.2)[k].fixed_rows::<3>(3).into())
            }
        })
        .collect();
    let weights = TangentWeights {
        velocity: 4.0,
        acceleration: 30.0,
        rotation: Some(&turns),
    };
    let time = 0.7;

    let mut solver = SystemSolver::moving(&system);
    let mut residual = vec![Vector6::zeros(); n];
    solver.begin();
    solver.assemble(time, &state, Some(&weights), &mut residual);
    let reference = solver.clone();
    let h = 1e-6;
    let places = state
        .configuration
        .position
        .iter()
        .chain(&state.configuration.second);
    let heights: Vec<f64> = places.map(|place| place.z).collect();
    let mut idle = 0;
    for k in 0..n {
        for row in 0..6 {
            let mut unit = vec![Vector6::zeros(); n];
            unit[k][row] = 1.0;
            let mut at = |sign: f64| {
                let mut moved = state.clone();
                let d: Vec<Vector6> = unit.iter().map(|d| d * (h * sign)).collect();
                moved.configuration.retract(&d);
                let mut rate = d[k];
                let turned = turns[k] * d[k].fixed_rows::<3>(3);
                rate.fixed_rows_mut::<3>(3).copy_from(&turned);
                moved.velocity[k] += rate * weights.velocity;
                moved.acceleration[k] += rate * weights.acceleration;
                let mut residual = vec![Vector6::zeros(); n];
                solver.assemble(time, &moved, None, &mut residual);
                residual
            };
            let (plus, minus) = (at(1.0), at(-1.0));
            if k < pairs && plus == minus {
                idle += 1;
                continue;
            }
            let mut exact = vec![Vector6::zeros(); n];
            reference
                .matrix
                .subtract_times(&system.topology, &unit, &mut exact);
            for other in 0..n {
                let numeric = (plus[other] - minus[other]) / (2.0 * h);
                let error = (exact[other] + numeric).norm();
                assert!(
                    error < 2e-6 * (1e4 + numeric.norm()),
                    "d residual of {} by component {row} of {}: {} instead of {numeric}",
                    system.owner(other),
                    system.owner(k),
                    -exact[other],
                );
            }
        }
    }
    assert!(idle <= 3 * most_idle, "{idle} components move nothing");
    assert!(
        heights.iter().any(|z| z.abs() < 0.2),
        "the model must meet the surface"
    );
    assert!(
        heights.iter().any(|z| *z < -12.0),
        "the model must meet the seabed"
    );
}
