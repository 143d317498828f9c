//! Two ways to say the same: another unit, the other side, more samples on the same lines, a device that
//! does nothing. The answers are the same, to the last bit and with their certificates for another unit of mass and
//! for the other side, to rounding for other units of length and time, else to 1e-9 of the peak of each quantity
//! wherever a change of the input by 1e-12 moves it by less; and all are certified.
//!
//! Half of the systems are what an engineer would write, half are anything, with all devices. Thousands:
//! `SLIPSTICK_SEEDS=0..5000 cargo test -p slipstick --test library metamorphic:: -- --nocapture`.

// The numbers of a run are for people who look for them with --nocapture; helpers of tests may panic as
// tests do; a seed from outside to look for more.
#![allow(clippy::disallowed_macros, clippy::disallowed_methods, clippy::expect_used)]

use std::ops::Range;

use crate::common::random::Random;
use crate::common::sensible::{self, system};
use crate::common::sketch::Sketch;
use slipstick::check::{Certificate, DecisionKind, check};
use slipstick::error::SolveError;
use slipstick::model::{Contents, Stop, StopKind};
use slipstick::response::{Contact, DemandColumn, Event, EventKind, Mode, Response};
use slipstick::slider::{RateCurve, Surface, SurfacesInSeries};
use slipstick::solver::exact;
use slipstick::units::Dimension;

/// Largest difference of a figure, over the peak of its quantity.
const TOLERANCE: f64 = 1e-9;
/// The same of a system in other units: rounding is a ten-thousandth of the change that tells which figures
/// are well determined.
const ROUNDING: f64 = 1e-12;
/// Relative change of the input that must move a well-determined figure by less.
const PERTURBATION: f64 = 1e-12;
const SYSTEMS: u64 = 200;

fn seeds() -> Range<u64> {
    sensible::seeds(0..SYSTEMS)
}

fn solve(x: &Sketch) -> Result<Response, SolveError> {
    let (model, motion) = x.build();
    exact(&model, &motion)
}

/// Factors on lengths and times, and on masses, between a system and its twin.
#[derive(Clone, Copy)]
struct Units {
    mass: f64,
    length: f64,
    time: f64,
    /// On forces over the weight.
    coefficient: f64,
}

impl Units {
    const SAME: Self = Self { mass: 1.0, length: 1.0, time: 1.0, coefficient: 1.0 };

    fn velocity(self) -> f64 {
        self.length / self.time
    }

    fn acceleration(self) -> f64 {
        self.velocity() / self.time
    }

    fn force(self) -> f64 {
        self.mass * self.acceleration()
    }

    fn of(self, column: &DemandColumn) -> f64 {
        match column.dimension() {
            Some(Dimension::Length) => self.length,
            Some(Dimension::Time) => self.time,
            Some(Dimension::Velocity) => self.velocity(),
            Some(Dimension::Acceleration) => self.acceleration(),
            Some(Dimension::Force) => self.force(),
            None if column.name().contains("coefficient") => self.coefficient,
            None => 1.0,
            Some(other) => panic!("{other:?} of {}", column.name()),
        }
    }
}

/// The lists of a history with what they measure.
fn lists(response: &Response, units: Units) -> Vec<(&'static str, &[f64], f64)> {
    let h = response.history.as_ref().expect("a history");
    let Units { length, time, .. } = units;
    let (velocity, acceleration) = (units.velocity(), units.acceleration());
    vec![
        ("t", &h.time_s, time),
        ("Ü", &h.table_acceleration_m_per_s2, acceleration),
        ("s", &h.sliding_displacement_m, length),
        ("ds/dt", &h.sliding_velocity_m_per_s, velocity),
        ("block acceleration", &h.block_acceleration_m_per_s2, acceleration),
        ("T", &h.friction_force_n, units.force()),
        ("q", &h.storey_displacement_m, length),
        ("dq/dt", &h.storey_velocity_m_per_s, velocity),
        ("floor acceleration", &h.storey_acceleration_m_per_s2, acceleration),
        ("u", &h.surface_displacement_m, length),
        ("r", &h.contents_displacement_m, length),
        ("dr/dt", &h.contents_velocity_m_per_s, velocity),
        ("contents acceleration", &h.contents_acceleration_m_per_s2, acceleration),
    ]
}

/// The first number of `b` that is not that of `a` times its unit, to a part of its size.
///
/// An impact below 1 mm/s is neither counted nor listed, nor the turn before it: where velocities have
/// other units, those of a rigid stop are left out.
fn first_other(a: &Response, b: &Response, units: Units, part: f64) -> Option<String> {
    let bounces = |event: &Event| matches!(event.kind, EventKind::Impact | EventKind::Rest);
    let any_speed = units.velocity() == 1.0 || !a.events.iter().any(bounces);
    let near = |x: f64, y: f64, size: f64| x == y || (x - y).abs() <= part * size;
    let differs = |what: &str, (x, y): (f64, f64), factor: f64, size: f64| {
        let same = near(x * factor, y, size * factor) || (x.is_nan() && y.is_nan());
        (!same).then(|| format!("{what}: {x:e} × {factor:e} became {y:e}"))
    };
    let told = |response: &Response| -> Vec<Event> {
        let left_out =
            |event: &&Event| matches!(event.kind, EventKind::Impact | EventKind::Reversal);
        let listed = |event: &&Event| any_speed || !left_out(event);
        response.events.iter().filter(listed).copied().collect()
    };
    let (told_a, told_b) = (told(a), told(b));
    let end_s = a.history.as_ref().expect("a history").time_s.last().copied().unwrap_or(0.0);
    let d = &a.demands;
    let mut sizes = vec![d.peak_sliding_displacement_m];
    sizes.extend(d.contents.iter().map(|contents| contents.peak_sliding_displacement_m));
    for (x, y) in told_a.iter().zip(&told_b) {
        let alike = (x.kind, x.mode, x.interface) == (y.kind, y.mode, y.interface);
        let time = near(x.time_s * units.time, y.time_s, end_s * units.time);
        let places = [x.sliding_displacement_m * units.length, y.sliding_displacement_m];
        let place = near(places[0], places[1], sizes[x.interface] * units.length);
        if !(alike && time && place) {
            return Some(format!("event {x:?} became {y:?}"));
        }
    }
    if told_a.len() != told_b.len() {
        return Some(format!("{} events became {}", told_a.len(), told_b.len()));
    }
    for ((what, x, factor), (_, y, _)) in lists(a, units).into_iter().zip(lists(b, units)) {
        let size = x.iter().fold(0.0, |size: f64, x| size.max(x.abs()));
        let found = x.iter().zip(y).find_map(|(x, y)| differs(what, (*x, *y), factor, size));
        let count = (x.len() != y.len()).then(|| format!("{} knots became {}", x.len(), y.len()));
        if let Some(found) = found.or(count) {
            return Some(found);
        }
    }
    for column in a.demands.shape().columns() {
        let name = column.name();
        if any_speed || !["stop.impact_count", "reversal_count"].contains(&name.as_str()) {
            let [x, y] = [a, b].map(|r| column.value(&r.demands).unwrap_or(f64::NAN));
            let size = match column.dimension() {
                // Which of two equal peaks is the first is decided by rounding.
                Some(Dimension::Time) if part > 0.0 && name.ends_with("displacement_time_s") => {
                    continue;
                }
                Some(Dimension::Time) => end_s,
                Some(Dimension::Length) => sizes.iter().fold(x.abs(), |size, s| size.max(*s)),
                _ => x.abs().max(1.0),
            };
            if let Some(found) = differs(&name, (x, y), units.of(&column), size) {
                return Some(found);
            }
        }
    }
    None
}

/// The first figure of a certificate that is not the same; impacts below 1 mm/s are no close calls.
fn other_certificate(a: &Certificate, b: &Certificate, units: Units) -> Option<String> {
    let [x, y] = [a, b].map(|c| c.closest_call.map(|call| call.kind));
    let of_impact = units.velocity() != 1.0 && [x, y].contains(&Some(DecisionKind::Impact));
    let figures = |c: &Certificate| {
        let call = c.closest_call.filter(|_| !of_impact);
        [
            ("bound", c.bound),
            ("equilibrium residual", c.equilibrium_residual),
            ("friction excess", c.friction_excess),
            ("energy balance error", c.energy_balance_error),
            ("demands error", c.demands_error),
            ("closest call", call.map_or(-1.0, |call| call.margin)),
            ("time of the closest call", call.map_or(-1.0, |call| call.time_s)),
        ]
    };
    let mut pairs = figures(a).into_iter().zip(figures(b));
    pairs.find_map(|((what, x), (_, y))| {
        let wanted = if what.starts_with("time") && x >= 0.0 { x * units.time } else { x };
        (wanted != y).then(|| format!("{what}: {x:e} became {y:e}"))
    })
}

/// Solves and certifies every system and its twin: every number is the same to the last bit.
fn exact_twins(units: Units, change: impl Fn(&Sketch) -> [Sketch; 2]) {
    let differ = |seed: u64| -> Option<String> {
        let [x, y] = change(&system(seed));
        match (solve(&x), solve(&y)) {
            (Ok(a), Ok(b)) => first_other(&a, &b, units, 0.0)
                .or_else(|| other_certificate(&certified(&x, &a), &certified(&y, &b), units)),
            (
                Err(SolveError::EndOfTravel { time_s: a, .. }),
                Err(SolveError::EndOfTravel { time_s: b, .. }),
            ) if a * units.time == b => None,
            (a, b) => Some(format!("{:?} became {:?}", a.err(), b.err())),
        }
    };
    report(seeds().filter_map(|seed| Some((seed, differ(seed)?))).collect());
}

fn certified(x: &Sketch, response: &Response) -> Certificate {
    let (model, motion) = x.build();
    check(&model, &motion, response)
}

/// A certificate that does not hold.
fn alarm(x: &Sketch, response: &Response) -> Option<String> {
    let c = certified(x, response);
    let figures =
        [c.equilibrium_residual, c.friction_excess, c.energy_balance_error, c.demands_error];
    (!c.holds()).then(|| format!("{figures:?} above {}", c.bound))
}

/// Solves every system and its twin in other units of length or time: every number is the same to rounding,
/// and both are certified.
fn twins_in_units(units: Units, change: impl Fn(&Sketch) -> [Sketch; 2]) {
    let differ = |seed: u64| -> Option<String> {
        let [x, y] = change(&system(seed));
        let (a, b) = match (solve(&x), solve(&y)) {
            (Ok(a), Ok(b)) => (a, b),
            (Err(SolveError::EndOfTravel { .. }), Err(SolveError::EndOfTravel { .. })) => {
                return None;
            }
            (a, b) => return Some(format!("{:?} became {:?}", a.err(), b.err())),
        };
        alarm(&x, &a)
            .or_else(|| alarm(&y, &b))
            .or_else(|| first_other(&a, &b, units, ROUNDING).filter(|_| moved(&x, &a) <= TOLERANCE))
    };
    report(seeds().filter_map(|seed| Some((seed, differ(seed)?))).collect());
}

fn report(failures: Vec<(u64, String)>) {
    let lines: Vec<String> =
        failures.iter().map(|(seed, what)| format!("{seed}: {what}")).collect();
    assert!(
        lines.is_empty(),
        "{} of {} differ:\n{}",
        lines.len(),
        seeds().count(),
        lines.join("\n")
    );
}

/// Figures of a response with their names and sizes: states at the rows of given times, demands.
fn figures(response: &Response, times_s: &[f64]) -> Vec<(String, f64, f64)> {
    let (h, d) = (response.history.as_ref().expect("a history"), &response.demands);
    let mut list = Vec::new();
    let fastest = |list: &[f64]| list.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    let rates = [&h.storey_velocity_m_per_s, &h.contents_velocity_m_per_s].map(|v| fastest(v));
    let mut rows = h.rows.iter();
    for time_s in times_s {
        let row = *rows.find(|row| h.time_s[**row] == *time_s).expect("a row of each sample");
        let mut state = |name: &str, value: f64, size: f64| {
            list.push((format!("{name} at {time_s} s"), value, size));
        };
        state("s", h.sliding_displacement_m[row], d.peak_sliding_displacement_m);
        state("ds/dt", h.sliding_velocity_m_per_s[row], d.peak_sliding_velocity_m_per_s);
        for i in 0..h.storeys {
            state("q", h.storey_displacements(row)[i], d.storeys[i].peak_displacement_m);
            state("dq/dt", h.storey_velocities(row)[i], rates[0]);
        }
        for (e, contents) in d.contents.iter().enumerate() {
            let [r, w, _] = h.contents_state(row, e);
            state("r", r, contents.peak_sliding_displacement_m);
            state("dr/dt", w, rates[1]);
        }
    }
    let columns = d.shape().columns();
    let end_s = times_s[times_s.len() - 1];
    for column in &columns {
        let (name, value) = (column.name(), column.value(d).unwrap_or(f64::NAN));
        // Of the same part and quantity.
        let peak =
            ["residual_", "max_", "min_"].iter().fold(name.clone(), |n, w| n.replace(w, "peak_"));
        let size = columns.iter().find(|other| other.name() == peak).and_then(|peak| peak.value(d));
        let size = match column.dimension() {
            // Which of two equal peaks is the first is decided by rounding.
            Some(Dimension::Time) if name.ends_with("displacement_time_s") => continue,
            // A stick as short as the root of rounding may or may not be told.
            Some(Dimension::Time) => 100.0 * end_s,
            // A margin measures nothing of the motion.
            None if name == "closest_stop" => continue,
            _ => size.unwrap_or(value).abs(),
        };
        list.push((name, value, size));
    }
    list
}

/// The figure in which two responses differ most, of those that both have, at the rows of the first.
fn difference(a: &Response, b: &Response, but_for: &[&str]) -> (f64, String) {
    let h = a.history.as_ref().expect("a history");
    let times_s: Vec<f64> = h.rows.iter().map(|row| h.time_s[*row]).collect();
    let mut others = figures(b, &times_s).into_iter();
    let mut worst = (0.0, String::new());
    for (name, x, size) in figures(a, &times_s) {
        let Some((_, y, _)) = others.find(|(other, ..)| *other == name) else { continue };
        if x == y || (x.is_nan() && y.is_nan()) || but_for.iter().any(|word| name.contains(word)) {
            continue;
        }
        let error = (x - y).abs() / size;
        // NaN must not vanish.
        if !(error <= worst.0) {
            worst = (error, format!("{name}: {x:e} became {y:e}"));
        }
    }
    worst
}

/// By how much a change of the input by 1e-12 moves the figures; infinite where one has no answer.
fn moved(x: &Sketch, response: &Response) -> f64 {
    let by =
        |x: &Sketch| solve(x).map_or(f64::INFINITY, |other| difference(response, &other, &[]).0);
    x.perturbed(PERTURBATION).iter().map(by).fold(0.0, f64::max)
}

/// Solves every system that has a twin, and compares where the answer is well determined.
fn twins(change: impl Fn(&mut Sketch, &mut Random) -> Option<Sketch>) {
    twins_but_for(&[], change);
}

/// The same, but for figures in whose names one of some words is. Returns those that differ and are ill
/// determined.
fn twins_but_for(
    others: &[&str],
    change: impl Fn(&mut Sketch, &mut Random) -> Option<Sketch>,
) -> Vec<(u64, Sketch)> {
    let (mut compared, mut largest) = (0_u32, 0.0_f64);
    let (mut ill, mut failures) = (Vec::new(), Vec::new());
    for seed in seeds() {
        let mut x = system(seed);
        let Some(twin) = change(&mut x, &mut Random::new(seed)) else { continue };
        let answers = (solve(&x), solve(&twin));
        let (error, what) = match &answers {
            (Ok(a), Ok(b)) => difference(a, b, others),
            (Err(SolveError::EndOfTravel { .. }), Err(SolveError::EndOfTravel { .. })) => continue,
            (a, b) => {
                let refused = [a, b].map(|answer| answer.as_ref().err());
                (f64::INFINITY, format!("{refused:?}"))
            }
        };
        let alarms = [(&x, &answers.0), (&twin, &answers.1)]
            .into_iter()
            .find_map(|(x, answer)| alarm(x, answer.as_ref().ok()?));
        if let Some(alarm) = alarms {
            failures.push((seed, alarm));
        } else if error <= TOLERANCE {
            compared += 1;
            largest = largest.max(error);
        } else if answers.0.is_ok_and(|response| !(moved(&x, &response) <= TOLERANCE)) {
            ill.push((seed, x));
        } else {
            failures.push((seed, format!("off by {error:.1e}, {what}")));
        }
    }
    let seeds: Vec<u64> = ill.iter().map(|(seed, _)| *seed).collect();
    println!(
        "{compared} agree to {largest:.1e} of the peaks, {} ill determined {seeds:?}",
        ill.len()
    );
    report(failures);
    assert!(compared >= 20, "only {compared} compared");
    ill
}

/// Everything the other way round: every number is, to the last bit.
#[test]
fn prop_mirror_negates_every_number() {
    let differ = |seed: u64| -> Option<String> {
        let x = system(seed);
        let y = x.mirrored();
        match (solve(&x), solve(&y)) {
            (Ok(a), Ok(b)) => {
                let certificates = [certified(&x, &a), certified(&y, &b)];
                first_other(&a, &turned(b), Units::SAME, 0.0)
                    .or_else(|| other_certificate(&certificates[0], &certificates[1], Units::SAME))
            }
            (a, b) => {
                let [a, b] = [a.err(), b.err()];
                (a != b).then(|| format!("{a:?} became {b:?}"))
            }
        }
    };
    report(seeds().filter_map(|seed| Some((seed, differ(seed)?))).collect());
}

/// A response seen from the other side.
fn turned(mut response: Response) -> Response {
    let other = |mode: &mut Mode| {
        if let Mode::Slip(direction) = mode {
            *direction = direction.opposite();
        }
    };
    let negate = |list: &mut Vec<f64>| list.iter_mut().for_each(|x| *x = -*x);
    let d = &mut response.demands;
    (d.max_sliding_displacement_m, d.min_sliding_displacement_m) =
        (-d.min_sliding_displacement_m, -d.max_sliding_displacement_m);
    d.residual_sliding_displacement_m *= -1.0;
    d.surfaces.iter_mut().for_each(|u| u.residual_displacement_m *= -1.0);
    d.contents.iter_mut().for_each(|r| r.residual_sliding_displacement_m *= -1.0);
    for event in &mut response.events {
        event.sliding_displacement_m *= -1.0;
        other(&mut event.mode);
    }
    let h = response.history.as_mut().expect("a history");
    h.mode.iter_mut().for_each(other);
    for contact in &mut h.contact {
        *contact = match *contact {
            Contact::Free => Contact::Free,
            Contact::Pressed(side) => Contact::Pressed(side.opposite()),
            Contact::Separated(side) => Contact::Separated(side.opposite()),
        };
    }
    for list in [
        &mut h.table_acceleration_m_per_s2,
        &mut h.sliding_displacement_m,
        &mut h.sliding_velocity_m_per_s,
        &mut h.block_acceleration_m_per_s2,
        &mut h.friction_force_n,
        &mut h.storey_displacement_m,
        &mut h.storey_velocity_m_per_s,
        &mut h.storey_acceleration_m_per_s2,
        &mut h.surface_displacement_m,
        &mut h.contents_displacement_m,
        &mut h.contents_velocity_m_per_s,
        &mut h.contents_acceleration_m_per_s2,
    ] {
        negate(list);
    }
    response
}

/// 2¹⁰: no number is rounded by it.
const MANY: f64 = 1024.0;

fn in_units(units: Units) {
    let Units { mass, length, time, .. } = units;
    let twins = |x: &Sketch| [x.clone(), x.in_units(mass, length, time)];
    if (length, time) == (1.0, 1.0) {
        exact_twins(units, twins)
    } else {
        twins_in_units(units, twins)
    }
}

#[test]
fn prop_mass_in_other_units() {
    in_units(Units { mass: MANY, ..Units::SAME });
}

#[test]
fn prop_length_in_larger_units() {
    in_units(Units { length: 1.0 / MANY, ..Units::SAME });
}

#[test]
fn prop_length_in_smaller_units() {
    in_units(Units { length: MANY, ..Units::SAME });
}

/// Displacements stay, gravity does not.
#[test]
fn prop_time_in_larger_units() {
    in_units(Units { time: 1.0 / MANY, ..Units::SAME });
}

#[test]
fn prop_time_in_smaller_units() {
    in_units(Units { time: MANY, ..Units::SAME });
}

/// Accelerations stay, gravity too: a model of another size.
#[test]
fn prop_smaller_is_faster() {
    in_units(Units { length: 1.0 / (MANY * MANY), time: 1.0 / MANY, ..Units::SAME });
}

#[test]
fn prop_larger_is_slower() {
    in_units(Units { length: MANY * MANY, time: MANY, ..Units::SAME });
}

/// The same straight lines with more samples are the same motion.
#[test]
fn prop_collinear_samples_change_nothing() {
    const PARTS: usize = 5;
    twins(|x, _| {
        let mut twin = x.clone();
        let lists = [Some(&mut twin.times), Some(&mut twin.horizontal), twin.vertical.as_mut()];
        for list in lists.into_iter().flatten() {
            let fine = |pair: &[f64]| {
                let (from, by) = (pair[0], (pair[1] - pair[0]) / PARTS as f64);
                (0..PARTS).map(|k| from + by * k as f64).collect::<Vec<_>>()
            };
            let last = list[list.len() - 1];
            let jumps: Vec<bool> = x.times.windows(2).map(|p| p[0] == p[1]).collect();
            let parts = list.windows(2).zip(jumps);
            *list = parts
                .flat_map(|(pair, jump)| if jump { vec![pair[0]] } else { fine(pair) })
                .chain([last])
                .collect();
        }
        Some(twin)
    });
}

/// A stop that is never reached is not there.
#[test]
fn prop_a_far_stop_changes_nothing() {
    twins(|x, random| {
        x.stop = None;
        let far_m = 1e3 * x.series.as_ref().and_then(SurfacesInSeries::travel_m).unwrap_or(1.0);
        let kind = if random.chance(0.5) {
            StopKind::Rigid { restitution: 0.5 }
        } else {
            StopKind::Elastic { stiffness_n_per_m: 1e3 * x.block, damper_n_s_per_m: 0.0 }
        };
        Some(Sketch { stop: Some(Stop { gap_m: [Some(far_m); 2], kind }), ..x.clone() })
    });
}

/// Friction by speed of one coefficient is friction.
#[test]
fn prop_constant_pieces_are_constant_friction() {
    twins(|x, random| {
        x.rate = None;
        x.series.is_none().then(|| {
            let mut twin = x.clone();
            let coefficients = vec![x.kinetic_friction[0]; 3];
            let speeds_m_per_s = vec![0.0, random.between(0.01, 0.1), random.between(0.2, 0.5)];
            twin.set_curve(RateCurve::Pieces { speeds_m_per_s, coefficients });
            x.kinetic_friction = twin.kinetic_friction;
            x.static_friction = twin.static_friction;
            twin
        })
    });
}

/// Surfaces in series that are all alike are one; their friction force is the whole of what they pass on.
#[test]
fn prop_equal_surfaces_are_one_pendulum() {
    twins_but_for(&["friction"], |x, random| {
        let radius_m = random.of(&[0.5, 1.0, 2.0]);
        let (friction, static_ratio) = (x.kinetic_friction[0], random.of(&[1.0, 1.25]));
        x.rate = None;
        x.series = None;
        x.radius_m = Some(radius_m);
        x.kinetic_friction = [friction; 2];
        x.static_friction = [friction * static_ratio; 2];
        let count = random.of(&[1, 1, 2]);
        let surface =
            Surface { radius_m: Some(radius_m / f64::from(count)), friction, travel_m: None };
        let mut twin = x.clone();
        twin.radius_m = None;
        twin.spring = 0.0;
        let surfaces = vec![surface; count as usize];
        twin.series = Some(SurfacesInSeries::new(surfaces, static_ratio).expect("surfaces"));
        Some(twin)
    });
}

/// A ground that does not move up and down moves as if nothing were said of it.
#[test]
fn prop_a_vertical_record_of_zeros_changes_nothing() {
    twins(|x, _| {
        x.vertical = None;
        Some(Sketch { vertical: Some(vec![0.0; x.times.len()]), ..x.clone() })
    });
}

/// Motion, friction, gaps, speeds and start times a factor on a level surface.
#[test]
fn prop_stronger_over_rougher_is_the_same_story() {
    for factor in [MANY, 1.0 / MANY] {
        let units = Units { length: factor, coefficient: factor, ..Units::SAME };
        twins_in_units(units, |x| {
            let x = Sketch { tilt: 0.0, ..x.clone() };
            let twin = x.louder(factor);
            [x, twin]
        });
    }
}

/// A slope is an acceleration g sin θ under gravity g cos θ on a level surface. Reported accelerations
/// leave the slope out, and the weight is another.
#[test]
fn prop_tilt_is_an_acceleration() {
    twins_but_for(&["acceleration", "coefficient"], |x, random| {
        x.vertical = None;
        x.tilt = random.between(-0.02, 0.02);
        // The start written out: its default depends on the tilt.
        x.q = Some(x.model().initial_storey_displacement_m());
        let mut twin = x.clone();
        twin.gravity *= libm::cos(x.tilt);
        twin.tilt = 0.0;
        for a in &mut twin.horizontal {
            *a += x.gravity * libm::sin(x.tilt);
        }
        Some(twin)
    });
}

/// Two equal items of contents are one of their mass; where a breath decides, the certificate says so.
#[test]
fn prop_equal_contents_are_one_of_their_mass() {
    let ill = twins_but_for(&[], |x, random| {
        if x.contents.is_empty() {
            let friction = random.of(&[0.02, 0.05, 0.1, 0.2, 0.3]);
            let static_friction = friction * random.of(&[1.0, 1.0, 1.25]);
            let floor = random.integer(0, x.masses.len() as i64) as usize;
            let mass_kg = x.block * random.of(&[0.05, 0.2, 1.0]);
            let kinetic_friction = friction;
            x.contents = vec![Contents { floor, mass_kg, static_friction, kinetic_friction }];
        }
        let mut twin = x.clone();
        let contents = &mut twin.contents;
        contents[0].mass_kg *= 0.5;
        // Behind the others: their numbers stay.
        contents.push(contents[0]);
        Some(twin)
    });
    for (seed, x) in ill {
        let (model, motion) = x.build();
        let response = exact(&model, &motion).expect("a response");
        let call = check(&model, &motion, &response).closest_call.expect("a close call");
        assert!(call.margin < 1e-6, "{seed}: {call:?}");
    }
}
