use core::f64::consts::{PI, TAU};

use super::*;
use crate::input::Mapping;
use crate::model::Model;
use crate::slider::Friction;
use crate::solver;

const G: f64 = 9.80665;

fn model() -> Model {
    Model::rigid_block(124.0, Friction::new(0.1, 0.08).unwrap()).unwrap()
}

fn table(n: usize) -> Vec<f64> {
    // Whole cycles in the window: the table comes to rest.
    let value = |t: f64| {
        let window = libm::sin(PI * t / 6.0);
        3.0 * libm::sin(TAU * t) * window * window
    };
    (0..n).map(|i| value(0.01 * i as f64)).collect()
}

/// A file whose block moves as the model says, in chosen units, sign and clock.
fn file(block: impl Fn(f64) -> f64, shift: usize) -> String {
    let a = table(600);
    let motion = GroundMotion::evenly_spaced(0.01, a.clone(), None).unwrap();
    let history = solver::exact(&model(), &motion).unwrap().history.unwrap();
    let mut text =
        "time_s,table_acceleration_m_per_s2,block_acceleration_m_per_s2,sliding_displacement_mm\n"
            .to_owned();
    for i in 0..600 {
        let knot = history.rows[i];
        let late = history.rows[i.saturating_sub(shift)];
        text.push_str(&format!(
            "{:.2},{:e},{:e},{:e}\n",
            0.01 * i as f64,
            a[i],
            block(history.block_acceleration_m_per_s2[late]),
            1e3 * history.sliding_displacement_m[knot]
        ));
    }
    text
}

fn compared(text: &str, options: &[&str]) -> (Measured, Comparison) {
    let options: Vec<String> = options.iter().map(|o| (*o).to_owned()).collect();
    let mapping = Mapping::parse(None, &options).unwrap();
    let measured = Measured::read("m.csv", text.as_bytes(), &mapping).unwrap();
    let comparison = compare(&measured, &model(), Method::Exact).unwrap();
    (measured, comparison)
}

fn kinds(text: &str) -> Vec<String> {
    compared(text, &[]).1.warnings.iter().map(|w| format!("{} {}", w.kind, w.message)).collect()
}

/// The block comes to rest 2e-9 s after a sample: at the sample it still slides.
#[test]
fn an_event_just_after_a_sample_is_not_seen_at_it() {
    let a = table(600);
    let motion = GroundMotion::evenly_spaced(0.01, a.clone(), None).unwrap();
    let events = solver::exact(&model(), &motion).unwrap().events;
    let stick = events.iter().find(|event| event.kind == crate::response::EventKind::Stick);
    let time_s = stick.unwrap().time_s - 2e-9;
    let before = (time_s / 0.01) as usize;
    let part = time_s / 0.01 - before as f64;
    let mut rows: Vec<(f64, f64)> =
        a.iter().enumerate().map(|(i, a)| (0.01 * i as f64, *a)).collect();
    rows.insert(before + 1, (time_s, a[before] + part * (a[before + 1] - a[before])));
    let text: String = rows.iter().map(|(t, a)| format!("{t:e},{a:e},0\n")).collect();
    let header = "time_s,table_acceleration_m_per_s2,block_acceleration_m_per_s2\n";
    let (_, comparison) = compared(&format!("{header}{text}"), &[]);
    let predicted = comparison.compared[0].pair.predicted[before + 1];
    assert!((predicted.abs() - 0.08 * G).abs() < 1e-9, "{predicted}");
}

#[test]
fn our_own_history_is_met_exactly() {
    let (_, comparison) = compared(&file(|a| a, 0), &[]);
    assert_eq!(comparison.compared.len(), 2);
    for Compared { pair, metrics } in &comparison.compared {
        assert_eq!(pair.times_s.len(), 600);
        assert_eq!(pair.at_samples, 600);
        // The file is written with all digits; times are k·dt in both.
        assert!(metrics.rms_error < 1e-12 * metrics.measured_rms, "{metrics:?}");
        assert!((metrics.peak_ratio.unwrap() - 1.0).abs() < 1e-12);
        assert_eq!(metrics.arrival_lag_s.map(|lag| lag.abs() < 1e-9), Some(true));
    }
    assert!(comparison.warnings.is_empty(), "{:?}", comparison.warnings);
    assert!(comparison.compared[0].metrics.anderson.unwrap().mean() > 9.999);
    assert!(comparison.compared[1].metrics.anderson.is_none());
    assert!(comparison.alignment.contains("nothing was interpolated"));
}

#[test]
fn wrong_units_signs_and_clocks_are_named() {
    let unit = kinds(&file(|a| a / G, 0));
    assert!(
        unit.iter()
            .any(|w| w
                .starts_with("unit_suspect the prediction of block_acceleration is 9.807 times")),
        "{unit:?}"
    );
    let sign = kinds(&file(|a| -a, 0));
    assert_eq!(sign.len(), 1, "{sign:?}");
    assert!(sign[0].starts_with("sign_suspect the measured block_acceleration runs against"));
    let clock = kinds(&file(|a| a, 25));
    assert_eq!(clock.len(), 1, "{clock:?}");
    assert!(
        clock[0].starts_with("clock_suspect the measured block_acceleration comes +0.25"),
        "{clock:?}"
    );
    // What the warnings ask for puts it right.
    let (_, back) = compared(&file(|a| -a, 25), &["block_acceleration=#3 * -1 @ -0.25 s"]);
    assert!(back.warnings.is_empty(), "{:?}", back.warnings);
    let Compared { pair, metrics } = &back.compared[0];
    assert!(metrics.rms_error < 0.05 * metrics.measured_rms);
    assert_eq!(pair.times_s.len(), 575);
}

#[test]
fn columns_of_accelerations_in_the_ratio_of_g() {
    let text = "time_s,table_acceleration_m_per_s2,block_acceleration_m_per_s2\n0,0,0\n1,0.5,4.9\n2,-0.4,1\n";
    let measured = Measured::read("m.csv", text.as_bytes(), &Mapping::default()).unwrap();
    let warnings = suspicions(&measured, &[]);
    assert_eq!(warnings[0].kind, NoticeKind::UnitSuspect);
    assert!(warnings[0].message.contains("9.800 times that of table_acceleration"));
}

/// Between knots the cubic has the right rates: s = t² − t³ is met to rounding.
#[test]
fn interpolation_of_a_cubic() {
    let times = [0.0, 0.4, 1.0];
    let history = History {
        time_s: times.to_vec(),
        sliding_displacement_m: times.map(|t| t * t - t * t * t).to_vec(),
        sliding_velocity_m_per_s: times.map(|t| 2.0 * t - 3.0 * t * t).to_vec(),
        block_acceleration_m_per_s2: times.map(|t| 2.0 - 3.0 * t).to_vec(),
        ..History::default()
    };
    let series = |channel| MeasuredSeries {
        zero_known: false,
        channel,
        origin: String::new(),
        times_s: vec![4.9, 5.0, 5.1, 5.4, 5.75, 6.0, 6.5],
        values: vec![0.0; 7],
    };
    let sliding = pair(&series(Channel::SlidingDisplacement), 5.0, &history).unwrap();
    assert_eq!((sliding.times_s.len(), sliding.at_samples), (5, 3));
    for (t, s) in sliding.times_s.iter().zip(&sliding.predicted) {
        assert!((s - (t * t - t * t * t)).abs() < 1e-12, "{t}");
    }
    let block = pair(&series(Channel::BlockAcceleration), 5.0, &history).unwrap();
    for (t, a) in block.times_s.iter().zip(&block.predicted) {
        assert!((a - (2.0 - 3.0 * t)).abs() < 1e-12, "{t}");
    }
    assert!(pair(&series(Channel::StoreyDisplacement(1)), 5.0, &history).is_none());
}
