//! Names of objects and the references to them.

use std::collections::HashMap;

use crate::SupportRef;
use crate::file::diagnostic::DiagnosticCode as Code;
use crate::file::log::{Log, closest, one_of};
use crate::file::read::{Named, Text};
use crate::file::tables::ModelTable;

/// Most names that a message lists.
const MOST_LISTED: usize = 12;

/// Index of each name of one kind.
#[derive(Debug, Default)]
pub(super) struct Lookup {
    what: &'static str,
    names: Vec<String>,
    indices: HashMap<String, usize>,
}

/// A line or a body, by index.
#[derive(Debug, Clone, Copy)]
pub(super) enum LoadTarget {
    /// Index of a line.
    Line(usize),
    /// Index of a body.
    Body(usize),
}

/// All names of a load case.
#[derive(Debug)]
pub(super) struct Names {
    /// Cross sections.
    pub line_types: Lookup,
    /// Motions.
    pub motions: Lookup,
    /// Vessels, then anchors: indices of the model's vessels.
    pub vessels: Lookup,
    /// How many of the vessels are no anchors.
    pub moving_vessels: usize,
    /// Bodies.
    pub bodies: Lookup,
    /// Lines.
    pub lines: Lookup,
    /// Loads.
    pub loads: Lookup,
}

impl Lookup {
    fn new(what: &'static str) -> Self {
        Lookup {
            what,
            ..Lookup::default()
        }
    }

    fn add<T>(mut self, named: &Named<T>) -> Self {
        for item in &named.0 {
            let index = self.names.len();
            self.names.push(item.name.clone());
            self.indices.entry(item.name.clone()).or_insert(index);
        }
        self
    }

    /// Index of a name.
    pub fn get(&self, name: &str) -> Option<usize> {
        self.indices.get(name).copied()
    }

    /// All names.
    pub fn iter(&self) -> impl Iterator<Item = &str> + Clone {
        self.names.iter().map(String::as_str)
    }

    /// Index of a referenced name; notes an error when there is none.
    pub fn find(&self, reference: &Text, log: &mut Log) -> Option<usize> {
        let found = self.get(&reference.value);
        if found.is_none() {
            let message = format!("there is no {} `{}`", self.what, reference.value);
            log.error(
                Code::UnknownName,
                &reference.span,
                message,
                self.help(&reference.value),
            );
        }
        found
    }

    fn help(&self, word: &str) -> String {
        suggest(word, self.what, self.iter())
    }
}

/// "did you mean ...", or the names that there are.
pub(super) fn suggest<'a>(
    word: &str,
    what: &str,
    names: impl Iterator<Item = &'a str> + Clone,
) -> String {
    if let Some(name) = closest(word, names.clone()) {
        return format!("did you mean `{name}`?");
    }
    match names.clone().count() {
        0 => format!("the model has no {what} yet: add one"),
        1..=MOST_LISTED => format!("write {}", one_of(names)),
        more => format!(
            "write {}, or one of {} others",
            one_of(names.take(MOST_LISTED)),
            more - MOST_LISTED
        ),
    }
}

impl Names {
    /// Collects all names and reports those that two objects share.
    pub fn collect(table: &ModelTable, log: &mut Log) -> Names {
        report_shared_names(table, log);
        Names {
            line_types: Lookup::new("line type").add(&table.line_types),
            motions: Lookup::new("motion").add(&table.motions),
            vessels: Lookup::new("vessel or anchor")
                .add(&table.vessels)
                .add(&table.anchors),
            moving_vessels: table.vessels.0.len(),
            bodies: Lookup::new("body").add(&table.bodies),
            lines: Lookup::new("line").add(&table.lines),
            loads: Lookup::new("load").add(&table.loads),
        }
    }

    /// The line or body of a name; notes an error when there is none.
    pub fn find_load_place(&self, reference: &Text, log: &mut Log) -> Option<LoadTarget> {
        let name = &reference.value;
        if let Some(index) = self.lines.get(name) {
            return Some(LoadTarget::Line(index));
        }
        if let Some(index) = self.bodies.get(name) {
            return Some(LoadTarget::Body(index));
        }
        let (message, help) = if self.vessels.get(name).is_some() {
            let message = format!("`{name}` moves as it is told, or not at all: no load moves it");
            (message, "put the load on a line or body".to_owned())
        } else {
            let known = self.lines.iter().chain(self.bodies.iter());
            let what = "line or body";
            (
                format!("there is no {what} `{name}`"),
                suggest(name, what, known),
            )
        };
        log.error(Code::UnknownName, &reference.span, message, help);
        None
    }

    /// The vessel, anchor or body of a name; notes an error when there is none.
    pub fn find_support(&self, reference: &Text, log: &mut Log) -> Option<SupportRef> {
        let name = &reference.value;
        if let Some(index) = self.vessels.get(name) {
            return Some(SupportRef::Vessel(index));
        }
        if let Some(index) = self.bodies.get(name) {
            return Some(SupportRef::Body(index));
        }
        let (message, help) = if self.lines.get(name).is_some() {
            let message = format!("`{name}` is a line, and a line is not connected to a line");
            (
                message,
                "put a body where they meet, and connect both lines to it".to_owned(),
            )
        } else {
            let known = self.vessels.iter().chain(self.bodies.iter());
            let what = "vessel, anchor or body";
            (
                format!("there is no {what} `{name}`"),
                suggest(name, what, known),
            )
        };
        log.error(Code::UnknownName, &reference.span, message, help);
        None
    }
}

fn report_shared_names(table: &ModelTable, log: &mut Log) {
    let mut owners: HashMap<&str, &str> = HashMap::new();
    let vessels = table
        .vessels
        .0
        .iter()
        .map(|item| ("a vessel", &item.name, &item.name_span));
    let anchors = table
        .anchors
        .0
        .iter()
        .map(|item| ("an anchor", &item.name, &item.name_span));
    let bodies = table
        .bodies
        .0
        .iter()
        .map(|item| ("a body", &item.name, &item.name_span));
    let lines = table
        .lines
        .0
        .iter()
        .map(|item| ("a line", &item.name, &item.name_span));
    for (what, name, span) in vessels.chain(anchors).chain(bodies).chain(lines) {
        if let Some(owner) = owners.insert(name, what) {
            let message = format!("`{name}` is already the name of {owner}");
            let help = format!(
                "give {what} another name: vessels, anchors, bodies and lines share one set of names"
            );
            log.error(Code::Name, span, message, help);
        }
    }
}
