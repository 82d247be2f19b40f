//! The elements of all lines, and the connectors between them, several at a time. Connectors that
//! are not straight, round and linear are few, and go one by one ([`super::pairs`]).

use std::sync::Arc;

use catenix_numerics::lanes::{
    Kernel, Lane, MOST_LANES, Mat3, Row, Vec3, block, gather, lane_count, vectorised,
};
use catenix_numerics::{BlockMatrix, TangentWeights, Vector3, Vector6};

use super::super::Situation;
use super::element::connector::predicted_force;
use super::element::pair_kernel::{PairGeometry, PairLaw, PairRates, PairTangents, PairWeights};
use super::{Carrier, Connector, ConnectorLaw, Link, Place};
use crate::system::frame_kernel::{FrameBatch, FrameLoads, FrameState, add_contacts, turns};

const NO_ROW: Row = [0.0; MOST_LANES];

/// What never changes of the links that begin at the elements of a batch: each leads to the next
/// element.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct LinkLaws {
    /// 1 where an element has one, else 0; all else is 0 there too.
    linked: Row,
    /// Axial, shear, torsional and bending stiffness, and damping time (5).
    law: [Row; 5],
    /// Place of the connection point on the axes of the two frames (2) [m].
    levers: [Row; 2],
    /// Whether any of them is damped.
    damped: bool,
}

/// What changes of the links that begin at the elements of a batch.
#[derive(Debug, Clone)]
struct LinkStates {
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
    /// As many as there are batches of elements; none where no element has a link. Neighbours that
    /// are alike share theirs.
    laws: Vec<Option<Arc<LinkLaws>>>,
    /// As many.
    states: Vec<LinkStates>,
    /// Whether there is a prediction.
    predicts: bool,
}

/// The link that a connector is, and the frame at which it begins, if it is one.
pub(super) fn link_of(connector: &Connector) -> Option<(usize, Link)> {
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
    let levers = mounts.map(|mount| mount.arm.x);
    let law = law.clone();
    plain.then_some((k, Link { law, levers }))
}

impl LinkLaws {
    const NONE: LinkLaws = LinkLaws {
        linked: NO_ROW,
        law: [NO_ROW; 5],
        levers: [NO_ROW; 2],
        damped: false,
    };

    /// Links, in the order of the frames at which they begin, by the batches of `elements` elements.
    pub(super) fn batches<'l>(
        links: impl Iterator<Item = (usize, &'l Link)>,
        elements: usize,
    ) -> Vec<Option<Arc<LinkLaws>>> {
        let mut batches: Vec<Option<Arc<LinkLaws>>> = Vec::new();
        batches.resize(elements.div_ceil(lane_count()), None);
        let mut links = links.peekable();
        let mut before: Option<Arc<LinkLaws>> = None;
        while let Some(&(frame, _)) = links.peek() {
            let index = frame / lane_count();
            let mut laws = LinkLaws::NONE;
            while let Some((frame, link)) = links.next_if(|(k, _)| k / lane_count() == index) {
                laws.put(frame % lane_count(), link);
            }
            let own = match before {
                Some(before) if *before == laws => before,
                _ => Arc::new(laws),
            };
            batches[index] = Some(own.clone());
            before = Some(own);
        }
        batches
    }

    fn put(&mut self, lane: usize, Link { law, levers }: &Link) {
        self.linked[lane] = 1.0;
        self.damped |= law.damping > 0.0;
        let own = [law.axial, law.shear, law.torsion, law.bending, law.damping];
        for (row, value) in self.law.iter_mut().zip(own) {
            row[lane] = value;
        }
        for (row, value) in self.levers.iter_mut().zip(levers) {
            row[lane] = *value;
        }
    }
}

impl Links {
    /// Room for links, by the batches of elements at which they begin.
    pub(super) fn new(laws: &[Option<Arc<LinkLaws>>]) -> Links {
        let state = LinkStates {
            geometry: [NO_ROW; 13],
            predicted: [NO_ROW; 4],
            energy: [NO_ROW; 2],
        };
        Links {
            laws: laws.to_vec(),
            states: vec![state; laws.len()],
            predicts: false,
        }
    }

    pub(super) fn begin(&mut self) {
        self.predicts = false;
    }

    /// Writes inertia and loads of all elements and the forces of the links between them and, with
    /// `weights`, their derivatives: all that is in the elements' part of residual and matrix.
    pub(super) fn put(
        &mut self,
        elements: &[FrameBatch],
        at: &Situation<'_>,
        weights: Option<&TangentWeights<'_>>,
        residual: &mut [Vector6],
        matrix: &mut BlockMatrix,
    ) {
        vectorised(Put {
            links: self,
            elements,
            at,
            weights,
            residual,
            matrix,
        });
    }

    /// Predicts the gaps after an increment of the frames.
    pub(super) fn moving(&mut self, elements: &[FrameBatch], increment: &[Vector6]) {
        vectorised(Moving {
            links: self,
            elements,
            increment,
        });
    }

    /// Elastic energy [J] and power of the damping [W] at the state that was assembled last.
    pub(super) fn energy(&self) -> [f64; 2] {
        let mut sums = [0.0; 2];
        for state in &self.states {
            for (sum, row) in sums.iter_mut().zip(&state.energy) {
                *sum += row.iter().sum::<f64>();
            }
        }
        sums
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

/// Adds, number by number.
#[inline(always)]
fn add<T: Lane, const R: usize>(sums: &mut [T; R], values: &[T; R]) {
    let mut k = 0;
    while k < R {
        sums[k] += values[k];
        k += 1;
    }
}

/// The factors on rotations, where there are weights.
#[inline(always)]
fn turns_if<T: Lane>(
    token: T::Token,
    weights: Option<&TangentWeights<'_>>,
    batch: &FrameBatch,
) -> Mat3<T> {
    match weights {
        Some(weights) => turns(token, weights, batch),
        None => Mat3::zeros(token),
    }
}

struct Put<'a> {
    links: &'a mut Links,
    elements: &'a [FrameBatch],
    at: &'a Situation<'a>,
    weights: Option<&'a TangentWeights<'a>>,
    residual: &'a mut [Vector6],
    matrix: &'a mut BlockMatrix,
}

impl Kernel for Put<'_> {
    type Output = ();

    #[inline(always)]
    fn run<T: Lane>(self, token: T::Token) {
        let Put {
            links,
            elements,
            at,
            weights,
            residual,
            matrix,
        } = self;
        let Some(first) = elements.first() else {
            return;
        };
        let zero = T::splat(token, 0.0);
        // What links leave to the elements that follow: those of this batch and of the one before,
        // which change places from batch to batch.
        let mut forces = [[zero; 6]; 2];
        let mut blocks = [[Mat3::zeros(token); 4]; 2];
        let mut pose = FrameState::load(token, at.state, first);
        let mut turn = turns_if::<T>(token, weights, first);
        let laws = links.laws.iter().zip(&mut links.states);
        for (index, (batch, (laws, state))) in elements.iter().zip(laws).enumerate() {
            let (here, before) = (index % 2, 1 - index % 2);
            let following = elements.get(index + 1).unwrap_or(batch);
            let next = FrameState::load(token, at.state, following);
            let next_turn = turns_if::<T>(token, weights, following);
            let loads = FrameLoads::<T>::new(token, batch, &at.sea, &pose);
            let mut sums = loads.total();
            forces[here] = [zero; 6];
            let mut own = [Mat3::zeros(token); 4];
            if let Some(weights) = weights {
                let [[a, b], [c, d]] = loads.tangent(weights, turn);
                own = [a, b, c, d];
            }
            if let Some(laws) = laws {
                let pair = Pair::new(token, laws, &pose, &next);
                let [on_first, on_second] = pair.forces();
                add(&mut sums, &on_first);
                forces[here] = on_second;
                pair.keep(state);
                if let Some(weights) = weights {
                    let predicted = links.predicts.then_some(&state.predicted);
                    let turns = [turn, turn.one_on(next_turn)];
                    let t = pair.tangents(token, laws.damped, predicted, weights, turns);
                    let ([m, n], f, [f_m, f_n]) =
                        (&t.moment, t.force.translation, t.force.rotation);
                    own[0] = own[0] + f;
                    own[1] = own[1] - f_m;
                    own[2] = own[2] - m.translation;
                    own[3] = own[3] + m.rotation[0];
                    blocks[here] = [f, f_n, n.translation, n.rotation[1]];
                    let upper = block([&-f, &-f_n, &m.translation, &m.rotation[1]]);
                    batch.put(&upper, &mut matrix.upper);
                    let lower = block([&-f, &f_m, &-n.translation, &n.rotation[0]]);
                    batch.put(&lower, &mut matrix.lower);
                }
            } else if weights.is_some() {
                blocks[here] = [Mat3::zeros(token); 4];
                batch.put(&[zero; 36], &mut matrix.upper);
                batch.put(&[zero; 36], &mut matrix.lower);
            }
            let mut k = 0;
            while k < 6 {
                sums[k] += forces[here][k].one_back(forces[before][k]);
                k += 1;
            }
            batch.put(&sums, residual);
            if weights.is_some() {
                let (left, left_before) = (&blocks[here], &blocks[before]);
                let a = own[0] + left[0].one_back(left_before[0]);
                let b = own[1] + left[1].one_back(left_before[1]);
                let c = own[2] + left[2].one_back(left_before[2]);
                let d = own[3] + left[3].one_back(left_before[3]);
                batch.put(&block([&a, &b, &c, &d]), &mut matrix.diagonal);
            }
            add_contacts(at, batch, weights, residual, matrix);
            (pose, turn) = (next, next_turn);
        }
    }
}

/// Of the next element where there is a link, else of the element itself.
#[inline(always)]
fn other<T: Lane>(linked: T::Mask, own: Vec3<T>, following: Vec3<T>) -> Vec3<T> {
    Vec3::select(linked, own.one_on(following), own)
}

/// Links at a state.
pub(super) struct Pair<T> {
    law: PairLaw<T>,
    levers: [T; 2],
    /// From the frames to the connection points, global (3) [m].
    pub(super) arms: [Vec3<T>; 2],
    pub(super) geometry: PairGeometry<T>,
    twist: T,
    rates: PairRates<T>,
    stretch: T,
    /// Elastic force and moment.
    pub(super) elastic: [Vec3<T>; 2],
    /// Force and moment of the damping.
    pub(super) damping: [Vec3<T>; 2],
}

impl<T: Lane> Pair<T> {
    #[inline(always)]
    pub(super) fn new(
        token: T::Token,
        link: &LinkLaws,
        first: &FrameState<T>,
        following: &FrameState<T>,
    ) -> Self {
        let law = PairLaw {
            axial: T::read(token, &link.law[0]),
            shear: T::read(token, &link.law[1]),
            torsion: T::read(token, &link.law[2]),
            bending: T::read(token, &link.law[3]),
            damping: T::read(token, &link.law[4]),
        };
        let levers = [
            T::read(token, &link.levers[0]),
            T::read(token, &link.levers[1]),
        ];
        // An element that has no link is linked with itself, without stiffness.
        let linked = T::splat(token, 0.5).less(T::read(token, &link.linked));
        let [axis, direction, _] = first.rotation.0;
        let [next_axis, next_direction, _] = following.rotation.0;
        let axes = [axis, other(linked, axis, next_axis)];
        let arms = [axes[0] * levers[0], axes[1] * levers[1]];
        let between = other(linked, first.position, following.position) - first.position;
        let geometry = PairGeometry::new(axes, between + arms[1] - arms[0]);
        let twist = geometry.twist([direction, other(linked, direction, next_direction)]);
        let stretch = (law.axial - law.shear) * geometry.extension();
        let elastic = [
            (geometry.gap * law.shear).plus(stretch, geometry.mean),
            geometry.round_moment(&law, twist),
        ];
        let spins = [
            first.motion.spin,
            other(linked, first.motion.spin, following.motion.spin),
        ];
        let gap_velocity = other(linked, first.velocity, following.velocity) - first.velocity
            + spins[1].cross(arms[1])
            - spins[0].cross(arms[0]);
        let rates = geometry.rates(spins, gap_velocity);
        let damping = if link.damped {
            geometry.damping(&law, &rates)
        } else {
            [Vec3::zeros(token); 2]
        };
        Pair {
            law,
            levers,
            arms,
            geometry,
            twist,
            rates,
            stretch,
            elastic,
            damping,
        }
    }

    /// What the residuals of both frames get: force and moment (6) each.
    #[inline(always)]
    fn forces(&self) -> [[T; 6]; 2] {
        let f = self.elastic[0] + self.damping[0];
        let [m, n] = self.geometry.moments(
            self.arms,
            f,
            self.elastic[1] + self.damping[1],
            self.damping[0],
            self.geometry.turning(self.stretch),
        );
        [
            [-f.x, -f.y, -f.z, m.x, m.y, m.z],
            [f.x, f.y, f.z, n.x, n.y, n.z],
        ]
    }

    /// Keeps what energies and the next prediction need.
    #[inline(always)]
    fn keep(&self, link: &mut LinkStates) {
        let [first, second] = self.geometry.axes;
        first.write(&mut link.geometry);
        second.write(&mut link.geometry[3..]);
        self.geometry.gap.write(&mut link.geometry[6..]);
        self.geometry.mean.write(&mut link.geometry[9..]);
        self.geometry.inverse.write(&mut link.geometry[12]);
        let energy = self.geometry.round_energy(&self.law, self.twist);
        energy.write(&mut link.energy[0]);
        let [force, moment] = self.damping;
        let power = -(force.dot(self.rates.gap) + moment.dot(self.rates.bend));
        power.write(&mut link.energy[1]);
    }

    #[inline(always)]
    fn tangents(
        &self,
        token: T::Token,
        damped: bool,
        predicted: Option<&[Row; 4]>,
        weights: &TangentWeights<'_>,
        turns: [Mat3<T>; 2],
    ) -> PairTangents<T> {
        let (law, pair) = (&self.law, &self.geometry);
        let geometric = if let Some(predicted) = predicted {
            let tension = law.axial * T::read(token, &predicted[0]);
            let across = Vec3::read(token, &predicted[1..]);
            predicted_force(pair.mean, tension, law.shear, across)
        } else {
            self.elastic[0]
        };
        let moment_by = pair.round_moment_by_rotations(law, self.twist);
        let mut tangents = pair.elastic_tangent(law, geometric, self.levers, &moment_by);
        if predicted.is_some() {
            tangents.turn_with(pair.moments_by_force(self.arms, geometric - self.elastic[0]));
        }
        if damped && weights.velocity > 0.0 {
            let own = PairWeights {
                velocity: T::splat(token, weights.velocity),
                rotation: turns,
            };
            let by = pair.round_damping_by(law, &self.rates);
            pair.add_damping_tangent(
                law,
                self.arms,
                &self.rates,
                self.damping[0],
                &by,
                &own,
                &mut tangents,
            );
        }
        tangents
    }
}

struct Moving<'a> {
    links: &'a mut Links,
    elements: &'a [FrameBatch],
    increment: &'a [Vector6],
}

impl Kernel for Moving<'_> {
    type Output = ();

    #[inline(always)]
    fn run<T: Lane>(self, token: T::Token) {
        self.links.predicts = true;
        let Some(first) = self.elements.first() else {
            return;
        };
        let mut own: [T; 6] = gather(token, self.increment, first.frames().start);
        let links = self.links.laws.iter().zip(&mut self.links.states);
        for (index, (laws, state)) in links.enumerate() {
            let following = self.elements.get(index + 1).unwrap_or(first);
            let next: [T; 6] = gather(token, self.increment, following.frames().start);
            let Some(laws) = laws else {
                own = next;
                continue;
            };
            let kept = &state.geometry;
            let inverse = T::read(token, &kept[12]);
            let pair = PairGeometry {
                axes: [at::<T>(token, kept, 0), at::<T>(token, kept, 3)],
                gap: at::<T>(token, kept, 6),
                mean: at::<T>(token, kept, 9),
                inverse,
                // Not needed here.
                one_plus_cos: inverse,
            };
            let levers = [
                T::read(token, &laws.levers[0]),
                T::read(token, &laws.levers[1]),
            ];
            let [a, b] = pair.axes;
            let [shift, turn] = [three(&own, 0), three(&own, 3)];
            let [next_shift, next_turn] = [three(&next, 0), three(&next, 3)];
            let (extension, across) = pair.predicted(
                [a * levers[0], b * levers[1]],
                shift.one_on(next_shift) - shift,
                [turn, turn.one_on(next_turn)],
            );
            extension.write(&mut state.predicted[0]);
            across.write(&mut state.predicted[1..]);
            own = next;
        }
    }
}
