//! Times models with devices for `cargo xtask bench-peers`, which talks to it line by line.
//!
//! `load MODEL` opens a model on its record. `time COUNT` prints the nanoseconds of so many analyses of the
//! demands, set-up of the system included. `history FILE` writes the sliding displacement at the samples as
//! little-endian doubles, in two directions along x, then along y, and prints the number of samples and
//! events. `script K_INIT FILE` writes the model
//! as a script for OpenSees, K_INIT being in N/m.

#![allow(clippy::print_stdout, reason = "its answers")]

use std::error::Error;
use std::hint::black_box;
use std::path::Path;
use std::time::Instant;

use slipstick::input;
use slipstick::solver;
use slipstick_files::{OpenJob, read_at_most};
use slipstick_report::opensees;

fn main() -> Result<(), Box<dyn Error>> {
    let mut open: Option<OpenJob> = None;
    for line in std::io::stdin().lines() {
        let line = line?;
        let words: Vec<&str> = line.split_whitespace().collect();
        match (words.as_slice(), &open) {
            (["load", file], _) => {
                let path = Path::new(file);
                let bytes = read_at_most(path, input::MAX_TEXT_BYTES as u64)?;
                let analysis = input::from_bytes(file, &bytes, &[])?;
                open = Some(OpenJob::new(path, analysis, None)?);
                println!("loaded");
            }
            (["time", count], Some(open)) => println!("{}", time(open, count.parse()?)?),
            (["history", file], Some(open)) => println!("{}", history(open, file)?),
            (["script", k_init, file], Some(open)) => {
                let job = &open.job;
                let script = opensees::script(
                    &open.name,
                    &job.analysis.model,
                    &job.motion,
                    k_init.parse()?,
                )?;
                std::fs::write(file, script)?;
                println!("written");
            }
            _ => {
                return Err(
                    format!("expected load, time, history or script, found {line:?}").into()
                );
            }
        }
    }
    Ok(())
}

fn time(open: &OpenJob, count: usize) -> Result<String, Box<dyn Error>> {
    let mut nanoseconds = Vec::with_capacity(count);
    for _ in 0..count {
        let clock = Instant::now();
        black_box(solver::exact_demands(&open.job.analysis.model, &open.job.motion)?);
        nanoseconds.push(clock.elapsed().as_nanos().to_string());
    }
    Ok(nanoseconds.join(" "))
}

fn history(open: &OpenJob, file: &str) -> Result<String, Box<dyn Error>> {
    let response = solver::exact(&open.job.analysis.model, &open.job.motion)?;
    let history = response.history.as_ref().ok_or("expected a history")?;
    // Of the two rows of a jump the right one, as in the script.
    let time_s = |row: &usize| history.time_s[*row];
    let pairs = history.rows.iter().zip(history.rows.iter().skip(1).map(Some).chain([None]));
    let rows: Vec<usize> = pairs
        .filter(|(row, next)| next.is_none_or(|next| time_s(next) > time_s(row)))
        .map(|(row, _)| *row)
        .collect();
    let along_y = response.in_plane.as_deref().and_then(|plane| plane.history.as_ref());
    let along_y = along_y.map(|y| &y.sliding_displacement_m);
    let axes = core::iter::once(&history.sliding_displacement_m).chain(along_y);
    let bytes: Vec<u8> =
        axes.flat_map(|s| rows.iter().flat_map(move |&row| s[row].to_le_bytes())).collect();
    std::fs::write(file, &bytes)?;
    Ok(format!("{} {}", rows.len(), response.events.len()))
}
