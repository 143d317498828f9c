//! The path of an interval, solved or mapped from its stored start, and its energies.

use fearless_simd::f64x8;
use fearless_simd::prelude::*;

use super::super::collocation::{MOST_PASSES, NODES, ROUNDING};
use super::super::ground::Ground;
use super::super::lane::{Eight, LANES, Places, all, both, inlined, keep, larger};
use super::super::outputs::Outputs;
use super::group::Group;
use super::knots::{LaneJudge, lists_of, rates_of};
use super::maps::{Maps, Spread};
use super::work::{Pass, Spent, Work};
use crate::error::Stopped;
use crate::numerics::instructions::vectorize;

impl LaneJudge<'_> {
    /// Judges a group by the maps of its step, or by solving the equations of each.
    pub(super) fn group(
        &self,
        group: &mut Group,
        how: (Option<&Maps>, Option<&Spread>),
        pass: &mut Pass<'_, '_>,
    ) -> Result<(), Stopped> {
        let n = self.structure.masses_kg.len();
        vectorize!(self.instructions, simd => self.group_of(simd, n, group, how, pass))
    }

    #[inline(always)]
    fn group_of<S: Simd>(
        &self,
        simd: S,
        n: usize,
        group: &mut Group,
        (maps, spread): (Option<&Maps>, Option<&Spread>),
        pass: &mut Pass<'_, '_>,
    ) -> Result<(), Stopped> {
        let places = Places::new(group.knots);
        self.read(simd, n, &places, &mut pass.work.input);
        pass.work.spent = Spent::default();
        pass.work.fastest.fill(Eight::ZERO);
        let mut first = true;
        while group.next(self, pass.ground) {
            pass.pulse.beat(32 * self.structure.degrees() as u32)?;
            self.load(simd, n, group, first, pass.work);
            match maps {
                Some(maps) => {
                    let Work { input, active, path, .. } = &mut *pass.work;
                    maps.path.apply(simd, (input, active), path);
                }
                None => self.solve(group, Some(&places), pass.work),
            }
            self.spend(simd, n, group, maps.is_none(), pass.work);
            self.watch(simd, n, group, first, pass.work);
            if first {
                self.sides(simd, (group, 0), &places, pass);
            }
            self.peaks(simd, group, (maps, spread), pass);
            first = false;
        }
        self.sides(simd, (group, 1), &places, pass);
        for i in 0..pass.work.seen.len() {
            let at = self.structure.degree_of(i);
            let Work { seen, watch, fastest, .. } = &mut *pass.work;
            seen[i].least_into(simd, &mut watch[i]);
            watch[i].fastest = fastest[at];
        }
        self.arrive(simd, n, group, &places, pass);
        pass.work.spent.enter(&group.knots, pass.books);
        Ok(())
    }

    /// Forces at instants: `T` in `ends[0][FRICTION]`, accelerations in `bodies`.
    pub(super) fn instants(&self, group: &mut Group, ground: &Ground<'_>, work: &mut Work) {
        let n = self.structure.masses_kg.len();
        let places = Places::new(group.knots);
        group.follow_normal(self, ground);
        vectorize!(self.instructions, simd => {
            self.read(simd, n, &places, &mut work.input);
            self.load(simd, n, group, true, work);
            self.ask(simd, n, group, 0, work);
        });
    }

    /// Outputs at instants, in `ends[0]`.
    pub(super) fn outputs_at(
        &self,
        group: &mut Group,
        (ground, outputs): (&Ground<'_>, &Outputs),
        work: &mut Work,
    ) {
        self.instants(group, ground, work);
        self.end((group, 0), outputs, work);
    }

    /// Acceleration of an item of contents that [`instants`](Self::instants) or a node has found.
    pub(super) fn acceleration(&self, work: &Work, contents: usize, lane: usize) -> f64 {
        work.bodies[self.structure.degree_of(1 + contents)].0[lane]
    }

    /// Mass of the block with what sticks to it.
    pub(super) fn block_mass(&self, group: &Group, lane: usize) -> f64 {
        group.mass[0].0[lane]
    }

    /// Inputs of a path: `x` and `v` at its start, loads at both ends: `a`, of sliding, of contents.
    pub(super) fn inputs(&self) -> usize {
        2 * self.structure.degrees() + 4 + 2 * self.structure.contents.len()
    }

    /// `x, v` stored at the knots.
    #[inline(always)]
    pub(super) fn read<S: Simd>(&self, simd: S, n: usize, places: &Places, input: &mut [Eight]) {
        let d = self.structure.degrees();
        for i in 0..d {
            let ([x, v], at) = lists_of(self.history, n, i);
            input[i].store(places.read(simd, x, 0, at));
            input[d + i].store(places.read(simd, v, 0, at));
        }
    }

    /// The loads of a step, and the state with which it starts after another; what sticks has no velocity.
    #[inline(always)]
    pub(super) fn load<S: Simd>(
        &self,
        simd: S,
        n: usize,
        group: &Group,
        first: bool,
        work: &mut Work,
    ) {
        let d = self.structure.degrees();
        if !first {
            work.go_on(d);
        }
        let moves = all(simd, 1.0) - group.stuck.load(simd);
        let w = work.input[d].load(simd) * moves;
        work.input[d].store(w);
        let shift = group.stop[2].load(simd);
        for end in 0..2 {
            let normal = group.normal[end].load(simd);
            let a = group.table[end].load(simd) + all(simd, self.slope);
            work.input[2 * d + end].store(a);
            let slid = normal * group.friction[0].load(simd) * moves;
            work.input[2 * d + 2 + end].store(slid + shift);
            for (e, carried) in group.carried.iter().enumerate() {
                let pull = carried.pull.load(simd) * normal;
                work.input[2 * d + 4 + 2 * e + end].store(pull);
            }
        }
        self.take_speed(simd, group, w, work);
        for (e, carried) in group.carried.iter().enumerate() {
            let p = work.input[d + 1 + n + e].load(simd);
            work.input[d + 1 + n + e].store(p * (all(simd, 1.0) - carried.stuck.load(simd)));
        }
    }

    /// Keeps sliding speeds, near which friction by speed is asked for.
    #[inline(always)]
    pub(super) fn take_speed<S: Simd>(&self, simd: S, group: &Group, w: f64x8<S>, work: &mut Work) {
        if let Some(rate) = self.law.rate.as_ref().filter(|_| !group.affine && !group.sticks()) {
            let from = self.inputs();
            work.input[from].store(w.abs());
            work.input[from + 1].store(rate.faded_of(simd, w.abs()));
        }
    }

    /// `ẍ` of a degree stored at the knots of lanes, or those after them.
    #[inline(always)]
    pub(super) fn stored_rate<S: Simd>(
        &self,
        simd: S,
        (n, degree): (usize, usize),
        places: &Places,
        later: usize,
    ) -> f64x8<S> {
        let [(own, at), (under, below)] = rates_of(self.history, self.structure, n, degree);
        places.read(simd, own, later, at) - places.read(simd, under, later, below)
    }

    /// Solves the collocation equations of every lane by iteration, which begins with the line between
    /// the accelerations stored at the ends of the intervals.
    pub(super) fn solve(&self, group: &Group, stored: Option<&Places>, work: &mut Work) {
        // One storey gets loops of its own.
        match self.structure.masses_kg.len() {
            1 => vectorize!(self.instructions, simd => self.solve_of(simd, 1, group, stored, work)),
            n => vectorize!(self.instructions, simd => self.solve_of(simd, n, group, stored, work)),
        }
    }

    #[inline(always)]
    fn solve_of<S: Simd>(
        &self,
        simd: S,
        n: usize,
        group: &Group,
        stored: Option<&Places>,
        work: &mut Work,
    ) {
        let rule = self.rule;
        let d = self.structure.degrees();
        let Work { input, state, path, trace, bodies, .. } = work;
        let (places, rates) = trace.split_at_mut(NODES * d);
        let h = group.step_s.load(simd);
        let start = inlined!(|k: usize| [input[k].load(simd), input[d + k].load(simd)]);
        let node = inlined!(|rates: &[Eight], i: usize, k: usize| {
            rule.node(i, h, start(k), inlined!(|j: usize| rates[j * d + k].load(simd)))
        });
        rates.fill(Eight::ZERO);
        if let Some(places) = stored {
            let per_s = all(simd, 1.0) / group.length_s.load(simd);
            let (before, width) = (group.before_s.load(simd) * per_s, h * per_s);
            for k in 0..d {
                let from = self.stored_rate(simd, (n, k), places, 0);
                let rise = self.stored_rate(simd, (n, k), places, 1) - from;
                for i in 0..NODES {
                    let part = before + width * all(simd, rule.c[i]);
                    rates[i * d + k].store(from + rise * part);
                }
            }
        }
        let linear = self.law.rate.is_none() || group.affine;
        let rounding = if linear { f64::INFINITY } else { ROUNDING };
        let mut last = Eight([f64::INFINITY; LANES]);
        for pass in 0..MOST_PASSES {
            let (mut change, mut size) = (all(simd, 0.0), all(simd, 0.0));
            for i in 0..NODES {
                for (k, (x, v)) in state.iter_mut().enumerate() {
                    let [place, speed] = node(rates, i, k);
                    x.store(place);
                    v.store(speed);
                }
                let x = inlined!(|k: usize| state[k].0.load(simd));
                let v = inlined!(|k: usize| state[k].1.load(simd));
                let now = self.at(simd, group, input, rule.c[i]);
                self.accelerate(simd, n, group, now, (x, v), input, bodies);
                for k in 0..d {
                    let rate = self.rate(simd, (n, k), now.a, bodies);
                    let old = &mut rates[i * d + k];
                    change = larger(change, (rate - old.load(simd)).abs());
                    size = larger(size, rate.abs());
                    old.store(rate);
                }
            }
            // The next pass would gain as much as this one.
            let next = change * change;
            let gained = all(simd, if pass > 0 { 0.5 * f64::EPSILON } else { -1.0 });
            let small = change.simd_le(all(simd, 2.0 * f64::EPSILON) * size)
                | next.simd_le(gained * size * last.load(simd));
            let stalled = change.simd_ge(all(simd, 0.5) * last.load(simd))
                & change.simd_le(all(simd, rounding) * size);
            if small.all_true() || (pass >= 8 && (small | stalled).all_true()) {
                break;
            }
            last.store(change);
        }
        for k in 0..d {
            let [x, v] = rule.end(h, start(k), inlined!(|j: usize| rates[j * d + k].load(simd)));
            path[NODES * d + k].store(x);
            path[(NODES + 1) * d + k].store(v);
        }
        let asks = group.asks();
        for i in 0..NODES {
            for (k, (x, v)) in state.iter_mut().enumerate() {
                let [place, speed] = node(rates, i, k);
                x.store(place);
                v.store(speed);
                places[i * d + k].store(place);
                path[i * d + k].store(speed);
            }
            let x = inlined!(|k: usize| state[k].0.load(simd));
            let v = inlined!(|k: usize| state[k].1.load(simd));
            if !asks {
                continue;
            }
            let now = self.at(simd, group, input, rule.c[i]);
            let forces = if d == 1 + n {
                self.on_block(simd, now, (x, v), input)
            } else {
                self.accelerate(simd, n, group, now, (x, v), input, bodies)
            };
            let asked = self.friction(simd, group, now, (x(0), v(0)), forces, input);
            path[(NODES + 2) * d + i].store(asked);
            for e in 0..d - 1 - n {
                path[(NODES + 2) * d + (1 + e) * NODES + i] = bodies[1 + n + e];
            }
        }
    }

    /// Work and losses, and the largest velocities.
    #[inline(always)]
    pub(super) fn spend<S: Simd>(
        &self,
        simd: S,
        n: usize,
        group: &Group,
        solved: bool,
        work: &mut Work,
    ) {
        let s = self.structure;
        let d = s.degrees();
        let zero = all(simd, 0.0);
        let (mut done, mut size, mut damping, mut friction) = (zero, zero, zero, zero);
        let h = group.step_s.load(simd);
        let Work { input, path, trace, fastest, .. } = work;
        let [stiffness, damper] = both!(|i| group.stop[i].load(simd));
        let shift = group.stop[2].load(simd);
        let follows = self.law.follows();
        for node in 0..NODES {
            let v = inlined!(|k: usize| path[node * d + k].load(simd));
            let now = self.at(simd, group, input, self.rule.c[node]);
            let weight = h * all(simd, self.rule.weights[node]);
            let mut momentum = all(simd, s.total_kg) * v(0);
            for (k, fastest) in fastest.iter_mut().enumerate() {
                let speed = v(k);
                keep(simd, fastest, speed.abs());
                if (1..=n).contains(&k) {
                    momentum += all(simd, s.masses_kg[k - 1]) * speed;
                }
            }
            for (e, contents) in s.contents.iter().enumerate() {
                let mass = all(simd, contents.mass_kg);
                let mut speed = v(1 + n + e);
                if contents.floor > 0 {
                    speed += v(contents.floor);
                }
                momentum += mass * speed;
                let pull = self.pull(simd, input, e, now.part);
                friction += weight * mass * pull * v(1 + n + e);
            }
            let power = momentum * now.a;
            done -= weight * power;
            size += weight * power.abs();
            damping += weight
                * (damper * v(0) * v(0)
                    + self.dissipation(simd, v(0), inlined!(|j: usize| v(1 + j))));
            let mut force = self.sliding_force(simd, group, (v(0), now.load - shift), input);
            if follows && solved {
                force -= now.rise * trace[node * d].load(simd);
            }
            friction -= weight * force * v(0);
        }
        let [from, to] = [input[0].load(simd), path[NODES * d].load(simd)];
        let half = all(simd, 0.5);
        // What the stop's spring takes, and a spring that follows a constant N, is exact.
        damping += half * stiffness * (to * to - from * from) - shift * (to - from);
        if follows {
            let stored = half * group.rise[0].load(simd) * (to * to - from * from);
            if !solved {
                friction += stored;
            }
            // What such a spring gives back is work put in.
            size += larger(zero, -stored);
        }
        let spent = &mut work.spent;
        spent.work.store(spent.work.load(simd) + done);
        spent.size.store(spent.size.load(simd) + size);
        spent.damping.store(spent.damping.load(simd) + damping);
        spent.friction.store(spent.friction.load(simd) + friction);
    }
}
