//! Energies of the system and the powers that change them, for the energy account.

use catenix_numerics::MotionState;

use super::frame_kernel::frame_energies;
use super::frames::{self, LoadPowers};
use super::loads;
use super::solver::SystemSolver;

/// Energies and powers at one instant.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct EnergyTerms {
    /// Kinetic energy of the structure; of lumps with their added mass [J].
    pub kinetic: f64,
    /// Elastic energy of the lines [J].
    pub elastic: f64,
    /// Potential of gravity and of the seabed's springs [J].
    pub potential: f64,
    /// Power of drag [W].
    pub drag: f64,
    /// Power of the added mass of elements and bodies [W].
    pub added_mass: f64,
    /// Power of buoyancy [W].
    pub buoyancy: f64,
    /// Power of the seabed's damping and friction [W].
    pub seabed: f64,
    /// Power of structural damping [W].
    pub structural_damping: f64,
    /// Power of the moved ends [W].
    pub moved_ends: f64,
    /// Power of point loads [W].
    pub loads: f64,
}

impl EnergyTerms {
    /// Adds kinetic and potential energy of a frame or lump, and the powers of its loads.
    pub(crate) fn add(&mut self, (kinetic, potential, powers): (f64, f64, LoadPowers)) {
        self.kinetic += kinetic;
        self.potential += potential;
        self.drag += powers.drag;
        self.added_mass += powers.added_mass;
        self.buoyancy += powers.buoyancy;
        self.seabed += powers.seabed_damping;
    }

    /// Sum of the energies [J].
    pub fn stored(&self) -> f64 {
        self.kinetic + self.elastic + self.potential
    }

    /// All powers, in the order of the account.
    pub fn powers(&self) -> [f64; 7] {
        [
            self.drag,
            self.added_mass,
            self.buoyancy,
            self.seabed,
            self.structural_damping,
            self.moved_ends,
            self.loads,
        ]
    }
}

impl SystemSolver<'_> {
    /// Energies and powers at `state`, which was the last one assembled.
    pub fn energy_terms(&self, time: f64, state: &MotionState) -> EnergyTerms {
        let at = self.situation(time, state);
        let mut terms = EnergyTerms::default();
        self.lines.add_energy(&at, &mut terms);
        terms.add(frame_energies(&at, &self.system.body_batches));
        for lump in &self.system.lumps {
            let motion = frames::lump_carrier(state, lump);
            terms.add(frames::lump_energy(lump, &motion, &at.sea));
        }
        terms.loads = loads::power(self.system, &self.load_factors, state);
        terms
    }
}
