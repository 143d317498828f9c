//! The same work for many items, on all threads or so many, results in order.

/// `work` of every number below `count`, in order.
#[cfg(feature = "parallel")]
pub(super) fn map<R: Send>(count: usize, work: impl Fn(usize) -> R + Sync + Send) -> Vec<R> {
    use rayon::prelude::*;
    (0..count).into_par_iter().map(work).collect()
}

/// `work` of every number below `count`, in order.
#[cfg(not(feature = "parallel"))]
pub(super) fn map<R: Send>(count: usize, work: impl Fn(usize) -> R + Sync + Send) -> Vec<R> {
    (0..count).map(work).collect()
}

/// Does work that uses so many threads; as many as the machine has where `None`.
#[cfg(feature = "parallel")]
pub fn on_threads<T: Send>(jobs: Option<usize>, work: impl FnOnce() -> T + Send) -> T {
    match rayon::ThreadPoolBuilder::new().num_threads(jobs.unwrap_or(0)).build() {
        Ok(pool) => pool.install(work),
        // Fewer threads than asked for give the same results.
        Err(_) => work(),
    }
}

/// Does work on the one thread there is.
#[cfg(not(feature = "parallel"))]
pub fn on_threads<T: Send>(_jobs: Option<usize>, work: impl FnOnce() -> T + Send) -> T {
    work()
}
