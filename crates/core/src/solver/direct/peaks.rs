//! Peaks of the series, and the knots of the history.

use core::ops::Range;

use super::super::course::Course;
use super::super::ground::Ground;
use super::super::outputs::output;
use super::super::phase::Straight;
use super::Direct;
use super::body::{Body, Expansion, Loads};
use crate::linear::polynomial::{
    DEGREE, Polynomial, ZERO, curvature_bound, largest, size_bound, value,
};
use crate::model::Model;
use crate::response::{History, Mode};

/// Largest sizes so far.
pub(super) struct Peaks {
    /// In the order of [`Direct::output`].
    pub(super) values: Vec<f64>,
    /// Whether the overturning moment is asked for.
    pub(super) overturns: bool,
    /// Mass times lever arm of the points' inertia.
    arms: Vec<f64>,
    /// Of the block's, and heights of the block and of the floors for what stands on them.
    block_arm: f64,
    heights_m: Vec<f64>,
    /// `g sin θ`, which accelerations are reported without.
    pub(super) slope_m_per_s2: f64,
}

impl Peaks {
    /// None so far, of so many `contents` that slide each by itself.
    pub(super) fn new(model: &Model, contents: usize) -> Self {
        let block_m = model.block().height_m.unwrap_or(0.0);
        let oscillators = if model.structure().is_some() { model.storeys() } else { 0 };
        let arms = model.lever_arms();
        let points = arms.iter().flatten();
        let heights_m = core::iter::once(block_m).chain(points.clone().map(|point| point[1]));
        Self {
            values: vec![0.0; output::count(model.points()) + 2 * contents + oscillators],
            overturns: model.block().width_m.is_some() && arms.is_some(),
            heights_m: heights_m.collect(),
            arms: points.map(|[mass_kg, above_m]| mass_kg * above_m).collect(),
            block_arm: 0.5 * block_m * model.bare_block_kg(),
            slope_m_per_s2: model.slope_m_per_s2(),
        }
    }
}

/// Raises a peak to the largest size of a polynomial on [0, `part`].
fn raise(peak: &mut f64, p: &Polynomial, part: f64) {
    let ends = p[0].abs().max(value(p, part).abs());
    *peak = peak.max(ends);
    if ends + 0.125 * curvature_bound(p) * (part * part) <= *peak {
        return;
    }
    *peak = largest(&p.map(|c| -c), part, largest(p, part, *peak));
}

/// An output as a part of an expansion.
pub(super) enum Output<'e> {
    /// Less a constant.
    Less(&'e Polynomial, f64),
    Difference([&'e Polynomial; 2]),
    Made(Polynomial),
}

impl Output<'_> {
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
            Self::Made(p) => *p,
        }
    }
}

impl<'a> Direct<'a> {
    /// Output of the velocity of an interface.
    pub(super) fn velocity_output(&self, interface: usize) -> usize {
        let Some(i) = interface.checked_sub(1) else { return output::VELOCITY };
        output::count(self.body.point_count()) + i
    }

    /// Output of the acceleration of contents.
    pub(super) fn contents_acceleration_output(&self, i: usize) -> usize {
        output::count(self.body.point_count()) + self.body.contents.len() + i
    }

    /// An output: those of [`output`], then velocities and accelerations of contents, then accelerations of
    /// the oscillators of modes.
    pub(super) fn output<'e>(&self, series: &'e Expansion, j: usize) -> Output<'e> {
        let (body, n, slope) = (&self.body, self.body.point_count(), self.peaks.slope_m_per_s2);
        let by_modes = body.points.is_some();
        match j {
            output::VELOCITY => Output::Less(&series.w, 0.0),
            output::BLOCK => Output::Less(&series.u, slope),
            output::SLIDER => Output::Less(&series.slider, 0.0),
            output::FRICTION => Output::Less(&series.friction, 0.0),
            output::BASE_SHEAR => Output::Less(&series.shear, 0.0),
            output::OVERTURNING => Output::Made(self.moment(series)),
            j if by_modes && j < output::acceleration(n, 0) => {
                Output::Made(body.displacement(series, j - output::displacement(0)))
            }
            j if by_modes && j < output::acceleration(n, n) => {
                let mut p = body.acceleration(series, j - output::acceleration(n, 0));
                p[0] -= slope;
                Output::Made(p)
            }
            j if by_modes && j < output::count(n) => {
                let i = 1 + j - output::acceleration(n, n);
                let [here, below] = [i, i - 1].map(|i| body.displacement(series, i));
                Output::Made(core::array::from_fn(|k| here[k] - below[k]))
            }
            j if j < output::acceleration(n, 0) => {
                Output::Less(&series.q[j - output::displacement(0)], 0.0)
            }
            j if j < output::acceleration(n, n) => {
                Output::Less(&series.floors[j - output::acceleration(n, 0)], slope)
            }
            j if j < output::count(n) => {
                let i = 1 + j - output::acceleration(n, n);
                Output::Difference([&series.q[i], &series.q[i - 1]])
            }
            j => {
                let (i, contents) = (j - output::count(n), self.body.contents.len());
                match i {
                    i if i < contents => Output::Less(&series.p[i], 0.0),
                    i if i < 2 * contents => Output::Less(&series.carried[i - contents], slope),
                    i => Output::Less(&series.floors[i - 2 * contents], slope),
                }
            }
        }
    }

    /// Looks for peaks in the part of the series just gone through.
    pub(super) fn look_at_outputs(&mut self, course: &mut Course<'_>, part: f64) {
        for j in 0..self.peaks.values.len() {
            match j {
                output::FRICTION => self.look_at_friction(course, part),
                output::OVERTURNING if !self.peaks.overturns => {}
                j => {
                    let output = self.output(&self.series, j);
                    if !(output.size_bound() <= self.peaks.values[j]) {
                        let p = output.series();
                        raise(&mut self.peaks.values[j], &p, part);
                    }
                }
            }
        }
        self.look_at_stop(course, part);
    }

    /// Overturning moment of the inertia of block, floors and contents about the sliding surface.
    fn moment(&self, series: &Expansion) -> Polynomial {
        if !self.peaks.overturns {
            return ZERO;
        }
        let body = &self.body;
        let Peaks { heights_m, arms, block_arm, .. } = &self.peaks;
        let points: Vec<Polynomial> =
            (0..arms.len()).map(|i| body.acceleration(series, i)).collect();
        core::array::from_fn(|k| {
            let own = block_arm * series.u[k];
            let floors = arms.iter().zip(&points).map(|(arm, a)| arm * a[k]).sum::<f64>();
            let contents = body.contents.iter().zip(&series.carried);
            let contents =
                contents.map(|(c, a)| heights_m[c.floor] * c.mass_kg * a[k]).sum::<f64>();
            own + floors + contents
        })
    }

    /// Friction takes what it can where the block leans on a rigid stop, the stop the rest.
    fn look_at_friction(&mut self, course: &mut Course<'_>, part: f64) {
        let beyond = self.beyond_friction(course).filter(|(_, p)| value(p, 0.5 * part) > 0.0);
        let friction = &self.series.friction;
        let peak = &mut self.peaks.values[output::FRICTION];
        let Some((sign, beyond)) = beyond else {
            raise(peak, friction, part);
            return;
        };
        raise(peak, &core::array::from_fn(|k| friction[k] - sign * beyond[k]), part);
        raise(&mut course.slider.stopping.demands.peak_force_n, &beyond, part);
    }

    fn look_at_stop(&mut self, course: &mut Course<'_>, part: f64) {
        let (law, contact) = (course.slider.law, course.slider.memory.contact);
        if !law.has_pads() {
            return;
        }
        let mut force_n = law.stop_force_n(contact, self.x.s, self.x.w);
        if let Some([of_s, of_w, constant]) = law.stop_row(contact) {
            let (s, w) = (&self.series.s, &self.series.w);
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
        course: &Course<'_>,
        [time_s, table]: [f64; 2],
        loads: &Loads,
        row: bool,
    ) {
        self.look_at_orders(0, loads);
        let [mut states, mut outputs] = core::mem::take(&mut self.knot);
        states.resize(self.x.count(), [0.0]);
        self.x.get(states.as_flattened_mut());
        outputs.clear();
        let all = 0..self.peaks.values.len();
        outputs.extend(all.map(|j| [self.output(&self.instant, j).start()]));
        if self.modes[0] == Mode::Stick {
            let [friction_n] = &mut outputs[output::FRICTION];
            let hold = course.hold(self.x.s);
            let [low, high] = hold.friction_n(loads.normal[0]);
            if hold.leans[0] {
                *friction_n = friction_n.max(low);
            }
            if hold.leans[1] {
                *friction_n = friction_n.min(high);
            }
        }
        self.store(course, [&[time_s], &[table]], [&states, &outputs], row);
        self.knot = [states, outputs];
    }

    /// Stores samples in the present modes as rows of the history, by their states and outputs side by side.
    pub(super) fn store_samples<const K: usize>(
        &mut self,
        course: &Course<'_>,
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
        course: &Course<'_>,
        [times_s, table]: [&[f64]; 2],
        [states, outputs]: [&[[f64; K]]; 2],
        are_rows: bool,
    ) {
        let (n, parts, count) = (self.body.storeys(), self.body.contents.len(), times_s.len());
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
            Some(_) => output::count(self.body.point_count()) + 2 * parts,
            None => output::acceleration(n, 0),
        };
        let accelerations = &outputs[first..][..n];
        side_by_side(count, &mut h.storey_acceleration_m_per_s2, accelerations);
        let accelerations = &outputs[output::count(self.body.point_count()) + parts..][..parts];
        let (displacements, velocities) = of_contents.split_at(parts);
        for k in 0..count {
            for &part in items {
                h.contents_displacement_m.push(displacements[part][k]);
                h.contents_velocity_m_per_s.push(velocities[part][k]);
                h.contents_acceleration_m_per_s2.push(accelerations[part][k]);
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
