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
        let clone = Self { folder };
        // What is downloaded depends on the line, not on the sources.
        shell::run(&mut clone.command("cargo", "fetch --quiet"))?;
        Ok(clone)
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

/// A figure of the table: what is waited for, its bar in s, and how it is measured.
struct Row {
    what: &'static str,
    bar_s: u64,
    measure: fn(&Path) -> Result<Option<Duration>, String>,
}

const ROWS: [Row; 5] = [
    Row { what: "a fresh clone to the first answer", bar_s: 105, measure: first_answer },
    Row { what: "a change in the solver to a running command", bar_s: 60, measure: after_change },
    Row { what: "`cargo test`, cold", bar_s: 360, measure: tests },
    Row { what: "`pip install ./crates/python`, cold", bar_s: 150, measure: pip },
    Row { what: "`cargo xtask ci`, cold", bar_s: 900, measure: ci },
];

/// The file of the solver that is changed; a comment at its end.
const CHANGED: &str = "crates/dynamics/src/solver/walk.rs";

/// The command of a first answer.
const RUN: &str = "run --quiet --release -- run examples/taft.toml -q";

/// Where the table is.
const TABLE: &str = "book/src/generated/building.md";

fn first_answer(parent: &Path) -> Result<Option<Duration>, String> {
    Clone::fresh(parent, "first")?.timed("cargo", RUN).map(Some)
}

fn after_change(parent: &Path) -> Result<Option<Duration>, String> {
    let built = Clone { folder: parent.join("first") };
    let clone = if built.folder.exists() { built } else { Clone::fresh(parent, "first")? };
    shell::run(&mut clone.command("cargo", RUN))?;
    let path = clone.folder.join(CHANGED);
    let text = fs::read_to_string(&path).map_err(|error| format!("{CHANGED}: {error}"))?;
    fs::write(&path, text + "\n// A change.\n").map_err(|error| format!("{CHANGED}: {error}"))?;
    clone.timed("cargo", RUN).map(Some)
}

fn tests(parent: &Path) -> Result<Option<Duration>, String> {
    Clone::fresh(parent, "tests")?.timed("cargo", "test --quiet").map(Some)
}

fn pip(parent: &Path) -> Result<Option<Duration>, String> {
    if !shell::answers("python3", "-m venv -h") {
        eprintln!("not run: pip install (expected python3 with venv, found none)");
        return Ok(None);
    }
    let clone = Clone::fresh(parent, "pip")?;
    shell::run(&mut clone.command("python3", "-m venv environment"))?;
    let python = clone.folder.join("environment/bin/python");
    let install = "-m pip install --quiet --no-deps ./crates/python";
    clone.timed(&python.to_string_lossy(), install).map(Some)
}

fn ci(parent: &Path) -> Result<Option<Duration>, String> {
    Clone::fresh(parent, "ci")?.timed("cargo", "xtask ci").map(Some)
}

/// Times what whoever builds and tests waits for: all, or the rows with one of some words in their names; `--write` puts
/// each into the table of the book as soon as it is measured, and leaves the others as they are.
pub fn bench_build(options: &[&str]) -> Outcome {
    let (flags, words): (Vec<&str>, Vec<&str>) =
        options.iter().partition(|option| option.starts_with('-'));
    if let Some(flag) = flags.iter().find(|flag| **flag != "--write") {
        return Err(format!("bench-build: expected --write or words, found {flag}"));
    }
    let is_meant =
        |row: &&Row| words.is_empty() || words.iter().any(|word| row.what.contains(word));
    let rows: Vec<&Row> = ROWS.iter().filter(is_meant).collect();
    if rows.is_empty() {
        let names = ROWS.map(|row| row.what).join(", ");
        return Err(format!("bench-build: expected words of {names}, found {}", words.join(" ")));
    }
    let parent = shell::target_folder()?.join("building");
    let remove = || match parent.exists() {
        true => fs::remove_dir_all(&parent).map_err(|e| format!("{}: {e}", parent.display())),
        false => Ok(()),
    };
    remove()?;
    let path = shell::root().join(TABLE);
    let mut lines = measured(&fs::read_to_string(&path).unwrap_or_default());
    for row in rows {
        let Some(found) = (row.measure)(&parent)? else { continue };
        let line = row.line(found);
        println!("{line}");
        lines.retain(|(what, _)| what != row.what);
        lines.push((row.what.to_owned(), line));
        if !flags.is_empty() {
            shell::write(&path, &table(&lines))?;
        }
    }
    remove()
}

impl Row {
    /// Its line of the table.
    fn line(&self, found: Duration) -> String {
        let missed = if found.as_secs() <= self.bar_s { "" } else { "missed" };
        let [bar, found] =
            [self.bar_s, found.as_secs()].map(|s| format!("{} min {:02} s", s / 60, s % 60));
        format!("| {} | {bar} | {found} | {missed} |", self.what)
    }
}

/// The lines of a table by what they are of.
fn measured(table: &str) -> Vec<(String, String)> {
    let of = |line: &str| {
        let what = line.strip_prefix("| ")?.split(" | ").next()?;
        ROWS.iter().any(|row| row.what == what).then(|| (what.to_owned(), line.to_owned()))
    };
    table.lines().filter_map(of).collect()
}

/// A table of lines, in the order of the rows.
fn table(lines: &[(String, String)]) -> String {
    let processors = std::thread::available_parallelism().map_or(0, usize::from);
    let head = format!(
        "<!-- Written by `cargo xtask bench-build --write`. -->\n\n\
         | what, on {processors} processors | bar | measured | |\n|---|--:|--:|---|\n"
    );
    let of = |row: &Row| lines.iter().find(|(what, _)| what == row.what);
    ROWS.iter().filter_map(of).fold(head, |table, (_, line)| table + line + "\n")
}
