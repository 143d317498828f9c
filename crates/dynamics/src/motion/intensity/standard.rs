//! The set of measures that is printed for every record.

use super::{DEFAULT_THRESHOLD_M_PER_S2, Measure, durations, integrals, spectral};
use crate::motion::GroundMotion;

/// The standard measures of a motion's horizontal component, all SI; 0 where it is zero throughout.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct IntensityMeasures {
    /// Largest |Ü|, m/s².
    pub pga_m_per_s2: f64,
    /// Largest |U̇|, m/s.
    pub pgv_m_per_s: f64,
    /// Largest |U|, m.
    pub pgd_m: f64,
    /// Arias intensity, m/s.
    pub arias_m_per_s: f64,
    /// Cumulative absolute velocity, m/s.
    pub cav_m_per_s: f64,
    /// Standardised cumulative absolute velocity, m/s.
    pub cavstd_m_per_s: f64,
    /// Significant duration from 5 % to 75 %, s.
    pub d5_75_s: f64,
    /// Significant duration from 5 % to 95 %, s.
    pub d5_95_s: f64,
    /// Bracketed duration above 0.05 g, s.
    pub bracketed_s: f64,
    /// Uniform duration above 0.05 g, s.
    pub uniform_s: f64,
    /// Mean period, s.
    pub tm_s: f64,
    /// Housner's spectrum intensity, m.
    pub housner_m: f64,
    /// Acceleration spectrum intensity, m/s.
    pub asi_m_per_s: f64,
    /// Velocity spectrum intensity, m.
    pub vsi_m: f64,
}

impl IntensityMeasures {
    /// All of them.
    #[must_use]
    pub fn of(motion: &GroundMotion) -> Self {
        let figures = motion.figures();
        let above = durations::above(motion, DEFAULT_THRESHOLD_M_PER_S2);
        let spectral = spectral::intensities(motion);
        Self {
            pga_m_per_s2: figures.pga_m_per_s2,
            pgv_m_per_s: figures.pgv_m_per_s,
            pgd_m: figures.pgd_m,
            arias_m_per_s: integrals::arias(motion),
            cav_m_per_s: integrals::cav(motion),
            cavstd_m_per_s: integrals::cav_std(motion),
            d5_75_s: durations::significant(motion, 0.05, 0.75),
            d5_95_s: durations::significant(motion, 0.05, 0.95),
            bracketed_s: above.bracketed_s,
            uniform_s: above.uniform_s,
            tm_s: spectral::mean_period(motion),
            housner_m: spectral.housner_m,
            asi_m_per_s: spectral.asi_m_per_s,
            vsi_m: spectral.vsi_m,
        }
    }

    /// Name of the measure, column (with unit) and value of each, in the order of the fields.
    #[must_use]
    pub fn columns(&self) -> [(Measure, &'static str, f64); 14] {
        let threshold_m_per_s2 = DEFAULT_THRESHOLD_M_PER_S2;
        [
            (Measure::Pga, "pga_m_per_s2", self.pga_m_per_s2),
            (Measure::Pgv, "pgv_m_per_s", self.pgv_m_per_s),
            (Measure::Pgd, "pgd_m", self.pgd_m),
            (Measure::Arias, "arias_m_per_s", self.arias_m_per_s),
            (Measure::Cav, "cav_m_per_s", self.cav_m_per_s),
            (Measure::CavStd, "cavstd_m_per_s", self.cavstd_m_per_s),
            (Measure::D5To75, "d5_75_s", self.d5_75_s),
            (Measure::D5To95, "d5_95_s", self.d5_95_s),
            (Measure::Bracketed { threshold_m_per_s2 }, "bracketed_0.05g_s", self.bracketed_s),
            (Measure::Uniform { threshold_m_per_s2 }, "uniform_0.05g_s", self.uniform_s),
            (Measure::MeanPeriod, "tm_s", self.tm_s),
            (Measure::Housner, "housner_m", self.housner_m),
            (Measure::Asi, "asi_m_per_s", self.asi_m_per_s),
            (Measure::Vsi, "vsi_m", self.vsi_m),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn noise() -> GroundMotion {
        let wave = |k: u32| libm::sin(f64::from(k * k)) * f64::from(k) / 1500.0;
        GroundMotion::evenly_spaced(0.01, (0..1500).map(wave).collect(), None).unwrap()
    }

    /// The set and the measures one by one are one thing.
    #[test]
    fn set_is_the_measures() {
        let motion = noise();
        for (measure, column, value) in IntensityMeasures::of(&motion).columns() {
            assert_eq!(measure.of(&motion), value, "{measure}");
            assert_eq!(measure.column(), column);
            assert!(value > 0.0, "{measure}");
        }
    }

    #[test]
    fn zero_motion_has_zero_of_everything() {
        let motion = GroundMotion::evenly_spaced(0.01, vec![0.0; 300], None).unwrap();
        assert_eq!(IntensityMeasures::of(&motion), IntensityMeasures::default());
        for text in ["Sa(1 s)", "PSa(1 s)", "Sa_avg(0.1 s, 1 s)", "FIV3(1 s)"] {
            assert_eq!(Measure::parse(text).unwrap().of(&motion), 0.0, "{text}");
        }
    }

    /// What scales, scales; what does not, does not.
    #[test]
    fn scaling_of_measures() {
        let motion = noise();
        let double = motion.scaled(2.0).unwrap();
        let others = ["Sa(0.4 s)", "PSa(0.4 s)", "Sa_avg(0.1 s, 1 s)", "FIV3(0.5 s)"];
        let others = others.map(|text| Measure::parse(text).unwrap());
        let standard = IntensityMeasures::of(&motion).columns().map(|(measure, ..)| measure);
        for measure in standard.into_iter().chain(others) {
            let (once, twice) = (measure.of(&motion), measure.of(&double));
            let scaled = (twice - 2.0 * once).abs() <= 1e-12 * twice;
            assert_eq!(scaled, measure.scales(), "{measure} {once} {twice}");
        }
    }
}
