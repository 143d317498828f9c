//! The verification cases of `data/reference/devices.json`: stops at the ends of the gap.

// Helpers of tests may panic as tests do.
#![allow(clippy::disallowed_macros, clippy::expect_used)]

mod common;

use common::cases::{number, numbers, text_of};
use serde_json::Value;
use slipstick::friction::{Coulomb, Friction};
use slipstick::model::{Block, Damping, Frame, InitialState, Model, Slider, Stop, StopKind};
use slipstick::motion::GroundMotion;
use slipstick::response::{Mode, Response};
use slipstick::solver::exact;

fn model(case: &Value) -> Model {
    let params = &case["params"];
    let p = |name: &str| params.get(name).map_or(0.0, number);
    let initial = &case["initial"];
    let (masses_kg, k) = (numbers(&params["m"]), numbers(&params["k"]));
    let total_kg = masses_kg.iter().sum::<f64>() + p("M1");
    let friction = Coulomb::new([p("mu_s"); 2], [p("mu_d"); 2]).expect("friction");
    let stop = &params["stop"];
    let spring = params.get("R").map_or(p("K1"), |radius| total_kg * p("g") / number(radius));
    Model::new(
        Block { mass_kg: p("M1"), width_m: None, height_m: None },
        Slider {
            friction: Friction::Coulomb(friction),
            stiffness_n_per_m: spring,
            damper_n_s_per_m: p("C1"),
            tilt_rad: p("tilt"),
            gap_m: None,
            stop: Some(Stop {
                gap_m: ["gap_pos", "gap_neg"].map(|side| stop[side].as_f64()),
                kind: StopKind::Elastic {
                    stiffness_n_per_m: number(&stop["k"]),
                    damper_n_s_per_m: number(&stop["c"]),
                },
            }),
        },
        Frame {
            masses_kg,
            stiffnesses_n_per_m: k,
            damping: Damping::Ratio(p("xi")),
            heights_m: None,
        },
        p("g"),
        InitialState {
            sliding_displacement_m: number(&initial["z"]),
            sliding_velocity_m_per_s: number(&initial["w"]),
            storey_displacement_m: Some(numbers(&initial["q"])),
            storey_velocity_m_per_s: Some(numbers(&initial["v"])),
        },
    )
    .expect("a model")
}

/// The motion up to the end of the case, with the times of the states as collinear samples.
fn motion(case: &Value) -> GroundMotion {
    let (t, a) = (numbers(&case["input"]["t"]), numbers(&case["input"]["a"]));
    let end_s = number(&case["t_end"]);
    let states = case["states"].as_array().expect("states").iter().map(|s| number(&s["t"]));
    let mut samples: Vec<(f64, f64)> = t.iter().copied().zip(a).filter(|x| x.0 <= end_s).collect();
    for time_s in states.chain([end_s]) {
        if samples.iter().any(|x| x.0 == time_s) {
            continue;
        }
        let i = t.iter().position(|x| *x > time_s).expect("a time inside the record");
        let all = numbers(&case["input"]["a"]);
        let part = (time_s - t[i - 1]) / (t[i] - t[i - 1]);
        let value = all[i - 1] + (all[i] - all[i - 1]) * part;
        let at = samples.iter().position(|x| x.0 > time_s).unwrap_or(samples.len());
        samples.insert(at, (time_s, value));
    }
    let (t, a) = samples.into_iter().unzip();
    GroundMotion::new(t, a, None).expect("a motion")
}

struct Report {
    id: String,
    wrong: Vec<String>,
    worst: f64,
}

impl Report {
    fn compare(&mut self, what: &str, found: f64, wanted: f64, tolerance: f64) {
        let off = (found - wanted).abs();
        self.worst = self.worst.max(off / tolerance);
        if !(off <= tolerance) {
            let id = &self.id;
            self.wrong
                .push(format!("{id}: {what} is {found:e}, wanted {wanted:e} ± {tolerance:e}"));
        }
    }
}

fn mode_name(mode: Mode) -> &'static str {
    match mode.sign() {
        s if s > 0.0 => "slip+",
        s if s < 0.0 => "slip-",
        _ => "stick",
    }
}

fn judge(case: &Value, response: &Response, report: &mut Report) {
    let (d, h) = (&response.demands, response.history.as_ref().expect("a history"));
    let stop = d.stop.as_ref().expect("demands of the stop");
    let times = numbers(&case["event_times"]);
    if times.len() != response.events.len() {
        let found: Vec<_> = response.events.iter().map(|e| (e.time_s, e.kind.name())).collect();
        report.wrong.push(format!("{}: {} events, found {found:?}", report.id, times.len()));
        return;
    }
    for (i, (event, time_s)) in response.events.iter().zip(&times).enumerate() {
        report.compare(&format!("time of event {i}"), event.time_s, *time_s, 1e-10);
    }
    for (event, wanted) in response.events.iter().zip(case["events"].as_array().expect("events")) {
        let kind = text_of(&wanted["kind"]);
        if event.kind.name() != kind || mode_name(event.mode) != text_of(&wanted["to"]) {
            report.wrong.push(format!("{}: {event:?} instead of {wanted}", report.id));
        }
        let (z, tolerance) = (number(&wanted["z"]), number(&wanted["tol_z"]));
        report.compare("z at an event", event.sliding_displacement_m, z, tolerance);
    }
    let last = h.len() - 1;
    let expected = case["expect"].as_array().expect("expected values");
    for wanted in expected {
        let name = text_of(&wanted["q"]);
        let storey = |end: &str| name.rsplit(end).next().and_then(|i| i.parse::<usize>().ok());
        let found = match name.as_str() {
            "peak_abs_a1" => d.peak_block_acceleration_m_per_s2,
            "peak_impact_speed" => stop.peak_impact_speed_m_per_s,
            "peak_stop_force" => stop.peak_force_n,
            "peak_abs_w" => d.peak_sliding_velocity_m_per_s,
            "peak_abs_z" => d.peak_sliding_displacement_m,
            "final_z" => d.residual_sliding_displacement_m,
            "final_w" => h.sliding_velocity_m_per_s[last],
            "slip_path" => d.sliding_path_m,
            "sliding_time" => d.sliding_time_s,
            _ if name.starts_with("peak_abs_a_s") => {
                d.storeys[storey("_s").expect("a storey") - 1].peak_acceleration_m_per_s2
            }
            _ if name.starts_with("peak_abs_q") => {
                d.storeys[storey("q").expect("a storey") - 1].peak_displacement_m
            }
            _ if name.starts_with("peak_abs_drift") => {
                d.storeys[storey("drift").expect("a storey") - 1].peak_drift_m
            }
            _ if name.starts_with("final_q") => {
                h.storey_displacements(last)[storey("q").expect("a storey") - 1]
            }
            _ if name.starts_with("final_v") => {
                h.storey_velocities(last)[storey("v").expect("a storey") - 1]
            }
            _ => panic!("nothing is known of {name}"),
        };
        report.compare(&name, found, number(&wanted["value"]), number(&wanted["tol_abs"]));
    }
    for state in case["states"].as_array().expect("states") {
        let time_s = number(&state["t"]);
        let row = *h.rows.iter().find(|&&row| h.time_s[row] == time_s).expect("a row");
        let mut compare = |name: &str, found: f64, tolerance: &str| {
            let tolerance = number(&state[tolerance]);
            report.compare(&format!("{name} at {time_s}"), found, number(&state[name]), tolerance);
        };
        compare("z", h.sliding_displacement_m[row], "tol_z");
        compare("w", h.sliding_velocity_m_per_s[row], "tol_w");
        compare("a1", h.block_acceleration_m_per_s2[row], "tol_a1");
        for (name, found, tolerance) in [
            ("q", h.storey_displacements(row), "tol_q"),
            ("v", h.storey_velocities(row), "tol_v"),
            ("a_storeys", h.storey_accelerations(row), "tol_a_storeys"),
        ] {
            let wanted = state.get(name).map_or(vec![], numbers);
            for (found, wanted) in found.iter().zip(wanted) {
                let tolerance = number(&state[tolerance]);
                report.compare(&format!("{name} at {time_s}"), *found, wanted, tolerance);
            }
        }
    }
}

/// Events, peaks and states within the stated tolerances, and a certificate that holds.
#[test]
fn reference_elastic_stops() {
    let text = include_str!("../../../data/reference/devices.json");
    let file: Value = serde_json::from_str(text).expect("devices.json is JSON");
    let mut wrong = Vec::new();
    for case in file["cases"].as_array().expect("cases") {
        let (model, motion) = (model(case), motion(case));
        let response = exact(&model, &motion).expect("a response");
        let mut report = Report { id: text_of(&case["id"]), wrong: vec![], worst: 0.0 };
        judge(case, &response, &mut report);
        let certificate = slipstick::check::check(&model, &motion, &response);
        if !certificate.holds() {
            let [a, b, c, d] = [
                certificate.equilibrium_residual,
                certificate.friction_excess,
                certificate.energy_balance_error,
                certificate.demands_error,
            ];
            report.wrong.push(format!("{}: certificate {a:e} {b:e} {c:e} {d:e}", report.id));
        }
        println!("{}: {:.1e} of its tolerances", report.id, report.worst);
        wrong.extend(report.wrong);
    }
    assert!(wrong.is_empty(), "{} differences:\n{}", wrong.len(), wrong.join("\n"));
}
