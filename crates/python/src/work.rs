//! Work that Ctrl-C ends.

use std::cell::{Cell, RefCell};
use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::{Duration, Instant};

use pyo3::exceptions::PyRuntimeError;
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

/// Samples of a motion from which work on it is worth a thread that can be left behind.
const LONG: usize = 100_000;

/// Does work on the samples of a motion while Python's other threads go on. Of a long one it has a thread of its own,
/// which is left behind where a signal comes: then nobody reads what it finds, and it may ask whether to go on.
pub(crate) fn on_samples<T: Send + 'static>(
    py: Python<'_>,
    samples: usize,
    work: impl FnOnce(Cancel<'_>) -> T + Send + 'static,
) -> PyResult<T> {
    if samples < LONG {
        return Ok(py.detach(|| work(&|| ControlFlow::Continue(()))));
    }
    let stop = Arc::new(AtomicBool::new(false));
    let stopped = Arc::clone(&stop);
    let (sender, receiver) = mpsc::channel();
    thread::spawn(move || {
        let go_on = || match stopped.load(Ordering::Relaxed) {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        };
        // Nobody waits any more where a signal came.
        let _ = sender.send(work(&go_on));
    });
    py.detach(move || {
        loop {
            match receiver.recv_timeout(TURN) {
                Ok(found) => return Ok(found),
                Err(RecvTimeoutError::Timeout) => {
                    if let Err(error) = Python::attach(|py| py.check_signals()) {
                        stop.store(true, Ordering::Relaxed);
                        return Err(error);
                    }
                }
                Err(RecvTimeoutError::Disconnected) => return Err(ended_early()),
            }
        }
    })
}

/// Work that has panicked.
fn ended_early() -> PyErr {
    PyRuntimeError::new_err("the work has ended early")
}

/// Does work on threads of its own, which end with it, while Python's other threads go on. Every now
/// and then, and when the work is done, `progress` is called with the runs done and planned. A signal, or an
/// exception of `progress`, stops the work and is raised.
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
                    Ok(result) => return raised.map_or_else(|| turn().map(|()| result), Err),
                    Err(RecvTimeoutError::Timeout) if raised.is_none() => {
                        if let Err(error) = turn() {
                            stop.store(true, Ordering::Relaxed);
                            raised = Some(error);
                        }
                    }
                    Err(RecvTimeoutError::Timeout) => {}
                    Err(RecvTimeoutError::Disconnected) => {
                        // The work has panicked: the scope passes that on.
                        return Err(raised.unwrap_or_else(ended_early));
                    }
                }
            }
        })
    })
}
