//! A small lump fixed to an element: float, clump weight or pump, with its own drag and mass.
//! Its weight and buoyancy are the system's business.
//!
//! Source: docs/theory/hydrodynamics.md, eqs. (9) and (10).

use catenix_numerics::{Matrix3, Vector3, so3::hat};

/// Properties of a lump.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Lump {
    /// Mass of the structure [kg].
    pub mass: f64,
    /// Added mass under water, the same in all directions [kg].
    pub added_mass: f64,
    /// rho CdA / 2, under water [N s2/m2].
    pub drag: f64,
}

/// Motion of a lump's point.
#[derive(Debug, Clone, Copy)]
pub struct LumpMotion {
    /// From the frame's origin to the lump, global (3) [m].
    pub arm: Vector3,
    /// Velocity of the water minus that of the frame's origin (3) [m/s].
    pub relative_velocity: Vector3,
    /// Angular velocity of the frame (3) [rad/s].
    pub spin: Vector3,
    /// Acceleration of the frame's origin (3) [m/s2].
    pub acceleration: Vector3,
    /// Angular acceleration of the frame (3) [rad/s2].
    pub angular_acceleration: Vector3,
}

impl LumpMotion {
    fn relative(&self) -> Vector3 {
        self.relative_velocity - self.spin.cross(&self.arm)
    }

    fn point_acceleration(&self) -> Vector3 {
        self.acceleration
            + self.angular_acceleration.cross(&self.arm)
            + self.spin.cross(&self.spin.cross(&self.arm))
    }
}

/// Parts of the force of a lump on its frame, at the lump, global (3) [N].
#[derive(Debug, Clone, Copy)]
pub struct LumpForce {
    /// Drag.
    pub drag: Vector3,
    /// Inertia, opposed to the acceleration.
    pub inertia: Vector3,
}

impl LumpForce {
    /// The sum.
    pub fn total(&self) -> Vector3 {
        self.drag + self.inertia
    }
}

/// Derivatives of the total force at the lump.
#[derive(Debug, Clone, Copy)]
pub struct LumpTangent {
    /// By the share under water.
    pub share: Vector3,
    /// By the velocity of the water at the lump.
    pub water: Matrix3,
    /// By a rotation of the frame.
    pub rotation: Matrix3,
    /// By the velocity of the frame's origin.
    pub velocity: Matrix3,
    /// By the angular velocity.
    pub spin: Matrix3,
    /// By the acceleration of the frame's origin.
    pub acceleration: Matrix3,
    /// By the angular acceleration.
    pub angular_acceleration: Matrix3,
}

impl Lump {
    /// Force on the frame, with a `share` of the lump under water.
    pub fn force(&self, share: f64, m: &LumpMotion) -> LumpForce {
        let u = m.relative();
        let mass = self.mass + share * self.added_mass;
        LumpForce {
            drag: u * (share * self.drag * u.norm()),
            inertia: m.point_acceleration() * -mass,
        }
    }

    /// Exact derivatives of the total of [`Self::force`].
    pub fn tangent(&self, share: f64, m: &LumpMotion) -> LumpTangent {
        let u = m.relative();
        let speed = u.norm();
        let mut drag = Matrix3::identity() * (share * self.drag * speed);
        if speed > 0.0 {
            drag += u * u.transpose() * (share * self.drag / speed);
        }
        let arm = hat(&m.arm);
        let (w, alpha) = (hat(&m.spin), hat(&m.angular_acceleration));
        let mass = self.mass + share * self.added_mass;
        LumpTangent {
            share: u * (self.drag * speed) - m.point_acceleration() * self.added_mass,
            water: drag,
            rotation: drag * w * arm + (alpha + w * w) * arm * mass,
            velocity: -drag,
            spin: drag * arm + (hat(&m.spin.cross(&m.arm)) + w * arm) * mass,
            acceleration: Matrix3::identity() * -mass,
            angular_acceleration: arm * mass,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use catenix_numerics::so3;

    #[test]
    fn derivatives_match_finite_differences() {
        let lump = Lump {
            mass: 2.0,
            added_mass: 1.5,
            drag: 5.0,
        };
        let share = 0.8;
        let m = LumpMotion {
            arm: Vector3::new(0.5, -0.2, 0.9),
            relative_velocity: Vector3::new(1.0, 0.5, -0.4),
            spin: Vector3::new(0.2, 0.9, -0.5),
            acceleration: Vector3::new(0.3, -0.6, 0.1),
            angular_acceleration: Vector3::new(-0.7, 0.4, 0.2),
        };
        let exact = lump.tangent(share, &m);
        let h = 1e-6;
        let by_share =
            (lump.force(share + h, &m).total() - lump.force(share - h, &m).total()) / (2.0 * h);
        assert!((exact.share - by_share).norm() < 1e-7);
        for k in 0..3 {
            let mut d = Vector3::zeros();
            d[k] = h;
            let check = |name: &str, got: Vector3, at: &dyn Fn(f64) -> LumpMotion| {
                let want = (lump.force(share, &at(1.0)).total()
                    - lump.force(share, &at(-1.0)).total())
                    / (2.0 * h);
                assert!(
                    (got - want).norm() < 1e-7,
                    "{name}, column {k}: {got} not {want}"
                );
            };
            let column = |matrix: &Matrix3| matrix.column(k).into_owned();
            check("water", column(&exact.water), &|s| LumpMotion {
                relative_velocity: m.relative_velocity + d * s,
                ..m
            });
            check("velocity", column(&exact.velocity), &|s| LumpMotion {
                relative_velocity: m.relative_velocity - d * s,
                ..m
            });
            check("rotation", column(&exact.rotation), &|s| LumpMotion {
                arm: so3::exp(&(d * s)) * m.arm,
                ..m
            });
            check("spin", column(&exact.spin), &|s| LumpMotion {
                spin: m.spin + d * s,
                ..m
            });
            check("acceleration", column(&exact.acceleration), &|s| {
                LumpMotion {
                    acceleration: m.acceleration + d * s,
                    ..m
                }
            });
            check("angular", column(&exact.angular_acceleration), &|s| {
                LumpMotion {
                    angular_acceleration: m.angular_acceleration + d * s,
                    ..m
                }
            });
        }
    }
}
