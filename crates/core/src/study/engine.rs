//! Many runs in a fixed order: on the threads of the caller's pool, followed and stopped by one
//! callback.
//!
//! Everything that takes more than one run goes through an [`Engine`]: studies, spectra, incremental
//! dynamic analyses, designs, identification. Work is shared by the threads of the pool that the
//! caller runs it in (rayon's `ThreadPool::install`): each takes the next piece when it is free. Outside of a
//! pool, and without the feature `parallel`, it is done on the caller's own thread. The results are the same.

use core::cell::Cell;
use core::ops::ControlFlow;
use core::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::Arc;

use super::kept::KeptRuns;
use crate::error::{SolveError, Stopped};
use crate::model::Model;
use crate::numerics::sort;
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
    kept: Option<&'a dyn KeptRuns>,
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
        Self { follow, stopped: AtomicBool::new(false), planned, kept: None }
    }

    /// An engine of the same follower, whose costly runs are kept, and not made again where they are.
    #[must_use]
    pub fn keeping(&self, kept: &'a dyn KeptRuns) -> Self {
        Self { kept: Some(kept), ..Self::planning(self.follow, self.planned.clone()) }
    }

    /// Where costly runs are kept.
    pub(crate) fn kept(&self) -> Option<&'a dyn KeptRuns> {
        self.kept
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
        work: impl Fn(usize) -> Result<R, Stopped> + Sync,
    ) -> Result<Vec<R>, Stopped> {
        self.begun_in_order(count, usize::MAX, |i| {
            self.check()?;
            work(i)
        })
    }

    /// `work` of every number below `count`, in order; the costliest is begun first, that no thread is left with it
    /// when the others have ended.
    ///
    /// # Errors
    /// As [`Engine::map`].
    pub fn map_costliest_first<R: Send>(
        &self,
        count: usize,
        cost: impl Fn(usize) -> usize,
        work: impl Fn(usize) -> Result<R, Stopped> + Sync,
    ) -> Result<Vec<R>, Stopped> {
        let mut order: Vec<(usize, usize)> = (0..count).map(|i| (cost(i), i)).collect();
        sort(&mut order, |a, b| b.0.cmp(&a.0));
        let results = self.map(count, |place| work(order[place].1))?;
        let mut results: Vec<(usize, R)> = order.into_iter().map(|(_, i)| i).zip(results).collect();
        sort(&mut results, |a, b| a.0.cmp(&b.0));
        Ok(results.into_iter().map(|(_, result)| result).collect())
    }

    /// `work` of every number below `count`, in order; each is begun after those before it, and at most `at_once` are
    /// begun and not ended.
    ///
    /// # Errors
    /// The first in order, after the pieces in work.
    pub fn begun_in_order<R: Send, E: Send>(
        &self,
        count: usize,
        at_once: usize,
        work: impl Fn(usize) -> Result<R, E> + Sync,
    ) -> Result<Vec<R>, E> {
        #[cfg(feature = "parallel")]
        if count > 1 && rayon::current_thread_index().is_some() {
            let at_once = at_once.min(rayon::current_num_threads()).min(count);
            return parallel::Pieces::new(count, &work).run(at_once);
        }
        let _ = at_once;
        (0..count).map(work).collect()
    }

    /// The same for pieces that are one run each.
    ///
    /// # Errors
    /// [`Stopped`], after the runs in work.
    pub fn runs<R: Send>(
        &self,
        count: usize,
        run: impl Fn(usize) -> R + Sync,
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

#[cfg(feature = "parallel")]
mod parallel {
    use core::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
    use std::sync::{Mutex, PoisonError};

    use rayon::ScopeFifo;

    use crate::numerics::sort;

    /// Pieces of work, each of which the next free thread of a pool begins.
    pub(super) struct Pieces<'w, R, E> {
        count: usize,
        work: &'w (dyn Fn(usize) -> Result<R, E> + Sync),
        next: AtomicUsize,
        failed: AtomicBool,
        ended: Mutex<Vec<(usize, Result<R, E>)>>,
    }

    impl<'w, R: Send, E: Send> Pieces<'w, R, E> {
        pub(super) fn new(count: usize, work: &'w (dyn Fn(usize) -> Result<R, E> + Sync)) -> Self {
            let ended = Mutex::new(Vec::with_capacity(count));
            Self { count, work, next: AtomicUsize::new(0), failed: AtomicBool::new(false), ended }
        }

        /// Their results in order, or the first error.
        pub(super) fn run(self, at_once: usize) -> Result<Vec<R>, E> {
            rayon::scope_fifo(|scope| {
                (0..at_once).for_each(|_| scope.spawn_fifo(|scope| self.step(scope)));
            });
            let mut ended = self.ended.into_inner().unwrap_or_else(PoisonError::into_inner);
            sort(&mut ended, |a, b| a.0.cmp(&b.0));
            ended.into_iter().map(|(_, result)| result).collect()
        }

        /// The next piece. The one after it is a task of its own: a thread that waits for something within a piece
        /// takes no more than one other.
        fn step<'s>(&'s self, scope: &ScopeFifo<'s>) {
            if self.failed.load(Ordering::Relaxed) {
                return;
            }
            let i = self.next.fetch_add(1, Ordering::Relaxed);
            if i >= self.count {
                return;
            }
            let result = (self.work)(i);
            self.failed.fetch_or(result.is_err(), Ordering::Relaxed);
            self.ended.lock().unwrap_or_else(PoisonError::into_inner).push((i, result));
            scope.spawn_fifo(|scope| self.step(scope));
        }
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

    /// On threads or without, results come in their order, and so does the first error.
    #[test]
    fn costly_pieces_begin_first_and_few_are_open() {
        use core::sync::atomic::AtomicUsize;
        use std::sync::Mutex;

        let check = || {
            let engine = Engine::unwatched();
            let begun = Mutex::new(Vec::new());
            let note = |i: usize| {
                begun.lock().unwrap().push(i);
                Ok(i)
            };
            let results = engine.map_costliest_first(40, |i| i * 7 % 40, note);
            assert_eq!(results, Ok((0..40).collect()));
            let begun = begun.into_inner().unwrap();
            let place = |i: usize| begun.iter().position(|of| *of == i).unwrap();
            // 17 costs 39 and 23 costs 1: each thread may be late with one piece.
            assert!(place(17) < 4 && place(23) > 35, "{begun:?}");
            let (open, most) = (AtomicUsize::new(0), AtomicUsize::new(0));
            let count = |i: usize| {
                most.fetch_max(1 + open.fetch_add(1, Ordering::Relaxed), Ordering::Relaxed);
                let inner = engine.map(8, |j| Ok(i * j)).unwrap();
                open.fetch_sub(1, Ordering::Relaxed);
                if i % 5 == 3 { Err(i) } else { Ok(inner) }
            };
            assert_eq!(engine.begun_in_order(20, 2, count), Err(3));
            assert!(most.into_inner() <= 2);
        };
        check();
        #[cfg(feature = "parallel")]
        rayon::ThreadPoolBuilder::new().num_threads(4).build().unwrap().install(check);
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
