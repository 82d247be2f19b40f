//! The equilibrium path of a system as loads are scaled by one factor, through limit points and
//! large post-buckling deformation.
//!
//! Pseudo-arc-length continuation: the factor is an unknown like the motion, and what is given is
//! how far along the path the next point lies. Each Newton iteration is one factorisation and two
//! solutions.
//!
//! Source: docs/theory/path.md.

use std::ops::ControlFlow;

use catenix_model::PathSettings;
use thiserror::Error;

use super::path_step::{Closure, PathScale, PathTangent, PathWalker, StepFailure};
use super::statics::{StaticsError, StaticsProgress, find_equilibrium};
use crate::system::{FrameOwner, LoadControl, StepView, System, SystemSolver};

/// Iterations that a step should take; more shorten the next one.
const WANTED_ITERATIONS: f64 = 4.0;
/// Least cosine of the angle between the tangents at both ends of a step.
const LEAST_TURN: f64 = 0.8;
/// Smallest step, over the first one.
const SMALLEST_STEP: f64 = 1e-6;
/// Step, over the first one, down to which a change of stability is closed in on.
const LOCATED: f64 = 1e-3;
/// Most rounds in which a limit point is closed in on.
const LIMIT_ROUNDS: usize = 30;
/// Slope of the factor along the path, in the path's scale, that counts as none.
const LIMIT_SLOPE: f64 = 1e-7;

/// What happens on the path at a point or since the one before.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PathEvent {
    /// The factor has an extreme at this point.
    Limit,
    /// Another path branches off between the point before and this one.
    Bifurcation,
}

/// A point of the path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathPoint {
    /// Number, starting at 0.
    pub number: usize,
    /// Factor on the loads.
    pub factor: f64,
    /// Distance along the path, in its scale.
    pub distance: f64,
    /// Change of the factor per distance: positive where more load goes with going on.
    pub slope: f64,
    /// Newton iterations from the point before.
    pub iterations: usize,
    /// Largest residual force [N].
    pub residual_n: f64,
    /// Number of motions in which the equilibrium is unstable; right where all loads have a
    /// potential (none follows).
    pub unstable: usize,
    /// What happens here.
    pub event: Option<PathEvent>,
}

/// Why a path ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PathEnd {
    /// The factor left its range.
    Range,
    /// The channel that stops it left its range.
    Channel,
    /// It has as many points as were asked for.
    Points,
    /// The observer stopped it.
    Interrupted,
}

/// What following the path took.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathReport {
    /// Points.
    pub points: usize,
    /// Newton iterations, those of given-up steps included.
    pub iterations: usize,
    /// Factorisations.
    pub factorisations: usize,
    /// Steps that were given up and repeated, shorter.
    pub rejected_steps: usize,
    /// Why it ended.
    pub end: PathEnd,
}

/// Why a path could not be followed.
#[derive(Debug, Clone, Error, PartialEq)]
#[non_exhaustive]
pub enum PathError {
    /// The model has no `[path]`.
    #[error("the model asks for no path: add a [path] table with a range")]
    NoPath,
    /// The first point was not found.
    #[error("the first point of the path, at the factor {factor}: {source}")]
    Start {
        /// Factor of the first point.
        factor: f64,
        /// Why not.
        source: StaticsError,
    },
    /// The path was lost.
    #[error(
        "the path is lost after the factor {factor:.6e}: with a step of {step:.1e} the residual is \
         still {residual_n:.3e} N (allowed {allowed_n:.3e} N) at {owner}. The points so far are \
         kept. What to try: a smaller max_step, shorter elements where the line bends, or a small \
         load that breaks a symmetry"
    )]
    Lost {
        /// Factor of the last point.
        factor: f64,
        /// Step that failed, in the path's scale.
        step: f64,
        /// Residual when it was given up [N].
        residual_n: f64,
        /// Residual allowed [N].
        allowed_n: f64,
        /// Where it is.
        owner: FrameOwner,
        /// Points until then.
        points: usize,
    },
}

/// Follows the path of the model's `[path]`.
///
/// `progress` is called while the first point is sought, `observer` at every point; both may stop.
///
/// # Errors
/// [`PathError`]; the observer has seen every point until then.
pub fn follow_path(
    system: &System,
    progress: &mut dyn FnMut(&StaticsProgress) -> ControlFlow<()>,
    observer: &mut dyn FnMut(&PathPoint, &StepView<'_>) -> ControlFlow<()>,
) -> Result<PathReport, PathError> {
    let settings = system.model().path.as_ref().ok_or(PathError::NoPath)?;
    let mut solver = SystemSolver::at_rest(system, system.model().statics.current);
    solver.control_loads(LoadControl {
        loads: settings.loads.clone(),
        factor: settings.start,
    });
    let start = find_equilibrium(solver, progress).map_err(|source| PathError::Start {
        factor: settings.start,
        source,
    })?;
    let scale = PathScale {
        length: system.reference_length(),
        factor: settings.range[1] - settings.range[0],
        pairs: system.pair_count(),
    };
    let mut walker = PathWalker::new(start.solver, start.state, settings.start, scale);
    walker.allowed = system.allowed_residual(settings.tolerance);
    walker.max_iterations = settings.max_iterations;
    Path {
        settings,
        walker,
        observer,
        step: settings.first_step,
        distance: 0.0,
        points: 0,
        rejected: 0,
    }
    .follow()
}

struct Path<'p, 's> {
    settings: &'p PathSettings,
    walker: PathWalker<'s>,
    observer: &'p mut dyn FnMut(&PathPoint, &StepView<'_>) -> ControlFlow<()>,
    /// Length of the step to try.
    step: f64,
    distance: f64,
    points: usize,
    rejected: usize,
}

/// A point that a step has reached.
struct Reached {
    tangent: PathTangent,
    /// Length of the step.
    length: f64,
    iterations: usize,
    event: Option<PathEvent>,
}

impl Path<'_, '_> {
    fn follow(mut self) -> Result<PathReport, PathError> {
        let [low, high] = self.settings.range;
        let residual = self.walker.evaluate();
        let Some(mut tangent) = self.walker.tangent() else {
            return Err(self.lost(0.0, &StepFailure { residual }));
        };
        // Towards the end of the range that is further away.
        if self.settings.start - low > high - self.settings.start {
            reverse(&mut tangent);
        }
        let first = Reached {
            tangent: tangent.clone(),
            length: 0.0,
            iterations: 0,
            event: None,
        };
        let mut end = self.show(&first);
        while end.is_none() {
            self.walker.settle();
            let reached = self.advance(&tangent)?;
            self.distance += reached.length;
            end = self.show(&reached);
            tangent = reached.tangent;
        }
        Ok(PathReport {
            points: self.points,
            iterations: self.walker.iterations,
            factorisations: self.walker.solver.factorisations(),
            rejected_steps: self.rejected,
            end: end.unwrap_or(PathEnd::Points),
        })
    }

    /// The next point, with shorter steps where one fails.
    fn advance(&mut self, tangent: &PathTangent) -> Result<Reached, PathError> {
        loop {
            match self.attempt(tangent, self.step) {
                Ok(reached) => {
                    let ease = WANTED_ITERATIONS / reached.iterations.max(1) as f64;
                    let grown = self.step * ease.sqrt().clamp(0.5, 2.0);
                    self.step = grown.min(self.settings.max_step);
                    return Ok(reached);
                }
                Err(failure) => {
                    self.rejected += 1;
                    self.walker.go_back();
                    if self.step < SMALLEST_STEP * self.settings.first_step {
                        return Err(self.lost(self.step, &failure));
                    }
                    self.step *= 0.4;
                }
            }
        }
    }

    /// A step of this length, ended on a wanted factor or on a limit point that it meets.
    fn attempt(&mut self, tangent: &PathTangent, length: f64) -> Result<Reached, StepFailure> {
        let before = self.walker.factor;
        let mut reached = self.reach(tangent, &Closure::Distance(tangent, length), length)?;
        if reached.tangent.factor * tangent.factor < 0.0 {
            reached = self.close_in_on_limit(tangent, reached)?;
        }
        if let Some(wanted) = self.first_wanted(before, self.walker.factor) {
            let share = (wanted - before) / (self.walker.factor - before);
            let iterations = reached.iterations;
            reached = self.reach(tangent, &Closure::Factor(wanted), length * share)?;
            reached.iterations = reached.iterations.max(iterations);
        }
        if reached.event.is_none() && reached.tangent.unstable != tangent.unstable {
            // A branch point, or a jump to another path: short steps tell.
            if length > LOCATED * self.settings.first_step {
                let residual = self.walker.evaluate();
                return Err(StepFailure { residual });
            }
            reached.event = Some(PathEvent::Bifurcation);
        }
        Ok(reached)
    }

    /// Takes one step and finds the tangent at its end, turned the way the path goes.
    fn reach(
        &mut self,
        tangent: &PathTangent,
        closure: &Closure<'_>,
        length: f64,
    ) -> Result<Reached, StepFailure> {
        let iterations = self.walker.step(closure)?;
        let residual = self.walker.evaluate();
        let failure = StepFailure { residual };
        let mut next = self.walker.tangent().ok_or(failure)?;
        let mut turn = next.along(tangent, &self.walker.scale);
        if turn < 0.0 {
            reverse(&mut next);
            turn = -turn;
        }
        if turn < LEAST_TURN {
            return Err(failure);
        }
        Ok(Reached {
            tangent: next,
            length,
            iterations,
            event: None,
        })
    }

    /// Finds the point between the start of the step and its end at which the factor turns round,
    /// by false position on its slope (with the Illinois rule).
    fn close_in_on_limit(
        &mut self,
        tangent: &PathTangent,
        mut end: Reached,
    ) -> Result<Reached, StepFailure> {
        let (iterations, behind) = (end.iterations, end.tangent.unstable);
        let (mut low, mut low_slope) = (0.0, tangent.factor);
        let (mut high, mut high_slope) = (end.length, end.tangent.factor);
        for _ in 0..LIMIT_ROUNDS {
            if end.tangent.factor.abs() <= LIMIT_SLOPE * self.walker.scale.factor {
                break;
            }
            let middle = low + (high - low) * low_slope / (low_slope - high_slope);
            end = self.reach(tangent, &Closure::Distance(tangent, middle), middle)?;
            let slope = end.tangent.factor;
            if slope * low_slope > 0.0 {
                (low, low_slope) = (middle, slope);
                high_slope *= 0.5;
            } else {
                (high, high_slope) = (middle, slope);
                low_slope *= 0.5;
            }
        }
        // The start of the next step must lie behind the limit, or it would be met again.
        if end.tangent.factor * tangent.factor > 0.0 {
            end.tangent.factor = -end.tangent.factor;
        }
        // At a limit one eigenvalue vanishes; behind it, it has the other sign.
        end.tangent.unstable = behind;
        end.event = Some(PathEvent::Limit);
        end.iterations = iterations;
        Ok(end)
    }

    /// The first wanted factor, or end of the range, between two factors.
    fn first_wanted(&self, from: f64, to: f64) -> Option<f64> {
        let slack = 1e-9 * self.walker.scale.factor;
        let wanted = self.settings.at.iter().chain(&self.settings.range).copied();
        let between = wanted.filter(|&factor| {
            (factor - from) * (to - from) > 0.0
                && (factor - from).abs() > slack
                && (factor - from).abs() < (to - from).abs() - slack
        });
        between.min_by(|a, b| (a - from).abs().total_cmp(&(b - from).abs()))
    }

    /// Shows the current point; what ends the path here, if anything.
    fn show(&mut self, reached: &Reached) -> Option<PathEnd> {
        let residual = self.walker.evaluate();
        let point = PathPoint {
            number: self.points,
            factor: self.walker.factor,
            distance: self.distance,
            slope: reached.tangent.factor,
            iterations: reached.iterations,
            residual_n: residual.newtons,
            unstable: reached.tangent.unstable,
            event: reached.event,
        };
        self.points += 1;
        let view = StepView {
            solver: &self.walker.solver,
            state: &self.walker.state,
            time: 0.0,
            step: 0.0,
            at_output_time: true,
            at_field_time: true,
        };
        let stopped = self.settings.stop.as_ref().is_some_and(|stop| {
            let value = view.channel(stop.channel.target);
            !(stop.range[0]..=stop.range[1]).contains(&value)
        });
        if (self.observer)(&point, &view).is_break() {
            return Some(PathEnd::Interrupted);
        }
        let [low, high] = self.settings.range;
        let slack = 1e-9 * (high - low);
        let forward = reached.tangent.factor;
        if (point.factor >= high - slack && forward > 0.0)
            || (point.factor <= low + slack && forward < 0.0)
        {
            return Some(PathEnd::Range);
        }
        if stopped {
            return Some(PathEnd::Channel);
        }
        (self.points >= self.settings.max_points).then_some(PathEnd::Points)
    }

    fn lost(&self, step: f64, failure: &StepFailure) -> PathError {
        PathError::Lost {
            factor: self.walker.factor,
            step,
            residual_n: failure.residual.newtons,
            allowed_n: self.walker.allowed,
            owner: self.walker.solver.system().owner(failure.residual.frame),
            points: self.points,
        }
    }
}

fn reverse(tangent: &mut PathTangent) {
    tangent.factor = -tangent.factor;
    tangent.motion.iter_mut().for_each(|d| *d = -*d);
}
