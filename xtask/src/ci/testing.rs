//! The test step: runs `cargo test`, keeps its log short and counts.

use super::{Problem, Tally};
use crate::shell;
use std::io::{BufRead, BufReader};
use std::process::Stdio;

/// All tests of the workspace, doc tests included.
pub fn tests(tally: &mut Tally) -> Result<(), Problem> {
    counted("", tally)
}

/// Those that take minutes, and how often intervals cover the truth. What writes reference values is no test.
pub fn long(tally: &mut Tally) -> Result<(), Problem> {
    counted("--ignored --skip write_", tally)
}

/// `cargo test` with these options of the test programs.
fn counted(options: &str, tally: &mut Tally) -> Result<(), Problem> {
    // --show-output: a test that skips something says so on its own output.
    let test = format!("test --workspace --no-fail-fast -- --show-output {options}");
    let mut cargo = shell::cargo_for_many_runs(&test);
    let mut child =
        cargo.stdout(Stdio::piped()).spawn().map_err(|error| format!("cargo test: {error}"))?;
    let mut log = Log::default();
    if let Some(stdout) = child.stdout.take() {
        for line in BufReader::new(stdout).split(b'\n') {
            let line = line.map_err(|error| format!("cargo test: {error}"))?;
            let line = String::from_utf8_lossy(&line);
            if log.read(line.trim_end_matches('\r')) {
                println!("  {line}");
            }
        }
    }
    let status = child.wait().map_err(|error| format!("cargo test: {error}"))?;
    let counted = log.tally();
    tally.passed += counted.passed;
    tally.failed += counted.failed;
    tally.skipped += counted.skipped;
    println!(
        "  {} tests passed, {} failed, {} skipped",
        counted.passed, counted.failed, counted.skipped
    );
    match (status.success(), counted) {
        (true, Tally { failed: 0, .. }) => Ok(()),
        _ => Err(Problem::Failed(format!("cargo test: {status}"))),
    }
}

/// What the output of `cargo test` has said so far.
#[derive(Default)]
struct Log {
    results: Tally,
    /// Tests that passed by skipping what they are about.
    skipping: u64,
    /// Between `successes:` and what follows it.
    in_successes: bool,
    /// Between `failures:` and the result line: a test that failed has skipped nothing.
    in_failures: bool,
    /// The current test has already said that it skipped something.
    counted: bool,
}

impl Log {
    /// Takes in one line; true where a person wants to see it.
    fn read(&mut self, line: &str) -> bool {
        if let Some(result) = line.strip_prefix("test result:") {
            (self.in_successes, self.in_failures) = (false, false);
            self.results.passed += count(result, "passed");
            self.results.failed += count(result, "failed");
            self.results.skipped += count(result, "ignored");
            return true;
        }
        match line {
            "successes:" => self.in_successes = true,
            "failures:" => (self.in_successes, self.in_failures) = (false, true),
            _ => {}
        }
        if line.starts_with("---- ") || line.starts_with("test ") {
            self.counted = false;
        }
        if line.starts_with("skipped:") {
            self.skipping += u64::from(!(self.in_failures || self.counted));
            self.counted = true;
            return true;
        }
        let passed = line.starts_with("test ") && line.ends_with(" ok");
        !(self.in_successes || passed || line.is_empty() || line.starts_with("running "))
    }

    /// A test that says `skipped:` counts as skipped, not as passed.
    fn tally(&self) -> Tally {
        Tally {
            passed: self.results.passed.saturating_sub(self.skipping),
            failed: self.results.failed,
            skipped: self.results.skipped + self.skipping,
        }
    }
}

/// The number before a word, as in `ok. 3 passed; 0 failed; 1 ignored`.
fn count(result: &str, word: &str) -> u64 {
    let mut words = result.split([' ', ';', '.']).filter(|w| !w.is_empty());
    let mut previous = "";
    words
        .find_map(|w| {
            let found = (w == word).then(|| previous.parse().ok());
            previous = w;
            found
        })
        .flatten()
        .unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const OUTPUT: &str = "\
running 4 tests
test motion::peak ... ok
test motion::records ... ok
test motion::slow ... ignored
test motion::live ... 
skipped: said past the captured output
ok
test motion::wrong ... FAILED

successes:

---- motion::peak stdout ----
skippedless chatter
---- motion::records stdout ----
skipped: far-field records (no folder of records)
skipped: near-fault records (no folder of records)

successes:
    motion::peak
    motion::records

failures:

---- motion::wrong stdout ----
skipped: said by a test that failed
left: 1

failures:
    motion::wrong

test result: FAILED. 2 passed; 1 failed; 1 ignored; 0 measured; 0 filtered out; finished in 0.01s
test result: ok. 5 passed; 0 failed; 0 ignored; 0 measured; 0 filtered out; finished in 1.00s
";

    #[test]
    fn a_test_that_skips_is_counted_once_and_not_as_passed() {
        let mut log = Log::default();
        for line in OUTPUT.lines() {
            log.read(line);
        }
        assert_eq!(log.tally(), Tally { passed: 5, failed: 1, skipped: 3 });
    }

    #[test]
    fn failures_are_shown_and_successes_are_not() {
        let mut log = Log::default();
        let shown: Vec<&str> = OUTPUT.lines().filter(|line| log.read(line)).collect();
        assert!(shown.contains(&"left: 1") && shown.contains(&"test motion::wrong ... FAILED"));
        assert!(!shown.contains(&"skippedless chatter"));
        assert!(!shown.iter().any(|line| line.ends_with("... ok")));
    }
}
