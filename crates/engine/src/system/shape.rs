//! A first shape for statics, from end positions and lengths alone.
//!
//! Bodies without a given position sink (or rise) as far as their lines let them; each line then
//! hangs between its ends as a circular arc of its own length, in the vertical plane of its ends.
//!
//! Source: docs/theory/statics.md, eqs. (7) and (8).

use catenix_model::{EndConnection, Joint, Line, LineEnd, Model, SupportRef};
use catenix_numerics::{Matrix3, Vector3, so3};

use super::{Carrier, LineLayout};
use crate::body::motion::PrescribedMotion;

/// Rounds of sinking and pulling back within the lines' lengths.
const ROUNDS: usize = 400;

/// Where a line can be connected, in the first shape.
#[derive(Debug, Clone)]
pub(crate) struct Support {
    pub carrier: Carrier,
    pub position: Vector3,
    pub rotation: Matrix3,
}

/// All supports: vessels, then bodies.
#[derive(Debug, Clone)]
pub(crate) struct Supports {
    vessels: Vec<Support>,
    pub bodies: Vec<Support>,
}

impl Supports {
    pub(crate) fn get(&self, to: SupportRef) -> &Support {
        match to {
            SupportRef::Vessel(vessel) => &self.vessels[vessel],
            SupportRef::Body(body) => &self.bodies[body],
        }
    }

    /// Connection point of an end, if it is connected (3) [m].
    pub(crate) fn point(&self, end: &LineEnd) -> Option<Vector3> {
        let LineEnd::Connected(EndConnection {
            to, point_local, ..
        }) = end
        else {
            return None;
        };
        let support = self.get(*to);
        Some(support.position + support.rotation * Vector3::from(*point_local))
    }
}

/// Places vessels where they are at t = 0 and bodies where their lines let them settle.
pub(super) fn place_supports(
    model: &Model,
    vessels: &[PrescribedMotion],
    element_count: usize,
) -> Supports {
    let vessels = vessels
        .iter()
        .enumerate()
        .map(|(index, vessel)| {
            let motion = vessel.at(0.0);
            Support {
                carrier: Carrier::Vessel(index),
                position: motion.position,
                rotation: motion.rotation,
            }
        })
        .collect();
    let bodies = model
        .bodies
        .iter()
        .enumerate()
        .map(|(index, body)| Support {
            carrier: Carrier::Free(element_count + index),
            position: body
                .initial_position
                .map_or_else(Vector3::zeros, Vector3::from),
            rotation: Matrix3::identity(),
        })
        .collect();
    let mut supports = Supports { vessels, bodies };
    settle(model, &mut supports);
    supports
}

/// Net weight of a line in water [N].
fn net_weight(model: &Model, line: &Line) -> f64 {
    let environment = &model.environment;
    let sections: f64 = line
        .sections
        .iter()
        .map(|section| {
            let line_type = &model.line_types[section.line_type];
            let area = 0.25 * std::f64::consts::PI * line_type.outer_diameter.powi(2);
            let length: f64 = section.element_lengths.iter().sum();
            (line_type.mass - environment.fluid_density() * area) * length
        })
        .sum();
    let lumps: f64 = line
        .attachments
        .iter()
        .map(|lump| lump.mass - environment.fluid_density() * lump.volume)
        .sum();
    (sections + lumps) * environment.gravity
}

/// Height of the surface; without water there is none [m].
pub(crate) fn surface(model: &Model) -> f64 {
    match model.environment.water {
        Some(_) => 0.0,
        None => f64::INFINITY,
    }
}

/// Moves the bodies without a given position down (or up) as far as the lines allow.
fn settle(model: &Model, supports: &mut Supports) {
    let environment = &model.environment;
    let fixed: Vec<bool> = model
        .bodies
        .iter()
        .map(|body| body.initial_position.is_some())
        .collect();
    if fixed.iter().all(|&fixed| fixed) {
        return;
    }
    let body_of = |end: &LineEnd| match end {
        LineEnd::Connected(EndConnection {
            to: SupportRef::Body(body),
            ..
        }) => Some(*body),
        _ => None,
    };
    let mut pull: Vec<f64> = model
        .bodies
        .iter()
        .map(|body| (body.mass - environment.fluid_density() * body.volume) * environment.gravity)
        .collect();
    for line in &model.lines {
        for body in line.ends.iter().filter_map(body_of) {
            pull[body] += 0.5 * net_weight(model, line);
        }
    }
    // Start every body at the mean of the vessels that its lines lead to.
    let held: Vec<Vector3> = supports
        .vessels
        .iter()
        .map(|vessel| vessel.position)
        .collect();
    let middle = held.iter().sum::<Vector3>() / held.len().max(1) as f64;
    for (index, body) in supports.bodies.iter_mut().enumerate() {
        if !fixed[index] {
            let ends: Vec<Vector3> = model
                .lines
                .iter()
                .filter(|line| line.ends.iter().any(|end| body_of(end) == Some(index)))
                .flat_map(|line| &line.ends)
                .filter_map(|end| match end {
                    LineEnd::Connected(EndConnection {
                        to: SupportRef::Vessel(vessel),
                        ..
                    }) => Some(held[*vessel]),
                    _ => None,
                })
                .collect();
            body.position = if ends.is_empty() {
                // Apart from each other, so that lines between bodies have a direction.
                middle + Vector3::new(0.1 * index as f64, 0.0, 0.0)
            } else {
                ends.iter().sum::<Vector3>() / ends.len() as f64
            };
        }
    }
    let longest = model.lines.iter().map(Line::length).fold(0.0, f64::max);
    // What floats rises to the surface and no further.
    let surface = surface(model);
    let floor = environment.seabed_height().unwrap_or(f64::NEG_INFINITY);
    for round in 0..ROUNDS {
        let step = longest * 0.05 * (1.0 - round as f64 / ROUNDS as f64);
        for (index, body) in supports.bodies.iter_mut().enumerate() {
            if !fixed[index] {
                let ceiling = body.position.z.max(surface);
                // Without weight and buoyancy nothing pulls.
                let way = if pull[index] == 0.0 {
                    0.0
                } else {
                    step * pull[index].signum()
                };
                body.position.z = (body.position.z - way).min(ceiling).max(floor);
            }
        }
        for line in &model.lines {
            let [Some(a), Some(b)] = [0, 1].map(|end| supports.point(&line.ends[end])) else {
                continue;
            };
            let chord = b - a;
            let excess = chord.norm() - line.length();
            if excess <= 0.0 {
                continue;
            }
            let free = [0, 1].map(|end| body_of(&line.ends[end]).filter(|&body| !fixed[body]));
            let share = excess / free.iter().flatten().count().max(1) as f64;
            let correction = chord.normalize() * share;
            if let Some(body) = free[0] {
                supports.bodies[body].position += correction;
            }
            if let Some(body) = free[1] {
                supports.bodies[body].position -= correction;
            }
        }
    }
}

/// Where a line tends to: down, or up if it is lighter than water.
pub(crate) fn net_direction(model: &Model, line: &Line) -> Vector3 {
    if net_weight(model, line) >= 0.0 {
        -Vector3::z()
    } else {
        Vector3::z()
    }
}

/// Node positions of a line, end A to end B.
pub(crate) fn line_points(
    model: &Model,
    line: &Line,
    layout: &LineLayout,
    supports: &Supports,
) -> Vec<Vector3> {
    let length = line.length();
    if !line.start_shape.is_empty() {
        return along_polyline(line, layout);
    }
    let down = net_direction(model, line);
    let ends = [supports.point(&line.ends[0]), supports.point(&line.ends[1])];
    let away = |end: usize, start: &Vector3| {
        let surface = surface(model);
        loose_direction(
            &line.ends[end],
            end,
            start,
            length,
            &down,
            surface,
            supports,
        ) * length
    };
    let (a, b) = match ends {
        [Some(a), Some(b)] => (a, b),
        [Some(a), None] => (a, a + away(0, &a)),
        [None, Some(b)] => (b + away(1, &b), b),
        [None, None] => (Vector3::zeros(), down * length),
    };
    // Lines start under water, where the water carries them.
    let ceiling = a.z.max(b.z).max(surface(model));
    let floor = model.environment.seabed_height();
    layout
        .arc_length
        .iter()
        .map(|s| {
            let mut point = arc(&a, &b, length, &down, s / length);
            point.z = point.z.min(ceiling);
            if let Some(floor) = floor {
                point.z = point.z.max(floor);
            }
            point
        })
        .collect()
}

/// Node positions along the line's start shape, at equal shares of both lengths.
fn along_polyline(line: &Line, layout: &LineLayout) -> Vec<Vector3> {
    let points: Vec<Vector3> = line.start_shape.iter().map(|p| Vector3::from(*p)).collect();
    let mut distance = vec![0.0];
    for pair in points.windows(2) {
        distance.push(distance[distance.len() - 1] + (pair[1] - pair[0]).norm());
    }
    let total = distance[distance.len() - 1];
    let length = line.length();
    let at = |s: &f64| {
        let way = s / length * total;
        let after = distance.partition_point(|&d| d <= way);
        let piece = after.saturating_sub(1).min(points.len() - 2);
        let share = (way - distance[piece]) / (distance[piece + 1] - distance[piece]);
        points[piece] + (points[piece + 1] - points[piece]) * share
    };
    layout.arc_length.iter().map(at).collect()
}

/// Where a line with one loose end leads from the end that is held: in the direction in which a
/// fixed joint or a hinge holds it, or down (a heavy line), up (a light one under deep enough
/// water), or along the surface.
pub(crate) fn loose_direction(
    held: &LineEnd,
    end: usize,
    start: &Vector3,
    length: f64,
    down: &Vector3,
    surface: f64,
    supports: &Supports,
) -> Vector3 {
    if let LineEnd::Connected(connection) = held
        && matches!(connection.joint, Joint::Fixed | Joint::Hinge { .. })
    {
        let direction =
            supports.get(connection.to).rotation * Vector3::from(connection.direction_local);
        return if end == 0 { direction } else { -direction };
    }
    if start.z + length * down.z > surface {
        Vector3::x()
    } else {
        *down
    }
}

/// Point at a share of a circular arc of `length` from `a` to `b` that sags towards `down`.
fn arc(a: &Vector3, b: &Vector3, length: f64, down: &Vector3, share: f64) -> Vector3 {
    let chord = b - a;
    let distance = chord.norm();
    let ratio = distance / length;
    if ratio > 1.0 - 1e-9 {
        return a + chord * share;
    }
    let along = if distance > 1e-9 * length {
        chord / distance
    } else {
        Vector3::x()
    };
    let across = down - along * along.dot(down);
    let across = if across.norm() > 1e-3 {
        across.normalize()
    } else {
        so3::any_normal(&along)
    };
    // Half the opening angle: sin(angle) / angle = chord / length, by bisection.
    let (mut low, mut high) = (0.0, std::f64::consts::PI);
    for _ in 0..60 {
        let middle: f64 = 0.5 * (low + high);
        if middle.sin() > ratio * middle {
            low = middle
        } else {
            high = middle
        }
    }
    let angle = 0.5 * (low + high);
    let radius = 0.5 * length / angle;
    let at = angle * (2.0 * share - 1.0);
    a + along * (radius * (at.sin() + angle.sin())) + across * (radius * (at.cos() - angle.cos()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elements_are_laid_evenly_along_a_start_shape() {
        let line = Line {
            name: "bent".into(),
            sections: Vec::new(),
            attachments: Vec::new(),
            ends: [LineEnd::Free, LineEnd::Free],
            start_shape: vec![[1.0, 0.0, 0.0], [1.0, 3.0, 0.0], [1.0, 3.0, -1.0]],
        };
        let layout = LineLayout {
            first_frame: 0,
            element_count: 0,
            frame_count: 0,
            arc_length: vec![0.0, 2.0, 6.0, 7.0, 8.0],
            lengths: vec![2.0, 4.0, 1.0, 1.0],
            element_types: Vec::new(),
            natural: Vec::new(),
            tension: Vec::new(),
        };
        // The sections give the line its length of 8 m, twice that of the polyline.
        let line = Line {
            sections: vec![catenix_model::Section {
                line_type: 0,
                element_lengths: vec![2.0, 4.0, 1.0, 1.0],
                natural: catenix_model::NaturalShape::default(),
            }],
            ..line
        };
        let points = along_polyline(&line, &layout);
        let expected = [
            [1.0, 0.0, 0.0],
            [1.0, 1.0, 0.0],
            [1.0, 3.0, 0.0],
            [1.0, 3.0, -0.5],
            [1.0, 3.0, -1.0],
        ];
        for (point, expected) in points.iter().zip(expected) {
            assert!(
                (point - Vector3::from(expected)).norm() < 1e-14,
                "{point} not {expected:?}"
            );
        }
    }

    #[test]
    fn arcs_have_their_length_and_their_ends() {
        let down = -Vector3::z();
        for (b, length) in [
            (Vector3::new(10.0, 0.0, 0.0), 10.5),
            (Vector3::new(10.0, 5.0, -30.0), 90.0),
            (Vector3::zeros(), 7.0),
            (Vector3::new(0.0, 0.0, -5.0), 6.0),
        ] {
            let a = Vector3::zeros();
            let points: Vec<Vector3> = (0..=2000)
                .map(|k| arc(&a, &b, length, &down, k as f64 / 2000.0))
                .collect();
            let total: f64 = points.windows(2).map(|p| (p[1] - p[0]).norm()).sum();
            assert!(
                (total - length).abs() < 1e-5 * length,
                "length {total} of {length}"
            );
            assert!((points[0] - a).norm() + (points[2000] - b).norm() < 1e-6 * length);
            assert!(points[1000].z <= 0.5 * b.z + 1e-9, "sags down");
        }
    }
}
