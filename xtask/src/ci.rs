//! `cargo xtask ci`: all that must hold before a change goes in.

mod licences;
mod package;
mod page;
mod steps;
mod testing;

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
    ("wasm build of core and report", steps::wasm_build),
    ("golden values equal in bits under wasm", steps::wasm_golden),
    ("Python package", package::python),
    ("the page in a browser", page::page),
    ("licences of all dependencies", licences::licences),
];

/// Runs every step; the last line is `N passed, N failed, N skipped`.
pub fn ci() -> ExitCode {
    let started = Instant::now();
    let mut tally = Tally::default();
    let mut failures = Vec::new();
    for (i, (name, step)) in STEPS.iter().enumerate() {
        println!("[{}/{}] {name}", i + 1, STEPS.len());
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
