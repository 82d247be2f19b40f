//! The `catenix` command: reads a model file, computes it, prints and writes the results.
//!
//! It translates between the user and the libraries: no physics and no defaults live here.

mod args;
mod commands;
mod failure;
mod interrupt;
mod memory;
mod print;
mod progress;
mod tables;

use std::process::ExitCode;

use clap::Parser;

use crate::args::{Command, CommandLine};
use crate::failure::{Document, Failure};

fn main() -> ExitCode {
    let line = CommandLine::parse();
    let (name, json, result) = match &line.command {
        Command::Check(args) => ("check", args.output.json, commands::check(args)),
        Command::Statics(args) => ("statics", args.output.json, commands::statics(args)),
        Command::Modes(args) => ("modes", args.output.json, commands::modes(args)),
        Command::Path(args) => ("path", args.output.json, commands::path(args)),
        Command::Run(args) => ("run", args.output.json, commands::run(args)),
        Command::Summary(args) => ("summary", args.output.json, commands::summary(args)),
        Command::Export(args) => ("export", args.output.json, commands::export(args)),
        Command::Report(args) => ("report", args.json, commands::report(args)),
        Command::Verify(args) => ("verify", args.output.json, commands::verify(args)),
        Command::Compare(args) => ("compare", args.output.json, commands::compare(args)),
        Command::View(args) => ("view", false, commands::view(args)),
        Command::Schema => ("schema", false, commands::schema()),
    };
    let exit = result.unwrap_or_else(|failure: Failure| {
        let exit = failure.exit();
        if json {
            print::json(&Document::of_failure(name, &failure));
        } else {
            print::error(&failure.into_text());
        }
        exit
    });
    ExitCode::from(exit as u8)
}
