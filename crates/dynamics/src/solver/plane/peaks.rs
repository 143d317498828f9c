//! Peaks of the continuous motion: of resultants and by axis.
//!
//! A vector departs from its chord over a part of a step by no more than an eighth of its largest second
//! derivative times the square of the part: where the ends and that bound cannot exceed what has been attained,
//! nothing is looked for; nor where the slope at its start is more than that derivative can turn; else the part is halved.

use super::mass::{Matrix, times};
use super::nodes::{NODES, nodes};
use super::rows::{PointsBetween, Rows, at};
use super::series::{Kind, PlaneSeries, square};
use super::stop::Arc;
use super::system::{State, System};
use super::vector::{apart, inner, norm};
use crate::linear::polynomial::{
    DEGREE, Polynomial, ZERO, curvature_bound, curvature_term, largest, value,
};
use crate::numerics::instructions::vectorize;
use crate::response::output::Output;

/// A relative difference of peaks that is rounding.
const ROUNDING: f64 = 1e-15;

/// The largest second derivative of Legendre's polynomial that follows those of a step, twice for those after it.
const LEFT_OUT: f64 = ((NODES - 1) * NODES * (NODES + 1) * (NODES + 2)) as f64;

/// Most parts of a step that are looked at.
const MOST_PARTS: usize = 4096;

/// Peaks of a vector: of its length, and of its components as sizes.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Peak {
    pub(super) norm: f64,
    pub(super) axes: [f64; 2],
}

impl Peak {
    /// Notes a value; whether its length is the largest so far.
    #[inline(always)]
    fn note(&mut self, [x, y]: [f64; 2]) -> bool {
        self.axes = [self.axes[0].max(x.abs()), self.axes[1].max(y.abs())];
        let size = norm([x, y]);
        let is_largest = size > self.norm;
        if is_largest {
            self.norm = size;
        }
        is_largest
    }

    /// Notes the values at both ends of a step; which end is the farthest so far, if one is.
    fn note_ends(&mut self, ends: [[f64; 2]; 2], to: f64) -> Option<f64> {
        let first = self.note(ends[0]).then_some(0.0);
        self.note(ends[1]).then_some(to).or(first)
    }

    /// Whether values between two, which depart from their chord by so much, are below what is attained.
    #[inline(always)]
    fn is_above(&self, [a, b]: [[f64; 2]; 2], bend: [f64; 2]) -> bool {
        self.holds(norm(a).max(norm(b)) + norm(bend), self.norm)
            && self.is_above_by_axis([a, b], bend)
    }

    /// Whether components between two, which depart from their chords by so much, are below what is attained.
    #[inline(always)]
    fn is_above_by_axis(&self, [a, b]: [[f64; 2]; 2], bend: [f64; 2]) -> bool {
        (0..2).all(|k| self.holds(a[k].abs().max(b[k].abs()) + bend[k], self.axes[k]))
    }

    /// Whether a bound is not above what is attained, but for rounding.
    #[inline(always)]
    fn holds(&self, bound: f64, attained: f64) -> bool {
        bound <= attained + ROUNDING * self.norm
    }

    /// Looks for peaks of a series over `[0, to]`; where its length is largest, if that is new.
    fn look(&mut self, of: &[Polynomial; 2], to: f64) -> Option<f64> {
        let (ends, bends, best) = self.look_at_axes(of, to);
        if norm(ends[0]).max(norm(ends[1])) + norm(bends) <= self.norm * (1.0 + ROUNDING) {
            return best;
        }
        let q = squared(of);
        let (bend, rounding) = (bend(&q, to), ROUNDING * (self.norm * self.norm));
        let ends = ends.map(|v| v[0] * v[0] + v[1] * v[1]);
        let arch = ChordBound { bend, rise: q[1] * to, rounding, ends, to };
        self.search_length(&arch, |x| value(&q, x), best)
    }

    /// Looks for peaks of the components, and notes the ends: these, how far the components depart from their
    /// chords, and which end is the farthest so far, if one is.
    #[inline(always)]
    fn look_at_axes(
        &mut self,
        of: &[Polynomial; 2],
        to: f64,
    ) -> ([[f64; 2]; 2], [f64; 2], Option<f64>) {
        let ends = [[of[0][0], of[1][0]], [value(&of[0], to), value(&of[1], to)]];
        let best = self.note_ends(ends, to);
        let bends = [bend(&of[0], to), bend(&of[1], to)];
        for axis in 0..2 {
            let (bend, rounding) = (bends[axis], ROUNDING * self.norm);
            let (rise, ends) = (of[axis][1] * to, ends.map(|v| v[axis].abs()));
            let component = ChordBound { bend, rise, rounding, ends, to };
            component.search(|x| value(&of[axis], x).abs(), &mut self.axes[axis]);
        }
        (ends, bends, best)
    }

    /// Looks for the largest square of the length.
    fn search_length(
        &mut self,
        arch: &ChordBound,
        of: impl Fn(f64) -> f64,
        best: Option<f64>,
    ) -> Option<f64> {
        let mut largest = self.norm * self.norm;
        let found = arch.search(of, &mut largest);
        if found.is_some() {
            self.norm = self.norm.max(largest.sqrt());
        }
        found.or(best)
    }
}

/// A function over `[0, to]`: its values at the ends, how far it departs from its chord, how far it would rise as it does at
/// the start, or 0, and what of it is rounding.
struct ChordBound {
    bend: f64,
    rise: f64,
    rounding: f64,
    ends: [f64; 2],
    to: f64,
}

impl ChordBound {
    /// Looks for values above what has been attained; where the largest is, if there is one.
    fn search(&self, of: impl Fn(f64) -> f64, attained: &mut f64) -> Option<f64> {
        let [first, last] = self.ends;
        let is_below = |ends: [f64; 2], part: f64, attained: f64| {
            ends[0].max(ends[1]) + self.bend * (part * part) <= attained + self.rounding
        };
        let is_known = is_below(self.ends, 1.0, *attained) || keeps_on(self.rise, self.bend);
        if self.to == 0.0 || is_known {
            return None;
        }
        let mut best = None;
        let mut parts = vec![[(0.0, first), (self.to, last)]];
        for _ in 0..MOST_PARTS {
            let Some([(a, of_a), (b, of_b)]) = parts.pop() else { break };
            if is_below([of_a, of_b], (b - a) / self.to, *attained) {
                continue;
            }
            let middle = 0.5 * (a + b);
            let here = of(middle);
            if here > *attained {
                (*attained, best) = (here, Some(middle));
            }
            parts.push([(middle, here), (b, of_b)]);
            parts.push([(a, of_a), (middle, here)]);
        }
        best
    }
}

/// Whether a function that would rise so far as it does at the start, and departs from its chord by so much, turns nowhere.
#[inline(always)]
fn keeps_on(rise: f64, bend: f64) -> bool {
    rise.abs() >= 8.0 * bend
}

/// Whether neither component of a vector turns, nor its length: `|v|²` changes by `2 v·v'`, and that by no more than
/// `2 |v'|² + 2 |v| |v''|`.
fn keeps_on_both([from, to]: [[f64; 2]; 2], rise: [f64; 2], bend: [f64; 2]) -> bool {
    let turn = 8.0 * norm(bend);
    let fastest = norm(rise) + turn;
    let largest = norm(from).max(norm(to)) + norm(bend);
    (0..2).all(|axis| keeps_on(rise[axis], bend[axis]))
        && inner(from, rise).abs() >= fastest * fastest + largest * turn
}

/// All peaks.
pub(super) struct Peaks {
    points: usize,
    all: Vec<Peak>,
    /// Of the sum and the difference of the overturning ratios along x and y.
    corners: Peak,
    room: Room,
    /// Of `s`: its length, when that was largest and where; largest and smallest by axis.
    pub(super) sliding: Peak,
    pub(super) peak_time_s: f64,
    pub(super) peak_place: [f64; 2],
    pub(super) largest: [f64; 2],
    pub(super) smallest: [f64; 2],
}

/// Room for what points do over a part of a series, and for how far the modes depart from their chords.
#[derive(Default)]
struct Room {
    points: PointsBetween,
    of_modes: [Vec<f64>; 3],
}

impl Room {
    fn new(system: &System) -> Self {
        let list = || vec![0.0; system.modes()];
        Self { points: PointsBetween::new(system.points), of_modes: [list(), list(), list()] }
    }

    /// Of a part of a series that ends with a state and `g`.
    #[inline(always)]
    fn look(&mut self, system: &System, series: &PlaneSeries, to: f64, (end, g): (&State, &[f64])) {
        let all = [&series.eta, &series.rate, &series.g];
        for (list, bends) in all.into_iter().zip(&mut self.of_modes) {
            series.bends(list, to, bends);
        }
        let start = all.map(|list| &list[..series.modes]);
        self.points.follow(system, Some(start), [&end.eta, &end.rate, g], &self.of_modes);
    }
}

/// An end of a sample of a stick: the table, `P`, `p`, `L g` and `g`.
pub(super) struct StickEnd<'a> {
    pub(super) table: [f64; 2],
    pub(super) pull: [f64; 2],
    pub(super) push: [f64; 2],
    pub(super) shear_n: [f64; 2],
    pub(super) g: &'a [f64],
}

/// What a vector output is made of: `a P + b L g − c φ − d`, with `φ = f u`, in stick `p`.
struct Composed {
    of_pull: f64,
    of_shear: f64,
    of_friction: f64,
    /// What does not move.
    less: [f64; 2],
}

impl Composed {
    /// Without friction.
    fn steady(&self, axis: usize, series: &PlaneSeries) -> Polynomial {
        let (pull, shear) = (&series.pull[axis], &series.shear[axis]);
        let own = core::array::from_fn(|k| self.of_pull * pull[k] + self.of_shear * shear[k]);
        less(own, self.less[axis])
    }

    /// A bound on its length over a part of a series.
    fn longest(&self, part: &SeriesPart<'_>) -> f64 {
        let (ends, bends) = Self { of_friction: 0.0, ..*self }.between(part.chords);
        let steady = norm(ends[0]).max(norm(ends[1])) + norm(bends);
        steady + self.of_friction.abs() * most_friction(part)
    }

    /// Its values at both ends, and how far its components depart from their chords at most.
    fn between(&self, chords: &[[Chord; 2]; 3]) -> ([[f64; 2]; 2], [f64; 2]) {
        let factors = [self.of_pull, self.of_shear, -self.of_friction];
        let (mut ends, mut bends) = ([self.less.map(|constant| 0.0 - constant); 2], [0.0; 2]);
        for (factor, chords) in factors.into_iter().zip(chords) {
            for (axis, chord) in chords.iter().enumerate() {
                bends[axis] += factor.abs() * chord.bend;
                (0..2).for_each(|end| ends[end][axis] += factor * chord.ends[end]);
            }
        }
        (ends, bends)
    }
}

/// A polynomial over `[0, to]`: its values at the ends, and how far it departs from the chord between them at most.
#[derive(Clone, Copy)]
struct Chord {
    ends: [f64; 2],
    bend: f64,
}

impl Chord {
    fn of(c: &Polynomial, to: f64) -> Self {
        Self { ends: [c[0], value(c, to)], bend: bend(c, to) }
    }
}

/// What of a series is looked at.
struct SeriesPart<'a> {
    system: &'a System,
    series: &'a PlaneSeries,
    to: f64,
    /// Of `P`, `L g` and `φ`.
    chords: &'a [[Chord; 2]; 3],
}

/// A vector that friction is part of, `A − M φ`.
struct Vector {
    steady: [Polynomial; 2],
    of_friction: Matrix,
}

/// An eighth of the bound on the second derivative over a part.
#[inline(always)]
pub(super) fn bend(c: &Polynomial, to: f64) -> f64 {
    0.125 * if to == 1.0 { curvature_bound(c) } else { curvature_term(c, to) }
}

/// `r_x + r_y` and `r_x − r_y` of the overturning ratios, from the moments along x and y.
fn at_corners(per: [f64; 2], moment: [f64; 2]) -> [f64; 2] {
    let [x, y] = [per[0] * moment[0], per[1] * moment[1]];
    [x + y, x - y]
}

/// A series less a constant.
fn less(mut c: Polynomial, constant: f64) -> Polynomial {
    c[0] -= constant;
    c
}

fn scaled(c: &Polynomial, factor: f64) -> Polynomial {
    c.map(|c| factor * c)
}

impl Peaks {
    pub(super) fn new(system: &System, s: [f64; 2]) -> Self {
        let mut sliding = Peak::default();
        sliding.note(s);
        Self {
            points: system.points,
            all: vec![Peak::default(); Output::count(system.points, 0)],
            corners: Peak::default(),
            room: Room::new(system),
            sliding,
            peak_time_s: 0.0,
            peak_place: s,
            largest: s,
            smallest: s,
        }
    }

    /// The largest `|r_x| + |r_y|` of the overturning ratios.
    pub(super) fn overturning_ratio(&self) -> f64 {
        self.corners.axes[0].max(self.corners.axes[1])
    }

    pub(super) fn of(&self, output: Output) -> Peak {
        self.all[output.place(self.points)]
    }

    /// Whether all of block and slider that lies between the ends of a sample of a stick, and these, is below what is
    /// attained; with how far `L g`, and `g` of each mode, depart from their chords.
    pub(super) fn hold_in_stick(
        &self,
        system: &System,
        ends: [&StickEnd<'_>; 2],
        (bend_n, of_g): ([f64; 2], &[f64]),
    ) -> bool {
        let tables = ends.map(|end| end.table);
        let blocks = tables.map(|table| apart(table, system.slope));
        let kg = system.block_kg;
        let of_push = ends.map(|end| end.push.map(|p| kg * p));
        let of_slider =
            ends.map(|end| [0, 1].map(|k| kg * (end.pull[k] - end.push[k]) - end.shear_n[k]));
        let own = self.of(Output::Block).is_above(blocks, [0.0; 2])
            && self.of(Output::FrictionForce).is_above(of_push, bend_n)
            && self.of(Output::SliderForce).is_above(of_slider, bend_n)
            && self.of(Output::BaseShear).is_above(ends.map(|end| end.shear_n), bend_n);
        if !own {
            return false;
        }
        let (mut values, mut bend) = ([[0.0; 2]; 2], [0.0; 2]);
        for axis in 0..2 {
            let Some((arm, along)) = &system.overturning[axis] else { continue };
            for i in 0..2 {
                values[i][axis] = inner(*along, tables[i]) - arm.sum(0, ends[i].g);
            }
            bend[axis] = arm.size(0, of_g);
        }
        self.of(Output::Overturning).is_above_by_axis(values, bend)
            && system.per_resisted.is_none_or(|per| {
                let bend = inner(per, bend);
                self.corners.is_above_by_axis(values.map(|m| at_corners(per, m)), [bend; 2])
            })
    }

    /// Whether no output of a point passes its peak between two instants.
    pub(super) fn hold_at_points(
        &self,
        system: &System,
        tables: [[f64; 2]; 2],
        PointsBetween { ends, bends }: &PointsBetween,
    ) -> bool {
        let ends = ends.each_ref();
        (0..self.points).all(|i| {
            let mut accelerations = ends.map(|end| at(&end.of_g, i));
            for (acceleration, table) in accelerations.iter_mut().zip(tables) {
                let carried = system.with_block.get(i).map_or([0.0; 2], |part| times(part, table));
                *acceleration = apart(apart(carried, *acceleration), system.slope);
            }
            let drifts = || {
                let ends = ends.map(|end| at(&end.drifts, i));
                self.of(Output::Drift(i)).is_above(ends, at(&bends.drifts, i))
            };
            let shears = || {
                let mut of = ends.map(|end| at(&end.shears, i));
                for (shear, table) in of.iter_mut().zip(tables) {
                    let part = system.shears_with_block.get(i);
                    *shear = apart(*shear, part.map_or([0.0; 2], |part| times(part, table)));
                }
                self.of(Output::StoreyShear(i)).is_above(of, at(&bends.shears, i))
            };
            let displacements = ends.map(|end| at(&end.displacements, i));
            let velocities = ends.map(|end| at(&end.drift_velocities, i));
            self.of(Output::Displacement(i)).is_above(displacements, at(&bends.displacements, i))
                && self
                    .of(Output::DriftVelocity(i))
                    .is_above(velocities, at(&bends.drift_velocities, i))
                && self.of(Output::Acceleration(i)).is_above(accelerations, at(&bends.of_g, i))
                && (i == 0 || drifts() && (system.shears.is_none() || shears()))
        })
    }

    /// Looks for peaks in the first part of a series that begins at a time, and ends in a state.
    pub(super) fn look(
        &mut self,
        system: &System,
        (series, to): (&PlaneSeries, f64),
        from_s: f64,
        end: (&State, &[f64]),
    ) {
        if series.kind != Kind::Stick {
            self.look_at_sliding(series, to, from_s);
            self.look_at(Output::Velocity, &series.w, to);
        }
        let of = |of: &[Polynomial; 2]| of.each_ref().map(|c| Chord::of(c, to));
        let chords = [of(&series.pull), of(&series.shear), friction_chord(system, series, to)];
        let part = SeriesPart { system, series, to, chords: &chords };
        let block = self.look_at_block(&part);
        if system.modes() > 0 {
            self.look_at(Output::BaseShear, &series.shear, to);
            self.look_at_points(&part, end, block.as_ref());
        }
    }

    /// The outputs of the points, which are combinations of modes: their series are asked for where the bends
    /// of the modes are not enough.
    fn look_at_points(
        &mut self,
        part: &SeriesPart<'_>,
        (end, g): (&State, &[f64]),
        block: Option<&Vector>,
    ) {
        let &SeriesPart { system, series, to, .. } = part;
        let mut room = core::mem::take(&mut self.room);
        vectorize!(series.instructions, _simd => room.look(system, series, to, (end, g)));
        let PointsBetween { ends, bends } = &room.points;
        let ends = ends.each_ref();
        let pulled = system.slope.map(|pull| -pull);
        for i in 0..system.points {
            let displacements = ends.map(|end| at(&end.displacements, i));
            let of = (displacements, at(&bends.displacements, i));
            let rows = (&system.floors, i, &*series.eta);
            self.look_at_rows(Output::Displacement(i), of, rows, (series, to));
            if i > 0 {
                let of = (ends.map(|end| at(&end.drifts, i)), at(&bends.drifts, i));
                let rows = (&system.drifts, i, &*series.eta);
                self.look_at_rows(Output::Drift(i), of, rows, (series, to));
            }
            let of = ends.map(|end| at(&end.drift_velocities, i));
            let of = (of, at(&bends.drift_velocities, i));
            let rows = (&system.drifts, i, &*series.rate);
            self.look_at_rows(Output::DriftVelocity(i), of, rows, (series, to));
            if let Some(shears) = system.shears.as_ref().filter(|_| i > 0) {
                let rows = (shears, i, &*series.g);
                let output = Output::StoreyShear(i);
                if let (Some(with_block), Some(block)) = (system.shears_with_block.get(i), block) {
                    // Σ m (Φ g − W b)
                    let less = with_block.map(|row| row.map(|x| -x));
                    let vector = block.carried(&less, (&series.combined(rows), [0.0; 2]), -1.0);
                    self.look_at_vector(output, &vector, part);
                } else {
                    let of = (ends.map(|end| at(&end.shears, i)), at(&bends.shears, i));
                    self.look_at_rows(output, of, rows, (series, to));
                }
            }
            let rows = (&system.floors, i, &*series.g);
            if let (Some(with_block), Some(block)) = (system.with_block.get(i), block) {
                // −Φ g + W b
                let of_modes = (&series.combined(rows), system.slope);
                let vector = block.carried(with_block, of_modes, 1.0);
                self.look_at_vector(Output::Acceleration(i), &vector, part);
                continue;
            }
            // Φ g, and the slope's pull: what is told is −Φ g without it.
            let ends = ends.map(|end| apart(at(&end.of_g, i), pulled));
            let of = (ends, at(&bends.of_g, i));
            let output = Output::Acceleration(i);
            self.look_at_rows_apart(output, of, rows, (series, to), pulled);
        }
        self.room = room;
    }

    /// An output of a point along x and y, from its values at the ends and how far it departs from its chord at most; else
    /// from its series.
    #[inline(always)]
    fn look_at_rows(
        &mut self,
        output: Output,
        of: ([[f64; 2]; 2], [f64; 2]),
        rows: (&[Rows; 2], usize, &[f64]),
        part: (&PlaneSeries, f64),
    ) {
        self.look_at_rows_apart(output, of, rows, part, [0.0; 2]);
    }

    /// Looks at an output of rows less a constant, which the ends are already.
    #[inline(always)]
    fn look_at_rows_apart(
        &mut self,
        output: Output,
        (ends, bend): ([[f64; 2]; 2], [f64; 2]),
        rows: (&[Rows; 2], usize, &[f64]),
        (series, to): (&PlaneSeries, f64),
        constant: [f64; 2],
    ) {
        let peak = &mut self.all[output.place(self.points)];
        peak.note_ends(ends, to);
        if peak.is_above(ends, bend) {
            return;
        }
        let (of, point, list) = rows;
        let rise = of.each_ref().map(|rows| to * rows.sum(point, &list[series.modes..]));
        if !keeps_on_both(ends, rise, bend) {
            let [x, y] = series.combined(rows);
            peak.look(&[less(x, constant[0]), less(y, constant[1])], to);
        }
    }

    fn look_at(&mut self, output: Output, of: &[Polynomial; 2], to: f64) {
        self.all[output.place(self.points)].look(of, to);
    }

    fn look_at_sliding(&mut self, series: &PlaneSeries, to: f64, from_s: f64) {
        let s = &series.s;
        if let Some(x) = self.sliding.look(s, to) {
            self.peak_time_s = from_s + series.unit * x;
            self.peak_place = [value(&s[0], x), value(&s[1], x)];
        }
        let bends = [bend(&s[0], to), bend(&s[1], to)];
        // The sign of a new extreme by axis.
        for axis in 0..2 {
            let ends = [s[axis][0], value(&s[axis], to)];
            let (low, high) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
            self.largest[axis] = self.largest[axis].max(high);
            self.smallest[axis] = self.smallest[axis].min(low);
            if high + bends[axis] > self.largest[axis] {
                let c = &s[axis];
                self.largest[axis] = largest(c, to, self.largest[axis]);
            }
            if low - bends[axis] < self.smallest[axis] {
                let c = scaled(&s[axis], -1.0);
                let attained = -self.smallest[axis];
                self.smallest[axis] = -largest(&c, to, attained);
            }
        }
    }

    /// The outputs that friction is part of; the acceleration of a block that has more than one mass.
    fn look_at_block(&mut self, part: &SeriesPart<'_>) -> Option<Vector> {
        let &SeriesPart { system, series, .. } = part;
        let kg = system.block_kg;
        let slope = system.slope;
        let block = Composed { of_pull: 1.0, of_shear: 0.0, of_friction: 1.0, less: slope };
        let none = [0.0; 2];
        let friction = Composed { of_pull: 0.0, of_shear: 0.0, of_friction: kg, less: none };
        let slider = Composed { of_pull: kg, of_shear: -1.0, of_friction: kg, less: none };
        self.look_at_composed(Output::FrictionForce, &friction, part);
        self.look_at_composed(Output::SliderForce, &slider, part);
        let mut own = None;
        if let Some(mass) = &system.mass {
            // b = C (P − φ)
            let of_pull = |axis: usize| -> Polynomial {
                let row = mass.inverse[axis];
                core::array::from_fn(|k| inner(row, [series.pull[0][k], series.pull[1][k]]))
            };
            let block = Vector { steady: [of_pull(0), of_pull(1)], of_friction: mass.inverse };
            let [x, y] = block.steady;
            let steady = [less(x, slope[0]), less(y, slope[1])];
            self.look_at_vector(Output::Block, &Vector { steady, ..block }, part);
            own = Some(block);
        } else {
            self.look_at_composed(Output::Block, &block, part);
        }
        let mut moments = Vector { steady: [ZERO; 2], of_friction: [[0.0; 2]; 2] };
        for axis in 0..2 {
            let Some((arm, along)) = &system.overturning[axis] else { continue };
            // The moment of floors and block: −arm·g + along·b.
            let modes = arm.series(0, series.modes, &series.g, series.degree);
            let of_block = |pull: &[Polynomial; 2]| -> Polynomial {
                core::array::from_fn(|k| inner(*along, [pull[0][k], pull[1][k]]) - modes[k])
            };
            let (steady, of_friction) = match &own {
                Some(block) => (of_block(&block.steady), row_times(*along, &block.of_friction)),
                None => (of_block(&series.pull), *along),
            };
            let mut moment = Vector { steady: [ZERO; 2], of_friction: [[0.0; 2]; 2] };
            (moment.steady[axis], moment.of_friction[axis]) = (steady, of_friction);
            let mut peak = self.all[Output::Overturning.place(self.points)];
            moment.look(&mut peak, part, true);
            let all = &mut self.all[Output::Overturning.place(self.points)];
            all.axes[axis] = peak.axes[axis];
            all.norm = all.norm.max(peak.axes[axis]);
            moments.steady[axis] = steady;
            moments.of_friction[axis] = of_friction;
        }
        if let Some(per) = system.per_resisted {
            let ([x, y], [of_x, of_y]) = (&moments.steady, moments.of_friction);
            let of = |k: usize| at_corners(per, [x[k], y[k]]);
            let steady = [0, 1].map(|corner| core::array::from_fn(|k| of(k)[corner]));
            let [a, b] = [0, 1].map(|k| at_corners(per, [of_x[k], of_y[k]]));
            let of_friction = [[a[0], b[0]], [a[1], b[1]]];
            Vector { steady, of_friction }.look(&mut self.corners, part, true);
        }
        own
    }

    /// Where a vector is never longer than its ends, as one that is friction alone, only its components are searched.
    fn look_at_composed(&mut self, output: Output, of: &Composed, part: &SeriesPart<'_>) {
        let peak = &mut self.all[output.place(self.points)];
        let (ends, bends) = of.between(part.chords);
        peak.note_ends(ends, part.to);
        if peak.is_above(ends, bends) {
            return;
        }
        let by_axis = of.longest(part) <= peak.norm * (1.0 + ROUNDING);
        if !(by_axis && peak.is_above_by_axis(ends, bends)) {
            let c = of.of_friction;
            let steady = [of.steady(0, part.series), of.steady(1, part.series)];
            let vector = Vector { steady, of_friction: [[c, 0.0], [0.0, c]] };
            vector.look(peak, part, by_axis);
        }
    }

    fn look_at_vector(&mut self, output: Output, of: &Vector, part: &SeriesPart<'_>) {
        of.look(&mut self.all[output.place(self.points)], part, false);
    }

    /// Notes the outputs that friction is part of on the arc at a stop, from `P` and `L g` at both of its ends.
    pub(super) fn note_arc(
        &mut self,
        system: &System,
        arc: &Arc,
        (pulls, shears_n): ([[f64; 2]; 2], [[f64; 2]; 2]),
        g: &[f64],
    ) {
        let kg = system.block_kg;
        let slider = [0, 1].map(|i| [0, 1].map(|k| kg * pulls[i][k] - shears_n[i][k]));
        if system.mass.is_some() {
            self.note_arc_of_block(system, arc, pulls[1], g);
        }
        let block = (Output::Block, pulls.map(|pull| apart(pull, system.slope)), arc.friction);
        let of = [
            (Output::FrictionForce, [[0.0; 2]; 2], kg * arc.friction),
            (Output::SliderForce, slider, kg * arc.friction),
        ];
        for (axis, moment) in system.overturning.iter().enumerate() {
            let Some((arm, along)) = moment.as_ref().filter(|_| system.mass.is_none()) else {
                continue;
            };
            let modes = arm.sum(0, g);
            let [from, to] = pulls;
            let within = arc.extremes(to).map(|u| (u, arc.part_left(u)));
            for (u, left) in within.chain([(arc.to, 0.0)]) {
                let pull = to[axis] + (from[axis] - to[axis]) * left;
                let size = (along[axis] * (pull - arc.friction * u[axis]) - modes).abs();
                let peak = &mut self.all[Output::Overturning.place(self.points)];
                peak.axes[axis] = peak.axes[axis].max(size);
            }
        }
        self.note_arc_at_corners(system, arc, pulls, g);
        let of = of.into_iter().chain(system.mass.is_none().then_some(block));
        for (output, [from, to], c) in of {
            let peak = &mut self.all[output.place(self.points)];
            let within = arc.extremes(to).map(|u| (u, arc.part_left(u)));
            for (u, left) in within.chain([(arc.to, 0.0)]) {
                peak.note([0, 1].map(|k| (to[k] + (from[k] - to[k]) * left) - c * u[k]));
            }
        }
    }
}

impl Peaks {
    /// Raises the peaks of the overturning ratios of both axes together, of one mass, along an arc.
    fn note_arc_at_corners(
        &mut self,
        system: &System,
        arc: &Arc,
        [from, to]: [[f64; 2]; 2],
        g: &[f64],
    ) {
        let [Some((of_x, along_x)), Some((of_y, along_y))] = &system.overturning else { return };
        let Some(per) = system.per_resisted.filter(|_| system.mass.is_none()) else { return };
        let (modes, arms) = ([of_x.sum(0, g), of_y.sum(0, g)], [along_x[0], along_y[1]]);
        let [x, y] = [per[0] * arms[0], per[1] * arms[1]];
        let towards = [[x, y], [-x, -y], [x, -y], [-x, y]];
        let extremes = towards.into_iter().flat_map(|towards| arc.extremes(towards));
        let within = extremes.map(|u| (u, arc.part_left(u)));
        for (u, left) in within.chain([(arc.to, 0.0)]).collect::<Vec<_>>() {
            let moment = [0, 1].map(|k| {
                let pull = to[k] + (from[k] - to[k]) * left;
                arms[k] * (pull - arc.friction * u[k]) - modes[k]
            });
            self.corners.note(at_corners(per, moment));
        }
    }

    /// Raises the peaks that the acceleration of a block with a mass in each direction is part of, `b = C (P − f u)`,
    /// along an arc: over times as short all but `u` is constant.
    fn note_arc_of_block(&mut self, system: &System, arc: &Arc, pull: [f64; 2], g: &[f64]) {
        let block = |u: [f64; 2]| system.moved([0, 1].map(|k| pull[k] - arc.friction * u[k]));
        let points = self.points;
        let mut raise = |output: Output, of: &dyn Fn([f64; 2]) -> [f64; 2]| {
            let peak = &mut self.all[output.place(points)];
            peak.norm = peak.norm.max(arc.largest(|u| norm(of(u))));
            for axis in 0..2 {
                peak.axes[axis] = peak.axes[axis].max(arc.largest(|u| of(u)[axis].abs()));
            }
        };
        raise(Output::Block, &|u| apart(block(u), system.slope));
        for (i, part) in system.with_block.iter().enumerate() {
            let of_modes = [0, 1].map(|axis| system.floors[axis].sum(i, g));
            let of = |u: [f64; 2]| apart(apart(times(part, block(u)), of_modes), system.slope);
            raise(Output::Acceleration(i), &of);
        }
        for (i, part) in system.shears_with_block.iter().enumerate().skip(1) {
            let Some(shears) = &system.shears else { break };
            let of_modes = [0, 1].map(|axis| shears[axis].sum(i, g));
            raise(Output::StoreyShear(i), &|u| apart(of_modes, times(part, block(u))));
        }
        let moments = system
            .overturning
            .each_ref()
            .map(|moment| moment.as_ref().map(|(arm, along)| (arm.sum(0, g), *along)));
        let of = |u: [f64; 2]| {
            let b = block(u);
            moments.map(|moment| moment.map_or(0.0, |(modes, along)| inner(along, b) - modes))
        };
        raise(Output::Overturning, &of);
        if let Some(per) = system.per_resisted {
            for corner in 0..2 {
                let largest = arc.largest(|u| at_corners(per, of(u))[corner].abs());
                self.corners.axes[corner] = self.corners.axes[corner].max(largest);
            }
        }
    }
}

/// What friction takes at a part of a series: in slip along the velocity there; from rest, where that begins with
/// what the nodes leave out, along the polynomial through its values there and at the start.
fn friction_at(system: &System, series: &PlaneSeries, x: f64) -> [f64; 2] {
    if series.kind != Kind::Slip {
        return series.friction.each_ref().map(|p| value(p, x));
    }
    let (w, [normal_n, rate]) = (series.velocity_at(x), series.loads.normal);
    let speed = norm(w);
    let normal_at_x_n = (normal_n + rate * (series.unit * x)).max(0.0);
    let size = system.kinetic_per_kg.force(speed, normal_at_x_n);
    if let Some(sign) = series.along_stop {
        // Near rest what is left of the velocity across the stop is rounding.
        let [x, y] = series.s.each_ref().map(|s| value(s, x));
        let per = sign * size / norm([x, y]);
        return [-per * y, per * x];
    }
    if [series.w[0][0], series.w[1][0]] == [0.0; 2] {
        let part = nodes().beside_start(x);
        let [of_x, of_y] = series.friction.each_ref();
        let first = [of_x[0], of_y[0]];
        let at_rest = system.kinetic_per_kg.force(0.0, normal_n);
        let along = [(of_x, 0), (of_y, 1)]
            .map(|(of, axis)| value(of, x) + (at_rest * series.from[axis] - first[axis]) * part);
        let length = norm(along);
        return if length > 0.0 { along.map(|u| size / length * u) } else { [0.0; 2] };
    }
    w.map(|w| size / speed * w)
}

/// A bound on what friction takes in a part of a slip. Where it takes that everywhere, as under a law that does not follow
/// the speed, a search for more would look everywhere.
fn most_friction(&SeriesPart { system, series, to, .. }: &SeriesPart<'_>) -> f64 {
    if series.kind != Kind::Slip {
        return f64::INFINITY;
    }
    let law = &system.kinetic_per_kg;
    let [normal_n, rate] = series.loads.normal;
    let most_n = normal_n.max(normal_n + rate * (series.unit * to)).max(0.0);
    let fastest = if law.is_constant() {
        0.0
    } else {
        let ends = [0.0, to].map(|x| norm(series.velocity_at(x)));
        ends[0].max(ends[1]) + norm(series.w.each_ref().map(|w| bend(w, to)))
    };
    let [_, most] = law.range_up_to(fastest);
    most * law.pressing_n(most_n)
}

/// How far what the polynomial of friction leaves out in a slip departs from its chord at most: its coefficients are below
/// the last of those.
fn left_out(series: &PlaneSeries, to: f64) -> f64 {
    if series.kind == Kind::Slip { 0.125 * LEFT_OUT * series.tail * (to * to) } else { 0.0 }
}

/// How far it departs from its chord by axis: of a slip that of the polynomial, and of what that leaves out.
fn friction_chord(system: &System, series: &PlaneSeries, to: f64) -> [Chord; 2] {
    let [from, end] = [0.0, to].map(|x| friction_at(system, series, x));
    let left_out = left_out(series, to);
    [0, 1].map(|axis| {
        let bend = bend(&series.friction[axis], to) + left_out;
        Chord { ends: [from[axis], end[axis]], bend }
    })
}

/// A row times a matrix.
fn row_times(row: [f64; 2], matrix: &Matrix) -> [f64; 2] {
    let [[a, b], [c, d]] = *matrix;
    [row[0] * a + row[1] * c, row[0] * b + row[1] * d]
}

impl Vector {
    /// A matrix times it, less a factor of a series and a constant.
    fn carried(
        &self,
        matrix: &Matrix,
        (of_modes, constant): (&[Polynomial; 2], [f64; 2]),
        factor: f64,
    ) -> Self {
        let steady = [0, 1].map(|axis| -> Polynomial {
            let ([x, y], row) = (&self.steady, matrix[axis]);
            let total =
                core::array::from_fn(|k| inner(row, [x[k], y[k]]) - factor * of_modes[axis][k]);
            less(total, constant[axis])
        });
        let of_friction = matrix.map(|row| row_times(row, &self.of_friction));
        Self { steady, of_friction }
    }

    /// Looks for its peaks, in slip by the friction along its velocity; `by_axis` those of its components alone.
    fn look(&self, peak: &mut Peak, part: &SeriesPart<'_>, by_axis: bool) {
        let &SeriesPart { system, series, to, .. } = part;
        let all = [0, 1].map(|axis| -> Polynomial {
            let ([x, y], row) = (&series.friction, self.of_friction[axis]);
            core::array::from_fn(|k| self.steady[axis][k] - inner(row, [x[k], y[k]]))
        });
        if series.kind != Kind::Slip {
            if by_axis {
                peak.look_at_axes(&all, to);
            } else {
                peak.look(&all, to);
            }
            return;
        }
        let of = |x: f64| {
            let taken = times(&self.of_friction, friction_at(system, series, x));
            [0, 1].map(|axis| value(&self.steady[axis], x) - taken[axis])
        };
        let ends = [of(0.0), of(to)];
        peak.note_ends(ends, to);
        let rounding = ROUNDING * peak.norm;
        let left_out = left_out(series, to);
        let mut bends = [0.0; 2];
        for axis in 0..2 {
            bends[axis] = bend(&all[axis], to) + norm(self.of_friction[axis]) * left_out;
            let ends = ends.map(|v| v[axis].abs());
            let arch = ChordBound { bend: bends[axis], rise: 0.0, rounding, ends, to };
            arch.search(|x| of(x)[axis].abs(), &mut peak.axes[axis]);
        }
        let largest = norm(ends[0]).max(norm(ends[1])) + norm(bends);
        if by_axis || largest <= peak.norm * (1.0 + ROUNDING) {
            return;
        }
        let square = |v: [f64; 2]| inner(v, v);
        let of_friction = norm(self.of_friction.map(norm)) * left_out;
        let bend = bend(&squared(&all), to) + 2.0 * largest * of_friction;
        let rounding = ROUNDING * (peak.norm * peak.norm);
        let arch = ChordBound { bend, rise: 0.0, rounding, ends: ends.map(square), to };
        peak.search_length(&arch, |x| square(of(x)), None);
    }
}

/// `|v|²` as a series.
pub(super) fn squared(v: &[Polynomial; 2]) -> Polynomial {
    core::array::from_fn(|k| if k > DEGREE { 0.0 } else { square(&v[0], k) + square(&v[1], k) })
}
