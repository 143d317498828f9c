//! The amplification window: where sliding makes the storey's response larger.

use crate::claims::Finding;
use crate::curves::{highest, interval_text, intervals, linspace, logspace, range};
use crate::library::{
    Experiment, Library, damping_ratio, fixed, free_free_hz, storey, storey_peak,
};
use crate::numbers::amplification;
use crate::steady::{SAMPLES, steady};
use crate::{Grid, PaperError, WINDOWS, piece};
use slipstick::motion::Sine;
use slipstick::solver;
use slipstick::study::engine::Engine;

/// Duration of a test from rest in s.
const FROM_REST_S: f64 = 20.0;

/// Frequencies as tested, in Hz.
pub const TESTED_HZ: [f64; 2] = [1.0, 3.4];
/// Frequencies as scanned, in Hz.
pub const SCANNED_HZ: [f64; 2] = [0.2, 8.0];

/// A ratio above this exceeds one: sampling the sine 100 times a period costs 0.03 %.
const ABOVE_ONE: f64 = 1.005;

/// A ratio below this is smaller than one.
const BELOW_ONE: f64 = 0.995;

/// Amplitude in m/s² at which the window is judged: all mock-ups slide, and it is still wide.
const JUDGED: f64 = 1.0;

/// Ratios at one frequency of the table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Frequency in Hz.
    pub frequency_hz: f64,
    /// Peak storey acceleration in 20 s from rest over the table's amplitude.
    pub rest_over_table: f64,
    /// The same over that of the same storey on a fixed block.
    pub rest_over_fixed: f64,
    /// Steady peak storey acceleration over the table's amplitude.
    pub steady_over_table: f64,
    /// The same over that on a fixed block.
    pub steady_over_fixed: f64,
    /// Periods of the table after which the steady motion repeats; `None` where it has not
    /// settled.
    pub period: Option<usize>,
    /// Sliding displacement gained a period in the steady state, in m.
    pub drift_m: f64,
    /// Whether the block slides at all in 20 s from rest, and in the steady state.
    pub slides: [bool; 2],
}

/// Ratios of one mock-up at one amplitude against frequency.
#[derive(Clone, Debug, PartialEq)]
pub struct Window {
    /// Name of the experiment that the mock-up is from.
    pub id: String,
    /// `M2` in kg.
    pub mass_kg: f64,
    /// Fixed-base frequency in Hz.
    pub frequency_hz: f64,
    /// Frequency of the storey on the freely sliding block in Hz.
    pub free_free_hz: f64,
    /// Amplitude of the table in m/s².
    pub amplitude_m_per_s2: f64,
    /// Ratios by frequency.
    pub points: Vec<Point>,
}

/// One of the four ratios.
pub type Ratio = fn(&Point) -> f64;

impl Window {
    /// Frequency and value of a ratio over a band of frequencies.
    #[must_use]
    pub fn curve(&self, ratio: Ratio, [from_hz, to_hz]: [f64; 2]) -> Vec<[f64; 2]> {
        let inside = |p: &&Point| (from_hz..=to_hz).contains(&p.frequency_hz);
        self.points.iter().filter(inside).map(|p| [p.frequency_hz, ratio(p)]).collect()
    }

    /// Where a ratio exceeds one (by more than the sampling of the sine costs), in Hz.
    #[must_use]
    pub fn above_one(&self, ratio: Ratio, band_hz: [f64; 2]) -> Vec<[f64; 2]> {
        intervals(&self.curve(ratio, band_hz), |value| value > ABOVE_ONE)
    }

    /// The same as text, in Hz.
    #[must_use]
    pub fn above_one_text(&self, ratio: Ratio, band_hz: [f64; 2]) -> String {
        interval_text(&self.above_one(ratio, band_hz), 2)
    }

    /// Frequency in Hz and value of the largest ratio in a band.
    #[must_use]
    pub fn peak(&self, ratio: Ratio, band_hz: [f64; 2]) -> [f64; 2] {
        highest(&self.curve(ratio, band_hz)).unwrap_or([f64::NAN; 2])
    }

    /// Frequencies about the storey's own resonance and above, in Hz: below 0.75 of its fixed-base
    /// frequency, sub-harmonics amplify by another mechanism.
    #[must_use]
    pub fn near_hz(&self) -> [f64; 2] {
        [0.75 * self.frequency_hz, SCANNED_HZ[1]]
    }

    /// Frequencies below those, in Hz.
    #[must_use]
    pub fn below_hz(&self) -> [f64; 2] {
        [SCANNED_HZ[0], 0.75 * self.frequency_hz]
    }

    /// Motions that do not repeat within the periods allowed.
    pub fn unsettled(&self) -> impl Iterator<Item = &Point> {
        self.points.iter().filter(|p| p.period.is_none())
    }

    /// Motions that repeat only after several periods of the table.
    #[must_use]
    pub fn subharmonic(&self) -> usize {
        self.points.iter().filter(|p| p.period.is_some_and(|n| n > 1)).count()
    }
}

pub(crate) fn run(
    library: &Library,
    grid: Grid,
    engine: &Engine<'_>,
    findings: &mut Vec<Finding>,
) -> Result<Vec<Window>, PaperError> {
    let amplitudes: &[f64] = grid.pick(&[0.1, 0.2, 0.3, 0.5, 1.0, 2.0, 3.0, 5.0], &[0.1, 1.0, 5.0]);
    let each = |experiment| amplitudes.iter().map(move |amplitude| (experiment, *amplitude));
    let pairs: Vec<(&Experiment, f64)> = library.oscillators().flat_map(each).collect();
    let windows = engine.map(pairs.len(), |i| {
        let window = window(pairs[i].0, pairs[i].1, grid);
        engine.done(piece(WINDOWS, i, pairs.len()))?;
        Ok(window)
    })?;
    let windows = windows.into_iter().collect::<Result<Vec<_>, PaperError>>()?;
    findings.extend([generally(&windows), exists(&windows), over_fixed(&windows)]);
    findings.push(weakest(&windows));
    findings.extend(windows.chunk_by(|a, b| a.id == b.id).map(slightly_higher));
    Ok(windows)
}

fn frequencies(free_free_hz: f64, amplitude: f64, friction: f64, grid: Grid) -> Vec<f64> {
    let mut all = logspace(SCANNED_HZ[0], SCANNED_HZ[1], grid.pick(150, 40));
    all.extend(linspace(TESTED_HZ[0], TESTED_HZ[1], grid.pick(121, 25)));
    // Half the width of the window that a square wave of friction excites about f_ff.
    let half = 2.0 * friction / (core::f64::consts::PI * amplitude);
    let near = linspace(-1.5, 1.5, grid.pick(31, 9));
    all.extend(near.iter().map(|x| free_free_hz * (1.0 + x * half)).filter(|f| *f > 0.9));
    all.sort_unstable_by(f64::total_cmp);
    all.dedup_by(|a, b| *a - *b < 1e-9);
    all
}

/// The table of a test from rest.
fn sine(frequency_hz: f64, amplitude_m_per_s2: f64) -> Sine {
    Sine {
        frequency_hz,
        amplitude_m_per_s2,
        duration_s: FROM_REST_S,
        dt_s: 1.0 / (SAMPLES as f64 * frequency_hz),
        phase_rad: 0.0,
        ramp_s: 0.0,
        decay_s: 0.0,
    }
}

fn window(experiment: &Experiment, amplitude: f64, grid: Grid) -> Result<Window, PaperError> {
    let model = &experiment.model;
    let (mass_kg, frequency_hz) = storey(model);
    let free_free_hz = free_free_hz(model);
    let friction = model.kinetic_friction()[0] * model.gravity_m_per_s2();
    let held = fixed(model)?;
    let damping = damping_ratio(model);
    let mut points = Vec::new();
    for table_hz in frequencies(free_free_hz, amplitude, friction, grid) {
        let sine = sine(table_hz, amplitude);
        let motion = sine.motion()?;
        let demands = solver::exact_demands(model, &motion)?.demands;
        let from_rest = storey_peak(&demands);
        let from_rest_held = storey_peak(&solver::exact_demands(&held, &motion)?.demands);
        let settled = steady(model, &sine)?;
        let over_table = settled.peak_m_per_s2() / amplitude;
        points.push(Point {
            frequency_hz: table_hz,
            rest_over_table: from_rest / amplitude,
            rest_over_fixed: from_rest / from_rest_held,
            steady_over_table: over_table,
            steady_over_fixed: over_table / amplification(table_hz / frequency_hz, damping),
            period: settled.period,
            drift_m: settled.drift_m,
            slides: [
                demands.sliding_time_s > 0.0,
                settled.demands.iter().any(|d| d.sliding_time_s > 0.0),
            ],
        });
    }
    let id = experiment.id.clone();
    let amplitude_m_per_s2 = amplitude;
    Ok(Window { id, mass_kg, frequency_hz, free_free_hz, amplitude_m_per_s2, points })
}

/// Share in % of the tests over the tested frequencies for which something holds.
fn share<'a>(windows: impl Iterator<Item = &'a Window>, holds: impl Fn(&Point) -> bool) -> f64 {
    let inside = |p: &&Point| (TESTED_HZ[0]..=TESTED_HZ[1]).contains(&p.frequency_hz);
    let points: Vec<&Point> = windows.flat_map(|w| w.points.iter().filter(inside)).collect();
    100.0 * points.iter().filter(|p| holds(p)).count() as f64 / points.len() as f64
}

fn generally(windows: &[Window]) -> Finding {
    let smaller = |ratio: Ratio| share(windows.iter(), |p| ratio(p) < BELOW_ONE);
    Finding::new("sliding-reduces", smaller(|p| p.rest_over_fixed))
        .quoting("steady", smaller(|p| p.steady_over_fixed))
        .quoting("table", smaller(|p| p.rest_over_table))
}

/// Width in Hz of the window next to the free–free frequency, 0 without one.
fn width(window: &Window) -> f64 {
    let near =
        |i: &&[f64; 2]| i[0] <= 1.02 * window.free_free_hz && i[1] >= 0.98 * window.free_free_hz;
    let all = window.above_one(|p| p.steady_over_table, SCANNED_HZ);
    all.iter().find(near).map_or(0.0, |[from, to]| to - from)
}

fn exists(windows: &[Window]) -> Finding {
    let judged: Vec<&Window> = windows.iter().filter(|w| w.amplitude_m_per_s2 == JUDGED).collect();
    let widths = range(judged.iter().map(|w| width(w) / w.frequency_hz));
    let peaks = range(judged.iter().map(|w| w.peak(|p| p.steady_over_table, w.near_hz())[1]));
    // No window at all is no narrow window either.
    Finding::new("window-over-table", if widths[0] > 0.0 { widths[1] } else { f64::INFINITY })
        .quoting("widths", widths)
        .quoting("peaks", peaks)
}

fn over_fixed(windows: &[Window]) -> Finding {
    let largest = |ratio: Ratio, band_hz: fn(&Window) -> [f64; 2]| {
        let peaks = windows.iter().map(|w| (w, w.peak(ratio, band_hz(w))));
        let (w, [hz, value]) = peaks.reduce(|a, b| if b.1[1] > a.1[1] { b } else { a })?;
        let (kg, storey_hz, table) = (w.mass_kg, w.frequency_hz, w.amplitude_m_per_s2);
        let of = format!("{kg:.0} kg at {storey_hz:.3} Hz, {table} m/s², table at {hz:.2} Hz");
        Some((value, format!("{value:.2} ({of})")))
    };
    let none = || (f64::NAN, String::new());
    let (value, rest) = largest(|p| p.rest_over_fixed, Window::near_hz).unwrap_or_else(none);
    let steady = |band_hz| largest(|p| p.steady_over_fixed, band_hz).unwrap_or_else(none).1;
    Finding::new("window-over-fixed", value)
        .quoting("rest", rest)
        .quoting("steady", steady(Window::near_hz))
        .quoting("below", steady(Window::below_hz))
}

/// Tables of 0.1 m/s² are below μ_s g: only a storey in resonance can start the sliding.
fn weakest(windows: &[Window]) -> Finding {
    let least = windows.iter().map(|w| w.amplitude_m_per_s2).fold(f64::INFINITY, f64::min);
    let weakest = || windows.iter().filter(|w| w.amplitude_m_per_s2 == least);
    Finding::new("sliding-at-0.1", share(weakest(), |p| p.slides[0]))
        .quoting("steady", share(weakest(), |p| p.slides[1]))
}

/// Where one mock-up's peak lies.
fn slightly_higher(of_mock_up: &[Window]) -> Finding {
    let judged = of_mock_up.iter().find(|w| w.amplitude_m_per_s2 == JUDGED);
    let judged = judged.unwrap_or(&of_mock_up[0]);
    let peak_over_f2 =
        |w: &Window| w.peak(|p| p.steady_over_table, w.near_hz())[0] / w.frequency_hz;
    let peak = peak_over_f2(judged);
    let free_free = judged.free_free_hz / judged.frequency_hz;
    let id = format!("window-peak-{:.0}kg-{:.3}Hz", judged.mass_kg, judged.frequency_hz);
    Finding::new(id, peak)
        .quoting("peak_hz", peak * judged.frequency_hz)
        .quoting("free_free_hz", judged.free_free_hz)
        .quoting("free_free", free_free)
        .quoting("moves", range(of_mock_up.iter().map(peak_over_f2)))
        .quoting("above_percent", 100.0 * (free_free - 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::library::with_frequency;
    use slipstick::model::{Block, Damping, Frame, InitialState, Model, Slider};
    use slipstick::slider::Friction;

    /// Peaks and edges that another program found, event by event in 50 digits' company (see
    /// `data/reference/ORIGIN.md`).
    const REFERENCE: &str = include_str!("../../../data/reference/ampwindow.csv");

    fn mock_up(mass_kg: f64, frequency_hz: f64) -> Model {
        let friction = Friction::new(0.020, 0.012).unwrap();
        let slider = Slider::new(friction);
        let frame = Frame {
            masses_kg: vec![mass_kg],
            stiffnesses_n_per_m: vec![1.0],
            damping: Damping::Ratio(0.01),
            heights_m: None,
        };
        let block = Block { mass_kg: 325.0, width_m: None, height_m: None };
        let model = Model::new(block, slider, frame, 9.81, InitialState::rest()).unwrap();
        with_frequency(&model, frequency_hz).unwrap()
    }

    /// Steady peaks at the frequencies of the reference's peaks, to 1.5 %: it prints the frequency to
    /// three decimals, and the sine is sampled 100 times a period.
    #[test]
    fn reference_steady_peaks() {
        let mut compared = 0;
        for line in REFERENCE.lines().skip(1) {
            let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
            let (mass_kg, f2, amplitude) = (cells[0], cells[1], cells[2]);
            let (peak_hz, peak) = (cells[6], cells[7]);
            // Above, where the steady state is one: sub-harmonics and stuck states depend on the
            // transient.
            if !(0.5..=3.0).contains(&amplitude) || peak_hz < 0.75 * f2 {
                continue;
            }
            let found = steady(&mock_up(mass_kg, f2), &sine(peak_hz, amplitude)).unwrap();
            let ratio = found.peak_m_per_s2() / amplitude;
            assert!((ratio / peak - 1.0).abs() < 0.015, "{line}: {ratio}");
            compared += 1;
        }
        assert!(compared >= 45, "{compared}");
    }

    /// A block that cannot slide ends in the closed form of a damped oscillator.
    #[test]
    fn held_block() {
        let held = fixed(&mock_up(45.0, 1.625)).unwrap();
        for table_hz in [0.7, 1.5, 1.9, 4.0] {
            let found = steady(&held, &sine(table_hz, 1.0)).unwrap();
            let exact = amplification(table_hz / 1.625, 0.01);
            assert_eq!(found.period, Some(1));
            assert!((found.peak_m_per_s2() / exact - 1.0).abs() < 1e-3, "{table_hz}");
        }
    }
}
