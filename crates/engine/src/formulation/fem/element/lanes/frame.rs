//! The frame that moves with corotational elements, and rotation vectors against it.

use catenix_numerics::lanes::{Lane, Mat3, Vec3, angle_over_sine};

use super::{Ends, sandwich, turned_back};

/// The frame that moves with an element, and its sections against it.
pub(super) struct Frame<T> {
    pub axes: Mat3<T>,
    /// One over the distance of the ends.
    pub inverse: T,
    pub chord: T,
    pub squared_chord: T,
    /// The sections in element axes.
    pub sections: [Mat3<T>; 2],
    pub lean: T,
    /// One over the second component of the mean director.
    pub upright: T,
    /// First and second component of the roll by the spin of each section.
    pub roll: [Vec3<T>; 2],
}

impl<T: Lane> Frame<T> {
    /// Source: docs/theory/fem.md, eqs. (5) and (10).
    #[inline(always)]
    pub fn new(ends: &[Ends<T>; 2]) -> Frame<T> {
        let [first, second] = ends;
        let span = second.position - first.position;
        let squared_chord = span.norm_squared();
        let chord = squared_chord.sqrt();
        let one = chord.same(1.0);
        let inverse = one / chord;
        let along = span * inverse;
        let third = along.cross(first.rotation.0[1] + second.rotation.0[1]);
        // Sections that point along the chord leave no roll; such a state is lost.
        let size = third.norm_squared().sqrt();
        let least = chord.same(1e-9);
        let size = T::select(size.less(least), least, size);
        let third = third * (one / size);
        let axes = Mat3([along, third.cross(along), third]);
        let back = [
            turned_back(axes, first.rotation),
            turned_back(axes, second.rotation),
        ];
        let [p, q] = [back[0].0[1], back[1].0[1]];
        let upright = (one + one) / (p.y + q.y);
        let half = upright * 0.5;
        let zero = chord.same(0.0);
        Frame {
            axes,
            inverse,
            chord,
            squared_chord,
            sections: back,
            lean: (p.x + q.x) * half,
            upright,
            roll: [
                Vec3::new(p.y * half, -(p.x * half), zero),
                Vec3::new(q.y * half, -(q.x * half), zero),
            ],
        }
    }
}

/// The turn of a section against the element axes, and what turns a moment by it into one by the
/// spin.
///
/// Source: docs/theory/fem.md, eqs. (6) and (12).
#[derive(Clone, Copy)]
pub(super) struct Turned<T> {
    /// Rotation vector [rad].
    pub turn: Vec3<T>,
    /// The inverse of the left Jacobian.
    pub inverse: Mat3<T>,
    pub b: T,
    /// Twice the derivative of b by the squared angle.
    twice_slope: T,
}

/// Below this squared angle b comes from its series; the first dropped terms are under 1e-13 of the
/// sum.
const SMALL_SQUARE: f64 = 0.1;

impl<T: Lane> Turned<T> {
    /// Of a section in element axes. Close to half a turn digits are lost; there the element has
    /// long lost its meaning.
    #[inline(always)]
    pub fn new(section: Mat3<T>) -> Turned<T> {
        let [x, y, z] = section.0;
        let cos = (x.x + y.y + z.z) * 0.5 + -0.5;
        let over_sine = angle_over_sine(cos).0;
        let turn = Vec3::new(y.z - z.y, z.x - x.z, x.y - y.x) * (over_sine * 0.5);
        let s = turn.norm_squared();
        let (mut b, mut slope) = near(s);
        if !s.all_less(SMALL_SQUARE) {
            let (far, far_slope) = far(s, over_sine, cos);
            let small = s.less(s.same(SMALL_SQUARE));
            b = T::select(small, b, far);
            slope = T::select(small, slope, far_slope);
        }
        Turned {
            turn,
            inverse: left_jacobian_inverse(turn, b),
            b,
            twice_slope: slope + slope,
        }
    }

    /// The moment by the spin.
    #[inline(always)]
    pub fn moment(&self, m: Vec3<T>) -> Vec3<T> {
        self.inverse.led_by(m)
    }

    /// inverse^T diag(d) inverse, and how the moment changes with the turn.
    #[inline(always)]
    pub fn stiffness(&self, d: Vec3<T>, m: Vec3<T>) -> Mat3<T> {
        let across = self.turn.cross(m);
        let twice = self.turn.cross(across);
        let halved = (m * m.x.same(0.5)).plus(self.b, across);
        let along = self.b * self.turn.dot(m);
        sandwich(self.inverse, d, self.inverse).plus(along, self.inverse)
            - self.inverse.crossed_by(halved)
            + (twice * self.twice_slope).minus(self.b, m).outer(self.turn)
    }
}

/// The inverse of the left Jacobian of a turn.
#[inline(always)]
pub(super) fn left_jacobian_inverse<T: Lane>(turn: Vec3<T>, b: T) -> Mat3<T> {
    let s = turn.norm_squared();
    Mat3::diagonal(-(b * s) + 1.0)
        .plus_outer(turn * b, turn)
        .plus_hat(turn * s.same(-0.5))
}

/// b and its derivative at small squared angles.
#[inline(always)]
fn near<T: Lane>(s: T) -> (T, T) {
    let b = [
        1.0 / 12.0,
        1.0 / 720.0,
        1.0 / 30_240.0,
        1.0 / 1_209_600.0,
        1.0 / 47_900_160.0,
        691.0 / 1_307_674_368_000.0,
    ];
    let slope = [
        1.0 / 720.0,
        1.0 / 15_120.0,
        1.0 / 403_200.0,
        1.0 / 11_975_040.0,
        691.0 / 261_534_873_600.0,
    ];
    (series(s, &b), series(s, &slope))
}

/// The same at large ones, from angle over sine and cosine: half the angle times its cotangent is
/// half of the first times one plus the second.
#[inline(always)]
fn far<T: Lane>(s: T, over_sine: T, cos: T) -> (T, T) {
    let product = over_sine * (cos + 1.0);
    let b = (product * -0.5 + 1.0) / s;
    let one = s.same(1.0);
    let by_s = (product / s - one / (-cos + 1.0)) * 0.25;
    (b, -(by_s + b) / s)
}

#[inline(always)]
fn series<T: Lane, const N: usize>(s: T, coefficients: &[f64; N]) -> T {
    let mut sum = s.same(coefficients[N - 1]);
    let mut k = N - 1;
    while k > 0 {
        k -= 1;
        sum = sum.mul_add(s, s.same(coefficients[k]));
    }
    sum
}
