//! Kernels that are written once and computed for several elements at a time: one in each lane of a
//! vector register, or just one as a plain number.
//!
//! A kernel is a function of a [`Lane`]. With `f64` it is ordinary scalar code, the reference; with
//! the vectors that [`vectorised`] chooses while the program runs, it computes [`Lane::COUNT`]
//! elements at once. Both differ by round-off only.
//!
//! Everything that a kernel calls must be marked `#[inline(always)]`: only then is it compiled for
//! the instructions of the processor. Closures cannot be marked, and neither can what the library
//! does with them (`map`, `from_fn`): in kernels they are for data, not for lanes.

mod functions;
mod pack;
mod records;
mod registers;
mod rotations;
mod vectors;

use std::fmt::Debug;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

pub use functions::{angle_over_sine, atan2};
#[cfg(test)]
pub(crate) use pack::on_every_instruction_set;
pub use pack::{lane_count, vectorised};
pub use records::{Record, add_records, gather, put_records};
pub use rotations::{
    exp, left_jacobian_inverse, left_jacobian_inverse_times, left_jacobian_times, orthonormalise,
};
pub use vectors::{Mat3, Vec3, block};

/// Most elements that are computed at once.
pub const MOST_LANES: usize = 8;

/// One number per element, in the order of the elements.
pub type Row = [f64; MOST_LANES];

/// A number, or a vector of numbers of which each belongs to another element.
pub trait Lane:
    Copy
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
    + AddAssign
    + SubAssign
{
    /// Proof that the processor has the instructions.
    type Token: Copy;
    /// A yes or no per element.
    type Mask: Copy;
    /// Number of elements, at most [`MOST_LANES`].
    const COUNT: usize;

    /// The same number for all elements.
    fn splat(token: Self::Token, value: f64) -> Self;

    /// The proof that this value is of.
    fn token(self) -> Self::Token;

    /// Reads the first [`Self::COUNT`] numbers.
    fn read(token: Self::Token, row: &Row) -> Self;

    /// Writes the first [`Self::COUNT`] numbers.
    fn write(self, row: &mut Row);

    /// Reads the first [`Self::COUNT`] of at least so many numbers.
    fn read_some(token: Self::Token, numbers: &[f64]) -> Self;

    /// Reads up to [`Self::COUNT`] numbers; lanes beyond them hold zero.
    fn read_part(token: Self::Token, numbers: &[f64]) -> Self;

    /// Writes the first [`Self::COUNT`] of at least so many numbers.
    fn write_some(self, numbers: &mut [f64]);

    /// Exchanges rows and columns of the square of the first [`Self::COUNT`] rows.
    fn transposed(square: [Self; MOST_LANES]) -> [Self; MOST_LANES];

    /// Where elements are consecutive: that of the next one. `next` holds those that follow.
    fn one_on(self, next: Self) -> Self;

    /// Where elements are consecutive: that of the one before. `before` holds those that precede.
    fn one_back(self, before: Self) -> Self;

    /// self x factor + addend
    fn mul_add(self, factor: Self, addend: Self) -> Self;

    /// addend - self x factor
    fn neg_mul_add(self, factor: Self, addend: Self) -> Self;

    /// Square root.
    fn sqrt(self) -> Self;

    /// Absolute value.
    fn abs(self) -> Self;

    /// Where this is less than `other`.
    fn less(self, other: Self) -> Self::Mask;

    /// `yes` where the mask says so, else `no`.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;

    /// Whether the mask is set anywhere.
    fn any(self, mask: Self::Mask) -> bool;

    /// `value` for all elements.
    #[inline(always)]
    fn same(self, value: f64) -> Self {
        Self::splat(self.token(), value)
    }

    /// Whether this is less than `bound` for all elements; false where one is not a number.
    #[inline(always)]
    fn all_less(self, bound: f64) -> bool {
        let one = self.same(1.0);
        let outside = Self::select(self.less(self.same(bound)), self.same(0.0), one);
        !self.any(self.same(0.5).less(outside))
    }
}

/// A kernel: see [`vectorised`].
pub trait Kernel {
    /// What it gives.
    type Output;

    /// Does the work; to be marked `#[inline(always)]`.
    fn run<T: Lane>(self, token: T::Token) -> Self::Output;
}

impl Lane for f64 {
    type Token = ();
    type Mask = bool;
    const COUNT: usize = 1;

    #[inline(always)]
    fn splat((): (), value: f64) -> f64 {
        value
    }

    #[inline(always)]
    fn token(self) {}

    #[inline(always)]
    fn read((): (), row: &Row) -> f64 {
        row[0]
    }

    #[inline(always)]
    fn write(self, row: &mut Row) {
        row[0] = self;
    }

    #[inline(always)]
    fn read_some((): (), numbers: &[f64]) -> f64 {
        numbers[0]
    }

    #[inline(always)]
    fn read_part((): (), numbers: &[f64]) -> f64 {
        numbers[0]
    }

    #[inline(always)]
    fn write_some(self, numbers: &mut [f64]) {
        numbers[0] = self;
    }

    #[inline(always)]
    fn transposed(square: [f64; MOST_LANES]) -> [f64; MOST_LANES] {
        square
    }

    #[inline(always)]
    fn one_on(self, next: f64) -> f64 {
        next
    }

    #[inline(always)]
    fn one_back(self, before: f64) -> f64 {
        before
    }

    #[inline(always)]
    fn mul_add(self, factor: f64, addend: f64) -> f64 {
        self * factor + addend
    }

    #[inline(always)]
    fn neg_mul_add(self, factor: f64, addend: f64) -> f64 {
        addend - self * factor
    }

    #[inline(always)]
    fn sqrt(self) -> f64 {
        f64::sqrt(self)
    }

    #[inline(always)]
    fn abs(self) -> f64 {
        f64::abs(self)
    }

    #[inline(always)]
    fn less(self, other: f64) -> bool {
        self < other
    }

    #[inline(always)]
    fn select(mask: bool, yes: f64, no: f64) -> f64 {
        if mask { yes } else { no }
    }

    #[inline(always)]
    fn any(self, mask: bool) -> bool {
        mask
    }
}
