//! Benchmarks of Catenix, alone and beside its peers; run as `cargo xtask bench`.
//!
//! docs/benchmarks.md says what is measured and how.

// This program talks to a person at a terminal; printing is its only output beside its files.
#![allow(clippy::print_stdout, clippy::print_stderr)]

mod child;
mod context;
mod machine;
mod markdown;
mod probe;
mod python;
mod sections;
mod store;
mod trial;
mod variant;

use std::process::ExitCode;
use std::time::Instant;

use context::Context;
use machine::Circumstances;
use probe::Task;
use sections::{SECTIONS, Section};
use store::Entry;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let outcome = match arguments.first().map(String::as_str) {
        Some("probe") => probe(&arguments[1..]),
        Some("page") => store::write_page(&context::workspace_root().join("bench")),
        _ => measure(&arguments),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}

/// One measurement, in this process.
fn probe(arguments: &[String]) -> Result<(), String> {
    let found = Task::from_arguments(arguments)?.compute()?;
    let text = serde_json::to_string(&found).map_err(|error| error.to_string())?;
    println!("{text}");
    Ok(())
}

/// Measures the sections that are named, or all.
fn measure(arguments: &[String]) -> Result<(), String> {
    let quick = arguments.iter().any(|argument| argument == "--quick");
    let names = arguments.iter().filter(|argument| *argument != "--quick");
    let mut chosen: Vec<&Section> = Vec::new();
    for name in names {
        let found = SECTIONS.iter().find(|section| section.name == name);
        chosen.push(found.ok_or_else(|| usage(name))?);
    }
    if chosen.is_empty() {
        chosen.extend(SECTIONS);
    }
    let context = Context::new(quick)?;
    let mut failed = Vec::new();
    for section in chosen {
        eprintln!("{}", section.title);
        let start = Instant::now();
        let command = format!(
            "cargo xtask bench {}{}",
            section.name,
            if quick { " --quick" } else { "" }
        );
        let mut circumstances = Circumstances::now(&context.root, command);
        // One section that cannot run (no network, say) must not take the others with it.
        match (section.measure)(&context) {
            Ok(data) => {
                circumstances.load[1] = machine::load();
                circumstances.elapsed_s = start.elapsed().as_secs_f64();
                let entry = Entry {
                    circumstances,
                    data,
                };
                println!("{}", (section.markdown)(&entry.data)?);
                store::keep(&context.output(), section, entry)?;
            }
            Err(message) => {
                eprintln!("{}: {message}", section.name);
                failed.push(section.name);
            }
        }
    }
    if failed.is_empty() {
        println!("written: {}", context.output().join(store::PAGE).display());
        Ok(())
    } else {
        Err(format!("failed: {}", failed.join(", ")))
    }
}

fn usage(unknown: &str) -> String {
    let names: Vec<&str> = SECTIONS.iter().map(|section| section.name).collect();
    format!(
        "there is no section `{unknown}`\n\
         usage: cargo xtask bench [--quick] [SECTION...], with sections {}; or `page`, which makes \
         page and figures of the kept numbers again",
        names.join(", ")
    )
}
