//! The discrete element method: rigid elements that carry all inertia, joined by massless
//! connectors that carry all stiffness.

mod bend;
pub mod connector;

pub mod joint;
mod law;
mod layer;
pub mod pair;
pub mod pair_kernel;
pub mod stiffness;

#[cfg(test)]
mod tangent_tests;
