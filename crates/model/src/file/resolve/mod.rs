//! From the tables of one load case to its [`Model`]: references become indices, derived values are
//! computed, and what cannot be is reported.
//!
//! Objects that could not be read keep their place as empty [`Slot`]s, so that everything else is
//! still checked.

mod analysis;
mod body;
mod channel;
mod checks;
mod environment;
mod grading;
mod history;
mod line;
mod line_type;
mod load;
mod motion;
mod names;
mod path;
mod references;
mod section_law;

use crate::{Body, Environment, LineType, Model, OutputSettings, Reference, Vessel};

use super::log::Log;
use super::node::Span;
use super::read::Named;
use super::tables::{FigureTable, ModelTable, ReferenceTable};

pub(super) use history::Histories;
use line::ResolvedLine;
use names::Names;

/// An object of the model with its place in the file; empty when it could not be resolved.
#[derive(Debug)]
struct Slot<T> {
    name: String,
    name_span: Span,
    item: Option<T>,
}

/// A resolved line type with the strain at which it counts as torn.
#[derive(Debug)]
struct ResolvedLineType {
    line_type: LineType,
    strain_limit: f64,
}

/// All objects of a load case, resolved as far as possible; indices are those of the model.
#[derive(Debug)]
struct Assembly {
    environment: Environment,
    line_types: Vec<Slot<ResolvedLineType>>,
    vessels: Vec<Slot<Vessel>>,
    bodies: Vec<Slot<Body>>,
    lines: Vec<Slot<ResolvedLine>>,
}

/// A load case's model with what the case compares and draws.
pub(super) struct ResolvedCase {
    /// The model.
    pub model: Model,
    /// What its results are compared with.
    pub references: Vec<Reference>,
    /// Channels of the study's figures, in their order.
    pub figure_channels: Vec<crate::Channel>,
}

/// Resolves and checks one load case; `None` when anything is wrong, which is then in the log.
pub(super) fn resolve_case(
    title: &str,
    table: &ModelTable,
    references: &[ReferenceTable],
    figures: &Named<FigureTable>,
    histories: &mut Histories,
    log: &mut Log,
) -> Option<ResolvedCase> {
    let names = Names::collect(table, log);
    let environment = environment::resolve(&table.environment, log);
    let motions = slots(
        &table.motions,
        |item, _, log| motion::resolve(item, histories, log),
        log,
    );
    let line_types = slots(&table.line_types, line_type::resolve, log);
    let mut vessels = slots(
        &table.vessels,
        |item, name, log| body::vessel(item, name, &names, &motions, log),
        log,
    );
    vessels.extend(slots(
        &table.anchors,
        |item, name, _| Some(body::anchor(item, name)),
        log,
    ));
    let resolve_body =
        |item: &_, name: &str, log: &mut Log| body::body(item, name, &environment, &names, log);
    let bodies = slots(&table.bodies, resolve_body, log);
    let mut element_budget = grading::MOST_ELEMENTS;
    let resolve_line = |item: &_, name: &str, log: &mut Log| {
        line::resolve(
            item,
            name,
            &environment,
            &names,
            &line_types,
            &mut element_budget,
            log,
        )
    };
    let lines = slots(&table.lines, resolve_line, log);
    let assembly = Assembly {
        environment,
        line_types,
        vessels,
        bodies,
        lines,
    };
    let resolve_load = |item: &_, name: &str, log: &mut Log| {
        load::resolve(item, name, &names, &assembly.lines, log)
    };
    let loads = slots(&table.loads, resolve_load, log);
    checks::check(&assembly, table.statics.equilibrium, log);

    let statics = analysis::statics(&table.statics, log);
    let modes = analysis::modes(&table.modes, log);
    let dynamics = table.dynamics.as_ref().map(|dynamics| {
        let formulation = analysis::formulation(table.formulation);
        analysis::dynamics(dynamics, &assembly.vessels, formulation, log)
    });
    let path = table
        .path
        .as_ref()
        .and_then(|table| path::resolve(table, &assembly, &names, log));
    let mut channels = channel::output_channels(&table.output, &assembly, &names, log);
    let references = references::resolve(references, &assembly, &names, log);
    let figure_channels = channel::figures(figures, &assembly, &names, log);
    let stop = path.as_ref().and_then(|path| path.stop.as_ref());
    // Points of lines that are drawn or compared, or that end a path, must be recorded too.
    let used = references
        .iter()
        .map(|reference| &reference.channel)
        .chain(&figure_channels)
        .chain(stop.map(|stop| &stop.channel));
    for used in used.filter(|channel| channel::is_line_point(channel)) {
        if !channels.contains(used) {
            channels.push(used.clone());
        }
    }
    if !log.is_empty() {
        return None;
    }
    let output = OutputSettings {
        interval: table.output.interval.si,
        field_interval: table.output.field_interval.si,
        interpolate: table.output.interpolate,
        channels,
    };
    let model = Model {
        title: title.to_owned(),
        formulation: analysis::formulation(table.formulation),
        environment: assembly.environment,
        line_types: filled(assembly.line_types)?
            .into_iter()
            .map(|item| item.line_type)
            .collect(),
        lines: filled(assembly.lines)?
            .into_iter()
            .map(|item| item.line)
            .collect(),
        bodies: filled(assembly.bodies)?,
        vessels: filled(assembly.vessels)?,
        loads: filled(loads)?,
        statics,
        modes,
        dynamics,
        path,
        output,
    };
    Some(ResolvedCase {
        model,
        references,
        figure_channels,
    })
}

fn slots<T, R>(
    named: &Named<T>,
    mut resolve: impl FnMut(&T, &str, &mut Log) -> Option<R>,
    log: &mut Log,
) -> Vec<Slot<R>> {
    let slot = |item: &super::read::NamedItem<T>| Slot {
        name: item.name.clone(),
        name_span: item.name_span.clone(),
        item: item
            .item
            .as_ref()
            .and_then(|table| resolve(table, &item.name, log)),
    };
    named.0.iter().map(slot).collect()
}

/// The objects of the slots; `None` if one is empty.
fn filled<T>(slots: Vec<Slot<T>>) -> Option<Vec<T>> {
    slots.into_iter().map(|slot| slot.item).collect()
}
