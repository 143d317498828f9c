//! A response as the page takes it: typed arrays over time, and one object of everything else.

use slipstick::assessment::single::Job;
use slipstick::input::{Input, MotionSource};
use slipstick::model::Model;
use slipstick::notice::Notice;
use slipstick::response::{Demands, EventKind, History, Response, StoreyDemands};
use slipstick::units::{Dimension, parse_unit};
use slipstick_report::display::{DisplayUnits, Quantity, Unit};
use slipstick_report::json::{Serialize, each, pretty};
use slipstick_report::number::{compact, rounded, typeset_sentence};
use slipstick_report::{Summary, describe, peaks, view};
use wasm_bindgen::prelude::*;

/// A response that is not judged yet.
#[wasm_bindgen]
pub struct Answer {
    state: String,
    columns: Vec<Vec<f64>>,
    mode: Vec<i8>,
    event_times_s: Vec<f64>,
    event_kinds: Vec<u8>,
    ground: u32,
}

/// Kinds of events in the order of their numbers.
const KINDS: [EventKind; 10] = [
    EventKind::Slip,
    EventKind::Stick,
    EventKind::Reversal,
    EventKind::Contact,
    EventKind::Separation,
    EventKind::Press,
    EventKind::Leave,
    EventKind::Impact,
    EventKind::Rest,
    EventKind::Surface,
];

#[wasm_bindgen]
impl Answer {
    /// All but the histories: the model's values, the peaks, the warnings, the units.
    #[must_use]
    pub fn state(&self) -> String {
        self.state.clone()
    }

    /// A history at the knots, SI: 0 time, 1 table acceleration, 2 sliding displacement, 3 sliding
    /// velocity, 4 total acceleration of the block, 5 friction force, 6 force of the block on its slider,
    /// 7 displacements and 8 accelerations of the storeys, or of the points of a structure by its modes,
    /// all of a knot together, 9 displacements
    /// of the contents; in two directions these are along x, and 10 sliding displacement and 11 friction
    /// force are along y.
    #[must_use]
    pub fn column(&mut self, number: usize) -> Vec<f64> {
        self.columns.get_mut(number).map(std::mem::take).unwrap_or_default()
    }

    /// Sign of the sliding velocity at the knots, 0 in stick.
    #[must_use]
    pub fn mode(&self) -> Vec<i8> {
        self.mode.clone()
    }

    /// Times of the events in s.
    #[wasm_bindgen(js_name = eventTimes)]
    #[must_use]
    pub fn event_times(&self) -> Vec<f64> {
        self.event_times_s.clone()
    }

    /// Kinds of the events: slip, stick, reversal, contact, separation, press, leave, impact, rest,
    /// surface, from 0.
    #[wasm_bindgen(js_name = eventKinds)]
    #[must_use]
    pub fn event_kinds(&self) -> Vec<u8> {
        self.event_kinds.clone()
    }

    /// Number of the ground motion: another one where the table moves otherwise.
    #[must_use]
    pub fn ground(&self) -> u32 {
        self.ground
    }
}

impl Answer {
    /// Gathers what the page draws.
    pub fn new(
        job: &Job,
        words: &str,
        response: &Response,
        summary: &Summary,
        display: DisplayUnits,
        ground: u32,
    ) -> Self {
        let empty = History::default();
        let history = response.history.as_ref().unwrap_or(&empty);
        let model = &job.analysis.model;
        let along_y = response.in_plane.as_ref().and_then(|plane| plane.history.as_ref());
        let points = along_y.map_or(history.point_count(), |y| y.point_count(history));
        let of_points = |value: &dyn Fn(usize, usize) -> f64| {
            let knots = 0..history.len();
            knots.flat_map(|knot| (0..points).map(move |i| value(knot, i))).collect()
        };
        let displacement = |knot, i| match along_y {
            Some(y) => y.point_displacement(history, knot, i)[0],
            None => history.point_displacement(knot, i),
        };
        let acceleration = |knot, i| match along_y {
            Some(y) => y.point_acceleration(history, knot, i)[0],
            None => history.point_acceleration(knot, i),
        };
        let force = response.slider_force_n(model);
        let columns = vec![
            history.time_s.clone(),
            history.table_acceleration_m_per_s2.clone(),
            history.sliding_displacement_m.clone(),
            history.sliding_velocity_m_per_s.clone(),
            history.block_acceleration_m_per_s2.clone(),
            history.friction_force_n.iter().map(|force| -force).collect(),
            force,
            of_points(&displacement),
            of_points(&acceleration),
            history.contents_displacement_m.clone(),
            along_y.map_or_else(Vec::new, |y| y.sliding_displacement_m.clone()),
            along_y
                .map_or_else(Vec::new, |y| y.friction_force_n.iter().map(|force| -force).collect()),
        ];
        let sliders = history.mode.iter().step_by(history.interfaces.max(1));
        let events = response.events.iter();
        let kind = |kind: EventKind| KINDS.iter().position(|k| *k == kind).unwrap_or(0) as u8;
        Self {
            state: pretty(&state(job, words, summary, display)),
            columns,
            mode: sliders.map(|mode| mode.sign() as i8).collect(),
            event_times_s: events.clone().map(|event| event.time_s).collect(),
            event_kinds: events.map(|event| kind(event.kind)).collect(),
            ground,
        }
    }
}

/// Demands of the highest storey, or point of a structure by its modes.
pub fn roof(demands: &Demands) -> Option<&StoreyDemands> {
    demands.storeys.last().or(demands.points.last())
}

fn state(job: &Job, words: &str, summary: &Summary, display: DisplayUnits) -> impl Serialize {
    let analysis = &job.analysis;
    let model = &analysis.model;
    let slider = model.slider();
    let kind = match &analysis.motion {
        Some(MotionSource::Record(_)) => "record",
        Some(MotionSource::Sine(_) | MotionSource::Sines { .. }) => "sine",
        Some(MotionSource::Sweep(_)) => "sweep",
        Some(MotionSource::Pulse(_)) => "pulse",
        None => "",
    };
    let (storey_masses_kg, heights_m) = floors(model);
    let demands = &summary.demands;
    view! {
        name: &summary.model,
        line: describe::model_line(model, display),
        inputs: each(analysis.inputs(), |input| value(input, display)),
        motion: view! {
            kind,
            words,
            pga_m_per_s2: summary.record.pga_m_per_s2,
            duration_s: summary.duration_s,
            dt_s: summary.dt_s,
        },
        structure: view! {
            blockMass_kg: model.block().mass_kg,
            storeyMasses_kg: storey_masses_kg,
            heights_m,
            width_m: model.block().width_m,
            gap_m: slider.gap_m(),
            stop_m: slider.stop().map(|stop| stop.gap_m),
            radius_m: slider.pendulum_radius_m(false),
            springs: model.slider_stiffness_n_per_m() > 0.0,
            weight_n: model.weight_n(),
            tilt_rad: slider.tilt_rad,
            contents: demands.contents.len(),
            storeyNames: each(1..=model.points(), |i| analysis.names.point(i)),
            blockName: analysis.names.block(),
        },
        rows: rows(summary, display),
        runs: ["nominal"],
        warnings: warnings(summary, display),
        units: units(display, demands),
        headline: view! {
            peak_m: demands.peak_sliding_displacement_m,
            peakTime_s: demands.peak_sliding_displacement_time_s,
            residual_m: demands.residual_sliding_displacement_m,
            block_m_per_s2: demands.peak_block_acceleration_m_per_s2,
            roof_m_per_s2: roof(demands).map(|roof| roof.peak_acceleration_m_per_s2),
            gapRatio: demands.gap_ratio,
            slips: demands.slip_count,
            baseShear: demands.base_shear_coefficient,
        },
        method: slipstick_report::summary::method_name(summary.method),
    }
}

/// Mass and height of the storeys in kg and m, as they are drawn; of a structure by its modes each point is
/// one, of equal masses where it has none, and the heights are empty where they are not all known.
fn floors(model: &Model) -> (Vec<f64>, Vec<f64>) {
    let Some(structure) = model.structure() else {
        let frame = model.frame();
        return (frame.masses_kg.clone(), frame.heights_m.clone().unwrap_or_default());
    };
    let points = 0..structure.points.len();
    let masses_kg = structure.points.iter().map(|point| point.mass_kg.unwrap_or(1.0)).collect();
    let heights_m: Option<Vec<f64>> = points.map(|point| structure.rise_m(point)).collect();
    (masses_kg, heights_m.unwrap_or_default())
}

/// A value in use: as written, and as it is shown and may be written in the units of the display.
fn value(input: Input<'_>, display: DisplayUnits) -> impl Serialize {
    let in_numbers = input.value.map(|value| {
        let dimension = Dimension::ALL.into_iter().find(|d| d.si_unit() == input.unit);
        let quantity = Quantity::from(dimension.filter(|_| !input.unit.is_empty()));
        let as_written = matches!(display, DisplayUnits::Si) || quantity == Quantity::Ratio;
        let (in_si, symbol) = match dimension.filter(|_| as_written && !input.unit.is_empty()) {
            Some(dimension) => {
                // Times, frequencies and angles are in the same units everywhere.
                let symbol = input
                    .text
                    .trim_start_matches(|c: char| c.is_ascii_digit() || "+-.eE_ ".contains(c));
                let known = parse_unit(symbol, dimension).is_ok();
                let one = if known { in_si(symbol, dimension) } else { 1.0 };
                (one, if known { symbol } else { input.unit }.to_owned())
            }
            None => {
                let unit = display.unit(quantity, value);
                (unit.in_si, unit.symbol.to_owned())
            }
        };
        let shown = value / in_si;
        let shown = if as_written { compact(shown) } else { rounded(shown, 4) };
        view! { value, in_si, symbol, shown }
    });
    view! {
        path: input.path.to_owned(),
        text: input.text.to_owned(),
        #[serde(flatten)] in_numbers,
    }
}

fn in_si(symbol: &str, dimension: Dimension) -> f64 {
    parse_unit(symbol, dimension).map_or(1.0, |unit| unit.to_si(1.0))
}

/// Units of the plots, each by its largest value.
fn units(display: DisplayUnits, demands: &Demands) -> impl Serialize {
    let all = demands.storeys.iter().chain(&demands.points);
    let roof = all.fold(0.0_f64, |l, s| l.max(s.peak_displacement_m));
    let unit = |quantity, largest: f64| shown_unit(display.unit(quantity, largest));
    let force_n = demands.peak_slider_force_n;
    view! {
        length: unit(Quantity::Length, demands.peak_sliding_displacement_m.max(roof)),
        velocity: unit(Quantity::Velocity, demands.peak_sliding_velocity_m_per_s),
        acceleration: unit(Quantity::Acceleration, demands.peak_block_acceleration_m_per_s2),
        force: unit(Quantity::Force, force_n),
        energy: unit(Quantity::Energy, force_n * demands.sliding_path_m * 0.5),
    }
}

/// A unit: its size in SI, and its symbol.
pub fn shown_unit(unit: Unit) -> impl Serialize {
    view! { in_si: unit.in_si, symbol: unit.symbol }
}

pub fn rows(summary: &Summary, display: DisplayUnits) -> impl Serialize {
    let all = peaks::rows(summary, display).into_iter().chain(peaks::count_rows(summary));
    each(all, |peaks::Row { label, unit, values, governing, .. }| {
        view! { label, unit, values, governing }
    })
}

pub fn warnings(summary: &Summary, display: DisplayUnits) -> impl Serialize {
    each(summary.all_warnings(), |(run, notice)| warning(run, notice, display))
}

/// A notice of a run, of all runs where none is named.
pub fn warning(
    run: Option<&'static str>,
    notice: &Notice,
    display: DisplayUnits,
) -> impl Serialize {
    view! {
        label: notice.label(),
        kind: notice.kind.words(),
        run,
        time_s: notice.time_s,
        message: typeset_sentence(&display.sentence(&notice.message)),
    }
}
