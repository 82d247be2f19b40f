//! The first shape of the nodes of a line.

use catenix_model::{Line, LineEnd, Model};
use catenix_numerics::{Matrix3, Vector3, so3};

use super::super::Plan;
use super::super::directions::{about_x, has_directions, is_curved, reference_end, wanted_axes};
use super::element::section::ElementSection;
use super::ends::is_carried;
use crate::system::LineLayout;
use crate::system::shape::{Supports, line_points, loose_direction, net_direction, surface};

/// Positions and section axes of all nodes of a line along its first shape, (n_elements + 1).
/// `sections`: of its elements.
pub(super) fn nodes(
    plan: &Plan<'_>,
    line: &Line,
    layout: &LineLayout,
    sections: &[ElementSection],
) -> Vec<(Vector3, Matrix3)> {
    let Plan {
        model, supports, ..
    } = *plan;
    let ends = [0, 1].map(|end: usize| supports.point(&line.ends[end]));
    let loose = ends.iter().any(Option::is_none);
    if is_curved(line) && loose && line.start_shape.is_empty() {
        return stress_free(model, line, sections, &ends, supports);
    }
    let points = line_points(model, line, layout, supports);
    let tangents = tangents(&points);
    let directed = has_directions(model, line);
    let mut rotations: Vec<Matrix3> = Vec::with_capacity(points.len());
    for (k, tangent) in tangents.iter().enumerate() {
        rotations.push(match rotations.last() {
            None => so3::frame_from_direction(tangent, &so3::any_normal(tangent)),
            // Carried along, with the natural twist only.
            Some(before) => {
                let along: Vector3 = before.column(0).into();
                so3::shortest_arc(&along, tangent) * before * about_x(sections[k - 1].rest.x)
            }
        });
    }
    if directed {
        // Turned to agree with the end that says where local y points.
        let end = reference_end(line);
        let node = if end == 0 { 0 } else { layout.element_count };
        let wanted = wanted_axes(line, end, &tangents[node], supports);
        let y = rotations[node].transpose() * wanted.column(1);
        let roll = about_x(y.z.atan2(y.y));
        for rotation in &mut rotations {
            *rotation *= roll;
        }
    }
    for end in [0, 1] {
        ease(plan, line, end, &mut rotations);
    }
    points.into_iter().zip(rotations).collect()
}

/// Where a first shape leaves a clamp backwards, turns the node next to it half way, so that the
/// outermost element is bent by less than the half turn beyond which a rotation vector jumps.
fn ease(plan: &Plan<'_>, line: &Line, end: usize, rotations: &mut [Matrix3]) {
    let LineEnd::Connected(connection) = &line.ends[end] else {
        return;
    };
    if !is_carried(&line.ends[end]) || rotations.len() < 3 {
        return;
    }
    let node = if end == 0 { 1 } else { rotations.len() - 2 };
    let clamp =
        plan.supports.get(connection.to).rotation * Vector3::from(connection.direction_local);
    let own: Vector3 = rotations[node].column(0).into();
    if clamp.dot(&own) < 0.0 {
        let mean = (clamp + own).try_normalize(1e-6);
        let between = mean.unwrap_or_else(|| so3::any_normal(&clamp));
        rotations[node] = so3::shortest_arc(&own, &between) * rotations[node];
    }
}

/// Directions of the line at its nodes: between two chords their mean; at an end the chord, turned
/// on as far as the next node is turned back.
fn tangents(points: &[Vector3]) -> Vec<Vector3> {
    let chords: Vec<Vector3> = points
        .windows(2)
        .map(|pair| {
            let chord = (pair[1] - pair[0]).try_normalize(0.0);
            chord.unwrap_or_else(|| -Vector3::z())
        })
        .collect();
    let mean = |k: usize| {
        let sum = (chords[k - 1] + chords[k]).try_normalize(1e-6);
        sum.unwrap_or(chords[k])
    };
    let last = chords.len();
    let beyond = |chord: &Vector3, next: &Vector3| chord * (2.0 * chord.dot(next)) - next;
    (0..=last)
        .map(|k| match k {
            _ if last == 1 => chords[0],
            0 => beyond(&chords[0], &mean(1)),
            _ if k == last => beyond(&chords[last - 1], &mean(last - 1)),
            _ => mean(k),
        })
        .collect()
}

/// A curved line that is not held at both ends starts in its stress-free shape, from the end that
/// is held.
fn stress_free(
    model: &Model,
    line: &Line,
    sections: &[ElementSection],
    ends: &[Option<Vector3>; 2],
    supports: &Supports,
) -> Vec<(Vector3, Matrix3)> {
    let held = usize::from(ends[0].is_none() && ends[1].is_some());
    let point = ends[held].unwrap_or_else(Vector3::zeros);
    let down = net_direction(model, line);
    let end: &LineEnd = &line.ends[held];
    let surface = surface(model);
    let away = loose_direction(end, held, &point, line.length(), &down, surface, supports);
    let direction = away * if held == 0 { 1.0 } else { -1.0 };
    let mut rotation = wanted_axes(line, held, &direction, supports);
    let mut position = point;
    let mut nodes = vec![(position, rotation)];
    let step = |section: &ElementSection| {
        let span = so3::left_jacobian(&section.rest) * Vector3::x() * section.length;
        (span, so3::exp(&section.rest))
    };
    if held == 0 {
        for section in sections {
            let (span, turn) = step(section);
            position += rotation * span;
            rotation *= turn;
            nodes.push((position, rotation));
        }
    } else {
        for section in sections.iter().rev() {
            let (span, turn) = step(section);
            rotation *= turn.transpose();
            position -= rotation * span;
            nodes.push((position, rotation));
        }
        nodes.reverse();
    }
    nodes
}
