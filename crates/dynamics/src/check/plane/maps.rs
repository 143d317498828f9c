//! The linear part of the motion in a plane: springs, dampers and inertia, in physical coordinates.
//!
//! Of the degrees that move together, `y = (x, v)`:
//!
//! ```text
//! ẏ = A y + B_a a(t) + B φ(t)        a linear in t,  φ the force of the slider on the block, over its mass
//! ```
//!
//! φ is the polynomial through its values at the nodes of a step. With `g_0 = y(0)`, `g_1 = A g_0 + B_a a(0)`,
//! `g_2 = A g_1 + B_a ȧ`, `g_{l+1} = A g_l`, and the `l + 1`-fold integrals `I^{l+1}` of Lagrange's polynomials `L_k`,
//!
//! ```text
//! y(c h) = Σ_l (c h)^l/l! g_l  +  Σ_k Σ_l h^{l+1} (I^{l+1} L_k)(c) A^l B φ_k
//! ```
//!
//! which a step of at most a radian ends at rounding after [`TERMS`] terms. The same sums of unit vectors are the maps
//! of a step that comes again and again.

use super::super::collocation::{Column, NODES, POINTS, Rule, add, combined};
use super::frame::{Loads, Pair, PlaneFrame};
use std::sync::LazyLock;

/// Values at the points of a step.
type Points = Column<POINTS>;
/// Most radians of a step: what is linear is exact, the polynomials through the points of a radian are off by 5e-13.
const MOST_RADIANS: f64 = 1.0;
/// Most terms of a sum over a radian: the next is below rounding of what matrices that are not normal make of it.
const TERMS: usize = 24;
/// Most degrees of a group whose maps are kept.
const MOST_MAPPED: usize = 28;
/// Parts of a range over which Lagrange's polynomials are integrated, by Gauss's rule in each.
const PANELS: usize = 4;

/// `(I^{l+1} L_k)(c)` at the points, of each order and node.
type Integrals = [[Points; NODES]; TERMS];

fn integrals() -> &'static Integrals {
    static INTEGRALS: LazyLock<Box<Integrals>> = LazyLock::new(|| {
        let rule = Rule::get();
        let mut all = Box::new([[[0.0; POINTS]; NODES]; TERMS]);
        for (p, c) in rule.points.into_iter().enumerate() {
            for panel in 0..PANELS {
                for (node, weight) in rule.c.iter().zip(&rule.weights) {
                    let t = c * (panel as f64 + node) / PANELS as f64;
                    let values: [f64; NODES] = core::array::from_fn(|k| rule.lagrange(k, t));
                    // (c − t)^l/l!
                    let mut kernel = c * weight / PANELS as f64;
                    for (l, of_order) in all.iter_mut().enumerate() {
                        for (of_node, value) in of_order.iter_mut().zip(values) {
                            of_node[p] += kernel * value;
                        }
                        kernel *= (c - t) / (l + 1) as f64;
                    }
                }
            }
        }
        all
    });
    &INTEGRALS
}

/// How many terms a sum takes over so many radians: four where nothing but the table moves a free block.
fn terms(radians: f64) -> usize {
    let (mut count, mut size) = (4, radians * radians * radians / 6.0);
    while count < TERMS && size > 1e-21 {
        size *= radians / count as f64;
        count += 1;
    }
    count
}

/// Degrees of freedom that move together.
struct DegreeGroup {
    /// Their places in a state; those of the block come first.
    degrees: Vec<usize>,
    /// Axes of the block among them, in that order.
    axes: Vec<usize>,
    /// Place by place in `y`, what a unit there accelerates of all degrees.
    rates: Vec<Vec<f64>>,
    /// Accelerations of a unit of the table's along each axis.
    of_table: Vec<Vec<f64>>,
    /// `A^l B` of a unit force along each axis.
    of_force: Vec<Vec<Vec<f64>>>,
}

impl DegreeGroup {
    fn size(&self) -> usize {
        2 * self.degrees.len()
    }

    /// `A y`.
    #[inline(always)]
    fn apply(&self, y: &[f64], to: &mut [f64]) {
        let (to_x, to_v) = to.split_at_mut(self.degrees.len());
        to_x.copy_from_slice(&y[to_x.len()..]);
        to_v.fill(0.0);
        for (value, rates) in y.iter().zip(&self.rates) {
            if *value != 0.0 {
                to_v.iter_mut().zip(rates).for_each(|(to, rate)| *to += rate * value);
            }
        }
    }

    /// `g_l` of a motion under a table's acceleration and its slope, for so many terms.
    #[inline(always)]
    fn derivatives(&self, y: &[f64], loads: [Pair; 2], terms: usize, all: &mut Vec<f64>) {
        let (m, d) = (self.size(), self.degrees.len());
        all.clear();
        all.extend_from_slice(y);
        all.resize(terms * m, 0.0);
        for l in 1..terms {
            let (known, next) = all.split_at_mut(l * m);
            self.apply(&known[(l - 1) * m..][..m], &mut next[..m]);
            let Some(load) = loads.get(l - 1) else { continue };
            for (axis, rates) in self.axes.iter().zip(&self.of_table) {
                for (to, rate) in next[d..m].iter_mut().zip(rates) {
                    *to += rate * load[*axis];
                }
            }
        }
    }

    /// `Σ_l (c h)^l/l! g_l` at the points, row by row.
    #[inline(always)]
    fn sum(&self, derivatives: &[f64], step_s: f64, mut row: impl FnMut(usize, Points)) {
        let (m, points) = (self.size(), Rule::get().points);
        let (mut powers, mut power) = ([[0.0; POINTS]; TERMS], [1.0; POINTS]);
        for (l, of_order) in powers[..derivatives.len() / m].iter_mut().enumerate() {
            if l > 0 {
                power = core::array::from_fn(|p| power[p] * (points[p] * step_s / l as f64));
            }
            *of_order = power;
        }
        for i in 0..m {
            let mut sum = [0.0; POINTS];
            for (g, power) in derivatives.chunks_exact(m).zip(&powers) {
                add(&mut sum, g[i], power);
            }
            row(i, sum);
        }
    }

    /// What forces at the nodes of a step add at the points, row by row of `y`:
    /// `Σ_k Σ_l h^{l+1} (I^{l+1} L_k)(c) A^l B φ_k`.
    #[inline(always)]
    fn forced(
        &self,
        forces: &[[f64; NODES]; 2],
        (step_s, terms): (f64, usize),
        mut row: impl FnMut(usize, Points),
    ) {
        for (axis, powers) in self.axes.iter().zip(&self.of_force) {
            let (mut moments, mut power) = ([[0.0; POINTS]; TERMS], step_s);
            for (of_order, moment) in integrals()[..terms].iter().zip(&mut moments) {
                for (of_node, force) in of_order.iter().zip(&forces[*axis]) {
                    add(moment, power * force, of_node);
                }
                power *= step_s;
            }
            for i in 0..self.size() {
                let mut sum = [0.0; POINTS];
                for (moment, of_force) in moments[..terms].iter().zip(powers) {
                    add(&mut sum, of_force[i], moment);
                }
                row(i, sum);
            }
        }
    }

    /// The place of a row of `y` in a state of so many degrees, `x` and `v` one after the other.
    fn place(&self, row: usize, degrees: usize) -> usize {
        match row.checked_sub(self.degrees.len()) {
            None => self.degrees[row],
            Some(row) => degrees + self.degrees[row],
        }
    }
}

/// What forces at the nodes do to `w` and `s` at the nodes: along axis `a` at node `j` of one along `b` at node `k`
/// at `[a][b][k][j]`.
pub(super) struct Influence {
    pub(super) of_w: Blocks,
    pub(super) of_s: Blocks,
}

/// A number for each pair of axes and of nodes.
pub(super) type Blocks = [[[[f64; NODES]; NODES]; 2]; 2];

/// The maps of a step of one length.
struct Maps {
    step_s: f64,
    /// Group by group, row by row of `y`, at the points: factors of `y` at the start, then of the table's
    /// accelerations along the axes, then of their slopes.
    free: Vec<Vec<Points>>,
    /// Row by row, at the points: factors of the forces, node by node for each axis.
    forced: Vec<Vec<Points>>,
    influence: Box<Influence>,
}

/// Masses, springs and dampers where the block rests, or where it slides.
pub(super) struct Linear {
    groups: Vec<DegreeGroup>,
    /// An upper bound on the fastest rate, in 1/s.
    rate: f64,
    /// The maps of the step that comes again and again.
    maps: Option<Maps>,
}

/// The table's accelerations at the start of a step, and their slopes.
fn of_table(loads: &[Loads; 2], step_s: f64) -> [Pair; 2] {
    let [from, to] = loads.each_ref().map(|loads| [loads[0].a, loads[1].a]);
    let slope = |axis: usize| if step_s > 0.0 { (to[axis] - from[axis]) / step_s } else { 0.0 };
    [from, [slope(0), slope(1)]]
}

impl Linear {
    pub(super) fn new(frame: &PlaneFrame<'_>, slips: bool) -> Self {
        let d = frame.degrees();
        let all: Vec<usize> = (0..d).collect();
        let split = || [0, 1].map(|axis| all.iter().copied().filter(|k| k % 2 == axis).collect());
        let groups: Vec<(Vec<usize>, Vec<usize>)> = match frame.points {
            Some(_) => vec![(all, vec![0, 1])],
            None => split().into_iter().zip([vec![0], vec![1]]).collect(),
        };
        let groups = groups.into_iter().map(|(degrees, axes)| {
            let unit = |place: usize| {
                let mut list = vec![0.0; d];
                list[place] = 1.0;
                list
            };
            let none = vec![0.0; d];
            let n = degrees.len();
            let of = |state: [&[f64]; 2], loads: [Pair; 2]| -> Vec<f64> {
                let whole = frame.accelerations(state, loads, slips);
                degrees.iter().map(|degree| whole[*degree]).collect()
            };
            let rates = (0..2 * n).map(|place| {
                let one = unit(degrees[place % n]);
                let state = if place < n { [&*one, &*none] } else { [&*none, &*one] };
                of(state, [[0.0; 2]; 2])
            });
            let rates = rates.collect();
            let of_loads = |a: Pair, force: Pair| of([&none, &none], [a, force]);
            let along = |axis: usize| [0, 1].map(|other| if other == axis { 1.0 } else { 0.0 });
            let of_table = axes.iter().map(|axis| of_loads(along(*axis), [0.0; 2])).collect();
            let starts: Vec<Vec<f64>> =
                axes.iter().map(|axis| of_loads([0.0; 2], along(*axis))).collect();
            let mut group = DegreeGroup { degrees, axes, rates, of_table, of_force: Vec::new() };
            let powers = |start: Vec<f64>| {
                let mut all = vec![[vec![0.0; n], start].concat()];
                for l in 1..TERMS {
                    let mut next = vec![0.0; 2 * n];
                    group.apply(&all[l - 1], &mut next);
                    all.push(next);
                }
                all
            };
            let of_force =
                if slips { starts.into_iter().map(powers).collect() } else { Vec::new() };
            group.of_force = of_force;
            group
        });
        let rate = frame.linear_rates[usize::from(slips)];
        Self { groups: groups.collect(), rate, maps: None }
    }

    /// Keeps the maps of a step of a length; not of so many degrees that the sums are faster than maps that large.
    pub(super) fn keep(&mut self, step_s: f64) {
        if self.groups.iter().any(|group| group.degrees.len() > MOST_MAPPED) {
            return;
        }
        let terms = terms(self.rate * step_s);
        let mut maps = Maps {
            step_s,
            free: Vec::new(),
            forced: Vec::new(),
            influence: Box::new(self.influence(step_s)),
        };
        for group in &self.groups {
            let (m, axes) = (group.size(), group.axes.len());
            let width = m + 2 * axes;
            let mut free = vec![[0.0; POINTS]; m * width];
            let mut derivatives = Vec::new();
            for column in 0..width {
                let mut start = vec![0.0; m];
                let mut loads = [[0.0; 2]; 2];
                match column.checked_sub(m) {
                    None => start[column] = 1.0,
                    Some(load) => loads[load / axes][group.axes[load % axes]] = 1.0,
                }
                group.derivatives(&start, loads, terms, &mut derivatives);
                group.sum(&derivatives, step_s, |row, of| free[row * width + column] = of);
            }
            let columns = NODES * group.of_force.len();
            let mut forced = vec![[0.0; POINTS]; m * columns];
            for column in 0..columns {
                let mut forces = [[0.0; NODES]; 2];
                forces[group.axes[column / NODES]][column % NODES] = 1.0;
                group.forced(&forces, (step_s, terms), |row, of| {
                    add(&mut forced[row * columns + column], 1.0, &of);
                });
            }
            maps.free.push(free);
            maps.forced.push(forced);
        }
        self.maps = Some(maps);
    }

    /// The maps of a step of a length, as near as a time can tell, if they are kept.
    fn maps(&self, step_s: f64, instant_s: f64) -> Option<&Maps> {
        self.maps.as_ref().filter(|maps| (maps.step_s - step_s).abs() <= instant_s)
    }

    /// In how many steps a length is gone through.
    pub(super) fn parts(&self, length_s: f64) -> f64 {
        libm::ceil(self.rate * length_s / MOST_RADIANS * (1.0 - 1e-9)).max(1.0)
    }

    /// The motion at the points of a step without force: `x` and `v` one after the other.
    #[inline(always)]
    pub(super) fn free(
        &self,
        [x, v]: [&[f64]; 2],
        loads: &[Loads; 2],
        (step_s, instant_s): (f64, f64),
        states: &mut [Points],
    ) {
        let (d, loads) = (x.len(), of_table(loads, step_s));
        let maps = self.maps(step_s, instant_s);
        let terms = terms(self.rate * step_s);
        let (mut derivatives, mut start) = (Vec::new(), Vec::new());
        for (g, group) in self.groups.iter().enumerate() {
            start.clear();
            start.extend(group.degrees.iter().map(|k| x[*k]));
            start.extend(group.degrees.iter().map(|k| v[*k]));
            if let Some(maps) = maps {
                loads.iter().for_each(|load| start.extend(group.axes.iter().map(|k| load[*k])));
                for (i, row) in maps.free[g].chunks_exact(start.len()).enumerate() {
                    states[group.place(i, d)] = combined(row, &start);
                }
                continue;
            }
            group.derivatives(&start, loads, terms, &mut derivatives);
            group.sum(&derivatives, step_s, |row, of| states[group.place(row, d)] = of);
        }
    }

    /// Adds what forces at the nodes do.
    #[inline(always)]
    pub(super) fn add_forced(
        &self,
        forces: &[[f64; NODES]; 2],
        (step_s, instant_s): (f64, f64),
        states: &mut [Points],
    ) {
        let d = states.len() / 2;
        let maps = self.maps(step_s, instant_s);
        let terms = terms(self.rate * step_s);
        for (g, group) in self.groups.iter().enumerate() {
            if let Some(maps) = maps {
                let mut all = [0.0; 2 * NODES];
                for (all, axis) in all.chunks_exact_mut(NODES).zip(&group.axes) {
                    all.copy_from_slice(&forces[*axis]);
                }
                let all = &all[..NODES * group.axes.len()];
                for (i, row) in maps.forced[g].chunks_exact(all.len()).enumerate() {
                    add(&mut states[group.place(i, d)], 1.0, &combined(row, all));
                }
                continue;
            }
            group.forced(forces, (step_s, terms), |row, of| {
                add(&mut states[group.place(row, d)], 1.0, &of);
            });
        }
    }

    /// What forces at the nodes of a step do to the block at the nodes.
    fn influence(&self, step_s: f64) -> Influence {
        let terms = terms(self.rate * step_s);
        let zero = [[[[0.0; NODES]; NODES]; 2]; 2];
        let mut all = Influence { of_w: zero, of_s: zero };
        for group in &self.groups {
            let n = group.degrees.len();
            for (by, powers) in group.axes.iter().zip(&group.of_force) {
                for (place, along) in group.axes.iter().enumerate() {
                    let of_s = &mut all.of_s[*along][*by];
                    let of_w = &mut all.of_w[*along][*by];
                    let mut power = step_s;
                    for (of_order, of_force) in integrals()[..terms].iter().zip(powers) {
                        add_at_nodes(of_s, power * of_force[place], of_order);
                        add_at_nodes(of_w, power * of_force[n + place], of_order);
                        power *= step_s;
                    }
                }
            }
        }
        all
    }

    /// The same, made once for a step that comes again.
    pub(super) fn with_influence<T>(
        &self,
        (step_s, instant_s): (f64, f64),
        of: impl FnOnce(&Influence) -> T,
    ) -> T {
        match self.maps(step_s, instant_s) {
            Some(maps) => of(&maps.influence),
            None => of(&self.influence(step_s)),
        }
    }
}

/// Adds a multiple of integrals, at the nodes.
#[inline(always)]
fn add_at_nodes(to: &mut [[f64; NODES]; NODES], factor: f64, integrals: &[Points; NODES]) {
    if factor != 0.0 {
        for (to, from) in to.iter_mut().zip(integrals) {
            to.iter_mut().zip(&from[1..]).for_each(|(to, from)| *to += factor * from);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::ground::Load;
    use super::super::super::law::Law;
    use super::*;
    use crate::model::{AlongY, Block, Damping, Frame, InitialState, Model, Slider};
    use crate::slider::Friction;

    /// A frame on a pendulum, stiffer along y.
    fn model(storeys: usize) -> Model {
        let stiffnesses =
            |factor: f64| (0..storeys).map(|i| factor * (3e5 - 5e4 * i as f64)).collect();
        let frame = Frame {
            masses_kg: vec![300.0; storeys],
            stiffnesses_n_per_m: stiffnesses(1.0),
            damping: Damping::Ratio(0.02),
            heights_m: None,
        };
        let along_y = AlongY {
            stiffnesses_n_per_m: stiffnesses(1.3),
            damping: Damping::Ratio(0.03),
            width_m: None,
            initial: InitialState::rest(),
        };
        let slider = Slider::pendulum(Friction::new(0.07, 0.06).unwrap(), 2.2);
        let block = Block { mass_kg: 1000.0, width_m: None, height_m: None };
        Model::new(block, slider, frame, 9.81, InitialState::rest())
            .and_then(|model| model.with_along_y(along_y))
            .unwrap()
    }

    fn loads() -> [Loads; 2] {
        [[1.3, -0.4], [0.2, 0.9]].map(|a| a.map(|a| Load { a, ..Load::default() }))
    }

    /// Numbers that repeat themselves in no simple way.
    fn numbers(count: usize) -> Vec<f64> {
        (1..=count).map(|k| libm::sin((k * k) as f64)).collect()
    }

    #[test]
    fn kept_maps_are_the_sums_that_they_are_made_of() {
        let model = model(3);
        let law = Law::new(&model, false);
        let frame = PlaneFrame::new(&model, false, &law, 1.0);
        let d = frame.degrees();
        for slips in [false, true] {
            let [sums, mut kept] = [0, 1].map(|_| Linear::new(&frame, slips));
            let step_s = 0.9 / kept.rate;
            kept.keep(step_s);
            let length = (step_s, 1e-16);
            let (x, v) = (numbers(d), numbers(2 * d)[d..].to_vec());
            let forces = [0, 1].map(|i| core::array::from_fn(|k| libm::cos((3 * k + i) as f64)));
            let ends = [&sums, &kept].map(|linear| {
                let mut states = vec![[0.0; POINTS]; 2 * d];
                linear.free([&x, &v], &loads(), length, &mut states);
                if slips {
                    linear.add_forced(&forces, length, &mut states);
                }
                states
            });
            let largest = ends[0].iter().flatten().fold(0.0, |most: f64, x| most.max(x.abs()));
            for (a, b) in ends[0].iter().flatten().zip(ends[1].iter().flatten()) {
                assert!((a - b).abs() <= 1e-14 * largest, "{a} {b}");
            }
            if slips {
                // The block's part at the nodes is what the influence of the forces says.
                let mut states = vec![[0.0; POINTS]; 2 * d];
                kept.add_forced(&forces, length, &mut states);
                kept.with_influence(length, |influence| {
                    for (j, a) in (0..NODES).flat_map(|j| [(j, 0), (j, 1)]) {
                        let sum = |blocks: &Blocks| -> f64 {
                            let of = |b: usize| {
                                (0..NODES).map(move |k| blocks[a][b][k][j] * forces[b][k])
                            };
                            (0..2).flat_map(of).sum()
                        };
                        let [s, w] = [sum(&influence.of_s), sum(&influence.of_w)];
                        assert!((s - states[a][1 + j]).abs() <= 1e-15 * largest);
                        assert!((w - states[d + a][1 + j]).abs() <= 1e-15 * largest);
                    }
                });
            }
        }
    }

    /// A storey on a block that rests: a damped oscillator under an acceleration that is linear in time.
    #[test]
    fn an_oscillator_moves_as_its_closed_form() {
        let model = model(1);
        let law = Law::new(&model, false);
        let frame = PlaneFrame::new(&model, false, &law, 1.0);
        let linear = Linear::new(&frame, false);
        let step_s = 1.0 / linear.rate;
        let (x, v) = ([0.0, 0.0, 0.01, -0.02], [0.0, 0.0, 0.3, 0.1]);
        let mut states = vec![[0.0; POINTS]; 2 * 4];
        linear.free([&x, &v], &loads(), (step_s, 0.0), &mut states);
        let of = [(3e5_f64, 0.02), (1.3 * 3e5, 0.03)];
        for (axis, (stiffness, ratio)) in of.into_iter().enumerate() {
            let omega = libm::sqrt(stiffness / 300.0);
            let [from, to] = loads().map(|loads| loads[axis].a);
            let slope = (to - from) / step_s;
            // q = c + m t + e^(−ξωt) (A cos ω_d t + B sin ω_d t)
            let m = -slope / (omega * omega);
            let c = -(from + 2.0 * ratio * omega * m) / (omega * omega);
            let damped = omega * libm::sqrt(1.0 - ratio * ratio);
            let a = x[2 + axis] - c;
            let b = (v[2 + axis] - m + ratio * omega * a) / damped;
            for point in 0..POINTS {
                let t = Rule::get().points[point] * step_s;
                let wave = a * libm::cos(damped * t) + b * libm::sin(damped * t);
                let q = c + m * t + libm::exp(-ratio * omega * t) * wave;
                let found = states[2 + axis][point];
                assert!((found - q).abs() < 1e-16, "{found} {q}");
            }
        }
    }
}
