//! Computes the natural modes of one load case and records them.

use catenix_engine::{
    FrameOwner, Mode, ModeKind, Modes, ModesError, Motion, StaticSolution, System, find_modes,
};
use catenix_model::{LoadCase, ModeSettings};
use catenix_results::{
    CaseModes, CaseRecorder, CaseSummary, ModeReport, ModeShapes, ModesReport, MotionShare, Status,
    StoreError,
};

use crate::case::{Account, EngineSample, Halt, case_error, flow, settle, system_of};
use crate::equilibria::Equilibria;
use crate::watch::Watch;

/// Finds the natural modes of a case about its static equilibrium, and writes both into
/// `recorder`, if there is one.
///
/// A solver that gives up makes a failed case, without modes; an error is a store that cannot be
/// written.
pub fn compute_modes(
    case: &LoadCase,
    settings: &ModeSettings,
    recorder: Option<CaseRecorder>,
    watch: &dyn Watch,
) -> Result<(CaseSummary, Option<CaseModes>), StoreError> {
    let mut account = Account::begin();
    let mut recorder = recorder;
    let system = system_of(&case.model, &Equilibria::default(), watch);
    let start = match &system {
        Ok(system) => settle(system, watch),
        Err(halt) => Err(halt.clone()),
    };
    if let Ok(start) = &start {
        account.found(start);
    }
    let modes = match (&system, &start) {
        (Ok(system), Ok(start)) => seek(system, start, settings, watch, &mut account).map(Some),
        _ => Ok(None),
    };
    let (status, error) = match (&start, &modes) {
        (Err(Halt::Interrupted), _) | (_, Err(Halt::Interrupted)) => (Status::Interrupted, None),
        (Err(Halt::Failed(error)), _) | (_, Err(Halt::Failed(error))) => {
            (Status::Failed, Some(error.clone()))
        }
        (Ok(_), Ok(_)) => (Status::Complete, None),
    };
    let outcome = account.outcome(status, error);
    let modes = modes.ok().flatten();
    if let Some(recorder) = &mut recorder {
        if let Ok(start) = &start {
            recorder.record_static(case, &EngineSample(&start.view()))?;
        }
        if let Some(modes) = &modes {
            recorder.record_modes(modes)?;
        }
    }
    let summary = match (recorder, &start) {
        (Some(recorder), _) => recorder.finish(&outcome)?,
        (None, Ok(start)) => {
            CaseSummary::of_static_state(case, &EngineSample(&start.view()), &outcome)
        }
        (None, Err(_)) => outcome.summary(&case.description),
    };
    Ok((summary, modes))
}

fn seek<'a>(
    system: &'a System,
    start: &StaticSolution<'a>,
    settings: &ModeSettings,
    watch: &dyn Watch,
    account: &mut Account,
) -> Result<CaseModes, Halt> {
    let found = find_modes(system, start, settings, &mut |progress| {
        watch.modes(progress.found);
        flow(watch.stop())
    });
    let found = found.map_err(|error| match &error {
        ModesError::Interrupted => Halt::Interrupted,
        ModesError::TooMany { .. } => Halt::Failed(case_error("modes::too_many", &error)),
        ModesError::Incomplete { .. } => Halt::Failed(case_error("modes::incomplete", &error)),
        _ => Halt::Failed(case_error("modes::other", &error)),
    })?;
    account.warnings.extend_from_slice(&found.warnings);
    Ok(record(system, &found))
}

/// What results keep of the engine's modes.
fn record(system: &System, found: &Modes<'_>) -> CaseModes {
    let model = system.model();
    let lines = model.lines.iter().enumerate().map(|(line, properties)| {
        let motion = |mode: &Mode| -> Vec<[f64; 6]> {
            let nodes = found.line_shape(mode, line);
            nodes.into_iter().map(Into::into).collect()
        };
        ModeShapes {
            name: properties.name.clone(),
            arc_length: Some(system.arc_length(line).to_vec()),
            motion: found.modes.iter().map(motion).collect(),
        }
    });
    let bodies = model.bodies.iter().enumerate().map(|(body, properties)| {
        let motion = |mode: &Mode| vec![found.body_shape(mode, body).into()];
        ModeShapes {
            name: properties.name.clone(),
            arc_length: None,
            motion: found.modes.iter().map(motion).collect(),
        }
    });
    CaseModes {
        report: ModesReport {
            added_mass: found.added_mass,
            total_mass_kg: found.total_mass_kg,
            counted_between_hz: found.proof.between_hz(),
            counted: found.proof.counted,
            below_band: found.below_band,
            unsymmetric_coupling: found.unsymmetric,
            factorisations: found.factorisations,
            modes: (1..).zip(&found.modes).map(mode_report).collect(),
        },
        lines: lines.collect(),
        bodies: bodies.collect(),
    }
}

fn mode_report((number, mode): (usize, &Mode)) -> ModeReport {
    let frequency = Some(mode.frequency_hz()).filter(|hz| hz.is_finite());
    let (moves_most, arc_length_m) = match &mode.largest_at {
        FrameOwner::Element {
            line, arc_length_m, ..
        }
        | FrameOwner::Node {
            line, arc_length_m, ..
        } => (line.clone(), Some(*arc_length_m)),
        FrameOwner::Body(name) => (name.clone(), None),
    };
    ModeReport {
        number,
        kind: match mode.kind {
            ModeKind::Unstable => "unstable",
            ModeKind::Free => "free",
            ModeKind::Vibration => "vibration",
        }
        .into(),
        frequency_hz: frequency,
        period_s: frequency.filter(|hz| *hz > 0.0).map(|hz| 1.0 / hz),
        omega_squared_rad2_s2: mode.omega_squared,
        equals_previous: mode.equals_previous,
        moves_most,
        arc_length_m,
        motions: mode
            .motions
            .iter()
            .map(|(motion, share)| MotionShare {
                motion: motion_word(*motion).into(),
                share: *share,
            })
            .collect(),
        damping_ratio: Some(mode.damping_ratio).filter(|ratio| ratio.is_finite()),
        effective_mass_kg: mode.effective_mass_kg,
        residual: mode.residual,
    }
}

fn motion_word(motion: Motion) -> &'static str {
    match motion {
        Motion::X => "x",
        Motion::Y => "y",
        Motion::Z => "z",
        Motion::Axial => "axial",
        Motion::Torsion => "torsion",
        Motion::Rotation => "rotation",
    }
}
