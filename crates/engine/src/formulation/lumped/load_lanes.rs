//! Inertia and loads of the nodes between the ends of lines, several at a time: what `loads.rs`
//! computes for one.
//!
//! Source: docs/theory/lumped.md, eqs. (18) to (22).

use catenix_numerics::lanes::{
    Kernel, Lane, MOST_LANES, Mat3, Row, Vec3, add_records, gather, lane_count, vectorised,
};
use catenix_numerics::{Matrix3, TangentWeights, Vector3};

use super::assembly::Band;
use super::loads::NodeProperties;
use crate::hydro::morison::PointDrag;
use crate::system::frames::Sea;
use crate::system::surroundings::Surroundings;
use crate::system::touch::Touch;

const NO_ROW: Row = [0.0; MOST_LANES];

/// As many consecutive nodes as are computed at once.
#[derive(Debug, Clone)]
struct Batch {
    /// The first of them among the nodes of its line.
    node: usize,
    /// How many there are; the properties of the last one fill idle lanes.
    count: usize,
    /// Mass, weight, buoyancy (3).
    plain: [Row; 3],
    /// Drag across and along (2).
    drag: [Row; 2],
    /// Added mass across and along (2).
    added: [Row; 2],
    /// Length and diameter (2) [m].
    size: [Row; 2],
}

/// The nodes of a line but its ends.
#[derive(Debug, Clone)]
pub(super) struct InnerNodes {
    batches: Vec<Batch>,
}

impl InnerNodes {
    /// Of all nodes of a line.
    pub fn of(nodes: &[NodeProperties]) -> InnerNodes {
        let last = nodes.len().saturating_sub(1);
        let starts = (1..last).step_by(lane_count());
        let batches = starts.map(|first| Batch::new(nodes, first, lane_count().min(last - first)));
        InnerNodes {
            batches: batches.collect(),
        }
    }

    /// Adds inertia minus loads to the forces at the nodes and, with `weights`, their derivatives to
    /// the line's matrix.
    pub fn add(
        &self,
        sea: &Sea<'_>,
        motion: &LineMotion<'_>,
        weights: Option<&TangentWeights<'_>>,
        force: &mut [Vector3],
        band: &mut Band,
    ) {
        vectorised(Add {
            batches: &self.batches,
            sea,
            motion,
            weights,
            force,
            band,
        });
    }
}

/// Positions and motions of all nodes of a line (n_nodes each).
pub(super) struct LineMotion<'a> {
    pub position: &'a [Vector3],
    pub velocity: &'a [Vector3],
    pub acceleration: &'a [Vector3],
}

impl Batch {
    fn new(nodes: &[NodeProperties], first: usize, count: usize) -> Batch {
        let mut batch = Batch {
            node: first,
            count,
            plain: [NO_ROW; 3],
            drag: [NO_ROW; 2],
            added: [NO_ROW; 2],
            size: [NO_ROW; 2],
        };
        for lane in 0..MOST_LANES {
            let own = &nodes[first + lane.min(count - 1)];
            let rows = batch
                .plain
                .iter_mut()
                .chain(&mut batch.drag)
                .chain(&mut batch.added)
                .chain(&mut batch.size);
            let values = [
                own.mass,
                own.weight,
                own.buoyancy,
                own.drag.normal,
                own.drag.axial,
                own.added_normal,
                own.added_axial,
                own.length,
                own.diameter,
            ];
            for (row, value) in rows.zip(values) {
                row[lane] = value;
            }
        }
        batch
    }
}

struct Add<'a> {
    batches: &'a [Batch],
    sea: &'a Sea<'a>,
    motion: &'a LineMotion<'a>,
    weights: Option<&'a TangentWeights<'a>>,
    force: &'a mut [Vector3],
    band: &'a mut Band,
}

#[inline(always)]
fn load<T: Lane>(token: T::Token, vectors: &[Vector3], first: usize) -> Vec3<T> {
    let [x, y, z] = gather(token, vectors, first);
    Vec3::new(x, y, z)
}

#[inline(always)]
fn add<T: Lane>(m: Mat3<T>, to: &mut [Matrix3], first: usize, count: usize) {
    let [a, b, c] = m.0;
    let entries = [a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z];
    add_records(&entries, to, first, count);
}

impl Kernel for Add<'_> {
    type Output = ();

    #[inline(always)]
    fn run<T: Lane>(self, token: T::Token) {
        let Add {
            batches,
            sea,
            motion,
            weights,
            force,
            band,
        } = self;
        for batch in batches {
            let (first, count) = (batch.node, batch.count);
            let position = load::<T>(token, motion.position, first);
            let before = load::<T>(token, motion.position, first - 1);
            let after = load::<T>(token, motion.position, first + 1);
            let velocity = load::<T>(token, motion.velocity, first);
            let acceleration = load::<T>(token, motion.acceleration, first);
            let chord = after - before;
            let one = chord.x.same(1.0);
            let inverse = one / chord.norm_squared().sqrt();
            let axis = chord * inverse;
            let Surroundings {
                water: [current, current_slope],
                wet: [share, by_height, by_slope],
                at_surface,
            } = Surroundings::new(token, &batch.size, sea, position.z, axis.z);
            let mass = T::read(token, &batch.plain[0]);
            let weight = T::read(token, &batch.plain[1]);
            let buoyancy = T::read(token, &batch.plain[2]);
            let coefficients = [
                T::read(token, &batch.drag[0]),
                T::read(token, &batch.drag[1]),
            ];
            let drag = PointDrag::new(coefficients, axis, current - velocity);
            let normal = T::read(token, &batch.added[0]);
            let beyond = T::read(token, &batch.added[1]) - normal;
            let added = (axis * beyond).outer(axis).plus_diagonal(normal);
            let mut wetted = added.times(acceleration) - drag.force();
            let mut sum = (acceleration * mass).plus(share, wetted);
            sum.z += weight - buoyancy * share;
            let length = T::read(token, &batch.size[0]);
            let touch = Touch::of(token, sea, length, position.z, velocity);
            if let Some(touch) = &touch {
                sum -= touch.force;
            }
            add_records(&[sum.x, sum.y, sum.z], force, first, count);

            let Some(weights) = weights else { continue };
            let [by_velocity, by_axis] = drag.derivatives();
            let along = axis.dot(acceleration);
            let across = acceleration.minus(along, axis);
            let steady = beyond * along;
            // The axis stays unit: (I - axis axis^T) on the right.
            let mut turned = (Mat3::diagonal(steady)
                .plus_outer(axis * -steady, axis)
                .plus_outer(axis * beyond, across)
                - by_axis)
                * share;
            let mut by_speed = by_velocity * share;
            let mut raised = by_velocity.times(current_slope) * -share;
            if at_surface {
                wetted.z -= buoyancy;
                raised += wetted * by_height;
                let mut up = axis * -axis.z;
                up.z += one;
                turned = turned.plus_outer(wetted * by_slope, up);
            }
            if let Some(touch) = &touch {
                raised -= touch.by_height;
                by_speed = by_speed - touch.by_velocity;
            }
            let mut own =
                (added * share).plus_diagonal(mass) * T::splat(token, weights.acceleration);
            own = own.plus(T::splat(token, weights.velocity), by_speed);
            own.0[2] += raised;
            let chord = turned * inverse;
            add(own, &mut band.own, first, count);
            add(chord, &mut band.next, first, count);
            add(-chord, &mut band.previous, first - 1, count);
        }
    }
}
