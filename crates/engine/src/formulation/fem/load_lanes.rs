//! The sea on several elements at a time: what `load.rs` computes for one.
//!
//! What depends on the height of a point by cases (how much is under water there, the current, the
//! seabed) is found point by point; the rest is computed in lanes.

use catenix_numerics::lanes::{Lane, MOST_LANES, Mat3, Row, Vec3};

use super::element::field::{POINT_COUNT, POINTS};
use super::element::lanes::field::{Load, SpreadLoads, Stations};
use super::load::Spread;
use crate::hydro::morison::PointDrag;
use crate::system::frames::Sea;
use crate::system::surroundings::Surroundings;
use crate::system::touch::Touch;

const NO_ROW: Row = [0.0; MOST_LANES];

/// Properties per unit length of lines side by side.
#[derive(Debug, Clone)]
pub(super) struct SpreadRows {
    /// Mass [kg/m], weight and buoyancy [N/m].
    pub mass: Row,
    pub weight: Row,
    pub buoyancy: Row,
    /// Drag across and along.
    drag: [Row; 2],
    /// Added mass across and along [kg/m].
    added: [Row; 2],
    /// Length that each point of integration stands for, and diameter (POINT_COUNT x 2) [m].
    size: [[Row; 2]; POINT_COUNT],
}

impl SpreadRows {
    /// Of elements with their lengths; the last one fills idle lanes.
    pub fn new(elements: &[(&Spread, f64)]) -> SpreadRows {
        let mut rows = SpreadRows {
            mass: NO_ROW,
            weight: NO_ROW,
            buoyancy: NO_ROW,
            drag: [NO_ROW; 2],
            added: [NO_ROW; 2],
            size: [[NO_ROW; 2]; POINT_COUNT],
        };
        for lane in 0..MOST_LANES {
            let (own, length) = elements[lane.min(elements.len() - 1)];
            rows.mass[lane] = own.mass;
            rows.weight[lane] = own.weight;
            rows.buoyancy[lane] = own.buoyancy;
            rows.drag[0][lane] = own.drag.normal;
            rows.drag[1][lane] = own.drag.axial;
            rows.added[0][lane] = own.added_normal;
            rows.added[1][lane] = own.added_axial;
            for (size, [_, share]) in rows.size.iter_mut().zip(POINTS) {
                size[0][lane] = length * share;
                size[1][lane] = own.diameter;
            }
        }
        rows
    }
}

/// The sea on lines side by side.
pub(super) struct SeaLoads<'a, T: Lane> {
    pub rows: &'a SpreadRows,
    pub sea: &'a Sea<'a>,
    pub token: T::Token,
}

/// What of the load is common to its value and its derivatives.
pub(super) struct Water<T> {
    pub share: T,
    by_height: T,
    by_slope: T,
    current_slope: Vec3<T>,
    drag: PointDrag<T>,
    /// Force of the drag under water.
    pub dragged: Vec3<T>,
    added: Mat3<T>,
    /// Added mass times acceleration, under water.
    pub carried: Vec3<T>,
    /// Whether one of the points is not all under water.
    at_surface: bool,
}

impl<T: Lane> SeaLoads<'_, T> {
    #[inline(always)]
    fn row(&self, row: &Row) -> T {
        T::read(self.token, row)
    }

    /// Water at the points of integration.
    #[inline(always)]
    pub fn water(&self, point: usize, s: &Stations<T>) -> Water<T> {
        let size = &self.rows.size[point];
        let Surroundings {
            water: [current, current_slope],
            wet: [share, by_height, by_slope],
            at_surface,
        } = Surroundings::new(self.token, size, self.sea, s.position.z, s.axis.z);
        let relative = current - s.velocity;
        let [normal, axial] = &self.rows.drag;
        let drag = PointDrag::new([self.row(normal), self.row(axial)], s.axis, relative);
        let [normal, axial] = &self.rows.added;
        let normal = self.row(normal);
        let beyond = self.row(axial) - normal;
        // Source: docs/theory/hydrodynamics.md, eq. (7).
        let added = (s.axis * beyond).outer(s.axis).plus_diagonal(normal);
        Water {
            share,
            by_height,
            by_slope,
            current_slope,
            drag,
            dragged: drag.force(),
            carried: added.times(s.acceleration),
            added,
            at_surface,
        }
    }
}

impl<T: Lane> SpreadLoads<T> for SeaLoads<'_, T> {
    #[inline(always)]
    fn at(&mut self, point: usize, s: &Stations<T>) -> Load<T> {
        let water = self.water(point, s);
        let (share, axis) = (water.share, s.axis);
        let buoyancy = self.row(&self.rows.buoyancy);
        let [by_velocity, by_axis] = water.drag.derivatives();
        let whole = water.dragged - water.carried;
        let mut force = whole * share;
        // Weight and full buoyancy are a uniform load; here is what the surface takes off.
        force.z += buoyancy * (share - 1.0);
        let mut height = by_velocity.times(water.current_slope) * share;
        let [normal, axial] = &self.rows.added;
        let difference = (self.row(axial) - self.row(normal)) * share;
        let along = axis.dot(s.acceleration);
        let across = s.acceleration.minus(along, axis);
        let steady = difference * along;
        let mut by_axis = (by_axis * share)
            .plus_outer(axis * -difference, across)
            .plus_diagonal(-steady)
            .plus_outer(axis * steady, axis);
        if water.at_surface {
            let mut whole = whole;
            whole.z += buoyancy;
            height += whole * water.by_height;
            let mut up = axis * -axis.z;
            up.z += share.same(1.0);
            by_axis = by_axis.plus_outer(whole * water.by_slope, up);
        }
        let mut velocity = by_velocity * -share;
        let one = share.same(1.0);
        if let Some(touch) = Touch::of(self.token, self.sea, one, s.position.z, s.velocity) {
            force += touch.force;
            height += touch.by_height;
            velocity = velocity + touch.by_velocity;
        }
        Load {
            force,
            height,
            axis: by_axis,
            velocity,
            acceleration: water.added * -share,
        }
    }
}
