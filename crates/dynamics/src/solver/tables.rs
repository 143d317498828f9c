//! What an analysis needs to know of a structure and a step, made once.

use core::ops::Deref;
use std::sync::{Arc, OnceLock};

use fearless_simd::prelude::*;

use super::outputs::{self, Inertia, Outputs};
use super::{dense, plane};
use crate::error::SolveError;
use crate::linear::polynomial::DEGREE;
use crate::linear::{
    BATCH, IntervalTables, MAX_RATE_STEP, Maps, Row, StoreyDamping, System, UnitResponses, orders,
};
use crate::model::{Damping, Model};
use crate::numerics::InstructionSet;
use crate::numerics::instructions::vectorize;
use crate::response::output;
use crate::slider::{Law, Restraint, Restraints};

/// Most storeys for which samples go in batches: beyond, the maps are larger than the work.
const BATCH_STOREYS: usize = 32;

/// Largest rate times step for batches: beyond, their bounds say nothing.
const BATCH_RATE_STEP: f64 = 8.0;

/// Tables of a structure, its restraints by the ground, and a step.
#[derive(Debug)]
pub(super) struct Tables {
    pub(super) stick: LazyPhase,
    /// One for each restraint of the law.
    slip: Vec<LazyPhase>,
    /// Orders of all series.
    pub(super) orders: usize,
    /// Whether the overturning moment is an output.
    overturns: bool,
    /// `g sin θ`.
    pub(super) slope: f64,
    /// `s, ṡ, η, η̇` at the start, padded.
    pub(super) start: Vec<f64>,
    /// For the way ahead of one storey or none.
    pub(super) dense: Option<Box<dense::Tables>>,
    in_plane: OnceLock<plane::System>,
}

/// What tables of stick, or of slip under one restraint, are made of where they are first needed.
#[derive(Debug)]
pub(super) struct LazyPhase {
    /// Its number: 0 is stick.
    pub(super) number: usize,
    pub(super) system: Arc<System>,
    /// None in stick.
    restraints: Option<Restraints>,
    dt_s: Option<f64>,
    batch_s: Option<f64>,
    orders: usize,
    inertia: Arc<Inertia>,
    slope: f64,
    phase: OnceLock<PhaseTables>,
}

impl LazyPhase {
    /// What of the restraint is friction.
    pub(super) fn of_friction(&self) -> Restraint {
        self.restraints.map(|restraints| restraints.of_friction).unwrap_or_default()
    }

    /// The tables.
    #[inline(always)]
    pub(super) fn get(&self) -> &PhaseTables {
        match self.phase.get() {
            Some(phase) => phase,
            None => self.make(),
        }
    }

    #[cold]
    #[inline(never)]
    fn make(&self) -> &PhaseTables {
        let make = || vectorize!(InstructionSet::best(), simd => PhaseTables::new(simd, self));
        self.phase.get_or_init(make)
    }
}

impl Deref for LazyPhase {
    type Target = PhaseTables;

    #[inline(always)]
    fn deref(&self) -> &PhaseTables {
        self.get()
    }
}

/// Tables of stick, or of slip under one restraint.
#[derive(Debug)]
pub(super) struct PhaseTables {
    pub(super) system: Arc<System>,
    pub(super) slip: bool,
    /// Length of one series in s: a whole part of the step.
    pub(super) unit_s: f64,
    /// The motion over that, with the sliding velocity in slip and the demand on friction in stick.
    pub(super) solution: IntervalTables,
    pub(super) outputs: Outputs,
    /// How much the energy norm can grow over one series: friction that falls with the speed feeds it.
    pub(super) growth: f64,
    /// Step of the batches, where samples go by them.
    batch_s: Option<f64>,
    batch: OnceLock<Batch>,
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
    /// How much the energy norm can grow over a batch.
    pub(super) growth: f64,
}

/// The linear system of a model.
pub(super) fn system_of(model: &Model) -> System {
    let frame = model.frame();
    if let (Some(structure), Damping::Dampers(dampers)) = (model.structure(), &frame.damping) {
        let of_point = |i: usize| structure.modes.iter().map(|mode| mode.points[i]).collect();
        let points: Vec<Vec<f64>> = (0..structure.points.len()).map(of_point).collect();
        return System::of_oscillators(
            (
                model.block().mass_kg,
                model.slider_stiffness_n_per_m(),
                model.slider().damper_n_s_per_m,
            ),
            (&frame.masses_kg, &frame.stiffnesses_n_per_m, dampers),
            &points,
        );
    }
    let damping = match &frame.damping {
        Damping::Ratio(ratio) => StoreyDamping::Ratio(*ratio),
        Damping::Dampers(dampers) => StoreyDamping::Dampers(dampers),
    };
    System::new(
        model.block().mass_kg,
        model.slider_stiffness_n_per_m(),
        model.slider().damper_n_s_per_m,
        &frame.masses_kg,
        &frame.stiffnesses_n_per_m,
        damping,
    )
}

/// Whether tables serve a model with its law, under a normal force that is constant or varies.
pub(super) fn serve(model: &Model, law: &Law<'_>, varying: bool) -> bool {
    model.contents().is_empty() && law.is_tabled(varying)
}

impl Tables {
    /// Tables for a step, or for motions that have none. A law that goes by none needs no more than the
    /// systems.
    #[inline(always)]
    pub(super) fn new<S: Simd>(simd: S, model: &Model, dt_s: Option<f64>) -> Self {
        let normal_n = model.normal_n();
        let law = model.law(false);
        let is_tabled = serve(model, &law, false);
        let law = law.under(normal_n);
        let free = system_of(model);
        let Restraint { stiffness_n_per_m, damper_n_s_per_m } = law.restraint();
        let free = if stiffness_n_per_m == free.stiffness_n_per_m {
            free
        } else {
            free.restrained(stiffness_n_per_m, damper_n_s_per_m)
        };
        let free = Arc::new(free);
        let inertia = Arc::new(Inertia::new(model, &[]));
        let slope = model.slope_m_per_s2();
        let mut stick = LazyPhase {
            number: 0,
            system: free.clone(),
            restraints: None,
            dt_s,
            batch_s: dt_s.filter(|_| is_tabled),
            orders: DEGREE,
            inertia,
            slope,
            phase: OnceLock::new(),
        };
        let mut slip = Vec::with_capacity(2);
        for restraints in law.restraints(normal_n) {
            let Restraint { stiffness_n_per_m: k, damper_n_s_per_m: c } = restraints.all;
            let same = k == free.stiffness_n_per_m && c == free.damper_n_s_per_m;
            let system = if same { free.clone() } else { Arc::new(free.restrained(k, c)) };
            slip.push(LazyPhase {
                number: 1 + slip.len(),
                system,
                restraints: Some(restraints),
                // Pressed against a stop, samples go one by one.
                batch_s: dt_s.filter(|_| !restraints.is_pressed),
                inertia: stick.inertia.clone(),
                phase: OnceLock::new(),
                ..stick
            });
        }
        if law.fading_rate_s_per_m().is_none() {
            let rates = slip.iter().map(|slip| slip.system.slip_rate_rad_per_s);
            let rate_step = |rate: f64| rate * unit_s(rate, dt_s);
            let first = rate_step(free.stick_rate_rad_per_s);
            stick.orders = orders(rates.map(rate_step).fold(first, f64::max));
            for slip in &mut slip {
                slip.orders = stick.orders;
            }
        }
        let start = start(model, &free);
        let fits = free.storeys <= 1 && !free.is_by_modes();
        let plain_s = dt_s.filter(|_| fits && is_tabled && law.two_branches(normal_n).is_some());
        let dense = plain_s.and_then(|dt_s| {
            let arms = stick.inertia.arms.as_ref();
            let rows = [None, Some(&Restraint::default())]
                .map(|slip| outputs::rows(&free, slip, &stick.inertia, slope));
            let shape = dense::Shape {
                floor: if free.storeys == 1 { free.floor(0)[0] } else { 0.0 },
                arms: arms.map_or([0.0; 2], |arms| {
                    let (of_f, of_block) = arms.by_modes(&free);
                    [of_f.first().copied().unwrap_or(0.0), of_block]
                }),
                slope,
            };
            dense::Tables::new(simd, &free, shape, rows.each_ref().map(Vec::as_slice), dt_s)
        });
        let overturns = stick.inertia.arms.is_some();
        let (orders, in_plane) = (stick.orders, OnceLock::new());
        let tables = Self { orders, stick, slip, overturns, slope, start, dense, in_plane };
        if is_tabled && tables.dense.is_none() {
            tables.stick.get().batch();
            tables.slip[0].get().batch();
        }
        tables
    }

    /// The system in two horizontal directions, under the friction of a model that these tables serve.
    ///
    /// # Errors
    /// As [`plane::System::new`].
    pub(super) fn in_plane(&self, model: &Model) -> Result<plane::System, SolveError> {
        if let Some(system) = self.in_plane.get() {
            return system.under_friction_of(model);
        }
        let system = plane::System::new(model)?;
        Ok(self.in_plane.get_or_init(|| system).clone())
    }

    /// Whether the overturning moment is an output.
    pub(super) fn overturns(&self) -> bool {
        self.overturns
    }

    /// Largest rate of slip under any restraint, in rad/s.
    pub(super) fn rate_rad_per_s(&self) -> f64 {
        self.slip.iter().fold(0.0, |rate, slip| slip.system.slip_rate_rad_per_s.max(rate))
    }

    /// A phase by its number.
    #[inline(always)]
    pub(super) fn phase(&self, number: usize) -> &PhaseTables {
        self.slip.get(number.wrapping_sub(1)).unwrap_or(&self.stick).get()
    }

    /// Tables of slip under the restraints of a branch.
    #[inline(always)]
    pub(super) fn under(&self, restraints: Restraints) -> &LazyPhase {
        let place = self.slip.iter().position(|slip| slip.restraints == Some(restraints));
        &self.slip[place.unwrap_or_default()]
    }
}

/// The state with which an analysis starts, padded.
fn start(model: &Model, system: &System) -> Vec<f64> {
    let (initial, masses_kg) = (model.initial(), &model.frame().masses_kg);
    let mut x = vec![initial.sliding_displacement_m, initial.sliding_velocity_m_per_s];
    x.extend(system.coordinates(masses_kg, &model.initial_storey_displacement_m()));
    x.extend(system.coordinates(masses_kg, &model.initial_storey_velocity_m_per_s()));
    x.resize(x.len().next_multiple_of(4), 0.0);
    x
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

impl PhaseTables {
    /// Tables of slip with what of its restraint is friction, or of stick.
    #[inline(always)]
    fn new<S: Simd>(simd: S, of: &LazyPhase) -> Self {
        let LazyPhase { ref system, restraints, dt_s, batch_s, orders, slope, .. } = *of;
        let inertia = &*of.inertia;
        let of_friction = restraints.map(|restraints| restraints.of_friction);
        let rows = outputs::rows(system, of_friction.as_ref(), inertia, slope);
        let slip = of_friction.is_some();
        let system = system.clone();
        let rate = if slip { system.slip_rate_rad_per_s } else { system.stick_rate_rad_per_s };
        let unit_s = unit_s(rate, dt_s);
        let tracked = &rows[if slip { output::VELOCITY } else { output::FRICTION }];
        let tracked = (tracked.state.as_slice(), tracked.of_a, tracked.of_friction);
        let solution = IntervalTables::new(simd, &system, slip, (unit_s, orders), tracked);
        let batch_s = batch_s
            .filter(|dt_s| system.storeys <= BATCH_STOREYS && dt_s * rate <= BATCH_RATE_STEP);
        let growth = if slip { system.growth(unit_s) } else { 1.0 };
        let outputs = Outputs::new(&system, slip, rows);
        let batch = OnceLock::new();
        Self { system, slip, unit_s, solution, outputs, growth, batch_s, batch }
    }

    /// Maps over batches of samples, where they go by them; made where they are first needed.
    #[inline(always)]
    pub(super) fn batch(&self) -> Option<&Batch> {
        match self.batch.get() {
            Some(batch) => Some(batch),
            None => self.make_batch(),
        }
    }

    #[cold]
    #[inline(never)]
    fn make_batch(&self) -> Option<&Batch> {
        let dt_s = self.batch_s?;
        let make = || vectorize!(InstructionSet::best(), simd => Batch::new(simd, self, dt_s));
        Some(self.batch.get_or_init(make))
    }
}

impl Batch {
    #[inline(always)]
    fn new<S: Simd>(simd: S, phase: &PhaseTables, dt_s: f64) -> Self {
        let PhaseTables { ref system, slip, .. } = *phase;
        let rows = &phase.outputs.rows;
        let units = UnitResponses::new(simd, system, slip, dt_s);
        let mut of_s = vec![0.0; rows[0].state.len()];
        of_s[0] = 1.0;
        let mut of_rows = Vec::with_capacity(rows.len());
        for row in rows {
            of_rows.push(units.row(simd, &row.state, row.of_a, row.of_friction));
        }
        Self {
            dt_s,
            per_dt: 1.0 / dt_s,
            maps: units.maps(system, slip),
            rows: of_rows,
            displacement: units.row(simd, &of_s, 0.0, 0.0),
            growth: if slip { system.growth(BATCH as f64 * dt_s) } else { 1.0 },
        }
    }
}
