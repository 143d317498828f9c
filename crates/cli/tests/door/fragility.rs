//! Fragility, from counts and from studies.

use serde_json::Value;

use super::assessment::{json, number, suite};
use super::support::{Folder, column};

#[test]
fn peer_fragility_of_counts_is_that_of_statsmodels() {
    let folder = Folder::new("fragility-counts");
    folder.write("stripes.csv", "level,runs,exceeded\n0.2,11,1\n0.4,11,4\n0.8,11,10\n");
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
fn exact_fragility_of_a_study_counts_its_rows() {
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
        "--levels",
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
    // First crossings need the names of the records, which Parquet has too.
    let crossings = |source: &str| {
        json(&folder, &[&["fragility", source, "--fit-to", "capacities"], &limit[..]].concat())
    };
    assert_eq!(crossings("ida/ida.parquet")["median"], crossings("ida/ida.csv")["median"]);
    assert!(number(&crossings("study")["median"]) > 0.0);
    let csv = folder.read("ida/ida.csv");
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
