//! `[output]`, `[figures.*]` and references.

use crate::file::define::{choice, table};
use crate::file::dimension::{AnyMeasure, Time};
use crate::file::quantity::{Positive, Real};
use crate::file::read::{Pair, Text};

table! {
    /// What is recorded.
    pub(super) struct OutputTable {
        /// Interval of the time histories.
        interval: Positive<Time> = "0.1 s",
        /// Interval at which every quantity along every line is recorded.
        field_interval: Positive<Time> = "1 s",
        /// Whether results at output times are interpolated between steps, to third order; with
        /// `false`, steps end on output times.
        interpolate: bool = true,
        /// Channels beyond the standard ones: `<line>.<quantity>@<arc length>`, for example
        /// `hose.bend_moment@132 m`. Quantities are x, y, z, effective_tension, wall_tension,
        /// shear_force, bend_moment, curvature, torque, von_mises_stress and declination.
        channels: Option<Vec<Text>>,
    }
}

table! {
    /// A figure: one channel against time, one curve per load case.
    pub(super) struct FigureTable {
        /// Title above the axes; absent: the channel.
        title: Option<Text>,
        /// The channel, for example `buffer.offset_x`, `hose.end_b.force_z` or
        /// `lift_pipe.effective_tension@450 m`.
        channel: Text,
    }
}

table! {
    /// A result from elsewhere that the case's own is compared with: of a publication, a
    /// measurement, or other programs. It is one value or a range, in the unit of its channel.
    pub(super) struct ReferenceTable {
        /// Channel that is compared.
        channel: Text,
        /// What of the channel is compared.
        statistic: StatisticChoice = "mean",
        /// The value; or give `range`.
        value: Option<Real<AnyMeasure>>,
        /// The range, where several results differ; or give `value`.
        range: Option<Pair<Real<AnyMeasure>>>,
        /// Where it is from; references of one source are printed together.
        source: Text,
    }
}

choice! {
    /// Numbers out of a history.
    pub(super) enum StatisticChoice {
        /// Over the statistics window.
        Mean = "mean",
        /// Smallest value over the whole run.
        Min = "min",
        /// Largest value over the whole run.
        Max = "max",
    }
}
