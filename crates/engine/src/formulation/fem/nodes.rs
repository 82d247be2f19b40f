//! Results at the nodes of a line, from what the elements beside them need there.
//!
//! Source: docs/theory/fem.md, eq. (37).

use catenix_model::LineType;
use catenix_numerics::{Matrix3, Vector3, Vector6};

use super::super::{NodeResult, Situation};
use super::element::ends::End;
use super::element::field::Carried;
use super::evaluation::FemEvaluation;
use super::kernel::Kernel;
use crate::formulation::curve::Curve;
use crate::system::LineLayout;

/// Force and moment in a section, of the part towards end B on the part towards end A.
#[derive(Debug, Clone, Copy, Default)]
struct Stress {
    force: Vector3,
    moment: Vector3,
    /// The share of the moment that damping has.
    damping: Vector3,
}

impl Stress {
    /// At one end (0 or 1) of an element.
    fn at<K: Kernel>(
        own: &FemEvaluation<K>,
        element: usize,
        end: usize,
        carried: &[Carried; 2],
    ) -> Stress {
        let needed = own.force(element, end);
        let sign = if end == 0 { -1.0 } else { 1.0 };
        let force: Vector3 = needed.fixed_rows::<3>(0).into();
        let about_frame: Vector3 = needed.fixed_rows::<3>(3).into();
        let moment = about_frame - carried[end].lever.cross(&force);
        let kernel = &own.fem.kernels[element];
        let damping = if kernel.section().damping > 0.0 {
            let still = carried.each_ref().map(|c| End {
                velocity: Vector3::zeros(),
                spin: Vector3::zeros(),
                ..c.end
            });
            let elastic = kernel.forces(&kernel.state(&still)).moment[end];
            let moving = carried.each_ref().map(|c| c.end);
            kernel.forces(&kernel.state(&moving)).moment[end] - elastic
        } else {
            Vector3::zeros()
        };
        Stress {
            force: force * sign,
            moment: moment * sign,
            damping: damping * sign,
        }
    }

    fn mean(a: &Stress, b: &Stress) -> Stress {
        Stress {
            force: (a.force + b.force) * 0.5,
            moment: (a.moment + b.moment) * 0.5,
            damping: (a.damping + b.damping) * 0.5,
        }
    }
}

/// Results at a node.
pub(super) fn node<K: Kernel>(
    own: &FemEvaluation<K>,
    at: &Situation<'_>,
    line: usize,
    node: usize,
) -> NodeResult {
    let layout = &at.system.lines[line];
    let first = own.fem.lines[line].first_element;
    let count = layout.element_count;
    let side = |element: usize, end: usize| {
        let carried = own.fem.parts[first + element].carried(at);
        (
            Stress::at(own, first + element, end, &carried),
            carried[end].end,
        )
    };
    let (stress, end) = match node {
        0 => side(0, 0),
        _ if node == count => side(count - 1, 1),
        _ => {
            let ((before, end), (after, _)) = (side(node - 1, 1), side(node, 0));
            (Stress::mean(&before, &after), end)
        }
    };
    let axis: Vector3 = end.rotation.column(0).into();
    let (tension, shear) = split(&stress.force, &axis);
    let (torque, bend_moment) = split(&stress.moment, &axis);
    let elastic = stress.moment - stress.damping;
    // Where the stiffness jumps, the more flexible side has the larger curvature.
    let sides = [node.saturating_sub(1), node.min(count - 1)];
    let curvature = sides
        .map(|element| {
            let line_type = at.system.element_type(line, element);
            curvature(line_type, layout, element, &end.rotation, &elastic)
        })
        .into_iter()
        .fold(0.0, f64::max);
    let bends = sides.iter().all(|&element| {
        let stiffness = at.system.element_type(line, element).bending_stiffness;
        stiffness.iter().all(|&own| own > 0.0)
    });
    NodeResult {
        position: end.position,
        axis,
        tension,
        shear,
        bend_moment,
        torque,
        curvature: if bends {
            curvature
        } else {
            turning(own, at, first, layout, sides)
        },
    }
}

/// Curvature of a line that bends without moment: the angle between its directions over the length
/// between them.
fn turning<K: Kernel>(
    own: &FemEvaluation<K>,
    at: &Situation<'_>,
    first: usize,
    layout: &LineLayout,
    sides: [usize; 2],
) -> f64 {
    let direction = |element: usize, end: usize| -> Vector3 {
        let carried = own.fem.parts[first + element].carried(at);
        carried[end].end.rotation.column(0).into()
    };
    let (a, b) = (direction(sides[0], 0), direction(sides[1], 1));
    let length = layout.arc_length[sides[1] + 1] - layout.arc_length[sides[0]];
    a.cross(&b).norm().atan2(a.dot(&b)) / length
}

/// Curvature of a section: the natural one, and what the moment adds by the section's law.
///
/// Source: docs/theory/sections.md, eq. (17).
fn curvature(
    line_type: &LineType,
    layout: &LineLayout,
    element: usize,
    rotation: &Matrix3,
    moment: &Vector3,
) -> f64 {
    let local = rotation.transpose() * moment;
    let size = local.y.hypot(local.z);
    let by_moment = match &line_type.bending_law {
        Some(points) if size > 0.0 => {
            let share = Curve::through(points, 1.0).inverse(size) / size;
            [local.y * share, local.z * share]
        }
        Some(_) => [0.0; 2],
        None => {
            let [y, z] = line_type.bending_stiffness;
            let over = |m: f64, stiffness: f64| if stiffness > 0.0 { m / stiffness } else { 0.0 };
            [over(local.y, y), over(local.z, z)]
        }
    };
    let natural = layout.natural[element].curvature;
    (natural[0] + by_moment[0]).hypot(natural[1] + by_moment[1])
}

/// Force and moment, about the connection point, of a line on what its end is connected to.
pub(super) fn end_load<K: Kernel>(
    own: &FemEvaluation<K>,
    at: &Situation<'_>,
    line: usize,
    end: usize,
) -> Vector6 {
    use super::Seat;
    let own_line = &own.fem.lines[line];
    let element = own_line.first_element
        + if end == 0 {
            0
        } else {
            own_line.element_count - 1
        };
    let mut load = Vector6::zeros();
    let part = &own.fem.parts[element];
    let add = |load: &mut Vector6, force: &Vector3, moment: &Vector3| {
        let mut sum = load.fixed_rows_mut::<3>(0);
        sum += force;
        let mut sum = load.fixed_rows_mut::<3>(3);
        sum += moment;
    };
    let needed = own.force(element, end);
    let force: Vector3 = needed.fixed_rows::<3>(0).into();
    let about_frame: Vector3 = needed.fixed_rows::<3>(3).into();
    match &part.seats[end] {
        Seat::Carried(_) => {
            let lever = part.carried(at)[end].lever;
            add(&mut load, &-force, &(lever.cross(&force) - about_frame));
        }
        Seat::Hinged(..) => add(&mut load, &-force, &Vector3::zeros()),
        Seat::Node(_) => {}
    }
    if let Some(idle) = own_line.idle[end].map(|index| &own.fem.idle[index]) {
        add(
            &mut load,
            &(idle.lag(at) * -idle.stiffness),
            &Vector3::zeros(),
        );
    }
    if let Some(index) = own_line.joints[end] {
        let (state, side) = &own.joints[index];
        let [gradient, _] = state.forces(side);
        let force: Vector3 = gradient.fixed_rows::<3>(0).into();
        let moment: Vector3 = gradient.fixed_rows::<3>(3).into();
        add(&mut load, &-force, &(side.lever.cross(&force) - moment));
    }
    load
}

fn split(v: &Vector3, axis: &Vector3) -> (f64, f64) {
    let along = axis.dot(v);
    (along, (v - axis * along).norm())
}
