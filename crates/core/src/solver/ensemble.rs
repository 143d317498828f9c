//! Many analyses in a fixed order, on one thread or on all.

/// Analyses in work at a time: what an ensemble holds in memory, whatever its size.
const CHUNK: usize = 512;

/// Evaluates `run` for `0..count` and hands the results to `take` in that order.
///
/// With the feature `parallel` the threads of rayon's pool share the work; what is handed over and
/// in which order does not depend on their number. No more than a fixed number of results is held
/// at a time. `take` may end the ensemble early by an error.
///
/// # Errors
/// The first error of `take`.
pub fn ensemble<T: Send, E>(
    count: usize,
    run: impl Fn(usize) -> T + Sync + Send,
    mut take: impl FnMut(usize, T) -> Result<(), E>,
) -> Result<(), E> {
    let mut start = 0;
    while start < count {
        let end = count.min(start + CHUNK);
        for (index, result) in (start..end).zip(chunk(start..end, &run)) {
            take(index, result)?;
        }
        start = end;
    }
    Ok(())
}

#[cfg(feature = "parallel")]
fn chunk<T: Send>(
    indices: core::ops::Range<usize>,
    run: &(impl Fn(usize) -> T + Sync + Send),
) -> Vec<T> {
    use rayon::iter::{IntoParallelIterator, ParallelIterator};
    indices.into_par_iter().map(run).collect()
}

#[cfg(not(feature = "parallel"))]
fn chunk<T: Send>(
    indices: core::ops::Range<usize>,
    run: &(impl Fn(usize) -> T + Sync + Send),
) -> Vec<T> {
    indices.map(run).collect()
}

#[cfg(test)]
mod tests {
    use super::ensemble;

    #[test]
    fn exact_results_come_in_order_and_none_is_lost() {
        let mut seen = Vec::new();
        let done = ensemble(
            1500,
            |i| i * i,
            |i, square| {
                seen.push((i, square));
                Ok::<(), ()>(())
            },
        );
        assert_eq!(done, Ok(()));
        assert_eq!(seen, (0..1500).map(|i| (i, i * i)).collect::<Vec<_>>());
    }

    #[test]
    fn exact_an_error_of_the_taker_ends_it() {
        let mut taken = 0;
        let done = ensemble(
            2000,
            |i| i,
            |i, _| {
                taken += 1;
                if i == 700 { Err(i) } else { Ok(()) }
            },
        );
        assert_eq!((done, taken), (Err(700), 701));
    }
}
