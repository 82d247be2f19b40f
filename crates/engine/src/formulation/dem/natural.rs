//! Lines whose sections have directions: how their elements are laid, and the stress-free shape.
//!
//! Source: docs/theory/sections.md, eqs. (4) and (14).

use catenix_model::{Joint, Line, LineEnd, Model};
use catenix_numerics::{Matrix3, Vector3, so3};

use super::element::stiffness::ConnectorStiffness;
use super::node_stiffness;
use crate::formulation::directions::{about_x, wanted_axes};
pub(super) use crate::formulation::directions::{
    connection_axes, has_directions, is_curved, reference_end,
};
use crate::system::LineLayout;
use crate::system::shape::Supports;

/// Local axes of the sections at the end of a line, from those of its outermost element, as they
/// are without stress.
pub(super) fn end_axes(half: &ConnectorStiffness, end: usize, element: &Matrix3) -> Matrix3 {
    let rest = half.rest_rotation();
    if end == 0 {
        element * rest.transpose()
    } else {
        element * rest
    }
}

/// Rotations of the elements of a line with known tangents (n_elements): carried along with the
/// natural twist only, turned to agree with the end that says where local y points.
pub(super) fn rotations_along(
    model: &Model,
    line: &Line,
    layout: &LineLayout,
    tangents: &[Vector3],
    supports: &Supports,
) -> Vec<Matrix3> {
    let mut rotations: Vec<Matrix3> = Vec::with_capacity(tangents.len());
    for (k, tangent) in tangents.iter().enumerate() {
        rotations.push(match rotations.last() {
            None => so3::frame_from_direction(tangent, &so3::any_normal(tangent)),
            Some(before) => {
                let along: Vector3 = before.column(0).into();
                let twist = node_stiffness(model, layout, k).rest_twist();
                so3::shortest_arc(&along, tangent) * before * about_x(twist)
            }
        });
    }
    let end = reference_end(line);
    let (node, element) = if end == 0 {
        (0, 0)
    } else {
        (layout.element_count, layout.element_count - 1)
    };
    let own = end_axes(
        &node_stiffness(model, layout, node),
        end,
        &rotations[element],
    );
    let wanted = wanted_axes(line, end, &own.column(0).into(), supports);
    let y = own.transpose() * wanted.column(1);
    let roll = about_x(y.z.atan2(y.y));
    for rotation in &mut rotations {
        *rotation *= roll;
    }
    rotations
}

/// Positions and rotations of the elements of a line in its stress-free shape, which starts at the
/// point and in the direction in which end `held` is held.
pub(super) fn stress_free(
    model: &Model,
    line: &Line,
    layout: &LineLayout,
    held: usize,
    point: &Vector3,
    direction: &Vector3,
    supports: &Supports,
) -> Vec<(Vector3, Matrix3)> {
    let count = layout.element_count;
    let clamped = matches!(&line.ends[held], LineEnd::Connected(connection)
        if connection.joint == Joint::Fixed);
    let mut rotation = wanted_axes(line, held, direction, supports);
    // The connectors' points, from the held end on.
    let forward = if held == 0 { 1.0 } else { -1.0 };
    let mut point = *point;
    let mut elements = Vec::with_capacity(count);
    for step in 0..count {
        let (node, element) = if held == 0 {
            (step, step)
        } else {
            (count - step, count - 1 - step)
        };
        let stiffness = node_stiffness(model, layout, node);
        let shift = if step == 0 && !clamped {
            0.0
        } else {
            stiffness.shift
        };
        point += rotation.column(0) * shift;
        let rest = stiffness.rest_rotation();
        rotation *= if held == 0 { rest } else { rest.transpose() };
        let axis: Vector3 = rotation.column(0).into();
        point -= axis * shift;
        let half = axis * (0.5 * forward * layout.length(element));
        elements.push((point + half, rotation));
        point += half * 2.0;
    }
    if held == 1 {
        elements.reverse();
    }
    elements
}
