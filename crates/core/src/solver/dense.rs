//! A way ahead for one storey or none under a plain law: no stop, no rate, a constant normal force.
//!
//! The state stays in registers. A block of eight samples follows from its start by one precomputed
//! formula, and a bound shows that nothing happened between: no event, no new peak. Where the bound is
//! too coarse the same formula gives one value at all eight samples at once, and a bound for single
//! samples shows how far nothing happens. The next sample goes by its Taylor series ([`step`]), which
//! takes events that are beyond doubt; whatever is not is handed back to event stepping, in the midst of
//! the sample if need be. The book's chapter "Theory" has the proofs.

mod lanes;
mod leap;
mod peaks;
mod plant;
mod series;
mod step;
mod tables;
mod view;
mod walk;
mod windows;

use fearless_simd::Level;
use fearless_simd::prelude::*;

use self::walk::Walk;
use crate::error::{Pulse, SolveError};
use crate::linear::System;
use crate::solver::recorder::Recorder;

pub(super) use peaks::Candidate;
pub(super) use tables::Tables;
pub(super) use walk::{Carry, Ground, Reached};
pub(super) use windows::Windows;

/// Walks from a sample towards the end of the evenly spaced samples.
pub(super) fn run_ahead<S: Simd>(
    simd: S,
    tables: (&Tables, &Windows),
    ground: &Ground<'_>,
    keeps: (Option<(&mut Recorder, &System)>, &mut Pulse<'_>),
    carry: &mut Carry,
    samples: [usize; 2],
) -> Result<Reached, SolveError> {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    if simd.level().as_avx2().is_some()
        && let Some(wide) = Level::new().as_avx512()
    {
        return go(wide, tables, ground, keeps, carry, samples);
    }
    go(simd, tables, ground, keeps, carry, samples)
}

#[inline(never)]
fn go<S: Simd>(
    simd: S,
    tables: (&Tables, &Windows),
    ground: &Ground<'_>,
    (recorder, pulse): (Option<(&mut Recorder, &System)>, &mut Pulse<'_>),
    carry: &mut Carry,
    [sample, end]: [usize; 2],
) -> Result<Reached, SolveError> {
    simd.vectorize(
        #[inline(always)]
        || Walk::new(simd, tables, ground, recorder, carry).go(sample, end, pulse),
    )
}

/// Looks at all places that may still hold a peak.
#[inline(never)]
pub(super) fn settle<S: Simd>(
    simd: S,
    tables: (&Tables, &Windows),
    ground: &Ground<'_>,
    carry: &mut Carry,
) {
    simd.vectorize(
        #[inline(always)]
        || {
            let mut walk = Walk::new(simd, tables, ground, None, carry);
            walk.settle();
            walk.hand_peaks();
        },
    );
}
