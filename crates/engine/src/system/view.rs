//! Results read off a state: channels and quantities along lines.

use catenix_model::{Axis, ChannelTarget, LineQuantity};
use catenix_numerics::{MotionState, Vector3, Vector6, so3};

use super::ConnectorLaw;
use super::assembly::{EvaluatedPair, PairState};
use super::solver::SystemSolver;

/// A state as results see it. Valid for the state that was assembled last.
pub struct StepView<'a> {
    pub(crate) solver: &'a SystemSolver<'a>,
    pub(crate) state: &'a MotionState,
    pub(crate) time: f64,
    pub(crate) step: f64,
    pub(crate) at_output_time: bool,
    pub(crate) at_field_time: bool,
}

/// Local result at a node of a line.
#[derive(Debug, Clone, Copy, Default)]
struct NodeResult {
    position: Vector3,
    axis: Vector3,
    tension: f64,
    shear: f64,
    bend_moment: f64,
    torque: f64,
    curvature: f64,
    /// Elastic moment, signed as bend towards end B (3) [N m].
    elastic_moment: Vector3,
}

impl StepView<'_> {
    /// Time [s].
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Size of the step that led here [s]; 0 at the start.
    pub fn step(&self) -> f64 {
        self.step
    }

    /// Whether time histories are due.
    pub fn at_output_time(&self) -> bool {
        self.at_output_time
    }

    /// Whether line fields are due.
    pub fn at_field_time(&self) -> bool {
        self.at_field_time
    }

    /// Value of a channel, in the channel's unit. NaN where there is nothing to read.
    pub fn channel(&self, target: ChannelTarget) -> f64 {
        match target {
            ChannelTarget::BodyPosition(body, axis) => pick(&self.body_position(body), axis),
            ChannelTarget::BodyOffset(body, axis) => {
                let model = &self.solver.system.model;
                model.bodies[body].offset_vessel.map_or(f64::NAN, |vessel| {
                    let offset = self.body_position(body) - self.solver.vessels[vessel].position;
                    pick(&offset, axis)
                })
            }
            ChannelTarget::BodyTilt(body) => {
                let frame = self.solver.system.body_frame(body);
                let axis = self.state.configuration.rotation[frame]
                    .column(2)
                    .into_owned();
                angle_between(&axis, &Vector3::z())
            }
            ChannelTarget::BodyAngle(body, angle) => {
                let frame = self.solver.system.body_frame(body);
                let rotation = &self.state.configuration.rotation[frame];
                so3::angles(rotation)[angle as usize].to_degrees()
            }
            ChannelTarget::VesselAngle(vessel, angle) => {
                so3::angles(&self.solver.vessels[vessel].rotation)[angle as usize].to_degrees()
            }
            ChannelTarget::VesselPosition(vessel, axis) => {
                pick(&self.solver.vessels[vessel].position, axis)
            }
            ChannelTarget::EndForce(line, end, axis) => pick(
                &self.end_load(line, end).fixed_rows::<3>(0).into_owned(),
                axis,
            ),
            ChannelTarget::EndMoment(line, end, axis) => pick(
                &self.end_load(line, end).fixed_rows::<3>(3).into_owned(),
                axis,
            ),
            ChannelTarget::EndTension(line, end) => {
                self.node(line, self.end_node(line, end)).tension
            }
            ChannelTarget::EndDeclination(line, end) => {
                let node = self.node(line, self.end_node(line, end));
                angle_between(&node.axis, &-Vector3::z())
            }
            ChannelTarget::LinePoint(line, quantity, arc_length) => {
                self.line_point(line, quantity, arc_length)
            }
        }
    }

    /// All quantities along a line: one row per [`LineQuantity::ALL`], one column per node,
    /// row-major, (11 x (n_elements + 1)).
    ///
    /// # Panics
    /// When `out` has another length.
    pub fn line_quantities(&self, line: usize, out: &mut [f64]) {
        let nodes = self.solver.system.lines[line].arc_length.len();
        assert_eq!(
            out.len(),
            nodes * LineQuantity::ALL.len(),
            "one value per quantity and node"
        );
        for node in 0..nodes {
            for (row, value) in self.quantities(line, node).into_iter().enumerate() {
                out[row * nodes + node] = value;
            }
        }
    }

    /// Smallest and largest effective tension along a line [N].
    pub fn tension_range(&self, line: usize) -> (f64, f64) {
        let nodes = self.solver.system.lines[line].arc_length.len();
        (0..nodes).map(|node| self.node(line, node).tension).fold(
            (f64::INFINITY, f64::NEG_INFINITY),
            |(low, high), tension| (low.min(tension), high.max(tension)),
        )
    }

    /// A quantity between the nodes of a line.
    fn line_point(&self, line: usize, quantity: LineQuantity, arc_length: f64) -> f64 {
        let nodes = &self.solver.system.lines[line].arc_length;
        let after = nodes.partition_point(|&node| node < arc_length);
        let after = after.clamp(1, nodes.len() - 1);
        let share = (arc_length - nodes[after - 1]) / (nodes[after] - nodes[after - 1]);
        // At a node the neighbour stays out, which may have no value.
        match share {
            _ if share < 1e-9 => self.quantities(line, after - 1)[quantity.index()],
            _ if share > 1.0 - 1e-9 => self.quantities(line, after)[quantity.index()],
            _ => {
                let [a, b] = [after - 1, after].map(|k| self.quantities(line, k)[quantity.index()]);
                a + (b - a) * share
            }
        }
    }

    fn body_position(&self, body: usize) -> Vector3 {
        self.state.configuration.position[self.solver.system.body_frame(body)]
    }

    fn end_node(&self, line: usize, end: usize) -> usize {
        if end == 0 {
            0
        } else {
            self.solver.system.lines[line].element_count
        }
    }

    /// Force and moment (about the connection point) of a line on what its end is connected to.
    fn end_load(&self, line: usize, end: usize) -> Vector6 {
        let system = self.solver.system;
        let Some(index) = system.lines[line].nodes[self.end_node(line, end)] else {
            return Vector6::zeros();
        };
        let (connector, pair) = (&system.connectors[index], &self.solver.pairs[index]);
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
        crate::element::dem::pair::six(&force, &(moment - arm.cross(&force)))
    }

    fn node(&self, line: usize, node: usize) -> NodeResult {
        let system = self.solver.system;
        let layout = &system.lines[line];
        let element = layout.first_frame + node.min(layout.element_count - 1);
        let Some(index) = layout.nodes[node] else {
            return self.free_end(line, node);
        };
        let pair = &self.solver.pairs[index];
        let shift = system.connectors[index].law.shift();
        let mut result = match &pair.state {
            PairState::Beam(state) => {
                let axis = match node {
                    // A clamp holds the direction of the line.
                    0 => pair.first.rotation.column(0).into(),
                    _ if node == layout.element_count => pair.second.rotation.column(0).into(),
                    _ => state.axis,
                };
                beam_node(pair, shift, &axis)
            }
            PairState::Joint(_) => joint_node(pair, node == 0, &self.end_axis(line, node)),
        };
        let last = layout.element_count - 1;
        let sides = [node.saturating_sub(1), node.min(last)];
        if system.connectors[index].law.stiffness().general.is_some() {
            let of_side = |&k: &usize| self.section_curvature(line, k, pair, &result);
            result.curvature = sides.iter().map(of_side).fold(0.0, f64::max);
            return result;
        }
        let stiffness = |k: usize| system.element_type(line, k).bending_stiffness[0];
        // Where the stiffness jumps, the more flexible side has the larger curvature.
        let bending = stiffness(sides[0]).min(stiffness(sides[1]));
        if bending > 0.0 {
            result.curvature = result.bend_moment / bending;
        } else {
            let first: Vector3 = pair.first.rotation.column(0).into();
            let second: Vector3 = pair.second.rotation.column(0).into();
            let length = system.frames[element].length;
            result.curvature = angle_between(&first, &second).to_radians() / length;
        }
        result
    }

    /// Curvature of the section of an element beside a connector: the natural one, and what the
    /// moment adds by the section's law.
    ///
    /// Source: docs/theory/sections.md, eq. (17).
    fn section_curvature(
        &self,
        line: usize,
        element: usize,
        pair: &EvaluatedPair,
        node: &NodeResult,
    ) -> f64 {
        let system = self.solver.system;
        let line_type = system.element_type(line, element);
        let elastic = &node.elastic_moment;
        let across = elastic - node.axis * node.axis.dot(elastic);
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
        let natural = system.lines[line].natural[element].curvature;
        (natural[0] + by_moment[0]).hypot(natural[1] + by_moment[1])
    }

    /// A free end carries nothing.
    fn free_end(&self, line: usize, node: usize) -> NodeResult {
        let layout = &self.solver.system.lines[line];
        let at_b = node > 0;
        let frame = layout.first_frame + if at_b { node - 1 } else { 0 };
        let element_axis: Vector3 = self.state.configuration.rotation[frame].column(0).into();
        let half = self.solver.system.frames[frame].length * if at_b { 0.5 } else { -0.5 };
        NodeResult {
            position: self.state.configuration.position[frame] + element_axis * half,
            axis: self.end_axis(line, node),
            curvature: {
                let [y, z] = layout.natural[frame - layout.first_frame].curvature;
                y.hypot(z)
            },
            ..NodeResult::default()
        }
    }

    /// Axis of a line at its very end, extrapolated from the two elements there.
    ///
    /// Source: docs/theory/results.md, eq. (10).
    fn end_axis(&self, line: usize, node: usize) -> Vector3 {
        let system = self.solver.system;
        let layout = &system.lines[line];
        let (end, next) = if node == 0 {
            (0, 1)
        } else {
            (
                layout.element_count - 1,
                layout.element_count.saturating_sub(2),
            )
        };
        let axis = |element: usize| -> Vector3 {
            let frame = layout.first_frame + element;
            self.state.configuration.rotation[frame].column(0).into()
        };
        if layout.element_count < 2 {
            return axis(end);
        }
        let length = |element: usize| system.frames[layout.first_frame + element].length;
        let ahead = length(end) / (length(end) + length(next));
        (axis(end) + (axis(end) - axis(next)) * ahead).normalize()
    }

    fn quantities(&self, line: usize, node: usize) -> [f64; 11] {
        let system = self.solver.system;
        let result = self.node(line, node);
        let environment = &system.model.environment;
        // Without water there is no surface from which pressures could be reckoned.
        let depth = match environment.water {
            Some(_) => (-result.position.z).max(0.0),
            None => 0.0,
        };
        let last = system.lines[line].element_count - 1;
        let line_type = system.element_type(line, node.min(last));
        let outer = environment.fluid_density() * environment.gravity * depth;
        let inner = line_type.content_density * environment.gravity * depth;
        let area = |diameter: f64| 0.25 * std::f64::consts::PI * diameter * diameter;
        // Source: docs/theory/results.md, eq. (1).
        let wall_tension = result.tension + inner * area(line_type.inner_diameter)
            - outer * area(line_type.outer_diameter);
        let stress = line_type.wall.map_or(f64::NAN, |wall| {
            von_mises(
                [wall.outer_diameter, wall.inner_diameter],
                [outer, inner],
                wall_tension,
                result.bend_moment,
                result.torque,
            )
        });
        [
            result.position.x,
            result.position.y,
            result.position.z,
            result.tension,
            wall_tension,
            result.shear,
            result.bend_moment,
            result.curvature,
            result.torque,
            stress,
            angle_between(&result.axis, &-Vector3::z()),
        ]
    }
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

fn pick(v: &Vector3, axis: Axis) -> f64 {
    v[axis as usize]
}

/// Angle between two vectors [deg].
fn angle_between(a: &Vector3, b: &Vector3) -> f64 {
    a.cross(b).norm().atan2(a.dot(b)).to_degrees()
}

fn split(v: &Vector3, axis: &Vector3) -> (f64, f64) {
    let along = axis.dot(v);
    (along, (v - axis * along).norm())
}

/// Results at the elements' meeting point, `shift` before the point where the connector acts.
fn beam_node(pair: &EvaluatedPair, shift: f64, axis: &Vector3) -> NodeResult {
    let PairState::Beam(state) = &pair.state else {
        return NodeResult::default();
    };
    let force = state.elastic.force + state.damping.force;
    let arm = state.axis * shift;
    let moment = state.elastic.moment + state.damping.moment + arm.cross(&force);
    let (tension, shear) = split(&force, axis);
    let (torque, bend_moment) = split(&moment, axis);
    NodeResult {
        position: (pair.first.point + pair.second.point) * 0.5 - arm,
        axis: *axis,
        tension,
        shear,
        bend_moment,
        torque,
        curvature: 0.0,
        elastic_moment: state.elastic.moment + arm.cross(&state.elastic.force),
    }
}

fn joint_node(pair: &EvaluatedPair, at_a: bool, axis: &Vector3) -> NodeResult {
    let PairState::Joint(state) = &pair.state else {
        return NodeResult::default();
    };
    // The gap points from the element's end to the support: forward at end B, backward at end A.
    let (along, shear) = split(&(state.elastic + state.damping), axis);
    let (torque, bend_moment) = split(&state.moment, axis);
    NodeResult {
        position: pair.first.point,
        axis: *axis,
        tension: if at_a { -along } else { along },
        shear,
        bend_moment,
        torque: if at_a { torque } else { -torque },
        curvature: 0.0,
        elastic_moment: if at_a { state.moment } else { -state.moment },
    }
}

/// Largest von Mises stress over the inner and outer fibres of a thick-walled tube.
///
/// `diameters` and `pressures` are outer, inner [m], [Pa]. Source: docs/theory/results.md, eqs. (2)
/// to (5) (Lame).
fn von_mises(
    diameters: [f64; 2],
    pressures: [f64; 2],
    wall_tension: f64,
    bend_moment: f64,
    torque: f64,
) -> f64 {
    let [ro, ri] = diameters.map(|d| 0.5 * d);
    let area = std::f64::consts::PI * (ro * ro - ri * ri);
    let second_moment = 0.25 * std::f64::consts::PI * (ro.powi(4) - ri.powi(4));
    let span = ro * ro - ri * ri;
    let [po, pi] = pressures;
    let mean = (pi * ri * ri - po * ro * ro) / span;
    let swing = (pi - po) * ri * ri * ro * ro / span;
    let mut largest = 0.0f64;
    for r in [ro, ri] {
        if r <= 0.0 {
            continue;
        }
        let (radial, hoop) = (mean - swing / (r * r), mean + swing / (r * r));
        let shear = torque * r / (2.0 * second_moment);
        for sign in [1.0, -1.0] {
            let axial = wall_tension / area + sign * bend_moment * r / second_moment;
            let sum = (axial - hoop).powi(2) + (hoop - radial).powi(2) + (radial - axial).powi(2);
            largest = largest.max((0.5 * sum + 3.0 * shear * shear).sqrt());
        }
    }
    largest
}
