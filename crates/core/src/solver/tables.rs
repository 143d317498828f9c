//! What an analysis needs to know of a structure and a step, made once.

use fearless_simd::prelude::*;

use super::outputs::{self, Outputs};
use crate::friction::Law;
use crate::linear::{
    MAX_RATE_STEP, Maps, Row, SeriesTable, StoreyDamping, System, Units, orders, series_table,
};
use crate::model::{Damping, Model};

/// Most storeys for which samples go in batches: beyond, the maps are larger than the work.
const BATCH_STOREYS: usize = 32;

/// Largest rate times step for batches: beyond, their bounds say nothing.
const BATCH_RATE_STEP: f64 = 8.0;

/// Tables of a structure, its springs and dampers, and a step. Friction has no part in them.
#[derive(Debug)]
pub(super) struct Tables {
    pub(super) stick: Phase,
    /// One for each restraint of the law.
    pub(super) slip: Vec<Phase>,
    /// Orders of all series.
    pub(super) orders: usize,
    /// Whether the overturning moment is an output.
    pub(super) overturns: bool,
    /// `g sin θ`.
    pub(super) slope: f64,
}

/// Tables of stick, or of slip under one restraint.
#[derive(Debug)]
pub(super) struct Phase {
    pub(super) system: System,
    pub(super) slip: bool,
    /// Length of one series in s: a whole part of the step.
    pub(super) unit_s: f64,
    pub(super) series: Option<SeriesTable>,
    pub(super) outputs: Outputs,
    pub(super) batch: Option<Batch>,
}

/// Maps over batches of samples, and the outputs as rows over them.
#[derive(Debug)]
pub(super) struct Batch {
    pub(super) dt_s: f64,
    pub(super) per_dt: f64,
    pub(super) maps: Maps,
    pub(super) rows: Vec<Row>,
    /// `s`.
    pub(super) displacement: Row,
}

/// The linear system of a model.
pub(super) fn system_of(model: &Model) -> System {
    let frame = model.frame();
    let damping = match &frame.damping {
        Damping::Ratio(ratio) => StoreyDamping::Ratio(*ratio),
        Damping::Dampers(dampers) => StoreyDamping::Dampers(dampers),
    };
    System::new(
        model.block().mass_kg,
        model.slider().stiffness_n_per_m,
        model.slider().damper_n_s_per_m,
        &frame.masses_kg,
        &frame.stiffnesses_n_per_m,
        damping,
    )
}

impl Tables {
    /// Tables for a step, or for motions that have none.
    #[inline(always)]
    pub(super) fn new<S: Simd>(simd: S, model: &Model, law: &Law, dt_s: Option<f64>) -> Self {
        let free = system_of(model);
        let overturning = outputs::overturning(model, &free);
        let slope = model.slope_m_per_s2();
        let moment = overturning.as_ref();
        let systems: Vec<System> = law
            .restraints()
            .enumerate()
            .map(|(i, restraint)| {
                let (k, c) = (restraint.stiffness_n_per_m, restraint.damper_n_s_per_m);
                if i == 0 { free.clone() } else { free.restrained(k, c) }
            })
            .collect();
        let rates = systems.iter().map(|system| system.slip_rate_rad_per_s);
        let rate_step = |rate: f64| rate * unit_s(rate, dt_s);
        let orders =
            orders(rates.map(rate_step).fold(rate_step(free.stick_rate_rad_per_s), f64::max));
        let rows = outputs::rows(&free, false, moment, slope);
        let stick = Phase::new(simd, free, false, (dt_s, dt_s), orders, rows);
        let mut slip = Vec::with_capacity(systems.len());
        for system in systems {
            let rows = outputs::rows(&system, true, moment, slope);
            // Pressed against a stop, samples go one by one.
            let batch_s = dt_s.filter(|_| slip.is_empty());
            slip.push(Phase::new(simd, system, true, (dt_s, batch_s), orders, rows));
        }
        Self { stick, slip, orders, overturns: overturning.is_some(), slope }
    }
}

/// Length of one series: a whole part of the step.
fn unit_s(rate_rad_per_s: f64, dt_s: Option<f64>) -> f64 {
    let longest_s = MAX_RATE_STEP / rate_rad_per_s;
    match dt_s {
        Some(dt_s) => dt_s / (dt_s / longest_s).ceil().max(1.0),
        // Without a rate any length is one series; a minute keeps its powers within reach.
        None => longest_s.min(60.0),
    }
}

impl Phase {
    #[inline(always)]
    fn new<S: Simd>(
        simd: S,
        system: System,
        slip: bool,
        (dt_s, batch_s): (Option<f64>, Option<f64>),
        orders: usize,
        rows: Vec<outputs::OutputRow>,
    ) -> Self {
        let rate = if slip { system.slip_rate_rad_per_s } else { system.stick_rate_rad_per_s };
        let unit_s = unit_s(rate, dt_s);
        let series = series_table(&system, slip, unit_s, orders);
        let batch = batch_s
            .filter(|dt_s| system.storeys <= BATCH_STOREYS && dt_s * rate <= BATCH_RATE_STEP);
        let batch = if let Some(dt_s) = batch {
            let units = Units::new(simd, &system, slip, dt_s);
            let of_s: Vec<f64> =
                (0..rows[0].state.len()).map(|i| if i == 0 { 1.0 } else { 0.0 }).collect();
            let mut of_rows = Vec::with_capacity(rows.len());
            for row in &rows {
                of_rows.push(units.row(simd, &row.state, row.of_a, row.of_friction));
            }
            Some(Batch {
                dt_s,
                per_dt: 1.0 / dt_s,
                maps: units.maps(slip),
                rows: of_rows,
                displacement: units.row(simd, &of_s, 0.0, 0.0),
            })
        } else {
            None
        };
        let outputs = Outputs::new(&system, slip, rows);
        Self { system, slip, unit_s, series, outputs, batch }
    }
}
