//! Peaks of the outputs: what has been attained, and candidates for more.

use fearless_simd::prelude::*;
use fearless_simd::{f64x4, f64x8};

use super::ahead::Ahead;
use super::event::Segment;
use super::lanes::{Eight, Four, combine4, combine8, eight, four, greatest, larger};
use super::series::{Series, Span};
use crate::linear::polynomial::{ZERO, largest};
use crate::response::Mode;
use crate::response::output;

/// Candidates that are kept before they are settled.
const CANDIDATES: usize = 16;

/// Some whole samples of one phase.
#[derive(Clone, Copy, Debug)]
pub(super) struct Samples {
    pub(super) sample: usize,
    pub(super) steps: usize,
    pub(super) mode: Mode,
    /// State at their start.
    pub(super) x: [f64; 4],
}

#[derive(Clone, Copy, Debug)]
enum Place {
    /// With the slack of the outputs over one of them.
    Samples(Samples, Eight),
    Segment(Segment),
}

/// A place that may hold a peak.
#[derive(Clone, Copy, Debug)]
pub(in crate::solver) struct Candidate {
    place: Place,
    /// Upper bounds on the outputs; zero where it cannot hold a peak.
    above: Eight,
}

impl<S: Simd> Ahead<'_, '_, S> {
    /// Looks for peaks of the outputs whose bits are open in whole samples, over each of which the gates
    /// have a slack.
    #[inline(never)]
    pub(super) fn look_over<const SLIP: bool>(
        &mut self,
        samples: &Samples,
        mut open: u64,
        slack: f64x4<S>,
    ) {
        let simd = self.simd;
        simd.vectorize(
            #[inline(always)]
            || {
                let Samples { sample, steps, mode, x } = *samples;
                let (a, phase, force_n) =
                    (self.window(sample), self.phase::<SLIP>(), self.force_n(mode));
                let rows = &phase.rows;
                let mut state = [eight(simd, x[0]); 4];
                if SLIP {
                    state[0] = self.row::<SLIP>(&rows[0], x, a, force_n);
                    state[1] = self.row::<SLIP>(&rows[1], x, a, force_n);
                } else {
                    state[1] = eight(simd, 0.0);
                }
                state[2] = self.row::<SLIP>(&rows[2], x, a, force_n);
                state[3] = self.row::<SLIP>(&rows[4], x, a, force_n);
                let of = &phase.outputs;
                let (mut input, mut inputs) = (force_n, eight(simd, force_n));
                if !SLIP {
                    (input, inputs) = (a[0], f64x8::from_slice(simd, &a[1..]));
                }
                let first = of.at(simd, x, input).abs().to_array();
                let slack = combine8(simd, &of.of_gates, slack.to_array()).to_array();
                let (mut peak, mut above) = (self.peak.to_array(), [0.0; 8]);
                let all = (1_u64 << steps) - 1;
                while open != 0 {
                    let j = open.trailing_zeros() as usize;
                    open &= open - 1;
                    let c = of.columns.each_ref().map(|column| column.0[j]);
                    let of_state = (state[0] * eight(simd, c[0]) + state[1] * eight(simd, c[1]))
                        + (state[2] * eight(simd, c[2]) + state[3] * eight(simd, c[3]));
                    let of_input =
                        inputs * eight(simd, of.of_input.0[j]) + eight(simd, of.constant.0[j]);
                    let sizes = (of_state + of_input).abs();
                    let limit = peak[j] - slack[j];
                    let passes = sizes.simd_gt(eight(simd, limit)).to_bitmask() & all;
                    if passes == 0 && first[j] <= limit {
                        continue;
                    }
                    let mut attained = first[j];
                    for size in &sizes.to_array()[..steps] {
                        attained = greatest(attained, *size);
                    }
                    peak[j] = greatest(peak[j], attained);
                    above[j] = attained + slack[j];
                }
                self.peak = f64x8::load_array(simd, peak);
                self.set_limits();
                let above = Eight(above);
                if above.load(simd).simd_gt(self.peak).any_true() {
                    self.keep(Candidate { place: Place::Samples(*samples, Eight(slack)), above });
                }
            },
        );
    }

    /// Looks for peaks in the first part `t` of a segment, which ends in the state `end`.
    #[inline(always)]
    pub(super) fn look<const SLIP: bool>(
        &mut self,
        segment: &Segment,
        series: &Series<S>,
        end: f64x4<S>,
        t: f64,
        friction_n: [f64; 2],
    ) {
        let (simd, storey) = (self.simd, &self.of.tables.storey);
        let Span { a, change, .. } = segment.span;
        let input = if SLIP { friction_n } else { [a, a + change * t] };
        let slack = self.slack::<SLIP>(series, t);
        let first = self.gates::<SLIP>(Four(segment.x).load(simd), input[0]);
        let last = self.gates::<SLIP>(end, input[1]);
        let quiet = (self.within(first, slack) & self.within(last, slack)).all_true();
        let [s, end_s] = [segment.x[0], end.as_array()[0]];
        let slider_n = [
            friction_n[0] - storey.stiffness_n_per_m * s,
            friction_n[1] - storey.stiffness_n_per_m * end_s,
        ];
        let friction = greatest(friction_n[0].abs(), friction_n[1].abs());
        let slider = greatest(slider_n[0].abs(), slider_n[1].abs());
        let stays = if SLIP {
            let peak = self.peak.as_array();
            friction <= peak[output::FRICTION] && slider <= peak[output::SLIDER]
        } else {
            let hidden = storey.participation * slack.as_array()[2];
            friction + hidden <= self.most_friction && slider + hidden <= self.most_slider
        };
        if !(quiet && stays) || self.several {
            self.look_at_outputs::<SLIP>(segment, end.to_array(), t, input, slack.to_array());
        }
    }

    /// How far the gates depart from the chord over the first part `t` of a segment at most.
    #[inline(always)]
    fn slack<const SLIP: bool>(&self, series: &Series<S>, t: f64) -> f64x4<S> {
        let sizes = &self.phase::<SLIP>().gates.sizes;
        combine4(self.simd, sizes, series.curvature) * four(self.simd, 0.125 * (t * t))
    }

    /// The same for all outputs.
    #[inline(never)]
    fn look_at_outputs<const SLIP: bool>(
        &mut self,
        segment: &Segment,
        end: [f64; 4],
        t: f64,
        input: [f64; 2],
        slack: [f64; 4],
    ) {
        let simd = self.simd;
        simd.vectorize(
            #[inline(always)]
            || {
                let of = &self.phase::<SLIP>().outputs;
                let (first, last) = (of.at(simd, segment.x, input[0]), of.at(simd, end, input[1]));
                let slack = combine8(simd, &of.of_gates, slack);
                let attained = larger(first.abs(), last.abs());
                if (attained + slack).simd_le(self.peak).all_true() {
                    return;
                }
                self.peak = larger(self.peak, attained);
                self.set_limits();
                // A parabola of that curvature between ends d apart rises above the higher one by
                // (slack − d/4)²/slack, and not at all where d ≥ 4 slack.
                let zero = eight(simd, 0.0);
                let inside = slack - (last - first).abs() * eight(simd, 0.25);
                let rise = inside.simd_gt(zero).select(inside * (inside / slack), zero);
                // A few ulp are no more than the rounding of the ends.
                let above = attained + rise;
                let rounding = self.peak * eight(simd, 1e-15);
                if above.simd_gt(self.peak + rounding).any_true() {
                    let mut segment = *segment;
                    segment.span.rest = t;
                    let above = Eight(above.to_array());
                    self.keep(Candidate { place: Place::Segment(segment), above });
                }
            },
        );
    }

    #[inline(never)]
    fn keep(&mut self, candidate: Candidate) {
        if self.shared.candidates.len() == CANDIDATES {
            self.drop_overtaken();
            if self.shared.candidates.len() > CANDIDATES / 2 {
                self.settle();
            }
        }
        self.shared.candidates.push(candidate);
    }

    fn drop_overtaken(&mut self) {
        let peak = self.peak.to_array();
        let may = |c: &Candidate| c.above.0.iter().zip(&peak).any(|(above, peak)| above > peak);
        self.shared.candidates.retain(may);
    }

    /// Settles all candidates.
    #[inline(never)]
    pub(super) fn settle(&mut self) {
        let simd = self.simd;
        simd.vectorize(
            #[inline(always)]
            || {
                self.drop_overtaken();
                for i in 0..self.shared.candidates.len() {
                    let Candidate { place, above } = self.shared.candidates[i];
                    if above.load(simd).simd_le(self.peak).all_true() {
                        continue;
                    }
                    match place {
                        Place::Segment(segment) if segment.mode == Mode::Stick => {
                            self.settle_segment::<false>(&segment);
                        }
                        Place::Segment(segment) => {
                            self.settle_segment::<true>(&segment);
                        }
                        Place::Samples(samples, slack) if samples.mode == Mode::Stick => {
                            self.settle_samples::<false>(&samples, &slack);
                        }
                        Place::Samples(samples, slack) => {
                            self.settle_samples::<true>(&samples, &slack);
                        }
                    }
                }
                self.shared.candidates.clear();
            },
        );
    }

    /// Settles those of some samples that may hold a peak.
    #[inline(always)]
    fn settle_samples<const SLIP: bool>(&mut self, samples: &Samples, slack: &Eight) {
        let (simd, pieces) = (self.simd, self.of.tables.pieces);
        let Samples { sample, steps, mode, x: first_x } = *samples;
        let (a, force_n, of) =
            (self.window(sample), self.force_n(mode), &self.phase::<SLIP>().outputs);
        let (x, slack) = (Four(first_x).load(simd), slack.load(simd));
        let mut start = first_x;
        let mut first = of.at(simd, start, if SLIP { force_n } else { a[0] });
        for k in 0..steps {
            let end = self.after::<SLIP>(k + 1, x, a, force_n).to_array();
            let last = of.at(simd, end, if SLIP { force_n } else { a[k + 1] });
            if (larger(first.abs(), last.abs()) + slack).simd_gt(self.peak).any_true() {
                let change = (a[k + 1] - a[k]) / pieces as f64;
                let mut x = start;
                for piece in 0..pieces {
                    let span = Span { rest: 1.0, a: a[k] + change * piece as f64, change };
                    x = self.settle_segment::<SLIP>(&Segment { sample: sample + k, span, mode, x });
                }
            }
            (start, first) = (end, last);
        }
    }

    /// Settles a segment by the Taylor polynomials of what may hold a peak; the state at its end.
    #[inline(always)]
    fn settle_segment<const SLIP: bool>(&mut self, segment: &Segment) -> [f64; 4] {
        let (simd, phase) = (self.simd, self.phase::<SLIP>());
        let (Span { rest, a, change }, of) = (segment.span, &phase.outputs);
        let force_n = self.force_n(segment.mode);
        let series = Series::new::<SLIP>(simd, &phase.series, segment.x, &segment.span, force_n);
        let end = series.at(rest).to_array();
        let input = if SLIP { [force_n; 2] } else { [a, a + change * rest] };
        let (first, last) = (of.at(simd, segment.x, input[0]), of.at(simd, end, input[1]));
        let slack = combine8(simd, &of.of_gates, self.slack::<SLIP>(&series, rest).to_array());
        // A peak on the upper side, and on the lower one.
        let upper = (larger(first, last) + slack).simd_gt(self.peak).to_bitmask();
        let lower = (larger(-first, -last) + slack).simd_gt(self.peak).to_bitmask();
        let mut open = upper | lower;
        self.peak = larger(self.peak, larger(first.abs(), last.abs()));
        let (mut peak, first) = (self.peak.to_array(), first.to_array());
        while open != 0 {
            let j = open.trailing_zeros() as usize;
            open &= open - 1;
            let mut p = ZERO;
            p[0] = first[j];
            let c = of.columns.each_ref().map(|column| column.0[j]);
            let mut power = 1.0;
            for (k, x) in series.coefficients().iter().enumerate() {
                power *= rest;
                let of_state = (c[0] * x[0] + c[1] * x[1]) + (c[2] * x[2] + c[3] * x[3]);
                let of_input = if SLIP || k > 0 { 0.0 } else { of.of_input.0[j] * change };
                p[k + 1] = (of_state + of_input) * power;
            }
            if upper >> j & 1 != 0 {
                peak[j] = largest(&p, 1.0, peak[j]);
            }
            if lower >> j & 1 != 0 {
                peak[j] = largest(&p.map(|c| -c), 1.0, peak[j]);
            }
        }
        self.peak = f64x8::load_array(simd, peak);
        self.set_limits();
        end
    }
}
