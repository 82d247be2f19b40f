//! Generalised-alpha on R3 x SO(3): one implicit step of a second-order system.
//!
//! The integrator sees residual, tangent, state and increment; it knows no physics.
//! Source: docs/theory/integration.md, eqs. (1) to (8); Bruls, Cardona and Arnold,
//! "Lie group generalized-alpha time integration of constrained flexible multibody systems",
//! Mech. Mach. Theory 48 (2012) 121-137, here with left multiplication of global rotations.

use crate::implicit::{ImplicitSystem, MotionState, ResidualSize, TangentWeights};
use crate::{Matrix3, Vector6, so3};

/// Newton iterations before the line search looks at their residual.
const UNCHECKED_ITERATIONS: usize = 4;
/// Most halvings of an increment.
const MOST_HALVINGS: usize = 3;

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

/// When Newton's method stops.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NewtonSettings {
    /// Largest residual accepted [N].
    pub tolerance_newtons: f64,
    /// Iterations after which the step is given up.
    pub max_iterations: usize,
}

/// What a converged step took.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepOutcome {
    /// Newton iterations (matrix solutions).
    pub iterations: usize,
    /// Residual at the end.
    pub residual: ResidualSize,
    /// Estimated local error of the translations, largest over the frames [m].
    pub local_error: f64,
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

/// The integrator with its current state and its room for the next one.
#[derive(Debug, Clone)]
pub struct GeneralisedAlpha {
    parameters: AlphaParameters,
    state: MotionState,
    /// Algorithmic acceleration of the current state.
    algorithmic: Vec<Vector6>,
    /// Change of acceleration over the last step, per second.
    jerk: Vec<Vector6>,
    /// Step size for which `algorithmic` is placed in time; 0 before the first step.
    placed_for: f64,
    trial: MotionState,
    trial_algorithmic: Vec<Vector6>,
    trial_step: f64,
    /// Translation and rotation vector from the current to the trial configuration.
    travel: Vec<Vector6>,
    rotation_weights: Vec<Matrix3>,
    residual: Vec<Vector6>,
    increment: Vec<Vector6>,
}

impl GeneralisedAlpha {
    /// Starts from `state`, whose acceleration satisfies the equations of motion.
    pub fn new(parameters: AlphaParameters, state: MotionState) -> GeneralisedAlpha {
        let n = state.configuration.len();
        let zeros = vec![Vector6::zeros(); n];
        GeneralisedAlpha {
            parameters,
            algorithmic: state.acceleration.clone(),
            jerk: zeros.clone(),
            placed_for: 0.0,
            trial: state.clone(),
            trial_algorithmic: zeros.clone(),
            trial_step: 0.0,
            travel: zeros.clone(),
            rotation_weights: vec![Matrix3::identity(); n],
            residual: zeros.clone(),
            increment: zeros,
            state,
        }
    }

    /// The state at the end of the last accepted step.
    pub fn state(&self) -> &MotionState {
        &self.state
    }

    /// Tries a step of size `step` to `end_time`; [`Self::accept`] makes it the current state.
    ///
    /// # Errors
    /// [`NewtonFailure`]; the current state is untouched.
    pub fn advance(
        &mut self,
        system: &mut dyn ImplicitSystem,
        end_time: f64,
        step: f64,
        newton: &NewtonSettings,
    ) -> Result<StepOutcome, NewtonFailure> {
        self.predict(step);
        let AlphaParameters {
            alpha_m,
            alpha_f,
            beta,
            gamma,
        } = self.parameters;
        let velocity = gamma / (beta * step);
        let acceleration = (1.0 - alpha_m) / ((1.0 - alpha_f) * beta * step * step);
        system.begin();
        let mut iterations = 0;
        let mut previous = f64::INFINITY;
        loop {
            // After the first iteration the residual alone usually shows convergence; the matrix
            // is only built when it does not.
            let mut converged = false;
            if iterations > 0 {
                let residual = self.search_line(system, end_time, step, iterations, previous);
                converged = residual <= newton.tolerance_newtons;
                previous = residual;
            }
            if !converged {
                for (weight, travel) in self.rotation_weights.iter_mut().zip(&self.travel) {
                    *weight = so3::left_jacobian_inverse(&travel.fixed_rows::<3>(3).into_owned());
                }
                let rotation = Some(self.rotation_weights.as_slice());
                let weights = TangentWeights {
                    velocity,
                    acceleration,
                    rotation,
                };
                system.assemble(end_time, &self.trial, Some(&weights), &mut self.residual);
            }
            let residual = system.residual_size(&self.residual);
            let failure = NewtonFailure {
                iterations,
                residual,
                singular: false,
            };
            if !residual.newtons.is_finite() {
                return Err(failure);
            }
            if residual.newtons <= newton.tolerance_newtons {
                let local_error = self.local_error(step);
                return Ok(StepOutcome {
                    iterations,
                    residual,
                    local_error,
                });
            }
            if iterations == newton.max_iterations {
                return Err(failure);
            }
            system
                .solve(&self.residual, &mut self.increment)
                .map_err(|frame| {
                    let residual = ResidualSize { frame, ..residual };
                    NewtonFailure {
                        iterations,
                        residual,
                        singular: true,
                    }
                })?;
            iterations += 1;
            system.moving(&self.increment);
            self.correct(step);
        }
    }

    /// Evaluates the residual after an increment, and takes half of the increment back as long as
    /// it made matters worse. The first iterations go unchecked: in the mixed form their residual
    /// may rise, and the next iteration repairs it.
    fn search_line(
        &mut self,
        system: &mut dyn ImplicitSystem,
        end_time: f64,
        step: f64,
        iterations: usize,
        previous: f64,
    ) -> f64 {
        let mut halvings = 0;
        loop {
            system.assemble(end_time, &self.trial, None, &mut self.residual);
            let residual = system.residual_size(&self.residual).newtons;
            // A residual that is not a number is worse than any.
            let better = residual < previous;
            if better || iterations < UNCHECKED_ITERATIONS || halvings == MOST_HALVINGS {
                return residual;
            }
            halvings += 1;
            self.increment.iter_mut().for_each(|d| *d *= -0.5);
            self.correct(step);
            // What is left of the increment, for the next halving.
            self.increment.iter_mut().for_each(|d| *d *= -1.0);
        }
    }

    /// Makes the last converged trial the current state.
    pub fn accept(&mut self) {
        for ((jerk, new), old) in self
            .jerk
            .iter_mut()
            .zip(&self.trial.acceleration)
            .zip(&self.state.acceleration)
        {
            *jerk = (new - old) / self.trial_step;
        }
        self.placed_for = self.trial_step;
        std::mem::swap(&mut self.state, &mut self.trial);
        std::mem::swap(&mut self.algorithmic, &mut self.trial_algorithmic);
        self.state.configuration.orthonormalise();
    }

    /// Constant algorithmic acceleration over the step.
    fn predict(&mut self, step: f64) {
        self.trial.copy_from(&self.state);
        self.trial_step = step;
        // The algorithmic acceleration belongs to a time (alpha_m - alpha_f) h after the step's
        // start, so it moves when the step size changes (eq. (7)).
        let mut shift = 0.0;
        if self.placed_for > 0.0 {
            shift = (self.parameters.alpha_m - self.parameters.alpha_f) * (step - self.placed_for);
            self.placed_for = step;
        }
        for k in 0..self.travel.len() {
            self.algorithmic[k] += self.jerk[k] * shift;
            self.travel[k] =
                self.state.velocity[k] * step + self.algorithmic[k] * (0.5 * step * step);
        }
        self.update(step);
    }

    /// Adds the Newton increment to the travel of the step.
    fn correct(&mut self, step: f64) {
        for ((travel, increment), weight) in self
            .travel
            .iter_mut()
            .zip(&self.increment)
            .zip(&self.rotation_weights)
        {
            let rotation = weight * increment.fixed_rows::<3>(3);
            for row in 0..3 {
                travel[row] += increment[row];
                travel[row + 3] += rotation[row];
            }
        }
        self.update(step);
    }

    /// Trial configuration, velocity and acceleration from the travel of the step.
    fn update(&mut self, step: f64) {
        let AlphaParameters {
            alpha_m,
            alpha_f,
            beta,
            gamma,
        } = self.parameters;
        for k in 0..self.travel.len() {
            let travel = self.travel[k];
            let old = self.algorithmic[k];
            let new = (travel - self.state.velocity[k] * step - old * ((0.5 - beta) * step * step))
                / (beta * step * step);
            self.trial_algorithmic[k] = new;
            self.trial.velocity[k] =
                self.state.velocity[k] + (old * (1.0 - gamma) + new * gamma) * step;
            self.trial.acceleration[k] = (new * (1.0 - alpha_m) + old * alpha_m
                - self.state.acceleration[k] * alpha_f)
                / (1.0 - alpha_f);
            self.trial.configuration.position[k] =
                self.state.configuration.position[k] + travel.fixed_rows::<3>(0);
            self.trial.configuration.rotation[k] =
                so3::exp(&travel.fixed_rows::<3>(3).into_owned())
                    * self.state.configuration.rotation[k];
        }
    }

    fn local_error(&self, step: f64) -> f64 {
        let largest = self
            .trial
            .acceleration
            .iter()
            .zip(&self.state.acceleration)
            .map(|(new, old)| (new - old).fixed_rows::<3>(0).norm_squared())
            .fold(0.0, f64::max);
        self.parameters.error_coefficient() * step * step * largest.sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Configuration, Vector3};

    /// A heavy top without gravity: a free body with three unlike moments of inertia, tied to the
    /// origin by a spring.
    struct Tumbler {
        inertia: Matrix3,
        stiffness: f64,
        matrix: nalgebra::Matrix6<f64>,
    }

    impl ImplicitSystem for Tumbler {
        fn frame_count(&self) -> usize {
            1
        }

        fn begin(&mut self) {}

        fn assemble(
            &mut self,
            _time: f64,
            state: &MotionState,
            weights: Option<&TangentWeights<'_>>,
            residual: &mut [Vector6],
        ) {
            let evaluate = |x: Vector3, r: Matrix3, velocity: Vector6, acceleration: Vector6| {
                let w: Vector3 = velocity.fixed_rows::<3>(3).into();
                let alpha: Vector3 = acceleration.fixed_rows::<3>(3).into();
                let j = r * self.inertia * r.transpose();
                let force = acceleration.fixed_rows::<3>(0) * 2.0 + x * self.stiffness;
                let moment = j * alpha + w.cross(&(j * w));
                Vector6::new(force.x, force.y, force.z, moment.x, moment.y, moment.z)
            };
            let (x, r) = (
                state.configuration.position[0],
                state.configuration.rotation[0],
            );
            let (v, a) = (state.velocity[0], state.acceleration[0]);
            residual[0] = evaluate(x, r, v, a);
            let Some(weights) = weights else { return };
            let turn = weights.rotation.map_or(Matrix3::identity(), |list| list[0]);
            let h = 1e-6;
            for column in 0..6 {
                let mut d = Vector6::zeros();
                d[column] = h;
                let theta = d.fixed_rows::<3>(3).into_owned();
                let mut step = d;
                step.fixed_rows_mut::<3>(3).copy_from(&(turn * theta));
                let moved = |sign: f64| {
                    evaluate(
                        x + d.fixed_rows::<3>(0) * sign,
                        so3::exp(&(theta * sign)) * r,
                        v + step * (weights.velocity * sign),
                        a + step * (weights.acceleration * sign),
                    )
                };
                self.matrix
                    .set_column(column, &((moved(1.0) - moved(-1.0)) / (2.0 * h)));
            }
        }

        fn solve(&mut self, residual: &[Vector6], increment: &mut [Vector6]) -> Result<(), usize> {
            increment[0] = -self.matrix.lu().solve(&residual[0]).ok_or(0usize)?;
            Ok(())
        }

        fn residual_size(&self, residual: &[Vector6]) -> ResidualSize {
            ResidualSize {
                newtons: residual[0].norm(),
                frame: 0,
            }
        }
    }

    fn run(rho: f64, steps: &[f64]) -> MotionState {
        let mut system = Tumbler {
            inertia: Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 3.0)),
            stiffness: 8.0,
            matrix: nalgebra::Matrix6::zeros(),
        };
        let mut state = MotionState::at_rest(Configuration {
            position: vec![Vector3::new(1.0, 0.0, 0.0)],
            rotation: vec![Matrix3::identity()],
        });
        let w = Vector3::new(0.3, 2.0, 0.5);
        let alpha = -Vector3::new(
            (3.0 - 2.0) * w.y * w.z,
            (1.0 - 3.0) * w.z * w.x / 2.0,
            (2.0 - 1.0) * w.x * w.y / 3.0,
        );
        state.velocity[0] = Vector6::new(0.0, 1.0, 0.0, w.x, w.y, w.z);
        state.acceleration[0] = Vector6::new(-4.0, 0.0, 0.0, alpha.x, alpha.y, alpha.z);
        let mut alpha = GeneralisedAlpha::new(AlphaParameters::with_spectral_radius(rho), state);
        let newton = NewtonSettings {
            tolerance_newtons: 1e-9,
            max_iterations: 12,
        };
        let mut time = 0.0;
        for &step in steps {
            time += step;
            alpha.advance(&mut system, time, step, &newton).unwrap();
            alpha.accept();
        }
        alpha.state().clone()
    }

    fn distance(a: &MotionState, b: &MotionState) -> f64 {
        a.configuration.difference(&b.configuration)[0].norm()
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
        let mut system = Tumbler {
            inertia: Matrix3::identity(),
            stiffness: 8.0,
            matrix: nalgebra::Matrix6::zeros(),
        };
        let state = MotionState::at_rest(Configuration {
            position: vec![Vector3::x()],
            rotation: vec![Matrix3::identity()],
        });
        let mut alpha =
            GeneralisedAlpha::new(AlphaParameters::with_spectral_radius(0.8), state.clone());
        let newton = NewtonSettings {
            tolerance_newtons: 0.0,
            max_iterations: 2,
        };
        let failure = alpha.advance(&mut system, 0.1, 0.1, &newton).unwrap_err();
        assert_eq!(failure.iterations, 2);
        assert_eq!(alpha.state(), &state);
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
