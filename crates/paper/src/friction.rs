//! Static against kinetic friction, friction that falls with mass, and overturning.

use crate::claims::Finding;
use crate::curves::range;
use crate::library::{Experiment, Library, Shake, storey_peak, with_friction};
use crate::offset::studied;
use crate::sensitivity::{Compared, compared};
use crate::{Grid, PaperError};
use slipstick::motion::Sine;
use slipstick::response::Demands;

/// One test with both coefficients at the kinetic one, as measured, and both at the static one.
#[derive(Clone, Debug, PartialEq)]
pub struct FrictionPair {
    /// What was tested.
    pub name: String,
    /// Static and kinetic coefficient as measured.
    pub measured: [f64; 2],
    /// Peak block and storey acceleration in m/s², peak and residual sliding displacement in mm;
    /// both at `μ_k`, as measured, both at `μ_s`.
    pub figures: [Compared; 3],
    /// Slips, reversals and sticks of the same three.
    pub counts: [[u64; 3]; 3],
}

/// One test of section 6 with its friction lowered.
#[derive(Clone, Debug, PartialEq)]
pub struct LighterFriction {
    /// What was tested.
    pub name: String,
    /// Factors on static and kinetic friction.
    pub factors: [f64; 2],
    /// Changes in %: peak storey acceleration, peak storey displacement, peak sliding displacement.
    pub changes_percent: [f64; 3],
    /// Change of the residual sliding displacement in mm.
    pub residual_mm: f64,
}

/// Overturning ratio of one mock-up: above 1 it would rock.
#[derive(Clone, Debug, PartialEq)]
pub struct Overturning {
    /// What was tested.
    pub name: String,
    /// Whether the mock-up has an oscillator.
    pub has_storey: bool,
    /// Peak table acceleration in m/s² of each run, and the ratio.
    pub ratios: Vec<[f64; 2]>,
    /// The table at which the ratio first reaches 1, between two runs; `None` up to 5 m/s².
    pub lifts_at_m_per_s2: Option<f64>,
}

type Results = (Vec<FrictionPair>, Vec<LighterFriction>, Vec<Overturning>);

pub(crate) fn run(
    library: &Library,
    grid: Grid,
    findings: &mut Vec<Finding>,
) -> Result<Results, PaperError> {
    let mut pairs = Vec::new();
    for experiment in studied(library)? {
        pairs.push(pair(&experiment)?);
    }
    let mut lighter = Vec::new();
    for experiment in library.experiments().iter().filter(|e| e.model.storeys() == 1) {
        for factors in [[0.96, 0.96], [0.96, 0.89], [0.89, 0.89]] {
            lighter.push(lowered(experiment, factors)?);
        }
    }
    let mut overturning = Vec::new();
    for experiment in library.experiments() {
        overturning.extend(overturned(experiment, grid)?);
    }
    findings.extend([novelty(&pairs), other_mass(&lighter)]);
    findings.extend(rocking(&overturning));
    Ok((pairs, lighter, overturning))
}

fn pair(experiment: &Experiment) -> Result<FrictionPair, PaperError> {
    let model = &experiment.model;
    let measured @ [mu_s, mu_k] = [model.static_friction()[0], model.kinetic_friction()[0]];
    let mut figures = [[0.0; 4]; 3];
    let mut counts = [[0; 3]; 3];
    for (i, [mu_s, mu_k]) in [[mu_k, mu_k], measured, [mu_s, mu_s]].into_iter().enumerate() {
        let demands = experiment.with_model(with_friction(model, mu_s, mu_k)?).demands()?;
        figures[i] = compared(&demands);
        counts[i] = [demands.slip_count, demands.reversal_count, demands.stick_count];
    }
    Ok(FrictionPair { name: experiment.name.clone(), measured, figures, counts })
}

fn lowered(experiment: &Experiment, factors: [f64; 2]) -> Result<LighterFriction, PaperError> {
    let model = &experiment.model;
    let [mu_s, mu_k] =
        [factors[0] * model.static_friction()[0], factors[1] * model.kinetic_friction()[0]];
    let before = experiment.demands()?;
    let after = experiment.with_model(with_friction(model, mu_s, mu_k)?).demands()?;
    let percent = |of: &dyn Fn(&Demands) -> f64| 100.0 * (of(&after) / of(&before) - 1.0);
    Ok(LighterFriction {
        name: experiment.name.clone(),
        factors,
        changes_percent: [
            percent(&storey_peak),
            percent(&|d| d.storeys.first().map_or(0.0, |s| s.peak_displacement_m)),
            percent(&|d| d.peak_sliding_displacement_m),
        ],
        residual_mm: 1e3
            * (after.residual_sliding_displacement_m - before.residual_sliding_displacement_m),
    })
}

/// Ratios for a sine over its amplitudes, or for a record over its sizes.
fn overturned(experiment: &Experiment, grid: Grid) -> Result<Option<Overturning>, PaperError> {
    let mut ratios = Vec::new();
    let levels: &[f64] = grid.pick(&[0.1, 0.5, 1.0, 2.0, 3.0, 4.0, 5.0], &[0.1, 1.0, 5.0]);
    for &level in levels {
        let shake = match &experiment.shake {
            Shake::Sine(sine) => Shake::Sine(Sine { amplitude_m_per_s2: level, ..*sine }),
            Shake::Record(record) => Shake::Record(record.scaled_to_peak(level)?),
        };
        let demands = Experiment { shake, ..experiment.clone() }.demands()?;
        if let Some(ratio) = demands.overturning_ratio {
            ratios.push([level, ratio]);
        }
    }
    let name = experiment.name.clone();
    let has_storey = experiment.model.storeys() > 0;
    let lifts = ratios.windows(2).find(|pair| pair[0][1] < 1.0 && pair[1][1] >= 1.0);
    let lifts_at_m_per_s2 = lifts.map(|pair| {
        let [[x0, y0], [x1, y1]] = [pair[0], pair[1]];
        x0 + (x1 - x0) * (1.0 - y0) / (y1 - y0)
    });
    let found = Overturning { name, has_storey, ratios, lifts_at_m_per_s2 };
    Ok((!found.ratios.is_empty()).then_some(found))
}

fn novelty(pairs: &[FrictionPair]) -> Finding {
    let of = |p: &FrictionPair, i: usize, figure: usize| {
        100.0 * (p.figures[i][figure] / p.figures[1][figure] - 1.0)
    };
    let sliding = || pairs.iter().map(|p| of(p, 0, 2).abs().max(of(p, 2, 2).abs()));
    let changed = sliding().filter(|change| *change >= 5.0).count();
    let residuals = |p: &FrictionPair| [0, 2].map(|i| p.figures[i][3] - p.figures[1][3]);
    Finding::new("static-kinetic", 100.0 * changed as f64 / pairs.len() as f64)
        .quoting("changed", changed)
        .quoting("tests", pairs.len())
        .quoting("largest", range(sliding())[1])
        .quoting("accelerations", range(pairs.iter().flat_map(|p| [of(p, 0, 0), of(p, 2, 0)])))
        .quoting("residuals", range(pairs.iter().flat_map(residuals)))
}

fn other_mass(lighter: &[LighterFriction]) -> Finding {
    let of = |i: usize| range(lighter.iter().map(|l| l.changes_percent[i]));
    Finding::unchecked("friction-other-mass")
        .quoting("accelerations", of(0))
        .quoting("displacements", of(1))
        .quoting("sliding", of(2))
        .quoting("residuals", range(lighter.iter().map(|l| l.residual_mm)))
}

/// Largest ratio of some mock-ups: name, table in m/s², ratio.
fn worst<'a>(all: impl Iterator<Item = &'a Overturning>) -> (&'a str, f64, f64) {
    all.flat_map(|o| o.ratios.iter().map(move |r| (o.name.as_str(), r[0], r[1])))
        .reduce(|a, b| if b.2 > a.2 { b } else { a })
        .unwrap_or(("", f64::NAN, f64::NAN))
}

fn rocking(overturning: &[Overturning]) -> [Finding; 2] {
    let blocks = || overturning.iter().filter(|o| !o.has_storey);
    let (name, level, ratio) = worst(blocks());
    let block = Finding::unchecked("no-rocking-block")
        .quoting("ratio", ratio)
        .quoting("name", name)
        .quoting("level", level)
        .quoting("lifts", range(blocks().filter_map(|o| o.lifts_at_m_per_s2))[0]);
    let (name, level, ratio) = worst(overturning.iter().filter(|o| o.has_storey));
    let oscillator =
        Finding::new("no-rocking-oscillator", ratio).quoting("name", name).quoting("level", level);
    [block, oscillator]
}
