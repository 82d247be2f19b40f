//! Verification: published cases, computed and held against their references.
//!
//! A case is a folder: `case.toml` says what is compared and how well it must agree, `model.toml` is
//! an ordinary model file, `SOURCE.md` says where the reference is from, and curves may have their
//! reference in CSV files. docs/verification.md describes the files. To add a case is to add a
//! folder.

mod compare;
mod estimates;
mod results;
mod spec;

use std::path::{Path, PathBuf};

use catenix_model::Study;
use catenix_model::file::{ModelFileErrors, read_study};
use catenix_results::VerifiedCase;
use cpu_time::ThreadTime;
use thiserror::Error;

use compare::{verified_convergence, verified_curve, verified_number};
use estimates::verified_estimates;
use results::Results;
use spec::Spec;

/// Name of the file that describes a case.
const CASE_FILE: &str = "case.toml";

/// Why a verification case cannot be read.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum VerificationError {
    /// A file or folder that cannot be read.
    #[error("cannot read {path}: {source}")]
    Read {
        /// The file or folder.
        path: PathBuf,
        /// The system's reason.
        source: std::io::Error,
    },
    /// A `case.toml` that is wrong.
    #[error("{path}: {message}")]
    Spec {
        /// The file.
        path: PathBuf,
        /// Line, column and what is wrong.
        message: String,
    },
    /// A model file that is wrong.
    #[error("{0}")]
    Model(String),
    /// A folder without cases.
    #[error("{0} has no verification case: a case is a folder with a case.toml in it")]
    Empty(PathBuf),
}

/// A case of a verification suite.
#[derive(Debug, Clone)]
pub struct VerificationCase {
    /// Name of its folder.
    pub name: String,
    directory: PathBuf,
    spec: Spec,
    study: Study,
    source: String,
}

/// Reads all cases below a folder, by name.
///
/// # Errors
/// The first case that is wrong, or a folder without any.
pub fn read_suite(directory: &Path) -> Result<Vec<VerificationCase>, VerificationError> {
    let read_error = |source| VerificationError::Read {
        path: directory.to_owned(),
        source,
    };
    let mut folders = Vec::new();
    for entry in std::fs::read_dir(directory).map_err(read_error)? {
        let path = entry.map_err(read_error)?.path();
        if path.join(CASE_FILE).is_file() {
            folders.push(path);
        }
    }
    if folders.is_empty() {
        return Err(VerificationError::Empty(directory.to_owned()));
    }
    folders.sort();
    folders.iter().map(|path| read_case(path)).collect()
}

fn read_case(directory: &Path) -> Result<VerificationCase, VerificationError> {
    let read = |name: &str| {
        let path = directory.join(name);
        std::fs::read_to_string(&path).map_err(|source| VerificationError::Read { path, source })
    };
    let spec: Spec =
        toml::from_str(&read(CASE_FILE)?).map_err(|error| VerificationError::Spec {
            path: directory.join(CASE_FILE),
            message: error.to_string(),
        })?;
    let study = read_study(&directory.join("model.toml"))
        .map_err(|errors| VerificationError::Model(in_words(&errors)))?;
    let name = directory.file_name().unwrap_or_default();
    Ok(VerificationCase {
        name: name.to_string_lossy().into_owned(),
        source: read("SOURCE.md")?,
        directory: directory.to_owned(),
        spec,
        study,
    })
}

/// All errors of a model file, one line each.
fn in_words(errors: &ModelFileErrors) -> String {
    let diagnostics = errors.diagnostics.iter();
    let lines = diagnostics.map(|d| format!("{}:{}: {}", errors.file, d.line, d));
    lines.collect::<Vec<_>>().join("\n")
}

impl VerificationCase {
    /// The title, for progress and tables.
    pub fn title(&self) -> &str {
        &self.spec.title
    }

    /// Computes the case and compares. `stop` is asked now and then.
    pub fn verify(&self, stop: &dyn Fn() -> bool) -> VerifiedCase {
        let cpu = ThreadTime::now();
        let mut results = Results::new(&self.study, stop);
        let mut errors: Vec<String> = Vec::new();
        let mut keep = |error: String| {
            if !errors.contains(&error) {
                errors.push(error);
            }
        };
        let numbers = self.spec.numbers.iter();
        let numbers: Vec<_> = numbers
            .map(|number| {
                verified_number(number, &mut results).unwrap_or_else(|error| {
                    keep(error);
                    number.not_computed()
                })
            })
            .collect();
        let mut curves = Vec::new();
        for curve in &self.spec.curves {
            match verified_curve(curve, &self.directory, &mut results) {
                Ok(curve) => curves.push(curve),
                Err(error) => keep(error),
            }
        }
        let mut convergences = Vec::new();
        for convergence in &self.spec.convergences {
            match verified_convergence(convergence, &mut results) {
                Ok(convergence) => convergences.push(convergence),
                Err(error) => keep(error),
            }
        }
        let mut estimates = Vec::new();
        for target in &self.spec.accuracies {
            match verified_estimates(*target, &self.spec.numbers, &self.study, stop) {
                Ok(found) => estimates.extend(found),
                Err(error) => keep(error),
            }
        }
        let passed = errors.is_empty()
            && numbers.iter().all(|number| number.passed != Some(false))
            && curves.iter().all(|curve| curve.passed != Some(false))
            && convergences.iter().all(|convergence| convergence.passed);
        VerifiedCase {
            name: self.name.clone(),
            title: self.spec.title.clone(),
            topic: self.spec.topic.clone(),
            summary: self.spec.summary.clone(),
            source: self.source.clone(),
            passed,
            error: (!errors.is_empty()).then(|| errors.join("; ")),
            numbers,
            curves,
            convergences,
            estimates,
            cpu_seconds: cpu.elapsed().as_secs_f64(),
        }
    }
}
