//! Project tasks, run as `cargo xtask <command>`.
//!
//! `test` runs everything that a change must pass; `tidy` runs only the architecture test, which is
//! also one of the tests. CONTRIBUTING.md explains both.

// This program talks to a person at a terminal; printing is its only output.
#![allow(clippy::print_stdout, clippy::print_stderr)]

mod bench;
mod documentation;
mod formulations;
mod integrators;
mod read_back;
mod steps;
mod tidy;
mod web;
mod written;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

const USAGE: &str = "\
usage: cargo xtask <command>

  test                  formatting, lints, documentation, read-back check and all tests
  test --only <step>    one step of the above
  test --list           the steps and what each does
  bench [SECTION...]    cost of kernels and whole systems, and peers beside it, into bench/RESULTS.md
  bench --quick ...     the same in short and rough, into the target folder
  integrators           cost against error of the time integrators, into docs/theory/integration.md
  formulations          formulations side by side on the sea trial, into docs/theory/formulations.md
  tidy                  only the architecture test: crate arrows, source rules, documents
";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let root = workspace_root();
    match arguments[..] {
        ["test"] => steps::run(&root, None),
        ["test", "--only", step] => steps::run(&root, Some(step)),
        ["test", "--list"] => {
            steps::list();
            ExitCode::SUCCESS
        }
        ["bench", ref rest @ ..] => exit_code(bench::run(&root, rest)),
        ["integrators"] => exit_code(integrators::write_table(&root)),
        ["formulations"] => exit_code(formulations::write_table(&root)),
        ["tidy"] => report_tidy(&root),
        _ => {
            eprint!("{USAGE}");
            ExitCode::from(2)
        }
    }
}

fn exit_code(outcome: Result<(), String>) -> ExitCode {
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}

/// The folder of the workspace's `Cargo.toml`.
///
/// Cargo says at run time where the package is; the place where it was compiled may be another
/// checkout that shares the target folder.
fn workspace_root() -> PathBuf {
    let xtask = std::env::var_os("CARGO_MANIFEST_DIR")
        .map_or_else(|| PathBuf::from(env!("CARGO_MANIFEST_DIR")), PathBuf::from);
    xtask.parent().map(Path::to_path_buf).unwrap_or(xtask)
}

fn report_tidy(root: &Path) -> ExitCode {
    match tidy::check(root) {
        Ok(violations) if violations.is_empty() => {
            println!("tidy: no violations");
            ExitCode::SUCCESS
        }
        Ok(violations) => {
            for violation in &violations {
                println!("{violation}\n");
            }
            println!("tidy: {} violations", violations.len());
            ExitCode::FAILURE
        }
        Err(message) => {
            eprintln!("tidy could not run: {message}");
            ExitCode::FAILURE
        }
    }
}
