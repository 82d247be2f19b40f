//! Checks of the whole system: what holds it, and whether the lines are long enough.

use nalgebra::{Point3, Vector3, distance};

use crate::file::diagnostic::DiagnosticCode as Code;
use crate::file::log::Log;
use crate::{EndConnection, LineEnd, SupportRef, Vessel};

use super::environment::direction;
use super::line::ResolvedLine;
use super::{Assembly, Slot};

/// Most connection points between which chains of lines are checked: the check compares every pair.
const MOST_CHAIN_POINTS: usize = 300;

/// Reports systems that cannot be in equilibrium; one that flies freely needs none.
pub(super) fn check(assembly: &Assembly, equilibrium: bool, log: &mut Log) {
    if assembly.lines.is_empty() {
        let help = "write [lines.some_name] with sections and ends";
        log.error(Code::MissingKey, &(0..0), "the model has no line", help);
    }
    if equilibrium {
        check_supports(assembly, log);
    }
    check_depths(assembly, log);
    let direct_gaps = check_line_lengths(assembly, log);
    if !direct_gaps {
        check_chains(assembly, log);
    }
}

fn connected(end: &LineEnd) -> Option<&EndConnection> {
    match end {
        LineEnd::Free => None,
        LineEnd::Connected(connection) => Some(connection),
    }
}

fn slides(connection: &EndConnection) -> bool {
    connection.slides_along.is_some()
}

/// Lines that nothing holds, bodies that no line holds, and systems without a fixed point.
fn check_supports(assembly: &Assembly, log: &mut Log) {
    // What a broken line would have held is unknown.
    let Some(lines) = assembly
        .lines
        .iter()
        .map(|slot| Some((slot, slot.item.as_ref()?)))
        .collect::<Option<Vec<_>>>()
    else {
        return;
    };
    let mut groups = Groups::new(assembly.bodies.len() + 1);
    let held = assembly.bodies.len();
    let group_of = |connection: &EndConnection| match connection.to {
        SupportRef::Vessel(_) => held,
        SupportRef::Body(index) => index,
    };
    let mut has_line = vec![false; assembly.bodies.len() + 1];
    for (slot, resolved) in &lines {
        let ends: Vec<usize> = resolved
            .line
            .ends
            .iter()
            .filter_map(connected)
            .map(group_of)
            .collect();
        for &end in &ends {
            has_line[end] = true;
        }
        match ends.as_slice() {
            [] => {
                let message = format!(
                    "both ends of the line `{}` are free: nothing holds it",
                    slot.name
                );
                let help = "connect an end: end_a = { to = \"...\", joint = \"ball\" }; or let it fly \
                            from its first shape: statics.equilibrium = false";
                log.error(Code::Geometry, &slot.name_span, message, help);
            }
            [_] => {}
            [a, b, ..] => groups.join(*a, *b),
        }
    }
    let mut reported = Vec::new();
    for (index, slot) in assembly.bodies.iter().enumerate() {
        if !has_line[index] {
            let message = format!(
                "no line is connected to the body `{}`: nothing holds it",
                slot.name
            );
            let help = format!(
                "connect a line's end to it: end_b = {{ to = \"{}\" }}",
                slot.name
            );
            log.error(Code::Geometry, &slot.name_span, message, help);
            continue;
        }
        let group = groups.find(index);
        if group != groups.find(held) && !reported.contains(&group) {
            reported.push(group);
            let others: Vec<&str> = (0..assembly.bodies.len())
                .filter(|&other| groups.find(other) == group)
                .map(|other| assembly.bodies[other].name.as_str())
                .collect();
            let message = format!(
                "nothing holds {}: no line leads from it to a vessel or anchor",
                crate::file::log::one_of(others).replace(" or ", " and ")
            );
            let help = "connect one of its lines to a vessel or anchor";
            log.error(Code::Geometry, &slot.name_span, message, help);
        }
    }
}

/// Vessels and connection points below a seabed that acts.
fn check_depths(assembly: &Assembly, log: &mut Log) {
    let Some(seabed) = assembly.environment.seabed_height() else {
        return;
    };
    let depth = -seabed;
    let help = format!("the seabed is at z = {seabed} m");
    for slot in &assembly.vessels {
        if let Some(vessel) = &slot.item
            && vessel.position[2] < -depth
        {
            let below = -depth - vessel.position[2];
            let message = format!("`{}` lies {below:.3} m below the seabed", slot.name);
            log.error(Code::Geometry, &slot.name_span, message, &*help);
        }
    }
    for (slot, resolved) in resolved_lines(assembly) {
        for (end, span) in resolved.line.ends.iter().zip(&resolved.point_spans) {
            let Some(connection) = connected(end) else {
                continue;
            };
            let SupportRef::Vessel(index) = connection.to else {
                continue;
            };
            let Some(vessel) = assembly.vessels[index].item.as_ref() else {
                continue;
            };
            let z = vessel.position[2] + connection.point_local[2];
            // Where the vessel itself is below the seabed, that is the error.
            if z < -depth && vessel.position[2] >= -depth {
                let below = -depth - z;
                let message = format!(
                    "the end of `{}` lies {below:.3} m below the seabed",
                    slot.name
                );
                log.error(Code::Geometry, span, message, &*help);
            }
        }
    }
}

/// Lines whose two ends are a known distance apart, which they cannot span; whether there are any.
fn check_line_lengths(assembly: &Assembly, log: &mut Log) -> bool {
    let mut found = false;
    for (slot, resolved) in resolved_lines(assembly) {
        let [Some(a), Some(b)] = [0, 1].map(|end| connected(&resolved.line.ends[end])) else {
            continue;
        };
        let gap = match (a.to, b.to) {
            (SupportRef::Body(first), SupportRef::Body(second))
                if first == second && !slides(a) && !slides(b) =>
            {
                distance(&Point3::from(a.point_local), &Point3::from(b.point_local))
            }
            _ => match (
                known_position(a, &assembly.vessels),
                known_position(b, &assembly.vessels),
            ) {
                (Some(a), Some(b)) => distance(&a, &b),
                _ => continue,
            },
        };
        let (length, stretched) = (resolved.line.length(), resolved.stretched_length);
        if gap > stretched {
            found = true;
            let message = format!(
                "the ends of `{}` are {gap:.1} m apart, but the line is {length:.1} m long: {:.1} m too short",
                slot.name,
                gap - length
            );
            let help = format!(
                "it stretches to {stretched:.1} m before it counts as torn (`strain_limit` of its line types); lengthen it, or move its ends closer"
            );
            log.error(Code::Geometry, &slot.name_span, message, help);
        }
    }
    found
}

/// Chains of lines through bodies that are too short for the fixed points that they join.
fn check_chains(assembly: &Assembly, log: &mut Log) {
    let mut points: Vec<(&EndConnection, &str)> = Vec::new();
    let mut links: Vec<(usize, usize, f64)> = Vec::new();
    for (slot, resolved) in resolved_lines(assembly) {
        let [Some(a), Some(b)] = [0, 1].map(|end| connected(&resolved.line.ends[end])) else {
            continue;
        };
        links.push((points.len(), points.len() + 1, resolved.stretched_length));
        points.push((a, &slot.name));
        points.push((b, &slot.name));
    }
    if points.len() > MOST_CHAIN_POINTS || assembly.bodies.is_empty() {
        return;
    }
    for first in 0..points.len() {
        for second in first + 1..points.len() {
            let (a, b) = (points[first].0, points[second].0);
            if slides(a) || slides(b) {
                // Where a point slides, nothing limits the way from one line to the next.
                continue;
            }
            if a.to == b.to && matches!(a.to, SupportRef::Body(_)) {
                let apart = distance(&Point3::from(a.point_local), &Point3::from(b.point_local));
                links.push((first, second, apart));
            }
        }
    }
    let mut neighbours: Vec<Vec<(usize, f64)>> = vec![Vec::new(); points.len()];
    for (a, b, reach) in links {
        neighbours[a].push((b, reach));
        neighbours[b].push((a, reach));
    }
    let known: Vec<(usize, Point3<f64>)> = (0..points.len())
        .filter_map(|point| Some((point, known_position(points[point].0, &assembly.vessels)?)))
        .collect();
    let mut worst: Option<(f64, String, usize)> = None;
    for (rank, (start, start_position)) in known.iter().enumerate() {
        let reach = reaches(*start, &neighbours);
        for (end, end_position) in &known[rank + 1..] {
            let gap = distance(start_position, end_position);
            let short = gap - reach[*end];
            if short > 0.0 && worst.as_ref().is_none_or(|(most, ..)| short > *most) {
                let message = format!(
                    "the far ends of `{}` and `{}` are {gap:.1} m apart, but the lines and bodies between them reach {:.1} m at most: {short:.1} m too short",
                    points[*start].1, points[*end].1, reach[*end]
                );
                worst = Some((short, message, *start));
            }
        }
    }
    if let Some((_, message, point)) = worst {
        let line = assembly
            .lines
            .iter()
            .find(|slot| slot.name == points[point].1);
        let span = line.map_or(0..0, |slot| slot.name_span.clone());
        let help = "lengthen the lines, or move the vessels or anchors closer";
        log.error(Code::Geometry, &span, message, help);
    }
}

/// Shortest way from one point to each other (Dijkstra, without a heap for these few points).
fn reaches(start: usize, neighbours: &[Vec<(usize, f64)>]) -> Vec<f64> {
    let mut reach = vec![f64::INFINITY; neighbours.len()];
    let mut open: Vec<usize> = vec![start];
    reach[start] = 0.0;
    while let Some(position) =
        (0..open.len()).min_by(|&a, &b| reach[open[a]].total_cmp(&reach[open[b]]))
    {
        let point = open.swap_remove(position);
        for &(next, length) in &neighbours[point] {
            if reach[point] + length < reach[next] {
                reach[next] = reach[point] + length;
                open.push(next);
            }
        }
    }
    reach
}

fn resolved_lines(
    assembly: &Assembly,
) -> impl Iterator<Item = (&Slot<ResolvedLine>, &ResolvedLine)> {
    assembly
        .lines
        .iter()
        .filter_map(|slot| Some((slot, slot.item.as_ref()?)))
}

/// Position of a connection to a vessel at rest, global [m]; none for a point that slides.
fn known_position(connection: &EndConnection, vessels: &[Slot<Vessel>]) -> Option<Point3<f64>> {
    if connection.slides_along.is_some() {
        return None;
    }
    let SupportRef::Vessel(index) = connection.to else {
        return None;
    };
    let vessel = vessels.get(index)?.item.as_ref()?;
    let (cosine, sine) = direction(vessel.heading);
    let [x, y, z] = connection.point_local;
    let offset = Vector3::new(cosine * x - sine * y, sine * x + cosine * y, z);
    Some(Point3::from(vessel.position) + offset)
}

/// Sets that are joined pairwise (union-find).
struct Groups(Vec<usize>);

impl Groups {
    fn new(count: usize) -> Self {
        Groups((0..count).collect())
    }

    fn find(&mut self, mut item: usize) -> usize {
        while self.0[item] != item {
            self.0[item] = self.0[self.0[item]];
            item = self.0[item];
        }
        item
    }

    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.find(a), self.find(b));
        self.0[a] = b;
    }
}
