//! Friction that falls with the pressure, `μ(p, v) = μ(v) (p/p_ref)^(−m)`: closed forms under a normal force that is
//! constant, that grows or falls linearly under a sliding block, that is lost and comes back, and what of it a
//! certificate says.

#![allow(clippy::expect_used)]

use crate::common::random::Random;
use slipstick::check::check;
use slipstick::model::{Block, Contents, Damping, Frame, InitialState, Model, Slider, Stop};
use slipstick::motion::GroundMotion;
use slipstick::response::{EventKind, Response};
use slipstick::slider::{Friction, PressureLaw, RateCurve, RateLaw};
use slipstick::solver::exact;

const MASS_KG: f64 = 700.0;
const G: f64 = 9.81;

fn law(at_rest_over_reference: f64, exponent: f64) -> PressureLaw {
    PressureLaw::new(20e6 * at_rest_over_reference, 20e6, exponent).expect("a law")
}

fn sliding(slider: Slider, velocity_m_per_s: f64) -> Model {
    let block = Block { mass_kg: MASS_KG, width_m: None, height_m: None };
    let initial =
        InitialState { sliding_velocity_m_per_s: velocity_m_per_s, ..InitialState::rest() };
    Model::new(block, slider, Frame::none(), G, initial).expect("a model")
}

/// A table that stands, and moves up with these accelerations at samples 1 s apart.
fn upwards(vertical: &[f64]) -> GroundMotion {
    GroundMotion::evenly_spaced(1.0, vec![0.0; vertical.len()], Some(vertical.to_vec()))
        .expect("a motion")
}

fn certified(model: &Model, motion: &GroundMotion) -> Response {
    let response = exact(model, motion).expect("a response");
    let certificate = check(model, motion, &response);
    assert!(certificate.holds(), "{certificate:?}");
    response
}

/// A record of noise with a vertical one.
fn noise(vertical: bool) -> GroundMotion {
    let wave = |i: usize, rate: f64| libm::sin(rate * i as f64) + libm::cos(0.37 * rate * i as f64);
    let level = (0..800).map(|i| 1.6 * wave(i, 0.21)).collect();
    let up = (0..800).map(|i| 1.9 * wave(i, 0.33)).collect();
    GroundMotion::evenly_spaced(0.01, level, vertical.then_some(up)).expect("a motion")
}

/// `∫₀ᵗ N₀ (N/N₀)^(1−m) dt` and the integral of that, `N = N₀ + r t`.
fn integrals(at_rest_n: f64, [from_n, rate]: [f64; 2], m: f64, t: f64) -> [f64; 2] {
    let to_n = from_n + rate * t;
    let power = |n: f64, p: f64| libm::pow(n.max(0.0), p);
    let once = |n: f64| power(n, 2.0 - m) / (2.0 - m) / rate;
    let twice = |n: f64| power(n, 3.0 - m) / (3.0 - m) / (2.0 - m) / (rate * rate);
    let factor = libm::pow(at_rest_n, m);
    [
        factor * (once(to_n) - once(from_n)),
        factor * (twice(to_n) - twice(from_n) - once(from_n) * t),
    ]
}

#[test]
fn under_a_constant_normal_force_all_coefficients_have_one_factor() {
    let plain = Friction::new(0.08, 0.06).expect("friction");
    for (ratio, exponent) in [(1.0, 0.3), (1.0, 0.0), (2.2, 0.2), (0.4, 0.15)] {
        let law = law(ratio, exponent);
        let own = plain.under_pressure(law).expect("friction");
        let scaled = plain.scaled(law.factor_at_rest()).expect("friction");
        assert!(ratio != 1.0 || scaled == plain);
        let motion = noise(false);
        let [a, b] = [own, scaled]
            .map(|friction| certified(&sliding(Slider::pendulum(friction, 2.0), 0.0), &motion));
        assert_eq!(a.demands, b.demands);
        assert_eq!(a.events, b.events);
        assert!(a.events.len() > 10);
    }
}

#[test]
fn slides_as_its_closed_form_under_a_normal_force_that_changes_linearly() {
    for exponent in [0.1, 0.2, 0.45, 0.9] {
        for up in [[0.0, 6.0], [-4.0, 3.0], [5.0, -9.0], [0.0, -9.81], [-9.81, 0.0]] {
            let friction = Friction::new(0.05, 0.05).expect("friction");
            let friction = friction.under_pressure(law(1.7, exponent)).expect("friction");
            let mu = friction.kinetic_coefficient(slipstick::slider::Direction::Positive);
            let (w, motion) = (3.0, upwards(&up));
            let response = certified(&sliding(Slider::new(friction), w), &motion);
            let at_rest_n = MASS_KG * G;
            let normal = [MASS_KG * (G + up[0]), MASS_KG * (up[1] - up[0])];
            let [_, path] = integrals(at_rest_n, normal, exponent, 1.0);
            let expected = w - mu / MASS_KG * path;
            let found = response.demands.residual_sliding_displacement_m;
            assert!((found - expected).abs() <= 1e-12 * expected, "{exponent} {up:?}: {found}");
        }
    }
}

#[test]
fn stops_where_its_closed_form_does() {
    let (exponent, up, w) = (0.25, [0.0, 7.0], 0.4);
    let friction = Friction::new(0.09, 0.08).expect("friction");
    let friction = friction.under_pressure(law(1.0, exponent)).expect("friction");
    let response = certified(&sliding(Slider::new(friction), w), &upwards(&up));
    let stop = response.events.iter().find(|event| event.kind == EventKind::Stick);
    let stop_s = stop.expect("a stop").time_s;
    let normal = [MASS_KG * G, MASS_KG * 7.0];
    let [impulse, _] = integrals(MASS_KG * G, normal, exponent, stop_s);
    assert!((w - 0.08 / MASS_KG * impulse).abs() <= 1e-12 * w, "{stop_s}");
}

#[test]
fn goes_through_a_loss_of_contact() {
    let (exponent, w, mu) = (0.2, 2.0, 0.07);
    let up = [0.0, -15.0, -12.0, 4.0];
    let friction = Friction::new(mu, mu).expect("friction");
    let friction = friction.under_pressure(law(1.0, exponent)).expect("friction");
    let response = certified(&sliding(Slider::new(friction), w), &upwards(&up));
    let (mut s, mut v) = (0.0, w);
    for pair in up.windows(2) {
        let [from, to] = [pair[0], pair[1]].map(|a| MASS_KG * (G + a));
        let rate = to - from;
        let crossing = if from * to < 0.0 { from / (from - to) } else { 1.0 };
        for [a, b] in [[0.0, crossing], [crossing, 1.0]] {
            let (start_n, dt) = (from + rate * a, b - a);
            let middle_n = from + rate * 0.5 * (a + b);
            let [impulse, path] = if dt > 0.0 && middle_n > 0.0 {
                let start_n = if a > 0.0 { 0.0 } else { start_n };
                integrals(MASS_KG * G, [start_n, rate], exponent, dt)
            } else {
                [0.0; 2]
            };
            s += v * dt - mu / MASS_KG * path;
            v -= mu / MASS_KG * impulse;
        }
    }
    assert!(v > 0.0 && response.contact_loss_s.len() == 1);
    let found = response.demands.residual_sliding_displacement_m;
    assert!((found - s).abs() <= 1e-12 * s, "{found} for {s}");
}

/// `ẇ = −μ(w) N_p(t)/M` by Runge and Kutta's steps of the fourth order, extrapolated.
#[test]
fn follows_the_speed_and_the_pressure_as_a_fine_integration_does() {
    let (exponent, w) = (0.3, 1.2);
    let curve = RateCurve::Exponential { slow: 0.03, fast: 0.09, rate_s_per_m: 6.0 };
    let rate = RateLaw::new(curve, [1.0; 2]).expect("a law");
    let friction = Friction::by_speed([0.05; 2], rate.clone()).expect("friction");
    let friction = friction.under_pressure(law(1.0, exponent)).expect("friction");
    let response = certified(&sliding(Slider::new(friction), w), &upwards(&[-3.0, 5.0]));
    let change = |t: f64, w: f64| {
        let ratio = 1.0 + (-3.0 + 8.0 * t) / G;
        -rate.at(w, slipstick::slider::Direction::Positive) * G * libm::pow(ratio, 1.0 - exponent)
    };
    let path = |steps: usize| {
        let (h, mut w, mut s) = (1.0 / steps as f64, w, 0.0);
        for i in 0..steps {
            let t = i as f64 * h;
            let k1 = change(t, w);
            let k2 = change(t + 0.5 * h, w + 0.5 * h * k1);
            let k3 = change(t + 0.5 * h, w + 0.5 * h * k2);
            let k4 = change(t + h, w + h * k3);
            s += h * w + h * h * (k1 + k2 + k3) / 6.0;
            w += h * (k1 + 2.0 * k2 + 2.0 * k3 + k4) / 6.0;
        }
        s
    };
    let (coarse, fine) = (path(2000), path(4000));
    let expected = fine + (fine - coarse) / 15.0;
    let found = response.demands.residual_sliding_displacement_m;
    assert!((found - expected).abs() <= 1e-12 * expected, "{found} for {expected}");
}

#[test]
fn a_pressure_that_stays_changes_nothing_under_a_vertical_motion_of_nothing() {
    let motion = noise(true);
    let friction = Friction::new(0.08, 0.06).expect("friction");
    let own = friction.under_pressure(law(1.0, 0.0)).expect("friction");
    let [a, b] = [friction, own]
        .map(|friction| certified(&sliding(Slider::pendulum(friction, 2.0), 0.0), &motion).demands);
    assert_eq!(a, b);
}

/// A noise that wanders, of so many samples.
fn wander(random: &mut Random, count: usize, size: f64) -> Vec<f64> {
    let (mut x, pace) = (0.0, random.between(0.1, 1.0));
    let mut next = |_| {
        x += pace * (size * random.between(-1.5, 1.5) - x);
        x
    };
    (0..count).map(&mut next).collect()
}

/// A system whose friction follows the pressure, under a vertical motion that may lift it, in one direction or in two.
fn drawn(seed: u64, in_plane: bool) -> (Model, GroundMotion) {
    let mut random = Random::new(seed);
    let n = random.integer(0, 3) as usize;
    let mu = random.between(0.01, 0.2);
    let fixed = mu * if random.chance(0.4) { 1.0 } else { random.between(1.0, 1.5) };
    let friction = if random.chance(0.5) {
        Friction::new(fixed, mu)
    } else {
        let (slow, fast) = (mu, mu * random.between(1.0, 3.0));
        let curve =
            RateCurve::Exponential { slow, fast, rate_s_per_m: random.logarithmic(1.0, 100.0) };
        Friction::by_speed([fixed; 2], RateLaw::new(curve, [1.0; 2]).expect("a law"))
    };
    let law = law(random.between(0.3, 3.0), random.between(0.02, 0.6));
    let friction = friction.and_then(|friction| friction.under_pressure(law)).expect("friction");
    let mut slider = match random.integer(0, 2) {
        0 => Slider::new(friction),
        1 => Slider::sprung(friction, random.logarithmic(1e2, 1e5)),
        _ => Slider::pendulum(friction, random.between(0.5, 5.0)),
    };
    match random.integer(0, 4) {
        _ if in_plane => {}
        0 => {
            let gap_m = random.between(0.01, 0.1);
            slider.ends = Stop::rigid([Some(gap_m), None], random.between(0.0, 0.9)).into();
        }
        1 => {
            let gap_m = random.between(0.005, 0.05);
            slider.ends = Stop::elastic([Some(gap_m); 2], 1e6, 1e3).into();
        }
        2 => slider.tilt_rad = random.between(-0.02, 0.02),
        _ => {}
    }
    let frame = Frame {
        masses_kg: (0..n).map(|_| random.between(50.0, 500.0)).collect(),
        stiffnesses_n_per_m: (0..n).map(|_| random.logarithmic(3e3, 3e5)).collect(),
        damping: Damping::Ratio(random.between(0.0, 0.1)),
        heights_m: None,
    };
    let frame = if n == 0 { Frame::none() } else { frame };
    let block = Block { mass_kg: random.between(100.0, 800.0), width_m: None, height_m: None };
    let mut model = Model::new(block, slider, frame, G, InitialState::rest()).expect("a model");
    if !in_plane && random.chance(0.25) {
        let floor = random.integer(0, n as i64) as usize;
        let (static_friction, kinetic_friction) = (0.2, 0.15);
        let contents = Contents { floor, mass_kg: 30.0, static_friction, kinetic_friction };
        model = model.with_contents(vec![contents]).expect("contents");
    }
    let (dt_s, count) = (random.between(0.005, 0.02), random.integer(60, 260) as usize);
    let [level, up] = [random.logarithmic(0.5, 10.0), random.logarithmic(0.3, 18.0)];
    let [x, y] = [0, 1].map(|_| wander(&mut random, count, level));
    let up = wander(&mut random, count, up);
    let motion = GroundMotion::evenly_spaced(dt_s, x, Some(up)).expect("a motion");
    if !in_plane {
        return (model, motion);
    }
    let along_y = GroundMotion::evenly_spaced(dt_s, y, None).expect("a motion");
    (model, motion.with_along_y(&along_y).expect("two directions").0)
}

fn drawn_are_certified(seeds: core::ops::Range<u64>, in_plane: bool) {
    let (mut lifted, mut events) = (0, 0);
    for seed in seeds {
        let (model, motion) = drawn(seed, in_plane);
        let response = exact(&model, &motion).expect("a response");
        let certificate = check(&model, &motion, &response);
        assert!(certificate.holds(), "{seed}: {certificate:?}");
        lifted += usize::from(!response.contact_loss_s.is_empty());
        events += response.events.len();
    }
    assert!(lifted > 5 && events > 500, "{lifted} lifted, {events} events");
}

#[test]
fn prop_random_systems_are_certified() {
    drawn_are_certified(0..150, false);
}

#[test]
fn prop_random_systems_in_two_directions_are_certified() {
    drawn_are_certified(0..80, true);
}

#[test]
#[ignore = "minutes: cargo xtask nightly"]
fn prop_many_random_systems_are_certified() {
    drawn_are_certified(0..2000, false);
    drawn_are_certified(0..2000, true);
}
