//! Loads of the water: current, drag, added mass, submergence. Knows nothing of elements.

pub mod current;
pub mod morison;
pub mod submergence;
