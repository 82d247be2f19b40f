//! Motion in time from a static equilibrium.
//!
//! Source: docs/theory/integration.md.

use std::ops::ControlFlow;

use catenix_model::{DynamicsSettings, IntegratorSettings, StepControl};
use catenix_numerics::{
    AlphaParameters, Bdf, CentralDifferences, GeneralisedAlpha, ImplicitSystem, Integrator,
    MotionState, NewtonFailure, NewtonSettings, StepOutcome, StepSettings, TangentWeights, Vector6,
};
use thiserror::Error;

use super::energy::{EnergyAccount, EnergyLedger};
use super::statics::StaticSolution;
use crate::system::{FrameOwner, LoadEvent, StepView, System, SystemSolver};

/// Smallest step after failed Newton iterations, over the step that was asked for.
const SMALLEST_CUT: f64 = 1e-4;
/// Share of the step that is stable by theory that explicit integration takes: tensions rise
/// within a step of output.
const EXPLICIT_SHARE: f64 = 0.9;
/// Steps that must all allow a larger one before the step grows.
const PATIENCE: usize = 20;
/// Share of a step in which Newton's method failed that it is repeated with.
const CUT: f64 = 0.5;
/// Share of that step above which later ones stay for a while.
const CEILING: f64 = 0.8;
/// Growth of that bound with every accepted step.
const CEILING_GROWTH: f64 = 1.005;
/// Growth that is taken at once: the step is much too small, as at the start.
const LEAP: f64 = 2.5;
/// Least growth that is worth a change.
const WORTHWHILE: f64 = 1.1;
/// Weight of the mass that drowns stiffness and damping when accelerations are found [1/s2].
const MASS_ONLY: f64 = 1e20;

/// What the integration took.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct SolverStatistics {
    /// Accepted steps.
    pub steps: usize,
    /// Steps repeated with a smaller size.
    pub rejected_steps: usize,
    /// Accepted steps of each order of the integrator, from 1 to 5.
    pub steps_of_order: [usize; 5],
    /// Newton iterations, rejected steps included.
    pub iterations: usize,
    /// Factorisations of the iteration matrix.
    pub factorisations: usize,
    /// Largest residual force at the end of any accepted step [N].
    pub largest_residual_n: f64,
}

/// The outcome of a simulation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DynamicsReport {
    /// Solver statistics.
    pub statistics: SolverStatistics,
    /// Energy account.
    pub energy: EnergyAccount,
    /// Time that was reached [s].
    pub end_time_s: f64,
    /// Whether the observer stopped it.
    pub interrupted: bool,
}

/// Why a simulation ended early.
#[derive(Debug, Clone, Error, PartialEq)]
#[non_exhaustive]
pub enum DynamicsError {
    /// The model has no `[dynamics]`.
    #[error("the model describes no motion: add a [dynamics] table with a duration")]
    NoDynamics,
    /// Newton's method failed at the smallest step.
    #[error(
        "no solution at t = {time_s:.4} s: after {iterations} iterations the residual is \
         {residual_n:.3e} N (allowed {allowed_n:.3e} N) at {owner}, with a step of {step_s:.2e} s. \
         What to try: shorter elements where the line bends, some structural_damping, a longer ramp \
         of the motions, or a smaller step"
    )]
    NotConverged {
        /// Time at the end of the failed step [s].
        time_s: f64,
        /// Step size [s].
        step_s: f64,
        /// Newton iterations of the last attempt.
        iterations: usize,
        /// Residual when it was given up [N].
        residual_n: f64,
        /// Residual allowed [N].
        allowed_n: f64,
        /// Where it is.
        owner: FrameOwner,
        /// What was done until then.
        report: Box<DynamicsReport>,
    },
}

impl DynamicsError {
    /// What was done until the failure, if anything.
    pub fn report(&self) -> Option<&DynamicsReport> {
        match self {
            DynamicsError::NotConverged { report, .. } => Some(report),
            DynamicsError::NoDynamics => None,
        }
    }
}

/// Integrates the motion from `start`.
///
/// `observer` is called at t = 0 and after every accepted step, and may stop the simulation.
///
/// # Errors
/// [`DynamicsError`]; the observer has seen every step until then.
pub fn simulate(
    system: &System,
    start: &StaticSolution<'_>,
    observer: &mut dyn FnMut(&StepView<'_>) -> ControlFlow<()>,
) -> Result<DynamicsReport, DynamicsError> {
    let settings = system
        .model()
        .dynamics
        .as_ref()
        .ok_or(DynamicsError::NoDynamics)?;
    let mut solver = SystemSolver::moving(system);
    let mut state = MotionState::at_rest(start.configuration().clone());
    find_accelerations(&mut solver, 0.0, &mut state);
    let integrator: Box<dyn Integrator> = match settings.integrator {
        IntegratorSettings::GeneralisedAlpha { spectral_radius } => {
            let parameters = AlphaParameters::with_spectral_radius(spectral_radius);
            Box::new(GeneralisedAlpha::new(parameters, state))
        }
        IntegratorSettings::Bdf { max_order } => Box::new(Bdf::new(max_order, state)),
        IntegratorSettings::Explicit => Box::new(CentralDifferences::new(EXPLICIT_SHARE, state)),
    };
    let ledger = EnergyLedger::new(solver.energy_terms(0.0, integrator.state()));
    Simulation {
        settings,
        goals: StepSettings {
            newton: NewtonSettings {
                tolerance_newtons: system.allowed_residual(settings.tolerance),
                max_iterations: settings.max_iterations,
            },
            allowed_error: match settings.step {
                StepControl::Fixed(_) => None,
                StepControl::Adaptive { accuracy, .. } => {
                    Some(accuracy * system.reference_length())
                }
            },
        },
        solver,
        integrator,
        ledger,
        statistics: SolverStatistics::default(),
        calm: Calm::new(),
        ceiling: f64::INFINITY,
        time: 0.0,
    }
    .run(observer)
}

/// Accelerations that satisfy the equations of motion at `time`.
///
/// Source: docs/theory/integration.md, eq. (10).
fn find_accelerations(solver: &mut SystemSolver<'_>, time: f64, state: &mut MotionState) {
    let n = state.configuration.len();
    let mut residual = vec![Vector6::zeros(); n];
    let mut increment = vec![Vector6::zeros(); n];
    let weights = TangentWeights {
        velocity: 0.0,
        acceleration: MASS_ONLY,
        rotation: None,
    };
    solver.begin();
    solver.assemble(time, state, Some(&weights), &mut residual);
    // A massless frame has no acceleration of its own; it keeps what it has.
    if solver.solve(&residual, &mut increment).is_ok() {
        for (acceleration, d) in state.acceleration.iter_mut().zip(&increment) {
            *acceleration += d * MASS_ONLY;
        }
    }
    solver.assemble(time, state, None, &mut residual);
}

struct Simulation<'s> {
    settings: &'s DynamicsSettings,
    goals: StepSettings,
    solver: SystemSolver<'s>,
    integrator: Box<dyn Integrator>,
    ledger: EnergyLedger,
    statistics: SolverStatistics,
    calm: Calm,
    /// Largest step to ask for since Newton's method failed [s].
    ceiling: f64,
    time: f64,
}

/// What the steps since the last change of their size would have allowed.
#[derive(Debug, Clone, Copy)]
struct Calm {
    steps: usize,
    /// The smallest size that one of them asked for [s].
    least: f64,
}

impl Calm {
    fn new() -> Calm {
        Calm {
            steps: 0,
            least: f64::INFINITY,
        }
    }
}

impl Simulation<'_> {
    fn run(
        mut self,
        observer: &mut dyn FnMut(&StepView<'_>) -> ControlFlow<()>,
    ) -> Result<DynamicsReport, DynamicsError> {
        let mut events = self.events();
        let wanted = match self.settings.step {
            StepControl::Fixed(step) => step,
            StepControl::Adaptive { max, .. } => max,
        };
        let mut interrupted = self.show(observer, 0.0, true, true).is_break();
        // The size that the controller asks for; steps actually taken may be shorter.
        let mut size = match self.settings.step {
            StepControl::Fixed(step) => step,
            StepControl::Adaptive { min, max, .. } => (0.05 * max).max(min),
        };
        while !interrupted && let Some(event) = events.next_after(self.time) {
            let span = event.time - self.time;
            let pieces = (span / size - 1e-6).ceil().max(1.0);
            let step = span / pieces;
            let due = pieces == 1.0;
            let end = if due { event.time } else { self.time + step };
            // A step that ends on a jump of the loads sees those before it.
            let jump = due && event.jump;
            let seen = if jump { end.next_down() } else { end };
            let result = self
                .integrator
                .advance(&mut self.solver, seen, step, &self.goals);
            let outcome = match result {
                Ok(outcome) => outcome,
                Err(failure) => {
                    self.calm = Calm::new();
                    self.statistics.iterations += failure.iterations;
                    self.statistics.rejected_steps += 1;
                    size = CUT * step;
                    self.ceiling = CEILING * step;
                    if size < SMALLEST_CUT * wanted {
                        return Err(self.failed(end, step, &failure));
                    }
                    continue;
                }
            };
            self.statistics.iterations += outcome.iterations;
            match self.next_size(step, size, &outcome) {
                Ok(next) => size = next,
                Err(smaller) => {
                    self.statistics.rejected_steps += 1;
                    size = smaller;
                    continue;
                }
            }
            self.integrator.accept();
            self.ceiling *= CEILING_GROWTH;
            self.time = end;
            self.statistics.steps += 1;
            if let Some(count) = self.statistics.steps_of_order.get_mut(outcome.order - 1) {
                *count += 1;
            }
            self.statistics.largest_residual_n = self
                .statistics
                .largest_residual_n
                .max(outcome.residual.newtons);
            self.ledger
                .add(step, self.solver.energy_terms(end, self.integrator.state()));
            interrupted = self
                .show(observer, step, due && event.output, due && event.field)
                .is_break();
            if jump {
                self.restart();
            }
        }
        Ok(self.report(interrupted))
    }

    /// Starts anew from the current state, since the loads have jumped.
    fn restart(&mut self) {
        let mut state = self.integrator.state().clone();
        find_accelerations(&mut self.solver, self.time, &mut state);
        self.integrator.restart(&state.acceleration);
        let terms = self.solver.energy_terms(self.time, &state);
        self.ledger.restart(terms);
    }

    /// The size to ask for after a converged step, or a smaller one to repeat it with.
    ///
    /// The size changes seldom: every change disturbs what the integrator remembers.
    ///
    /// Source: docs/theory/integration.md, below eq. (9).
    fn next_size(&mut self, step: f64, asked: f64, outcome: &StepOutcome) -> Result<f64, f64> {
        match self.settings.step {
            StepControl::Fixed(fixed) => Ok((2.0 * asked).min(fixed)),
            StepControl::Adaptive { min, max, .. } => {
                let wanted = outcome.growth * step;
                let allowed = self.goals.allowed_error.unwrap_or(f64::INFINITY);
                if outcome.local_error > allowed && step > min * (1.0 + 1e-9) {
                    self.calm = Calm::new();
                    return Err(wanted.clamp((0.2 * step).max(min), step));
                }
                self.calm.steps += 1;
                self.calm.least = self.calm.least.min(wanted);
                let mut proposal = asked;
                if wanted > LEAP * asked {
                    proposal = 2.0 * asked;
                    self.calm = Calm::new();
                } else if self.calm.steps >= PATIENCE {
                    // The largest size is worth little, too: no other change follows it.
                    if self.calm.least > (WORTHWHILE * asked).min(max) {
                        proposal = self.calm.least.min(2.0 * asked);
                    }
                    self.calm = Calm::new();
                }
                if outcome.iterations > self.settings.max_iterations / 2 {
                    proposal = proposal.min(step);
                }
                Ok(proposal.min(self.ceiling).clamp(min, max))
            }
        }
    }

    /// Shows the current state, which is the one that the solver evaluated last.
    fn show(
        &mut self,
        observer: &mut dyn FnMut(&StepView<'_>) -> ControlFlow<()>,
        step: f64,
        at_output_time: bool,
        at_field_time: bool,
    ) -> ControlFlow<()> {
        observer(&StepView {
            solver: &self.solver,
            state: self.integrator.state(),
            time: self.time,
            step,
            at_output_time,
            at_field_time,
        })
    }

    fn report(&self, interrupted: bool) -> DynamicsReport {
        let factorisations = self.solver.factorisations();
        DynamicsReport {
            statistics: SolverStatistics {
                factorisations,
                ..self.statistics
            },
            energy: self.ledger.account(),
            end_time_s: self.time,
            interrupted,
        }
    }

    fn failed(&self, time_s: f64, step_s: f64, failure: &NewtonFailure) -> DynamicsError {
        DynamicsError::NotConverged {
            time_s,
            step_s,
            iterations: failure.iterations,
            residual_n: failure.residual.newtons,
            allowed_n: self.goals.newton.tolerance_newtons,
            owner: self.solver.system().owner(failure.residual.frame),
            report: Box::new(self.report(false)),
        }
    }

    fn events(&self) -> Events {
        let output = &self.solver.system().model().output;
        let mut extra: Vec<LoadEvent> = self.solver.system().load_events().collect();
        extra.retain(|event| event.time > 0.0 && event.time < self.settings.duration);
        // The statistics of the window are those of whole steps.
        let window = self.settings.duration - self.settings.statistics_window;
        if window > 0.0 {
            extra.push(LoadEvent {
                time: window,
                jump: false,
            });
        }
        extra.sort_by(|a, b| a.time.total_cmp(&b.time));
        let bound = |interval: f64| {
            if output.interpolate {
                self.settings.duration
            } else {
                interval
            }
        };
        Events {
            output: bound(output.interval),
            field: bound(output.field_interval),
            extra,
            duration: self.settings.duration,
        }
    }
}

/// Times at which a step must end.
struct Events {
    output: f64,
    field: f64,
    extra: Vec<LoadEvent>,
    duration: f64,
}

struct Event {
    time: f64,
    output: bool,
    field: bool,
    /// Whether the loads jump.
    jump: bool,
}

impl Events {
    /// The next time after `now`; `None` at the end.
    fn next_after(&mut self, now: f64) -> Option<Event> {
        let slack = 1e-9 * self.duration;
        if now >= self.duration - slack {
            return None;
        }
        let multiple = |interval: f64| ((now + slack) / interval).floor() * interval + interval;
        let next_output = multiple(self.output).min(self.duration);
        let next_field = multiple(self.field).min(self.duration);
        let extra = self.extra.iter().find(|event| event.time > now + slack);
        let next_extra = extra.map_or(f64::INFINITY, |event| event.time);
        let time = next_output.min(next_field).min(next_extra);
        Some(Event {
            time,
            output: next_output <= time + slack,
            field: next_field <= time + slack,
            jump: extra.is_some_and(|event| event.jump && event.time <= time + slack),
        })
    }
}
