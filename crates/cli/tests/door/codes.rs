//! `slipstick run --code`: what a code requires, at one intensity and at two.

use serde_json::Value;

use super::support::{Folder, cells};

const MODEL: &str = include_str!("../../../../examples/hospital.toml");

/// A folder with the hospital and two pairs of records.
fn folder(test: &str) -> Folder {
    // A name without a comma, which would be a cell of two.
    let folder = Folder::with_model(test, &MODEL.replace("Hospital, four", "Hospital of four"));
    for i in 0..4 {
        let sample = |k: i32| {
            let t = 0.02 * f64::from(k);
            let a = 2.0 * ((2.0 + 0.3 * f64::from(i)) * t).sin() * (-0.2 * t).exp();
            format!("{t:.2},{a:.6}\n")
        };
        let text: String = (0..250).map(sample).collect();
        folder.write(&format!("r{i}.csv"), format!("time_s,acceleration_m_per_s2\n{text}"));
    }
    folder
}

const PAIRS: [&str; 7] =
    ["--records", "r0.csv", "r2.csv", "--second", "r1.csv", "r3.csv", "--pairs"];
const SPECTRUM: [&str; 2] = ["--code-spectrum", "sds = 1 g, sd1 = 0.6 g, tl = 8 s"];

#[test]
fn a_code_is_judged_in_text_json_and_page() {
    let folder = folder("codes-judged");
    let code = ["--code", "asce7-22", "--code-values", "R = 4, I_e = 1.5, S_1 = 0.7"];
    let hazards = ["--hazard", "MCE_R", "--hazard", "DE=0.5"];
    let title = ["--project", "Hospital", "--author", "A. Engineer", "--date", "1 May"];
    let run = [
        &["run", "model.toml"][..],
        &PAIRS,
        &["together"],
        &SPECTRUM,
        &code,
        &hazards,
        &title,
        &["--out", "out"],
    ]
    .concat();
    let text = folder.stdout(&run);
    let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
    for part in [
        "Code MCE_R: ASCE/SEI 7-22:",
        "Code DE: ASCE/SEI 7-22: no requirement of its own.",
        "Requirements of ASCE/SEI 7-22 at MCE_R",
        "At least seven pairs of records",
        "Maximum at each intensity",
        "Lateral force at each level along x",
        "Forces at the base, maximum at MCE_R",
    ] {
        assert!(words.contains(part), "{part}: {text}");
    }
    let json: Value = serde_json::from_str(&folder.read("out/summary.json")).unwrap();
    let rows = json["code"][0]["requirements"].as_array().unwrap();
    let of = |words: &str| {
        let found = rows.iter().find(|row| row["requirement"].as_str().unwrap().contains(words));
        found.unwrap()
    };
    let pairs = of("seven pairs");
    assert_eq!((pairs["demand"].as_f64(), pairs["capacity"].as_f64()), (Some(7.0), Some(2.0)));
    assert_eq!((pairs["ok"].as_bool(), pairs["clause"].as_str()), (Some(false), Some("17.3.3")));
    let wind = of("wind load");
    assert!(wind["ratio"].is_null() && wind["not_judged"].as_str().unwrap().contains("V_wind"));
    assert_eq!(json["hazards"][0]["name"], "DE");
    assert_eq!(json["hazards"][0]["factor"], 0.5);
    let runs = folder.read("out/runs.csv");
    let (names, scales) = (cells(&runs, "hazard"), cells(&runs, "scale"));
    assert_eq!(names.len(), 12);
    assert_eq!((&names[0][..], &names[6][..]), ("MCE_R", "DE"));
    let scales: Vec<f64> = scales.iter().map(|scale| scale.parse().unwrap()).collect();
    for (first, second) in scales[..6].iter().zip(&scales[6..]) {
        assert!((second / first - 0.5).abs() < 1e-15, "{scales:?}");
    }
    // Without factors and bounds the limits of the code are run.
    assert_eq!(cells(&runs, "friction")[..3], ["lower", "nominal", "upper"]);
    let page = folder.read("out/report.html");
    for part in ["<dt>Project</dt><dd>Hospital</dd>", "<dt>Date</dt><dd>1 May</dd>", "not judged: "]
    {
        assert!(page.contains(part), "{part}");
    }
    // Components by themselves are judged where that makes sense.
    let apart = [&["run", "model.toml", "--json"][..], &PAIRS, &["separate"], &SPECTRUM, &code];
    let model = MODEL.replace("width_y = \"36 m\"\n", "").replace("period_y = \"0.45 s\"\n", "");
    folder.write("model.toml", model);
    let json: Value = serde_json::from_str(&folder.stdout(&apart.concat())).unwrap();
    let rows = json["code"][0]["requirements"].as_array().unwrap();
    let once = rows.iter().find(|row| row["requirement"] == "Both components act at once").unwrap();
    assert_eq!((once["capacity"].as_f64(), once["ok"].as_bool()), (Some(0.0), Some(false)));
}

#[test]
fn what_no_code_asks_for_is_refused() {
    let folder = folder("codes-refused");
    let run = [&["run", "model.toml"][..], &PAIRS, &["together"]].concat();
    for (options, expected) in [
        (
            &["--code-values", "R = 4"][..],
            "--code-values: expected --code beside them, found \"R = 4\"",
        ),
        (
            &["--code", "asce7-22", "--code-values", "Vwind = 4 kN"],
            "--code-values: expected one of the values that ASCE/SEI 7-22 asks for: R, R_I, I_e, S_1, V_wind, exponent, \
             qualification_tests, found \"Vwind\"; nearest is \"V_wind\"",
        ),
        (
            &["--hazard", "MCE_R", "--hazard", "DE"],
            "--hazard: expected a name, and after the first a factor on it: MCE_R, DE=0.6667, found \"DE\"",
        ),
        (
            &["--hazard", "MCE_R", "--hazard", "DE=-1"],
            "--hazard: expected a name, and after the first a factor on it: MCE_R, DE=0.6667, found \"DE=-1\"",
        ),
    ] {
        assert_eq!(folder.refused(&[&run[..], options].concat()), expected);
    }
    let alone = folder.refused(&["run", "model.toml", "--motion", "r0.csv", "--code", "aashto"]);
    assert_eq!(alone, "--code: expected a suite beside it, --records <PATTERN>");
}
