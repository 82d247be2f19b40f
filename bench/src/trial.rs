//! The sea trial as a yardstick: the results that are compared, and what counts as their error.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use crate::context::{Context, read_text, write_text};
use crate::probe::{Probe, Task};
use crate::variant::Variant;

/// The model file.
pub(crate) const MODEL: &str = "examples/sea-trial-1km.toml";
/// Its load cases.
pub(crate) const CASES: [&str; 6] = ["a", "b", "c", "d", "e", "f"];
/// Elements of pipe and hose in the example.
pub(crate) const MESH: [usize; 2] = [90, 200];
/// What is compared. A name between bars is the length of a vector.
const CHANNELS: [&str; 6] = [
    "buffer.offset_x",
    "buffer.offset_y",
    "|lift_pipe.end_a.force|",
    "hose.end_b.force_x",
    "hose.end_b.force_y",
    "hose.end_b.force_z",
];
/// Output times bind the steps, so they are far apart; extremes are taken over all steps [s].
const INTERVAL: f64 = 0.8;

/// How the motion is stepped.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) enum Stepping {
    /// Constant steps [s].
    Fixed(f64),
    /// As the program chooses where the model file says nothing.
    Default,
    /// Mesh and steps as they are chosen for an accuracy [-].
    Chosen(f64),
}

impl Stepping {
    /// In words.
    pub(crate) fn words(self) -> String {
        match self {
            Stepping::Fixed(step) => format!("{step} s"),
            Stepping::Default => "adaptive".to_owned(),
            Stepping::Chosen(accuracy) => format!("`--accuracy {}%`", 100.0 * accuracy),
        }
    }
}

/// The results that are compared.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct Outcome {
    /// Mean offset of the buffer from the ship over the last heave period (x, y) [m].
    pub offset_m: [f64; 2],
    /// Smallest and largest force of the pipe on the ship over the whole motion [N].
    pub top_n: [f64; 2],
    /// Mean force of the hose on the miner over the last heave period (x, y, z) [N].
    pub hose_n: [f64; 3],
}

/// Deviations from a reference [-].
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct Errors {
    /// Of the offset, relative to it.
    pub offset: f64,
    /// Of the worse end of the range of the top force, relative to the range.
    pub top: f64,
    /// Of the hose's force, relative to it.
    pub hose: f64,
}

impl Outcome {
    /// What a run of a [`task`] found.
    pub(crate) fn of(probe: &Probe) -> Result<Outcome, String> {
        let [x, y, top, fx, fy, fz] = probe.statistics[..] else {
            return Err("the probe did not measure the channels of the sea trial".to_owned());
        };
        Ok(Outcome {
            offset_m: [x.mean, y.mean],
            top_n: [top.min, top.max],
            hose_n: [fx.mean, fy.mean, fz.mean],
        })
    }

    /// How far this is from what is right.
    pub(crate) fn errors(&self, right: &Outcome) -> Errors {
        let [low, high] = right.top_n;
        let worse = (self.top_n[0] - low)
            .abs()
            .max((self.top_n[1] - high).abs());
        Errors {
            offset: deviation(&self.offset_m, &right.offset_m),
            top: worse / (high - low),
            hose: deviation(&self.hose_n, &right.hose_n),
        }
    }
}

/// Length of the difference of two vectors, over the length of the second.
fn deviation(found: &[f64], right: &[f64]) -> f64 {
    let length = |values: &mut dyn Iterator<Item = f64>| values.map(|v| v * v).sum::<f64>().sqrt();
    let apart = length(&mut found.iter().zip(right).map(|(a, b)| a - b));
    apart / length(&mut right.iter().copied())
}

/// The sea trial on another mesh and with other steps.
pub(crate) fn variant(
    context: &Context,
    mesh: [usize; 2],
    stepping: Stepping,
) -> Result<Variant, String> {
    let mut variant = Variant::of(context, MODEL)?;
    for (line, elements) in ["lift_pipe", "hose"].iter().zip(mesh) {
        let place = format!("lines.{line}.sections.0.elements");
        variant.set(&place, elements as i64)?;
    }
    variant.set("output.interval", INTERVAL)?;
    variant.set("output.field_interval", 10.0 * INTERVAL)?;
    match stepping {
        Stepping::Fixed(step) => variant.set("dynamics.step", step)?,
        Stepping::Default | Stepping::Chosen(_) => variant.remove("dynamics", "step"),
    }
    Ok(variant)
}

/// A run of one case of it, with what is compared.
pub(crate) fn task(
    context: &Context,
    case: &str,
    mesh: [usize; 2],
    stepping: Stepping,
) -> Result<Task, String> {
    let name = format!(
        "sea-trial-{}-{}-{}",
        mesh[0],
        mesh[1],
        stepping.words().replace([' ', '.', '`', '%'], "_")
    );
    Ok(Task {
        model: variant(context, mesh, stepping)?.write(context, &name)?,
        case: case.to_owned(),
        channels: CHANNELS.map(str::to_owned).to_vec(),
        statics_only: false,
        accuracy: match stepping {
            Stepping::Chosen(accuracy) => Some(accuracy),
            _ => None,
        },
    })
}

/// What is right, as well as it is known.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct Reference {
    /// Elements in the finest run, over those in the example; its step is so much below 0.1 s.
    pub fineness: usize,
    /// Of the finest run.
    pub outcome: Outcome,
    /// Change from half its fineness in mesh and step: what is left is about a third of it.
    pub change: Errors,
}

/// Times as many elements, and so much smaller steps than 0.1 s, in the finest run.
fn fineness(context: &Context) -> usize {
    if context.quick { 2 } else { 4 }
}

/// References of the cases, in their order; computed once for each build of this program.
pub(crate) fn references(context: &Context, cases: &[&str]) -> Result<Vec<Reference>, String> {
    let program = std::fs::read(&context.own).map_err(|error| error.to_string())?;
    let fineness = fineness(context);
    let mut jobs = Vec::new();
    for case in cases {
        let run = |fineness: usize| {
            let step = Stepping::Fixed(0.1 / fineness as f64);
            task(context, case, MESH.map(|n| n * fineness), step)
        };
        jobs.push((
            cache_file(context, case, fineness, &program)?,
            [run(fineness)?, run(fineness / 2)?],
        ));
    }
    // Times do not matter here, so all processors may help.
    let next = std::sync::Mutex::new(jobs.iter());
    let workers = std::thread::available_parallelism().map_or(1, usize::from);
    let work = || -> Result<(), String> {
        loop {
            let job = next.lock().map_err(|error| error.to_string())?.next();
            let Some((cache, [fine, coarse])) = job else {
                return Ok(());
            };
            if cache.exists() {
                continue;
            }
            eprintln!("  reference of case {} ...", fine.case);
            let outcome = Outcome::of(&fine.run(context)?)?;
            let change = Outcome::of(&coarse.run(context)?)?.errors(&outcome);
            let found = Reference {
                fineness,
                outcome,
                change,
            };
            let text = serde_json::to_string(&found).map_err(|error| error.to_string())?;
            write_text(cache, &text)?;
        }
    };
    std::thread::scope(|scope| {
        let threads: Vec<_> = (0..workers).map(|_| scope.spawn(work)).collect();
        threads
            .into_iter()
            .map(|thread| thread.join().map_err(|_| "a reference failed".to_owned())?)
            .collect::<Result<Vec<()>, String>>()
    })?;
    let read = |(cache, _): &(PathBuf, _)| {
        serde_json::from_str(&read_text(cache)?).map_err(|error| error.to_string())
    };
    jobs.iter().map(read).collect()
}

fn cache_file(
    context: &Context,
    case: &str,
    fineness: usize,
    program: &[u8],
) -> Result<PathBuf, String> {
    let mut hasher = DefaultHasher::new();
    program.hash(&mut hasher);
    variant(context, MESH, Stepping::Default)?
        .text()?
        .hash(&mut hasher);
    let name = format!("reference-{case}-{fineness}-{:016x}.json", hasher.finish());
    Ok(context.work.join(name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_relative_to_what_they_belong_to() {
        let right = Outcome {
            offset_m: [-20.0, 0.0],
            top_n: [1e6, 2e6],
            hose_n: [3e3, 0.0, 4e3],
        };
        let found = Outcome {
            offset_m: [-20.2, 0.0],
            top_n: [1.02e6, 1.99e6],
            hose_n: [3e3, 100.0, 4e3],
        };
        let errors = found.errors(&right);
        for (got, want) in [
            (errors.offset, 0.01),
            (errors.top, 0.02),
            (errors.hose, 0.02),
        ] {
            // Round-off of one division.
            assert!((got - want).abs() < 1e-12, "{got} {want}");
        }
    }
}
