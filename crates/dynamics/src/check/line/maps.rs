//! What an interval of one kind makes of its inputs: linear maps, found from unit inputs.

use fearless_simd::prelude::*;

use super::super::collocation::{NODES, legendre};
use super::super::lane::{Eight, LANES, add_chain, all};
use super::super::outputs::Outputs;
use super::group::{Group, Key};
use super::knots::{BATCH, LaneJudge};
use super::work::Work;

/// A map from inputs, row by row, of inputs that are not 0.
pub(super) struct Map {
    inputs: Vec<usize>,
    /// Rows that are 0, and those that are not with their entries.
    blank: Vec<usize>,
    rows: Vec<usize>,
    entries: Vec<f64>,
}

impl Map {
    /// From the columns of all inputs, of which some are 0.
    fn new(zero: &[usize], count: usize, columns: &[f64]) -> Self {
        let length = columns.len() / count;
        let inputs: Vec<usize> = (0..count)
            .filter(|j| !zero.contains(j))
            .filter(|j| columns[j * length..(j + 1) * length].iter().any(|c| *c != 0.0))
            .collect();
        let row = |r: usize| inputs.iter().map(move |j| columns[j * length + r]);
        let (rows, blank): (Vec<usize>, Vec<usize>) =
            (0..length).partition(|&r| row(r).any(|c| c != 0.0));
        let entries = rows.iter().flat_map(|&r| row(r)).collect();
        Self { inputs, blank, rows, entries }
    }

    /// What it makes of the inputs of every lane.
    #[inline(always)]
    pub(super) fn apply<S: Simd>(
        &self,
        simd: S,
        (input, active): (&[Eight], &mut [Eight]),
        out: &mut [Eight],
    ) {
        let count = self.inputs.len().max(1);
        for (active, &j) in active.iter_mut().zip(&self.inputs) {
            *active = input[j];
        }
        for &row in &self.blank {
            out[row] = Eight::ZERO;
        }
        let active = &active[..self.inputs.len()];
        for (&row, entries) in self.rows.iter().zip(self.entries.chunks_exact(count)) {
            let mut sum = all(simd, 0.0);
            for (&c, input) in entries.iter().zip(active) {
                sum += all(simd, c) * input.load(simd);
            }
            out[row].store(sum);
        }
    }
}

/// The maps of a key and a step to the path, and to its places.
pub(super) struct Maps {
    pub(super) path: Map,
    pub(super) places: Map,
}

/// How far outputs may leave the chord of an interval: at most in proportion to its length.
pub(super) struct Spread {
    /// Of which interval these are the bounds.
    pub(super) longest_s: f64,
    /// Outputs that leave the chord, with the inputs whose sizes make them and by how much.
    pub(super) leaving: Vec<(usize, Vec<(usize, f64)>)>,
    /// Which outputs may pass their peaks in intervals that begin in a batch, a bit each, or one of 64;
    /// empty if unknown.
    loud: Vec<u64>,
}

impl Spread {
    /// Which outputs may pass their peaks in intervals of at most this length from these knots on.
    pub(super) fn loud(&self, knots: &[usize; LANES]) -> u64 {
        if self.loud.is_empty() {
            return u64::MAX;
        }
        let (first, last) = (knots[0] / BATCH, knots[LANES - 1] / BATCH);
        if knots[LANES - 1] == knots[0] + LANES - 1 {
            return self.loud[first] | self.loud[last];
        }
        knots.iter().fold(0, |loud, k| loud | self.loud[k / BATCH])
    }

    /// Nothing is known of batches.
    pub(super) fn forget(&mut self) {
        self.loud.clear();
    }

    /// Looks at all batches of knots: largest outputs, then largest inputs of the map. Returns how far each
    /// output may leave its chord, batch by batch, and the largest that it can be.
    pub(super) fn look<'b>(
        &mut self,
        batches: impl Iterator<Item = (&'b [f64], Vec<f64>)>,
        attained: &[f64],
    ) -> (Vec<Vec<f64>>, Vec<f64>) {
        let mut largest = attained.to_vec();
        let mut off = vec![Vec::new(); attained.len()];
        self.loud.clear();
        for (outputs, inputs) in batches {
            let mut loud = 0;
            for off in &mut off {
                off.push(0.0);
            }
            for (g, bounds) in &self.leaving {
                let far: f64 = bounds.iter().map(|&(input, bound)| bound * inputs[input]).sum();
                let passes = !(outputs[*g] + far <= attained[*g] * (1.0 + 1e-12));
                loud |= u64::from(passes) << (g % 64);
                largest[*g] = largest[*g].max(outputs[*g] + far);
                if let Some(last) = off[*g].last_mut() {
                    *last = far;
                }
            }
            self.loud.push(loud);
        }
        // An interval may end in the next batch.
        for b in 1..self.loud.len() {
            self.loud[b - 1] |= self.loud[b];
            for off in &mut off {
                off[b - 1] = off[b - 1].max(off[b]);
            }
        }
        (off, largest)
    }
}

/// What unit inputs make of an interval in equal steps.
pub(super) struct UnitResponses {
    /// Of the interval, if it is one step.
    pub(super) maps: Maps,
    /// Of the interval: Legendre's terms of all velocities, then the velocities at its end.
    pub(super) sums: Map,
    pub(super) spread: Spread,
}

impl LaneJudge<'_> {
    /// The maps of a key over an interval in equal steps, with so many of Legendre's terms, and how far
    /// outputs leave their chords in it.
    pub(super) fn units(
        &self,
        (key, outputs): (&Key, &Outputs),
        (length_s, steps): (f64, usize),
        terms: usize,
        work: &mut Work,
    ) -> UnitResponses {
        let (d, count) = (self.structure.degrees(), self.inputs());
        let group = Group::of_key(self, key, length_s / steps as f64);
        let (mut paths, mut places, mut sums) = (Vec::new(), Vec::new(), Vec::new());
        // Values of the outputs at both ends and all nodes, input by input.
        let points = 2 + steps * NODES;
        let mut traced: Vec<Vec<f64>> = Vec::with_capacity(count);
        let part =
            |point: usize| ((point / NODES) as f64 + self.rule.c[point % NODES]) / steps as f64;
        for from in (0..count).step_by(LANES) {
            let lanes = LANES.min(count - from);
            set_units(&mut work.input, from);
            let unit = work.input.clone();
            let mut sum = vec![Eight::ZERO; (terms + 1) * d];
            let mut values: Vec<Eight> = Vec::with_capacity(points * outputs.len());
            for step in 0..steps {
                if step > 0 {
                    work.go_on(d);
                }
                for load in (2 * d..count).step_by(2) {
                    for end in 0..2 {
                        let part = (step + end) as f64 / steps as f64;
                        for lane in 0..lanes {
                            let [from, to] = [unit[load].0[lane], unit[load + 1].0[lane]];
                            work.input[load + end].0[lane] = from + (to - from) * part;
                        }
                    }
                }
                self.solve(&group, None, work);
                if step == 0 {
                    self.end((&group, 0), outputs, work);
                    values.extend_from_slice(&work.ends[0]);
                    for lane in 0..lanes {
                        paths.extend(work.path.iter().map(|row| row.0[lane]));
                        places.extend(work.trace[..NODES * d].iter().map(|row| row.0[lane]));
                    }
                }
                self.trace(&group, outputs, work);
                for node in 0..NODES {
                    let weight = self.rule.weights[node] / steps as f64;
                    let z = 2.0 * part(step * NODES + node) - 1.0;
                    for term in 0..terms {
                        let share = (2 * term + 1) as f64 * weight * legendre(term, z);
                        for k in (0..d).filter(|&k| term < 2 || self.is_damped(key, k)) {
                            let (sum, v) = (&mut sum[term * d + k], &work.path[node * d + k]);
                            for lane in 0..lanes {
                                sum.0[lane] += share * v.0[lane];
                            }
                        }
                    }
                    values.extend((0..outputs.len()).map(|g| work.values[g * NODES + node]));
                }
            }
            self.end((&group, 1), outputs, work);
            values.extend_from_slice(&work.ends[1]);
            sum[terms * d..].copy_from_slice(&work.path[(NODES + 1) * d..(NODES + 2) * d]);
            for lane in 0..lanes {
                sums.extend(sum.iter().map(|row| row.0[lane]));
                traced.push(values.iter().map(|value| value.0[lane]).collect());
            }
        }
        for first in [0, d] {
            self.by_forces(&mut traced[first + 1..]);
        }
        let parts = (0..steps * NODES).map(part).collect::<Vec<f64>>();
        let leaving = (0..outputs.len()).map(|g| {
            let of = |input: usize| {
                let off = leaves(&traced[input][g..], outputs.len(), &parts)?;
                Some((input, off))
            };
            (g, (0..count).filter_map(of).collect::<Vec<(usize, f64)>>())
        });
        let leaving = leaving.filter(|(_, bounds)| !bounds.is_empty()).collect();
        // What sticks has no velocity.
        let interfaces = 1 + self.structure.contents.len();
        let zero: Vec<usize> = (0..interfaces)
            .filter(|i| key.stuck >> i & 1 == 1)
            .map(|i| d + self.structure.degree_of(i))
            .collect();
        let map = |columns: &[f64]| Map::new(&zero, count, columns);
        UnitResponses {
            maps: Maps { path: map(&paths), places: map(&places) },
            sums: map(&sums),
            spread: Spread { longest_s: length_s, leaving, loud: Vec::new() },
        }
    }

    /// From columns of unit displacements of storeys to those of unit forces of their springs over their
    /// masses: `f = M⁻¹ K q`, so `q_j = Σ_{i ≤ j} δ_i` with the drifts `δ_i = Σ_{l ≥ i} m_l f_l/k_i`. In
    /// these what a state makes of an output hardly cancels.
    fn by_forces(&self, columns: &mut [Vec<f64>]) {
        let s = self.structure;
        let n = s.masses_kg.len();
        if s.on_block {
            for (i, column) in columns[..n].iter_mut().enumerate() {
                let per_force = s.masses_kg[i] / s.stiffnesses[i];
                column.iter_mut().for_each(|x| *x *= per_force);
            }
            return;
        }
        // Of drifts: all storeys above move with one.
        for i in (1..n).rev() {
            let (below, above) = columns.split_at_mut(i);
            add(&mut below[i - 1], &above[0], 1.0);
        }
        let mut sum = vec![0.0; columns.first().map_or(0, Vec::len)];
        for (i, column) in columns[..n].iter_mut().enumerate() {
            add(&mut sum, column, 1.0 / s.stiffnesses[i]);
            column.iter_mut().zip(&sum).for_each(|(x, sum)| *x = s.masses_kg[i] * sum);
        }
    }

    /// Sizes of the inputs of every lane, of storeys those of the forces of their springs over their masses.
    #[inline(always)]
    pub(super) fn sizes<S: Simd>(&self, simd: S, work: &mut Work) {
        let (s, d) = (self.structure, self.structure.degrees());
        let n = s.masses_kg.len();
        let Work { input, active: sizes, .. } = work;
        sizes.fill(Eight::ZERO);
        for first in [0, d] {
            let (from, to) = (first + 1, first + 1 + n);
            add_chain(simd, n, s.springs(), &input[from..to], &mut sizes[from..to]);
            for (size, mass) in sizes[from..to].iter_mut().zip(&s.masses_kg) {
                size.store((size.load(simd) * all(simd, 1.0 / mass)).abs());
            }
        }
        for j in 0..self.inputs() {
            if !(1..=n).contains(&j) && !(d + 1..=d + n).contains(&j) {
                sizes[j].store(input[j].load(simd).abs());
            }
        }
    }

    /// Whether the velocity of a degree is damped in intervals of a key without a stop.
    fn is_damped(&self, key: &Key, degree: usize) -> bool {
        match degree {
            0 => self.structure.damper + key.push[1] + key.drag != 0.0,
            k => k <= self.structure.masses_kg.len(),
        }
    }
}

/// Unit inputs from one on, one a lane.
fn set_units(input: &mut [Eight], from: usize) {
    input.fill(Eight::ZERO);
    for (lane, input) in input.iter_mut().skip(from).take(LANES).enumerate() {
        input.0[lane] = 1.0;
    }
}

/// `x += c y`.
fn add(x: &mut [f64], y: &[f64], c: f64) {
    x.iter_mut().zip(y).for_each(|(x, y)| *x += c * y);
}

/// How far an output leaves the chord of an interval at most, from its values, a stride apart, at the start,
/// at parts of the interval, and at the end. `None` where it is linear.
fn leaves(values: &[f64], stride: usize, parts: &[f64]) -> Option<f64> {
    let (start, end) = (values[0], values[(parts.len() + 1) * stride]);
    let (mut off, mut size) = (0.0_f64, start.abs().max(end.abs()));
    for (part, value) in parts.iter().zip(values.iter().step_by(stride).skip(1)) {
        off = off.max((value - (start + (end - start) * part)).abs());
        size = size.max(value.abs());
    }
    // What is linear leaves it by rounding only; between two points the output may leave the chord a little
    // further than at any.
    (!(off <= 1e-14 * size)).then_some(1.25 * off)
}
