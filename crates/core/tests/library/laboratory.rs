//! The laboratory against NumPy and SciPy, and on real tests, which are not part of the repository:
//! those are looked for in `$SLIPSTICK_RECORDS`, else `../shared/records`, else skipped.

#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;
use slipstick::input::{self, Channel, Mapping};
use slipstick::laboratory::anderson::anderson;
use slipstick::laboratory::cyclic::{CyclicTest, KineticLaw, cyclic, estimates};
use slipstick::laboratory::free_vibration::{Motion, free_vibration};
use slipstick::laboratory::measured::Measured;
use slipstick::laboratory::metrics;
use slipstick::laboratory::shaking_table::{
    Builder, Instruments, Parameter, TableTest, shaking_table,
};
use slipstick::study::engine::Engine;

/// The folder, or `None` and a line that says so.
#[allow(clippy::disallowed_macros, reason = "tests say what they skip on their own output")]
fn experiments(test: &str) -> Option<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/records");
    let folder = std::env::var_os("SLIPSTICK_RECORDS").map_or(beside, PathBuf::from);
    if folder.join("experiments").is_dir() {
        return Some(folder.join("experiments"));
    }
    println!("skipped: {test}");
    None
}

fn reference(name: &str) -> Value {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/reference/laboratory");
    serde_json::from_str(&fs::read_to_string(folder.join(name)).unwrap()).unwrap()
}

fn number(value: &Value, key: &str) -> f64 {
    value[key].as_f64().unwrap_or_else(|| panic!("{key}"))
}

fn numbers(value: &Value, key: &str) -> Vec<f64> {
    value[key].as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect()
}

#[test]
fn peer_metrics() {
    let peer = reference("metrics.json");
    let (m, p) = (numbers(&peer, "measured"), numbers(&peer, "predicted"));
    let russell = metrics::russell(&m, &p).unwrap();
    for (key, found) in [
        ("peak_ratio", metrics::peak(&p).0 / metrics::peak(&m).0),
        ("rms_error", metrics::rms_error(&m, &p)),
        ("normalised_rms_error", metrics::rms_error(&m, &p) / metrics::rms(&m)),
        ("correlation", metrics::correlation(&m, &p).unwrap()),
        ("russell_magnitude", russell.magnitude),
        ("russell_phase", russell.phase),
        ("russell_comprehensive", russell.comprehensive),
        ("lag_samples", metrics::lag(&m, &p, 60).unwrap().samples),
    ] {
        let expected = number(&peer, key);
        assert!((found / expected - 1.0).abs() < 1e-9, "{key}: {found} {expected}");
    }
    let times_s: Vec<f64> = (0..m.len()).map(|i| 0.02 * i as f64).collect();
    for (key, found) in anderson(&times_s, &m, &p).unwrap().scores() {
        let expected = number(&peer["anderson"], key);
        // The peer's response spectra are peaks at twenty points a step.
        let slack = if key == "response_spectrum" { 0.02 } else { 1e-8 };
        assert!((found - expected).abs() < slack, "{key}: {found} {expected}");
    }
}

#[test]
fn peer_free_vibration() {
    let peer = reference("free_vibration.json");
    let values = numbers(&peer, "values");
    let times_s: Vec<f64> = (0..values.len()).map(|i| 0.01 * i as f64).collect();
    let found = free_vibration(&times_s, &values, Motion::Displacement);
    for (estimate, key, half) in [
        (&found.frequency, "frequency_hz", "frequency_half_width_hz"),
        (&found.damping_ratio, "damping_ratio", "damping_ratio_half_width"),
    ] {
        let (expected, half) = (number(&peer, key), number(&peer, half));
        // The minimum is found to far less than its uncertainty.
        assert!((estimate.value().unwrap() - expected).abs() < 1e-3 * half, "{estimate:?}");
        let [low, high] = estimate.interval().unwrap();
        // The profile of a nearly linear model, times the correlation length of the noise.
        let width = 0.5 * (high - low) / half / found.correlation_length.sqrt();
        assert!((width - 1.0).abs() < 0.02, "{key}: {width}");
    }
}

/// The tests of a banded friction damper with backlash (Coble, Huggins, Cao, Ricles, Downey 2022):
/// 30 lb of tension, strokes of 0.5 and 1.5 in at 1 Hz and of 0.2 in at 2 Hz.
#[test]
fn file_cyclic_tests_of_a_friction_damper() {
    let Some(folder) = experiments("file_cyclic_tests_of_a_friction_damper") else { return };
    let (inch, kip) = (0.0254, 4_448.221_615_260_5);
    let mut fits = Vec::new();
    for name in ["1Hz30lbtension0.5amplitude", "1Hz30lbtension1.5amplitude"] {
        let path = folder.join(format!("friction_damper_cyclic/{name}.json"));
        let data: Value = serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap();
        let column = |k: usize, factor: f64| -> Vec<f64> {
            let rows = data["data"].as_array().unwrap();
            rows.iter().map(|row| factor * row[k].as_f64().unwrap()).collect()
        };
        let (t, x, f) = (column(0, 1.0), column(1, inch), column(2, kip));
        let test = CyclicTest {
            times_s: &t,
            displacement_m: &x,
            force_n: &f,
            slack_m: None,
            spring: false,
            damper: false,
            law: KineticLaw::Coulomb,
            zero_known: true,
        };
        let fit = cyclic(&test).unwrap();
        // Seven seconds at 1 Hz, which swell and die.
        assert!((3..=6).contains(&fit.cycles.len()), "{}", fit.cycles.len());
        for cycle in &fit.cycles {
            // The amplitude of the last ones falls, which moves their reversals.
            assert!((cycle.frequency_hz - 1.0).abs() < 0.1);
            // The loops stand between 1.7 and 3.2 kip.
            for force_n in cycle.kinetic_n {
                assert!((1.2..4.0).contains(&(force_n / kip)), "{cycle:?}");
            }
        }
        // The force takes several millimetres after each reversal to build up: the backlash.
        assert!((2e-3..16e-3).contains(&fit.slack_m), "{}", fit.slack_m);
        fits.push(fit);
    }
    let all: Vec<_> = fits.iter().collect();
    let found = estimates(&all, 4.0 * kip, None);
    let kinetic = &found.estimates[0];
    let [low, high] = kinetic.interval().unwrap();
    assert!(low > 1.7 * kip && high < 3.2 * kip, "{kinetic:?}");
}

/// A base-isolated building on a shaking table (Canoga Park record): rubber bearings, not sliders,
/// seen as spring, damper and friction. Masses are unknown; only ratios to them are told.
#[test]
fn file_isolated_building_on_a_shaking_table() {
    let Some(folder) = experiments("file_isolated_building_on_a_shaking_table") else { return };
    let read = |name: &str| -> Vec<String> {
        let path = folder.join(format!("bi_bncs_isolated_building/CNP100_{name}.txt"));
        let text = fs::read_to_string(path).unwrap();
        text.split_whitespace().map(str::to_owned).collect()
    };
    let (u, a, d) = (read("u"), read("a1"), read("d1"));
    let mut text = "time_s,u,a,d\n".to_owned();
    for i in 0..4000 {
        text.push_str(&format!("{:.3},{},{},{}\n", 0.005 * i as f64, u[i], a[i], d[i]));
    }
    let options = [
        "table_acceleration=u [m/s2]",
        "block_acceleration=a [m/s2]",
        "sliding_displacement=d [m]",
    ];
    let mapping = Mapping::parse(None, &options.map(str::to_owned)).unwrap();
    let measured = Measured::read("cnp100.csv", text.as_bytes(), &mapping).unwrap();
    let start = "[block]\nmass = \"1 t\"\n[slider]\nstatic_friction = 0.02\nkinetic_friction = 0.02\n\
                 spring = \"8 kN/m\"\ndamper = \"500 N s/m\"\n";
    let analysis = input::parse("start.toml", start, &[]).unwrap();
    let names =
        ["slider.static_friction", "slider.kinetic_friction", "slider.spring", "slider.damper"];
    let parameters: Vec<Parameter> =
        names.iter().map(|n| Parameter::parse(n, &analysis, &names).unwrap()).collect();
    let builder = Builder::new("start.toml", start, &[], &parameters);
    let test = TableTest {
        measured: &measured,
        parameters: &parameters,
        build: &|values: &[f64]| builder.model(values),
        start: None,
        using: Some(vec![Channel::SlidingDisplacement]),
        instruments: &Instruments::exact(),
        seed: 1,
    };
    let found = shaking_table(&test, &Engine::unwatched()).unwrap();
    let sliding = found.comparison.get(Channel::SlidingDisplacement).unwrap();
    assert!(sliding.metrics.correlation.unwrap() > 0.95, "{:?}", sliding.metrics);
    // Period of the isolated building, 2π √(M/K): the record shows 0.40 Hz.
    let hz = (found.values[2] / 1000.0).sqrt() / core::f64::consts::TAU;
    assert!((0.33..0.47).contains(&hz), "{hz} {:?}", found.estimates);
    // What a model leaves of another kind of bearing has a memory.
    assert!(found.correlation_length > 5.0);
}

/// Any text as measured file, mapping, bound or parameter is an error or a value, never a panic.
#[test]
fn prop_any_text_ends_well() {
    use slipstick::laboratory::compare::{Within, compare};
    use slipstick::response::Method;
    use slipstick::study::Random;

    let model =
        "[block]\nmass = \"1 t\"\n[slider]\nstatic_friction = 0.2\nkinetic_friction = 0.1\n";
    let analysis = input::parse("m.toml", model, &[]).unwrap();
    let words = [
        "time_s",
        "table_acceleration_g",
        "sliding_displacement (mm)",
        "a",
        "€",
        ",",
        ",",
        "\n",
        "\n",
        "\n",
        "0",
        "1",
        "-2.5",
        "1e300",
        "nan",
        "[g]",
        "[",
        "]",
        "'",
        " - ",
        "*",
        "@",
        "=",
        "..",
        "\"",
        "#1",
        "#0",
        "slider.tilt",
        "peak_ratio.",
        "5 ms",
        " ",
        "\u{0}",
    ];
    for seed in 0..4000 {
        let mut random = Random::new(seed);
        let length = 1 + (24.0 * random.uniform()) as usize;
        let text: String =
            (0..length).map(|_| words[(words.len() as f64 * random.uniform()) as usize]).collect();
        let file = format!(
            "time_s,table_acceleration_g,block_acceleration_g\n{text}\n0,1,2\n1,2,3\n2,1,0\n"
        );
        for bytes in [text.as_bytes(), file.as_bytes()] {
            if let Ok(measured) = Measured::read("m.csv", bytes, &Mapping::default()) {
                let _ = compare(&measured, &analysis.model, Method::Exact);
            }
        }
        let _ = Mapping::parse(Some(("map.toml", &text)), &[]);
        let _ = Mapping::parse(None, &[text.clone(), format!("force={text}")]);
        let _ = Within::parse(&text);
        let _ = Within::parse(&format!("peak_ratio.force={text}"));
        let _ = Parameter::parse(&text, &analysis, &[&text]);
        let _ = Parameter::parse(&format!("slider.tilt={text}"), &analysis, &[]);
    }
}
