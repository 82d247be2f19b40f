//! Ends that slide: the joint's point moves along an axis of its support without resistance.
//!
//! The slide is an unknown of the connector alone. The law is linear in the gap, so the slide at
//! which the force has no part along the axis is found in closed form, and it is condensed out of
//! the tangent.
//!
//! Source: docs/theory/sliding.md, eqs. (1) to (4).

use catenix_numerics::{Matrix3, Vector3};

use super::element::pair::{PairTangent, Sensitivity, Side};

/// A connector's freedom to slide.
#[derive(Debug, Clone, Copy)]
pub(super) struct Slide {
    /// Whether the support is the connector's first side.
    pub support_first: bool,
    /// Direction in the connection axes of the support, unit (3).
    pub axis: Vector3,
}

/// A slide that has found its place.
#[derive(Debug, Clone, Copy)]
pub(super) struct SlideState {
    support_first: bool,
    /// Direction, global, unit (3).
    axis: Vector3,
    /// Stiffness of the connector along the axis [N/m].
    stiffness: f64,
    /// Derivative of the connector's forces by the slide, once the tangent is known.
    row: Option<SlideRow>,
}

/// Derivative by the slide of the force on the second side and of the moments on both.
#[derive(Debug, Clone, Copy)]
struct SlideRow {
    force: Vector3,
    moments: [Vector3; 2],
}

impl Slide {
    /// Moves the support's side to where the force has no part along the axis.
    ///
    /// `force_on_support` is the generalised force before (3) [N]; `stiffness` maps a move of the
    /// point to the change of that force.
    pub fn settle(
        &self,
        first: &mut Side,
        second: &mut Side,
        force_on_support: impl Fn(&Side, &Side) -> Vector3,
        stiffness: impl Fn(&Vector3) -> f64,
    ) -> SlideState {
        let support = if self.support_first {
            &*first
        } else {
            &*second
        };
        let axis = support.rotation * self.axis;
        let stiffness = stiffness(&axis);
        let distance = -axis.dot(&force_on_support(first, second)) / stiffness;
        let support = if self.support_first { first } else { second };
        let shift = axis * distance;
        support.point += shift;
        support.lever += shift;
        support.velocity += support.spin.cross(&shift);
        SlideState {
            support_first: self.support_first,
            axis,
            stiffness,
            row: None,
        }
    }
}

impl SlideState {
    /// Takes the slide out of the tangent. `force` is the force on the second side (3) [N].
    pub fn condense(&mut self, tangent: &mut PairTangent, force: &Vector3) {
        let n = &self.axis;
        let sign = if self.support_first { -1.0 } else { 1.0 };
        let lever_part = n.cross(&(force * sign));
        let mut moments = [&tangent.first_moment, &tangent.second_moment]
            .map(|moment| moment.translation * n * sign);
        moments[usize::from(!self.support_first)] += lever_part;
        let row = SlideRow {
            force: tangent.force.translation * n * sign,
            moments,
        };
        let soften = |d: &mut Sensitivity, by_slide: &Vector3| {
            let column = by_slide / self.stiffness;
            let outer = |v: &Vector3| -> Matrix3 { column * v.transpose() };
            d.translation -= outer(&row.force);
            d.first_rotation -= outer(&row.moments[0]);
            d.second_rotation -= outer(&row.moments[1]);
        };
        soften(&mut tangent.force, &row.force);
        soften(&mut tangent.first_moment, &row.moments[0]);
        soften(&mut tangent.second_moment, &row.moments[1]);
        self.row = Some(row);
    }

    /// Moves the support by what the slide adds to the increments (translation, rotation) of the
    /// two sides.
    pub fn carry(&self, moves: &mut [(Vector3, Vector3); 2]) {
        let Some(row) = &self.row else { return };
        let by_force = row.force.dot(&(moves[1].0 - moves[0].0));
        let by_moments = row.moments[0].dot(&moves[0].1) + row.moments[1].dot(&moves[1].1);
        let slide = -(by_force + by_moments) / self.stiffness;
        moves[usize::from(!self.support_first)].0 += self.axis * slide;
    }
}
