//! The inertia of sections at nodes, several nodes at a time. It comes first, and writes over what
//! residual and matrix held for its nodes.
//!
//! Source: docs/theory/fem.md, eq. (31).

use catenix_numerics::lanes::{
    Kernel as Work, Lane, MOST_LANES, Mat3, Row, Vec3, block, gather, lane_count, put_records,
    vectorised,
};
use catenix_numerics::{Block6, BlockMatrix, Matrix3, TangentWeights, Vector6};

use super::super::Situation;
use super::Rotary;

/// As many consecutive nodes as are computed at once.
#[derive(Debug, Clone)]
struct Batch {
    /// Frame of the first one.
    frame: usize,
    count: usize,
    /// About local x, y and z (3) [kg m2].
    inertia: [Row; 3],
}

/// The nodes of all lines.
#[derive(Debug, Clone)]
pub(super) struct Turning {
    batches: Vec<Batch>,
    /// What is not in them.
    others: Vec<Rotary>,
    /// Frames of lines that are not in them.
    bare: Vec<usize>,
}

impl Turning {
    /// All of `rotary`; `frames`: those of the lines are the first so many.
    pub(super) fn new(rotary: &[Rotary], frames: usize) -> Turning {
        let plain = |own: &Rotary| own.frame < frames && own.axes == Matrix3::identity();
        let mut at_frame: Vec<Option<&Rotary>> = vec![None; frames];
        let mut others = Vec::new();
        for own in rotary {
            if plain(own) && at_frame[own.frame].is_none() {
                at_frame[own.frame] = Some(own);
            } else {
                others.push(own.clone());
            }
        }
        let bare = (0..frames).filter(|&k| at_frame[k].is_none()).collect();
        let there: Vec<&Rotary> = at_frame.into_iter().flatten().collect();
        let batches = there
            .chunk_by(|a, b| a.frame + 1 == b.frame)
            .flat_map(|run| run.chunks(lane_count()))
            .map(Batch::new)
            .collect();
        Turning {
            batches,
            others,
            bare,
        }
    }

    /// Writes the inertia over residual and, with `weights`, diagonal blocks of the lines' frames;
    /// what bodies carry is added to theirs.
    pub(super) fn put(
        &self,
        at: &Situation<'_>,
        weights: Option<&TangentWeights<'_>>,
        residual: &mut [Vector6],
        matrix: &mut BlockMatrix,
    ) {
        for &k in &self.bare {
            residual[k] = Vector6::zeros();
            matrix.diagonal[k] = Block6::ZERO;
        }
        vectorised(Put {
            turning: self,
            at,
            weights,
            residual,
            matrix,
        });
        for own in &self.others {
            own.add(at, weights, residual, matrix);
        }
    }
}

impl Turning {
    /// Kinetic energy [J].
    pub(super) fn kinetic_energy(&self, at: &Situation<'_>) -> f64 {
        let twice = vectorised(Energy { turning: self, at });
        let others = self.others.iter().map(|own| own.kinetic_energy(at));
        0.5 * twice + others.sum::<f64>()
    }
}

struct Energy<'a> {
    turning: &'a Turning,
    at: &'a Situation<'a>,
}

impl Work for Energy<'_> {
    type Output = f64;

    /// Twice the kinetic energy of the nodes in batches.
    #[inline(always)]
    fn run<T: Lane>(self, token: T::Token) -> f64 {
        let state = self.at.state;
        let mut sum = 0.0;
        for batch in &self.turning.batches {
            let rotation = Mat3::<T>::gather(token, &state.configuration.rotation, batch.frame);
            let [_, _, _, p, q, r] = gather(token, &state.velocity, batch.frame);
            let own = rotation.led_by(Vec3::new(p, q, r));
            let [x, y, z] = &batch.inertia;
            let twice = T::read(token, x) * own.x * own.x
                + T::read(token, y) * own.y * own.y
                + T::read(token, z) * own.z * own.z;
            let mut row = [0.0; MOST_LANES];
            twice.write(&mut row);
            sum += row[..batch.count].iter().sum::<f64>();
        }
        sum
    }
}

impl Batch {
    fn new(nodes: &[&Rotary]) -> Batch {
        let mut batch = Batch {
            frame: nodes[0].frame,
            count: nodes.len(),
            inertia: [[0.0; MOST_LANES]; 3],
        };
        for (lane, node) in nodes.iter().enumerate() {
            for axis in 0..3 {
                batch.inertia[axis][lane] = node.inertia[axis];
            }
        }
        batch
    }
}

struct Put<'a> {
    turning: &'a Turning,
    at: &'a Situation<'a>,
    weights: Option<&'a TangentWeights<'a>>,
    residual: &'a mut [Vector6],
    matrix: &'a mut BlockMatrix,
}

impl Work for Put<'_> {
    type Output = ();

    #[inline(always)]
    fn run<T: Lane>(self, token: T::Token) {
        let state = self.at.state;
        for batch in &self.turning.batches {
            let first = batch.frame;
            let Mat3([x, y, z]) = Mat3::<T>::gather(token, &state.configuration.rotation, first);
            let [_, _, _, p, q, r] = gather(token, &state.velocity, first);
            let [_, _, _, d, e, f] = gather(token, &state.acceleration, first);
            let (spin, turning) = (Vec3::new(p, q, r), Vec3::new(d, e, f));
            let tensor = (x * T::read(token, &batch.inertia[0]))
                .outer(x)
                .plus_outer(y * T::read(token, &batch.inertia[1]), y)
                .plus_outer(z * T::read(token, &batch.inertia[2]), z);
            let momentum = tensor.times(spin);
            let torque = tensor.times(turning);
            let moment = torque + spin.cross(momentum);
            let zero = T::splat(token, 0.0);
            let sums = [zero, zero, zero, moment.x, moment.y, moment.z];
            put_records(&sums, self.residual, first, batch.count);
            let Some(weights) = self.weights else {
                continue;
            };
            // A tensor that turns with its frame changes a product T v by (T [v] - [T v]) theta.
            let by_spin = tensor.crossing(spin).plus_hat(-momentum);
            let by_rotation = tensor.crossing(turning).plus_hat(-torque) + by_spin.crossed_by(spin);
            let by_rates = tensor.crossed_by(spin).plus_hat(-momentum)
                * T::splat(token, weights.velocity)
                + tensor * T::splat(token, weights.acceleration);
            let turned = match weights.rotation {
                None => by_rates,
                Some(rotation) => by_rates.product(Mat3::gather(token, rotation, first)),
            };
            let none = Mat3::zeros(token);
            let values = block([&none, &none, &none, &(by_rotation + turned)]);
            put_records(&values, &mut self.matrix.diagonal, first, batch.count);
        }
    }
}
