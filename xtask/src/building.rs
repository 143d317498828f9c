//! `cargo xtask bench-build`: how long who builds and tests has to wait.

use crate::shell::{self, Outcome};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

/// A clone of what is committed, with a target folder of its own, as a newcomer has it; registries stay.
struct Clone {
    folder: PathBuf,
}

impl Clone {
    fn fresh(parent: &Path, name: &str) -> Result<Self, String> {
        let folder = parent.join(name);
        let mut git = shell::command("git");
        git.args(["clone", "--quiet"]).arg(shell::root()).arg(&folder);
        shell::run(&mut git)?;
        Ok(Self { folder })
    }

    fn command(&self, program: &str, arguments: &str) -> Command {
        let mut command = Command::new(program);
        command.args(arguments.split_whitespace()).current_dir(&self.folder);
        command.env_remove("CARGO_TARGET_DIR");
        command
    }

    /// How long a program takes here.
    fn timed(&self, program: &str, arguments: &str) -> Result<Duration, String> {
        eprintln!("{program} {arguments}");
        let clock = Instant::now();
        shell::run(&mut self.command(program, arguments))?;
        let took = clock.elapsed();
        eprintln!("{program} {arguments}: {} s", took.as_secs());
        Ok(took)
    }
}

/// A figure and its bar, in s.
struct Row {
    what: &'static str,
    bar_s: u64,
    found: Duration,
}

/// The file of the solver that is changed; a comment at its end.
const CHANGED: &str = "crates/dynamics/src/solver/walk.rs";

/// Times what whoever builds and tests waits for; `--write` puts the table into the book.
pub fn bench_build(options: &[&str]) -> Outcome {
    let write = match options {
        [] => false,
        ["--write"] => true,
        _ => return Err(format!("bench-build: expected --write, found {}", options.join(" "))),
    };
    let parent = shell::target_folder()?.join("building");
    if parent.exists() {
        fs::remove_dir_all(&parent).map_err(|error| format!("{}: {error}", parent.display()))?;
    }
    let mut rows = Vec::new();
    let first = Clone::fresh(&parent, "first")?;
    // What is downloaded depends on the line, not on the sources.
    shell::run(&mut first.command("cargo", "fetch --quiet"))?;
    let mut row = |what, bar_s, found| rows.push(Row { what, bar_s, found });
    let run = "run --quiet --release -- run examples/taft.toml -q";
    row("a fresh clone to the first answer", 105, first.timed("cargo", run)?);
    let path = first.folder.join(CHANGED);
    let text = fs::read_to_string(&path).map_err(|error| format!("{CHANGED}: {error}"))?;
    fs::write(&path, text + "\n// A change.\n").map_err(|error| format!("{CHANGED}: {error}"))?;
    row("a change in the solver to a running command", 60, first.timed("cargo", run)?);
    row("`cargo test`, cold", 360, Clone::fresh(&parent, "tests")?.timed("cargo", "test --quiet")?);
    row("`cargo xtask ci`, cold", 900, Clone::fresh(&parent, "ci")?.timed("cargo", "xtask ci")?);
    if shell::answers("python3", "-m venv -h") {
        let pip = Clone::fresh(&parent, "pip")?;
        shell::run(&mut pip.command("python3", "-m venv environment"))?;
        let python = pip.folder.join("environment/bin/python");
        let install = "-m pip install --quiet --no-deps ./crates/python";
        row(
            "`pip install ./crates/python`, cold",
            150,
            pip.timed(&python.to_string_lossy(), install)?,
        );
    } else {
        eprintln!("not run: pip install (expected python3 with venv, found none)");
    }
    let processors = std::thread::available_parallelism().map_or(0, usize::from);
    let mut table = format!(
        "<!-- Written by `cargo xtask bench-build --write`. -->\n\n\
         | what, on {processors} processors | bar | measured | |\n|---|--:|--:|---|\n"
    );
    for Row { what, bar_s, found } in &rows {
        let missed = if found.as_secs() <= *bar_s { "" } else { "missed" };
        let [bar, found] =
            [*bar_s, found.as_secs()].map(|s| format!("{} min {:02} s", s / 60, s % 60));
        table.push_str(&format!("| {what} | {bar} | {found} | {missed} |\n"));
    }
    print!("{table}");
    if write {
        shell::write(&shell::root().join("book/src/generated/building.md"), &table)?;
    }
    fs::remove_dir_all(&parent).map_err(|error| format!("{}: {error}", parent.display()))
}
