//! Normal spring and damper and Coulomb friction of the seabed on an element.

use catenix_model::Seabed;
use catenix_numerics::{Matrix3, Vector3};

/// Penetration over which the contact stiffness grows from zero to its full value [m]: the force
/// then has a continuous slope, which Newton's method needs.
const SOFT_START: f64 = 0.02;

/// Contact force on an element and its derivatives.
#[derive(Debug, Clone, Copy)]
pub struct Contact {
    /// Force on the element, global (3) [N].
    pub force: Vector3,
    /// Derivative of the force by the height of the element (3) [N/m].
    pub by_height: Vector3,
    /// Derivative of the force by the velocity [N s/m].
    pub by_velocity: Matrix3,
    /// Energy stored in the normal spring [J].
    pub energy: f64,
}

/// Contact of an element of `length` whose centre is `height` above the seabed (negative when in
/// contact), moving with `velocity`; `None` when it does not touch.
///
/// Source: docs/theory/contact.md, eqs. (1) to (4).
pub fn contact(seabed: &Seabed, length: f64, height: f64, velocity: &Vector3) -> Option<Contact> {
    if height >= 0.0 {
        return None;
    }
    let penetration = -height;
    let stiffness = seabed.normal_stiffness * length;
    // Force, its slope, and energy of the spring with a soft start.
    let (spring, slope, energy, share, share_slope) = if penetration < SOFT_START {
        let share = penetration / SOFT_START;
        (
            0.5 * stiffness * penetration * share,
            stiffness * share,
            stiffness * penetration * penetration * share / 6.0,
            share,
            1.0 / SOFT_START,
        )
    } else {
        let beyond = penetration - 0.5 * SOFT_START;
        let energy = 0.5 * stiffness * beyond * beyond + stiffness * SOFT_START * SOFT_START / 24.0;
        (stiffness * beyond, stiffness, energy, 1.0, 0.0)
    };
    let damping = seabed.normal_damping * length;
    let normal = spring - damping * share * velocity.z;
    let normal_by_height = -slope + damping * share_slope * velocity.z;
    let normal_by_velocity = -damping * share;

    // Friction opposes sliding, fully developed well above the friction speed.
    let sliding = Vector3::new(velocity.x, velocity.y, 0.0);
    let speed = (sliding.norm_squared() + seabed.friction_speed * seabed.friction_speed).sqrt();
    let direction = sliding / speed;
    let flat = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, 0.0));
    let direction_by_velocity = (flat - direction * direction.transpose()) / speed;
    let grip = seabed.friction * spring;
    let mut by_velocity = direction_by_velocity * -grip;
    by_velocity[(2, 2)] += normal_by_velocity;
    let mut by_height = direction * (seabed.friction * slope);
    by_height.z += normal_by_height;
    Some(Contact {
        force: Vector3::new(0.0, 0.0, normal) - direction * grip,
        by_height,
        by_velocity,
        energy,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const SEABED: Seabed = Seabed {
        normal_stiffness: 1e4,
        normal_damping: 300.0,
        friction: 0.6,
        friction_speed: 0.01,
    };

    #[test]
    fn derivatives_match_finite_differences() {
        let h = 1e-7;
        for height in [-0.005, -0.019, -0.2] {
            for velocity in [Vector3::zeros(), Vector3::new(0.03, -0.02, -0.4)] {
                let at = |height: f64, velocity: Vector3| {
                    contact(&SEABED, 2.0, height, &velocity).unwrap()
                };
                let exact = at(height, velocity);
                let by_height =
                    (at(height + h, velocity).force - at(height - h, velocity).force) / (2.0 * h);
                assert!((exact.by_height - by_height).norm() < 1e-3 * (1.0 + by_height.norm()));
                for k in 0..3 {
                    let mut d = Vector3::zeros();
                    d[k] = h;
                    let plus = at(height, velocity + d).force;
                    let minus = at(height, velocity - d).force;
                    let numeric = (plus - minus) / (2.0 * h);
                    let got = exact.by_velocity.column(k);
                    assert!((got - numeric).norm() < 1e-4 * (1.0 + numeric.norm()));
                }
                let still = |height: f64| contact(&SEABED, 2.0, height, &Vector3::zeros()).unwrap();
                let slope = -(still(height + h).energy - still(height - h).energy) / (2.0 * h);
                assert!((still(height).force.z - slope).abs() < 1e-5 * slope.abs());
            }
        }
    }

    #[test]
    fn above_the_seabed_there_is_nothing_and_sliding_meets_coulomb_friction() {
        assert!(contact(&SEABED, 2.0, 0.1, &Vector3::zeros()).is_none());
        let sliding = contact(&SEABED, 2.0, -0.1, &Vector3::new(3.0, 4.0, 0.0)).unwrap();
        let friction = Vector3::new(sliding.force.x, sliding.force.y, 0.0);
        assert!((friction.norm() / sliding.force.z - 0.6).abs() < 1e-4);
        assert!(friction.x < 0.0 && friction.y < 0.0);
    }
}
