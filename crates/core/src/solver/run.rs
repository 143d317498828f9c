//! One analysis: its state, and the way through the motion.
//!
//! Evenly spaced samples go by screened propagation (`screen`), eight at a time, as far as a bound
//! shows that nothing happens in them. Every other sample goes by event stepping (`event`), which
//! knows the Taylor series of the motion and misses nothing. Peaks are looked for in `peaks`. Where
//! `dense` can, it runs ahead of all three. `course` says what follows an event.

use core::mem::take;

use fearless_simd::f64x8;
use fearless_simd::prelude::*;

use super::course::Course;
use super::dense::{self, Dense, Reached};
use super::ground::{Ground, Normal, Roughness};
use super::outputs::{Group, output};
use super::peaks::Peaks;
use super::recorder::{Knot, Recorder};
use super::slider::SliderState;
use super::tables::{Batch, LazyPhase, Phase, Tables};
use super::workspace::Workspace;
use crate::error::SolveError;
use crate::linear::lanes::{Eight, Width, combine8, dot, eight};
use crate::linear::{BATCH, Force, Series};
use crate::progress::Pulse;
use crate::response::{Event, Mode, StopDemands, SurfaceDemands};
use crate::slider::{Affine, Contact, EXITS, Exit, Fading, Hold, Law, Restraint};

/// Extremes, path and duration of sliding; `s` is monotone between two events.
#[derive(Clone, Copy)]
pub(super) struct Sliding {
    pub(super) max_m: f64,
    pub(super) min_m: f64,
    pub(super) peak_time_s: f64,
    pub(super) path_m: f64,
    pub(super) time_s: f64,
    /// Least margin of the decisions at stops so far; infinite where there was none.
    pub(super) closest_stop: f64,
    phase_start: [f64; 2],
}

impl Sliding {
    pub(super) fn new(s: f64) -> Self {
        Self {
            max_m: s,
            min_m: s,
            peak_time_s: 0.0,
            path_m: 0.0,
            time_s: 0.0,
            closest_stop: f64::INFINITY,
            phase_start: [0.0, s],
        }
    }

    /// A stop is decided by a margin, if it is one.
    pub(super) fn decide(&mut self, margin: Option<f64>) {
        self.closest_stop = self.closest_stop.min(margin.unwrap_or(f64::INFINITY));
    }

    /// The block starts to slide, one way or the other.
    pub(super) fn begin(&mut self, time_s: f64, s: f64) {
        self.phase_start = [time_s, s];
    }

    /// It stops, turns round, or the motion ends.
    pub(super) fn end(&mut self, time_s: f64, s: f64) {
        if s.abs() > self.max_m.max(-self.min_m) {
            self.peak_time_s = time_s;
        }
        self.max_m = self.max_m.max(s);
        self.min_m = self.min_m.min(s);
        let [start_s, start_m] = self.phase_start;
        self.path_m += (s - start_m).abs();
        self.time_s += time_s - start_s;
    }
}

/// What an analysis leaves behind.
pub(super) struct Outcome {
    pub(super) events: Vec<Event>,
    pub(super) overturns: bool,
    pub(super) sliding: Sliding,
    pub(super) stop: Option<StopDemands>,
    pub(super) surfaces: Vec<SurfaceDemands>,
    pub(super) residual_m: f64,
    pub(super) sliding_at_end: bool,
}

/// A polyline departs from its chord over a batch by no more than this times the sum of its second
/// differences.
const BEND: f64 = 0.25 * BATCH as f64;

/// Bounds over a batch: on `‖ẋ‖` and `‖ẍ‖`, on `|ȧ|` and `|Ṫ|`, and how far `a` and `T` themselves
/// depart from their chords.
#[derive(Clone, Copy, Debug)]
pub(super) struct Curvature {
    first: f64,
    second: f64,
    jerk: f64,
    force_rate: f64,
    bend_of_a: f64,
    bend_of_force: f64,
}

impl Curvature {
    /// How far outputs of a group depart from a chord within one sample, `reach` being `h²/8`: for
    /// `y = c·x + …`, `|ÿ| ≤ min(|c|* ‖ẍ‖, |c A|* ‖ẋ‖ + |c b| |ȧ| + …)`.
    #[inline(always)]
    pub(super) fn slack<S: Simd>(&self, simd: S, group: &Group, reach: f64) -> f64x8<S> {
        let by_second = group.norm.load(simd) * eight(simd, self.second);
        let by_first = group.norm_of_rate.load(simd) * eight(simd, self.first)
            + (group.of_jerk.load(simd) * eight(simd, self.jerk)
                + group.of_force_rate.load(simd) * eight(simd, self.force_rate));
        by_first.simd_lt(by_second).select(by_first, by_second) * eight(simd, reach)
    }

    /// The same from a chord over the batch, in which the loads have kinks.
    #[inline(always)]
    pub(super) fn slack_over_batch<S: Simd>(&self, simd: S, group: &Group, reach: f64) -> f64x8<S> {
        self.slack(simd, group, reach) + self.bend(simd, group)
    }

    /// What the kinks of the loads alone add over a batch.
    #[inline(always)]
    pub(super) fn bend<S: Simd>(&self, simd: S, group: &Group) -> f64x8<S> {
        group.size_of_a.load(simd) * eight(simd, self.bend_of_a)
            + group.size_of_friction.load(simd) * eight(simd, self.bend_of_force)
    }
}

/// What is in force between two events.
#[derive(Clone, Copy)]
pub(super) struct InForce<'a> {
    pub(super) mode: Mode,
    pub(super) phase: &'a LazyPhase,
    /// Constant part of the friction force over the normal force, `−σ μ_k`; 0 in stick.
    pub(super) friction: f64,
    /// What the stop does to the outputs: in slip the constant force of its branch, in stick its force.
    pub(super) stop: f64,
    /// What fades with the speed.
    pub(super) fading: Option<Fading>,
}

impl InForce<'_> {
    /// The friction force but for what of it the state adds.
    #[inline(always)]
    pub(super) fn friction_n(&self, normal_n: f64, w: f64) -> f64 {
        match self.fading {
            None => self.friction * normal_n,
            Some(fading) => self.friction * normal_n + fading.at(w),
        }
    }

    /// Friction force in slip, and the force that a [`Knot`] names, from what holds in stick.
    #[inline(always)]
    pub(super) fn forces(&self, hold: &Hold, normal_n: f64, x: &[f64]) -> [f64; 2] {
        let mut friction_n = self.friction_n(normal_n, x[1]);
        let force_n = match self.mode {
            Mode::Stick => hold.force_n,
            Mode::Slip(_) => friction_n - self.stop,
        };
        let of_friction = self.phase.of_friction();
        if of_friction != Restraint::default() {
            let Restraint { stiffness_n_per_m: k, damper_n_s_per_m: c } = of_friction;
            friction_n -= k * x[0] + c * x[1];
        }
        [friction_n, force_n]
    }
}

/// An analysis under way.
pub(super) struct Run<'a, S, W> {
    pub(super) simd: S,
    pub(super) width: W,
    pub(super) tables: &'a Tables,
    pub(super) ground: Ground<'a>,
    /// Where a history is wanted.
    pub(super) recorder: Option<Recorder>,
    /// Asks whether to go on.
    pub(super) pulse: Pulse<'a>,
    /// Units of work for that: a batch of samples, and a segment between two events.
    pub(super) units: [u32; 2],
    /// `s, ṡ, η, η̇`, padded.
    pub(super) x: Vec<f64>,
    /// A state ahead.
    pub(super) next: Vec<f64>,
    /// Outputs in `x`, where they are known.
    pub(super) values: Vec<Eight>,
    pub(super) series: Series,
    /// Amplitudes of the structure in stick.
    pub(super) amplitudes: Vec<f64>,
    /// Room for two lists of storey coordinates.
    pub(super) spare: [Vec<f64>; 2],
    pub(super) peaks: Peaks,
    pub(super) course: Course<'a>,
    /// What follows from mode and memory.
    pub(super) now: InForce<'a>,
    /// In slip how the branch can end.
    pub(super) exits: [Option<Exit>; EXITS],
    /// What holds the block at rest, in stick.
    pub(super) hold: Hold,
    /// Length that a series of fading friction had last, in s.
    pub(super) fading_s: f64,
    /// Where it can run ahead.
    dense: Option<Dense<'a>>,
    /// What may hold a peak of what it has gone through.
    candidates: Vec<dense::Candidate>,
}

impl<'a, S: Simd, W: Width> Run<'a, S, W> {
    pub(super) fn new(
        (simd, width): (S, W),
        (tables, law): (&'a Tables, &'a Law<'a>),
        ground: Ground<'a>,
        (recorder, pulse): (Option<Recorder>, Pulse<'a>),
        room: &mut Workspace,
    ) -> Self {
        let system = &tables.stick.system;
        let stride = 4 * width.fours();
        let n = width.modes();
        let [mut x, next] = room.states.each_mut().map(|x| Workspace::list(x, stride, 0.0));
        x.copy_from_slice(&tables.start);
        let [s, w] = [x[0], x[1]];
        let outputs = output::count(system.storeys);
        let groups = outputs.div_ceil(8);
        let values = Workspace::list(&mut room.values, groups, Eight::ZERO);
        let [mut amplitudes, f, g] =
            room.modes.each_mut().map(|list| Workspace::list(list, n, 0.0));
        amplitudes.resize(n.next_multiple_of(4), 0.0);
        let (mut series, mut peaks) = (take(&mut room.series), take(&mut room.peaks));
        series.serve(system, tables.orders);
        peaks.serve(groups, outputs, stride);
        let mut events = take(&mut room.events);
        events.clear();
        let course = Course::new(SliderState::new(law, s, w), [s, w], events);
        let now = InForce {
            mode: course.mode,
            phase: &tables.stick,
            friction: 0.0,
            stop: 0.0,
            fading: None,
        };
        let of_dense = tables.dense.as_deref();
        let dense =
            of_dense.and_then(|of| Dense::new(simd, (of, &tables.stick.system), law, ground));
        let mut candidates = take(&mut room.candidates);
        candidates.clear();
        Self {
            simd,
            width,
            tables,
            ground,
            recorder,
            pulse,
            units: [4, 32].map(|units| units * (1 + n as u32)),
            next,
            values,
            series,
            amplitudes,
            spare: [f, g],
            peaks,
            hold: course.slider.hold(s),
            course,
            now,
            exits: [None; EXITS],
            fading_s: f64::INFINITY,
            dense,
            candidates,
            x,
        }
    }

    /// Goes through all sample intervals.
    #[inline(always)]
    pub(super) fn go(&mut self) -> Result<(), SolveError> {
        let (simd, times_s) = (self.simd, self.ground.times_s);
        let last = times_s.len() - 1;
        let mut sample = 0;
        self.set_in_force();
        while sample < last {
            if times_s[sample + 1] == times_s[sample] {
                // The left side of a jump; the right side decides, as the next sample does.
                self.record_sample(sample, true);
                sample += 1;
                continue;
            }
            let end = self.ground.sampling.regular_end(sample, last);
            let mut from_s = 0.0;
            if let Some((dense, shared)) = self.sharing() {
                let samples = [sample, end];
                Reached { sample, at_s: from_s } = dense.run_ahead(simd, shared, samples)?;
                self.set_in_force();
            } else {
                sample = self.screened(sample, end);
            }
            self.pulse.beat(self.units[0])?;
            if sample < last && times_s[sample + 1] > times_s[sample] {
                self.step_events(sample, from_s)?;
                sample += 1;
            }
        }
        self.finish(last)
    }

    /// What runs ahead, and what it shares with this.
    fn sharing(&mut self) -> Option<(Dense<'a>, dense::Shared<'_, 'a>)> {
        let shared = dense::Shared {
            x: self.x.first_chunk_mut()?,
            peak: &mut self.peaks.peak.first_mut()?.0,
            course: &mut self.course,
            candidates: &mut self.candidates,
            recorder: self.recorder.as_mut(),
            pulse: &mut self.pulse,
        };
        Some((self.dense?, shared))
    }

    fn finish(&mut self, last: usize) -> Result<(), SolveError> {
        let end_s = self.ground.times_s[last];
        if !self.x.iter().all(|x| x.is_finite()) {
            return Err(SolveError::NotFinite { time_s: end_s });
        }
        if self.course.is_stopped(self.x[1]) {
            // A stop at the very end is decided by the limit from the left.
            let interval = (0..last).rev().find(|&i| self.ground.times_s[i] < end_s);
            if let Some(interval) = interval {
                let length_s = end_s - self.ground.times_s[interval];
                let stretch = self.ground.stretch(interval, 0.0, length_s);
                self.record(&stretch, length_s, false);
                self.stop(&stretch, length_s);
            }
        }
        if let Some(stretch) = self.ground.after_last_jump() {
            self.look_after_jump(&stretch);
        }
        self.record_sample(last, true);
        if matches!(self.course.mode, Mode::Slip(_)) {
            self.course.sliding.end(end_s, self.x[0]);
        }
        if self.course.slider.law.has_pads() {
            self.course.slider.stopping.change(
                end_s,
                0.0,
                self.course.slider.memory.contact,
                Contact::Free,
            );
        }
        self.course.slider.note_surfaces(self.x[0]);
        let simd = self.simd;
        if let Some((dense, shared)) = self.sharing() {
            dense.settle(simd, shared);
        }
        self.settle_peaks();
        Ok(())
    }

    /// What the analysis leaves behind, its recorder, and its room.
    pub(super) fn outcome(self, room: &mut Workspace) -> (Outcome, Option<Recorder>) {
        let outcome = Outcome {
            events: self.course.events.clone(),
            overturns: self.tables.overturns(),
            sliding: self.course.sliding,
            stop: self.course.slider.law.has_pads().then_some(self.course.slider.stopping.demands),
            surfaces: self.course.slider.surfaces.demands(),
            residual_m: self.x[0],
            sliding_at_end: matches!(self.course.mode, Mode::Slip(_)),
        };
        let [f, g] = self.spare;
        room.states = [self.x, self.next];
        room.modes = [self.amplitudes, f, g];
        (room.values, room.series) = (self.values, self.series);
        (room.peaks, room.events) = (self.peaks, self.course.events);
        room.candidates = self.candidates;
        (outcome, self.recorder)
    }

    // ---- what is in force -----------------------------------------------------------------------

    /// Finds what follows from mode and memory.
    pub(super) fn set_in_force(&mut self) {
        let (mode, s) = (self.course.mode, self.x[0]);
        let normal_n = match self.ground.normal {
            Normal::Constant(normal_n) => normal_n,
            // The restraints of a law that is affine under any force do not ask for it.
            Normal::Varying(_) => 0.0,
        };
        let stick = &self.tables.stick;
        self.now = InForce { mode, phase: stick, friction: 0.0, stop: 0.0, fading: None };
        match mode {
            Mode::Stick => {
                self.hold = self.course.slider.law.hold(&self.course.slider.memory, s);
                if self.course.slider.law.has_pads() {
                    self.now.stop = self.hold.force_n - stick.system.stiffness_n_per_m * s;
                }
            }
            Mode::Slip(direction) => {
                self.exits = self.course.slider.law.exits(&self.course.slider.memory, direction);
                let force = self.course.slider.law.force(&self.course.slider.memory, direction);
                let Affine { restraints, force_n, coefficient, fading } = force.affine(normal_n);
                let phase = self.tables.under(restraints);
                let (friction, stop) = (-coefficient, force_n);
                self.now = InForce { mode, phase, friction, stop, fading };
            }
        }
        self.set_limits();
    }

    /// The friction force of a batch of slip, from its coefficient.
    #[inline(always)]
    pub(super) fn batch_force(&self, coefficient: f64, sample: usize) -> Force<'a> {
        match self.ground.normal {
            Normal::Constant(normal) => {
                Force::Constant(coefficient * if normal > 0.0 { normal } else { 0.0 })
            }
            Normal::Varying(normal) => match normal[sample..].first_chunk() {
                Some(window) => Force::Varying(coefficient, window),
                None => Force::Constant(0.0),
            },
        }
    }

    /// Groups of eight outputs; those of one storey are one.
    #[inline(always)]
    pub(super) fn groups(&self, phase: &Phase) -> usize {
        if self.width.modes() == 1 { 1 } else { phase.outputs.groups.len() }
    }

    /// A group of outputs in a padded state.
    #[inline(always)]
    pub(super) fn group_at(
        simd: S,
        phase: &Phase,
        g: usize,
        x: &[f64],
        [friction, a, stop]: [f64; 3],
    ) -> f64x8<S> {
        let used = if x.len() <= 12 { x.len() } else { phase.outputs.groups[g].used };
        let columns = &phase.outputs.columns[g * (4 + x.len())..][..4 + used];
        combine8(simd, columns, &[1.0, friction, a, stop], &[], &x[..used])
    }

    /// What bounds the second derivatives of the outputs over the batch from a sample.
    ///
    /// A kink of the loads adds to `‖ẍ‖` at most `√M_tot |Δȧ| + |ΔṪ|/√M1`, and their change to `‖ẋ‖`
    /// at most `√M_tot |Δa| + |ΔT|/√M1`; from its chord over `n` samples a polyline departs by no more
    /// than `n/4` times the sum of its second differences.
    #[inline(always)]
    pub(super) fn curvature(
        &mut self,
        phase: &Phase,
        coefficient: f64,
        sample: usize,
        batch: &Batch,
    ) -> Curvature {
        let per_dt = batch.per_dt;
        let a = self.ground.acceleration;
        let jerk = (a[sample + 1] - a[sample]) * per_dt;
        let normal = self.ground.normal_at(sample);
        let force = coefficient * if normal > 0.0 { normal } else { 0.0 };
        let force_rate = match self.ground.normal {
            Normal::Constant(_) => 0.0,
            Normal::Varying(n) => coefficient * ((n[sample + 1] - n[sample]) * per_dt),
        };
        let system = &phase.system;
        let loads = [[a[sample], jerk], [force, force_rate]];
        let how = (self.simd, self.width);
        let [first, second] = Self::derivative_norms(how, phase, &self.x, loads, &mut self.spare);
        let horizontal = Roughness::new(self.simd, self.window(sample));
        let of_a = if phase.slip { system.root_total_mass } else { system.root_storey_mass };
        let mut curvature = Curvature {
            first: first + of_a * horizontal.variation,
            second: second + per_dt * (of_a * horizontal.kinks),
            jerk: per_dt * horizontal.change,
            force_rate: 0.0,
            bend_of_a: BEND * horizontal.kinks,
            bend_of_force: 0.0,
        };
        if let (Some(normal), true) = (self.ground.normal.window(sample), coefficient != 0.0) {
            let vertical = Roughness::new(self.simd, normal);
            let of_normal = coefficient.abs();
            let of_norm = of_normal * system.per_root_block;
            curvature.first += of_norm * vertical.variation;
            curvature.second += per_dt * (of_norm * vertical.kinks);
            curvature.force_rate = per_dt * (of_normal * vertical.change);
            curvature.bend_of_force = BEND * (of_normal * vertical.kinks);
        }
        curvature.first *= batch.growth;
        curvature.second *= batch.growth;
        curvature
    }

    /// Energy norms of `ẋ` and `ẍ` in a state under an acceleration and a force, each with its rate.
    #[inline(always)]
    pub(super) fn derivative_norms(
        (simd, width): (S, W),
        phase: &Phase,
        x: &[f64],
        [load, force]: [[f64; 2]; 2],
        [f, eta2]: &mut [Vec<f64>; 2],
    ) -> [f64; 2] {
        let (system, slip) = (&phase.system, phase.slip);
        if width.modes() == 1 {
            let (mut f, mut eta2) = ([0.0], [0.0]);
            return system.derivative_norms(simd, slip, x, load, force, [&mut f, &mut eta2]);
        }
        system.derivative_norms(simd, slip, x, load, force, [f, eta2])
    }

    /// The force that keeps the block stuck under an acceleration, eqs (8), (14).
    pub(super) fn demand(&mut self, hold: &Hold, a: f64) -> f64 {
        let system = &self.tables.stick.system;
        let n = self.width.modes();
        let (eta, rate) = (&self.x[2..2 + n], &self.x[2 + n..2 + 2 * n]);
        let f = &mut self.spare[0];
        system.restoring(eta, rate, f);
        (system.block_mass_kg * a + hold.force_n) - dot(&system.participation, f)
    }

    // ---- what is kept ---------------------------------------------------------------------------

    /// Records the present state as a knot at a sample.
    #[inline(never)]
    pub(super) fn record_sample(&mut self, sample: usize, row: bool) {
        if self.recorder.is_some() {
            let normal = self.ground.normal_at(sample).max(0.0);
            let time_s = self.ground.times_s[sample];
            let (table, a) = (self.ground.table[sample], self.ground.acceleration[sample]);
            let x = core::mem::take(&mut self.x);
            self.record_knot(time_s, &x, [table, a, normal], row);
            self.x = x;
        }
    }

    /// Records a state at a time.
    #[inline(never)]
    pub(super) fn record_knot(
        &mut self,
        time_s: f64,
        x: &[f64],
        [table, acceleration, normal]: [f64; 3],
        row: bool,
    ) {
        let (InForce { mode, phase, .. }, contact) = (self.now, self.course.slider.memory.contact);
        let [friction_n, force_n] = self.now.forces(&self.hold, normal, x);
        let knot =
            Knot { time_s, mode, contact, table, acceleration, state: x, friction_n, force_n };
        if let Some(recorder) = &mut self.recorder {
            recorder.knot(&phase.system, &knot, row);
            if recorder.history.surfaces > 0 {
                let surfaces = self.course.slider.law.surfaces(&self.course.slider.memory, x[0]);
                recorder.history.surface_displacement_m.extend(surfaces);
            }
        }
    }

    /// Draws the limits around the peaks attained; a demand that has reached its largest bound cannot
    /// grow but by rounding.
    #[inline(always)]
    pub(super) fn set_limits(&mut self) {
        for (limit, peak) in self.peaks.limit.iter_mut().zip(&self.peaks.peak) {
            peak.load(self.simd).store_slice(&mut limit.0);
        }
        if let (Mode::Stick, Normal::Constant(normal)) = (self.course.mode, self.ground.normal) {
            let bound = self.course.slider.law.largest_static_n(normal) * (1.0 - 1e-14);
            let first = &mut self.peaks.limit[0].0;
            if first[output::FRICTION] >= bound {
                first[output::FRICTION] = f64::INFINITY;
            }
            let free = self.tables.stick.system.stiffness_n_per_m == 0.0
                && !self.course.slider.law.has_pads();
            if free && first[output::SLIDER] >= bound {
                first[output::SLIDER] = f64::INFINITY;
            }
        }
    }
}
