//! Computes studies: load cases with everything recorded, and how good the numbers are.
//!
//! The engine integrates one system; the results crate stores what it is given. This crate brings
//! the two together, for every adapter alike: [`compute_case`], [`compute_statics`],
//! [`compute_modes`] and [`compute_path`] run one load case; [`compare_formulations`] runs it under
//! several formulations.

mod accuracy;
mod case;
mod comparison;
mod equilibria;
mod modes;
mod parallel;
mod path;
mod verification;
mod watch;

pub use case::{choose_for_accuracy, compute_case, compute_statics};
pub use comparison::{ComparisonSettings, MemoryMeter, compare_formulations};
pub use equilibria::Equilibria;
pub use modes::compute_modes;
pub use parallel::in_parallel;
pub use path::compute_path;
pub use verification::{VerificationCase, VerificationError, read_suite};
pub use watch::Watch;
