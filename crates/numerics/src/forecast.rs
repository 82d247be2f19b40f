//! A forecast of vectors over frames that come at equal steps of time: the next one as a sum of the
//! last ones, with the weights that would have served best so far.
//!
//! Waves and what follows them repeat; a few weights are enough to carry several frequencies on.
//! Source: docs/theory/integration.md, eqs. (28) and (29).

use nalgebra::SMatrix;

use crate::Vector6;
use crate::lanes::{Kernel, Lane, MOST_LANES, vectorised};
use crate::passes::{Pass, numbers, numbers_mut, pass, read, write};

/// Vectors that a forecast is a sum of.
const TERMS: usize = 6;
/// What a step counts against the one after it, when weights are sought.
const MEMORY: f64 = 0.95;
/// Added to the diagonal of the normal equations, over its first entry: what repeats exactly has
/// more than one set of weights.
const RIDGE: f64 = 1e-6;
/// Difference of two steps' sizes that are taken as equal, over their size.
const EQUAL: f64 = 1e-9;

/// Products of the newest vector (first) and those before it, with each other.
type Products = SMatrix<f64, { TERMS + 1 }, { TERMS + 1 }>;

/// Factors on the newest vector and those before it.
pub(crate) type Weights = [f64; TERMS];

/// The last vectors, and what is known of how one follows from those before it.
#[derive(Debug, Clone)]
pub(crate) struct Forecast {
    /// The last vectors, newest first, (n) each.
    past: [Vec<Vector6>; TERMS],
    /// How many there have been at equal steps.
    count: usize,
    /// Size of the steps between them [s].
    step: f64,
    products: Products,
    /// Sum of the products of all steps, of which older ones count less.
    sums: Products,
}

impl Forecast {
    pub(crate) fn new(frame_count: usize) -> Forecast {
        Forecast {
            past: std::array::from_fn(|_| vec![Vector6::zeros(); frame_count]),
            count: 0,
            step: 0.0,
            products: Products::zeros(),
            sums: Products::zeros(),
        }
    }

    /// Forgets the past.
    pub(crate) fn clear(&mut self) {
        self.count = 0;
        self.sums.fill(0.0);
    }

    /// Keeps the vector, (n), that `newest` of [`Self::learn`] follows after a step of this size [s].
    pub(crate) fn keep(&mut self, vector: &[Vector6], step: f64) {
        if !self.is_at(step) {
            self.clear();
            self.step = step;
        }
        self.past.rotate_right(1);
        self.past[0].copy_from_slice(vector);
        self.count += 1;
    }

    /// The vector that was kept last, (n).
    pub(crate) fn last(&self) -> &[Vector6] {
        &self.past[0]
    }

    /// Learns from the vector, (n), that follows those that are kept.
    pub(crate) fn learn(&mut self, newest: &[Vector6]) {
        let older = self.products.fixed_view::<TERMS, TERMS>(0, 0).into_owned();
        self.products
            .fixed_view_mut::<TERMS, TERMS>(1, 1)
            .copy_from(&older);
        let sums = vectorised(ProductsWith {
            newest: numbers(newest),
            past: self.past.each_ref().map(|vector| numbers(vector)),
        });
        for (k, sum) in sums.into_iter().enumerate() {
            self.products[(0, k)] = sum;
            self.products[(k, 0)] = sum;
        }
        // The first vector of all was never the newest: it must be gone.
        if self.count > TERMS {
            self.sums = self.sums * MEMORY + self.products;
        }
    }

    /// Adds the change from `newest`, the last vector, to the forecast times `factor` to `sum`, (n)
    /// each.
    pub(crate) fn add_change(
        &self,
        weights: &Weights,
        newest: &[Vector6],
        factor: f64,
        sum: &mut [Vector6],
    ) {
        let mut weights = *weights;
        weights[0] -= 1.0;
        let [a, b, c, d, e, _] = self.past.each_ref().map(|vector| numbers(vector));
        let formula = AddSum {
            weights: weights.map(|weight| weight * factor),
            vectors: [numbers(newest), a, b, c, d, e],
            sum: numbers_mut(sum),
        };
        pass(formula, 6 * newest.len());
    }

    fn is_at(&self, step: f64) -> bool {
        (self.step - step).abs() <= EQUAL * step
    }

    /// Weights for a step of this size [s]; none where nothing is known.
    pub(crate) fn weights(&self, step: f64) -> Option<Weights> {
        if !self.is_at(step) {
            return None;
        }
        let mut normal = self.sums.fixed_view::<TERMS, TERMS>(1, 1).into_owned();
        let ridge = RIDGE * normal[(0, 0)];
        for k in 0..TERMS {
            normal[(k, k)] += ridge;
        }
        let right = self.sums.fixed_view::<TERMS, 1>(1, 0).into_owned();
        // Sums of nothing, or of numbers that are none, have no factors.
        Some(normal.cholesky()?.solve(&right).into())
    }
}

/// Scalar products of the newest vector with itself and with those before it.
struct ProductsWith<'a> {
    newest: &'a [f64],
    past: [&'a [f64]; TERMS],
}

impl ProductsWith<'_> {
    /// Adds the products of the numbers from `i` on, as many as there are lanes.
    #[inline(always)]
    fn add<T: Lane>(&self, token: T::Token, i: usize, sums: &mut [T; TERMS + 1]) {
        let newest = read::<T>(token, self.newest, i);
        sums[0] = newest.mul_add(newest, sums[0]);
        let mut k = 0;
        while k < TERMS {
            sums[k + 1] = newest.mul_add(read(token, self.past[k], i), sums[k + 1]);
            k += 1;
        }
    }
}

impl Kernel for ProductsWith<'_> {
    type Output = [f64; TERMS + 1];

    #[inline(always)]
    fn run<T: Lane>(self, token: T::Token) -> Self::Output {
        let mut sums = [T::splat(token, 0.0); TERMS + 1];
        let count = self.newest.len();
        let mut i = 0;
        while i + T::COUNT <= count {
            self.add(token, i, &mut sums);
            i += T::COUNT;
        }
        let mut totals = [0.0; TERMS + 1];
        // What does not fill a register.
        while i < count {
            self.add((), i, &mut totals);
            i += 1;
        }
        let mut k = 0;
        while k <= TERMS {
            let mut row = [0.0; MOST_LANES];
            sums[k].write(&mut row);
            let mut lane = 0;
            while lane < MOST_LANES {
                totals[k] += row[lane];
                lane += 1;
            }
            k += 1;
        }
        totals
    }
}

/// sum <- sum + weights . vectors
struct AddSum<'a> {
    weights: [f64; TERMS],
    vectors: [&'a [f64]; TERMS],
    sum: &'a mut [f64],
}

impl Pass for AddSum<'_> {
    #[inline(always)]
    fn step<T: Lane>(&mut self, token: T::Token, i: usize) {
        let mut sum = read::<T>(token, self.sum, i);
        let mut k = 0;
        while k < TERMS {
            let weight = T::splat(token, self.weights[k]);
            sum = read::<T>(token, self.vectors[k], i).mul_add(weight, sum);
            k += 1;
        }
        write(sum, self.sum, i);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Frames that swing with frequencies of their own share of two or three, at step `k`.
    fn swing(frames: usize, waves: usize, k: usize) -> Vec<Vector6> {
        let time = 0.6 * k as f64;
        (0..frames)
            .map(|frame| {
                Vector6::from_fn(|row, _| {
                    (0..waves)
                        .map(|wave| {
                            let phase = (frame * 7 + row * 3 + wave * 5) as f64;
                            let amplitude = 1.0 + (phase * 1.3).sin();
                            amplitude * ((0.7 + 0.6 * wave as f64) * time + phase).cos()
                        })
                        .sum()
                })
            })
            .collect()
    }

    fn taught(frames: usize, waves: usize, steps: usize) -> Forecast {
        let mut forecast = Forecast::new(frames);
        for k in 0..steps {
            forecast.keep(&swing(frames, waves, k), 0.6);
            forecast.learn(&swing(frames, waves, k + 1));
        }
        forecast
    }

    #[test]
    fn sums_of_waves_are_carried_on() {
        for (frames, waves) in [(1, 1), (5, 2), (11, 3)] {
            let forecast = taught(frames, waves, 20);
            let (last, next) = (swing(frames, waves, 20), swing(frames, waves, 21));
            let mut sum = vec![Vector6::zeros(); frames];
            let weights = forecast.weights(0.6).expect("there is a past");
            forecast.add_change(&weights, &last, 2.0, &mut sum);
            let (mut error, mut change): (f64, f64) = (0.0, 0.0);
            for ((sum, last), next) in sum.iter().zip(&last).zip(&next) {
                error = error.max((sum * 0.5 + last - next).norm());
                change = change.max((next - last).norm());
            }
            assert!(
                error < 1e-3 * change,
                "{waves} waves: {error} of a change of {change}"
            );
        }
    }

    #[test]
    fn there_is_no_forecast_without_a_past_at_equal_steps() {
        let last = swing(3, 2, 20);
        assert!(taught(3, 2, TERMS).weights(0.6).is_none());
        let mut forecast = taught(3, 2, 20);
        assert!(forecast.weights(0.5).is_none());
        forecast.keep(&last, 0.5);
        forecast.learn(&last);
        assert!(forecast.weights(0.5).is_none());
        // Rest, and a number that is none.
        for number in [0.0, f64::NAN] {
            let mut forecast = Forecast::new(3);
            let vector = vec![Vector6::repeat(number); 3];
            for _ in 0..20 {
                forecast.keep(&vector, 0.6);
                forecast.learn(&vector);
            }
            assert!(forecast.weights(0.6).is_none());
        }
    }
}
