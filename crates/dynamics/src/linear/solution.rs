//! The motion over intervals of one length, prepared: its series, its parts, and one number of it.

use fearless_simd::prelude::*;

use super::lanes::{Four, Many, combine4};
use super::polynomial::{Polynomial, ZERO};
use super::series::{Load, ModalSeries};
use super::system::System;

/// Most storeys for which series go by a table, in stick and in slip: beyond, its sums are longer than
/// the recursion.
const TABLE_STOREYS: [usize; 2] = [1, 2];

/// The same of short series, which the table holds alone then.
const SHORT_STOREYS: [usize; 2] = [2, 5];

/// Most storeys for which a part of an interval goes by a map: beyond, the maps are too large.
const MAP_STOREYS: usize = 10;

/// Parts of an interval to which maps lead.
const PARTS: usize = 16;

/// Orders of a series from the nearest of them: (1.4 / 32)^9 / 9! = 1.6e-18.
const SHORT: usize = 8;

/// The motion over intervals of one length from any state under any loads that are linear in time.
///
/// All tables are sums over the same inputs: in slip the numbers of a [`Load`] and the state; in stick,
/// where neither the force nor the block's own motion does anything, the state with the acceleration and
/// its change in the place of `s` and `ṡ`.
#[derive(Debug)]
pub struct IntervalTables {
    slip: bool,
    length_s: f64,
    orders: usize,
    /// One number: factors of the state, of the acceleration and of the force.
    row: Vec<f64>,
    of_loads: [f64; 2],
    /// The orders from the first on of the series, as far as that is shorter than the recursion.
    series: Vec<Four>,
    parts: Option<Parts>,
}

/// What an event needs in the place of the whole series.
#[derive(Debug)]
struct Parts {
    /// The state after each of the parts.
    maps: Vec<Four>,
    /// The coefficients of the number.
    number: Vec<Four>,
}

impl IntervalTables {
    /// Tables of a system and of one number of it, `row` times the state, `of_a` times the
    /// acceleration and `of_force` times the force; in stick without what `s` adds.
    #[inline(always)]
    #[must_use]
    pub fn new<S: Simd>(
        simd: S,
        system: &System,
        slip: bool,
        (length_s, orders): (f64, usize),
        (row, of_a, of_force): (&[f64], f64, f64),
    ) -> Self {
        let of_loads = [of_a, of_force];
        let mut row = row.to_vec();
        if !slip {
            row[0] = 0.0;
        }
        let mut solution =
            Self { slip, length_s, orders, row, of_loads, series: Vec::new(), parts: None };
        if system.storeys <= MAP_STOREYS {
            solution.tabulate(simd, system);
        }
        solution
    }

    /// Makes the tables from what every input does by itself.
    #[inline(always)]
    fn tabulate<S: Simd>(&mut self, simd: S, system: &System) {
        let (slip, orders, stride) = (self.slip, self.orders, self.row.len());
        let mut series = ModalSeries::new(system, orders);
        let (count, fours) = (if slip { 4 + stride } else { stride }, stride / 4);
        let table = |rows: usize| vec![Four::ZERO; rows * count];
        let short = SHORT.min(orders);
        let tabled = match system.storeys {
            n if n <= TABLE_STOREYS[usize::from(slip)] => orders,
            n if n <= SHORT_STOREYS[usize::from(slip)] => short,
            _ => 0,
        };
        let mut of_series = table(tabled * fours);
        let mut maps = table(PARTS * fours);
        let mut number = table((orders + 1).div_ceil(4));
        let (mut x, mut after) = (vec![0.0; stride], vec![0.0; stride]);
        for input in 0..4 + 2 + 2 * system.modes() {
            let of = |i: usize| f64::from(u8::from(input == i));
            let load = Load {
                acceleration: of(0),
                acceleration_change: of(1),
                force: of(2),
                force_change: of(3),
            };
            x.fill(0.0);
            if input >= 4 {
                x[input - 4] = 1.0;
            }
            let place = match input {
                _ if slip => input,
                0 | 1 => input,
                2..6 => continue,
                _ => input - 4,
            };
            series.expand(simd, system, slip, &x, &load, self.length_s);
            for k in 0..tabled {
                let (c, _) = series.order(k + 1).as_chunks::<4>();
                for i in 0..fours {
                    of_series[(k * fours + i) * count + place] = Four(c[i]);
                }
            }
            for part in 0..PARTS {
                series.state_at(simd, (part + 1) as f64 / PARTS as f64, &mut after);
                let (after, _) = after.as_chunks::<4>();
                for i in 0..fours {
                    maps[(part * fours + i) * count + place] = Four(after[i]);
                }
            }
            let c = self.number_of(simd, system, &series, &load);
            for k in 0..=orders {
                number[k / 4 * count + place].0[k % 4] = c[k];
            }
        }
        (self.series, self.parts) = (of_series, Some(Parts { maps, number }));
    }

    /// Coefficients of the number from those of the state.
    #[inline(always)]
    fn number_of<S: Simd>(
        &self,
        simd: S,
        system: &System,
        series: &ModalSeries,
        load: &Load,
    ) -> Polynomial {
        let mut c = series.row(simd, Many(system.modes()), &self.row);
        let [constant, change] = load.times(self.of_loads);
        c[0] += constant;
        c[1] += change;
        c
    }

    /// `out` as sums of the inputs.
    #[inline(always)]
    fn sum<S: Simd>(&self, simd: S, table: &[Four], x: &[f64], load: &Load, out: &mut [f64]) {
        let [a, change] = [load.acceleration, load.acceleration_change];
        if self.slip {
            combine4(simd, table, &[a, change, load.force, load.force_change], &[], x, out);
        } else {
            combine4(simd, table, &[a, change, x[2], x[3]], &[], &x[4..], out);
        }
    }

    /// Coefficients of the number from a padded state, over the whole interval.
    #[inline(always)]
    #[must_use]
    pub fn number<S: Simd>(
        &self,
        simd: S,
        system: &System,
        (x, load): (&[f64], &Load),
        series: &mut ModalSeries,
    ) -> Polynomial {
        let Some(parts) = &self.parts else {
            self.expand(simd, system, x, load, series);
            return self.number_of(simd, system, series, load);
        };
        let mut c = ZERO;
        let count = (self.orders + 1).next_multiple_of(4);
        self.sum(simd, &parts.number, x, load, &mut c[..count]);
        c
    }

    /// The series from a padded state.
    #[inline(always)]
    pub fn expand<S: Simd>(
        &self,
        simd: S,
        system: &System,
        x: &[f64],
        load: &Load,
        series: &mut ModalSeries,
    ) {
        self.expand_to(simd, self.orders, system, x, load, series);
    }

    #[inline(always)]
    fn expand_to<S: Simd>(
        &self,
        simd: S,
        orders: usize,
        system: &System,
        x: &[f64],
        load: &Load,
        series: &mut ModalSeries,
    ) {
        let inputs = if self.slip { 4 + x.len() } else { x.len() };
        if self.series.len() < orders * (x.len() / 4) * inputs {
            series.expand_to(simd, system, self.slip, x, load, (self.length_s, orders));
            return;
        }
        let (start, rest) = series.scratch(orders, x.len());
        start.copy_from_slice(x);
        if !self.slip {
            start[1] = 0.0;
        }
        self.sum(simd, &self.series, x, load, rest);
    }

    /// Padded state after a part of the interval, at most 1, from the state and under the load for which
    /// [`number`](Self::number) was asked last.
    #[inline(always)]
    pub fn state_at<S: Simd>(
        &self,
        simd: S,
        system: &System,
        (x, load): (&[f64], &Load),
        part: f64,
        series: &mut ModalSeries,
        out: &mut [f64],
    ) {
        if let Some(Parts { maps, .. }) = &self.parts {
            let nearest = (part * PARTS as f64 + 0.5) as usize;
            let from = nearest as f64 / PARTS as f64;
            if nearest == 0 {
                out.copy_from_slice(x);
            } else {
                let size = maps.len() / PARTS;
                self.sum(simd, &maps[(nearest - 1) * size..][..size], x, load, out);
            }
            if part != from {
                let load = Load {
                    acceleration: load.acceleration + from * load.acceleration_change,
                    force: load.force + from * load.force_change,
                    ..*load
                };
                self.expand_to(simd, SHORT.min(self.orders), system, out, &load, series);
                series.state_at(simd, part - from, out);
            }
        } else {
            series.state_at(simd, part, out);
        }
        if !self.slip {
            (out[0], out[1]) = (x[0], 0.0);
        }
    }
}
