//! Runs that use up the travel of their surfaces: one rule in every analysis.

use crate::assessment::design::{DesignRequest, Target, run_design};
use crate::assessment::ida::{IdaLevels, IdaRequest, IdaRun, run_ida};
use crate::assessment::models::Models;
use crate::assessment::observed::{Data, FitTo, FragilityRequest, FragilityRun, run_fragility};
use crate::assessment::spectrum::{SpectrumRequest, run_spectrum};
use crate::assessment::suite::{Scaling, Suite};
use crate::error::Stopped;
use crate::input::plan::Plan;
use crate::motion::GroundMotion;
use crate::motion::intensity::{LevelMeasure, Measure};
use crate::notice::NoticeKind;
use crate::study::engine::Engine;
use crate::study::summary::Rows;
use crate::study::{Record, Study, TRAVEL_USED_UP, travel_used_up};
use crate::table::Table;

/// A triple pendulum whose travel of 240 mm ends.
const TRIPLE: &str = "[block]\nweight = \"1000 kN\"\n[slider]\n[slider.triple]\n\
                      effective_radius = [\"2.0 m\", \"0.4 m\", \"0.4 m\", \"2.0 m\"]\n\
                      friction = [0.06, 0.02, 0.02, 0.06]\n\
                      travel = [\"0.10 m\", \"0.02 m\", \"0.02 m\", \"0.10 m\"]\n";
const TRAVEL_M: f64 = 0.24;
const DEMAND: &str = "peak_sliding_displacement_m";
const PGA: LevelMeasure = LevelMeasure { measure: Measure::Pga, rotated: None };
const LEVELS: [f64; 6] = [1.0, 2.0, 3.0, 4.5, 6.0, 9.0];

fn suite() -> Suite {
    let record = |i: u32| {
        let wave = |k: u32| {
            let t = 0.02 * f64::from(k);
            let rate = 2.5 + 0.7 * f64::from(i);
            libm::sin(rate * t) * libm::sin(0.3 * t) * libm::exp(-0.02 * t)
        };
        let motion = GroundMotion::evenly_spaced(0.02, (0..500).map(wave).collect(), None);
        Record::new(format!("r{i}"), motion.unwrap())
    };
    Suite { records: (0..8).map(record).collect(), ..Suite::default() }
}

fn ida(limit: f64) -> IdaRun {
    let models = Models::new("m.toml", TRIPLE, &[], &[], true).unwrap();
    let request = IdaRequest {
        models: &models,
        suite: &suite(),
        measure: PGA,
        demand: DEMAND,
        limit: Some(limit),
        levels: IdaLevels::Fixed(LEVELS.to_vec()),
        bounds: &[],
        keep: &[],
        by: None,
    };
    run_ida(&request, &Engine::unwatched()).unwrap()
}

fn fragility(table: &Table, limit: f64, fit_to: FitTo) -> FragilityRun {
    let request = FragilityRequest {
        table,
        source_name: "runs",
        demand: DEMAND,
        limit: Some(limit),
        measure: None,
        units: None,
        fit_to: Some(fit_to),
        floor: None,
        cap: None,
        keep: &[],
        bootstrap: None,
    };
    run_fragility(&request, &Engine::unwatched()).unwrap()
}

fn numbers(table: &Table, name: &str) -> Vec<f64> {
    table.find(name).unwrap().cells.to_numbers().unwrap()
}

/// Every run of a level that used up its travel counts as beyond a limit within it, in an incremental dynamic
/// analysis and in a fragility of its runs alike; beyond the travel it is neither.
#[test]
fn ida_and_fragility_count_runs_that_used_up_their_travel() {
    let run = ida(0.18);
    let ended = travel_used_up(&run.failures);
    assert!(ended > 10 && ended == run.failures.len(), "{ended} of {}", run.rows.rows());
    let travels = numbers(&run.rows, TRAVEL_USED_UP);
    assert_eq!(travels.iter().filter(|travel| (**travel - TRAVEL_M).abs() < 1e-12).count(), ended);

    let counted = fragility(&run.rows, 0.18, FitTo::Counts);
    let Data::Stripes(stripes) = &counted.data else { panic!("{:?}", counted.data) };
    let (levels, demands) = (numbers(&run.rows, "level"), numbers(&run.rows, DEMAND));
    for stripe in stripes {
        let rows = (0..levels.len()).filter(|&row| levels[row] == stripe.level);
        let beyond = rows.filter(|&row| demands[row] > 0.18 || !travels[row].is_nan()).count();
        assert_eq!((stripe.runs, stripe.exceeded), (8, beyond as u64));
    }
    let said = &counted.warnings.iter().find(|w| w.kind == NoticeKind::FailedRuns).unwrap().message;
    assert_eq!(*said, format!("{ended} of 48 runs used up their travel and count as beyond it"));

    // The capacities of the runs are those of the analysis.
    let of_runs = fragility(&run.rows, 0.18, FitTo::Capacities);
    let of_ida = run.groups[0].fit.clone().unwrap().unwrap().curve();
    assert_eq!(of_runs.fragility.curve(), of_ida);
    // A crossing lies up to one step of the levels below where it is put, 1.5 of its level.
    assert!((1.0..1.5).contains(&(of_ida.median / counted.fragility.curve().median)));

    // A limit beyond the travel is not known to be passed.
    let run = ida(0.3);
    let crossings = run.groups[0].curves.iter().map(|curve| curve.first_crossing(0.3));
    assert!(crossings.clone().all(|crossing| !crossing.reached));
    let last = run.groups[0].curves.iter().filter_map(|curve| curve.demands.last());
    let ended = last.filter(|demand| demand.value().is_nan()).count();
    assert_eq!(crossings.filter(|crossing| crossing.cut_short).count(), ended);
}

/// A spectrum: a fractile of the displacement that falls on such runs is infinite, one of the acceleration is of the
/// runs that have one.
#[test]
fn spectra_put_used_up_travel_above_all() {
    let varied = [("over", "block.mass=100..200t:2".to_owned())];
    let models = Models::new("m.toml", TRIPLE, &[], &varied, true).unwrap();
    let scaling = Scaling::Level(PGA, 4.5);
    let (suite, demands) = (suite(), []);
    let request = SpectrumRequest {
        models: &models,
        suite: &suite,
        scaling: &scaling,
        demands: &demands,
        bounds: &[],
    };
    let run = run_spectrum(&request, &Engine::unwatched()).unwrap();
    let ended = travel_used_up(&run.failures) / 2;
    assert!(ended > 1 && ended < 8, "{ended}");
    let of = |key: &str| {
        &run.curves.iter().find(|curves| curves.of.name() == key).unwrap().fractiles[0][0]
    };
    assert_eq!(of(DEMAND)[2], f64::INFINITY);
    assert!(of("block.peak_acceleration_m_per_s2").iter().all(|value| value.is_finite()));
}

/// A design: a gap within the travel is passed by such runs.
#[test]
fn designs_count_used_up_travel_as_beyond_the_gap() {
    let varied = [("vary", "block.mass=100..200t:2".to_owned())];
    let models = Models::new("m.toml", TRIPLE, &[], &varied, true).unwrap();
    let scaling = Scaling::Level(PGA, 4.5);
    let (suite, engine) = (suite(), Engine::unwatched());
    let within = |gap_m: f64| {
        let request = DesignRequest {
            models: &models,
            suite: &suite,
            scaling: &scaling,
            target: Target { gap_m, probability: 0.1, acceleration_share: 0.5 },
            acceleration: "block.peak_acceleration_m_per_s2",
            bounds: None,
            sensitivity: 0,
            seed: 0,
            confidence: 0.9,
        };
        let run = run_design(&request, &engine).unwrap();
        let point = run.found.chosen().or(run.found.nearest).unwrap();
        (point.figures.within.estimate(), travel_used_up(&run.failures) as f64 / 16.0)
    };
    let (kept, ended) = within(0.2399);
    assert!((kept - (1.0 - ended)).abs() < 1e-12, "{kept} {ended}");
    // Of a gap beyond the travel those runs say nothing.
    assert_eq!(within(0.25).0, 1.0);
}

/// The quantiles of a study count such runs above all others, and its rows say which they are.
#[test]
fn studies_count_used_up_travel_above_all() {
    let text = "model = \"m.toml\"\n[records]\nfiles = \"*.txt\"\nmeasure = \"PGA\"\n\
                levels = [\"0.3 m/s2\", \"4.5 m/s2\"]\n";
    let plan = Plan::parse("p.toml", text).unwrap();
    let study = Study::new(&plan, "m.toml", TRIPLE, suite().records).unwrap();
    let engine = Engine::unwatched();
    let rows = study.rows(0..study.runs(), &engine).unwrap();
    let table = study.table(&rows);
    let travels = numbers(&table, TRAVEL_USED_UP);
    assert_eq!(study.fields()[study.travel_used_up().unwrap()].name, TRAVEL_USED_UP);
    let ended = travels.iter().filter(|travel| (**travel - TRAVEL_M).abs() < 1e-12).count() as u64;
    assert!(ended > 1 && ended < 8, "{ended}");
    let solved = |take: &mut dyn FnMut(u64, bool)| {
        rows.iter().for_each(|row| take(row.run, row.error.is_none()));
        Ok::<(), Stopped>(())
    };
    let demand = |i: usize, take: &mut dyn FnMut(u64, f64)| {
        rows.iter().for_each(|row| take(row.run, row.demands[i]));
        Ok(())
    };
    let used_up = |take: &mut dyn FnMut(u64, f64)| {
        rows.iter().for_each(|row| take(row.run, travels[row.run as usize]));
        Ok(())
    };
    let warnings = |_: &mut dyn FnMut(u64, &str)| Ok(());
    let passes =
        Rows { solved: &solved, demand: &demand, travel_used_up: &used_up, warnings: &warnings };
    let summary = study.summary("s", &passes, &engine).unwrap();
    let of = |level: usize, name: &str| {
        summary.rows.iter().find(|row| row.level == level && row.demand.name() == name).unwrap()
    };
    assert_eq!((of(0, DEMAND).beyond, of(1, DEMAND).beyond), (0, ended));
    assert!(of(0, DEMAND).mean.is_finite() && of(1, DEMAND).mean.is_nan());
    assert_eq!((of(1, DEMAND).quantiles[2], of(1, DEMAND).max), (f64::INFINITY, f64::INFINITY));
    let acceleration = of(1, "block.peak_acceleration_m_per_s2");
    assert_eq!((acceleration.failures, acceleration.beyond), (ended, 0));
    assert!(acceleration.mean.is_finite());
    // As `fractile` sorts them.
    let (mut displacements, column) = (Vec::new(), numbers(&table, DEMAND));
    for row in rows.iter().filter(|row| row.case.level == 1) {
        let demand = column[row.run as usize];
        displacements.push(if demand.is_nan() { f64::INFINITY } else { demand });
    }
    let expected = crate::numerics::fractile::fractiles(&displacements);
    for (found, expected) in of(1, DEMAND).quantiles.iter().zip(expected) {
        assert!(*found == expected || (found / expected - 1.0).abs() < 1e-14, "{found} {expected}");
    }
}
