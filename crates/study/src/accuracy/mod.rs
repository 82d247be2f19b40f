//! Chooses element lengths and time step for a wanted accuracy, and says what error is left.
//!
//! A case is computed on a family of meshes, each with every element of the one before split in
//! two, and with steps of half the size each. Richardson extrapolation gives the error of every
//! headline result in space and in time; the first member whose errors all meet the target is
//! chosen.
//!
//! Source: docs/theory/accuracy.md.

mod family;
mod headline;
mod mesh;
mod plan;

use catenix_engine::simulate;
use catenix_model::{ChannelTarget, Line, LineQuantity, LoadCase, Model, Reference, StepControl};
use catenix_results::{CaseError, Discretisation, ErrorEstimate};

use crate::case::{Halt, dynamics_halt, flow, settle, system_of};
use crate::equilibria::Equilibria;
use crate::watch::Watch;
use family::Family;
use headline::SMALLEST_TENSION;
pub(crate) use headline::{Collector, Headline};
use plan::Planner;

/// What is computed of a case.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Wanted {
    /// The static equilibrium.
    Statics,
    /// Everything that the model describes: the motion, where there is one.
    Everything,
}

/// Compression that counts for none, over the largest tension of the line.
const SLIGHT: f64 = 0.01;

/// A model with the mesh and steps that were chosen, and the errors that are left.
struct Chosen {
    model: Model,
    estimates: Vec<ErrorEstimate>,
    /// Runs that it took.
    trials: usize,
}

/// The case with a mesh and a step that meet the relative error `target`, and the errors that are
/// left; with the best that could be reached where the target could not.
///
/// # Errors
/// What the solver said where no member of the family could be computed, or an interruption.
pub(crate) fn refined(
    case: &LoadCase,
    target: f64,
    wanted: Wanted,
    watch: &dyn Watch,
) -> Result<(LoadCase, Discretisation), Halt> {
    let mut model = case.model.clone();
    if wanted == Wanted::Statics {
        model.dynamics = None;
    }
    // References belong to the motion.
    let references = match model.dynamics {
        Some(_) => case.references.clone(),
        None => Vec::new(),
    };
    let planned = model.dynamics.is_some() && !wants_bending(&model, &references);
    let chosen = if planned {
        Planner::new(model, references, watch).choose(target)?
    } else {
        Family::adapted_to(model, references, watch)?.choose(target)?
    };
    let Chosen {
        model: chosen,
        estimates,
        trials,
    } = chosen;
    let mut case = case.clone();
    case.model.lines = chosen.lines;
    let mut steps = None;
    if let (Some(dynamics), Some(chosen)) = (&mut case.model.dynamics, chosen.dynamics) {
        dynamics.step = chosen.step;
        steps = Some(chosen.step);
    }
    let discretisation = Discretisation {
        target,
        reached: estimates.iter().all(|estimate| estimate.meets(target)),
        elements: case.model.lines.iter().map(Line::element_count).sum(),
        largest_step_s: steps.and_then(|step| match step {
            StepControl::Adaptive { max, .. } => Some(max),
            StepControl::Fixed(_) => None,
        }),
        step_error: steps.and_then(|step| match step {
            StepControl::Adaptive { accuracy, .. } => Some(accuracy),
            StepControl::Fixed(_) => None,
        }),
        trials,
        cpu_seconds: None,
        estimates,
    };
    Ok((case, discretisation))
}

/// Warnings where estimates say little: a compressed line may have several shapes, and neighbouring
/// meshes that agree on one of them say nothing of the others.
pub(crate) fn doubts(discretisation: &Discretisation) -> Vec<String> {
    let compressed = discretisation.estimates.iter().filter_map(|estimate| {
        let line = estimate.result.strip_suffix(SMALLEST_TENSION)?;
        (estimate.value < -SLIGHT * estimate.scale).then(|| {
            format!(
                "{line} is compressed (effective tension down to {:.3e} {}), so it may have more \
                 than one shape, and the error estimates hold for the one that was found: compare \
                 with a run of twice the elements",
                estimate.value, estimate.unit
            )
        })
    });
    compressed.collect()
}

/// Computes a case without a store.
fn compute<'m>(
    model: &'m Model,
    references: &'m [Reference],
    watch: &dyn Watch,
) -> Result<Collector<'m>, Halt> {
    let system = system_of(model, &Equilibria::default(), watch)?;
    let start = settle(&system, watch)?;
    let mut collector = Collector::new(model, references);
    if model.dynamics.is_none() {
        collector.add(&start.view());
        return Ok(collector);
    }
    let report = simulate(&system, &start, &mut |view| {
        collector.add(view);
        flow(watch.stop())
    })
    .map_err(dynamics_halt)?;
    if report.interrupted {
        return Err(Halt::Interrupted);
    }
    Ok(collector)
}

/// Whether a recorded or compared channel is one of bending.
fn wants_bending(model: &Model, references: &[Reference]) -> bool {
    let compared = references.iter().map(|reference| &reference.channel);
    model.output.channels.iter().chain(compared).any(|channel| {
        use LineQuantity::{BendMoment, Curvature, ShearForce, VonMisesStress};
        let bends = [BendMoment, Curvature, ShearForce, VonMisesStress];
        match channel.target {
            ChannelTarget::LinePoint(_, quantity, _) => bends.contains(&quantity),
            ChannelTarget::EndMoment(..) => true,
            _ => false,
        }
    })
}

fn no_estimate() -> CaseError {
    CaseError {
        code: "accuracy::no_estimate".to_owned(),
        message: "no mesh of the family could be computed".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_compressed_line_puts_the_estimates_in_doubt() {
        let estimate = |result: &str, value: f64| ErrorEstimate {
            result: result.to_owned(),
            unit: "N".to_owned(),
            value,
            scale: 5e4,
            space_error: 1.0,
            time_error: 1.0,
            steers: false,
        };
        let discretisation = |estimates| Discretisation {
            target: 0.01,
            reached: true,
            elements: 40,
            largest_step_s: None,
            step_error: None,
            trials: 1,
            cpu_seconds: None,
            estimates,
        };
        let [pulled, hardly, pressed] = [1e3, -100.0, -9.8e3].map(|value| {
            doubts(&discretisation(vec![estimate(
                "hose, smallest effective_tension",
                value,
            )]))
        });
        assert!(pulled.is_empty() && hardly.is_empty());
        assert!(pressed.len() == 1 && pressed[0].starts_with("hose is compressed"));
        let other = estimate("hose.end_b.force_x, mean", -9.8e3);
        assert!(doubts(&discretisation(vec![other])).is_empty());
    }
}
