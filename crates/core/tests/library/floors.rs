//! Floor spectra in two horizontal directions; floor spectra, profiles and histories over a suite.

// Every test says how close it came. Helpers of tests may panic as tests do.
#![allow(clippy::disallowed_macros, clippy::expect_used)]

use core::f64::consts::TAU;

use crate::common::random_in_plane::{System, in_plane, libm_sin};
use slipstick::assessment::floors::{FloorSpectra, PlaceSpectra, TABLED_PERIODS_S};
use slipstick::assessment::histories::floors::FloorSpectrum;
use slipstick::assessment::histories::{Histories, Kept, ModelOn, run_histories};
use slipstick::assessment::single::{Job, Outcome};
use slipstick::assessment::suite::{Scaling, Suite};
use slipstick::input::loaded::Loaded;
use slipstick::input::{self, Analysis};
use slipstick::motion::GroundMotion;
use slipstick::progress::NEVER_CANCELLED;
use slipstick::response::Response;
use slipstick::solver::exact;
use slipstick::study::Record;
use slipstick::study::engine::Engine;

fn spectra(motion: &GroundMotion, response: &Response) -> FloorSpectra {
    let found = FloorSpectra::of(motion, response, NEVER_CANCELLED).expect("nothing stops it");
    found.expect("a history")
}

/// Times and accelerations along x and y of the block and the points at all knots, as `history.csv` has them at its
/// rows, each straight line cut into ten.
fn recorded(response: &Response) -> (Vec<f64>, Vec<[Vec<f64>; 2]>) {
    let knots: Vec<usize> = (0..response.history.as_ref().expect("a history").len()).collect();
    let columns = response.columns(&knots);
    let fine = |name: &str| -> Vec<f64> {
        let (_, values) = columns.iter().find(|(known, _)| known == name).expect("a column");
        let cut = |pair: &[f64]| {
            let [from, to] = [pair[0], pair[1]];
            (0..10).map(move |k| from + (to - from) * f64::from(k) / 10.0)
        };
        values.windows(2).flat_map(cut).chain(values.last().copied()).collect()
    };
    let is_point = |name: &str| name.starts_with("storey") || name.starts_with("point");
    let along_x = columns.iter().map(|(name, _)| &name[..]).filter(|name| {
        (is_point(name) || name.starts_with("block")) && name.ends_with("acceleration_m_per_s2")
    });
    let both = along_x.map(|x| {
        let y = x.replace("acceleration", "acceleration_y");
        [fine(x), fine(&y)]
    });
    (fine("time_s"), both.collect())
}

/// Sa along x and along y and its RotD100, by Runge and Kutta with small steps, of an oscillator that shares nothing with
/// the library.
fn by_runge_kutta(times_s: &[f64], [x, y]: &[Vec<f64>; 2], period_s: f64) -> [f64; 3] {
    let (omega, xi) = (TAU / period_s, 0.05);
    let total = |[u, v]: [f64; 2]| -(2.0 * xi * omega * v + omega * omega * u);
    let directions: Vec<[f64; 2]> = (0..180)
        .map(|degree| f64::from(degree).to_radians())
        .map(|angle| [libm_sin(angle + core::f64::consts::FRAC_PI_2), libm_sin(angle)])
        .collect();
    let (mut most, mut states) = ([0.0_f64; 3], [[0.0; 2]; 2]);
    for (k, t) in times_s.windows(2).enumerate() {
        let parts = ((t[1] - t[0]) / (3e-4 * period_s)).ceil().max(1.0);
        let h = (t[1] - t[0]) / parts;
        for part in 0..parts as u32 {
            for (state, a) in states.iter_mut().zip([x, y]) {
                let ground = |share: f64| a[k] + (a[k + 1] - a[k]) * share;
                let rate = |[u, v]: [f64; 2], share| [v, total([u, v]) - ground(share)];
                let at = |s: [f64; 2], k: [f64; 2], h: f64| [s[0] + h * k[0], s[1] + h * k[1]];
                let share = |own: f64| (f64::from(part) + own) / parts;
                let k1 = rate(*state, share(0.0));
                let k2 = rate(at(*state, k1, 0.5 * h), share(0.5));
                let k3 = rate(at(*state, k2, 0.5 * h), share(0.5));
                let k4 = rate(at(*state, k3, h), share(1.0));
                for i in 0..2 {
                    state[i] += h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]);
                }
            }
            let [x, y] = states.map(total);
            most[0] = most[0].max(x.abs());
            most[1] = most[1].max(y.abs());
            if x * x + y * y > most[2] * most[2] {
                for [cos, sin] in &directions {
                    most[2] = most[2].max((x * cos + y * sin).abs());
                }
            }
        }
    }
    most
}

/// Frames and structures by their modes: at some periods every place has the spectrum of its recorded history, resampled
/// ten times as fine, by an independent oscillator; its peaks lie at steps of three ten-thousandths of the period.
#[test]
fn spectra_of_a_pair_are_those_of_the_recorded_floors() {
    let mut worst = 0.0_f64;
    let mut points = 0;
    for seed in [2, 3, 4, 9] {
        let (model, motion) = in_plane(seed);
        let response = exact(&model, &motion).expect("a response");
        let found = spectra(&motion, &response);
        let axes = found.axes.as_ref().expect("two directions");
        let (times_s, places) = recorded(&response);
        points += places.len() - 1;
        assert_eq!(places.len() + 1, found.sa.places().count());
        for (place, recorded) in places.iter().enumerate() {
            for period_s in [TABLED_PERIODS_S[2], TABLED_PERIODS_S[4]] {
                let i = found.periods_s.iter().position(|known| *known == period_s);
                let i = i.expect("a period of tables");
                let of = |sa: &PlaceSpectra| sa.places().nth(1 + place).expect("a place")[i];
                let [x, y, rotated] = by_runge_kutta(&times_s, recorded, period_s);
                for (found, expected) in
                    [(of(&axes[0]), x), (of(&axes[1]), y), (of(&found.sa), rotated)]
                {
                    let error = (found / expected - 1.0).abs();
                    assert!(error < 1e-6, "{seed} {place} {period_s} s: {found} {expected}");
                    worst = worst.max(error);
                }
            }
        }
    }
    println!("{points} points: worst difference {worst:.1e}");
    assert!(points > 3);
}

/// A pair whose second component is 0 has the spectra of the first by itself, and nothing along y.
#[test]
fn a_pair_along_x_has_the_spectra_of_one_direction() {
    for seed in 0..6 {
        let system = System::random(seed, false).along_a_line(0.0);
        let pair = spectra(&system.motion(), &system.response());
        let bare = GroundMotion::new(
            system.times_s.clone(),
            system.table[0].clone(),
            system.vertical.clone(),
        );
        let alone = spectra(&bare.expect("a motion"), &system.along_x());
        assert!(alone.axes.is_none());
        let [x, y] = pair.axes.as_ref().expect("two directions");
        assert_eq!(pair.periods_s, alone.periods_s, "seed {seed}");
        assert!(y.places().flatten().all(|sa| *sa == 0.0), "seed {seed}");
        // The oscillator goes in other steps, which is all that differs.
        for found in [x, &pair.sa] {
            for (found, alone) in found.places().flatten().zip(alone.sa.places().flatten()) {
                assert!((found / alone - 1.0).abs() < 1e-12, "seed {seed}: {found} {alone}");
            }
        }
    }
}

/// The whole problem turned by whole degrees, in which RotD100 is looked for, has the same RotD100 of every place.
#[test]
fn prop_a_turned_pair_has_the_same_rotd100() {
    // Where the direction of sliding turns fast a history has knots between samples, which turning moves: between
    // others straight lines differ by the square of their length. In the first three systems all stand still, and
    // what is left is that of the responses, whose events are found to 1e-11 of what moves.
    for (seed, bound) in [(6, 1e-9), (8, 1e-9), (22, 1e-9), (0, 1e-4), (3, 1e-4), (9, 1e-4)] {
        let system = System::random(seed, true);
        let angle = (7.0 + 23.0 * seed as f64).to_radians();
        let (sine, cosine) = (libm_sin(angle), libm_sin(angle + core::f64::consts::FRAC_PI_2));
        let turned = system.changed(|[x, y]| [cosine * x - sine * y, sine * x + cosine * y]);
        let of = |system: &System| spectra(&system.motion(), &system.response());
        let (plain, turned) = (of(&system), of(&turned));
        assert_ne!(plain.axes, turned.axes);
        let pairs = plain.sa.places().flatten().zip(turned.sa.places().flatten());
        let worst = pairs.map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max);
        println!("seed {seed}: worst difference {worst:.1e}");
        assert!(worst < bound, "seed {seed}: {worst:.1e}");
    }
}

/// Two storeys with heights, and bounds of friction.
const FRAME: &str = "[block]\nmass = \"10 t\"\n[slider]\nstatic_friction = 0.06\nkinetic_friction = 0.05\n\
                     radius = \"2 m\"\nbounds = { lower = 0.8, upper = 1.3 }\n[frame]\nperiod = \"0.5 s\"\n\
                     [[storey]]\nmass = \"5 t\"\nstiffness = \"1 kN/m\"\ndamping_ratio = 0.03\nheight = \"3 m\"\n\
                     [[storey]]\nmass = \"4 t\"\nstiffness = \"1 kN/m\"\ndamping_ratio = 0.03\n\
                     height = \"2.5 m\"\n[analysis]\ntail = \"1 s\"\n";

const SCALE: f64 = 1.5;

fn wave(i: u32, axis: u32) -> Vec<f64> {
    let rates = [5.0 + f64::from(i + axis), 17.0 - 2.0 * f64::from(axis)];
    let of = |t: f64| 2.5 * libm_sin(rates[0] * t) * libm_sin(rates[1] * t + 0.3 * f64::from(i));
    (0..80).map(|k| of(0.02 * f64::from(k))).collect()
}

/// So many records, in two directions or in one.
fn suite(records: u32, in_plane: bool) -> Suite {
    let record = |i: u32| {
        let motion = GroundMotion::evenly_spaced(0.02, wave(i, 0), None).expect("a motion");
        let motion = if in_plane { motion.with_y(wave(i, 1)).expect("y") } else { motion };
        Record::new(format!("r{i}"), motion)
    };
    Suite { records: (0..records).map(record).collect(), ..Suite::default() }
}

fn frame(in_plane: bool) -> Analysis {
    let analysis = input::parse("m.toml", FRAME, &[]).expect("a model");
    if in_plane { analysis.in_plane().expect("two directions") } else { analysis }
}

fn over(suite: &Suite, analysis: &Analysis, histories_of: &[&str]) -> Histories {
    let on = ModelOn { name: "m", analysis, suite };
    let kept = Kept { floor_spectra: true, histories_of, ..Kept::default() };
    run_histories(&[on], &Scaling::Factor(SCALE), kept, &Engine::unwatched()).expect("runs")
}

/// The run of a record by itself, with a bound of friction.
fn alone(suite: &Suite, record: usize, analysis: &Analysis, bound: usize) -> Outcome {
    let factors = analysis.friction_bounds.expect("bounds").all();
    let mut analysis = analysis.clone();
    analysis.model = factors[bound].of(&analysis.model);
    analysis.friction_bounds = None;
    let motion = suite.records[record].motion.scaled(SCALE).expect("a motion");
    let job = Job::new(analysis, Loaded::made(motion, String::new())).expect("a job");
    job.run(true).expect("an answer")
}

/// Of seven records and of three, in one direction and in two: mean, fractiles and largest are those of the spectra of
/// single runs, with every bound, of every place and direction at every period.
#[test]
fn a_suites_floor_spectra_are_those_of_single_runs() {
    for (records, in_plane) in [(7, false), (3, true)] {
        let (suite, analysis) = (suite(records, in_plane), frame(in_plane));
        let histories = over(&suite, &analysis, &[]);
        let model = &histories.models[0];
        assert_eq!(model.statistic(), if records == 7 { "mean" } else { "maximum" });
        let single: Vec<Vec<FloorSpectra>> = (0..3)
            .map(|bound| {
                let of = |i: u32| alone(&suite, i as usize, &analysis, bound).floor_spectra;
                (0..records).map(|i| of(i).expect("spectra")).collect()
            })
            .collect();
        let all = model.floor_spectra();
        // Ground, block and two floors.
        assert_eq!(all.len(), 3 * 4 * if in_plane { 3 } else { 1 });
        for (of, over) in &all {
            let FloorSpectrum { bound, direction, place } = *of;
            for (period, over) in over.iter().enumerate() {
                let ordinate = |spectra: &FloorSpectra| {
                    let sa = spectra.in_directions().nth(direction).expect("a direction");
                    sa.places().nth(place).expect("a place")[period]
                };
                let mut values: Vec<f64> = single[bound].iter().map(ordinate).collect();
                let mean = values.iter().sum::<f64>() / values.len() as f64;
                assert!((over.mean / mean - 1.0).abs() < 1e-14, "{of:?} {period}");
                values.sort_by(f64::total_cmp);
                let last = values.len() - 1;
                assert_eq!(over.largest, values[last]);
                // The value at the place p (n − 1), straight between neighbours.
                for (share, found) in [0.16, 0.5, 0.84].into_iter().zip(over.fractiles) {
                    let at = share * last as f64;
                    let (low, part) = (at as usize, at.fract());
                    let high = values[(low + 1).min(last)];
                    let expected = values[low] + part * (high - values[low]);
                    assert!((found / expected - 1.0).abs() < 1e-14, "{of:?} {period} {share}");
                }
            }
        }
        // The bound with the largest ordinate of what governs.
        let of = FloorSpectrum { place: 3, ..FloorSpectrum::default() };
        let peak = |bound: usize| {
            let over = model.floor_spectrum(FloorSpectrum { bound, ..of }).expect("a spectrum");
            over.iter().map(|over| model.governing_of(over)).fold(0.0, f64::max)
        };
        let governs = model.floor_governs(of).expect("a bound");
        assert!((0..3).all(|bound| peak(bound) <= peak(governs)));
        let table = histories.floor_spectra.as_ref().expect("a table");
        let periods = model.a_floor_spectrum().expect("spectra").periods_s.len();
        assert_eq!(table.rows(), all.len() * periods);
    }
}

/// Profiles are the mean of the demands of single runs, level by level, with the heights of the levels.
#[test]
fn profiles_are_those_of_single_runs() {
    let (suite, analysis) = (suite(7, false), frame(false));
    let histories = over(&suite, &analysis, &[]);
    let model = &histories.models[0];
    assert_eq!(model.levels_m.as_deref(), Some(&[0.0, 3.0, 5.5][..]));
    for bound in 0..3 {
        let single: Vec<_> =
            (0..7).map(|i| alone(&suite, i, &analysis, bound).nominal.response.demands).collect();
        let profiles = model.profiles(bound);
        let keys: Vec<&str> = profiles.iter().map(|(profile, _)| profile.key).collect();
        let expected = [
            "peak_acceleration_m_per_s2",
            "peak_displacement_m",
            "peak_drift_m",
            "peak_drift_ratio",
            "peak_shear_n",
        ];
        assert_eq!(keys, expected);
        for (profile, over) in &profiles {
            let levels: Vec<usize> = profile.levels.iter().map(|(level, _)| *level).collect();
            let from_block = profile.key == "peak_acceleration_m_per_s2";
            assert_eq!(levels, if from_block { vec![0, 1, 2] } else { vec![1, 2] });
            for (level, over) in levels.iter().zip(over) {
                let value = |demands: &slipstick::response::Demands| {
                    let Some(storey) = level.checked_sub(1).map(|i| &demands.storeys[i]) else {
                        return demands.peak_block_acceleration_m_per_s2;
                    };
                    match profile.key {
                        "peak_displacement_m" => storey.peak_displacement_m,
                        "peak_drift_m" => storey.peak_drift_m,
                        "peak_drift_ratio" => storey.peak_drift_ratio.expect("heights"),
                        "peak_shear_n" => storey.peak_shear_n.expect("masses"),
                        _ => storey.peak_acceleration_m_per_s2,
                    }
                };
                let mean = single.iter().map(value).sum::<f64>() / 7.0;
                assert!((over.mean / mean - 1.0).abs() < 1e-14, "{} {level}", profile.key);
            }
        }
    }
    // Bounds, levels of five demands.
    let rows = histories.profiles.as_ref().map(|table| table.rows());
    assert_eq!(rows, Some(3 * (3 + 2 + 2 + 2 + 2)));
}

/// Of a pair whose components are run separately the larger ordinate counts.
#[test]
fn the_larger_component_of_a_separate_pair_counts() {
    let mut pairs = suite(4, false);
    for (i, record) in pairs.records.iter_mut().enumerate() {
        record.pair = Some(i / 2);
    }
    let analysis = frame(false);
    let histories = over(&pairs, &analysis, &[]);
    let model = &histories.models[0];
    let of = FloorSpectrum { bound: 1, direction: 0, place: 2 };
    let over = model.floor_spectrum(of).expect("a spectrum");
    let sa = |i: usize| model.records[i].floor_spectrum(of).expect("a spectrum");
    for (period, over) in over.iter().enumerate() {
        let larger = [0, 2].map(|i| sa(i)[period].max(sa(i + 1)[period]));
        assert_eq!(over.mean, 0.5 * (larger[0] + larger[1]));
    }
}

/// The histories of chosen records are those of their runs by themselves to the last bit, with every bound; of others
/// none is kept, and a name that is none is refused.
#[test]
fn chosen_histories_are_those_of_single_runs() {
    for in_plane in [false, true] {
        let (suite, analysis) = (suite(3, in_plane), frame(in_plane));
        let histories = over(&suite, &analysis, &["r2", "r0"]);
        let chosen: Vec<[usize; 2]> =
            histories.chosen.iter().map(|one| [one.record, one.bound]).collect();
        assert_eq!(chosen, [[0, 0], [0, 1], [0, 2], [2, 0], [2, 1], [2, 2]]);
        for one in &histories.chosen {
            let expected = alone(&suite, one.record, &analysis, one.bound).nominal.response;
            assert!(expected.history.is_some());
            assert_eq!(one.response, expected);
        }
    }
    let (suite, analysis) = (suite(3, false), frame(false));
    let on = ModelOn { name: "m", analysis: &analysis, suite: &suite };
    let kept = Kept { histories_of: &["r4"], ..Kept::default() };
    let refused = run_histories(&[on], &Scaling::Factor(1.0), kept, &Engine::unwatched());
    let message = refused.expect_err("no such record").to_string();
    let expected =
        "history-of: expected the name of a record of the suite, such as r0, found \"r4\"";
    assert!(message.starts_with(expected), "{message}");
}
