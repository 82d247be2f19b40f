//! What a case looks like before it moves: enough of the model to draw it beside its results.

use catenix_model::{Attachment, Joint, Line, LineEnd, Model, SupportRef};
use serde::{Deserialize, Serialize};

/// What a viewer draws around the results of a case. The keys are a public interface, described in
/// docs/results.md.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Scene {
    /// Depth of the water [m]; null without water.
    pub water_depth_m: Option<f64>,
    /// Whether lines and bodies meet the seabed; without, they may pass through it.
    pub seabed: bool,
    /// Current over depth, by increasing depth; empty without current.
    pub current: Vec<SceneCurrent>,
    /// Factor on the current over time: time [s], factor [-]; empty: 1.
    pub current_factor: Vec<(f64, f64)>,
    /// Vessels and anchors, in the order of the model file.
    pub vessels: Vec<SceneVessel>,
    /// Bodies, in the order of the model file.
    pub bodies: Vec<SceneBody>,
    /// Lines, in the order of the model file.
    pub lines: Vec<SceneLine>,
}

/// One point of a current profile.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SceneCurrent {
    /// Depth below the mean surface [m].
    pub depth_m: f64,
    /// Velocity towards which the water flows, global x and y [m/s].
    pub velocity_m_s: [f64; 2],
}

/// A vessel or anchor.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SceneVessel {
    /// Name.
    pub name: String,
    /// Position at rest, global (3) [m].
    pub position_m: [f64; 3],
    /// From global x to local x, about global z [deg].
    pub heading_deg: f64,
    /// Whether a motion is prescribed; an anchor stays.
    pub moves: bool,
    /// `ship`, `platform`, `buoy`, `crawler` or `anchor`; null where the model does not say, absent
    /// in stores of earlier versions.
    #[serde(default)]
    pub shape: Option<String>,
    /// Length from end to end [m]; null where the model does not say, absent in stores of earlier
    /// versions.
    #[serde(default)]
    pub length_m: Option<f64>,
}

/// A body.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SceneBody {
    /// Name.
    pub name: String,
    /// Length along its z axis [m]; 0 where the model gives none.
    pub length_m: f64,
    /// Displaced volume [m3].
    pub volume_m3: f64,
    /// Mass [kg].
    pub mass_kg: f64,
    /// Vessel against which its offset is reported.
    pub offset_vessel: Option<String>,
}

/// A line.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SceneLine {
    /// Name.
    pub name: String,
    /// Unstretched length [m].
    pub length_m: f64,
    /// Number of elements; one less than the nodes.
    pub elements: usize,
    /// Sections from end A to end B.
    pub sections: Vec<SceneSection>,
    /// Floats, weights and pumps on the line, by arc length.
    pub attachments: Vec<SceneAttachment>,
    /// End A and end B; null where nothing holds it.
    pub ends: [Option<SceneEnd>; 2],
}

/// A stretch of a line with one cross section.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SceneSection {
    /// Name of the line type.
    pub line_type: String,
    /// Distance of its end from end A [m].
    pub end_m: f64,
    /// Outer diameter [m].
    pub outer_diameter_m: f64,
}

/// A lump on a line.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SceneAttachment {
    /// Name.
    pub name: String,
    /// Distance from end A [m].
    pub arc_length_m: f64,
    /// Displaced volume [m3].
    pub volume_m3: f64,
    /// Weight less buoyancy, fully under water [N]; negative for a float.
    pub wet_weight_n: f64,
}

/// What holds an end of a line.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SceneEnd {
    /// Name of the vessel, anchor or body.
    pub to: String,
    /// `ball`, `flex joint`, `universal`, `hinge` or `fixed`.
    pub joint: String,
    /// Connection point in the axes of what holds it (3) [m].
    pub point_m: [f64; 3],
}

impl Scene {
    /// The scene of a model.
    pub fn new(model: &Model) -> Self {
        let environment = &model.environment;
        let vessel_name = |index: usize| model.vessels[index].name.clone();
        Scene {
            water_depth_m: environment.water.map(|water| water.depth),
            seabed: environment.seabed.is_some(),
            current: environment
                .current
                .profile
                .iter()
                .map(|point| SceneCurrent {
                    depth_m: point.depth,
                    velocity_m_s: point.velocity,
                })
                .collect(),
            current_factor: environment.current.factor.clone(),
            vessels: model
                .vessels
                .iter()
                .map(|vessel| SceneVessel {
                    name: vessel.name.clone(),
                    position_m: vessel.position,
                    heading_deg: vessel.heading.to_degrees(),
                    moves: !vessel.motions.is_empty(),
                    shape: vessel.appearance.shape.map(|shape| shape.word().to_owned()),
                    length_m: vessel.appearance.length,
                })
                .collect(),
            bodies: model
                .bodies
                .iter()
                .map(|body| SceneBody {
                    name: body.name.clone(),
                    length_m: body.length,
                    volume_m3: body.volume,
                    mass_kg: body.mass,
                    offset_vessel: body.offset_vessel.map(vessel_name),
                })
                .collect(),
            lines: model
                .lines
                .iter()
                .map(|line| scene_line(line, model))
                .collect(),
        }
    }
}

fn scene_line(line: &Line, model: &Model) -> SceneLine {
    let mut end_m = 0.0;
    let sections = line.sections.iter().map(|section| {
        let line_type = &model.line_types[section.line_type];
        end_m += section.element_lengths.iter().sum::<f64>();
        SceneSection {
            line_type: line_type.name.clone(),
            end_m,
            outer_diameter_m: line_type.outer_diameter,
        }
    });
    SceneLine {
        name: line.name.clone(),
        length_m: line.length(),
        elements: line.element_count(),
        sections: sections.collect(),
        attachments: line
            .attachments
            .iter()
            .map(|lump| scene_attachment(lump, model))
            .collect(),
        ends: [0, 1].map(|end| scene_end(&line.ends[end], model)),
    }
}

fn scene_attachment(lump: &Attachment, model: &Model) -> SceneAttachment {
    let environment = &model.environment;
    SceneAttachment {
        name: lump.name.clone(),
        arc_length_m: lump.arc_length,
        volume_m3: lump.volume,
        wet_weight_n: environment.gravity * (lump.mass - environment.fluid_density() * lump.volume),
    }
}

fn scene_end(end: &LineEnd, model: &Model) -> Option<SceneEnd> {
    let LineEnd::Connected(connection) = end else {
        return None;
    };
    let to = match connection.to {
        SupportRef::Vessel(index) => &model.vessels[index].name,
        SupportRef::Body(index) => &model.bodies[index].name,
    };
    Some(SceneEnd {
        to: to.clone(),
        joint: joint_word(&connection.joint).to_owned(),
        point_m: connection.point_local,
    })
}

/// A joint in words, for overviews and drawings.
pub(crate) fn joint_word(joint: &Joint) -> &'static str {
    match joint {
        Joint::Ball {
            rotational_stiffness: 0.0,
        } => "ball",
        Joint::Ball { .. } => "flex joint",
        Joint::Universal { .. } => "universal",
        Joint::Hinge { .. } => "hinge",
        Joint::Fixed => "fixed",
    }
}
