//! Analyses over a suite: spectrum, ida, fragility, design.

use serde_json::Value;

use super::support::{BLOCK, Folder, cells, column, message, text};

/// A storey on a pendulum slider with a gap.
const TOWER: &str = r#"name = "Tower"
[block]
mass = "100 kg"
[slider]
static_friction = 0.06
kinetic_friction = 0.05
radius = "2 m"
gap = "60 mm"
bounds = { lower = 0.8, upper = 1.3 }
[[storey]]
mass = "50 kg"
period = "0.5 s"
damping_ratio = 0.02
"#;

/// A record of a decaying oscillation, another for every number.
fn record(number: u32) -> String {
    let mut text = "time_s,acceleration_m_per_s2\n".to_owned();
    let f = f64::from(number);
    for i in 0..=300 {
        let t = 0.02 * f64::from(i);
        let wave = (5.0 + 1.3 * f) * t;
        let value = if i == 0 {
            0.0
        } else {
            2.0 * (-0.4 * t).exp() * (wave.sin() + 0.5 * (2.3 * wave + f).sin())
        };
        text.push_str(&format!("{t:.2},{value:.6}\n"));
    }
    text
}

/// The tower without bounds of friction, and so many records.
pub fn suite(test: &str, records: u32) -> Folder {
    let folder = bounded(test, records);
    folder.write("model.toml", TOWER.replace("bounds = { lower = 0.8, upper = 1.3 }\n", ""));
    folder
}

/// The tower and so many records.
fn bounded(test: &str, records: u32) -> Folder {
    let folder = Folder::with_model(test, TOWER);
    for number in 0..records {
        folder.write(&format!("records/r{number}.csv"), record(number));
    }
    folder
}

pub fn json(folder: &Folder, arguments: &[&str]) -> Value {
    let arguments = [arguments, &["--json", "-q"]].concat();
    serde_json::from_str(&folder.stdout(&arguments)).unwrap()
}

pub fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

/// What `slipstick run` says of one record, for the same values.
fn run(folder: &Folder, record: &str, scale: f64, set: &[&str]) -> Value {
    let motion = format!("records/{record}.csv");
    let scale = format!("{scale:?}");
    let mut arguments = vec!["model.toml", "--motion", &motion, "--scale", &scale, "-q"];
    for set in set {
        arguments.extend(["--set", set]);
    }
    folder.json(&arguments)
}

#[test]
fn spectrum_of_one_record_is_that_of_its_runs() {
    let folder = suite("spectrum-one", 1);
    let over = "storey.1.period=0.2, 0.5, 1.1 s";
    folder.stdout(&[
        "spectrum",
        "model.toml",
        "--records",
        "records",
        "--over",
        over,
        "--friction",
        "0.03,0.08",
        "--scale",
        "2",
        "--out",
        "out",
        "-q",
    ]);
    let csv = folder.read("out/spectrum.csv");
    let periods = column(&csv, "storey.1.period");
    let frictions = column(&csv, "slider.kinetic_friction");
    assert_eq!(periods, [0.2, 0.5, 1.1, 0.2, 0.5, 1.1]);
    assert_eq!(frictions, [0.03, 0.03, 0.03, 0.08, 0.08, 0.08]);
    for row in 0..6 {
        let kinetic = format!("slider.kinetic_friction={:?}", frictions[row]);
        // The ratio of the coefficients stays that of the model.
        let fixed = format!("slider.static_friction={:?}", frictions[row] * (0.06 / 0.05));
        let period = format!("storey.1.period={:?} s", periods[row]);
        let expected = run(&folder, "r0", 2.0, &[&kinetic, &fixed, &period]);
        let cell = |name: &str| column(&csv, name)[row];
        for share in ["p16", "p50", "p84"] {
            let found = cell(&format!("peak_sliding_displacement_m_{share}"));
            assert_eq!(found, number(&expected["peak_sliding_displacement_m"]));
        }
        let residual = number(&expected["residual_sliding_displacement_m"]).abs();
        assert_eq!(cell("residual_sliding_displacement_m_p50"), residual);
        let roof = number(&expected["storeys"][0]["peak_acceleration_m_per_s2"]);
        assert_eq!(cell("storey1_peak_acceleration_m_per_s2_p50"), roof);
        let table = number(&expected["record"]["pga_m_per_s2"]);
        assert_eq!(cell("storey1_amplification_p50"), roof / table);
        // Held by friction that nothing overcomes.
        let held = run(&folder, "r0", 2.0, &["slider.static_friction=1e6", &period]);
        let held = number(&held["storeys"][0]["peak_acceleration_m_per_s2"]);
        let ratio = cell("storey1_fixed_base_ratio_p50");
        assert!((ratio * held / roof - 1.0).abs() < 1e-9, "{ratio} for {}", roof / held);
    }
    let page = folder.read("out/report.html");
    assert!(page.contains("<svg") && !page.contains("src=") && page.contains("Sliding spectra"));
    for name in
        ["spectrum.parquet", "runs.parquet", "summary.json", "displacement.svg", "residual.svg"]
    {
        assert!(folder.names("out").contains(&name.to_owned()), "{name}");
    }
}

/// Whatever is asked for has its own curves, once: in the table, on the page, in a file.
#[test]
fn every_curve_of_a_spectrum_has_its_own_figure() {
    let folder = suite("spectrum-figures", 1);
    let mut arguments = vec!["spectrum", "model.toml", "--records", "records", "-q"];
    arguments.extend(["--over", "slider.kinetic_friction=0.02,0.05", "--out", "out"]);
    for key in [
        "storey1_peak_displacement_m",
        "storey1_peak_acceleration_m_per_s2",
        "peak_base_shear_n",
        "block.peak_acceleration_m_per_s2",
        "peak_sliding_displacement_m",
        "storey1_peak_displacement_m",
    ] {
        arguments.extend(["--demand", key]);
    }
    folder.stdout(&arguments);
    let csv = folder.read("out/spectrum.csv");
    let mut heads: Vec<&str> = csv.lines().next().expect("heads").split(',').collect();
    let count = heads.len();
    heads.sort_unstable();
    heads.dedup();
    assert_eq!(heads.len(), count, "{csv}");
    // Four that are always told, three that are asked for besides, two ratios.
    assert_eq!(heads.iter().filter(|head| head.ends_with("_p50")).count(), 9, "{heads:?}");
    let page = folder.read("out/report.html");
    let of_page: Vec<&str> = page.split("<figure id=\"").skip(1).collect();
    let names = of_page.iter().map(|rest| rest.split('"').next().expect("an identifier"));
    let mut pictures: Vec<String> = names.map(|name| format!("{name}.svg")).collect();
    pictures.sort_unstable();
    let mut files = folder.names("out");
    files.retain(|name| name.ends_with(".svg"));
    files.sort_unstable();
    assert_eq!(pictures, files);
    assert_eq!(files.len(), 9, "{files:?}");
}

/// Whatever is asked for is told, once, however much it is.
#[test]
fn every_demand_of_a_sensitivity_is_told() {
    let folder = suite("sensitivity-demands", 1);
    let mut arguments = vec!["sensitivity", "model.toml", "--records", "records", "--out", "out"];
    // By the old name of --vary.
    arguments.extend(["--paths", "slider.kinetic_friction", "-q"]);
    let keys = [
        "peak_base_shear_n",
        "peak_sliding_displacement_m",
        "sliding_path_m",
        "storey1_peak_displacement_m",
        "sliding_time_s",
        "block.peak_acceleration_m_per_s2",
    ];
    for key in keys.iter().chain(&keys[..1]) {
        arguments.extend(["--demand", key]);
    }
    let text = folder.stdout(&arguments);
    let titles = ["Peak base shear", "Sliding path", "Storey 1 peak displacement", "Sliding time"];
    for title in titles {
        assert_eq!(text.matches(&format!("\n{title}\n")).count(), 1, "{title}: {text}");
    }
    let csv = folder.read("out/sensitivity.csv");
    assert_eq!(csv.lines().count(), 1 + keys.len(), "{csv}");
    let page = folder.read("out/report.html");
    let pictures = folder.names("out").iter().filter(|name| name.ends_with(".svg")).count();
    assert_eq!((page.matches("<figure id=\"tornado").count(), pictures), (6, 6));
}

#[test]
fn isolator_period_sets_the_radius() {
    let folder = suite("isolator", 1);
    let out = |over: &str| {
        json(
            &folder,
            &[
                "spectrum",
                "model.toml",
                "--records",
                "records",
                "--over",
                over,
                "--scale-to",
                "3 m/s2",
            ],
        )
    };
    let by_period = out("isolator.period=2, 3 s");
    let radius = |t: f64| 9.80665 * (t / std::f64::consts::TAU) * (t / std::f64::consts::TAU);
    let by_radius = out(&format!("slider.radius={:?}, {:?} m", radius(2.0), radius(3.0)));
    assert_eq!(by_period["curves"], by_radius["curves"]);
    assert_eq!(by_period["values"], serde_json::json!([2.0, 3.0]));
    assert_eq!(by_period["over"], "isolator.period");
}

#[test]
fn frequency_response_has_its_window() {
    let folder = Folder::with_model(
        "frequency",
        &format!(
            "{BLOCK}\n[[storey]]\nmass = \"50 kg\"\nfrequency = \"2 Hz\"\ndamping_ratio = 0.01\n"
        ),
    );
    let result =
        json(&folder, &["spectrum", "model.toml", "--over", "motion.sine.frequency=0.5..5Hz:19"]);
    assert_eq!(result["values"].as_array().unwrap().len(), 19);
    assert_eq!(result["runs"], 19);
    let windows = result["windows"][0]["above_1"].as_array().unwrap();
    assert!(!windows.is_empty(), "{result}");
    for window in windows {
        assert!(number(&window[0]) < number(&window[1]));
    }
    // At 2 Hz the model is as it stands.
    let plain = folder.json(&["model.toml"]);
    let curve = &result["curves"][3];
    assert_eq!(curve["demand"], "storey1_peak_acceleration_m_per_s2");
    assert_eq!(curve["p50"][6], plain["storeys"][0]["peak_acceleration_m_per_s2"]);
}

#[test]
fn ida_at_levels_is_that_of_its_runs() {
    let folder = suite("ida", 4);
    folder.stdout(&[
        "ida",
        "model.toml",
        "--records",
        "records/*.csv",
        "--scale-to",
        "1..7 m/s2:4",
        "--out",
        "out",
        "-q",
    ]);
    let csv = folder.read("out/ida.csv");
    let (levels, scales) = (column(&csv, "level"), column(&csv, "scale"));
    let (records, demands) = (cells(&csv, "record"), column(&csv, "peak_sliding_displacement_m"));
    assert_eq!(levels.len(), 16);
    assert_eq!(levels[..4], [1.0, 3.0, 5.0, 7.0]);
    for row in [0, 5, 10, 15] {
        let expected = run(&folder, &records[row], scales[row], &[]);
        assert_eq!(demands[row], number(&expected["peak_sliding_displacement_m"]), "row {row}");
        let pga = number(&expected["record"]["pga_m_per_s2"]);
        assert!((pga / levels[row] - 1.0).abs() < 1e-14);
    }
    // The model's gap is the limit; fractiles are counted over the suite.
    let summary: Value = serde_json::from_str(&folder.read("out/summary.json")).unwrap();
    assert_eq!(summary["limit"], 0.06);
    let mut third: Vec<f64> = (0..4).map(|r| demands[4 * r + 2]).collect();
    third.sort_by(f64::total_cmp);
    let median = number(&summary["demand_by_level"][2]["p50"]);
    assert!((median - 0.5 * (third[1] + third[2])).abs() < 1e-15);
    assert!(folder.read("out/report.html").contains("Incremental dynamic analysis"));
}

#[test]
fn hunt_brackets_the_gap_to_one_percent() {
    let folder = suite("hunt", 3);
    folder.stdout(&["ida", "model.toml", "--records", "records", "--out", "out", "-q"]);
    let csv = folder.read("out/capacities.csv");
    let records = cells(&csv, "record");
    let (below, above) = (column(&csv, "below"), column(&csv, "above"));
    assert_eq!(column(&csv, "reached"), [1.0; 3]);
    for row in 0..3 {
        assert!(above[row] - below[row] <= 0.01 * above[row]);
        let pga = number(&run(&folder, &records[row], 1.0, &[])["record"]["pga_m_per_s2"]);
        let peak = |level: f64| {
            number(&run(&folder, &records[row], level / pga, &[])["peak_sliding_displacement_m"])
        };
        assert!(peak(below[row]) < 0.06 && peak(above[row]) >= 0.06, "{}", records[row]);
    }
    // What the hunt found is what the fragility is fitted to, from any of its files or the folder:
    // a level that several records were run at makes no stripe of it.
    let of = |source: &str| json(&folder, &["fragility", source, "--limit", "60 mm"]);
    let by_capacity = of("out/capacities.csv");
    for source in ["out/ida.csv", "out/ida.parquet", "out"] {
        let by_run = of(source);
        for key in
            ["median", "dispersion", "median_interval", "dispersion_interval", "method", "measure"]
        {
            assert_eq!(by_capacity[key], by_run[key], "{source}: {key}");
        }
        assert_eq!(by_run["why"], "the levels were hunted for each record");
    }
    let text = folder.stdout(&["fragility", "out", "--limit", "60 mm"]);
    let first = "Fitted   to capacities, the first crossing of each record: the levels were hunted";
    assert!(text.starts_with(first), "{text}");
    let refused = folder.refused(&["fragility", "out", "--limit", "60 mm", "--fit-to", "counts"]);
    assert!(refused.starts_with("--fit-to: expected capacities: the levels"), "{refused}");
    // Without the word of the analysis the levels themselves tell.
    let rows: Vec<String> = folder
        .read("out/ida.csv")
        .lines()
        .map(|line| {
            line.split(',')
                .enumerate()
                .filter(|(i, _)| *i != 3)
                .map(|(_, c)| c)
                .collect::<Vec<_>>()
                .join(",")
        })
        .collect();
    folder.write("plain.csv", rows.join("\n"));
    assert!(!rows[0].contains("level_choice"));
    assert_eq!(of("plain.csv")["median"], by_capacity["median"]);
    assert_eq!(by_capacity["measure"], "PGA");
    assert_eq!(by_capacity["method"], "capacities");
    let capacities = column(&csv, "capacity");
    let mean = capacities.iter().map(|c| c.ln()).sum::<f64>() / 3.0;
    assert!((number(&by_capacity["median"]).ln() - mean).abs() < 1e-9);
    // Another demand needs its own limit.
    let refused = folder.refused(&[
        "ida",
        "model.toml",
        "--records",
        "records",
        "--demand",
        "storey1_peak_drift_m",
    ]);
    assert!(refused.starts_with("--limit: expected a limit to hunt for"), "{refused}");
    let drift = json(
        &folder,
        &[
            "ida",
            "model.toml",
            "--records",
            "records",
            "--demand",
            "storey1_peak_drift_m",
            "--limit",
            "4 mm",
        ],
    );
    assert_eq!(drift["limit"], 0.004);
}

/// statsmodels 0.15: `data/reference/fragility.json`, the case "few".
#[test]
fn design_front_is_that_of_all_designs() {
    let folder = bounded("design", 1);
    let (friction, radius) = ("0.02..0.10:9", "slider.radius=0.5..4m:8");
    let scale = ["--scale-to", "2 m/s2"];
    let arguments = |command: &'static str| {
        let common = [command, "model.toml", "--records", "records", "--friction", friction, "-q"];
        [&common[..], &scale[..]].concat()
    };
    folder.stdout(
        &[&arguments("spectrum")[..], &["--over", radius, "--bounds", "nominal", "--out", "all"]]
            .concat(),
    );
    folder.stdout(
        &[
            &arguments("design")[..],
            &["--vary", radius, "--gap", "80 mm", "--sensitivity", "16", "--out", "out"],
        ]
        .concat(),
    );
    let all = folder.read("all/spectrum.csv");
    let d = column(&all, "peak_sliding_displacement_m_p50");
    let a = column(&all, "storey1_peak_acceleration_m_per_s2_p50");
    assert_eq!(d.len(), 72);
    let feasible: Vec<usize> = (0..72).filter(|&i| d[i] <= 0.08).collect();
    assert!(feasible.len() > 3 && feasible.len() < 72, "{} of 72", feasible.len());
    let beaten = |i: usize| {
        feasible.iter().any(|&j| d[j] <= d[i] && a[j] <= a[i] && (d[j] < d[i] || a[j] < a[i]))
    };
    let mut expected: Vec<[f64; 2]> =
        feasible.iter().filter(|&&i| !beaten(i)).map(|&i| [d[i], a[i]]).collect();
    expected.sort_by(|x, y| x[0].total_cmp(&y[0]));
    let front = folder.read("out/front.csv");
    let found: Vec<[f64; 2]> = column(&front, "displacement_m")
        .into_iter()
        .zip(column(&front, "acceleration_m_per_s2"))
        .map(|(d, a)| [d, a])
        .collect();
    assert_eq!(found, expected);
    let summary: Value = serde_json::from_str(&folder.read("out/summary.json")).unwrap();
    let last = expected.last().unwrap();
    assert_eq!(number(&summary["chosen"]["nominal"]["acceleration_m_per_s2"]), last[1]);
    // The chosen design with lower friction, by hand.
    let values = &summary["chosen"]["values"];
    let [mu, radius] = [number(&values[0]), number(&values[1])];
    let pga = number(&run(&folder, "r0", 1.0, &[])["record"]["pga_m_per_s2"]);
    let set = [
        format!("slider.kinetic_friction={mu:?}"),
        format!("slider.static_friction={:?}", mu * (0.06 / 0.05)),
        format!("slider.radius={radius:?} m"),
    ];
    let set: Vec<&str> = set.iter().map(String::as_str).collect();
    let by_hand = run(&folder, "r0", 2.0 / pga, &set);
    for (bound, expected) in
        [("lower", &by_hand["bounds"]["lower"]), ("upper", &by_hand["bounds"]["upper"])]
    {
        let found = number(&summary["chosen"][bound]["displacement_m"]);
        assert_eq!(found, number(&expected["peak_sliding_displacement_m"]), "{bound}");
    }
    let indices = summary["sensitivity"]["displacement"].as_array().unwrap();
    assert_eq!(indices.len(), 2);
}

#[test]
fn design_that_cannot_be_is_status_1_with_the_nearest() {
    let folder = suite("infeasible", 2);
    let output = folder.output(&[
        "design",
        "model.toml",
        "--records",
        "records",
        "--friction",
        "0.02,0.03",
        "--gap",
        "0.1 mm",
        "--scale-to",
        "6 m/s2",
        "--sensitivity",
        "0",
        "--json",
    ]);
    assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
    let result: Value = serde_json::from_str(&text(&output.stdout)).unwrap();
    assert_eq!(result["chosen"], Value::Null);
    assert!(number(&result["nearest"]["nominal"]["displacement_m"]) > 1e-4);
    assert!(text(&output.stderr).contains("no_feasible_design"));
}

#[test]
fn results_are_the_same_on_any_number_of_threads() {
    let folder = suite("threads", 3);
    let commands: [&[&str]; 3] = [
        &["spectrum", "model.toml", "--records", "records", "--over", "storey.1.period=0.2..1s:5"],
        &["ida", "model.toml", "--records", "records"],
        &[
            "design",
            "model.toml",
            "--records",
            "records",
            "--friction",
            "0.02..0.1:5",
            "--gap",
            "400 mm",
            "--sensitivity",
            "8",
        ],
    ];
    for command in commands {
        for jobs in ["1", "3"] {
            let out = format!("out{jobs}");
            folder.stdout(&[command, &["-q", "--jobs", jobs, "--out", &out]].concat());
        }
        for name in folder.names("out1") {
            if name == "report.html" {
                continue;
            }
            let bytes = |out: &str| std::fs::read(folder.path().join(out).join(&name)).unwrap();
            assert!(bytes("out1") == bytes("out3"), "{command:?}: {name}");
        }
    }
}

#[test]
fn what_is_wrong_is_said() {
    let folder = suite("refused", 2);
    folder.write("none.csv", "level [m/s2],runs,exceeded\n0.1,4,0\n0.2,4,0\n");
    folder.write("cell.csv", "level [m/s2],runs,exceeded\n0.1,4,0\n0.2,x,0\n");
    folder.write("columns.csv", "record,level_g,peak_drift_m\na,1,2\n");
    let records = ["--records", "records"];
    let with = |arguments: &[&'static str]| -> Vec<&'static str> {
        [&arguments[..2], &records[..], &arguments[2..]].concat()
    };
    let cases: [(Vec<&str>, &str); 14] = [
        (
            with(&["spectrum", "model.toml", "--over", "storey.1.perod=0.1..3s:30"]),
            "--over storey.1.perod: expected a path of the model, found \"storey.1.perod\"; nearest is \
             \"storey.1.period\"",
        ),
        (
            with(&["spectrum", "model.toml", "--over", "storey.1.period=3..1s:3"]),
            "--over storey.1.period: expected values that rise, found values that do not rise",
        ),
        (
            with(&[
                "spectrum",
                "model.toml",
                "--over",
                "slider.radius=1,2 m",
                "--demand",
                "peak_sliding_displacement",
            ]),
            "--demand: expected the key of a demand, such as peak_sliding_displacement_m, found \
             \"peak_sliding_displacement\"; nearest is \"peak_sliding_displacement_m\"",
        ),
        (
            with(&[
                "spectrum",
                "model.toml",
                "--over",
                "slider.radius=1,2 m",
                "--scale-to",
                "0.3 m",
            ]),
            "--scale-to: expected an acceleration, such as \"0.3 g\", found a length, \"0.3 m\"",
        ),
        (
            with(&["ida", "model.toml", "--scale-to", "1 m/s2", "--measure", "PGAA"]),
            "--measure: expected",
        ),
        (
            with(&["ida", "model.toml", "--scale-to", "1 m/s2", "--measure", "Arias"]),
            "--measure: expected a measure that grows as the motion does, such as PGA or Sa(1.2 s), found Arias",
        ),
        (
            with(&["ida", "model.toml", "--scale-to", "2, 1 m/s2"]),
            "--scale-to: expected levels > 0 that rise",
        ),
        (
            vec!["ida", "model.toml", "--records", "records/*.AT2", "--scale-to", "1 m/s2"],
            "records/*.AT2: ",
        ),
        (
            with(&["design", "model.toml", "--gap", "1 mm"]),
            "--vary: expected something to vary, --friction or slider.radius=1..5m:50",
        ),
        (
            vec!["fragility", "none.csv", "--measure", "PGA"],
            "none of 8 runs exceeds the limit, up to an intensity of 0.2: a fragility cannot be told; go \
             to higher intensities or take a smaller limit (intensities in m/s2)",
        ),
        (
            vec!["fragility", "none.csv"],
            "--measure: expected the measure of level [m/s2], which none.csv does not state",
        ),
        (
            vec!["fragility", "cell.csv", "--measure", "PGA"],
            "cell.csv:3:5: expected a number in runs, found \"x\"",
        ),
        (
            vec![
                "fragility",
                "columns.csv",
                "--measure",
                "PGA",
                "--demand",
                "peak_drift",
                "--limit",
                "1",
            ],
            "--demand: expected a column of columns.csv, found \"peak_drift\"; nearest is \"peak_drift_m\"",
        ),
        (
            vec!["fragility", "columns.csv", "--measure", "PGA", "--demand", "peak_drift_m"],
            "--limit: expected a limit on the demand, such as \"150 mm\", found nothing",
        ),
    ];
    for (arguments, expected) in cases {
        let found = folder.refused(&arguments);
        assert!(found.starts_with(expected), "{arguments:?}: {found:?}");
    }
    // A model that says something else than the exact method.
    let output = folder.output(&with(&[
        "ida",
        "model.toml",
        "--scale-to",
        "1 m/s2",
        "--set",
        "analysis.method=stepwise",
    ]));
    let found = message(&["ida"], &output);
    assert!(found.contains("expected the exact method"), "{found}");
}

#[test]
fn help_of_the_suite_teaches_in_a_hundred_columns() {
    let folder = Folder::new("suite-help");
    for command in ["spectrum", "ida", "fragility", "design"] {
        let help = folder.stdout(&[command, "--help"]);
        let longest = help.lines().map(|line| line.chars().count()).max().unwrap();
        assert!(longest <= 105, "{command}: {longest} columns");
        for word in ["Examples:", "report.html", "--json"] {
            assert!(help.contains(word), "{command}: {word}");
        }
    }
}

/// A model with bounds is run with each of them; what is varied is averaged over, taken apart or kept.
#[test]
fn ida_of_designs_and_bounds() {
    let folder = bounded("ida-designs", 4);
    let ida = [
        "ida",
        "model.toml",
        "--records",
        "records",
        "--scale-to",
        "1, 2, 4 m/s2",
        "--limit",
        "20 mm",
    ];
    let with = |more: &[&'static str]| [&ida[..], more].concat();
    let by_bound = json(&folder, &with(&["--out", "out"]));
    assert_eq!(by_bound["by"], "friction");
    let of_group = |i: usize| &by_bound["groups"][i]["ida"]["capacity"]["p50"];
    for (i, bound) in ["lower", "nominal", "upper"].into_iter().enumerate() {
        let one = json(&folder, &with(&["--bounds", bound]));
        assert_eq!(&one["capacity"]["p50"], of_group(i), "{bound}");
        let kept = ["--where", &format!("friction={bound}")];
        let kept = json(&folder, &[&ida[..], &kept].concat());
        assert_eq!(&kept["capacity"]["p50"], of_group(i), "{bound}");
    }
    let csv = folder.read("out/ida.csv");
    assert!(
        csv.starts_with("record,measure,measure_unit,level_choice,level,scale,friction,"),
        "{csv}"
    );
    assert!(folder.read("out/capacities.csv").lines().next().unwrap().ends_with(",friction"));
    let curves = json(&folder, &["fragility", "out", "--limit", "20 mm", "--fit-to", "capacities"]);
    assert_eq!(curves["by"], "friction");
    let median = number(&curves["curves"][1]["fragility"]["median"]);
    let lognormal = number(&by_bound["groups"][1]["ida"]["lognormal"]["median"]);
    assert!((median / lognormal - 1.0).abs() < 1e-9, "{median} {lognormal}");

    let varied = with(&["--bounds", "nominal", "--vary", "slider.radius=1, 2 m"]);
    let averaged = folder.stdout(&varied);
    let first = "Fitted   to all curves, averaged over slider.radius: 2 designs\n";
    assert!(averaged.starts_with(first), "{averaged}");
    let apart = folder.stdout(&[&varied[..], &["--by", "slider.radius"]].concat());
    assert!(apart.starts_with("Curves   by slider.radius\n"), "{apart}");
    let apart = json(&folder, &[&varied[..], &["--by", "slider.radius"]].concat());
    let one = json(&folder, &[&varied[..], &["--where", "slider.radius=2 m"]].concat());
    assert_eq!(apart["groups"][1]["ida"]["capacity"], one["capacity"]);
    let refused = folder.refused(&[&varied[..], &["--by", "slider.tilt"]].concat());
    assert!(refused.contains("--by: expected a column of what is varied"), "{refused}");

    let plain = suite("ida-plain", 2);
    let refused = plain.refused(&with(&["--bounds", "upper"]));
    assert!(refused.contains("--bounds: expected slider.bounds in the model, found"), "{refused}");

    let over = ["--records", "records", "--over", "slider.radius=1, 2 m"];
    let spectrum = json(&folder, &[&["spectrum", "model.toml"][..], &over].concat());
    assert_eq!(
        spectrum["groups"],
        serde_json::json!(["lower friction", "nominal friction", "upper friction"])
    );
}

/// A design whose runs have no answer says how many, and the status is that of a failure.
#[test]
fn design_counts_the_runs_that_fail() {
    let folder = suite("design-failed", 4);
    // Kinetic friction above the static of 0.06 makes no model: one design of five.
    let arguments = [
        "design",
        "model.toml",
        "--records",
        "records",
        "--vary",
        "slider.kinetic_friction=0.03, 0.04, 0.05, 0.06, 0.07",
        "--gap",
        "1 m",
        "--sensitivity",
        "0",
    ];
    let output = folder.output(&arguments);
    let shown = text(&output.stdout);
    assert_eq!(output.status.code(), Some(1), "{shown}");
    let words = shown.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words.contains("of 20 were needed, 4 of them without an answer"), "{shown}");
    assert!(
        words.contains(
            "runs have no answer and are left out; the first: r0, \
             slider.kinetic_friction = 0.07: "
        ),
        "{shown}"
    );
}

/// Curves of pairs at once, under a spectrum and a design too: the runs of the suite of the same pairs.
#[test]
fn pairs_at_once_in_every_analysis() {
    let folder = suite("pairs-at-once", 4);
    let pairs = [
        "--records",
        "records/r0.csv",
        "records/r2.csv",
        "--second",
        "records/r1.csv",
        "records/r3.csv",
        "-q",
        "--scale-to",
        "3 m/s2",
    ];
    let asked = |command: &[&str], out: &str| {
        folder.stdout(
            &[&[command[0], "model.toml"], &pairs[..], &command[1..], &["--out", out]].concat(),
        );
    };
    asked(&["run"], "run");
    asked(&["ida", "--limit", "40 mm"], "ida");
    let name = "peak_sliding_displacement_m";
    let runs = column(&folder.read("run/runs.csv"), name);
    assert_eq!(runs.len(), 2);
    let ida = folder.read("ida/ida.csv");
    assert_eq!(cells(&ida, "record"), ["r0 + r1", "r2 + r3"]);
    assert_eq!(column(&ida, name), runs);
    let of = |rows: &str| {
        let rows = slipstick_files::read_columns(&folder.path().join(rows)).unwrap();
        let found = rows.iter().find(|column| column.name == name).unwrap();
        found.cells.to_numbers().unwrap()
    };
    let model = folder.read("model.toml");
    let radius = model.lines().find_map(|line| line.strip_prefix("radius = ")).unwrap();
    let over = format!("slider.radius={}", radius.trim_matches('"'));
    asked(&["spectrum", "--over", &over], "spectrum");
    assert_eq!(of("spectrum/runs.parquet"), runs);
    asked(&["design", "--vary", &over, "--gap", "1 m", "--sensitivity", "0"], "design");
    assert_eq!(of("design/runs.parquet"), runs);
}

/// Two components of one station are one observation: standard errors are clustered by pair.
#[test]
fn ida_clusters_pairs() {
    let folder = suite("ida-pairs", 8);
    let levels = ["--scale-to", "1..6 m/s2:21", "--limit", "40 mm", "-q"];
    let files: Vec<String> = (0..8).map(|i| format!("records/r{i}.csv")).collect();
    let file = |i: usize| files[i].as_str();
    let (first, second) = ([0, 2, 4, 6].map(file), [1, 3, 5, 7].map(file));
    let ida = ["ida", "model.toml", "--records"];
    let pairs = [&ida[..], &first, &["--second"], &second].concat();
    let separate = ["--pairs", "separate", "--out", "pairs"];
    folder.stdout(&[&pairs[..], &levels, &separate].concat());
    folder.stdout(&[&ida[..], &["records"], &levels, &["--out", "alone"]].concat());
    let csv = folder.read("pairs/ida.csv");
    assert_eq!(cells(&csv, "pair")[..2], ["r0", "r0"]);
    assert!(cells(&csv, "pair").iter().all(|pair| ["r0", "r2", "r4", "r6"].contains(&&pair[..])));
    // Both components take the factor that brings their geometric mean to the level.
    let scales = column(&csv, "scale");
    assert_eq!(scales[0], scales[21], "{csv}");
    assert!(!folder.read("alone/ida.csv").lines().next().unwrap().contains("pair"));
    let of = |source: &str| json(&folder, &["fragility", source, "--limit", "40 mm"]);
    let (pairs, alone) = (of("pairs"), of("alone"));
    assert_eq!((&pairs["clustered_by"], &pairs["records"]), (&"pair".into(), &4.into()));
    assert_eq!((&alone["clustered_by"], &alone["records"]), (&"record".into(), &8.into()));
    // Files that state their earthquake and station need no option.
    let at2 = |name: &str, number: usize, component: &str| {
        let values =
            column(&folder.read(&format!("records/r{number}.csv")), "acceleration_m_per_s2");
        let mut text = format!(
            "PEER STRONG MOTION DATABASE RECORD\nEvent {}, Station, {component}\n\
             ACCELERATION TIME SERIES IN UNITS OF G\nNPTS= {}, DT= .0200 SEC\n",
            number / 2,
            values.len()
        );
        values.iter().for_each(|value| text.push_str(&format!("{:.7}\n", value / 9.80665)));
        folder.write(name, text);
    };
    for number in 0..8 {
        at2(&format!("at2/r{number}.AT2"), number, if number % 2 == 0 { "000" } else { "090" });
    }
    folder.stdout(&[&ida[..], &["at2"], &levels, &["--out", "stated"]].concat());
    let stated = of("stated");
    assert_eq!((&stated["clustered_by"], &stated["records"]), (&"pair".into(), &4.into()));
    assert!((number(&stated["median"]) / number(&alone["median"]) - 1.0).abs() < 1e-3);
    assert!(stated["se_ln_median"] != alone["se_ln_median"]);
}

/// One run that fails is one row with its error, named with its factor; the others are what they are alone,
/// and the status says that not all is answered.
#[test]
fn a_run_that_fails_is_a_row_and_the_status_says_so() {
    let folder = suite("one-fails", 3);
    // Three times this is more than any motion may be.
    folder.write("records/strong.csv", "time_s,acceleration_m_per_s2\n0,0\n0.1,5e29\n0.2,0\n");
    let tail = ["--records", "records/*.csv", "--scale", "3", "--out", "out"];
    let answered = |head: &[&str], runs: usize| {
        let arguments = [head, &tail[..]].concat();
        let output = folder.output(&arguments);
        assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
        let said: String = text(&output.stdout).split_whitespace().collect::<Vec<_>>().join(" ");
        let expected = format!("1 of {runs} runs have no answer and ");
        assert!(said.contains(&expected), "{said}");
        let reason = ": sample 1: expected a horizontal acceleration of at most 1e30";
        assert!(said.contains("strong × 3") && said.contains(reason), "{said}");
        let summary: Value = serde_json::from_str(&folder.read("out/summary.json")).unwrap();
        assert_eq!(summary["warnings"][0]["kind"], "failed_runs");
        said
    };
    answered(&["spectrum", "model.toml", "--over", "storey.1.period=0.5 s"], 4);
    let said = answered(&["run", "model.toml"], 4);
    assert!(said.contains("no maximum: 1 of 4 runs have no answer"), "{said}");
    let runs = folder.read("out/runs.csv");
    let status = cells(&runs, "status");
    assert_eq!(status[..3], ["ok"; 3]);
    assert!(status[3].contains("sample 1: expected"), "{status:?}");
    let alone = run(&folder, "r1", 3.0, &[]);
    let peaks = cells(&runs, "peak_sliding_displacement_m");
    assert_eq!(peaks[1].parse::<f64>().unwrap(), number(&alone["peak_sliding_displacement_m"]));
    assert_eq!(peaks[3], "");
    assert_eq!(cells(&folder.read("out/governing.csv"), "peak_sliding_displacement_m"), [""]);
}

/// The level of one record would make it stronger than any motion may be.
#[test]
fn ida_with_runs_that_fail_says_so_in_its_status() {
    let folder = suite("ida-fails", 2);
    let mut ripple = "time_s,acceleration_m_per_s2\n".to_owned();
    for i in 0..200 {
        ripple.push_str(&format!(
            "{:.3},{}\n",
            0.005 * f64::from(i),
            if i % 2 == 0 { 9 } else { -9 }
        ));
    }
    folder.write("records/ripple.csv", ripple);
    let arguments = [
        "ida",
        "model.toml",
        "--records",
        "records",
        "--measure",
        "Sa(2 s)",
        "--scale-to",
        "1, 1e29 m/s2",
    ];
    let output = folder.output(&arguments);
    let said: String = text(&output.stdout).split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(said.contains("1 of 6 runs have no answer and are left out"), "{said}");
    assert!(said.contains("the first: ripple × "), "{said}");
    assert_eq!(output.status.code(), Some(1));
}

/// Flat geometry is said wherever runs leave it, with how many and which first.
#[test]
fn runs_beyond_flat_geometry_are_counted_in_every_analysis() {
    let folder = suite("flat", 3);
    for head in [
        &["ida", "model.toml", "--scale-to", "1, 40 m/s2"][..],
        &["spectrum", "model.toml", "--over", "storey.1.period=0.5 s", "--scale", "20"],
        &["design", "model.toml", "--friction", "0.05", "--scale", "20", "--sensitivity", "0"],
    ] {
        let output =
            folder.output(&[head, &["--records", "records/*.csv", "--json", "-q"]].concat());
        let summary: Value = serde_json::from_slice(&output.stdout).unwrap();
        let warnings = summary["warnings"].as_array().unwrap();
        let flat = warnings.iter().find(|warning| warning["kind"] == "flat_geometry");
        let message =
            flat.unwrap_or_else(|| panic!("{head:?}: {summary}"))["message"].as_str().unwrap();
        assert!(
            message.starts_with("3 of ") && message.contains("the first of them r0"),
            "{message}"
        );
    }
}

/// Every answer says how many of its runs were certified, and which was the worst: as text, as JSON and on its page.
#[test]
fn every_answer_says_how_many_of_its_runs_were_certified() {
    let folder = suite("certified", 6);
    let levels = ["--scale-to", "0.5..6 m/s2:12", "--limit", "50 mm"];
    let cases: [(&str, &[&str], u64); 6] = [
        ("ida", &[&["ida", "model.toml", "--records", "records"], &levels[..]].concat(), 72),
        ("hunt", &["ida", "model.toml", "--records", "records"], 0),
        (
            "spectrum",
            &["spectrum", "model.toml", "--records", "records", "--over", "slider.radius=1..3m:3"],
            18,
        ),
        (
            "design",
            &["design", "model.toml", "--records", "records", "--friction", "0.04..0.1:4"],
            0,
        ),
        ("run", &["run", "model.toml", "--records", "records"], 6),
        ("fragility", &["fragility", "ida"], 72),
    ];
    for (out, arguments, runs) in cases {
        let output = folder.output(&[arguments, &["--out", out]].concat());
        let said = text(&output.stdout);
        let line = said.lines().find(|line| line.starts_with("Checked"));
        let line = line.unwrap_or_else(|| panic!("{out}: {said}"));
        assert!(line.contains(" runs certified"), "{out}: {line}");
        let summary: Value =
            serde_json::from_str(&folder.read(&format!("{out}/summary.json"))).unwrap();
        let certified = &summary["certified"];
        let [of, count] = ["runs", "certified"].map(|key| certified[key].as_u64().unwrap());
        assert!(1 <= count && count <= of && (runs == 0 || of == runs), "{out}: {certified}");
        assert_eq!(certified["unconfirmed"], serde_json::json!([]), "{out}");
        if out != "fragility" {
            assert!(line.contains("; worst: r"), "{out}: {line}");
            let worst = &certified["worst"];
            assert!(worst["run"].is_string() && worst["what"].is_string(), "{out}: {worst}");
            assert!(number(&worst["error"]) < 1e-10, "{out}: {worst}");
        }
        let page = folder.read(&format!("{out}/report.html"));
        assert!(page.contains(&format!("Certificates: {count} of {of} runs certified")), "{out}");
    }
    // A table of one's own says nothing of it.
    folder.write("own.csv", "level,runs,exceeded\n1,20,2\n2,20,9\n3,20,16\n");
    let own = json(&folder, &["fragility", "own.csv", "--measure", "PGA", "--units", "m/s2"]);
    assert_eq!(own["certified"], Value::Null);
    // A study says it of its parts.
    folder.write(
        "plan.toml",
        format!(
            "name = \"S\"\nmodel = \"model.toml\"\n[records]\nfiles = [\"records/*.csv\"]\n\
             measure = \"PGA\"\nlevels = {:?}\n",
            (1..13).map(|i| format!("{} m/s2", 0.5 * f64::from(i))).collect::<Vec<_>>()
        ),
    );
    folder.stdout(&["study", "plan.toml", "--out", "study", "-q"]);
    folder.stdout(&["study", "merge", "study", "--out", "merged.parquet"]);
    for source in ["study", "merged.parquet"] {
        let of_study = json(&folder, &["fragility", source, levels[2], levels[3]]);
        let certified = &of_study["certified"];
        assert_eq!(certified["runs"], 72, "{certified}");
        assert!(certified["certified"].as_u64().unwrap() >= 1, "{certified}");
        assert!(certified["worst"]["run"].as_str().unwrap().starts_with("run "), "{certified}");
    }
}

/// The limit of the analysis is known beside its tables, as in its folder.
#[test]
fn fragility_knows_the_limit_of_the_analysis() {
    let folder = suite("limit-known", 6);
    let ida = [
        "--records",
        "records",
        "--scale-to",
        "0.5..6 m/s2:12",
        "--limit",
        "50 mm",
        "--out",
        "ida",
        "-q",
    ];
    folder.stdout(&[&["ida", "model.toml"], &ida[..]].concat());
    let of = |source: &str| json(&folder, &["fragility", source]);
    for source in ["ida", "ida/ida.csv", "ida/ida.parquet", "ida/capacities.csv"] {
        assert_eq!(of(source)["limit"], 0.05, "{source}");
    }
}
