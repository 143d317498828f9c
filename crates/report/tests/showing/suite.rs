//! Models over suites, laid out: what the check does not confirm, and records of one name.

use slipstick::assessment::histories::{CertifiedRun, Histories, Kept, ModelOn, run_histories};
use slipstick::assessment::suite::{Scaling, Suite};
use slipstick::input;
use slipstick::input::loaded::Loaded;
use slipstick::motion::GroundMotion;
use slipstick::motion::intensity::{LevelMeasure, Measure};
use slipstick::notice::{NoticeKind, Severity};
use slipstick::requests::{Answer, Results};
use slipstick::study::Record;
use slipstick::study::engine::Engine;
use slipstick_report::DisplayUnits;
use slipstick_report::assessment::{Sheet, answer};

const MODEL: &str = "[block]\nmass = \"10 t\"\n[slider]\nstatic_friction = 0.06\n\
                     kinetic_friction = 0.05\nradius = \"2 m\"\n";

fn motion(rate: f64, peak: f64) -> GroundMotion {
    let wave = |k: u32| {
        let t = 0.02 * f64::from(k);
        peak * libm::sin(rate * t) * libm::sin(9.0 * t) * libm::exp(-0.3 * t)
    };
    GroundMotion::evenly_spaced(0.02, (0..250).map(wave).collect(), None).expect("a motion")
}

fn histories(suite: &Suite) -> Histories {
    histories_of(MODEL, suite)
}

fn histories_of(model: &str, suite: &Suite) -> Histories {
    let analysis = input::parse("m.toml", model, &[]).expect("a model");
    let on = ModelOn { name: "m", analysis: &analysis, suite };
    let pga = LevelMeasure { measure: Measure::Pga, rotated: None };
    run_histories(&[on], &Scaling::Level(pga, 3.0), Kept::default(), &Engine::unwatched())
        .expect("runs")
}

fn sheet(histories: Histories, suite: &Suite) -> Sheet {
    let answer = Answer {
        name: "m".to_owned(),
        model_hash: None,
        records: suite.recorded(),
        scaled: " scaled to PGA = 3 m/s²".to_owned(),
        warnings: Vec::new(),
        title: Vec::new(),
        found: Results::Suite {
            histories,
            hazard: None,
            factors: None,
            plan: None,
            judgements: Vec::new(),
            others: Vec::new(),
        },
    };
    answer::sheet(&answer, DisplayUnits::Si)
}

/// A run whose certificate fails is in no mean; the verdict is red and names run and demand, and a severe notice
/// says it.
#[test]
fn a_run_that_is_not_confirmed_leaves_the_mean() {
    let record = |i: u32| Record::new(format!("r{i}"), motion(4.0 + f64::from(i), 3.0));
    let suite = Suite { records: (0..9).map(record).collect(), ..Suite::default() };
    let right = histories(&suite);
    let peak = right.shape.find("peak_sliding_displacement_m").expect("a demand").1;
    let mut wrong = right.clone();
    let broken = &mut wrong.models[0].records[3].runs[0];
    let demand = "demands error of peak sliding displacement";
    let CertifiedRun { mut demands, axes, floor_spectra, .. } = broken.clone().expect("a run");
    demands.peak_sliding_displacement_m *= 100.0;
    let (defect, largest) = (Some(demand.to_owned()), Some((demand.to_owned(), 0.99)));
    *broken = Ok(CertifiedRun { demands, axes, defect, largest, floor_spectra });
    let sizes = right.models[0].sizes(&peak, 0);
    let left: Vec<f64> = (0..9).filter(|i| *i != 3).map(|i| sizes[i]).collect();
    let mean = left.iter().sum::<f64>() / 8.0;
    assert!((wrong.models[0].governing(&peak, 0) - mean).abs() < 1e-15 * mean);
    assert_eq!((wrong.models[0].counted(), right.models[0].counted()), (8, 9));

    let (calm, red) = (sheet(right, &suite), sheet(wrong, &suite));
    assert!(!calm.failed && calm.complete && red.failed && !red.complete);
    assert!(calm.to_text().contains("9 of 9 runs certified; worst: r"), "{}", calm.to_text());
    let said =
        "CHECK FAILED for 1 of 9 runs, the first r3: demands error of peak sliding displacement";
    assert!(red.first.as_ref().is_some_and(|(_, said_first)| said_first.contains(said)));
    let text = red.to_text();
    assert!(text.contains("worst: r3 (demands error of peak sliding displacement, 1e0)"), "{text}");
    let failed: Vec<_> =
        red.warnings.iter().filter(|n| n.kind == NoticeKind::CheckFailed).collect();
    let [notice] = failed[..] else { panic!("one notice: {:?}", red.warnings) };
    assert_eq!(notice.severity(), Severity::Severe);
    assert!(notice.message.contains(said) && notice.message.contains("1 of 9 records"));
    let json: serde_json::Value = serde_json::from_str(&red.to_json()).expect("JSON");
    assert_eq!(json["certified"]["runs"], 9);
    assert_eq!(json["certified"]["worst"]["run"], "r3");
    assert_eq!(json["certified"]["unconfirmed"][0]["what"], demand);
}

/// The rows of a table, without its head.
fn rows(sheet: &Sheet, heading: &str) -> Vec<Vec<String>> {
    let table = sheet.tables.iter().find(|(name, _)| name.starts_with(heading));
    table.expect("a table").1[1..].to_vec()
}

/// Two records of one name or one description are two rows, each with its own factor and demand.
#[test]
fn records_of_one_name_are_two_rows() {
    let motions = [motion(4.0, 3.0), motion(7.0, 1.5)];
    let named = |motion: &GroundMotion| {
        ("Taft 1952".to_owned(), Loaded::made(motion.clone(), "Taft 1952".to_owned()))
    };
    let numbered = Suite::of(motions.iter().map(named), false);
    let names: Vec<&str> = numbered.records.iter().map(|record| &record.name[..]).collect();
    assert_eq!(names, ["Taft 1952 (1)", "Taft 1952 (2)"]);
    // Those that nobody numbered too.
    let alike = motions.iter().map(|motion| Record::new("Taft 1952", motion.clone())).collect();
    let alike = Suite { records: alike, ..Suite::default() };
    for suite in [numbered, alike] {
        let histories = histories(&suite);
        let factors: Vec<f64> = histories.models[0].records.iter().map(|on| on.scale).collect();
        let sheet = sheet(histories, &suite);
        let of_records = rows(&sheet, "Records");
        assert_eq!(of_records.len(), 2, "{of_records:?}");
        assert_ne!(of_records[0][1], of_records[1][1], "{of_records:?}");
        let peaks = rows(&sheet, "Peak sliding displacement");
        assert_eq!(peaks.len(), 3, "{peaks:?}");
        assert_ne!(peaks[0][1], peaks[1][1], "{peaks:?}");
        let json: serde_json::Value = serde_json::from_str(&sheet.to_json()).expect("JSON");
        let scales = [0, 1].map(|i| json["suite"][i]["scale"].as_f64());
        assert_eq!(scales, [Some(factors[0]), Some(factors[1])]);
    }
}

/// A headline counts the records beyond the gap and names the farthest, which the warning cites.
#[test]
fn a_headline_counts_what_exceeds_the_gap() {
    let record = |i: u32| Record::new(format!("r{i}"), motion(4.0 + f64::from(i), 3.0));
    let suite = Suite { records: (0..9).map(record).collect(), ..Suite::default() };
    let plain = histories(&suite);
    let peak = plain.shape.find("peak_sliding_displacement_m").expect("a demand").1;
    let sizes = plain.models[0].sizes(&peak, 0);
    let farthest = (0..9).max_by(|a, b| sizes[*a].total_cmp(&sizes[*b])).expect("a record");
    let mut sorted = sizes.clone();
    sorted.sort_by(f64::total_cmp);
    // Four records are beyond, then one, then none.
    for (gap_m, said) in [
        (0.5 * (sorted[4] + sorted[5]), ", and 4 of 9 records exceed the gap, "),
        (0.5 * (sorted[7] + sorted[8]), ", and 1 of 9 records exceeds the gap, "),
        (1.5 * sorted[8], ", and none of 9 records exceeds the gap, "),
    ] {
        let model = MODEL.replace("radius", &format!("gap = \"{gap_m} m\"\nradius"));
        let found = histories_of(&model, &suite);
        let sheet = sheet(found, &suite);
        let (_, first) = sheet.first.as_ref().expect("a headline");
        let most = 1e3 * sizes[farthest];
        let at = first.find(said).unwrap_or_else(|| panic!("{said}: {first}"));
        assert!(first[at..].contains(&format!(" r{farthest} ")), "{first}");
        let told: f64 = first.rsplit(' ').nth(1).and_then(|n| n.parse().ok()).expect("a number");
        assert!((told / most - 1.0).abs() < 1e-3, "{told} for {most}: {first}");
        let cited = sheet.warnings.iter().find(|w| w.kind == NoticeKind::GapExceeded);
        assert_eq!(cited.is_some(), gap_m < sorted[8]);
        let cites = |notice: &slipstick::notice::Notice| {
            notice.message.starts_with(&format!("r{farthest}: "))
        };
        assert!(cited.is_none_or(cites), "{cited:?}");
    }
}
