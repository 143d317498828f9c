//! The classes of traps: what each of them draws.

use slipstick::model::Damping;
use slipstick::response::EventKind;

use super::plain::{Reference, reference};
use super::random::Random;
use super::sketch::Sketch;
use super::system::System;

/// What a class draws.
pub type Draw = fn(&mut Random) -> Sketch;

/// The classes by name.
pub const CLASSES: [(&str, Draw); 13] = [
    ("grazing stops", grazing),
    ("two roots in a sample", two_roots),
    ("over twenty events in a sample", over_twenty_events),
    ("small excess of the demand", excess),
    ("events on samples", dyadic),
    ("zero-length sticks", zero_length_sticks),
    ("no friction", no_friction),
    ("huge steps", huge_steps),
    ("stiff spring", stiff_spring),
    ("equal friction releases", equal_friction),
    ("jumps", jumps),
    ("uplift", uplift),
    ("general", Sketch::shaken),
];

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

fn two_roots(random: &mut Random) -> Sketch {
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
}

fn over_twenty_events(random: &mut Random) -> Sketch {
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

fn zero_length_sticks(random: &mut Random) -> Sketch {
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
}

fn no_friction(random: &mut Random) -> Sketch {
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
}

/// Bound on the rate of the fastest motion.
pub fn rate(x: &Sketch) -> f64 {
    System::new(&x.model()).rate
}

fn huge_steps(random: &mut Random) -> Sketch {
    let mut x = Sketch::system(random);
    if x.masses.is_empty() && x.spring == 0.0 {
        x.set_spring(random.logarithmic(5.0, 50.0));
    }
    let level = x.level();
    x.shake(random, 2, 1.0, 4.0 * level);
    let dt = random.between(22.0, 60.0) / rate(&x);
    x.times = vec![0.0, dt, 2.0 * dt];
    x
}

fn stiff_spring(random: &mut Random) -> Sketch {
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
}

fn equal_friction(random: &mut Random) -> Sketch {
    let mut x = Sketch::shaken(random);
    x.static_friction = x.kinetic_friction;
    (x.horizontal[0], x.w) = (0.0, 0.0);
    x
}

fn jumps(random: &mut Random) -> Sketch {
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
}

fn uplift(random: &mut Random) -> Sketch {
    let mut x = Sketch::shaken(random);
    let vertical = x.gravity * random.between(1.2, 3.0);
    x.lift(random, vertical);
    x
}
