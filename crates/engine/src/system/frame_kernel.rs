//! Loads and inertia of rigid frames, several at a time.
//!
//! What depends on a frame's height by cases (how much of it is under water, the current there, the
//! seabed) is found frame by frame; the rest is computed in lanes.

use std::ops::Range;

use catenix_numerics::lanes::{Kernel, Lane, MOST_LANES, Mat3, Row, Vec3, vectorised};
use catenix_numerics::{BlockMatrix, TangentWeights, Vector3, Vector6};

use super::Frame;
use super::frames::{FrameMotion, LoadPowers, frame_motion, touch};
use crate::body::inertia::{BodyMotion, Tensors, inertia_force, inertia_tangent};
use crate::formulation::Situation;
use crate::hydro::morison::DragKernel;
use crate::hydro::submergence::Submergence;

const NO_ROW: Row = [0.0; MOST_LANES];

/// Adds inertia minus loads of rigid frames to their residuals and, with `weights`, their derivatives
/// to their diagonal blocks.
pub(crate) fn add_frames(
    at: &Situation<'_>,
    range: Range<usize>,
    weights: Option<&TangentWeights<'_>>,
    residual: &mut [Vector6],
    matrix: &mut BlockMatrix,
) {
    vectorised(Frames {
        at,
        range,
        weights,
        residual,
        matrix,
    });
}

pub(super) struct Frames<'a> {
    pub at: &'a Situation<'a>,
    pub range: Range<usize>,
    pub weights: Option<&'a TangentWeights<'a>>,
    pub residual: &'a mut [Vector6],
    pub matrix: &'a mut BlockMatrix,
}

/// Kinetic and potential energy of rigid frames [J], and the powers of their loads.
pub(crate) fn frame_energies(at: &Situation<'_>, range: Range<usize>) -> (f64, f64, LoadPowers) {
    let [twice_kinetic, drag, added_mass, buoyancy] = vectorised(Energies {
        at,
        range: range.clone(),
    });
    let mut potential = 0.0;
    let mut powers = LoadPowers {
        drag,
        added_mass,
        buoyancy,
        seabed_damping: 0.0,
    };
    for k in range {
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
    range: Range<usize>,
}

impl Kernel for Energies<'_> {
    type Output = [f64; 4];

    /// Twice the kinetic energy, and the powers of drag, added mass and buoyancy.
    #[inline(always)]
    fn run<T: Lane>(self, token: T::Token) -> [f64; 4] {
        let mut rows = NO_ROWS;
        let mut sums = [0.0; 4];
        let mut first = self.range.start;
        while first < self.range.end {
            let count = (self.range.end - first).min(T::COUNT);
            for lane in 0..T::COUNT {
                rows.fill(lane, self.at, first + lane.min(count - 1), None);
            }
            let loads = Loads::<T>::new(token, &rows);
            let mut each = [NO_ROW; 4];
            let velocity = Vec3::<T>::read(token, &rows.motion);
            let mass: T = T::read(token, &rows.plain[0]);
            let (share, motion) = (loads.share, &loads.motion);
            let turning = loads.tensors.inertia.times(motion.spin)
                - loads.added.inertia.times(motion.spin) * share;
            let kinetic: T = mass * velocity.norm_squared() + motion.spin.dot(turning);
            kinetic.write(&mut each[0]);
            let [force, moment] = loads.drag_load;
            (share * (force.dot(velocity) + moment.dot(motion.spin))).write(&mut each[1]);
            let carried = velocity.dot(loads.added.mass.times(motion.acceleration))
                + motion
                    .spin
                    .dot(loads.added.inertia.times(motion.angular_acceleration));
            (-(share * carried)).write(&mut each[2]);
            let rise = velocity.z + motion.spin.cross(loads.arm).z;
            (loads.buoyancy * share * rise).write(&mut each[3]);
            for (sum, row) in sums.iter_mut().zip(&each) {
                for value in &row[..count] {
                    *sum += value;
                }
            }
            first += count;
        }
        sums
    }
}

/// Everything that frames are computed from, one row per number.
#[derive(Clone, Copy)]
struct Rows {
    /// Mass, weight, buoyancy, added mass across and along, added inertia (6).
    plain: [Row; 6],
    /// Drag coefficients (3).
    drag: [Row; 3],
    /// Principal moments of inertia, own axis, arm of the buoyancy (9).
    vectors: [Row; 9],
    /// Rotation (9).
    rotation: [Row; 9],
    /// Velocity and acceleration (12).
    motion: [Row; 12],
    /// Velocity of the water and its derivative by height (6).
    water: [Row; 6],
    /// Share under water, its derivative by height, and by the slope of the axis (3).
    wet: [Row; 3],
    /// Factor on rotation increments (9).
    turn: [Row; 9],
}

const NO_ROWS: Rows = Rows {
    plain: [NO_ROW; 6],
    drag: [NO_ROW; 3],
    vectors: [NO_ROW; 9],
    rotation: [NO_ROW; 9],
    motion: [NO_ROW; 12],
    water: [NO_ROW; 6],
    wet: [NO_ROW; 3],
    turn: [NO_ROW; 9],
};

/// Puts the numbers of one frame into its lane.
#[inline(always)]
fn gather(rows: &mut [Row], lane: usize, values: &[f64]) {
    for (row, value) in rows.iter_mut().zip(values) {
        row[lane] = *value;
    }
}

impl Rows {
    /// Fills a lane; whether the frame passes through the surface.
    #[inline(always)]
    fn fill(
        &mut self,
        lane: usize,
        at: &Situation<'_>,
        k: usize,
        weights: Option<&TangentWeights<'_>>,
    ) -> bool {
        let frame: &Frame = &at.system.frames[k];
        let rotation = &at.state.configuration.rotation[k];
        let height = at.state.configuration.position[k].z;
        let plain = [
            frame.mass,
            frame.weight,
            frame.buoyancy,
            frame.added_normal,
            frame.added_axial,
            frame.added_inertia,
        ];
        gather(&mut self.plain, lane, &plain);
        let drag = [
            frame.drag.normal,
            frame.drag.axial,
            frame.drag.radius_squared,
        ];
        gather(&mut self.drag, lane, &drag);
        gather(&mut self.vectors, lane, frame.inertia.as_slice());
        gather(&mut self.vectors[3..], lane, frame.axis.as_slice());
        gather(&mut self.vectors[6..], lane, frame.buoyancy_arm.as_slice());
        gather(&mut self.rotation, lane, rotation.as_slice());
        gather(&mut self.motion, lane, at.state.velocity[k].as_slice());
        gather(
            &mut self.motion[6..],
            lane,
            at.state.acceleration[k].as_slice(),
        );
        let (water, slope) = at.sea.current.at(height, at.sea.current_factor);
        gather(&mut self.water, lane, water.as_slice());
        gather(&mut self.water[3..], lane, slope.as_slice());
        let [x, y, z] = [0, 1, 2].map(|d| rotation[(2, d)] * frame.axis[d]);
        let wet = Submergence::new(height, x + y + z, frame.length, frame.diameter);
        gather(
            &mut self.wet,
            lane,
            &[wet.share, wet.by_height, wet.by_slope],
        );
        if let Some(weights) = weights {
            gather(&mut self.turn, lane, weights.turn(k).as_slice());
        }
        wet.by_height != 0.0
    }
}

impl Kernel for Frames<'_> {
    type Output = ();

    #[inline(always)]
    fn run<T: Lane>(self, token: T::Token) {
        let Frames {
            at,
            range,
            weights,
            residual,
            matrix,
        } = self;
        let mut rows = NO_ROWS;
        let mut blocks = [NO_ROW; 36];
        let mut first = range.start;
        while first < range.end {
            let count = (range.end - first).min(T::COUNT);
            let mut at_surface = false;
            for lane in 0..T::COUNT {
                // The last frame fills idle lanes.
                let k = first + lane.min(count - 1);
                at_surface |= rows.fill(lane, at, k, weights);
            }
            let loads = Loads::<T>::new(token, &rows);
            let [force, moment] = loads.total();
            let mut sums = [NO_ROW; 6];
            force.write(&mut sums);
            moment.write(&mut sums[3..]);
            for lane in 0..count {
                for (sum, row) in residual[first + lane].iter_mut().zip(&sums) {
                    *sum += row[lane];
                }
            }
            if let Some(weights) = weights {
                let turn = Mat3::read(token, &rows.turn);
                let velocity = T::splat(token, weights.velocity);
                let acceleration = T::splat(token, weights.acceleration);
                let mut tangent = loads.tangent(velocity, acceleration, turn);
                if at_surface {
                    loads.add_waterline(&mut tangent);
                }
                let [[a, b], [c, d]] = &tangent;
                for column in 0..3 {
                    a.0[column].write(&mut blocks[6 * column..]);
                    c.0[column].write(&mut blocks[6 * column + 3..]);
                    b.0[column].write(&mut blocks[6 * column + 18..]);
                    d.0[column].write(&mut blocks[6 * column + 21..]);
                }
                for lane in 0..count {
                    let block = &mut matrix.diagonal[first + lane].0;
                    for (entry, row) in block.iter_mut().zip(&blocks) {
                        *entry += row[lane];
                    }
                }
            }
            if at.sea.seabed.is_some() {
                for k in first..first + count {
                    add_contact(at, k, weights, residual, matrix);
                }
            }
            first += count;
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
struct Loads<T> {
    axis: Vec3<T>,
    /// Share under water.
    share: T,
    drag: DragKernel<T>,
    /// Force and moment of the drag, fully under water.
    drag_load: [Vec3<T>; 2],
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
}

impl<T: Lane> Loads<T> {
    #[inline(always)]
    fn new(token: T::Token, rows: &Rows) -> Self {
        let rotation = Mat3::<T>::read(token, &rows.rotation);
        let axis = rotation.times(Vec3::read(token, &rows.vectors[3..]));
        let share = T::read(token, &rows.wet[0]);
        let spin = Vec3::read(token, &rows.motion[3..]);
        let relative = Vec3::read(token, &rows.water) - Vec3::read(token, &rows.motion);
        let coefficients = [
            T::read(token, &rows.drag[0]),
            T::read(token, &rows.drag[1]),
            T::read(token, &rows.drag[2]),
        ];
        let drag = DragKernel::new(coefficients, axis, relative, spin);
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
        let [x, y, z] = rotation.0;
        let structure = (x * T::read(token, &rows.vectors[0]))
            .outer(x)
            .plus_outer(y * T::read(token, &rows.vectors[1]), y)
            .plus_outer(z * T::read(token, &rows.vectors[2]), z);
        Loads {
            axis,
            share,
            drag,
            drag_load: drag.load(),
            tensors: Tensors {
                mass: (added.mass * share).plus_diagonal(T::read(token, &rows.plain[0])),
                inertia: structure.plus(share, added.inertia),
            },
            added,
            motion: BodyMotion {
                spin,
                acceleration: Vec3::read(token, &rows.motion[6..]),
                angular_acceleration: Vec3::read(token, &rows.motion[9..]),
            },
            current_slope: Vec3::read(token, &rows.water[3..]),
            weight: T::read(token, &rows.plain[1]),
            buoyancy: T::read(token, &rows.plain[2]),
            arm: rotation.times(Vec3::read(token, &rows.vectors[6..])),
            by_height: T::read(token, &rows.wet[1]),
            by_slope: T::read(token, &rows.wet[2]),
        }
    }

    /// Inertia minus loads: force and moment.
    #[inline(always)]
    fn total(&self) -> [Vec3<T>; 2] {
        let [force, moment] = inertia_force(&self.tensors, &self.motion);
        let buoyancy = self.buoyancy * self.share;
        let mut force = force.minus(self.share, self.drag_load[0]);
        force.z += self.weight - buoyancy;
        let mut moment = moment.minus(self.share, self.drag_load[1]);
        // Arm x buoyancy.
        moment.x -= self.arm.y * buoyancy;
        moment.y += self.arm.x * buoyancy;
        [force, moment]
    }

    /// Derivatives of [`Self::total`] by translation and rotation, but for those through the share.
    #[inline(always)]
    fn tangent(&self, velocity: T, acceleration: T, turn: Mat3<T>) -> [[Mat3<T>; 2]; 2] {
        let drag = self.drag.derivatives();
        let inertia = inertia_tangent(&self.tensors, &self.motion);
        let by_velocity = self.share * velocity;
        let mut force_translation =
            (self.tensors.mass * acceleration).plus(by_velocity, drag.force[0]);
        let mut moment_translation = drag.moment[0] * by_velocity;
        // The current changes with height.
        let slope = self.current_slope * self.share;
        force_translation.0[2] -= drag.force[0].times(slope);
        moment_translation.0[2] -= drag.moment[0].times(slope);
        // Drag by a turn of the axis, and through the spin.
        let turned = self.axis * self.share;
        let force_spin = drag.force[2] * -by_velocity;
        let moment_spin = (self.tensors.inertia * acceleration)
            .plus(velocity, inertia.moment_spin)
            .plus(-by_velocity, drag.moment[2]);
        // (buoyancy)^ (arm)^
        let up = self.buoyancy * self.share;
        let mut hung = Mat3::diagonal(self.arm.z * up);
        hung.0[2].x -= self.arm.x * up;
        hung.0[2].y -= self.arm.y * up;
        hung.0[2].z -= self.arm.z * up;
        [
            [
                force_translation,
                drag.force[1].crossing(turned) + inertia.force_rotation + force_spin.product(turn),
            ],
            [
                moment_translation,
                drag.moment[1].crossing(turned)
                    + inertia.moment_rotation
                    + hung
                    + moment_spin.product(turn),
            ],
        ]
    }

    /// Adds the derivatives through the share under water.
    #[inline(always)]
    fn add_waterline(&self, tangent: &mut [[Mat3<T>; 2]; 2]) {
        let [mut force, moment] = inertia_force(&self.added, &self.motion);
        force -= self.drag_load[0];
        force.z -= self.buoyancy;
        let mut moment = moment - self.drag_load[1];
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
                let frames = Frames {
                    at,
                    range: 0..n,
                    weights: Some(weights),
                    residual,
                    matrix,
                };
                match lanes {
                    0 => frames.run::<f64>(()),
                    _ => vectorised(frames),
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
