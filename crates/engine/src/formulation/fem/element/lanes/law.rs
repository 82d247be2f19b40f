//! What the sections of corotational elements with linear laws oppose to deformation.

use catenix_numerics::lanes::{Lane, Vec3};

/// Constants in lanes.
pub(super) struct Law<T> {
    pub length: T,
    pub axial: T,
    pub torsion: T,
    pub alike: [T; 2],
    pub apart: [T; 2],
    pub bow: [T; 2],
}

impl<T: Lane> Law<T> {
    /// Moments by the two turns, of bending and torsion, for turns less those without stress.
    ///
    /// Source: docs/theory/fem.md, eq. (7).
    #[inline(always)]
    pub fn bending(&self, [a, b]: [Vec3<T>; 2]) -> [Vec3<T>; 2] {
        let torque = self.torsion * (b.x - a.x);
        let (mean_y, half_y) = ((a.y + b.y) * 0.25, (b.y - a.y) * 0.25);
        let (mean_z, half_z) = ((a.z + b.z) * 0.25, (b.z - a.z) * 0.25);
        let (mean_y, half_y) = (self.alike[0] * mean_y, self.apart[0] * half_y);
        let (mean_z, half_z) = (self.alike[1] * mean_z, self.apart[1] * half_z);
        [
            Vec3::new(-torque, mean_y - half_y, mean_z - half_z),
            Vec3::new(torque, mean_y + half_y, mean_z + half_z),
        ]
    }

    /// Elastic energy of turns less those without stress, and of a strain.
    #[inline(always)]
    pub fn energy(&self, [a, b]: [Vec3<T>; 2], strain: T) -> T {
        let twist = b.x - a.x;
        let (mean_y, half_y) = ((a.y + b.y) * 0.5, (b.y - a.y) * 0.5);
        let (mean_z, half_z) = ((a.z + b.z) * 0.5, (b.z - a.z) * 0.5);
        let twice = self.axial * self.length * strain * strain
            + self.torsion * twist * twist
            + self.alike[0] * mean_y * mean_y
            + self.apart[0] * half_y * half_y
            + self.alike[1] * mean_z * mean_z
            + self.apart[1] * half_z * half_z;
        twice * 0.5
    }

    /// Derivatives of the shortening by the two turns, and the shortening.
    ///
    /// Source: docs/theory/fem.md, eq. (8).
    #[inline(always)]
    pub fn shortening(&self, [a, b]: [Vec3<T>; 2]) -> ([Vec3<T>; 2], T) {
        let zero = self.length.same(0.0);
        let (mean_y, half_y) = ((a.y + b.y) * 0.5, (b.y - a.y) * 0.5);
        let (mean_z, half_z) = ((a.z + b.z) * 0.5, (b.z - a.z) * 0.5);
        let (bow_y, bow_z) = (self.bow[0] * mean_y, self.bow[1] * mean_z);
        let (arc_y, arc_z) = (half_y * (1.0 / 6.0), half_z * (1.0 / 6.0));
        let sum = bow_y * mean_y + arc_y * half_y + bow_z * mean_z + arc_z * half_z;
        let by = [
            Vec3::new(zero, bow_y - arc_y, bow_z - arc_z),
            Vec3::new(zero, bow_y + arc_y, bow_z + arc_z),
        ];
        (by, sum)
    }

    /// Diagonal of the stiffness by one end's turn against its own moment, and against the other's,
    /// with a tension times the length.
    #[inline(always)]
    pub fn stiffness(&self, pull: T) -> [Vec3<T>; 2] {
        let (y, z) = (self.bow[0] * pull * 0.5, self.bow[1] * pull * 0.5);
        let arc = pull * (1.0 / 12.0);
        let quarter = self.length.same(0.25);
        let [ay, az] = self.alike;
        let [dy, dz] = self.apart;
        [
            Vec3::new(
                self.torsion,
                (ay + dy) * quarter + y + arc,
                (az + dz) * quarter + z + arc,
            ),
            Vec3::new(
                -self.torsion,
                (ay - dy) * quarter + y - arc,
                (az - dz) * quarter + z - arc,
            ),
        ]
    }
}
