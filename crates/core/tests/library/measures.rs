//! Spectra, intensity measures and processing against other programs: NumPy, SciPy, eqsig, pyrotd
//! (`data/reference/measures`).

#![allow(clippy::unwrap_used, clippy::expect_used)]

use serde_json::Value;
use slipstick::motion::intensity::{IntensityMeasures, Measure, RotD};
use slipstick::motion::processing::{Band, Step};
use slipstick::motion::{GroundMotion, spectrum};

fn folder() -> std::path::PathBuf {
    std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn expected() -> Value {
    let path = folder().join("data/reference/measures/expected.json");
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

fn record(name: &str) -> GroundMotion {
    let text = std::fs::read_to_string(folder().join("examples/records").join(name)).unwrap();
    let values = text.lines().filter(|line| !line.starts_with('#'));
    let values = values.filter_map(|line| line.trim().parse::<f64>().ok()).map(|a| a * 9.80665);
    GroundMotion::evenly_spaced(0.01, values.collect(), None).unwrap()
}

fn list(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect()
}

fn close(what: &str, found: f64, expected: f64, tolerance: f64) {
    let error = (found - expected).abs() / expected.abs();
    assert!(error <= tolerance, "{what}: {found}, expected {expected}, off by {error:e}");
}

/// Matrix exponentials at a sixteenth of a sample and roots of the velocity: 1e-9.
#[test]
fn peer_spectra_by_matrix_exponentials() {
    let (expected, motion) = (expected(), record("taft-111.txt"));
    let (periods_s, damping) = (list(&expected["periods_s"]), list(&expected["damping_ratios"]));
    let [sd, sv, sa] = ["sd_m", "sv_m_per_s", "sa_m_per_s2"].map(|key| list(&expected[key]));
    let (times_s, a) = (motion.times_s(), motion.horizontal_m_per_s2());
    let even = spectrum(times_s, a, &periods_s, &damping).unwrap();
    // The same motion with a sample that changes nothing is uneven: the other path.
    let (mut more_s, mut b) = (times_s.to_vec(), a.to_vec());
    more_s.insert(1, 0.004);
    b.insert(1, a[0] + (a[1] - a[0]) * 0.4);
    let uneven = spectrum(&more_s, &b, &periods_s, &damping).unwrap();
    for (i, (even, uneven)) in even.ordinates.iter().zip(&uneven.ordinates).enumerate() {
        let at = format!("T {} ξ {}", periods_s[i % 10], damping[i / 10]);
        for found in [even, uneven] {
            close(&format!("Sd {at}"), found.sd_m, sd[i], 1e-9);
            close(&format!("Sv {at}"), found.sv_m_per_s, sv[i], 1e-9);
            close(&format!("Sa {at}"), found.sa_m_per_s2, sa[i], 1e-9);
        }
    }
}

/// eqsig takes peaks at samples, so that its ordinates are lower at short periods; pyrotd filters
/// by FFT and interpolates.
#[test]
fn peer_spectra_by_eqsig_and_pyrotd() {
    let (expected, motion) = (expected(), record("taft-111.txt"));
    let periods_s = list(&expected["periods_s"]);
    let (times_s, a) = (motion.times_s(), motion.horizontal_m_per_s2());
    let found = spectrum(times_s, a, &periods_s, &[0.05]).unwrap();
    let eqsig = list(&expected["eqsig_psa_5_percent"]);
    let pyrotd = list(&expected["pyrotd_psa_5_percent"]);
    for (i, ordinates) in found.ordinates.iter().enumerate() {
        let at = format!("T {}", periods_s[i]);
        let coarse = 0.01 / periods_s[i];
        // A peak between samples is at most 1 − cos(π h/T) above both.
        let tolerance = 5.0 * coarse * coarse + 1e-6;
        close(&format!("eqsig {at}"), eqsig[i], ordinates.psa_m_per_s2, tolerance);
        close(&format!("pyrotd {at}"), pyrotd[i], ordinates.psa_m_per_s2, 0.01 + tolerance);
    }
}

#[test]
fn peer_rotated_spectra_by_pyrotd() {
    let expected = expected();
    let (x, y) = (record("taft-111.txt"), record("taft-021.txt"));
    let periods_s = list(&expected["periods_s"]);
    let [median, largest] = ["50", "100"].map(|p| list(&expected["pyrotd_rotd"][p]));
    for i in [3, 6, 8] {
        let measure = Measure::PSa { period_s: periods_s[i], damping_ratio: 0.05 };
        let rotated = RotD::of(&measure, &x, &y).unwrap();
        let at = format!("T {}", periods_s[i]);
        close(&format!("RotD50 {at}"), rotated.median(), median[i], 0.01);
        close(&format!("RotD100 {at}"), rotated.largest(), largest[i], 0.01);
    }
}

/// Integrals on samples 50 times finer, by the trapezium rule: its error is 1e-4 of what a sample
/// contributes.
#[test]
fn peer_integrals_by_numpy() {
    let (expected, motion) = (expected(), record("taft-111.txt"));
    let found = IntensityMeasures::of(&motion);
    let fine = &expected["measures"]["fine"];
    let mut compared = 0;
    for (measure, column, value) in found.columns() {
        let Some(expected) = fine[column].as_f64() else { continue };
        // The uniform duration is counted in steps of 0.2 ms, of which each crossing may miss one.
        let tolerance = if column.starts_with("uniform") { 2e-3 } else { 2e-5 };
        close(&measure.to_string(), value, expected, tolerance);
        compared += 1;
    }
    assert_eq!(compared, 10);
    let eqsig = &expected["measures"]["eqsig"];
    close("Arias", found.arias_m_per_s, eqsig["arias_m_per_s"].as_f64().unwrap(), 0.01);
    close("CAV", found.cav_m_per_s, eqsig["cav_m_per_s"].as_f64().unwrap(), 0.005);
    close("Tm", found.tm_s, expected["measures"]["tm_s"].as_f64().unwrap(), 1e-12);
    close("Housner", found.housner_m, expected["housner_m"].as_f64().unwrap(), 1e-9);
    close("ASI", found.asi_m_per_s, expected["asi_m_per_s"].as_f64().unwrap(), 1e-9);
    close("VSI", found.vsi_m, expected["vsi_m"].as_f64().unwrap(), 1e-9);
    let average = Measure::parse("Sa_avg(0.5 s, 3 s)").unwrap().of(&motion);
    close("Sa_avg", average, expected["sa_avg_0.5s_3s"].as_f64().unwrap(), 1e-9);
}

/// SciPy's lsim of the analogue filter on samples 20 times finer.
#[test]
fn peer_fiv3_by_scipy() {
    let (expected, motion) = (expected(), record("taft-111.txt"));
    for (period, value) in expected["fiv3"].as_object().unwrap() {
        let measure = Measure::parse(&format!("FIV3({period} s)")).unwrap();
        close(period, measure.of(&motion), value.as_f64().unwrap(), 1e-5);
    }
}

#[test]
fn peer_filters_by_scipy() {
    let (expected, series) = (expected(), record("taft-111.txt").series());
    for case in expected["filters"].as_array().unwrap() {
        let corners = list(&case["corners_hz"]);
        let band = match case["kind"].as_str().unwrap() {
            "low" => Band::Low { corner_hz: corners[0] },
            "high" => Band::High { corner_hz: corners[0] },
            _ => Band::Pass { from_hz: corners[0], to_hz: corners[1] },
        };
        let order = case["order"].as_u64().unwrap() as usize;
        let found = Step::Filter { band, order }.apply(&series).unwrap();
        let peak = case["peak"].as_f64().unwrap();
        for (index, value) in list(&case["index"]).into_iter().zip(list(&case["value"])) {
            let error = (found.values()[index as usize] - value).abs() / peak;
            assert!(error < 1e-9, "{band:?} order {order} at {index}: off by {error:e}");
        }
    }
}

#[test]
fn peer_baselines_and_taper_by_numpy() {
    let (expected, series) = (expected(), record("taft-111.txt").series());
    for case in expected["baselines"].as_array().unwrap() {
        let degree = case["degree"].as_u64().unwrap() as usize;
        let found = Step::RemovePolynomial { degree }.apply(&series).unwrap();
        for (index, value) in list(&case["index"]).into_iter().zip(list(&case["value"])) {
            let error = (found.values()[index as usize] - value).abs();
            assert!(error < 1e-12, "degree {degree} at {index}: off by {error:e}");
        }
    }
    let found = Step::Taper { fraction: 0.05 }.apply(&series).unwrap();
    let taper = &expected["taper_5_percent"];
    for (index, value) in list(&taper["index"]).into_iter().zip(list(&taper["value"])) {
        let expected = value * series.values()[index as usize];
        assert!((found.values()[index as usize] - expected).abs() < 1e-14, "{index}");
    }
}

/// The same straight lines sampled five times finer have the same measures.
#[test]
fn subdivision_changes_no_measure() {
    let motion = record("el-centro-180.txt");
    let (dt_s, a) = (0.01, motion.horizontal_m_per_s2());
    let fine = a.windows(2).flat_map(|p| (0..5).map(|k| p[0] + (p[1] - p[0]) * f64::from(k) / 5.0));
    let fine = fine.chain(a.last().copied()).collect();
    let fine = GroundMotion::evenly_spaced(dt_s / 5.0, fine, None).unwrap();
    let (coarse, fine) = (IntensityMeasures::of(&motion), IntensityMeasures::of(&fine));
    for ((measure, column, c), (_, _, f)) in coarse.columns().into_iter().zip(fine.columns()) {
        // The Fourier transform is that of the samples: by sinc² another for the straight lines.
        close(&measure.to_string(), f, c, if column == "tm_s" { 0.02 } else { 1e-9 });
    }
}
