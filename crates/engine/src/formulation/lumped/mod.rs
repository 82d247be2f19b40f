//! The lumped-mass method: nodes carry the mass of the half elements beside them, elements are
//! springs, bending acts over three nodes (`element`). There is no torsion.

mod arrangement;
mod assembly;
mod bodies;
pub mod element;
mod ends;
mod evaluation;
mod limits;
mod load_lanes;
mod loads;
mod nodes;
mod refusals;

use std::ops::Range;
use std::sync::Arc;

use catenix_model::{EndConnection, FormulationKind, Joint, Line, LineEnd, LineType, Model};
use catenix_numerics::{Configuration, Matrix3, MotionState, Vector3, Vector6};

use super::{Evaluation, Family, Formulation, Lines, Plan, Situation, Spot};
use crate::hydro::morison::DragCoefficients;
use crate::system::shape::line_points;
use crate::system::{Carrier, Frame, FrameOwner, LineLayout, SystemError};
use arrangement::Arrangement;
use element::bend::BendStiffness;
use element::guide::Guide;
use element::spring::Spring;
use ends::{Held, Tie};
use evaluation::LumpedEvaluation;
use loads::NodeProperties;

/// Stiffness of the spring that ties an end to its support where the end is a point of the state,
/// over that of the element.
const TIE: f64 = 1e3;

/// All lines of a model.
#[derive(Debug, Clone)]
struct Lumped {
    lines: Vec<LumpedLine>,
    /// Spring of each element of all lines (n_elements).
    springs: Vec<Spring>,
    /// Bending at each node of all lines; `None` at ends, and where there is none (n_nodes).
    bends: Vec<Option<BendStiffness>>,
    /// Mass, weight and coefficients of each node of all lines (n_nodes).
    nodes: Vec<NodeProperties>,
    /// Stiffness of the points that are not used [N/m]: that of the stiffest spring.
    idle_stiffness: f64,
}

/// Where the parts of a line are.
#[derive(Debug, Clone)]
struct LumpedLine {
    /// First block in the state.
    first_block: usize,
    arrangement: Arrangement,
    /// Elements among the springs.
    springs: Range<usize>,
    /// Nodes among the nodes.
    nodes: Range<usize>,
    ends: [Option<Held>; 2],
}

impl LumpedLine {
    fn elements(&self) -> usize {
        self.springs.len()
    }

    /// The node of an end (0 or 1).
    fn end_node(&self, end: usize) -> usize {
        if end == 0 { 0 } else { self.elements() }
    }

    /// Block and half of a node that is a point of the state.
    #[inline]
    fn slot(&self, node: usize) -> Option<(usize, usize)> {
        let slot = self.arrangement.slot(node)?;
        Some((self.first_block + slot.block, slot.half))
    }

    /// The support that a node sits on, if it is no point of the state.
    #[inline]
    fn seat(&self, node: usize) -> Option<&Held> {
        let end = usize::from(node > 0);
        self.ends[end]
            .as_ref()
            .filter(|held| held.tie.is_none() && node == self.end_node(end))
    }
}

/// Whether any part of a line resists bending.
fn bends(model: &Model, line: &Line) -> bool {
    line.sections
        .iter()
        .any(|section| model.line_types[section.line_type].bending_stiffness[0] > 0.0)
}

fn arrange(model: &Model, line: &Line, elements: usize) -> Result<Arrangement, SystemError> {
    let arranged = Arrangement::new(line, elements, bends(model, line));
    arranged.ok_or_else(|| SystemError::Unusable {
        owner: format!("line '{}'", line.name),
        what: "lumped mass cannot hold a line by fixed joints that slide on bodies at both ends \
               with an even number of elements; give it one element more"
            .to_owned(),
    })
}

/// Its entry in the registry.
pub(super) const FAMILY: Family = Family {
    kind: FormulationKind::Lumped,
    frame_count,
    build,
};

/// Two nodes per block.
fn frame_count(model: &Model, line: &Line, layout: &LineLayout) -> usize {
    // A line that cannot be arranged is refused when it is built.
    arrange(model, line, layout.element_count).map_or(1, |own| own.block_count())
}

/// Builds points and springs.
fn build(plan: &Plan<'_>) -> Result<Lines, SystemError> {
    let model = plan.model;
    refusals::check(model)?;
    let mut lumped = Lumped {
        lines: Vec::new(),
        springs: Vec::new(),
        bends: Vec::new(),
        nodes: Vec::new(),
        idle_stiffness: 0.0,
    };
    let mut frames = Vec::new();
    let mut shape = Configuration::default();
    for (line, layout) in model.lines.iter().zip(plan.layouts) {
        let own = lumped.add_line(plan, line, layout)?;
        let points = line_points(model, line, layout, plan.supports);
        own.lay(&points, &mut shape);
        frames.extend(own.frames(&lumped.nodes, layout));
        lumped.lines.push(own);
    }
    let stiffnesses = lumped.springs.iter().map(|spring| spring.stiffness);
    lumped.idle_stiffness = stiffnesses.fold(1.0, f64::max);
    Ok(Lines {
        frames,
        shape,
        formulation: Arc::new(lumped),
    })
}

impl Lumped {
    fn add_line(
        &mut self,
        plan: &Plan<'_>,
        line: &Line,
        layout: &LineLayout,
    ) -> Result<LumpedLine, SystemError> {
        let model = plan.model;
        let n = layout.element_count;
        let (first_spring, first_node) = (self.springs.len(), self.nodes.len());
        let line_type = |element: usize| &model.line_types[layout.element_types[element]];
        let (water, gravity) = (model.environment.fluid_density(), model.environment.gravity);
        self.nodes
            .resize(first_node + n + 1, NodeProperties::default());
        for element in 0..n {
            let (own, length) = (line_type(element), layout.length(element));
            if !(own.axial_stiffness.is_finite() && own.axial_stiffness > 0.0) {
                return Err(SystemError::Unusable {
                    owner: format!("line '{}'", line.name),
                    what: format!(
                        "the axial stiffness of '{}' is not a positive number; give it one",
                        own.name
                    ),
                });
            }
            self.springs.push(Spring {
                rest: length,
                stiffness: own.axial_stiffness / length,
                law: own.axial_law.clone(),
                damping: own.structural_damping,
            });
            for node in [element, element + 1] {
                self.nodes[first_node + node].add_half(own, length, water, gravity);
            }
        }
        for node in 0..=n {
            self.bends.push(if node == 0 || node == n {
                None
            } else {
                let side = |element: usize| (line_type(element), layout.length(element));
                bend_between(side(node - 1), side(node))
            });
        }
        let arrangement = arrange(model, line, n)?;
        let hold = |end: usize| match &line.ends[end] {
            LineEnd::Free => None,
            LineEnd::Connected(connection) => {
                let element = if end == 0 { 0 } else { n - 1 };
                let outermost = (line_type(element), layout.length(element));
                let support = plan.supports.get(connection.to);
                let tied = arrangement.tied[end];
                Some(held(connection, outermost, support.carrier, tied))
            }
        };
        Ok(LumpedLine {
            first_block: layout.first_frame,
            ends: [hold(0), hold(1)],
            arrangement,
            springs: first_spring..first_spring + n,
            nodes: first_node..first_node + n + 1,
        })
    }
}

/// Bending stiffness between two elements: their halves in series.
///
/// Source: docs/theory/lumped.md, eq. (7).
fn bend_between(a: (&LineType, f64), b: (&LineType, f64)) -> Option<BendStiffness> {
    let [x, y] = [a, b].map(|(line_type, length)| {
        let stiffness = line_type.bending_stiffness[0];
        (stiffness > 0.0).then(|| 0.5 * length / stiffness)
    });
    let compliance = x? + y?;
    Some(match &a.0.bending_law {
        None => BendStiffness::Linear(1.0 / compliance),
        Some(points) => BendStiffness::Law {
            points: points.clone(),
            length: 0.5 * (a.1 + b.1),
        },
    })
}

/// How a connection holds the end of a line.
///
/// Source: docs/theory/lumped.md, eqs. (14) and (23).
fn held(
    connection: &EndConnection,
    (line_type, length): (&LineType, f64),
    carrier: Carrier,
    tied: bool,
) -> Held {
    let half = 2.0 * line_type.bending_stiffness[0] / length;
    let direction = Vector3::from(connection.direction_local);
    let guide = match connection.joint {
        _ if half <= 0.0 => None,
        Joint::Fixed => {
            let stiffness = match &line_type.bending_law {
                None => BendStiffness::Linear(half),
                Some(points) => BendStiffness::Law {
                    points: points.clone(),
                    length: 0.5 * length,
                },
            };
            Some((direction, Guide::Along(stiffness)))
        }
        Joint::Ball {
            rotational_stiffness: joint,
        } if joint > 0.0 => {
            let both = 1.0 / (1.0 / joint + 1.0 / half);
            Some((direction, Guide::Along(BendStiffness::Linear(both))))
        }
        Joint::Hinge { axis_local } => Some((Vector3::from(axis_local), Guide::Across(half))),
        Joint::Ball { .. } | Joint::Universal { .. } => None,
    };
    Held {
        carrier,
        arm: Vector3::from(connection.point_local),
        guide,
        tie: tied.then(|| Tie {
            stiffness: TIE * line_type.axial_stiffness / length,
            slides_along: connection.slides_along.map(Vector3::from),
        }),
    }
}

impl LumpedLine {
    /// Lays the points of the state on those of the first shape.
    fn lay(&self, points: &[Vector3], shape: &mut Configuration) {
        let blocks = self.arrangement.block_count();
        // Idle points have a place too, which means nothing.
        let mut own = vec![[points[0]; 2]; blocks];
        for node in self.arrangement.points.clone() {
            if let Some(slot) = self.arrangement.slot(node) {
                own[slot.block][slot.half] = points[node];
            }
        }
        for [first, second] in own {
            shape.position.push(first);
            shape.second.push(second);
            shape.rotation.push(Matrix3::identity());
        }
    }

    /// What the rest of the program asks of frames, for the blocks of this line; the loads of a
    /// node on a support count with the block beside it.
    fn frames<'s>(
        &'s self,
        nodes: &'s [NodeProperties],
        layout: &'s LineLayout,
    ) -> impl Iterator<Item = Frame> + 's {
        let own = &nodes[self.nodes.clone()];
        let blocks = self.arrangement.block_count();
        let block_of = move |node: usize| match self.arrangement.slot(node) {
            Some(slot) => slot.block,
            None if node == 0 => 0,
            None => blocks - 1,
        };
        let mut first = 0;
        (0..blocks).map(move |block| {
            // Nodes stand in the order of their blocks.
            let mut last = first;
            while last < own.len() && block_of(last) == block {
                last += 1;
            }
            let members = &own[first..last];
            let sum =
                |value: fn(&NodeProperties) -> f64| -> f64 { members.iter().map(value).sum() };
            let mass = sum(|node| node.mass);
            let length = layout.length(first.min(layout.element_count - 1));
            first = last;
            Frame {
                axis: Vector3::x(),
                length,
                diameter: members[0].diameter,
                mass,
                // Of no use to points; as of a rod with its mass at its ends.
                inertia: Vector3::repeat(0.25 * mass * length * length),
                drag: DragCoefficients::default(),
                added_normal: 0.0,
                added_axial: 0.0,
                added_inertia: 0.0,
                weight: sum(|node| node.weight),
                buoyancy: sum(|node| node.buoyancy),
                buoyancy_arm: Vector3::zeros(),
                seabed_length: 0.0,
                residual_length: length,
            }
        })
    }

    /// From the origins of the two supports to the ends of the line (2) [m].
    fn arms(&self, at: &Situation<'_>) -> [Vector3; 2] {
        let arm = |held: &Option<Held>| {
            held.as_ref()
                .map_or_else(Vector3::zeros, |h| h.seat(at).arm)
        };
        [arm(&self.ends[0]), arm(&self.ends[1])]
    }

    /// First-order move of a node; `arms` are those of [`Self::arms`].
    fn node_move(&self, arms: &[Vector3; 2], increment: &[Vector6], node: usize) -> Vector3 {
        if let Some((block, half)) = self.slot(node) {
            return increment[block].fixed_rows::<3>(3 * half).into();
        }
        match self.seat(node).map(|held| held.carrier) {
            Some(Carrier::Free(body)) => {
                let turn: Vector3 = increment[body].fixed_rows::<3>(3).into();
                increment[body].fixed_rows::<3>(0) + turn.cross(&arms[usize::from(node > 0)])
            }
            _ => Vector3::zeros(),
        }
    }
}

impl Formulation for Lumped {
    fn evaluation(self: Arc<Self>, at: &Situation<'_>) -> Box<dyn Evaluation> {
        Box::new(LumpedEvaluation::new(self, at))
    }

    /// The two nodes beside the arc length, by the rule of the lever.
    ///
    /// What sits at an end that a vessel holds is carried by the vessel, and has no spot.
    fn spots(&self, layout: &LineLayout, arc_length: f64) -> Vec<Spot> {
        let own = self
            .lines
            .iter()
            .find(|line| line.first_block == layout.first_frame);
        let Some(line) = own else { return Vec::new() };
        let total = layout.arc_length[layout.element_count];
        let at = arc_length.clamp(0.0, total);
        let after = layout.arc_length.partition_point(|&s| s <= at);
        let element = after.saturating_sub(1).min(layout.element_count - 1);
        let share = (at - layout.arc_length[element]) / layout.length(element);
        let spot = |(node, share): (usize, f64)| {
            if share < 1e-9 {
                return None;
            }
            if let Some((frame, half)) = line.slot(node) {
                return Some(Spot {
                    frame,
                    half,
                    arm: Vector3::zeros(),
                    share,
                });
            }
            let held = line.seat(node)?;
            match held.carrier {
                Carrier::Free(frame) => Some(Spot {
                    frame,
                    half: 0,
                    arm: held.arm,
                    share,
                }),
                Carrier::Vessel(_) => None,
            }
        };
        let both = [(element, 1.0 - share), (element + 1, share)];
        both.into_iter().filter_map(spot).collect()
    }

    fn owner(&self, line: &Line, layout: &LineLayout, index: usize) -> FrameOwner {
        let own = self
            .lines
            .iter()
            .find(|line| line.first_block == layout.first_frame);
        let first = own.and_then(|own| {
            let in_block =
                |&node: &usize| own.arrangement.slot(node).is_some_and(|s| s.block == index);
            own.arrangement.points.clone().find(in_block)
        });
        let node = first.unwrap_or(0);
        FrameOwner::Element {
            line: line.name.clone(),
            number: (node + 1).min(layout.element_count),
            arc_length_m: layout.arc_length[node],
        }
    }

    fn stiffest(&self) -> f64 {
        let springs = self.springs.iter().map(|spring| spring.stiffness);
        let held = self
            .lines
            .iter()
            .flat_map(|line| line.ends.iter().flatten());
        let ties = held.filter_map(|held| Some(held.tie.as_ref()?.stiffness));
        // An angle is the difference of points over a length: round-off meets 4 k / l^2.
        let bending = self.lines.iter().flat_map(|line| {
            (1..line.elements()).map(|node| {
                let bend = self.bends[line.nodes.start + node].as_ref();
                let rests = [node - 1, node].map(|e| self.springs[line.springs.start + e].rest);
                let length = rests[0].min(rests[1]);
                4.0 * bend.map_or(0.0, BendStiffness::initial) / (length * length)
            })
        });
        springs.chain(ties).chain(bending).fold(0.0, f64::max)
    }

    fn stiffest_over(&self, frames: &[Arc<Frame>], softness: &dyn Fn(&Frame) -> f64) -> f64 {
        let each = self.lines.iter().flat_map(|line| {
            (0..line.elements()).map(|element| {
                let blocks = [element, element + 1].map(|node| line.slot(node));
                let softest = blocks.into_iter().flatten();
                let softest = softest.map(|(block, _)| softness(&frames[block]));
                self.springs[line.springs.start + element].stiffness * softest.fold(0.0, f64::max)
            })
        });
        each.fold(0.0, f64::max)
    }

    /// The largest angle by which an element turns.
    fn largest_turn(&self, increment: &[Vector6]) -> f64 {
        let mut largest = 0.0f64;
        // The turn of a body has its own limit, so that the arms to the ends can stay out.
        let arms = [Vector3::zeros(); 2];
        for line in &self.lines {
            let mut before = line.node_move(&arms, increment, 0);
            for element in 0..line.elements() {
                let after = line.node_move(&arms, increment, element + 1);
                let rest = self.springs[line.springs.start + element].rest;
                let turn = (after - before).norm() / rest;
                // A number that is none must not hide behind a comparison.
                if turn > largest || turn.is_nan() {
                    largest = turn;
                }
                before = after;
            }
        }
        largest
    }

    fn has_mass_of_blocks(&self) -> bool {
        true
    }

    fn axis(&self, state: &MotionState, block: usize) -> Vector3 {
        let line = self.lines.iter().rfind(|line| line.first_block <= block);
        let towards = line.and_then(|line| {
            let points = &line.arrangement.points;
            let here = points
                .clone()
                .find(|&node| line.slot(node).is_some_and(|s| s.0 == block))?;
            // Its own second point, or the point before.
            let pair = if here + 1 < points.end {
                [here, here + 1]
            } else {
                [here.checked_sub(1)?, here]
            };
            let [a, b] = pair.map(|node| line.slot(node));
            let [(a, p), (b, q)] = [a?, b?];
            let configuration = &state.configuration;
            (configuration.point(b, q) - configuration.point(a, p)).try_normalize(0.0)
        });
        towards.unwrap_or_else(Vector3::x)
    }
}
