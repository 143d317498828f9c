//! Random systems with all devices: each is certified, the same as its mirror image, and the same
//! when its motion is sampled more finely.

// Helpers of tests may panic as tests do.
#![allow(clippy::disallowed_macros, clippy::expect_used)]

use crate::common::random_devices::{motion, system};
use slipstick::check::check;
use slipstick::error::SolveError;
use slipstick::motion::GroundMotion;
use slipstick::response::Response;
use slipstick::solver::exact;

fn same_mirrored(a: &Response, b: &Response) -> bool {
    let (d, e) = (&a.demands, &b.demands);
    let events = a.events.iter().zip(&b.events).all(|(a, b)| {
        a.time_s == b.time_s
            && a.kind == b.kind
            && a.interface == b.interface
            && a.mode.sign() == -b.mode.sign()
            && a.sliding_displacement_m == -b.sliding_displacement_m
    });
    events
        && a.events.len() == b.events.len()
        && d.peak_sliding_displacement_m == e.peak_sliding_displacement_m
        && d.residual_sliding_displacement_m == -e.residual_sliding_displacement_m
        && d.storeys == e.storeys
        && d.stop == e.stop
}

/// Every system has an answer that the check confirms, or runs out of travel; its mirror image has
/// the same numbers.
#[test]
fn prop_random_devices_are_certified_and_have_no_side() {
    certified(0, 400);
}

/// Those among ten thousand that bounce at a rigid stop so close to where another surface takes over, or
/// with a surface so close to its end, that only the force tells which surface slides.
#[test]
fn bounces_beside_a_join_and_an_end_are_certified() {
    for seed in [438, 1032, 7810, 8425, 9417] {
        certified(seed, 1);
    }
}

/// The same of ten thousand.
#[test]
#[ignore = "minutes: cargo xtask nightly"]
fn prop_many_random_devices_are_certified_and_have_no_side() {
    certified(0, 10_000);
}

/// The same straight lines with every interval in three: all that changes is where samples lie. Where a
/// decision was closer than rounding, so that another one may follow, is left out.
#[test]
fn prop_random_devices_do_not_know_the_samples() {
    let (mut compared, mut close) = (0, 0);
    for seed in 0..200 {
        let system = system(seed);
        let motion_s = motion(&system, 1.0);
        let Ok(response) = exact(&system.model, &motion_s) else { continue };
        let call = check(&system.model, &motion_s, &response).closest_call;
        if call.is_some_and(|call| call.margin < 1e-9) {
            close += 1;
            continue;
        }
        let finer = |list: &[f64]| -> Vec<f64> {
            let between = |pair: &[f64]| {
                [0.0, 1.0 / 3.0, 2.0 / 3.0].map(|part| pair[0] + (pair[1] - pair[0]) * part)
            };
            let all = list.windows(2).flat_map(between);
            all.chain(list.last().copied()).collect()
        };
        let (t, a) = (finer(&system.times_s), finer(&system.horizontal));
        let finer_s = GroundMotion::new(t, a, system.vertical.as_deref().map(finer));
        let other = exact(&system.model, &finer_s.expect("a motion")).expect("a response");
        let (d, e) = (&response.demands, &other.demands);
        let near = |a: f64, b: f64| (a - b).abs() <= 1e-7 * a.abs().max(b.abs());
        assert!(
            near(d.peak_sliding_displacement_m, e.peak_sliding_displacement_m)
                && near(d.peak_sliding_velocity_m_per_s, e.peak_sliding_velocity_m_per_s)
                && near(d.sliding_path_m, e.sliding_path_m)
                && response.events.len() == other.events.len(),
            "{seed}: {d:?} with {} events became {e:?} with {}",
            response.events.len(),
            other.events.len()
        );
        compared += 1;
    }
    assert!(compared >= 150, "{compared} compared, {close} decided closely");
}

fn certified(first: u64, count: u64) {
    let (mut wrong, mut ends, mut events) = (Vec::new(), 0, 0);
    for seed in first..first + count {
        let system = system(seed);
        let motion_s = motion(&system, 1.0);
        let response = match exact(&system.model, &motion_s) {
            Ok(response) => response,
            Err(SolveError::EndOfTravel { .. }) => {
                ends += 1;
                continue;
            }
            Err(error) => {
                wrong.push(format!("{seed}: {error}"));
                continue;
            }
        };
        events += response.events.len();
        let c = check(&system.model, &motion_s, &response);
        if !c.holds() {
            wrong.push(format!(
                "{seed}: certificate {:.1e} {:.1e} {:.1e} {:.1e} over {:.1e}",
                c.equilibrium_residual,
                c.friction_excess,
                c.energy_balance_error,
                c.demands_error,
                c.bound
            ));
        }
        let mirrored = exact(&system.mirrored, &motion(&system, -1.0)).expect("a response");
        if !same_mirrored(&response, &mirrored) {
            wrong.push(format!("{seed}: its mirror image differs"));
        }
    }
    println!("{count} systems, {events} events, {ends} out of travel, {} wrong", wrong.len());
    assert!(wrong.is_empty(), "{} wrong:\n{}", wrong.len(), wrong.join("\n"));
}
