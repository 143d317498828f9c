//! What an analysis returns: peaks and counts, events, histories, warnings.

mod columns;
mod limits;
pub(crate) mod output;
mod registry;

pub use limits::{flat_geometry, struck};

pub use registry::{
    DEMANDS, Demand, DemandColumn, DemandKind, DemandOf, DemandShape, InDirections, PrintedRow,
    demand_values,
};

use std::sync::Arc;

use crate::model::Model;
use crate::notice::Notice;
use crate::slider::Direction;

pub use crate::slider::Contact;

/// Whether the block is held by friction or slides, and which way; in two horizontal directions a slip is
/// positive along its own velocity ([`EventInPlane`]).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// The block moves with the table.
    Stick,
    /// The block slides over the table.
    Slip(Direction),
}

impl Mode {
    /// Sign of the sliding velocity: 0 in stick, ±1 in slip.
    #[must_use]
    pub fn sign(self) -> f64 {
        match self {
            Self::Stick => 0.0,
            Self::Slip(direction) => direction.sign(),
        }
    }
}

/// How an analysis was made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Linear phases propagated exactly, events located.
    Exact,
    /// The paper's own program: trapezoidal rule with fixed-point iteration.
    Stepwise,
}

impl Method {
    /// Its name in the model file.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Exact => "exact",
            Self::Stepwise => "stepwise",
        }
    }
}

/// What happened at an event.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EventKind {
    /// From stick to slip.
    Slip,
    /// From slip to stick.
    Stick,
    /// From sliding one way to sliding the other, without a stick between.
    Reversal,
    /// The block reaches the stop: from free to pressed.
    Contact,
    /// The force of the stop falls to 0 beyond the gap: from pressed to separated.
    Separation,
    /// The stop takes force again beyond the gap: from separated to pressed.
    Press,
    /// The block leaves the stop: back within its gap.
    Leave,
    /// The block strikes a rigid stop and rebounds.
    Impact,
    /// The block comes to rest at a rigid stop: without restitution, or after infinitely many impacts.
    Rest,
    /// Other surfaces of a series slide from here on.
    Surface,
}

impl EventKind {
    /// All kinds.
    pub const ALL: [Self; 10] = [
        Self::Slip,
        Self::Stick,
        Self::Reversal,
        Self::Contact,
        Self::Separation,
        Self::Press,
        Self::Leave,
        Self::Impact,
        Self::Rest,
        Self::Surface,
    ];

    /// Its name in files and tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Slip => "slip",
            Self::Stick => "stick",
            Self::Reversal => "reversal",
            Self::Contact => "contact",
            Self::Separation => "separation",
            Self::Press => "press",
            Self::Leave => "leave",
            Self::Impact => "impact",
            Self::Rest => "rest",
            Self::Surface => "surface",
        }
    }
}

/// A change between stick and slip, of the direction of sliding, or of the contact with a stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    /// When, in s.
    pub time_s: f64,
    /// What.
    pub kind: EventKind,
    /// The mode after it.
    pub mode: Mode,
    /// Sliding displacement then, in m; of contents that over their floor.
    pub sliding_displacement_m: f64,
    /// Where: 0 the slider, then the contents in their order, from 1.
    pub interface: usize,
}

impl Event {
    /// Where it happened, as files name it: `slider`, `contents.1`.
    #[must_use]
    pub fn interface_name(&self) -> String {
        interface_name(self.interface)
    }
}

/// What an interface is called in files: `slider`, `contents.1`.
pub(crate) fn interface_name(interface: usize) -> String {
    match interface {
        0 => "slider".to_owned(),
        contents => format!("contents.{contents}"),
    }
}

/// How the motion of points follows from that of the oscillators which the modes of a structure are.
#[derive(Clone, Debug, PartialEq)]
pub struct PointFactors {
    /// Point by point: what of each oscillator's motion the point has.
    pub of_modes: Vec<Vec<f64>>,
    /// What of the block's acceleration it has besides.
    pub with_block: Vec<f64>,
}

impl PointFactors {
    /// The factors of a model whose structure is given by its modes.
    #[must_use]
    pub fn of(model: &Model) -> Option<Arc<Self>> {
        let structure = model.structure()?;
        let of_modes = |i: usize| structure.modes.iter().map(|mode| mode.points[i]).collect();
        let points = 0..structure.points.len();
        Some(Arc::new(Self {
            of_modes: points.clone().map(of_modes).collect(),
            with_block: points.map(|i| structure.with_block(i)).collect(),
        }))
    }
}

/// States at *knots*: every sample and both sides of every event, in order of time.
///
/// Between two neighbouring knots with different times the table acceleration is linear, and modes
/// and contact are constant (and stored at both). Knots with the same time are the two sides of an
/// event or a jump. Storey values are stored knot by knot, `storeys` values each.
#[derive(Clone, Debug, PartialEq)]
pub struct History {
    /// Number of storeys; of a structure by its modes that of the oscillators that its modes are, whose
    /// motions are then stored as those of storeys.
    pub storeys: usize,
    /// How the points of a structure by its modes follow from these; `None` of a frame.
    pub points: Option<Arc<PointFactors>>,
    /// Number of sliding interfaces: the slider, then the contents.
    pub interfaces: usize,
    /// Number of surfaces in series; 0 of a slider that has one.
    pub surfaces: usize,
    /// Times in s.
    pub time_s: Vec<f64>,
    /// Modes knot by knot, `interfaces` each; at an event first those before it, then those after.
    pub mode: Vec<Mode>,
    /// Contact with the stop; empty where the model has none.
    pub contact: Vec<Contact>,
    /// Table acceleration `Ü` in m/s², on the knot's side of a jump.
    pub table_acceleration_m_per_s2: Vec<f64>,
    /// `s` in m.
    pub sliding_displacement_m: Vec<f64>,
    /// `ṡ` in m/s.
    pub sliding_velocity_m_per_s: Vec<f64>,
    /// Total acceleration of the block, `s̈ + Ü`, in m/s².
    pub block_acceleration_m_per_s2: Vec<f64>,
    /// Force of the table on the block by friction, `T`, in N.
    pub friction_force_n: Vec<f64>,
    /// `q_i` in m, relative to the block.
    pub storey_displacement_m: Vec<f64>,
    /// `q̇_i` in m/s, relative to the block.
    pub storey_velocity_m_per_s: Vec<f64>,
    /// Total acceleration of the floors, `q̈_i + s̈ + Ü`, in m/s².
    pub storey_acceleration_m_per_s2: Vec<f64>,
    /// Displacements of the surfaces in series in m, knot by knot.
    pub surface_displacement_m: Vec<f64>,
    /// Displacement of the contents over their floors in m, knot by knot.
    pub contents_displacement_m: Vec<f64>,
    /// Their velocity over their floors in m/s.
    pub contents_velocity_m_per_s: Vec<f64>,
    /// Their total acceleration in m/s².
    pub contents_acceleration_m_per_s2: Vec<f64>,
    /// Indices of the knots that are rows of `history.csv`: one a sample, the limit from the right
    /// (at a repeated time two, left then right; the last is the left limit).
    pub rows: Vec<usize>,
}

impl Default for History {
    fn default() -> Self {
        Self {
            storeys: 0,
            points: None,
            interfaces: 1,
            surfaces: 0,
            time_s: Vec::new(),
            mode: Vec::new(),
            contact: Vec::new(),
            table_acceleration_m_per_s2: Vec::new(),
            sliding_displacement_m: Vec::new(),
            sliding_velocity_m_per_s: Vec::new(),
            block_acceleration_m_per_s2: Vec::new(),
            friction_force_n: Vec::new(),
            storey_displacement_m: Vec::new(),
            storey_velocity_m_per_s: Vec::new(),
            storey_acceleration_m_per_s2: Vec::new(),
            surface_displacement_m: Vec::new(),
            contents_displacement_m: Vec::new(),
            contents_velocity_m_per_s: Vec::new(),
            contents_acceleration_m_per_s2: Vec::new(),
            rows: Vec::new(),
        }
    }
}

impl History {
    /// Number of knots.
    #[must_use]
    pub fn len(&self) -> usize {
        self.time_s.len()
    }

    /// Whether nothing was stored.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.time_s.is_empty()
    }

    /// Modes at a knot, one an interface, the slider first.
    #[must_use]
    pub fn modes(&self, knot: usize) -> &[Mode] {
        &self.mode[knot * self.interfaces..(knot + 1) * self.interfaces]
    }

    /// Number of contents.
    #[must_use]
    pub fn contents(&self) -> usize {
        self.interfaces - 1
    }

    /// Displacements of the surfaces in series at a knot, in m.
    #[must_use]
    pub fn surface_displacements(&self, knot: usize) -> &[f64] {
        &self.surface_displacement_m[knot * self.surfaces..(knot + 1) * self.surfaces]
    }

    /// Displacement, velocity and total acceleration of contents at a knot, SI.
    #[must_use]
    pub fn contents_state(&self, knot: usize, contents: usize) -> [f64; 3] {
        let at = knot * self.contents() + contents;
        [
            self.contents_displacement_m[at],
            self.contents_velocity_m_per_s[at],
            self.contents_acceleration_m_per_s2[at],
        ]
    }

    /// Number of points whose motion is told: storeys, or the points of a structure by its modes.
    #[must_use]
    pub fn point_count(&self) -> usize {
        self.points.as_ref().map_or(self.storeys, |points| points.of_modes.len())
    }

    /// Displacement of a point at a knot in m, relative to the block.
    #[must_use]
    pub fn point_displacement(&self, knot: usize, point: usize) -> f64 {
        self.of_point(self.storey_displacements(knot), point)
    }

    /// Velocity of a point at a knot in m/s, relative to the block.
    #[must_use]
    pub fn point_velocity(&self, knot: usize, point: usize) -> f64 {
        self.of_point(self.storey_velocities(knot), point)
    }

    /// Total acceleration of a point at a knot in m/s².
    #[must_use]
    pub fn point_acceleration(&self, knot: usize, point: usize) -> f64 {
        let of_modes = self.of_point(self.storey_accelerations(knot), point);
        match &self.points {
            None => of_modes,
            Some(points) => {
                of_modes + points.with_block[point] * self.block_acceleration_m_per_s2[knot]
            }
        }
    }

    fn of_point(&self, values: &[f64], point: usize) -> f64 {
        match &self.points {
            None => values[point],
            Some(points) => {
                let of = points.of_modes[point].iter().zip(values);
                of.fold(0.0, |sum, (factor, value)| sum + factor * value)
            }
        }
    }

    /// Storey displacements at a knot, in m.
    #[must_use]
    pub fn storey_displacements(&self, knot: usize) -> &[f64] {
        &self.storey_displacement_m[knot * self.storeys..(knot + 1) * self.storeys]
    }

    /// Storey velocities at a knot, in m/s.
    #[must_use]
    pub fn storey_velocities(&self, knot: usize) -> &[f64] {
        &self.storey_velocity_m_per_s[knot * self.storeys..(knot + 1) * self.storeys]
    }

    /// Total accelerations of the floors at a knot, in m/s².
    #[must_use]
    pub fn storey_accelerations(&self, knot: usize) -> &[f64] {
        &self.storey_acceleration_m_per_s2[knot * self.storeys..(knot + 1) * self.storeys]
    }
}

/// Peaks of one storey over the whole run, absolute values.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StoreyDemands {
    /// Total acceleration in m/s².
    pub peak_acceleration_m_per_s2: f64,
    /// Displacement relative to the block in m.
    pub peak_displacement_m: f64,
    /// Displacement relative to the floor below in m.
    pub peak_drift_m: f64,
    /// Drift over the storey's height, where heights are given.
    pub peak_drift_ratio: Option<f64>,
    /// Velocity relative to the floor below in m/s.
    pub peak_drift_velocity_m_per_s: f64,
    /// Shear of the storey in N: what moves all above it; of points of a structure by its modes where all have a mass.
    pub peak_shear_n: Option<f64>,
}

/// What the response asks of the stop.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StopDemands {
    /// Times the block reached an elastic stop, on either side; a start beyond the gap is none.
    pub contact_count: u64,
    /// Rebounds from a rigid stop at 1 mm/s or faster.
    pub impact_count: u64,
    /// Largest force between stop and block in N, without the impulses of impacts.
    pub peak_force_n: f64,
    /// Largest |ṡ| at which the block reached the stop in m/s, 0 where it did not.
    pub peak_impact_speed_m_per_s: f64,
    /// Time with a force between stop and block, or at rest at a rigid one, in s.
    pub contact_time_s: f64,
}

/// What the response asks of one surface in series.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SurfaceDemands {
    /// Largest |u| in m.
    pub peak_displacement_m: f64,
    /// u at the last instant in m.
    pub residual_displacement_m: f64,
    /// Whether it has come to the end of its travel.
    pub end_reached: bool,
}

/// What the response asks of contents of a floor.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContentsDemands {
    /// Largest displacement over the floor, as a size, in m.
    pub peak_sliding_displacement_m: f64,
    /// Displacement over the floor at the last instant in m.
    pub residual_sliding_displacement_m: f64,
    /// Path over the floor in m.
    pub sliding_path_m: f64,
    /// Time spent sliding in s.
    pub sliding_time_s: f64,
    /// Largest velocity over the floor in m/s.
    pub peak_sliding_velocity_m_per_s: f64,
    /// Largest total acceleration in m/s².
    pub peak_acceleration_m_per_s2: f64,
    /// Events from stick to slip.
    pub slip_count: u64,
    /// Direct reversals.
    pub reversal_count: u64,
    /// Events from slip to stick.
    pub stick_count: u64,
}

/// What the response asks of the structure: peaks of the continuous motion, residuals, counts.
///
/// Peaks are absolute values over the whole run, the start and both sides of jumps included;
/// accelerations are total (absolute) accelerations.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Demands {
    /// Largest |s| in m.
    pub peak_sliding_displacement_m: f64,
    /// When |s| is largest (first time), in s.
    pub peak_sliding_displacement_time_s: f64,
    /// Largest s in m.
    pub max_sliding_displacement_m: f64,
    /// Smallest s in m.
    pub min_sliding_displacement_m: f64,
    /// s at the last instant, signed, tail included, in m.
    pub residual_sliding_displacement_m: f64,
    /// Whether the block still slides at the last instant.
    pub sliding_at_end: bool,
    /// Path ∫|ṡ| dt in m.
    pub sliding_path_m: f64,
    /// Largest |ṡ| in m/s.
    pub peak_sliding_velocity_m_per_s: f64,
    /// Time spent sliding in s.
    pub sliding_time_s: f64,
    /// Events from stick to slip.
    pub slip_count: u64,
    /// Direct reversals.
    pub reversal_count: u64,
    /// Events from slip to stick.
    pub stick_count: u64,
    /// Largest total acceleration of the block in m/s².
    pub peak_block_acceleration_m_per_s2: f64,
    /// One entry a storey, from the block up.
    pub storeys: Vec<StoreyDemands>,
    /// One entry a point of a structure by its modes, which has no storeys; the drift is that from the point
    /// before, of the first point that from the block.
    pub points: Vec<StoreyDemands>,
    /// Largest force of spring and damper of storey 1 in N, 0 without storeys; with a damping ratio,
    /// whose dampers join all floors, the whole force of the structure on the block.
    pub peak_base_shear_n: f64,
    /// Largest |T| in N, stuck or sliding.
    pub peak_friction_force_n: f64,
    /// Largest |T − K1 s − C1 ṡ| in N, the force of a stop included: all that passes from the table
    /// to the block.
    pub peak_slider_force_n: f64,
    /// Peak base shear over the weight.
    pub base_shear_coefficient: f64,
    /// Peak friction force over the weight.
    pub friction_coefficient_used: f64,
    /// Peak slider force over the weight.
    pub slider_force_coefficient: f64,
    /// Least margin of the decisions at stops, `||demand| − bound| / bound`; `None` where there were
    /// none, and of the stepwise method.
    pub closest_stop: Option<f64>,
    /// Peak sliding displacement over the gap, where one is given.
    pub gap_ratio: Option<f64>,
    /// Largest overturning moment about the sliding surface over `M_tot g width/2`, where width and
    /// heights are given. Of two directions together `|r_x| + |r_y|` of both ratios at one instant, at its largest.
    pub overturning_ratio: Option<f64>,
    /// Of the stop, where the model has one.
    pub stop: Option<StopDemands>,
    /// Of each surface in series.
    pub surfaces: Vec<SurfaceDemands>,
    /// Of the contents of the floors, in their order.
    pub contents: Vec<ContentsDemands>,
}

/// Iterations a step of the stepwise method took.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iterations {
    /// Mean over all steps.
    pub mean: f64,
    /// Largest.
    pub max: u32,
}

/// What an event in two horizontal directions has besides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EventInPlane {
    /// Unit vector of the first sliding velocity after it; 0, 0 where the block sticks.
    pub direction: [f64; 2],
    /// Sliding displacement along y then, in m.
    pub sliding_displacement_y_m: f64,
}

/// How the motion of points in two directions follows from that of the oscillators which the modes of a structure
/// are, each along a direction of its own.
#[derive(Clone, Debug, PartialEq)]
pub struct PointFactorsInPlane {
    /// Point by point along x and y: what of each oscillator's motion the point has.
    pub of_modes: Vec<[Vec<f64>; 2]>,
    /// What of the block's acceleration it has besides, along x and y by that along x and y.
    pub with_block: Vec<[[f64; 2]; 2]>,
}

impl PointFactorsInPlane {
    /// The factors of a model whose structure is given by its modes.
    #[must_use]
    pub fn of(model: &Model) -> Option<Arc<Self>> {
        let structure = model.structure()?;
        let oscillators = structure.oscillators_in_plane();
        let of_modes = |i: usize| {
            [0, 1].map(|axis| oscillators.iter().map(|mode| mode.points[i][axis]).collect())
        };
        let points = 0..structure.points.len();
        Some(Arc::new(Self {
            of_modes: points.clone().map(of_modes).collect(),
            with_block: points.map(|i| structure.with_block_in_plane(i)).collect(),
        }))
    }
}

/// The part of a history that is along y, at the knots of [`History`] and in its order. The oscillators of a
/// structure by its modes have directions of their own: their motions are stored as those of storeys of
/// [`History`], and here there are none.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HistoryAlongY {
    /// Table acceleration in m/s², on the knot's side of a jump.
    pub table_acceleration_m_per_s2: Vec<f64>,
    /// `s` in m.
    pub sliding_displacement_m: Vec<f64>,
    /// `ṡ` in m/s.
    pub sliding_velocity_m_per_s: Vec<f64>,
    /// Total acceleration of the block in m/s².
    pub block_acceleration_m_per_s2: Vec<f64>,
    /// Force of the table on the block by friction in N.
    pub friction_force_n: Vec<f64>,
    /// `q_i` in m, relative to the block.
    pub storey_displacement_m: Vec<f64>,
    /// `q̇_i` in m/s, relative to the block.
    pub storey_velocity_m_per_s: Vec<f64>,
    /// Total acceleration of the floors in m/s².
    pub storey_acceleration_m_per_s2: Vec<f64>,
    /// How the points of a structure by its modes follow from its oscillators; `None` of a frame.
    pub points: Option<Arc<PointFactorsInPlane>>,
}

impl HistoryAlongY {
    /// Number of points whose motion is told: storeys, or the points of a structure by its modes.
    #[must_use]
    pub fn point_count(&self, along_x: &History) -> usize {
        self.points.as_ref().map_or(along_x.storeys, |points| points.of_modes.len())
    }

    /// Displacement of a point along x and y at a knot in m, relative to the block.
    #[must_use]
    pub fn point_displacement(&self, along_x: &History, knot: usize, point: usize) -> [f64; 2] {
        let own = &self.storey_displacement_m;
        self.of_point((along_x.storey_displacements(knot), own), along_x.storeys, knot, point)
    }

    /// Velocity of a point along x and y at a knot in m/s, relative to the block.
    #[must_use]
    pub fn point_velocity(&self, along_x: &History, knot: usize, point: usize) -> [f64; 2] {
        let own = &self.storey_velocity_m_per_s;
        self.of_point((along_x.storey_velocities(knot), own), along_x.storeys, knot, point)
    }

    /// Total acceleration of a point along x and y at a knot in m/s².
    #[must_use]
    pub fn point_acceleration(&self, along_x: &History, knot: usize, point: usize) -> [f64; 2] {
        let own = &self.storey_acceleration_m_per_s2;
        let lists = (along_x.storey_accelerations(knot), own.as_slice());
        let [x, y] = self.of_point(lists, along_x.storeys, knot, point);
        let Some(points) = &self.points else { return [x, y] };
        let block = [&along_x.block_acceleration_m_per_s2, &self.block_acceleration_m_per_s2]
            .map(|list| list[knot]);
        let [of_x, of_y] =
            points.with_block[point].map(|row| row[0] * block[0] + row[1] * block[1]);
        [x + of_x, y + of_y]
    }

    fn of_point(
        &self,
        (values, own): (&[f64], &[f64]),
        storeys: usize,
        knot: usize,
        point: usize,
    ) -> [f64; 2] {
        match &self.points {
            None => [values[point], own[knot * storeys + point]],
            Some(points) => points.of_modes[point].each_ref().map(|factors| {
                factors.iter().zip(values).fold(0.0, |sum, (factor, value)| sum + factor * value)
            }),
        }
    }
}

/// What a response in two horizontal directions has besides. [`Response::demands`] are then of resultants,
/// the norm over x and y at each instant: [`Demands::residual_sliding_displacement_m`] is a norm, largest and
/// smallest `s` are those along x, and a block that passes rest has not reversed. So it is of a motion along a line too,
/// which is solved in one direction.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct InPlane {
    /// Demands along x and along y; counts, times, path and what else belongs to no axis are 0 or absent.
    pub axes: [Demands; 2],
    /// Direction of `s` at its peak, from x towards y, in rad.
    pub peak_sliding_displacement_direction_rad: f64,
    /// Least local minimum of the sliding speed within slips, in m/s.
    pub least_sliding_speed_m_per_s: Option<f64>,
    /// Of each event of [`Response::events`].
    pub events: Vec<EventInPlane>,
    /// Of [`Response::history`], where that was asked for.
    pub history: Option<HistoryAlongY>,
}

/// The result of one analysis.
#[derive(Clone, Debug, PartialEq)]
pub struct Response {
    /// How it was computed.
    pub method: Method,
    /// Peaks, residuals and counts.
    pub demands: Demands,
    /// All events in order.
    pub events: Vec<Event>,
    /// States at knots, where asked for.
    pub history: Option<History>,
    /// Intervals in which contact was lost, in s.
    pub contact_loss_s: Vec<[f64; 2]>,
    /// Iterations, of the stepwise method only.
    pub iterations: Option<Iterations>,
    /// What the solver noticed.
    pub warnings: Vec<Notice>,
    /// Of a motion in two horizontal directions.
    pub in_plane: Option<Box<InPlane>>,
}
