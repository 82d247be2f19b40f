//! Python with the peers: a virtual environment of its own below the target folder.

use std::path::PathBuf;
use std::process::Command;

use crate::child;
use crate::context::{Context, read_text, write_text};

const REQUIREMENTS: &str = "bench/peers/requirements.txt";

/// The Python that has the pinned packages; the environment is made anew when the pins change.
pub(crate) fn environment(context: &Context) -> Result<PathBuf, String> {
    let requirements = context.root.join(REQUIREMENTS);
    let wanted = read_text(&requirements)?;
    let folder = context.work.join("venv");
    let stamp = folder.join("installed.txt");
    let python = if cfg!(windows) {
        folder.join("Scripts").join("python.exe")
    } else {
        folder.join("bin").join("python")
    };
    if python.exists() && read_text(&stamp).is_ok_and(|installed| installed == wanted) {
        return Ok(python);
    }
    eprintln!("  installing the peers ...");
    let system = if cfg!(windows) { "python" } else { "python3" };
    child::output_of(
        Command::new(system)
            .args(["-m", "venv", "--clear"])
            .arg(&folder),
    )
    .map_err(|message| {
        format!(
            "{message}\nThe peers need Python 3.11 or newer with its venv module \
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
    child::output_of(install.arg("--requirement").arg(&requirements))?;
    write_text(&stamp, &wanted)?;
    Ok(python)
}
