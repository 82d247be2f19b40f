//! Computes studies: load cases with everything recorded, and how good the numbers are.
//!
//! The engine integrates one system; the results crate stores what it is given. This crate brings
//! the two together, for every adapter alike: [`compute_case`], [`compute_statics`],
//! [`compute_modes`] and [`compute_path`] run one load case.

mod accuracy;
mod case;
mod modes;
mod path;
mod watch;

pub use case::{compute_case, compute_statics};
pub use modes::compute_modes;
pub use path::compute_path;
pub use watch::Watch;
