//! The elements and connectors of all lines at a state.

use std::sync::Arc;

use catenix_numerics::{BlockMatrix, Matrix3, TangentWeights, Vector3, Vector6};

use super::super::{Evaluation, NodeResult, Situation};
use super::element::connector::Prediction;
use super::element::pair::RateWeights;
use super::links::Links;
use super::pairs::{EvaluatedPair, scatter};
use super::{ConnectorLaw, Dem, element_end, node_pass, nodes};
use crate::system::frame_kernel::frame_energies;
use crate::system::frames::{self, frame_motion};
use crate::system::{Carrier, EnergyTerms, Momentum, Mount, System};

/// Connectors as last evaluated.
#[derive(Debug, Clone)]
pub(super) struct DemEvaluation {
    pub(super) dem: Arc<Dem>,
    /// The connectors between elements, several at a time.
    links: Links,
    /// All others, one by one.
    others: Vec<Other>,
    has_prediction: bool,
}

/// A connector that is no link.
#[derive(Debug, Clone)]
struct Other {
    /// Its index among those that are no links.
    index: usize,
    pair: EvaluatedPair,
    predicted: Prediction,
}

impl DemEvaluation {
    pub(super) fn new(dem: Arc<Dem>, at: &Situation<'_>) -> DemEvaluation {
        let other = |(index, connector)| Other {
            index,
            pair: EvaluatedPair::new(connector, at),
            predicted: Prediction::default(),
        };
        DemEvaluation {
            links: Links::new(&dem.linked),
            others: dem.others.iter().enumerate().map(other).collect(),
            has_prediction: false,
            dem,
        }
    }
}

impl Evaluation for DemEvaluation {
    fn duplicate(&self) -> Box<dyn Evaluation> {
        Box::new(self.clone())
    }

    fn assemble(
        &mut self,
        at: &Situation<'_>,
        weights: Option<&TangentWeights<'_>>,
        residual: &mut [Vector6],
        matrix: &mut BlockMatrix,
    ) {
        let elements = &self.dem.elements;
        self.links.put(elements, at, weights, residual, matrix);
        for other in &mut self.others {
            let connector = &self.dem.others[other.index];
            let mut pair = EvaluatedPair::new(connector, at);
            let forces = pair.forces();
            for (mount, force) in [
                (&connector.first, &forces.first),
                (&connector.second, &forces.second),
            ] {
                if let Carrier::Free(k) = mount.carrier {
                    residual[k] += force;
                }
            }
            if let Some(weights) = weights {
                let side_turn = |mount: &Mount| match mount.carrier {
                    Carrier::Free(k) => weights.turn(k),
                    Carrier::Vessel(_) => Matrix3::identity(),
                };
                let rates = RateWeights {
                    velocity: weights.velocity,
                    rotation: [side_turn(&connector.first), side_turn(&connector.second)],
                };
                let prediction = self.has_prediction.then_some(&other.predicted);
                let tangent = pair.tangent(&connector.law, prediction, &rates);
                scatter(&at.system.topology, connector, &tangent, matrix);
            }
            other.pair = pair;
        }
    }

    fn begin(&mut self) {
        self.has_prediction = false;
        self.links.begin();
    }

    fn moving(&mut self, _: &System, increment: &[Vector6]) {
        self.links.moving(&self.dem.elements, increment);
        for other in &mut self.others {
            let connector = &self.dem.others[other.index];
            other.predicted = other.pair.predicted(connector, increment);
        }
        self.has_prediction = true;
    }

    fn node(&self, at: &Situation<'_>, line: usize, node: usize) -> NodeResult {
        nodes::node(self, at, line, node)
    }

    fn nodes(&self, at: &Situation<'_>, line: usize, rows: &mut [f64]) {
        node_pass::put(&self.dem, at, line, rows);
        for node in self.dem.nodes_apart(line) {
            self.node(at, line, node).put(node, rows);
        }
    }

    fn end_load(&self, at: &Situation<'_>, line: usize, end: usize) -> Vector6 {
        nodes::end_load(self, at, line, end)
    }

    fn add_energy(&self, at: &Situation<'_>, terms: &mut EnergyTerms) {
        terms.add(frame_energies(at, &self.dem.elements));
        let [elastic, damping] = self.links.energy();
        terms.elastic += elastic;
        terms.structural_damping += damping;
        for Other { index, pair, .. } in &self.others {
            let connector = &self.dem.others[*index];
            terms.elastic += pair.energy(&connector.law);
            terms.structural_damping += pair.damping_power();
            let forces = pair.forces();
            for (mount, force) in [
                (&connector.first, &forces.first),
                (&connector.second, &forces.second),
            ] {
                if let Carrier::Vessel(vessel) = mount.carrier {
                    let motion = &at.vessels[vessel];
                    terms.moved_ends += force.fixed_rows::<3>(0).dot(&motion.velocity)
                        + force.fixed_rows::<3>(3).dot(&motion.spin);
                }
            }
        }
    }

    fn add_momentum(&self, at: &Situation<'_>, momentum: &mut Momentum) {
        for k in 0..at.system.body_frame(0) {
            momentum.add_frame(&at.system.frames[k], &frame_motion(at.state, k));
        }
    }

    fn add_mass(&self, at: &Situation<'_>, in_water: bool, mass: &mut BlockMatrix) {
        for k in 0..at.system.body_frame(0) {
            let motion = frame_motion(at.state, k);
            let own = frames::frame_mass(&at.system.frames[k], &motion, in_water);
            mass.diagonal[k] = mass.diagonal[k].plus(1.0, &own);
        }
    }

    fn structural_damping(&self, at: &Situation<'_>) -> f64 {
        let powers = self.dem.connectors();
        let powers = powers.map(|connector| EvaluatedPair::new(&connector, at).damping_power());
        -powers.sum::<f64>()
    }

    /// Elements that meet no torsional stiffness at all (chains, ropes without it) could spin about
    /// their axis each by itself. They are given a stiffness that makes their spin as fast as the
    /// extension of one element.
    fn hold_idle_spins(&self, at: &Situation<'_>, matrix: &mut BlockMatrix) {
        let system = at.system;
        let mut idle = vec![true; system.body_frame(0)];
        let mut axial = vec![0.0f64; idle.len()];
        for connector in self.dem.connectors() {
            let turns = match &connector.law {
                ConnectorLaw::Beam(stiffness) => stiffness.torsion > 0.0,
                ConnectorLaw::Joint(joint) => !joint.springs.is_empty(),
            };
            for mount in [&connector.first, &connector.second] {
                match mount.carrier {
                    Carrier::Free(k) if k < idle.len() => {
                        idle[k] &= !turns;
                        axial[k] = axial[k].max(connector.law.stiffness().axial);
                    }
                    _ => {}
                }
            }
        }
        for k in (0..idle.len()).filter(|&k| idle[k]) {
            let frame = &system.frames[k];
            let axis = at.state.configuration.rotation[k] * frame.axis;
            let held = axis * axis.transpose() * (axial[k] * frame.inertia.x / frame.mass);
            matrix.diagonal[k].add_quadrant(1, 1, &held);
        }
    }

    /// At each node the mean of the two elements that meet there, and at an end the support.
    ///
    /// Source: docs/theory/modes.md, eq. (18).
    fn motion_at_nodes(&self, at: &Situation<'_>, x: &[Vector6], line: usize) -> Vec<Vector6> {
        let layout = &at.system.lines[line];
        (0..=layout.element_count)
            .map(|node| {
                let before = (node > 0).then(|| element_end(layout, node - 1, true));
                let after = (node < layout.element_count).then(|| element_end(layout, node, false));
                let at_end = before.is_none() || after.is_none();
                let end = at_end.then(|| self.dem.connector(line, node)).flatten();
                let Some(connector) = end else {
                    return mean(before.iter().chain(&after).map(|m| m.motion(at.state, x)));
                };
                // An end is where its support is; a joint lets it turn as the line does.
                let (support, turns) = match (&connector.law, node) {
                    (ConnectorLaw::Joint(_), _) => (connector.first, true),
                    (ConnectorLaw::Beam(_), 0) => (connector.first, false),
                    (ConnectorLaw::Beam(_), _) => (connector.second, false),
                };
                let back = Vector3::x() * -connector.law.shift();
                let mut motion = support.shifted(&back).motion(at.state, x);
                if let Some(own) = before.or(after).filter(|_| turns) {
                    let own = own.motion(at.state, x);
                    motion
                        .fixed_rows_mut::<3>(3)
                        .copy_from(&own.fixed_rows::<3>(3));
                }
                motion
            })
            .collect()
    }
}

fn mean(motions: impl Iterator<Item = Vector6>) -> Vector6 {
    let (count, sum) = motions.fold((0.0, Vector6::zeros()), |(count, sum), motion| {
        (count + 1.0, sum + motion)
    });
    sum / f64::max(count, 1.0)
}
