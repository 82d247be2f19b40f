//! Inertia and loads spread over the line, of several elements at a time: the field of `field.rs` in
//! lanes, for ends that are nodes.
//!
//! Source: docs/theory/fem.md, eqs. (25) to (30).

use catenix_numerics::lanes::{Lane, Mat3, Vec3};

use super::super::field::{AT_POINTS, CUBICS, POINT_COUNT, POINTS};
use super::{Assembled, Ends, Weights};

/// A point of each line.
#[derive(Debug, Clone, Copy)]
pub struct Stations<T> {
    /// Position [m].
    pub position: Vec3<T>,
    /// Direction, unit.
    pub axis: Vec3<T>,
    /// Velocity [m/s].
    pub velocity: Vec3<T>,
    /// Acceleration [m/s2].
    pub acceleration: Vec3<T>,
    /// Size of the derivative of the position by the place on the unit length [m].
    pub stretch: T,
}

/// A load per length, and its derivatives.
#[derive(Debug, Clone, Copy)]
pub struct Load<T> {
    /// The load [N/m].
    pub force: Vec3<T>,
    /// By the height [N/m2].
    pub height: Vec3<T>,
    /// By the axis, which stays unit: nothing along it [N/m].
    pub axis: Mat3<T>,
    /// By the velocity [N s/m2].
    pub velocity: Mat3<T>,
    /// By the acceleration [kg/m].
    pub acceleration: Mat3<T>,
}

/// Loads on the points of integration; what they are, the elements do not know.
pub trait SpreadLoads<T> {
    /// The load on one of the points of each element.
    fn at(&mut self, point: usize, stations: &Stations<T>) -> Load<T>;
}

/// The four vectors that the position is linear in, with their first and second rates.
#[derive(Debug, Clone, Copy)]
pub struct Fields<T> {
    value: [Vec3<T>; 4],
    rate: [Vec3<T>; 4],
    second: [Vec3<T>; 4],
    length: T,
}

/// How a vector that is fixed to a node, its velocity and acceleration follow the node's spin; of the
/// value itself, minus the vector's cross matrix, nothing is kept.
struct Turn<T> {
    rate: Mat3<T>,
    second: Mat3<T>,
}

impl<T: Lane> Turn<T> {
    /// Source: docs/theory/fem.md, eq. (28), with the products of cross matrices written out.
    #[inline(always)]
    fn new(y: Vec3<T>, end: &Ends<T>, weights: &Weights<T>, rotation: Mat3<T>) -> Turn<T> {
        let (spin, turning) = (end.spin, end.angular_acceleration);
        let (w, a) = (weights.velocity, weights.acceleration);
        // [spin][y]
        let moved = y.outer(spin).plus_diagonal(-spin.dot(y));
        let by_spin = ((moved + y.outer(spin) - spin.outer(y)) * w).plus_hat(y * a);
        let still = y
            .outer(turning)
            .plus_diagonal(-turning.dot(y))
            .plus_outer(spin.cross(y), spin)
            .plus_hat(spin * -spin.dot(y));
        Turn {
            rate: -(moved.plus(w, rotation.crossed_by(y))),
            second: -(still + by_spin.product(rotation)),
        }
    }
}

impl<T: Lane> Fields<T> {
    /// Source: docs/theory/fem.md, eqs. (25) and (27).
    #[inline(always)]
    pub fn new(ends: &[Ends<T>; 2], length: T) -> Fields<T> {
        let [first, second] = ends;
        let (a, b) = (first.rotation.0[0] * length, second.rotation.0[0] * length);
        let (p, q) = (first.spin.cross(a), second.spin.cross(b));
        Fields {
            value: [first.position, a, second.position, b],
            rate: [first.velocity, p, second.velocity, q],
            second: [
                first.acceleration,
                first.angular_acceleration.cross(a) + first.spin.cross(p),
                second.acceleration,
                second.angular_acceleration.cross(b) + second.spin.cross(q),
            ],
            length,
        }
    }

    /// The lines at one of the points of integration.
    #[inline(always)]
    pub fn stations(&self, point: usize) -> Stations<T> {
        let [shape, slopes] = &AT_POINTS[point];
        let slope = combine(slopes, &self.value);
        let stretch = slope.norm_squared().sqrt();
        Stations {
            position: combine(shape, &self.value),
            axis: slope * (stretch.same(1.0) / stretch),
            velocity: combine(shape, &self.rate),
            acceleration: combine(shape, &self.second),
            stretch,
        }
    }

    /// Length of the lines that a point of integration stands for [m].
    #[inline(always)]
    pub fn share(&self, point: usize) -> T {
        self.length * POINTS[point][1]
    }

    /// Twice the kinetic energy of a mass per length [J].
    ///
    /// Source: docs/theory/fem.md, eq. (26).
    #[inline(always)]
    pub fn twice_kinetic_energy(&self, mass: T) -> T {
        let mut sum = mass.same(0.0);
        let mut a = 0;
        while a < 4 {
            sum += self.rate[a].dot(combine(&CUBICS[a], &self.rate));
            a += 1;
        }
        mass * self.length * sum * (1.0 / 420.0)
    }

    /// Writes inertia less loads and, with `weights`, their derivatives over what `out` held.
    /// `uniform`: a vertical load per length of which half goes to each end [N/m].
    ///
    /// Source: docs/theory/fem.md, eqs. (26) to (30).
    #[inline(always)]
    #[expect(clippy::too_many_arguments, reason = "a struct would only rename them")]
    pub fn put<L: SpreadLoads<T>>(
        &self,
        ends: &[Ends<T>; 2],
        mass: T,
        uniform: T,
        loads: &mut L,
        weights: Option<&Weights<T>>,
        room: &mut Room<T>,
        out: &mut Assembled<T>,
    ) {
        let heavy = mass * self.length * (1.0 / 420.0);
        let mut forces = [self.value[0]; 4];
        let mut a = 0;
        while a < 4 {
            forces[a] = combine(&CUBICS[a], &self.second) * heavy;
            a += 1;
        }
        let half = uniform * self.length * 0.5;
        forces[0].z -= half;
        forces[2].z -= half;
        let Some(weights) = weights else {
            let mut point = 0;
            while point < POINT_COUNT {
                let load = loads.at(point, &self.stations(point));
                take_off(&mut forces, load.force * self.share(point), point);
                point += 1;
            }
            self.put_forces(&forces, out);
            return;
        };
        let points = &mut room.0;
        let mut point = 0;
        while point < POINT_COUNT {
            let stations = self.stations(point);
            let load = loads.at(point, &stations);
            let share = self.share(point);
            take_off(&mut forces, load.force * share, point);
            points[point] = PointTangent::new(&load, share, stations.stretch, weights);
            point += 1;
        }
        self.put_forces(&forces, out);
        let inert = heavy * weights.acceleration;
        let mut k = 0;
        while k < 2 {
            let moved = [
                points[0].by_translation(0, k),
                points[1].by_translation(1, k),
                points[2].by_translation(2, k),
            ];
            let inertia = Mat3::diagonal(inert);
            self.put_column(&forces, &inertia, &moved, 2 * k, out);
            let y = self.value[2 * k + 1];
            let turn = Turn::new(y, &ends[k], weights, weights.rotation[k]);
            let spun = [
                points[0].by_spin(0, k, y, &turn),
                points[1].by_spin(1, k, y, &turn),
                points[2].by_spin(2, k, y, &turn),
            ];
            self.put_column(&forces, &(turn.second * heavy), &spun, 2 * k + 1, out);
            k += 1;
        }
    }

    /// From the forces on the four vectors to those on the nodes.
    #[inline(always)]
    fn put_forces(&self, forces: &[Vec3<T>; 4], out: &mut Assembled<T>) {
        let mut k = 0;
        while k < 2 {
            let pull = self.value[2 * k + 1].cross(forces[2 * k + 1]);
            out.force[k] = [forces[2 * k], pull];
            k += 1;
        }
    }

    /// Writes the derivatives by one column: translation and spin of the first node, then of the
    /// second. `inertia`: its factor on the column of the mass matrix; `loads`: derivatives of the
    /// loads at the points of integration.
    ///
    /// Source: docs/theory/fem.md, eq. (29).
    #[inline(always)]
    fn put_column(
        &self,
        forces: &[Vec3<T>; 4],
        inertia: &Mat3<T>,
        loads: &[Mat3<T>; POINT_COUNT],
        column: usize,
        out: &mut Assembled<T>,
    ) {
        let mut k = 0;
        while k < 2 {
            let force = row(inertia, loads, 2 * k, column);
            let (slope, pull) = (self.value[2 * k + 1], forces[2 * k + 1]);
            let mut moment = row(inertia, loads, 2 * k + 1, column).crossed_by(slope);
            if column == 2 * k + 1 {
                // [pull][slope]
                moment = moment
                    .plus_outer(slope, pull)
                    .plus_diagonal(-slope.dot(pull));
            }
            let block = &mut out.block[k][column / 2];
            block[column % 2] = force;
            block[2 + column % 2] = moment;
            k += 1;
        }
    }
}

/// How the force on one of the four vectors follows a column.
#[inline(always)]
fn row<T: Lane>(
    inertia: &Mat3<T>,
    loads: &[Mat3<T>; POINT_COUNT],
    vector: usize,
    column: usize,
) -> Mat3<T> {
    let one = inertia.0[0].x;
    let mut sum = *inertia * one.same(CUBICS[vector][column]);
    let mut point = 0;
    while point < POINT_COUNT {
        sum = sum.plus(one.same(-AT_POINTS[point][0][vector]), loads[point]);
        point += 1;
    }
    sum
}

/// Room for what is found at the points of integration; to be kept from element to element, since
/// clearing it costs as much as filling it.
pub struct Room<T>([PointTangent<T>; POINT_COUNT]);

impl<T: Lane> Room<T> {
    /// Some room.
    #[inline(always)]
    pub fn new(token: T::Token) -> Room<T> {
        let none = Mat3::zeros(token);
        Room(
            [PointTangent {
                translation: none,
                slope: none,
                raised: Vec3::zeros(token),
                velocity: none,
                acceleration: none,
            }; POINT_COUNT],
        )
    }
}

/// Derivatives of a load, times the length that its point stands for.
#[derive(Clone, Copy)]
struct PointTangent<T> {
    /// By a translation of the point.
    translation: Mat3<T>,
    /// By the derivative of the position by the place on the unit length.
    slope: Mat3<T>,
    /// By the height.
    raised: Vec3<T>,
    velocity: Mat3<T>,
    acceleration: Mat3<T>,
}

impl<T: Lane> PointTangent<T> {
    /// Source: docs/theory/fem.md, eq. (30).
    #[inline(always)]
    fn new(load: &Load<T>, share: T, stretch: T, weights: &Weights<T>) -> PointTangent<T> {
        let (velocity, acceleration) = (load.velocity * share, load.acceleration * share);
        let raised = load.height * share;
        let mut translation =
            (velocity * weights.velocity).plus(weights.acceleration, acceleration);
        translation.0[2] += raised;
        PointTangent {
            translation,
            slope: load.axis * (share / stretch),
            raised,
            velocity,
            acceleration,
        }
    }

    #[inline(always)]
    fn by_translation(&self, point: usize, k: usize) -> Mat3<T> {
        let [shape, slopes] = &AT_POINTS[point];
        let one = self.raised.x;
        (self.translation * one.same(shape[2 * k])).plus(one.same(slopes[2 * k]), self.slope)
    }

    /// `y`: the vector that turns with the node, and whose value follows a spin with minus its cross
    /// matrix.
    #[inline(always)]
    fn by_spin(&self, point: usize, k: usize, y: Vec3<T>, turn: &Turn<T>) -> Mat3<T> {
        let [shape, slopes] = &AT_POINTS[point];
        let (one, zero) = (y.x, y.x.same(0.0));
        let turned = self
            .velocity
            .product(turn.rate)
            .plus_outer(self.raised, Vec3::new(y.y, -y.x, zero))
            + self.acceleration.product(turn.second);
        turned * one.same(shape[2 * k + 1]) - self.slope.crossing(y * one.same(slopes[2 * k + 1]))
    }
}

/// Takes a force at a point of integration off those on the four vectors.
#[inline(always)]
fn take_off<T: Lane>(forces: &mut [Vec3<T>; 4], force: Vec3<T>, point: usize) {
    let shape = &AT_POINTS[point][0];
    let mut a = 0;
    while a < 4 {
        forces[a] = forces[a].minus(force.x.same(shape[a]), force);
        a += 1;
    }
}

#[inline(always)]
fn combine<T: Lane>(factors: &[f64; 4], vectors: &[Vec3<T>; 4]) -> Vec3<T> {
    let one = vectors[0].x;
    (vectors[0] * one.same(factors[0]))
        .plus(one.same(factors[1]), vectors[1])
        .plus(one.same(factors[2]), vectors[2])
        .plus(one.same(factors[3]), vectors[3])
}
