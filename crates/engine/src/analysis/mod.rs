//! Analyses: static equilibrium and motion.

pub mod dynamics;
pub mod energy;
mod free_motion;
pub mod path;
mod path_step;
pub mod statics;
