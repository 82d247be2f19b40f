//! Elements that are computed side by side, one per lane: the corotational beam, and what inertia and
//! loads spread over the line do to its nodes. They see and give the same as in `ends.rs` and
//! `field.rs`; joints, ends on vessels and bodies, and laws by points are left to those.
//!
//! No closures and no calls: see `catenix_numerics::lanes`.

pub mod corotational;
mod couples;
mod damping;
mod elastic;
pub mod field;
mod frame;
mod law;

use catenix_numerics::lanes::{Lane, Mat3, Vec3};

/// The ends of elements, and how they move; all global.
#[derive(Debug, Clone, Copy)]
pub struct Ends<T> {
    /// Position [m].
    pub position: Vec3<T>,
    /// Section axes to global axes.
    pub rotation: Mat3<T>,
    /// Velocity [m/s].
    pub velocity: Vec3<T>,
    /// Angular velocity [rad/s].
    pub spin: Vec3<T>,
    /// Acceleration [m/s2].
    pub acceleration: Vec3<T>,
    /// Angular acceleration [rad/s2].
    pub angular_acceleration: Vec3<T>,
}

/// How velocities and accelerations follow an increment.
#[derive(Debug, Clone, Copy)]
pub struct Weights<T> {
    /// d velocity / d increment [1/s].
    pub velocity: T,
    /// d acceleration / d increment [1/s2].
    pub acceleration: T,
    /// Factor on the rotation increments of the two ends.
    pub rotation: [Mat3<T>; 2],
}

/// Force and moment at both ends, and their derivatives by the increments of both.
#[derive(Debug, Clone, Copy)]
pub struct Assembled<T> {
    /// Force and moment at each end [N, N m].
    pub force: [[Vec3<T>; 2]; 2],
    /// Row and column by end: quadrants of force and moment by translation and rotation, by rows.
    pub block: [[[Mat3<T>; 4]; 2]; 2],
}

impl<T: Lane> Assembled<T> {
    /// All zeros.
    #[inline(always)]
    pub fn zeros(token: T::Token) -> Self {
        Assembled {
            force: [[Vec3::zeros(token); 2]; 2],
            block: [[[Mat3::zeros(token); 4]; 2]; 2],
        }
    }

    /// Adds internal forces: of the second end, which the first has with the other sign, and the
    /// moments of both.
    #[inline(always)]
    pub fn add_internal(&mut self, force: Vec3<T>, moments: [Vec3<T>; 2]) {
        let [first, second] = &mut self.force;
        first[0] -= force;
        second[0] += force;
        first[1] += moments[0];
        second[1] += moments[1];
    }

    /// Adds their derivatives, in blocks as in `ends.rs`.
    #[inline(always)]
    pub fn add_internal_tangent(&mut self, by: &[[Mat3<T>; 3]; 3]) {
        let [[ff, f0, f1], [m0f, m00, m01], [m1f, m10, m11]] = by;
        let [[first, upper], [lower, second]] = &mut self.block;
        sum(first, [*ff, -*f0, -*m0f, *m00]);
        sum(upper, [-*ff, -*f1, *m0f, *m01]);
        sum(lower, [-*ff, *f0, -*m1f, *m10]);
        sum(second, [*ff, *f1, *m1f, *m11]);
    }
}

#[inline(always)]
fn sum<T: Lane>(block: &mut [Mat3<T>; 4], other: [Mat3<T>; 4]) {
    let mut k = 0;
    while k < 4 {
        block[k] = block[k] + other[k];
        k += 1;
    }
}

/// axes^T rotation
#[inline(always)]
fn turned_back<T: Lane>(axes: Mat3<T>, rotation: Mat3<T>) -> Mat3<T> {
    let [a, b, c] = rotation.0;
    Mat3([axes.led_by(a), axes.led_by(b), axes.led_by(c)])
}

/// axes m axes^T
#[inline(always)]
fn turned<T: Lane>(axes: Mat3<T>, m: Mat3<T>) -> Mat3<T> {
    axes.product(m).product(axes.transposed())
}

/// axes^T m axes
#[inline(always)]
fn turned_to<T: Lane>(axes: Mat3<T>, m: Mat3<T>) -> Mat3<T> {
    turned_back(axes, m.product(axes))
}

/// Each component times its own.
#[inline(always)]
fn each<T: Lane>(a: Vec3<T>, b: Vec3<T>) -> Vec3<T> {
    Vec3::new(a.x * b.x, a.y * b.y, a.z * b.z)
}

/// diag(d) m
#[inline(always)]
fn rows_times<T: Lane>(d: Vec3<T>, m: Mat3<T>) -> Mat3<T> {
    let [a, b, c] = m.0;
    Mat3([each(d, a), each(d, b), each(d, c)])
}

/// a^T diag(d) b
#[inline(always)]
fn sandwich<T: Lane>(a: Mat3<T>, d: Vec3<T>, b: Mat3<T>) -> Mat3<T> {
    turned_back(a, rows_times(d, b))
}
