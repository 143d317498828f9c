//! What modes do at points along an axis: one row a point, of the modes that move along it.

use std::ops::Range;

use super::system::System;
use crate::linear::polynomial::{Polynomial, ZERO};
use crate::numerics::algebra::dot;

/// Orders of a series that are summed side by side.
const SIDE_BY_SIDE: usize = 4;

/// Rows of a list of all modes; what a row does not reach is zero.
#[derive(Clone, Debug)]
pub(super) struct Rows {
    points: usize,
    own: Range<usize>,
    by_point: Vec<f64>,
    by_mode: Vec<f64>,
}

impl Rows {
    /// Of rows of all modes, a point each.
    pub(super) fn new(rows: &[Vec<f64>]) -> Self {
        let modes = rows.first().map_or(0, Vec::len);
        let moves = |j: &usize| rows.iter().any(|row| row[*j] != 0.0);
        let first = (0..modes).find(moves).unwrap_or(0);
        let own = first..(first..modes).rev().find(moves).map_or(first, |last| last + 1);
        Self {
            points: rows.len(),
            by_point: rows.iter().flat_map(|row| &row[own.clone()]).copied().collect(),
            by_mode: own.clone().flat_map(|j| rows.iter().map(move |row| row[j])).collect(),
            own,
        }
    }

    /// What a mode does at a point.
    pub(super) fn of_mode(&self, point: usize, mode: usize) -> f64 {
        if self.own.contains(&mode) { self.row(point)[mode - self.own.start] } else { 0.0 }
    }

    fn row(&self, point: usize) -> &[f64] {
        &self.by_point[point * self.own.len()..][..self.own.len()]
    }

    /// A row times a list of all modes.
    pub(super) fn sum(&self, point: usize, list: &[f64]) -> f64 {
        dot(self.row(point), &list[self.own.clone()])
    }

    /// `Σ |a_j| b_j` of a row.
    pub(super) fn size(&self, point: usize, list: &[f64]) -> f64 {
        size_of_sum(self.row(point), &list[self.own.clone()])
    }

    /// All rows times a list.
    #[inline(always)]
    pub(super) fn sums(&self, list: &[f64], into: &mut [f64]) {
        self.add(list, into, |c| c);
    }

    /// `Σ |a_j| b_j` of all rows.
    #[inline(always)]
    pub(super) fn sizes(&self, list: &[f64], into: &mut [f64]) {
        self.add(list, into, f64::abs);
    }

    #[inline(always)]
    fn add(&self, list: &[f64], into: &mut [f64], of: impl Fn(f64) -> f64) {
        into.fill(0.0);
        let columns = self.by_mode.chunks_exact(self.points.max(1));
        for (column, x) in columns.zip(&list[self.own.clone()]) {
            for (sum, c) in into.iter_mut().zip(column) {
                *sum += of(*c) * x;
            }
        }
    }

    /// A row times the lists of a series, which follow each other order by order, of so many modes each.
    #[inline(always)]
    pub(super) fn series(
        &self,
        point: usize,
        modes: usize,
        list: &[f64],
        degree: usize,
    ) -> Polynomial {
        let (row, mut sums) = (self.row(point), ZERO);
        for (i, sums) in sums.chunks_mut(SIDE_BY_SIDE).enumerate() {
            let first = i * SIDE_BY_SIDE;
            if first > degree {
                break;
            }
            let orders: [&[f64]; SIDE_BY_SIDE] = core::array::from_fn(|k| {
                &list[(first + k).min(degree) * modes..][self.own.clone()]
            });
            let mut side_by_side = [0.0; SIDE_BY_SIDE];
            for (j, c) in row.iter().enumerate() {
                for (sum, order) in side_by_side.iter_mut().zip(orders) {
                    *sum += c * order[j];
                }
            }
            let last = sums.len().min(degree + 1 - first);
            sums[..last].copy_from_slice(&side_by_side[..last]);
        }
        sums
    }
}

/// `Σ |a_j| b_j`.
#[inline(always)]
pub(super) fn size_of_sum(row: &[f64], list: &[f64]) -> f64 {
    row.iter().zip(list).fold(0.0, |sum, (a, b)| sum + a.abs() * b)
}

/// What points do over a part of a motion: at both ends, and how far they depart from their chords at most.
#[derive(Default)]
pub(super) struct PointsBetween {
    pub(super) ends: [AtPoints; 2],
    pub(super) bends: AtPoints,
}

impl PointsBetween {
    pub(super) fn new(points: usize) -> Self {
        let at_points = || AtPoints::new(points);
        Self { ends: [at_points(), at_points()], bends: at_points() }
    }

    /// From `η`, `η̇` and `g` of the modes at the start, where that is not known, and at the end, and from how far they
    /// bend.
    #[inline(always)]
    pub(super) fn follow(
        &mut self,
        system: &System,
        start: Option<[&[f64]; 3]>,
        end: [&[f64]; 3],
        bends: &[Vec<f64>; 3],
    ) {
        let [first, last] = &mut self.ends;
        if let Some(start) = start {
            first.values(system, start);
        }
        last.values(system, end);
        self.bends.bends(system, bends);
    }
}

/// Of points along x and y: displacements, drifts, their velocities and `Φ g`.
#[derive(Default)]
pub(super) struct AtPoints {
    pub(super) displacements: [Vec<f64>; 2],
    pub(super) drifts: [Vec<f64>; 2],
    pub(super) drift_velocities: [Vec<f64>; 2],
    pub(super) of_g: [Vec<f64>; 2],
    /// What `g` adds to the shears before them.
    pub(super) shears: [Vec<f64>; 2],
}

impl AtPoints {
    fn new(points: usize) -> Self {
        let lists = || [vec![0.0; points], vec![0.0; points]];
        Self {
            displacements: lists(),
            drifts: lists(),
            drift_velocities: lists(),
            of_g: lists(),
            shears: lists(),
        }
    }

    /// Their values, from `η`, `η̇` and `g` of the modes.
    #[inline(always)]
    fn values(&mut self, system: &System, of_modes: [&[f64]; 3]) {
        self.each(system, of_modes, |rows, list, into| rows.sums(list, into));
    }

    /// How far they depart from their chords at most, from how far `η`, `η̇` and `g` of the modes do.
    #[inline(always)]
    fn bends(&mut self, system: &System, of_modes: &[Vec<f64>; 3]) {
        let of_modes = of_modes.each_ref().map(Vec::as_slice);
        self.each(system, of_modes, |rows, list, into| rows.sizes(list, into));
    }

    #[inline(always)]
    fn each(
        &mut self,
        system: &System,
        [of_eta, of_rate, of_g]: [&[f64]; 3],
        of: impl Fn(&Rows, &[f64], &mut [f64]),
    ) {
        for axis in 0..2 {
            of(&system.floors[axis], of_eta, &mut self.displacements[axis]);
            of(&system.drifts[axis], of_eta, &mut self.drifts[axis]);
            of(&system.drifts[axis], of_rate, &mut self.drift_velocities[axis]);
            of(&system.floors[axis], of_g, &mut self.of_g[axis]);
            if let Some(shears) = &system.shears {
                of(&shears[axis], of_g, &mut self.shears[axis]);
            }
        }
    }
}

/// One point of a list along x and y.
#[inline(always)]
pub(super) fn at(lists: &[Vec<f64>; 2], point: usize) -> [f64; 2] {
    [lists[0][point], lists[1][point]]
}
