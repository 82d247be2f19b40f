//! Results from elsewhere that a case is compared with.

use crate::file::diagnostic::DiagnosticCode as Code;
use crate::file::dimension::{AnyMeasure, name_of};
use crate::file::log::Log;
use crate::file::quantity::Real;
use crate::file::tables::{ReferenceTable, StatisticChoice};
use crate::file::units::{Powers, describe_powers, parse_quantity};
use crate::{Channel, Reference, Statistic};

use super::Assembly;
use super::channel;
use super::names::Names;

/// Resolves references, whose units must be those of their channels.
pub(super) fn resolve(
    tables: &[ReferenceTable],
    assembly: &Assembly,
    names: &Names,
    log: &mut Log,
) -> Vec<Reference> {
    // A loop, so that each is checked whatever became of the others.
    let mut references = Vec::new();
    for table in tables {
        let channel = channel::find(&table.channel, assembly, names, log);
        let written = written_range(table, log);
        if let (Some(channel), Some(written)) = (channel, written) {
            references.extend(reference(table, channel, written, log));
        }
    }
    references
}

/// Lower and upper end as they are written, the same for a single value.
fn written_range<'a>(
    table: &'a ReferenceTable,
    log: &mut Log,
) -> Option<[&'a Real<AnyMeasure>; 2]> {
    let channel = &table.channel.value;
    match (&table.value, &table.range) {
        (Some(value), None) => Some([value, value]),
        (None, Some(range)) => {
            let [low, high] = &range.items;
            Some([low, high])
        }
        (None, None) => {
            let message = format!("the reference for `{channel}` has neither `value` nor `range`");
            let help = "write value = \"-22.5 m\" or range = [\"-22.9 m\", \"-22.6 m\"]";
            log.error(Code::MissingKey, &table.channel.span, message, help);
            None
        }
        (Some(_), Some(range)) => {
            let message = format!("the reference for `{channel}` has both `value` and `range`");
            let help = "keep one of them";
            log.error(Code::ConflictingKeys, &range.span, message, help);
            None
        }
    }
}

fn reference(
    table: &ReferenceTable,
    channel: Channel,
    written: [&Real<AnyMeasure>; 2],
    log: &mut Log,
) -> Option<Reference> {
    let low = in_unit_of(&channel, written[0], log)?;
    let high = in_unit_of(&channel, written[1], log)?;
    if low > high {
        let unit = channel.unit;
        let message = format!("`range` runs from {low} down to {high} {unit}");
        let help = format!(
            "write the lower end first: range = [\"{high} {unit}\", \"{low} {unit}\"]; of two \
             negative numbers that is the one further from zero"
        );
        log.error(Code::Value, &written[0].span, message, help);
        return None;
    }
    Some(Reference {
        channel,
        statistic: match table.statistic {
            StatisticChoice::Mean => Statistic::Mean,
            StatisticChoice::Min => Statistic::Min,
            StatisticChoice::Max => Statistic::Max,
        },
        low,
        high,
        source: table.source.value.clone(),
    })
}

/// A number in the unit of a channel; notes an error when it measures something else.
pub(super) fn in_unit_of(
    channel: &Channel,
    number: &Real<AnyMeasure>,
    log: &mut Log,
) -> Option<f64> {
    let (expected, si_per_unit) = unit_of(channel.unit);
    if let Some(powers) = number.powers
        && powers != expected
    {
        let found = name_of(powers).map_or_else(|| describe_powers(powers), str::to_owned);
        let message = format!(
            "`{}` is in {}, but the value is {found}",
            channel.name, channel.unit
        );
        let help = format!("write the value in {}", channel.unit);
        log.error(Code::Dimension, &number.span, message, help);
        return None;
    }
    Some(number.si / si_per_unit)
}

/// Powers and size of a channel's unit.
fn unit_of(unit: &str) -> (Powers, f64) {
    match parse_quantity(&format!("1 {unit}")) {
        Ok(number) => (number.powers.unwrap_or_default(), number.si),
        // Only the curvature's "1/m" is no product of units.
        Err(_) => (Powers::new(0, -1, 0, 0), 1.0),
    }
}
