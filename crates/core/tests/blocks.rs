//! The block kernel against the plain path: random systems under long records, every demand and
//! every count.

// Helpers of tests may panic as tests do.
#![allow(clippy::expect_used)]

mod common;

use common::random::Random;
use common::sketch::Sketch;
use slipstick::response::Response;
use slipstick::solver;

/// Largest difference, over the peak of each quantity.
const TOLERANCE: f64 = 1e-11;
/// Relative change of the input that must move a well-conditioned result by less.
const PERTURBATION: f64 = 1e-12;

/// Systems that a run of the test draws.
const SYSTEMS: u64 = 3000;

/// A system of at most one storey, shaken by a record of a few hundred samples.
fn shaken(random: &mut Random) -> Sketch {
    let mut x = loop {
        let x = Sketch::system(random);
        if x.masses.len() <= 1 {
            break x;
        }
    };
    let count = random.integer(20, 600) as usize;
    let rate = x.stiffnesses.first().map_or(10.0, |k| (k / x.masses[0]).sqrt());
    let dt = random.logarithmic(0.003, 0.15) / rate;
    let amplitude = x.level() * random.logarithmic(0.5, 6.0);
    x.times = (0..=count).map(|i| i as f64 * dt).collect();
    x.horizontal = record(random, count, dt, amplitude);
    if random.chance(0.15) {
        x.stretch_times(random);
    }
    if random.chance(0.1) {
        let vertical = x.gravity * random.between(0.0, 0.7);
        x.lift(random, vertical);
    }
    for _ in 0..random.integer(0, 3) {
        if random.chance(0.3) {
            let to = amplitude * random.between(-1.0, 1.0);
            x.add_jump(random, to);
        }
    }
    if random.chance(0.3) {
        x.disturb(random, 0.02, 0.1);
    }
    x
}

/// Sines, noise and rests in any mixture.
fn record(random: &mut Random, count: usize, dt: f64, amplitude: f64) -> Vec<f64> {
    let noise = if random.chance(0.6) { random.logarithmic(1e-3, 1.0) } else { 0.0 };
    let colour = random.between(0.0, 0.98);
    let waves: Vec<[f64; 3]> = (0..random.integer(1, 3))
        .map(|_| {
            let samples = random.logarithmic(8.0, 400.0);
            [random.unit(), core::f64::consts::TAU / (samples * dt), random.between(0.0, 6.3)]
        })
        .collect();
    let quiet = if random.chance(0.3) { random.integer(0, count as i64) as usize } else { count };
    let mut drift = 0.0;
    (0..=count)
        .map(|i| {
            drift = colour * drift + noise * random.between(-1.0, 1.0);
            let t = i as f64 * dt;
            let sum: f64 = waves.iter().map(|w| w[0] * libm::sin(w[1] * t + w[2])).sum();
            if i > quiet && i < quiet + 60 { 0.0 } else { amplitude * (0.5 * sum + drift) }
        })
        .collect()
}

/// Every demand with the size it is measured by, and every count.
fn figures(r: &Response) -> (Vec<(&'static str, f64, f64)>, [u64; 3], bool) {
    let d = &r.demands;
    let s = d.peak_sliding_displacement_m;
    let mut list = vec![
        ("peak s", s, s),
        ("largest s", d.max_sliding_displacement_m, s),
        ("smallest s", d.min_sliding_displacement_m, s),
        ("residual s", d.residual_sliding_displacement_m, s),
        ("path", d.sliding_path_m, d.sliding_path_m.max(s)),
        ("sliding time", d.sliding_time_s, d.sliding_time_s),
        ("time of peak", d.peak_sliding_displacement_time_s, f64::INFINITY),
    ];
    let mut own = |name, x: f64| list.push((name, x, x));
    own("peak velocity", d.peak_sliding_velocity_m_per_s);
    own("block acceleration", d.peak_block_acceleration_m_per_s2);
    own("base shear", d.peak_base_shear_n);
    own("friction", d.peak_friction_force_n);
    own("slider force", d.peak_slider_force_n);
    own("overturning", d.overturning_ratio.unwrap_or(0.0));
    for storey in &d.storeys {
        own("floor acceleration", storey.peak_acceleration_m_per_s2);
        own("displacement", storey.peak_displacement_m);
        own("drift", storey.peak_drift_m);
    }
    (list, [d.slip_count, d.reversal_count, d.stick_count], d.sliding_at_end)
}

/// What differs between two responses, over the size of each.
fn difference(a: &Response, b: &Response) -> (f64, String, bool) {
    let ((x, counts, sliding), (y, other_counts, other_sliding)) = (figures(a), figures(b));
    let mut worst = (0.0, String::new());
    for (x, y) in x.iter().zip(&y) {
        let size = x.2.max(y.2).max(1e-300);
        let off = (x.1 - y.1).abs() / size;
        if !(off <= worst.0) {
            worst = (off, format!("{}: {:e} and {:e}", x.0, x.1, y.1));
        }
    }
    (worst.0, worst.1, counts == other_counts && sliding == other_sliding)
}

fn agree(seed: u64, systems: u64, draw: impl Fn(&mut Random) -> Sketch) {
    let (mut ill, mut events, mut worst) = (0, 0, 0.0_f64);
    let mut wrong = Vec::new();
    for system in 0..systems {
        let mut random = Random::new(seed + system);
        let sketch = draw(&mut random);
        let (model, motion) = sketch.build();
        let plain = solver::exact_demands_plain(&model, &motion).expect("a response");
        let blocks = solver::exact_demands(&model, &motion).expect("a response");
        events += plain.events.len();
        let (off, what, same) = difference(&plain, &blocks);
        if same && off <= TOLERANCE {
            worst = worst.max(off);
            continue;
        }
        let moved = sketch.perturbed(PERTURBATION).iter().fold((0.0_f64, true), |moved, other| {
            let (model, motion) = other.build();
            let other = solver::exact_demands_plain(&model, &motion).expect("a response");
            let (off, _, same) = difference(&plain, &other);
            (moved.0.max(off), moved.1 && same)
        });
        if (!same && !moved.1) || (same && moved.0 > TOLERANCE) {
            ill += 1;
        } else {
            let counts = [&plain, &blocks].map(|r| figures(r).1);
            wrong.push(format!("seed {}: {off:.1e} {what}, counts {counts:?}", seed + system));
        }
    }
    println!("{systems} systems, {events} events, {ill} ill-conditioned, worst {worst:.1e}");
    assert!(wrong.is_empty(), "{} differ:\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn peer_plain_path_on_random_systems() {
    agree(1, SYSTEMS, shaken);
}
