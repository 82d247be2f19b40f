//! Channels that the user names: recorded, drawn or compared.

use crate::file::diagnostic::DiagnosticCode as Code;
use crate::file::log::{Log, closest, one_of};
use crate::file::read::{Named, Text};
use crate::file::tables::{FigureTable, OutputTable};
use crate::file::units::{Powers, parse_quantity};
use crate::output::{body_channels, line_channels, vessel_channels};
use crate::{Channel, ChannelTarget, LineQuantity};

use super::Assembly;
use super::line::ResolvedLine;
use super::names::{Names, suggest};

/// Resolves the user's own channels.
pub(super) fn output_channels(
    table: &OutputTable,
    assembly: &Assembly,
    names: &Names,
    log: &mut Log,
) -> Vec<Channel> {
    let texts = table.channels.as_deref().unwrap_or_default();
    texts
        .iter()
        .filter_map(|text| find(text, assembly, names, log))
        .collect()
}

/// Resolves the channels of the figures.
pub(super) fn figures(
    figures: &Named<FigureTable>,
    assembly: &Assembly,
    names: &Names,
    log: &mut Log,
) -> Vec<Channel> {
    let tables = figures.0.iter().filter_map(|item| item.item.as_ref());
    tables
        .filter_map(|table| find(&table.channel, assembly, names, log))
        .collect()
}

/// Whether a channel is a point of a line, which is recorded only on demand.
pub(super) fn is_line_point(channel: &Channel) -> bool {
    matches!(channel.target, ChannelTarget::LinePoint(..))
}

/// The channel that a text names; `None` after noting an error, or when its object is broken.
pub(super) fn find(
    text: &Text,
    assembly: &Assembly,
    names: &Names,
    log: &mut Log,
) -> Option<Channel> {
    let Some((object, quantity)) = text.value.split_once('.') else {
        let message = format!("`{}` is no channel", text.value);
        let help = "write <object>.<quantity>, for example \"buffer.offset_x\"";
        log.error(Code::Channel, &text.span, message, help);
        return None;
    };
    let channels = if let Some(index) = names.vessels.get(object) {
        vessel_channels(index, object)
    } else if let Some(index) = names.bodies.get(object) {
        let has_offset = names.moving_vessels > 0
            || assembly.bodies[index]
                .item
                .as_ref()
                .is_none_or(|body| body.offset_vessel.is_some());
        body_channels(index, object, has_offset)
    } else if let Some(index) = names.lines.get(object) {
        if let Some((quantity, at)) = quantity.split_once('@') {
            let line = assembly.lines[index].item.as_ref();
            return line_point(text, index, object, quantity, at, line, log);
        }
        line_channels(index, object)
    } else {
        let known = names
            .vessels
            .iter()
            .chain(names.bodies.iter())
            .chain(names.lines.iter());
        let message = format!("there is no vessel, anchor, body or line `{object}`");
        log.error(
            Code::Channel,
            &text.span,
            message,
            suggest(object, "object", known),
        );
        return None;
    };
    let found = channels.iter().find(|channel| channel.name == text.value);
    if found.is_none() {
        let message = format!("`{object}` has no quantity `{quantity}`");
        let known: Vec<&str> = channels
            .iter()
            .filter_map(|channel| Some(channel.name.split_once('.')?.1))
            .collect();
        let is_line_quantity = names.lines.get(object).is_some()
            && LineQuantity::ALL
                .iter()
                .any(|known| known.name() == quantity);
        let help = match closest(quantity, known.iter().copied()) {
            _ if is_line_quantity => {
                format!("say where along the line: \"{object}.{quantity}@100 m\"")
            }
            Some(known) => format!("did you mean `{object}.{known}`?"),
            None => format!("its quantities are {}", one_of(known)),
        };
        log.error(Code::Channel, &text.span, message, help);
    }
    found.cloned()
}

fn line_point(
    text: &Text,
    index: usize,
    name: &str,
    quantity: &str,
    at: &str,
    line: Option<&ResolvedLine>,
    log: &mut Log,
) -> Option<Channel> {
    let known = LineQuantity::ALL.map(LineQuantity::name);
    let quantity = quantity.trim();
    let Some(found) = LineQuantity::ALL
        .into_iter()
        .find(|known| known.name() == quantity)
    else {
        let message = format!("lines have no quantity `{quantity}`");
        let help = match closest(quantity, known) {
            Some(known) => format!("did you mean `{known}`?"),
            None => format!("quantities along a line are {}", one_of(known)),
        };
        log.error(Code::Channel, &text.span, message, help);
        return None;
    };
    let length = Powers::new(0, 1, 0, 0);
    let arc_length = match parse_quantity(at) {
        Ok(number) if number.powers.is_none_or(|powers| powers == length) => number.si,
        _ => {
            let message = format!("`{at}` is no place along the line");
            let help = format!("write a length, for example \"{name}.{quantity}@132 m\"");
            log.error(Code::Channel, &text.span, message, help);
            return None;
        }
    };
    let line = &line?.line;
    let line_length = line.length();
    if arc_length < 0.0 || arc_length > line_length * (1.0 + 1e-6) {
        let message =
            format!("`{name}` is {line_length} m long and has no point at {arc_length} m");
        let help = "the place is the unstretched distance from end A";
        log.error(Code::Channel, &text.span, message, help);
        return None;
    }
    Some(Channel {
        name: format!("{name}.{quantity}@{arc_length}m"),
        unit: found.unit(),
        target: ChannelTarget::LinePoint(index, found, arc_length),
    })
}
