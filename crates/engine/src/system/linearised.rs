//! The system linearised about a state: mass matrix, tangent, structural damping of a small
//! motion, and what such a motion is at the nodes of a line.

use catenix_numerics::{BlockMatrix, ImplicitSystem, MotionState, TangentWeights, Vector6, six};

use super::frames::{self, frame_motion};
use super::solver::SystemSolver;
use super::{Carrier, Mount};
use crate::formulation::Situation;

impl SystemSolver<'_> {
    /// Tangent stiffness at `state`, which is at rest: derivative of all forces by the increments.
    ///
    /// Frames that could spin each by itself, which moves nothing, are held.
    pub(crate) fn stiffness(&mut self, state: &MotionState) -> &BlockMatrix {
        let weights = TangentWeights {
            velocity: 0.0,
            acceleration: 0.0,
            rotation: None,
        };
        let mut residual = vec![Vector6::zeros(); self.system.frames.len()];
        self.begin();
        self.assemble(0.0, state, Some(&weights), &mut residual);
        let mut matrix = std::mem::take(&mut self.matrix);
        self.lines
            .hold_idle_spins(&self.situation(0.0, state), &mut matrix);
        self.matrix = matrix;
        &self.matrix
    }

    /// Mass matrix at `state`, symmetric, with the added mass if `in_water`.
    ///
    /// Source: docs/theory/modes.md, eq. (2).
    pub(crate) fn mass(&self, state: &MotionState, in_water: bool) -> BlockMatrix {
        let at = self.situation(0.0, state);
        let mut mass = BlockMatrix::zeros(&self.system.topology);
        self.add_mass(&at, in_water, &mut mass);
        mass
    }

    /// Adds the mass matrix in a situation.
    pub(super) fn add_mass(&self, at: &Situation<'_>, in_water: bool, mass: &mut BlockMatrix) {
        let (system, state) = (self.system, at.state);
        self.lines.add_mass(at, in_water, mass);
        for k in system.body_frame(0)..system.frames.len() {
            let motion = frame_motion(state, k);
            let own = frames::frame_mass(&system.frames[k], &motion, in_water);
            mass.diagonal[k] = mass.diagonal[k].plus(1.0, &own);
        }
        for lump in &system.lumps {
            let motion = frames::lump_carrier(state, lump);
            let own = frames::lump_mass(lump, &motion, &at.sea, in_water);
            let block = &mut mass.diagonal[lump.frame];
            if lump.frame < system.pair_count() {
                block.add_quadrant(lump.half, lump.half, &own.quadrant(0, 0));
            } else {
                *block = block.plus(1.0, &own);
            }
        }
    }

    /// v^T C v with the structural damping C about `state`: the power that it takes from the
    /// velocities `v` [W].
    pub(crate) fn structural_damping(&self, state: &mut MotionState, v: &[Vector6]) -> f64 {
        state.velocity.copy_from_slice(v);
        let power = self.lines.structural_damping(&self.situation(0.0, state));
        state.velocity.fill(Vector6::zeros());
        power
    }

    /// Small motion of the nodes of a line for the small motion `x` of the frames,
    /// (n_elements + 1) translations and rotations.
    pub(crate) fn motion_at_nodes(
        &self,
        state: &MotionState,
        x: &[Vector6],
        line: usize,
    ) -> Vec<Vector6> {
        self.lines
            .motion_at_nodes(&self.situation(0.0, state), x, line)
    }
}

impl Mount {
    /// Small motion of this point for the small motion `x` of the frames; vessels stand still.
    pub(crate) fn motion(&self, state: &MotionState, x: &[Vector6]) -> Vector6 {
        let Carrier::Free(k) = self.carrier else {
            return Vector6::zeros();
        };
        let turn = x[k].fixed_rows::<3>(3).into_owned();
        let lever = state.configuration.rotation[k] * self.arm;
        six(&(x[k].fixed_rows::<3>(0) + turn.cross(&lever)), &turn)
    }
}
