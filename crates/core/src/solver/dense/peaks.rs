//! Peaks of the tracked quantities: what has been attained, and where more may hide.
//!
//! A block is kept as a whole, and a second look takes the samples of it that may hold more.

use fearless_simd::prelude::*;
use fearless_simd::{f64x4, f64x8};

use super::lanes::{BLOCK, Eight, Four, combine4, combine8, eight, four, greatest, larger};
use super::series::Series;
use super::step::Segment;
use super::walk::Walk;
use crate::friction::Direction;
use crate::linear::polynomial::{ZERO, largest};
use crate::response::Mode;
use crate::solver::outputs::output as tracked;

/// Most places in question that are kept before they are looked at.
const ROOM: usize = 16;

/// Some whole samples of one phase.
#[derive(Clone, Copy, Debug)]
pub(super) struct Block {
    pub(super) sample: usize,
    pub(super) steps: usize,
    /// Of sliding; none in stick.
    pub(super) direction: Option<Direction>,
    pub(super) x: [f64; 4],
}

/// A segment of a piece of a sample.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    pub(super) sample: usize,
    pub(super) segment: Segment,
    pub(super) x: [f64; 4],
    pub(super) mode: Mode,
}

#[derive(Clone, Copy, Debug)]
enum Place {
    /// With what a chord over a sample hides.
    Block(Block, Eight),
    /// Up to an event or its end.
    Part(Part),
}

#[derive(Clone, Copy, Debug)]
pub(in crate::solver) struct Candidate {
    place: Place,
    /// Bounds on the tracked quantities; zero where it cannot hold a peak.
    above: Eight,
}

impl<S: Simd> Walk<'_, S> {
    /// Looks for peaks in whole samples, among the quantities whose bits are set in `open`; a chord
    /// over a sample hides `slack` of the gates.
    #[inline(never)]
    pub(super) fn watch<const SLIP: bool>(
        &mut self,
        block: &Block,
        mut open: u64,
        slack: f64x4<S>,
    ) {
        let simd = self.simd;
        simd.vectorize(
            #[inline(always)]
            || {
                let a = self.block_at(block.sample);
                let phase = self.phase::<SLIP>();
                let force = block.direction.map_or(0.0, |direction| self.force(direction));
                let rows = if SLIP {
                    [
                        self.row::<SLIP>(&phase.rows[0], block.x, a, force),
                        self.row::<SLIP>(&phase.rows[1], block.x, a, force),
                        self.row::<SLIP>(&phase.rows[2], block.x, a, force),
                        self.row::<SLIP>(&phase.rows[4], block.x, a, force),
                    ]
                } else {
                    [
                        eight(simd, block.x[0]),
                        eight(simd, 0.0),
                        self.row::<SLIP>(&phase.rows[2], block.x, a, force),
                        self.row::<SLIP>(&phase.rows[4], block.x, a, force),
                    ]
                };
                let table = f64x8::from_slice(simd, &a[1..]);
                let first = self.view::<SLIP>(block.x, a[0], force).abs().to_array();
                let slack = combine8(simd, &phase.view.of_gates, slack.to_array()).to_array();
                let mut peak = self.peak.to_array();
                let mut above = [0.0; 8];
                let steps = (1_u64 << block.steps) - 1;
                while open != 0 {
                    let j = open.trailing_zeros() as usize;
                    open &= open - 1;
                    let c = &phase.view.columns;
                    let input = if SLIP {
                        eight(simd, phase.view.of_force.0[j]) * eight(simd, force)
                    } else {
                        eight(simd, phase.view.of_acceleration.0[j]) * table
                    };
                    let values = ((rows[0] * eight(simd, c[0].0[j])
                        + rows[1] * eight(simd, c[1].0[j]))
                        + (rows[2] * eight(simd, c[2].0[j]) + rows[3] * eight(simd, c[3].0[j])))
                        + (input + eight(simd, phase.view.constant.0[j]));
                    let sizes = values.abs();
                    let limit = peak[j] - slack[j];
                    let hits = sizes.simd_gt(eight(simd, limit)).to_bitmask() & steps;
                    if hits == 0 && first[j] <= limit {
                        continue;
                    }
                    let attained = sizes.to_array()[..block.steps]
                        .iter()
                        .fold(first[j], |most, x| if *x > most { *x } else { most });
                    peak[j] = if attained > peak[j] { attained } else { peak[j] };
                    above[j] = attained + slack[j];
                }
                self.peak = f64x8::load_array(simd, peak);
                self.set_gates();
                let above = Eight(above);
                if above.load(simd).simd_gt(self.peak).any_true() {
                    self.keep(Candidate { place: Place::Block(*block, Eight(slack)), above });
                }
            },
        );
    }

    /// Looks for peaks in the first part `t` of a segment, which ends in the state `end`.
    #[inline(always)]
    pub(super) fn look<const SLIP: bool>(
        &mut self,
        part: &Part,
        series: &Series<S>,
        end: f64x4<S>,
        t: f64,
        friction: [f64; 2],
    ) {
        let simd = self.simd;
        let a = part.segment.a;
        let end_a = a + part.segment.change * t;
        let gates = &self.phase::<SLIP>().gates;
        let input = if SLIP { friction } else { [a, end_a] };
        let slack = combine4(simd, &gates.sizes, series.bend) * four(simd, 0.125 * (t * t));
        let first = self.gates::<SLIP>(Four(part.x).load(simd), input[0]);
        let last = self.gates::<SLIP>(end, input[1]);
        let quiet = (self.inside(first, slack) & self.inside(last, slack)).all_true();
        let plant = &self.tables.plant;
        let spring =
            [plant.stiffness_n_per_m * part.x[0], plant.stiffness_n_per_m * end.as_array()[0]];
        let most = greatest(friction[0].abs(), friction[1].abs());
        let sliders = [friction[0] - spring[0], friction[1] - spring[1]];
        let slider = greatest(sliders[0].abs(), sliders[1].abs());
        let forces = if SLIP {
            let peak = self.peak.as_array();
            most <= peak[tracked::FRICTION] && slider <= peak[tracked::SLIDER]
        } else {
            let hidden = plant.participation * slack.as_array()[2];
            most + hidden <= self.most_friction && slider + hidden <= self.most_slider
        };
        if !(quiet && forces) || self.careful {
            self.look_at_all::<SLIP>(part, end.to_array(), t, input, slack);
        }
    }

    /// The same for all tracked quantities.
    #[inline(always)]
    fn look_at_all<const SLIP: bool>(
        &mut self,
        part: &Part,
        end: [f64; 4],
        t: f64,
        input: [f64; 2],
        slack: f64x4<S>,
    ) {
        let simd = self.simd;
        let first = self.view::<SLIP>(part.x, input[0], input[0]);
        let last = self.view::<SLIP>(end, input[1], input[1]);
        let of_gates = &self.phase::<SLIP>().view.of_gates;
        let slack = combine8(simd, of_gates, slack.to_array());
        let attained = larger(first.abs(), last.abs());
        if (attained + slack).simd_le(self.peak).all_true() {
            return;
        }
        self.peak = larger(self.peak, attained);
        self.set_gates();
        // An extreme lies inside only where the ends are less than four times the slack apart.
        let zero = eight(simd, 0.0);
        let inside = slack - (last - first).abs() * eight(simd, 0.25);
        let bulge = inside.simd_gt(zero).select(inside * (inside / slack), zero);
        // A few ulp are no more than the rounding of the ends.
        let above = attained + bulge;
        let rounding = self.peak * eight(simd, 1e-15);
        if above.simd_gt(self.peak + rounding).any_true() {
            let mut part = *part;
            part.segment.rest = t;
            self.keep(Candidate { place: Place::Part(part), above: Eight(above.to_array()) });
        }
    }

    #[inline(never)]
    fn keep(&mut self, candidate: Candidate) {
        if self.carry.candidates.len() == ROOM {
            self.drop_overtaken();
            if self.carry.candidates.len() > ROOM / 2 {
                self.settle();
            }
        }
        self.carry.candidates.push(candidate);
    }

    fn drop_overtaken(&mut self) {
        let peak = self.peak.to_array();
        self.carry
            .candidates
            .retain(|c| c.above.0.iter().zip(&peak).any(|(above, peak)| above > peak));
    }

    /// Looks at all places still in question.
    #[inline(never)]
    pub(super) fn settle(&mut self) {
        let simd = self.simd;
        simd.vectorize(
            #[inline(always)]
            || {
                self.drop_overtaken();
                let mut candidates = core::mem::take(&mut self.carry.candidates);
                for candidate in candidates.drain(..) {
                    let above = candidate.above.load(simd);
                    if above.simd_le(self.peak).all_true() {
                        continue;
                    }
                    match (&candidate.place, candidate.place.slides()) {
                        (Place::Part(part), true) => self.look_at::<true>(part),
                        (Place::Part(part), false) => self.look_at::<false>(part),
                        (Place::Block(block, slack), true) => {
                            self.look_through::<true>(block, slack)
                        }
                        (Place::Block(block, slack), false) => {
                            self.look_through::<false>(block, slack);
                        }
                    }
                }
                self.carry.candidates = candidates;
            },
        );
    }

    /// Looks at the samples of a block that may hold a peak.
    #[inline(always)]
    fn look_through<const SLIP: bool>(&mut self, block: &Block, slack: &Eight) {
        let (simd, pieces) = (self.simd, self.tables.pieces);
        let force = block.direction.map_or(0.0, |direction| self.force(direction));
        let mode = block.direction.map_or(Mode::Stick, Mode::Slip);
        let a: &[f64; BLOCK + 1] = self.block_at(block.sample);
        let x = Four(block.x).load(simd);
        let slack = slack.load(simd);
        let mut start = block.x;
        let mut first = self.view::<SLIP>(start, a[0], force);
        for k in 0..block.steps {
            let end = self.end::<SLIP>(k + 1, x, a, force).to_array();
            let last = self.view::<SLIP>(end, a[k + 1], force);
            if (larger(first.abs(), last.abs()) + slack).simd_gt(self.peak).any_true() {
                let change = (a[k + 1] - a[k]) / pieces as f64;
                let mut x = start;
                for piece in 0..pieces {
                    let at = a[k] + change * piece as f64;
                    let segment = Segment { rest: 1.0, a: at, change };
                    let part = Part { sample: block.sample + k, segment, x, mode };
                    let series = self.series_of::<SLIP>(&part, force);
                    self.look_closely::<SLIP>(&part, &series, force);
                    x = series.at(simd, 1.0).to_array();
                }
            }
            (start, first) = (end, last);
        }
    }

    #[inline(always)]
    fn look_at<const SLIP: bool>(&mut self, part: &Part) {
        let force = match part.mode {
            Mode::Stick => 0.0,
            Mode::Slip(direction) => self.force(direction),
        };
        let series = self.series_of::<SLIP>(part, force);
        self.look_closely::<SLIP>(part, &series, force);
    }

    #[inline(always)]
    fn series_of<const SLIP: bool>(&self, part: &Part, force: f64) -> Series<S> {
        let table = &self.phase::<SLIP>().series;
        Series::new::<SLIP>(self.simd, table, part.x, &part.segment, force)
    }

    /// Looks at a segment by the Taylor polynomials of what may hold a peak.
    #[inline(always)]
    fn look_closely<const SLIP: bool>(&mut self, part: &Part, series: &Series<S>, force: f64) {
        let simd = self.simd;
        let rest = part.segment.rest;
        let (a, change) = (part.segment.a, part.segment.change);
        let end = series.at(simd, rest).to_array();
        let first = self.view::<SLIP>(part.x, a, force);
        let last = self.view::<SLIP>(end, a + change * rest, force);
        let view = &self.phase::<SLIP>().view;
        let sizes = &self.phase::<SLIP>().gates.sizes;
        let slack = combine4(simd, sizes, series.bend) * four(simd, 0.125 * (rest * rest));
        let slack = combine8(simd, &view.of_gates, slack.to_array());
        // A peak at the upper side, and at the lower one.
        let upper = (larger(first, last) + slack).simd_gt(self.peak).to_bitmask();
        let lower = (larger(-first, -last) + slack).simd_gt(self.peak).to_bitmask();
        let mut open = upper | lower;
        self.peak = larger(self.peak, larger(first.abs(), last.abs()));
        let mut peak = self.peak.to_array();
        let first = first.to_array();
        while open != 0 {
            let j = open.trailing_zeros() as usize;
            open &= open - 1;
            let mut q = ZERO;
            q[0] = first[j];
            let mut power = 1.0;
            for (k, c) in series.coefficients().iter().enumerate() {
                power *= rest;
                let columns = &view.columns;
                let value = (columns[0].0[j] * c[0] + columns[1].0[j] * c[1])
                    + (columns[2].0[j] * c[2] + columns[3].0[j] * c[3]);
                let input = if SLIP || k > 0 { 0.0 } else { view.of_acceleration.0[j] * change };
                q[k + 1] = (value + input) * power;
            }
            if upper >> j & 1 != 0 {
                peak[j] = largest(&q, 1.0, peak[j]);
            }
            if lower >> j & 1 != 0 {
                peak[j] = largest(&q.map(|c| -c), 1.0, peak[j]);
            }
        }
        self.peak = f64x8::load_array(simd, peak);
        self.set_gates();
    }
}

impl Place {
    fn slides(&self) -> bool {
        match self {
            Self::Block(block, _) => block.direction.is_some(),
            Self::Part(part) => part.mode != Mode::Stick,
        }
    }
}
