//! The line between two nodes as a field: where its points are, how they move, and how inertia and
//! loads that are spread over it reach the nodes.
//!
//! The position is Hermite's cubic through the ends, with the sections' axes as slopes. It is linear
//! in four vectors, two of which turn with a node; so inertia is exact with a constant mass matrix,
//! energy and momenta are kept, and a straight beam that bends has the cubic beam's consistent mass.
//! The same holds for both elements: what they store in a deformed shape is their own affair.
//!
//! An end may be carried at a distance by a body: its node is then the body, and a lever leads from
//! there to the end.
//!
//! Source: docs/theory/fem.md, eqs. (25) to (31).

use catenix_numerics::{Block6, Matrix3, Vector3, Vector6, so3::hat};

use super::ends::End;

/// Hermite's cubics integrated two by two over the unit length, times 420: position and slope of
/// the first end, then of the second.
pub(super) const CUBICS: [[f64; 4]; 4] = [
    [156.0, 22.0, 54.0, -13.0],
    [22.0, 4.0, 13.0, -3.0],
    [54.0, 13.0, 156.0, -22.0],
    [-13.0, -3.0, -22.0, 4.0],
];

/// Places and weights of the points at which loads are taken, on the unit length: Gauss, exact for
/// polynomials of degree 5.
pub(in crate::formulation::fem) const POINTS: [[f64; 2]; 3] = [
    [0.112_701_665_379_258_31, 5.0 / 18.0],
    [0.5, 8.0 / 18.0],
    [0.887_298_334_620_741_7, 5.0 / 18.0],
];

/// Number of points at which loads are taken.
pub const POINT_COUNT: usize = POINTS.len();

/// Hermite's cubics, and their slopes, at a place on the unit length.
const fn cubics(x: f64) -> [[f64; 4]; 2] {
    let y = 1.0 - x;
    [
        [
            y * y * (1.0 + 2.0 * x),
            x * y * y,
            x * x * (3.0 - 2.0 * x),
            -x * x * y,
        ],
        [
            -6.0 * x * y,
            y * (1.0 - 3.0 * x),
            6.0 * x * y,
            -x * (2.0 - 3.0 * x),
        ],
    ]
}

pub(super) const AT_POINTS: [[[f64; 4]; 2]; POINT_COUNT] = [
    cubics(POINTS[0][0]),
    cubics(POINTS[1][0]),
    cubics(POINTS[2][0]),
];

/// A point of the line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Station {
    /// Position, global (3) [m].
    pub position: Vector3,
    /// Direction of the line, unit, global (3).
    pub axis: Vector3,
    /// Velocity (3) [m/s].
    pub velocity: Vector3,
    /// Acceleration (3) [m/s2].
    pub acceleration: Vector3,
    /// Length of the line that it stands for [m].
    pub length: f64,
}

/// Derivatives of a load per length by what is known of its station.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoadTangent {
    /// By the position [N/m2].
    pub position: Matrix3,
    /// By the axis [N/m].
    pub axis: Matrix3,
    /// By the velocity [N s/m2].
    pub velocity: Matrix3,
    /// By the acceleration [kg/m].
    pub acceleration: Matrix3,
}

/// A load spread over the line; what it is, the element does not know.
pub trait SpreadLoad {
    /// Force per length on the line at a station, global (3) [N/m].
    fn force(&self, station: &Station) -> Vector3;

    /// The same with its exact derivatives.
    fn linearised(&self, station: &Station) -> (Vector3, LoadTangent);
}

/// What carries an end: the end is at `lever` from the origin of the frame that is the unknown.
/// A node carries its own end, with no lever.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Carried {
    /// The end.
    pub end: End,
    /// From the origin of the carrying frame to the end, global (3) [m].
    pub lever: Vector3,
}

/// How velocities and accelerations follow an increment.
#[derive(Debug, Clone, Copy)]
pub struct FieldWeights {
    /// d velocity / d increment [1/s].
    pub velocity: f64,
    /// d acceleration / d increment [1/s2].
    pub acceleration: f64,
    /// Factor on the rotation increments of the two carrying frames.
    pub rotation: [Matrix3; 2],
}

/// Residual and matrix of an element, by its two carrying frames.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ElementBlocks {
    /// Force and moment on each frame (2 x 6) [N, N m].
    pub force: [Vector6; 2],
    /// Their derivatives, row and column by frame (2 x 2 blocks).
    pub block: [[Block6; 2]; 2],
}

impl ElementBlocks {
    /// All zeros.
    pub fn zeros() -> ElementBlocks {
        ElementBlocks {
            force: [Vector6::zeros(); 2],
            block: [[Block6::ZERO; 2]; 2],
        }
    }
}

/// The four vectors that the position is linear in, with their first and second rates.
#[derive(Debug, Clone, Copy)]
pub struct Field {
    value: [Vector3; 4],
    rate: [Vector3; 4],
    second: [Vector3; 4],
    length: f64,
}

/// How a vector that is fixed to a frame, its velocity and acceleration follow the frame's spin.
#[derive(Clone, Copy)]
struct Turn {
    value: Matrix3,
    rate: Matrix3,
    second: Matrix3,
}

impl Turn {
    /// Source: docs/theory/fem.md, eq. (28).
    #[inline]
    fn new(v: &Vector3, end: &End, velocity: f64, acceleration: f64, rotation: &Matrix3) -> Turn {
        let value = -hat(v);
        let spin = hat(&end.spin);
        let by_spin = rotation * velocity;
        let moved = spin * value;
        Turn {
            value,
            rate: value * by_spin + moved,
            second: value * rotation * acceleration + hat(&end.angular_acceleration) * value
                - (hat(&end.spin.cross(v)) - moved) * by_spin
                + spin * moved,
        }
    }

    #[inline]
    fn combined(&self, factor: f64, other: &Turn, other_factor: f64) -> Turn {
        let add = |a: &Matrix3, b: &Matrix3| a * factor + b * other_factor;
        Turn {
            value: add(&self.value, &other.value),
            rate: add(&self.rate, &other.rate),
            second: add(&self.second, &other.second),
        }
    }
}

/// Derivatives of the forces on the four vectors: columns are translation and spin of the first
/// frame, then of the second.
struct Columns {
    by: [[Matrix3; 4]; 4],
    turns: [Turn; 2],
    levers: Option<[Turn; 2]>,
}

impl Field {
    /// Source: docs/theory/fem.md, eqs. (25) and (27).
    #[inline]
    pub fn new(ends: [&End; 2], length: f64) -> Field {
        let mut field = Field {
            value: [Vector3::zeros(); 4],
            rate: [Vector3::zeros(); 4],
            second: [Vector3::zeros(); 4],
            length,
        };
        for (k, end) in ends.into_iter().enumerate() {
            let slope = end.rotation.column(0) * length;
            let rate = end.spin.cross(&slope);
            field.value[2 * k] = end.position;
            field.rate[2 * k] = end.velocity;
            field.second[2 * k] = end.acceleration;
            field.value[2 * k + 1] = slope;
            field.rate[2 * k + 1] = rate;
            field.second[2 * k + 1] =
                end.angular_acceleration.cross(&slope) + end.spin.cross(&rate);
        }
        field
    }

    /// The line at one of the points of integration.
    #[inline]
    pub fn station(&self, point: usize) -> Station {
        let [shape, slopes] = &AT_POINTS[point];
        let slope = combine(slopes, &self.value);
        Station {
            position: combine(shape, &self.value),
            axis: slope / slope.norm().max(f64::MIN_POSITIVE),
            velocity: combine(shape, &self.rate),
            acceleration: combine(shape, &self.second),
            length: POINTS[point][1] * self.length,
        }
    }

    /// Kinetic energy of a mass per length [J].
    ///
    /// Source: docs/theory/fem.md, eq. (26).
    pub fn kinetic_energy(&self, mass: f64) -> f64 {
        let mut twice = 0.0;
        for (row, a) in CUBICS.iter().zip(&self.rate) {
            twice += a.dot(&combine(row, &self.rate));
        }
        0.5 * mass * self.length / 420.0 * twice
    }

    /// Linear momentum, and angular momentum about the global origin, of a mass per length
    /// (3) [kg m/s], (3) [kg m2/s].
    pub fn momentum(&self, mass: f64) -> [Vector3; 2] {
        let mut momenta = [Vector3::zeros(); 2];
        for (row, value) in CUBICS.iter().zip(&self.value) {
            let own = combine(row, &self.rate) * (mass * self.length / 420.0);
            momenta[1] += value.cross(&own);
        }
        // The cubics of the two positions add up to one.
        for k in [0, 2] {
            momenta[0] += combine(&CUBICS[k], &self.rate) * (mass * self.length / 420.0);
        }
        momenta
    }

    /// Adds inertia less loads to `out`, and with `weights` their derivatives. `uniform`: a load per
    /// length of which half goes to each end (3) [N/m]; its moments are in `weight.rs`.
    ///
    /// Source: docs/theory/fem.md, eqs. (26) to (30).
    pub fn add(
        &self,
        carried: [&Carried; 2],
        mass: f64,
        uniform: &Vector3,
        load: &impl SpreadLoad,
        weights: Option<&FieldWeights>,
        out: &mut ElementBlocks,
    ) {
        let mut forces = [Vector3::zeros(); 4];
        let heavy = mass * self.length / 420.0;
        for (row, force) in CUBICS.iter().zip(&mut forces) {
            *force = combine(row, &self.second) * heavy;
        }
        let half = uniform * (0.5 * self.length);
        forces[0] -= half;
        forces[2] -= half;
        let mut columns = weights.map(|weights| self.columns(carried, weights, heavy));
        for (point, [shape, slopes]) in AT_POINTS.iter().enumerate() {
            let station = self.station(point);
            let force = match (&mut columns, weights) {
                (Some(columns), Some(weights)) => {
                    let (force, tangent) = load.linearised(&station);
                    let stretch = combine(slopes, &self.value).norm().max(f64::MIN_POSITIVE);
                    let project = Matrix3::identity() - station.axis * station.axis.transpose();
                    let by_slope = tangent.axis * project / stretch;
                    let at = [shape, slopes];
                    columns.add_load(&tangent, &by_slope, at, station.length, weights);
                    force
                }
                _ => load.force(&station),
            };
            for (sum, shape) in forces.iter_mut().zip(shape) {
                *sum -= force * (*shape * station.length);
            }
        }
        self.spread_to_frames(carried, &forces, columns.as_ref(), out);
    }

    /// Adds the mass matrix: of a mass per length, and of an added mass per length that depends on
    /// the station (3 x 3, symmetric) [kg/m].
    ///
    /// Source: docs/theory/fem.md, eqs. (26) and (29).
    pub fn add_mass(
        &self,
        carried: [&Carried; 2],
        mass: f64,
        added: impl Fn(&Station) -> Matrix3,
        out: &mut [[Block6; 2]; 2],
    ) {
        let heavy = mass * self.length / 420.0;
        let mut own = CUBICS.map(|row| row.map(|entry| Matrix3::identity() * (entry * heavy)));
        for (point, [shape, _]) in AT_POINTS.iter().enumerate() {
            let station = self.station(point);
            let added = added(&station) * station.length;
            for (row, a) in own.iter_mut().zip(shape) {
                for (entry, b) in row.iter_mut().zip(shape) {
                    *entry += added * (a * b);
                }
            }
        }
        // By spins: the slope and the lever turn with the frame.
        let arms = [0, 1].map(|k: usize| [hat(&carried[k].lever), hat(&self.value[2 * k + 1])]);
        for i in 0..2 {
            for j in 0..2 {
                let by = |a: usize, b: usize| &own[2 * i + a][2 * j + b];
                let ([lever_i, slope_i], [lever_j, slope_j]) = (&arms[i], &arms[j]);
                let to_spin = |a: usize| by(a, 0) * lever_j + by(a, 1) * slope_j;
                let block = &mut out[i][j];
                block.add_quadrant(0, 0, by(0, 0));
                block.add_quadrant(0, 1, &-to_spin(0));
                block.add_quadrant(1, 0, &(lever_i * by(0, 0) + slope_i * by(1, 0)));
                block.add_quadrant(1, 1, &-(lever_i * to_spin(0) + slope_i * to_spin(1)));
            }
        }
    }

    /// The columns of the inertia.
    #[inline]
    fn columns(&self, carried: [&Carried; 2], weights: &FieldWeights, heavy: f64) -> Columns {
        let turn = |k: usize, v: &Vector3| {
            Turn::new(
                v,
                &carried[k].end,
                weights.velocity,
                weights.acceleration,
                &weights.rotation[k],
            )
        };
        let turns = [0, 1].map(|k: usize| turn(k, &self.value[2 * k + 1]));
        let levered = carried.iter().any(|c| c.lever != Vector3::zeros());
        let levers = levered.then(|| [0, 1].map(|k: usize| turn(k, &carried[k].lever)));
        let mut by = [[Matrix3::zeros(); 4]; 4];
        let translation = Matrix3::identity() * (heavy * weights.acceleration);
        for (row, factors) in by.iter_mut().zip(&CUBICS) {
            for k in 0..2 {
                row[2 * k] = translation * factors[2 * k];
                row[2 * k + 1] = turns[k].second * (heavy * factors[2 * k + 1]);
                if let Some(levers) = &levers {
                    row[2 * k + 1] += levers[k].second * (heavy * factors[2 * k]);
                }
            }
        }
        Columns { by, turns, levers }
    }

    /// From the forces on the four vectors to those on the frames.
    #[inline]
    fn spread_to_frames(
        &self,
        carried: [&Carried; 2],
        forces: &[Vector3; 4],
        columns: Option<&Columns>,
        out: &mut ElementBlocks,
    ) {
        for k in 0..2 {
            let (force, pull) = (&forces[2 * k], &forces[2 * k + 1]);
            let (slope, lever) = (&self.value[2 * k + 1], &carried[k].lever);
            let moment = slope.cross(pull) + lever.cross(force);
            let mut sum = out.force[k].fixed_rows_mut::<3>(0);
            sum += force;
            let mut sum = out.force[k].fixed_rows_mut::<3>(3);
            sum += moment;
            let Some(columns) = columns else { continue };
            let arm = hat(slope);
            let lever_hat = columns.levers.as_ref().map(|_| hat(lever));
            for c in 0..4 {
                let block = &mut out.block[k][c / 2];
                let by_force = &columns.by[2 * k][c];
                let mut by_moment = arm * columns.by[2 * k + 1][c];
                if let Some(lever) = &lever_hat {
                    by_moment += lever * by_force;
                }
                if c == 2 * k + 1 {
                    by_moment -= hat(pull) * columns.turns[k].value;
                    if let Some(levers) = &columns.levers {
                        by_moment -= hat(force) * levers[k].value;
                    }
                }
                block.add_quadrant(0, c % 2, by_force);
                block.add_quadrant(1, c % 2, &by_moment);
            }
        }
    }
}

impl Columns {
    /// Takes the derivatives of a load off.
    #[inline]
    fn add_load(
        &mut self,
        tangent: &LoadTangent,
        by_slope: &Matrix3,
        [shape, slopes]: [&[f64; 4]; 2],
        length: f64,
        weights: &FieldWeights,
    ) {
        let translation = tangent.position
            + tangent.velocity * weights.velocity
            + tangent.acceleration * weights.acceleration;
        for k in 0..2 {
            let moved = translation * shape[2 * k] + by_slope * slopes[2 * k];
            let (own, turn) = (2 * k + 1, &self.turns[k]);
            let (at, along) = match &self.levers {
                None => {
                    let scaled = |factor: f64| Turn {
                        value: turn.value * factor,
                        rate: turn.rate * factor,
                        second: turn.second * factor,
                    };
                    (scaled(shape[own]), turn.value * slopes[own])
                }
                Some(levers) => {
                    let at = turn.combined(shape[own], &levers[k], shape[2 * k]);
                    let along = turn.value * slopes[own] + levers[k].value * slopes[2 * k];
                    (at, along)
                }
            };
            let spun = tangent.position * at.value
                + by_slope * along
                + tangent.velocity * at.rate
                + tangent.acceleration * at.second;
            for (row, shape) in self.by.iter_mut().zip(shape) {
                row[2 * k] -= moved * (shape * length);
                row[2 * k + 1] -= spun * (shape * length);
            }
        }
    }
}

#[inline]
fn combine(factors: &[f64; 4], vectors: &[Vector3; 4]) -> Vector3 {
    vectors[0] * factors[0]
        + vectors[1] * factors[1]
        + vectors[2] * factors[2]
        + vectors[3] * factors[3]
}
