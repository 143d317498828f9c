//! A structure by its modes, as a user gives it.

use crate::support::Folder;

const MODEL: &str = r#"
[block]
mass = "300 t"
[slider]
static_friction = 0.06
kinetic_friction = 0.05
[structure]
mass = "800 t"
modes = "modes.csv"
[[structure.point]]
name = "Roof"
height = "8 m"
[motion]
sine = { frequency = "1 Hz", amplitude = "2 m/s2", duration = "5 s", dt = "0.01 s" }
"#;

const MODES: &str = "period_s,damping_ratio,participation_x,first_x,roof_x
0.5,0.03,800,0.0005,0.0012
0.2,0.03,300,0.001,-0.0009
";

fn folder(test: &str, modes: &str) -> Folder {
    let folder = Folder::with_model(test, MODEL);
    folder.write("modes.csv", modes);
    folder
}

#[test]
fn exact_points_have_names_and_peaks() {
    let json = folder("structure-points", MODES).json(&["model.toml"]);
    let points = json["points"].as_array().expect("a list");
    assert_eq!(points.len(), 2);
    assert_eq!((&points[0]["name"], &points[1]["name"]), (&"Roof".into(), &"first".into()));
    for point in points {
        assert!(point["peak_acceleration_m_per_s2"].as_f64().expect("a number") > 0.0);
        assert!(point["peak_displacement_m"].as_f64().expect("a number") > 0.0);
    }
    assert!(json["storeys"].as_array().expect("a list").is_empty());
    let kinds = json["warnings"].as_array().expect("a list").iter().map(|w| w["kind"].as_str());
    // 730 t of 800 t.
    assert!(!kinds.flatten().any(|kind| kind == "missing_modes"));
}

#[test]
fn exact_faults_of_a_table_of_modes_are_told_where_they_are() {
    for (name, from, to, place) in [
        ("nan", "0.0012", "nan", "modes.csv:2:21: expected a finite number, found \"nan\""),
        ("short", ",0.0012", "", "modes.csv:2:1: expected 5 values, as the header has, found 4"),
        ("complex", "0.2,", "0.2+1i,", "modes.csv:3:1: expected a finite number, found \"0.2+1i\""),
        (
            "order",
            "0.2,",
            "0.6,",
            "modes.csv:3:1: structure.mode.2.period: expected a period of at most 0.5 s",
        ),
        ("unit", "period_s", "period", "modes.csv:1:1: expected its unit in the name"),
        (
            "sum",
            ",300,",
            ",500,",
            "modes.csv:3:10: structure.mode.2.participation: expected effective masses",
        ),
        (
            "negative",
            "0.5,",
            "-0.5,",
            "modes.csv:2:1: structure.mode.1.period: expected a finite time > 0",
        ),
    ] {
        let folder = folder(&format!("structure-{name}"), &MODES.replacen(from, to, 1));
        let message = folder.refused(&["run", "model.toml"]);
        assert!(message.contains(place), "{name}: {message}");
    }
}

#[test]
fn exact_storeys_beside_a_structure_are_refused() {
    let storey = "[[storey]]\nmass = \"1 t\"\nperiod = \"1 s\"\ndamping_ratio = 0.1\n";
    let folder = folder("structure-both", MODES);
    folder.write("model.toml", format!("{MODEL}{storey}"));
    let message = folder.refused(&["run", "model.toml"]);
    assert!(message.contains("only one of structure, storey"), "{message}");
}

#[test]
fn exact_examples_of_structures_run_as_they_stand() {
    for example in ["structure", "tank-sloshing"] {
        let folder = Folder::new(&format!("structure-init-{example}"));
        folder.stdout(&["init", "it", "--example", example]);
        let json = folder.json(&["it.toml"]);
        assert!(json["points"].as_array().is_some_and(|points| points.len() >= 2), "{example}");
        let warnings = json["warnings"].as_array().expect("a list");
        assert!(warnings.iter().all(|w| w["kind"] != "missing_modes"), "{warnings:?}");
    }
}
