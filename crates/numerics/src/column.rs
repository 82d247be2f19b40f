//! Columns of a 6 x 6 block in vector registers, for the block solver.
//!
//! A column is `N` registers of the instruction set `S`: 6 numbers, and up to two idle lanes behind
//! them that hold anything.

use std::ops::Range;

use pulp::Simd;

use crate::Block6;

/// Six numbers in registers.
#[derive(Clone, Copy)]
pub(crate) struct Column<S: Simd, const N: usize>([S::f64s; N]);

impl<S: Simd, const N: usize> Column<S, N> {
    /// Numbers in the registers of a column: at least 6, at most 8.
    pub(crate) const WIDTH: usize = N * S::F64_LANES;

    #[inline(always)]
    pub(crate) fn splat(s: S, value: f64) -> Self {
        Column([s.splat_f64s(value); N])
    }

    /// Reads the width of a column from the start of `from`.
    #[inline(always)]
    pub(crate) fn read(from: &[f64]) -> Self {
        let (parts, _) = S::as_simd_f64s(&from[..Self::WIDTH]);
        Column(std::array::from_fn(|k| parts[k]))
    }

    /// Six numbers that no others need to follow.
    #[inline(always)]
    pub(crate) fn read_six(s: S, from: &[f64; 6]) -> Self {
        let mut own = Self::splat(s, 0.0);
        let mut k = 0;
        while k < N {
            own.0[k] = s.partial_load_f64s(&from[Self::part(k)]);
            k += 1;
        }
        own
    }

    /// Writes six numbers and leaves alone what follows them.
    #[inline(always)]
    pub(crate) fn write_six(self, s: S, to: &mut [f64; 6]) {
        let mut k = 0;
        while k < N {
            s.partial_store_f64s(&mut to[Self::part(k)], self.0[k]);
            k += 1;
        }
    }

    /// Those of six numbers that are in register `k`.
    #[inline(always)]
    fn part(k: usize) -> Range<usize> {
        let start = k * S::F64_LANES;
        start..(start + S::F64_LANES).min(6)
    }

    /// Column `column` of a block.
    #[inline(always)]
    pub(crate) fn of_block(s: S, block: &Block6, column: usize) -> Self {
        if column < 5 {
            Self::read(&block.0[6 * column..])
        } else {
            Self::read_six(s, block.column(5))
        }
    }

    /// The columns of a block.
    #[inline(always)]
    pub(crate) fn all_of_block(s: S, block: &Block6) -> [Self; 6] {
        let mut columns = [Self::splat(s, 0.0); 6];
        let mut k = 0;
        while k < 6 {
            columns[k] = Self::of_block(s, block, k);
            k += 1;
        }
        columns
    }

    /// Writes the width of a column to the start of `to`.
    #[inline(always)]
    pub(crate) fn write(self, to: &mut [f64]) {
        let (parts, _) = S::as_mut_simd_f64s(&mut to[..Self::WIDTH]);
        for (part, own) in parts.iter_mut().zip(self.0) {
            *part = own;
        }
    }

    /// Writes all columns of a block.
    #[inline(always)]
    pub(crate) fn write_block(s: S, columns: &[Self; 6], to: &mut Block6) {
        // In order, since each but the last writes its idle lanes over the start of the next.
        let mut k = 0;
        while k < 5 {
            columns[k].write(&mut to.0[6 * k..]);
            k += 1;
        }
        columns[5].write_six(s, to.column_mut(5));
    }

    /// self + factor x other
    #[inline(always)]
    pub(crate) fn plus(self, s: S, factor: f64, other: Self) -> Self {
        let factor = s.splat_f64s(factor);
        Column(std::array::from_fn(|k| {
            s.mul_add_e_f64s(factor, other.0[k], self.0[k])
        }))
    }

    /// self - factor x other
    #[inline(always)]
    pub(crate) fn minus(self, s: S, factor: f64, other: Self) -> Self {
        let factor = s.splat_f64s(factor);
        Column(std::array::from_fn(|k| {
            s.negate_mul_add_e_f64s(factor, other.0[k], self.0[k])
        }))
    }

    #[inline(always)]
    pub(crate) fn times(self, s: S, factor: f64) -> Self {
        let factor = s.splat_f64s(factor);
        Column(self.0.map(|part| s.mul_f64s(factor, part)))
    }

    /// The bits that both have.
    #[inline(always)]
    fn bits_of(self, s: S, other: Self) -> Self {
        Column(std::array::from_fn(|k| s.and_f64s(self.0[k], other.0[k])))
    }

    /// Zero in row `row`, all else as it is.
    #[inline(always)]
    fn cleared(self, s: S, row: usize) -> Self {
        self.bits_of(s, Self::read(&KEEP[row]))
    }

    /// Minus one in row `row`, all else as it is.
    #[inline(always)]
    fn marked(self, s: S, row: usize) -> Self {
        let (mark, kept) = (Self::read(&MARK[row]), self.cleared(s, row));
        Column(std::array::from_fn(|k| s.or_f64s(kept.0[k], mark.0[k])))
    }
}

/// All bits set but in one row.
const KEEP: [[f64; 8]; 6] = {
    let mut rows = [[f64::from_bits(u64::MAX); 8]; 6];
    let mut k = 0;
    while k < 6 {
        rows[k][k] = 0.0;
        k += 1;
    }
    rows
};

/// Minus one in one row, zero elsewhere.
const MARK: [[f64; 8]; 6] = {
    let mut rows = [[0.0; 8]; 6];
    let mut k = 0;
    while k < 6 {
        rows[k][k] = -1.0;
        k += 1;
    }
    rows
};

/// Columns times the six numbers in `factors`.
#[inline(always)]
pub(crate) fn times_six<S: Simd, const N: usize>(
    s: S,
    columns: &[Column<S, N>; 6],
    factors: &[f64],
) -> Column<S, N> {
    let even = columns[0]
        .times(s, factors[0])
        .plus(s, factors[2], columns[2])
        .plus(s, factors[4], columns[4]);
    let odd = columns[1]
        .times(s, factors[1])
        .plus(s, factors[3], columns[3])
        .plus(s, factors[5], columns[5]);
    Column(std::array::from_fn(|k| s.add_f64s(even.0[k], odd.0[k])))
}

/// `from` minus columns times the six numbers in `factors`.
#[inline(always)]
pub(crate) fn minus_six<S: Simd, const N: usize>(
    s: S,
    from: Column<S, N>,
    columns: &[Column<S, N>; 6],
    factors: &[f64],
) -> Column<S, N> {
    let even = from
        .minus(s, factors[0], columns[0])
        .minus(s, factors[2], columns[2])
        .minus(s, factors[4], columns[4]);
    let odd = columns[1]
        .times(s, factors[1])
        .plus(s, factors[3], columns[3])
        .plus(s, factors[5], columns[5]);
    Column(std::array::from_fn(|k| s.sub_f64s(even.0[k], odd.0[k])))
}

/// block <- columns block
#[inline(always)]
pub(crate) fn multiply<S: Simd, const N: usize>(
    s: S,
    columns: &[Column<S, N>; 6],
    block: &mut Block6,
) {
    let mut product = *columns;
    let mut j = 0;
    while j < 6 {
        product[j] = times_six(s, columns, block.column(j));
        j += 1;
    }
    Column::write_block(s, &product, block);
}

/// block <- block - columns other
#[inline(always)]
pub(crate) fn subtract_product<S: Simd, const N: usize>(
    s: S,
    block: &mut Block6,
    columns: &[Column<S, N>; 6],
    other: &Block6,
) {
    let mut difference = *columns;
    let mut j = 0;
    while j < 6 {
        let from = Column::of_block(s, block, j);
        difference[j] = minus_six(s, from, columns, other.column(j));
        j += 1;
    }
    Column::write_block(s, &difference, block);
}

/// Smallest pivot over the diagonal entry that it was: below it ten digits are lost, and rows must
/// change places.
const SMALLEST_PIVOT: f64 = 1e-10;

/// The inverse of a block, by Gauss-Jordan elimination with pivots on the diagonal, and whether
/// these were large enough.
///
/// Source: docs/theory/solver.md, eqs. (9) and (10).
#[inline(always)]
pub(crate) fn invert<S: Simd, const N: usize>(
    s: S,
    mut columns: [Column<S, N>; 6],
) -> ([Column<S, N>; 6], bool) {
    // Pivot rows are read back from memory, number by number.
    let mut room = [[0.0; 8]; 6];
    for (column, room) in columns.iter().zip(&mut room) {
        column.write(room);
    }
    let diagonal: [f64; 6] = std::array::from_fn(|k| room[k][k]);
    let mut pivot = diagonal[0];
    let mut safe = true;
    // Written out, so that the columns stay in registers.
    safe &= pivot_on::<S, N, 0>(s, &mut columns, &mut room, &diagonal, &mut pivot);
    safe &= pivot_on::<S, N, 1>(s, &mut columns, &mut room, &diagonal, &mut pivot);
    safe &= pivot_on::<S, N, 2>(s, &mut columns, &mut room, &diagonal, &mut pivot);
    safe &= pivot_on::<S, N, 3>(s, &mut columns, &mut room, &diagonal, &mut pivot);
    safe &= pivot_on::<S, N, 4>(s, &mut columns, &mut room, &diagonal, &mut pivot);
    safe &= pivot_on::<S, N, 5>(s, &mut columns, &mut room, &diagonal, &mut pivot);
    (columns, safe)
}

/// One step of the elimination; whether its pivot was large enough. Leaves the next pivot.
#[inline(always)]
fn pivot_on<S: Simd, const N: usize, const K: usize>(
    s: S,
    columns: &mut [Column<S, N>; 6],
    room: &mut [[f64; 8]; 6],
    diagonal: &[f64; 6],
    next: &mut f64,
) -> bool {
    let pivot = *next;
    let inverse = 1.0 / pivot;
    if K < 5 {
        // By itself, before its column is ready: the next division need not wait for that.
        *next = room[K + 1][K + 1] - room[K][K + 1] * room[K + 1][K] * inverse;
    }
    let scaled = columns[K].marked(s, K).times(s, -inverse);
    let [c0, c1, c2, c3, c4, c5] = *columns;
    let [r0, r1, r2, r3, r4, r5] = room;
    let each = |j: usize, column: Column<S, N>, room: &mut [f64; 8]| {
        let new = if j == K {
            scaled
        } else {
            column.cleared(s, K).plus(s, room[K], scaled)
        };
        new.write(room);
        new
    };
    *columns = [
        each(0, c0, r0),
        each(1, c1, r1),
        each(2, c2, r2),
        each(3, c3, r3),
        each(4, c4, r4),
        each(5, c5, r5),
    ];
    // Not true of anything that is not a number.
    pivot.abs() > SMALLEST_PIVOT * diagonal[K].abs()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dispatch::{self, Columnwise, columnwise, on_every_instruction_set};
    use proptest::prelude::*;

    struct Invert(Block6);

    impl Columnwise for Invert {
        type Output = (Block6, bool);

        #[inline(always)]
        fn run<S: Simd, const N: usize>(self, s: S) -> (Block6, bool) {
            let columns = Column::<S, N>::all_of_block(s, &self.0);
            let (inverse, safe) = invert(s, columns);
            let mut block = Block6::ZERO;
            Column::write_block(s, &inverse, &mut block);
            (block, safe)
        }
    }

    proptest! {
        #[test]
        fn a_block_times_its_inverse_is_one(
            entries in prop::array::uniform32(-1.0..1.0f64),
        ) {
            let mut block = Block6::ZERO;
            block.0[..32].copy_from_slice(&entries);
            (0..6).for_each(|k| block.add_diagonal(k, 6.0));
            let inverses = on_every_instruction_set(|| dispatch::Columns(Invert(block)));
            prop_assert!(!inverses.is_empty());
            for (inverse, safe) in inverses {
                prop_assert!(safe);
                let mut product = Block6::ZERO;
                product.subtract_product(&block, &inverse);
                for row in 0..6 {
                    for column in 0..6 {
                        let want = if row == column { -1.0 } else { 0.0 };
                        prop_assert!((product.at(row, column) - want).abs() < 1e-13);
                    }
                }
            }
        }
    }

    #[test]
    fn vanishing_pivots_are_seen() {
        let mut one = Block6::ZERO;
        (0..6).for_each(|k| one.add_diagonal(k, 1.0));
        for k in 0..5 {
            // Rows k and k + 1 are nearly alike.
            let mut block = one;
            block.0[k + 1 + 6 * k] = 1.0;
            block.0[k + 6 * (k + 1)] = 1.0 - 1e-12;
            for (_, safe) in on_every_instruction_set(|| dispatch::Columns(Invert(block))) {
                assert!(!safe, "rows {k} and {}", k + 1);
            }
        }
        assert!(!columnwise(Invert(Block6::ZERO)).1);
        one.0[3] = f64::NAN;
        assert!(!columnwise(Invert(one)).1);
    }
}
