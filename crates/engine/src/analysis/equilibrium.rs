//! An equilibrium that several load cases have in common.
//!
//! Load cases often differ only in what moves: current that does not act in statics, motions of
//! vessels, duration. Then their equilibrium is the same to the last bit, and is found once.

use catenix_model::{Environment, Model};
use catenix_numerics::{Configuration, ImplicitSystem, MotionState, Vector6};

use super::statics::StaticSolution;
use crate::body::motion::RigidMotion;
use crate::system::{System, SystemSolver};

/// An equilibrium and what it is the equilibrium of.
#[derive(Debug, Clone)]
pub struct Equilibrium {
    model: Model,
    /// Vessels as they stand at t = 0.
    vessels: Vec<RigidMotion>,
    first_shape: Configuration,
    /// Expected at the nodes of each line (n_lines x n_nodes) [N].
    tensions: Vec<Vec<f64>>,
    state: MotionState,
    iterations: usize,
    residual_n: f64,
    warnings: Vec<String>,
}

impl Equilibrium {
    /// Keeps a solution.
    pub fn new(solution: &StaticSolution<'_>) -> Equilibrium {
        let system = solution.solver.system();
        Equilibrium {
            model: system.model().clone(),
            vessels: standing(system),
            first_shape: system.first_shape().clone(),
            tensions: tensions(system).cloned().collect(),
            state: solution.state.clone(),
            iterations: solution.iterations,
            residual_n: solution.residual_n,
            warnings: solution.warnings.clone(),
        }
    }

    /// The solution that [`solve_statics`](super::statics::solve_statics) would find for `system`,
    /// if that poses the same static problem and this was found from the same first shape; no
    /// tolerance is involved.
    pub fn of<'a>(&self, system: &'a System) -> Option<StaticSolution<'a>> {
        let same = same_statics(&self.model, system.model())
            && self.vessels == standing(system)
            && self.first_shape == *system.first_shape()
            && self.tensions.iter().eq(tensions(system));
        if !same {
            return None;
        }
        let mut solver = SystemSolver::at_rest(system, self.model.statics.current);
        // Results are read off the state that was assembled last.
        let mut residual = vec![Vector6::zeros(); system.frame_count()];
        solver.begin();
        solver.assemble(0.0, &self.state, None, &mut residual);
        solver.rest();
        Some(StaticSolution {
            solver,
            state: self.state.clone(),
            iterations: self.iterations,
            residual_n: self.residual_n,
            warnings: self.warnings.clone(),
        })
    }
}

fn tensions(system: &System) -> impl Iterator<Item = &Vec<f64>> {
    system.lines.iter().map(|layout| &layout.tension)
}

fn standing(system: &System) -> Vec<RigidMotion> {
    let vessels = system.vessels.iter();
    vessels.map(|vessel| vessel.at(0.0).stopped()).collect()
}

/// Whether two models differ in nothing that statics sees, beside their vessels.
fn same_statics(a: &Model, b: &Model) -> bool {
    // Taken apart without `..`: whoever adds to the model decides here.
    let Model {
        title: _,
        formulation,
        environment,
        line_types,
        lines,
        bodies,
        vessels: _,
        loads,
        statics,
        modes: _,
        dynamics: _,
        path: _,
        output: _,
    } = a;
    let Environment {
        gravity,
        water,
        current,
        seabed,
    } = environment;
    *formulation == b.formulation
        && *gravity == b.environment.gravity
        && *water == b.environment.water
        && *seabed == b.environment.seabed
        && (!statics.current || *current == b.environment.current)
        && *line_types == b.line_types
        && *lines == b.lines
        && *bodies == b.bodies
        && *loads == b.loads
        && *statics == b.statics
}
