//! Records of numbers (a position, a velocity, a block of the matrix) into lanes and back, one
//! record per lane, by squares that are transposed in registers.

use super::{Lane, MOST_LANES};

/// A run of numbers that is stored record after record.
pub trait Record: Sized {
    /// Numbers of a record.
    const LENGTH: usize;

    /// The numbers of all records, one after another.
    fn numbers(records: &[Self]) -> &[f64];

    /// The numbers of all records, to be changed.
    fn numbers_mut(records: &mut [Self]) -> &mut [f64];
}

macro_rules! record {
    ($type:ty, $length:literal) => {
        impl Record for $type {
            const LENGTH: usize = $length;

            #[inline(always)]
            fn numbers(records: &[Self]) -> &[f64] {
                bytemuck::cast_slice(records)
            }

            #[inline(always)]
            fn numbers_mut(records: &mut [Self]) -> &mut [f64] {
                bytemuck::cast_slice_mut(records)
            }
        }
    };
}

record!(crate::Vector3, 3);
record!(crate::Vector6, 6);
record!(crate::Matrix3, 9);
record!(crate::Block6, 36);

/// Where the square of numbers that begins at `start` begins, so that it ends with the record if
/// the record is long enough.
#[inline(always)]
fn begin<T: Lane>(start: usize, length: usize) -> usize {
    start.min(length.saturating_sub(T::COUNT))
}

/// The first `R` numbers of the records `index`, one record per lane.
///
/// # Panics
/// If there is no such record.
#[inline(always)]
pub fn gather<T: Lane, I: Record, const R: usize>(
    token: T::Token,
    records: &[I],
    index: &[usize; MOST_LANES],
) -> [T; R] {
    let numbers = I::numbers(records);
    let zero = T::splat(token, 0.0);
    let mut values = [zero; R];
    let mut start = 0;
    while start < R {
        let first = begin::<T>(start, R);
        let mut square = [zero; MOST_LANES];
        let mut lane = 0;
        while lane < T::COUNT {
            let at = I::LENGTH * index[lane] + first;
            square[lane] = if at + T::COUNT <= numbers.len() {
                T::read_some(token, &numbers[at..at + T::COUNT])
            } else {
                last(token, &numbers[at..])
            };
            lane += 1;
        }
        let square = T::transposed(square);
        let mut k = start;
        while k < R && k < first + T::COUNT {
            values[k] = square[k - first];
            k += 1;
        }
        start = first + T::COUNT;
    }
    values
}

/// Fewer numbers than lanes, at the very end.
#[inline(always)]
fn last<T: Lane>(token: T::Token, numbers: &[f64]) -> T {
    let mut room = [0.0; MOST_LANES];
    room[..numbers.len()].copy_from_slice(numbers);
    T::read(token, &room)
}

/// Adds to the records `index` what the lanes hold, as many records as there are indices.
///
/// # Panics
/// If there is no such record.
#[inline(always)]
pub fn add_records<T: Lane, I: Record, const R: usize>(
    values: &[T; R],
    records: &mut [I],
    index: &[usize],
) {
    scatter::<T, I, R>(values, records, index, true);
}

/// Writes what the lanes hold over the records `index`, as many records as there are indices.
///
/// # Panics
/// If there is no such record.
#[inline(always)]
pub fn put_records<T: Lane, I: Record, const R: usize>(
    values: &[T; R],
    records: &mut [I],
    index: &[usize],
) {
    scatter::<T, I, R>(values, records, index, false);
}

#[inline(always)]
fn scatter<T: Lane, I: Record, const R: usize>(
    values: &[T; R],
    records: &mut [I],
    index: &[usize],
    add: bool,
) {
    let numbers = I::numbers_mut(records);
    let mut start = 0;
    while start < R {
        let mut square = [values[start]; MOST_LANES];
        let mut k = 0;
        while k < T::COUNT && start + k < R {
            square[k] = values[start + k];
            k += 1;
        }
        let square = T::transposed(square);
        let mut lane = 0;
        while lane < T::COUNT {
            if lane < index.len() {
                let at = I::LENGTH * index[lane] + start;
                if start + T::COUNT <= R {
                    let room = &mut numbers[at..at + T::COUNT];
                    let own = square[lane];
                    let sum = if add {
                        T::read_some(own.token(), room) + own
                    } else {
                        own
                    };
                    sum.write_some(room);
                } else {
                    // Not a number further: what is written in one piece and read in another waits.
                    let mut row = [0.0; MOST_LANES];
                    square[lane].write(&mut row);
                    let room = &mut numbers[at..at + R - start];
                    let mut k = 0;
                    while k < R - start {
                        room[k] = if add { room[k] + row[k] } else { row[k] };
                        k += 1;
                    }
                }
            }
            lane += 1;
        }
        start += T::COUNT;
    }
}

#[cfg(test)]
mod tests {
    use super::super::Kernel;
    use super::super::pack::on_every_instruction_set;
    use super::*;
    use crate::{Block6, Matrix3, Vector3, Vector6};

    /// Records of `n` counted numbers each.
    fn counted(n: usize, factor: f64) -> Vec<f64> {
        (0..n).map(|k| factor * (k as f64 + 1.0)).collect()
    }

    fn records<I: Record + Clone>(none: I, factor: f64) -> Vec<I> {
        let mut records = vec![none; 9];
        let numbers = counted(9 * I::LENGTH, factor);
        I::numbers_mut(&mut records).copy_from_slice(&numbers);
        records
    }

    /// Gathers records, adds them to others and writes them over others.
    struct There<I> {
        records: Vec<I>,
        sums: Vec<I>,
        copies: Vec<I>,
        index: [usize; MOST_LANES],
        count: usize,
    }

    macro_rules! and_back {
        ($type:ty, $length:literal) => {
            impl Kernel for There<$type> {
                type Output = (Vec<$type>, Vec<$type>, usize);

                #[inline(always)]
                fn run<T: Lane>(mut self, token: T::Token) -> Self::Output {
                    let values: [T; $length] = gather(token, &self.records, &self.index);
                    let count = self.count.min(T::COUNT);
                    add_records(&values, &mut self.sums, &self.index[..count]);
                    put_records(&values, &mut self.copies, &self.index[..count]);
                    (self.sums, self.copies, count)
                }
            }
        };
    }

    and_back!(Vector3, 3);
    and_back!(Vector6, 6);
    and_back!(Matrix3, 9);
    and_back!(Block6, 36);

    fn check<I: Record + Clone + PartialEq + std::fmt::Debug>(none: I)
    where
        There<I>: Kernel<Output = (Vec<I>, Vec<I>, usize)>,
    {
        for (index, count) in [
            ([1, 2, 3, 4, 5, 6, 7, 8], 8),
            ([8, 0, 5, 2, 7, 7, 7, 7], 5),
            ([0, 8, 1, 1, 1, 1, 1, 1], 2),
        ] {
            let there = || There {
                records: records(none.clone(), 1.0),
                sums: records(none.clone(), 1e3),
                copies: records(none.clone(), -1.0),
                index,
                count,
            };
            for (sums, copies, count) in on_every_instruction_set(there) {
                let mut want = (there().sums, there().copies);
                for &k in &index[..count] {
                    let range = I::LENGTH * k..I::LENGTH * (k + 1);
                    let own = &I::numbers(&there().records)[range.clone()].to_vec();
                    let sums = &mut I::numbers_mut(&mut want.0)[range.clone()];
                    sums.iter_mut().zip(own).for_each(|(sum, own)| *sum += own);
                    I::numbers_mut(&mut want.1)[range].copy_from_slice(own);
                }
                assert_eq!((sums, copies), want, "records {index:?}, {count} of them");
            }
        }
    }

    #[test]
    fn records_go_into_lanes_and_back() {
        check(Vector3::zeros());
        check(Vector6::zeros());
        check(Matrix3::zeros());
        check(Block6::ZERO);
    }
}
