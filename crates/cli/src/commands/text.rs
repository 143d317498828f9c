//! Commands that print text: schema, units, completions, manual pages.

use std::path::Path;
use std::process::ExitCode;

use clap::{Command, CommandFactory};
use clap_complete::Shell;
use slipstick_files::{FileError, OutputFolder};

use crate::args::{Cli, SchemaArgs};
use crate::failure::{Failure, print};

/// Prints the JSON schema of the model file or of a study plan, or the units.
pub fn schema(args: &SchemaArgs) -> Result<ExitCode, Failure> {
    let text = match args {
        SchemaArgs { units: true, .. } => slipstick::units::table(),
        SchemaArgs { requests: true, .. } => slipstick::requests::table(),
        SchemaArgs { plan: true, .. } => slipstick::input::plan_json_schema(),
        _ => slipstick::input::json_schema(),
    };
    print(&text)?;
    Ok(ExitCode::SUCCESS)
}

/// Prints a completion script.
pub fn completions(shell: Shell) -> Result<ExitCode, Failure> {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Cli::command(), "slipstick", &mut script);
    print(&String::from_utf8_lossy(&script))?;
    Ok(ExitCode::SUCCESS)
}

/// Writes one manual page a command.
pub fn man(folder: &Path) -> Result<ExitCode, Failure> {
    let mut output = OutputFolder::create(folder, &[])?;
    let mut command = Cli::command().disable_help_subcommand(true);
    command.build();
    page(&command, "slipstick", &mut output)?;
    for sub in command.get_subcommands().filter(|sub| !sub.is_hide_set()) {
        let name = format!("slipstick-{}", sub.get_name());
        page(sub, &name, &mut output)?;
        for sub in sub.get_subcommands() {
            page(sub, &format!("{name}-{}", sub.get_name()), &mut output)?;
        }
    }
    output.commit()?;
    Ok(ExitCode::SUCCESS)
}

fn page(command: &Command, name: &str, output: &mut OutputFolder) -> Result<(), Failure> {
    let mut text = Vec::new();
    let man = clap_mangen::Man::new(command.clone()).title(name);
    let failed = |source| FileError::Write { path: output.path(&format!("{name}.1")), source };
    man.render(&mut text).map_err(failed)?;
    output.write(&format!("{name}.1"), &text)?;
    Ok(())
}
