//! Every answer says how many of its runs were certified, and what the check does not confirm is no answer.

use crate::assessment::design::{DesignRequest, DesignRun, Target, run_design};
use crate::assessment::histories::{Kept, ModelOn, run_histories};
use crate::assessment::ida::{IdaLevels, IdaRequest, IdaRun, run_ida};
use crate::assessment::models::Models;
use crate::assessment::observed::{Data, FitTo, FragilityRequest, certified, run_fragility};
use crate::assessment::spectrum::{SpectrumRequest, SpectrumRun, run_spectrum};
use crate::assessment::suite::{Scaling, Suite};
use crate::input;
use crate::motion::GroundMotion;
use crate::motion::intensity::{LevelMeasure, Measure};
use crate::notice::Severity;
use crate::study::cases::tests::with_broken;
use crate::study::engine::Engine;
use crate::study::{Case, Certified, Demanded, Record};
use crate::table::Table;

const MODEL: &str = "[block]\nmass = \"10 t\"\n[slider]\nstatic_friction = 0.06\n\
                     kinetic_friction = 0.05\nradius = \"2 m\"\n";
const DEMAND: &str = "peak_sliding_displacement_m";
const PGA: LevelMeasure = LevelMeasure { measure: Measure::Pga, rotated: None };

/// Records of which the last shakes vertically too.
fn suite() -> Suite {
    let record = |i: u32| {
        let wave = |k: u32| {
            let t = 0.02 * f64::from(k);
            3.0 * libm::sin((4.0 + f64::from(i)) * t) * libm::sin(9.0 * t) * libm::exp(-0.3 * t)
        };
        let along: Vec<f64> = (0..250).map(wave).collect();
        let up = (i == 4).then(|| along.iter().map(|a| 0.2 * a).collect());
        Record::new(format!("r{i}"), GroundMotion::evenly_spaced(0.02, along, up).unwrap())
    };
    Suite { records: (0..5).map(record).collect(), ..Suite::default() }
}

fn models(varied: &[(&str, &str)]) -> Models {
    let varied: Vec<_> = varied.iter().map(|(what, text)| (*what, (*text).to_owned())).collect();
    Models::new("m.toml", MODEL, &[], &varied, true).unwrap()
}

fn ida(levels: IdaLevels) -> IdaRun {
    let request = IdaRequest {
        models: &models(&[]),
        suite: &suite(),
        measure: PGA,
        demand: DEMAND,
        limit: Some(0.05),
        levels,
        bounds: &[],
        keep: &[],
        by: None,
    };
    run_ida(&request, &Engine::unwatched()).unwrap()
}

fn fixed() -> IdaLevels {
    IdaLevels::Fixed(vec![1.0, 2.0, 3.0, 4.0, 6.0])
}

fn spectrum() -> SpectrumRun {
    let request = SpectrumRequest {
        models: &models(&[("over", "slider.radius=1..3m:4")]),
        suite: &suite(),
        scaling: &Scaling::Factor(1.0),
        demands: &[],
        bounds: &[],
    };
    run_spectrum(&request, &Engine::unwatched()).unwrap()
}

fn design() -> DesignRun {
    let request = DesignRequest {
        models: &models(&[("vary", "slider.kinetic_friction=0.02..0.2:6")]),
        suite: &suite(),
        scaling: &Scaling::Factor(1.0),
        target: Target { gap_m: 0.2, probability: 1.0, acceleration_share: 0.5 },
        acceleration: "block.peak_acceleration_m_per_s2",
        bounds: Some([0.9, 1.1]),
        sensitivity: 0,
        seed: 1,
        confidence: 0.9,
    };
    run_design(&request, &Engine::unwatched()).unwrap()
}

/// Runs of a table that were certified, and those that the check does not confirm.
fn holds(table: &Table) -> [usize; 2] {
    let cells = table.find("holds").unwrap().cells.to_numbers().unwrap();
    [1.0, 0.0].map(|holds| cells.iter().filter(|cell| **cell == holds).count())
}

fn judged(certified: &Certified, runs: usize) {
    assert_eq!(certified.runs, runs as u64);
    // One of a thousand, and the first with and without a vertical component.
    assert!((2..=3).contains(&certified.certified), "{certified}");
    let worst = certified.worst.as_ref().unwrap();
    assert!(worst.error < 1e-10 && worst.run.starts_with('r'), "{certified}");
    assert_eq!(certified.notice(), None);
    let said = format!("{} of {runs} runs certified; worst: {} (", certified.certified, worst.run);
    assert!(certified.to_string().starts_with(&said), "{certified}");
}

/// Spectra, incremental dynamic analyses of both kinds, designs, fragilities and suites say it of their runs.
#[test]
fn every_answer_says_how_many_of_its_runs_were_certified() {
    for levels in [fixed(), IdaLevels::Hunt { start: 0.5, top: 20.0 }] {
        let ida = ida(levels);
        judged(&ida.certified, ida.rows.rows());
        assert_eq!(holds(&ida.rows), [ida.certified.certified as usize, 0]);
    }
    let spectrum = spectrum();
    judged(&spectrum.certified, 20);
    assert_eq!(holds(&spectrum.rows), [spectrum.certified.certified as usize, 0]);
    let of_design = design();
    let bounded = 2 * 5 * of_design.bounded.as_ref().unwrap().len();
    let runs = of_design.found.runs as usize + bounded;
    assert_eq!(of_design.certified.runs, runs as u64);
    assert!((4..=30).contains(&of_design.certified.certified), "{}", of_design.certified);
    assert_eq!(of_design.certified.notice(), None);
    let table = ida(fixed()).rows;
    let request = fragility_of(&table);
    let of_table = certified(&request).unwrap().unwrap();
    assert_eq!((of_table.runs, of_table.certified as usize), (25, holds(&table)[0]));
    let analysis = input::parse("m.toml", MODEL, &[]).unwrap();
    let on = ModelOn { name: "m", analysis: &analysis, suite: &suite() };
    let suite =
        run_histories(&[on], &Scaling::Factor(1.0), Kept::default(), &Engine::unwatched()).unwrap();
    let of_suite = suite.certified();
    assert_eq!((of_suite.runs, of_suite.certified), (5, 5));
    assert!(of_suite.worst.is_some() && of_suite.unconfirmed.is_empty(), "{of_suite}");
}

fn fragility_of(table: &Table) -> FragilityRequest<'_> {
    FragilityRequest {
        table,
        source_name: "runs",
        demand: DEMAND,
        limit: Some(0.05),
        measure: None,
        units: None,
        fit_to: Some(FitTo::Cloud),
        floor: Some(1e-6),
        cap: None,
        keep: &[],
        bootstrap: None,
    }
}

/// Of the record that shakes vertically the certificates are broken.
fn lifted(case: &Case) -> bool {
    case.record == 4
}

fn refused(certified: &Certified) {
    let first = certified.unconfirmed.first().expect("a run that is not confirmed");
    assert!(first.run.starts_with("r4"), "{first:?}");
    let notice = certified.notice().unwrap();
    assert_eq!(notice.severity(), Severity::Severe, "{notice:?}");
    for part in ["CHECK FAILED for ", &first.run, "demands error of peak sliding displacement"] {
        assert!(notice.message.contains(part), "{part} in {notice:?}");
    }
}

/// A run that is not confirmed is no point of its curve, no value of a fractile and no count.
#[test]
fn what_is_not_confirmed_leaves_the_statistics() {
    let (right, wrong) = (ida(fixed()), with_broken(lifted, || ida(fixed())));
    refused(&wrong.certified);
    let broken: usize = holds(&wrong.rows)[1];
    assert_eq!((broken, wrong.failures.len()), (wrong.certified.unconfirmed.len(), 0));
    let unknown = |run: &IdaRun| {
        let demands = run.groups[0].curves.iter().flat_map(|curve| &curve.demands);
        demands.filter(|demand| **demand == Demanded::Unknown).count()
    };
    assert_eq!((unknown(&right), unknown(&wrong)), (0, broken));
    // A fragility of its table leaves it out, and says so.
    let counted = |run: &IdaRun| {
        let fit = run_fragility(&fragility_of(&run.rows), &Engine::unwatched()).unwrap();
        let Data::Cloud(points) = fit.data else { panic!("a cloud") };
        points.len()
    };
    assert_eq!((counted(&right), counted(&wrong)), (25, 25 - broken));
    refused(&certified(&fragility_of(&wrong.rows)).unwrap().unwrap());
    let wrong = with_broken(lifted, spectrum);
    refused(&wrong.certified);
    let lost = wrong.curves[0].singles[0][4].iter().filter(|value| value.is_nan()).count();
    assert_eq!(lost, wrong.certified.unconfirmed.len());
    let wrong = with_broken(lifted, design);
    refused(&wrong.certified);
    let cells = |name: &str| wrong.runs.find(name).unwrap().cells.to_numbers().unwrap();
    for (holds, demand) in cells("holds").into_iter().zip(cells(DEMAND)) {
        assert!(holds != 0.0 || demand.is_nan(), "{holds} {demand}");
    }
}

/// Answers in memory, and how often one was found.
#[derive(Default)]
struct InMemory {
    lines: std::sync::Mutex<std::collections::HashMap<String, String>>,
    found: core::sync::atomic::AtomicUsize,
}

impl crate::study::kept::KeptRuns for InMemory {
    fn find(&self, key: &str) -> Option<String> {
        let line = self.lines.lock().unwrap().get(key).cloned();
        self.found.fetch_add(usize::from(line.is_some()), core::sync::atomic::Ordering::Relaxed);
        line
    }

    fn keep(&self, key: &str, line: &str) {
        let before = self.lines.lock().unwrap().insert(key.to_owned(), line.to_owned());
        assert_eq!(before, None, "a run was made twice");
    }
}

/// Runs of pairs that were kept are not made again, say the same to the last bit, and serve no other run.
#[test]
fn kept_runs_of_pairs_serve_the_same_runs() {
    use core::sync::atomic::Ordering;

    let mut suite = suite();
    for record in &mut suite.records {
        let motion = &record.motion;
        let y = motion.horizontal_m_per_s2().iter().rev().map(|a| 0.8 * a).collect();
        record.motion = motion.clone().with_y(y).unwrap();
    }
    let kept = InMemory::default();
    let unwatched = Engine::unwatched();
    let engine = unwatched.keeping(&kept);
    let ida = |top: f64, engine: &Engine<'_>| {
        let models = models(&[]).in_plane();
        let request = IdaRequest {
            models: &models,
            suite: &suite,
            measure: PGA,
            demand: DEMAND,
            limit: Some(0.05),
            levels: IdaLevels::Fixed(vec![1.0, 2.0, top]),
            bounds: &[],
            keep: &[],
            by: None,
        };
        run_ida(&request, engine).unwrap()
    };
    let plain = ida(3.0, &unwatched);
    let first = ida(3.0, &engine);
    assert_eq!((kept.lines.lock().unwrap().len(), kept.found.load(Ordering::Relaxed)), (15, 0));
    let second = ida(3.0, &engine);
    assert_eq!(kept.found.load(Ordering::Relaxed), 15);
    let bits = |run: &IdaRun| format!("{run:?}");
    assert_eq!(bits(&first), bits(&plain));
    assert_eq!(bits(&second), bits(&plain));
    let other = ida(4.0, &engine);
    assert_eq!(kept.found.load(Ordering::Relaxed), 25);
    assert_eq!(bits(&other), bits(&ida(4.0, &unwatched)));
}
