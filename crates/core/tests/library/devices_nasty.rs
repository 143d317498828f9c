//! Random systems with all devices, compared with the plain reference for devices.

// What became of the systems, for people who look with --nocapture; a seed from outside to look for more.
#![allow(clippy::disallowed_macros, clippy::disallowed_methods, clippy::expect_used)]

use crate::common::devices::{Event, Reference, reference};
use crate::common::random_devices::{System, coincident, motion, system};
use slipstick::error::SolveError;
use slipstick::model::{Model, StopKind};
use slipstick::motion::GroundMotion;
use slipstick::response::{EventKind, Response};
use slipstick::slider::RateCurve;
use slipstick::solver::exact;

/// Largest difference, over the peak of each quantity.
const TOLERANCE: f64 = 1e-9;
/// Relative change of the input that must move a well-determined result by less.
const PERTURBATION: f64 = 1e-12;

/// What became of a comparison.
enum Verdict {
    /// Everything within the tolerance; the largest difference.
    Agrees(Box<Reference>, f64),
    /// Something differs, but a change of the input by 1e-12 moves figures of the reference by more than
    /// the tolerance, or changes its events.
    IllDetermined,
    /// Contact with the ground is lost.
    Lost,
    Differs(String),
}

/// A named number and the size it is measured by.
type Figure = (&'static str, f64, f64);

fn figures(model: &Model, r: &Reference) -> Vec<Figure> {
    let p = &r.peaks;
    let (n, count) = (p.q.len(), p.contents.len());
    let mut names = vec![("s", p.s), ("ds/dt", p.w)];
    names.extend(p.q.iter().map(|q| ("q", *q)));
    names.extend(p.v.iter().map(|v| ("dq/dt", *v)));
    names.extend(p.contents.iter().map(|x| ("r", x[0])));
    names.extend(p.contents.iter().map(|x| ("dr/dt", x[1])));
    names.extend(p.surfaces.iter().map(|u| ("u", *u)));
    let mut list: Vec<Figure> = Vec::new();
    for x in &r.samples {
        list.extend(
            names.iter().zip(&x.values).map(|((name, size), value)| (*name, *value, *size)),
        );
    }
    let end_s = r.samples[r.samples.len() - 1].time_s;
    for (name, value) in [
        ("peak s", p.s),
        ("peak ds/dt", p.w),
        ("peak block acceleration", p.block),
        ("peak friction", p.friction),
        ("peak slider force", p.slider),
        ("peak base shear", p.shear),
        ("path", r.path[0]),
    ] {
        list.push((name, value, value));
    }
    list.push(("sliding time", r.sliding_time_s[0], end_s));
    for i in 0..n {
        for (name, value) in [
            ("peak q", p.q[i]),
            ("peak drift", p.drift[i]),
            ("peak floor acceleration", p.floors[i]),
        ] {
            list.push((name, value, value));
        }
    }
    for e in 0..count {
        let [r_m, z, a] = p.contents[e];
        for (name, value) in [
            ("peak r", r_m),
            ("peak dr/dt", z),
            ("peak contents acceleration", a),
            ("contents path", r.path[1 + e]),
        ] {
            list.push((name, value, value));
        }
        list.push(("contents sliding time", r.sliding_time_s[1 + e], end_s));
    }
    for u in &p.surfaces {
        list.push(("peak u", *u, *u));
    }
    if model.stop().is_some() {
        list.push(("peak stop force", p.stop, p.slider));
        list.push(("impact speed", r.impact_speed, r.impact_speed));
        list.push(("contact time", r.contact_time_s, end_s));
    }
    list
}

/// The same numbers of a response.
fn values(model: &Model, response: &Response) -> Vec<f64> {
    let d = &response.demands;
    let h = response.history.as_ref().expect("a history");
    let mut list = Vec::new();
    for &row in &h.rows {
        list.extend([h.sliding_displacement_m[row], h.sliding_velocity_m_per_s[row]]);
        list.extend(h.storey_displacements(row));
        list.extend(h.storey_velocities(row));
        for part in 0..2 {
            list.extend((0..h.contents()).map(|e| h.contents_state(row, e)[part]));
        }
        list.extend(h.surface_displacements(row));
    }
    list.extend([
        d.peak_sliding_displacement_m,
        d.peak_sliding_velocity_m_per_s,
        d.peak_block_acceleration_m_per_s2,
        d.peak_friction_force_n,
        d.peak_slider_force_n,
        d.peak_base_shear_n,
        d.sliding_path_m,
        d.sliding_time_s,
    ]);
    for storey in &d.storeys {
        list.extend([
            storey.peak_displacement_m,
            storey.peak_drift_m,
            storey.peak_acceleration_m_per_s2,
        ]);
    }
    for contents in &d.contents {
        list.extend([
            contents.peak_sliding_displacement_m,
            contents.peak_sliding_velocity_m_per_s,
            contents.peak_acceleration_m_per_s2,
            contents.sliding_path_m,
            contents.sliding_time_s,
        ]);
    }
    list.extend(d.surfaces.iter().map(|surface| surface.peak_displacement_m));
    if model.stop().is_some() {
        let stop = d.stop.expect("a stop");
        list.extend([stop.peak_force_n, stop.peak_impact_speed_m_per_s, stop.contact_time_s]);
    }
    list
}

/// Events in the order of their interfaces: at one instant their order is a matter of form.
fn by_interface(events: &[Event]) -> Vec<Event> {
    let mut list = events.to_vec();
    list.sort_by_key(|event| event.interface);
    list
}

fn of_response(response: &Response) -> Vec<Event> {
    let event = |e: &slipstick::response::Event| Event {
        time_s: e.time_s,
        interface: e.interface,
        kind: e.kind,
        sign: e.mode.sign() as i32,
    };
    by_interface(&response.events.iter().map(event).collect::<Vec<_>>())
}

/// Where two lists of events first differ in more than the last digits of their times.
fn first_difference(a: &[Event], b: &[Event], slack_s: f64) -> Option<String> {
    let same = |x: &Event, y: &Event| {
        x.kind == y.kind
            && x.sign == y.sign
            && x.interface == y.interface
            && (x.time_s - y.time_s).abs() <= slack_s
    };
    let at = a.iter().zip(b).position(|(x, y)| !same(x, y));
    let at = at.or((a.len() != b.len()).then_some(a.len().min(b.len())))?;
    let near = |list: &[Event]| {
        let from = at.saturating_sub(2);
        format!("{:?}", &list[from.min(list.len())..(at + 3).min(list.len())])
    };
    Some(format!("event {at}: expected {}, found {}", near(a), near(b)))
}

/// The first figure that differs, or the largest difference.
fn worst_difference(wanted: &[Figure], found: &[f64]) -> Result<f64, String> {
    if wanted.len() != found.len() {
        return Err(format!("{} figures expected, {} found", wanted.len(), found.len()));
    }
    let mut worst = 0.0_f64;
    for ((name, value, size), found) in wanted.iter().zip(found) {
        let error = (found - value).abs();
        // NaN must fail.
        if !(error <= TOLERANCE * size) {
            return Err(format!(
                "{name}: expected {value:e}, found {found:e}, off by {:.1e} of its peak",
                error / size
            ));
        }
        if *size > 0.0 {
            worst = worst.max(error / size);
        }
    }
    Ok(worst)
}

/// Whether changes of the input by 1e-12 leave the reference's answer as it is.
fn is_determined(system: &System, expected: &Reference) -> bool {
    let factor = 1.0 + PERTURBATION;
    let rougher = system.model.with_friction_times(factor).expect("a model");
    let mut up = false;
    let mut shaken = |list: &[f64]| -> Vec<f64> {
        let moved = list.iter().map(|a| {
            up = !up;
            a * if up { factor } else { 1.0 - PERTURBATION }
        });
        moved.collect()
    };
    let horizontal = shaken(&system.horizontal);
    let vertical = system.vertical.as_deref().map(&mut shaken);
    let other = GroundMotion::new(system.times_s.clone(), horizontal, vertical).expect("a motion");
    let wanted = figures(&system.model, expected);
    let end_s = system.times_s[system.times_s.len() - 1];
    [(&rougher, &motion(system, 1.0)), (&system.model, &other)].into_iter().all(
        |(model, motion)| {
            let Some(moved) = reference(model, motion) else { return false };
            let events = [expected, &moved].map(|r| by_interface(&r.events));
            let found: Vec<f64> = figures(model, &moved).iter().map(|figure| figure.1).collect();
            expected.end_of_travel_s.is_some() == moved.end_of_travel_s.is_some()
                && first_difference(&events[0], &events[1], TOLERANCE * end_s).is_none()
                && worst_difference(&wanted, &found).is_ok()
        },
    )
}

fn differences(system: &System, expected: &Reference) -> Result<f64, String> {
    let end_s = system.times_s[system.times_s.len() - 1];
    let slack_s = TOLERANCE * end_s;
    let response = match exact(&system.model, &motion(system, 1.0)) {
        Ok(response) => response,
        Err(SolveError::EndOfTravel { time_s, .. }) => {
            return match expected.end_of_travel_s {
                Some(wanted_s) if (time_s - wanted_s).abs() <= slack_s => Ok(0.0),
                wanted_s => Err(format!("end of travel: expected {wanted_s:?}, found {time_s}")),
            };
        }
        Err(error) => return Err(error.to_string()),
    };
    if let Some(time_s) = expected.end_of_travel_s {
        return Err(format!("end of travel: expected at {time_s}, found none"));
    }
    let told = of_response(&response);
    if let Some(difference) = first_difference(&by_interface(&expected.events), &told, slack_s) {
        return Err(difference);
    }
    let wanted = figures(&system.model, expected);
    let worst = worst_difference(&wanted, &values(&system.model, &response))?;
    if let Some(stop) = response.demands.stop {
        let kinds = [EventKind::Impact, EventKind::Contact].map(|kind| expected.count(kind) as u64);
        if [stop.impact_count, stop.contact_count] != kinds {
            return Err(format!("impacts and contacts: expected {kinds:?}, found {stop:?}"));
        }
    }
    Ok(worst)
}

fn judge(system: &System) -> Verdict {
    let Some(expected) = reference(&system.model, &motion(system, 1.0)) else {
        return Verdict::Lost;
    };
    match differences(system, &expected) {
        Ok(worst) => Verdict::Agrees(Box::new(expected), worst),
        Err(_) if !is_determined(system, &expected) => Verdict::IllDetermined,
        Err(difference) => Verdict::Differs(difference),
    }
}

/// The devices of a model, in words.
fn devices(system: &System) -> String {
    let (model, slider) = (&system.model, system.model.slider());
    let mut words = Vec::new();
    match model.stop().map(|stop| stop.kind) {
        Some(StopKind::Elastic { .. }) => words.push("elastic stop"),
        Some(StopKind::Rigid { .. }) => words.push("rigid stop"),
        None => {}
    }
    match slider.rate().map(|rate| rate.curve()) {
        Some(RateCurve::Pieces { .. }) => words.push("pieces"),
        Some(RateCurve::Exponential { .. }) => words.push("exponential"),
        None => {}
    }
    if slider.series().is_some() {
        words.push("surfaces");
    }
    if slider.radius_m().is_some() {
        words.push("pendulum");
    }
    if !model.contents().is_empty() {
        words.push("contents");
    }
    if system.vertical.is_some() {
        words.push("vertical");
    }
    words.join(", ")
}

/// Kinds of events of the slider that must occur in one of twenty systems.
const KINDS: [EventKind; 6] = [
    EventKind::Contact,
    EventKind::Separation,
    EventKind::Impact,
    EventKind::Rest,
    EventKind::Surface,
    EventKind::Reversal,
];

/// Judges the systems of some seeds; at most one of two hundred may be ill determined.
fn judged(seeds: std::ops::Range<u64>) {
    let count = seeds.end - seeds.start;
    let (mut agree, mut lost, mut worst, mut largest) = (0, 0, 0.0_f64, 0);
    let (mut occurred, mut shaken, mut ends) = ([0; KINDS.len()], 0, 0);
    let (mut ill, mut failures) = (Vec::new(), Vec::new());
    for seed in seeds {
        let system = system(seed);
        match judge(&system) {
            Verdict::Agrees(expected, error) => {
                agree += 1;
                for (number, kind) in occurred.iter_mut().zip(KINDS) {
                    *number += u64::from(expected.count(kind) > 0);
                }
                shaken += u64::from(expected.events.iter().any(|event| event.interface > 0));
                ends += u64::from(expected.end_of_travel_s.is_some());
                if error > worst {
                    (worst, largest) = (error, seed);
                }
            }
            Verdict::IllDetermined => ill.push(seed),
            Verdict::Lost => lost += 1,
            Verdict::Differs(what) => {
                failures.push(format!("{seed} ({}): {what}", devices(&system)));
            }
        }
    }
    println!(
        "{count} systems: {agree} agree (largest difference {worst:.1e} of a peak, seed {largest}), \
         {} ill determined {ill:?}, {lost} lose contact, {} differ; {KINDS:?} in {occurred:?}, contents \
         slide in {shaken}, {ends} run out of travel",
        ill.len(),
        failures.len()
    );
    assert!(failures.is_empty(), "{} differ:\n{}", failures.len(), failures.join("\n"));
    assert!(lost == 0 && 200 * ill.len() as u64 <= count);
    let often = |number: &u64| 20 * *number >= count;
    assert!(occurred.iter().all(often) && often(&shaken), "{KINDS:?} in {occurred:?}");
}

#[test]
fn reference_nasty_devices() {
    judged(0..500);
}

fn agree(seeds: &[u64]) {
    let failures: Vec<String> = seeds
        .iter()
        .filter_map(|&seed| match judge(&system(seed)) {
            Verdict::Agrees(..) => None,
            Verdict::Differs(what) => Some(format!("{seed}: {what}")),
            Verdict::IllDetermined | Verdict::Lost => Some(format!("{seed}: not determined")),
        })
        .collect();
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// Systems in which much coincides: what the solver calls equal to rounding, the reference calls equal
/// to 1e-26. Where a change of the input by 1e-12 makes another story, both must still tell the same.
fn coincident_agree(seeds: std::ops::Range<u64>) {
    let failures: Vec<String> = seeds
        .filter_map(|seed| {
            let system = coincident(seed);
            let expected = reference(&system.model, &motion(&system, 1.0)).expect("contact");
            differences(&system, &expected).err().map(|what| format!("{seed}: {what}"))
        })
        .collect();
    assert!(failures.is_empty(), "{} differ:\n{}", failures.len(), failures.join("\n"));
}

#[test]
fn reference_coincident_contents() {
    coincident_agree(0..1000);
}

/// The same of ten thousand.
#[test]
#[ignore = "minutes: cargo xtask nightly"]
fn reference_many_coincident_contents() {
    coincident_agree(0..10_000);
}

/// Systems that would run out of travel if their rigid stop were not there.
#[test]
fn reference_rigid_stops_before_the_end_of_travel() {
    agree(&[1734, 2149, 6133, 6697, 7504, 9523, 9757, 15_854]);
}

/// Bounces below the rounding of a surface that is at its end: it slides on the way out, and back.
#[test]
fn reference_bounces_off_a_rigid_stop_with_a_surface_at_its_end() {
    agree(&[8425, 12_726, 12_980]);
}

/// The same of ten thousand; `SLIPSTICK_SEEDS=0..20000` takes others.
#[test]
#[ignore = "minutes: cargo xtask nightly"]
fn reference_nasty_many_devices() {
    let given = std::env::var("SLIPSTICK_SEEDS").unwrap_or_default();
    let range =
        given.split_once("..").and_then(|(from, to)| Some(from.parse().ok()?..to.parse().ok()?));
    judged(range.unwrap_or(0..10_000));
}
