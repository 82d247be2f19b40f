//! Systems with known motions, for the tests of the integrators.

use crate::{
    Configuration, ExplicitSystem, ImplicitSystem, Integrator, Matrix3, MotionState,
    NewtonSettings, ResidualSize, StepSettings, TangentWeights, Vector3, Vector6, so3,
};

/// Mass of a tumbler [kg].
const MASS: f64 = 2.0;

/// A free body with three unlike moments of inertia; one of its points is tied to the origin by a
/// spring.
pub(crate) struct Tumbler {
    pub inertia: Matrix3,
    pub stiffness: f64,
    /// From the centre of mass to the tied point, body axes [m].
    pub arm: Vector3,
    pub matrix: nalgebra::Matrix6<f64>,
    /// New matrices that were solved with.
    pub matrices: usize,
}

impl Tumbler {
    /// Tied at its centre: translation and rotation go their own ways.
    pub(crate) fn free() -> Tumbler {
        Tumbler {
            inertia: Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 3.0)),
            stiffness: 8.0,
            arm: Vector3::zeros(),
            matrix: nalgebra::Matrix6::zeros(),
            matrices: 0,
        }
    }

    /// Tied at another point: the spring turns the body, in all three directions.
    pub(crate) fn tied() -> Tumbler {
        Tumbler {
            arm: Vector3::new(0.3, -0.2, 0.4),
            ..Tumbler::free()
        }
    }

    /// Beside the origin, moving and turning.
    pub(crate) fn start(&self) -> MotionState {
        let mut state = MotionState::at_rest(Configuration::of_frames(
            vec![Vector3::new(1.0, 0.0, 0.0)],
            vec![Matrix3::identity()],
        ));
        state.velocity[0] = Vector6::new(0.0, 1.0, 0.0, 0.3, 2.0, 0.5);
        state.acceleration[0] = self.acceleration(&state);
        state
    }

    /// Acceleration that satisfies the equations of motion.
    fn acceleration(&self, state: &MotionState) -> Vector6 {
        let r = state.configuration.rotation[0];
        let still = self.force(
            state.configuration.position[0],
            r,
            state.velocity[0],
            Vector6::zeros(),
        );
        let turn: Vector3 = still.fixed_rows::<3>(3).into();
        let inverse = self.inertia.map_diagonal(|moment| 1.0 / moment);
        let alpha = -(r * Matrix3::from_diagonal(&inverse) * r.transpose() * turn);
        let a = -still.fixed_rows::<3>(0) / MASS;
        Vector6::new(a.x, a.y, a.z, alpha.x, alpha.y, alpha.z)
    }

    /// Inertia less the spring's force and moment.
    fn force(&self, x: Vector3, r: Matrix3, velocity: Vector6, acceleration: Vector6) -> Vector6 {
        let w: Vector3 = velocity.fixed_rows::<3>(3).into();
        let alpha: Vector3 = acceleration.fixed_rows::<3>(3).into();
        let j = r * self.inertia * r.transpose();
        let arm = r * self.arm;
        let spring = (x + arm) * self.stiffness;
        let force = acceleration.fixed_rows::<3>(0) * MASS + spring;
        let moment = j * alpha + w.cross(&(j * w)) + arm.cross(&spring);
        Vector6::new(force.x, force.y, force.z, moment.x, moment.y, moment.z)
    }

    /// Kinetic energy and that of the spring [J].
    pub(crate) fn energy(&self, state: &MotionState) -> f64 {
        let r = state.configuration.rotation[0];
        let v: Vector3 = state.velocity[0].fixed_rows::<3>(0).into();
        let w: Vector3 = state.velocity[0].fixed_rows::<3>(3).into();
        let stretch = state.configuration.position[0] + r * self.arm;
        0.5 * (MASS * v.norm_squared()
            + w.dot(&(r * self.inertia * r.transpose() * w))
            + self.stiffness * stretch.norm_squared())
    }

    /// The motion after `duration` by the classical Runge-Kutta method, which shares nothing with
    /// the implicit integrators: rotation matrices as nine plain numbers, `steps` steps.
    pub(crate) fn runge_kutta(
        &self,
        start: &MotionState,
        duration: f64,
        steps: usize,
    ) -> MotionState {
        let h = duration / steps as f64;
        let mut state = start.clone();
        for _ in 0..steps {
            let begin = state.clone();
            let mut total = Slope::default();
            let mut last = Slope::default();
            for (reach, weight) in [(0.0, 1.0), (0.5, 2.0), (0.5, 2.0), (1.0, 1.0)] {
                let at = last.moved(&begin, reach * h);
                last = Slope {
                    velocity: at.velocity[0],
                    spin: so3::hat(&at.velocity[0].fixed_rows::<3>(3).into())
                        * at.configuration.rotation[0],
                    acceleration: self.acceleration(&at),
                };
                total.velocity += last.velocity * (weight / 6.0);
                total.spin += last.spin * (weight / 6.0);
                total.acceleration += last.acceleration * (weight / 6.0);
            }
            state = total.moved(&begin, h);
            state.configuration.orthonormalise();
        }
        state.acceleration[0] = self.acceleration(&state);
        state
    }
}

/// Time derivatives of a motion state of one frame.
#[derive(Default)]
struct Slope {
    velocity: Vector6,
    spin: Matrix3,
    acceleration: Vector6,
}

impl Slope {
    fn moved(&self, from: &MotionState, time: f64) -> MotionState {
        let mut to = from.clone();
        to.configuration.position[0] += self.velocity.fixed_rows::<3>(0) * time;
        to.configuration.rotation[0] += self.spin * time;
        to.velocity[0] += self.acceleration * time;
        to
    }
}

impl ImplicitSystem for Tumbler {
    fn frame_count(&self) -> usize {
        1
    }

    fn begin(&mut self) {}

    fn assemble(
        &mut self,
        _time: f64,
        state: &MotionState,
        weights: Option<&TangentWeights<'_>>,
        residual: &mut [Vector6],
    ) {
        let (x, r) = (
            state.configuration.position[0],
            state.configuration.rotation[0],
        );
        let (v, a) = (state.velocity[0], state.acceleration[0]);
        residual[0] = self.force(x, r, v, a);
        let Some(weights) = weights else { return };
        let turn = weights.rotation.map_or(Matrix3::identity(), |list| list[0]);
        let h = 1e-6;
        for column in 0..6 {
            let mut d = Vector6::zeros();
            d[column] = h;
            let theta = d.fixed_rows::<3>(3).into_owned();
            let mut step = d;
            step.fixed_rows_mut::<3>(3).copy_from(&(turn * theta));
            let moved = |sign: f64| {
                self.force(
                    x + d.fixed_rows::<3>(0) * sign,
                    so3::exp(&(theta * sign)) * r,
                    v + step * (weights.velocity * sign),
                    a + step * (weights.acceleration * sign),
                )
            };
            self.matrix
                .set_column(column, &((moved(1.0) - moved(-1.0)) / (2.0 * h)));
        }
    }

    fn solve(&mut self, residual: &[Vector6], increment: &mut [Vector6]) -> Result<(), usize> {
        increment[0] = -self.matrix.lu().solve(&residual[0]).ok_or(0usize)?;
        self.matrices += 1;
        Ok(())
    }

    fn solve_again(&mut self, residual: &[Vector6], increment: &mut [Vector6]) {
        let solution = self.matrix.lu().solve(&residual[0]);
        increment[0] = -solution.expect("this matrix has been solved before");
    }

    fn residual_size(&self, residual: &[Vector6]) -> ResidualSize {
        ResidualSize {
            newtons: residual[0].norm(),
            frame: 0,
        }
    }

    fn increment_size(&self, increment: &[Vector6]) -> f64 {
        increment[0].norm()
    }

    fn explicit(&mut self) -> Option<&mut dyn ExplicitSystem> {
        Some(self)
    }
}

impl ExplicitSystem for Tumbler {
    fn accelerate(&mut self, _time: f64, state: &mut MotionState) -> Result<(), usize> {
        state.acceleration[0] = self.acceleration(state);
        Ok(())
    }

    fn stable_step(&mut self, _time: f64, _state: &MotionState) -> f64 {
        1.0
    }
}

/// A point on a spring of the angular frequency 1, with this share of the critical damping.
pub(crate) struct Oscillator {
    pub damping: f64,
}

impl Oscillator {
    /// One metre away, at rest.
    pub(crate) fn start(&self) -> MotionState {
        let mut state = MotionState::at_rest(Configuration {
            position: vec![Vector3::x()],
            rotation: vec![Matrix3::identity()],
            second: vec![Vector3::zeros()],
        });
        state.acceleration[0][0] = -1.0;
        state
    }

    /// Where it is after `time`, with less than the critical damping [m].
    pub(crate) fn exact(&self, time: f64) -> f64 {
        let xi = self.damping;
        let fast = (1.0 - xi * xi).sqrt();
        (-xi * time).exp() * ((fast * time).cos() + xi / fast * (fast * time).sin())
    }
}

impl ImplicitSystem for Oscillator {
    fn frame_count(&self) -> usize {
        1
    }

    fn begin(&mut self) {}

    fn assemble(
        &mut self,
        _time: f64,
        state: &MotionState,
        _weights: Option<&TangentWeights<'_>>,
        residual: &mut [Vector6],
    ) {
        let position = state.configuration.position[0];
        let force = state.velocity[0] * (2.0 * self.damping) + state.acceleration[0];
        residual[0] = force;
        for row in 0..3 {
            residual[0][row] += position[row];
        }
    }

    fn solve(&mut self, _residual: &[Vector6], _increment: &mut [Vector6]) -> Result<(), usize> {
        Err(0)
    }

    fn solve_again(&mut self, _residual: &[Vector6], _increment: &mut [Vector6]) {}

    fn residual_size(&self, residual: &[Vector6]) -> ResidualSize {
        ResidualSize {
            newtons: residual[0].norm(),
            frame: 0,
        }
    }

    fn increment_size(&self, increment: &[Vector6]) -> f64 {
        increment[0].norm()
    }

    fn explicit(&mut self) -> Option<&mut dyn ExplicitSystem> {
        Some(self)
    }
}

impl ExplicitSystem for Oscillator {
    fn accelerate(&mut self, time: f64, state: &mut MotionState) -> Result<(), usize> {
        state.acceleration[0] = Vector6::zeros();
        let mut residual = [Vector6::zeros()];
        self.assemble(time, state, None, &mut residual);
        state.acceleration[0] = -residual[0];
        Ok(())
    }

    fn stable_step(&mut self, _time: f64, _state: &MotionState) -> f64 {
        crate::stability_limit(self.damping)
    }
}

/// Two masses on a spring that stiffens, each free otherwise: as one pair of points, or as two
/// frames that do not turn.
pub(crate) struct Dumbbell {
    pub as_pair: bool,
    /// Whether it shows its explicit side.
    pub explicit: bool,
    matrix: nalgebra::Matrix6<f64>,
}

impl Dumbbell {
    pub(crate) fn new(as_pair: bool) -> Dumbbell {
        Dumbbell {
            as_pair,
            explicit: true,
            matrix: nalgebra::Matrix6::zeros(),
        }
    }

    /// Apart, and on the way to somewhere, fast.
    pub(crate) fn start(&self) -> MotionState {
        let points = [Vector3::new(1.0, 0.0, 0.0), Vector3::new(-1.0, 0.5, 0.0)];
        let velocities = [Vector3::new(9.0, 1.0, 0.0), Vector3::new(8.0, 0.0, -2.0)];
        let configuration = match self.as_pair {
            true => Configuration {
                position: vec![points[0]],
                rotation: vec![Matrix3::identity()],
                second: vec![points[1]],
            },
            false => Configuration::of_frames(points.to_vec(), vec![Matrix3::identity(); 2]),
        };
        let mut state = MotionState::at_rest(configuration);
        state.velocity = self.laid_out(&velocities);
        state.acceleration = self.acceleration(&state);
        state
    }

    /// Both points of a state.
    pub(crate) fn points(&self, state: &MotionState) -> [Vector3; 2] {
        let configuration = &state.configuration;
        match self.as_pair {
            true => [0, 1].map(|half| configuration.point(0, half)),
            false => [0, 1].map(|k| configuration.position[k]),
        }
    }

    fn laid_out(&self, values: &[Vector3; 2]) -> Vec<Vector6> {
        let six = |a: &Vector3, b: &Vector3| Vector6::new(a.x, a.y, a.z, b.x, b.y, b.z);
        let zero = Vector3::zeros();
        match self.as_pair {
            true => vec![six(&values[0], &values[1])],
            false => vec![six(&values[0], &zero), six(&values[1], &zero)],
        }
    }

    fn acceleration(&self, state: &MotionState) -> Vec<Vector6> {
        let forces = self.forces(&self.points(state));
        self.laid_out(&forces.map(|force| -force / MASS))
    }

    /// Forces that hold the spring back.
    fn forces(&self, points: &[Vector3; 2]) -> [Vector3; 2] {
        let gap = points[0] - points[1];
        let force = gap * (3.0 + gap.norm_squared());
        [force, -force]
    }
}

impl ImplicitSystem for Dumbbell {
    fn frame_count(&self) -> usize {
        if self.as_pair { 1 } else { 2 }
    }

    fn begin(&mut self) {}

    fn assemble(
        &mut self,
        _time: f64,
        state: &MotionState,
        weights: Option<&TangentWeights<'_>>,
        residual: &mut [Vector6],
    ) {
        let points = self.points(state);
        residual.copy_from_slice(&self.laid_out(&self.forces(&points)));
        for (residual, acceleration) in residual.iter_mut().zip(&state.acceleration) {
            *residual += acceleration * MASS;
        }
        let Some(weights) = weights else { return };
        let gap = points[0] - points[1];
        let own = Matrix3::identity() * (3.0 + gap.norm_squared()) + gap * gap.transpose() * 2.0;
        self.matrix = nalgebra::Matrix6::identity() * (MASS * weights.acceleration);
        for (row, column, sign) in [(0, 0, 1.0), (3, 3, 1.0), (0, 3, -1.0), (3, 0, -1.0)] {
            let mut quadrant = self.matrix.fixed_view_mut::<3, 3>(row, column);
            quadrant += own * sign;
        }
    }

    fn solve(&mut self, residual: &[Vector6], increment: &mut [Vector6]) -> Result<(), usize> {
        let part = |k: usize, row: usize| -> Vector3 { residual[k].fixed_rows::<3>(row).into() };
        let (a, b) = match self.as_pair {
            true => (part(0, 0), part(0, 3)),
            false => (part(0, 0), part(1, 0)),
        };
        let both = Vector6::new(a.x, a.y, a.z, b.x, b.y, b.z);
        let solved: Vector6 = -self.matrix.lu().solve(&both).ok_or(0usize)?;
        let part = |row: usize| -> Vector3 { solved.fixed_rows::<3>(row).into() };
        increment.copy_from_slice(&self.laid_out(&[part(0), part(3)]));
        Ok(())
    }

    fn solve_again(&mut self, residual: &[Vector6], increment: &mut [Vector6]) {
        self.solve(residual, increment)
            .expect("this matrix has been solved before");
    }

    fn residual_size(&self, residual: &[Vector6]) -> ResidualSize {
        ResidualSize {
            newtons: residual.iter().map(Vector6::norm).fold(0.0, f64::max),
            frame: 0,
        }
    }

    fn increment_size(&self, increment: &[Vector6]) -> f64 {
        increment.iter().map(Vector6::norm).fold(0.0, f64::max)
    }

    fn explicit(&mut self) -> Option<&mut dyn ExplicitSystem> {
        self.explicit.then_some(self)
    }
}

impl ExplicitSystem for Dumbbell {
    fn accelerate(&mut self, _time: f64, state: &mut MotionState) -> Result<(), usize> {
        state.acceleration = self.acceleration(state);
        Ok(())
    }

    fn stable_step(&mut self, _time: f64, _state: &MotionState) -> f64 {
        1.0
    }
}

/// The same motion of two points, as a pair and as two frames, by the same integrator: nothing may
/// depend on how they are kept.
pub(crate) fn assert_pairs_move_like_frames(
    integrator: impl Fn(MotionState) -> Box<dyn Integrator>,
) {
    let ends = [true, false].map(|as_pair| {
        let mut system = Dumbbell::new(as_pair);
        let mut integrator = integrator(system.start());
        // Ways of many metres, which would be many turns of a frame.
        let steps: Vec<f64> = (0..200)
            .map(|k| 0.02 * (1.0 + 0.3 * f64::from(k % 3)))
            .collect();
        drive(integrator.as_mut(), &mut system, &steps);
        system.points(integrator.state())
    });
    for (pair, frame) in ends[0].iter().zip(&ends[1]) {
        assert!(pair.norm() > 10.0);
        // Newton's tolerance over the smallest stiffness, over 200 steps.
        assert!((pair - frame).norm() < 1e-7, "{pair} and {frame}");
    }
}

/// Settings of fixed steps.
pub(crate) const FIXED: StepSettings = StepSettings {
    newton: NewtonSettings {
        tolerance_newtons: 1e-9,
        max_iterations: 12,
    },
    allowed_error: None,
};

/// Takes steps of the given sizes; returns the orders that were used and all iterations.
pub(crate) fn drive(
    integrator: &mut dyn Integrator,
    system: &mut dyn ImplicitSystem,
    steps: &[f64],
) -> (Vec<usize>, usize) {
    let mut time = 0.0;
    let mut iterations = 0;
    let orders = steps
        .iter()
        .map(|&step| {
            time += step;
            let outcome = integrator
                .advance(system, time, step, &FIXED)
                .expect("the step converges");
            integrator.accept();
            iterations += outcome.iterations;
            outcome.order
        })
        .collect();
    (orders, iterations)
}

/// Distance of two configurations, over translations and rotations.
pub(crate) fn distance(a: &MotionState, b: &MotionState) -> f64 {
    a.configuration.difference(&b.configuration)[0].norm()
}
