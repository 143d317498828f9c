//! `slipstick init`: an example model that runs as it stands.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::ValueEnum;
use slipstick_report::examples;

use crate::args::InitArgs;
use crate::failure::{Failure, say};

/// Writes `NAME.toml` into the working folder.
pub fn init(args: &InitArgs) -> Result<ExitCode, Failure> {
    let stem = args.name.strip_suffix(".toml").unwrap_or(&args.name);
    let example = args.example.to_possible_value();
    let text = example.and_then(|value| examples::text(value.get_name())).unwrap_or_default();
    let path = PathBuf::from(format!("{stem}.toml"));
    let nameless = Path::new(stem).file_name().is_none() || stem.ends_with(['/', '\\']);
    if nameless || stem == "-" {
        let found = &args.name;
        return Err(Failure::Message(format!("expected a name for the model, found {found:?}")));
    }
    if path.exists() && !args.force {
        return Err(Failure::Message(format!(
            "{}: stands there already; expected a new name, or --force to replace it",
            path.display()
        )));
    }
    slipstick_files::write_whole(&path, text.as_bytes())?;
    let path = path.display();
    say(format_args!("wrote {path}; next: slipstick run {path} --out out"));
    Ok(ExitCode::SUCCESS)
}
