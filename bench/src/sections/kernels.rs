//! Kernels alone, measured with criterion in `bench/benches/kernels`.

use std::path::{Path, PathBuf};
use std::process::Command;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::{Section, kept, no_charts, recalled};
use crate::context::{Context, read_text};
use crate::markdown::{Table, digits, grouped};

pub(crate) const SECTION: Section = Section {
    name: "kernels",
    title: "Kernels",
    measure,
    markdown,
    charts: no_charts,
};

/// Marks benchmarks of this run among those of earlier ones.
const BASELINE: &str = "catenix-bench";

#[derive(Debug, Serialize, Deserialize)]
struct Data {
    kernels: Vec<Kernel>,
}

#[derive(Debug, Serialize, Deserialize)]
struct Kernel {
    name: String,
    /// Elements, connectors or blocks in one pass.
    items: u64,
    /// Processor time of one pass, in the fastest of the samples [ns].
    fastest_ns: f64,
    /// The same in the median of the samples [ns].
    median_ns: f64,
}

fn measure(context: &Context) -> Result<Value, String> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let folder = context.work.join("criterion");
    if folder.exists() {
        std::fs::remove_dir_all(&folder).map_err(|error| error.to_string())?;
    }
    let mut command = Command::new(cargo);
    command
        .current_dir(&context.root)
        .env("CRITERION_HOME", &folder)
        .args(["bench", "--quiet", "--package", "catenix-bench"])
        .args(["--bench", "kernels", "--", "--noplot"])
        .args(["--save-baseline", BASELINE])
        .args(["--warm-up-time", "0.5"]);
    let seconds = if context.quick { "0.5" } else { "2" };
    command.args(["--measurement-time", seconds]);
    // Criterion's own words say how it goes; they belong on the terminal.
    let status = command.status().map_err(|error| error.to_string())?;
    if !status.success() {
        return Err(format!("`cargo bench` ended with {status}"));
    }
    let mut kernels = Vec::new();
    for group in folders(&folder)? {
        for kernel in folders(&group)? {
            let found = kernel.join(BASELINE);
            if found.exists() {
                kernels.push(read_kernel(&found)?);
            }
        }
    }
    kernels.sort_by(|a, b| a.name.cmp(&b.name));
    kept(&Data { kernels })
}

fn folders(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let entries = std::fs::read_dir(folder).map_err(|error| error.to_string())?;
    let paths = entries.filter_map(|entry| Some(entry.ok()?.path()));
    Ok(paths.filter(|path| path.is_dir()).collect())
}

fn read_kernel(folder: &Path) -> Result<Kernel, String> {
    let json = |name: &str| -> Result<Value, String> {
        let text = read_text(&folder.join(name))?;
        serde_json::from_str(&text).map_err(|error| format!("{name}: {error}"))
    };
    let (about, sample) = (json("benchmark.json")?, json("sample.json")?);
    let lacking = || format!("{} is not what criterion writes", folder.display());
    let numbers = |key: &str| -> Option<Vec<f64>> {
        let list = sample[key].as_array()?.iter();
        list.map(Value::as_f64).collect()
    };
    let passes = numbers("iters").ok_or_else(lacking)?;
    let times = numbers("times").ok_or_else(lacking)?;
    let mut each: Vec<f64> = times.iter().zip(&passes).map(|(t, n)| t / n).collect();
    each.sort_by(f64::total_cmp);
    Ok(Kernel {
        name: about["full_id"].as_str().ok_or_else(lacking)?.to_owned(),
        items: about["throughput"]["Elements"].as_u64().unwrap_or(1),
        fastest_ns: *each.first().ok_or_else(lacking)?,
        median_ns: each[each.len() / 2],
    })
}

fn markdown(data: &Value) -> Result<String, String> {
    let data: Data = recalled(data)?;
    let mut table = Table::new(&[
        "kernel",
        "items",
        "µs per pass",
        "ns per item",
        "median above it, %",
    ]);
    for kernel in &data.kernels {
        let (fastest, median) = (kernel.fastest_ns, kernel.median_ns);
        table.row([
            kernel.name.replace('/', ": "),
            grouped(kernel.items as f64),
            digits(1e-3 * fastest),
            digits(fastest / kernel.items as f64),
            format!("{:.0}", 100.0 * (median / fastest - 1.0)),
        ]);
    }
    Ok(format!(
        "Processor time on one thread, the fastest of criterion's samples. Items are connectors,\n\
         elements or blocks; \"sea trial\" is the example with 90 + 200 elements.\n\n{}",
        table.text()
    ))
}
