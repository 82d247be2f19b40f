//! Lanes in a vector register of an instruction set that is chosen while the program runs.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use pulp::{Arch, Simd, WithSimd};

use super::{Kernel, Lane, MOST_LANES, Row};

/// A vector register of the instruction set `S`.
#[derive(Debug, Clone, Copy)]
pub struct Pack<S: Simd> {
    s: S,
    v: S::f64s,
}

/// Computes a kernel with the best instructions of this processor.
pub fn vectorised<K: Kernel>(kernel: K) -> K::Output {
    Arch::new().dispatch(OnPacks(kernel))
}

/// Elements that [`vectorised`] computes at once on this processor.
pub fn lane_count() -> usize {
    struct Count;
    impl Kernel for Count {
        type Output = usize;

        #[inline(always)]
        fn run<T: Lane>(self, _: T::Token) -> usize {
            T::COUNT
        }
    }
    vectorised(Count)
}

/// Chooses the register.
pub(super) struct OnPacks<K>(pub(super) K);

impl<K: Kernel> WithSimd for OnPacks<K> {
    type Output = K::Output;

    #[inline(always)]
    fn with_simd<S: Simd>(self, s: S) -> K::Output {
        self.0.run::<Pack<S>>(s)
    }
}

impl<S: Simd> Pack<S> {
    #[inline(always)]
    fn new(s: S, v: S::f64s) -> Self {
        Pack { s, v }
    }

    #[inline(always)]
    fn row(self) -> Row {
        let mut row = [0.0; MOST_LANES];
        self.write(&mut row);
        row
    }
}

impl<S: Simd> Lane for Pack<S> {
    type Token = S;
    type Mask = S::m64s;
    const COUNT: usize = S::F64_LANES;

    #[inline(always)]
    fn splat(s: S, value: f64) -> Self {
        Pack::new(s, s.splat_f64s(value))
    }

    #[inline(always)]
    fn token(self) -> S {
        self.s
    }

    #[inline(always)]
    fn read(s: S, row: &Row) -> Self {
        Pack::new(s, S::as_simd_f64s(row).0[0])
    }

    #[inline(always)]
    fn write(self, row: &mut Row) {
        S::as_mut_simd_f64s(row).0[0] = self.v;
    }

    #[inline(always)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        Pack::new(self.s, self.s.mul_add_e_f64s(self.v, factor.v, addend.v))
    }

    #[inline(always)]
    fn neg_mul_add(self, factor: Self, addend: Self) -> Self {
        let v = self.s.negate_mul_add_e_f64s(self.v, factor.v, addend.v);
        Pack::new(self.s, v)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Pack::new(self.s, self.s.sqrt_f64s(self.v))
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Pack::new(self.s, self.s.abs_f64s(self.v))
    }

    #[inline(always)]
    fn less(self, other: Self) -> S::m64s {
        self.s.less_than_f64s(self.v, other.v)
    }

    #[inline(always)]
    fn select(mask: S::m64s, yes: Self, no: Self) -> Self {
        Pack::new(yes.s, yes.s.select_f64s(mask, yes.v, no.v))
    }

    #[inline(always)]
    fn any(self, mask: S::m64s) -> bool {
        let marks = Self::select(mask, self.same(1.0), self.same(0.0));
        self.s.reduce_max_f64s(marks.v) > 0.0
    }

    #[inline(always)]
    fn map(self, f: impl Fn(f64) -> f64) -> Self {
        let mut row = self.row();
        row[..Self::COUNT].iter_mut().for_each(|x| *x = f(*x));
        Self::read(self.s, &row)
    }

    #[inline(always)]
    fn map_with(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        let (mut row, other) = (self.row(), other.row());
        for (x, y) in row[..Self::COUNT].iter_mut().zip(other) {
            *x = f(*x, y);
        }
        Self::read(self.s, &row)
    }
}

macro_rules! operator {
    ($trait:ident, $function:ident, $simd:ident) => {
        impl<S: Simd> $trait for Pack<S> {
            type Output = Self;

            #[inline(always)]
            fn $function(self, other: Self) -> Self {
                Pack::new(self.s, self.s.$simd(self.v, other.v))
            }
        }
    };
}

operator!(Add, add, add_f64s);
operator!(Sub, sub, sub_f64s);
operator!(Mul, mul, mul_f64s);
operator!(Div, div, div_f64s);

macro_rules! operator_with_number {
    ($trait:ident, $function:ident) => {
        impl<S: Simd> $trait<f64> for Pack<S> {
            type Output = Self;

            #[inline(always)]
            fn $function(self, other: f64) -> Self {
                self.$function(self.same(other))
            }
        }
    };
}

operator_with_number!(Add, add);
operator_with_number!(Sub, sub);
operator_with_number!(Mul, mul);

impl<S: Simd> Neg for Pack<S> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Pack::new(self.s, self.s.neg_f64s(self.v))
    }
}

impl<S: Simd> AddAssign for Pack<S> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<S: Simd> SubAssign for Pack<S> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}
