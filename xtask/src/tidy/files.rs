//! The text files of the workspace.

use std::fs;
use std::path::Path;

/// Endings of the files that a person writes and the checks read.
const TEXT_ENDINGS: [&str; 12] = [
    "rs", "md", "toml", "py", "sh", "yml", "yaml", "txt", "ts", "mjs", "css", "html",
];

/// Folders that hold what programs made, at any depth.
const GENERATED_FOLDERS: [&str; 5] = ["target", ".git", "node_modules", ".venv", "__pycache__"];

/// A text file of the workspace.
#[derive(Debug, Clone)]
pub(crate) struct TextFile {
    /// Path from the workspace root, with forward slashes.
    pub path: String,
    /// Whole contents.
    pub text: String,
}

impl TextFile {
    /// Whether the file's name ends in `.ending`.
    pub(crate) fn has_ending(&self, ending: &str) -> bool {
        self.path
            .rsplit_once('.')
            .is_some_and(|(_, found)| found == ending)
    }

    /// The path's folder, without a trailing slash; empty at the root.
    pub(crate) fn folder(&self) -> &str {
        self.path.rsplit_once('/').map_or("", |(folder, _)| folder)
    }
}

/// Reads every text file below `root` that is not generated, in order of path.
pub(crate) fn read_all(root: &Path) -> Result<Vec<TextFile>, String> {
    let mut files = Vec::new();
    read_folder(root, "", &mut files)?;
    files.sort_by(|a, b| a.path.cmp(&b.path));
    Ok(files)
}

fn read_folder(root: &Path, folder: &str, files: &mut Vec<TextFile>) -> Result<(), String> {
    let absolute = root.join(folder);
    let failed = |error: std::io::Error| format!("cannot read {}: {error}", absolute.display());
    for entry in fs::read_dir(&absolute).map_err(failed)? {
        let entry = entry.map_err(failed)?;
        let name = entry.file_name().to_string_lossy().into_owned();
        let path = if folder.is_empty() {
            name.clone()
        } else {
            format!("{folder}/{name}")
        };
        if entry.file_type().map_err(failed)?.is_dir() {
            if !is_generated(&path, &name) {
                read_folder(root, &path, files)?;
            }
        } else if is_text(&path, &name) {
            match fs::read_to_string(entry.path()) {
                Ok(text) => files.push(TextFile { path, text }),
                // A test may own a deliberately broken text file, for example a binary model file.
                Err(error) if error.kind() == std::io::ErrorKind::InvalidData => {}
                Err(error) => return Err(format!("cannot read {path}: {error}")),
            }
        }
    }
    Ok(())
}

/// Results are written to `results/` at the root by default; `crates/results` is a crate.
fn is_generated(path: &str, name: &str) -> bool {
    GENERATED_FOLDERS.contains(&name)
        || path == "results"
        || path == "crates/viewer/assets"
        || name.ends_with(".zarr")
}

fn is_text(path: &str, name: &str) -> bool {
    let ending = name.rsplit_once('.').map_or("", |(_, ending)| ending);
    TEXT_ENDINGS.contains(&ending) || path.starts_with(".ci/")
}
