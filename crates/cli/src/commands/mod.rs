//! One file per command.

mod check;
mod compare;
mod export;
mod modes;
mod path;
mod report;
mod run;
mod statics;
mod summary;
mod verify;
mod view;

pub(crate) use check::{CheckReport, check};
pub(crate) use compare::compare;
pub(crate) use export::export;
pub(crate) use modes::{CaseModesReport, ModesDocument, modes};
pub(crate) use path::path;
pub(crate) use report::report;
pub(crate) use run::run;
pub(crate) use statics::statics;
pub(crate) use summary::summary;
pub(crate) use verify::verify;
pub(crate) use view::view;

use catenix_model::file::read_study;
use catenix_model::{LoadCase, Study};
use catenix_results::Status;
use catenix_study::in_parallel;

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
    let mut study = read_study(&args.file).map_err(Box::new)?;
    if let Some(formulation) = args.formulation {
        for case in &mut study.cases {
            case.model.formulation = formulation;
        }
    }
    Ok(study)
}

/// The cases that the user wants, in file order; all of them when none is named.
fn chosen_cases<'a>(study: &'a Study, wanted: &[String]) -> Result<Vec<&'a LoadCase>, Failure> {
    let known = |name: &String| study.cases.iter().any(|case| case.name == *name);
    if let Some(name) = wanted.iter().find(|name| !known(name)) {
        let names: Vec<&str> = study.cases.iter().map(|case| case.name.as_str()).collect();
        return Err(Failure::UnknownCase {
            name: name.clone(),
            available: names.join(", "),
        });
    }
    let chosen = |case: &&LoadCase| wanted.is_empty() || wanted.contains(&case.name);
    Ok(study.cases.iter().filter(chosen).collect())
}

/// Does `work` for every case on several threads; the results are in file order.
fn for_each_case<T: Send>(
    cases: &[&LoadCase],
    args: &WorkArgs,
    interrupt: &Interrupt,
    work: impl Fn(&LoadCase, &CaseProgress<'_>) -> T + Sync,
) -> Vec<T> {
    let names = cases.iter().map(|case| case.name.chars().count());
    let progress = Progress::new(args.quiet, names);
    in_parallel(cases, args.threads, |case| {
        work(case, &progress.begin(&case.name, interrupt))
    })
}

/// Exit code of a study that ended with this status.
fn exit_of(status: Status) -> Exit {
    match status {
        Status::Complete => Exit::Success,
        Status::Interrupted => Exit::Interrupted,
        Status::Failed | Status::Running | Status::Pending => Exit::SolverFailed,
    }
}
