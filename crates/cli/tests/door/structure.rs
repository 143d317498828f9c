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
fn points_have_names_and_peaks() {
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

/// Floor spectra and histories of a structure by its modes call its points by their names, wherever they are drawn.
#[test]
fn floor_spectra_name_points_by_their_names() {
    let modes = "period_s,damping_ratio,participation_x,first_x,second_x,third_x,fourth_x,roof_x\n\
                 0.5,0.03,800,0.0003,0.0005,0.0008,0.001,0.0012\n\
                 0.2,0.03,300,0.001,0.0006,0.0001,-0.0004,-0.0009\n";
    let folder = folder("structure-spectra", modes);
    folder.stdout(&["run", "model.toml", "--floor-spectrum", "--out", "out", "-q"]);
    let page = folder.read("out/report.html").to_lowercase();
    for said in [">roof<", "of 5 points are drawn", "a point of the structure"] {
        assert!(page.contains(said), "{said}");
    }
    // Nothing calls them floors or storeys.
    for wrong in [
        "floor 1",
        "floor 5",
        "storey 1",
        "storey 5",
        "5 storeys",
        "and storeys over",
        "storey drifts",
    ] {
        assert!(!page.contains(wrong), "{wrong}");
    }
    let json = folder.json(&["model.toml", "--floor-spectrum"]);
    let points = json["points"].as_array().map(Vec::len);
    let spectra = json["floor_spectrum"]["storeys_acceleration_m_per_s2"].as_array().map(Vec::len);
    assert_eq!((points, spectra), (Some(5), Some(5)));
}

/// So they are in two directions, where every point has RotD100 and what is along x and along y.
#[test]
fn floor_spectra_of_points_in_two_directions() {
    let modes = "period_s,damping_ratio,participation_x,participation_y,roof_x,roof_y\n\
                 0.5,0.03,800,0,0.0012,0\n0.4,0.03,0,700,0,0.0011\n";
    let folder = folder("structure-spectra-pair", modes);
    let (model, _) = MODEL.split_once("[motion]").expect("a motion");
    folder.write(
        "model.toml",
        format!("{model}[motion]\nrecord = \"x.csv\"\nrecord_y = \"y.csv\"\n"),
    );
    for (name, peak) in [("x.csv", 3.0), ("y.csv", -2.0)] {
        let record = format!("0,0\n0.2,{peak}\n0.5,-1\n0.9,{peak}\n1.4,0\n3,0\n");
        folder.write(name, format!("time_s,acceleration_m_per_s2\n{record}"));
    }
    let text = folder.stdout(&["run", "model.toml", "--floor-spectrum", "--out", "out", "-q"]);
    let table = text.split("Floor spectra").nth(1).expect("a table");
    assert!(table.contains("Roof") && table.contains("along y"), "{table}");
    assert!(folder.read("out/report.html").to_lowercase().contains(">roof<"));
    let json = folder.json(&["model.toml", "--floor-spectrum"]);
    for of in [&json["floor_spectrum"], &json["floor_spectrum"]["y"]] {
        let points = of["storeys_acceleration_m_per_s2"].as_array().expect("a list");
        assert_eq!(points.len(), 1);
        let first = points[0].as_array().and_then(|sa| sa[0].as_f64()).expect("a number");
        assert!(first > 0.0);
    }
}

#[test]
fn faults_of_a_table_of_modes_are_told_where_they_are() {
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
        (
            "negative-mass",
            "participation_x,first_x,roof_x\n0.5,0.03,800,",
            "effective_mass_kg,first_x,roof_x\n0.5,0.03,-640000,",
            "modes.csv:2:10: structure.mode.1.effective_mass: expected a finite mass",
        ),
    ] {
        let folder = folder(&format!("structure-{name}"), &MODES.replacen(from, to, 1));
        let message = folder.refused(&["run", "model.toml"]);
        assert!(message.contains(place), "{name}: {message}");
    }
}

/// Faults of the file's own keys.
#[test]
fn faults_of_the_keys_of_a_structure_are_told_where_they_are() {
    for (name, from, to, place) in [
        (
            "negative-total",
            "mass = \"800 t\"",
            "mass = \"-800 t\"",
            "model.toml:8:8: structure.mass: expected a finite mass > 0",
        ),
        (
            "negative-point",
            "height = \"8 m\"",
            "mass = \"-1 t\"",
            "model.toml:12:8: structure.point.1.mass: expected a finite mass > 0",
        ),
        (
            "no-unit",
            "mass = \"800 t\"",
            "mass = 800",
            "model.toml:8:8: structure.mass: expected a mass",
        ),
        (
            "lengths",
            "modes = \"modes.csv\"",
            "damping_ratio = 0.03\nmode = [{ period = \"1 s\", participation = 700 }, { period = \"0.5 s\", \
             participation = 90 }]",
            "structure.point.1.shape: expected one value a mode, 2 in all, found ",
        ),
        (
            "lengths-y",
            "modes = \"modes.csv\"",
            "damping_ratio = 0.03\nmode = [{ period = \"1 s\", participation = 700, participation_y = 0 }, \
             { period = \"0.5 s\", participation = 90, participation_y = 700 }]\n\
             point = [{ name = \"top\", shape = [1e-3, 1e-3], shape_y = [1e-3] }]\n#",
            "structure.point.1.shape_y: expected one value a mode, 2 in all, found 1",
        ),
    ] {
        let folder = Folder::new(&format!("structure-key-{name}"));
        folder.write("modes.csv", MODES);
        let text = MODEL.replacen(from, to, 1);
        let text = match name {
            "lengths-y" => {
                text.replace("[[structure.point]]\nname = \"Roof\"\nheight = \"8 m\"\n", "")
            }
            _ => text,
        };
        folder.write("model.toml", text);
        let message = folder.refused(&["run", "model.toml"]);
        assert!(message.contains(place), "{name}: {message}");
    }
}

#[test]
fn storeys_beside_a_structure_are_refused() {
    let storey = "[[storey]]\nmass = \"1 t\"\nperiod = \"1 s\"\ndamping_ratio = 0.1\n";
    let folder = folder("structure-both", MODES);
    folder.write("model.toml", format!("{MODEL}{storey}"));
    let message = folder.refused(&["run", "model.toml"]);
    assert!(message.contains("only one of structure, storey"), "{message}");
}

#[test]
fn examples_of_structures_run_as_they_stand() {
    for example in ["structure", "tank-sloshing"] {
        let folder = Folder::new(&format!("structure-init-{example}"));
        folder.stdout(&["init", "it", "--example", example]);
        let json = folder.json(&["it.toml"]);
        assert!(json["points"].as_array().is_some_and(|points| points.len() >= 2), "{example}");
        let warnings = json["warnings"].as_array().expect("a list");
        assert!(warnings.iter().all(|w| w["kind"] != "missing_modes"), "{warnings:?}");
    }
}

/// A file of the examples.
fn example(name: &str) -> String {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/structures");
    std::fs::read_to_string(format!("{folder}/{name}")).expect("an example")
}

#[test]
fn info_says_what_was_understood_of_exported_tables() {
    let folder = Folder::new("structure-info");
    folder.write("building.csv", example("sap2000-layout.csv"));
    let text = folder.stdout(&["structure", "info", "building.csv", "--svg", "modes.svg"]);
    for line in [
        "building.csv  (tables of ETABS or SAP2000)",
        "  Joint Displacements: 30 rows; m, Radians",
        "Mass     1200.0 t along x, 1200.0 t along y",
        "Points   c1, c2, c3",
    ] {
        assert!(text.contains(line), "{line}: {text}");
    }
    assert!(folder.read("modes.svg").contains("Mode 6"));
    let json = folder.stdout(&["structure", "info", "building.csv", "--json"]);
    let json: serde_json::Value = serde_json::from_str(&json).expect("an object");
    let ratio = json["modes"][1]["effective_mass_ratio"]["x"].as_f64().expect("a number");
    assert!((ratio - 0.804896).abs() < 1e-6, "{ratio}");
    let sum = json["effective_mass_ratio_sum"]["y"].as_f64().expect("a number");
    assert!((sum - 1.0).abs() < 1e-5, "{sum}");
}

#[test]
fn opensees_report_needs_the_unit_of_mass() {
    let folder = Folder::new("structure-opensees");
    folder.write("modal.txt", example("opensees-modal.txt"));
    let message = folder.refused(&["structure", "info", "modal.txt"]);
    assert!(message.contains("add --mass-unit"), "{message}");
    let text = folder.stdout(&["structure", "info", "modal.txt", "--mass-unit", "t"]);
    assert!(text.contains("242.40 t along x"), "{text}");
    // kip s²/in
    let unit = ["structure", "info", "modal.txt", "--mass-unit", "175.127 t"];
    assert!(folder.stdout(&unit).contains("42451 t along x"));
}

/// From an exported table to a certified answer; the table of ours reads back as it was written.
#[test]
fn converted_tables_run_in_a_model() {
    let folder = Folder::with_model("structure-convert", MODEL);
    folder.write("building.csv", example("etabs-layout.csv"));
    let convert = [
        "structure",
        "convert",
        "building.csv",
        "--point",
        "Roof=Roof 7",
        "--damping",
        "3 %",
        "-o",
        "modes.csv",
    ];
    let output = folder.output(&convert);
    assert!(output.status.success());
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(
        said.contains("wrote modes.csv; in a model beside it: [structure] with mass = \"1200."),
        "{said}"
    );
    let header = "period_s,damping_ratio,participation_x,participation_y,roof_x,roof_y\n";
    assert!(folder.read("modes.csv").starts_with(header));
    let json = folder.json(&["model.toml", "--set", "structure.mass=\"1201 t\""]);
    assert_eq!(json["points"][0]["name"], "Roof");
    assert!(json["checks"]["demands_error"].as_f64().expect("a number") < 1e-10);
    let text = folder.stdout(&["structure", "info", "modes.csv", "--mass", "1201 t"]);
    assert!(text.contains("modes.csv  (modes.csv)") && text.contains("Points   roof"), "{text}");
    folder.write("model.toml", MODEL.replace("800 t", "1201 t"));
    let text = folder.stdout(&["structure", "info", "model.toml"]);
    assert!(text.contains("model.toml  (model)") && text.contains("1201.0 t along x"), "{text}");
}

/// The example that the book runs names what is made of the table beside it.
#[test]
fn example_of_an_exported_building() {
    let folder = Folder::new("structure-example");
    folder.write("building.csv", example("sap2000-layout.csv"));
    let points = ["--point", "First=C1", "--point", "Second=C2", "--point", "Roof=C3"];
    let convert = ["structure", "convert", "building.csv", "--damping", "3 %"];
    let csv = folder.stdout(&[&convert[..], &points[..]].concat());
    assert_eq!(csv, example("building-modes.csv"));
}

#[test]
fn tank_of_the_example_is_that_of_its_dimensions() {
    let folder = Folder::new("structure-tank");
    folder.stdout(&["init", "it", "--example", "tank-sloshing"]);
    let feet = ["--radius", "32.808398950131235 ft", "--height", "26.246719160104988 ft"];
    folder.stdout(&[&["structure", "tank", "-o", "us.toml"], &feet[..]].concat());
    assert_eq!(folder.read("it.toml"), folder.read("us.toml"));
    assert!(folder.read("it.toml").contains("mass = \"2513.27 t\""));
    // Under a pair it is the same in both directions.
    folder.write("x.txt", "0 0.3 0.6 0.2 -0.4 -0.7 -0.1 0.3 0.1 0\n");
    folder.write("y.txt", "0 0.1 -0.2 -0.5 0.1 0.6 0.2 -0.1 0 0\n");
    let pair =
        ["it.toml", "--records", "x.txt", "--second", "y.txt", "--units", "g", "--dt", "0.1 s"];
    let said = folder.stdout(&[&["run"], &pair[..]].concat());
    assert!(said.contains("in two directions"), "{said}");
    // A workbook is no table: the message says what to do.
    folder.write("modes.xlsx", "PK\u{3}\u{4}");
    let message = folder.refused(&["structure", "info", "modes.xlsx"]);
    assert!(message.contains("save each sheet as CSV"), "{message}");
    // A tall one, an oil: no more mass than the liquid's.
    let tall = ["--radius", "4 m", "--height", "16 m", "--specific-gravity", "0.85"];
    folder.stdout(&[&["structure", "tank", "-o", "tall.toml"], &tall[..]].concat());
    assert_eq!(folder.json(&["tall.toml"])["points"][1]["name"], "Sloshing");
    let message = folder.refused(&["structure", "tank", "--radius", "-1 m", "--height", "8 m"]);
    assert!(message.contains("radius"), "{message}");
}
