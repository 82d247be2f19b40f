//! Mesh and step of a motion, planned line by line from what each costs and gains.
//!
//! A few cheap runs say how much of every result's error each line and the step have. From them
//! follow the cheapest element numbers and step that should do, and runs with all elements and all
//! steps halved say whether they do.
//!
//! Source: docs/theory/accuracy.md, eqs. (7) to (10).

use catenix_model::{Line, Model, Motion, Reference, StepControl};
use catenix_results::ErrorEstimate;

use super::mesh::evenly;
use super::{Chosen, Headline, compute, no_estimate};
use crate::case::Halt;
use crate::watch::Watch;

/// Elements of a line in the runs that errors are planned from.
const FIRST_ELEMENTS: f64 = 8.0;
/// Elements of each span between lumps, at least, in those runs.
const FIRST_IN_SPAN: f64 = 4.0;
/// Elements of a line in those runs, at most.
const MOST_FIRST: f64 = 100.0;
/// Lines that are planned one by one, at most; more are planned together.
const MOST_GROUPS: usize = 4;
/// Largest step, over the shortest period of the motions [-], and without one [s].
const STEPS_PER_PERIOD: f64 = 12.0;
const LARGEST_STEP: f64 = 1.0;
/// Local error that the largest steps may have, over the system's reference length.
const LARGEST_STEP_ERROR: f64 = 2e-4;
/// Smallest step [s].
const SMALLEST_STEP: f64 = 1e-5;
/// Error of a run over its difference from one with halved elements: holds from first order on.
const HALVED_ELEMENTS: f64 = 2.0;
/// The same with halved steps: holds for orders from 1.6 on.
const HALVED_STEPS: f64 = 1.5;
/// Share of the target of the first plan, of the second, which knows more, and what is left of that
/// after each further plan that missed.
const PLANNED_SHARE: f64 = 0.8;
const NEXT_SHARE: f64 = 0.95;
const LESS: f64 = 0.93;
/// Plans that are tried.
const MOST_PLANS: usize = 8;
/// Most growth of an error over what was planned that is believed.
const MOST_SURPRISE: f64 = 8.0;
/// One trade of elements against steps.
const TRADE: f64 = 1.03;
const MOST_TRADES: usize = 2000;
/// Most elements of a mesh that is tried.
const MOST_ELEMENTS: f64 = 20_000.0;

/// Runs of one motion, and what they say.
pub(super) struct Planner<'w> {
    model: Model,
    references: Vec<Reference>,
    /// Lines that are planned together.
    groups: Vec<Vec<usize>>,
    largest_step: f64,
    trials: usize,
    watch: &'w dyn Watch,
}

/// Wanted elements of every line, and the step over the largest.
#[derive(Debug, Clone, PartialEq)]
struct Set {
    elements: Vec<f64>,
    step: f64,
}

/// A run's results, and the elements that its lines had.
struct Run {
    elements: Vec<f64>,
    headlines: Vec<Headline>,
}

/// How the error of one result is made up, of a first run.
struct Shares {
    scale: f64,
    /// By the elements of each group.
    space: Vec<f64>,
    /// By the step.
    time: f64,
}

impl<'w> Planner<'w> {
    pub(super) fn new(
        mut model: Model,
        references: Vec<Reference>,
        watch: &'w dyn Watch,
    ) -> Planner<'w> {
        if let Some(dynamics) = &model.dynamics {
            // No output binds the steps of a trial.
            model.output.interpolate = true;
            model.output.interval = dynamics.duration;
            model.output.field_interval = dynamics.duration;
        }
        let lines = 0..model.lines.len();
        let groups = if lines.len() <= MOST_GROUPS {
            lines.map(|line| vec![line]).collect()
        } else {
            vec![lines.collect()]
        };
        let largest_step = (shortest_period(&model) / STEPS_PER_PERIOD).min(LARGEST_STEP);
        Planner {
            model,
            references,
            groups,
            largest_step,
            trials: 0,
            watch,
        }
    }

    /// Elements for a first run, and the largest step.
    fn first(&self) -> Set {
        let of_line = |line: &Line| {
            let spans = line.sections.len() + line.attachments.len();
            FIRST_ELEMENTS
                .max(FIRST_IN_SPAN * spans as f64)
                .min(MOST_FIRST)
        };
        Set {
            elements: self.model.lines.iter().map(of_line).collect(),
            step: 1.0,
        }
    }

    /// The model of a set, with the elements of some groups halved, and the step shortened.
    fn model_of(&self, set: &Set, halved: &[usize], shortening: f64) -> Model {
        let mut model = self.model.clone();
        for (group, lines) in self.groups.iter().enumerate() {
            let split = 1 + usize::from(halved.contains(&group));
            for &line in lines {
                model.lines[line] = evenly(&model.lines[line], set.elements[line], split);
            }
        }
        let factor = set.step * shortening;
        if let Some(dynamics) = &mut model.dynamics {
            dynamics.step = StepControl::Adaptive {
                // The local error of a second-order method falls with the cube of the step.
                accuracy: LARGEST_STEP_ERROR * factor.powi(3),
                min: SMALLEST_STEP.min(self.largest_step * factor),
                max: self.largest_step * factor,
            };
        }
        model
    }

    fn run(&mut self, set: &Set, halved: &[usize], shortening: f64) -> Result<Run, Halt> {
        let model = self.model_of(set, halved, shortening);
        let elements: Vec<f64> = model
            .lines
            .iter()
            .map(|line| line.element_count() as f64)
            .collect();
        self.trials += 1;
        self.watch
            .trial(self.trials, elements.iter().sum::<f64>() as usize);
        let headlines = compute(&model, &self.references, self.watch)?.headlines();
        Ok(Run {
            elements,
            headlines,
        })
    }

    /// The cheapest set that meets the target, with its estimates; the best found where none does.
    pub(super) fn choose(mut self, target: f64) -> Result<Chosen, Halt> {
        let mut first = self.first();
        let mut base = self.run(&first, &[], 1.0);
        // Where few elements have no solution, more may.
        for _ in 0..3 {
            if let Err(Halt::Failed(_)) = base {
                first.elements.iter_mut().for_each(|count| *count *= 2.0);
                base = self.run(&first, &[], 1.0);
            }
        }
        let base = base?;
        let mut shares = self.shares(&first, &base)?;
        let every: Vec<usize> = (0..self.groups.len()).collect();
        let (mut share, mut next) = (PLANNED_SHARE, NEXT_SHARE);
        let mut best: Option<(f64, Set, Vec<ErrorEstimate>)> = None;
        let mut last = None;
        for _ in 0..MOST_PLANS {
            let set = self.plan(&shares, &base, share * target);
            (share, next) = (next, LESS * next);
            if last.as_ref() == Some(&set) || set.elements.iter().sum::<f64>() > MOST_ELEMENTS {
                break;
            }
            let estimates = match self.checked(&set, &every) {
                Ok(found) => found,
                // A set without a solution is no choice; the next plan is finer.
                Err(Halt::Failed(_)) => continue,
                Err(halt) => return Err(halt),
            };
            let (elements, estimates) = estimates;
            let steering = estimates.iter().filter(|estimate| estimate.steers);
            let worst = steering.map(ErrorEstimate::relative).fold(0.0, f64::max);
            learn(
                &mut shares,
                &estimates,
                &base,
                &elements,
                set.step,
                &self.groups,
            );
            if best.as_ref().is_none_or(|(least, ..)| worst < *least) {
                best = Some((worst, set.clone(), estimates));
            }
            if worst <= target {
                break;
            }
            last = Some(set);
        }
        let (_, set, estimates) = best.ok_or_else(|| Halt::Failed(no_estimate()))?;
        Ok(Chosen {
            model: self.model_of(&set, &[], 1.0),
            estimates,
            trials: self.trials,
        })
    }

    /// What every line and the step have of each steering result's error.
    ///
    /// Source: docs/theory/accuracy.md, eq. (8).
    fn shares(&mut self, first: &Set, base: &Run) -> Result<Vec<(String, Shares)>, Halt> {
        let mut finer = Vec::new();
        for group in 0..self.groups.len() {
            finer.push(self.run(first, &[group], 1.0)?);
        }
        let shorter = self.run(first, &[], 0.5)?;
        let steering = base.headlines.iter().filter(|headline| headline.steers);
        let shares = steering.map(|headline| {
            let change = |run: &Run| difference(headline, &run.headlines);
            let shares = Shares {
                scale: headline.scale,
                space: finer
                    .iter()
                    .map(|run| HALVED_ELEMENTS * change(run))
                    .collect(),
                time: HALVED_STEPS * change(&shorter),
            };
            (headline.name.clone(), shares)
        });
        Ok(shares.collect())
    }

    /// The cheapest set of which second order promises an error.
    ///
    /// Source: docs/theory/accuracy.md, eq. (9).
    fn plan(&self, shares: &[(String, Shares)], base: &Run, target: f64) -> Set {
        // Begins with too little of everything, and buys where an error falls most for its cost.
        let counts: Vec<f64> = self
            .groups
            .iter()
            .map(|lines| lines.iter().map(|&line| base.elements[line]).sum())
            .collect();
        let mut growth = vec![0.6; counts.len()];
        let mut step = 1.0;
        let worst = |growth: &[f64], step: f64| {
            let of_result = |(_, shares): &(String, Shares)| {
                let space = shares.space.iter().zip(growth);
                let space: f64 = space.map(|(error, growth)| error / (growth * growth)).sum();
                (space + shares.time * step * step) / shares.scale
            };
            shares.iter().map(of_result).fold(0.0, f64::max)
        };
        for _ in 0..MOST_TRADES {
            let now = worst(&growth, step);
            if now <= target {
                break;
            }
            let all: f64 = counts.iter().zip(&growth).map(|(n, g)| n * g).sum();
            // Cost is elements times steps: gains are over the share of it that they take.
            let mut found = (now - worst(&growth, step / TRADE), None);
            for group in 0..growth.len() {
                let mut more = growth.clone();
                more[group] *= TRADE;
                let gain = now - worst(&more, step);
                let gain = gain * all / (counts[group] * growth[group]);
                if gain > found.0 {
                    found = (gain, Some(group));
                }
            }
            match found.1 {
                Some(group) => growth[group] *= TRADE,
                None => step /= TRADE,
            }
        }
        let mut elements = base.elements.clone();
        for (lines, growth) in self.groups.iter().zip(&growth) {
            for &line in lines {
                elements[line] *= growth;
            }
        }
        Set { elements, step }
    }

    /// Errors of a set, from runs with halved elements and with halved steps; and its elements.
    ///
    /// Source: docs/theory/accuracy.md, eq. (10).
    fn checked(
        &mut self,
        set: &Set,
        every: &[usize],
    ) -> Result<(Vec<f64>, Vec<ErrorEstimate>), Halt> {
        let chosen = self.run(set, &[], 1.0)?;
        let finer = self.run(set, every, 1.0)?;
        let shorter = self.run(set, &[], 0.5)?;
        let estimates = chosen.headlines.iter().map(|headline| ErrorEstimate {
            result: headline.name.clone(),
            unit: headline.unit.to_owned(),
            value: headline.value,
            scale: headline.scale,
            space_error: HALVED_ELEMENTS * difference(headline, &finer.headlines),
            time_error: HALVED_STEPS * difference(headline, &shorter.headlines),
            steers: headline.steers,
        });
        // A range that is too small to be a headline result of some run has no estimate.
        let estimates = estimates.filter(|estimate| estimate.relative().is_finite());
        Ok((chosen.elements, estimates.collect()))
    }
}

/// Raises what is thought of errors to what a plan's runs have shown.
fn learn(
    shares: &mut [(String, Shares)],
    estimates: &[ErrorEstimate],
    base: &Run,
    elements: &[f64],
    step: f64,
    groups: &[Vec<usize>],
) {
    for (name, shares) in shares {
        let mut found = estimates.iter().filter(|estimate| estimate.result == *name);
        let Some(estimate) = found.next() else {
            continue;
        };
        let count = |lines: &Vec<usize>, of: &[f64]| lines.iter().map(|&k| of[k]).sum::<f64>();
        let growth = groups
            .iter()
            .map(|lines| count(lines, elements) / count(lines, &base.elements));
        let planned = shares.space.iter().zip(growth);
        let planned: f64 = planned
            .map(|(error, growth)| error / (growth * growth))
            .sum();
        let surprise = |found: f64, planned: f64| {
            let ratio = found / planned.max(1e-300);
            if ratio.is_finite() {
                ratio.clamp(1.0, MOST_SURPRISE)
            } else {
                1.0
            }
        };
        let space = surprise(estimate.space_error, planned);
        shares.space.iter_mut().for_each(|error| *error *= space);
        shares.time *= surprise(estimate.time_error, shares.time * step * step);
    }
}

/// How far a result of another run is from this one; not a number where it has none.
fn difference(headline: &Headline, others: &[Headline]) -> f64 {
    let other = others.iter().find(|other| other.name == headline.name);
    other.map_or(f64::NAN, |other| (headline.value - other.value).abs())
}

/// The shortest period of the harmonic motions that act [s].
fn shortest_period(model: &Model) -> f64 {
    let motions = model.vessels.iter().flat_map(|vessel| &vessel.motions);
    let periods = motions.filter_map(|motion| match motion {
        Motion::Harmonic {
            period, amplitude, ..
        } if *amplitude != 0.0 => Some(*period),
        _ => None,
    });
    periods.fold(f64::INFINITY, f64::min)
}
