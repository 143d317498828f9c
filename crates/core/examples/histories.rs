//! Time of a history of the Taft example in ms, the best of several hundreds: what the page's module is
//! measured against.

#![allow(
    clippy::disallowed_macros,
    clippy::disallowed_methods,
    reason = "a program may print and read the clock"
)]

use std::time::Instant;

use slipstick::input::loaded::{Loaded, Wanted};
use slipstick::input::{MotionSource, parse};
use slipstick::record::{self, Options};
use slipstick::solver::{Prepared, PreparedMotion};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let text = include_str!("../../../examples/taft.toml");
    let bytes = include_bytes!("../../../examples/records/taft-111.txt");
    let analysis = parse("taft.toml", text, &[])?;
    let Some(MotionSource::Record(source)) = &analysis.motion else { return Ok(()) };
    let options = Options { format: None, units: source.units, dt_s: source.dt_s };
    let record = record::read(&source.path, bytes, &options)?;
    let wanted = Wanted { record: &record, channel: None };
    let loaded = Loaded::recorded(wanted, Some(source.scale))?;
    let motion = PreparedMotion::new(loaded.motion.with_tail(analysis.tail_s)?);
    let prepared = Prepared::new(analysis.model, motion.dt_s());
    let mut best_ms = f64::INFINITY;
    for _ in 0..7 {
        let start = Instant::now();
        for _ in 0..100 {
            std::hint::black_box(prepared.response(&motion)?);
        }
        best_ms = best_ms.min(start.elapsed().as_secs_f64() * 1000.0 / 100.0);
    }
    println!("{best_ms}");
    Ok(())
}
