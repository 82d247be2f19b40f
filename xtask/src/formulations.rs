//! Formulations of lines side by side on the sea trial, as a table and figures.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::Value;

use crate::written::{build_catenix, write_between};

const MODEL: &str = "examples/sea-trial-1km.toml";
const CHAPTER: &str = "docs/theory/formulations.md";
const BEGIN: &str = "<!-- formulations table: begin -->";
const END: &str = "<!-- formulations table: end -->";
const FIGURES: &str = "docs/theory/figures";
const CASES: [&str; 2] = ["a", "d"];
/// Element counts over those of the model file, and that of the reference: two minutes in all.
const MESHES: &str = "0.25,0.5,1";
const REFERENCE_MESH: &str = "2";
const FORMULATIONS: &str = "dem,fem,fem-exact,lumped";
/// Results whose differences have a column: name, and what the column is called.
const RESULTS: [(&str, &str); 4] = [
    ("buffer.offset_x, mean", "offset, %"),
    (
        "lift_pipe.end_a.effective_tension, range",
        "top tension range, %",
    ),
    ("hose.end_b.force_x, mean", "hose end force x, % of tension"),
    ("hose.end_b.force_z, mean", "hose end force z, % of tension"),
];

/// Runs the comparison and writes table and figures into the chapter.
pub(crate) fn write_table(root: &Path) -> Result<(), String> {
    let (program, target) = build_catenix(root)?;
    let folder = target.join("formulations");
    let mut command = Command::new(program);
    command.arg("compare").arg(root.join(MODEL));
    command.args(["--formulations", FORMULATIONS, "--json", "--quiet"]);
    command.args(["--meshes", MESHES, "--reference-mesh", REFERENCE_MESH]);
    command.arg("--out").arg(&folder);
    for case in CASES {
        command.args(["--case", case]);
    }
    let output = command
        .output()
        .map_err(|error| format!("catenix did not start: {error}"))?;
    let document: Value = serde_json::from_slice(&output.stdout)
        .map_err(|error| format!("`catenix compare` printed no document: {error}"))?;
    let mut text = String::new();
    let mut files = Vec::new();
    for case in list(&document["cases"]) {
        let name = case["name"].as_str().unwrap_or_default();
        let figure = format!("formulations-cost-{name}.svg");
        files.push((format!("cost-{name}.svg"), figure.clone()));
        text.push_str(&case_table(case, name));
        let _ = writeln!(
            text,
            "\n![Error against cost, case {name}](figures/{figure})\n"
        );
    }
    println!("{text}");
    let figures = root.join(FIGURES);
    fs::create_dir_all(&figures).map_err(|error| format!("{FIGURES}: {error}"))?;
    for (from, to) in files {
        fs::copy(folder.join("figures").join(&from), figures.join(to))
            .map_err(|error| format!("{from}: {error}"))?;
    }
    write_between(root, CHAPTER, [BEGIN, END], &text)
}

/// Differences and costs of one load case.
fn case_table(case: &Value, name: &str) -> String {
    let reference = &case["reference"];
    let mut text = format!(
        "\nCase {name}, against {} with {} elements; differences on the mesh of the model file:\n\n| formulation |",
        reference["formulation"].as_str().unwrap_or("-"),
        reference["run"]["elements"],
    );
    for (_, title) in RESULTS {
        let _ = write!(text, " {title} |");
    }
    text.push_str(
        " iterations | MB | CPU, s | over dem | elements at 1 % | CPU at 1 %, s | over dem |\n|",
    );
    text.push_str(&" --- |".repeat(RESULTS.len() + 8));
    text.push('\n');
    let formulations = list(&case["formulations"]);
    let run = |formulation: &Value, which: &str| -> Value {
        let index = formulation[which].as_u64().map(|index| index as usize);
        index.map_or(Value::Null, |index| formulation["runs"][index].clone())
    };
    let cost = |formulation: &Value, which: &str| run(formulation, which)["cpu_seconds"].as_f64();
    let first = formulations.first().unwrap_or(&Value::Null);
    for (index, formulation) in formulations.iter().enumerate() {
        let word = formulation["formulation"].as_str().unwrap_or("-");
        let _ = write!(text, "| {word} |");
        for (result, _) in RESULTS {
            let found = list(&case["results"]).iter();
            let found = found.clone().find(|own| own["name"] == result);
            let value = found.and_then(|own| own["differences_percent"][index].as_f64());
            let _ = write!(text, " {} |", digits(value, 3));
        }
        let mesh = run(formulation, "equal_mesh");
        let megabytes = mesh["peak_memory_bytes"].as_f64().map(|bytes| bytes / 1e6);
        let _ = write!(text, " {} | {} |", mesh["iterations"], digits(megabytes, 2));
        for which in ["equal_mesh", "at_target"] {
            if which == "at_target" {
                let _ = write!(text, " {} |", run(formulation, which)["elements"]);
            }
            let own = cost(formulation, which);
            let ratio = own.zip(cost(first, which)).map(|(own, first)| own / first);
            let _ = write!(text, " {} | {} |", digits(own, 3), digits(ratio, 2));
        }
        text.push('\n');
    }
    text
}

fn list(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

fn digits(value: Option<f64>, decimals: usize) -> String {
    value.map_or_else(|| "-".to_owned(), |value| format!("{value:.decimals$}"))
}
