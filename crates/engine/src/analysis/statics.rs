//! Static equilibrium from any first shape.
//!
//! Pseudo-transient continuation: every step is the backward-Euler step of a system that starts at
//! rest, with its real masses. For small steps that is a short move towards lower energy, for
//! large ones it is Newton's method; the step grows as long as Newton converges.
//!
//! Source: docs/theory/statics.md, eqs. (1) to (4).

use std::ops::ControlFlow;

use catenix_numerics::{
    Configuration, ImplicitSystem, Matrix3, MotionState, ResidualSize, TangentWeights, Vector3,
    Vector6, so3,
};
use thiserror::Error;

use super::free_motion;
use crate::system::{FrameOwner, StepView, System, SystemError, SystemSolver};

/// Newton iterations of one pseudo-step before it is cut.
const STEP_ITERATIONS: usize = 12;
/// Shortened iterations of one pseudo-step before it is cut: the step is too large.
const SHORTENED_ITERATIONS: usize = 3;
/// Largest rotation of a frame in one iteration [rad].
pub(super) const ROTATION_LIMIT: f64 = 0.4;
/// Residual at which an intermediate pseudo-step is good enough, over the reference force.
const STEP_TOLERANCE: f64 = 1e-5;
/// Growth, per converged step, of the largest step that is tried after a failure.
const LIMIT_GROWTH: f64 = 1.25;
/// Most Newton steps after the residual is allowed.
const SHARPENING_STEPS: usize = 5;
/// Pseudo-step beyond which the inertia term no longer matters [s].
pub(super) const LARGEST_STEP: f64 = 1e4;
/// Squared frequency of the touch of stiffness that keeps free spins out of the matrix
/// [rad2/s2]; it acts on the search only, never on the residual.
pub(super) const SPIN_HOLD: f64 = 1e-3;
/// The same in proportion to the largest residual moment [1/rad]: a spin that nothing holds must
/// not answer to moments that are there only until the iteration has converged.
const SPIN_MOMENT: f64 = 1.0;
/// Pseudo-step below which the search is hopeless [s].
const SMALLEST_STEP: f64 = 1e-7;

/// How far the search for equilibrium is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StaticsProgress {
    /// Newton iterations so far.
    pub iteration: usize,
    /// Largest residual force [N].
    pub residual_n: f64,
    /// Largest move of a frame in the last iteration [m].
    pub largest_move_m: f64,
}

/// A static equilibrium.
#[derive(Debug, Clone)]
pub struct StaticSolution<'a> {
    pub(super) solver: SystemSolver<'a>,
    pub(super) state: MotionState,
    /// Newton iterations that it took.
    pub iterations: usize,
    /// Largest residual force [N]; of the first shape, where no equilibrium was sought.
    pub residual_n: f64,
    /// Remarks for the user, for example on motions that nothing resists.
    pub warnings: Vec<String>,
}

impl StaticSolution<'_> {
    /// Results of the equilibrium.
    pub fn view(&self) -> StepView<'_> {
        StepView {
            solver: &self.solver,
            state: &self.state,
            time: 0.0,
            step: 0.0,
            at_output_time: true,
            at_field_time: true,
        }
    }

    /// Positions and rotations.
    pub fn configuration(&self) -> &Configuration {
        &self.state.configuration
    }

    /// The same system, which knows the tension of this equilibrium and starts from its shape, for
    /// one that [wants to know it](System::wants_tension).
    ///
    /// Source: docs/theory/dem.md, "Bending layers shorter than an element".
    ///
    /// # Errors
    /// [`SystemError`] when a value cannot be used.
    pub fn tightened(&self) -> Result<System, SystemError> {
        let system = self.solver.system();
        let lines = 0..system.lines.len();
        let tensions: Vec<Vec<f64>> = lines.map(|line| self.view().tensions(line)).collect();
        system.tightened(&tensions, self.configuration())
    }
}

/// Why no equilibrium was found.
#[derive(Debug, Clone, Error, PartialEq)]
#[non_exhaustive]
pub enum StaticsError {
    /// The search ended without equilibrium.
    #[error(
        "no static equilibrium after {iterations} iterations: the residual is still \
         {residual_n:.3e} N (allowed {allowed_n:.3e} N) at {owner}. Check that the system can hang \
         in equilibrium (nothing drifts away, lines are long enough), or give bodies an \
         initial_position nearer to where they end up"
    )]
    NoEquilibrium {
        /// Iterations done.
        iterations: usize,
        /// Largest residual [N].
        residual_n: f64,
        /// Residual allowed [N].
        allowed_n: f64,
        /// Where it is.
        owner: FrameOwner,
    },
    /// Equilibrium leaves a motion that nothing resists.
    #[error(
        "the equilibrium is not unique: {owner} can move without any resistance{how}. Hold it \
         with a joint that keeps this motion (fixed instead of hinge or ball), or with another line"
    )]
    FreeMotion {
        /// What moves most.
        owner: FrameOwner,
        /// In which direction, starting with a space; may be empty.
        how: String,
    },
    /// The caller stopped the search.
    #[error("stopped by the user after {iterations} iterations")]
    Interrupted {
        /// Iterations done.
        iterations: usize,
    },
}

/// Finds the static equilibrium at t = 0; or takes the first shape as it is, where the model asks
/// for no equilibrium. Loads have their values at t = 0.
///
/// `progress` is called after every iteration and may stop the search.
///
/// # Errors
/// [`StaticsError`] when there is no equilibrium to be found, or it is not unique.
pub fn solve_statics<'a>(
    system: &'a System,
    progress: &mut dyn FnMut(&StaticsProgress) -> ControlFlow<()>,
) -> Result<StaticSolution<'a>, StaticsError> {
    let settings = &system.model().statics;
    let solver = SystemSolver::at_rest(system, settings.current);
    if settings.equilibrium {
        let mut solution = find_equilibrium(solver, progress)?;
        solution.solver.rest();
        return Ok(solution);
    }
    let mut search = Search::new(solver, system.first_shape().clone(), progress);
    search.static_residual();
    Ok(StaticSolution {
        solver: search.solver,
        state: search.state,
        iterations: 0,
        residual_n: search.residual.newtons,
        warnings: Vec::new(),
    })
}

/// Finds the equilibrium of what `solver` sees, from the first shape.
pub(super) fn find_equilibrium<'a>(
    solver: SystemSolver<'a>,
    progress: &mut dyn FnMut(&StaticsProgress) -> ControlFlow<()>,
) -> Result<StaticSolution<'a>, StaticsError> {
    let system = solver.system();
    let settings = &system.model().statics;
    let mut search = Search::new(solver, system.first_shape().clone(), progress);
    let allowed = system.allowed_residual(settings.tolerance);
    search.run(allowed, settings.max_iterations)?;
    // What only the search needs ends here.
    let (mut solver, mut state, iterations, residual) = search.end();
    let mut warnings = Vec::new();
    warnings.extend(system.round_off_warning());
    match free_motion::find(&mut solver, &mut state) {
        Some(free) if !free.blames_a_joint() => warnings.push(free.warning(system)),
        Some(free) => {
            return Err(StaticsError::FreeMotion {
                owner: system.owner(free.frame),
                how: free.direction(),
            });
        }
        None => {}
    }
    Ok(StaticSolution {
        solver,
        state,
        iterations,
        residual_n: residual.newtons,
        warnings,
    })
}

/// The search with its state.
struct Search<'s, 'a> {
    solver: SystemSolver<'a>,
    progress: &'s mut dyn FnMut(&StaticsProgress) -> ControlFlow<()>,
    state: MotionState,
    /// Start of the current pseudo-step.
    start: Configuration,
    travel: Vec<Vector6>,
    weights: Vec<Matrix3>,
    residual_vector: Vec<Vector6>,
    increment: Vec<Vector6>,
    iterations: usize,
    residual: ResidualSize,
}

/// How a pseudo-step ended.
enum StepEnd {
    Converged {
        iterations: usize,
    },
    /// Still on its way; the residual it started from [N].
    OutOfIterations {
        start_residual: f64,
    },
    Failed,
}

impl<'s, 'a> Search<'s, 'a> {
    fn new(
        solver: SystemSolver<'a>,
        shape: Configuration,
        progress: &'s mut dyn FnMut(&StaticsProgress) -> ControlFlow<()>,
    ) -> Self {
        let n = shape.len();
        Search {
            solver,
            progress,
            start: shape.clone(),
            state: MotionState::at_rest(shape),
            travel: vec![Vector6::zeros(); n],
            weights: vec![Matrix3::identity(); n],
            residual_vector: vec![Vector6::zeros(); n],
            increment: vec![Vector6::zeros(); n],
            iterations: 0,
            residual: ResidualSize {
                newtons: f64::INFINITY,
                frame: 0,
            },
        }
    }

    /// What it found.
    fn end(self) -> (SystemSolver<'a>, MotionState, usize, ResidualSize) {
        (self.solver, self.state, self.iterations, self.residual)
    }

    fn run(&mut self, allowed: f64, max_iterations: usize) -> Result<(), StaticsError> {
        let system = self.solver.system();
        let gravity = system.model().environment.gravity.max(0.1);
        let mut tau = 0.1 * (system.reference_length() / gravity).sqrt();
        let coarse = STEP_TOLERANCE * system.reference_force();
        let mut tolerance = coarse.max(allowed);
        // Steps near the last one that failed are approached slowly.
        let mut limit = LARGEST_STEP;
        loop {
            let end = self.pseudo_step(tau, tolerance)?;
            let step_residual = self.residual.newtons;
            self.static_residual();
            if self.residual.newtons <= allowed {
                self.sharpen();
                return Ok(());
            }
            match end {
                StepEnd::Converged { iterations } => {
                    let growth = match iterations {
                        0..=3 => 2.5,
                        4..=5 => 1.6,
                        _ => 1.2,
                    };
                    tau = (tau * growth).min(limit);
                    limit = (limit * LIMIT_GROWTH).min(LARGEST_STEP);
                    // Each step must have something left to do.
                    tolerance = (0.1 * self.residual.newtons).clamp(allowed, coarse.max(allowed));
                }
                // A step on its way is continued; one that got lost is repeated, smaller.
                StepEnd::OutOfIterations { start_residual }
                    if step_residual < 0.1 * start_residual => {}
                StepEnd::OutOfIterations { .. } | StepEnd::Failed => {
                    self.state.configuration.copy_from(&self.start);
                    limit = 0.7 * tau;
                    tau *= 0.4;
                }
            }
            if tau < SMALLEST_STEP || self.iterations > max_iterations {
                self.static_residual();
                return Err(StaticsError::NoEquilibrium {
                    iterations: self.iterations,
                    residual_n: self.residual.newtons,
                    allowed_n: allowed,
                    owner: system.owner(self.residual.frame),
                });
            }
        }
    }

    /// Goes on with Newton steps once the residual is allowed, as long as they help: what is left at
    /// the elements may add up along a line, and these steps cost next to nothing.
    fn sharpen(&mut self) {
        let mass = 1.0 / (LARGEST_STEP * LARGEST_STEP);
        let weights = TangentWeights {
            velocity: 0.0,
            acceleration: mass,
            rotation: None,
        };
        for _ in 0..SHARPENING_STEPS {
            let before = self.residual.newtons;
            self.start.copy_from(&self.state.configuration);
            self.travel.fill(Vector6::zeros());
            self.solver.begin();
            self.solver
                .assemble(0.0, &self.state, Some(&weights), &mut self.residual_vector);
            self.solver.hold_spins(&self.state, SPIN_HOLD, 0.0);
            if self
                .solver
                .solve(&self.residual_vector, &mut self.increment)
                .is_err()
            {
                break;
            }
            self.iterations += 1;
            self.advance();
            self.static_residual();
            if self.residual.newtons.is_nan() || self.residual.newtons > 0.5 * before {
                if self.residual.newtons.is_nan() || self.residual.newtons > before {
                    self.state.configuration.copy_from(&self.start);
                    self.static_residual();
                }
                break;
            }
        }
    }

    /// Residual without the pseudo-inertia.
    fn static_residual(&mut self) {
        self.state.acceleration.fill(Vector6::zeros());
        self.solver
            .assemble(0.0, &self.state, None, &mut self.residual_vector);
        self.residual = self.solver.residual_size(&self.residual_vector);
    }

    /// One backward-Euler step of size `tau` from rest.
    fn pseudo_step(&mut self, tau: f64, tolerance: f64) -> Result<StepEnd, StaticsError> {
        self.state.configuration.orthonormalise();
        self.start.copy_from(&self.state.configuration);
        self.travel.fill(Vector6::zeros());
        self.solver.begin();
        let mass = 1.0 / (tau * tau);
        let mut shortened = 0;
        let mut start_residual = f64::INFINITY;
        for iteration in 0..=STEP_ITERATIONS {
            for k in 0..self.travel.len() {
                self.state.acceleration[k] = self.travel[k] * mass;
                // Points do not turn: at pairs the weights stay the identity.
                if k >= self.start.pair_count() {
                    let turn = self.travel[k].fixed_rows::<3>(3).into_owned();
                    self.weights[k] = so3::left_jacobian_inverse(&turn);
                }
            }
            let weights = TangentWeights {
                velocity: 0.0,
                acceleration: mass,
                rotation: Some(&self.weights),
            };
            self.solver
                .assemble(0.0, &self.state, Some(&weights), &mut self.residual_vector);
            self.residual = self.solver.residual_size(&self.residual_vector);
            if iteration == 0 {
                start_residual = self.residual.newtons;
            }
            if !self.residual.newtons.is_finite() {
                return Ok(StepEnd::Failed);
            }
            if self.residual.newtons <= tolerance {
                return Ok(StepEnd::Converged {
                    iterations: iteration,
                });
            }
            if iteration == STEP_ITERATIONS {
                return Ok(StepEnd::OutOfIterations { start_residual });
            }
            let moment = self.solver.system().largest_moment(&self.residual_vector);
            let moment = SPIN_MOMENT * moment;
            self.solver.hold_spins(&self.state, SPIN_HOLD, moment);
            if self
                .solver
                .solve(&self.residual_vector, &mut self.increment)
                .is_err()
            {
                return Ok(StepEnd::Failed);
            }
            self.iterations += 1;
            let (largest_move_m, complete) = self.advance();
            let progress = StaticsProgress {
                iteration: self.iterations,
                residual_n: self.residual.newtons,
                largest_move_m,
            };
            if (self.progress)(&progress).is_break() {
                return Err(StaticsError::Interrupted {
                    iterations: self.iterations,
                });
            }
            shortened += usize::from(!complete);
            if shortened > SHORTENED_ITERATIONS {
                break;
            }
        }
        Ok(StepEnd::Failed)
    }

    /// Applies the increment, shortened where it turns too far; returns the largest move
    /// and whether it was applied in full.
    fn advance(&mut self) -> (f64, bool) {
        let turn = self.solver.system().largest_turn(&self.increment);
        let shorten = if turn > ROTATION_LIMIT {
            ROTATION_LIMIT / turn
        } else {
            1.0
        };
        let moved = self.solver.system().largest_translation(&self.increment) * shorten;
        for increment in &mut self.increment {
            *increment *= shorten;
        }
        self.solver.moving(&self.increment);
        for k in 0..self.travel.len() {
            move_frame(self.solver.system(), k, &self.increment[k], &mut self.state);
            self.travel[k] = travelled(k, &self.start, &self.state);
        }
        (moved, shorten == 1.0)
    }
}

/// Moves a frame: its spin first and the swing after it, so that a large spin leaves the axis where
/// the linear solution put it.
pub(super) fn move_frame(system: &System, k: usize, d: &Vector6, state: &mut MotionState) {
    let turn: Vector3 = d.fixed_rows::<3>(3).into();
    state.configuration.position[k] += d.fixed_rows::<3>(0);
    if let Some(second) = state.configuration.second.get_mut(k) {
        *second += d.fixed_rows::<3>(3);
        return;
    }
    let rotation = &mut state.configuration.rotation[k];
    let axis = *rotation * system.frame_axis(k);
    let spin = axis * axis.dot(&turn);
    *rotation = so3::exp(&(turn - spin)) * so3::exp(&spin) * *rotation;
}

/// Translation and rotation vector of a frame from `start`.
pub(super) fn travelled(k: usize, start: &Configuration, state: &MotionState) -> Vector6 {
    state.configuration.difference_at(start, k)
}
