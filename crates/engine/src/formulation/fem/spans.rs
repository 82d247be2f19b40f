//! The elements between two nodes, several at a time: those with linear laws, which are nearly all.
//! The others, and those that end on a vessel or body, go one by one (`evaluation.rs`).

use catenix_numerics::lanes::{
    Kernel as Work, Lane, MOST_LANES, Mat3, Row, Vec3, add_records, block, gather, lane_count,
    put_records, vectorised,
};
use catenix_numerics::{BlockMatrix, MotionState, TangentWeights, Vector6};

use super::super::Situation;
use super::element::field::POINTS;
use super::element::lanes::field::{Fields, Room};
use super::element::lanes::{Assembled, Ends, Weights};
use super::kernel::{Kernel, Lanes};
use super::load_lanes::{SeaLoads, SpreadRows};
use super::{Fem, Part, Place, Seat};
use crate::system::frames::LoadPowers;

const NO_ROW: Row = [0.0; MOST_LANES];

/// As many elements as are computed at once.
#[derive(Debug, Clone)]
struct Batch<L> {
    /// Elements in it.
    count: usize,
    /// First frame of the first element. The others follow, and so do their second frames; whatever
    /// comes behind them fills idle lanes, with the properties of the last element.
    frame: usize,
    /// The first element among all.
    element: usize,
    length: Row,
    spread: SpreadRows,
    beams: L,
}

/// All elements that are computed side by side.
#[derive(Debug, Clone)]
pub(super) struct Spans<L> {
    batches: Vec<Batch<L>>,
    /// Whether there is a prediction.
    predicts: bool,
}

/// The first frame of an element between two neighbouring nodes; the second one follows.
fn first_frame(part: &Part) -> Option<usize> {
    match (part.seats, part.place) {
        ([Seat::Node(a), Seat::Node(b)], Place::Link(k)) if a == k && b == k + 1 => Some(k),
        _ => None,
    }
}

impl<L: Lanes> Spans<L> {
    /// The elements that can be computed side by side, and the indices of the others.
    pub(super) fn among<K: Kernel<Lanes = L>>(fem: &Fem<K>) -> (Spans<L>, Vec<usize>) {
        let fits = |index: &usize| {
            first_frame(&fem.parts[*index]).is_some() && fem.kernels[*index].fits_in_lanes()
        };
        let (fitting, others): (Vec<usize>, Vec<usize>) = (0..fem.parts.len()).partition(fits);
        let mut spans = Spans {
            batches: Vec::new(),
            predicts: false,
        };
        let mut left = others;
        let follows = |a: &usize, b: &usize| {
            let frames = [*a, *b].map(|k| first_frame(&fem.parts[k]));
            *b == a + 1 && frames[0].map(|k| k + 1) == frames[1]
        };
        for chunk in fitting
            .chunk_by(follows)
            .flat_map(|run| run.chunks(lane_count()))
        {
            match Batch::new(fem, chunk) {
                Some(batch) => spans.batches.push(batch),
                None => left.extend(chunk),
            }
        }
        left.sort_unstable();
        (spans, left)
    }

    pub(super) fn begin(&mut self) {
        self.predicts = false;
    }

    /// Adds residual and, with `weights`, matrix of the elements; writes their forces on their ends.
    pub(super) fn assemble(
        &mut self,
        at: &Situation<'_>,
        weights: Option<&TangentWeights<'_>>,
        forces: &mut [Vec<Vector6>; 2],
        residual: &mut [Vector6],
        matrix: &mut BlockMatrix,
    ) {
        vectorised(Assembly {
            spans: self,
            at,
            weights,
            forces,
            residual,
            matrix,
        });
    }

    /// Predicts the deformation after an increment of the frames.
    pub(super) fn moving(&mut self, increment: &[Vector6]) {
        vectorised(Moving {
            spans: self,
            increment,
        });
    }

    /// Elastic energy [J] and power of the damping [W] at the state that was assembled last.
    pub(super) fn elastic_energy(&self) -> [f64; 2] {
        let mut sums = [0.0; 2];
        for batch in &self.batches {
            for (sum, row) in sums.iter_mut().zip(batch.beams.energy()) {
                *sum += row[..batch.count].iter().sum::<f64>();
            }
        }
        sums
    }

    /// Kinetic energy and potential of the weight [J], and the powers of the loads; without seabed.
    pub(super) fn energies(&self, at: &Situation<'_>) -> (f64, f64, LoadPowers) {
        let [twice_kinetic, potential, drag, added_mass, buoyancy] =
            vectorised(Energies { spans: self, at });
        let powers = LoadPowers {
            drag,
            added_mass,
            buoyancy,
            seabed_damping: 0.0,
        };
        (0.5 * twice_kinetic, potential, powers)
    }

    /// First frames of the elements.
    pub(super) fn first_frames(&self) -> impl Iterator<Item = usize> + '_ {
        let of = |batch: &Batch<L>| batch.frame..batch.frame + batch.count;
        self.batches.iter().flat_map(of)
    }

    /// Elements that are computed side by side.
    pub(super) fn elements(&self) -> impl Iterator<Item = usize> + '_ {
        let of = |batch: &Batch<L>| batch.element..batch.element + batch.count;
        self.batches.iter().flat_map(of)
    }
}

impl<L: Lanes> Batch<L> {
    fn new<K: Kernel<Lanes = L>>(fem: &Fem<K>, elements: &[usize]) -> Option<Batch<L>> {
        let kernels: Vec<&K> = elements.iter().map(|&k| &fem.kernels[k]).collect();
        let spread: Vec<_> = elements
            .iter()
            .map(|&k| (&fem.parts[k].spread, fem.parts[k].length))
            .collect();
        let first = *elements.first()?;
        let last = elements.len() - 1;
        let length = std::array::from_fn(|lane| fem.parts[elements[lane.min(last)]].length);
        Some(Batch {
            count: elements.len(),
            frame: first_frame(&fem.parts[first])?,
            element: first,
            length,
            spread: SpreadRows::new(&spread),
            beams: K::side_by_side(&kernels)?,
        })
    }

    #[inline(always)]
    fn ends<T: Lane>(&self, token: T::Token, state: &MotionState) -> [Ends<T>; 2] {
        [
            load_ends(token, state, self.frame),
            load_ends(token, state, self.frame + 1),
        ]
    }
}

#[inline(always)]
fn load_ends<T: Lane>(token: T::Token, state: &MotionState, first: usize) -> Ends<T> {
    let [x, y, z] = gather(token, &state.configuration.position, first);
    let [u, v, w, p, q, r] = gather(token, &state.velocity, first);
    let [a, b, c, d, e, f] = gather(token, &state.acceleration, first);
    Ends {
        position: Vec3::new(x, y, z),
        rotation: Mat3::gather(token, &state.configuration.rotation, first),
        velocity: Vec3::new(u, v, w),
        spin: Vec3::new(p, q, r),
        acceleration: Vec3::new(a, b, c),
        angular_acceleration: Vec3::new(d, e, f),
    }
}

/// The factors on the rotations of frames.
#[inline(always)]
fn turns<T: Lane>(token: T::Token, weights: &TangentWeights<'_>, first: usize) -> Mat3<T> {
    match weights.rotation {
        None => Mat3::diagonal(T::splat(token, 1.0)),
        Some(rotation) => Mat3::gather(token, rotation, first),
    }
}

struct Assembly<'a, L> {
    spans: &'a mut Spans<L>,
    at: &'a Situation<'a>,
    weights: Option<&'a TangentWeights<'a>>,
    forces: &'a mut [Vec<Vector6>; 2],
    residual: &'a mut [Vector6],
    matrix: &'a mut BlockMatrix,
}

impl<L: Lanes> Work for Assembly<'_, L> {
    type Output = ();

    #[inline(always)]
    fn run<T: Lane>(self, token: T::Token) {
        let predicts = self.spans.predicts;
        let (mut out, mut room) = (Assembled::zeros(token), Room::new(token));
        for batch in &mut self.spans.batches {
            let ends = batch.ends::<T>(token, self.at.state);
            let own = match self.weights {
                None => None,
                Some(weights) => Some(Weights {
                    velocity: T::splat(token, weights.velocity),
                    acceleration: T::splat(token, weights.acceleration),
                    rotation: [
                        turns(token, weights, batch.frame),
                        turns(token, weights, batch.frame + 1),
                    ],
                }),
            };
            let length = T::read(token, &batch.length);
            let mass = T::read(token, &batch.spread.mass);
            let uniform =
                T::read(token, &batch.spread.buoyancy) - T::read(token, &batch.spread.weight);
            let mut loads = SeaLoads::<T> {
                rows: &batch.spread,
                sea: &self.at.sea,
                token,
            };
            let fields = Fields::new(&ends, length);
            let weights = own.as_ref();
            fields.put(
                &ends, mass, uniform, &mut loads, weights, &mut room, &mut out,
            );
            let beams = &mut batch.beams;
            beams.add(token, &ends, uniform, predicts, weights, &mut out);
            let mut end = 0;
            while end < 2 {
                let [f, m] = out.force[end];
                let values = [f.x, f.y, f.z, m.x, m.y, m.z];
                let [first, second] = &mut *self.forces;
                let kept = if end == 0 { first } else { second };
                add_records(&values, self.residual, batch.frame + end, batch.count);
                put_records(&values, kept, batch.element, batch.count);
                end += 1;
            }
            if own.is_some() {
                scatter(batch, &out, self.matrix);
            }
        }
    }
}

/// Adds the blocks on the diagonal, and writes those beside it, which no other element has.
#[inline(always)]
fn scatter<T: Lane, L>(batch: &Batch<L>, out: &Assembled<T>, matrix: &mut BlockMatrix) {
    let (first, count) = (batch.frame, batch.count);
    let [[own, upper], [lower, other]] = &out.block;
    add_records(&entries(own), &mut matrix.diagonal, first, count);
    add_records(&entries(other), &mut matrix.diagonal, first + 1, count);
    put_records(&entries(upper), &mut matrix.upper, first, count);
    put_records(&entries(lower), &mut matrix.lower, first, count);
}

#[inline(always)]
fn entries<T: Lane>([a, b, c, d]: &[Mat3<T>; 4]) -> [T; 36] {
    block([a, b, c, d])
}

struct Moving<'a, L> {
    spans: &'a mut Spans<L>,
    increment: &'a [Vector6],
}

impl<L: Lanes> Work for Moving<'_, L> {
    type Output = ();

    #[inline(always)]
    fn run<T: Lane>(self, token: T::Token) {
        self.spans.predicts = true;
        for batch in &mut self.spans.batches {
            let [u, v, w, p, q, r] = gather(token, self.increment, batch.frame);
            let first = [Vec3::new(u, v, w), Vec3::new(p, q, r)];
            let [u, v, w, p, q, r] = gather(token, self.increment, batch.frame + 1);
            let second = [Vec3::new(u, v, w), Vec3::new(p, q, r)];
            batch.beams.predict::<T>(token, [first, second]);
        }
    }
}

struct Energies<'a, L> {
    spans: &'a Spans<L>,
    at: &'a Situation<'a>,
}

impl<L: Lanes> Work for Energies<'_, L> {
    type Output = [f64; 5];

    /// Twice the kinetic energy, the potential of the weight, and the powers of drag, added mass and
    /// buoyancy.
    ///
    /// Source: docs/theory/fem.md, eqs. (26), (38) and (39).
    #[inline(always)]
    fn run<T: Lane>(self, token: T::Token) -> [f64; 5] {
        let mut sums = [0.0; 5];
        for batch in &self.spans.batches {
            let ends = batch.ends::<T>(token, self.at.state);
            let length = T::read(token, &batch.length);
            let fields = Fields::new(&ends, length);
            let rows = &batch.spread;
            let mass = T::read(token, &rows.mass);
            let weight = T::read(token, &rows.weight);
            let lift = T::read(token, &rows.buoyancy);
            let loads = SeaLoads::<T> {
                rows,
                sea: &self.at.sea,
                token,
            };
            let mut each = [NO_ROW; 5];
            fields.twice_kinetic_energy(mass).write(&mut each[0]);
            // The height, and its rate, that a load of one newton per metre has in each element.
            let [a, b] = &ends;
            let span = b.position - a.position;
            let chord = span.norm_squared().sqrt();
            let along = span * (chord.same(1.0) / chord);
            let (t, u) = (a.rotation.0[0], b.rotation.0[0]);
            let apart = t - u;
            let twelfth = length * length * (1.0 / 12.0);
            let mut across = along * -along.z;
            across.z += chord.same(1.0);
            let across = across * twelfth;
            let half = length * 0.5;
            let height = half * (a.position.z + b.position.z) + across.dot(apart);
            (weight * height).write(&mut each[1]);
            let leant = along.dot(apart);
            let apart_across = apart.minus(leant, along);
            let pulled = (across * leant).plus(twelfth * along.z, apart_across);
            let rise = half * (a.velocity.z + b.velocity.z)
                - pulled.dot(b.velocity - a.velocity) / chord
                - across.cross(t).dot(a.spin)
                - u.cross(across).dot(b.spin);
            let mut buoyancy = lift * rise;
            let mut drag = chord.same(0.0);
            let mut added = chord.same(0.0);
            for point in 0..POINTS.len() {
                let stations = fields.stations(point);
                let water = loads.water(point, &stations);
                let share = water.share * fields.share(point);
                drag += share * water.dragged.dot(stations.velocity);
                added -= share * water.carried.dot(stations.velocity);
                buoyancy += lift * (share - fields.share(point)) * stations.velocity.z;
            }
            drag.write(&mut each[2]);
            added.write(&mut each[3]);
            buoyancy.write(&mut each[4]);
            for (sum, row) in sums.iter_mut().zip(&each) {
                *sum += row[..batch.count].iter().sum::<f64>();
            }
        }
        sums
    }
}
