//! Functions of lanes that have no instruction: series where they hold for all lanes, and the
//! functions of numbers elsewhere.

use super::Lane;

/// Below this the series of [`atan2`] is exact to the last bit but one.
const SMALL_RATIO: f64 = 0.1;
/// Below this value of 1 - cos the series of [`angle_over_sine`] are used.
const SMALL_VERSINE: f64 = 5e-3;

/// The angle of the point (x, y), -pi to pi [rad].
#[inline(always)]
pub fn atan2<T: Lane>(y: T, x: T) -> T {
    // Not for negative x; a quotient that is not a number goes the long way too.
    let small = (y.abs() - x * SMALL_RATIO).all_less(0.0);
    if !small {
        return y.map_with(x, f64::atan2);
    }
    let ratio = y / x;
    let q = ratio * ratio;
    // 1 - q/3 + q^2/5 - ...: with q <= 0.01 the first term left out is below 1e-17.
    let mut sum = q.same(1.0 / 17.0);
    for k in (0..8).rev() {
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
        let value = [1.0, 1.0 / 3.0, 2.0 / 15.0, 2.0 / 35.0, 8.0 / 315.0];
        let slope = [
            1.0 / 3.0,
            4.0 / 15.0,
            6.0 / 35.0,
            32.0 / 315.0,
            40.0 / 693.0,
        ];
        return (series(y, &value), -series(y, &slope));
    }
    (
        cos.map(|cos| angle_over_sine_of(cos).0),
        cos.map(|cos| angle_over_sine_of(cos).1),
    )
}

#[inline(always)]
fn series<T: Lane>(y: T, coefficients: &[f64; 5]) -> T {
    let mut sum = y.same(coefficients[4]);
    for coefficient in coefficients[..4].iter().rev() {
        sum = sum.mul_add(y, y.same(*coefficient));
    }
    sum
}

fn angle_over_sine_of(cos: f64) -> (f64, f64) {
    let y = 1.0 - cos;
    if y < SMALL_VERSINE {
        return angle_over_sine(cos);
    }
    let sin2 = (1.0 - cos * cos).max(1e-12);
    let value = cos.clamp(-1.0, 1.0).acos() / sin2.sqrt();
    (value, (cos * value - 1.0) / sin2)
}

#[cfg(test)]
mod tests {
    use super::super::pack::on_every_instruction_set;
    use super::super::{Kernel, Row};
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
            let mut rows = [[0.0; 8]; 3];
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
        ];
        let heights = [
            [0.0, 1e-9, -0.05, 0.09, 0.01, -0.099, 1e-3, -1e-5],
            [1.0, -2.0, 0.3, -0.0, -0.5, 0.0, -1.0, 1e-3],
        ];
        for (x, y) in cosines.into_iter().zip(heights) {
            for (count, rows) in on_every_instruction_set(|| Both { x, y }) {
                for k in 0..count {
                    // Two roundings of numbers of size 3.
                    assert!((rows[0][k] - y[k].atan2(x[k])).abs() < 1e-15 * 3.0);
                    let (value, slope) = angle_over_sine_of(x[k]);
                    assert!((rows[1][k] - value).abs() < 1e-14 * value);
                    assert!((rows[2][k] - slope).abs() < 1e-14 * slope.abs());
                    let sin = (1.0 - x[k] * x[k]).sqrt();
                    if sin > 1e-2 {
                        assert!((value - x[k].acos() / sin).abs() < 1e-12 * value);
                    }
                }
            }
        }
    }
}
