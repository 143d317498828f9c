//! Keeps the history of a response.

use super::slider::SliderState;
use crate::error::SolveError;
use crate::linear::lanes::dot;
use crate::linear::{BATCH, System};
use crate::model::Model;
use crate::response::{History, Mode};
use crate::slider::{Contact, Law};

/// Memory of an analysis with history and certificate: so many bytes a sample and number kept, and the
/// most in all.
const BYTES_A_NUMBER: u64 = 40;
const MEMORY_LIMIT: u64 = 4 << 30;

/// Whether the history of so many samples and its certificate fit: what cannot be certified is not answered,
/// kept or not.
///
/// # Errors
/// [`SolveError::TooMuchMemory`] where they do not.
pub(super) fn fits(model: &Model, samples: usize) -> Result<(), SolveError> {
    let surfaces = model.law(false).surface_count();
    // t, Ü, s, ṡ, block, T, five energies; q, q̇ and acceleration; r, ṙ and acceleration; u.
    let storeys = model.storeys().max(model.storeys_in_plane());
    let numbers = 11 + 3 * storeys + 3 * model.contents().len() + surfaces;
    let (bytes, limit) = (BYTES_A_NUMBER * samples as u64 * numbers as u64, MEMORY_LIMIT);
    if bytes <= limit {
        return Ok(());
    }
    Err(SolveError::TooMuchMemory { bytes, limit, samples, numbers })
}

/// What is known at a knot.
pub(super) struct Knot<'a> {
    pub(super) time_s: f64,
    pub(super) mode: Mode,
    pub(super) contact: Contact,
    /// `Ü`.
    pub(super) table: f64,
    /// `a`.
    pub(super) acceleration: f64,
    /// `s, ṡ, η, η̇`.
    pub(super) state: &'a [f64],
    /// Friction force in slip, in N.
    pub(super) friction_n: f64,
    /// In slip the constant part of the force on the block, in stick the force of springs and stop.
    pub(super) force_n: f64,
}

/// Keeps every knot.
pub(super) struct Recorder {
    pub(super) history: History,
    slope_m_per_s2: f64,
    stop: bool,
    f: Vec<f64>,
    /// Room for a state.
    pub(super) state: Vec<f64>,
}

impl Recorder {
    pub(super) fn new(system: &System, law: &Law<'_>, samples: usize, slope_m_per_s2: f64) -> Self {
        let (storeys, surfaces) = (system.storeys, law.surface_count());
        let stop = law.has_pads();
        let mut history = History { storeys, surfaces, ..History::default() };
        let capacity = samples + samples / 8;
        for column in [
            &mut history.time_s,
            &mut history.table_acceleration_m_per_s2,
            &mut history.sliding_displacement_m,
            &mut history.sliding_velocity_m_per_s,
            &mut history.block_acceleration_m_per_s2,
            &mut history.friction_force_n,
        ] {
            column.reserve(capacity);
        }
        for column in [
            &mut history.storey_displacement_m,
            &mut history.storey_velocity_m_per_s,
            &mut history.storey_acceleration_m_per_s2,
        ] {
            column.reserve(capacity * storeys);
        }
        history.mode.reserve(capacity);
        history.rows.reserve(samples);
        Self { history, slope_m_per_s2, stop, f: vec![0.0; system.modes()], state: Vec::new() }
    }
}

/// Adds the first of nine numbers.
#[inline(always)]
fn extend(list: &mut Vec<f64>, numbers: &[f64; BATCH + 1], steps: usize) {
    if steps == BATCH {
        // Of a known length: no call.
        list.extend_from_slice(&numbers[..BATCH]);
    } else {
        list.extend_from_slice(&numbers[..steps]);
    }
}

/// What is stored at a knot.
pub(super) struct Stored<'a> {
    pub(super) time_s: f64,
    pub(super) mode: Mode,
    pub(super) contact: Contact,
    /// `Ü`.
    pub(super) table: f64,
    /// `s, ṡ, η, η̇`.
    pub(super) state: &'a [f64],
    /// Total acceleration of the block.
    pub(super) block: f64,
    pub(super) friction_n: f64,
    /// `f = D η̇ + Ω η`.
    pub(super) f: &'a [f64],
}

impl Recorder {
    /// Stores a knot; `row` if it is also a row of the sampled history.
    #[inline]
    pub(super) fn store(&mut self, system: &System, knot: &Stored<'_>, row: bool) {
        let h = &mut self.history;
        if row {
            h.rows.push(h.time_s.len());
        }
        h.time_s.push(knot.time_s);
        h.mode.push(knot.mode);
        if self.stop {
            h.contact.push(knot.contact);
        }
        h.table_acceleration_m_per_s2.push(knot.table);
        self.store_motion(system, knot.state, [knot.block, knot.friction_n], knot.f);
    }

    /// Stores times and table accelerations of samples in one mode, each a row, before their motion.
    #[inline]
    pub(super) fn store_samples(
        &mut self,
        [times_s, table]: [&[f64]; 2],
        mode: Mode,
        contact: Contact,
    ) {
        let h = &mut self.history;
        let (first, end) = (h.time_s.len(), h.time_s.len() + times_s.len());
        h.rows.extend(first..end);
        h.time_s.extend_from_slice(times_s);
        h.mode.resize(end, mode);
        if self.stop {
            h.contact.resize(end, contact);
        }
        h.table_acceleration_m_per_s2.extend_from_slice(table);
    }

    /// Stores the motion at the first of nine samples whose times have been stored: `s`, `ṡ`, the block's
    /// acceleration and friction; displacement, velocity and acceleration of one storey.
    #[inline(always)]
    pub(super) fn store_batch(
        &mut self,
        steps: usize,
        block: [&[f64; BATCH + 1]; 4],
        storey: Option<&[[f64; BATCH + 1]; 3]>,
    ) {
        let h = &mut self.history;
        extend(&mut h.sliding_displacement_m, block[0], steps);
        extend(&mut h.sliding_velocity_m_per_s, block[1], steps);
        extend(&mut h.block_acceleration_m_per_s2, block[2], steps);
        extend(&mut h.friction_force_n, block[3], steps);
        if let Some([displacement, velocity, acceleration]) = storey {
            extend(&mut h.storey_displacement_m, displacement, steps);
            extend(&mut h.storey_velocity_m_per_s, velocity, steps);
            extend(&mut h.storey_acceleration_m_per_s2, acceleration, steps);
        }
    }

    #[inline(always)]
    fn store_motion(
        &mut self,
        system: &System,
        x: &[f64],
        [block, friction_n]: [f64; 2],
        f: &[f64],
    ) {
        let (n, modes) = (system.storeys, system.modes());
        let (h, slope) = (&mut self.history, self.slope_m_per_s2);
        h.sliding_displacement_m.push(x[0]);
        h.sliding_velocity_m_per_s.push(x[1]);
        h.block_acceleration_m_per_s2.push(block);
        h.friction_force_n.push(friction_n);
        let (eta, rate) = (&x[2..2 + modes], &x[2 + modes..2 + 2 * modes]);
        for i in 0..n {
            let shape = system.floor(i);
            h.storey_displacement_m.push(dot(shape, eta));
            h.storey_velocity_m_per_s.push(dot(shape, rate));
            h.storey_acceleration_m_per_s2.push(-dot(shape, f) - slope);
        }
    }

    /// A knot; `row` if it is also a row of the sampled history.
    #[inline]
    pub(super) fn knot(&mut self, system: &System, knot: &Knot<'_>, row: bool) {
        let mut f = core::mem::take(&mut self.f);
        let [block, friction_n] = self.forces(system, knot, &mut f);
        let Knot { time_s, mode, contact, table, state, .. } = *knot;
        let stored = Stored { time_s, mode, contact, table, state, block, friction_n, f: &f };
        self.store(system, &stored, row);
        self.f = f;
    }

    /// Displacements of surfaces in series at a knot.
    #[inline(always)]
    pub(super) fn surfaces(&mut self, slider: &SliderState<'_>, s: f64) {
        if self.history.surfaces > 0 {
            let surfaces = slider.law.surfaces(&slider.memory, s);
            self.history.surface_displacement_m.extend(surfaces);
        }
    }

    /// The motion at a knot whose time has been stored with those of other samples.
    #[inline(always)]
    pub(super) fn motion(&mut self, system: &System, knot: &Knot<'_>) {
        let mut f = core::mem::take(&mut self.f);
        let forces = self.forces(system, knot, &mut f);
        self.store_motion(system, knot.state, forces, &f);
        self.f = f;
    }

    /// Acceleration of the block and friction force at a knot; leaves `D η̇ + Ω η` in `f`.
    #[inline(always)]
    fn forces(&self, system: &System, knot: &Knot<'_>, f: &mut [f64]) -> [f64; 2] {
        let (modes, x) = (system.modes(), knot.state);
        system.restoring(&x[2..2 + modes], &x[2 + modes..2 + 2 * modes], f);
        let shear_n = dot(&system.participation, f);
        match knot.mode {
            Mode::Stick => {
                let inertia = system.block_mass_kg * knot.acceleration;
                [knot.table, (inertia + knot.force_n) - shear_n]
            }
            Mode::Slip(_) => {
                let u = system.block_acceleration(x[0], x[1], shear_n, knot.force_n);
                [u - self.slope_m_per_s2, knot.friction_n]
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::slider::Friction;

    /// 40 bytes × 11 numbers × 9e7 samples.
    #[test]
    fn histories_that_do_not_fit_are_refused() {
        let friction = Friction::new(0.1, 0.1).unwrap();
        let model = Model::rigid_block(100.0, friction).unwrap();
        assert_eq!(fits(&model, 9_000_000), Ok(()));
        assert_eq!(
            fits(&model, 90_000_000).unwrap_err().to_string(),
            "the history would take 36.9 GiB, where 4 GiB are the most: 90000000 samples with 11 \
             numbers each; take a longer time step or a shorter motion"
        );
    }
}
