//! The cases of an analysis, and their runs: a design with a bound of friction, on a record at a level.
//!
//! A study, a spectrum, an incremental dynamic analysis and a design differ in the cases that they ask for and in
//! what they keep of a response. A run that has no answer is one run with its error; the others go on. What is
//! said of a run names its case.

use core::borrow::Borrow;
use core::cell::OnceCell;

use super::certified::{Certified, RunKind, Verdict, chosen, is_drawn};
use super::demanded::TRAVEL_USED_UP;
use super::engine::{Engine, Running};
use super::kept::{self, InNumbers};
use super::pieces::runs_in_piece;
use super::records::Record;
use crate::check::{self, Certificate};
use crate::error::{MotionError, RunError, Stopped};
use crate::input::{Bound, MotionSource, Parts};
use crate::model::Model;
use crate::motion::GroundMotion;
use crate::notice::{Notice, NoticeKind, Severity};
use crate::response::{Response, flat_geometry};
use crate::solver::{self, PreparedMotion, Workspace};
use crate::table::{Cells, Column, Table};

/// What a run is of. Numbers count from 0.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Case {
    /// Number of the record.
    pub record: usize,
    /// Number of the level; 0 where levels are sought.
    pub level: usize,
    /// Number of the design: a sample of a study, a place in a grid.
    pub design: usize,
    /// Number of the bound of friction.
    pub bound: usize,
    /// Factor on the record, or on the motion that the model makes.
    pub scale: f64,
}

impl Case {
    /// Some designs with each bound, on every record times its factor, the records fastest.
    pub(crate) fn every(designs: usize, bounds: usize, factors: &[f64]) -> Vec<Self> {
        let each = |number| {
            let (bound, design) = (number / designs, number % designs);
            let on = move |(record, &scale)| Self { record, level: 0, design, bound, scale };
            factors.iter().enumerate().map(on)
        };
        (0..designs * bounds).flat_map(each).collect()
    }
}

/// Numbers of records, levels and samples of a study: its runs go through all of them, the last fastest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cases {
    /// Number of records, ≥ 1; a made motion counts as one.
    pub records: u64,
    /// Number of levels, ≥ 1.
    pub levels: u64,
    /// Number of samples, ≥ 1.
    pub samples: u64,
    /// Number of bounds of friction that each sample is run with, ≥ 1.
    pub bounds: u64,
}

impl Cases {
    /// Number of runs; `None` where it is beyond counting.
    #[must_use]
    pub fn runs(&self) -> Option<u64> {
        let motions = self.records.checked_mul(self.levels)?;
        motions.checked_mul(self.samples)?.checked_mul(self.bounds)
    }

    /// Number of models: samples times bounds. Their runs of one record at one level stand together.
    #[must_use]
    pub fn models(&self) -> u64 {
        self.samples * self.bounds
    }

    /// The case of a run; `factors` are those of each record's levels, record by record.
    pub(super) fn case(&self, run: u64, factors: &[f64]) -> Case {
        let (motion, model) = (run / self.models(), run % self.models());
        Case {
            record: (motion / self.levels) as usize,
            level: (motion % self.levels) as usize,
            design: (model / self.bounds) as usize,
            bound: (model % self.bounds) as usize,
            scale: factors.get(motion as usize).copied().unwrap_or(1.0),
        }
    }

    /// Number of a case's model, below [`Cases::models`].
    pub(super) fn model(&self, case: &Case) -> u64 {
        case.design as u64 * self.bounds + case.bound as u64
    }

    /// The run of a case.
    pub(super) fn run(&self, case: &Case) -> u64 {
        let motion = case.record as u64 * self.levels + case.level as u64;
        motion * self.models() + self.model(case)
    }
}

/// A run that was made.
#[derive(Clone, Debug)]
pub struct CaseRun<R, M = ()> {
    /// What it is of.
    pub case: Case,
    /// What is known of its motion, where there is one.
    pub known: Option<M>,
    /// What was kept of its response, or why there is none.
    pub kept: Result<R, RunError>,
    /// What was noticed of the response.
    pub noticed: Vec<Noticed>,
    /// Whether the check confirms it, where it was asked.
    pub holds: Option<bool>,
}

/// What was noticed of a response, without its message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Noticed {
    /// Its kind.
    pub kind: NoticeKind,
    /// Whether it is severe, however much its kind weighs.
    pub is_severe: bool,
}

impl<R, M> CaseRun<R, M> {
    /// The travel in m that the run has used up; none where it has an answer, or lacks one for another reason.
    #[must_use]
    pub fn travel_used_up_m(&self) -> Option<f64> {
        self.kept.as_ref().err().and_then(RunError::travel_used_up_m)
    }

    /// A run of which nothing else is known.
    pub(crate) fn of(case: Case, kept: Result<R, RunError>) -> Self {
        Self { case, known: None, kept, noticed: Vec::new(), holds: None }
    }
}

impl Noticed {
    /// The kinds of some of them.
    pub(super) fn kinds(all: &[Self]) -> Vec<NoticeKind> {
        all.iter().map(|noticed| noticed.kind).collect()
    }
}

/// What is noticed of a response that nobody judged.
pub(super) fn noticed_of(model: &Model, response: &Response) -> Vec<Noticed> {
    let flat = flat_geometry(model, &response.demands);
    let of = |notice: &Notice| Noticed { kind: notice.kind, is_severe: notice.is_severe };
    flat.iter().chain(&response.warnings).map(of).collect()
}

/// What the motion of a run is made from: one serves all runs that agree on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MotionOrigin<'a> {
    pub(crate) record: usize,
    pub(crate) scale: f64,
    /// What the model makes, where there are no records.
    pub(crate) source: Option<&'a MotionSource>,
    /// Angle by which a pair of recorded components is turned, x towards y, where it is varied.
    pub(crate) turned_rad: Option<f64>,
    pub(crate) tail_s: f64,
}

impl MotionOrigin<'_> {
    /// The motion as it was recorded or made, times its factor.
    pub(crate) fn bare(&self, records: &[Record]) -> Result<GroundMotion, RunError> {
        let made;
        let unscaled = match records.get(self.record) {
            Some(record) => &record.motion,
            None => {
                let source = self.source.map(MotionSource::made).transpose()?;
                made = source.flatten().ok_or(RunError::NoMotion)?;
                &made
            }
        };
        Ok(if self.scale == 1.0 { unscaled.clone() } else { unscaled.scaled(self.scale)? })
    }

    /// The same turned, with a tail of free vibration.
    pub(crate) fn finished(&self, bare: GroundMotion) -> Result<GroundMotion, MotionError> {
        let turned = match self.turned_rad {
            Some(angle_rad) => bare.turned(1.0, angle_rad)?,
            None => bare,
        };
        if self.tail_s == 0.0 { Ok(turned) } else { turned.with_tail(self.tail_s) }
    }
}

/// A motion as it is solved, and what is known of it.
#[derive(Clone, Debug)]
struct Shaking<M> {
    motion: PreparedMotion,
    known: M,
}

/// What is to be known of the motion of a record times a factor, without its tail and before it is turned.
pub(crate) type Know<'a, M> = &'a (dyn Fn(usize, f64, &GroundMotion) -> M + Sync);

/// The runs of an analysis: its records, and those motions that most runs share, each prepared once.
pub(crate) struct Runs<'a, M = ()> {
    /// None where every model makes its own motion.
    records: &'a [Record],
    /// Record by record: its number, the factor on it, and the motion.
    shared: Vec<(usize, f64, Result<Shaking<M>, RunError>)>,
    /// Tail of the motions that are shared.
    tail_s: f64,
    know: Know<'a, M>,
    engine: &'a Engine<'a>,
    /// Hashes of the records that run in two directions, where their runs are kept.
    hashes: Vec<Option<String>>,
}

impl<'a, M: Clone + Send + Sync> Runs<'a, M> {
    /// Runs most of which are on these records times these factors, with this tail.
    pub(crate) fn new(
        records: &'a [Record],
        (motions, tail_s): (&[(usize, f64)], f64),
        know: Know<'a, M>,
        engine: &'a Engine<'a>,
    ) -> Result<Self, Stopped> {
        let hashes = match engine.kept() {
            Some(_) => engine.map(records.len(), |i| Ok(kept::hash_of_record(&records[i])))?,
            None => Vec::new(),
        };
        let mut of = Self { records, shared: Vec::new(), tail_s, know, engine, hashes };
        // A made motion may be another with every design.
        let count = if records.is_empty() { 0 } else { motions.len() };
        of.shared = engine.map(count, |i| {
            let (record, scale) = motions[i];
            let origin = MotionOrigin { record, scale, source: None, turned_rad: None, tail_s };
            Ok((record, scale, of.shaking(&origin)))
        })?;
        Ok(of)
    }

    fn shaking(&self, origin: &MotionOrigin<'_>) -> Result<Shaking<M>, RunError> {
        let bare = origin.bare(self.records)?;
        let known = (self.know)(origin.record, origin.scale, &bare);
        Ok(Shaking { motion: PreparedMotion::new(origin.finished(bare)?), known })
    }

    fn shared(&self, case: &Case) -> Option<&Result<Shaking<M>, RunError>> {
        let from = self.shared.partition_point(|(record, ..)| *record < case.record);
        let of_record = self.shared[from..].iter().take_while(|of| of.0 == case.record);
        of_record.into_iter().find(|of| of.1 == case.scale).map(|of| &of.2)
    }

    /// The runs of cases, in their order; those of one design stand together. `design` gives the model of a
    /// case, `keep` what is kept of a response and of the motion under it. The engine is told of every run.
    pub(crate) fn all<'d, R: Send + InNumbers>(
        &self,
        cases: &[Case],
        design: impl Fn(&Case) -> &'d Result<Parts, RunError> + Sync,
        keep: impl Fn(&Case, &Response, &GroundMotion) -> R + Sync,
    ) -> Result<Vec<CaseRun<R, M>>, Stopped> {
        let alike = |a: &Case, b: &Case| (a.design, a.bound) == (b.design, b.bound);
        let in_piece = |cases: &[Case]| {
            let parts = design(&cases[0]).as_ref().ok();
            let motion = self.records.get(cases[0].record).map(|record| &record.motion);
            parts.zip(motion).map_or(cases.len(), |(of, motion)| runs_in_piece(&of.model, motion))
        };
        let of_design = cases.chunk_by(alike);
        let pieces: Vec<&[Case]> =
            of_design.flat_map(|cases| cases.chunks(in_piece(cases))).collect();
        self.engine.plan(cases.len() as u64);
        self.pieces(&pieces, |case| (design(case), None), keep)
    }

    /// The same of pieces of cases, each on one thread, whose models may come back in turn; beside the model of
    /// a case stands the angle by which its motion is turned.
    pub(crate) fn pieces<'d, R: Send + InNumbers>(
        &self,
        pieces: &[impl AsRef<[Case]> + Sync],
        design: impl Fn(&Case) -> (&'d Result<Parts, RunError>, Option<f64>) + Sync,
        keep: impl Fn(&Case, &Response, &GroundMotion) -> R + Sync,
    ) -> Result<Vec<CaseRun<R, M>>, Stopped> {
        let samples = |case: &Case| self.records.get(case.record).map_or(1, |of| of.motion.len());
        let cost = |i: usize| pieces[i].as_ref().iter().map(samples).sum();
        let ran = self.engine.map_costliest_first(pieces.len(), cost, |i| {
            let mut thread = OneThread::new(self);
            let cases = pieces[i].as_ref().iter();
            let ran: Vec<_> = cases.map(|case| thread.run(*case, design(case), &keep)).collect();
            self.engine.done(ran.len() as u64)?;
            Ok(ran)
        })?;
        Ok(ran.into_iter().flatten().collect())
    }
}

impl<M: Clone + Send + Sync> Runs<'_, M> {
    /// Makes some of the runs again, each alone with its history, and judges them: one of every thousand and the
    /// first of each kind. One that the check does not confirm, or that is not the same to the last bit, loses its
    /// answer. `name` is what a run is called.
    pub(crate) fn certify<'d, R: Send + Sync>(
        &self,
        ran: &mut [CaseRun<R, M>],
        design: impl Fn(&Case) -> &'d Result<Parts, RunError> + Sync,
        same: impl Fn(&R, &Response) -> bool + Sync,
        name: impl Fn(&Case) -> String,
    ) -> Result<Certified, Stopped> {
        let kind = |ran: &CaseRun<R, M>| {
            let parts = design(&ran.case).as_ref().ok().filter(|_| ran.kept.is_ok())?;
            Some(RunKind::of(parts, self.records.get(ran.case.record)))
        };
        let kinds: Vec<Option<RunKind>> = ran.iter().map(kind).collect();
        let runs = ran.len() as u64;
        let mut chosen = chosen(&kinds, |place| is_drawn(place as u64, runs));
        chosen.retain(|&place| ran[place].kept.is_ok());
        let verdicts = self.engine.map(chosen.len(), |i| {
            let CaseRun { case, kept, .. } = &ran[chosen[i]];
            let judged = design(case).as_ref().map_err(Clone::clone);
            let judged = judged.and_then(|parts| self.judged(case, parts));
            // What has no answer the second time came out differently.
            let (Ok((response, certificate)), Ok(kept)) = (judged, kept) else {
                return Ok(Verdict::default());
            };
            Ok(Verdict::of(&certificate, same(kept, &response)))
        })?;
        let mut certified = Certified::of(runs);
        for (place, verdict) in chosen.into_iter().zip(verdicts) {
            let run = &mut ran[place];
            #[cfg(test)]
            let verdict = tests::tampered(&run.case, verdict);
            certified.add(&name(&run.case), &verdict);
            run.holds = Some(verdict.holds());
            if !verdict.holds() {
                run.kept = Err(RunError::Unconfirmed { what: verdict.what_failed() });
            }
        }
        Ok(certified)
    }

    /// The response of a case with its history, and its certificate.
    fn judged(&self, case: &Case, parts: &Parts) -> Result<(Response, Certificate), RunError> {
        let Case { record, scale, .. } = *case;
        let source = parts.motion.as_ref().filter(|_| self.records.is_empty());
        let origin = MotionOrigin { record, scale, source, turned_rad: None, tail_s: parts.tail_s };
        let motion = origin.finished(origin.bare(self.records)?)?;
        let response = solver::exact(&parts.model, &motion)?;
        let certificate = check::check(&parts.model, &motion, &response);
        Ok((response, certificate))
    }
}

/// A model of several runs.
struct OfModel<'a> {
    /// Numbers of its design and its bound.
    place: [usize; 2],
    running: Running<'a>,
    /// Hash of its design, once a run of it is kept.
    hash: OnceCell<String>,
}

/// Runs one after the other: a model is prepared once for all of its runs, a motion for those in a row.
pub(crate) struct OneThread<'a, M = ()> {
    of: &'a Runs<'a, M>,
    models: Vec<OfModel<'a>>,
    own: Option<(MotionOrigin<'a>, Result<Shaking<M>, RunError>)>,
    workspace: Workspace,
}

impl<'a, M: Clone + Send + Sync> OneThread<'a, M> {
    pub(crate) fn new(of: &'a Runs<'a, M>) -> Self {
        Self { of, models: Vec::new(), own: None, workspace: Workspace::default() }
    }

    pub(crate) fn run<R: InNumbers>(
        &mut self,
        case: Case,
        (parts, turned_rad): (&'a Result<Parts, RunError>, Option<f64>),
        keep: impl Fn(&Case, &Response, &GroundMotion) -> R,
    ) -> CaseRun<R, M> {
        let Self { of, models, own, workspace } = self;
        let shared = of.shared(&case);
        let known = |shaking: &Result<Shaking<M>, RunError>| {
            shaking.as_ref().ok().map(|shaking| shaking.known.clone())
        };
        let failed =
            |known, error: &RunError| CaseRun { known, ..CaseRun::of(case, Err(error.clone())) };
        let parts = match parts {
            Ok(parts) => parts,
            Err(error) => return failed(shared.and_then(known), error),
        };
        let shaking = match shared {
            Some(shared) if turned_rad.is_none() && parts.tail_s == of.tail_s => shared,
            _ => {
                let Case { record, scale, .. } = case;
                let source = parts.motion.as_ref().filter(|_| of.records.is_empty());
                let tail_s = parts.tail_s;
                let origin = MotionOrigin { record, scale, source, turned_rad, tail_s };
                if own.as_ref().is_none_or(|(own, _)| *own != origin) {
                    *own = None;
                }
                &own.get_or_insert_with(|| (origin, of.shaking(&origin))).1
            }
        };
        let ready = match shaking {
            Ok(ready) => ready,
            Err(error) => return failed(None, error),
        };
        let place = [case.design, case.bound];
        let at = models.iter().position(|of| of.place == place).unwrap_or_else(|| {
            let running = Running::new(&parts.model, of.engine);
            models.push(OfModel { place, running, hash: OnceCell::new() });
            models.len() - 1
        });
        let OfModel { running, hash, .. } = &mut models[at];
        let known = Some(ready.known.clone());
        let of_record = of.hashes.get(case.record).and_then(Option::as_deref);
        let keeper = of.engine.kept().zip(of_record).filter(|_| turned_rad.is_none());
        let keeper = keeper.map(|(all, of_record)| {
            let of_design = hash.get_or_init(|| kept::hash_of_design(parts));
            (all, kept::key(of_design, of_record, case.scale))
        });
        let before = keeper.as_ref().and_then(|(all, key)| all.find(key));
        if let Some((answer, noticed)) = before.and_then(|line| kept::read(&line)) {
            return CaseRun { known, noticed, ..CaseRun::of(case, Ok(answer)) };
        }
        match running.on(&ready.motion, workspace) {
            Ok(response) => {
                let answer = keep(&case, &response, ready.motion.motion());
                let noticed = noticed_of(&parts.model, &response);
                if let Some((all, key)) = keeper
                    && let Some(line) = kept::line(&answer, &noticed)
                {
                    all.keep(&key, &line);
                }
                CaseRun { known, noticed, ..CaseRun::of(case, Ok(answer)) }
            }
            Err(error) => failed(known, &error.into()),
        }
    }
}

/// A run without an answer.
#[derive(Clone, Debug, PartialEq)]
pub struct FailedRun {
    /// What it is of, in words.
    pub case: String,
    /// Why.
    pub error: RunError,
}

impl core::fmt::Display for FailedRun {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "{}: {}", self.case, self.error)
    }
}

/// What the column of that name says of a run: `ok`, or why it has no answer.
pub(crate) fn status(error: Option<&RunError>) -> String {
    error.map_or_else(|| "ok".to_owned(), RunError::to_string)
}

/// Adds what runs say besides their demands: of sliders with surfaces the travel that was used up, the kinds of what
/// was noticed of their responses, and whether the check confirms a run, empty where it was not asked.
pub(crate) fn add_answers<R, M>(table: &mut Table, ran: &[CaseRun<R, M>], has_surfaces: bool) {
    if has_surfaces {
        let used_up = ran.iter().map(|ran| ran.travel_used_up_m().unwrap_or(f64::NAN));
        table.numbers(TRAVEL_USED_UP, "m", used_up.collect());
    }
    table.texts(NOTICED, ran.iter().map(|ran| in_a_cell(&Noticed::kinds(&ran.noticed))).collect());
    let cells = Cells::Flags(ran.iter().map(|ran| ran.holds).collect());
    table.columns.push(Column { name: HOLDS.to_owned(), unit: String::new(), cells });
}

/// Name of the column that says whether the check confirms a run.
pub(crate) const HOLDS: &str = "holds";

/// Name of the column of the kinds of warnings that a run gave.
pub(crate) const NOTICED: &str = "warnings";

/// The names of kinds of warnings, each once, as a table has them in one cell; notes are not among them.
pub(crate) fn in_a_cell(kinds: &[NoticeKind]) -> String {
    let mut names: Vec<&str> = Vec::new();
    for kind in kinds.iter().filter(|kind| kind.severity() != Severity::Note) {
        if !names.contains(&kind.name()) {
            names.push(kind.name());
        }
    }
    names.join(";")
}

/// The kinds that such a cell names; one that this version does not know is left out.
pub(crate) fn of_a_cell(cell: &str) -> impl Iterator<Item = NoticeKind> + use<'_> {
    cell.split(';').filter_map(NoticeKind::from_name)
}

/// A notice of a kind that several runs gave.
pub(crate) fn of_runs(kind: NoticeKind, gave: u64, runs: usize, first: &str) -> Notice {
    Notice::new(kind, format!("{gave} of {runs} runs, the first of them {first}"))
}

/// What the runs of an analysis are called in messages.
#[derive(Clone, Copy)]
pub(crate) struct InWords<'a> {
    pub(crate) records: &'a [Record],
    /// The bounds of friction; none where one is run.
    pub(crate) bounds: &'a [Bound],
    /// A design, to stand after its record; empty where it is the only one.
    pub(crate) design: &'a dyn Fn(usize) -> String,
}

impl InWords<'_> {
    /// A case: record times factor, design, bound.
    pub(crate) fn case(&self, case: &Case) -> String {
        let Case { record, design, bound, scale, .. } = *case;
        let record = &self.records[record].name;
        // Four digits name a factor.
        let short: f64 = format!("{scale:.3e}").parse().unwrap_or(scale);
        let times = match short.abs() {
            _ if scale == 1.0 => String::new(),
            1e-3..1e6 => format!(" × {short}"),
            _ => format!(" × {short:e}"),
        };
        let bound = self.bounds.get(bound);
        let bound = bound.map_or(String::new(), |bound| format!(", {} friction", bound.name));
        format!("{record}{times}{}{bound}", (self.design)(design))
    }

    /// A run without an answer.
    pub(crate) fn failed(&self, case: &Case, error: &RunError) -> FailedRun {
        FailedRun { case: self.case(case), error: error.clone() }
    }

    /// The runs without an answer, but for those that had one which the check does not confirm.
    pub(crate) fn failures<'r, R: 'r, M: 'r>(
        &self,
        ran: impl IntoIterator<Item = &'r CaseRun<R, M>>,
    ) -> Vec<FailedRun> {
        let of = |ran: &CaseRun<R, M>| {
            let error = ran.kept.as_ref().err().filter(|error| !error.is_unconfirmed())?;
            Some(self.failed(&ran.case, error))
        };
        ran.into_iter().filter_map(of).collect()
    }

    /// What was noticed of runs, each kind once with the number of its runs and the first of them.
    pub(crate) fn noticed<R, M>(&self, ran: &[CaseRun<R, M>]) -> Vec<Notice> {
        let mut kinds = Vec::new();
        for CaseRun { case, noticed, .. } in ran {
            noticed.iter().for_each(|noticed| tally(&mut kinds, &noticed.kind, case));
        }
        let told = |(kind, count, case): (NoticeKind, u64, &Case)| {
            let mut all = ran.iter().flat_map(|ran| &ran.noticed);
            let is_severe = all.any(|noticed| noticed.kind == kind && noticed.is_severe);
            of_runs(kind, count, ran.len(), &self.case(case)).severe_where(is_severe)
        };
        kinds.into_iter().map(told).collect()
    }
}

/// Counts what was seen, each kind with the number of times and where it was first.
pub(crate) fn tally<K, Q, F>(seen: &mut Vec<(K, u64, F)>, kind: &Q, at: F)
where
    K: Borrow<Q>,
    Q: ToOwned<Owned = K> + PartialEq + ?Sized,
{
    match seen.iter_mut().find(|(known, ..)| (*known).borrow() == kind) {
        Some((_, count, _)) => *count += 1,
        None => seen.push((kind.to_owned(), 1, at)),
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use core::cell::Cell;

    use super::*;

    type Which = fn(&Case) -> bool;

    thread_local! {
        /// The certificates of which runs are broken, on this thread.
        static TAMPERED: Cell<Option<Which>> = const { Cell::new(None) };
    }

    /// What `work` gives where the certificates of some runs are broken.
    pub(crate) fn with_broken<R>(which: Which, work: impl FnOnce() -> R) -> R {
        TAMPERED.set(Some(which));
        let given = work();
        TAMPERED.set(None);
        given
    }

    pub(super) fn tampered(case: &Case, verdict: Verdict) -> Verdict {
        if !TAMPERED.get().is_some_and(|which| which(case)) {
            return verdict;
        }
        let what = "demands error of peak sliding displacement".to_owned();
        let defects = format!("{what} 5.0e-1 above the bound 1.0e-10");
        Verdict { holds: false, largest: Some((what, 0.5)), defects, ..verdict }
    }

    #[test]
    fn runs_count_bounds_and_samples_fastest() {
        let cases = Cases { records: 3, levels: 2, samples: 5, bounds: 2 };
        let factors = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
        assert_eq!((cases.runs(), cases.models()), (Some(60), 10));
        for (run, [record, level, design, bound]) in [
            (0, [0, 0, 0, 0]),
            (1, [0, 0, 0, 1]),
            (9, [0, 0, 4, 1]),
            (10, [0, 1, 0, 0]),
            (20, [1, 0, 0, 0]),
            (59, [2, 1, 4, 1]),
        ] {
            let scale = factors[2 * record + level];
            let case = Case { record, level, design, bound, scale };
            assert_eq!(cases.case(run, &factors), case);
        }
        for run in 0..60 {
            assert_eq!(cases.run(&cases.case(run, &factors)), run);
        }
        let many = Cases { records: 1 << 30, levels: 1 << 30, samples: 1 << 30, bounds: 1 };
        assert_eq!(many.runs(), None);
    }
}
