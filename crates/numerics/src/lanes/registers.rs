//! What lanes need of an instruction set beyond arithmetic.

use pulp::Simd;

use super::MOST_LANES;

/// The vector registers of an instruction set.
pub trait Registers: Simd {
    /// Exchanges rows and columns of the square of the first `F64_LANES` rows.
    fn transposed(self, rows: [Self::f64s; MOST_LANES]) -> [Self::f64s; MOST_LANES];

    /// All numbers of `here` but the first, and the first of `next`.
    fn one_on(self, here: Self::f64s, next: Self::f64s) -> Self::f64s;

    /// The last number of `before`, and all of `here` but the last.
    fn one_back(self, before: Self::f64s, here: Self::f64s) -> Self::f64s;
}

impl Registers for pulp::Scalar {
    #[inline(always)]
    fn transposed(self, rows: [f64; MOST_LANES]) -> [f64; MOST_LANES] {
        rows
    }

    #[inline(always)]
    fn one_on(self, _: f64, next: f64) -> f64 {
        next
    }

    #[inline(always)]
    fn one_back(self, before: f64, _: f64) -> f64 {
        before
    }
}

#[cfg(target_arch = "x86_64")]
mod x86 {
    use std::arch::x86_64::{__m256d, __m512d};

    use pulp::x86::{V3, V4};
    use pulp::{cast, f64x4, f64x8};

    use super::{MOST_LANES, Registers};

    impl Registers for V4 {
        #[inline(always)]
        fn transposed(self, rows: [f64x8; MOST_LANES]) -> [f64x8; MOST_LANES] {
            let v = self.avx512f;
            let [a, b, c, d, e, f, g, h]: [__m512d; 8] = cast(rows);
            // Pairs of rows, then of pairs, then of fours: (a0 b0 a2 b2 ..), (a0 b0 a4 b4 c0 ..), ..
            let even = [
                v._mm512_unpacklo_pd(a, b),
                v._mm512_unpacklo_pd(c, d),
                v._mm512_unpacklo_pd(e, f),
                v._mm512_unpacklo_pd(g, h),
            ];
            let odd = [
                v._mm512_unpackhi_pd(a, b),
                v._mm512_unpackhi_pd(c, d),
                v._mm512_unpackhi_pd(e, f),
                v._mm512_unpackhi_pd(g, h),
            ];
            let [c0, c2, c4, c6] = self.fours(even);
            let [c1, c3, c5, c7] = self.fours(odd);
            cast([c0, c1, c2, c3, c4, c5, c6, c7])
        }

        #[inline(always)]
        fn one_on(self, here: f64x8, next: f64x8) -> f64x8 {
            let v = self.avx512f;
            cast(v._mm512_alignr_epi64::<1>(cast(next), cast(here)))
        }

        #[inline(always)]
        fn one_back(self, before: f64x8, here: f64x8) -> f64x8 {
            let v = self.avx512f;
            cast(v._mm512_alignr_epi64::<7>(cast(here), cast(before)))
        }
    }

    /// Steps of the transposition.
    trait Fours {
        /// Columns 0, 2, 4 and 6 of four pairs of rows.
        fn fours(self, pairs: [__m512d; 4]) -> [__m512d; 4];
    }

    impl Fours for V4 {
        #[inline(always)]
        fn fours(self, [p, q, r, s]: [__m512d; 4]) -> [__m512d; 4] {
            let v = self.avx512f;
            let (low, high) = (
                [
                    v._mm512_shuffle_f64x2::<0x88>(p, q),
                    v._mm512_shuffle_f64x2::<0x88>(r, s),
                ],
                [
                    v._mm512_shuffle_f64x2::<0xdd>(p, q),
                    v._mm512_shuffle_f64x2::<0xdd>(r, s),
                ],
            );
            [
                v._mm512_shuffle_f64x2::<0x88>(low[0], low[1]),
                v._mm512_shuffle_f64x2::<0x88>(high[0], high[1]),
                v._mm512_shuffle_f64x2::<0xdd>(low[0], low[1]),
                v._mm512_shuffle_f64x2::<0xdd>(high[0], high[1]),
            ]
        }
    }

    impl Registers for V3 {
        #[inline(always)]
        fn transposed(self, rows: [f64x4; MOST_LANES]) -> [f64x4; MOST_LANES] {
            let v = self.avx;
            let [a, b, c, d, ..]: [__m256d; MOST_LANES] = cast(rows);
            let (even, odd) = (
                [v._mm256_unpacklo_pd(a, b), v._mm256_unpacklo_pd(c, d)],
                [v._mm256_unpackhi_pd(a, b), v._mm256_unpackhi_pd(c, d)],
            );
            let square: [f64x4; 4] = cast([
                v._mm256_permute2f128_pd::<0x20>(even[0], even[1]),
                v._mm256_permute2f128_pd::<0x20>(odd[0], odd[1]),
                v._mm256_permute2f128_pd::<0x31>(even[0], even[1]),
                v._mm256_permute2f128_pd::<0x31>(odd[0], odd[1]),
            ]);
            let [a, b, c, d] = square;
            [a, b, c, d, rows[4], rows[5], rows[6], rows[7]]
        }

        #[inline(always)]
        fn one_on(self, here: f64x4, next: f64x4) -> f64x4 {
            let (v, here, next) = (self.avx, cast(here), cast(next));
            // (h2 h3 n0 n1), then (h1 h2), (h3 n0).
            let middle = v._mm256_permute2f128_pd::<0x21>(here, next);
            cast(v._mm256_shuffle_pd::<0b0101>(here, middle))
        }

        #[inline(always)]
        fn one_back(self, before: f64x4, here: f64x4) -> f64x4 {
            let (v, before, here) = (self.avx, cast(before), cast(here));
            // (b2 b3 h0 h1), then (b3 h0), (h1 h2).
            let middle = v._mm256_permute2f128_pd::<0x21>(before, here);
            cast(v._mm256_shuffle_pd::<0b0101>(middle, here))
        }
    }
}

#[cfg(target_arch = "aarch64")]
impl Registers for pulp::aarch64::Neon {
    #[inline(always)]
    fn transposed(self, rows: [Self::f64s; MOST_LANES]) -> [Self::f64s; MOST_LANES] {
        let ([a, b], [c, d]): ([f64; 2], [f64; 2]) = (pulp::cast(rows[0]), pulp::cast(rows[1]));
        let mut turned = rows;
        turned[0] = pulp::cast([a, c]);
        turned[1] = pulp::cast([b, d]);
        turned
    }

    #[inline(always)]
    fn one_on(self, here: Self::f64s, next: Self::f64s) -> Self::f64s {
        let ([_, b], [c, _]): ([f64; 2], [f64; 2]) = (pulp::cast(here), pulp::cast(next));
        pulp::cast([b, c])
    }

    #[inline(always)]
    fn one_back(self, before: Self::f64s, here: Self::f64s) -> Self::f64s {
        let ([_, b], [c, _]): ([f64; 2], [f64; 2]) = (pulp::cast(before), pulp::cast(here));
        pulp::cast([b, c])
    }
}
