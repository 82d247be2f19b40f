//! `catenix summary`: the summary of stored results.

use std::path::Path;

use catenix_results::{StoredStudy, Summary};
use serde::Serialize;

use crate::args::SummaryArgs;
use crate::failure::{Document, Exit, Failure};
use crate::{print, tables};

/// What `summary --json` prints.
#[derive(Debug, Serialize)]
struct SummaryReport<'a> {
    #[serde(flatten)]
    summary: &'a Summary,
    results: &'a Path,
}

pub(crate) fn summary(args: &SummaryArgs) -> Result<Exit, Failure> {
    let study = StoredStudy::open(&args.results)?;
    let summary = study.summary()?;
    if args.output.json {
        let report = SummaryReport {
            summary: &summary,
            results: study.path(),
        };
        print::json(&Document::new("summary", Exit::Success, &report));
    } else {
        print::text(&tables::summary_text(&summary));
    }
    Ok(Exit::Success)
}
