//! 6 x 6 blocks: products and a pivoted factorisation, on flat column-major arrays.

use bytemuck::{Pod, Zeroable};

use crate::{Matrix3, Vector6};

/// A 6 x 6 block, column-major: entry (row, column) at `row + 6 column`.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(transparent)]
pub struct Block6(pub [f64; 36]);

impl Block6 {
    /// All zeros.
    pub const ZERO: Block6 = Block6([0.0; 36]);

    /// Entry at (row, column).
    #[inline]
    pub fn at(&self, row: usize, column: usize) -> f64 {
        self.0[row + 6 * column]
    }

    /// Adds a 3 x 3 matrix to one of the four quadrants: (0, 0) is translation-translation.
    #[inline]
    pub fn add_quadrant(&mut self, quadrant_row: usize, quadrant_column: usize, m: &Matrix3) {
        for column in 0..3 {
            let base = 3 * quadrant_row + 6 * (3 * quadrant_column + column);
            for row in 0..3 {
                self.0[base + row] += m[(row, column)];
            }
        }
    }

    /// A 3 x 3 part: rows and columns of the first (0) or second (1) three.
    pub fn quadrant(&self, quadrant_row: usize, quadrant_column: usize) -> Matrix3 {
        Matrix3::from_fn(|row, column| {
            self.at(row + 3 * quadrant_row, column + 3 * quadrant_column)
        })
    }

    /// Adds `value` to a diagonal entry.
    #[inline]
    pub fn add_diagonal(&mut self, index: usize, value: f64) {
        self.0[7 * index] += value;
    }

    /// self -= a b.
    #[inline]
    pub fn subtract_product(&mut self, a: &Block6, b: &Block6) {
        for column in 0..6 {
            let target: &mut [f64; 6] = self.column_mut(column);
            for k in 0..6 {
                let factor = b.0[k + 6 * column];
                let source = a.column(k);
                for row in 0..6 {
                    target[row] -= source[row] * factor;
                }
            }
        }
    }

    /// y += self x.
    #[inline]
    pub fn add_times(&self, x: &Vector6, y: &mut Vector6) {
        for column in 0..6 {
            let factor = x[column];
            let source = self.column(column);
            for row in 0..6 {
                y[row] += source[row] * factor;
            }
        }
    }

    /// Rows and columns exchanged.
    pub fn transposed(&self) -> Block6 {
        let mut block = Block6::ZERO;
        for column in 0..6 {
            for row in 0..6 {
                block.0[column + 6 * row] = self.at(row, column);
            }
        }
        block
    }

    /// self + factor other.
    #[inline]
    pub fn plus(&self, factor: f64, other: &Block6) -> Block6 {
        let mut sum = *self;
        for (entry, added) in sum.0.iter_mut().zip(&other.0) {
            *entry += factor * added;
        }
        sum
    }

    /// y -= self x.
    #[inline]
    pub fn subtract_times(&self, x: &Vector6, y: &mut Vector6) {
        for column in 0..6 {
            let factor = x[column];
            let source = self.column(column);
            for row in 0..6 {
                y[row] -= source[row] * factor;
            }
        }
    }

    #[inline]
    pub(crate) fn column(&self, column: usize) -> &[f64; 6] {
        self.0[6 * column..]
            .first_chunk()
            .expect("a block has six columns of six")
    }

    #[inline]
    pub(crate) fn column_mut(&mut self, column: usize) -> &mut [f64; 6] {
        self.0[6 * column..]
            .first_chunk_mut()
            .expect("a block has six columns of six")
    }
}

/// A block whose pivot vanished or is not a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SingularBlock;

/// LU factors of a [`Block6`] with row pivoting.
#[derive(Debug, Clone, Copy)]
pub struct BlockLu {
    factors: Block6,
    inverse_diagonal: [f64; 6],
    pivots: [u8; 6],
}

impl BlockLu {
    /// A placeholder to be overwritten by [`BlockLu::factorise`].
    pub const EMPTY: BlockLu = BlockLu {
        factors: Block6::ZERO,
        inverse_diagonal: [0.0; 6],
        pivots: [0; 6],
    };

    /// Factorises `block` with row pivoting.
    ///
    /// # Errors
    /// [`SingularBlock`] when a pivot is zero or not finite.
    #[inline]
    pub fn factorise(block: &Block6) -> Result<BlockLu, SingularBlock> {
        let mut a = block.0;
        let mut inverse_diagonal = [0.0; 6];
        let mut pivots = [0u8; 6];
        for k in 0..6 {
            let mut pivot = k;
            let mut largest = a[k + 6 * k].abs();
            for row in k + 1..6 {
                let candidate = a[row + 6 * k].abs();
                if candidate > largest {
                    largest = candidate;
                    pivot = row;
                }
            }
            if !(largest > 0.0 && largest.is_finite()) {
                return Err(SingularBlock);
            }
            pivots[k] = pivot as u8;
            if pivot != k {
                for column in 0..6 {
                    a.swap(k + 6 * column, pivot + 6 * column);
                }
            }
            let inverse = 1.0 / a[k + 6 * k];
            inverse_diagonal[k] = inverse;
            for row in k + 1..6 {
                a[row + 6 * k] *= inverse;
            }
            for column in k + 1..6 {
                let factor = a[k + 6 * column];
                for row in k + 1..6 {
                    a[row + 6 * column] -= a[row + 6 * k] * factor;
                }
            }
        }
        Ok(BlockLu {
            factors: Block6(a),
            inverse_diagonal,
            pivots,
        })
    }

    /// The block that was factorised, put together again from its factors.
    pub(crate) fn product(&self) -> Block6 {
        let a = &self.factors.0;
        let mut block = Block6::ZERO;
        for column in 0..6 {
            for row in 0..6 {
                // L has ones on its diagonal.
                let mut entry = if row <= column {
                    a[row + 6 * column]
                } else {
                    0.0
                };
                for k in 0..row.min(column + 1) {
                    entry += a[row + 6 * k] * a[k + 6 * column];
                }
                block.0[row + 6 * column] = entry;
            }
        }
        for k in (0..6).rev() {
            let pivot = self.pivots[k] as usize;
            for column in 0..6 {
                block.0.swap(k + 6 * column, pivot + 6 * column);
            }
        }
        block
    }

    #[inline]
    fn solve_column(&self, x: &mut [f64; 6]) {
        for k in 0..6 {
            x.swap(k, self.pivots[k] as usize);
        }
        let a = &self.factors.0;
        for k in 0..5 {
            let factor = x[k];
            for row in k + 1..6 {
                x[row] -= a[row + 6 * k] * factor;
            }
        }
        for k in (0..6).rev() {
            x[k] *= self.inverse_diagonal[k];
            let factor = x[k];
            for row in 0..k {
                x[row] -= a[row + 6 * k] * factor;
            }
        }
    }

    /// x <- A^-1 x.
    #[inline]
    pub fn solve(&self, x: &mut Vector6) {
        let mut column: [f64; 6] = (*x).into();
        self.solve_column(&mut column);
        *x = Vector6::from(column);
    }

    /// b <- A^-1 b.
    #[inline]
    pub fn solve_block(&self, b: &mut Block6) {
        for column in 0..6 {
            self.solve_column(b.column_mut(column));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn solve_inverts_the_product(
            entries in prop::array::uniform32(-1.0..1.0f64),
            x in prop::array::uniform6(-1.0..1.0f64),
        ) {
            let mut block = Block6::ZERO;
            block.0[..32].copy_from_slice(&entries);
            block.0[35] = 2.0;
            // Rows out of order, so that pivoting has work to do.
            for k in 0..6 {
                block.0[(5 - k) + 6 * k] += 4.0;
            }
            let x = Vector6::from(x);
            let mut rhs = Vector6::zeros();
            block.subtract_times(&x, &mut rhs);
            let lu = BlockLu::factorise(&block).unwrap();
            lu.solve(&mut rhs);
            prop_assert!((rhs + x).norm() < 1e-11);
            let product = lu.product();
            for (entry, want) in product.0.iter().zip(&block.0) {
                prop_assert!((entry - want).abs() < 1e-13);
            }
        }
    }

    #[test]
    fn a_singular_block_is_refused() {
        assert_eq!(BlockLu::factorise(&Block6::ZERO).err(), Some(SingularBlock));
        let mut nan = Block6::ZERO;
        nan.0[0] = f64::NAN;
        assert_eq!(BlockLu::factorise(&nan).err(), Some(SingularBlock));
    }
}
