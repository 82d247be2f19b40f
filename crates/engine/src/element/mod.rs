//! Force kernels of the formulations, one folder each. They share nothing but the state's types
//! and how a property of a section is read off its points: if they did, their agreement would
//! prove nothing.

pub mod curve;
pub mod dem;
pub mod fem;
pub mod lumped;
