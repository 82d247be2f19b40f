//! The read-back check: a store that catenix wrote opens in xarray, with names, units and sizes.
//!
//! It runs the built binary on a small model and hands the store to
//! `crates/results/tests/read_back.py`, in a virtual environment of its own below the target folder.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use cargo_metadata::MetadataCommand;

use crate::steps::{cargo, run_command};

const SCRIPT: &str = "crates/results/tests/read_back.py";
const REQUIREMENTS: &str = "xtask/read-back-requirements.txt";

/// Writes a store and reads it back with Python.
pub(crate) fn run(root: &Path) -> Result<(), String> {
    if !root.join(SCRIPT).exists() {
        println!("    {SCRIPT} does not exist yet; nothing to read back");
        return Ok(());
    }
    let target = target_folder(root)?;
    let python = environment(root, &target.join("read-back-venv"))?;
    run_command(&mut cargo(root, &["build", "--package", "catenix"]))?;
    let store = write_store(root, &target)?;
    run_command(Command::new(python).arg(root.join(SCRIPT)).arg(store))
}

fn target_folder(root: &Path) -> Result<PathBuf, String> {
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
        "--quiet",
        "--disable-pip-version-check",
    ]);
    run_command(install.arg("--requirement").arg(&requirements)).map_err(|message| {
        format!("{message}. The packages of {REQUIREMENTS} could not be installed")
    })?;
    fs::write(&stamp, wanted).map_err(|error| format!("cannot write the stamp: {error}"))?;
    Ok(python)
}

fn write_store(_root: &Path, _target: &Path) -> Result<PathBuf, String> {
    Err("the binary does not write a store yet".to_owned())
}
