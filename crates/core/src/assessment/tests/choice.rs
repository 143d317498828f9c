//! Design search against the full grid, Sobol' indices against closed forms, windows.

use std::collections::BTreeSet;

use crate::assessment::design::{Demand, SearchResult, Target, records_needed, search};
use crate::assessment::sensitivity::{design, indices};
use crate::assessment::spectrum::{fixed_base, intervals_above};
use crate::error::FitError;
use crate::model::{Block, Damping, Frame, InitialState, Model, Slider};
use crate::motion::{GroundMotion, Sine, spectrum};
use crate::slider::{Ends, Friction};
use crate::solver;

/// The front by the definition: every design in full, each against each.
fn full_front(
    target: &Target,
    designs: usize,
    demands: impl Fn(usize) -> Vec<Demand>,
) -> BTreeSet<usize> {
    let figures: Vec<_> = (0..designs).map(|d| target.figures(&demands(d)).unwrap()).collect();
    let feasible: Vec<usize> =
        (0..designs).filter(|&d| figures[d].displacement_m <= target.gap_m).collect();
    let beats = |a: usize, b: usize| {
        let (x, y) = (&figures[a], &figures[b]);
        x.displacement_m <= y.displacement_m
            && x.acceleration_m_per_s2 <= y.acceleration_m_per_s2
            && (x.displacement_m < y.displacement_m
                || x.acceleration_m_per_s2 < y.acceleration_m_per_s2)
    };
    // Sorted by displacement a front is what has the least acceleration so far; the definition is
    // kept for small grids.
    if designs <= 2000 {
        let beaten = |d: usize| feasible.iter().any(|&other| beats(other, d));
        return feasible.iter().copied().filter(|&d| !beaten(d)).collect();
    }
    let mut order = feasible;
    order.sort_by(|&a, &b| {
        let (x, y) = (&figures[a], &figures[b]);
        let by_displacement = x.displacement_m.total_cmp(&y.displacement_m);
        by_displacement.then(x.acceleration_m_per_s2.total_cmp(&y.acceleration_m_per_s2))
    });
    let mut front: Vec<usize> = Vec::new();
    for d in order {
        if front.last().is_none_or(|&last| !beats(last, d)) {
            front.push(d);
        }
    }
    front.into_iter().collect()
}

fn numbers(found: &SearchResult) -> BTreeSet<usize> {
    found.front.iter().map(|point| point.design).collect()
}

/// Demands of a smooth trade-off with scatter by record, in steps so that equal figures occur.
fn trade(side: usize, design: usize, record: usize) -> Demand {
    let (friction, stiffness) =
        ((design / side) as f64 / side as f64, (design % side) as f64 / side as f64);
    let wild = libm::sin(17.0 * record as f64 + 31.0 * friction + 23.0 * stiffness);
    let round = |value: f64| libm::round(value * 400.0) / 400.0;
    Demand {
        displacement_m: round(0.3 / (0.2 + friction + 0.4 * stiffness) * (1.0 + 0.3 * wild)),
        acceleration_m_per_s2: round(
            (1.0 + 3.0 * friction + 2.0 * stiffness * stiffness) * (1.0 - 0.2 * wild),
        ),
    }
}

fn run(side: usize) -> impl FnMut(&[(usize, usize)]) -> Result<Vec<Demand>, FitError> {
    move |pairs| Ok(pairs.iter().map(|&(design, record)| trade(side, design, record)).collect())
}

#[test]
fn search_equals_the_full_grid_of_200_by_200() {
    let target = Target { gap_m: 0.32, probability: 0.9, acceleration_share: 0.5 };
    let (designs, records) = (40_000, 21);
    let found = search(&target, designs, records, run(200)).unwrap();
    let demands = |design| (0..records).map(|record| trade(200, design, record)).collect();
    assert_eq!(numbers(&found), full_front(&target, designs, demands));
    assert!(found.front.len() > 5);
    let all = (designs * records) as u64;
    assert!(2 * found.runs < all, "{} runs of {all}", found.runs);
    let chosen = found.chosen().unwrap();
    let least =
        found.front.iter().map(|p| p.figures.acceleration_m_per_s2).fold(f64::INFINITY, f64::min);
    assert_eq!(chosen.figures.acceleration_m_per_s2, least);
    assert!(found.front.windows(2).all(|pair| {
        let [a, b] = [&pair[0].figures, &pair[1].figures];
        a.displacement_m <= b.displacement_m && a.acceleration_m_per_s2 >= b.acceleration_m_per_s2
    }));
}

/// Of few designs, too, the front of the first bounds the others.
#[test]
fn search_of_a_small_grid_leaves_out_half_of_its_runs() {
    let target = Target { gap_m: 0.32, probability: 0.9, acceleration_share: 0.5 };
    let (side, records) = (17, 42);
    let found = search(&target, side * side, records, run(side)).unwrap();
    let all = (side * side * records) as u64;
    assert!(2 * found.runs < all, "{} runs of {all}", found.runs);
}

#[test]
fn prop_search_equals_the_full_grid_for_any_target() {
    for gap_m in [0.12, 0.2, 0.3, 0.5, 2.0] {
        for probability in [0.3, 0.84, 0.9, 1.0] {
            for (acceleration_share, records) in [(0.5, 7), (0.84, 13), (1.0, 1), (0.1, 3)] {
                let target = Target { gap_m, probability, acceleration_share };
                let found = search(&target, 900, records, run(30)).unwrap();
                let demands =
                    |design| (0..records).map(|record| trade(30, design, record)).collect();
                assert_eq!(
                    numbers(&found),
                    full_front(&target, 900, demands),
                    "{target:?} {records}"
                );
                for point in &found.front {
                    let needed = records_needed(&target, records) as f64 / records as f64;
                    assert!(point.figures.within.estimate() >= needed);
                }
                // Where nothing is feasible, the least displacement of all is told.
                assert_eq!(found.front.is_empty(), found.nearest.is_some());
                if let Some(nearest) = found.nearest {
                    let least = (0..900)
                        .map(|d| {
                            target
                                .figures(&(0..records).map(|r| trade(30, d, r)).collect::<Vec<_>>())
                        })
                        .map(|figures| figures.unwrap().displacement_m)
                        .fold(f64::INFINITY, f64::min);
                    assert_eq!(nearest.figures.displacement_m, least);
                }
            }
        }
    }
}

#[test]
fn runs_beyond_the_gap_count_and_runs_without_an_answer_do_not() {
    let target = Target { gap_m: 1.0, probability: 0.5, acceleration_share: 0.5 };
    let beyond = Demand { displacement_m: f64::INFINITY, acceleration_m_per_s2: f64::NAN };
    let unknown = Demand { displacement_m: f64::NAN, acceleration_m_per_s2: f64::NAN };
    let fine = Demand { displacement_m: 0.5, acceleration_m_per_s2: 2.0 };
    let figures = target.figures(&[beyond, fine, beyond, fine]).unwrap();
    assert_eq!((figures.displacement_m, figures.within.estimate()), (0.5, 0.5));
    assert_eq!(target.figures(&[beyond, beyond, fine]).unwrap().displacement_m, f64::INFINITY);
    let figures = target.figures(&[unknown, fine, unknown, unknown, beyond]).unwrap();
    assert_eq!((figures.displacement_m, figures.within.estimate()), (0.5, 0.5));
    // A design of which nothing is known keeps no gap.
    let figures = target.figures(&[unknown; 3]).unwrap();
    assert_eq!((figures.displacement_m, figures.within.estimate()), (f64::INFINITY, 0.0));
    for target in [
        Target { gap_m: 0.0, ..target },
        Target { probability: 0.0, ..target },
        Target { probability: 1.1, ..target },
        Target { acceleration_share: f64::NAN, ..target },
    ] {
        assert!(search(&target, 1, 1, run(1)).is_err(), "{target:?}");
    }
    assert!(search(&target, 0, 1, run(1)).is_err() && search(&target, 1, 0, run(1)).is_err());
}

/// Points of a lattice whose generator has good low-dimensional projections (Korobov's form).
fn lattice(n: usize, dimensions: usize) -> Vec<Vec<f64>> {
    let point = |i: usize| {
        let mut z = 1_u128;
        (0..dimensions)
            .map(|_| {
                let value = ((i as u128 * z) % n as u128) as f64 + 0.5;
                z = z * 17_364 % n as u128;
                value / n as f64
            })
            .collect()
    };
    (0..n).map(point).collect()
}

/// T. Ishigami and T. Homma's function (1990), whose indices are known in closed form.
#[test]
fn indices_of_ishigami() {
    let (a, b, pi) = (7.0, 0.1, core::f64::consts::PI);
    let rows = design(&lattice(16_381, 6), 3).unwrap();
    assert_eq!(rows.len(), 16_381 * 5);
    let f = |row: &Vec<f64>| {
        let [x, y, z] = [row[0], row[1], row[2]].map(|u| pi * (2.0 * u - 1.0));
        libm::sin(x) + a * libm::sin(y) * libm::sin(y) + b * z * z * z * z * libm::sin(x)
    };
    let outputs: Vec<f64> = rows.iter().map(f).collect();
    let found = indices(&outputs, 3, 0.95).unwrap();
    let p4 = pi * pi * pi * pi;
    let v1 = 0.5 * (1.0 + b * p4 / 5.0) * (1.0 + b * p4 / 5.0);
    let v2 = a * a / 8.0;
    let v13 = b * b * p4 * p4 * (1.0 / 18.0 - 1.0 / 50.0);
    let v = v1 + v2 + v13;
    let expected = [[v1 / v, (v1 + v13) / v], [v2 / v, v2 / v], [0.0, v13 / v]];
    for (index, [first, total]) in found.iter().zip(expected) {
        assert!((index.first - first).abs() < 0.01, "{index:?} for {first}");
        assert!((index.total - total).abs() < 0.01, "{index:?} for {total}");
        for ([low, high], value) in [(index.first_interval, first), (index.total_interval, total)] {
            assert!(
                low <= value + 1e-3 && value - 1e-3 <= high && high - low < 0.06,
                "{index:?} {value}"
            );
        }
    }
}

#[test]
fn indices_refuse_what_tells_nothing() {
    assert!(design(&lattice(7, 4), 2).is_err());
    assert!(design(&lattice(11, 3), 2).is_err());
    assert!(indices(&[1.0; 40], 2, 0.9).is_err(), "outputs that do not vary");
    assert!(indices(&[1.0; 39], 2, 0.9).is_err());
    let mut outputs = vec![0.0; 40];
    outputs[3] = f64::NAN;
    assert!(matches!(indices(&outputs, 2, 0.9), Err(FitError::OutOfRange { .. })));
}

#[test]
fn windows_above_a_threshold() {
    let x = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0];
    let above = intervals_above(&x, &[0.0, 2.0, 0.0, f64::NAN, 3.0, 4.0], 1.0);
    assert_eq!(above, [[0.5, 1.5], [4.0, 5.0]]);
    assert_eq!(intervals_above(&x[..3], &[2.0, 2.0, 1.0], 1.0), [[0.0, 2.0]]);
    assert!(intervals_above(&x, &[1.0; 6], 1.0).is_empty());
}

/// Held to the table the structure is an elastic oscillator, whose spectrum is known by another way.
#[test]
fn fixed_base_is_the_elastic_spectrum() {
    let omega = 2.0 * core::f64::consts::PI / 0.6;
    let frame = Frame {
        masses_kg: vec![2.0],
        stiffnesses_n_per_m: vec![2.0 * omega * omega],
        damping: Damping::Ratio(0.03),
        heights_m: None,
    };
    let friction = Friction::new(0.05, 0.04).unwrap();
    let ends = Ends::Open { gap_m: Some(0.1) };
    let slider = Slider { damper_n_s_per_m: 3.0, ends, ..Slider::sprung(friction, 50.0) };
    let block = Block { mass_kg: 3.0, width_m: None, height_m: None };
    let model = Model::new(block, slider, frame, 9.81, InitialState::rest()).unwrap();
    let sine = Sine {
        frequency_hz: 1.3,
        amplitude_m_per_s2: 3.0,
        duration_s: 4.0,
        dt_s: 0.01,
        phase_rad: 0.0,
        ramp_s: 0.0,
        decay_s: 0.0,
    };
    let motion: GroundMotion = sine.motion().unwrap();
    let held = solver::exact_demands(&fixed_base(&model).unwrap(), &motion).unwrap().demands;
    let elastic =
        spectrum(motion.times_s(), motion.horizontal_m_per_s2(), &[0.6], &[0.03]).unwrap();
    let expected = elastic.ordinates[0].sa_m_per_s2;
    let found = held.storeys[0].peak_acceleration_m_per_s2;
    assert!((found / expected - 1.0).abs() < 1e-10, "{found} for {expected}");
    assert_eq!((held.slip_count, held.peak_sliding_displacement_m), (0, 0.0));
}
