//! How lines and bodies follow the vessels that they hang on: the part of their motion that is
//! known before a step.
//!
//! Lines are springs from end to end, which hand on what their ends do along the chord; bodies are
//! masses on these springs. It need not be what happens, only close to it where vessels drive the
//! motion: the integrator adds the rest.
//!
//! Source: docs/theory/integration.md, eqs. (16) to (19).

use catenix_model::{EndConnection, Line, LineEnd, Model, SupportRef};
use catenix_numerics::lanes::{Kernel, Lane, Record, vectorised};
use catenix_numerics::{CarriedMotion, Configuration, Matrix3, Vector3, Vector6};

use super::{Frame, LineLayout};
use crate::body::motion::{PrescribedMotion, RigidMotion};

/// Rate of motion at which a body's inertia holds against the springs [rad/s].
const RATE: f64 = 1.0;
/// Sweeps over the bodies until their shares agree, at most.
const MOST_SWEEPS: usize = 200;

/// What each frame follows.
#[derive(Debug, Clone, Default)]
pub(crate) struct Followers {
    /// Moving points of vessels that ends of lines are connected to.
    points: Vec<VesselPoint>,
    /// Per body: the points that it follows, with the map of their displacement to its own.
    bodies: Vec<Vec<(usize, Matrix3)>>,
    lines: Vec<Follower>,
    /// First frame that is a body.
    first_body: usize,
}

#[derive(Debug, Clone, Copy)]
struct VesselPoint {
    vessel: usize,
    /// In the vessel's axes (3) [m].
    arm: Vector3,
    /// Where it is at t = 0 (3) [m].
    start: Vector3,
}

/// A line between its two ends.
#[derive(Debug, Clone)]
struct Follower {
    ends: [Source; 2],
    first_frame: usize,
    /// Share of end B in every number of the frames (n_frames).
    shares: Vec<Vector6>,
    /// Whether its blocks are pairs of points.
    pairs: bool,
}

/// What an end of a line moves with.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Source {
    /// Does not move.
    Still,
    /// One of the points.
    Point(usize),
    Body(usize),
}

/// Displacement, velocity and acceleration (3 each) [m, m/s, m/s2].
type Kinematics = [Vector3; 3];

const STILL: Kinematics = [Vector3::new(0.0, 0.0, 0.0); 3];

impl Followers {
    /// `frames` and `shape`: of the whole system, lines before bodies.
    pub(crate) fn new(
        model: &Model,
        motions: &[PrescribedMotion],
        layouts: &[LineLayout],
        frames: &[Frame],
        shape: &Configuration,
    ) -> Followers {
        let mut points = Vec::new();
        let lines: Vec<Follower> = model
            .lines
            .iter()
            .zip(layouts)
            .map(|(line, layout)| follower(model, line, layout, motions, shape, &mut points))
            .collect();
        let springs: Vec<(Matrix3, [Source; 2])> = model
            .lines
            .iter()
            .zip(layouts)
            .zip(&lines)
            .map(|((line, layout), follower)| (spring(model, line, layout, shape), follower.ends))
            .collect();
        let first_body = frames.len() - model.bodies.len();
        let masses = frames[first_body..].iter().map(|frame| frame.mass);
        let bodies = body_maps(&springs, &masses.collect::<Vec<f64>>(), points.len());
        Followers {
            points,
            bodies,
            lines,
            first_body,
        }
    }

    /// Writes the motion that goes with that of the vessels; returns whether there is any.
    ///
    /// Source: docs/theory/integration.md, eqs. (17) and (19).
    pub(crate) fn carry(&self, vessels: &[RigidMotion], carried: &mut CarriedMotion) -> bool {
        if self.points.is_empty() {
            return false;
        }
        let point = |k: usize| self.points[k].kinematics(vessels);
        for (body, map) in self.bodies.iter().enumerate() {
            let mut sum = STILL;
            for (k, share) in map {
                for (sum, of_point) in sum.iter_mut().zip(point(*k)) {
                    *sum += share * of_point;
                }
            }
            set(carried, self.first_body + body, &sum);
        }
        for line in &self.lines {
            let of_end = |source: Source| match source {
                Source::Still => STILL,
                Source::Point(k) => point(k),
                Source::Body(k) => get(carried, self.first_body + k),
            };
            let ends = line.ends.map(of_end);
            let mut patterns = [[[0.0; PERIOD]; 2]; 3];
            for (k, pattern) in patterns.iter_mut().enumerate() {
                let between = [ends[0][k], ends[1][k] - ends[0][k]];
                for (pattern, vector) in pattern.iter_mut().zip(between) {
                    for (place, number) in pattern.iter_mut().enumerate() {
                        // The rotations of a frame do not follow.
                        if line.pairs || place % 6 < 3 {
                            *number = vector[place % 3];
                        }
                    }
                }
            }
            let frames = line.first_frame..line.first_frame + line.shares.len();
            let lists = [
                &mut carried.travel,
                &mut carried.velocity,
                &mut carried.acceleration,
            ];
            vectorised(AlongLine {
                shares: Vector6::numbers(&line.shares),
                patterns: &patterns,
                to: lists.map(|list| Vector6::numbers_mut(&mut list[frames.clone()])),
            });
        }
        true
    }
}

/// Numbers after which those of frames, and the registers that hold them, repeat.
const PERIOD: usize = 24;

/// Motion between the ends of a line, over all numbers of its frames.
struct AlongLine<'a> {
    shares: &'a [f64],
    /// Displacement, velocity and acceleration: of end A, and of end B beside it.
    patterns: &'a [[[f64; PERIOD]; 2]; 3],
    to: [&'a mut [f64]; 3],
}

impl AlongLine<'_> {
    #[inline(always)]
    fn at<T: Lane>(&mut self, token: T::Token, i: usize) {
        let share = T::read_some(token, &self.shares[i..]);
        let mut k = 0;
        while k < 3 {
            let start = T::read_some(token, &self.patterns[k][0][i % PERIOD..]);
            let way = T::read_some(token, &self.patterns[k][1][i % PERIOD..]);
            way.mul_add(share, start).write_some(&mut self.to[k][i..]);
            k += 1;
        }
    }
}

impl Kernel for AlongLine<'_> {
    type Output = ();

    #[inline(always)]
    fn run<T: Lane>(mut self, token: T::Token) {
        let mut i = 0;
        while i + T::COUNT <= self.shares.len() {
            self.at::<T>(token, i);
            i += T::COUNT;
        }
        while i < self.shares.len() {
            self.at::<f64>((), i);
            i += 1;
        }
    }
}

/// Writes the motion of a body.
fn set(carried: &mut CarriedMotion, frame: usize, motion: &Kinematics) {
    let block = |k: usize| Vector6::new(motion[k].x, motion[k].y, motion[k].z, 0.0, 0.0, 0.0);
    carried.travel[frame] = block(0);
    carried.velocity[frame] = block(1);
    carried.acceleration[frame] = block(2);
}

fn get(carried: &CarriedMotion, frame: usize) -> Kinematics {
    [&carried.travel, &carried.velocity, &carried.acceleration]
        .map(|list| list[frame].fixed_rows::<3>(0).into_owned())
}

impl VesselPoint {
    fn new(motions: &[PrescribedMotion], vessel: usize, arm: Vector3) -> VesselPoint {
        let start = motions[vessel].at(0.0);
        VesselPoint {
            vessel,
            arm,
            start: start.position + start.rotation * arm,
        }
    }

    fn kinematics(&self, vessels: &[RigidMotion]) -> Kinematics {
        let motion = &vessels[self.vessel];
        let arm = motion.rotation * self.arm;
        let around = motion.spin.cross(&arm);
        let acceleration = motion.acceleration
            + motion.angular_acceleration.cross(&arm)
            + motion.spin.cross(&around);
        [
            motion.position + arm - self.start,
            motion.velocity + around,
            acceleration,
        ]
    }
}

fn follower(
    model: &Model,
    line: &Line,
    layout: &LineLayout,
    motions: &[PrescribedMotion],
    shape: &Configuration,
    points: &mut Vec<VesselPoint>,
) -> Follower {
    let mut source = |end: &LineEnd| match end {
        LineEnd::Free => None,
        LineEnd::Connected(EndConnection {
            to, point_local, ..
        }) => Some(match *to {
            SupportRef::Body(body) => Source::Body(body),
            SupportRef::Vessel(vessel) if model.vessels[vessel].motions.is_empty() => Source::Still,
            SupportRef::Vessel(vessel) => {
                points.push(VesselPoint::new(
                    motions,
                    vessel,
                    Vector3::from(*point_local),
                ));
                Source::Point(points.len() - 1)
            }
        }),
    };
    let [a, b] = line.ends.each_ref().map(&mut source);
    // A free end goes where the other one goes.
    let ends = [a.or(b), b.or(a)].map(|end| end.unwrap_or(Source::Still));
    let softness = softness_along(model, layout);
    let count = layout.frame_count as f64;
    let total = softness[softness.len() - 1];
    // Frames follow one another as elements do, whatever a formulation makes of these.
    let share = |place: f64| {
        let element = place / count * layout.element_count as f64;
        let whole = (element.floor() as usize).min(layout.element_count - 1);
        let part = element - whole as f64;
        (softness[whole] + (softness[whole + 1] - softness[whole]) * part) / total
    };
    let pairs = layout.first_frame < shape.pair_count();
    let shares = (0..layout.frame_count).map(|k| {
        let place = k as f64;
        let halves = match pairs {
            true => [share(place + 0.25), share(place + 0.75)],
            false => [share(place + 0.5), 0.0],
        };
        Vector6::from_fn(|row, _| halves[row / 3])
    });
    Follower {
        ends,
        first_frame: layout.first_frame,
        shares: shares.collect(),
        pairs,
    }
}

/// Stretch per newton from end A to each node (n_elements + 1) [m/N].
fn softness_along(model: &Model, layout: &LineLayout) -> Vec<f64> {
    let of_element =
        |k: usize| layout.length(k) / model.line_types[layout.element_types[k]].axial_stiffness;
    std::iter::once(0.0)
        .chain((0..layout.element_count).scan(0.0, |sum, k| {
            *sum += of_element(k);
            Some(*sum)
        }))
        .collect()
}

/// Stiffness of a line between its ends, along its chord (3 x 3) [N/m]: it stretches, and it gives
/// its slack against its weight.
///
/// Source: docs/theory/integration.md, eq. (16).
fn spring(model: &Model, line: &Line, layout: &LineLayout, shape: &Configuration) -> Matrix3 {
    let frames = layout.frames();
    let (first, last) = (frames.start, frames.end.saturating_sub(1));
    let chord = shape.position[last] - shape.position[first];
    let length = line.length();
    let distance = chord.norm() + length / layout.element_count as f64;
    let slack = (length - distance).max(0.0);
    let weight: f64 = (0..layout.element_count)
        .map(|k| model.line_types[layout.element_types[k]].mass * layout.length(k))
        .sum::<f64>()
        * model.environment.gravity;
    let stretch = softness_along(model, layout)[layout.element_count];
    let softness = stretch + slack / weight.max(f64::MIN_POSITIVE);
    match chord.try_normalize(0.0) {
        Some(axis) => axis * axis.transpose() / softness,
        None => Matrix3::zeros(),
    }
}

/// Per body: which points it follows, and how.
///
/// Source: docs/theory/integration.md, eq. (18).
fn body_maps(
    springs: &[(Matrix3, [Source; 2])],
    masses: &[f64],
    points: usize,
) -> Vec<Vec<(usize, Matrix3)>> {
    let mut maps = vec![vec![Matrix3::zeros(); points]; masses.len()];
    for _ in 0..MOST_SWEEPS {
        let mut change = 0.0f64;
        for (body, mass) in masses.iter().enumerate() {
            let mut stiffness = Matrix3::identity() * (mass * RATE * RATE);
            let mut pull = vec![Matrix3::zeros(); points];
            for (spring, ends) in springs {
                for (own, other) in [(ends[0], ends[1]), (ends[1], ends[0])] {
                    if own != Source::Body(body) || other == own {
                        continue;
                    }
                    stiffness += spring;
                    match other {
                        Source::Still => {}
                        Source::Point(k) => pull[k] += spring,
                        Source::Body(k) => {
                            for (pull, map) in pull.iter_mut().zip(&maps[k]) {
                                *pull += spring * map;
                            }
                        }
                    }
                }
            }
            let Some(softness) = stiffness.try_inverse() else {
                continue;
            };
            for (map, pull) in maps[body].iter_mut().zip(&pull) {
                let new = softness * pull;
                change = change.max((new - *map).amax());
                *map = new;
            }
        }
        if change < 1e-6 {
            break;
        }
    }
    maps.into_iter()
        .map(|map| {
            let moved = map.into_iter().enumerate();
            moved.filter(|(_, share)| share.amax() > 0.0).collect()
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(k: usize) -> Source {
        Source::Point(k)
    }

    fn along(axis: Vector3, stiffness: f64) -> Matrix3 {
        axis * axis.transpose() * stiffness
    }

    #[test]
    fn a_heavy_body_on_a_stiff_pipe_heaves_with_the_ship_and_does_not_sway() {
        let pipe = (along(Vector3::z(), 1e7), [point(0), Source::Body(0)]);
        let hose = (along(Vector3::x(), 1e3), [Source::Body(0), Source::Still]);
        let maps = body_maps(&[pipe, hose], &[1e5], 1);
        let [(0, share)] = maps[0][..] else {
            panic!("one point is followed: {maps:?}")
        };
        // 1e7 / (1e7 + 1e5), and nothing across the pipe.
        assert!((share[(2, 2)] - 1.0 / 1.01).abs() < 1e-12);
        assert!(share[(0, 0)].abs() < 1e-12 && share[(1, 1)].abs() < 1e-12);
    }

    #[test]
    fn bodies_in_a_row_share_what_their_springs_hand_on() {
        let spring = along(Vector3::z(), 3.0);
        let springs = [
            (spring, [point(0), Source::Body(0)]),
            (spring, [Source::Body(0), Source::Body(1)]),
            (spring, [Source::Body(1), Source::Still]),
        ];
        let maps = body_maps(&springs, &[0.0, 0.0], 1);
        // Without mass a body across which nothing holds has no answer, and stays.
        assert!(maps.iter().all(Vec::is_empty));
        let maps = body_maps(&springs, &[1e-9, 1e-9], 1);
        let shares = [0, 1].map(|body| maps[body][0].1[(2, 2)]);
        // A third and two thirds of the way; the sweeps end at changes of a millionth.
        assert!((shares[0] - 2.0 / 3.0).abs() < 1e-5 && (shares[1] - 1.0 / 3.0).abs() < 1e-5);
    }
}
