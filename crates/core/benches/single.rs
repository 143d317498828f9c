//! Single analyses: an earthquake record, a low-friction case with hundreds of events, the set-up
//! of a new system alone.
//!
//! What an event costs follows from the pair `low_friction`: cutting every sample in two doubles
//! the ordinary samples and leaves the events, so an event costs (2 t − t₂) / events.

#![allow(missing_docs, reason = "criterion's macros make undocumented functions")]
#![allow(clippy::disallowed_methods, clippy::unwrap_used, reason = "a bench may read and panic")]

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use slipstick::check::check;
use slipstick::model::{Block, Damping, Frame, InitialState, Model, Slider};
use slipstick::motion::GroundMotion;
use slipstick::slider::Friction;
use slipstick::solver::{self, Prepared, PreparedMotion};
use slipstick::units::STANDARD_GRAVITY_M_PER_S2;
use std::hint::black_box;

fn single(c: &mut Criterion) {
    let taft = taft();
    let pendulum = model(0.06, 0.05, 526.0 * 9.81 / 2.0);
    let sliding = model(0.020, 0.012, 0.0);
    let sine = sine(0.005);
    let mut group = c.benchmark_group("single");
    for (name, model, motion) in [
        ("taft", &pendulum, &taft),
        ("low_friction", &sliding, &sine),
        ("low_friction_cut_in_two", &sliding, &cut_in_two(&sine)),
    ] {
        let events = solver::exact_demands(model, motion).unwrap().events.len();
        group.throughput(Throughput::Elements(motion.len() as u64));
        group.bench_function(format!("{name}/{events} events"), |b| {
            b.iter(|| solver::exact_demands(black_box(model), black_box(motion)));
        });
        let prepared_motion = PreparedMotion::new(motion.clone());
        let prepared = Prepared::new(model.clone(), prepared_motion.dt_s());
        group.bench_function(format!("{name}/prepared"), |b| {
            b.iter(|| black_box(&prepared).demands(black_box(&prepared_motion)));
        });
        group.bench_function(format!("{name}/with history"), |b| {
            b.iter(|| solver::exact(black_box(model), black_box(motion)));
        });
        let response = solver::exact(model, motion).unwrap();
        group.bench_function(format!("{name}/certificate"), |b| {
            b.iter(|| check(black_box(model), black_box(motion), black_box(&response)));
        });
    }
    // Two samples of a table at rest: nothing but the set-up.
    let still = GroundMotion::evenly_spaced(0.005, vec![0.0; 2], None).unwrap();
    group.throughput(Throughput::Elements(1));
    group.bench_function("set_up", |b| {
        b.iter(|| solver::exact_demands(black_box(&model(0.06, 0.05, 143e3)), &still));
    });
    group.bench_function("tables", |b| {
        b.iter(|| black_box(Prepared::new(black_box(&pendulum).clone(), Some(0.01))));
    });
    group.finish();
}

/// The Taft record at 0.3 g.
fn taft() -> GroundMotion {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/records/taft-111.txt");
    let text = std::fs::read_to_string(file).unwrap();
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    let values: Vec<f64> = lines.filter_map(|line| line.trim().parse().ok()).collect();
    let peak = values.iter().fold(0.0_f64, |peak, a| peak.max(a.abs()));
    let factor = 0.3 * STANDARD_GRAVITY_M_PER_S2 / peak;
    let scaled = values.iter().map(|a| factor * a).collect();
    GroundMotion::evenly_spaced(0.01, scaled, None).unwrap()
}

/// 40 s of 1.5 m/s² at 2.984 Hz: the paper's mock-up under it slips hundreds of times.
fn sine(dt_s: f64) -> GroundMotion {
    let sample = |i: u32| 1.5 * libm::sin(core::f64::consts::TAU * 2.984 * f64::from(i) * dt_s);
    let count = (40.0 / dt_s) as u32;
    GroundMotion::evenly_spaced(dt_s, (0..=count).map(sample).collect(), None).unwrap()
}

/// The same polyline with a sample in the middle of every interval.
fn cut_in_two(motion: &GroundMotion) -> GroundMotion {
    let a = motion.horizontal_m_per_s2();
    let mut values = vec![a[0]];
    values.extend(a.windows(2).flat_map(|pair| [0.5 * (pair[0] + pair[1]), pair[1]]));
    GroundMotion::evenly_spaced(0.5 * motion.dt_s().unwrap(), values, None).unwrap()
}

/// 201 kg at 2.687 Hz on 325 kg.
fn model(mu_static: f64, mu_kinetic: f64, stiffness_n_per_m: f64) -> Model {
    let rate = core::f64::consts::TAU * 2.687;
    Model::new(
        Block { mass_kg: 325.0, width_m: None, height_m: None },
        Slider::sprung(Friction::new(mu_static, mu_kinetic).unwrap(), stiffness_n_per_m),
        Frame {
            masses_kg: vec![201.0],
            stiffnesses_n_per_m: vec![201.0 * rate * rate],
            damping: Damping::Ratio(0.01),
            heights_m: None,
        },
        9.81,
        InitialState::rest(),
    )
    .unwrap()
}

criterion_group!(benches, single);
criterion_main!(benches);
