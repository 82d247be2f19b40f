//! The connectors between the elements of a line, several at a time: those between straight round
//! linear sections, which are nearly all. The others go one by one ([`super::pairs`]).

use catenix_numerics::lanes::{Kernel, Lane, MOST_LANES, Mat3, Row, Vec3, lane_count, vectorised};
use catenix_numerics::{BlockMatrix, MotionState, TangentWeights, Vector3, Vector6};

use super::super::Situation;
use super::element::connector::predicted_force;
use super::element::pair_kernel::{PairGeometry, PairLaw, PairTangents, PairWeights};
use super::{Carrier, Connector, ConnectorLaw, Place};

const NO_ROW: Row = [0.0; MOST_LANES];

/// As many links as are computed at once.
#[derive(Debug, Clone)]
struct Batch {
    /// Links in it.
    count: usize,
    /// First frame of each link; the second one follows it. The last link fills idle lanes.
    frame: [usize; MOST_LANES],
    /// Axial, shear, torsional and bending stiffness, and damping time (5).
    law: [Row; 5],
    /// Place of the connection point on the axes of the two frames (2) [m].
    levers: [Row; 2],
    /// Whether any of them is damped.
    damped: bool,
    /// What the last assembly leaves: both axes, gap, mean axis, inverse of the sum's length (13).
    geometry: [Row; 13],
    /// Gap along and across the axis that the mixed form predicts (4) [m].
    predicted: [Row; 4],
    /// Elastic energy [J] and power of the damping [W] (2).
    energy: [Row; 2],
}

/// All links of the lines of a model.
#[derive(Debug, Clone)]
pub(super) struct Links {
    batches: Vec<Batch>,
    /// Whether there is a prediction.
    predicts: bool,
}

/// The law and the levers of a connector that is a link: straight, round, linear, between the axes
/// of two neighbours.
fn link_of(connector: &Connector) -> Option<(usize, [f64; 7])> {
    let ConnectorLaw::Beam(law) = &connector.law else {
        return None;
    };
    let (Place::Link(k), None, None) = (connector.place, connector.slide, &law.general) else {
        return None;
    };
    let mounts = [&connector.first, &connector.second];
    let along = |mount: &super::Mount, frame: usize| {
        mount.carrier == Carrier::Free(frame)
            && mount.axes.is_identity(0.0)
            && mount.arm == Vector3::x() * mount.arm.x
    };
    let plain = along(mounts[0], k) && along(mounts[1], k + 1);
    plain.then_some((
        k,
        [
            law.axial,
            law.shear,
            law.torsion,
            law.bending,
            law.damping,
            mounts[0].arm.x,
            mounts[1].arm.x,
        ],
    ))
}

impl Links {
    /// The links among `connectors`, and whether each connector is one.
    pub(super) fn among(connectors: &[Connector]) -> (Links, Vec<bool>) {
        let links: Vec<Option<(usize, [f64; 7])>> = connectors.iter().map(link_of).collect();
        let are = links.iter().map(Option::is_some).collect();
        let links: Vec<(usize, [f64; 7])> = links.into_iter().flatten().collect();
        let batches = links.chunks(lane_count()).map(Batch::new).collect();
        let links = Links {
            batches,
            predicts: false,
        };
        (links, are)
    }

    pub(super) fn begin(&mut self) {
        self.predicts = false;
    }

    /// Adds forces of the links and, with `weights`, their derivatives.
    pub(super) fn assemble(
        &mut self,
        at: &Situation<'_>,
        weights: Option<&TangentWeights<'_>>,
        residual: &mut [Vector6],
        matrix: &mut BlockMatrix,
    ) {
        vectorised(Assembly {
            links: self,
            state: at.state,
            weights,
            residual,
            matrix,
        });
    }

    /// Predicts the gaps after an increment of the frames.
    pub(super) fn moving(&mut self, increment: &[Vector6]) {
        vectorised(Moving {
            links: self,
            increment,
        });
    }

    /// Elastic energy [J] and power of the damping [W] at the state that was assembled last.
    pub(super) fn energy(&self) -> [f64; 2] {
        let mut sums = [0.0; 2];
        for batch in &self.batches {
            for (sum, row) in sums.iter_mut().zip(&batch.energy) {
                *sum += row[..batch.count].iter().sum::<f64>();
            }
        }
        sums
    }
}

impl Batch {
    fn new(links: &[(usize, [f64; 7])]) -> Batch {
        let mut batch = Batch {
            count: links.len(),
            frame: [0; MOST_LANES],
            law: [NO_ROW; 5],
            levers: [NO_ROW; 2],
            damped: links.iter().any(|(_, law)| law[4] > 0.0),
            geometry: [NO_ROW; 13],
            predicted: [NO_ROW; 4],
            energy: [NO_ROW; 2],
        };
        for lane in 0..MOST_LANES {
            let (frame, law) = &links[lane.min(links.len() - 1)];
            batch.frame[lane] = *frame;
            let rows = batch.law.iter_mut().chain(&mut batch.levers);
            for (row, value) in rows.zip(law) {
                row[lane] = *value;
            }
        }
        batch
    }

    #[inline(always)]
    fn law<T: Lane>(&self, token: T::Token) -> PairLaw<T> {
        PairLaw {
            axial: T::read(token, &self.law[0]),
            shear: T::read(token, &self.law[1]),
            torsion: T::read(token, &self.law[2]),
            bending: T::read(token, &self.law[3]),
            damping: T::read(token, &self.law[4]),
        }
    }

    #[inline(always)]
    fn levers<T: Lane>(&self, token: T::Token) -> [T; 2] {
        [
            T::read(token, &self.levers[0]),
            T::read(token, &self.levers[1]),
        ]
    }
}

/// Three rows from `first` on.
#[inline(always)]
fn at<T: Lane>(token: T::Token, rows: &[Row], first: usize) -> Vec3<T> {
    Vec3::read(token, &rows[first..])
}

/// Puts the numbers of one element into its lane.
#[inline(always)]
fn gather(rows: &mut [Row], lane: usize, values: &[f64]) {
    for (row, value) in rows.iter_mut().zip(values) {
        row[lane] = *value;
    }
}

struct Assembly<'a> {
    links: &'a mut Links,
    state: &'a MotionState,
    weights: Option<&'a TangentWeights<'a>>,
    residual: &'a mut [Vector6],
    matrix: &'a mut BlockMatrix,
}

impl Kernel for Assembly<'_> {
    type Output = ();

    #[inline(always)]
    fn run<T: Lane>(self, token: T::Token) {
        let predicts = self.links.predicts;
        for batch in &mut self.links.batches {
            // Position (3), first two columns of the rotation (6), velocity (6), of both frames.
            let mut rows = [[NO_ROW; 15]; 2];
            let configuration = &self.state.configuration;
            for lane in 0..T::COUNT {
                for (side, rows) in rows.iter_mut().enumerate() {
                    let k = batch.frame[lane] + side;
                    let (place, motion) = rows.split_at_mut(9);
                    gather(place, lane, configuration.position[k].as_slice());
                    gather(&mut place[3..], lane, configuration.rotation[k].as_slice());
                    gather(motion, lane, self.state.velocity[k].as_slice());
                }
            }
            let [first, second] = &rows;
            let (law, levers) = (batch.law::<T>(token), batch.levers::<T>(token));
            let axes = [at::<T>(token, first, 3), at::<T>(token, second, 3)];
            let arms = [axes[0] * levers[0], axes[1] * levers[1]];
            let gap = at::<T>(token, second, 0) - at::<T>(token, first, 0) + arms[1] - arms[0];
            let pair = PairGeometry::new(axes, gap);
            let twist = pair.twist([at::<T>(token, first, 6), at::<T>(token, second, 6)]);
            let extension = pair.extension();
            let stretch = (law.axial - law.shear) * extension;
            let elastic = (gap * law.shear).plus(stretch, pair.mean);
            let moment = pair.round_moment(&law, twist);
            let spins = [at::<T>(token, first, 12), at::<T>(token, second, 12)];
            let gap_velocity = at::<T>(token, second, 9) - at::<T>(token, first, 9)
                + spins[1].cross(arms[1])
                - spins[0].cross(arms[0]);
            let rates = pair.rates(spins, gap_velocity);
            let zero = Vec3::zeros(token);
            let [damping_force, damping_moment] = if batch.damped {
                pair.damping(&law, &rates)
            } else {
                [zero, zero]
            };
            let force = elastic + damping_force;
            let [first_moment, second_moment] = pair.moments(
                arms,
                force,
                moment + damping_moment,
                damping_force,
                pair.turning(stretch),
            );
            let mut forces = [NO_ROW; 9];
            force.write(&mut forces);
            first_moment.write(&mut forces[3..]);
            second_moment.write(&mut forces[6..]);
            for (lane, &k) in batch.frame[..batch.count].iter().enumerate() {
                for d in 0..3 {
                    self.residual[k][d] -= forces[d][lane];
                    self.residual[k][d + 3] += forces[d + 3][lane];
                    self.residual[k + 1][d] += forces[d][lane];
                    self.residual[k + 1][d + 3] += forces[d + 6][lane];
                }
            }
            axes[0].write(&mut batch.geometry);
            axes[1].write(&mut batch.geometry[3..]);
            gap.write(&mut batch.geometry[6..]);
            pair.mean.write(&mut batch.geometry[9..]);
            pair.inverse.write(&mut batch.geometry[12]);
            pair.round_energy(&law, twist).write(&mut batch.energy[0]);
            let power = -(damping_force.dot(rates.gap) + damping_moment.dot(rates.bend));
            power.write(&mut batch.energy[1]);

            let Some(weights) = self.weights else {
                continue;
            };
            let geometric = if predicts {
                let tension = law.axial * T::read(token, &batch.predicted[0]);
                let across = Vec3::read(token, &batch.predicted[1..]);
                predicted_force(pair.mean, tension, law.shear, across)
            } else {
                elastic
            };
            let moment_by = pair.round_moment_by_rotations(&law, twist);
            let mut tangents = pair.elastic_tangent(&law, geometric, levers, &moment_by);
            if batch.damped && weights.velocity > 0.0 {
                let mut rows = [[NO_ROW; 9]; 2];
                for lane in 0..T::COUNT {
                    for (side, rows) in rows.iter_mut().enumerate() {
                        let turn = weights.turn(batch.frame[lane] + side);
                        gather(rows, lane, turn.as_slice());
                    }
                }
                let own = PairWeights {
                    velocity: T::splat(token, weights.velocity),
                    rotation: [Mat3::read(token, &rows[0]), Mat3::read(token, &rows[1])],
                };
                let by = pair.round_damping_by(&law, &rates);
                pair.add_damping_tangent(
                    &law,
                    arms,
                    &rates,
                    damping_force,
                    &by,
                    &own,
                    &mut tangents,
                );
            }
            scatter(batch, &tangents, self.matrix);
        }
    }
}

/// Adds the blocks of the links where they belong.
#[inline(always)]
fn scatter<T: Lane>(batch: &Batch, t: &PairTangents<T>, matrix: &mut BlockMatrix) {
    let mut rows = [NO_ROW; 36];
    let [first, second] = &t.moment;
    let f = &t.force;
    write_block(
        &mut rows,
        [
            &f.translation,
            &-f.rotation[0],
            &-first.translation,
            &first.rotation[0],
        ],
    );
    for lane in 0..batch.count {
        add(&mut matrix.diagonal[batch.frame[lane]].0, &rows, lane);
    }
    write_block(
        &mut rows,
        [
            &f.translation,
            &f.rotation[1],
            &second.translation,
            &second.rotation[1],
        ],
    );
    for lane in 0..batch.count {
        add(&mut matrix.diagonal[batch.frame[lane] + 1].0, &rows, lane);
    }
    write_block(
        &mut rows,
        [
            &-f.translation,
            &-f.rotation[1],
            &first.translation,
            &first.rotation[1],
        ],
    );
    for lane in 0..batch.count {
        put(&mut matrix.upper[batch.frame[lane]].0, &rows, lane);
    }
    write_block(
        &mut rows,
        [
            &-f.translation,
            &f.rotation[0],
            &-second.translation,
            &second.rotation[0],
        ],
    );
    for lane in 0..batch.count {
        put(&mut matrix.lower[batch.frame[lane]].0, &rows, lane);
    }
}

/// Four quadrants, by rows, as the 36 entries of a block.
#[inline(always)]
fn write_block<T: Lane>(rows: &mut [Row; 36], quadrants: [&Mat3<T>; 4]) {
    for column in 0..3 {
        quadrants[0].0[column].write(&mut rows[6 * column..]);
        quadrants[2].0[column].write(&mut rows[6 * column + 3..]);
        quadrants[1].0[column].write(&mut rows[6 * column + 18..]);
        quadrants[3].0[column].write(&mut rows[6 * column + 21..]);
    }
}

#[inline(always)]
fn add(block: &mut [f64; 36], rows: &[Row; 36], lane: usize) {
    for (entry, row) in block.iter_mut().zip(rows) {
        *entry += row[lane];
    }
}

#[inline(always)]
fn put(block: &mut [f64; 36], rows: &[Row; 36], lane: usize) {
    for (entry, row) in block.iter_mut().zip(rows) {
        *entry = row[lane];
    }
}

struct Moving<'a> {
    links: &'a mut Links,
    increment: &'a [Vector6],
}

impl Kernel for Moving<'_> {
    type Output = ();

    #[inline(always)]
    fn run<T: Lane>(self, token: T::Token) {
        self.links.predicts = true;
        for batch in &mut self.links.batches {
            let mut rows = [[NO_ROW; 6]; 2];
            for lane in 0..T::COUNT {
                for (side, rows) in rows.iter_mut().enumerate() {
                    gather(
                        rows,
                        lane,
                        self.increment[batch.frame[lane] + side].as_slice(),
                    );
                }
            }
            let kept = &batch.geometry;
            let inverse = T::read(token, &batch.geometry[12]);
            let pair = PairGeometry {
                axes: [at::<T>(token, kept, 0), at::<T>(token, kept, 3)],
                gap: at::<T>(token, kept, 6),
                mean: at::<T>(token, kept, 9),
                inverse,
                // Not needed here.
                one_plus_cos: inverse,
            };
            let levers = batch.levers::<T>(token);
            let [a, b] = pair.axes;
            let [first, second] = &rows;
            let (extension, across) = pair.predicted(
                [a * levers[0], b * levers[1]],
                at::<T>(token, second, 0) - at::<T>(token, first, 0),
                [at::<T>(token, first, 3), at::<T>(token, second, 3)],
            );
            extension.write(&mut batch.predicted[0]);
            across.write(&mut batch.predicted[1..]);
        }
    }
}

#[cfg(test)]
mod tests {
    use catenix_numerics::{Block6, Chain, Matrix3, Topology};

    use super::super::super::Situation;
    use super::super::Mount;
    use super::super::pairs::{EvaluatedPair, scatter};
    use super::*;
    use crate::formulation::dem::element::connector::Prediction;
    use crate::formulation::dem::element::pair::RateWeights;
    use crate::formulation::dem::element::stiffness::ConnectorStiffness;
    use crate::system::tangent_test::moving_system;

    /// A chain through all frames of a system, whatever these are.
    fn chain(frames: usize) -> Vec<Connector> {
        let mount = |k: usize, x: f64| Mount {
            carrier: Carrier::Free(k),
            arm: Vector3::x() * x,
            axes: Matrix3::identity(),
        };
        let link = |k: usize| Connector {
            law: ConnectorLaw::Beam(ConnectorStiffness {
                axial: 3e5 + 1e4 * k as f64,
                shear: 8e5,
                torsion: if k.is_multiple_of(5) { 0.0 } else { 4e4 },
                bending: 6e4 - 1e3 * k as f64,
                shift: 0.0,
                damping: if k < frames / 2 { 0.04 } else { 0.0 },
                general: None,
            }),
            first: mount(k, 0.6 + 0.01 * k as f64),
            second: mount(k + 1, -0.5),
            place: Place::Link(k),
            slide: None,
        };
        (0..frames - 1).map(link).collect()
    }

    /// Residual, matrix and energies of links one by one, with predictions after an increment.
    fn one_by_one(
        connectors: &[Connector],
        topology: &Topology,
        at: &Situation<'_>,
        weights: &TangentWeights<'_>,
        increment: Option<&[Vector6]>,
    ) -> (Vec<Vector6>, BlockMatrix, [f64; 2]) {
        let mut residual = vec![Vector6::zeros(); topology.frame_count()];
        let mut matrix = BlockMatrix::zeros(topology);
        let mut energy = [0.0; 2];
        for (k, connector) in connectors.iter().enumerate() {
            let mut pair = EvaluatedPair::new(connector, at);
            let forces = pair.forces();
            residual[k] += forces.first;
            residual[k + 1] += forces.second;
            energy[0] += pair.energy(&connector.law);
            energy[1] += pair.damping_power();
            let rates = RateWeights {
                velocity: weights.velocity,
                rotation: [weights.turn(k), weights.turn(k + 1)],
            };
            let predicted: Option<Prediction> =
                increment.map(|increment| pair.predicted(connector, increment));
            let tangent = pair.tangent(&connector.law, predicted.as_ref(), &rates);
            scatter(topology, connector, &tangent, &mut matrix);
        }
        (residual, matrix, energy)
    }

    #[test]
    fn lanes_compute_what_single_connectors_do() {
        moving_system(|at, weights| {
            let frames = at.system.frame_count();
            let connectors = chain(frames);
            let whole = Chain {
                first: 0,
                len: frames,
                head: None,
                tail: None,
            };
            let topology = Topology::new(vec![whole], frames);
            let (mut links, are) = Links::among(&connectors);
            assert!(are.iter().all(|&is| is));
            let increment: Vec<Vector6> = (0..frames)
                .map(|k| Vector6::from_fn(|row, _| 0.02 * ((7 * k + row) as f64).sin()))
                .collect();
            for increment in [None, Some(increment.as_slice())] {
                if let Some(increment) = increment {
                    links.moving(increment);
                }
                let mut residual = vec![Vector6::zeros(); frames];
                let mut matrix = BlockMatrix::zeros(&topology);
                links.assemble(at, Some(weights), &mut residual, &mut matrix);
                let (want, want_matrix, energy) =
                    one_by_one(&connectors, &topology, at, weights, increment);
                // Roundings, of the largest numbers of each block: the frames are far apart and far
                // turned, so that terms of different size cancel.
                for (got, want) in residual.iter().zip(&want) {
                    assert!((got - want).norm() <= 1e-12 * want.norm());
                }
                let same = |got: &[Block6], want: &[Block6]| {
                    for (got, want) in got.iter().zip(want) {
                        let size = want.0.iter().fold(0.0f64, |size, x| size.max(x.abs()));
                        let near = |(a, b): (&f64, &f64)| (a - b).abs() <= 1e-12 * size;
                        assert!(got.0.iter().zip(&want.0).all(near));
                    }
                };
                same(&matrix.diagonal, &want_matrix.diagonal);
                same(&matrix.upper, &want_matrix.upper);
                same(&matrix.lower, &want_matrix.lower);
                for (got, want) in links.energy().iter().zip(&energy) {
                    assert!((got - want).abs() <= 1e-12 * want.abs());
                }
            }
        });
    }
}
