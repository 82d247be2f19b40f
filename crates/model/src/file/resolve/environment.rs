//! Water, current and seabed.

use crate::file::diagnostic::DiagnosticCode as Code;
use crate::file::log::Log;
use crate::file::tables::{
    CurrentPointTable, CurrentTable, EnvironmentTable, FactorTable, SeabedTable,
};
use crate::{Current, CurrentPoint, Environment, Seabed, Water};

/// Resolves the environment; values that are wrong are NaN and already reported.
pub(super) fn resolve(table: &EnvironmentTable, log: &mut Log) -> Environment {
    check_water(table, log);
    Environment {
        gravity: table.gravity.si,
        water: table.water.as_ref().map(|water| Water {
            density: water.density.si,
            depth: water.depth.si,
        }),
        current: current(&table.current, log),
        seabed: table
            .seabed
            .as_ref()
            .filter(|table| table.contact)
            .map(seabed),
    }
}

/// What needs water, where there is none.
fn check_water(table: &EnvironmentTable, log: &mut Log) {
    if table.water.is_some() {
        return;
    }
    let profile = table.current.profile.as_ref();
    let current = profile
        .filter(|points| !points.is_empty())
        .map(|_| ("a current", &table.current.key_span));
    let seabed = table
        .seabed
        .as_ref()
        .filter(|seabed| seabed.contact)
        .map(|seabed| {
            (
                "a seabed, which lies at the water's depth,",
                &seabed.key_span,
            )
        });
    for (what, span) in [current, seabed].into_iter().flatten() {
        let message = format!("there is {what} but no water");
        let help = "write environment.water.depth = \"1000 m\", or remove it";
        log.error(Code::MissingKey, span, message, help);
    }
}

/// A factor over time as (time, factor); reports times that decrease.
pub(super) fn factor_table(entries: &[FactorTable], log: &mut Log) -> Vec<(f64, f64)> {
    for pair in entries.windows(2) {
        let (before, after) = (&pair[0].time, &pair[1].time);
        if after.si < before.si {
            let message = format!(
                "times must not decrease, but {} s follows {} s",
                after.si, before.si
            );
            let help = "order the entries by time; two entries at one time are a step";
            log.error(Code::Value, &after.span, message, help);
        }
    }
    entries
        .iter()
        .map(|entry| (entry.time.si, entry.factor.si))
        .collect()
}

fn current(table: &CurrentTable, log: &mut Log) -> Current {
    let points = table.profile.as_deref().unwrap_or_default();
    for pair in points.windows(2) {
        let (above, below) = (&pair[0].depth, &pair[1].depth);
        if below.si <= above.si {
            let message = format!(
                "depths of a current profile must increase, but {} m follows {} m",
                below.si, above.si
            );
            log.error(
                Code::Value,
                &below.span,
                message,
                "order the points from the surface down",
            );
        }
    }
    let point = |point: &CurrentPointTable| {
        let heading = point.heading.as_ref().unwrap_or(&table.heading);
        CurrentPoint {
            depth: point.depth.si,
            velocity: horizontal(point.speed.si, heading.si),
        }
    };
    Current {
        profile: points.iter().map(point).collect(),
        factor: factor_table(table.factor.as_deref().unwrap_or_default(), log),
    }
}

fn seabed(table: &SeabedTable) -> Seabed {
    Seabed {
        normal_stiffness: table.normal_stiffness.si,
        normal_damping: table.normal_damping.si,
        friction: table.friction.si,
        friction_speed: table.friction_speed.si,
    }
}

/// Horizontal vector of a length along a heading (global x, y).
pub(super) fn horizontal(length: f64, heading: f64) -> [f64; 2] {
    let (cosine, sine) = direction(heading);
    [length * cosine, length * sine]
}

/// Cosine and sine of a heading; exactly 0 and 1 along the axes, where pi is not exact.
pub(super) fn direction(heading: f64) -> (f64, f64) {
    let snap = |value: f64| if value.abs() < 1e-15 { 0.0 } else { value };
    (snap(heading.cos()), snap(heading.sin()))
}
