//! Sums over the whole system that laws of mechanics speak of: momentum and energy.

use catenix_numerics::{Matrix3, Vector3};

use super::frames::{FrameMotion, frame_motion, lump_carrier};
use super::{EnergyTerms, Frame, StepView};

/// Momentum of the structure: elements, bodies and the masses of lumps, without added mass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Momentum {
    /// Linear momentum, global (3) [kg m/s].
    pub linear: Vector3,
    /// Angular momentum about the global origin (3) [kg m2/s].
    pub angular: Vector3,
}

impl Momentum {
    /// Adds a linear momentum at a position.
    pub(crate) fn add_point(&mut self, position: &Vector3, own: &Vector3) {
        self.linear += own;
        self.angular += position.cross(own);
    }

    /// Adds a rigid frame.
    pub(crate) fn add_frame(&mut self, frame: &Frame, m: &FrameMotion) {
        self.add_point(&m.position, &(m.velocity * frame.mass));
        let inertia = Matrix3::from_diagonal(&frame.inertia);
        self.angular += m.rotation * (inertia * (m.rotation.transpose() * m.spin));
    }
}

impl StepView<'_> {
    /// Momentum of the structure.
    ///
    /// Source: docs/theory/energy.md, eq. (4).
    pub fn momentum(&self) -> Momentum {
        let system = self.solver.system;
        let at = self.solver.situation(self.time, self.state);
        let mut momentum = Momentum {
            linear: Vector3::zeros(),
            angular: Vector3::zeros(),
        };
        self.solver.lines.add_momentum(&at, &mut momentum);
        for k in system.body_frame(0)..system.frames.len() {
            momentum.add_frame(&system.frames[k], &frame_motion(self.state, k));
        }
        for lump in &system.lumps {
            let m = lump_carrier(self.state, lump);
            let arm = m.rotation * lump.arm;
            let own = (m.velocity + m.spin.cross(&arm)) * lump.lump.mass;
            momentum.add_point(&(m.position + arm), &own);
        }
        momentum
    }

    /// Energies of the system and the powers that change them.
    pub fn energy(&self) -> EnergyTerms {
        self.solver.energy_terms(self.time, self.state)
    }
}
