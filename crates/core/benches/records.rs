//! Records: bytes a second of the readers that meet the most files.

#![allow(missing_docs, reason = "criterion's macros make undocumented functions")]
#![allow(clippy::disallowed_methods, clippy::unwrap_used, reason = "a bench may read and panic")]

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use slipstick::record::{self, Channel, Options, write_at2, write_csv};
use std::hint::black_box;

/// Taft, repeated until it is long enough to measure.
fn motion() -> Channel {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/records/taft-111.txt");
    let bytes = std::fs::read(path).unwrap();
    let units = record::Units::parse("g");
    let options = Options { units, dt_s: Some(0.01), ..Options::default() };
    let mut channel = record::read("taft", &bytes, &options).unwrap().channels.remove(0);
    channel.values = channel.values.repeat(20);
    channel
}

fn readers(c: &mut Criterion) {
    let channel = motion();
    let column: String = channel.values.iter().map(|v| format!("{:.6}\n", v / 9.80665)).collect();
    let csv: String = "time_s,acceleration_m_per_s2\n".to_owned()
        + &(0..channel.values.len())
            .map(|i| format!("{:.2},{:.6}\n", i as f64 * 0.01, channel.values[i]))
            .collect::<String>();
    let options =
        Options { units: record::Units::parse("g"), dt_s: Some(0.01), ..Options::default() };
    let nothing = Options::default();
    let mut group = c.benchmark_group("records");
    for (name, text, options) in [
        ("AT2", write_at2(&channel).unwrap(), &nothing),
        ("CSV", csv, &nothing),
        ("CSV, 17 digits", write_csv(&channel).unwrap(), &nothing),
        ("one column", column, &options),
    ] {
        group.throughput(Throughput::Bytes(text.len() as u64));
        group.bench_function(name, |b| {
            b.iter(|| record::read("bench", black_box(text.as_bytes()), options).unwrap());
        });
    }
    group.finish();
}

criterion_group!(benches, readers);
criterion_main!(benches);
