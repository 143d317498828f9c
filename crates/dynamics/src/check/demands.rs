//! The printed demands and events, compared with those of the check's own path.

use super::events::{Events, JudgedEvent};
use super::outputs::Outputs;
use super::structure::larger;
use crate::model::{Model, StopKind};
use crate::response::output::Output;
use crate::response::{
    Contact, Demands, Event, EventKind, History, Method, Mode, Response, SurfaceDemands,
};

/// Sums of one interface.
#[derive(Clone, Copy, Default)]
pub(super) struct Sums {
    pub(super) path_m: f64,
    pub(super) sliding_s: f64,
}

/// What is added up from knot to knot.
pub(super) struct Totals {
    pub(super) interfaces: Vec<Sums>,
    contact_s: f64,
    /// Least margin of the decisions at stops, and what the rounding of their times makes of one.
    closest_stop: Option<f64>,
    stop_rounding: f64,
}

impl Totals {
    pub(super) fn new(interfaces: usize) -> Self {
        let interfaces = vec![Sums::default(); interfaces];
        Self { interfaces, contact_s: 0.0, closest_stop: None, stop_rounding: 0.0 }
    }

    /// Adds the length of an interval; `bears_on_stop` where the block is against a rigid stop.
    pub(super) fn add(
        &mut self,
        modes: &[Mode],
        contact: Contact,
        length_s: f64,
        bears_on_stop: bool,
    ) {
        for (sums, mode) in self.interfaces.iter_mut().zip(modes) {
            if *mode != Mode::Stick {
                sums.sliding_s += length_s;
            }
        }
        if matches!(contact, Contact::Pressed(_)) || (bears_on_stop && modes[0] == Mode::Stick) {
            self.contact_s += length_s;
        }
    }

    /// A stop of the slider was decided.
    pub(super) fn decided(&mut self, margin: f64, drift: f64) {
        if self.closest_stop.is_none_or(|least| margin < least) {
            self.closest_stop = Some(margin);
            self.stop_rounding = drift + 1e3 * f64::EPSILON;
        }
    }
}

/// What the check has found by itself.
#[derive(Clone, Copy)]
pub(super) struct Recomputed<'a> {
    pub(super) outputs: &'a Outputs,
    /// Peak, largest, least and last sliding displacement, and what they are measured by.
    pub(super) sliding_m: [f64; 4],
    pub(super) scale_m: f64,
    /// Largest sizes of the outputs.
    pub(super) peaks: &'a [f64],
    /// Largest sizes with what rounding decides, and what differences are measured by.
    pub(super) possible: &'a [f64],
    pub(super) scales: &'a [f64],
    pub(super) totals: &'a Totals,
    pub(super) events: &'a Events,
    /// What a gap ratio and an overturning ratio are asked of.
    pub(super) gap_m: Option<f64>,
    pub(super) width_m: Option<f64>,
    /// Of both axes together, in place of a width.
    pub(super) corner: Option<Corner>,
}

/// The overturning ratio of a base at its corners.
#[derive(Clone, Copy)]
pub(super) struct Corner {
    /// Least and largest that it may be.
    pub(super) ratio: [f64; 2],
    /// What a moment along both axes makes of it, in 1/(N m).
    pub(super) per_n_m: f64,
}

impl Recomputed<'_> {
    /// Least and largest peak of an output, and its scale.
    fn peak(&self, output: Output) -> [f64; 3] {
        let i = self.outputs.place(output);
        [self.peaks[i], self.possible[i].max(self.peaks[i]), self.scales[i]]
    }
}

/// What the rounding of the knots leaves undecided.
#[derive(Default)]
pub(super) struct Rounding {
    pub(super) instant_s: f64,
    pub(super) displacement_m: f64,
    pub(super) velocity_m_per_s: f64,
    pub(super) force_n: f64,
}

/// The largest difference between printed and recomputed demands so far.
#[derive(Default)]
pub(super) struct Comparison {
    pub(super) worst: f64,
    /// What is compared now: the axis, and the demand of a part with its number from 1.
    axis: &'static str,
    now: (&'static str, usize, &'static str),
    /// What was compared when the worst was found.
    found: Option<(&'static str, (&'static str, usize, &'static str))>,
}

impl Comparison {
    /// What comes next is of an axis, `x.` or `y.`.
    pub(super) fn along(&mut self, axis: &'static str) {
        self.axis = axis;
    }

    /// What comes next is this demand.
    pub(super) fn of(&mut self, demand: &'static str) {
        self.now = ("", 0, demand);
    }

    /// What comes next is this demand of a part, by its index.
    fn of_part(&mut self, part: &'static str, index: usize, demand: &'static str) {
        self.now = (part, index + 1, demand);
    }

    /// The key of the demand with the largest difference.
    pub(super) fn worst_of(&self) -> Option<String> {
        let (axis, (part, number, demand)) = self.found?;
        Some(match part {
            "" => format!("{axis}{demand}"),
            _ => format!("{axis}{part}{number}_{demand}"),
        })
    }

    fn take(&mut self, difference: f64) {
        let worst = larger(self.worst, difference);
        if worst.to_bits() != self.worst.to_bits() {
            (self.worst, self.found) = (worst, Some((self.axis, self.now)));
        }
    }

    /// A number, of which `rounding` is no difference, over a peak.
    pub(super) fn number(&mut self, printed: f64, own: f64, rounding: f64, peak: f64) {
        self.within(printed, [own, own, peak], rounding);
    }

    /// A number from a least to a largest, over a peak.
    pub(super) fn within(&mut self, printed: f64, [least, most, peak]: [f64; 3], rounding: f64) {
        let difference = (printed - most).max(least - printed) - rounding;
        if !(difference <= 0.0) {
            self.take(difference / peak.abs());
        }
    }

    pub(super) fn same(&mut self, is: bool) {
        if !is {
            self.take(1.0);
        }
    }

    pub(super) fn optional(&mut self, printed: Option<f64>, own: Option<[f64; 3]>, rounding: f64) {
        match (printed, own) {
            (Some(printed), Some(own)) => self.within(printed, own, rounding),
            (printed, own) => self.same(printed.is_none() && own.is_none()),
        }
    }
}

/// Compares the printed demands of a whole motion with one's own.
pub(super) fn of_motion(
    c: &mut Comparison,
    (model, response, h): (&Model, &Response, &History),
    own: &Recomputed<'_>,
    rounding: &Rounding,
) {
    let (d, near_m) = (&response.demands, rounding.displacement_m);
    of_directions(c, model, d, own, rounding);
    let instants_s = of_sums(c, d, h, own, rounding);
    of_contents(c, model, (d, h), own, (instants_s, rounding));
    of_surfaces(c, model, &d.surfaces, h, near_m);
    of_events(c, response, own, own.scale_m.max(near_m), rounding);
    of_stops(c, response, own);
    of_stop(c, model, d, own, (instants_s, rounding));
}

/// Compares what there is in every direction: sliding displacements and the peaks of outputs.
pub(super) fn of_directions(
    c: &mut Comparison,
    model: &Model,
    d: &Demands,
    own: &Recomputed<'_>,
    rounding: &Rounding,
) {
    let printed = [
        ("peak_sliding_displacement_m", d.peak_sliding_displacement_m),
        ("max_sliding_displacement_m", d.max_sliding_displacement_m),
        ("min_sliding_displacement_m", d.min_sliding_displacement_m),
        ("residual_sliding_displacement_m", d.residual_sliding_displacement_m),
    ];
    for ((name, printed), own_m) in printed.into_iter().zip(own.sliding_m) {
        c.of(name);
        c.number(printed, own_m, rounding.displacement_m, own.scale_m);
    }
    of_peaks(c, model, d, own, rounding);
}

/// Sums over time; what the rounding of all times makes of one.
fn of_sums(
    c: &mut Comparison,
    d: &Demands,
    h: &History,
    own: &Recomputed<'_>,
    rounding: &Rounding,
) -> f64 {
    let peak_m = own.scale_m;
    let instants_s = (own.events.list.len() + 1) as f64 * rounding.instant_s;
    let near_m = rounding.displacement_m;
    let sums = &own.totals.interfaces[0];
    c.of("sliding_at_end");
    c.same(d.sliding_at_end == (h.modes(h.len() - 1)[0] != Mode::Stick));
    c.of("sliding_time_s");
    c.number(d.sliding_time_s, sums.sliding_s, instants_s, sums.sliding_s);
    // A path of many strokes is rounded in each.
    let strokes = if peak_m > near_m { sums.path_m / peak_m } else { 1.0 };
    c.of("sliding_path_m");
    c.number(d.sliding_path_m, sums.path_m, near_m * strokes.max(1.0), sums.path_m);
    instants_s
}

/// The least margin of the decisions at stops.
fn of_stops(c: &mut Comparison, response: &Response, own: &Recomputed<'_>) {
    let closest = own.totals.closest_stop.filter(|_| response.method == Method::Exact);
    c.of("closest_stop");
    match (response.demands.closest_stop, closest) {
        (Some(printed), Some(margin)) => {
            c.number(printed, margin, own.totals.stop_rounding, 1.0);
        }
        (printed, own) => c.same(printed.is_none() && own.is_none()),
    }
}

/// Largest size, largest, least and last of a list.
pub(super) fn extremes(list: impl Iterator<Item = f64>) -> [f64; 4] {
    let start = [0.0, f64::NEG_INFINITY, f64::INFINITY, 0.0];
    list.fold(start, |[peak, most, least, _], x| [larger(peak, x), x.max(most), x.min(least), x])
}

/// Peaks of the outputs, and what is a multiple of one.
fn of_peaks(
    c: &mut Comparison,
    model: &Model,
    d: &Demands,
    own: &Recomputed<'_>,
    rounding: &Rounding,
) {
    let weight_n = model.weight_n();
    let (force_n, near_m) = (rounding.force_n, rounding.displacement_m);
    let over = |output: Output, divisor: f64| own.peak(output).map(|peak| peak / divisor);
    let near = rounding.velocity_m_per_s;
    c.of("peak_sliding_velocity_m_per_s");
    c.within(d.peak_sliding_velocity_m_per_s, own.peak(Output::Velocity), near);
    let near = force_n / model.block().mass_kg;
    c.of("block.peak_acceleration_m_per_s2");
    c.within(d.peak_block_acceleration_m_per_s2, own.peak(Output::Block), near);
    for (name, printed, coefficient, output) in [
        ("peak_base_shear_n", d.peak_base_shear_n, d.base_shear_coefficient, Output::BaseShear),
        (
            "peak_friction_force_n",
            d.peak_friction_force_n,
            d.friction_coefficient_used,
            Output::FrictionForce,
        ),
        (
            "peak_slider_force_n",
            d.peak_slider_force_n,
            d.slider_force_coefficient,
            Output::SliderForce,
        ),
    ] {
        c.of(name);
        c.within(printed, own.peak(output), force_n);
        c.within(coefficient, over(output, weight_n), force_n / weight_n);
    }
    of_points(c, model, d, own, rounding);
    let ratio = own.gap_m.map(|gap_m| [own.scale_m / gap_m; 3]);
    c.of("gap_ratio");
    c.optional(d.gap_ratio, ratio, near_m / own.gap_m.unwrap_or(1.0));
    let width_m = own.width_m.filter(|_| own.outputs.has_moment());
    let moment = width_m.map(|width_m| 0.5 * width_m * weight_n);
    let (ratio, per_n_m) = match (own.corner, moment) {
        (Some(Corner { ratio: [least, most], per_n_m }), _) => (Some([least, most, most]), per_n_m),
        (None, Some(moment)) => (Some(over(Output::Overturning, moment)), 1.0 / moment),
        (None, None) => (None, 1.0),
    };
    let near = own.outputs.height_m(model) * force_n;
    c.of("overturning_ratio");
    c.optional(d.overturning_ratio, ratio, near * per_n_m);
}

/// Peaks of storeys, or of points.
fn of_points(
    c: &mut Comparison,
    model: &Model,
    d: &Demands,
    own: &Recomputed<'_>,
    rounding: &Rounding,
) {
    let n = model.points();
    let (force_n, near_m) = (rounding.force_n, rounding.displacement_m);
    // What rounding of forces makes of an acceleration: of a point through the oscillators of its modes.
    let of_mode = |i: usize| {
        let modes = model.structure().into_iter().flat_map(|structure| &structure.modes);
        modes.map(move |mode| (mode.points[i] / mode.effective_mass_kg).abs()).sum::<f64>()
    };
    let mass_kg = |i: usize| match model.structure() {
        Some(_) => 1.0 / (of_mode(i) + 1.0 / model.block().mass_kg),
        None => model.frame().masses_kg[i],
    };
    let points = if model.structure().is_some() { &d.points } else { &d.storeys };
    let part = if model.structure().is_some() { "point" } else { "storey" };
    let has_masses = model.has_point_masses();
    for (i, storey) in points.iter().enumerate().take(n) {
        c.of_part(part, i, "peak_displacement_m");
        c.within(storey.peak_displacement_m, own.peak(Output::Displacement(i)), near_m);
        c.of_part(part, i, "peak_drift_m");
        c.within(storey.peak_drift_m, own.peak(Output::Drift(i)), near_m);
        c.of_part(part, i, "peak_drift_velocity_m_per_s");
        let fast = own.peak(Output::DriftVelocity(i));
        c.within(storey.peak_drift_velocity_m_per_s, fast, rounding.velocity_m_per_s);
        c.of_part(part, i, "peak_shear_n");
        let shear = has_masses.then(|| own.peak(Output::StoreyShear(i)));
        c.optional(storey.peak_shear_n, shear, force_n);
        let near = force_n / mass_kg(i);
        c.of_part(part, i, "peak_acceleration_m_per_s2");
        c.within(storey.peak_acceleration_m_per_s2, own.peak(Output::Acceleration(i)), near);
    }
    for (i, storey) in points.iter().enumerate().take(n) {
        let height_m = model.rise_m(i);
        let ratio = height_m.map(|height_m| own.peak(Output::Drift(i)).map(|peak| peak / height_m));
        c.of_part(part, i, "peak_drift_ratio");
        c.optional(storey.peak_drift_ratio, ratio, near_m / height_m.unwrap_or(1.0));
    }
    c.of("storeys");
    c.same(d.storeys.len() + d.points.len() == n && points.len() == n);
}

fn of_contents(
    c: &mut Comparison,
    model: &Model,
    (d, h): (&Demands, &History),
    own: &Recomputed<'_>,
    (instants_s, rounding): (f64, &Rounding),
) {
    let contents = model.contents();
    c.of("contents");
    c.same(d.contents.len() == contents.len());
    for (e, (printed, given)) in d.contents.iter().zip(contents).enumerate() {
        let places = (0..h.len()).map(|k| h.contents_state(k, e)[0]);
        let [peak_m, _, _, last_m] = extremes(places);
        let (sums, near_m) = (own.totals.interfaces[1 + e], rounding.displacement_m);
        let [fast, rough] = [Output::ContentsVelocity(e), Output::ContentsAcceleration(e)]
            .map(|output| own.peaks[own.outputs.place(output)]);
        c.of_part("contents", e, "peak_sliding_displacement_m");
        c.number(printed.peak_sliding_displacement_m, peak_m, near_m, peak_m);
        c.of_part("contents", e, "residual_sliding_displacement_m");
        c.number(printed.residual_sliding_displacement_m, last_m, near_m, peak_m);
        c.of_part("contents", e, "sliding_path_m");
        c.number(printed.sliding_path_m, sums.path_m, near_m, sums.path_m);
        c.of_part("contents", e, "sliding_time_s");
        c.number(printed.sliding_time_s, sums.sliding_s, instants_s, sums.sliding_s);
        let near = rounding.velocity_m_per_s;
        c.of_part("contents", e, "peak_sliding_velocity_m_per_s");
        c.number(printed.peak_sliding_velocity_m_per_s, fast, near, fast);
        let near = rounding.force_n / given.mass_kg;
        c.of_part("contents", e, "peak_acceleration_m_per_s2");
        c.number(printed.peak_acceleration_m_per_s2, rough, near, rough);
    }
}

/// The printed time of the peak is that of a knot where |s| has risen to it.
pub(super) fn of_peak_time(
    c: &mut Comparison,
    d: &Demands,
    h: &History,
    peak_m: f64,
    rounding: &Rounding,
) {
    c.of("peak_sliding_displacement_time_s");
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

fn of_surfaces(
    c: &mut Comparison,
    model: &Model,
    printed: &[SurfaceDemands],
    h: &History,
    near_m: f64,
) {
    c.of("surfaces");
    c.same(printed.len() == h.surfaces);
    let Some(series) = model.slider().series() else { return };
    for (i, (printed, surface)) in printed.iter().zip(series.surfaces()).enumerate() {
        let all = (0..h.len()).map(|k| h.surface_displacements(k)[i]);
        let peak_m = all.fold(0.0, |peak: f64, u| peak.max(u.abs()));
        c.of_part("surface", i, "peak_displacement_m");
        c.number(printed.peak_displacement_m, peak_m, near_m, peak_m);
        let last_m = h.surface_displacements(h.len() - 1)[i];
        c.of_part("surface", i, "residual_displacement_m");
        c.number(printed.residual_displacement_m, last_m, near_m, peak_m.max(near_m));
        let reached = surface.travel_m.is_some_and(|d| peak_m >= d * (1.0 - 1e-12));
        c.of_part("surface", i, "end_reached");
        c.same(printed.end_reached == reached);
    }
}

fn of_stop(
    c: &mut Comparison,
    model: &Model,
    d: &Demands,
    own: &Recomputed<'_>,
    (instants_s, rounding): (f64, &Rounding),
) {
    c.of("stop");
    match (&d.stop, model.stop()) {
        (Some(stop), Some(given)) => {
            let rigid = matches!(given.kind, StopKind::Rigid { .. });
            let of = |kind: EventKind| own.events.list.iter().filter(move |e| e.event.kind == kind);
            let touched = of(EventKind::Contact).fold(0.0, |p: f64, e| p.max(e.speed));
            let speed = if rigid { own.events.impacts } else { touched };
            let force_n = own.peaks[own.outputs.of_stop()];
            c.of("stop.contact_count");
            c.same(stop.contact_count == of(EventKind::Contact).count() as u64);
            c.of("stop.impact_count");
            c.same(stop.impact_count == of(EventKind::Impact).count() as u64);
            c.of("stop.peak_force_n");
            c.number(stop.peak_force_n, force_n, rounding.force_n, force_n);
            let near = rounding.velocity_m_per_s;
            c.of("stop.peak_impact_speed_m_per_s");
            c.number(stop.peak_impact_speed_m_per_s, speed, near, speed);
            let own = own.totals.contact_s;
            c.of("stop.contact_time_s");
            c.number(stop.contact_time_s, own, instants_s, own);
        }
        (printed, own) => c.same(printed.is_none() && own.is_none()),
    }
}

/// Counts, times, directions and places of the events, kind by kind.
fn of_events(
    c: &mut Comparison,
    response: &Response,
    own: &Recomputed<'_>,
    peak_m: f64,
    rounding: &Rounding,
) {
    c.of("events");
    let all = &own.events.list;
    let interfaces = own.totals.interfaces.len();
    for interface in 0..interfaces {
        for kind in EventKind::ALL {
            let fits = |e: &&Event| e.kind == kind && e.interface == interface;
            let own: Vec<&Event> =
                all.iter().map(|judged: &JudgedEvent| &judged.event).filter(fits).collect();
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
                EventKind::Slip => counts.map(|counts| counts[0]),
                EventKind::Stick => counts.map(|counts| counts[1]),
                EventKind::Reversal => counts.map(|counts| counts[2]),
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
