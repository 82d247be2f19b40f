//! A connector of either kind, evaluated between its two sides, and the places of its blocks in the
//! matrix.

use catenix_numerics::{Block6, BlockMatrix, Matrix3, Topology, Vector3, Vector6};

use super::super::Situation;
use super::element::connector::{ConnectorState, Prediction};
use super::element::joint::JointState;
use super::element::pair::{PairForces, PairTangent, RateWeights, Sensitivity, Side};
use super::slide::SlideState;
use super::{Connector, ConnectorLaw, Place};
use crate::system::{Carrier, Mount};

/// A connector of either kind at one configuration.
#[derive(Debug, Clone, Copy)]
#[expect(
    clippy::large_enum_variant,
    reason = "few are kept, and a box would allocate in every evaluation"
)]
pub(super) enum PairState {
    Beam(ConnectorState),
    Joint(JointState),
}

impl PairState {
    fn new(law: &ConnectorLaw, first: &Side, second: &Side) -> PairState {
        match law {
            ConnectorLaw::Beam(law) => PairState::Beam(ConnectorState::new(law, first, second)),
            ConnectorLaw::Joint(law) => PairState::Joint(JointState::new(law, first, second)),
        }
    }

    fn forces(&self, first: &Side, second: &Side) -> PairForces {
        match self {
            PairState::Beam(state) => state.forces(first, second),
            PairState::Joint(state) => state.forces(first, second),
        }
    }

    /// Direction in which the axial stiffness acts.
    fn axis(&self, second: &Side) -> Vector3 {
        match self {
            PairState::Beam(state) => state.axis,
            PairState::Joint(_) => second.rotation.column(0).into(),
        }
    }

    /// Elastic force on the second side that the geometric part of the tangent uses [N].
    fn geometric_force(
        &self,
        law: &ConnectorLaw,
        second: &Side,
        prediction: Option<&Prediction>,
    ) -> Vector3 {
        let predicted =
            prediction.map(|p| p.force(law.stiffness(), &self.axis(second), law.forward()));
        match self {
            PairState::Beam(state) => predicted.unwrap_or(state.elastic.force),
            PairState::Joint(state) => -predicted.unwrap_or(state.elastic),
        }
    }
}

/// A connector with its two sides, as last evaluated.
#[derive(Debug, Clone, Copy)]
pub(super) struct EvaluatedPair {
    pub first: Side,
    pub second: Side,
    pub state: PairState,
    slide: Option<SlideState>,
}

impl EvaluatedPair {
    pub(super) fn new(connector: &Connector, at: &Situation<'_>) -> EvaluatedPair {
        let mut first = side(&connector.first, at);
        let mut second = side(&connector.second, at);
        let law = &connector.law;
        let slide = connector.slide.map(|slide| {
            let still = PairState::new(law, &first, &second);
            let along = still.axis(&second);
            slide.settle(
                &mut first,
                &mut second,
                |first, second| {
                    let forces = still.forces(first, second);
                    let on_support = if slide.support_first {
                        forces.first
                    } else {
                        forces.second
                    };
                    on_support.fixed_rows::<3>(0).into_owned()
                },
                |axis| {
                    let stiffness = law.stiffness();
                    let along = along.dot(axis);
                    stiffness.shear + (stiffness.axial - stiffness.shear) * along * along
                },
            )
        });
        EvaluatedPair {
            first,
            second,
            state: PairState::new(law, &first, &second),
            slide,
        }
    }

    pub(super) fn forces(&self) -> PairForces {
        self.state.forces(&self.first, &self.second)
    }

    pub(super) fn energy(&self, law: &ConnectorLaw) -> f64 {
        match (&self.state, law) {
            (PairState::Beam(state), ConnectorLaw::Beam(law)) => {
                state.energy(law, &self.first, &self.second)
            }
            (PairState::Joint(state), ConnectorLaw::Joint(law)) => state.energy(law, &self.second),
            _ => unreachable!("a state is made by its own law"),
        }
    }

    pub(super) fn damping_power(&self) -> f64 {
        match &self.state {
            PairState::Beam(state) => state.damping_power(),
            PairState::Joint(state) => state.damping_power(),
        }
    }

    pub(super) fn tangent(
        &mut self,
        law: &ConnectorLaw,
        prediction: Option<&Prediction>,
        rates: &RateWeights,
    ) -> PairTangent {
        let (first, second) = (&self.first, &self.second);
        let mut tangent = match (&self.state, law) {
            (PairState::Beam(state), ConnectorLaw::Beam(law)) => {
                state.tangent(law, first, second, prediction, rates)
            }
            (PairState::Joint(state), ConnectorLaw::Joint(law)) => {
                state.tangent(law, first, second, prediction, rates)
            }
            _ => unreachable!("a state is made by its own law"),
        };
        if let Some(slide) = &mut self.slide {
            let force = self.state.geometric_force(law, second, prediction);
            slide.condense(&mut tangent, &force);
        }
        tangent
    }

    /// Mixed unknowns after a linear solution.
    pub(super) fn predicted(&self, connector: &Connector, increment: &[Vector6]) -> Prediction {
        let split = |mount: &Mount| match mount.carrier {
            Carrier::Free(k) => (
                increment[k].fixed_rows::<3>(0).into_owned(),
                increment[k].fixed_rows::<3>(3).into_owned(),
            ),
            Carrier::Vessel(_) => (Vector3::zeros(), Vector3::zeros()),
        };
        let mut moves = [split(&connector.first), split(&connector.second)];
        if let Some(slide) = &self.slide {
            slide.carry(&mut moves);
        }
        let [a, b] = &moves;
        let (a, b) = ((&a.0, &a.1), (&b.0, &b.1));
        match &self.state {
            PairState::Beam(state) => state.predicted(&self.first, &self.second, a, b),
            PairState::Joint(state) => state.predicted(&self.first, &self.second, a, b),
        }
    }
}

fn side(mount: &Mount, at: &Situation<'_>) -> Side {
    let own = at.carrier(mount.carrier);
    let lever = own.rotation * mount.arm;
    Side {
        point: own.position + lever,
        lever,
        rotation: own.rotation * mount.axes,
        velocity: own.velocity + own.spin.cross(&lever),
        spin: own.spin,
    }
}

/// Adds the blocks of a connector where they belong.
pub(super) fn scatter(
    topology: &Topology,
    connector: &Connector,
    t: &PairTangent,
    matrix: &mut BlockMatrix,
) {
    // Blocks by frame of the force (row) and frame of the move (column).
    let rows = |block: &mut Block6, row: usize, column: usize| {
        let sign = if row == 0 { -1.0 } else { 1.0 };
        let moment = if row == 0 {
            &t.first_moment
        } else {
            &t.second_moment
        };
        let pick = |d: &Sensitivity| -> (Matrix3, Matrix3) {
            if column == 0 {
                (-d.translation, d.first_rotation)
            } else {
                (d.translation, d.second_rotation)
            }
        };
        let (by_position, by_rotation) = pick(&t.force);
        block.add_quadrant(0, 0, &(by_position * sign));
        block.add_quadrant(0, 1, &(by_rotation * sign));
        let (by_position, by_rotation) = pick(moment);
        block.add_quadrant(1, 0, &by_position);
        block.add_quadrant(1, 1, &by_rotation);
    };
    let carriers = [connector.first.carrier, connector.second.carrier];
    for (side, carrier) in carriers.into_iter().enumerate() {
        if let Carrier::Free(k) = carrier {
            rows(&mut matrix.diagonal[k], side, side);
        }
    }
    // The side that belongs to the line, when the other is a junction.
    let line_side = |junction: usize| usize::from(carriers[0] == Carrier::Free(junction));
    match connector.place {
        Place::Grounded => {}
        Place::Link(k) => {
            rows(&mut matrix.upper[k], 0, 1);
            rows(&mut matrix.lower[k], 1, 0);
        }
        Place::Head(chain) => {
            if let Some(junction) = topology.chains()[chain].head {
                let line = line_side(junction);
                let [out, back] = &mut matrix.head[chain];
                rows(out, line, 1 - line);
                rows(back, 1 - line, line);
            }
        }
        Place::Tail(chain) => {
            if let Some(junction) = topology.chains()[chain].tail {
                let line = line_side(junction);
                let [out, back] = &mut matrix.tail[chain];
                rows(out, line, 1 - line);
                rows(back, 1 - line, line);
            }
        }
    }
}
