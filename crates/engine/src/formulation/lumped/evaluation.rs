//! The points and springs of all lines at a state.

use std::sync::Arc;

use catenix_numerics::so3::hat;
use catenix_numerics::{Block6, BlockMatrix, Matrix3, TangentWeights, Vector3, Vector6, six};

use super::super::{Evaluation, NodeResult, Situation, clear_lines};
use super::assembly::Band;
use super::element::bend::BendState;
use super::element::guide::GuideState;
use super::element::spring::SpringState;
use super::ends::TieState;
use super::load_lanes::{InnerNodes, LineMotion};
use super::loads::{NodeLoad, NodeMotion};
use super::{Lumped, LumpedLine, limits, nodes};
use crate::system::{Carrier, EnergyTerms, Momentum, System};

/// Points, springs and ends as last evaluated.
#[derive(Debug, Clone)]
pub(super) struct LumpedEvaluation {
    pub(super) lumped: Arc<Lumped>,
    /// Of each node (n_nodes).
    pub(super) position: Vec<Vector3>,
    pub(super) velocity: Vec<Vector3>,
    pub(super) acceleration: Vec<Vector3>,
    /// Inertia + internal forces - loads at each node; what remains at a node on a support is what
    /// the support has to hold (n_nodes) [N].
    pub(super) force: Vec<Vector3>,
    pub(super) springs: Vec<SpringState>,
    pub(super) bends: Vec<BendState>,
    pub(super) guides: Vec<[GuideState; 2]>,
    pub(super) ties: Vec<[TieState; 2]>,
    /// Per line: from the origins of the two supports to its ends, global (n_lines x 2) [m].
    arms: Vec<[Vector3; 2]>,
    /// Extension that the linear solution predicts for each element [m].
    predicted: Vec<f64>,
    has_prediction: bool,
    /// Per line: its nodes between the ends (n_lines).
    inner: Vec<InnerNodes>,
    /// Room for the matrix of one line.
    pub(super) band: Band,
}

impl LumpedEvaluation {
    pub(super) fn new(lumped: Arc<Lumped>, at: &Situation<'_>) -> LumpedEvaluation {
        let (nodes, elements) = (lumped.nodes.len(), lumped.springs.len());
        let longest = lumped.lines.iter().map(LumpedLine::elements).max();
        let zeros = vec![Vector3::zeros(); nodes];
        let mut own = LumpedEvaluation {
            position: zeros.clone(),
            velocity: zeros.clone(),
            acceleration: zeros.clone(),
            force: zeros,
            springs: vec![SpringState::default(); elements],
            bends: vec![BendState::default(); nodes],
            guides: vec![Default::default(); lumped.lines.len()],
            ties: vec![Default::default(); lumped.lines.len()],
            arms: vec![Default::default(); lumped.lines.len()],
            predicted: vec![0.0; elements],
            has_prediction: false,
            inner: lumped
                .lines
                .iter()
                .map(|line| InnerNodes::of(&lumped.nodes[line.nodes.clone()]))
                .collect(),
            band: Band::with_nodes(longest.unwrap_or(0) + 1),
            lumped,
        };
        own.gather(at);
        own.evaluate(at);
        own
    }

    /// Positions and motions of all nodes.
    fn gather(&mut self, at: &Situation<'_>) {
        let state = at.state;
        for (line, arms) in self.lumped.lines.iter().zip(&mut self.arms) {
            *arms = line.arms(at);
            for node in 0..=line.elements() {
                let k = line.nodes.start + node;
                if let Some((block, half)) = line.slot(node) {
                    let row = 3 * half;
                    self.position[k] = state.configuration.point(block, half);
                    self.velocity[k] = state.velocity[block].fixed_rows::<3>(row).into();
                    self.acceleration[k] = state.acceleration[block].fixed_rows::<3>(row).into();
                } else if let Some(held) = line.seat(node) {
                    let seat = held.seat(at);
                    self.position[k] = seat.position();
                    self.velocity[k] = seat.velocity();
                    self.acceleration[k] = seat.acceleration();
                }
            }
        }
    }

    /// Forces of springs, bending and ends.
    fn evaluate(&mut self, at: &Situation<'_>) {
        self.force.fill(Vector3::zeros());
        let lumped = Arc::clone(&self.lumped);
        for (index, line) in lumped.lines.iter().enumerate() {
            let (first, spring) = (line.nodes.start, line.springs.start);
            for e in 0..line.elements() {
                let (a, b) = (first + e, first + e + 1);
                let between = self.position[b] - self.position[a];
                let rate = self.velocity[b] - self.velocity[a];
                let state = SpringState::new(&lumped.springs[spring + e], &between, &rate);
                let force = state.force();
                self.force[a] -= force;
                self.force[b] += force;
                self.springs[spring + e] = state;
            }
            for node in 1..line.elements() {
                let k = first + node;
                let Some(stiffness) = &lumped.bends[k] else {
                    continue;
                };
                let before = &self.springs[spring + node - 1].segment;
                let after = &self.springs[spring + node].segment;
                let state = BendState::new(stiffness, before, after);
                let [p, q] = state.forces(before, after);
                self.force[k - 1] -= p;
                self.force[k] += p - q;
                self.force[k + 1] += q;
                self.bends[k] = state;
            }
            for end in 0..2 {
                self.hold(at, line, index, end);
            }
        }
    }

    /// Guide and tie at an end.
    fn hold(&mut self, at: &Situation<'_>, line: &LumpedLine, index: usize, end: usize) {
        let Some(held) = &line.ends[end] else { return };
        let seat = held.seat(at);
        let k = line.nodes.start + line.end_node(end);
        if let Some((_, guide)) = &held.guide {
            let element = line.springs.start + if end == 0 { 0 } else { line.elements() - 1 };
            let segment = &self.springs[element].segment;
            let state = GuideState::new(guide, &held.direction(&seat), segment);
            let force = state.force(segment);
            let first = line.nodes.start + if end == 0 { 0 } else { line.elements() - 1 };
            self.force[first] -= force;
            self.force[first + 1] += force;
            self.guides[index][end] = state;
        }
        if let Some(tie) = &held.tie {
            let state = tie.at(&seat, &self.position[k]);
            self.force[k] += state.force;
            self.ties[index][end] = state;
        }
    }

    /// Motion of a node, with the chord from the node before to the node after.
    #[inline]
    pub(super) fn motion(&self, line: &LumpedLine, node: usize) -> NodeMotion {
        let k = line.nodes.start + node;
        let before = line.nodes.start + node.saturating_sub(1);
        let after = line.nodes.start + (node + 1).min(line.elements());
        NodeMotion {
            position: self.position[k],
            velocity: self.velocity[k],
            acceleration: self.acceleration[k],
            chord: self.position[after] - self.position[before],
        }
    }

    /// Adds inertia and loads of the nodes of one line to their forces and, with `weights`, their
    /// derivatives to its matrix.
    fn load_nodes(
        &mut self,
        at: &Situation<'_>,
        line: &LumpedLine,
        index: usize,
        weights: Option<&TangentWeights<'_>>,
    ) {
        let lumped = Arc::clone(&self.lumped);
        let (nodes, n) = (line.nodes.clone(), line.elements());
        let motion = LineMotion {
            position: &self.position[nodes.clone()],
            velocity: &self.velocity[nodes.clone()],
            acceleration: &self.acceleration[nodes.clone()],
        };
        let force = &mut self.force[nodes.clone()];
        self.inner[index].add(&at.sea, &motion, weights, force, &mut self.band);
        for end in 0..2 {
            let node = line.end_node(end);
            let (own, motion) = (&lumped.nodes[nodes.start + node], self.motion(line, node));
            let load = NodeLoad::new(own, &motion, &at.sea);
            self.force[nodes.start + node] += load.force(own, &motion);
            let Some(weights) = weights else { continue };
            let tangent = load.tangent(own, &motion);
            let total = tangent.position
                + tangent.velocity * weights.velocity
                + tangent.acceleration * weights.acceleration;
            self.band.add_node(node, n, &total, &tangent.chord);
            self.band.end_velocity[end] = tangent.velocity;
            self.band.end_acceleration[end] = tangent.acceleration;
        }
    }

    /// Adds springs, bending and ends to the matrix of one line.
    fn fill_band(&mut self, line: &LumpedLine, index: usize, weights: &TangentWeights<'_>) {
        let lumped = Arc::clone(&self.lumped);
        let (first, spring) = (line.nodes.start, line.springs.start);
        let n = line.elements();
        let mut band = std::mem::take(&mut self.band);
        for e in 0..n {
            let (a, b) = (first + e, first + e + 1);
            let rate = self.velocity[b] - self.velocity[a];
            let predicted = self.has_prediction.then(|| self.predicted[spring + e]);
            let law = &lumped.springs[spring + e];
            let tangent = self.springs[spring + e].tangent(law, &rate, predicted, weights.velocity);
            band.add_element(e, &tangent);
        }
        for node in 1..n {
            if lumped.bends[first + node].is_some() {
                let before = &self.springs[spring + node - 1].segment;
                let after = &self.springs[spring + node].segment;
                band.add_bend(node, &self.bends[first + node].tangent(before, after));
            }
        }
        for end in 0..2 {
            let Some(held) = &line.ends[end] else {
                continue;
            };
            let e = if end == 0 { 0 } else { n - 1 };
            let segment = &self.springs[spring + e].segment;
            if held.guide.is_some() {
                band.add_element(e, &self.guides[index][end].tangent(segment).force);
            }
            if held.tie.is_some() {
                band.own[line.end_node(end)] += self.ties[index][end].tangent().force;
            }
            let law = &lumped.springs[spring + e];
            let t = &segment.direction;
            band.end_damping[end] = t * t.transpose() * (law.damping * law.stiffness);
        }
        self.band = band;
    }
}

/// What stands where no derivatives are wanted.
const NO_WEIGHTS: TangentWeights<'_> = TangentWeights {
    velocity: 0.0,
    acceleration: 0.0,
    rotation: None,
};

impl Evaluation for LumpedEvaluation {
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
        clear_lines(at.system, weights.is_some(), residual, matrix);
        self.gather(at);
        self.evaluate(at);
        let lumped = Arc::clone(&self.lumped);
        for (index, line) in lumped.lines.iter().enumerate() {
            if weights.is_some() {
                self.band.clear(line.elements() + 1);
            }
            self.load_nodes(at, line, index, weights);
            for node in 0..=line.elements() {
                let k = line.nodes.start + node;
                if let Some((block, half)) = line.slot(node) {
                    let mut rows = residual[block].fixed_rows_mut::<3>(3 * half);
                    rows += self.force[k];
                }
            }
            if let Some(weights) = weights {
                self.fill_band(line, index, weights);
                self.band.scatter(line, lumped.idle_stiffness, matrix);
            }
            for end in 0..2 {
                let wanted = weights.is_some().then_some(&mut *matrix);
                let weights = weights.unwrap_or(&NO_WEIGHTS);
                self.add_body(at, line, index, end, weights, residual, wanted);
            }
        }
    }

    fn begin(&mut self) {
        self.has_prediction = false;
    }

    fn moving(&mut self, _: &System, increment: &[Vector6]) {
        for (line, arms) in self.lumped.lines.iter().zip(&self.arms) {
            let mut before = line.node_move(arms, increment, 0);
            for e in 0..line.elements() {
                let after = line.node_move(arms, increment, e + 1);
                let spring = line.springs.start + e;
                self.predicted[spring] = self.springs[spring].predicted(&(after - before));
                before = after;
            }
        }
        self.has_prediction = true;
    }

    fn node(&self, at: &Situation<'_>, line: usize, node: usize) -> NodeResult {
        nodes::node(self, at, line, node)
    }

    fn end_load(&self, _: &Situation<'_>, line: usize, end: usize) -> Vector6 {
        nodes::end_load(self, line, end)
    }

    fn add_energy(&self, at: &Situation<'_>, terms: &mut EnergyTerms) {
        for (index, line) in self.lumped.lines.iter().enumerate() {
            for node in 0..=line.elements() {
                let k = line.nodes.start + node;
                let (own, motion) = (&self.lumped.nodes[k], self.motion(line, node));
                let load = NodeLoad::new(own, &motion, &at.sea);
                terms.add(load.energy(own, &motion, &at.sea));
                if self.lumped.bends[k].is_some() {
                    terms.elastic += self.bends[k].energy();
                }
            }
            for e in 0..line.elements() {
                let (a, b) = (line.nodes.start + e, line.nodes.start + e + 1);
                let state = &self.springs[line.springs.start + e];
                let law = &self.lumped.springs[line.springs.start + e];
                terms.elastic += law.tension(state.extension).2;
                terms.structural_damping +=
                    state.damping_power(&(self.velocity[b] - self.velocity[a]));
            }
            for end in 0..2 {
                let Some(held) = &line.ends[end] else {
                    continue;
                };
                terms.elastic += self.guides[index][end].energy() + self.ties[index][end].energy;
                if let Carrier::Vessel(vessel) = held.carrier {
                    let motion = &at.vessels[vessel];
                    // What the support feels is the opposite of what it has to hold.
                    let load = nodes::end_load(self, index, end);
                    let force: Vector3 = load.fixed_rows::<3>(0).into();
                    let moment: Vector3 = load.fixed_rows::<3>(3).into();
                    let arm = match held.tie {
                        Some(_) => self.ties[index][end].arm,
                        None => motion.rotation * held.arm,
                    };
                    let velocity = motion.velocity + motion.spin.cross(&arm);
                    terms.moved_ends -= force.dot(&velocity) + moment.dot(&motion.spin);
                }
            }
        }
    }

    fn add_momentum(&self, _: &Situation<'_>, momentum: &mut Momentum) {
        for (k, node) in self.lumped.nodes.iter().enumerate() {
            momentum.add_point(&self.position[k], &(self.velocity[k] * node.mass));
        }
    }

    fn add_mass(&self, at: &Situation<'_>, in_water: bool, mass: &mut BlockMatrix) {
        let mut smallest = f64::INFINITY;
        for line in &self.lumped.lines {
            for node in 0..=line.elements() {
                let own = &self.lumped.nodes[line.nodes.start + node];
                let motion = self.motion(line, node);
                let load = NodeLoad::new(own, &motion, &at.sea);
                let tensor = load.mass(own, in_water);
                smallest = smallest.min(own.mass);
                if let Some((block, half)) = line.slot(node) {
                    mass.diagonal[block].add_quadrant(half, half, &tensor);
                } else if let Some(held) = line.seat(node)
                    && let Carrier::Free(body) = held.carrier
                {
                    let arm = hat(&held.seat(at).arm);
                    let block: &mut Block6 = &mut mass.diagonal[body];
                    block.add_quadrant(0, 0, &tensor);
                    block.add_quadrant(0, 1, &-(tensor * arm));
                    block.add_quadrant(1, 0, &(arm * tensor));
                    block.add_quadrant(1, 1, &-(arm * tensor * arm));
                }
            }
        }
        // Idle points are faster than everything else.
        let idle = Matrix3::identity() * (1e-6 * smallest);
        for line in &self.lumped.lines {
            for slot in line.arrangement.idle() {
                let block = line.first_block + slot.block;
                mass.diagonal[block].add_quadrant(slot.half, slot.half, &idle);
            }
        }
    }

    fn structural_damping(&self, at: &Situation<'_>) -> f64 {
        let velocity = |line: &LumpedLine, node: usize| -> Vector3 {
            match (line.slot(node), line.seat(node)) {
                (Some((block, half)), _) => {
                    at.state.velocity[block].fixed_rows::<3>(3 * half).into()
                }
                (None, Some(held)) => held.seat(at).velocity(),
                (None, None) => Vector3::zeros(),
            }
        };
        let mut power = 0.0;
        for line in &self.lumped.lines {
            for e in 0..line.elements() {
                let k = line.springs.start + e;
                let (law, segment) = (&self.lumped.springs[k], &self.springs[k].segment);
                let rate = segment
                    .direction
                    .dot(&(velocity(line, e + 1) - velocity(line, e)));
                power += law.damping * law.stiffness * rate * rate;
            }
        }
        power
    }

    /// Idle points have a stiffness from the start.
    fn hold_idle_spins(&self, _: &Situation<'_>, _: &mut BlockMatrix) {}

    /// Translations of the nodes; each turns as the elements beside it do, without a spin.
    fn motion_at_nodes(&self, at: &Situation<'_>, x: &[Vector6], line: usize) -> Vec<Vector6> {
        let own = &self.lumped.lines[line];
        let (n, arms) = (own.elements(), own.arms(at));
        let moves: Vec<Vector3> = (0..=n).map(|node| own.node_move(&arms, x, node)).collect();
        let turns: Vec<Vector3> = (0..n)
            .map(|e| {
                let segment = &self.springs[own.springs.start + e].segment;
                segment.direction.cross(&(moves[e + 1] - moves[e])) / segment.length
            })
            .collect();
        (0..=n)
            .map(|node| {
                let sides = [node.saturating_sub(1), node.min(n - 1)];
                six(&moves[node], &((turns[sides[0]] + turns[sides[1]]) * 0.5))
            })
            .collect()
    }

    fn stable_step(&self, at: &Situation<'_>) -> Option<f64> {
        Some(limits::stable_step(self, at))
    }
}
