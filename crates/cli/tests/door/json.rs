//! The keys of `--json` are a promise.

use serde_json::Value;

use super::support::{BLOCK, Folder};

#[derive(Clone, Copy)]
enum Kind {
    Text,
    Count,
    Number,
    NumberOrNull,
    Bool,
    List,
}
use Kind::{Bool, Count, List, Number, NumberOrNull, Text};

/// Every key that any run has, dots as slashes.
const KEYS: [(&str, Kind); 38] = [
    ("/slipstick", Text),
    ("/model", Text),
    ("/method", Text),
    ("/samples", Count),
    ("/dt_s", NumberOrNull),
    ("/duration_s", Number),
    ("/record/pga_m_per_s2", Number),
    ("/record/pgv_m_per_s", Number),
    ("/record/pgd_m", Number),
    ("/record/end_velocity_m_per_s", Number),
    ("/peak_sliding_displacement_m", Number),
    ("/peak_sliding_displacement_time_s", Number),
    ("/max_sliding_displacement_m", Number),
    ("/min_sliding_displacement_m", Number),
    ("/residual_sliding_displacement_m", Number),
    ("/sliding_at_end", Bool),
    ("/sliding_path_m", Number),
    ("/peak_sliding_velocity_m_per_s", Number),
    ("/sliding_time_s", Number),
    ("/slip_count", Count),
    ("/reversal_count", Count),
    ("/stick_count", Count),
    ("/block/peak_acceleration_m_per_s2", Number),
    ("/storeys", List),
    ("/peak_base_shear_n", Number),
    ("/peak_friction_force_n", Number),
    ("/peak_slider_force_n", Number),
    ("/base_shear_coefficient", Number),
    ("/friction_coefficient_used", Number),
    ("/slider_force_coefficient", Number),
    ("/gap_ratio", NumberOrNull),
    ("/overturning_ratio", NumberOrNull),
    ("/contact_loss_s", List),
    ("/warnings", List),
    ("/checks/equilibrium_residual", Number),
    ("/checks/friction_excess", Number),
    ("/checks/energy_balance_error", Number),
    ("/checks/demands_error", Number),
];

fn check(value: &Value, path: &str, kind: Kind) {
    let found = value.pointer(path).unwrap_or_else(|| panic!("no {path} in {value:#}"));
    let right = match kind {
        Text => found.is_string(),
        Count => found.is_u64(),
        Number => found.is_number(),
        NumberOrNull => found.is_number() || found.is_null(),
        Bool => found.is_boolean(),
        List => found.is_array(),
    };
    assert!(right, "{path}: {found}");
}

fn check_run(value: &Value, storeys: usize) {
    for (path, kind) in KEYS {
        check(value, path, kind);
    }
    assert_eq!(value["storeys"].as_array().unwrap().len(), storeys);
    for storey in value["storeys"].as_array().unwrap() {
        check(storey, "/peak_acceleration_m_per_s2", Number);
        check(storey, "/peak_displacement_m", Number);
        check(storey, "/peak_drift_m", Number);
        check(storey, "/peak_drift_ratio", NumberOrNull);
        check(storey, "/peak_drift_velocity_m_per_s", Number);
    }
    for warning in value["warnings"].as_array().unwrap() {
        check(warning, "/kind", Text);
        check(warning, "/time_s", NumberOrNull);
        check(warning, "/message", Text);
    }
    for interval in value["contact_loss_s"].as_array().unwrap() {
        check(interval, "/0", Number);
        check(interval, "/1", Number);
    }
    let call = value.pointer("/checks/closest_call").expect("closest_call");
    if !call.is_null() {
        check(call, "/margin", Number);
        check(call, "/time_s", Number);
        check(call, "/kind", Text);
    }
}

#[test]
fn keys_of_a_block() {
    let folder = Folder::with_model("json-block", BLOCK);
    let json = folder.json(&["model.toml"]);
    check_run(&json, 0);
    assert_eq!((&json["model"], &json["method"]), (&"Block".into(), &"exact".into()));
    assert_eq!((&json["samples"], &json["dt_s"]), (&501.into(), &0.01.into()));
    assert_eq!(json["slipstick"], env!("CARGO_PKG_VERSION"));
    assert!(json["gap_ratio"].is_null() && json["overturning_ratio"].is_null());
    assert!(!json["checks"]["closest_call"].is_null());
    assert_eq!(json["peak_base_shear_n"], 0.0);
    assert!(json.get("iterations").is_none() && json.get("bounds").is_none());
}

#[test]
fn keys_with_bounds_heights_and_iterations() {
    let storeys = "\n[[storey]]\nmass = \"40 kg\"\nstiffness = \"50 kN/m\"\ndamping_ratio = 0.02\n\
                   height = \"0.8 m\"\n";
    let text = BLOCK
        .replace("\"124 kg\"", "\"124 kg\"\nwidth = \"0.5 m\"")
        .replace("[slider]", "[slider]\ngap = \"10 mm\"\nbounds = { lower = 0.8, upper = 1.3 }")
        .replace("\n[motion]", &format!("{storeys}{storeys}\n[motion]"));
    let folder = Folder::with_model("json-bounds", &text);
    let json = folder.json(&["model.toml"]);
    // Names stand with the values, where the model gives them.
    let named = text.replacen("[block]", "[block]\nname = \"Base mat\"", 1);
    let at = named.rfind("[[storey]]").unwrap() + "[[storey]]".len();
    folder.write("named.toml", format!("{}\nname = \"Roof\"{}", &named[..at], &named[at..]));
    let named = folder.json(&["named.toml"]);
    for run in [&named, &named["bounds"]["upper"]] {
        assert_eq!(
            (&run["block"]["name"], &run["storeys"][1]["name"]),
            (&"Base mat".into(), &"Roof".into())
        );
        assert!(run["storeys"][0].get("name").is_none());
        assert!(run["block"]["peak_acceleration_m_per_s2"].is_number());
    }
    assert!(json["block"].get("name").is_none());
    for run in [&json, &json["bounds"]["lower"], &json["bounds"]["upper"]] {
        check_run(run, 2);
        assert!(run["gap_ratio"].is_number() && run["overturning_ratio"].is_number());
        assert!(run["storeys"][1]["peak_drift_ratio"].is_number());
        assert!(run["peak_base_shear_n"].as_f64().unwrap() > 0.0);
    }
    assert!(json["bounds"]["lower"].get("bounds").is_none());
    let stepwise = folder.json(&["model.toml", "--method", "stepwise"]);
    for run in [&stepwise, &stepwise["bounds"]["lower"], &stepwise["bounds"]["upper"]] {
        check_run(run, 2);
        check(run, "/iterations/mean", Number);
        check(run, "/iterations/max", Count);
        assert!(run["checks"]["closest_call"].is_null());
    }
    assert_eq!(stepwise["method"], "stepwise");
}

#[test]
fn floor_spectra_stand_beside() {
    let folder = Folder::with_model("json-spectra", BLOCK);
    assert!(folder.json(&["model.toml"]).get("floor_spectrum").is_none());
    let json = folder.json(&["model.toml", "--floor-spectrum"]);
    check_run(&json, 0);
    let spectrum = &json["floor_spectrum"];
    assert_eq!(spectrum["damping_ratio"], 0.05);
    let lists = ["period_s", "table_acceleration_m_per_s2", "block_acceleration_m_per_s2"];
    let lists = lists.map(|key| spectrum[key].as_array().unwrap());
    assert!(lists.iter().all(|list| list.len() == lists[0].len() && list[0].is_number()));
    // A stiff oscillator moves with what it stands on.
    let block = json["block"]["peak_acceleration_m_per_s2"].as_f64().unwrap();
    assert!((lists[2][0].as_f64().unwrap() / block - 1.0).abs() < 0.1, "{} {block}", lists[2][0]);
    assert_eq!(spectrum["storeys_acceleration_m_per_s2"], serde_json::json!([]));
}

/// In two directions the keys are those of one, of RotD100, and again along x and along y; table and page show them.
#[test]
fn floor_spectra_of_a_pair_stand_by_axis() {
    let storey = "[[storey]]\nmass = \"50 kg\"\nstiffness = \"20 kN/m\"\ndamping_ratio = 0.03\n";
    let model = format!(
        "[block]\nmass = \"100 kg\"\n[slider]\nstatic_friction = 0.1\nkinetic_friction = 0.1\n\
         radius = \"2 m\"\n{storey}{storey}[motion]\nrecord = \"x.csv\"\nrecord_y = \"y.csv\"\n"
    );
    let folder = Folder::with_model("json-spectra-pair", &model);
    for (name, peaks) in [("x.csv", [3.0, -4.0]), ("y.csv", [-2.0, 5.0])] {
        let [first, second] = peaks;
        let record = format!("0,0\n0.2,{first}\n0.5,{second}\n0.9,{first}\n1.4,0\n3,0\n");
        folder.write(name, format!("time_s,acceleration_m_per_s2\n{record}"));
    }
    let asked = ["model.toml", "--floor-spectrum"];
    let json = folder.json(&asked);
    let spectrum = &json["floor_spectrum"];
    let floors = |of: &serde_json::Value| -> Vec<f64> {
        let all = of["storeys_acceleration_m_per_s2"].as_array().unwrap();
        all.iter().flat_map(|one| one.as_array().unwrap()).map(|a| a.as_f64().unwrap()).collect()
    };
    let [both, x, y] = [spectrum, &spectrum["x"], &spectrum["y"]].map(floors);
    assert!(!both.is_empty() && both.len() == x.len() && both.len() == y.len());
    for (both, (x, y)) in both.iter().zip(x.iter().zip(&y)) {
        assert!(*both >= x.max(*y) && *both <= x.hypot(*y) * (1.0 + 1e-12), "{both} {x} {y}");
    }
    let text = folder.stdout(&[&["run"][..], &asked, &["--out", "out"]].concat());
    let page = folder.read("out/report.html");
    for said in ["Floor spectra at 5 % damping", "RotD100", "along y"] {
        assert!(text.contains(said) && page.contains(said), "{said}");
    }
    let table = text.split("Floor spectra").nth(1).unwrap();
    let places = ["Ground", "Block", "Storey 1"];
    assert!(places.iter().all(|place| table.contains(place)), "{table}");
    assert!(page.contains("id=\"floor-spectra\""));
}

#[test]
fn keys_where_nothing_happens() {
    let still = BLOCK.replace("3 m/s2", "0 m/s2");
    let json = Folder::with_model("json-still", &still).json(&["model.toml"]);
    check_run(&json, 0);
    assert_eq!(json["slip_count"], 0);
    assert_eq!(json["peak_sliding_displacement_m"], 0.0);
}

#[test]
fn contact_loss_is_a_list_of_intervals() {
    let text = super::support::RECORDED;
    let folder = Folder::with_model("json-contact", text);
    let header = "time_s,acceleration_m_per_s2,vertical_acceleration_m_per_s2\n";
    folder.write("record.csv", format!("{header}0,1,0\n1,1,-20\n2,1,0\n3,0,0\n"));
    let json = folder.json(&["model.toml"]);
    check_run(&json, 0);
    assert_eq!(json["contact_loss_s"].as_array().unwrap().len(), 1);
}
