//! The connectors between the elements of a line, several at a time: those between straight round
//! linear sections, which are nearly all. The others go one by one ([`super::pairs`]).

use catenix_numerics::lanes::{
    Kernel, Lane, MOST_LANES, Mat3, Row, Vec3, add_records, block, gather, lane_count, put_records,
    vectorised,
};
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
    /// Both frames of each link. The last link fills idle lanes.
    frames: [[usize; MOST_LANES]; 2],
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
            frames: [[0; MOST_LANES]; 2],
            law: [NO_ROW; 5],
            levers: [NO_ROW; 2],
            damped: links.iter().any(|(_, law)| law[4] > 0.0),
            geometry: [NO_ROW; 13],
            predicted: [NO_ROW; 4],
            energy: [NO_ROW; 2],
        };
        for lane in 0..MOST_LANES {
            let (frame, law) = &links[lane.min(links.len() - 1)];
            batch.frames[0][lane] = *frame;
            batch.frames[1][lane] = *frame + 1;
            let rows = batch.law.iter_mut().chain(&mut batch.levers);
            for (row, value) in rows.zip(law) {
                row[lane] = *value;
            }
        }
        batch
    }

    /// Both frames of the links that are there.
    #[inline(always)]
    fn frames(&self) -> [&[usize]; 2] {
        [&self.frames[0][..self.count], &self.frames[1][..self.count]]
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

/// Three numbers from `start` on.
#[inline(always)]
fn three<T: Lane>(numbers: &[T; 6], start: usize) -> Vec3<T> {
    Vec3::new(numbers[start], numbers[start + 1], numbers[start + 2])
}

/// What a connector feels of one of its frames.
struct Side<T> {
    position: Vec3<T>,
    axis: Vec3<T>,
    /// Second axis, which tells the twist.
    direction: Vec3<T>,
    velocity: Vec3<T>,
    spin: Vec3<T>,
}

impl<T: Lane> Side<T> {
    #[inline(always)]
    fn load(token: T::Token, state: &MotionState, frames: &[usize; MOST_LANES]) -> Side<T> {
        let [x, y, z] = gather(token, &state.configuration.position, frames);
        let [a, b, c, d, e, f] = gather(token, &state.configuration.rotation, frames);
        let [u, v, w, p, q, r] = gather(token, &state.velocity, frames);
        Side {
            position: Vec3::new(x, y, z),
            axis: Vec3::new(a, b, c),
            direction: Vec3::new(d, e, f),
            velocity: Vec3::new(u, v, w),
            spin: Vec3::new(p, q, r),
        }
    }
}

/// The factors on the rotations of frames.
#[inline(always)]
fn turns<T: Lane>(
    token: T::Token,
    weights: &TangentWeights<'_>,
    frames: &[usize; MOST_LANES],
) -> Mat3<T> {
    match weights.rotation {
        None => Mat3::diagonal(T::splat(token, 1.0)),
        Some(rotation) => Mat3::gather(token, rotation, frames),
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
            let [first, second] = [
                Side::load(token, self.state, &batch.frames[0]),
                Side::load(token, self.state, &batch.frames[1]),
            ];
            let (law, levers) = (batch.law::<T>(token), batch.levers::<T>(token));
            let axes = [first.axis, second.axis];
            let arms = [axes[0] * levers[0], axes[1] * levers[1]];
            let gap = second.position - first.position + arms[1] - arms[0];
            let pair = PairGeometry::new(axes, gap);
            let twist = pair.twist([first.direction, second.direction]);
            let extension = pair.extension();
            let stretch = (law.axial - law.shear) * extension;
            let elastic = (gap * law.shear).plus(stretch, pair.mean);
            let moment = pair.round_moment(&law, twist);
            let spins = [first.spin, second.spin];
            let gap_velocity = second.velocity - first.velocity + spins[1].cross(arms[1])
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
            let frames = batch.frames();
            let (f, m, n) = (force, first_moment, second_moment);
            let on_first = [-f.x, -f.y, -f.z, m.x, m.y, m.z];
            add_records(&on_first, self.residual, frames[0]);
            let on_second = [f.x, f.y, f.z, n.x, n.y, n.z];
            add_records(&on_second, self.residual, frames[1]);
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
                let own = PairWeights {
                    velocity: T::splat(token, weights.velocity),
                    rotation: [
                        turns(token, weights, &batch.frames[0]),
                        turns(token, weights, &batch.frames[1]),
                    ],
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

/// Adds the blocks on the diagonal, and writes those beside it, which no other connector has.
#[inline(always)]
fn scatter<T: Lane>(batch: &Batch, t: &PairTangents<T>, matrix: &mut BlockMatrix) {
    let frames = batch.frames();
    let [first, second] = &t.moment;
    let (f, [f_first, f_second]) = (&t.force.translation, &t.force.rotation);
    let values = block([f, &-*f_first, &-first.translation, &first.rotation[0]]);
    add_records(&values, &mut matrix.diagonal, frames[0]);
    let values = block([f, f_second, &second.translation, &second.rotation[1]]);
    add_records(&values, &mut matrix.diagonal, frames[1]);
    let minus = -*f;
    let values = block([&minus, &-*f_second, &first.translation, &first.rotation[1]]);
    put_records(&values, &mut matrix.upper, frames[0]);
    let values = block([&minus, f_first, &-second.translation, &second.rotation[0]]);
    put_records(&values, &mut matrix.lower, frames[0]);
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
            let [first, second]: [[T; 6]; 2] = [
                gather(token, self.increment, &batch.frames[0]),
                gather(token, self.increment, &batch.frames[1]),
            ];
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
            let (extension, across) = pair.predicted(
                [a * levers[0], b * levers[1]],
                three(&second, 0) - three(&first, 0),
                [three(&first, 3), three(&second, 3)],
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
