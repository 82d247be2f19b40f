//! Natural modes: what is known of each, and the shapes.

use catenix_results::{CaseModes, LinePlace, ModeReport};

use crate::table::{Column, Kind, SmallTable};

/// A number of a mode.
type Value = fn(&ModeReport) -> f64;

/// One row per mode.
pub(crate) fn modes(modes: &CaseModes) -> SmallTable {
    let number =
        |name: &str, unit: &str, text: &str| Column::number(name, unit, text, Kind::Float64);
    let numbers: [(Column, Value); 9] = [
        (
            number(
                "frequency",
                "Hz",
                "natural frequency; 0 where the motion is free",
            ),
            |mode| mode.frequency_hz.unwrap_or(f64::NAN),
        ),
        (number("period", "s", "natural period"), |mode| {
            mode.period_s.unwrap_or(f64::NAN)
        }),
        (
            number("omega_squared", "rad2/s2", "squared angular frequency"),
            |mode| mode.omega_squared_rad2_s2,
        ),
        (
            number("damping_ratio", "1", "damping ratio by structural damping"),
            |mode| mode.damping_ratio.unwrap_or(f64::NAN),
        ),
        (
            number(
                "arc_length",
                "m",
                "distance from end A of where a line moves most",
            ),
            |mode| mode.arc_length_m.unwrap_or(f64::NAN),
        ),
        (
            number("effective_mass_x", "kg", "effective mass along x"),
            |mode| mode.effective_mass_kg[0],
        ),
        (
            number("effective_mass_y", "kg", "effective mass along y"),
            |mode| mode.effective_mass_kg[1],
        ),
        (
            number("effective_mass_z", "kg", "effective mass along z"),
            |mode| mode.effective_mass_kg[2],
        ),
        (
            number(
                "residual",
                "1",
                "largest unbalanced force over the largest force of inertia",
            ),
            |mode| mode.residual,
        ),
    ];
    let mut columns = vec![
        Column::plain_number("mode", "number of the mode"),
        Column::text("kind", "vibration, free or unstable"),
        Column::text("moves_most", "line or body that moves most"),
    ];
    columns.extend(numbers.iter().map(|(column, _)| column.clone()));
    let mut table = SmallTable::new("modes", columns);
    for mode in &modes.report.modes {
        table.push_numbers(0, [mode.number as f64]);
        table.push_text(1, &mode.kind, 1);
        table.push_text(2, &mode.moves_most, 1);
        for (index, (_, value)) in numbers.iter().enumerate() {
            table.push_numbers(index + 3, [value(mode)]);
        }
    }
    table
}

/// One row per mode and node of a line, or body.
pub(crate) fn mode_shapes(modes: &CaseModes, lines: &[LinePlace]) -> SmallTable {
    let number =
        |name: &str, unit: &str, text: &str| Column::number(name, unit, text, Kind::Float64);
    let columns = vec![
        Column::plain_number("mode", "number of the mode"),
        Column::text("name", "line or body"),
        number(
            "arc_length",
            "m",
            "unstretched distance from end A; none for a body",
        ),
        number("displacement_x", "m", "displacement, global x"),
        number("displacement_y", "m", "displacement, global y"),
        number("displacement_z", "m", "displacement, global z"),
        number("rotation_x", "rad", "rotation about global x"),
        number("rotation_y", "rad", "rotation about global y"),
        number("rotation_z", "rad", "rotation about global z"),
    ];
    let mut table = SmallTable::new("mode_shapes", columns);
    let is_wanted = |name: &str| lines.iter().any(|line| line.name == name);
    let wanted = modes.lines.iter().filter(|line| is_wanted(&line.name));
    for part in wanted.chain(&modes.bodies) {
        for (mode, shape) in modes.report.modes.iter().zip(&part.motion) {
            table.push_numbers(0, std::iter::repeat_n(mode.number as f64, shape.len()));
            table.push_text(1, &part.name, shape.len());
            match &part.arc_length {
                Some(arc_length) => table.push_numbers(2, arc_length.iter().copied()),
                None => table.push_numbers(2, std::iter::repeat_n(f64::NAN, shape.len())),
            }
            for component in 0..6 {
                table.push_numbers(component + 3, shape.iter().map(|motion| motion[component]));
            }
        }
    }
    table
}
