//! The report of a study out of its result store.

mod builder;
mod data;
mod document;
mod environment;
mod format;
mod histories;
mod key_results;
mod labels;
mod modes;
mod ranges;
mod shapes;
mod solver;
mod system;
mod system_drawing;

use std::path::{Path, PathBuf};

use catenix_results::{Status, StoredStudy};

use self::builder::Builder;
use self::data::StudyData;
use self::document::Page;
use crate::ReportError;
use crate::page::Templates;
use crate::picture::{PNG_SCALE, write};
use crate::words::Language;

/// What a report is to be.
#[derive(Debug, Clone, Default)]
pub struct ReportOptions {
    /// Language of every text that is not from the model file.
    pub language: Language,
    /// Folder for every figure as SVG and PNG.
    pub figures: Option<PathBuf>,
    /// Folder with templates that replace built-in ones.
    pub templates: Option<PathBuf>,
}

/// What was written.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Report {
    /// The page.
    pub report: PathBuf,
    /// Its size.
    pub bytes: usize,
    /// Code of its language.
    pub language: &'static str,
    /// Load cases in the store.
    pub cases: usize,
    /// Load cases that were computed to the end.
    pub complete_cases: usize,
    /// How far the study came.
    pub status: Status,
    /// The tables of the page.
    pub tables: usize,
    /// The figures of the page.
    pub figures: Vec<ReportFigure>,
    /// Built-in templates that were replaced.
    pub templates: Vec<String>,
}

/// A figure that is in the page.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct ReportFigure {
    /// Number in the page.
    pub number: usize,
    /// Title.
    pub title: String,
    /// Its files, where they were asked for.
    pub files: Vec<PathBuf>,
}

/// Writes the report of a store into one HTML file.
pub fn write_report(
    study: &StoredStudy,
    file: &Path,
    options: &ReportOptions,
) -> Result<Report, ReportError> {
    check_target(file)?;
    let templates = Templates::new(options.language, options.templates.as_deref())?;
    let data = StudyData::read(study)?;
    if data.is_empty() {
        return Err(ReportError::Empty {
            path: study.path().to_owned(),
            model_file: data.summary.model_file.clone(),
        });
    }
    let mut builder = Builder::new(options.language, options.figures.is_some());
    let notices = notices(&data, &builder);
    system::add(&data, &mut builder)?;
    environment::add(&data, &mut builder);
    key_results::add(&data, &mut builder);
    shapes::add(&data, &mut builder)?;
    histories::add(&data, &mut builder)?;
    ranges::add(&data, &mut builder)?;
    modes::add(&data, &mut builder)?;
    solver::add_accuracy(&data, &mut builder);
    solver::add_solver(&data, &mut builder)?;
    solver::add_provenance(&data, &mut builder);
    builder.drop_empty();

    let Builder {
        sections, files, ..
    } = builder;
    let summary = &data.summary;
    let page = Page {
        language: options.language.tag(),
        title: match summary.title.as_str() {
            "" => file_name(&summary.model_file),
            title => title.to_owned(),
        },
        note: summary.note.clone(),
        status: summary.status.word(),
        status_text: options.language.text(status_key(summary.status)).to_owned(),
        version: summary.catenix_version.clone(),
        created: date(&data, options.language),
        model_file: summary.model_file.clone(),
        case_count: data.cases.len(),
        notices,
        sections,
    };
    let html = templates.render("report.html", &page)?;
    let blocks = || page.sections.iter().flat_map(|section| &section.blocks);
    let tables = blocks().filter(|block| matches!(block, document::Block::Table(_)));
    let mut figures: Vec<ReportFigure> = blocks()
        .filter_map(|block| match block {
            document::Block::Figure(figure) => Some(ReportFigure {
                number: figure.number,
                title: figure.title.clone(),
                files: Vec::new(),
            }),
            _ => None,
        })
        .collect();
    if let Some(directory) = &options.figures {
        for file in files {
            let stem = directory.join(&file.name);
            let (svg, png) = (stem.with_extension("svg"), stem.with_extension("png"));
            write(&svg, file.drawing.to_svg().as_bytes())?;
            write(&png, &file.drawing.to_png(PNG_SCALE)?)?;
            if let Some(figure) = figures.iter_mut().find(|f| f.number == file.number) {
                figure.files = vec![svg, png];
            }
        }
    }
    write(file, html.as_bytes())?;
    let complete = |case: &&data::CaseData| case.summary.status == Status::Complete;
    Ok(Report {
        report: file.to_owned(),
        bytes: html.len(),
        language: options.language.code(),
        cases: data.cases.len(),
        complete_cases: data.cases.iter().filter(complete).count(),
        status: summary.status,
        tables: tables.count(),
        figures,
        templates: templates.replaced,
    })
}

/// Whether a file can be made there, before anything is computed.
fn check_target(file: &Path) -> Result<(), ReportError> {
    if file.is_dir() {
        return Err(ReportError::IsFolder {
            path: file.to_owned(),
        });
    }
    match file.parent() {
        Some(folder) if folder != Path::new("") && !folder.is_dir() => Err(ReportError::NoFolder {
            path: folder.to_owned(),
        }),
        _ => Ok(()),
    }
}

/// What a reader must know before any number: how far the study came, and why.
fn notices(data: &StudyData<'_>, builder: &Builder) -> Vec<String> {
    let mut notices = Vec::new();
    let complete = |case: &data::CaseData| case.summary.status == Status::Complete;
    if !data.cases.iter().all(complete) {
        let key = match data.summary.status {
            Status::Interrupted => "notice.interrupted",
            Status::Failed => "notice.failed",
            _ => "notice.running",
        };
        notices.push(builder.text(key));
    }
    for case in data.cases.iter().filter(|case| !complete(case)) {
        let status = builder.text(key_results::status_key(case));
        let time = case.summary.simulated_s;
        let time = time
            .filter(|_| case.has_results)
            .map(|time| format::with_unit(time, "s"));
        let values = [
            ("case", case.name.as_str()),
            ("status", &status),
            ("time", time.as_deref().unwrap_or(format::NONE)),
        ];
        let key = match time {
            Some(_) => "notice.case",
            None => "notice.case_without",
        };
        let mut text = builder.fill(key, &values);
        if let Some(error) = &case.summary.error {
            let error = builder.fill("notice.error", &[("message", &error.message)]);
            text = format!("{text} {error}");
        }
        notices.push(text);
    }
    notices
}

/// Key of the word for how far a study or case came.
fn status_key(status: Status) -> &'static str {
    match status {
        Status::Pending => "status.pending",
        Status::Running => "status.running",
        Status::Complete => "status.complete",
        Status::Interrupted => "status.interrupted",
        Status::Failed => "status.failed",
    }
}

/// When the store was made, as people read it.
fn date(data: &StudyData<'_>, language: Language) -> String {
    let created = data.study.attribute("created");
    match created
        .strip_suffix('Z')
        .and_then(|date| date.split_once('T'))
    {
        Some((day, time)) => format!("{day} {time} UTC"),
        None => language.text("provenance.no_date").to_owned(),
    }
}

fn file_name(path: &str) -> String {
    let name = path.rsplit(['/', '\\']).next().unwrap_or(path);
    name.to_owned()
}
