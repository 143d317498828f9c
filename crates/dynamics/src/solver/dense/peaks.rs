//! Peaks of the outputs: what has been attained, and candidates for more.

use fearless_simd::prelude::*;
use fearless_simd::{f64x4, f64x8};

use super::ahead::Ahead;
use super::event::Segment;
use super::lanes::{Abreast, Eight, Four, eight, greatest};
use super::outputs::{Kept, REGISTERS, above, by_register, each, kept, larger_sizes, loaded, plus};
use super::series::{Span, StoreySeries};
use crate::linear::polynomial::{ZERO, raise_to_size};
use crate::response::Mode;
use crate::response::output;
use crate::solver::chords::bound_between;

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
    Samples(Samples, Kept),
    Segment(Segment),
}

/// A place that may hold a peak.
#[derive(Clone, Copy, Debug)]
pub(in crate::solver) struct Candidate {
    place: Place,
    /// Upper bounds on the outputs; zero where it cannot hold a peak.
    above: Kept,
}

impl<S: Simd> Ahead<'_, '_, S> {
    /// Looks for peaks of the outputs whose bits are open in whole samples, over each of which the gates
    /// have a slack.
    #[inline(never)]
    pub(super) fn look_over<const SLIP: bool>(
        &mut self,
        samples: &Samples,
        mut open: u64,
        slack: Abreast<S>,
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
                let first = each(&kept(of.at(simd, x, input)));
                let kept_slack = kept(of.slack(simd, slack.to_array()));
                let slack = each(&kept_slack);
                let (mut peak, mut bounds) = (kept(self.peak), [Eight::ZERO; REGISTERS]);
                let all = (1_u64 << steps) - 1;
                while open != 0 {
                    let j = open.trailing_zeros() as usize;
                    open &= open - 1;
                    let (g, lane) = (j / 8, j % 8);
                    let c = of.columns.each_ref().map(|column| column[g].0[lane]);
                    let of_state = (state[0] * eight(simd, c[0]) + state[1] * eight(simd, c[1]))
                        + (state[2] * eight(simd, c[2]) + state[3] * eight(simd, c[3]));
                    let of_input = inputs * eight(simd, of.of_input[g].0[lane])
                        + eight(simd, of.constant[g].0[lane]);
                    let sizes = (of_state + of_input).abs();
                    let peak = &mut peak[g].0[lane];
                    let limit = *peak - slack[j];
                    let passes = sizes.simd_gt(eight(simd, limit)).to_bitmask() & all;
                    let mut attained = first[j].abs();
                    if passes == 0 && attained <= limit {
                        continue;
                    }
                    for size in &sizes.to_array()[..steps] {
                        attained = greatest(attained, *size);
                    }
                    *peak = greatest(*peak, attained);
                    bounds[g].0[lane] = attained + slack[j];
                }
                self.peak = loaded(simd, &peak);
                self.set_limits();
                if above(loaded(simd, &bounds), self.peak) != 0 {
                    let place = Place::Samples(*samples, kept_slack);
                    self.keep(Candidate { place, above: bounds });
                }
            },
        );
    }

    /// Looks for peaks in the first part `t` of a segment, which ends in the state `end`.
    #[inline(always)]
    pub(super) fn look<const SLIP: bool>(
        &mut self,
        segment: &Segment,
        series: &StoreySeries<S>,
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
        let quiet = self.are_within(first, slack) && self.are_within(last, slack);
        let [s, end_s] = [segment.x[0], end.as_array()[0]];
        let slider_n = [
            friction_n[0] - storey.stiffness_n_per_m * s,
            friction_n[1] - storey.stiffness_n_per_m * end_s,
        ];
        let friction = greatest(friction_n[0].abs(), friction_n[1].abs());
        let slider = greatest(slider_n[0].abs(), slider_n[1].abs());
        let stays = if SLIP {
            let peak = self.peak[0].as_array();
            friction <= peak[output::FRICTION] && slider <= peak[output::SLIDER]
        } else {
            let hidden = storey.participation * slack.four.as_array()[2];
            friction + hidden <= self.most_friction && slider + hidden <= self.most_slider
        };
        if !(quiet && stays) || self.several {
            self.look_at_outputs::<SLIP>(segment, end.to_array(), t, input, slack.to_array());
        }
    }

    /// How far the gates depart from the chord over the first part `t` of a segment at most.
    #[inline(always)]
    fn slack<const SLIP: bool>(&self, series: &StoreySeries<S>, t: f64) -> Abreast<S> {
        let gates = &self.phase::<SLIP>().gates;
        gates.of_sizes(self.simd, series.curvature).times(self.simd, 0.125 * (t * t))
    }

    /// Looks for peaks of all outputs in the first part `t` of a segment.
    #[inline(never)]
    fn look_at_outputs<const SLIP: bool>(
        &mut self,
        segment: &Segment,
        end: [f64; 4],
        t: f64,
        input: [f64; 2],
        slack: [f64; 5],
    ) {
        let simd = self.simd;
        simd.vectorize(
            #[inline(always)]
            || {
                let of = &self.phase::<SLIP>().outputs;
                let (first, last) = (of.at(simd, segment.x, input[0]), of.at(simd, end, input[1]));
                let slack = of.slack(simd, slack);
                let attained = larger_sizes(first, last);
                let bound = plus(attained, slack);
                if above(bound, self.peak) == 0 {
                    return;
                }
                self.peak = larger_sizes(self.peak, attained);
                self.set_limits();
                let bound = by_register(
                    #[inline(always)]
                    |g| bound_between(simd, [first[g], last[g]], slack[g]),
                );
                // A few ulp are no more than the rounding of the ends.
                let most = by_register(
                    #[inline(always)]
                    |g| self.peak[g] + self.peak[g] * eight(simd, 1e-15),
                );
                if above(bound, most) != 0 {
                    let mut segment = *segment;
                    segment.span.rest = t;
                    self.keep(Candidate { place: Place::Segment(segment), above: kept(bound) });
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
        let (simd, peak) = (self.simd, self.peak);
        self.shared.candidates.retain(|c| above(loaded(simd, &c.above), peak) != 0);
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
                    let Candidate { place, above: bound } = self.shared.candidates[i];
                    if above(loaded(simd, &bound), self.peak) == 0 {
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
    fn settle_samples<const SLIP: bool>(&mut self, samples: &Samples, slack: &Kept) {
        let (simd, pieces) = (self.simd, self.of.tables.pieces);
        let Samples { sample, steps, mode, x: first_x } = *samples;
        let (a, force_n, of) =
            (self.window(sample), self.force_n(mode), &self.phase::<SLIP>().outputs);
        let (x, slack) = (Four(first_x).load(simd), loaded(simd, slack));
        let mut start = first_x;
        let mut first = of.at(simd, start, if SLIP { force_n } else { a[0] });
        for k in 0..steps {
            let end = self.after::<SLIP>(k + 1, x, a, force_n).to_array();
            let last = of.at(simd, end, if SLIP { force_n } else { a[k + 1] });
            let attained = larger_sizes(first, last);
            if above(plus(attained, slack), self.peak) != 0 {
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
        let series =
            StoreySeries::new::<SLIP>(simd, &phase.series, segment.x, &segment.span, force_n);
        let end = series.at(rest).to_array();
        let input = if SLIP { [force_n; 2] } else { [a, a + change * rest] };
        let (first, last) = (of.at(simd, segment.x, input[0]), of.at(simd, end, input[1]));
        let slack = of.slack(simd, self.slack::<SLIP>(&series, rest).to_array());
        let sizes = larger_sizes(first, last);
        let mut open = above(plus(sizes, slack), self.peak);
        self.peak = larger_sizes(self.peak, sizes);
        let (mut peak, first) = (kept(self.peak), kept(first));
        while open != 0 {
            let j = open.trailing_zeros() as usize;
            open &= open - 1;
            let (g, lane) = (j / 8, j % 8);
            let mut p = ZERO;
            p[0] = first[g].0[lane];
            let c = of.columns.each_ref().map(|column| column[g].0[lane]);
            let mut power = 1.0;
            for (k, x) in series.coefficients().iter().enumerate() {
                power *= rest;
                let of_state = (c[0] * x[0] + c[1] * x[1]) + (c[2] * x[2] + c[3] * x[3]);
                let of_input = if SLIP || k > 0 { 0.0 } else { of.of_input[g].0[lane] * change };
                p[k + 1] = (of_state + of_input) * power;
            }
            raise_to_size(&mut peak[g].0[lane], &p, 1.0);
        }
        self.peak = loaded(simd, &peak);
        self.set_limits();
        end
    }
}
