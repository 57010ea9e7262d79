//! The command line: a thin face on the library. Progress, warnings and errors go to standard error, results to
//! standard output; the exit status is 0 only when every output is complete on disk.

mod args;
mod bench;
mod compare;
mod error;
mod info;
mod merge;
mod outputs;
mod picture;
mod prepare;
mod reference;
mod render;
mod report;
mod session;

use std::process::ExitCode;

use clap::Parser;

use crate::args::{Cli, Command};
use crate::session::say;

fn main() -> ExitCode {
    let done = match Cli::parse().command {
        Command::Render(args) => render::run(&args),
        Command::Merge(args) => merge::run(&args),
        Command::Compare(args) => compare::run(&args),
        Command::Info(args) => info::run(&args),
        Command::Bench(args) => bench::run(&args),
        Command::Reference(args) => reference::run(&args),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(e) => {
            say(&format!("etendue: {e}"));
            ExitCode::from(e.status())
        }
    }
}
