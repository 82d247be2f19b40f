//! Functions of lanes that have no instruction: series where they converge fast, and halved angles
//! elsewhere. Nothing is called here: a call in a kernel would cost more than the function, since
//! all registers must be saved for it.

use super::Lane;

/// Below this the series of [`atan2`] is exact to the last bit but one.
const SMALL_RATIO: f64 = 0.1;
/// Below this value of 1 - cos five terms of the series of [`angle_over_sine`] are exact, and below
/// the second one (46 degrees) twenty are: each term is at most 0.15 of the one before.
const SMALL_VERSINE: f64 = 5e-3;
const MEDIUM_VERSINE: f64 = 0.3;

/// The angle of the point (x, y), -pi to pi [rad].
#[inline(always)]
pub fn atan2<T: Lane>(y: T, x: T) -> T {
    // Not for negative x.
    if (y.abs() - x * SMALL_RATIO).all_less(0.0) {
        return atan(y / x);
    }
    // Half the angle from cosine and sine, without loss of digits on either side of a right angle.
    let zero = y.same(0.0);
    let square = x.mul_add(x, y * y);
    let origin = T::select(zero.less(square), zero, y.same(1.0));
    let one_over = y.same(1.0) / (square + origin).sqrt();
    let (cos, sin) = ((x + origin) * one_over, y * one_over);
    let large = ((cos.abs() + 1.0) * 0.5).sqrt();
    let small = sin.abs() / (large + large);
    let backward = cos.less(zero);
    let (cos, sin) = (
        T::select(backward, small, large),
        T::select(backward, large, small),
    );
    // A quarter of it is within 45 degrees, and a 32nd within 6.
    let mut tan = sin / (cos + 1.0);
    let mut k = 0;
    while k < 3 {
        tan = tan / (tan.mul_add(tan, tan.same(1.0)).sqrt() + 1.0);
        k += 1;
    }
    let angle = atan(tan) * 32.0;
    T::select(y.less(zero), -angle, angle)
}

/// For ratios below 0.1.
#[inline(always)]
fn atan<T: Lane>(ratio: T) -> T {
    let q = ratio * ratio;
    // 1 - q/3 + q^2/5 - ...: with q <= 0.01 the first term left out is below 1e-17.
    let mut sum = q.same(1.0 / 17.0);
    let mut k = 8;
    while k > 0 {
        k -= 1;
        let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
        sum = sum.mul_add(q, q.same(sign / (2.0 * k as f64 + 1.0)));
    }
    ratio * sum
}

/// Angle over its sine as a function of the cosine, with its derivative by the cosine.
///
/// Source: docs/theory/dem.md, eq. (8).
#[inline(always)]
pub fn angle_over_sine<T: Lane>(cos: T) -> (T, T) {
    let y = -cos + 1.0;
    if y.all_less(SMALL_VERSINE) {
        let value = [VALUE[0], VALUE[1], VALUE[2], VALUE[3], VALUE[4]];
        let slope = [SLOPE[0], SLOPE[1], SLOPE[2], SLOPE[3], SLOPE[4]];
        return (series(y, &value), -series(y, &slope));
    }
    if y.all_less(MEDIUM_VERSINE) {
        return (series(y, &VALUE), -series(y, &SLOPE));
    }
    // A quarter of the angle is within 45 degrees: f(c) = f(h) / h with the cosine h of half of it.
    let least = cos.same(1e-12);
    let sum = cos + 1.0;
    let half = (T::select(least.less(sum), sum, least) * 0.5).sqrt();
    let quarter = ((half + 1.0) * 0.5).sqrt();
    let y = -quarter + 1.0;
    let at_quarter = (series(y, &VALUE), -series(y, &SLOPE));
    doubled(half, doubled(quarter, at_quarter))
}

/// Angle over sine and its derivative from those of half the angle, whose cosine is `half`.
#[inline(always)]
fn doubled<T: Lane>(half: T, (value, slope): (T, T)) -> (T, T) {
    let over = half.same(1.0) / half;
    let doubled = value * over;
    (doubled, (slope - doubled) * (over * over * 0.25))
}

const TERMS: usize = 20;

/// Coefficients of angle over sine by powers of 1 - cos: each is (n + 1) / (2 n + 3) of the one
/// before.
const VALUE: [f64; TERMS] = {
    let mut terms = [1.0; TERMS];
    let mut n = 0;
    while n + 1 < TERMS {
        terms[n + 1] = terms[n] * (n as f64 + 1.0) / (2.0 * n as f64 + 3.0);
        n += 1;
    }
    terms
};

/// Those of its derivative.
const SLOPE: [f64; TERMS] = {
    let mut terms = [0.0; TERMS];
    let mut n = 0;
    while n < TERMS {
        let next = VALUE[n] * (n as f64 + 1.0) / (2.0 * n as f64 + 3.0);
        terms[n] = (n as f64 + 1.0) * next;
        n += 1;
    }
    terms
};

#[inline(always)]
fn series<T: Lane, const N: usize>(y: T, coefficients: &[f64; N]) -> T {
    let mut sum = y.same(coefficients[N - 1]);
    let mut k = N - 1;
    while k > 0 {
        k -= 1;
        sum = sum.mul_add(y, y.same(coefficients[k]));
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::super::pack::on_every_instruction_set;
    use super::super::{Kernel, MOST_LANES, Row};
    use super::*;

    struct Both {
        x: Row,
        y: Row,
    }

    impl Kernel for Both {
        type Output = (usize, [Row; 3]);

        #[inline(always)]
        fn run<T: Lane>(self, token: T::Token) -> Self::Output {
            let (x, y) = (T::read(token, &self.x), T::read(token, &self.y));
            let mut rows = [[0.0; MOST_LANES]; 3];
            atan2(y, x).write(&mut rows[0]);
            let (value, slope) = angle_over_sine(x);
            value.write(&mut rows[1]);
            slope.write(&mut rows[2]);
            (T::COUNT, rows)
        }
    }

    #[test]
    fn lanes_and_numbers_agree_near_and_far() {
        let cosines = [
            [1.0, 0.999_999, 0.999, 0.996, 0.9951, 0.998, 0.9999, 0.997],
            [1.0, 0.9, -0.3, 0.999, -0.99, 0.5, 0.0, 0.9949],
            [1.0, 0.9, 0.701, 0.999, 0.75, 0.8, 0.71, 0.9949],
            [-0.9, -0.5, -0.1, 0.0, -0.95, -0.7, 0.3, 1.0],
        ];
        let heights = [
            [0.0, 1e-9, -0.05, 0.09, 0.01, -0.099, 1e-3, -1e-5],
            [1.0, -2.0, 0.3, -0.0, -0.5, 0.0, -1.0, 1e-3],
            [0.0, 1e-9, -0.05, 0.09, 0.01, -0.07, 1e-3, -1e-5],
            [1e-9, -1e-3, 2.0, -3.0, 0.5, 0.0, -0.1, 0.0],
        ];
        for (x, y) in cosines.into_iter().zip(heights) {
            for (count, rows) in on_every_instruction_set(|| Both { x, y }) {
                for k in 0..count {
                    // Some roundings of numbers of size 3.
                    assert!((rows[0][k] - y[k].atan2(x[k])).abs() < 4e-15);
                    let sin2 = (1.0 - x[k]) * (1.0 + x[k]);
                    if sin2 > 1e-4 {
                        let value = x[k].acos() / sin2.sqrt();
                        // So has the arc cosine near one.
                        assert!((rows[1][k] - value).abs() < 1e-14 * value + 1e-15 / sin2);
                        // The difference of two numbers near one has lost digits.
                        let slope = (x[k] * value - 1.0) / sin2;
                        let lost = 1e-15 / sin2 * value;
                        assert!((rows[2][k] - slope).abs() < 1e-14 * slope.abs() + lost);
                    } else {
                        // 1 + y / 3 + 2 y^2 / 15
                        let y = 1.0 - x[k];
                        assert!((rows[1][k] - 1.0 - y / 3.0).abs() < 0.2 * y * y + 1e-15);
                        assert!((rows[2][k] + 1.0 / 3.0 + 4.0 * y / 15.0).abs() < y * y + 1e-15);
                    }
                }
            }
        }
    }
}
