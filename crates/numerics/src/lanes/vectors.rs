//! Three components, and three by three, of lanes: what kernels need and no more.
//!
//! No closures and no iterators: they need not be inlined, and what is not inlined into the kernel
//! is not compiled for its instructions.

use std::ops::{Add, AddAssign, Mul, Neg, Sub, SubAssign};

use super::{Lane, Row, gather};
use crate::{Matrix3, Vector3};

/// Three components.
#[derive(Debug, Clone, Copy)]
pub struct Vec3<T> {
    /// First.
    pub x: T,
    /// Second.
    pub y: T,
    /// Third.
    pub z: T,
}

/// Three by three, by columns.
#[derive(Debug, Clone, Copy)]
pub struct Mat3<T>(pub [Vec3<T>; 3]);

impl<T: Lane> Vec3<T> {
    /// From its components.
    #[inline(always)]
    pub fn new(x: T, y: T, z: T) -> Self {
        Vec3 { x, y, z }
    }

    /// Zeros.
    #[inline(always)]
    pub fn zeros(token: T::Token) -> Self {
        let zero = T::splat(token, 0.0);
        Vec3::new(zero, zero, zero)
    }

    /// Reads three rows.
    #[inline(always)]
    pub fn read(token: T::Token, rows: &[Row]) -> Self {
        Vec3 {
            x: T::read(token, &rows[0]),
            y: T::read(token, &rows[1]),
            z: T::read(token, &rows[2]),
        }
    }

    /// Writes three rows.
    #[inline(always)]
    pub fn write(self, rows: &mut [Row]) {
        self.x.write(&mut rows[0]);
        self.y.write(&mut rows[1]);
        self.z.write(&mut rows[2]);
    }

    /// Those of the next elements, see [`Lane::one_on`].
    #[inline(always)]
    pub fn one_on(self, next: Self) -> Self {
        Vec3 {
            x: self.x.one_on(next.x),
            y: self.y.one_on(next.y),
            z: self.z.one_on(next.z),
        }
    }

    /// Those of the elements before, see [`Lane::one_back`].
    #[inline(always)]
    pub fn one_back(self, before: Self) -> Self {
        Vec3 {
            x: self.x.one_back(before.x),
            y: self.y.one_back(before.y),
            z: self.z.one_back(before.z),
        }
    }

    /// `yes` where the mask says so, else `no`.
    #[inline(always)]
    pub fn select(mask: T::Mask, yes: Self, no: Self) -> Self {
        Vec3 {
            x: T::select(mask, yes.x, no.x),
            y: T::select(mask, yes.y, no.y),
            z: T::select(mask, yes.z, no.z),
        }
    }

    /// Scalar product.
    #[inline(always)]
    pub fn dot(self, o: Self) -> T {
        self.x.mul_add(o.x, self.y.mul_add(o.y, self.z * o.z))
    }

    /// Square of the length.
    #[inline(always)]
    pub fn norm_squared(self) -> T {
        self.dot(self)
    }

    /// Cross product.
    #[inline(always)]
    pub fn cross(self, o: Self) -> Self {
        Vec3 {
            x: self.z.neg_mul_add(o.y, self.y * o.z),
            y: self.x.neg_mul_add(o.z, self.z * o.x),
            z: self.y.neg_mul_add(o.x, self.x * o.y),
        }
    }

    /// self + factor x other
    #[inline(always)]
    pub fn plus(self, factor: T, other: Self) -> Self {
        Vec3 {
            x: factor.mul_add(other.x, self.x),
            y: factor.mul_add(other.y, self.y),
            z: factor.mul_add(other.z, self.z),
        }
    }

    /// self - factor x other
    #[inline(always)]
    pub fn minus(self, factor: T, other: Self) -> Self {
        Vec3 {
            x: factor.neg_mul_add(other.x, self.x),
            y: factor.neg_mul_add(other.y, self.y),
            z: factor.neg_mul_add(other.z, self.z),
        }
    }

    /// self other^T
    #[inline(always)]
    pub fn outer(self, other: Self) -> Mat3<T> {
        Mat3([self * other.x, self * other.y, self * other.z])
    }
}

impl<T: Lane> Mat3<T> {
    /// Zeros.
    #[inline(always)]
    pub fn zeros(token: T::Token) -> Self {
        Mat3([Vec3::zeros(token); 3])
    }

    /// `value` on the diagonal.
    #[inline(always)]
    pub fn diagonal(value: T) -> Self {
        let zero = value.same(0.0);
        Mat3([
            Vec3::new(value, zero, zero),
            Vec3::new(zero, value, zero),
            Vec3::new(zero, zero, value),
        ])
    }

    /// The matrix of the cross product with `a`.
    #[inline(always)]
    pub fn hat(a: Vec3<T>) -> Self {
        let zero = a.x.same(0.0);
        Mat3([
            Vec3::new(zero, a.z, -a.y),
            Vec3::new(-a.z, zero, a.x),
            Vec3::new(a.y, -a.x, zero),
        ])
    }

    /// Reads nine rows, by columns.
    #[inline(always)]
    pub fn read(token: T::Token, rows: &[Row]) -> Self {
        Mat3([
            Vec3::read(token, rows),
            Vec3::read(token, &rows[3..]),
            Vec3::read(token, &rows[6..]),
        ])
    }

    /// Those of the next elements, see [`Lane::one_on`].
    #[inline(always)]
    pub fn one_on(self, next: Self) -> Self {
        let ([a, b, c], [p, q, r]) = (self.0, next.0);
        Mat3([a.one_on(p), b.one_on(q), c.one_on(r)])
    }

    /// Those of the elements before, see [`Lane::one_back`].
    #[inline(always)]
    pub fn one_back(self, before: Self) -> Self {
        let ([a, b, c], [p, q, r]) = (self.0, before.0);
        Mat3([a.one_back(p), b.one_back(q), c.one_back(r)])
    }

    /// Consecutive matrices, see [`gather`].
    #[inline(always)]
    pub fn gather(token: T::Token, matrices: &[Matrix3], first: usize) -> Self {
        let [a, b, c, d, e, f, g, h, i] = gather(token, matrices, first);
        Mat3([Vec3::new(a, b, c), Vec3::new(d, e, f), Vec3::new(g, h, i)])
    }

    /// From nine entries, by columns.
    #[inline(always)]
    pub fn of([a, b, c, d, e, f, g, h, i]: [T; 9]) -> Self {
        Mat3([Vec3::new(a, b, c), Vec3::new(d, e, f), Vec3::new(g, h, i)])
    }

    /// The nine entries, by columns.
    #[inline(always)]
    pub fn entries(self) -> [T; 9] {
        let [a, b, c] = self.0;
        [a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z]
    }

    /// self x
    #[inline(always)]
    pub fn times(self, v: Vec3<T>) -> Vec3<T> {
        (self.0[0] * v.x).plus(v.y, self.0[1]).plus(v.z, self.0[2])
    }

    /// v^T self
    #[inline(always)]
    pub fn led_by(self, v: Vec3<T>) -> Vec3<T> {
        Vec3::new(v.dot(self.0[0]), v.dot(self.0[1]), v.dot(self.0[2]))
    }

    /// self other
    #[inline(always)]
    pub fn product(self, other: Self) -> Self {
        let [a, b, c] = other.0;
        Mat3([self.times(a), self.times(b), self.times(c)])
    }

    /// hat(a) self
    #[inline(always)]
    pub fn crossed_by(self, a: Vec3<T>) -> Self {
        let [x, y, z] = self.0;
        Mat3([a.cross(x), a.cross(y), a.cross(z)])
    }

    /// self hat(a)
    #[inline(always)]
    pub fn crossing(self, a: Vec3<T>) -> Self {
        let [x, y, z] = self.0;
        Mat3([
            (y * a.z).minus(a.y, z),
            (z * a.x).minus(a.z, x),
            (x * a.y).minus(a.x, y),
        ])
    }

    /// Rows and columns exchanged.
    #[inline(always)]
    pub fn transposed(self) -> Self {
        let [a, b, c] = self.0;
        Mat3([
            Vec3::new(a.x, b.x, c.x),
            Vec3::new(a.y, b.y, c.y),
            Vec3::new(a.z, b.z, c.z),
        ])
    }

    /// self + factor x other
    #[inline(always)]
    pub fn plus(self, factor: T, other: Self) -> Self {
        let [a, b, c] = self.0;
        let [p, q, r] = other.0;
        Mat3([a.plus(factor, p), b.plus(factor, q), c.plus(factor, r)])
    }

    /// self + a b^T
    #[inline(always)]
    pub fn plus_outer(self, a: Vec3<T>, b: Vec3<T>) -> Self {
        let [p, q, r] = self.0;
        Mat3([p.plus(b.x, a), q.plus(b.y, a), r.plus(b.z, a)])
    }

    /// self + value on the diagonal
    #[inline(always)]
    pub fn plus_diagonal(self, value: T) -> Self {
        let [mut a, mut b, mut c] = self.0;
        a.x += value;
        b.y += value;
        c.z += value;
        Mat3([a, b, c])
    }

    /// self + hat(a)
    #[inline(always)]
    pub fn plus_hat(self, a: Vec3<T>) -> Self {
        let [mut p, mut q, mut r] = self.0;
        p.y += a.z;
        p.z -= a.y;
        q.x -= a.z;
        q.z += a.x;
        r.x += a.y;
        r.y -= a.x;
        Mat3([p, q, r])
    }
}

impl<T: Lane> Add for Vec3<T> {
    type Output = Self;

    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Vec3::new(self.x + o.x, self.y + o.y, self.z + o.z)
    }
}

impl<T: Lane> Sub for Vec3<T> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Vec3::new(self.x - o.x, self.y - o.y, self.z - o.z)
    }
}

impl<T: Lane> Neg for Vec3<T> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Vec3::new(-self.x, -self.y, -self.z)
    }
}

impl<T: Lane> Mul<T> for Vec3<T> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, f: T) -> Self {
        Vec3::new(self.x * f, self.y * f, self.z * f)
    }
}

impl<T: Lane> AddAssign for Vec3<T> {
    #[inline(always)]
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}

impl<T: Lane> SubAssign for Vec3<T> {
    #[inline(always)]
    fn sub_assign(&mut self, o: Self) {
        *self = *self - o;
    }
}

impl<T: Lane> Add for Mat3<T> {
    type Output = Self;

    #[inline(always)]
    fn add(self, o: Self) -> Self {
        let ([a, b, c], [p, q, r]) = (self.0, o.0);
        Mat3([a + p, b + q, c + r])
    }
}

impl<T: Lane> Sub for Mat3<T> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        let ([a, b, c], [p, q, r]) = (self.0, o.0);
        Mat3([a - p, b - q, c - r])
    }
}

impl<T: Lane> Neg for Mat3<T> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        let [a, b, c] = self.0;
        Mat3([-a, -b, -c])
    }
}

impl<T: Lane> Mul<T> for Mat3<T> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, f: T) -> Self {
        let [a, b, c] = self.0;
        Mat3([a * f, b * f, c * f])
    }
}

impl From<&Vector3> for Vec3<f64> {
    #[inline(always)]
    fn from(v: &Vector3) -> Self {
        Vec3::new(v.x, v.y, v.z)
    }
}

impl From<Vec3<f64>> for Vector3 {
    #[inline(always)]
    fn from(v: Vec3<f64>) -> Self {
        Vector3::new(v.x, v.y, v.z)
    }
}

impl From<&Matrix3> for Mat3<f64> {
    #[inline(always)]
    fn from(m: &Matrix3) -> Self {
        Mat3([0, 1, 2].map(|k| Vec3::new(m[(0, k)], m[(1, k)], m[(2, k)])))
    }
}

impl From<Mat3<f64>> for Matrix3 {
    #[inline(always)]
    fn from(m: Mat3<f64>) -> Self {
        Matrix3::from_columns(&m.0.map(Vector3::from))
    }
}

/// Four quadrants, by rows, as the 36 entries of a block.
#[inline(always)]
pub fn block<T: Lane>([a, b, c, d]: [&Mat3<T>; 4]) -> [T; 36] {
    let ([a, p, q], [b, r, s]) = (a.0, b.0);
    let ([c, t, u], [d, v, w]) = (c.0, d.0);
    [
        a.x, a.y, a.z, c.x, c.y, c.z, p.x, p.y, p.z, t.x, t.y, t.z, //
        q.x, q.y, q.z, u.x, u.y, u.z, b.x, b.y, b.z, d.x, d.y, d.z, //
        r.x, r.y, r.z, v.x, v.y, v.z, s.x, s.y, s.z, w.x, w.y, w.z,
    ]
}
