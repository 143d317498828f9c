//! Many runs in a fixed order: on the threads of the caller's pool, followed and stopped by one
//! callback.
//!
//! Everything that takes more than one run goes through an [`Engine`]: studies, spectra, incremental
//! dynamic analyses, designs, identification. Work is shared by the threads of the pool that the
//! caller runs it in (rayon's `ThreadPool::install`); outside of a pool, and without the feature
//! `parallel`, it is done on the caller's own thread. The results are the same.

use core::cell::Cell;
use core::ops::ControlFlow;
use core::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::Arc;

use crate::error::{SolveError, Stopped};
use crate::model::Model;
use crate::progress::Cancel;
use crate::response::Response;
use crate::solver::{Prepared, PreparedMotion, Workspace};

/// Told how many more runs are done, from any thread; answers whether to go on.
pub type Follow<'a> = &'a (dyn Fn(u64) -> ControlFlow<()> + Sync);

/// Does work in many pieces, and stops where its follower says so.
pub struct Engine<'a> {
    follow: Follow<'a>,
    stopped: AtomicBool,
    planned: Arc<AtomicU64>,
}

impl Engine<'static> {
    /// An engine that nobody follows and nothing stops.
    #[must_use]
    pub fn unwatched() -> Self {
        Self::new(&|_| ControlFlow::Continue(()))
    }
}

impl<'a> Engine<'a> {
    /// An engine that tells of its runs as they are done.
    #[must_use]
    pub fn new(follow: Follow<'a>) -> Self {
        Self::planning(follow, Arc::default())
    }

    /// The same, whose follower may look how many runs are planned.
    #[must_use]
    pub fn planning(follow: Follow<'a>, planned: Arc<AtomicU64>) -> Self {
        Self { follow, stopped: AtomicBool::new(false), planned }
    }

    /// Tells that so many more runs are to be done.
    pub fn plan(&self, runs: u64) {
        self.planned.fetch_add(runs, Ordering::Relaxed);
    }

    /// The same where so many were thought to be, and are not.
    pub fn replan(&self, thought: u64, runs: u64) {
        self.planned.fetch_add(runs.wrapping_sub(thought), Ordering::Relaxed);
    }

    /// Number of runs that are known to be done or to be to do.
    #[must_use]
    pub fn planned(&self) -> u64 {
        self.planned.load(Ordering::Relaxed)
    }

    /// Tells that so many more runs are done.
    ///
    /// # Errors
    /// [`Stopped`] where the work is to end.
    pub fn done(&self, runs: u64) -> Result<(), Stopped> {
        self.check()?;
        if (self.follow)(runs).is_break() {
            self.stopped.store(true, Ordering::Relaxed);
        }
        self.check()
    }

    /// Whether the work goes on.
    ///
    /// # Errors
    /// [`Stopped`] where it is to end.
    pub fn check(&self) -> Result<(), Stopped> {
        if self.stopped.load(Ordering::Relaxed) { Err(Stopped) } else { Ok(()) }
    }

    /// `work` of every number below `count`, in order.
    ///
    /// # Errors
    /// [`Stopped`], after the pieces in work.
    pub fn map<R: Send>(
        &self,
        count: usize,
        work: impl Fn(usize) -> Result<R, Stopped> + Sync + Send,
    ) -> Result<Vec<R>, Stopped> {
        let checked = |i: usize| {
            self.check()?;
            work(i)
        };
        #[cfg(feature = "parallel")]
        if count > 1 && rayon::current_thread_index().is_some() {
            use rayon::prelude::*;
            return (0..count).into_par_iter().map(checked).collect();
        }
        (0..count).map(checked).collect()
    }

    /// The same for pieces that are one run each.
    ///
    /// # Errors
    /// [`Stopped`], after the runs in work.
    pub fn runs<R: Send>(
        &self,
        count: usize,
        run: impl Fn(usize) -> R + Sync + Send,
    ) -> Result<Vec<R>, Stopped> {
        self.plan(count as u64);
        self.map(count, |i| {
            let result = run(i);
            self.done(1)?;
            Ok(result)
        })
    }

    /// One run that asks now and then whether to go on, and ends where the engine is stopped.
    pub fn watch<R>(&self, run: impl FnOnce(Cancel<'_>) -> R) -> R {
        // The first question comes at once: short runs do not bother the follower.
        let long = Cell::new(false);
        run(&|| {
            let asked = if long.replace(true) { self.done(0) } else { self.check() };
            asked.map_or_else(|Stopped| ControlFlow::Break(()), ControlFlow::Continue)
        })
    }

    /// What two works give, the first on this thread while the second goes on beside it, where there
    /// is a thread for it.
    pub fn both<A: Send, B: Send>(
        &self,
        first: impl FnOnce() -> A + Send,
        second: impl FnOnce() -> B + Send,
    ) -> (A, B) {
        #[cfg(feature = "parallel")]
        if rayon::current_thread_index().is_some() {
            return rayon::join(first, second);
        }
        (first(), second())
    }
}

/// A model with what its last run needed of it, for the next one.
pub(crate) struct Running<'a> {
    model: &'a Model,
    engine: &'a Engine<'a>,
    prepared: Option<Prepared>,
}

impl<'a> Running<'a> {
    pub(crate) fn new(model: &'a Model, engine: &'a Engine<'_>) -> Self {
        Self { model, engine, prepared: None }
    }

    /// The response without its history: the one place where many runs meet the solver. A run that takes
    /// long is stopped where the engine is.
    pub(crate) fn on(
        &mut self,
        motion: &PreparedMotion,
        workspace: &mut Workspace,
    ) -> Result<Response, SolveError> {
        let dt_s = motion.dt_s();
        let prepared = match self.prepared.take().filter(|prepared| prepared.dt_s() == dt_s) {
            Some(prepared) => prepared,
            None => workspace.prepare(self.model, dt_s),
        };
        self.engine
            .watch(|go_on| self.prepared.insert(prepared).demands_while(workspace, motion, go_on))
    }
}

#[cfg(test)]
mod tests {
    use core::sync::atomic::AtomicU64;

    use super::*;

    #[test]
    fn results_come_in_order_and_every_run_is_told() {
        let told = AtomicU64::new(0);
        let follow = |runs: u64| {
            told.fetch_add(runs, Ordering::Relaxed);
            ControlFlow::Continue(())
        };
        let engine = Engine::new(&follow);
        let squares = engine.runs(1500, |i| i * i);
        assert_eq!(engine.planned(), 1500);
        engine.plan(30);
        engine.replan(30, 7);
        assert_eq!(engine.planned(), 1507);
        assert_eq!(squares, Ok((0..1500).map(|i| i * i).collect()));
        assert_eq!(told.into_inner(), 1500);
    }

    #[test]
    fn the_follower_stops_it_for_good() {
        let told = AtomicU64::new(0);
        let follow = |runs: u64| match told.fetch_add(runs, Ordering::Relaxed) + runs {
            7.. => ControlFlow::Break(()),
            _ => ControlFlow::Continue(()),
        };
        let engine = Engine::new(&follow);
        assert_eq!(engine.runs(2000, |i| i), Err(Stopped));
        assert_eq!(told.load(Ordering::Relaxed), 7);
        // What comes after does nothing.
        assert_eq!(engine.runs(10, |i| i), Err(Stopped));
        assert_eq!(told.into_inner(), 7);
    }

    /// The threads are those of the pool that the caller is in; outside of one there is no other.
    #[cfg(feature = "parallel")]
    #[test]
    fn threads_are_the_callers() {
        let threads = || {
            let all = Engine::unwatched().runs(64, |_| std::thread::current().id()).unwrap();
            all.into_iter().collect::<std::collections::HashSet<_>>()
        };
        assert_eq!(threads().into_iter().collect::<Vec<_>>(), [std::thread::current().id()]);
        let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build().unwrap();
        let (own, used) = pool.install(|| {
            let own = rayon::broadcast(|_| std::thread::current().id());
            (own, threads())
        });
        assert!(used.iter().all(|id| own.contains(id)));
    }
}
