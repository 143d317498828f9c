//! Spectra, incremental dynamic analyses, fragilities and designs without a file: each run is that of
//! its model and record alone, on any threads, and the follower stops them.

use core::cell::Cell;
use core::ops::ControlFlow;
use core::sync::atomic::{AtomicU64, Ordering};

use crate::assessment::AssessmentError;
use crate::assessment::design::{DesignRequest, Target, run_design};
use crate::assessment::histories::{Kept, ModelOn, run_histories};
use crate::assessment::ida::{IdaLevels, IdaRequest, run_ida};
use crate::assessment::models::Models;
use crate::assessment::observed::{Data, FitTo, FragilityRequest, run_fragility};
use crate::assessment::single::Job;
use crate::assessment::spectrum::{SpectrumRequest, run_spectrum};
use crate::assessment::suite::{Scaling, Suite};
use crate::error::{SolveError, Stopped};
use crate::input::loaded::Loaded;
use crate::input::{self, Bound};
use crate::motion::GroundMotion;
use crate::motion::intensity::{LevelMeasure, Measure, RotD};
use crate::response::demand_values;
use crate::solver;
use crate::study::Record;
use crate::study::engine::Engine;
use crate::table::Cells;

const MODEL: &str = "[block]\nmass = \"10 t\"\n[slider]\nstatic_friction = 0.06\n\
                     kinetic_friction = 0.05\nradius = \"2 m\"\n[[storey]]\nmass = \"5 t\"\n\
                     period = \"0.5 s\"\ndamping_ratio = 0.05\n[analysis]\ntail = \"1 s\"\n";

const PGA: LevelMeasure = LevelMeasure { measure: Measure::Pga, rotated: None };

fn suite() -> Suite {
    let record = |i: u32| {
        let wave = |k: u32| {
            let t = 0.01 * f64::from(k);
            3.0 * libm::sin((5.0 + f64::from(i)) * t) * libm::sin(19.0 * t) * libm::exp(-0.3 * t)
        };
        let motion = GroundMotion::evenly_spaced(0.01, (0..500).map(wave).collect(), None);
        Record::new(format!("r{i}"), motion.unwrap())
    };
    Suite { records: (0..5).map(record).collect(), ..Suite::default() }
}

fn models(varied: &[(&str, &str)]) -> Models {
    let varied: Vec<_> = varied.iter().map(|(what, text)| (*what, (*text).to_owned())).collect();
    Models::new("m.toml", MODEL, &[], &varied, true).unwrap()
}

/// A follower that stops after so many runs.
fn after(limit: u64, work: impl FnOnce(&Engine<'_>) -> AssessmentError) {
    let runs = AtomicU64::new(0);
    let follow = |more| match runs.fetch_add(more, Ordering::Relaxed) + more {
        runs if runs >= limit => ControlFlow::Break(()),
        _ => ControlFlow::Continue(()),
    };
    assert_eq!(work(&Engine::new(&follow)), AssessmentError::Stopped(Stopped));
}

#[test]
fn runs_of_a_spectrum_are_those_of_each_model_alone() {
    let varied =
        [("friction", "slider.kinetic_friction=0.02,0.05"), ("over", "storey.1.period=0.2..1s:4")];
    let (models, suite) = (models(&varied), suite());
    let scaling = Scaling::Level(PGA, 3.0);
    let request = SpectrumRequest {
        models: &models,
        suite: &suite,
        scaling: &scaling,
        demands: &[],
        bounds: &[],
    };
    let run = run_spectrum(&request, &Engine::unwatched()).unwrap();
    assert_eq!((run.runs, request.runs(), run.failures.len()), (40, 40, 0));
    let column = |name: &str| match &run.rows.find(name).unwrap().cells {
        Cells::Numbers(cells) => cells.clone(),
        _ => panic!("{name} holds no numbers"),
    };
    let factors = suite.scaled(&scaling, &Engine::unwatched()).unwrap().factors;
    for (name, index) in [("peak_sliding_displacement_m", 0), ("storey1_peak_drift_m", 15)] {
        let found = column(name);
        assert_eq!(models.columns()[index].name(), name);
        for (i, found) in found.iter().enumerate() {
            let (design, record) = (i / 5, i % 5);
            let parts = models.parts(&models.grid().values(design)).unwrap();
            let motion = suite.motion(record, factors[record], 1.0).unwrap();
            let alone = solver::exact_demands(&parts.model, &motion).unwrap().demands;
            assert_eq!(found.to_bits(), demand_values(&alone)[index].to_bits(), "{name} {i}");
        }
    }
    // The model on a fixed base feels what it would without sliders: a ratio of 1 where all sticks.
    let ratios = column("storey1_fixed_base_ratio");
    assert!(ratios.iter().all(|ratio| *ratio > 0.0 && ratio.is_finite()));
    after(7, |engine| run_spectrum(&request, engine).unwrap_err());
}

#[test]
fn a_fragility_comes_of_an_ida_without_a_file() {
    let (models, suite) = (models(&[]), suite());
    let levels = IdaLevels::Fixed(vec![0.5, 1.0, 2.0, 4.0, 8.0]);
    let demand = "peak_sliding_displacement_m";
    let request = IdaRequest {
        models: &models,
        suite: &suite,
        measure: PGA,
        demand,
        limit: Some(0.02),
        levels,
        bounds: &[],
        keep: &[],
        by: None,
    };
    let run = run_ida(&request, &Engine::unwatched()).unwrap();
    assert_eq!((run.groups[0].curves.len(), run.rows.rows()), (5, 25));
    let fitted = FragilityRequest {
        table: &run.rows,
        source_name: "ida",
        demand,
        limit: Some(0.02),
        measure: None,
        units: None,
        fit_to: Some(FitTo::Capacities),
        floor: None,
        cap: None,
        keep: &[],
        bootstrap: None,
    };
    let fragility = run_fragility(&fitted, &Engine::unwatched());
    let fragility = fragility.unwrap();
    assert_eq!((fragility.measure.as_str(), fragility.measure_unit.as_str()), ("PGA", "m/s2"));
    let Data::Capacities(capacities) = &fragility.data else { panic!("{:?}", fragility.data) };
    let of_curves = run.groups[0].curves.iter().map(|curve| curve.first_crossing(0.02).level);
    assert!(capacities.iter().map(|c| c.level).eq(of_curves));

    let hunt = IdaRequest { levels: IdaLevels::Hunt { start: 0.1, top: 20.0 }, ..request };
    let run = run_ida(&hunt, &Engine::unwatched()).unwrap();
    for (curve, fixed) in run.groups[0].curves.iter().zip(capacities) {
        let crossing = curve.first_crossing(0.02);
        let [low, high] = crossing.between;
        assert!(crossing.reached && high - low <= 0.01 * high, "{crossing:?} {fixed:?}");
    }
    after(30, |engine| run_ida(&hunt, engine).unwrap_err());
}

/// Levels of RotD50 are those of the pair, and both components take its factor.
#[test]
fn levels_of_an_ida_are_those_of_the_pair_in_all_directions() {
    let (models, mut suite) = (models(&[]), suite());
    suite.records.truncate(4);
    for (i, record) in suite.records.iter_mut().enumerate() {
        record.pair = Some(i / 2);
    }
    let request = |suite, measure| IdaRequest {
        models: &models,
        suite,
        measure: LevelMeasure::parse(measure).unwrap(),
        demand: "peak_sliding_displacement_m",
        limit: Some(0.02),
        levels: IdaLevels::Fixed(vec![2.0, 4.0]),
        bounds: &[],
        keep: &[],
        by: None,
    };
    let run = run_ida(&request(&suite, "RotD50(1.2 s)"), &Engine::unwatched()).unwrap();
    let cells = |name: &str| run.rows.find(name).unwrap().cells.clone();
    let (Cells::Numbers(levels), Cells::Numbers(scales)) = (cells("level"), cells("scale")) else {
        panic!("no numbers")
    };
    let measure = Measure::parse("PSa(1.2 s)").unwrap();
    for (row, (level, scale)) in levels.iter().zip(&scales).enumerate() {
        let [x, y] = [0, 1].map(|component| &suite.records[row / 4 * 2 + component].motion);
        let rotated = RotD::of(&measure, x, y).unwrap();
        assert_eq!(level / rotated.median(), *scale, "row {row}");
    }
    let Cells::Texts(measures) = cells("measure") else { panic!("no texts") };
    assert!(measures.iter().all(|measure| measure == "RotD50(1.2 s)"), "{measures:?}");

    let mut one_alone = suite.clone();
    one_alone.records[3].pair = None;
    let alone = run_ida(&request(&one_alone, "RotD50(1.2 s)"), &Engine::unwatched()).unwrap_err();
    let expected = "measure: expected the other components of all records beside it, `second`";
    assert!(alone.to_string().starts_with(expected), "{alone}");
}

#[test]
fn the_front_of_a_design_is_that_of_all_runs() {
    let varied =
        [("friction", "slider.kinetic_friction=0.02..0.1:5"), ("vary", "slider.radius=1..4m:4")];
    let (models, suite) = (models(&varied), suite());
    let target = Target { gap_m: 0.04, probability: 0.8, acceleration_share: 0.5 };
    let acceleration = models.roof_acceleration();
    let request = DesignRequest {
        models: &models,
        suite: &suite,
        scaling: &Scaling::Factor(1.0),
        target,
        acceleration: &acceleration,
        bounds: Some([0.8, 1.3]),
        sensitivity: 16,
        seed: 1,
        confidence: 0.9,
    };
    let run = run_design(&request, &Engine::unwatched()).unwrap();
    assert!(run.failures.is_empty() && !run.found.front.is_empty(), "{:?}", run.found);
    let column = models.column(&acceleration).unwrap();
    for point in &run.found.front {
        let parts = models.parts(&models.grid().values(point.design)).unwrap();
        let mut demands: Vec<[f64; 2]> = (0..5)
            .map(|record| {
                let motion = suite.motion(record, 1.0, 1.0).unwrap();
                let values =
                    demand_values(&solver::exact_demands(&parts.model, &motion).unwrap().demands);
                [values[0], values[column]]
            })
            .collect();
        // Four of five records keep the displacement, three of five the acceleration.
        demands.sort_by(|a, b| a[0].total_cmp(&b[0]));
        assert_eq!(point.figures.displacement_m, demands[3][0]);
        demands.sort_by(|a, b| a[1].total_cmp(&b[1]));
        assert_eq!(point.figures.acceleration_m_per_s2, demands[2][1]);
    }
    // The map has the figures of every design of the grid, which is small enough.
    let map = run.map.as_ref().unwrap();
    assert_eq!((map.variables, map.x.len(), map.y.len()), ([0, 1], 5, 4));
    for point in &run.found.front {
        let values = models.grid().values(point.design);
        let i = map.x.iter().position(|x| *x == values[0]).unwrap();
        let j = map.y.iter().position(|y| *y == values[1]).unwrap();
        assert_eq!(map.displacement_m[i * 4 + j], point.figures.displacement_m);
        assert_eq!(map.acceleration_m_per_s2[i * 4 + j], point.figures.acceleration_m_per_s2);
    }
    assert_eq!(run.bounded.unwrap().len(), run.found.front.len());
    assert!(run.sensitivity.unwrap().is_ok());
    after(3, |engine| run_design(&request, engine).unwrap_err());
}

/// What is asked for wrongly is named without the dashes of an option.
#[test]
fn choices_are_named() {
    let (models, suite) = (models(&[]), suite());
    let error = models.column("peak_slidng_displacement_m").unwrap_err().to_string();
    assert!(error.starts_with("demand: expected the key of a demand"), "{error}");
    assert!(error.ends_with("nearest is \"peak_sliding_displacement_m\""), "{error}");
    let arias = LevelMeasure { measure: Measure::Arias, rotated: None };
    let error = suite.measure(&arias, &Engine::unwatched()).unwrap_err().to_string();
    assert!(error.starts_with("measure: expected a measure that grows"), "{error}");
}

/// The same numbers on the caller's pool of any size.
#[cfg(feature = "parallel")]
#[test]
fn runs_do_not_depend_on_threads() {
    let varied = [("over", "storey.1.period=0.2..1s:6")];
    let (models, suite) = (models(&varied), suite());
    let scaling = Scaling::Factor(1.5);
    let request = SpectrumRequest {
        models: &models,
        suite: &suite,
        scaling: &scaling,
        demands: &[],
        bounds: &[],
    };
    let run = || format!("{:?}", run_spectrum(&request, &Engine::unwatched()).unwrap().rows);
    let alone = run();
    for threads in [1, 3] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        assert_eq!(pool.install(run), alone, "{threads} threads");
    }
}

/// Designs of an incremental dynamic analysis are run as each alone; averaged, taken apart and kept.
#[test]
fn designs_of_an_ida_are_those_of_each_alone() {
    let (alone, suite) = (models(&[]), suite());
    let demand = "peak_sliding_displacement_m";
    let bounds = [Bound { name: "lower", friction_factor: 0.8 }, Bound::NOMINAL];
    let request = |models, bounds, keep, by| IdaRequest {
        models,
        bounds,
        suite: &suite,
        measure: PGA,
        demand,
        limit: Some(0.02),
        levels: IdaLevels::Fixed(vec![1.0, 2.0, 4.0]),
        keep,
        by,
    };
    let engine = Engine::unwatched();
    let run = |models, bounds, keep, by| run_ida(&request(models, bounds, keep, by), &engine);
    let one = run(&alone, &[], &[], None).unwrap();
    let varied = models(&[("vary", "slider.radius=2, 3 m")]);
    let all = run(&varied, &bounds, &[], Some("slider.radius")).unwrap();
    assert_eq!(all.by, Some(("slider.radius".to_owned(), "m".to_owned())));
    assert_eq!(all.groups.iter().map(|group| group.value).collect::<Vec<_>>(), [2.0, 3.0]);
    let averaged = &all.groups[0].averaged;
    assert_eq!(averaged.to_string(), "averaged over friction: 2 designs");
    assert_eq!(all.groups[0].names[0], "r0, lower");
    // The second half of the first group is the model as it stands.
    assert_eq!(all.groups[0].curves[5..], one.groups[0].curves);
    assert_eq!((all.rows.rows(), all.capacities.unwrap().rows()), (60, 20));

    let radius = ["slider.radius=2 m".to_owned()];
    let by_bound = run(&varied, &bounds, &radius, None).unwrap();
    assert_eq!(by_bound.by.unwrap().0, "friction");
    assert_eq!(by_bound.groups.len(), 2);
    assert_eq!(by_bound.groups[1].curves, one.groups[0].curves);
    assert_eq!(by_bound.groups[0].text, "lower");
    assert_eq!(by_bound.groups[1].averaged.designs, 1);

    let both = run(&varied, &[], &[], None).unwrap();
    assert_eq!(both.groups[0].averaged.to_string(), "averaged over slider.radius: 2 designs");
    assert_eq!(both.groups[0].names[9], "r4, 3 m");
    let error = run(&varied, &[], &[], Some("slider.radios")).unwrap_err().to_string();
    assert!(error.contains("nearest is \"slider.radius\""), "{error}");
}

/// A spectrum with bounds of friction has a group of curves for each, the runs of each alone.
#[test]
fn bounds_of_a_spectrum_are_groups() {
    let (models, suite) = (models(&[("over", "slider.radius=1, 2, 3 m")]), suite());
    let scaling = Scaling::Level(PGA, 3.0);
    let upper = Bound { name: "upper", friction_factor: 1.3 };
    let run = |bounds| {
        let request = SpectrumRequest {
            models: &models,
            suite: &suite,
            scaling: &scaling,
            demands: &[],
            bounds,
        };
        run_spectrum(&request, &Engine::unwatched()).unwrap()
    };
    let (plain, both) = (run(&[]), run(&[Bound::NOMINAL, upper]));
    assert_eq!((plain.runs, both.runs), (15, 30));
    assert_eq!(both.group_bounds, ["nominal", "upper"]);
    assert!(plain.group_bounds.is_empty() && plain.rows.find("friction").is_none());
    assert_eq!(both.curves[0].singles[0], plain.curves[0].singles[0]);
    let parts = models.parts(&[3.0]).unwrap();
    let factors = suite.scaled(&scaling, &Engine::unwatched()).unwrap().factors;
    let motion = suite.motion(4, factors[4], 1.0).unwrap();
    let alone = solver::exact_demands(&upper.of(&parts.model), &motion).unwrap().demands;
    assert_eq!(both.curves[0].singles[1][4][2], alone.peak_sliding_displacement_m);
    let Cells::Texts(friction) = &both.rows.find("friction").unwrap().cells else { panic!() };
    assert_eq!((friction[0].as_str(), friction[29].as_str()), ("nominal", "upper"));
}

/// One long analysis on a sine of so many samples.
fn long(slider: &str, more: &str, samples: usize) -> Job {
    let text = format!("[block]\nmass = \"10 t\"\n[slider]\n{slider}\n{more}");
    let analysis = input::parse("m.toml", &text, &[]).unwrap();
    let wave = |k: usize| 3.0 * libm::sin(0.07 * k as f64);
    let motion = GroundMotion::evenly_spaced(0.01, (0..samples).map(wave).collect(), None);
    Job::new(analysis, Loaded::made(motion.unwrap(), String::new())).unwrap()
}

#[test]
fn one_analysis_is_stopped_wherever_it_is() {
    let storeys = "[[storey]]\nmass = \"5 t\"\nstiffness = \"9 kN/mm\"\ndamping_ratio = 0.05\n";
    let contents =
        "[[contents]]\nfloor = 0\nmass = \"1 kg\"\nstatic_friction = 0.2\nkinetic_friction = 0.2\n";
    let rate = "kinetic_friction = { slow = 0.04, fast = 0.08, rate = \"25 s/m\" }";
    for (what, job) in [
        ("stick", long("static_friction = 0.9\nkinetic_friction = 0.9", storeys, 600_000)),
        ("events", long("static_friction = 0.2\nkinetic_friction = 0.1", "", 500_000)),
        (
            "storeys",
            long("static_friction = 0.2\nkinetic_friction = 0.1", &storeys.repeat(20), 8000),
        ),
        ("rate", long(&format!("static_friction = 0.05\n{rate}"), contents, 2000)),
        (
            "stepwise",
            long(
                "static_friction = 0.2\nkinetic_friction = 0.1\n[analysis]\nmethod = \"stepwise\"",
                storeys,
                20_000,
            ),
        ),
        ("floor spectra", long("static_friction = 0.9\nkinetic_friction = 0.9", "", 110_000)),
    ] {
        let spectra = what == "floor spectra";
        let asked = Cell::new(0);
        let ask = |limit: u32| {
            asked.set(asked.get() + 1);
            if asked.get() < limit { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        };
        let whole = job.run_while(spectra, &|| ask(u32::MAX)).expect(what);
        let times = asked.get();
        assert!(times > if spectra { 200 } else { 3 }, "{what}: asked {times} times");
        // Being asked changes nothing.
        let alone = job.run(spectra).expect(what);
        assert_eq!(whole.nominal.response, alone.nominal.response, "{what}");
        assert_eq!(whole.nominal.certificate, alone.nominal.certificate, "{what}");
        assert_eq!(whole.floor_spectra, alone.floor_spectra, "{what}");
        for limit in [1, times / 2, times] {
            asked.set(0);
            let stopped = job.run_while(spectra, &|| ask(limit)).err();
            assert_eq!(stopped, Some(SolveError::Stopped(Stopped)), "{what}");
            assert_eq!(asked.get(), limit, "{what}");
        }
    }
}

/// A suite of one long record ends within the first of its runs, and its runs are shared out bound by bound.
#[test]
fn a_suite_is_stopped_within_a_run() {
    let analysis = input::parse("m.toml", MODEL, &[]).unwrap();
    let wave = |i: u32| 4.0 * libm::sin(0.07 * f64::from(i)) * libm::sin(0.23 * f64::from(i));
    let motion = GroundMotion::evenly_spaced(0.01, (0..300_000).map(wave).collect(), None);
    let mut suite = suite();
    suite.records.truncate(1);
    suite.records[0].motion = motion.unwrap();
    let model = ModelOn { name: "m", analysis: &analysis, suite: &suite };
    let (asked, done) = (AtomicU64::new(0), AtomicU64::new(0));
    let follow = |runs: u64| {
        done.fetch_add(runs, Ordering::Relaxed);
        asked.fetch_add(1, Ordering::Relaxed);
        if runs == 0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    let found =
        run_histories(&[model], &Scaling::Factor(1.0), Kept::default(), &Engine::new(&follow));
    assert_eq!(found.unwrap_err(), AssessmentError::Stopped(Stopped));
    assert_eq!((asked.into_inner(), done.into_inner()), (1, 0));
}
