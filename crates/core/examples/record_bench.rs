//! Times reading and response spectra for `cargo xtask bench-records`, which talks to it line by
//! line.
//!
//! `read FILE COUNT [DT_S UNITS]` (DT_S may be `-`) prints the nanoseconds of reading a file that is in memory so many
//! times, then its number of values. `spectrum FILE DT_S COUNT OUT` does the same for the spectra of
//! 200 periods (0.02 to 10 s, evenly spaced by their logarithm) and five damping ratios of an
//! acceleration in m/s² (little-endian doubles), and writes PSa into OUT.

#![allow(
    clippy::disallowed_macros,
    clippy::disallowed_methods,
    clippy::disallowed_types,
    reason = "a program may print, read the clock and open files"
)]

use slipstick::motion::spectrum;
use slipstick::record::{self, Options, Units};
use std::error::Error;
use std::hint::black_box;
use std::time::Instant;

const DAMPING_RATIOS: [f64; 5] = [0.01, 0.02, 0.05, 0.1, 0.2];

fn main() -> Result<(), Box<dyn Error>> {
    for line in std::io::stdin().lines() {
        let line = line?;
        let words: Vec<&str> = line.split_whitespace().collect();
        match words.as_slice() {
            ["read", file, count, given @ ..] => read(file, count.parse()?, given)?,
            ["spectrum", file, dt_s, count, out] => {
                spectra(file, dt_s.parse()?, count.parse()?, out)?;
            }
            _ => return Err(format!("expected read or spectrum, found {line:?}").into()),
        }
    }
    Ok(())
}

fn read(file: &str, count: usize, given: &[&str]) -> Result<(), Box<dyn Error>> {
    let bytes = std::fs::read(file)?;
    let mut options = Options::default();
    if let [dt_s, units @ ..] = given {
        options.units = Units::parse(&units.join(" "));
        options.dt_s = dt_s.parse().ok();
    }
    let mut values = 0;
    for _ in 0..count {
        let clock = Instant::now();
        let record = record::read(file, black_box(&bytes), &options)?;
        print!("{} ", clock.elapsed().as_nanos());
        values = record.channels.iter().map(|channel| channel.values.len()).sum();
    }
    println!("{values}");
    Ok(())
}

fn spectra(file: &str, dt_s: f64, count: usize, out: &str) -> Result<(), Box<dyn Error>> {
    let bytes = std::fs::read(file)?;
    let (words, _) = bytes.as_chunks::<8>();
    let a: Vec<f64> = words.iter().map(|word| f64::from_le_bytes(*word)).collect();
    let times_s: Vec<f64> = (0..a.len()).map(|i| dt_s * i as f64).collect();
    let periods_s: Vec<f64> =
        (0..200).map(|k| 0.02 * (f64::from(k) / 199.0 * 500_f64.ln()).exp()).collect();
    let mut psa: Vec<u8> = Vec::new();
    for _ in 0..count {
        let clock = Instant::now();
        let found = spectrum(black_box(&times_s), &a, &periods_s, &DAMPING_RATIOS)?;
        print!("{} ", clock.elapsed().as_nanos());
        psa = found.ordinates.iter().flat_map(|one| one.psa_m_per_s2.to_le_bytes()).collect();
    }
    println!("{}", psa.len() / 8);
    Ok(std::fs::write(out, psa)?)
}
