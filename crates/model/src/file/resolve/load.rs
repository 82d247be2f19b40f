//! Forces and moments on points of lines and bodies.

use std::f64::consts::TAU;

use crate::file::diagnostic::DiagnosticCode as Code;
use crate::file::log::Log;
use crate::file::quantity::Real;
use crate::file::read::Vector;
use crate::file::tables::{LoadHarmonicTable, LoadTable};
use crate::{LoadPlace, LoadVariation, PointLoad};

use super::Slot;
use super::environment::factor_table;
use super::line::ResolvedLine;
use super::names::{LoadTarget, Names};

/// Resolves a load.
pub(super) fn resolve(
    table: &LoadTable,
    name: &str,
    names: &Names,
    lines: &[Slot<ResolvedLine>],
    log: &mut Log,
) -> Option<PointLoad> {
    if table.force.is_none() && table.moment.is_none() {
        let message = format!("the load `{name}` has neither `force` nor `moment`");
        let help = "write force = [\"1 kN\", 0, 0], moment = [0, \"2 kN m\", 0], or both";
        log.error(Code::MissingKey, &table.key_span, message, help);
    }
    let variation = variation(table, log);
    let place = place(table, name, names, lines, log);
    Some(PointLoad {
        name: name.to_owned(),
        place: place?,
        force: components(table.force.as_ref()),
        moment: components(table.moment.as_ref()),
        follows: table.follows,
        variation: variation?,
    })
}

fn components<M>(vector: Option<&Vector<Real<M>>>) -> [f64; 3] {
    vector.map_or([0.0; 3], |vector| {
        [0, 1, 2].map(|i| vector.components[i].si)
    })
}

fn place(
    table: &LoadTable,
    name: &str,
    names: &Names,
    lines: &[Slot<ResolvedLine>],
    log: &mut Log,
) -> Option<LoadPlace> {
    match names.find_load_place(&table.on, log)? {
        LoadTarget::Line(line) => {
            if let Some(point) = &table.point {
                let message = format!(
                    "`{}` is a line, and a load on it has no `point`",
                    table.on.value
                );
                let help = "write at = \"... m\", the unstretched distance from end A";
                log.error(Code::ConflictingKeys, &point.span, message, help);
            }
            let Some(at) = &table.at else {
                let message = format!("the load `{name}` does not say where on the line it acts");
                let help = "write at = \"... m\", the unstretched distance from end A";
                log.error(Code::MissingKey, &table.key_span, message, help);
                return None;
            };
            let length = lines.get(line)?.item.as_ref()?.line.length();
            // Lengths of sections add up with rounding; a millionth of the line is no error.
            if at.si > length * (1.0 + 1e-6) {
                let message = format!(
                    "`{name}` is at {} m, beyond the end of `{}`, which is {length} m long",
                    at.si, table.on.value
                );
                let help = "`at` is the unstretched distance from the line's end A";
                log.error(Code::Value, &at.span, message, help);
            }
            let arc_length = at.si.min(length);
            Some(LoadPlace::Line { line, arc_length })
        }
        LoadTarget::Body(body) => {
            if let Some(at) = &table.at {
                let message = format!(
                    "`{}` is a body, and a load on it has no `at`",
                    table.on.value
                );
                let help = "write point = [x, y, z] in the body's local axes";
                log.error(Code::ConflictingKeys, &at.span, message, help);
            }
            let point_local = components(table.point.as_ref());
            Some(LoadPlace::Body { body, point_local })
        }
    }
}

fn variation(table: &LoadTable, log: &mut Log) -> Option<LoadVariation> {
    match (&table.harmonic, &table.factor) {
        (None, None) => Some(LoadVariation::Constant),
        (Some(harmonic), None) => self::harmonic(harmonic, log),
        (None, Some(entries)) => {
            if entries.is_empty() {
                let help = "write factor = [ { time = \"0 s\", factor = 0 }, ... ], or remove it";
                let message = "`factor` is empty";
                log.error(Code::Value, &table.key_span, message, help);
                return None;
            }
            Some(LoadVariation::Table(factor_table(entries, log)))
        }
        (Some(harmonic), Some(_)) => {
            let message = "a load has `harmonic` or `factor`, but not both";
            let help = "keep one of them, or write two loads";
            log.error(Code::ConflictingKeys, &harmonic.key_span, message, help);
            None
        }
    }
}

fn harmonic(table: &LoadHarmonicTable, log: &mut Log) -> Option<LoadVariation> {
    let angular_frequency = match (&table.period, &table.angular_frequency) {
        (Some(period), None) => TAU / period.si,
        (None, Some(frequency)) => frequency.si,
        (Some(_), Some(frequency)) => {
            let message = "`period` and `angular_frequency` exclude each other";
            log.error(
                Code::ConflictingKeys,
                &frequency.span,
                message,
                "keep one of them",
            );
            return None;
        }
        (None, None) => {
            let message = "the harmonic load does not say how fast it varies";
            let help = "write period = \"8 s\" or angular_frequency = \"20 rad/s\"";
            log.error(Code::MissingKey, &table.key_span, message, help);
            return None;
        }
    };
    Some(LoadVariation::Harmonic {
        angular_frequency,
        phase: table.phase.si,
        ramp: table.ramp.si,
    })
}
