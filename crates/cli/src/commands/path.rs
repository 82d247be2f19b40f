//! `catenix path`: the equilibrium path of each load case.

use std::path::{Path, PathBuf};

use catenix_report::{PNG_SCALE, path_chart};
use catenix_results::{CasePath, Status, StoreError, StudyPaths};
use catenix_study::compute_path;
use serde::Serialize;

use super::run::provenance;
use super::{chosen_cases, exit_of, for_each_case, read};
use crate::args::PathArgs;
use crate::failure::{Document, Exit, Failure};
use crate::interrupt::Interrupt;
use crate::{print, tables};

/// What `path --json` prints.
#[derive(Debug, Serialize)]
struct PathReport<'a> {
    #[serde(flatten)]
    paths: &'a StudyPaths,
    /// Everything that was written.
    files: &'a [PathBuf],
}

pub(crate) fn path(args: &PathArgs) -> Result<Exit, Failure> {
    let study = read(&args.model)?;
    let provenance = provenance(&args.model)?;
    let cases = chosen_cases(&study, &args.model.cases)?;
    let interrupt = Interrupt::listen()?;
    let results = for_each_case(&cases, &args.work, &interrupt, |case, progress| {
        compute_path(case, progress)
    });
    let named = cases.iter().map(|case| case.name.clone()).zip(results);
    let cases: indexmap::IndexMap<String, CasePath> = named.collect();
    let paths = StudyPaths {
        catenix_version: provenance.version.clone(),
        title: study.title.clone(),
        note: study.note.clone(),
        model_file: provenance.model_file.clone(),
        model_sha256: provenance.model_sha256(),
        status: Status::of_study(cases.values().map(|case| case.status)),
        cases,
    };
    let mut files = Vec::new();
    if let Some(file) = &args.csv {
        files.push(write(file, paths.to_csv().as_bytes())?);
    }
    if let Some(file) = &args.figure {
        files.push(write(
            file,
            &figure(&paths, args.channel.as_deref(), file)?,
        )?);
    }
    let exit = exit_of(paths.status);
    if args.output.json {
        let report = PathReport {
            paths: &paths,
            files: &files,
        };
        print::json(&Document::new("path", exit, &report));
    } else {
        print::text(&tables::path_text(&paths, &files));
    }
    Ok(exit)
}

/// The figure as the bytes of an SVG or PNG file.
fn figure(paths: &StudyPaths, channel: Option<&str>, file: &Path) -> Result<Vec<u8>, Failure> {
    let wanted = channel.or_else(|| paths.default_channel());
    let chart = wanted.and_then(|name| path_chart(paths, name));
    let Some(chart) = chart else {
        let mut known = paths.cases.values().flat_map(|case| case.channels.keys());
        return Err(Failure::UnknownChannel {
            name: wanted.unwrap_or_default().to_owned(),
            example: known.next().cloned().unwrap_or_default(),
        });
    };
    let drawing = chart.draw();
    let is_png = file
        .extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case("png"));
    if is_png {
        return Ok(drawing.to_png(PNG_SCALE)?);
    }
    Ok(drawing.to_svg().into_bytes())
}

fn write(file: &Path, content: &[u8]) -> Result<PathBuf, Failure> {
    std::fs::write(file, content).map_err(|source| StoreError::Write {
        path: file.to_owned(),
        source,
    })?;
    Ok(file.to_owned())
}
