//! `[output]`, `[figures.*]` and published values.

use crate::file::define::table;
use crate::file::dimension::{AnyMeasure, Time};
use crate::file::quantity::{Positive, Real};
use crate::file::read::Text;

table! {
    /// What is recorded.
    pub(super) struct OutputTable {
        /// Interval of the time histories.
        interval: Positive<Time> = "0.1 s",
        /// Interval at which every quantity along every line is recorded.
        field_interval: Positive<Time> = "1 s",
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
    /// A number from a publication that the case's result is compared with.
    pub(super) struct PublishedTable {
        /// Channel whose mean over the statistics window is compared.
        channel: Text,
        /// Published value.
        value: Real<AnyMeasure>,
        /// Where it was published.
        source: Text,
    }
}
