//! `catenix statics`: the static equilibrium of each load case.

use catenix_results::{CaseSummary, Provenance, Status, Summary};
use catenix_study::compute_statics;

use super::{chosen_cases, exit_of, for_each_case, read};
use crate::args::StaticsArgs;
use crate::failure::{Document, Exit, Failure};
use crate::interrupt::Interrupt;
use crate::{print, tables};

pub(crate) fn statics(args: &StaticsArgs) -> Result<Exit, Failure> {
    let study = read(&args.model)?;
    let provenance = super::run::provenance(&args.model)?;
    let cases = chosen_cases(&study, &args.model.cases)?;
    let interrupt = Interrupt::listen()?;
    let results = for_each_case(&cases, &args.work, &interrupt, |case, progress| {
        compute_statics(case, args.accuracy.accuracy, progress)
    });
    let named = cases.iter().map(|case| case.name.clone()).zip(results);
    let summary = study_summary(&study.title, &study.note, &provenance, named);
    let exit = exit_of(summary.status);
    if args.output.json {
        print::json(&Document::new("statics", exit, &summary));
    } else {
        print::text(&tables::statics_text(&summary));
    }
    Ok(exit)
}

/// The summary of a study out of those of its cases.
pub(super) fn study_summary(
    title: &str,
    note: &str,
    provenance: &Provenance,
    cases: impl Iterator<Item = (String, CaseSummary)>,
) -> Summary {
    let cases: indexmap::IndexMap<String, CaseSummary> = cases.collect();
    Summary {
        catenix_version: provenance.version.clone(),
        title: title.to_owned(),
        note: note.to_owned(),
        model_file: provenance.model_file.clone(),
        model_sha256: provenance.model_sha256(),
        status: Status::of_study(cases.values().map(|case| case.status)),
        cases,
    }
}
