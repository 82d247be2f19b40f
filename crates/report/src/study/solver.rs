//! Sections on how good the numbers are: accuracy, the solver's account, and where all comes from.

use catenix_results::{CaseSummary, Setting, SettingValue, StoreError};

use super::builder::{Builder, row};
use super::data::{CaseData, StudyData};
use super::document::{Block, Cell, Column, Group};
use super::format::{NONE, Scaled, count, with_unit};
use crate::number::{shortest, significant};

/// Most cases beside each other in a table.
const CASES_PER_TABLE: usize = 6;

/// The error estimates, or how to get some.
pub(super) fn add_accuracy(data: &StudyData<'_>, builder: &mut Builder) {
    builder.section("accuracy", builder.text("section.accuracy"));
    let estimated: Vec<&CaseData> = data
        .cases
        .iter()
        .filter(|case| case.summary.discretisation.is_some())
        .collect();
    if estimated.is_empty() {
        builder.notice(builder.text("accuracy.none"));
        builder.paragraph(builder.text("accuracy.how"));
        let model = quoted(&data.summary.model_file);
        builder.block(Block::Code {
            text: format!("catenix run {model} --accuracy 1%"),
        });
        return;
    }
    builder.paragraph(builder.text("accuracy.about"));
    for case in estimated {
        let Some(found) = &case.summary.discretisation else {
            continue;
        };
        let rows = found.estimates.iter().map(|estimate| {
            let scaled = Scaled::new(&estimate.unit, std::iter::once(estimate.value));
            let error = |error: f64| -> Cell {
                let scaled = Scaled::new(&estimate.unit, std::iter::once(error));
                format!("{} {}", scaled.text(error), scaled.unit).into()
            };
            let verdict = match (estimate.steers, estimate.meets(found.target)) {
                (false, _) => "accuracy.reported",
                (true, true) => "accuracy.met",
                (true, false) => "accuracy.missed",
            };
            row([
                estimate.result.as_str().into(),
                format!("{} {}", scaled.text(estimate.value), scaled.unit).into(),
                error(estimate.space_error),
                error(estimate.time_error),
                percent(estimate.relative()).into(),
                builder.text(verdict).into(),
            ])
        });
        let rows = rows.collect();
        let columns = vec![
            Column::text(&builder.text("results.result")),
            Column::number(&builder.text("accuracy.value")),
            Column::number(&builder.text("accuracy.mesh")),
            Column::number(&builder.text("accuracy.step")),
            Column::number(&builder.text("accuracy.relative")),
            Column::text(&builder.text("accuracy.verdict")),
        ];
        let target = percent(found.target);
        let elements = found.elements.to_string();
        let step = found.largest_step_s;
        let step = step.map_or(NONE.to_owned(), |step| with_unit(step, "s"));
        let trials = found.trials.to_string();
        let values = [
            ("target", target.as_str()),
            ("elements", &elements),
            ("step", &step),
            ("trials", &trials),
        ];
        let key = match found.reached {
            true => "accuracy.reached",
            false => "accuracy.not_reached",
        };
        let title = builder.fill("accuracy.title", &[("case", &case.label())]);
        let caption = builder.fill(key, &values);
        builder.table(title, caption, columns, vec![Group::new("", rows)]);
    }
}

/// The solver's own account.
pub(super) fn add_solver(data: &StudyData<'_>, builder: &mut Builder) -> Result<(), StoreError> {
    builder.section("solver", builder.text("section.solver"));
    for cases in data.cases.chunks(CASES_PER_TABLE) {
        let mut rows: Vec<Vec<Cell>> = Vec::new();
        let mut add = |key: &'static str, unit: &str, pick: &dyn Fn(&CaseSummary) -> Cell| {
            let cells: Vec<Cell> = cases.iter().map(|case| pick(&case.summary)).collect();
            if cells.iter().any(|cell| cell.text != NONE) {
                let mut row = vec![builder.text(key).into(), unit.into()];
                row.extend(cells);
                rows.push(row);
            }
        };
        let decimal = |value: Option<f64>, digits: usize| -> Cell {
            let value = value.filter(|value| value.is_finite());
            value
                .map_or(NONE.to_owned(), |value| significant(value, digits))
                .into()
        };
        add("solver.static_iterations", "", &|case| {
            count(case.static_iterations)
        });
        add("solver.static_residual", "N", &|case| {
            decimal(case.static_residual_n, 3)
        });
        add("solver.steps", "", &|case| count(case.steps));
        add("solver.rejected", "", &|case| count(case.rejected_steps));
        add("solver.iterations", "", &|case| count(case.iterations));
        add("solver.per_step", "", &|case| {
            let both = case.iterations.zip(case.steps);
            decimal(
                both.map(|(iterations, steps)| iterations as f64 / steps as f64),
                3,
            )
        });
        add("solver.factorisations", "", &|case| {
            count(case.factorisations)
        });
        add("solver.order", "", &|case| {
            decimal(
                case.steps_of_order
                    .as_ref()
                    .map(catenix_results::mean_order),
                3,
            )
        });
        add("solver.residual", "N", &|case| decimal(case.residual_n, 3));
        add("solver.imbalance", "%", &|case| {
            decimal(case.energy_imbalance.map(|share| 100.0 * share), 2)
        });
        add("solver.cpu", "s", &|case| decimal(case.cpu_seconds, 3));
        add("solver.wall", "s", &|case| decimal(case.wall_seconds, 3));
        add("solver.real_time", "", &|case| {
            decimal(case.real_time_factor, 3)
        });
        let mut energies: Vec<(String, Vec<Option<f64>>)> = Vec::new();
        for (index, case) in cases.iter().enumerate() {
            for (name, value) in case.stored.energies()? {
                let place = energies.iter().position(|(known, _)| *known == name);
                let place = place.unwrap_or_else(|| {
                    energies.push((name, vec![None; cases.len()]));
                    energies.len() - 1
                });
                energies[place].1[index] = Some(value);
            }
        }
        let energies = energies.into_iter().map(|(name, values)| {
            let scaled = Scaled::new("J", values.iter().copied().flatten());
            let known = format!("energy.{}", name.trim_end_matches("_j"));
            let text = builder.language.find(&known).map(str::to_owned);
            let text = text.unwrap_or_else(|| name.trim_end_matches("_j").replace('_', " "));
            let mut row: Vec<Cell> = vec![text.into(), scaled.unit.as_str().into()];
            row.extend(values.into_iter().map(|value| scaled.cell(value)));
            row
        });
        let energies = energies.collect();
        let groups = vec![
            Group::new("", rows),
            Group::new(&builder.text("solver.energies"), energies),
        ];
        let groups = groups.into_iter().filter(|group| !group.rows.is_empty());
        let groups = groups.collect();
        let mut columns = vec![
            Column::text(""),
            Column::text(&builder.text("results.unit")),
        ];
        columns.extend(cases.iter().map(|case| Column::number(&case.name)));
        let caption = builder.text("solver.caption");
        builder.table(builder.text("solver.title"), caption, columns, groups);
    }
    for case in &data.cases {
        for warning in &case.summary.warnings {
            let values = [("case", case.name.as_str()), ("warning", warning)];
            builder.notice(builder.fill("solver.warning", &values));
        }
    }
    Ok(())
}

/// Version, model file, date and settings.
pub(super) fn add_provenance(data: &StudyData<'_>, builder: &mut Builder) {
    builder.section("provenance", builder.text("section.provenance"));
    let summary = &data.summary;
    let created = super::date(data, builder.language);
    let facts: [(&'static str, String); 5] = [
        (
            "provenance.version",
            format!("Catenix {}", summary.catenix_version),
        ),
        ("provenance.created", created),
        ("provenance.model_file", summary.model_file.clone()),
        ("provenance.sha256", summary.model_sha256.clone()),
        ("provenance.store", data.study.path().display().to_string()),
    ];
    let rows = facts
        .into_iter()
        .map(|(key, value)| row([builder.text(key).into(), value.into()]));
    let rows = rows.collect();
    let columns = vec![
        Column::text(&builder.text("provenance.what")),
        Column::text(&builder.text("provenance.value")),
    ];
    let title = builder.text("provenance.title");
    builder.table(title, String::new(), columns, vec![Group::new("", rows)]);
    // Settings that are the same in all cases stand once.
    for cases in data.cases.chunks(CASES_PER_TABLE) {
        let mut names: Vec<&'static str> = Vec::new();
        for setting in cases.iter().flat_map(|case| &case.settings) {
            if !names.contains(&setting.name) {
                names.push(setting.name);
            }
        }
        let rows = names.into_iter().map(|name| {
            let (key, unit) = split_setting(name);
            let known = builder.language.find(&format!("setting.{key}"));
            let text = known.map_or_else(|| key.replace('_', " "), str::to_owned);
            let mut row: Vec<Cell> = vec![text.into(), unit.into()];
            let values = cases.iter().map(|case| {
                let setting = case.settings.iter().find(|setting| setting.name == name);
                Cell::from(setting.map_or(NONE.to_owned(), |setting| value(setting, builder)))
            });
            row.extend(values);
            row
        });
        let rows = rows.collect();
        let mut columns = vec![
            Column::text(&builder.text("provenance.setting")),
            Column::text(&builder.text("results.unit")),
        ];
        columns.extend(cases.iter().map(|case| Column::number(&case.name)));
        let title = builder.text("provenance.settings");
        builder.table(title, String::new(), columns, vec![Group::new("", rows)]);
    }
}

fn value(setting: &Setting, builder: &Builder) -> String {
    match &setting.value {
        SettingValue::Number(number) => shortest(*number, 6),
        SettingValue::Word(word) => {
            let known = builder.language.find(&format!("word.{word}"));
            known.map_or_else(|| word.clone(), str::to_owned)
        }
    }
}

/// `step_max_s` as name and unit.
fn split_setting(name: &str) -> (&str, &'static str) {
    match name.rsplit_once('_') {
        Some((key, "s")) => (key, "s"),
        Some((key, "m")) => (key, "m"),
        _ => (name, ""),
    }
}

/// A share in percent, two digits.
fn percent(share: f64) -> String {
    match share.is_finite() {
        true => format!("{} %", shortest(100.0 * share, 2)),
        false => NONE.to_owned(),
    }
}

/// A file name as one word of a shell.
fn quoted(name: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "-_./\\:+".contains(c);
    match !name.is_empty() && name.chars().all(plain) {
        true => name.to_owned(),
        false => format!("'{}'", name.replace('\'', "'\\''")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_stand_apart_from_the_names_of_settings() {
        assert_eq!(split_setting("step_max_s"), ("step_max", "s"));
        assert_eq!(split_setting("water_depth_m"), ("water_depth", "m"));
        assert_eq!(split_setting("integrator"), ("integrator", ""));
    }

    #[test]
    fn commands_can_be_pasted() {
        assert_eq!(quoted("examples/a-b.toml"), "examples/a-b.toml");
        assert_eq!(quoted("my model's.toml"), "'my model'\\''s.toml'");
    }
}
