//! The displacement of the equivalent-lateral-force procedure of isolated structures, worked out as by hand
//! (ASCE/SEI 7, section 17.5), to stand beside that of response histories.

use crate::model::Model;
use crate::motion::target::TargetSpectrum;

/// Effective damping and the factor `B_M` by which it divides the spectrum, linear between
/// (ASCE/SEI 7, table 17.5-1).
const DAMPING: [[f64; 2]; 7] =
    [[0.02, 0.8], [0.05, 1.0], [0.10, 1.2], [0.20, 1.5], [0.30, 1.7], [0.40, 1.9], [0.50, 2.0]];

/// The least total displacement over `D_M` (17.5.3.3): what eccentricity adds at least.
pub const LEAST_TOTAL: f64 = 1.15;

/// Displacements looked at, in m.
const SOUGHT_M: [f64; 2] = [1e-4, 100.0];

/// The isolators at the displacement that the procedure gives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LateralForce {
    /// `D_M = Sa(T_M) (T_M/2π)² / B_M` in m.
    pub displacement_m: f64,
    /// Effective stiffness `k_M = F(D_M)/D_M` in N/m.
    pub stiffness_n_per_m: f64,
    /// Effective damping `β_M = E_loop/(2π k_M D_M²)`.
    pub damping_ratio: f64,
    /// `B_M`.
    pub damping_factor: f64,
    /// Effective period `T_M = 2π √(W/(k_M g))` in s.
    pub period_s: f64,
}

impl LateralForce {
    /// The least displacement that satisfies it; `None` where nothing slides, beyond the spectrum, and for
    /// friction that follows the speed, of which a hand takes no loop.
    #[must_use]
    pub fn of(model: &Model, spectrum: &TargetSpectrum) -> Option<Self> {
        let loops = Loop::of(model)?;
        let (weight_n, g) = (model.weight_n(), model.gravity_m_per_s2());
        let at = |displacement_m: f64| -> Option<(Self, f64)> {
            let [force, area_m] = loops.at(displacement_m);
            let stiffness_n_per_m = force * weight_n / displacement_m;
            let period_s = core::f64::consts::TAU * (displacement_m / (force * g)).sqrt();
            let damping_ratio = area_m / (core::f64::consts::TAU * force * displacement_m);
            let damping_factor = damping_factor(damping_ratio);
            let rate = core::f64::consts::TAU / period_s;
            let of_spectrum = spectrum.at(period_s)? / (rate * rate * damping_factor);
            let found =
                Self { displacement_m, stiffness_n_per_m, damping_ratio, damping_factor, period_s };
            Some((found, of_spectrum - displacement_m))
        };
        // The first fall through 0 of what the spectrum asks for beyond what is there, halved to rounding.
        const STEPS: i32 = 600;
        let ratio = SOUGHT_M[1] / SOUGHT_M[0];
        let step = |i: i32| SOUGHT_M[0] * libm::pow(ratio, f64::from(i) / f64::from(STEPS));
        let mut low = None;
        for i in 0..=STEPS {
            match (low, at(step(i))) {
                (_, Some((_, missing))) if missing > 0.0 => low = Some(step(i)),
                (Some(low), Some(_)) => {
                    let (mut low, mut high) = (low, step(i));
                    for _ in 0..200 {
                        let middle = 0.5 * (low + high);
                        if at(middle)?.1 > 0.0 { low = middle } else { high = middle }
                    }
                    return at(high).map(|(found, _)| found);
                }
                _ => low = None,
            }
        }
        None
    }
}

/// `B_M` of an effective damping.
#[must_use]
pub fn damping_factor(ratio: f64) -> f64 {
    let above = DAMPING.partition_point(|[damping, _]| *damping < ratio);
    match above {
        0 => DAMPING[0][1],
        i if i == DAMPING.len() => DAMPING[i - 1][1],
        i => {
            let ([from, low], [to, high]) = (DAMPING[i - 1], DAMPING[i]);
            low + (high - low) * (ratio - from) / (to - from)
        }
    }
}

/// The loop of the isolators pushed slowly: sliding surfaces in series, each `f = μ + u/R` over the weight.
struct Loop {
    /// Coefficient and `1/R` in 1/m of each.
    surfaces: Vec<[f64; 2]>,
}

impl Loop {
    fn of(model: &Model) -> Option<Self> {
        let mut surfaces = model.slider().slow_loop(model.normal_n(), model.weight_n())?;
        surfaces.sort_by(|a, b| a[0].total_cmp(&b[0]));
        Some(Self { surfaces })
    }

    /// Force over the weight at a displacement, and the area of the loop over the weight in m:
    /// `f = (D + Σ μ_i R_i)/Σ R_i` over the surfaces that slide, which have `μ_i < f`, and `4 Σ μ_i u_i`.
    fn at(&self, displacement_m: f64) -> [f64; 2] {
        let (mut radii_m, mut rise_m) = (0.0, 0.0);
        for (i, [friction, curvature]) in self.surfaces.iter().enumerate() {
            let next = self.surfaces.get(i + 1).map_or(f64::INFINITY, |[friction, _]| *friction);
            let flat = *curvature == 0.0;
            let force = if flat {
                *friction
            } else {
                radii_m += 1.0 / curvature;
                rise_m += friction / curvature;
                (displacement_m + rise_m) / radii_m
            };
            if force <= next {
                let of_curved = |[friction, curvature]: &[f64; 2]| {
                    friction * (force - friction).max(0.0) / curvature
                };
                let curved = self.surfaces[..=i].iter().filter(|[_, curvature]| *curvature > 0.0);
                let area: f64 = curved.clone().map(of_curved).sum();
                let curved_m: f64 =
                    curved.map(|[mu, curvature]| (force - mu).max(0.0) / curvature).sum();
                // A flat surface takes what the others leave.
                let left_m = if flat { (displacement_m - curved_m).max(0.0) } else { 0.0 };
                return [force, 4.0 * (area + friction * left_m)];
            }
        }
        [f64::INFINITY, 0.0]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input;
    use crate::units::STANDARD_GRAVITY_M_PER_S2 as G;

    fn model(slider: &str) -> Model {
        let text = format!("[block]\nmass = \"100 t\"\n[slider]\n{slider}");
        input::parse("m.toml", &text, &[]).unwrap().model
    }

    const SPECTRUM: TargetSpectrum =
        TargetSpectrum::Code { sds_m_per_s2: 1.2 * G, sd1_m_per_s2: 0.8 * G, tl_s: 8.0 };

    /// A pendulum of R = 2.2 m with μ = 0.06: `k = W (1/R + μ/D)`, `β = 2/π μ/(μ + D/R)`, iterated by hand.
    #[test]
    fn pendulum_is_the_textbooks() {
        let pendulum =
            model("static_friction = 0.06\nkinetic_friction = 0.06\nradius = \"2.2 m\"\n");
        let found = LateralForce::of(&pendulum, &SPECTRUM).unwrap();
        let mut d = 0.3;
        for _ in 0..500 {
            let k = 1.0 / 2.2 + 0.06 / d;
            let t = core::f64::consts::TAU * (1.0 / (k * G)).sqrt();
            let beta = 2.0 / core::f64::consts::PI * 0.06 / (0.06 + d / 2.2);
            // 10 to 20 % or 20 to 30 %, as it comes out.
            let b = if beta < 0.2 { 1.2 + 3.0 * (beta - 0.1) } else { 1.5 + 2.0 * (beta - 0.2) };
            let rate = core::f64::consts::TAU / t;
            d = 0.5 * (d + 0.8 * G / t / (rate * rate * b));
        }
        assert!((found.displacement_m - d).abs() < 1e-12, "{found:?} {d}");
        assert!((0.1..0.3).contains(&found.damping_ratio), "{found:?}");
        let period_s = core::f64::consts::TAU * (d / (G * (0.06 + d / 2.2))).sqrt();
        assert!((found.period_s - period_s).abs() < 1e-11);
    }

    /// Two surfaces: the outer one slides where the force reaches its friction; each dissipates by itself.
    #[test]
    fn surfaces_in_series_share_the_displacement() {
        let loops = Loop { surfaces: vec![[0.02, 1.0 / 0.4], [0.08, 1.0 / 4.0]] };
        let close = |found: [f64; 2], expected: [f64; 2]| {
            assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-15), "{found:?}");
        };
        // Up to u = (0.08 − 0.02) 0.4 m the inner one alone.
        close(loops.at(0.01), [0.02 + 0.01 / 0.4, 4.0 * 0.02 * 0.01]);
        let force = (0.3 + 0.02 * 0.4 + 0.08 * 4.0) / 4.4;
        let [inner, outer] = [(force - 0.02) * 0.4, (force - 0.08) * 4.0];
        assert!((inner + outer - 0.3_f64).abs() < 1e-15);
        close(loops.at(0.3), [force, 4.0 * (0.02 * inner + 0.08 * outer)]);
        let flat = Loop { surfaces: vec![[0.1, 0.0]] };
        close(flat.at(0.5), [0.1, 4.0 * 0.1 * 0.5]);
    }

    #[test]
    fn damping_factors_are_the_tables() {
        let found = [0.0, 0.05, 0.15, 0.2, 0.45, 0.6].map(damping_factor);
        let expected = [0.8, 1.0, 1.35, 1.5, 1.95, 2.0];
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-15), "{found:?}");
    }

    /// Friction that the spectrum does not overcome, and friction by speed, have none.
    #[test]
    fn no_displacement_where_nothing_slides() {
        let held = model("static_friction = 1.0\nkinetic_friction = 1.0\nradius = \"2 m\"\n");
        assert_eq!(LateralForce::of(&held, &SPECTRUM), None);
        let by_speed = model(
            "static_friction = 0.1\nkinetic_friction = { slow = 0.03, fast = 0.08, rate = \"25 s/m\" }\n\
             radius = \"2 m\"\n",
        );
        assert_eq!(LateralForce::of(&by_speed, &SPECTRUM), None);
    }
}
