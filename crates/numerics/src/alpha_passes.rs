//! The formulas of generalised-alpha that are the same for every number of a state.
//!
//! Source: docs/theory/integration.md, eqs. (2), (5a) and (17).

use crate::Vector6;
use crate::implicit::{CarriedMotion, MotionState};
use crate::lanes::Lane;
use crate::passes::{Pass, numbers, numbers_mut, pass, read, write};

/// Travel, velocity and acceleration at the end of a step, (n) each.
#[derive(Debug, Clone)]
pub(crate) struct Guess {
    pub travel: Vec<Vector6>,
    pub velocity: Vec<Vector6>,
    pub acceleration: Vec<Vector6>,
}

/// Motion that is carried along at the start and at the end of a step.
pub(crate) type Carried<'a> = Option<[&'a CarriedMotion; 2]>;

/// Where a step begins.
pub(crate) struct Start<'a> {
    pub state: &'a MotionState,
    /// Algorithmic acceleration, (n).
    pub algorithmic: &'a [Vector6],
    pub carried: Carried<'a>,
}

/// A step of constant algorithmic acceleration: writes its travel, and the velocity and acceleration
/// that it leads to into `end`.
///
/// Source: docs/theory/integration.md, eqs. (5a) and (17).
pub(crate) fn predict(
    start: &Start<'_>,
    step: f64,
    alpha_f: f64,
    travel: &mut [Vector6],
    end: &mut MotionState,
) {
    let count = 6 * travel.len();
    let formula = Predict {
        velocity: numbers(&start.state.velocity),
        acceleration: numbers(&start.state.acceleration),
        algorithmic: numbers(start.algorithmic),
        carried: start.carried.map(Impositions::new),
        step,
        half_square: 0.5 * step * step,
        by_algorithmic: 1.0 / (1.0 - alpha_f),
        by_old: -alpha_f / (1.0 - alpha_f),
        to: [
            numbers_mut(travel),
            numbers_mut(&mut end.velocity),
            numbers_mut(&mut end.acceleration),
        ],
    };
    pass(formula, count);
}

/// Numbers of a [`Carried`] motion: travel, velocity and acceleration, each at start and end.
struct Impositions<'a> {
    travel: [&'a [f64]; 2],
    velocity: [&'a [f64]; 2],
    acceleration: [&'a [f64]; 2],
}

impl<'a> Impositions<'a> {
    fn new([start, end]: [&'a CarriedMotion; 2]) -> Self {
        Impositions {
            travel: [numbers(&start.travel), numbers(&end.travel)],
            velocity: [numbers(&start.velocity), numbers(&end.velocity)],
            acceleration: [numbers(&start.acceleration), numbers(&end.acceleration)],
        }
    }
}

struct Predict<'a> {
    velocity: &'a [f64],
    acceleration: &'a [f64],
    algorithmic: &'a [f64],
    carried: Option<Impositions<'a>>,
    step: f64,
    half_square: f64,
    by_algorithmic: f64,
    by_old: f64,
    to: [&'a mut [f64]; 3],
}

impl Pass for Predict<'_> {
    #[inline(always)]
    fn step<T: Lane>(&mut self, token: T::Token, i: usize) {
        let steady = read::<T>(token, self.algorithmic, i);
        let mut velocity = read::<T>(token, self.velocity, i);
        let mut acceleration = read::<T>(token, self.acceleration, i);
        // What the supports impose stays out of the formulas.
        if let Some(carried) = &self.carried {
            velocity -= read(token, carried.velocity[0], i);
            acceleration -= read(token, carried.acceleration[0], i);
        }
        let step = T::splat(token, self.step);
        let square = T::splat(token, self.half_square);
        let mut travel = velocity.mul_add(step, steady * square);
        let mut new_velocity = steady.mul_add(step, velocity);
        let mut new_acceleration = steady * self.by_algorithmic + acceleration * self.by_old;
        if let Some(carried) = &self.carried {
            travel +=
                read::<T>(token, carried.travel[1], i) - read::<T>(token, carried.travel[0], i);
            new_velocity += read(token, carried.velocity[1], i);
            new_acceleration += read(token, carried.acceleration[1], i);
        }
        write(travel, self.to[0], i);
        write(new_velocity, self.to[1], i);
        write(new_acceleration, self.to[2], i);
    }
}

/// Velocity and acceleration of `state` at another travel than that of `guess`, with their
/// derivatives by the travel.
///
/// Source: docs/theory/integration.md, eq. (5a).
pub(crate) fn follow(
    travel: &[Vector6],
    guess: &Guess,
    by_travel: [f64; 2],
    state: &mut MotionState,
) {
    let formula = Follow {
        travel: numbers(travel),
        guess: [
            numbers(&guess.travel),
            numbers(&guess.velocity),
            numbers(&guess.acceleration),
        ],
        by_travel,
        to: [
            numbers_mut(&mut state.velocity),
            numbers_mut(&mut state.acceleration),
        ],
    };
    pass(formula, 6 * travel.len());
}

struct Follow<'a> {
    travel: &'a [f64],
    guess: [&'a [f64]; 3],
    by_travel: [f64; 2],
    to: [&'a mut [f64]; 2],
}

impl Pass for Follow<'_> {
    #[inline(always)]
    fn step<T: Lane>(&mut self, token: T::Token, i: usize) {
        let way = read::<T>(token, self.travel, i) - read::<T>(token, self.guess[0], i);
        let velocity = T::splat(token, self.by_travel[0]);
        let velocity = way.mul_add(velocity, read(token, self.guess[1], i));
        write(velocity, self.to[0], i);
        let acceleration = T::splat(token, self.by_travel[1]);
        let acceleration = way.mul_add(acceleration, read(token, self.guess[2], i));
        write(acceleration, self.to[1], i);
    }
}

/// algorithmic <- algorithmic + factor (travel - guess)
///
/// Source: docs/theory/integration.md, eq. (5a).
pub(crate) fn move_algorithmic(
    algorithmic: &mut [Vector6],
    factor: f64,
    [travel, guess]: [&Vec<Vector6>; 2],
) {
    let count = 6 * algorithmic.len();
    let formula = MoveAlgorithmic {
        algorithmic: numbers_mut(algorithmic),
        factor,
        ends: [numbers(travel), numbers(guess)],
    };
    pass(formula, count);
}

struct MoveAlgorithmic<'a> {
    algorithmic: &'a mut [f64],
    factor: f64,
    ends: [&'a [f64]; 2],
}

impl Pass for MoveAlgorithmic<'_> {
    #[inline(always)]
    fn step<T: Lane>(&mut self, token: T::Token, i: usize) {
        let way = read::<T>(token, self.ends[0], i) - read::<T>(token, self.ends[1], i);
        let old = read::<T>(token, self.algorithmic, i);
        let new = way.mul_add(T::splat(token, self.factor), old);
        write(new, self.algorithmic, i);
    }
}

/// Acceleration at the end of a step less that at its start, both beside what is carried along.
///
/// Source: docs/theory/integration.md, eqs. (8) and (17).
pub(crate) fn change_of_acceleration(
    ends: [&MotionState; 2],
    carried: Carried<'_>,
    change: &mut [Vector6],
) {
    let count = 6 * change.len();
    let formula = Change {
        ends: ends.map(|state| numbers(&state.acceleration)),
        carried: carried.map(|ends| ends.map(|motion| numbers(&motion.acceleration))),
        change: numbers_mut(change),
    };
    pass(formula, count);
}

struct Change<'a> {
    ends: [&'a [f64]; 2],
    carried: Option<[&'a [f64]; 2]>,
    change: &'a mut [f64],
}

impl Pass for Change<'_> {
    #[inline(always)]
    fn step<T: Lane>(&mut self, token: T::Token, i: usize) {
        let mut change = read::<T>(token, self.ends[1], i) - read::<T>(token, self.ends[0], i);
        if let Some([start, end]) = self.carried {
            change -= read::<T>(token, end, i) - read::<T>(token, start, i);
        }
        write(change, self.change, i);
    }
}
