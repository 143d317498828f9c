//! A sign of life where a person waits for more than a second.

use std::io::{self, IsTerminal, Write};
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError, mpsc};
use std::thread;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use slipstick::study::engine::Engine;
use slipstick_files::reading_time;

/// How long a person waits before the sign appears.
const PATIENCE: Duration = Duration::from_secs(1);

/// How long the first of some work may be tried to tell how long all of it takes.
pub const TRIAL: Duration = Duration::from_millis(400);

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

/// What to say where Ctrl-C ends the work in hand.
static ON_INTERRUPT: Mutex<Option<Box<dyn Fn() -> String + Send>>> = Mutex::new(None);

/// Says what is done and how to go on, should Ctrl-C end what follows.
pub fn on_interrupt(tell: impl Fn() -> String + Send + 'static) {
    *ON_INTERRUPT.lock().unwrap_or_else(PoisonError::into_inner) = Some(Box::new(tell));
}

/// What was left to be said.
pub fn interrupted() -> Option<String> {
    let tell = ON_INTERRUPT.lock().unwrap_or_else(PoisonError::into_inner);
    tell.as_ref().map(|tell| tell())
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

/// What is shown while no end is known.
const SPINNER: &str = "{spinner} {msg}, {elapsed}";

/// Runs `work` and, where a person watches and it takes long, shows what is going on.
pub fn watched<T: Send>(what: &'static str, quiet: bool, work: impl FnOnce() -> T + Send) -> T {
    with_sign(what, quiet, &|bar| bar.tick(), SPINNER, &|| None, work)
}

/// The same for work by an engine: a bar with what is done of what is planned, and the time left.
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
    let engine = Engine::new(&follow);
    let show = |bar: &ProgressBar| {
        bar.set_length(engine.planned().max(1));
        bar.set_position(done.load(Ordering::Relaxed));
    };
    let template = "{msg} {wide_bar} {human_pos}/{human_len}, {eta} left";
    with_sign(what, quiet, &show, template, &|| None, || work(&engine))
}

/// The same for work whose time is estimated once it takes long: a bar with the time left.
pub fn estimated<T: Send>(
    what: &'static str,
    quiet: bool,
    estimate: &(dyn Fn() -> Option<Duration> + Sync),
    work: impl FnOnce() -> T + Send,
) -> T {
    with_sign(what, quiet, &|bar| bar.tick(), SPINNER, estimate, work)
}

/// The same for reading a file, of whose beginning `piece` is read to tell how long all of it takes.
pub fn reading<T: Send>(
    path: Option<&Path>,
    quiet: bool,
    piece: &(dyn Fn(&[u8]) + Sync),
    work: impl FnOnce() -> T + Send,
) -> T {
    let estimate = || reading_time(path?, TRIAL, piece);
    estimated("reading", quiet, &estimate, work)
}

/// The same for writing so many lines: the bar follows those written, which the work tells.
pub fn writing<T: Send>(
    lines: u64,
    quiet: bool,
    work: impl FnOnce(&(dyn Fn(u64) + Sync)) -> T + Send,
) -> T {
    let done = AtomicU64::new(0);
    let written = |more: u64| {
        done.fetch_add(more, Ordering::Relaxed);
    };
    let show = |bar: &ProgressBar| {
        bar.set_length(lines.max(1));
        bar.set_position(done.load(Ordering::Relaxed));
    };
    with_sign("writing", quiet, &show, "{msg} {wide_bar} {eta} left", &|| None, || work(&written))
}

/// Tells of the lines that go through it.
pub struct Lines<'a, W: Write> {
    /// Where they go.
    pub to: W,
    /// Who is told.
    pub written: &'a dyn Fn(u64),
}

impl<W: Write> Write for Lines<'_, W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let count = self.to.write(bytes)?;
        (self.written)(bytes[..count].iter().filter(|byte| **byte == b'\n').count() as u64);
        Ok(count)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.to.flush()
    }
}

fn with_sign<T: Send>(
    what: &'static str,
    quiet: bool,
    show: &(dyn Fn(&ProgressBar) + Sync),
    template: &str,
    estimate: &(dyn Fn() -> Option<Duration> + Sync),
    work: impl FnOnce() -> T + Send,
) -> T {
    if quiet || !wanted() {
        return work();
    }
    thread::scope(|scope| {
        let (done, wait) = mpsc::channel::<()>();
        scope.spawn(move || {
            const TICK: Duration = Duration::from_millis(100);
            let begun = Instant::now();
            let waiting = |time| wait.recv_timeout(time) == Err(mpsc::RecvTimeoutError::Timeout);
            if !waiting(PATIENCE) {
                return;
            }
            let whole = estimate();
            let template =
                if whole.is_some() { "{msg} {wide_bar} about {prefix} left" } else { template };
            let style = ProgressStyle::with_template(template);
            let style = style.unwrap_or_else(|_| ProgressStyle::default_spinner());
            let bar = ProgressBar::new(1000).with_style(style).with_message(what);
            bar.set_elapsed(begun.elapsed());
            bar.enable_steady_tick(TICK);
            while waiting(TICK) {
                match whole {
                    Some(whole) => {
                        let left = whole.saturating_sub(begun.elapsed()).max(TICK);
                        let share = begun.elapsed().as_secs_f64() / whole.as_secs_f64();
                        bar.set_position((1000.0 * share.min(0.999)) as u64);
                        bar.set_prefix(format!("{:.0} s", left.as_secs_f64().ceil()));
                    }
                    None => show(&bar),
                }
            }
            bar.finish_and_clear();
        });
        let result = work();
        drop(done);
        result
    })
}
