//! The energy account of a simulation: what is stored, what was done, and what does not add up.
//!
//! Source: docs/theory/energy.md, eqs. (1) to (3).

use crate::system::EnergyTerms;

/// Stored energies at the end and works since the start.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct EnergyAccount {
    /// Kinetic energy at the end [J].
    pub kinetic_j: f64,
    /// Elastic energy at the end [J].
    pub elastic_j: f64,
    /// Potential of gravity and of the seabed's springs at the end, less that at the start [J].
    pub potential_j: f64,
    /// Change of the stored energy since the start [J].
    pub stored_change_j: f64,
    /// Work of drag on the system [J].
    pub work_drag_j: f64,
    /// Work of the added mass of elements and bodies [J].
    pub work_added_mass_j: f64,
    /// Work of buoyancy [J].
    pub work_buoyancy_j: f64,
    /// Work of the seabed's damping and friction [J].
    pub work_seabed_j: f64,
    /// Work of structural damping [J].
    pub work_structural_damping_j: f64,
    /// Work of the moved ends [J].
    pub work_moved_ends_j: f64,
    /// Work of point loads [J].
    pub work_loads_j: f64,
    /// Change of stored energy less all works, over the largest of the energies: moved (the sum of
    /// absolute works of each kind) or held (kinetic and elastic at the end) [-]. Zero for an exact integration.
    pub imbalance: f64,
}

/// Adds up the account over accepted steps.
#[derive(Debug, Clone)]
pub(super) struct EnergyLedger {
    first: EnergyTerms,
    last: EnergyTerms,
    works: [f64; 7],
    moved: [f64; 7],
}

impl EnergyLedger {
    pub(super) fn new(start: EnergyTerms) -> EnergyLedger {
        EnergyLedger {
            first: start,
            last: start,
            works: [0.0; 7],
            moved: [0.0; 7],
        }
    }

    /// Adds a step by the trapezoidal rule on the powers.
    pub(super) fn add(&mut self, step: f64, terms: EnergyTerms) {
        let (old, new) = (self.last.powers(), terms.powers());
        for k in 0..self.works.len() {
            let work = 0.5 * step * (old[k] + new[k]);
            self.works[k] += work;
            self.moved[k] += work.abs();
        }
        self.last = terms;
    }

    /// Goes on with other powers, since the loads have jumped.
    pub(super) fn restart(&mut self, terms: EnergyTerms) {
        self.last = terms;
    }

    pub(super) fn account(&self) -> EnergyAccount {
        let stored_change = self.last.stored() - self.first.stored();
        let total: f64 = self.works.iter().sum();
        let held = self.last.kinetic + self.last.elastic;
        let scale = self
            .moved
            .iter()
            .fold(held.max(stored_change.abs()), |a, &b| a.max(b));
        let [drag, added_mass, buoyancy, seabed, damping, ends, loads] = self.works;
        EnergyAccount {
            kinetic_j: self.last.kinetic,
            elastic_j: self.last.elastic,
            potential_j: self.last.potential - self.first.potential,
            stored_change_j: stored_change,
            work_drag_j: drag,
            work_added_mass_j: added_mass,
            work_buoyancy_j: buoyancy,
            work_seabed_j: seabed,
            work_structural_damping_j: damping,
            work_moved_ends_j: ends,
            work_loads_j: loads,
            imbalance: if scale > 0.0 {
                (stored_change - total) / scale
            } else {
                0.0
            },
        }
    }
}
