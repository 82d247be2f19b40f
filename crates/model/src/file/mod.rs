//! The model file: from TOML text to a validated [`Study`].
//!
//! Three steps, each of which collects its errors and goes on as far as it can: the text becomes a
//! tree of `node`s with their places; `tables` read the tree into typed, dimension-checked
//! values; `resolve` turns names into indices and checks the system. Load cases are laid over the
//! base as trees, so that an override is read and checked like anything else.

mod band;
mod define;
mod diagnostic;
mod dimension;
mod load;
mod log;
mod node;
mod quantity;
mod read;
mod reference;
mod resolve;
mod schema;
mod shape;
mod syntax;
mod tables;
mod unit_table;
mod units;

use std::path::Path;

use crate::{Figure, LoadCase, Study};

pub use band::parse_band;
pub use diagnostic::{Diagnostic, DiagnosticCode, ModelFileErrors};
pub use load::MOST_BYTES;
pub use reference::reference_markdown;
pub use schema::json_schema;

use log::{Finding, Log, join_cases};
use node::{Entries, Node, NodeValue, merge};
use read::{Read, ReadTable};
use resolve::{Histories, ResolvedCase, resolve_case};
use tables::{CaseTable, ModelTable, StudyTable};

/// Name of the only load case of a file without load cases.
const BASE_CASE: &str = "base";

/// Reads and checks a model file.
///
/// # Errors
///
/// All errors of the file at once, each with its position and a remedy.
pub fn read_study(path: &Path) -> Result<Study, ModelFileErrors> {
    let file_name = path.display().to_string();
    let text = load::read_text(path, &file_name)?;
    let base_dir = path.parent().unwrap_or(Path::new(""));
    parse_study(&text, &file_name, base_dir)
}

/// Reads and checks the text of a model file.
///
/// `file_name` is for messages; the CSV files that the text names are relative to `base_dir`.
///
/// # Errors
///
/// All errors of the text at once, each with its position and a remedy.
pub fn parse_study(text: &str, file_name: &str, base_dir: &Path) -> Result<Study, ModelFileErrors> {
    load::check_text(text, file_name)?;
    let (table, syntax_errors) = toml::de::DeTable::parse_recoverable(text);
    if !syntax_errors.is_empty() {
        let findings = syntax::findings(text, &syntax_errors);
        return Err(ModelFileErrors::new(file_name, text, findings));
    }
    let default_title = || {
        let stem = Path::new(file_name).file_stem();
        stem.map_or_else(String::new, |stem| stem.to_string_lossy().into_owned())
    };
    study(
        &Node::document(&table),
        default_title,
        &mut Histories::new(base_dir),
    )
    .map_err(|findings| ModelFileErrors::new(file_name, text, findings))
}

fn study(
    document: &Node,
    default_title: impl FnOnce() -> String,
    histories: &mut Histories,
) -> Result<Study, Vec<Finding>> {
    let mut log = Log::default();
    let mut beside: Vec<&str> = ModelTable::KEYS.to_vec();
    beside.push("cases");
    let header = StudyTable::read_beside(document, &beside, &mut log);
    let document_entries = document.entries().cloned().unwrap_or_default();
    let base = only_keys(&document_entries, ModelTable::KEYS);
    let overrides = read_cases(document_entries.get("cases"), &mut log);
    let Some(header) = header else {
        return Err(log.findings);
    };
    let title = header.title.map_or_else(default_title, |title| title.value);

    let mut case_logs = Vec::new();
    let mut resolved_cases: Vec<(String, String, Option<ResolvedCase>)> = Vec::new();
    for case in overrides {
        let mut case_log = Log::default();
        let mut entries = base.clone();
        merge(&mut entries, &case.entries);
        let node = Node {
            value: NodeValue::Table(entries),
            ..Node::implied("", document, false.into())
        };
        let references = case.table.references.unwrap_or_default();
        let resolved = ModelTable::read(&node, &mut case_log).and_then(|table| {
            resolve_case(
                &title,
                &table,
                &references,
                &header.figures,
                histories,
                &mut case_log,
            )
        });
        let description = case
            .table
            .description
            .map_or_else(String::new, |text| text.value);
        case_logs.push((case.name.clone(), case_log));
        resolved_cases.push((case.name, description, resolved));
    }
    log.findings.extend(join_cases(case_logs));
    if !log.is_empty() {
        return Err(log.findings);
    }
    let figure_channels = resolved_cases
        .first()
        .and_then(|(_, _, resolved)| resolved.as_ref())
        .map_or_else(Vec::new, |resolved| resolved.figure_channels.clone());
    let titles = header
        .figures
        .0
        .into_iter()
        .filter_map(|figure| Some((figure.name, figure.item?.title.map(|title| title.value))));
    let figures = titles.zip(figure_channels).map(|((name, title), channel)| {
        let title = title.unwrap_or_else(|| channel.name.clone());
        Figure {
            name,
            title,
            channel,
        }
    });
    let figures = figures.collect();
    let cases = resolved_cases
        .into_iter()
        .filter_map(|(name, description, resolved)| {
            let ResolvedCase {
                model, references, ..
            } = resolved?;
            Some(LoadCase {
                name,
                description,
                model,
                references,
            })
        });
    let note = header.note.map_or_else(String::new, |note| note.value);
    Ok(Study {
        title,
        note,
        cases: cases.collect(),
        figures,
    })
}

/// A load case as written: its own keys, and what it lays over the base.
struct CaseOverride {
    name: String,
    table: CaseTable,
    entries: Entries,
}

/// The load cases; one without overrides when the file has none.
fn read_cases(node: Option<&Node>, log: &mut Log) -> Vec<CaseOverride> {
    let no_cases = || {
        let table = CaseTable {
            description: None,
            references: None,
            key_span: 0..0,
        };
        vec![CaseOverride {
            name: BASE_CASE.to_owned(),
            table,
            entries: Entries::new(),
        }]
    };
    let Some(node) = node else { return no_cases() };
    // Names are checked like those of all named objects; the contents are read below.
    let Some(names) = read::Named::<RawTable>::read(node, log) else {
        return no_cases();
    };
    let entries = node.entries().cloned().unwrap_or_default();
    let mut cases = Vec::new();
    for name in names.0 {
        let Some(case) = entries.get(&name.name) else {
            continue;
        };
        if let Some(table) = CaseTable::read_beside(case, ModelTable::KEYS, log) {
            let entries = only_keys(case.entries().unwrap_or(&entries), ModelTable::KEYS);
            cases.push(CaseOverride {
                name: name.name,
                table,
                entries,
            });
        }
    }
    if cases.is_empty() { no_cases() } else { cases }
}

/// A table that is read elsewhere.
struct RawTable;

impl Read for RawTable {
    fn read(_node: &Node, _log: &mut Log) -> Option<Self> {
        Some(RawTable)
    }

    fn shape() -> shape::Shape {
        shape::Shape::Table(CaseTable::table_shape())
    }
}

fn only_keys(entries: &Entries, keys: &[&str]) -> Entries {
    let kept = entries
        .iter()
        .filter(|(key, _)| keys.contains(&key.as_str()));
    kept.map(|(key, node)| (key.clone(), node.clone()))
        .collect()
}
