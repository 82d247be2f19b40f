//! Results at the nodes of a line, from the connectors there.

use catenix_model::Model;
use catenix_numerics::{Vector3, Vector6, six};

use super::super::{NodeResult, Situation};
use super::ConnectorLaw;
use super::evaluation::DemEvaluation;
use super::pairs::{EvaluatedPair, PairState};
use crate::system::LineLayout;

/// Force and moment (about the connection point) of a line on what its end is connected to.
pub(super) fn end_load(
    own: &DemEvaluation,
    at: &Situation<'_>,
    line: usize,
    end: usize,
) -> Vector6 {
    let layout = &at.system.lines[line];
    let node = if end == 0 { 0 } else { layout.element_count };
    let Some(connector) = own.dem.connector(line, node) else {
        return Vector6::zeros();
    };
    let pair = EvaluatedPair::new(&connector, at);
    let forces = pair.forces();
    let support_first = matches!(connector.law, ConnectorLaw::Joint(_)) || end == 0;
    let (load, side) = if support_first {
        (-forces.first, &pair.first)
    } else {
        (-forces.second, &pair.second)
    };
    let shift = side.rotation.column(0) * connector.law.shift();
    let arm = side.lever - shift;
    let force: Vector3 = load.fixed_rows::<3>(0).into();
    let moment: Vector3 = load.fixed_rows::<3>(3).into();
    six(&force, &(moment - arm.cross(&force)))
}

/// Results at a node.
pub(super) fn node(
    own: &DemEvaluation,
    at: &Situation<'_>,
    line: usize,
    node: usize,
) -> NodeResult {
    let layout = &at.system.lines[line];
    let model = &at.system.model;
    let Some(connector) = own.dem.connector(line, node) else {
        return free_end(at, layout, node);
    };
    let pair = &EvaluatedPair::new(&connector, at);
    let law = &connector.law;
    let (mut result, elastic_moment) = match &pair.state {
        PairState::Beam(state) => {
            let axis = match node {
                // A clamp holds the direction of the line.
                0 => pair.first.rotation.column(0).into(),
                _ if node == layout.element_count => pair.second.rotation.column(0).into(),
                _ => state.axis,
            };
            beam_node(pair, law.shift(), &axis)
        }
        PairState::Joint(_) => joint_node(pair, node == 0, &end_axis(at, layout, node)),
    };
    let sides = [node.saturating_sub(1), node.min(layout.element_count - 1)];
    if law.stiffness().general.is_some() {
        let of_side =
            |&k: &usize| section_curvature(model, layout, k, pair, &result.axis, &elastic_moment);
        result.curvature = sides.iter().map(of_side).fold(0.0, f64::max);
        return result;
    }
    let stiffness = |k: usize| model.line_types[layout.element_types[k]].bending_stiffness[0];
    // Where the stiffness jumps, the more flexible side has the larger curvature.
    let bending = stiffness(sides[0]).min(stiffness(sides[1]));
    result.curvature = if bending > 0.0 {
        result.bend_moment / bending
    } else {
        let first: Vector3 = pair.first.rotation.column(0).into();
        let second: Vector3 = pair.second.rotation.column(0).into();
        let angle = first.cross(&second).norm().atan2(first.dot(&second));
        angle / layout.length(sides[1])
    };
    result
}

/// Curvature of the section of an element beside a connector: the natural one, and what the
/// moment adds by the section's law. `elastic` is the moment, signed as bend towards end B [N m].
///
/// Source: docs/theory/sections.md, eq. (17).
fn section_curvature(
    model: &Model,
    layout: &LineLayout,
    element: usize,
    pair: &EvaluatedPair,
    axis: &Vector3,
    elastic: &Vector3,
) -> f64 {
    let line_type = &model.line_types[layout.element_types[element]];
    let across = elastic - axis * axis.dot(elastic);
    // Directors half way between the two sections of a beam; those of the element at a joint.
    let director = |column: usize| -> Vector3 {
        let own: Vector3 = pair.second.rotation.column(column).into();
        match &pair.state {
            PairState::Beam(_) => (own + pair.first.rotation.column(column)).normalize(),
            PairState::Joint(_) => own,
        }
    };
    let moment = [director(1).dot(&across), director(2).dot(&across)];
    let by_moment = match &line_type.bending_law {
        Some(points) => {
            let size = moment[0].hypot(moment[1]);
            let share = if size > 0.0 {
                law_curvature(points, size) / size
            } else {
                0.0
            };
            moment.map(|m| m * share)
        }
        None => {
            let stiffness = line_type.bending_stiffness;
            [0, 1].map(|k| {
                if stiffness[k] > 0.0 {
                    moment[k] / stiffness[k]
                } else {
                    0.0
                }
            })
        }
    };
    let natural = layout.natural[element].curvature;
    (natural[0] + by_moment[0]).hypot(natural[1] + by_moment[1])
}

/// A free end carries nothing.
fn free_end(at: &Situation<'_>, layout: &LineLayout, node: usize) -> NodeResult {
    let at_b = node > 0;
    let element = if at_b { node - 1 } else { 0 };
    let frame = layout.first_frame + element;
    let configuration = &at.state.configuration;
    let half = layout.length(element) * if at_b { 0.5 } else { -0.5 };
    let [y, z] = layout.natural[element].curvature;
    NodeResult {
        position: configuration.position[frame] + configuration.rotation[frame].column(0) * half,
        axis: end_axis(at, layout, node),
        curvature: y.hypot(z),
        ..NodeResult::default()
    }
}

/// Axis of a line at its very end, extrapolated from the two elements there.
///
/// Source: docs/theory/results.md, eq. (10).
fn end_axis(at: &Situation<'_>, layout: &LineLayout, node: usize) -> Vector3 {
    let (end, next) = if node == 0 {
        (0, 1)
    } else {
        let last = layout.element_count - 1;
        (last, last.saturating_sub(1))
    };
    let axis = |element: usize| -> Vector3 {
        let frame = layout.first_frame + element;
        at.state.configuration.rotation[frame].column(0).into()
    };
    if layout.element_count < 2 {
        return axis(end);
    }
    let ahead = layout.length(end) / (layout.length(end) + layout.length(next));
    (axis(end) + (axis(end) - axis(next)) * ahead).normalize()
}

/// Curvature [1/m] at a moment [N m] by the points of a bending law (curvature, moment).
fn law_curvature(points: &[[f64; 2]], moment: f64) -> f64 {
    let above = points.partition_point(|point| point[1] < moment);
    let [a, b] = {
        let upper = above.clamp(1, points.len() - 1);
        [points[upper - 1], points[upper]]
    };
    a[0] + (moment - a[1]) * (b[0] - a[0]) / (b[1] - a[1])
}

fn split(v: &Vector3, axis: &Vector3) -> (f64, f64) {
    let along = axis.dot(v);
    (along, (v - axis * along).norm())
}

/// Results at the elements' meeting point, `shift` before the point where the connector acts, with
/// the elastic moment.
fn beam_node(pair: &EvaluatedPair, shift: f64, axis: &Vector3) -> (NodeResult, Vector3) {
    let PairState::Beam(state) = &pair.state else {
        return Default::default();
    };
    let force = state.elastic.force + state.damping.force;
    let arm = state.axis * shift;
    let moment = state.elastic.moment + state.damping.moment + arm.cross(&force);
    let (tension, shear) = split(&force, axis);
    let (torque, bend_moment) = split(&moment, axis);
    let node = NodeResult {
        position: (pair.first.point + pair.second.point) * 0.5 - arm,
        axis: *axis,
        tension,
        shear,
        bend_moment,
        torque,
        curvature: 0.0,
    };
    (node, state.elastic.moment + arm.cross(&state.elastic.force))
}

fn joint_node(pair: &EvaluatedPair, at_a: bool, axis: &Vector3) -> (NodeResult, Vector3) {
    let PairState::Joint(state) = &pair.state else {
        return Default::default();
    };
    // The gap points from the element's end to the support: forward at end B, backward at end A.
    let (along, shear) = split(&(state.elastic + state.damping), axis);
    let (torque, bend_moment) = split(&state.moment, axis);
    let node = NodeResult {
        position: pair.first.point,
        axis: *axis,
        tension: if at_a { -along } else { along },
        shear,
        bend_moment,
        torque: if at_a { torque } else { -torque },
        curvature: 0.0,
    };
    (node, if at_a { state.moment } else { -state.moment })
}
