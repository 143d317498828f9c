//! A sign of life where a person waits for more than a second.

use std::io::{self, IsTerminal, Write};
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc;
use std::thread;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};
use slipstick::study::engine::Engine;

/// How long a person waits before the sign appears.
const PATIENCE: Duration = Duration::from_secs(1);

/// Whether a sign may appear: a person watches, and has not asked for plain output.
fn wanted() -> bool {
    io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none_or(|v| v.is_empty())
}

/// Takes a sign that may stand on the terminal's line off it.
pub fn clear() {
    if wanted() {
        let _ = write!(io::stderr(), "\r\u{1b}[2K");
    }
}

/// A bar with rate and time left for so many steps, where a person watches.
pub struct Steps(Option<ProgressBar>);

impl Steps {
    /// A bar that stands at 0 of `total`.
    pub fn new(total: u64, quiet: bool) -> Self {
        if quiet || !wanted() {
            return Self(None);
        }
        let template = "{wide_bar} {human_pos}/{human_len} runs, {per_sec}, {eta} left";
        let style = ProgressStyle::with_template(template);
        let style = style.unwrap_or_else(|_| ProgressStyle::default_bar());
        let bar = ProgressBar::new(total).with_style(style);
        bar.enable_steady_tick(Duration::from_millis(200));
        Self(Some(bar))
    }

    /// So many steps more.
    pub fn advance(&self, steps: u64) {
        if let Some(bar) = &self.0 {
            bar.inc(steps);
        }
    }

    /// Takes the bar off the screen.
    pub fn finish(self) {
        if let Some(bar) = self.0 {
            bar.finish_and_clear();
        }
    }
}

/// Runs `work` and, where a person watches and it takes long, shows what is going on.
pub fn watched<T: Send>(what: &'static str, quiet: bool, work: impl FnOnce() -> T + Send) -> T {
    with_sign(what, "{spinner} {msg}, {elapsed}", quiet, &|| 0, work)
}

/// The same for work by an engine, with the number of runs that are done.
pub fn counted<T: Send>(
    what: &'static str,
    quiet: bool,
    work: impl FnOnce(&Engine<'_>) -> T + Send,
) -> T {
    let done = AtomicU64::new(0);
    let follow = |runs: u64| {
        done.fetch_add(runs, Ordering::Relaxed);
        ControlFlow::Continue(())
    };
    let position = || done.load(Ordering::Relaxed);
    let template = "{spinner} {msg}, {human_pos} runs, {elapsed}";
    with_sign(what, template, quiet, &position, || work(&Engine::new(&follow)))
}

fn with_sign<T: Send>(
    what: &'static str,
    template: &str,
    quiet: bool,
    position: &(dyn Fn() -> u64 + Sync),
    work: impl FnOnce() -> T + Send,
) -> T {
    if quiet || !wanted() {
        return work();
    }
    thread::scope(|scope| {
        let (done, wait) = mpsc::channel::<()>();
        scope.spawn(move || {
            const TICK: Duration = Duration::from_millis(100);
            let waiting = |time| wait.recv_timeout(time) == Err(mpsc::RecvTimeoutError::Timeout);
            if waiting(PATIENCE) {
                let style = ProgressStyle::with_template(template);
                let style = style.unwrap_or_else(|_| ProgressStyle::default_spinner());
                let bar = ProgressBar::new_spinner().with_style(style).with_message(what);
                bar.set_elapsed(PATIENCE);
                bar.enable_steady_tick(TICK);
                while waiting(TICK) {
                    bar.set_position(position());
                }
                bar.finish_and_clear();
            }
        });
        let result = work();
        drop(done);
        result
    })
}
