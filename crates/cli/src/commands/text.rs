//! Commands that print text: schema, units, completions, manual pages.

use std::io::{self, Write};
use std::path::Path;
use std::process::ExitCode;

use clap::{Command, CommandFactory};
use clap_complete::Shell;

use crate::args::{Cli, SchemaArgs};
use crate::failure::Failure;

/// Prints the JSON schema of the model file, or the units.
pub fn schema(args: &SchemaArgs) -> Result<ExitCode, Failure> {
    let text = if args.units { slipstick::units::table() } else { slipstick::input::json_schema() };
    let mut out = io::stdout().lock();
    out.write_all(text.as_bytes())?;
    if !text.ends_with('\n') {
        out.write_all(b"\n")?;
    }
    out.flush()?;
    Ok(ExitCode::SUCCESS)
}

/// Prints a completion script.
pub fn completions(shell: Shell) -> Result<ExitCode, Failure> {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Cli::command(), "slipstick", &mut script);
    let mut out = io::stdout().lock();
    out.write_all(&script)?;
    out.flush()?;
    Ok(ExitCode::SUCCESS)
}

/// Writes one manual page a command.
pub fn man(folder: &Path) -> Result<ExitCode, Failure> {
    let mut output = slipstick_files::OutputFolder::create(folder, &[])?;
    let mut command = Cli::command().disable_help_subcommand(true);
    command.build();
    page(&command, "slipstick", &mut output)?;
    for sub in command.get_subcommands().filter(|sub| !sub.is_hide_set()) {
        page(sub, &format!("slipstick-{}", sub.get_name()), &mut output)?;
    }
    output.commit()?;
    Ok(ExitCode::SUCCESS)
}

fn page(
    command: &Command,
    name: &str,
    output: &mut slipstick_files::OutputFolder,
) -> Result<(), Failure> {
    let mut text = Vec::new();
    let command = command.clone().name(name.to_owned());
    clap_mangen::Man::new(command).render(&mut text)?;
    output.write(&format!("{name}.1"), &text)?;
    Ok(())
}
