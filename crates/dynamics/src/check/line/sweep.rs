//! Even intervals, run by run and eight at a time: from one linear map no more than their ends and their
//! energies. Where a decision may be near, or an output may pass its peak, an interval is named, to be
//! looked at by its path.
//!
//! With `τ` from 0 to 1 over an interval of length h, loads `a₀ + Δa τ` and `T₀ + ΔT τ`, and velocities by
//! Legendre's polynomials, `v = Σ v_l P_l(2τ − 1)`:
//!
//! ```text
//! Δx = h v_0        ∫ τ x' dτ = h (v_0/2 + v_1/6) = x̄
//! work      −∫ a Σ m ẋ dt = −Σ m (a₀ Δx + Δa x̄)
//! friction  −∫ T ṡ dt     = −(T₀ Δs + ΔT s̄)
//! damping    ∫ vᵀ C v dt  = h Σ_l v_lᵀ C v_l/(2 l + 1)
//! ```

use fearless_simd::f64x8;
use fearless_simd::prelude::*;

use super::super::collocation::NODES;
use super::super::ground::Ground;
use super::super::lane::{Eight, LANES, Places, all, both, inlined, larger, smaller};
use super::group::{Course, Group, Key};
use super::knots::{BATCH, LaneJudge};
use super::maps::{Map, Maps, Spread};
use super::work::{Pass, Spent, Work};
use crate::error::Stopped;
use crate::response::output::Output;

/// Most steps of an interval whose outputs are bounded from its ends.
pub(super) const MOST_STEPS: usize = 2;
/// Intervals of one key: even ones swept, or by maps; odd ones by their equations.
pub(super) struct Kind {
    pub(super) key: Key,
    pub(super) even: Option<Even>,
    pub(super) mapped: Group,
    pub(super) odd: Group,
    pub(super) maps: Option<Maps>,
    pub(super) spread: Spread,
}

/// The even intervals of one key.
pub(super) struct Even {
    common: Common,
    /// Those being judged: of one run, and what is left of several.
    run: Lanes,
    rest: Lanes,
}

/// What is common to them.
struct Common {
    length_s: f64,
    /// To Legendre's terms of all velocities, one after another, then the velocities at the end.
    map: Map,
    terms: usize,
    deciding: Vec<Deciding>,
    /// Outputs that pass no peak where no decision is near, a bit each.
    settled: u64,
}

/// What decides about an interface.
struct Deciding {
    sticks: bool,
    /// `T` or the acceleration of contents in stick, the speed in slip.
    output: usize,
    /// How far it may leave its chord, batch by batch.
    off: Vec<f64>,
}

/// Eight even intervals.
struct Lanes {
    group: Group,
    /// Samples at which they begin.
    samples: [usize; LANES],
}

/// Even intervals of one course from a knot and a sample on.
pub(super) struct EvenRun<'a> {
    pub(super) kind: usize,
    pub(super) course: Course<'a>,
    pub(super) knot: usize,
    pub(super) sample: usize,
    pub(super) count: usize,
}

/// What is near: a margin below one, a speed of an interface below one.
pub(super) struct Floors {
    pub(super) margin: f64,
    pub(super) speeds: Vec<f64>,
    /// Of which interfaces speeds are compared with their peaks.
    pub(super) drops: Vec<bool>,
}

impl Even {
    pub(super) fn new(
        bench: &LaneJudge<'_>,
        key: &Key,
        length_s: f64,
        terms: usize,
        map: Map,
    ) -> Self {
        let lanes = || Lanes { group: Group::new(bench), samples: [0; LANES] };
        let deciding = (0..=bench.structure.contents.len()).map(|i| {
            let sticks = key.stuck >> i & 1 == 1;
            let output = match (i.checked_sub(1), sticks) {
                (None, true) => Output::FrictionForce,
                (None, false) => Output::Velocity,
                (Some(e), false) => Output::ContentsVelocity(e),
                (Some(e), true) => Output::ContentsAcceleration(e),
            };
            Deciding { sticks, output: output.place(bench.structure.points), off: Vec::new() }
        });
        let common = Common { length_s, map, terms, deciding: deciding.collect(), settled: 0 };
        Self { common, run: lanes(), rest: lanes() }
    }

    /// What decides about the slider, if it sticks.
    pub(super) fn holds(&self) -> bool {
        self.common.deciding[0].sticks
    }

    /// Takes the outputs that pass no peak where no decision is near.
    pub(super) fn settle<'o>(&mut self, outputs: impl Iterator<Item = &'o usize>) {
        self.common.settled = outputs.fold(0, |bits, g| bits | 1 << g);
    }

    /// Takes how far outputs may leave their chords, batch by batch.
    pub(super) fn bound(&mut self, off: &[Vec<f64>]) {
        for deciding in &mut self.common.deciding {
            deciding.off.clone_from(&off[deciding.output]);
        }
    }
}

impl Lanes {
    /// Reads the loads of the intervals.
    #[inline(always)]
    fn read<S: Simd>(&mut self, simd: S, length_s: f64, ground: &Ground<'_>) {
        let (group, samples) = (&mut self.group, Places::new(self.samples));
        let length = all(simd, length_s);
        group.set_length(simd, length);
        let pair = inlined!(|list: &[f64]| { both!(|end| samples.read(simd, list, end, [1, 0])) });
        let [from, to] = pair(ground.horizontal());
        group.table[0].store(from);
        group.table[1].store(to);
        group.drift.store((to - from) / length);
        if let Some(vertical) = ground.vertical() {
            let (zero, kg) = (all(simd, 0.0), all(simd, ground.total_kg()));
            let [from, to] = pair(vertical);
            let slope = kg * ((to - from) / length);
            for (normal, up) in group.normal.iter_mut().zip([from, to]) {
                normal.store(kg * larger(zero, all(simd, ground.gravity()) + up));
            }
            let (instant_s, most) = ground.blur();
            let most = slope.simd_eq(zero).select(zero, all(simd, 8.0 * f64::EPSILON * most));
            group.normal_rounding.store(all(simd, instant_s) * slope.abs() + most);
        } else {
            let normal = all(simd, ground.rest_normal());
            group.normal.iter_mut().for_each(|to| to.store(normal));
        }
    }
}

impl LaneJudge<'_> {
    /// Goes through runs of even intervals, and names those that are to be looked at by their paths.
    #[inline(always)]
    pub(super) fn sweep<S: Simd>(
        &self,
        simd: S,
        runs: &[EvenRun<'_>],
        kinds: &mut [Kind],
        floors: &Floors,
        (pass, named): (&mut Pass<'_, '_>, &mut Vec<usize>),
    ) -> Result<(), Stopped> {
        for run in runs {
            let Kind { even: Some(Even { common, run: whole, rest }), spread, .. } =
                &mut kinds[run.kind]
            else {
                continue;
            };
            if run.count < LANES {
                for i in 0..run.count {
                    rest.samples[rest.group.count] = run.sample + i;
                    if rest.group.push(self, &Course { knot: run.knot + i, ..run.course }) {
                        self.eight(simd, (common, spread), rest, floors, (pass, named))?;
                        rest.group.count = 0;
                    }
                }
                continue;
            }
            whole.group.count = 0;
            whole.group.push(self, &run.course);
            whole.group.fill();
            whole.group.count = LANES;
            for i in (0..run.count).step_by(LANES) {
                // The last eight overlap those before.
                let i = i.min(run.count - LANES);
                whole.group.knots = core::array::from_fn(|lane| run.knot + i + lane);
                whole.samples = core::array::from_fn(|lane| run.sample + i + lane);
                self.eight(simd, (common, spread), whole, floors, (pass, named))?;
            }
        }
        for kind in kinds {
            let Kind { even: Some(Even { common, rest, .. }), spread, .. } = kind else { continue };
            let count = rest.group.count;
            if count > 0 {
                rest.group.fill();
                let last = rest.samples[count - 1];
                rest.samples[count..].fill(last);
                self.eight(simd, (common, spread), rest, floors, (pass, named))?;
            }
        }
        Ok(())
    }

    /// Judges eight even intervals: a function of its own, or every place that calls it would be compiled with all
    /// of it inside.
    #[inline(never)]
    fn eight<S: Simd>(
        &self,
        simd: S,
        (common, spread): (&Common, &Spread),
        lanes: &mut Lanes,
        floors: &Floors,
        (pass, named): (&mut Pass<'_, '_>, &mut Vec<usize>),
    ) -> Result<(), Stopped> {
        pass.pulse.beat(8 * self.structure.degrees() as u32)?;
        // One storey gets loops of its own.
        let bits = match self.structure.masses_kg.len() {
            1 => simd.vectorize(
                #[inline(always)]
                || self.eight_of(simd, 1, (common, spread), lanes, floors, pass),
            ),
            n => simd.vectorize(
                #[inline(always)]
                || self.eight_of(simd, n, (common, spread), lanes, floors, pass),
            ),
        };
        let lanes = (0..lanes.group.count).zip(lanes.group.knots);
        if bits != 0 {
            named.extend(lanes.filter(|(lane, _)| bits >> lane & 1 == 1).map(|(_, knot)| knot));
        }
        Ok(())
    }

    #[inline(always)]
    fn eight_of<S: Simd>(
        &self,
        simd: S,
        n: usize,
        (common, spread): (&Common, &Spread),
        lanes: &mut Lanes,
        floors: &Floors,
        pass: &mut Pass<'_, '_>,
    ) -> u64 {
        lanes.read(simd, common.length_s, pass.ground);
        let group = &lanes.group;
        let d = self.structure.degrees();
        let places = Places::new(group.knots);
        self.read(simd, n, &places, &mut pass.work.input);
        self.load(simd, n, group, true, pass.work);
        let Work { input, active, sums, path, fastest, .. } = &mut *pass.work;
        common.map.apply(simd, (input, active), sums);
        let h = all(simd, common.length_s);
        for k in 0..d {
            let (x, v) = (input[k].load(simd), input[d + k].load(simd));
            let last = sums[common.terms * d + k].load(simd);
            path[NODES * d + k].store(x + h * sums[k].load(simd));
            path[(NODES + 1) * d + k].store(last);
            fastest[k].store(larger(v.abs(), last.abs()));
        }
        pass.work.spent = self.exchange(simd, common, group, pass.work);
        for end in 0..2 {
            self.sides(simd, (group, end), &places, pass);
        }
        self.arrive(simd, n, group, &places, pass);
        pass.work.spent.enter(&group.knots, pass.books);
        let mut named = 0;
        for i in 0..common.deciding.len() {
            named |= self.near(simd, i, (common, spread), (group, &places), floors, pass.work);
        }
        let loud = spread.loud(&group.knots) & !common.settled;
        if loud != 0 {
            named |= self.passing(simd, group, (spread, loud), pass);
        }
        named
    }

    /// Energies from Legendre's terms.
    #[inline(always)]
    fn exchange<S: Simd>(&self, simd: S, common: &Common, group: &Group, work: &Work) -> Spent {
        let s = self.structure;
        let (d, n) = (s.degrees(), s.masses_kg.len());
        let h = all(simd, common.length_s);
        let [half, sixth] = [all(simd, 0.5), all(simd, 1.0 / 6.0)];
        // Δx and x̄.
        let moved = inlined!(|k: usize| {
            let (mean, tilt) = (work.sums[k].load(simd), work.sums[d + k].load(simd));
            [h * mean, h * (half * mean + sixth * tilt)]
        });
        // A load from one end to the other.
        let exchanged = inlined!(|load: usize, [moved, moment]: [f64x8<S>; 2]| {
            let from = work.input[load].load(simd);
            let to = work.input[load + 1].load(simd);
            from * moved + (to - from) * moment
        });
        let (mut done, mut friction) = (all(simd, 0.0), all(simd, 0.0));
        for (k, &kg) in s.moved_kg.iter().enumerate() {
            done -= all(simd, kg) * exchanged(2 * d, moved(k));
        }
        friction -= exchanged(2 * d + 2, moved(0));
        for (e, contents) in s.contents.iter().enumerate() {
            let pulled = exchanged(2 * d + 4 + 2 * e, moved(1 + n + e));
            friction += all(simd, contents.mass_kg) * pulled;
        }
        let (mut damping, drag) = (all(simd, 0.0), group.drag.load(simd));
        for term in 0..common.terms {
            let terms = &work.sums[term * d..];
            let w = terms[0].load(simd);
            friction += all(simd, common.length_s / (2 * term + 1) as f64) * (drag * w * w);
            let lost = self.dissipation(simd, w, inlined!(|j: usize| terms[1 + j].load(simd)));
            damping += all(simd, 1.0 / (2 * term + 1) as f64) * lost;
        }
        let mut spent = Spent::default();
        spent.work.store(done);
        spent.size.store(done.abs());
        spent.damping.store(h * damping);
        spent.friction.store(friction);
        spent
    }

    /// What decides about an interface, as stored at the start (0) or the end (1): `T` or the acceleration of
    /// contents in stick, the speed in slip.
    #[inline(always)]
    fn decides<S: Simd>(
        &self,
        simd: S,
        i: usize,
        sticks: bool,
        (group, places, end): (&Group, &Places, usize),
    ) -> f64x8<S> {
        let (h, e) = (self.history, self.structure.contents.len());
        let of = inlined!(|list: &[f64], place: [usize; 2]| places.read(simd, list, end, place));
        match (i.checked_sub(1), sticks) {
            (None, true) => of(&h.friction_force_n, [1, 0]),
            (None, false) => group.sign.load(simd) * of(&h.sliding_velocity_m_per_s, [1, 0]),
            (Some(i), true) => {
                of(&h.contents_acceleration_m_per_s2, [e, i]) + all(simd, self.slope)
            }
            (Some(i), false) => {
                group.carried[i].sign.load(simd) * of(&h.contents_velocity_m_per_s, [e, i])
            }
        }
    }

    /// In which lanes the largest speed of a slip is between the ends: it tells the peak by which speeds are
    /// measured.
    #[inline(always)]
    fn turns<S: Simd>(&self, simd: S, i: usize, (group, places): (&Group, &Places)) -> u64 {
        let s = self.structure;
        let place = (s.masses_kg.len(), s.degree_of(i));
        let [_, sign] = group.interface(i);
        let sign = sign.load(simd);
        let [first, last] = both!(|end| sign * self.stored_rate(simd, place, places, end));
        let zero = all(simd, 0.0);
        (first.simd_gt(zero) & last.simd_lt(zero)).to_bitmask()
    }

    /// In which lanes a decision of an interface may be near.
    #[inline(always)]
    fn near<S: Simd>(
        &self,
        simd: S,
        i: usize,
        (common, spread): (&Common, &Spread),
        (group, places): (&Group, &Places),
        floors: &Floors,
        work: &mut Work,
    ) -> u64 {
        let deciding = &common.deciding[i];
        let [from, to] = both!(|end| self.decides(simd, i, deciding.sticks, (group, places, end)));
        let pair = inlined!(|pair: &[Eight; 2]| [pair[0].load(simd), pair[1].load(simd)]);
        let [first, second] = pair(&group.normal);
        let normal = [smaller(first, second), larger(first, second)];
        let reaches = inlined!(|off: f64x8<S>| {
            let (low, high) = (smaller(from, to) - off, larger(from, to) + off);
            if !deciding.sticks {
                let clear = low.simd_ge(all(simd, floors.speeds[i]));
                let [slow, fast] = pair(&group.band);
                let within = low.simd_ge(slow) & high.simd_le(fast);
                return !if i == 0 { clear & within } else { clear }.to_bitmask();
            }
            // The largest ratio to N either way is that to the least N.
            let zero = all(simd, 0.0);
            let most = high / high.simd_gt(zero).select(normal[0], normal[1]);
            let least = low / low.simd_lt(zero).select(normal[0], normal[1]);
            let margin = self.margin(simd, i, group, [least, most]);
            !margin.simd_ge(all(simd, floors.margin)).to_bitmask()
        });
        let lanes = (1 << LANES) - 1;
        let off = core::array::from_fn(|lane| deciding.off[places.knot(lane) / BATCH]);
        let turns = match !deciding.sticks && floors.drops[i] {
            true => self.turns(simd, i, (group, places)),
            false => 0,
        };
        let bits = reaches(f64x8::load_array(simd, off)) & lanes;
        if bits == 0 {
            return turns;
        }
        // The bound of an interval is closer than that of its batch.
        self.sizes(simd, work);
        let mut off = all(simd, 0.0);
        for (_, bounds) in spread.leaving.iter().filter(|(output, _)| *output == deciding.output) {
            for &(input, bound) in bounds {
                off += all(simd, bound) * work.active[input].load(simd);
            }
        }
        reaches(off) & bits | turns
    }
}
