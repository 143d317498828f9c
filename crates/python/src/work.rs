//! Work that Ctrl-C ends.

use std::cell::{Cell, RefCell};
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::{Duration, Instant};

use pyo3::prelude::*;
use slipstick::progress::Cancel;
use slipstick::study::engine::Engine;
use slipstick_files::on_threads;

use crate::errors::of_argument;

/// How often signals, and the callback that follows the work, get their turn.
const TURN: Duration = Duration::from_millis(50);

/// Does work on this thread while Python's others go on; its callback is asked now and then whether to
/// go on. A signal stops the work and is raised.
pub(crate) fn interruptible<T: Send>(
    py: Python<'_>,
    work: impl FnOnce(Cancel<'_>) -> T + Send,
) -> PyResult<T> {
    py.detach(|| {
        let (last, raised) = (Cell::new(Instant::now()), RefCell::new(None));
        let go_on = || {
            if last.get().elapsed() < TURN {
                return ControlFlow::Continue(());
            }
            last.set(Instant::now());
            match Python::attach(|py| py.check_signals()) {
                Ok(()) => ControlFlow::Continue(()),
                Err(error) => {
                    raised.replace(Some(error));
                    ControlFlow::Break(())
                }
            }
        };
        let result = work(&go_on);
        raised.into_inner().map_or(Ok(result), Err)
    })
}

/// Does work on threads of its own, which end with it, while Python's other threads go on. Every now
/// and then `progress` is called with the runs done and planned. A signal, or an exception of
/// `progress`, stops the work and is raised.
pub(crate) fn followed<T: Send>(
    py: Python<'_>,
    jobs: Option<i64>,
    progress: Option<Py<PyAny>>,
    work: impl FnOnce(&Engine<'_>) -> T + Send,
) -> PyResult<T> {
    let jobs = match jobs {
        None | Some(-1) => None,
        Some(jobs) => match usize::try_from(jobs) {
            Ok(jobs) if jobs > 0 => Some(jobs),
            _ => {
                let expected = "a number of threads, or -1 for all";
                return Err(of_argument(py, "jobs", expected, &jobs.to_string()));
            }
        },
    };
    let (stop, done) = (AtomicBool::new(false), AtomicU64::new(0));
    let follow = |runs: u64| {
        done.fetch_add(runs, Ordering::Relaxed);
        if stop.load(Ordering::Relaxed) {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    };
    let engine = Engine::new(&follow);
    let turn = || {
        Python::attach(|py| {
            py.check_signals()?;
            let Some(progress) = &progress else { return Ok(()) };
            let done = done.load(Ordering::Relaxed);
            progress.call1(py, (done, engine.planned().max(done))).map(drop)
        })
    };
    py.detach(|| {
        thread::scope(|scope| {
            let (sender, receiver) = mpsc::channel();
            let engine = &engine;
            scope.spawn(move || {
                let result = on_threads(jobs, || work(engine));
                // Nobody waits any more only where this scope unwinds.
                let _ = sender.send(result);
            });
            let mut raised = None;
            loop {
                match receiver.recv_timeout(TURN) {
                    Ok(result) => return raised.map_or(Ok(result), Err),
                    Err(RecvTimeoutError::Timeout) if raised.is_none() => {
                        if let Err(error) = turn() {
                            stop.store(true, Ordering::Relaxed);
                            raised = Some(error);
                        }
                    }
                    Err(RecvTimeoutError::Timeout) => {}
                    Err(RecvTimeoutError::Disconnected) => {
                        // The work has panicked: the scope passes that on.
                        return Err(raised.unwrap_or_else(|| {
                            pyo3::exceptions::PyRuntimeError::new_err("the work has ended early")
                        }));
                    }
                }
            }
        })
    })
}
