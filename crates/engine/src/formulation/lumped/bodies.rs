//! The rows and columns of the bodies that lines end on.
//!
//! Source: docs/theory/lumped.md, eqs. (15) to (17), (23) and (24).

use catenix_numerics::{BlockMatrix, Matrix3, TangentWeights, Vector3, Vector6, six, so3::hat};

use super::super::Situation;
use super::LumpedLine;
use super::evaluation::LumpedEvaluation;
use crate::system::Carrier;

impl LumpedEvaluation {
    /// Adds the rows and columns of the body that an end is held by.
    #[expect(clippy::too_many_arguments, reason = "one call site, inside one loop")]
    pub(super) fn add_body(
        &self,
        at: &Situation<'_>,
        line: &LumpedLine,
        index: usize,
        end: usize,
        weights: &TangentWeights<'_>,
        residual: &mut [Vector6],
        matrix: Option<&mut BlockMatrix>,
    ) {
        let Some(held) = &line.ends[end] else { return };
        let Carrier::Free(body) = held.carrier else {
            return;
        };
        let seat = held.seat(at);
        let n = line.elements();
        let node = |step: usize| if end == 0 { step } else { n - step };
        let mut moment = Vector3::zeros();
        if held.guide.is_some() {
            moment += self.guides[index][end].moment();
        }
        let mut force = Vector3::zeros();
        if held.tie.is_some() {
            let tie = &self.ties[index][end];
            force -= tie.force;
            moment += tie.moment();
        } else {
            force += self.force[line.nodes.start + line.end_node(end)];
            moment += seat.arm.cross(&force);
        }
        residual[body] += six(&force, &moment);
        let Some(matrix) = matrix else { return };

        let BlockMatrix {
            diagonal,
            head,
            tail,
            ..
        } = matrix;
        let own = &mut diagonal[body];
        let [out, back] = if end == 0 {
            &mut head[index]
        } else {
            &mut tail[index]
        };
        let mut row = |step: usize, by_place: &Matrix3, by_turn: &Matrix3| {
            if let Some((_, half)) = (step <= n).then(|| line.slot(node(step))).flatten() {
                out.add_quadrant(half, 0, by_place);
                out.add_quadrant(half, 1, by_turn);
            }
        };
        let arm = hat(&seat.arm);
        // Derivatives by the support's rotation of what holds the direction.
        let element = line.springs.start + if end == 0 { 0 } else { n - 1 };
        let sign = if end == 0 { -1.0 } else { 1.0 };
        let zero = Matrix3::zeros();
        let (mut end_turn, mut next_turn) = (zero, zero);
        // Of the moment on the support, by the end of the line and by the node next to it.
        let (mut by_end, mut by_next) = (zero, zero);
        if held.guide.is_some() {
            let t = self.guides[index][end].tangent(&self.springs[element].segment);
            (end_turn, next_turn) = (t.force_rotation * sign, t.force_rotation * -sign);
            (by_end, by_next) = (t.moment * sign, t.moment * -sign);
            own.add_quadrant(1, 1, &t.moment_rotation);
        }
        let mut moments = |step: usize, by_node: &Matrix3| {
            if let Some((_, half)) = (step <= n).then(|| line.slot(node(step))).flatten() {
                back.add_quadrant(1, half, by_node);
            }
        };
        moments(1, &by_next);
        if held.tie.is_some() {
            let t = self.ties[index][end].tangent();
            moments(0, &(by_end + t.moment));
            row(0, &-t.force, &(end_turn + t.force_rotation));
            row(1, &zero, &next_turn);
            if let Some((_, half)) = line.slot(node(0)) {
                back.add_quadrant(0, half, &-t.force);
            }
            own.add_quadrant(0, 0, &t.force);
            own.add_quadrant(0, 1, &-t.force_rotation);
            own.add_quadrant(1, 0, &-t.moment);
            own.add_quadrant(1, 1, &t.moment_rotation);
            return;
        }
        let band = &self.band;
        let jacobian = seat.by_rotation(weights, body);
        let column = |total: &Matrix3, velocity: &Matrix3, acceleration: &Matrix3| -> Matrix3 {
            let place = total - velocity * weights.velocity - acceleration * weights.acceleration;
            place * jacobian[0] + velocity * jacobian[1] + acceleration * jacobian[2]
        };
        let damping = &band.end_damping[end];
        let total = &band.own[node(0)];
        let velocity = damping + band.end_velocity[end];
        let turned = column(total, &velocity, &band.end_acceleration[end]) + end_turn;
        own.add_quadrant(0, 0, total);
        own.add_quadrant(0, 1, &turned);
        own.add_quadrant(1, 0, &(arm * total + by_end));
        let levered = arm * turned + hat(&force) * arm + by_end * jacobian[0];
        own.add_quadrant(1, 1, &levered);
        for step in 1..=2.min(n) {
            let total = band.between(node(step), node(0));
            let velocity = if step == 1 { -damping } else { zero };
            let mut turned = column(&total, &velocity, &zero);
            if step == 1 {
                turned += next_turn;
            }
            row(step, &total, &turned);
            if let Some((_, half)) = line.slot(node(step)) {
                let total = band.between(node(0), node(step));
                back.add_quadrant(0, half, &total);
                back.add_quadrant(1, half, &(arm * total));
            }
        }
    }
}
