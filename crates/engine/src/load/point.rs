//! A force and a moment on a point of a rigid frame.
//!
//! Source: docs/theory/loads.md, eqs. (3) to (5).

use catenix_numerics::{Matrix3, Vector3, so3::hat};

/// A load at its full value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FramePoint {
    /// From the frame's origin to the point, own axes (3) [m].
    pub arm: Vector3,
    /// Force (3) [N]: global, or in the frame's own axes when it follows.
    pub force: Vector3,
    /// Moment (3) [N m]: global, or in the frame's own axes when it follows.
    pub moment: Vector3,
    /// Whether it turns with the frame.
    pub follows: bool,
}

/// Force, and moment about the frame's origin, global.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoadForce {
    /// Force (3) [N].
    pub force: Vector3,
    /// Moment about the frame's origin (3) [N m].
    pub moment: Vector3,
}

/// Derivatives of [`LoadForce`] by a rotation of the frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoadTangent {
    /// Of the force.
    pub force: Matrix3,
    /// Of the moment.
    pub moment: Matrix3,
}

impl FramePoint {
    /// The load on a frame with this rotation, at full value.
    #[inline]
    pub fn at(&self, rotation: &Matrix3) -> LoadForce {
        let (force, moment) = if self.follows {
            (rotation * self.force, rotation * self.moment)
        } else {
            (self.force, self.moment)
        };
        let lever = rotation * self.arm;
        LoadForce {
            force,
            moment: moment + lever.cross(&force),
        }
    }

    /// Exact derivatives of [`Self::at`].
    #[inline]
    pub fn tangent(&self, rotation: &Matrix3) -> LoadTangent {
        if self.follows {
            let load = self.at(rotation);
            return LoadTangent {
                force: -hat(&load.force),
                moment: -hat(&load.moment),
            };
        }
        LoadTangent {
            force: Matrix3::zeros(),
            moment: hat(&self.force) * hat(&(rotation * self.arm)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use catenix_numerics::so3;

    #[test]
    fn derivatives_match_finite_differences() {
        let rotation = so3::exp(&Vector3::new(0.7, -1.3, 2.0));
        for follows in [false, true] {
            let load = FramePoint {
                arm: Vector3::new(0.5, -0.1, 0.3),
                force: Vector3::new(3.0, -7.0, 2.0),
                moment: Vector3::new(-1.0, 4.0, 5.0),
                follows,
            };
            let exact = load.tangent(&rotation);
            let h = 1e-6;
            for k in 0..3 {
                let mut d = Vector3::zeros();
                d[k] = h;
                let at = |sign: f64| load.at(&(so3::exp(&(d * sign)) * rotation));
                let force = (at(1.0).force - at(-1.0).force) / (2.0 * h);
                let moment = (at(1.0).moment - at(-1.0).moment) / (2.0 * h);
                assert!((exact.force.column(k) - force).norm() < 1e-8);
                assert!((exact.moment.column(k) - moment).norm() < 1e-8);
            }
        }
    }

    #[test]
    fn a_follower_turns_with_the_frame() {
        let load = FramePoint {
            arm: Vector3::x(),
            force: Vector3::new(0.0, 0.0, 2.0),
            moment: Vector3::new(1.0, 0.0, 0.0),
            follows: true,
        };
        let still = load.at(&Matrix3::identity());
        let turn = so3::exp(&Vector3::new(0.3, 0.9, -2.2));
        let turned = load.at(&turn);
        assert!((turned.force - turn * still.force).norm() < 1e-15);
        assert!((turned.moment - turn * still.moment).norm() < 1e-15);
    }
}
