//! Judges sliders with devices: rigid stops, friction by speed, a pendulum under vertical motion,
//! surfaces in series, contents that slide on the floors.
//!
//! The same way as [`Judge`](super::judge::Judge): from every knot to the next by Gauss collocation, here
//! of the nonlinear equations, with the laws written once more.

mod law;
mod own;

use self::law::{Slider, Sliding};
use self::own::Own;
use super::collocation::{NODES, POINTS, ROUNDING, Rule};
use super::energy::Energy;
use super::ground::{Ground, Load, of_side};
use super::judge::{STILL, between};
use super::law::Dips;
use super::structure::{Phase, Structure, excess, larger};
use super::{Certificate, ClosestCall};
use crate::error::Stopped;
use crate::model::{Contents, Model};
use crate::motion::GroundMotion;
use crate::progress::Pulse;
use crate::response::{Contact, History, Mode, Response};
use crate::slider::Direction;

/// Largest rate times step.
const MAX_TURN: f64 = 0.5;
/// Most passes of the iteration.
const MOST_PASSES: usize = 60;
/// Most steps between two knots.
const MOST_STEPS: f64 = 1e6;

/// Everything at an instant. Accelerations are absolute, with the slope's share.
#[derive(Clone, Default)]
struct Now {
    /// `ẍ`: block over table, floors over block, contents over floors.
    rate: Vec<f64>,
    block: f64,
    floors: Vec<f64>,
    contents: Vec<f64>,
    shear: f64,
    /// Force of the table on the block, of all and of friction.
    slider: f64,
    friction: f64,
    /// Force of the block on the elastic stop towards +x.
    stop: f64,
    /// Masses of the block and the floors with what sticks to them, and the pull of what slides there.
    mass: Vec<f64>,
    pull: Vec<f64>,
}

/// A node of a step.
#[derive(Clone, Default)]
struct Node {
    now: Now,
    x: Vec<f64>,
    v: Vec<f64>,
}

/// Work space of a step: its start, its nodes, its end.
#[derive(Default)]
struct Room {
    first: Node,
    nodes: [Node; NODES],
    end: Now,
    /// Rates of a node in the pass before.
    before: Vec<f64>,
}

/// What is in force between two knots.
struct Between<'a> {
    modes: &'a [Mode],
    contact: Contact,
    /// Of a slider that slides on surfaces in series.
    sliding: Option<Sliding>,
    /// `s` at the knot.
    from_m: f64,
}

pub(super) struct Judge<'a> {
    model: &'a Model,
    response: &'a Response,
    h: &'a History,
    structure: &'a Structure,
    contents: &'a [Contents],
    ground: Ground<'a>,
    slider: Slider<'a>,
    rule: &'static Rule,
    instant_s: f64,
    jolt: f64,
    /// Largest sliding velocity so far.
    sliding_m_per_s: f64,
    /// Largest `N`.
    normal: f64,
    /// Rounding of a time, and the largest `N`.
    blur: (f64, f64),
    /// What the rounding of times makes of a force at an event at most.
    unsure_n: f64,
    /// What the rounding of `N` makes of places and velocities in an interval at most.
    drift: [f64; 2],
    displacement: [f64; 2],
    velocity: [f64; 2],
    force: [f64; 2],
    table: [f64; 2],
    excess: f64,
    energy: Energy,
    closest: Option<ClosestCall>,
    /// Near decisions of the phases under way, by interface.
    dips: Vec<Dips>,
    /// How the slip went that has led to the present knot, and `s` where it began.
    arriving: Option<(Sliding, f64)>,
    own: Own,
    room: Room,
    /// Asks whether to go on, after so many units of work a step.
    pulse: Pulse<'a>,
    units: u32,
}

/// Judges everything; `None` where something stored is not finite.
pub(super) fn certificate(
    model: &Model,
    motion: &GroundMotion,
    (response, history): (&Response, &History),
    structure: &Structure,
    (bound, pulse): (f64, Pulse<'_>),
) -> Result<Option<Certificate>, Stopped> {
    let end_s = history.time_s.last().copied().unwrap_or(0.0);
    let ground = Ground::new(model, motion);
    let (normal, table) = ground.largest(end_s);
    let mut judge = Judge {
        model,
        response,
        h: history,
        structure,
        contents: model.contents(),
        ground,
        slider: Slider::new(model, motion.vertical_m_per_s2().is_some()),
        rule: Rule::get(),
        instant_s: 8.0 * f64::EPSILON * end_s,
        jolt: 0.0,
        sliding_m_per_s: 0.0,
        normal,
        blur: (8.0 * f64::EPSILON * end_s, normal),
        unsure_n: 0.0,
        drift: [0.0; 2],
        displacement: [0.0; 2],
        velocity: [0.0; 2],
        force: [0.0; 2],
        table: [0.0, table],
        excess: 0.0,
        energy: Energy::default(),
        closest: None,
        dips: vec![Dips::new(0.0); 1 + model.contents().len()],
        arriving: None,
        own: Own::new(model, history),
        room: Room::default(),
        pulse,
        units: 64 * (1 + model.storeys() + model.contents().len()) as u32,
    };
    judge.run(bound)
}

/// Turns of the block short of a stop: how far, over the gap.
pub(super) fn near_misses(model: &Model, h: &History) -> Vec<ClosestCall> {
    let Some(stop) = model.stop() else { return Vec::new() };
    let mut calls = Vec::new();
    for side in [Direction::Positive, Direction::Negative] {
        let Some(gap_m) = stop.gap_towards(side) else { continue };
        // Where the block came to a halt on its way there.
        let halts = (0..h.len().saturating_sub(1)).filter(|&k| {
            h.modes(k)[0] == Mode::Slip(side)
                && h.modes(k + 1)[0] != Mode::Slip(side)
                && h.sliding_velocity_m_per_s[k] == 0.0
        });
        let turns = halts.map(|k| (side.sign() * h.sliding_displacement_m[k], k));
        let turns = turns.filter(|(s, _)| *s < gap_m);
        if let Some((s, k)) = turns.reduce(|a, b| if b.0 > a.0 { b } else { a }) {
            let margin = 1.0 - s / gap_m;
            calls.push(ClosestCall { margin, time_s: h.time_s[k], kind: "miss", interface: 0 });
        }
    }
    calls
}

/// Takes the state of a node from the start of a step and the rates at all nodes.
fn follow(rule: &Rule, (i, step_s): (usize, f64), nodes: &mut [Node], (x, v): (&[f64], &[f64])) {
    for c in 0..x.len() {
        let (mut along, mut twice) = (0.0, 0.0);
        for (j, node) in nodes.iter().enumerate() {
            along += rule.a[i][j] * node.now.rate[c];
            twice += rule.aa[i][j] * node.now.rate[c];
        }
        nodes[i].v[c] = v[c] + step_s * along;
        nodes[i].x[c] = x[c] + step_s * (rule.c[i] * v[c] + step_s * twice);
    }
}

fn relative(pair: [f64; 2]) -> f64 {
    if pair[0] == 0.0 { 0.0 } else { pair[0] / pair[1] }
}

impl<'a> Judge<'a> {
    fn floors(&self) -> usize {
        self.structure.masses_kg.len()
    }

    fn degrees(&self) -> usize {
        1 + self.floors() + self.contents.len()
    }

    fn modes(&self, k: usize) -> &'a [Mode] {
        self.h.modes(k)
    }

    fn contact(&self, k: usize) -> Contact {
        self.h.contact.get(k).copied().unwrap_or(Contact::Free)
    }

    /// `x` and `v` stored at a knot.
    fn stored(&self, k: usize) -> (Vec<f64>, Vec<f64>) {
        let (mut x, mut v) =
            (vec![self.h.sliding_displacement_m[k]], vec![self.h.sliding_velocity_m_per_s[k]]);
        x.extend(self.h.storey_displacements(k));
        v.extend(self.h.storey_velocities(k));
        for e in 0..self.contents.len() {
            let [r, p, _] = self.h.contents_state(k, e);
            x.push(r);
            v.push(p);
        }
        (x, v)
    }

    /// Accelerations and forces under a load.
    fn at(&self, b: &Between<'_>, load: &Load, x: &[f64], v: &[f64]) -> Now {
        let mut now = Now::default();
        self.find(b, load, (x, v), &mut now);
        now
    }

    /// The same into what is there.
    fn find(&self, b: &Between<'_>, load: &Load, (x, v): (&[f64], &[f64]), now: &mut Now) {
        let n = self.floors();
        let Now { rate, floors, contents: carried, mass, pull, .. } = now;
        let (q, rates) = (&x[1..=n], &v[1..=n]);
        let press = load.normal / self.structure.total_kg;
        mass.clear();
        mass.push(self.structure.block_kg);
        mass.extend(&self.structure.masses_kg);
        pull.clear();
        pull.resize(n + 1, 0.0);
        for (contents, mode) in self.contents.iter().zip(&b.modes[1..]) {
            match mode {
                Mode::Stick => mass[contents.floor] += contents.mass_kg,
                Mode::Slip(direction) => {
                    let friction = contents.kinetic_friction * contents.mass_kg * press;
                    pull[contents.floor] += direction.sign() * friction;
                }
            }
        }
        // The restoring forces first, then the accelerations of the floors.
        floors.clear();
        floors.resize(n, 0.0);
        self.structure.add_elastic(q, floors);
        self.structure.add_viscous(rates, floors);
        let shear = self.structure.base_force(q, rates);
        let (s, w) = (x[0], v[0]);
        let push = self.slider.stop(b.contact);
        let spring = self.slider.spring(s, w, load.normal);
        let stop = push.force(s, w);
        let (block, slider, friction) = match b.modes[0] {
            Mode::Stick => {
                let slider = mass[0] * load.a - shear - pull[0];
                (load.a, slider, slider + spring + stop)
            }
            Mode::Slip(direction) => {
                let friction = match &b.sliding {
                    Some(sliding) => -load.normal * sliding.force(s - b.from_m),
                    None => {
                        let mu = self.slider.kinetic(direction, w.abs());
                        -direction.sign() * mu * load.normal
                    }
                };
                let slider = friction - spring - stop;
                ((slider + shear + pull[0]) / mass[0], slider, friction)
            }
        };
        for (i, floor) in floors.iter_mut().enumerate() {
            *floor = (pull[i + 1] - *floor) / mass[i + 1];
        }
        let under = |floor: usize| if floor == 0 { block } else { floors[floor - 1] };
        carried.clear();
        carried.extend(self.contents.iter().zip(&b.modes[1..]).map(
            |(contents, mode)| match mode {
                Mode::Stick => under(contents.floor),
                Mode::Slip(direction) => -direction.sign() * contents.kinetic_friction * press,
            },
        ));
        rate.clear();
        rate.push(block - load.a);
        rate.extend(floors.iter().map(|floor| floor - block));
        rate.extend(self.contents.iter().zip(&*carried).map(|(c, a)| a - under(c.floor)));
        if b.modes[0] == Mode::Stick {
            rate[0] = 0.0;
        }
        for (rate, mode) in rate[1 + n..].iter_mut().zip(&b.modes[1..]) {
            if *mode == Mode::Stick {
                *rate = 0.0;
            }
        }
        (now.block, now.shear, now.slider, now.friction) = (block, shear, slider, friction);
        now.stop = stop;
    }

    /// Bound on the fastest rate between two knots, in 1/s.
    fn rate(&self, k: usize) -> f64 {
        let phase = if self.modes(k)[0] == Mode::Stick { Phase::Stick } else { Phase::Pressed };
        let own = self.structure.rate(phase);
        if phase == Phase::Stick {
            return own;
        }
        let speed = [k, k + 1]
            .map(|k| {
                let block = self.h.block_acceleration_m_per_s2[k];
                (block - self.h.table_acceleration_m_per_s2[k]).abs()
            })
            .into_iter()
            .fold(0.0, f64::max);
        own + self.slider.rate(self.normal / self.structure.block_kg, speed)
    }

    fn run(&mut self, bound: f64) -> Result<Option<Certificate>, Stopped> {
        let knots = self.h.len();
        if self.scales().is_none() {
            return Ok(None);
        }
        self.start();
        let (x, v) = self.stored(0);
        let stop_j = self.slider.stop(self.contact(0)).strain(x[0]);
        let initial_j = self.kinetic(&v) + self.strain(&x) + stop_j;
        let rounding_j = self.structure.total_kg * self.jolt * self.jolt;
        self.energy.start(initial_j, stop_j, rounding_j, knots);
        for i in 0..self.dips.len() {
            self.dips[i] = self.fresh_dips(0, i);
        }
        let mut arrives = false;
        for k in 0..knots {
            if k > 0 {
                self.join(k, !arrives);
            }
            let (x, v) = self.stored(k);
            let (kinetic, strain) = (self.kinetic(&v), self.strain(&x));
            self.energy.knot(kinetic, strain);
            self.energy.history.kinetic_j.push(kinetic);
            self.energy.history.strain_j.push(strain);
            self.knot(k);
            arrives = k + 1 < knots && self.h.time_s[k + 1] > self.h.time_s[k];
            if arrives {
                self.interval(k)?;
            }
        }
        if knots > 1 && !arrives && self.h.time_s[knots - 1] == self.h.time_s[knots - 2] {
            self.after_last_jump(knots - 1);
        }
        for (i, mode) in self.modes(knots - 1).iter().enumerate() {
            self.close(i, *mode);
        }
        Ok(Some(self.finish(bound)))
    }

    fn finish(&mut self, bound: f64) -> Certificate {
        let equilibrium = [self.displacement, self.velocity, self.force, self.table].map(relative);
        let near = |scale: f64| 64.0 * f64::EPSILON * scale;
        let rounding = own::Rounding {
            instant_s: self.instant_s,
            displacement_m: near(self.displacement[1]) + self.drift[0],
            velocity_m_per_s: near(self.velocity[1]) + self.jolt + self.drift[1],
            force_n: near(self.force[1])
                + self.unsure_n
                + self.slider.law.rounding(&self.ground, self.instant_s, self.normal),
        };
        let demands_error = self.own.error(self.model, self.response, self.h, &rounding);
        for call in near_misses(self.model, self.h) {
            self.nearest(call);
        }
        Certificate {
            equilibrium_residual: equilibrium.into_iter().fold(0.0, larger),
            friction_excess: relative([
                self.excess,
                self.slider.scale(self.normal, self.model.weight_n()),
            ]),
            energy_balance_error: self.energy.error(),
            demands_error,
            closest_call: self.closest,
            bound,
            energy: core::mem::take(&mut self.energy.history),
        }
    }

    /// The scales by which defects are measured; `None` where something is not finite.
    fn scales(&mut self) -> Option<()> {
        let h = self.h;
        let lists = [
            &h.sliding_displacement_m,
            &h.sliding_velocity_m_per_s,
            &h.block_acceleration_m_per_s2,
            &h.friction_force_n,
            &h.table_acceleration_m_per_s2,
            &h.storey_displacement_m,
            &h.storey_velocity_m_per_s,
            &h.storey_acceleration_m_per_s2,
            &h.surface_displacement_m,
            &h.contents_displacement_m,
            &h.contents_velocity_m_per_s,
            &h.contents_acceleration_m_per_s2,
        ];
        if lists.iter().any(|list| list.iter().any(|x| !x.is_finite())) {
            return None;
        }
        let most = |list: &[f64]| list.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let jolt = self.instant_s
            * most(&h.block_acceleration_m_per_s2).max(most(&h.table_acceleration_m_per_s2));
        self.jolt = jolt;
        let place = most(&h.sliding_displacement_m).max(most(&h.storey_displacement_m));
        let storey = most(&h.storey_displacement_m);
        let rest = 1e-4 * self.structure.frame_frequency() * storey;
        let sliding = most(&h.sliding_velocity_m_per_s);
        let speed = sliding.max(most(&h.storey_velocity_m_per_s));
        self.displacement[1] =
            place.max(most(&h.contents_displacement_m)).max(self.instant_s * jolt);
        self.velocity[1] = speed.max(most(&h.contents_velocity_m_per_s)).max(rest).max(jolt);
        self.sliding_m_per_s = sliding;
        Some(())
    }

    /// The first knot has the model's initial state, and what moves at rest was pushed.
    fn start(&mut self) {
        let initial = self.model.initial();
        let (x, v) = self.stored(0);
        let mut own_x = vec![initial.sliding_displacement_m];
        own_x.extend(self.model.initial_storey_displacement_m());
        own_x.resize(x.len(), 0.0);
        let mut own_v = vec![initial.sliding_velocity_m_per_s];
        own_v.extend(self.model.initial_storey_velocity_m_per_s());
        own_v.resize(v.len(), 0.0);
        self.compare((&x, &v), (&own_x, &own_v));
        let mut before = vec![Mode::Stick; self.modes(0).len()];
        if initial.sliding_velocity_m_per_s != 0.0 {
            before[0] = self.modes(0)[0];
        }
        self.changes(0, &before);
        self.own.begin(self.h, &before);
    }

    fn compare(&mut self, (x, v): (&[f64], &[f64]), (own_x, own_v): (&[f64], &[f64])) {
        for (a, b) in x.iter().zip(own_x) {
            self.displacement[0] = larger(self.displacement[0], a - b);
        }
        for (a, b) in v.iter().zip(own_v) {
            self.velocity[0] = larger(self.velocity[0], a - b);
        }
    }

    /// Passes from the knot before `k` to `k`; `abreast` where both have the same time.
    fn join(&mut self, k: usize, abreast: bool) {
        let (before, after) = (self.modes(k - 1), self.modes(k));
        let mut struck = false;
        if abreast {
            let ((x0, v0), (x1, v1)) = (self.stored(k - 1), self.stored(k));
            struck = self.slider.e.is_some() && v0[0] != v1[0] && self.at_wall(x1[0], v0[0]);
            if struck {
                self.impact(k, (&v0, &v1));
                self.compare((&x1, &[]), (&x0, &[]));
            } else {
                self.compare((&x1, &v1), (&x0, &v0));
            }
            let surfaces = self.h.surface_displacements(k).iter();
            for (a, b) in surfaces.zip(self.h.surface_displacements(k - 1)) {
                self.displacement[0] = larger(self.displacement[0], a - b);
            }
        }
        for i in 0..after.len() {
            if before[i] != after[i] {
                self.close(i, before[i]);
                self.dips[i] = self.fresh_dips(k, i);
            }
        }
        if !struck {
            for i in 0..after.len() {
                if before[i] != after[i] {
                    let (_, v) = self.stored(k);
                    let at = if i == 0 { 0 } else { self.floors() + i };
                    self.velocity[0] = larger(self.velocity[0], v[at]);
                }
            }
            self.changes(k, before);
        }
        self.own.pass(self.h, k, struck);
    }

    /// Whether a block at `s` with a velocity is about to pass a rigid stop.
    fn at_wall(&self, s: f64, w: f64) -> bool {
        let direction = if w > 0.0 { Direction::Positive } else { Direction::Negative };
        let slack_m = self.instant_s * w.abs() + 8.0 * f64::EPSILON * self.displacement[1];
        self.slider.wall(direction).is_some_and(|wall| (s - wall).abs() <= slack_m)
    }

    /// Judges an impact: `ṡ⁺ = −e ṡ⁻`, absolute velocities of floors and contents as before.
    fn impact(&mut self, k: usize, (v0, v1): (&[f64], &[f64])) {
        let e = self.slider.e.unwrap_or(0.0);
        let (before, after) = (v0[0], v1[0]);
        self.velocity[0] = larger(self.velocity[0], after + e * before);
        let n = self.floors();
        for i in 1..=n {
            self.velocity[0] = larger(self.velocity[0], (v1[i] + after) - (v0[i] + before));
        }
        for (e, contents) in self.contents.iter().enumerate() {
            let i = 1 + n + e;
            let change = if contents.floor == 0 { before - after } else { 0.0 };
            self.velocity[0] = larger(self.velocity[0], v1[i] - v0[i] - change);
        }
        let lost = 0.5 * self.structure.block_kg * (before * before - after * after);
        self.energy.spend(0.0, 0.0, lost, 0.0);
        let peak = self.velocity[1];
        if before.abs() >= own::SLOWEST_IMPACT_M_PER_S {
            let margin = before.abs() / peak;
            let time_s = self.h.time_s[k];
            self.nearest(ClosestCall { margin, time_s, kind: "impact", interface: 0 });
        }
    }

    /// Judges the decisions at the knot `k`, at which what changes its mode has no velocity.
    fn changes(&mut self, k: usize, before: &[Mode]) {
        let after = self.modes(k);
        if before == after {
            return;
        }
        let table = self.h.table_acceleration_m_per_s2[k];
        let all = self.ground.instant(self.h.time_s[k]);
        let loads = of_side(&all, table);
        let (_, v) = self.stored(k);
        let surfaces = match before[0] {
            Mode::Slip(slid) => self.slider.off_ends(self.h.surface_displacements(k), slid),
            Mode::Stick => self.h.surface_displacements(k).to_vec(),
        };
        let held: Vec<Mode> = (0..after.len())
            .map(|i| {
                let velocity = if i == 0 { v[0] } else { v[self.floors() + i] };
                if velocity == 0.0 { Mode::Stick } else { after[i] }
            })
            .collect();
        for i in 0..after.len() {
            if before[i] == after[i] {
                continue;
            }
            // The others may have changed before it or after it, or been held meanwhile.
            let (mut least, mut nearest_beyond) = (f64::INFINITY, f64::INFINITY);
            let mut margin = None;
            // What a jump passes on its way lets go too.
            let passed = if before[i] == Mode::Stick { &all[..] } else { &loads[..] };
            for load in passed {
                for others in [before, after, &held[..]] {
                    let mut modes = others.to_vec();
                    modes[i] = Mode::Stick;
                    // A bounce below the rounding of s turns back to the stop: that does not hold it.
                    let leans = after[i] == Mode::Stick;
                    let (asked, rounding) = self.asked((k, &surfaces), &modes, (i, leans), load);
                    let beyond = match after[i] {
                        Mode::Stick => asked.beyond(),
                        Mode::Slip(Direction::Positive) => asked.demand - asked.low,
                        Mode::Slip(Direction::Negative) => asked.high - asked.demand,
                    } - rounding;
                    if core::ptr::eq(others, before) && excess(beyond) <= nearest_beyond {
                        nearest_beyond = excess(beyond);
                        margin = asked.margin();
                    }
                    least = least.min(excess(beyond));
                }
            }
            self.excess = larger(self.excess, least);
            if before[i] != Mode::Stick
                && let Some(margin) = margin
            {
                if i == 0 {
                    let load = &loads[0];
                    let drift = self.structure.block_kg * load.slope.abs() * self.instant_s
                        / self.slider.scale(load.normal, self.model.weight_n());
                    self.own.decided(margin, drift);
                }
                let time_s = self.h.time_s[k];
                self.nearest(ClosestCall { margin, time_s, kind: "stop", interface: i });
            }
        }
        self.releases(k, before, &surfaces, loads[0]);
        if before[0] != Mode::Stick
            && before[0] != after[0]
            && let Some(margin) = self.slider.next_join(self.h.surface_displacements(k), before[0])
        {
            let time_s = self.h.time_s[k];
            self.nearest(ClosestCall { margin, time_s, kind: "join", interface: 0 });
        }
    }

    /// Interfaces that let go at the knot `k` together: a close call where one of them, had it let go
    /// first, would have held the other back. Along a jump from `Load` to `Load` each reaches its bound
    /// at a part of the way.
    fn releases(&mut self, k: usize, before: &[Mode], surfaces: &[f64], to: Load) {
        let after = self.modes(k);
        let gone: Vec<usize> = (0..after.len())
            .filter(|&i| before[i] == Mode::Stick && after[i] != Mode::Stick)
            .collect();
        if gone.len() < 2 {
            return;
        }
        let all = self.ground.instant(self.h.time_s[k]);
        let from = match k.checked_sub(1).filter(|&j| self.h.time_s[j] == self.h.time_s[k]) {
            Some(j) => {
                let off = |load: &Load| (load.table - self.h.table_acceleration_m_per_s2[j]).abs();
                all.into_iter().reduce(|a, b| if off(&b) < off(&a) { b } else { a }).unwrap_or(to)
            }
            None => all[0],
        };
        let jumps = (from.table, from.normal) != (to.table, to.normal);
        let at =
            |load: &Load, modes: &[Mode], i| self.asked((k, surfaces), modes, (i, false), load).0;
        let reached: Vec<f64> = gone
            .iter()
            .map(|&i| {
                let [first, last] = [&from, &to].map(|load| at(load, before, i));
                if !jumps {
                    return last.margin().unwrap_or(f64::INFINITY);
                }
                let part = |from: f64, to: f64| if to > from { -from / (to - from) } else { 1.0 };
                let above = part(first.demand - first.high, last.demand - last.high);
                let below = part(first.low - first.demand, last.low - last.demand);
                above.clamp(0.0, 1.0).min(below.clamp(0.0, 1.0))
            })
            .collect();
        let mut calls = Vec::new();
        for (a, &i) in gone.iter().enumerate() {
            let mut modes = before.to_vec();
            modes[i] = after[i];
            for (b, &j) in gone.iter().enumerate().filter(|&(b, _)| b != a) {
                if at(&to, &modes, j).beyond() <= 0.0 {
                    let margin = if jumps {
                        (reached[a] - reached[b]).abs()
                    } else {
                        reached[a].max(reached[b])
                    };
                    let time_s = self.h.time_s[k];
                    calls.push(ClosestCall { margin, time_s, kind: "release", interface: j });
                }
            }
        }
        for call in calls {
            self.nearest(call);
        }
    }

    /// What a stuck interface is asked for and what holds it, with the rounding of the two, in N.
    fn asked(
        &self,
        (k, surfaces): (usize, &[f64]),
        modes: &[Mode],
        (i, leans): (usize, bool),
        load: &Load,
    ) -> (law::Asked, f64) {
        let (x, v) = self.stored(k);
        let b = self.between_knots(k, modes);
        let now = self.at(&b, load, &x, &v);
        let asked = self.holds(&now, (x[0], surfaces), (i, leans), load);
        (asked, self.asked_rounding(&now, i, load))
    }

    /// The same from forces known; `leans` where rigid stops hold too.
    fn holds(
        &self,
        now: &Now,
        (s, surfaces): (f64, &[f64]),
        (i, leans): (usize, bool),
        load: &Load,
    ) -> law::Asked {
        if i == 0 {
            let slack_m =
                if leans { 8.0 * f64::EPSILON * self.displacement[1] } else { f64::NEG_INFINITY };
            return self.slider.asked(now.friction, (s, slack_m), surfaces, load.normal);
        }
        let contents = &self.contents[i - 1];
        let press = load.normal / self.structure.total_kg;
        let bound = contents.static_friction * contents.mass_kg * press;
        let demand = contents.mass_kg * now.contents[i - 1];
        law::Asked { demand, low: -bound, high: bound, friction: [-bound, bound] }
    }

    fn between_knots<'b>(&self, k: usize, modes: &'b [Mode]) -> Between<'b> {
        let sliding = match modes[0] {
            Mode::Stick => None,
            Mode::Slip(direction) => {
                let ways = self.slider.slidings(self.h.surface_displacements(k), direction);
                // The force that is stored tells that a surface has left its end.
                let (loads, found) =
                    (self.ground.instant(self.h.time_s[k]), self.h.friction_force_n[k]);
                let suits = |way: &Sliding| {
                    let off = |load: &Load| (load.normal * way.force(0.0) + found).abs();
                    let least = loads.iter().map(off).fold(f64::INFINITY, f64::min);
                    least <= STILL * self.model.weight_n()
                };
                let place = ways.iter().position(suits).unwrap_or(0);
                ways.into_iter().nth(place)
            }
        };
        Between {
            modes,
            contact: self.contact(k),
            sliding,
            from_m: self.h.sliding_displacement_m[k],
        }
    }

    /// Judges what is stored at a knot by the load that suits it best.
    fn knot(&mut self, k: usize) {
        let (h, modes) = (self.h, self.modes(k));
        let (x, v) = self.stored(k);
        let b = self.between_knots(k, modes);
        let slope = self.model.slope_m_per_s2();
        let mut best = [f64::INFINITY; 2];
        let (mut scale, mut unsure_n) = (0.0, 0.0);
        let led = self.arriving.take().filter(|_| modes[0] != Mode::Stick);
        let led = led.map(|(sliding, from_m)| Between {
            modes,
            contact: b.contact,
            sliding: Some(sliding),
            from_m,
        });
        let sides: Vec<&Between<'_>> = core::iter::once(&b).chain(&led).collect();
        let loads = self.ground.instant(h.time_s[k]);
        for (load, b) in loads.iter().flat_map(|load| sides.iter().map(move |b| (load, *b))) {
            let now = self.at(b, load, &x, &v);
            let table = ((load.table - h.table_acceleration_m_per_s2[k]).abs()
                - self.instant_s * load.slope.abs())
            .max(0.0);
            let mut force = self.structure.block_kg
                * (now.block - slope - h.block_acceleration_m_per_s2[k]).abs();
            for (i, a) in now.floors.iter().enumerate() {
                let off = a - slope - h.storey_accelerations(k)[i];
                force = force.max(self.structure.masses_kg[i] * off.abs());
            }
            for (e, contents) in self.contents.iter().enumerate() {
                let off = now.contents[e] - slope - h.contents_state(k, e)[2];
                force = force.max(contents.mass_kg * off.abs());
            }
            let asked = self.holds(&now, (x[0], h.surface_displacements(k)), (0, true), load);
            let friction = if modes[0] == Mode::Stick { asked.taken() } else { now.friction };
            force = force.max((friction - h.friction_force_n[k]).abs());
            let rounding = load.rounding(self.blur, self.structure.total_kg, self.slider.most());
            force = excess(force - rounding);
            if table + force / self.structure.total_kg < best[0] + best[1] / self.structure.total_kg
            {
                best = [table, force];
                unsure_n = rounding;
                let terms = [now.slider, now.friction, now.shear, now.stop];
                let own = terms.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
                let floors = now.floors.iter().zip(&self.structure.masses_kg);
                scale = floors.fold(own, |most, (a, m)| most.max((a * m).abs()));
            }
        }
        if !self.ground.has_sample(h.time_s[k]) {
            self.unsure_n = larger(self.unsure_n, unsure_n);
        }
        self.table[0] = larger(self.table[0], best[0]);
        self.force[0] = larger(self.force[0], best[1]);
        self.force[1] = larger(self.force[1], scale);
        self.excess = larger(self.excess, self.contact_excess(k));
        // Surfaces in series make up s, within their travels.
        let surfaces = h.surface_displacements(k);
        if !surfaces.is_empty() {
            let sum: f64 = surfaces.iter().sum();
            self.displacement[0] = larger(self.displacement[0], sum - x[0]);
            let beyond = self.slider.beyond_ends(surfaces);
            self.displacement[0] = larger(self.displacement[0], beyond);
        }
        if let Some(beyond) = self.slider.beyond_walls(x[0]) {
            self.displacement[0] = larger(self.displacement[0], beyond);
        }
    }

    /// What the rounding of times makes of what a stuck interface is asked for, less what holds it, in N.
    fn asked_rounding(&self, now: &Now, i: usize, load: &Load) -> f64 {
        let Some(contents) = i.checked_sub(1).map(|e| &self.contents[e]) else {
            return load.rounding(self.blur, now.mass[0], self.slider.most());
        };
        let mu = contents.static_friction * contents.mass_kg / self.structure.total_kg;
        load.rounding(self.blur, contents.mass_kg, mu)
    }

    /// Coefficients of friction of what slides from the knot `k` on, and 0 of what sticks.
    fn sliding_friction(&self, k: usize) -> impl Iterator<Item = f64> {
        let (most, contents) = (self.slider.most(), self.contents);
        self.modes(k).iter().enumerate().map(move |(i, mode)| match (mode, i.checked_sub(1)) {
            (Mode::Stick, _) => 0.0,
            (Mode::Slip(_), None) => most,
            (Mode::Slip(_), Some(e)) => contents[e].kinetic_friction,
        })
    }

    /// Judges the last knot by the load after a jump there, which no interval follows.
    fn after_last_jump(&mut self, k: usize) {
        let modes = self.modes(k);
        let [_, _, load, _] = self.ground.instant(self.h.time_s[k]);
        let (x, v) = self.stored(k);
        let now = self.at(&self.between_knots(k, modes), &load, &x, &v);
        let surfaces = self.h.surface_displacements(k);
        let asked = self.holds(&now, (x[0], surfaces), (0, true), &load);
        for (i, mode) in modes.iter().enumerate() {
            if *mode == Mode::Stick {
                let asked = self.holds(&now, (x[0], surfaces), (i, true), &load);
                let beyond = asked.beyond() - self.asked_rounding(&now, i, &load);
                self.excess = larger(self.excess, excess(beyond));
            }
        }
        let asked = if modes[0] == Mode::Stick { vec![asked; POINTS] } else { Vec::new() };
        let all = [(&now, &x[..], &v[..]); POINTS];
        self.own.see(self.model, self.rule, &all, &asked);
    }

    fn contact_excess(&self, k: usize) -> f64 {
        let (s, w) = (self.h.sliding_displacement_m[k], self.h.sliding_velocity_m_per_s[k]);
        self.slider.contact_excess(self.contact(k), (s, w), self.slack(w))
    }

    /// What the rounding of times makes of a position at this speed, and of the force of the stop.
    fn slack(&self, w: f64) -> [f64; 2] {
        let slack_m = self.instant_s * w.abs() + 8.0 * f64::EPSILON * self.displacement[1];
        [slack_m, self.structure.stop_damper() * self.jolt]
    }

    /// Integrates from the knot `k` to the next.
    fn interval(&mut self, k: usize) -> Result<(), Stopped> {
        let modes = self.modes(k).to_vec();
        let b = self.between_knots(k, &modes);
        let (mut x, mut v) = self.stored(k);
        let (mut from_s, end_s) = (self.h.time_s[k], self.h.time_s[k + 1]);
        let rate = self.rate(k);
        let mut fastest = vec![0.0; self.degrees()];
        let mut normal = 0.0_f64;
        self.own.totals.add(&modes, b.contact, end_s - from_s, self.leans(k));
        if let Some(sliding) = &b.sliding {
            self.own.slides_on(self.h, k, sliding.active());
        }
        loop {
            let piece = self.ground.piece(from_s, end_s);
            let steps = (rate * (piece.to_s - from_s) / MAX_TURN).ceil().clamp(1.0, MOST_STEPS);
            let step_s = (piece.to_s - from_s) / steps;
            normal = normal.max(piece.loads[0].normal_rounding(self.blur));
            for j in 0..steps as usize {
                self.pulse.beat(self.units)?;
                let loads = [j, j + 1].map(|j| between(piece.loads, j as f64 / steps));
                let at_s = from_s + j as f64 * step_s;
                self.step((k, &b), at_s, step_s, loads, (&mut x, &mut v), &mut fastest);
            }
            from_s = piece.to_s;
            if from_s >= end_s {
                break;
            }
        }
        let (to_x, to_v) = self.stored(k + 1);
        let [drift_m, drift] = self.drift(k, normal, (&x, &fastest));
        for i in 0..self.degrees() {
            let off = (x[i] - to_x[i]).abs() - self.instant_s * fastest[i] - drift_m;
            self.displacement[0] = larger(self.displacement[0], excess(off));
            let off = (v[i] - to_v[i]).abs() - self.instant_s * self.own.jerked(i) - drift;
            self.velocity[0] = larger(self.velocity[0], excess(off));
        }
        if let Some(sliding) = &b.sliding {
            let own = sliding.displacements(self.h.surface_displacements(k), x[0] - b.from_m);
            for (own, stored) in own.iter().zip(self.h.surface_displacements(k + 1)) {
                let off = (own - stored).abs() - self.instant_s * fastest[0] - drift_m;
                self.displacement[0] = larger(self.displacement[0], excess(off));
            }
            let normal = self.ground.instant(end_s)[0].normal;
            let broken = self.slider.series_excess(sliding, &own, x[0] - b.from_m);
            self.excess = larger(self.excess, excess(normal * broken));
            self.arriving = Some((sliding.clone(), b.from_m));
        } else {
            let stuck = self.h.surface_displacements(k).iter();
            for (own, stored) in stuck.zip(self.h.surface_displacements(k + 1)) {
                self.displacement[0] = larger(self.displacement[0], own - stored);
            }
        }
        Ok(())
    }

    /// What the rounding of `N` by so much makes of places and velocities in the interval from the knot
    /// `k` to a place, and of its energies.
    fn drift(&mut self, k: usize, normal: f64, (x, fastest): (&[f64], &[f64])) -> [f64; 2] {
        if normal == 0.0 {
            return [0.0; 2];
        }
        let length_s = self.h.time_s[k + 1] - self.h.time_s[k];
        let least_kg =
            self.structure.masses_kg.iter().fold(self.structure.block_kg, |a, b| a.min(*b));
        let (from, n) = (self.stored(k).0, self.floors());
        let (mut force, mut work) = (0.0, 0.0);
        for (i, mu) in self.sliding_friction(k).enumerate() {
            let at = if i == 0 { 0 } else { n + i };
            force += mu * normal;
            work += mu * normal * (x[at] - from[at]).abs();
        }
        let drift = force / least_kg * length_s;
        let speed: f64 = fastest.iter().sum();
        self.energy.blur(work + self.structure.total_kg * speed * drift);
        let drift_m = 0.5 * length_s * drift;
        self.drift = [larger(self.drift[0], drift_m), larger(self.drift[1], drift)];
        [drift_m, drift]
    }

    /// Whether the block rests against a rigid stop.
    fn leans(&self, k: usize) -> bool {
        let s = self.h.sliding_displacement_m[k];
        self.slider.leans(s, 8.0 * f64::EPSILON * self.displacement[1]) != [false; 2]
    }

    /// One collocation step.
    fn step(
        &mut self,
        (k, b): (usize, &Between<'_>),
        from_s: f64,
        step_s: f64,
        loads: [Load; 2],
        (x, v): (&mut Vec<f64>, &mut Vec<f64>),
        fastest: &mut [f64],
    ) {
        let (d, rule) = (self.degrees(), self.rule);
        let mut room = core::mem::take(&mut self.room);
        let Room { first, nodes, end, before } = &mut room;
        first.x.clone_from(x);
        first.v.clone_from(v);
        self.find(b, &loads[0], (x, v), &mut first.now);
        for node in nodes.iter_mut() {
            node.now.rate.clone_from(&first.now.rate);
            node.x.resize(d, 0.0);
            node.v.resize(d, 0.0);
        }
        let size = self.own.most_jerked();
        let mut last = f64::INFINITY;
        for pass in 0..MOST_PASSES {
            let mut change: f64 = 0.0;
            // Each node takes what those before it have found in this pass.
            for i in 0..NODES {
                follow(rule, (i, step_s), nodes, (x, v));
                let Node { now, x, v } = &mut nodes[i];
                before.clone_from(&now.rate);
                self.find(b, &between(loads, rule.c[i]), (x, v), now);
                for (new, old) in now.rate.iter().zip(&*before) {
                    change = change.max((new - old).abs());
                }
            }
            // The next pass would gain as much as this one; a change that no longer shrinks is rounding.
            let next = change * (change / last);
            if change == 0.0
                || (pass > 0 && next <= 0.5 * f64::EPSILON * size)
                || (change >= 0.5 * last && change <= ROUNDING * size)
            {
                break;
            }
            last = change;
        }
        // The last pass has changed the rates that the first nodes were placed by.
        for i in 0..NODES {
            follow(rule, (i, step_s), nodes, (x, v));
        }
        for c in 0..d {
            let (mut along, mut twice) = (0.0, 0.0);
            for (j, node) in nodes.iter().enumerate() {
                let rate = node.now.rate[c];
                along += rule.weights[j] * rate;
                twice += rule.weights[j] * (1.0 - rule.c[j]) * rate;
            }
            x[c] += step_s * (v[c] + step_s * twice);
            v[c] += step_s * along;
        }
        self.find(b, &loads[1], (x, v), end);
        self.spend(b, step_s, loads, nodes);
        for (i, fastest) in fastest.iter_mut().enumerate() {
            let all = nodes.iter().map(|node| node.v[i].abs());
            *fastest = all.fold(fastest.max(first.v[i].abs()).max(v[i].abs()), f64::max);
        }
        // A slip may have no velocity at any knot.
        self.sliding_m_per_s = self.sliding_m_per_s.max(fastest[0]);
        self.velocity[1] = fastest.iter().fold(self.velocity[1], |most, v| most.max(*v));
        let all: [(&Now, &[f64], &[f64]); POINTS] = core::array::from_fn(|i| {
            let node = match i {
                0 => &*first,
                i if i <= NODES => &nodes[i - 1],
                _ => return (&*end, &x[..], &v[..]),
            };
            (&node.now, &node.x[..], &node.v[..])
        });
        let surfaces = self.h.surface_displacements(k);
        let asked: Vec<law::Asked> = match b.modes[0] {
            Mode::Stick => all
                .iter()
                .zip(rule.points)
                .map(|((now, x, _), t)| {
                    self.holds(now, (x[0], surfaces), (0, true), &between(loads, t))
                })
                .collect(),
            Mode::Slip(_) => Vec::new(),
        };
        self.judge_step((k, b), from_s, step_s, loads, &all);
        self.own.see(self.model, rule, &all, &asked);
        self.own.totals.path(b.modes, &first.x, x, self.floors());
        self.room = room;
    }

    /// Judges the inequalities at the points of a step.
    fn judge_step(
        &mut self,
        (k, b): (usize, &Between<'_>),
        from_s: f64,
        step_s: f64,
        loads: [Load; 2],
        all: &[(&Now, &[f64], &[f64])],
    ) {
        let (n, surfaces) = (self.floors(), self.h.surface_displacements(k));
        for (i, mode) in b.modes.iter().enumerate() {
            let at = if i == 0 { 0 } else { n + i };
            // Margin in stick, speed in slip.
            let mut near = [f64::NAN; POINTS];
            for (point, (now, x, v)) in all.iter().enumerate() {
                let t = self.rule.points[point];
                let load = between(loads, t);
                match mode {
                    Mode::Stick => {
                        let asked = self.holds(now, (x[0], surfaces), (i, true), &load);
                        let beyond = asked.beyond() - self.asked_rounding(now, i, &load);
                        self.excess = larger(self.excess, excess(beyond));
                        near[point] = asked.margin().unwrap_or(f64::NAN);
                    }
                    Mode::Slip(direction) => {
                        near[point] = direction.sign() * v[at];
                        let blur = self.still() + self.instant_s * self.own.jerked(at);
                        if near[point] < -blur {
                            let force = self.slider.scale(load.normal, self.model.weight_n());
                            self.excess = larger(self.excess, force);
                        }
                        if i == 0 {
                            let broken = self.slider.contact_excess(
                                b.contact,
                                (x[0], v[0]),
                                self.slack(v[0]),
                            );
                            self.excess = larger(self.excess, broken);
                            if let Some(beyond) = self.slider.beyond_walls(x[0]) {
                                let off = beyond - self.instant_s * v[0].abs();
                                self.displacement[0] = larger(self.displacement[0], excess(off));
                            }
                        }
                    }
                }
            }
            if near.iter().any(|value| value.is_nan()) {
                self.dips[i].interrupt();
            } else {
                self.dips[i].feed_points(self.rule, (from_s, step_s), &near);
            }
        }
    }

    /// Adds up work and losses of a step.
    fn spend(&mut self, b: &Between<'_>, step_s: f64, loads: [Load; 2], nodes: &[Node]) {
        let n = self.floors();
        let (mut work, mut size, mut damping, mut friction) = (0.0, 0.0, 0.0, 0.0);
        for i in 0..NODES {
            let weight = step_s * self.rule.weights[i];
            let load = between(loads, self.rule.c[i]);
            let Node { now, x, v } = &nodes[i];
            let mut momentum = self.structure.block_kg * v[0];
            for j in 0..n {
                momentum += self.structure.masses_kg[j] * (v[0] + v[1 + j]);
            }
            for (e, contents) in self.contents.iter().enumerate() {
                let floor = if contents.floor == 0 { 0.0 } else { v[contents.floor] };
                momentum += contents.mass_kg * (v[0] + floor + v[1 + n + e]);
                if let Mode::Slip(direction) = b.modes[1 + e] {
                    let press = load.normal / self.structure.total_kg;
                    let force = contents.kinetic_friction * contents.mass_kg * press;
                    friction += weight * force * direction.sign() * v[1 + n + e];
                }
            }
            let power = -momentum * load.a;
            work += weight * power;
            size += weight * power.abs();
            damping += weight * (self.structure.dissipation(&v[..=n]) + now.stop * v[0]);
            if b.modes[0] != Mode::Stick {
                // The spring of a pendulum follows the normal force: its work counts as friction's, and
                // what it gives back is work put in.
                let loss = (self.slider.pendulum(x[0], load.normal) - now.friction) * v[0];
                friction += weight * loss;
                size += weight * excess(-loss);
            }
        }
        self.energy.spend(work, size, damping, friction);
    }

    fn kinetic(&self, v: &[f64]) -> f64 {
        let n = self.floors();
        let contents = self.contents.iter().enumerate().map(|(e, contents)| {
            let floor = if contents.floor == 0 { 0.0 } else { v[contents.floor] };
            let speed = v[0] + floor + v[1 + n + e];
            0.5 * contents.mass_kg * speed * speed
        });
        self.structure.kinetic(&v[..=n]) + contents.sum::<f64>()
    }

    /// Strain energy; of a pendulum under vertical motion there is none.
    fn strain(&self, x: &[f64]) -> f64 {
        let mut own = x[..=self.floors()].to_vec();
        if self.slider.is_pendulum() {
            own[0] = 0.0;
        }
        self.structure.strain(&own)
    }

    fn nearest(&mut self, call: ClosestCall) {
        let call = ClosestCall { margin: call.margin.abs(), ..call };
        if self.closest.is_none_or(|closest| call.margin < closest.margin) {
            self.closest = Some(call);
        }
    }

    /// A sliding velocity without a sign, in m/s.
    fn still(&self) -> f64 {
        STILL * self.sliding_m_per_s + 64.0 * f64::EPSILON * self.velocity[1]
    }

    fn fresh_dips(&self, k: usize, i: usize) -> Dips {
        Dips::new(if self.modes(k)[i] == Mode::Stick { 1e-12 } else { self.still() })
    }

    /// Ends a phase of an interface: its near decisions are known.
    fn close(&mut self, i: usize, mode: Mode) {
        let drops = |direction| match i.checked_sub(1) {
            None => self.slider.drops(direction),
            Some(e) => self.contents[e].static_friction > self.contents[e].kinetic_friction,
        };
        let call = match mode {
            Mode::Stick => self.dips[i].least(i),
            Mode::Slip(direction) if drops(direction) => self.dips[i].least_of_peak(i),
            Mode::Slip(_) => None,
        };
        if let Some(call) = call {
            self.nearest(call);
        }
    }
}
