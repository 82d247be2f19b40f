//! Elastic forces of corotational elements, in element axes, and their derivatives. These are
//! symmetric but for a known skew part.

use catenix_numerics::lanes::{Lane, Mat3, Vec3};

use super::frame::{Frame, Turned};
use super::law::Law;
use super::{sandwich, turned};

/// Elastic forces in element axes.
pub(super) struct Elastic<T> {
    pub force: Vec3<T>,
    pub moments: [Vec3<T>; 2],
    /// Sum of the moments by the spins against the element axes.
    sum: Vec3<T>,
}

/// The blocks of a symmetric tangent in element axes, but that the blocks of a moment by its own
/// rotation have a skew part.
pub(super) struct Symmetric<T> {
    pub force_span: Mat3<T>,
    pub force_spin: [Mat3<T>; 2],
    pub first: Mat3<T>,
    pub mixed: Mat3<T>,
    pub second: Mat3<T>,
}

impl<T: Lane> Symmetric<T> {
    #[inline(always)]
    pub fn all(&self) -> [[Mat3<T>; 3]; 3] {
        let [f, g] = self.force_spin;
        [
            [self.force_span, f, g],
            [f.transposed(), self.first, self.mixed],
            [g.transposed(), self.mixed.transposed(), self.second],
        ]
    }

    /// In global axes.
    #[inline(always)]
    pub fn everywhere(&self, axes: Mat3<T>) -> [[Mat3<T>; 3]; 3] {
        let [f, g] = self.force_spin;
        Symmetric {
            force_span: turned(axes, self.force_span),
            force_spin: [turned(axes, f), turned(axes, g)],
            first: turned(axes, self.first),
            mixed: turned(axes, self.mixed),
            second: turned(axes, self.second),
        }
        .all()
    }
}

impl<T: Lane> Elastic<T> {
    /// Source: docs/theory/fem.md, eq. (11).
    #[inline(always)]
    pub fn new(frame: &Frame<T>, tension: T, moments: [Vec3<T>; 2]) -> Elastic<T> {
        let sum = moments[0] + moments[1];
        Elastic {
            force: Vec3::new(
                tension,
                -(sum.z * frame.inverse),
                (frame.lean * sum.x + sum.y) * frame.inverse,
            ),
            moments: [
                moments[0].minus(sum.x, frame.roll[0]),
                moments[1].minus(sum.x, frame.roll[1]),
            ],
            sum,
        }
    }

    /// Derivative of the forces, but for the extension's. `by_turn`: the moments by the turns.
    ///
    /// Source: docs/theory/fem.md, eqs. (48) to (52).
    #[inline(always)]
    pub fn tangent(
        &self,
        law: &Law<T>,
        frame: &Frame<T>,
        spun: &[Turned<T>; 2],
        by_turn: [Vec3<T>; 2],
    ) -> Symmetric<T> {
        let [same, other] = law.stiffness(self.force.x * law.length);
        let first = spun[0].stiffness(same, by_turn[0]);
        let second = spun[1].stiffness(same, by_turn[1]);
        let mixed = sandwich(spun[0].inverse, other, spun[1].inverse);
        let mirrored = mixed.transposed();
        // Rows of the derivatives of the sum of the moments by both spins, and by both alike.
        let [x, y, z] = (first + mirrored).transposed().0;
        let [u, v, w] = (mixed + second).transposed().0;
        let all = [x + u, y + v, z + w];
        let sides = [
            Side::new(frame, self, 0, [x, y, z], &all, first.0[0] + mixed.0[0]),
            Side::new(frame, self, 1, [u, v, w], &all, mirrored.0[0] + second.0[0]),
        ];
        let (inverse, lean, f) = (frame.inverse, frame.lean, self.force);
        let squared = inverse * inverse;
        let zero = inverse.same(0.0);
        let [x, y, z] = all;
        let (xy, xz) = (-(f.y * inverse), -(f.z * inverse));
        let yy = z.z * squared + f.x * inverse;
        let yz = lean * f.z * inverse - (z.x * lean + z.y) * squared;
        let zz = ((x.x * lean + x.y + y.x) * lean + y.y) * squared + (f.x - lean * f.y) * inverse;
        Symmetric {
            force_span: Mat3([
                Vec3::new(zero, xy, xz),
                Vec3::new(xy, yy, yz),
                Vec3::new(xz, yz, zz),
            ]),
            force_spin: [sides[0].force, sides[1].force],
            first: sides[0].own(sides[0].coupled(first, &sides[0])),
            mixed: sides[0].coupled(mixed, &sides[1]),
            second: sides[1].own(sides[1].coupled(second, &sides[1])),
        }
    }
}

/// What the tangent has to do with the spin of one section.
struct Side<T> {
    roll: Vec3<T>,
    director: Vec3<T>,
    /// Derivative of the force across the chord by this spin.
    force: Mat3<T>,
    /// What a roll of the element does to the moment on this section.
    by_roll: Vec3<T>,
    /// How this spin changes what a roll takes from the moments.
    to_roll: Vec3<T>,
    /// Half of the torque over the second component of the mean director.
    halved: T,
}

impl<T: Lane> Side<T> {
    /// `sums`: rows of the derivative of the sum of the moments by this spin, `all`: by both alike;
    /// `lead`: derivative of the own moment by a common spin about the chord.
    ///
    /// Source: docs/theory/fem.md, eqs. (50) to (52).
    #[inline(always)]
    fn new(
        frame: &Frame<T>,
        elastic: &Elastic<T>,
        end: usize,
        sums: [Vec3<T>; 3],
        all: &[Vec3<T>; 3],
        lead: Vec3<T>,
    ) -> Side<T> {
        let (inverse, lean, f) = (frame.inverse, frame.lean, elastic.force);
        let (q, r) = (frame.sections[end].0[1], frame.roll[end]);
        let w = elastic.moments[end];
        let halved = elastic.sum.x * frame.upright * 0.5;
        let zero = inverse.same(0.0);
        let x = sums[0].minus(all[0].x, r);
        let y = sums[1].minus(all[1].x, r);
        let z = sums[2].minus(all[2].x, r);
        let leaning = Vec3::new(lean * q.z, q.z, -(q.y + lean * q.x)) * halved;
        let second = (z * -inverse).minus(f.z, r);
        let third = ((x * lean + y + leaning) * inverse).plus(f.y, r);
        Side {
            roll: r,
            director: q,
            force: Mat3([
                Vec3::new(zero, second.x, third.x),
                Vec3::new(zero, second.y, third.y),
                Vec3::new(zero, second.z, third.z),
            ]),
            by_roll: lead + Vec3::new(halved * q.z, w.z, -w.y),
            to_roll: x - Vec3::new(-q.z, zero, q.x) * halved,
            halved,
        }
    }

    /// The derivative of the moment on this section by the spin of a section: from `m`, that of the
    /// moments by the spins against the element axes.
    #[inline(always)]
    fn coupled(&self, m: Mat3<T>, by: &Side<T>) -> Mat3<T> {
        m.plus_outer(-self.by_roll, by.roll)
            .plus_outer(-self.roll, by.to_roll)
    }

    /// Adds how the own roll changes with the own spin.
    #[inline(always)]
    fn own(&self, m: Mat3<T>) -> Mat3<T> {
        let (q, halved) = (self.director, self.halved);
        let [mut a, mut b, mut c] = m.0;
        a.x += halved * q.z;
        b.y += halved * q.z;
        c.x -= halved * q.x;
        c.y -= halved * q.y;
        Mat3([a, b, c])
    }
}

/// Adds the stiffness against extension. `bowed`: derivatives of the shortening by the spins of the
/// sections against the element axes.
///
/// Source: docs/theory/fem.md, eq. (49).
#[inline(always)]
pub(super) fn add_extension<T: Lane>(
    law: &Law<T>,
    frame: &Frame<T>,
    bowed: [Vec3<T>; 2],
    out: &mut Symmetric<T>,
) {
    let stiffness = law.axial * law.length;
    let sum = bowed[0] + bowed[1];
    let by_span = Vec3::new(
        sum.x.same(1.0) / law.length,
        -(sum.z * frame.inverse),
        (frame.lean * sum.x + sum.y) * frame.inverse,
    );
    let first = bowed[0].minus(sum.x, frame.roll[0]);
    let second = bowed[1].minus(sum.x, frame.roll[1]);
    let (scaled_span, scaled) = (by_span * stiffness, first * stiffness);
    out.force_span = out.force_span.plus_outer(scaled_span, by_span);
    out.force_spin[0] = out.force_spin[0].plus_outer(scaled_span, first);
    out.force_spin[1] = out.force_spin[1].plus_outer(scaled_span, second);
    out.first = out.first.plus_outer(scaled, first);
    out.mixed = out.mixed.plus_outer(scaled, second);
    out.second = out.second.plus_outer(second * stiffness, second);
}
