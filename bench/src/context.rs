//! What every section needs to know: where things are, and how thorough to be.

use std::path::{Path, PathBuf};

/// Where things are, and how thorough to be.
#[derive(Debug, Clone)]
pub(crate) struct Context {
    /// The workspace.
    pub root: PathBuf,
    /// For models, results and caches; below cargo's target folder.
    pub work: PathBuf,
    /// The `catenix` command, as users run it.
    pub catenix: PathBuf,
    /// This program, for measurements in a process of their own.
    pub own: PathBuf,
    /// A rough and short measurement, to see that everything works.
    pub quick: bool,
}

impl Context {
    /// Everything relative to this program: cargo has put it beside `catenix`.
    pub(crate) fn new(quick: bool) -> Result<Context, String> {
        let own = std::env::current_exe().map_err(|error| format!("where am I: {error}"))?;
        let folder = own.parent().ok_or("this program is in no folder")?;
        let target = folder.parent().ok_or("this program is in no folder")?;
        let catenix = folder.join(format!("catenix{}", std::env::consts::EXE_SUFFIX));
        let context = Context {
            root: workspace_root(),
            work: target.join("bench"),
            catenix,
            own: own.clone(),
            quick,
        };
        make_folder(&context.work)?;
        Ok(context)
    }

    /// How often a measurement is repeated; the fastest counts.
    pub(crate) fn repeats(&self) -> usize {
        if self.quick { 1 } else { 3 }
    }

    /// Where the tables and figures of this run belong: a quick one must not replace good ones.
    pub(crate) fn output(&self) -> PathBuf {
        if self.quick {
            self.work.join("quick")
        } else {
            self.root.join("bench")
        }
    }
}

/// The folder of the workspace's `Cargo.toml`: cargo says at run time where the package is.
pub(crate) fn workspace_root() -> PathBuf {
    let package = std::env::var_os("CARGO_MANIFEST_DIR")
        .map_or_else(|| PathBuf::from(env!("CARGO_MANIFEST_DIR")), PathBuf::from);
    package.parent().map(Path::to_path_buf).unwrap_or(package)
}

/// Makes a folder with all above it.
pub(crate) fn make_folder(folder: &Path) -> Result<(), String> {
    std::fs::create_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))
}

/// Reads a text file.
pub(crate) fn read_text(path: &Path) -> Result<String, String> {
    std::fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))
}

/// Writes a text file.
pub(crate) fn write_text(path: &Path, text: &str) -> Result<(), String> {
    std::fs::write(path, text).map_err(|error| format!("{}: {error}", path.display()))
}
