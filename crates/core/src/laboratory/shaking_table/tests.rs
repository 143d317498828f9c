use core::f64::consts::TAU;

use super::*;
use crate::input::{Mapping, parse};
use crate::numerics::random::Random;

pub const BLOCK: &str = "[block]\nmass = \"124 kg\"\n[slider]\nstatic_friction = 0.12\n\
                         kinetic_friction = 0.1\nspring = \"20 kN/m\"\n";

/// The motion of a test, so many samples in each of 0.01 s: a sine of 1.3 Hz that swells and dies.
fn table(amplitude: f64, finer: usize) -> Vec<f64> {
    let value = |i: usize| {
        let t = 0.01 * i as f64 / finer as f64;
        amplitude * libm::sin(TAU * 1.3 * t) * libm::sin(TAU * t / 12.0)
    };
    (0..=399 * finer).map(value).collect()
}

/// A measured file: the response of a model with noise on block and slider.
fn made(text: &str, amplitude: f64, noise: [f64; 2], seed: u64) -> Measured {
    made_by(text, amplitude, noise, seed, [0.0; 2], 1)
}

/// The same with an offset of the displacement and noise of the table's accelerometer, under a table that
/// moves between the samples that are taken of it: so many times finer.
fn made_by(
    text: &str,
    amplitude: f64,
    noise: [f64; 2],
    seed: u64,
    [offset_m, of_table]: [f64; 2],
    finer: usize,
) -> Measured {
    let model = parse("true.toml", text, &[]).unwrap().model;
    let a = table(amplitude, finer);
    let motion = GroundMotion::evenly_spaced(0.01 / finer as f64, a.clone(), None).unwrap();
    let history = solver::exact(&model, &motion).unwrap().history.unwrap();
    let mut random = Random::new(seed);
    let mut file = "time_s,table_acceleration_m_per_s2,block_acceleration_m_per_s2,\
                    sliding_displacement_m"
        .to_owned();
    let storey = history.storeys > 0;
    file.push_str(if storey { ",storey1_acceleration_m_per_s2\n" } else { "\n" });
    for (i, &knot) in history.rows.iter().step_by(finer).enumerate() {
        let a = a[i * finer];
        let block = history.block_acceleration_m_per_s2[knot] + noise[0] * random.normal();
        let sliding = history.sliding_displacement_m[knot] + noise[1] * random.normal() + offset_m;
        let table = if of_table > 0.0 { a + of_table * random.normal() } else { a };
        file.push_str(&format!("{:.2},{table:e},{block:e},{sliding:e}", 0.01 * i as f64));
        if storey {
            let floor = history.storey_accelerations(knot)[0] + noise[0] * random.normal();
            file.push_str(&format!(",{floor:e}"));
        }
        file.push('\n');
    }
    Measured::read("made.csv", file.as_bytes(), &Mapping::default()).unwrap()
}

fn fitted(measured: &Measured, start: &str, fit: &[&str], seed: u64) -> TableFit {
    fitted_by(&Engine::unwatched(), measured, start, fit, &Instruments::exact(), seed).unwrap()
}

fn fitted_by(
    engine: &Engine<'_>,
    measured: &Measured,
    start: &str,
    fit: &[&str],
    instruments: &Instruments,
    seed: u64,
) -> Result<TableFit, TableError> {
    let analysis = parse("start.toml", start, &[]).unwrap();
    let parameters: Vec<Parameter> =
        fit.iter().map(|text| Parameter::parse(text, &analysis, fit).unwrap()).collect();
    let builder = Builder::new("start.toml", start, &[], &parameters);
    let build = |values: &[f64]| builder.model(values);
    let test = TableTest {
        measured,
        parameters: &parameters,
        build: &build,
        start: None,
        using: None,
        instruments,
        seed,
    };
    shaking_table(&test, engine)
}

/// The follower stops a fit after so many runs.
#[test]
fn a_fit_is_stopped() {
    let runs = core::sync::atomic::AtomicU64::new(0);
    let follow = |more| match runs.fetch_add(more, core::sync::atomic::Ordering::Relaxed) {
        10.. => core::ops::ControlFlow::Break(()),
        _ => core::ops::ControlFlow::Continue(()),
    };
    let engine = Engine::new(&follow);
    let measured = made(BLOCK, 3.0, [0.0; 2], 1);
    let found = fitted_by(&engine, &measured, BLOCK, &STATIC_KINETIC, &Instruments::exact(), 1);
    assert_eq!(found, Err(TableError::Stopped(Stopped)));
    assert_eq!(runs.into_inner(), 11);
}

const STATIC_KINETIC: [&str; 2] = ["slider.static_friction", "slider.kinetic_friction"];

#[test]
fn without_noise_the_truth_is_found() {
    let measured = made(BLOCK, 3.0, [0.0; 2], 1);
    let start = BLOCK.replace("0.12", "0.2").replace("0.1\n", "0.15\n").replace("20 kN", "30 kN");
    let fit = ["slider.static_friction", "slider.kinetic_friction", "slider.spring"];
    let found = fitted(&measured, &start, &fit, 1);
    for (value, truth) in found.values.iter().zip([0.12, 0.1, 20e3]) {
        assert!((value / truth - 1.0).abs() < 1e-5, "{:?}", found.values);
    }
    assert!(found.comparison.compared[0].metrics.normalised_rms_error.unwrap() < 1e-4);
}

/// A mock-up with a storey, a damper and a surface that is neither level nor even.
const STOREY: &str = "[block]\nmass = \"325 kg\"\n[slider]\nstatic_friction = 0.06\n\
                      kinetic_friction = 0.05\nspring = \"20 kN/m\"\ndamper = \"150 N s/m\"\n\
                      tilt = \"1 mrad\"\nasymmetry = 0.05\n[[storey]]\nmass = \"90 kg\"\n\
                      frequency = \"1.75 Hz\"\ndamping_ratio = 0.02\n";

/// What is fitted, a go each, and the truth. A tilt and an asymmetry do much the same, so that one
/// record hardly tells both.
const GOES: [(&str, &[(&str, f64)]); 4] = [
    (BLOCK, &[("slider.static_friction", 0.12), ("slider.kinetic_friction", 0.1)]),
    (STOREY, &[("slider.spring", 20e3), ("slider.damper", 150.0), ("slider.tilt", 1e-3)]),
    (STOREY, &[("slider.static_friction", 0.06), ("slider.asymmetry", 0.05)]),
    (
        STOREY,
        &[
            ("slider.kinetic_friction", 0.05),
            ("storey.1.frequency", 1.75),
            ("storey.1.damping_ratio", 0.02),
        ],
    ),
];

/// How many of some records have intervals that cover the truth, by parameter; the table moves straight
/// between its samples, or so many times finer.
fn covered(go: usize, finer: usize, seeds: u64) -> Vec<(&'static str, u64)> {
    let (text, truth) = GOES[go];
    covered_by(text, truth, [0.05, 3e-4], ([0.0; 2], finer), seeds)
}

/// A mock-up without a spring, whose surface is not level.
const TILTED: &str = "[block]\nmass = \"124 kg\"\n[slider]\nstatic_friction = 0.12\n\
                      kinetic_friction = 0.1\ntilt = \"1 mrad\"\n";

/// The same with what is wrong with the sensors.
fn covered_by(
    text: &str,
    truth: &[(&'static str, f64)],
    noise: [f64; 2],
    (wrong, finer): ([f64; 2], usize),
    seeds: u64,
) -> Vec<(&'static str, u64)> {
    let names: Vec<&str> = truth.iter().map(|(path, _)| *path).collect();
    let mut counts = vec![0; truth.len()];
    for seed in 0..seeds {
        let measured = made_by(text, 3.0, noise, seed, wrong, finer);
        let found = fitted(&measured, text, &names, seed);
        for (k, (_, truth)) in truth.iter().enumerate() {
            let inside =
                found.estimates[k].interval().is_some_and(|[l, h]| l <= *truth && *truth <= h);
            counts[k] += u64::from(inside);
        }
    }
    truth.iter().map(|(path, _)| *path).zip(counts).collect()
}

/// A displacement that is off by 12.3 mm.
fn covered_off_zero(seeds: u64) -> Vec<(&'static str, u64)> {
    let truth = [("slider.kinetic_friction", 0.1), ("slider.tilt", 1e-3)];
    covered_by(TILTED, &truth, [0.05, 3e-4], ([0.0123, 0.0], 5), seeds)
}

/// An accelerometer of the table whose noise is that of good sensors elsewhere.
fn covered_by_noisy_table(seeds: u64) -> Vec<(&'static str, u64)> {
    let truth = [("slider.kinetic_friction", 0.1), ("slider.spring", 20e3)];
    covered_by(BLOCK, &truth, [0.02, 1e-4], ([0.0, 0.05], 5), seeds)
}

/// An LVDT that shows 12.3 mm at rest became 8.6 mrad of tilt where 1.0 was true.
#[test]
fn an_offset_of_a_sensor_is_no_tilt() {
    let fit = ["slider.kinetic_friction", "slider.tilt"];
    let plain = fitted(&made_by(TILTED, 3.0, [0.05, 3e-4], 1, [0.0; 2], 5), TILTED, &fit, 1);
    let off = fitted(&made_by(TILTED, 3.0, [0.05, 3e-4], 1, [0.0123, 0.0], 5), TILTED, &fit, 1);
    let tilt = off.estimates[1].value().unwrap();
    assert!((tilt - 1e-3).abs() < 2e-4, "{tilt}");
    assert!((tilt / plain.estimates[1].value().unwrap() - 1.0).abs() < 1e-3);
    let (channel, offset_m) = off.offsets[0];
    assert_eq!(channel, Channel::SlidingDisplacement);
    assert!((offset_m - 0.0123).abs() < 1e-4, "{offset_m}");
    // The mapping that states the zero takes the offset away, whatever its sign.
    let below = fitted(&made_by(TILTED, 3.0, [0.05, 3e-4], 1, [-0.0123, 0.0], 5), TILTED, &fit, 1);
    for (found, zero) in [(&off, "=… - 1.2"), (&below, "=… + 1.2")] {
        let told = found.warnings.iter().find(|w| w.kind == NoticeKind::SensorOffset);
        assert!(told.is_some_and(|w| w.message.contains(zero)), "{:?}", found.warnings);
    }
    // What the accelerometer of the table is off by is tilt all the same, and that is said.
    let kinds: Vec<_> = plain.warnings.iter().map(|warning| warning.kind.name()).collect();
    assert_eq!(kinds, ["zero_not_stated"]);
    assert!(plain.warnings[0].message.contains("1 mg of it is 1 mrad"), "{:?}", plain.warnings);
}

/// What a transducer of the tests does.
#[derive(Clone, Copy, Debug)]
struct Transducer {
    gain: f64,
    lag_s: f64,
    zero: f64,
    /// From the first sample to the last.
    drift: f64,
    /// What one count is.
    count: f64,
    noise: f64,
}

impl Transducer {
    /// Drawn at random: gains within 5 %, clocks within 20 ms, any zero, a drift, counts of a coarse card.
    fn drawn(peak: f64, random: &mut Random) -> Self {
        let mut within = |most: f64| most * (2.0 * random.uniform() - 1.0);
        Self {
            gain: 1.0 + within(0.05),
            lag_s: within(0.02),
            zero: within(0.2 * peak),
            drift: within(0.04 * peak),
            count: peak / 512.0,
            noise: 0.005 * peak,
        }
    }

    fn shows(&self, values: &[f64], random: &mut Random) -> Vec<f64> {
        let last = (values.len() - 1) as f64;
        let shown = values.iter().enumerate().map(|(i, value)| {
            let drift = self.drift * (i as f64 / last - 0.5);
            let plain = self.gain * value + self.zero + drift + self.noise * random.normal();
            self.count * (plain / self.count).round()
        });
        shown.collect()
    }
}

/// A test as a laboratory makes it: block and displacement by transducers drawn at random, under a table that
/// moves between its samples.
fn of_laboratory(text: &str, seed: u64) -> (Measured, [Transducer; 2]) {
    let finer = 5;
    let model = parse("true.toml", text, &[]).unwrap().model;
    let a = table(3.0, finer);
    let motion = GroundMotion::evenly_spaced(0.01 / finer as f64, a.clone(), None).unwrap();
    let history = solver::exact(&model, &motion).unwrap().history.unwrap();
    let mut random = Random::new(seed);
    let times_s: Vec<f64> = (0..400).map(|i| 0.01 * f64::from(i)).collect();
    let mut transducers = Vec::new();
    let shown = [Channel::BlockAcceleration, Channel::SlidingDisplacement].map(|channel| {
        let at = |late_s: f64| {
            let times_s: Vec<f64> = times_s.iter().map(|t| t - late_s).collect();
            compare::predicted(channel, &history, &times_s).unwrap()
        };
        let peak = at(0.0).iter().fold(0.0, |most: f64, v| most.max(v.abs()));
        let transducer = Transducer::drawn(peak, &mut random);
        transducers.push(transducer);
        transducer.shows(&at(transducer.lag_s), &mut random)
    });
    let mut file = "time_s,table_acceleration_m_per_s2,block_acceleration_m_per_s2,\
                    sliding_displacement_m\n"
        .to_owned();
    for (i, t) in times_s.iter().enumerate() {
        let (table, [block, sliding]) = (a[i * finer], [shown[0][i], shown[1][i]]);
        file.push_str(&format!("{t:.2},{table:e},{block:e},{sliding:e}\n"));
    }
    let measured = Measured::read("made.csv", file.as_bytes(), &Mapping::default()).unwrap();
    (measured, [transducers[0], transducers[1]])
}

/// How many of some tests of a laboratory have intervals that cover the truth, or say that there is none, by
/// parameter of the model and of the transducers.
fn covered_of_laboratory(seeds: core::ops::Range<u64>) -> Vec<(String, u64)> {
    let truth = [
        ("slider.static_friction", 0.12),
        ("slider.kinetic_friction", 0.1),
        ("slider.spring", 20e3),
    ];
    let names = truth.map(|(path, _)| path);
    let mut counts: Vec<(String, u64)> = Vec::new();
    let mut count = |path: &str, holds: bool| match counts.iter_mut().find(|(p, _)| p == path) {
        Some((_, count)) => *count += u64::from(holds),
        None => counts.push((path.to_owned(), u64::from(holds))),
    };
    for seed in seeds {
        let (measured, transducers) = of_laboratory(BLOCK, seed);
        let engine = Engine::unwatched();
        let usual = Instruments::default();
        let found = fitted_by(&engine, &measured, BLOCK, &names, &usual, seed).unwrap();
        for (estimate, (path, truth)) in found.estimates.iter().zip(truth) {
            let covers = |[low, high]: [f64; 2]| low <= truth && truth <= high;
            count(path, estimate.interval().is_none_or(covers));
        }
        for (transducer, name) in
            transducers.iter().zip(["block_acceleration", "sliding_displacement"])
        {
            let truth = [
                ("gain", transducer.gain),
                ("lag", transducer.lag_s),
                ("drift", 0.5 * transducer.drift),
            ];
            for (what, truth) in truth {
                let path = format!("{name}.{what}");
                let estimate = found.instruments.iter().find(|e| e.path == path).unwrap();
                let covers = |[low, high]: [f64; 2]| low <= truth && truth <= high;
                count(&path, estimate.interval().is_some_and(covers));
            }
        }
    }
    counts
}

/// A gain of 1.03, a clock 12 ms late, a drifting transducer: narrow intervals that excluded the truth.
#[test]
fn prop_intervals_cover_whatever_the_transducers_do() {
    let counts = covered_of_laboratory(0..6);
    // At 95 % fewer than 4 of 6 have a chance of 2e-3.
    assert!(counts.iter().all(|(_, count)| *count >= 4), "{counts:?}");
}

#[test]
#[ignore = "200 records: cargo xtask coverage"]
fn coverage_shaking_table_laboratory() {
    let counts = covered_of_laboratory(0..200);
    let model: Vec<(&str, u64)> = counts
        .iter()
        .filter(|(p, _)| p.starts_with("slider"))
        .map(|(p, n)| (p.as_str(), *n))
        .collect();
    crate::laboratory::hold_to_coverage(&model, 200);
}

/// The sum of squares falls by a little in the first small steps from the best values: twenty new
/// starts came no further than that, and the interval was refused.
#[test]
fn a_sum_of_squares_that_jumps_has_its_intervals() {
    for seed in [10, 166] {
        let measured = made_by(BLOCK, 3.0, [0.02, 1e-4], seed, [0.0, 0.05], 5);
        let found = fitted(&measured, BLOCK, &["slider.kinetic_friction", "slider.spring"], seed);
        assert!(found.estimates.iter().all(|e| e.value().is_some()), "{:?}", found.estimates);
    }
}

/// The best values stand between two cliffs, where an event passes a sample: there was no width left,
/// and nothing was added to it.
#[test]
fn a_minimum_between_two_cliffs_is_not_taken_as_certain() {
    let measured = made_by(BLOCK, 3.0, [0.02, 1e-4], 188, [0.0, 0.05], 5);
    let found = fitted(&measured, BLOCK, &["slider.kinetic_friction", "slider.spring"], 188);
    for (estimate, truth) in found.estimates.iter().zip([0.1, 20e3]) {
        let [low, high] = estimate.interval().unwrap();
        assert!((high - low) / truth > 2e-3, "{estimate:?}");
    }
}

/// Of 200 such tests the estimates of kinetic friction and spring scatter by 0.62 % and 0.22 %; by
/// derivatives alone the standard deviations of a fit were 0.46 % and 0.17 %.
#[test]
fn prop_intervals_under_a_noisy_table_are_as_wide_as_estimates_scatter() {
    let truth = [("slider.kinetic_friction", 0.1, 0.0062), ("slider.spring", 20e3, 0.0022)];
    let names = truth.map(|(path, ..)| path);
    let (mut deviations, mut covered) = ([0.0; 2], [0; 2]);
    for seed in 0..12 {
        let measured = made_by(BLOCK, 3.0, [0.02, 1e-4], seed, [0.0, 0.05], 5);
        let found = fitted(&measured, BLOCK, &names, seed);
        for (k, (_, truth, _)) in truth.iter().enumerate() {
            let [low, high] = found.estimates[k].interval().unwrap();
            deviations[k] += (high - low) / (2.0 * 1.96 * truth * 12.0);
            covered[k] += u32::from(low <= *truth && *truth <= high);
        }
    }
    assert!(covered.iter().all(|count| *count >= 9), "{covered:?}");
    for ((_, _, scatter), found) in truth.iter().zip(deviations) {
        // A deviation from 24 draws is known to a seventh, the mean of twelve to a twenty-fifth.
        assert!((0.9..1.4).contains(&(found / scatter)), "{deviations:?}");
    }
}

/// Of 200 such tests the estimates of the damper scatter by 0.228 N s/m, and are 0.52 N s/m lower where the
/// table moves between its samples: 95 % and the shift are 0.52 + 2 · 1.96 · 0.228 wide. The shift as if it were
/// a scatter made 1.87 of it, which held 200 of 200.
#[test]
fn prop_motion_between_samples_shifts_and_does_not_scatter() {
    let (text, truth) = GOES[1];
    let names: Vec<&str> = truth.iter().map(|(path, _)| *path).collect();
    let mut width = 0.0;
    for seed in 0..6 {
        let found = fitted(&made(text, 3.0, [0.05, 3e-4], seed), text, &names, seed);
        let [low, high] = found.estimates[1].interval().unwrap();
        width += (high - low) / 6.0;
    }
    assert!((width / 1.414 - 1.0).abs() < 0.06, "{width}");
}

#[test]
fn prop_intervals_cover_whatever_the_zero_of_a_sensor() {
    let counts = covered_off_zero(12);
    assert!(counts.iter().all(|(_, count)| *count >= 9), "{counts:?}");
}

#[test]
#[ignore = "200 records: cargo xtask coverage"]
fn coverage_shaking_table_offset() {
    crate::laboratory::hold_to_coverage(&covered_off_zero(200), 200);
}

#[test]
#[ignore = "200 records: cargo xtask coverage"]
fn coverage_shaking_table_noisy_table() {
    crate::laboratory::hold_to_coverage(&covered_by_noisy_table(200), 200);
}

/// Whether nothing is said of friction from a record at 0.9 of what would release the block.
fn silent_is_refused(seed: u64) -> bool {
    let measured = made(BLOCK, 1.0, [0.05, 3e-4], seed);
    let found = fitted(&measured, BLOCK, &STATIC_KINETIC, seed);
    found.estimates.iter().all(|estimate| estimate.why().is_some())
}

#[test]
fn prop_intervals_cover() {
    for go in 0..4 {
        // At 95 % fewer than 9 of 12 have a chance of 3e-3.
        let counts = covered(go, 1, 12);
        assert!(counts.iter().all(|(_, count)| *count >= 9), "{counts:?}");
    }
}

/// What transducers may do makes no friction of a block that is stuck, with noise and without.
#[test]
fn a_record_without_sliding_is_refused_whatever_the_transducers_may_do() {
    for (seed, noise) in [(0, [0.0; 2]), (1, [0.05, 3e-4]), (2, [0.05, 3e-4])] {
        let measured = made(BLOCK, 1.0, noise, seed);
        let (engine, usual) = (Engine::unwatched(), Instruments::default());
        let found = fitted_by(&engine, &measured, BLOCK, &STATIC_KINETIC, &usual, seed).unwrap();
        let said = (
            seed,
            found.sliding_evidence,
            &found.noise,
            &found.instruments,
            found.correlation_length,
        );
        assert!(
            found.estimates.iter().all(|e| e.why().is_some()),
            "{said:?} {:?}",
            found.estimates
        );
    }
}

#[test]
fn a_record_without_sliding_is_refused() {
    for seed in 0..12 {
        assert!(silent_is_refused(seed), "{seed}");
    }
}

#[test]
#[ignore = "200 records: cargo xtask coverage"]
fn coverage_shaking_table_friction() {
    crate::laboratory::hold_to_coverage(&covered(0, 1, 200), 200);
}

#[test]
#[ignore = "400 records: cargo xtask coverage"]
fn coverage_shaking_table_slider() {
    // Straight between its samples or on a curve: the limits of what is not known of the table.
    for finer in [1, 5] {
        crate::laboratory::hold_to_coverage(&covered(1, finer, 200), 200);
    }
}

#[test]
#[ignore = "200 records: cargo xtask coverage"]
fn coverage_shaking_table_asymmetry() {
    crate::laboratory::hold_to_coverage(&covered(2, 1, 200), 200);
}

#[test]
#[ignore = "400 records: cargo xtask coverage"]
fn coverage_shaking_table_storey() {
    // Straight between its samples or on a curve: the limits of what is not known of the table.
    for finer in [1, 5] {
        crate::laboratory::hold_to_coverage(&covered(3, finer, 200), 200);
    }
}

#[test]
#[ignore = "200 records: cargo xtask coverage"]
fn coverage_shaking_table_refused() {
    let refused = (0..200).filter(|seed| silent_is_refused(*seed)).count() as u64;
    crate::laboratory::hold_to_coverage(&[], refused);
}

#[test]
fn what_has_no_effect_is_refused_and_the_rest_is_told() {
    // A damper without speed to speak of, beside a spring that shows.
    let measured = made(BLOCK, 3.0, [0.05, 3e-4], 5);
    let found = fitted(&measured, BLOCK, &["slider.kinetic_friction", "slider.tilt"], 5);
    assert!(found.estimates.iter().all(|e| e.value().is_some()), "{:?}", found.estimates);
    let [low, high] = found.estimates[1].interval().unwrap();
    assert!(low <= 0.0 && high >= 0.0 && high - low < 0.02);
    assert!(found.correlation_length < 1.2 && found.sliding_evidence > 1e3);
}

#[test]
fn parameters_have_their_ranges() {
    let analysis = parse("m.toml", BLOCK, &[]).unwrap();
    let range = |text: &str| {
        let p = Parameter::parse(text, &analysis, &[text]).map_err(|e| e.to_string())?;
        Ok::<_, String>(([p.low, p.high], p.unit, p.natural))
    };
    assert_eq!(range("slider.kinetic_friction"), Ok(([0.1 * 0.2, 0.12], "", [false, true])));
    assert_eq!(range("slider.static_friction"), Ok(([0.1, 5.0 * 0.12], "", [true, false])));
    assert_eq!(range("slider.spring=1 kN/m..9 kN/m"), Ok(([1e3, 9e3], "N/m", [false, false])));
    assert_eq!(range("slider.tilt"), Ok(([-0.02, 0.02], "rad", [false, false])));
    assert_eq!(range("slider.damper=0 N s/m..5 N s/m").unwrap().2, [true, false]);
    for (text, part) in [
        ("slider.sprng", "nearest is \"slider.spring\""),
        ("slider.spring=1..2", "a stiffness with its unit"),
        ("slider.spring=5 N/m..1 N/m", "LEAST below MOST"),
        ("slider.spring=5", "PATH=LEAST..MOST"),
        ("motion.record", "a path to a number"),
        ("storey.1.frequency", "a range, since the model gives no value"),
    ] {
        let message = range(text).unwrap_err();
        assert!(message.contains(part), "{message}");
    }
    // Friction by direction has a value for both.
    let by_way = BLOCK.replace("0.12", "{ positive = 0.13, negative = 0.12 }");
    let analysis_by_way = parse("m.toml", &by_way, &[]).unwrap();
    let names = ["slider.static_friction"];
    let both_ways = Parameter::parse(names[0], &analysis_by_way, &names).unwrap();
    assert_eq!([both_ways.low, both_ways.high], [0.1, 5.0 * 0.13]);
    // Static friction below the kinetic one counts as equal to it.
    let both = ["slider.static_friction", "slider.kinetic_friction"]
        .map(|text| Parameter::parse(text, &analysis, &STATIC_KINETIC).unwrap());
    let builder = Builder::new("m.toml", BLOCK, &[], &both);
    assert_eq!(builder.model(&[0.05, 0.08]).unwrap().static_friction(), [0.08, 0.08]);
}
