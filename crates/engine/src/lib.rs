//! Physics: elements, loads, bodies, their assembly into a system, and its analyses.
//!
//! A [`System`] is assembled once from a [`catenix_model::Model`] and never changes.
//! [`solve_statics`] finds its equilibrium, [`simulate`] moves it from there, and both show their
//! states as a [`StepView`], from which results are read.

pub mod analysis;
pub mod body;
pub mod contact;
pub mod formulation;
pub mod hydro;
pub mod load;
pub mod system;

pub use analysis::dynamics::{DynamicsError, DynamicsReport, SolverStatistics, simulate};
pub use analysis::energy::EnergyAccount;
pub use analysis::equilibrium::Equilibrium;
pub use analysis::modes::{
    Mode, ModeKind, Modes, ModesError, ModesProgress, Motion, Proof, find_modes,
};
pub use analysis::path::{PathEnd, PathError, PathEvent, PathPoint, PathReport, follow_path};
pub use analysis::stable_step::{StableStep, measure_stable_step};
pub use analysis::statics::{StaticSolution, StaticsError, StaticsProgress, solve_statics};
pub use system::{FrameOwner, StepView, System, SystemError};
