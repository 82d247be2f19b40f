//! The sea trial by beam elements, held against discrete elements.

mod common;

use catenix_model::FormulationKind;
use common::sea_trial::{SEA_TRIAL, assert_close, both, graded};

/// Elements of 10 and 2 m leave bends of 0.8 m at the hose's ends and floats unresolved; cubics
/// follow them well, and the connectors of discrete elements know them.
#[test]
fn the_sea_trial_agrees_with_discrete_elements() {
    for case in ["a", "d"] {
        let figures = both(SEA_TRIAL, case, FormulationKind::Fem);
        assert_close(case, &figures, 0.002, 0.002, 0.002);
    }
}

/// The same with helices in place of cubics.
#[test]
fn the_sea_trial_by_geometrically_exact_elements_agrees_with_discrete_elements() {
    for case in ["a", "d"] {
        let figures = both(SEA_TRIAL, case, FormulationKind::FemExact);
        assert_close(case, &figures, 0.002, 0.002, 0.002);
    }
}

/// Where these bends are resolved, the pipe's elements of 10 m are what is left.
#[test]
fn on_a_graded_mesh_the_force_on_the_miner_agrees() {
    for case in ["a", "d"] {
        let figures = both(&graded(), case, FormulationKind::Fem);
        assert_close(case, &figures, 0.002, 0.002, 0.002);
    }
    let figures = both(&graded(), "d", FormulationKind::FemExact);
    assert_close("d", &figures, 0.002, 0.002, 0.002);
}
