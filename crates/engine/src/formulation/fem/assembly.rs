//! From elements and joints to the residual and the matrix of the system.

use catenix_numerics::so3::hat;
use catenix_numerics::{Block6, BlockMatrix, Matrix3, TangentWeights, Topology, Vector3, Vector6};

use super::super::Situation;
use super::element::ends::{Blocks, ElementForces, ElementTangent, End};
use super::element::field::{Carried, ElementBlocks, FieldWeights};
use super::element::joint::Support;
use super::{EndJoint, Part, Place, Rotary, Seat};
use crate::system::frames::frame_motion;
use crate::system::{Carrier, Mount};

/// Motion of a frame or vessel, as that of an end at its origin.
fn origin(at: &Situation<'_>, carrier: Carrier) -> End {
    match carrier {
        Carrier::Free(k) => {
            let m = frame_motion(at.state, k);
            End {
                position: m.position,
                rotation: m.rotation,
                velocity: m.velocity,
                spin: m.spin,
                acceleration: m.acceleration,
                angular_acceleration: m.angular_acceleration,
            }
        }
        Carrier::Vessel(k) => {
            let m = &at.vessels[k];
            End {
                position: m.position,
                rotation: m.rotation,
                velocity: m.velocity,
                spin: m.spin,
                acceleration: m.acceleration,
                angular_acceleration: m.angular_acceleration,
            }
        }
    }
}

/// An end on a mount.
fn mounted(at: &Situation<'_>, mount: &Mount) -> Carried {
    let from = origin(at, mount.carrier);
    let lever = from.rotation * mount.arm;
    let end = End {
        position: from.position + lever,
        rotation: from.rotation * mount.axes,
        velocity: from.velocity + from.spin.cross(&lever),
        acceleration: from.acceleration
            + from.angular_acceleration.cross(&lever)
            + from.spin.cross(&from.spin.cross(&lever)),
        ..from
    };
    Carried { end, lever }
}

impl Seat {
    /// Where the end is, and what carries it.
    #[inline]
    pub(super) fn carried(&self, at: &Situation<'_>) -> Carried {
        match self {
            Seat::Node(frame) => Carried {
                end: origin(at, Carrier::Free(*frame)),
                lever: Vector3::zeros(),
            },
            Seat::Carried(mount) => mounted(at, mount),
            Seat::Hinged(frame, mount) => {
                let held = mounted(at, mount).end;
                let own = origin(at, Carrier::Free(*frame));
                Carried {
                    end: End {
                        position: held.position,
                        velocity: held.velocity,
                        acceleration: held.acceleration,
                        ..own
                    },
                    lever: Vector3::zeros(),
                }
            }
        }
    }

    /// Translation and rotation of the end for increments of the frames.
    pub(super) fn moved(&self, lever: &Vector3, increment: &[Vector6]) -> (Vector3, Vector3) {
        let Some(frame) = self.frame() else {
            return (Vector3::zeros(), Vector3::zeros());
        };
        let turn: Vector3 = increment[frame].fixed_rows::<3>(3).into();
        let shift = match self {
            Seat::Hinged(..) => Vector3::zeros(),
            _ => increment[frame].fixed_rows::<3>(0) + turn.cross(lever),
        };
        (shift, turn)
    }
}

impl Part {
    /// Both ends.
    #[inline]
    pub(super) fn carried(&self, at: &Situation<'_>) -> [Carried; 2] {
        [self.seats[0].carried(at), self.seats[1].carried(at)]
    }

    /// How velocities and accelerations of the two ends follow increments.
    #[inline]
    pub(super) fn weights(&self, weights: &TangentWeights<'_>) -> FieldWeights {
        let turn = |seat: &Seat| {
            seat.frame()
                .map_or_else(Matrix3::identity, |frame| weights.turn(frame))
        };
        FieldWeights {
            velocity: weights.velocity,
            acceleration: weights.acceleration,
            rotation: [turn(&self.seats[0]), turn(&self.seats[1])],
        }
    }

    /// Adds the element to the system.
    pub(super) fn scatter(
        &self,
        topology: &Topology,
        element: &ElementBlocks,
        residual: &mut [Vector6],
        matrix: Option<&mut BlockMatrix>,
    ) {
        for (seat, force) in self.seats.iter().zip(&element.force) {
            match seat {
                Seat::Hinged(frame, _) => {
                    let mut moment = residual[*frame].fixed_rows_mut::<3>(3);
                    moment += force.fixed_rows::<3>(3);
                }
                _ => {
                    if let Some(frame) = seat.frame() {
                        residual[frame] += force;
                    }
                }
            }
        }
        if let Some(matrix) = matrix {
            self.scatter_blocks(topology, &element.block, matrix);
        }
    }

    /// Adds blocks of the element to a matrix.
    pub(super) fn scatter_blocks(
        &self,
        topology: &Topology,
        blocks: &[[Block6; 2]; 2],
        matrix: &mut BlockMatrix,
    ) {
        let hinged = self.seats.each_ref().map(|s| matches!(s, Seat::Hinged(..)));
        let add = |to: &mut Block6, row: usize, column: usize| {
            let block = &blocks[row][column];
            if hinged[row] || hinged[column] {
                let (first_row, first_column) = (
                    3 * usize::from(hinged[row]),
                    3 * usize::from(hinged[column]),
                );
                for c in first_column..6 {
                    for r in first_row..6 {
                        to.0[r + 6 * c] += block.0[r + 6 * c];
                    }
                }
                return;
            }
            for (sum, value) in to.0.iter_mut().zip(&block.0) {
                *sum += value;
            }
        };
        for (k, seat) in self.seats.iter().enumerate() {
            if let Some(frame) = seat.frame() {
                add(&mut matrix.diagonal[frame], k, k);
            }
        }
        match self.place {
            Place::Link(k) => {
                add(&mut matrix.upper[k], 0, 1);
                add(&mut matrix.lower[k], 1, 0);
            }
            Place::Head(chain) if topology.chains()[chain].head.is_some() => {
                let [out, back] = &mut matrix.head[chain];
                add(out, 1, 0);
                add(back, 0, 1);
            }
            Place::Tail(chain) if topology.chains()[chain].tail.is_some() => {
                let [out, back] = &mut matrix.tail[chain];
                add(out, 0, 1);
                add(back, 1, 0);
            }
            _ => {}
        }
    }
}

/// Adds internal forces, and with `tangent` their derivatives, to those of an element.
///
/// Source: docs/theory/fem.md, eqs. (28) and (29): a lever turns with its frame.
pub(super) fn add_internal(
    forces: &ElementForces,
    tangent: Option<(&ElementTangent, &FieldWeights)>,
    carried: &[Carried; 2],
    out: &mut ElementBlocks,
) {
    for (k, sign) in [(0, -1.0), (1, 1.0)] {
        let force = forces.force * sign;
        let moment = forces.moment[k] + carried[k].lever.cross(&force);
        let mut sum = out.force[k].fixed_rows_mut::<3>(0);
        sum += force;
        let mut sum = out.force[k].fixed_rows_mut::<3>(3);
        sum += moment;
    }
    let Some((tangent, weights)) = tangent else {
        return;
    };
    let own: Blocks;
    let blocks = match &tangent.rates {
        None if carried.iter().all(|c| c.lever == Vector3::zeros()) => &tangent.configuration,
        _ => {
            own = by_frames(tangent, weights, carried);
            &own
        }
    };
    let levers = carried.each_ref().map(|c| hat(&c.lever));
    let levered = carried.each_ref().map(|c| c.lever != Vector3::zeros());
    let force_hat = hat(&forces.force);
    for (column, sign) in [(0, -1.0), (1, 1.0)] {
        for (row, other) in [(0, -1.0), (1, 1.0)] {
            let block = &mut out.block[row][column];
            let by_shift = blocks[0][0] * (sign * other);
            let by_turn = blocks[0][column + 1] * other;
            let mut moment_by_shift = blocks[row + 1][0] * sign;
            let mut moment_by_turn = blocks[row + 1][column + 1];
            if levered[row] {
                moment_by_shift += levers[row] * by_shift;
                moment_by_turn += levers[row] * by_turn;
                if row == column {
                    moment_by_turn += force_hat * levers[row] * other;
                }
            }
            block.add_quadrant(0, 0, &by_shift);
            block.add_quadrant(0, 1, &by_turn);
            block.add_quadrant(1, 0, &moment_by_shift);
            block.add_quadrant(1, 1, &moment_by_turn);
        }
    }
}

/// Derivatives by distance and spins of the ends as those by the carrying frames, with the rates.
fn by_frames(tangent: &ElementTangent, weights: &FieldWeights, carried: &[Carried; 2]) -> Blocks {
    let mut blocks = tangent.configuration;
    for (row, own) in blocks.iter_mut().enumerate() {
        let by_span = own[0];
        for (k, sign) in [(0, -1.0), (1, 1.0)] {
            let lever = hat(&carried[k].lever);
            own[k + 1] -= by_span * lever * sign;
            if let Some(rates) = &tangent.rates {
                let turn = weights.rotation[k] * weights.velocity;
                let lever_rate = -(lever * turn) - hat(&carried[k].end.spin) * lever;
                own[k + 1] += rates[row][k + 1] * turn + rates[row][0] * lever_rate * sign;
            }
        }
        if let Some(rates) = &tangent.rates {
            own[0] += rates[row][0] * weights.velocity;
        }
    }
    blocks
}

impl EndJoint {
    /// The support's side.
    pub(super) fn side(&self, at: &Situation<'_>) -> Support {
        let carried = mounted(at, &self.support);
        Support {
            point: carried.end.position,
            lever: carried.lever,
            rotation: carried.end.rotation,
        }
    }

    /// Adds the joint to the system.
    pub(super) fn scatter(
        &self,
        topology: &Topology,
        forces: &[Vector6; 2],
        blocks: Option<&[[Block6; 2]; 2]>,
        residual: &mut [Vector6],
        matrix: &mut BlockMatrix,
    ) {
        residual[self.node] += forces[1];
        let body = match self.support.carrier {
            Carrier::Free(body) => Some(body),
            Carrier::Vessel(_) => None,
        };
        if let Some(body) = body {
            residual[body] += forces[0];
        }
        let Some(blocks) = blocks else { return };
        let add = |to: &mut Block6, block: &Block6| *to = to.plus(1.0, block);
        add(&mut matrix.diagonal[self.node], &blocks[1][1]);
        if let Some(body) = body {
            add(&mut matrix.diagonal[body], &blocks[0][0]);
        }
        let pair = match self.place {
            Place::Head(chain) if topology.chains()[chain].head.is_some() => {
                Some(&mut matrix.head[chain])
            }
            Place::Tail(chain) if topology.chains()[chain].tail.is_some() => {
                Some(&mut matrix.tail[chain])
            }
            _ => None,
        };
        if let Some([out, back]) = pair {
            add(out, &blocks[1][0]);
            add(back, &blocks[0][1]);
        }
    }
}

impl Rotary {
    /// Inertia tensor in global axes [kg m2].
    pub(super) fn tensor(&self, rotation: &Matrix3) -> Matrix3 {
        let axes = rotation * self.axes;
        axes * Matrix3::from_diagonal(&self.inertia) * axes.transpose()
    }

    /// Kinetic energy [J].
    pub(super) fn kinetic_energy(&self, at: &Situation<'_>) -> f64 {
        let m = frame_motion(at.state, self.frame);
        0.5 * m.spin.dot(&(self.tensor(&m.rotation) * m.spin))
    }

    /// Adds the inertia of sections to a node.
    ///
    /// Source: docs/theory/fem.md, eq. (31).
    pub(super) fn add(
        &self,
        at: &Situation<'_>,
        weights: Option<&TangentWeights<'_>>,
        residual: &mut [Vector6],
        matrix: &mut BlockMatrix,
    ) {
        let m = frame_motion(at.state, self.frame);
        let (spin, turning) = (&m.spin, &m.angular_acceleration);
        let tensor = self.tensor(&m.rotation);
        let momentum = tensor * spin;
        let mut sum = residual[self.frame].fixed_rows_mut::<3>(3);
        sum += tensor * turning + spin.cross(&momentum);
        let Some(weights) = weights else { return };
        // A tensor that turns with its frame changes a product T x by (T [x] - [T x]) theta.
        let turned = |v: &Vector3| tensor * hat(v) - hat(&(tensor * v));
        let by_rotation = turned(turning) + hat(spin) * turned(spin);
        let by_spin = hat(spin) * tensor - hat(&momentum);
        let by_rates = by_spin * weights.velocity + tensor * weights.acceleration;
        let block = &mut matrix.diagonal[self.frame];
        block.add_quadrant(1, 1, &(by_rotation + by_rates * weights.turn(self.frame)));
    }
}
