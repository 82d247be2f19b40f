//! A family of nested meshes and halved steps, refined until the errors meet the target.
//!
//! Every element of a member is one of the next split in two, so that Richardson extrapolation
//! finds the order that is there. This is for statics, and for motions of which bending is wanted.
//!
//! Source: docs/theory/accuracy.md, eqs. (1) to (6).

use std::collections::BTreeMap;

use catenix_model::{Line, Model, Reference, StepControl};
use catenix_results::ErrorEstimate;

use super::mesh::{Density, remeshed};
use super::{Chosen, Headline, compute, no_estimate};
use crate::case::Halt;
use crate::watch::Watch;

/// Elements of each section on the mesh whose solution shows where the lines bend.
const FIRST_ELEMENTS: f64 = 16.0;
/// Rounds of adapting the mesh to the static shape.
const ROUNDS: usize = 3;
/// Most splits of an element.
const MOST_SPLITS: usize = 7;
/// Most halvings of the step.
const MOST_HALVINGS: usize = 8;
/// Most elements of a mesh that is tried.
const MOST_ELEMENTS: usize = 50_000;
/// Local error that the coarsest steps may have, over the system's reference length.
const COARSEST_STEP_ERROR: f64 = 1.6e-4;
/// Largest of the coarsest steps [s].
const COARSEST_STEP: f64 = 0.8;
/// Factor of safety on errors of which the order is observed.
const SAFETY: f64 = 1.25;
/// Share of the wanted accuracy that the step may take.
const STEP_SHARE: f64 = 0.5;
/// Smallest step [s].
const SMALLEST_STEP: f64 = 1e-5;

/// A member of the family: splits of the elements and halvings of the step.
type Member = (usize, usize);

/// Meshes and steps of one case, and what has been computed with them.
pub(super) struct Family<'w> {
    model: Model,
    references: Vec<Reference>,
    densities: Vec<Density>,
    computed: BTreeMap<Member, Vec<Headline>>,
    watch: &'w dyn Watch,
}

impl<'w> Family<'w> {
    /// Lets the coarsest mesh follow the static shape, and then the motion.
    pub(super) fn adapted_to(
        mut model: Model,
        references: Vec<Reference>,
        watch: &'w dyn Watch,
    ) -> Result<Family<'w>, Halt> {
        if let Some(dynamics) = &model.dynamics {
            // No output binds the steps of a trial.
            model.output.interpolate = true;
            model.output.interval = dynamics.duration;
            model.output.field_interval = dynamics.duration;
        }
        let sections = |line: &Line| line.sections.len() as f64;
        let densities = model
            .lines
            .iter()
            .map(|line| Density::uniform(line, FIRST_ELEMENTS * sections(line)))
            .collect();
        let mut family = Family {
            model,
            references,
            densities,
            computed: BTreeMap::new(),
            watch,
        };
        let dynamics = family.model.dynamics.take();
        for _ in 0..ROUNDS {
            family.adapt()?;
        }
        if dynamics.is_some() {
            family.model.dynamics = dynamics;
            family.adapt()?;
        }
        Ok(family)
    }

    /// Computes the coarsest member, and adapts the mesh to what it does.
    fn adapt(&mut self) -> Result<(), Halt> {
        let mut split = 0;
        loop {
            let model = self.model_of((split, 0));
            match compute(&model, &self.references, self.watch) {
                Ok(collector) => {
                    let bent = collector.curvatures().iter();
                    self.densities = model
                        .lines
                        .iter()
                        .zip(bent)
                        .map(|(line, curvatures)| Density::from_curvature(line, curvatures))
                        .collect();
                    return Ok(());
                }
                // Where a coarse mesh has no solution, a finer one may.
                Err(Halt::Failed(_)) if split < 3 => split += 1,
                Err(halt) => return Err(halt),
            }
        }
    }

    fn model_of(&self, (splits, halvings): Member) -> Model {
        let mut model = remeshed(&self.model, &self.densities, 1 << splits);
        if let Some(dynamics) = &mut model.dynamics {
            let factor = 0.5f64.powi(halvings as i32);
            dynamics.step = StepControl::Adaptive {
                // The local error of a second-order method falls with the cube of the step.
                accuracy: COARSEST_STEP_ERROR * factor.powi(3),
                min: SMALLEST_STEP,
                max: COARSEST_STEP * factor,
            };
        }
        model
    }

    /// The member that meets the target, or the best.
    pub(super) fn choose(mut self, target: f64) -> Result<Chosen, Halt> {
        let (member, estimates) = self.search(target)?;
        Ok(Chosen {
            model: self.model_of(member),
            estimates,
            trials: self.computed.len(),
        })
    }

    /// Goes through the family until a member meets the target, or to its end.
    ///
    /// The step comes first, on the coarsest mesh, for steps that are too long disturb what the
    /// meshes are compared by.
    fn search(&mut self, target: f64) -> Result<(Member, Vec<ErrorEstimate>), Halt> {
        let moves = self.model.dynamics.is_some();
        let mut member: Member = (1, usize::from(moves));
        let mut best = None;
        loop {
            let mut finer = (1, usize::from(moves));
            match self.estimates(member) {
                Ok(estimates) => {
                    let steering = estimates.iter().filter(|e| e.steers);
                    let time = steering.map(|e| e.time_error / e.scale).fold(0.0, f64::max);
                    let met = estimates.iter().all(|e| e.meets(target));
                    best = Some((member, estimates));
                    if met {
                        break;
                    }
                    let step_first = moves && time > STEP_SHARE * target;
                    finer = if step_first { (0, 1) } else { (1, 0) };
                }
                Err(Halt::Failed(error)) => {
                    if member.0 >= MOST_SPLITS || member.1 >= MOST_HALVINGS {
                        return best.ok_or(Halt::Failed(error));
                    }
                }
                Err(interrupted) => return Err(interrupted),
            }
            member = (member.0 + finer.0, member.1 + finer.1);
            let elements: usize = self
                .model_of(member)
                .lines
                .iter()
                .map(Line::element_count)
                .sum();
            if member.0 > MOST_SPLITS || member.1 > MOST_HALVINGS || elements > MOST_ELEMENTS {
                break;
            }
        }
        best.ok_or_else(|| Halt::Failed(no_estimate()))
    }

    /// Errors of a member against its coarser neighbours.
    fn estimates(&mut self, (splits, halvings): Member) -> Result<Vec<ErrorEstimate>, Halt> {
        let fine = self.results((splits, halvings))?;
        let coarse = self.results((splits - 1, halvings))?;
        let coarser = if splits > 1 {
            Some(self.results((splits - 2, halvings))?)
        } else {
            None
        };
        let longer_steps = if halvings > 0 {
            Some(self.results((splits - 1, halvings - 1))?)
        } else {
            None
        };
        let longest_steps = if halvings > 1 {
            Some(self.results((splits - 1, halvings - 2))?)
        } else {
            None
        };
        let find = |list: &[Headline], name: &str| {
            let found = list.iter().find(|headline| headline.name == name);
            found.map(|headline| headline.value)
        };
        let estimates = fine.iter().filter_map(|headline| {
            let value_of = |list: &[Headline]| find(list, &headline.name).unwrap_or(f64::NAN);
            let middle = value_of(&coarse);
            let estimate = ErrorEstimate {
                result: headline.name.clone(),
                unit: headline.unit.to_owned(),
                value: headline.value,
                scale: headline.scale,
                space_error: richardson(
                    headline.value,
                    middle,
                    coarser.as_ref().map(|list| value_of(list)),
                ),
                time_error: longer_steps.as_ref().map_or(0.0, |list| {
                    richardson(
                        middle,
                        value_of(list),
                        longest_steps.as_ref().map(|list| value_of(list)),
                    )
                }),
                steers: headline.steers,
            };
            // A range that is too small to be a headline result on some member has no estimate.
            estimate.relative().is_finite().then_some(estimate)
        });
        Ok(estimates.collect())
    }

    fn results(&mut self, member: Member) -> Result<Vec<Headline>, Halt> {
        if let Some(known) = self.computed.get(&member) {
            return Ok(known.clone());
        }
        let model = self.model_of(member);
        let elements: usize = model.lines.iter().map(Line::element_count).sum();
        self.watch.trial(self.computed.len() + 1, elements);
        let headlines = compute(&model, &self.references, self.watch)?.headlines();
        self.computed.insert(member, headlines.clone());
        Ok(headlines)
    }
}

/// Error of `fine` by Richardson extrapolation from results with elements or steps twice and four
/// times the size.
///
/// Source: docs/theory/accuracy.md, eqs. (5) and (6).
fn richardson(fine: f64, coarse: f64, coarser: Option<f64>) -> f64 {
    let last = (fine - coarse).abs();
    let Some(coarser) = coarser else {
        // One difference shows no order: first order is the safe guess.
        return last;
    };
    let before = (coarse - coarser).abs();
    let ratio = before / last.max(1e-300);
    // Orders from one half to two are taken as they are; beyond, second order is the safe guess,
    // and a change that is small by chance leaves 3 / 16 of the second-order estimate.
    let gain = ratio.clamp(std::f64::consts::SQRT_2, 4.0) - 1.0;
    SAFETY * (last / gain).max(before / 64.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_of_known_order_are_found_within_a_factor_of_two() {
        for order in [1.0f64, 1.5, 2.0, 3.0, 4.0] {
            let value = |h: f64| 5.0 + 0.3 * h.powf(order);
            let error = 0.3 * 0.25f64.powf(order);
            let estimate = richardson(value(0.25), value(0.5), Some(value(1.0)));
            assert!(error <= 2.0 * estimate, "order {order}: {estimate}");
            assert!(estimate <= 8.0 * error, "order {order}: {estimate}");
        }
    }
}
