//! `slipstick run` over a suite and over several models.

use super::support::Folder;

const MODEL: &str = r#"
[block]
mass = "300 kg"
[slider]
static_friction = 0.06
kinetic_friction = 0.05
radius = "2 m"
gap = "20 mm"
bounds = { lower = 0.8, upper = 1.2 }
[[storey]]
mass = "200 kg"
frequency = "2 Hz"
damping_ratio = 0.05
"#;

/// A folder with a model, its twin without bounds, and so many records.
fn folder(test: &str, records: usize) -> Folder {
    let folder = Folder::with_model(test, MODEL);
    let plain = MODEL.replace("bounds = { lower = 0.8, upper = 1.2 }\n", "");
    folder.write("plain.toml", plain.replace("0.05\nradius", "0.04\nradius"));
    for i in 0..records {
        let sample = |k: i32| {
            let t = 0.01 * f64::from(k);
            let a = 3.0 * (6.0 * t + i as f64).sin() * (1.1 * t).sin();
            format!("{t:.2},{a:.6}\n")
        };
        let text: String = (0..600).map(sample).collect();
        folder.write(&format!("records/r{i}.csv"), format!("time_s,acceleration_m_per_s2\n{text}"));
    }
    folder
}

/// A column of a CSV by its name.
fn column(table: &str, name: &str) -> Vec<String> {
    let mut rows = table.lines().map(|line| line.split(',').map(str::to_owned).collect::<Vec<_>>());
    let at = rows.next().unwrap().iter().position(|head| head == name).unwrap();
    rows.map(|row| row[at].clone()).collect()
}

#[test]
fn exact_every_run_of_a_suite_is_that_of_a_single_analysis() {
    let folder = folder("histories-single", 3);
    let scaled = ["--records", "records/*.csv", "--scale-to", "0.35 g", "--out", "out"];
    let text = folder.stdout(&[&["run", "model.toml"], &scaled[..]].concat());
    assert!(text.contains("lower") && text.contains("Maximum"), "{text}");
    let runs = folder.read("out/runs.csv");
    let peaks = column(&runs, "peak_sliding_displacement_m");
    assert_eq!(column(&runs, "friction")[..3], ["lower", "nominal", "upper"]);
    assert!(column(&runs, "holds").iter().all(|holds| holds == "true"));
    for (i, of_record) in peaks.chunks(3).enumerate() {
        let motion = format!("records/r{i}.csv");
        let one = folder.json(&["model.toml", "--motion", &motion, "--scale-to", "0.35 g"]);
        let of = |value: &serde_json::Value| value["peak_sliding_displacement_m"].as_f64().unwrap();
        let expected = [of(&one["bounds"]["lower"]), of(&one), of(&one["bounds"]["upper"])];
        let found: Vec<f64> = of_record.iter().map(|cell| cell.parse().unwrap()).collect();
        assert_eq!(found, expected);
    }
    let largest = |friction: usize| {
        let of = peaks.iter().skip(friction).step_by(3).map(|cell| cell.parse::<f64>().unwrap());
        of.fold(0.0, f64::max)
    };
    let governing = folder.read("out/governing.csv");
    let found = column(&governing, "peak_sliding_displacement_m");
    let found: Vec<f64> = found.iter().map(|cell| cell.parse().unwrap()).collect();
    assert_eq!(found, [largest(0), largest(1), largest(2)]);
    assert_eq!(column(&governing, "statistic"), ["maximum"; 3]);
}

#[test]
fn exact_mean_governs_from_seven_records_on() {
    let folder = folder("histories-mean", 7);
    folder.stdout(&["run", "plain.toml", "--records", "records", "--out", "out"]);
    let runs = column(&folder.read("out/runs.csv"), "peak_sliding_displacement_m");
    let sum: f64 = runs.iter().map(|cell| cell.parse::<f64>().unwrap()).sum();
    let governing = folder.read("out/governing.csv");
    assert_eq!(column(&governing, "statistic"), ["mean"]);
    let found: f64 = column(&governing, "peak_sliding_displacement_m")[0].parse().unwrap();
    assert!((found - sum / 7.0).abs() < 1e-15, "{found}");
}

#[test]
fn exact_models_side_by_side_in_one_report() {
    let folder = folder("histories-models", 2);
    let text = folder.stdout(&[
        "run",
        "model.toml",
        "plain.toml",
        "--records",
        "records/*.csv",
        "--measure",
        "Sa(1 s)",
        "--scale-to",
        "0.4 g",
        "--out",
        "out",
    ]);
    assert!(text.contains("model: peak sliding displacement"), "{text}");
    assert!(text.contains("plain: peak sliding displacement"), "{text}");
    let page = folder.read("out/report.html");
    assert!(page.contains("largest peak bold") && page.contains("Share of the records"));
    assert_eq!(
        folder.names("out"),
        ["governing.csv", "histories.svg", "report.html", "runs.csv", "shares.svg", "summary.json",]
    );
}

/// Seven pairs under RotD100 and under the shape of a code: the same factors and demands as a study of
/// the same pairs, and the mean of the larger of both components governs.
#[test]
fn exact_pairs_take_one_factor_as_in_a_study() {
    let folder = folder("histories-pairs", 14);
    let (mut files, mut second) = (Vec::new(), Vec::new());
    for i in 0..7 {
        files.push(format!("records/r{}.csv", 2 * i));
        second.push(format!("records/r{}.csv", 2 * i + 1));
    }
    let pairs: Vec<&str> = ["--records"]
        .into_iter()
        .chain(files.iter().map(String::as_str))
        .chain(["--second"])
        .chain(second.iter().map(String::as_str))
        .collect();
    let level = ["--measure", "RotD100(1 s)", "--scale-to", "0.4 g"].as_slice();
    let code = ["--code-spectrum", "sds = 1 g, sd1 = 0.6 g, tl = 8 s", "--periods", "0.5 s..3 s"];
    let of_code = "code_spectrum = { sds = \"1 g\", sd1 = \"0.6 g\", tl = \"8 s\" }\n\
                   periods = [\"0.5 s\", \"3 s\"]\n";
    for (options, in_plan) in
        [(level, "measure = \"RotD100(1 s)\"\nlevels = [\"0.4 g\"]\n"), (code.as_slice(), of_code)]
    {
        let run = ["run", "plain.toml", "--out", "out"];
        let text = folder.stdout(&[&run[..], &pairs, options].concat());
        assert!(text.contains("7 pairs of components"), "{text}");
        assert!(text.contains("mean of 7 pairs"), "{text}");
        folder.write(
            "plan.toml",
            format!(
                "name = \"Pairs\"\nmodel = \"plain.toml\"\n[records]\nfiles = {files:?}\n\
                 second = {second:?}\n{in_plan}"
            ),
        );
        folder.stdout(&["study", "plan.toml", "--out", "study", "--force", "-q"]);
        let _ = std::fs::remove_file(folder.path().join("rows.parquet"));
        folder.stdout(&["study", "merge", "study", "--out", "rows.parquet"]);
        let rows = slipstick_files::read_columns(&folder.path().join("rows.parquet")).unwrap();
        let runs = folder.read("out/runs.csv");
        for name in ["scale", "peak_sliding_displacement_m"] {
            let expected = rows.iter().find(|column| column.name == name).unwrap();
            let found = column(&runs, name).into_iter().map(|cell| cell.parse::<f64>().unwrap());
            assert_eq!(Some(found.collect()), expected.cells.to_numbers(), "{name}");
        }
        assert_eq!(column(&runs, "pair")[..4], ["r0", "r0", "r2", "r2"]);
        let peaks = column(&runs, "peak_sliding_displacement_m");
        let peaks: Vec<f64> = peaks.iter().map(|cell| cell.parse().unwrap()).collect();
        let mean = peaks.chunks(2).map(|pair| pair[0].max(pair[1])).sum::<f64>() / 7.0;
        let governing = folder.read("out/governing.csv");
        let found: f64 = column(&governing, "peak_sliding_displacement_m")[0].parse().unwrap();
        assert!((found / mean - 1.0).abs() < 1e-14, "{found} {mean}");
    }
    // The last of both drew the spectra.
    let page = folder.read("out/report.html");
    assert!(page.contains("90 % of it") && page.contains("Misfit σ of ln"));
    for (options, expected) in [
        (["--scale-to", "0.4 g", "--measure", "RotD50(1 s)"].as_slice(), "the other components"),
        (&["--second", "records/r1.csv"], "--second: expected one other component for each of 7"),
    ] {
        let run = [&["run", "plain.toml", "--records"], &*strs(&files), options].concat();
        let refused = folder.refused(&run);
        assert!(refused.contains(expected), "{refused}");
    }
    let periods =
        folder.refused(&[&["run", "plain.toml"], &*pairs, &["--periods", "1 s..2 s"]].concat());
    assert!(periods.contains("--target or --code-spectrum"), "{periods}");
}

fn strs(all: &[String]) -> Vec<&str> {
    all.iter().map(String::as_str).collect()
}

#[test]
fn exact_what_a_suite_cannot_be_asked() {
    let folder = folder("histories-refused", 1);
    for (options, expected) in [
        (["--floor-spectrum"].as_slice(), "expected one model and one record"),
        (&["--method", "stepwise"], "expected exact, the only one over a suite"),
        (&["--scale-to", "fast"], "--scale-to"),
        (&["--scale", "x"], "--scale: expected a factor"),
    ] {
        let run = ["run", "model.toml", "--records", "records/*.csv"];
        let refused = folder.refused(&[&run[..], options].concat());
        assert!(refused.contains(expected), "{refused}");
    }
    let alone = ["run", "model.toml", "--motion", "records/r0.csv", "--scale-to", "0.3 g"];
    let refused = folder.refused(&[&alone[..], &["--measure", "PGV"]].concat());
    assert!(refused.contains("--measure: expected a suite"), "{refused}");
}
