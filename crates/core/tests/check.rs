//! True histories pass the check; every kind of tampering shows.

#![allow(clippy::unwrap_used, reason = "a test that cannot be set up has failed")]

use slipstick::check::{Certificate, check};
use slipstick::friction::{Coulomb, Direction, Friction};
use slipstick::model::{Block, Damping, Frame, InitialState, Model, Slider};
use slipstick::motion::GroundMotion;
use slipstick::response::{History, Mode};
use slipstick::solver;
use slipstick::units::STANDARD_GRAVITY_M_PER_S2 as G;

/// A tampered figure must stand above this.
const SHOWS: f64 = 1e-9;

fn coulomb(fixed: [f64; 2], kinetic: [f64; 2]) -> Friction {
    Friction::Coulomb(Coulomb::new(fixed, kinetic).unwrap())
}

fn block(mass_kg: f64) -> Block {
    Block { mass_kg, width_m: None, height_m: None }
}

fn slider(friction: Friction) -> Slider {
    Slider { friction, stiffness_n_per_m: 0.0, damper_n_s_per_m: 0.0, tilt_rad: 0.0, gap_m: None }
}

fn frame(masses_kg: &[f64], stiffnesses_n_per_m: &[f64], damping: Damping) -> Frame {
    Frame {
        masses_kg: masses_kg.to_vec(),
        stiffnesses_n_per_m: stiffnesses_n_per_m.to_vec(),
        damping,
        heights_m: None,
    }
}

/// The same model with another slider or frame.
fn with(model: &Model, change: impl FnOnce(&mut Slider, &mut Frame)) -> Model {
    let (mut slider, mut frame) = (*model.slider(), model.frame().clone());
    change(&mut slider, &mut frame);
    let g = model.gravity_m_per_s2();
    Model::new(*model.block(), slider, frame, g, model.initial().clone()).unwrap()
}

/// A shaking that wanders between several frequencies, with or without a vertical companion.
fn shaking(peak: f64, vertical: Option<f64>) -> GroundMotion {
    let wave = |t: f64, shift: f64| {
        let sum = libm::sin(6.3 * t + shift) + 0.7 * libm::sin(17.1 * t + 2.0 * shift)
            - 0.4 * libm::sin(41.0 * t);
        0.5 * sum * (t / 2.0).min(1.0) * (4.0 - 0.5 * t).min(1.0)
    };
    let dt_s = 0.01;
    let values = |peak: f64, shift: f64| -> Vec<f64> {
        (0..=800).map(|i| peak * wave(f64::from(i) * dt_s, shift)).collect()
    };
    let up = vertical.map(|peak| values(peak, 1.0));
    GroundMotion::evenly_spaced(dt_s, values(peak, 0.0), up).unwrap()
}

#[derive(Clone)]
struct System {
    name: &'static str,
    model: Model,
    motion: GroundMotion,
}

/// Rigid, one and three storeys; springs, dampers, tilt, vertical motion, unequal friction.
fn systems() -> Vec<System> {
    let model = |block_kg, slider: Slider, frame| {
        Model::new(block(block_kg), slider, frame, G, InitialState::rest()).unwrap()
    };
    let k1 = 45.0 * (2.0 * core::f64::consts::PI * 1.625) * (2.0 * core::f64::consts::PI * 1.625);
    vec![
        System {
            name: "rigid",
            model: model(124.0, slider(coulomb([0.1; 2], [0.08; 2])), Frame::none()),
            motion: shaking(3.0, None),
        },
        System {
            name: "rigid on spring and damper",
            model: model(
                248.0,
                Slider {
                    stiffness_n_per_m: 143e3,
                    damper_n_s_per_m: 400.0,
                    ..slider(coulomb([0.158; 2], [0.136; 2]))
                },
                Frame::none(),
            ),
            motion: shaking(4.0, None),
        },
        System {
            name: "mock-up",
            model: model(
                325.0,
                slider(coulomb([0.02; 2], [0.012; 2])),
                frame(&[45.0], &[k1], Damping::Ratio(0.01)),
            ),
            motion: shaking(1.0, None),
        },
        System {
            name: "mock-up, tilted, vertical, unequal friction",
            model: model(
                325.0,
                Slider {
                    stiffness_n_per_m: 8e3,
                    tilt_rad: 0.004,
                    ..slider(coulomb([0.05, 0.06], [0.05, 0.03]))
                },
                frame(&[90.0], &[1.09e4], Damping::Dampers(vec![30.0])),
            ),
            motion: shaking(2.0, Some(3.0)),
        },
        System {
            name: "contact lost now and then",
            model: model(
                325.0,
                slider(coulomb([0.3; 2], [0.25; 2])),
                frame(&[90.0], &[1.09e4], Damping::Ratio(0.03)),
            ),
            motion: shaking(4.0, Some(14.0)),
        },
        System {
            name: "three storeys",
            model: model(
                800.0,
                Slider { stiffness_n_per_m: 2e4, ..slider(coulomb([0.06; 2], [0.05; 2])) },
                frame(&[500.0, 400.0, 300.0], &[6e5, 5e5, 3e5], Damping::Ratio(0.02)),
            ),
            motion: shaking(2.5, None),
        },
    ]
}

fn history_of(system: &System) -> History {
    solver::exact(&system.model, &system.motion).unwrap().history.unwrap()
}

fn judge(system: &System, history: &History) -> Certificate {
    check(&system.model, &system.motion, history)
}

fn worst(c: &Certificate) -> f64 {
    c.equilibrium_residual.max(c.friction_excess).max(c.energy_balance_error)
}

/// Indices of the knots just before a change from one kind of mode to another.
fn changes(h: &History, pick: impl Fn(Mode, Mode) -> bool) -> Vec<usize> {
    let after = |k: &usize| h.time_s[*k] == h.time_s[k + 1] && pick(h.mode[*k], h.mode[k + 1]);
    (0..h.len() - 1).filter(after).collect()
}

fn slips(mode: Mode) -> bool {
    mode != Mode::Stick
}

/// Largest |value|.
fn peak(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |p, v| v.abs().max(p))
}

/// Two systems in which one sample holds many radians of the structure, or many events.
fn coarse_systems() -> Vec<System> {
    let model = |block_kg, fixed, kinetic, frame| {
        let slider = slider(coulomb([fixed; 2], [kinetic; 2]));
        Model::new(block(block_kg), slider, frame, G, InitialState::rest()).unwrap()
    };
    let zigzag = [0.0, 1.1, -0.9, 0.2, 1.6, -2.2, 0.7, -0.3, 0.0].map(|a| 0.5 * a).to_vec();
    vec![
        System {
            name: "60 Hz without damping, sampled at 2 Hz",
            model: model(325.0, 0.05, 0.04, frame(&[45.0], &[6.4e6], Damping::Ratio(0.0))),
            motion: GroundMotion::evenly_spaced(0.5, zigzag.clone(), None).unwrap(),
        },
        System {
            name: "light block under a heavy oscillator",
            model: model(0.5, 0.05, 0.04, frame(&[200.0], &[7.9e3], Damping::Ratio(0.02))),
            motion: GroundMotion::evenly_spaced(0.5, zigzag, None).unwrap(),
        },
    ]
}

#[test]
fn exact_true_histories_pass() {
    for system in systems().into_iter().chain(coarse_systems()) {
        let history = history_of(&system);
        let c = judge(&system, &history);
        assert!(worst(&c) < 1e-11, "{}: {}", system.name, figures(&c));
        assert!(c.holds());
        assert_eq!(c.energy.input_j.len(), history.len());
        let slid = changes(&history, |a, b| a == Mode::Stick && slips(b)).len();
        assert!(slid >= 3, "{}: {slid} slips are too few to test anything", system.name);
    }
}

fn figures(c: &Certificate) -> String {
    let [r, f, e] = [c.equilibrium_residual, c.friction_excess, c.energy_balance_error];
    format!("equilibrium {r:e}, friction {f:e}, energy {e:e}, {:?}", c.closest_call)
}

/// Judges a tampered history and says what went unnoticed.
fn must_show(system: &System, history: &History, what: &str) {
    let c = judge(system, history);
    assert!(worst(&c) > SHOWS, "{}: {what} went unnoticed: {}", system.name, figures(&c));
}

#[test]
fn exact_moved_events_show() {
    for system in systems().into_iter().chain(coarse_systems()) {
        let history = history_of(&system);
        for k in changes(&history, |a, b| a != b) {
            for shift_s in [1e-6, -1e-6] {
                let mut moved = history.clone();
                moved.time_s[k] += shift_s;
                moved.time_s[k + 1] += shift_s;
                if moved.time_s.is_sorted() {
                    must_show(&system, &moved, &format!("event at {} s", history.time_s[k]));
                }
            }
        }
    }
}

#[test]
fn exact_changed_friction_shows() {
    for system in systems().into_iter().chain(coarse_systems()) {
        let [fixed, kinetic] = [system.model.static_friction(), system.model.kinetic_friction()];
        let more = |pair: [f64; 2]| pair.map(|mu| mu * (1.0 + 1e-6));
        let less = |pair: [f64; 2]| pair.map(|mu| mu * (1.0 - 1e-6));
        for (fixed, kinetic) in [
            (more(fixed), more(kinetic)),
            (less(fixed), less(kinetic)),
            (more(fixed), kinetic),
            (fixed, less(kinetic)),
        ] {
            let model = system.model.with_friction(coulomb(fixed, kinetic));
            let other = history_of(&System { model, ..system.clone() });
            must_show(&system, &other, "μ changed by 1e-6");
        }
    }
}

#[test]
fn exact_reversal_left_out_shows() {
    let mut reversals = 0;
    for system in systems() {
        let history = history_of(&system);
        for k in changes(&history, |a, b| slips(a) && slips(b) && a != b) {
            reversals += 1;
            let (mut tampered, claimed) = (history.clone(), history.mode[k]);
            let after = history.mode[k + 1];
            let end = (k + 1..history.len()).find(|&j| history.mode[j] != after);
            tampered.mode[k + 1..end.unwrap_or(history.len())].fill(claimed);
            must_show(&system, &tampered, "a reversal left out");
        }
    }
    assert!(reversals > 5, "{reversals} reversals are too few");
}

#[test]
fn exact_stop_turned_into_pass_shows() {
    for system in systems().into_iter().chain(coarse_systems()) {
        let history = history_of(&system);
        for k in changes(&history, |a, b| slips(a) && b == Mode::Stick) {
            let end = (k + 1..history.len()).find(|&j| history.mode[j] != Mode::Stick);
            let end = end.unwrap_or(history.len());
            if history.time_s[end - 1] == history.time_s[k] {
                continue;
            }
            for direction in [Direction::Positive, Direction::Negative] {
                let mut tampered = history.clone();
                tampered.mode[k + 1..end].fill(Mode::Slip(direction));
                must_show(&system, &tampered, "a stop turned into a pass");
            }
        }
    }
}

#[test]
fn exact_flipped_friction_shows() {
    for system in systems().into_iter().chain(coarse_systems()) {
        let history = history_of(&system);
        for k in changes(&history, |a, b| a == Mode::Stick && slips(b)) {
            let during = history.mode[k + 1];
            let mut tampered = history.clone();
            for j in (k + 1..history.len()).take_while(|&j| history.mode[j] == during) {
                tampered.friction_force_n[j] *= -1.0;
            }
            must_show(&system, &tampered, "friction of the wrong sign");
        }
    }
}

#[test]
fn exact_one_changed_value_shows() {
    for system in systems().into_iter().chain(coarse_systems()) {
        let history = history_of(&system);
        let columns: [fn(&mut History) -> &mut Vec<f64>; 8] = [
            |h| &mut h.sliding_velocity_m_per_s,
            |h| &mut h.storey_velocity_m_per_s,
            |h| &mut h.sliding_displacement_m,
            |h| &mut h.storey_displacement_m,
            |h| &mut h.table_acceleration_m_per_s2,
            |h| &mut h.block_acceleration_m_per_s2,
            |h| &mut h.storey_acceleration_m_per_s2,
            |h| &mut h.friction_force_n,
        ];
        let sliding = peak(&history.sliding_velocity_m_per_s);
        let speed = sliding.max(peak(&history.storey_velocity_m_per_s));
        for (i, column) in columns.into_iter().enumerate() {
            let length = column(&mut history.clone()).len();
            for j in (0..length).step_by(31).chain(length.checked_sub(1)) {
                let mut tampered = history.clone();
                let scale = if i < 2 { speed } else { peak(column(&mut tampered)) };
                column(&mut tampered)[j] += 1e-7 * scale;
                must_show(&system, &tampered, &format!("value {j} of column {i}"));
            }
        }
    }
}

#[test]
fn exact_damping_left_out_shows() {
    for system in systems() {
        let undamped = with(&system.model, |slider, frame| {
            slider.damper_n_s_per_m = 0.0;
            frame.damping = Damping::Ratio(0.0);
        });
        if undamped == system.model {
            continue;
        }
        let other = history_of(&System { model: undamped, ..system.clone() });
        must_show(&system, &other, "damping left out");
    }
}

/// A demand above its bound only between two samples shows, and one just below it does not.
#[test]
fn exact_excess_between_samples_shows() {
    for system in coarse_systems().into_iter().skip(1) {
        let model = system.model.with_friction(coulomb([1e3; 2], [1e3; 2]));
        let held = System { model, ..system.clone() };
        let history = history_of(&held);
        let call = judge(&held, &history).closest_call.unwrap();
        assert_eq!(call.kind, "stick");
        let inside = |t: &f64| (t - call.time_s).abs() > 1e-3;
        assert!(held.motion.times_s().iter().all(inside), "between samples");
        for (part, shows) in [(1.0 - 1e-8, true), (1.0 + 1e-8, false)] {
            let mu = 1e3 * (1.0 - call.margin) * part;
            let model = held.model.with_friction(coulomb([mu; 2], [mu; 2]));
            let excess = judge(&System { model, ..held.clone() }, &history).friction_excess;
            let expected = if shows { 1e-8 } else { 0.0 };
            assert!((excess - expected).abs() < 1e-11, "{}: {excess:e}", system.name);
        }
    }
}

/// A release too early or too late, the motion after it correct: only the law can tell.
#[test]
fn exact_delayed_release_shows() {
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

/// Appends a knot: `[s, ṡ, block acceleration]`, friction force, storeys' `q`, `q̇`, accelerations.
fn knot(
    h: &mut History,
    time_s: f64,
    mode: Mode,
    table: f64,
    [s, v, block]: [f64; 3],
    force: f64,
    [q, rates, storeys]: [&[f64]; 3],
) {
    h.storeys = q.len();
    h.time_s.push(time_s);
    h.mode.push(mode);
    h.table_acceleration_m_per_s2.push(table);
    h.sliding_displacement_m.push(s);
    h.sliding_velocity_m_per_s.push(v);
    h.block_acceleration_m_per_s2.push(block);
    h.friction_force_n.push(force);
    h.storey_displacement_m.extend(q);
    h.storey_velocity_m_per_s.extend(rates);
    h.storey_acceleration_m_per_s2.extend(storeys);
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
fn exact_newmark_block_passes() {
    let (system, history) = newmark(false);
    let c = judge(&system, &history);
    assert!(worst(&c) < 1e-15, "{}", figures(&c));
    assert_eq!(c.bound, 1e-10);
    let call = c.closest_call.unwrap();
    assert_eq!((call.margin, call.time_s, call.kind), (1.0, 1.0, "stop"));
    // All that the table put in went into friction: μ M g times 0.49 m.
    let spent = 0.2 * 124.0 * G * 0.05 * G;
    for energy in [&c.energy.friction_j, &c.energy.input_j] {
        assert!((energy[5] - spent).abs() < 1e-12 * spent, "{energy:?}");
    }
}

/// Consistent but for the sign of the velocity: the friction law alone tells.
#[test]
fn exact_lost_stop_shows() {
    let (system, history) = newmark(true);
    let c = judge(&system, &history);
    assert!(c.equilibrium_residual < 1e-15, "{}", figures(&c));
    assert!((c.friction_excess - 2.0).abs() < 1e-12, "{}", figures(&c));
}

/// Den Hartog: half cycles of a block on a spring lose 2 μ M g / K1 each, then it sticks.
#[test]
fn exact_free_vibration_with_friction_passes() {
    let (mu, m, k) = (0.1, 248.0, 19_400.0);
    let omega = libm::sqrt(k / m);
    let (half_s, shift) = (core::f64::consts::PI / omega, mu * m * G / k);
    let start = 5.5 * shift;
    let slider = Slider { stiffness_n_per_m: k, ..slider(coulomb([mu; 2], [mu; 2])) };
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
    assert!((call.margin - 0.5).abs() < 1e-12 && call.kind == "stop", "{call:?}");
}

/// A block that never slides: the oscillator on a ramp, y = −(j/ω²)(t − sin ωt/ω).
#[test]
fn exact_oscillator_on_ramp_passes() {
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
fn exact_free_free_vibration_passes() {
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

/// What cannot be judged is refused, without a panic.
#[test]
fn exact_broken_histories_are_refused() {
    let system = &systems()[2];
    let history = history_of(system);
    let breaks: [fn(&mut History); 8] = [
        |h| *h = History::default(),
        |h| h.mode.truncate(9),
        |h| h.storey_velocity_m_per_s.truncate(9),
        |h| h.storeys = 2,
        |h| h.time_s.swap(3, 4),
        |h| h.time_s[0] = f64::NAN,
        |h| h.sliding_velocity_m_per_s[7] = f64::NAN,
        |h| h.table_acceleration_m_per_s2[7] = f64::NAN,
    ];
    for (i, damage) in breaks.into_iter().enumerate() {
        let mut broken = history.clone();
        damage(&mut broken);
        let c = judge(system, &broken);
        assert!(!c.holds() && worst(&c) == f64::INFINITY, "{i}: {}", figures(&c));
    }
}

/// A motion of zero leaves nothing to decide and nothing to divide by.
#[test]
fn exact_rest_has_zero_figures() {
    let motion = GroundMotion::evenly_spaced(0.1, vec![0.0; 11], None).unwrap();
    let System { model, .. } = systems().swap_remove(2);
    let system = System { name: "at rest", model, motion };
    let c = judge(&system, &history_of(&system));
    assert_eq!(worst(&c), 0.0);
    assert_eq!(c.closest_call, None);
}

/// A frame at rest on a slope is in equilibrium to rounding, and its friction is the closest call.
#[test]
fn exact_rest_on_slope_passes() {
    let motion = GroundMotion::evenly_spaced(0.1, vec![0.0; 11], None).unwrap();
    let System { model, .. } = systems().swap_remove(5);
    let model = with(&model, |slider, _| slider.tilt_rad = 0.01);
    let system = System { name: "at rest on a slope", model, motion };
    let c = judge(&system, &history_of(&system));
    assert!(worst(&c) < 1e-11, "{}", figures(&c));
    let call = c.closest_call.unwrap();
    assert!((call.margin - (1.0 - libm::tan(0.01) / 0.06)).abs() < 1e-12, "{call:?}");
}
