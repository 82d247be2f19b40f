//! The end of a line on a ball, universal or hinge joint, or sliding: springs between the node and
//! its support, much stiffer than the element next to them.
//!
//! The node keeps its own six freedoms. What the joint holds is held by springs: the distance of the
//! node from its point, or from a line through it where the end slides, and the scalar products of
//! directions of the two sides, which have the exact kinematics of a cross.
//!
//! Source: docs/theory/fem.md, eqs. (32) to (34).

use catenix_numerics::{Block6, Matrix3, Vector3, Vector6, six, so3::hat};

/// What holds two directions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Hold {
    /// k (a . b)^2 / 2: at a right angle [N m/rad].
    Perpendicular(f64),
    /// k angle^2 / 2: parallel [N m/rad].
    Parallel(f64),
}

/// A spring between a direction of the support and one of the node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Direction {
    /// Direction in the support's connection axes, unit (3).
    pub on_support: Vector3,
    /// Direction in the node's axes, unit (3).
    pub on_node: Vector3,
    /// How they are held.
    pub hold: Hold,
}

/// A joint.
#[derive(Debug, Clone, PartialEq)]
pub struct JointSprings {
    /// Against the distance of the node from its point [N/m].
    pub stiffness: f64,
    /// Direction in which the node slides freely, in the support's connection axes, unit (3).
    pub slide: Option<Vector3>,
    /// Held rotations.
    pub directions: Vec<Direction>,
}

/// The support's side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Support {
    /// The joint's point, global (3) [m].
    pub point: Vector3,
    /// From the origin of the carrying frame to the point, global (3) [m].
    pub lever: Vector3,
    /// Connection axes to global axes.
    pub rotation: Matrix3,
}

/// A joint at one configuration.
#[derive(Debug, Clone, Copy)]
pub struct JointState {
    /// Force of the support on the node (3) [N].
    pub force: Vector3,
    /// Moment of the support on the node (3) [N m].
    pub moment: Vector3,
    /// Direction of sliding, global, or none.
    along: Option<Vector3>,
    /// From the node to the joint's point (3) [m].
    gap: Vector3,
    energy: f64,
}

impl Hold {
    /// Energy and its first and second derivative by the scalar product e.
    fn at(self, e: f64) -> [f64; 3] {
        match self {
            Hold::Perpendicular(k) => [0.5 * k * e * e, k * e, k],
            Hold::Parallel(k) => {
                let e = e.clamp(-0.999_999, 1.0);
                let y = 1.0 - e;
                if y < 1e-3 {
                    // angle^2 / 2 = y + y^2 / 6 + 2 y^3 / 45 + y^4 / 70 + ..
                    return [
                        k * y * (1.0 + y * (1.0 / 6.0 + y * (2.0 / 45.0 + y / 70.0))),
                        -k * (1.0 + y * (1.0 / 3.0 + y * (2.0 / 15.0 + y * (2.0 / 35.0)))),
                        k * (1.0 / 3.0 + y * (4.0 / 15.0 + y * (6.0 / 35.0))),
                    ];
                }
                let angle = e.acos();
                let sin2 = 1.0 - e * e;
                let ratio = angle / sin2.sqrt();
                [
                    0.5 * k * angle * angle,
                    -k * ratio,
                    k * (1.0 - e * ratio) / sin2,
                ]
            }
        }
    }
}

impl JointState {
    /// Source: docs/theory/fem.md, eqs. (32) and (33).
    pub fn new(
        joint: &JointSprings,
        support: &Support,
        position: &Vector3,
        rotation: &Matrix3,
    ) -> JointState {
        let gap = support.point - position;
        let along = joint.slide.map(|slide| support.rotation * slide);
        let held = along.map_or(gap, |n| gap - n * n.dot(&gap));
        let mut state = JointState {
            force: held * joint.stiffness,
            moment: Vector3::zeros(),
            along,
            gap,
            energy: 0.5 * joint.stiffness * held.norm_squared(),
        };
        for direction in &joint.directions {
            let (a, b) = direction.global(support, rotation);
            let [energy, slope, _] = direction.hold.at(a.dot(&b));
            state.moment -= b.cross(&a) * slope;
            state.energy += energy;
        }
        state
    }

    /// Elastic energy [J].
    pub fn energy(&self) -> f64 {
        self.energy
    }

    /// From the support's frame to where the force acts on it, (3) [m]: the node's foot on the line
    /// that it slides along, or the joint's point.
    fn foot(&self, support: &Support) -> Vector3 {
        let back = self
            .along
            .map_or_else(Vector3::zeros, |n| n * n.dot(&self.gap));
        support.lever - back
    }

    /// Generalised forces, as gradients of the energy: on the support's frame, and on the node.
    ///
    /// Source: docs/theory/fem.md, eq. (33).
    pub fn forces(&self, support: &Support) -> [Vector6; 2] {
        let about = self.foot(support).cross(&self.force);
        [
            six(&self.force, &(about + self.moment)),
            six(&-self.force, &-self.moment),
        ]
    }

    /// Exact derivative of [`Self::forces`], by support and node. With a `prediction`, that force
    /// takes the place of the true one in the geometric part (the mixed form).
    ///
    /// Source: docs/theory/fem.md, eq. (34).
    pub fn tangent(
        &self,
        joint: &JointSprings,
        support: &Support,
        rotation: &Matrix3,
        prediction: Option<&Vector3>,
    ) -> [[Block6; 2]; 2] {
        let force = prediction.unwrap_or(&self.force);
        let lever = hat(&support.lever);
        let k = joint.stiffness;
        // The gap by translations of support and node is plus and minus one, and by the support's
        // rotation -lever; the foot by the same.
        let (by_gap, by_turn, foot_by_gap, foot_by_turn) = match &self.along {
            None => (
                Matrix3::identity() * k,
                Matrix3::zeros(),
                Matrix3::zeros(),
                -lever,
            ),
            Some(n) => {
                let along = n.dot(&self.gap);
                let outer = n * n.transpose();
                let by_direction =
                    (Matrix3::identity() * along + n * self.gap.transpose()) * hat(n);
                (
                    (Matrix3::identity() - outer) * k,
                    by_direction * k,
                    -outer,
                    -lever + by_direction,
                )
            }
        };
        let foot = hat(&self.foot(support));
        let force_hat = hat(force);
        let force_by_turn = by_turn - by_gap * lever;
        let moment_by_gap = foot * by_gap - force_hat * foot_by_gap;
        let moment_by_turn =
            foot * force_by_turn - force_hat * (foot_by_turn - foot_by_gap * lever);
        let mut blocks = [[Block6::ZERO; 2]; 2];
        for (column, sign) in [(0, 1.0), (1, -1.0)] {
            blocks[0][column].add_quadrant(0, 0, &(by_gap * sign));
            blocks[0][column].add_quadrant(1, 0, &(moment_by_gap * sign));
            blocks[1][column].add_quadrant(0, 0, &(by_gap * -sign));
        }
        blocks[0][0].add_quadrant(0, 1, &force_by_turn);
        blocks[0][0].add_quadrant(1, 1, &moment_by_turn);
        blocks[1][0].add_quadrant(0, 1, &-force_by_turn);
        for direction in &joint.directions {
            let (a, b) = direction.global(support, rotation);
            let [_, slope, curvature] = direction.hold.at(a.dot(&b));
            let turn = b.cross(&a);
            let outer = turn * turn.transpose() * curvature;
            let by_node = outer + hat(&a) * hat(&b) * slope;
            let by_support = -outer - hat(&b) * hat(&a) * slope;
            for (row, sign) in [(0, -1.0), (1, 1.0)] {
                blocks[row][0].add_quadrant(1, 1, &(by_support * sign));
                blocks[row][1].add_quadrant(1, 1, &(by_node * sign));
            }
        }
        blocks
    }

    /// The force on the node after a small move, from the linear solution: the mixed unknown.
    /// `moves`: translation and rotation of the support's frame and of the node.
    ///
    /// Source: docs/theory/fem.md, eq. (34).
    pub fn predicted(
        &self,
        joint: &JointSprings,
        support: &Support,
        moves: &[(Vector3, Vector3); 2],
    ) -> Vector3 {
        let change = moves[0].0 + moves[0].1.cross(&support.lever) - moves[1].0;
        let held = match &self.along {
            None => change,
            Some(n) => {
                let turned = moves[0].1.cross(n);
                change - n * (n.dot(&change) + turned.dot(&self.gap)) - turned * n.dot(&self.gap)
            }
        };
        self.force + held * joint.stiffness
    }
}

impl Direction {
    #[inline]
    fn global(&self, support: &Support, rotation: &Matrix3) -> (Vector3, Vector3) {
        (support.rotation * self.on_support, rotation * self.on_node)
    }
}
