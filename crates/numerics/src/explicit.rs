//! Central differences: an explicit integrator for systems whose mass matrix falls into blocks.
//!
//! It takes as many steps within each step that it is asked for as its limit of stability needs,
//! and solves no system of equations but one block of mass at a time.
//! Source: docs/theory/integration.md, eqs. (24) to (27).

use crate::Vector6;
use crate::implicit::{ImplicitSystem, MotionState, ResidualSize};
use crate::integrator::{Integrator, StepOutcome, StepSettings};
use crate::newton::NewtonFailure;

/// What an explicit integrator needs of a system.
pub trait ExplicitSystem {
    /// Replaces the accelerations of `state` by those that its configuration and velocities have
    /// at `time`.
    ///
    /// # Errors
    /// The block whose mass is singular.
    fn accelerate(&mut self, time: f64, state: &mut MotionState) -> Result<(), usize>;

    /// A step that [`CentralDifferences`] can take from `state` without becoming unstable [s].
    fn stable_step(&mut self, time: f64, state: &MotionState) -> f64;
}

/// Largest stable step over the period of a motion, times its angular frequency, that is damped by
/// the share `damping` of its critical damping.
///
/// Source: docs/theory/integration.md, eq. (27).
pub fn stability_limit(damping: f64) -> f64 {
    let twice = 2.0 * damping;
    // 2 (sqrt(1 + 4 xi^2) - 2 xi) without the difference of large numbers.
    2.0 / ((1.0 + twice * twice).sqrt() + twice)
}

/// The integrator with its current state and its room for the next one.
#[derive(Debug, Clone)]
pub struct CentralDifferences {
    share: f64,
    state: MotionState,
    trial: MotionState,
    shift: Vec<Vector6>,
    steps: usize,
}

impl CentralDifferences {
    /// Starts from `state`, whose acceleration satisfies the equations of motion, and takes steps
    /// of at most `share` of what the system says is stable; an infinite share takes each step as
    /// it is asked for.
    pub fn new(share: f64, state: MotionState) -> CentralDifferences {
        CentralDifferences {
            share,
            trial: state.clone(),
            shift: vec![Vector6::zeros(); state.configuration.len()],
            state,
            steps: 0,
        }
    }

    /// Steps taken so far, those of trials that were not accepted included.
    pub fn steps(&self) -> usize {
        self.steps
    }

    /// Takes `count` steps of one size from the current state, with the loads of one `time`
    /// throughout, and accepts them; the state at the end.
    ///
    /// # Errors
    /// The block whose mass is singular.
    pub fn advance_steps(
        &mut self,
        system: &mut dyn ExplicitSystem,
        time: f64,
        step: f64,
        count: usize,
    ) -> Result<&MotionState, usize> {
        self.trial.clone_from(&self.state);
        for _ in 0..count {
            self.advance_trial(system, time, step)?;
        }
        self.accept();
        Ok(&self.state)
    }

    /// One step of the trial state.
    ///
    /// Source: docs/theory/integration.md, eq. (24).
    fn advance_trial(
        &mut self,
        system: &mut dyn ExplicitSystem,
        time: f64,
        step: f64,
    ) -> Result<(), usize> {
        let trial = &mut self.trial;
        let motion = trial.velocity.iter_mut().zip(&trial.acceleration);
        for (shift, (velocity, acceleration)) in self.shift.iter_mut().zip(motion) {
            let change = acceleration * step;
            *shift = (*velocity + change * 0.5) * step;
            // Forces that depend on velocity see the velocity of the end, extrapolated.
            *velocity += change;
        }
        trial.configuration.retract(&self.shift);
        system.accelerate(time, trial)?;
        // From there back to the velocity of the middle, and on with the new acceleration.
        for k in 0..trial.velocity.len() {
            trial.velocity[k] = self.shift[k] / step + trial.acceleration[k] * (0.5 * step);
        }
        self.steps += 1;
        Ok(())
    }
}

impl Integrator for CentralDifferences {
    fn state(&self) -> &MotionState {
        &self.state
    }

    fn advance(
        &mut self,
        system: &mut dyn ImplicitSystem,
        end_time: f64,
        step: f64,
        _settings: &StepSettings,
    ) -> Result<StepOutcome, NewtonFailure> {
        let failure = |iterations: usize, frame: usize, singular: bool| NewtonFailure {
            iterations,
            residual: ResidualSize {
                newtons: f64::NAN,
                frame,
            },
            singular,
        };
        // A system that has no explicit side is as if it were singular: nothing can be done.
        let system = system.explicit().ok_or_else(|| failure(0, 0, true))?;
        let stable = self.share * system.stable_step(end_time - step, &self.state);
        let count = (step / stable).ceil().max(1.0);
        if !count.is_finite() {
            return Err(failure(0, 0, false));
        }
        let size = step / count;
        let count = count as usize;
        self.trial.clone_from(&self.state);
        for k in 1..=count {
            let time = end_time - (count - k) as f64 * size;
            self.advance_trial(system, time, size)
                .map_err(|frame| failure(k, frame, true))?;
        }
        let lost = |x: &Vector6| !x.iter().all(|entry| entry.is_finite());
        if let Some(frame) = self.trial.velocity.iter().position(lost) {
            return Err(failure(count, frame, false));
        }
        Ok(StepOutcome {
            iterations: count,
            residual: ResidualSize {
                newtons: 0.0,
                frame: 0,
            },
            order: 2,
            local_error: 0.0,
            growth: f64::INFINITY,
        })
    }

    fn accept(&mut self) {
        std::mem::swap(&mut self.state, &mut self.trial);
    }

    fn restart(&mut self, acceleration: &[Vector6]) {
        self.state.acceleration.copy_from_slice(acceleration);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_systems::{Dumbbell, Oscillator, Tumbler, assert_pairs_move_like_frames};
    use crate::test_systems::{distance, drive};

    fn free_of_limits(state: MotionState) -> CentralDifferences {
        CentralDifferences::new(f64::INFINITY, state)
    }

    #[test]
    fn second_order_on_rotations_and_with_damping() {
        let exact = Tumbler::tied().runge_kutta(&Tumbler::tied().start(), 2.0, 8000);
        let tumbler = |n: usize| {
            let mut system = Tumbler::tied();
            let mut integrator = free_of_limits(system.start());
            drive(&mut integrator, &mut system, &vec![2.0 / n as f64; n]);
            distance(integrator.state(), &exact)
        };
        let oscillator = |n: usize| {
            let mut system = Oscillator { damping: 0.3 };
            let mut integrator = free_of_limits(system.start());
            drive(&mut integrator, &mut system, &vec![2.0 / n as f64; n]);
            (integrator.state().configuration.position[0].x - system.exact(2.0)).abs()
        };
        for errors in [
            [100, 200, 400].map(tumbler),
            [100, 200, 400].map(oscillator),
        ] {
            let order = (errors[1] / errors[2]).log2();
            assert!(order > 1.9, "errors {errors:?}, order {order}");
        }
    }

    #[test]
    fn pairs_of_points_move_like_frames() {
        assert_pairs_move_like_frames(|state| Box::new(free_of_limits(state)));
    }

    /// Whether the oscillator stays bounded over 2000 steps.
    fn holds(damping: f64, step: f64) -> bool {
        let mut system = Oscillator { damping };
        let mut integrator = free_of_limits(system.start());
        let time = |k: usize| step * k as f64;
        (1..=2000).all(|k| {
            let done = integrator.advance(&mut system, time(k), step, &crate::test_systems::FIXED);
            integrator.accept();
            done.is_ok() && integrator.state().configuration.position[0].norm() < 1e3
        })
    }

    #[test]
    fn the_limit_of_stability_is_that_of_theory() {
        for damping in [0.0, 0.02, 0.2, 1.0, 3.0] {
            let limit = stability_limit(damping);
            // Just beyond the limit the motion doubles within some hundred steps.
            assert!(holds(damping, 0.999 * limit), "damping {damping}");
            assert!(!holds(damping, 1.01 * limit), "damping {damping}");
            // Nor is there another gap below it.
            assert!((1..20).all(|k| holds(damping, 0.05 * f64::from(k) * limit)));
        }
        assert_eq!(stability_limit(0.0), 2.0);
    }

    #[test]
    fn long_steps_are_split_and_a_system_without_an_explicit_side_is_refused() {
        let mut system = Oscillator { damping: 0.0 };
        let mut integrator = CentralDifferences::new(0.9, system.start());
        drive(&mut integrator, &mut system, &[10.0, 10.0]);
        // Each second takes 1 / (0.9 x 2) steps.
        assert_eq!(integrator.steps(), 12);

        let mut pair = Dumbbell::new(true);
        pair.explicit = false;
        let state = pair.start();
        let mut integrator = free_of_limits(state.clone());
        let failure = integrator
            .advance(&mut pair, 0.1, 0.1, &crate::test_systems::FIXED)
            .unwrap_err();
        assert!(failure.singular);
        assert_eq!(integrator.state(), &state);
    }
}
