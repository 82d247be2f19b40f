//! The read-back check: xarray opens the stores that the results crate writes, and finds every
//! value, unit and dimension that was written, also after an interrupted and a killed run; and what
//! the export crate makes of these stores opens in the programs that it is for.
//!
//! A program of the results crate writes stores whose values follow formulas;
//! `crates/results/tests/read_back.py` reads them and knows the same formulas. A program of the
//! export crate exports them in every format; `crates/export/tests/read_back.py` compares every
//! value with the store. Python and its packages live in a virtual environment of their own below
//! the target folder.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use cargo_metadata::MetadataCommand;

use crate::steps::{cargo, run_command};

const SCRIPT: &str = "crates/results/tests/read_back.py";
/// The example of the results crate that writes the stores.
const WRITER: &str = "synthetic_store";
const EXPORT_SCRIPT: &str = "crates/export/tests/read_back.py";
/// The example of the export crate that exports a store in every format.
const EXPORTER: &str = "export_all";
/// Stores that are written and exported.
const STORES: [&str; 3] = ["complete", "interrupted", "killed"];
const REQUIREMENTS: &str = "xtask/read-back-requirements.txt";

/// Writes stores and reads them back with Python.
pub(crate) fn run(root: &Path) -> Result<(), String> {
    let target = target_folder(root)?;
    let python = environment(root, &target.join("read-back-venv"))?;
    let stores = empty_folder(&target.join("read-back-stores"))?;
    write_stores(root, &target, &stores)?;
    run_command(Command::new(&python).arg(root.join(SCRIPT)).arg(&stores))?;
    let exports = empty_folder(&target.join("read-back-exports"))?;
    build(root, EXPORTER)?;
    for store in STORES {
        let (store, export) = (stores.join(store), exports.join(store));
        run_command(Command::new(program(&target, EXPORTER)).args([&store, &export]))?;
        let mut check = Command::new(&python);
        run_command(check.arg(root.join(EXPORT_SCRIPT)).args([&store, &export]))?;
    }
    Ok(())
}

/// Builds an example as the tests are built, for the whole workspace: with the features that one
/// package alone would ask for, cargo would compile most dependencies again.
fn build(root: &Path, example: &str) -> Result<(), String> {
    run_command(&mut cargo(
        root,
        &["build", "--workspace", "--example", example],
    ))
}

fn program(target: &Path, example: &str) -> PathBuf {
    let name = format!("{example}{}", std::env::consts::EXE_SUFFIX);
    target.join("debug").join("examples").join(name)
}

/// Runs the program that writes the stores. It writes the last one half and then aborts, as a
/// killed run would; any other end is a failure.
fn write_stores(root: &Path, target: &Path, stores: &Path) -> Result<(), String> {
    build(root, WRITER)?;
    let status = Command::new(program(target, WRITER))
        .arg(stores)
        .status()
        .map_err(|error| format!("`{WRITER}` did not start: {error}"))?;
    // Killed by a signal, a program has no exit code; Windows gives an aborted one a code as well.
    let aborted = status.code().is_none() || (cfg!(windows) && !status.success());
    if aborted && stores.join("killed").exists() {
        return Ok(());
    }
    Err(format!(
        "`{WRITER}` should have aborted while it wrote its last store, but: {status}"
    ))
}

fn empty_folder(folder: &Path) -> Result<PathBuf, String> {
    let failed = |error: std::io::Error| format!("cannot empty {}: {error}", folder.display());
    if folder.exists() {
        fs::remove_dir_all(folder).map_err(failed)?;
    }
    fs::create_dir_all(folder).map_err(failed)?;
    Ok(folder.to_path_buf())
}

/// Cargo's folder for what is built.
pub(crate) fn target_folder(root: &Path) -> Result<PathBuf, String> {
    MetadataCommand::new()
        .manifest_path(root.join("Cargo.toml"))
        .no_deps()
        .exec()
        .map(|metadata| metadata.target_directory.into_std_path_buf())
        .map_err(|error| format!("`cargo metadata` failed: {error}"))
}

/// The Python of a virtual environment with the pinned packages; made anew when the pins change.
fn environment(root: &Path, folder: &Path) -> Result<PathBuf, String> {
    let requirements = root.join(REQUIREMENTS);
    let wanted = fs::read_to_string(&requirements)
        .map_err(|error| format!("cannot read {REQUIREMENTS}: {error}"))?;
    let stamp = folder.join("installed.txt");
    let python = if cfg!(windows) {
        folder.join("Scripts").join("python.exe")
    } else {
        folder.join("bin").join("python")
    };
    if fs::read_to_string(&stamp).is_ok_and(|installed| installed == wanted) && python.exists() {
        return Ok(python);
    }
    let system_python = if cfg!(windows) { "python" } else { "python3" };
    run_command(
        Command::new(system_python)
            .args(["-m", "venv", "--clear"])
            .arg(folder),
    )
    .map_err(|message| {
        format!(
            "{message}. The check needs Python 3.11 or newer with its venv module \
                 (Debian and Ubuntu: apt-get install python3-venv)"
        )
    })?;
    let mut install = Command::new(&python);
    install.args([
        "-m",
        "pip",
        "install",
        // The list is complete; what it leaves out of a package's wishes is not needed.
        "--no-deps",
        "--quiet",
        "--disable-pip-version-check",
    ]);
    run_command(install.arg("--requirement").arg(&requirements)).map_err(|message| {
        format!("{message}. The packages of {REQUIREMENTS} could not be installed")
    })?;
    fs::write(&stamp, wanted).map_err(|error| format!("cannot write the stamp: {error}"))?;
    Ok(python)
}
