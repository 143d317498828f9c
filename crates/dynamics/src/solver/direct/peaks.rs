//! Peaks of the series, and the knots of the history.

use core::ops::Range;

use super::super::course::WalkState;
use super::super::ground::Ground;
use super::super::outputs::{Inertia, Linear, Quantities};
use super::super::phase::LinePhase;
use super::Direct;
use super::body::{Body, Expansion, Loads, combined};
use crate::linear::polynomial::{
    DEGREE, Polynomial, ZERO, largest, raise_to_size, size_bound, value,
};
use crate::model::{Contents, Model};
use crate::response::output::{self, Output};
use crate::response::{History, Mode};

/// Largest sizes so far.
pub(super) struct Peaks {
    outputs: Vec<Output>,
    /// One of each.
    pub(super) values: Vec<f64>,
    /// What has inertia.
    pub(super) inertia: Inertia,
    /// `g sin θ`, which accelerations are reported without.
    pub(super) slope_m_per_s2: f64,
}

impl Peaks {
    /// None so far, of these contents that slide each by itself.
    pub(super) fn new(model: &Model, contents: &[Contents]) -> Self {
        let outputs: Vec<Output> = Output::all(model.points(), contents.len()).collect();
        Self {
            values: vec![0.0; outputs.len()],
            outputs,
            inertia: Inertia::new(model, contents),
            slope_m_per_s2: model.slope_m_per_s2(),
        }
    }
}

/// A number as it stands in an expansion, or made of several.
pub(super) enum Part<'e> {
    /// Less a constant.
    Less(&'e Polynomial, f64),
    Difference([&'e Polynomial; 2]),
    /// Apart, that what is handed about stays small.
    Made(Box<Polynomial>),
}

impl Part<'_> {
    fn made(p: Polynomial) -> Self {
        Self::Made(Box::new(p))
    }

    /// Its value at the start.
    pub(super) fn start(&self) -> f64 {
        match self {
            Self::Less(p, constant) => p[0] - constant,
            Self::Difference([a, b]) => a[0] - b[0],
            Self::Made(p) => p[0],
        }
    }

    /// Bound on its size over the unit.
    fn size_bound(&self) -> f64 {
        match self {
            Self::Less(p, constant) => size_bound(p) + constant.abs(),
            Self::Difference([a, b]) => size_bound(a) + size_bound(b),
            Self::Made(p) => size_bound(p),
        }
    }

    /// Its series.
    fn series(&self) -> Polynomial {
        match self {
            Self::Less(p, constant) => {
                let mut p = **p;
                p[0] -= constant;
                p
            }
            Self::Difference([a, b]) => core::array::from_fn(|k| a[k] - b[k]),
            Self::Made(p) => **p,
        }
    }
}

impl Linear for Part<'_> {
    fn less(self, constant: f64) -> Self {
        match self {
            Self::Less(p, other) => Self::Less(p, other + constant),
            part => {
                let mut p = part.series();
                p[0] -= constant;
                Self::made(p)
            }
        }
    }

    fn sum((factor, first): (f64, Self), terms: impl Iterator<Item = (f64, Self)>) -> Self {
        let mut sum = first.series().map(|c| factor * c);
        for (factor, term) in terms {
            let p = term.series();
            sum.iter_mut().zip(p).for_each(|(sum, c)| *sum += factor * c);
        }
        Self::made(sum)
    }
}

/// The motion as series.
pub(super) struct InSeries<'e> {
    body: &'e Body,
    series: &'e Expansion,
}

impl<'e> InSeries<'e> {
    /// A point's share of a list of the floors.
    fn of_point(&self, point: usize, list: &'e [Polynomial]) -> Part<'e> {
        match &self.body.points {
            None => Part::Less(&list[point], 0.0),
            Some((points, _)) => Part::made(combined(&points[point], list)),
        }
    }

    /// A point's share less that of the point below it, if there is one.
    fn over_last(&self, point: usize, list: &'e [Polynomial]) -> Part<'e> {
        let Some(last) = point.checked_sub(1) else { return self.of_point(point, list) };
        match &self.body.points {
            None => Part::Difference([&list[point], &list[last]]),
            Some((points, _)) => {
                let [here, below] = [point, last].map(|i| combined(&points[i], list));
                Part::made(core::array::from_fn(|k| here[k] - below[k]))
            }
        }
    }
}

impl<'e> Quantities for InSeries<'e> {
    type Value = Part<'e>;

    fn zero(&self) -> Part<'e> {
        Part::Less(&ZERO, 0.0)
    }

    fn velocity(&self) -> Part<'e> {
        Part::Less(&self.series.state.w, 0.0)
    }

    fn block(&self) -> Part<'e> {
        Part::Less(&self.series.u, 0.0)
    }

    fn slider_n(&self) -> Part<'e> {
        Part::Less(&self.series.slider, 0.0)
    }

    fn friction_n(&self) -> Part<'e> {
        Part::Less(&self.series.friction, 0.0)
    }

    fn base_shear_n(&self) -> Part<'e> {
        Part::Less(&self.series.shear, 0.0)
    }

    fn displacement(&self, point: usize) -> Part<'e> {
        self.of_point(point, &self.series.state.q)
    }

    fn drift(&self, point: usize) -> Part<'e> {
        self.over_last(point, &self.series.state.q)
    }

    fn drift_velocity(&self, point: usize) -> Part<'e> {
        self.over_last(point, &self.series.state.v)
    }

    fn acceleration(&self, point: usize) -> Part<'e> {
        let series = self.series;
        let Some((points, with_block)) = &self.body.points else {
            return Part::Less(&series.floors[point], 0.0);
        };
        let of_modes = combined(&points[point], &series.floors);
        Part::made(core::array::from_fn(|k| of_modes[k] + with_block[point] * series.u[k]))
    }

    fn contents(&self, number: usize) -> [Part<'e>; 2] {
        let Expansion { state, carried, .. } = self.series;
        [Part::Less(&state.p[number], 0.0), Part::Less(&carried[number], 0.0)]
    }
}

impl<'a> Direct<'a> {
    /// Output of the velocity of an interface.
    pub(super) fn velocity_output(&self, interface: usize) -> usize {
        let output = interface.checked_sub(1).map_or(Output::Velocity, Output::ContentsVelocity);
        output.place(self.body.point_count())
    }

    /// Output of the acceleration of contents.
    pub(super) fn contents_acceleration_output(&self, i: usize) -> usize {
        Output::ContentsAcceleration(i).place(self.body.point_count())
    }

    /// Values of all outputs at an instant, then accelerations of the oscillators that modes are.
    pub(super) fn values_at<'e>(
        &'e self,
        instant: &'e Expansion,
    ) -> impl Iterator<Item = f64> + 'e {
        let (motion, peaks) = (InSeries { body: &self.body, series: instant }, &self.peaks);
        let slope = peaks.slope_m_per_s2;
        let oscillators = if self.body.points.is_some() { &instant.floors[..] } else { &[] };
        let outputs = peaks.outputs.iter();
        outputs
            .map(move |output| output.of(&motion, &peaks.inertia, slope).start())
            .chain(oscillators.iter().map(move |p| p[0] - slope))
    }

    /// Looks for peaks in the part of the series just gone through.
    pub(super) fn look_at_outputs(&mut self, course: &mut WalkState<'_>, part: f64) {
        for j in 0..self.peaks.outputs.len() {
            match self.peaks.outputs[j] {
                Output::FrictionForce => self.look_at_friction(course, part),
                Output::Overturning if self.peaks.inertia.arms.is_none() => {}
                output => {
                    let Peaks { values, inertia, slope_m_per_s2, .. } = &mut self.peaks;
                    let motion = InSeries { body: &self.body, series: &self.series };
                    let output = output.of(&motion, inertia, *slope_m_per_s2);
                    if !(output.size_bound() <= values[j]) {
                        raise_to_size(&mut values[j], &output.series(), part);
                    }
                }
            }
        }
        self.look_at_stop(course, part);
    }

    /// Friction takes what it can where the block leans on a rigid stop, the stop the rest.
    fn look_at_friction(&mut self, course: &mut WalkState<'_>, part: f64) {
        let beyond =
            self.beyond_friction(course).into_iter().find(|(_, p)| value(p, 0.5 * part) > 0.0);
        let friction = &self.series.friction;
        let peak = &mut self.peaks.values[output::FRICTION];
        let Some((sign, beyond)) = beyond else {
            raise_to_size(peak, friction, part);
            return;
        };
        raise_to_size(peak, &core::array::from_fn(|k| friction[k] - sign * beyond[k]), part);
        raise_to_size(&mut course.slider.stopping.demands.peak_force_n, &beyond, part);
    }

    fn look_at_stop(&mut self, course: &mut WalkState<'_>, part: f64) {
        let (law, contact) = (course.slider.law, course.slider.memory.contact);
        if !law.has_pads() {
            return;
        }
        let mut force_n = law.stop_force_n(contact, self.x.s, self.x.w);
        if let Some([of_s, of_w, constant]) = law.stop_row(contact) {
            let (s, w) = (&self.series.state.s, &self.series.state.w);
            let mut p: Polynomial = core::array::from_fn(|k| of_s * s[k] + of_w * w[k]);
            p[0] += constant;
            if self.modes[0] == Mode::Stick {
                p[1..=DEGREE].fill(0.0);
            }
            force_n = largest(&p, part, force_n);
        }
        let peak = &mut course.slider.stopping.demands.peak_force_n;
        *peak = peak.max(force_n);
    }

    /// Records the present state as a knot at a time, under an acceleration of the table.
    pub(super) fn record_knot(
        &mut self,
        course: &WalkState<'_>,
        [time_s, table]: [f64; 2],
        loads: &Loads,
        row: bool,
    ) {
        self.look_at_orders(0, loads);
        let [mut states, mut outputs] = core::mem::take(&mut self.knot);
        states.resize(self.x.count(), [0.0]);
        self.x.get(states.as_flattened_mut());
        outputs.clear();
        outputs.extend(self.values_at(&self.instant).map(|value| [value]));
        if self.modes[0] == Mode::Stick {
            let [friction_n] = &mut outputs[output::FRICTION];
            let hold = course.hold(self.x.s);
            let [low, high] = hold.friction_n(loads.normal[0]);
            if hold.bears_on_stop[0] {
                *friction_n = friction_n.max(low);
            }
            if hold.bears_on_stop[1] {
                *friction_n = friction_n.min(high);
            }
        }
        self.store(course, [&[time_s], &[table]], [&states, &outputs], row);
        self.knot = [states, outputs];
    }

    /// Stores samples in the present modes as rows of the history, by their states and outputs side by side.
    pub(super) fn store_samples<const K: usize>(
        &mut self,
        course: &WalkState<'_>,
        samples: Range<usize>,
        lists: [&[[f64; K]]; 2],
    ) {
        let Ground { times_s, table, .. } = self.ground;
        self.store(course, [&times_s[samples.clone()], &table[samples]], lists, true);
    }

    /// Stores knots in the present modes: their times, the accelerations of the table, their states and
    /// outputs side by side.
    fn store<const K: usize>(
        &mut self,
        course: &WalkState<'_>,
        [times_s, table]: [&[f64]; 2],
        [states, outputs]: [&[[f64; K]]; 2],
        are_rows: bool,
    ) {
        let (n, parts, count) = (self.body.storeys(), self.body.contents.len(), times_s.len());
        let points = self.body.point_count();
        let items = &self.body.part_of;
        let Some(h) = &mut self.history else { return };
        let (first, end) = (h.time_s.len(), h.time_s.len() + count);
        if are_rows {
            h.rows.extend(first..end);
        }
        h.time_s.extend_from_slice(times_s);
        for k in 0..count {
            h.mode.push(self.modes[0]);
            h.mode.extend(items.iter().map(|part| self.modes[1 + part]));
            if h.surfaces > 0 {
                let surfaces = course.slider.law.surfaces(&course.slider.memory, states[0][k]);
                h.surface_displacement_m.extend(surfaces);
            }
        }
        if course.slider.law.has_pads() {
            h.contact.resize(end, course.slider.memory.contact);
        }
        h.table_acceleration_m_per_s2.extend_from_slice(table);
        side_by_side(count, &mut h.sliding_displacement_m, &states[..1]);
        side_by_side(count, &mut h.sliding_velocity_m_per_s, &states[1..2]);
        if self.modes[0] == Mode::Stick {
            h.block_acceleration_m_per_s2.extend_from_slice(table);
        } else {
            side_by_side(count, &mut h.block_acceleration_m_per_s2, &outputs[output::BLOCK..][..1]);
        }
        side_by_side(count, &mut h.friction_force_n, &outputs[output::FRICTION..][..1]);
        let (of_storeys, of_contents) = states[2..].split_at(2 * n);
        side_by_side(count, &mut h.storey_displacement_m, &of_storeys[..n]);
        side_by_side(count, &mut h.storey_velocity_m_per_s, &of_storeys[n..]);
        let first = match self.body.points {
            Some(_) => self.peaks.values.len(),
            None => Output::Acceleration(0).place(points),
        };
        let accelerations = &outputs[first..][..n];
        side_by_side(count, &mut h.storey_acceleration_m_per_s2, accelerations);
        let (displacements, velocities) = of_contents.split_at(parts);
        for k in 0..count {
            for &part in items {
                h.contents_displacement_m.push(displacements[part][k]);
                h.contents_velocity_m_per_s.push(velocities[part][k]);
                let acceleration = Output::ContentsAcceleration(part).place(points);
                h.contents_acceleration_m_per_s2.push(outputs[acceleration][k]);
            }
        }
    }
}

/// Adds so many knots to a column, of numbers side by side.
#[inline(always)]
fn side_by_side<const K: usize>(count: usize, column: &mut Vec<f64>, lists: &[[f64; K]]) {
    let end = column.len() + count * lists.len();
    match lists {
        // Whole lists are moved faster than parts of them.
        [list] => column.extend_from_slice(list),
        lists => (0..count).for_each(|k| column.extend(lists.iter().map(|list| list[k]))),
    }
    column.truncate(end);
}

/// A history with room for the knots of so many samples.
pub(super) fn history(body: &Body, surfaces: usize, samples: usize) -> History {
    let (n, contents, capacity) = (body.storeys(), body.part_of.len(), samples + samples / 4);
    let column = |width: usize| Vec::with_capacity(width * capacity);
    History {
        storeys: n,
        interfaces: 1 + contents,
        surfaces,
        time_s: column(1),
        mode: Vec::with_capacity((1 + contents) * capacity),
        rows: Vec::with_capacity(samples),
        table_acceleration_m_per_s2: column(1),
        sliding_displacement_m: column(1),
        sliding_velocity_m_per_s: column(1),
        block_acceleration_m_per_s2: column(1),
        friction_force_n: column(1),
        storey_displacement_m: column(n),
        storey_velocity_m_per_s: column(n),
        storey_acceleration_m_per_s2: column(n),
        surface_displacement_m: column(surfaces),
        contents_displacement_m: column(contents),
        contents_velocity_m_per_s: column(contents),
        contents_acceleration_m_per_s2: column(contents),
        ..History::default()
    }
}
