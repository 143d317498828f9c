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
fn every_run_of_a_suite_is_that_of_a_single_analysis() {
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
fn mean_governs_from_seven_records_on() {
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
fn models_side_by_side_in_one_report() {
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
    let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words.contains("model: peak sliding displacement"), "{text}");
    assert!(words.contains("plain: peak sliding displacement"), "{text}");
    let page = folder.read("out/report.html");
    assert!(page.contains("bold the largest") && page.contains("Share of the records"));
    assert_eq!(
        folder.names("out"),
        ["governing.csv", "histories.svg", "report.html", "runs.csv", "shares.svg", "summary.json",]
    );
}

/// Seven pairs under RotD100 and under the shape of a code: the same factors and demands as a study of
/// the same pairs, and the mean of the larger of both components governs.
#[test]
fn pairs_take_one_factor_as_in_a_study() {
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
        .chain(["--pairs", "separate"])
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
                 second = {second:?}\npairs = \"separate\"\n{in_plan}"
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

/// Pairs at once are the runs of models with both records, bit for bit; what components say alone are runs of
/// one record; a second component of zeros leaves the run of the first.
#[test]
fn pairs_at_once_are_models_with_two_records() {
    let folder = folder("histories-at-once", 4);
    let zeros = |text: String| {
        let mut lines = text.lines().map(str::to_owned).collect::<Vec<_>>();
        for line in lines.iter_mut().filter(|line| line.starts_with(|c: char| c.is_ascii_digit())) {
            let time = line.split(',').next().unwrap_or_default();
            *line = format!("{time},0");
        }
        lines.join("\n") + "\n"
    };
    folder.write("records/zero.csv", zeros(folder.read("records/r0.csv")));
    let run =
        ["run", "plain.toml", "--scale-to", "3 m/s2", "--measure", "RotD50(PGA)", "--out", "out"];
    let pairs = [
        "--records",
        "records/r0.csv",
        "records/r2.csv",
        "--second",
        "records/r1.csv",
        "records/r3.csv",
    ];
    let text = folder.stdout(&[&run[..], &pairs].concat());
    assert!(text.contains("2 runs: 2 pairs of components in two directions"), "{text}");
    assert!(text.contains("Both at once") && text.contains("100 % + 30 %"), "{text}");
    let runs = folder.read("out/runs.csv");
    assert_eq!(column(&runs, "record"), ["r0 + r1", "r2 + r3"]);
    let number = |name: &str, row: usize| column(&runs, name)[row].parse::<f64>().unwrap();
    let peak = |motion: &str| {
        let model = folder.read("plain.toml");
        folder.write("one.toml", format!("{model}[motion]\n{motion}\n"));
        let json = folder.json(&["one.toml", "-q"]);
        json["peak_sliding_displacement_m"].as_f64().unwrap()
    };
    for row in 0..2 {
        let scale = number("scale", row);
        let [x, y] = [2 * row, 2 * row + 1].map(|i| format!("records/r{i}.csv"));
        let both = peak(&format!("record = \"{x}\"\nrecord_y = \"{y}\"\nscale = {scale:?}"));
        assert_eq!(number("peak_sliding_displacement_m", row), both);
        let alone = [x, y].map(|file| peak(&format!("record = \"{file}\"\nscale = {scale:?}")));
        assert_eq!(number("peak_sliding_displacement_x_alone_m", row), alone[0]);
        assert_eq!(number("peak_sliding_displacement_y_alone_m", row), alone[1]);
        let combined = alone[0].max(alone[1]).hypot(0.3 * alone[0].min(alone[1]));
        let found = number("peak_sliding_displacement_100_30_m", row);
        assert!((found / combined - 1.0).abs() < 1e-15, "{found} {combined}");
    }
    let along_x = ["--records", "records/r0.csv", "--second", "records/zero.csv"];
    folder.stdout(&[&["run", "plain.toml", "--out", "zero"][..], &along_x].concat());
    folder.stdout(&["run", "plain.toml", "--out", "alone", "--records", "records/r0.csv"]);
    let (zero, alone) = (folder.read("zero/runs.csv"), folder.read("alone/runs.csv"));
    let heads = alone.lines().next().unwrap().split(',').filter(|head| *head != "record");
    for head in heads {
        let (of_two, of_one) = (column(&zero, head), column(&alone, head));
        if head == "residual_sliding_displacement_m" {
            // In two directions it is a length.
            let length = |cell: &String| cell.trim_start_matches('-').to_owned();
            assert_eq!(of_two, of_one.iter().map(length).collect::<Vec<_>>());
        } else if head == "reversal_count" {
            // What passes rest in two directions turns, and is no reversal.
            assert!(of_two.iter().all(|cell| cell == "0.0"), "{of_two:?}");
        } else if head == "closest_stop" {
            // A margin of forces, which are told anew in two directions.
            let near = |(a, b): (&String, &String)| {
                let [a, b]: [f64; 2] = [a, b].map(|cell| cell.parse().unwrap());
                (a - b).abs() < 1e-12
            };
            assert!(of_two.iter().zip(&of_one).all(near), "{of_two:?} {of_one:?}");
        } else {
            assert_eq!(of_two, of_one, "{head}");
        }
    }
}

/// What two directions refuse names its key, and the option that runs the components by themselves.
#[test]
fn pairs_of_a_model_in_one_direction() {
    let folder = folder("histories-one-direction", 2);
    let model = folder.read("plain.toml").replace("[slider]\n", "[slider]\nasymmetry = 0.1\n");
    folder.write("uneven.toml", &model);
    let run = ["run", "uneven.toml", "--records", "records/r0.csv", "--second", "records/r1.csv"];
    let refused = folder.refused(&run);
    assert!(
        refused.contains("slider.asymmetry: expected a model that is solved in two"),
        "{refused}"
    );
    assert!(refused.contains("pairs = separate"), "{refused}");
    folder.stdout(&[&run[..], &["--pairs", "separate"]].concat());
    // What cannot be run in two directions says what each axis by itself leaves out.
    let contents = "\n[[contents]]\nfloor = 0\nmass = \"1 kg\"\nstatic_friction = 0.3\nkinetic_friction = 0.3\n";
    folder.write("contents.toml", folder.read("plain.toml") + contents);
    let run = ["run", "contents.toml", "--records", "records/r0.csv", "--second", "records/r1.csv"];
    assert!(folder.refused(&run).contains("contents: expected a model that is solved in two"));
    folder.stdout(&[&run[..], &["--pairs", "separate", "--out", "apart"]].concat());
    let page = folder.read("apart/report.html");
    assert!(page.contains("cannot be run in two directions"), "{page}");
    assert!(page.contains("times as far under both components at once"), "{page}");
    // What speaks of y waits for pairs, and is refused under one component.
    let wide = folder.read("plain.toml").replace("[slider]", "width_y = \"2 m\"\n[slider]");
    folder.write("wide.toml", &wide);
    let run = ["run", "wide.toml", "--records", "records/r0.csv"];
    folder.stdout(&[&run[..], &["--second", "records/r1.csv"]].concat());
    let refused = folder.refused(&run);
    assert!(refused.contains("block.width_y: expected a motion in two directions"), "{refused}");
}

fn strs(all: &[String]) -> Vec<&str> {
    all.iter().map(String::as_str).collect()
}

#[test]
fn what_a_suite_cannot_be_asked() {
    let folder = folder("histories-refused", 1);
    for (options, expected) in [
        (
            ["--method", "stepwise"].as_slice(),
            "--method: expected one model and one record beside it",
        ),
        (&["--measure", "PGV"], "--measure: expected --scale-to beside it, found \"PGV\""),
        (
            &["--scale", "2", "--scale-to", "1 g"],
            "--scale: expected only one of --scale and --scale-to",
        ),
        (&["--scale-to", "fast"], "--scale-to"),
        (&["--scale", "x"], "--scale: expected a factor"),
        (&["--history-of", "r0"], "--history-of: expected a folder for the history beside it"),
        (
            &["--history-of", "r9", "--out", "out"],
            "--history-of: expected the name of a record of the suite, such as r0, found \"r9\"",
        ),
    ] {
        let run = ["run", "model.toml", "--records", "records/*.csv"];
        let refused = folder.refused(&[&run[..], options].concat());
        assert!(refused.contains(expected), "{refused}");
    }
    let alone = ["run", "model.toml", "--motion", "records/r0.csv", "--scale-to", "0.3 g"];
    let refused = folder.refused(&[&alone[..], &["--measure", "PGV"]].concat());
    assert!(refused.contains("--measure: expected a suite"), "{refused}");
}

/// With floor spectra a suite has tables, figures and keys of them; with two storeys profiles besides.
#[test]
fn floor_spectra_and_profiles_of_a_suite() {
    let folder = folder("histories-floors", 7);
    let storey = MODEL
        .split_once("[[storey]]")
        .unwrap()
        .1
        .replace("frequency = \"2 Hz\"", "stiffness = \"30 kN/m\"");
    let (rest, _) = MODEL.split_once("[[storey]]").unwrap();
    folder.write("frame.toml", format!("{rest}[[storey]]{storey}[[storey]]{storey}"));
    let run = ["run", "frame.toml", "--records", "records", "--floor-spectrum"];
    let text = folder.stdout(&[&run[..], &["--out", "out"]].concat());
    for said in [
        "Floor spectra at 5 % damping (m/s²)",
        "Peak acceleration over the height, mean (m/s²)",
        "Peak drift over the height, mean",
        "84 %",
    ] {
        assert!(text.contains(said), "{said}: {text}");
    }
    let spectra = folder.read("out/floor-spectra.csv");
    // Bounds, ground, block and two storeys, periods.
    let rows = spectra.lines().count() - 1;
    let periods = rows / (3 * 4);
    assert!(rows == 3 * 4 * periods && periods > 100, "{rows}");
    let mean: Vec<f64> =
        column(&spectra, "mean_m_per_s2").iter().map(|cell| cell.parse().unwrap()).collect();
    let json: serde_json::Value = serde_json::from_str(&folder.read("out/summary.json")).unwrap();
    let first = &json["floor_spectrum"]["spectra"][0];
    assert_eq!((&first["friction"], &first["place"]), (&"lower".into(), &"Ground".into()));
    assert_eq!(first["mean_m_per_s2"][3].as_f64(), Some(mean[3]));
    assert_eq!(json["floor_spectrum"]["period_s"].as_array().unwrap().len(), periods);
    let governs = json["floor_spectrum"]["spectra"].as_array().unwrap().iter();
    assert_eq!(governs.filter(|one| one["governs"] == true).count(), 4);
    // Three bounds of four demands; there are no heights.
    assert_eq!(json["profiles"].as_array().unwrap().len(), 12);
    assert_eq!(column(&folder.read("out/profiles.csv"), "level")[..3], ["0.0", "1.0", "2.0"]);
    let page = folder.read("out/report.html");
    for id in ["floor-spectra", "profiles"] {
        assert!(page.contains(&format!("id=\"{id}\"")), "{id}");
        assert!(folder.read(&format!("out/{id}.svg")).starts_with("<svg"), "{id}");
    }
    // Unasked there are none, and those of another run do not stay.
    let text = folder.stdout(&["run", "plain.toml", "--records", "records", "--out", "out"]);
    assert!(!text.contains("Floor spectra") && !text.contains("over the height"), "{text}");
    let names = folder.names("out");
    assert!(
        !names.iter().any(|name| name.contains("floor") || name.contains("profile")),
        "{names:?}"
    );
    // Pairs have directions.
    let pair = ["--records", "records/r0.csv", "--second", "records/r1.csv", "--floor-spectrum"];
    let text = folder.stdout(&[&["run", "plain.toml", "--out", "pair"][..], &pair].concat());
    assert!(text.contains("Floor spectra at 5 % damping, RotD100 (m/s²)"), "{text}");
    let directions = column(&folder.read("pair/floor-spectra.csv"), "direction");
    assert_eq!(
        [&directions[0], &directions[periods], &directions[2 * periods]],
        ["rotd100", "x", "y"]
    );
}

/// The history of a record of a suite is the file that its run by itself writes.
#[test]
fn a_history_of_a_suite_is_that_of_a_single_run() {
    let folder = folder("histories-of", 3);
    let one = ["--motion", "records/r1.csv", "--scale", "2", "--out", "one"];
    folder.stdout(&[&["run", "plain.toml"][..], &one].concat());
    let of = ["--records", "records", "--scale", "2", "--history-of", "r1", "--out", "suite"];
    folder.stdout(&[&["run", "plain.toml"][..], &of].concat());
    assert_eq!(folder.read("suite/history-r1.csv"), folder.read("one/history.csv"));
    // With bounds of friction each has its file, and those of several models.
    folder.stdout(&[&["run", "model.toml", "plain.toml"][..], &of].concat());
    let names: Vec<String> =
        folder.names("suite").into_iter().filter(|name| name.contains("history")).collect();
    let expected = ["model-lower", "model-nominal", "model-upper", "plain"];
    let expected = expected.map(|which| format!("history-r1-{which}.csv"));
    assert!(expected.iter().all(|name| names.contains(name)), "{names:?}");
    assert_eq!(folder.read("suite/history-r1-plain.csv"), folder.read("one/history.csv"));
    let refused = folder.refused(&["run", "plain.toml", "--history-of", "r1"]);
    assert!(refused.contains("--history-of: expected a suite beside it"), "{refused}");
}

/// Of several models each column is of one bound of friction, and the statistic below is that of the column.
#[test]
fn mean_is_that_of_the_printed_column() {
    let folder = folder("histories-columns", 7);
    // With a gap so large that it plays no part the bounds differ in what they make of single records.
    let text =
        folder.stdout(&["run", "model.toml", "plain.toml", "--records", "records", "--scale", "3"]);
    let table = text.split("Peak sliding displacement").nth(1).unwrap();
    let rows: Vec<Vec<&str>> = table
        .lines()
        .map(|line| line.split_whitespace().collect())
        .skip_while(|words: &Vec<&str>| words.first() != Some(&"Record"))
        .take(9)
        .collect();
    assert!(
        rows[0].iter().any(|word| ["(lower)", "(nominal)", "(upper)"].contains(word)),
        "{text}"
    );
    assert_eq!(rows[8][0], "Mean", "{text}");
    for column in 1..=2 {
        let value = |row: &Vec<&str>| row[column].parse::<f64>().unwrap();
        let mean = rows[1..8].iter().map(value).sum::<f64>() / 7.0;
        // Cells have four digits.
        assert!((value(&rows[8]) / mean - 1.0).abs() < 1e-3, "{text}");
    }
}

/// What the slider strikes and what the storeys are called is told of a suite as of a single run.
#[test]
fn stops_contents_and_names_of_a_suite() {
    let folder = folder("histories-met", 3);
    let model = MODEL
        .replace("gap = \"20 mm\"\n", "stop = { gap = \"10 mm\", stiffness = \"400 kN/m\" }\n")
        .replace("[block]\n", "[block]\nname = \"Base mat\"\n")
        .replace("[[storey]]\n", "[[storey]]\nname = \"Roof\"\n");
    let contents = "[[contents]]\nfloor = 0\nmass = \"20 kg\"\nstatic_friction = 0.05\n\
                    kinetic_friction = 0.04\n";
    folder.write("met.toml", format!("{model}{contents}"));
    let text =
        folder.stdout(&["run", "met.toml", "--records", "records", "--scale", "2", "--out", "out"]);
    let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
    for said in [
        "the block strikes its stop",
        "Stop peak force",
        "Contents 1 peak sliding displacement",
        "Base mat peak acceleration",
        "Roof peak acceleration",
    ] {
        assert!(words.contains(said), "{said}: {text}");
    }
    assert!(folder.read("out/report.html").contains("the block strikes its stop"));
}

/// A pendulum that slides far on its dish is not the flat one that is computed.
#[test]
fn flat_geometry_is_said_of_runs_suites_and_studies() {
    let folder = folder("histories-flat", 2);
    let said = "of its radius: beyond 0.2 flat geometry is in error";
    let one = ["run", "plain.toml", "--motion", "records/r1.csv", "--scale", "8"];
    let text = folder.stdout(&one);
    let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words(&text).contains(said), "{text}");
    let text = folder.stdout(&["run", "plain.toml", "--records", "records", "--scale", "8"]);
    assert!(words(&text).contains(said), "{text}");
    folder.write(
        "plan.toml",
        "model = \"plain.toml\"\n[records]\nfiles = [\"records/*.csv\"]\nscale = [0.5, 8.0]\n",
    );
    let output = folder.output(&["study", "plan.toml", "--out", "study"]);
    let said = String::from_utf8(output.stderr).unwrap();
    let warned = "warning: flat_geometry: 2 runs, the first of them run 1\n";
    assert!(said.contains(warned), "{said}");
}

/// Every sentence of a report says which run it is of, or is of all of them.
#[test]
fn sentences_of_a_report_are_of_the_bound_that_governs() {
    let model = MODEL
        .replace("mass = \"300 kg\"", "mass = \"300 kg\"\nwidth = \"0.3 m\"")
        .replace("mass = \"200 kg\"", "mass = \"200 kg\"\nheight = \"1 m\"")
        .replace("{ lower = 0.8, upper = 1.2 }", "{ lower = 0.5, upper = 2.0 }");
    let folder = folder("histories-sentences", 1);
    folder.write("wide.toml", model);
    let arguments = ["wide.toml", "--motion", "records/r0.csv", "--scale", "1.5", "--out", "out"];
    folder.json(&arguments);
    let moving = "The block is still sliding at the end of the analysis (lower-bound friction).";
    assert!(folder.read("out/report.html").contains(moving));
    // A tail in which it comes to rest under every bound.
    let one = folder.json(&[&arguments[..], &["--set", "analysis.tail=30 s"]].concat());
    let of = |key: &str| {
        let runs = [&one, &one["bounds"]["lower"], &one["bounds"]["upper"]];
        let sizes = runs.map(|run| run[key].as_f64().unwrap().abs());
        assert!(sizes[0] != sizes[1] && sizes[0] != sizes[2], "{key}: {sizes:?}");
        sizes.into_iter().fold(0.0, f64::max)
    };
    let page = folder.read("out/report.html").replace('\u{2212}', "-").replace("&#39;", "'");
    let after = |words: &str, before: &str| -> f64 {
        let rest = page.split(words).nth(1).unwrap_or_else(|| panic!("{words}"));
        let number = rest.split(before).next().unwrap().split_whitespace().next().unwrap();
        number.parse::<f64>().unwrap().abs()
    };
    let near = |found: f64, expected: f64| {
        assert!((found / expected - 1.0).abs() < 6e-3, "{found} for {expected}");
    };
    near(after("Its peak over all bounds of friction uses ", " %"), 100.0 * of("gap_ratio"));
    near(after("It comes to rest at ", " mm"), 1e3 * of("residual_sliding_displacement_m"));
    near(after("The largest overturning moment is ", " of"), of("overturning_ratio"));
}

/// The force through surfaces in series has their slopes in it: over the weight it is no friction.
#[test]
fn force_of_surfaces_is_friction_and_restoring_force() {
    let folder = Folder::with_model(
        "histories-series",
        "[block]\nmass = \"1 t\"\n[slider]\n[[slider.surface]]\nfriction = 0.03\nradius = \"0.5 m\"\n\
         [[slider.surface]]\nfriction = 0.06\nradius = \"2 m\"\n[motion]\nsine = { frequency = \"1 Hz\", \
         amplitude = \"3 m/s2\", duration = \"6 s\", dt = \"0.01 s\" }\n",
    );
    let text = folder.stdout(&["run", "model.toml"]);
    assert!(text.contains("Peak friction and restoring force"), "{text}");
    assert!(!text.contains("Peak friction force"), "{text}");
}

/// A report that a reviewer can follow: earthquakes, factors and peaks first, what governs marked, and the hand's
/// calculation beside the runs.
#[test]
fn report_of_a_suite_says_what_it_is_of() {
    let folder = folder("histories-of", 1);
    let at2 = |component: &str, phase: f64| {
        let values = (0..1500).map(|k| {
            let t = 0.01 * f64::from(k);
            format!("{:.6e}", 0.3 * (4.0 * t + phase).sin() * (0.2 * t).sin() * (-0.05 * t).exp())
        });
        let rows: Vec<String> =
            values.collect::<Vec<_>>().chunks(5).map(|row| row.join(" ")).collect();
        format!(
            "PEER NGA STRONG MOTION DATABASE RECORD\nMade Up, 1/1/2000, Nowhere Fire Station, {component}\n\
             ACCELERATION TIME SERIES IN UNITS OF G\nNPTS=  1500, DT=   .0100 SEC,\n{}\n",
            rows.join("\n")
        )
    };
    folder.write("x/RSN1_A000.AT2", at2("0", 0.0));
    folder.write("y/RSN1_A090.AT2", at2("90", 0.7));
    let arguments = ["--records", "x", "--second", "y", "--code-spectrum"];
    let spectrum = ["sds = 1.2 g, sd1 = 0.8 g, tl = 8 s", "--jobs", "1", "--out", "out"];
    let plan = [
        "--eccentricity",
        "e = 3 m, y = 9 m, b = 18 m, d = 24 m",
        "--property-factors",
        "test = 0.8..1.3, limits = 0.6..1.8",
    ];
    let text =
        folder.stdout(&[&["run", "model.toml"], &arguments[..], &spectrum[..], &plan[..]].concat());
    let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
    for said in [
        "Records Record Earthquake Station Component Azimuth Factor PGA, resultant (g) RSN1_A000 ",
        "0, 90 0°, 90°",
        "0.75 to 1.25 T_M",
        "of the gap (%)",
        "λ at most 0.6000, at least 1.800: as run 0.6000 1.800",
        "Nowhere Fire Station",
        "Effective damping β_M (%)",
        "Displacement D_M (mm)",
        "over D_M",
        "Demand and capacity Demand, maximum Friction Capacity Used (%) Runs beyond Gap, demand with torsion × 1.360",
        "Total displacement D_TM = 1.360 D_M (mm)",
        "* governs: the bound of friction with the larger value, of each record and of all.",
    ] {
        assert!(words.contains(said), "{said}: {text}");
    }
    let summary: serde_json::Value =
        serde_json::from_str(&folder.read("out/summary.json")).unwrap();
    // A pair is from where its first component is, which is along x.
    let record = &summary["suite"][0];
    assert_eq!(record["station"], "Nowhere Fire Station");
    assert_eq!(record["azimuth_deg"], 0.0);
    assert_eq!(summary["model_hash"].as_str().unwrap().len(), 12);
    let lateral = &summary["lateral_force"][1];
    let number = |key: &str| lateral[key].as_f64().unwrap();
    // D = Sa(T) (T/2π)²/B with Sa = 0.8 g/T, T from the stiffness under the mass of 500 kg.
    let rate = number("period_s") / std::f64::consts::TAU;
    let sa = 0.8 * 9.80665 / number("period_s");
    let displacement = sa * rate * rate / number("damping_factor");
    assert!((displacement / number("displacement_m") - 1.0).abs() < 1e-12, "{lateral}");
    assert!((500.0 / (number("stiffness_n_per_m") * rate * rate) - 1.0).abs() < 1e-12, "{lateral}");
    // Pairs are compared with the spectrum from 0.75 of the shortest effective period to 1.25 of the longest.
    let periods = summary["lateral_force"].as_array().unwrap().iter();
    let periods: Vec<f64> = periods.map(|found| found["period_s"].as_f64().unwrap()).collect();
    let (longest, shortest) = (periods[0], periods[2]);
    let range = format!("from {:.3} s to {:.3} s", 0.75 * shortest, 1.25 * longest);
    assert!(words.contains(&range) && longest > shortest, "{range}: {text}");
    let within = ["--property-factors", "test = 0.8..1.3"];
    let text =
        folder.stdout(&[&["run", "model.toml"], &arguments[..], &spectrum[..1], &within].concat());
    let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words.contains("milder than those of ASCE/SEI 7, section 17.2.8.4"), "{text}");
    let page = folder.read("out/report.html");
    assert!(page.contains("class=\"number governs\""));
    assert!(page.find("id=\"target\"").unwrap() < page.find("id=\"histories\"").unwrap());
}

/// Two records of one name in two folders are two rows, each with its factor.
#[test]
fn records_of_one_name_are_two_rows() {
    let folder = folder("histories-alike", 2);
    folder.write("a/taft.csv", folder.read("records/r0.csv"));
    folder.write("b/taft.csv", folder.read("records/r1.csv"));
    let run = ["run", "plain.toml", "--records", "a/taft.csv", "b/taft.csv", "--scale-to", "0.3 g"];
    let text = folder.stdout(&[&run[..], &["--out", "out"]].concat());
    let rows = |name: &str| text.lines().filter(|line| line.starts_with(name)).count();
    // In the table of the records with their factors, and in each table of demands.
    assert!(rows("a/taft.csv ") > 3 && rows("a/taft.csv ") == rows("b/taft.csv "), "{text}");
    let summary: serde_json::Value =
        serde_json::from_str(&folder.read("out/summary.json")).unwrap();
    let scales: Vec<f64> = summary["suite"]
        .as_array()
        .unwrap()
        .iter()
        .map(|on| on["scale"].as_f64().unwrap())
        .collect();
    assert!(scales.len() == 2 && scales[0] != scales[1], "{scales:?}");
}

/// A factor that makes another motion of a record is said with the record.
#[test]
fn far_factors_are_said() {
    let folder = folder("histories-far", 3);
    let warned = |scale: &str| {
        let text = folder.stdout(&["run", "model.toml", "--records", "records", "--scale", scale]);
        text.split_whitespace()
            .collect::<Vec<_>>()
            .join(" ")
            .contains("factor_far: 3 of 3 factors are outside 0.25 to 4")
    };
    assert!(warned("0.2") && warned("-5") && !warned("4") && !warned("-0.25"));
}

/// What reading two files said stands in the answer with each of them, weighed; the sentence above names the
/// first.
#[test]
fn notices_of_every_record_of_a_suite_are_kept() {
    let folder = folder("histories-noticed", 3);
    for i in 0..2 {
        // A first sample that is not 0, and a velocity left at the end.
        let rest =
            folder.read(&format!("records/r{i}.csv")).replace("\n0.00,0.000000\n", "\n0.00,0.9\n");
        folder.write(&format!("records/r{i}.csv"), rest);
    }
    let run = ["run", "model.toml", "--records", "records", "--out", "out", "--json"];
    let summary: serde_json::Value = serde_json::from_str(&folder.stdout(&run)).unwrap();
    let kinds = |i: usize| -> Vec<&str> {
        let notices = summary["suite"][i]["notices"].as_array().unwrap();
        notices.iter().map(|notice| notice["kind"].as_str().unwrap()).collect()
    };
    assert!(kinds(0).contains(&"first_sample_not_zero"), "{summary}");
    assert!(kinds(1).contains(&"first_sample_not_zero"), "{summary}");
    assert!(!kinds(2).contains(&"first_sample_not_zero"), "{summary}");
    let warnings = summary["warnings"].as_array().unwrap();
    let first = warnings.iter().find(|w| w["kind"] == "first_sample_not_zero").unwrap();
    assert_eq!(first["severity"], "warning");
    let said = first["message"].as_str().unwrap();
    assert!(said.starts_with("r0: ") && said.ends_with("(and 1 of the other records)"), "{said}");
    let page = folder.read("out/report.html");
    assert!(
        page.contains("<strong>first sample not zero</strong> (warning): r0, r1. The first: "),
        "{page}"
    );
    assert!(page.contains(&format!("model {}", summary["model_hash"].as_str().unwrap())));
}

/// A single run says which model and which record it is of, the gravest notice first.
#[test]
fn a_run_says_what_it_is_of() {
    let folder = folder("histories-one", 1);
    let run = |more: &[&str]| {
        folder.json(&[&["model.toml", "--motion", "records/r0.csv", "--scale", "3"], more].concat())
    };
    let summary = run(&[]);
    assert_eq!(summary["record"]["factor"], 3.0);
    assert_eq!(summary["warnings"][0]["kind"], "gap_exceeded");
    assert_eq!(summary["warnings"][0]["severity"], "severe");
    let hash = |summary: &serde_json::Value| summary["model_hash"].as_str().unwrap().to_owned();
    assert_ne!(hash(&summary), hash(&run(&["--set", "slider.gap=21 mm"])));
    // Comments and order are not in it.
    folder.write("model.toml", format!("# The same.\n{MODEL}"));
    assert_eq!(hash(&summary), hash(&run(&[])));
    let text = folder.stdout(&["run", "model.toml", "--motion", "records/r0.csv", "--scale", "3"]);
    assert!(text.contains(&format!("model {}", hash(&summary))), "{text}");
    assert!(text.contains("\nSevere   gap_exceeded"), "{text}");
}

/// What a reviewer asks of a report for a code: the intensity by its name, factors on the properties, demand beside
/// capacity with the number of runs beyond, the total displacement of an eccentricity.
#[test]
fn report_for_a_code_names_intensity_factors_and_capacity() {
    let folder = folder("histories-code", 3);
    let stop = "stop = { gap = \"20 mm\", stiffness = \"4 MN/m\" }\n";
    let stopped = MODEL
        .replace("gap = \"20 mm\"\n", stop)
        .replace("bounds = { lower = 0.8, upper = 1.2 }\n", "");
    folder.write("stopped.toml", stopped);
    let run = |more: &[&str]| {
        let suite = ["run", "stopped.toml", "--records", "records", "--scale", "3"];
        folder.stdout(&[&suite[..], more].concat())
    };
    let factors =
        ["--property-factors", "test = 0.8..1.1, aging = 0.9..1.4, specification = 0.85..1.15"];
    let text = run(&[&factors[..], &["--hazard", "MCE_R", "--out", "out"]].concat());
    let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
    for said in [
        "Governs MCE_R: peak sliding displacement",
        "3 records × 3 at MCE_R",
        "Demand and capacity",
        "Stop struck: largest force (kN)",
        "λ on friction, with 0.75 of aging 0.6290 1.64",
    ] {
        assert!(words.contains(said), "{said}: {text}");
    }
    let summary: serde_json::Value =
        serde_json::from_str(&folder.read("out/summary.json")).unwrap();
    assert_eq!(summary["hazard"], "MCE_R");
    let runs = folder.read("out/runs.csv");
    let struck = column(&runs, "stop.contact_count").iter().filter(|n| *n != "0").count();
    assert!(words.contains(&format!("{struck} of 9")), "{text}");
    // The bounds are those of the factors: (1 + 0.75 · 0.4) · 1.1 · 1.15.
    let set = ["--set", "slider.bounds.lower=0.629", "--set", "slider.bounds.upper=1.6445"];
    run(&[&set[..], &["--out", "set"]].concat());
    let peaks = |runs: &str| column(runs, "peak_sliding_displacement_m");
    let pairs = peaks(&runs).into_iter().zip(peaks(&folder.read("set/runs.csv")));
    for (a, b) in pairs {
        let [a, b] = [a, b].map(|text| text.parse::<f64>().unwrap());
        assert!((a / b - 1.0).abs() < 1e-9, "{a} {b}");
    }
    let refused = folder.refused(&["run", "stopped.toml", "--property-factors", "aging = 2..3"]);
    assert!(refused.contains("--property-factors: expected factors from below 1"), "{refused}");
}

/// A model's own record is called by its file wherever a name is needed; what its format is stands behind the name.
#[test]
fn a_models_own_record_is_called_by_its_file() {
    let folder = folder("histories-named", 2);
    let own = |i: u32| format!("{MODEL}[motion]\nrecord = \"records/r{i}.csv\"\n");
    folder.write("a.toml", own(0));
    folder.write("b.toml", own(1));
    let summary = folder.stdout(&["run", "a.toml", "b.toml", "--json", "-q"]);
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
    let names: Vec<&serde_json::Value> =
        summary["suite"].as_array().unwrap().iter().map(|on| &on["record"]).collect();
    assert_eq!(names, ["r0", "r1"]);
    let text = folder.stdout(&["run", "a.toml", "-q", "--out", "out"]);
    let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words(&text).contains("Record r0 ("), "{text}");
    assert!(words(&folder.read("out/report.html")).contains("ground motion: r0 ("));
    // The record that replaces it too.
    let text = folder.stdout(&["run", "a.toml", "--motion", "records/r1.csv", "-q"]);
    assert!(words(&text).contains("Record r1 ("), "{text}");
}

/// Two records of one name from two folders, and of one length, are two rows.
#[test]
fn records_of_one_name_in_two_folders_are_two_rows() {
    let folder = folder("histories-alike", 2);
    folder.write("near/r0.csv", folder.read("records/r1.csv"));
    let run = ["run", "model.toml", "--records", "records/r0.csv", "near/r0.csv", "--json", "-q"];
    let summary: serde_json::Value = serde_json::from_str(&folder.stdout(&run)).unwrap();
    let names: Vec<&str> = summary["suite"]
        .as_array()
        .unwrap()
        .iter()
        .map(|on| on["record"].as_str().unwrap())
        .collect();
    assert_eq!(names, ["records/r0.csv", "near/r0.csv"]);
}
