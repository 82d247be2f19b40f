//! One step along an equilibrium path: a configuration and a load factor that are in equilibrium,
//! at a given distance along the tangent, or at a given factor.
//!
//! Source: docs/theory/path.md, eqs. (1) to (6).

use catenix_numerics::{
    Configuration, ImplicitSystem, Matrix3, MotionState, ResidualSize, TangentWeights, Vector6, so3,
};

use super::statics::{LARGEST_STEP, ROTATION_LIMIT, SPIN_HOLD, move_frame, travelled};
use crate::system::SystemSolver;

/// Lengths in which the path is measured.
#[derive(Debug, Clone, Copy)]
pub(super) struct PathScale {
    /// Length that counts as 1 [m].
    pub length: f64,
    /// Factor that counts as 1 [-].
    pub factor: f64,
    /// Number of frames that are pairs of points.
    pub pairs: usize,
}

impl PathScale {
    /// Product of two motions of all frames.
    fn product(&self, a: &[Vector6], b: &[Vector6]) -> f64 {
        let square = self.length * self.length;
        let sum: f64 = a
            .iter()
            .zip(b)
            .enumerate()
            .map(|(k, (a, b))| {
                let moved = a.fixed_rows::<3>(0).dot(&b.fixed_rows::<3>(0));
                let rest = a.fixed_rows::<3>(3).dot(&b.fixed_rows::<3>(3));
                // The second point of a pair moves, too.
                let unit = if k < self.pairs { square } else { 1.0 };
                moved / square + rest / unit
            })
            .sum();
        sum / a.len() as f64
    }
}

/// Direction of the path at a point, of length 1 in its scale.
#[derive(Debug, Clone)]
pub(super) struct PathTangent {
    /// Motion of the frames (n).
    pub motion: Vec<Vector6>,
    /// Change of the factor.
    pub factor: f64,
    /// Negative eigenvalues of the stiffness: motions in which the equilibrium is unstable.
    pub unstable: usize,
}

impl PathTangent {
    /// Cosine of the angle to another tangent.
    pub fn along(&self, other: &PathTangent, scale: &PathScale) -> f64 {
        scale.product(&self.motion, &other.motion)
            + self.factor * other.factor / (scale.factor * scale.factor)
    }
}

/// What closes the equations: one more than there are of equilibrium.
pub(super) enum Closure<'t> {
    /// This far along the tangent.
    Distance(&'t PathTangent, f64),
    /// At this factor, with the first guess at a share of the last step.
    Factor(f64),
}

/// A step that did not converge.
#[derive(Debug, Clone, Copy)]
pub(super) struct StepFailure {
    /// Residual when it was given up.
    pub residual: ResidualSize,
}

/// The state on the path with the room that steps need.
pub(super) struct PathWalker<'a> {
    pub solver: SystemSolver<'a>,
    /// Current configuration, at rest.
    pub state: MotionState,
    /// Current factor.
    pub factor: f64,
    pub scale: PathScale,
    /// Newton iterations so far.
    pub iterations: usize,
    pub allowed: f64,
    pub max_iterations: usize,
    start: Configuration,
    start_factor: f64,
    travel: Vec<Vector6>,
    weights: Vec<Matrix3>,
    residual: Vec<Vector6>,
    by_residual: Vec<Vector6>,
    by_factor: Vec<Vector6>,
}

impl<'a> PathWalker<'a> {
    pub fn new(
        solver: SystemSolver<'a>,
        state: MotionState,
        factor: f64,
        scale: PathScale,
    ) -> Self {
        let n = state.configuration.len();
        let zeros = vec![Vector6::zeros(); n];
        PathWalker {
            solver,
            start: state.configuration.clone(),
            start_factor: factor,
            state,
            factor,
            scale,
            iterations: 0,
            allowed: 0.0,
            max_iterations: 0,
            travel: zeros.clone(),
            weights: vec![Matrix3::identity(); n],
            residual: zeros.clone(),
            by_residual: zeros.clone(),
            by_factor: zeros,
        }
    }

    /// Makes the current point the start of the next step.
    pub fn settle(&mut self) {
        self.state.configuration.orthonormalise();
        self.start.copy_from(&self.state.configuration);
        self.start_factor = self.factor;
    }

    /// Goes back to the start of the step.
    pub fn go_back(&mut self) {
        self.state.configuration.copy_from(&self.start);
        self.factor = self.start_factor;
    }

    /// Largest residual force at the current point, which is evaluated anew.
    pub fn evaluate(&mut self) -> ResidualSize {
        self.solver.set_load_factor(self.factor);
        self.solver
            .assemble(0.0, &self.state, None, &mut self.residual);
        self.solver.residual_size(&self.residual)
    }

    /// Direction of the path at the current point, towards a rising factor; `None` where the
    /// stiffness is singular.
    pub fn tangent(&mut self) -> Option<PathTangent> {
        self.travel.fill(Vector6::zeros());
        self.solver.begin();
        self.linearise()?;
        let motion = self.by_factor.clone();
        let square = self.scale.product(&motion, &motion) + 1.0 / self.scale.factor.powi(2);
        let norm = square.sqrt();
        norm.is_finite().then(|| PathTangent {
            motion: motion.iter().map(|d| d / norm).collect(),
            factor: 1.0 / norm,
            unstable: self.solver.negative_eigenvalues(),
        })
    }

    /// Takes a step from its start; returns the iterations that it took.
    pub fn step(&mut self, closure: &Closure<'_>) -> Result<usize, StepFailure> {
        self.predict(closure);
        self.solver.begin();
        let mut iterations = 0;
        loop {
            let residual = self.evaluate();
            let failure = StepFailure { residual };
            if !residual.newtons.is_finite() {
                return Err(failure);
            }
            // A point is wanted where it was asked for, not only on the path: one iteration at
            // least, which also makes up for the curvature of rotations.
            if residual.newtons <= self.allowed && iterations > 0 {
                return Ok(iterations);
            }
            if iterations == self.max_iterations {
                return Err(failure);
            }
            self.linearise().ok_or(failure)?;
            iterations += 1;
            self.iterations += 1;
            if !self.correct(closure) {
                return Err(failure);
            }
        }
    }

    /// First guess: along the tangent, or part of the way that the last step went.
    fn predict(&mut self, closure: &Closure<'_>) {
        match closure {
            Closure::Distance(tangent, distance) => {
                self.go_back();
                for (k, d) in tangent.motion.iter().enumerate() {
                    move_frame(self.solver.system(), k, &(d * *distance), &mut self.state);
                }
                self.factor += tangent.factor * distance;
            }
            Closure::Factor(factor) => {
                let share = (factor - self.start_factor) / (self.factor - self.start_factor);
                for k in 0..self.travel.len() {
                    let way = travelled(k, &self.start, &self.state) * share;
                    let configuration = &mut self.state.configuration;
                    configuration.position[k] = self.start.position[k];
                    configuration.rotation[k] = self.start.rotation[k];
                    if let Some(second) = self.start.second.get(k) {
                        configuration.second[k] = *second;
                    }
                    move_frame(self.solver.system(), k, &way, &mut self.state);
                }
                self.factor = *factor;
            }
        }
        self.measure();
    }

    fn measure(&mut self) {
        for k in 0..self.travel.len() {
            self.travel[k] = travelled(k, &self.start, &self.state);
        }
    }

    /// Solves for the motion that the residual asks for, and for that by the factor.
    fn linearise(&mut self) -> Option<()> {
        let weights = TangentWeights {
            velocity: 0.0,
            acceleration: 1.0 / (LARGEST_STEP * LARGEST_STEP),
            rotation: None,
        };
        self.solver.set_load_factor(self.factor);
        self.solver
            .assemble(0.0, &self.state, Some(&weights), &mut self.residual);
        self.solver.hold_spins(&self.state, SPIN_HOLD, 0.0);
        self.solver
            .solve(&self.residual, &mut self.by_residual)
            .ok()?;
        self.solver.load_direction(&self.state, &mut self.by_factor);
        self.solver.solve_for(&mut self.by_factor);
        Some(())
    }

    /// Applies the increments that the closure asks for; false when they turn too far.
    fn correct(&mut self, closure: &Closure<'_>) -> bool {
        let change = match closure {
            Closure::Factor(factor) => factor - self.factor,
            Closure::Distance(tangent, distance) => {
                // The travel follows an increment by the inverse Jacobian of its rotation.
                let turns = self.weights.iter_mut().zip(&self.travel);
                for (weight, travel) in turns.skip(self.scale.pairs) {
                    *weight = so3::left_jacobian_inverse(&travel.fixed_rows::<3>(3).into_owned());
                }
                let along = |motion: &[Vector6]| -> f64 {
                    let followed: Vec<Vector6> = motion
                        .iter()
                        .zip(&self.weights)
                        .map(|(d, weight)| {
                            let mut followed = *d;
                            let turn = weight * d.fixed_rows::<3>(3);
                            followed.fixed_rows_mut::<3>(3).copy_from(&turn);
                            followed
                        })
                        .collect();
                    self.scale.product(&tangent.motion, &followed)
                };
                let square = self.scale.factor * self.scale.factor;
                let gone = self.scale.product(&tangent.motion, &self.travel)
                    + tangent.factor * (self.factor - self.start_factor) / square;
                (distance - gone - along(&self.by_residual))
                    / (along(&self.by_factor) + tangent.factor / square)
            }
        };
        for (d, by_factor) in self.by_residual.iter_mut().zip(&self.by_factor) {
            *d += by_factor * change;
        }
        let turn = self.solver.system().largest_turn(&self.by_residual);
        if !turn.is_finite() || turn > ROTATION_LIMIT {
            return false;
        }
        self.solver.moving(&self.by_residual);
        for k in 0..self.travel.len() {
            move_frame(
                self.solver.system(),
                k,
                &self.by_residual[k],
                &mut self.state,
            );
        }
        self.factor += change;
        self.measure();
        true
    }
}
