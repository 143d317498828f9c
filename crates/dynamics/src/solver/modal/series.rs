//! The series of one number of the motion, and the state at a part of it.

use core::mem::swap;

use fearless_simd::prelude::*;

use super::super::ground::Stretch;
use super::super::phase::{Segment, fitting};
use super::super::tables::PhaseTables;
use super::{How, InForce, Modal};
use crate::linear::lanes::{Width, least};
use crate::linear::polynomial::{DEGREE, Polynomial};
use crate::linear::{Load, ModalSeries};
use crate::response::{Mode, output};
use crate::slider::Fading;

/// The motion from an instant on, by one number of it.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::solver) struct Motion {
    pub(super) segment: Segment,
    /// In slip the sliding velocity, in stick the demand on friction.
    pub(super) number: Polynomial,
    /// `s`, where the block slides and its branch can end elsewhere than at a stop: `∫ ṡ dt + s₀`.
    pub(super) displacement: Polynomial,
    /// Loads, as the state takes them.
    pub(super) load: Load,
    /// `N` at the start, and its change over the unit.
    pub(super) normal: [f64; 2],
}

impl Motion {
    #[inline(always)]
    fn integrate(&mut self, start_m: f64) {
        self.displacement[0] = start_m;
        for k in 0..DEGREE {
            self.displacement[k + 1] = self.number[k] * (self.segment.unit_s / (k + 1) as f64);
        }
    }
}

impl Modal<'_> {
    /// The part of a stretch from a time on over which one series of so long goes.
    #[inline(always)]
    fn extent(unit_s: f64, stretch: &Stretch, from_s: f64) -> Segment {
        let part = (stretch.to_s - from_s) / unit_s;
        // A hair beyond is the rounding of the times.
        if part <= 1.0 + 1e-9 {
            let part = if part < 1.0 { part } else { 1.0 };
            Segment { from_s, to_s: stretch.to_s, unit_s, part }
        } else {
            Segment { from_s, to_s: from_s + unit_s, unit_s, part: 1.0 }
        }
    }

    /// Expands the motion from a time of a stretch.
    #[inline(always)]
    pub(super) fn expand_motion<S: Simd, W: Width>(
        &mut self,
        how: How<S, W>,
        stretch: &Stretch,
        from_s: f64,
    ) {
        let InForce { mode, tables, stop, fading, .. } = self.now;
        let (simd, stride) = (how.simd, 4 * how.width.fours());
        let phase = tables.get();
        if let Some(fading) = fading {
            self.motion.segment = self.expand_fading(how, &fading, stretch, from_s);
            self.motion.load = self.load(stretch, &self.motion.segment);
            self.motion.number = self.series.component(how.width, 1);
        } else {
            self.motion.segment = Self::extent(phase.unit_s, stretch, from_s);
            self.motion.load = self.load(stretch, &self.motion.segment);
            let (x, Motion { load, number, .. }) = (&self.x[..stride], &mut self.motion);
            *number = phase.solution.number(simd, &phase.system, (x, load), &mut self.series);
            if mode == Mode::Stick {
                let row = &phase.outputs.rows[output::FRICTION];
                number[0] += row.state[0] * x[0] + (row.of_stop * stop + row.constant);
            }
        }
        let unit_s = self.motion.segment.unit_s;
        self.motion.normal = [stretch.normal_at(from_s), stretch.normal_rate * unit_s];
        if mode != Mode::Stick && (self.exits.iter().any(Option::is_some) || self.law.has_pads()) {
            self.motion.integrate(self.x[0]);
        }
    }

    /// Loads over a segment, as the state takes them.
    #[inline(always)]
    fn load(&self, stretch: &Stretch, segment: &Segment) -> Load {
        let InForce { mode, friction, stop, .. } = self.now;
        let mut load = stretch.load(segment.from_s, segment.unit_s, friction);
        if mode != Mode::Stick {
            load.force -= stop;
        }
        load
    }

    /// Expands the motion under friction that fades with the speed, over as much of a stretch as one
    /// series takes.
    #[inline(never)]
    fn expand_fading<S: Simd, W: Width>(
        &mut self,
        how: How<S, W>,
        fading: &Fading,
        stretch: &Stretch,
        from_s: f64,
    ) -> Segment {
        let InForce { tables, friction, stop, .. } = self.now;
        let stride = 4 * how.width.fours();
        let phase = tables.get();
        // At the end of a stretch any length serves.
        let left_s = if from_s < stretch.to_s { stretch.to_s - from_s } else { phase.unit_s };
        let [unit_s, part] = fitting(&mut self.fading_s, phase.unit_s, left_s, |unit_s| {
            let mut load = stretch.load(from_s, unit_s, friction);
            load.force -= stop;
            let (x, fading) = (&self.x[..stride], [fading.force_n, fading.rate_s_per_m]);
            self.series.expand_fading(how.width, &phase.system, x, &load, unit_s, fading)
        });
        let whole = part == 1.0 && unit_s == left_s;
        let to_s = if whole { stretch.to_s } else { least(from_s + part * unit_s, stretch.to_s) };
        Segment { from_s, to_s, unit_s, part }
    }

    /// Moves the state to a part of what was expanded last.
    #[inline(always)]
    pub(super) fn move_motion<S: Simd, W: Width>(&mut self, how: How<S, W>, part: f64) {
        swap(&mut self.x, &mut self.next);
        let stride = 4 * how.width.fours();
        let (from, to) = (&self.next[..stride], &mut self.x[..stride]);
        if self.now.fading.is_some() {
            self.series.state_at(how.simd, part, to);
            return;
        }
        let (phase, start) = (self.now.tables.get(), (from, &self.motion.load));
        phase.solution.state_at(how.simd, &phase.system, start, part, &mut self.series, to);
    }
}

/// The series of an output from that of the state; the load's force contains no constant force of a
/// stop but what `stop` says in the output's own way.
#[inline(always)]
pub(super) fn output_series<S: Simd, W: Width>(
    How { simd, width }: How<S, W>,
    phase: &PhaseTables,
    j: usize,
    series: &ModalSeries,
    load: &Load,
    stop: f64,
) -> Polynomial {
    let row = &phase.outputs.rows[j];
    let mut p = series.row(simd, width, &row.state);
    let [constant, change] = load.times([row.of_a, row.of_friction]);
    p[0] += constant + (row.of_stop * stop + row.constant);
    p[1] += change;
    p
}
