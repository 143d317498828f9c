//! The `slipstick` command: arguments in, table or files out, an exit status.

mod args;
mod commands;
mod failure;
mod model_file;
mod opened;
mod progress;
mod record_args;
mod results;

use std::io::{self, IsTerminal};
use std::path::Path;
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};

use args::{Cli, Command};
use clap::Parser;
use clap::error::ErrorKind;
use failure::{Failure, print, say};
use slipstick::error::is_hidden;
use slipstick::input::MAX_TEXT_BYTES;

/// Exit status after Ctrl-C, as shells have it.
const INTERRUPTED: i32 = 130;

/// Set by Ctrl-C before anything else: what fails afterwards fails because of it.
static ENDING: AtomicBool = AtomicBool::new(false);

fn main() -> ExitCode {
    // Without a handler Ctrl-C still ends the program, only temporary files would stay.
    let _ = ctrlc::set_handler(|| {
        ENDING.store(true, Ordering::SeqCst);
        slipstick_files::remove_temporaries();
        progress::clear();
        if let Some(how) = progress::interrupted() {
            say(format_args!("{how}"));
        }
        std::process::exit(INTERRUPTED);
    });
    let failure = match run() {
        Ok(status) => return status,
        Err(failure) => failure,
    };
    while ENDING.load(Ordering::SeqCst) {
        // The handler took the files away and ends the process with its own status.
        std::thread::park();
    }
    failure.report();
    match failure {
        Failure::ClosedPipe => ExitCode::SUCCESS,
        Failure::CannotTell(_) => ExitCode::from(1),
        _ => ExitCode::from(2),
    }
}

/// What to write, where the first word is a file.
fn meant() -> Option<String> {
    let word = std::env::args_os().nth(1)?;
    let path = Path::new(&word);
    let name = word.to_string_lossy();
    let is_toml = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("toml"));
    let command = match slipstick_files::read_at_most(path, MAX_TEXT_BYTES as u64) {
        Ok(bytes) if is_toml => {
            let text = String::from_utf8_lossy(&bytes);
            let is_plan =
                text.lines().any(|line| line.split('=').next().unwrap_or("").trim() == "model");
            if is_plan { "study" } else { "run" }
        }
        Err(_) if is_toml => "run",
        _ if path.exists() => "record info",
        _ => return None,
    };
    Some(format!("expected a command, found the file {name}: write \"slipstick {command} {name}\""))
}

fn run() -> Result<ExitCode, Failure> {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        // Help and version are data: where they cannot be written, that is told.
        Err(error) if !error.use_stderr() && !io::stdout().is_terminal() => {
            print(&error.render().to_string())?;
            return Ok(ExitCode::SUCCESS);
        }
        Err(error) if error.kind() == ErrorKind::InvalidSubcommand && meant().is_some() => {
            say(format_args!("error: {}", meant().unwrap_or_default()));
            return Ok(ExitCode::from(2));
        }
        Err(error)
            if std::env::args_os().any(|word| word.to_string_lossy().contains(is_hidden)) =>
        {
            // It repeats what was typed, or what a pattern of the shell met.
            say(format_args!("{}", error.render().to_string().trim_end()));
            return Ok(if error.use_stderr() { ExitCode::from(2) } else { ExitCode::SUCCESS });
        }
        Err(error) => {
            let _ = error.print();
            return Ok(if error.use_stderr() { ExitCode::from(2) } else { ExitCode::SUCCESS });
        }
    };
    match &cli.command {
        Command::Run(args) => commands::run::run(args),
        Command::Compare(args) => commands::compare::compare(args),
        Command::Spectrum(args) => commands::assess::assess(args),
        Command::Sensitivity(args) => commands::assess::assess(args),
        Command::Ida(args) => commands::assess::assess(args),
        Command::Fragility(args) => commands::assess::fragility(args),
        Command::Design(args) => commands::assess::assess(args),
        Command::Record(command) => commands::record::record(command),
        Command::Structure(command) => commands::structure::structure(command),
        Command::Study(args) => commands::study::study(args),
        Command::Identify { job } => commands::identify::identify(job),
        Command::Init(args) => commands::init::init(args),
        Command::Paper(args) => commands::paper::paper(args),
        Command::Schema(args) => commands::text::schema(args),
        Command::Completions { shell } => commands::text::completions(*shell),
        Command::Man { folder } => commands::text::man(folder),
    }
}
