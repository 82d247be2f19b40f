//! Curves over arc length: range graphs and the static shape.

use catenix_results::{LinePlace, QuantityPlace};

use crate::ExportError;
use crate::contents::CaseContents;
use crate::table::{Column, Kind, SmallTable};

/// The quantities that any of the lines has, in one order.
pub(crate) fn quantities(lines: &[LinePlace]) -> Vec<&QuantityPlace> {
    // A line has all quantities but those that its section cannot have, all in the same order.
    let mut longest_first: Vec<&LinePlace> = lines.iter().collect();
    longest_first.sort_by_key(|line| std::cmp::Reverse(line.quantities.len()));
    let mut union: Vec<&QuantityPlace> = Vec::new();
    for quantity in longest_first.iter().flat_map(|line| &line.quantities) {
        if !union.iter().any(|known| known.name == quantity.name) {
            union.push(quantity);
        }
    }
    union
}

/// One row per line, quantity and node: what the quantity keeps within.
pub(crate) fn range_graphs(contents: &CaseContents) -> Result<SmallTable, ExportError> {
    let curves = [
        ("min", "smallest value in the statistics window"),
        ("mean", "mean over the statistics window"),
        ("max", "largest value in the statistics window"),
        ("std", "standard deviation over the statistics window"),
        ("run_min", "smallest value over the whole run"),
        ("run_max", "largest value over the whole run"),
    ];
    let mut columns = vec![
        Column::text("line", "line"),
        Column::text("quantity", "quantity"),
        Column::text("unit", "unit of the values"),
        Column::number(
            "arc_length",
            "m",
            "unstretched distance from end A",
            Kind::Float64,
        ),
    ];
    columns.extend(curves.map(|(name, text)| Column::plain_number(name, text)));
    let mut table = SmallTable::new("range_graphs", columns);
    if contents.description.progress.field_rows == 0 {
        return Ok(table);
    }
    for line in &contents.lines {
        let arc_length_m = contents.stored.arc_length_m(&line.name)?;
        let nodes = arc_length_m.len();
        for place in &line.quantities {
            let quantity = contents.stored.quantity(&line.name, place.name)?;
            let envelope = contents.stored.envelope(&line.name, quantity)?;
            let std = match place.has_range_graph {
                true => contents.stored.range_graph(&line.name, quantity)?.std,
                false => vec![f64::NAN; nodes],
            };
            for (column, text) in [&line.name, place.name, place.unit].into_iter().enumerate() {
                table.push_text(column, text, nodes);
            }
            table.push_numbers(3, arc_length_m.iter().copied());
            let curves = [
                envelope.min,
                envelope.mean,
                envelope.max,
                std,
                envelope.run_min,
                envelope.run_max,
            ];
            for (column, curve) in curves.into_iter().enumerate() {
                table.push_numbers(column + 4, curve);
            }
        }
    }
    Ok(table)
}

/// One row per line and node: every quantity in static equilibrium.
pub(crate) fn static_shape(contents: &CaseContents) -> Result<SmallTable, ExportError> {
    let mut columns = vec![
        Column::text("line", "line"),
        Column::number(
            "arc_length",
            "m",
            "unstretched distance from end A",
            Kind::Float64,
        ),
    ];
    let quantities = quantities(&contents.lines);
    columns.extend(quantities.iter().map(|quantity| {
        let text = format!("{}, static", quantity.long_name);
        Column::number(quantity.name, quantity.unit, &text, Kind::Float64)
    }));
    let mut table = SmallTable::new("static_shape", columns);
    for line in &contents.lines {
        let has_state = |place: &QuantityPlace| place.static_state.is_some();
        if !line.quantities.iter().any(has_state) {
            continue;
        }
        let arc_length_m = contents.stored.arc_length_m(&line.name)?;
        let nodes = arc_length_m.len();
        table.push_text(0, &line.name, nodes);
        table.push_numbers(1, arc_length_m);
        for (index, quantity) in quantities.iter().enumerate() {
            let own = line.quantities.iter().find(|own| own.name == quantity.name);
            let values = match own.filter(|own| has_state(own)) {
                Some(own) => {
                    let quantity = contents.stored.quantity(&line.name, own.name)?;
                    contents.stored.static_state(&line.name, quantity)?
                }
                None => vec![f64::NAN; nodes],
            };
            table.push_numbers(index + 2, values);
        }
    }
    Ok(table)
}
