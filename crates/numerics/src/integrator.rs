//! The seam between time integrators and those who drive them.

use crate::implicit::{ImplicitSystem, MotionState, ResidualSize};
use crate::lanes::{self, Kernel, Lane, Vec3, gather, put_records, vectorised};
use crate::newton::{NewtonFailure, NewtonSettings};
use crate::{Matrix3, Vector6};

/// What a step must meet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepSettings {
    /// When Newton's method stops.
    pub newton: NewtonSettings,
    /// Local error of a step that is aimed at [m]; `None` where the steps are fixed.
    pub allowed_error: Option<f64>,
}

/// What a converged step took.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepOutcome {
    /// Newton iterations (matrix solutions).
    pub iterations: usize,
    /// Residual at the end.
    pub residual: ResidualSize,
    /// Order of the formula.
    pub order: usize,
    /// Estimated local error of the configuration, as [`ImplicitSystem::increment_size`] [m].
    pub local_error: f64,
    /// Factor on this step's size that the next step should have, or this one when its error is
    /// more than allowed; infinite where no error is set.
    pub growth: f64,
}

/// An implicit integrator with its current state.
pub trait Integrator {
    /// The state at the end of the last accepted step.
    fn state(&self) -> &MotionState;

    /// Tries a step of size `step` to `end_time`; [`Self::accept`] makes it the current state.
    ///
    /// # Errors
    /// [`NewtonFailure`]; the current state is untouched.
    fn advance(
        &mut self,
        system: &mut dyn ImplicitSystem,
        end_time: f64,
        step: f64,
        settings: &StepSettings,
    ) -> Result<StepOutcome, NewtonFailure>;

    /// Makes the last converged trial the current state.
    fn accept(&mut self);

    /// Forgets the past and starts from the current state with this acceleration, (n): the loads
    /// have jumped.
    fn restart(&mut self, acceleration: &[Vector6]);
}

/// Share of the step with just the allowed error that the next step aims at.
const SAFETY: f64 = 0.85;

/// Size of the next step over this one, from the error of a method of order `order`.
///
/// Source: docs/theory/integration.md, eq. (9).
pub(crate) fn growth(allowed_error: Option<f64>, local_error: f64, order: usize) -> f64 {
    let root = 1.0 / (order as f64 + 1.0);
    allowed_error.map_or(f64::INFINITY, |allowed| {
        SAFETY * (allowed / local_error.max(f64::MIN_POSITIVE)).powf(root)
    })
}

/// Adds a Newton increment to the travel of a step; the first `pairs` blocks are pairs of points.
///
/// Source: docs/theory/integration.md, below eq. (6).
pub(crate) fn add_to_travel(travel: &mut [Vector6], increment: &[Vector6], pairs: usize) {
    let (of_points, of_frames) = travel.split_at_mut(pairs);
    for (travel, increment) in of_points.iter_mut().zip(increment) {
        *travel += increment;
    }
    vectorised(Adding {
        travel: of_frames,
        increment: &increment[pairs..],
    });
}

struct Adding<'a> {
    travel: &'a mut [Vector6],
    increment: &'a [Vector6],
}

impl Kernel for Adding<'_> {
    type Output = ();

    #[inline(always)]
    fn run<T: Lane>(self, token: T::Token) {
        let mut first = 0;
        while first < self.travel.len() {
            let count = (self.travel.len() - first).min(T::COUNT);
            let [x, y, z, a, b, c] = gather::<T, _, 6>(token, self.travel, first);
            let [u, v, w, d, e, f] = gather::<T, _, 6>(token, self.increment, first);
            let phi = Vec3::new(a, b, c);
            let turn = phi + lanes::left_jacobian_inverse_times(phi, Vec3::new(d, e, f));
            let sum = [x + u, y + v, z + w, turn.x, turn.y, turn.z];
            put_records(&sum, self.travel, first, count);
            first += T::COUNT;
        }
    }
}

/// Writes the inverse left Jacobians of the rotations of a travel (frames only), (n).
///
/// Source: docs/theory/rotations.md, eq. (4).
pub(crate) fn inverse_jacobians(travel: &[Vector6], inverses: &mut [Matrix3]) {
    vectorised(Inverses { travel, inverses });
}

struct Inverses<'a> {
    travel: &'a [Vector6],
    inverses: &'a mut [Matrix3],
}

impl Kernel for Inverses<'_> {
    type Output = ();

    #[inline(always)]
    fn run<T: Lane>(self, token: T::Token) {
        let mut first = 0;
        while first < self.travel.len() {
            let count = (self.travel.len() - first).min(T::COUNT);
            let [_, _, _, a, b, c] = gather::<T, _, 6>(token, self.travel, first);
            let inverse = lanes::left_jacobian_inverse(Vec3::new(a, b, c));
            put_records(&inverse.entries(), self.inverses, first, count);
            first += T::COUNT;
        }
    }
}

/// Turns the rates of rotation vectors (frames only), the last three of each of (n), into angular
/// velocities.
///
/// Source: docs/theory/integration.md, eq. (12).
pub(crate) fn turn_rates(travel: &[Vector6], rates: &mut [Vector6]) {
    vectorised(Turning { travel, rates });
}

struct Turning<'a> {
    travel: &'a [Vector6],
    rates: &'a mut [Vector6],
}

impl Kernel for Turning<'_> {
    type Output = ();

    #[inline(always)]
    fn run<T: Lane>(self, token: T::Token) {
        let mut first = 0;
        while first < self.travel.len() {
            let count = (self.travel.len() - first).min(T::COUNT);
            let [_, _, _, a, b, c] = gather::<T, _, 6>(token, self.travel, first);
            let [u, v, w, d, e, f] = gather::<T, _, 6>(token, self.rates, first);
            let spin = lanes::left_jacobian_times(Vec3::new(a, b, c), Vec3::new(d, e, f));
            let rate = [u, v, w, spin.x, spin.y, spin.z];
            put_records(&rate, self.rates, first, count);
            first += T::COUNT;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::on_every_instruction_set;
    use crate::{Vector3, so3};

    /// Everything that is done with travels here.
    struct All {
        travel: Vec<Vector6>,
        rates: Vec<Vector6>,
    }

    impl Kernel for All {
        type Output = (Vec<Vector6>, Vec<Vector6>, Vec<Matrix3>);

        #[inline(always)]
        fn run<T: Lane>(self, token: T::Token) -> Self::Output {
            let All { travel, rates } = self;
            let (mut sum, mut spins) = (travel.clone(), rates.clone());
            let mut inverses = vec![Matrix3::zeros(); travel.len()];
            Adding {
                travel: &mut sum,
                increment: &rates,
            }
            .run::<T>(token);
            Turning {
                travel: &travel,
                rates: &mut spins,
            }
            .run::<T>(token);
            Inverses {
                travel: &travel,
                inverses: &mut inverses,
            }
            .run::<T>(token);
            (sum, spins, inverses)
        }
    }

    #[test]
    fn lanes_treat_travels_as_they_are_treated_one_by_one() {
        let vectors = |n: usize, seed: f64, size: f64| -> Vec<Vector6> {
            let of =
                |k: usize| Vector6::from_fn(|row, _| (k as f64 * 1.9 + row as f64 + seed).sin());
            (0..n).map(|k| of(k) * size).collect()
        };
        for n in [1, 7, 8, 19] {
            for size in [0.01, 0.5, 1.7] {
                let (travel, rates) = (vectors(n, 0.3, size), vectors(n, 0.8, 1.0));
                let all = || All {
                    travel: travel.clone(),
                    rates: rates.clone(),
                };
                for (sum, spins, inverses) in on_every_instruction_set(all) {
                    for k in 0..n {
                        let half =
                            |x: &Vector6, row: usize| -> Vector3 { x.fixed_rows::<3>(row).into() };
                        let (turn, rate) = (half(&travel[k], 3), half(&rates[k], 3));
                        let inverse = so3::left_jacobian_inverse(&turn);
                        // A few roundings of numbers up to 4.
                        let near = |a: Vector3, b: Vector3| assert!((a - b).amax() < 1e-14);
                        assert!((inverses[k] - inverse).amax() < 1e-14);
                        near(half(&sum[k], 0), half(&travel[k], 0) + half(&rates[k], 0));
                        near(half(&sum[k], 3), turn + inverse * rate);
                        near(half(&spins[k], 0), half(&rates[k], 0));
                        near(half(&spins[k], 3), so3::left_jacobian(&turn) * rate);
                    }
                }
            }
        }
    }
}
