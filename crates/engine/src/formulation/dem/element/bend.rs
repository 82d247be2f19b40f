//! The moment of a connector whose sections have directions: unlike stiffness about local y and z,
//! a stress-free bend or twist, or a law given by points.
//!
//! The bend vector is split along the directors half way in twist between the two sections. Energy
//! depends on the relative rotation alone, so the moments on both sides are equal and opposite.
//!
//! Source: docs/theory/sections.md, eqs. (2) to (8).

use catenix_numerics::{Matrix3, Vector3, so3};

use super::law::GeneralLaw;
use super::pair::Side;
use so3::hat;

/// Angle over its sine as a function of the cosine, with its first and second derivative.
#[inline]
fn angle_over_sine(cos: f64) -> [f64; 3] {
    let y = 1.0 - cos;
    if y < 5e-3 {
        // Coefficients: each is n / (2 n + 1) times the one before.
        let value = 1.0 + y * (1.0 / 3.0 + y * (2.0 / 15.0 + y * (2.0 / 35.0 + y * (8.0 / 315.0))));
        let slope = 1.0 / 3.0
            + y * (4.0 / 15.0 + y * (6.0 / 35.0 + y * (32.0 / 315.0 + y * (40.0 / 693.0))));
        let second = 4.0 / 15.0
            + y * (12.0 / 35.0 + y * (32.0 / 105.0 + y * (160.0 / 693.0 + y * (160.0 / 1001.0))));
        return [value, -slope, second];
    }
    let sin2 = (1.0 - cos * cos).max(1e-12);
    let value = cos.clamp(-1.0, 1.0).acos() / sin2.sqrt();
    let slope = (cos * value - 1.0) / sin2;
    [value, slope, (value + 3.0 * cos * slope) / sin2]
}

/// Bend and twist of two sections against each other, with the directions of their derivatives.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bend {
    /// Axes of the two sides.
    a: Vector3,
    b: Vector3,
    /// Cross product of the axes.
    n: Vector3,
    cos: f64,
    ratio: [f64; 3],
    /// Directors half way in twist, carried back to the first axis: local y and z.
    directors: [Vector3; 2],
    /// Bend about them [rad].
    pub angles: [f64; 2],
    /// Derivative of the twist by a spin of the second section.
    by_twist: Vector3,
}

impl Bend {
    /// `twist`: of the second section against parallel transport [rad].
    ///
    /// Source: docs/theory/sections.md, eqs. (2) and (3).
    #[inline]
    pub fn new(first: &Side, second: &Side, twist: f64) -> Bend {
        let a: Vector3 = first.rotation.column(0).into();
        let b: Vector3 = second.rotation.column(0).into();
        let n = a.cross(&b);
        let total = a + b;
        // The same guard as for the mean axis: opposite axes are a lost state.
        let cos = 0.5 * total.norm_squared().max(1e-12) - 1.0;
        let ratio = angle_over_sine(cos);
        let y: Vector3 = first.rotation.column(1).into();
        let z: Vector3 = first.rotation.column(2).into();
        let (s, c) = (0.5 * twist).sin_cos();
        let directors = [y * c + z * s, z * c - y * s];
        Bend {
            a,
            b,
            n,
            cos,
            ratio,
            directors,
            angles: directors.map(|e| ratio[0] * e.dot(&n)),
            by_twist: total / (1.0 + cos),
        }
    }

    /// Derivative of an angle by a spin of the second section, but for the part through the twist.
    fn by_spin(&self, e: &Vector3) -> Vector3 {
        let [ratio, slope, _] = self.ratio;
        self.n * (-slope * e.dot(&self.n)) + (e * self.cos - self.a * self.b.dot(e)) * ratio
    }

    /// Moment on the second section, as gradient of the energy (3) [N m]. `torque`: derivative of
    /// the energy of torsion by the twist [N m].
    ///
    /// Source: docs/theory/sections.md, eqs. (5) and (6).
    #[inline]
    pub fn moment(&self, law: &GeneralLaw, torque: f64) -> Vector3 {
        let moment = law.bending.at(self.change(law)).moment;
        let pull = self.directors[0] * moment[0] + self.directors[1] * moment[1];
        let couple = 0.5 * (moment[0] * self.angles[1] - moment[1] * self.angles[0]);
        self.by_spin(&pull) + self.by_twist * (torque + couple)
    }

    /// Change of bend against rest (2) [rad].
    pub fn change(&self, law: &GeneralLaw) -> [f64; 2] {
        [0, 1].map(|k| self.angles[k] - law.rest_bend[k])
    }

    /// Derivatives of [`Self::moment`] by the spins of the first and second section.
    /// `torsion`: derivative of the torque by the twist [N m/rad].
    ///
    /// Source: docs/theory/sections.md, eqs. (7) and (8).
    pub fn moment_by_spins(&self, law: &GeneralLaw, torque: f64, torsion: f64) -> [Matrix3; 2] {
        let [ratio, slope, second] = self.ratio;
        let (a, b, n, s) = (&self.a, &self.b, &self.n, &self.by_twist);
        let [y, z] = &self.directors;
        let stress = law.bending.at(self.change(law));
        let [my, mz] = stress.moment;
        let [hyy, hyz, hzz] = stress.stiffness;
        let gy = self.by_spin(y) + s * (0.5 * self.angles[1]);
        let gz = self.by_spin(z) - s * (0.5 * self.angles[0]);
        let pull = y * my + z * mz;
        // How the pull turns with half of the twist.
        let turned = z * my - y * mz;
        let couple = 0.5 * (my * self.angles[1] - mz * self.angles[0]);
        let (pn, pb) = (pull.dot(n), pull.dot(b));
        let (nt, st) = (n.transpose(), s.transpose());
        let n_by_spin = Matrix3::identity() * self.cos - b * a.transpose();
        let s_by_spin = (s * nt - hat(b)) / (1.0 + self.cos);

        let by_second = gy * (gy * hyy + gz * hyz).transpose()
            + gz * (gy * hyz + gz * hzz).transpose()
            + s * (s * torsion + (gz * my - gy * mz) * 0.5).transpose()
            + s_by_spin * (torque + couple)
            + n * nt * (second * pn)
            - n * (n_by_spin.transpose() * pull).transpose() * slope
            - n_by_spin * (slope * pn)
            - pull * nt * (slope * self.cos + ratio)
            + a * nt * (slope * pb)
            + a * (hat(b).transpose() * pull).transpose() * ratio
            + self.by_spin(&turned) * st * 0.5;
        // Spun alike, both sections turn the moment with them.
        let moment = self.by_spin(&pull) + s * (torque + couple);
        [-by_second - hat(&moment), by_second]
    }
}

#[cfg(test)]
mod tests {
    use super::angle_over_sine;

    #[test]
    fn the_ratio_and_its_derivatives_agree_across_the_series() {
        for cos in [-0.9, 0.1, 0.8, 0.9949, 0.9951, 0.999] {
            let h = 1e-5;
            let (plus, minus) = (angle_over_sine(cos + h), angle_over_sine(cos - h));
            let here = angle_over_sine(cos);
            for k in 0..2 {
                let numeric = (plus[k] - minus[k]) / (2.0 * h);
                assert!(
                    (numeric - here[k + 1]).abs() < 1e-6 * (1.0 + numeric.abs()),
                    "derivative {} at {cos}: {} for {numeric}",
                    k + 1,
                    here[k + 1]
                );
            }
        }
    }
}
