//! Storey displacement against the amplitude of the table: figures 9d and 10d.

use crate::claims::Finding;
use crate::curves::{at_amplitudes, crossing, highest, intervals, linspace};
use crate::library::{Experiment, Library, Shake, with_friction};
use crate::{Grid, PaperError};
use slipstick::motion::Sine;

/// Amplitudes of section 6 in m/s².
pub(crate) const AMPLITUDES: [f64; 2] = [0.1, 5.0];

/// The frequency in Hz that the printed amplification of 4.22 implies for the table of figure 10.
const IMPLIED_HZ: f64 = 0.983;

/// Peak storey displacement from rest against the amplitude of the table.
#[derive(Clone, Debug, PartialEq)]
pub struct DisplacementCurve {
    /// The paper's figure.
    pub figure: u32,
    /// What was tested.
    pub name: String,
    /// The peak that the paper prints, in mm.
    pub paper_mm: f64,
    /// Amplitude in m/s², and peak in mm for a sine that starts at phase 0.
    pub points: Vec<[f64; 2]>,
    /// The same for a sine that starts at its peak.
    pub from_peak: Vec<[f64; 2]>,
}

pub(crate) fn run(
    library: &Library,
    grid: Grid,
    findings: &mut Vec<Finding>,
) -> Result<Vec<DisplacementCurve>, PaperError> {
    let amplitudes = linspace(AMPLITUDES[0], AMPLITUDES[1], grid.pick(491, 99));
    let mut curves = Vec::new();
    for (figure, id, test) in [
        (9, "storey-6.5", "section6-45kg-1_625hz-sine"),
        (10, "storey-11", "section6-201kg-1_125hz-sine"),
    ] {
        let experiment = library.experiment(test)?;
        let curve = DisplacementCurve {
            figure,
            name: experiment.name.clone(),
            paper_mm: library.printed(id)?,
            points: curve(experiment, &amplitudes, 0.0)?,
            from_peak: curve(experiment, &amplitudes, core::f64::consts::FRAC_PI_2)?,
        };
        findings.push(printed(library, id, experiment, &curve)?);
        curves.push(curve);
    }
    findings.push(larger(&curves));
    Ok(curves)
}

fn curve(
    experiment: &Experiment,
    amplitudes: &[f64],
    phase_rad: f64,
) -> Result<Vec<[f64; 2]>, PaperError> {
    let sine = experiment.sine()?;
    let mut points = Vec::with_capacity(amplitudes.len());
    for &amplitude_m_per_s2 in amplitudes {
        let shake = Shake::Sine(Sine { amplitude_m_per_s2, phase_rad, ..sine });
        let demands = Experiment { shake, ..experiment.clone() }.demands()?;
        let peak_m = demands.storeys.first().map_or(0.0, |storey| storey.peak_displacement_m);
        points.push([amplitude_m_per_s2, 1e3 * peak_m]);
    }
    Ok(points)
}

/// The printed peak, over all amplitudes.
fn printed(
    library: &Library,
    id: &str,
    experiment: &Experiment,
    curve: &DisplacementCurve,
) -> Result<Finding, PaperError> {
    let paper_mm = curve.paper_mm;
    let within_mm = library.claim(id)?.within.unwrap_or(0.0);
    let off = |p: &[f64; 2]| (p[1] - paper_mm).abs();
    let none = [f64::NAN; 2];
    let nearest = curve.points.iter().copied();
    let nearest = nearest.reduce(|a, b| if off(&b) < off(&a) { b } else { a }).unwrap_or(none);
    let printed = |points: &[[f64; 2]]| intervals(points, |mm| (mm - paper_mm).abs() <= within_mm);
    let [largest, from_peak_largest] =
        [&curve.points, &curve.from_peak].map(|points| highest(points).unwrap_or(none));
    let finding = Finding::new(id, nearest[1])
        .quoting("largest", largest[1])
        .quoting("largest_at", largest[0])
        .quoting("from_peak", at_amplitudes(&printed(&curve.from_peak)))
        .quoting("from_peak_largest", from_peak_largest[1])
        .quoting("from_peak_largest_at", from_peak_largest[0]);
    let printed = printed(&curve.points);
    if printed.is_empty() {
        return needed(finding, experiment, paper_mm);
    }
    Ok(finding.quoting("printed_at", at_amplitudes(&printed)))
}

/// One stated value changed so that the largest peak over all amplitudes is the printed one.
fn needed(finding: Finding, experiment: &Experiment, paper_mm: f64) -> Result<Finding, PaperError> {
    // The largest peak lies where sliding sets in fully: few amplitudes find it.
    let amplitudes = linspace(0.5, 1.5, 11);
    let largest = |experiment: &Experiment| -> Result<f64, PaperError> {
        Ok(highest(&curve(experiment, &amplitudes, 0.0)?).map_or(f64::NAN, |point| point[1]))
    };
    let sine = experiment.sine()?;
    let [mu_s, mu_k] =
        [experiment.model.static_friction()[0], experiment.model.kinetic_friction()[0]];
    let with_friction = |mu_s: f64, mu_k: f64| -> Result<f64, PaperError> {
        let model = with_friction(&experiment.model, mu_s, mu_k)?;
        Ok(largest(&experiment.with_model(model))? - paper_mm)
    };
    let at = |frequency_hz: f64| -> Result<f64, PaperError> {
        let shake = Shake::Sine(Sine { frequency_hz, ..sine });
        largest(&Experiment { shake, ..experiment.clone() })
    };
    let factor = crossing([1.0, 2.0], |factor| with_friction(mu_s * factor, mu_k * factor))?;
    let kinetic = crossing([mu_k, mu_s], |kinetic| with_friction(mu_s, kinetic))?;
    let slower = crossing([0.9, 1.0], |ratio| {
        Ok::<_, PaperError>(at(ratio * sine.frequency_hz)? - paper_mm)
    })?;
    Ok(finding
        .quoting("friction_percent", factor.map_or(f64::NAN, |factor| 100.0 * (factor - 1.0)))
        .quoting("kinetic", kinetic.unwrap_or(f64::NAN))
        .quoting("kinetic_stated", mu_k)
        .quoting("table_hz", slower.map_or(f64::NAN, |ratio| ratio * sine.frequency_hz))
        .quoting("implied_hz", IMPLIED_HZ)
        .quoting("implied", at(IMPLIED_HZ)?))
}

/// "Larger than in the previous test", for equal amplitudes.
fn larger(curves: &[DisplacementCurve]) -> Finding {
    let ratios = curves[0].points.iter().zip(&curves[1].points).map(|(a, b)| [a[0], b[1] / a[1]]);
    let least = ratios.reduce(|a, b| if b[1] < a[1] { b } else { a }).unwrap_or([f64::NAN; 2]);
    Finding::new("storey-larger", least[1]).quoting("amplitude", least[0])
}
