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

use catenix_model::file::{ModelFileErrors, read_study};
use catenix_model::{FormulationKind, Study};
use catenix_results::VerifiedCase;
use cpu_time::ThreadTime;
use thiserror::Error;

use compare::{verified_convergence, verified_curve, verified_number};
use estimates::verified_estimates;
use results::{Missing, Results};
use spec::{Comparison, Spec};

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

    /// Computes the case under a formulation and compares. `stop` is asked now and then.
    ///
    /// What the formulation cannot do is told by its reason and judged neither way. Error estimates
    /// are held against true errors under discrete elements only.
    pub fn verify(&self, formulation: FormulationKind, stop: &dyn Fn() -> bool) -> VerifiedCase {
        let cpu = ThreadTime::now();
        let mut results = Results::new(&self.study, formulation, stop);
        let mut told = Told::default();
        let mut numbers = Vec::new();
        for number in &self.spec.numbers {
            let found = number.adapted(formulation).map_err(Missing::Refused);
            let found = found.and_then(|number| verified_number(&number, &mut results));
            match found {
                Err(Missing::Failed(error)) => {
                    told.keep(Missing::Failed(error));
                    numbers.push(number.not_computed());
                }
                found => numbers.extend(told.sort_out(found)),
            }
        }
        let mut curves = Vec::new();
        for curve in &self.spec.curves {
            let found = curve.adapted(formulation).map_err(Missing::Refused);
            let found =
                found.and_then(|curve| verified_curve(&curve, &self.directory, &mut results));
            curves.extend(told.sort_out(found));
        }
        let mut convergences = Vec::new();
        for convergence in &self.spec.convergences {
            let found = convergence.adapted(formulation).map_err(Missing::Refused);
            let found = found.and_then(|found| verified_convergence(&found, &mut results));
            convergences.extend(told.sort_out(found));
        }
        let mut estimates = Vec::new();
        if formulation == FormulationKind::Dem {
            for target in &self.spec.accuracies {
                match verified_estimates(*target, &self.spec.numbers, &self.study, stop) {
                    Ok(found) => estimates.extend(found),
                    Err(error) => told.keep(Missing::Failed(error)),
                }
            }
        }
        let passed = told.errors.is_empty()
            && numbers.iter().all(|number| number.passed != Some(false))
            && curves.iter().all(|curve| curve.passed != Some(false))
            && convergences.iter().all(|convergence| convergence.passed);
        VerifiedCase {
            name: self.name.clone(),
            formulation: formulation.word().to_owned(),
            title: self.spec.title.clone(),
            topic: self.spec.topic.clone(),
            summary: self.spec.summary.clone(),
            source: self.source.clone(),
            passed,
            error: (!told.errors.is_empty()).then(|| told.errors.join("; ")),
            refused: told.refusals,
            numbers,
            curves,
            convergences,
            estimates,
            cpu_seconds: cpu.elapsed().as_secs_f64(),
        }
    }
}

/// What could not be computed, each reason once.
#[derive(Default)]
struct Told {
    errors: Vec<String>,
    refusals: Vec<String>,
}

impl Told {
    fn keep(&mut self, missing: Missing) {
        let (list, text) = match missing {
            Missing::Failed(text) => (&mut self.errors, text),
            Missing::Refused(text) => (&mut self.refusals, text),
        };
        if !list.contains(&text) {
            list.push(text);
        }
    }

    fn sort_out<T>(&mut self, found: Result<T, Missing>) -> Option<T> {
        found.map_err(|missing| self.keep(missing)).ok()
    }
}
