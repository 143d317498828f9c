//! Sliding displacement over records, and spectra of sliding structures for El Centro 1940.

use crate::curves::logspace;
use crate::library::{Library, storey_peak};
use crate::{Grid, PaperError};
use slipstick::model::{Block, Damping, Frame, InitialState, Model, Slider};
use slipstick::motion::GroundMotion;
use slipstick::slider::Friction;
use slipstick::solver;
use slipstick::units::STANDARD_GRAVITY_M_PER_S2;

/// The record of the spectra, among those of the library.
const EL_CENTRO: &str = "el-centro-180.txt";

/// Peak to which the records are scaled, in m/s².
pub const SUITE_PEAK_M_PER_S2: f64 = 0.3 * STANDARD_GRAVITY_M_PER_S2;

/// Damping ratio of the structure of the spectra.
const DAMPING: f64 = 0.05;

/// Coefficients of friction of the spectra.
pub const SPECTRUM_FRICTIONS: [f64; 4] = [0.05, 0.10, 0.15, 0.20];

/// Mass ratios `M2/(M1 + M2)` of the spectra.
pub const SPECTRUM_MASS_RATIOS: [f64; 3] = [0.25, 0.50, 0.75];

/// A rigid block on one record at one coefficient of friction, equal in stick and slip.
#[derive(Clone, Debug, PartialEq)]
pub struct SuiteRow {
    /// Name of the record.
    pub record: String,
    /// Coefficient of friction.
    pub friction: f64,
    /// The coefficient over the peak table acceleration in g.
    pub friction_over_pga: f64,
    /// Peak sliding displacement in m.
    pub peak_m: f64,
    /// Residual sliding displacement in m.
    pub residual_m: f64,
}

/// Spectrum of a one-storey structure on a sliding block.
#[derive(Clone, Debug, PartialEq)]
pub struct SlidingSpectrum {
    /// `M2/(M1 + M2)`.
    pub mass_ratio: f64,
    /// Coefficient of friction; infinite for the fixed base.
    pub friction: f64,
    /// Fixed-base period in s, peak total acceleration of the storey over the PGA, peak sliding
    /// displacement in m.
    pub points: Vec<[f64; 3]>,
}

type Results = (Vec<SuiteRow>, Vec<SlidingSpectrum>);

pub(crate) fn run(library: &Library, grid: Grid) -> Result<Results, PaperError> {
    let mut rows = Vec::new();
    for (name, motion) in library.records() {
        rows.extend(over_friction(name, motion)?);
    }
    let spectra = spectra(library.record(EL_CENTRO)?, grid)?;
    Ok((rows, spectra))
}

/// Rows of one record scaled to [`SUITE_PEAK_M_PER_S2`], friction from 0.05 to 0.95 of it.
///
/// # Errors
/// [`PaperError`] for a record that cannot be scaled, or a failed analysis.
pub fn over_friction(name: &str, motion: &GroundMotion) -> Result<Vec<SuiteRow>, PaperError> {
    let motion = motion.scaled_to_peak(SUITE_PEAK_M_PER_S2)?.with_tail(2.0)?;
    let mut rows = Vec::new();
    for ratio in [0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9] {
        let friction = ratio * SUITE_PEAK_M_PER_S2 / STANDARD_GRAVITY_M_PER_S2;
        let law = Friction::new(friction, friction)?;
        // Without a spring the mass is of no account.
        let model = Model::rigid_block(1.0, law)?;
        let demands = solver::exact_demands(&model, &motion)?.demands;
        rows.push(SuiteRow {
            record: name.to_owned(),
            friction,
            friction_over_pga: ratio,
            peak_m: demands.peak_sliding_displacement_m,
            residual_m: demands.residual_sliding_displacement_m,
        });
    }
    Ok(rows)
}

fn spectra(motion: &GroundMotion, grid: Grid) -> Result<Vec<SlidingSpectrum>, PaperError> {
    let pga = motion.figures().pga_m_per_s2;
    let periods_s = logspace(0.05, 4.0, grid.pick(80, 12));
    let mut all = Vec::new();
    for mass_ratio in SPECTRUM_MASS_RATIOS {
        for friction in SPECTRUM_FRICTIONS.into_iter().chain([f64::INFINITY]) {
            let mut points = Vec::new();
            for &period_s in &periods_s {
                let model = structure(mass_ratio, friction, period_s)?;
                let demands = solver::exact_demands(&model, motion)?.demands;
                let peak = storey_peak(&demands);
                points.push([period_s, peak / pga, demands.peak_sliding_displacement_m]);
            }
            all.push(SlidingSpectrum { mass_ratio, friction, points });
        }
    }
    Ok(all)
}

fn structure(mass_ratio: f64, friction: f64, period_s: f64) -> Result<Model, PaperError> {
    // Any friction far above the demand holds the block.
    let friction = if friction.is_finite() { friction } else { 1e3 };
    let rate = core::f64::consts::TAU / period_s;
    let slider = Slider::new(Friction::new(friction, friction)?);
    let frame = Frame {
        masses_kg: vec![mass_ratio],
        stiffnesses_n_per_m: vec![mass_ratio * rate * rate],
        damping: Damping::Ratio(DAMPING),
        heights_m: None,
    };
    let block = Block { mass_kg: 1.0 - mass_ratio, width_m: None, height_m: None };
    Ok(Model::new(block, slider, frame, STANDARD_GRAVITY_M_PER_S2, InitialState::rest())?)
}
