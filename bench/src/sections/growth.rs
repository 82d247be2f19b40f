//! Growth with the number of elements: a towed line in a current, from a hundred elements to a
//! hundred thousand.

use catenix_report::figure::{Chart, ChartAxis, Curve};
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::system::keep_faster;
use super::{Figures, Section, kept, recalled};
use crate::context::{Context, make_folder, write_text};
use crate::markdown::{Table, digits, grouped};
use crate::probe::{Probe, Task};

pub(crate) const SECTION: Section = Section {
    name: "growth",
    title: "Growth with the number of elements",
    measure,
    markdown,
    charts,
};

const COUNTS: [usize; 7] = [100, 300, 1000, 3000, 10_000, 30_000, 100_000];
/// Length of the line [m].
const LENGTH: f64 = 3000.0;
/// Steps of 0.1 s: as many for all, since the first ones take more iterations than the others.
const STEPS: usize = 200;
/// Up to this size, runs are repeated.
const REPEATED: usize = 10_000;

#[derive(Debug, Serialize, Deserialize)]
struct Data {
    length_m: f64,
    runs: Vec<Probe>,
}

/// A line that hangs from a ship with a weight at its end; at t = 0 the ship begins to move and the
/// current acts. Hanging straight down is the equilibrium, so the statics of the long ones is short.
fn model(elements: usize) -> String {
    let duration = 0.1 * STEPS as f64;
    format!(
        r#"title = "A towed line of {elements} elements"
[environment]
water.depth = 4000
current = {{ heading = "90 deg", profile = [
    {{ depth = 0, speed = 0.8 }},
    {{ depth = 500, speed = 0.2 }},
] }}
[line_types.cable]
kind = "general"
outer_diameter = 0.05
mass = 8
axial_stiffness = "100 MN"
bending_stiffness = "1 kN m^2"
torsional_stiffness = "1 kN m^2"
structural_damping = "0.01 s"
normal_drag = 1.2
axial_drag = 0.02
[motions.tow]
kind = "tow"
heading = 0
speed = 1
ramp = 5
[vessels.ship]
position = [0, 0, 0]
motions = ["tow"]
[lines.cable]
sections = [{{ type = "cable", length = {LENGTH}, elements = {elements} }}]
end_a = {{ to = "ship", joint = "ball" }}
start_shape = [[0, 0, 0], [0, 0, -{LENGTH}]]
[lines.cable.attachments.weight]
at = {LENGTH}
mass = 1000
volume = 0.13
drag_area = 0.5
[statics]
current = false
[dynamics]
duration = {duration}
step = 0.1
statistics_window = {duration}
[output]
interval = 0.1
field_interval = {duration}
"#
    )
}

fn measure(context: &Context) -> Result<Value, String> {
    let counts = if context.quick {
        &COUNTS[..3]
    } else {
        &COUNTS[..]
    };
    let folder = context.work.join("models");
    make_folder(&folder)?;
    let mut tasks = Vec::new();
    for elements in counts {
        let file = folder.join(format!("growth-{elements}.toml"));
        write_text(&file, &model(*elements))?;
        tasks.push(Task {
            model: file,
            case: "base".to_owned(),
            channels: Vec::new(),
            statics_only: false,
            accuracy: None,
        });
    }
    let mut fastest: Vec<Option<Probe>> = vec![None; tasks.len()];
    for repeat in 0..context.repeats() {
        for ((task, elements), best) in tasks.iter().zip(counts).zip(&mut fastest) {
            if repeat > 0 && *elements > REPEATED {
                continue;
            }
            eprintln!("  repeat {}: {} ...", repeat + 1, task.model.display());
            keep_faster(best, task.run(context)?);
        }
    }
    kept(&Data {
        length_m: LENGTH,
        runs: fastest.into_iter().flatten().collect(),
    })
}

/// Time of one step and of one iteration, per element [s].
fn each(probe: &Probe) -> [f64; 2] {
    let time = probe.motion_cpu_s / probe.elements as f64;
    [time / probe.steps as f64, time / probe.iterations as f64]
}

/// Memory per element beyond what the smallest run needs [bytes].
fn memory(probe: &Probe, least: &Probe) -> Option<f64> {
    let more = probe.elements - least.elements;
    (more > 0).then_some((probe.peak_bytes? - least.peak_bytes?) / more as f64)
}

fn markdown(data: &Value) -> Result<String, String> {
    let data: Data = recalled(data)?;
    let least = data.runs.first().ok_or("nothing was measured")?;
    let mut table = Table::new(&[
        "elements",
        "CPU ms per step",
        "steps (rejected)",
        "iterations per step",
        "ns per element and step",
        "ns per element and iteration",
        "statics, s",
        "peak memory, MB",
        "bytes per element",
    ]);
    for probe in &data.runs {
        let [step, iteration] = each(probe);
        let show = |value: Option<f64>| value.map_or("-".to_owned(), digits);
        table.row([
            grouped(probe.elements as f64),
            digits(1e3 * probe.motion_cpu_s / probe.steps as f64),
            format!("{} ({})", probe.steps, probe.rejected_steps),
            format!("{:.2}", probe.iterations as f64 / probe.steps as f64),
            digits(1e9 * step),
            digits(1e9 * iteration),
            digits(probe.statics_cpu_s),
            show(probe.peak_bytes.map(|bytes| 1e-6 * bytes)),
            show(memory(probe, least)),
        ]);
    }
    Ok(format!(
        "A line of {} m with a weight at its end, towed in a cross current, in steps of 0.1 s, on one\n\
         thread. Bytes per element: peak memory beyond that of the smallest run. Lines of more than\n\
         {} elements are computed once; time steps that were cut cost iterations.\n\n{}\n\
         ![Cost per element and step](figures/growth.svg)\n",
        grouped(data.length_m),
        grouped(REPEATED as f64),
        table.text()
    ))
}

fn charts(data: &Value) -> Result<Figures, String> {
    let data: Data = recalled(data)?;
    let curve = |label: &str, index: usize| {
        let points = data
            .runs
            .iter()
            .map(|probe| (probe.elements as f64, 1e9 * each(probe)[index]));
        Curve::new(label, points.collect())
    };
    let chart = Chart::new(
        "A towed line: cost per element",
        ChartAxis::logarithmic("Elements", ""),
        ChartAxis {
            from_zero: true,
            ..ChartAxis::linear("Processor time per element", "ns")
        },
        vec![curve("per step", 0), curve("per iteration", 1)],
    );
    Ok(vec![("growth".to_owned(), chart)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_line_runs_from_its_first_shape() {
        let context = Context::new(true).expect("a folder to work in");
        let folder = context.work.join("models");
        make_folder(&folder).expect("a folder");
        let file = folder.join("growth-smoke.toml");
        write_text(&file, &model(10)).expect("a file");
        let task = Task {
            model: file,
            case: "base".to_owned(),
            channels: vec!["|cable.end_a.force|".to_owned()],
            statics_only: false,
            accuracy: None,
        };
        let probe = task.compute().expect("a run");
        assert_eq!((probe.elements, probe.steps), (10, STEPS));
        // 8 kg/m of cable and the weight, less the water that they displace [N].
        let water = 1025.0 * (3000.0 * std::f64::consts::FRAC_PI_4 * 0.05_f64.powi(2) + 0.13);
        let weight = 9.80665 * (3000.0 * 8.0 + 1000.0 - water);
        // At rest at first; a tow of a few seconds lifts the line by less than one percent.
        assert!((probe.statistics[0].min / weight - 1.0).abs() < 0.01);
        let data = kept(&Data {
            length_m: LENGTH,
            runs: vec![probe],
        })
        .expect("JSON");
        assert!(markdown(&data).expect("a page").contains("| 10 |"));
        assert_eq!(charts(&data).expect("charts").len(), 1);
    }
}
