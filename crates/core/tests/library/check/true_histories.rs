//! True histories pass, and so does what only rounding moves.

use super::systems::*;
use slipstick::check::{DecisionKind, check};
use slipstick::model::{Contents, Damping, Frame, InitialState, Model, Slider, Stop, StopKind};
use slipstick::motion::GroundMotion;
use slipstick::response::{
    Contact, Demands, Event, EventKind, History, Method, Mode, Response, StopDemands,
};
use slipstick::slider::{Bearing, Direction, Restoring, Surface, SurfacesInSeries};
use slipstick::solver::exact;
use slipstick::units::STANDARD_GRAVITY_M_PER_S2 as G;

#[test]
fn true_histories_pass() {
    for system in systems().into_iter().chain(coarse_systems()) {
        let response = response_of(&system);
        let history = response.history.as_ref().unwrap();
        let c = check(&system.model, &system.motion, &response);
        assert!(worst(&c).max(c.demands_error) < 1e-11, "{}: {}", system.name, figures(&c));
        assert!(c.holds());
        assert_eq!(c.energy().input_j.len(), history.len());
        let slid = changes(history, |a, b| a == Mode::Stick && slips(b)).len();
        assert!(slid >= 3, "{}: {slid} slips are too few to test anything", system.name);
    }
}

/// A release too early or too late, the motion after it correct: only the law can tell.
#[test]
fn delayed_release_shows() {
    // a = j t: the block slips from t_r on, s̈ = μ_k g − j t.
    let (mu, kinetic, j, m) = (0.1, 0.08, 2.0, 124.0);
    let system = System {
        name: "rigid block on a ramp",
        model: Model::rigid_block(m, coulomb([mu; 2], [kinetic; 2])).unwrap(),
        motion: GroundMotion::new(vec![0.0, 1.0], vec![0.0, j], None).unwrap(),
    };
    let released = |t_r: f64| {
        let tau = 1.0 - t_r;
        let slip = |t: f64| kinetic * G - j * t;
        let v = kinetic * G * tau - j * (1.0 - t_r * t_r) / 2.0;
        let s = slip(t_r) * tau * tau / 2.0 - j * tau * tau * tau / 6.0;
        let sliding = Mode::Slip(Direction::Negative);
        let mut h = History::default();
        for (time_s, mode, s, v) in [
            (0.0, Mode::Stick, 0.0, 0.0),
            (t_r, Mode::Stick, 0.0, 0.0),
            (t_r, sliding, 0.0, 0.0),
            (1.0, sliding, s, v),
        ] {
            let a = j * time_s;
            let force = if mode == Mode::Stick { m * a } else { kinetic * m * G };
            knot(&mut h, time_s, mode, a, [s, v, force / m], force, [&[], &[], &[]]);
        }
        h
    };
    let true_s = mu * G / j;
    let right = judge(&system, &released(true_s));
    assert!(worst(&right) < 1e-14, "{}", figures(&right));
    assert_eq!(right.closest_call, None);
    for shift_s in [1e-6, -1e-6] {
        let wrong = judge(&system, &released(true_s + shift_s));
        let expected = 1e-6 * j / (mu * G);
        assert!((wrong.friction_excess - expected).abs() < 1e-12, "{}", figures(&wrong));
        assert!(wrong.equilibrium_residual < 1e-14, "{}", figures(&wrong));
    }
}

/// Newmark's block under a rectangular pulse, from its closed form; energies too.
fn newmark(pass: bool) -> (System, History) {
    let (mu, a, t0, m) = (0.2, 0.4 * G, 0.5, 124.0);
    let system = System {
        name: "Newmark's block",
        model: Model::rigid_block(m, coulomb([mu; 2], [mu; 2])).unwrap(),
        motion: GroundMotion::new(vec![0.0, t0, t0, 1.5], vec![a, a, 0.0, 0.0], None).unwrap(),
    };
    let sliding = Mode::Slip(Direction::Negative);
    let mut h = History::default();
    let block = mu * G;
    let v = (mu * G - a) * t0;
    let (s, end) = (v * t0 / 2.0, v * t0);
    let mut add = |t: f64, mode, table, s, v, block: f64| {
        knot(&mut h, t, mode, table, [s, v, block], m * block, [&[], &[], &[]]);
    };
    add(0.0, sliding, a, 0.0, 0.0, block);
    add(t0, sliding, a, s, v, block);
    add(t0, sliding, 0.0, s, v, block);
    add(1.0, sliding, 0.0, end, 0.0, block);
    if pass {
        // The friction goes on pushing: a solver that lost the stop.
        add(1.5, sliding, 0.0, end + block * 0.125, block * 0.5, block);
    } else {
        add(1.0, Mode::Stick, 0.0, end, 0.0, 0.0);
        add(1.5, Mode::Stick, 0.0, end, 0.0, 0.0);
    }
    (system, h)
}

#[test]
fn newmark_block_passes() {
    let (system, history) = newmark(false);
    let c = judge(&system, &history);
    assert!(worst(&c) < 1e-15, "{}", figures(&c));
    assert_eq!(c.bound, 1e-10);
    let call = c.closest_call.unwrap();
    assert_eq!((call.margin, call.time_s, call.kind), (1.0, 1.0, DecisionKind::Stop));
    // All that the table put in went into friction: μ M g times 0.49 m.
    let spent = 0.2 * 124.0 * G * 0.05 * G;
    let energies = c.energy();
    for energy in [&energies.friction_j, &energies.input_j] {
        assert!((energy[5] - spent).abs() < 1e-12 * spent, "{energy:?}");
    }
}

/// Consistent but for the sign of the velocity: the friction law alone tells.
#[test]
fn lost_stop_shows() {
    let (system, history) = newmark(true);
    let c = judge(&system, &history);
    assert!(c.equilibrium_residual < 1e-15, "{}", figures(&c));
    assert!((c.friction_excess - 2.0).abs() < 1e-12, "{}", figures(&c));
}

/// Den Hartog: half cycles of a block on a spring lose 2 μ M g / K1 each, then it sticks.
#[test]
fn free_vibration_with_friction_passes() {
    let (mu, m, k) = (0.1, 248.0, 19_400.0);
    let omega = libm::sqrt(k / m);
    let (half_s, shift) = (core::f64::consts::PI / omega, mu * m * G / k);
    let start = 5.5 * shift;
    let slider = Slider::sprung(coulomb([mu; 2], [mu; 2]), k);
    let rest = InitialState { sliding_displacement_m: start, ..InitialState::rest() };
    let system = System {
        name: "Den Hartog's block",
        model: Model::new(block(m), slider, Frame::none(), G, rest).unwrap(),
        motion: GroundMotion::new(vec![0.0, 4.0 * half_s], vec![0.0; 2], None).unwrap(),
    };
    let mut h = History::default();
    let mut add = |t: f64, mode: Mode, s: f64| {
        let force = if mode == Mode::Stick { k * s } else { -mode.sign() * mu * m * G };
        knot(&mut h, t, mode, 0.0, [s, 0.0, (force - k * s) / m], force, [&[], &[], &[]]);
    };
    let directions = [Direction::Negative, Direction::Positive, Direction::Negative];
    let mut s = start;
    for (i, direction) in directions.into_iter().enumerate() {
        add(i as f64 * half_s, Mode::Slip(direction), s);
        s = 2.0 * -direction.sign() * shift - s;
        add((i + 1) as f64 * half_s, Mode::Slip(direction), s);
    }
    add(3.0 * half_s, Mode::Stick, s);
    add(4.0 * half_s, Mode::Stick, s);
    let c = judge(&system, &h);
    assert!(worst(&c) < 1e-14, "{}", figures(&c));
    // |s| at the turning points over the friction: 5.5, 3.5, 1.5, 0.5 bounds.
    let call = c.closest_call.unwrap();
    assert!((call.margin - 0.5).abs() < 1e-12 && call.kind == DecisionKind::Stop, "{call:?}");
}

/// A block that never slides: the oscillator on a ramp, y = −(j/ω²)(t − sin ωt/ω).
#[test]
fn oscillator_on_ramp_passes() {
    let (j, m, omega, end_s) = (0.3, 201.0, 7.07, 3.0);
    let k = m * omega * omega;
    let frame = frame(&[m], &[k], Damping::Ratio(0.0));
    let model = Model::new(
        block(325.0),
        slider(coulomb([0.3; 2], [0.3; 2])),
        frame,
        G,
        InitialState::rest(),
    );
    let system = System {
        name: "oscillator on a ramp",
        model: model.unwrap(),
        motion: GroundMotion::new(vec![0.0, end_s], vec![0.0, j * end_s], None).unwrap(),
    };
    let mut h = History::default();
    for t in [0.0, 0.31, 0.87, 2.2, end_s] {
        let (sin, cos) = (libm::sin(omega * t), libm::cos(omega * t));
        let y = -(j / (omega * omega)) * (t - sin / omega);
        let rate = -(j / (omega * omega)) * (1.0 - cos);
        let a = j * t;
        let storey = -omega * omega * y;
        let values: [&[f64]; 3] = [&[y], &[rate], &[storey]];
        knot(&mut h, t, Mode::Stick, a, [0.0, 0.0, a], 325.0 * a - k * y, values);
    }
    let c = judge(&system, &h);
    assert!(worst(&c) < 1e-14, "{}", figures(&c));
}

/// Without friction the oscillator vibrates at ω √(1 + M2/M1) on the free block.
#[test]
fn free_free_vibration_passes() {
    let (block_kg, m, omega, y0) = (325.0, 201.0, 7.07, 0.02);
    let free = omega * libm::sqrt(1.0 + m / block_kg);
    let initial = InitialState { storey_displacement_m: Some(vec![y0]), ..InitialState::rest() };
    let frame = frame(&[m], &[m * omega * omega], Damping::Ratio(0.0));
    let frictionless = slider(coulomb([0.0; 2], [0.0; 2]));
    let half_s = core::f64::consts::PI / free;
    let system = System {
        name: "oscillator on a free block",
        model: Model::new(block(block_kg), frictionless, frame, G, initial).unwrap(),
        motion: GroundMotion::new(vec![0.0, 2.0 * half_s], vec![0.0; 2], None).unwrap(),
    };
    let mut h = History::default();
    for (turn, direction, sliding) in [
        (0.0, Direction::Positive, 1.0),
        (0.4, Direction::Positive, 1.0),
        (1.0, Direction::Positive, 1.0),
        (1.0, Direction::Negative, 1.0),
        (2.0, Direction::Negative, 0.0),
    ] {
        let t: f64 = turn * half_s;
        let still = turn == 0.0 || turn == 1.0 || (turn == 2.0 && sliding == 0.0);
        let (sin, cos) = (if still { 0.0 } else { libm::sin(free * t) }, libm::cos(free * t));
        let (y, rate, storey) = (y0 * cos, -y0 * free * sin, -omega * omega * y0 * cos);
        let part = m / (m + block_kg);
        let values: [&[f64]; 3] = [&[y], &[rate], &[storey]];
        let sliding = [part * (y0 - y), -part * rate, -m * storey / block_kg];
        knot(&mut h, t, Mode::Slip(direction), 0.0, sliding, 0.0, values);
    }
    let c = judge(&system, &h);
    assert!(worst(&c) < 1e-14, "{}", figures(&c));
    // A bound of zero decides nothing.
    assert_eq!(c.closest_call, None);
}

/// A history without its samples, events alone, is integrated piece by piece of the motion.
#[test]
fn events_alone_pass() {
    for system in systems().into_iter().chain(coarse_systems()) {
        let full = history_of(&system);
        let abreast = |k: usize| {
            let same = |j: usize| full.time_s.get(j) == Some(&full.time_s[k]);
            k == 0 || k + 1 == full.len() || same(k - 1) || same(k + 1)
        };
        let mut h = History::default();
        for k in (0..full.len()).filter(|&k| abreast(k)) {
            let sliding = [
                full.sliding_displacement_m[k],
                full.sliding_velocity_m_per_s[k],
                full.block_acceleration_m_per_s2[k],
            ];
            let storeys = [
                full.storey_displacements(k),
                full.storey_velocities(k),
                full.storey_accelerations(k),
            ];
            let table = full.table_acceleration_m_per_s2[k];
            let force = full.friction_force_n[k];
            knot(&mut h, full.time_s[k], full.mode[k], table, sliding, force, storeys);
        }
        assert!(h.len() < full.len());
        let c = judge(&system, &h);
        assert!(worst(&c) < 1e-11, "{}: {}", system.name, figures(&c));
    }
}

/// A damping ratio without storeys damps nothing.
#[test]
fn damping_ratio_of_no_storeys() {
    let System { model, motion, .. } = systems().swap_remove(0);
    let model = with(&model, |_, frame| frame.damping = Damping::Ratio(0.05));
    let system = System { name: "rigid with a damping ratio", model, motion };
    let c = judge(&system, &history_of(&system));
    assert!(worst(&c) < 1e-11, "{}", figures(&c));
}

/// A motion of zero leaves nothing to decide and nothing to divide by.
#[test]
fn rest_has_zero_figures() {
    let motion = GroundMotion::evenly_spaced(0.1, vec![0.0; 11], None).unwrap();
    let System { model, .. } = systems().swap_remove(2);
    let system = System { name: "at rest", model, motion };
    let c = judge(&system, &history_of(&system));
    assert_eq!(worst(&c), 0.0);
    assert_eq!(c.closest_call, None);
}

/// A slip as short as the rounding of its time is no defect: the demand only touches its bound.
#[test]
fn touch_by_rounding_passes() {
    let acceleration = |i: u32| 2.0 * libm::sin(3.0 * core::f64::consts::PI * 0.005 * f64::from(i));
    let values: Vec<f64> = (0..=8000).map(acceleration).collect();
    let mu = peak(&values) / G;
    for part in [1.0, 1.0 - 1e-16, 1.0 - 3e-16, 1.0 - 1e-15, 1.0 - 1e-13, 1.0 - 1e-10] {
        let friction = coulomb([mu * part; 2], [mu * part; 2]);
        let system = System {
            name: "a demand that touches its bound",
            model: Model::rigid_block(124.0, friction).unwrap(),
            motion: GroundMotion::evenly_spaced(0.005, values.clone(), None).unwrap(),
        };
        let c = judge(&system, &history_of(&system));
        assert!(holds(&c), "{part}: {}", figures(&c));
        assert!(c.closest_call.unwrap().margin < 1e-6 || part < 1.0 - 1e-11, "{}", figures(&c));
    }
}

/// A frame at rest on a slope is in equilibrium to rounding, and its friction is the closest call.
#[test]
fn rest_on_slope_passes() {
    let motion = GroundMotion::evenly_spaced(0.1, vec![0.0; 11], None).unwrap();
    let System { model, .. } = systems().swap_remove(5);
    let model = with(&model, |slider, _| slider.tilt_rad = 0.01);
    let system = System { name: "at rest on a slope", model, motion };
    let c = judge(&system, &history_of(&system));
    assert!(worst(&c) < 1e-11, "{}", figures(&c));
    let call = c.closest_call.unwrap();
    assert!((call.margin - (1.0 - libm::tan(0.01) / 0.06)).abs() < 1e-12, "{call:?}");
}

/// An oscillator swings as A sin ωt on a block that holds: its demand peaks between two knots.
#[test]
fn demand_between_knots_counts() {
    let (block_kg, m, omega, amplitude) = (325.0, 201.0, 7.07, 0.01);
    let k = m * omega * omega;
    let held = |bound: f64| {
        let mu = bound / ((block_kg + m) * G);
        let initial = InitialState {
            storey_velocity_m_per_s: Some(vec![amplitude * omega]),
            ..InitialState::rest()
        };
        let frame = frame(&[m], &[k], Damping::Ratio(0.0));
        let slider = slider(coulomb([mu; 2], [mu; 2]));
        let end_s = 0.83 * core::f64::consts::PI / omega;
        let system = System {
            name: "swinging on a block that holds",
            model: Model::new(block(block_kg), slider, frame, G, initial).unwrap(),
            motion: GroundMotion::new(vec![0.0, end_s], vec![0.0; 2], None).unwrap(),
        };
        let mut h = History::default();
        for t in [0.0, end_s] {
            let (y, rate) = (libm::sin(omega * t), omega * libm::cos(omega * t));
            let [y, rate] = [y, rate].map(|q| amplitude * q);
            let values: [&[f64]; 3] = [&[y], &[rate], &[-omega * omega * y]];
            knot(&mut h, t, Mode::Stick, 0.0, [0.0; 3], -k * y, values);
        }
        judge(&system, &h)
    };
    for margin in [1e-3, 1e-8] {
        let c = held(k * amplitude / (1.0 - margin));
        assert!(worst(&c) < 1e-14, "{}", figures(&c));
        let call = c.closest_call.unwrap();
        // The interpolation inside a step is good to some 1e-13; the time of a maximum to its root.
        assert!((call.margin - margin).abs() < 1e-12, "{}", figures(&c));
        assert!((call.time_s * omega - core::f64::consts::FRAC_PI_2).abs() < 1e-5);
        let c = held(k * amplitude / (1.0 + margin));
        assert!((c.friction_excess - margin).abs() < 1e-12, "{}", figures(&c));
    }
}

/// A block slows down to almost nothing, or a little beyond, and gains speed again between two
/// knots: s̈ = −c (1 − 2 t/T), so ṡ = v − c t + c t²/T with its least value v − c T/4.
#[test]
fn dip_of_velocity_between_knots_counts() {
    let (fixed, kinetic, c, end_s, m) = (0.12, 0.1, 2.0, 0.7, 124.0);
    let friction = coulomb([fixed; 2], [kinetic; 2]);
    let dips = |least: f64| {
        let v = c * end_s / 4.0 + least;
        let initial = InitialState { sliding_velocity_m_per_s: v, ..InitialState::rest() };
        let table = [c, -c].map(|a| a - kinetic * G);
        let system = System {
            name: "almost stopped",
            model: Model::new(block(m), slider(friction.clone()), Frame::none(), G, initial)
                .unwrap(),
            motion: GroundMotion::new(vec![0.0, end_s], table.to_vec(), None).unwrap(),
        };
        let s = v * end_s - c * end_s * end_s / 6.0;
        let mut h = History::default();
        for (t, a, s) in [(0.0, table[0], 0.0), (end_s, table[1], s)] {
            let sliding = Mode::Slip(Direction::Positive);
            let block = -kinetic * G;
            knot(&mut h, t, sliding, a, [s, v, block], m * block, [&[], &[], &[]]);
        }
        judge(&system, &h)
    };
    for depth in [1e-3, 1e-9] {
        let above = dips(depth);
        assert!(worst(&above) < 1e-14, "{}", figures(&above));
        let call = above.closest_call.unwrap();
        let expected = depth / (c * end_s / 4.0 + depth);
        assert!((call.margin - expected).abs() < 1e-14, "{}", figures(&above));
        assert_eq!(call.kind, DecisionKind::Slip);
        let below = dips(-depth);
        let expected = 2.0 * kinetic / fixed;
        assert!((below.friction_excess - expected).abs() < 1e-14, "{}", figures(&below));
        assert!(below.equilibrium_residual < 1e-14, "{}", figures(&below));
    }
}

/// 1 t slides at 0.8 m/s into an undamped stop of 200 kN/m at 0.1 m, is thrown back and comes to
/// rest: Newmark's decelerations outside, `s̈ = −(k/M)(s − d ± μ M g/k)` against the stop.
fn struck() -> (System, Response) {
    let (m, mu, w0, d, k) = (1000.0, 0.04, 0.8, 0.1, 2e5);
    let friction = coulomb([0.05; 2], [mu; 2]);
    let stop = Stop::elastic([Some(d), None], k, 0.0);
    let initial = InitialState { sliding_velocity_m_per_s: w0, ..InitialState::rest() };
    let slider = Slider { ends: stop.into(), ..slider(friction) };
    let model = Model::new(block(m), slider, Frame::none(), G, initial).unwrap();
    let motion = GroundMotion::evenly_spaced(4.0, vec![0.0; 2], None).unwrap();
    let (drag, rate) = (mu * G, (k / m).sqrt());
    let offset = drag / (rate * rate);
    let w1 = (w0 * w0 - 2.0 * drag * d).sqrt();
    let t1 = (w0 - w1) / drag;
    // Towards the stop about d − offset, back about d + offset.
    let turn = libm::atan2(w1, rate * offset) / rate;
    let reach = (offset * offset + w1 * w1 / (rate * rate)).sqrt();
    let (t2, top) = (t1 + turn, d - offset + reach);
    let back = reach - 2.0 * offset;
    let leave = libm::acos(-offset / back) / rate;
    let t3 = t2 + leave;
    let w3 = -rate * (back * back - offset * offset).sqrt();
    let t4 = t3 - w3 / drag;
    let state = |t: f64| -> (f64, f64) {
        if t <= t1 {
            (w0 * t - 0.5 * drag * t * t, w0 - drag * t)
        } else if t <= t2 {
            let (sin, cos) = (libm::sin(rate * (t2 - t)), libm::cos(rate * (t2 - t)));
            (d - offset + reach * cos, rate * reach * sin)
        } else if t <= t3 {
            let (sin, cos) = (libm::sin(rate * (t - t2)), libm::cos(rate * (t - t2)));
            (d + offset + back * cos, -rate * back * sin)
        } else {
            let t = t.min(t4) - t3;
            (d + w3 * t + 0.5 * drag * t * t, w3 + drag * t)
        }
    };
    let (towards, away) = (Mode::Slip(Direction::Positive), Mode::Slip(Direction::Negative));
    let pressed = Contact::Pressed(Direction::Positive);
    let phases = [
        (0.0, t1, towards, Contact::Free),
        (t1, t2, towards, pressed),
        (t2, t3, away, pressed),
        (t3, t4, away, Contact::Free),
        (t4, 4.0, Mode::Stick, Contact::Free),
    ];
    let mut h = History::default();
    for (from, to, mode, contact) in phases {
        for i in 0..=8 {
            let t = if i == 8 { to } else { from + (to - from) * f64::from(i) / 8.0 };
            let (s, w) = state(t);
            let w = if mode == Mode::Stick || t == t2 || t == t4 { 0.0 } else { w };
            let push = if contact == pressed { k * (s - d) } else { 0.0 };
            let force = -mode.sign() * mu * m * G;
            let block = if mode == Mode::Stick { 0.0 } else { (force - push) / m };
            knot(&mut h, t, mode, 0.0, [s, w, block], force, [&[]; 3]);
            h.contact.push(contact);
        }
    }
    let event = |time_s: f64, kind, mode| Event {
        time_s,
        kind,
        mode,
        sliding_displacement_m: state(time_s).0,
        interface: 0,
    };
    let events = vec![
        event(t1, EventKind::Contact, towards),
        event(t2, EventKind::Reversal, away),
        event(t3, EventKind::Leave, away),
        event(t4, EventKind::Stick, Mode::Stick),
    ];
    let end = state(4.0).0;
    let peak_force_n = k * (top - d);
    let demands = Demands {
        peak_sliding_displacement_m: end.abs(),
        peak_sliding_displacement_time_s: t4,
        max_sliding_displacement_m: top,
        min_sliding_displacement_m: end,
        residual_sliding_displacement_m: end,
        sliding_path_m: 2.0 * top - end,
        peak_sliding_velocity_m_per_s: w0,
        sliding_time_s: t4,
        reversal_count: 1,
        stick_count: 1,
        peak_block_acceleration_m_per_s2: drag + peak_force_n / m,
        peak_friction_force_n: mu * m * G,
        peak_slider_force_n: mu * m * G + peak_force_n,
        friction_coefficient_used: mu,
        slider_force_coefficient: mu + peak_force_n / (m * G),
        // At the turn the stop pushes far beyond what friction holds; at rest nothing does.
        closest_stop: Some(1.0_f64.min((1.0 - peak_force_n / (0.05 * m * G)).abs())),
        stop: Some(StopDemands {
            contact_count: 1,
            impact_count: 0,
            peak_force_n,
            peak_impact_speed_m_per_s: w1,
            contact_time_s: t3 - t1,
        }),
        ..Demands::default()
    };
    let response = Response {
        method: Method::Exact,
        demands,
        events,
        history: Some(h),
        contact_loss_s: Vec::new(),
        iterations: None,
        warnings: Vec::new(),
        in_plane: None,
    };
    (System { name: "block against a stop", model, motion }, response)
}

#[test]
fn elastic_stop_passes() {
    let (system, response) = struck();
    // The reference to 16 digits: contact, turn, leave, rest.
    let reference = [
        0.129_085_202_660_775_53,
        0.237_541_145_209_035_05,
        0.351_438_455_520_997,
        2.120_259_730_878_303,
    ];
    for (event, t) in response.events.iter().zip(reference) {
        assert!((event.time_s - t).abs() < 1e-14, "{event:?} {t}");
    }
    let c = check(&system.model, &system.motion, &response);
    assert!(worst(&c).max(c.demands_error) < 1e-12, "{}", figures(&c));
}

#[test]
fn wrong_stops_show() {
    let (system, response) = struck();
    let must_show = |model: &Model, change: &dyn Fn(&mut Response), what: &str| {
        let mut tampered = response.clone();
        change(&mut tampered);
        let c = check(model, &system.motion, &tampered);
        assert!(!c.holds() && worst(&c).max(c.demands_error) > 1e-9, "{what}: {}", figures(&c));
    };
    let kind = StopKind::Elastic { stiffness_n_per_m: 2e5 * (1.0 + 1e-7), damper_n_s_per_m: 0.0 };
    let damped = StopKind::Elastic { stiffness_n_per_m: 2e5, damper_n_s_per_m: 0.1 };
    let right = *system.model.stop().unwrap();
    let gap = |gap_m: f64| Stop { gap_m: [Some(gap_m), None], ..right };
    let stops = [
        Stop { kind, ..right },
        Stop { kind: damped, ..right },
        gap(0.1 + 1e-8),
        gap(0.1 - 1e-8),
        Stop { gap_m: [Some(0.1); 2], ..right },
    ];
    for (i, stop) in stops.into_iter().enumerate() {
        let model = with(&system.model, |slider, _| slider.ends = stop.into());
        must_show(&model, &|_| (), &format!("stop {i}"));
    }
    let contact = |from: usize, to: usize, contact: Contact| {
        move |r: &mut Response| r.history.as_mut().unwrap().contact[from..to].fill(contact)
    };
    let side = Direction::Positive;
    let model = &system.model;
    must_show(model, &contact(9, 27, Contact::Free), "no contact");
    must_show(model, &contact(9, 27, Contact::Separated(side)), "separated");
    must_show(model, &contact(9, 27, Contact::Pressed(Direction::Negative)), "the other side");
    must_show(model, &contact(0, 27, Contact::Pressed(side)), "pressed too early");
    must_show(model, &contact(27, 36, Contact::Separated(side)), "separated within the gap");
    must_show(model, &contact(27, 36, Contact::Pressed(side)), "pressed too long");
    must_show(model, &|r| r.history.as_mut().unwrap().contact.clear(), "no contacts");
    let stop: [fn(&mut StopDemands); 5] = [
        |s| s.contact_count += 1,
        |s| s.impact_count += 1,
        |s| s.peak_force_n *= 1.0 + 1e-8,
        |s| s.peak_impact_speed_m_per_s *= 1.0 - 1e-8,
        |s| s.contact_time_s *= 1.0 + 1e-8,
    ];
    for (i, change) in stop.into_iter().enumerate() {
        must_show(model, &|r| change(r.demands.stop.as_mut().unwrap()), &format!("demand {i}"));
    }
    must_show(model, &|r| r.demands.stop = None, "no demands");
    must_show(model, &|r| _ = r.events.remove(2), "no leave");
}

/// What is judged: a model and its motion's samples `[time, Ü, Üv]`, SI.
fn certified(name: &'static str, model: Model, samples: &[[f64; 3]]) {
    let list = |i: usize| samples.iter().map(|sample| sample[i]).collect::<Vec<f64>>();
    let up = list(2);
    let up = up.iter().any(|up| *up != 0.0).then_some(up);
    let motion = GroundMotion::new(list(0), list(1), up).unwrap();
    let system = System { name, model, motion };
    let c = check(&system.model, &system.motion, &response_of(&system));
    assert!(c.holds(), "{name}: {}", figures(&c));
    assert!(c.demands_error.is_finite(), "{name}: {}", figures(&c));
}

/// Nothing moves on a slider with any device: 0/0 is 0.
#[test]
fn rest_with_devices_passes() {
    for System { name, model, .. } in device_systems() {
        certified(name, model, &[[0.0; 3], [1.0, 0.0, 0.0]]);
    }
}

/// Released beyond the gap of an elastic stop at rest: its strain is all the energy there is.
#[test]
fn release_from_elastic_stop_passes() {
    // The last is a million times as fast as the time over which the stop lets go.
    for (damper_n_s_per_m, mass_kg, end_s) in
        [(0.0, 100.0, 1.0), (300.0, 100.0, 1.0), (1e5, 0.1, 0.1)]
    {
        let stop = Stop::elastic([Some(0.1); 2], 1e5, damper_n_s_per_m);
        let slider = Slider { ends: stop.into(), ..slider(coulomb([0.1; 2], [0.1; 2])) };
        let initial = InitialState { sliding_displacement_m: 0.12, ..InitialState::rest() };
        let model = Model::new(block(mass_kg), slider, Frame::none(), G, initial).unwrap();
        certified("released from a stop", model, &[[0.0; 3], [end_s, 0.0, 0.0]]);
    }
}

/// Motions so small that friction gives way only within the rounding of the time at which contact is
/// lost: there the normal force is rounding, and 0 from there on.
#[test]
fn tiny_motion_without_contact_passes() {
    let wave = |k: i32, rate: f64| libm::sin(rate * f64::from(k));
    for peak in [1e-14, 1e-7] {
        let sample = |k: i32| [f64::from(k) / 64.0, peak * wave(k, 0.21), 15.0 * wave(k, 1.7)];
        let samples: Vec<[f64; 3]> = (0..320).map(sample).collect();
        let rigid = Model::rigid_block(2.0, coulomb([0.48; 2], [0.37; 2])).unwrap();
        certified("tiny motion", rigid.clone(), &samples);
        let flat = Surface { radius_m: None, friction: 0.2, travel_m: None };
        let bearing = Bearing::InSeries(SurfacesInSeries::new(vec![flat], 1.0).unwrap());
        let model = with(&rigid, |slider, _| slider.bearing = bearing);
        certified("tiny motion on a surface in series", model, &samples);
        for (mu, carried) in [(0.31, 0.25), (0.09, 0.13)] {
            let friction = coulomb([1.3 * mu; 2], [mu; 2]);
            let restoring = Restoring::Spring { stiffness_n_per_m: 40.0 };
            let block = Model::rigid_block(2.0, friction.clone()).unwrap();
            let bearing = Bearing::Surface { friction, restoring };
            let sprung = with(&block, |slider, _| slider.bearing = bearing);
            certified("tiny motion of contents", carrying(sprung, carried), &samples);
        }
    }
}

/// A ramp so steep that the rounding of the time of a release within it moves the demand there.
#[test]
fn steep_ramp_passes() {
    let samples = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0 + 1e-9, 3.0, 0.0], [2.0, 3.0, 0.0]];
    for mu in [0.031, 0.17, 0.293] {
        let block = Model::rigid_block(2.0, coulomb([1.2 * mu; 2], [mu; 2])).unwrap();
        certified("steep ramp", block.clone(), &samples);
        certified("steep ramp under contents", carrying(block, 0.05), &samples);
    }
}

/// A jump that goes beyond what friction holds and comes back lets go on its way.
#[test]
fn release_within_a_jump_passes() {
    let samples = [[0.0, -3.0, 0.0], [0.0, -1.0, 0.0], [1.0, 2.0, 0.0], [2.0, 0.0, 0.0]];
    let firm = Model::rigid_block(2.0, coulomb([0.9; 2], [0.9; 2])).unwrap();
    certified("a jump and back under contents", carrying(firm, 0.2), &samples);
}

/// Block and contents reach their bounds together; either alone would have held the other back.
#[test]
fn which_lets_go_first_is_a_close_call() {
    let contents =
        vec![Contents { floor: 0, mass_kg: 1.0, static_friction: 0.2, kinetic_friction: 0.15 }];
    let block = Model::rigid_block(2.0, coulomb([0.2; 2], [0.15; 2])).unwrap();
    let model = block.with_contents(contents).unwrap();
    for (times_s, values) in [
        (vec![0.0, 1.0, 2.0, 3.0], vec![0.0, 3.0, -3.0, 0.0]),
        (vec![0.0, 1.0, 1.0, 2.0, 3.0], vec![0.0, 0.0, 3.0, -3.0, 0.0]),
    ] {
        let motion = GroundMotion::new(times_s, values, None).unwrap();
        let response = exact(&model, &motion).unwrap();
        let call = check(&model, &motion, &response).closest_call.unwrap();
        assert!(call.margin < 1e-12, "{call:?}");
    }
}

/// A model with contents of two thirds of the block's mass on it, of one coefficient.
fn carrying(model: Model, friction: f64) -> Model {
    let contents = vec![Contents {
        floor: 0,
        mass_kg: model.block().mass_kg / 1.5,
        static_friction: friction,
        kinetic_friction: friction,
    }];
    model.with_contents(contents).unwrap()
}

/// Contents that nearly let go, nearly stay, and nearly come to a halt in a slip: the closest call is theirs.
#[test]
fn close_decisions_of_contents_count() {
    let [fixed, kinetic] = [0.2, 0.15];
    let carrier = Model::rigid_block(2.0, coulomb([1.0; 2], [0.9; 2])).unwrap();
    let contents = vec![Contents {
        floor: 0,
        mass_kg: 1.0,
        static_friction: fixed,
        kinetic_friction: kinetic,
    }];
    let model = carrier.with_contents(contents).unwrap();
    let near = fixed * G * (1.0 - 1e-8);
    // The table stands still until 1e-8 of the velocity is left.
    let peak = 0.5 * (3.0 - kinetic * G);
    let back_s = (1.0 - 1e-8) * peak / (kinetic * G);
    for (kind, times_s, values) in [
        (DecisionKind::Stick, vec![0.0, 1.0, 2.0, 3.0], vec![0.0, near, 0.0, 0.0]),
        (DecisionKind::Stop, vec![0.0, 0.5, 0.5, 2.0, 3.0], vec![3.0, 3.0, -near, -near, 0.0]),
        (
            DecisionKind::Slip,
            vec![0.0, 0.5, 0.5, 0.5 + back_s, 0.5 + back_s, 1.0 + back_s],
            vec![3.0, 3.0, 0.0, 0.0, 3.0, 3.0],
        ),
    ] {
        let motion = GroundMotion::new(times_s, values, None).unwrap();
        let response = exact(&model, &motion).unwrap();
        let c = check(&model, &motion, &response);
        assert!(c.holds(), "{kind}: {}", figures(&c));
        let call = c.closest_call.unwrap();
        assert_eq!((call.kind, call.interface), (kind, 1), "{call:?}");
        assert!((call.margin - 1e-8).abs() < 1e-11, "{call:?}");
        assert_eq!(call.decision(), format!("{kind} of contents.1"));
    }
}
