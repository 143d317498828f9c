//! Corners in which several interfaces decide at one instant, or nothing presses.

// Helpers of tests may panic as tests do.
#![allow(clippy::expect_used)]

use crate::common::random::Random as Stream;
use crate::common::random_devices::{System, coincident, motion};
use crate::common::sketch::Sketch;
use slipstick::check::check;
use slipstick::error::SolveError;
use slipstick::input;
use slipstick::model::{Contents, Model, Stop, StopKind};
use slipstick::motion::GroundMotion;
use slipstick::notice::NoticeKind;
use slipstick::response::{Demands, Response};
use slipstick::solver::exact;
use slipstick::study::Random;

/// Part of the peak by which figures of systems that are the same but for rounding may differ.
const SAME: f64 = 1e-8;

fn model(slider: &str, more: &str) -> Model {
    let text = format!("[block]\nmass = \"100 kg\"\n[slider]\n{slider}\n{more}");
    input::parse("m.toml", &text, &[]).expect("a model").model
}

fn contents(mass_kg: f64, [static_friction, kinetic_friction]: [f64; 2]) -> String {
    format!(
        "[[contents]]\nfloor = 0\nmass = \"{mass_kg} kg\"\nstatic_friction = {static_friction}\n\
         kinetic_friction = {kinetic_friction}\n"
    )
}

fn friction([fixed, kinetic]: [f64; 2]) -> String {
    format!("static_friction = {fixed}\nkinetic_friction = {kinetic}")
}

fn ground(times_s: &[f64], horizontal: &[f64], vertical: Option<&[f64]>) -> GroundMotion {
    let vertical = vertical.map(<[f64]>::to_vec);
    GroundMotion::new(times_s.to_vec(), horizontal.to_vec(), vertical).expect("a motion")
}

fn response(model: &Model, motion: &GroundMotion) -> Response {
    exact(model, motion).expect("a response")
}

/// The figures of a certificate that does not hold.
fn alarm(model: &Model, motion: &GroundMotion, response: &Response) -> Option<String> {
    let c = check(model, motion, response);
    let figures =
        [c.equilibrium_residual, c.friction_excess, c.energy_balance_error, c.demands_error];
    (!c.holds()).then(|| format!("{figures:?}"))
}

/// The first figure in which two answers differ by more than a part of its size, which is that of the
/// first.
fn difference(a: &Demands, b: &Demands, part: f64) -> Option<String> {
    let size_m = a.peak_sliding_displacement_m.max(1e-6);
    let mut list = vec![
        ("peak s", a.peak_sliding_displacement_m, b.peak_sliding_displacement_m, size_m),
        (
            "residual s",
            a.residual_sliding_displacement_m,
            b.residual_sliding_displacement_m,
            size_m,
        ),
        ("path", a.sliding_path_m, b.sliding_path_m, a.sliding_path_m.max(1e-6)),
    ];
    for (a, b) in a.contents.iter().zip(&b.contents) {
        let size_m = a.peak_sliding_displacement_m.max(1e-6);
        list.extend([
            ("peak r", a.peak_sliding_displacement_m, b.peak_sliding_displacement_m, size_m),
            (
                "residual r",
                a.residual_sliding_displacement_m,
                b.residual_sliding_displacement_m,
                size_m,
            ),
        ]);
    }
    let off = list.into_iter().find(|(_, a, b, size)| (a - b).abs() > part * size)?;
    Some(format!("{}: {:e} and {:e}", off.0, off.1, off.2))
}

/// A model with the first of its contents cut in two.
fn cut(model: &Model, part: f64) -> Model {
    let mut list = model.contents().to_vec();
    let whole = list[0];
    list[0].mass_kg = part * whole.mass_kg;
    list.insert(1, Contents { mass_kg: (1.0 - part) * whole.mass_kg, ..whole });
    model.clone().with_contents(list).expect("contents")
}

fn two_are_one(seeds: std::ops::Range<u64>) {
    let mut wrong = Vec::new();
    for seed in seeds {
        let System { model, .. } = &coincident(seed);
        let motion = motion(&coincident(seed), 1.0);
        let (one, two) = (response(model, &motion), response(&cut(model, 0.375), &motion));
        let mut demands = two.demands.clone();
        let twin = demands.contents.remove(1);
        if twin != demands.contents[0] {
            wrong.push(format!("{seed}: the two part"));
        }
        wrong.extend(difference(&one.demands, &demands, SAME).map(|off| format!("{seed}: {off}")));
    }
    assert!(wrong.is_empty(), "{} wrong:\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn prop_two_equal_items_are_one_of_their_mass() {
    two_are_one(0..100);
}

#[test]
#[ignore = "a minute: cargo xtask nightly"]
fn prop_two_equal_items_are_one_of_their_mass_in_many_models() {
    two_are_one(0..1000);
}

/// Block and contents with one coefficient slide as one: neither lets the other go.
#[test]
fn contents_with_the_sliders_friction_stay() {
    for (mu, mass_kg) in [(0.1, 20.0), (0.05, 50.0), (0.15, 160.0)] {
        for list in [
            [0.0, -0.2, -3.7, 0.4, 2.9],
            [0.0, 1.3, -3.1, -2.7, 0.0],
            [0.0, -2.8, 2.7, -0.1, 2.5],
            [2.0, 2.7, -2.6, 1.0, 0.0],
        ] {
            let motion = ground(&[0.0, 0.5, 1.0, 1.5, 2.0], &list, None);
            let both = model(&friction([mu; 2]), &contents(mass_kg, [mu; 2]));
            let found = response(&both, &motion);
            let alone = response(&model(&friction([mu; 2]), ""), &motion);
            let (d, e) = (&found.demands, &alone.demands);
            assert_eq!((d.contents[0].slip_count, d.contents[0].sliding_path_m), (0, 0.0));
            assert_eq!((d.slip_count, d.stick_count), (e.slip_count, e.stick_count));
            let off = (d.peak_sliding_displacement_m - e.peak_sliding_displacement_m).abs();
            assert!(off <= 1e-13 * e.peak_sliding_displacement_m, "{d:?} {e:?}");
        }
    }
}

/// Contents slide at 0.065 g, where the block could still hold them: the block keeps still.
#[test]
fn contents_that_let_go_hold_the_block_back() {
    let slider = friction([0.438, 0.373]);
    let model = model(&slider, &contents(7.4, [0.066; 2]));
    let jump = response(&model, &ground(&[0.0, 0.5, 1.0], &[4.3, 4.3, 0.0], None));
    assert_eq!(jump.demands.slip_count, 0);
    assert!(!jump.warnings.iter().any(|w| w.kind == NoticeKind::SlipsAtStart), "the contents slip");
    let later = ground(&[0.0, 0.25, 0.25, 0.5, 1.0], &[0.0, 0.0, 4.3, 4.3, 0.0], None);
    assert_eq!(response(&model, &later).demands.slip_count, 0);
}

/// A motion with each jump as a ramp of this length.
fn ramped(system: &System, ramp_s: f64) -> GroundMotion {
    let (mut times_s, mut values) = (vec![0.0], vec![0.0]);
    let mut last_s = f64::NEG_INFINITY;
    for (time_s, value) in system.times_s.iter().zip(&system.horizontal) {
        if *time_s == last_s || (*time_s == 0.0 && *value != 0.0) {
            times_s.push(time_s + ramp_s);
        } else if *time_s > 0.0 {
            times_s.push(*time_s);
        } else {
            continue;
        }
        values.push(*value);
        last_s = *time_s;
    }
    ground(&times_s, &values, None)
}

/// Whether a sliding block may carry contents with just their own kinetic friction: the velocity that a
/// ramp gave them then stays. In the limit it is zero, and they stick.
fn keeps_a_velocity(model: &Model) -> bool {
    let [kinetic, _] = model.kinetic_friction();
    let has_drop = |c: &Contents| c.static_friction > c.kinetic_friction;
    let contents = model.contents();
    contents.iter().any(|c| c.kinetic_friction == kinetic)
        && (model.static_friction()[0] > kinetic || contents.iter().any(has_drop))
}

fn jumps_are_ramps(seeds: std::ops::Range<u64>) {
    let (mut wrong, mut compared, mut known) = (Vec::new(), 0, 0);
    let mut alarms = Vec::new();
    for seed in seeds {
        let system = coincident(seed);
        if keeps_a_velocity(&system.model) {
            continue;
        }
        known += 1;
        let jump = response(&system.model, &motion(&system, 1.0)).demands;
        let [coarse, fine, finer] = [1e-6, 1e-8, 1e-9].map(|ramp_s| {
            let motion = ramped(&system, ramp_s);
            let found = response(&system.model, &motion);
            let alarm = alarm(&system.model, &motion, &found);
            alarms.extend(alarm.map(|c| format!("{seed}, a ramp of {ramp_s} s: {c}")));
            found.demands
        });
        // Ramps that do not agree with each other tell nothing of their limit.
        if difference(&finer, &coarse, 1e-3).or(difference(&finer, &fine, 1e-5)).is_some() {
            continue;
        }
        compared += 1;
        wrong.extend(difference(&finer, &jump, 1e-5).map(|off| format!("{seed}: {off}")));
    }
    assert!(wrong.is_empty(), "{} wrong:\n{}", wrong.len(), wrong.join("\n"));
    assert!(10 * compared >= 9 * known, "{compared} of {known} compared");
    assert!(alarms.is_empty(), "{} alarms:\n{}", alarms.len(), alarms.join("\n"));
}

#[test]
fn prop_a_jump_is_the_limit_of_steep_ramps() {
    jumps_are_ramps(0..100);
}

#[test]
#[ignore = "minutes: cargo xtask nightly"]
fn prop_a_jump_is_the_limit_of_steep_ramps_in_many_models() {
    jumps_are_ramps(0..3000);
}

/// Vertical motion that takes the contact away, and nothing that pushes: nothing slides.
#[test]
fn contact_lost_without_horizontal_motion_moves_nothing() {
    let motion = ground(&[0.0, 1.0, 2.0, 3.0], &[0.0; 4], Some(&[0.0, -30.0, -12.0, 5.0]));
    let slider = friction([0.2, 0.15]);
    for (slider, more) in [
        (slider.clone(), contents(20.0, [0.3, 0.2])),
        (format!("{slider}\nradius = \"2 m\""), String::new()),
        (slider.clone(), "[slider.stop]\ngap = \"0.1 m\"\nrestitution = 0.5\n".to_owned()),
        (slider, String::new()),
    ] {
        let found = response(&model(&slider, &more), &motion);
        assert_eq!(found.demands.sliding_path_m, 0.0, "{slider} {more}");
        assert!(found.events.is_empty(), "{:?}", found.events);
    }
}

/// The same for a block alone, wherever in its interval contact is lost.
#[test]
fn contact_lost_anywhere_moves_nothing() {
    let block = model(&friction([0.2; 2]), "");
    for depth in 10..60 {
        let up = [0.0, -f64::from(depth), -f64::from(depth)];
        let found = response(&block, &ground(&[0.0, 1.0, 2.0], &[0.0; 3], Some(&up)));
        assert!(found.events.is_empty(), "{depth}: {:?}", found.events);
    }
}

/// Motions far below all that friction holds, but for the instants at which contact is lost and regained.
#[test]
fn prop_tiny_motions_across_lost_contact_do_not_chatter() {
    let mut alarms = Vec::new();
    let surface = "[[slider.surface]]\nfriction = 0.2\n".to_owned();
    let shelf = |mu: f64| {
        format!(
            "[[contents]]\nfloor = 1\nmass = \"66 kg\"\nstatic_friction = {mu}\nkinetic_friction = {mu}\n"
        )
    };
    let storey = "[[storey]]\nmass = \"91 kg\"\nstiffness = \"54 kN/m\"\ndamper = \"0 N s/m\"\n";
    let shelves = format!("{storey}{}{}", shelf(0.21), shelf(0.32));
    for seed in 0..60 {
        let r = &mut Random::new(seed);
        let mut draw =
            |size: f64| -> Vec<f64> { (0..40).map(|_| size * (2.0 * r.uniform() - 1.0)).collect() };
        let size = [1e-14, 1e-10, 1e-7][seed as usize % 3];
        let (horizontal, up) = (draw(size), draw(25.0));
        let times_s: Vec<f64> = (0..40).map(|k| f64::from(k) / 32.0).collect();
        let motion = ground(&times_s, &horizontal, Some(&up));
        for (slider, more) in [
            (friction([0.2, 0.15]), contents(20.0, [0.3, 0.2])),
            (format!("{}\nradius = \"2 m\"", friction([0.2; 2])), contents(20.0, [0.2; 2])),
            (String::new(), surface.clone()),
            (friction([0.31, 0.248]), shelves.clone()),
        ] {
            let model = model(&slider, &more);
            let found = response(&model, &motion);
            assert!(found.events.len() < 400, "{seed}: {} events", found.events.len());
            alarms.extend(alarm(&model, &motion, &found).map(|c| format!("{seed}: {c}")));
        }
    }
    assert!(alarms.is_empty(), "{} alarms:\n{}", alarms.len(), alarms.join("\n"));
}

/// Pressed against a rigid stop from the start: in contact all the time.
#[test]
fn rest_at_a_rigid_stop_from_the_start_is_contact() {
    let stop = "[slider.stop]\ngap = { positive = \"0.1 m\", negative = \"0.1 m\" }\n\
                restitution = 0.5\n[initial]\nsliding_displacement = \"0.1 m\"\n";
    let model = model(&friction([0.1; 2]), stop);
    let found = response(&model, &ground(&[0.0, 0.5, 1.0], &[-2.0, -3.0, -2.0], None));
    let stop = found.demands.stop.expect("a stop");
    assert_eq!((stop.contact_time_s, found.demands.sliding_path_m), (1.0, 0.0));
}

/// A vertical record of zeros is none.
#[test]
fn vertical_zeros_change_nothing() {
    let text = format!("{}\nradius = \"2 m\"\ntilt = \"60 mrad\"", friction([0.05, 0.04]));
    let model = model(&text, "");
    let times_s: Vec<f64> = (0..200).map(|k| 0.02 * f64::from(k)).collect();
    let values: Vec<f64> = times_s.iter().map(|t| 3.0 * libm::sin(4.0 * t)).collect();
    let without = response(&model, &ground(&times_s, &values, None));
    let with = response(&model, &ground(&times_s, &values, Some(&[0.0; 200])));
    assert!(difference(&without.demands, &with.demands, 1e-11).is_none());
}

/// Both sides of a jump count, at the very end too: what is asked of friction there, and what lets go.
#[test]
fn a_jump_at_the_end_counts() {
    let held = friction([0.2, 0.2]);
    let plain = model(&held, "");
    let loaded = model(&held, &contents(20.0, [0.5, 0.4]));
    for (model, mass_kg) in [(plain, 100.0), (loaded, 120.0)] {
        let jump = |a: f64| response(&model, &ground(&[0.0, 0.5, 0.5], &[0.1, 0.1, a], None));
        let still = jump(-0.5);
        assert_eq!(still.demands.peak_friction_force_n, 0.5 * mass_kg);
        assert_eq!(
            (still.demands.slip_count, still.demands.peak_block_acceleration_m_per_s2),
            (0, 0.5)
        );
        let gone = jump(-3.0);
        assert_eq!((gone.demands.slip_count, gone.demands.sliding_path_m), (1, 0.0));
        for (response, a) in [(still, -0.5), (gone, -3.0)] {
            let motion = ground(&[0.0, 0.5, 0.5], &[0.1, 0.1, a], None);
            assert!(check(&model, &motion, &response).holds(), "{a}");
        }
    }
}

/// The same at the very start, where a time that stands twice has two values: what slides between them
/// has no time to.
#[test]
fn a_jump_at_the_start_counts() {
    let held = friction([0.2, 0.2]);
    let plain = model(&held, "");
    let loaded = model(&held, &contents(20.0, [0.5, 0.4]));
    for (model, mass_kg) in [(plain, 100.0), (loaded, 120.0)] {
        let motion = |a: f64| ground(&[0.0, 0.0, 0.5], &[a, 0.1, 0.1], None);
        let still = response(&model, &motion(-0.5));
        let d = &still.demands;
        assert_eq!((d.slip_count, d.peak_friction_force_n), (0, 0.5 * mass_kg));
        assert_eq!(d.peak_block_acceleration_m_per_s2, 0.5);
        let gone = response(&model, &motion(-3.0));
        let d = &gone.demands;
        assert_eq!((d.slip_count, d.stick_count, d.sliding_path_m), (1, 1, 0.0));
        assert!((d.peak_friction_force_n / mass_kg - 0.2 * 9.80665).abs() < 1e-14);
        for (response, a) in [(still, -0.5), (gone, -3.0)] {
            assert_eq!(alarm(&model, &motion(a), &response), None, "{a}");
        }
    }
}

/// Peaks at the first and the last instant with what is not stored at knots: a pendulum whose spring
/// follows the normal force, a block pressed against a rigid stop, contact made at the start.
#[test]
fn outputs_beside_a_jump_are_certified() {
    let pieces = "static_friction = 0.24\nradius = \"2 m\"\n\
                  kinetic_friction = { velocity = [\"0 m/s\", \"0.1 m/s\"], coefficient = [0.24, 0.16] }";
    let start = |s: &str, w: &str| {
        format!("[initial]\nsliding_displacement = \"{s} m\"\nsliding_velocity = \"{w} m/s\"\n")
    };
    let rigid = "[slider.stop]\ngap = \"0.01 m\"\nrestitution = 0.0\n";
    let elastic = "[slider.stop]\ngap = \"0.01 m\"\nstiffness = \"100 kN/m\"\n";
    let held = friction([0.06; 2]);
    let all = [
        (pieces, start("0.01", "0")),
        (pieces, format!("{rigid}{}", start("-0.01", "-0.1"))),
        (&held, format!("{rigid}{}", start("-0.01", "0"))),
        (&held, format!("{rigid}{}", start("0.01", "0.1"))),
        (&held, format!("{elastic}{}", start("0.01", "0"))),
        (&held, format!("{elastic}{}", start("-0.01", "-0.1"))),
        (&held, format!("{elastic}{}", start("0.012", "0"))),
    ];
    let lists: [[f64; 4]; 4] = [
        [0.2, 0.2, 0.2, -1.5],
        [-1.5, 0.3, 0.3, 0.3],
        [3.0, 0.2, 0.1, 3.0],
        [-3.0, 0.2, 0.1, -4.0],
    ];
    for (slider, more) in all {
        let model = model(slider, &more);
        for list in lists {
            for up in [None, Some([-2.0, 1.0, 2.0, -3.0])] {
                let up = up.as_ref().map(<[f64; 4]>::as_slice);
                let motion = ground(&[0.0, 0.0, 0.5, 0.5], &list, up);
                let found = response(&model, &motion);
                assert_eq!(alarm(&model, &motion, &found), None, "{more} {list:?} {up:?}");
            }
        }
    }
}

/// Two spikes within a hair of time let the block go: all that it spends lies between instants that are
/// rounded.
#[test]
fn spikes_of_any_length_are_certified() {
    let model = model(&friction([0.1, 0.08]), &contents(40.0, [0.2, 0.15]));
    for length_s in [1e-5, 1e-7, 1e-9, 1e-11, 1e-13] {
        let times_s = [0.0, 1.0, 2.0, 3.0].map(|k| 0.5 + k * length_s);
        let times_s: Vec<f64> = [&[0.0], &times_s[..], &[1.0]].concat();
        let motion = ground(&times_s, &[0.0, 0.0, 9.0, -9.0, 0.0, 0.0], None);
        let found = response(&model, &motion);
        assert_eq!((found.demands.slip_count, found.demands.stick_count), (1, 1));
        assert_eq!(alarm(&model, &motion, &found), None, "{length_s} s");
    }
}

/// A jump at the start that only lets the block go on is no decision.
#[test]
fn a_slip_that_goes_on_decides_nothing() {
    let block = friction([0.1; 2]);
    for more in [
        "",
        "[[contents]]\nfloor = 0\nmass = \"20 kg\"\nstatic_friction = 0.3\nkinetic_friction = 0.2\n",
    ] {
        let model = model(&block, more);
        let motion = ground(&[0.0, 0.0, 0.5, 1.0], &[-1.4, -1.6, 0.0, 0.0], None);
        let found = response(&model, &motion);
        assert_eq!((found.demands.slip_count, found.demands.stick_count), (1, 1));
        assert_eq!(alarm(&model, &motion, &found), None, "{more}");
    }
}

/// Within a ramp of the motion, however short, the block stops, stays and is let go:
/// `ṡ = w − μ g t − a₀ t + (a₀ − a₁) t²/(2 T)` falls below zero at 0.265 T, and at 0.628 T friction no
/// longer holds −a.
#[test]
fn stop_and_release_within_a_steep_ramp() {
    let block = friction([0.1; 2]);
    for ramp_s in [1e-3, 1e-6, 1e-9, 1e-12] {
        let start = format!("[initial]\nsliding_velocity = \"{:e} m/s\"\n", 0.5 * ramp_s);
        let model = model(&block, &start);
        let (first, last) = (2.0, -6.0);
        let motion = ground(&[0.0, ramp_s, 0.5, 1.0], &[first, last, 0.0, 0.0], None);
        let found = response(&model, &motion);
        let held = 0.1 * 9.80665;
        let [b, c] = [first + held, 0.5 * (first - last)];
        let stop = (b - (b * b - 2.0 * c).sqrt()) / (2.0 * c);
        let release = (first + held) / (first - last);
        let times: Vec<f64> = found.events.iter().map(|e| e.time_s / ramp_s).collect();
        let off = |k: usize, wanted: f64| (times[k] - wanted).abs() < 1e-12;
        assert!(off(0, stop) && off(1, release), "{ramp_s}: {times:?}, not {stop}, {release}");
        assert_eq!(alarm(&model, &motion, &found), None, "{ramp_s} s");
    }
}

/// Friction that grows with the normal force up to the instant at which the block strikes a rigid stop.
#[test]
fn a_peak_on_arrival_at_a_rigid_stop_is_certified() {
    let stop = "[slider.stop]\ngap = \"0.3 m\"\nrestitution = 0.0\n\
                [initial]\nsliding_velocity = \"1 m/s\"\n";
    let model = model(&friction([0.1; 2]), stop);
    let times_s: Vec<f64> = (0..60).map(|k| 0.01 * f64::from(k)).collect();
    let up: Vec<f64> = (0..60).map(|k| 0.2 * f64::from(k)).collect();
    let motion = ground(&times_s, &[0.0; 60], Some(&up));
    let found = response(&model, &motion);
    assert_eq!(alarm(&model, &motion, &found), None);
    let arrival_s = found.events[0].time_s;
    let peak_n = 10.0 * (9.80665 + 20.0 * arrival_s);
    assert!((found.demands.peak_slider_force_n / peak_n - 1.0).abs() < 1e-13);
}

/// Bounces that carry contents along die out; the last ends within the rounding of `s` off the stop.
#[test]
fn last_bounces_under_contents_raise_no_alarm() {
    let horizontal = [
        0.0, 0.0, 0.0, 0.063, 2.167, 1.276, 0.895, 0.0, 0.524, -1.404, 0.877, -1.387, -1.13, 3.308,
        -0.138, 0.0, 0.561, -0.646, 1.157, -3.725, -0.602, -0.61, 0.911, 2.98,
    ];
    let up = [
        -9.98, 11.448, 4.868, 1.556, -13.966, -0.743, -9.427, 1.06, 9.337, -10.329, 6.686, 26.78,
        -6.968, 20.233, -8.865, 3.186, 1.395, 8.605, -7.625, 8.582, 9.208, 4.955, -18.328, 14.085,
    ];
    let stop = "[slider.stop]\ngap = \"0.001 m\"\nrestitution = 0.8\n";
    let model = model(&friction([0.161; 2]), &(stop.to_owned() + &contents(66.0, [0.37; 2])));
    let times_s: Vec<f64> = (0..24).map(|k| 0.02 * f64::from(k)).collect();
    let motion = ground(&times_s, &horizontal, Some(&up));
    let found = response(&model, &motion);
    assert_eq!(alarm(&model, &motion, &found), None);
}

/// Friction that changes within a hair of rest is refused, whatever units make the rate a large number.
#[test]
fn a_rate_of_friction_is_limited_by_the_fading_of_the_motion() {
    let answer = |rate_s_per_m: f64, velocity_m_per_s: f64| {
        let slider = format!(
            "static_friction = 0.05\nkinetic_friction = {{ slow = 0.04, fast = 0.08, rate = \"{rate_s_per_m} s/m\" }}"
        );
        let a = velocity_m_per_s / 0.5;
        let pulse = ground(&[0.0, 0.25, 0.5, 1.0], &[0.0, a, -a, 0.0], None);
        exact(&model(&slider, ""), &pulse)
    };
    for (rate_s_per_m, velocity_m_per_s) in [(1e8, 1.0), (1e12, 1e-4), (1e30, 1.0)] {
        let found = answer(rate_s_per_m, velocity_m_per_s);
        let refused = matches!(&found, Err(SolveError::TooMuchWork { limit, .. }) if *limit == 1e5);
        assert!(refused, "{rate_s_per_m} s/m: {found:?}");
    }
    for (rate_s_per_m, velocity_m_per_s) in [(100.0, 1.0), (1e8, 1e-6)] {
        assert!(answer(rate_s_per_m, velocity_m_per_s).is_ok(), "{rate_s_per_m} s/m");
    }
}

/// The samples of a file of times and values.
fn columns(text: &str) -> (Vec<f64>, Vec<f64>) {
    let rows = text.lines().skip(1).map(|line| {
        let (time_s, value) = line.split_once(',').expect("two columns");
        let number = |text: &str| text.trim().parse::<f64>().expect("a number");
        (number(time_s), number(value))
    });
    rows.unzip()
}

/// Contents of equal coefficients on a pendulum under vertical motion: they let go and stop once, not without end.
#[test]
fn contents_under_vertical_motion_do_not_chatter() {
    let text = include_str!("../../../../data/reference/chatter/contents-vertical-radius.toml");
    let model = input::parse("m.toml", text, &[]).expect("a model").model;
    let (times_s, x) =
        columns(include_str!("../../../../data/reference/chatter/contents-vertical-radius-x.csv"));
    let (_, up) =
        columns(include_str!("../../../../data/reference/chatter/contents-vertical-radius-v.csv"));
    let motion = ground(&times_s, &x, Some(&up));
    let found = response(&model, &motion);
    assert!(found.events.len() < 10_000, "{} events", found.events.len());
    assert_eq!(alarm(&model, &motion, &found), None);
}

/// Stops that the block stands against: pads of a spring alone on both sides are a spring.
#[test]
fn pads_without_a_gap_are_a_spring() {
    for seed in 0..60 {
        let mut x = Sketch::shaken(&mut Stream::new(90_001 + seed));
        x.tilt = 0.0;
        let stiffness_n_per_m = x.block * 400.0;
        let sprung = Sketch { spring: x.spring + stiffness_n_per_m, ..x.clone() };
        let stop = Stop::elastic([Some(0.0); 2], stiffness_n_per_m, 0.0);
        let padded = Sketch { stop: Some(stop), ..x };
        let [(a, motion), (b, _)] = [sprung, padded].map(|x| x.build());
        let [a, b] = [(&a, response(&a, &motion)), (&b, response(&b, &motion))];
        assert_eq!(alarm(b.0, &motion, &b.1), None, "{seed}");
        let close = check(a.0, &motion, &a.1).closest_call;
        if close.is_none_or(|call| call.margin > 1e-6) {
            assert_eq!(difference(&a.1.demands, &b.1.demands, SAME), None, "{seed}");
        }
    }
}

/// A block between walls on both sides stands still.
#[test]
fn walls_without_a_gap_hold_a_block() {
    let stop = "[slider.stop]\ngap = \"0 mm\"\nrestitution = 0.5\n";
    let model = model(&friction([0.2, 0.15]), stop);
    let motion = ground(&[0.0, 0.5, 1.0, 1.5, 2.0], &[0.0, 5.0, -5.0, 3.0, 0.0], None);
    let found = response(&model, &motion);
    assert_eq!(found.demands.peak_sliding_displacement_m, 0.0);
    assert_eq!(found.demands.sliding_path_m, 0.0);
    assert_eq!(alarm(&model, &motion, &found), None);
}

/// A block that is pushed against a wall stays there and, pulled away, comes back to it at the speed of the closed form.
#[test]
fn closed_form_block_against_a_wall() {
    let stop = "[slider.stop]\ngap = { positive = \"0 mm\" }\nrestitution = 0\n[analysis]\ngravity = \"10 m/s2\"\n";
    let model = model(&friction([0.1; 2]), stop);
    // Held by the wall for 1 s; then away by 2 m/s² less 1 m/s² of friction for 1 s, and back.
    let times_s = [0.0, 1.0, 1.0, 2.0, 2.0, 6.0];
    let motion = ground(&times_s, &[-2.0, -2.0, 2.0, 2.0, -3.0, -3.0], None);
    let found = response(&model, &motion);
    assert_eq!(alarm(&model, &motion, &found), None);
    // s = −0.5 m at 1 m/s after 2 s; it stops after 0.25 s at −0.625 m, and comes back by 2 m/s².
    let d = &found.demands;
    assert!((d.min_sliding_displacement_m + 0.625).abs() < 1e-14, "{d:?}");
    assert_eq!((d.max_sliding_displacement_m, d.residual_sliding_displacement_m), (0.0, 0.0));
    let speed = d.stop.expect("a stop").peak_impact_speed_m_per_s;
    assert!((speed - (2.0_f64 * 2.0 * 0.625).sqrt()).abs() < 1e-13, "{speed}");
}

/// Random models that stand against a stop on one side.
fn against_a_stop(seeds: std::ops::Range<u64>) {
    for seed in seeds {
        let random = &mut Stream::new(70_001 + seed);
        let mut x = Sketch::shaken(random);
        x.equip(random);
        let rate = random.between(10.0, 80.0);
        let kind = match seed % 3 {
            0 => StopKind::Rigid { restitution: 0.0 },
            1 => StopKind::Rigid { restitution: random.between(0.1, 0.9) },
            _ => StopKind::Elastic {
                stiffness_n_per_m: x.block * rate * rate,
                damper_n_s_per_m: x.block * rate * random.of(&[0.0, 0.1, 1.0]),
            },
        };
        x.s = if random.chance(0.7) { 0.0 } else { -x.s.abs() };
        let other = random.chance(0.5).then(|| 1.1 * x.s.abs() + 0.05);
        x.stop = Some(Stop { gap_m: [Some(0.0), other], kind });
        let (model, motion) = x.build();
        match exact(&model, &motion) {
            Ok(found) => assert_eq!(alarm(&model, &motion, &found), None, "{seed}"),
            Err(SolveError::EndOfTravel { .. }) => {}
            Err(error) => panic!("{seed}: {error}"),
        }
    }
}

#[test]
fn prop_models_against_a_stop_are_certified() {
    against_a_stop(0..300);
}
