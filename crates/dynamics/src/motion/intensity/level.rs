//! Measures to whose values records are scaled: of one component, or of a pair of them.

use core::fmt;

use super::{Measure, RotD};
use crate::error::{MeasureError, MotionError, cut};
use crate::motion::GroundMotion;

/// Which of the values over all directions a measure of a pair is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rotated {
    /// RotD00, the smallest.
    Smallest,
    /// RotD50, the median.
    Median,
    /// RotD100, the largest: the maximum direction of ASCE/SEI 7.
    Largest,
}

/// A measure of a record, or of a pair of horizontal components.
///
/// ```
/// use slipstick_dynamics::motion::intensity::{LevelMeasure, Measure, Rotated};
/// let measure = LevelMeasure::parse("RotD50(1.2 s)").unwrap();
/// assert_eq!(measure.measure, Measure::PSa { period_s: 1.2, damping_ratio: 0.05 });
/// assert_eq!(measure.rotated, Some(Rotated::Median));
/// assert_eq!(measure.to_string(), "RotD50(1.2 s)");
/// assert_eq!(LevelMeasure::parse("rotd100(PGV)").unwrap().to_string(), "RotD100(PGV)");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LevelMeasure {
    /// The measure of a component.
    pub measure: Measure,
    /// Which of its values over all directions; `None` for that of a component, and of a pair the
    /// geometric mean of both.
    pub rotated: Option<Rotated>,
}

const NAMES: [(&str, Rotated); 3] =
    [("RotD00", Rotated::Smallest), ("RotD50", Rotated::Median), ("RotD100", Rotated::Largest)];

impl LevelMeasure {
    /// Reads a measure as [`Measure::parse`] does, and `RotD50(1.2 s)`, `RotD100(1.2 s, 2 %)`,
    /// `RotD50(PGV)`: a period means the pseudo-spectral acceleration there.
    ///
    /// # Errors
    /// As [`Measure::parse`].
    pub fn parse(text: &str) -> Result<Self, MeasureError> {
        let text = text.trim();
        let named = NAMES.iter().find_map(|(name, rotated)| {
            let start = text.get(..name.len()).filter(|start| start.eq_ignore_ascii_case(name))?;
            let rest = text[start.len()..].trim_start();
            rest.starts_with('(').then_some((rest, *rotated))
        });
        let Some((rest, rotated)) = named else {
            return Ok(Self { measure: Measure::parse(text)?, rotated: None });
        };
        let inner = rest.strip_prefix('(').and_then(|rest| rest.strip_suffix(')'));
        let inner = inner.ok_or_else(|| MeasureError {
            expected: "a closing bracket at the end".to_owned(),
            found: cut(text),
            nearest: None,
        })?;
        let of_period = inner.trim_start().starts_with(|c: char| c.is_ascii_digit() || c == '.');
        let measure = match of_period {
            true => Measure::parse(&format!("PSa({inner})"))?,
            false => Measure::parse(inner)?,
        };
        Ok(Self { measure, rotated: Some(rotated) })
    }

    /// Its SI unit.
    #[must_use]
    pub fn unit(&self) -> &'static str {
        self.measure.unit()
    }

    /// Whether it grows as the motion does.
    #[must_use]
    pub fn scales(&self) -> bool {
        self.measure.scales()
    }

    /// The measure of a record, or of it and the other component of its pair, which a motion in two
    /// horizontal directions has in it; NaN for a direction without a pair.
    ///
    /// # Errors
    /// [`MotionError`] where the union of their times has too many samples.
    pub fn of(&self, x: &GroundMotion, other: Option<&GroundMotion>) -> Result<f64, MotionError> {
        let split = x.horizontal_y_m_per_s2().map(|_| [x.along_x(), x.along_y()]);
        let (x, other) = split.as_ref().map_or((x, other), |[x, y]| (x, Some(y)));
        let Some(y) = other else {
            return Ok(if self.rotated.is_none() { self.measure.of(x) } else { f64::NAN });
        };
        let Some(rotated) = self.rotated else {
            return Ok((self.measure.of(x) * self.measure.of(y)).sqrt());
        };
        let all = RotD::of(&self.measure, x, y)?;
        Ok(match rotated {
            Rotated::Smallest => all.smallest(),
            Rotated::Median => all.median(),
            Rotated::Largest => all.largest(),
        })
    }
}

impl fmt::Display for LevelMeasure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let plain = self.measure.to_string();
        let Some((name, _)) = NAMES.iter().find(|(_, rotated)| Some(*rotated) == self.rotated)
        else {
            return f.write_str(&plain);
        };
        write!(
            f,
            "{name}({})",
            plain.strip_prefix("PSa(").and_then(|p| p.strip_suffix(')')).unwrap_or(&plain)
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_measures_of_pairs() {
        for text in ["RotD50(1.2 s)", "RotD100(0.5 s, 2 %)", "RotD00(PGA)", "Sa(1.2 s)", "PGV"] {
            assert_eq!(LevelMeasure::parse(text).unwrap().to_string(), text);
        }
        for (text, expected) in [
            ("RotD50(1.2)", "a"),
            ("RotD50(1.2 s", "a closing bracket at the end"),
            ("RotD50", "one of"),
        ] {
            let error = LevelMeasure::parse(text).unwrap_err();
            assert!(error.expected.contains(expected), "{text}: {error:?}");
        }
    }

    #[test]
    fn measures_of_a_pair() {
        let motion = |a: &[f64]| GroundMotion::evenly_spaced(0.5, a.to_vec(), None).unwrap();
        let (x, y) = (motion(&[0.0, 4.0, 0.0, 0.0]), motion(&[0.0, 0.0, 1.0, 0.0]));
        let of = |text: &str, other| LevelMeasure::parse(text).unwrap().of(&x, other).unwrap();
        assert_eq!(of("PGA", None), 4.0);
        assert_eq!(of("PGA", Some(&y)), 2.0);
        assert_eq!(of("RotD100(PGA)", Some(&y)), 4.0);
        let rotated = RotD::of(&Measure::Pga, &x, &y).unwrap();
        assert_eq!(of("RotD50(PGA)", Some(&y)), rotated.median());
        assert!(of("RotD50(PGA)", None).is_nan());
    }
}
