//! What `--out` writes.

use super::support::{BLOCK, Folder, RECORDED, cells, column};

const FILES: [&str; 4] = ["events.csv", "history.csv", "report.html", "summary.json"];

/// A model with two storeys.
fn storeys() -> String {
    let storey = "\n[[storey]]\nmass = \"40 kg\"\nstiffness = \"50 kN/m\"\ndamping_ratio = 0.02\n";
    BLOCK.replace("\n[motion]", &format!("{storey}{storey}\n[motion]"))
}

#[test]
fn same_command_writes_the_same_bytes() {
    let folder = Folder::with_model("same", &storeys());
    let run = || {
        folder.stdout(&["run", "model.toml", "--out", "out", "--floor-spectrum"]);
        folder.contents()
    };
    let first = run();
    assert_eq!(folder.names("out"), FILES);
    assert_eq!(run(), first);
    let json = folder.stdout(&["run", "model.toml", "--json", "--floor-spectrum"]);
    assert!(folder.read("out/summary.json") == json);
}

#[test]
fn output_folder_keeps_what_is_not_ours() {
    let folder = Folder::with_model("keeps", BLOCK);
    folder.write("out/notes.txt", "mine");
    folder.write("out/history.csv", "older");
    folder.stdout(&["run", "model.toml", "-o", "out"]);
    assert_eq!(folder.read("out/notes.txt"), "mine");
    assert!(folder.read("out/history.csv").starts_with("time_s,"));
    assert_eq!(folder.names("out").len(), 5);
}

#[test]
fn history_has_the_columns_and_rows_of_the_manual() {
    let folder =
        Folder::with_model("history", &format!("{}[analysis]\ntail = \"1 s\"\n", storeys()));
    let json = folder.json(&["model.toml", "--out", "out"]);
    let csv = folder.read("out/history.csv");
    assert_eq!(
        csv.lines().next().unwrap(),
        "time_s,table_acceleration_m_per_s2,sliding_displacement_m,sliding_velocity_m_per_s,\
         block_acceleration_m_per_s2,friction_force_n,storey1_displacement_m,\
         storey1_velocity_m_per_s,storey1_acceleration_m_per_s2,storey2_displacement_m,\
         storey2_velocity_m_per_s,storey2_acceleration_m_per_s2"
    );
    let times = column(&csv, "time_s");
    assert_eq!(json["samples"], times.len());
    assert_eq!(times.last(), Some(&6.0));
    assert!(times.windows(2).all(|t| t[0] <= t[1]));
    let digits = |cell: &String| {
        let mantissa = cell.trim_start_matches('-').split('e').next().unwrap();
        mantissa.chars().filter(char::is_ascii_digit).count()
    };
    for name in csv.lines().next().unwrap().split(',') {
        assert!(cells(&csv, name).iter().all(|cell| digits(cell) == 17), "{name}");
    }
    let last = *column(&csv, "sliding_displacement_m").last().unwrap();
    assert_eq!(json["residual_sliding_displacement_m"], last);
    assert!(!csv.contains('\r') && csv.ends_with('\n'));
}

#[test]
fn repeated_times_give_two_rows() {
    let folder = Folder::with_model("jump", RECORDED);
    folder.write("record.csv", "time_s,acceleration_m_per_s2\n0,1\n1,1\n1,-4\n2,-4\n2,0\n3,0\n");
    let json = folder.json(&["model.toml", "--out", "out"]);
    let csv = folder.read("out/history.csv");
    assert_eq!(column(&csv, "time_s"), [0.0, 1.0, 1.0, 2.0, 2.0, 3.0]);
    let table = column(&csv, "table_acceleration_m_per_s2");
    assert_eq!(table, [1.0, 1.0, -4.0, -4.0, 0.0, 0.0]);
    assert_eq!((json["samples"].as_u64(), json["dt_s"].is_null()), (Some(6), true));
}

#[test]
fn step_is_that_of_the_record_whatever_the_tail() {
    // The last sample is not 0, so that the tail starts with a jump, and ends between two steps.
    let record = "time_s,acceleration_m_per_s2\n0,0\n1,5\n2,-5\n3,1\n";
    let folder = Folder::with_model("tail", &format!("{RECORDED}[analysis]\ntail = \"1.5 s\"\n"));
    folder.write("record.csv", record);
    let json = folder.json(&["model.toml", "--out", "out"]);
    assert_eq!(json["dt_s"], 1.0);
    assert_eq!(json["duration_s"], 4.5);
    let times = column(&folder.read("out/history.csv"), "time_s");
    assert_eq!(times, [0.0, 1.0, 2.0, 3.0, 3.0, 4.0, 4.5]);
    assert_eq!(json["samples"], times.len());
}

#[test]
fn events_are_those_that_were_counted() {
    let folder = Folder::with_model("events", BLOCK);
    let json = folder.json(&["model.toml", "--out", "out"]);
    let csv = folder.read("out/events.csv");
    assert_eq!(
        csv.lines().next().unwrap(),
        "time_s,kind,direction,sliding_displacement_m,interface"
    );
    let kinds = cells(&csv, "kind");
    for (kind, key) in
        [("slip", "slip_count"), ("reversal", "reversal_count"), ("stick", "stick_count")]
    {
        assert_eq!(json[key], kinds.iter().filter(|k| *k == kind).count(), "{kind}");
    }
    for (kind, direction) in kinds.iter().zip(cells(&csv, "direction")) {
        let known: &[&str] = if kind == "stick" { &["0"] } else { &["1", "-1"] };
        assert!(known.contains(&direction.as_str()), "{kind} {direction}");
    }
}

#[test]
fn report_names_what_it_came_from() {
    let folder = Folder::with_model("report", RECORDED);
    folder.write("record.csv", "time_s,acceleration_m_per_s2\n0,0\n1,5\n2,-5\n3,0\n");
    folder.stdout(&["run", "model.toml", "--out", "out"]);
    let report = folder.read("out/report.html");
    for word in ["model.toml", "record.csv", "slipstick run model.toml --out out", "124 kg"] {
        assert!(report.contains(word), "{word}");
    }
    let outside = ["http://", "https://", "<script ", "<link", "src="];
    for word in outside.iter().filter(|word| report.contains(**word)) {
        // The name of a namespace is no address.
        let plain = report.replace("http://www.w3.org/", "");
        assert!(!plain.contains(*word), "{word}");
    }
}
