//! Judges a response without the solver.
//!
//! From the model, the motion, and the states and modes stored at knots, [`check`] integrates the
//! equations of motion (9)–(12) from every knot to the next by Gauss collocation, and compares:
//! states, forces, the laws of friction and stop at every instant, and energy; then the demands and
//! events that this path has with those of the response. It shares nothing with the solver: neither
//! matrices nor modes nor propagators.

mod collocation;
mod damping;
mod demands;
mod energy;
mod events;
mod ground;
mod judge;
mod law;
mod line;
mod near;
mod outputs;
mod plane;
mod rate;
mod structure;

use core::fmt;

use self::energy::EnergyBalance;
use self::judge::{Judge, JudgeInput};
use self::law::Law;
use self::outputs::Outputs;
use self::structure::{Phase, Structure};
use crate::error::Stopped;
use crate::model::{Model, Stop, StopKind};
use crate::motion::GroundMotion;
use crate::progress::{Cancel, NEVER_CANCELLED, Pulse};
use crate::response::{DemandColumn, History, Response, interface_name};

/// Radians beyond which the phase of the fastest mode says nothing: every interval is divided into
/// steps of half a radian, so this also bounds the work.
const MAX_RADIANS: f64 = 1e9;

/// What was decided, and what its margin is a part of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum DecisionKind {
    /// The demand where the block came to rest, `||demand| − bound|/bound`.
    Stop,
    /// A maximum of the demand while it held, `1 − |demand|/bound`.
    Stick,
    /// A minimum of `|ṡ|` over its peak in that slip, where `μ_k < μ_s`; in two directions one at which the
    /// block would have been held.
    Slip,
    /// The speed at a rigid stop over the largest.
    Impact,
    /// The way left to a rigid stop over the gap.
    Miss,
    /// Of surfaces in series, the force left to the next one.
    Join,
    /// How far apart two let go of which one alone would have held the other back.
    Release,
}

impl DecisionKind {
    /// Its name in JSON, tables and texts.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Stop => "stop",
            Self::Stick => "stick",
            Self::Slip => "slip",
            Self::Impact => "impact",
            Self::Miss => "miss",
            Self::Join => "join",
            Self::Release => "release",
        }
    }
}

impl fmt::Display for DecisionKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// The decision that came closest to going the other way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClosestCall {
    /// Distance from the other decision, relative to the bound or peak.
    pub margin: f64,
    /// When, in s.
    pub time_s: f64,
    /// What was decided.
    pub kind: DecisionKind,
    /// What decided: the slider (0) or contents counted from 1.
    pub interface: usize,
}

impl ClosestCall {
    /// What decided, as files name it: `slider`, `contents.1`.
    #[must_use]
    pub fn interface_name(&self) -> String {
        interface_name(self.interface)
    }

    /// Its kind, with the item if it is not the slider's: `stop`, `stop of contents.1`.
    #[must_use]
    pub fn decision(&self) -> String {
        match self.interface {
            0 => self.kind.name().to_owned(),
            _ => format!("{} of {}", self.kind, self.interface_name()),
        }
    }
}

/// Figures that certify a response.
#[derive(Clone, Debug, PartialEq)]
pub struct Certificate {
    /// Largest defect of the equations of motion, 0/0 = 0: at a knot, of `s` and `q` integrated from
    /// the knot before over the run's largest displacement, of `ṡ` and `q̇` over its largest velocity;
    /// of the stored accelerations and `T` in eqs (9), (10) over the largest single term; and of
    /// the stored table acceleration from the motion's over its peak. What a state changes within
    /// the rounding of its time (8 ε of the end) is no defect.
    pub equilibrium_residual: f64,
    /// Largest excess over the friction law, over the largest `μ_s N` (`M_tot g` if that is 0): in
    /// stick the demand beyond its bound, at any instant; in slip `|T + μ_k N sgn ṡ|` with the sign
    /// that `ṡ` really has, in two directions `|T + μ_k N w/|w||`; at a change of mode, by how much the
    /// demand forbids it.
    pub friction_excess: f64,
    /// Largest imbalance of energy at a knot, over the largest sum of `E₀`, the sizes of the table's work
    /// interval by interval, what springs that follow the normal force give back, and the four kinds of
    /// energy.
    pub energy_balance_error: f64,
    /// Largest difference of a printed demand from the one recomputed from the check's own path, over
    /// the peak of its quantity, 0/0 = 0; 1 where a count or the time of an event differs. Peaks are
    /// those of the collocation polynomials, between knots too; rounding (64 ε of the largest terms,
    /// 8 ε of the end for times) is no difference.
    pub demands_error: f64,
    /// The demand of that difference, as its key, `events` or `counts`, in two directions after `x.` or `y.` where it
    /// is of an axis; `None` where there is none.
    pub demand_in_error: Option<String>,
    /// The nearest decision; `None` where nothing was decided.
    pub closest_call: Option<ClosestCall>,
    /// What the first four must stay below: max(1e-10, 100 ε ω_max t_end), with Gershgorin's upper
    /// bound on the fastest rate, sliding or not, as `ω_max`.
    pub bound: f64,
    books: EnergyBalance,
}

impl Certificate {
    /// Energy by kind at every knot; empty where nothing could be judged.
    #[must_use]
    pub fn energy(&self) -> EnergyHistory {
        self.books.history()
    }

    /// The first four figures by their names, that of the demands with the demand.
    fn figures(&self) -> [(String, f64); 4] {
        let of_demand = match &self.demand_in_error {
            Some(demand) => format!("demands error of {}", demand_in_words(demand)),
            None => "demands error".to_owned(),
        };
        [
            ("equilibrium residual".to_owned(), self.equilibrium_residual),
            ("friction excess".to_owned(), self.friction_excess),
            ("energy balance error".to_owned(), self.energy_balance_error),
            (of_demand, self.demands_error),
        ]
    }

    /// The figures that do not stay within the bound, each by its name; that of the demands with the demand.
    #[must_use]
    pub fn defects(&self) -> Vec<(String, f64)> {
        // What is not a number is not within it.
        self.figures().into_iter().filter(|(_, figure)| !(*figure <= self.bound)).collect()
    }

    /// The largest of the first four figures, by its name.
    #[must_use]
    pub fn largest(&self) -> (String, f64) {
        let [first, rest @ ..] = self.figures();
        rest.into_iter().fold(first, |most, other| {
            let larger = other.1 > most.1 || other.1.is_nan() && !most.1.is_nan();
            if larger { other } else { most }
        })
    }

    /// Whether the first four figures stay within the bound.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.equilibrium_residual <= self.bound
            && self.friction_excess <= self.bound
            && self.energy_balance_error <= self.bound
            && self.demands_error <= self.bound
    }
}

/// What [`Certificate::demand_in_error`] is called in a sentence: `sliding path`, `storey 2 peak drift along y`.
fn demand_in_words(demand: &str) -> String {
    let axis = |axis: &'static str| Some((demand.strip_prefix(axis)?.strip_prefix('.')?, axis));
    let (key, along) = match axis("x").or_else(|| axis("y")) {
        Some((key, axis)) => (key, format!(" along {axis}")),
        None => (demand, String::new()),
    };
    let words = match (DemandColumn::of_name(key), key) {
        (Some(column), _) => column.words(),
        // The one figure of a response in two directions that no list of demands has.
        (None, "least_sliding_speed_m_per_s") => "least sliding speed".to_owned(),
        // What is compared as a whole is named by one word, such as `events`.
        (None, word) => word.to_owned(),
    };
    words + &along
}

/// Energy in the frame of the table at every knot, in J.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EnergyHistory {
    /// Initial energy plus the work of the table, `E₀ + W`.
    pub input_j: Vec<f64>,
    /// Kinetic.
    pub kinetic_j: Vec<f64>,
    /// Strain of spring and storeys.
    pub strain_j: Vec<f64>,
    /// Spent in dampers so far, and what a stop has taken, with what it had at the start.
    pub damping_j: Vec<f64>,
    /// Spent in friction so far.
    pub friction_j: Vec<f64>,
}

/// Judges a response to a motion: the states at the knots of its history, and its demands and events
/// by what these states tell.
///
/// No history, or one that cannot be judged (lists of different lengths, times that run backwards, do not
/// start at 0 or end before the motion, values that are not finite where steps depend on them)
/// gets infinite figures.
///
/// # Examples
/// ```
/// use slipstick_dynamics::check::check;
/// use slipstick_dynamics::{model::Model, motion::GroundMotion, solver};
///
/// let model = Model::builder().block("124 kg").friction(0.2, 0.15).build()?;
/// let motion = GroundMotion::new(vec![0.0, 0.5, 0.5, 1.5], vec![4.0, 4.0, 0.0, 0.0], None)?;
/// let mut response = solver::exact(&model, &motion)?;
/// assert!(check(&model, &motion, &response).holds());
///
/// // A millionth more than what came out is found.
/// response.demands.peak_sliding_displacement_m *= 1.0 + 1e-6;
/// assert!(!check(&model, &motion, &response).holds());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn check(model: &Model, motion: &GroundMotion, response: &Response) -> Certificate {
    // Nothing stops it.
    check_while(model, motion, response, NEVER_CANCELLED).unwrap_or_else(|Stopped| unjudged(1e-10))
}

/// [`check()`] as long as `go_on` says so, which is asked every few milliseconds.
///
/// # Errors
/// [`Stopped`] where it says no.
pub fn check_while(
    model: &Model,
    motion: &GroundMotion,
    response: &Response,
    go_on: Cancel<'_>,
) -> Result<Certificate, Stopped> {
    if let Some(table_y) = motion.horizontal_y_m_per_s2() {
        return plane::check(model, (motion, table_y), response, go_on);
    }
    let vertical = motion.vertical_m_per_s2().is_some();
    let structure = Structure::new(model, vertical);
    let history = response.history.as_ref();
    let end_s = history.and_then(|h| h.time_s.last().copied()).unwrap_or(0.0);
    let fastest = if model.stop().is_some() { Phase::Pressed } else { Phase::Slip };
    let radians = structure.rate(fastest) * end_s;
    let bound = (100.0 * f64::EPSILON * radians).max(1e-10);
    let judged = history
        .filter(|h| radians <= MAX_RADIANS && well_formed(model, model.storeys(), motion, h));
    let run = |history| {
        let (law, outputs, pulse) =
            (Law::new(model, vertical), Outputs::new(model), Pulse::new(go_on));
        let (law, outputs) = (&law, &outputs);
        let given = JudgeInput { model, motion, response, history, law, outputs, pulse };
        Judge::of_line(given, &structure).run(bound)
    };
    let judged = judged.map_or(Ok(None), run)?;
    Ok(judged.unwrap_or_else(|| unjudged(bound)))
}

/// Of what cannot be judged.
fn unjudged(bound: f64) -> Certificate {
    Certificate {
        equilibrium_residual: f64::INFINITY,
        friction_excess: f64::INFINITY,
        energy_balance_error: f64::INFINITY,
        demands_error: f64::INFINITY,
        demand_in_error: None,
        closest_call: None,
        bound,
        books: EnergyBalance::default(),
    }
}

/// Whether a history has the shape that its documentation promises, with so many storeys.
fn well_formed(model: &Model, n: usize, motion: &GroundMotion, history: &History) -> bool {
    let knots = history.len();
    let ends_s = motion.duration_s() * (1.0 - 8.0 * f64::EPSILON);
    let knot_lists = [
        &history.table_acceleration_m_per_s2,
        &history.sliding_displacement_m,
        &history.sliding_velocity_m_per_s,
        &history.block_acceleration_m_per_s2,
        &history.friction_force_n,
    ];
    let storey_lists = [
        &history.storey_displacement_m,
        &history.storey_velocity_m_per_s,
        &history.storey_acceleration_m_per_s2,
    ];
    // In two directions a block may also slide along a stop that does not give way.
    let is_in_plane = motion.horizontal_y_m_per_s2().is_some();
    let elastic = |stop: &Stop| matches!(stop.kind, StopKind::Elastic { .. });
    let is_listed = model.stop().is_some_and(|stop| is_in_plane || elastic(stop));
    let contacts = if is_listed { knots } else { 0 };
    let contents = model.contents().len();
    let surfaces = model.slider().series().map_or(0, |series| series.surfaces().len());
    let contents_lists = [
        &history.contents_displacement_m,
        &history.contents_velocity_m_per_s,
        &history.contents_acceleration_m_per_s2,
    ];
    history.storeys == n
        && history.interfaces == 1 + contents
        && history.surfaces == surfaces
        && history.surface_displacement_m.len() == knots * surfaces
        && contents_lists.iter().all(|list| list.len() == knots * contents)
        && history.mode.len() == knots * (1 + contents)
        && history.contact.len() == contacts
        && knot_lists.iter().all(|list| list.len() == knots)
        && storey_lists.iter().all(|list| list.len() == knots * n)
        && history.time_s.first() == Some(&0.0)
        && history.time_s.windows(2).all(|pair| pair[0] <= pair[1])
        && history.time_s.last().is_some_and(|t| t.is_finite() && *t >= ends_s)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A certificate calls a demand as tables and titles do, with its part and its axis.
    #[test]
    fn a_demand_in_error_is_named_in_words() {
        for (key, said) in [
            ("sliding_path_m", "sliding path"),
            ("block.peak_acceleration_m_per_s2", "block peak acceleration"),
            ("storey2_peak_drift_m", "storey 2 peak drift"),
            ("y.storey1_peak_drift_m", "storey 1 peak drift along y"),
            ("stop.peak_force_n", "stop peak force"),
            ("least_sliding_speed_m_per_s", "least sliding speed"),
            ("events", "events"),
        ] {
            assert_eq!(demand_in_words(key), said);
        }
    }
}
