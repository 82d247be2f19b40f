//! Formulas that are the same for every number of a run of numbers: one pass over memory, in vector
//! registers.

use crate::Vector6;
use crate::lanes::{Kernel, Lane, Record, vectorised};

/// A formula for numbers at the same place of several runs; everything is marked
/// `#[inline(always)]`.
pub(crate) trait Pass {
    /// Computes the numbers from `i` on, as many as there are lanes.
    fn step<T: Lane>(&mut self, token: T::Token, i: usize);
}

/// Computes the first `count` numbers.
pub(crate) fn pass<P: Pass>(formula: P, count: usize) {
    vectorised(Passing { formula, count });
}

struct Passing<P> {
    formula: P,
    count: usize,
}

impl<P: Pass> Kernel for Passing<P> {
    type Output = ();

    #[inline(always)]
    fn run<T: Lane>(mut self, token: T::Token) {
        let mut i = 0;
        while i + T::COUNT <= self.count {
            self.formula.step::<T>(token, i);
            i += T::COUNT;
        }
        // What does not fill a register.
        while i < self.count {
            self.formula.step::<f64>((), i);
            i += 1;
        }
    }
}

/// The numbers of vectors over frames, (6 n).
#[inline(always)]
pub(crate) fn numbers(vectors: &[Vector6]) -> &[f64] {
    Vector6::numbers(vectors)
}

/// The numbers of vectors over frames, (6 n), to be changed.
#[inline(always)]
pub(crate) fn numbers_mut(vectors: &mut [Vector6]) -> &mut [f64] {
    Vector6::numbers_mut(vectors)
}

/// The numbers from `i` on.
#[inline(always)]
pub(crate) fn read<T: Lane>(token: T::Token, numbers: &[f64], i: usize) -> T {
    T::read_some(token, &numbers[i..])
}

/// Writes the numbers from `i` on.
#[inline(always)]
pub(crate) fn write<T: Lane>(value: T, numbers: &mut [f64], i: usize) {
    value.write_some(&mut numbers[i..]);
}

/// y <- y + factor x
pub(crate) fn add_multiple(y: &mut [Vector6], factor: f64, x: &[Vector6]) {
    struct AddMultiple<'a> {
        y: &'a mut [f64],
        factor: f64,
        x: &'a [f64],
    }

    impl Pass for AddMultiple<'_> {
        #[inline(always)]
        fn step<T: Lane>(&mut self, token: T::Token, i: usize) {
            let factor = T::splat(token, self.factor);
            let sum = read::<T>(token, self.x, i).mul_add(factor, read(token, self.y, i));
            write(sum, self.y, i);
        }
    }

    let count = 6 * y.len();
    let (y, x) = (numbers_mut(y), numbers(x));
    pass(AddMultiple { y, factor, x }, count);
}

/// y <- factor x
pub(crate) fn multiple(y: &mut [Vector6], factor: f64, x: &[Vector6]) {
    struct Multiple<'a> {
        y: &'a mut [f64],
        factor: f64,
        x: &'a [f64],
    }

    impl Pass for Multiple<'_> {
        #[inline(always)]
        fn step<T: Lane>(&mut self, token: T::Token, i: usize) {
            write(read::<T>(token, self.x, i) * self.factor, self.y, i);
        }
    }

    let count = 6 * y.len();
    let (y, x) = (numbers_mut(y), numbers(x));
    pass(Multiple { y, factor, x }, count);
}
