//! What the response asks of the structure, recomputed from the path of the judge of devices.

use super::super::collocation::{POINTS, Rule};
pub(super) use super::super::demands::Rounding;
use super::super::demands::{Comparison, first_time, raise};
use super::super::law::contact_event;
use super::Now;
use super::law::Asked;
use crate::model::{Model, StopKind};
use crate::response::{
    Contact, Demands, Event, EventKind, History, Method, Mode, Response, SurfaceDemands,
};

/// Impacts slower than this are neither listed nor counted, in m/s.
pub(super) const SLOWEST_IMPACT_M_PER_S: f64 = 1e-3;

/// Sums of one interface.
#[derive(Clone, Copy, Default)]
pub(super) struct Interface {
    path_m: f64,
    sliding_s: f64,
}

/// What is added up from knot to knot.
#[derive(Default)]
pub(super) struct Totals {
    interfaces: Vec<Interface>,
    contact_s: f64,
}

impl Totals {
    pub(super) fn add(&mut self, modes: &[Mode], contact: Contact, length_s: f64, leans: bool) {
        for (sums, mode) in self.interfaces.iter_mut().zip(modes) {
            if *mode != Mode::Stick {
                sums.sliding_s += length_s;
            }
        }
        if matches!(contact, Contact::Pressed(_)) || (leans && modes[0] == Mode::Stick) {
            self.contact_s += length_s;
        }
    }

    pub(super) fn path(&mut self, modes: &[Mode], from: &[f64], to: &[f64], floors: usize) {
        for (i, (sums, mode)) in self.interfaces.iter_mut().zip(modes).enumerate() {
            let at = if i == 0 { 0 } else { floors + i };
            if *mode != Mode::Stick {
                sums.path_m += (to[at] - from[at]).abs();
            }
        }
    }
}

/// Largest sizes of the continuous motion.
#[derive(Default)]
struct Peaks {
    velocity: f64,
    block: f64,
    slider: f64,
    friction: f64,
    shear: f64,
    overturning: f64,
    stop: f64,
    displacement: Vec<f64>,
    drift: Vec<f64>,
    acceleration: Vec<f64>,
    contents_velocity: Vec<f64>,
    contents_acceleration: Vec<f64>,
}

/// An event that the knots tell, with the sliding speed before it.
struct Told {
    event: Event,
    speed: f64,
}

pub(super) struct Own {
    pub(super) totals: Totals,
    peaks: Peaks,
    events: Vec<Told>,
    /// The last turn of the slider since its last impact.
    turn: Option<usize>,
    impacts: f64,
    closest_stop: Option<f64>,
    stop_rounding: f64,
    /// Surfaces that slid in the last interval, while the slider slides on.
    active: Option<Vec<bool>>,
    /// Largest accelerations by degree.
    jerked: Vec<f64>,
    heights_m: Vec<f64>,
    half: f64,
    slope: f64,
}

impl Own {
    pub(super) fn new(model: &Model, h: &History) -> Self {
        let (n, e) = (model.storeys(), model.contents().len());
        let mut above_m = model.block().height_m.unwrap_or(0.0);
        let mut heights_m = vec![above_m];
        for height_m in model.frame().heights_m.iter().flatten() {
            above_m += height_m;
            heights_m.push(above_m);
        }
        heights_m.resize(n + 1, 0.0);
        let most = |list: &[f64]| list.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let block = most(&h.block_acceleration_m_per_s2);
        let table = most(&h.table_acceleration_m_per_s2);
        let storeys = most(&h.storey_acceleration_m_per_s2);
        let contents = most(&h.contents_acceleration_m_per_s2);
        let mut jerked = vec![block + table];
        jerked.resize(1 + n, block + storeys);
        jerked.resize(1 + n + e, contents + storeys.max(block));
        Self {
            totals: Totals { interfaces: vec![Interface::default(); 1 + e], contact_s: 0.0 },
            peaks: Peaks {
                displacement: vec![0.0; n],
                drift: vec![0.0; n],
                acceleration: vec![0.0; n],
                contents_velocity: vec![0.0; e],
                contents_acceleration: vec![0.0; e],
                ..Peaks::default()
            },
            events: Vec::new(),
            turn: None,
            impacts: 0.0,
            closest_stop: None,
            stop_rounding: 0.0,
            active: None,
            jerked,
            half: 0.5 * heights_m[0] * model.block().mass_kg,
            heights_m,
            slope: model.slope_m_per_s2(),
        }
    }

    /// Largest acceleration of a degree that the history tells.
    pub(super) fn jerked(&self, degree: usize) -> f64 {
        self.jerked[degree]
    }

    /// Largest acceleration of any degree that the history tells.
    pub(super) fn most_jerked(&self) -> f64 {
        self.jerked.iter().fold(0.0, |most, a| a.max(most))
    }

    /// Takes the points of a step.
    pub(super) fn see(
        &mut self,
        model: &Model,
        rule: &Rule,
        all: &[(&Now, &[f64], &[f64])],
        asked: &[Asked],
    ) {
        let of = |pick: &dyn Fn(usize) -> f64| -> [f64; POINTS] { core::array::from_fn(pick) };
        let n = model.storeys();
        let slope = self.slope;
        let p = &mut self.peaks;
        raise(rule, &mut p.velocity, &of(&|i| all[i].2[0]));
        raise(rule, &mut p.block, &of(&|i| all[i].0.block - slope));
        raise(rule, &mut p.slider, &of(&|i| all[i].0.slider));
        raise(rule, &mut p.shear, &of(&|i| all[i].0.shear));
        raise(rule, &mut p.stop, &of(&|i| all[i].0.stop));
        for j in 0..n {
            raise(rule, &mut p.displacement[j], &of(&|i| all[i].1[1 + j]));
            let below = |i: usize| if j == 0 { 0.0 } else { all[i].1[j] };
            raise(rule, &mut p.drift[j], &of(&|i| all[i].1[1 + j] - below(i)));
            raise(rule, &mut p.acceleration[j], &of(&|i| all[i].0.floors[j] - slope));
        }
        for e in 0..p.contents_velocity.len() {
            raise(rule, &mut p.contents_velocity[e], &of(&|i| all[i].2[1 + n + e]));
            raise(rule, &mut p.contents_acceleration[e], &of(&|i| all[i].0.contents[e] - slope));
        }
        let (heights_m, half) = (&self.heights_m, self.half);
        let contents = model.contents();
        let masses_kg = &model.frame().masses_kg;
        raise(
            rule,
            &mut p.overturning,
            &of(&|i| {
                let now = all[i].0;
                let floors: f64 =
                    (0..n).map(|j| heights_m[j + 1] * masses_kg[j] * now.floors[j]).sum();
                let carried: f64 = contents
                    .iter()
                    .zip(&now.contents)
                    .map(|(c, a)| heights_m[c.floor] * c.mass_kg * a)
                    .sum();
                half * now.block + floors + carried
            }),
        );
        // Against a rigid stop friction takes what it can; it takes all or not in a whole step.
        let middle = asked.get(POINTS / 2);
        let taken = middle.map_or(0.0, |asked| asked.taken() - asked.demand);
        let side = if taken > 0.0 { 0 } else { 1 };
        let friction: [f64; POINTS] = core::array::from_fn(|i| match asked.get(i) {
            Some(asked) if taken != 0.0 => asked.friction[side],
            _ => all[i].0.friction,
        });
        raise(rule, &mut p.friction, &friction);
        if taken != 0.0 {
            raise(rule, &mut p.stop, &of(&|i| friction[i] - all[i].0.friction));
        }
    }

    /// A stop of the slider was decided.
    pub(super) fn decided(&mut self, margin: f64, drift: f64) {
        if self.closest_stop.is_none_or(|least| margin < least) {
            self.closest_stop = Some(margin);
            self.stop_rounding = drift + 1e3 * f64::EPSILON;
        }
    }

    // ---- events ---------------------------------------------------------------------------------

    fn push(&mut self, h: &History, k: usize, interface: usize, kind: EventKind, speed: f64) {
        let place = match interface {
            0 => h.sliding_displacement_m[k],
            _ => h.contents_state(k, interface - 1)[0],
        };
        if interface == 0 {
            self.turn = (kind == EventKind::Reversal).then_some(self.events.len());
        }
        let mode = h.modes(k)[interface];
        let event =
            Event { time_s: h.time_s[k], kind, mode, sliding_displacement_m: place, interface };
        self.events.push(Told { event, speed });
    }

    /// The first knot, with the modes before it.
    pub(super) fn begin(&mut self, h: &History, before: &[Mode]) {
        for i in 0..before.len() {
            if before[i] == Mode::Stick && h.modes(0)[i] != Mode::Stick {
                self.push(h, 0, i, EventKind::Slip, 0.0);
            }
        }
    }

    /// Passes to the knot `k`, at which the block has perhaps struck a rigid stop.
    pub(super) fn pass(&mut self, h: &History, k: usize, struck: bool) {
        let (before, after) = (h.modes(k - 1), h.modes(k));
        if struck {
            let speed = h.sliding_velocity_m_per_s[k - 1].abs();
            self.impacts = self.impacts.max(speed);
            if let Some(turn) = self.turn.take()
                && speed < SLOWEST_IMPACT_M_PER_S
            {
                self.events.remove(turn);
            }
            self.active = None;
            if after[0] == Mode::Stick {
                self.push(h, k, 0, EventKind::Rest, speed);
            } else if speed >= SLOWEST_IMPACT_M_PER_S {
                self.push(h, k, 0, EventKind::Impact, speed);
            }
            self.turn = None;
        }
        for i in usize::from(struck)..after.len() {
            let kind = match (before[i], after[i]) {
                (Mode::Stick, Mode::Slip(_)) => EventKind::Slip,
                (Mode::Slip(_), Mode::Stick) => EventKind::Stick,
                (a, b) if a != b => EventKind::Reversal,
                _ => continue,
            };
            if i == 0 {
                self.active = None;
            }
            self.push(h, k, i, kind, 0.0);
        }
        if let (Some(before), Some(after)) = (h.contact.get(k - 1), h.contact.get(k))
            && let Some(kind) = contact_event(*before, *after)
        {
            let speed = h.sliding_velocity_m_per_s[k].abs();
            self.push(h, k, 0, kind, speed);
        }
    }

    /// The slider slides from the knot `k` on these surfaces.
    pub(super) fn slides_on(&mut self, h: &History, k: usize, active: Vec<bool>) {
        if self.active.as_ref().is_some_and(|before| *before != active) {
            self.push(h, k, 0, EventKind::Surface, 0.0);
        }
        self.active = Some(active);
    }

    // ---- comparison -----------------------------------------------------------------------------

    /// [`Certificate::demands_error`](crate::check::Certificate::demands_error).
    pub(super) fn error(
        &self,
        model: &Model,
        response: &Response,
        h: &History,
        rounding: &Rounding,
    ) -> f64 {
        let mut c = Comparison { worst: 0.0 };
        let d = &response.demands;
        let instants_s = (self.events.len() + 1) as f64 * rounding.instant_s;
        let extremes = |list: &[f64]| {
            let most = list.iter().fold(list[0], |m, s| s.max(m));
            let least = list.iter().fold(list[0], |m, s| s.min(m));
            (most.abs().max(least.abs()), most, least, list[list.len() - 1])
        };
        let (peak_m, most_m, least_m, last_m) = extremes(&h.sliding_displacement_m);
        let near_m = rounding.displacement_m;
        for (printed, own) in [
            (d.peak_sliding_displacement_m, peak_m),
            (d.max_sliding_displacement_m, most_m),
            (d.min_sliding_displacement_m, least_m),
            (d.residual_sliding_displacement_m, last_m),
        ] {
            c.number(printed, own, near_m, peak_m);
        }
        first_time(&mut c, d, h, peak_m, rounding);
        let sums = &self.totals.interfaces;
        c.same(d.sliding_at_end == (h.modes(h.len() - 1)[0] != Mode::Stick));
        c.number(d.sliding_time_s, sums[0].sliding_s, instants_s, sums[0].sliding_s);
        // A path of many strokes is rounded in each.
        let strokes = if peak_m > near_m { sums[0].path_m / peak_m } else { 1.0 };
        c.number(d.sliding_path_m, sums[0].path_m, near_m * strokes, sums[0].path_m);
        self.of_peaks(&mut c, model, d, rounding, peak_m);
        for (e, contents) in d.contents.iter().enumerate().take(model.contents().len()) {
            let list: Vec<f64> = (0..h.len()).map(|k| h.contents_state(k, e)[0]).collect();
            let (peak_m, _, _, last_m) = extremes(&list);
            let own = sums[1 + e];
            let fast = self.peaks.contents_velocity[e];
            let rough = self.peaks.contents_acceleration[e];
            let per_kg = rounding.force_n / model.contents()[e].mass_kg;
            c.number(contents.peak_sliding_displacement_m, peak_m, near_m, peak_m);
            c.number(contents.residual_sliding_displacement_m, last_m, near_m, peak_m);
            c.number(contents.sliding_path_m, own.path_m, near_m, own.path_m);
            c.number(contents.sliding_time_s, own.sliding_s, instants_s, own.sliding_s);
            let near = rounding.velocity_m_per_s;
            c.number(contents.peak_sliding_velocity_m_per_s, fast, near, fast);
            c.number(contents.peak_acceleration_m_per_s2, rough, per_kg, rough);
        }
        c.same(d.contents.len() == model.contents().len());
        self.of_surfaces(&mut c, model, &d.surfaces, h, near_m);
        self.of_events(&mut c, response, peak_m.max(near_m), rounding);
        let closest = if response.method == Method::Exact { self.closest_stop } else { None };
        match (d.closest_stop, closest) {
            (Some(printed), Some(own)) => c.number(printed, own, self.stop_rounding, 1.0),
            (printed, own) => c.same(printed.is_none() && own.is_none()),
        }
        self.of_stop(&mut c, model, d, (instants_s, rounding));
        c.worst
    }

    fn of_surfaces(
        &self,
        c: &mut Comparison,
        model: &Model,
        printed: &[SurfaceDemands],
        h: &History,
        near_m: f64,
    ) {
        c.same(printed.len() == h.surfaces);
        let Some(series) = model.slider().series() else { return };
        for (i, (printed, surface)) in printed.iter().zip(series.surfaces()).enumerate() {
            let all = (0..h.len()).map(|k| h.surface_displacements(k)[i]);
            let peak_m = all.fold(0.0, |peak: f64, u| peak.max(u.abs()));
            c.number(printed.peak_displacement_m, peak_m, near_m, peak_m);
            let last_m = h.surface_displacements(h.len() - 1)[i];
            c.number(printed.residual_displacement_m, last_m, near_m, peak_m.max(near_m));
            let reached = surface.travel_m.is_some_and(|d| peak_m >= d * (1.0 - 1e-12));
            c.same(printed.end_reached == reached);
        }
    }

    fn of_stop(
        &self,
        c: &mut Comparison,
        model: &Model,
        d: &Demands,
        (instants_s, rounding): (f64, &Rounding),
    ) {
        match (&d.stop, model.stop()) {
            (Some(stop), Some(given)) => {
                let rigid = matches!(given.kind, StopKind::Rigid { .. });
                let of = |kind: EventKind| self.events.iter().filter(move |e| e.event.kind == kind);
                let touched = of(EventKind::Contact).fold(0.0, |p: f64, e| p.max(e.speed));
                let speed = if rigid { self.impacts } else { touched };
                c.same(stop.contact_count == of(EventKind::Contact).count() as u64);
                c.same(stop.impact_count == of(EventKind::Impact).count() as u64);
                c.number(stop.peak_force_n, self.peaks.stop, rounding.force_n, self.peaks.stop);
                let near = rounding.velocity_m_per_s;
                c.number(stop.peak_impact_speed_m_per_s, speed, near, speed);
                let own = self.totals.contact_s;
                c.number(stop.contact_time_s, own, instants_s, own);
            }
            (printed, own) => c.same(printed.is_none() && own.is_none()),
        }
    }

    fn of_peaks(
        &self,
        c: &mut Comparison,
        model: &Model,
        d: &Demands,
        rounding: &Rounding,
        peak_m: f64,
    ) {
        let (p, weight_n) = (&self.peaks, model.weight_n());
        let mut number = |printed: f64, own: f64, near: f64| c.number(printed, own, near, own);
        let (force_n, near_m) = (rounding.force_n, rounding.displacement_m);
        number(d.peak_sliding_velocity_m_per_s, p.velocity, rounding.velocity_m_per_s);
        number(d.peak_block_acceleration_m_per_s2, p.block, force_n / model.block().mass_kg);
        for (printed, coefficient, own) in [
            (d.peak_base_shear_n, d.base_shear_coefficient, p.shear),
            (d.peak_friction_force_n, d.friction_coefficient_used, p.friction),
            (d.peak_slider_force_n, d.slider_force_coefficient, p.slider),
        ] {
            number(printed, own, force_n);
            number(coefficient, own / weight_n, force_n / weight_n);
        }
        let heights_m = model.frame().heights_m.as_ref();
        let n = model.storeys();
        for (i, storey) in d.storeys.iter().enumerate().take(n) {
            number(storey.peak_displacement_m, p.displacement[i], near_m);
            number(storey.peak_drift_m, p.drift[i], near_m);
            let near = force_n / model.frame().masses_kg[i];
            number(storey.peak_acceleration_m_per_s2, p.acceleration[i], near);
        }
        c.same(d.storeys.len() == n);
        for (i, storey) in d.storeys.iter().enumerate().take(n) {
            let height_m = heights_m.map(|heights_m| heights_m[i]);
            let ratio = height_m.map(|height_m| p.drift[i] / height_m);
            c.optional(storey.peak_drift_ratio, ratio, near_m / height_m.unwrap_or(1.0));
        }
        let gap_m = model.slider().gap_m();
        c.optional(d.gap_ratio, gap_m.map(|gap_m| peak_m / gap_m), near_m / gap_m.unwrap_or(1.0));
        let block = model.block();
        let known = heights_m.is_some() || (model.storeys() == 0 && block.height_m.is_some());
        let moment = block.width_m.filter(|_| known).map(|width_m| 0.5 * width_m * weight_n);
        let ratio = moment.map(|moment| p.overturning / moment);
        let arm_m = self.heights_m.iter().fold(0.0, |most: f64, z| most.max(*z));
        c.optional(d.overturning_ratio, ratio, arm_m * force_n / moment.unwrap_or(1.0));
    }

    /// Counts, times, directions and places of the events, kind by kind.
    fn of_events(&self, c: &mut Comparison, response: &Response, peak_m: f64, rounding: &Rounding) {
        use EventKind::{
            Contact, Impact, Leave, Press, Rest, Reversal, Separation, Slip, Stick, Surface,
        };
        let interfaces = self.totals.interfaces.len();
        for interface in 0..interfaces {
            for kind in
                [Slip, Stick, Reversal, Contact, Separation, Press, Leave, Impact, Rest, Surface]
            {
                let fits = |e: &&Event| e.kind == kind && e.interface == interface;
                let own: Vec<&Event> =
                    self.events.iter().map(|told| &told.event).filter(fits).collect();
                let printed: Vec<&Event> = response.events.iter().filter(fits).collect();
                let count = own.len() as u64;
                c.same(printed.len() == own.len());
                let counts = match interface {
                    0 => {
                        let d = &response.demands;
                        Some([d.slip_count, d.stick_count, d.reversal_count])
                    }
                    _ => response
                        .demands
                        .contents
                        .get(interface - 1)
                        .map(|d| [d.slip_count, d.stick_count, d.reversal_count]),
                };
                let counted = match kind {
                    Slip => counts.map(|counts| counts[0]),
                    Stick => counts.map(|counts| counts[1]),
                    Reversal => counts.map(|counts| counts[2]),
                    _ => Some(count),
                };
                c.same(counted == Some(count));
                for (printed, own) in printed.into_iter().zip(own) {
                    c.same((printed.time_s - own.time_s).abs() <= rounding.instant_s);
                    c.same(printed.mode == own.mode);
                    let [printed, own] = [printed, own].map(|event| event.sliding_displacement_m);
                    c.number(printed, own, rounding.displacement_m, peak_m);
                }
            }
        }
    }
}
