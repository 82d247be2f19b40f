//! The verification suite is part of the program: a change of it builds the program anew.

#![allow(
    clippy::print_stdout,
    reason = "this is how a build script talks to cargo"
)]

fn main() {
    println!("cargo::rerun-if-changed=../../verification");
}
