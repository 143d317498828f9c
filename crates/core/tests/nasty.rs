//! Random systems in which something goes wrong easily, compared with the plain reference.
//!
//! Each class of trap is drawn on purpose, and a test fails unless the trap really occurred, seen
//! on the reference's response, at least 500 times in systems whose answer is well determined.
//! `SLIPSTICK_SEED` sets another seed.

// The seed and what became of the systems, for people who look with --nocapture; a seed from
// outside to look for more.
#![allow(clippy::disallowed_macros, clippy::disallowed_methods)]

mod common;

use common::agree::{Verdict, compare};
use common::plain::{Reference, reference};
use common::random::Random;
use common::sketch::Sketch;
use slipstick::model::Damping;
use slipstick::response::EventKind;
use slipstick::solver::exact;

/// Systems drawn for each of the thirteen classes: 10 400 in all.
const DRAWN: u64 = 800;
/// Occurrences that a class must reach among the compared.
const NEEDED: u32 = 500;

/// Draws, solves and compares systems of a class; `occurs` sees the trap on the reference.
fn run(
    class: &str,
    draw: impl Fn(&mut Random) -> Sketch,
    occurs: impl Fn(&Sketch, &Reference) -> bool,
) {
    let given = std::env::var("SLIPSTICK_SEED").ok().and_then(|text| text.parse().ok());
    let seed: u64 = given.unwrap_or(1952);
    println!("{class}: seed {seed}");
    let (mut occurred, mut compared, mut ill, mut worst) = (0, 0, 0, 0.0_f64);
    let mut failures = Vec::new();
    for index in 0..DRAWN {
        let sketch = draw(&mut Random::new(seed.wrapping_mul(1_000_003).wrapping_add(index)));
        let (model, motion) = sketch.build();
        let expected = reference(&model, &motion);
        let verdict = match exact(&model, &motion) {
            Ok(response) => compare(&sketch, &expected, &response),
            Err(error) => Verdict::Differs(error.to_string()),
        };
        match verdict {
            Verdict::IllConditioned => ill += 1,
            Verdict::Agrees(error) => {
                compared += 1;
                occurred += u32::from(occurs(&sketch, &expected));
                worst = worst.max(error);
            }
            Verdict::Differs(what) => failures.push(format!("system {index}: {what}\n{sketch:?}")),
        }
    }
    println!(
        "{class}: {DRAWN} drawn, {compared} agree (largest difference {worst:.1e} of a peak), \
         {ill} ill-conditioned, the trap in {occurred}"
    );
    let shown = &failures[..failures.len().min(3)];
    assert!(
        failures.is_empty(),
        "{class}, seed {seed}: {} differ:\n{}",
        failures.len(),
        shown.join("\n")
    );
    assert!(occurred >= NEEDED, "{class}, seed {seed}: occurred only {occurred} times");
}

/// Largest number of events strictly inside one sample interval.
fn busiest(sketch: &Sketch, r: &Reference) -> usize {
    let inside =
        |pair: &[f64]| r.events.iter().filter(|e| pair[0] < e.time_s && e.time_s < pair[1]).count();
    sketch.times.windows(2).map(inside).max().unwrap_or(0)
}

/// Changes the initial sliding velocity until `measure` of the response is `target`, by secants.
fn tune(sketch: &mut Sketch, target: f64, measure: impl Fn(&Reference) -> Option<f64>) {
    let at = |sketch: &Sketch| {
        let (model, motion) = sketch.build();
        measure(&reference(&model, &motion))
    };
    let mut last: Option<(f64, f64)> = None;
    for _ in 0..12 {
        let Some(found) = at(sketch) else { return };
        let error = found - target;
        let slope = match last {
            Some((w, old)) if w != sketch.w && old != error => (error - old) / (sketch.w - w),
            Some(_) => return,
            None => 1.0,
        };
        last = Some((sketch.w, error));
        let limit = 0.3 * sketch.w.abs();
        sketch.w -= (error / slope).clamp(-limit, limit);
    }
}

/// A block sliding towards +x that is braked, then pushed on, so that its velocity dips to a part
/// 1e-10 to 1e-4 of its peak above or below zero.
fn grazing(random: &mut Random) -> Sketch {
    let mut x = Sketch::system(random);
    let level = x.level();
    let dt = random.logarithmic(0.02, 0.2);
    x.times = (0..=4).map(|i| f64::from(i) * dt).collect();
    let brake = level * random.between(0.5, 3.0);
    let push = -level * random.between(2.0, 5.0);
    let after = level * random.between(-1.0, 1.0);
    x.horizontal = vec![brake, brake * random.between(0.5, 1.5), push, 0.3 * push, after];
    x.w = (brake + level) * dt * random.between(1.2, 1.8);
    if random.chance(0.3) {
        // The worst for a bound made of both ends of a sample: a parabola with its dip midway.
        let friction = random.between(0.02, 0.2);
        let (gravity, dt) = (x.gravity, dt);
        x = Sketch { gravity, ..Sketch::block(friction, friction) };
        let level = friction * gravity;
        let turn = level * random.between(1.2, 4.0);
        x.times = (0..=4).map(|i| f64::from(i) * dt).collect();
        x.horizontal = vec![brake, turn - level, -turn - level, -turn, 0.0];
        x.w = (0.5 * (brake + turn + level) + 0.25 * turn) * dt;
    }
    let target = random.sign() * random.logarithmic(1e-10, 1e-4);
    // Over the initial velocity, which is the peak.
    tune(&mut x, target, |r| {
        let stop = r.events.first().filter(|e| e.kind != EventKind::Slip);
        let dip = r.dips.first().filter(|d| stop.is_none_or(|e| d.time_s < e.time_s));
        dip.map(|d| d.depth).or(stop.map(|e| -e.dip))
    });
    x
}

#[test]
fn reference_nasty_grazing_stops() {
    run("grazing stops", grazing, |_, r| {
        r.dips.iter().any(|d| d.depth < 1e-3)
            || r.events.iter().any(|e| e.dip != 0.0 && e.dip < 1e-3)
    });
}

#[test]
fn reference_nasty_two_roots_in_a_sample() {
    let draw = |random: &mut Random| {
        let mut x = Sketch::system(random);
        let rate = random.logarithmic(4.0, 12.0);
        if x.masses.is_empty() {
            x.set_spring(rate);
            x.damper *= 0.1;
        }
        let dt = random.between(4.0, 12.0) / rate;
        let level = x.level();
        x.shake(random, 3, dt, 2.5 * level);
        x.disturb(random, 6.0 * level / (rate * rate), 6.0 * level / rate);
        x
    };
    run("two roots in a sample", draw, |x, r| busiest(x, r) >= 2);
}

#[test]
fn reference_nasty_over_twenty_events_in_a_sample() {
    let draw = |random: &mut Random| {
        let mut x = Sketch::system(random);
        while x.masses.len() > 1 {
            x = Sketch::system(random);
        }
        (x.damper, x.tilt) = (0.0, 0.0);
        let rate = random.logarithmic(5.0, 50.0);
        x.set_spring(rate);
        // A storey so stiff that the block swings on its spring as if alone.
        for k in &mut x.stiffnesses {
            *k = x.masses[0] * (4.0 * rate) * (4.0 * rate);
        }
        let half_cycles = random.between(23.0, 32.0);
        // Each half cycle takes twice this off the displacement.
        let lost = x.level() / (rate * rate);
        x.s = random.sign() * lost * (2.0 * half_cycles + random.between(2.0, 9.0));
        let dt = half_cycles * std::f64::consts::PI / rate;
        let level = x.level();
        let count = random.integer(1, 2) as usize;
        x.shake(random, count, dt / count.min(1) as f64, 0.3 * level);
        x
    };
    run("over twenty events in a sample", draw, |x, r| busiest(x, r) > 20);
}

/// A long quiet shaking over which the demand exceeds its bound once, between two samples, by a part
/// 1e-8 to 1e-2 of it: the bound is made from the largest demand.
fn excess(random: &mut Random) -> Sketch {
    let mut x = Sketch::system(random);
    while x.masses.is_empty() {
        x = Sketch::system(random);
    }
    // With equal friction the slip is as small as the excess, and only its events can be compared.
    let kinetic = if random.chance(0.1) { 1.0 } else { random.between(0.5, 0.95) };
    x.tilt = 0.0;
    let count = random.integer(20, 60) as usize;
    let dt = random.logarithmic(0.05, 1.0) / rate(&x);
    x.shake(random, count, dt, 1.0);
    if random.chance(0.3) {
        // The worst for a bound made of both ends of a sample: free vibration with its peak midway.
        x.masses.truncate(1);
        x.damping = Damping::Ratio(0.0);
        x.horizontal.iter_mut().for_each(|a| *a *= 1e-9);
        x.stiffnesses.truncate(1);
        let rate = (x.stiffnesses[0] / x.masses[0]).sqrt();
        let phase = rate * dt * (random.integer(0, 9) as f64 + 0.5);
        x.q = Some(vec![0.01 * libm::cos(phase)]);
        x.v = vec![0.01 * rate * libm::sin(phase)];
    }
    (x.static_friction, x.kinetic_friction) = ([1e3; 2], [1e3; 2]);
    let (model, motion) = x.build();
    let largest = reference(&model, &motion).peaks.friction / model.weight_n();
    let bound = largest * (1.0 - random.logarithmic(1e-8, 1e-2));
    (x.static_friction, x.kinetic_friction) = ([bound; 2], [kinetic * bound; 2]);
    x
}

#[test]
fn reference_nasty_small_excess_of_the_demand() {
    run("small excess of the demand", excess, |x, r| {
        let first = r.events.first().map_or(0.0, |e| e.time_s);
        first > 0.0 && !x.times.contains(&first)
    });
}

/// Numbers with few binary digits, so that a stop and a release fall on samples exactly.
fn dyadic(random: &mut Random) -> Sketch {
    let eighths = |r: &mut Random, low: i64, high: i64| r.integer(low, high) as f64 / 8.0;
    let kinetic = eighths(random, 1, 2);
    let static_ = kinetic + if random.chance(0.5) { 0.0 } else { 0.125 };
    let mut x = Sketch::block(static_, kinetic);
    let (fs, fk) = (8.0 * static_, 8.0 * kinetic);
    let dt = [0.125, 0.25, 0.5, 1.0][random.integer(0, 3) as usize];
    let side = random.sign();
    // Braked over two intervals to a stop at the third sample, held, then pushed over the limit.
    let first = eighths(random, 0, 16);
    let second = eighths(random, 0, 16);
    let stop = eighths(random, -7, 7) * fk.min(1.0);
    x.w = dt * ((first + second) / 2.0 + (second + stop) / 2.0 + 2.0 * fk);
    let step = eighths(random, 1, 8);
    let push = random.sign();
    let beyond = (1..=3).map(|k| push * (fs + step * f64::from(k)));
    x.horizontal = vec![first, second, stop, push * (fs - step), push * fs];
    x.horizontal.extend(beyond);
    x.horizontal.push(0.0);
    x.times = (0..x.horizontal.len()).map(|i| i as f64 * dt).collect();
    if random.chance(0.3) {
        // The stop falls on a jump: the limit from the right decides.
        let jump = eighths(random, -40, 40);
        x.times.insert(3, x.times[2]);
        x.horizontal.insert(3, jump);
    }
    x.w *= side;
    for a in &mut x.horizontal {
        *a *= side;
    }
    x
}

#[test]
fn reference_nasty_events_on_samples() {
    run("events on samples", dyadic, |x, r| {
        let on = |t: f64| x.times.contains(&t) && t > 0.0;
        r.events.iter().filter(|e| on(e.time_s)).count() >= 2
    });
}

#[test]
fn reference_nasty_zero_length_sticks() {
    let draw = |random: &mut Random| {
        if random.chance(0.3) {
            // A stop on a sample where the demand is at its opposite bound and grows: no stick.
            let mu = random.integer(1, 4) as f64 / 8.0;
            let mut x = Sketch::block(mu, mu);
            let (limit, dt) = (8.0 * mu, 0.5);
            let first = random.integer(0, 8) as f64 / 8.0 * limit;
            let end = limit + random.integer(1, 16) as f64 / 8.0;
            x.times = vec![0.0, dt, 2.0 * dt, 3.0 * dt];
            x.horizontal = vec![first, limit, end, 0.0];
            x.w = dt * ((first + limit) / 2.0 + limit);
            return x;
        }
        let mut x = Sketch::system(random);
        x.tilt = 0.0;
        let level = x.level();
        let dt = random.logarithmic(0.02, 0.2);
        x.times = (0..=3).map(|i| f64::from(i) * dt).collect();
        let start = level * random.between(0.0, 0.6);
        let rise = level * random.between(0.8, 2.0);
        x.horizontal = vec![start, start + rise, start + 2.0 * rise, 0.0];
        x.w = level * dt * random.between(0.8, 1.6);
        // Sticks for a moment where positive, turns round where negative.
        let target = random.sign() * random.logarithmic(1e-10, 1e-4);
        tune(&mut x, target, |r| {
            r.events.first().filter(|e| e.kind != EventKind::Slip).map(|e| e.margin)
        });
        x
    };
    run("zero-length sticks", draw, |x, r| {
        let end_s = x.times[x.times.len() - 1];
        let close = r
            .events
            .windows(2)
            .any(|p| p[0].kind == EventKind::Stick && p[1].time_s - p[0].time_s < 1e-3 * end_s);
        let stops = || r.events.iter().filter(|e| e.kind != EventKind::Slip);
        close || stops().any(|e| e.margin.abs() < 1e-3)
    });
}

#[test]
fn reference_nasty_no_friction() {
    let draw = |random: &mut Random| {
        let mut x = Sketch::system(random);
        x.kinetic_friction = [0.0; 2];
        if random.chance(0.6) {
            x.static_friction = [0.0; 2];
        }
        let dt = random.logarithmic(0.02, 0.3);
        x.shake(random, 6, dt, 1.0);
        if random.chance(0.5) {
            x.disturb(random, 0.05, 0.2);
        }
        x
    };
    run("no friction", draw, |x, r| x.kinetic_friction == [0.0; 2] && !r.events.is_empty());
}

/// Bound on the rate of the fastest motion.
fn rate(x: &Sketch) -> f64 {
    common::system::System::new(&x.model()).rate
}

#[test]
fn reference_nasty_huge_steps() {
    let draw = |random: &mut Random| {
        let mut x = Sketch::system(random);
        if x.masses.is_empty() && x.spring == 0.0 {
            x.set_spring(random.logarithmic(5.0, 50.0));
        }
        let level = x.level();
        x.shake(random, 2, 1.0, 4.0 * level);
        let dt = random.between(22.0, 60.0) / rate(&x);
        x.times = vec![0.0, dt, 2.0 * dt];
        x
    };
    run("huge steps", draw, |x, r| rate(x) * x.times[1] > 20.0 && !r.events.is_empty());
}

#[test]
fn reference_nasty_stiff_spring() {
    let draw = |random: &mut Random| {
        let mut x = Sketch::system(random);
        while x.masses.len() > 1 {
            x = Sketch::system(random);
        }
        let rate = random.logarithmic(300.0, 3000.0);
        x.set_spring(rate);
        if x.damper > 0.0 {
            x.damper = 2.0 * random.between(0.01, 0.3) * rate * x.total();
        }
        let dt = random.between(51.0, 70.0) / rate;
        let level = x.level();
        x.shake(random, 2, dt, 6.0 * level);
        if random.chance(0.3) {
            x.w = level / rate * random.between(-5.0, 5.0);
        }
        x
    };
    run("stiff spring", draw, |x, r| {
        let rate = (x.spring / x.block).sqrt();
        rate * x.times[1] > 50.0 && !r.events.is_empty()
    });
}

#[test]
fn reference_nasty_equal_friction_releases() {
    let draw = |random: &mut Random| {
        let mut x = Sketch::shaken(random);
        x.static_friction = x.kinetic_friction;
        (x.horizontal[0], x.w) = (0.0, 0.0);
        x
    };
    run("equal friction releases", draw, |x, r| {
        let inside = |t: f64| t > 0.0 && !x.times.contains(&t);
        r.events.iter().any(|e| e.kind == EventKind::Slip && inside(e.time_s))
    });
}

#[test]
fn reference_nasty_jumps() {
    let draw = |random: &mut Random| {
        let mut x = Sketch::shaken(random);
        let level = x.level();
        // Held until the first jump, so that it is the jump that releases or turns it.
        let still = x.horizontal.len() / 2;
        for a in &mut x.horizontal[..=still] {
            *a *= 0.05;
        }
        for _ in 0..4 {
            let to = level * random.between(2.0, 6.0) * random.sign();
            x.add_jump(random, to);
        }
        x
    };
    run("jumps", draw, |x, r| {
        let jump = |t: f64| x.times.windows(2).any(|p| p[0] == p[1] && p[0] == t);
        r.events.iter().any(|e| jump(e.time_s))
    });
}

#[test]
fn reference_nasty_uplift() {
    let draw = |random: &mut Random| {
        let mut x = Sketch::shaken(random);
        let vertical = x.gravity * random.between(1.2, 3.0);
        x.lift(random, vertical);
        x
    };
    run("uplift", draw, |_, r| !r.contact_loss_s.is_empty() && !r.events.is_empty());
}

#[test]
fn reference_nasty_general() {
    run("general", Sketch::shaken, |_, r| !r.events.is_empty());
}
