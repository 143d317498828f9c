//! Figures of a record: acceleration, velocity, displacement and Arias intensity over time, and the
//! response spectra.

use slipstick::motion::{GroundMotion, Quantity, Spectrum, processing::Step};
use slipstick::units::STANDARD_GRAVITY_M_PER_S2;

use crate::assessment::lines::{over_x, panel, single};
use crate::display::{DisplayUnits, Quantity as Shown, Unit};
use crate::figures::{Drawn, Trace, marked};
use crate::legend::{ACCELERATION, AxisQuantity, DISPLACEMENT, PERIOD, TIME, VELOCITY};
use crate::number::{compact, printed};
use crate::plot::{Axis, Figure, Layout, Panel, PlotSeries, Style};

/// Heights of panels: four of them and a spectrum stand on one printed page.
const HISTORY_HEIGHT: f64 = 92.0;
const HUSID_HEIGHT: f64 = 92.0;
const SPECTRUM_HEIGHT: f64 = 210.0;

/// Figures of one motion; `spectrum` is its response spectrum, drawn as PSa over a logarithmic
/// period.
#[must_use]
pub fn figures(motion: &GroundMotion, spectrum: &Spectrum, display: DisplayUnits) -> Vec<Drawn> {
    let histories = Histories { motion, display }.drawn();
    std::iter::once(histories).chain(spectrum_figures(spectrum, display)).collect()
}

/// PSa and Sd over the period, one line a damping ratio; none where there is nothing to draw.
#[must_use]
pub fn spectrum_figures(spectrum: &Spectrum, display: DisplayUnits) -> Vec<Drawn> {
    let of = |id| spectra(spectrum, display, id);
    ["spectrum-acceleration", "spectrum-displacement"].into_iter().filter_map(of).collect()
}

/// Acceleration, velocity, displacement and the Husid plot on one time axis.
#[derive(Clone, Copy, Debug)]
pub struct Histories<'a> {
    /// The motion.
    pub motion: &'a GroundMotion,
    /// Units of the axes.
    pub display: DisplayUnits,
}

impl Histories<'_> {
    /// All of them as one figure.
    #[must_use]
    pub fn drawn(self) -> Drawn {
        let figures = self.motion.figures();
        let series = self.motion.series();
        let panel = |name: AxisQuantity, quantity: Quantity, peak: f64| {
            // From acceleration to what is drawn nothing can fail but numbers out of range.
            let values = Step::To { quantity }.apply(&series);
            let values = values.map_or_else(|_| Vec::new(), |series| series.values().to_vec());
            let unit = self.display.unit(name.quantity, peak);
            let times = self.motion.times_s().iter();
            let points = times.zip(&values).map(|(t, v)| [*t, unit.of(*v)]).collect();
            self.panel(name, Trace::with_peak(points, unit.of(peak)), unit)
        };
        let panels = vec![
            panel(ACCELERATION, Quantity::Acceleration, figures.pga_m_per_s2),
            panel(VELOCITY, Quantity::Velocity, figures.pgv_m_per_s),
            panel(DISPLACEMENT, Quantity::Displacement, figures.pgd_m),
            self.husid(),
        ];
        let caption =
            "Acceleration, its integrals from rest, and the growth of its Arias intensity; \
                       lines mark 5, 75 and 95 %. Nothing was filtered or corrected for drawing."
                .to_owned();
        let notes = panels.iter().map(|panel| format!(" {}: {}.", panel.y.label, panel.note));
        let description = std::iter::once(caption.clone()).chain(notes).collect();
        let figure = Figure {
            id: "histories".to_owned(),
            title: "Acceleration, velocity, displacement and Arias intensity over time".to_owned(),
            description,
            layout: Layout::Stacked,
            panels,
            shaded: Vec::new(),
        };
        Drawn::new(figure, caption)
    }

    fn panel(&self, quantity: AxisQuantity, trace: Trace, unit: Unit) -> Panel {
        let (peak, note) = marked(&trace, unit, "peak");
        let along = Axis::linear(TIME.alone(Unit::SECOND), 0.0, self.motion.duration_s());
        let upwards = Axis::symmetric(quantity.alone(unit), trace.values());
        let series = vec![over_x("", Style::MAIN, trace.points)];
        Panel { peak, note, ..panel(along, upwards, HISTORY_HEIGHT, series) }
    }

    fn husid(&self) -> Panel {
        let husid = Husid::of(self.motion);
        let total = husid.total_m_per_s;
        let unit = self.display.unit(Shown::Velocity, total);
        let style = Style { width: 0.8, ..Style::DOTTED };
        let limit =
            |percent: f64| crate::plot::Limit { value: percent, label: String::new(), style };
        let along = Axis::linear(TIME.alone(Unit::SECOND), 0.0, self.motion.duration_s());
        let share = Axis::linear("Share of the Arias intensity (%)", 0.0, 100.0);
        let series = vec![over_x("", Style::MAIN, husid.points)];
        Panel {
            limits: [5.0, 75.0, 95.0].map(limit).to_vec(),
            note: format!("in all {} {}", printed(unit.of(total), 4), unit.symbol),
            ..panel(along, share, HUSID_HEIGHT, series)
        }
    }
}

/// The growth of the Arias intensity: the Husid plot.
#[derive(Clone, Debug, PartialEq)]
pub struct Husid {
    /// Time in s and share of the whole in %.
    pub points: Vec<[f64; 2]>,
    /// The whole, the Arias intensity in m/s.
    pub total_m_per_s: f64,
}

impl Husid {
    /// Of a motion, at its samples.
    #[must_use]
    pub fn of(motion: &GroundMotion) -> Self {
        let mut sum = 0.0;
        let mut points = vec![[0.0, 0.0]];
        let pieces = motion.times_s().windows(2).zip(motion.horizontal_m_per_s2().windows(2));
        for (t, a) in pieces {
            sum += (t[1] - t[0]) * (a[0] * a[0] + a[0] * a[1] + a[1] * a[1]) / 3.0;
            points.push([t[1], sum]);
        }
        if sum > 0.0 {
            points.iter_mut().for_each(|point| point[1] *= 100.0 / sum);
        }
        let factor = core::f64::consts::PI / (2.0 * STANDARD_GRAVITY_M_PER_S2);
        Self { points, total_m_per_s: factor * sum }
    }
}

/// Spectra over a logarithmic period, a line for each damping ratio; none without two periods > 0.
fn spectra(spectrum: &Spectrum, display: DisplayUnits, id: &'static str) -> Option<Drawn> {
    let of_displacement = id == "spectrum-displacement";
    let elastic = |t: &&f64| **t > 0.0;
    let first = spectrum.periods_s.iter().filter(elastic).copied().fold(f64::INFINITY, f64::min);
    let last = spectrum.periods_s.iter().copied().fold(0.0, f64::max);
    if !(first < last) {
        return None;
    }
    let ordinate = |o: &slipstick::motion::Ordinates| {
        if of_displacement { o.sd_m } else { o.psa_m_per_s2 }
    };
    let largest = spectrum.ordinates.iter().map(ordinate).fold(0.0, f64::max);
    let shown = if of_displacement { Shown::Length } else { Shown::Acceleration };
    let unit = display.unit(shown, largest);
    let styles = [
        Style { width: 1.3, ..Style::MAIN },
        Style { width: 1.3, ..Style::DASHED },
        Style::DOTTED,
        Style { colour: "#1a1a1a", ..Style::LIMIT },
        Style { width: 1.6, ..Style::WIDE },
    ];
    let series = spectrum.damping_ratios.iter().enumerate().map(|(i, damping)| {
        let points = spectrum.periods_s.iter().zip(spectrum.of_damping(i));
        let mut points: Vec<[f64; 2]> =
            points.filter(|(t, _)| **t > 0.0).map(|(t, o)| [*t, unit.of(ordinate(o))]).collect();
        points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        over_x(format!("damping {} %", compact(100.0 * damping)), styles[i % styles.len()], points)
    });
    let series: Vec<PlotSeries> = series.collect();
    let values: Vec<f64> = series.iter().flat_map(|s| s.points.iter().map(|p| p[1])).collect();
    let (name, caption) = if of_displacement {
        (
            "Displacement Sd",
            "Displacement response spectrum: largest displacement of an oscillator \
                             relative to the ground, over its period.",
        )
    } else {
        (
            "Pseudo-acceleration PSa",
            "Acceleration response spectrum: ω² times the largest \
                                     displacement of an oscillator, over its period.",
        )
    };
    let panel = panel(
        Axis::logarithmic(PERIOD.alone(Unit::SECOND), first, last),
        Axis::from_zero(unit.label(name), values),
        SPECTRUM_HEIGHT,
        series,
    );
    Some(single(id, name, caption.to_owned(), panel))
}
