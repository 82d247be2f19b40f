//! The largest block of a vector over frames.

use crate::Vector6;
use crate::lanes::{Kernel, Lane, MOST_LANES, Row, Vec3, gather, vectorised};

/// How large a block of six numbers is: the length of its first half, or that of its second half
/// times a factor of the block, whichever is more.
#[derive(Debug, Clone)]
pub struct BlockMeasure {
    /// Square of the factor of each block, with zeros for idle lanes behind them.
    squares: Vec<f64>,
}

impl BlockMeasure {
    /// With the factor of each block, (n).
    pub fn new(factors: impl Iterator<Item = f64>) -> BlockMeasure {
        let mut squares: Vec<f64> = factors.map(|factor| factor * factor).collect();
        let padded = squares.len().next_multiple_of(MOST_LANES);
        squares.resize(padded, 0.0);
        BlockMeasure { squares }
    }

    /// Size and index of the largest block of `vector`, (n); of the first one with a number that is
    /// none, or too large to be squared, if there is one.
    pub fn largest(&self, vector: &[Vector6]) -> (f64, usize) {
        let found = vectorised(Largest {
            vector,
            squares: &self.squares,
        });
        if let Some((square, block)) = found {
            return (square.sqrt(), block);
        }
        let mut largest = (0.0, 0);
        for (k, (block, factor)) in vector.iter().zip(&self.squares).enumerate() {
            let first = block.fixed_rows::<3>(0).norm_squared();
            let second = block.fixed_rows::<3>(3).norm_squared() * factor;
            // What is not a number must not hide behind a comparison.
            let sum = first + second;
            if !sum.is_finite() {
                return (sum, k);
            }
            if first.max(second) > largest.0 {
                largest = (first.max(second), k);
            }
        }
        (f64::sqrt(largest.0), largest.1)
    }
}

struct Largest<'a> {
    vector: &'a [Vector6],
    squares: &'a [f64],
}

impl Kernel for Largest<'_> {
    /// Square of the size, and the block; `None` if not everything is a finite number.
    type Output = Option<(f64, usize)>;

    #[inline(always)]
    fn run<T: Lane>(self, token: T::Token) -> Self::Output {
        let zero = T::splat(token, 0.0);
        let (mut largest, mut found) = (zero, zero);
        // Stays zero as long as all numbers are finite.
        let mut spoilt = zero;
        let mut first = 0;
        while first < self.vector.len() {
            let [x, y, z, a, b, c] = gather::<T, _, 6>(token, self.vector, first);
            let head = Vec3::new(x, y, z).norm_squared();
            let factor = T::read_some(token, &self.squares[first..]);
            let rest = Vec3::new(a, b, c).norm_squared() * factor;
            let sum = head + rest;
            spoilt += sum * zero;
            let size = T::select(head.less(rest), rest, head);
            let larger = largest.less(size);
            found = T::select(larger, T::splat(token, first as f64), found);
            largest = T::select(larger, size, largest);
            first += T::COUNT;
        }
        let mut rows: [Row; 3] = [[0.0; MOST_LANES]; 3];
        largest.write(&mut rows[0]);
        found.write(&mut rows[1]);
        spoilt.write(&mut rows[2]);
        let [sizes, firsts, spoilt] = rows;
        if spoilt.iter().any(|sum| *sum != 0.0) {
            return None;
        }
        let mut best = (0.0, 0);
        for (lane, (&size, &first)) in sizes.iter().zip(&firsts).enumerate() {
            // Idle lanes repeat the last block.
            let block = (first as usize + lane).min(self.vector.len().saturating_sub(1));
            if size > best.0 || (size == best.0 && size > 0.0 && block < best.1) {
                best = (size, block);
            }
        }
        Some(best)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::on_every_instruction_set;

    fn blocks(n: usize) -> Vec<Vector6> {
        (0..n)
            .map(|k| Vector6::from_fn(|row, _| ((7 * k + row) as f64 * 1.7).sin()))
            .collect()
    }

    #[test]
    fn the_largest_block_is_found_wherever_it_is() {
        for n in [1, 2, 3, 7, 8, 9, 16, 21] {
            for place in 0..n {
                for half in 0..2 {
                    let mut vector = blocks(n);
                    vector[place][3 * half + 1] = -500.0;
                    let measure = BlockMeasure::new((0..n).map(|k| 0.5 + k as f64));
                    let own = vector[place].fixed_rows::<3>(3 * half).norm();
                    let want = own * [1.0, 0.5 + place as f64][half];
                    let found = on_every_instruction_set(|| Largest {
                        vector: &vector,
                        squares: &measure.squares,
                    });
                    for found in found {
                        let (square, block) = found.expect("all are numbers");
                        // Larger than all others, up to factors of 20.5 on sines.
                        assert_eq!(block, place, "of {n}, half {half}");
                        assert!((square.sqrt() - want).abs() < 1e-14 * want);
                    }
                }
            }
        }
    }

    #[test]
    fn what_is_no_number_does_not_hide() {
        let n = 11;
        let measure = BlockMeasure::new((0..n).map(|_| 1.0));
        for wrong in [f64::NAN, f64::INFINITY, 1e200] {
            for (place, row) in [(0, 0), (4, 5), (10, 2), (10, 3)] {
                let mut vector = blocks(n);
                vector[place][row] = wrong;
                let found = on_every_instruction_set(|| Largest {
                    vector: &vector,
                    squares: &measure.squares,
                });
                assert!(found.iter().all(Option::is_none));
                let (size, block) = measure.largest(&vector);
                assert!(!size.is_finite() && block == place);
            }
        }
        assert_eq!(measure.largest(&[]), (0.0, 0));
        assert_eq!(measure.largest(&[Vector6::zeros(); 3]), (0.0, 0));
    }
}
