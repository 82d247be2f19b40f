//! Results at the nodes of a line, several at a time: those between straight, round, linear
//! elements. The few others go one by one ([`super::nodes`]).

use std::sync::Arc;

use catenix_numerics::lanes::{Kernel, Lane, MOST_LANES, Row, Vec3, atan2, lane_count, vectorised};

use super::super::{NODE_ROWS, Plan, Situation};
use super::links::Pair;
use super::{Dem, Node};
use crate::system::LineLayout;
use crate::system::frame_kernel::FrameState;

const NO_ROW: Row = [0.0; MOST_LANES];

/// What results need to know of the links that begin at the elements of a batch.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct NodeLaws {
    /// How far the connector acts beyond the node [m].
    shift: Row,
    /// One over the smaller bending stiffness of the two elements [1/(N m2)]; 0 without any.
    softness: Row,
    /// One over the length of the following element where there is no bending stiffness [1/m].
    per_length: Row,
}

impl NodeLaws {
    const NONE: NodeLaws = NodeLaws {
        shift: NO_ROW,
        softness: NO_ROW,
        per_length: NO_ROW,
    };

    /// For the links of `dem`, by its batches of elements; neighbours that are alike share them.
    pub(super) fn batches(dem: &Dem, plan: &Plan<'_>) -> Vec<Arc<NodeLaws>> {
        let mut batches = vec![Self::NONE; dem.elements.len()];
        for (layout, line) in plan.layouts.iter().zip(&dem.lines) {
            for (node, place) in line.nodes.iter().enumerate() {
                let Node::Link(index) = *place else { continue };
                let frame = layout.first_frame + node - 1;
                let (batch, lane) = (&mut batches[frame / lane_count()], frame % lane_count());
                batch.shift[lane] = dem.links[index as usize].law.shift;
                let stiffness = |element: usize| {
                    plan.model.line_types[layout.element_types[element]].bending_stiffness[0]
                };
                let bending = stiffness(node - 1).min(stiffness(node));
                if bending > 0.0 {
                    batch.softness[lane] = 1.0 / bending;
                } else {
                    batch.per_length[lane] = 1.0 / layout.length(node);
                }
            }
        }
        let mut shared: Vec<Arc<NodeLaws>> = Vec::with_capacity(batches.len());
        for batch in batches {
            let own = match shared.last() {
                Some(before) if **before == batch => before.clone(),
                _ => Arc::new(batch),
            };
            shared.push(own);
        }
        shared
    }
}

/// Writes the rows of the nodes of a line where there is a link, see [`NODE_ROWS`].
pub(super) fn put(dem: &Dem, at: &Situation<'_>, line: usize, rows: &mut [f64]) {
    let layout = &at.system.lines[line];
    vectorised(Put {
        dem,
        at,
        layout,
        rows,
    });
}

struct Put<'a> {
    dem: &'a Dem,
    at: &'a Situation<'a>,
    layout: &'a LineLayout,
    rows: &'a mut [f64],
}

impl Kernel for Put<'_> {
    type Output = ();

    #[inline(always)]
    fn run<T: Lane>(self, token: T::Token) {
        let Put {
            dem,
            at,
            layout,
            rows,
        } = self;
        let nodes = layout.element_count + 1;
        // Frames that are followed by one of the same line.
        let (first, end) = (
            layout.first_frame,
            layout.first_frame + layout.element_count - 1,
        );
        if end <= first {
            return;
        }
        let mut index = first / T::COUNT;
        let mut pose = FrameState::<T>::load(token, at.state, &dem.elements[index]);
        while index * T::COUNT < end {
            let following = dem.elements.get(index + 1);
            let following = following.unwrap_or(&dem.elements[index]);
            let next = FrameState::<T>::load(token, at.state, following);
            // Without a link in it there is nothing to write.
            let Some(laws) = &dem.linked[index] else {
                pose = next;
                index += 1;
                continue;
            };
            let pair = Pair::new(token, laws, &pose, &next);
            let batch = &*dem.node_laws[index];
            let values = node_values(token, batch, &pair, &pose, &next);
            let start = index * T::COUNT;
            if start >= first && start + T::COUNT <= end {
                let node = start - first + 1;
                let mut row = 0;
                while row < NODE_ROWS {
                    values[row].write_some(&mut rows[row * nodes + node..][..T::COUNT]);
                    row += 1;
                }
            } else {
                let mut row = 0;
                while row < NODE_ROWS {
                    let mut numbers = NO_ROW;
                    values[row].write(&mut numbers);
                    for frame in start.max(first)..end.min(start + T::COUNT) {
                        rows[row * nodes + frame - first + 1] = numbers[frame - start];
                    }
                    row += 1;
                }
            }
            pose = next;
            index += 1;
        }
    }
}

/// Rows of the nodes behind the elements of a batch.
///
/// Source: docs/theory/results.md, eqs. (6) and (7).
#[inline(always)]
fn node_values<T: Lane>(
    token: T::Token,
    batch: &NodeLaws,
    pair: &Pair<T>,
    first: &FrameState<T>,
    following: &FrameState<T>,
) -> [T; NODE_ROWS] {
    let axis = pair.geometry.mean;
    let force = pair.elastic[0] + pair.damping[0];
    let arm = axis * T::read(token, &batch.shift);
    let moment = pair.elastic[1] + pair.damping[1] + arm.cross(force);
    let (tension, shear) = split(force, axis);
    let (torque, bend) = split(moment, axis);
    let one = first.position + pair.arms[0];
    let other = first.position.one_on(following.position) + pair.arms[1];
    let place = (one + other) * T::splat(token, 0.5) - arm;
    let [a, b] = pair.geometry.axes;
    let angle = atan2(a.cross(b).norm_squared().sqrt(), a.dot(b));
    let curvature = bend.mul_add(
        T::read(token, &batch.softness),
        angle * T::read(token, &batch.per_length),
    );
    [
        place.x, place.y, place.z, tension, axis.x, shear, bend, curvature, torque, axis.y, axis.z,
    ]
}

/// What is along an axis, and the length of what is across.
#[inline(always)]
fn split<T: Lane>(v: Vec3<T>, axis: Vec3<T>) -> (T, T) {
    let along = axis.dot(v);
    (along, v.minus(along, axis).norm_squared().sqrt())
}
