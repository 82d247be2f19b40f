//! Which way the sections of a line point about its axis, and what says so.
//!
//! Source: docs/theory/sections.md, eq. (14).

use catenix_model::{EndConnection, Joint, Line, LineEnd, Model};
use catenix_numerics::{Matrix3, Vector3, so3};

use crate::system::shape::Supports;

/// Whether it matters how the sections of a line are turned about its axis.
pub(crate) fn has_directions(model: &Model, line: &Line) -> bool {
    line.sections.iter().any(|section| {
        let [y, z] = model.line_types[section.line_type].bending_stiffness;
        y != z || !section.natural.is_straight()
    }) || line.ends.iter().any(|end| {
        matches!(end, LineEnd::Connected(connection)
            if connection.joint == Joint::Fixed && connection.axis_given)
    })
}

/// Whether the line is bent where no stress acts.
pub(crate) fn is_curved(line: &Line) -> bool {
    let curved = |curvature: [f64; 2]| curvature != [0.0; 2];
    line.sections.iter().any(|s| curved(s.natural.curvature))
}

/// The end whose connection says where local y points: one that says so itself, else a connected
/// one; end A before end B.
pub(crate) fn reference_end(line: &Line) -> usize {
    let connection = |end: usize| match &line.ends[end] {
        LineEnd::Connected(connection) => Some(connection),
        LineEnd::Free => None,
    };
    let says = |end: usize| {
        connection(end).is_some_and(|connection| match connection.joint {
            Joint::Universal { .. } | Joint::Hinge { .. } => true,
            Joint::Fixed => connection.axis_given,
            Joint::Ball { .. } => false,
        })
    };
    let order = [0, 1];
    order
        .into_iter()
        .find(|&end| says(end))
        .or_else(|| order.into_iter().find(|&end| connection(end).is_some()))
        .unwrap_or(0)
}

/// Local axes that a connection gives the sections at an end, in the axes of the support.
pub(crate) fn connection_axes(connection: &EndConnection) -> Matrix3 {
    so3::frame_from_direction(
        &Vector3::from(connection.direction_local),
        &Vector3::from(connection.axis_local),
    )
}

/// Where a connected end points the sections: its global axes, with x along `tangent`.
pub(crate) fn wanted_axes(
    line: &Line,
    end: usize,
    tangent: &Vector3,
    supports: &Supports,
) -> Matrix3 {
    let LineEnd::Connected(connection) = &line.ends[end] else {
        return so3::frame_from_direction(tangent, &so3::any_normal(tangent));
    };
    let axes = supports.get(connection.to).rotation * connection_axes(connection);
    let direction: Vector3 = axes.column(0).into();
    so3::shortest_arc(&direction, tangent) * axes
}

/// A rotation about local x.
pub(crate) fn about_x(angle: f64) -> Matrix3 {
    so3::exp(&Vector3::new(angle, 0.0, 0.0))
}
