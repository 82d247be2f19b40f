//! Prescribed motions of vessels.

/// Degree of freedom of a prescribed motion, along or about the global axes.
///
/// Rotations compose as yaw, then pitch, then roll (R = Rz Ry Rx).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Degree {
    /// Translation along global x.
    Surge,
    /// Translation along global y.
    Sway,
    /// Translation along global z.
    Heave,
    /// Rotation about x.
    Roll,
    /// Rotation about y.
    Pitch,
    /// Rotation about z.
    Yaw,
}

impl Degree {
    /// Position in the six-component motion (surge, sway, heave, roll, pitch, yaw).
    pub fn index(self) -> usize {
        self as usize
    }
}

/// One prescribed motion; a vessel adds up several.
///
/// Every motion starts at t = 0 from rest with continuous velocity and acceleration where its
/// `ramp` is positive.
#[derive(Debug, Clone, PartialEq)]
pub enum Motion {
    /// Tow at constant speed along a path of legs.
    ///
    /// Each leg changes the velocity to `velocity` between `start` and `start + ramp`, by a quintic
    /// smooth step; later legs start from the velocity of the one before. A reversal is a second
    /// leg.
    Tow {
        /// Legs by increasing start time, not overlapping.
        legs: Vec<TowLeg>,
    },
    /// Harmonic motion: s(t) amplitude sin(2 pi t / period + phase), with s the quintic smooth
    /// step from 0 to 1 over `ramp`.
    Harmonic {
        /// Direction of the motion.
        degree: Degree,
        /// Amplitude [m] or [rad].
        amplitude: f64,
        /// Period [s].
        period: f64,
        /// Phase [rad].
        phase: f64,
        /// Time over which the amplitude is raised [s].
        ramp: f64,
    },
    /// Motion given at points in time, joined by a cubic spline (continuous acceleration) that
    /// starts and ends at rest, held constant before the first and after the last point.
    History {
        /// Times, strictly increasing, at least two (n) [s].
        time: Vec<f64>,
        /// Values per degree of freedom: surge, sway, heave [m], roll, pitch, yaw [rad]; each
        /// either empty (no motion in it) or as long as `time`.
        values: [Vec<f64>; 6],
    },
}

/// One leg of a [`Motion::Tow`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TowLeg {
    /// When the velocity starts to change [s].
    pub start: f64,
    /// How long the change takes [s], positive.
    pub ramp: f64,
    /// New velocity, global x and y [m/s].
    pub velocity: [f64; 2],
}
