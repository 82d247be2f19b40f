//! Forces and moments that the user puts on points of lines and bodies.

pub mod point;
pub mod variation;
