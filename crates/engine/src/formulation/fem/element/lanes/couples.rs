//! A vertical load per length that is the same all along an element; see `weight.rs`.

use catenix_numerics::lanes::{Lane, Mat3, Vec3};

use super::elastic::Symmetric;
use super::frame::Frame;

/// A vertical load that is the same everywhere, in element axes; see `weight.rs`.
pub(super) struct Couples<T> {
    /// Load times the squared length over 12.
    pull: Vec3<T>,
    /// First axes of the sections.
    axes: [Vec3<T>; 2],
    pub force: Vec3<T>,
}

impl<T: Lane> Couples<T> {
    /// Source: docs/theory/fem.md, eq. (39).
    #[inline(always)]
    pub fn new(frame: &Frame<T>, pull: T) -> Couples<T> {
        let [a, b, c] = frame.axes.0;
        let pull = Vec3::new(a.z, b.z, c.z) * pull;
        let axes = [frame.sections[0].0[0], frame.sections[1].0[0]];
        let apart = axes[0] - axes[1];
        let zero = pull.x.same(0.0);
        Couples {
            pull,
            axes,
            force: Vec3::new(
                zero,
                (pull.y * apart.x + apart.y * pull.x) * frame.inverse,
                (pull.z * apart.x + apart.z * pull.x) * frame.inverse,
            ),
        }
    }

    /// The load across the chord.
    #[inline(always)]
    fn across(&self) -> Vec3<T> {
        Vec3::new(self.pull.x.same(0.0), self.pull.y, self.pull.z)
    }

    #[inline(always)]
    pub fn moments(&self) -> [Vec3<T>; 2] {
        let across = self.across();
        [across.cross(self.axes[0]), self.axes[1].cross(across)]
    }

    /// Source: docs/theory/fem.md, eq. (53).
    #[inline(always)]
    pub fn add_tangent(&self, frame: &Frame<T>, out: &mut Symmetric<T>) {
        let (q, f, inverse) = (self.pull, self.force, frame.inverse);
        let apart = self.axes[0] - self.axes[1];
        let twice = (inverse + inverse) * inverse;
        let straight = twice * apart.x * q.x;
        let yz = (q.y * apart.z + apart.y * q.z) * inverse * inverse;
        let (xy, xz) = (f.y * inverse, f.z * inverse);
        let [a, b, c] = &mut out.force_span.0;
        a.y -= xy;
        a.z -= xz;
        b.x -= xy;
        b.y += twice * q.y * apart.y - straight;
        b.z += yz;
        c.x -= xz;
        c.y += yz;
        c.z += twice * q.z * apart.z - straight;
        let scaled = q * inverse;
        let minus = -scaled;
        add_leaning(self.axes[0], scaled, &mut out.force_spin[0]);
        add_leaning(self.axes[1], minus, &mut out.force_spin[1]);
        let across = self.across();
        let [t, u] = self.axes;
        out.first = out
            .first
            .plus_outer(-t, across)
            .plus_diagonal(across.dot(t));
        out.second = out
            .second
            .plus_outer(u, across)
            .plus_diagonal(-across.dot(u));
    }
}

/// Takes off (q.x (I - e e^T) + across e^T) hat(t), with e along the chord.
#[inline(always)]
fn add_leaning<T: Lane>(t: Vec3<T>, q: Vec3<T>, m: &mut Mat3<T>) {
    let [a, b, c] = &mut m.0;
    a.y -= q.x * t.z;
    a.z += q.x * t.y;
    b.y += q.y * t.z;
    b.z += q.z * t.z - q.x * t.x;
    c.y += q.x * t.x - q.y * t.y;
    c.z -= q.z * t.y;
}
