//! Response-history analyses side by side: models on the records of suites, with lower- and
//! upper-bound friction, and what governs.

pub mod alone;
pub mod floors;
mod kept;
pub mod left_out;
pub mod over_suite;
pub mod profiles;

use self::alone::{ALONE, Alone};
use self::left_out::LeftOut;
use super::floors::FloorSpectra;
use super::lateral::LateralForce;
use super::outline::SlidingOutline;
use super::single::{Job, Judged, Outcome};
use super::suite::{Scaled, Scaling, Suite};
use super::{AssessmentError, FailedRun};
use crate::error::{ChoiceError, RunError, Stopped, similar};
use crate::hash::motion_hash;
use crate::input::loaded::Loaded;
use crate::input::{Analysis, Bound, Names};
use crate::model::Model;
use crate::motion::GroundMotion;
use crate::motion::target::{Matched, TargetSpectrum};
use crate::notice::Notice;
use crate::record::Origin;
use crate::response::{
    DemandColumn, DemandShape, Demands, Method, Response, flat_geometry, struck,
};
use crate::study::cases::{Case, CaseRun, status};
use crate::study::engine::Engine;
use crate::study::kept::{KeptRuns, hash_of_model, hash_of_record, key};
use crate::study::{Certified, Record};
use crate::table::{Cells, Column, Table};

/// From this number of records on their mean governs, of fewer the maximum (ASCE/SEI 7, chapter 17).
pub const RECORDS_OF_A_MEAN: usize = 7;

/// A model and the records that it is run on.
#[derive(Clone, Copy, Debug)]
pub struct ModelOn<'a> {
    /// Its name in tables.
    pub name: &'a str,
    /// The model and how it is analysed.
    pub analysis: &'a Analysis,
    /// The records.
    pub suite: &'a Suite,
}

/// What is kept of the runs besides their demands.
#[derive(Clone, Copy, Debug, Default)]
pub struct Kept<'a> {
    /// Whether floor spectra are wanted.
    pub floor_spectra: bool,
    /// Names of the records whose histories are wanted.
    pub histories_of: &'a [&'a str],
    /// Whether no run is judged: demands alone, in less time.
    pub without_certificates: bool,
}

/// The run of a record whose history was asked for.
#[derive(Clone, Debug)]
pub struct ChosenHistory {
    /// Index of the model.
    pub model: usize,
    /// Index of the record among those of the model.
    pub record: usize,
    /// Index of the bound of friction.
    pub bound: usize,
    /// The response with its history.
    pub response: Response,
}

/// A model on a record.
#[derive(Clone, Debug)]
pub struct OnRecord {
    /// Name of the record.
    pub record: String,
    /// Name of its pair, that of the first component; empty where it is in none.
    pub pair: String,
    /// What its file says of where it was recorded.
    pub origin: Origin,
    /// Short hash of its samples as recorded.
    pub motion_hash: String,
    /// Factor on it.
    pub scale: f64,
    /// Peak of the horizontal acceleration as it was run, in m/s²; in two directions of the resultant.
    pub pga_m_per_s2: f64,
    /// What came of each bound of friction, in the order of [`ModelHistories::bounds`]; or why nothing did.
    pub runs: Vec<Result<CertifiedRun, FailedRun>>,
    /// Of a pair that was run together what its components say by themselves, with each bound; else none.
    pub alone: Vec<Option<Alone>>,
    /// How it slides with nominal friction; empty where it was not run so.
    pub sliding: SlidingOutline,
    /// What reading it and running it gave notice of.
    pub notices: Vec<Notice>,
}

/// A run with an answer.
#[derive(Clone, Debug)]
pub struct CertifiedRun {
    /// Its demands.
    pub demands: Demands,
    /// In two directions those along x and along y.
    pub axes: Option<Box<[Demands; 2]>>,
    /// What the check does not confirm of it; none where its certificate holds.
    pub defect: Option<String>,
    /// The largest figure of its certificate by its name; none of a run without one.
    pub largest: Option<(String, f64)>,
    /// Floor spectra, where they were asked for.
    pub floor_spectra: Option<FloorSpectra>,
}

impl OnRecord {
    /// Whether the check does not confirm a run of it.
    #[must_use]
    pub fn is_unconfirmed(&self) -> bool {
        self.runs.iter().flatten().any(|run| run.defect.is_some())
    }

    /// The size of a demand with a bound of friction; NaN where there is none.
    #[must_use]
    pub fn size(&self, column: &DemandColumn, bound: usize) -> f64 {
        self.value(column, bound).abs()
    }

    /// A demand with a bound of friction; NaN where there is none.
    #[must_use]
    pub fn value(&self, column: &DemandColumn, bound: usize) -> f64 {
        let demands = self.runs.get(bound).and_then(|run| run.as_ref().ok());
        demands.and_then(|run| column.value(&run.demands)).unwrap_or(f64::NAN)
    }
}

/// A model on all its records.
#[derive(Clone, Debug)]
pub struct ModelHistories {
    /// Its name.
    pub name: String,
    /// Hash of the model.
    pub hash: String,
    /// What its block and its storeys are called.
    pub names: Names,
    /// Weight `W` of all that is isolated, in N.
    pub weight_n: f64,
    /// Weight `W_s` of the structure above the block, where there is one, in N.
    pub above_block_n: Option<f64>,
    /// The gap of its slider in m, where it has one.
    pub gap_m: Option<f64>,
    /// Travel of each of its surfaces in series in m, where it ends.
    pub travels_m: Vec<Option<f64>>,
    /// Where its stop stands towards +x and −x, in m, where there is one.
    pub stop_m: [Option<f64>; 2],
    /// Heights of the block, 0, and of the storeys or points above it in m, where the model gives all of them.
    pub levels_m: Option<Vec<f64>>,
    /// The bounds of friction that were run.
    pub bounds: Vec<Bound>,
    /// Its records in their order.
    pub records: Vec<OnRecord>,
    /// Whether its runs were judged.
    pub certifying: bool,
    /// How the record slides that slides farthest with the bound of friction that governs.
    pub farthest: Option<Farthest>,
    /// Of each bound the displacement of the equivalent-lateral-force procedure under the target spectrum,
    /// where there is one of both.
    pub lateral: Vec<Option<LateralForce>>,
    /// What running components by themselves leaves out, of a model that cannot be run under both.
    pub left_out: Option<LeftOut>,
}

/// How the record slides that slides farthest with the bound of friction that governs.
#[derive(Clone, Debug)]
pub struct Farthest {
    /// Index of the record.
    pub record: usize,
    /// Index of the bound.
    pub bound: usize,
    /// How it slides.
    pub sliding: SlidingOutline,
}

/// What came of all models.
#[derive(Clone, Debug)]
pub struct Histories {
    /// The models in their order.
    pub models: Vec<ModelHistories>,
    /// What the models have that demands are asked of.
    pub shape: DemandShape,
    /// Every run: model, record, bound, scale, peak acceleration, whether its certificate holds, demands.
    pub runs: Table,
    /// What governs: model, bound, statistic, demands.
    pub governing: Table,
    /// Floor spectra over the suites: model, bound, place, direction, period, statistics; none where they were not
    /// asked for.
    pub floor_spectra: Option<Table>,
    /// Demands over the height over the suites: model, bound, demand, level, statistics; none without two storeys.
    pub profiles: Option<Table>,
    /// Runs whose histories were asked for: model by model, record by record, bound by bound.
    pub chosen: Vec<ChosenHistory>,
    /// How pairs were brought to a target spectrum, and their names.
    pub matched: Option<(Matched, Vec<String>)>,
    /// What was noticed of the records together, each once.
    pub notices: Vec<Notice>,
}

impl Histories {
    /// How many runs of all models were certified, each by its model where there are several.
    #[must_use]
    pub fn certified(&self) -> Certified {
        let mut all = Certified::default();
        for model in &self.models {
            let mut of_model = model.certified();
            if self.models.len() > 1 {
                let worst = of_model.worst.iter_mut().map(|worst| &mut worst.run);
                let refused = of_model.unconfirmed.iter_mut().map(|refused| &mut refused.run);
                worst.chain(refused).for_each(|run| *run = format!("{}: {run}", model.name));
            }
            all.join(of_model);
        }
        all
    }
}

impl ModelHistories {
    /// What the model has that demands are asked of.
    #[must_use]
    pub fn shape(&self) -> DemandShape {
        let first = self.runs().find_map(|run| run.as_ref().ok());
        first.map_or_else(DemandShape::default, |run| run.demands.shape())
    }

    /// The records of each earthquake: both components of a pair, or a record alone.
    fn earthquakes(&self) -> impl Iterator<Item = &[OnRecord]> {
        self.records.chunk_by(|a, b| !a.pair.is_empty() && a.pair == b.pair)
    }

    /// All runs: record by record, bound by bound.
    pub fn runs(&self) -> impl Iterator<Item = &Result<CertifiedRun, FailedRun>> {
        self.records.iter().flat_map(|on| &on.runs)
    }

    /// The runs that the check does not confirm: the record, the bound and what is not confirmed. The records of
    /// such runs are in no mean and no maximum.
    pub fn unconfirmed(&self) -> impl Iterator<Item = (&OnRecord, &Bound, &str)> {
        self.records.iter().flat_map(move |on| {
            let of_bounds = self.bounds.iter().zip(&on.runs);
            of_bounds.filter_map(move |(bound, run)| {
                Some((on, bound, run.as_ref().ok()?.defect.as_deref()?))
            })
        })
    }

    /// How many of the runs were certified: all that have an answer, but for those of the stepwise method.
    #[must_use]
    pub fn certified(&self) -> Certified {
        let mut certified = Certified::default();
        for on in &self.records {
            for (bound, run) in self.bounds.iter().zip(&on.runs) {
                let name = match self.bounds.len() {
                    1 => on.record.clone(),
                    _ => format!("{} with {} friction", on.record, bound.name),
                };
                certified.runs += 1;
                if let Ok(CertifiedRun { largest: largest @ Some(_), defect, .. }) = run {
                    certified.add_judged(&name, largest.clone(), defect.clone());
                }
            }
        }
        certified
    }

    /// The runs without an answer.
    pub fn failures(&self) -> impl Iterator<Item = &FailedRun> {
        self.runs().filter_map(|run| run.as_ref().err())
    }

    /// Whether the records are pairs of components.
    #[must_use]
    pub fn has_pairs(&self) -> bool {
        self.records.iter().any(|on| !on.pair.is_empty())
    }

    /// Whether the records are pairs of components, run together or separately.
    #[must_use]
    pub fn of_pairs(&self) -> bool {
        self.has_pairs() || self.is_in_plane()
    }

    /// The mean or the maximum of sizes, one an earthquake; NaN where one has none.
    fn statistic_of(&self, sizes: &[f64]) -> f64 {
        if sizes.iter().any(|size| size.is_nan()) {
            return f64::NAN;
        }
        match self.statistic() {
            "mean" => sizes.iter().sum::<f64>() / sizes.len() as f64,
            _ => largest(sizes),
        }
    }

    /// What governs over the suite of a demand with a bound: of the resultant, or along one of two directions where an axis
    /// is given; none where a run does not have it.
    #[must_use]
    pub fn governing_along(
        &self,
        bound: usize,
        axis: Option<usize>,
        of: impl Fn(&Demands) -> Option<f64>,
    ) -> Option<f64> {
        let over = self.over_suite(|on| {
            let run = on.runs.get(bound).and_then(|run| run.as_ref().ok());
            let demands = run.map(|run| match (&run.axes, axis) {
                (Some(axes), Some(axis)) => &axes[axis],
                _ => &run.demands,
            });
            demands.and_then(&of).map_or(f64::NAN, f64::abs)
        });
        over.map(|over| self.governing_of(&over))
    }

    /// Number of pairs, or of records alone, that the mean or the maximum is of.
    #[must_use]
    pub fn counted(&self) -> usize {
        self.earthquakes().filter(|records| is_confirmed(records)).count()
    }

    /// Number of pairs, or of records alone.
    #[must_use]
    pub fn of_earthquakes(&self) -> usize {
        self.earthquakes().count()
    }

    /// Name of the statistic that governs: `mean` from [`RECORDS_OF_A_MEAN`] records or pairs on, else
    /// `maximum`.
    #[must_use]
    pub fn statistic(&self) -> &'static str {
        if self.counted() >= RECORDS_OF_A_MEAN { "mean" } else { "maximum" }
    }

    /// The sizes of a demand with a bound of friction, record by record; NaN where there is none.
    #[must_use]
    pub fn sizes(&self, column: &DemandColumn, bound: usize) -> Vec<f64> {
        self.records.iter().map(|on| on.size(column, bound)).collect()
    }

    /// The mean of these sizes, or their maximum; of a pair the larger of both components counts. NaN where
    /// a record has none.
    #[must_use]
    pub fn governing(&self, column: &DemandColumn, bound: usize) -> f64 {
        let over = self.over_suite(|on| on.size(column, bound));
        over.map_or(f64::NAN, |over| self.governing_of(&over))
    }

    /// How many of the earthquakes that count have a size above a limit, and the record whose size is the largest; of a
    /// pair the larger of both components. None where a record has none.
    #[must_use]
    pub fn beyond(
        &self,
        limit: f64,
        size: impl Fn(&OnRecord) -> f64,
    ) -> Option<(usize, &OnRecord, f64)> {
        let over = self.of_each_earthquake(&size)?;
        let count = over.iter().filter(|size| **size > limit).count();
        let confirmed = self.earthquakes().filter(|records| is_confirmed(records)).flatten();
        let sized = confirmed.map(|on| (on, size(on)));
        let (on, most) = sized.reduce(|a, b| if b.1 > a.1 { b } else { a })?;
        Some((count, on, most))
    }

    /// The bound with which a demand governs, and the demand; `None` where no record has it.
    #[must_use]
    pub fn governs(&self, column: &DemandColumn) -> Option<(&Bound, f64)> {
        self.governing_bound(column).map(|i| (&self.bounds[i], self.governing(column, i)))
    }

    /// Index of the bound with which a demand governs; none where a run has no answer.
    #[must_use]
    pub fn governing_bound(&self, column: &DemandColumn) -> Option<usize> {
        let all = (0..self.bounds.len()).map(|i| (i, self.governing(column, i)));
        let all: Vec<(usize, f64)> = all.filter(|_| self.failures().next().is_none()).collect();
        let all = all.into_iter().filter(|(_, value)| !value.is_nan());
        all.reduce(|a, b| if b.1 > a.1 { b } else { a }).map(|(i, _)| i)
    }
}

/// Whether the check confirms every run of a record, or of both components of a pair.
fn is_confirmed(records: &[OnRecord]) -> bool {
    !records.iter().any(OnRecord::is_unconfirmed)
}

fn largest(sizes: &[f64]) -> f64 {
    sizes.iter().fold(0.0, |most: f64, size| most.max(*size))
}

/// Runs every model on every one of its records and with the bounds of friction that it gives; a record in two
/// horizontal directions as one motion, and what each of its components says by itself beside it. Histories are kept of
/// the records that `kept` names, each of these runs once more.
///
/// # Errors
/// [`AssessmentError`] for records that cannot be scaled so, and for a name that is none of theirs. A record without
/// an answer is one with its reason, and with it there is no mean or maximum.
pub fn run_histories(
    models: &[ModelOn<'_>],
    scaling: &Scaling,
    kept: Kept<'_>,
    engine: &Engine<'_>,
) -> Result<Histories, AssessmentError> {
    for name in kept.histories_of {
        known(name, models)?;
    }
    let mut done = Vec::with_capacity(models.len());
    let mut matched = None;
    for model in models {
        let Scaled { factors, matched: of_target } = model.suite.scaled(scaling, engine)?;
        matched = matched.or(of_target.map(|matched| (matched, model.suite.names_of_pairs())));
        let bounds = bounds(model.analysis);
        // Record by record, each with every bound.
        let cases = factors.len() * bounds.len();
        let case = |i: usize| {
            let (record, bound) = (i / bounds.len(), i % bounds.len());
            Case { record, bound, scale: factors[record], ..Case::default() }
        };
        let hashes = hashes(model.suite, kept, engine)?;
        let run = |i: usize| {
            let (case, bound) = (case(i), &bounds[i % bounds.len()]);
            let keeper = keeper(model, (&case, bound), &hashes, engine);
            let before = keeper.as_ref().and_then(|(all, key)| all.find(key));
            if let Some(run) = before.and_then(|line| kept::read(&line)) {
                return CaseRun::of(case, Ok(run));
            }
            let figures = match kept.without_certificates {
                true => unjudged(model, &case, bound, kept.floor_spectra, engine),
                false => with_bound(model, &case, bound, kept.floor_spectra, engine)
                    .map(|judged| RunFigures::of(bound, judged)),
            };
            let ran = figures.map(|figures| {
                let alone = alone::of(model, &case, bound, engine).ok().flatten();
                RunFigures { alone, ..figures }
            });
            if let (Some((all, key)), Some(line)) = (keeper, ran.as_ref().ok().and_then(kept::line))
            {
                all.keep(&key, &line);
            }
            CaseRun::of(case, ran)
        };
        let mut ran = engine.runs(cases, run)?.into_iter();
        let on =
            |with: (usize, &f64)| on_record(model, with, &bounds, ran.by_ref().take(bounds.len()));
        let records = factors.iter().enumerate().map(on).collect();
        let slider = model.analysis.model.slider();
        let mut of_model = ModelHistories {
            name: model.name.to_owned(),
            hash: model.analysis.hash(),
            names: model.analysis.names.clone(),
            weight_n: model.analysis.model.weight_n(),
            above_block_n: above_block_n(&model.analysis.model),
            gap_m: slider.gap_m(),
            travels_m: slider.surfaces().iter().map(|on| on.travel_m).collect(),
            stop_m: slider.stop_m(),
            levels_m: profiles::levels_m(&model.analysis.model),
            certifying: !kept.without_certificates,
            farthest: None,
            lateral: match scaling {
                Scaling::Target(spectrum, _) => lateral(model.analysis, spectrum),
                _ => Vec::new(),
            },
            bounds,
            records,
            left_out: None,
        };
        of_model.left_out = left_out::of(model, &of_model);
        of_model.farthest = farthest(model, &of_model, engine);
        done.push(of_model);
    }
    let shapes = done.iter().map(ModelHistories::shape);
    let shape = shapes.fold(DemandShape::default(), |all, shape| DemandShape {
        storeys: all.storeys.max(shape.storeys),
        points: all.points.max(shape.points),
        stop: all.stop || shape.stop,
        surfaces: all.surfaces.max(shape.surfaces),
        contents: all.contents.max(shape.contents),
    });
    let (runs, governing) = (table_of_runs(&done, shape), table_of_governing(&done, shape));
    let (floor_spectra, profiles) = (floors::table(&done), profiles::table(&done));
    let chosen = chosen(models, &done, kept.histories_of, engine)?;
    let mut notices: Vec<Notice> = Vec::new();
    for notice in models.iter().flat_map(|model| &model.suite.notices) {
        if !notices.contains(notice) {
            notices.push(notice.clone());
        }
    }
    Ok(Histories {
        models: done,
        shape,
        runs,
        governing,
        floor_spectra,
        profiles,
        chosen,
        matched,
        notices,
    })
}

/// Hashes of the records that are run in two directions, where runs are kept.
fn hashes(
    suite: &Suite,
    kept: Kept<'_>,
    engine: &Engine<'_>,
) -> Result<Vec<Option<String>>, Stopped> {
    // What is kept has its certificate.
    let whole = !kept.floor_spectra && !kept.without_certificates;
    let keeps = engine.kept().is_some() && whole;
    let count = if keeps { suite.records.len() } else { 0 };
    engine.map(count, |i| Ok(hash_of_record(&suite.records[i])))
}

/// Where a run is kept, and its key.
fn keeper<'a>(
    model: &ModelOn<'_>,
    (case, bound): (&Case, &Bound),
    hashes: &[Option<String>],
    engine: &Engine<'a>,
) -> Option<(&'a dyn KeptRuns, String)> {
    let of_record = hashes.get(case.record)?.as_deref()?;
    let of_design = hash_of_model(&bound.of(&model.analysis.model), model.analysis.tail_s);
    Some((engine.kept()?, key(&of_design, of_record, case.scale)))
}

/// Refuses a name that no record of the models has.
fn known(name: &str, models: &[ModelOn<'_>]) -> Result<(), AssessmentError> {
    let mut names = models.iter().flat_map(|model| &model.suite.records).map(|of| &of.name[..]);
    if names.clone().any(|known| known == name) {
        return Ok(());
    }
    let nearest = similar(name, names.clone());
    let first = names.next().unwrap_or_default();
    Err(AssessmentError::Choice(ChoiceError {
        what: "history-of".to_owned(),
        expected: format!("the name of a record of the suite, such as {first}"),
        found: format!("{name:?}"),
        nearest,
    }))
}

/// The runs of some records once more, each with its history; a run without an answer has none.
fn chosen(
    models: &[ModelOn<'_>],
    done: &[ModelHistories],
    names: &[&str],
    engine: &Engine<'_>,
) -> Result<Vec<ChosenHistory>, Stopped> {
    let mut cases = Vec::new();
    for (model, of) in done.iter().enumerate() {
        let is_chosen = |on: &OnRecord| names.contains(&&on.record[..]);
        for (record, on) in of.records.iter().enumerate().filter(|(_, on)| is_chosen(on)) {
            let bounds = 0..of.bounds.len();
            cases.extend(
                bounds.map(|bound| {
                    (model, Case { record, bound, scale: on.scale, ..Case::default() })
                }),
            );
        }
    }
    let ran = engine.runs(cases.len(), |i| {
        let (model, case) = &cases[i];
        let bound = &done[*model].bounds[case.bound];
        let (_, outcome) = with_bound(&models[*model], case, bound, false, engine).ok()?;
        let (record, bound) = (case.record, case.bound);
        Some(ChosenHistory { model: *model, record, bound, response: outcome.nominal.response })
    })?;
    Ok(ran.into_iter().flatten().collect())
}

/// Weight above the block in N; none of a block alone.
fn above_block_n(model: &Model) -> Option<f64> {
    let of_frame = || model.frame().masses_kg.iter().sum::<f64>();
    let structure_kg = model.structure().map_or_else(of_frame, |structure| structure.mass_kg);
    let contents = model.contents().iter().filter(|contents| contents.floor > 0);
    let contents_kg: f64 = contents.map(|contents| contents.mass_kg).sum();
    (structure_kg > 0.0).then(|| (structure_kg + contents_kg) * model.gravity_m_per_s2())
}

/// The bounds of friction that an analysis asks for.
pub(crate) fn bounds(analysis: &Analysis) -> Vec<Bound> {
    analysis.friction_bounds.map_or_else(|| vec![Bound::NOMINAL], |bounds| bounds.all().to_vec())
}

/// The displacement of the equivalent-lateral-force procedure with each bound under a spectrum.
pub(crate) fn lateral(analysis: &Analysis, spectrum: &TargetSpectrum) -> Vec<Option<LateralForce>> {
    let of = |bound: &Bound| LateralForce::of(&bound.of(&analysis.model), spectrum);
    bounds(analysis).iter().map(of).collect()
}

/// What is kept of a run.
struct RunFigures {
    demands: Demands,
    axes: Option<Box<[Demands; 2]>>,
    defect: Option<String>,
    largest: Option<(String, f64)>,
    alone: Option<Alone>,
    floor_spectra: Option<FloorSpectra>,
    /// How it slides; of nominal friction alone.
    sliding: Option<SlidingOutline>,
    /// What was noticed of model and motion, of the response, and of its demands.
    noticed: [Vec<Notice>; 3],
}

impl RunFigures {
    fn of(bound: &Bound, (job, outcome): (Job, Outcome)) -> Self {
        let Outcome { nominal, floor_spectra, .. } = outcome;
        let Judged { response, certificate, .. } = nominal;
        let judged = response.method != Method::Stepwise;
        let defect = (judged && !certificate.holds()).then(|| {
            let names = certificate.defects().into_iter().map(|(name, _)| name);
            names.collect::<Vec<_>>().join(", ")
        });
        let largest = judged.then(|| certificate.largest());
        Self { defect, largest, ..Self::unjudged(bound, job, response, floor_spectra) }
    }

    fn unjudged(
        bound: &Bound,
        job: Job,
        response: Response,
        floor_spectra: Option<FloorSpectra>,
    ) -> Self {
        let (nominal, model) = (*bound == Bound::NOMINAL, &job.analysis.model);
        let sliding = if nominal { SlidingOutline::of(&response) } else { None };
        let met = struck(model, &response.demands).into_iter();
        let met = met.chain(flat_geometry(model, &response.demands));
        Self {
            defect: None,
            largest: None,
            alone: None,
            floor_spectra,
            sliding,
            noticed: [job.warnings, response.warnings, met.collect()],
            axes: response.in_plane.map(|plane| Box::new(plane.axes)),
            demands: response.demands,
        }
    }
}

/// The runs of a record, one a bound of friction.
fn on_record(
    model: &ModelOn<'_>,
    (record, scale): (usize, &f64),
    bounds: &[Bound],
    ran: impl Iterator<Item = CaseRun<RunFigures>>,
) -> OnRecord {
    let several = if bounds.len() > 1 { bounds } else { &[] };
    let in_words = model.suite.in_words(several, &|_| String::new());
    let Record { name, motion, origin, notices, .. } = &model.suite.records[record];
    let mut on = OnRecord {
        record: name.clone(),
        pair: model.suite.pair_name(record).to_owned(),
        origin: origin.clone(),
        motion_hash: motion_hash(motion),
        scale: *scale,
        pga_m_per_s2: scale.abs() * motion.figures().pga_m_per_s2,
        runs: Vec::new(),
        alone: Vec::new(),
        sliding: SlidingOutline::default(),
        notices: notices.clone(),
    };
    let mut met = Vec::new();
    for (bound, CaseRun { case, kept, .. }) in bounds.iter().zip(ran) {
        on.alone.push(kept.as_ref().ok().and_then(|kept| kept.alone));
        let run = kept.map_err(|error| in_words.failed(&case, &error));
        let run = run.map(|kept| on.take(bound, bounds.len() > 1, kept, &mut met));
        on.runs.push(run);
    }
    // Of a kind that several bounds give, the one with which the block slides farthest is told first.
    met.sort_by(|a: &(f64, Notice), b| b.0.total_cmp(&a.0));
    on.notices.extend(met.into_iter().map(|(_, notice)| notice));
    on
}

/// The run of a record with a bound of friction, with its history and its certificate.
fn with_bound(
    model: &ModelOn<'_>,
    case: &Case,
    bound: &Bound,
    floor_spectra: bool,
    engine: &Engine<'_>,
) -> Result<(Job, Outcome), RunError> {
    let motion = model.suite.motion(case.record, case.scale, 0.0)?;
    judged(model.analysis, motion, bound, floor_spectra, engine)
}

/// The same without the certificate.
fn unjudged(
    model: &ModelOn<'_>,
    case: &Case,
    bound: &Bound,
    floor_spectra: bool,
    engine: &Engine<'_>,
) -> Result<RunFigures, RunError> {
    let motion = model.suite.motion(case.record, case.scale, 0.0)?;
    let job = job(model.analysis, motion, bound)?;
    let (response, spectra) = engine.watch(|go_on| job.solve_while(floor_spectra, go_on))?;
    Ok(RunFigures::unjudged(bound, job, response, spectra))
}

/// A model with a bound of friction on a motion.
fn job(analysis: &Analysis, motion: GroundMotion, bound: &Bound) -> Result<Job, RunError> {
    let mut analysis = analysis.clone();
    analysis.friction_bounds = None;
    analysis.model = bound.of(&analysis.model);
    Ok(Job::new(analysis, Loaded::made(motion, String::new()))?)
}

fn judged(
    analysis: &Analysis,
    motion: GroundMotion,
    bound: &Bound,
    floor_spectra: bool,
    engine: &Engine<'_>,
) -> Result<(Job, Outcome), RunError> {
    let job = job(analysis, motion, bound)?;
    let outcome = engine.watch(|go_on| job.run_while(floor_spectra, go_on))?;
    Ok((job, outcome))
}

impl OnRecord {
    /// Takes what the tables and the figure tell of a run; what it comes to the end of goes to `all_met`, with how far
    /// it slides.
    fn take(
        &mut self,
        bound: &Bound,
        several: bool,
        kept: RunFigures,
        all_met: &mut Vec<(f64, Notice)>,
    ) -> CertifiedRun {
        let of_bound = |warning: Notice| match several {
            false => warning,
            true => {
                let message = format!("{} friction: {}", bound.name, warning.message);
                Notice { message, ..warning }
            }
        };
        let [of_job, of_response, met] = kept.noticed;
        for notice in of_job {
            if !self.notices.contains(&notice) {
                self.notices.push(notice);
            }
        }
        self.sliding = kept.sliding.unwrap_or_else(|| core::mem::take(&mut self.sliding));
        self.notices.extend(of_response);
        let far_m = kept.demands.peak_sliding_displacement_m;
        all_met.extend(met.into_iter().map(|notice| (far_m, of_bound(notice))));
        let RunFigures { demands, axes, defect, largest, floor_spectra, .. } = kept;
        CertifiedRun { demands, axes, defect, largest, floor_spectra }
    }
}

/// The run of the record that slides farthest with the bound that governs, once more for its history.
fn farthest(model: &ModelOn<'_>, of: &ModelHistories, engine: &Engine<'_>) -> Option<Farthest> {
    let peak = of.shape().find("peak_sliding_displacement_m")?.1;
    let bound = of.governing_bound(&peak)?;
    let sizes = of.sizes(&peak, bound);
    let confirmed = (0..sizes.len()).filter(|&i| !of.records[i].is_unconfirmed());
    let record = confirmed.reduce(|a, b| if sizes[b] > sizes[a] { b } else { a })?;
    let case = Case { record, bound, scale: of.records[record].scale, ..Case::default() };
    let (_, outcome) = with_bound(model, &case, &of.bounds[bound], false, engine).ok()?;
    let sliding = SlidingOutline::of(&outcome.nominal.response)?;
    Some(Farthest { record, bound, sliding })
}

/// Every run as a row.
fn table_of_runs(models: &[ModelHistories], shape: DemandShape) -> Table {
    let mut rows = Vec::new();
    for model in models {
        for on in &model.records {
            rows.extend((0..model.bounds.len()).map(|i| (model, on, i)));
        }
    }
    let mut table = Table::default();
    table
        .texts("model", rows.iter().map(|(model, ..)| model.name.clone()).collect())
        .texts("record", rows.iter().map(|(_, on, _)| on.record.clone()).collect())
        .texts("friction", rows.iter().map(|(m, _, i)| m.bounds[*i].name.to_owned()).collect());
    if models.iter().any(ModelHistories::has_pairs) {
        table.texts("pair", rows.iter().map(|(_, on, _)| on.pair.clone()).collect());
    }
    table.numbers("scale", "", rows.iter().map(|(_, on, _)| on.scale).collect()).numbers(
        "pga_m_per_s2",
        "m/s2",
        rows.iter().map(|(_, on, _)| on.pga_m_per_s2).collect(),
    );
    let holds = rows.iter().map(|(model, on, i)| {
        let run = on.runs[*i].as_ref().ok()?;
        model.certifying.then(|| run.defect.is_none())
    });
    let holds = holds.collect();
    table.columns.push(Column {
        name: "holds".to_owned(),
        unit: String::new(),
        cells: Cells::Flags(holds),
    });
    for column in shape.columns() {
        let value = |(_, on, i): &(_, &OnRecord, usize)| on.value(&column, *i);
        table.numbers(&column.name(), column.unit(), rows.iter().map(value).collect());
    }
    if models.iter().any(ModelHistories::is_in_plane) {
        for (name, of) in ALONE {
            let value =
                |(_, on, i): &(_, &OnRecord, usize)| on.alone[*i].map_or(f64::NAN, |a| of(&a));
            table.numbers(name, "m", rows.iter().map(value).collect());
        }
    }
    let status = |(_, on, i): &(_, &OnRecord, usize)| {
        status(on.runs[*i].as_ref().err().map(|failed| &failed.error))
    };
    table.texts("status", rows.iter().map(status).collect());
    table
}

/// What governs, a row a model and bound.
fn table_of_governing(models: &[ModelHistories], shape: DemandShape) -> Table {
    let rows: Vec<(&ModelHistories, usize)> =
        models.iter().flat_map(|model| (0..model.bounds.len()).map(move |i| (model, i))).collect();
    let mut table = Table::default();
    table
        .texts("model", rows.iter().map(|(model, _)| model.name.clone()).collect())
        .texts("friction", rows.iter().map(|(m, i)| m.bounds[*i].name.to_owned()).collect())
        .texts("statistic", rows.iter().map(|(model, _)| model.statistic().to_owned()).collect());
    let governs = |column: &DemandColumn| column.demand.row.is_some_and(|row| row.governs);
    for column in shape.columns().iter().filter(|column| governs(column)) {
        let values = rows.iter().map(|(model, i)| model.governing(column, *i)).collect();
        table.numbers(&column.name(), column.unit(), values);
    }
    table
}
