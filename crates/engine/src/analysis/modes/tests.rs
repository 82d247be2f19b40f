//! The eigenvalues of a whole small system against a dense solver, with a mass matrix that is made
//! independently: from the residual's answer to accelerations.

use std::ops::ControlFlow;

use catenix_model::file::parse_study;
use catenix_numerics::ImplicitSystem;
use nalgebra::{DMatrix, SymmetricEigen};

use super::*;
use crate::{solve_statics, system::System};

/// Two bodies, three lines with a clamp, a hinge and balls, a lump, seabed under the tail.
const SYSTEM: &str = r#"
    environment.water = { density = 1025, depth = "40 m" }
    environment.seabed = { normal_stiffness = "20 kPa" }
    environment.current = { profile = [{ depth = 0, speed = 0.3, heading = 0.4 }] }
    [line_types.hose]
    kind = "general"
    outer_diameter = "0.2 m"
    mass = "50 kg/m"
    axial_stiffness = "1 MN"
    bending_stiffness = "20 kN m^2"
    [anchors.ship]
    position = [0, 0, -1]
    [bodies.buffer]
    mass = "4 t"
    volume = "1 m^3"
    normal_added_mass = "2 t"
    initial_position = [0, 0, -12]
    [bodies.miner]
    mass = "3 t"
    volume = "1 m^3"
    initial_position = [0, 0, -30]
    [lines.pipe]
    sections = [{ type = "hose", length = "10 m", elements = 4 }]
    end_a = { to = "ship", joint = "fixed", direction = [0, 0, -1] }
    end_b = { to = "buffer", joint = "ball" }
    attachments.pump = { at = "6 m", mass = "300 kg", volume = "0.1 m^3" }
    [lines.hose]
    sections = [{ type = "hose", length = "16 m", elements = 7 }]
    end_a = { to = "buffer", joint = "fixed", direction = [0, 0, -1] }
    end_b = { to = "miner", joint = "ball" }
    [lines.tail]
    sections = [{ type = "hose", length = "32 m", elements = 8 }]
    end_a = { to = "buffer", joint = "hinge", axis = [0, 1, 0], direction = [0, 0, -1] }
"#;

#[test]
fn modes_of_a_whole_system_are_those_of_a_dense_solver() {
    let study = parse_study(SYSTEM, "test.toml", std::path::Path::new(""));
    let study = study.unwrap_or_else(|errors| panic!("{errors:?}"));
    let system = System::new(&study.cases[0].model).unwrap();
    let statics = solve_statics(&system, &mut |_| ControlFlow::Continue(())).unwrap();
    for added_mass in [true, false] {
        let settings = ModeSettings {
            range: ModeRange::Lowest(40),
            added_mass,
        };
        let found = find_modes(&system, &statics, &settings, &mut |_| {
            ControlFlow::Continue(())
        });
        let found = found.unwrap();
        let exact = dense_eigenvalues(&statics, added_mass);
        for (mode, exact) in found.modes.iter().zip(&exact) {
            // The dense solver mixes scales up to 1e9 rad2/s2; its own round-off decides.
            assert!(
                (mode.omega_squared - exact).abs() < 1e-5 + 1e-6 * exact.abs(),
                "{} instead of {exact}",
                mode.omega_squared
            );
        }
        assert!(found.modes.len() >= 40);
        // The tail stands on the seabed in compression, and its equilibrium is a buckled column's.
        assert!(found.modes[0].kind == ModeKind::Unstable);
        assert!(
            found.warnings[0].contains("unstable"),
            "{:?}",
            found.warnings
        );
    }
}

/// Squared frequencies, ascending.
fn dense_eigenvalues(statics: &StaticSolution<'_>, added_mass: bool) -> Vec<f64> {
    let (mut solver, mut state) = (statics.solver.clone(), statics.state.clone());
    let n = state.configuration.len();
    let topology = &solver.system().topology;
    let stiffness = solver.stiffness(&state).clone();
    let mut k = DMatrix::zeros(6 * n, 6 * n);
    let mut m = DMatrix::zeros(6 * n, 6 * n);
    let mass = solver.mass(&state, added_mass);
    let mut still = vec![Vector6::zeros(); n];
    solver.assemble(0.0, &state, None, &mut still);
    for column in 0..6 * n {
        let mut unit = vec![Vector6::zeros(); n];
        unit[column / 6][column % 6] = 1.0;
        let mut force = vec![Vector6::zeros(); n];
        stiffness.subtract_times(topology, &unit, &mut force);
        let mut inertia_of_unit = vec![Vector6::zeros(); n];
        mass.times(topology, &unit, &mut inertia_of_unit);
        state.acceleration.copy_from_slice(&unit);
        let mut moved = vec![Vector6::zeros(); n];
        solver.assemble(0.0, &state, None, &mut moved);
        state.acceleration.fill(Vector6::zeros());
        for row in 0..6 * n {
            k[(row, column)] = -force[row / 6][row % 6];
            let inertia = moved[row / 6][row % 6] - still[row / 6][row % 6];
            let own = inertia_of_unit[row / 6][row % 6];
            if added_mass {
                // Residuals are known to some 1e-9 N.
                assert!(
                    (inertia - own).abs() < 1e-7 * (1.0 + own.abs()),
                    "{row} {column}"
                );
            }
            m[(row, column)] = own;
        }
    }
    let symmetric = |a: &DMatrix<f64>| (a + a.transpose()) * 0.5;
    let factor = symmetric(&m).cholesky().unwrap().l().try_inverse().unwrap();
    let standard = symmetric(&(&factor * symmetric(&k) * factor.transpose()));
    let eigen = SymmetricEigen::new(standard);
    let mut values: Vec<f64> = eigen.eigenvalues.iter().copied().collect();
    values.sort_by(f64::total_cmp);
    values
}
