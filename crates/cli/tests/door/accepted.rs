//! What people write: line ends, byte order marks, separators, standard input, options.

use serde_json::Value;

use super::support::{BLOCK, Folder, RECORD, RECORDED, output, text};

fn number(value: &Value, path: &str) -> f64 {
    value.pointer(path).and_then(Value::as_f64).unwrap_or_else(|| panic!("{path} in {value}"))
}

#[test]
fn standard_input_is_a_model() {
    let folder = Folder::with_model("stdin", RECORDED);
    folder.write("record.csv", RECORD);
    let from_stdin = |arguments: &[&str]| {
        let stdin = std::fs::File::open(folder.path().join("model.toml")).unwrap();
        let output = output(folder.command(arguments).stdin(stdin));
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
        text(&output.stdout)
    };
    assert_eq!(from_stdin(&["run", "-"]), folder.stdout(&["run", "model.toml"]));
    let piped = from_stdin(&["run", "--json", "-", "--out", "out"]);
    assert_eq!(piped, folder.stdout(&["run", "--json", "model.toml"]));
    assert!(folder.read("out/report.html").contains("standard input"));
}

#[test]
fn line_ends_and_byte_order_marks_change_nothing() {
    let folder = Folder::new("crlf");
    for sub in ["lf", "crlf"] {
        let dress = |text: &str| match sub {
            "lf" => text.to_owned(),
            _ => format!("\u{feff}{}", text.replace('\n', "\r\n")),
        };
        let model = RECORDED.replace("record.csv", "records/a.csv");
        let separator = if sub == "lf" { "/" } else { "\\\\" };
        let model = model.replace("records/", &format!("records{separator}"));
        folder.write(&format!("{sub}/model.toml"), dress(&model));
        folder.write(&format!("{sub}/records/a.csv"), dress(RECORD));
    }
    let [lf, crlf] = ["lf", "crlf"].map(|sub| {
        let model = format!("{sub}/model.toml");
        folder.stdout(&["run", "--json", &model, "--out", sub])
    });
    assert_eq!(lf, crlf);
    for file in ["summary.json", "history.csv", "events.csv"] {
        let [lf, crlf] = ["lf", "crlf"].map(|sub| folder.read(&format!("{sub}/{file}")));
        assert_eq!(lf, crlf, "{file}");
        assert!(!lf.contains('\r') && lf.ends_with('\n'), "{file}");
    }
}

#[test]
fn records_lie_beside_the_model_and_motions_in_the_working_folder() {
    let folder = Folder::new("relative");
    folder.write("deep/model.toml", RECORDED);
    folder.write("deep/record.csv", RECORD);
    folder.write("record.csv", RECORD.replace("5", "6"));
    let own = folder.json(&["deep/model.toml"]);
    assert_eq!(number(&own, "/record/pga_m_per_s2"), 5.0);
    assert_eq!(own["model"], "model");
    let motion = folder.json(&["deep/model.toml", "--motion", "record.csv"]);
    assert_eq!(number(&motion, "/record/pga_m_per_s2"), 6.0);
}

#[test]
fn motion_options_complete_a_record() {
    let folder = Folder::with_model("motion", BLOCK);
    folder.write("one.txt", "0\n0.1\n-0.4\n0\n");
    let motion = ["model.toml", "--motion", "one.txt", "--units", "g", "--dt", "20 ms"];
    let run = |more: &[&str]| folder.json(&[&motion, more].concat());
    let plain = run(&[]);
    assert_eq!(number(&plain, "/record/pga_m_per_s2"), 0.4 * 9.80665);
    assert_eq!((number(&plain, "/dt_s"), number(&plain, "/duration_s")), (0.02, 0.06));
    assert_eq!(plain["samples"], 4);
    let scaled = run(&["--scale", "-2"]);
    assert_eq!(number(&scaled, "/record/pga_m_per_s2"), 0.8 * 9.80665);
    let negative = run(&["--scale=-1"]);
    let back = |value: &Value| number(value, "/residual_sliding_displacement_m");
    assert_eq!(number(&negative, "/record/pga_m_per_s2"), number(&plain, "/record/pga_m_per_s2"));
    assert_eq!(back(&negative), -back(&plain));
    let peak = run(&["--scale-to", "3 m/s2"]);
    assert!((number(&peak, "/record/pga_m_per_s2") - 3.0).abs() < 1e-15);
    folder.write("two.csv", "time [s],east [g],north [g]\n0,0,0\n1,0.1,0.3\n2,0,0\n");
    let north = folder.json(&["model.toml", "--motion", "two.csv", "--channel", "north [g]"]);
    let second = folder.json(&["model.toml", "--motion", "two.csv", "--channel", "2"]);
    assert_eq!(number(&north, "/record/pga_m_per_s2"), 0.3 * 9.80665);
    assert_eq!(north, second);
}

#[test]
fn set_and_method_change_the_model() {
    let folder = Folder::with_model("set", BLOCK);
    let frictions = "static_friction = 0.165\nkinetic_friction = 0.153";
    let written = BLOCK.replace(frictions, "static_friction = 0.2\nkinetic_friction = 0.1");
    folder.write("written.toml", written.replace("20 kN/m", "30 kN/m"));
    let sets = [
        ["--set", "slider.static_friction=0.2"],
        ["--set", "slider.kinetic_friction = 0.1"],
        ["--set", "slider.spring=30 kN/m"],
    ];
    let set = folder.json(&[&["model.toml"], sets.concat().as_slice()].concat());
    assert_eq!(set, folder.json(&["written.toml"]));
    let quoted = ["model.toml", "--set", "slider.spring=\"30 kN/m\""];
    let bare = ["model.toml", "--set", "slider.spring=30 kN/m"];
    assert_eq!(folder.json(&quoted), folder.json(&bare));
    // The later of two settings holds; --method is one of them.
    let method = |arguments: &[&str]| {
        folder.json(&[&["model.toml"], arguments].concat())["method"].as_str().unwrap().to_owned()
    };
    assert_eq!(method(&[]), "exact");
    assert_eq!(method(&["--method", "stepwise"]), "stepwise");
    assert_eq!(method(&["--set", "analysis.method=stepwise"]), "stepwise");
    assert_eq!(method(&["--set", "analysis.method=stepwise", "--method", "exact"]), "exact");
    let radius = folder.json(&["model.toml", "--set", "slider.radius=2 m"]);
    assert_ne!(radius, folder.json(&["model.toml"]));
}
