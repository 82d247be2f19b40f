//! The benchmark command: builds what is measured as users build it, and lets `bench` measure.

use std::path::Path;

use crate::steps::{cargo, run_command};

/// Builds the command and the benchmark program, and runs the latter.
pub(crate) fn run(root: &Path, arguments: &[&str]) -> Result<(), String> {
    let build = ["build", "--release", "--bin", "catenix"];
    run_command(&mut cargo(root, &build))?;
    let run = [
        "run",
        "--quiet",
        "--release",
        "--package",
        "catenix-bench",
        "--",
    ];
    run_command(cargo(root, &run).args(arguments))
}
