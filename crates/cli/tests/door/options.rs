//! Commands beside `run`, help, units of the table, what is said and what is not.

use slipstick::requests::{FrontEnd, Kind};

use super::support::{BLOCK, Folder, RECORD, RECORDED, text};

#[test]
fn examples_of_init_run_without_surprises() {
    for example in ["block", "mock-up", "frame"] {
        let folder = Folder::new(&format!("init-{example}"));
        folder.stdout(&["init", example, "--example", example]);
        let model = format!("{example}.toml");
        assert_eq!(folder.names("").join(" "), model);
        let json = folder.json(&[&model]);
        assert_eq!(json["warnings"], serde_json::json!([]), "{example}");
        assert_eq!(json["checks"]["holds"], true, "{example}");
        assert!(json["slip_count"].as_u64().unwrap() > 0, "{example} never slides");
        // The table ends nearly at rest, so that its displacement means something.
        let end = json["record"]["end_velocity_m_per_s"].as_f64().unwrap();
        let peak = json["record"]["pgv_m_per_s"].as_f64().unwrap();
        assert!(end.abs() < 0.1 * peak, "{example}: {end} m/s");
        for method in ["exact", "stepwise"] {
            folder.stdout(&["run", &model, "--method", method, "--floor-spectrum"]);
        }
    }
    let folder = Folder::new("init-default");
    folder.stdout(&["init"]);
    folder.stdout(&["init", "tank.toml"]);
    assert_eq!(folder.names(""), ["model.toml", "tank.toml"]);
}

#[test]
fn schema_is_json_and_units_a_table() {
    let folder = Folder::new("schema");
    let schema: serde_json::Value = serde_json::from_str(&folder.stdout(&["schema"])).unwrap();
    assert_eq!(schema["type"], "object");
    assert!(schema["properties"]["slider"].is_object());
    let units = folder.stdout(&["schema", "--units"]);
    for unit in ["kip", "gal", "kN/mm", "mrad", "N s/m"] {
        assert!(units.contains(unit), "{unit} in {units}");
    }
}

/// What the command offers is the table of fields; what it does not, the table says.
#[test]
fn options_are_the_fields_of_the_requests() {
    let folder = Folder::new("fields");
    for kind in Kind::ALL {
        let command: &[&str] = match kind {
            Kind::Sweep => continue,
            Kind::Suite => &["run"],
            Kind::Cyclic | Kind::FreeVibration | Kind::ShakingTable => &["identify", kind.name()],
            _ => &[kind.name()],
        };
        let help = folder.stdout(&[command, &["--help"]].concat());
        let options: Vec<&str> = help
            .lines()
            .filter_map(|line| line.trim_start().trim_start_matches("-j, ").strip_prefix("--"))
            .filter_map(|line| line.split(|c: char| !(c.is_alphanumeric() || c == '-')).next())
            .collect();
        for field in kind.offered(FrontEnd::Command) {
            assert!(options.contains(&field.name), "{command:?} lacks --{}", field.name);
        }
        // Besides them: what goes in, and what becomes of the answer.
        let files = ["motion", "records", "vertical", "second", "target", "units", "dt", "channel"];
        let others = [
            "set",
            "model",
            "jobs",
            "json",
            "display-units",
            "help",
            "version",
            "quiet",
            "to-opensees",
        ];
        let fields = || Kind::ALL.into_iter().flat_map(Kind::fields).map(|field| field.name);
        for option in options.iter().filter(|option| **option != "out") {
            let known = files.contains(option) || others.contains(option);
            let own = kind.offered(FrontEnd::Command).any(|field| field.name == *option);
            let of_run = command == ["run"] && fields().any(|name| name == *option);
            assert!(known || own || of_run, "{command:?} has --{option}");
        }
    }
    let table = folder.stdout(&["schema", "--requests"]);
    assert!(
        table.contains("Python   run scale             Motion.scaled scales a motion"),
        "{table}"
    );
}

#[test]
fn completions_know_the_options() {
    let folder = Folder::new("completions");
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = folder.stdout(&["completions", shell]);
        assert!(script.contains("floor-spectrum"), "{shell}");
    }
    folder.stdout(&["man", "pages"]);
    assert!(folder.names("pages").contains(&"slipstick-run.1".to_owned()));
}

#[test]
fn help_teaches_in_a_hundred_columns() {
    let folder = Folder::new("help");
    for arguments in [&["--help"] as &[&str], &["run", "--help"], &["help", "run"], &["init", "-h"]]
    {
        let help = folder.stdout(arguments);
        let longest = help.lines().map(|line| line.chars().count()).max().unwrap();
        assert!(longest <= 100, "{arguments:?}: {longest} columns");
        assert!(!help.contains('\u{1b}'), "{arguments:?}");
    }
    let help = folder.stdout(&["help", "run"]);
    assert_eq!(help, folder.stdout(&["run", "--help"]));
    for word in ["Examples:", "--scale-to", "summary.json", "events.csv", "--floor-spectrum"] {
        assert!(help.contains(word), "{word}");
    }
    assert!(folder.stdout(&["--version"]).starts_with("slipstick "));
    // Without a command: the help, where messages go.
    let output = folder.output(&[]);
    assert_eq!((output.status.code(), text(&output.stdout).as_str()), (Some(2), ""));
    assert!(text(&output.stderr).contains("slipstick init"));
}

#[test]
fn display_units_are_those_of_the_table_only() {
    let folder = Folder::with_model("units", BLOCK);
    let table = |system: &str| folder.stdout(&["run", "model.toml", "--display-units", system]);
    let [si, kn_mm, us] = ["si", "kN-mm", "us"].map(table);
    assert_eq!(si, folder.stdout(&["run", "model.toml"]));
    assert!(kn_mm.contains(" kN") && kn_mm.contains(" mm"), "{kn_mm}");
    assert!(us.contains(" kip") && us.contains(" in"), "{us}");
    let json = folder.stdout(&["run", "model.toml", "--json"]);
    assert_eq!(json, folder.stdout(&["run", "model.toml", "--json", "--display-units", "us"]));
    for text in [si, kn_mm, us, json] {
        assert!(!text.contains('\u{1b}') && !text.contains('\r') && text.ends_with('\n'));
    }
}

#[test]
fn messages_go_to_standard_error_and_quiet_takes_them_away() {
    // The gap is passed, which is a warning.
    let folder =
        Folder::with_model("quiet", &BLOCK.replace("20 kN/m\"", "20 kN/m\"\ngap = \"1 mm\""));
    let stderr = |arguments: &[&str]| {
        let output = folder.output(&[&["run", "model.toml"], arguments].concat());
        assert_eq!(output.status.code(), Some(0));
        text(&output.stderr)
    };
    assert!(stderr(&["--json"]).starts_with("severe: gap_exceeded: "));
    assert_eq!(stderr(&["--json", "-q"]), "");
    assert_eq!(stderr(&[]), "");
    assert_eq!(stderr(&["--out", "out"]), "wrote out/report.html\n");
    assert_eq!(stderr(&["--out", "out", "--quiet"]), "");
    assert!(folder.stdout(&["run", "model.toml"]).contains("gap_exceeded"));
}

/// Without --motion the scale is that of the model's own record.
#[test]
fn scale_without_a_motion_is_that_of_the_model() {
    let folder = Folder::with_model("scale-of-model", RECORDED);
    folder.write("record.csv", RECORD);
    let scaled = folder.json(&["model.toml", "--scale-to", "0.3 g"]);
    assert!(
        (scaled["record"]["pga_m_per_s2"].as_f64().unwrap() / 0.3 / 9.80665 - 1.0).abs() < 1e-14
    );
    let set = folder.json(&["model.toml", "--set", "motion.scale_to=0.3 g"]);
    assert_eq!(scaled, set);
    let twice = folder.json(&["model.toml", "--scale", "-2"]);
    assert_eq!(twice["record"]["pga_m_per_s2"], 10.0);
    folder.write("sine.toml", BLOCK);
    let found = folder.refused(&["run", "sine.toml", "--scale-to", "0.3 g"]);
    let expected = "--scale-to: expected a record to scale; of a made motion the amplitude is a key of \
                    the model, found \"scale_to\" beside \"sine\"";
    assert!(found.starts_with(expected), "{found}");
}

/// A tail that ends between two steps does not make the record's step uneven.
#[test]
fn the_report_tells_the_step_of_the_record() {
    let model = format!("{RECORDED}\n[analysis]\ntail = \"0.7 s\"\n");
    let folder = Folder::with_model("step-of-record", &model);
    folder.write("record.csv", RECORD);
    folder.stdout(&["run", "model.toml", "--out", "out", "-q"]);
    let page = folder.read("out/report.html");
    assert!(page.contains("Time step") && !page.contains("uneven"), "uneven");
}

/// One long line of numbers is a series as several lines of them are.
#[test]
fn one_long_line_is_a_record() {
    let folder = Folder::new("long-line");
    let numbers: Vec<String> =
        (0..200).map(|i| format!("{:.4}", (0.3 * f64::from(i)).sin())).collect();
    folder.write("line.txt", numbers.join(" "));
    let lines: Vec<String> = numbers.chunks(8).map(|line| line.join(" ")).collect();
    folder.write("lines.txt", lines.join("\n"));
    let of = |file: &str| {
        let text =
            folder.stdout(&["record", "info", file, "--units", "g", "--dt", "0.01 s", "--json"]);
        let found: serde_json::Value = serde_json::from_str(&text).unwrap();
        (found[0]["npts"].clone(), found[0]["pga_m_per_s2"].clone())
    };
    assert_eq!(of("line.txt"), of("lines.txt"));
    assert_eq!(of("line.txt").0, 200);
}
