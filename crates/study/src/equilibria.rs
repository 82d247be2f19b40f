//! Equilibria that the load cases of a study have in common.

use std::sync::{Mutex, PoisonError};

use catenix_engine::{Equilibrium, StaticSolution, System};

use crate::case::Halt;

/// Most equilibria that are kept: cases that have one in common usually follow one another, and
/// each case may need two, without and with the tension known.
const MOST_KEPT: usize = 8;

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
    /// The equilibrium of a system: one of those that are known, or what `find` finds.
    pub(crate) fn of_or_find<'a>(
        &self,
        system: &'a System,
        find: impl FnOnce() -> Result<StaticSolution<'a>, Halt>,
    ) -> Result<StaticSolution<'a>, Halt> {
        let latest = || self.latest.lock().unwrap_or_else(PoisonError::into_inner);
        let known = latest().iter().rev().find_map(|found| found.of(system));
        if let Some(known) = known {
            return Ok(known);
        }
        let found = find()?;
        let mut latest = latest();
        if latest.len() == MOST_KEPT {
            latest.remove(0);
        }
        latest.push(Equilibrium::new(&found));
        Ok(found)
    }
}
