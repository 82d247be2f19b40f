//! The test command: everything that a change must pass, in order, from cheap to thorough.
//!
//! Every step runs even when an earlier one has failed, so that one run shows everything that is
//! wrong. The tests come last and have the last word: on success nothing is printed after them, so
//! that the closing line is the test runner's own count.

use std::ffi::OsString;
use std::path::Path;
use std::process::{Command, ExitCode};
use std::time::Instant;

use crate::{documentation, read_back, web};

struct Step {
    name: &'static str,
    what: &'static str,
    run: fn(&Path) -> Result<(), String>,
}

const STEPS: [Step; 7] = [
    Step {
        name: "format",
        what: "sources are formatted with rustfmt",
        run: format,
    },
    Step {
        name: "lints",
        what: "clippy finds nothing in any target",
        run: lints,
    },
    Step {
        name: "docs",
        what: "documentation builds, all its links lead somewhere",
        run: documentation::build,
    },
    Step {
        name: "doc-tests",
        what: "examples in the documentation run",
        run: doc_tests,
    },
    Step {
        name: "read-back",
        what: "xarray reads stores, and pandas, xarray and VTK read exports (needs python3 with venv, and pip)",
        run: read_back::run,
    },
    Step {
        name: "web",
        what: "the viewer's page is built from its sources and works in a browser (needs node, npm, Chromium)",
        run: web::run,
    },
    Step {
        name: "tests",
        what: "all tests, with cargo-nextest where it is installed",
        run: tests,
    },
];

/// Runs all steps, or only the one named.
pub(crate) fn run(root: &Path, only: Option<&str>) -> ExitCode {
    let chosen: Vec<&Step> = STEPS
        .iter()
        .filter(|step| only.is_none_or(|name| name == step.name))
        .collect();
    let Some(last) = chosen.last() else {
        let names: Vec<&str> = STEPS.iter().map(|step| step.name).collect();
        eprintln!(
            "there is no step `{}`; steps are {}",
            only.unwrap_or(""),
            names.join(", ")
        );
        return ExitCode::from(2);
    };
    let last_name = last.name;
    let mut failed = Vec::new();
    for step in chosen {
        println!("==> {}: {}", step.name, step.what);
        let start = Instant::now();
        let outcome = (step.run)(root);
        let seconds = start.elapsed().as_secs_f64();
        match outcome {
            // The runner's own closing line says it all, time included.
            Ok(()) if step.name == "tests" && last_name == "tests" => {}
            Ok(()) => println!("==> {}: passed in {seconds:.1} s\n", step.name),
            Err(message) => {
                println!(
                    "==> {}: FAILED after {seconds:.1} s: {message}\n",
                    step.name
                );
                failed.push(step.name);
            }
        }
    }
    if failed.is_empty() {
        return ExitCode::SUCCESS;
    }
    println!("failed: {}", failed.join(", "));
    println!(
        "run one step again with `cargo xtask test --only {}`",
        failed[0]
    );
    ExitCode::FAILURE
}

/// Prints the steps.
pub(crate) fn list() {
    for step in &STEPS {
        println!("{:<10} {}", step.name, step.what);
    }
}

/// A cargo command in the workspace, with the cargo that runs this program.
pub(crate) fn cargo(root: &Path, arguments: &[&str]) -> Command {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| OsString::from("cargo"));
    let mut command = Command::new(cargo);
    command.current_dir(root).args(arguments);
    command
}

/// Runs a command with its output on the terminal; a non-zero exit is an error that names it.
pub(crate) fn run_command(command: &mut Command) -> Result<(), String> {
    let shown = show(command);
    match command.status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(format!("`{shown}` ended with {status}")),
        Err(error) => Err(format!("`{shown}` did not start: {error}")),
    }
}

fn show(command: &Command) -> String {
    let program = Path::new(command.get_program());
    let name = program
        .file_stem()
        .unwrap_or(program.as_os_str())
        .to_string_lossy();
    let arguments = command
        .get_args()
        .map(|argument| argument.to_string_lossy());
    [name]
        .into_iter()
        .chain(arguments)
        .collect::<Vec<_>>()
        .join(" ")
}

fn format(root: &Path) -> Result<(), String> {
    run_command(&mut cargo(root, &["fmt", "--all", "--check"]))
}

fn lints(root: &Path) -> Result<(), String> {
    let arguments = [
        "clippy",
        "--workspace",
        "--all-targets",
        "--",
        "-D",
        "warnings",
    ];
    run_command(&mut cargo(root, &arguments))
}

fn doc_tests(root: &Path) -> Result<(), String> {
    run_command(&mut cargo(root, &["test", "--workspace", "--doc"]))
}

fn tests(root: &Path) -> Result<(), String> {
    let has_nextest = cargo(root, &["nextest", "--version"])
        .output()
        .is_ok_and(|output| output.status.success());
    let arguments: &[&str] = if has_nextest {
        &["nextest", "run", "--workspace", "--no-fail-fast"]
    } else {
        // Without `--all-targets`: benchmarks measure nothing useful beside running tests.
        &[
            "test",
            "--workspace",
            "--lib",
            "--bins",
            "--tests",
            "--no-fail-fast",
        ]
    };
    run_command(&mut cargo(root, arguments))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failing_command_is_named() {
        let root = crate::workspace_root();
        let message = run_command(&mut cargo(&root, &["no-such-subcommand"])).expect_err("fails");
        assert!(
            message.starts_with("`cargo no-such-subcommand` ended with"),
            "{message}"
        );
        let message = run_command(&mut Command::new("no-such-program")).expect_err("fails");
        assert!(
            message.starts_with("`no-such-program` did not start"),
            "{message}"
        );
    }

    #[test]
    fn step_names_are_unique_and_the_tests_come_last() {
        let mut names: Vec<&str> = STEPS.iter().map(|step| step.name).collect();
        assert_eq!(names.last(), Some(&"tests"));
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), STEPS.len());
    }
}
