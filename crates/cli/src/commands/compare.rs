//! `catenix compare`: formulations of one model side by side.

use std::path::PathBuf;

use catenix_model::FormulationKind;
use catenix_model::file::read_study;
use catenix_report::{cost_chart, write_figure};
use catenix_results::FormulationStudy;
use catenix_study::{ComparisonSettings, compare_formulations};
use serde::Serialize;

use super::chosen_cases;
use crate::args::CompareArgs;
use crate::failure::{Document, Exit, Failure};
use crate::interrupt::Interrupt;
use crate::memory::PeakMemory;
use crate::progress::Progress;
use crate::{print, tables};

/// Steps of the reference, over those of the model file.
const REFERENCE_STEP: f64 = 0.5;

/// What `compare --json` prints.
#[derive(Debug, Serialize)]
struct CompareReport<'a> {
    #[serde(flatten)]
    study: &'a FormulationStudy,
    /// Figures written.
    files: &'a [PathBuf],
}

pub(crate) fn compare(args: &CompareArgs) -> Result<Exit, Failure> {
    let study = read_study(&args.file).map_err(Box::new)?;
    let cases = chosen_cases(&study, &args.cases)?;
    let settings = settings(args);
    let interrupt = Interrupt::listen()?;
    let names = cases.iter().map(|case| case.name.chars().count());
    let progress = Progress::new(args.quiet, names);
    let memory = PeakMemory::default();
    // One after the other, so that their times compare.
    let mut compared = Vec::new();
    for case in cases {
        if interrupt.requested() {
            break;
        }
        let bar = progress.begin(&case.name, &interrupt);
        compared.push(compare_formulations(case, &settings, &bar, &memory));
    }
    let found = FormulationStudy {
        catenix_version: env!("CARGO_PKG_VERSION").to_owned(),
        title: study.title.clone(),
        target: args.target,
        cases: compared,
    };
    let mut files = Vec::new();
    if let Some(directory) = &args.out {
        for case in &found.cases {
            if let Some(chart) = cost_chart(case, &found.title, found.target) {
                let name = format!("cost-{}", case.name);
                files.extend(write_figure(&chart.draw(), &name, directory)?);
            }
        }
    }
    let exit = if interrupt.requested() {
        Exit::Interrupted
    } else if found.cases.iter().all(|case| case.reference.is_some()) {
        Exit::Success
    } else {
        Exit::SolverFailed
    };
    if args.output.json {
        let report = CompareReport {
            study: &found,
            files: &files,
        };
        print::json(&Document::new("compare", exit, &report));
    } else {
        print::text(&tables::comparison_text(&found));
        for file in &files {
            print::text(&format!("Written: {}\n", file.display()));
        }
    }
    Ok(exit)
}

fn settings(args: &CompareArgs) -> ComparisonSettings {
    let mut formulations: Vec<FormulationKind> = Vec::new();
    for &kind in &args.formulations {
        if !formulations.contains(&kind) {
            formulations.push(kind);
        }
    }
    let mut meshes = args.meshes.clone();
    meshes.push(1.0);
    meshes.sort_by(f64::total_cmp);
    meshes.dedup();
    ComparisonSettings {
        reference: args.reference.unwrap_or(formulations[0]),
        formulations,
        reference_mesh: args.reference_mesh,
        reference_step: REFERENCE_STEP,
        meshes,
        target: args.target,
    }
}
