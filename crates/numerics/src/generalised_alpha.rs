//! Generalised-alpha on R3 x SO(3): one implicit step of a second-order system.
//!
//! The integrator sees residual, tangent, state and increment; it knows no physics.
//! Source: docs/theory/integration.md, eqs. (1) to (8); Bruls, Cardona and Arnold,
//! "Lie group generalized-alpha time integration of constrained flexible multibody systems",
//! Mech. Mach. Theory 48 (2012) 121-137, here with left multiplication of global rotations.

use crate::alpha_passes::{self, Guess, Start};
use crate::forecast::Forecast;
use crate::implicit::{CarriedMotion, ImplicitSystem, MotionState, TangentWeights};
use crate::integrator::{self, Integrator, StepOutcome, StepSettings};
use crate::newton::{Newton, NewtonFailure, Stage};
use crate::passes::add_multiple;
use crate::{Matrix3, Vector6};

/// The four coefficients of the method.
///
/// Source: docs/theory/integration.md, eq. (4); Chung and Hulbert 1993.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AlphaParameters {
    /// Weight of the old algorithmic acceleration.
    pub alpha_m: f64,
    /// Weight of the old acceleration.
    pub alpha_f: f64,
    /// Newmark beta.
    pub beta: f64,
    /// Newmark gamma.
    pub gamma: f64,
}

impl AlphaParameters {
    /// Optimal parameters for a spectral radius at infinite frequency, 0 to 1; 1 is undamped.
    pub fn with_spectral_radius(rho: f64) -> AlphaParameters {
        let alpha_m = (2.0 * rho - 1.0) / (rho + 1.0);
        let alpha_f = rho / (rho + 1.0);
        let gamma = 0.5 + alpha_f - alpha_m;
        AlphaParameters {
            alpha_m,
            alpha_f,
            beta: 0.25 * (gamma + 0.5).powi(2),
            gamma,
        }
    }

    /// Coefficient c of the local error c h2 (a_new - a_old) in the configuration.
    ///
    /// Source: docs/theory/integration.md, eq. (8).
    pub fn error_coefficient(&self) -> f64 {
        (1.0 / 6.0 - self.beta + 0.5 * (self.alpha_f - self.alpha_m)).abs()
    }
}

/// The integrator with its current state and its room for the next one.
#[derive(Debug, Clone)]
pub struct GeneralisedAlpha {
    stage: AlphaStage,
    newton: Newton,
}

impl GeneralisedAlpha {
    /// Starts from `state`, whose acceleration satisfies the equations of motion.
    pub fn new(parameters: AlphaParameters, state: MotionState) -> GeneralisedAlpha {
        let n = state.configuration.len();
        let zeros = vec![Vector6::zeros(); n];
        GeneralisedAlpha {
            stage: AlphaStage {
                parameters,
                algorithmic: state.acceleration.clone(),
                last_step: 0.0,
                carried: CarriedMotion::none(n),
                trial_carried: CarriedMotion::none(n),
                forecast: Forecast::new(n),
                carries: None,
                placed_for: 0.0,
                trial: state.clone(),
                step: 0.0,
                guess: Guess {
                    travel: zeros.clone(),
                    velocity: zeros.clone(),
                    acceleration: zeros.clone(),
                },
                corrected: false,
                travel: zeros,
                rotation_weights: vec![Matrix3::identity(); n],
                state,
            },
            newton: Newton::new(n),
        }
    }
}

impl Integrator for GeneralisedAlpha {
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
        self.stage.carry(system, end_time, step);
        self.stage.predict(step);
        let solution = self
            .newton
            .solve(system, end_time, &mut self.stage, settings)?;
        let local_error = self.stage.local_error(system, self.newton.room());
        Ok(StepOutcome {
            iterations: solution.iterations,
            residual: solution.residual,
            order: 2,
            local_error,
            growth: integrator::growth(settings.allowed_error, local_error, 2),
        })
    }

    fn accept(&mut self) {
        self.stage.accept();
    }

    fn restart(&mut self, acceleration: &[Vector6]) {
        self.newton.restart();
        let stage = &mut self.stage;
        stage.state.acceleration.copy_from_slice(acceleration);
        stage.algorithmic.copy_from_slice(acceleration);
        stage.forecast.clear();
        stage.placed_for = 0.0;
        stage.carries = None;
    }
}

/// Current state, and the trial state of the step that Newton's method works on.
#[derive(Debug, Clone)]
struct AlphaStage {
    parameters: AlphaParameters,
    state: MotionState,
    /// Algorithmic acceleration of the current state.
    algorithmic: Vec<Vector6>,
    /// Of the algorithmic acceleration.
    forecast: Forecast,
    /// Size of the last step [s].
    last_step: f64,
    /// Motion that the supports impose on the current state, and on the trial state.
    carried: CarriedMotion,
    trial_carried: CarriedMotion,
    /// Whether they impose any; `None` before the first step.
    carries: Option<bool>,
    /// Step size for which `algorithmic` is placed in time; 0 before the first step.
    placed_for: f64,
    trial: MotionState,
    /// Size of the step to the trial state [s].
    step: f64,
    /// Where constant algorithmic acceleration leads, once the trial state is elsewhere.
    guess: Guess,
    corrected: bool,
    /// Translation and rotation vector from the current to the trial configuration.
    travel: Vec<Vector6>,
    rotation_weights: Vec<Matrix3>,
}

impl AlphaStage {
    /// Finds the motion that the supports impose at both ends of a step.
    fn carry(&mut self, system: &mut dyn ImplicitSystem, end_time: f64, step: f64) {
        if self.carries.is_none() {
            let carries = system.carry(end_time - step, &mut self.carried);
            if carries {
                add_multiple(&mut self.algorithmic, -1.0, &self.carried.acceleration);
            }
            self.carries = Some(carries);
        }
        if self.carries == Some(true) {
            system.carry(end_time, &mut self.trial_carried);
        }
    }

    fn accept(&mut self) {
        self.forecast.keep(&self.algorithmic, self.step);
        if self.corrected {
            let by_travel = 1.0 / (self.parameters.beta * self.step * self.step);
            let ends = [&self.travel, &self.guess.travel];
            alpha_passes::move_algorithmic(&mut self.algorithmic, by_travel, ends);
        }
        self.forecast.learn(&self.algorithmic);
        if self.carries == Some(true) {
            std::mem::swap(&mut self.carried, &mut self.trial_carried);
        }
        self.last_step = self.step;
        self.placed_for = self.step;
        std::mem::swap(&mut self.state, &mut self.trial);
    }

    /// The algorithmic acceleration that is forecast, or else a constant one, over the step.
    fn predict(&mut self, step: f64) {
        self.step = step;
        // The algorithmic acceleration belongs to a time (alpha_m - alpha_f) h after the step's
        // start, so it moves when the step size changes (eq. (7)).
        if self.placed_for > 0.0 && self.placed_for != step {
            let AlphaParameters {
                alpha_m, alpha_f, ..
            } = self.parameters;
            let early = alpha_m - alpha_f;
            let since_last = self.last_step + early * (self.placed_for - self.last_step);
            let share = early * (step - self.placed_for) / since_last;
            let ends = self.algorithmic.iter_mut().zip(self.forecast.last());
            ends.for_each(|(newest, before)| *newest += (*newest - before) * share);
            self.placed_for = step;
        }
        let carries = self.carries == Some(true);
        let start = Start {
            state: &self.state,
            algorithmic: &self.algorithmic,
            carried: carries.then_some([&self.carried, &self.trial_carried]),
        };
        let alpha_f = self.parameters.alpha_f;
        alpha_passes::predict(&start, step, alpha_f, &mut self.travel, &mut self.trial);
        self.corrected = false;
        if let Some(weights) = self.forecast.weights(step) {
            self.keep_guess();
            let by_algorithmic = self.parameters.beta * step * step;
            let steady = &self.algorithmic;
            self.forecast
                .add_change(&weights, steady, by_algorithmic, &mut self.travel);
            let by_travel = self.by_travel();
            alpha_passes::follow(&self.travel, &self.guess, by_travel, &mut self.trial);
        }
        self.move_configuration();
    }

    /// Remembers where the trial state is, before it goes elsewhere.
    fn keep_guess(&mut self) {
        self.guess.travel.copy_from_slice(&self.travel);
        std::mem::swap(&mut self.guess.velocity, &mut self.trial.velocity);
        std::mem::swap(&mut self.guess.acceleration, &mut self.trial.acceleration);
        self.corrected = true;
    }

    /// Trial configuration from the travel of the step.
    fn move_configuration(&mut self) {
        let trial = &mut self.trial.configuration;
        trial.retract_from(&self.state.configuration, &self.travel);
    }

    /// Derivatives of velocity and acceleration by the travel of the step [1/s, 1/s2].
    ///
    /// Source: docs/theory/integration.md, eq. (5a).
    fn by_travel(&self) -> [f64; 2] {
        let AlphaParameters {
            alpha_m,
            alpha_f,
            beta,
            gamma,
        } = self.parameters;
        let step = self.step;
        [
            gamma / (beta * step),
            (1.0 - alpha_m) / ((1.0 - alpha_f) * beta * step * step),
        ]
    }

    /// Size of the local error of the trial step [m]; `change` is room for the change of acceleration, (n).
    ///
    /// Source: docs/theory/integration.md, eq. (8).
    fn local_error(&self, system: &dyn ImplicitSystem, change: &mut [Vector6]) -> f64 {
        let carries = self.carries == Some(true);
        let carried = carries.then_some([&self.carried, &self.trial_carried]);
        let ends = [&self.state, &self.trial];
        alpha_passes::change_of_acceleration(ends, carried, change);
        let factor = self.parameters.error_coefficient() * self.step * self.step;
        factor * system.increment_size(change)
    }
}

impl Stage for AlphaStage {
    fn trial(&self) -> &MotionState {
        &self.trial
    }

    fn travel(&self) -> &[Vector6] {
        &self.travel
    }

    fn linearise(&mut self) {
        // Points do not turn: at pairs the weights stay the identity.
        let pairs = self.state.configuration.pair_count();
        let weights = &mut self.rotation_weights[pairs..];
        integrator::inverse_jacobians(&self.travel[pairs..], weights);
    }

    fn weights(&self) -> TangentWeights<'_> {
        let [velocity, acceleration] = self.by_travel();
        TangentWeights {
            velocity,
            acceleration,
            rotation: Some(&self.rotation_weights),
        }
    }

    fn correct(&mut self, increment: &[Vector6]) {
        if !self.corrected {
            self.keep_guess();
        }
        let pairs = self.state.configuration.pair_count();
        integrator::add_to_travel(&mut self.travel, increment, pairs);
        let by_travel = self.by_travel();
        alpha_passes::follow(&self.travel, &self.guess, by_travel, &mut self.trial);
        self.move_configuration();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_systems::{Tumbler, assert_pairs_move_like_frames, distance, drive};
    use crate::{NewtonSettings, ResidualSize, Vector3};

    fn run(rho: f64, steps: &[f64]) -> MotionState {
        let mut system = Tumbler::free();
        let state = system.start();
        let mut alpha = GeneralisedAlpha::new(AlphaParameters::with_spectral_radius(rho), state);
        drive(&mut alpha, &mut system, steps);
        alpha.state().clone()
    }

    #[test]
    fn second_order_for_constant_and_for_varying_steps() {
        let uniform = |n: usize| vec![4.0 / n as f64; n];
        // Steps that grow from 2/3 to 4/3 of the mean.
        let varying = |n: usize| -> Vec<f64> {
            (0..n)
                .map(|k| {
                    4.0 / n as f64 * (1.0 + (2.0 * k as f64 + 1.0 - n as f64) / (3.0 * n as f64))
                })
                .collect()
        };
        let exact = run(0.8, &uniform(6400));
        for (name, errors) in [
            (
                "uniform",
                [100, 200, 400].map(|n| distance(&run(0.8, &uniform(n)), &exact)),
            ),
            (
                "varying",
                [100, 200, 400].map(|n| distance(&run(0.8, &varying(n)), &exact)),
            ),
        ] {
            let order = (errors[1] / errors[2]).log2();
            assert!(
                order > 1.9,
                "{name}: errors {errors:?}, observed order {order}"
            );
        }
    }

    /// A tumbler that is said to be carried along a curve that has little to do with its motion.
    struct Carried(Tumbler);

    impl ImplicitSystem for Carried {
        fn carry(&mut self, time: f64, carried: &mut CarriedMotion) -> bool {
            let (sin, cos) = (1.3 * time).sin_cos();
            carried.travel[0] = Vector6::new(sin, 0.2 * time, 1.0 - cos, 0.0, 0.0, 0.0);
            carried.velocity[0] = Vector6::new(1.3 * cos, 0.2, 1.3 * sin, 0.0, 0.0, 0.0);
            carried.acceleration[0] = Vector6::new(-sin, 0.0, cos, 0.0, 0.0, 0.0) * 1.69;
            true
        }

        fn frame_count(&self) -> usize {
            self.0.frame_count()
        }

        fn begin(&mut self) {
            self.0.begin();
        }

        fn assemble(
            &mut self,
            time: f64,
            state: &MotionState,
            weights: Option<&TangentWeights<'_>>,
            residual: &mut [Vector6],
        ) {
            self.0.assemble(time, state, weights, residual);
        }

        fn solve(&mut self, residual: &[Vector6], increment: &mut [Vector6]) -> Result<(), usize> {
            self.0.solve(residual, increment)
        }

        fn solve_again(&mut self, residual: &[Vector6], increment: &mut [Vector6]) {
            self.0.solve_again(residual, increment);
        }

        fn residual_size(&self, residual: &[Vector6]) -> ResidualSize {
            self.0.residual_size(residual)
        }

        fn increment_size(&self, increment: &[Vector6]) -> f64 {
            self.0.increment_size(increment)
        }
    }

    #[test]
    fn whatever_is_carried_the_answer_and_the_order_stay() {
        let exact = run(0.8, &vec![4.0 / 6400.0; 6400]);
        let error = |n: usize| {
            let mut system = Carried(Tumbler::free());
            let state = system.0.start();
            let parameters = AlphaParameters::with_spectral_radius(0.8);
            let mut alpha = GeneralisedAlpha::new(parameters, state);
            // Steps that grow from 2/3 to 4/3 of the mean.
            let growth = |k: usize| (2.0 * k as f64 + 1.0 - n as f64) / (3.0 * n as f64);
            let steps: Vec<f64> = (0..n).map(|k| 4.0 / n as f64 * (1.0 + growth(k))).collect();
            drive(&mut alpha, &mut system, &steps);
            distance(alpha.state(), &exact)
        };
        let errors = [100, 200, 400].map(error);
        let order = (errors[1] / errors[2]).log2();
        assert!(order > 1.9, "errors {errors:?}, observed order {order}");
    }

    #[test]
    fn undamped_setting_keeps_the_energy_and_the_angular_momentum() {
        let momentum = |state: &MotionState| {
            let r = state.configuration.rotation[0];
            let j = r * Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 3.0)) * r.transpose();
            j * state.velocity[0].fixed_rows::<3>(3)
        };
        let start = Vector3::new(0.3, 4.0, 1.5);
        let drift = |n: usize| (momentum(&run(1.0, &vec![20.0 / n as f64; n])) - start).norm();
        let (coarse, fine) = (drift(1000), drift(2000));
        assert!(
            fine < 1e-3 && coarse / fine > 3.5,
            "drift {coarse} and {fine}"
        );
    }

    #[test]
    fn a_step_that_does_not_converge_leaves_the_state_alone() {
        let mut system = Tumbler::free();
        let state = system.start();
        let mut alpha =
            GeneralisedAlpha::new(AlphaParameters::with_spectral_radius(0.8), state.clone());
        let settings = StepSettings {
            newton: NewtonSettings {
                tolerance_newtons: 0.0,
                max_iterations: 2,
            },
            allowed_error: None,
        };
        let failure = alpha.advance(&mut system, 0.1, 0.1, &settings).unwrap_err();
        assert_eq!(failure.iterations, 2);
        assert_eq!(alpha.state(), &state);
    }

    #[test]
    fn a_solution_may_be_off_by_little_beside_the_allowed_error() {
        let step = |tolerance_newtons: f64, allowed_error: Option<f64>| {
            let mut system = Tumbler::free();
            let state = system.start();
            let mut alpha =
                GeneralisedAlpha::new(AlphaParameters::with_spectral_radius(0.8), state);
            let settings = StepSettings {
                newton: NewtonSettings {
                    tolerance_newtons,
                    max_iterations: 12,
                },
                allowed_error,
            };
            let outcome = alpha.advance(&mut system, 0.3, 0.3, &settings).unwrap();
            alpha.accept();
            (outcome, alpha.state().clone())
        };
        let (_, exact) = step(1e-12, None);
        let (outcome, _) = step(1e-4, None);
        assert!(outcome.residual.newtons < 1e-4);
        let mut earlier = 0;
        for tolerance in [1e-4, 1e-5, 1e-6, 1e-7] {
            let (tight, _) = step(tolerance, None);
            let allowed = 1e-3;
            let (loose, state) = step(tolerance, Some(allowed));
            assert!(loose.residual.newtons <= 10.0 * tolerance);
            assert!(loose.iterations <= tight.iterations);
            earlier += tight.iterations - loose.iterations;
            let off = distance(&state, &exact);
            assert!(off <= 0.01 * allowed, "off by {off} at {tolerance}");
        }
        assert!(earlier > 0, "some solution ends earlier");
    }

    #[test]
    fn small_steps_share_a_matrix_and_large_ones_do_not() {
        let matrices = |n: usize| {
            let mut system = Tumbler::tied();
            let parameters = AlphaParameters::with_spectral_radius(0.8);
            let mut alpha = GeneralisedAlpha::new(parameters, system.start());
            let (_, iterations) = drive(&mut alpha, &mut system, &vec![4.0 / n as f64; n]);
            (system.matrices, iterations)
        };
        let (few, iterations) = matrices(20_000);
        assert!(
            few < 5000 && iterations >= 20_000,
            "{few} matrices in {iterations} iterations"
        );
        let (many, _) = matrices(40);
        assert!(many >= 40, "{many} matrices in 40 steps");
    }

    #[test]
    fn a_restart_forgets_the_matrix() {
        let mut system = Tumbler::tied();
        let parameters = AlphaParameters::with_spectral_radius(0.8);
        let mut alpha = GeneralisedAlpha::new(parameters, system.start());
        drive(&mut alpha, &mut system, &[1e-3; 100]);
        // The system makes another matrix in between, as it does to find accelerations.
        system.matrix.fill(f64::NAN);
        let acceleration = alpha.state().acceleration.clone();
        alpha.restart(&acceleration);
        drive(&mut alpha, &mut system, &[1e-3; 10]);
    }

    #[test]
    fn pairs_of_points_move_like_frames() {
        let parameters = AlphaParameters::with_spectral_radius(0.8);
        assert_pairs_move_like_frames(|state| Box::new(GeneralisedAlpha::new(parameters, state)));
    }

    #[test]
    fn parameters_of_the_literature() {
        let p = AlphaParameters::with_spectral_radius(1.0);
        assert_eq!(
            (p.alpha_m, p.alpha_f, p.beta, p.gamma),
            (0.5, 0.5, 0.25, 0.5)
        );
        let p = AlphaParameters::with_spectral_radius(0.0);
        assert_eq!(
            (p.alpha_m, p.alpha_f, p.beta, p.gamma),
            (-1.0, 0.0, 1.0, 1.5)
        );
    }
}
