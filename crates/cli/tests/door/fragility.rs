//! Fragility, from counts and from studies.

use serde_json::Value;

use super::assessment::{json, number, suite};
use super::support::{Folder, column};

#[test]
fn peer_fragility_of_counts_is_that_of_statsmodels() {
    let folder = Folder::new("fragility-counts");
    folder.write("stripes.csv", "level [m/s2],runs,exceeded\n0.2,11,1\n0.4,11,4\n0.8,11,10\n");
    let text = include_str!("../../../../data/reference/fragility.json");
    let reference: Value = serde_json::from_str(text).unwrap();
    let case = &reference["stripes"][1];
    assert_eq!(case["name"], "few");
    let found = json(&folder, &["fragility", "stripes.csv", "--measure", "PGA", "--out", "out"]);
    for key in ["median", "dispersion", "log_likelihood", "se_ln_median", "se_dispersion"] {
        let (found, expected) = (number(&found[key]), number(&case[key]));
        assert!((found / expected - 1.0).abs() < 1e-8, "{key}: {found} for {expected}");
    }
    for key in ["median_interval", "dispersion_interval"] {
        for end in 0..2 {
            let (found, expected) = (number(&found[key][end]), number(&case[key][end]));
            assert!((found / expected - 1.0).abs() < 1e-6, "{key}: {found} for {expected}");
        }
    }
    let curve = folder.read("out/fragility.csv");
    let probability = column(&curve, "probability");
    assert!(probability[0] == 0.0 && probability.windows(2).all(|p| p[0] <= p[1]));
    for name in ["fragility.parquet", "fragility.svg", "report.html", "summary.json"] {
        assert!(folder.names("out").contains(&name.to_owned()), "{name}");
    }
}

#[test]
fn fragility_of_a_study_counts_its_rows() {
    let folder = suite("fragility-study", 5);
    folder.write(
        "plan.toml",
        "model = \"model.toml\"\n[records]\nfiles = [\"records/*.csv\"]\nmeasure = \"PGA\"\n\
         levels = [\"1 m/s2\", \"1.5 m/s2\", \"2 m/s2\", \"2.5 m/s2\", \"3 m/s2\"]\n",
    );
    folder.stdout(&["study", "plan.toml", "--out", "study", "-q"]);
    folder.stdout(&[
        "ida",
        "model.toml",
        "--records",
        "records/*.csv",
        "--scale-to",
        "1..3 m/s2:5",
        "--out",
        "ida",
        "-q",
    ]);
    let limit = ["--limit", "40 mm", "--measure", "PGA"];
    let of = |source: &str| json(&folder, &[&["fragility", source], &limit[..]].concat());
    let (of_study, of_ida) = (of("study"), of("ida/ida.csv"));
    assert_eq!(of_study["method"], "stripes");
    assert_eq!(of_study["stripes"], of_ida["stripes"]);
    assert_eq!(of_study["median"], of_ida["median"]);
    assert_eq!(of("ida/ida.parquet")["median"], of_ida["median"]);
    // The folder of the parts, and a study that has them beside its manifest.
    assert_eq!(of("study/parts")["stripes"], of_study["stripes"]);
    folder.parts_to_old_layout("study");
    assert_eq!(of("study")["stripes"], of_study["stripes"]);
    // The folder itself is the table, and each form of it fits the same.
    for source in ["ida", "ida/ida.csv", "ida/ida.parquet"] {
        assert_eq!(of(source), of_ida);
    }
    // Each is called by the model that was run, not by where the runs are.
    assert_eq!(of_ida["name"], "Tower");
    assert_eq!(of_study["name"], "model");
    folder.write("elsewhere.csv", folder.read("ida/ida.csv"));
    assert_eq!(of("elsewhere.csv")["name"], "elsewhere.csv");
    // First crossings need the names of the records, which Parquet has too.
    let crossings = |source: &str| {
        json(&folder, &[&["fragility", source, "--fit-to", "capacities"], &limit[..]].concat())
    };
    assert_eq!(crossings("ida/ida.parquet")["median"], crossings("ida/ida.csv")["median"]);
    assert!(number(&crossings("study")["median"]) > 0.0);
    let csv = folder.read("ida/ida.csv");
    assert!(csv.lines().next().unwrap().contains(",warnings,holds,"), "{csv}");
    let (levels, demands) = (column(&csv, "level"), column(&csv, "peak_sliding_displacement_m"));
    for stripe in of_study["stripes"].as_array().unwrap() {
        let level = number(&stripe["level"]);
        let rows: Vec<usize> = (0..levels.len()).filter(|&i| levels[i] == level).collect();
        let beyond = rows.iter().filter(|&&i| demands[i] > 0.04).count();
        assert_eq!(
            (rows.len(), beyond),
            (
                stripe["runs"].as_u64().unwrap() as usize,
                stripe["exceeded"].as_u64().unwrap() as usize
            )
        );
    }
    // A cloud over another measure, which the study has as a column.
    let cloud = [
        "fragility",
        "study",
        "--limit",
        "40 mm",
        "--measure",
        "PGV",
        "--fit-to",
        "cloud",
        "--floor",
        "0.1 mm",
    ];
    let cloud = json(&folder, &cloud);
    assert_eq!((&cloud["method"], &cloud["measure_unit"]), (&"cloud".into(), &"m/s".into()));
    assert!(number(&cloud["cloud"]["slope"]) > 0.5);
}

/// Every record at every level is run once for each design, so runs of a record are not independent.
#[test]
fn intervals_of_a_study_are_clustered_by_record() {
    let folder = suite("fragility-clusters", 6);
    folder.write(
        "plan.toml",
        "model = \"model.toml\"\n[records]\nfiles = [\"records/*.csv\"]\nmeasure = \"PGA\"\n\
         levels = [\"1 m/s2\", \"1.5 m/s2\", \"2 m/s2\", \"2.5 m/s2\", \"3 m/s2\"]\n[vary]\n\
         \"slider.kinetic_friction\" = { uniform = [0.03, 0.06] }\n\
         \"slider.radius\" = { values = [\"1.5 m\", \"2 m\"] }\n[sampling]\nmethod = \"sobol\"\n\
         count = 16\nseed = 3\n",
    );
    folder.stdout(&["study", "plan.toml", "--out", "study", "-q"]);
    let of = |more: &[&str]| {
        let fragility = ["fragility", "study", "--limit", "40 mm", "--measure", "PGA"];
        json(&folder, &[&fragility[..], more].concat())
    };
    let all = of(&[]);
    assert_eq!((&all["certainty"], &all["records"]), (&"clustered".into(), &6.into()));
    assert_eq!(all["designs"], 16);
    assert_eq!(
        all["averaged_over"],
        serde_json::json!(["slider.kinetic_friction", "slider.radius"])
    );
    let text = folder.stdout(&["fragility", "study", "--limit", "40 mm"]);
    let first = text.lines().next().unwrap();
    assert!(first.starts_with("Fitted   to counts of exceedances at each level: every"), "{text}");
    let words: Vec<&str> = text.split_whitespace().collect();
    let averaged = "averaged over slider.kinetic_friction, slider.radius: 16 designs";
    assert!(words.join(" ").contains(averaged), "{text}");
    // A curve of its own for each radius is the curve of those rows.
    let by = of(&["--by", "slider.radius"]);
    let curves = by["curves"].as_array().unwrap();
    assert_eq!((curves.len(), &by["by_unit"]), (2, &"m".into()));
    // What is noticed of several curves is told once.
    let noticed = |of: &serde_json::Value, kind: &str| -> Vec<String> {
        let all = of["warnings"].as_array().unwrap().iter().filter(|w| w["kind"] == kind);
        all.map(|w| w["message"].as_str().unwrap().to_owned()).collect()
    };
    let few = "6 records: intervals over so few records are rough";
    assert_eq!(noticed(&all, "few_records"), [few]);
    assert_eq!(noticed(&by, "few_records"), [format!("1.5 m: {few} (and 1 of the other curves)")]);
    for (curve, radius) in curves.iter().zip(["1.5 m", "2 m"]) {
        let alone = of(&["--where", &format!("slider.radius={radius}")]);
        // The version and the warnings are those of the whole answer.
        for (key, value) in curve["fragility"].as_object().unwrap() {
            assert_eq!(value, &alone[key], "{radius}: {key}");
        }
        assert_eq!(alone["designs"], 8);
        assert_eq!(alone["averaged_over"], serde_json::json!(["slider.kinetic_friction"]));
    }
    let low = of(&[
        "--where",
        "slider.kinetic_friction=0.03..0.045",
        "--where",
        "slider.radius=1..1.8 m",
    ]);
    assert!(number(&low["designs"]) < 8.0 && number(&low["designs"]) > 1.0);
    // Crossings are those of every design of every record.
    let crossings = of(&["--fit-to", "capacities"]);
    assert_eq!(crossings["capacities"].as_array().unwrap().len(), 6 * 16);
    // Draws of the records instead of the sandwich.
    let drawn = of(&["--bootstrap", "200"]);
    assert_eq!((&drawn["certainty"], &drawn["median"]), (&"bootstrap".into(), &all["median"]));
    let ratio = number(&drawn["se_ln_median"]) / number(&all["se_ln_median"]);
    assert!((0.5..1.5).contains(&ratio), "{ratio}");
    assert_eq!(of(&["--bootstrap", "200"]), drawn);
    folder.stdout(&[
        "fragility",
        "study",
        "--limit",
        "40 mm",
        "--by",
        "slider.radius",
        "--out",
        "by",
        "-q",
    ]);
    let curve = folder.read("by/fragility.csv");
    assert!(curve.starts_with("slider.radius,level,probability,band_low,band_high\n"), "{curve}");
    let mut radii = column(&curve, "slider.radius");
    radii.dedup();
    assert_eq!(radii, [1.5, 2.0]);
    assert!(folder.read("by/fragility.svg").contains("1.5 m"));
    for (more, expected) in [
        (
            &["--where", "slider.radius=3 m"][..],
            "--where slider.radius: expected a value that occurs",
        ),
        (&["--where", "slider.radius=2"], "--where slider.radius: expected a length with its unit"),
        (&["--where", "slider.radius"], "--where: expected PATH=VALUE or PATH=FROM..TO"),
        (&["--where", "slider.radios=2 m"], "--where: expected a column of"),
        (&["--by", "slider.radios"], "--by: expected a column of"),
        (&["--by", "peak_sliding_displacement_m"], "--by: expected a column of"),
    ] {
        let found = folder.refused(&[&["fragility", "study", "--limit", "40 mm"], more].concat());
        assert!(found.starts_with(expected), "{more:?}: {found}");
    }
}

/// A design's folder holds the runs of its front, a spectrum's all of its runs.
#[test]
fn folders_of_design_and_spectrum_are_read() {
    let folder = suite("fragility-folders", 8);
    // Records that are alike but for their strength and a part of their own: demands grow with it.
    let values = |number: usize| {
        column(&folder.read(&format!("records/r{number}.csv")), "acceleration_m_per_s2")
    };
    let first = values(0);
    for number in 0..8 {
        let mut text = "time_s,acceleration_m_per_s2\n".to_owned();
        for (i, (common, own)) in first.iter().zip(values(number)).enumerate() {
            let value = (0.5 + 0.2 * number as f64) * (common + 0.1 * own);
            text.push_str(&format!("{:.2},{value:.6}\n", 0.02 * i as f64));
        }
        folder.write(&format!("records/r{number}.csv"), text);
    }
    let common =
        ["model.toml", "--records", "records", "--scale", "1.3", "-q", "--friction", "0.03,0.05"];
    let design =
        ["--vary", "slider.radius=1, 2 m", "--gap", "2 m", "--sensitivity", "0", "--out", "design"];
    folder.stdout(&[&["design"], &common[..], &design].concat());
    folder.stdout(
        &[&["spectrum"], &common[..], &["--over", "slider.radius=1, 2 m", "--out", "spectrum"]]
            .concat(),
    );
    let of = |source: &str| {
        json(&folder, &["fragility", source, "--limit", "40 mm", "--floor", "0.1 mm"])
    };
    let front = column(&folder.read("design/front.csv"), "slider.radius").len();
    let design = of("design");
    assert_eq!((&design["method"], &design["measure"]), (&"cloud".into(), &"PGA".into()));
    let cloud = &design["cloud"];
    assert_eq!(number(&cloud["known"]) + number(&cloud["below_floor"]), 8.0 * front as f64);
    let spectrum = of("spectrum");
    assert_eq!((&spectrum["designs"], &spectrum["certainty"]), (&4.into(), &"clustered".into()));
    folder.write("empty/readme.txt", "nothing");
    let found = folder.refused(&["fragility", "empty", "--limit", "40 mm"]);
    assert!(found.contains(": expected a table, or a folder that ida"), "{found}");
}

/// A table that does not state the unit of its levels is refused: read as SI, levels in g would be wrong
/// by a factor of 9.8.
#[test]
fn intensities_without_a_unit_are_refused() {
    let folder = Folder::new("fragility-units");
    let rows = "runs,exceeded\n0.2,11,1\n0.4,11,4\n0.8,11,10\n";
    for (name, head) in [
        ("none", "level"),
        ("suffix", "level_g"),
        ("bracket", "level [g]"),
        ("si", "level_m_per_s2"),
    ] {
        folder.write(&format!("{name}.csv"), format!("{head},{rows}"));
    }
    folder.write("capacities.csv", "capacity,reached\n0.2,1\n0.4,1\n0.8,1\n");
    folder.write("ida.csv", "level,peak_drift_m\n0.2,0.1\n0.4,0.2\n0.4,0.4\n0.8,0.3\n");
    let refused = |arguments: &[&str]| folder.refused(&[&["fragility"], arguments].concat());
    let found = refused(&["none.csv", "--measure", "PGA"]);
    let expected = "--units: expected the unit of level, which none.csv does not state: write \
                    \"level [g]\" in its header, or give --units g, found none";
    assert!(found.starts_with(expected), "{found}");
    assert!(refused(&["none.csv"]).starts_with("--units: expected the unit of level"));
    assert!(refused(&["capacities.csv"]).starts_with("--units: expected the unit of capacity"));
    let run = ["ida.csv", "--demand", "peak_drift_m", "--limit", "0.25 m"];
    assert!(refused(&run).starts_with("--units: expected the unit of level"));
    let median = |arguments: &[&str]| {
        let all = [&["fragility"], arguments, &["--measure", "PGA"]].concat();
        number(&json(&folder, &all)["median"])
    };
    let si = median(&["si.csv"]);
    for stated in [&["none.csv", "--units", "g"][..], &["suffix.csv"], &["bracket.csv"]] {
        assert!((median(stated) / si / 9.80665 - 1.0).abs() < 1e-9, "{stated:?}");
    }
    assert_eq!(median(&["suffix.csv", "--units", "g"]), median(&["suffix.csv"]));
    let found = refused(&["suffix.csv", "--units", "m/s2"]);
    assert!(found.starts_with("--units: expected \"g\", the unit that level_g states"), "{found}");
    let found = refused(&["none.csv", "--measure", "PGA", "--units", "m/s"]);
    assert!(found.starts_with("--units: expected an acceleration"), "{found}");
    let velocity = json(&folder, &["fragility", "none.csv", "--measure", "PGV", "--units", "cm/s"]);
    assert_eq!(velocity["measure_unit"], "m/s");
    assert!((number(&velocity["median"]) * 100.0 / si - 1.0).abs() < 1e-9);
}

/// What the records of a study were scaled to is what its levels are of, whatever is asked for.
#[test]
fn levels_keep_their_measure() {
    let folder = suite("fragility-measure", 5);
    folder.write(
        "plan.toml",
        "model = \"model.toml\"\n[records]\nfiles = [\"records/*.csv\"]\nmeasure = \"Sa(0.45 s)\"\n\
         levels = [\"2 m/s2\", \"3 m/s2\", \"4 m/s2\", \"5 m/s2\", \"6 m/s2\"]\n",
    );
    folder.stdout(&["study", "plan.toml", "--out", "study", "-q"]);
    let common = ["--limit", "40 mm"];
    for source in ["study", "study/parts"] {
        let found = json(&folder, &[&["fragility", source], &common[..]].concat());
        assert_eq!(
            (&found["measure"], &found["measure_unit"]),
            (&"Sa(0.45 s)".into(), &"m/s2".into())
        );
        let asked = [&["fragility", source, "--measure", "Sa(0.45 s)"], &common[..]].concat();
        assert_eq!(json(&folder, &asked)["median"], found["median"]);
        let other = [&["fragility", source, "--measure", "Sa(0.7 s)"], &common[..]].concat();
        let refused = folder.refused(&other);
        let expected = "--measure: expected Sa(0.45 s), of which the levels of study/parts/";
        assert!(refused.starts_with(expected), "{refused}");
    }
    // A part says what its levels are of without its study too.
    let parts = folder.names("study/parts");
    std::fs::create_dir(folder.path().join("alone")).unwrap();
    let part = folder.path().join("study/parts").join(&parts[0]);
    std::fs::copy(part, folder.path().join("alone/rows.parquet")).unwrap();
    let alone = [&["fragility", "alone/rows.parquet"], &common[..]].concat();
    assert_eq!(json(&folder, &alone)["measure"], "Sa(0.45 s)");
    let refused = folder.refused(&[&alone[..], &["--measure", "Sa(0.7 s)"]].concat());
    let expected = "--measure: expected Sa(0.45 s), of which the levels of alone/rows.parquet";
    assert!(refused.starts_with(expected), "{refused}");
    // Counts whose table does not say it need the option.
    folder.write("stripes.csv", "level [g],runs,exceeded\n0.2,11,1\n0.4,11,4\n0.8,11,10\n");
    let refused = folder.refused(&["fragility", "stripes.csv"]);
    assert!(
        refused.starts_with("--measure: expected the measure of level [g], which"),
        "{refused}"
    );
}
