//! Settings of static path following.

use crate::file::diagnostic::DiagnosticCode as Code;
use crate::file::log::Log;
use crate::file::tables::{PathStopTable, PathTable};
use crate::{PathSettings, PathStop};

use super::Assembly;
use super::analysis::check_below_one;
use super::channel;
use super::names::Names;
use super::references::in_unit_of;

/// Resolves the settings of the path; `None` when something is wrong, which is in the log.
pub(super) fn resolve(
    table: &PathTable,
    assembly: &Assembly,
    names: &Names,
    log: &mut Log,
) -> Option<PathSettings> {
    check_below_one("tolerance", &table.tolerance, log);
    let loads = loads(table, names, log);
    let [low, high] = &table.range.items;
    let start = &table.start;
    if low.si >= high.si {
        let message = format!("`range` runs from {} to {}", low.si, high.si);
        let help = "write the lower factor first: range = [0, 9]";
        log.error(Code::Value, &low.span, message, help);
    } else if start.si < low.si || start.si > high.si {
        let message = format!(
            "the path starts at the factor {}, outside its range from {} to {}",
            start.si, low.si, high.si
        );
        log.error(
            Code::Value,
            &low.span,
            message,
            "widen `range`, or move `start`",
        );
    }
    let wanted = table.at.as_deref().unwrap_or_default();
    for factor in wanted {
        if factor.si < low.si || factor.si > high.si {
            let message = format!(
                "the factor {} lies outside `range`, {} to {}",
                factor.si, low.si, high.si
            );
            log.error(
                Code::Value,
                &factor.span,
                message,
                "remove it, or widen `range`",
            );
        }
    }
    if table.first_step.si > table.max_step.si {
        let message = format!(
            "the first step, {}, is longer than the largest, {}",
            table.first_step.si, table.max_step.si
        );
        let help = "write first_step below max_step";
        log.error(Code::Value, &table.first_step.span, message, help);
    }
    let stop = match &table.stop {
        None => Some(None),
        Some(stop) => self::stop(stop, assembly, names, log).map(Some),
    };
    let mut at: Vec<f64> = wanted.iter().map(|factor| factor.si).collect();
    at.sort_by(f64::total_cmp);
    at.dedup();
    Some(PathSettings {
        loads: loads?,
        start: start.si,
        range: [low.si, high.si],
        at,
        stop: stop?,
        max_points: table.max_points.value,
        first_step: table.first_step.si,
        max_step: table.max_step.si,
        tolerance: table.tolerance.si,
        max_iterations: table.max_iterations.value,
    })
}

fn loads(table: &PathTable, names: &Names, log: &mut Log) -> Option<Vec<usize>> {
    if names.loads.iter().next().is_none() {
        let message = "the model has no load that a path could scale";
        let help = "write [loads.some_name] with on, at and force";
        log.error(Code::MissingKey, &table.key_span, message, help);
        return None;
    }
    let Some(references) = &table.loads else {
        return Some((0..names.loads.iter().count()).collect());
    };
    if references.is_empty() {
        let help = "name the loads that the factor scales, or leave `loads` out for all";
        log.error(Code::Value, &table.key_span, "`loads` is empty", help);
        return None;
    }
    let found: Vec<Option<usize>> = references
        .iter()
        .map(|reference| names.loads.find(reference, log))
        .collect();
    let mut loads = found.into_iter().collect::<Option<Vec<usize>>>()?;
    loads.sort_unstable();
    loads.dedup();
    Some(loads)
}

fn stop(
    table: &PathStopTable,
    assembly: &Assembly,
    names: &Names,
    log: &mut Log,
) -> Option<PathStop> {
    let channel = channel::find(&table.channel, assembly, names, log)?;
    let [low, high] = &table.range.items;
    let range = [
        in_unit_of(&channel, low, log)?,
        in_unit_of(&channel, high, log)?,
    ];
    if range[0] >= range[1] {
        let message = format!("`range` runs from {} to {}", range[0], range[1]);
        log.error(Code::Value, &low.span, message, "write the lower end first");
    }
    Some(PathStop { channel, range })
}
