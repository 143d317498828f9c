//! Runs ahead of event stepping: evenly spaced samples eight at a time, as far as a bound shows that nothing
//! happens in them. The first sample that this leaves open is handed back by returning.
//!
//! Within a sample a number departs from the chord between its values at both ends by no more than
//! `h²/8` times the bound on its second derivative that [`Number`] names. Where that may exceed the
//! peak attained so far the sample is kept as a candidate, which is settled by its series.

use fearless_simd::f64x8;
use fearless_simd::prelude::*;

use super::super::chords::bound_between;
use super::super::course::WalkState;
use super::super::ground::Normal;
use super::super::phase::{LinePhase, Phase};
use super::super::walk::Walk;
use super::Direct;
use super::affine::{Affine, Configuration, Nine, Number};
use crate::linear::lanes::{eight, larger, largest_lane};
use crate::linear::{BATCH, Force, Window};
use crate::numerics::instructions::vectorize;
use crate::response::{Mode, output};
use crate::slider::{Contact, Hold};

/// Candidates that are kept before they are settled.
const CANDIDATES: usize = 512;

/// What running ahead keeps from one stretch of samples to the next.
#[derive(Default)]
pub(super) struct Ahead {
    pub(super) configurations: Vec<Configuration>,
    candidates: Vec<Candidate>,
    /// The states of candidates, one after another.
    candidate_states: Vec<f64>,
    /// The state at the first sample of a batch, padded.
    x: Vec<f64>,
    /// Components of the state and outputs at the samples of a batch.
    states: Vec<Nine>,
    outputs: Vec<Nine>,
    margins: Vec<Margin>,
}

/// What holds while nothing happens.
enum Margin {
    /// `factor × output + constant` is positive.
    Output { output: usize, factor: f64, constant: f64 },
    /// `factor × s + constant` is positive; `s` is monotone while the block slides: its value at a sample speaks for all
    /// before.
    Level { factor: f64, constant: f64 },
    /// What a stuck interface is asked for is between what holds it at the samples of a batch.
    Held { interface: usize, output: usize, between: [Nine; 2] },
}

/// A sample in which an output may have its peak.
#[derive(Clone, Copy)]
struct Candidate {
    sample: usize,
    configuration: usize,
    output: usize,
    bound: f64,
    /// Place of the state at its start.
    state: usize,
}

/// The first sample between two that is left open.
pub(super) fn run_ahead<'a>(walk: &mut Walk<'a, Direct<'a>>, [sample, end]: [usize; 2]) -> usize {
    if sample + BATCH > end || !may_run_ahead(walk) {
        return sample;
    }
    let Some(configuration) = walk.phase.configuration(&walk.course) else { return sample };
    let instructions = walk.phase.instructions;
    let reached =
        vectorize!(instructions, simd => in_mode(walk, simd, configuration, [sample, end]));
    if walk.phase.ahead.candidates.len() > CANDIDATES {
        walk.phase.settle_candidates(&mut walk.course);
    }
    reached
}

/// Goes ahead by batches in one configuration; the sample reached.
#[inline(always)]
fn in_mode<'a, S: Simd>(
    walk: &mut Walk<'a, Direct<'a>>,
    simd: S,
    configuration: usize,
    samples: [usize; 2],
) -> usize {
    let mut ahead = core::mem::take(&mut walk.phase.ahead);
    let configurations = core::mem::take(&mut ahead.configurations);
    let mut reached = samples[0];
    if let Some(affine) = &configurations[configuration].affine {
        reached = batches(walk, simd, &mut ahead, (affine, configuration), samples);
    }
    ahead.configurations = configurations;
    walk.phase.ahead = ahead;
    reached
}

/// Whether nothing waits to be decided, and the block is at no stop.
fn may_run_ahead<'a>(walk: &Walk<'a, Direct<'a>>) -> bool {
    let (phase, course) = (&walk.phase, &walk.course);
    let is_at_stop =
        course.near.is_some() || matches!(course.slider.memory.contact, Contact::Pressed(_));
    walk.is_settled()
        && !is_at_stop
        && (0..course.interfaces()).all(|i| match course.mode(i) {
            Mode::Slip(direction) => direction.sign() * phase.position_and_velocity(i)[1] > 0.0,
            Mode::Stick => phase.hold(course, i).bears_on_stop == [false; 2],
        })
}

/// Takes samples up to `end`; the first that is left open.
#[inline(always)]
fn batches<'a, S: Simd>(
    walk: &mut Walk<'a, Direct<'a>>,
    simd: S,
    ahead: &mut Ahead,
    (affine, configuration): (&Affine, usize),
    [mut sample, end]: [usize; 2],
) -> usize {
    let (phase, course) = (&mut walk.phase, &walk.course);
    let mut margins = core::mem::take(&mut ahead.margins);
    if phase.find_margins(course, &mut margins) {
        let count = phase.x.count();
        ahead.x.resize(count.next_multiple_of(4), 0.0);
        phase.x.get(&mut ahead.x);
        ahead.states.clear();
        ahead.states.extend(ahead.x.iter().map(|x| [*x; BATCH + 1]));
        let a = phase.ground.acceleration[sample];
        ahead.outputs.clear();
        let start = affine.outputs.iter().map(|y| [y.at(&ahead.x, a); BATCH + 1]);
        ahead.outputs.extend(start);
        phase.add_of_varying_normal(course, &mut ahead.outputs[output::FRICTION][..1], sample);
        let (first, varies) = (sample, matches!(phase.ground.normal, Normal::Varying(_)));
        while sample + BATCH <= end && walk.pulse.tick(walk.units).is_ok() {
            if varies || sample == first {
                phase.find_bounds(course, &mut margins, sample);
            }
            let steps = phase.batch(simd, course, ahead, (affine, configuration), &margins, sample);
            sample += steps;
            if steps < BATCH {
                break;
            }
        }
        phase.x.set(&ahead.x[..count]);
    }
    ahead.margins = margins;
    sample
}

impl<'a> Direct<'a> {
    /// Between what a stuck interface is held under a normal force on the slider, in the unit of the output that says
    /// what it is asked for.
    fn held_between(&self, hold: &Hold, interface: usize, normal_n: f64) -> [f64; 2] {
        if interface == 0 {
            return hold.holds_n(normal_n);
        }
        let slope = self.peaks.slope_m_per_s2;
        hold.holds_n(normal_n / self.body.total_kg).map(|bound| bound - slope)
    }

    /// What must hold in the present modes, its bounds still to be found; false where that is more than values of the
    /// outputs.
    fn find_margins(&self, course: &WalkState<'a>, margins: &mut Vec<Margin>) -> bool {
        margins.clear();
        for (interface, mode) in self.modes.iter().enumerate() {
            margins.push(match mode {
                Mode::Slip(direction) => Margin::Output {
                    output: self.velocity_output(interface),
                    factor: direction.sign(),
                    constant: 0.0,
                },
                Mode::Stick => {
                    let of_contents = |i| self.contents_acceleration_output(i);
                    let output = interface.checked_sub(1).map_or(output::FRICTION, of_contents);
                    Margin::Held { interface, output, between: [[0.0; BATCH + 1]; 2] }
                }
            });
        }
        if let Mode::Slip(direction) = self.modes[0] {
            let (law, memory) = (course.slider.law, &course.slider.memory);
            for exit in law.exits(memory, direction).into_iter().flatten() {
                let constant = exit.constant;
                margins.push(match [exit.of_s, exit.of_w] {
                    [factor, 0.0] => Margin::Level { factor, constant },
                    [0.0, factor] => Margin::Output { output: output::VELOCITY, factor, constant },
                    _ => return false,
                });
            }
        }
        true
    }

    /// Finds the bounds of what sticks over the batch from a sample. Between two samples they are no nearer than their
    /// chord: friction grows with the normal force, or with a power of it below one.
    fn find_bounds(&self, course: &WalkState<'a>, margins: &mut [Margin], sample: usize) {
        for margin in margins {
            let Margin::Held { interface, between: [low, high], .. } = margin else { continue };
            let hold = self.hold(course, *interface);
            let bounds = |normal_n: f64| self.held_between(&hold, *interface, normal_n);
            match self.ground.normal {
                Normal::Constant(normal_n) => {
                    [*low, *high] = bounds(normal_n).map(|bound| [bound; BATCH + 1]);
                }
                Normal::Varying(normal_n) => {
                    for (k, normal_n) in normal_n[sample..].iter().take(BATCH + 1).enumerate() {
                        [low[k], high[k]] = bounds(normal_n.max(0.0));
                    }
                }
            }
        }
    }

    /// Adds to what friction is asked for at samples what a normal force that varies asks of it at rest: their configuration
    /// knows of none.
    fn add_of_varying_normal(&self, course: &WalkState<'a>, friction_n: &mut [f64], sample: usize) {
        let Normal::Varying(normal_n) = self.ground.normal else { return };
        let of_normal = self.hold(course, 0).of_normal;
        for (friction_n, normal_n) in friction_n.iter_mut().zip(&normal_n[sample..]) {
            *friction_n += of_normal * normal_n;
        }
    }

    /// Takes the samples of a batch up to the first that is left open; how many.
    #[inline(always)]
    fn batch<S: Simd>(
        &mut self,
        simd: S,
        course: &WalkState<'a>,
        ahead: &mut Ahead,
        (affine, configuration): (&Affine, usize),
        margins: &[Margin],
        sample: usize,
    ) -> usize {
        let Some(a) = self.ground.acceleration[sample..].first_chunk::<{ BATCH + 1 }>() else {
            return 0;
        };
        for (i, row) in &affine.moving {
            let values = row.values(simd, &ahead.x, a, Force::Constant(1.0));
            values.store_slice(&mut ahead.states[*i][1..]);
        }
        for (number, y) in affine.outputs.iter().zip(&mut ahead.outputs) {
            number.values(simd, &ahead.states, (a, 1), eight(simd, 0.0)).store_slice(&mut y[1..]);
        }
        let friction_n = &mut ahead.outputs[output::FRICTION][1..];
        self.add_of_varying_normal(course, friction_n, sample + 1);
        let departure = Departure::new(simd, affine, &ahead.states, a);
        let mut clear = u64::MAX;
        for margin in margins {
            clear &= match margin {
                Margin::Output { output, factor, constant } => {
                    let slack = departure.of(simd, &affine.outputs[*output]);
                    let slack = slack * eight(simd, factor.abs()) - eight(simd, *constant);
                    let [first, last] = both_ends(simd, &ahead.outputs[*output]);
                    let factor = eight(simd, *factor);
                    let [first, last] = [first * factor, last * factor];
                    (first.simd_gt(slack) & last.simd_gt(slack)).to_bitmask()
                }
                Margin::Level { factor, constant } => {
                    let s = f64x8::from_slice(simd, &ahead.states[0][1..]);
                    let value = s * eight(simd, *factor) + eight(simd, *constant);
                    value.simd_gt(eight(simd, 0.0)).to_bitmask()
                }
                Margin::Held { output, between, .. } => {
                    let slack = departure.of(simd, &affine.outputs[*output]);
                    let asked = both_ends(simd, &ahead.outputs[*output]);
                    let [low, high] = between.each_ref().map(|bound| both_ends(simd, bound));
                    let is_held = |end: usize| {
                        asked[end].simd_gt(slack + low[end])
                            & (-asked[end]).simd_gt(slack - high[end])
                    };
                    (is_held(0) & is_held(1)).to_bitmask()
                }
            };
        }
        let steps = ((!clear).trailing_zeros() as usize).min(BATCH);
        if steps == 0 {
            return 0;
        }
        self.weigh(simd, ahead, (affine, configuration), (sample, steps), &departure);
        self.store_samples(course, sample..sample + steps, [&ahead.states, &ahead.outputs]);
        for list in [&mut ahead.states, &mut ahead.outputs] {
            list.iter_mut().for_each(|nine| nine[0] = nine[steps]);
        }
        for (i, _) in &affine.moving {
            ahead.x[*i] = ahead.states[*i][0];
        }
        steps
    }

    /// Looks at the outputs over samples, and keeps those as candidates that may hold a peak.
    #[inline(always)]
    fn weigh<S: Simd>(
        &mut self,
        simd: S,
        ahead: &mut Ahead,
        (affine, configuration): (&Affine, usize),
        (sample, steps): (usize, usize),
        departure: &Departure<S>,
    ) {
        let taken = u64::MAX >> (64 - steps);
        let mut kept = [None; BATCH];
        let count = self.peaks.values.len();
        for (j, number) in affine.outputs[..count].iter().enumerate() {
            let y = &mut ahead.outputs[j];
            // Samples that are not taken do not count.
            let end = y[steps];
            y[steps + 1..].fill(end);
            let [first, last] = both_ends(simd, y);
            let slack = departure.of(simd, number);
            let attained = larger(first.abs(), last.abs());
            let peak = &mut self.peaks.values[j];
            let limit = eight(simd, *peak);
            if (attained + slack).simd_le(limit).all_true() {
                continue;
            }
            *peak = peak.max(largest_lane(simd, attained));
            let bound = bound_between(simd, [first, last], slack);
            // A few ulp are no more than the rounding of the values.
            let open = bound.simd_gt(eight(simd, *peak * (1.0 + 1e-15)));
            let (mut open, bound) = (open.to_bitmask() & taken, bound.to_array());
            while open != 0 {
                let k = open.trailing_zeros() as usize;
                open &= open - 1;
                let state = *kept[k].get_or_insert_with(|| {
                    let place = ahead.candidate_states.len();
                    ahead.candidate_states.extend(ahead.states.iter().map(|x| x[k]));
                    place
                });
                let (sample, bound) = (sample + k, bound[k]);
                let kept = Candidate { sample, configuration, output: j, bound, state };
                ahead.candidates.push(kept);
            }
        }
    }

    /// Settles the candidates that are still in question, those that promise most first.
    pub(super) fn settle_candidates(&mut self, course: &mut WalkState<'a>) {
        let mut candidates = core::mem::take(&mut self.ahead.candidates);
        let states = core::mem::take(&mut self.ahead.candidate_states);
        let peaks = &self.peaks.values;
        candidates.retain(|c| c.bound > peaks[c.output]);
        let promise = |c: &Candidate| c.bound / peaks[c.output];
        candidates.sort_by(|a, b| promise(b).total_cmp(&promise(a)));
        for candidate in &candidates {
            if candidate.bound > self.peaks.values[candidate.output] {
                self.settle_candidate(course, candidate, &states);
            }
        }
        candidates.clear();
        self.ahead.candidates = candidates;
        self.ahead.candidate_states = states;
        self.ahead.candidate_states.clear();
    }

    /// Looks for peaks in the sample of a candidate by its series.
    fn settle_candidate(
        &mut self,
        course: &mut WalkState<'a>,
        candidate: &Candidate,
        states: &[f64],
    ) {
        let here = (self.x.clone(), self.modes.clone(), course.slider.memory.clone());
        let near = course.near.take();
        let configuration = &self.ahead.configurations[candidate.configuration];
        course.slider.memory.clone_from(&configuration.memory);
        course.set_modes(&configuration.modes);
        self.x.set(&states[candidate.state..][..self.x.count()]);
        self.update_branch(course);
        let sample = candidate.sample;
        let to_s = self.ground.times_s[sample + 1] - self.ground.times_s[sample];
        let stretch = self.ground.stretch(sample, 0.0, to_s);
        let mut at_s = 0.0;
        while at_s < to_s {
            let segment = self.expand(course, &stretch, at_s);
            self.move_to(segment.part);
            self.look(course, &stretch, &segment);
            at_s = segment.to_s;
        }
        let modes;
        (self.x, modes, course.slider.memory) = here;
        course.set_modes(&modes);
        course.near = near;
        self.update_branch(course);
    }
}

/// The ends of eight intervals.
#[inline(always)]
fn both_ends<S: Simd>(simd: S, list: &Nine) -> [f64x8<S>; 2] {
    [f64x8::from_slice(simd, &list[..BATCH]), f64x8::from_slice(simd, &list[1..])]
}

/// How far numbers depart from the chords over eight samples.
struct Departure<S: Simd> {
    /// `‖ẍ‖` and `|ȧ|`, times `h²/8`.
    second: f64x8<S>,
    jerk: f64x8<S>,
}

impl<S: Simd> Departure<S> {
    #[inline(always)]
    fn new(simd: S, affine: &Affine, states: &[Nine], a: &Window) -> Self {
        let [first, last] = both_ends(simd, a);
        let jerk = (last - first) * eight(simd, 1.0 / affine.dt_s);
        let mut square = eight(simd, 0.0);
        for number in &affine.second {
            let value = number.values(simd, states, (a, 0), jerk);
            square += value * value;
        }
        let reach = 0.125 * affine.dt_s * affine.dt_s;
        Self {
            second: square.sqrt() * eight(simd, affine.growth * reach),
            jerk: jerk.abs() * eight(simd, reach),
        }
    }

    #[inline(always)]
    fn of(&self, simd: S, number: &Number) -> f64x8<S> {
        eight(simd, number.norm) * self.second + eight(simd, number.of_jerk) * self.jerk
    }
}
