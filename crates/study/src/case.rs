//! Computes one load case with the engine and records it.

use std::borrow::Cow;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use catenix_engine::{
    DynamicsError, DynamicsReport, EnergyAccount, StaticSolution, StaticsError, StepView, System,
    simulate, solve_statics,
};
use catenix_model::{Channel, ChannelTarget, LoadCase, Model};
use catenix_results::{
    CaseError, CaseOutcome, CaseRecorder, CaseSummary, Discretisation, DynamicsFacts, ResultStore,
    Sample, StaticsFacts, Status, StoreError,
};
use cpu_time::ThreadTime;

use crate::accuracy::{Wanted, doubts, refined};
use crate::equilibria::Equilibria;
use crate::watch::Watch;

/// Elapsed time between two looks of the watch.
pub(crate) const PROGRESS_INTERVAL: Duration = Duration::from_millis(100);

/// Code of a model that cannot be assembled.
pub(crate) const UNUSABLE: &str = "system::unusable";

/// What ends a case early.
#[derive(Debug, Clone)]
pub(crate) enum Halt {
    Interrupted,
    Failed(CaseError),
}

/// What ends a recorded case early: the solver's reason, or the disk's.
pub(crate) enum Stop {
    Halt(Halt),
    Store(StoreError),
}

impl From<Halt> for Stop {
    fn from(halt: Halt) -> Self {
        Stop::Halt(halt)
    }
}

/// Elapsed and processor time of a case, and what is known of its outcome so far.
pub(crate) struct Account {
    wall: Instant,
    cpu: ThreadTime,
    statics: Option<StaticsFacts>,
    dynamics: Option<DynamicsFacts>,
    pub(crate) warnings: Vec<String>,
    discretisation: Option<Discretisation>,
}

/// Computes a case and writes it into `store`. `equilibria` are those of cases that were computed
/// before; the results do not depend on them.
///
/// A solver that gives up makes a failed case, which is a result too; an error is a store that
/// cannot be written.
pub fn compute_case(
    case: &LoadCase,
    store: &ResultStore,
    accuracy: Option<f64>,
    equilibria: &Equilibria,
    watch: &dyn Watch,
) -> Result<CaseSummary, StoreError> {
    let mut account = Account::begin();
    let (case, halt) = account.choose(case, accuracy, Wanted::Everything, watch);
    let mut recorder = store.record_case(&case);
    let end = match halt {
        Some(halt) => Err(halt.into()),
        None => run_case(&case, &mut recorder, equilibria, watch, &mut account),
    };
    let (status, error) = match end {
        Ok(()) => (Status::Complete, None),
        Err(Stop::Halt(Halt::Interrupted)) => (Status::Interrupted, None),
        Err(Stop::Halt(Halt::Failed(error))) => (Status::Failed, Some(error)),
        Err(Stop::Store(error)) => return Err(error),
    };
    recorder.finish(&account.outcome(status, error))
}

/// A case on the mesh and with the step that a wanted accuracy asks for, not computed yet.
///
/// # Errors
/// What the solver said where nothing could be computed; `None` where the watch stopped it.
pub fn choose_for_accuracy(
    case: &LoadCase,
    accuracy: f64,
    watch: &dyn Watch,
) -> Result<LoadCase, Option<CaseError>> {
    match refined(case, accuracy, Wanted::Everything, watch) {
        Ok((case, _)) => Ok(case),
        Err(Halt::Failed(error)) => Err(Some(error)),
        Err(Halt::Interrupted) => Err(None),
    }
}

/// Finds the static equilibrium of a case, on the mesh that an `accuracy` asks for if one is given.
pub fn compute_statics(case: &LoadCase, accuracy: Option<f64>, watch: &dyn Watch) -> CaseSummary {
    let mut account = Account::begin();
    let (case, halt) = account.choose(case, accuracy, Wanted::Statics, watch);
    let system = match halt {
        Some(halt) => Err(halt),
        None => system_of(&case.model, &Equilibria::default(), watch),
    };
    let solution = match &system {
        Ok(system) => settle(system, watch),
        Err(halt) => Err(halt.clone()),
    };
    if let Ok(start) = &solution {
        account.found(start);
    }
    let (status, error) = match &solution {
        Ok(_) => (Status::Complete, None),
        Err(Halt::Interrupted) => (Status::Interrupted, None),
        Err(Halt::Failed(error)) => (Status::Failed, Some(error.clone())),
    };
    let outcome = account.outcome(status, error);
    match solution {
        Ok(solution) => {
            CaseSummary::of_static_state(&case, &EngineSample(&solution.view()), &outcome)
        }
        Err(_) => outcome.summary(&case.description),
    }
}

fn run_case(
    case: &LoadCase,
    recorder: &mut CaseRecorder,
    equilibria: &Equilibria,
    watch: &dyn Watch,
    account: &mut Account,
) -> Result<(), Stop> {
    let system = system_of(&case.model, equilibria, watch)?;
    let start = equilibria.of_or_find(&system, || settle(&system, watch))?;
    account.found(&start);
    recorder
        .record_static(case, &EngineSample(&start.view()))
        .map_err(Stop::Store)?;
    let Some(dynamics) = &case.model.dynamics else {
        return Ok(());
    };
    watch.motion(0.0, dynamics.duration);
    let mut last_shown = Instant::now();
    let mut store_error = None;
    let result = simulate(&system, &start, &mut |view| {
        if let Err(error) = recorder.record(&EngineSample(view)) {
            store_error = Some(error);
            return ControlFlow::Break(());
        }
        if last_shown.elapsed() >= PROGRESS_INTERVAL {
            watch.motion(view.time(), dynamics.duration);
            last_shown = Instant::now();
        }
        flow(watch.stop())
    });
    if let Some(error) = store_error {
        return Err(Stop::Store(error));
    }
    match result {
        Ok(report) => {
            account.dynamics = Some(dynamics_facts(&report));
            if report.interrupted {
                Err(Halt::Interrupted.into())
            } else {
                Ok(())
            }
        }
        Err(error) => {
            account.dynamics = error.report().map(dynamics_facts);
            Err(dynamics_halt(error).into())
        }
    }
}

/// The system of a model, which knows the tension of its equilibrium where it wants to.
pub(crate) fn system_of(
    model: &Model,
    equilibria: &Equilibria,
    watch: &dyn Watch,
) -> Result<System, Halt> {
    let unusable = |error| Halt::Failed(case_error(UNUSABLE, &error));
    let system = System::new(model).map_err(unusable)?;
    if !system.wants_tension() {
        return Ok(system);
    }
    let start = equilibria.of_or_find(&system, || settle(&system, watch))?;
    start.tightened().map_err(unusable)
}

/// The static equilibrium of a system.
pub(crate) fn settle<'a>(
    system: &'a System,
    watch: &dyn Watch,
) -> Result<StaticSolution<'a>, Halt> {
    if watch.stop() {
        return Err(Halt::Interrupted);
    }
    let mut last_shown = Instant::now();
    solve_statics(system, &mut |state| {
        if last_shown.elapsed() >= PROGRESS_INTERVAL {
            watch.statics(state.iteration, state.residual_n);
            last_shown = Instant::now();
        }
        flow(watch.stop())
    })
    .map_err(statics_halt)
}

impl Account {
    pub(crate) fn begin() -> Self {
        Account {
            wall: Instant::now(),
            cpu: ThreadTime::now(),
            statics: None,
            dynamics: None,
            warnings: Vec::new(),
            discretisation: None,
        }
    }

    pub(crate) fn found(&mut self, solution: &StaticSolution<'_>) {
        self.statics = Some(StaticsFacts {
            iterations: solution.iterations,
            residual_n: solution.residual_n,
        });
        self.warnings.extend_from_slice(&solution.warnings);
    }

    /// The case with the mesh and step that `accuracy` asks for. The time that the choice takes is
    /// kept apart from that of the case.
    fn choose<'a>(
        &mut self,
        case: &'a LoadCase,
        accuracy: Option<f64>,
        wanted: Wanted,
        watch: &dyn Watch,
    ) -> (Cow<'a, LoadCase>, Option<Halt>) {
        let Some(target) = accuracy else {
            return (Cow::Borrowed(case), None);
        };
        let chosen = refined(case, target, wanted, watch);
        let trials = self.cpu.elapsed().as_secs_f64();
        *self = Account::begin();
        match chosen {
            Ok((case, mut discretisation)) => {
                discretisation.cpu_seconds = Some(trials);
                self.warnings = doubts(&discretisation);
                self.discretisation = Some(discretisation);
                (Cow::Owned(case), None)
            }
            Err(halt) => (Cow::Borrowed(case), Some(halt)),
        }
    }

    pub(crate) fn outcome(self, status: Status, error: Option<CaseError>) -> CaseOutcome {
        CaseOutcome {
            status,
            error,
            warnings: self.warnings,
            discretisation: self.discretisation,
            statics: self.statics,
            dynamics: self.dynamics,
            cpu_seconds: self.cpu.elapsed().as_secs_f64(),
            wall_seconds: self.wall.elapsed().as_secs_f64(),
        }
    }
}

/// The engine's view of a step, as results see it.
pub(crate) struct EngineSample<'a, 'b>(pub(crate) &'a StepView<'b>);

impl Sample for EngineSample<'_, '_> {
    fn time(&self) -> f64 {
        self.0.time()
    }

    fn channel(&self, target: ChannelTarget) -> f64 {
        self.0.channel(target)
    }

    fn channels(&self, channels: &[Channel], out: &mut [f64]) {
        let targets = channels.iter().map(|channel| channel.target);
        self.0.channels(targets, out);
    }

    fn line_quantities(&self, line: usize, out: &mut [f64]) {
        self.0.line_quantities(line, out);
    }
}

pub(crate) fn flow(stop: bool) -> ControlFlow<()> {
    if stop {
        ControlFlow::Break(())
    } else {
        ControlFlow::Continue(())
    }
}

pub(crate) fn statics_halt(error: StaticsError) -> Halt {
    match &error {
        StaticsError::Interrupted { .. } => Halt::Interrupted,
        StaticsError::NoEquilibrium { .. } => {
            Halt::Failed(case_error("statics::no_equilibrium", &error))
        }
        StaticsError::FreeMotion { .. } => Halt::Failed(case_error("statics::free_motion", &error)),
        _ => Halt::Failed(case_error("statics::other", &error)),
    }
}

pub(crate) fn dynamics_halt(error: DynamicsError) -> Halt {
    Halt::Failed(case_error(dynamics_code(&error), &error))
}

fn dynamics_code(error: &DynamicsError) -> &'static str {
    match error {
        DynamicsError::NotConverged { .. } => "dynamics::not_converged",
        DynamicsError::NoDynamics => "dynamics::no_dynamics",
        _ => "dynamics::other",
    }
}

pub(crate) fn case_error(code: &str, error: &dyn std::error::Error) -> CaseError {
    CaseError {
        code: code.to_owned(),
        message: error.to_string(),
    }
}

fn dynamics_facts(report: &DynamicsReport) -> DynamicsFacts {
    let statistics = &report.statistics;
    // Taken apart without `..`: a new term of the account must be recorded too.
    let EnergyAccount {
        kinetic_j,
        elastic_j,
        potential_j,
        stored_change_j,
        work_drag_j,
        work_added_mass_j,
        work_buoyancy_j,
        work_seabed_j,
        work_structural_damping_j,
        work_moved_ends_j,
        work_loads_j,
        imbalance,
    } = report.energy;
    DynamicsFacts {
        end_time_s: report.end_time_s,
        steps: statistics.steps,
        rejected_steps: statistics.rejected_steps,
        steps_of_order: statistics.steps_of_order,
        iterations: statistics.iterations,
        factorisations: statistics.factorisations,
        residual_n: statistics.largest_residual_n,
        energy: vec![
            ("kinetic_j", kinetic_j),
            ("elastic_j", elastic_j),
            ("potential_j", potential_j),
            ("stored_change_j", stored_change_j),
            ("work_drag_j", work_drag_j),
            ("work_added_mass_j", work_added_mass_j),
            ("work_buoyancy_j", work_buoyancy_j),
            ("work_seabed_j", work_seabed_j),
            ("work_structural_damping_j", work_structural_damping_j),
            ("work_moved_ends_j", work_moved_ends_j),
            ("work_loads_j", work_loads_j),
        ],
        energy_imbalance: imbalance,
    }
}
