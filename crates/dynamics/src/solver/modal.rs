//! The motion by the modes of the structure, for a lone slider whose branches are affine.
//!
//! Evenly spaced samples go by screened propagation (`screen`), eight at a time, as far as a bound
//! shows that nothing happens in them. An event sample goes by the series of one number, the sliding velocity
//! or the demand on friction, and by maps of the state (`series`). Peaks are looked for in `peaks`. Where
//! `dense` can, it runs ahead of all three.

mod buffers;
mod peaks;
mod screen;
mod series;
mod settle;

use core::mem::{swap, take};

use fearless_simd::f64x8;
use fearless_simd::prelude::*;

use self::series::Motion;
use super::course::WalkState;
use super::dense::{self, Dense};
use super::ground::{Ground, Normal, Roughness, Stretch};
use super::outputs::OutputGroup;
use super::phase::{Advance, LinePhase, Of, Phase, Segment};
use super::recorder::{Knot, Recorder};
use super::slider::ROUNDING;
use super::tables::{Batch, LazyPhase, PhaseTables, Tables};
use super::walk::Walk;
use crate::error::SolveError;
use crate::linear::lanes::{Eight, Many, One, Width, combine8, dot, eight};
use crate::linear::polynomial::{Polynomial, derivative};
use crate::linear::{BATCH, Force, ModalSeries};
use crate::numerics::InstructionSet;
use crate::numerics::instructions::vectorize;
use crate::response::Mode;
use crate::response::output::{self, Output};
use crate::slider::{Affine, Contact, EXITS, Exit, Fading, Hold, Law, Restraint};

pub(super) use self::buffers::Buffers;
pub(super) use self::peaks::Peaks;

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
    pub(super) fn slack<S: Simd>(&self, simd: S, group: &OutputGroup, reach: f64) -> f64x8<S> {
        let by_second = group.norm.load(simd) * eight(simd, self.second);
        let by_first = group.norm_of_rate.load(simd) * eight(simd, self.first)
            + (group.of_jerk.load(simd) * eight(simd, self.jerk)
                + group.of_force_rate.load(simd) * eight(simd, self.force_rate));
        by_first.simd_lt(by_second).select(by_first, by_second) * eight(simd, reach)
    }

    /// The same from a chord over the batch, in which the loads have kinks.
    #[inline(always)]
    pub(super) fn slack_over_batch<S: Simd>(
        &self,
        simd: S,
        group: &OutputGroup,
        reach: f64,
    ) -> f64x8<S> {
        self.slack(simd, group, reach) + self.bend(simd, group)
    }

    /// What the kinks of the loads alone add over a batch.
    #[inline(always)]
    pub(super) fn bend<S: Simd>(&self, simd: S, group: &OutputGroup) -> f64x8<S> {
        group.size_of_a.load(simd) * eight(simd, self.bend_of_a)
            + group.size_of_friction.load(simd) * eight(simd, self.bend_of_force)
    }
}

/// What is in force between two events.
#[derive(Clone, Copy)]
pub(super) struct InForce<'a> {
    pub(super) mode: Mode,
    pub(super) contact: Contact,
    pub(super) tables: &'a LazyPhase,
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
        let of_friction = self.tables.of_friction();
        if of_friction != Restraint::default() {
            let Restraint { stiffness_n_per_m: k, damper_n_s_per_m: c } = of_friction;
            friction_n -= k * x[0] + c * x[1];
        }
        [friction_n, force_n]
    }
}

/// By which vector instructions kernels go, and for how many storeys: what the compiler knows inside them, and
/// nothing outside.
#[derive(Clone, Copy)]
pub(super) struct How<S, W> {
    simd: S,
    width: W,
}

/// Work of a kernel by the instructions and for the storeys of a phase: `by!(modal, how => work)`.
macro_rules! by {
    ($modal:expr, $how:ident => $work:expr) => {
        vectorize!($modal.instructions, simd => match $modal.modes {
            0 | 1 => {
                let $how = How { simd, width: One };
                $work
            }
            modes => {
                let $how = How { simd, width: Many(modes) };
                $work
            }
        })
    };
}

/// State, series and peaks of an analysis by modes.
pub(super) struct Modal<'a> {
    instructions: InstructionSet,
    modes: usize,
    tables: &'a Tables,
    law: &'a Law<'a>,
    ground: Ground<'a>,
    /// Where a history is wanted.
    recorder: Option<Recorder>,
    /// Units of work of a batch of samples.
    units: u32,
    /// `s, ṡ, η, η̇`, padded.
    x: Vec<f64>,
    /// A state ahead, or the one before.
    next: Vec<f64>,
    /// Outputs in `x`, where they are known.
    values: Vec<Eight>,
    series: ModalSeries,
    /// What was expanded last, and what is known of an instant.
    motion: Motion,
    instant: Motion,
    /// Amplitudes of the structure in stick.
    amplitudes: Vec<f64>,
    /// Scratch for two lists of storey coordinates.
    scratch: [Vec<f64>; 2],
    peaks: Peaks,
    /// What follows from mode and memory.
    now: InForce<'a>,
    /// In slip how the branch can end.
    exits: [Option<Exit>; EXITS],
    /// What holds the block at rest, in stick.
    hold: Hold,
    /// Length that a series of fading friction had last, in s.
    fading_s: f64,
    /// Where it can run ahead.
    dense: Option<Dense<'a>>,
    /// What may hold a peak of what it has gone through.
    candidates: Vec<dense::Candidate>,
}

impl<'a> Modal<'a> {
    pub(super) fn new(
        (instructions, modes): (InstructionSet, usize),
        (tables, law): (&'a Tables, &'a Law<'a>),
        ground: Ground<'a>,
        recorder: Option<Recorder>,
        buffers: &mut Buffers,
    ) -> Self {
        let system = &tables.stick.system;
        let stride = 4 * Many(modes).fours();
        let n = modes;
        let [mut x, next] = buffers.states.each_mut().map(|x| Buffers::list(x, stride, 0.0));
        x.copy_from_slice(&tables.start);
        let outputs = Output::count(system.points(), 0);
        // At least as many as what runs ahead has registers.
        let groups = outputs.div_ceil(8).max(dense::REGISTERS);
        let values = Buffers::list(&mut buffers.values, groups, Eight::ZERO);
        let [mut amplitudes, f, g] =
            buffers.modes.each_mut().map(|list| Buffers::list(list, n, 0.0));
        amplitudes.resize(n.next_multiple_of(4), 0.0);
        let (mut series, mut peaks) = (take(&mut buffers.series), take(&mut buffers.peaks));
        series.serve(system, tables.orders);
        peaks.serve(groups, outputs, stride);
        let now = InForce {
            mode: Mode::Stick,
            contact: Contact::Free,
            tables: &tables.stick,
            friction: 0.0,
            stop: 0.0,
            fading: None,
        };
        let of_dense = tables.dense.as_deref();
        let of_dense = of_dense.map(|of| (of, &*tables.stick.system));
        let dense = of_dense
            .and_then(|of| vectorize!(instructions, simd => Dense::new(simd, of, law, ground)));
        let mut candidates = take(&mut buffers.candidates);
        candidates.clear();
        Self {
            instructions,
            modes,
            tables,
            law,
            ground,
            recorder,
            units: 4 * (1 + n as u32),
            hold: law.hold(&law.initial(x[0], x[1]), x[0]),
            x,
            next,
            values,
            series,
            motion: Motion::default(),
            instant: Motion::default(),
            amplitudes,
            scratch: [f, g],
            peaks,
            now,
            exits: [None; EXITS],
            fading_s: f64::INFINITY,
            dense,
            candidates,
        }
    }

    /// Gives its lists back; its recorder.
    pub(super) fn leave(self, buffers: &mut Buffers) -> Option<Recorder> {
        let [f, g] = self.scratch;
        buffers.states = [self.x, self.next];
        buffers.modes = [self.amplitudes, f, g];
        (buffers.values, buffers.series) = (self.values, self.series);
        (buffers.peaks, buffers.candidates) = (self.peaks, self.candidates);
        self.recorder
    }

    /// What runs ahead, and what it shares with this.
    fn sharing<'r>(walk: &'r mut Walk<'a, Self>) -> Option<(Dense<'a>, dense::Shared<'r, 'a>)> {
        let phase = &mut walk.phase;
        let shared = dense::Shared {
            x: phase.x.first_chunk_mut()?,
            peak: phase.peaks.peak.first_chunk_mut::<{ dense::REGISTERS }>()?,
            course: &mut walk.course,
            candidates: &mut phase.candidates,
            recorder: phase.recorder.as_mut(),
            pulse: &mut walk.pulse,
        };
        Some((phase.dense?, shared))
    }

    // ---- loads and outputs ----------------------------------------------------------------------

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

    /// A group of outputs in a padded state.
    #[inline(always)]
    pub(super) fn group_at<S: Simd>(
        simd: S,
        phase: &PhaseTables,
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
    pub(super) fn curvature<S: Simd, W: Width>(
        &mut self,
        how: How<S, W>,
        phase: &PhaseTables,
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
        let [first, second] = Self::derivative_norms(how, phase, &self.x, loads, &mut self.scratch);
        let horizontal = Roughness::new(how.simd, self.window(sample));
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
            let vertical = Roughness::new(how.simd, normal);
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
    pub(super) fn derivative_norms<S: Simd, W: Width>(
        How { simd, width }: How<S, W>,
        phase: &PhaseTables,
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

    #[inline(always)]
    fn motion_of(&self, of: Of) -> &Motion {
        match of {
            Of::Motion => &self.motion,
            Of::Instant => &self.instant,
        }
    }

    /// Expands the motion from a time of a stretch.
    fn expand_from(&mut self, stretch: &Stretch, from_s: f64) {
        by!(self, how => self.expand_motion(how, stretch, from_s));
    }

    // ---- what is kept ---------------------------------------------------------------------------

    /// Records a state at a time.
    #[inline(never)]
    fn record_knot(
        &mut self,
        course: &WalkState<'a>,
        time_s: f64,
        [table, acceleration, normal]: [f64; 3],
        row: bool,
    ) {
        let InForce { mode, contact, tables, .. } = self.now;
        let [friction_n, force_n] = self.now.forces(&self.hold, normal, &self.x);
        let knot = Knot {
            time_s,
            mode,
            contact,
            table,
            acceleration,
            state: &self.x,
            friction_n,
            force_n,
        };
        if let Some(recorder) = &mut self.recorder {
            recorder.knot(&tables.system, &knot, row);
            recorder.surfaces(&course.slider, self.x[0]);
        }
    }

    /// Draws the limits around the peaks attained; a demand that has reached its largest bound cannot
    /// grow but by rounding.
    #[inline(always)]
    fn set_limits(&mut self) {
        for (limit, peak) in self.peaks.limit.iter_mut().zip(&self.peaks.peak) {
            *limit = *peak;
        }
        if let (Mode::Stick, Normal::Constant(normal)) = (self.now.mode, self.ground.normal) {
            let bound = self.law.largest_static_n(normal) * (1.0 - 1e-14);
            let first = &mut self.peaks.limit[0].0;
            if first[output::FRICTION] >= bound {
                first[output::FRICTION] = f64::INFINITY;
            }
            let free = self.tables.stick.system.stiffness_n_per_m == 0.0 && !self.law.has_pads();
            if free && first[output::SLIDER] >= bound {
                first[output::SLIDER] = f64::INFINITY;
            }
        }
    }
}

impl<'a> Phase<'a> for Modal<'a> {
    #[inline(always)]
    fn run_ahead(
        walk: &mut Walk<'a, Self>,
        [sample, end]: [usize; 2],
    ) -> Result<Advance, SolveError> {
        let instructions = walk.phase.instructions;
        if let Some((dense, shared)) = Self::sharing(walk) {
            let ahead =
                vectorize!(instructions, simd => dense.run_ahead(simd, shared, [sample, end]));
            let reached = ahead?;
            walk.phase.update_branch(&walk.course);
            return Ok(reached);
        }
        let (phase, course) = (&mut walk.phase, (&walk.course, &mut walk.pulse));
        let sample = by!(phase, how => phase.screened(how, course, sample, end));
        Ok(Advance { sample, at_s: 0.0 })
    }

    fn settle(walk: &mut Walk<'a, Self>) {
        let instructions = walk.phase.instructions;
        if let Some((dense, shared)) = Self::sharing(walk) {
            vectorize!(instructions, simd => dense.settle(simd, shared));
        }
        let phase = &mut walk.phase;
        by!(phase, how => phase.settle_peaks(how));
    }

    /// Finds what follows from mode and memory.
    fn update_branch(&mut self, course: &WalkState<'a>) {
        let (mode, memory, s) = (course.block.mode, &course.slider.memory, self.x[0]);
        let normal_n = match self.ground.normal {
            Normal::Constant(normal_n) => normal_n,
            // The restraints of a law that is affine under any force do not ask for it.
            Normal::Varying(_) => 0.0,
        };
        let stick = &self.tables.stick;
        let contact = memory.contact;
        self.now = InForce { mode, contact, tables: stick, friction: 0.0, stop: 0.0, fading: None };
        match mode {
            Mode::Stick => {
                self.hold = self.law.hold(memory, s);
                if self.law.has_pads() {
                    self.now.stop = self.hold.force_n - stick.system.stiffness_n_per_m * s;
                }
            }
            Mode::Slip(direction) => {
                self.exits = self.law.exits(memory, direction);
                let force = self.law.force(memory, direction);
                let Affine { restraints, force_n, coefficient, fading } = force.affine(normal_n);
                let tables = self.tables.under(restraints);
                let (friction, stop) = (-coefficient, force_n);
                self.now = InForce { mode, contact, tables, friction, stop, fading };
            }
        }
        self.set_limits();
    }

    #[inline(always)]
    fn position_and_velocity(&self, _: usize) -> [f64; 2] {
        [self.x[0], self.x[1]]
    }

    #[inline(always)]
    fn records(&self) -> bool {
        self.recorder.is_some()
    }

    #[inline(never)]
    fn record_sample(&mut self, course: &WalkState<'a>, sample: usize, row: bool) {
        let normal = self.ground.normal_at(sample).max(0.0);
        let (table, a) = (self.ground.table[sample], self.ground.acceleration[sample]);
        self.record_knot(course, self.ground.times_s[sample], [table, a, normal], row);
    }

    fn record_between(
        &mut self,
        course: &WalkState<'a>,
        [time_s, table]: [f64; 2],
        (stretch, at_s): (&Stretch, f64),
        row: bool,
    ) {
        let (a, normal) = (stretch.acceleration_at(at_s), stretch.normal_at(at_s));
        self.record_knot(course, time_s, [table, a, normal], row);
    }
}

impl<'a> LinePhase<'a> for Modal<'a> {
    #[inline(always)]
    fn set_position_and_velocity(&mut self, _: usize, place: [f64; 2]) {
        [self.x[0], self.x[1]] = place;
    }

    /// `L` is what a unit of velocity of all floors is of the modes.
    fn apply_impulse(&mut self, change: f64) {
        let system = &self.tables.stick.system;
        let rates = &mut self.x[2 + system.modes()..];
        for (rate, l) in rates.iter_mut().zip(&system.participation) {
            *rate += l * change;
        }
    }

    fn state(&self) -> Vec<f64> {
        self.x.clone()
    }

    fn set_state(&mut self, state: &[f64]) {
        self.x.copy_from_slice(state);
    }

    #[inline(always)]
    fn required_friction_n(&mut self, hold: &Hold, [acceleration, _]: [f64; 2]) -> f64 {
        let (system, n) = (&self.tables.stick.system, self.modes);
        let (eta, rate) = (&self.x[2..2 + n], &self.x[2 + n..2 + 2 * n]);
        let f = &mut self.scratch[0];
        system.restoring(eta, rate, f);
        (system.block_mass_kg * acceleration + hold.force_n) - dot(&system.participation, f)
    }

    #[inline(always)]
    fn block_kg(&self) -> f64 {
        self.tables.stick.system.block_mass_kg
    }

    #[inline(always)]
    fn expand(&mut self, _: &WalkState<'a>, stretch: &Stretch, from_s: f64) -> Segment {
        self.expand_from(stretch, from_s);
        self.motion.segment
    }

    fn look_at_instant(&mut self, _: &WalkState<'a>, stretch: &Stretch, at_s: f64) {
        let fading_s = self.fading_s;
        swap(&mut self.motion, &mut self.instant);
        self.expand_from(stretch, at_s);
        swap(&mut self.motion, &mut self.instant);
        self.fading_s = fading_s;
    }

    #[inline(always)]
    fn segment(&self, of: Of) -> Segment {
        self.motion_of(of).segment
    }

    fn unit_s(&self) -> f64 {
        self.fading_s
    }

    fn set_unit_s(&mut self, unit_s: f64) {
        self.fading_s = unit_s;
    }

    #[inline(always)]
    fn displacement(&self) -> &Polynomial {
        &self.motion.displacement
    }

    #[inline(always)]
    fn velocity(&self, _: usize) -> &Polynomial {
        &self.motion.number
    }

    fn acceleration(&self, of: Of, _: usize) -> Polynomial {
        let motion = self.motion_of(of);
        derivative(&motion.number).map(|c| c / motion.segment.unit_s)
    }

    #[inline(always)]
    fn required_friction(&self, of: Of, _: usize) -> &Polynomial {
        &self.motion_of(of).number
    }

    #[inline(always)]
    fn normal(&self, of: Of, _: usize) -> [f64; 2] {
        self.motion_of(of).normal
    }

    #[inline(always)]
    fn hold(&self, _: &WalkState<'a>, _: usize) -> Hold {
        self.hold
    }

    /// The terms are `M1 a`, friction, springs and stop, and the structure's pull, which is no more than what it
    /// balances.
    fn rounding_m_per_s2(&self, _: &WalkState<'a>, of: Of, _: usize) -> f64 {
        let InForce { mode, tables, friction, stop, .. } = self.now;
        let motion = self.motion_of(of);
        let (mass_kg, Motion { number, load, segment, .. }) = (self.block_kg(), motion);
        let Segment { unit_s, part, .. } = *segment;
        let a = load.acceleration.abs() + part * load.acceleration_change.abs();
        let normal_n = motion.normal[0].abs() + part * motion.normal[1].abs();
        let springs_n = tables.system.stiffness_n_per_m * self.x[0].abs() + stop.abs();
        let own_n = match mode {
            Mode::Stick => number[0].abs() + part * number[1].abs() + self.hold.largest_n(normal_n),
            Mode::Slip(_) => mass_kg * (number[1].abs() / unit_s) + friction.abs() * normal_n,
        };
        let balanced_n = mass_kg * a + springs_n + own_n;
        let pull_n = balanced_n.max(self.peaks.attained(output::BASE_SHEAR));
        ROUNDING * (a + (balanced_n + pull_n) / mass_kg)
    }

    fn peak_velocity(&self, _: usize) -> f64 {
        self.peaks.attained(output::VELOCITY)
    }

    #[inline(always)]
    fn move_to(&mut self, part: f64) {
        by!(self, how => self.move_motion(how, part));
    }

    #[inline(always)]
    fn look(&mut self, course: &mut WalkState<'a>, stretch: &Stretch, segment: &Segment) {
        if self.law.has_pads() {
            self.look_at_stop(course, segment.part);
        }
        by!(self, how => self.look_at_outputs(how, stretch, segment));
    }
}
