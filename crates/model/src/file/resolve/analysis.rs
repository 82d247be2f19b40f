//! Settings of the analyses.

use crate::file::diagnostic::DiagnosticCode as Code;
use crate::file::dimension::Dimensionless;
use crate::file::log::Log;
use crate::file::node::Span;
use crate::file::quantity::Quantity;
use crate::file::tables::{
    DynamicsTable, FormulationChoice, IntegratorChoice, ModesTable, StaticsTable,
};
use crate::{
    DynamicsSettings, FormulationKind, IntegratorSettings, ModeRange, ModeSettings, Motion,
    StaticsSettings, StepControl, Vessel,
};

use super::Slot;

/// Error per step that is allowed where the file does not say [-]: of generalised-alpha, which
/// leaves out what vessels impose, and of other methods; named in the key's description.
const DEFAULT_ACCURACY: f64 = 1e-4;
const DEFAULT_ACCURACY_OF_OTHERS: f64 = 2e-5;
/// Smallest step where the file does not say [s]; named in the key's description.
const DEFAULT_MIN_STEP: f64 = 1e-4;
/// Largest step where the file does not say [s]: of generalised-alpha and of other methods; named
/// in the key's description.
const DEFAULT_MAX_STEP: f64 = 1.0;
const DEFAULT_MAX_STEP_OF_OTHERS: f64 = 0.5;
/// Steps in the shortest period of a motion, at least; named in the key's description.
const STEPS_PER_PERIOD: f64 = 12.0;

/// Spectral radius where the file does not say [-]; named in the key's description.
const DEFAULT_SPECTRAL_RADIUS: f64 = 0.4;
/// Highest order of BDF where the file does not say; named in the key's description.
const DEFAULT_MAX_ORDER: usize = 2;

/// Resolves the formulation of lines.
pub(super) fn formulation(choice: FormulationChoice) -> FormulationKind {
    match choice {
        FormulationChoice::Dem => FormulationKind::Dem,
        FormulationChoice::Fem => FormulationKind::Fem,
        FormulationChoice::FemExact => FormulationKind::FemExact,
        FormulationChoice::Lumped => FormulationKind::Lumped,
    }
}

/// Resolves the settings of statics.
pub(super) fn statics(table: &StaticsTable, log: &mut Log) -> StaticsSettings {
    check_below_one("tolerance", &table.tolerance, log);
    StaticsSettings {
        equilibrium: table.equilibrium,
        current: table.current,
        tolerance: table.tolerance.si,
        max_iterations: table.max_iterations.value,
    }
}

/// Number of modes where the file does not say; named in the key's description.
const DEFAULT_MODES: usize = 10;

/// Resolves which modes are sought.
pub(super) fn modes(table: &ModesTable, log: &mut Log) -> ModeSettings {
    let from_hz = table.from.as_ref().map_or(0.0, |from| from.si);
    let range = match (&table.to, &table.from) {
        (Some(to), _) => {
            if from_hz >= to.si {
                let message = format!("the band ends at {} Hz, below its start", to.si);
                let help = format!("write `to` above `from`, which is {from_hz} Hz");
                log.error(Code::Value, &to.span, message, help);
            }
            if let Some(count) = &table.count {
                let message = "`count` has no meaning beside a band of frequencies";
                let help = "keep `count`, or `from` and `to`";
                log.error(Code::ConflictingKeys, &count.span, message, help);
            }
            ModeRange::Band {
                from_hz,
                to_hz: to.si,
            }
        }
        (None, Some(from)) => {
            let message = "a band of frequencies needs its upper end `to`";
            let help = "write, for example, to = \"2 Hz\", or give `count` instead of `from`";
            log.error(Code::MissingKey, &from.span, message, help);
            ModeRange::Lowest(DEFAULT_MODES)
        }
        (None, None) => ModeRange::Lowest(table.count.as_ref().map_or(DEFAULT_MODES, |n| n.value)),
    };
    ModeSettings {
        range,
        added_mass: table.added_mass,
    }
}

/// Resolves the settings of dynamics.
pub(super) fn dynamics(
    table: &DynamicsTable,
    vessels: &[Slot<Vessel>],
    formulation: FormulationKind,
    log: &mut Log,
) -> DynamicsSettings {
    if table.integrator == IntegratorChoice::Explicit && !formulation.has_point_masses() {
        let message = format!(
            "the integrator `explicit` needs a mass at each point for itself, which the formulation \
             `{}` does not have",
            formulation.word()
        );
        let help = "remove `integrator`, or write formulation = \"lumped\" at the top of the file";
        log.error(Code::ConflictingKeys, &table.key_span, message, help);
    }
    check_below_one("tolerance", &table.tolerance, log);
    let duration = table.duration.si;
    let statistics_window = match &table.statistics_window {
        Some(window) => {
            if window.si > duration {
                let message = format!(
                    "the window of {} s is longer than the duration of {duration} s",
                    window.si
                );
                log.error(
                    Code::Value,
                    &window.span,
                    message,
                    "shorten it, or simulate longer",
                );
            }
            window.si
        }
        None => periods(vessels)
            .reduce(f64::max)
            .unwrap_or(0.1 * duration)
            .min(duration),
    };
    DynamicsSettings {
        duration,
        step: step_control(table, vessels, log),
        integrator: integrator(table, log),
        tolerance: table.tolerance.si,
        max_iterations: table.max_iterations.value,
        statistics_window,
    }
}

fn integrator(table: &DynamicsTable, log: &mut Log) -> IntegratorSettings {
    let radius = table.spectral_radius.as_ref();
    let order = table.max_order.as_ref();
    let mut foreign = |key: &str, span: &Span, own: &str| {
        let message = format!("`{key}` belongs to the integrator `{own}`, which is not used here");
        let help = format!("remove it, or write integrator = \"{own}\"");
        log.error(Code::ConflictingKeys, span, message, help);
    };
    match table.integrator {
        IntegratorChoice::GeneralisedAlpha => {
            if let Some(order) = order {
                foreign("max_order", &order.span, "bdf");
            }
            if let Some(radius) = radius.filter(|radius| radius.si > 1.0) {
                let message = format!(
                    "`spectral_radius` lies between 0 and 1, but is {}",
                    radius.si
                );
                log.error(Code::Value, &radius.span, message, "0.8 suits most models");
            }
            IntegratorSettings::GeneralisedAlpha {
                spectral_radius: radius.map_or(DEFAULT_SPECTRAL_RADIUS, |radius| radius.si),
            }
        }
        IntegratorChoice::Bdf => {
            if let Some(radius) = radius {
                foreign("spectral_radius", &radius.span, "generalised-alpha");
            }
            if let Some(order) = order.filter(|order| !(1..=5).contains(&order.value)) {
                let message = format!("`max_order` lies between 1 and 5, but is {}", order.value);
                log.error(Code::Value, &order.span, message, "2 suits most models");
            }
            IntegratorSettings::Bdf {
                max_order: order.map_or(DEFAULT_MAX_ORDER, |order| order.value),
            }
        }
        IntegratorChoice::Explicit => {
            if let Some(radius) = radius {
                foreign("spectral_radius", &radius.span, "generalised-alpha");
            }
            if let Some(order) = order {
                foreign("max_order", &order.span, "bdf");
            }
            IntegratorSettings::Explicit
        }
    }
}

fn step_control(table: &DynamicsTable, vessels: &[Slot<Vessel>], log: &mut Log) -> StepControl {
    if let Some(step) = &table.step {
        let adaptive = [
            table.accuracy.as_ref().map(|q| (&q.span, "accuracy")),
            table.min_step.as_ref().map(|q| (&q.span, "min_step")),
            table.max_step.as_ref().map(|q| (&q.span, "max_step")),
        ];
        for (span, key) in adaptive.into_iter().flatten() {
            let message = format!("`{key}` has no meaning beside `step`, which fixes the step");
            log.error(Code::ConflictingKeys, span, message, "keep one of them");
        }
        return StepControl::Fixed(step.si);
    }
    if let Some(accuracy) = &table.accuracy {
        check_below_one("accuracy", accuracy, log);
    }
    let min = table.min_step.as_ref().map_or(DEFAULT_MIN_STEP, |q| q.si);
    let (default_accuracy, default_max) = match table.integrator {
        IntegratorChoice::GeneralisedAlpha => {
            let shortest = periods(vessels).fold(f64::INFINITY, f64::min);
            let longest_step = DEFAULT_MAX_STEP.min(shortest / STEPS_PER_PERIOD);
            (DEFAULT_ACCURACY, longest_step.max(DEFAULT_MIN_STEP))
        }
        _ => (DEFAULT_ACCURACY_OF_OTHERS, DEFAULT_MAX_STEP_OF_OTHERS),
    };
    let max = table.max_step.as_ref().map_or(default_max, |q| q.si);
    if min > max {
        let message = format!("the smallest step, {min} s, is larger than the largest, {max} s");
        let written = table.min_step.as_ref().or(table.max_step.as_ref());
        let span = written.map_or(&table.key_span, |q| &q.span);
        log.error(Code::Value, span, message, "write min_step below max_step");
    }
    let accuracy = table.accuracy.as_ref().map_or(default_accuracy, |q| q.si);
    StepControl::Adaptive { accuracy, min, max }
}

/// Reports a fraction that is none.
pub(super) fn check_below_one<S>(key: &str, value: &Quantity<Dimensionless, S>, log: &mut Log) {
    if value.si >= 1.0 {
        let message = format!("`{key}` must be well below 1, but is {}", value.si);
        log.error(
            Code::Value,
            &value.span,
            message,
            "write a small fraction such as 1e-6",
        );
    }
}

/// Periods of the harmonic motions that act [s].
fn periods(vessels: &[Slot<Vessel>]) -> impl Iterator<Item = f64> {
    let motions = vessels
        .iter()
        .filter_map(|slot| slot.item.as_ref())
        .flat_map(|v| &v.motions);
    motions.filter_map(|motion| match motion {
        Motion::Harmonic {
            period, amplitude, ..
        } if *amplitude > 0.0 => Some(*period),
        _ => None,
    })
}
