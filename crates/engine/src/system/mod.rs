//! The assembled system: lines in their formulation, bodies, lumps and loads, built once from a
//! [`Model`] and never changed; everything that changes lives in the state and in a [`SystemSolver`].
//!
//! Frames are numbered line by line from end A to end B, then the bodies.

pub(crate) mod assembly;
mod balance;
mod build;
mod carry;
mod energy;
pub(crate) mod frame_kernel;
pub(crate) mod frames;
mod linearised;
mod loads;
mod own_axes;
mod quantities;
pub(crate) mod shape;
mod solver;
pub(crate) mod surroundings;
pub(crate) mod touch;
mod view;

#[cfg(test)]
mod quantities_test;
#[cfg(test)]
pub(crate) mod tangent_test;

use std::ops::Range;
use std::sync::Arc;

use catenix_model::{ChannelTarget, LineType, Model, NaturalShape};
use catenix_numerics::{Configuration, Matrix3, Topology, Vector3, Vector6};
use thiserror::Error;

use crate::body::lump::Lump;
use crate::body::motion::PrescribedMotion;
use crate::formulation::Formulation;
use crate::hydro::current::CurrentField;
use crate::hydro::morison::DragCoefficients;
use crate::load::variation;

pub use balance::Momentum;
pub use energy::EnergyTerms;
pub(crate) use solver::LoadControl;
pub use solver::SystemSolver;
pub use view::StepView;

/// Why a model cannot be assembled.
#[derive(Debug, Clone, Error, PartialEq)]
#[non_exhaustive]
pub enum SystemError {
    /// Nothing to compute.
    #[error("the model has no line and no body: there is nothing to compute")]
    Empty,
    /// A value that the solver cannot work with.
    #[error("{owner}: {what}")]
    Unusable {
        /// Line, body or vessel.
        owner: String,
        /// What is wrong and what to change.
        what: String,
    },
}

/// Share of the reference force beyond which a residual that round-off leaves is told to the user.
const WORRYING_ROUND_OFF: f64 = 1e-5;

/// The assembled, immutable system.
#[derive(Debug, Clone)]
pub struct System {
    pub(crate) model: Model,
    /// Neighbours that are alike share one.
    pub(crate) frames: Vec<Arc<Frame>>,
    /// The bodies, several at a time.
    pub(crate) body_batches: Vec<frame_kernel::FrameBatch>,
    pub(crate) lumps: Vec<FrameLump>,
    pub(crate) loads: Vec<loads::FrameLoad>,
    pub(crate) lines: Vec<LineLayout>,
    /// What the results along each line are computed with.
    pub(crate) walls: Vec<quantities::WallFactors>,
    pub(crate) formulation: Arc<dyn Formulation>,
    pub(crate) vessels: Vec<PrescribedMotion>,
    pub(crate) current: CurrentField,
    pub(crate) topology: Topology,
    pub(crate) first_shape: Configuration,
    pub(crate) followers: carry::Followers,
    pub(crate) reference_force: f64,
    pub(crate) reference_length: f64,
    pub(crate) residual_floor: f64,
}

/// Constant properties of a rigid frame: an element of a line, or a body.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Frame {
    /// Axis of the frame in its own axes, unit: along the line, or the body's z.
    pub axis: Vector3,
    /// Length along the axis [m].
    pub length: f64,
    /// Diameter, for the passage through the surface [m].
    pub diameter: f64,
    /// Mass of the structure [kg].
    pub mass: f64,
    /// Moments of inertia of the structure about its own axes [kg m2].
    pub inertia: Vector3,
    /// Drag, fully under water.
    pub drag: DragCoefficients,
    /// Added mass across the axis, fully under water [kg].
    pub added_normal: f64,
    /// Added mass along the axis [kg].
    pub added_axial: f64,
    /// Added moment of inertia about the normal axes [kg m2].
    pub added_inertia: f64,
    /// Weight in air [N].
    pub weight: f64,
    /// Buoyancy, fully under water [N].
    pub buoyancy: f64,
    /// From the origin to the centre of buoyancy, own axes [m].
    pub buoyancy_arm: Vector3,
    /// Length that rests on the seabed [m]; 0 for none.
    pub seabed_length: f64,
    /// Length that turns a residual moment into a force [m].
    pub residual_length: f64,
}

/// A lump on a frame.
#[derive(Debug, Clone)]
pub(crate) struct FrameLump {
    pub frame: usize,
    /// Which point, where the frame is a pair of points.
    pub half: usize,
    /// From the frame's origin, own axes [m].
    pub arm: Vector3,
    pub lump: Lump,
    /// Weight in air [N].
    pub weight: f64,
    /// Buoyancy under water [N].
    pub buoyancy: f64,
    /// Diameter of a sphere of its volume [m].
    pub diameter: f64,
}

/// What a connector's side is fixed to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Carrier {
    /// A frame of the state.
    Free(usize),
    /// A prescribed body.
    Vessel(usize),
}

/// A connection point on a carrier.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Mount {
    pub carrier: Carrier,
    /// From the carrier's origin, its own axes [m].
    pub arm: Vector3,
    /// Connection axes in the carrier's axes.
    pub axes: Matrix3,
}

impl Mount {
    /// Moved by `shift`, in the connection axes [m].
    pub fn shifted(mut self, shift: &Vector3) -> Mount {
        self.arm += self.axes * shift;
        self
    }
}

/// Where a line's parts are.
#[derive(Debug, Clone)]
pub(crate) struct LineLayout {
    pub first_frame: usize,
    /// Frames that the formulation gives the line.
    pub frame_count: usize,
    pub element_count: usize,
    /// Unstretched distance of each node from end A (n_elements + 1) [m].
    pub arc_length: Vec<f64>,
    /// Unstretched length of each element (n_elements) [m].
    pub lengths: Vec<f64>,
    /// Line type of each element (n_elements).
    pub element_types: Vec<usize>,
    /// Stress-free shape of each element (n_elements).
    pub natural: Vec<NaturalShape>,
    /// Effective tension that is expected at each node (n_elements + 1), by which discrete elements
    /// know bending layers shorter than themselves [N]; empty where nothing is known.
    pub tension: Vec<f64>,
}

impl LineLayout {
    /// The line's frames.
    pub fn frames(&self) -> Range<usize> {
        self.first_frame..self.first_frame + self.frame_count
    }

    /// Unstretched length of an element [m].
    pub fn length(&self, element: usize) -> f64 {
        self.lengths[element]
    }

    /// Effective tension expected at a node [N]; 0 where nothing is known.
    pub fn expected_tension(&self, node: usize) -> f64 {
        self.tension.get(node).copied().unwrap_or(0.0)
    }
}

/// The larger of two numbers; one that is none does not hide.
fn larger(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}

/// A time at which loads are not smooth.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LoadEvent {
    /// Time [s].
    pub time: f64,
    /// Whether they jump, rather than bend.
    pub jump: bool,
}

/// Which line or body a frame belongs to, for messages.
#[derive(Debug, Clone, PartialEq)]
pub enum FrameOwner {
    /// Element of a line: name, number from end A (1 is the first), distance of its centre [m].
    Element {
        /// Line name.
        line: String,
        /// Number from end A, starting at 1.
        number: usize,
        /// Unstretched distance of the element's centre from end A [m].
        arc_length_m: f64,
    },
    /// Node of a line: name, number from end A (1 is the first), distance [m].
    Node {
        /// Line name.
        line: String,
        /// Number from end A, starting at 1.
        number: usize,
        /// Unstretched distance from end A [m].
        arc_length_m: f64,
    },
    /// A body.
    Body(String),
}

impl std::fmt::Display for FrameOwner {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            FrameOwner::Element {
                line,
                number,
                arc_length_m,
            } => {
                write!(
                    f,
                    "element {number} of line '{line}' ({arc_length_m:.1} m from end A)"
                )
            }
            FrameOwner::Node {
                line,
                number,
                arc_length_m,
            } => {
                write!(
                    f,
                    "node {number} of line '{line}' ({arc_length_m:.1} m from end A)"
                )
            }
            FrameOwner::Body(name) => write!(f, "body '{name}'"),
        }
    }
}

impl System {
    /// Assembles a model.
    ///
    /// # Errors
    /// [`SystemError`] when there is nothing to compute or a value cannot be used.
    pub fn new(model: &Model) -> Result<System, SystemError> {
        build::build(model, &[])
    }

    /// Whether places of this system bend in a way that depends on the tension there, which it does
    /// not know yet: a static equilibrium tells it
    /// ([`StaticSolution::tightened`](crate::StaticSolution::tightened)).
    pub fn wants_tension(&self) -> bool {
        let known = self.lines.iter().any(|line| !line.tension.is_empty());
        !known && self.model.statics.equilibrium && self.formulation.has_layers()
    }

    /// The same system, which knows the tension at the nodes of each line (n_lines x n_nodes) [N],
    /// with another first shape.
    pub(crate) fn tightened(
        &self,
        tensions: &[Vec<f64>],
        first_shape: &Configuration,
    ) -> Result<System, SystemError> {
        let mut system = build::build(&self.model, tensions)?;
        system.first_shape = first_shape.clone();
        Ok(system)
    }

    /// The model it was made of.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// Number of frames: elements and bodies.
    pub fn frame_count(&self) -> usize {
        self.frames.len()
    }

    /// Largest residual force that counts as solved [N]: a fraction of the reference force, or
    /// what round-off leaves where that is more.
    ///
    /// Source: docs/theory/solver.md, eq. (8).
    pub fn allowed_residual(&self, tolerance: f64) -> f64 {
        (tolerance * self.reference_force).max(self.residual_floor)
    }

    /// What to tell the user where round-off leaves residuals that may matter.
    pub(crate) fn round_off_warning(&self) -> Option<String> {
        let share = self.residual_floor / self.reference_force;
        (share > WORRYING_ROUND_OFF).then(|| {
            format!(
                "round-off in the stiffest springs leaves residual forces of up to {:.1e} N, {share:.0e} \
                 of the weights and loads: results that depend on smaller forces are not to be \
                 trusted. A smaller axial stiffness, longer elements or an origin closer to the \
                 system lower it",
                self.residual_floor
            )
        })
    }

    /// Force that tolerances are relative to: weight of everything in air [N].
    pub fn reference_force(&self) -> f64 {
        self.reference_force
    }

    /// Length that step accuracy is relative to: the longest line [m].
    pub fn reference_length(&self) -> f64 {
        self.reference_length
    }

    /// The first guess of the shape, before statics.
    pub fn first_shape(&self) -> &Configuration {
        &self.first_shape
    }

    /// Unstretched distances of a line's nodes from end A (n_elements + 1) [m].
    pub fn arc_length(&self, line: usize) -> &[f64] {
        &self.lines[line].arc_length
    }

    /// Which line or body a frame belongs to.
    pub fn owner(&self, frame: usize) -> FrameOwner {
        for (layout, line) in self.lines.iter().zip(&self.model.lines) {
            if layout.frames().contains(&frame) {
                let index = frame - layout.first_frame;
                return self.formulation.owner(line, layout, index);
            }
        }
        FrameOwner::Body(self.model.bodies[frame - self.body_frame(0)].name.clone())
    }

    /// Squared frequency that round-off in the stiffest spring amounts to [rad2/s2].
    pub(crate) fn frequency_round_off(&self) -> f64 {
        self.round_off(|frame| 1.0 / frame.mass)
    }

    /// The same for the spin of elements about their axes, which a connector's stiffness across
    /// the axis meets by round-off only [rad2/s2].
    pub(crate) fn spin_round_off(&self) -> f64 {
        self.round_off(|frame| (0.5 * frame.length).powi(2) / frame.inertia.min())
    }

    /// Rounding of the stiffest spring, over what its frames oppose to it.
    fn round_off(&self, softness: impl Fn(&Frame) -> f64) -> f64 {
        4.0 * f64::EPSILON * self.formulation.stiffest_over(&self.frames, &softness)
    }

    /// Axis of a frame in its own axes: along the line, or a body's z.
    pub(crate) fn frame_axis(&self, frame: usize) -> Vector3 {
        self.frames[frame].axis
    }

    /// Whether a frame weighs nothing in water, lumps included.
    pub(crate) fn is_weightless(&self, frame: usize) -> bool {
        let own = &self.frames[frame];
        let lumps = self.lumps.iter().filter(|lump| lump.frame == frame);
        let net =
            own.weight - own.buoyancy + lumps.map(|lump| lump.weight - lump.buoyancy).sum::<f64>();
        net.abs() <= 1e-6 * own.weight
    }

    /// Number of frames that are pairs of points; they come first.
    pub(crate) fn pair_count(&self) -> usize {
        self.first_shape.pair_count()
    }

    /// Largest angle by which anything turns at an increment (frame_count) [rad].
    pub(crate) fn largest_turn(&self, increment: &[Vector6]) -> f64 {
        let turns = increment[self.pair_count()..].iter();
        let turns = turns.map(|d| d.fixed_rows::<3>(3).norm());
        turns.fold(self.formulation.largest_turn(increment), larger)
    }

    /// Largest translation of anything at an increment (frame_count) [m].
    pub(crate) fn largest_translation(&self, increment: &[Vector6]) -> f64 {
        let pairs = increment[..self.pair_count()].iter();
        let second = pairs.map(|d| d.fixed_rows::<3>(3).norm());
        let first = increment.iter().map(|d| d.fixed_rows::<3>(0).norm());
        first.chain(second).fold(0.0, larger)
    }

    /// Largest moment of a residual on a frame (frame_count) [N m].
    pub(crate) fn largest_moment(&self, residual: &[Vector6]) -> f64 {
        let moments = residual[self.pair_count()..].iter();
        let moments = moments.map(|d| d.fixed_rows::<3>(3).norm());
        moments.fold(0.0, larger)
    }

    /// Frame of a body.
    pub(crate) fn body_frame(&self, body: usize) -> usize {
        self.frames.len() - self.model.bodies.len() + body
    }

    pub(crate) fn element_type(&self, line: usize, element: usize) -> &LineType {
        &self.model.line_types[self.lines[line].element_types[element]]
    }

    /// Times at which loads bend or jump: a step should end there.
    pub(crate) fn load_events(&self) -> impl Iterator<Item = LoadEvent> + '_ {
        let loads = self.model.loads.iter();
        let of_loads = loads.flat_map(|load| variation::events(&load.variation));
        let events = self.current.events().chain(of_loads);
        events.map(|(time, jump)| LoadEvent { time, jump })
    }

    /// Whether a channel can be read from this system.
    pub fn has_channel(&self, target: ChannelTarget) -> bool {
        let (lines, bodies) = (self.lines.len(), self.model.bodies.len());
        match target {
            ChannelTarget::BodyPosition(k, _)
            | ChannelTarget::BodyTilt(k)
            | ChannelTarget::BodyAngle(k, _) => k < bodies,
            ChannelTarget::BodyOffset(k, _) => {
                k < bodies && self.model.bodies[k].offset_vessel.is_some()
            }
            ChannelTarget::VesselPosition(k, _) | ChannelTarget::VesselAngle(k, _) => {
                k < self.vessels.len()
            }
            ChannelTarget::EndForce(k, end, _) | ChannelTarget::EndMoment(k, end, _) => {
                k < lines && end < 2
            }
            ChannelTarget::EndTension(k, end) | ChannelTarget::EndDeclination(k, end) => {
                k < lines && end < 2
            }
            ChannelTarget::LinePoint(k, ..) => k < lines,
        }
    }
}
