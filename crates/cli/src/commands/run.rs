//! `catenix run`: computes the load cases, writes results and figures, prints a summary.

use std::path::{Path, PathBuf};

use catenix_report::{study_chart, write_figure};
use catenix_results::{Provenance, ResultStore, StoreError, StoredStudy, Summary};
use catenix_study::{Equilibria, compute_case};
use serde::Serialize;

use super::statics::study_summary;
use super::{chosen_cases, exit_of, for_each_case, read, view};
use crate::args::{ListenArgs, ModelArgs, RunArgs};
use crate::failure::{Document, Exit, Failure};
use crate::interrupt::Interrupt;
use crate::{print, tables};

/// What `run --json` prints.
#[derive(Debug, Serialize)]
struct RunReport<'a> {
    #[serde(flatten)]
    summary: &'a Summary,
    /// The store.
    results: &'a Path,
    /// Everything else that was written.
    files: &'a [PathBuf],
}

pub(crate) fn run(args: &RunArgs) -> Result<Exit, Failure> {
    let study = read(&args.model)?;
    let provenance = provenance(&args.model)?;
    let cases = chosen_cases(&study, &args.model.cases)?;
    let directory = args
        .out
        .clone()
        .unwrap_or_else(|| default_directory(&args.model.file));
    let store = ResultStore::create(&directory, &study, &cases, &provenance)?;
    let interrupt = Interrupt::listen()?;
    let live = &args.live;
    if live.live {
        let listen = ListenArgs {
            port: live.port,
            address: None,
            no_open: live.no_open,
        };
        view::start(store.path(), &listen)?;
    }
    let equilibria = Equilibria::default();
    let results = for_each_case(&cases, &args.work, &interrupt, |case, progress| {
        compute_case(case, &store, args.accuracy.accuracy, &equilibria, progress)
    });
    let results = results
        .into_iter()
        .collect::<Result<Vec<_>, StoreError>>()?;
    let named = cases.iter().map(|case| case.name.clone()).zip(results);
    let summary = study_summary(&study.title, &study.note, &provenance, named);

    let results = store.path().to_path_buf();
    let mut files = vec![store.finish(&summary)?];
    files.extend(write_figures(&results, &directory)?);
    let exit = exit_of(summary.status);
    if args.output.json {
        let report = RunReport {
            summary: &summary,
            results: &results,
            files: &files,
        };
        print::json(&Document::new("run", exit, &report));
    } else {
        print::text(&tables::summary_text(&summary));
        print::text(&tables::files_text(&results, &files));
    }
    if live.live && !interrupt.requested() {
        print::error("computed; the viewer goes on until Ctrl-C");
        view::wait(&interrupt);
    }
    Ok(exit)
}

/// Draws every figure of the study as SVG and PNG.
fn write_figures(store: &Path, directory: &Path) -> Result<Vec<PathBuf>, Failure> {
    let study = StoredStudy::open(store)?;
    let mut files = Vec::new();
    for figure in study.figures() {
        let drawing = study_chart(&study, &figure)?.draw();
        files.extend(write_figure(&drawing, &figure.name, directory)?);
    }
    Ok(files)
}

/// Version, model file, and its text.
pub(super) fn provenance(model: &ModelArgs) -> Result<Provenance, Failure> {
    let file = model.file.display().to_string();
    let text = std::fs::read_to_string(&model.file).map_err(|source| Failure::Read {
        path: file.clone(),
        source,
    })?;
    Ok(Provenance {
        version: env!("CARGO_PKG_VERSION").to_owned(),
        model_file: file,
        model_text: text,
    })
}

fn default_directory(model: &Path) -> PathBuf {
    Path::new("results").join(model.file_stem().unwrap_or_else(|| "model".as_ref()))
}
