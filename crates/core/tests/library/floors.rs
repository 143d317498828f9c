//! Floor spectra in two horizontal directions.

// Every test says how close it came. Helpers of tests may panic as tests do.
#![allow(clippy::disallowed_macros, clippy::expect_used)]

use core::f64::consts::TAU;

use crate::common::random_in_plane::{System, in_plane, libm_sin};
use slipstick::assessment::floors::{FloorSpectra, PlaceSpectra, TABLED_PERIODS_S};
use slipstick::motion::GroundMotion;
use slipstick::progress::UNWATCHED;
use slipstick::response::Response;
use slipstick::solver::exact;

fn spectra(motion: &GroundMotion, response: &Response) -> FloorSpectra {
    let found = FloorSpectra::of(motion, response, UNWATCHED).expect("nothing stops it");
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
        assert_eq!((x, &pair.periods_s), (&alone.sa, &alone.periods_s), "seed {seed}");
        assert!(y.places().flatten().all(|sa| *sa == 0.0), "seed {seed}");
        for (pair, alone) in pair.sa.places().flatten().zip(alone.sa.places().flatten()) {
            assert!((pair / alone - 1.0).abs() < 1e-12, "seed {seed}: {pair} {alone}");
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
