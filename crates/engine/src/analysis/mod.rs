//! Analyses: static equilibrium, natural modes and motion.

pub mod dynamics;
pub mod energy;
pub mod equilibrium;
mod free_motion;
pub mod modes;
pub mod path;
mod path_step;
pub mod stable_step;
pub mod statics;
