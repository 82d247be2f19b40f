//! `[motions.*]`: prescribed motions that vessels refer to.

use crate::file::define::{choice, kinds, table};
use crate::file::dimension::{Angle, LengthOrAngle, Speed, Time};
use crate::file::quantity::{NonNegative, Positive, Real};
use crate::file::read::Text;

kinds! {
    /// A prescribed motion; a vessel adds up several.
    pub(super) enum MotionTable {
        "tow" => Tow(TowTable),
        "harmonic" => Harmonic(HarmonicTable),
        "history" => History(HistoryTable),
    }
}

table! {
    /// Tow at constant speed from rest. One change of velocity is given by `speed`, `heading`,
    /// `start` and `ramp`; several by `legs`.
    pub(super) struct TowTable {
        /// Speed after the ramp; negative moves backwards.
        speed: Option<Real<Speed>>,
        /// Direction of the motion, from +x towards +y; absent: 0 deg.
        heading: Option<Real<Angle>>,
        /// When the speed starts to change; absent: 0 s.
        start: Option<NonNegative<Time>>,
        /// How long the change takes; a quintic smooth step.
        ramp: Option<NonNegative<Time>>,
        /// Changes of velocity by increasing time, each from the velocity of the one before.
        legs: Option<Vec<LegTable>>,
    }
}

table! {
    /// One change of velocity.
    pub(super) struct LegTable {
        /// When the velocity starts to change.
        start: NonNegative<Time>,
        /// How long the change takes; a quintic smooth step.
        ramp: NonNegative<Time>,
        /// New speed; negative moves backwards.
        speed: Real<Speed>,
        /// New direction of the motion, from +x towards +y.
        heading: Real<Angle> = "0 deg",
    }
}

table! {
    /// Harmonic motion: amplitude sin(2 pi t / period + phase), raised by a quintic smooth step.
    pub(super) struct HarmonicTable {
        /// Direction of the motion, along or about the global axes.
        degree: DegreeChoice,
        /// Amplitude: a length, or an angle for roll, pitch and yaw.
        amplitude: NonNegative<LengthOrAngle>,
        /// Period.
        period: Positive<Time>,
        /// Phase.
        phase: Real<Angle> = "0 deg",
        /// Time over which the amplitude is raised from zero; absent: two periods.
        ramp: Option<NonNegative<Time>>,
    }
}

choice! {
    /// Degrees of freedom.
    pub(super) enum DegreeChoice {
        /// Translation along global x.
        Surge = "surge",
        /// Translation along global y.
        Sway = "sway",
        /// Translation along global z.
        Heave = "heave",
        /// Rotation about x.
        Roll = "roll",
        /// Rotation about y.
        Pitch = "pitch",
        /// Rotation about z.
        Yaw = "yaw",
    }
}

table! {
    /// Motion given at points in time, joined by a cubic spline that starts and ends at rest, held constant before
    /// the first and after the last.
    pub(super) struct HistoryTable {
        /// CSV file, relative to the model file. Its first row names the columns: `time_s` and any
        /// of `surge_m`, `sway_m`, `heave_m`, `roll_deg`, `pitch_deg`, `yaw_deg`.
        file: Text,
    }
}
