//! Equilibria that the load cases of a study have in common.

use std::sync::{Mutex, PoisonError};

use catenix_engine::{Equilibrium, StaticSolution, System};

/// Most equilibria that are kept: cases that have one in common usually follow one another.
const MOST_KEPT: usize = 4;

/// The equilibria of the latest cases, for those that pose the same static problem: they need not
/// find it again.
///
/// What is shared is equal to the last bit to what the case would find by itself, so results do
/// not depend on the order of the cases, nor on the number of threads.
#[derive(Debug, Default)]
pub struct Equilibria {
    latest: Mutex<Vec<Equilibrium>>,
}

impl Equilibria {
    pub(crate) fn of<'a>(&self, system: &'a System) -> Option<StaticSolution<'a>> {
        let latest = self.latest.lock().unwrap_or_else(PoisonError::into_inner);
        latest.iter().rev().find_map(|found| found.of(system))
    }

    pub(crate) fn keep(&self, solution: &StaticSolution<'_>) {
        let mut latest = self.latest.lock().unwrap_or_else(PoisonError::into_inner);
        if latest.len() == MOST_KEPT {
            latest.remove(0);
        }
        latest.push(Equilibrium::new(solution));
    }
}
