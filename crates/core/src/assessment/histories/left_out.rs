//! What running the components of a pair by themselves leaves out, where a model cannot be run under both at once:
//! by how much a rigid block on one pendulum of the same stiffness and friction goes farther under both.

use super::{ModelHistories, ModelOn};
use crate::check::check;
use crate::model::Model;
use crate::motion::GroundMotion;
use crate::numerics::fractile::{fractile, sorted};
use crate::solver::exact;

/// How far a rigid block on one surface slides under both components of pairs at once, over the larger of what it does
/// under each by itself.
#[derive(Clone, Debug, PartialEq)]
pub struct LeftOut {
    /// The block on its surface.
    pub simple: Model,
    /// The ratios in order, one a pair that was certified and slides.
    pub ratios: Vec<f64>,
}

impl LeftOut {
    /// The median, the least and the largest ratio.
    #[must_use]
    pub fn spread(&self) -> [f64; 3] {
        [0.5, 0.0, 1.0].map(|p| fractile(&self.ratios, p))
    }
}

/// Of a model that two directions do not take, on pairs whose components are run by themselves; none of other models,
/// and where no pair says anything.
pub(super) fn of(model: &ModelOn<'_>, histories: &ModelHistories) -> Option<LeftOut> {
    let simple = model.analysis.model.simple_in_plane()?;
    let mut ratios = Vec::new();
    let mut first = 0;
    for records in histories.earthquakes() {
        let of = |i: usize| model.suite.motion(first + i, records[i].scale, 0.0).ok();
        if let [Some(x), Some(y)] = [0, 1].map(|i| (i < records.len()).then(|| of(i)).flatten()) {
            ratios.extend(ratio(&simple, &x, &y));
        }
        first += records.len();
    }
    let ratios = sorted(&ratios);
    (!ratios.is_empty()).then_some(LeftOut { simple, ratios })
}

/// Of one pair; none of a block that does not slide under one of both alone, or whose answer is not certified.
fn ratio(model: &Model, x: &GroundMotion, y: &GroundMotion) -> Option<f64> {
    let (both, _) = x.with_along_y(y).ok()?;
    let peak = |motion: &GroundMotion| {
        let response = exact(model, motion).ok()?;
        let holds = check(model, motion, &response).holds();
        holds.then_some(response.demands.peak_sliding_displacement_m)
    };
    let (alone, together) = (peak(x)?.max(peak(y)?), peak(&both)?);
    (alone > 0.0).then(|| together / alone)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::input::parse;

    const TEXT: &str = "[block]\nmass = \"1 t\"\n[slider]\nstatic_friction = 0.05\n\
                        kinetic_friction = 0.04\nradius = \"2 m\"\n";

    /// Two components of one wave are one along the diagonal, √2 as strong.
    #[test]
    fn equal_components_are_one_that_is_longer() {
        let model = parse("m.toml", TEXT, &[]).unwrap().model;
        let wave = |size: f64| {
            let of = |i: usize| size * libm::sin(0.05 * i as f64) * libm::sin(0.003 * i as f64);
            GroundMotion::evenly_spaced(0.01, (0..1000).map(of).collect(), None).unwrap()
        };
        let found = ratio(&model, &wave(2.0), &wave(2.0)).unwrap();
        let peak =
            |size: f64| exact(&model, &wave(size)).unwrap().demands.peak_sliding_displacement_m;
        let expected = peak(2.0 * core::f64::consts::SQRT_2) / peak(2.0);
        assert!((found - expected).abs() <= 1e-11 * expected && found > 1.4, "{found} {expected}");
        // What stands still says nothing.
        assert_eq!(ratio(&model, &wave(0.1), &wave(0.1)), None);
    }
}
