//! `catenix check`: reads the model, assembles every case, prints what it describes.

use catenix_engine::System;
use catenix_results::ModelOverview;
use indexmap::IndexMap;
use serde::Serialize;

use super::{chosen_cases, read};
use crate::args::CheckArgs;
use crate::failure::{Document, Exit, Failure};
use crate::{print, tables};

/// What `check --json` prints about a good model.
#[derive(Debug, Serialize)]
pub(crate) struct CheckReport<'a> {
    catenix_version: &'static str,
    pub(crate) title: &'a str,
    pub(crate) note: &'a str,
    pub(crate) model_file: String,
    /// Load cases by name.
    pub(crate) cases: IndexMap<&'a str, CaseReport<'a>>,
    /// Names of the figures.
    pub(crate) figures: Vec<&'a str>,
}

/// One load case of a good model.
#[derive(Debug, Serialize)]
pub(crate) struct CaseReport<'a> {
    pub(crate) description: &'a str,
    #[serde(flatten)]
    pub(crate) overview: ModelOverview,
    /// Number of references that the case is compared with.
    pub(crate) references: usize,
}

pub(crate) fn check(args: &CheckArgs) -> Result<Exit, Failure> {
    let study = read(&args.model)?;
    let cases = chosen_cases(&study, &args.model.cases)?;
    for case in &cases {
        System::new(&case.model).map_err(|error| Failure::System {
            case: case.name.clone(),
            message: error.to_string(),
        })?;
    }
    let reports = cases.iter().map(|case| {
        let report = CaseReport {
            description: &case.description,
            overview: ModelOverview::new(&case.model),
            references: case.references.len(),
        };
        (case.name.as_str(), report)
    });
    let report = CheckReport {
        catenix_version: env!("CARGO_PKG_VERSION"),
        title: &study.title,
        note: &study.note,
        model_file: args.model.file.display().to_string(),
        cases: reports.collect(),
        figures: study
            .figures
            .iter()
            .map(|figure| figure.name.as_str())
            .collect(),
    };
    if args.output.json {
        print::json(&Document::new("check", Exit::Success, &report));
    } else {
        print::text(&tables::check_text(&report));
    }
    Ok(Exit::Success)
}
