//! What was tried for ensembles: eight chains of equal length, one in each lane, eliminated
//! together. It is here to be measured against the block solver, which takes them one by one with
//! the columns of a block in registers.

#![expect(
    clippy::needless_range_loop,
    reason = "indices are rows and columns, and iterators are not inlined into kernels"
)]

use catenix_numerics::lanes::{Kernel, Lane, MOST_LANES, Row, vectorised};
use catenix_numerics::{BlockMatrix, Vector6};

/// A 6 x 6 block per lane, by columns.
type Blocks = [Row; 36];
/// Six numbers per lane.
type Six = [Row; 6];

/// Chains and their solutions.
pub struct SideBySide {
    diagonal: Vec<Blocks>,
    upper: Vec<Blocks>,
    lower: Vec<Blocks>,
    right: Vec<Six>,
    /// D^-1 U of each frame.
    ahead: Vec<Blocks>,
    solution: Vec<Six>,
}

impl SideBySide {
    /// The same chain in each lane, with other diagonals.
    pub fn new(matrix: &BlockMatrix, right: &[Vector6]) -> SideBySide {
        let blocks = |list: &[catenix_numerics::Block6], growth: f64| -> Vec<Blocks> {
            let entry =
                |value: f64| std::array::from_fn(|lane| value * (1.0 + growth * lane as f64));
            list.iter().map(|block| block.0.map(entry)).collect()
        };
        let right: Vec<Six> = right
            .iter()
            .map(|six| std::array::from_fn(|row| [six[row]; MOST_LANES]))
            .collect();
        SideBySide {
            diagonal: blocks(&matrix.diagonal, 0.1),
            upper: blocks(&matrix.upper, 0.0),
            lower: blocks(&matrix.lower, 0.0),
            ahead: vec![[[0.0; MOST_LANES]; 36]; right.len()],
            solution: right.clone(),
            right,
        }
    }

    /// Factorises all chains and solves them.
    pub fn eliminate(&mut self) {
        vectorised(Eliminate(self));
    }

    /// Largest residual of any lane.
    pub fn error(&self) -> f64 {
        let mut worst: f64 = 0.0;
        for (k, right) in self.right.iter().enumerate() {
            for (row, right) in right.iter().enumerate() {
                for lane in 0..MOST_LANES {
                    let mut sum = -right[lane];
                    for column in 0..6 {
                        let entry = row + 6 * column;
                        let at = |k: usize| self.solution[k][column][lane];
                        sum += self.diagonal[k][entry][lane] * at(k);
                        if k + 1 < self.right.len() {
                            sum += self.upper[k][entry][lane] * at(k + 1);
                        }
                        if k > 0 {
                            sum += self.lower[k - 1][entry][lane] * at(k - 1);
                        }
                    }
                    worst = worst.max(sum.abs());
                }
            }
        }
        worst
    }
}

struct Eliminate<'a>(&'a mut SideBySide);

impl Kernel for Eliminate<'_> {
    type Output = ();

    #[inline(always)]
    fn run<T: Lane>(self, token: T::Token) {
        let chains = self.0;
        let last = chains.right.len() - 1;
        let mut pivot = read::<T, 36>(token, &chains.diagonal[0]);
        let mut right = read::<T, 6>(token, &chains.right[0]);
        for k in 0..=last {
            invert(&mut pivot);
            let mut solved = [T::splat(token, 0.0); 6];
            for column in 0..6 {
                for row in 0..6 {
                    solved[row] = pivot[6 * column + row].mul_add(right[column], solved[row]);
                }
            }
            write(&solved, &mut chains.solution[k]);
            if k == last {
                break;
            }
            right = read::<T, 6>(token, &chains.right[k + 1]);
            for column in 0..6 {
                let back = lower_column::<T>(token, &chains.lower[k], column);
                for row in 0..6 {
                    right[row] = back[row].neg_mul_add(solved[column], right[row]);
                }
            }
            let mut next = read::<T, 36>(token, &chains.diagonal[k + 1]);
            for column in 0..6 {
                let mut ahead = [T::splat(token, 0.0); 6];
                for j in 0..6 {
                    let factor = T::read(token, &chains.upper[k][6 * column + j]);
                    for row in 0..6 {
                        ahead[row] = pivot[6 * j + row].mul_add(factor, ahead[row]);
                    }
                }
                for row in 0..6 {
                    ahead[row].write(&mut chains.ahead[k][6 * column + row]);
                }
                for j in 0..6 {
                    let back = lower_column::<T>(token, &chains.lower[k], j);
                    for row in 0..6 {
                        let entry = &mut next[6 * column + row];
                        *entry = back[row].neg_mul_add(ahead[j], *entry);
                    }
                }
            }
            pivot = next;
        }
        for k in (0..last).rev() {
            let mut solved = read::<T, 6>(token, &chains.solution[k]);
            let next = read::<T, 6>(token, &chains.solution[k + 1]);
            for column in 0..6 {
                for row in 0..6 {
                    let ahead = T::read(token, &chains.ahead[k][6 * column + row]);
                    solved[row] = ahead.neg_mul_add(next[column], solved[row]);
                }
            }
            write(&solved, &mut chains.solution[k]);
        }
    }
}

#[inline(always)]
fn read<T: Lane, const R: usize>(token: T::Token, rows: &[Row; R]) -> [T; R] {
    let mut values = [T::splat(token, 0.0); R];
    let mut k = 0;
    while k < R {
        values[k] = T::read(token, &rows[k]);
        k += 1;
    }
    values
}

#[inline(always)]
fn lower_column<T: Lane>(token: T::Token, block: &Blocks, column: usize) -> [T; 6] {
    let mut values = [T::splat(token, 0.0); 6];
    let mut row = 0;
    while row < 6 {
        values[row] = T::read(token, &block[6 * column + row]);
        row += 1;
    }
    values
}

#[inline(always)]
fn write<T: Lane>(values: &[T; 6], rows: &mut Six) {
    let mut k = 0;
    while k < 6 {
        values[k].write(&mut rows[k]);
        k += 1;
    }
}

/// The inverse in place, by Gauss-Jordan steps with pivots on the diagonal.
#[inline(always)]
fn invert<T: Lane>(block: &mut [T; 36]) {
    for p in 0..6 {
        let inverse = block[7 * p].same(1.0) / block[7 * p];
        let mut column = [inverse; 6];
        for row in 0..6 {
            column[row] = block[6 * p + row];
        }
        for c in 0..6 {
            if c == p {
                continue;
            }
            let factor = block[6 * c + p] * inverse;
            for row in 0..6 {
                if row != p {
                    let entry = &mut block[6 * c + row];
                    *entry = column[row].neg_mul_add(factor, *entry);
                }
            }
            block[6 * c + p] = factor;
        }
        for row in 0..6 {
            block[6 * p + row] = -(column[row] * inverse);
        }
        block[7 * p] = inverse;
    }
}
