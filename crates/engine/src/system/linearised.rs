//! The system linearised about a state: mass matrix, tangent, structural damping of a small
//! motion, and what such a motion is at the nodes of a line.

use catenix_numerics::{
    Block6, BlockMatrix, ImplicitSystem, Matrix3, MotionState, TangentWeights, Vector3, Vector6,
};

use super::assembly::{EvaluatedPair, frame_motion};
use super::solver::SystemSolver;
use super::{Carrier, ConnectorLaw, Mount, System, frames};
use crate::element::dem::pair::six;

impl SystemSolver<'_> {
    /// Tangent stiffness at `state`, which is at rest: derivative of all forces by the increments.
    ///
    /// Elements that meet no torsional stiffness at all (chains, ropes without it) could spin about
    /// their axis each by itself, which moves nothing: they are held.
    pub(crate) fn stiffness(&mut self, state: &MotionState) -> &BlockMatrix {
        let weights = TangentWeights {
            velocity: 0.0,
            acceleration: 0.0,
            rotation: None,
        };
        let mut residual = vec![Vector6::zeros(); self.system.frames.len()];
        self.begin();
        self.assemble(0.0, state, Some(&weights), &mut residual);
        self.hold_idle_spins(state);
        &self.matrix
    }

    /// Gives elements without torsional stiffness on either side one about their axis: their spin
    /// is then as fast as the extension of one element.
    fn hold_idle_spins(&mut self, state: &MotionState) {
        let system = self.system;
        let mut idle = vec![true; system.body_frame(0)];
        let mut axial = vec![0.0f64; idle.len()];
        for connector in &system.connectors {
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
            let axis = state.configuration.rotation[k] * frame.axis;
            let held = axis * axis.transpose() * (axial[k] * frame.inertia.x / frame.mass);
            self.matrix.diagonal[k].add_quadrant(1, 1, &held);
        }
    }

    /// Mass matrix at `state`, one symmetric block per frame, with the added mass if `in_water`.
    ///
    /// Source: docs/theory/modes.md, eq. (2).
    pub(crate) fn mass(&self, state: &MotionState, in_water: bool) -> Vec<Block6> {
        let sea = self.sea(0.0);
        let system = self.system;
        let mut mass: Vec<Block6> = (0..system.frames.len())
            .map(|k| frames::frame_mass(&system.frames[k], &frame_motion(state, k), &sea, in_water))
            .collect();
        for lump in &system.lumps {
            let motion = frame_motion(state, lump.frame);
            let own = frames::lump_mass(lump, &motion, &sea, in_water);
            mass[lump.frame] = mass[lump.frame].plus(1.0, &own);
        }
        mass
    }

    /// v^T C v with the structural damping C about `state`: the power that it takes from the
    /// velocities `v` [W].
    pub(crate) fn structural_damping(&self, state: &mut MotionState, v: &[Vector6]) -> f64 {
        state.velocity.copy_from_slice(v);
        let power = self
            .system
            .connectors
            .iter()
            .map(|connector| EvaluatedPair::new(connector, state, &self.vessels).damping_power())
            .sum::<f64>();
        state.velocity.fill(Vector6::zeros());
        -power
    }

    /// Small motion of the nodes of a line for the small motion `x` of the frames: at each node
    /// the mean of the two elements that meet there, and at an end the support, (n_elements + 1)
    /// translations and rotations.
    ///
    /// Source: docs/theory/modes.md, eq. (18).
    pub(crate) fn motion_at_nodes(
        &self,
        state: &MotionState,
        x: &[Vector6],
        line: usize,
    ) -> Vec<Vector6> {
        let layout = &self.system.lines[line];
        let mount = |node: usize, at_b: bool| Mount::element_end(self.system, line, node, at_b);
        (0..=layout.element_count)
            .map(|node| {
                let before = (node > 0).then(|| mount(node - 1, true));
                let after = (node < layout.element_count).then(|| mount(node, false));
                let end = layout.nodes[node].filter(|_| before.is_none() || after.is_none());
                let Some(connector) = end.map(|index| &self.system.connectors[index]) else {
                    return mean(before.iter().chain(&after).map(|m| m.motion(state, x)));
                };
                // An end is where its support is; a joint lets it turn as the line does.
                let (support, turns) = match (&connector.law, node) {
                    (ConnectorLaw::Joint(_), _) => (connector.first, true),
                    (ConnectorLaw::Beam(_), 0) => (connector.first, false),
                    (ConnectorLaw::Beam(_), _) => (connector.second, false),
                };
                let back = Vector3::x() * -connector.law.shift();
                let mut motion = support.shifted(&back).motion(state, x);
                if let Some(own) = before.or(after).filter(|_| turns) {
                    let own = own.motion(state, x);
                    motion
                        .fixed_rows_mut::<3>(3)
                        .copy_from(&own.fixed_rows::<3>(3));
                }
                motion
            })
            .collect()
    }
}

impl Mount {
    /// The end of an element.
    fn element_end(system: &System, line: usize, element: usize, at_b: bool) -> Mount {
        let frame = system.lines[line].first_frame + element;
        let half = 0.5 * system.frames[frame].length;
        Mount {
            carrier: Carrier::Free(frame),
            arm: Vector3::x() * if at_b { half } else { -half },
            axes: Matrix3::identity(),
        }
    }

    /// Small motion of this point for the small motion `x` of the frames; vessels stand still.
    fn motion(&self, state: &MotionState, x: &[Vector6]) -> Vector6 {
        let Carrier::Free(k) = self.carrier else {
            return Vector6::zeros();
        };
        let turn = x[k].fixed_rows::<3>(3).into_owned();
        let lever = state.configuration.rotation[k] * self.arm;
        six(&(x[k].fixed_rows::<3>(0) + turn.cross(&lever)), &turn)
    }
}

fn mean(motions: impl Iterator<Item = Vector6>) -> Vector6 {
    let (count, sum) = motions.fold((0.0, Vector6::zeros()), |(count, sum), motion| {
        (count + 1.0, sum + motion)
    });
    sum / f64::max(count, 1.0)
}
