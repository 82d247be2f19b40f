//! Overview of a model: what it consists of, how heavy it is, what acts on it.

use catenix_model::{
    Attachment, Environment, Line, LineEnd, LineType, LoadPlace, LoadVariation, Model, PointLoad,
    StepControl, SupportRef,
};
use indexmap::IndexMap;
use serde::Serialize;

use crate::scene::joint_word;

/// What a model consists of. The keys are a public interface, described in docs/cli.md.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ModelOverview {
    /// Depth of the water [m]; null without water.
    pub water_depth_m: Option<f64>,
    /// Current at the surface; null without current.
    pub surface_current: Option<CurrentOverview>,
    /// Elements of all lines.
    pub elements: usize,
    /// Simulated time [s]; null when the model describes statics only.
    pub duration_s: Option<f64>,
    /// Largest time step [s]; null when the model describes statics only.
    pub step_s: Option<f64>,
    /// Lines by name.
    pub lines: IndexMap<String, LineOverview>,
    /// Bodies by name.
    pub bodies: IndexMap<String, BodyOverview>,
    /// Vessels and anchors by name.
    pub vessels: IndexMap<String, VesselOverview>,
    /// Point loads by name.
    pub loads: IndexMap<String, LoadOverview>,
}

/// A point load in an overview.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LoadOverview {
    /// Line or body that it acts on.
    pub on: String,
    /// On a line: unstretched distance from end A [m]; null on a body.
    pub arc_length_m: Option<f64>,
    /// Force (3) [N]: global, or in local axes when it follows.
    pub force_n: [f64; 3],
    /// Moment (3) [N m]: global, or in local axes when it follows.
    pub moment_n_m: [f64; 3],
    /// Whether it turns with what it acts on.
    pub follows: bool,
    /// Whether it changes over time.
    pub varies: bool,
}

/// Current at the surface.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct CurrentOverview {
    /// Speed [m/s].
    pub speed_m_s: f64,
    /// Direction towards which the water flows, from x towards y [deg].
    pub heading_deg: f64,
}

/// A line in an overview.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LineOverview {
    /// Unstretched length [m].
    pub length_m: f64,
    /// Number of elements.
    pub elements: usize,
    /// Shortest and longest element [m].
    pub element_length_m: [f64; 2],
    /// Number of attachments.
    pub attachments: usize,
    /// Mass with content and attachments [kg].
    pub mass_kg: f64,
    /// Weight less buoyancy, fully under water, with attachments [N].
    pub wet_weight_n: f64,
    /// What end A is connected to, and how.
    pub end_a: String,
    /// What end B is connected to, and how.
    pub end_b: String,
}

/// A body in an overview.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BodyOverview {
    /// Mass [kg].
    pub mass_kg: f64,
    /// Weight less buoyancy, fully under water [N].
    pub wet_weight_n: f64,
    /// Vessel against which offsets are reported.
    pub offset_vessel: Option<String>,
}

/// A vessel or anchor in an overview.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct VesselOverview {
    /// Position at rest, global (3) [m].
    pub position_m: [f64; 3],
    /// Number of motions that are added up; 0 for an anchor.
    pub motions: usize,
}

impl ModelOverview {
    /// The overview of a model.
    pub fn new(model: &Model) -> Self {
        let environment = &model.environment;
        let lines = model
            .lines
            .iter()
            .map(|line| (line.name.clone(), line_overview(line, model)))
            .collect();
        let bodies = model.bodies.iter().map(|body| {
            let overview = BodyOverview {
                mass_kg: body.mass,
                wet_weight_n: wet_weight_n(body.mass, body.volume, environment),
                offset_vessel: body
                    .offset_vessel
                    .map(|index| model.vessels[index].name.clone()),
            };
            (body.name.clone(), overview)
        });
        let vessels = model.vessels.iter().map(|vessel| {
            let overview = VesselOverview {
                position_m: vessel.position,
                motions: vessel.motions.len(),
            };
            (vessel.name.clone(), overview)
        });
        ModelOverview {
            water_depth_m: environment.water.map(|water| water.depth),
            surface_current: surface_current(environment),
            elements: model.lines.iter().map(Line::element_count).sum(),
            duration_s: model.dynamics.as_ref().map(|dynamics| dynamics.duration),
            step_s: model.dynamics.as_ref().map(|dynamics| match dynamics.step {
                StepControl::Fixed(step) => step,
                StepControl::Adaptive { max, .. } => max,
            }),
            lines,
            bodies: bodies.collect(),
            vessels: vessels.collect(),
            loads: model
                .loads
                .iter()
                .map(|load| load_overview(load, model))
                .collect(),
        }
    }
}

fn load_overview(load: &PointLoad, model: &Model) -> (String, LoadOverview) {
    let (on, arc_length_m) = match load.place {
        LoadPlace::Line { line, arc_length } => (&model.lines[line].name, Some(arc_length)),
        LoadPlace::Body { body, .. } => (&model.bodies[body].name, None),
    };
    let overview = LoadOverview {
        on: on.clone(),
        arc_length_m,
        force_n: load.force,
        moment_n_m: load.moment,
        follows: load.follows,
        varies: load.variation != LoadVariation::Constant,
    };
    (load.name.clone(), overview)
}

fn line_overview(line: &Line, model: &Model) -> LineOverview {
    let types: &[LineType] = &model.line_types;
    let lengths = || {
        line.sections
            .iter()
            .flat_map(|section| &section.element_lengths)
            .copied()
    };
    let over_sections = |per_metre: &dyn Fn(&LineType) -> f64| -> f64 {
        line.sections
            .iter()
            .map(|s| per_metre(&types[s.line_type]) * s.element_lengths.iter().sum::<f64>())
            .sum()
    };
    let over_attachments =
        |value: fn(&Attachment) -> f64| line.attachments.iter().map(value).sum::<f64>();
    let mass = over_sections(&|line_type| line_type.mass) + over_attachments(|lump| lump.mass);
    let section_area =
        |line_type: &LineType| 0.25 * std::f64::consts::PI * line_type.outer_diameter.powi(2);
    let volume = over_sections(&section_area) + over_attachments(|lump| lump.volume);
    let end = |index: usize| end_text(&line.ends[index], model);
    LineOverview {
        length_m: line.length(),
        elements: line.element_count(),
        element_length_m: [
            lengths().fold(f64::INFINITY, f64::min),
            lengths().fold(0.0, f64::max),
        ],
        attachments: line.attachments.len(),
        mass_kg: mass,
        wet_weight_n: wet_weight_n(mass, volume, &model.environment),
        end_a: end(0),
        end_b: end(1),
    }
}

/// Weight less buoyancy, fully under water [N].
fn wet_weight_n(mass: f64, volume: f64, environment: &Environment) -> f64 {
    environment.gravity * (mass - environment.fluid_density() * volume)
}

fn surface_current(environment: &Environment) -> Option<CurrentOverview> {
    let [x, y] = environment.current.profile.first()?.velocity;
    let heading_deg = y.atan2(x).to_degrees();
    Some(CurrentOverview {
        speed_m_s: x.hypot(y),
        heading_deg,
    })
}

fn end_text(end: &LineEnd, model: &Model) -> String {
    let LineEnd::Connected(connection) = end else {
        return "free".to_owned();
    };
    let support = match connection.to {
        SupportRef::Vessel(index) => &model.vessels[index].name,
        SupportRef::Body(index) => &model.bodies[index].name,
    };
    format!("{support} ({})", joint_word(&connection.joint))
}
