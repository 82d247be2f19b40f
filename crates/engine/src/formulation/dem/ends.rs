//! The connections of the ends of lines to vessels and bodies.
//!
//! Source: docs/theory/dem.md, eqs. (17) to (21), and docs/theory/sections.md, eq. (14).

use catenix_model::{EndConnection, Joint, SupportRef};
use catenix_numerics::{Matrix3, Vector3, so3};

use super::super::Plan;
use super::element::joint::{DotLaw, DotSpring, JointStiffness};
use super::slide::Slide;
use super::{Connector, ConnectorLaw, Place, half, natural, node_stiffness};
use crate::system::Mount;

/// The connection of a line's end to a vessel or body.
pub(super) fn end_connector(
    plan: &Plan<'_>,
    line: usize,
    end: usize,
    connection: &EndConnection,
    element: Mount,
    element_rotation: &Matrix3,
) -> Connector {
    let (model, layout) = (plan.model, &plan.layouts[line]);
    let support = plan.supports.get(connection.to);
    let point = Vector3::from(connection.point_local);
    let direction = Vector3::from(connection.direction_local);
    let tangent: Vector3 = element_rotation.column(0).into();
    let (node, outermost) = if end == 0 {
        (0, 0)
    } else {
        (layout.element_count, layout.element_count - 1)
    };
    let half = half(model, layout, outermost);
    let mut stiffness = node_stiffness(model, layout, node);
    if connection.slides_along.is_some() {
        // The condensed slide has no rate, and its place is found for a linear spring.
        stiffness.damping = 0.0;
        if let Some(general) = &mut stiffness.general {
            general.axial = None;
        }
    }
    let slide = |axes: &Matrix3, support_first| {
        connection.slides_along.map(|axis| Slide {
            support_first,
            axis: axes.transpose() * Vector3::from(axis),
        })
    };
    let place = match (connection.to, end) {
        (SupportRef::Vessel(_), _) => Place::Grounded,
        (SupportRef::Body(_), 0) => Place::Head(line),
        (SupportRef::Body(_), _) => Place::Tail(line),
    };
    let on_support = |axes: Matrix3| Mount {
        carrier: support.carrier,
        arm: point,
        axes,
    };
    // The line's axes at its end, without stress.
    let own = natural::end_axes(&stiffness, end, element_rotation);
    if connection.joint == Joint::Fixed {
        let own_line = &model.lines[line];
        let says = connection.axis_given || natural::reference_end(own_line) == end;
        let axes = if says && natural::has_directions(model, own_line) {
            natural::connection_axes(connection)
        } else {
            // Turned the shortest way into the connection's direction: a line that is laid in its
            // first shape is not twisted.
            let tangent: Vector3 = own.column(0).into();
            let untwisted = so3::shortest_arc(&tangent, &(support.rotation * direction)) * own;
            support.rotation.transpose() * untwisted
        };
        let stiffness = stiffness.with_layer_at_clamp(half, layout.expected_tension(node));
        let shift = Vector3::x() * stiffness.shift;
        let clamp = on_support(axes).shifted(&shift);
        let element = element.shifted(&shift);
        let (first, second) = if end == 0 {
            (clamp, element)
        } else {
            (element, clamp)
        };
        return Connector {
            law: ConnectorLaw::Beam(stiffness),
            first,
            second,
            place,
            slide: slide(&axes, end == 0),
        };
    }
    let torsion = 2.0 * half.line_type.torsional_stiffness / half.length;
    let bending = half
        .line_type
        .bending_stiffness
        .map(|stiffness| 2.0 * stiffness / half.length);
    // Direction of the line at its end, in the element's axes.
    let end_direction: Vector3 = natural::end_axes(&stiffness, end, &Matrix3::identity())
        .column(0)
        .into();
    let spring = |support_axis: Vector3, element_axis: Vector3, law| DotSpring {
        support_axis,
        element_axis,
        law,
    };
    // The cross's second axis, in the element: normal to the line and to the support's axis.
    let second_axis = |axis: Vector3| {
        let normal = tangent.cross(&(support.rotation * axis));
        let normal = if normal.norm() > 1e-6 {
            normal.normalize()
        } else {
            so3::any_normal(&tangent)
        };
        element_rotation.transpose() * normal
    };
    let springs = match connection.joint {
        Joint::Ball {
            rotational_stiffness,
        } if rotational_stiffness > 0.0 => {
            let [y, z] = bending.map(|own| 1.0 / (1.0 / rotational_stiffness + 1.0 / own));
            let mut springs = vec![spring(direction, end_direction, DotLaw::Parallel(y.min(z)))];
            // The stiffer plane of the half element adds the difference: a bend about y moves the
            // direction along z.
            if y != z {
                let across = if y > z { Vector3::z() } else { Vector3::y() };
                let across = across - end_direction * end_direction.dot(&across);
                let law = DotLaw::Perpendicular((y - z).abs());
                springs.push(spring(direction, across.normalize(), law));
            }
            springs
        }
        Joint::Ball { .. } | Joint::Fixed => Vec::new(),
        Joint::Universal { axis_local } => {
            let axis = Vector3::from(axis_local);
            vec![spring(
                axis,
                second_axis(axis),
                DotLaw::Perpendicular(torsion),
            )]
        }
        Joint::Hinge { axis_local } => {
            let axis = Vector3::from(axis_local);
            // The line bends against the hinge about the normal of hinge axis and line.
            let hinge = element_rotation.transpose() * (support.rotation * axis);
            let [y, z] = bending;
            let (along_y, along_z) = (hinge.y * hinge.y, hinge.z * hinge.z);
            let held = if y == z || along_y + along_z == 0.0 {
                y
            } else {
                (along_y + along_z) / (along_z / y + along_y / z)
            };
            vec![
                spring(axis, second_axis(axis), DotLaw::Perpendicular(torsion)),
                spring(axis, end_direction, DotLaw::Perpendicular(held)),
            ]
        }
    };
    Connector {
        law: ConnectorLaw::Joint(JointStiffness {
            half: stiffness,
            forward: if end == 0 { -1.0 } else { 1.0 },
            springs,
        }),
        first: on_support(Matrix3::identity()),
        second: element,
        place,
        slide: slide(&Matrix3::identity(), true),
    }
}
