//! Records of numbers (a position, a velocity, a block of the matrix) into lanes and back, one
//! record per lane, by squares that are transposed in registers.

use super::{Lane, MOST_LANES, Row};

/// A run of numbers that is stored record after record.
pub trait Record: Copy {
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

/// The first `R` numbers of consecutive records, one record per lane. Lanes beyond the last record
/// hold the last one.
///
/// # Panics
/// If there is no record `first`.
#[inline(always)]
pub fn gather<T: Lane, I: Record, const R: usize>(
    token: T::Token,
    records: &[I],
    first: usize,
) -> [T; R] {
    let numbers = I::numbers(records);
    let begin = I::LENGTH * first;
    // Whole registers are read, which may reach beyond the last record of the lanes.
    let extent = I::LENGTH * (T::COUNT - 1) + R.max(T::COUNT);
    match numbers.get(begin..begin + extent) {
        Some(numbers) => squares::<T, I, R, true>(token, numbers, 0),
        None => {
            let last = I::LENGTH * (records.len() - 1 - first);
            squares::<T, I, R, false>(token, &numbers[begin..], last)
        }
    }
}

/// The first `R` numbers of each record. Unless they are `WHOLE`, with whole registers to be read
/// for every lane, the last record begins at `last` and is that of the lanes behind it.
#[inline(always)]
fn squares<T: Lane, I: Record, const R: usize, const WHOLE: bool>(
    token: T::Token,
    numbers: &[f64],
    last: usize,
) -> [T; R] {
    let mut values = [T::splat(token, 0.0); R];
    let mut start = 0;
    while start < R {
        // So that it ends with the record, if the record is long enough.
        let from = start.min(R.saturating_sub(T::COUNT));
        let mut square = [values[0]; MOST_LANES];
        let mut lane = 0;
        while lane < T::COUNT {
            let at = I::LENGTH * lane;
            square[lane] = if WHOLE {
                T::read_some(token, &numbers[at + from..at + from + T::COUNT])
            } else {
                T::read_part(token, &numbers[at.min(last) + from..])
            };
            lane += 1;
        }
        let square = T::transposed(square);
        let mut k = start;
        while k < R && k < from + T::COUNT {
            values[k] = square[k - from];
            k += 1;
        }
        start = from + T::COUNT;
    }
    values
}

/// Adds what the first `count` lanes hold to consecutive records, from `first` on.
///
/// # Panics
/// If there are no such records.
#[inline(always)]
pub fn add_records<T: Lane, I: Record, const R: usize>(
    values: &[T; R],
    records: &mut [I],
    first: usize,
    count: usize,
) {
    scatter::<T, I, R>(values, records, first, count, true);
}

/// Writes what the first `count` lanes hold over consecutive records, from `first` on.
///
/// # Panics
/// If there are no such records.
#[inline(always)]
pub fn put_records<T: Lane, I: Record, const R: usize>(
    values: &[T; R],
    records: &mut [I],
    first: usize,
    count: usize,
) {
    scatter::<T, I, R>(values, records, first, count, false);
}

#[inline(always)]
fn scatter<T: Lane, I: Record, const R: usize>(
    values: &[T; R],
    records: &mut [I],
    first: usize,
    count: usize,
    add: bool,
) {
    let records = &mut records[first..first + count.min(T::COUNT)];
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
            let Some(record) = records.get_mut(lane) else {
                break;
            };
            let numbers = I::numbers_mut(std::slice::from_mut(record));
            if start + T::COUNT <= R {
                put_some(square[lane], &mut numbers[start..start + T::COUNT], add);
            } else {
                // Not a number further: what is written in one piece and read in another waits.
                let mut row = [0.0; MOST_LANES];
                square[lane].write(&mut row);
                let mut at = start;
                if (R % T::COUNT) & 4 != 0 {
                    put_part::<4>(&row, at - start, numbers, at, add);
                    at += 4;
                }
                if (R % T::COUNT) & 2 != 0 {
                    put_part::<2>(&row, at - start, numbers, at, add);
                    at += 2;
                }
                if (R % T::COUNT) & 1 != 0 {
                    put_part::<1>(&row, at - start, numbers, at, add);
                }
            }
            lane += 1;
        }
        start += T::COUNT;
    }
}

#[inline(always)]
fn put_some<T: Lane>(own: T, room: &mut [f64], add: bool) {
    let sum = if add {
        T::read_some(own.token(), room) + own
    } else {
        own
    };
    sum.write_some(room);
}

/// `N` numbers of a row, from `from` on, to numbers from `at` on. Pieces of known length, since a
/// loop over them would become a call.
#[inline(always)]
fn put_part<const N: usize>(row: &Row, from: usize, numbers: &mut [f64], at: usize, add: bool) {
    let (row, room) = (&row[from..from + N], &mut numbers[at..at + N]);
    let mut sums = [0.0; N];
    let mut k = 0;
    while k < N {
        sums[k] = if add { room[k] + row[k] } else { row[k] };
        k += 1;
    }
    room.copy_from_slice(&sums);
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
        first: usize,
        count: usize,
    }

    macro_rules! and_back {
        ($type:ty, $length:literal) => {
            impl Kernel for There<$type> {
                type Output = (Vec<$type>, Vec<$type>, usize);

                #[inline(always)]
                fn run<T: Lane>(mut self, token: T::Token) -> Self::Output {
                    let values: [T; $length] = gather(token, &self.records, self.first);
                    let count = self.count.min(T::COUNT);
                    add_records(&values, &mut self.sums, self.first, count);
                    put_records(&values, &mut self.copies, self.first, count);
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
        for (first, count) in [(0, 8), (1, 8), (1, 5), (6, 3), (8, 1)] {
            let there = || There {
                records: records(none, 1.0),
                sums: records(none, 1e3),
                copies: records(none, -1.0),
                first,
                count,
            };
            for (sums, copies, count) in on_every_instruction_set(there) {
                let mut want = (there().sums, there().copies);
                for k in first..first + count {
                    let range = I::LENGTH * k..I::LENGTH * (k + 1);
                    let own = &I::numbers(&there().records)[range.clone()].to_vec();
                    let sums = &mut I::numbers_mut(&mut want.0)[range.clone()];
                    sums.iter_mut().zip(own).for_each(|(sum, own)| *sum += own);
                    I::numbers_mut(&mut want.1)[range].copy_from_slice(own);
                }
                assert_eq!((sums, copies), want, "{count} records from {first} on");
            }
        }
    }

    struct Shifts;

    impl Kernel for Shifts {
        type Output = (usize, [[f64; MOST_LANES]; 2]);

        #[inline(always)]
        fn run<T: Lane>(self, token: T::Token) -> Self::Output {
            let counted = counted(24, 1.0);
            let read = |k: usize| T::read_some(token, &counted[k * T::COUNT..]);
            let (before, here, next) = (read(0), read(1), read(2));
            let mut rows = [[0.0; MOST_LANES]; 2];
            here.one_back(before).write(&mut rows[0]);
            here.one_on(next).write(&mut rows[1]);
            (T::COUNT, rows)
        }
    }

    #[test]
    fn lanes_shift_by_one_element() {
        for (count, [back, on]) in on_every_instruction_set(|| Shifts) {
            for lane in 0..count {
                assert_eq!(back[lane], (count + lane) as f64);
                assert_eq!(on[lane], (count + lane + 2) as f64);
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
