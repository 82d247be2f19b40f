//! Loads and inertia of one frame: the place where hydrodynamics, gravity, contact and inertia
//! meet.

use catenix_model::Seabed;
use catenix_numerics::{
    Block6, Matrix3, MotionState, TangentWeights, Vector3, Vector6, six, so3::hat,
};

use super::{Frame, FrameLump};
use crate::body::lump::LumpMotion;
use crate::contact::seabed;
use crate::hydro::current::CurrentField;
use crate::hydro::morison;
use crate::hydro::submergence::Submergence;

/// The sea at one time.
#[derive(Clone, Copy)]
pub(crate) struct Sea<'a> {
    pub current: &'a CurrentField,
    pub current_factor: f64,
    pub seabed: Option<&'a Seabed>,
    pub depth: f64,
}

/// Motion of one frame, global.
#[derive(Clone, Copy)]
pub(crate) struct FrameMotion {
    pub position: Vector3,
    pub rotation: Matrix3,
    pub velocity: Vector3,
    pub spin: Vector3,
    pub acceleration: Vector3,
    pub angular_acceleration: Vector3,
}

/// How velocity and acceleration follow an increment of this frame.
#[derive(Clone, Copy)]
pub(crate) struct FrameWeights {
    pub velocity: f64,
    pub acceleration: f64,
    pub rotation: Matrix3,
}

impl FrameWeights {
    /// For frame `k`.
    pub fn of(weights: &TangentWeights<'_>, k: usize) -> FrameWeights {
        FrameWeights {
            velocity: weights.velocity,
            acceleration: weights.acceleration,
            rotation: weights.turn(k),
        }
    }
}

/// Motion of frame `k` of a state.
pub(crate) fn frame_motion(state: &MotionState, k: usize) -> FrameMotion {
    let (velocity, acceleration) = (&state.velocity[k], &state.acceleration[k]);
    FrameMotion {
        position: state.configuration.position[k],
        rotation: state.configuration.rotation[k],
        velocity: velocity.fixed_rows::<3>(0).into_owned(),
        spin: velocity.fixed_rows::<3>(3).into_owned(),
        acceleration: acceleration.fixed_rows::<3>(0).into_owned(),
        angular_acceleration: acceleration.fixed_rows::<3>(3).into_owned(),
    }
}

/// Motion of a point of pair `k` of a state: a frame that does not turn.
pub(crate) fn point_motion(state: &MotionState, k: usize, half: usize) -> FrameMotion {
    let part = |list: &[Vector6]| -> Vector3 { list[k].fixed_rows::<3>(3 * half).into() };
    FrameMotion {
        position: state.configuration.point(k, half),
        rotation: Matrix3::identity(),
        velocity: part(&state.velocity),
        spin: Vector3::zeros(),
        acceleration: part(&state.acceleration),
        angular_acceleration: Vector3::zeros(),
    }
}

/// Powers of the loads on a frame or lump [W].
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct LoadPowers {
    pub drag: f64,
    pub added_mass: f64,
    pub buoyancy: f64,
    pub seabed_damping: f64,
}

/// Contact of a frame with the seabed, if it touches it.
pub(super) fn touch(sea: &Sea<'_>, frame: &Frame, m: &FrameMotion) -> Option<seabed::Contact> {
    let seabed = sea.seabed.filter(|_| frame.seabed_length > 0.0)?;
    let height = m.position.z + sea.depth;
    seabed::contact(seabed, frame.seabed_length, height, &m.velocity)
}

fn lump_motion(lump: &FrameLump, m: &FrameMotion, sea: &Sea<'_>) -> (LumpMotion, Vector3) {
    let arm = m.rotation * lump.arm;
    let (water, slope) = sea.current.at(m.position.z + arm.z, sea.current_factor);
    let motion = LumpMotion {
        arm,
        relative_velocity: water - m.velocity,
        spin: m.spin,
        acceleration: m.acceleration,
        angular_acceleration: m.angular_acceleration,
    };
    (motion, slope)
}

/// Motion of what a lump sits on.
pub(crate) fn lump_carrier(state: &MotionState, lump: &FrameLump) -> FrameMotion {
    if lump.frame < state.configuration.pair_count() {
        point_motion(state, lump.frame, lump.half)
    } else {
        frame_motion(state, lump.frame)
    }
}

/// Adds inertia minus loads of a lump on a point of a pair.
pub(crate) fn add_point_lump(
    lump: &FrameLump,
    m: &FrameMotion,
    sea: &Sea<'_>,
    residual: &mut Vector6,
    tangent: Option<(&mut Block6, &FrameWeights)>,
) {
    let mut own = Vector6::zeros();
    let mut block = Block6::ZERO;
    let wanted = tangent.as_ref().map(|(_, weights)| (&mut block, *weights));
    add_lump(lump, m, sea, &mut own, wanted);
    let mut rows = residual.fixed_rows_mut::<3>(3 * lump.half);
    rows += own.fixed_rows::<3>(0);
    if let Some((into, _)) = tangent {
        into.add_quadrant(lump.half, lump.half, &block.quadrant(0, 0));
    }
}

/// Adds inertia minus loads of a lump to its frame's residual and diagonal block.
pub(crate) fn add_lump(
    lump: &FrameLump,
    m: &FrameMotion,
    sea: &Sea<'_>,
    residual: &mut Vector6,
    tangent: Option<(&mut Block6, &FrameWeights)>,
) {
    let (motion, slope) = lump_motion(lump, m, sea);
    let arm = motion.arm;
    let wet = Submergence::new(m.position.z + arm.z, 0.0, 0.0, lump.diameter);
    let lift = Vector3::z() * (lump.buoyancy * wet.share - lump.weight);
    let force = lump.lump.force(wet.share, &motion).total() + lift;
    *residual -= six(&force, &arm.cross(&force));

    let Some((block, weights)) = tangent else {
        return;
    };
    let t = lump.lump.tangent(wet.share, &motion);
    let by_height = t.water * slope + (t.share + Vector3::z() * lump.buoyancy) * wet.by_height;
    let FrameWeights {
        velocity,
        acceleration,
        rotation,
    } = weights;
    // Of minus the force, by a move and a turn of the frame; the height is that of the lump.
    let mut by_move = t.velocity * -velocity - t.acceleration * *acceleration;
    let mut by_turn =
        -(t.spin * *velocity + t.angular_acceleration * *acceleration) * rotation - t.rotation;
    by_move.column_mut(2).axpy(-1.0, &by_height, 1.0);
    by_turn += by_height * Vector3::new(-arm.y, arm.x, 0.0).transpose();
    let lever = hat(&arm);
    block.add_quadrant(0, 0, &by_move);
    block.add_quadrant(0, 1, &by_turn);
    block.add_quadrant(1, 0, &(lever * by_move));
    block.add_quadrant(1, 1, &(lever * by_turn - hat(&force) * lever));
}

/// Mass matrix of a frame at its place: the structure, and the added mass if `in_water`.
pub(crate) fn frame_mass(frame: &Frame, m: &FrameMotion, in_water: bool) -> Block6 {
    let axis = m.rotation * frame.axis;
    let share = match in_water {
        true => Submergence::new(m.position.z, axis.z, frame.length, frame.diameter).share,
        false => 0.0,
    };
    let structure = m.rotation * Matrix3::from_diagonal(&frame.inertia) * m.rotation.transpose();
    let added = morison::added_mass(&axis, frame.added_normal, frame.added_axial);
    let added_inertia = morison::added_mass(&axis, frame.added_inertia, 0.0);
    let mut mass = Block6::ZERO;
    mass.add_quadrant(0, 0, &(Matrix3::identity() * frame.mass + added * share));
    mass.add_quadrant(1, 1, &(structure + added_inertia * share));
    mass
}

/// Mass matrix of a lump about its frame's origin.
pub(crate) fn lump_mass(
    lump: &FrameLump,
    m: &FrameMotion,
    sea: &Sea<'_>,
    in_water: bool,
) -> Block6 {
    let (motion, _) = lump_motion(lump, m, sea);
    let height = m.position.z + motion.arm.z;
    let share = match in_water {
        true => Submergence::new(height, 0.0, 0.0, lump.diameter).share,
        false => 0.0,
    };
    let own = lump.lump.mass + share * lump.lump.added_mass;
    let arm = hat(&motion.arm);
    let mut mass = Block6::ZERO;
    mass.add_quadrant(0, 0, &(Matrix3::identity() * own));
    mass.add_quadrant(0, 1, &(arm * -own));
    mass.add_quadrant(1, 0, &(arm * own));
    mass.add_quadrant(1, 1, &(arm * arm * -own));
    mass
}

/// Kinetic and gravity energy of a lump and the powers of its loads; its own mass is structure, its
/// added mass is not told apart and counts as structure too.
pub(crate) fn lump_energy(
    lump: &FrameLump,
    m: &FrameMotion,
    sea: &Sea<'_>,
) -> (f64, f64, LoadPowers) {
    let (motion, _) = lump_motion(lump, m, sea);
    let velocity = m.velocity + m.spin.cross(&motion.arm);
    let height = m.position.z + motion.arm.z;
    let wet = Submergence::new(height, 0.0, 0.0, lump.diameter);
    let force = lump.lump.force(wet.share, &motion);
    let powers = LoadPowers {
        drag: force.drag.dot(&velocity),
        buoyancy: lump.buoyancy * wet.share * velocity.z,
        ..LoadPowers::default()
    };
    let kinetic =
        0.5 * (lump.lump.mass + wet.share * lump.lump.added_mass) * velocity.norm_squared();
    (kinetic, lump.weight * height, powers)
}
