//! Times one analysis as the Python package calls it: `cargo xtask bench-python`.
//!
//! `run_bench MODEL`; every line of standard input is a number of runs, answered by the nanoseconds of each;
//! after the word `demands` the solver alone is run, without bounds of friction, history and certificate.

#![allow(clippy::print_stdout, reason = "its answers")]

use std::io::{self, BufRead};
use std::path::PathBuf;
use std::time::Instant;

use slipstick::assessment::single::Job;
use slipstick::input;
use slipstick::solver::exact_demands;
use slipstick_files::{OpenJob, read_at_most};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = PathBuf::from(std::env::args_os().nth(1).ok_or("expected a model")?);
    let bytes = read_at_most(&path, input::MAX_TEXT_BYTES as u64)?;
    let analysis = input::from_bytes(&path.display().to_string(), &bytes, &[])?;
    let open = OpenJob::new(&path, analysis, None)?;
    for line in io::stdin().lock().lines() {
        let line = line?;
        let (count, demands) = match line.trim().strip_prefix("demands ") {
            Some(count) => (count.parse()?, true),
            None => (line.trim().parse::<usize>()?, false),
        };
        let mut told = Vec::with_capacity(count);
        if demands {
            let Job { analysis, motion, .. } = &open.job;
            for _ in 0..count {
                let start = Instant::now();
                let response = exact_demands(&analysis.model, motion)?;
                told.push(start.elapsed().as_nanos().to_string());
                drop(response);
            }
        }
        let count = if demands { 0 } else { count };
        for _ in 0..count {
            let start = Instant::now();
            let job = Job::new(open.job.analysis.clone(), open.job.loaded.clone())?;
            let again = OpenJob { job, ..open.clone() };
            let outcome = again.run(false)?;
            told.push(start.elapsed().as_nanos().to_string());
            drop(outcome);
        }
        println!("{}", told.join(" "));
    }
    Ok(())
}
