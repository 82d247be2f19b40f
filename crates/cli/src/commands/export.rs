//! `catenix export`: results as files for other programs.

use std::cell::Cell;
use std::path::{Path, PathBuf};

use catenix_export::{ExportRequest, ExportWatch, Exported, Thinning, export as export_study};
use catenix_results::StoredStudy;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use serde::Serialize;

use crate::args::ExportArgs;
use crate::failure::{Document, Exit, Failure};
use crate::interrupt::Interrupt;
use crate::{print, tables};

/// What `export --json` prints.
#[derive(Debug, Serialize)]
struct ExportReport<'a> {
    format: &'static str,
    results: &'a Path,
    directory: &'a Path,
    #[serde(flatten)]
    exported: &'a Exported,
}

pub(crate) fn export(args: &ExportArgs) -> Result<Exit, Failure> {
    let study = StoredStudy::open(&args.results)?;
    let format = args.to.0;
    let directory = args
        .out
        .clone()
        .unwrap_or_else(|| beside(study.path(), format.word()));
    let request = ExportRequest {
        format,
        directory,
        cases: args.cases.clone(),
        lines: args.lines.clone(),
        thinning: match (args.every, args.times) {
            (Some(n), _) => Thinning::Every(n.get()),
            (None, Some(times)) => times,
            (None, None) => Thinning::All,
        },
        fields: args.fields,
        force: args.force,
    };
    let interrupt = Interrupt::listen()?;
    let bar = Bar::new(args.quiet, interrupt);
    let exported = export_study(&study, &request, &bar)?;
    bar.bar.finish_and_clear();
    if args.output.json {
        let report = ExportReport {
            format: format.word(),
            results: study.path(),
            directory: &request.directory,
            exported: &exported,
        };
        print::json(&Document::new("export", Exit::Success, &report));
    } else {
        print::text(&tables::export_text(&exported));
    }
    Ok(Exit::Success)
}

/// `export/<format>` in the directory that holds the store.
fn beside(store: &Path, format: &str) -> PathBuf {
    let directory = store.parent().unwrap_or(store);
    directory.join("export").join(format)
}

/// One progress bar on standard error, when that is a terminal.
struct Bar {
    bar: ProgressBar,
    shown: Cell<bool>,
    interrupt: Interrupt,
}

impl Bar {
    fn new(quiet: bool, interrupt: Interrupt) -> Self {
        let target = if quiet {
            ProgressDrawTarget::hidden()
        } else {
            ProgressDrawTarget::stderr()
        };
        // The template is a constant, and a test reads it.
        let style = ProgressStyle::with_template(TEMPLATE)
            .unwrap_or_else(|_| ProgressStyle::default_bar())
            .progress_chars("=> ");
        Bar {
            bar: ProgressBar::with_draw_target(Some(0), target).with_style(style),
            shown: Cell::new(false),
            interrupt,
        }
    }
}

const TEMPLATE: &str = "{msg} [{bar:40}] {percent} % {eta} left";

impl ExportWatch for Bar {
    fn progress(&self, what: &str, done: u64, total: u64) {
        if !self.shown.replace(true) {
            self.bar.set_length(total);
            self.bar.reset_eta();
        }
        self.bar.set_message(what.to_owned());
        self.bar.set_position(done);
    }

    fn stop(&self) -> bool {
        self.interrupt.requested()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hidden_bar_goes_through_its_life() {
        let bar = Bar::new(true, Interrupt::default());
        bar.progress("a.csv", 1, 2);
        assert!(!bar.stop());
        assert!(ProgressStyle::with_template(TEMPLATE).is_ok());
        assert_eq!(
            beside(Path::new("out/results.zarr"), "csv"),
            Path::new("out/export/csv")
        );
    }
}
