//! Force kernels of the formulations, one folder each. They share nothing but the state's types:
//! if they did, their agreement would prove nothing.

pub mod dem;
