//! From a path to text, with limits that protect against files that are no model files.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use super::diagnostic::ModelFileErrors;

/// Largest model file that is read [bytes].
pub const MOST_BYTES: u64 = 16 << 20;

/// Reads a text file.
pub(super) fn read_text(path: &Path, file_name: &str) -> Result<String, ModelFileErrors> {
    let fail = |message: String, help: &str| {
        let help = (!help.is_empty()).then(|| help.to_owned());
        Err(ModelFileErrors::of_file(file_name, message, help))
    };
    let metadata = match std::fs::metadata(path) {
        Ok(metadata) => metadata,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
            return fail("there is no such file".to_owned(), "check the path");
        }
        Err(error) => return fail(format!("the file cannot be read: {error}"), ""),
    };
    if metadata.is_dir() {
        return fail(
            "this is a folder".to_owned(),
            "name the model file (.toml) in it",
        );
    }
    if !metadata.is_file() {
        return fail(
            "this is not a regular file".to_owned(),
            "name a model file (.toml)",
        );
    }
    if metadata.len() > MOST_BYTES {
        return Err(too_large(file_name, metadata.len()));
    }
    let mut bytes = Vec::new();
    // The limit holds for a file that grows while it is read, too.
    let read = File::open(path).and_then(|file| file.take(MOST_BYTES + 1).read_to_end(&mut bytes));
    if let Err(error) = read {
        return fail(format!("the file cannot be read: {error}"), "");
    }
    match String::from_utf8(bytes) {
        Ok(text) => Ok(text),
        Err(error) => {
            let at = error.utf8_error().valid_up_to();
            let message = format!("the file is not text: byte {at} is not valid UTF-8");
            fail(message, "a model file is TOML text in UTF-8")
        }
    }
}

/// Refuses text that cannot be a model file, before it is parsed.
pub(super) fn check_text(text: &str, file_name: &str) -> Result<(), ModelFileErrors> {
    let fail = |message: String, help: &str| {
        Err(ModelFileErrors::of_file(
            file_name,
            message,
            Some(help.to_owned()),
        ))
    };
    if text.len() as u64 > MOST_BYTES {
        return Err(too_large(file_name, text.len() as u64));
    }
    if let Some(at) = text.find('\0') {
        let message = format!("the file is not text: byte {at} is zero");
        return fail(message, "a model file is TOML text in UTF-8");
    }
    let is_blank = |line: &str| line.trim().is_empty() || line.trim_start().starts_with('#');
    if text.trim_start_matches('\u{feff}').lines().all(is_blank) {
        let help = "start from one of the files in the folder `examples`";
        return fail("the file is empty".to_owned(), help);
    }
    Ok(())
}

fn too_large(file_name: &str, bytes: u64) -> ModelFileErrors {
    let message = format!(
        "the file has {:.1} MiB, but a model file has at most {} MiB",
        bytes as f64 / f64::from(1 << 20),
        MOST_BYTES >> 20
    );
    let help = "long motion histories belong into CSV files (kind = \"history\")";
    ModelFileErrors::of_file(file_name, message, Some(help.to_owned()))
}
