//! Results at the nodes of a line.
//!
//! Source: docs/theory/lumped.md, eqs. (29) and (30).

use catenix_numerics::{Vector3, Vector6, six};

use super::super::{NodeResult, Situation};
use super::LumpedLine;
use super::evaluation::LumpedEvaluation;
use crate::system::LineLayout;

/// Force and moment (about the connection point) of a line on what its end is connected to.
pub(super) fn end_load(own: &LumpedEvaluation, line: usize, end: usize) -> Vector6 {
    let layout = &own.lumped.lines[line];
    let Some(held) = &layout.ends[end] else {
        return Vector6::zeros();
    };
    let force = match held.tie {
        Some(_) => own.ties[line][end].force,
        None => -own.force[layout.nodes.start + layout.end_node(end)],
    };
    let moment = match held.guide {
        Some(_) => -own.guides[line][end].moment(),
        None => Vector3::zeros(),
    };
    six(&force, &moment)
}

/// Force that an element passes on towards its end A: along it the tension, across it the shear
/// force that the bending at its two nodes makes.
///
/// Source: docs/theory/lumped.md, eq. (29).
fn passed_on(own: &LumpedEvaluation, index: usize, element: usize) -> Vector3 {
    let line = &own.lumped.lines[index];
    let spring = line.springs.start + element;
    let segment = &own.springs[spring].segment;
    let mut force = own.springs[spring].force();
    for (node, side) in [(element, 1), (element + 1, 0)] {
        let k = line.nodes.start + node;
        if own.lumped.bends[k].is_some() {
            let (before, after) = (node - 1 + line.springs.start, node + line.springs.start);
            let [before, after] = [before, after].map(|k| &own.springs[k].segment);
            force += own.bends[k].forces(before, after)[side];
        }
    }
    for end in 0..2 {
        let outermost = if end == 0 { 0 } else { line.elements() - 1 };
        let guided = line.ends[end]
            .as_ref()
            .is_some_and(|held| held.guide.is_some());
        if guided && element == outermost {
            force += own.guides[index][end].force(segment);
        }
    }
    force
}

/// Results at a node.
pub(super) fn node(
    own: &LumpedEvaluation,
    at: &Situation<'_>,
    index: usize,
    node: usize,
) -> NodeResult {
    let line = &own.lumped.lines[index];
    let layout = &at.system.lines[index];
    let n = line.elements();
    let position = own.position[line.nodes.start + node];
    let end = match node {
        0 => Some(0),
        _ if node == n => Some(1),
        _ => None,
    };
    if let Some(end) = end {
        return end_node(own, at, index, end, position);
    }
    let lengths = [layout.length(node - 1), layout.length(node)];
    let total = lengths[0] + lengths[1];
    // Values at the middles of the two elements, brought to the node between them.
    let shares = [lengths[1] / total, lengths[0] / total];
    let force =
        passed_on(own, index, node - 1) * shares[0] + passed_on(own, index, node) * shares[1];
    let direction = |element: usize| own.springs[line.springs.start + element].segment.direction;
    let axis = (direction(node - 1) * shares[0] + direction(node) * shares[1]).normalize();
    let tension = axis.dot(&force);
    let k = line.nodes.start + node;
    let (bend_moment, curvature) = match own.lumped.bends[k] {
        Some(_) => {
            let moment = own.bends[k].moment();
            let curvature = own.bends[k].angle() / (0.5 * total);
            (moment, sectional(at, layout, node, moment, curvature))
        }
        None => {
            let angle = direction(node - 1).cross(&direction(node)).norm();
            let angle = angle.atan2(direction(node - 1).dot(&direction(node)));
            (0.0, angle / (0.5 * total))
        }
    };
    NodeResult {
        position,
        axis,
        tension,
        shear: (force - axis * tension).norm(),
        bend_moment,
        torque: f64::NAN,
        curvature,
    }
}

/// Curvature at a node: where the stiffness jumps, that of the more flexible side.
fn sectional(at: &Situation<'_>, layout: &LineLayout, node: usize, moment: f64, mean: f64) -> f64 {
    let sides = [node.saturating_sub(1), node.min(layout.element_count - 1)];
    let types = sides.map(|k| &at.system.model.line_types[layout.element_types[k]]);
    if types[0].bending_law.is_some() {
        return mean;
    }
    let [a, b] = types.map(|own| own.bending_stiffness[0]);
    moment / a.min(b)
}

/// Results at an end: from what its support has to hold.
///
/// Source: docs/theory/lumped.md, eq. (30).
fn end_node(
    own: &LumpedEvaluation,
    at: &Situation<'_>,
    index: usize,
    end: usize,
    position: Vector3,
) -> NodeResult {
    let line = &own.lumped.lines[index];
    let layout = &at.system.lines[index];
    let axis = end_axis(own, line, layout, end);
    let mut result = NodeResult {
        position,
        axis,
        torque: f64::NAN,
        ..NodeResult::default()
    };
    let Some(held) = &line.ends[end] else {
        return result;
    };
    // A clamp holds the direction of the line.
    if matches!(
        &held.guide,
        Some((
            _,
            crate::formulation::lumped::element::guide::Guide::Along(_)
        ))
    ) && is_clamp(at, index, end)
    {
        result.axis = held.direction(&held.seat(at));
    }
    let load = end_load(own, index, end);
    let force: Vector3 = load.fixed_rows::<3>(0).into();
    let along = result.axis.dot(&force);
    result.tension = if end == 0 { along } else { -along };
    result.shear = (force - result.axis * along).norm();
    if held.guide.is_some() {
        result.bend_moment = own.guides[index][end].moment_size();
        let element = if end == 0 {
            0
        } else {
            layout.element_count - 1
        };
        let line_type = &at.system.model.line_types[layout.element_types[element]];
        let stiffness = line_type.bending_stiffness[0];
        result.curvature = match &line_type.bending_law {
            Some(_) => own.guides[index][end].angle() / (0.5 * layout.length(element)),
            None => result.bend_moment / stiffness,
        };
    }
    result
}

fn is_clamp(at: &Situation<'_>, index: usize, end: usize) -> bool {
    use catenix_model::{Joint, LineEnd};
    matches!(&at.system.model.lines[index].ends[end],
        LineEnd::Connected(connection) if connection.joint == Joint::Fixed)
}

/// Direction of a line at its very end, extrapolated from the two elements there.
///
/// Source: docs/theory/results.md, eq. (10).
fn end_axis(own: &LumpedEvaluation, line: &LumpedLine, layout: &LineLayout, end: usize) -> Vector3 {
    let n = line.elements();
    let (last, next) = if end == 0 {
        (0, 1)
    } else {
        (n - 1, n.wrapping_sub(2))
    };
    let direction = |element: usize| own.springs[line.springs.start + element].segment.direction;
    if n < 2 {
        return direction(last);
    }
    let ahead = layout.length(last) / (layout.length(last) + layout.length(next));
    (direction(last) + (direction(last) - direction(next)) * ahead).normalize()
}
