//! The seam behind which the formulations stand: how lines become frames, forces and results.
//!
//! A formulation is one folder here, with its force kernels in the folder `element` below. It owes
//! three things:
//!
//! 1. **`Family`**, its entry in the registry: what it is called, how many frames a line takes,
//!    and how lines are built (`Lines`: frames, first shape, and the formulation itself);
//! 2. **`Formulation`**, what never changes: where things sit on a line, how stiff it is, what
//!    its frames are called;
//! 3. **`Evaluation`**, the lines at one state: residual and iteration matrix, and afterwards,
//!    for the state that was assembled last, results at the nodes, forces on the supports,
//!    energies, momentum, mass.
//!
//! Bodies, vessels, lumps, point loads, water, seabed, block solver, integrators and results are
//! shared. Force kernels are not: otherwise the agreement of two formulations would prove nothing.
//! No folder here names another; what they share (how a property of a section is read off its
//! points, `curve.rs`; which way sections point, `directions.rs`) stands beside them.
//!
//! A new formulation is a new folder, a line in `FAMILIES`, and a name in the two lists that
//! readers of model files need for their errors and their schema: `FormulationKind` and
//! `FormulationChoice` in `catenix-model`. Nothing else asks which formulation it has.

mod curve;
pub mod dem;
pub(crate) mod directions;
pub mod fem;
pub mod lumped;

use std::fmt::Debug;
use std::sync::Arc;

use catenix_model::{FormulationKind, Line, Model};
use catenix_numerics::{
    Block6, BlockMatrix, Configuration, MotionState, TangentWeights, Vector3, Vector6,
};

use crate::body::motion::RigidMotion;
use crate::system::frames::Sea;
use crate::system::shape::Supports;
use crate::system::{
    Carrier, EnergyTerms, Frame, FrameOwner, LineLayout, Momentum, System, SystemError,
};

/// The registry: every formulation that there is.
const FAMILIES: [Family; 4] = [dem::FAMILY, fem::COROTATIONAL, fem::EXACT, lumped::FAMILY];

/// What the registry knows of a formulation: how a model becomes its lines.
pub(crate) struct Family {
    /// Its name in model files.
    pub kind: FormulationKind,
    /// Number of frames that a line takes.
    pub frame_count: fn(&Model, &Line, &LineLayout) -> usize,
    /// Builds the lines of a model, or refuses what the formulation cannot do
    /// ([`SystemError::Unusable`], with what to write instead).
    pub build: fn(&Plan<'_>) -> Result<Lines, SystemError>,
}

/// The registered formulation of a name.
///
/// # Errors
/// [`SystemError::Unusable`] where nothing is registered under it.
pub(crate) fn family(kind: FormulationKind) -> Result<&'static Family, SystemError> {
    let found = FAMILIES.iter().find(|family| family.kind == kind);
    found.ok_or_else(|| SystemError::Unusable {
        owner: format!("the formulation '{}'", kind.word()),
        what: "this engine does not have it".to_owned(),
    })
}

/// What a formulation is built from.
#[derive(Clone, Copy)]
pub(crate) struct Plan<'a> {
    /// The model.
    pub model: &'a Model,
    /// One layout per line of the model; their frames are already numbered.
    pub layouts: &'a [LineLayout],
    /// Where ends can be connected, in the first shape.
    pub supports: &'a Supports,
}

/// The lines of a model as a formulation sees them.
pub(crate) struct Lines {
    /// Properties of the frames of all lines, line by line from end A (n_line_frames).
    pub frames: Vec<Frame>,
    /// First shape of these frames (n_line_frames).
    pub shape: Configuration,
    /// The formulation with all its constants.
    pub formulation: Arc<dyn Formulation>,
}

/// A point on a frame or of a pair, with the share of a thing that it takes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Spot {
    /// The frame or pair of points.
    pub frame: usize,
    /// Which point of a pair; 0 at frames.
    pub half: usize,
    /// From the frame's origin, in its own axes (3) [m]; zero at points.
    pub arm: Vector3,
    /// Share, 0 to 1; the shares of one thing add up to 1 [-].
    pub share: f64,
}

/// What never changes of the lines of a system.
pub(crate) trait Formulation: Debug + Send + Sync {
    /// Room to evaluate the lines of `system`, at its first shape.
    fn evaluation(self: Arc<Self>, at: &Situation<'_>) -> Box<dyn Evaluation>;

    /// Where a thing at an unstretched distance from end A [m] sits.
    fn spots(&self, layout: &LineLayout, arc_length: f64) -> Vec<Spot>;

    /// What frame `index` of a line is called, counted from end A.
    fn owner(&self, line: &Line, layout: &LineLayout, index: usize) -> FrameOwner;

    /// Stiffest spring against a displacement [N/m]: round-off in the residual is proportional to it.
    fn stiffest(&self) -> f64;

    /// Largest product of a spring's stiffness and the softness of a frame that it acts on.
    fn stiffest_over(&self, frames: &[Arc<Frame>], softness: &dyn Fn(&Frame) -> f64) -> f64;

    /// Largest angle by which the parts of lines turn that are no frames, whose own turns callers
    /// see, at an increment (frame_count) [rad].
    fn largest_turn(&self, increment: &[Vector6]) -> f64 {
        let _ = increment;
        0.0
    }

    /// Whether no two frames share mass, so that an explicit integrator can do without a system of
    /// equations; then [`Evaluation::stable_step`] has a value.
    fn has_mass_of_blocks(&self) -> bool {
        false
    }

    /// Whether connectors depend on the tension that is expected at them
    /// ([`LineLayout::tension`]).
    fn has_layers(&self) -> bool {
        false
    }

    /// Direction of the line at one of its frames, unit, global (3).
    fn axis(&self, state: &MotionState, frame: usize) -> Vector3 {
        state.configuration.rotation[frame].column(0).into()
    }
}

/// A state of the system with its surroundings.
#[derive(Clone, Copy)]
pub(crate) struct Situation<'a> {
    /// The system.
    pub system: &'a System,
    /// Water and seabed at this time.
    pub sea: Sea<'a>,
    /// Motions of the vessels at this time.
    pub vessels: &'a [RigidMotion],
    /// Configuration, velocities and accelerations of all frames.
    pub state: &'a MotionState,
}

impl Situation<'_> {
    /// Motion of a frame or vessel.
    pub fn carrier(&self, carrier: Carrier) -> RigidMotion {
        match carrier {
            Carrier::Free(k) => RigidMotion {
                position: self.state.configuration.position[k],
                rotation: self.state.configuration.rotation[k],
                velocity: self.state.velocity[k].fixed_rows::<3>(0).into_owned(),
                spin: self.state.velocity[k].fixed_rows::<3>(3).into_owned(),
                acceleration: self.state.acceleration[k].fixed_rows::<3>(0).into_owned(),
                angular_acceleration: self.state.acceleration[k].fixed_rows::<3>(3).into_owned(),
            },
            Carrier::Vessel(k) => self.vessels[k],
        }
    }
}

/// Local results at a node of a line.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct NodeResult {
    /// Position (3) [m].
    pub position: Vector3,
    /// Direction of the line towards end B, unit (3).
    pub axis: Vector3,
    /// Effective tension [N].
    pub tension: f64,
    /// Shear force [N].
    pub shear: f64,
    /// Bending moment [N m].
    pub bend_moment: f64,
    /// Torque [N m]; NaN where the formulation has none.
    pub torque: f64,
    /// Curvature [1/m].
    pub curvature: f64,
}

/// Rows of [`Evaluation::nodes`]: those of `LineQuantity::ALL`, with the three components of the
/// axis where wall tension, stress and declination will stand, for which it is needed.
pub(crate) const NODE_ROWS: usize = 11;

impl NodeResult {
    /// Writes the result at a node into its rows.
    pub fn put(&self, node: usize, rows: &mut [f64]) {
        let nodes = rows.len() / NODE_ROWS;
        let values: [f64; NODE_ROWS] = [
            self.position.x,
            self.position.y,
            self.position.z,
            self.tension,
            self.axis.x,
            self.shear,
            self.bend_moment,
            self.curvature,
            self.torque,
            self.axis.y,
            self.axis.z,
        ];
        for (row, value) in values.into_iter().enumerate() {
            rows[row * nodes + node] = value;
        }
    }
}

/// Sets the lines' own part of a residual and, if wanted, of a matrix to zero.
fn clear_lines(
    system: &System,
    matrix_too: bool,
    residual: &mut [Vector6],
    matrix: &mut BlockMatrix,
) {
    let end = system.body_frame(0);
    residual[..end].fill(Vector6::zeros());
    if matrix_too {
        matrix.diagonal[..end].fill(Block6::ZERO);
        matrix.upper[..end].fill(Block6::ZERO);
        matrix.lower[..end].fill(Block6::ZERO);
    }
}

/// The lines of a system at a state, with the room that this needs.
///
/// Everything but [`Self::assemble`] speaks of the state that was assembled last, which callers
/// hand in again.
pub(crate) trait Evaluation: Debug + Send {
    /// A copy.
    fn duplicate(&self) -> Box<dyn Evaluation>;

    /// Inertia + internal forces - loads of all lines (frame_count) [N, N m] and, with `weights`, the
    /// derivatives by the increments of the frames: written over what `residual` and `matrix` held
    /// for the lines' own frames, and added to what they hold for bodies, and between the first and
    /// last frame of a line and the body that it ends on.
    fn assemble(
        &mut self,
        at: &Situation<'_>,
        weights: Option<&TangentWeights<'_>>,
        residual: &mut [Vector6],
        matrix: &mut BlockMatrix,
    );

    /// Told before the first iteration of a solution.
    fn begin(&mut self);

    /// Told of the increment of the frames (frame_count) that is about to be applied.
    fn moving(&mut self, at: &System, increment: &[Vector6]);

    /// Local results at a node, counted from end A (0 to n_elements).
    fn node(&self, at: &Situation<'_>, line: usize, node: usize) -> NodeResult;

    /// Local results at all nodes of a line: ([`NODE_ROWS`] x nodes).
    fn nodes(&self, at: &Situation<'_>, line: usize, rows: &mut [f64]) {
        for node in 0..rows.len() / NODE_ROWS {
            self.node(at, line, node).put(node, rows);
        }
    }

    /// Force and moment, about the connection point, of a line on what its end (0 or 1) is
    /// connected to (6) [N, N m]; zero for a free end.
    fn end_load(&self, at: &Situation<'_>, line: usize, end: usize) -> Vector6;

    /// Adds energies of the lines and the powers that change them.
    fn add_energy(&self, at: &Situation<'_>, terms: &mut EnergyTerms);

    /// Adds the momentum of the lines, without added mass.
    fn add_momentum(&self, at: &Situation<'_>, momentum: &mut Momentum);

    /// Adds the mass matrix of the lines, symmetric, with the added mass if `in_water`.
    fn add_mass(&self, at: &Situation<'_>, in_water: bool, mass: &mut BlockMatrix);

    /// Power that structural damping takes at the velocities of `at`, which need not be those
    /// that were assembled [W].
    fn structural_damping(&self, at: &Situation<'_>) -> f64;

    /// Gives frames that could turn by themselves, without moving anything, a stiffness against it.
    fn hold_idle_spins(&self, at: &Situation<'_>, matrix: &mut BlockMatrix);

    /// Small motion of the nodes of a line for the small motion `x` of the frames (frame_count):
    /// translations and rotations, (n_elements + 1).
    fn motion_at_nodes(&self, at: &Situation<'_>, x: &[Vector6], line: usize) -> Vec<Vector6>;

    /// A step that an explicit integrator can take [s]; `None` where there is none.
    fn stable_step(&self, at: &Situation<'_>) -> Option<f64> {
        let _ = at;
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_is_registered_once() {
        for kind in FormulationKind::ALL {
            let found = FAMILIES.iter().filter(|family| family.kind == kind);
            assert_eq!(found.count(), 1, "{}", kind.word());
        }
        assert_eq!(FAMILIES.len(), FormulationKind::ALL.len());
    }
}
