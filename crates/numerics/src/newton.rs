//! Newton's method on the residual of one implicit step, common to all integrators.
//!
//! Source: docs/theory/integration.md, eq. (6); docs/theory/solver.md, eqs. (5) to (7a).

use crate::Vector6;
use crate::implicit::{ImplicitSystem, MotionState, ResidualSize, TangentWeights};
use crate::integrator::StepSettings;

/// Newton iterations before the line search looks at their residual.
const UNCHECKED_ITERATIONS: usize = 4;
/// Share of the residual that an iteration with an old matrix may leave, to be worth another one.
const GOOD_REDUCTION: f64 = 0.5;
/// Share of the residual that an iteration with a new matrix may leave, for that matrix to serve
/// again: where it leaves more, the problem bends too much for an old one.
const WORTH_REUSE: f64 = 0.05;
/// Growth of the residual since the first one, after which a solution is given up as lost.
const LOST: f64 = 1e3;
/// Solutions that get new matrices only, after an old one did not do.
const PAUSE: usize = 3;
/// Share of the residual that the first iteration of a solution with a new matrix may leave, for that
/// matrix to serve the next solution as well; or what it may leave over the tolerance.
const HARDLY_BENT: f64 = 1e-4;
const HARDLY_LEFT: f64 = 0.01;
/// Iterations that such a solution may take, for its matrix to serve once more.
const CHEAP: usize = 2;
/// Difference of two steps' sizes with which a matrix serves both, over their size.
const SAME: f64 = 1e-3;
/// Most iterations in a row with an old matrix.
const MOST_REUSES: usize = 3;
/// Most halvings of an increment.
const MOST_HALVINGS: usize = 3;

/// Share of a step's allowed error that a solution may be off by, where its residual is above the
/// tolerance.
const UNSOLVED: f64 = 0.01;
/// Largest residual of such a solution, over the tolerance.
const ABOVE_TOLERANCE: f64 = 10.0;

/// When Newton's method stops.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NewtonSettings {
    /// Largest residual accepted [N]; ten times as much where a step's error is controlled and what
    /// is left to move is little beside it.
    pub tolerance_newtons: f64,
    /// Iterations after which the step is given up.
    pub max_iterations: usize,
}

/// A solution of one step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct NewtonOutcome {
    /// Iterations (matrix solutions).
    pub iterations: usize,
    /// Residual at the end.
    pub residual: ResidualSize,
}

/// Why a step did not converge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NewtonFailure {
    /// Newton iterations done.
    pub iterations: usize,
    /// Residual when it was given up; not finite when the state was lost.
    pub residual: ResidualSize,
    /// Whether the matrix was singular (at `residual.frame`).
    pub singular: bool,
}

/// A step being solved: the trial state at its end, and how an integrator lets Newton's method move it.
pub(crate) trait Stage {
    /// The trial state.
    fn trial(&self) -> &MotionState;

    /// Travel from the last accepted state to the trial state, (n).
    fn travel(&self) -> &[Vector6];

    /// Prepares [`Self::weights`] and [`Self::correct`] at the trial state.
    fn linearise(&mut self);

    /// How velocity and acceleration follow an increment of the configuration.
    fn weights(&self) -> TangentWeights<'_>;

    /// Moves the configuration by `increment`, (n), with the velocity and acceleration that follow.
    fn correct(&mut self, increment: &[Vector6]);
}

/// Room for the iteration.
#[derive(Debug, Clone)]
pub(crate) struct Newton {
    residual: Vec<Vector6>,
    increment: Vec<Vector6>,
    /// Iterations of the last solution; the next one is likely to take as many.
    expected: usize,
    /// Whether the last solution converged.
    converged: bool,
    /// Solutions to come that get a new matrix in every iteration.
    pause: usize,
    /// Factor on velocities of the matrix that is factorised, if there is one [1/s].
    factorised: Option<f64>,
    /// Whether it may serve the next solution.
    serves: bool,
}

impl Newton {
    pub(crate) fn new(frame_count: usize) -> Newton {
        Newton {
            residual: vec![Vector6::zeros(); frame_count],
            increment: vec![Vector6::zeros(); frame_count],
            expected: 0,
            converged: false,
            pause: 0,
            factorised: None,
            serves: false,
        }
    }

    /// Room for a vector, (n), that is free between solutions.
    pub(crate) fn room(&mut self) -> &mut [Vector6] {
        &mut self.increment
    }

    /// Forgets the matrix: the system has made another one.
    pub(crate) fn restart(&mut self) {
        self.factorised = None;
    }

    /// Moves `stage` until its residual at `time` is small enough.
    pub(crate) fn solve(
        &mut self,
        system: &mut dyn ImplicitSystem,
        time: f64,
        stage: &mut dyn Stage,
        settings: &StepSettings,
    ) -> Result<NewtonOutcome, NewtonFailure> {
        let unsolved = UNSOLVED * settings.allowed_error.unwrap_or(0.0);
        let settings = &settings.newton;
        // What the system knows of the last solution helps where this one follows it.
        if !std::mem::take(&mut self.converged) {
            system.begin();
            self.factorised = None;
        }
        // The factor on velocities is one over the step, but for a constant.
        let rate = stage.weights().velocity;
        let same = self
            .factorised
            .is_some_and(|of| (of - rate).abs() <= SAME * rate);
        let unaided = same && self.serves && self.pause == 0;
        if unaided {
            system.stepping(stage.travel());
        }
        let mut iterations = 0;
        let (mut previous, mut first) = (f64::INFINITY, None);
        let mut may_reuse = self.pause == 0;
        self.pause = self.pause.saturating_sub(1);
        let (mut reuses, mut renewed) = (0, false);
        // Whether the first iteration left next to nothing.
        let mut hardly_bent = false;
        loop {
            // Where convergence is likely, or the old matrix may do, the residual alone is
            // evaluated. Elsewhere residual and matrix come from one evaluation.
            let likely = may_reuse || iterations >= self.expected.min(UNCHECKED_ITERATIONS);
            let mut converged = false;
            let mut reuse = false;
            if iterations == 0 && unaided {
                system.assemble(time, stage.trial(), None, &mut self.residual);
                reuse = true;
            }
            if iterations > 0 && likely {
                let residual = self.search_line(system, time, stage, iterations, previous);
                converged = residual <= settings.tolerance_newtons
                    || residual <= ABOVE_TOLERANCE * settings.tolerance_newtons
                        && self.next_increment(system, residual, previous) <= unsolved;
                if reuses > 0 && residual > GOOD_REDUCTION * previous && !converged {
                    may_reuse = false;
                    // Of a matrix of this step more was to be expected.
                    if !unaided {
                        self.pause = PAUSE;
                    }
                }
                let worth = reuses > 0 || residual < WORTH_REUSE * previous;
                reuse = may_reuse && worth && !converged && reuses < MOST_REUSES;
            }
            if !converged && !reuse {
                stage.linearise();
                let weights = stage.weights();
                self.factorised = None;
                system.assemble(time, stage.trial(), Some(&weights), &mut self.residual);
            }
            let residual = system.residual_size(&self.residual);
            let failure = NewtonFailure {
                iterations,
                residual,
                singular: false,
            };
            let first = *first.get_or_insert(residual.newtons);
            if iterations == 1 {
                let next_to_nothing =
                    (HARDLY_BENT * first).max(HARDLY_LEFT * settings.tolerance_newtons);
                hardly_bent = residual.newtons < next_to_nothing;
            }
            if !residual.newtons.is_finite()
                || iterations > UNCHECKED_ITERATIONS && residual.newtons > LOST * first
            {
                self.pause = PAUSE;
                return Err(failure);
            }
            previous = residual.newtons;
            if converged || residual.newtons <= settings.tolerance_newtons {
                self.expected = iterations;
                self.serves = if unaided {
                    !renewed && iterations <= CHEAP
                } else {
                    hardly_bent
                };
                self.converged = true;
                return Ok(NewtonOutcome {
                    iterations,
                    residual,
                });
            }
            if iterations == settings.max_iterations {
                self.pause = PAUSE;
                return Err(failure);
            }
            if reuse {
                reuses += 1;
                system.solve_again(&self.residual, &mut self.increment);
            } else {
                reuses = 0;
                system
                    .solve(&self.residual, &mut self.increment)
                    .map_err(|frame| NewtonFailure {
                        residual: ResidualSize { frame, ..residual },
                        singular: true,
                        ..failure
                    })?;
                self.factorised = Some(rate);
                renewed = true;
            }
            iterations += 1;
            system.moving(&self.increment);
            stage.correct(&self.increment);
        }
    }

    /// Size of the increment that would follow the last one, if increments shrink as residuals do
    /// [m].
    ///
    /// Source: docs/theory/solver.md, eq. (7a).
    fn next_increment(&self, system: &dyn ImplicitSystem, residual: f64, previous: f64) -> f64 {
        system.increment_size(&self.increment) * residual / previous
    }

    /// Evaluates the residual after an increment, and takes half of the increment back as long as
    /// it made matters worse. The first iterations go unchecked: in the mixed form their residual
    /// may rise, and the next iteration repairs it.
    fn search_line(
        &mut self,
        system: &mut dyn ImplicitSystem,
        time: f64,
        stage: &mut dyn Stage,
        iterations: usize,
        previous: f64,
    ) -> f64 {
        let mut halvings = 0;
        loop {
            system.assemble(time, stage.trial(), None, &mut self.residual);
            let residual = system.residual_size(&self.residual).newtons;
            // A residual that is not a number is worse than any.
            let better = residual < previous;
            if better || iterations < UNCHECKED_ITERATIONS || halvings == MOST_HALVINGS {
                return residual;
            }
            halvings += 1;
            self.increment.iter_mut().for_each(|d| *d *= -0.5);
            stage.correct(&self.increment);
            // What is left of the increment, for the next halving.
            self.increment.iter_mut().for_each(|d| *d *= -1.0);
        }
    }
}
