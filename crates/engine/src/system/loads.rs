//! Point loads on the frames of a system.

use catenix_model::{LoadPlace, PointLoad};
use catenix_numerics::{BlockMatrix, Configuration, Matrix3, MotionState, Vector3, Vector6, six};

use super::{LineLayout, System};
use crate::formulation::{Formulation, Spot};
use crate::load::point::FramePoint;

/// A load, or its share, on one frame.
#[derive(Debug, Clone)]
pub(crate) struct FrameLoad {
    pub frame: usize,
    /// Which point, where the frame is a pair of points.
    pub half: usize,
    /// Index into the model's loads.
    pub load: usize,
    pub point: FramePoint,
}

impl FrameLoad {
    /// Force and moment on the frame, or forces on the two points of a pair, at the full value.
    fn value(&self, system: &System, state: &MotionState) -> Vector6 {
        let value = self.point.at(&state.configuration.rotation[self.frame]);
        match (self.frame < system.pair_count(), self.half) {
            (false, _) => six(&value.force, &value.moment),
            (true, 0) => six(&value.force, &Vector3::zeros()),
            (true, _) => six(&Vector3::zeros(), &value.force),
        }
    }
}

/// Puts the loads of a model on its frames, in their first shape.
pub(super) fn place(
    loads: &[PointLoad],
    layouts: &[LineLayout],
    formulation: &dyn Formulation,
    shape: &Configuration,
    first_body: usize,
) -> Vec<FrameLoad> {
    let mut placed = Vec::new();
    for (index, load) in loads.iter().enumerate() {
        let (force, moment) = (Vector3::from(load.force), Vector3::from(load.moment));
        let mut add = |spot: Spot, to_frame: Matrix3| {
            let turn = if load.follows {
                to_frame
            } else {
                Matrix3::identity()
            };
            placed.push(FrameLoad {
                frame: spot.frame,
                half: spot.half,
                load: index,
                point: FramePoint {
                    arm: spot.arm,
                    force: turn * force * spot.share,
                    moment: turn * moment * spot.share,
                    follows: load.follows,
                },
            });
        };
        match load.place {
            LoadPlace::Line { line, arc_length } => {
                let layout = &layouts[line];
                for spot in formulation.spots(layout, arc_length) {
                    let rotation = &shape.rotation[spot.frame];
                    let to_frame = rotation.transpose() * local_axes(&rotation.column(0).into());
                    add(spot, to_frame);
                }
            }
            LoadPlace::Body { body, point_local } => {
                let spot = Spot {
                    frame: first_body + body,
                    half: 0,
                    arm: Vector3::from(point_local),
                    share: 1.0,
                };
                add(spot, Matrix3::identity());
            }
        }
    }
    placed
}

/// Axes of a follower on a line: x along it, y horizontal (global y where the line is vertical),
/// z = x x y.
fn local_axes(tangent: &Vector3) -> Matrix3 {
    let across = Vector3::z().cross(tangent);
    let y = if across.norm() > 1e-6 {
        across.normalize()
    } else {
        Vector3::y()
    };
    Matrix3::from_columns(&[*tangent, y, tangent.cross(&y)])
}

/// Adds the loads, each times its factor, to the residual and, with `matrix`, their derivatives.
pub(super) fn add_loads(
    system: &System,
    factors: &[f64],
    state: &MotionState,
    residual: &mut [Vector6],
    mut matrix: Option<&mut BlockMatrix>,
) {
    for load in &system.loads {
        let factor = factors[load.load];
        if factor == 0.0 {
            continue;
        }
        residual[load.frame] -= load.value(system, state) * factor;
        if load.frame < system.pair_count() {
            // On a point a force is constant.
            continue;
        }
        let rotation = &state.configuration.rotation[load.frame];
        if let Some(matrix) = matrix.as_deref_mut() {
            let tangent = load.point.tangent(rotation);
            let block = &mut matrix.diagonal[load.frame];
            block.add_quadrant(0, 1, &(tangent.force * -factor));
            block.add_quadrant(1, 1, &(tangent.moment * -factor));
        }
    }
}

/// Adds the full values of some loads.
pub(super) fn add_direction(
    system: &System,
    chosen: &[usize],
    state: &MotionState,
    out: &mut [Vector6],
) {
    for load in system
        .loads
        .iter()
        .filter(|load| chosen.contains(&load.load))
    {
        out[load.frame] += load.value(system, state);
    }
}

/// Power of the loads [W].
pub(super) fn power(system: &System, factors: &[f64], state: &MotionState) -> f64 {
    let powers = system.loads.iter().map(|load| {
        let velocity = &state.velocity[load.frame];
        load.value(system, state).dot(velocity) * factors[load.load]
    });
    powers.sum()
}
