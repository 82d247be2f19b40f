//! Section with the load cases, their key results, and results from elsewhere beside them.

use catenix_results::{CaseSummary, EndSummary, Extent, LineSummary, Located};

use super::builder::{Builder, row};
use super::data::{CaseData, StudyData};
use super::document::{Cell, Column, Group};
use super::format::{NONE, Scaled, with_unit};

/// Most cases beside each other in a table.
const CASES_PER_TABLE: usize = 6;

/// One number of a case, and where along its line it is [m].
type Number = (f64, Option<f64>);
type PickEnd = fn(&LineSummary) -> &EndSummary;
type PickStatistic = fn(&Extent) -> f64;
type Pick = fn(&EndSummary) -> Extent;
type PickLocated = fn(&LineSummary) -> Option<Located>;

pub(super) fn add(data: &StudyData<'_>, builder: &mut Builder) {
    builder.section("results", builder.text("section.results"));
    cases(data, builder);
    let computed = data.computed();
    for cases in computed.chunks(CASES_PER_TABLE) {
        let groups = groups(cases, builder);
        let mut columns = vec![
            Column::text(&builder.text("results.result")),
            Column::text(&builder.text("results.unit")),
        ];
        columns.extend(cases.iter().map(|case| Column::number(&case.name)));
        let caption = builder.text("results.caption");
        builder.table(builder.text("results.key"), caption, columns, groups);
    }
    references(&computed, builder);
}

fn cases(data: &StudyData<'_>, builder: &mut Builder) {
    let rows = data.cases.iter().map(|case| {
        let seconds = |value: Option<f64>| value.map_or(NONE.to_owned(), |s| with_unit(s, "s"));
        let window = case
            .summary
            .window_s
            .filter(|_| case.summary.simulated_s.is_some());
        let window = window.map_or(NONE.to_owned(), |[from, to]| {
            let [from, to] = [from, to].map(|time| with_unit(time, "s"));
            builder.fill("results.from_to", &[("from", &from), ("to", &to)])
        });
        row([
            case.name.as_str().into(),
            case.summary.description.as_str().into(),
            builder.language.text(status_key(case)).into(),
            seconds(case.summary.simulated_s).into(),
            window.into(),
        ])
    });
    let rows = rows.collect();
    let columns = vec![
        Column::text(&builder.text("results.case")),
        Column::text(&builder.text("results.description")),
        Column::text(&builder.text("results.status")),
        Column::number(&builder.text("results.simulated")),
        Column::number(&builder.text("results.window")),
    ];
    let title = builder.text("results.cases");
    builder.table(title, String::new(), columns, vec![Group::new("", rows)]);
}

/// Key of the word for how far a case came.
pub(super) fn status_key(case: &CaseData) -> &'static str {
    super::status_key(case.summary.status)
}

/// The rows of all bodies and lines.
fn groups(cases: &[&CaseData], builder: &Builder) -> Vec<Group> {
    let mut groups = Vec::new();
    let mut names: Vec<&String> = Vec::new();
    for name in cases.iter().flat_map(|case| case.summary.bodies.keys()) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    for name in names {
        let vessel = cases.iter().find_map(|case| {
            let body = case.summary.bodies.get(name)?;
            body.offset_vessel.as_deref()
        });
        let title = match vessel {
            Some(vessel) => {
                builder.fill("results.body_from", &[("body", name), ("vessel", vessel)])
            }
            None => builder.fill("results.body", &[("body", name)]),
        };
        let value = |pick: fn(&catenix_results::BodySummary) -> Option<f64>| {
            move |summary: &CaseSummary| Some((pick(summary.bodies.get(name)?)?, None))
        };
        let mut rows = Vec::new();
        let mut add =
            |quantity: &str, unit, pick: fn(&catenix_results::BodySummary) -> Option<f64>| {
                let name = mean(builder, quantity);
                rows.extend(number_row(&name, unit, cases, value(pick)));
            };
        if vessel.is_some() {
            add("offset_x", "m", |body| body.offset_x_m);
            add("offset_y", "m", |body| body.offset_y_m);
            add("offset_z", "m", |body| body.offset_z_m);
        } else {
            add("x", "m", |body| body.x_m);
            add("y", "m", |body| body.y_m);
            add("z", "m", |body| body.z_m);
        }
        add("tilt", "deg", |body| body.tilt_deg);
        groups.push(Group::new(&title, rows));
    }
    let mut names: Vec<&String> = Vec::new();
    for name in cases.iter().flat_map(|case| case.summary.lines.keys()) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    for name in names {
        groups.extend(line_groups(name, cases, builder));
    }
    groups.retain(|group| !group.rows.is_empty());
    groups
}

fn line_groups(name: &str, cases: &[&CaseData], builder: &Builder) -> Vec<Group> {
    let ends: [(&str, PickEnd); 2] = [("end_a", |line| &line.end_a), ("end_b", |line| &line.end_b)];
    let mut groups = Vec::new();
    for (label, end) in ends {
        let mut rows = Vec::new();
        let extent = |pick: fn(&EndSummary) -> Extent, statistic: fn(&Extent) -> f64| {
            move |summary: &CaseSummary| {
                let line = summary.lines.get(name)?;
                Some((statistic(&pick(end(line))), None))
            }
        };
        let forces: [(&str, Pick); 3] = [
            ("force_x", |end| end.force_x_n),
            ("force_y", |end| end.force_y_n),
            ("force_z", |end| end.force_z_n),
        ];
        for (quantity, pick) in forces {
            let name = mean(builder, quantity);
            rows.extend(number_row(&name, "N", cases, extent(pick, |e| e.mean)));
        }
        let tension: Pick = |end| end.effective_tension_n;
        let statistics: [(&'static str, PickStatistic); 3] = [
            ("results.smallest", |extent| extent.min),
            ("results.mean", |extent| extent.mean),
            ("results.largest", |extent| extent.max),
        ];
        let moves = cases.iter().any(|case| case.summary.simulated_s.is_some());
        for (key, statistic) in statistics {
            if moves || key == "results.mean" {
                let name = builder.language.quantity("effective_tension");
                let name = builder.fill(key, &[("quantity", &name)]);
                rows.extend(number_row(&name, "N", cases, extent(tension, statistic)));
            }
        }
        let name_of_end = builder.language.end(label);
        let values = [("line", name), ("end", name_of_end.as_str())];
        groups.push(Group::new(&builder.fill("results.end", &values), rows));
    }
    let mut rows = Vec::new();
    let along: [(&'static str, &str, &str, PickLocated); 5] = [
        ("results.smallest", "effective_tension", "N", |line| {
            line.min_effective_tension_n
        }),
        ("results.largest", "effective_tension", "N", |line| {
            line.max_effective_tension_n
        }),
        ("results.largest", "bend_moment", "N m", |line| {
            line.max_bend_moment_n_m
        }),
        ("results.largest", "curvature", "1/m", |line| {
            line.max_curvature_1_m
        }),
        ("results.largest", "von_mises_stress", "Pa", |line| {
            line.max_von_mises_stress_pa
        }),
    ];
    for (key, quantity, unit, pick) in along {
        let text = builder.language.quantity(quantity);
        let text = builder.fill(key, &[("quantity", &text)]);
        rows.extend(number_row(&text, unit, cases, |summary| {
            let located = pick(summary.lines.get(name)?)?;
            Some((located.value, Some(located.arc_length_m)))
        }));
    }
    groups.push(Group::new(
        &builder.fill("results.along", &[("line", name)]),
        rows,
    ));
    groups
}

fn mean(builder: &Builder, quantity: &str) -> String {
    let name = builder.language.quantity(quantity);
    builder.fill("results.mean", &[("quantity", &name)])
}

/// A row of one number per case; `None` where no case has it.
fn number_row(
    name: &str,
    unit: &str,
    cases: &[&CaseData],
    pick: impl Fn(&CaseSummary) -> Option<Number>,
) -> Option<Vec<Cell>> {
    let numbers: Vec<Option<Number>> = cases
        .iter()
        .map(|case| pick(&case.summary).filter(|(value, _)| value.is_finite()))
        .collect();
    if numbers.iter().all(Option::is_none) {
        return None;
    }
    let values = numbers.iter().flatten().map(|(value, _)| *value);
    let scaled = Scaled::new(unit, values);
    let mut cells: Vec<Cell> = vec![name.into(), scaled.unit.as_str().into()];
    for number in numbers {
        let mut cell = scaled.cell(number.map(|(value, _)| value));
        if let Some((_, Some(place))) = number {
            cell.remark = with_unit(place, "m");
        }
        cells.push(cell);
    }
    Some(cells)
}

/// Results from elsewhere, by their source.
fn references(cases: &[&CaseData], builder: &mut Builder) {
    let mut groups: Vec<Group> = Vec::new();
    for case in cases {
        for reference in &case.summary.references {
            let computed = reference.computed;
            let numbers = [reference.low, reference.high].into_iter().chain(computed);
            let scaled = Scaled::new(&reference.unit, numbers);
            let range = match reference.low == reference.high {
                true => scaled.text(reference.low),
                false => {
                    let [from, to] = [reference.low, reference.high].map(|v| scaled.text(v));
                    builder.fill("results.from_to", &[("from", &from), ("to", &to)])
                }
            };
            let difference: Cell = match reference.difference {
                Some(0.0) if reference.low < reference.high => {
                    builder.text("results.inside").into()
                }
                difference => scaled.cell(difference),
            };
            let statistic = match reference.statistic.word() {
                "min" => "results.smallest",
                "max" => "results.largest",
                _ => "results.mean",
            };
            let channel = builder.language.channel(&reference.channel);
            let cells = row([
                case.name.as_str().into(),
                builder.fill(statistic, &[("quantity", &channel)]).into(),
                scaled.unit.as_str().into(),
                range.into(),
                scaled.cell(computed),
                difference,
            ]);
            match groups
                .iter_mut()
                .find(|group| group.name == reference.source)
            {
                Some(group) => group.rows.push(cells),
                None => groups.push(Group::new(&reference.source, vec![cells])),
            }
        }
    }
    let columns = vec![
        Column::text(&builder.text("results.case")),
        Column::text(&builder.text("results.result")),
        Column::text(&builder.text("results.unit")),
        Column::number(&builder.text("results.elsewhere")),
        Column::number(&builder.text("results.computed")),
        Column::number(&builder.text("results.difference")),
    ];
    let title = builder.text("results.references");
    let caption = builder.text("results.references_note");
    builder.table(title, caption, columns, groups);
}
