//! What holds for every system: symmetries, scalings, conservation, the friction law.
//!
//! Random systems come from a fixed seed. Figures are compared to 1e-9 of their peak wherever a
//! change of the input by 1e-12 moves them by less; how many were not is printed.

// The numbers of a run are for people who look for them with --nocapture; helpers of tests may panic as
// tests do.
#![allow(clippy::disallowed_macros, clippy::expect_used)]

mod common;

use common::random::Random;
use common::sketch::Sketch;
use slipstick::check::check;
use slipstick::model::{Damping, Model};
use slipstick::response::{Mode, Response};
use slipstick::solver::exact;

const SYSTEMS: u64 = 400;
const TOLERANCE: f64 = 1e-9;

fn systems() -> impl Iterator<Item = Sketch> {
    (0..SYSTEMS).map(|index| Sketch::shaken(&mut Random::new(2_000_003 + index)))
}

fn solve(sketch: &Sketch) -> (Model, Response) {
    let (model, motion) = sketch.build();
    let response = exact(&model, &motion).expect("a response");
    (model, response)
}

/// What a figure measures, in the order of [`Units`].
#[derive(Clone, Copy, Debug)]
enum Kind {
    Length,
    Velocity,
    Acceleration,
    Force,
    Time,
}

/// Factors on lengths, velocities, accelerations, forces and times; `None`: not compared.
type Units = [Option<f64>; 5];

const UNCHANGED: Units = [Some(1.0); 5];

/// States at the rows and peaks: kind, value, peak.
fn figures(response: &Response) -> Vec<(Kind, f64, f64)> {
    use Kind::{Acceleration, Force, Length, Time, Velocity};
    let d = &response.demands;
    let h = response.history.as_ref().expect("a history");
    let (s, w) = (d.peak_sliding_displacement_m, d.peak_sliding_velocity_m_per_s);
    let end_s = h.time_s[h.len() - 1];
    let rates = &h.storey_velocity_m_per_s;
    let fastest = rates.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    let mut list = Vec::new();
    for &row in &h.rows {
        list.push((Length, h.sliding_displacement_m[row], s));
        list.push((Velocity, h.sliding_velocity_m_per_s[row], w));
        for i in 0..h.storeys {
            let peak = d.storeys[i].peak_displacement_m;
            list.push((Length, h.storey_displacements(row)[i], peak));
            list.push((Velocity, h.storey_velocities(row)[i], fastest));
        }
    }
    let mut peak = |kind: Kind, value: f64| list.push((kind, value, value));
    peak(Length, s);
    peak(Velocity, w);
    peak(Length, d.sliding_path_m);
    peak(Acceleration, d.peak_block_acceleration_m_per_s2);
    peak(Force, d.peak_base_shear_n);
    peak(Force, d.peak_friction_force_n);
    peak(Force, d.peak_slider_force_n);
    for storey in &d.storeys {
        peak(Length, storey.peak_displacement_m);
        peak(Length, storey.peak_drift_m);
        peak(Acceleration, storey.peak_acceleration_m_per_s2);
    }
    // A stick as short as the root of rounding may or may not be told (see the plain reference).
    list.push((Time, d.sliding_time_s, 100.0 * end_s));
    list
}

/// Largest difference of figures, those of `b` divided by `units`, over the peaks of `a`.
fn difference(a: &Response, b: &Response, units: Units) -> f64 {
    let (a, b) = (figures(a), figures(b));
    assert_eq!(a.len(), b.len());
    let each = a.iter().zip(&b).filter_map(|((kind, x, size), (_, y, _))| {
        let error = (x - y / units[*kind as usize]?).abs();
        // 0/0 = 0.
        Some(if error == 0.0 { 0.0 } else { error / size })
    });
    // NaN must not vanish.
    each.fold(0.0, |m, e| if e <= m || m.is_nan() { m } else { e })
}

/// By how much a change of the input by 1e-12 moves the figures.
fn moved(sketch: &Sketch, response: &Response) -> f64 {
    let other = sketch.perturbed(1e-12).map(|x| difference(response, &solve(&x).1, UNCHANGED));
    if other[0].is_nan() || other[0] > other[1] { other[0] } else { other[1] }
}

/// Solves every system and its changed twin, and compares where the answer is well determined.
fn twins(what: &str, change: impl Fn(&mut Sketch, &mut Random) -> (Sketch, Units)) {
    let (mut compared, mut ill, mut worst) = (0_u32, 0_u32, 0.0_f64);
    for (index, mut sketch) in systems().enumerate() {
        let mut random = Random::new(index as u64);
        let (twin, units) = change(&mut sketch, &mut random);
        let (_, response) = solve(&sketch);
        let moved = moved(&sketch, &response);
        if !(moved < TOLERANCE) {
            ill += 1;
            continue;
        }
        let (_, other) = solve(&twin);
        let found = difference(&response, &other, units);
        assert!(found <= TOLERANCE, "{what}: system {index} differs by {found:.1e}: {sketch:?}");
        compared += 1;
        worst = worst.max(found);
    }
    println!("{what}: {compared} agree to {worst:.1e} of the peaks, {ill} ill-conditioned");
    assert!(compared >= 100, "{what}: only {compared} systems compared, {ill} ill-conditioned");
}

fn scale(values: &mut [f64], factor: f64) {
    for value in values {
        *value *= factor;
    }
}

fn scaled_dampers(damping: &mut Damping, factor: f64) {
    if let Damping::Dampers(c) = damping {
        scale(c, factor);
    }
}

/// The start written out: the default start of a sketch depends on what a twin changes.
fn fix_start(x: &mut Sketch) {
    let (model, _) = x.build();
    x.q = Some(model.initial_storey_displacement_m());
}

/// Motion, start, tilt and directions the other way round: every number is, to the last bit.
#[test]
fn prop_mirror_negates_every_number() {
    for sketch in systems() {
        let mut twin = sketch.clone();
        twin.static_friction.reverse();
        twin.kinetic_friction.reverse();
        scale(&mut twin.horizontal, -1.0);
        scale(&mut twin.v, -1.0);
        twin.q.iter_mut().for_each(|q| scale(q, -1.0));
        (twin.tilt, twin.s, twin.w) = (-sketch.tilt, -sketch.s, -sketch.w);
        let ((_, response), (_, mut other)) = (solve(&sketch), solve(&twin));
        let d = &mut other.demands;
        (d.max_sliding_displacement_m, d.min_sliding_displacement_m) =
            (-d.min_sliding_displacement_m, -d.max_sliding_displacement_m);
        d.residual_sliding_displacement_m *= -1.0;
        assert_eq!(response.demands, other.demands, "{sketch:?}");
        assert_eq!(response.contact_loss_s, other.contact_loss_s, "{sketch:?}");
        for event in &mut other.events {
            event.sliding_displacement_m *= -1.0;
            event.mode = turned(event.mode);
        }
        assert_eq!(response.events, other.events, "{sketch:?}");
        let mut history = other.history.take().expect("a history");
        history.mode.iter_mut().for_each(|m| *m = turned(*m));
        for list in [
            &mut history.table_acceleration_m_per_s2,
            &mut history.sliding_displacement_m,
            &mut history.sliding_velocity_m_per_s,
            &mut history.block_acceleration_m_per_s2,
            &mut history.friction_force_n,
            &mut history.storey_displacement_m,
            &mut history.storey_velocity_m_per_s,
            &mut history.storey_acceleration_m_per_s2,
        ] {
            scale(list, -1.0);
        }
        assert_eq!(response.history, Some(history), "{sketch:?}");
    }
}

fn turned(mode: Mode) -> Mode {
    use slipstick::friction::Direction::{Negative, Positive};
    match mode {
        Mode::Stick => Mode::Stick,
        Mode::Slip(Positive) => Mode::Slip(Negative),
        Mode::Slip(Negative) => Mode::Slip(Positive),
    }
}

/// The same straight lines with more samples are the same motion.
#[test]
fn prop_collinear_samples_change_nothing() {
    const PARTS: usize = 5;
    let (mut compared, mut ill, mut worst) = (0_u32, 0_u32, 0.0_f64);
    for (index, sketch) in systems().enumerate() {
        let mut twin = sketch.clone();
        let lists = [Some(&mut twin.times), Some(&mut twin.horizontal), twin.vertical.as_mut()];
        for list in lists.into_iter().flatten() {
            let fine = |pair: &[f64]| {
                let (from, by) = (pair[0], (pair[1] - pair[0]) / PARTS as f64);
                (0..PARTS).map(|k| from + by * k as f64).collect::<Vec<_>>()
            };
            let last = list[list.len() - 1];
            let jumps: Vec<bool> = sketch.times.windows(2).map(|p| p[0] == p[1]).collect();
            let parts = list.windows(2).zip(jumps);
            *list = parts
                .flat_map(|(pair, jump)| if jump { vec![pair[0]] } else { fine(pair) })
                .chain([last])
                .collect();
        }
        let (_, response) = solve(&sketch);
        let (_, mut other) = solve(&twin);
        // Only the rows that both have.
        let history = other.history.as_mut().expect("a history");
        let mut own = 0;
        let kept = sketch.times.windows(2).map(|p| if p[0] == p[1] { 1 } else { PARTS });
        let rows: Vec<usize> = [0]
            .into_iter()
            .chain(kept.map(|n| {
                own += n;
                own
            }))
            .collect();
        history.rows = rows.into_iter().map(|row| history.rows[row]).collect();
        let moved = moved(&sketch, &response);
        if !(moved < TOLERANCE) {
            ill += 1;
            continue;
        }
        let found = difference(&response, &other, UNCHANGED);
        assert!(found <= TOLERANCE, "system {index} differs by {found:.1e}: {sketch:?}");
        compared += 1;
        worst = worst.max(found);
    }
    println!("collinear samples: {compared} agree to {worst:.1e}, {ill} ill-conditioned");
    assert!(compared >= 100, "only {compared} systems compared, {ill} ill-conditioned");
}

/// All masses, stiffnesses and dampers times c: the same motion, forces times c.
#[test]
fn prop_heavier_and_stiffer_moves_the_same() {
    twins("mass, stiffness, damping", |x, random| {
        let c = random.logarithmic(0.01, 100.0);
        let mut twin = x.clone();
        for value in [&mut twin.block, &mut twin.spring, &mut twin.damper] {
            *value *= c;
        }
        scale(&mut twin.masses, c);
        scale(&mut twin.stiffnesses, c);
        scaled_dampers(&mut twin.damping, c);
        (twin, [1.0, 1.0, 1.0, c, 1.0].map(Some))
    });
}

/// Time times c with the same accelerations: lengths times c², velocities times c.
#[test]
fn prop_slower_moves_further() {
    twins("time", |x, random| {
        fix_start(x);
        let c = random.logarithmic(0.1, 10.0);
        let mut twin = x.clone();
        scale(&mut twin.times, c);
        twin.spring /= c * c;
        twin.damper /= c;
        scale(&mut twin.stiffnesses, 1.0 / (c * c));
        scaled_dampers(&mut twin.damping, 1.0 / c);
        (twin.s, twin.w) = (x.s * c * c, x.w * c);
        twin.q.iter_mut().for_each(|q| scale(q, c * c));
        scale(&mut twin.v, c);
        (twin, [c * c, c, 1.0, 1.0, c].map(Some))
    });
}

/// Motion, friction and start times c on a level surface: everything times c.
#[test]
fn prop_stronger_over_rougher_is_the_same_story() {
    twins("amplitude and friction", |x, random| {
        x.tilt = 0.0;
        // The vertical motion changes the weight, which stays.
        let c = random.logarithmic(0.1, 10.0);
        let mut twin = x.clone();
        scale(&mut twin.horizontal, c);
        scale(&mut twin.static_friction, c);
        scale(&mut twin.kinetic_friction, c);
        (twin.s, twin.w) = (x.s * c, x.w * c);
        twin.q.iter_mut().for_each(|q| scale(q, c));
        scale(&mut twin.v, c);
        (twin, [c, c, c, c, 1.0].map(Some))
    });
}

/// A slope is an acceleration g sin θ with friction μ cos θ on a level surface.
#[test]
fn prop_tilt_is_an_acceleration() {
    twins("tilt", |x, random| {
        x.vertical = None;
        x.tilt = random.between(-0.02, 0.02);
        fix_start(x);
        let mut twin = x.clone();
        twin.tilt = 0.0;
        for a in &mut twin.horizontal {
            *a += x.gravity * libm::sin(x.tilt);
        }
        scale(&mut twin.static_friction, libm::cos(x.tilt));
        scale(&mut twin.kinetic_friction, libm::cos(x.tilt));
        // Reported accelerations leave the slope out: they are not compared.
        (twin, [Some(1.0), Some(1.0), None, Some(1.0), Some(1.0)])
    });
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
