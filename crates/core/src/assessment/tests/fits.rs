//! Fits and distributions against statsmodels and SciPy, and against closed forms.

use serde_json::Value;

use crate::assessment::censored::{Fit, Known, Observation};
use crate::assessment::fragility::{
    Capacity, Certainty, CloudPoint, Fragility, Lognormal, Stripe, test_counts, test_normality,
};
use crate::assessment::observed::{FitTo, FragilityRequest, noticed, run_fragility};
use crate::assessment::proportion::Proportion;
use crate::error::FitError;
use crate::notice::{Notice, NoticeKind, Severity};
use crate::numerics::distribution::{
    beta_quantile, chi_squared_tail, ln_normal_cdf, normal_cdf, normal_hazard, normal_quantile,
};
use crate::numerics::fractile::{fractile, fractiles, held_by, needed, sorted};
use crate::study::engine::Engine;
use crate::table::Table;

fn reference() -> Value {
    let text = include_str!("../../../../../data/reference/fragility.json");
    serde_json::from_str(text).unwrap()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(number).collect()
}

/// Relative where the value is not small.
fn near(found: f64, expected: &Value, tolerance: f64, what: &str) {
    let expected = number(expected);
    let error = (found - expected).abs() / expected.abs().max(1e-300);
    assert!(error <= tolerance, "{what}: {found} for {expected}, off by {error:e}");
}

#[test]
fn peer_distributions_agree_with_scipy() {
    let reference = &reference()["distributions"];
    type Function = fn(&[f64]) -> f64;
    let all: [(&str, Function, f64); 5] = [
        ("normal_cdf", |a| normal_cdf(a[0]), 1e-13),
        ("ln_normal_cdf", |a| ln_normal_cdf(a[0]), 1e-13),
        ("normal_quantile", |a| normal_quantile(a[0]), 1e-13),
        ("chi_squared_tail", |a| chi_squared_tail(a[0], a[1]), 1e-12),
        ("beta_quantile", |a| beta_quantile(a[0], a[1], a[2]), 1e-11),
    ];
    for (name, function, tolerance) in all {
        let rows = reference[name].as_array().unwrap();
        assert!(rows.len() >= 5);
        for row in rows {
            let cells = row.as_array().unwrap();
            let (expected, given) = cells.split_last().unwrap();
            let given: Vec<f64> = given.iter().map(number).collect();
            near(function(&given), expected, tolerance, &format!("{name}{given:?}"));
        }
    }
}

#[test]
fn distributions_at_their_edges() {
    assert_eq!((normal_quantile(0.0), normal_quantile(1.0)), (f64::NEG_INFINITY, f64::INFINITY));
    assert!(normal_quantile(-0.1).is_nan() && normal_quantile(f64::NAN).is_nan());
    assert_eq!(normal_quantile(0.5), 0.0);
    // The hazard is the slope of ln Φ, also where the branches meet.
    for x in [-30.0, -6.001, -6.0, -5.999, -1.0, 0.0, 2.0] {
        let slope = (ln_normal_cdf(x + 1e-5) - ln_normal_cdf(x - 1e-5)) / 2e-5;
        assert!((normal_hazard(x) / slope - 1.0).abs() < 1e-8, "{x}");
    }
}

#[test]
fn peer_proportions_agree_with_statsmodels() {
    for row in reference()["proportions"].as_array().unwrap() {
        let count = |key: &str| row[key].as_u64().unwrap();
        let share = Proportion::new(count("count"), count("runs")).unwrap();
        for (found, expected) in [
            (share.wilson(0.9), &row["wilson"]),
            (share.clopper_pearson(0.9), &row["clopper_pearson"]),
        ] {
            for (found, expected) in found.iter().zip(numbers(expected)) {
                assert!((found - expected).abs() < 1e-12, "{row}: {found} for {expected}");
            }
        }
    }
    assert!(Proportion::new(0, 0).is_err() && Proportion::new(3, 2).is_err());
}

fn check_band(fragility: &Fragility, case: &Value, tolerance: f64) {
    let name = case["name"].as_str().unwrap();
    for row in case["band"].as_array().unwrap() {
        let row = numbers(row);
        let [low, high] = fragility.band(row[0], 0.9);
        for (found, expected) in [(low, row[1]), (high, row[2])] {
            let error = (found - expected).abs();
            assert!(error < tolerance, "{name}: band at {} is {found} for {expected}", row[0]);
        }
    }
}

fn check_intervals(fragility: &Fragility, case: &Value) {
    for (found, expected) in [
        (fragility.median_interval(0.9), &case["median_interval"]),
        (fragility.dispersion_interval(0.9), &case["dispersion_interval"]),
    ] {
        for (found, expected) in found.iter().zip(expected.as_array().unwrap()) {
            // The peer's profile is a search without derivatives.
            near(found.unwrap(), expected, 1e-7, case["name"].as_str().unwrap());
        }
    }
}

#[test]
fn peer_stripes_agree_with_statsmodels() {
    for case in reference()["stripes"].as_array().unwrap() {
        let name = case["name"].as_str().unwrap();
        let of = |row: &Value| Stripe {
            level: number(&row[0]),
            runs: row[1].as_u64().unwrap(),
            exceeded: row[2].as_u64().unwrap(),
        };
        let stripes: Vec<Stripe> = case["stripes"].as_array().unwrap().iter().map(of).collect();
        let fragility = Fragility::of_stripes(&stripes).unwrap();
        let curve = fragility.curve();
        near(curve.median, &case["median"], 1e-10, name);
        near(curve.dispersion, &case["dispersion"], 1e-10, name);
        near(fragility.fit().log_likelihood(), &case["log_likelihood"], 1e-12, name);
        let [of_median, of_dispersion] = fragility.standard_errors();
        near(of_median, &case["se_ln_median"], 1e-8, name);
        near(of_dispersion, &case["se_dispersion"], 1e-8, name);
        check_band(&fragility, case, 1e-9);
        check_intervals(&fragility, case);
        let test = test_counts(&curve, &stripes);
        near(test.deviance, &case["deviance"], 1e-9, name);
        near(test.pearson, &case["pearson"], 1e-9, name);
        near(test.p_value.unwrap(), &case["p_value"], 1e-9, name);
        assert_eq!(test.degrees as u64, case["degrees"].as_u64().unwrap());
        // Splitting a stripe in two, or the order, changes nothing but rounding.
        let mut split: Vec<Stripe> = stripes.clone();
        let last = split.last_mut().unwrap();
        *last = Stripe { runs: last.runs - 1, exceeded: last.exceeded - 1, ..*last };
        let level = last.level;
        split.insert(0, Stripe { level, runs: 1, exceeded: 1 });
        let again = Fragility::of_stripes(&split).unwrap().curve();
        assert!((again.median / curve.median - 1.0).abs() < 1e-12);
        let again = test_counts(&curve, &split);
        assert!((again.deviance - test.deviance).abs() < 1e-9 && again.degrees == test.degrees);
    }
}

#[test]
fn peer_capacities_agree_with_scipy() {
    for case in reference()["capacities"].as_array().unwrap() {
        let name = case["name"].as_str().unwrap();
        let levels = numbers(&case["levels"]);
        let reached = case["reached"].as_array().unwrap().iter().map(|r| r.as_bool().unwrap());
        let capacities: Vec<Capacity> = levels
            .iter()
            .zip(reached)
            .map(|(&level, reached)| Capacity { level, reached })
            .collect();
        let fragility = Fragility::of_capacities(&capacities).unwrap();
        near(fragility.curve().median, &case["median"], 1e-9, name);
        near(fragility.curve().dispersion, &case["dispersion"], 1e-9, name);
        near(fragility.fit().log_likelihood(), &case["log_likelihood"], 1e-10, name);
        let [of_median, of_dispersion] = fragility.standard_errors();
        // The peer's information is by differences of differences.
        near(of_median, &case["se_ln_median"], 1e-6, name);
        near(of_dispersion, &case["se_dispersion"], 1e-6, name);
        check_intervals(&fragility, case);
        if case["moments"].is_null() {
            assert!(capacities.iter().any(|capacity| !capacity.reached) || levels.len() < 8);
            continue;
        }
        let moments = Lognormal::of_moments(&levels).unwrap();
        near(moments.median, &case["moments"][0], 1e-12, name);
        near(moments.dispersion, &case["moments"][1], 1e-12, name);
        let logs: Vec<f64> = levels.iter().map(|level| libm::log(*level)).collect();
        let Some(test) = test_normality(&logs) else {
            assert!(levels.len() < 8);
            continue;
        };
        near(test.anderson_darling, &case["anderson_darling"], 1e-10, name);
        near(test.p_value, &case["anderson_darling_p"], 1e-9, name);
        near(test.largest_difference, &case["largest_difference"], 1e-12, name);
    }
}

#[test]
fn peer_clouds_agree_with_statsmodels() {
    for case in reference()["clouds"].as_array().unwrap() {
        let name = case["name"].as_str().unwrap();
        let known = case["known"].as_array().unwrap().iter().map(|k| match k.as_str().unwrap() {
            "exactly" => Known::Exactly,
            "at most" => Known::AtMost,
            _ => Known::AtLeast,
        });
        let levels = numbers(&case["levels"]);
        let points: Vec<CloudPoint> = levels
            .iter()
            .zip(numbers(&case["demands"]))
            .zip(known)
            .map(|((&level, demand), known)| CloudPoint { level, demand, known })
            .collect();
        let fragility = Fragility::of_cloud(&points, number(&case["limit"])).unwrap();
        near(fragility.fit().intercept(), &case["intercept"], 1e-9, name);
        near(fragility.fit().slope(), &case["slope"], 1e-9, name);
        near(fragility.fit().sigma(), &case["sigma"], 1e-9, name);
        near(fragility.fit().log_likelihood(), &case["log_likelihood"], 1e-10, name);
        near(fragility.curve().median, &case["median"], 1e-9, name);
        near(fragility.curve().dispersion, &case["dispersion"], 1e-9, name);
        check_band(&fragility, case, 1e-7);
        // The band at the median and the intervals tell the same certainty, roughly.
        let [low, high] = fragility.median_interval(0.9);
        let median = fragility.curve().median;
        assert!(low.unwrap() < median && median < high.unwrap());
        let [low, high] = fragility.dispersion_interval(0.9);
        let dispersion = fragility.curve().dispersion;
        assert!(low.unwrap() < dispersion && dispersion < high.unwrap());
    }
}

/// Standard errors, intervals and band of a clustered fit.
fn check_clustered(fragility: &Fragility, case: &Value, name: &str, tolerance: f64) {
    near(fragility.curve().median, &case["median"], 1e-9, name);
    near(fragility.curve().dispersion, &case["dispersion"], 1e-9, name);
    let [of_median, of_dispersion] = fragility.standard_errors();
    near(of_median, &case["se_ln_median"], tolerance, name);
    near(of_dispersion, &case["se_dispersion"], tolerance, name);
    for (found, expected) in [
        (fragility.median_interval(0.9), numbers(&case["median_interval"])),
        (fragility.dispersion_interval(0.9), numbers(&case["dispersion_interval"])),
    ] {
        for (found, expected) in found.iter().zip(expected) {
            let found = found.unwrap();
            assert!((found / expected - 1.0).abs() < tolerance, "{name}: {found} for {expected}");
        }
    }
}

fn indices(value: &Value) -> Vec<usize> {
    value.as_array().unwrap().iter().map(|v| v.as_u64().unwrap() as usize).collect()
}

#[test]
fn peer_clustered_probit_agrees_with_statsmodels() {
    for case in reference()["clustered"]["stripes"].as_array().unwrap() {
        let name = case["name"].as_str().unwrap();
        let rows = case["rows"].as_array().unwrap();
        let count = |row: &Value, i: usize| row[i].as_u64().unwrap();
        let of = |row: &Value| Stripe {
            level: number(&row[1]),
            runs: count(row, 2),
            exceeded: count(row, 3),
        };
        let stripes: Vec<Stripe> = rows.iter().map(of).collect();
        let records: Vec<usize> = rows.iter().map(|row| count(row, 0) as usize).collect();
        let fragility = Fragility::of_stripes_by_record(&stripes, &records).unwrap();
        check_clustered(&fragility, case, name, 1e-8);
        check_band(&fragility, case, 1e-9);
        near(fragility.fit().log_likelihood(), &case["log_likelihood"], 1e-11, name);
        // Taken as independent, the same counts claim a certainty that they do not have.
        let independent = Fragility::of_stripes(&stripes).unwrap();
        assert_eq!(independent.certainty(), &Certainty::Independent);
        near(independent.standard_errors()[0], &case["naive_se_ln_median"], 1e-8, name);
        assert!(fragility.standard_errors()[0] > 1.5 * independent.standard_errors()[0]);
        assert_eq!(independent.curve(), fragility.curve());
    }
}

#[test]
fn peer_clustered_capacities_and_cloud_agree_with_scipy() {
    let reference = reference();
    let case = &reference["clustered"]["capacities"];
    let reached = case["reached"].as_array().unwrap().iter().map(|r| r.as_bool().unwrap());
    let levels = numbers(&case["levels"]).into_iter();
    let capacities: Vec<Capacity> =
        levels.zip(reached).map(|(level, reached)| Capacity { level, reached }).collect();
    let records = indices(&case["records"]);
    let fragility = Fragility::of_capacities_by_record(&capacities, &records).unwrap();
    // The peer's scores are by differences.
    check_clustered(&fragility, case, "capacities", 1e-6);
    let case = &reference["clustered"]["cloud"];
    let points: Vec<CloudPoint> = numbers(&case["levels"])
        .into_iter()
        .zip(numbers(&case["demands"]))
        .map(|(level, demand)| CloudPoint { level, demand, known: Known::Exactly })
        .collect();
    let records = indices(&case["records"]);
    let fragility =
        Fragility::of_cloud_by_record(&points, number(&case["limit"]), &records).unwrap();
    check_clustered(&fragility, case, "cloud", 1e-6);
}

/// What runs gave notice of is told of the rows that are kept, each kind once with its first run; a kind of another
/// version is none.
#[test]
fn notices_of_runs_are_one_a_kind() {
    let mut table = Table::default();
    table.texts("record", ["a", "b", "c", "d"].map(str::to_owned).to_vec());
    table.numbers("slider.radius", "m", vec![1.0, 1.0, 2.0, 2.0]);
    let cells = ["", "gap_exceeded;close_call", "of_tomorrow;gap_exceeded", "gap_exceeded"];
    table.texts("warnings", cells.map(str::to_owned).to_vec());
    let told = |keep: &[String]| {
        let request = FragilityRequest {
            table: &table,
            source_name: "runs",
            demand: "peak",
            limit: None,
            measure: None,
            units: None,
            fit_to: None,
            floor: None,
            cap: None,
            keep,
            bootstrap: None,
        };
        let notice = |notice: Notice| (notice.kind, notice.severity(), notice.message);
        noticed(&request).unwrap().into_iter().map(notice).collect::<Vec<_>>()
    };
    let gap = |said: &str| (NoticeKind::GapExceeded, Severity::Severe, said.to_owned());
    let call = "1 of 4 runs, the first of them b".to_owned();
    let call = (NoticeKind::CloseCall, Severity::Warning, call);
    assert_eq!(told(&[]), [gap("3 of 4 runs, the first of them b"), call]);
    assert_eq!(told(&["slider.radius=2 m".to_owned()]), [gap("2 of 2 runs, the first of them c")]);
}

/// The two components of a pair are one earthquake's: runs are clustered by pair where a table tells it.
#[test]
fn peer_runs_of_pairs_agree_with_statsmodels_clustered_by_pair() {
    let reference = reference();
    let case = &reference["clustered"]["pairs"];
    let rows: Vec<Vec<f64>> = case["rows"].as_array().unwrap().iter().map(numbers).collect();
    let mut table = Table::default();
    let name = |row: &Vec<f64>| format!("r{}-{}", row[0], row[1]);
    table.texts("record", rows.iter().map(name).collect());
    table.numbers("level", "m/s2", rows.iter().map(|row| row[2]).collect());
    table.numbers("peak", "m", rows.iter().map(|row| 0.1 + 0.1 * row[3]).collect());
    let fitted = |table: &Table| {
        let request = FragilityRequest {
            table,
            source_name: "runs",
            demand: "peak",
            limit: Some(0.15),
            measure: Some("PGA"),
            units: None,
            fit_to: Some(FitTo::Counts),
            floor: None,
            cap: None,
            keep: &[],
            bootstrap: None,
        };
        run_fragility(&request, &Engine::unwatched()).unwrap()
    };
    let by_record = fitted(&table);
    check_clustered(&by_record.fragility, &case["component"], "by record", 1e-8);
    assert_eq!(by_record.clustered_by, "record");
    table.texts("pair", rows.iter().map(|row| format!("r{}", row[0])).collect());
    let by_pair = fitted(&table);
    check_clustered(&by_pair.fragility, &case["pair"], "by pair", 1e-8);
    assert_eq!(by_pair.clustered_by, "pair");
    assert_eq!(by_pair.fragility.certainty(), &Certainty::Clustered { records: 12 });
    // Counts of a pair are added up first: the last bit may differ.
    let [a, b] = [&by_pair, &by_record].map(|run| run.fragility.curve().median);
    assert!((a / b - 1.0).abs() < 1e-13, "{a} {b}");
}

/// One observation a record is independence; one record tells nothing of the scatter between records.
#[test]
fn clusters_of_one_are_independent() {
    let capacities =
        [0.3, 0.4, 0.55, 0.7, 0.5].map(|level| Capacity { level, reached: level < 0.6 });
    let alone = Fragility::of_capacities(&capacities).unwrap();
    let own = Fragility::of_capacities_by_record(&capacities, &[4, 2, 0, 1, 3]).unwrap();
    assert_eq!(own, alone);
    let one = Fragility::of_capacities_by_record(&capacities, &[0; 5]);
    assert!(matches!(one, Err(FitError::TooFew { found: 1, .. })), "{one:?}");
    // Five runs in one row are not one observation.
    let stripe = |level, exceeded| Stripe { level, runs: 5, exceeded };
    let stripes = [stripe(0.2, 1), stripe(0.3, 2), stripe(0.5, 4)];
    let clustered = Fragility::of_stripes_by_record(&stripes, &[0, 1, 2]).unwrap();
    assert_eq!(clustered.certainty(), &Certainty::Clustered { records: 3 });
}

/// Draws of records scatter as the sandwich says, and the same seed gives the same.
#[test]
fn prop_bootstrap_over_records_is_near_the_sandwich() {
    let reference = reference();
    let case = &reference["clustered"]["stripes"][0];
    let rows = case["rows"].as_array().unwrap();
    let count = |row: &Value, i: usize| row[i].as_u64().unwrap();
    let stripes: Vec<Stripe> = rows
        .iter()
        .map(|row| Stripe { level: number(&row[1]), runs: count(row, 2), exceeded: count(row, 3) })
        .collect();
    let records: Vec<usize> = rows.iter().map(|row| count(row, 0) as usize).collect();
    let sandwich = Fragility::of_stripes_by_record(&stripes, &records).unwrap();
    let drawn = sandwich.clone().bootstrapped(1000, 1, &Engine::unwatched()).unwrap();
    let Certainty::Bootstrap { records, curves, failed } = drawn.certainty() else {
        panic!("a bootstrap");
    };
    assert_eq!((*records, curves.len(), *failed), (20, 1000, 0));
    for (found, expected) in drawn.standard_errors().iter().zip(sandwich.standard_errors()) {
        // The sandwich has its correction and 1000 draws scatter by 2 %.
        assert!((found / expected - 1.0).abs() < 0.15, "{found} for {expected}");
    }
    let [low, high] = drawn.median_interval(0.9).map(Option::unwrap);
    assert!(low < sandwich.curve().median && sandwich.curve().median < high);
    let [low, high] = drawn.band(0.5, 0.9);
    assert!(0.5 < low && low < high && high < 0.95);
    assert_eq!(sandwich.clone().bootstrapped(1000, 1, &Engine::unwatched()).unwrap(), drawn);
    assert_ne!(sandwich.bootstrapped(1000, 2, &Engine::unwatched()).unwrap(), drawn);
}

/// Without censoring and with equal weights: mean and standard deviation with n.
#[test]
fn uncensored_fit_is_mean_and_deviation() {
    let values = [1e6 + 1.0, 1e6 + 2.0, 1e6 + 4.0, 1e6 + 9.0];
    let data = values.map(|y| Observation { x: 0.0, y, known: Known::Exactly, weight: 2.5 });
    let fit = Fit::new(&data, false).unwrap();
    assert!((fit.intercept() - 1e6 - 4.0).abs() < 1e-8, "{}", fit.intercept());
    assert!((fit.sigma() - 9.5_f64.sqrt()).abs() < 1e-9, "{}", fit.sigma());
    assert_eq!(fit.slope(), 0.0);
}

/// Baker's closed form: two levels are fitted exactly, so the curve goes through both shares.
#[test]
fn two_stripes_are_met() {
    let stripes =
        [(0.2, 3), (0.5, 16)].map(|(level, exceeded)| Stripe { level, runs: 20, exceeded });
    let fragility = Fragility::of_stripes(&stripes).unwrap();
    let curve = fragility.curve();
    for stripe in &stripes {
        let share = stripe.exceeded as f64 / 20.0;
        assert!((curve.probability(stripe.level) - share).abs() < 1e-12);
        assert!((curve.intensity(share) / stripe.level - 1.0).abs() < 1e-11);
    }
    let test = test_counts(&curve, &stripes);
    assert!(test.deviance.abs() < 1e-12 && test.p_value.is_none());
    assert_eq!(curve.probability(0.0), 0.0);
}

#[test]
fn data_that_cannot_tell_are_refused() {
    let of = |rows: &[(f64, u64, u64)]| {
        let stripe = |&(level, runs, exceeded)| Stripe { level, runs, exceeded };
        Fragility::of_stripes(&rows.iter().map(stripe).collect::<Vec<_>>()).map(|_| ())
    };
    assert_eq!(
        of(&[(0.1, 10, 0), (0.2, 12, 0)]),
        Err(FitError::NoneExceeds { runs: 22, highest: 0.2 })
    );
    assert_eq!(
        of(&[(0.1, 10, 10), (0.2, 5, 5)]),
        Err(FitError::AllExceed { runs: 15, lowest: 0.1 })
    );
    assert_eq!(of(&[(0.1, 10, 4)]), Err(FitError::OneLevel { level: 0.1 }));
    let separated = Err(FitError::Separated { below: 0.1, above: 0.2 });
    assert_eq!(of(&[(0.1, 10, 0), (0.2, 5, 5)]), separated);
    // One level divided, nothing overlaps: the likelihood still grows with the slope.
    let separated = Err(FitError::Separated { below: 0.2, above: 0.2 });
    assert_eq!(of(&[(0.1, 10, 0), (0.2, 5, 3), (0.3, 7, 7)]), separated);
    assert_eq!(of(&[(0.1, 10, 7), (0.2, 10, 3)]), Err(FitError::Falls));
    assert_eq!(of(&[(0.1, 10, 10), (0.2, 10, 0)]), Err(FitError::Falls));
    assert!(matches!(of(&[(0.1, 3, 4), (0.2, 3, 1)]), Err(FitError::OutOfRange { .. })));
    assert!(matches!(of(&[(0.0, 3, 1), (0.2, 3, 1)]), Err(FitError::OutOfRange { .. })));
    assert!(matches!(of(&[]), Err(FitError::TooFew { .. })));
    // Overlap of one run is enough.
    assert_eq!(of(&[(0.1, 10, 1), (0.2, 10, 10), (0.05, 10, 0), (0.12, 10, 9)]), Ok(()));

    let capacity = |level, reached| Capacity { level, reached };
    let of = |capacities: &[Capacity]| Fragility::of_capacities(capacities).map(|_| ());
    let none = [capacity(1.0, false), capacity(2.0, false)];
    assert_eq!(of(&none), Err(FitError::NoneExceeds { runs: 2, highest: 2.0 }));
    assert!(matches!(of(&[capacity(1.0, true)]), Err(FitError::TooFew { found: 1, .. })));
    assert_eq!(of(&[capacity(1.0, true); 4]), Err(FitError::NoMaximum));
    assert!(matches!(of(&[capacity(f64::NAN, true); 2]), Err(FitError::OutOfRange { .. })));

    let point = |level, demand| CloudPoint { level, demand, known: Known::Exactly };
    let of = |points: &[CloudPoint]| Fragility::of_cloud(points, 0.1).map(|_| ());
    let line = [0.1, 0.2, 0.4, 0.8].map(|x| point(x, 3.0 * x * x));
    assert_eq!(of(&line), Err(FitError::NoMaximum));
    assert_eq!(of(&[1.0, 2.0, 3.0].map(|d| point(0.3, d))), Err(FitError::OneLevel { level: 0.3 }));
    let falling = [(0.1, 3.0), (0.2, 1.9), (0.3, 2.0), (0.4, 1.0)].map(|(x, d)| point(x, d));
    assert_eq!(of(&falling), Err(FitError::Falls));
    assert!(matches!(of(&line[..2]), Err(FitError::TooFew { found: 2, .. })));
    assert!(matches!(of(&[point(0.1, 0.0); 3]), Err(FitError::OutOfRange { .. })));
    let error = FitError::Separated { below: 0.1, above: 0.2 }.to_string();
    assert!(error.contains("none exceeds it below 0.1, all do above 0.2"), "{error}");
}

/// Scattered at random: whatever the counts, either a reason or a maximum whose neighbours are lower.
#[test]
fn prop_every_set_of_counts_has_a_maximum_or_a_reason() {
    let mut state = 7_u64;
    let mut draw = |n: u64| {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) % n
    };
    let (mut fitted, mut refused) = (0, 0);
    for _ in 0..3000 {
        let count = 1 + draw(5);
        let stripes: Vec<Stripe> = (0..count)
            .map(|i| {
                let runs = 1 + draw(6);
                let level = 0.1 + 0.07 * (i + draw(3)) as f64;
                Stripe { level, runs, exceeded: draw(runs + 1).min(runs) }
            })
            .collect();
        let likelihood = |curve: &Lognormal| -> f64 {
            let of = |stripe: &Stripe| {
                let z = libm::log(stripe.level / curve.median) / curve.dispersion;
                let (k, n) = (stripe.exceeded as f64, stripe.runs as f64);
                k * ln_normal_cdf(z) + (n - k) * ln_normal_cdf(-z)
            };
            stripes.iter().map(of).sum()
        };
        match Fragility::of_stripes(&stripes) {
            Ok(fragility) => {
                fitted += 1;
                let curve = fragility.curve();
                let top = likelihood(&curve);
                assert!(curve.median > 0.0 && curve.dispersion > 0.0);
                for (median, dispersion) in [(0.999, 1.0), (1.001, 1.0), (1.0, 0.999), (1.0, 1.001)]
                {
                    let other = Lognormal {
                        median: curve.median * median,
                        dispersion: curve.dispersion * dispersion,
                    };
                    assert!(likelihood(&other) <= top + 1e-12, "{stripes:?}");
                }
                let [low, high] = fragility.median_interval(0.9);
                assert!(low.is_none_or(|low| low < curve.median), "{stripes:?}");
                assert!(high.is_none_or(|high| high > curve.median), "{stripes:?}");
                let [low, high] = fragility.dispersion_interval(0.9);
                assert!(low.is_none_or(|low| low < curve.dispersion), "{stripes:?}");
                assert!(high.is_none_or(|high| high > curve.dispersion), "{stripes:?}");
            }
            Err(FitError::NoMaximum) => panic!("{stripes:?} is neither fitted nor explained"),
            Err(_) => refused += 1,
        }
    }
    assert!(fitted > 500 && refused > 500, "{fitted} fitted, {refused} refused");
}

#[test]
fn fractiles_interpolate_and_count() {
    let values = [4.0, 1.0, 3.0, 2.0, 5.0];
    let rising = sorted(&values);
    assert_eq!(rising, [1.0, 2.0, 3.0, 4.0, 5.0]);
    // Position p (n − 1): 0.16 × 4 = 0.64.
    let [low, middle, high] = fractiles(&values);
    assert!((low - 1.64).abs() < 1e-15 && middle == 3.0 && (high - 4.36).abs() < 1e-15);
    assert_eq!((fractile(&rising, 0.0), fractile(&rising, 1.0)), (1.0, 5.0));
    assert!(fractile(&[], 0.5).is_nan());
    // Two of five collapse: the median is still known, the 84 % fractile is not.
    let collapsed = [4.0, f64::INFINITY, 3.0, f64::INFINITY, 5.0, f64::NAN];
    assert_eq!(fractiles(&collapsed)[1..], [5.0, f64::INFINITY]);
    // 0.9 × 10 is 9 and no more, whatever its rounding; 0.9 × 44 = 39.6.
    assert_eq!(
        [needed(0.9, 10), needed(0.9, 44), needed(1.0, 3), needed(0.1 + 0.2, 10)],
        [9, 40, 3, 3]
    );
    assert_eq!(
        [held_by(&rising, 0.6), held_by(&rising, 0.61), held_by(&rising, 1.0)],
        [3.0, 4.0, 5.0]
    );
    assert_eq!(held_by(&rising, 0.0), f64::NEG_INFINITY);
}
