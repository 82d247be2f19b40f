//! `catenix report`: one HTML file about stored results.

use std::path::{Path, PathBuf};

use catenix_report::{Report, ReportOptions, write_report};
use catenix_results::StoredStudy;
use serde::Serialize;

use crate::args::ReportArgs;
use crate::failure::{Document, Exit, Failure};
use crate::print;

/// What `report --json` prints.
#[derive(Debug, Serialize)]
struct ReportDocument<'a> {
    /// The store.
    results: &'a Path,
    #[serde(flatten)]
    written: &'a Report,
}

pub(crate) fn report(args: &ReportArgs) -> Result<Exit, Failure> {
    let study = StoredStudy::open(&args.results)?;
    let file = match &args.output {
        Some(file) => file.clone(),
        None => beside(study.path()),
    };
    let options = ReportOptions {
        language: args.lang,
        figures: args.figures.clone(),
        templates: args.templates.clone(),
    };
    let written = write_report(&study, &file, &options)?;
    if args.json {
        let document = ReportDocument {
            results: study.path(),
            written: &written,
        };
        print::json(&Document::new("report", Exit::Success, &document));
    } else {
        print::text(&text(&written, args.figures.as_deref()));
    }
    Ok(Exit::Success)
}

/// The report's default place: beside the store.
fn beside(store: &Path) -> PathBuf {
    store.parent().unwrap_or(store).join("report.html")
}

fn text(written: &Report, figures: Option<&Path>) -> String {
    let count = |count: usize, what: &str| match count {
        1 => format!("1 {what}"),
        count => format!("{count} {what}s"),
    };
    let mut text = format!(
        "Written: {} ({} kB, {}, {}, {})\n",
        written.report.display(),
        written.bytes.div_ceil(1000),
        count(written.cases, "load case"),
        count(written.figures.len(), "figure"),
        count(written.tables, "table"),
    );
    if let Some(figures) = figures {
        text.push_str(&format!(
            "         {}: every figure as SVG and PNG\n",
            figures.display()
        ));
    }
    if written.complete_cases < written.cases {
        text.push_str(&format!(
            "Note: {} of {} load cases are complete; the report says how far the others came.\n",
            written.complete_cases, written.cases
        ));
    }
    text
}
