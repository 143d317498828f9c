//! Screened propagation against event stepping, and running ahead against the way that serves all models:
//! random systems under long records, every demand, every count, every number of a history.
//!
//! The long run, 10 000 systems of each kind: `cargo test --release -p slipstick --test library screening:: -- --ignored`.

// Helpers of tests may panic as tests do.
#![allow(clippy::disallowed_macros, clippy::expect_used)]

use crate::common::random::Random;
use crate::common::sketch::Sketch;
use slipstick::model::{Damping, Model};
use slipstick::motion::GroundMotion;
use slipstick::response::{History, Response};
use slipstick::solver::{self, InstructionSet, Prepared, PreparedMotion};

/// Largest difference, over the peak of each quantity.
const TOLERANCE: f64 = 1e-11;
/// Relative change of the input that must move a well-conditioned result by less.
const PERTURBATION: f64 = 1e-12;

/// The same of frames, the bar for motions that are cut: their fastest modes turn up to 1e5 rad, and
/// cutting the samples rounds the times.
const TOLERANCE_OF_FRAMES: f64 = 1e-9;

/// Systems that a run of the test draws.
const SYSTEMS: u64 = 3000;

/// Systems of each kind that run ahead in a usual run of the tests, and in a long one.
const AHEAD: [u64; 2] = [300, 10_000];

/// A system of at most one storey, shaken by a record of a few hundred samples.
fn shaken(random: &mut Random) -> Sketch {
    loop {
        let x = Sketch::system(random);
        if x.masses.len() <= 1 {
            return under_record(random, x, [20, 600], [0.003, 0.15]);
        }
    }
}

/// A frame of two storeys or more, shaken so.
fn shaken_frame(random: &mut Random) -> Sketch {
    loop {
        let x = Sketch::system(random);
        if x.masses.len() > 1 {
            return under_record(random, x, [20, 600], [0.003, 0.15]);
        }
    }
}

/// A frame of four to twenty storeys that are nearly alike, shaken so.
fn shaken_tall_frame(random: &mut Random) -> Sketch {
    let n = random.integer(4, 20) as usize;
    let mut x = Sketch::frame(random, n);
    let (mass, rate) = (x.masses[0], random.logarithmic(10.0, 100.0));
    for (m, k) in x.masses.iter_mut().zip(&mut x.stiffnesses) {
        *m = mass * random.between(0.7, 1.3);
        *k = mass * rate * rate * random.between(0.7, 1.3);
    }
    if let Damping::Dampers(dampers) = &mut x.damping {
        let time_s = random.logarithmic(1e-3, 1.0) / rate;
        *dampers = x.stiffnesses.iter().map(|k| k * time_s).collect();
    }
    // Long enough for what shakes the block to reach the top.
    under_record(random, x, [200, 600], [0.2, 0.8])
}

/// Shakes a system by a record of so many samples, whose step is so long beside the first storey.
fn under_record(random: &mut Random, mut x: Sketch, samples: [i64; 2], steps: [f64; 2]) -> Sketch {
    let count = random.integer(samples[0], samples[1]) as usize;
    let rate = x.stiffnesses.first().map_or(10.0, |k| (k / x.masses[0]).sqrt());
    let dt = random.logarithmic(steps[0], steps[1]) / rate;
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

/// A demand and the size it is measured by.
type Figure = (&'static str, f64, f64);

/// Every demand with the size it is measured by, and every count.
fn figures(r: &Response) -> (Vec<Figure>, [u64; 3], bool) {
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
        own("drift velocity", storey.peak_drift_velocity_m_per_s);
    }
    (list, [d.slip_count, d.reversal_count, d.stick_count], d.sliding_at_end)
}

/// Largest difference of two histories of one motion over the peak of each of their numbers, and whether
/// both have the same knots in the same modes.
fn difference_of_histories(a: &Response, b: &Response) -> (f64, String, bool) {
    let mut worst = (0.0, String::new());
    // Between the knots of a short slip the velocity is larger than at any.
    let velocity = a.demands.peak_sliding_velocity_m_per_s;
    let (Some(a), Some(b)) = (&a.history, &b.history) else { return (0.0, String::new(), true) };
    if a.mode != b.mode || a.rows != b.rows {
        return (1.0, "knots".to_owned(), false);
    }
    let columns = |h: &History| {
        [
            ("time", h.time_s.clone()),
            ("table", h.table_acceleration_m_per_s2.clone()),
            ("s", h.sliding_displacement_m.clone()),
            ("sliding velocity", h.sliding_velocity_m_per_s.clone()),
            ("block", h.block_acceleration_m_per_s2.clone()),
            ("friction", h.friction_force_n.clone()),
            ("displacement", h.storey_displacement_m.clone()),
            ("velocity", h.storey_velocity_m_per_s.clone()),
            ("floor", h.storey_acceleration_m_per_s2.clone()),
        ]
    };
    for ((name, a), (_, b)) in columns(a).iter().zip(&columns(b)) {
        let least = if *name == "sliding velocity" { velocity } else { 0.0 };
        let peak = a.iter().fold(least.max(1e-300), |peak, x| peak.max(x.abs()));
        for (knot, (a, b)) in a.iter().zip(b).enumerate() {
            let off = (a - b).abs() / peak;
            if !(off <= worst.0) {
                worst = (off, format!("{name} at knot {knot}: {a:e} and {b:e}"));
            }
        }
    }
    (worst.0, worst.1, true)
}

/// What differs between two responses, over the size of each; accelerations of floors over `least` at
/// least.
fn difference(a: &Response, b: &Response, least: f64) -> (f64, String, bool) {
    let ((x, counts, sliding), (y, other_counts, other_sliding)) = (figures(a), figures(b));
    let mut worst = (0.0, String::new());
    for (x, y) in x.iter().zip(&y) {
        let least = if x.0 == "floor acceleration" { least } else { 0.0 };
        let size = x.2.max(y.2).max(least).max(1e-300);
        let off = (x.1 - y.1).abs() / size;
        if !(off <= worst.0) {
            worst = (off, format!("{}: {:e} and {:e}", x.0, x.1, y.1));
        }
    }
    let (off, what, same) = difference_of_histories(a, b);
    if off > worst.0 {
        worst = (off, what);
    }
    (worst.0, worst.1, same && counts == other_counts && sliding == other_sliding)
}

/// Demands by event stepping alone: every interval of the motion is cut in three uneven parts, which
/// changes no straight line and leaves no even step to screen.
fn stepped(model: &Model, motion: &GroundMotion) -> Response {
    let times_s = motion.times_s();
    let cut = |x: &[f64]| -> Vec<f64> {
        let mut cut = Vec::new();
        for (i, pair) in x.windows(2).enumerate() {
            let [a, b] = [pair[0], pair[1]];
            cut.push(a);
            // A jump stays one.
            if times_s[i + 1] > times_s[i] {
                let parts = if i % 2 == 0 { [0.3, 0.55] } else { [0.2, 0.75] };
                cut.extend(parts.map(|part| a + (b - a) * part));
            }
        }
        cut.push(x[x.len() - 1]);
        cut
    };
    let vertical = motion.vertical_m_per_s2().map(cut);
    let motion = GroundMotion::new(cut(times_s), cut(motion.horizontal_m_per_s2()), vertical);
    solver::exact_demands(model, &motion.expect("a motion")).expect("a response")
}

/// With its history by the way that serves all models.
fn general(model: &Model, motion: &GroundMotion) -> Response {
    let motion = PreparedMotion::new(motion.clone());
    let prepared = Prepared::new(model.clone(), motion.dt_s()).without_running_ahead();
    prepared.response(&motion).expect("a response")
}

/// Responses of random systems by event stepping alone and as usual.
fn agree(seed: u64, systems: u64, tolerance: f64, draw: impl Fn(&mut Random) -> Sketch) {
    let usual = |model: &Model, motion: &GroundMotion| {
        solver::exact_demands(model, motion).expect("a response")
    };
    agree_by((seed, systems, tolerance), draw, stepped, usual);
}

/// Responses of random systems by the general way alone and as usual, with their histories.
fn agree_ahead(seed: u64, systems: u64, draw: impl Fn(&mut Random) -> Sketch) {
    let usual =
        |model: &Model, motion: &GroundMotion| solver::exact(model, motion).expect("a response");
    agree_by((seed, systems, TOLERANCE), draw, general, usual);
}

/// Responses of random systems by two ways; where they differ, the last digits of the input must decide.
fn agree_by(
    (seed, systems, tolerance): (u64, u64, f64),
    draw: impl Fn(&mut Random) -> Sketch,
    stepped: impl Fn(&Model, &GroundMotion) -> Response,
    usual: impl Fn(&Model, &GroundMotion) -> Response,
) {
    let (mut ill, mut events, mut worst) = (0, 0, 0.0_f64);
    let mut wrong = Vec::new();
    for system in 0..systems {
        let mut random = Random::new(seed + system);
        let sketch = draw(&mut random);
        let (model, motion) = sketch.build();
        // A floor that feels a millionth of what shakes its frame is known to so many digits less.
        let pga = motion.horizontal_m_per_s2().iter().fold(0.0_f64, |pga, a| pga.max(a.abs()));
        let least = if model.storeys() > 1 { 1e-6 * pga } else { 0.0 };
        let stepped_alone = stepped(&model, &motion);
        let screened = usual(&model, &motion);
        events += stepped_alone.events.len();
        let (off, what, same) = difference(&stepped_alone, &screened, least);
        if same && off <= tolerance {
            worst = worst.max(off);
            continue;
        }
        // Either way: a demand that just stays at its bound decides as one that just passes it.
        let others = [PERTURBATION, -PERTURBATION].map(|part| sketch.perturbed(part));
        let moved = others.iter().flatten().fold((0.0_f64, true), |moved, other| {
            let (model, motion) = other.build();
            let other = stepped(&model, &motion);
            let (off, _, same) = difference(&stepped_alone, &other, least);
            (moved.0.max(off), moved.1 && same)
        });
        if (!same && !moved.1) || (same && moved.0 > tolerance) {
            ill += 1;
        } else {
            let counts = [&stepped_alone, &screened].map(|r| figures(r).1);
            wrong.push(format!("seed {}: {off:.1e} {what}, counts {counts:?}", seed + system));
        }
    }
    println!("{systems} systems, {events} events, {ill} ill-conditioned, worst {worst:.1e}");
    assert!(wrong.is_empty(), "{} differ:\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn peer_event_stepping_on_random_systems() {
    agree(1, SYSTEMS, TOLERANCE, shaken);
}

#[test]
fn peer_event_stepping_on_random_frames() {
    agree(300_000, 500, TOLERANCE_OF_FRAMES, shaken_frame);
}

#[test]
fn peer_event_stepping_on_random_tall_frames() {
    agree(400_000, 150, TOLERANCE_OF_FRAMES, shaken_tall_frame);
}

/// A system of one storey or none of every kind that runs ahead: the usual ones, with equal friction, under
/// coarse samples, with dampers of all sizes, with an overturning moment, sliding from the start downhill.
fn runs_ahead(random: &mut Random) -> Sketch {
    let mut x = shaken(random);
    x.vertical = None;
    match random.integer(0, 6) {
        0 => x.static_friction = x.kinetic_friction,
        1 => x.times.iter_mut().for_each(|t| *t *= 3.0),
        2 | 3 => {
            x.set_spring(random.logarithmic(1.0, 30.0));
            x.damper = x.total() * random.logarithmic(0.1, 50.0);
        }
        4 => {
            // In motion from the start: a storey that hardly moves about where the slope bends it to is known to
            // that many digits less.
            x.tilt = random.between(-0.1, 0.1);
            x.disturb(random, 0.05, 0.2);
        }
        5 => x.disturb(random, 0.2, 1.0),
        _ => {}
    }
    x.overturns = random.chance(0.5);
    x
}

/// Few samples and much in them: grazing stops, events near samples, motions that end in a jump or a step.
fn nasty_ahead(random: &mut Random) -> Sketch {
    let mut x = loop {
        let x = Sketch::system(random);
        if x.masses.len() <= 1 {
            break x;
        }
    };
    let (level, count) = (x.level(), random.integer(4, 24) as usize);
    let dt = random.logarithmic(0.002, 0.1);
    let amplitude = level * random.logarithmic(1.0, 8.0);
    x.shake(random, count, dt, amplitude);
    if random.chance(0.5) {
        // Levels that return: demands that reach a bound just so, stops at samples.
        let unit = level * [1.0, 0.5, 0.25][random.integer(0, 2) as usize];
        x.horizontal.iter_mut().for_each(|a| *a = unit * (*a / unit).round());
    }
    if random.chance(0.3) {
        let to = level * random.between(-2.0, 2.0);
        x.add_jump(random, to);
    }
    if random.chance(0.5) {
        x.disturb(random, 0.01, 0.05);
    }
    x.overturns = random.chance(0.3);
    x
}

#[test]
fn peer_general_way_on_random_systems() {
    agree_ahead(500_000, AHEAD[0], runs_ahead);
    agree_ahead(600_000, AHEAD[0], nasty_ahead);
}

#[test]
#[ignore = "minutes: cargo xtask nightly"]
fn peer_general_way_on_many_random_systems() {
    agree_ahead(700_000, AHEAD[1], runs_ahead);
    agree_ahead(800_000, AHEAD[1], nasty_ahead);
}

/// The bits of all that a response says but its history.
fn bits(r: &Response) -> (Vec<u64>, [u64; 3], Vec<[u64; 2]>) {
    let (list, counts, _) = figures(r);
    let events = r.events.iter();
    let events = events.map(|e| [e.time_s.to_bits(), e.sliding_displacement_m.to_bits()]);
    (list.iter().map(|x| x.1.to_bits()).collect(), counts, events.collect())
}

/// The bits of a history.
fn bits_of_history(r: &Response) -> Vec<Vec<u64>> {
    let h = r.history.as_ref().expect("a history");
    let columns = [
        &h.time_s,
        &h.sliding_displacement_m,
        &h.sliding_velocity_m_per_s,
        &h.block_acceleration_m_per_s2,
        &h.friction_force_n,
        &h.storey_displacement_m,
        &h.storey_velocity_m_per_s,
        &h.storey_acceleration_m_per_s2,
    ];
    columns.map(|x| x.iter().map(|x| x.to_bits()).collect()).to_vec()
}

#[test]
fn bits_are_the_same_by_every_instruction_set() {
    let all = InstructionSet::all();
    assert!(!all.is_empty());
    let draw = |seed: u64| match seed {
        0..400 => shaken(&mut Random::new(seed)),
        400..500 => shaken_frame(&mut Random::new(seed)),
        _ => shaken_tall_frame(&mut Random::new(seed)),
    };
    for seed in 0..600 {
        let (model, motion) = draw(seed).build();
        let motion = PreparedMotion::new(motion);
        let model = Prepared::new(model, motion.dt_s());
        let by = |set: InstructionSet| {
            let response = model.response_by(set, &motion).expect("a response");
            (bits(&response), bits_of_history(&response))
        };
        let first = by(all[0]);
        for set in &all[1..] {
            assert_eq!(by(*set), first, "seed {seed}: {set:?} and {:?}", all[0]);
        }
    }
}

#[test]
fn history_changes_no_bit() {
    for seed in 0..400 {
        let (model, motion) = shaken(&mut Random::new(seed)).build();
        let with = solver::exact(&model, &motion).expect("a response");
        let without = solver::exact_demands(&model, &motion).expect("a response");
        assert_eq!(bits(&with), bits(&without), "seed {seed}");
    }
}

#[test]
fn sharing_and_foreign_steps_change_no_bit() {
    for seed in 0..200 {
        let (model, motion) = shaken(&mut Random::new(seed)).build();
        let fresh = bits(&solver::exact_demands(&model, &motion).expect("a response"));
        let prepared = PreparedMotion::new(motion);
        let rougher = model.with_friction_times(1.7).expect("friction");
        let shared = Prepared::new(rougher, prepared.dt_s()).with_model(model.clone());
        assert_eq!(bits(&shared.demands(&prepared).expect("a response")), fresh);
        // Prepared for another step.
        let foreign = Prepared::new(model, Some(0.0123));
        assert_eq!(bits(&foreign.demands(&prepared).expect("a response")), fresh);
    }
}

/// Everything turned round gives the same numbers, the never-slid residual of −0 included.
#[test]
fn mirrored_systems_give_mirrored_numbers() {
    for seed in 0..1000 {
        let sketch = shaken(&mut Random::new(seed));
        let mut other = sketch.clone();
        let turn = |list: &mut Vec<f64>| list.iter_mut().for_each(|x| *x = -*x);
        turn(&mut other.horizontal);
        turn(&mut other.v);
        other.q.as_mut().map(turn);
        (other.s, other.w, other.tilt) = (-sketch.s, -sketch.w, -sketch.tilt);
        other.static_friction.reverse();
        other.kinetic_friction.reverse();
        let of = |sketch: &Sketch| {
            let (model, motion) = sketch.build();
            solver::exact(&model, &motion).expect("a response")
        };
        let (a, b) = (of(&sketch), of(&other));
        let histories = [&a, &b].map(|r| r.history.as_ref().expect("a history"));
        let columns =
            histories.map(|h| [&h.sliding_displacement_m, &h.storey_acceleration_m_per_s2]);
        for (a, b) in columns[0].iter().zip(columns[1]) {
            assert!(a.len() == b.len() && a.iter().zip(b).all(|(a, b)| *a == -b), "seed {seed}");
        }
        let ((x, counts, sliding), (y, other_counts, other_sliding)) = (figures(&a), figures(&b));
        assert_eq!((counts, sliding), (other_counts, other_sliding), "seed {seed}");
        for (x, y) in x.iter().zip(&y) {
            let expected = match x.0 {
                "largest s" => -b.demands.min_sliding_displacement_m,
                "smallest s" => -b.demands.max_sliding_displacement_m,
                "residual s" => -y.1,
                _ => y.1,
            };
            assert!(x.1 == expected, "seed {seed}: {} is {:e}, mirrored {expected:e}", x.0, x.1);
        }
        assert!(a.events.iter().zip(&b.events).all(|(a, b)| a.time_s == b.time_s), "seed {seed}");
    }
}

/// An undamped storey swings on a stuck block: `q = v₀/ω sin ωt`, whatever sample of a block the
/// peak follows, the first of all included.
#[test]
fn peak_after_any_sample_of_a_block() {
    for k in 0..40 {
        let mut x = Sketch::block(0.5, 0.5);
        x.masses = vec![32.0];
        let rate = 8.0;
        x.stiffnesses = vec![32.0 * rate * rate];
        let dt = 0.02;
        // The peak lies between samples k and k + 1, nearer to the former.
        let phase = core::f64::consts::FRAC_PI_2 - rate * dt * (k as f64 + 0.3);
        x.q = Some(vec![0.01 * libm::sin(phase)]);
        x.v = vec![0.01 * rate * libm::cos(phase)];
        x.times = (0..60).map(|i| f64::from(i) * dt).collect();
        x.horizontal = vec![0.0; 60];
        let (model, motion) = x.build();
        let d = solver::exact_demands(&model, &motion).expect("a response").demands;
        let found = d.storeys[0].peak_displacement_m;
        assert!((found - 0.01).abs() < 1e-14, "peak after sample {k}: {found:e}");
        let shear = 0.01 * 32.0 * rate * rate;
        assert!((d.peak_base_shear_n - shear).abs() < 1e-12 * shear, "peak after sample {k}");
    }
}

/// A rigid block on a spring slides from `w₀` to its stop at `s`, `½ w₀² = ½ k s² + f s`; its
/// acceleration, which is `f` alone without a spring, is largest there: `k s + f`.
#[test]
fn acceleration_of_a_rigid_block_on_a_spring() {
    let mut x = Sketch::block(0.05, 0.05);
    (x.w, x.spring) = (0.5, 128.0 * 9.0);
    x.times = (0..200).map(|i| f64::from(i) * 0.01).collect();
    x.horizontal = vec![0.0; 200];
    let (model, motion) = x.build();
    let d = solver::exact_demands(&model, &motion).expect("a response").demands;
    let (k, f) = (9.0_f64, 0.05 * 8.0);
    let s = ((f * f + k * 0.25).sqrt() - f) / k;
    assert!((d.peak_sliding_displacement_m - s).abs() < 1e-14);
    assert!((d.peak_block_acceleration_m_per_s2 - (k * s + f)).abs() < 1e-13);
}

/// Slips that grow by a little each, of a block on a spring and a damper: the slider force is largest
/// shortly before a stop, in a batch that does not slide through, and just above its peak so far.
#[test]
fn peer_general_way_on_slips_that_grow() {
    agree_ahead(900_000, 1500, |random| {
        let friction = random.between(0.01, 0.05);
        let mut x = Sketch::block(friction, friction);
        let rate = random.logarithmic(3.0, 12.0);
        x.set_spring(rate);
        x.damper = 2.0 * random.between(0.05, 0.3) * rate * x.block;
        let dt = random.between(0.15, 0.35) / rate;
        let (wave, growth) = (rate * random.between(0.8, 1.2), random.logarithmic(1e-5, 1e-2));
        let amplitude = x.level() * random.between(1.5, 10.0);
        let at = |t: f64| amplitude * libm::exp(growth * wave * t) * libm::sin(wave * t);
        x.times = (0..900).map(|i| f64::from(i) * dt).collect();
        x.horizontal = x.times.iter().map(|t| at(*t)).collect();
        x
    });
}

/// A block on a spring and a damper slides out from `s = 0` to its stop: while it slides
/// `s̈ = −(f + K1 s + C1 ṡ)/M1`, which is the slider force, with its peak between samples.
#[test]
fn slider_force_of_a_block_on_a_spring_and_a_damper() {
    for k in 0..24 {
        let mut x = Sketch::block(0.5, 0.02);
        // Per unit of mass K1 = 9 and C1 = 2, so that y = s + f/9 turns at √8 rad/s and fades by e^−t.
        (x.spring, x.damper) = (128.0 * 9.0, 128.0 * 2.0);
        x.w = 0.02 + 0.01 * f64::from(k);
        x.times = (0..60).map(|i| f64::from(i) * 0.05).collect();
        x.horizontal = vec![0.0; 60];
        let (f, rate) = (0.02 * x.gravity, 8.0_f64.sqrt());
        let (a, b) = (f / 9.0, (x.w + f / 9.0) / rate);
        let at = |t: f64| {
            let (e, c, s) = (libm::exp(-t), libm::cos(rate * t), libm::sin(rate * t));
            let (y, w) = (a * c + b * s, (rate * b - a) * c - (rate * a + b) * s);
            [e * w, e * (9.0 * y + 2.0 * w)]
        };
        // On a grid of 1e-5 s a smooth peak is missed by less than |F″| 1e-10/8.
        let times = (0..200_000).map(|i| f64::from(i) * 1e-5);
        let sliding = times.map(at).take_while(|[w, _]| *w >= 0.0);
        let peak = sliding.fold(0.0_f64, |peak, [_, force]| peak.max(force));
        let (model, motion) = x.build();
        let d = solver::exact_demands(&model, &motion).expect("a response").demands;
        let found = d.peak_slider_force_n / 128.0;
        assert!(d.stick_count == 1 && (found - peak).abs() < 1e-10, "{}: {found} {peak}", x.w);
    }
}

/// A jump amid what would be a block: the block that just holds before it slips right after.
#[test]
fn jump_amid_a_block() {
    for at in 1..20 {
        let mut x = Sketch::block(0.1, 0.1);
        x.times = (0..=at).map(|i| f64::from(i) * 0.125).collect();
        x.horizontal = vec![0.5; x.times.len()];
        x.times.extend((at..40).map(|i| f64::from(i) * 0.125));
        x.horizontal.resize(x.times.len(), 1.6);
        let (model, motion) = x.build();
        let r = solver::exact_demands(&model, &motion).expect("a response");
        assert_eq!(r.events.len(), 1, "jump at sample {at}");
        assert_eq!(r.events[0].time_s, f64::from(at) * 0.125);
        // Slides at 0.8 − 1.6 m/s² ever after.
        let t = (39 - at) as f64 * 0.125;
        let s = -0.5 * 0.8 * t * t;
        assert!((r.demands.residual_sliding_displacement_m - s).abs() < 1e-13);
    }
}

/// Static and kinetic friction are equal: each release starts with no acceleration, and none of
/// its double zeros is a stop. A rigid block under a triangle wave turns round in closed form; here
/// the counts of the event stepping are the measure, over hundreds of releases.
#[test]
fn peer_event_stepping_on_equal_friction() {
    agree(100_000, 1000, TOLERANCE, |random| {
        let mut x = shaken(random);
        x.static_friction = x.kinetic_friction;
        x
    });
}

/// Coarse sampling: an event every few samples, and chords that hide much.
#[test]
fn peer_event_stepping_on_coarse_samples() {
    agree(200_000, 1000, TOLERANCE, |random| {
        let mut x = shaken(random);
        let factor = random.between(2.0, 10.0);
        x.times.iter_mut().for_each(|t| *t *= factor);
        x
    });
}
