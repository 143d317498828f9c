//! Friction under several normal forces: the exponent of the pressure, and what holds at the reference pressure.

use super::curve::{CurveCycle, CurveFit, Follows};
use crate::laboratory::estimate::Estimate;
use crate::numerics::fractile::upper_median;

/// Normal forces are different where they differ by this ratio.
const APART: f64 = 1.1;
/// An interval as wide as the exponents that the law has, from 0 to 1, says nothing.
const WIDEST: f64 = 1.0;
/// Parts of the curve.
const PARTS: usize = 60;

/// What presses the bearing in some tests.
#[derive(Clone, Copy, Debug)]
pub struct BearingLoads<'a> {
    /// Normal force of each test in N.
    pub normal_n: &'a [f64],
    /// Area of the bearing in m².
    pub area_m2: f64,
    /// Pressure at which coefficients are told, in Pa; if `None` that of the tests which lies nearest to the geometric
    /// mean of the least and the largest.
    pub reference_pa: Option<f64>,
}

impl BearingLoads<'_> {
    /// Pressure of each test in Pa.
    #[must_use]
    pub fn pressures_pa(&self) -> Vec<f64> {
        self.normal_n.iter().map(|n| n / self.area_m2).collect()
    }

    /// The least and the largest normal force in N.
    fn range_n(&self) -> [f64; 2] {
        self.normal_n.iter().fold([f64::INFINITY, 0.0], |[l, h], n| [n.min(l), n.max(h)])
    }

    /// Whether they differ enough to tell how friction follows the pressure.
    #[must_use]
    pub fn are_apart(&self) -> bool {
        let [least, largest] = self.range_n();
        largest > APART * least
    }

    /// The pressure at which coefficients hold, in Pa: the reference, or that of the tests where they are at one.
    #[must_use]
    pub fn coefficients_at_pa(&self) -> f64 {
        let pressures = self.pressures_pa();
        if !self.are_apart() {
            return upper_median(pressures.iter().copied()).unwrap_or(0.0);
        }
        self.reference_pa.unwrap_or_else(|| {
            let [least, largest] = self.range_n().map(|n| libm::log(n / self.area_m2));
            let off = |pressure: f64| (libm::log(pressure) - 0.5 * (least + largest)).abs();
            let nearer = |a: f64, b: f64| if off(b) < off(a) { b } else { a };
            pressures.into_iter().reduce(nearer).unwrap_or(0.0)
        })
    }
}

/// Friction over the pressure, `μ(p) = μ (p/reference)^(−exponent)`.
#[derive(Clone, Debug, PartialEq)]
pub struct PressureFit {
    /// The exponent.
    ///
    /// Refused where normal forces differ by less than a tenth, where its interval is as wide as the range of the
    /// law, and where the force of friction does not grow with the normal force.
    pub exponent: Estimate,
    /// Pressure at which the coefficients hold, in Pa: the reference, or that of the tests where they are at one.
    pub reference_pa: f64,
    /// Pressure of each test in Pa.
    pub pressures_pa: Vec<f64>,
    /// Kinetic friction of every cycle: the coefficient, or where friction follows the speed too, that over what the
    /// curve says at the reference pressure; empty where the exponent is refused.
    pub cycles: Vec<PressurePoint>,
    /// The fitted curve over the pressures that were tested; empty where the exponent is refused.
    pub curve: Vec<PressurePoint>,
}

impl PressureFit {
    /// Friction at the pressure of a test over that at which the coefficients hold; 1 where the exponent is refused.
    #[must_use]
    pub fn factor(&self, test: usize) -> f64 {
        let ratio = self.pressures_pa.get(test).map_or(1.0, |pa| pa / self.reference_pa);
        self.exponent.value().map_or(1.0, |exponent| libm::pow(ratio, -exponent))
    }
}

/// Friction at a pressure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PressurePoint {
    /// Pressure in Pa.
    pub pressure_pa: f64,
    /// Friction there.
    pub friction: f64,
    /// Ends of its 95 % interval; of a cycle it is `friction` itself.
    pub interval: [f64; 2],
}

/// Lays the law through all cycles, which stand under their pressure; `why_not` is why nothing slid, if so.
pub(super) fn pressure_law(
    cycles: &[CurveCycle],
    by_speed: bool,
    loads: &BearingLoads<'_>,
    why_not: Option<&str>,
) -> (PressureFit, Option<CurveFit>) {
    let fit = match why_not {
        Some(why) => Err(why.to_owned()),
        None => judged(cycles, by_speed, loads),
    };
    let reference_pa = loads.coefficients_at_pa();
    let at = |ln_pressure: f64| reference_pa * libm::exp(ln_pressure);
    let (path, pressures_pa) = ("slider.pressure.exponent", loads.pressures_pa());
    let (exponent, points, curve) = match &fit {
        Err(why) => (Estimate::refused(path, "", why.as_str()), vec![], vec![]),
        Ok((fit, value, ends)) => {
            let points = cycles.iter().map(|cycle| {
                let friction = fit.over_pressure(cycle);
                let (pressure_pa, interval) = (at(cycle.ln_pressure), [friction; 2]);
                PressurePoint { pressure_pa, friction, interval }
            });
            let [low, high] = loads.range_n().map(|n| libm::log(n / loads.area_m2 / reference_pa));
            let curve = (0..=PARTS).map(|i| {
                let ln_pressure = low + (high - low) * i as f64 / PARTS as f64;
                let (friction, half) = fit.at_pressure(ln_pressure);
                let interval = [friction - half, friction + half];
                PressurePoint { pressure_pa: at(ln_pressure), friction, interval }
            });
            (Estimate::determined(path, "", *value, *ends), points.collect(), curve.collect())
        }
    };
    let law = PressureFit { exponent, reference_pa, pressures_pa, cycles: points, curve };
    (law, fit.ok().map(|(fit, ..)| fit))
}

/// The fit with its exponent and the ends of its interval; else why the tests do not tell it.
fn judged(
    cycles: &[CurveCycle],
    by_speed: bool,
    loads: &BearingLoads<'_>,
) -> Result<(CurveFit, f64, [f64; 2]), String> {
    let [least, largest] = loads.range_n();
    let range = format!("{least:.4e} to {largest:.4e} N");
    if !loads.are_apart() {
        return Err(format!(
            "all tests are at one normal force ({range}): the exponent takes tests at normal forces a tenth \
             apart at least, and better at twice the force"
        ));
    }
    let fit = CurveFit::new(cycles, Follows { speed: by_speed, pressure: true })?;
    let unsettled = || "the fit does not settle".to_owned();
    let (value, interval) = fit.exponent.ok_or_else(unsettled)?;
    let [low, high] = interval.ends;
    if interval.open != [false; 2] || !(high - low < WIDEST) {
        return Err(format!(
            "normal forces from {range} leave the exponent anywhere between {low:.2} and {high:.2}: tests at \
             forces further apart are needed, or more cycles"
        ));
    }
    if !(value < 1.0) {
        return Err(format!(
            "the force of friction does not grow with the normal force from {range} (exponent {value:.3}): look \
             at the normal forces of the tests"
        ));
    }
    Ok((fit, value, interval.ends))
}

#[cfg(test)]
mod tests;
