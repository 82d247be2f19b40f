//! The discrete element method: every element is a rigid frame, and connectors between them carry
//! all stiffness (`element`).

pub mod element;
mod ends;
mod evaluation;
mod links;
#[cfg(test)]
mod links_tests;
mod natural;
mod node_pass;
mod nodes;
mod pairs;
mod shape;
mod slide;

use std::borrow::Cow;
use std::sync::Arc;

use catenix_model::{FormulationKind, Joint, Line, LineEnd, LineType, Model};
use catenix_numerics::{Configuration, Matrix3, Vector3};

use super::{Evaluation, Family, Formulation, Lines, Plan, Situation, Spot};
use crate::hydro::morison::DragCoefficients;
use crate::system::frame_kernel::FrameBatch;
use crate::system::{Carrier, Frame, FrameOwner, LineLayout, Mount, SystemError};
use element::joint::JointStiffness;
use element::stiffness::{ConnectorStiffness, HalfElement, rotary_share};
use ends::end_connector;
use evaluation::DemEvaluation;
use links::{LinkLaws, link_of};
use node_pass::NodeLaws;
use slide::Slide;

/// Share of an element's length within which a thing counts as sitting at the element's end; it is
/// then shared by the two neighbours.
const END_SHARE: f64 = 1e-6;

/// Where the blocks of a connector go in the matrix.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Place {
    /// Between chain frames k and k + 1.
    Link(usize),
    /// Between a chain's first frame and its head junction.
    Head(usize),
    /// Between a chain's last frame and its tail junction.
    Tail(usize),
    /// One side is prescribed.
    Grounded,
}

/// A connector of any kind.
#[derive(Debug, Clone)]
struct Connector {
    law: ConnectorLaw,
    first: Mount,
    second: Mount,
    place: Place,
    /// Along which the support's side slides freely.
    slide: Option<Slide>,
}

#[derive(Debug, Clone)]
enum ConnectorLaw {
    /// Six components; first is towards end A.
    Beam(ConnectorStiffness),
    /// First is the support, second the element.
    Joint(JointStiffness),
}

impl ConnectorLaw {
    /// Stiffness of the connector, or of the half element behind a joint.
    fn stiffness(&self) -> &ConnectorStiffness {
        match self {
            ConnectorLaw::Beam(stiffness) => stiffness,
            ConnectorLaw::Joint(joint) => &joint.half,
        }
    }

    /// 1 where a positive extension stretches the line, -1 where it compresses.
    fn forward(&self) -> f64 {
        match self {
            ConnectorLaw::Beam(_) => 1.0,
            ConnectorLaw::Joint(joint) => joint.forward,
        }
    }

    /// How far beyond the elements' meeting point, towards end B, the connector acts [m].
    fn shift(&self) -> f64 {
        match self {
            ConnectorLaw::Beam(stiffness) => stiffness.shift,
            ConnectorLaw::Joint(_) => 0.0,
        }
    }
}

/// All connectors of the lines of a model.
#[derive(Debug, Clone)]
struct Dem {
    /// Per line what is at its nodes.
    lines: Vec<LineNodes>,
    /// The links that differ from the one before, and all other connectors.
    links: Vec<Link>,
    others: Vec<Connector>,
    /// The elements, several at a time, and the links that begin at them.
    elements: Vec<FrameBatch>,
    linked: Vec<Option<Arc<LinkLaws>>>,
    /// What results need to know of these links.
    node_laws: Vec<Arc<NodeLaws>>,
    /// Whether some connectors depend on the tension that is expected at them.
    has_layers: bool,
}

/// The connectors of a line.
#[derive(Debug, Clone)]
struct LineNodes {
    first_frame: usize,
    /// At each node, end A to end B (n_elements + 1).
    nodes: Vec<Node>,
}

/// What is at a node.
#[derive(Debug, Clone, Copy)]
enum Node {
    /// Nothing: a free end.
    Free,
    /// A link between the elements that meet there: an index into [`Dem::links`].
    Link(u32),
    /// Another connector: an index into [`Dem::others`].
    Other(u32),
}

/// A connector that is computed with others of its kind: straight, round, linear, between the axes
/// of two neighbours.
#[derive(Debug, Clone, PartialEq)]
struct Link {
    law: ConnectorStiffness,
    /// Place of the connection point on the axes of the two frames (2) [m].
    levers: [f64; 2],
}

impl Link {
    /// The connector that it is between frames k and k + 1.
    fn at(&self, k: usize) -> Connector {
        let mount = |side: usize| Mount {
            carrier: Carrier::Free(k + side),
            arm: Vector3::x() * self.levers[side],
            axes: Matrix3::identity(),
        };
        Connector {
            law: ConnectorLaw::Beam(self.law.clone()),
            first: mount(0),
            second: mount(1),
            place: Place::Link(k),
            slide: None,
        }
    }
}

/// Half of an element, for the connector on one of its sides.
fn half<'a>(model: &'a Model, layout: &LineLayout, element: usize) -> HalfElement<'a> {
    HalfElement {
        line_type: &model.line_types[layout.element_types[element]],
        length: layout.length(element),
        natural: layout.natural[element],
    }
}

/// Stiffness of the connector at a node; at an end, of the half element and a clamp.
fn node_stiffness(model: &Model, layout: &LineLayout, node: usize) -> ConnectorStiffness {
    let half = |element| half(model, layout, element);
    if node == 0 {
        ConnectorStiffness::clamp(half(0), true)
    } else if node == layout.element_count {
        ConnectorStiffness::clamp(half(node - 1), false)
    } else {
        ConnectorStiffness::between(half(node - 1), half(node))
    }
}

/// Whether a lump sits at a node between two elements.
fn has_lump(line: &Line, layout: &LineLayout, node: usize) -> bool {
    let slack = END_SHARE * layout.length(node - 1).min(layout.length(node));
    let at = layout.arc_length[node];
    let mut lumps = line.attachments.iter();
    lumps.any(|attachment| (attachment.arc_length - at).abs() < slack)
}

/// Whether a line that may bend is clamped somewhere, or pulled aside by a lump between elements.
fn has_layers(plan: &Plan<'_>, index: usize) -> bool {
    let (line, layout) = (&plan.model.lines[index], &plan.layouts[index]);
    let types = line.sections.iter().map(|section| section.line_type);
    let bends = types.map(|index| plan.model.line_types[index].bending_stiffness);
    let clamped = |end: &LineEnd| match end {
        LineEnd::Connected(connection) => connection.joint == Joint::Fixed,
        LineEnd::Free => false,
    };
    bends.flatten().any(|stiffness| stiffness > 0.0)
        && (line.ends.iter().any(clamped)
            || (1..layout.element_count).any(|node| has_lump(line, layout, node)))
}

/// Its entry in the registry: one frame per element.
pub(super) const FAMILY: Family = Family {
    kind: FormulationKind::Dem,
    frame_count: |_, _, layout| layout.element_count,
    build,
};

/// Builds frames and connectors.
fn build(plan: &Plan<'_>) -> Result<Lines, SystemError> {
    let model = plan.model;
    let counts = plan.layouts.iter().map(|layout| layout.element_count);
    let mut frames = Vec::with_capacity(counts.sum());
    for layout in plan.layouts {
        for (k, &line_type) in layout.element_types.iter().enumerate() {
            let line_type = &model.line_types[line_type];
            frames.push(element_frame(model, line_type, layout.length(k)));
        }
    }
    let shape = shape::first_shape(plan);
    let mut dem = Dem {
        lines: Vec::new(),
        links: Vec::new(),
        others: Vec::new(),
        elements: FrameBatch::all(&frames, 0..frames.len()),
        linked: Vec::new(),
        node_laws: Vec::new(),
        has_layers: (0..model.lines.len()).any(|index| has_layers(plan, index)),
    };
    for index in 0..model.lines.len() {
        dem.connect(plan, index, &shape)?;
    }
    dem.linked = LinkLaws::batches(dem.all_links(), frames.len());
    dem.node_laws = NodeLaws::batches(&dem, plan);
    Ok(Lines {
        frames,
        shape,
        formulation: Arc::new(dem),
    })
}

/// Properties of one element: everything per metre times its length.
///
/// Source: docs/theory/dem.md, eq. (22), and docs/theory/hydrodynamics.md, eqs. (2) to (7).
fn element_frame(model: &Model, line_type: &LineType, length: f64) -> Frame {
    let water = model.environment.fluid_density();
    let area = 0.25 * std::f64::consts::PI * line_type.outer_diameter.powi(2);
    let displaced = water * area * length;
    let mass = line_type.mass * length;
    let radius_squared = length * length / 12.0;
    let added_normal = line_type.normal_added_mass * displaced;
    let half_flow = 0.5 * water * line_type.outer_diameter * length;
    let share = rotary_share(line_type, length);
    let normal_inertia =
        [0, 1].map(|k| mass * radius_squared * share[k] + line_type.rotary_inertia[k] * length);
    Frame {
        axis: Vector3::x(),
        length,
        diameter: line_type.outer_diameter,
        mass,
        inertia: Vector3::new(
            line_type.polar_inertia * length,
            normal_inertia[0],
            normal_inertia[1],
        ),
        drag: DragCoefficients {
            normal: line_type.normal_drag * half_flow,
            axial: line_type.axial_drag * half_flow * std::f64::consts::PI,
            radius: radius_squared.sqrt(),
        },
        added_normal,
        added_axial: line_type.axial_added_mass * displaced,
        added_inertia: added_normal * radius_squared * (0.5 * (share[0] + share[1])),
        weight: mass * model.environment.gravity,
        buoyancy: displaced * model.environment.gravity,
        buoyancy_arm: Vector3::zeros(),
        seabed_length: length,
        residual_length: length,
    }
}

/// The end of an element.
fn element_end(layout: &LineLayout, element: usize, at_b: bool) -> Mount {
    Mount {
        carrier: Carrier::Free(layout.first_frame + element),
        arm: Vector3::x() * layout.length(element) * if at_b { 0.5 } else { -0.5 },
        axes: Matrix3::identity(),
    }
}

impl Dem {
    /// Nodes of a line that are not between linked elements.
    fn nodes_apart(&self, line: usize) -> impl Iterator<Item = usize> {
        let nodes = self.lines[line].nodes.iter().enumerate();
        nodes.filter_map(|(node, place)| match place {
            Node::Link(_) => None,
            Node::Free | Node::Other(_) => Some(node),
        })
    }

    /// Adds the connectors of a line, end A to end B.
    fn connect(
        &mut self,
        plan: &Plan<'_>,
        index: usize,
        shape: &Configuration,
    ) -> Result<(), SystemError> {
        let model = plan.model;
        let (line, layout) = (&model.lines[index], &plan.layouts[index]);
        let mut nodes = vec![Node::Free; layout.element_count + 1];
        for (node, place) in nodes.iter_mut().enumerate() {
            let end = if node == 0 {
                Some(0)
            } else if node == layout.element_count {
                Some(1)
            } else {
                None
            };
            let connector = match end {
                None => {
                    let mut stiffness = node_stiffness(model, layout, node);
                    if has_lump(line, layout, node) {
                        let sides = [node - 1, node].map(|element| half(model, layout, element));
                        let tension = layout.expected_tension(node);
                        stiffness = stiffness.with_layers_at_lump(sides, tension);
                    }
                    let shift = Vector3::x() * stiffness.shift;
                    Connector {
                        law: ConnectorLaw::Beam(stiffness),
                        first: element_end(layout, node - 1, true).shifted(&shift),
                        second: element_end(layout, node, false).shifted(&shift),
                        place: Place::Link(layout.first_frame + node - 1),
                        slide: None,
                    }
                }
                Some(end) => {
                    let LineEnd::Connected(connection) = &line.ends[end] else {
                        continue;
                    };
                    let element = if end == 0 {
                        0
                    } else {
                        layout.element_count - 1
                    };
                    let rotation = shape.rotation[layout.first_frame + element];
                    let own = element_end(layout, element, end == 1);
                    end_connector(plan, index, end, connection, own, &rotation)
                }
            };
            let stiffness = connector.law.stiffness();
            let usable = stiffness.axial.is_finite() && stiffness.axial > 0.0;
            if !(usable && stiffness.shear.is_finite()) {
                return Err(SystemError::Unusable {
                    owner: format!("line '{}'", line.name),
                    what: format!(
                        "the axial stiffness at {:.3} m is not a positive number; give its line \
                         type a positive axial stiffness",
                        layout.arc_length[node]
                    ),
                });
            }
            *place = self.add(connector);
        }
        self.lines.push(LineNodes {
            first_frame: layout.first_frame,
            nodes,
        });
        Ok(())
    }

    fn add(&mut self, connector: Connector) -> Node {
        match link_of(&connector) {
            Some((_, link)) => {
                if self.links.last() != Some(&link) {
                    self.links.push(link);
                }
                Node::Link(self.links.len() as u32 - 1)
            }
            None => {
                self.others.push(connector);
                Node::Other(self.others.len() as u32 - 1)
            }
        }
    }

    /// The connector at a node of a line, if there is one.
    fn connector(&self, line: usize, node: usize) -> Option<Cow<'_, Connector>> {
        let own = &self.lines[line];
        match own.nodes[node] {
            Node::Free => None,
            Node::Link(index) => {
                // It begins at the element before the node.
                let first = own.first_frame + node - 1;
                Some(Cow::Owned(self.links[index as usize].at(first)))
            }
            Node::Other(index) => Some(Cow::Borrowed(&self.others[index as usize])),
        }
    }

    /// All connectors, line by line from end A.
    fn connectors(&self) -> impl Iterator<Item = Cow<'_, Connector>> {
        let lines = self.lines.iter().enumerate();
        lines.flat_map(move |(line, own)| {
            (0..own.nodes.len()).filter_map(move |node| self.connector(line, node))
        })
    }

    /// All links with the frames at which they begin.
    fn all_links(&self) -> impl Iterator<Item = (usize, &Link)> {
        self.lines.iter().flat_map(|own| {
            let nodes = own.nodes.iter().enumerate();
            nodes.filter_map(|(node, what)| match what {
                Node::Link(index) => {
                    Some((own.first_frame + node - 1, &self.links[*index as usize]))
                }
                _ => None,
            })
        })
    }
}

impl Formulation for Dem {
    fn evaluation(self: Arc<Self>, at: &Situation<'_>) -> Box<dyn Evaluation> {
        Box::new(DemEvaluation::new(self, at))
    }

    /// The element that holds the arc length: all of it, or a half each where two elements meet.
    fn spots(&self, layout: &LineLayout, arc_length: f64) -> Vec<Spot> {
        let spot = |element: usize, offset: f64, share: f64| Spot {
            frame: layout.first_frame + element,
            half: 0,
            arm: Vector3::x() * offset,
            share,
        };
        let total = layout.arc_length[layout.element_count];
        let at = arc_length.clamp(0.0, total);
        let after = layout.arc_length.partition_point(|&s| s <= at);
        let element = after.saturating_sub(1).min(layout.element_count - 1);
        let (start, end) = (layout.arc_length[element], layout.arc_length[element + 1]);
        let length = end - start;
        let shared = |before: usize| {
            vec![
                spot(before, 0.5 * layout.length(before), 0.5),
                spot(before + 1, -0.5 * layout.length(before + 1), 0.5),
            ]
        };
        if (at - start).abs() < END_SHARE * length && element > 0 {
            return shared(element - 1);
        }
        if (end - at).abs() < END_SHARE * length && element + 1 < layout.element_count {
            return shared(element);
        }
        vec![spot(element, at - 0.5 * (start + end), 1.0)]
    }

    fn owner(&self, line: &Line, layout: &LineLayout, index: usize) -> FrameOwner {
        FrameOwner::Element {
            line: line.name.clone(),
            number: index + 1,
            arc_length_m: 0.5 * (layout.arc_length[index] + layout.arc_length[index + 1]),
        }
    }

    fn stiffest(&self) -> f64 {
        let links = self.links.iter().map(|link| &link.law);
        let others = self.others.iter().map(|other| other.law.stiffness());
        let each = links.chain(others).map(ConnectorStiffness::stiffest);
        each.fold(0.0, f64::max)
    }

    fn has_layers(&self) -> bool {
        self.has_layers
    }

    fn stiffest_over(&self, frames: &[Arc<Frame>], softness: &dyn Fn(&Frame) -> f64) -> f64 {
        let each = self.connectors().map(|connector| {
            let softest = [connector.first.carrier, connector.second.carrier]
                .into_iter()
                .filter_map(|carrier| match carrier {
                    Carrier::Free(k) => Some(softness(&frames[k])),
                    Carrier::Vessel(_) => None,
                })
                .fold(0.0, f64::max);
            connector.law.stiffness().stiffest() * softest
        });
        each.fold(0.0, f64::max)
    }
}
