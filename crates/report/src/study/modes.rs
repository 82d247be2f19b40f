//! Section with the natural modes, where the store has any.

use catenix_results::{ModeReport, StoreError};

use super::builder::{Builder, NewFigure, row};
use super::data::StudyData;
use super::document::{Cell, Column, Group};
use super::format::{NONE, with_unit};
use crate::charts::line_modes_charts;
use crate::number::significant;

/// Shares of the motion that are smaller are left out, but for the largest.
const WORTH_TELLING: f64 = 0.1;

pub(super) fn add(data: &StudyData<'_>, builder: &mut Builder) -> Result<(), StoreError> {
    builder.section("modes", builder.text("section.modes"));
    for case in data.computed() {
        let Some(modes) = case.stored.modes()? else {
            continue;
        };
        let report = &modes.report;
        let rows = report
            .modes
            .iter()
            .map(|mode| mode_row(mode, &report.total_mass_kg, builder));
        let rows = rows.collect();
        let columns = vec![
            Column::number(&builder.text("modes.number")),
            Column::number(&builder.text("modes.frequency")),
            Column::number(&builder.text("modes.period")),
            Column::number(&builder.text("modes.damping")),
            Column::text(&builder.text("modes.moves_most")),
            Column::text(&builder.text("modes.motion")),
            Column::number(&builder.text("modes.mass")),
        ];
        let key = match report.added_mass {
            true => "modes.in_water",
            false => "modes.in_air",
        };
        let [_, high] = report.counted_between_hz;
        let counted = report.counted.to_string();
        let values = [
            ("count", counted.as_str()),
            ("frequency", &significant(high, 5)),
        ];
        let proof = builder.fill("modes.proof", &values);
        let caption = format!("{} {proof}", builder.text(key));
        let title = builder.fill("modes.title", &[("case", &case.label())]);
        builder.table(title, caption, columns, vec![Group::new("", rows)]);
        for (line, mut chart) in line_modes_charts(&modes, builder.language) {
            chart.panels[0].height = 280.0;
            let figure = NewFigure {
                name: &format!("modes-{}-{line}", case.name),
                title: &builder.fill(
                    "modes.of_line",
                    &[("line", line.as_str()), ("case", &case.name)],
                ),
                caption: &builder.text("modes.figure_note"),
            };
            builder.chart(&figure, chart);
        }
    }
    Ok(())
}

fn mode_row(mode: &ModeReport, total_mass_kg: &[f64; 3], builder: &Builder) -> Vec<Cell> {
    let frequency = match (&*mode.kind, mode.frequency_hz) {
        ("unstable", _) => builder.text("modes.unstable"),
        ("free", _) => builder.text("modes.free"),
        (_, hz) => hz.map_or(NONE.to_owned(), |hz| significant(hz, 5)),
    };
    let damping = mode.damping_ratio.filter(|_| mode.kind == "vibration");
    let place = match mode.arc_length_m {
        Some(place) => {
            let values = [
                ("line", mode.moves_most.as_str()),
                ("place", &with_unit(place, "m")),
            ];
            builder.fill("modes.at", &values)
        }
        None => mode.moves_most.clone(),
    };
    let shares = mode.motions.iter().enumerate();
    let shares = shares.filter(|(index, share)| *index == 0 || share.share >= WORTH_TELLING);
    let shares = shares.map(|(_, share)| {
        let known = builder.language.find(&format!("motion.{}", share.motion));
        let motion = known.unwrap_or(&share.motion);
        format!("{motion} {:.0} %", 100.0 * share.share)
    });
    let masses = mode.effective_mass_kg.iter().zip(total_mass_kg);
    let masses: Vec<String> = masses
        .map(|(mass, total)| match total.is_finite() && *total > 0.0 {
            true => format!("{:.0}", 100.0 * mass / total),
            false => NONE.to_owned(),
        })
        .collect();
    row([
        mode.number.to_string().into(),
        frequency.into(),
        mode.period_s
            .map_or(NONE.to_owned(), |s| significant(s, 4))
            .into(),
        damping
            .map_or(NONE.to_owned(), |ratio| significant(100.0 * ratio, 3))
            .into(),
        place.into(),
        builder.language.list(&shares.collect::<Vec<_>>()).into(),
        masses.join(" / ").into(),
    ])
}
