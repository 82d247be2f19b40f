//! `catenix modes`: natural frequencies and mode shapes about the static equilibrium.

use std::path::{Path, PathBuf};

use catenix_model::{LoadCase, ModeRange, ModeSettings, Study};
use catenix_report::{figure::Chart, mode_charts, write_figure};
use catenix_results::{CaseModes, CaseSummary, ModesReport, ResultStore, Status, StoreError};
use catenix_study::compute_modes;
use indexmap::IndexMap;
use serde::Serialize;

use super::run::provenance;
use super::statics::study_summary;
use super::{chosen_cases, exit_of, for_each_case, read};
use crate::args::ModesArgs;
use crate::failure::{Document, Exit, Failure};
use crate::interrupt::Interrupt;
use crate::{print, tables};

/// What `modes --json` prints.
#[derive(Debug, Serialize)]
pub(crate) struct ModesDocument<'a> {
    catenix_version: &'a str,
    pub(crate) title: &'a str,
    pub(crate) note: &'a str,
    model_file: &'a str,
    model_sha256: &'a str,
    status: Status,
    /// Load cases by name.
    pub(crate) cases: IndexMap<&'a str, CaseModesReport<'a>>,
    /// The store, if one was written.
    results: Option<&'a Path>,
    /// Everything else that was written.
    files: &'a [PathBuf],
}

/// The modes of one load case.
#[derive(Debug, Serialize)]
pub(crate) struct CaseModesReport<'a> {
    #[serde(flatten)]
    pub(crate) summary: ModesCaseSummary<'a>,
    #[serde(flatten)]
    pub(crate) report: Option<&'a ModesReport>,
}

/// How a case ended.
#[derive(Debug, Serialize)]
pub(crate) struct ModesCaseSummary<'a> {
    description: &'a str,
    status: Status,
    error: Option<&'a catenix_results::CaseError>,
    pub(crate) warnings: &'a [String],
    cpu_seconds: Option<f64>,
    wall_seconds: Option<f64>,
}

pub(crate) fn modes(args: &ModesArgs) -> Result<Exit, Failure> {
    let study = still(read(&args.model)?);
    let provenance = provenance(&args.model)?;
    let cases = chosen_cases(&study, &args.model.cases)?;
    let store = match &args.out {
        Some(directory) => Some(ResultStore::create(directory, &study, &cases, &provenance)?),
        None => None,
    };
    let interrupt = Interrupt::listen()?;
    let results = for_each_case(&cases, &args.work, &interrupt, |case, progress| {
        let recorder = store.as_ref().map(|store| store.record_case(case));
        compute_modes(case, &settings(case, args), recorder, progress)
    });
    let (summaries, modes): (Vec<CaseSummary>, Vec<Option<CaseModes>>) = results
        .into_iter()
        .collect::<Result<Vec<_>, StoreError>>()?
        .into_iter()
        .unzip();
    let named = cases.iter().map(|case| case.name.clone()).zip(summaries);
    let summary = study_summary(&study.title, &study.note, &provenance, named);

    let results = store.as_ref().map(|store| store.path().to_path_buf());
    let mut files = Vec::new();
    if let (Some(store), Some(directory)) = (store, &args.out) {
        files.push(store.finish(&summary)?);
        for (case, modes) in cases.iter().zip(&modes) {
            for (line, chart) in modes.iter().flat_map(|modes| charts(&study, case, modes)) {
                let stem = format!("modes_{}_{line}", case.name);
                files.extend(write_figure(&chart.draw(), &stem, directory)?);
            }
        }
    }
    let exit = exit_of(summary.status);
    let reports = summary
        .cases
        .iter()
        .zip(&modes)
        .map(|((name, case), modes)| {
            let report = CaseModesReport {
                summary: ModesCaseSummary {
                    description: &case.description,
                    status: case.status,
                    error: case.error.as_ref(),
                    warnings: &case.warnings,
                    cpu_seconds: case.cpu_seconds,
                    wall_seconds: case.wall_seconds,
                },
                report: modes.as_ref().map(|modes| &modes.report),
            };
            (name.as_str(), report)
        });
    let document = ModesDocument {
        catenix_version: &summary.catenix_version,
        title: &summary.title,
        note: &summary.note,
        model_file: &summary.model_file,
        model_sha256: &summary.model_sha256,
        status: summary.status,
        cases: reports.collect(),
        results: results.as_deref(),
        files: &files,
    };
    if args.output.json {
        print::json(&Document::new("modes", exit, &document));
    } else {
        print::text(&tables::modes_text(&document));
        print::text(&tables::errors_text(&summary));
        if let Some(results) = &results {
            print::text(&tables::files_text(results, &files));
        }
    }
    Ok(exit)
}

/// The study without its motion: the store is to hold the static state and the modes.
fn still(mut study: Study) -> Study {
    for case in &mut study.cases {
        case.model.dynamics = None;
    }
    study.figures.clear();
    study
}

/// What the model file asks for, unless the command line does.
fn settings(case: &LoadCase, args: &ModesArgs) -> ModeSettings {
    let mut settings = case.model.modes.clone();
    if let Some(count) = args.count {
        settings.range = ModeRange::Lowest(count.get());
    }
    if let Some(band) = args.band {
        settings.range = band;
    }
    if args.air {
        settings.added_mass = false;
    }
    settings
}

fn charts(study: &Study, case: &LoadCase, modes: &CaseModes) -> Vec<(String, Chart)> {
    let title = match study.cases.len() {
        1 => study.title.clone(),
        _ => format!("{}, {}", study.title, case.name),
    };
    mode_charts(modes, &title, &study.note)
}
