//! Studies: whatever interrupts, divides or repeats them, the rows are the same.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use slipstick::table::{Cells, Column};
use slipstick_files::read_columns;

use crate::support::{Folder, RECORD, start, text};

/// A block whose friction, radius and gap are varied.
const MODEL: &str = r#"[block]
mass = "10 t"

[slider]
static_friction = 0.2
kinetic_friction = 0.1
gap = "100 mm"

[[storey]]
mass = "5 t"
period = "0.5 s"
damping_ratio = 0.05

[motion]
sine = { frequency = "1 Hz", amplitude = "3 m/s2", duration = "2 s", dt = "0.01 s" }
"#;

/// 2 records × 3 levels × 250 samples: 1500 runs in three parts.
const PLAN: &str = r#"name = "Test of studies"
model = "model.toml"

[records]
files = ["records/*.csv"]
measure = "PGA"
levels = ["0.2 g", "0.3 g", "0.5 g"]

[vary]
"slider.kinetic_friction" = { uniform = [0.02, 0.15] }
"slider.radius" = { lognormal = ["2 m", 0.3] }

[sampling]
method = "sobol"
count = 250
seed = 1
"#;

/// What that study leaves in its folder: in `parts`, where readers take every file, parts only.
const WRITTEN: [&str; 6] = [
    "manifest.json",
    "parts",
    "parts/part-00000.parquet",
    "parts/part-00001.parquet",
    "parts/part-00002.parquet",
    "summary.csv",
];

fn folder(test: &str) -> Folder {
    let folder = Folder::with_model(test, MODEL);
    folder.write("plan.toml", PLAN);
    folder.write("records/a.csv", RECORD);
    folder.write("records/b.csv", RECORD.replace("-5", "-3"));
    folder
}

/// The parts of a study with their bytes.
fn parts(folder: &Folder, out: &str) -> BTreeMap<PathBuf, Vec<u8>> {
    let all = folder.contents().into_iter();
    let parts = PathBuf::from(out).join("parts");
    let inside =
        all.filter_map(|(path, bytes)| Some((path.strip_prefix(&parts).ok()?.to_owned(), bytes?)));
    inside.filter(|(path, _)| path.extension().is_some_and(|e| e == "parquet")).collect()
}

/// How many parts stand in a folder, which a study may be writing meanwhile.
fn part_count(folder: &Folder, out: &str) -> usize {
    let Ok(entries) = std::fs::read_dir(folder.path().join(out).join("parts")) else { return 0 };
    let names = entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
    names.filter(|name| name.starts_with("part-")).count()
}

/// A column of numbers of a table.
struct Numbers {
    name: String,
    unit: String,
    values: Vec<f64>,
}

fn numbers(folder: &Folder, file: &str) -> Vec<Numbers> {
    let columns = read_columns(&folder.path().join(file)).unwrap().into_iter();
    let of =
        |Column { name, unit, cells }| Some(Numbers { name, unit, values: cells.to_numbers()? });
    columns.filter_map(of).collect()
}

/// The row of a run in the merged table, by column; NaN where there is none.
fn row(folder: &Folder, file: &str, run: u64) -> BTreeMap<String, f64> {
    let value = |column: Numbers| (column.name, column.values[run as usize]);
    numbers(folder, file).into_iter().map(value).collect()
}

#[test]
fn whole_study_has_every_run_in_order() {
    let folder = folder("study-whole");
    let table = folder.stdout(&["study", "plan.toml", "--out", "out"]);
    assert!(table.contains("Peak sliding displacement (m)"), "{table}");
    assert!(table.contains("0.2 g") && table.contains("a.csv"), "{table}");
    assert_eq!(folder.names("out"), WRITTEN);
    folder.stdout(&["study", "merge", "out", "--out", "all.parquet"]);
    let columns = numbers(&folder, "all.parquet");
    let of = |name: &str| &columns.iter().find(|column| column.name == name).unwrap().values;
    assert!(of("run").iter().enumerate().all(|(index, run)| *run == index as f64));
    // Levels in order, the samples fastest, the same samples for every record and level.
    let level = |run: usize| (of("level")[run] / 9.80665 * 10.0).round() / 10.0;
    assert_eq!(
        [level(0), level(249), level(250), level(500), level(750)],
        [0.2, 0.2, 0.3, 0.5, 0.2]
    );
    let radius = of("slider.radius");
    assert!(radius.iter().enumerate().all(|(run, value)| *value == radius[run % 250]));
    let unit = |name: &str| columns.iter().find(|column| column.name == name).unwrap().unit.clone();
    assert_eq!([unit("slider.radius"), unit("level"), unit("slip_count")], ["m", "m/s2", ""]);
    // Texts come back too.
    let all = read_columns(&folder.path().join("all.parquet")).unwrap();
    let names: Vec<&str> = all.iter().map(|column| column.name.as_str()).collect();
    assert_eq!(names[..5], ["run", "record", "channel", "level", "scale"]);
    assert_eq!(names[names.len() - 2..], ["warnings", "status"]);
    let Cells::Texts(records) = &all[1].cells else { panic!("names of records") };
    assert_eq!([&records[0], &records[749]], ["records/a.csv"; 2]);
    assert_eq!([&records[750], &records[1499]], ["records/b.csv"; 2]);
    let ok = Column::texts("status", vec!["ok".to_owned(); 1500]);
    assert_eq!(all[names.len() - 1], ok);
    // PGA of the motion as it was run is the level.
    let pga = of("pga_m_per_s2");
    assert!(pga.iter().zip(of("level")).all(|(pga, level)| (pga - level).abs() < 1e-12));
    // One of every thousand of all, wherever the parts are cut.
    let manifest: serde_json::Value =
        serde_json::from_str(&folder.read("out/manifest.json")).unwrap();
    // And the first of each kind of run in every part: here of one kind.
    assert_eq!(manifest["checks"]["rows"], 5);
    let worst = &manifest["checks"]["worst"];
    assert!(worst["run"].as_str().unwrap().starts_with("run "), "{worst}");
    assert!(worst["error"].as_f64().unwrap() < 1e-10, "{worst}");
    assert_eq!(manifest["rows"], 1500);
    assert_eq!(manifest["complete"], true);
    assert_eq!(manifest["seed"], 1);
    assert_eq!(manifest["plan"], PLAN);
    assert_eq!(manifest["inputs"].as_array().unwrap().len(), 4);
    assert!(manifest["checks"]["equilibrium_residual"].as_f64().unwrap() < 1e-10);
}

/// Of a plan of two rows of two kinds both are certified; the worst is named beside the count, on the page and in
/// the manifest, also when the study is gone on with.
#[test]
fn a_row_of_each_kind_is_certified() {
    let folder = folder("study-kinds");
    let plan = "name = \"Two\"\nmodel = \"model.toml\"\n[vary]\n\
                \"slider.tilt\" = { values = [\"0 rad\", \"0.005 rad\"] }\n\
                [sampling]\nmethod = \"grid\"\n";
    folder.write("plan.toml", plan);
    for again in [&["--report"][..], &["--resume"]] {
        let output = folder.output(&[&["study", "plan.toml", "--out", "out"], again].concat());
        assert!(output.status.success(), "{}", text(&output.stderr));
        let said = text(&output.stderr);
        assert!(said.contains("2 of 2 runs certified; worst: run "), "{said}");
    }
    let page = folder.read("out/report.html");
    assert!(page.contains("Certificates: 2 of 2 runs certified; worst: run "), "{page}");
    let manifest: serde_json::Value =
        serde_json::from_str(&folder.read("out/manifest.json")).unwrap();
    assert_eq!(manifest["checks"]["rows"], 2);
    assert!(manifest["checks"]["worst"]["what"].is_string(), "{manifest}");
}

/// Mean, quantiles and maximum as one would compute them from the sorted column.
#[test]
fn summary_is_that_of_the_sorted_values() {
    let folder = folder("study-summary");
    folder.stdout(&["study", "plan.toml", "--out", "out", "-q"]);
    folder.stdout(&["study", "merge", "out", "--out", "all.parquet"]);
    let columns = numbers(&folder, "all.parquet");
    let summary = folder.read("out/summary.csv");
    let mut lines = 0;
    for line in summary.lines().skip(1) {
        let cells: Vec<&str> = line.split(',').collect();
        let number = |i: usize| cells[i].parse::<f64>().unwrap_or(f64::NAN);
        let column = columns.iter().find(|column| column.name == cells[2]).unwrap();
        let level = columns.iter().find(|column| column.name == "level").unwrap();
        let of_level = |(run, value): (usize, &f64)| {
            (level.values[run] == number(0) && !value.is_nan()).then_some((run, *value))
        };
        let mut values: Vec<(usize, f64)> =
            column.values.iter().enumerate().filter_map(of_level).collect();
        if cells[2].starts_with("residual_") {
            // What is left has either sign: its figures are those of its size.
            values.iter_mut().for_each(|(_, value)| *value = value.abs());
        }
        assert_eq!([number(4), number(5)], [500.0, 0.0]);
        if values.is_empty() {
            assert_eq!(cells[6], "");
            continue;
        }
        let largest = values.iter().fold(0.0, |l: f64, (_, v)| l.max(v.abs()));
        let first = values.iter().find(|(_, v)| v.abs() == largest).unwrap();
        assert_eq!((number(10), number(12)), (first.1, first.0 as f64), "{line}");
        assert_eq!(cells[11], if first.0 < 750 { "records/a.csv" } else { "records/b.csv" });
        let mean = values.iter().map(|(_, v)| v).sum::<f64>() / values.len() as f64;
        assert!((number(6) - mean).abs() <= 1e-12 * largest, "{line}");
        values.sort_by(|a, b| a.1.total_cmp(&b.1));
        for (cell, p) in [(7, 0.5), (8, 0.16), (9, 0.84)] {
            let place = p * (values.len() - 1) as f64;
            let [low, high] = [place.floor(), place.ceil()].map(|i| values[i as usize].1);
            let expected = low + (high - low) * (place - place.floor());
            assert_eq!(number(cell), expected, "{line}");
        }
        lines += 1;
    }
    assert!(lines > 60, "{lines}");
}

#[test]
fn shards_and_threads_give_the_same_bytes() {
    let folder = folder("study-shards");
    folder.stdout(&["study", "plan.toml", "--out", "one", "--jobs", "1"]);
    folder.stdout(&["study", "plan.toml", "--out", "many", "--jobs", "3"]);
    assert_eq!(parts(&folder, "one"), parts(&folder, "many"));
    for file in ["manifest.json", "summary.csv"] {
        assert_eq!(folder.read(&format!("one/{file}")), folder.read(&format!("many/{file}")));
    }
    let shards = ["1/4", "2/4", "3/4", "4/4"];
    for (index, shard) in shards.iter().enumerate() {
        let out = format!("shard{index}");
        folder.stdout(&["study", "plan.toml", "--out", &out, "--shard", shard]);
    }
    folder.stdout(&["study", "merge", "one", "--out", "one.parquet"]);
    let merge = ["study", "merge", "shard3", "shard0", "shard1", "shard2", "--out", "four.parquet"];
    folder.stdout(&merge);
    let bytes = |name: &str| std::fs::read(folder.path().join(name)).unwrap();
    assert_eq!(bytes("one.parquet"), bytes("four.parquet"));
    let refused = folder.refused(&["study", "merge", "shard1", "shard2", "--out", "two.parquet"]);
    let expected = "expected the runs 0 to 1499, found none from 1000 on in shard1, shard2";
    assert!(refused.contains(expected), "{refused}");
}

/// Killed at some moment the study loses what was in work, no more, and leaves nothing half-written
/// under a part's name.
#[test]
fn killed_study_is_resumed_to_the_same_bytes() {
    let folder = folder("study-killed");
    let many = PLAN.replace("count = 250", "count = 2500");
    folder.write("plan.toml", many);
    folder.stdout(&["study", "plan.toml", "--out", "whole", "-q"]);
    let whole = parts(&folder, "whole");
    assert_eq!(whole.len(), 30);
    for wanted in [1, 7] {
        let out = format!("killed{wanted}");
        let mut child = start(&mut folder.command(&["study", "plan.toml", "--out", &out]));
        let begun = Instant::now();
        while part_count(&folder, &out) < wanted {
            assert!(begun.elapsed() < Duration::from_secs(60), "no part after a minute");
            std::thread::sleep(Duration::from_millis(1));
        }
        child.kill().unwrap();
        child.wait().unwrap();
        let left = parts(&folder, &out);
        // What was half-written stands elsewhere: readers take the folder as it is.
        assert_eq!(folder.names(&format!("{out}/parts")).len(), left.len());
        assert!(left.iter().all(|(name, bytes)| whole[name] == *bytes));
        if left.len() < whole.len() {
            let refused = folder.output(&["study", "plan.toml", "--out", &out]);
            assert_eq!(refused.status.code(), Some(2));
            assert!(text(&refused.stderr).contains("--resume"), "{}", text(&refused.stderr));
        }
        folder.stdout(&["study", "plan.toml", "--out", &out, "--resume"]);
        assert_eq!(parts(&folder, &out), whole);
        for file in ["manifest.json", "summary.csv"] {
            assert_eq!(
                folder.read(&format!("whole/{file}")),
                folder.read(&format!("{out}/{file}"))
            );
        }
        let names = folder.names(&out);
        assert!(names.iter().all(|name| !name.starts_with('.')), "{names:?}");
    }
}

/// Ctrl-C says what is done and how to go on; the line that it prints does so.
#[cfg(unix)]
#[test]
fn interrupted_study_says_how_to_go_on() {
    let folder = folder("study-interrupted");
    folder.write("plan.toml", PLAN.replace("count = 250", "count = 25000"));
    let arguments = ["study", "plan.toml", "--out", "o u t", "--force", "-q"];
    let child = start(&mut folder.command(&arguments));
    let begun = Instant::now();
    while part_count(&folder, "o u t") < 2 {
        assert!(begun.elapsed() < Duration::from_secs(60), "no part after a minute");
        std::thread::sleep(Duration::from_millis(1));
    }
    let mut kill = std::process::Command::new("kill");
    start(kill.args(["-INT", &child.id().to_string()])).wait().unwrap();
    let output = child.wait_with_output().unwrap();
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(130), "{said}");
    let done = part_count(&folder, "o u t") * 1172;
    let (head, line) = said.trim_end().split_once("\n  ").unwrap();
    let digits: String = head.chars().filter(char::is_ascii_digit).collect();
    assert_eq!(digits, format!("{done}150000"), "{said}");
    assert!(head.ends_with("runs are done and kept in o u t; go on with"), "{said}");
    assert_eq!(line, "slipstick study plan.toml --out 'o u t' -q --resume");
}

/// What a disk or a hand did to a part is found, said and run again, to the same bytes.
#[test]
fn damaged_parts_are_run_again() {
    let folder = folder("study-damaged");
    folder.stdout(&["study", "plan.toml", "--out", "out", "-q"]);
    let (whole, summary) = (parts(&folder, "out"), folder.read("out/summary.csv"));
    let manifest = folder.read("out/manifest.json");
    let damaged = "out/parts/part-00001.parquet";
    let bytes = whole.get(&PathBuf::from("part-00001.parquet")).unwrap();
    let length = bytes.len();
    // A bit of the data, of the notes at the end, of the hash among them; a file cut off, one that
    // is none, another part in its place.
    let mut cases: Vec<Vec<u8>> =
        (0..12).map(|k| flipped(bytes, (2 * k + 1) * length / 24)).collect();
    cases.push(flipped(bytes, length - 20));
    let key = bytes.windows(16).rposition(|window| window == b"slipstick.sha256").unwrap();
    cases.push(flipped(bytes, key + 20));
    cases.extend([bytes[..length / 2].to_vec(), Vec::new(), b"PAR1 no more".to_vec()]);
    let other = whole.get(&PathBuf::from("part-00000.parquet")).unwrap().clone();
    for (case, bytes) in cases.iter().chain([&other]).enumerate() {
        folder.write(damaged, bytes);
        let refused = folder.refused(&["study", "merge", "out", "--out", "all.parquet"]);
        let reason = match case == cases.len() {
            false => "damaged: its bytes are not those that were written",
            true => "holds the runs 0 to 499, where 500 to 999 belong",
        };
        let mend = "run the study again with --resume, which replaces it";
        assert_eq!(refused, format!("{damaged}: {reason}: {mend}"), "{case}");
        let output = folder.output(&["study", "plan.toml", "--out", "out", "--resume"]);
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
        let said = format!("warning: {damaged}: {reason}; its runs are run again\n");
        assert!(text(&output.stderr).contains(&said), "{case}: {}", text(&output.stderr));
        assert_eq!(parts(&folder, "out"), whole, "{case}");
        assert_eq!(folder.read("out/summary.csv"), summary, "{case}");
        assert_eq!(folder.read("out/manifest.json"), manifest, "{case}");
    }
}

/// A file that no part of the study is called is counted nowhere.
#[test]
fn stray_parts_are_left_out() {
    let folder = folder("study-stray");
    folder.stdout(&["study", "plan.toml", "--out", "out", "-q"]);
    let summary = folder.read("out/summary.csv");
    let part = std::fs::read(folder.path().join("out/parts/part-00001.parquet")).unwrap();
    for name in ["out/parts/part-00003.parquet", "out/parts/part-1.parquet"] {
        folder.write(name, &part);
        let refused = folder.refused(&["study", "merge", "out", "--out", "all.parquet"]);
        assert_eq!(refused, format!("{name}: the study has no such part: remove it"));
        let output = folder.output(&["study", "plan.toml", "--out", "out", "--resume"]);
        let said =
            format!("warning: {name}: the study has no such part; left out of the summary\n");
        assert!(text(&output.stderr).contains(&said), "{}", text(&output.stderr));
        assert_eq!(folder.read("out/summary.csv"), summary);
        std::fs::remove_file(folder.path().join(name)).unwrap();
    }
}

/// The manifest says which bytes each part has, as `sha256sum` does.
#[test]
fn manifest_has_the_hash_of_every_part() {
    let folder = folder("study-hashes");
    folder.stdout(&["study", "plan.toml", "--out", "out", "-q"]);
    let manifest: serde_json::Value =
        serde_json::from_str(&folder.read("out/manifest.json")).unwrap();
    let listed = manifest["parts"].as_array().unwrap();
    assert_eq!(listed.len(), 3);
    for (index, part) in listed.iter().enumerate() {
        assert_eq!(part["path"], format!("parts/part-{index:05}.parquet"));
        let path = folder.path().join("out").join(part["path"].as_str().unwrap());
        let hash = slipstick::hash::sha256_hex(&std::fs::read(path).unwrap());
        assert_eq!(part["sha256"], hash.as_str());
        assert_eq!((&part["first_run"], &part["rows"]), (&(500 * index).into(), &500.into()));
    }
}

/// Some bytes with one bit changed.
fn flipped(bytes: &[u8], at: usize) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    bytes[at] ^= 4;
    bytes
}

/// The printed line gives the row's demands, to the last bit.
#[test]
fn repeat_reproduces_rows() {
    let folder = folder("study-repeat");
    // A file name that a shell would take apart.
    folder.write("records/c d's.csv", RECORD.replace("5", "4"));
    folder.stdout(&["study", "plan.toml", "--out", "out", "-q"]);
    folder.stdout(&["study", "merge", "out", "--out", "all.parquet"]);
    for run in [0, 333, 1499, 2249] {
        let line = folder.stdout(&["study", "plan.toml", "--repeat", &run.to_string()]);
        let words = words(line.trim());
        assert_eq!(words[..2], ["slipstick", "run"]);
        let arguments: Vec<&str> = words[2..].iter().map(String::as_str).collect();
        let result = folder.json(&arguments);
        let row = row(&folder, "all.parquet", run);
        compare(&result, &row);
        assert!(result["record"]["pgv_m_per_s"].as_f64().unwrap() > 0.0);
    }
    let refused = folder.refused(&["study", "plan.toml", "--repeat", "2250"]);
    assert!(refused.contains("expected a run from 0 to 2249, found 2250"), "{refused}");
}

/// Every demand of a summary that a row has is equal to it.
fn compare(result: &serde_json::Value, row: &BTreeMap<String, f64>) {
    let mut compared = 0;
    for (name, value) in row {
        let axis = ["x", "y"].iter().find(|axis| name.starts_with(&format!("{axis}.")));
        let of = axis.map_or(result, |axis| &result[axis]);
        let name = axis.map_or(name.as_str(), |_| &name[2..]);
        let found = match name.strip_prefix("storey1_") {
            Some(name) => &of["storeys"][0][name],
            None => name.split('.').fold(of, |found, key| &found[key]),
        };
        let found = match found {
            serde_json::Value::Bool(flag) => f64::from(u8::from(*flag)),
            serde_json::Value::Number(number) => number.as_f64().unwrap(),
            _ => continue,
        };
        assert!(found == *value, "{name}: run {found:?}, row {value:?}");
        compared += 1;
    }
    assert!(compared > 20, "{compared}");
}

/// What a shell makes of a line with single quotes.
fn words(line: &str) -> Vec<String> {
    let (mut words, mut word, mut quoted) = (Vec::new(), String::new(), false);
    let mut characters = line.chars();
    while let Some(c) = characters.next() {
        match c {
            '\'' => quoted = !quoted,
            '\\' if !quoted => word.extend(characters.next()),
            ' ' if !quoted => words.push(std::mem::take(&mut word)),
            c => word.push(c),
        }
    }
    words.push(word);
    words
}

#[test]
fn vertical_motions_go_with_their_records() {
    let folder = folder("study-vertical");
    folder.write("up/a.csv", RECORD.replace("5", "2"));
    folder.write("up/b.csv", RECORD.replace("5", "1"));
    let vertical = "files = [\"records/*.csv\"]\nvertical = \"up/*.csv\"\nvertical_scale = 0.5";
    folder.write("plan.toml", PLAN.replace("files = [\"records/*.csv\"]", vertical));
    folder.stdout(&["study", "plan.toml", "--out", "out", "-q"]);
    folder.stdout(&["study", "merge", "out", "--out", "all.parquet"]);
    for run in [77, 1400] {
        let line = folder.stdout(&["study", "plan.toml", "--repeat", &run.to_string()]);
        assert!(line.contains("motion.vertical="), "{line}");
        let words = words(line.trim());
        let arguments: Vec<&str> = words[2..].iter().map(String::as_str).collect();
        compare(&folder.json(&arguments), &row(&folder, "all.parquet", run));
    }
    folder.write("up/c.csv", RECORD);
    let refused = folder.refused(&["study", "plan.toml", "--out", "other"]);
    let expected = "records.vertical: expected one vertical motion for each of 2 files, found 3";
    assert!(refused.contains(expected), "{refused}");
}

/// A frequency response curve is a study of the model's own made motion.
#[test]
fn made_motions_may_be_varied() {
    let folder = folder("study-made");
    let plan = "model = \"model.toml\"\n[vary]\n\
                \"motion.sine.amplitude\" = { values = [\"2 m/s2\", \"4 m/s2\"] }\n\
                \"motion.sine.frequency\" = { linspace = [\"0.5 Hz\", \"3 Hz\", 30] }\n\
                \"analysis.tail\" = { values = [\"0 s\", \"1 s\"] }\n\
                [sampling]\nmethod = \"grid\"\n";
    folder.write("plan.toml", plan);
    folder.stdout(&["study", "plan.toml", "--out", "out", "-q"]);
    folder.stdout(&["study", "merge", "out", "--out", "all.parquet"]);
    for run in [0, 1, 61, 119] {
        let line = folder.stdout(&["study", "plan.toml", "--repeat", &run.to_string()]);
        let words = words(line.trim());
        let arguments: Vec<&str> = words[2..].iter().map(String::as_str).collect();
        let row = row(&folder, "all.parquet", run);
        compare(&folder.json(&arguments), &row);
        assert!((row["pga_m_per_s2"] - row["motion.sine.amplitude"]).abs() < 0.2);
        assert!(row["level"].is_nan() && row["scale"] == 1.0);
    }
    let row = row(&folder, "all.parquet", 61);
    assert_eq!((row["motion.sine.amplitude"], row["motion.sine.frequency"]), (4.0, 0.5));
    assert_eq!(row["analysis.tail"], 1.0);
}

/// A model's own record is a study's record too.
#[test]
fn own_record_of_the_model() {
    let folder = folder("study-own-record");
    let motion = "[motion]\nrecord = \"records/a.csv\"\nscale_to = \"0.4 g\"\n";
    let model = MODEL.split("[motion]").next().unwrap().to_owned() + motion;
    folder.write("model.toml", model);
    let start = PLAN.find("[records]").unwrap();
    let end = PLAN.find("[vary]").unwrap();
    folder.write("plan.toml", PLAN.replace(&PLAN[start..end], ""));
    folder.stdout(&["study", "plan.toml", "--out", "out", "-q"]);
    folder.stdout(&["study", "merge", "out", "--out", "all.parquet"]);
    let line = folder.stdout(&["study", "plan.toml", "--repeat", "42"]);
    assert!(!line.contains("--motion"), "{line}");
    let words = words(line.trim());
    let arguments: Vec<&str> = words[2..].iter().map(String::as_str).collect();
    compare(&folder.json(&arguments), &row(&folder, "all.parquet", 42));
}

/// Runs whose sample makes no model are rows, counted and told, and the study goes on.
#[test]
fn failing_runs_are_rows() {
    let folder = folder("study-failing");
    folder.write("plan.toml", PLAN.replace("[0.02, 0.15]", "[0.1, 0.3]"));
    let output = folder.output(&["study", "plan.toml", "--out", "out"]);
    assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
    let table = text(&output.stdout);
    assert!(
        table.ends_with("750 runs failed and are left out: see the column status\n"),
        "{table}"
    );
    assert!(text(&output.stderr).contains("1500 runs, 750 failed"), "{}", text(&output.stderr));
    folder.stdout(&["study", "merge", "out", "--out", "all.parquet"]);
    let columns = numbers(&folder, "all.parquet");
    let of = |name: &str| &columns.iter().find(|column| column.name == name).unwrap().values;
    let peaks = of("peak_sliding_displacement_m").iter().zip(of("slider.kinetic_friction"));
    assert!(peaks.clone().all(|(peak, friction)| peak.is_nan() == (*friction > 0.2)));
}

#[test]
fn folders_with_files_need_a_word() {
    let folder = folder("study-nonempty");
    folder.write("out/mine.txt", "mine");
    let refused = folder.refused(&["study", "plan.toml", "--out", "out"]);
    let expected = "out: expected an empty folder, found files: go on with --resume, or start anew";
    assert!(refused.contains(expected), "{refused}");
    folder.stdout(&["study", "plan.toml", "--out", "out", "--resume", "-q"]);
    let first = parts(&folder, "out");
    // Another seed is another study.
    folder.write("plan.toml", PLAN.replace("seed = 1", "seed = 2"));
    let refused = folder.refused(&["study", "plan.toml", "--out", "out", "--resume"]);
    assert!(
        refused.contains("out/parts/part-00000.parquet: belongs to another study"),
        "{refused}"
    );
    folder.stdout(&["study", "plan.toml", "--out", "out", "--force", "-q"]);
    let second = parts(&folder, "out");
    assert_eq!(first.len(), second.len());
    assert!(first.iter().all(|(name, bytes)| second[name] != *bytes));
    assert_eq!(folder.read("out/mine.txt"), "mine");
    folder.write("file", "");
    let refused = folder.refused(&["study", "plan.toml", "--out", "file"]);
    assert!(refused.contains("file: expected a folder to write to, found a file"), "{refused}");
}

/// What a killed study left half-written in an otherwise empty folder is no study.
#[test]
fn leftovers_alone_need_no_word() {
    let folder = folder("study-leftover");
    folder.write("out/.part-00001.parquet.4711-0.tmp", "half");
    std::fs::create_dir(folder.path().join("out/parts")).unwrap();
    folder.stdout(&["study", "plan.toml", "--out", "out", "-q"]);
    assert_eq!(folder.names("out"), WRITTEN);
    assert_eq!(parts(&folder, "out").len(), 3);
    folder.write("other/parts/mine.txt", "mine");
    let refused = folder.refused(&["study", "plan.toml", "--out", "other"]);
    assert!(refused.contains("other: expected an empty folder, found files"), "{refused}");
    folder.write("third/parts", "mine");
    let refused = folder.refused(&["study", "plan.toml", "--out", "third", "--resume"]);
    let expected = "third/parts: expected a folder to write to, found a file";
    assert!(refused.contains(expected), "{refused}");
}

/// What a killed study left half-written of its other files goes, and nothing else.
#[test]
fn leftovers_of_other_files_are_removed() {
    let folder = folder("study-leftover-files");
    folder.stdout(&["study", "plan.toml", "--out", "out", "-q"]);
    for file in ["manifest.json", "summary.csv", "report.html", "mine.csv"] {
        folder.write(&format!("out/.{file}.4711-0.tmp"), "half");
    }
    folder.stdout(&["study", "plan.toml", "--out", "out", "-q", "--shard", "1/1", "--resume"]);
    let mut left = vec![".mine.csv.4711-0.tmp"];
    left.extend(WRITTEN);
    assert_eq!(folder.names("out"), left);
}

/// What steers a terminal in the name of a record is shown and not done, and the line that repeats a run
/// runs it.
#[cfg(unix)]
#[test]
fn hidden_characters_of_records_are_made_visible() {
    let folder = folder("study-hidden");
    let name = "records/c\u{1b}[2J'\u{202e}d.csv";
    folder.write(name, RECORD);
    let hidden = |text: &str| text.contains(['\u{1b}', '\u{202e}']);
    let output = folder.output(&["study", "plan.toml", "--out", "out", "--report"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    for told in [text(&output.stdout), text(&output.stderr)] {
        assert!(!hidden(&told), "{told:?}");
    }
    let line = folder.stdout(&["study", "plan.toml", "--repeat", "2249"]);
    assert!(!hidden(&line) && line.contains(r"$'records/c\x1b[2J\'\xe2\x80\xaed.csv'"), "{line}");
    let quoted = line.trim_end().replacen("slipstick", env!("CARGO_BIN_EXE_slipstick"), 1);
    let mut shell = std::process::Command::new("bash");
    let ran = shell.args(["-c", &quoted]).current_dir(folder.path()).output().unwrap();
    assert_eq!(ran.status.code(), Some(0), "{}", text(&ran.stderr));
    assert!(!hidden(&text(&ran.stdout)), "{}", text(&ran.stdout));
}

/// Parts beside the manifest are not run a second time: they are merged as they stand, and
/// `--resume` says where they belong.
#[test]
fn studies_of_the_old_layout_are_known() {
    let folder = folder("study-old-layout");
    folder.stdout(&["study", "plan.toml", "--out", "out", "-q"]);
    let whole = parts(&folder, "out");
    let bytes = |name: &str| std::fs::read(folder.path().join(name)).unwrap();
    folder.stdout(&["study", "merge", "out", "--out", "new.parquet"]);
    folder.stdout(&["study", "merge", "out/parts", "--out", "inner.parquet"]);
    assert_eq!(bytes("new.parquet"), bytes("inner.parquet"));
    folder.parts_to_old_layout("out");
    folder.stdout(&["study", "merge", "out", "--out", "old.parquet"]);
    assert_eq!(bytes("new.parquet"), bytes("old.parquet"));
    let before = folder.contents();
    let refused = folder.refused(&["study", "plan.toml", "--out", "out", "--resume"]);
    let expected = "out: expected the parts of the study in out/parts, found some beside it, as an \
                    earlier version wrote them: move part-*.parquet there, or start anew with --force";
    assert_eq!(refused, expected);
    assert_eq!(folder.contents(), before);
    // The mends: moved they are those of the study; --force leaves none behind.
    for name in whole.keys() {
        let (from, to) = (folder.path().join("out"), folder.path().join("out/parts"));
        std::fs::create_dir_all(&to).unwrap();
        std::fs::rename(from.join(name), to.join(name)).unwrap();
    }
    let output = folder.output(&["study", "plan.toml", "--out", "out", "--resume"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert_eq!(parts(&folder, "out"), whole);
    folder.parts_to_old_layout("out");
    folder.stdout(&["study", "plan.toml", "--out", "out", "--force", "-q"]);
    assert_eq!(folder.names("out"), WRITTEN);
    assert_eq!(parts(&folder, "out"), whole);
}

#[test]
fn refused_plans_say_why() {
    let folder = folder("study-refused");
    let refuse = |text: &str| {
        folder.write("plan.toml", text);
        folder.refused(&["study", "plan.toml", "--out", "out"])
    };
    let missing =
        refuse(&PLAN.replace("[\"records/*.csv\"]", "[\"records/*.csv\", \"x.AT2\", \"y/*.txt\"]"));
    let expected = "plan.toml:5:9: records.files: expected files beside the plan; 2 of 3 are \
                    missing, found no \"x.AT2\", \"y/*.txt\"";
    assert!(missing.contains(expected), "{missing}");
    let model = refuse(&PLAN.replace("model.toml", "none.toml"));
    assert!(
        model.contains("plan.toml:2:9: model: expected a model file that can be read"),
        "{model}"
    );
    let storey = refuse(&PLAN.replace("slider.radius", "storey.2.height"));
    assert!(
        storey.contains(
            "plan.toml:11:21: vary.storey.2.height: expected storey.1, for there is only one, found \"2\""
        ),
        "{storey}"
    );
    let zero = "time_s,acceleration_m_per_s2\n0,0\n1,0\n";
    folder.write("records/a.csv", zero);
    let flat = refuse(PLAN);
    assert!(
        flat.contains("expected records that can be scaled to PGA, found PGA = 0 of records/a.csv"),
        "{flat}"
    );
    let many = refuse(&PLAN.replace("count = 250", "count = 100000000"));
    assert!(many.contains("expected at most 100000000 runs"), "{many}");
    folder.write("plan.toml", PLAN);
    for shard in ["0/4", "5/4", "4", "a/b"] {
        let refused = folder.refused(&["study", "plan.toml", "--out", "out", "--shard", shard]);
        assert!(refused.contains("expected i/n with i from 1 to n"), "{refused}");
    }
    let refused = folder.refused(&["study", "merge", "records", "--out", "all.parquet"]);
    assert!(refused.contains("records: expected a Parquet file: it holds no parts"), "{refused}");
    folder.write("model.toml", format!("{MODEL}\n[analysis]\nmethod = \"stepwise\"\n"));
    folder.write("records/a.csv", RECORD);
    let refused = folder.refused(&["study", "plan.toml", "--out", "out"]);
    assert!(
        refused.contains("expected the exact method, which is the only one of studies"),
        "{refused}"
    );
}

#[test]
fn dry_run_counts_and_writes_nothing() {
    let folder = folder("study-dry");
    let before = folder.contents();
    let text = folder.stdout(&["study", "plan.toml", "--dry-run"]);
    assert!(text.contains("records  2\nlevels   3\nsamples  250\nruns     1500\n"), "{text}");
    assert!(text.contains("\ntime     about "), "{text}");
    let text = folder.stdout(&["study", "plan.toml", "--dry-run", "--shard", "1/3"]);
    assert!(text.contains("runs     1500\nof shard 500\n"), "{text}");
    assert_eq!(folder.contents(), before);
}

#[test]
fn schema_of_plans_is_json() {
    let folder = Folder::new("study-schema");
    let schema: serde_json::Value =
        serde_json::from_str(&folder.stdout(&["schema", "--plan"])).unwrap();
    assert_eq!(schema["title"], "Slipstick study plan");
    assert!(
        schema["properties"]["vary"]["additionalProperties"]["properties"]["factor_of"].is_object()
    );
}

/// A level named twice would count its runs twice; a record named twice is used once, and that is said.
#[test]
fn what_is_named_twice_is_said() {
    let folder = folder("named-twice");
    folder.write("twice.toml", PLAN.replace("\"0.5 g\"]", "\"0.2 g\"]"));
    let found = folder.refused(&["study", "twice.toml", "--out", "out"]);
    assert!(found.contains("expected a level that is not named before, found"), "{found}");
    folder.write(
        "factors.toml",
        PLAN.replace("measure = \"PGA\"\n", "")
            .replace("levels = [\"0.2 g\", \"0.3 g\", \"0.5 g\"]", "scale = [1.0, 2.0, 1.0]"),
    );
    let found = folder.refused(&["study", "factors.toml", "--out", "out"]);
    assert!(found.contains("expected factors that differ, found 1 twice"), "{found}");
    folder.write(
        "files.toml",
        PLAN.replace("[\"records/*.csv\"]", "[\"records/b.csv\", \"records\"]"),
    );
    let output = folder.output(&["study", "files.toml", "--dry-run"]);
    let said = text(&output.stderr);
    assert!(said.contains("b.csv is named more than once: it is used once"), "{said}");
    assert!(text(&output.stdout).contains("records  2\n"), "{}", text(&output.stdout));
    let output = folder.output(&[
        "ida",
        "model.toml",
        "--records",
        "records/b.csv",
        "records",
        "--scale-to",
        "1, 2 m/s2",
    ]);
    let said = text(&output.stdout);
    assert!(said.contains("record_named_twice: records/b.csv is named more than once"), "{said}");
}

/// A study warns of what `run` warns of, on the same model and motion.
#[test]
fn a_study_warns_as_run_does() {
    let folder = folder("study-warns");
    let tilted = MODEL.replace("gap = \"100 mm\"", "tilt = \"0.4 rad\"");
    folder.write("model.toml", &tilted);
    folder.write("up/a.csv", RECORD);
    let plan = "model = \"model.toml\"\n[records]\nfiles = [\"records/a.csv\"]\nvertical = [\"up/a.csv\"]\n";
    folder.write("plan.toml", plan);
    folder.stdout(&["study", "plan.toml", "--out", "out", "-q"]);
    let columns = read_columns(&folder.path().join("out/parts/part-00000.parquet")).unwrap();
    let of_study = columns.iter().find(|column| column.name == "warnings").unwrap();
    let Cells::Texts(of_study) = &of_study.cells else { panic!("texts") };
    let motion = "record = \"records/a.csv\"\nvertical = \"up/a.csv\"\n";
    let motion = tilted.split("[motion]").next().unwrap().to_owned() + "[motion]\n" + motion;
    folder.write("run.toml", motion);
    let of_run = folder.json(&["run.toml"]);
    let of_run: Vec<&str> = of_run["warnings"]
        .as_array()
        .unwrap()
        .iter()
        .map(|w| w["kind"].as_str().unwrap())
        .collect();
    assert!(of_run.contains(&"coarse_sampling"), "{of_run:?}");
    assert!(of_run.contains(&"slide_need_not_stop"), "{of_run:?}");
    for kind in &of_run {
        assert!(of_study[0].split(';').any(|of_study| of_study == *kind), "{kind}: {of_study:?}");
    }
}

/// Rows with lower and upper friction are those that `run` gives beside the nominal ones.
#[test]
fn bounds_of_friction_are_run() {
    let folder = folder("study-bounds");
    let bounded = "gap = \"100 mm\"\nbounds = { lower = 0.8, upper = 1.3 }";
    folder.write("model.toml", MODEL.replace("gap = \"100 mm\"", bounded));
    let plan = PLAN.replace("count = 250", "count = 20");
    folder.write("plan.toml", &plan);
    let text = folder.stdout(&["study", "plan.toml", "--dry-run"]);
    assert!(text.contains("samples  20\nfriction lower, nominal, upper\nruns     360\n"), "{text}");
    let table = folder.stdout(&["study", "plan.toml", "--out", "out", "-q"]);
    assert!(table.contains("0.2 g  upper "), "{table}");
    let part = "out/parts/part-00000.parquet";
    for (run, bound) in [(0, "lower"), (1, "nominal"), (359, "upper"), (200, "upper")] {
        let line = folder.stdout(&["study", "plan.toml", "--repeat", &run.to_string()]);
        let line = line.trim().split("  #").next().unwrap();
        let words = words(line);
        let arguments: Vec<&str> = words[2..].iter().map(String::as_str).collect();
        let result = folder.json(&arguments);
        let of_bound = if bound == "nominal" { &result } else { &result["bounds"][bound] };
        compare(of_bound, &row(&folder, part, run));
        let columns = read_columns(&folder.path().join(part)).unwrap();
        let friction = columns.iter().find(|column| column.name == "friction").unwrap();
        let Cells::Texts(friction) = &friction.cells else { panic!("texts") };
        assert_eq!(friction[run as usize], bound);
    }
    let summary = folder.read("out/summary.csv");
    assert!(summary.starts_with("level,scale,friction,demand,"), "{summary}");
    let manifest: serde_json::Value =
        serde_json::from_str(&folder.read("out/manifest.json")).unwrap();
    assert_eq!(manifest["bounds"], serde_json::json!(["lower", "nominal", "upper"]));

    // A fragility takes bounds apart, as nobody averages over them.
    let curves = ["fragility", "out", "--limit", "600 mm", "--json"];
    let of_bounds = folder.stdout(&curves);
    let of_bounds: serde_json::Value = serde_json::from_str(&of_bounds).unwrap();
    assert_eq!(of_bounds["by"], "friction");
    let names: Vec<_> =
        of_bounds["curves"].as_array().unwrap().iter().map(|c| &c["value"]).collect();
    assert_eq!(names, ["lower", "nominal", "upper"]);
    let one = folder.stdout(&[&curves[..], &["--where", "friction=upper"]].concat());
    let one: serde_json::Value = serde_json::from_str(&one).unwrap();
    assert_eq!(one["median"], of_bounds["curves"][2]["fragility"]["median"]);

    // One of them alone, and one where there are none.
    folder.write("upper.toml", format!("bounds = \"upper\"\n{plan}"));
    folder.stdout(&["study", "upper.toml", "--out", "upper", "-q"]);
    let upper = numbers(&folder, "upper/parts/part-00000.parquet");
    assert_eq!(upper[0].values.len(), 120);
    let of_all = row(&folder, part, 3 * 77 + 2);
    for column in upper.iter().filter(|column| column.name != "run") {
        let same = column.values[77].to_bits() == of_all[&column.name].to_bits();
        assert!(same, "{}", column.name);
    }
    folder.write("model.toml", MODEL);
    let refused = folder.refused(&["study", "upper.toml", "--out", "none"]);
    assert!(
        refused
            .contains("bounds: expected slider.bounds in the model, whose bounds are run, found"),
        "{refused}"
    );
}

/// With `--report` a page stands beside the parts: the answer first, figures, tables, the plan.
#[test]
fn page_of_a_study() {
    let folder = folder("study-page");
    folder.write("plan.toml", PLAN.replace("count = 250", "count = 20"));
    folder.stdout(&["study", "plan.toml", "--out", "out", "--report", "-q"]);
    let page = folder.read("out/report.html");
    let lead = "<p class=\"lead\">Peak sliding displacement at PGA = 0.5 g: median ";
    assert!(page.contains(lead), "{page}");
    assert!(page.contains("Of the gap ") && page.contains("id=\"levels\""), "{page}");
    assert!(page.contains("120 runs: 2 records × 3 levels × 20 samples"), "{page}");
    assert!(page.contains("plan.toml") && page.contains("model.toml"), "{page}");
    // One level: the distribution of its runs.
    let one = PLAN.replace(", \"0.3 g\", \"0.5 g\"]", "]");
    folder.write("plan.toml", one.replace("count = 250", "count = 20"));
    folder.stdout(&["study", "plan.toml", "--out", "out", "--report", "--force", "-q"]);
    assert!(folder.read("out/report.html").contains("id=\"distributions\""));
    folder.stdout(&["study", "plan.toml", "--out", "out", "--force", "-q"]);
    assert!(!folder.names("out").contains(&"report.html".to_owned()));
}

/// Pairs of components: one factor each, by a measure of pairs or to a spectrum of a file.
#[test]
fn pairs_of_components() {
    let folder = folder("study-pairs");
    let other = RECORD.replace("1,5", "1,2").replace("2,-5", "2,4");
    folder.write("second/a.csv", &other);
    folder.write("second/b.csv", other.replace('4', "3"));
    let plan = |keys: &str| {
        format!(
            "model = \"model.toml\"\n[records]\nfiles = [\"records/*.csv\"]\n\
             second = [\"second/*.csv\"]\npairs = \"separate\"\n{keys}\n"
        )
    };
    folder.write("plan.toml", plan("measure = \"RotD50(1.2 s)\"\nlevels = [\"0.3 g\"]"));
    let table = folder.stdout(&["study", "plan.toml", "--out", "out", "-q"]);
    assert!(table.contains("RotD50(1.2 s)"), "{table}");
    let part = "out/parts/part-00000.parquet";
    let columns = read_columns(&folder.path().join(part)).unwrap();
    let texts = |name: &str| match &columns.iter().find(|c| c.name == name).unwrap().cells {
        Cells::Texts(texts) => texts.clone(),
        _ => panic!("{name} holds no texts"),
    };
    assert_eq!(texts("record"), ["records/a.csv", "second/a.csv", "records/b.csv", "second/b.csv"]);
    let pairs = ["records/a.csv", "records/a.csv", "records/b.csv", "records/b.csv"];
    assert_eq!(texts("pair"), pairs);
    let scale = |run| row(&folder, part, run)["scale"];
    assert!(scale(0) == scale(1) && scale(2) == scale(3) && scale(0) != scale(2));

    folder.write("target.csv", "period_s,sa_g\n0.1,0.8\n0.5,0.8\n4,0.1\n");
    let target = "target = \"target.csv\"\nperiods = [\"0.3 s\", \"3 s\"]";
    folder.write("plan.toml", plan(target));
    folder.stdout(&["study", "plan.toml", "--out", "out", "--force", "--report", "-q"]);
    assert!(scale(0) == scale(1) && scale(2) == scale(3));
    let page = folder.read("out/report.html");
    assert!(
        page.contains("id=\"target\"") && page.contains("Factors on both components"),
        "{page}"
    );
    let manifest = folder.read("out/manifest.json");
    assert!(manifest.contains("\"target.csv\""), "{manifest}");

    for (keys, expected) in [
        (
            "target = \"no.csv\"\nperiods = [\"0.3 s\", \"3 s\"]",
            "records.target: expected a spectrum",
        ),
        ("target = \"target.csv\"", "records.periods: expected the first and last period"),
        (
            "target = \"target.csv\"\nperiods = [\"0.3 s\", \"9 s\"]",
            "records.periods: expected pairs that can be brought to the spectrum",
        ),
    ] {
        folder.write("plan.toml", plan(keys));
        let refused = folder.refused(&["study", "plan.toml", "--dry-run"]);
        assert!(refused.contains(expected), "{keys}: {refused}");
    }
    let alone = PLAN.replace("measure = \"PGA\"", "measure = \"RotD50(1 s)\"");
    folder.write("plan.toml", alone);
    let refused = folder.refused(&["study", "plan.toml", "--dry-run"]);
    assert!(refused.contains("expected the other components, second = "), "{refused}");
    folder.write("second/c.csv", &other);
    folder.write("plan.toml", plan(""));
    let refused = folder.refused(&["study", "plan.toml", "--dry-run"]);
    assert!(refused.contains("one other component for each of 2 files, found 3"), "{refused}");
}

/// Both components at once: a row a pair, with the resultants as its demands and the components beside them, to
/// the last bit those of the command that repeats it; other stiffness along y is varied.
#[test]
fn pairs_of_components_at_once() {
    let folder = folder("study-plane");
    let other = RECORD.replace("1,5", "1,2").replace("2,-5", "2,4");
    folder.write("second/a.csv", &other);
    folder.write("second/b.csv", other.replace('4', "3"));
    folder.write(
        "plan.toml",
        "model = \"model.toml\"\n[records]\nfiles = [\"records/*.csv\"]\n\
         second = [\"second/*.csv\"]\nmeasure = \"RotD100(1 s)\"\nlevels = [\"0.3 g\", \"0.5 g\"]\n\
         [vary]\n\"storey.1.period_y\" = { values = [\"0.4 s\", \"0.6 s\"] }\n[sampling]\n\
         method = \"grid\"\n",
    );
    folder.stdout(&["study", "plan.toml", "--out", "out", "--report", "-q"]);
    let part = "out/parts/part-00000.parquet";
    let columns = read_columns(&folder.path().join(part)).unwrap();
    let names: Vec<&str> = columns.iter().map(|column| &*column.name).collect();
    assert_eq!(columns[0].cells.len(), 2 * 2 * 2);
    assert!(!names.contains(&"pair"), "{names:?}");
    for run in [0, 3, 6] {
        let line = folder.stdout(&["study", "plan.toml", "--repeat", &run.to_string()]);
        let words = words(line.trim());
        let arguments: Vec<&str> = words[2..].iter().map(String::as_str).collect();
        let row = row(&folder, part, run);
        compare(&folder.json(&arguments), &row);
        let resultant = row["peak_sliding_displacement_m"];
        assert!(resultant >= row["y.peak_sliding_displacement_m"].abs());
        assert!(row["peak_sliding_displacement_m"] > 0.0);
        assert!(row["max_sliding_displacement_m"].is_nan());
        assert!(!names.contains(&"x.slip_count") && row["slip_count"] > 0.0);
    }
    assert!(folder.read("out/report.html").contains("move the table at once"));
}

/// The file that the parts of a study are merged to says of which measure its levels are: a fragility of it is that
/// of the folder.
#[test]
fn a_merged_study_keeps_its_measure() {
    let folder = folder("study-merged-measure");
    folder.write("plan.toml", PLAN.replace("count = 250", "count = 40"));
    folder.stdout(&["study", "plan.toml", "--out", "out", "-q"]);
    folder.stdout(&["study", "merge", "out", "--out", "all.parquet"]);
    // Whether a curve can be told or not, both say the same, and of a measure that is missing nothing is said.
    let told = |source: &str| {
        let output = folder.output(&["fragility", source, "--limit", "1 mm"]);
        assert!(!text(&output.stderr).contains("measure"), "{}", text(&output.stderr));
        let lines = [text(&output.stdout), text(&output.stderr)].concat();
        let lines = lines.lines().filter(|line| !line.starts_with("Model"));
        lines.map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(told("all.parquet"), told("out"));
}
