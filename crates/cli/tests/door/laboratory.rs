//! `slipstick compare` and `slipstick identify`.

use serde_json::Value;

use super::support::{BLOCK, Folder, text};

/// A folder with a model and the history of its own run, which is what a test might have measured.
fn tested(name: &str) -> Folder {
    let folder = Folder::with_model(name, BLOCK);
    folder.stdout(&["run", "model.toml", "-q", "--out", "run"]);
    folder.write("test.csv", folder.read("run/history.csv"));
    folder
}

fn stderr(output: &std::process::Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn a_run_compared_with_itself_agrees() {
    let folder = tested("compare-self");
    let bound = "peak_ratio.sliding_displacement=0.999999..1.000001";
    let text = folder.stdout(&["compare", "test.csv", "model.toml", "--json", "--within", bound]);
    let json: Value = serde_json::from_str(&text).unwrap();
    let quantities = json["quantities"].as_array().unwrap();
    let names: Vec<&str> = quantities.iter().map(|q| q["quantity"].as_str().unwrap()).collect();
    assert_eq!(
        names,
        ["sliding_displacement", "sliding_velocity", "block_acceleration", "friction_force"]
    );
    for quantity in quantities {
        assert!(quantity["normalised_rms_error"].as_f64().unwrap() < 1e-9, "{quantity}");
    }
    assert_eq!(json["within"][0]["holds"], true);
    assert_eq!(json["warnings"].as_array().unwrap().len(), 0);
}

#[test]
fn a_missed_bound_is_named_and_status_1() {
    let folder = tested("compare-missed");
    let output = folder.output(&[
        "compare",
        "test.csv",
        "model.toml",
        "--set",
        "slider.spring=60 kN/m",
        "--within",
        "peak_ratio.sliding_displacement=0.99..1.01",
        "--within",
        "arrival_lag.block_acceleration=-1..1",
        "--out",
        "out",
    ]);
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("missed: peak_ratio.sliding_displacement"));
    assert!(!stderr(&output).contains("missed: arrival_lag"));
    let figures = ["accelerations.svg", "comparison.json", "displacements.svg", "report.html"];
    assert_eq!(folder.names("out"), figures);
    let page = folder.read("out/report.html");
    assert!(page.contains("<svg") && page.contains("expected 0.99 to 1.01: missed"));
    assert!(page.contains("1 of 2 bounds is missed."), "{page}");
    let bound = ["--within", "arrival_lag.block_acceleration=-1..1", "--out", "one"];
    folder.stdout(&[&["compare", "test.csv", "model.toml"], &bound[..]].concat());
    assert!(folder.read("one/report.html").contains("The bound is kept."));
}

#[test]
fn bad_input_is_status_2_with_its_place() {
    let folder = tested("compare-refused");
    folder.write("map.toml", "block_acceleraton = \"A1 [g]\"\n");
    folder.write("gap.csv", "time_s,table_acceleration_m_per_s2\n0,1\n1,\n2,3\n");
    for (arguments, part) in [
        (vec!["compare", "test.csv", "model.toml", "--mapping", "map.toml"], "map.toml:1:1: "),
        (vec!["compare", "none.csv", "model.toml"], "none.csv: cannot be read"),
        (vec!["compare", "gap.csv", "model.toml"], "gap.csv:3:3: "),
        (
            vec!["compare", "test.csv", "model.toml", "--mapping", "force = nothing [N]"],
            "expected one of the columns",
        ),
        (vec!["compare", "test.csv", "model.toml", "--within", "peak=1..2"], "METRIC.QUANTITY"),
        (vec!["identify", "cyclic", "test.csv"], "a column of force"),
        (
            vec!["identify", "shaking-table", "test.csv", "model.toml", "--fit", "slider.sprng"],
            "nearest is \"slider.spring\"",
        ),
    ] {
        let output = folder.output(&arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(stderr(&output).contains(part), "{arguments:?}: {}", stderr(&output));
        assert!(output.stdout.is_empty());
    }
    assert!(!folder.path().join("out").exists());
}

#[test]
fn fitted_model_is_one_that_runs_and_compares() {
    let folder = tested("identify-table");
    let start = "slider.kinetic_friction=0.12";
    folder.stdout(&[
        "identify",
        "shaking-table",
        "test.csv",
        "model.toml",
        "--set",
        start,
        "--fit",
        "slider.kinetic_friction",
        "--out",
        "fitted",
    ]);
    let files = ["identified.json", "model.toml", "report.html", "table.csv"];
    assert!(files.iter().all(|name| folder.names("fitted").iter().any(|there| there == name)));
    let json: Value = serde_json::from_str(&folder.read("fitted/identified.json")).unwrap();
    let value = json["estimates"][0]["value"].as_f64().unwrap();
    assert!((value / 0.153 - 1.0).abs() < 1e-4, "{value}");
    let page = folder.read("fitted/report.html");
    let lead = "<main>\n<section class=\"verdict\">\n<p class=\"lead\">Determined: \
                slider.kinetic_friction = 0.153";
    assert!(page.contains(lead), "{page}");
    folder.stdout(&["run", "fitted/model.toml"]);
    folder.stdout(&["compare", "test.csv", "fitted/model.toml"]);
}

#[test]
fn what_cannot_be_told_is_status_1() {
    let folder = Folder::with_model("identify-refused", BLOCK);
    folder.stdout(&[
        "run",
        "model.toml",
        "-q",
        "--set",
        "motion.sine.amplitude=1 m/s2",
        "-o",
        "run",
    ]);
    let output = folder.output(&[
        "identify",
        "shaking-table",
        "run/history.csv",
        "model.toml",
        "--fit",
        "slider.kinetic_friction,slider.static_friction",
    ]);
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(text.contains(" cannot be determined: "), "{text}");
    let rows: String = (0..200).map(|i| format!("{},0,{}\n", 0.01 * f64::from(i), i % 7)).collect();
    folder.write("stuck.csv", format!("time_s,displacement_mm,force_n\n{rows}"));
    let output = folder.output(&["identify", "cyclic", "stuck.csv"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("no sliding in the record"), "{}", stderr(&output));
}

/// The zero of a sensor is stated as a quantity, by a stretch at rest, or taken as it is; else friction by
/// direction cannot be determined, and that is said.
#[test]
fn zeros_of_sensors_are_stated() {
    let folder = Folder::new("sensor-zeros");
    let example = |name: &str| {
        let path = format!("{}/../../examples/laboratory/{name}", env!("CARGO_MANIFEST_DIR"));
        std::fs::read_to_string(path).unwrap()
    };
    let made = example("cyclic-1hz.csv");
    let (head, rows) = made.split_once('\n').unwrap();
    assert_eq!(head, "time (s),displacement (mm),force (N)");
    let off = rows.lines().map(|row| {
        let (rest, force) = row.rsplit_once(',').unwrap();
        format!("{rest},{}\n", force.parse::<f64>().unwrap() + 30.0)
    });
    folder.write("test.csv", format!("{head}\n{rows}"));
    folder.write("off.csv", format!("{head}\n{}", off.collect::<String>()));
    let of = |file: &str, more: &[&str]| -> (Vec<(String, f64)>, String) {
        let all =
            [&["identify", "cyclic", file, "--without", "spring,damper", "--json"], more].concat();
        let output = folder.output(&all);
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
        let found: serde_json::Value = serde_json::from_str(&text(&output.stdout)).unwrap();
        let estimate = |e: &serde_json::Value| {
            (e["parameter"].as_str().unwrap().to_owned(), e["value"].as_f64().unwrap())
        };
        let estimates = found["estimates"].as_array().unwrap().iter().map(estimate).collect();
        (estimates, text(&output.stderr))
    };
    let (unknown, said) = of("off.csv", &[]);
    assert!(said.contains("zero_not_stated") && !said.contains("force_drift"), "{said}");
    assert!(unknown.iter().all(|(path, _)| !path.ends_with("tive")), "{unknown:?}");
    let (right, _) = of("test.csv", &["--mapping", "zero=as measured"]);
    assert!(right.iter().any(|(path, _)| path.ends_with(".positive")), "{right:?}");
    let (stated, said) = of("off.csv", &["--mapping", "force=force - 30 N"]);
    assert!(!said.contains("zero_not_stated"), "{said}");
    for ((path, found), (_, expected)) in stated.iter().zip(&right) {
        assert!((found / expected - 1.0).abs() < 1e-9, "{path}: {found} for {expected}");
    }
    assert!((unknown[0].1 / right[0].1 - 1.0).abs() < 1e-9);
    let refused = folder.refused(&["identify", "cyclic", "off.csv", "--mapping", "zero=first 2"]);
    assert!(refused.contains("zero: expected \"first 2 s\""), "{refused}");
}

/// Sines at three frequencies; what was put in stands in the README of the examples.
#[test]
fn friction_that_follows_the_speed_is_told() {
    let folder = Folder::new("identify-rate");
    for hz in ["0.005", "0.05", "0.5"] {
        let name = format!("bearing-{hz}hz.csv");
        let path = format!("{}/../../examples/laboratory/{name}", env!("CARGO_MANIFEST_DIR"));
        folder.write(&name, std::fs::read_to_string(path).unwrap());
    }
    let model =
        "[block]\nmass = \"81577 kg\"\n[slider]\nstatic_friction = 0.1\nkinetic_friction = 0.1\n";
    folder.write("model.toml", model);
    let fit = ["identify", "cyclic", "bearing-*.csv", "--law", "slow-fast-rate", "-q"];
    let out = ["--model", "model.toml", "--json", "-o", "out"];
    let found: Value = serde_json::from_str(&folder.stdout(&[&fit[..], &out].concat())).unwrap();
    let truth = [
        ("slider.kinetic_friction.slow", 0.04),
        ("slider.kinetic_friction.fast", 0.08),
        ("slider.kinetic_friction.rate", 25.0),
        ("slider.static_friction", 0.09),
        ("slider.spring", 320e3),
    ];
    for (estimate, (path, truth)) in found["estimates"].as_array().unwrap().iter().zip(truth) {
        assert_eq!(estimate["parameter"], path);
        let end = |key: &str| estimate[key].as_f64().unwrap();
        assert!(end("low") <= truth && truth <= end("high"), "{estimate}");
        assert!(end("high") - end("low") < 0.2 * truth, "{estimate}");
    }
    assert_eq!(found["law"], "slow-fast-rate");
    assert_eq!(found["friction_curve"].as_array().unwrap().len(), 61);
    assert!(folder.read("out/report.html").contains("id=\"friction-by-speed\""));
    let keys = found["slider_keys"].as_str().unwrap();
    assert!(keys.contains("\nkinetic_friction = { slow = 0.0"), "{keys}");
    // The model that was written runs.
    let motion = [
        "--set",
        "motion.sine={ frequency = \"1 Hz\", amplitude = \"3 m/s2\", \
                   duration = \"2 s\", dt = \"0.01 s\" }",
    ];
    folder.stdout(&[&["run", "out/model.toml"], &motion[..]].concat());
    // At one frequency, far below the knee, the data do not tell the fast end.
    let slow =
        folder.output(&["identify", "cyclic", "bearing-0.005hz.csv", "--law", "slow-fast-rate"]);
    assert_eq!(slow.status.code(), Some(1), "{}", text(&slow.stderr));
    let said = text(&slow.stdout);
    assert!(said.contains("slider.kinetic_friction_force.rate cannot be determined: "), "{said}");
}

const LOADS: [&str; 3] = ["load-0400kn.csv", "load-0800kn.csv", "load-1600kn.csv"];

/// A folder with tests of a bearing under three normal forces.
fn loaded(name: &str) -> Folder {
    let folder = Folder::new(name);
    for name in LOADS {
        let path = format!("{}/../../examples/laboratory/{name}", env!("CARGO_MANIFEST_DIR"));
        folder.write(name, std::fs::read_to_string(path).unwrap());
    }
    folder
}

/// What was put in stands in the README of the examples.
#[test]
fn friction_that_follows_the_pressure_is_told() {
    let folder = loaded("identify-pressure");
    let fit = [&["identify", "cyclic"], &LOADS[..], &["--area", "0.04 m2", "-q"]].concat();
    let each = ["--normal-force", "400 kN,800 kN,1600 kN"];
    // A bearing under 24 MPa.
    let model =
        "[block]\nweight = \"960 kN\"\n[slider]\nstatic_friction = 0.1\nkinetic_friction = 0.1\n";
    folder.write("model.toml", model);
    let out = ["--model", "model.toml", "--json", "-o", "out"];
    let json = folder.stdout(&[&fit[..], &each, &out].concat());
    let found: Value = serde_json::from_str(&json).unwrap();
    let truth = [
        ("slider.kinetic_friction", 0.07),
        ("slider.static_friction", 0.1),
        ("slider.pressure.exponent", 0.2),
        ("slider.radius", 2.5),
    ];
    for (estimate, (path, truth)) in found["estimates"].as_array().unwrap().iter().zip(truth) {
        assert_eq!(estimate["parameter"], path);
        let end = |key: &str| estimate[key].as_f64().unwrap();
        assert!(end("low") <= truth && truth <= end("high"), "{estimate}");
        assert!(end("high") - end("low") < 0.15 * truth, "{estimate}");
    }
    let pressure = &found["pressure"];
    assert_eq!(
        (&pressure["reference_pa"], &pressure["tests"][2]["pressure_pa"]),
        (&2e7.into(), &4e7.into())
    );
    assert!((pressure["at_rest_pa"].as_f64().unwrap() / 24e6 - 1.0).abs() < 1e-12);
    assert_eq!(pressure["curve"].as_array().unwrap().len(), 61);
    assert!(folder.read("out/report.html").contains("id=\"friction-by-pressure\""));
    let keys = found["slider_keys"].as_str().unwrap();
    assert!(
        keys.contains("\n[slider.pressure]\nat_rest = \"24.0 MPa\"\nreference = \"20.0 MPa\"\n"),
        "{keys}"
    );
    // The model that was written runs, and so do the keys in a model of one's own.
    let motion = [
        "--set",
        "motion.sine={ frequency = \"1 Hz\", amplitude = \"3 m/s2\", \
                   duration = \"2 s\", dt = \"0.01 s\" }",
    ];
    folder.stdout(&[&["run", "out/model.toml"], &motion[..]].concat());
    folder.write("own.toml", format!("[block]\nweight = \"960 kN\"\n{keys}"));
    folder.stdout(&[&["run", "own.toml"], &motion[..]].concat());
    // Without a model nobody knows the pressure at rest.
    let told = folder.stdout(&[&fit[..], &each].concat());
    assert!(
        told.contains("# at_rest = the pressure under the weight of the model alone"),
        "{told}"
    );
    // At one force the law is not told, what holds there is.
    let one = folder.output(&[&fit[..], &["--normal-force", "800 kN"]].concat());
    assert_eq!(one.status.code(), Some(1), "{}", text(&one.stderr));
    let said = text(&one.stdout);
    let expected =
        "slider.pressure.exponent cannot be determined: all tests are at one normal force";
    assert!(said.contains(expected) && !said.contains("[slider.pressure]"), "{said}");
}

#[test]
fn normal_forces_that_cannot_be_are_refused() {
    let folder = loaded("identify-pressure-refused");
    let cases: [(&[&str], &str); 8] = [
        (
            &["--normal-force", "400 kN,800 kN", "--area", "0.04 m2"],
            "--normal-force: expected one force, or one for each of 3 tests, in their order, found 2 forces",
        ),
        (
            &["--normal-force", "400 kN,-800 kN,1600 kN", "--area", "0.04 m2"],
            "--normal-force: expected more than 0 N, found -800000 N",
        ),
        (
            &["--normal-force", "400 kN,800 mm,1600 kN", "--area", "0.04 m2"],
            "--normal-force: expected a force, such as \"12 kN\", found a length, \"800 mm\"",
        ),
        (
            &["--normal-force", "400 kN,800 kN,1600 kN"],
            "--area: expected the area of the bearing, such as \"0.04 m2\", beside normal forces that \
             differ, found none",
        ),
        (
            &["--normal-force", "800 kN", "--reference-pressure", "20 MPa"],
            "--area: expected the area of the bearing, such as \"0.04 m2\", beside a --reference-pressure, \
             found none",
        ),
        (
            &["--area", "0.04 m2"],
            "--area: expected a --normal-force, a --mass or a model beside the area of the bearing, found none",
        ),
        (&["--normal-force", "800 kN", "--area", "0 m2"], "--area: expected more than 0, found 0"),
        (
            &["--normal-force", "800 kN", "--area", "0.04 m2", "--reference-pressure", "0 Pa"],
            "--reference-pressure: expected more than 0, found 0",
        ),
    ];
    for (options, expected) in cases {
        let said = folder.refused(&[&["identify", "cyclic", "-q"], &LOADS[..], options].concat());
        assert!(said.contains(expected), "{said}");
    }
}

/// However many there are.
#[test]
fn every_cyclic_test_has_its_figure() {
    let folder = Folder::new("cyclic-many");
    let path = format!("{}/../../examples/laboratory/cyclic-1hz.csv", env!("CARGO_MANIFEST_DIR"));
    let made = std::fs::read_to_string(path).unwrap();
    let names: Vec<String> = (1..=10).map(|i| format!("test-{i}.csv")).collect();
    names.iter().for_each(|name| folder.write(name, &made));
    let mut arguments = vec!["identify", "cyclic", "--out", "out", "-q"];
    arguments.extend(names.iter().map(String::as_str));
    folder.stdout(&arguments);
    let page = folder.read("out/report.html");
    assert_eq!(page.matches("<figure id=\"loop-").count(), 10);
    let files = folder.names("out");
    assert!((1..=10).all(|i| files.contains(&format!("loop-{i}.svg"))), "{files:?}");
}

/// What is wrong with a cyclic test is said, of the file it is wrong with.
#[test]
fn what_is_suspicious_of_a_cyclic_test_is_said() {
    let folder = Folder::new("cyclic-suspicious");
    let path = format!("{}/../../examples/laboratory/cyclic-1hz.csv", env!("CARGO_MANIFEST_DIR"));
    let made = std::fs::read_to_string(path).unwrap();
    let (head, rows) = made.split_once('\n').unwrap();
    let with = |force: &dyn Fn(f64, f64) -> f64| -> String {
        let row = |row: &str| {
            let cells: Vec<f64> = row.split(',').map(|cell| cell.parse().unwrap()).collect();
            format!("{},{},{}\n", cells[0], cells[1], force(cells[0], cells[2]))
        };
        rows.lines().map(row).collect()
    };
    let cyclic = ["identify", "cyclic"];
    // A force of the other sign gives energy where friction takes it.
    folder.write("reversed.csv", format!("{head}\n{}", with(&|_, force| -force)));
    let output = folder.output(&[&cyclic[..], &["reversed.csv"]].concat());
    assert_eq!((output.status.code(), text(&output.stdout)), (Some(1), String::new()));
    let said = stderr(&output);
    assert!(said.contains("reversed.csv: friction comes out negative, -18"), "{said}");
    assert!(said.contains("the mapping \"force=… * -1\""), "{said}");
    folder.stdout(&[&cyclic[..], &["reversed.csv", "--mapping", "force=force * -1"]].concat());
    // Displacements in mm under a head that says m.
    folder.write("metres.csv", made.replace("displacement (mm)", "displacement (m)"));
    let said = stderr(&folder.output(&[&cyclic[..], &["metres.csv", "--json"]].concat()));
    assert!(said.contains("unit_suspect: the strokes are "), "{said}");
    // Names on one line and units on the next, a force among them.
    folder.write("two.csv", format!("Time,Displacement,Force\n(s),(mm),(N)\n{rows}"));
    let of = |file: &str| -> Value {
        serde_json::from_str(&folder.stdout(&[&cyclic[..], &[file, "--json", "-q"]].concat()))
            .unwrap()
    };
    folder.write("one.csv", &made);
    assert_eq!(of("two.csv")["estimates"], of("one.csv")["estimates"]);
    // Of several files a warning names its own; a drift is that of the whole test.
    let last_s = rows.lines().last().unwrap().split(',').next().unwrap().parse::<f64>().unwrap();
    folder.write("drift.csv", format!("{head}\n{}", with(&|t, force| force + 40.0 * t / last_s)));
    let output = folder.output(&[&cyclic[..], &["one.csv", "drift.csv", "--json"]].concat());
    let said = stderr(&output);
    let drift = said.split("drift.csv: the middle of the force loop drifts by ").nth(1).unwrap();
    let drift: f64 = drift.split(' ').next().unwrap().parse().unwrap();
    assert!((drift / 40.0 - 1.0).abs() < 0.1, "{said}");
}
