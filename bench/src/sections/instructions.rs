//! Instructions that a short run executes, counted by valgrind: the same on a busy machine.

use std::process::Command;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::{Section, kept, no_charts, recalled};
use crate::child;
use crate::context::{Context, read_text};
use crate::markdown::{Table, digits, grouped};
use crate::probe::{Probe, Task};
use crate::trial::{self, MESH, Stepping};

pub(crate) const SECTION: Section = Section {
    name: "instructions",
    title: "Instructions",
    measure,
    markdown,
    charts: no_charts,
};

/// Simulated time [s]; not less than the statistics window of the example.
const DURATION: f64 = 20.0;
const STEP: f64 = 0.1;
/// Functions that are named.
const NAMED: usize = 12;

#[derive(Debug, Serialize, Deserialize)]
struct Data {
    /// `None` where valgrind is missing.
    counts: Option<Counts>,
}

#[derive(Debug, Serialize, Deserialize)]
struct Counts {
    valgrind: String,
    elements: usize,
    statics_iterations: usize,
    iterations: usize,
    steps: usize,
    /// Of reading, assembling and settling.
    statics: f64,
    /// Of the same and the motion.
    total: f64,
    /// Instructions in each function alone.
    functions: Vec<(String, f64)>,
}

fn measure(context: &Context) -> Result<Value, String> {
    let version = crate::machine::said(Command::new("valgrind").arg("--version"));
    let Some(valgrind) = version else {
        eprintln!(
            "  skipped: valgrind is not installed (Debian, Ubuntu: apt-get install valgrind)"
        );
        return kept(&Data { counts: None });
    };
    let mut variant = trial::variant(context, MESH, Stepping::Fixed(STEP))?;
    variant.set(
        "dynamics.duration",
        if context.quick { 8.0 } else { DURATION },
    )?;
    let model = variant.write(context, "instructions")?;
    let task = |statics_only| Task {
        model: model.clone(),
        case: "a".to_owned(),
        channels: Vec::new(),
        statics_only,
        accuracy: None,
    };
    let (statics, _) = count(context, &task(true), "statics")?;
    let (total, functions) = count(context, &task(false), "motion")?;
    let probe: Probe = task(false).run(context)?;
    kept(&Data {
        counts: Some(Counts {
            valgrind,
            elements: probe.elements,
            statics_iterations: probe.statics_iterations,
            iterations: probe.iterations,
            steps: probe.steps,
            statics,
            total,
            functions,
        }),
    })
}

/// Instructions of a task in its own process, all and by function.
fn count(context: &Context, task: &Task, name: &str) -> Result<(f64, Vec<(String, f64)>), String> {
    let file = context.work.join(format!("callgrind.{name}.out"));
    let probe = task.command(context);
    let mut command = Command::new("valgrind");
    command
        .arg("--tool=callgrind")
        .arg(format!("--callgrind-out-file={}", file.display()))
        .arg(probe.get_program())
        .args(probe.get_args());
    child::output_of(&mut command)?;
    parse(&read_text(&file)?)
}

/// Totals of a callgrind profile: of the program, and of each function alone, most first.
fn parse(text: &str) -> Result<(f64, Vec<(String, f64)>), String> {
    let mut names: Vec<(String, String)> = Vec::new();
    let mut costs: std::collections::BTreeMap<String, f64> = Default::default();
    let mut function = String::new();
    let mut total = None;
    let mut inclusive = false;
    for line in text.lines() {
        if let Some(rest) = line.strip_prefix("fn=") {
            let (id, name) = rest.split_once(' ').unwrap_or((rest, ""));
            if !name.is_empty() {
                names.push((id.to_owned(), name.to_owned()));
            }
            id.clone_into(&mut function);
        } else if let Some(rest) = line.strip_prefix("cfn=") {
            if let Some((id, name)) = rest.split_once(' ') {
                names.push((id.to_owned(), name.to_owned()));
            }
        } else if line.starts_with("calls=") {
            // The next line holds the cost of the called function, which is its own affair.
            inclusive = true;
        } else if let Some(rest) = line.strip_prefix("totals:") {
            total = rest.trim().parse().ok();
        } else if line.starts_with(['+', '-', '*'])
            || line.starts_with(|c: char| c.is_ascii_digit())
        {
            let cost = line.split_whitespace().nth(1);
            if let (false, Some(cost)) = (inclusive, cost.and_then(|cost| cost.parse::<f64>().ok()))
            {
                *costs.entry(function.clone()).or_default() += cost;
            }
            inclusive = false;
        }
    }
    let name = |id: &String| {
        let found = names.iter().find(|(known, _)| known == id);
        found.map_or_else(|| id.clone(), |(_, name)| short(name))
    };
    let mut list: Vec<(String, f64)> = costs.iter().map(|(id, cost)| (name(id), *cost)).collect();
    list.sort_by(|a, b| b.1.total_cmp(&a.1));
    list.truncate(NAMED);
    Ok((total.ok_or("callgrind wrote no totals")?, list))
}

/// A function's name without the compiler's hash.
fn short(name: &str) -> String {
    let name = name.split("'").next().unwrap_or(name);
    match name.rsplit_once("::h") {
        Some((before, hash)) if hash.len() == 16 => before.to_owned(),
        _ => name.to_owned(),
    }
}

fn markdown(data: &Value) -> Result<String, String> {
    let data: Data = recalled(data)?;
    let Some(c) = data.counts else {
        return Ok("Skipped: valgrind is not installed on this machine.\n".to_owned());
    };
    let motion = c.total - c.statics;
    let each = motion / c.iterations as f64;
    let mut table = Table::new(&["", "instructions"]);
    let mut row = |what: String, value: f64| table.row([what, grouped(value)]);
    row("whole program".to_owned(), c.total);
    row("the motion".to_owned(), motion);
    row("per iteration of the motion".to_owned(), each);
    row(
        "per iteration and element of the motion".to_owned(),
        each / c.elements as f64,
    );
    row(
        "per iteration and element until the equilibrium, reading included".to_owned(),
        c.statics / (c.statics_iterations * c.elements) as f64,
    );
    let mut functions = Table::new(&["function, without what it calls", "share, %"]);
    for (name, cost) in &c.functions {
        functions.row([
            format!("`{}`", name.replace('|', "\\|")),
            digits(100.0 * cost / c.total),
        ]);
    }
    Ok(format!(
        "Equilibrium ({} iterations) and the first {} s of case a in {} steps with {} iterations,\n\
         {} elements, counted by {} (callgrind).\n\n{}\n{}",
        c.statics_iterations,
        digits(c.steps as f64 * STEP),
        c.steps,
        c.iterations,
        c.elements,
        c.valgrind,
        table.text(),
        functions.text(),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_profile_is_read_without_what_functions_call() {
        let text = "fn=(1) main::h0123456789abcdef\n5 10\ncfn=(2) solve\ncalls=3 7\n+1 500\n+2 7\n\
                    fn=(2)\n9 500\ntotals: 517\n";
        let (total, functions) = parse(text).expect("a profile");
        assert_eq!(total, 517.0);
        assert_eq!(
            functions,
            [("solve".to_owned(), 500.0), ("main".to_owned(), 17.0)]
        );
        assert!(parse("fn=(1) a\n").is_err());
    }
}
