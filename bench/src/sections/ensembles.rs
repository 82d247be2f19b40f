//! Ensembles: many load cases of one model in one run, against the same cases run one by one.

use std::path::Path;
use std::process::Command;
use std::time::Instant;

use serde::{Deserialize, Serialize};
use serde_json::Value;
use toml::Table as TomlTable;

use super::{Section, kept, no_charts, recalled};
use crate::child;
use crate::context::Context;
use crate::markdown::{Table, digits, grouped};
use crate::probe::Task;
use crate::trial::{self, MESH, Stepping};

pub(crate) const SECTION: Section = Section {
    name: "ensembles",
    title: "Ensembles",
    measure,
    markdown,
    charts: no_charts,
};

/// Load cases.
const CASES: usize = 64;
/// Every so many of them is run alone.
const EVERY: usize = 8;
/// Simulated time of each [s].
const DURATION: f64 = 40.0;
const STEP: f64 = 0.2;

#[derive(Debug, Serialize, Deserialize)]
struct Data {
    cases: usize,
    elements: usize,
    simulated_s: f64,
    /// Cases that were run alone.
    alone: usize,
    /// Processor time of a case alone, mean [s].
    alone_cpu_s: f64,
    /// Processor and elapsed time of all in one run on one thread [s].
    one_thread_s: [f64; 2],
    /// The same on as many threads as there are processors [s].
    all_threads_s: [f64; 2],
    threads: usize,
    /// Processor time of what the engine does of a case, mean over those that were run alone:
    /// assembling, static equilibrium, motion [s].
    #[serde(default)]
    engine_s: [f64; 3],
    /// Files that the run of all cases leaves.
    #[serde(default)]
    files: usize,
}

fn measure(context: &Context) -> Result<Value, String> {
    let cases = if context.quick { 8 } else { CASES };
    let mut variant = trial::variant(context, MESH, Stepping::Fixed(STEP))?;
    variant.set("dynamics.duration", DURATION)?;
    // Other currents and speeds, as a study of operating conditions has them.
    let mut list = TomlTable::new();
    for k in 0..cases {
        let heading = 360.0 * k as f64 / cases as f64;
        let speed = 0.5 + 0.5 * ((5 * k) % cases) as f64 / cases as f64;
        let text = format!(
            "environment.current.heading = \"{heading} deg\"\nmotions.tow.speed = {speed}\n"
        );
        let case: TomlTable = text.parse().map_err(|error| format!("{error}"))?;
        list.insert(name(k), case.into());
    }
    variant.set("cases", list)?;
    variant.remove_all("figures");
    let model = variant.write(context, "ensemble")?;
    let run = |chosen: Option<usize>, threads: usize| -> Result<[f64; 2], String> {
        // Else the run would spend its time on taking away the results of the one before.
        let results = context.work.join("results");
        if results.exists() {
            std::fs::remove_dir_all(&results).map_err(|error| error.to_string())?;
        }
        let mut command = Command::new(&context.catenix);
        command.arg("run").arg(&model).args(["--quiet", "--json"]);
        command.args(["--threads", &threads.to_string(), "--out"]);
        command.arg(&results);
        if let Some(k) = chosen {
            command.args(["--case", &name(k)]);
        }
        let start = Instant::now();
        let (cpu, _) = child::cpu_of(&mut command)?;
        Ok([cpu, start.elapsed().as_secs_f64()])
    };
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let least = |best: &mut [f64], found: &[f64]| {
        for (best, found) in best.iter_mut().zip(found) {
            *best = best.min(*found);
        }
    };
    let chosen: Vec<usize> = (0..cases).step_by(EVERY).collect();
    let mut alone = vec![[f64::INFINITY; 2]; chosen.len()];
    let mut engine = vec![[f64::INFINITY; 3]; chosen.len()];
    let (mut one, mut all) = ([f64::INFINITY; 2], [f64::INFINITY; 2]);
    for repeat in 0..context.repeats().min(2) {
        eprintln!("  ensemble, repeat {} ...", repeat + 1);
        for ((k, best), engine) in chosen.iter().zip(&mut alone).zip(&mut engine) {
            least(best, &run(Some(*k), 1)?);
            let probe = Task {
                model: model.clone(),
                case: name(*k),
                channels: Vec::new(),
                statics_only: false,
                accuracy: None,
            }
            .run(context)?;
            let found = [
                probe.assembling_cpu_s,
                probe.statics_cpu_s,
                probe.motion_cpu_s,
            ];
            least(engine, &found);
        }
        least(&mut one, &run(None, 1)?);
        least(&mut all, &run(None, threads)?);
    }
    let total: f64 = alone.iter().map(|[cpu, _]| cpu).sum();
    kept(&Data {
        cases,
        elements: MESH.iter().sum(),
        simulated_s: DURATION,
        alone: chosen.len(),
        alone_cpu_s: total / chosen.len() as f64,
        one_thread_s: one,
        all_threads_s: all,
        threads,
        engine_s: [0, 1, 2].map(|part| {
            let sum: f64 = engine.iter().map(|found| found[part]).sum();
            sum / chosen.len() as f64
        }),
        files: count_files(&context.work.join("results"))?,
    })
}

fn name(k: usize) -> String {
    format!("c{k:02}")
}

fn markdown(data: &Value) -> Result<String, String> {
    let d: Data = recalled(data)?;
    let all = d.cases as f64;
    let mut table = Table::new(&[
        "",
        "CPU s per case",
        "simulated s per CPU s",
        "against single runs",
        "elapsed s, all cases",
    ]);
    let mut row = |what: String, cpu: f64, elapsed: String| {
        table.row([
            what,
            digits(cpu),
            digits(d.simulated_s / cpu),
            format!("{:.2}", d.alone_cpu_s / cpu),
            elapsed,
        ]);
    };
    let engine: f64 = d.engine_s.iter().sum();
    if engine > 0.0 {
        row(
            "engine alone, nothing recorded".to_owned(),
            engine,
            "-".to_owned(),
        );
    }
    row(
        format!("one by one (mean of {})", d.alone),
        d.alone_cpu_s,
        "-".to_owned(),
    );
    row(
        "in one run, 1 thread".to_owned(),
        d.one_thread_s[0] / all,
        digits(d.one_thread_s[1]),
    );
    row(
        format!("in one run, {} threads", d.threads),
        d.all_threads_s[0] / all,
        digits(d.all_threads_s[1]),
    );
    Ok(format!(
        "{} load cases of the sea trial ({} elements; other current headings and speeds), {} s each in\n\
         steps of {STEP} s, with `catenix run`: statics, motion and store, whole process.\n\n{}\n\
         {}\
         Cases are computed one by one on each thread; [why lanes over cases do not pay]\
         (../docs/theory/speed.md#ensembles), and what was tried, stands with the kernels above.",
        d.cases,
        d.elements,
        grouped(d.simulated_s),
        table.text(),
        parts(&d)
    ))
}

/// What the engine's time of a case is made of, and how much the run leaves.
fn parts(d: &Data) -> String {
    let [assembling, statics, motion] = d.engine_s.map(|seconds| digits(1e3 * seconds));
    if d.files == 0 {
        return String::new();
    }
    format!(
        "Of a case the engine takes {assembling} ms for the system, {statics} ms for its equilibrium and {motion} ms\n\
         for its motion. All cases leave {} files.\n\n",
        d.files
    )
}

/// Files in a folder and below.
fn count_files(folder: &Path) -> Result<usize, String> {
    let mut count = 0;
    for entry in std::fs::read_dir(folder).map_err(|error| error.to_string())? {
        let path = entry.map_err(|error| error.to_string())?.path();
        count += if path.is_dir() {
            count_files(&path)?
        } else {
            1
        };
    }
    Ok(count)
}
