//! Random systems in which something goes wrong easily, compared with the plain reference.
//!
//! Each class of trap is drawn on purpose, and a test fails unless the trap really occurred, seen
//! on the reference's response, at least 500 times in systems whose answer is well determined.
//! `SLIPSTICK_SEED` sets another seed.

// The seed and what became of the systems, for people who look with --nocapture; a seed from
// outside to look for more.
#![allow(clippy::disallowed_macros, clippy::disallowed_methods, clippy::expect_used)]

use crate::common::agree::{Verdict, compare};
use crate::common::nasty::{CLASSES, rate};
use crate::common::plain::{Reference, reference};
use crate::common::random::Random;
use crate::common::sketch::Sketch;
use slipstick::response::EventKind;
use slipstick::solver::exact;

/// Systems drawn for each of the thirteen classes: 10 400 in all.
const DRAWN: u64 = 800;
/// Occurrences that a class must reach among the compared.
const NEEDED: u32 = 500;

/// Draws, solves and compares systems of a class; `occurs` sees the trap on the reference.
fn run(class: &str, occurs: impl Fn(&Sketch, &Reference) -> bool) {
    let (_, draw) = CLASSES.iter().find(|(name, _)| *name == class).expect("a class");
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

#[test]
fn reference_nasty_grazing_stops() {
    run("grazing stops", |_, r| {
        r.dips.iter().any(|d| d.depth < 1e-3)
            || r.events.iter().any(|e| e.dip != 0.0 && e.dip < 1e-3)
    });
}

#[test]
fn reference_nasty_two_roots_in_a_sample() {
    run("two roots in a sample", |x, r| busiest(x, r) >= 2);
}

#[test]
fn reference_nasty_over_twenty_events_in_a_sample() {
    run("over twenty events in a sample", |x, r| busiest(x, r) > 20);
}

#[test]
fn reference_nasty_small_excess_of_the_demand() {
    run("small excess of the demand", |x, r| {
        let first = r.events.first().map_or(0.0, |e| e.time_s);
        first > 0.0 && !x.times.contains(&first)
    });
}

#[test]
fn reference_nasty_events_on_samples() {
    run("events on samples", |x, r| {
        let on = |t: f64| x.times.contains(&t) && t > 0.0;
        r.events.iter().filter(|e| on(e.time_s)).count() >= 2
    });
}

#[test]
fn reference_nasty_zero_length_sticks() {
    run("zero-length sticks", |x, r| {
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
    run("no friction", |x, r| x.kinetic_friction == [0.0; 2] && !r.events.is_empty());
}

#[test]
fn reference_nasty_huge_steps() {
    run("huge steps", |x, r| rate(x) * x.times[1] > 20.0 && !r.events.is_empty());
}

#[test]
fn reference_nasty_stiff_spring() {
    run("stiff spring", |x, r| {
        let rate = (x.spring / x.block).sqrt();
        rate * x.times[1] > 50.0 && !r.events.is_empty()
    });
}

#[test]
fn reference_nasty_equal_friction_releases() {
    run("equal friction releases", |x, r| {
        let inside = |t: f64| t > 0.0 && !x.times.contains(&t);
        r.events.iter().any(|e| e.kind == EventKind::Slip && inside(e.time_s))
    });
}

#[test]
fn reference_nasty_jumps() {
    run("jumps", |x, r| {
        let jump = |t: f64| x.times.windows(2).any(|p| p[0] == p[1] && p[0] == t);
        r.events.iter().any(|e| jump(e.time_s))
    });
}

#[test]
fn reference_nasty_uplift() {
    run("uplift", |_, r| !r.contact_loss_s.is_empty() && !r.events.is_empty());
}

#[test]
fn reference_nasty_general() {
    run("general", |_, r| !r.events.is_empty());
}
