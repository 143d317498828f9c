//! Bad input: one clear message, exit status 2, nothing written and nothing touched.

use super::support::{BLOCK, Folder, RECORD, RECORDED, message, output};

/// The message for a model, run with an output folder that must not stay.
fn of_model(test: &str, bytes: impl AsRef<[u8]>) -> String {
    let folder = Folder::new(test);
    folder.write("model.toml", bytes);
    folder.refused(&["run", "model.toml", "--out", "out/new"])
}

/// The message for a model with one line replaced.
fn of_change(test: &str, from: &str, to: &str) -> String {
    assert!(BLOCK.contains(from), "{from}");
    of_model(test, BLOCK.replace(from, to))
}

/// UTF-16 with its byte order mark.
fn utf16(text: &str) -> Vec<u8> {
    let units = std::iter::once(0xfeff).chain(text.encode_utf16());
    units.flat_map(u16::to_le_bytes).collect()
}

#[test]
fn model_that_is_no_text() {
    assert_eq!(
        of_model("model-utf16", utf16(BLOCK)),
        "model.toml:1:1: expected text in UTF-8, found the byte 0xff"
    );
    assert_eq!(
        of_model("model-latin", b"name = \"Stra\xdfe\"\n"),
        "model.toml:1:13: expected text in UTF-8, found the byte 0xdf"
    );
    let bytes: Vec<u8> = (0..=255).cycle().skip(1).take(4000).collect();
    let found = of_model("model-binary", bytes);
    assert!(found.starts_with("model.toml:") && found.contains("expected"), "{found}");
    let found = of_model("model-nul", "name = \"a\0b\"\n");
    assert!(found.starts_with("model.toml:1:"), "{found}");
}

#[test]
fn model_that_ends_too_soon() {
    assert_eq!(
        of_model("model-empty", ""),
        "model.toml:1:1: block: expected a table [block], found nothing"
    );
    // Wherever the text is cut, it is a model still or one message; never anything else.
    let folder = Folder::new("model-truncated");
    for end in (0..BLOCK.len()).step_by(19) {
        folder.write("model.toml", &BLOCK[..end]);
        let found = folder.refused(&["run", "model.toml", "--out", "out"]);
        assert!(found.starts_with("model.toml:"), "{end}: {found}");
    }
}

#[test]
fn model_too_long() {
    let comment = format!("{BLOCK}#{}\n", "x".repeat(1 << 20));
    let found = of_model("model-long", &comment);
    assert_eq!(found, "model.toml: expected at most 1048576 bytes, found more");
    let folder = Folder::new("model-long-stdin");
    folder.write("long.toml", &comment);
    let stdin = std::fs::File::open(folder.path().join("long.toml")).unwrap();
    let output = output(folder.command(&["run", "-"]).stdin(stdin));
    let found = message(&["run", "-"], &output);
    assert_eq!(found, "standard input: expected at most 1048576 bytes, found more");
}

#[test]
fn values_that_no_model_has() {
    for (test, from, to, expected) in [
        ("nan", "0.153", "nan", "model.toml:8:20: slider.kinetic_friction: expected "),
        ("infinity", "0.165", "inf", "model.toml:7:19: slider.static_friction: expected "),
        ("infinite-mass", "124 kg", "1e400 kg", "model.toml:4:8: block.mass: expected "),
        ("nan-mass", "124 kg", "NaN kg", "model.toml:4:8: block.mass: expected "),
        ("kinetic", "0.153", "0.17", "model.toml:8:20: slider.kinetic_friction: expected "),
        ("negative", "124 kg", "-1 kg", "model.toml:4:8: block.mass: expected "),
        ("no-unit", "\"124 kg\"", "124", "model.toml:4:8: block.mass: expected "),
        ("wrong-unit", "20 kN/m", "20 kN", "model.toml:9:10: slider.spring: expected "),
        ("dt", "0.01 s", "0 s", "model.toml:12:75: motion.sine.dt: expected "),
        ("steps", "0.01 s", "5e-12 s", "model.toml:12:75: motion.sine.dt: expected "),
        ("duration", "5 s", "1e10 s", "model.toml:12:78: motion.sine.dt: expected "),
    ] {
        let found = of_change(test, from, to);
        assert!(found.starts_with(expected), "{test}: {found}");
    }
}

#[test]
fn messages_of_made_motions_and_tails() {
    assert_eq!(
        of_change("asked", "0.01 s", "5e-12 s"),
        "model.toml:12:75: motion.sine.dt: expected at most 100 000 000 samples, found 1.0e12"
    );
    let ramp = of_change("ramp", "dt =", "ramp = \"6 s\", dt =");
    assert_eq!(
        ramp,
        "model.toml:12:77: motion.sine.ramp: expected ramp + decay in s at most the duration, \
         found 6"
    );
    assert_eq!(
        of_model("tail", format!("{BLOCK}[analysis]\ntail = \"1e10 s\"\n")),
        "model.toml:14:8: analysis.tail: expected at most 100 000 000 samples, those of the motion \
         among them, found 1.0e12"
    );
}

#[test]
fn unknown_names_offer_the_nearest() {
    let found = of_change("key", "spring =", "sprng =");
    assert!(found.contains("sprng") && found.ends_with("nearest is \"spring\""), "{found}");
    let folder = Folder::with_model("names", BLOCK);
    for (arguments, nearest) in [
        (&["rum", "model.toml"] as &[&str], "'run'"),
        (&["shema"], "'schema'"),
        (&["run", "model.toml", "--jsn"], "'--json'"),
        (&["run", "model.toml", "--method", "exct"], "'exact'"),
        (&["run", "model.toml", "--display-units", "kN-m"], "'kN-mm'"),
        (&["init", "--example", "bloc"], "'block'"),
    ] {
        let found = folder.refused(arguments);
        assert!(found.contains(nearest), "{arguments:?}: {found}");
    }
    let found = folder.refused(&["run", "model.toml", "--set", "slider.sprng=1 kN/m"]);
    assert!(found.starts_with("--set ") && found.contains("slider.spring"), "{found}");
    let found = folder.refused(&["run", "model.toml", "--set", "slider.spring"]);
    assert!(found.contains("PATH=VALUE"), "{found}");
    let found = folder.refused(&["run", "model.toml", "--set", "slider.spring=1 kN"]);
    assert!(found.contains("slider.spring: expected"), "{found}");
    assert!(folder.refused(&["run"]).contains("<MODEL>"));
}

#[test]
fn paths_that_lead_nowhere() {
    let folder = Folder::with_model("paths", RECORDED);
    assert_eq!(
        folder.refused(&["run", "none.toml"]),
        "none.toml: cannot be read: there is no such file or folder"
    );
    assert_eq!(folder.refused(&["run", "."]), ".: expected a file, found a folder");
    assert_eq!(
        folder.refused(&["run", "model.toml"]),
        "model.toml:9:10: motion.record: expected a file that can be read, found record.csv: there \
         is no such file or folder"
    );
    assert_eq!(
        folder.refused(&["run", "model.toml", "--motion", "none.AT2"]),
        "none.AT2: cannot be read: there is no such file or folder"
    );
    let folder_there = ["run", "model.toml", "--motion", "."];
    assert_eq!(folder.refused(&folder_there), ".: expected a file, found a folder");
    folder.write("record.csv/inside", "");
    assert_eq!(
        folder.refused(&["run", "model.toml"]),
        "model.toml:9:10: motion.record: expected a file, found the folder record.csv"
    );
}

#[test]
fn outputs_that_cannot_be() {
    let folder = Folder::with_model("outputs", BLOCK);
    folder.write("taken", "mine");
    for out in ["taken", "taken/deeper", "model.toml"] {
        let file = out.split('/').next().unwrap();
        assert_eq!(
            folder.refused(&["run", "model.toml", "--out", out]),
            format!("{file}: expected a folder to write to, found a file")
        );
    }
    assert!(folder.refused(&["run", "model.toml", "--out", ""]).contains("--out"));
    if cfg!(target_os = "linux") {
        let found = folder.refused(&["run", "model.toml", "--out", "/proc/slipstick"]);
        assert!(found.starts_with("/proc/slipstick: cannot be written: "), "{found}");
    }
    folder.write("out/history.csv/inside", "");
    folder.write("out/summary.json", "older");
    assert_eq!(
        folder.refused(&["run", "model.toml", "--out", "out"]),
        "out/history.csv: expected a file, found a folder"
    );
}

#[test]
fn inputs_are_never_replaced() {
    let folder = Folder::new("inputs");
    folder.write("summary.json", BLOCK);
    let expected = "summary.json: is an input of this analysis and is not overwritten";
    assert_eq!(folder.refused(&["run", "summary.json", "--out", "."]), format!("./{expected}"));
    folder.write("model.toml", RECORDED.replace("record.csv", "history.csv"));
    folder.write("history.csv", RECORD);
    let expected = "history.csv: is an input of this analysis and is not overwritten";
    assert_eq!(folder.refused(&["run", "model.toml", "--out", "."]), format!("./{expected}"));
    let motion = ["run", "summary.json", "--motion", "history.csv", "--out", "."];
    folder.refused(&motion);
}

#[test]
fn analysis_that_fails_leaves_no_folder() {
    let folder = Folder::with_model("unsolved", &BLOCK.replace("20 kN/m", "2000 MN/m"));
    let found = folder.refused(&["run", "model.toml", "--method", "stepwise", "--out", "a/b"]);
    let start = "model.toml: stepwise method: 200 iterations did not converge at 0.05 s:";
    assert!(found.starts_with(start), "{found}");
}

#[test]
fn options_that_make_no_sense() {
    let folder = Folder::with_model("nonsense", BLOCK);
    folder.write("one.txt", "0\n1\n-1\n0\n");
    let beside = |options: &[&str]| {
        let all = [&["run", "model.toml", "--motion", "one.txt"], options].concat();
        folder.refused(&all)
    };
    for (options, expected) in [
        (&[] as &[&str], "one.txt:1:1: expected units and time step,"),
        (&["--units", "g"], "one.txt:1:1: expected a time step,"),
        (&["--units", "furlong", "--dt", "1 s"], "--units: expected a unit of acceleration (m/s2,"),
        (&["--units", "mm", "--dt", "1 s"], "--units: expected a unit of acceleration (m/s2,"),
        (&["--units", "g", "--dt", "0 s"], "--dt: expected a time step > 0, found \"0 s\""),
        (&["--units", "g", "--dt", "nan s"], "--dt: expected a time"),
        (&["--units", "g", "--dt", "1"], "--dt: expected a time"),
        (&["--units", "g", "--dt", "1 s", "--scale", "two"], "--scale: expected a factor"),
        (&["--units", "g", "--dt", "1 s", "--scale", "inf"], "--scale: expected a factor"),
        (&["--units", "g", "--dt", "1 s", "--scale-to", "0 g"], "--scale-to: expected a peak"),
        (&["--units", "g", "--dt", "1 s", "--channel", "2"], "one.txt: expected an acceleration"),
    ] {
        let found = beside(options);
        assert!(found.starts_with(expected), "{options:?}: {found}");
    }
    let both = beside(&["--scale", "2", "--scale-to", "1 g"]);
    assert_eq!(both, "--scale: expected only one of --scale and --scale-to, found both");
    let alone = folder.refused(&["run", "model.toml", "--units", "g"]);
    assert!(alone.contains("--motion <FILE>"), "{alone}");
}

#[test]
fn init_replaces_nothing_unasked() {
    let folder = Folder::with_model("init-taken", "mine");
    let found = folder.refused(&["init"]);
    assert!(found.starts_with("model.toml: ") && found.contains("--force"), "{found}");
    assert!(folder.refused(&["init", "nowhere/model"]).starts_with("nowhere/model.toml: "));
    for name in ["", "-", ".toml", "..", "/", "a/"] {
        let found = folder.refused(&["init", "--", name]);
        assert!(found.starts_with("expected a name"), "{name:?}: {found}");
    }
    folder.stdout(&["init", "--force"]);
    assert!(folder.read("model.toml").contains("[block]"));
}

/// What is often written in another way is answered with the way to write it.
#[test]
fn messages_name_the_mend() {
    let one =
        format!("{BLOCK}\n[storey]\nmass = \"45 kg\"\nperiod = \"0.5 s\"\ndamping_ratio = 0.05\n");
    let refused = of_model("mend-storey", &one);
    let expected = "storey: expected [[storey]] in two brackets, one for each, found [storey]";
    assert!(refused.contains(expected), "{refused}");
    let refused = of_change("mend-block", "[block]", "[[block]]");
    let expected = "block: expected [block] in single brackets: there is one, found [[block]]";
    assert!(refused.contains(expected), "{refused}");
    let refused = of_change("mend-comma", "\"124 kg\"", "\"124,5 kg\"");
    assert!(
        refused.contains("block.mass: expected a decimal point, \"124.5 kg\", found \"124,5 kg\""),
        "{refused}"
    );
    let refused = of_change("mend-comma-bare", "0.165", "0,165");
    assert!(
        refused.contains("model.toml:7:19: expected a decimal point, 0.165, found 0,165"),
        "{refused}"
    );
    let folder = Folder::with_model("mend-command", BLOCK);
    folder.write("plan.toml", "model = \"model.toml\"\n");
    folder.write("record.csv", RECORD);
    for (file, command) in
        [("model.toml", "run"), ("plan.toml", "study"), ("record.csv", "record info")]
    {
        let expected = format!(
            "expected a command, found the file {file}: write \"slipstick {command} {file}\""
        );
        assert_eq!(folder.refused(&[file]), expected);
    }
}

/// A ratio may be written in percent wherever one is taken.
#[test]
fn ratios_in_percent() {
    let folder = Folder::with_model("percent", BLOCK);
    let plain =
        ["model.toml", "--set", "slider.asymmetry=0.05", "--set", "slider.kinetic_friction=0.125"];
    let percent =
        ["model.toml", "--set", "slider.asymmetry=5 %", "--set", "slider.kinetic_friction=12.5 %"];
    assert_eq!(folder.json(&plain)["block"], folder.json(&percent)["block"]);
    folder.write("model.toml", BLOCK.replace("0.165", "\"16.5%\"").replace("0.153", "\"15.3 %\""));
    let in_percent = folder.json(&["model.toml"]);
    folder.write("model.toml", BLOCK);
    assert_eq!(folder.json(&["model.toml"])["block"], in_percent["block"]);
    folder.write("model.toml", BLOCK.replace("0.165", "\"16.5 percent\""));
    let refused = folder.refused(&["run", "model.toml"]);
    assert!(refused.contains("slider.static_friction: expected a finite number"), "{refused}");
}

/// Notes stand apart from warnings, and what is hardly meant is said.
#[test]
fn notes_are_not_warnings() {
    let folder = Folder::with_model("notes", RECORDED);
    let kinds = |list: &serde_json::Value| -> Vec<String> {
        let list = list.as_array().unwrap().iter();
        list.map(|warning| warning["kind"].as_str().unwrap().to_owned()).collect()
    };
    let record =
        |first: &str| format!("time_s,acceleration_m_per_s2\n0,{first}\n0.1,5\n0.2,-5\n0.3,0\n");
    folder.write("record.csv", record("0.05"));
    let small = folder.json(&["model.toml"]);
    assert_eq!(
        (kinds(&small["notes"]), kinds(&small["warnings"])),
        (vec!["first_sample_small".to_owned()], vec![])
    );
    let table = folder.stdout(&["run", "model.toml"]);
    assert!(table.contains("\nNote") && !table.contains("Warning"), "{table}");
    folder.write("record.csv", record("0.06"));
    let large = folder.json(&["model.toml"]);
    assert_eq!(kinds(&large["warnings"]), ["first_sample_not_zero"]);

    folder.write("record.csv", record("0"));
    let with = |set: &[&str]| {
        let words: Vec<&str> = set.iter().flat_map(|pair| ["--set", pair]).collect();
        kinds(&folder.json(&[&["model.toml"][..], &words[..]].concat())["warnings"])
    };
    assert_eq!(with(&["slider.static_friction=0.51"]), ["nothing_slides", "high_friction"]);
    assert_eq!(with(&["slider.static_friction=0.5"]), ["nothing_slides"][..0]);
    let storey = "\n[[storey]]\nmass = \"45 kg\"\nperiod = \"0.5 s\"\ndamping_ratio = 0.31\n";
    folder.write("model.toml", format!("{RECORDED}{storey}"));
    assert!(with(&[]).contains(&"high_damping".to_owned()));
    folder.write("record.csv", "time_s,acceleration_m_per_s2\n0,0\n0.1,50\n0.2,-50\n0.3,0\n");
    assert!(with(&[]).contains(&"absurd_peak".to_owned()));
}

/// An analysis that would take hours says why and what to do, before it starts.
#[test]
fn endless_analyses_are_refused_with_advice() {
    let folder = Folder::new("endless");
    let model = |mass: &str, stiffness: &str, damping: &str, storeys: usize| {
        let storey = format!(
            "\n[[storey]]\nmass = \"{mass}\"\nstiffness = \"{stiffness}\"\ndamping_ratio = {damping}\n"
        );
        format!("{RECORDED}{}", storey.repeat(storeys))
    };
    folder.write("record.csv", RECORD);
    folder.write("model.toml", model("45 kg", "1e16 kN/m", "0.02", 1));
    let begun = std::time::Instant::now();
    let refused = folder.refused(&["run", "model.toml"]);
    let advice = "storey 1 is a rigid link; leave it out and add its mass to the one below";
    assert!(refused.starts_with("model.toml: the analysis would take "), "{refused}");
    assert!(refused.ends_with(advice), "{refused}");
    folder.write("model.toml", model("45 t", "1e5 kN/m", "1e6", 60));
    let refused = folder.refused(&["run", "model.toml"]);
    assert!(refused.contains("a damper or a stop acts within"), "{refused}");
    // Sixty ordinary storeys and an hour without a sample: that is the motion's.
    let samples: String =
        (0..1000).map(|k| format!("{},{}\n", f64::from(k) * 0.01, k % 7 - 3)).collect();
    let gap = format!("time_s,acceleration_m_per_s2\n{samples}9000,0\n");
    folder.write("record.csv", gap);
    folder.write("model.toml", model("45 t", "1e5 kN/m", "0.05", 60));
    let refused = folder.refused(&["run", "model.toml"]);
    assert!(refused.contains("the motion has a gap of 8990.01 s; cut it there"), "{refused}");
    assert!(begun.elapsed().as_secs() < 60, "{:?}", begun.elapsed());
}

/// What was meant is named: a record is no model, a made motion is not scaled, an option belongs to another.
#[test]
fn messages_say_what_was_meant() {
    let folder = Folder::with_model("meant", BLOCK);
    folder.write("record.csv", RECORD);
    let at2 = "PEER NGA STRONG MOTION DATABASE RECORD\nSomewhere, 1999, Station, 090\n\
               ACCELERATION TIME SERIES IN UNITS OF G\nNPTS=   5, DT=   .0100 SEC\n\
               0.1E+00 0.2E+00 0.3E+00 0.4E+00 0.5E+00\n";
    folder.write("record.AT2", at2);
    for (arguments, expected) in [
        (
            &["run", "model.toml", "--scale-to", "0.3 g"][..],
            "--scale-to: expected a record to scale; of a made motion the amplitude is a key of the model",
        ),
        (&["run", "record.AT2"], "record.AT2: expected a model, found a record (a record is given"),
        (&["run", "record.csv"], "record.csv: expected a model, found a record (a record is given"),
        (
            &["compare", "model.toml", "record.csv"],
            "record.csv: expected a model, found a record (a record is given beside a model, with \
             --motion or --records; what was measured stands before the model)",
        ),
        (
            &["identify", "cyclic", "record.AT2"],
            "record.AT2:1:1: expected a table with a column a sensor, found \"a record of ground motion, \
             PEER AT2\"",
        ),
        (
            &["compare", "model.toml", "model.toml"],
            "model.toml:1:1: expected a table with a column a sensor, found \"a model: what was measured \
             stands before it\"",
        ),
        (
            &["identify", "shaking-table", "model.toml", "record.csv"],
            "model.toml:1:1: expected a table with a column a sensor, found \"a model: what was measured \
             stands before it\"",
        ),
        (
            &["run", "model.toml", "record.csv"],
            "record.csv: expected a model, found a record (a record is given beside a model",
        ),
        (
            &["run", "model.toml", "--second", "record.csv"],
            "--second: expected a suite beside it, --records <PATTERN>",
        ),
        (
            &["run", "model.toml", "--set", "slider.friction=0.1"],
            "--set slider.friction=…:1:1: expected static_friction or kinetic_friction of slider, found \
             \"slider.friction\"",
        ),
        (
            &[
                "ida",
                "model.toml",
                "--records",
                "record.csv",
                "--scale-to",
                "1, 2 m/s2",
                "--demand",
                "force",
            ],
            "--demand: expected the key of a demand, such as peak_sliding_displacement_m, found \
             \"force\"; nearest is \"peak_slider_force_n\"",
        ),
    ] {
        let found = folder.refused(arguments);
        assert!(found.starts_with(expected), "{arguments:?}: {found}");
    }
}

/// A key that takes the place of others says so: a gap is no stop.
#[test]
fn replaced_keys_are_said() {
    let stop = "[slider]\nstop = { gap = \"50 mm\", stiffness = \"1 MN/m\" }";
    let folder = Folder::with_model("replaced", &BLOCK.replace("[slider]", stop));
    let output = folder.output(&["run", "model.toml", "--set", "slider.gap=20 mm"]);
    let said = String::from_utf8(output.stderr).unwrap();
    let expected =
        "note: slider.gap replaces slider.stop.gap, slider.stop.stiffness of the model\n";
    assert!(said.contains(expected), "{said}");
    let output = folder.output(&["run", "model.toml", "--set", "slider.spring=30 kN/m"]);
    assert_eq!(String::from_utf8(output.stderr).unwrap(), "");
}

/// The results of a suite are not mixed with the history of an earlier run.
#[test]
fn results_of_another_run_do_not_stay() {
    let folder = Folder::with_model("stale", BLOCK);
    folder.write("records/a.csv", RECORD);
    folder.stdout(&["run", "model.toml", "--out", "out", "-q"]);
    assert!(folder.names("out").contains(&"history.csv".to_owned()));
    folder.write("out/mine.csv", "a,b\n1,2\n");
    folder.stdout(&["run", "model.toml", "--records", "records", "--out", "out", "-q"]);
    let names = folder.names("out");
    assert!(
        !names.iter().any(|name| ["history.csv", "events.csv"].contains(&&name[..])),
        "{names:?}"
    );
    assert!(names.contains(&"runs.csv".to_owned()) && names.contains(&"mine.csv".to_owned()));
    folder.stdout(&["run", "model.toml", "--out", "out", "-q"]);
    let names = folder.names("out");
    assert!(!names.contains(&"runs.csv".to_owned()) && names.contains(&"history.csv".to_owned()));
    // A file of that name in a folder without results is somebody's own.
    folder.write("own/history.csv", "a,b\n1,2\n");
    folder.stdout(&["run", "model.toml", "--records", "records", "--out", "own", "-q"]);
    assert_eq!(folder.read("own/history.csv"), "a,b\n1,2\n");
}

/// The displacement of a record that drifts is no displacement of the ground, and is marked.
#[test]
fn drifting_displacement_is_marked() {
    let folder = Folder::with_model("drifting", RECORDED);
    folder.write("record.csv", RECORD);
    assert!(!folder.stdout(&["run", "model.toml"]).contains("drifts)"));
    folder.write("record.csv", "time_s,acceleration_m_per_s2\n0,0\n1,5\n2,-3\n3,0\n");
    let text = folder.stdout(&["run", "model.toml", "--out", "out"]);
    assert!(
        text.split_whitespace().collect::<Vec<_>>().join(" ").contains("(the record drifts)"),
        "{text}"
    );
    assert!(folder.read("out/report.html").contains("PGD (the record drifts)"));
}

/// Radii and surfaces that are hardly meant are said, and run.
#[test]
fn suspicious_surfaces_are_said() {
    let motion = "[motion]\nsine = { frequency = \"2 Hz\", amplitude = \"3 m/s2\", duration = \"2 s\", \
                  dt = \"0.01 s\" }\n";
    let model = |slider: &str| format!("[block]\nmass = \"1 t\"\n[slider]\n{slider}\n{motion}");
    let small = "static_friction = 0.06\nkinetic_friction = 0.05\nradius = \"2 mm\"";
    let inner = "[[slider.surface]]\nfriction = 0.08\nradius = \"0.5 m\"\n[[slider.surface]]\n\
                 friction = 0.03\nradius = \"2 m\"";
    for (name, slider, said) in [
        ("small", small, "a radius is 0.002 m: below 0.05 m is no pendulum slider's"),
        (
            "inner",
            inner,
            "the surface of radius 0.5 m has the friction 0.08, that of 2 m only 0.03",
        ),
    ] {
        let folder = Folder::with_model(&format!("suspicious-{name}"), &model(slider));
        let text = folder.stdout(&["run", "model.toml"]);
        assert!(text.split_whitespace().collect::<Vec<_>>().join(" ").contains(said), "{text}");
    }
}
