//! No amplification near resonance while sliding is free: figures 9, 10 and 11.

use crate::claims::Finding;
use crate::curves::{at_amplitudes, highest, intervals, linspace};
use crate::library::{Experiment, Library, Shake, storey_peak};
use crate::storey::AMPLITUDES;
use crate::{Grid, PaperError};
use slipstick::motion::Sine;

/// The largest ratio that is no noticeable amplification.
const NOTICEABLE: f64 = 1.1;

/// The least share of the time in which a freely sliding block slides.
const FREE: f64 = 0.5;

/// Accelerations over that of the table against its amplitude, from rest.
#[derive(Clone, Debug, PartialEq)]
pub struct FreeSliding {
    /// The paper's figure.
    pub figure: u32,
    /// What was tested.
    pub name: String,
    /// Amplitude in m/s², and peak block acceleration over it.
    pub block: Vec<[f64; 2]>,
    /// Amplitude in m/s², and peak storey acceleration over it.
    pub storey: Vec<[f64; 2]>,
    /// Amplitude in m/s², and share of the time in which the block slides.
    pub sliding: Vec<[f64; 2]>,
}

pub(crate) fn run(
    library: &Library,
    grid: Grid,
    findings: &mut Vec<Finding>,
) -> Result<Vec<FreeSliding>, PaperError> {
    let amplitudes = linspace(AMPLITUDES[0], AMPLITUDES[1], grid.pick(246, 50));
    let mut all = Vec::new();
    for (figure, id) in [
        (9, "section6-45kg-1_625hz-sine"),
        (10, "section6-201kg-1_125hz-sine"),
        (11, "section6-201kg-2_65hz-sine"),
    ] {
        let test = scan(figure, &library.drawn(id)?, &amplitudes)?;
        findings.push(found(&test, "block", &test.block));
        findings.push(found(&test, "storey", &test.storey));
        all.push(test);
    }
    Ok(all)
}

fn scan(
    figure: u32,
    experiment: &Experiment,
    amplitudes: &[f64],
) -> Result<FreeSliding, PaperError> {
    let sine = experiment.sine()?;
    let mut test = FreeSliding {
        figure,
        name: experiment.name.clone(),
        block: Vec::new(),
        storey: Vec::new(),
        sliding: Vec::new(),
    };
    for &amplitude_m_per_s2 in amplitudes {
        let shake = Shake::Sine(Sine { amplitude_m_per_s2, ..sine });
        let demands = Experiment { shake, tail_s: 0.0, ..experiment.clone() }.demands()?;
        let over = |value: f64| [amplitude_m_per_s2, value / amplitude_m_per_s2];
        test.block.push(over(demands.peak_block_acceleration_m_per_s2));
        test.storey.push(over(storey_peak(&demands)));
        test.sliding.push([amplitude_m_per_s2, demands.sliding_time_s / sine.duration_s]);
    }
    Ok(test)
}

/// Over the stated range of amplitudes, as the test's own is not stated.
fn found(test: &FreeSliding, part: &str, ratios: &[[f64; 2]]) -> Finding {
    let largest = highest(ratios).unwrap_or([f64::NAN; 2]);
    let below = ratios.iter().filter(|point| point[1] <= NOTICEABLE).count();
    let share = 100.0 * below as f64 / ratios.len() as f64;
    Finding::new(format!("fig{}-{part}", test.figure), share)
        .quoting("above", at_amplitudes(&intervals(ratios, |ratio| ratio > NOTICEABLE)))
        .quoting("largest", largest[1])
        .quoting("largest_at", largest[0])
        .quoting("last", ratios.last().map_or(f64::NAN, |point| point[1]))
        .quoting("free", test.sliding.iter().find(|s| s[1] >= FREE).map_or(f64::NAN, |s| s[0]))
}
