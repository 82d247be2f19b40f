//! Rotations in lanes: what a step does to every frame. [`crate::so3`] has the same functions for
//! one rotation.
//!
//! Source: docs/theory/rotations.md.

use super::{Lane, MOST_LANES, Mat3, Row, Vec3};

/// Squared angles below which the series are exact to rounding with few terms, and with all [rad2].
const FEW_SUFFICE: f64 = 0.04;
const ALL_SUFFICE: f64 = 1.0;
/// Terms of the series. The first one left out is below 1e-17 in either range.
const FEW: usize = 6;
const ALL: usize = 10;

/// Series in the square of the angle: (-1)^k / (2k + `least`)!
const fn circular(least: usize) -> [f64; ALL] {
    let mut series = [0.0; ALL];
    let mut k = 0;
    while k < ALL {
        let mut factorial = if k % 2 == 0 { 1.0 } else { -1.0 };
        let mut factor = 2;
        while factor <= 2 * k + least {
            factorial *= factor as f64;
            factor += 1;
        }
        series[k] = 1.0 / factorial;
        k += 1;
    }
    series
}

/// sin(t) / t
const SINE: [f64; ALL] = circular(1);
/// (1 - cos t) / t^2
const VERSINE: [f64; ALL] = circular(2);
/// (t - sin t) / t^3
const REST: [f64; ALL] = circular(3);
/// (1 - t/2 cot(t/2)) / t^2: the numbers |B_2k| / (2k)! of Bernoulli. They fall by 4 pi^2 each.
const COTANGENT: [f64; ALL] = [
    1.0 / 12.0,
    1.0 / 720.0,
    1.0 / 30_240.0,
    1.0 / 1_209_600.0,
    1.0 / 47_900_160.0,
    691.0 / 1_307_674_368_000.0,
    1.0 / 74_724_249_600.0,
    3617.0 / 10_670_622_842_880_000.0,
    43_867.0 / 5_109_094_217_170_944_000.0,
    174_611.0 / 802_857_662_698_291_200_000.0,
];

/// Rotation matrix of a rotation vector.
///
/// Source: docs/theory/rotations.md, eq. (1).
#[inline(always)]
pub fn exp<T: Lane>(phi: Vec3<T>) -> Mat3<T> {
    let s = phi.norm_squared();
    let [a, b] = coefficients(s, [&SINE, &VERSINE], [sine_over_angle, versine_over_square]);
    with_coefficients(phi, s, a, b)
}

/// The left Jacobian of `phi`, times `d`.
///
/// Source: docs/theory/rotations.md, eq. (3).
#[inline(always)]
pub fn left_jacobian_times<T: Lane>(phi: Vec3<T>, d: Vec3<T>) -> Vec3<T> {
    let s = phi.norm_squared();
    let [a, b] = coefficients(s, [&VERSINE, &REST], [versine_over_square, rest_over_cube]);
    let across = phi.cross(d);
    d.plus(a, across).plus(b, phi.cross(across))
}

/// Inverse of the left Jacobian of `phi`.
///
/// Source: docs/theory/rotations.md, eq. (4).
#[inline(always)]
pub fn left_jacobian_inverse<T: Lane>(phi: Vec3<T>) -> Mat3<T> {
    let s = phi.norm_squared();
    let [b] = coefficients(s, [&COTANGENT], [cotangent_over_square]);
    with_coefficients(phi, s, s.same(-0.5), b)
}

/// Inverse of the left Jacobian of `phi`, times `d`.
///
/// Source: docs/theory/rotations.md, eq. (4).
#[inline(always)]
pub fn left_jacobian_inverse_times<T: Lane>(phi: Vec3<T>, d: Vec3<T>) -> Vec3<T> {
    let [b] = coefficients(phi.norm_squared(), [&COTANGENT], [cotangent_over_square]);
    let across = phi.cross(d);
    d.plus(d.x.same(-0.5), across).plus(b, phi.cross(across))
}

/// Pulls matrices that drifted off the rotations by round-off back on.
///
/// Source: docs/theory/rotations.md, eq. (7).
#[inline(always)]
pub fn orthonormalise<T: Lane>(r: Mat3<T>) -> Mat3<T> {
    let [x, y, z] = r.0;
    let (half, most) = (x.x.same(-0.5), x.x.same(1.5));
    let (xy, yz, zx) = (x.dot(y) * half, y.dot(z) * half, z.dot(x) * half);
    Mat3([
        (x * x.dot(x).mul_add(half, most)).plus(xy, y).plus(zx, z),
        (y * y.dot(y).mul_add(half, most)).plus(yz, z).plus(xy, x),
        (z * z.dot(z).mul_add(half, most)).plus(zx, x).plus(yz, y),
    ])
}

/// I + a [phi] + b [phi]^2, with s = phi . phi
#[inline(always)]
fn with_coefficients<T: Lane>(phi: Vec3<T>, s: T, a: T, b: T) -> Mat3<T> {
    // [phi]^2 = phi phi^T - s I
    let diagonal = s.neg_mul_add(b, s.same(1.0));
    (phi * b)
        .outer(phi)
        .plus_diagonal(diagonal)
        .plus_hat(phi * a)
}

/// Functions of the square of the angle, by their series where these hold in all lanes.
#[inline(always)]
fn coefficients<T: Lane, const N: usize>(
    s: T,
    of: [&[f64; ALL]; N],
    else_by: [fn(f64) -> f64; N],
) -> [T; N] {
    let mut values = [s; N];
    let mut k = 0;
    if s.all_less(FEW_SUFFICE) {
        while k < N {
            values[k] = series::<T, FEW>(s, of[k]);
            k += 1;
        }
    } else if s.all_less(ALL_SUFFICE) {
        while k < N {
            values[k] = series::<T, ALL>(s, of[k]);
            k += 1;
        }
    } else {
        let mut row = [0.0; MOST_LANES];
        s.write(&mut row);
        let rows = one_by_one(&row, else_by);
        while k < N {
            values[k] = T::read(s.token(), &rows[k]);
            k += 1;
        }
    }
    values
}

/// Functions of large angles: a step in which something turns so far is rare.
#[cold]
#[inline(never)]
fn one_by_one<const N: usize>(squares: &Row, of: [fn(f64) -> f64; N]) -> [Row; N] {
    of.map(|of| squares.map(of))
}

#[inline(always)]
fn series<T: Lane, const TERMS: usize>(s: T, coefficients: &[f64; ALL]) -> T {
    let mut sum = s.same(coefficients[TERMS - 1]);
    let mut k = TERMS - 1;
    while k > 0 {
        k -= 1;
        sum = sum.mul_add(s, s.same(coefficients[k]));
    }
    sum
}

fn sine_over_angle(s: f64) -> f64 {
    if s < ALL_SUFFICE {
        return series::<f64, ALL>(s, &SINE);
    }
    s.sqrt().sin() / s.sqrt()
}

fn versine_over_square(s: f64) -> f64 {
    if s < ALL_SUFFICE {
        return series::<f64, ALL>(s, &VERSINE);
    }
    (1.0 - s.sqrt().cos()) / s
}

fn rest_over_cube(s: f64) -> f64 {
    if s < ALL_SUFFICE {
        return series::<f64, ALL>(s, &REST);
    }
    (s.sqrt() - s.sqrt().sin()) / (s * s.sqrt())
}

fn cotangent_over_square(s: f64) -> f64 {
    if s < ALL_SUFFICE {
        return series::<f64, ALL>(s, &COTANGENT);
    }
    let half = 0.5 * s.sqrt();
    (1.0 - half / half.tan()) / s
}

#[cfg(test)]
mod tests {
    use super::super::pack::on_every_instruction_set;
    use super::super::{Kernel, gather, put_records};
    use super::*;
    use crate::{Matrix3, Vector3, so3};

    /// Rotation vectors and others, one per lane.
    struct Turns([[Vector3; MOST_LANES]; 2]);

    #[derive(Debug, Clone)]
    struct Found {
        exp: Vec<Matrix3>,
        inverse: Vec<Matrix3>,
        /// Left Jacobian and its inverse, times the other vectors.
        times: [Vec<Vector3>; 2],
        /// Of the first one, grown by a hair.
        orthonormal: Vec<Matrix3>,
    }

    #[inline(always)]
    fn put<T: Lane>(list: &mut [Matrix3], m: Mat3<T>) {
        let [a, b, c] = m.0;
        let nine = [a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z];
        put_records(&nine, list, 0, T::COUNT);
    }

    impl Kernel for Turns {
        type Output = (usize, Found);

        #[inline(always)]
        fn run<T: Lane>(self, token: T::Token) -> Self::Output {
            let mut found = Found {
                exp: vec![Matrix3::zeros(); MOST_LANES],
                inverse: vec![Matrix3::zeros(); MOST_LANES],
                times: [
                    vec![Vector3::zeros(); MOST_LANES],
                    vec![Vector3::zeros(); MOST_LANES],
                ],
                orthonormal: vec![Matrix3::zeros(); MOST_LANES],
            };
            let [x, y, z] = gather::<T, _, 3>(token, &self.0[0], 0);
            let phi = Vec3::new(x, y, z);
            let [x, y, z] = gather::<T, _, 3>(token, &self.0[1], 0);
            let d = Vec3::new(x, y, z);
            let matrix = exp(phi);
            put(&mut found.exp, matrix);
            put(&mut found.inverse, left_jacobian_inverse(phi));
            let times = [
                left_jacobian_times(phi, d),
                left_jacobian_inverse_times(phi, d),
            ];
            for (list, v) in found.times.iter_mut().zip(times) {
                put_records(&[v.x, v.y, v.z], list, 0, T::COUNT);
            }
            let grown = matrix.plus(x.same(1e-9), Mat3::hat(d).plus_diagonal(d.x));
            put(&mut found.orthonormal, orthonormalise(grown));
            (T::COUNT, found)
        }
    }

    #[test]
    fn lanes_turn_as_single_rotations_do() {
        let direction = |k: usize| {
            let k = k as f64;
            Vector3::new(
                (k + 0.3).sin(),
                (2.0 * k + 1.0).cos(),
                (3.0 * k - 0.7).sin(),
            )
        };
        // Small ones, the range of the series and both sides of its end, large ones, a mixture.
        for angles in [
            [0.0, 1e-12, 1e-9, 1e-5, 1e-3, 0.01, 0.031, 0.0317],
            [0.1, 0.2, 0.3, 0.5, 0.7, 0.9, 0.999, 0.9999],
            [1.0001, 1.2, 1.5, 2.0, 2.5, 3.0, 3.1, 1.000_001],
            [0.0, 3.0, 1e-7, 1.0, 0.5, 2.0, 0.02, 1e-3],
        ] {
            let phi = std::array::from_fn(|k| direction(k).normalize() * angles[k]);
            let other = std::array::from_fn(|k| direction(k + 11));
            for (count, found) in on_every_instruction_set(|| Turns([phi, other])) {
                for k in 0..count {
                    // Some roundings of entries of size 1, and 3e-13 of b s where the closed form
                    // of single rotations begins, s = 1e-3.
                    let near = |a: &Matrix3, b: &Matrix3| assert!((a - b).amax() < 3e-15);
                    near(&found.exp[k], &so3::exp(&phi[k]));
                    let inverse = so3::left_jacobian_inverse(&phi[k]);
                    near(&found.inverse[k], &inverse);
                    let times = [so3::left_jacobian(&phi[k]), inverse].map(|m| m * other[k]);
                    for (found, want) in found.times.iter().zip(times) {
                        assert!((found[k] - want).amax() < 5e-15, "{} {want}", found[k]);
                    }
                    let square = found.orthonormal[k].transpose() * found.orthonormal[k];
                    near(&square, &Matrix3::identity());
                    let way = (found.orthonormal[k] - found.exp[k]).amax();
                    assert!(way < 1e-8, "{way}");
                }
            }
        }
    }
}
