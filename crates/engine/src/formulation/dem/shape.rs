//! The first shape of the elements of a line.

use catenix_model::{Line, Model};
use catenix_numerics::{Configuration, Matrix3, Vector3, so3};

use super::super::Plan;
use super::natural;
use crate::system::LineLayout;
use crate::system::shape::{Supports, line_points, loose_direction, net_direction, surface};

/// Positions and rotations of all elements along the first shapes of their lines.
pub(super) fn first_shape(plan: &Plan<'_>) -> Configuration {
    let Plan {
        model,
        layouts,
        supports,
    } = *plan;
    let mut shape = Configuration::default();
    // Bodies follow the elements.
    let counts = layouts.iter().map(|layout| layout.element_count);
    let count = counts.sum::<usize>() + model.bodies.len();
    shape.position.reserve_exact(count);
    shape.rotation.reserve_exact(count);
    for (line, layout) in model.lines.iter().zip(layouts) {
        if natural::has_directions(model, line) {
            for (position, rotation) in directed_line(model, line, layout, supports) {
                shape.position.push(position);
                shape.rotation.push(rotation);
            }
            continue;
        }
        let points = line_points(model, line, layout, supports);
        let mut rotation = Matrix3::identity();
        for k in 0..layout.element_count {
            let chord = points[k + 1] - points[k];
            let tangent = if chord.norm() > 0.0 {
                chord.normalize()
            } else {
                -Vector3::z()
            };
            // Carried along without twist.
            rotation = if k == 0 {
                so3::frame_from_direction(&tangent, &so3::any_normal(&tangent))
            } else {
                let before: Vector3 = rotation.column(0).into();
                so3::shortest_arc(&before, &tangent) * rotation
            };
            shape.position.push((points[k] + points[k + 1]) * 0.5);
            shape.rotation.push(rotation);
        }
    }
    shape
}

/// Elements of a line whose sections have directions: along the same shapes as other lines, but
/// a curved line that is not held at both ends starts in its stress-free shape.
fn directed_line(
    model: &Model,
    line: &Line,
    layout: &LineLayout,
    supports: &Supports,
) -> Vec<(Vector3, Matrix3)> {
    let ends = [supports.point(&line.ends[0]), supports.point(&line.ends[1])];
    let loose = ends.iter().any(Option::is_none);
    if natural::is_curved(line) && loose && line.start_shape.is_empty() {
        let held = usize::from(ends[0].is_none() && ends[1].is_some());
        let point = ends[held].unwrap_or_else(Vector3::zeros);
        let sign = if held == 0 { 1.0 } else { -1.0 };
        let length = line.length();
        let down = net_direction(model, line);
        let surface = surface(model);
        let end = &line.ends[held];
        let away = loose_direction(end, held, &point, length, &down, surface, supports);
        let direction = away * sign;
        return natural::stress_free(model, line, layout, held, &point, &direction, supports);
    }
    let points = line_points(model, line, layout, supports);
    let tangents: Vec<Vector3> = points
        .windows(2)
        .map(|pair| {
            let tangent = (pair[1] - pair[0]).try_normalize(0.0);
            tangent.unwrap_or_else(|| -Vector3::z())
        })
        .collect();
    let rotations = natural::rotations_along(model, line, layout, &tangents, supports);
    let middle = points.windows(2).map(|pair| (pair[0] + pair[1]) * 0.5);
    middle.zip(rotations).collect()
}
