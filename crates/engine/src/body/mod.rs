//! Rigid bodies: inertia, lumps on lines, and prescribed motions.

pub mod inertia;
pub mod lump;
pub mod motion;
