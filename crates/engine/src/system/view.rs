//! Results read off a state: channels and quantities along lines.

use catenix_model::{Axis, ChannelTarget, LineQuantity};
use catenix_numerics::{MotionState, Vector3, Vector6, so3};

use super::solver::SystemSolver;
use crate::formulation::{NodeResult, Situation};

/// A state as results see it. Valid for the state that was assembled last.
pub struct StepView<'a> {
    pub(crate) solver: &'a SystemSolver<'a>,
    pub(crate) state: &'a MotionState,
    pub(crate) time: f64,
    pub(crate) step: f64,
    pub(crate) at_output_time: bool,
    pub(crate) at_field_time: bool,
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
        self.channel_with(target, &mut Ends::default())
    }

    /// Values of several channels. What channels of one end have in common is computed once where
    /// they follow one another.
    pub fn channels(&self, targets: impl Iterator<Item = ChannelTarget>, out: &mut [f64]) {
        let mut ends = Ends::default();
        for (value, target) in out.iter_mut().zip(targets) {
            *value = self.channel_with(target, &mut ends);
        }
    }

    fn channel_with(&self, target: ChannelTarget, ends: &mut Ends) -> f64 {
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
                &ends.load(self, line, end).fixed_rows::<3>(0).into_owned(),
                axis,
            ),
            ChannelTarget::EndMoment(line, end, axis) => pick(
                &ends.load(self, line, end).fixed_rows::<3>(3).into_owned(),
                axis,
            ),
            ChannelTarget::EndTension(line, end) => ends.node(self, line, end).tension,
            ChannelTarget::EndDeclination(line, end) => {
                angle_between(&ends.node(self, line, end).axis, &-Vector3::z())
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
        self.solver.lines.nodes(&self.situation(), line, out);
        self.solver.system.walls[line].finish(nodes, out);
    }

    /// Smallest and largest effective tension along a line [N].
    pub fn tension_range(&self, line: usize) -> (f64, f64) {
        let tensions = self.tensions(line).into_iter();
        tensions.fold(
            (f64::INFINITY, f64::NEG_INFINITY),
            |(low, high), tension| (low.min(tension), high.max(tension)),
        )
    }

    /// Effective tension at the nodes of a line (n_elements + 1) [N].
    pub(crate) fn tensions(&self, line: usize) -> Vec<f64> {
        let nodes = 0..self.solver.system.lines[line].arc_length.len();
        nodes.map(|node| self.node(line, node).tension).collect()
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
        self.solver.lines.end_load(&self.situation(), line, end)
    }

    fn node(&self, line: usize, node: usize) -> NodeResult {
        self.solver.lines.node(&self.situation(), line, node)
    }

    fn situation(&self) -> Situation<'_> {
        self.solver.situation(self.time, self.state)
    }

    /// What [`Self::line_quantities`] writes at one node.
    pub(super) fn quantities(&self, line: usize, node: usize) -> [f64; 11] {
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
                // A formulation without torsion has no stress by it.
                if result.torque.is_nan() {
                    0.0
                } else {
                    result.torque
                },
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

/// What was last computed at an end of a line: which line and end, and what.
#[derive(Default)]
struct Ends {
    load: Option<([usize; 2], Vector6)>,
    node: Option<([usize; 2], NodeResult)>,
}

impl Ends {
    fn load(&mut self, view: &StepView<'_>, line: usize, end: usize) -> Vector6 {
        match self.load {
            Some((of, load)) if of == [line, end] => load,
            _ => {
                let load = view.end_load(line, end);
                self.load = Some(([line, end], load));
                load
            }
        }
    }

    fn node(&mut self, view: &StepView<'_>, line: usize, end: usize) -> NodeResult {
        match self.node {
            Some((of, node)) if of == [line, end] => node,
            _ => {
                let node = view.node(line, view.end_node(line, end));
                self.node = Some(([line, end], node));
                node
            }
        }
    }
}

fn pick(v: &Vector3, axis: Axis) -> f64 {
    v[axis as usize]
}

/// Angle between two vectors [deg].
fn angle_between(a: &Vector3, b: &Vector3) -> f64 {
    a.cross(b).norm().atan2(a.dot(b)).to_degrees()
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
            largest = largest.max(0.5 * sum + 3.0 * shear * shear);
        }
    }
    largest.sqrt()
}
