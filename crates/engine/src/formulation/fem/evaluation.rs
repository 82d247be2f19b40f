//! The elements and joints of all lines at a state.

use std::sync::Arc;

use catenix_numerics::{Block6, BlockMatrix, Matrix3, TangentWeights, Vector3, Vector6};

use super::super::{Evaluation, NodeResult, Situation};
use super::assembly::add_internal;
use super::element::ends::{Blocks, End, Prediction};
use super::element::field::{Carried, ElementBlocks, Field, POINT_COUNT};
use super::element::joint::{JointState, Support};
use super::element::weight::Couples;
use super::kernel::Kernel;
use super::load::SeaLoad;
use super::spans::Spans;
use super::turning::Turning;
use super::{EndJoint, Fem, Idle, Part, Seat, nodes};
use crate::system::frames::{LoadPowers, frame_motion};
use crate::system::{Carrier, EnergyTerms, Momentum, System};

/// Elements as last evaluated.
#[derive(Debug, Clone)]
pub(super) struct FemEvaluation<K: Kernel> {
    pub(super) fem: Arc<Fem<K>>,
    /// The elements that are computed several at a time.
    spans: Spans<K::Lanes>,
    /// All others, one by one.
    others: Vec<Other<K>>,
    /// Inertia of sections.
    turning: Turning,
    /// Frames of lines whose blocks beside the diagonal no span writes.
    bare_links: Vec<usize>,
    /// What each element needs at its two frames: force and moment (2 x n_elements) [N, N m].
    forces: [Vec<Vector6>; 2],
    /// Joints with their support's side (n_joints).
    pub(super) joints: Vec<(JointState, Support)>,
    predicted_joints: Vec<Vector3>,
    has_prediction: bool,
}

/// An element that is computed by itself.
#[derive(Debug, Clone)]
struct Other<K: Kernel> {
    /// Its index among all elements.
    index: usize,
    state: K::State,
    /// From the origin of what carries each end to the end (2 x 3) [m].
    levers: [Vector3; 2],
    predicted: Prediction,
}

impl<K: Kernel> FemEvaluation<K> {
    pub(super) fn new(fem: Arc<Fem<K>>, at: &Situation<'_>) -> FemEvaluation<K> {
        let (spans, others) = Spans::among(&fem);
        let other = |index: usize| {
            let carried = fem.parts[index].carried(at);
            Other {
                index,
                state: state(&fem.kernels[index], &carried),
                levers: [carried[0].lever, carried[1].lever],
                predicted: Prediction::default(),
            }
        };
        let frames = at.system.body_frame(0);
        let mut bare = vec![true; frames];
        for frame in spans.first_frames() {
            bare[frame] = false;
        }
        FemEvaluation {
            spans,
            turning: Turning::new(&fem.rotary, frames),
            bare_links: (0..frames).filter(|&k| bare[k]).collect(),
            others: others.into_iter().map(other).collect(),
            forces: [0, 1].map(|_| vec![Vector6::zeros(); fem.parts.len()]),
            joints: fem
                .joints
                .iter()
                .map(|joint| evaluate_joint(joint, at))
                .collect(),
            predicted_joints: vec![Vector3::zeros(); fem.joints.len()],
            has_prediction: false,
            fem,
        }
    }

    /// What an element needs at one of its frames [N, N m].
    pub(super) fn force(&self, element: usize, end: usize) -> &Vector6 {
        &self.forces[end][element]
    }

    /// Residual and, with `weights`, matrix of the elements that go one by one.
    fn assemble_others(
        &mut self,
        at: &Situation<'_>,
        weights: Option<&TangentWeights<'_>>,
        residual: &mut [Vector6],
        matrix: &mut BlockMatrix,
    ) {
        let fem = &*self.fem;
        for other in &mut self.others {
            let (part, kernel) = (&fem.parts[other.index], &fem.kernels[other.index]);
            let carried = part.carried(at);
            let state = state(kernel, &carried);
            let own = weights.map(|weights| part.weights(weights));
            let load = SeaLoad {
                spread: &part.spread,
                sea: &at.sea,
            };
            let mut element = ElementBlocks::zeros();
            let ends = [&carried[0], &carried[1]];
            let uniform = part.spread.uniform();
            let field = field(part, &carried);
            let mass = part.spread.mass;
            field.add(ends, mass, &uniform, &load, own.as_ref(), &mut element);
            let couples = Couples::new([&ends[0].end, &ends[1].end], part.length, &uniform);
            let prediction = self.has_prediction.then_some(&other.predicted);
            let tangent = own.as_ref().map(|weights| {
                let mut tangent = kernel.tangent(&state, prediction);
                add_blocks(&mut tangent.configuration, &couples.tangent());
                (tangent, weights)
            });
            let tangent = tangent
                .as_ref()
                .map(|(tangent, weights)| (tangent, *weights));
            let forces = kernel.forces(&state).plus(&couples.forces());
            add_internal(&forces, tangent, &carried, &mut element);
            let into = weights.is_some().then_some(&mut *matrix);
            part.scatter(&at.system.topology, &element, residual, into);
            other.state = state;
            other.levers = [carried[0].lever, carried[1].lever];
            for (end, force) in element.force.into_iter().enumerate() {
                self.forces[end][other.index] = force;
            }
        }
    }
}

fn state<K: Kernel>(kernel: &K, carried: &[Carried; 2]) -> K::State {
    kernel.state(&[carried[0].end, carried[1].end])
}

fn evaluate_joint(joint: &EndJoint, at: &Situation<'_>) -> (JointState, Support) {
    let side = joint.side(at);
    let configuration = &at.state.configuration;
    let (position, rotation) = (
        &configuration.position[joint.node],
        &configuration.rotation[joint.node],
    );
    (
        JointState::new(&joint.springs, &side, position, rotation),
        side,
    )
}

fn add_blocks(sum: &mut Blocks, other: &Blocks) {
    for (sum, other) in sum.iter_mut().flatten().zip(other.iter().flatten()) {
        *sum += other;
    }
}

fn field(part: &Part, carried: &[Carried; 2]) -> Field {
    Field::new([&carried[0].end, &carried[1].end], part.length)
}

impl Idle {
    /// From the node to where the vessel has it (3) [m].
    pub(super) fn lag(&self, at: &Situation<'_>) -> Vector3 {
        let held = Seat::Hinged(self.frame, self.mount)
            .carried(at)
            .end
            .position;
        held - at.state.configuration.position[self.frame]
    }
}

impl<K: Kernel> Evaluation for FemEvaluation<K> {
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
        self.turning.put(at, weights, residual, matrix);
        if weights.is_some() {
            for &k in &self.bare_links {
                matrix.upper[k] = Block6::ZERO;
                matrix.lower[k] = Block6::ZERO;
            }
        }
        let topology = &at.system.topology;
        self.spans
            .assemble(at, weights, &mut self.forces, residual, matrix);
        self.assemble_others(at, weights, residual, matrix);
        let fem = &*self.fem;
        for (index, joint) in fem.joints.iter().enumerate() {
            let (state, side) = evaluate_joint(joint, at);
            let blocks = weights.map(|_| {
                let rotation = &at.state.configuration.rotation[joint.node];
                let prediction = self.has_prediction.then(|| &self.predicted_joints[index]);
                state.tangent(&joint.springs, &side, rotation, prediction)
            });
            let forces = state.forces(&side);
            joint.scatter(topology, &forces, blocks.as_ref(), residual, matrix);
            self.joints[index] = (state, side);
        }
        for idle in &fem.idle {
            let mut force = residual[idle.frame].fixed_rows_mut::<3>(0);
            force -= idle.lag(at) * idle.stiffness;
            if weights.is_some() {
                let stiffness = Matrix3::identity() * idle.stiffness;
                matrix.diagonal[idle.frame].add_quadrant(0, 0, &stiffness);
            }
        }
    }

    fn begin(&mut self) {
        self.has_prediction = false;
        self.spans.begin();
    }

    fn moving(&mut self, _: &System, increment: &[Vector6]) {
        let fem = &*self.fem;
        self.spans.moving(increment);
        for other in &mut self.others {
            let (part, kernel) = (&fem.parts[other.index], &fem.kernels[other.index]);
            let moves = [0, 1].map(|k: usize| part.seats[k].moved(&other.levers[k], increment));
            other.predicted = kernel.predicted(&other.state, &moves);
        }
        let joints = fem.joints.iter().zip(&self.joints);
        for (prediction, (joint, (state, side))) in self.predicted_joints.iter_mut().zip(joints) {
            let of = |frame: usize| {
                let d = &increment[frame];
                (d.fixed_rows::<3>(0).into(), d.fixed_rows::<3>(3).into())
            };
            let support = match joint.support.carrier {
                Carrier::Free(body) => of(body),
                Carrier::Vessel(_) => (Vector3::zeros(), Vector3::zeros()),
            };
            *prediction = state.predicted(&joint.springs, side, &[support, of(joint.node)]);
        }
        self.has_prediction = true;
    }

    fn node(&self, at: &Situation<'_>, line: usize, node: usize) -> NodeResult {
        nodes::node(self, at, line, node)
    }

    fn end_load(&self, at: &Situation<'_>, line: usize, end: usize) -> Vector6 {
        nodes::end_load(self, at, line, end)
    }

    fn add_energy(&self, at: &Situation<'_>, terms: &mut EnergyTerms) {
        let fem = &*self.fem;
        let [elastic, damping] = self.spans.elastic_energy();
        terms.elastic += elastic;
        terms.structural_damping += damping;
        if at.sea.seabed.is_some() {
            for index in self.spans.elements() {
                terms.add(spread_energy(&fem.parts[index], at));
            }
        } else {
            terms.add(self.spans.energies(at));
        }
        for other in &self.others {
            let (part, kernel) = (&fem.parts[other.index], &fem.kernels[other.index]);
            terms.add(spread_energy(part, at));
            terms.elastic += kernel.energy(&other.state);
            terms.structural_damping += K::damping_power(&other.state);
            for (k, seat) in part.seats.iter().enumerate() {
                terms.moved_ends += moved_end_power(seat, self.force(other.index, k), at);
            }
        }
        terms.kinetic += self.turning.kinetic_energy(at);
        for (joint, (state, side)) in fem.joints.iter().zip(&self.joints) {
            terms.elastic += state.energy();
            if let Carrier::Vessel(vessel) = joint.support.carrier {
                let [force, _] = state.forces(side);
                let motion = &at.vessels[vessel];
                terms.moved_ends += force.fixed_rows::<3>(0).dot(&motion.velocity)
                    + force.fixed_rows::<3>(3).dot(&motion.spin);
            }
        }
        for idle in &fem.idle {
            // What sits on the node itself is carried by the vessel through the idle stiffness.
            let held = Seat::Hinged(idle.frame, idle.mount).carried(at).end;
            terms.moved_ends += (idle.lag(at) * idle.stiffness).dot(&held.velocity);
        }
    }

    fn add_momentum(&self, at: &Situation<'_>, momentum: &mut Momentum) {
        for part in &self.fem.parts {
            let [linear, angular] = field(part, &part.carried(at)).momentum(part.spread.mass);
            momentum.linear += linear;
            momentum.angular += angular;
        }
        for rotary in &self.fem.rotary {
            let m = frame_motion(at.state, rotary.frame);
            momentum.angular += rotary.tensor(&m.rotation) * m.spin;
        }
    }

    fn add_mass(&self, at: &Situation<'_>, in_water: bool, mass: &mut BlockMatrix) {
        let topology = &at.system.topology;
        for part in &self.fem.parts {
            let carried = part.carried(at);
            let mut blocks = ElementBlocks::zeros().block;
            let added = |station: &_| match in_water {
                true => part.spread.added_mass(station),
                false => Matrix3::zeros(),
            };
            let ends = [&carried[0], &carried[1]];
            field(part, &carried).add_mass(ends, part.spread.mass, added, &mut blocks);
            part.scatter_blocks(topology, &blocks, mass);
        }
        for rotary in &self.fem.rotary {
            let rotation = &at.state.configuration.rotation[rotary.frame];
            let tensor = rotary.tensor(rotation);
            mass.diagonal[rotary.frame].add_quadrant(1, 1, &tensor);
        }
        for idle in &self.fem.idle {
            let own = Matrix3::identity() * idle.mass;
            mass.diagonal[idle.frame].add_quadrant(0, 0, &own);
        }
    }

    fn structural_damping(&self, at: &Situation<'_>) -> f64 {
        let parts = self.fem.parts.iter().zip(&self.fem.kernels);
        let power =
            |(part, kernel): (&Part, &K)| K::damping_power(&state(kernel, &part.carried(at)));
        -parts.map(power).sum::<f64>()
    }

    /// Nodes that meet no torsional stiffness at all (chains, ropes without it) could spin about
    /// the line each by itself. They are given a stiffness that makes their spin as fast as the
    /// extension of one element.
    fn hold_idle_spins(&self, at: &Situation<'_>, matrix: &mut BlockMatrix) {
        let fem = &*self.fem;
        let first_body = at.system.body_frame(0);
        let mut held = vec![f64::INFINITY; first_body];
        for (part, kernel) in fem.parts.iter().zip(&fem.kernels) {
            let section = kernel.section();
            let frequency = section.axial / (section.length * part.spread.mass * section.length);
            for frame in part.seats.iter().filter_map(Seat::frame) {
                if frame < first_body {
                    let own = if section.torsion > 0.0 {
                        0.0
                    } else {
                        frequency
                    };
                    held[frame] = held[frame].min(own);
                }
            }
        }
        for joint in fem
            .joints
            .iter()
            .filter(|j| !j.springs.directions.is_empty())
        {
            held[joint.node] = 0.0;
        }
        for (frame, frequency) in held.iter().enumerate() {
            if *frequency > 0.0 && frequency.is_finite() {
                let own = &at.system.frames[frame];
                let axis = at.state.configuration.rotation[frame] * own.axis;
                let stiffness = axis * axis.transpose() * (frequency * own.inertia.x);
                matrix.diagonal[frame].add_quadrant(1, 1, &stiffness);
            }
        }
    }

    /// Source: docs/theory/modes.md, eq. (18).
    fn motion_at_nodes(&self, at: &Situation<'_>, x: &[Vector6], line: usize) -> Vec<Vector6> {
        let own = &self.fem.lines[line];
        (0..=own.element_count)
            .map(|node| {
                let element = own.first_element + node.min(own.element_count - 1);
                let seat = &self.fem.parts[element].seats[usize::from(node == own.element_count)];
                let (shift, turn) = seat.moved(&seat.carried(at).lever, x);
                Vector6::new(shift.x, shift.y, shift.z, turn.x, turn.y, turn.z)
            })
            .collect()
    }
}

/// Kinetic and potential energy of what is spread over an element [J], and the powers of its loads.
fn spread_energy(part: &Part, at: &Situation<'_>) -> (f64, f64, LoadPowers) {
    let carried = part.carried(at);
    let field = field(part, &carried);
    let load = SeaLoad {
        spread: &part.spread,
        sea: &at.sea,
    };
    let ends = [&carried[0].end, &carried[1].end];
    let mut potential = weight_energy(ends, part);
    let mut powers = LoadPowers {
        buoyancy: buoyancy_power(ends, part),
        ..LoadPowers::default()
    };
    for point in 0..POINT_COUNT {
        let station = field.station(point);
        let (contact, own) = load.energy(&station);
        potential += contact * station.length;
        powers.drag += own.drag * station.length;
        powers.added_mass += own.added_mass * station.length;
        powers.buoyancy += own.buoyancy * station.length;
        powers.seabed_damping += own.seabed_damping * station.length;
    }
    (field.kinetic_energy(part.spread.mass), potential, powers)
}

/// Potential of the weight of an element [J].
fn weight_energy(ends: [&End; 2], part: &Part) -> f64 {
    let load = Vector3::z() * -part.spread.weight;
    let height = 0.5 * (ends[0].position.z + ends[1].position.z);
    part.spread.weight * part.length * height + Couples::new(ends, part.length, &load).potential()
}

/// Power of full buoyancy on an element [W].
fn buoyancy_power(ends: [&End; 2], part: &Part) -> f64 {
    let load = Vector3::z() * part.spread.buoyancy;
    let couples = Couples::new(ends, part.length, &load).forces();
    let whole = 0.5 * part.length * load.dot(&(ends[0].velocity + ends[1].velocity));
    whole
        - couples.force.dot(&(ends[1].velocity - ends[0].velocity))
        - couples.moment[0].dot(&ends[0].spin)
        - couples.moment[1].dot(&ends[1].spin)
}

/// Power with which a vessel moves the end that it carries [W].
fn moved_end_power(seat: &Seat, needed: &Vector6, at: &Situation<'_>) -> f64 {
    let force = needed.fixed_rows::<3>(0);
    match seat {
        Seat::Node(_) => 0.0,
        Seat::Hinged(..) => force.dot(&seat.carried(at).end.velocity),
        Seat::Carried(mount) => match mount.carrier {
            Carrier::Free(_) => 0.0,
            Carrier::Vessel(vessel) => {
                let motion = &at.vessels[vessel];
                force.dot(&motion.velocity) + needed.fixed_rows::<3>(3).dot(&motion.spin)
            }
        },
    }
}
