//! The finite element method: nodes with position and rotation, beam elements between them
//! (`element`), inertia and loads spread over the elements.
//!
//! A node is a frame of the state. A fixed end has no node of its own: it is a point of the vessel
//! or body that carries it. A node on a vessel through another joint is where the vessel has it, and
//! keeps its rotations; on a body, or where it slides, springs hold it.
//!
//! Source: docs/theory/fem.md.

mod assembly;
pub mod element;
mod ends;
mod evaluation;
mod kernel;
#[cfg(test)]
mod lanes_tests;
mod load;
mod load_lanes;
mod nodes;
mod shape;
mod spans;
mod turning;

use std::sync::Arc;

use catenix_model::{FormulationKind, Line, Model};
use catenix_numerics::{Configuration, Matrix3, Vector3};

use super::{Evaluation, Family, Formulation, Lines, Plan, Situation, Spot};
use crate::hydro::morison::DragCoefficients;
use crate::system::{Carrier, Frame, FrameOwner, LineLayout, Mount, SystemError};
use element::corotational::Corotational;
use element::exact::Exact;
use element::joint::JointSprings;
use element::section::ElementSection;
use evaluation::FemEvaluation;
use kernel::Kernel;
use load::Spread;

/// Where an end of an element sits.
#[derive(Debug, Clone, Copy)]
enum Seat {
    /// On a node: this frame.
    Node(usize),
    /// Where a vessel has it, with the rotation of a node: this frame.
    Hinged(usize, Mount),
    /// On a vessel or body, rigidly.
    Carried(Mount),
}

impl Seat {
    /// The frame whose increments move it.
    fn frame(&self) -> Option<usize> {
        match self {
            Seat::Node(frame) | Seat::Hinged(frame, _) => Some(*frame),
            Seat::Carried(mount) => match mount.carrier {
                Carrier::Free(frame) => Some(frame),
                Carrier::Vessel(_) => None,
            },
        }
    }
}

/// Where blocks go in the matrix.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Place {
    /// Between frames k and k + 1 of a chain.
    Link(usize),
    /// Between a chain's first frame and its head junction.
    Head(usize),
    /// Between a chain's last frame and its tail junction.
    Tail(usize),
    /// One side is prescribed.
    Grounded,
}

/// An element, but for its stiffness.
#[derive(Debug, Clone)]
struct Part {
    seats: [Seat; 2],
    place: Place,
    spread: Spread,
    /// Unstretched length [m].
    length: f64,
}

/// A joint at the end of a line.
#[derive(Debug, Clone)]
struct EndJoint {
    springs: JointSprings,
    support: Mount,
    /// Frame of the node.
    node: usize,
    place: Place,
}

/// Inertia of sections, at a node or where a body carries an end.
#[derive(Debug, Clone)]
struct Rotary {
    frame: usize,
    /// Section axes in the frame's axes.
    axes: Matrix3,
    /// About local x, y and z (3) [kg m2].
    inertia: Vector3,
}

/// A node whose place a vessel prescribes: its three translations follow idly.
#[derive(Debug, Clone)]
struct Idle {
    frame: usize,
    mount: Mount,
    /// Stiffness with which it follows [N/m].
    stiffness: f64,
    /// Mass that it has in a modal analysis [kg].
    mass: f64,
}

/// A line among the elements.
#[derive(Debug, Clone)]
struct FemLine {
    first_element: usize,
    element_count: usize,
    /// First frame; it tells lines apart.
    first_frame: usize,
    /// Joints at ends A and B.
    joints: [Option<usize>; 2],
    /// Idle nodes at ends A and B.
    idle: [Option<usize>; 2],
}

/// All elements of the lines of a model.
#[derive(Debug, Clone)]
struct Fem<K> {
    kernels: Vec<K>,
    parts: Vec<Part>,
    joints: Vec<EndJoint>,
    rotary: Vec<Rotary>,
    idle: Vec<Idle>,
    lines: Vec<FemLine>,
}

/// The entry of the corotational beam in the registry.
pub(super) const COROTATIONAL: Family = Family {
    kind: FormulationKind::Fem,
    frame_count,
    build: build::<Corotational>,
};

/// The entry of the geometrically exact beam.
pub(super) const EXACT: Family = Family {
    kind: FormulationKind::FemExact,
    frame_count,
    build: build::<Exact>,
};

/// One frame per node, but none where the end is fixed.
fn frame_count(_: &Model, line: &Line, layout: &LineLayout) -> usize {
    let carried = line.ends.iter().filter(|end| ends::is_carried(end)).count();
    (layout.element_count + 1).saturating_sub(carried)
}

/// Refuses what the elements cannot do.
fn check(model: &Model, line: &Line, layout: &LineLayout) -> Result<(), SystemError> {
    let refuse = |what: String| {
        Err(SystemError::Unusable {
            owner: format!("line '{}'", line.name),
            what,
        })
    };
    if layout.frame_count == 0 {
        return refuse(
            "its only element is fixed at both ends, so nothing can move; give it at least two \
             elements"
                .into(),
        );
    }
    for &line_type in &layout.element_types {
        let line_type = &model.line_types[line_type];
        let name = &line_type.name;
        if !(line_type.axial_stiffness.is_finite() && line_type.axial_stiffness > 0.0) {
            return refuse(format!(
                "the axial stiffness of line type '{name}' is not a positive number; give it a \
                 positive axial stiffness"
            ));
        }
        if line_type.bending_law.is_some() && line_type.shear_stiffness.is_some() {
            return refuse(format!(
                "line type '{name}' has a bending law and a shear stiffness, which finite \
                 elements do not do together; leave the shear stiffness out, or use formulation = \
                 \"dem\""
            ));
        }
    }
    Ok(())
}

/// Builds nodes and elements.
fn build<K: Kernel>(plan: &Plan<'_>) -> Result<Lines, SystemError>
where
    Fem<K>: Formulation,
{
    for (line, layout) in plan.model.lines.iter().zip(plan.layouts) {
        check(plan.model, line, layout)?;
    }
    let mut fem = Fem::<K> {
        kernels: Vec::new(),
        parts: Vec::new(),
        joints: Vec::new(),
        rotary: Vec::new(),
        idle: Vec::new(),
        lines: Vec::new(),
    };
    let mut frames = Vec::new();
    let mut shape = Configuration::default();
    for line in 0..plan.model.lines.len() {
        fem.add_line(plan, line, &mut frames, &mut shape);
    }
    Ok(Lines {
        frames,
        shape,
        formulation: Arc::new(fem),
    })
}

impl<K: Kernel> Fem<K> {
    fn add_line(
        &mut self,
        plan: &Plan<'_>,
        index: usize,
        frames: &mut Vec<Frame>,
        shape: &mut Configuration,
    ) {
        let model = plan.model;
        let (line, layout) = (&model.lines[index], &plan.layouts[index]);
        let count = layout.element_count;
        let line_type = |k: usize| &model.line_types[layout.element_types[k]];
        let sections: Vec<ElementSection> = (0..count)
            .map(|k| ElementSection::new(line_type(k), layout.length(k), &layout.natural[k]))
            .collect();
        let nodes = shape::nodes(plan, line, layout, &sections);
        let skipped = usize::from(ends::is_carried(&line.ends[0]));
        let frame_of = |node: usize| (layout.first_frame + node).wrapping_sub(skipped);
        let mut own_line = FemLine {
            first_element: self.parts.len(),
            element_count: count,
            first_frame: layout.first_frame,
            joints: [None; 2],
            idle: [None; 2],
        };
        let kernels: Vec<K> = (0..count)
            .map(|k| {
                // What the springs of a joint take of the outermost element's compliance, the
                // element gives; so the line as a whole is as stiff as it should be.
                let mut section = sections[k].clone();
                for (end, outermost) in [(0, 0), (1, count - 1)] {
                    if k == outermost {
                        section.axial *= ends::axial_share(&line.ends[end]);
                    }
                }
                K::new(section)
            })
            .collect();
        let mut seats: Vec<Seat> = (0..=count).map(|node| Seat::Node(frame_of(node))).collect();
        for end in 0..2 {
            let (node, outermost) = if end == 0 { (0, 0) } else { (count, count - 1) };
            let (seat, joint) = ends::connect(
                plan,
                index,
                end,
                frame_of(node),
                &nodes[node].1,
                &sections[outermost],
                sections[outermost].stiffest(),
            );
            seats[node] = seat;
            if let Some(joint) = joint {
                own_line.joints[end] = Some(self.joints.len());
                self.joints.push(joint);
            }
            if let Seat::Hinged(frame, mount) = seat {
                own_line.idle[end] = Some(self.idle.len());
                self.idle.push(Idle {
                    frame,
                    mount,
                    stiffness: kernels[outermost].stiffest() / sections[outermost].length,
                    mass: 0.5 * line_type(outermost).mass * sections[outermost].length,
                });
            }
        }
        for k in 0..count {
            let place = match [&seats[k], &seats[k + 1]].map(Seat::frame) {
                [Some(_), Some(_)] if k == 0 && matches!(seats[0], Seat::Carried(_)) => {
                    Place::Head(index)
                }
                [Some(_), Some(_)]
                    if k + 1 == count && matches!(seats[count], Seat::Carried(_)) =>
                {
                    Place::Tail(index)
                }
                [Some(first), Some(_)] => Place::Link(first),
                _ => Place::Grounded,
            };
            self.parts.push(Part {
                seats: [seats[k], seats[k + 1]],
                place,
                spread: Spread::new(model, line_type(k)),
                length: sections[k].length,
            });
            for seat in &seats[k..k + 2] {
                self.add_rotary(seat, &section_inertia(line_type(k), sections[k].length));
            }
        }
        self.kernels.extend(kernels);
        self.lines.push(own_line);
        for (node, (position, rotation)) in nodes.iter().enumerate() {
            if matches!(seats[node], Seat::Carried(_)) {
                continue;
            }
            shape.position.push(*position);
            shape.rotation.push(*rotation);
            frames.push(node_frame(model, layout, node, &seats));
        }
    }

    /// Adds half of an element's section inertia at one of its ends.
    fn add_rotary(&mut self, seat: &Seat, inertia: &Vector3) {
        let (frame, axes) = match seat {
            Seat::Node(frame) | Seat::Hinged(frame, _) => (*frame, Matrix3::identity()),
            Seat::Carried(mount) => match mount.carrier {
                Carrier::Free(frame) => (frame, mount.axes),
                Carrier::Vessel(_) => return,
            },
        };
        match self.rotary.last_mut() {
            Some(last) if last.frame == frame && last.axes == axes => last.inertia += inertia,
            _ => self.rotary.push(Rotary {
                frame,
                axes,
                inertia: *inertia,
            }),
        }
    }

    /// Element and place on its unit length of an unstretched distance from end A.
    fn element_at(&self, layout: &LineLayout, arc_length: f64) -> (usize, f64) {
        let at = arc_length.clamp(0.0, layout.arc_length[layout.element_count]);
        let after = layout.arc_length.partition_point(|&s| s <= at);
        let element = after.saturating_sub(1).min(layout.element_count - 1);
        let place = (at - layout.arc_length[element]) / layout.length(element);
        (element, place.clamp(0.0, 1.0))
    }
}

/// Half of an element's section inertia, about local x, y and z (3) [kg m2].
///
/// Source: docs/theory/fem.md, eq. (31).
fn section_inertia(line_type: &catenix_model::LineType, length: f64) -> Vector3 {
    let [y, z] = line_type.rotary_inertia;
    Vector3::new(line_type.polar_inertia, y, z) * (0.5 * length)
}

/// What solvers need to know of a node: half of the elements on both sides of it, and of an element
/// whose other end is carried by something else, all.
fn node_frame(model: &Model, layout: &LineLayout, node: usize, seats: &[Seat]) -> Frame {
    let mut frame = Frame {
        axis: Vector3::x(),
        length: 0.0,
        diameter: 0.0,
        mass: 0.0,
        inertia: Vector3::zeros(),
        drag: DragCoefficients::default(),
        added_normal: 0.0,
        added_axial: 0.0,
        added_inertia: 0.0,
        weight: 0.0,
        buoyancy: 0.0,
        buoyancy_arm: Vector3::zeros(),
        seabed_length: 0.0,
        residual_length: 0.0,
    };
    let mut sides = 0.0;
    for (element, other) in [
        (node.checked_sub(1), node.wrapping_sub(1)),
        (Some(node), node + 1),
    ] {
        let Some(element) = element.filter(|&element| element < layout.element_count) else {
            continue;
        };
        let line_type = &model.line_types[layout.element_types[element]];
        let length = layout.length(element);
        let share = match seats[other] {
            Seat::Carried(_) => 1.0,
            _ => 0.5,
        };
        let spread = Spread::new(model, line_type);
        frame.mass += share * spread.mass * length;
        frame.weight += share * spread.weight * length;
        frame.buoyancy += share * spread.buoyancy * length;
        // Of the cubics, the square of a slope has 4 / 420 of the mass.
        let across = spread.mass * length.powi(3) / 105.0;
        frame.inertia += section_inertia(line_type, length) + Vector3::new(0.0, across, across);
        frame.diameter = frame.diameter.max(line_type.outer_diameter);
        // The lever at which the axial stiffness has the effect of bending, 12 EI / l: round-off in
        // that is what a spin about the line meets.
        let [y, z] = line_type.bending_stiffness;
        let lever = (12.0 * y.max(z) / line_type.axial_stiffness).sqrt();
        frame.length = frame.length.max(2.0 * lever);
        frame.residual_length += length;
        sides += 1.0;
    }
    frame.residual_length /= f64::max(sides, 1.0);
    frame
}

impl<K: Kernel> Formulation for Fem<K> {
    fn evaluation(self: Arc<Self>, at: &Situation<'_>) -> Box<dyn Evaluation> {
        Box::new(FemEvaluation::new(self, at))
    }

    /// The two nodes of the element that holds the arc length, with the shares and arms that give a
    /// force there the moments of the element's cubics. Next to a vessel that carries an end the
    /// node takes all.
    ///
    /// Source: docs/theory/fem.md, eq. (29).
    fn spots(&self, layout: &LineLayout, arc_length: f64) -> Vec<Spot> {
        let Some(line) = self
            .lines
            .iter()
            .find(|l| l.first_frame == layout.first_frame)
        else {
            return Vec::new();
        };
        let (element, x) = self.element_at(layout, arc_length);
        let part = &self.parts[line.first_element + element];
        let y = 1.0 - x;
        let shares = [y * y * (1.0 + 2.0 * x), x * x * (3.0 - 2.0 * x)];
        let arms = [x / (1.0 + 2.0 * x), -y / (3.0 - 2.0 * x)];
        let spot = |end: usize, share: f64, arm: f64| -> Option<Spot> {
            let arm = Vector3::x() * (arm * part.length);
            let (frame, arm) = match &part.seats[end] {
                Seat::Node(frame) | Seat::Hinged(frame, _) => (*frame, arm),
                Seat::Carried(mount) => match mount.carrier {
                    Carrier::Free(frame) => (frame, mount.arm + mount.axes * arm),
                    Carrier::Vessel(_) => return None,
                },
            };
            Some(Spot {
                frame,
                half: 0,
                arm,
                share,
            })
        };
        let both: Vec<Option<Spot>> = (0..2)
            .map(|end| spot(end, shares[end], arms[end]))
            .collect();
        match both[..] {
            [Some(first), Some(second)] => [first, second]
                .into_iter()
                .filter(|spot| spot.share > 0.0)
                .collect(),
            [None, _] => spot(1, 1.0, -y).into_iter().collect(),
            _ => spot(0, 1.0, x).into_iter().collect(),
        }
    }

    fn owner(&self, line: &Line, layout: &LineLayout, index: usize) -> FrameOwner {
        let skipped = usize::from(ends::is_carried(&line.ends[0]));
        let node = index + skipped;
        FrameOwner::Node {
            line: line.name.clone(),
            number: node + 1,
            arc_length_m: layout.arc_length[node],
        }
    }

    fn stiffest(&self) -> f64 {
        let elements = self
            .kernels
            .iter()
            .map(|k| k.stiffest() / k.section().length);
        let joints = self.joints.iter().map(|joint| joint.springs.stiffness);
        elements.chain(joints).fold(0.0, f64::max)
    }

    fn stiffest_over(&self, frames: &[Arc<Frame>], softness: &dyn Fn(&Frame) -> f64) -> f64 {
        let soft = |frame: Option<usize>| frame.map_or(0.0, |k| softness(&frames[k]));
        let elements = self.kernels.iter().zip(&self.parts).map(|(kernel, part)| {
            let softest = part.seats.each_ref().map(|seat| soft(seat.frame()));
            kernel.stiffest() / kernel.section().length * softest[0].max(softest[1])
        });
        let joints = self
            .joints
            .iter()
            .map(|joint| joint.springs.stiffness * soft(Some(joint.node)));
        elements.chain(joints).fold(0.0, f64::max)
    }
}
