//! Section on the system: the drawing, and what lines, bodies and vessels are.

use catenix_results::{Scene, SceneLine, StoreError};

use super::builder::{Builder, NewFigure, row};
use super::data::StudyData;
use super::document::{Cell, Column, Group};
use super::format::{NONE, with_unit};
use super::system_drawing;

pub(super) fn add(data: &StudyData<'_>, builder: &mut Builder) -> Result<(), StoreError> {
    builder.section("system", builder.text("section.system"));
    let Some(case) = data.cases.iter().find(|case| case.scene.is_some()) else {
        builder.paragraph(builder.text("system.no_scene"));
        return Ok(());
    };
    let Some(scene) = &case.scene else {
        return Ok(());
    };
    // The first case that was found at rest; cases differ little in what they are made of.
    for case in data.computed() {
        if let Some(system) = system_drawing::draw(case, builder.language)? {
            let axis = if system.axis == 0 { "x" } else { "y" };
            let mut caption = builder.fill("drawing.caption", &[("axis", axis)]);
            if data.cases.len() > 1 {
                let of_case = builder.fill("drawing.of_case", &[("case", &case.name)]);
                caption = format!("{caption} {of_case}");
            }
            let figure = NewFigure {
                name: "system",
                title: &builder.text("drawing.title"),
                caption: &caption,
            };
            let file = system.drawing.clone();
            builder.drawing(&figure, system.drawing, Some(file));
            break;
        }
    }
    lines(scene, builder);
    bodies(scene, builder);
    vessels(scene, builder);
    attachments(scene, builder);
    Ok(())
}

fn lines(scene: &Scene, builder: &mut Builder) {
    let end = |line: &SceneLine, index: usize| match &line.ends[index] {
        None => builder.text("system.free"),
        Some(end) => {
            let joint = builder.language.find(&joint_key(&end.joint));
            let joint = joint.unwrap_or(&end.joint);
            builder.fill("system.held", &[("support", &end.to), ("joint", joint)])
        }
    };
    let rows = scene.lines.iter().map(|line| {
        let mut from = 0.0;
        let sections = line.sections.iter().map(|section| {
            let length = with_unit(section.end_m - from, "m");
            from = section.end_m;
            let diameter = with_unit(section.outer_diameter_m, "m");
            let values = [
                ("type", section.line_type.as_str()),
                ("length", &length),
                ("diameter", &diameter),
            ];
            builder.fill("system.section", &values)
        });
        let mut sections: Vec<String> = sections.collect();
        // Graded meshes have many sections of one type.
        let count = sections.len();
        if count > 4 {
            sections.truncate(3);
            let more = (count - 3).to_string();
            sections.push(builder.fill("system.more", &[("count", &more)]));
        }
        row([
            line.name.as_str().into(),
            with_unit(line.length_m, "m").into(),
            line.elements.to_string().into(),
            sections.join("; ").into(),
            end(line, 0).into(),
            end(line, 1).into(),
        ])
    });
    let rows = rows.collect();
    let columns = vec![
        Column::text(&builder.text("system.line")),
        Column::number(&builder.text("system.length")),
        Column::number(&builder.text("system.elements")),
        Column::text(&builder.text("system.sections")),
        Column::text(&builder.text("system.end_a")),
        Column::text(&builder.text("system.end_b")),
    ];
    let title = builder.text("system.lines");
    builder.table(title, String::new(), columns, vec![Group::new("", rows)]);
}

/// Key of the word for a joint.
fn joint_key(joint: &str) -> String {
    format!("joint.{}", joint.replace(' ', "_"))
}

fn bodies(scene: &Scene, builder: &mut Builder) {
    let rows = scene.bodies.iter().map(|body| {
        let length = match body.length_m {
            0.0 => NONE.to_owned(),
            length => with_unit(length, "m"),
        };
        let vessel = body.offset_vessel.clone();
        row([
            body.name.as_str().into(),
            with_unit(body.mass_kg / 1000.0, "t").into(),
            with_unit(body.volume_m3, "m³").into(),
            length.into(),
            vessel.unwrap_or_else(|| NONE.to_owned()).into(),
        ])
    });
    let rows = rows.collect();
    let columns = vec![
        Column::text(&builder.text("system.body")),
        Column::number(&builder.text("system.mass")),
        Column::number(&builder.text("system.volume")),
        Column::number(&builder.text("system.length")),
        Column::text(&builder.text("system.offset_vessel")),
    ];
    let title = builder.text("system.bodies");
    builder.table(title, String::new(), columns, vec![Group::new("", rows)]);
}

fn vessels(scene: &Scene, builder: &mut Builder) {
    let rows = scene.vessels.iter().map(|vessel| {
        let [x, y, z] = vessel
            .position_m
            .map(|value| Cell::from(with_unit(value, "m")));
        let motion = match vessel.moves {
            true => builder.text("system.moves"),
            false => builder.text("system.stays"),
        };
        row([
            vessel.name.as_str().into(),
            x,
            y,
            z,
            with_unit(vessel.heading_deg, "deg").into(),
            motion.into(),
        ])
    });
    let rows = rows.collect();
    let columns = vec![
        Column::text(&builder.text("system.vessel")),
        Column::number("x"),
        Column::number("y"),
        Column::number("z"),
        Column::number(&builder.text("system.heading")),
        Column::text(&builder.text("system.motion")),
    ];
    let title = builder.text("system.vessels");
    let caption = builder.text("system.vessels_note");
    builder.table(title, caption, columns, vec![Group::new("", rows)]);
}

fn attachments(scene: &Scene, builder: &mut Builder) {
    let groups = scene.lines.iter().map(|line| {
        let rows = line.attachments.iter().map(|lump| {
            row([
                lump.name.as_str().into(),
                with_unit(lump.arc_length_m, "m").into(),
                with_unit(lump.wet_weight_n, "N").into(),
                with_unit(lump.volume_m3, "m³").into(),
            ])
        });
        Group::new(&line.name, rows.collect())
    });
    let groups: Vec<Group> = groups.filter(|group| !group.rows.is_empty()).collect();
    let columns = vec![
        Column::text(&builder.text("system.attachment")),
        Column::number(&builder.text("axis.arc_length")),
        Column::number(&builder.text("system.wet_weight")),
        Column::number(&builder.text("system.volume")),
    ];
    let title = builder.text("system.attachments");
    let caption = builder.text("system.attachments_note");
    builder.table(title, caption, columns, groups);
}
