//! Goes through the knots of a history and keeps the worst of everything.

use fearless_simd::{Level, dispatch};

use super::collocation::{MAX_TURN, Scheme};
use super::demands::{self, Outputs, Peaks, Rounding, Totals};
use super::energy::Energy;
use super::ground::{Ground, Load, of_side};
use super::lanes::{Bench, Group, Interval, Knots, Map, Reach, Sizes, Told, Work, Worst};
use super::law::{Dips, Law};
use super::step::{Look, Spread, Unit};
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
pub(super) const STILL: f64 = 1e-12;

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

pub(super) struct Judge<'a> {
    model: &'a Model,
    response: &'a Response,
    history: &'a History,
    pub(super) structure: &'a Structure,
    ground: Ground<'a>,
    /// Largest `N` and `|Ü|`.
    largest: (f64, f64),
    pub(super) law: &'a Law,
    pub(super) scheme: Scheme<'a>,
    /// Velocities below this are zero to within rounding.
    pub(super) still: f64,
    /// Rounding of a time.
    pub(super) instant_s: f64,
    /// What it makes of a force at an event at most.
    unsure_n: f64,
    /// Velocity that the largest acceleration gives in that time.
    pub(super) jolt: f64,
    /// Within an interval: the largest velocity of the wrong sign, the largest excess by such.
    pub(super) astray: [f64; 2],
    /// Within an interval: the largest size of each velocity.
    pub(super) fastest: Vec<f64>,
    pub(super) figures: Figures,
    pub(super) energy: Energy,
    /// Near decisions of the phase under way.
    pub(super) dips: Dips,
    closest: Option<ClosestCall>,
    /// A margin that the closest call has at most.
    floor: f64,
    pub(super) peaks: Peaks<'a>,
    pub(super) totals: Totals,
    /// How far outputs may leave the chord of a step, by phase, and the longest step.
    pub(super) spreads: [Option<Spread>; 3],
    longest_s: f64,
    /// Step of most intervals of the motion.
    even_s: f64,
    /// Intervals judged by maps so far.
    #[cfg(test)]
    by_maps: usize,
    level: Level,
    /// The knot up to which near decisions were looked at.
    fed: usize,
    /// `(x, v)` along an interval, and at the start of a step.
    pub(super) state: Vec<f64>,
    pub(super) before: Vec<f64>,
    /// `(x, v)` of the knot last looked at.
    stored: Vec<f64>,
    /// Asks whether to go on, after so many units of work a step.
    pulse: Pulse<'a>,
    units: u32,
}

impl<'a> Judge<'a> {
    pub(super) fn new(
        model: &'a Model,
        motion: &'a GroundMotion,
        (response, history): (&'a Response, &'a History),
        (structure, law): (&'a Structure, &'a Law),
        pulse: Pulse<'a>,
    ) -> Self {
        let d = structure.degrees();
        let end_s = history.time_s.last().copied().unwrap_or(0.0);
        let instant_s = 8.0 * f64::EPSILON * end_s;
        let ground = Ground::new(model, motion);
        let largest = ground.largest(end_s);
        let relative = || {
            let tables = history.table_acceleration_m_per_s2.iter();
            let pairs = history.block_acceleration_m_per_s2.iter().zip(tables);
            pairs.fold(0.0, |most, (block, table)| (block - table).abs().max(most))
        };
        let relative = if law.rate.is_some() { relative() } else { 0.0 };
        let added_rate = law.added_rate(largest.0 / structure.block_kg, relative);
        Self {
            model,
            response,
            history,
            structure,
            ground,
            largest,
            law,
            scheme: Scheme::new((structure, law), 2.0 * instant_s, added_rate),
            still: 0.0,
            instant_s,
            unsure_n: 0.0,
            jolt: 0.0,
            astray: [0.0; 2],
            fastest: vec![0.0; d],
            figures: Figures::default(),
            energy: Energy::default(),
            dips: Dips::new(0.0),
            closest: None,
            floor: f64::INFINITY,
            peaks: Peaks::new(Outputs::new(model, structure)),
            totals: Totals::default(),
            spreads: [const { None }; 3],
            longest_s: history.time_s.windows(2).map(|t| t[1] - t[0]).fold(0.0, f64::max),
            even_s: common_step(motion.times_s(), 2.0 * instant_s),
            #[cfg(test)]
            by_maps: 0,
            level: Level::new(),
            fed: 0,
            state: vec![0.0; 2 * d],
            before: vec![0.0; 2 * d],
            stored: vec![0.0; 2 * d],
            pulse,
            units: 32 * d as u32,
        }
    }

    /// Looks at every knot by itself: the balance of forces, scales, energies and outputs. `None`
    /// where something stored is not finite.
    fn knots(&mut self) -> Result<Option<Knots>, Stopped> {
        let h = self.history;
        let mut stop = Vec::new();
        if self.model.stop().is_some() {
            let at = |k: usize| (h.sliding_displacement_m[k], h.sliding_velocity_m_per_s[k]);
            let force = |k: usize| self.law.push(self.contact(k)).force(at(k).0, at(k).1);
            stop.extend((0..h.len()).map(force));
        }
        let mut worst = Worst::NONE;
        let mut knots = Knots::new(h.len(), self.peaks.outputs.len());
        let mut pulse = core::mem::replace(&mut self.pulse, Pulse::new(UNWATCHED));
        let (bench, outputs) = (self.bench(&stop), &self.peaks.outputs);
        let to = (&mut knots, &mut pulse);
        dispatch!(self.level, simd => bench.knots(simd, outputs, &mut worst, to))?;
        self.pulse = pulse;
        if worst.broken.0.iter().any(|x| x.is_nan()) {
            return Ok(None);
        }
        self.peaks.attained.copy_from_slice(&knots.attained);
        let Sizes { place, storey, rate, table } = worst.sizes;
        let [place, storey, rate, table] = [place, storey, rate, table].map(|all| all.largest());
        let (sliding, block) = (self.peaks.speed(), self.peaks.block_acceleration());
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
                let slack = self.contact_slack(at.1);
                let broken = self.law.contact_excess(self.contact(k), at, slack);
                self.figures.excess = larger(self.figures.excess, broken);
            }
        }
        Ok(Some(knots))
    }

    /// What the lanes need.
    pub(super) fn bench<'b>(&self, stop: &'b [f64]) -> Bench<'b>
    where
        'a: 'b,
    {
        Bench {
            structure: self.structure,
            rule: self.scheme.rule,
            history: self.history,
            slope: self.model.slope_m_per_s2(),
            instant_s: self.instant_s,
            stop,
            law: self.law,
        }
    }

    /// Judges everything; `None` where something stored is not finite.
    pub(super) fn run(mut self, bound: f64) -> Result<Option<Certificate>, Stopped> {
        let Some(mut all) = self.knots()? else { return Ok(None) };
        let h = self.history;
        let (times, knots) = (&h.time_s, h.len());
        self.load_state(0);
        self.start();
        let stop_j = self.law.push(self.contact(0)).strain(self.x()[0]);
        let initial_j = self.structure.kinetic(self.v()) + self.structure.strain(self.x()) + stop_j;
        let rounding_j = self.model.total_mass_kg() * self.jolt * self.jolt;
        self.energy.start(initial_j, stop_j, rounding_j, knots);
        let told = self.side_by_side(&all)?;
        self.find_floor();
        self.dips = self.fresh_dips(0);
        let mut arrives = false;
        for k in 0..knots {
            if k > 0 {
                self.join(k, !arrives);
            }
            self.energy.knot(all.kinetic_j[k], all.strain_j[k]);
            let leaves = k + 1 < knots && times[k + 1] > times[k];
            if leaves {
                match &told[k] {
                    Some(told) => self.recall(k, told)?,
                    None => self.interval(k, Look::All)?,
                }
            } else if !arrives {
                self.alone(k);
            }
            arrives = leaves;
        }
        self.close(h.mode[knots - 1]);
        all.kinetic_j.truncate(knots);
        all.strain_j.truncate(knots);
        self.energy.history.kinetic_j = all.kinetic_j;
        self.energy.history.strain_j = all.strain_j;
        Ok(Some(self.certificate(bound)))
    }

    /// Judges side by side all intervals of one step in which no stop acts and the loads are linear;
    /// looks for peaks where there may be some.
    fn side_by_side(&mut self, knots: &Knots) -> Result<Vec<Option<Told<f64>>>, Stopped> {
        let h = self.history;
        let mut told = Vec::with_capacity(h.len());
        let mut worst = Worst::NONE;
        let mut work = Work::new(self.structure.degrees());
        let mut groups = [Phase::Stick, Phase::Slip].map(|phase| {
            let steps = self.steps(phase);
            [Group::new(phase, steps), Group::new(phase, steps)]
        });
        let mut maps = [None, None];
        let even_s = self.even_s;
        for k in 0..h.len().saturating_sub(1) {
            told.push(None);
            let length_s = h.time_s[k + 1] - h.time_s[k];
            if !(length_s > 0.0) {
                continue;
            }
            let Some((phase, interval)) = self.single(k, length_s) else { continue };
            let which = phase as usize;
            let even = (length_s - even_s).abs() <= 2.0 * self.instant_s;
            if self.spreads[which].is_none() {
                maps[which] = self.prepare(phase);
            }
            let even = even && maps[which].is_some();
            let group = &mut groups[which][usize::from(even)];
            if group.push(&interval) {
                let maps = maps[which].as_ref().filter(|_| even);
                self.flush(group, maps, knots, (&mut work, &mut worst), &mut told)?;
            }
        }
        for group in groups.iter_mut().flatten().filter(|group| group.count > 0) {
            self.flush(group, None, knots, (&mut work, &mut worst), &mut told)?;
        }
        told.resize(h.len(), None);
        self.figures.take(&worst);
        self.still = (STILL * worst.sliding.largest()).max(self.still);
        Ok(told)
    }

    /// Steps that an even interval of a phase takes, and any that goes side by side with others.
    fn steps(&self, phase: Phase) -> usize {
        let turn = self.scheme.rate(phase) * self.even_s;
        if turn > MAX_TURN { libm::ceil(turn / MAX_TURN) as usize } else { 1 }
    }

    /// The interval from a knot if it takes no more steps under a linear load, and no stop acts in it.
    fn single(&mut self, k: usize, length_s: f64) -> Option<(Phase, Interval)> {
        let h = self.history;
        let phase = if h.mode[k] == Mode::Stick { Phase::Stick } else { Phase::Slip };
        let longest = MAX_TURN * self.steps(phase) as f64;
        if self.contact(k) != Contact::Free || self.scheme.rate(phase) * length_s > longest {
            return None;
        }
        let piece = self.ground.piece(h.time_s[k], h.time_s[k + 1]);
        if piece.to_s < h.time_s[k + 1] {
            return None;
        }
        let [from, to] = piece.loads;
        let force = match h.mode[k] {
            Mode::Stick => {
                let bound =
                    self.law.fixed()[0].min(self.law.fixed()[1]) * from.normal.min(to.normal);
                if !(bound > 0.0) {
                    return None;
                }
                [0.0; 2]
            }
            Mode::Slip(direction) => {
                [from, to].map(|load| self.law.sliding_load(direction, load.normal))
            }
        };
        let interval = Interval {
            knot: k,
            length_s,
            table: [from.table, to.table],
            normal: [from.normal, to.normal],
            drift: from.slope,
            sign: h.mode[k].sign(),
            force,
        };
        Some((phase, interval))
    }

    /// Bounds the outputs of a phase; the maps of the even step to its path, and to its places, where
    /// there is an even step.
    fn prepare(&mut self, phase: Phase) -> Option<[Map; 2]> {
        let (rate, steps) = (self.scheme.rate(phase), self.steps(phase));
        let longest_s = if rate > 0.0 { MAX_TURN / rate } else { f64::INFINITY };
        let longest_s = longest_s.min(self.longest_s / steps as f64);
        if phase != Phase::Stick && self.law.rate.is_some() {
            self.spreads[phase as usize] = Some(Spread::unknown(longest_s));
            return None;
        }
        let longest = self.units(phase, longest_s);
        self.spread(phase, longest_s, &longest);
        if self.even_s.is_nan() {
            return None;
        }
        let same = (longest_s * steps as f64 - self.even_s).abs() <= 2.0 * self.instant_s;
        let even = if same { longest } else { self.units(phase, self.even_s / steps as f64) };
        let columns = [Unit::paths(&even), Unit::places(&even)];
        let maps =
            columns.each_ref().map(|columns| Map::new(phase, self.structure.degrees(), columns));
        let [columns, _] = columns;
        self.scheme.keep(phase, (self.even_s, steps), columns);
        Some(maps)
    }

    /// Judges a group and empties it.
    fn flush(
        &mut self,
        group: &mut Group,
        maps: Option<&[Map; 2]>,
        knots: &Knots,
        (work, worst): (&mut Work, &mut Worst),
        told: &mut [Option<Told<f64>>],
    ) -> Result<(), Stopped> {
        self.pulse.beat(self.units.saturating_mul(self.steps(group.phase) as u32))?;
        let Some(spread) = &self.spreads[group.phase as usize] else { return Ok(()) };
        group.fill();
        let (bounds, longest_s) = (&spread.leaving[..], spread.longest_s);
        let reach = Reach { bounds, longest_s, unknown: spread.bounds.is_empty(), knots };
        #[cfg(test)]
        if maps.is_some() {
            self.by_maps += group.count;
        }
        let bench = self.bench(&[]);
        let (lanes, peaks) = ((&*group, maps), &mut self.peaks);
        dispatch!(self.level, simd => bench.group(simd, lanes, &reach, peaks, work, worst));
        for lane in 0..group.count {
            told[group.knot(lane)] = Some(work.told.lane(lane));
        }
        group.count = 0;
        Ok(())
    }

    /// Takes up what was told of an interval; looks again where a decision may have been close.
    fn recall(&mut self, k: usize, told: &Told<f64>) -> Result<(), Stopped> {
        let h = self.history;
        let (mode, from_s, to_s) = (h.mode[k], h.time_s[k], h.time_s[k + 1]);
        self.energy.spend(told.work, told.size, told.damping, told.friction);
        self.totals.add(mode, Contact::Free, to_s - from_s);
        let near = self.closest.map_or(self.floor, |call| call.margin.min(self.floor));
        let (floor, wrong) = match mode {
            Mode::Stick => (near.min(self.dips.so_far()).max(0.0), told.least < 0.0),
            Mode::Slip(direction) => {
                let s = &h.sliding_displacement_m;
                self.totals.path_m += (s[k + 1] - s[k]).abs();
                let wrong = told.least.min(told.low) < -self.still;
                let drops = self.law.drops(direction);
                let near = (near * self.peaks.speed()).min(self.dips.so_far());
                (if drops { near } else { f64::NEG_INFINITY }, wrong)
            }
        };
        if wrong || told.low < floor {
            return self.interval(k, Look::Law);
        }
        let [first, last] = told.ends;
        if first.min(last) < floor {
            self.resume(k);
            self.dips.feed(from_s, first);
            self.dips.feed(to_s, last);
        }
        self.dips.see(told.fastest);
        Ok(())
    }

    /// Looks at all decisions where the block came to rest, and at maxima of the demand at knots: only
    /// what comes closer is worth a search between knots.
    fn find_floor(&mut self) {
        let h = self.history;
        for k in 1..h.len() {
            if h.mode[k] != h.mode[k - 1] {
                self.load_state(k);
                self.change(k, h.mode[k - 1], h.mode[k]);
            }
        }
        self.floor = self.closest.map_or(f64::INFINITY, |call| call.margin);
        if self.ground.has_vertical() {
            return;
        }
        let normal = self.largest.0;
        let margin = |k: usize| self.law.margin(h.friction_force_n[k], normal);
        for k in 1..h.len().saturating_sub(1) {
            if h.mode[k - 1..=k + 1] != [Mode::Stick; 3] || self.contact(k) != Contact::Free {
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

    /// Decisions are looked at from the knot `k` to the next, and perhaps were not before.
    fn resume(&mut self, k: usize) {
        if self.fed != k {
            self.dips.interrupt();
        }
        self.fed = k + 1;
    }

    /// Contact with the stop at a knot.
    fn contact(&self, k: usize) -> Contact {
        self.history.contact.get(k).copied().unwrap_or(Contact::Free)
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
            displacement_m: near(f.displacement[1]),
            velocity_m_per_s: near(f.velocity[1]) + self.jolt,
            force_n: near(f.force[1])
                + self.unsure_n
                + self.law.rounding(&self.ground, self.instant_s, normal),
        };
        let own = (&self.peaks, &self.totals);
        let demands_error = demands::error(self.model, self.response, self.history, own, &rounding);
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

    fn x(&self) -> &[f64] {
        &self.stored[..self.stored.len() / 2]
    }

    fn v(&self) -> &[f64] {
        &self.stored[self.stored.len() / 2..]
    }

    /// Reads the stored state of a knot.
    fn load_state(&mut self, k: usize) {
        let h = self.history;
        let (x, v) = self.stored.split_at_mut(self.structure.degrees());
        x[0] = h.sliding_displacement_m[k];
        v[0] = h.sliding_velocity_m_per_s[k];
        x[1..].copy_from_slice(h.storey_displacements(k));
        v[1..].copy_from_slice(h.storey_velocities(k));
    }

    /// Compares the stored state with another, entry by entry.
    fn compare(&mut self, other: &[f64]) {
        let d = self.structure.degrees();
        for (i, (stored, other)) in self.stored.iter().zip(other).enumerate() {
            let figure =
                if i < d { &mut self.figures.displacement } else { &mut self.figures.velocity };
            figure[0] = larger(figure[0], stored - other);
        }
    }

    /// Compares the state integrated from the knot `k` with the stored one at the next, less what
    /// the motion changes within the rounding of their times.
    fn arrive(&mut self, k: usize, end: &[f64]) {
        let d = self.structure.degrees();
        for i in 0..d {
            let [from, to] = [k, k + 1].map(|k| self.stored_acceleration(k, i).abs());
            for (at, rate, figure) in [
                (i, self.fastest[i], &mut self.figures.displacement),
                (d + i, from.max(to), &mut self.figures.velocity),
            ] {
                let defect = (self.stored[at] - end[at]).abs() - self.instant_s * rate;
                figure[0] = larger(figure[0], excess(defect));
            }
        }
    }

    /// `s̈` or `q̈_i` from the accelerations stored at a knot.
    fn stored_acceleration(&self, k: usize, degree: usize) -> f64 {
        let block = self.history.block_acceleration_m_per_s2[k];
        match degree.checked_sub(1) {
            None => block - self.history.table_acceleration_m_per_s2[k],
            Some(storey) => self.history.storey_accelerations(k)[storey] - block,
        }
    }

    /// The first knot has the model's initial state, and a block at rest that slides was pushed.
    fn start(&mut self) {
        let initial = self.model.initial();
        let mut state = vec![initial.sliding_displacement_m];
        state.extend(self.model.initial_storey_displacement_m());
        state.push(initial.sliding_velocity_m_per_s);
        state.extend(self.model.initial_storey_velocity_m_per_s());
        self.compare(&state);
        if initial.sliding_velocity_m_per_s == 0.0 {
            self.change(0, Mode::Stick, self.history.mode[0]);
        }
    }

    /// Passes from the knot before `k` to `k`; `abreast` where both have the same time.
    fn join(&mut self, k: usize, abreast: bool) {
        let (before, after) = (self.history.mode[k - 1], self.history.mode[k]);
        if abreast {
            self.load_state(k - 1);
            let other = self.stored.clone();
            self.load_state(k);
            self.compare(&other);
        }
        if before != after {
            self.load_state(k);
            let speed = self.stored[self.structure.degrees()];
            self.figures.velocity[0] = larger(self.figures.velocity[0], speed);
            self.close(before);
            self.change(k, before, after);
            self.dips = self.fresh_dips(k);
        }
    }

    /// What the rounding of times makes of the demand on a block at rest, less what holds it, in N.
    pub(super) fn rounding(&self, load: &Load) -> f64 {
        let most = self.law.fixed()[0].max(self.law.fixed()[1]);
        load.rounding((self.instant_s, self.largest.0), self.structure.block_kg, most)
    }

    /// Judges the decision between two modes at the knot `k`, where the block has no velocity.
    ///
    /// The knot's own side of a jump decides.
    fn change(&mut self, k: usize, before: Mode, after: Mode) {
        if before == after {
            return;
        }
        let h = self.history;
        let table = h.table_acceleration_m_per_s2[k];
        let loads = self.ground.instant(h.time_s[k]);
        let stop = self.law.push(self.contact(k)).force(self.x()[0], 0.0);
        let judged = |load: &Load| {
            let demand = self.structure.demand(self.x(), self.v(), load.a) + stop;
            let bound = self.law.bound(demand, load.normal);
            let drift = self.model.block().mass_kg * load.slope.abs() * self.instant_s / bound;
            let margin = self.law.margin(demand, load.normal).map(|margin| (margin, drift));
            let rounding = self.rounding(load);
            let forbidden = excess(self.law.forbids(after, demand, load.normal) - rounding);
            (forbidden, margin, rounding)
        };
        // What a jump passes on its way lets go too.
        let side = of_side(&loads, table);
        let passed = if before == Mode::Stick { &loads[..] } else { &side[..] };
        let best = passed.iter().map(judged).reduce(|a, b| if b.0 < a.0 { b } else { a });
        // Distances that are not numbers leave no candidate.
        let (excess, margin, rounding) = best.unwrap_or((f64::INFINITY, None, 0.0));
        self.figures.excess = larger(self.figures.excess, excess);
        if !self.ground.has_sample(h.time_s[k]) {
            self.unsure_n = larger(self.unsure_n, rounding);
        }
        if let (true, Some((margin, drift))) = (before != Mode::Stick, margin) {
            if self.totals.closest_stop.is_none_or(|least| margin.abs() < least) {
                self.totals.closest_stop = Some(margin.abs());
                self.totals.stop_rounding = drift + 1e3 * f64::EPSILON;
            }
            let time_s = h.time_s[k];
            self.nearest(ClosestCall { margin, time_s, kind: "stop", interface: 0 });
        }
    }

    /// Keeps the least margin; rounding may leave one a little below 0.
    fn nearest(&mut self, call: ClosestCall) {
        let call = ClosestCall { margin: call.margin.abs(), ..call };
        if self.closest.is_none_or(|closest| call.margin < closest.margin) {
            self.closest = Some(call);
        }
    }

    fn fresh_dips(&self, k: usize) -> Dips {
        Dips::new(if self.history.mode[k] == Mode::Stick { 1e-12 } else { self.still })
    }

    /// Ends a phase: its near decisions are known.
    fn close(&mut self, mode: Mode) {
        let call = match mode {
            Mode::Stick => self.dips.least(0),
            Mode::Slip(direction) if self.law.drops(direction) => self.dips.least_of_peak(0),
            Mode::Slip(_) => None,
        };
        if let Some(call) = call {
            self.nearest(call);
        }
    }

    /// How far the stored table acceleration and force of sliding at a knot are off those of a load.
    fn off(&self, k: usize, load: &Load) -> [f64; 2] {
        let h = self.history;
        // The stored time is rounded, the acceleration stored with it need not be.
        let table = (load.table - h.table_acceleration_m_per_s2[k]).abs();
        let w = h.sliding_velocity_m_per_s[k];
        let beyond = match h.mode[k] {
            Mode::Stick => 0.0,
            Mode::Slip(claimed) => {
                let direction = if w.abs() <= self.still {
                    claimed
                } else if w > 0.0 {
                    Direction::Positive
                } else {
                    Direction::Negative
                };
                self.law.sliding_excess(h.friction_force_n[k], (direction, w), load.normal)
            }
        };
        [(table - self.instant_s * load.slope.abs()).max(0.0), beyond]
    }

    /// Judges the stored values of a knot with the load of an interval that ends or begins there.
    fn side(&mut self, k: usize, load: &Load) {
        let [table, beyond] = self.off(k, load);
        self.figures.table[0] = larger(self.figures.table[0], table);
        self.figures.excess = larger(self.figures.excess, beyond);
    }

    /// Judges a knot at which no interval ends or begins by the load that suits it best.
    fn alone(&mut self, k: usize) {
        let offs = self.ground.instant(self.history.time_s[k]).map(|load| self.off(k, &load));
        let least = |i: usize| offs.iter().map(|off| off[i]).fold(f64::INFINITY, f64::min);
        self.figures.table[0] = larger(self.figures.table[0], least(0));
        self.figures.excess = larger(self.figures.excess, least(1));
    }

    /// What the rounding of times makes of a position at this speed, and of the force of the stop.
    pub(super) fn contact_slack(&self, w: f64) -> [f64; 2] {
        let slack_m = self.instant_s * w.abs() + 8.0 * f64::EPSILON * self.figures.displacement[1];
        [slack_m, self.structure.stop_damper() * self.jolt]
    }

    /// Integrates from the knot `k` to the next.
    fn interval(&mut self, k: usize, look: Look) -> Result<(), Stopped> {
        let mode = self.history.mode[k];
        let contact = self.contact(k);
        let phase = match (mode, contact) {
            (Mode::Stick, _) => Phase::Stick,
            (_, Contact::Pressed(_)) => Phase::Pressed,
            _ => Phase::Slip,
        };
        let d = self.structure.degrees();
        self.load_state(k);
        self.state.copy_from_slice(&self.stored);
        if phase == Phase::Stick {
            self.state[d] = 0.0;
        }
        let (mut from_s, end_s) = (self.history.time_s[k], self.history.time_s[k + 1]);
        self.astray = [0.0; 2];
        self.fastest.fill(0.0);
        if look == Look::All {
            self.totals.add(mode, contact, end_s - from_s);
        }
        self.resume(k);
        if self.spreads[phase as usize].is_none() {
            self.prepare(phase);
        }
        let mut first = None;
        loop {
            let piece = self.ground.piece(from_s, end_s);
            let steps = self.scheme.begin(phase, piece.to_s - from_s);
            let step_s = (piece.to_s - from_s) / steps as f64;
            for j in 0..steps {
                self.pulse.beat(self.units)?;
                let loads = [j, j + 1].map(|j| between(piece.loads, j as f64 / steps as f64));
                self.step((mode, contact), from_s + j as f64 * step_s, step_s, loads, look);
            }
            let first = *first.get_or_insert(piece.loads[0]);
            from_s = piece.to_s;
            if from_s < end_s {
                continue;
            }
            self.load_state(k + 1);
            let end = core::mem::take(&mut self.state);
            if look == Look::All {
                self.arrive(k, &end);
                self.side(k, &first);
                self.side(k + 1, &piece.loads[1]);
            }
            // What the knot's own defect and the rounding of times explain is no sign.
            let defect = (self.stored[d] - end[d]).abs();
            let jerked = [k, k + 1].map(|k| self.stored_acceleration(k, 0).abs());
            let blur = defect + self.instant_s * jerked[0].max(jerked[1]);
            if self.astray[0] > self.still + blur {
                self.figures.excess = larger(self.figures.excess, self.astray[1]);
            }
            self.state = end;
            return Ok(());
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

/// The load at a fraction of a stretch.
pub(super) fn between([from, to]: [Load; 2], t: f64) -> Load {
    let linear = |from: f64, to: f64| from + (to - from) * t;
    Load {
        table: linear(from.table, to.table),
        a: linear(from.a, to.a),
        normal: linear(from.normal, to.normal),
        slope: from.slope,
        normal_slope: from.normal_slope,
    }
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
                let structure = Structure::new(&model);
                let history = response.history.as_ref().unwrap();
                let (given, pulse) = ((&response, history), Pulse::new(UNWATCHED));
                let law = Law::new(&model);
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
            let structure = Structure::new(&model);
            let of = |level| {
                let history = response.history.as_ref().unwrap();
                let (given, pulse) = ((&response, history), Pulse::new(UNWATCHED));
                let law = Law::new(&model);
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
