//! What the response asks of the structure, recomputed from the check's own path.

use fearless_simd::f64x8;
use fearless_simd::prelude::*;

use super::collocation::{POINTS, Rule};
use super::structure::{Structure, larger};
use crate::model::Model;
use crate::response::{Contact, Demands, Event, EventKind, History, Method, Mode, Response};

/// Places of the tracked outputs; from [`STOREYS`] on displacements of all storeys, then drifts, then
/// total accelerations.
pub(super) mod output {
    pub(super) const VELOCITY: usize = 0;
    pub(super) const BLOCK: usize = 1;
    pub(super) const SLIDER: usize = 2;
    pub(super) const FRICTION: usize = 3;
    pub(super) const BASE_SHEAR: usize = 4;
    pub(super) const OVERTURNING: usize = 5;
    pub(super) const STOP: usize = 6;
    pub(in crate::check) const STOREYS: usize = 7;
}

/// All that is known at an instant.
pub(super) struct Instant<'a> {
    pub(super) x: &'a [f64],
    pub(super) v: &'a [f64],
    /// `ẍ`, relative as `x` is.
    pub(super) rate: &'a [f64],
    /// `Ü + g sin θ`.
    pub(super) a: f64,
    /// `T`.
    pub(super) force: f64,
    /// Force of the block on the stop towards +x.
    pub(super) stop: f64,
}

/// The tracked outputs: linear functions of state, accelerations and forces.
pub(super) struct Outputs<'a> {
    structure: &'a Structure,
    /// Mass times height of each floor, and of the block's centre; `None`: no moment is asked for.
    arm: Option<(Vec<f64>, f64)>,
    /// `g sin θ`.
    slope: f64,
}

impl<'a> Outputs<'a> {
    pub(super) fn new(model: &Model, structure: &'a Structure) -> Self {
        Self { structure, arm: arm(model), slope: model.slope_m_per_s2() }
    }

    /// How many there are.
    pub(super) fn len(&self) -> usize {
        output::STOREYS + 3 * (self.structure.degrees() - 1)
    }

    /// The overturning moment about the sliding surface from total accelerations with the slope's
    /// share, in lanes.
    #[inline(always)]
    pub(super) fn moment<S: Simd>(
        &self,
        simd: S,
        block: f64x8<S>,
        floor: impl Fn(usize) -> f64x8<S>,
    ) -> f64x8<S> {
        let Some((floors, half)) = &self.arm else { return f64x8::splat(simd, 0.0) };
        let mut sum = f64x8::splat(simd, *half) * block;
        for (i, &arm) in floors.iter().enumerate() {
            sum += f64x8::splat(simd, arm) * floor(i);
        }
        sum
    }

    /// Their values.
    pub(super) fn at(&self, now: &Instant, out: &mut [f64]) {
        let n = now.x.len() - 1;
        let block = now.rate[0] + now.a;
        let moment = self.arm.as_ref().map_or(0.0, |(floors, half)| {
            let floors = floors.iter().zip(&now.rate[1..]);
            half * block + floors.map(|(arm, rate)| arm * (rate + block)).sum::<f64>()
        });
        out[output::VELOCITY] = now.v[0];
        out[output::BLOCK] = block - self.slope;
        out[output::SLIDER] =
            now.force - self.structure.slider_force(now.x[0], now.v[0]) - now.stop;
        out[output::FRICTION] = now.force;
        out[output::BASE_SHEAR] = self.structure.base_force(&now.x[1..], &now.v[1..]);
        out[output::OVERTURNING] = moment;
        out[output::STOP] = now.stop;
        let (q, rest) = out[output::STOREYS..].split_at_mut(n);
        let (drift, acceleration) = rest.split_at_mut(n);
        let mut below = 0.0;
        for i in 0..n {
            q[i] = now.x[1 + i];
            drift[i] = q[i] - below;
            below = q[i];
            acceleration[i] = now.rate[1 + i] + block - self.slope;
        }
    }
}

/// `m_i z_i` of the floors and `M1 z/2` of the block, where width and heights are given.
fn arm(model: &Model) -> Option<(Vec<f64>, f64)> {
    let (block, frame) = (model.block(), model.frame());
    block.width_m?;
    let heights_m = match &frame.heights_m {
        Some(heights_m) => heights_m.as_slice(),
        None if model.storeys() == 0 && block.height_m.is_some() => &[],
        None => return None,
    };
    let mut above_m = block.height_m.unwrap_or(0.0);
    let half = 0.5 * above_m * block.mass_kg;
    let floors = frame.masses_kg.iter().zip(heights_m).map(|(mass, height_m)| {
        above_m += height_m;
        mass * above_m
    });
    Some((floors.collect(), half))
}

/// Largest sizes of the outputs so far.
pub(super) struct Peaks<'a> {
    pub(super) outputs: Outputs<'a>,
    pub(super) attained: Vec<f64>,
    values: Vec<f64>,
}

impl<'a> Peaks<'a> {
    pub(super) fn new(outputs: Outputs<'a>) -> Self {
        let length = outputs.len();
        Self { attained: vec![0.0; length], values: vec![0.0; length], outputs }
    }

    /// The largest |ṡ|.
    pub(super) fn speed(&self) -> f64 {
        self.attained[output::VELOCITY]
    }

    /// The largest total acceleration of the block.
    pub(super) fn block_acceleration(&self) -> f64 {
        self.attained[output::BLOCK]
    }

    /// Stores the values at an instant as those at a point of a step.
    pub(super) fn outputs_at(&mut self, now: &Instant, values: &mut [[f64; POINTS]], point: usize) {
        self.outputs.at(now, &mut self.values);
        for (values, &value) in values.iter_mut().zip(&self.values) {
            values[point] = value;
        }
    }

    /// Takes the values at the ends of a step; whether outputs that are `off` the chord between may
    /// pass what has been attained. Rounding (1e-12 of the peak) passes nothing.
    pub(super) fn may_pass(
        &mut self,
        values: &[[f64; POINTS]],
        off: impl Iterator<Item = f64>,
    ) -> bool {
        let mut passes = false;
        for ((peak, values), off) in self.attained.iter_mut().zip(values).zip(off) {
            let ends = values[0].abs().max(values[POINTS - 1].abs());
            passes |= !(ends + off <= *peak * (1.0 + 1e-12));
            *peak = larger(*peak, ends);
        }
        passes
    }

    /// Takes the largest size of a polynomial through an output's values at the points of a step.
    pub(super) fn search(&mut self, rule: &Rule, output: usize, values: &[f64; POINTS]) {
        raise(rule, &mut self.attained[output], values);
    }
}

/// Raises a peak to the largest size of a polynomial through the values at the points of a step.
pub(super) fn raise(rule: &Rule, peak: &mut f64, values: &[f64; POINTS]) {
    let size = |value: f64| value.abs();
    let at = |best: usize, i: usize| if size(values[i]) > size(values[best]) { i } else { best };
    let best = (1..POINTS).fold(0, at);
    let (least, most) =
        values.iter().fold((values[0], values[0]), |(least, most), &v| (v.min(least), v.max(most)));
    *peak = larger(*peak, values[best]);
    // Between two points the polynomial rises above both by less than a tenth of its range.
    if size(values[best]) + 0.1 * (most - least) <= *peak * (1.0 + 1e-12) {
        return;
    }
    let sign = values[best].signum();
    let (_, lowest) = rule.least(values, best, |_, value| -sign * value);
    *peak = larger(*peak, lowest);
}

/// What is added up from knot to knot.
#[derive(Default)]
pub(super) struct Totals {
    pub(super) path_m: f64,
    pub(super) sliding_s: f64,
    pub(super) contact_s: f64,
    /// Least margin of the decisions at stops, and what the rounding of their times makes of one.
    pub(super) closest_stop: Option<f64>,
    pub(super) stop_rounding: f64,
}

impl Totals {
    /// Adds the length of an interval.
    pub(super) fn add(&mut self, mode: Mode, contact: Contact, length_s: f64) {
        if mode != Mode::Stick {
            self.sliding_s += length_s;
        }
        if matches!(contact, Contact::Pressed(_)) {
            self.contact_s += length_s;
        }
    }
}

/// What the rounding of the knots leaves undecided.
pub(super) struct Rounding {
    pub(super) instant_s: f64,
    pub(super) displacement_m: f64,
    pub(super) velocity_m_per_s: f64,
    pub(super) force_n: f64,
}

/// The largest difference between printed and recomputed demands so far.
pub(super) struct Comparison {
    pub(super) worst: f64,
}

impl Comparison {
    /// A number, of which `rounding` is no difference, over a peak.
    pub(super) fn number(&mut self, printed: f64, own: f64, rounding: f64, peak: f64) {
        let difference = (printed - own).abs() - rounding;
        if !(difference <= 0.0) {
            self.worst = larger(self.worst, difference / peak.abs());
        }
    }

    pub(super) fn same(&mut self, is: bool) {
        if !is {
            self.worst = larger(self.worst, 1.0);
        }
    }

    pub(super) fn optional(&mut self, printed: Option<f64>, own: Option<f64>, rounding: f64) {
        match (printed, own) {
            (Some(printed), Some(own)) => self.number(printed, own, rounding, own),
            (printed, own) => self.same(printed.is_none() && own.is_none()),
        }
    }
}

/// [`super::Certificate::demands_error`].
pub(super) fn error(
    model: &Model,
    response: &Response,
    history: &History,
    (peaks, totals): (&Peaks, &Totals),
    rounding: &Rounding,
) -> f64 {
    let mut c = Comparison { worst: 0.0 };
    let d = &response.demands;
    let s = &history.sliding_displacement_m;
    let peak_m = s.iter().fold(0.0, |p, &s| larger(p, s));
    let [most_m, least_m] =
        [s.iter().fold(s[0], |m, &s| s.max(m)), s.iter().fold(s[0], |m, &s| s.min(m))];
    let (last_m, near_m) = (s[s.len() - 1], rounding.displacement_m);
    for (printed, own) in [
        (d.peak_sliding_displacement_m, peak_m),
        (d.max_sliding_displacement_m, most_m),
        (d.min_sliding_displacement_m, least_m),
        (d.residual_sliding_displacement_m, last_m),
    ] {
        c.number(printed, own, near_m, peak_m);
    }
    c.same(d.sliding_at_end == (history.mode.last() != Some(&Mode::Stick)));
    first_time(&mut c, d, history, peak_m, rounding);
    let events = own_events(model, history);
    // The times of slips begin and end at events.
    let instants_s = (events.len() + 1) as f64 * rounding.instant_s;
    c.number(d.sliding_time_s, totals.sliding_s, instants_s, totals.sliding_s);
    c.number(d.sliding_path_m, totals.path_m, near_m, totals.path_m);
    of_peaks(&mut c, model, d, &peaks.attained, (peak_m, rounding));
    of_events(&mut c, response, &events, peak_m, rounding);
    let closest = if response.method == Method::Exact { totals.closest_stop } else { None };
    match (d.closest_stop, closest) {
        (Some(printed), Some(own)) => c.number(printed, own, totals.stop_rounding, 1.0),
        (printed, own) => c.same(printed.is_none() && own.is_none()),
    }
    match (&d.stop, model.stop()) {
        (Some(stop), Some(_)) => {
            let reached = |e: &&Own| e.event.kind == EventKind::Contact;
            let speed = events.iter().filter(reached).fold(0.0, |p, e| larger(p, e.speed));
            c.same(stop.contact_count == events.iter().filter(reached).count() as u64);
            c.same(stop.impact_count == 0);
            let force = peaks.attained[output::STOP];
            c.number(stop.peak_force_n, force, rounding.force_n, force);
            c.number(stop.peak_impact_speed_m_per_s, speed, rounding.velocity_m_per_s, speed);
            c.number(stop.contact_time_s, totals.contact_s, instants_s, totals.contact_s);
        }
        (printed, own) => c.same(printed.is_none() && own.is_none()),
    }
    c.worst
}

/// Peaks of the outputs, and what is a multiple of one.
fn of_peaks(
    c: &mut Comparison,
    model: &Model,
    d: &Demands,
    peak: &[f64],
    (peak_m, rounding): (f64, &Rounding),
) {
    let weight_n = model.weight_n();
    let n = model.storeys();
    let mut number = |printed: f64, own: f64, rounding: f64| c.number(printed, own, rounding, own);
    let (block_kg, masses_kg) = (model.block().mass_kg, &model.frame().masses_kg);
    let (force_n, near_m) = (rounding.force_n, rounding.displacement_m);
    let fast = rounding.velocity_m_per_s;
    number(d.peak_sliding_velocity_m_per_s, peak[output::VELOCITY], fast);
    number(d.peak_block_acceleration_m_per_s2, peak[output::BLOCK], force_n / block_kg);
    for (printed, coefficient, i) in [
        (d.peak_base_shear_n, d.base_shear_coefficient, output::BASE_SHEAR),
        (d.peak_friction_force_n, d.friction_coefficient_used, output::FRICTION),
        (d.peak_slider_force_n, d.slider_force_coefficient, output::SLIDER),
    ] {
        number(printed, peak[i], force_n);
        number(coefficient, peak[i] / weight_n, force_n / weight_n);
    }
    let heights_m = model.frame().heights_m.as_ref();
    let own = &peak[output::STOREYS..];
    for (i, storey) in d.storeys.iter().enumerate().take(n) {
        number(storey.peak_displacement_m, own[i], near_m);
        number(storey.peak_drift_m, own[n + i], near_m);
        let acceleration = own[2 * n + i];
        number(storey.peak_acceleration_m_per_s2, acceleration, force_n / masses_kg[i]);
    }
    for (i, storey) in d.storeys.iter().enumerate().take(n) {
        let height_m = heights_m.map(|heights_m| heights_m[i]);
        let ratio = height_m.map(|height_m| own[n + i] / height_m);
        c.optional(storey.peak_drift_ratio, ratio, near_m / height_m.unwrap_or(1.0));
    }
    c.same(d.storeys.len() == n);
    let gap_m = model.slider().gap_m();
    c.optional(d.gap_ratio, gap_m.map(|gap_m| peak_m / gap_m), near_m / gap_m.unwrap_or(1.0));
    let arm = arm(model);
    let width_m = model.block().width_m.filter(|_| arm.is_some());
    let moment = width_m.map(|width_m| 0.5 * width_m * weight_n);
    let ratio = moment.map(|moment| peak[output::OVERTURNING] / moment);
    let near = arm.map_or(0.0, |(floors, half)| {
        let arm_m = floors.iter().zip(masses_kg).map(|(arm, mass)| arm / mass);
        arm_m.fold(half / block_kg, f64::max) * force_n
    });
    c.optional(d.overturning_ratio, ratio, near / moment.unwrap_or(1.0));
}

/// The printed time of the peak is that of a knot where |s| has risen to it.
pub(super) fn first_time(
    c: &mut Comparison,
    d: &Demands,
    h: &History,
    peak_m: f64,
    rounding: &Rounding,
) {
    let at_s = d.peak_sliding_displacement_time_s;
    let size = |k: usize| h.sliding_displacement_m[k].abs();
    let near = |k: &usize| (h.time_s[*k] - at_s).abs() <= rounding.instant_s;
    let knots = (0..h.len()).filter(near);
    let Some(best) = knots.reduce(|best, k| if size(k) > size(best) { k } else { best }) else {
        c.same(false);
        return;
    };
    c.number(size(best), peak_m, rounding.displacement_m, peak_m);
    // Where the block rests at its peak, the first instant counts.
    let before = (0..best).rev().find(|&k| h.time_s[k] < at_s - rounding.instant_s);
    c.same(before.is_none_or(|k| size(k) < size(best)));
}

/// An event that the knots tell, with the sliding speed at it.
struct Own {
    event: Event,
    speed: f64,
}

/// The events that the changes of mode and contact between knots are.
fn own_events(model: &Model, h: &History) -> Vec<Own> {
    let mut events = Vec::new();
    let mut push = |k: usize, kind: EventKind| {
        let event = Event {
            time_s: h.time_s[k],
            kind,
            mode: h.mode[k],
            sliding_displacement_m: h.sliding_displacement_m[k],
            interface: 0,
        };
        events.push(Own { event, speed: h.sliding_velocity_m_per_s[k].abs() });
    };
    if h.mode[0] != Mode::Stick && model.initial().sliding_velocity_m_per_s == 0.0 {
        push(0, EventKind::Slip);
    }
    for k in 1..h.len() {
        match (h.mode[k - 1], h.mode[k]) {
            (Mode::Stick, Mode::Slip(_)) => push(k, EventKind::Slip),
            (Mode::Slip(_), Mode::Stick) => push(k, EventKind::Stick),
            (before, after) if before != after => push(k, EventKind::Reversal),
            _ => {}
        }
        if let (Some(before), Some(after)) = (h.contact.get(k - 1), h.contact.get(k))
            && let Some(kind) = super::law::contact_event(*before, *after)
        {
            push(k, kind);
        }
    }
    events
}

/// Counts, times, directions and places of the events, kind by kind.
fn of_events(
    c: &mut Comparison,
    response: &Response,
    own: &[Own],
    peak_m: f64,
    rounding: &Rounding,
) {
    use EventKind::{Contact, Leave, Press, Reversal, Separation, Slip, Stick};
    for kind in [Slip, Stick, Reversal, Contact, Separation, Press, Leave] {
        let own = || own.iter().map(|own| &own.event).filter(|event| event.kind == kind);
        let printed = || response.events.iter().filter(|event| event.kind == kind);
        let count = own().count();
        c.same(printed().count() == count);
        let d = &response.demands;
        match kind {
            Slip => c.same(d.slip_count == count as u64),
            Stick => c.same(d.stick_count == count as u64),
            Reversal => c.same(d.reversal_count == count as u64),
            _ => {}
        }
        for (printed, own) in printed().zip(own()) {
            c.same((printed.time_s - own.time_s).abs() <= rounding.instant_s);
            c.same(printed.mode == own.mode);
            let [printed, own] = [printed, own].map(|event| event.sliding_displacement_m);
            c.number(printed, own, rounding.displacement_m, peak_m);
        }
    }
}
