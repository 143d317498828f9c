//! Why accelerations agree and displacements do not: what small unknowns change.

use crate::claims::Finding;
use crate::curves::range;
use crate::library::{Experiment, Library, storey_peak, with_asymmetry, with_friction, with_tilt};
use crate::offset::{disturbed, spring_kn_per_m, studied};
use crate::{Grid, PaperError};
use slipstick::response::Demands;
use slipstick::solver;

/// Standard deviation of sensor noise in m/s².
pub const NOISE_M_PER_S2: f64 = 0.02;

/// Figures of a response that tests compare: peak block and storey acceleration in m/s², peak and
/// residual sliding displacement in mm.
pub type Compared = [f64; 4];

/// What 1 % more friction, 1 mrad, 1 % asymmetry and sensor noise change in one test.
#[derive(Clone, Debug, PartialEq)]
pub struct SensitivityRow {
    /// What was tested.
    pub name: String,
    /// Stiffness of the spring in kN/m, 0 without.
    pub spring_kn_per_m: f64,
    /// The figures as they are; no storey gives 0.
    pub base: Compared,
    /// Changes of the accelerations in % of each, of the displacements in mm; by friction, tilt,
    /// asymmetry, noise (root of the mean square over seeds).
    pub changes: [Compared; 4],
}

impl SensitivityRow {
    /// Largest change of an acceleration in % of it.
    #[must_use]
    pub fn acceleration_percent(&self) -> f64 {
        self.changes.iter().flat_map(|c| [c[0].abs(), c[1].abs()]).fold(0.0, f64::max)
    }

    /// Largest change of the residual in % of the peak sliding displacement.
    #[must_use]
    pub fn residual_percent(&self) -> f64 {
        let largest = self.changes.iter().map(|c| c[3].abs()).fold(0.0, f64::max);
        100.0 * largest / self.base[2]
    }
}

pub(crate) fn compared(d: &Demands) -> Compared {
    [
        d.peak_block_acceleration_m_per_s2,
        storey_peak(d),
        1e3 * d.peak_sliding_displacement_m,
        1e3 * d.residual_sliding_displacement_m,
    ]
}

/// Accelerations in % of the base, displacements in mm.
fn change(base: &Compared, other: &Compared) -> Compared {
    let percent = |i: usize| if base[i] == 0.0 { 0.0 } else { 100.0 * (other[i] / base[i] - 1.0) };
    [percent(0), percent(1), other[2] - base[2], other[3] - base[3]]
}

pub(crate) fn run(
    library: &Library,
    grid: Grid,
    findings: &mut Vec<Finding>,
) -> Result<Vec<SensitivityRow>, PaperError> {
    let seeds = grid.pick(20, 5);
    let mut rows = Vec::new();
    for experiment in studied(library)? {
        rows.push(row(&experiment, seeds)?);
    }
    let measured = Finding::unchecked("measured-agreement");
    findings.extend([accelerations(&rows), measured, design(&rows)]);
    Ok(rows)
}

fn row(experiment: &Experiment, seeds: u64) -> Result<SensitivityRow, PaperError> {
    let base = compared(&experiment.demands()?);
    let model = &experiment.model;
    let [mu_s, mu_k] = [model.static_friction()[0], model.kinetic_friction()[0]];
    let mut changes = [[0.0; 4]; 4];
    for (i, varied) in [
        with_friction(model, 1.01 * mu_s, 1.01 * mu_k)?,
        with_tilt(model, 1e-3)?,
        with_asymmetry(model, 0.01)?,
    ]
    .into_iter()
    .enumerate()
    {
        changes[i] = change(&base, &compared(&experiment.with_model(varied).demands()?));
    }
    for seed in 1..=seeds {
        let motion = disturbed(experiment, NOISE_M_PER_S2, 0.0, seed)?;
        let noisy = compared(&solver::exact_demands(model, &motion)?.demands);
        for (sum, c) in changes[3].iter_mut().zip(change(&base, &noisy)) {
            *sum += c * c;
        }
    }
    changes[3] = changes[3].map(|sum| (sum / seeds as f64).sqrt());
    let name = experiment.name.clone();
    Ok(SensitivityRow { name, spring_kn_per_m: spring_kn_per_m(experiment), base, changes })
}

fn accelerations(rows: &[SensitivityRow]) -> Finding {
    let free = || rows.iter().filter(|r| r.spring_kn_per_m == 0.0);
    let strong = rows.iter().filter(|r| r.spring_kn_per_m > 100.0);
    let ratio = |r: &SensitivityRow| r.residual_percent() / r.acceleration_percent();
    Finding::new("accelerations-agree", range(free().map(ratio))[0])
        .quoting("accelerations", range(free().map(SensitivityRow::acceleration_percent)))
        .quoting("residuals", range(free().map(SensitivityRow::residual_percent)))
        .quoting("sprung", range(strong.map(SensitivityRow::residual_percent)))
}

fn design(rows: &[SensitivityRow]) -> Finding {
    let peak = |r: &SensitivityRow| {
        100.0 * r.changes.iter().map(|c| c[2].abs()).fold(0.0, f64::max) / r.base[2]
    };
    let free = range(rows.iter().filter(|r| r.spring_kn_per_m == 0.0).map(peak));
    Finding::unchecked("preliminary-design")
        .quoting("free_least", free[0])
        .quoting("free_largest", free[1])
        .quoting("sprung", range(rows.iter().filter(|r| r.spring_kn_per_m > 0.0).map(peak)))
}
