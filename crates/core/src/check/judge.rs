//! Goes through the knots of a history and keeps the worst of everything.

use fearless_simd::{Level, dispatch};

use super::collocation::{MAX_TURN, POINTS, Rule};
use super::demands::{self, Rounding, Totals};
use super::energy::Energy;
use super::events::Events;
use super::ground::{Ground, Load, between};
use super::group::{
    Course, Feed, Group, Key, Maps, Pass, Points, Spent, Spread, UNBOUNDED, Watch, Work,
};
use super::knots::{Acting, Knots, LaneJudge, Sizes, Worst};
use super::law::{Law, Sliding};
use super::near::{Dips, dip};
use super::outputs::{BLOCK, Outputs, STOREYS, VELOCITY};
use super::structure::{Phase, Structure, excess, larger};
use super::{Certificate, ClosestCall};
use crate::error::Stopped;
use crate::model::Model;
use crate::motion::GroundMotion;
use crate::progress::{Pulse, UNWATCHED};
use crate::response::{Contact, History, Mode, Response};
use crate::slider::Direction;

/// A sliding velocity below this part of its peak has no sign: the depth of a dip through zero that
/// the exact method may miss.
const STILL: f64 = 1e-12;
/// Most kinds of intervals that are judged by maps.
const MOST_KEYS: usize = 16;
/// Buckets of intervals by the power of two of their steps.
const BUCKETS: usize = 34;

/// Largest defects so far, each with the scale it is measured by.
#[derive(Default)]
pub(super) struct Figures {
    pub(super) displacement: [f64; 2],
    pub(super) velocity: [f64; 2],
    force: [f64; 2],
    table: [f64; 2],
    pub(super) excess: f64,
}

impl Figures {
    /// Takes the worst of all lanes.
    fn take(&mut self, worst: &Worst) {
        for (figure, lanes) in [
            (&mut self.displacement, &worst.displacement),
            (&mut self.velocity, &worst.velocity),
            (&mut self.force, &worst.force),
        ] {
            *figure = [0, 1].map(|i| larger(figure[i], lanes[i].largest()));
        }
        self.table[0] = larger(self.table[0], worst.table.largest());
        self.excess = larger(self.excess, worst.excess.largest());
    }
}

/// The largest defect over its scale, where `pair` is `[defect, scale]`.
fn relative(pair: [f64; 2]) -> f64 {
    if pair[0] == 0.0 { 0.0 } else { pair[0] / pair[1] }
}

/// Intervals of one key: even ones by maps, odd ones by their equations.
struct Kind {
    key: Key,
    even: Group,
    odd: Group,
    maps: Option<Maps>,
    spread: Spread,
}

/// Figures of all intervals.
struct IntervalFigures {
    spent: Vec<Spent<f64>>,
    /// One an interface.
    watch: Vec<Watch<f64>>,
}

pub(super) struct Judge<'a> {
    pub(super) model: &'a Model,
    response: &'a Response,
    pub(super) h: &'a History,
    pub(super) structure: &'a Structure,
    pub(super) law: &'a Law,
    pub(super) ground: Ground<'a>,
    /// Largest `N` and `|Ü|`.
    pub(super) largest: (f64, f64),
    outputs: Outputs,
    /// Largest sizes of the outputs.
    attained: Vec<f64>,
    rates: [f64; 3],
    /// Velocities below this are zero to within rounding.
    still: f64,
    /// Rounding of a time.
    pub(super) instant_s: f64,
    /// What it makes of a force at an event at most.
    pub(super) unsure_n: f64,
    /// Velocity that the largest acceleration gives in that time.
    jolt: f64,
    /// What the rounding of `N` makes of places and velocities in an interval.
    drift: [f64; 2],
    pub(super) figures: Figures,
    energy: Energy,
    /// Near decisions of the phases under way, by interface.
    dips: Vec<Dips>,
    closest: Option<ClosestCall>,
    /// A margin that the closest call has at most.
    floor: f64,
    pub(super) totals: Totals,
    events: Events,
    /// Step of most intervals of the motion.
    even_s: f64,
    longest_s: f64,
    /// Intervals judged by maps so far.
    #[cfg(test)]
    by_maps: usize,
    pub(super) level: Level,
    /// Asks whether to go on.
    pulse: Pulse<'a>,
}

impl<'a> Judge<'a> {
    pub(super) fn new(
        model: &'a Model,
        motion: &'a GroundMotion,
        (response, history): (&'a Response, &'a History),
        (structure, law): (&'a Structure, &'a Law),
        pulse: Pulse<'a>,
    ) -> Self {
        let end_s = history.time_s.last().copied().unwrap_or(0.0);
        let instant_s = 8.0 * f64::EPSILON * end_s;
        let ground = Ground::new(model, motion, end_s);
        let largest = ground.largest(end_s);
        let relative = || {
            let tables = history.table_acceleration_m_per_s2.iter();
            let pairs = history.block_acceleration_m_per_s2.iter().zip(tables);
            pairs.fold(0.0, |most, (block, table)| (block - table).abs().max(most))
        };
        let relative = if law.rate.is_some() { relative() } else { 0.0 };
        let added = law.added_rate(largest.0 / structure.block_kg, relative);
        let rate = |phase| structure.rate(phase) + if phase == Phase::Stick { 0.0 } else { added };
        let interfaces = 1 + structure.contents.len();
        let outputs = Outputs::new(model);
        Self {
            model,
            response,
            h: history,
            structure,
            law,
            ground,
            largest,
            attained: vec![0.0; outputs.len()],
            outputs,
            rates: [Phase::Stick, Phase::Slip, Phase::Pressed].map(rate),
            still: 0.0,
            instant_s,
            unsure_n: 0.0,
            jolt: 0.0,
            drift: [0.0; 2],
            figures: Figures::default(),
            energy: Energy::default(),
            dips: vec![Dips::new(0.0); interfaces],
            closest: None,
            floor: f64::INFINITY,
            totals: Totals::new(interfaces),
            events: Events::default(),
            even_s: common_step(motion.times_s(), 2.0 * instant_s),
            longest_s: history.time_s.windows(2).map(|t| t[1] - t[0]).fold(0.0, f64::max),
            #[cfg(test)]
            by_maps: 0,
            level: Level::new(),
            pulse,
        }
    }

    /// What the lanes need.
    pub(super) fn bench(&self) -> LaneJudge<'a> {
        LaneJudge {
            structure: self.structure,
            rule: Rule::get(),
            history: self.h,
            law: self.law,
            slope: self.model.slope_m_per_s2(),
            instant_s: self.instant_s,
            vertical: self.ground.has_vertical(),
        }
    }

    /// Looks at every knot by itself: the balance of forces, scales, energies and outputs. `None`
    /// where something stored is not finite.
    fn knots(&mut self) -> Result<Option<Knots>, Stopped> {
        let h = self.h;
        let (mut stop, mut held) = (Vec::new(), Vec::new());
        if self.model.stop().is_some() && self.law.restitution().is_none() {
            let at = |k: usize| (h.sliding_displacement_m[k], h.sliding_velocity_m_per_s[k]);
            let force = |k: usize| self.law.push(self.contact(k)).force(at(k).0, at(k).1);
            stop.extend((0..h.len()).map(force));
        }
        if self.law.is_pendulum() {
            held = vec![1.0; h.len()];
        } else if self.law.restitution().is_some() {
            // Sliding, the block has left the stop or not yet struck it.
            let leans = |k: usize| {
                let s = h.sliding_displacement_m[k];
                h.modes(k)[0] == Mode::Stick && self.law.leans(s) != [false; 2]
            };
            held.extend((0..h.len()).map(|k| if leans(k) { 1.0 } else { 0.0 }));
        }
        // At the start and at the end both sides of a jump last.
        let passed = |k: &usize| h.time_s[k + 1] == h.time_s[*k] && h.time_s[k - 1] == h.time_s[*k];
        let passed: Vec<usize> = (1..h.len().saturating_sub(1)).filter(passed).collect();
        let mut worst = Worst::NONE;
        let mut knots = Knots::new(h.len(), self.outputs.len());
        let mut pulse = core::mem::replace(&mut self.pulse, Pulse::new(UNWATCHED));
        let (bench, outputs) = (self.bench(), &self.outputs);
        let acting = Acting { stop: &stop, held: &held, passed: &passed };
        let to = (&mut knots, &mut pulse);
        dispatch!(self.level, simd => bench.knots(simd, outputs, &mut worst, acting, to))?;
        self.pulse = pulse;
        if worst.broken.0.iter().any(|x| x.is_nan())
            || !h.surface_displacement_m.iter().all(|u| u.is_finite())
        {
            return Ok(None);
        }
        self.attained.copy_from_slice(&knots.attained);
        let Sizes { place, storey, rate, table } = worst.sizes;
        let [place, storey, rate, table] = [place, storey, rate, table].map(|all| all.largest());
        let (sliding, block) = (self.attained[VELOCITY], self.attained[BLOCK]);
        let speed = sliding.max(rate);
        // A frame held at rest by its weight on a slope moves by rounding alone: its velocities
        // are measured by the static displacement, not by themselves.
        let rest = 1e-4 * self.structure.frame_frequency() * storey;
        // What the rounding of a time makes of the largest acceleration is no motion either.
        self.jolt = self.instant_s * block.max(table);
        let f = &mut self.figures;
        f.displacement[1] = storey.max(place).max(self.instant_s * self.jolt);
        f.velocity[1] = speed.max(rest).max(self.jolt);
        self.still = STILL * sliding + 64.0 * f64::EPSILON * speed;
        f.take(&worst);
        if self.model.stop().is_some() {
            for k in 0..h.len() {
                let at = (h.sliding_displacement_m[k], h.sliding_velocity_m_per_s[k]);
                let broken = self.law.contact_excess(self.contact(k), at, self.slack(at.1));
                self.figures.excess = larger(self.figures.excess, broken);
                let beyond = self.law.beyond_walls(at.0);
                self.figures.displacement[0] = larger(self.figures.displacement[0], beyond);
            }
        }
        // Surfaces in series make up s, within their travels.
        for k in 0..if h.surfaces > 0 { h.len() } else { 0 } {
            let surfaces = h.surface_displacements(k);
            let off = surfaces.iter().sum::<f64>() - h.sliding_displacement_m[k];
            for off in [off, self.law.beyond_ends(surfaces)] {
                self.figures.displacement[0] = larger(self.figures.displacement[0], off);
            }
        }
        Ok(Some(knots))
    }

    /// Judges everything; `None` where something stored is not finite.
    pub(super) fn run(mut self, bound: f64) -> Result<Option<Certificate>, Stopped> {
        let Some(mut all) = self.knots()? else { return Ok(None) };
        let (h, knots) = (self.h, self.h.len());
        self.start();
        let stop_j = self.law.push(self.contact(0)).strain(h.sliding_displacement_m[0]);
        let initial_j = all.kinetic_j[0] + all.strain_j[0] + stop_j;
        let rounding_j = self.model.total_mass_kg() * self.jolt * self.jolt;
        self.energy.start(initial_j, stop_j, rounding_j, knots);
        self.decide();
        self.find_floor();
        let intervals = self.side_by_side(&all)?;
        let near = self.look_again(&all, &intervals)?;
        self.in_order(&all, &intervals, &near);
        for list in [&mut all.kinetic_j, &mut all.strain_j] {
            list.truncate(knots);
        }
        self.energy.history.kinetic_j = all.kinetic_j;
        self.energy.history.strain_j = all.strain_j;
        Ok(Some(self.certificate(bound)))
    }

    /// Contact with the stop at a knot.
    pub(super) fn contact(&self, k: usize) -> Contact {
        self.h.contact.get(k).copied().unwrap_or(Contact::Free)
    }

    /// What the rounding of times makes of a position at this speed, and of the force of the stop.
    pub(super) fn slack(&self, w: f64) -> [f64; 2] {
        let slack_m = self.instant_s * w.abs() + 8.0 * f64::EPSILON * self.figures.displacement[1];
        [slack_m, self.structure.stop_damper() * self.jolt]
    }

    /// Displacement and velocity of a degree at a knot.
    pub(super) fn stored(&self, k: usize, degree: usize) -> [f64; 2] {
        let (h, n) = (self.h, self.h.storeys);
        match degree {
            0 => [h.sliding_displacement_m[k], h.sliding_velocity_m_per_s[k]],
            i if i <= n => [h.storey_displacements(k)[i - 1], h.storey_velocities(k)[i - 1]],
            i => {
                let [r, p, _] = h.contents_state(k, i - 1 - n);
                [r, p]
            }
        }
    }

    /// Compares the stored state of a knot with another, degree by degree.
    pub(super) fn compare(&mut self, k: usize, other: impl Fn(usize) -> [f64; 2]) {
        for i in 0..self.structure.degrees() {
            let ([x, v], [own_x, own_v]) = (self.stored(k, i), other(i));
            self.figures.displacement[0] = larger(self.figures.displacement[0], x - own_x);
            self.figures.velocity[0] = larger(self.figures.velocity[0], v - own_v);
        }
    }

    /// The first knot has the model's initial state.
    fn start(&mut self) {
        let initial = self.model.initial();
        let mut x = vec![initial.sliding_displacement_m];
        x.extend(self.model.initial_storey_displacement_m());
        let mut v = vec![initial.sliding_velocity_m_per_s];
        v.extend(self.model.initial_storey_velocity_m_per_s());
        let at = |list: &[f64], i: usize| list.get(i).copied().unwrap_or(0.0);
        self.compare(0, |i| [at(&x, i), at(&v, i)]);
    }

    /// Modes before the first knot: a block with a velocity slides on.
    pub(super) fn modes_at_start(&self) -> Vec<Mode> {
        let mut modes = vec![Mode::Stick; self.h.interfaces];
        if self.model.initial().sliding_velocity_m_per_s != 0.0 {
            modes[0] = self.h.mode[0];
        }
        modes
    }

    /// How a slip of surfaces in series goes on from a knot.
    pub(super) fn sliding(&self, k: usize, mode: Mode) -> Option<Sliding> {
        let Mode::Slip(direction) = mode else { return None };
        self.law.series.as_ref()?;
        let mut ways = self.law.slidings(self.h.surface_displacements(k), direction);
        // The force that is stored tells that a surface has left its end.
        let place = if ways.len() > 1 {
            let (loads, found) =
                (self.ground.instant(self.h.time_s[k]), self.h.friction_force_n[k]);
            let suits = |way: &Sliding| {
                let off = |load: &Load| (load.normal * way.force(0.0) + found).abs();
                let least = loads.iter().map(off).fold(f64::INFINITY, f64::min);
                least <= STILL * self.model.weight_n()
            };
            ways.iter().position(suits).unwrap_or(0)
        } else {
            0
        };
        (!ways.is_empty()).then(|| ways.swap_remove(place))
    }

    /// What is in force from a knot on in modes.
    pub(super) fn course<'m>(&self, k: usize, modes: &'m [Mode], feed: Feed) -> Course<'m> {
        let s = self.h.sliding_displacement_m[k];
        let (mut friction, mut hold) = ([0.0; 2], [0.0; 2]);
        let mut taken = [-UNBOUNDED, UNBOUNDED];
        let mut slides = 0.0;
        match modes[0] {
            Mode::Stick => {
                hold = self.law.hold(self.h.surface_displacements(k));
                let free = hold;
                let [positive, negative] = self.law.leans(s);
                if positive {
                    (hold[0], taken[0]) = (-UNBOUNDED, free[0]);
                }
                if negative {
                    (hold[1], taken[1]) = (UNBOUNDED, free[1]);
                }
            }
            Mode::Slip(direction) => {
                friction = match self.sliding(k, modes[0]) {
                    Some(sliding) => sliding.friction(s),
                    None => [self.law.sliding_load(direction), 0.0],
                };
                slides += self.law.most();
            }
        }
        for (mode, contents) in modes[1..].iter().zip(&self.structure.contents) {
            if *mode != Mode::Stick {
                slides += contents.kinetic_friction;
            }
        }
        let push = self.law.push(self.contact(k));
        Course { knot: k, modes, friction, push, hold, taken, slides, feed }
    }

    /// The interval from a knot to the next.
    fn interval(&mut self, k: usize) -> Course<'a> {
        let h = self.h;
        let modes = h.modes(k);
        let phase = match (modes[0], self.contact(k)) {
            (Mode::Stick, _) => Phase::Stick,
            (_, Contact::Pressed(_)) => Phase::Pressed,
            _ => Phase::Slip,
        };
        let times_s = [h.time_s[k], h.time_s[k + 1]];
        let feed = Feed::new(&mut self.ground, times_s, self.rates[phase as usize]);
        if !self.ground.is_at_sample(times_s[0]) {
            let rounding = self.rounding(0, self.structure.total_kg, &feed.loads()[0]);
            self.unsure_n = larger(self.unsure_n, rounding);
        }
        self.course(k, modes, feed)
    }

    /// The key of an interval whose path is a linear map of its inputs.
    fn key(&self, course: &Course<'_>) -> Option<Key> {
        let slips = course.modes[0] != Mode::Stick;
        if !course.feed.is_single() || course.modes.len() > 64 || slips && self.law.rate.is_some() {
            return None;
        }
        let per_n = course.friction[1] + self.law.curvature_per_m();
        let [from, to] = course.feed.loads().map(|load| load.normal * per_n);
        let [stiffness, damper, _] = course.push.numbers();
        let stuck = course.modes.iter().enumerate().filter(|(_, mode)| **mode == Mode::Stick);
        let stuck = stuck.fold(0, |bits, (i, _)| bits | 1 << i);
        (from == to).then_some(Key { stuck, push: [stiffness, damper], rise: from })
    }

    /// Judges all intervals eight at a time; looks for peaks where there may be some.
    fn side_by_side(&mut self, knots: &Knots) -> Result<IntervalFigures, Stopped> {
        let (h, bench) = (self.h, self.bench());
        let interfaces = h.interfaces;
        let mut intervals = IntervalFigures {
            spent: vec![Spent::default(); h.len()],
            watch: vec![Watch::default(); h.len() * interfaces],
        };
        let mut worst = Worst::NONE;
        let mut work = Work::new(&bench, self.outputs.len());
        let mut kinds: Vec<Kind> = Vec::new();
        let mut rest: Vec<Option<Group>> = (0..BUCKETS).map(|_| None).collect();
        for k in 0..h.len() - 1 {
            let length_s = h.time_s[k + 1] - h.time_s[k];
            if !(length_s > 0.0) {
                continue;
            }
            let course = self.interval(k);
            let steps = course.feed.steps();
            let kind = self.key(&course).and_then(|key| {
                let place = kinds.iter().position(|kind| kind.key == key);
                place.or_else(|| {
                    let made =
                        (kinds.len() < MOST_KEYS).then(|| self.kind(key, &course, &mut work));
                    kinds.extend(made);
                    kinds.len().checked_sub(1).filter(|&i| kinds[i].key == key)
                })
            });
            match kind {
                Some(i) => {
                    let kind = &mut kinds[i];
                    let even = (length_s - self.even_s).abs() <= 2.0 * self.instant_s;
                    let even = even && kind.maps.is_some();
                    let group = if even { &mut kind.even } else { &mut kind.odd };
                    if group.push(&bench, &course) {
                        let maps = kind.maps.as_ref().filter(|_| even);
                        let how = (maps, Some(&kind.spread));
                        self.flush(
                            &bench,
                            group,
                            how,
                            knots,
                            (&mut work, &mut worst),
                            &mut intervals,
                        )?;
                    }
                }
                None => {
                    let bucket = (usize::BITS - steps.leading_zeros()) as usize;
                    let bucket = if course.feed.is_single() { bucket } else { BUCKETS - 1 };
                    let group =
                        rest[bucket.min(BUCKETS - 1)].get_or_insert_with(|| Group::new(&bench));
                    if group.push(&bench, &course) {
                        let to = (&mut work, &mut worst);
                        self.flush(&bench, group, (None, None), knots, to, &mut intervals)?;
                    }
                }
            }
        }
        for kind in &mut kinds {
            let spread = Some(&kind.spread);
            for (group, maps) in [(&mut kind.even, kind.maps.as_ref()), (&mut kind.odd, None)] {
                let to = (&mut work, &mut worst);
                self.flush(&bench, group, (maps, spread), knots, to, &mut intervals)?;
            }
        }
        for group in rest.iter_mut().flatten() {
            let to = (&mut work, &mut worst);
            self.flush(&bench, group, (None, None), knots, to, &mut intervals)?;
        }
        self.figures.take(&worst);
        self.drift = worst.drift.map(|drift| drift.largest());
        self.still = (STILL * worst.sliding.largest()).max(self.still);
        Ok(intervals)
    }

    /// Groups of a key with the maps of the even step, where there is one, and bounds on the outputs.
    fn kind(&self, key: Key, course: &Course<'_>, work: &mut Work) -> Kind {
        let bench = self.bench();
        let rate = course.feed.rate();
        let turn = rate * self.even_s;
        let steps = if turn > MAX_TURN { libm::ceil(turn / MAX_TURN * (1.0 - 1e-9)) } else { 1.0 };
        let even_s = (!self.even_s.is_nan()).then(|| self.even_s / steps);
        let longest_s = if rate > 0.0 { MAX_TURN / rate } else { f64::INFINITY };
        let longest_s = longest_s.min(self.longest_s / steps);
        let (level, outputs) = (self.level, &self.outputs);
        let (maps, spread) = dispatch!(level, simd => {
            bench.maps(simd, (&key, outputs), (even_s, longest_s), work)
        });
        Kind { key, even: Group::new(&bench), odd: Group::new(&bench), maps, spread }
    }

    fn pass<'p>(
        &'p mut self,
        knots: &'p Knots,
        work: &'p mut Work,
        worst: &'p mut Worst,
    ) -> Pass<'p, 'a> {
        Pass {
            ground: &mut self.ground,
            outputs: &self.outputs,
            attained: &mut self.attained,
            knots,
            work,
            worst,
            pulse: &mut self.pulse,
        }
    }

    /// Judges a group and empties it.
    fn flush(
        &mut self,
        bench: &LaneJudge<'_>,
        group: &mut Group,
        (maps, spread): (Option<&Maps>, Option<&Spread>),
        knots: &Knots,
        (work, worst): (&mut Work, &mut Worst),
        intervals: &mut IntervalFigures,
    ) -> Result<(), Stopped> {
        if group.count == 0 {
            return Ok(());
        }
        group.fill();
        #[cfg(test)]
        if maps.is_some() {
            self.by_maps += group.count;
        }
        let level = self.level;
        let mut pass = self.pass(knots, work, worst);
        dispatch!(level, simd => bench.group(simd, group, (maps, spread), &mut pass))?;
        for lane in 0..group.count {
            let k = group.knot(lane);
            intervals.spent[k] = work.spent.lane(lane);
            let watch = work.watch.iter().map(|watch| watch.lane(lane));
            let own = &mut intervals.watch[k * self.h.interfaces..][..self.h.interfaces];
            for (own, watch) in own.iter_mut().zip(watch) {
                *own = watch;
            }
        }
        group.count = 0;
        Ok(())
    }

    /// Looks at maxima of the demand at knots, beside the decisions already made: only what comes closer
    /// is worth a search between knots.
    fn find_floor(&mut self) {
        let h = self.h;
        self.floor = self.closest.map_or(f64::INFINITY, |call| call.margin);
        if self.ground.has_vertical() || self.law.series.is_some() {
            return;
        }
        let [low, high] = self.law.hold(&[]).map(|per_n| per_n * self.largest.0);
        let margin = |k: usize| {
            let demand = h.friction_force_n[k];
            let bound = if demand > 0.0 { high } else { -low };
            (bound > 0.0).then(|| 1.0 - demand.abs() / bound)
        };
        let free = |k: usize| h.contact.get(k).is_none_or(|contact| *contact == Contact::Free);
        let sticks = |k: usize| h.modes(k)[0] == Mode::Stick && free(k);
        for k in 1..h.len().saturating_sub(1) {
            if !(sticks(k - 1) && sticks(k) && sticks(k + 1)) {
                continue;
            }
            if let (Some(before), Some(here), Some(after)) =
                (margin(k - 1), margin(k), margin(k + 1))
                && here <= before
                && here <= after
            {
                // The demand has a maximum of this size or a larger one next to it.
                self.floor = self.floor.min(here.max(0.0) + 1e-9);
            }
        }
    }

    /// The largest speed of an interface.
    fn speed(&self, i: usize) -> f64 {
        match i.checked_sub(1) {
            None => self.attained[VELOCITY],
            Some(e) => self.attained[STOREYS + 3 * self.h.storeys + e],
        }
    }

    /// Whether an interface could stick where it slides, without slowing down to it smoothly.
    fn drops(&self, i: usize, direction: Direction) -> bool {
        match i.checked_sub(1).map(|e| &self.structure.contents[e]) {
            None => self.law.drops(direction),
            Some(contents) => contents.static_friction > contents.kinetic_friction,
        }
    }

    /// Whether the points of an interval are needed: a decision may have been closer than any so far, or
    /// a law is broken.
    fn is_near(&self, k: usize, intervals: &IntervalFigures) -> bool {
        let h = self.h;
        let watch = &intervals.watch[k * h.interfaces..][..h.interfaces];
        let contact = self.contact(k) != Contact::Free && h.modes(k)[0] != Mode::Stick;
        let near = |(i, (watch, mode)): (usize, (&Watch<f64>, &Mode))| match mode {
            Mode::Stick => !(watch.least >= 0.0) || watch.low < self.floor,
            Mode::Slip(direction) => {
                let floor = self.floor * self.speed(i);
                let wrong = !(watch.least.min(watch.low) >= -self.still);
                wrong || self.drops(i, *direction) && watch.low < floor
            }
        };
        contact || watch.iter().zip(h.modes(k)).enumerate().any(near)
    }

    /// The points of intervals in which a decision may have been close, in order of time.
    fn look_again(
        &mut self,
        knots: &Knots,
        intervals: &IntervalFigures,
    ) -> Result<Vec<Points>, Stopped> {
        let (h, bench) = (self.h, self.bench());
        let mut found = Vec::new();
        let mut work = Work::new(&bench, self.outputs.len());
        let mut worst = Worst::NONE;
        let mut group = Group::new(&bench);
        for k in 0..h.len() {
            let last = k + 1 == h.len();
            let full = if !last && h.time_s[k + 1] > h.time_s[k] && self.is_near(k, intervals) {
                let course = self.interval(k);
                group.push(&bench, &course)
            } else {
                false
            };
            if full || last && group.count > 0 {
                group.fill();
                let level = self.level;
                let mut pass = self.pass(knots, &mut work, &mut worst);
                dispatch!(level, simd => {
                    bench.points(simd, &mut group, &mut pass, &mut found)
                })?;
                group.count = 0;
            }
        }
        // Steps of one interval stand in their order.
        found.sort_by_key(|points| points.knot);
        Ok(found)
    }

    /// Goes through the knots in order of time: events, near decisions, energies, sums.
    fn in_order(&mut self, all: &Knots, intervals: &IntervalFigures, near: &[Points]) {
        let (h, knots) = (self.h, self.h.len());
        let before = self.modes_at_start();
        let [s, w] = self.stored(0, 0);
        self.events.begin(h, &before, self.law.contact_at_start(s, w));
        for i in 0..h.interfaces {
            self.dips[i] = self.fresh_dips(0, i);
        }
        let (mut arrives, mut near) = (false, near);
        for k in 0..knots {
            if k > 0 {
                self.join(k, !arrives);
            }
            self.energy.knot(all.kinetic_j[k], all.strain_j[k]);
            let leaves = k + 1 < knots && h.time_s[k + 1] > h.time_s[k];
            if leaves {
                let count = near.iter().take_while(|points| points.knot == k).count();
                let (own, later) = near.split_at(count);
                near = later;
                self.recall(k, intervals, own);
            } else if !arrives {
                self.alone(k);
            }
            arrives = leaves;
        }
        for (i, mode) in h.modes(knots - 1).iter().enumerate() {
            self.close(i, *mode);
        }
        for call in self.near_misses() {
            self.nearest(call);
        }
    }

    /// Passes from the knot before `k` to `k`; `abreast` where both have the same time.
    fn join(&mut self, k: usize, abreast: bool) {
        let h = self.h;
        let (before, after) = (h.modes(k - 1), h.modes(k));
        let struck = abreast && self.strikes(k);
        if abreast {
            if !struck {
                let other: Vec<[f64; 2]> =
                    (0..self.structure.degrees()).map(|i| self.stored(k - 1, i)).collect();
                self.compare(k, |i| other[i]);
            }
            let surfaces = h.surface_displacements(k).iter();
            for (a, b) in surfaces.zip(h.surface_displacements(k - 1)) {
                self.figures.displacement[0] = larger(self.figures.displacement[0], a - b);
            }
        }
        for i in 0..after.len() {
            if before[i] != after[i] {
                let [_, v] = self.stored(k, self.structure.degree_of(i));
                if !struck {
                    self.figures.velocity[0] = larger(self.figures.velocity[0], v);
                }
                self.close(i, before[i]);
                self.dips[i] = self.fresh_dips(k, i);
            }
        }
        if struck {
            let damping = self.lost_in_impact(k);
            self.energy.spend(&Spent { damping, ..Spent::default() });
        }
        if struck || before != after || !h.contact.is_empty() {
            self.events.pass(h, k, struck);
        }
    }

    /// Takes up the figures of an interval, and looks at its points where a decision may have been close.
    fn recall(&mut self, k: usize, intervals: &IntervalFigures, near: &[Points]) {
        let h = self.h;
        let (modes, times_s) = (h.modes(k), [h.time_s[k], h.time_s[k + 1]]);
        let mut spent = intervals.spent[k];
        let stands_twice = |k: usize| h.time_s.get(k + 1) == Some(&h.time_s[k]);
        if (k > 0 && stands_twice(k - 1)) || stands_twice(k + 1) {
            // What the rounding of an event's time makes of the energies spent beside it.
            let part = (self.instant_s / (times_s[1] - times_s[0])).min(1.0);
            spent.blur += part * (spent.size + spent.friction.abs() + spent.damping.abs());
        }
        self.energy.spend(&spent);
        let leans = self.law.restitution().is_some()
            && self.law.leans(h.sliding_displacement_m[k]) != [false; 2];
        self.totals.add(modes, self.contact(k), times_s[1] - times_s[0], leans);
        for (i, mode) in modes.iter().enumerate() {
            if *mode != Mode::Stick {
                let at = self.structure.degree_of(i);
                let [[from, _], [to, _]] = [k, k + 1].map(|k| self.stored(k, at));
                self.totals.interfaces[i].path_m += (to - from).abs();
            }
        }
        if h.surfaces > 0 {
            self.surfaces(k);
        }
        for (i, mode) in modes.iter().enumerate() {
            let watch = intervals.watch[k * h.interfaces + i];
            if !near.is_empty() {
                self.dips[i].resume(times_s);
                match mode {
                    Mode::Stick => near.iter().for_each(|points| self.held(i, points)),
                    Mode::Slip(direction) => self.slid(i, *direction, near),
                }
                continue;
            }
            let least = self.dips[i].so_far();
            let floor = match mode {
                Mode::Stick => self.floor.min(least).max(0.0),
                Mode::Slip(direction) if self.drops(i, *direction) => {
                    (self.floor * self.speed(i)).min(least)
                }
                Mode::Slip(_) => f64::NEG_INFINITY,
            };
            let [first, last] = watch.ends;
            if first.min(last) < floor {
                self.dips[i].resume(times_s);
                self.dips[i].feed(times_s[0], first);
                self.dips[i].feed(times_s[1], last);
            }
            self.dips[i].see(watch.fastest);
        }
        if self.contact(k) != Contact::Free && modes[0] != Mode::Stick {
            self.against_stop(k, near);
        }
    }

    /// Judges surfaces in series from the knot `k` to the next.
    fn surfaces(&mut self, k: usize) {
        let h = self.h;
        let [from, to] = [k, k + 1].map(|k| h.surface_displacements(k));
        let Some(sliding) = self.sliding(k, h.modes(k)[0]) else {
            for (own, stored) in from.iter().zip(to) {
                self.figures.displacement[0] = larger(self.figures.displacement[0], own - stored);
            }
            return;
        };
        let moved = h.sliding_displacement_m[k + 1] - h.sliding_displacement_m[k];
        let own = sliding.displacements(from, moved);
        let fastest = self.attained[VELOCITY];
        for (own, stored) in own.iter().zip(to) {
            let off = (own - stored).abs() - self.instant_s * fastest - self.drift[0];
            self.figures.displacement[0] = larger(self.figures.displacement[0], excess(off));
        }
        let normal = self.ground.instant(h.time_s[k + 1])[0].normal;
        let broken = self.law.series_excess(&sliding, &own, moved);
        self.figures.excess = larger(self.figures.excess, excess(normal * broken));
        self.events.slides_on(h, k, sliding.active());
    }

    /// Judges an elastic stop that acts or is left at the points of an interval.
    fn against_stop(&mut self, k: usize, near: &[Points]) {
        for points in near {
            let [s, w] = [0, 1].map(|i| points.values[self.h.interfaces + i]);
            let fastest = w.iter().fold(0.0, |most: f64, w| most.max(w.abs()));
            for (s, w) in s.into_iter().zip(w) {
                let broken = self.law.contact_excess(self.contact(k), (s, w), self.slack(fastest));
                self.figures.excess = larger(self.figures.excess, broken);
            }
        }
    }

    /// Judges a step of a stick from what is asked at its points.
    fn held(&mut self, i: usize, points: &Points) {
        let rule = Rule::get();
        let step = &points.step;
        let values = &points.values[i];
        let load = |t: f64| between(step.loads, t);
        let k = points.knot;
        let hold = self.course(k, self.h.modes(k), Feed::default()).hold;
        let mass_kg = self.stuck_mass(k, i);
        let rounding = self.rounding(i, mass_kg, &step.loads[0]);
        let mut margins = [f64::NAN; POINTS];
        for point in 0..POINTS {
            let normal = load(rule.points[point]).normal;
            let asked = self.asked_in(i, values[point], hold, normal);
            self.figures.excess = larger(self.figures.excess, excess(asked.beyond() - rounding));
            margins[point] = asked.margin().unwrap_or(f64::NAN);
        }
        if margins.iter().any(|m| m.is_nan()) {
            self.dips[i].interrupt();
            return;
        }
        let inner = dip(&margins);
        let flat = margins.iter().all(|m| (m - margins[0]).abs() <= 1e-12);
        for point in 0..POINTS {
            let (mut t, mut margin) = (rule.points[point], margins[point]);
            if inner == Some(point) {
                let cost = |t: f64, value: f64| {
                    self.asked_in(i, value, hold, load(t).normal).margin().unwrap_or(f64::INFINITY)
                };
                (t, margin) = rule.least(values, point, cost);
                let bound = self.asked_in(i, values[point], hold, load(t).normal).bound();
                self.figures.excess =
                    larger(self.figures.excess, excess(-margin * bound - rounding));
            }
            self.dips[i].feed(step.from_s + t * step.step_s, margin);
        }
        // A plateau near the bound is as close a call as a maximum, if it is no sliver of one.
        let long = step.step_s > 1e6 * self.instant_s;
        if flat && long && margins[0] < 1.0 {
            self.dips[i].take(step.from_s, margins[0]);
        }
    }

    /// Judges the steps of a slip from the speed, in the direction claimed, at their points.
    fn slid(&mut self, i: usize, direction: Direction, near: &[Points]) {
        let rule = Rule::get();
        let mut astray = [0.0; 2];
        let per_n = match i.checked_sub(1).map(|e| &self.structure.contents[e]) {
            None => self.law.wrong_way(),
            Some(contents) => {
                let mu = contents.kinetic_friction.max(0.5 * contents.static_friction);
                2.0 * mu * contents.mass_kg / self.structure.total_kg
            }
        };
        for points in near {
            let (step, speeds) = (&points.step, &points.values[i]);
            let inner = dip(speeds);
            for point in 0..POINTS {
                let (mut t, mut speed) = (rule.points[point], speeds[point]);
                if inner == Some(point) {
                    (t, speed) = rule.least(speeds, point, |_, speed| speed);
                }
                if speed < -self.still || speed.is_nan() {
                    let force = per_n * between(step.loads, t).normal;
                    astray = [larger(astray[0], speed), larger(astray[1], force)];
                }
                self.dips[i].feed(step.from_s + t * step.step_s, speed);
            }
        }
        // What the knot's own defect and the rounding of times explain is no sign.
        let (Some(first), Some(last)) = (near.first(), near.last()) else { return };
        let at = self.structure.degree_of(i);
        let k = first.knot;
        let [_, stored] = self.stored(k + 1, at);
        let defect = (direction.sign() * stored - last.values[i][POINTS - 1]).abs();
        let jerked = [k, k + 1].map(|k| self.acceleration(k, at).abs());
        let blur = defect + self.instant_s * jerked[0].max(jerked[1]);
        if astray[0] > self.still + blur {
            self.figures.excess = larger(self.figures.excess, astray[1]);
        }
    }

    /// `ẍ` of a degree from the accelerations stored at a knot.
    fn acceleration(&self, k: usize, degree: usize) -> f64 {
        let (h, n) = (self.h, self.h.storeys);
        let floor = |floor: usize| match floor {
            0 => h.block_acceleration_m_per_s2[k],
            i => h.storey_accelerations(k)[i - 1],
        };
        match degree {
            0 => floor(0) - h.table_acceleration_m_per_s2[k],
            i if i <= n => floor(i) - floor(0),
            i => {
                let e = i - 1 - n;
                h.contents_state(k, e)[2] - floor(self.structure.contents[e].floor)
            }
        }
    }

    /// Judges a knot at which no interval ends or begins by the load that suits it best.
    fn alone(&mut self, k: usize) {
        let h = self.h;
        let w = h.sliding_velocity_m_per_s[k];
        let per_n = match h.modes(k)[0] {
            Mode::Stick => None,
            Mode::Slip(direction) => Some(match self.sliding(k, h.modes(k)[0]) {
                Some(sliding) => -sliding.force(0.0),
                None => {
                    let factor =
                        self.law.rate.as_ref().map_or(1.0, |rate| rate.coefficients([w.abs()])[0]);
                    self.law.sliding_load(direction) * factor
                }
            }),
        };
        let (mut table, mut force) = (f64::INFINITY, f64::INFINITY);
        for load in self.ground.instant(h.time_s[k]) {
            let off = (load.table - h.table_acceleration_m_per_s2[k]).abs();
            table = table.min((off - self.instant_s * load.slope.abs()).max(0.0));
            let off =
                per_n.map_or(0.0, |per_n| (h.friction_force_n[k] - per_n * load.normal).abs());
            let rounding = self.law.most() * load.normal_rounding(self.ground.blur());
            force = force.min(excess(off - rounding));
        }
        self.figures.table[0] = larger(self.figures.table[0], table);
        self.figures.excess = larger(self.figures.excess, force);
        if k == 0 || k + 1 == h.len() {
            self.beside_jump(k);
        }
    }

    /// Raises the peaks by the outputs at the first or the last knot, where no interval tells those that
    /// are not stored.
    fn beside_jump(&mut self, k: usize) {
        let load = self.ground.instant(self.h.time_s[k])[if k == 0 { 1 } else { 2 }];
        let bench = self.bench();
        let mut work = Work::new(&bench, self.outputs.len());
        let mut group = Group::new(&bench);
        group.push(&bench, &self.course(k, self.h.modes(k), Feed::instant(load)));
        group.fill();
        let (level, ground, outputs) = (self.level, &self.ground, &self.outputs);
        dispatch!(level, simd => bench.outputs_at(simd, &mut group, (ground, outputs), &mut work));
        for (peak, value) in self.attained.iter_mut().zip(&work.ends[0]) {
            *peak = larger(*peak, value.0[0]);
        }
    }

    /// Keeps the least margin; rounding may leave one a little below 0.
    pub(super) fn nearest(&mut self, call: ClosestCall) {
        let call = ClosestCall { margin: call.margin.abs(), ..call };
        if self.closest.is_none_or(|closest| call.margin < closest.margin) {
            self.closest = Some(call);
        }
    }

    fn fresh_dips(&self, k: usize, i: usize) -> Dips {
        Dips::new(if self.h.modes(k)[i] == Mode::Stick { 1e-12 } else { self.still })
    }

    /// Ends a phase of an interface: its near decisions are known.
    fn close(&mut self, i: usize, mode: Mode) {
        let call = match mode {
            Mode::Stick => self.dips[i].least(i),
            Mode::Slip(direction) if self.drops(i, direction) => self.dips[i].least_of_peak(i),
            Mode::Slip(_) => None,
        };
        if let Some(call) = call {
            self.nearest(call);
        }
    }

    fn certificate(self, bound: f64) -> Certificate {
        let weight = self.model.weight_n();
        let (normal, table) = self.largest;
        let f = &self.figures;
        let equilibrium = [f.displacement, f.velocity, f.force, [f.table[0], table]].map(relative);
        let energy_balance_error = self.energy.error();
        // 64 ε of what a difference is made of is rounding.
        let near = |scale: f64| 64.0 * f64::EPSILON * scale;
        let rounding = Rounding {
            instant_s: self.instant_s,
            displacement_m: near(f.displacement[1]) + self.drift[0],
            velocity_m_per_s: near(f.velocity[1]) + self.jolt + self.drift[1],
            force_n: near(f.force[1])
                + self.unsure_n
                + self.law.rounding(&self.ground, self.instant_s, normal),
        };
        let own = demands::Own {
            outputs: &self.outputs,
            peaks: &self.attained,
            totals: &self.totals,
            events: &self.events,
        };
        let demands_error = demands::error(self.model, self.response, self.h, &own, &rounding);
        Certificate {
            equilibrium_residual: equilibrium.into_iter().fold(0.0, larger),
            friction_excess: relative([f.excess, self.law.scale(normal, weight)]),
            energy_balance_error,
            demands_error,
            closest_call: self.closest,
            bound,
            energy: self.energy.history,
        }
    }
}

/// The length that more than half of the intervals between these times have, to within `same_s`; NaN
/// where there is none.
fn common_step(times_s: &[f64], same_s: f64) -> f64 {
    let lengths = || times_s.windows(2).map(|pair| pair[1] - pair[0]);
    let same = |a: f64, b: f64| (a - b).abs() <= same_s;
    // Boyer and Moore's majority vote: pairs of unlike lengths cancel.
    let (mut step_s, mut votes) = (f64::NAN, 0_usize);
    for length_s in lengths() {
        if votes == 0 {
            step_s = length_s;
        }
        if same(length_s, step_s) {
            votes += 1;
        } else {
            votes -= 1;
        }
    }
    let count = lengths().filter(|length_s| same(*length_s, step_s)).count();
    if step_s > 0.0 && 2 * count > times_s.len() - 1 { step_s } else { f64::NAN }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Block, Damping, Frame, InitialState, Slider};
    use crate::response::{Demands, Method};
    use crate::slider::Friction;

    /// A motion that is none of the model's, with its figures of every size, under a motion of so many
    /// samples that does not end at 0, and a tail.
    fn wrong(n: usize, samples: usize, tail_s: f64) -> (Model, GroundMotion, Response) {
        let friction = Friction::new(0.1, 0.08).unwrap();
        let rigid = Model::rigid_block(300.0, friction.clone()).unwrap();
        let frame = Frame {
            masses_kg: vec![200.0; n],
            stiffnesses_n_per_m: vec![4e4; n],
            damping: Damping::Ratio(0.02),
            heights_m: Some(vec![3.0; n]),
        };
        let slider = Slider::sprung(friction, 5e3);
        let block = Block { width_m: Some(1.0), ..*rigid.block() };
        let model = Model::new(block, slider, frame, 9.81, InitialState::rest()).unwrap();
        let wave = |k: usize, rate: f64| libm::sin(rate * k as f64);
        let motion = (0..samples).map(|k| 2.0 * wave(k, 0.3)).collect();
        let motion = GroundMotion::evenly_spaced(0.01, motion, None).unwrap();
        let motion = motion.with_tail(tail_s).unwrap();
        let mut h = History { storeys: n, ..History::default() };
        for k in 0..motion.len() {
            h.time_s.push(motion.times_s()[k]);
            h.mode.push(match k / 11 % 3 {
                0 => Mode::Stick,
                1 => Mode::Slip(Direction::Positive),
                _ => Mode::Slip(Direction::Negative),
            });
            h.table_acceleration_m_per_s2.push(motion.horizontal_m_per_s2()[k]);
            h.sliding_displacement_m.push(0.01 * wave(k, 0.2));
            h.sliding_velocity_m_per_s.push(0.2 * wave(k, 0.25));
            h.block_acceleration_m_per_s2.push(wave(k, 0.37));
            h.friction_force_n.push(200.0 * wave(k, 0.31));
            for i in 0..n {
                h.storey_displacement_m.push(0.01 * wave(k + i, 0.21));
                h.storey_velocity_m_per_s.push(0.1 * wave(k + i, 0.23));
                h.storey_acceleration_m_per_s2.push(wave(k + i, 0.29));
            }
        }
        let response = Response {
            method: Method::Exact,
            demands: Demands::default(),
            events: Vec::new(),
            history: Some(h),
            contact_loss_s: Vec::new(),
            iterations: None,
            warnings: Vec::new(),
        };
        (model, motion, response)
    }

    /// The step that a record has goes by maps with a tail too, which begins with a jump.
    #[test]
    fn exact_common_step_goes_by_maps() {
        for n in [0, 1, 2, 5] {
            for tail_s in [0.0, 1.0, 1.0037] {
                let (model, motion, response) = wrong(n, 800, tail_s);
                assert_eq!(motion.dt_s().is_none(), tail_s > 0.0);
                let structure = Structure::new(&model, false);
                let history = response.history.as_ref().unwrap();
                let (given, pulse) = ((&response, history), Pulse::new(UNWATCHED));
                let law = Law::new(&model, false);
                let mut judge = Judge::new(&model, &motion, given, (&structure, &law), pulse);
                let knots = judge.knots().unwrap().unwrap();
                judge.side_by_side(&knots).unwrap();
                let (mapped, intervals) = (judge.by_maps, motion.len() - 1);
                assert!(10 * mapped > 9 * intervals, "{n} storeys: {mapped} of {intervals}");
            }
        }
    }

    #[test]
    fn exact_step_of_most_intervals_is_common() {
        assert_eq!(common_step(&[0.0, 1.0, 2.0, 2.0, 3.0, 9.0], 0.0), 1.0);
        assert_eq!(common_step(&[0.0, 5.0, 6.0, 6.5, 7.5, 8.5, 9.5], 0.0), 1.0);
        assert!(common_step(&[0.0, 1.0, 2.0, 4.0, 6.0], 0.0).is_nan());
        assert!(common_step(&[0.0, 0.0], 0.0).is_nan());
    }

    #[test]
    fn exact_same_bits_by_every_instruction_set() {
        let mut levels = vec![Level::new()];
        #[cfg(target_arch = "x86_64")]
        {
            let best = Level::new();
            levels.extend(best.as_avx2().map(Level::Avx2));
            levels.extend(best.as_sse4_2().map(Level::Sse4_2));
            levels.extend(best.as_sse2().map(Level::Sse2));
        }
        for n in [0, 1, 3] {
            let (model, motion, response) = wrong(n, 99, 0.0);
            let structure = Structure::new(&model, false);
            let of = |level| {
                let history = response.history.as_ref().unwrap();
                let (given, pulse) = ((&response, history), Pulse::new(UNWATCHED));
                let law = Law::new(&model, false);
                let mut judge = Judge::new(&model, &motion, given, (&structure, &law), pulse);
                judge.level = level;
                judge.run(1e-10).unwrap().unwrap()
            };
            let first = of(levels[0]);
            assert!(first.equilibrium_residual > 0.01 && first.equilibrium_residual.is_finite());
            for &level in &levels {
                assert_eq!(of(level), first, "{n} storeys, {level:?}");
            }
        }
    }
}
