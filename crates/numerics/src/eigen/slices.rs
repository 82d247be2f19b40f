//! The spectrum in slices: counts at shifts say how many eigenvalues lie between them, and each
//! slice is searched until all are found.

use std::ops::ControlFlow;

use super::lanczos::{Random, about_shift};
use super::pencil::Pencil;
use super::{Eigenpair, add_scaled};

/// Most eigenvalues of a slice, unless they are too close to be cut.
const SLICE: usize = 14;
/// Width of a slice, over its place, that is cut no further.
const NARROWEST: f64 = 1e-9;
/// Where in a slice the shifts of successive runs are, before it is cut in two: never in the middle, where a slice about zero has its
/// eigenvalues.
const SHIFTS: [f64; 6] = [0.53, 0.31, 0.69, 0.12, 0.88, 0.43];
/// Relative distance of eigenvalues whose vectors are made orthogonal if they come from different
/// slices: further apart, their own accuracy does it.
const NEIGHBOURS: f64 = 1e-4;

/// Number of eigenvalues below a value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Count {
    /// The value.
    pub at: f64,
    /// Eigenvalues below it.
    pub below: usize,
}

/// Why eigenvalues were not found.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum EigenError {
    /// K - sigma M is singular for all sigma near this one.
    Singular {
        /// The shift.
        shift: f64,
    },
    /// The iteration and the count do not agree.
    Incomplete {
        /// Where the slice begins and ends.
        slice: [f64; 2],
        /// Eigenvalues in it, by count.
        counted: usize,
        /// Eigenvalues that the iteration found.
        found: usize,
    },
    /// More eigenvalues are asked for than there are.
    TooMany {
        /// How many there are.
        available: usize,
    },
    /// The caller stopped the search.
    Interrupted,
}

/// A search for eigenvalues, with all counts so far.
pub struct Spectrum<'p, 'a, 'c> {
    pencil: &'p mut Pencil<'a>,
    progress: &'c mut dyn FnMut(usize) -> ControlFlow<()>,
    found: usize,
    random: Random,
    /// Factorisations so far.
    pub factorisations: usize,
}

impl<'p, 'a, 'c> Spectrum<'p, 'a, 'c> {
    /// A search that tells `progress` the number of eigenvalues found so far, and may be stopped
    /// by it.
    pub fn new(
        pencil: &'p mut Pencil<'a>,
        progress: &'c mut dyn FnMut(usize) -> ControlFlow<()>,
    ) -> Self {
        Spectrum {
            pencil,
            progress,
            found: 0,
            random: Random::new(1),
            factorisations: 0,
        }
    }

    /// Counts the eigenvalues below `sigma`.
    ///
    /// # Errors
    /// [`EigenError::Singular`], [`EigenError::Interrupted`].
    pub fn count(&mut self, sigma: f64) -> Result<Count, EigenError> {
        if (self.progress)(self.found).is_break() {
            return Err(EigenError::Interrupted);
        }
        self.factorisations += 1;
        let below = self.pencil.factorise(sigma);
        let below = below.ok_or(EigenError::Singular { shift: sigma })?;
        let at = self.pencil.shift();
        Ok(Count { at, below })
    }

    /// A value with at least `wanted` eigenvalues between `low` and it, and not many more.
    ///
    /// # Errors
    /// [`EigenError::TooMany`] and those of [`Self::count`].
    pub fn above_lowest(
        &mut self,
        low: Count,
        wanted: usize,
        guess: f64,
    ) -> Result<Count, EigenError> {
        let available = self.pencil.dimension() - low.below;
        if wanted > available {
            return Err(EigenError::TooMany { available });
        }
        let enough = |count: &Count| count.below >= low.below + wanted;
        let mut high = self.count(low.at.max(0.0) + guess)?;
        let mut under = low;
        while !enough(&high) {
            under = high;
            high = self.count(low.at.max(0.0) + 16.0 * (high.at - low.at.max(0.0)))?;
            if !high.at.is_finite() || high.at > 1e30 {
                return Err(EigenError::TooMany { available });
            }
        }
        let most = low.below + wanted + (wanted / 4).max(2);
        while high.below > most && high.at - under.at > 1e-6 * high.at {
            let middle = self.count(between(under.at, high.at))?;
            if enough(&middle) {
                high = middle;
            } else {
                under = middle;
            }
        }
        Ok(high)
    }

    /// All eigenpairs between two counts, in ascending order.
    ///
    /// # Errors
    /// [`EigenError`]; never fewer pairs than the counts promise.
    pub fn between(&mut self, low: Count, high: Count) -> Result<Vec<Eigenpair>, EigenError> {
        let mut pairs = Vec::new();
        let mut slices = vec![(low, high)];
        // The last slice of the list is the lowest that is open.
        while let Some((low, high)) = slices.pop() {
            let counted = high.below.saturating_sub(low.below);
            let narrow = high.at - low.at < NARROWEST * high.at.abs().max(low.at.abs());
            if counted > SLICE && !narrow {
                let middle = self.count(between(low.at, high.at))?;
                slices.push((middle, high));
                slices.push((low, middle));
                continue;
            }
            let first = pairs.len();
            let done = self.search(low, high, &mut pairs)?;
            let found = pairs.len() - first;
            if done {
                pairs[first..].sort_by(|a, b| a.value.total_cmp(&b.value));
                continue;
            }
            if narrow || found > counted {
                return Err(EigenError::Incomplete {
                    slice: [low.at, high.at],
                    counted,
                    found,
                });
            }
            pairs.truncate(first);
            let middle = self.count(between(low.at, high.at))?;
            slices.push((middle, high));
            slices.push((low, middle));
        }
        self.part_neighbours(&mut pairs);
        Ok(pairs)
    }

    /// Searches one slice; whether all of its eigenvalues were found.
    fn search(
        &mut self,
        low: Count,
        high: Count,
        pairs: &mut Vec<Eigenpair>,
    ) -> Result<bool, EigenError> {
        let counted = high.below.saturating_sub(low.below);
        let first = pairs.len();
        for part in SHIFTS {
            let found = pairs.len() - first;
            if found >= counted {
                break;
            }
            self.count(low.at + part * (high.at - low.at))?;
            let new = about_shift(
                self.pencil,
                [low.at, high.at],
                counted - found,
                &pairs[first..],
                &mut self.random,
            );
            pairs.extend(new);
            self.found = pairs.len();
        }
        Ok(pairs.len() - first == counted)
    }

    /// Vectors of neighbouring eigenvalues from different slices are made orthogonal.
    fn part_neighbours(&mut self, pairs: &mut [Eigenpair]) {
        for k in 1..pairs.len() {
            let (before, rest) = pairs.split_at_mut(k);
            let pair = &mut rest[0];
            for other in before.iter().rev() {
                let distance = (pair.value - other.value).abs();
                if distance > NEIGHBOURS * pair.value.abs() {
                    break;
                }
                let share = self.pencil.product(&other.vector, &pair.vector);
                add_scaled(&mut pair.vector, -share, &other.vector);
            }
            self.pencil.normalise(&mut pair.vector);
        }
    }
}

/// Where to cut: at the mean of the roots, since modes are spread over frequency.
fn between(low: f64, high: f64) -> f64 {
    if low >= 0.0 {
        let (a, b) = (low.sqrt(), high.sqrt());
        // Decades apart, the geometric mean gets nearer.
        let root = if a > 0.0 && b > 100.0 * a {
            (a * b).sqrt()
        } else {
            0.5 * (a + b)
        };
        root * root
    } else {
        low + 0.53 * (high - low)
    }
}
