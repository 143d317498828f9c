//! `slipstick init`: an example model that runs as it stands.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use super::tank;
use crate::args::{Example, InitArgs};
use crate::failure::{Failure, say};

const BLOCK: &str = include_str!("../../models/block.toml");
const MOCK_UP: &str = include_str!("../../models/mock-up.toml");
const FRAME: &str = include_str!("../../models/frame.toml");
const STOP: &str = include_str!("../../models/stop.toml");
const DOUBLE_PENDULUM: &str = include_str!("../../models/double-pendulum.toml");
const TRIPLE_PENDULUM: &str = include_str!("../../models/triple-pendulum.toml");
const CONTENTS: &str = include_str!("../../models/contents.toml");
const STRUCTURE: &str = include_str!("../../models/structure.toml");

/// Writes `NAME.toml` into the working folder.
pub fn init(args: &InitArgs) -> Result<ExitCode, Failure> {
    let stem = args.name.strip_suffix(".toml").unwrap_or(&args.name);
    let text = match args.example {
        Example::Block => BLOCK,
        Example::MockUp => MOCK_UP,
        Example::Frame => FRAME,
        Example::Stop => STOP,
        Example::DoublePendulum => DOUBLE_PENDULUM,
        Example::TriplePendulum => TRIPLE_PENDULUM,
        Example::Contents => CONTENTS,
        Example::Structure => STRUCTURE,
        Example::TankSloshing => &tank::example()?,
    };
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
