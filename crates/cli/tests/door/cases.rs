//! Verification cases through the command: model file and record in, JSON and CSV out, each figure
//! within the tolerance of its case.

use std::fmt::Write;

use serde_json::Value;

use super::support::{Folder, cells, column, text};

pub fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("expected a number, found {value}"))
}

pub fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(number).collect()
}

pub fn name(value: &Value) -> &str {
    value.as_str().unwrap()
}

/// Masses, stiffnesses of the storeys and what damps each.
fn storeys(case: &Value) -> Vec<(f64, f64, String)> {
    let p = &case["params"];
    if p["m"].is_array() {
        let ratio = format!("damping_ratio = {:?}", number(&p["xi"]));
        let both = numbers(&p["m"]).into_iter().zip(numbers(&p["k"]));
        return both.map(|(m, k)| (m, k, ratio.clone())).collect();
    }
    match number(&p["M2"]) {
        0.0 => vec![],
        m => {
            let damper = format!("damper = \"{:?} N s/m\"", number(&p["C2"]));
            vec![(m, number(&p["K2"]), damper)]
        }
    }
}

fn model(case: &Value) -> String {
    let (p, initial) = (&case["params"], &case["initial"]);
    let friction = |name: &str| match &p[format!("{name}_pos")] {
        Value::Null => format!("{:?}", number(&p[name])),
        positive => {
            let negative = number(&p[format!("{name}_neg")]);
            format!("{{ positive = {:?}, negative = {negative:?} }}", number(positive))
        }
    };
    let mut text = format!(
        "[block]\nmass = \"{:?} kg\"\n[slider]\ndamper = \"{:?} N s/m\"\ntilt = \"{:?} rad\"\n",
        number(&p["M1"]),
        number(&p["C1"]),
        number(&p["tilt"]),
    );
    text += &slider(p, friction);
    for (mass, stiffness, damping) in storeys(case) {
        write!(
            text,
            "[[storey]]\nmass = \"{mass:?} kg\"\nstiffness = \"{stiffness:?} N/m\"\n{damping}\n"
        )
        .unwrap();
    }
    let list = |key: &str, unit: &str| {
        let values = initial[key].as_array().cloned().unwrap_or_else(|| vec![initial[key].clone()]);
        let values: Vec<_> = values.iter().map(|v| format!("\"{:?} {unit}\"", number(v))).collect();
        format!("[{}]", values.join(", "))
    };
    write!(
        text,
        "[motion]\nrecord = \"record.csv\"\n[analysis]\ngravity = \"{:?} m/s2\"\n[initial]\n\
         sliding_displacement = \"{:?} m\"\nsliding_velocity = \"{:?} m/s\"\n",
        number(&p["g"]),
        number(&initial["z"]),
        number(&initial["w"]),
    )
    .unwrap();
    if !storeys(case).is_empty() {
        let q = if initial["q"].is_array() { "q" } else { "y" };
        let (q, v) = (list(q, "m"), list("v", "m/s"));
        write!(text, "storey_displacement = {q}\nstorey_velocity = {v}\n").unwrap();
    }
    text
}

/// Friction, spring, stops and surfaces.
fn slider(p: &Value, friction: impl Fn(&str) -> String) -> String {
    let quantity = |value: &Value, unit: &str| format!("\"{:?} {unit}\"", number(value));
    let mut text = String::new();
    if let Some(surfaces) = p["surfaces"].as_array() {
        let ratio = number(&p["static_ratio"]);
        writeln!(text, "static_ratio = {ratio:?}").unwrap();
        for surface in surfaces {
            writeln!(text, "[[slider.surface]]\nfriction = {:?}", number(&surface["mu"])).unwrap();
            for (key, name) in [("radius", "R"), ("travel", "d")] {
                if !surface[name].is_null() {
                    writeln!(text, "{key} = {}", quantity(&surface[name], "m")).unwrap();
                }
            }
        }
    } else {
        let kinetic = if p["mu_exp"].is_object() {
            let law = &p["mu_exp"];
            let [slow, fast] = ["slow", "fast"].map(|name| number(&law[name]));
            let rate = quantity(&law["rate"], "s/m");
            format!("{{ slow = {slow:?}, fast = {fast:?}, rate = {rate} }}")
        } else if p["mu_v"].is_object() {
            let speeds = p["mu_v"]["v"].as_array().unwrap().iter();
            let speeds: Vec<_> = speeds.map(|v| quantity(v, "m/s")).collect();
            let coefficients = numbers(&p["mu_v"]["mu"]);
            format!("{{ velocity = [{}], coefficient = {coefficients:?} }}", speeds.join(", "))
        } else {
            friction("mu_d")
        };
        let fixed = friction("mu_s");
        writeln!(text, "static_friction = {fixed}\nkinetic_friction = {kinetic}").unwrap();
        match &p["R"] {
            Value::Null => writeln!(text, "spring = {}", quantity(&p["K1"], "N/m")),
            radius => writeln!(text, "radius = {}", quantity(radius, "m")),
        }
        .unwrap();
    }
    let stop = &p["stop"];
    if stop.is_object() {
        let sides = [("positive", "gap_pos"), ("negative", "gap_neg")].into_iter();
        let sides = sides.filter(|(_, name)| !stop[name].is_null());
        let sides: Vec<_> =
            sides.map(|(side, name)| format!("{side} = {}", quantity(&stop[name], "m"))).collect();
        writeln!(text, "[slider.stop]\ngap = {{ {} }}", sides.join(", ")).unwrap();
        if stop["type"] == "elastic" {
            let (k, c) = (quantity(&stop["k"], "N/m"), quantity(&stop["c"], "N s/m"));
            writeln!(text, "stiffness = {k}\ndamper = {c}").unwrap();
        } else {
            writeln!(text, "restitution = {:?}", number(&stop["e"])).unwrap();
        }
    }
    let contents = &p["equipment"];
    if contents.is_object() {
        let mass = quantity(&contents["m"], "kg");
        let [fixed, kinetic] = ["mu_s", "mu_d"].map(|name| number(&contents[name]));
        writeln!(
            text,
            "[[contents]]\nfloor = {}\nmass = {mass}\nstatic_friction = {fixed:?}\n\
             kinetic_friction = {kinetic:?}",
            contents["floor"]
        )
        .unwrap();
    }
    text
}

/// Makes the times of a case's states samples on the straight lines of a record, and cuts it at the case's end.
pub fn sample_at_states(case: &Value, columns: &mut [Vec<f64>]) {
    let states = case["states"].as_array().unwrap().iter().map(|state| number(&state["t"]));
    let end_s = case["t_end"].as_f64();
    for time_s in states.chain(end_s) {
        if let Err(i) = columns[0].binary_search_by(|t| t.total_cmp(&time_s))
            && i < columns[0].len()
        {
            let x = (time_s - columns[0][i - 1]) / (columns[0][i] - columns[0][i - 1]);
            for column in columns.iter_mut() {
                column.insert(i, column[i - 1] + (column[i] - column[i - 1]) * x);
            }
            columns[0][i] = time_s;
        }
    }
    let count = columns[0].iter().filter(|t| end_s.is_none_or(|end_s| **t <= end_s)).count();
    columns.iter_mut().for_each(|column| column.truncate(count));
}

/// The record, with the times of the states as samples on its straight lines, up to the case's end.
fn record(case: &Value) -> String {
    let input = &case["input"];
    let mut columns = vec![numbers(&input["t"]), numbers(&input["a"])];
    let mut text = "time_s,acceleration_m_per_s2".to_owned();
    if input["av"].is_array() {
        columns.push(numbers(&input["av"]));
        text.push_str(",vertical_acceleration_m_per_s2");
    }
    sample_at_states(case, &mut columns);
    for i in 0..columns[0].len() {
        let row: Vec<String> = columns.iter().map(|column| format!("{:?}", column[i])).collect();
        write!(text, "\n{}", row.join(",")).unwrap();
    }
    text + "\n"
}

/// What the command says of a case.
struct Answer {
    json: Value,
    history: String,
    events: String,
}

impl Answer {
    /// A figure by the name that cases give it.
    fn figure(&self, q: &str) -> f64 {
        let plain = |pointer: &str| number(&self.json[pointer]);
        let last = |name: &str| *column(&self.history, name).last().unwrap();
        // Cases with one storey leave its number out.
        let split = q.trim_end_matches(|c: char| c.is_ascii_digit());
        let (stem, storey) = match q[split.len()..].parse::<usize>() {
            Ok(storey) if split != "peak_abs_a" => (split, storey),
            _ => (q, 1),
        };
        let of_storey = |key: &str| number(&self.json["storeys"][storey - 1][key]);
        let last_of = |column: &str| last(&format!("storey{storey}_{column}"));
        let of_contents = |key: &str| number(&self.json["contents"][0][key]);
        match stem {
            "peak_abs_z" => plain("peak_sliding_displacement_m"),
            "peak_abs_w" => plain("peak_sliding_velocity_m_per_s"),
            "peak_abs_a1" => number(&self.json["block"]["peak_acceleration_m_per_s2"]),
            "final_z" => plain("residual_sliding_displacement_m"),
            "final_w" => last("sliding_velocity_m_per_s"),
            "slip_path" => plain("sliding_path_m"),
            "sliding_time" => plain("sliding_time_s"),
            "t_uplift" => number(&self.json["contact_loss_s"][0][0]),
            "peak_abs_y" | "peak_abs_q" => of_storey("peak_displacement_m"),
            "peak_abs_a2" | "peak_abs_a_s" => of_storey("peak_acceleration_m_per_s2"),
            "peak_abs_drift" => of_storey("peak_drift_m"),
            "final_y" | "final_q" => last_of("displacement_m"),
            "final_v" => last_of("velocity_m_per_s"),
            "peak_impact_speed" => number(&self.json["stop"]["peak_impact_speed_m_per_s"]),
            "peak_stop_force" => number(&self.json["stop"]["peak_force_n"]),
            "final_u" => number(&self.json["surfaces"][storey - 1]["residual_displacement_m"]),
            "peak_abs_ae" => of_contents("peak_acceleration_m_per_s2"),
            "peak_abs_r" => of_contents("peak_sliding_displacement_m"),
            "peak_abs_p" => of_contents("peak_sliding_velocity_m_per_s"),
            "final_r" => of_contents("residual_sliding_displacement_m"),
            "final_p" => last("contents1_velocity_m_per_s"),
            "equipment_path" => of_contents("sliding_path_m"),
            "equipment_sliding_time" => of_contents("sliding_time_s"),
            _ => panic!("no figure for {q}"),
        }
    }

    /// The values of a state in the history's row at its time, the first where there are two.
    fn state(&self, time_s: f64, key: &str) -> Vec<f64> {
        let times = column(&self.history, "time_s");
        // Evenly spaced times are multiples of their step, an ulp from what was written.
        let row = times.iter().position(|t| (t - time_s).abs() <= 1e-12);
        let row = row.expect("a row at the state's time");
        let at = |name: &str| column(&self.history, name)[row];
        let of_storeys = |column: &str| {
            let count = self.json["storeys"].as_array().unwrap().len();
            (1..=count).map(|i| at(&format!("storey{i}_{column}"))).collect()
        };
        match key {
            "z" => vec![at("sliding_displacement_m")],
            "w" => vec![at("sliding_velocity_m_per_s")],
            "a1" => vec![at("block_acceleration_m_per_s2")],
            "y" | "q" => of_storeys("displacement_m"),
            "v" => of_storeys("velocity_m_per_s"),
            "a2" | "a_storeys" => of_storeys("acceleration_m_per_s2"),
            "r" => vec![at("contents1_displacement_m")],
            "p" => vec![at("contents1_velocity_m_per_s")],
            "a_equipment" => vec![at("contents1_acceleration_m_per_s2")],
            _ => panic!("no column for {key}"),
        }
    }
}

/// All that is outside its tolerance.
fn faults(case: &Value, answer: &Answer) -> Vec<String> {
    let mut faults = Vec::new();
    let mut compare = |what: String, found: f64, expected: f64, tolerance: f64| {
        // NaN must fail.
        if !((found - expected).abs() <= tolerance) {
            faults
                .push(format!("{what}: expected {expected:e} ± {tolerance:.0e}, found {found:e}"));
        }
    };
    for expected in case["expect"].as_array().unwrap() {
        let q = name(&expected["q"]);
        let (value, tolerance) = (number(&expected["value"]), number(&expected["tol_abs"]));
        compare(q.to_owned(), answer.figure(q), value, tolerance);
    }
    if case["compare_sequence"] == true {
        let events = case["events"].as_array().unwrap();
        let contents = case["params"]["equipment"].is_object();
        let count = case["n_events"].as_u64().map_or(events.len(), |count| count as usize);
        let found: Vec<String> = cells(&answer.events, "kind")
            .into_iter()
            .zip(cells(&answer.events, "interface"))
            .map(|(kind, interface)| format!("{interface} {kind}"))
            .collect();
        let expected = events.iter().map(|event| {
            let interface = match &event["interface"] {
                Value::String(name) if contents && name == "equipment" => "contents.1",
                _ => "slider",
            };
            format!("{interface} {}", name(&event["kind"]))
        });
        let expected: Vec<String> = expected.collect();
        compare("number of events".to_owned(), found.len() as f64, count as f64, 0.0);
        let first = &found[..expected.len().min(found.len())];
        compare("events".to_owned(), f64::from(u8::from(first != expected)), 0.0, 0.0);
        let times = column(&answer.events, "time_s");
        let places = column(&answer.events, "sliding_displacement_m");
        for (i, event) in events.iter().enumerate().take(times.len()) {
            let t = [&event["t"], &event["tol_t"]].map(number);
            compare(format!("time of event {i}"), times[i], t[0], t[1]);
            let [z, tolerance] = match &event["interface"] {
                Value::String(name) if name == "equipment" => ["r", "tol_r"],
                _ => ["z", "tol_z"],
            };
            let z = [&event[z], &event[tolerance]].map(number);
            compare(format!("place of event {i}"), places[i], z[0], z[1]);
        }
        for kind in ["slip", "reversal", "stick"] {
            let counted = number(&answer.json[format!("{kind}_count")]);
            compare(kind.to_owned(), counted, number(&case["counts"][kind]), 0.0);
            if contents {
                let counted = number(&answer.json["contents"][0][format!("{kind}_count")]);
                let wanted = case["counts"][format!("equipment.{kind}")].as_f64().unwrap_or(0.0);
                compare(format!("{kind} of contents"), counted, wanted, 0.0);
            }
        }
        if case["params"]["stop"].is_object() {
            for kind in ["contact", "impact"] {
                let counted = number(&answer.json["stop"][format!("{kind}_count")]);
                compare(
                    kind.to_owned(),
                    counted,
                    case["counts"][kind].as_f64().unwrap_or(0.0),
                    0.0,
                );
            }
        }
    }
    for state in case["states"].as_array().unwrap() {
        let time_s = number(&state["t"]);
        for key in ["z", "w", "a1", "y", "v", "a2", "q", "a_storeys", "r", "p", "a_equipment"] {
            let Some(value) = state.get(key) else { continue };
            let expected = value.as_array().cloned().unwrap_or_else(|| vec![value.clone()]);
            let tolerance = number(&state[format!("tol_{key}")]);
            for (found, expected) in answer.state(time_s, key).into_iter().zip(expected) {
                compare(format!("{key} at {time_s} s"), found, number(&expected), tolerance);
            }
        }
    }
    faults
}

/// Runs the cases of a file that are sampled in a folder of this name, and says how many.
fn through_the_command(folder_name: &str, file: &str) -> usize {
    let file: Value = serde_json::from_str(file).unwrap();
    let mut wrong = String::new();
    let mut compared = 0;
    for case in file["cases"].as_array().unwrap() {
        // Sines are compared where their samples can be chosen.
        if !name(&case["kind"]).starts_with("time-history") || case["input"]["type"] != "pwl" {
            continue;
        }
        let id = name(&case["id"]);
        let folder = Folder::with_model(folder_name, &model(case));
        folder.write("record.csv", record(case));
        let output = folder.output(&["run", "model.toml", "--json", "--out", "out"]);
        assert_eq!(output.status.code(), Some(0), "{id}: {}", text(&output.stderr));
        let answer = Answer {
            json: serde_json::from_slice(&output.stdout).unwrap(),
            history: folder.read("out/history.csv"),
            events: folder.read("out/events.csv"),
        };
        for fault in faults(case, &answer) {
            writeln!(wrong, "{id}: {fault}").unwrap();
        }
        compared += 1;
    }
    assert!(wrong.is_empty(), "{wrong}");
    compared
}

#[test]
fn reference_cases_through_the_command() {
    let compared =
        through_the_command("case", include_str!("../../../../data/reference/cases.json"));
    assert_eq!(compared, 48);
}

#[test]
fn reference_devices_through_the_command() {
    let compared =
        through_the_command("device", include_str!("../../../../data/reference/devices.json"));
    assert_eq!(compared, 43);
}
