//! The fast way through evenly spaced samples: a block of eight at a time.
//!
//! A block's end follows from its start by one precomputed formula, and a bound shows that nothing
//! happened between: no event, no new peak. Where the bound is too coarse the same formula gives
//! one value at all eight samples at once, and a bound for single samples shows how far nothing
//! happens. The next sample goes by its Taylor series ([`step`]), which takes events that are
//! beyond doubt; whatever is not goes the long way of [`exact`](super::exact). The book's chapter
//! "Theory" has the proofs.

mod lanes;
mod leap;
mod peaks;
mod plant;
mod series;
mod step;
mod tables;
#[cfg(test)]
mod tests;
mod view;
mod walk;
mod windows;

use fearless_simd::{Level, dispatch};

use self::walk::Walk;
use crate::error::SolveError;

pub(super) use tables::Tables;
pub(super) use view::{ACCELERATION, DISPLACEMENT};
pub(super) use walk::{Carry, Ground, Host};
pub(super) use windows::Windows;

/// What a run needs to go by blocks.
#[derive(Clone, Copy)]
pub(super) struct Blocks<'a> {
    pub(super) tables: &'a Tables,
    pub(super) windows: &'a Windows,
    pub(super) level: Level,
}

/// Walks by blocks from a sample to the end of the evenly spaced samples, which are `end`.
pub(super) fn walk(
    blocks: Blocks<'_>,
    ground: &Ground<'_>,
    host: &mut dyn Host,
    carry: &mut Carry,
    sample: usize,
    end: usize,
) -> Result<(), SolveError> {
    let tables = (blocks.tables, blocks.windows);
    dispatch!(blocks.level, simd => {
        Walk::new(simd, tables, ground, host, carry).go(sample, end)
    })
}
