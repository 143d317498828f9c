//! The cases that are values rather than histories: limit cycles, drift, amplification.
//!
//! Each is computed from responses to a sampled sine; formulas stand only where the case is one.

use std::f64::consts::{PI, TAU};

use slipstick::model::{Block, Damping, Frame, InitialState, Model, Slider};
use slipstick::response::{Event, EventKind, Mode};
use slipstick::slider::Friction;

use super::cases::{Case, cycles, number, text_of};
use super::compare::{Numbers, Outcome, Report, Solve};

/// Values of a case by their names, from `per_cycle` samples a cycle.
pub fn values(case: &Case, solve: Solve, per_cycle: usize) -> Numbers {
    match text_of(case.field("group")).as_str() {
        "sdof" => fixed_base(case, solve, per_cycle),
        "ampwindow" => amplification(case, solve, per_cycle),
        "tilt" | "vertical" => drift(case, solve, per_cycle),
        _ if case.id == "HARM-CRIT" => critical(case),
        _ if case.id.starts_with("HARM-START") => from_rest(case, solve, per_cycle),
        _ => limit_cycle(case, solve, per_cycle),
    }
}

/// Compares the values from `per_cycle` samples a cycle with their case, by the rule for sampled
/// sines: 3 max(measured, 8.2e-5) (200/N)² of the value, or the stated tolerance where nothing was
/// sampled.
pub fn judge(case: &Case, solve: Solve, per_cycle: usize, report: &mut Report) {
    let found = values(case, solve, per_cycle);
    let measured = case.field("sampled").get("measured_relative_error").map(|list| {
        let list = list.as_object().expect("measured errors");
        list.values().map(number).fold(8.2e-5, f64::max)
    });
    for expected in case.list("expect") {
        let name = text_of(&expected["q"]);
        let value = found.get(&name).copied().unwrap_or(f64::NAN);
        let (wanted, stated) = (number(&expected["value"]), number(&expected["tol_abs"]));
        let fineness = 200.0 / per_cycle as f64;
        let rule = measured.map_or(0.0, |m| 3.0 * m * fineness * fineness * wanted.abs());
        // Counts, formulas, and what is found with a fineness of its own.
        let own = ["n_events", "contraction", "critical", "first-order"];
        let stands = own.iter().any(|start| name.starts_with(start));
        let tolerance = if stands { stated } else { stated.max(rule) };
        report.compare(&format!("{name}, {per_cycle} a cycle"), value, wanted, tolerance);
    }
}

/// A response to cycles `from` to `to` of the case's sine that goes on from the state after cycle
/// `from`, and the state it started from.
struct Window {
    outcome: Outcome,
    start: Numbers,
}

fn window(case: &Case, model: &Model, solve: Solve, n: usize, from: usize, to: usize) -> Window {
    let before = solve(model, &case.cycles(n, 0, from));
    let start = before.numbers;
    let (y, v) = (start.get("final_y"), start.get("final_v"));
    let state = InitialState {
        sliding_displacement_m: start["final_z"],
        sliding_velocity_m_per_s: start["final_w"],
        storey_displacement_m: Some(y.into_iter().copied().collect()),
        storey_velocity_m_per_s: Some(v.into_iter().copied().collect()),
    };
    let going_on = with(model.slider().clone(), model, state);
    Window { outcome: solve(&going_on, &case.cycles(n, from, to)), start }
}

fn with(slider: Slider, model: &Model, initial: InitialState) -> Model {
    Model::new(*model.block(), slider, model.frame().clone(), model.gravity_m_per_s2(), initial)
        .expect("a model")
}

fn fixed(model: &Model) -> Model {
    let held = Friction::new(1e3, 1e3).expect("friction");
    with(model.slider().clone().with_friction(held), model, model.initial().clone())
}

fn square(x: f64) -> f64 {
    x * x
}

/// Half of the distance between the turning points, which are events, and their middle.
fn half_range(events: &[Event]) -> (f64, f64) {
    let z = events.iter().map(|e| e.sliding_displacement_m);
    let (low, high) =
        (z.clone().fold(f64::INFINITY, f64::min), z.fold(f64::NEG_INFINITY, f64::max));
    if low > high { (0.0, 0.0) } else { (0.5 * (high - low), 0.5 * (high + low)) }
}

fn phase(event: &Event, omega: f64) -> f64 {
    (event.time_s * omega).rem_euclid(TAU)
}

/// Sections C1–C5 and D3.
fn limit_cycle(case: &Case, solve: Solve, n: usize) -> Numbers {
    const DISCARDED: usize = 160;
    const KEPT: usize = 2;
    let [a, omega, _] = case.sine();
    let window = window(case, &case.model(), solve, n, DISCARDED, DISCARDED + KEPT);
    let events = &window.outcome.events;
    let mut x = Numbers::new();
    let mut put = |name: &str, value: f64| {
        x.insert(name.to_owned(), value);
    };
    let (half, _) = half_range(events);
    put("half_pp_z", half);
    put("half_pp_z / (A/omega^2)", half * omega * omega / a);
    let p = |name| case.parameter(name, 0.0);
    put("half_pp_z/(M a/K)", half * p("K1") / (p("M1") * a));
    let sliding_s = window.outcome.numbers["sliding_time"];
    put("slide_fraction", sliding_s * omega / (TAU * KEPT as f64));
    put("peak_w", window.outcome.numbers["peak_abs_w"]);
    let [eta_s, eta_d] = ["mu_s", "mu_d"].map(|mu| p(mu) * p("g") / a);
    put("critical LHS eta_s^2+(pi eta_d/2)^2", eta_s * eta_s + square(0.5 * PI * eta_d));
    let to = |kind, sign: f64| {
        let fits = move |e: &&Event| e.kind == kind && (sign == 0.0 || e.mode.sign() == sign);
        events.iter().find(fits).copied()
    };
    if let Some(turn) = to(EventKind::Reversal, -1.0) {
        put("reversal phase phi (rad, a=A sin theta)", phase(&turn, omega));
    }
    if let Some(slip) = to(EventKind::Slip, -1.0) {
        put("slip start phase", phase(&slip, omega));
        let stop = events.iter().find(|e| e.time_s > slip.time_s && e.kind == EventKind::Stick);
        if let Some(stop) = stop {
            put("slip end phase", phase(&slip, omega) + omega * (stop.time_s - slip.time_s));
        }
    }
    let name = "contraction_per_half_cycle";
    if case.list("expect").iter().any(|e| e["q"] == name) {
        put(name, contraction(case, solve).unwrap_or(f64::NAN));
    }
    x
}

/// Ratio of successive deviations of the reversal phase from that of the limit cycle (C6), from
/// the first pair small enough for the ratio to be the limit's.
///
/// It hangs on the table acceleration at the very reversal, which straight lines get wrong by
/// ω²h²/8 in a way that depends on where between two samples it falls: so many samples that the
/// stated tolerance of 1e-6 holds.
fn contraction(case: &Case, solve: Solve) -> Option<f64> {
    let [_, omega, _] = case.sine();
    let outcome = solve(&case.model(), &case.cycles(4000, 0, 80));
    let turns = outcome.events.iter().filter(|e| e.kind == EventKind::Reversal);
    // Both directions of a cycle turn at the same phase of their own half cycle.
    let half = |e: &Event| (e.time_s * omega).rem_euclid(PI);
    let phases: Vec<f64> = turns.map(half).collect();
    let limit = *phases.last()?;
    let small = |pair: &&[f64]| (pair[0] - limit).abs() < 1e-6;
    let pair = phases.windows(2).find(small)?;
    Some(((pair[1] - limit) / (pair[0] - limit)).abs())
}

/// C6: from rest at a phase.
fn from_rest(case: &Case, solve: Solve, n: usize) -> Numbers {
    let [a, omega, _] = case.sine();
    let outcome = solve(&case.model(), &case.motion(n, false));
    let end_s = number(case.field("t_end"));
    let last = outcome.events.iter().filter(|e| e.time_s > end_s - TAU / omega * 1.001);
    let (half, offset) = half_range(&last.copied().collect::<Vec<_>>());
    Numbers::from([
        ("half_pp_z".to_owned(), half),
        ("offset".to_owned(), offset),
        ("offset of limit-cycle mid position / (A/omega^2)".to_owned(), offset * omega * omega / a),
        ("max_abs_z".to_owned(), outcome.numbers["peak_abs_z"]),
    ])
}

/// I and J1: drift per cycle.
fn drift(case: &Case, solve: Solve, n: usize) -> Numbers {
    const KEPT: usize = 4;
    let [a, omega, _] = case.sine();
    let window = window(case, &case.model(), solve, n, 40, 40 + KEPT);
    let per_cycle = (window.outcome.numbers["final_z"] - window.start["final_z"]) / KEPT as f64;
    let mut positive_s = 0.0;
    let (mut from_s, mut mode) = (0.0, window.outcome.initial_mode);
    let end = (KEPT as f64 * TAU / omega, Mode::Stick);
    let changes = window.outcome.events.iter().map(|e| (e.time_s, e.mode)).chain([end]);
    for (time_s, next) in changes {
        if mode.sign() > 0.0 {
            positive_s += time_s - from_s;
        }
        (from_s, mode) = (time_s, next);
    }
    let p = |name| case.parameter(name, 0.0);
    let theta = p("tilt");
    let eta = p("mu_d") * libm::cos(theta) * p("g") / a;
    let small_tilt = -PI * PI * a / (omega * omega) * libm::tan(theta) / p("mu_d");
    Numbers::from([
        ("drift_per_cycle".to_owned(), per_cycle),
        ("drift_per_cycle/(A/omega^2)".to_owned(), per_cycle * omega * omega / a),
        ("fraction of the cycle with w>0".to_owned(), positive_s * omega / (TAU * KEPT as f64)),
        (
            "first-order (small tilt) estimate, informative".to_owned(),
            small_tilt * (1.0 - square(0.5 * PI * eta)).sqrt(),
        ),
    ])
}

/// C2: a formula; `closed_form_critical_ratio_separates_stops_from_none` shows it in responses.
fn critical(case: &Case) -> Numbers {
    let critical = 1.0 / (1.0 + 0.25 * PI * PI).sqrt();
    let names = case.list("expect").iter().map(|e| text_of(&e["q"]));
    names.zip([critical, 1.0 / critical]).collect()
}

/// F1: steady state of an oscillator on a held block.
fn fixed_base(case: &Case, solve: Solve, n: usize) -> Numbers {
    let p = |name| case.parameter(name, 0.0);
    let text = case.id.trim_start_matches("SDOF-SS-");
    let frequency_hz: f64 = text.split('-').next().expect("a frequency").parse().expect("Hz");
    let rate = TAU * p("fn");
    let frame = Frame {
        masses_kg: vec![p("M2")],
        stiffnesses_n_per_m: vec![p("M2") * rate * rate],
        damping: Damping::Ratio(p("xi")),
        heights_m: None,
    };
    let slider = Slider::new(Friction::new(p("mu_s"), p("mu_d")).expect("friction"));
    let block = Block { mass_kg: p("M1"), width_m: None, height_m: None };
    // The steady state of the undisturbed sine, H = q/Ü; what sampling leaves of a transient is of
    // the order of what it takes off the sine, and goes with it in the extrapolation.
    let omega = TAU * frequency_hz;
    let (re, im) = (rate * rate - omega * omega, 2.0 * p("xi") * rate * omega);
    let gain = -1.0 / (re * re + im * im);
    let state = InitialState {
        storey_displacement_m: Some(vec![-gain * im]),
        storey_velocity_m_per_s: Some(vec![gain * re * omega]),
        ..InitialState::rest()
    };
    let model = Model::new(block, slider, frame, 9.81, state).expect("a model");
    let peaks = |n: usize| {
        let x = solve(&model, &cycles([1.0, omega, 0.0], None, n, 0, 2)).numbers;
        ["peak_abs_a2", "peak_abs_y"].map(|name| x[name])
    };
    // Errors fall as 1/N²: from N and 2N the limit.
    let (coarse, fine) = (peaks(10 * n), peaks(20 * n));
    let [a2, y] = [0, 1].map(|i| fine[i] + (fine[i] - coarse[i]) / 3.0);
    Numbers::from([
        ("abs acceleration amplification".to_owned(), a2),
        ("pseudo (relative displacement) amplification".to_owned(), y * rate * rate),
    ])
}

/// L: the mock-ups on sines, sliding and held.
fn amplification(case: &Case, solve: Solve, n: usize) -> Numbers {
    let [a, _, _] = case.sine();
    let model = case.model();
    let held = fixed(&model);
    let motion = case.motion(n, false);
    let sliding = solve(&model, &motion);
    let [run, run_held] =
        [sliding.numbers["peak_abs_a2"], solve(&held, &motion).numbers["peak_abs_a2"]];
    let names = case.list("expect").iter().map(|e| text_of(&e["q"]));
    let steady_name =
        names.clone().find(|q| q.contains("10 cycles after")).expect("a steady state");
    let word = steady_name.split_whitespace().rev().nth(1).expect("a number of cycles");
    let from: usize = word.parse().expect("a number of cycles");
    let peak = |m: &Model, from: usize, to: usize| {
        window(case, m, solve, n, from, to).outcome.numbers["peak_abs_a2"]
    };
    let steady = peak(&model, from, from + 10);
    // What is left of the transient of the held oscillator, exp(−ξ ω t), is below 1e-9 then.
    let steady_held = peak(&held, 400, 402);
    let mut x = Numbers::new();
    for name in names {
        let value = match name.as_str() {
            "peak_abs_a2 sliding, 0..20 s from rest" => run,
            "peak_abs_a2 fixed block, 0..20 s from rest" => run_held,
            "ratio sliding/fixed, 0..20 s" => run / run_held,
            "ratio sliding peak / table amplitude, 0..20 s" => run / a,
            "peak_abs_a2 fixed steady state" => steady_held,
            "ratio sliding/fixed steady" => steady / steady_held,
            "ratio sliding steady peak / table amplitude" => steady / a,
            "n_events 0..20 s" => sliding.events.len() as f64,
            _ => steady,
        };
        x.insert(name, value);
    }
    x
}
