//! Running ahead of event stepping: one storey or none under a plain law, a constant normal force, evenly
//! spaced samples.
//!
//! What the general way does for any number of storeys, screened propagation ([`screen`]), event samples
//! ([`event`]) and candidates for peaks ([`peaks`]), is done here for four numbers that stay in vector
//! registers. It goes on while nothing is in doubt and hands over by returning, in the midst of a sample if
//! need be: two roots near each other, an event on a sample, a demand at its bound are left to event
//! stepping, and so is every motion with an irregular interval. It decides nothing by itself: what follows an event is
//! said by [`WalkState`]. The book's chapter "Theory" has the bounds and their proofs.

mod ahead;
mod equations;
mod event;
mod lanes;
mod outputs;
mod peaks;
mod record;
mod screen;
mod series;
mod tables;

use fearless_simd::prelude::*;

use self::ahead::Ahead;
use super::course::WalkState;
use super::ground::{Ground, Normal};
use super::phase::Advance;
use super::recorder::Recorder;
use super::windows::Windows;
use crate::error::SolveError;
use crate::linear::System;
use crate::progress::Pulse;
use crate::slider::{Law, TwoBranches};

pub(super) use self::outputs::{Kept, REGISTERS, Shape};
pub(super) use self::peaks::Candidate;
pub(super) use self::tables::Tables;

/// What running ahead needs to know of an analysis.
#[derive(Clone, Copy)]
pub(super) struct Dense<'a> {
    tables: &'a Tables,
    windows: &'a Windows,
    system: &'a System,
    ground: Ground<'a>,
    normal_n: f64,
    /// `−μ_s⁺ N` and `μ_s⁻ N`.
    bounds_n: [f64; 2],
    /// Friction force of sliding towards +x and towards −x.
    kinetic_n: [f64; 2],
}

/// What it shares with the general way.
pub(super) struct Shared<'r, 'a> {
    /// `s, ṡ, η, η̇`, with zeros for the structure of a rigid block.
    pub(super) x: &'r mut [f64; 4],
    /// Peaks attained so far, in the order of the outputs.
    pub(super) peak: &'r mut Kept,
    pub(super) course: &'r mut WalkState<'a>,
    pub(super) candidates: &'r mut Vec<Candidate>,
    pub(super) recorder: Option<&'r mut Recorder>,
    pub(super) pulse: &'r mut Pulse<'a>,
}

impl<'a> Dense<'a> {
    /// Where a law and a normal force allow it.
    pub(super) fn new<S: Simd>(
        simd: S,
        (tables, system): (&'a Tables, &'a System),
        law: &Law<'_>,
        ground: Ground<'a>,
    ) -> Option<Self> {
        let Normal::Constant(normal_n) = ground.normal else { return None };
        if !(normal_n > 0.0) {
            return None;
        }
        let TwoBranches { bounds_n, kinetic_n } = law.two_branches(normal_n)?;
        let windows = ground.sampling.windows(simd, ground.table);
        Some(Self { tables, windows, system, ground, normal_n, bounds_n, kinetic_n })
    }

    /// Goes on from the first of two samples towards the second, as far as nothing is in doubt.
    #[inline(never)]
    pub(super) fn run_ahead<S: Simd>(
        &self,
        simd: S,
        shared: Shared<'_, 'a>,
        samples: [usize; 2],
    ) -> Result<Advance, SolveError> {
        simd.vectorize(
            #[inline(always)]
            || Ahead::new(simd, self, shared).go(samples),
        )
    }

    /// Settles what may still hold a peak.
    #[inline(never)]
    pub(super) fn settle<S: Simd>(&self, simd: S, shared: Shared<'_, 'a>) {
        simd.vectorize(
            #[inline(always)]
            || {
                let mut ahead = Ahead::new(simd, self, shared);
                ahead.settle();
                ahead.hand_over();
            },
        );
    }
}
