//! The command line.
//!
//! ```text
//! args, failure   arguments; why a command stopped
//! walk, files     the files of a folder or archive; writing results
//! scene_files     photographs by their head, until their pixels are needed
//! input           a scene's files, options and parameters
//! check           the orientation check alone
//! orient          photographs alone: their orientation
//! tiles, table    a region tile by tile; the summary of a run
//! block           a large area on many machines: plan, tile, join
//! reconstruct     the whole reconstruction
//! model           of a finished model: its roof report, a comparison, corrections
//! ```
//!
//! Exit codes: 0 done, 1 the outputs could not be written, 2 the input or the arguments are bad.
#![allow(clippy::print_stdout, clippy::print_stderr)] // The only place that writes to a terminal.

mod args;
mod block;
mod check;
mod failure;
mod files;
mod input;
mod model;
mod orient;
mod reconstruct;
mod scene_files;
mod table;
mod tiles;
mod walk;

use std::process::ExitCode;

use clap::Parser;
use ridgeline::base::params::Params;

use self::args::{Cli, Command};
use self::failure::Failure;

/// Runs the command that the arguments name.
pub fn main() -> ExitCode {
    let outcome = match Cli::parse().command {
        Command::Reconstruct(args) => reconstruct::reconstruct(&args),
        Command::Plan(args) => block::plan(&args),
        Command::Tile(args) => block::tile(&args),
        Command::Join(args) => block::join(&args),
        Command::Check(args) => check::check(&args),
        Command::Orient(args) => orient::orient(&args),
        Command::Report(args) => model::report(&args),
        Command::Compare(args) => model::compare(&args),
        Command::Correct(args) => model::correct(&args),
        Command::Params => print_params(),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(Failure::Input(message)) => {
            eprintln!("error: {message}");
            ExitCode::from(2)
        }
        Err(Failure::Output(message)) => {
            eprintln!("error: {message}");
            ExitCode::from(1)
        }
    }
}

fn print_params() -> Result<(), Failure> {
    let json = serde_json::to_string_pretty(&Params::default())
        .expect("parameters hold only numbers and names");
    println!("{json}");
    Ok(())
}
