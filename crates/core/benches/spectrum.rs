//! Elastic response spectra: 200 periods by 5 damping ratios of a record of 60 s at 200 Hz.

#![allow(missing_docs, reason = "criterion's macros make undocumented functions")]
#![allow(clippy::disallowed_methods, clippy::unwrap_used, reason = "a bench may read and panic")]

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use slipstick::motion::intensity::{IntensityMeasures, Measure};
use slipstick::motion::{GroundMotion, spectrum};
use std::hint::black_box;

fn spectra(c: &mut Criterion) {
    let motion = taft();
    // From 0.02 to 10 s, evenly spaced by their logarithm.
    let periods_s: Vec<f64> =
        (0..200).map(|k| 0.02 * (f64::from(k) / 199.0 * 500_f64.ln()).exp()).collect();
    let damping = [0.01, 0.02, 0.05, 0.1, 0.2];
    let (times_s, a) = (motion.times_s(), motion.horizontal_m_per_s2());
    let mut group = c.benchmark_group("spectrum");
    group.throughput(Throughput::Elements((motion.len() * 1000) as u64));
    group.bench_function("200 periods x 5 dampings", |b| {
        b.iter(|| spectrum(black_box(times_s), a, &periods_s, &damping));
    });
    group.throughput(Throughput::Elements(motion.len() as u64));
    group.bench_function("standard measures", |b| {
        b.iter(|| IntensityMeasures::of(black_box(&motion)));
    });
    for name in ["Sa(1 s)", "Sa_avg(0.2 s, 2 s)", "FIV3(1 s)", "Tm"] {
        let measure = Measure::parse(name).unwrap();
        group.bench_function(name, |b| b.iter(|| measure.of(black_box(&motion))));
    }
    group.finish();
}

/// The Taft record, its straight lines sampled at 200 Hz, 60 s long.
fn taft() -> GroundMotion {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/records/taft-111.txt");
    let text = std::fs::read_to_string(file).unwrap();
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    let values: Vec<f64> = lines.filter_map(|line| line.trim().parse().ok()).collect();
    let mut fine: Vec<f64> = values.windows(2).flat_map(|a| [a[0], 0.5 * (a[0] + a[1])]).collect();
    fine.resize(12_001, 0.0);
    GroundMotion::evenly_spaced(0.005, fine.iter().map(|a| 9.80665 * a).collect(), None).unwrap()
}

criterion_group!(benches, spectra);
criterion_main!(benches);
