//! `cargo xtask ci`: all that must hold before a change goes in; `release-check` and `nightly`: what else is tried.

mod licences;
mod package;
mod page;
mod release;
mod steps;
mod testing;

use crate::tools;
use std::process::ExitCode;
use std::time::Instant;

/// How many checks went which way; a step counts as one beside the tests in it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Held.
    pub passed: u64,
    /// Did not hold.
    pub failed: u64,
    /// Could not be tried here.
    pub skipped: u64,
}

/// Why a step did not pass.
pub enum Problem {
    /// Something does not hold.
    Failed(String),
    /// This machine lacks what the step needs.
    NotRun(String),
}

impl From<String> for Problem {
    fn from(message: String) -> Self {
        Self::Failed(message)
    }
}

/// A step adds what it counted to the tally.
type Step = fn(&mut Tally) -> Result<(), Problem>;

/// Cheap ones first; a failing step does not keep the others from running.
const STEPS: &[(&str, Step)] = &[
    ("formatting", steps::formatting),
    ("lints", steps::lints),
    ("tests and doc tests", testing::tests),
    ("documentation", steps::documentation),
    ("examples", steps::examples),
    ("outputs in README and book", steps::console),
    ("wasm build of all that runs in a browser", steps::wasm_build),
    ("golden values equal in bits under wasm", steps::wasm_golden),
    ("Python package", package::python),
    ("the page in a browser", page::page),
    ("licences of all dependencies", licences::licences),
];

/// What a release hands out, in the profiles of a release.
const RELEASE: &[(&str, Step)] =
    &[("page", release::page), ("binary", release::binary), ("wheel", release::wheel)];

/// What takes too long for every change.
const NIGHTLY: &[(&str, Step)] =
    &[("tests that take minutes, coverage of intervals", testing::long), ("fuzzing", fuzzing)];

/// `cargo xtask ci`.
pub fn ci(words: &[&str]) -> ExitCode {
    asked("ci", STEPS, words)
}

/// `cargo xtask release-check`: wheel, page and binary are built as a release has them, and tested.
pub fn release_check(words: &[&str]) -> ExitCode {
    asked("release-check", RELEASE, words)
}

/// `cargo xtask nightly`.
pub fn nightly() -> ExitCode {
    all_of(NIGHTLY)
}

/// Every fuzz target for ten minutes.
fn fuzzing(_: &mut Tally) -> Result<(), Problem> {
    Ok(tools::fuzz(&["--seconds", "600"])?)
}

/// Runs all steps of a task; with words those that have one of them in their names.
fn asked(task: &str, steps: &[(&str, Step)], words: &[&str]) -> ExitCode {
    let asked = |name: &str| words.is_empty() || words.iter().any(|word| name.contains(word));
    let chosen: Vec<_> = steps.iter().filter(|(name, _)| asked(name)).copied().collect();
    if chosen.is_empty() {
        let names: Vec<&str> = steps.iter().map(|(name, _)| *name).collect();
        eprintln!("{task}: expected a word of {}, found {}", names.join(", "), words.join(" "));
        return ExitCode::FAILURE;
    }
    all_of(&chosen)
}

/// Runs every step; the last line is `N passed, N failed, N skipped`.
fn all_of(steps: &[(&str, Step)]) -> ExitCode {
    let started = Instant::now();
    let mut tally = Tally::default();
    let mut failures = Vec::new();
    for (i, (name, step)) in steps.iter().enumerate() {
        println!("[{}/{}] {name}", i + 1, steps.len());
        let clock = Instant::now();
        let result = step(&mut tally);
        let seconds = clock.elapsed().as_secs_f64();
        match result {
            Ok(()) => {
                tally.passed += 1;
                println!("  passed in {seconds:.1} s");
            }
            Err(Problem::Failed(reason)) => {
                tally.failed += 1;
                println!("  FAILED in {seconds:.1} s: {reason}");
                failures.push(*name);
            }
            Err(Problem::NotRun(reason)) => {
                tally.skipped += 1;
                println!("  not run: {name} ({reason})");
            }
        }
    }
    println!("{:.0} s", started.elapsed().as_secs_f64());
    if !failures.is_empty() {
        println!("failed: {}", failures.join(", "));
    }
    let Tally { passed, failed, skipped } = tally;
    println!("{passed} passed, {failed} failed, {skipped} skipped");
    if failed == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
