//! A commercial system at 6000 m: six cases of the example.

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::system::keep_faster;
use super::{Section, kept, no_charts, recalled};
use crate::context::Context;
use crate::markdown::{Table, digits, grouped};
use crate::probe::{Probe, Task};
use crate::trial::Stepping;
use crate::variant::Variant;

pub(crate) const SECTION: Section = Section {
    name: "commercial",
    title: "A commercial system at 6000 m",
    measure,
    markdown,
    charts: no_charts,
};

const MODEL: &str = "examples/commercial-6000m.toml";
const CASES: [&str; 6] = ["a", "b", "c", "d", "e", "f"];
const STEPPINGS: [Stepping; 2] = [Stepping::Fixed(0.2), Stepping::Default];
const CHANNELS: [&str; 2] = ["buffer.offset_x", "|lift_pipe.end_a.force|"];

#[derive(Debug, Serialize, Deserialize)]
struct Data {
    runs: Vec<(String, Stepping, Probe)>,
}

fn measure(context: &Context) -> Result<Value, String> {
    let cases: &[&str] = if context.quick { &["f"] } else { &CASES };
    let mut tasks = Vec::new();
    for case in cases {
        for stepping in STEPPINGS {
            let mut variant = Variant::of(context, MODEL)?;
            variant.set("output.interval", 1.0)?;
            if let Stepping::Fixed(step) = stepping {
                variant.set("dynamics.step", step)?;
            }
            if context.quick {
                variant.set("dynamics.duration", 20.0)?;
            }
            let name = format!("commercial-{}", stepping.words().replace([' ', '.'], "_"));
            let task = Task {
                model: variant.write(context, &name)?,
                case: (*case).to_owned(),
                channels: CHANNELS.map(str::to_owned).to_vec(),
                statics_only: false,
                accuracy: None,
            };
            tasks.push((task, stepping));
        }
    }
    let mut fastest: Vec<Option<Probe>> = vec![None; tasks.len()];
    for repeat in 0..context.repeats().min(2) {
        eprintln!("  commercial system, repeat {} ...", repeat + 1);
        for ((task, _), best) in tasks.iter().zip(&mut fastest) {
            keep_faster(best, task.run(context)?);
        }
    }
    let runs = tasks.into_iter().zip(fastest);
    kept(&Data {
        runs: runs
            .filter_map(|((task, stepping), probe)| Some((task.case, stepping, probe?)))
            .collect(),
    })
}

fn markdown(data: &Value) -> Result<String, String> {
    let data: Data = recalled(data)?;
    let mut table = Table::new(&[
        "case, step",
        "statics, ms",
        "CPU ms per simulated s",
        "times real time",
        "steps (rejected)",
        "iterations per step",
        "ns per element and iteration",
        "mean offset at the end, m",
        "top tension, MN",
    ]);
    let mut elements = 0;
    let mut simulated = 0.0;
    for (case, stepping, probe) in &data.runs {
        let [offset, top] = probe.statistics[..] else {
            return Err("the kept numbers lack channels".to_owned());
        };
        elements = probe.elements;
        simulated = probe.simulated_s;
        table.row([
            format!("{case}, {}", stepping.words()),
            digits(1e3 * probe.statics_cpu_s),
            digits(1e3 * probe.per_simulated_second()),
            digits(1.0 / probe.per_simulated_second()),
            format!("{} ({})", probe.steps, probe.rejected_steps),
            format!("{:.2}", probe.iterations as f64 / probe.steps as f64),
            digits(1e9 * probe.per_iteration() / probe.elements as f64),
            format!("{:.1}", offset.mean),
            format!("{:.3} to {:.3}", 1e-6 * top.min, 1e-6 * top.max),
        ]);
    }
    Ok(format!(
        "{MODEL}, {elements} elements, the first {} s of a course; the motion alone, on one thread.\n\
         Most of its data are assumptions (the file says which): it shows cost, not answers.\n\n{}",
        grouped(simulated),
        table.text()
    ))
}
