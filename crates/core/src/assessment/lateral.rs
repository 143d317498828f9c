//! The displacement of the equivalent-lateral-force procedure of isolated structures, worked out as by hand
//! (ASCE/SEI 7, section 17.5), to stand beside that of response histories.

use crate::model::Model;
use crate::motion::target::TargetSpectrum;
use crate::slider::Surface;

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
    /// What `D_M` passes, and where that stands in m: the travel of all surfaces, the gap to a stop or the gap of
    /// the detailing, the least of them. Then there is no such displacement.
    pub passes: Option<(&'static str, f64)>,
}

impl LateralForce {
    /// The least displacement that satisfies it; `None` where nothing slides, beyond the spectrum, and for
    /// friction that follows the speed, of which a hand takes no loop.
    #[must_use]
    pub fn of(model: &Model, spectrum: &TargetSpectrum) -> Option<Self> {
        Self::by_law(model, spectrum, &|ratio| Some(damping_factor(ratio)))
    }

    /// The same by another law of the factor by which an effective damping divides the spectrum.
    pub(super) fn by_law(
        model: &Model,
        spectrum: &TargetSpectrum,
        damping_factor: &dyn Fn(f64) -> Option<f64>,
    ) -> Option<Self> {
        let loops = Loop::of(model)?;
        let reach = model.slider().reach_m();
        let (weight_n, g) = (model.weight_n(), model.gravity_m_per_s2());
        let at = |displacement_m: f64| -> Option<(Self, f64)> {
            let [force, area_m] = loops.at(displacement_m);
            let stiffness_n_per_m = force * weight_n / displacement_m;
            let period_s = core::f64::consts::TAU * (displacement_m / (force * g)).sqrt();
            let damping_ratio = area_m / (core::f64::consts::TAU * force * displacement_m);
            let damping_factor = damping_factor(damping_ratio)?;
            let rate = core::f64::consts::TAU / period_s;
            let of_spectrum = spectrum.at(period_s)? / (rate * rate * damping_factor);
            let passes = reach.filter(|(_, reach_m)| displacement_m > *reach_m);
            let found = Self {
                displacement_m,
                stiffness_n_per_m,
                damping_ratio,
                damping_factor,
                period_s,
                passes,
            };
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
    interpolated(&DAMPING, ratio)
}

/// The value at `x` between rows `[x, value]` of a table, `x` rising; beyond its ends that of the end. NaN of no row.
pub(super) fn interpolated(table: &[[f64; 2]], x: f64) -> f64 {
    let above = table.partition_point(|[at, _]| *at < x);
    let row = |i: usize| table.get(i).copied();
    match (above.checked_sub(1).and_then(row), row(above)) {
        (None, None) => f64::NAN,
        (None, Some([_, value])) | (Some([_, value]), None) => value,
        (Some([from, low]), Some([to, high])) => low + (high - low) * (x - from) / (to - from),
    }
}

/// The loop of the isolators pushed slowly: sliding surfaces in series under one force `f` over the weight. A surface
/// has slid `u_i = min(R_i (f − μ_i), d_i)` where that is positive, a flat one under `f = μ_i` whatever is left of the
/// displacement, up to its travel `d_i`. In a cycle it slides `4 u_i` against `μ_i`: at its end it waits.
///
/// Beyond the travel of all of them the surface that reaches its end last goes on: how far the spectrum asks for is
/// then known, and that it is too far.
pub(super) struct Loop {
    surfaces: Vec<Surface>,
}

impl Loop {
    /// That of a model; none of friction that follows the speed.
    pub(super) fn of(model: &Model) -> Option<Self> {
        let surfaces = model.slider().slow_surfaces(model.normal_n(), model.weight_n())?;
        Some(Self::new(surfaces))
    }

    fn new(mut surfaces: Vec<Surface>) -> Self {
        let travels: Option<f64> = surfaces.iter().map(|surface| surface.travel_m).sum();
        if travels.is_some() {
            let ends = |surface: &Surface| end_of(surface).unwrap_or(f64::INFINITY);
            let last = surfaces.iter().map(ends).fold(0.0, f64::max);
            let of_last = surfaces.iter_mut().filter(|surface| ends(surface) == last);
            of_last.for_each(|surface| surface.travel_m = None);
        }
        Self { surfaces }
    }

    /// Energy over the weight in m that pushing to a displacement stores in the curvature of the surfaces.
    pub(super) fn stored_m(&self, displacement_m: f64) -> f64 {
        let [force, _] = self.at(displacement_m);
        let of = |surface: &Surface| {
            let slid_m = slid(surface, force);
            surface.radius_m.map_or(0.0, |radius_m| 0.5 * slid_m * slid_m / radius_m)
        };
        self.surfaces.iter().map(of).sum()
    }

    /// Force over the weight at a displacement > 0, and the area of the loop over the weight in m.
    pub(super) fn at(&self, displacement_m: f64) -> [f64; 2] {
        let starts = self.surfaces.iter().map(|surface| surface.friction);
        let mut forces: Vec<f64> = starts.chain(self.surfaces.iter().filter_map(end_of)).collect();
        forces.sort_by(f64::total_cmp);
        forces.dedup();
        let mut below = 0.0;
        for force in forces {
            let curved_m = self.slid_m(force, true);
            if displacement_m <= curved_m + self.slid_m(below, false) {
                return self.between(below, displacement_m);
            }
            if displacement_m <= curved_m + self.slid_m(force, false) {
                return [
                    force,
                    self.area_m(force, displacement_m - curved_m - self.slid_m(below, false)),
                ];
            }
            below = force;
        }
        self.between(below, displacement_m)
    }

    /// Under a force above one at which something starts or ends, and below the next.
    fn between(&self, below: f64, displacement_m: f64) -> [f64; 2] {
        let (mut radii_m, mut rise_m) = (0.0, displacement_m - self.slid_m(below, false));
        for surface in &self.surfaces {
            let Some(radius_m) = surface.radius_m else { continue };
            if end_of(surface).is_some_and(|end| end <= below) {
                rise_m -= surface.travel_m.unwrap_or(0.0);
            } else if surface.friction <= below {
                radii_m += radius_m;
                rise_m += radius_m * surface.friction;
            }
        }
        let force = rise_m / radii_m;
        if force.is_finite() { [force, self.area_m(force, 0.0)] } else { [f64::INFINITY, 0.0] }
    }

    /// What surfaces with a radius have slid under a force, or what flat ones can have.
    fn slid_m(&self, force: f64, has_radius: bool) -> f64 {
        let alike = self.surfaces.iter().filter(|surface| surface.radius_m.is_some() == has_radius);
        alike.map(|surface| slid(surface, force)).sum()
    }

    /// `4 Σ μ_i u_i`, of flat surfaces that have just begun to slide under this force what is left.
    fn area_m(&self, force: f64, left_m: f64) -> f64 {
        let of = |surface: &Surface| match surface.radius_m {
            None if surface.friction >= force => 0.0,
            _ => surface.friction * slid(surface, force),
        };
        4.0 * (self.surfaces.iter().map(of).sum::<f64>() + force * left_m)
    }
}

/// What a surface has slid under a force over the weight, in m; of a flat one the most.
fn slid(surface: &Surface, force: f64) -> f64 {
    let travel_m = surface.travel_m.unwrap_or(f64::INFINITY);
    match surface.radius_m {
        Some(radius_m) => (radius_m * (force - surface.friction)).max(0.0).min(travel_m),
        None if surface.friction <= force => travel_m,
        None => 0.0,
    }
}

/// The force over the weight at which a surface reaches its end; none without one.
fn end_of(surface: &Surface) -> Option<f64> {
    let curvature = surface.radius_m.map_or(0.0, |radius_m| 1.0 / radius_m);
    Some(surface.friction + surface.travel_m? * curvature)
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
        let of =
            |friction: f64, radius_m: Option<f64>| Surface { radius_m, friction, travel_m: None };
        let loops = Loop::new(vec![of(0.08, Some(4.0)), of(0.02, Some(0.4))]);
        let close = |found: [f64; 2], expected: [f64; 2]| {
            assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-15), "{found:?}");
        };
        // Up to u = (0.08 − 0.02) 0.4 m the inner one alone.
        close(loops.at(0.01), [0.02 + 0.01 / 0.4, 4.0 * 0.02 * 0.01]);
        let force = (0.3 + 0.02 * 0.4 + 0.08 * 4.0) / 4.4;
        let [inner, outer] = [(force - 0.02) * 0.4, (force - 0.08) * 4.0];
        assert!((inner + outer - 0.3_f64).abs() < 1e-15);
        close(loops.at(0.3), [force, 4.0 * (0.02 * inner + 0.08 * outer)]);
        let flat = Loop::new(vec![of(0.1, None)]);
        close(flat.at(0.5), [0.1, 4.0 * 0.1 * 0.5]);
        // A flat surface between two pendulums takes all beyond where it starts.
        let mixed = Loop::new(vec![of(0.02, Some(0.4)), of(0.05, None), of(0.08, Some(4.0))]);
        close(mixed.at(0.012), [0.05, 4.0 * 0.02 * 0.012]);
        close(mixed.at(0.112), [0.05, 4.0 * (0.02 * 0.012 + 0.05 * 0.1)]);
    }

    /// Regimes of a triple pendulum by Fenz and Constantinou (2008): stiffness over the weight 1/(L2 + L3),
    /// 1/(L1 + L3), 1/(L1 + L4), 1/(L2 + L4) where the outer surface with less friction has used up its travel and
    /// 1/(L2 + L3) where both have. Each point lies on a line of that slope through the one before.
    #[test]
    fn paper_triple_pendulum_has_five_regimes() {
        let [l1, l2, l3, l4] = [1.25, 0.18, 0.18, 1.25];
        let (travel, force_at) =
            ([0.12, 0.05, 0.05, 0.12], |from: [f64; 2], radius: f64, u: f64| {
                from[1] + (u - from[0]) / radius
            });
        let triple = model(
            "[slider.triple]\neffective_radius = [\"1.25 m\", \"0.18 m\", \"0.18 m\", \"1.25 m\"]\n\
             friction = [0.052, 0.012, 0.012, 0.14]\ntravel = [\"0.12 m\", \"0.05 m\", \"0.05 m\", \"0.12 m\"]\n",
        );
        let loops = Loop::of(&triple).unwrap();
        let travel_m = triple.slider().series().unwrap().travel_m().unwrap();
        assert!((travel_m - travel.iter().sum::<f64>()).abs() < 1e-12);
        // Where the next surface starts, or the travel of one ends: displacement and force over the weight.
        let start = [0.0, 0.012];
        let first = [(0.052 - 0.012) * (l2 + l3), 0.052];
        let second = [first[0] + (0.14 - 0.052) * (l1 + l3), 0.14];
        let end1 = 0.052 + travel[0] / l1;
        let third = [second[0] + (end1 - 0.14) * (l1 + l4), end1];
        let end4 = 0.14 + travel[3] / l4;
        let fourth = [third[0] + (end4 - end1) * (l2 + l4), end4];
        let regimes = [
            (start, l2 + l3, 0.5 * first[0]),
            (first, l1 + l3, 0.5 * (first[0] + second[0])),
            (second, l1 + l4, 0.5 * (second[0] + third[0])),
            (third, l2 + l4, 0.5 * (third[0] + fourth[0])),
            (fourth, l2 + l3, 0.5 * (fourth[0] + travel_m)),
        ];
        for (from, radius, u) in regimes {
            let [force, _] = loops.at(u);
            let expected = force_at(from, radius, u);
            assert!((force - expected).abs() < 1e-12, "{u} m: {force} for {expected}");
        }
        // ASCE/SEI 7, 17.5, worked by hand.
        let found = LateralForce::of(&triple, &SPECTRUM).unwrap();
        let per_kn = 500.0 / 100.0;
        assert!((found.stiffness_n_per_m * per_kn / 1e3 - 4544.0).abs() < 1.0, "{found:?}");
        assert!(
            (found.period_s - 2.084).abs() < 5e-4 && (found.displacement_m - 0.3018).abs() < 5e-5
        );
        assert!(
            (found.damping_ratio - 0.1575).abs() < 5e-5
                && (found.damping_factor - 1.372).abs() < 5e-4
        );
        assert_eq!(found.passes, None);
        // Beyond the travel: the last surface goes on, and that is said.
        let strong =
            TargetSpectrum::Code { sds_m_per_s2: 1.6 * G, sd1_m_per_s2: 1.2 * G, tl_s: 8.0 };
        let found = LateralForce::of(&triple, &strong).unwrap();
        assert!(found.displacement_m > 0.34, "{found:?}");
        let (what, reach_m) = found.passes.unwrap();
        assert!(what == "travel" && (reach_m - 0.34).abs() < 1e-12);
    }

    /// The gap of the detailing and that of a stop are passed by the displacement too.
    #[test]
    fn a_gap_is_passed() {
        let base = "static_friction = 0.06\nkinetic_friction = 0.06\nradius = \"2.2 m\"\n";
        for (ends, what) in [
            ("gap = \"100 mm\"\n", Some("gap")),
            ("gap = \"2 m\"\n", None),
            ("[slider.stop]\ngap = \"90 mm\"\nrestitution = 0.5\n", Some("gap to the stop")),
        ] {
            let found = LateralForce::of(&model(&format!("{base}{ends}")), &SPECTRUM).unwrap();
            assert_eq!(found.passes.map(|(what, _)| what), what);
        }
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
