//! A sign of life where a person waits for more than a second.

use std::io::{self, IsTerminal};
use std::sync::mpsc;
use std::thread;
use std::time::Duration;

use indicatif::ProgressBar;

/// How long a person waits before the sign appears.
const PATIENCE: Duration = Duration::from_secs(1);

/// Runs `work` and, where standard error is a terminal and it takes long, shows what is going on.
pub fn watched<T: Send>(what: &'static str, quiet: bool, work: impl FnOnce() -> T + Send) -> T {
    if quiet || !io::stderr().is_terminal() {
        return work();
    }
    thread::scope(|scope| {
        let (done, wait) = mpsc::channel::<()>();
        scope.spawn(move || {
            if wait.recv_timeout(PATIENCE) == Err(mpsc::RecvTimeoutError::Timeout) {
                let bar = ProgressBar::new_spinner().with_message(what);
                bar.enable_steady_tick(Duration::from_millis(100));
                let _ = wait.recv();
                bar.finish_and_clear();
            }
        });
        let result = work();
        drop(done);
        result
    })
}
