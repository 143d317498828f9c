//! Keeps the history of a response in two horizontal directions.

use super::system::System;
use super::vector::apart;
use crate::response::{Contact, History, HistoryAlongY, Mode};

/// What is known at a knot.
pub(super) struct Knot<'a> {
    pub(super) time_s: f64,
    pub(super) mode: Mode,
    pub(super) contact: Contact,
    /// Each along x and y: `Ü`, `s`, `w`, the block's total acceleration and friction.
    pub(super) table: [f64; 2],
    pub(super) s: [f64; 2],
    pub(super) w: [f64; 2],
    pub(super) block: [f64; 2],
    pub(super) friction_n: [f64; 2],
    pub(super) eta: &'a [f64],
    pub(super) rate: &'a [f64],
    pub(super) g: &'a [f64],
}

/// Keeps every knot.
pub(super) struct Recorder {
    pub(super) along_x: History,
    pub(super) along_y: HistoryAlongY,
}

impl Recorder {
    pub(super) fn new(system: &System) -> Self {
        let storeys = match system.oscillators.len() {
            0 => system.points,
            oscillators => oscillators,
        };
        let along_x = History { storeys, ..History::default() };
        Self { along_x, along_y: HistoryAlongY::default() }
    }

    /// Stores a knot; `row` if it is also a row of the sampled history.
    pub(super) fn store(&mut self, system: &System, knot: &Knot<'_>, row: bool) {
        let (x, y) = (&mut self.along_x, &mut self.along_y);
        if row {
            x.rows.push(x.time_s.len());
        }
        x.time_s.push(knot.time_s);
        x.mode.push(knot.mode);
        x.contact.extend(system.ring.map(|_| knot.contact));
        let both = |lists: [&mut Vec<f64>; 2], values: [f64; 2]| {
            for (list, value) in lists.into_iter().zip(values) {
                list.push(value);
            }
        };
        both([&mut x.table_acceleration_m_per_s2, &mut y.table_acceleration_m_per_s2], knot.table);
        both([&mut x.sliding_displacement_m, &mut y.sliding_displacement_m], knot.s);
        both([&mut x.sliding_velocity_m_per_s, &mut y.sliding_velocity_m_per_s], knot.w);
        both([&mut x.block_acceleration_m_per_s2, &mut y.block_acceleration_m_per_s2], knot.block);
        both([&mut x.friction_force_n, &mut y.friction_force_n], knot.friction_n);
        for (j, per) in system.oscillators.iter().enumerate() {
            x.storey_displacement_m.push(per * knot.eta[j]);
            x.storey_velocity_m_per_s.push(per * knot.rate[j]);
            x.storey_acceleration_m_per_s2.push(-(per * knot.g[j]) - system.slope_along(j));
        }
        let floors = if system.oscillators.is_empty() { system.points } else { 0 };
        for i in 0..floors {
            let of = |list: &[f64]| [0, 1].map(|axis| system.floors[axis].sum(i, list));
            both([&mut x.storey_displacement_m, &mut y.storey_displacement_m], of(knot.eta));
            both([&mut x.storey_velocity_m_per_s, &mut y.storey_velocity_m_per_s], of(knot.rate));
            let accelerations = apart(of(knot.g).map(|g| -g), system.slope);
            both(
                [&mut x.storey_acceleration_m_per_s2, &mut y.storey_acceleration_m_per_s2],
                accelerations,
            );
        }
    }
}
