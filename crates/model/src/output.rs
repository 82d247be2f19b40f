//! What is recorded, and under which names.

use serde::{Deserialize, Serialize};

use crate::Model;

/// Settings of the result store.
#[derive(Debug, Clone, PartialEq)]
pub struct OutputSettings {
    /// Interval of the time histories [s].
    pub interval: f64,
    /// Interval of the line fields (every quantity along every line) [s].
    pub field_interval: f64,
    /// Whether results at output times are interpolated between steps; if not, steps end there.
    pub interpolate: bool,
    /// Channels beyond the standard ones, as written by the user and resolved.
    pub channels: Vec<Channel>,
}

/// A named time history with its unit, for example `buffer.offset_x` [m].
#[derive(Debug, Clone, PartialEq)]
pub struct Channel {
    /// `<object>.<quantity>`, or `<line>.<quantity>@<arc length>m`.
    pub name: String,
    /// Unit as printed, for example `"m"`, `"N"`, `"deg"`.
    pub unit: &'static str,
    /// What is recorded.
    pub target: ChannelTarget,
}

/// A coordinate direction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Axis {
    /// Global x.
    X,
    /// Global y.
    Y,
    /// Global z, up.
    Z,
}

impl Axis {
    /// All three, in order.
    pub const ALL: [Axis; 3] = [Axis::X, Axis::Y, Axis::Z];

    /// Lower-case letter.
    pub fn letter(self) -> char {
        ['x', 'y', 'z'][self as usize]
    }
}

/// One of the three angles of an orientation: R = Rz(heading) Ry(pitch) Rx(roll), from local to
/// global axes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Angle {
    /// About the local x axis.
    Roll,
    /// About the y axis after heading.
    Pitch,
    /// About global z, from global x towards y.
    Heading,
}

impl Angle {
    /// All three, in the order of arrays that hold them.
    pub const ALL: [Angle; 3] = [Angle::Roll, Angle::Pitch, Angle::Heading];

    /// Name in channels.
    pub fn name(self) -> &'static str {
        ["roll", "pitch", "heading"][self as usize]
    }
}

/// What a channel records.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ChannelTarget {
    /// Position of a body's origin, global [m].
    BodyPosition(usize, Axis),
    /// Position of a body's origin less that of its offset vessel, global [m].
    BodyOffset(usize, Axis),
    /// Angle of a body's local z axis from the vertical [deg].
    BodyTilt(usize),
    /// An angle of a body's orientation [deg].
    BodyAngle(usize, Angle),
    /// Position of a vessel's origin, global [m].
    VesselPosition(usize, Axis),
    /// An angle of a vessel's orientation [deg].
    VesselAngle(usize, Angle),
    /// Force of a line on what its end (0 for A, 1 for B) is connected to, global [N].
    EndForce(usize, usize, Axis),
    /// Moment of a line on what its end is connected to, about the connection point, global [N m].
    EndMoment(usize, usize, Axis),
    /// Effective tension at an end of a line [N].
    EndTension(usize, usize),
    /// Angle at an end of a line between the line and the vertical [deg].
    EndDeclination(usize, usize),
    /// A line quantity at an unstretched distance from end A: line, quantity, distance [m]. Linear
    /// between the nodes.
    LinePoint(usize, LineQuantity, f64),
}

/// A result along a line, given at its nodes: end A, between each two elements, end B
/// (n_elements + 1 values).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum LineQuantity {
    /// Position, global x [m].
    X,
    /// Position, global y [m].
    Y,
    /// Position, global z [m].
    Z,
    /// Effective tension [N].
    EffectiveTension,
    /// Tension in the wall [N].
    WallTension,
    /// Resultant shear force [N].
    ShearForce,
    /// Resultant bending moment [N m].
    BendMoment,
    /// Resultant curvature [1/m].
    Curvature,
    /// Torque [N m].
    Torque,
    /// Largest von Mises stress in the wall [Pa]; NaN where the line type has no wall.
    VonMisesStress,
    /// Angle between the line (from A to B) and the downward vertical [deg].
    Declination,
}

impl LineQuantity {
    /// All quantities, in the order of every array that holds them.
    pub const ALL: [LineQuantity; 11] = [
        LineQuantity::X,
        LineQuantity::Y,
        LineQuantity::Z,
        LineQuantity::EffectiveTension,
        LineQuantity::WallTension,
        LineQuantity::ShearForce,
        LineQuantity::BendMoment,
        LineQuantity::Curvature,
        LineQuantity::Torque,
        LineQuantity::VonMisesStress,
        LineQuantity::Declination,
    ];

    /// Name in files and channels.
    pub fn name(self) -> &'static str {
        match self {
            LineQuantity::X => "x",
            LineQuantity::Y => "y",
            LineQuantity::Z => "z",
            LineQuantity::EffectiveTension => "effective_tension",
            LineQuantity::WallTension => "wall_tension",
            LineQuantity::ShearForce => "shear_force",
            LineQuantity::BendMoment => "bend_moment",
            LineQuantity::Curvature => "curvature",
            LineQuantity::Torque => "torque",
            LineQuantity::VonMisesStress => "von_mises_stress",
            LineQuantity::Declination => "declination",
        }
    }

    /// Unit as printed.
    pub fn unit(self) -> &'static str {
        match self {
            LineQuantity::X | LineQuantity::Y | LineQuantity::Z => "m",
            LineQuantity::EffectiveTension
            | LineQuantity::WallTension
            | LineQuantity::ShearForce => "N",
            LineQuantity::BendMoment | LineQuantity::Torque => "N m",
            LineQuantity::Curvature => "1/m",
            LineQuantity::VonMisesStress => "Pa",
            LineQuantity::Declination => "deg",
        }
    }

    /// Position in [`LineQuantity::ALL`].
    pub fn index(self) -> usize {
        self as usize
    }
}

/// A result from elsewhere that a case's own is compared with: of a publication, a measurement, or
/// other programs.
#[derive(Debug, Clone, PartialEq)]
pub struct Reference {
    /// Channel that is compared.
    pub channel: Channel,
    /// What of the channel is compared.
    pub statistic: Statistic,
    /// Lower end of the range, in the channel's unit.
    pub low: f64,
    /// Upper end of the range, in the channel's unit; the lower one when it is a single value.
    pub high: f64,
    /// Where it is from.
    pub source: String,
}

/// One number out of a channel's history.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Statistic {
    /// Mean over the statistics window.
    Mean,
    /// Smallest value over the whole run, t = 0 included.
    Min,
    /// Largest value over the whole run, t = 0 included.
    Max,
}

impl Statistic {
    /// The word that is written and printed.
    pub fn word(self) -> &'static str {
        match self {
            Statistic::Mean => "mean",
            Statistic::Min => "min",
            Statistic::Max => "max",
        }
    }
}

/// A figure: one channel against time, one curve per load case.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// Key in the model file and stem of the file name.
    pub name: String,
    /// Title above the axes.
    pub title: String,
    /// Channel that is drawn; present in every case.
    pub channel: Channel,
}

/// The channels that are always recorded, in a fixed order: vessels, bodies, line ends; then the
/// user's own.
pub fn all_channels(model: &Model) -> Vec<Channel> {
    let vessels = model.vessels.iter().enumerate();
    let bodies = model.bodies.iter().enumerate();
    let lines = model.lines.iter().enumerate();
    let mut channels: Vec<Channel> = vessels
        .flat_map(|(index, vessel)| vessel_channels(index, &vessel.name))
        .chain(bodies.flat_map(|(index, body)| {
            body_channels(index, &body.name, body.offset_vessel.is_some())
        }))
        .chain(lines.flat_map(|(index, line)| line_channels(index, &line.name)))
        .collect();
    for channel in &model.output.channels {
        if !channels.contains(channel) {
            channels.push(channel.clone());
        }
    }
    channels
}

/// Channels of a vessel or anchor.
pub(crate) fn vessel_channels(index: usize, name: &str) -> Vec<Channel> {
    let mut channels = per_axis(name, "", "m", |axis| {
        ChannelTarget::VesselPosition(index, axis)
    });
    channels.extend(per_angle(name, |angle| {
        ChannelTarget::VesselAngle(index, angle)
    }));
    channels
}

/// Channels of a body.
pub(crate) fn body_channels(index: usize, name: &str, has_offset: bool) -> Vec<Channel> {
    let mut channels = per_axis(name, "", "m", |axis| {
        ChannelTarget::BodyPosition(index, axis)
    });
    if has_offset {
        let offset = |axis| ChannelTarget::BodyOffset(index, axis);
        channels.extend(per_axis(name, "offset_", "m", offset));
    }
    let target = ChannelTarget::BodyTilt(index);
    channels.push(Channel {
        name: format!("{name}.tilt"),
        unit: "deg",
        target,
    });
    channels.extend(per_angle(name, |angle| {
        ChannelTarget::BodyAngle(index, angle)
    }));
    channels
}

/// Channels of the two ends of a line.
pub(crate) fn line_channels(index: usize, name: &str) -> Vec<Channel> {
    let mut channels = Vec::new();
    for (end, label) in ["end_a", "end_b"].into_iter().enumerate() {
        let prefix = format!("{name}.{label}");
        let force = |axis| ChannelTarget::EndForce(index, end, axis);
        channels.extend(per_axis(&prefix, "force_", "N", force));
        let moment = |axis| ChannelTarget::EndMoment(index, end, axis);
        channels.extend(per_axis(&prefix, "moment_", "N m", moment));
        channels.push(Channel {
            name: format!("{prefix}.effective_tension"),
            unit: "N",
            target: ChannelTarget::EndTension(index, end),
        });
        channels.push(Channel {
            name: format!("{prefix}.declination"),
            unit: "deg",
            target: ChannelTarget::EndDeclination(index, end),
        });
    }
    channels
}

fn per_axis(
    object: &str,
    quantity: &str,
    unit: &'static str,
    target: impl Fn(Axis) -> ChannelTarget,
) -> Vec<Channel> {
    let channel = |axis: Axis| Channel {
        name: format!("{object}.{quantity}{}", axis.letter()),
        unit,
        target: target(axis),
    };
    Axis::ALL.map(channel).into()
}

fn per_angle(object: &str, target: impl Fn(Angle) -> ChannelTarget) -> Vec<Channel> {
    let channel = |angle: Angle| Channel {
        name: format!("{object}.{}", angle.name()),
        unit: "deg",
        target: target(angle),
    };
    Angle::ALL.map(channel).into()
}
