//! Rows of a study: the demands of its runs.

use std::ops::Range;
use std::sync::Arc;

use super::cases::{Case, CaseRun, Cases, Noticed, Runs, in_a_cell};
use super::certified::RunKind;
use super::engine::Engine;
use super::kept::InNumbers;
use super::notices::{USUAL_FACTORS, coarse_sampling, longest_step_s};
use super::pieces::runs_in_piece;
use super::{CHUNK, Sample, Study, chunks};
use crate::error::{RunError, Stopped};
use crate::motion::GroundMotion;
use crate::motion::intensity::{IntensityMeasures, LevelMeasure, Measure};
use crate::notice::{NoticeKind, Severity};
use crate::numerics::sort;
use crate::response::Demands;

/// Most samples of scaled copies of a record that are held at a time.
const SAMPLES_AT_ONCE: usize = 4_000_000;

/// Most runs that one thread takes at a time.
const MOST_IN_PIECE: usize = 2048;

/// One run of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Its number, from 0.
    pub run: u64,
    /// Its record, level, sample and bound, and the factor on the record.
    pub case: Case,
    /// Intensity measures of the motion as it was run, without its tail; NaN where there is no
    /// motion. In the order of [`Study::measures`].
    pub measures: Arc<[f64]>,
    /// Values at the varied paths, in SI.
    pub values: Vec<f64>,
    /// Demands in the order of `Study::demand_columns`; NaN where one does not exist, all of them where the
    /// run failed.
    pub demands: Vec<f64>,
    /// Kinds of warnings, each once.
    pub warnings: Vec<NoticeKind>,
    /// Why the run failed, where it did.
    pub error: Option<RunError>,
    /// What it is one of, by which the runs that are certified are chosen.
    pub kind: RunKind,
}

impl Row {
    /// Its kind where it has an answer, which alone can be certified.
    pub(super) fn kind_of_answer(&self) -> Option<RunKind> {
        self.error.is_none().then_some(self.kind)
    }

    /// The travel in m that the run has used up; none where it has an answer, or lacks one for another reason.
    #[must_use]
    pub fn travel_used_up_m(&self) -> Option<f64> {
        self.error.as_ref().and_then(RunError::travel_used_up_m)
    }

    /// The names of its kinds of warnings, joined by `;`.
    #[must_use]
    pub fn kinds(&self) -> String {
        in_a_cell(&self.warnings)
    }
}

/// What rows say of their motion.
#[derive(Clone, Debug)]
struct Shaken {
    measures: Arc<[f64]>,
    /// Longest step of the motion without its tail.
    longest_step_s: f64,
}

/// What rows keep of a response: its demands, and kinds of what is noticed of them.
type Answer = (Vec<f64>, Vec<NoticeKind>);

/// The parts of a study are kept instead.
impl InNumbers for Answer {
    fn numbers(&self) -> Option<Vec<f64>> {
        None
    }

    fn of(_: Vec<f64>) -> Option<Self> {
        None
    }
}

impl Study {
    /// The rows of a range of runs, in order; the engine is told of every run.
    ///
    /// # Errors
    /// [`Stopped`].
    pub fn rows(&self, runs: Range<u64>, engine: &Engine<'_>) -> Result<Vec<Row>, Stopped> {
        let Cases { levels, .. } = self.cases;
        let mut blocks: Vec<Range<u64>> = Vec::new();
        let mut at = runs.start;
        while at < runs.end {
            // All runs of one record at one level stand together.
            let motion = at / self.cases.models();
            let record = motion / levels;
            let length = self.records.get(record as usize).map_or(1, |record| record.motion.len());
            let at_once = (SAMPLES_AT_ONCE / length).max(1) as u64;
            let last = (motion + at_once).min((record + 1) * levels);
            let end = (last * self.cases.models()).min(runs.end);
            blocks.push(at..end);
            at = end;
        }
        let cost = |i: usize| {
            let record = self.case(blocks[i].start).record;
            let samples = self.records.get(record).map_or(1, |record| record.motion.len());
            samples * (blocks[i].end - blocks[i].start) as usize
        };
        let rows =
            engine.map_costliest_first(blocks.len(), cost, |i| self.block(&blocks[i], engine))?;
        Ok(rows.into_iter().flatten().collect())
    }

    /// Runs of one record at some levels: a model is prepared once for all of them.
    fn block(&self, runs: &Range<u64>, engine: &Engine<'_>) -> Result<Vec<Row>, Stopped> {
        let models = self.cases.models();
        let levels: Vec<u64> = (runs.start / models..runs.end.div_ceil(models)).collect();
        let motion = |level: &u64| {
            let Case { record, scale, .. } = self.case(level * models);
            (record, scale)
        };
        let motions: Vec<(usize, f64)> = levels.iter().map(motion).collect();
        let know = |record: usize, scale: f64, motion: &GroundMotion| Shaken {
            measures: self.measures_of(record, scale, motion),
            longest_step_s: longest_step_s(motion),
        };
        let all = Runs::new(&self.records, (&motions, 0.0), &know, engine)?;
        let these = match levels.len() {
            1 => runs.start % models..(runs.end - 1) % models + 1,
            _ => 0..models,
        };
        let samples = self.samples(these.clone(), engine)?;
        let sample = |case: &Case| &samples[(self.cases.model(case) - these.start) as usize];
        let first = samples.iter().find_map(|sample| sample.parts.as_ref().ok());
        let motion = self.records.get(motions[0].0).map(|record| &record.motion);
        let in_piece = first.zip(motion).map_or(MOST_IN_PIECE, |(parts, motion)| {
            runs_in_piece(&parts.model, motion).min(MOST_IN_PIECE)
        });
        let of_chunk = |chunk: Range<u64>| -> Vec<Case> {
            let of_level = |level: &u64| {
                let from = level * models;
                (from + chunk.start).max(runs.start)..(from + chunk.end).min(runs.end)
            };
            levels.iter().flat_map(of_level).map(|run| self.case(run)).collect()
        };
        // All levels of a model in one piece, where that is not too much.
        let designs = (in_piece / levels.len()).clamp(1, CHUNK as usize) as u64;
        let chunks: Vec<Vec<Case>> = chunks(these.clone(), designs).map(of_chunk).collect();
        let pieces: Vec<&[Case]> = chunks.iter().flat_map(|of| of.chunks(in_piece)).collect();
        let design = |case: &Case| {
            let sample = sample(case);
            (&sample.parts, self.turned_rad(&sample.values))
        };
        let ran = all.pieces(&pieces, design, |_, response, _| {
            (self.demands(response), of_demands(&response.demands))
        })?;
        let row = |ran: CaseRun<Answer, Shaken>| self.row(sample(&ran.case), ran);
        let mut rows: Vec<Row> = ran.into_iter().map(row).collect();
        sort(&mut rows, |a, b| a.run.cmp(&b.run));
        Ok(rows)
    }

    fn row(&self, sample: &Sample, ran: CaseRun<Answer, Shaken>) -> Row {
        let CaseRun { case, known, kept, noticed, .. } = ran;
        let parts = sample.parts.as_ref().ok();
        let kind = parts.map(|parts| RunKind::of(parts, self.records.get(case.record)));
        let nothing = || vec![f64::NAN; self.measures.len()].into();
        let measures = known.as_ref().map_or_else(nothing, |known| known.measures.clone());
        let (demands, warnings, error) = match kept {
            Ok((demands, of_demands)) => {
                let step_s = known.map_or(0.0, |known| known.longest_step_s);
                let before = self.noticed(case, &sample.suspicious, sample.highest_hz, step_s);
                (demands, warnings([before, of_demands, Noticed::kinds(&noticed)]), None)
            }
            Err(error) => (vec![f64::NAN; self.demand_columns().len()], Vec::new(), Some(error)),
        };
        let (run, values) = (self.cases.run(&case), sample.values.clone());
        let kind = kind.unwrap_or_default();
        Row { run, case, measures, values, demands, warnings, error, kind }
    }

    /// Kinds of what is noticed of the record, and of model and motion before they are run.
    pub(super) fn noticed(
        &self,
        case: Case,
        suspicious: &[NoticeKind],
        highest_hz: f64,
        longest_step_s: f64,
    ) -> Vec<NoticeKind> {
        let of_record = self.records.get(case.record).map(|record| &record.notices);
        let is_far = of_record.is_some() && !USUAL_FACTORS.contains(&case.scale.abs());
        let far = is_far.then_some(NoticeKind::FactorFar);
        let of_model = coarse_sampling(highest_hz, longest_step_s);
        let of_model = of_model.into_iter().map(|warning| warning.kind);
        let of_record = of_record.into_iter().flatten().map(|notice| notice.kind);
        of_record.chain(far).chain(suspicious.iter().copied()).chain(of_model).collect()
    }

    /// The measures of a record at a level, or of the motion that a model makes. Spectra are taken once a
    /// record: most measures of a scaled motion follow from those of the record.
    fn measures_of(&self, record: usize, scale: f64, scaled: &GroundMotion) -> Arc<[f64]> {
        let Some((kept, record)) = self.unscaled.get(record).zip(self.records.get(record)) else {
            return self.measures.iter().map(|measure| measure.of(scaled)).collect();
        };
        let of = |motion: &GroundMotion| {
            IntensityMeasures::of(motion).columns().map(|(.., value)| value)
        };
        let unscaled = kept.get_or_init(|| {
            if !self.in_plane {
                return of(&record.motion).to_vec();
            }
            let [x, y] = [record.motion.along_x(), record.motion.along_y()];
            of(&x).iter().zip(of(&y)).map(|(x, y)| (x * y).sqrt()).collect()
        });
        let of_scaled = |(measure, unscaled): (&Measure, &f64)| match measure {
            measure if measure.scales() => unscaled * scale.abs(),
            Measure::Arias => unscaled * (scale * scale),
            // A motion times 0 has none of them.
            Measure::D5To75 | Measure::D5To95 | Measure::MeanPeriod if scale != 0.0 => *unscaled,
            measure => {
                let of_pair = LevelMeasure { measure: *measure, rotated: None };
                of_pair.of(scaled, None).unwrap_or(f64::NAN)
            }
        };
        self.measures.iter().zip(unscaled).map(of_scaled).collect()
    }
}

/// Kinds of what is noticed of demands.
pub(super) fn of_demands(demands: &Demands) -> Vec<NoticeKind> {
    let exceeded = demands.gap_ratio.is_some_and(|ratio| ratio > 1.0);
    let slides = demands.slip_count > 0 || demands.sliding_path_m > 0.0;
    let kinds = [(exceeded, NoticeKind::GapExceeded), (!slides, NoticeKind::NothingSlides)];
    kinds.into_iter().filter(|(holds, _)| *holds).map(|(_, kind)| kind).collect()
}

/// Kinds of warnings that a run gives without its certificate, each once: of record, model and motion, of its
/// demands, of its response.
pub(super) fn warnings(noticed: [Vec<NoticeKind>; 3]) -> Vec<NoticeKind> {
    let mut kinds = Vec::new();
    for kind in noticed.into_iter().flatten() {
        if !kinds.contains(&kind) && kind.severity() != Severity::Note {
            kinds.push(kind);
        }
    }
    kinds
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::plan::Plan;
    use crate::model::Model;
    use crate::motion::target::maximum_direction;
    use crate::slider::Friction;
    use crate::solver;
    use crate::study::Record;

    /// A block that slides under 0.4 g for half a second and stops under −0.1 g: friction of 0.2 is
    /// asked for half of what it has.
    #[test]
    fn closest_stop_is_the_share_that_is_left() {
        let g = crate::units::STANDARD_GRAVITY_M_PER_S2;
        let friction = Friction::new(0.2, 0.2).unwrap();
        let model = Model::rigid_block(10.0, friction).unwrap();
        let values = [0.4, 0.4, -0.1, -0.1].map(|a| a * g).to_vec();
        let motion = GroundMotion::new(vec![0.0, 0.5, 0.5, 4.0], values, None).unwrap();
        let demands = solver::exact_demands(&model, &motion).unwrap().demands;
        assert_eq!(demands.stick_count, 1);
        assert!((demands.closest_stop.unwrap() - 0.5).abs() < 1e-13, "{demands:?}");
        let still = motion.scaled(0.25).unwrap();
        assert_eq!(solver::exact_demands(&model, &still).unwrap().demands.closest_stop, None);
    }

    const MODEL: &str = "[block]\nmass = \"10 t\"\n[slider]\nstatic_friction = 0.2\n\
                         kinetic_friction = 0.1\n[[storey]]\nmass = \"5 t\"\nperiod = \"0.5 s\"\n\
                         damping_ratio = 0.05\n";

    fn study(vary: &str, count: u64) -> Study {
        let text = format!(
            "model = \"m.toml\"\n[records]\nfiles = \"*.txt\"\nmeasure = \"PGA\"\n\
             levels = [\"0.2 g\", \"0.5 g\", \"1 g\"]\n[vary]\n{vary}\n[sampling]\n\
             method = \"sobol\"\ncount = {count}\nseed = 9\n"
        );
        let plan = Plan::parse("p.toml", &text).unwrap();
        let record = |name: &str, phase: f64, dt_s: f64| {
            let wave = |i: u32| {
                let t = f64::from(i) * dt_s;
                libm::sin(7.0 * t + phase) * libm::sin(23.0 * t) * libm::exp(-0.2 * t)
            };
            let motion = GroundMotion::evenly_spaced(dt_s, (0..600).map(wave).collect(), None);
            Record::new(name, motion.unwrap())
        };
        let records = vec![record("a", 0.0, 0.01), record("b", 1.0, 0.02)];
        Study::new(&plan, "m.toml", MODEL, records).unwrap()
    }

    fn rows(study: &Study, runs: Range<u64>) -> Vec<Row> {
        study.rows(runs, &Engine::unwatched()).unwrap()
    }

    /// A study of few long runs, all on one thread: it ends within the first of them.
    #[test]
    fn a_study_is_stopped_within_a_run() {
        use core::ops::ControlFlow;
        use core::sync::atomic::{AtomicU64, Ordering};

        let text = "model = \"m.toml\"\n[records]\nfiles = \"*.txt\"\n[vary]\n\
                    slider.kinetic_friction = { values = [0.05, 0.1, 0.15] }\n[sampling]\n\
                    method = \"grid\"\n";
        let plan = Plan::parse("p.toml", text).unwrap();
        let wave = |i: u32| 4.0 * libm::sin(0.07 * f64::from(i)) * libm::sin(0.23 * f64::from(i));
        let motion = GroundMotion::evenly_spaced(0.01, (0..1_000_000).map(wave).collect(), None);
        let record = Record::new("long", motion.unwrap());
        let study = Study::new(&plan, "m.toml", MODEL, vec![record]).unwrap();
        let (asked, done) = (AtomicU64::new(0), AtomicU64::new(0));
        let follow = |runs: u64| {
            done.fetch_add(runs, Ordering::Relaxed);
            asked.fetch_add(1, Ordering::Relaxed);
            if runs == 0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        assert_eq!(study.rows(0..3, &Engine::new(&follow)), Err(Stopped));
        assert_eq!((asked.into_inner(), done.into_inner()), (1, 0));
    }

    /// Any range of runs gives the rows that the whole study has there, and each row is that of the
    /// run alone, from the model's text and with its history.
    #[test]
    fn rows_do_not_depend_on_their_neighbours() {
        let vary = "slider.kinetic_friction = { uniform = [0.02, 0.21] }\n\
                    slider.radius = { uniform = [\"1 m\", \"4 m\"] }";
        let with_tail = format!("{vary}\nanalysis.tail = {{ values = [\"0 s\", \"1.003 s\"] }}");
        for vary in [vary, &with_tail] {
            let study = study(vary, 70);
            assert_eq!(study.runs(), 420);
            let whole = rows(&study, 0..420);
            let bits = |rows: &[Row]| -> Vec<String> {
                rows.iter().map(|row| format!("{row:?}")).collect()
            };
            for range in [0..1, 5..140, 69..71, 200..420, 139..141, 419..420] {
                let part = rows(&study, range.clone());
                let these = &whole[range.start as usize..range.end as usize];
                assert_eq!(bits(&part), bits(these), "{range:?}");
            }
            let failed = whole.iter().filter(|row| row.error.is_some()).count();
            assert!(0 < failed && failed < 60, "{failed}");
            for (run, row) in whole.iter().enumerate() {
                assert_eq!(row.run, run as u64);
                let verdict = study.verify(row);
                assert!(verdict.holds(), "{verdict:?} {row:?}");
            }
            let slid = whole.iter().find(|row| row.demands[0] > 0.0);
            let mut forged = slid.expect("a block that slides").clone();
            forged.demands[0] *= 1.0 + f64::EPSILON;
            assert!(!study.verify(&forged).holds());
        }
    }

    /// Two pairs of components under plans.
    fn of_pairs(pairs: &str, records_table: &str) -> Study {
        let text = format!(
            "model = \"m.toml\"\n[records]\nfiles = \"*x.txt\"\nsecond = \"*y.txt\"\n\
             pairs = \"{pairs}\"\n{records_table}\n"
        );
        let plan = Plan::parse("p.toml", &text).unwrap();
        let record = |i: usize| {
            let wave = |k: u32| {
                let t = 0.01 * f64::from(k);
                let phase = i as f64;
                libm::sin((5.0 + phase) * t + phase) * libm::sin(19.0 * t) * libm::exp(-0.3 * t)
            };
            let motion = GroundMotion::evenly_spaced(0.01, (0..500).map(wave).collect(), None);
            Record { pair: Some(i / 2), ..Record::new(format!("r{i}"), motion.unwrap()) }
        };
        Study::new(&plan, "m.toml", MODEL, (0..4).map(record).collect()).unwrap()
    }

    /// Both components of a pair take one factor, by which the measure of the pair takes its level.
    #[test]
    fn pairs_take_one_factor() {
        for (measure, level) in [("RotD50(0.5 s)", 12.0), ("RotD100(PGA)", 6.0), ("PGA", 6.0)] {
            let keys = format!("measure = \"{measure}\"\nlevels = [\"1 m/s2\", \"{level} m/s2\"]");
            let study = of_pairs("separate", &keys);
            assert!(study.has_pairs() && study.runs() == 8);
            let factor = |record: usize| study.factors[2 * record + 1];
            assert_eq!((factor(0), factor(2)), (factor(1), factor(3)));
            let measure = crate::motion::intensity::LevelMeasure::parse(measure).unwrap();
            for pair in study.records().chunks(2) {
                let factor = factor(pair[0].pair.unwrap() * 2);
                let scaled = [0, 1].map(|i| pair[i].motion.scaled(factor).unwrap());
                let found = measure.of(&scaled[0], Some(&scaled[1])).unwrap();
                assert!((found / level - 1.0).abs() < 1e-12, "{measure}: {found}");
            }
            let table = study.table(&rows(&study, 0..8));
            assert_eq!(table.texts_of("pair").unwrap()[5], "r2");

            let together = of_pairs("together", &keys);
            assert!(together.is_in_plane() && !together.has_pairs() && together.runs() == 4);
            let both = rows(&together, 0..4);
            for (row, (run, first)) in both.iter().zip([(0, "r0"), (1, "r0"), (4, "r2"), (5, "r2")])
            {
                let alone = &rows(&study, run..run + 1)[0];
                assert!(
                    (row.case.scale / alone.case.scale - 1.0).abs() < 1e-14,
                    "{first}: {row:?}"
                );
                assert_eq!(together.records()[row.case.record].name, first);
                let verdict = together.verify(row);
                assert!(verdict.holds(), "{verdict:?} {row:?}");
            }
            let table = together.table(&both);
            let [r, x, y] = ["", "x.", "y."].map(|axis| {
                let name = format!("{axis}peak_sliding_displacement_m");
                let column = table.columns.iter().find(|column| column.name == name).unwrap();
                column.cells.to_numbers().unwrap()
            });
            assert!(r.iter().any(|r| *r > 0.0));
            for ((r, x), y) in r.iter().zip(&x).zip(&y) {
                assert!(x.max(*y) <= *r && *r <= libm::hypot(*x, *y), "{x} {y} {r}");
            }
        }
    }

    /// A pair turned by a right angle moves the table along y as it did along x, and against x as along y;
    /// by half a turn, it slides the other way.
    #[test]
    fn pairs_are_turned() {
        let vary = "[vary]\n\"motion.rotate\" = { values = [\"0 deg\", \"90 deg\", \"180 deg\"] }\n\
                    [sampling]\nmethod = \"grid\"";
        let plain = of_pairs("together", "scale = [12]");
        let study = of_pairs("together", &format!("scale = [12]\n{vary}"));
        assert_eq!((plain.runs(), study.runs()), (2, 6));
        let (plain, turned) = (rows(&plain, 0..2), rows(&study, 0..6));
        assert!(turned.iter().all(|row| study.verify(row).holds()));
        let table = study.table(&turned);
        let column = |name: &str| {
            let column = table.columns.iter().find(|column| column.name == name).unwrap();
            column.cells.to_numbers().unwrap()
        };
        let [r, x, y] =
            ["", "x.", "y."].map(|axis| column(&format!("{axis}peak_sliding_displacement_m")));
        let near = |a: f64, b: f64| a > 0.0 && (a / b - 1.0).abs() < 1e-11;
        for (pair, at) in [(0, 0), (1, 3)] {
            let demands = |row: &Row| row.demands.iter().map(|d| d.to_bits()).collect::<Vec<_>>();
            assert_eq!(demands(&turned[at]), demands(&plain[pair]));
            assert_eq!(turned[at + 1].measures, plain[pair].measures);
            assert!(near(r[at + 1], r[at]) && near(r[at + 2], r[at]), "{r:?}");
            assert!(near(y[at + 1], x[at]) && near(x[at + 1], y[at]), "{x:?} {y:?}");
            assert!(near(x[at + 2], x[at]) && near(y[at + 2], y[at]), "{x:?} {y:?}");
        }
    }

    /// Nothing but pairs that move the table together is turned.
    #[test]
    fn records_in_one_direction_are_not_turned() {
        let plan = Plan::parse(
            "p.toml",
            "model = \"m.toml\"\n[records]\nfiles = \"*x.txt\"\n\
             [vary]\n\"motion.rotate\" = { values = [\"30 deg\"] }\n[sampling]\nmethod = \"grid\"",
        );
        let motion = GroundMotion::evenly_spaced(0.01, vec![1.0; 9], None).unwrap();
        let record = Record::new("r", motion);
        let error = Study::new(&plan.unwrap(), "m.toml", MODEL, vec![record]).unwrap_err();
        assert_eq!(
            error.to_string(),
            "p.toml:5:19: vary.motion.rotate: expected pairs of components that move the table together, \
             which alone are turned, found \"motion.rotate\" of records in one direction"
        );
    }

    /// Pairs are brought to a spectrum by one factor each, and levels are factors besides.
    #[test]
    fn pairs_are_brought_to_a_spectrum() {
        let study = of_pairs(
            "separate",
            "code_spectrum = { sds = \"1 g\", sd1 = \"0.6 g\", tl = \"8 s\" }\n\
             periods = [\"0.2 s\", \"2 s\"]\nscale = [1, 1.5]",
        );
        let matched = study.matched().unwrap();
        let factor = |record: usize, level: usize| study.factors[2 * record + level];
        for pair in 0..2 {
            assert_eq!(factor(2 * pair, 0), matched.factors[pair]);
            assert_eq!(factor(2 * pair + 1, 0), factor(2 * pair, 0));
            assert_eq!(factor(2 * pair, 1), 1.5 * factor(2 * pair, 0));
        }
        assert!(matched.least[0] >= 0.9 * (1.0 - 1e-12), "{:?}", matched.least);
        let scaled = [0, 1].map(|i| study.records()[i].motion.scaled(factor(0, 0)).unwrap());
        let spectrum = maximum_direction(&scaled[0], &scaled[1], &matched.periods_s).unwrap();
        for (found, expected) in matched.pairs_m_per_s2[0].iter().zip(spectrum) {
            assert!((found / expected - 1.0).abs() < 1e-12);
        }
    }

    /// Models of more samples than are kept are made anew, and are the same.
    #[test]
    fn many_samples_are_as_few() {
        let vary = "slider.kinetic_friction = { uniform = [0.02, 0.19] }";
        let study = study(vary, 20_000);
        let rows = rows(&study, 19_990..20_003);
        assert_eq!(rows.len(), 13);
        let Case { record, level, design, .. } = rows[12].case;
        assert_eq!([record, level, design], [0, 1, 2]);
        assert!(rows.iter().all(|row| study.verify(row).holds()));
    }

    /// The follower stops a study between two pieces of it.
    #[test]
    fn a_study_is_stopped() {
        let study = study("slider.kinetic_friction = { uniform = [0.02, 0.19] }", 200);
        let follow = |_| core::ops::ControlFlow::Break(());
        assert_eq!(study.rows(0..study.runs(), &Engine::new(&follow)), Err(Stopped));
    }

    /// Of two rows of two kinds both are certified, and a wrong one is found by its demand; so are all of a few
    /// rows of one kind, and of many the first of each kind.
    #[test]
    fn a_row_of_each_kind_is_certified() {
        let pulse =
            |up| GroundMotion::new(vec![0.0, 0.5, 0.5, 1.5], vec![4.0, 4.0, 0.0, 0.0], up).unwrap();
        let plan = |count: usize| {
            let text = format!(
                "model = \"m.toml\"\n[records]\nfiles = \"*.csv\"\n[vary]\n\
                 \"slider.kinetic_friction\" = {{ uniform = [0.02, 0.04] }}\n\
                 [sampling]\nmethod = \"sobol\"\ncount = {count}\nseed = 1\n"
            );
            Plan::parse("plan.toml", &text).unwrap()
        };
        let records = || {
            let up = Some(vec![0.0, 1.0, -1.0, 0.0]);
            vec![Record::new("flat", pulse(None)), Record::new("lifted", pulse(up))]
        };
        let study = |count: usize| Study::new(&plan(count), "m.toml", MODEL, records()).unwrap();
        let runs = |rows: &[&Row]| rows.iter().map(|row| row.run).collect::<Vec<_>>();
        let two = study(1);
        let mut all = rows(&two, 0..2);
        assert_eq!(runs(&two.to_certify(&all)), [0, 1]);
        assert_ne!(all[0].kind, all[1].kind);
        // A wrong row among two is found, whichever it is.
        for wrong in 0..2 {
            let right = all[wrong].demands[0];
            all[wrong].demands[0] *= 1.0 + 1e-9;
            let found = two.refuted(&all, 1000, &Engine::unwatched()).unwrap();
            assert_eq!(found.map(|(run, _)| run), Some(wrong as u64));
            all[wrong].demands[0] = right;
        }
        let many = study(64);
        let all = rows(&many, 0..128);
        let drawn = (0..128).filter(|run| many.is_drawn(*run));
        let mut expected: Vec<u64> = drawn.chain([0, 64]).collect();
        expected.sort_unstable();
        expected.dedup();
        assert_eq!(runs(&many.to_certify(&all)), expected);
    }

    /// One run of every thousand is drawn, wherever parts are cut, and at least one of all.
    #[test]
    fn one_run_of_a_thousand_is_checked() {
        for (count, checked) in [(70, 1), (500, 3), (3000, 18)] {
            let study = study("slider.kinetic_friction = { uniform = [0.02, 0.19] }", count);
            let of_block = |block: u64| {
                let end = (block + 1000).min(study.runs());
                (block..end).filter(|run| study.is_drawn(*run)).count()
            };
            let counts: Vec<usize> = (0..study.runs()).step_by(1000).map(of_block).collect();
            assert!(counts.len() == checked && counts.iter().all(|n| *n == 1), "{counts:?}");
        }
    }
}
