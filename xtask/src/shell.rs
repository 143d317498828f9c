//! Other programs, run from the root of the workspace.

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// What a task ends with; the error is a sentence for the person who called it.
pub type Outcome = Result<(), String>;

/// Root of the workspace.
pub fn root() -> PathBuf {
    let manifest = Path::new(env!("CARGO_MANIFEST_DIR"));
    manifest.parent().unwrap_or(manifest).to_path_buf()
}

/// A program to be run in the root of the workspace.
pub fn command(program: impl AsRef<std::ffi::OsStr>) -> Command {
    let mut command = Command::new(program);
    command.current_dir(root());
    command
}

/// Cargo with these arguments (words, separated by spaces).
pub fn cargo(arguments: &str) -> Command {
    let mut cargo = command(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.args(arguments.split_whitespace());
    // The extension for Python is checked without one.
    cargo.env("PYO3_NO_PYTHON", "1").env("PYO3_BUILD_EXTENSION_MODULE", "1");
    cargo
}

/// Cargo for programs that run thousands of analyses. The solver and the check are compiled as one unit, which runs in
/// two fifths of the time; who tries one test after a change would wait for all of it, so it is not the profile's.
pub fn cargo_for_many_runs(arguments: &str) -> Command {
    let (task, rest) = arguments.split_once(' ').unwrap_or((arguments, ""));
    let mut cargo = cargo(task);
    cargo.args(["--config", "profile.dev.package.slipstick-dynamics.codegen-units=1"]);
    cargo.args(rest.split_whitespace());
    cargo
}

/// Runs a program with its output on the terminal.
pub fn run(command: &mut Command) -> Outcome {
    let name = name(command);
    let status = command.status().map_err(|error| format!("{name}: {error}"))?;
    if status.success() { Ok(()) } else { Err(format!("{name}: {status}")) }
}

/// Runs a program and returns what it printed; its messages go to the terminal.
pub fn output(command: &mut Command) -> Result<String, String> {
    let name = name(command);
    let output =
        command.stderr(Stdio::inherit()).output().map_err(|error| format!("{name}: {error}"))?;
    if !output.status.success() {
        return Err(format!("{name}: {}", output.status));
    }
    String::from_utf8(output.stdout).map_err(|error| format!("{name}: {error}"))
}

/// Whether a program answers to these arguments.
pub fn answers(program: &str, arguments: &str) -> bool {
    let mut probe = command(program);
    probe.args(arguments.split_whitespace()).stdout(Stdio::null()).stderr(Stdio::null());
    probe.status().is_ok_and(|status| status.success())
}

/// Installs a cargo subcommand or tool from its registry, unless it answers already.
pub fn ensure_installed(program: &str, probe: &str, package: &str) -> Outcome {
    if answers(program, probe) {
        return Ok(());
    }
    eprintln!("{package} is not installed: cargo install --locked {package}");
    run(&mut cargo(&format!("install --locked {package}")))
}

/// Where cargo puts what it builds.
pub fn target_folder() -> Result<PathBuf, String> {
    let text = output(&mut cargo("metadata --format-version 1 --no-deps"))?;
    let metadata: Value =
        serde_json::from_str(&text).map_err(|error| format!("cargo metadata: {error}"))?;
    metadata["target_directory"]
        .as_str()
        .map(PathBuf::from)
        .ok_or_else(|| "cargo metadata: no target_directory".to_owned())
}

/// Writes a generated file, with its folder.
pub fn write(path: &Path, text: &str) -> Outcome {
    let folder = path.parent().unwrap_or(path);
    std::fs::create_dir_all(folder)
        .and_then(|()| std::fs::write(path, text))
        .map_err(|error| format!("{}: {error}", path.display()))?;
    eprintln!("wrote {}", path.display());
    Ok(())
}

fn name(command: &Command) -> String {
    let program = Path::new(command.get_program()).file_stem().unwrap_or_default();
    let first = command.get_args().next().unwrap_or_default();
    format!("{} {}", program.to_string_lossy(), first.to_string_lossy())
}
