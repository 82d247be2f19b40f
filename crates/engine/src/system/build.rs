//! From the model to the assembled system.

use catenix_model::{
    Attachment, Body, EndConnection, Line, LineEnd, LineType, Model, PointLoad, SupportRef,
};
use catenix_numerics::{Chain, Configuration, Matrix3, Topology, Vector3};

use super::ends::end_connector;
use super::loads;
use super::shape::{self, Supports};
use super::{
    Carrier, Connector, ConnectorLaw, Frame, FrameLump, LineLayout, Mount, Place, System,
    SystemError,
};
use crate::body::lump::Lump;
use crate::body::motion::PrescribedMotion;
use crate::element::dem::stiffness::rotary_share;
use crate::hydro::current::CurrentField;
use crate::hydro::morison::DragCoefficients;

/// Share of an element's length within which a lump counts as sitting at the element's end; it is
/// then shared by the two neighbours.
const END_SHARE: f64 = 1e-6;

/// Gravity that weighs a system where there is none [m/s2].
const EARTH_GRAVITY: f64 = 9.80665;

/// Roundings, of the size of the coordinates, that add up in the gap of a connector.
const ROUND_OFF: f64 = 4.0;

pub(super) fn build(model: &Model) -> Result<System, SystemError> {
    if model.lines.is_empty() && model.bodies.is_empty() {
        return Err(SystemError::Empty);
    }
    let vessels: Vec<PrescribedMotion> = model.vessels.iter().map(PrescribedMotion::new).collect();
    let mut frames = Vec::new();
    let mut lumps = Vec::new();
    let mut lines = Vec::new();
    for line in &model.lines {
        let layout = lay_out(line, frames.len());
        for (k, &line_type) in layout.element_types.iter().enumerate() {
            let length = layout.arc_length[k + 1] - layout.arc_length[k];
            frames.push(element_frame(model, &model.line_types[line_type], length));
        }
        for attachment in &line.attachments {
            place_attachment(model, attachment, &layout, &mut lumps);
        }
        lines.push(layout);
    }
    let element_count = frames.len();
    frames.extend(model.bodies.iter().map(|body| body_frame(model, body)));

    let supports = shape::place_supports(model, &vessels, element_count);
    let shape = shape::first_shape(model, &lines, &supports);
    let mut connectors = Vec::new();
    let mut chains = Vec::new();
    for (index, line) in model.lines.iter().enumerate() {
        chains.push(chain(line, &lines[index], element_count));
        connect(
            model,
            index,
            &mut lines[index],
            &shape,
            &supports,
            &mut connectors,
        )?;
    }
    let loads = loads::place(&model.loads, &lines, &shape, element_count);
    let reference_length = model.lines.iter().map(Line::length).fold(1.0, f64::max);
    let reference_force = reference_force(model, &frames, &lumps, reference_length);
    let furthest = shape.position.iter().map(|x| x.amax()).fold(1.0, f64::max);
    Ok(System {
        topology: Topology::new(chains, frames.len()),
        current: CurrentField::new(&model.environment.current),
        model: model.clone(),
        frames,
        lumps,
        loads,
        residual_floor: residual_floor(&connectors, furthest),
        connectors,
        lines,
        vessels,
        first_shape: shape,
        reference_force,
        reference_length,
    })
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

/// Forces below this are round-off: the stiffest spring times the spacing of numbers as large as
/// the coordinates [N].
///
/// Source: docs/theory/solver.md, eq. (8).
fn residual_floor(connectors: &[Connector], furthest: f64) -> f64 {
    let stiffest = connectors
        .iter()
        .map(|connector| connector.law.stiffness())
        .fold(0.0, |largest: f64, k| largest.max(k.stiffest()));
    ROUND_OFF * f64::EPSILON * furthest * stiffest
}

fn lay_out(line: &Line, first_frame: usize) -> LineLayout {
    let mut arc_length = vec![0.0];
    let mut element_types = Vec::new();
    let mut natural = Vec::new();
    let mut end = 0.0;
    for section in &line.sections {
        for length in &section.element_lengths {
            end += length;
            arc_length.push(end);
            element_types.push(section.line_type);
            natural.push(section.natural);
        }
    }
    LineLayout {
        first_frame,
        element_count: element_types.len(),
        nodes: vec![None; arc_length.len()],
        arc_length,
        element_types,
        natural,
    }
}

/// Properties of one element: everything per metre times its length.
///
/// Source: docs/theory/dem.md, eq. (22), and docs/theory/hydrodynamics.md, eqs. (2) to (7).
fn element_frame(model: &Model, line_type: &LineType, length: f64) -> Frame {
    let water = model.environment.fluid_density();
    let area = 0.25 * std::f64::consts::PI * line_type.outer_diameter.powi(2);
    let displaced = water * area * length;
    let mass = line_type.mass * length;
    let radius_squared = length * length / 12.0;
    let added_normal = line_type.normal_added_mass * displaced;
    let half_flow = 0.5 * water * line_type.outer_diameter * length;
    let share = rotary_share(line_type, length);
    let normal_inertia =
        [0, 1].map(|k| mass * radius_squared * share[k] + line_type.rotary_inertia[k] * length);
    Frame {
        axis: Vector3::x(),
        length,
        diameter: line_type.outer_diameter,
        mass,
        inertia: Vector3::new(
            line_type.polar_inertia * length,
            normal_inertia[0],
            normal_inertia[1],
        ),
        drag: DragCoefficients {
            normal: line_type.normal_drag * half_flow,
            axial: line_type.axial_drag * half_flow * std::f64::consts::PI,
            radius_squared,
        },
        added_normal,
        added_axial: line_type.axial_added_mass * displaced,
        added_inertia: added_normal * radius_squared * (0.5 * (share[0] + share[1])),
        weight: mass * model.environment.gravity,
        buoyancy: displaced * model.environment.gravity,
        buoyancy_arm: Vector3::zeros(),
        seabed_length: length,
        residual_length: length,
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
            radius_squared,
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

/// The element that holds an arc length, with the distance from its centre [m] and its share: all,
/// or a half each where two elements meet.
pub(super) fn shares_at(layout: &LineLayout, arc_length: f64) -> Vec<(usize, f64, f64)> {
    let total = layout.arc_length[layout.element_count];
    let at = arc_length.clamp(0.0, total);
    let after = layout.arc_length.partition_point(|&s| s <= at);
    let element = after.saturating_sub(1).min(layout.element_count - 1);
    let (start, end) = (layout.arc_length[element], layout.arc_length[element + 1]);
    let length = end - start;
    if (at - start).abs() < END_SHARE * length && element > 0 {
        let before = start - layout.arc_length[element - 1];
        return vec![
            (element - 1, 0.5 * before, 0.5),
            (element, -0.5 * length, 0.5),
        ];
    }
    if (end - at).abs() < END_SHARE * length && element + 1 < layout.element_count {
        let next = layout.arc_length[element + 2] - end;
        return vec![
            (element, 0.5 * length, 0.5),
            (element + 1, -0.5 * next, 0.5),
        ];
    }
    vec![(element, at - 0.5 * (start + end), 1.0)]
}

/// Puts a lump on the element that holds its arc length, or half on each of two neighbours.
fn place_attachment(
    model: &Model,
    attachment: &Attachment,
    layout: &LineLayout,
    lumps: &mut Vec<FrameLump>,
) {
    let environment = &model.environment;
    let water = environment.fluid_density();
    for (element, offset, share) in shares_at(layout, attachment.arc_length) {
        let weight = share * attachment.mass * environment.gravity;
        let volume = share * attachment.volume;
        lumps.push(FrameLump {
            frame: layout.first_frame + element,
            arm: Vector3::new(offset, 0.0, 0.0),
            lump: Lump {
                mass: share * attachment.mass,
                added_mass: share * in_water(model, attachment.added_mass),
                drag: share * 0.5 * water * attachment.drag_area,
            },
            weight,
            buoyancy: volume * water * environment.gravity,
            diameter: (6.0 * attachment.volume / std::f64::consts::PI).cbrt(),
        });
    }
}

/// What there is in water only: added mass given in kilograms.
fn in_water(model: &Model, added_mass: f64) -> f64 {
    match model.environment.water {
        Some(_) => added_mass,
        None => 0.0,
    }
}

fn chain(line: &Line, layout: &LineLayout, element_count: usize) -> Chain {
    let junction = |end: &LineEnd| match end {
        LineEnd::Connected(EndConnection {
            to: SupportRef::Body(body),
            ..
        }) => Some(element_count + body),
        _ => None,
    };
    Chain {
        first: layout.first_frame,
        len: layout.element_count,
        head: junction(&line.ends[0]),
        tail: junction(&line.ends[1]),
    }
}

/// Adds the connectors of a line, end A to end B.
fn connect(
    model: &Model,
    index: usize,
    layout: &mut LineLayout,
    shape: &Configuration,
    supports: &Supports,
    connectors: &mut Vec<Connector>,
) -> Result<(), SystemError> {
    let line = &model.lines[index];
    let mount = |layout: &LineLayout, element: usize, at_b: bool| Mount {
        carrier: Carrier::Free(layout.first_frame + element),
        arm: Vector3::x() * layout.length(element) * if at_b { 0.5 } else { -0.5 },
        axes: Matrix3::identity(),
    };
    for node in 0..=layout.element_count {
        let end = if node == 0 {
            Some(0)
        } else if node == layout.element_count {
            Some(1)
        } else {
            None
        };
        let connector = match end {
            None => {
                let stiffness = layout.stiffness(model, node);
                let shift = Vector3::x() * stiffness.shift;
                Connector {
                    law: ConnectorLaw::Beam(stiffness),
                    first: mount(layout, node - 1, true).shifted(&shift),
                    second: mount(layout, node, false).shifted(&shift),
                    place: Place::Link(layout.first_frame + node - 1),
                    slide: None,
                }
            }
            Some(end) => {
                let LineEnd::Connected(connection) = &line.ends[end] else {
                    continue;
                };
                let element = if end == 0 {
                    0
                } else {
                    layout.element_count - 1
                };
                let rotation = shape.rotation[layout.first_frame + element];
                end_connector(
                    model,
                    index,
                    layout,
                    end,
                    connection,
                    mount(layout, element, end == 1),
                    &rotation,
                    supports,
                )
            }
        };
        let stiffness = connector.law.stiffness();
        if !(stiffness.axial.is_finite() && stiffness.axial > 0.0 && stiffness.shear.is_finite()) {
            return Err(SystemError::Unusable {
                owner: format!("line '{}'", line.name),
                what: format!(
                    "the axial stiffness at {:.3} m is not a positive number; give its line type \
                     a positive axial stiffness",
                    layout.arc_length[node]
                ),
            });
        }
        layout.nodes[node] = Some(connectors.len());
        connectors.push(connector);
    }
    Ok(())
}
