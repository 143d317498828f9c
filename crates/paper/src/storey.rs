//! Storey displacement against the amplitude of the table: figures 9d and 10d.

use crate::curves::{at_amplitudes, crossing, highest, intervals, linspace};
use crate::library::{Experiment, Library, Shake, with_friction};
use crate::{Claim, Grid, PaperError, Verdict};
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
) -> Result<(Vec<DisplacementCurve>, Vec<Claim>), PaperError> {
    let amplitudes = linspace(AMPLITUDES[0], AMPLITUDES[1], grid.pick(491, 99));
    let mut curves = Vec::new();
    for (figure, id, paper_mm) in
        [(9, "section6-45kg-1_625hz-sine", 6.5), (10, "section6-201kg-1_125hz-sine", 11.0)]
    {
        let experiment = library.experiment(id)?;
        curves.push(DisplacementCurve {
            figure,
            name: experiment.name.clone(),
            paper_mm,
            points: curve(experiment, &amplitudes, 0.0)?,
            from_peak: curve(experiment, &amplitudes, core::f64::consts::FRAC_PI_2)?,
        });
    }
    let claims = vec![
        claim(library, &curves[0], ("storey-6.5", 0.05), "section6-45kg-1_625hz-sine")?,
        claim(library, &curves[1], ("storey-11", 0.5), "section6-201kg-1_125hz-sine")?,
        larger(&curves),
    ];
    Ok((curves, claims))
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

fn claim(
    library: &Library,
    curve: &DisplacementCurve,
    (id, half_unit): (&str, f64),
    experiment: &str,
) -> Result<Claim, PaperError> {
    let paper = curve.paper_mm;
    let off = |p: &[f64; 2]| (p[1] - paper).abs();
    let nearest = curve
        .points
        .iter()
        .copied()
        .reduce(|a, b| if off(&b) < off(&a) { b } else { a })
        .unwrap_or([f64::NAN; 2]);
    let inside = intervals(&curve.points, |mm| (mm - paper).abs() <= half_unit);
    let top = highest(&curve.points).unwrap_or([f64::NAN; 2]);
    let from_peak = intervals(&curve.from_peak, |mm| (mm - paper).abs() <= half_unit);
    let top_from_peak = highest(&curve.from_peak).unwrap_or([f64::NAN; 2]);
    let causes = if inside.is_empty() {
        needed(library.experiment(experiment)?, paper)?
    } else {
        String::new()
    };
    let text = format!(
        "The storey moves {paper} mm at most relative to the block (figure {}d; amplitude of the \
         table not stated)",
        curve.figure
    );
    Ok(Claim::printed(
        (id, "7.1", &text),
        [paper, half_unit],
        (nearest[1], "mm"),
        |verdict, difference| {
            let range = format!(
                "Amplitudes from 0.1 to 5 m/s² in 20 s from rest give {:.2} mm at most, at {:.2} \
                 m/s²",
                top[1], top[0]
            );
            let start = format!(
                "A sine that starts at its peak gives the printed value {} ({:.2} mm at most, at \
                 {:.2} m/s²)",
                at_amplitudes(&from_peak),
                top_from_peak[1],
                top_from_peak[0],
            );
            match verdict {
                Verdict::Agrees => {
                    format!("{range}; the printed value {}. {start}.", at_amplitudes(&inside))
                }
                _ => format!(
                    "{range}: {difference:+.2} mm. {start}. The printed value follows from {causes}."
                ),
            }
        },
    ))
}

/// One stated value changed so that the largest peak over all amplitudes is the printed one.
fn needed(experiment: &Experiment, paper_mm: f64) -> Result<String, PaperError> {
    // The largest peak lies where sliding sets in fully: few amplitudes find it.
    let amplitudes = linspace(0.5, 1.5, 11);
    let largest = |experiment: &Experiment| -> Result<f64, PaperError> {
        Ok(highest(&curve(experiment, &amplitudes, 0.0)?).map_or(f64::NAN, |point| point[1]))
    };
    let sine = experiment.sine()?;
    let [mu_s, mu_k] =
        [experiment.model.static_friction()[0], experiment.model.kinetic_friction()[0]];
    let factor = crossing([1.0, 2.0], |factor| {
        let model = with_friction(&experiment.model, mu_s * factor, mu_k * factor)?;
        Ok::<_, PaperError>(largest(&experiment.with_model(model))? - paper_mm)
    })?;
    let kinetic = crossing([mu_k, mu_s], |kinetic| {
        let model = with_friction(&experiment.model, mu_s, kinetic)?;
        Ok::<_, PaperError>(largest(&experiment.with_model(model))? - paper_mm)
    })?;
    let mut causes = Vec::new();
    if let Some(factor) = factor {
        causes
            .push(format!("both coefficients of friction {:.1} % higher", 100.0 * (factor - 1.0)));
    }
    if let Some(kinetic) = kinetic {
        causes.push(format!("a kinetic friction of {kinetic:.4} for {mu_k}"));
    }
    for (low, high) in [(0.9, 1.0), (1.0, 1.1)] {
        let frequency = crossing([low, high], |ratio| {
            let shake = Shake::Sine(Sine { frequency_hz: ratio * sine.frequency_hz, ..sine });
            Ok::<_, PaperError>(largest(&Experiment { shake, ..experiment.clone() })? - paper_mm)
        })?;
        if let Some(ratio) = frequency {
            causes.push(format!("a table frequency of {:.3} Hz", ratio * sine.frequency_hz));
        }
    }
    let implied = Sine { frequency_hz: IMPLIED_HZ, ..sine };
    let implied = Experiment { shake: Shake::Sine(implied), ..experiment.clone() };
    let at_implied = largest(&implied)?;
    if causes.is_empty() {
        return Ok("no single change of friction or of frequency within 10 %".to_owned());
    }
    Ok(format!(
        "{}; the {IMPLIED_HZ} Hz that the printed amplification implies give {at_implied:.2} mm",
        causes.join(", or from ")
    ))
}

/// "Larger than in the previous test", for equal amplitudes.
fn larger(curves: &[DisplacementCurve]) -> Claim {
    let ratios: Vec<[f64; 2]> =
        curves[0].points.iter().zip(&curves[1].points).map(|(a, b)| [a[0], b[1] / a[1]]).collect();
    let least = ratios
        .iter()
        .copied()
        .reduce(|a, b| if b[1] < a[1] { b } else { a })
        .unwrap_or([f64::NAN; 2]);
    Claim::banded(
        (
            "storey-larger",
            "7.1",
            "The storey of 201 kg at 1.125 Hz moves further than that of 45 kg at 1.625 Hz",
        ),
        Some(11.0 / 6.5),
        (least[1], ""),
        ([1.0, f64::INFINITY], "the ratio of the peaks is above 1 at every equal amplitude"),
        |_| {
            format!(
                "The ratio is least, {:.2}, at {:.2} m/s²; the printed peaks have {:.2}.",
                least[1],
                least[0],
                11.0 / 6.5
            )
        },
    )
}
