//! The verification cases of `data/reference/devices.json`: stops, friction by speed,
//! surfaces in series, contents.

// Helpers of tests may panic as tests do.
#![allow(clippy::disallowed_macros, clippy::expect_used)]

use crate::common::cases::{number, numbers, text_of};
use serde_json::Value;
use slipstick::model::{Block, Contents, Damping, Frame, InitialState, Model, Slider, Stop};
use slipstick::motion::GroundMotion;
use slipstick::response::{EventKind, Mode, Response};
use slipstick::slider::{Friction, RateCurve, RateLaw, Surface, SurfacesInSeries};
use slipstick::solver::{exact, exact_demands};

/// The model; nothing here is told which solver takes it.
fn model(case: &Value) -> Model {
    let params = &case["params"];
    let p = |name: &str| params.get(name).map_or(0.0, number);
    let optional = |value: &Value| value.as_f64();
    let initial = &case["initial"];
    let (masses_kg, k) = (numbers(&params["m"]), numbers(&params["k"]));
    let contents: Vec<Contents> = params
        .get("equipment")
        .map(|e| Contents {
            floor: e["floor"].as_u64().expect("a floor") as usize,
            mass_kg: number(&e["m"]),
            static_friction: number(&e["mu_s"]),
            kinetic_friction: number(&e["mu_d"]),
        })
        .into_iter()
        .collect();
    let curve = if let Some(knots) = params.get("mu_v") {
        let speeds_m_per_s = numbers(&knots["v"]);
        Some(RateCurve::Pieces { speeds_m_per_s, coefficients: numbers(&knots["mu"]) })
    } else {
        params.get("mu_exp").map(|law| RateCurve::Exponential {
            slow: number(&law["slow"]),
            fast: number(&law["fast"]),
            rate_s_per_m: number(&law["rate"]),
        })
    };
    let rate = curve.map(|curve| RateLaw::new(curve, [1.0; 2]).expect("a rate law"));
    let radius_m = params.get("R").map(number);
    let stop = params.get("stop").map(|stop| {
        let gap_m = ["gap_pos", "gap_neg"].map(|side| optional(&stop[side]));
        match text_of(&stop["type"]).as_str() {
            "elastic" => Stop::elastic(gap_m, number(&stop["k"]), number(&stop["c"])),
            _ => Stop::rigid(gap_m, number(&stop["e"])),
        }
    });
    let surfaces = params["surfaces"].as_array().map(|surfaces| {
        let surface = |s: &Value| Surface {
            radius_m: optional(&s["R"]),
            friction: number(&s["mu"]),
            travel_m: optional(&s["d"]),
        };
        SurfacesInSeries::new(surfaces.iter().map(surface).collect(), p("static_ratio"))
            .expect("surfaces")
    });
    let bearing = || {
        let friction = match rate {
            Some(rate) => Friction::by_speed([p("mu_s"); 2], rate),
            None => Friction::new(p("mu_s"), p("mu_d")),
        };
        let friction = friction.expect("friction");
        match radius_m {
            Some(radius_m) => Slider::pendulum(friction, radius_m),
            None => Slider::sprung(friction, p("K1")),
        }
    };
    Model::new(
        Block { mass_kg: p("M1"), width_m: None, height_m: None },
        Slider {
            damper_n_s_per_m: p("C1"),
            tilt_rad: p("tilt"),
            ends: stop.into(),
            ..surfaces.map_or_else(bearing, Slider::in_series)
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
    .with_contents(contents)
    .expect("contents")
}

/// The motion up to the end of the case, with the times of the states as collinear samples.
fn motion(case: &Value) -> GroundMotion {
    let input = &case["input"];
    let end_s = number(&case["t_end"]);
    let states = case["states"].as_array().expect("states").iter().map(|s| number(&s["t"]));
    let mut columns = vec![numbers(&input["t"]), numbers(&input["a"])];
    columns.extend(input.get("av").map(numbers));
    for time_s in states.chain([end_s]) {
        let t = &columns[0];
        if t.contains(&time_s) {
            continue;
        }
        let i = t.iter().position(|x| *x > time_s).expect("a time inside the record");
        let part = (time_s - t[i - 1]) / (t[i] - t[i - 1]);
        for column in &mut columns {
            column.insert(i, column[i - 1] + (column[i] - column[i - 1]) * part);
        }
        columns[0][i] = time_s;
    }
    let count = columns[0].iter().filter(|t| **t <= end_s).count();
    columns.iter_mut().for_each(|column| column.truncate(count));
    let vertical = (columns.len() == 3).then(|| columns.pop()).flatten();
    let a = columns.pop().expect("accelerations");
    GroundMotion::new(columns.remove(0), a, vertical).expect("a motion")
}

struct Report {
    id: String,
    wrong: Vec<String>,
    figures: usize,
    worst: f64,
    /// The figure that is so, and its tolerance.
    what: String,
    tolerance: f64,
}

impl Report {
    fn compare(&mut self, what: &str, found: f64, wanted: f64, tolerance: f64) {
        let off = (found - wanted).abs();
        self.figures += 1;
        let part = if off == 0.0 { 0.0 } else { off / tolerance };
        if part > self.worst || self.what.is_empty() {
            (self.worst, self.what, self.tolerance) = (part, what.to_owned(), tolerance);
        }
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

/// What the case calls an interface.
fn interface_name(case: &Value, interface: usize) -> Option<&'static str> {
    case["params"].get("equipment").map(|_| if interface == 0 { "block" } else { "equipment" })
}

fn judge(case: &Value, response: &Response, report: &mut Report) {
    let (d, h) = (&response.demands, response.history.as_ref().expect("a history"));
    let times = numbers(&case["event_times"]);
    if times.len() != response.events.len() {
        let found: Vec<_> = response.events.iter().map(|e| (e.time_s, e.kind.name())).collect();
        report.wrong.push(format!(
            "{}: {} events, found {} {found:?}",
            report.id,
            times.len(),
            found.len()
        ));
        return;
    }
    let tolerances = case["events"].as_array().expect("events");
    for (i, (event, time_s)) in response.events.iter().zip(&times).enumerate() {
        let tolerance = match event.kind {
            EventKind::Rest => 1e-8,
            _ => tolerances.get(i).map_or(1e-10, |event| number(&event["tol_t"])),
        };
        report.compare(&format!("time of event {i}"), event.time_s, *time_s, tolerance);
    }
    for (event, wanted) in response.events.iter().zip(tolerances) {
        let kind = text_of(&wanted["kind"]);
        let same_interface = wanted.get("interface").map(text_of).as_deref()
            == interface_name(case, event.interface);
        if event.kind.name() != kind
            || mode_name(event.mode) != text_of(&wanted["to"])
            || !same_interface
        {
            report.wrong.push(format!("{}: {event:?} instead of {wanted}", report.id));
        }
        let (place, tolerance) = match event.interface {
            0 => ("z", "tol_z"),
            _ => ("r", "tol_r"),
        };
        let (z, tolerance) = (number(&wanted[place]), number(&wanted[tolerance]));
        report.compare("place of an event", event.sliding_displacement_m, z, tolerance);
    }
    for (kind, count) in case["counts"].as_object().expect("counts") {
        let (interface, name) = kind.split_once('.').map_or((0, kind.as_str()), |(_, k)| (1, k));
        let found = response.events.iter();
        let found = found.filter(|e| e.interface == interface && e.kind.name() == name).count();
        report.compare(&format!("count of {kind}"), found as f64, number(count), 0.0);
    }
    let last = h.len() - 1;
    let stop = || d.stop.as_ref().expect("demands of the stop");
    let expected = case["expect"].as_array().expect("expected values");
    for wanted in expected {
        let name = text_of(&wanted["q"]);
        let storey = |end: &str| name.rsplit(end).next().and_then(|i| i.parse::<usize>().ok());
        let found = match name.as_str() {
            "peak_abs_a1" => d.peak_block_acceleration_m_per_s2,
            "peak_impact_speed" => stop().peak_impact_speed_m_per_s,
            "peak_stop_force" => stop().peak_force_n,
            "peak_abs_ae" => d.contents[0].peak_acceleration_m_per_s2,
            "peak_abs_p" => d.contents[0].peak_sliding_velocity_m_per_s,
            "peak_abs_r" => d.contents[0].peak_sliding_displacement_m,
            "final_r" => d.contents[0].residual_sliding_displacement_m,
            "final_p" => h.contents_state(last, 0)[1],
            "equipment_path" => d.contents[0].sliding_path_m,
            "equipment_sliding_time" => d.contents[0].sliding_time_s,
            "peak_abs_w" => d.peak_sliding_velocity_m_per_s,
            "peak_abs_z" => d.peak_sliding_displacement_m,
            "final_z" => d.residual_sliding_displacement_m,
            "final_w" => h.sliding_velocity_m_per_s[last],
            "slip_path" => d.sliding_path_m,
            "sliding_time" => d.sliding_time_s,
            _ if name.starts_with("final_u") => {
                d.surfaces[storey("u").expect("a surface") - 1].residual_displacement_m
            }
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
        if state.get("r").is_some() {
            for (i, (name, tolerance)) in
                [("r", "tol_r"), ("p", "tol_p"), ("a_equipment", "tol_a_equipment")]
                    .iter()
                    .enumerate()
            {
                let found = h.contents_state(row, 0)[i];
                let (wanted, tolerance) = (number(&state[*name]), number(&state[*tolerance]));
                report.compare(&format!("{name} at {time_s}"), found, wanted, tolerance);
            }
        }
    }
}

/// Events, peaks and states of all cases of a group within their tolerances, and a certificate that
/// holds.
fn run(group: &str, count: usize) {
    let text = include_str!("../../../../data/reference/devices.json");
    let file: Value = serde_json::from_str(text).expect("devices.json is JSON");
    let mut wrong = Vec::new();
    let mut cases = 0;
    for case in file["cases"].as_array().expect("cases") {
        if text_of(&case["group"]) != group {
            continue;
        }
        cases += 1;
        let (model, motion) = (model(case), motion(case));
        let mut report = Report {
            id: text_of(&case["id"]),
            wrong: vec![],
            figures: 0,
            worst: 0.0,
            what: String::new(),
            tolerance: 0.0,
        };
        let response = match exact(&model, &motion) {
            Ok(response) => response,
            Err(error) => {
                wrong.push(format!("{}: {error}", report.id));
                continue;
            }
        };
        judge(case, &response, &mut report);
        let plain = exact_demands(&model, &motion).expect("demands");
        if (&plain.demands, &plain.events) != (&response.demands, &response.events) {
            report.wrong.push(format!("{}: other demands without a history", report.id));
        }
        let certificate = slipstick::check::check(&model, &motion, &response);
        let [a, b, c, d] = [
            certificate.equilibrium_residual,
            certificate.friction_excess,
            certificate.energy_balance_error,
            certificate.demands_error,
        ];
        if !certificate.holds() {
            report.wrong.push(format!("{}: certificate {a:e} {b:e} {c:e} {d:e}", report.id));
        }
        let Report { id, figures, worst, what, tolerance, .. } = &report;
        println!(
            "case {id}: {figures} figures, worst {worst:.1e} of its tolerance {tolerance:.1e} ({what})"
        );
        wrong.extend(report.wrong);
    }
    assert_eq!(cases, count, "cases of {group}");
    assert!(wrong.is_empty(), "{} differences:\n{}", wrong.len(), wrong.join("\n"));
}

macro_rules! groups {
    ($($name:ident: $group:literal, $count:literal;)*) => {
        $(#[test]
        fn $name() {
            run($group, $count);
        })*

        /// No case of the file is left out.
        #[test]
        fn every_group_is_a_test() {
            let file: Value =
                serde_json::from_str(include_str!("../../../../data/reference/devices.json"))
                    .expect("devices.json is JSON");
            assert_eq!(file["cases"].as_array().expect("cases").len(), 0 $(+ $count)*);
        }
    };
}

groups! {
    reference_elastic_stops: "stop-elastic", 6;
    reference_rigid_stops: "stop-rigid", 6;
    reference_friction_in_pieces: "mu-pieces", 5;
    reference_exponential_friction: "mu-exponential", 9;
    reference_pendulum: "pendulum", 1;
    reference_surfaces_in_series: "series", 7;
    reference_contents: "equipment", 4;
    reference_nasty_devices: "nasty", 5;
}
