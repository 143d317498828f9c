//! What a response says in the words of the cases, and its comparison with what they expect.

use std::collections::BTreeMap;

use serde_json::Value;
use slipstick::model::Model;
use slipstick::motion::GroundMotion;
use slipstick::response::{Event, EventKind, Mode, Response};

use super::cases::{Case, number, numbers, text_of};
use super::plain::{Reference, reference};

/// Numbers by the names of the cases (`peak_abs_z`, `final_q1`, …).
pub type Numbers = BTreeMap<String, f64>;

/// A response in the words of the cases.
pub struct Outcome {
    pub initial_mode: Mode,
    pub events: Vec<Event>,
    pub numbers: Numbers,
    /// Time, mode and numbers at the samples: limits from the left.
    pub states: Vec<(f64, Mode, Numbers)>,
    /// Just before and after the first release, where the response stores that: the reference does
    /// not.
    pub release: Option<[Numbers; 2]>,
    pub stores_release: bool,
}

/// A way to a response: the solver or the reference.
pub type Solve = fn(&Model, &GroundMotion) -> Outcome;

/// The name of a storey's number: the cases call those of a single storey by other names.
fn storey(storeys: usize, i: usize, prefix: &str, single: &str, many: &str) -> String {
    if storeys == 1 { format!("{prefix}{single}") } else { format!("{prefix}{many}{}", i + 1) }
}

/// The outcome of the plain reference.
pub fn by_reference(model: &Model, motion: &GroundMotion) -> Outcome {
    let r: Reference = reference(model, motion);
    let n = model.storeys();
    let last = r.samples.last().expect("samples");
    let mut numbers = Numbers::new();
    let mut put = |name: &str, x: f64| {
        numbers.insert(name.to_owned(), x);
    };
    put("peak_abs_z", r.peaks.s);
    put("peak_abs_w", r.peaks.w);
    put("peak_abs_a1", r.peaks.block);
    put("slip_path", r.path);
    put("sliding_time", r.sliding_time_s);
    put("final_z", last.s);
    put("final_w", last.w);
    if let Some([from, _]) = r.contact_loss_s.first() {
        put("t_uplift", *from);
    }
    for i in 0..n {
        put(&storey(n, i, "peak_abs_", "y", "q"), r.peaks.q[i]);
        put(&storey(n, i, "peak_abs_", "a2", "a_s"), r.peaks.floors[i]);
        put(&storey(n, i, "peak_abs_", "drift", "drift"), r.peaks.drift[i]);
        put(&storey(n, i, "final_", "y", "q"), last.q[i]);
        put(&storey(n, i, "final_", "v", "v"), last.v[i]);
    }
    let state = |s: &super::plain::Sample| {
        let x = knot(n, s.s, s.w, s.block, &s.q, &s.v, &s.floors);
        (s.time_s, s.mode, x)
    };
    let event = |e: &super::plain::Event| Event {
        time_s: e.time_s,
        kind: e.kind,
        mode: e.mode,
        sliding_displacement_m: e.s,
        interface: 0,
    };
    Outcome {
        initial_mode: r.initial_mode(),
        events: r.events.iter().map(event).collect(),
        numbers,
        states: r.samples.iter().map(state).collect(),
        release: None,
        stores_release: false,
    }
}

/// Numbers at an instant.
fn knot(n: usize, s: f64, w: f64, block: f64, q: &[f64], v: &[f64], floors: &[f64]) -> Numbers {
    let mut x = Numbers::new();
    x.insert("z".to_owned(), s);
    x.insert("w".to_owned(), w);
    x.insert("a1".to_owned(), block);
    for i in 0..n {
        x.insert(storey(n, i, "", "y", "q"), q[i]);
        x.insert(storey(n, i, "", "v", "v"), v[i]);
        x.insert(storey(n, i, "", "a2", "a_storeys"), floors[i]);
    }
    x
}

/// The outcome of a response with a history.
pub fn of_response(model: &Model, response: &Response) -> Outcome {
    let n = model.storeys();
    let d = &response.demands;
    let h = response.history.as_ref().expect("a history");
    let end = h.len() - 1;
    let mut numbers = Numbers::new();
    let mut put = |name: &str, x: f64| {
        numbers.insert(name.to_owned(), x);
    };
    put("peak_abs_z", d.peak_sliding_displacement_m);
    put("peak_abs_w", d.peak_sliding_velocity_m_per_s);
    put("peak_abs_a1", d.peak_block_acceleration_m_per_s2);
    put("slip_path", d.sliding_path_m);
    put("sliding_time", d.sliding_time_s);
    put("final_z", d.residual_sliding_displacement_m);
    put("final_w", h.sliding_velocity_m_per_s[end]);
    if let Some([from, _]) = response.contact_loss_s.first() {
        put("t_uplift", *from);
    }
    for i in 0..n {
        let peaks = &d.storeys[i];
        put(&storey(n, i, "peak_abs_", "y", "q"), peaks.peak_displacement_m);
        put(&storey(n, i, "peak_abs_", "a2", "a_s"), peaks.peak_acceleration_m_per_s2);
        put(&storey(n, i, "peak_abs_", "drift", "drift"), peaks.peak_drift_m);
        put(&storey(n, i, "final_", "y", "q"), h.storey_displacements(end)[i]);
        put(&storey(n, i, "final_", "v", "v"), h.storey_velocities(end)[i]);
    }
    let at = |i: usize| {
        knot(
            n,
            h.sliding_displacement_m[i],
            h.sliding_velocity_m_per_s[i],
            h.block_acceleration_m_per_s2[i],
            h.storey_displacements(i),
            h.storey_velocities(i),
            h.storey_accelerations(i),
        )
    };
    let released = |i: &usize| h.mode[*i] == Mode::Stick && h.mode[i + 1] != Mode::Stick;
    let initial = h.time_s.iter().rposition(|t| *t == 0.0).expect("a knot at the start");
    Outcome {
        initial_mode: h.mode[initial],
        events: response.events.clone(),
        numbers,
        states: (0..h.len()).map(|i| (h.time_s[i], h.mode[i], at(i))).collect(),
        release: (0..end).find(released).map(|i| [at(i), at(i + 1)]),
        stores_release: true,
    }
}

/// What a comparison found.
#[derive(Debug, Default)]
pub struct Report {
    /// Number of figures compared.
    pub figures: usize,
    /// Largest error over its tolerance (0/0 = 0), and the figure that is so.
    pub worst: f64,
    pub what: String,
    /// Tolerance of that figure.
    pub tolerance: f64,
    /// One line for each figure outside its tolerance.
    pub wrong: Vec<String>,
}

impl Report {
    /// Compares a figure with what is expected.
    pub fn compare(&mut self, what: &str, value: f64, expected: f64, tolerance: f64) {
        let error = (value - expected).abs();
        let ratio = if error == 0.0 { 0.0 } else { error / tolerance };
        if self.figures == 0 || ratio > self.worst {
            (self.worst, self.what, self.tolerance) = (ratio, what.to_owned(), tolerance);
        }
        self.figures += 1;
        // NaN must fail.
        if !(error <= tolerance) {
            self.wrong.push(format!(
                "{what}: expected {expected:e}, found {value:e}, off by {error:.2e} > {tolerance:.2e}"
            ));
        }
    }
}

/// Compares a time history with its case.
pub fn judged(case: &Case, solve: Solve) -> Report {
    // A sine needs so many samples that its straight lines cost less than the tolerance (3.3 / N²
    // times the sensitivity).
    let per_cycle = 1_000_000;
    let model = case.model();
    let outcome = solve(&model, &case.motion(per_cycle, false));
    let mut report = Report::default();
    let mut compare = |what: &str, value: f64, expected: f64, tolerance: f64| {
        report.compare(what, value, expected, tolerance);
    };
    if case.field("compare_sequence") == true {
        let expected = case.list("events");
        let both = outcome.events.iter().zip(expected);
        for (i, (event, expected)) in both.enumerate() {
            let named = |key: &str| number(&expected[key]);
            let what = |name: &str| format!("event {} at {}: {name}", i + 1, named("t"));
            compare(&what("time"), event.time_s, named("t"), named("tol_t"));
            compare(&what("z"), event.sliding_displacement_m, named("z"), named("tol_z"));
            let same = kind(event.kind) == expected["kind"] && mode(event.mode) == expected["to"];
            compare(&what("kind"), f64::from(u8::from(same)), 1.0, 0.0);
        }
        compare("number of events", outcome.events.len() as f64, expected.len() as f64, 0.0);
        for name in ["slip", "reversal", "stick"] {
            let count = outcome.events.iter().filter(|e| kind(e.kind) == name).count();
            compare(name, count as f64, number(&case.field("counts")[name]), 0.0);
        }
    }
    let same = mode(outcome.initial_mode) == *case.field("initial_mode");
    compare("initial mode", f64::from(u8::from(same)), 1.0, 0.0);
    for expected in case.list("expect") {
        let name = text_of(&expected["q"]);
        let value = outcome.numbers.get(&name).copied().unwrap_or(f64::NAN);
        compare(&name, value, number(&expected["value"]), number(&expected["tol_abs"]));
    }
    let states = !case.list("states").is_empty();
    let dense = states.then(|| solve(&model, &case.motion(per_cycle, true)));
    let with_states = dense.as_ref().unwrap_or(&outcome);
    for expected in case.list("states") {
        let time_s = number(&expected["t"]);
        let (found_mode, state) = left_limit(with_states, time_s);
        let what = |name: &str| format!("state at {time_s}: {name}");
        let same = mode(found_mode) == expected["mode"];
        compare(&what("mode"), f64::from(u8::from(same)), 1.0, 0.0);
        for name in ["z", "w", "y", "v", "a1", "a2", "q", "a_storeys"] {
            let Some(values) = expected.get(name) else { continue };
            let tolerance = number(&expected[format!("tol_{name}")]);
            for (i, value) in numbers(values).into_iter().enumerate() {
                let key =
                    if values.is_array() { format!("{name}{}", i + 1) } else { name.to_owned() };
                compare(&what(&key), state[&key], value, tolerance);
            }
        }
    }
    for expected in case.list("closed_form") {
        let name = text_of(&expected["q"]);
        let value = closed_form(case, &outcome, with_states, &name);
        let (wanted, tolerance) = (number(&expected["value"]), number(&expected["tol_abs"]));
        if value.is_some() || outcome.stores_release {
            let value = value.unwrap_or(f64::NAN);
            compare(&format!("closed form: {name}"), value, wanted, tolerance);
        }
    }
    report
}

fn left_limit(outcome: &Outcome, time_s: f64) -> (Mode, &Numbers) {
    let (_, mode, state) = outcome
        .states
        .iter()
        .find(|(t, _, _)| *t >= time_s - 1e-12)
        .unwrap_or_else(|| panic!("no state at {time_s}"));
    (*mode, state)
}

/// The number of a response that a closed form stands for.
fn closed_form(case: &Case, outcome: &Outcome, dense: &Outcome, name: &str) -> Option<f64> {
    let events = |k: EventKind| outcome.events.iter().filter(move |e| e.kind == k);
    let slips = || events(EventKind::Slip);
    let sticks = || events(EventKind::Stick);
    let stops = || outcome.events.iter().filter(|e| e.kind != EventKind::Slip);
    let z = |e: &Event| e.sliding_displacement_m;
    let t = |e: &Event| e.time_s;
    if let Some(k) = name.strip_prefix("turning_point_") {
        return stops().nth(k.parse::<usize>().ok()? - 1).map(z);
    }
    let state = |time_s: f64, key: &str| Some(left_limit(dense, time_s).1[key]);
    let release = |side: usize, key: &str| outcome.release.as_ref().map(|r| r[side][key]);
    match name {
        "t_slip" => slips().next().map(t),
        "t_release" => slips().next_back().map(t),
        "t_stop1" | "t_first_stop" => stops().next().map(t),
        "t_stop" | "t_stop_final" | "t_stick" => sticks().next_back().map(t),
        "t_reversal" => events(EventKind::Reversal).next().map(t),
        "t_uplift" => outcome.numbers.get(name).copied(),
        "final_z" | "final_w" | "peak_abs_w" => outcome.numbers.get(name).copied(),
        "z(T)" => outcome.numbers.get("final_z").copied(),
        "y(T)" => outcome.numbers.get("final_y").copied(),
        "peak_z" | "z_after_first_slip" | "z_first_stop" => stops().next().map(z),
        "z_residual" => slips().next_back().map(z),
        "n_half_cycles" => Some(stops().count() as f64),
        "half_period" => Some(outcome.events[1].time_s - outcome.events[0].time_s),
        "dead band |z| = mu_s M g/K1" => {
            let p = |name| case.parameter(name, 0.0);
            Some(p("mu_s") * p("M1") * p("g") / p("K1"))
        }
        "free-free damped frequency Hz" => {
            let turns: Vec<_> = events(EventKind::Reversal).map(t).collect();
            Some(0.5 * (turns.len() - 1) as f64 / (turns.last()? - turns[0]))
        }
        "a1 just before release" => release(0, "a1"),
        "a1 just after release" => release(1, "a1"),
        "y at release" => release(1, "y"),
        "v at release" => release(1, "v"),
        "y(1.0)" => state(1.0, "y"),
        "y(2.5)" => state(2.5, "y"),
        "y(0.37)" => state(0.37, "y"),
        "z(0.37)" => state(0.37, "z"),
        _ => panic!("{}: no number for the closed form {name:?}", case.id),
    }
}

fn kind(kind: EventKind) -> Value {
    Value::from(kind.name())
}

fn mode(mode: Mode) -> Value {
    Value::from(match mode.sign() as i32 {
        0 => "stick",
        1 => "slip+",
        _ => "slip-",
    })
}
