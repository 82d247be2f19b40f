//! One file per command.

mod check;
mod modes;
mod path;
mod run;
mod statics;
mod summary;

pub(crate) use check::{CheckReport, check};
pub(crate) use modes::{CaseModesReport, ModesDocument, modes};
pub(crate) use path::path;
pub(crate) use run::run;
pub(crate) use statics::statics;
pub(crate) use summary::summary;

use std::panic::resume_unwind;
use std::sync::atomic::{AtomicUsize, Ordering};

use catenix_model::file::read_study;
use catenix_model::{LoadCase, Study};
use catenix_results::Status;

use crate::args::{ModelArgs, WorkArgs};
use crate::failure::{Exit, Failure};
use crate::interrupt::Interrupt;
use crate::print;
use crate::progress::{CaseProgress, Progress};

/// Prints the JSON schema of the model file.
pub(crate) fn schema() -> Result<Exit, Failure> {
    print::json(&catenix_model::file::json_schema());
    Ok(Exit::Success)
}

/// Reads the model file.
fn read(args: &ModelArgs) -> Result<Study, Failure> {
    Ok(read_study(&args.file).map_err(Box::new)?)
}

/// The cases that the user wants, in file order; all of them when none is named.
fn chosen_cases<'a>(study: &'a Study, args: &ModelArgs) -> Result<Vec<&'a LoadCase>, Failure> {
    let known = |name: &String| study.cases.iter().any(|case| case.name == *name);
    if let Some(name) = args.cases.iter().find(|name| !known(name)) {
        let names: Vec<&str> = study.cases.iter().map(|case| case.name.as_str()).collect();
        return Err(Failure::UnknownCase {
            name: name.clone(),
            available: names.join(", "),
        });
    }
    let chosen = |case: &&LoadCase| args.cases.is_empty() || args.cases.contains(&case.name);
    Ok(study.cases.iter().filter(chosen).collect())
}

/// Does `work` for every case on several threads, begun in file order; the results are in that
/// order too.
///
/// Plain threads that take the next case from a queue: a case is seconds to hours of work, and a
/// pool that splits the list in halves would begin with the first and the middle one.
fn for_each_case<T: Send>(
    cases: &[&LoadCase],
    args: &WorkArgs,
    interrupt: &Interrupt,
    work: impl Fn(&LoadCase, &CaseProgress<'_>) -> T + Sync,
) -> Vec<T> {
    let available = || std::thread::available_parallelism().map_or(1, usize::from);
    let threads = args
        .threads
        .map_or_else(available, usize::from)
        .min(cases.len());
    let progress = Progress::new(
        args.quiet,
        cases.iter().map(|case| case.name.chars().count()),
    );
    let next = AtomicUsize::new(0);
    let take_cases = || {
        let mut done = Vec::new();
        while let Some(case) = cases.get(next.fetch_add(1, Ordering::Relaxed)) {
            let result = work(case, &progress.begin(&case.name, interrupt));
            done.push((case.name.as_str(), result));
        }
        done
    };
    let mut results: Vec<(&str, T)> = std::thread::scope(|scope| {
        let workers: Vec<_> = (0..threads).map(|_| scope.spawn(take_cases)).collect();
        workers
            .into_iter()
            .flat_map(|worker| worker.join().unwrap_or_else(|panic| resume_unwind(panic)))
            .collect()
    });
    results.sort_by_key(|(name, _)| cases.iter().position(|case| case.name == *name));
    results.into_iter().map(|(_, result)| result).collect()
}

/// Exit code of a study that ended with this status.
fn exit_of(status: Status) -> Exit {
    match status {
        Status::Complete => Exit::Success,
        Status::Interrupted => Exit::Interrupted,
        Status::Failed | Status::Running | Status::Pending => Exit::SolverFailed,
    }
}
