//! The `--json` object: its keys are a promise, its numbers finite or null, its warnings complete.

use crate::support::{Case, frame_model, rough_motion, run, run_times, summarise};
use serde_json::Value;
use slipstick::check::{ClosestCall, DecisionKind};
use slipstick::notice::{Notice, NoticeKind};
use slipstick::response::{Iterations, Method};

fn case() -> Case {
    run("mock-up", frame_model(2, 1.0), rough_motion(10.0, 0.01))
}

fn parsed(text: &str) -> Value {
    serde_json::from_str(text).expect("JSON")
}

/// Every key of the promise with the kind of its value: `n` number, `n?` number or null, `s` string,
/// `b` true or false, `l` list, `o?` object or null.
const PROMISED: &str = "
    slipstick s, model s, method s, samples n, dt_s n?, duration_s n,
    record.pga_m_per_s2 n, record.pgv_m_per_s n, record.pgd_m n, record.end_velocity_m_per_s n,
    peak_sliding_displacement_m n, peak_sliding_displacement_time_s n,
    max_sliding_displacement_m n, min_sliding_displacement_m n,
    residual_sliding_displacement_m n, sliding_at_end b, sliding_path_m n,
    peak_sliding_velocity_m_per_s n, sliding_time_s n,
    slip_count n, reversal_count n, stick_count n,
    block.peak_acceleration_m_per_s2 n, storeys l,
    storeys.0.peak_acceleration_m_per_s2 n, storeys.0.peak_displacement_m n,
    storeys.0.peak_drift_m n, storeys.1.peak_drift_ratio n?,
    storeys.0.peak_drift_velocity_m_per_s n,
    peak_base_shear_n n, peak_friction_force_n n, peak_slider_force_n n,
    base_shear_coefficient n, friction_coefficient_used n, slider_force_coefficient n,
    gap_ratio n?, overturning_ratio n?, contact_loss_s l, warnings l,
    checks.equilibrium_residual n, checks.friction_excess n, checks.energy_balance_error n,
    checks.closest_call o?";

fn assert_promise(object: &Value) {
    for entry in PROMISED.split(',') {
        let (path, kind) = entry.trim().split_once(' ').expect("path and kind");
        let pointer = format!("/{}", path.replace('.', "/"));
        let value = object.pointer(&pointer).unwrap_or_else(|| panic!("{path} is missing"));
        let fits = match kind {
            "n" => value.is_number(),
            "n?" => value.is_number() || value.is_null(),
            "s" => value.is_string(),
            "b" => value.is_boolean(),
            "l" => value.is_array(),
            _ => value.is_object() || value.is_null(),
        };
        assert!(fits, "{path} should be {kind}, is {value}");
    }
}

#[test]
fn every_promised_key_is_there_in_all_three_runs() {
    let nominal = case();
    let bound = |factor| {
        run_times("mock-up", frame_model(2, factor), rough_motion(10.0, 0.01), factor).summary
    };
    let object = parsed(&nominal.summary.clone().with_bounds(bound(0.8), bound(1.3)).to_json());
    assert_promise(&object);
    assert_promise(&object["bounds"]["lower"]);
    assert_promise(&object["bounds"]["upper"]);
    assert_eq!(object["bounds"]["upper"]["friction_factor"], 1.3);
    assert_eq!(object["samples"], 1001);
    assert_eq!(object["dt_s"], 0.01);
    assert_eq!(object["duration_s"], 10.0);
    assert_eq!(object["method"], "exact");
    assert!(object.get("iterations").is_none());
    let alone = parsed(&nominal.summary.to_json());
    assert!(alone.get("bounds").is_none());
    let d = &nominal.response.demands;
    assert_eq!(alone["peak_sliding_displacement_m"], d.peak_sliding_displacement_m);
    assert_eq!(alone["storeys"][1]["peak_drift_m"], d.storeys[1].peak_drift_m);
}

#[test]
fn the_keys_stand_in_the_promised_order() {
    let text = case().summary.to_json();
    let mut from = 0;
    for entry in PROMISED.split(',').filter(|entry| !entry.contains('.')) {
        let key = format!("\n  \"{}\":", entry.split_whitespace().next().expect("a key"));
        from += text[from..].find(&key).unwrap_or_else(|| panic!("{key} out of order"));
    }
}

#[test]
fn numbers_that_are_not_finite_are_null() {
    let mut summary = case().summary;
    summary.demands.peak_base_shear_n = f64::NAN;
    summary.demands.gap_ratio = Some(f64::INFINITY);
    summary.checks.equilibrium_residual = f64::NAN;
    let object = parsed(&summary.to_json());
    assert!(object["peak_base_shear_n"].is_null());
    assert!(object["gap_ratio"].is_null());
    assert!(object["checks"]["equilibrium_residual"].is_null());
}

#[test]
fn a_stepwise_run_reports_iterations_and_is_never_judged() {
    let mut case = case();
    case.response.method = Method::Stepwise;
    case.response.iterations = Some(Iterations { mean: 3.25, max: 9 });
    case.certificate.equilibrium_residual = 0.1;
    let summary = summarise_again(&case, &[]);
    let object = parsed(&summary.to_json());
    assert_eq!(object["iterations"]["mean"], 3.25);
    assert_eq!(object["iterations"]["max"], 9);
    assert!(object["checks"]["closest_call"].is_null());
    assert!(object["checks"]["holds"].is_null());
    assert!(!summary.check_failed());
    assert!(kinds(&summary.warnings).iter().all(|kind| *kind != "check_failed"));
}

fn summarise_again(case: &Case, given: &[Notice]) -> slipstick_report::Summary {
    summarise("m", &case.model, &case.motion, &case.response, &case.certificate, 1.0, given)
}

fn kinds(warnings: &[Notice]) -> Vec<&'static str> {
    warnings.iter().map(|warning| warning.kind.name()).collect()
}

#[test]
fn warnings_come_from_figures_solver_and_record() {
    let mut case = case();
    assert_eq!(kinds(&case.summary.warnings), ["gap_exceeded"]);

    case.certificate.energy_balance_error = f64::NAN;
    case.certificate.closest_call =
        Some(ClosestCall { margin: 9e-7, time_s: 2.5, kind: DecisionKind::Slip, interface: 0 });
    let solver = Notice::new(NoticeKind::SlipsAtStart, "it slips").at(0.0);
    let record = Notice::new(NoticeKind::FirstSampleNotZero, "it jumps");
    case.response.warnings = vec![solver.clone(), solver];
    let summary = summarise_again(&case, std::slice::from_ref(&record));
    assert_eq!(
        kinds(&summary.warnings),
        ["check_failed", "gap_exceeded", "close_call", "slips_at_start", "first_sample_not_zero"]
    );
    assert!(summary.warnings[0].message.contains("energy balance error n/a above the bound 1e-10"));
    assert!(summary.check_failed());
    assert_eq!(summary.warnings[2].time_s, Some(2.5));
    let object = parsed(&summary.to_json());
    assert_eq!(object["warnings"][4]["kind"], "first_sample_not_zero");
    assert!(object["warnings"][4]["time_s"].is_null());
    assert_eq!(object["checks"]["holds"], false);
}

#[test]
fn the_gap_is_passed_at_the_first_knot_beyond_it() {
    let case = case();
    let history = case.response.history.as_ref().expect("a history");
    let warning = &case.summary.warnings[0];
    let time_s = warning.time_s.expect("a time");
    for (t, s) in history.time_s.iter().zip(&history.sliding_displacement_m) {
        assert!(*t >= time_s || s.abs() <= 0.06, "beyond the gap at {t} s already");
    }
    let at = history.time_s.iter().position(|t| *t == time_s).expect("a knot");
    assert!(history.sliding_displacement_m[at].abs() > 0.06);
    assert!(warning.message.starts_with("the block slides past its gap of 60 mm: peak "));
}

#[test]
fn warnings_of_the_bounds_are_told_apart() {
    let nominal = case();
    let mut lower = nominal.summary.clone();
    let own = Notice::new(NoticeKind::ContactLost, "lifted").at(1.0);
    lower.warnings.push(own);
    let mut own = nominal.summary.clone();
    own.warnings.push(Notice::new(NoticeKind::CloseCall, "close").at(2.0));
    let summary = own.with_bounds(lower, nominal.summary.clone());
    let all: Vec<_> =
        summary.all_warnings().into_iter().map(|(run, w)| (run, w.kind.name())).collect();
    // The gravest first, whichever run it is of.
    let severe = [(None, "gap_exceeded"), (Some("lower"), "contact_lost")];
    assert_eq!(all, [&severe[..], &[(None, "close_call")]].concat());
}
