//! The runs of an analysis over a suite: designs on records, each times its factor.
//!
//! One run that has no answer is one run with its error; the others go on. A run keeps its identity: what
//! is said of it names its design, its record and its factor.

use super::FailedRun;
use super::suite::Suite;
use crate::error::{MotionError, RunError, Stopped};
use crate::input::Parts;
use crate::motion::GroundMotion;
use crate::notice::{Notice, NoticeKind};
use crate::response::{Response, flat_geometry};
use crate::solver::{PreparedMotion, Workspace};
use crate::study::engine::{Engine, Running};

/// Runs of one design that one thread takes: the model is prepared once for them.
const PIECE: usize = 16;

/// One run: a design on a record times a factor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Case {
    /// Number of the design among those that are run.
    pub design: usize,
    /// Number of the record.
    pub record: usize,
    /// Factor on it.
    pub scale: f64,
}

/// A run that was made.
#[derive(Clone, Debug)]
pub struct Ran<R> {
    /// Which.
    pub case: Case,
    /// What was kept of its response, or why there is none.
    pub kept: Result<R, RunError>,
    /// Kinds of what was noticed of it.
    pub noticed: Vec<NoticeKind>,
}

/// What the runs of an analysis share: the records, and each of them times the factor that it has in most
/// runs, prepared once.
pub(super) struct Cases<'a> {
    suite: &'a Suite,
    engine: &'a Engine<'a>,
    shared: Vec<(f64, Result<PreparedMotion, MotionError>)>,
    tail_s: f64,
}

impl<'a> Cases<'a> {
    /// Runs whose records have these factors and a tail in most of them; no factors where each has others.
    pub(super) fn new(
        suite: &'a Suite,
        factors: &[f64],
        tail_s: f64,
        engine: &'a Engine<'a>,
    ) -> Result<Self, Stopped> {
        // A made motion may be another with every design.
        let count = if suite.made { 0 } else { factors.len() };
        let motion = |i: usize| suite.motion(i, factors[i], tail_s).map(PreparedMotion::new);
        let shared = engine.map(count, |i| Ok((factors[i], motion(i))))?;
        Ok(Self { suite, engine, shared, tail_s })
    }

    /// The runs of cases, in their order; those of one design stand together. `keep` says what is kept of a
    /// response and of the motion under it. The engine is told of every run.
    pub(super) fn run<R: Send>(
        &self,
        designs: &[Result<Parts, RunError>],
        cases: &[Case],
        keep: impl Fn(&Case, &Response, &GroundMotion) -> R + Sync,
    ) -> Result<Vec<Ran<R>>, Stopped> {
        let of_design = cases.chunk_by(|a, b| a.design == b.design);
        let pieces: Vec<&[Case]> = of_design.flat_map(|cases| cases.chunks(PIECE)).collect();
        self.engine.plan(cases.len() as u64);
        let ran = self.engine.map(pieces.len(), |i| {
            let mut design = OnDesign::new(self, &designs[pieces[i][0].design]);
            let ran: Vec<Ran<R>> = pieces[i].iter().map(|case| design.run(*case, &keep)).collect();
            self.engine.done(ran.len() as u64)?;
            Ok(ran)
        })?;
        Ok(ran.into_iter().flatten().collect())
    }
}

/// A design that runs one case after the other.
pub(super) struct OnDesign<'a> {
    cases: &'a Cases<'a>,
    parts: Result<(&'a Parts, Running<'a>), RunError>,
    room: Workspace,
}

impl<'a> OnDesign<'a> {
    pub(super) fn new(cases: &'a Cases<'a>, design: &'a Result<Parts, RunError>) -> Self {
        let running = |parts: &'a Parts| (parts, Running::new(&parts.model, cases.engine));
        let parts = design.as_ref().map(running).map_err(Clone::clone);
        Self { cases, parts, room: Workspace::default() }
    }

    pub(super) fn run<R>(
        &mut self,
        case: Case,
        keep: impl Fn(&Case, &Response, &GroundMotion) -> R,
    ) -> Ran<R> {
        let mut noticed = Vec::new();
        let kept = self.response(&case, |case, parts, response, motion| {
            let flat = flat_geometry(&parts.model, &response.demands);
            noticed.extend(flat.iter().chain(&response.warnings).map(|warning| warning.kind));
            keep(case, response, motion)
        });
        Ran { case, kept, noticed }
    }

    fn response<R>(
        &mut self,
        case: &Case,
        keep: impl FnOnce(&Case, &Parts, &Response, &GroundMotion) -> R,
    ) -> Result<R, RunError> {
        let (parts, running) = self.parts.as_mut().map_err(|error| error.clone())?;
        let Cases { suite, shared, tail_s, .. } = self.cases;
        let own;
        let motion = match shared.get(case.record) {
            Some((scale, motion)) if *scale == case.scale && *tail_s == parts.tail_s => {
                motion.as_ref().map_err(Clone::clone)?
            }
            _ => {
                own = PreparedMotion::new(suite.motion_of(case.record, case.scale, parts)?);
                &own
            }
        };
        let response = running.on(motion, &mut self.room)?;
        Ok(keep(case, parts, &response, motion.motion()))
    }
}

/// The runs without an answer; `design` names a design that is one of several.
pub(super) fn failures<R>(
    ran: &[Ran<R>],
    suite: &Suite,
    design: impl Fn(usize) -> String,
) -> Vec<FailedRun> {
    let of = |ran: &Ran<R>| {
        let error = ran.kept.as_ref().err()?.clone();
        let Case { design: number, record, scale } = ran.case;
        let record = suite.records[record].name.clone();
        Some(FailedRun { record, scale, design: design(number), error })
    };
    ran.iter().filter_map(of).collect()
}

/// What was noticed of runs, each kind once with the number of its runs and the first of them.
pub(super) fn noticed<R>(
    ran: &[Ran<R>],
    suite: &Suite,
    design: impl Fn(usize) -> String,
) -> Vec<Notice> {
    let mut kinds: Vec<(NoticeKind, usize, Case)> = Vec::new();
    for Ran { case, noticed, .. } in ran {
        for &kind in noticed {
            match kinds.iter_mut().find(|(seen, ..)| *seen == kind) {
                Some((_, count, _)) => *count += 1,
                None => kinds.push((kind, 1, *case)),
            }
        }
    }
    let told = |(kind, count, case): (NoticeKind, usize, Case)| {
        let what = super::times(&suite.records[case.record].name, case.scale);
        let design = design(case.design);
        let message = format!("{count} of {} runs, the first of them {what}{design}", ran.len());
        Notice::new(kind, message)
    };
    kinds.into_iter().map(told).collect()
}
