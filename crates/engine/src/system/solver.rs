//! The system as the numerics see it: residual, matrix, increment.

use catenix_numerics::{
    Block6, BlockLu, BlockMatrix, BlockMeasure, CarriedMotion, Elimination, ExplicitSystem,
    Factorisation, ImplicitSystem, Matrix3, MotionState, ResidualSize, TangentWeights, Vector3,
    Vector6,
};

use super::System;
use super::frames::Sea;
use super::own_axes::OwnAxes;
use super::{assembly, loads};
use crate::body::motion::RigidMotion;
use crate::formulation::{Evaluation, Situation};
use crate::load::variation;

/// Loads that one factor scales, whatever their variation over time.
#[derive(Debug, Clone)]
pub(crate) struct LoadControl {
    /// Indices into the model's loads.
    pub loads: Vec<usize>,
    /// Factor on all of them.
    pub factor: f64,
}

/// A system with the room that solving needs.
#[derive(Debug)]
pub struct SystemSolver<'a> {
    pub(super) system: &'a System,
    /// Whether the current acts.
    current_acts: bool,
    /// Whether vessels have their velocities, or stand still.
    vessels_move: bool,
    pub(super) vessels: Vec<RigidMotion>,
    /// Loads under the control of a factor instead of time.
    load_control: Option<LoadControl>,
    /// Factor on each load, as last evaluated.
    pub(super) load_factors: Vec<f64>,
    /// Time that vessels and factors belong to, if to any.
    placed_at: Option<f64>,
    /// Size of residuals [N] and of increments [m].
    residual_measure: BlockMeasure,
    increment_measure: BlockMeasure,
    pub(super) lines: Box<dyn Evaluation>,
    /// Empty until it is assembled; a solution puts its factors in its place.
    pub(super) matrix: BlockMatrix,
    factors: Elimination,
    own_axes: OwnAxes,
    factorisations: usize,
    explicit_room: Option<Box<ExplicitRoom>>,
}

/// Room for explicit integration.
#[derive(Debug, Clone)]
struct ExplicitRoom {
    residual: Vec<Vector6>,
    mass: BlockMatrix,
}

impl<'a> SystemSolver<'a> {
    /// For equilibrium: vessels stand still, and the current acts only when `current_acts`.
    pub fn at_rest(system: &'a System, current_acts: bool) -> SystemSolver<'a> {
        Self::new(system, current_acts, false)
    }

    /// For motion: vessels move and the current acts.
    pub fn moving(system: &'a System) -> SystemSolver<'a> {
        Self::new(system, true, true)
    }

    fn new(system: &'a System, current_acts: bool, vessels_move: bool) -> SystemSolver<'a> {
        let state = MotionState::at_rest(system.first_shape.clone());
        let vessels: Vec<RigidMotion> = system
            .vessels
            .iter()
            .map(|vessel| vessel.at(0.0).stopped())
            .collect();
        SystemSolver {
            system,
            current_acts,
            vessels_move,
            load_control: None,
            load_factors: vec![0.0; system.model.loads.len()],
            placed_at: None,
            residual_measure: measure(system, |length| 1.0 / length),
            increment_measure: measure(system, |length| 0.5 * length),
            lines: {
                let at = Situation {
                    system,
                    sea: sea(system, 0.0, current_acts),
                    vessels: &vessels,
                    state: &state,
                };
                system.formulation.clone().evaluation(&at)
            },
            vessels,
            matrix: BlockMatrix::default(),
            factors: Elimination::new(&system.topology),
            own_axes: OwnAxes::new(system.frame_count(), system.pair_count()),
            factorisations: 0,
            explicit_room: None,
        }
    }

    /// Gives back the memory of the matrix until the next one is assembled.
    pub(crate) fn rest(&mut self) {
        self.matrix = BlockMatrix::default();
        self.factors.rest();
    }

    /// The system.
    pub fn system(&self) -> &'a System {
        self.system
    }

    /// Puts loads under the control of a factor, to follow an equilibrium path.
    pub(crate) fn control_loads(&mut self, control: LoadControl) {
        self.load_control = Some(control);
        self.placed_at = None;
        // At limit and branch points the matrix is singular.
        self.factors.exchange_rows(&self.system.topology);
    }

    /// Sets the factor on the controlled loads.
    pub(crate) fn set_load_factor(&mut self, factor: f64) {
        if let Some(control) = &mut self.load_control {
            control.factor = factor;
            self.placed_at = None;
        }
    }

    /// Force and moment on each frame per unit of the factor on the controlled loads, (n) [N, N m].
    pub(crate) fn load_direction(&self, state: &MotionState, out: &mut [Vector6]) {
        out.fill(Vector6::zeros());
        if let Some(control) = &self.load_control {
            loads::add_direction(self.system, &control.loads, state, out);
        }
    }

    /// x <- S^-1 x with the factors of the last solution.
    pub(crate) fn solve_for(&mut self, x: &mut [Vector6]) {
        let topology = &self.system.topology;
        self.factors.solve(topology, &self.matrix, x);
    }

    /// x <- S^-1 x with the matrix of the last assembly, not solved with since, and with rows
    /// exchanged: for matrices that are nearly singular on purpose.
    ///
    /// # Errors
    /// The frame whose pivot is singular.
    pub(crate) fn solve_carefully(&mut self, x: &mut [Vector6]) -> Result<(), usize> {
        let topology = &self.system.topology;
        let mut factors = Factorisation::new(topology);
        self.factorisations += 1;
        factors
            .factorise(topology, &self.matrix)
            .map_err(|error| error.frame)?;
        factors.solve(topology, x);
        Ok(())
    }

    /// Number of negative eigenvalues of the last factorised matrix, if it is symmetric.
    pub(crate) fn negative_eigenvalues(&self) -> usize {
        let topology = &self.system.topology;
        let mut factors = Factorisation::new(topology);
        // A singular matrix has shown itself before, when it was solved with.
        match factors.factorise(topology, &self.matrix) {
            Ok(()) => factors.negative_eigenvalues(),
            Err(_) => 0,
        }
    }

    /// Factorisations done so far.
    pub fn factorisations(&self) -> usize {
        self.factorisations
    }

    /// Adds stiffness to the matrix, never to the residual, against the spin of elements about
    /// their axes and the turning of bodies: `frequency_squared` times the inertia, plus `moment`
    /// per radian [N m/rad].
    pub(crate) fn hold_spins(&mut self, state: &MotionState, frequency_squared: f64, moment: f64) {
        let first_body = self.system.body_frame(0);
        let frames = self.system.frames.iter().enumerate();
        for (k, frame) in frames.skip(self.system.pair_count()) {
            let rotation = &state.configuration.rotation[k];
            let held = if k < first_body {
                Vector3::new(frame.inertia.x * frequency_squared + moment, 0.0, 0.0)
            } else {
                (frame.inertia + Vector3::repeat(frame.added_inertia)) * frequency_squared
                    + Vector3::repeat(moment)
            };
            let stiffness = rotation * Matrix3::from_diagonal(&held) * rotation.transpose();
            self.matrix.diagonal[k].add_quadrant(1, 1, &stiffness);
        }
    }

    /// Moves vessels, and what varies with time, to `time`.
    fn place(&mut self, time: f64) {
        if self.placed_at == Some(time) {
            return;
        }
        self.placed_at = Some(time);
        for (motion, vessel) in self.vessels.iter_mut().zip(&self.system.vessels) {
            *motion = vessel.at(time);
            if !self.vessels_move {
                *motion = motion.stopped();
            }
        }
        for (factor, load) in self.load_factors.iter_mut().zip(&self.system.model.loads) {
            *factor = variation::factor(&load.variation, time);
        }
        if let Some(control) = &self.load_control {
            for &load in &control.loads {
                self.load_factors[load] = control.factor;
            }
        }
    }

    /// `state` with its surroundings; the vessels are where the last assembly put them.
    pub(super) fn situation<'s>(&'s self, time: f64, state: &'s MotionState) -> Situation<'s> {
        Situation {
            system: self.system,
            sea: sea(self.system, time, self.current_acts),
            vessels: &self.vessels,
            state,
        }
    }
}

impl Clone for SystemSolver<'_> {
    fn clone(&self) -> Self {
        SystemSolver {
            system: self.system,
            current_acts: self.current_acts,
            vessels_move: self.vessels_move,
            vessels: self.vessels.clone(),
            load_control: self.load_control.clone(),
            load_factors: self.load_factors.clone(),
            placed_at: self.placed_at,
            residual_measure: self.residual_measure.clone(),
            increment_measure: self.increment_measure.clone(),
            lines: self.lines.duplicate(),
            matrix: self.matrix.clone(),
            factors: self.factors.clone(),
            own_axes: self.own_axes.clone(),
            factorisations: self.factorisations,
            explicit_room: self.explicit_room.clone(),
        }
    }
}

/// Measures blocks by a factor on the rotations of frames, from their length [m]. The second point
/// of a pair counts as the first one does.
fn measure(system: &System, of_length: impl Fn(f64) -> f64) -> BlockMeasure {
    let pairs = system.pair_count();
    let frames = system.frames.iter().enumerate();
    BlockMeasure::new(frames.map(|(k, frame)| match k < pairs {
        true => 1.0,
        false => of_length(frame.residual_length),
    }))
}

fn sea(system: &System, time: f64, current_acts: bool) -> Sea<'_> {
    let environment = &system.model.environment;
    Sea {
        current: &system.current,
        current_factor: if current_acts {
            system.current.factor(time)
        } else {
            0.0
        },
        seabed: environment.seabed.as_ref(),
        depth: environment.water.map_or(0.0, |water| water.depth),
    }
}

impl ImplicitSystem for SystemSolver<'_> {
    fn frame_count(&self) -> usize {
        self.system.frames.len()
    }

    fn carry(&mut self, time: f64, carried: &mut CarriedMotion) -> bool {
        if !self.vessels_move {
            return false;
        }
        self.place(time);
        self.system.followers.carry(&self.vessels, carried)
    }

    fn begin(&mut self) {
        self.lines.begin();
    }

    fn assemble(
        &mut self,
        time: f64,
        state: &MotionState,
        weights: Option<&TangentWeights<'_>>,
        residual: &mut [Vector6],
    ) {
        self.place(time);
        if weights.is_some() && self.matrix.diagonal.is_empty() {
            self.matrix = BlockMatrix::zeros(&self.system.topology);
        }
        let at = Situation {
            system: self.system,
            sea: sea(self.system, time, self.current_acts),
            vessels: &self.vessels,
            state,
        };
        assembly::assemble(
            &at,
            &self.load_factors,
            weights,
            &mut *self.lines,
            residual,
            &mut self.matrix,
        );
    }

    fn solve(&mut self, residual: &[Vector6], increment: &mut [Vector6]) -> Result<(), usize> {
        let topology = &self.system.topology;
        self.factorisations += 1;
        self.own_axes.turn(residual, &mut self.matrix, increment);
        self.factors
            .factorise_and_solve(topology, &mut self.matrix, increment)
            .map_err(|error| error.frame)
    }

    fn solve_again(&mut self, residual: &[Vector6], increment: &mut [Vector6]) {
        self.own_axes.opposite(residual, increment);
        let topology = &self.system.topology;
        self.factors.solve(topology, &self.matrix, increment);
    }

    fn moving(&mut self, increment: &[Vector6]) {
        self.own_axes.moving(increment);
        self.lines.moving(self.system, increment);
    }

    fn stepping(&mut self, travel: &[Vector6]) {
        self.own_axes.moving(travel);
    }

    fn residual_size(&self, residual: &[Vector6]) -> ResidualSize {
        let (newtons, frame) = self.residual_measure.largest(residual);
        ResidualSize { newtons, frame }
    }

    fn increment_size(&self, increment: &[Vector6]) -> f64 {
        self.increment_measure.largest(increment).0
    }

    fn explicit(&mut self) -> Option<&mut dyn ExplicitSystem> {
        let has = self.system.formulation.has_mass_of_blocks();
        has.then_some(self)
    }
}

impl ExplicitSystem for SystemSolver<'_> {
    fn accelerate(&mut self, time: f64, state: &mut MotionState) -> Result<(), usize> {
        let mut room = std::mem::take(&mut self.explicit_room);
        let room_mut = room.get_or_insert_with(|| {
            Box::new(ExplicitRoom {
                residual: vec![Vector6::zeros(); self.system.frames.len()],
                mass: BlockMatrix::zeros(&self.system.topology),
            })
        });
        let ExplicitRoom { residual, mass } = &mut **room_mut;
        state.acceleration.fill(Vector6::zeros());
        self.assemble(time, state, None, residual);
        mass.diagonal.fill(Block6::ZERO);
        self.add_mass(&self.situation(time, state), true, mass);
        let blocks = mass.diagonal.iter().zip(residual).enumerate();
        let mut singular = Ok(());
        for (k, (block, residual)) in blocks {
            match BlockLu::factorise(block) {
                Ok(factors) => {
                    factors.solve(residual);
                    state.acceleration[k] = -*residual;
                }
                Err(_) => singular = Err(k),
            }
        }
        self.explicit_room = room;
        singular
    }

    fn stable_step(&mut self, time: f64, state: &MotionState) -> f64 {
        let at = self.situation(time, state);
        self.lines.stable_step(&at).unwrap_or(0.0)
    }
}
