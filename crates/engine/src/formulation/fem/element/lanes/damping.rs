//! Damping of corotational elements, in proportion to stiffness.

use catenix_numerics::lanes::{Lane, Mat3, Vec3};

use super::frame::Frame;
use super::law::Law;
use super::{Ends, Weights, each, rows_times, turned_to};

/// Damping forces in element axes, and what they are made of.
///
/// Source: docs/theory/fem.md, eq. (14).
pub(super) struct Damping<T> {
    /// Damping time [s].
    tau: T,
    pub force: Vec3<T>,
    pub moments: [Vec3<T>; 2],
    velocity: Vec3<T>,
    spins: [Vec3<T>; 2],
    pub power: T,
}

impl<T: Lane> Damping<T> {
    /// Source: docs/theory/fem.md, eq. (14).
    #[inline(always)]
    pub fn new(tau: T, law: &Law<T>, frame: &Frame<T>, ends: &[Ends<T>; 2]) -> Damping<T> {
        let [first, second] = ends;
        let velocity = frame.axes.led_by(second.velocity - first.velocity);
        let spins = [
            frame.axes.led_by(first.spin),
            frame.axes.led_by(second.spin),
        ];
        let zero = tau.same(0.0);
        let chord = Vec3::new(zero, -velocity.z, velocity.y) * frame.inverse;
        let relative = [spins[0] - chord, spins[1] - chord];
        let [same, other] = law.stiffness(zero);
        let moments = [
            (each(same, relative[0]) + each(other, relative[1])) * tau,
            (each(other, relative[0]) + each(same, relative[1])) * tau,
        ];
        let sum = moments[0] + moments[1];
        let tension = tau * law.axial / law.length * velocity.x;
        let power =
            tension * velocity.x + moments[0].dot(relative[0]) + moments[1].dot(relative[1]);
        Damping {
            tau,
            force: Vec3::new(tension, -(sum.z * frame.inverse), sum.y * frame.inverse),
            moments,
            velocity,
            spins,
            power: -power,
        }
    }

    /// Adds the derivatives of the damping, in element axes.
    ///
    /// Source: docs/theory/fem.md, eqs. (54) and (55).
    #[inline(always)]
    pub fn add_tangent(
        &self,
        law: &Law<T>,
        frame: &Frame<T>,
        weights: &Weights<T>,
        local: &mut [[Mat3<T>; 3]; 3],
    ) {
        let (d, tau) = (self, self.tau);
        let (inverse, w, zero) = (frame.inverse, weights.velocity, tau.same(0.0));
        let [same, other] = law.stiffness(zero);
        let (same, other) = (same * tau, other * tau);
        let half = tau * inverse * 0.5;
        let (y, z) = (half * law.alike[0], half * law.alike[1]);
        let across = Vec3::new(
            tau * law.axial / law.length,
            (z + z) * inverse,
            (y + y) * inverse,
        );
        // By velocities: across on the diagonal, and -z, y beside it in the rows of the force.
        let velocity = Mat3::hat(d.velocity);
        let spins = [Mat3::hat(d.spins[0]), Mat3::hat(d.spins[1])];
        let turning = [
            rows_times(across, velocity) + beside(spins[0] + spins[1], -z, y) - Mat3::hat(d.force),
            beside(velocity, y, -z) + rows_times(same, spins[0]) + rows_times(other, spins[1])
                - Mat3::hat(d.moments[0]),
            beside(velocity, y, -z) + rows_times(other, spins[0]) + rows_times(same, spins[1])
                - Mat3::hat(d.moments[1]),
        ];
        let pushed = each(across, d.velocity);
        let twisted = Vec3::new(zero, y * d.velocity.z, -(z * d.velocity.y));
        let longer = [
            Vec3::new(
                zero,
                -(d.force.y + pushed.y) * inverse,
                -(d.force.z + pushed.z) * inverse,
            ),
            twisted * -inverse,
            twisted * -inverse,
        ];
        let rates = [
            turned_to(frame.axes, weights.rotation[0]),
            turned_to(frame.axes, weights.rotation[1]),
        ];
        let by_rates = [
            [beside(rates[0], -z, y), beside(rates[1], -z, y)],
            [rows_times(same, rates[0]), rows_times(other, rates[1])],
            [rows_times(other, rates[0]), rows_times(same, rates[1])],
        ];
        let one = Mat3::diagonal(tau.same(1.0));
        let by_velocity = [
            rows_times(across, one),
            beside(one, y, -z),
            beside(one, y, -z),
        ];
        let mut r = 0;
        while r < 3 {
            let [p, q, s] = turning[r].0;
            let by_span = Mat3([longer[r], s * inverse, (p * frame.lean + q) * -inverse]);
            local[r][0] = (local[r][0] + by_span).plus(w, by_velocity[r]);
            local[r][1] = local[r][1]
                .plus_outer(p, frame.roll[0])
                .plus(w, by_rates[r][0]);
            local[r][2] = local[r][2]
                .plus_outer(p, frame.roll[1])
                .plus(w, by_rates[r][1]);
            r += 1;
        }
    }
}

/// A matrix with only the entries `yz` and `zy`, times `m`.
#[inline(always)]
fn beside<T: Lane>(m: Mat3<T>, yz: T, zy: T) -> Mat3<T> {
    let zero = yz.same(0.0);
    let [a, b, c] = m.0;
    Mat3([
        Vec3::new(zero, yz * a.z, zy * a.y),
        Vec3::new(zero, yz * b.z, zy * b.y),
        Vec3::new(zero, yz * c.z, zy * c.y),
    ])
}
