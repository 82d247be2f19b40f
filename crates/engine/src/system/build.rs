//! From the model to the assembled system.

use std::sync::Arc;

use catenix_model::{
    Attachment, Body, DynamicsSettings, EndConnection, IntegratorSettings, Line, LineEnd, Model,
    PointLoad, SupportRef,
};
use catenix_numerics::{Chain, Topology, Vector3};

use super::carry::Followers;
use super::frame_kernel::FrameBatch;
use super::quantities::WallFactors;
use super::{Frame, FrameLump, LineLayout, System, SystemError, loads, shape};
use crate::body::lump::Lump;
use crate::body::motion::PrescribedMotion;
use crate::formulation::{self, Lines, Plan, Spot};
use crate::hydro::current::CurrentField;
use crate::hydro::morison::DragCoefficients;

/// Gravity that weighs a system where there is none [m/s2].
const EARTH_GRAVITY: f64 = 9.80665;

/// Roundings, of the size of the coordinates, that add up in the gap of a connector.
const ROUND_OFF: f64 = 4.0;

/// `tensions`: expected at the nodes of each line (n_lines x n_nodes) [N]; empty where nothing is
/// known.
pub(super) fn build(model: &Model, tensions: &[Vec<f64>]) -> Result<System, SystemError> {
    if model.lines.is_empty() && model.bodies.is_empty() {
        return Err(SystemError::Empty);
    }
    let family = formulation::family(model.formulation)?;
    let vessels: Vec<PrescribedMotion> = model.vessels.iter().map(PrescribedMotion::new).collect();
    let mut layouts: Vec<LineLayout> = Vec::new();
    let mut line_frames = 0;
    for (index, line) in model.lines.iter().enumerate() {
        let mut layout = lay_out(line, line_frames);
        layout.tension = tensions.get(index).cloned().unwrap_or_default();
        layout.frame_count = (family.frame_count)(model, line, &layout);
        line_frames += layout.frame_count;
        layouts.push(layout);
    }
    let supports = shape::place_supports(model, &vessels, line_frames);
    let Lines {
        mut frames,
        mut shape,
        formulation,
    } = (family.build)(&Plan {
        model,
        layouts: &layouts,
        supports: &supports,
    })?;
    let explicit =
        |dynamics: &DynamicsSettings| dynamics.integrator == IntegratorSettings::Explicit;
    if model.dynamics.as_ref().is_some_and(explicit) && !formulation.has_mass_of_blocks() {
        return Err(SystemError::Unusable {
            owner: "the explicit integrator".to_owned(),
            what: format!(
                "it needs a mass at each point for itself, which the formulation '{}' does not \
                 have; use 'lumped', or an implicit integrator",
                model.formulation.word()
            ),
        });
    }
    for (body, support) in model.bodies.iter().zip(&supports.bodies) {
        frames.push(body_frame(model, body));
        shape.position.push(support.position);
        shape.rotation.push(support.rotation);
    }
    let mut lumps = Vec::new();
    let mut chains = Vec::new();
    for (line, layout) in model.lines.iter().zip(&layouts) {
        for attachment in &line.attachments {
            let spots = formulation.spots(layout, attachment.arc_length);
            lumps.extend(spots.iter().map(|spot| frame_lump(model, attachment, spot)));
        }
        chains.push(chain(line, layout, line_frames));
    }
    let loads = loads::place(&model.loads, &layouts, &*formulation, &shape, line_frames);
    let reference_length = model.lines.iter().map(Line::length).fold(1.0, f64::max);
    let reference_force = reference_force(model, &frames, &lumps, reference_length);
    let places = shape.position.iter().chain(&shape.second);
    let furthest = places.map(|x| x.amax()).fold(1.0, f64::max);
    let followers = Followers::new(model, &vessels, &layouts, &frames, &shape);
    Ok(System {
        followers,
        topology: Topology::new(chains, frames.len()),
        current: CurrentField::new(&model.environment.current),
        model: model.clone(),
        body_batches: FrameBatch::all(&frames, line_frames..frames.len()),
        frames: shared(frames),
        lumps,
        loads,
        // Forces below this are round-off: the stiffest spring times the spacing of numbers as
        // large as the coordinates. Source: docs/theory/solver.md, eq. (8).
        residual_floor: ROUND_OFF * f64::EPSILON * furthest * formulation.stiffest(),
        formulation,
        walls: layouts
            .iter()
            .map(|layout| WallFactors::new(model, layout))
            .collect(),
        lines: layouts,
        vessels,
        first_shape: shape,
        reference_force,
        reference_length,
    })
}

/// Frames of which those that are like the one before share it.
fn shared(frames: Vec<Frame>) -> Vec<Arc<Frame>> {
    let mut list: Vec<Arc<Frame>> = Vec::with_capacity(frames.len());
    for frame in frames {
        let own = match list.last() {
            Some(before) if **before == frame => before.clone(),
            _ => Arc::new(frame),
        };
        list.push(own);
    }
    list
}

/// Force that tolerances are relative to: weight and loads, or, where there is neither, the
/// weight that the masses would have on earth [N].
///
/// Source: docs/theory/solver.md, eq. (7).
fn reference_force(model: &Model, frames: &[Frame], lumps: &[FrameLump], length: f64) -> f64 {
    let weight = frames.iter().map(|frame| frame.weight).sum::<f64>()
        + lumps
            .iter()
            .map(|lump| lump.buoyancy.max(lump.weight))
            .sum::<f64>();
    let size = |load: &PointLoad| {
        Vector3::from(load.force).norm() + Vector3::from(load.moment).norm() / length
    };
    let scale = weight + model.loads.iter().map(size).sum::<f64>();
    if scale > 0.0 {
        return scale;
    }
    let mass = frames.iter().map(|frame| frame.mass).sum::<f64>()
        + lumps.iter().map(|lump| lump.lump.mass).sum::<f64>();
    mass * EARTH_GRAVITY
}

fn lay_out(line: &Line, first_frame: usize) -> LineLayout {
    let count = line.element_count();
    let mut arc_length = Vec::with_capacity(count + 1);
    arc_length.push(0.0);
    let mut lengths = Vec::with_capacity(count);
    let mut element_types = Vec::with_capacity(count);
    let mut natural = Vec::with_capacity(count);
    let mut end = 0.0;
    for section in &line.sections {
        for length in &section.element_lengths {
            end += length;
            arc_length.push(end);
            lengths.push(*length);
            element_types.push(section.line_type);
            natural.push(section.natural);
        }
    }
    LineLayout {
        first_frame,
        element_count: count,
        frame_count: 0,
        arc_length,
        lengths,
        element_types,
        natural,
        tension: Vec::new(),
    }
}

fn body_frame(model: &Model, body: &Body) -> Frame {
    let water = model.environment.fluid_density();
    let radius_squared = body.length * body.length / 12.0;
    let sphere = (6.0 * body.volume / std::f64::consts::PI).cbrt();
    let gyration = (body.inertia.iter().fold(0.0f64, |a, &b| a.max(b)) / body.mass).sqrt();
    Frame {
        axis: Vector3::z(),
        length: body.length,
        diameter: if body.length > 0.0 {
            (4.0 * body.volume / (std::f64::consts::PI * body.length)).sqrt()
        } else {
            sphere
        },
        mass: body.mass,
        inertia: Vector3::from(body.inertia),
        drag: DragCoefficients {
            normal: 0.5 * water * body.normal_drag_area,
            axial: 0.5 * water * body.axial_drag_area,
            radius: radius_squared.sqrt(),
        },
        added_normal: in_water(model, body.normal_added_mass),
        added_axial: in_water(model, body.axial_added_mass),
        added_inertia: in_water(model, body.normal_added_mass) * radius_squared,
        weight: body.mass * model.environment.gravity,
        buoyancy: water * body.volume * model.environment.gravity,
        buoyancy_arm: Vector3::from(body.centre_of_buoyancy),
        seabed_length: body.length.max(sphere),
        residual_length: body.length.max(gyration).max(1e-3),
    }
}

/// The share of an attachment on one frame.
fn frame_lump(model: &Model, attachment: &Attachment, spot: &Spot) -> FrameLump {
    let environment = &model.environment;
    let water = environment.fluid_density();
    let share = spot.share;
    FrameLump {
        frame: spot.frame,
        half: spot.half,
        arm: spot.arm,
        lump: Lump {
            mass: share * attachment.mass,
            added_mass: share * in_water(model, attachment.added_mass),
            drag: share * 0.5 * water * attachment.drag_area,
        },
        weight: share * attachment.mass * environment.gravity,
        buoyancy: share * attachment.volume * water * environment.gravity,
        diameter: (6.0 * attachment.volume / std::f64::consts::PI).cbrt(),
    }
}

/// What there is in water only: added mass given in kilograms.
fn in_water(model: &Model, added_mass: f64) -> f64 {
    match model.environment.water {
        Some(_) => added_mass,
        None => 0.0,
    }
}

fn chain(line: &Line, layout: &LineLayout, line_frames: usize) -> Chain {
    let junction = |end: &LineEnd| match end {
        LineEnd::Connected(EndConnection {
            to: SupportRef::Body(body),
            ..
        }) => Some(line_frames + body),
        _ => None,
    };
    Chain {
        first: layout.first_frame,
        len: layout.frame_count,
        head: junction(&line.ends[0]),
        tail: junction(&line.ends[1]),
    }
}
