//! Loads and inertia of rigid frames, several at a time.
//!
//! What depends on a frame's height by cases (how much of it is under water, the current there, the
//! seabed) is found frame by frame; the rest is computed in lanes.

use std::borrow::Borrow;
use std::ops::Range;
use std::sync::Arc;

use catenix_numerics::lanes::{
    Kernel, Lane, MOST_LANES, Mat3, Record, Row, Vec3, block, gather, lane_count, put_records,
    vectorised,
};
use catenix_numerics::{BlockMatrix, MotionState, TangentWeights, Vector3, Vector6};

use super::Frame;
use super::frames::{FrameMotion, LoadPowers, Sea, frame_motion, touch};
use super::surroundings::Surroundings;
use crate::body::inertia::{BodyMotion, Tensors, inertia_force, inertia_tangent};
use crate::formulation::Situation;
use crate::hydro::morison::{StripDrag, Wrench};

pub(super) const NO_ROW: Row = [0.0; MOST_LANES];

/// As many consecutive frames as are computed at once, and what never changes of them.
#[derive(Debug, Clone)]
pub(crate) struct FrameBatch {
    /// The first of them.
    first: usize,
    /// How many there are; the properties of the last one fill idle lanes.
    count: usize,
    /// Neighbours that are alike share them.
    rows: Arc<FrameRows>,
}

/// What never changes of the frames of a batch.
#[derive(Debug, Clone, PartialEq)]
struct FrameRows {
    /// Mass, weight, buoyancy, added mass across and along, added inertia (6).
    plain: [Row; 6],
    /// Drag coefficients (3).
    drag: [Row; 3],
    /// Principal moments of inertia, own axis, arm of the buoyancy (9).
    vectors: [Row; 9],
    /// Length and diameter (2) [m].
    size: [Row; 2],
}

impl FrameBatch {
    /// The frames of a range in batches.
    pub(crate) fn all<F: Borrow<Frame>>(frames: &[F], range: Range<usize>) -> Vec<FrameBatch> {
        let mut batches: Vec<FrameBatch> = Vec::with_capacity(range.len().div_ceil(lane_count()));
        for first in range.clone().step_by(lane_count()) {
            let count = lane_count().min(range.end - first);
            let rows = FrameRows::new(&frames[first..first + count]);
            let rows = match batches.last() {
                Some(before) if *before.rows == rows => before.rows.clone(),
                _ => Arc::new(rows),
            };
            batches.push(FrameBatch { first, count, rows });
        }
        batches
    }

    /// The frames in it.
    #[inline(always)]
    pub(crate) fn frames(&self) -> Range<usize> {
        self.first..self.first + self.count
    }

    /// Writes what the lanes hold over the numbers of the frames in it.
    #[inline(always)]
    pub(crate) fn put<T: Lane, I: Record, const R: usize>(&self, values: &[T; R], to: &mut [I]) {
        put_records(values, to, self.first, self.count);
    }
}

impl FrameRows {
    fn new<F: Borrow<Frame>>(frames: &[F]) -> FrameRows {
        let mut rows = FrameRows {
            plain: [NO_ROW; 6],
            drag: [NO_ROW; 3],
            vectors: [NO_ROW; 9],
            size: [NO_ROW; 2],
        };
        for lane in 0..MOST_LANES {
            let frame: &Frame = frames[lane.min(frames.len() - 1)].borrow();
            let plain = [
                frame.mass,
                frame.weight,
                frame.buoyancy,
                frame.added_normal,
                frame.added_axial,
                frame.added_inertia,
            ];
            fill(&mut rows.plain, lane, &plain);
            let drag = [frame.drag.normal, frame.drag.axial, frame.drag.radius];
            fill(&mut rows.drag, lane, &drag);
            fill(&mut rows.vectors, lane, frame.inertia.as_slice());
            fill(&mut rows.vectors[3..], lane, frame.axis.as_slice());
            fill(&mut rows.vectors[6..], lane, frame.buoyancy_arm.as_slice());
            fill(&mut rows.size, lane, &[frame.length, frame.diameter]);
        }
        rows
    }
}

/// Puts numbers into a lane.
#[inline(always)]
pub(super) fn fill(rows: &mut [Row], lane: usize, values: &[f64]) {
    for (row, value) in rows.iter_mut().zip(values) {
        row[lane] = *value;
    }
}

/// Writes inertia minus loads of rigid frames over their residuals and, with `weights`, their
/// derivatives over their diagonal blocks.
pub(crate) fn put_frames(
    at: &Situation<'_>,
    batches: &[FrameBatch],
    weights: Option<&TangentWeights<'_>>,
    residual: &mut [Vector6],
    matrix: &mut BlockMatrix,
) {
    vectorised(Frames {
        at,
        batches,
        weights,
        residual,
        matrix,
    });
}

struct Frames<'a> {
    at: &'a Situation<'a>,
    batches: &'a [FrameBatch],
    weights: Option<&'a TangentWeights<'a>>,
    residual: &'a mut [Vector6],
    matrix: &'a mut BlockMatrix,
}

/// Kinetic and potential energy of rigid frames [J], and the powers of their loads.
pub(crate) fn frame_energies(at: &Situation<'_>, batches: &[FrameBatch]) -> (f64, f64, LoadPowers) {
    let [twice_kinetic, drag, added_mass, buoyancy] = vectorised(Energies { at, batches });
    let mut potential = 0.0;
    let mut powers = LoadPowers {
        drag,
        added_mass,
        buoyancy,
        seabed_damping: 0.0,
    };
    for k in batches.iter().flat_map(FrameBatch::frames) {
        let frame = &at.system.frames[k];
        let m = frame_motion(at.state, k);
        potential += frame.weight * m.position.z;
        let Some(contact) = touch(&at.sea, frame, &m) else {
            continue;
        };
        let still = FrameMotion {
            velocity: Vector3::zeros(),
            ..m
        };
        let spring = touch(&at.sea, frame, &still);
        let spring = spring.map_or_else(Vector3::zeros, |contact| contact.force);
        potential += contact.energy;
        powers.seabed_damping += (contact.force - spring).dot(&m.velocity);
    }
    (0.5 * twice_kinetic, potential, powers)
}

struct Energies<'a> {
    at: &'a Situation<'a>,
    batches: &'a [FrameBatch],
}

impl Kernel for Energies<'_> {
    type Output = [f64; 4];

    /// Twice the kinetic energy, and the powers of drag, added mass and buoyancy.
    #[inline(always)]
    fn run<T: Lane>(self, token: T::Token) -> [f64; 4] {
        let mut sums = [0.0; 4];
        for batch in self.batches {
            let pose = FrameState::load(token, self.at.state, batch);
            let loads = FrameLoads::<T>::new(token, batch, &self.at.sea, &pose);
            let mut each = [NO_ROW; 4];
            let velocity = pose.velocity;
            let mass: T = T::read(token, &batch.rows.plain[0]);
            let (share, motion) = (loads.share, &loads.motion);
            let turning = loads.tensors.inertia.times(motion.spin)
                - loads.added.inertia.times(motion.spin) * share;
            let kinetic: T = mass * velocity.norm_squared() + motion.spin.dot(turning);
            kinetic.write(&mut each[0]);
            let Wrench { force, moment } = loads.drag_load;
            (share * (force.dot(velocity) + moment.dot(motion.spin))).write(&mut each[1]);
            let carried = velocity.dot(loads.added.mass.times(motion.acceleration))
                + motion
                    .spin
                    .dot(loads.added.inertia.times(motion.angular_acceleration));
            (-(share * carried)).write(&mut each[2]);
            let rise = velocity.z + motion.spin.cross(loads.arm).z;
            (loads.buoyancy * share * rise).write(&mut each[3]);
            for (sum, row) in sums.iter_mut().zip(&each) {
                for value in &row[..batch.count] {
                    *sum += value;
                }
            }
        }
        sums
    }
}

/// Positions, rotations and motions of the frames of a batch.
#[derive(Clone, Copy)]
pub(crate) struct FrameState<T> {
    pub position: Vec3<T>,
    pub rotation: Mat3<T>,
    pub velocity: Vec3<T>,
    pub motion: BodyMotion<T>,
}

impl<T: Lane> FrameState<T> {
    #[inline(always)]
    pub(crate) fn load(token: T::Token, state: &MotionState, batch: &FrameBatch) -> Self {
        let first = batch.first;
        let [x, y, z] = gather(token, &state.configuration.position, first);
        let [u, v, w, p, q, r] = gather(token, &state.velocity, first);
        let [a, b, c, d, e, f] = gather(token, &state.acceleration, first);
        FrameState {
            position: Vec3::new(x, y, z),
            rotation: Mat3::gather(token, &state.configuration.rotation, first),
            velocity: Vec3::new(u, v, w),
            motion: BodyMotion {
                spin: Vec3::new(p, q, r),
                acceleration: Vec3::new(a, b, c),
                angular_acceleration: Vec3::new(d, e, f),
            },
        }
    }
}

/// The factors on the rotations of the frames of a batch.
#[inline(always)]
pub(crate) fn turns<T: Lane>(
    token: T::Token,
    weights: &TangentWeights<'_>,
    batch: &FrameBatch,
) -> Mat3<T> {
    match weights.rotation {
        None => Mat3::diagonal(T::splat(token, 1.0)),
        Some(rotation) => Mat3::gather(token, rotation, batch.first),
    }
}

impl Kernel for Frames<'_> {
    type Output = ();

    #[inline(always)]
    fn run<T: Lane>(self, token: T::Token) {
        let Frames {
            at,
            batches,
            weights,
            residual,
            matrix,
        } = self;
        for batch in batches {
            let pose = FrameState::load(token, at.state, batch);
            let loads = FrameLoads::<T>::new(token, batch, &at.sea, &pose);
            batch.put(&loads.total(), residual);
            if let Some(weights) = weights {
                let [[a, b], [c, d]] = &loads.tangent(weights, turns(token, weights, batch));
                batch.put(&block([a, b, c, d]), &mut matrix.diagonal);
            }
            add_contacts(at, batch, weights, residual, matrix);
        }
    }
}

/// Adds the forces of the seabed on the frames that touch it.
#[inline(always)]
pub(crate) fn add_contacts(
    at: &Situation<'_>,
    batch: &FrameBatch,
    weights: Option<&TangentWeights<'_>>,
    residual: &mut [Vector6],
    matrix: &mut BlockMatrix,
) {
    if at.sea.seabed.is_some() {
        for k in batch.frames() {
            add_contact(at, k, weights, residual, matrix);
        }
    }
}

/// Adds the force of the seabed on a frame that touches it.
fn add_contact(
    at: &Situation<'_>,
    k: usize,
    weights: Option<&TangentWeights<'_>>,
    residual: &mut [Vector6],
    matrix: &mut BlockMatrix,
) {
    let frame = &at.system.frames[k];
    let Some(contact) = touch(&at.sea, frame, &frame_motion(at.state, k)) else {
        return;
    };
    let mut force = residual[k].fixed_rows_mut::<3>(0);
    force -= contact.force;
    if let Some(weights) = weights {
        let block = &mut matrix.diagonal[k];
        let by_height = contact.by_height * Vector3::z().transpose();
        block.add_quadrant(0, 0, &-by_height);
        block.add_quadrant(0, 0, &(contact.by_velocity * -weights.velocity));
    }
}

/// Inertia and loads of frames, in lanes.
pub(crate) struct FrameLoads<T> {
    axis: Vec3<T>,
    /// Share under water.
    share: T,
    drag: StripDrag<T>,
    /// Force and moment of the drag, fully under water.
    drag_load: Wrench<Vec3<T>>,
    tensors: Tensors<T>,
    /// What is added to the tensors fully under water.
    added: Tensors<T>,
    motion: BodyMotion<T>,
    current_slope: Vec3<T>,
    weight: T,
    /// Fully under water.
    buoyancy: T,
    arm: Vec3<T>,
    /// Derivatives of the share by height and by the slope of the axis.
    by_height: T,
    by_slope: T,
    /// Whether one of the frames passes through the surface.
    at_surface: bool,
}

impl<T: Lane> FrameLoads<T> {
    #[inline(always)]
    pub(crate) fn new(
        token: T::Token,
        batch: &FrameBatch,
        sea: &Sea<'_>,
        pose: &FrameState<T>,
    ) -> Self {
        let rows = &*batch.rows;
        let rotation = pose.rotation;
        let axis = rotation.times(Vec3::read(token, &rows.vectors[3..]));
        let Surroundings {
            water,
            wet: [share, by_height, by_slope],
            at_surface,
        } = Surroundings::new(token, &rows.size, sea, pose.position.z, axis.z);
        let spin = pose.motion.spin;
        let relative = water[0] - pose.velocity;
        let coefficients = [
            T::read(token, &rows.drag[0]),
            T::read(token, &rows.drag[1]),
            T::read(token, &rows.drag[2]),
        ];
        let drag = StripDrag::new(coefficients, axis, relative, spin);
        let added_normal = T::read(token, &rows.plain[3]);
        let beyond = T::read(token, &rows.plain[4]) - added_normal;
        let added_inertia = T::read(token, &rows.plain[5]);
        // Source: docs/theory/hydrodynamics.md, eq. (7).
        let added = Tensors {
            mass: (axis * beyond).outer(axis).plus_diagonal(added_normal),
            inertia: (axis * -added_inertia)
                .outer(axis)
                .plus_diagonal(added_inertia),
        };
        // The second moment in all directions, and what the others have beyond it.
        let [x, _, z] = rotation.0;
        let second: T = T::read(token, &rows.vectors[1]);
        let first = T::read(token, &rows.vectors[0]) - second;
        let third = T::read(token, &rows.vectors[2]) - second;
        let structure = (x * first)
            .outer(x)
            .plus_outer(z * third, z)
            .plus_diagonal(second);
        FrameLoads {
            axis,
            share,
            drag,
            drag_load: drag.load(),
            tensors: Tensors {
                mass: (added.mass * share).plus_diagonal(T::read(token, &rows.plain[0])),
                inertia: structure.plus(share, added.inertia),
            },
            added,
            motion: pose.motion,
            current_slope: water[1],
            weight: T::read(token, &rows.plain[1]),
            buoyancy: T::read(token, &rows.plain[2]),
            arm: rotation.times(Vec3::read(token, &rows.vectors[6..])),
            by_height,
            by_slope,
            at_surface,
        }
    }

    /// Inertia minus loads: force and moment (6).
    #[inline(always)]
    pub(crate) fn total(&self) -> [T; 6] {
        let [force, moment] = inertia_force(&self.tensors, &self.motion);
        let buoyancy = self.buoyancy * self.share;
        let mut force = force.minus(self.share, self.drag_load.force);
        force.z += self.weight - buoyancy;
        let mut moment = moment.minus(self.share, self.drag_load.moment);
        // Arm x buoyancy.
        moment.x -= self.arm.y * buoyancy;
        moment.y += self.arm.x * buoyancy;
        [force.x, force.y, force.z, moment.x, moment.y, moment.z]
    }

    /// Derivatives of [`Self::total`] by translation and rotation.
    #[inline(always)]
    pub(crate) fn tangent(&self, weights: &TangentWeights<'_>, turn: Mat3<T>) -> [[Mat3<T>; 2]; 2] {
        let velocity = self.share.same(weights.velocity);
        let acceleration = self.share.same(weights.acceleration);
        let drag = self.drag.derivatives(&self.drag_load);
        let inertia = inertia_tangent(&self.tensors, &self.motion);
        let by_velocity = self.share * velocity;
        let mut force_translation =
            (self.tensors.mass * acceleration).plus(by_velocity, drag.velocity.force);
        let mut moment_translation = drag.velocity.moment * by_velocity;
        // The current changes with height.
        let slope = self.current_slope * self.share;
        force_translation.0[2] -= drag.velocity.force.times(slope);
        moment_translation.0[2] -= drag.velocity.moment.times(slope);
        let force_spin = drag.spin.force * -by_velocity;
        let moment_spin = (self.tensors.inertia * acceleration)
            .plus(velocity, inertia.moment_spin)
            .plus(-by_velocity, drag.spin.moment);
        // (buoyancy)^ (arm)^
        let up = self.buoyancy * self.share;
        let mut hung = Mat3::diagonal(self.arm.z * up);
        hung.0[2].x -= self.arm.x * up;
        hung.0[2].y -= self.arm.y * up;
        hung.0[2].z -= self.arm.z * up;
        let mut tangent = [
            [
                force_translation,
                (inertia.force_rotation + force_spin.product(turn))
                    .plus(-self.share, drag.rotation.force),
            ],
            [
                moment_translation,
                (inertia.moment_rotation + hung + moment_spin.product(turn))
                    .plus(-self.share, drag.rotation.moment),
            ],
        ];
        if self.at_surface {
            self.add_waterline(&mut tangent);
        }
        tangent
    }

    /// Adds the derivatives through the share under water.
    #[inline(always)]
    fn add_waterline(&self, tangent: &mut [[Mat3<T>; 2]; 2]) {
        let [mut force, moment] = inertia_force(&self.added, &self.motion);
        force -= self.drag_load.force;
        force.z -= self.buoyancy;
        let mut moment = moment - self.drag_load.moment;
        moment.x -= self.arm.y * self.buoyancy;
        moment.y += self.arm.x * self.buoyancy;
        let zero = self.share.same(0.0);
        let by_height = Vec3::new(zero, zero, self.by_height);
        // The slope of the axis by a rotation: axis x up.
        let by_rotation = Vec3::new(self.axis.y, -self.axis.x, zero) * self.by_slope;
        let [[a, b], [c, d]] = tangent;
        *a = a.plus_outer(force, by_height);
        *b = b.plus_outer(force, by_rotation);
        *c = c.plus_outer(moment, by_height);
        *d = d.plus_outer(moment, by_rotation);
    }
}

#[cfg(test)]
mod tests {
    use super::super::tangent_test::moving_system;
    use super::*;

    /// Every frame of a system with all kinds of loads, in lanes and one by one.
    #[test]
    fn lanes_compute_what_numbers_do() {
        moving_system(|at, weights| {
            let n = at.system.frame_count();
            let mut residuals = [vec![Vector6::zeros(); n], vec![Vector6::zeros(); n]];
            let zero = BlockMatrix::zeros(&at.system.topology);
            let mut matrices = [zero.clone(), zero];
            for (lanes, (residual, matrix)) in residuals.iter_mut().zip(&mut matrices).enumerate() {
                match lanes {
                    0 => {
                        for k in 0..n {
                            let batches = FrameBatch::all(&at.system.frames, k..k + 1);
                            let one = Frames {
                                at,
                                batches: &batches,
                                weights: Some(weights),
                                residual: &mut *residual,
                                matrix: &mut *matrix,
                            };
                            one.run::<f64>(());
                        }
                    }
                    _ => vectorised(Frames {
                        at,
                        batches: &FrameBatch::all(&at.system.frames, 0..n),
                        weights: Some(weights),
                        residual,
                        matrix,
                    }),
                }
            }
            // A few roundings, of the largest entries of each block.
            for (a, b) in residuals[0].iter().zip(&residuals[1]) {
                assert!((a - b).norm() <= 1e-14 * a.norm());
            }
            for (a, b) in matrices[0].diagonal.iter().zip(&matrices[1].diagonal) {
                let size = a.0.iter().fold(0.0f64, |size, entry| size.max(entry.abs()));
                let same = |(a, b): (&f64, &f64)| (a - b).abs() <= 1e-14 * size;
                assert!(a.0.iter().zip(&b.0).all(same));
            }
        });
    }
}
