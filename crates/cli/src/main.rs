//! The `catenix` command.
fn main() {}
