//! What running the components of a pair by themselves leaves out, where a model cannot be run under both at once:
//! by how much a rigid block on one pendulum of the same stiffness and friction goes farther under both.

use super::{ModelHistories, ModelOn};
use crate::check::check;
use crate::model::{Block, Frame, InitialState, Model, Slider};
use crate::motion::GroundMotion;
use crate::numerics::fractile::{fractile, sorted};
use crate::solver::exact;
use crate::units::STANDARD_GRAVITY_M_PER_S2;

/// How far a rigid block on one pendulum slides under both components of pairs at once, over the larger of what it
/// does under each by itself.
#[derive(Clone, Debug, PartialEq)]
pub struct LeftOut {
    /// The pendulum: its radius in m, or none of what is flat, and its kinetic coefficient of friction at rest.
    pub radius_m: Option<f64>,
    /// See [`radius_m`](Self::radius_m).
    pub friction: f64,
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

/// Of a model with surfaces in series or contents on pairs whose components are run by themselves; none of other models,
/// and where no pair says anything.
pub(super) fn of(model: &ModelOn<'_>, histories: &ModelHistories) -> Option<LeftOut> {
    let own = &model.analysis.model;
    if own.slider().series().is_none() && own.contents().is_empty() {
        return None;
    }
    let slider = own.slider().as_one_surface()?;
    let (radius_m, friction) = (slider.radius_m(), slider.friction()?.clone());
    let rigid = rigid(slider, own.total_mass_kg())?;
    let mut ratios = Vec::new();
    let mut first = 0;
    for records in histories.earthquakes() {
        let of = |i: usize| model.suite.motion(first + i, records[i].scale, 0.0).ok();
        if let [Some(x), Some(y)] = [0, 1].map(|i| (i < records.len()).then(|| of(i)).flatten()) {
            ratios.extend(ratio(&rigid, &x, &y));
        }
        first += records.len();
    }
    let ratios = sorted(&ratios);
    let friction = friction.kinetic_coefficient(crate::slider::Direction::Positive);
    (!ratios.is_empty()).then_some(LeftOut { radius_m, friction, ratios })
}

fn rigid(slider: Slider, mass_kg: f64) -> Option<Model> {
    let block = Block { mass_kg, width_m: None, height_m: None };
    let (frame, start) = (Frame::none(), InitialState::rest());
    Model::new(block, slider, frame, STANDARD_GRAVITY_M_PER_S2, start).ok()
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
    use crate::slider::{Friction, Surface, SurfacesInSeries};

    /// `φ = (s + Σ μ R)/Σ R` where all slide, and the friction of a flat surface where there is one.
    #[test]
    fn surfaces_that_all_slide_are_one() {
        let surface = |radius_m, friction| Surface { radius_m, friction, travel_m: Some(0.1) };
        let one = |surfaces| {
            let series = SurfacesInSeries::new(surfaces, 1.5).unwrap();
            Slider::in_series(series).as_one_surface().unwrap()
        };
        let pendulum = one(vec![surface(Some(1.0), 0.03), surface(Some(3.0), 0.06)]);
        let friction = Friction::new(1.5 * 0.0525, 0.0525).unwrap();
        assert_eq!(pendulum, Slider::pendulum(friction, 4.0));
        let flat = one(vec![surface(Some(1.0), 0.03), surface(None, 0.06)]);
        assert_eq!(flat, Slider::new(Friction::new(0.09, 0.06).unwrap()));
    }

    /// Two components of one wave are one along the diagonal, √2 as strong.
    #[test]
    fn equal_components_are_one_that_is_longer() {
        let friction = Friction::new(0.05, 0.04).unwrap();
        let model = rigid(Slider::pendulum(friction, 2.0), 1e3).unwrap();
        let wave = |size: f64| {
            let of = |i: usize| size * libm::sin(0.05 * i as f64) * libm::sin(0.003 * i as f64);
            GroundMotion::evenly_spaced(0.01, (0..1000).map(of).collect(), None).unwrap()
        };
        let found = ratio(&model, &wave(2.0), &wave(2.0)).unwrap();
        let peak =
            |size: f64| exact(&model, &wave(size)).unwrap().demands.peak_sliding_displacement_m;
        let expected = peak(2.0 * core::f64::consts::SQRT_2) / peak(2.0);
        assert!((found - expected).abs() <= 1e-11 * expected && found > 1.4, "{found} {expected}");
        // What friction holds says nothing.
        assert_eq!(ratio(&model, &wave(0.1), &wave(0.1)), None);
    }
}
