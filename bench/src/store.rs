//! The raw numbers, and the page that is made of them.
//!
//! `results.json` holds what every section measured last, with its circumstances; `RESULTS.md` and
//! the figures are made of it and of nothing else. A section that runs alone replaces its own part.

use std::fmt::Write as _;
use std::path::Path;

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use crate::context::{make_folder, read_text, write_text};
use crate::machine::Circumstances;
use crate::markdown::digits;
use crate::sections::{SECTIONS, Section};

/// The file of raw numbers.
pub(crate) const RAW: &str = "results.json";
/// The page.
pub(crate) const PAGE: &str = "RESULTS.md";

/// What is known of why things take the time that they take.
const SPEED: &str = include_str!("../../docs/theory/speed.md");
/// The heading of the part of it that the page repeats.
const NOT_REACHED: &str = "## What is not reached\n";

/// What one section measured.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct Entry {
    /// On what, with and when.
    pub circumstances: Circumstances,
    /// The section's own numbers.
    pub data: Value,
}

/// Puts a section's numbers beside those of the others, and makes page and figures again.
pub(crate) fn keep(folder: &Path, section: &Section, entry: Entry) -> Result<(), String> {
    make_folder(folder)?;
    let mut all = read(folder)?;
    // Numbers that an earlier version of a section kept would stop the page.
    all.retain(|name, value| {
        let section = SECTIONS.iter().find(|section| section.name == name);
        let shown = section.map(|section| (section.markdown)(&value["data"]));
        let readable = matches!(shown, Some(Ok(_)));
        if !readable {
            eprintln!("dropped the numbers of `{name}`, which an earlier version kept");
        }
        readable
    });
    let value = serde_json::to_value(entry).map_err(|error| error.to_string())?;
    all.insert(section.name.to_owned(), value);
    let ordered: Map<String, Value> = SECTIONS
        .iter()
        .filter_map(|section| Some((section.name.to_owned(), all.remove(section.name)?)))
        .collect();
    let text = serde_json::to_string_pretty(&ordered).map_err(|error| error.to_string())?;
    write_text(&folder.join(RAW), &format!("{text}\n"))?;
    write_page(folder)
}

/// Makes page and figures from the raw numbers.
pub(crate) fn write_page(folder: &Path) -> Result<(), String> {
    let all = read(folder)?;
    for section in SECTIONS {
        if let Some(entry) = entry_of(&all, section)? {
            for (name, chart) in (section.charts)(&entry.data)? {
                catenix_report::write_figure(&chart.draw(), &name, folder)
                    .map_err(|error| error.to_string())?;
                // Pages show the vector picture; the other is for looking at by hand.
                let _ = std::fs::remove_file(folder.join("figures").join(format!("{name}.png")));
            }
        }
    }
    write_text(&folder.join(PAGE), &page(&all)?)
}

fn read(folder: &Path) -> Result<Map<String, Value>, String> {
    let file = folder.join(RAW);
    if !file.exists() {
        return Ok(Map::new());
    }
    serde_json::from_str(&read_text(&file)?).map_err(|error| format!("{}: {error}", file.display()))
}

fn entry_of(all: &Map<String, Value>, section: &Section) -> Result<Option<Entry>, String> {
    let Some(value) = all.get(section.name) else {
        return Ok(None);
    };
    serde_json::from_value(value.clone())
        .map(Some)
        .map_err(|error| format!("{RAW}, {}: {error}", section.name))
}

/// The page's text.
fn page(all: &Map<String, Value>) -> Result<String, String> {
    let mut text = String::from(
        "# Benchmark results\n\n\
         Written by `cargo xtask bench`; do not edit by hand. What is measured, how, and how fair it\n\
         is to the peers stands in [docs/benchmarks.md](../docs/benchmarks.md), the raw numbers in\n\
         [results.json](results.json). Times are processor times; the fastest of several repeats\n\
         counts. Every section is one run, in which what is compared took turns.\n\n",
    );
    text.push_str(&not_reached()?);
    for section in SECTIONS {
        let Some(entry) = entry_of(all, section)? else {
            continue;
        };
        let _ = write!(text, "\n## {}\n\n", section.title);
        text.push_str(&(section.markdown)(&entry.data).map_err(|error| {
            format!(
                "{}: {error}; measure it again: `cargo xtask bench {}`",
                section.title, section.name
            )
        })?);
        text.push('\n');
        text.push_str(&circumstances(&entry.circumstances));
    }
    Ok(text)
}

/// The part of the theory that says what is not reached, with its links as they are from here.
fn not_reached() -> Result<String, String> {
    let (_, rest) = SPEED
        .split_once(NOT_REACHED)
        .ok_or_else(|| format!("docs/theory/speed.md has no `{NOT_REACHED}`"))?;
    let part = rest.split("\n## ").next().unwrap_or(rest);
    let part = part.replace("](#", "](../docs/theory/speed.md#");
    Ok(format!("{NOT_REACHED}{}\n", part.trim_end()))
}

fn circumstances(c: &Circumstances) -> String {
    let load = |value: Option<f64>| value.map_or("unknown".to_owned(), |load| format!("{load:.2}"));
    format!(
        "*`{}` on {}: {}, {} processors, {}; Catenix {}, {}; load {} before and {} after; {} s.*\n",
        c.command,
        c.date,
        c.processor,
        c.processors,
        c.system,
        c.catenix,
        c.rustc,
        load(c.load[0]),
        load(c.load[1]),
        digits(c.elapsed_s),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::context::workspace_root;

    #[test]
    fn the_page_is_what_the_raw_numbers_say() {
        let folder = workspace_root().join("bench");
        let page_text = page(&read(&folder).expect("raw numbers")).expect("a page");
        let committed = read_text(&folder.join(PAGE)).expect("the page");
        assert!(
            committed == page_text,
            "bench/{PAGE} is not what bench/{RAW} says: run `cargo xtask bench page`"
        );
    }
}
