//! Prescribed motions.

use crate::file::diagnostic::DiagnosticCode as Code;
use crate::file::dimension::Time;
use crate::file::log::Log;
use crate::file::quantity::NonNegative;
use crate::file::tables::{DegreeChoice, HarmonicTable, LegTable, MotionTable, TowTable};
use crate::{Degree, Motion, TowLeg};

use super::environment::horizontal;
use super::history::Histories;

/// Resolves a motion.
pub(super) fn resolve(
    table: &MotionTable,
    histories: &mut Histories,
    log: &mut Log,
) -> Option<Motion> {
    match table {
        MotionTable::Tow(table) => tow(table, log),
        MotionTable::Harmonic(table) => harmonic(table, log),
        MotionTable::History(table) => histories.read(&table.file, log),
    }
}

fn tow(table: &TowTable, log: &mut Log) -> Option<Motion> {
    match (&table.legs, &table.speed) {
        (Some(legs), None) => {
            let single = [
                table.heading.as_ref().map(|q| (&q.span, "heading")),
                table.start.as_ref().map(|q| (&q.span, "start")),
                table.ramp.as_ref().map(|q| (&q.span, "ramp")),
            ];
            for (span, key) in single.into_iter().flatten() {
                let message = format!("`{key}` beside `legs` has no meaning");
                log.error(Code::ConflictingKeys, span, message, "write it in each leg");
            }
            path(legs, table, log)
        }
        (None, Some(speed)) => {
            let Some(ramp) = &table.ramp else {
                let message = "the tow does not say how long it takes to reach its speed";
                log.error(
                    Code::MissingKey,
                    &table.key_span,
                    message,
                    "write ramp = \"2 s\"",
                );
                return None;
            };
            check_ramp(ramp, log);
            let heading = table.heading.as_ref().map_or(0.0, |q| q.si);
            let start = table.start.as_ref().map_or(0.0, |q| q.si);
            let velocity = horizontal(speed.si, heading);
            Some(Motion::Tow {
                legs: vec![TowLeg {
                    start,
                    ramp: ramp.si,
                    velocity,
                }],
            })
        }
        (Some(_), Some(speed)) => {
            let message = "`speed` and `legs` exclude each other";
            log.error(
                Code::ConflictingKeys,
                &speed.span,
                message,
                "write the speed in the legs",
            );
            None
        }
        (None, None) => {
            let help = "write speed = \"0.5 m/s\" and ramp = \"2 s\", or legs = [ { start = \"0 s\", \
                        ramp = \"2 s\", speed = \"0.5 m/s\" } ]";
            log.error(
                Code::MissingKey,
                &table.key_span,
                "the tow has no speed",
                help,
            );
            None
        }
    }
}

fn path(legs: &[LegTable], table: &TowTable, log: &mut Log) -> Option<Motion> {
    if legs.is_empty() {
        let message = "`legs` is empty: the tow has no speed";
        let help =
            "write at least one leg, { start = \"0 s\", ramp = \"2 s\", speed = \"0.5 m/s\" }";
        log.error(Code::Value, &table.key_span, message, help);
        return None;
    }
    for leg in legs {
        check_ramp(&leg.ramp, log);
    }
    for pair in legs.windows(2) {
        let end = pair[0].start.si + pair[0].ramp.si;
        let start = &pair[1].start;
        if start.si < end {
            let message = format!(
                "the leg starts at {} s, before the change of speed of the leg before it ends at {end} s",
                start.si
            );
            let help = "order legs by time; a leg starts after the ramp of the one before";
            log.error(Code::Value, &start.span, message, help);
        }
    }
    let leg = |leg: &LegTable| TowLeg {
        start: leg.start.si,
        ramp: leg.ramp.si,
        velocity: horizontal(leg.speed.si, leg.heading.si),
    };
    Some(Motion::Tow {
        legs: legs.iter().map(leg).collect(),
    })
}

fn check_ramp(ramp: &NonNegative<Time>, log: &mut Log) {
    if ramp.si == 0.0 {
        let message =
            "`ramp` must be greater than zero: a speed reached in no time takes an infinite force";
        log.error(
            Code::Value,
            &ramp.span,
            message,
            "write a short ramp, for example \"2 s\"",
        );
    }
}

fn harmonic(table: &HarmonicTable, log: &mut Log) -> Option<Motion> {
    let (degree, rotates) = match table.degree {
        DegreeChoice::Surge => (Degree::Surge, false),
        DegreeChoice::Sway => (Degree::Sway, false),
        DegreeChoice::Heave => (Degree::Heave, false),
        DegreeChoice::Roll => (Degree::Roll, true),
        DegreeChoice::Pitch => (Degree::Pitch, true),
        DegreeChoice::Yaw => (Degree::Yaw, true),
    };
    if let Some(powers) = table.amplitude.powers
        && (powers.angle != 0) != rotates
    {
        let (expected, example) = if rotates {
            ("an angle", "5 deg")
        } else {
            ("a length", "4 m")
        };
        let message = format!("the amplitude of {degree:?} must be {expected}").to_lowercase();
        let help = format!("write for example \"{example}\"");
        log.error(Code::Dimension, &table.amplitude.span, message, help);
    }
    if let Some(ramp) = &table.ramp {
        check_ramp(ramp, log);
    }
    let period = table.period.si;
    Some(Motion::Harmonic {
        degree,
        amplitude: table.amplitude.si,
        period,
        phase: table.phase.si,
        ramp: table.ramp.as_ref().map_or(2.0 * period, |ramp| ramp.si),
    })
}
