//! `slipstick record`: what is printed, written and refused.

use crate::support::{Folder, text};

/// 1 m/s² over 2 s: a pulse of one second between jumps of zero length in time.
const PULSE: &str = "time_s,acceleration_m_per_s2\n0,0\n1,0\n1,1\n2,1\n2,0\n3,0\n";

/// A sine of 2 Hz over 4 s in g, one column.
fn sine() -> String {
    let value = |k: i32| 0.2 * (std::f64::consts::TAU * 2.0 * f64::from(k) * 0.01).sin();
    (0..=400).map(|k| format!("{:.8}\n", value(k))).collect()
}

#[test]
fn file_info_has_the_promised_keys() {
    let folder = Folder::new("record-info");
    folder.write("pulse.csv", PULSE);
    let printed = folder.stdout(&["record", "info", "pulse.csv", "--json"]);
    let list: serde_json::Value = serde_json::from_str(&printed).unwrap();
    let one = &list.as_array().unwrap()[0];
    for key in [
        "file",
        "format",
        "channel",
        "component",
        "units",
        "npts",
        "dt_s",
        "duration_s",
        "pga_m_per_s2",
        "pgv_m_per_s",
        "pgd_m",
        "arias_m_per_s",
        "cav_m_per_s",
        "d5_95_s",
        "tm_s",
        "event",
        "station",
        "warnings",
    ] {
        assert!(one.get(key).is_some(), "{key}");
    }
    assert_eq!((one["npts"].as_u64(), one["dt_s"].as_f64()), (Some(6), None));
    // v = 1 after the pulse, u = 1/2 at its end and 1 more in the last second.
    for (key, expected) in [
        ("pga_m_per_s2", 1.0),
        ("pgv_m_per_s", 1.0),
        ("pgd_m", 1.5),
        ("cav_m_per_s", 1.0),
        ("arias_m_per_s", std::f64::consts::PI / (2.0 * 9.80665)),
        ("d5_95_s", 0.9),
        ("duration_s", 3.0),
    ] {
        let found = one[key].as_f64().unwrap();
        assert!((found - expected).abs() < 1e-12, "{key}: {found}");
    }
    let table = folder.stdout(&["record", "info", "pulse.csv"]);
    assert!(table.starts_with("pulse.csv  (text with 2 columns)\nChannel"), "{table}");
}

#[test]
fn file_a_bad_file_among_many_is_reported_and_the_rest_go_on() {
    let folder = Folder::new("record-many");
    folder.write("suite/a.csv", PULSE);
    folder.write("suite/b.csv", "time_s,acceleration_m_per_s2\n0,0\n1,x\n");
    folder.write("suite/c.csv", PULSE);
    for files in ["suite", "suite/*.csv"] {
        let output = folder.output(&["record", "info", files, "--json"]);
        assert_eq!(output.status.code(), Some(1));
        let list: serde_json::Value = serde_json::from_str(&text(&output.stdout)).unwrap();
        assert_eq!(list.as_array().unwrap().len(), 2);
        let stderr = text(&output.stderr);
        assert!(stderr.contains("b.csv:3:3: expected"), "{stderr}");
        assert!(stderr.contains("1 file of 3 could not be used"), "{stderr}");
    }
    let output = folder.output(&["record", "info", "suite/b.csv"]);
    assert_eq!(output.status.code(), Some(2));
    let output = folder.output(&["record", "info", "suite/*.AT2"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("expected a file, a folder or a pattern"));
}

#[test]
fn file_converted_records_read_back() {
    let folder = Folder::new("record-convert");
    folder.write("sine.txt", sine());
    let given = ["--units", "g", "--dt", "0.01 s"];
    let info = |name: &str, given: &[&str]| {
        let arguments = [&["record", "info", name, "--json"], given].concat();
        let list: serde_json::Value = serde_json::from_str(&folder.stdout(&arguments)).unwrap();
        list[0].clone()
    };
    let first = info("sine.txt", &given);
    for name in ["sine.csv", "sine.AT2", "sine.smc"] {
        let arguments = [&["record", "convert", "sine.txt", name][..], &given].concat();
        assert_eq!(folder.stdout(&arguments), "");
        let back = info(name, &[]);
        assert_eq!((&back["npts"], &back["dt_s"]), (&first["npts"], &first["dt_s"]));
        let (a, b) = (&back["pga_m_per_s2"], &first["pga_m_per_s2"]);
        let error = a.as_f64().unwrap() / b.as_f64().unwrap() - 1.0;
        assert!(error.abs() < 1e-5, "{name}: {error}");
    }
    // Into a folder, by a pattern.
    folder.stdout(&["record", "convert", "sine.[cA]*", "made", "--to", "csv"]);
    assert_eq!(folder.names("made"), ["sine-2.csv", "sine.csv"]);
    folder.stdout(&["record", "convert", "sine.csv", "sine.parquet"]);
    let parquet = std::fs::read(folder.path().join("sine.parquet")).unwrap();
    assert!(parquet.starts_with(b"PAR1") && parquet.ends_with(b"PAR1"));
    let output = folder.output(&["record", "convert", "sine.csv", "sine.csv"]);
    assert!(text(&output.stderr).contains("is an input"), "{}", text(&output.stderr));
    let output = folder.output(&["record", "convert", "sine.csv", "x.xyz"]);
    assert!(text(&output.stderr).contains("ends in .csv, .AT2, .smc or .parquet"));
}

#[test]
fn file_spectrum_of_a_history() {
    let folder = Folder::new("record-spectrum");
    folder.write(
        "history.csv",
        "time_s,table_acceleration_m_per_s2,storey1_acceleration_m_per_s2\n0,1,2\n1,1,2\n2,1,2\n",
    );
    let arguments = [
        "record",
        "spectrum",
        "history.csv",
        "--channel",
        "storey1_acceleration_m_per_s2",
        "--period",
        "0 s",
        "--period",
        "0.5 s",
        "--damping",
        "0 %",
    ];
    let csv = folder.stdout(&arguments);
    let mut lines = csv.lines();
    let header = "file,channel,damping_ratio,period_s,sd_m,sv_m_per_s,psv_m_per_s,psa_m_per_s2,\
                  sa_m_per_s2";
    assert_eq!(lines.next(), Some(header));
    let last = |line: &str| line.rsplit(',').next().unwrap().parse::<f64>().unwrap();
    // A step of 2 m/s²: the rigid oscillator has 2, the undamped one 4.
    assert_eq!(last(lines.next().unwrap()), 2.0);
    assert!((last(lines.next().unwrap()) - 4.0).abs() < 1e-12);
    assert_eq!(lines.next(), None);
    let json = folder.stdout(&[&arguments[..], &["--json"]].concat());
    let list: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(list[0]["spectra"][0]["sa_m_per_s2"][0].as_f64(), Some(2.0));
    folder.stdout(&["record", "spectrum", "history.csv", "-o", "out"]);
    assert_eq!(folder.names("out").len(), 3);
    let fourier = folder.stdout(&["record", "spectrum", "history.csv", "--fourier"]);
    assert!(fourier.starts_with("file,channel,frequency_hz,fourier_amplitude_m_per_s\n"));
}

/// Two components that are one motion at 30°: RotD100 is that motion, RotD50 what |cos| leaves.
#[test]
fn file_spectrum_of_a_pair_over_all_directions() {
    let folder = Folder::new("record-rotd");
    let rows = (0..200).map(|i| {
        let a = (0.3 * f64::from(i)).sin();
        format!("{:.2},{:e},{:e},0\n", 0.01 * f64::from(i), a * 0.75_f64.sqrt(), a * 0.5)
    });
    let header = "time [s],north [m/s2],east [m/s2],up [m/s2]\n";
    folder.write("pair.csv", header.to_owned() + &rows.collect::<String>());
    let pair = ["record", "spectrum", "pair.csv", "--channel", "north", "--second", "east"];
    let json = folder.stdout(&[&pair[..], &["--rotd", "--period", "0 s", "--json"]].concat());
    let list: serde_json::Value = serde_json::from_str(&json).unwrap();
    let value = |i: usize| list[i]["spectra"][0]["sa_m_per_s2"][0].as_f64().unwrap();
    assert_eq!([&list[0]["channel"], &list[1]["channel"]], ["RotD50", "RotD100"]);
    let peak = (0..200).map(|i| (0.3 * f64::from(i)).sin().abs()).fold(0.0, f64::max);
    // The middle of |cos| over whole degrees is that at 45° and 135°.
    assert!((value(0) / peak - 0.5_f64.sqrt()).abs() < 1e-12, "{}", value(0));
    assert!((value(1) / peak - 1.0).abs() < 1e-12);
    folder.stdout(&[&pair[..], &["--rotd", "--count", "5", "-o", "out"]].concat());
    assert_eq!(folder.names("out"), ["RotD100.svg", "RotD50.svg", "spectrum.csv"]);
    let output = folder.output(&["record", "spectrum", "pair.csv", "--rotd"]);
    let message = text(&output.stderr);
    assert!(message.contains("expected two channels of acceleration at right angles"), "{message}");
    assert!(message.contains("--second), found 3"), "{message}");
}

#[test]
fn file_processed_record_names_its_steps() {
    let folder = Folder::new("record-process");
    folder.write("sine.txt", sine());
    let output = folder.output(&[
        "record",
        "process",
        "sine.txt",
        "--units",
        "g",
        "--dt",
        "0.01 s",
        "--step",
        "remove mean",
        "--step",
        "taper 5 %",
        "-o",
        "made.csv",
    ]);
    assert_eq!(text(&output.stderr), "1. remove mean\n2. taper 5 %\n");
    let made = folder.read("made.csv");
    assert!(made.starts_with(
        "Processed from sine.txt: remove mean; taper 5 %\ntime_s,acceleration_m_per_s2\n"
    ));
    let printed = folder.stdout(&["record", "info", "made.csv", "--json"]);
    let list: serde_json::Value = serde_json::from_str(&printed).unwrap();
    assert_eq!((list[0]["npts"].as_u64(), list[0]["dt_s"].as_f64()), (Some(401), Some(0.01)));
    // Velocity and back: on standard output without a name.
    let velocity = folder.stdout(&["record", "process", "made.csv", "--step", "to velocity", "-q"]);
    assert!(velocity.contains("\ntime_s,velocity_m_per_s\n"), "{}", &velocity[..200]);
    let output = folder.output(&["record", "process", "made.csv", "--step", "bandpass 1 Hz 2 Hz"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("nearest is \"band-pass\""));
    let output = folder.output(&["record", "process", "made.csv", "--step", "low-pass 60 Hz"]);
    assert_eq!(output.status.code(), Some(2));
    let stderr = text(&output.stderr);
    assert!(
        stderr.contains("made.csv: low-pass 60 Hz order 4: corner in Hz: expected"),
        "{stderr}"
    );
}

#[test]
fn file_rotated_and_combined_channels() {
    let folder = Folder::new("record-rotate");
    folder.write("pair.csv", "time_s,x (m/s2),y (m/s2)\n0,1,0\n1,3,4\n2,-1,2\n");
    let names = folder.stdout(&["record", "info", "pair.csv", "--json"]);
    let list: serde_json::Value = serde_json::from_str(&names).unwrap();
    let [x, y] = [0, 1].map(|i| list[i]["channel"].as_str().unwrap().to_owned());
    let values = |csv: String| -> Vec<f64> {
        let rows = csv.lines().skip(2).map(|line| line.split(',').nth(1).unwrap().parse());
        rows.collect::<Result<_, _>>().unwrap()
    };
    let rotated = folder.stdout(&[
        "record",
        "process",
        "pair.csv",
        "--channel",
        &x,
        "--second",
        &y,
        "--rotate",
        "90 deg",
        "-q",
    ]);
    assert_eq!(values(rotated), [0.0, 4.0, 2.0]);
    let sum = folder.stdout(&[
        "record",
        "process",
        "pair.csv",
        "--combine",
        &format!("{x}=2"),
        "--combine",
        &format!("{y}=-0.5"),
        "-q",
    ]);
    assert_eq!(values(sum), [2.0, 4.0, -3.0]);
}

#[test]
fn file_plots_are_whole_and_self_contained() {
    let folder = Folder::new("record-plot");
    folder.write("sine.txt", sine());
    let given = ["--units", "g", "--dt", "0.01 s"];
    for (name, start) in [("a.svg", "<svg xmlns"), ("a.html", "<!DOCTYPE html>")] {
        let arguments = [&["record", "plot", "sine.txt", "-o", name][..], &given].concat();
        folder.stdout(&arguments);
        let text = folder.read(name);
        assert!(text.starts_with(start) && !text.contains("NaN"), "{name}");
        assert!(
            !text.contains("http:")
                || text.matches("http:").count() == text.matches("http://www.w3.org").count()
        );
    }
    let output = folder.output(&["record", "plot", "sine.txt", "-o", "a.png"]);
    assert!(text(&output.stderr).contains("ends in .svg or .html"));
}

/// Five lines do not keep it busy: a gap out of proportion is refused at its place, one within is
/// looked at in seconds.
#[test]
fn a_long_gap_is_refused_or_soon_done() {
    let folder = Folder::new("record-gap");
    let gap = |to: &str| {
        format!("time_s,acceleration_m_per_s2\n0,0\n0.01,1\n0.02,-1\n0.03,0.5\n{to},0\n")
    };
    for to in ["1e5", "1e9", "1e300"] {
        folder.write("gap.csv", gap(to));
        let refused = folder.refused(&["record", "info", "gap.csv"]);
        let expected = format!(
            "gap.csv:6:1: expected a time in proportion to the samples after 0.03 s, 4000 s from the \
             first to the last (correct it, cut the motion there, or give the time step as dt if these \
             are no seconds), found {to:?}"
        );
        assert_eq!(refused, expected);
    }
    folder.write("five.txt", "0\n1\n-1\n0.5\n0\n");
    let step = ["record", "info", "five.txt", "--units", "m/s2", "--dt"];
    let refused = folder.refused(&[&step[..], &["1e12 s"]].concat());
    assert!(refused.contains("expected a time step of at most 1000 s given as dt"), "{refused}");
    folder.write("gap.csv", gap("3999"));
    let begun = std::time::Instant::now();
    folder.stdout(&["record", "info", "gap.csv"]);
    folder.stdout(&["record", "spectrum", "gap.csv"]);
    folder.stdout(&[&step[..], &["999 s"]].concat());
    assert!(begun.elapsed().as_secs() < 30, "{:?}", begun.elapsed());
    folder.write("model.toml", crate::support::RECORDED);
    let plan = "model = \"model.toml\"\n[records]\nfiles = [\"five.txt\"]\nunits = \"g\"\n\
                dt = \"1e12 s\"\nscale = [1.0]\n[vary]\n\"slider.kinetic_friction\" = \
                { values = [0.1] }\n[sampling]\nmethod = \"grid\"\n";
    folder.write("plan.toml", plan);
    let refused = folder.refused(&["study", "plan.toml", "--out", "out"]);
    assert!(refused.contains("a time step of at most 1000 s"), "{refused}");
}

/// A pipe in a folder is passed by: who opens one waits for its other end.
#[cfg(unix)]
#[test]
fn file_a_pipe_in_a_folder_is_passed_by() {
    let folder = Folder::new("record-pipe");
    folder.write("suite/a.csv", PULSE);
    let made = std::process::Command::new("mkfifo").arg(folder.path().join("suite/b.csv")).status();
    assert!(made.is_ok_and(|status| status.success()));
    for files in ["suite", "suite/*.csv"] {
        let table = std::process::Command::new("timeout")
            .args(["20", env!("CARGO_BIN_EXE_slipstick"), "record", "info", files])
            .current_dir(folder.path())
            .output()
            .unwrap();
        assert_eq!(table.status.code(), Some(0), "{files}");
    }
    std::fs::remove_file(folder.path().join("suite/b.csv")).unwrap();
}

/// What steers a terminal or turns the direction of writing is shown and not done, in messages as in
/// results.
#[cfg(target_os = "linux")]
#[test]
fn hidden_characters_are_made_visible() {
    let folder = Folder::new("record-hidden");
    let name = "a\u{1b}[2J\n\u{202e}b.csv";
    let shown = r"a\u{1b}[2J\n\u{202e}b.csv";
    let hidden = |text: &str| text.contains(['\u{1b}', '\u{202e}']);
    folder.write(name, "time_s,acceleration_m_per_s2\n0,0\n1,x\n");
    let refused = folder.refused(&["record", "info", name]);
    assert!(!hidden(&refused) && refused.starts_with(&format!("{shown}:3:3: ")), "{refused}");
    let refused = folder.refused(&["run", name]);
    assert!(!hidden(&refused) && refused.contains(shown), "{refused}");
    let refused = folder.refused(&["record", "info", "none\u{1b}[2J"]);
    assert!(refused.starts_with(r"none\u{1b}[2J: expected"), "{refused}");
    let output = folder.output(&["frag\u{1b}[2J"]);
    assert!(!hidden(&text(&output.stderr)), "{:?}", text(&output.stderr));
    folder.write(name, PULSE);
    let table = folder.stdout(&["record", "info", name]);
    assert!(!hidden(&table) && table.contains(shown), "{table}");
}

/// A cell that a spreadsheet would run stands behind an apostrophe.
#[test]
fn cells_that_are_formulas_are_quoted() {
    let folder = Folder::new("record-formula");
    folder.write("=cmd.csv", PULSE);
    let csv = folder.stdout(&["record", "spectrum", "=cmd.csv", "--period", "1 s"]);
    assert!(csv.lines().nth(1).unwrap().starts_with("'=cmd.csv,"), "{csv}");
}

/// Names on one line and their units on the next, as data loggers write them.
#[test]
fn two_header_rows_are_one() {
    let folder = Folder::new("record-two-rows");
    for (text, name) in [
        ("Time;Acc X\ns;m/s2\n0,0;0,0\n0,1;1,5\n0,2;0,0\n", "Acc X (m/s2)"),
        ("Time,Accel\n(s),(cm/s2)\n0.0,0.0\n0.1,150\n0.2,0.0\n", "Accel (cm/s2)"),
        ("\"Time\",\"X\"\n\"sec\",\"m/s^2\"\n0.0,0.0\n0.1,1.5\n0.2,0.0\n", "X (m/s^2)"),
        ("Logger 7\nt X\n[s] [m/s2]\n0.0 0.0\n0.1 1.5\n0.2 0.0\n", "X (m/s2)"),
    ] {
        folder.write("two.csv", text);
        let printed = folder.stdout(&["record", "info", "two.csv", "--json"]);
        let list: serde_json::Value = serde_json::from_str(&printed).unwrap();
        assert_eq!(
            (list[0]["channel"].as_str(), list[0]["dt_s"].as_f64()),
            (Some(name), Some(0.1))
        );
        assert_eq!(list[0]["pga_m_per_s2"].as_f64(), Some(1.5), "{text}");
    }
}
