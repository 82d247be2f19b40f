//! Cost against error of the time integrators on the sea trial, as a table.
//!
//! Runs the `catenix` command on copies of the example with other settings of `[dynamics]`, and
//! compares with a run of very small steps. Errors and counts are the same on every machine;
//! processor times are not, and decide no test.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

use crate::written::{build_catenix, write_between};

const MODEL: &str = "examples/sea-trial-1km.toml";
const CHAPTER: &str = "docs/theory/integration.md";
const BEGIN: &str = "<!-- integrators table: begin -->";
const END: &str = "<!-- integrators table: end -->";
/// With the current and against it.
const CASES: [&str; 2] = ["a", "f"];
/// Output times bind the steps, so they are far apart; extremes are taken over all steps.
const INTERVAL: &str = "0.8 s";
const REFERENCE: &str = "step = 0.005\ntolerance = 1e-7";

/// What the table has a row for: its name, and what it writes into `[dynamics]`.
fn settings() -> Vec<(String, String)> {
    let mut list = Vec::new();
    let methods = [("generalised-alpha", ""), ("bdf", "integrator = \"bdf\"\n")];
    for (name, method) in methods {
        for step in ["0.8", "0.4", "0.2", "0.1", "0.05"] {
            let row = format!("{name}, step {step} s");
            list.push((row, format!("{method}step = {step}")));
        }
        for accuracy in ["1e-4", "3e-5", "1e-5", "3e-6", "1e-6", "3e-7"] {
            let row = format!("{name}, accuracy {accuracy}");
            list.push((row, format!("{method}accuracy = {accuracy}")));
        }
    }
    for radius in ["0.5", "0.7", "0.9", "1"] {
        let row = format!("generalised-alpha, spectral radius {radius}, accuracy 3e-6");
        let text = format!("spectral_radius = {radius}\naccuracy = 3e-6");
        list.push((row, text));
    }
    for max_step in ["0.25", "1"] {
        let row = format!("generalised-alpha, accuracy 3e-6, steps up to {max_step} s");
        let text = format!("max_step = {max_step}\naccuracy = 3e-6");
        list.push((row, text));
    }
    // Higher orders: steps of 0.05 s and less have no end, since the vibrations break the line.
    for (order, step) in [("3", "0.4"), ("3", "0.1")] {
        let row = format!("bdf up to order {order}, step {step} s");
        let text = format!("integrator = \"bdf\"\nmax_order = {order}\nstep = {step}");
        list.push((row, text));
    }
    list
}

/// What is read off a run.
struct Figures {
    /// Mean offset of the buffer over the last heave period [m].
    offset: f64,
    /// Smallest and largest effective tension at the ship [N].
    tension: [f64; 2],
    steps: u64,
    rejected: u64,
    iterations: u64,
    factorisations: u64,
    cpu_seconds: f64,
}

/// Runs everything and writes the table into the chapter on integration.
pub(crate) fn write_table(root: &Path) -> Result<(), String> {
    let bench = Bench::new(root)?;
    let mut table = String::from(
        "| case, setting | offset error, mm | error of top tension range, % | steps (rejected) | \
         iterations | factorisations | processor time, s |\n| --- | --- | --- | --- | --- | --- | --- |\n",
    );
    for case in CASES {
        let exact = bench.run(case, REFERENCE)?;
        for (name, text) in settings() {
            let found = bench.run(case, &text)?;
            let row = row(&format!("{case}: {name}"), &found, &exact);
            println!("{row}");
            let _ = writeln!(table, "{row}");
        }
    }
    write_between(root, CHAPTER, [BEGIN, END], &table)
}

fn row(name: &str, found: &Figures, exact: &Figures) -> String {
    let swing = exact.tension[1] - exact.tension[0];
    let worst = (0..2)
        .map(|k| (found.tension[k] - exact.tension[k]).abs())
        .fold(0.0, f64::max);
    format!(
        "| {name} | {:.1} | {:.2} | {} ({}) | {} | {} | {:.2} |",
        1e3 * (found.offset - exact.offset).abs(),
        100.0 * worst / swing,
        found.steps,
        found.rejected,
        found.iterations,
        found.factorisations,
        found.cpu_seconds,
    )
}

struct Bench {
    example: String,
    program: PathBuf,
    folder: PathBuf,
}

impl Bench {
    fn new(root: &Path) -> Result<Bench, String> {
        let (program, target) = build_catenix(root)?;
        let folder = target.join("integrators");
        fs::create_dir_all(&folder).map_err(|error| error.to_string())?;
        Ok(Bench {
            example: fs::read_to_string(root.join(MODEL)).map_err(|error| error.to_string())?,
            program,
            folder,
        })
    }

    /// Runs one case with other lines in place of the example's step.
    fn run(&self, case: &str, settings: &str) -> Result<Figures, String> {
        let text = replaced(
            &self.example,
            "step = \"0.1 s\"\n",
            &format!("{settings}\n"),
        )?;
        let interval = format!("\ninterval = \"{INTERVAL}\"");
        let text = replaced(&text, "\ninterval = \"0.1 s\"", &interval)?;
        let file = self.folder.join("model.toml");
        fs::write(&file, text).map_err(|error| error.to_string())?;
        let output = Command::new(&self.program)
            .arg("run")
            .arg(&file)
            .args(["--json", "--quiet", "--case", case, "--out"])
            .arg(self.folder.join("results"))
            .output()
            .map_err(|error| format!("catenix did not start: {error}"))?;
        let summary: Value = serde_json::from_slice(&output.stdout)
            .map_err(|error| format!("no summary of `{settings}`: {error}"))?;
        read(&summary["cases"][case]).ok_or_else(|| {
            format!(
                "`{settings}` has no results: {}",
                summary["cases"][case]["error"]
            )
        })
    }
}

fn read(case: &Value) -> Option<Figures> {
    let tension = &case["lines"]["lift_pipe"]["end_a"]["effective_tension_n"];
    Some(Figures {
        offset: case["bodies"]["buffer"]["offset_x_m"].as_f64()?,
        tension: [tension["min"].as_f64()?, tension["max"].as_f64()?],
        steps: case["steps"].as_u64()?,
        rejected: case["rejected_steps"].as_u64()?,
        iterations: case["iterations"].as_u64()?,
        factorisations: case["factorisations"].as_u64()?,
        cpu_seconds: case["cpu_seconds"].as_f64()?,
    })
}

fn replaced(text: &str, from: &str, to: &str) -> Result<String, String> {
    if text.contains(from) {
        Ok(text.replace(from, to))
    } else {
        Err(format!("{MODEL} has changed: no `{}`", from.trim()))
    }
}
