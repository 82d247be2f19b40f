//! Lanes in a vector register of an instruction set that is chosen while the program runs.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use pulp::{Arch, NullaryFnOnce};

use super::registers::Registers;
use super::{Kernel, Lane, MOST_LANES, Row};

/// A vector register of the instruction set `S`.
#[derive(Debug, Clone, Copy)]
pub struct Pack<S: Registers> {
    s: S,
    v: S::f64s,
}

/// Computes a kernel with the best instructions of this processor.
pub fn vectorised<K: Kernel>(kernel: K) -> K::Output {
    match Arch::new() {
        #[cfg(target_arch = "x86_64")]
        Arch::V4(s) => s.vectorize(On { kernel, s }),
        #[cfg(target_arch = "x86_64")]
        Arch::V3(s) => s.vectorize(On { kernel, s }),
        #[cfg(target_arch = "aarch64")]
        Arch::Neon(s) => s.vectorize(On { kernel, s }),
        _ => kernel.run::<Pack<pulp::Scalar>>(pulp::Scalar::new()),
    }
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

/// A kernel on registers of one kind.
struct On<K, S> {
    kernel: K,
    s: S,
}

impl<K: Kernel, S: Registers> NullaryFnOnce for On<K, S> {
    type Output = K::Output;

    #[inline(always)]
    fn call(self) -> K::Output {
        self.kernel.run::<Pack<S>>(self.s)
    }
}

/// Computes a kernel with everything that this processor has: plain numbers too.
#[cfg(test)]
pub(crate) fn on_every_instruction_set<K: Kernel>(kernel: impl Fn() -> K) -> Vec<K::Output> {
    let s = pulp::Scalar::new();
    let mut outputs = vec![
        kernel().run::<f64>(()),
        kernel().run::<Pack<pulp::Scalar>>(s),
    ];
    #[cfg(target_arch = "x86_64")]
    {
        let run = |s: pulp::x86::V3| {
            let kernel = kernel();
            s.vectorize(On { kernel, s })
        };
        outputs.extend(pulp::x86::V3::try_new().map(run));
    }
    outputs.push(vectorised(kernel()));
    outputs
}

impl<S: Registers> Pack<S> {
    #[inline(always)]
    fn new(s: S, v: S::f64s) -> Self {
        Pack { s, v }
    }
}

impl<S: Registers> Lane for Pack<S> {
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
    fn read_some(s: S, numbers: &[f64]) -> Self {
        Pack::new(s, S::as_simd_f64s(&numbers[..Self::COUNT]).0[0])
    }

    #[inline(always)]
    fn read_part(s: S, numbers: &[f64]) -> Self {
        let count = numbers.len().min(Self::COUNT);
        Pack::new(s, s.partial_load_f64s(&numbers[..count]))
    }

    #[inline(always)]
    fn write_some(self, numbers: &mut [f64]) {
        S::as_mut_simd_f64s(&mut numbers[..Self::COUNT]).0[0] = self.v;
    }

    #[inline(always)]
    fn transposed(square: [Self; MOST_LANES]) -> [Self; MOST_LANES] {
        let s = square[0].s;
        let [a, b, c, d, e, f, g, h] = square;
        let [a, b, c, d, e, f, g, h] = s.transposed([a.v, b.v, c.v, d.v, e.v, f.v, g.v, h.v]);
        [
            Pack::new(s, a),
            Pack::new(s, b),
            Pack::new(s, c),
            Pack::new(s, d),
            Pack::new(s, e),
            Pack::new(s, f),
            Pack::new(s, g),
            Pack::new(s, h),
        ]
    }

    #[inline(always)]
    fn one_on(self, next: Self) -> Self {
        Pack::new(self.s, self.s.one_on(self.v, next.v))
    }

    #[inline(always)]
    fn one_back(self, before: Self) -> Self {
        Pack::new(self.s, self.s.one_back(before.v, self.v))
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
        // A mask of bits is a number.
        if let [bits] = bytemuck::bytes_of(&mask) {
            return *bits != 0;
        }
        let marks = Self::select(mask, self.same(1.0), self.same(0.0));
        self.s.reduce_max_f64s(marks.v) > 0.0
    }
}

macro_rules! operator {
    ($trait:ident, $function:ident, $simd:ident) => {
        impl<S: Registers> $trait for Pack<S> {
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
        impl<S: Registers> $trait<f64> for Pack<S> {
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

impl<S: Registers> Neg for Pack<S> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Pack::new(self.s, self.s.neg_f64s(self.v))
    }
}

impl<S: Registers> AddAssign for Pack<S> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<S: Registers> SubAssign for Pack<S> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}
