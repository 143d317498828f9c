//! Pools of threads.

/// Does work in a pool of so many threads, as many as the machine has where `None`: everything that
/// the work shares out is done by those.
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
