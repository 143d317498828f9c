//! What holds for every system: conservation, the friction law, the certificate. Random systems come from a
//! fixed seed. Symmetries and scalings are in `metamorphic.rs`.

// The numbers of a run are for people who look for them with --nocapture; helpers of tests may panic as
// tests do.
#![allow(clippy::disallowed_macros, clippy::expect_used)]

use crate::common::random::Random;
use crate::common::sketch::Sketch;
use slipstick::check::check;
use slipstick::model::Model;
use slipstick::response::{Mode, Response};
use slipstick::solver::exact;

const SYSTEMS: u64 = 400;

fn systems() -> impl Iterator<Item = Sketch> {
    (0..SYSTEMS).map(|index| Sketch::shaken(&mut Random::new(2_000_003 + index)))
}

fn solve(sketch: &Sketch) -> (Model, Response) {
    let (model, motion) = sketch.build();
    let response = exact(&model, &motion).expect("a response");
    (model, response)
}

/// Without spring and damper the centre of mass decelerates by μ_k (g cos θ + Üv) + g sin θ while it
/// slides, whatever the storeys do: at every knot, and over every stretch between two.
#[test]
fn prop_centre_of_mass_decelerates_by_friction() {
    let mut knots = 0;
    for mut x in systems() {
        (x.spring, x.damper, x.vertical) = (0.0, 0.0, None);
        let (model, response) = solve(&x);
        let h = response.history.expect("a history");
        let total = x.total();
        let slope = model.slope_m_per_s2();
        let mean = |i: usize, block: &[f64], floors: &[f64]| {
            let own = &floors[i * h.storeys..(i + 1) * h.storeys];
            let sum: f64 = x.masses.iter().zip(own).map(|(m, a)| m * a).sum();
            (x.block * block[i] + sum) / total
        };
        for i in 0..h.len() {
            let Mode::Slip(direction) = h.mode[i] else { continue };
            let side = usize::from(direction.sign() < 0.0);
            let friction = x.kinetic_friction[side] * model.normal_gravity_m_per_s2();
            let wanted = -direction.sign() * friction - slope;
            let accelerations = &h.storey_acceleration_m_per_s2;
            let found = mean(i, &h.block_acceleration_m_per_s2, accelerations);
            let size = response.demands.peak_block_acceleration_m_per_s2
                + response
                    .demands
                    .storeys
                    .iter()
                    .map(|s| s.peak_acceleration_m_per_s2)
                    .sum::<f64>();
            assert!((found - wanted).abs() <= 1e-12 * size, "knot {i} of {x:?}");
            knots += 1;
            if i + 1 < h.len() && h.mode[i + 1] == h.mode[i] && h.time_s[i + 1] > h.time_s[i] {
                // Velocity of the centre of mass over the table: its own less the table's gain.
                let speed = |i: usize| {
                    let own = h.storey_velocities(i).iter().zip(&x.masses);
                    let sum: f64 = own.map(|(v, m)| v * m).sum();
                    h.sliding_velocity_m_per_s[i] + sum / total
                };
                let dt_s = h.time_s[i + 1] - h.time_s[i];
                let table = &h.table_acceleration_m_per_s2;
                let gain = (wanted - 0.5 * (table[i] + table[i + 1])) * dt_s;
                let size = response.demands.peak_sliding_velocity_m_per_s + gain.abs();
                let error = speed(i + 1) - speed(i) - gain;
                assert!(error.abs() <= 1e-11 * size, "stretch {i} off by {error:e}: {x:?}");
            }
        }
    }
    assert!(knots > 1000, "only {knots} knots in slip");
}

/// A stuck block does not creep by a single bit, and its friction stays within the static bound.
#[test]
fn prop_stick_holds_still_within_its_bound() {
    let mut knots = 0;
    for x in systems() {
        let (model, response) = solve(&x);
        let (_, motion) = x.build();
        let h = response.history.expect("a history");
        let (mut largest, mut row) = (0.0_f64, 0);
        for i in 0..h.len() {
            largest = largest.max(h.friction_force_n[i].abs());
            while row + 1 < motion.len() && motion.times_s()[row + 1] < h.time_s[i] {
                row += 1;
            }
            if h.mode[i] != Mode::Stick {
                continue;
            }
            assert_eq!(h.sliding_velocity_m_per_s[i], 0.0, "knot {i} of {x:?}");
            if i > 0 && h.mode[i - 1] == Mode::Stick {
                let [before, now] = [i - 1, i].map(|k| h.sliding_displacement_m[k].to_bits());
                assert_eq!(before, now, "knot {i} of {x:?}");
            }
            knots += 1;
            if motion.vertical_m_per_s2().is_some() {
                continue;
            }
            // The force towards −x holds against sliding towards +x.
            let side = usize::from(h.friction_force_n[i] > 0.0);
            let normal = x.total() * model.normal_gravity_m_per_s2();
            let bound = x.static_friction[side] * normal;
            let excess = h.friction_force_n[i].abs() - bound;
            assert!(excess <= 1e-12 * bound.max(largest), "knot {i} exceeds by {excess:e}: {x:?}");
        }
    }
    assert!(knots > 1000, "only {knots} knots in stick");
}

/// The certificate, which knows nothing of the solver, holds.
#[test]
fn prop_certificate_holds() {
    let mut largest = [0.0_f64; 4];
    for (index, x) in systems().enumerate() {
        let (model, motion) = x.build();
        let response = exact(&model, &motion).expect("a response");
        let certificate = check(&model, &motion, &response);
        assert!(certificate.holds(), "system {index}: {certificate:?}\n{x:?}");
        for (largest, figure) in largest.iter_mut().zip([
            certificate.equilibrium_residual,
            certificate.friction_excess,
            certificate.energy_balance_error,
            certificate.demands_error,
        ]) {
            *largest = largest.max(figure);
        }
    }
    println!("largest residual, friction excess, energy and demands error: {largest:?}");
}
