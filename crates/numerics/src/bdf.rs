//! BDF on R3 x SO(3): backward differentiation (Gear's method) of order 1 to 5 with varying steps.
//!
//! Rotations of the past are rotation vectors about the last accepted configuration, so that the
//! formulas of a vector space keep their order.
//! Source: docs/theory/integration.md, eqs. (11) to (15).

use crate::differences::{self, MOST_POINTS, Weights};
use crate::implicit::{ImplicitSystem, MotionState, TangentWeights};
use crate::integrator::{self, Integrator, StepOutcome, StepSettings};
use crate::newton::{Newton, NewtonFailure, Stage};
use crate::passes;
use crate::{Configuration, Matrix3, Vector3, Vector6, so3};

/// The highest order; beyond 6 the formulas are unstable, and 6 is hardly stable.
const MOST_ORDER: usize = 5;
/// Rotation up to which a past configuration is described about the current one [rad].
const MOST_ROTATION: f64 = 2.5;
/// The first points before the start lie on a parabola; their share in the error is missing.
const START_FACTOR: f64 = 7.5;
/// Advantage in step size that another order must offer: a lower one, a higher one.
const LOWER_BIAS: f64 = 0.92;
const HIGHER_BIAS: f64 = 0.86;

/// The integrator with its current state, its past, and its room for the next state.
#[derive(Debug, Clone)]
pub struct Bdf {
    max_order: usize,
    stage: BdfStage,
    /// States before the current one, newest first; at most `max_order`, at least 2.
    past: Vec<Past>,
    /// How many of `past` may be used.
    past_count: usize,
    /// Accepted steps since the start or restart.
    steps: usize,
    /// Order of the next step.
    order: usize,
    /// Order after the trial step, if it is accepted.
    next_order: usize,
    /// Accepted steps since the order changed.
    steps_at_order: usize,
    /// Accepted steps since the step size changed.
    steps_at_size: usize,
    /// Size of the trial step [s].
    trial_step: f64,
    newton: Newton,
    error: Vec<Vector6>,
}

/// A state before the current one.
#[derive(Debug, Clone)]
struct Past {
    configuration: Configuration,
    velocity: Vec<Vector6>,
    /// Seconds from this state to the next one.
    step: f64,
    /// Translation and rotation vector from the current configuration to this one (n).
    travel: Vec<Vector6>,
}

/// Current state, and the trial state of the step that Newton's method works on.
#[derive(Debug, Clone)]
struct BdfStage {
    state: MotionState,
    trial: MotionState,
    /// Leading weight of the formula [1/s].
    leading: f64,
    /// Translation and rotation vector from the current to the trial configuration.
    travel: Vec<Vector6>,
    /// Part of the past in the rate of the travel, and in the acceleration.
    past_rate: Vec<Vector6>,
    past_acceleration: Vec<Vector6>,
    rotation_weights: Vec<Matrix3>,
}

impl Bdf {
    /// Starts from `state`, whose acceleration satisfies the equations of motion.
    ///
    /// `max_order` is taken into 1 to 5.
    pub fn new(max_order: usize, state: MotionState) -> Bdf {
        let max_order = max_order.clamp(1, MOST_ORDER);
        let n = state.configuration.len();
        let zeros = vec![Vector6::zeros(); n];
        let past = Past {
            configuration: state.configuration.clone(),
            velocity: state.velocity.clone(),
            step: 0.0,
            travel: zeros.clone(),
        };
        Bdf {
            max_order,
            stage: BdfStage {
                trial: state.clone(),
                state,
                leading: 0.0,
                travel: zeros.clone(),
                past_rate: zeros.clone(),
                past_acceleration: zeros.clone(),
                rotation_weights: vec![Matrix3::identity(); n],
            },
            past: vec![past; max_order.max(2)],
            past_count: 0,
            steps: 0,
            order: max_order.min(2),
            next_order: max_order.min(2),
            steps_at_order: 0,
            steps_at_size: 0,
            trial_step: 0.0,
            newton: Newton::new(n),
            error: zeros,
        }
    }

    /// Lays two states before the current one, on the parabola through its velocity and
    /// acceleration, so that the first step can be of second order.
    ///
    /// Source: docs/theory/integration.md, eq. (15).
    fn lay_past(&mut self, step: f64) {
        let state = &self.stage.state;
        for (index, past) in self.past.iter_mut().take(2).enumerate() {
            let back = -step * (index + 1) as f64;
            past.step = step;
            for k in 0..past.travel.len() {
                past.travel[k] =
                    state.velocity[k] * back + state.acceleration[k] * (0.5 * back * back);
                past.velocity[k] = state.velocity[k] + state.acceleration[k] * back;
            }
            past.configuration
                .retract_from(&state.configuration, &past.travel);
        }
        self.past_count = 2;
    }

    /// Times from the end of a step of size `step`: that end, the current state, and the past.
    fn times(&self, step: f64) -> [f64; MOST_POINTS] {
        let mut times = [0.0; MOST_POINTS];
        times[1] = -step;
        for (j, past) in self.past.iter().take(self.past_count).enumerate() {
            times[j + 2] = times[j + 1] - past.step;
        }
        times
    }

    /// Sum over the past of weights times travels; `weights[0]` belongs to the newest of the past.
    fn sum_travels(past: &[Past], weights: &[f64], sum: &mut [Vector6]) {
        sum.fill(Vector6::zeros());
        for (past, weight) in past.iter().zip(weights) {
            passes::add_multiple(sum, *weight, &past.travel);
        }
    }

    /// Formula and first guess of a step.
    ///
    /// Source: docs/theory/integration.md, eqs. (11) to (13).
    fn prepare(&mut self, times: &[f64]) {
        let order = self.order;
        let weights = differences::derivative(&times[..=order]);
        let stage = &mut self.stage;
        stage.leading = weights[0];
        Self::sum_travels(&self.past[..order - 1], &weights[2..], &mut stage.past_rate);
        let sum = &mut stage.past_acceleration;
        passes::multiple(sum, weights[1], &stage.state.velocity);
        for (past, weight) in self.past[..order - 1].iter().zip(&weights[2..]) {
            passes::add_multiple(sum, *weight, &past.velocity);
        }
        let ahead = differences::extrapolation(0.0, &times[1..order + 2]);
        Self::sum_travels(&self.past[..order], &ahead[1..], &mut stage.travel);
        stage.update();
    }

    /// Local error of a formula of `order` that ends at the trial state, as a size [m].
    ///
    /// Source: docs/theory/integration.md, eq. (14).
    fn local_error(&mut self, system: &dyn ImplicitSystem, times: &[f64], order: usize) -> f64 {
        let difference: Weights = differences::divided_difference(&times[..order + 2]);
        let leading = differences::derivative(&times[..=order])[0];
        let spans: f64 = times[1..=order].iter().map(|time| -time).product();
        let start = if self.steps < 2 { START_FACTOR } else { 1.0 };
        let factor = start * spans / leading;
        let weights = difference.map(|weight| weight * factor);
        Self::sum_travels(&self.past[..order], &weights[2..], &mut self.error);
        passes::add_multiple(&mut self.error, weights[0], &self.stage.travel);
        system.increment_size(&self.error)
    }

    /// The highest order that the past allows.
    fn highest_order(&self) -> usize {
        let past = self.past_count.max(1);
        // Points laid before the start lie on a parabola.
        let laid = if self.steps < 4 { 2 } else { MOST_ORDER };
        self.max_order.min(past).min(laid)
    }

    /// The factor on the step size, and the order of the next step in `next_order`.
    fn choose_order(
        &mut self,
        system: &dyn ImplicitSystem,
        times: &[f64],
        allowed: Option<f64>,
        local_error: f64,
    ) -> f64 {
        let order = self.order;
        self.next_order = order;
        let mut growth = integrator::growth(allowed, local_error, order);
        if allowed.is_none() {
            if self.steps_at_order > order {
                self.next_order = (order + 1).min(self.max_order);
            }
            return growth;
        }
        let settled = self.steps_at_order > order;
        let failed = allowed.is_some_and(|allowed| local_error > allowed);
        if order > 1 && (settled || failed) {
            let error = self.local_error(system, times, order - 1);
            let lower = LOWER_BIAS * integrator::growth(allowed, error, order - 1);
            if lower > growth {
                growth = lower;
                self.next_order = order - 1;
            }
        }
        if settled && !failed && order < self.highest_order() {
            let error = self.local_error(system, times, order + 1);
            let higher = HIGHER_BIAS * integrator::growth(allowed, error, order + 1);
            if higher > growth {
                growth = higher;
                self.next_order = order + 1;
            }
        }
        // Formulas of high order are unstable when the steps keep growing.
        if order > 2 && self.steps_at_size < order && !failed {
            growth = growth.min(1.0);
        }
        if failed {
            // The step will be repeated.
            self.order = self.next_order;
        }
        growth
    }

    /// Describes the past about the new current configuration, as far back as one chart reaches.
    fn move_chart(&mut self) {
        let current = &self.stage.state.configuration;
        for j in 0..self.past_count {
            let Past {
                configuration,
                travel,
                ..
            } = &mut self.past[j];
            let mut largest = 0.0f64;
            for (k, travel) in travel.iter_mut().enumerate() {
                *travel = configuration.difference_at(current, k);
                if k >= current.pair_count() {
                    largest = largest.max(travel.fixed_rows::<3>(3).norm_squared());
                }
            }
            if largest > MOST_ROTATION * MOST_ROTATION {
                self.past_count = j;
                break;
            }
        }
    }
}

impl Integrator for Bdf {
    fn state(&self) -> &MotionState {
        &self.stage.state
    }

    fn advance(
        &mut self,
        system: &mut dyn ImplicitSystem,
        end_time: f64,
        step: f64,
        settings: &StepSettings,
    ) -> Result<StepOutcome, NewtonFailure> {
        if self.past_count == 0 {
            self.steps = 0;
        }
        if self.steps == 0 {
            self.lay_past(step);
        }
        self.order = self.order.min(self.highest_order());
        let times = self.times(step);
        self.prepare(&times);
        let solution = self
            .newton
            .solve(system, end_time, &mut self.stage, settings)?;
        let order = self.order;
        let local_error = self.local_error(system, &times, order);
        let growth = self.choose_order(system, &times, settings.allowed_error, local_error);
        self.trial_step = step;
        Ok(StepOutcome {
            iterations: solution.iterations,
            residual: solution.residual,
            order,
            local_error,
            growth,
        })
    }

    fn accept(&mut self) {
        let step = self.trial_step;
        let last = self.past.first().map_or(0.0, |past| past.step);
        let same_size = (step - last).abs() < 1e-3 * step;
        self.steps_at_size = if same_size { self.steps_at_size + 1 } else { 0 };
        let same_order = self.next_order == self.order;
        self.steps_at_order = if same_order {
            self.steps_at_order + 1
        } else {
            0
        };
        self.order = self.next_order;
        self.steps += 1;

        self.past.rotate_right(1);
        let stage = &mut self.stage;
        if let Some(newest) = self.past.first_mut() {
            std::mem::swap(&mut newest.configuration, &mut stage.state.configuration);
            std::mem::swap(&mut newest.velocity, &mut stage.state.velocity);
            newest.step = step;
        }
        self.past_count = (self.past_count + 1).min(self.past.len());
        std::mem::swap(&mut stage.state, &mut stage.trial);
        self.move_chart();
    }

    fn restart(&mut self, acceleration: &[Vector6]) {
        self.newton.restart();
        self.stage.state.acceleration.copy_from_slice(acceleration);
        self.past_count = 0;
        self.steps = 0;
        self.steps_at_order = 0;
        self.steps_at_size = 0;
        self.order = self.max_order.min(2);
        self.next_order = self.order;
    }
}

impl BdfStage {
    /// Trial configuration, velocity and acceleration from the travel of the step.
    ///
    /// Source: docs/theory/integration.md, eq. (12).
    fn update(&mut self) {
        let pairs = self.state.configuration.pair_count();
        let velocity = &mut self.trial.velocity;
        passes::multiple(velocity, self.leading, &self.travel);
        passes::add_multiple(velocity, 1.0, &self.past_rate);
        integrator::turn_rates(&self.travel[pairs..], &mut velocity[pairs..]);
        let acceleration = &mut self.trial.acceleration;
        acceleration.copy_from_slice(&self.past_acceleration);
        passes::add_multiple(acceleration, self.leading, velocity);
        let trial = &mut self.trial.configuration;
        trial.retract_from(&self.state.configuration, &self.travel);
    }

    /// Rate of the rotation in the travel of a frame, at the end of the step.
    fn spin(&self, k: usize) -> Vector3 {
        let rate = self.travel[k] * self.leading + self.past_rate[k];
        rate.fixed_rows::<3>(3).into()
    }
}

impl Stage for BdfStage {
    fn trial(&self) -> &MotionState {
        &self.trial
    }

    fn travel(&self) -> &[Vector6] {
        &self.travel
    }

    /// Source: docs/theory/integration.md, eq. (13).
    fn linearise(&mut self) {
        // Points do not turn: at pairs the weights stay the identity.
        for k in self.state.configuration.pair_count()..self.travel.len() {
            let turn: Vector3 = self.travel[k].fixed_rows::<3>(3).into();
            let inverse = so3::left_jacobian_inverse(&turn);
            let bend = so3::left_jacobian_derivative(&turn, &self.spin(k)) / self.leading;
            self.rotation_weights[k] = Matrix3::identity() + bend * inverse;
        }
    }

    fn weights(&self) -> TangentWeights<'_> {
        TangentWeights {
            velocity: self.leading,
            acceleration: self.leading * self.leading,
            rotation: Some(&self.rotation_weights),
        }
    }

    fn correct(&mut self, increment: &[Vector6]) {
        let pairs = self.state.configuration.pair_count();
        integrator::add_to_travel(&mut self.travel, increment, pairs);
        self.update();
    }
}

#[cfg(test)]
#[path = "bdf_tests.rs"]
mod tests;
