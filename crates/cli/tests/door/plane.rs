//! Verification cases in two horizontal directions through the command: model file and two records in,
//! JSON, history and events out, each figure within the tolerance of its case.

use std::fmt::Write;

use serde_json::Value;

use super::cases::{name, number, numbers, sample_at_states};
use super::support::{Folder, cells, column, text};

fn model(case: &Value) -> String {
    let (p, initial) = (&case["params"], &case["initial"]);
    let quantity = |value: &Value, unit: &str| format!("\"{:?} {unit}\"", number(value));
    let pair = |value: &Value, unit: &str| {
        format!("[{}, {}]", quantity(&value[0], unit), quantity(&value[1], unit))
    };
    let kinetic = match &p["mu_exp"] {
        Value::Null => format!("{:?}", number(&p["mu_d"])),
        by_speed => format!(
            "{{ slow = {:?}, fast = {:?}, rate = {} }}",
            number(&by_speed["slow"]),
            number(&by_speed["fast"]),
            quantity(&by_speed["rate"], "s/m"),
        ),
    };
    let mut text = format!(
        "[block]\nmass = {}\n[slider]\nstatic_friction = {:?}\nkinetic_friction = {kinetic}\ndamper = {}\n",
        quantity(&p["M1"], "kg"),
        number(&p["mu_s"]),
        quantity(&p["C1"], "N s/m"),
    );
    match &p["R"] {
        Value::Null => writeln!(text, "spring = {}", quantity(&p["K1"], "N/m")),
        radius => writeln!(text, "radius = {}", quantity(radius, "m")),
    }
    .unwrap();
    if !p["gap"].is_null() {
        writeln!(text, "gap = {}", quantity(&p["gap"], "m")).unwrap();
    }
    let masses = p["m"].as_array().unwrap();
    for (i, mass) in masses.iter().enumerate() {
        write!(
            text,
            "[[storey]]\nmass = {}\nstiffness = {}\nstiffness_y = {}\ndamping_ratio = {:?}\n\
             damping_ratio_y = {:?}\n",
            quantity(mass, "kg"),
            quantity(&p["kx"][i], "N/m"),
            quantity(&p["ky"][i], "N/m"),
            number(&p["xi"]),
            number(&p["xiy"]),
        )
        .unwrap();
    }
    write!(
        text,
        "[motion]\nrecord = \"x.csv\"\nrecord_y = \"y.csv\"\n[analysis]\ngravity = {}\n[initial]\n\
         sliding_displacement = {}\nsliding_velocity = {}\n",
        quantity(&p["g"], "m/s2"),
        pair(&initial["s"], "m"),
        pair(&initial["w"], "m/s"),
    )
    .unwrap();
    if !masses.is_empty() {
        for (key, of, unit) in [("displacement", "q", "m"), ("velocity", "v", "m/s")] {
            let all: Vec<String> =
                initial[of].as_array().unwrap().iter().map(|value| pair(value, unit)).collect();
            writeln!(text, "storey_{key} = [{}]", all.join(", ")).unwrap();
        }
    }
    text
}

/// Times, then ax, ay and perhaps av, with the times of the states as samples, up to the case's end.
fn samples(case: &Value) -> Vec<Vec<f64>> {
    let input = &case["input"];
    let names = ["t", "ax", "ay", "av"].into_iter().filter(|name| input[name].is_array());
    let mut columns: Vec<Vec<f64>> = names.map(|name| numbers(&input[name])).collect();
    sample_at_states(case, &mut columns);
    columns
}

fn csv(columns: &[(&str, &[f64])]) -> String {
    let header: Vec<&str> = columns.iter().map(|(name, _)| *name).collect();
    let mut text = header.join(",");
    for i in 0..columns[0].1.len() {
        let row: Vec<String> =
            columns.iter().map(|(_, values)| format!("{:?}", values[i])).collect();
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
    /// A figure by its path: `x.storeys[0].peak_drift_m`.
    fn figure(&self, path: &str) -> f64 {
        let pointer = path.replace(['.', '['], "/").replace(']', "");
        let found = self.json.pointer(&format!("/{pointer}"));
        number(found.unwrap_or_else(|| panic!("no {path}")))
    }

    /// A column along x and along y of the first row at a time.
    fn vector(&self, time_s: f64, stem: &str, unit: &str) -> [f64; 2] {
        let times = column(&self.history, "time_s");
        let row = times.iter().position(|t| (t - time_s).abs() <= 1e-12);
        let row = row.expect("a row at the state's time");
        [format!("{stem}_{unit}"), format!("{stem}_y_{unit}")]
            .map(|name| column(&self.history, &name)[row])
    }
}

/// All that is outside its tolerance.
fn faults(case: &Value, answer: &Answer) -> Vec<String> {
    let mut faults = Vec::new();
    let mut compare = |what: String, found: f64, expected: f64, tolerance: f64| {
        if !((found - expected).abs() <= tolerance) {
            faults
                .push(format!("{what}: expected {expected:e} ± {tolerance:.0e}, found {found:e}"));
        }
    };
    for expected in case["expect"].as_array().unwrap() {
        let (value, tolerance) = (&expected["value"], &expected["tol_abs"]);
        if !value.is_null() {
            let q = name(&expected["q"]);
            compare(q.to_owned(), answer.figure(q), number(value), number(tolerance));
        }
    }
    if case["compare_sequence"] == true {
        let kinds = cells(&answer.events, "kind");
        let times = column(&answer.events, "time_s");
        let count = case["event_times"].as_array().unwrap().len();
        compare("number of events".to_owned(), times.len() as f64, count as f64, 0.0);
        let vectors = ["direction", "sliding_displacement"];
        let units = ["", "_m"];
        let [direction, place] = [0, 1].map(|i| {
            ["", "_y"]
                .map(|axis| column(&answer.events, &format!("{}{axis}{}", vectors[i], units[i])))
        });
        for (i, event) in case["events"].as_array().unwrap().iter().enumerate().take(times.len()) {
            let same = kinds[i] == name(&event["kind"]);
            compare(format!("kind of event {i}"), f64::from(u8::from(same)), 1.0, 0.0);
            compare(
                format!("time of event {i}"),
                times[i],
                number(&event["t"]),
                number(&event["tol_t"]),
            );
            for axis in 0..2 {
                let (s, tolerance) = (number(&event["s"][axis]), number(&event["tol_s"]));
                compare(format!("place of event {i}"), place[axis][i], s, tolerance);
                if let Some(expected) = event["direction"][axis].as_f64() {
                    let tolerance = number(&event["tol_direction"]);
                    compare(
                        format!("direction of event {i}"),
                        direction[axis][i],
                        expected,
                        tolerance,
                    );
                }
            }
        }
        for (i, time) in
            case["event_times"].as_array().unwrap().iter().enumerate().take(times.len())
        {
            compare(format!("time of event {i}"), times[i], number(time), 1e-10);
        }
    }
    for state in case["states"].as_array().unwrap() {
        let time_s = number(&state["t"]);
        for (key, stem, unit) in
            [("s", "sliding_displacement", "m"), ("w", "sliding_velocity", "m_per_s")]
        {
            let found = answer.vector(time_s, stem, unit);
            for axis in 0..2 {
                let tolerance = number(&state[format!("tol_{key}")]);
                compare(
                    format!("{key} at {time_s} s"),
                    found[axis],
                    number(&state[key][axis]),
                    tolerance,
                );
            }
        }
        for (key, stem, unit) in [("q", "displacement", "m"), ("v", "velocity", "m_per_s")] {
            for (i, expected) in state[key].as_array().unwrap().iter().enumerate() {
                let tolerance = &state[format!("tol_{key}")];
                let tolerance = tolerance.as_f64().unwrap_or_else(|| number(&tolerance[i]));
                let found = answer.vector(time_s, &format!("storey{}_{stem}", i + 1), unit);
                for axis in 0..2 {
                    compare(
                        format!("{key} at {time_s} s"),
                        found[axis],
                        number(&expected[axis]),
                        tolerance,
                    );
                }
            }
        }
    }
    faults
}

#[test]
fn reference_two_directions_through_the_command() {
    let file: Value =
        serde_json::from_str(include_str!("../../../../data/reference/bidirectional.json"))
            .unwrap();
    let mut wrong = String::new();
    let mut compared = 0;
    for case in file["cases"].as_array().unwrap() {
        let id = name(&case["id"]);
        let folder = Folder::with_model("two-directions", &model(case));
        let columns = samples(case);
        let mut along_x = vec![("time_s", &columns[0][..]), ("acceleration_m_per_s2", &columns[1])];
        if let Some(up) = columns.get(3) {
            along_x.push(("vertical_acceleration_m_per_s2", up));
        }
        folder.write("x.csv", csv(&along_x));
        let along_y = [("time_s", &columns[0][..]), ("acceleration_m_per_s2", &columns[2][..])];
        folder.write("y.csv", csv(&along_y));
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
    assert_eq!(compared, 18);
}

#[test]
fn a_script_for_opensees_is_printed_in_one_and_in_two_directions() {
    let folder = Folder::new("plane-opensees");
    let record = "time_s,acceleration_m_per_s2\n0,0\n0.5,3\n1,0\n";
    folder.write("x.csv", record);
    folder.write("y.csv", record);
    let model = "[block]\nmass = \"100 kg\"\n[slider]\nstatic_friction = 0.1\nkinetic_friction = 0.1\n\
                 radius = \"2 m\"\n[motion]\nrecord = \"x.csv\"\n";
    folder.write("one.toml", model);
    folder.write("two.toml", format!("{model}record_y = \"y.csv\"\n"));
    let script = |model: &str, option: &str| folder.stdout(&["run", model, option]);
    // μ N/10 µm
    let stiffness = "K_INIT = 9806650.0";
    assert!(script("one.toml", "--to-opensees").contains(stiffness));
    let two = script("two.toml", "--to-opensees=2 kN/mm");
    assert!(
        two.contains("K_INIT = 2000000.0") && two.contains("NDM, NDF, TOLERANCE = 3, 6"),
        "{two}"
    );
    let refused = folder.refused(&["run", "one.toml", "--to-opensees=2 kN"]);
    assert!(refused.contains("--to-opensees: expected"), "{refused}");
    let refused = folder.refused(&[
        "run",
        "one.toml",
        "--set",
        "slider.static_friction=0.2",
        "--to-opensees",
    ]);
    assert!(refused.contains("--to-opensees: "), "{refused}");
}

/// A block released by one bit more than friction starts with no acceleration but the rounding of it, which once
/// kept the first step from having a length.
#[test]
fn a_release_by_one_bit_more_than_friction_moves_on() {
    let folder = Folder::new("plane-release");
    let example = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/taft.toml");
    let mut arguments = vec!["run", example];
    for set in [
        "motion.record_y=records/taft-021.txt",
        "motion.rotate=90 deg",
        "motion.scale_to=0.5 g",
        "slider.static_friction=0.1",
        "slider.kinetic_friction=0.1",
    ] {
        arguments.extend(["--set", set]);
    }
    let answer = folder.stdout(&arguments);
    assert!(answer.contains("Check    passed"), "{answer}");
}
