//! The `slipstick` command: arguments in, table or files out, an exit status.

mod args;
mod commands;
mod failure;
mod progress;

use std::process::ExitCode;

use args::{Cli, Command};
use clap::Parser;
use failure::Failure;

/// Exit status after Ctrl-C, as shells have it.
const INTERRUPTED: i32 = 130;

fn main() -> ExitCode {
    let cli = Cli::parse();
    // Without a handler Ctrl-C still ends the program, only temporary files would stay.
    let _ = ctrlc::set_handler(|| {
        slipstick_files::remove_temporaries();
        std::process::exit(INTERRUPTED);
    });
    let done = match &cli.command {
        Command::Run(args) => commands::run::run(args),
        Command::Init(args) => commands::init::init(args),
        Command::Schema(args) => commands::text::schema(args),
        Command::Completions { shell } => commands::text::completions(*shell),
        Command::Man { folder } => commands::text::man(folder),
    };
    match done {
        Ok(status) => status,
        Err(Failure::ClosedPipe) => ExitCode::SUCCESS,
        Err(failure) => {
            failure.report();
            ExitCode::from(2)
        }
    }
}
