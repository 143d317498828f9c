//! Running ahead of event stepping with devices, against event stepping alone: random models with contents
//! and stops, every figure, event and row of the history.

// Helpers of tests may panic as tests do.
#![allow(clippy::disallowed_macros, clippy::expect_used)]

use crate::common::random_devices::{System, system};
use slipstick::error::SolveError;
use slipstick::motion::GroundMotion;
use slipstick::response::{History, Response};
use slipstick::slider::PressureLaw;
use slipstick::solver::{InstructionSet, Prepared, PreparedMotion, exact, exact_demands};

/// Largest difference, over the peak of each quantity.
const TOLERANCE: f64 = 1e-10;
/// Relative change of the motion that must move a well-conditioned answer by less.
const PERTURBATION: f64 = 1e-12;

/// Whether a motion lifts the ground too.
#[derive(Clone, Copy, PartialEq)]
enum Vertical {
    Without,
    With,
}

/// The motion of a system, its horizontal part times a factor.
fn even(system: &System, factor: f64, vertical: Vertical) -> GroundMotion {
    let a = system.horizontal.iter().map(|a| factor * a).collect();
    let lifts = system.vertical.clone().filter(|_| vertical == Vertical::With);
    GroundMotion::new(system.times_s.clone(), a, lifts).expect("a motion")
}

/// The same straight lines, every interval cut in three uneven parts: no even step is left to run ahead by.
fn cut(system: &System, factor: f64, vertical: Vertical) -> GroundMotion {
    let cut = |x: &[f64]| -> Vec<f64> {
        let parts = |(i, pair): (usize, &[f64])| {
            let parts = if i % 2 == 0 { [0.0, 0.3, 0.55] } else { [0.0, 0.2, 0.75] };
            let [a, b] = [pair[0], pair[1]];
            parts.map(|part| a + (b - a) * part)
        };
        x.windows(2).enumerate().flat_map(parts).chain(x.last().copied()).collect()
    };
    let even = even(system, factor, vertical);
    let a = cut(even.horizontal_m_per_s2());
    GroundMotion::new(cut(even.times_s()), a, even.vertical_m_per_s2().map(cut)).expect("a motion")
}

/// The system of a seed; under vertical motion the friction of every other one follows the pressure.
fn drawn(seed: u64, vertical: Vertical) -> System {
    let mut system = system(seed);
    if vertical == Vertical::With
        && seed.is_multiple_of(2)
        && let Some(friction) = system.model.slider().friction()
    {
        let law = PressureLaw::new(20e6, 15e6, 0.25).expect("a law");
        let friction = friction.under_pressure(law).expect("friction");
        system.model = system.model.with_friction(friction);
    }
    system
}

/// The columns of a history at every so many rows, each with the number of values of a row.
fn columns(h: &History, every: usize) -> Vec<Vec<f64>> {
    let list = [
        (&h.sliding_displacement_m, 1),
        (&h.sliding_velocity_m_per_s, 1),
        (&h.block_acceleration_m_per_s2, 1),
        (&h.friction_force_n, 1),
        (&h.storey_displacement_m, h.storeys),
        (&h.storey_velocity_m_per_s, h.storeys),
        (&h.storey_acceleration_m_per_s2, h.storeys),
        (&h.contents_displacement_m, h.interfaces - 1),
        (&h.contents_velocity_m_per_s, h.interfaces - 1),
        (&h.contents_acceleration_m_per_s2, h.interfaces - 1),
    ];
    let rows = || h.rows.iter().step_by(every);
    let of = |(column, width): (&Vec<f64>, usize)| {
        (0..width).map(|i| rows().map(|row| column[row * width + i]).collect()).collect::<Vec<_>>()
    };
    list.into_iter().flat_map(of).collect()
}

/// What differs between two answers, over the size of each; infinite where counts differ.
fn difference(a: &Response, b: &Response, rows: [usize; 2]) -> (f64, String) {
    let mut worst = (0.0, String::new());
    let mut compare = |name: &str, x: f64, y: f64, size: f64| {
        let off = (x - y).abs() / size.max(1e-300);
        if x != y && !(off <= worst.0) {
            worst = (off, format!("{name}: {x:e} and {y:e} of {size:e}"));
        }
    };
    if a.events.len() != b.events.len() {
        return (f64::INFINITY, format!("{} and {} events", a.events.len(), b.events.len()));
    }
    for (x, y) in a.events.iter().zip(&b.events) {
        let same = x.kind == y.kind && x.interface == y.interface && x.mode == y.mode;
        if !same || (x.time_s - y.time_s).abs() > 1e-7 {
            return (f64::INFINITY, format!("{x:?} and {y:?}"));
        }
    }
    let (d, e) = (&a.demands, &b.demands);
    let s = d.peak_sliding_displacement_m;
    compare("residual", d.residual_sliding_displacement_m, e.residual_sliding_displacement_m, s);
    let mut own = |name: &str, x: f64, y: f64| compare(name, x, y, x.abs());
    own("peak s", s, e.peak_sliding_displacement_m);
    own("path", d.sliding_path_m, e.sliding_path_m);
    own("time", d.sliding_time_s, e.sliding_time_s);
    own("velocity", d.peak_sliding_velocity_m_per_s, e.peak_sliding_velocity_m_per_s);
    own("block", d.peak_block_acceleration_m_per_s2, e.peak_block_acceleration_m_per_s2);
    own("shear", d.peak_base_shear_n, e.peak_base_shear_n);
    own("friction", d.peak_friction_force_n, e.peak_friction_force_n);
    own("slider", d.peak_slider_force_n, e.peak_slider_force_n);
    for (x, y) in d.storeys.iter().zip(&e.storeys) {
        own("floor", x.peak_acceleration_m_per_s2, y.peak_acceleration_m_per_s2);
        own("displacement", x.peak_displacement_m, y.peak_displacement_m);
        own("drift", x.peak_drift_m, y.peak_drift_m);
        own("drift velocity", x.peak_drift_velocity_m_per_s, y.peak_drift_velocity_m_per_s);
    }
    for (x, y) in d.contents.iter().zip(&e.contents) {
        own("slide", x.peak_sliding_displacement_m, y.peak_sliding_displacement_m);
        own("path of contents", x.sliding_path_m, y.sliding_path_m);
        own(
            "velocity of contents",
            x.peak_sliding_velocity_m_per_s,
            y.peak_sliding_velocity_m_per_s,
        );
        own("contents", x.peak_acceleration_m_per_s2, y.peak_acceleration_m_per_s2);
    }
    if let (Some(x), Some(y)) = (&d.stop, &e.stop) {
        own("impact", x.peak_impact_speed_m_per_s, y.peak_impact_speed_m_per_s);
        own("stop", x.peak_force_n, y.peak_force_n);
        own("contact", x.contact_time_s, y.contact_time_s);
    }
    let [x, y] = [(a, rows[0]), (b, rows[1])]
        .map(|(r, every)| columns(r.history.as_ref().expect("a history"), every));
    for (i, (x, y)) in x.iter().zip(&y).enumerate() {
        assert_eq!(x.len(), y.len(), "rows");
        let size = x.iter().fold(0.0_f64, |size, x| size.max(x.abs()));
        x.iter().zip(y).for_each(|(x, y)| compare(&format!("column {i}"), *x, *y, size));
    }
    worst
}

fn agree(first: u64, count: usize, vertical: Vertical) {
    let (mut compared, mut events, mut ill, mut worst) = (0, 0, 0, 0.0_f64);
    let mut wrong = Vec::new();
    let all = (first..).map(|seed| (seed, drawn(seed, vertical)));
    let wanted =
        all.filter(|(_, system)| vertical == Vertical::Without || system.vertical.is_some());
    for (seed, system) in wanted.take(count) {
        let stepped = exact(&system.model, &cut(&system, 1.0, vertical));
        let ahead = exact(&system.model, &even(&system, 1.0, vertical));
        let (stepped, ahead) = match (&stepped, &ahead) {
            (Ok(stepped), Ok(ahead)) => (stepped, ahead),
            (Err(SolveError::EndOfTravel { .. }), Err(SolveError::EndOfTravel { .. })) => continue,
            (stepped, ahead) => {
                panic!("seed {seed}: {:?} and {:?}", stepped.is_ok(), ahead.is_ok())
            }
        };
        compared += 1;
        events += stepped.events.len();
        let (off, what) = difference(stepped, ahead, [3, 1]);
        if off <= TOLERANCE {
            worst = worst.max(off);
            continue;
        }
        let moved =
            exact(&system.model, &cut(&system, 1.0 + PERTURBATION, vertical)).expect("a response");
        if difference(stepped, &moved, [3, 3]).0 > TOLERANCE {
            ill += 1;
        } else {
            wrong.push(format!("seed {seed}: {off:.1e} {what}"));
        }
    }
    println!("{compared} compared, {events} events, {ill} ill-conditioned, worst {worst:.1e}");
    assert!(wrong.is_empty(), "{} differ:\n{}", wrong.len(), wrong.join("\n"));
    assert!(10 * compared >= 7 * count && 20 * ill <= count, "{compared} compared, {ill} ill");
}

/// The bits of demands and events, as of a system that is turned round where `sign` is −1.
fn bits(r: &Response, sign: f64) -> Vec<u64> {
    let d = &r.demands;
    let signed = d.residual_sliding_displacement_m;
    let contents = d.contents.iter();
    let signed = core::iter::once(signed)
        .chain(contents.clone().map(|c| c.residual_sliding_displacement_m))
        .chain(r.events.iter().map(|e| e.sliding_displacement_m));
    let sizes = [
        d.peak_sliding_velocity_m_per_s,
        d.peak_block_acceleration_m_per_s2,
        d.peak_friction_force_n,
        d.peak_slider_force_n,
        d.peak_base_shear_n,
    ];
    let sizes = sizes.into_iter().chain(r.events.iter().map(|e| e.time_s));
    let sizes = sizes.chain(contents.map(|c| c.peak_sliding_velocity_m_per_s));
    let storeys = d.storeys.iter().map(|storey| storey.peak_acceleration_m_per_s2);
    // −0 is 0.
    signed.map(|x| sign * x).chain(sizes).chain(storeys).map(|x| (x + 0.0).to_bits()).collect()
}

#[test]
fn bits_know_no_side_no_history_and_no_instruction_set() {
    for seed in 0..200 {
        let system = system(seed);
        let Ok(response) = exact(&system.model, &even(&system, 1.0, Vertical::Without)) else {
            continue;
        };
        let here = bits(&response, 1.0);
        let mirrored =
            exact(&system.mirrored, &even(&system, -1.0, Vertical::Without)).expect("a response");
        assert_eq!(bits(&mirrored, -1.0), here, "seed {seed} mirrored");
        let demands = exact_demands(&system.model, &even(&system, 1.0, Vertical::Without))
            .expect("a response");
        assert_eq!(bits(&demands, 1.0), here, "seed {seed} without history");
        let motion = PreparedMotion::new(even(&system, 1.0, Vertical::Without));
        let model = Prepared::new(system.model, motion.dt_s());
        for set in InstructionSet::all() {
            let response = model.demands_by(set, &motion).expect("a response");
            assert_eq!(bits(&response, 1.0), here, "seed {seed} by {set:?}");
        }
    }
}

#[test]
fn peer_event_stepping_on_random_devices() {
    agree(0, 400, Vertical::Without);
    agree(20_000, 200, Vertical::With);
}

#[test]
#[ignore = "minutes: cargo xtask nightly"]
fn peer_event_stepping_on_many_random_devices() {
    agree(0, 10_000, Vertical::Without);
    agree(20_000, 10_000, Vertical::With);
}
