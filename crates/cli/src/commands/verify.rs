//! `catenix verify`: published cases, computed and held against their references.

use std::path::{Path, PathBuf};

use catenix_model::FormulationKind;
use catenix_report::write_verification;
use catenix_results::{Verification, VerifiedCase};
use catenix_study::{VerificationCase, in_parallel, read_suite};
use include_dir::{Dir, include_dir};
use serde::Serialize;

use crate::args::VerifyArgs;
use crate::failure::{Document, Exit, Failure};
use crate::interrupt::Interrupt;
use crate::progress::Progress;
use crate::{print, tables};

/// The project's own suite.
static SUITE: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/../../verification");

/// What `verify --json` prints.
#[derive(Debug, Serialize)]
struct VerifyReport<'a> {
    #[serde(flatten)]
    verification: &'a Verification,
    /// Files of the report.
    files: &'a [PathBuf],
}

pub(crate) fn verify(args: &VerifyArgs) -> Result<Exit, Failure> {
    let unpacked;
    let directory: &Path = match &args.suite {
        Some(directory) => directory,
        None => {
            unpacked = unpack()?;
            unpacked.path()
        }
    };
    let suite = read_suite(directory)?;
    let cases = chosen(&suite, &args.cases)?;
    if args.list {
        print::text(&tables::suite_text(&cases));
        return Ok(Exit::Success);
    }
    let interrupt = Interrupt::listen()?;
    let formulations = args.formulation.kinds();
    let jobs: Vec<(&VerificationCase, FormulationKind)> = formulations
        .iter()
        .flat_map(|&formulation| cases.iter().map(move |&case| (case, formulation)))
        .collect();
    let name = |(case, formulation): &(&VerificationCase, FormulationKind)| match formulation {
        FormulationKind::Dem => case.name.clone(),
        other => format!("{}, {}", case.name, other.word()),
    };
    let names = jobs.iter().map(|job| name(job).chars().count());
    let progress = Progress::new(args.work.quiet, names);
    let results: Vec<VerifiedCase> = in_parallel(&jobs, args.work.threads, |job| {
        let _bar = progress.begin(&name(job), &interrupt);
        job.0.verify(job.1, &|| interrupt.requested())
    });
    let verification = Verification::new(env!("CARGO_PKG_VERSION"), results);
    let files = match &args.report {
        Some(directory) => write_verification(&verification, directory)?,
        None => Vec::new(),
    };
    let exit = if interrupt.requested() {
        Exit::Interrupted
    } else if verification.passed {
        Exit::Success
    } else {
        Exit::SolverFailed
    };
    if args.output.json {
        let report = VerifyReport {
            verification: &verification,
            files: &files,
        };
        print::json(&Document::new("verify", exit, &report));
    } else {
        print::text(&tables::verification_text(&verification));
        if let Some(page) = files.first() {
            print::text(&format!("Written: {}\n", page.display()));
        }
    }
    Ok(exit)
}

/// The suite that is part of the program, as files.
fn unpack() -> Result<tempfile::TempDir, Failure> {
    let error = |source| Failure::Read {
        path: "the temporary folder".to_owned(),
        source,
    };
    let directory = tempfile::tempdir().map_err(error)?;
    SUITE.extract(directory.path()).map_err(error)?;
    Ok(directory)
}

/// The cases that the user wants; all of them when none is named.
fn chosen<'a>(
    suite: &'a [VerificationCase],
    names: &[String],
) -> Result<Vec<&'a VerificationCase>, Failure> {
    let known = |name: &String| suite.iter().any(|case| case.name == *name);
    if let Some(name) = names.iter().find(|name| !known(name)) {
        let available: Vec<&str> = suite.iter().map(|case| case.name.as_str()).collect();
        return Err(Failure::UnknownVerification {
            name: name.clone(),
            available: available.join(", "),
        });
    }
    let chosen = |case: &&VerificationCase| names.is_empty() || names.contains(&case.name);
    Ok(suite.iter().filter(chosen).collect())
}
