//! The finite element method: elements between nodes that carry position and rotation.
//!
//! Two elements: the corotational beam, whose deformation is small against a frame that moves with
//! it (`corotational.rs`), and the geometrically exact one of Reissner and Simo (`exact.rs`).
//! Both are pure functions of two ends. Inertia and loads spread over the length are the same for
//! both (`field.rs`); what a load is, only the system knows.
//!
//! Source: docs/theory/fem.md.

pub mod corotational;
pub mod ends;
pub mod exact;
pub mod field;
pub mod joint;
pub mod lanes;
mod reach;
pub mod section;
mod triad;
pub mod weight;

#[cfg(test)]
mod exact_solutions;
#[cfg(test)]
mod field_tests;
#[cfg(test)]
mod tangent_tests;
#[cfg(test)]
mod test_chain;
