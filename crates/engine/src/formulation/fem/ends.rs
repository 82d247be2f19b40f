//! The connections of the ends of lines to vessels and bodies.
//!
//! Source: docs/theory/fem.md, eqs. (32) to (35), and docs/theory/sections.md, eq. (14).

use catenix_model::{EndConnection, Joint, Line, LineEnd, SupportRef};
use catenix_numerics::{Matrix3, Vector3, so3};

use super::super::Plan;
use super::super::directions::{connection_axes, has_directions, reference_end};
use super::element::joint::{Direction, Hold, JointSprings};
use super::element::section::ElementSection;
use super::{EndJoint, Place, Seat};
use crate::system::Mount;

/// Stiffness of the springs of a joint over that of the element next to them.
const STIFFER: f64 = 100.0;

/// Stiffness of the outermost element over what its section has, next to a joint with springs: the
/// two in series then stretch as the element alone should.
///
/// Source: docs/theory/fem.md, eq. (35).
pub(super) fn axial_share(end: &LineEnd) -> f64 {
    match end {
        LineEnd::Connected(connection)
            if matches!(connection.to, SupportRef::Body(_))
                && connection.joint != Joint::Fixed
                && connection.slides_along.is_none() =>
        {
            STIFFER / (STIFFER - 1.0)
        }
        _ => 1.0,
    }
}

/// Whether the end of a line is a point of what it is connected to, and no node of its own.
pub(super) fn is_carried(end: &LineEnd) -> bool {
    matches!(end, LineEnd::Connected(connection)
        if connection.joint == Joint::Fixed && connection.slides_along.is_none())
}

/// Where the outermost node of a line sits, with the springs that hold it, if any.
/// `node`: its frame, if it has one; `own`: its section axes in the first shape.
pub(super) fn connect(
    plan: &Plan<'_>,
    line: usize,
    end: usize,
    node: usize,
    own: &Matrix3,
    section: &ElementSection,
    stiffest: f64,
) -> (Seat, Option<EndJoint>) {
    let own_line = &plan.model.lines[line];
    let LineEnd::Connected(connection) = &own_line.ends[end] else {
        return (Seat::Node(node), None);
    };
    let support = plan.supports.get(connection.to);
    let mount = |axes: Matrix3| Mount {
        carrier: support.carrier,
        arm: Vector3::from(connection.point_local),
        axes,
    };
    if is_carried(&own_line.ends[end]) {
        let axes = fixed_axes(plan, own_line, end, connection, own);
        return (Seat::Carried(mount(axes)), None);
    }
    let fixed = connection.joint == Joint::Fixed;
    let axes = if fixed {
        fixed_axes(plan, own_line, end, connection, own)
    } else {
        Matrix3::identity()
    };
    let slide = connection
        .slides_along
        .map(|along| axes.transpose() * Vector3::from(along));
    let directions = directions(connection, section, own, &support.rotation);
    let (place, on_vessel) = match (connection.to, end) {
        (SupportRef::Vessel(_), _) => (Place::Grounded, true),
        (SupportRef::Body(_), 0) => (Place::Head(line), false),
        (SupportRef::Body(_), _) => (Place::Tail(line), false),
    };
    let exact = on_vessel && slide.is_none();
    let seat = if exact {
        Seat::Hinged(node, mount(axes))
    } else {
        Seat::Node(node)
    };
    let held = !exact || !directions.is_empty();
    let joint = held.then(|| EndJoint {
        springs: JointSprings {
            stiffness: if exact {
                0.0
            } else {
                STIFFER * stiffest / section.length
            },
            slide,
            directions,
        },
        support: mount(axes),
        node,
        place,
    });
    (seat, joint)
}

/// Connection axes of a fixed joint, in the support's axes.
fn fixed_axes(
    plan: &Plan<'_>,
    line: &Line,
    end: usize,
    connection: &EndConnection,
    own: &Matrix3,
) -> Matrix3 {
    let says = connection.axis_given || reference_end(line) == end;
    if says && has_directions(plan.model, line) {
        return connection_axes(connection);
    }
    // Turned the shortest way into the connection's direction: a line that is laid in its first
    // shape is not twisted.
    let support = &plan.supports.get(connection.to).rotation;
    let tangent: Vector3 = own.column(0).into();
    let direction = support * Vector3::from(connection.direction_local);
    support.transpose() * so3::shortest_arc(&tangent, &direction) * own
}

/// What holds the rotation of an end.
fn directions(
    connection: &EndConnection,
    section: &ElementSection,
    own: &Matrix3,
    support: &Matrix3,
) -> Vec<Direction> {
    let torsion = STIFFER * section.torsion / section.length;
    let bending = STIFFER * 4.0 * section.bending[0].max(section.bending[1]) / section.length;
    let hold = |on_support: Vector3, on_node: Vector3, hold| Direction {
        on_support,
        on_node,
        hold,
    };
    let tangent: Vector3 = own.column(0).into();
    // The cross's second axis, in the node: normal to the line and to the support's axis.
    let second_axis = |axis: Vector3| {
        let normal = tangent.cross(&(support * axis)).try_normalize(1e-6);
        own.transpose() * normal.unwrap_or_else(|| so3::any_normal(&tangent))
    };
    let (x, y, z) = (Vector3::x(), Vector3::y(), Vector3::z());
    match connection.joint {
        Joint::Ball {
            rotational_stiffness,
        } if rotational_stiffness > 0.0 => {
            let direction = Vector3::from(connection.direction_local);
            vec![hold(direction, x, Hold::Parallel(rotational_stiffness))]
        }
        Joint::Ball { .. } => Vec::new(),
        Joint::Universal { axis_local } => {
            let axis = Vector3::from(axis_local);
            vec![hold(axis, second_axis(axis), Hold::Perpendicular(torsion))]
        }
        Joint::Hinge { axis_local } => {
            let axis = Vector3::from(axis_local);
            vec![
                hold(axis, second_axis(axis), Hold::Perpendicular(torsion)),
                hold(axis, x, Hold::Perpendicular(bending)),
            ]
        }
        // Fixed, but free to slide: all three directions.
        Joint::Fixed => vec![
            hold(x, y, Hold::Perpendicular(bending)),
            hold(x, z, Hold::Perpendicular(bending)),
            hold(y, z, Hold::Perpendicular(torsion)),
        ],
    }
}
