//! Energies of the system and the powers that change them, for the energy account.

use catenix_numerics::MotionState;

use super::assembly::frame_motion;
use super::frames::{self, LoadPowers};
use super::loads;
use super::solver::SystemSolver;
use super::{Carrier, Mount};

/// Energies and powers at one instant.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct EnergyTerms {
    /// Kinetic energy of the structure; of lumps with their added mass [J].
    pub kinetic: f64,
    /// Elastic energy of the connectors [J].
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
        let sea = self.sea(time);
        let mut terms = EnergyTerms::default();
        let mut add = |(kinetic, potential, powers): (f64, f64, LoadPowers)| {
            terms.kinetic += kinetic;
            terms.potential += potential;
            terms.drag += powers.drag;
            terms.added_mass += powers.added_mass;
            terms.buoyancy += powers.buoyancy;
            terms.seabed += powers.seabed_damping;
        };
        for (k, frame) in self.system.frames.iter().enumerate() {
            add(frames::frame_energy(frame, &frame_motion(state, k), &sea));
        }
        for lump in &self.system.lumps {
            add(frames::lump_energy(
                lump,
                &frame_motion(state, lump.frame),
                &sea,
            ));
        }
        terms.loads = loads::power(self.system, &self.load_factors, state);
        for (pair, connector) in self.pairs.iter().zip(&self.system.connectors) {
            terms.elastic += pair.energy(&connector.law);
            terms.structural_damping += pair.damping_power();
            let forces = pair.forces();
            for (mount, force) in [
                (&connector.first, &forces.first),
                (&connector.second, &forces.second),
            ] {
                let Mount {
                    carrier: Carrier::Vessel(vessel),
                    ..
                } = mount
                else {
                    continue;
                };
                let motion = &self.vessels[*vessel];
                terms.moved_ends += force.fixed_rows::<3>(0).dot(&motion.velocity)
                    + force.fixed_rows::<3>(3).dot(&motion.spin);
            }
        }
        terms
    }
}
