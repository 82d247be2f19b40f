//! Quantities of whole lines, several nodes at a time, against those of single nodes.

use std::path::Path;

use catenix_model::file::parse_study;
use catenix_model::{FormulationKind, LineQuantity, Model};
use catenix_numerics::{ImplicitSystem, MotionState, Vector6};

use super::tangent_test::noisy;
use super::view::StepView;
use super::{System, SystemSolver};

/// Lines with and without a wall, of one type and of several, with and without bending and
/// torsional stiffness; more elements than lanes, and fewer.
const MODEL: &str = r#"
title = "quantities"
[environment]
water.depth = "100 m"
[line_types.pipe]
kind = "pipe"
outer_diameter = "0.3 m"
inner_diameter = "0.25 m"
density = "7850 kg/m^3"
youngs_modulus = "206 GPa"
content_density = "1100 kg/m^3"
structural_damping = "0.02 s"
[line_types.thick]
kind = "pipe"
outer_diameter = "0.3 m"
inner_diameter = "0 m"
density = "7850 kg/m^3"
youngs_modulus = "206 GPa"
[line_types.hose]
kind = "general"
outer_diameter = "0.2 m"
mass = "57 kg/m"
axial_stiffness = "5 MN"
bending_stiffness = "10 kN m^2"
structural_damping = "0.02 s"
[line_types.rope]
kind = "general"
outer_diameter = "0.1 m"
mass = "20 kg/m"
axial_stiffness = "5 MN"
[vessels.ship]
position = ["0 m", "0 m", "0 m"]
[anchors.anchor]
position = ["70 m", "0 m", "-80 m"]
[lines.riser]
sections = [
    { type = "pipe", length = "40 m", elements = 21 },
    { type = "thick", length = "30 m", elements = 9 },
    { type = "hose", length = "40 m", elements = 11 },
]
end_a = { to = "ship", joint = "fixed", direction = ["0", "0", "-1"] }
end_b = { to = "anchor", joint = "ball" }
[lines.short]
sections = [{ type = "hose", length = "110 m", elements = 3 }]
end_a = { to = "ship", joint = "ball" }
end_b = { to = "anchor", joint = "ball" }
[lines.mooring]
sections = [{ type = "rope", length = "110 m", elements = 30 }]
end_a = { to = "ship", joint = "ball" }
end_b = { to = "anchor", joint = "ball" }
[statics]
[dynamics]
duration = "1 s"
step = "0.1 s"
"#;

fn model(formulation: FormulationKind) -> Model {
    let mut study = parse_study(MODEL, "quantities.toml", Path::new("."))
        .map_err(|errors| errors.to_string())
        .unwrap();
    Model {
        formulation,
        ..study.cases.remove(0).model
    }
}

#[test]
fn lines_as_a_whole_have_the_quantities_of_their_nodes() {
    for formulation in FormulationKind::ALL {
        let system = System::new(&model(formulation)).unwrap();
        let n = system.frame_count();
        let mut state = MotionState::at_rest(system.first_shape().clone());
        state.configuration.retract(&noisy(n, 1, 0.02, 0.05));
        state.velocity = noisy(n, 1000, 0.3, 0.2);
        let mut solver = SystemSolver::moving(&system);
        let mut residual = vec![Vector6::zeros(); n];
        solver.begin();
        solver.assemble(0.3, &state, None, &mut residual);
        let view = StepView {
            solver: &solver,
            state: &state,
            time: 0.3,
            step: 0.1,
            at_output_time: true,
            at_field_time: true,
        };
        for (line, layout) in system.lines.iter().enumerate() {
            let nodes = layout.element_count + 1;
            let mut rows = vec![f64::NEG_INFINITY; nodes * LineQuantity::ALL.len()];
            view.line_quantities(line, &mut rows);
            for quantity in LineQuantity::ALL {
                let found = &rows[quantity.index() * nodes..][..nodes];
                let wanted: Vec<f64> = (0..nodes)
                    .map(|node| view.quantities(line, node)[quantity.index()])
                    .collect();
                let size = wanted.iter().filter(|v| v.is_finite());
                let size = size.fold(0.0, |a: f64, b| a.max(b.abs()));
                for (node, (found, wanted)) in found.iter().zip(&wanted).enumerate() {
                    // Rounding: shear forces and torques are small differences of large numbers.
                    let close = (found - wanted).abs() <= 1e-11 * size + 1e-7;
                    assert!(
                        close || found.is_nan() && wanted.is_nan(),
                        "{} {line} {node} {}: {found} and {wanted}",
                        formulation.word(),
                        quantity.name(),
                    );
                }
            }
        }
    }
}
