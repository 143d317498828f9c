//! Two horizontal directions: every verification case of `data/reference/bidirectional.json` with constant
//! and with exponential friction, as two solvers that share nothing agree on it, and the judge.

// Every case says how close it came. Helpers of tests may panic as tests do.
#![allow(clippy::disallowed_macros, clippy::expect_used)]

use crate::common::in_plane::{cases, list, model, motion, number, numbers};
use serde_json::Value;
use slipstick::check::check;
use slipstick::response::{Demands, EventKind, History, Mode, Response};
use slipstick::solver::exact;

/// A figure of a response by its path in the results.
fn figure(response: &Response, path: &str) -> f64 {
    let in_plane = response.in_plane.as_deref().expect("two directions");
    let (demands, rest) = match path.split_once('.') {
        Some(("x", rest)) => (&in_plane.axes[0], rest),
        Some(("y", rest)) => (&in_plane.axes[1], rest),
        _ => (&response.demands, path),
    };
    match rest {
        "least_sliding_speed_m_per_s" => {
            in_plane.least_sliding_speed_m_per_s.expect("a least speed")
        }
        "peak_sliding_displacement_direction_rad" => {
            in_plane.peak_sliding_displacement_direction_rad
        }
        _ => of_demands(demands, rest),
    }
}

fn of_demands(demands: &Demands, path: &str) -> f64 {
    if let Some(rest) = path.strip_prefix("storeys[") {
        let (storey, what) = rest.split_once("].").expect("a storey");
        let storey = &demands.storeys[storey.parse::<usize>().expect("a number")];
        return match what {
            "peak_acceleration_m_per_s2" => storey.peak_acceleration_m_per_s2,
            "peak_displacement_m" => storey.peak_displacement_m,
            "peak_drift_m" => storey.peak_drift_m,
            "peak_drift_velocity_m_per_s" => storey.peak_drift_velocity_m_per_s,
            what => panic!("no {what}"),
        };
    }
    match path {
        "peak_sliding_displacement_m" => demands.peak_sliding_displacement_m,
        "peak_sliding_displacement_time_s" => demands.peak_sliding_displacement_time_s,
        "max_sliding_displacement_m" => demands.max_sliding_displacement_m,
        "min_sliding_displacement_m" => demands.min_sliding_displacement_m,
        "residual_sliding_displacement_m" => demands.residual_sliding_displacement_m,
        "sliding_path_m" => demands.sliding_path_m,
        "sliding_time_s" => demands.sliding_time_s,
        "peak_sliding_velocity_m_per_s" => demands.peak_sliding_velocity_m_per_s,
        "block.peak_acceleration_m_per_s2" => demands.peak_block_acceleration_m_per_s2,
        "peak_friction_force_n" => demands.peak_friction_force_n,
        "peak_slider_force_n" => demands.peak_slider_force_n,
        "peak_base_shear_n" => demands.peak_base_shear_n,
        "gap_ratio" => demands.gap_ratio.expect("a gap"),
        "slip_count" => demands.slip_count as f64,
        "stick_count" => demands.stick_count as f64,
        "reversal_count" => demands.reversal_count as f64,
        path => panic!("no {path}"),
    }
}

/// What was compared: how many figures, the worst in parts of its tolerance, and those outside.
#[derive(Default)]
struct Compared {
    figures: usize,
    /// Part of its tolerance, that, and of what.
    worst: (f64, f64, String),
    wrong: Vec<String>,
}

impl Compared {
    fn compare(&mut self, what: &str, found: f64, expected: f64, tolerance: f64) {
        self.figures += 1;
        let error = (found - expected).abs();
        let part = if error == 0.0 { 0.0 } else { error / tolerance };
        if part > self.worst.0 {
            self.worst = (part, tolerance, what.to_owned());
        }
        if !(part <= 1.0) {
            self.wrong.push(format!("{what}: expected {expected}, found {found}, {error:.1e} off"));
        }
    }

    fn pair(&mut self, what: &str, found: [f64; 2], expected: &Value, tolerance: f64) {
        for (axis, name) in ["x", "y"].into_iter().enumerate() {
            let what = format!("{what} {name}");
            self.compare(&what, found[axis], number(&expected[axis]), tolerance);
        }
    }
}

fn compare_events(case: &Value, response: &Response, compared: &mut Compared) {
    let in_plane = response.in_plane.as_deref().expect("two directions");
    let times_s = numbers(&case["event_times"]);
    compared.compare("events", response.events.len() as f64, times_s.len() as f64, 0.0);
    for (i, (event, time_s)) in response.events.iter().zip(times_s).enumerate() {
        compared.compare(&format!("event {i} time"), event.time_s, time_s, 1e-10);
    }
    let expected = list(&case["events"]).iter().enumerate();
    for ((i, expected), (event, by_axis)) in
        expected.zip(response.events.iter().zip(&in_plane.events))
    {
        let kind = match event.kind {
            EventKind::Slip => "slip",
            EventKind::Stick => "stick",
            _ => "another",
        };
        if expected["kind"] != kind {
            compared.wrong.push(format!("event {i}: expected {}, found {kind}", expected["kind"]));
        }
        let s = [event.sliding_displacement_m, by_axis.sliding_displacement_y_m];
        compared.pair(&format!("event {i} s"), s, &expected["s"], number(&expected["tol_s"]));
        if expected["direction"].is_array() {
            let tolerance = number(&expected["tol_direction"]);
            let what = format!("event {i} direction");
            compared.pair(&what, by_axis.direction, &expected["direction"], tolerance);
        } else {
            assert_eq!(by_axis.direction, [0.0; 2]);
        }
    }
}

fn compare_states(case: &Value, response: &Response, compared: &mut Compared) {
    let x: &History = response.history.as_ref().expect("a history");
    let in_plane = response.in_plane.as_deref().expect("two directions");
    let y = in_plane.history.as_ref().expect("a history along y");
    for state in list(&case["states"]) {
        let time_s = number(&state["t"]);
        let knot = x.time_s.iter().position(|t| *t == time_s).expect("a knot at the state");
        let mode = if x.mode[knot] == Mode::Stick { "stick" } else { "slip" };
        if state["mode"] != mode {
            compared.wrong.push(format!("{time_s} s: expected {}, found {mode}", state["mode"]));
        }
        let of = |lists: [&[f64]; 2], i: usize| lists.map(|list| list[i]);
        let s = of([&x.sliding_displacement_m, &y.sliding_displacement_m], knot);
        let w = of([&x.sliding_velocity_m_per_s, &y.sliding_velocity_m_per_s], knot);
        compared.pair(&format!("s at {time_s}"), s, &state["s"], number(&state["tol_s"]));
        compared.pair(&format!("w at {time_s}"), w, &state["w"], number(&state["tol_w"]));
        for i in 0..x.storeys {
            let place = knot * x.storeys + i;
            let q = of([&x.storey_displacement_m, &y.storey_displacement_m], place);
            let v = of([&x.storey_velocity_m_per_s, &y.storey_velocity_m_per_s], place);
            let tolerance = state["tol_q"].get(i).map_or_else(|| number(&state["tol_q"]), number);
            compared.pair(&format!("q{i} at {time_s}"), q, &state["q"][i], tolerance);
            compared.pair(&format!("v{i} at {time_s}"), v, &state["v"][i], number(&state["tol_v"]));
        }
    }
}

/// Fails with every number of the case that is outside its stated tolerance.
fn run(id: &str) {
    let case = cases().into_iter().find(|case| case["id"] == id).expect("the case");
    let (model, motion) = (model(&case), motion(&case));
    let response = exact(&model, &motion).expect("a response");
    let mut compared = Compared::default();
    compare_events(&case, &response, &mut compared);
    compare_states(&case, &response, &mut compared);
    for expected in list(&case["expect"]) {
        let path = expected["q"].as_str().expect("a path");
        let found = figure(&response, path);
        compared.compare(path, found, number(&expected["value"]), number(&expected["tol_abs"]));
    }
    let c = check(&model, &motion, &response);
    let judged = c.equilibrium_residual.max(c.friction_excess).max(c.energy_balance_error);
    let judged = judged.max(c.demands_error);
    // The states agree to 1e-13 or so: what the judge finds of them is no larger.
    compared.compare("what the judge finds", judged, 0.0, 1e-11);
    let Compared { figures, worst: (worst, tolerance, what), wrong } = compared;
    println!(
        "case {id}: {figures} figures, worst {worst:.1e} of its tolerance {tolerance:.1e} ({what})"
    );
    assert!(wrong.is_empty(), "{id}:\n{}", wrong.join("\n"));
}

macro_rules! cases {
    ($($name:ident: $id:literal,)*) => {
        $(#[test]
        fn $name() {
            run($id);
        })*

        /// No case is left out.
        #[test]
        fn every_case_is_a_test() {
            let ids: Vec<String> = cases()
                .iter()
                .map(|case| case["id"].as_str().expect("a text").to_owned())
                .collect();
            assert_eq!(ids, [$($id),*]);
        }
    };
}

cases! {
    closed_form_push_stop: "BIDI-PUSH-STOP",
    closed_form_near_miss: "BIDI-NEAR-MISS",
    closed_form_circle: "BIDI-CIRCLE",
    reference_ellipse: "BIDI-ELLIPSE",
    reference_sines_equal: "BIDI-SINES-EQUAL",
    closed_form_release: "BIDI-RELEASE",
    reference_many_stops: "BIDI-MANY-STOPS",
    reference_jumps: "BIDI-JUMPS",
    reference_free_pendulum: "BIDI-FREE-PENDULUM",
    reference_oblique_1: "BIDI-OBLIQUE-1",
    reference_vertical_0: "BIDI-VERTICAL-0",
    reference_spring_damper_1: "BIDI-SPRING-DAMPER-1",
    reference_xy_1: "BIDI-XY-1",
    reference_taft_pendulum_1: "BIDI-TAFT-PENDULUM-1",
    reference_uneven_2: "BIDI-UNEVEN-2",
    reference_xy_3: "BIDI-XY-3",
    reference_exponential_friction_1: "BIDI-EXP-TAFT-1",
    reference_weakening_friction: "BIDI-EXP-FREE",
}
