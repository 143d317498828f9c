//! What measures are called: text to measure and back, and columns of tables.

use std::fmt;

use super::{DEFAULT_DAMPING_RATIO, DEFAULT_THRESHOLD_M_PER_S2, Measure};
use crate::error::{MeasureError, cut, similar};
use crate::units::{Dimension, STANDARD_GRAVITY_M_PER_S2, parse_quantity};

/// Length of the window and corner frequency of FIV3 where none are written.
const FIV3_ALPHA: f64 = 0.7;
const FIV3_BETA: f64 = 0.85;

/// Every measure as a person would write it, for messages.
const EXAMPLES: &str = "PGA, PGV, PGD, Arias, CAV, CAVstd, D5-75, D5-95, Bracketed(0.05 g), \
                        Uniform(0.05 g), Tm, Housner, ASI, VSI, Sa(1.2 s), Sa(1.2 s, 2 %), \
                        PSa(1.2 s), Sa_avg(0.5 s, 3 s), FIV3(1 s)";

/// Names that take no parameters, then those that do.
const PLAIN: [(&str, Measure); 12] = [
    ("PGA", Measure::Pga),
    ("PGV", Measure::Pgv),
    ("PGD", Measure::Pgd),
    ("Arias", Measure::Arias),
    ("CAV", Measure::Cav),
    ("CAVstd", Measure::CavStd),
    ("D5-75", Measure::D5To75),
    ("D5-95", Measure::D5To95),
    ("Tm", Measure::MeanPeriod),
    ("Housner", Measure::Housner),
    ("ASI", Measure::Asi),
    ("VSI", Measure::Vsi),
];
const WITH_PARAMETERS: [&str; 6] = ["Bracketed", "Uniform", "Sa", "PSa", "Sa_avg", "FIV3"];

impl Measure {
    /// Reads a measure, such as `PGA`, `Sa(1.2 s, 2 %)` or `Sa_avg(0.5 s, 3 s)`; capital letters
    /// or not.
    ///
    /// Damping is 5 % where none is written and may be a ratio without `%`. Thresholds of
    /// durations are 0.05 g, α and β of FIV3 0.7 and 0.85 where none are written.
    ///
    /// # Errors
    /// [`MeasureError`] for a name that is none, for parameters that are missing, too many, without
    /// unit or out of range.
    pub fn parse(text: &str) -> Result<Self, MeasureError> {
        let text = text.trim();
        let error = |expected: &str| MeasureError {
            expected: expected.to_owned(),
            found: cut(text),
            nearest: None,
        };
        let (name, list) = match text.split_once('(') {
            Some((name, rest)) => {
                let list = rest.strip_suffix(')');
                (name.trim_end(), Some(list.ok_or_else(|| error("a closing bracket at the end"))?))
            }
            None => (text, None),
        };
        let list: Vec<&str> = list.map_or_else(Vec::new, |list| list.split(',').collect());
        let name = name.replace(['–', '‑'], "-");
        if let Some((_, measure)) =
            PLAIN.iter().find(|(known, _)| known.eq_ignore_ascii_case(&name))
        {
            return if list.is_empty() { Ok(*measure) } else { Err(error("no parameters")) };
        }
        let Some(known) = WITH_PARAMETERS.iter().find(|known| known.eq_ignore_ascii_case(&name))
        else {
            let names = PLAIN.iter().map(|(known, _)| *known).chain(WITH_PARAMETERS);
            let nearest = similar(&name, names);
            return Err(MeasureError { nearest, ..error(&format!("one of {EXAMPLES}")) });
        };
        let parameters = Parameters { list, error: &error };
        match *known {
            "Bracketed" => Ok(Self::Bracketed {
                threshold_m_per_s2: parameters.threshold("Bracketed(0.05 g)")?,
            }),
            "Uniform" => {
                Ok(Self::Uniform { threshold_m_per_s2: parameters.threshold("Uniform(0.05 g)")? })
            }
            "Sa" => {
                let (period_s, damping_ratio) = parameters.oscillator("Sa(1.2 s, 5 %)")?;
                Ok(Self::Sa { period_s, damping_ratio })
            }
            "PSa" => {
                let (period_s, damping_ratio) = parameters.oscillator("PSa(1.2 s, 5 %)")?;
                Ok(Self::PSa { period_s, damping_ratio })
            }
            "Sa_avg" => {
                parameters.count(2..=3, "Sa_avg(0.5 s, 3 s) or Sa_avg(0.5 s, 3 s, 5 %)")?;
                let (from_s, to_s) = (parameters.time(0)?, parameters.time(1)?);
                if !(0.0 < from_s && from_s < to_s) {
                    return Err(error("two periods > 0, the shorter first"));
                }
                Ok(Self::SaAverage { from_s, to_s, damping_ratio: parameters.damping(2)? })
            }
            _ => {
                parameters.count(1..=3, "FIV3(1 s) or FIV3(1 s, 0.7, 0.85)")?;
                let period_s = parameters.time(0)?;
                let alpha = parameters.number(1, FIV3_ALPHA)?;
                let beta = parameters.number(2, FIV3_BETA)?;
                if !(period_s > 0.0 && alpha > 0.0 && beta > 0.0) {
                    return Err(error("a period, α and β that are all > 0"));
                }
                Ok(Self::Fiv3 { period_s, alpha, beta })
            }
        }
    }

    /// Name of a column of a table, unit included, such as `sa_1.2s_5pct_m_per_s2`.
    #[must_use]
    pub fn column(&self) -> String {
        let plain = match *self {
            Self::Pga => "pga_m_per_s2",
            Self::Pgv => "pgv_m_per_s",
            Self::Pgd => "pgd_m",
            Self::Arias => "arias_m_per_s",
            Self::Cav => "cav_m_per_s",
            Self::CavStd => "cavstd_m_per_s",
            Self::D5To75 => "d5_75_s",
            Self::D5To95 => "d5_95_s",
            Self::MeanPeriod => "tm_s",
            Self::Housner => "housner_m",
            Self::Asi => "asi_m_per_s",
            Self::Vsi => "vsi_m",
            Self::Bracketed { threshold_m_per_s2 } => {
                return format!("bracketed_{}g_s", in_g(threshold_m_per_s2));
            }
            Self::Uniform { threshold_m_per_s2 } => {
                return format!("uniform_{}g_s", in_g(threshold_m_per_s2));
            }
            Self::Sa { period_s, damping_ratio } => {
                return format!("sa_{period_s}s_{}pct_m_per_s2", percent(damping_ratio));
            }
            Self::PSa { period_s, damping_ratio } => {
                return format!("psa_{period_s}s_{}pct_m_per_s2", percent(damping_ratio));
            }
            Self::SaAverage { from_s, to_s, damping_ratio } => {
                let damping = percent(damping_ratio);
                return format!("sa_avg_{from_s}s_{to_s}s_{damping}pct_m_per_s2");
            }
            Self::Fiv3 { period_s, alpha, beta } => {
                return format!("fiv3_{period_s}s_{alpha}_{beta}_m_per_s");
            }
        };
        plain.to_owned()
    }

    /// The measure's SI unit, empty for none: `m/s2`, `m/s`, `m` or `s`.
    #[must_use]
    pub fn unit(&self) -> &'static str {
        match self {
            Self::Pga | Self::Sa { .. } | Self::PSa { .. } | Self::SaAverage { .. } => "m/s2",
            Self::Pgv | Self::Arias | Self::Cav | Self::CavStd | Self::Asi | Self::Fiv3 { .. } => {
                "m/s"
            }
            Self::Pgd | Self::Housner | Self::Vsi => "m",
            Self::D5To75
            | Self::D5To95
            | Self::Bracketed { .. }
            | Self::Uniform { .. }
            | Self::MeanPeriod => "s",
        }
    }
}

/// The name as [`Measure::parse`] reads it; defaults are not written.
impl fmt::Display for Measure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some((name, _)) = PLAIN.iter().find(|(_, measure)| measure == self) {
            return f.write_str(name);
        }
        let damping = |damping_ratio: f64| {
            if damping_ratio == DEFAULT_DAMPING_RATIO {
                String::new()
            } else {
                format!(", {} %", percent(damping_ratio))
            }
        };
        match *self {
            Self::Bracketed { threshold_m_per_s2 } => {
                write!(f, "Bracketed({} g)", in_g(threshold_m_per_s2))
            }
            Self::Uniform { threshold_m_per_s2 } => {
                write!(f, "Uniform({} g)", in_g(threshold_m_per_s2))
            }
            Self::Sa { period_s, damping_ratio } => {
                write!(f, "Sa({period_s} s{})", damping(damping_ratio))
            }
            Self::PSa { period_s, damping_ratio } => {
                write!(f, "PSa({period_s} s{})", damping(damping_ratio))
            }
            Self::SaAverage { from_s, to_s, damping_ratio } => {
                write!(f, "Sa_avg({from_s} s, {to_s} s{})", damping(damping_ratio))
            }
            Self::Fiv3 { period_s, alpha: FIV3_ALPHA, beta: FIV3_BETA } => {
                write!(f, "FIV3({period_s} s)")
            }
            Self::Fiv3 { period_s, alpha, beta } => {
                write!(f, "FIV3({period_s} s, {alpha}, {beta})")
            }
            _ => Ok(()),
        }
    }
}

impl std::str::FromStr for Measure {
    type Err = MeasureError;

    fn from_str(text: &str) -> Result<Self, MeasureError> {
        Self::parse(text)
    }
}

/// A number that came from another by one operation, with its last digits rounded off.
fn tidy(value: f64) -> f64 {
    format!("{value:.13e}").parse().unwrap_or(value)
}

fn in_g(m_per_s2: f64) -> f64 {
    tidy(m_per_s2 / STANDARD_GRAVITY_M_PER_S2)
}

fn percent(ratio: f64) -> f64 {
    tidy(100.0 * ratio)
}

/// What stands between the brackets.
struct Parameters<'a, E: Fn(&str) -> MeasureError> {
    list: Vec<&'a str>,
    error: &'a E,
}

impl<E: Fn(&str) -> MeasureError> Parameters<'_, E> {
    fn count(
        &self,
        wanted: std::ops::RangeInclusive<usize>,
        example: &str,
    ) -> Result<(), MeasureError> {
        if wanted.contains(&self.list.len()) { Ok(()) } else { Err((self.error)(example)) }
    }

    fn quantity(&self, index: usize, dimension: Dimension) -> Result<f64, MeasureError> {
        parse_quantity(self.list[index], dimension).map_err(|unit| MeasureError {
            expected: unit.expected,
            found: cut(self.list[index].trim()),
            nearest: unit.nearest,
        })
    }

    fn time(&self, index: usize) -> Result<f64, MeasureError> {
        let seconds = self.quantity(index, Dimension::Time)?;
        if seconds >= 0.0 { Ok(seconds) } else { Err((self.error)("a period ≥ 0")) }
    }

    fn number(&self, index: usize, default: f64) -> Result<f64, MeasureError> {
        let Some(text) = self.list.get(index) else { return Ok(default) };
        let value = text.trim().parse::<f64>().ok().filter(|value| value.is_finite());
        value.ok_or_else(|| (self.error)("a finite number"))
    }

    fn damping(&self, index: usize) -> Result<f64, MeasureError> {
        let Some(text) = self.list.get(index) else { return Ok(DEFAULT_DAMPING_RATIO) };
        let text = text.trim();
        let ratio = match text.strip_suffix('%') {
            Some(percent) => percent.trim_end().parse::<f64>().map(|percent| percent / 100.0),
            None => text.parse::<f64>(),
        };
        let expected = "damping from 0 % to below 100 %, such as \"2 %\" or 0.02";
        ratio.ok().filter(|r| (0.0..1.0).contains(r)).ok_or_else(|| (self.error)(expected))
    }

    fn oscillator(&self, example: &str) -> Result<(f64, f64), MeasureError> {
        self.count(1..=2, example)?;
        Ok((self.time(0)?, self.damping(1)?))
    }

    fn threshold(&self, example: &str) -> Result<f64, MeasureError> {
        self.count(0..=1, example)?;
        if self.list.is_empty() {
            return Ok(DEFAULT_THRESHOLD_M_PER_S2);
        }
        let threshold = self.quantity(0, Dimension::Acceleration)?;
        if threshold >= 0.0 { Ok(threshold) } else { Err((self.error)("a threshold ≥ 0")) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [(&str, &str, &str); 22] = [
        ("PGA", "PGA", "pga_m_per_s2"),
        ("pgv", "PGV", "pgv_m_per_s"),
        ("PGD", "PGD", "pgd_m"),
        ("Arias", "Arias", "arias_m_per_s"),
        ("CAV", "CAV", "cav_m_per_s"),
        ("CAVstd", "CAVstd", "cavstd_m_per_s"),
        ("D5–75", "D5-75", "d5_75_s"),
        (" d5-95 ", "D5-95", "d5_95_s"),
        ("Tm", "Tm", "tm_s"),
        ("Housner", "Housner", "housner_m"),
        ("ASI", "ASI", "asi_m_per_s"),
        ("VSI", "VSI", "vsi_m"),
        ("Bracketed", "Bracketed(0.05 g)", "bracketed_0.05g_s"),
        ("uniform(0.1g)", "Uniform(0.1 g)", "uniform_0.1g_s"),
        ("Sa(1.2 s)", "Sa(1.2 s)", "sa_1.2s_5pct_m_per_s2"),
        ("Sa(1200ms,0.02)", "Sa(1.2 s, 2 %)", "sa_1.2s_2pct_m_per_s2"),
        ("Sa(0 s, 0 %)", "Sa(0 s, 0 %)", "sa_0s_0pct_m_per_s2"),
        ("PSa(1.2 s, 7 %)", "PSa(1.2 s, 7 %)", "psa_1.2s_7pct_m_per_s2"),
        ("Sa_avg(0.5 s, 3 s)", "Sa_avg(0.5 s, 3 s)", "sa_avg_0.5s_3s_5pct_m_per_s2"),
        ("Sa_avg(0.5 s, 3 s, 2%)", "Sa_avg(0.5 s, 3 s, 2 %)", "sa_avg_0.5s_3s_2pct_m_per_s2"),
        ("FIV3(1 s)", "FIV3(1 s)", "fiv3_1s_0.7_0.85_m_per_s"),
        ("FIV3(1 s, 0.5, 1)", "FIV3(1 s, 0.5, 1)", "fiv3_1s_0.5_1_m_per_s"),
    ];

    #[test]
    fn names_and_columns() {
        for (text, name, column) in ALL {
            let measure = Measure::parse(text).unwrap();
            assert_eq!((measure.to_string().as_str(), measure.column().as_str()), (name, column));
            assert_eq!(Measure::parse(name).unwrap(), measure);
        }
    }

    #[test]
    fn messages_say_what_to_write() {
        for (text, message) in [
            ("PGX", "found \"PGX\"; nearest is \"PGA\""),
            ("PGA(1 s)", "expected no parameters, found \"PGA(1 s)\""),
            ("Sa", "expected Sa(1.2 s, 5 %), found \"Sa\""),
            ("Sa(1.2)", "expected a time with its unit, such as \"0.01 s\", found \"1.2\""),
            ("Sa(-1 s)", "expected a period ≥ 0, found \"Sa(-1 s)\""),
            ("Sa(1 s", "expected a closing bracket at the end, found \"Sa(1 s\""),
            ("Sa(1 s, 100 %)", "expected damping from 0 % to below 100 %"),
            ("Sa_avg(3 s, 0.5 s)", "expected two periods > 0, the shorter first"),
            ("Sa_avg(3 s)", "expected Sa_avg(0.5 s, 3 s) or"),
            ("FIV3(0 s)", "expected a period, α and β that are all > 0"),
            ("Bracketed(-1 g)", "expected a threshold ≥ 0"),
            ("", "expected one of PGA, PGV"),
        ] {
            let found = Measure::parse(text).unwrap_err().to_string();
            assert!(found.contains(message), "{text}: {found}");
        }
    }
}
