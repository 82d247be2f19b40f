//! Sums over the whole system that laws of mechanics speak of: momentum and energy.

use catenix_numerics::{Matrix3, Vector3};

use super::assembly::frame_motion;
use super::{EnergyTerms, StepView};

/// Momentum of the structure: elements, bodies and the masses of lumps, without added mass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Momentum {
    /// Linear momentum, global (3) [kg m/s].
    pub linear: Vector3,
    /// Angular momentum about the global origin (3) [kg m2/s].
    pub angular: Vector3,
}

impl StepView<'_> {
    /// Momentum of the structure.
    ///
    /// Source: docs/theory/energy.md, eq. (4).
    pub fn momentum(&self) -> Momentum {
        let system = self.solver.system;
        let mut linear = Vector3::zeros();
        let mut angular = Vector3::zeros();
        for (k, frame) in system.frames.iter().enumerate() {
            let m = frame_motion(self.state, k);
            let inertia = Matrix3::from_diagonal(&frame.inertia);
            let own = m.velocity * frame.mass;
            linear += own;
            angular +=
                m.position.cross(&own) + m.rotation * (inertia * (m.rotation.transpose() * m.spin));
        }
        for lump in &system.lumps {
            let m = frame_motion(self.state, lump.frame);
            let arm = m.rotation * lump.arm;
            let own = (m.velocity + m.spin.cross(&arm)) * lump.lump.mass;
            linear += own;
            angular += (m.position + arm).cross(&own);
        }
        Momentum { linear, angular }
    }

    /// Energies of the system and the powers that change them.
    pub fn energy(&self) -> EnergyTerms {
        self.solver.energy_terms(self.time, self.state)
    }
}
