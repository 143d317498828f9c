//! Keeps the history of a response, or nothing.

use crate::linear::{PerStorey, State, System};
use crate::response::{History, Mode};

/// What is known at a knot.
pub(super) struct Knot<'a, V: PerStorey> {
    pub(super) time_s: f64,
    pub(super) mode: Mode,
    /// `Ü`.
    pub(super) table: f64,
    pub(super) state: &'a State<V>,
    /// `u = s̈ + a`.
    pub(super) u: f64,
    /// `f = D η̇ + Ω η`.
    pub(super) f: &'a [f64],
    pub(super) friction_n: f64,
}

/// Takes knots as the solver passes them.
pub(super) trait Recorder<V: PerStorey> {
    /// Whether knots are wanted at all.
    const WANTED: bool;

    /// A knot; `row` if it is also a row of the sampled history.
    fn knot(&mut self, system: &System<V>, knot: &Knot<'_, V>, row: bool);
}

/// Keeps nothing.
pub(super) struct Nothing;

impl<V: PerStorey> Recorder<V> for Nothing {
    const WANTED: bool = false;

    fn knot(&mut self, _: &System<V>, _: &Knot<'_, V>, _: bool) {}
}

/// Keeps every knot.
pub(super) struct Everything {
    pub(super) history: History,
    slope_m_per_s2: f64,
}

impl Everything {
    pub(super) fn new(storeys: usize, samples: usize, slope_m_per_s2: f64) -> Self {
        let mut history = History { storeys, ..History::default() };
        let room = samples + samples / 8;
        for column in [
            &mut history.time_s,
            &mut history.table_acceleration_m_per_s2,
            &mut history.sliding_displacement_m,
            &mut history.sliding_velocity_m_per_s,
            &mut history.block_acceleration_m_per_s2,
            &mut history.friction_force_n,
        ] {
            column.reserve(room);
        }
        for column in [
            &mut history.storey_displacement_m,
            &mut history.storey_velocity_m_per_s,
            &mut history.storey_acceleration_m_per_s2,
        ] {
            column.reserve(room * storeys);
        }
        history.mode.reserve(room);
        history.rows.reserve(samples);
        Self { history, slope_m_per_s2 }
    }
}

impl<V: PerStorey> Recorder<V> for Everything {
    const WANTED: bool = true;

    #[inline]
    fn knot(&mut self, system: &System<V>, knot: &Knot<'_, V>, row: bool) {
        let (h, slope) = (&mut self.history, self.slope_m_per_s2);
        if row {
            h.rows.push(h.time_s.len());
        }
        h.time_s.push(knot.time_s);
        h.mode.push(knot.mode);
        h.table_acceleration_m_per_s2.push(knot.table);
        h.sliding_displacement_m.push(knot.state.s());
        h.sliding_velocity_m_per_s.push(knot.state.w());
        h.block_acceleration_m_per_s2.push(match knot.mode {
            Mode::Stick => knot.table,
            Mode::Slip(_) => knot.u - slope,
        });
        h.friction_force_n.push(knot.friction_n);
        let floors = |coordinates: &[f64]| {
            let mut values = V::zeros(coordinates.len());
            system.floors(coordinates, values.as_mut());
            values
        };
        let mut accelerations = floors(knot.f);
        for a in accelerations.as_mut() {
            *a = -*a - slope;
        }
        h.storey_displacement_m.extend_from_slice(floors(knot.state.eta()).as_ref());
        h.storey_velocity_m_per_s.extend_from_slice(floors(knot.state.eta_dot()).as_ref());
        h.storey_acceleration_m_per_s2.extend_from_slice(accelerations.as_ref());
    }
}
