//! The discrete element method: rigid elements that carry all inertia, joined by massless
//! connectors that carry all stiffness.

pub mod connector;
pub mod joint;
pub mod pair;
pub mod stiffness;

#[cfg(test)]
mod tangent_tests;
