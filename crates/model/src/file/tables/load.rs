//! `[loads.*]`: forces and moments on points of lines and bodies.

use crate::file::define::table;
use crate::file::dimension::{Angle, AngularFrequency, Force, Length, Moment, Time};
use crate::file::quantity::{NonNegative, Positive, Real};
use crate::file::read::{Text, Vector};

use super::FactorTable;

table! {
    /// A force, a moment, or both, on a point of a line or body. It is constant unless `harmonic`
    /// or `factor` says otherwise; statics has its value at t = 0.
    pub(super) struct LoadTable {
        /// What it acts on: a name from `lines` or `bodies`.
        on: Text,
        /// On a line: unstretched distance from end A. The element there carries the load, or both
        /// neighbours half of it each where two elements meet.
        at: Option<NonNegative<Length>>,
        /// On a body: the point in its local axes; absent: the origin, its centre of mass.
        point: Option<Vector<Real<Length>>>,
        /// Force, in global axes unless the load `follows`; absent: none.
        force: Option<Vector<Real<Force>>>,
        /// Moment, in global axes unless the load `follows`; absent: none.
        moment: Option<Vector<Real<Moment>>>,
        /// Whether the load turns with what it acts on. Its components are then in local axes: those
        /// of the body, or, on a line, x along it from A to B, y horizontal and across it (z x x;
        /// global y where the line is vertical), z = x x y, all of the element in the first shape.
        follows: bool = false,
        /// The load is sin(w t + phase) times its components.
        harmonic: Option<LoadHarmonicTable>,
        /// Factor on the load over time; linear between entries, constant outside. Two entries at
        /// one time are a step.
        factor: Option<Vec<FactorTable>>,
    }
}

table! {
    /// Harmonic variation of a load. Exactly one of `period` and `angular_frequency` is given.
    pub(super) struct LoadHarmonicTable {
        /// Period.
        period: Option<Positive<Time>>,
        /// Angular frequency w; the period is 2 pi / w.
        angular_frequency: Option<Positive<AngularFrequency>>,
        /// Phase.
        phase: Real<Angle> = "0 deg",
        /// Time over which the load is raised from zero, by a quintic smooth step; 0 is at once.
        ramp: NonNegative<Time> = "0 s",
    }
}
