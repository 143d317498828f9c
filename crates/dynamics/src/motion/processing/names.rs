//! Steps in words: what is written is what is printed.

use std::fmt;

use super::{Band, Step};
use crate::error::{MeasureError, cut, similar};
use crate::motion::Quantity;
use crate::units::{Dimension, parse_quantity};

/// Order of a filter where none is written.
const DEFAULT_ORDER: usize = 4;

/// Every step as a person would write it.
const EXAMPLES: &str = "\"remove mean\", \"remove linear\", \"remove polynomial 3\", \
                        \"high-pass 0.1 Hz\", \"low-pass 25 Hz\", \"band-pass 0.1 Hz 25 Hz\" \
                        (perhaps with \"order 4\"), \"taper 5 %\", \"resample 0.005 s\", \
                        \"trim 2 s 30 s\", \"scale 1.5\", \"to acceleration\", \"to velocity\", \
                        \"to displacement\"";

const KEYWORDS: [&str; 9] =
    ["remove", "high-pass", "low-pass", "band-pass", "taper", "resample", "trim", "scale", "to"];

impl Step {
    /// Reads a step such as `band-pass 0.1 Hz 25 Hz order 4`; commas and brackets count as spaces.
    ///
    /// # Errors
    /// [`MeasureError`] with what to write.
    pub fn parse(text: &str) -> Result<Self, MeasureError> {
        let spaced = text.replace(['(', ')', ','], " ");
        let words: Vec<&str> = spaced.split_whitespace().collect();
        let error = |expected: &str| MeasureError {
            expected: expected.to_owned(),
            found: cut(text.trim()),
            nearest: None,
        };
        let Some((keyword, rest)) = words.split_first() else { return Err(error(EXAMPLES)) };
        let mut words = Words { rest, error: &error };
        let step = match keyword.to_ascii_lowercase().as_str() {
            "remove" => Self::RemovePolynomial { degree: words.degree()? },
            "high-pass" => {
                let band = Band::High { corner_hz: words.frequency("high-pass 0.1 Hz")? };
                Self::Filter { band, order: words.order()? }
            }
            "low-pass" => {
                let band = Band::Low { corner_hz: words.frequency("low-pass 25 Hz")? };
                Self::Filter { band, order: words.order()? }
            }
            "band-pass" => {
                let example = "band-pass 0.1 Hz 25 Hz";
                let (from_hz, to_hz) = (words.frequency(example)?, words.frequency(example)?);
                if !(from_hz < to_hz) {
                    return Err(error("two corner frequencies, the lower first"));
                }
                Self::Filter { band: Band::Pass { from_hz, to_hz }, order: words.order()? }
            }
            "taper" => Self::Taper { fraction: words.percent()? },
            "resample" => {
                let dt_s = words.quantity(Dimension::Time, "resample 0.005 s")?;
                if !(dt_s > 0.0) {
                    return Err(error("a time step > 0"));
                }
                Self::Resample { dt_s }
            }
            "trim" => {
                let from_s = words.quantity(Dimension::Time, "trim 2 s 30 s")?;
                let to_s = words.quantity(Dimension::Time, "trim 2 s 30 s")?;
                if !(0.0 <= from_s && from_s < to_s) {
                    return Err(error("two times ≥ 0, the earlier first"));
                }
                Self::Trim { from_s, to_s }
            }
            "scale" => {
                let factor = words.next().and_then(|w| w.parse::<f64>().ok());
                let factor = factor.filter(|factor| factor.is_finite());
                Self::Scale { factor: factor.ok_or_else(|| error("scale 1.5"))? }
            }
            "to" => {
                let known = [Quantity::Acceleration, Quantity::Velocity, Quantity::Displacement];
                let word = words.next().unwrap_or_default();
                let quantity = known.into_iter().find(|q| q.name().eq_ignore_ascii_case(word));
                let expected = "to acceleration, to velocity or to displacement";
                Self::To { quantity: quantity.ok_or_else(|| error(expected))? }
            }
            other => {
                let nearest = similar(other, KEYWORDS.into_iter());
                return Err(MeasureError { nearest, ..error(&format!("one of {EXAMPLES}")) });
            }
        };
        if words.rest.is_empty() { Ok(step) } else { Err(error(&format!("\"{step}\" alone"))) }
    }
}

/// As [`Step::parse`] reads it.
impl fmt::Display for Step {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::RemovePolynomial { degree: 0 } => f.write_str("remove mean"),
            Self::RemovePolynomial { degree: 1 } => f.write_str("remove linear"),
            Self::RemovePolynomial { degree } => write!(f, "remove polynomial {degree}"),
            Self::Filter { band, order } => {
                match band {
                    Band::High { corner_hz } => write!(f, "high-pass {corner_hz} Hz")?,
                    Band::Low { corner_hz } => write!(f, "low-pass {corner_hz} Hz")?,
                    Band::Pass { from_hz, to_hz } => {
                        write!(f, "band-pass {from_hz} Hz {to_hz} Hz")?
                    }
                }
                write!(f, " order {order}")
            }
            Self::Taper { fraction } => {
                let percent: f64 = format!("{:.12e}", 100.0 * fraction).parse().unwrap_or(0.0);
                write!(f, "taper {percent} %")
            }
            Self::Resample { dt_s } => write!(f, "resample {dt_s} s"),
            Self::Trim { from_s, to_s } => write!(f, "trim {from_s} s {to_s} s"),
            Self::Scale { factor } => write!(f, "scale {factor}"),
            Self::To { quantity } => write!(f, "to {}", quantity.name()),
        }
    }
}

/// Words that are still to be read.
struct Words<'a, E: Fn(&str) -> MeasureError> {
    rest: &'a [&'a str],
    error: &'a E,
}

impl<'a, E: Fn(&str) -> MeasureError> Words<'a, E> {
    fn next(&mut self) -> Option<&'a str> {
        let (first, rest) = self.rest.split_first()?;
        self.rest = rest;
        Some(first)
    }

    /// A number with its unit, written as one word or two.
    fn quantity(&mut self, dimension: Dimension, example: &str) -> Result<f64, MeasureError> {
        let first = self.next().ok_or_else(|| (self.error)(example))?;
        let text = match first.parse::<f64>() {
            Ok(_) => format!("{first} {}", self.next().unwrap_or_default()),
            Err(_) => first.to_owned(),
        };
        parse_quantity(&text, dimension).map_err(|unit| MeasureError {
            expected: unit.expected,
            found: cut(text.trim()),
            nearest: unit.nearest,
        })
    }

    fn frequency(&mut self, example: &str) -> Result<f64, MeasureError> {
        let hz = self.quantity(Dimension::Frequency, example)?;
        if hz > 0.0 { Ok(hz) } else { Err((self.error)("a corner frequency > 0")) }
    }

    fn order(&mut self) -> Result<usize, MeasureError> {
        match self.next() {
            None => Ok(DEFAULT_ORDER),
            Some("order") => {
                let order = self.next().and_then(|word| word.parse().ok());
                let order = order.filter(|order| (1..=10).contains(order));
                order.ok_or_else(|| (self.error)("order 1 to order 10"))
            }
            Some(_) => Err((self.error)("nothing more, or an order such as \"order 4\"")),
        }
    }

    fn degree(&mut self) -> Result<usize, MeasureError> {
        match self.next() {
            Some("mean") => Ok(0),
            Some("linear") => Ok(1),
            Some("polynomial") => {
                let degree = self.next().and_then(|word| word.parse().ok());
                let degree = degree.filter(|degree| *degree <= 10);
                degree.ok_or_else(|| (self.error)("remove polynomial 0 to remove polynomial 10"))
            }
            _ => Err((self.error)("remove mean, remove linear or remove polynomial 3")),
        }
    }

    fn percent(&mut self) -> Result<f64, MeasureError> {
        let first = self.next().unwrap_or_default();
        let number = match first.strip_suffix('%') {
            Some(number) => number,
            None => {
                if self.next() != Some("%") {
                    return Err((self.error)("taper 5 %"));
                }
                first
            }
        };
        let fraction = number.parse::<f64>().map(|percent| percent / 100.0);
        let fraction = fraction.ok().filter(|f| *f > 0.0 && *f <= 0.5);
        fraction.ok_or_else(|| (self.error)("a taper above 0 % and up to 50 % at each end"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_printed_as_they_are_written() {
        for (written, printed) in [
            ("remove mean", "remove mean"),
            ("remove polynomial 0", "remove mean"),
            ("remove linear", "remove linear"),
            ("remove polynomial 3", "remove polynomial 3"),
            ("high-pass 0.1Hz", "high-pass 0.1 Hz order 4"),
            ("low-pass 25 Hz order 2", "low-pass 25 Hz order 2"),
            ("Band-pass(0.1 Hz, 25 Hz, order 3)", "band-pass 0.1 Hz 25 Hz order 3"),
            ("taper 5%", "taper 5 %"),
            ("resample 5 ms", "resample 0.005 s"),
            ("trim 2 s 30 s", "trim 2 s 30 s"),
            ("scale -1.5", "scale -1.5"),
            ("to velocity", "to velocity"),
        ] {
            let step = Step::parse(written).unwrap();
            assert_eq!(step.to_string(), printed);
            assert_eq!(Step::parse(printed).unwrap(), step);
        }
    }

    #[test]
    fn messages_say_what_to_write() {
        for (written, message) in [
            ("bandpass 1 Hz 2 Hz", "nearest is \"band-pass\""),
            ("band-pass 2 Hz 1 Hz", "expected two corner frequencies, the lower first"),
            ("band-pass 2 Hz", "expected band-pass 0.1 Hz 25 Hz"),
            ("high-pass 0.1", "expected a frequency with its unit"),
            ("high-pass 0.1 Hz 4", "expected nothing more, or an order"),
            ("low-pass 1 Hz order 11", "expected order 1 to order 10"),
            ("taper 60 %", "up to 50 % at each end"),
            ("resample 0 s", "expected a time step > 0"),
            ("trim 3 s 2 s", "the earlier first"),
            ("scale", "expected scale 1.5"),
            ("to force", "expected to acceleration"),
            ("remove mean twice", "expected \"remove mean\" alone"),
            ("", "remove mean"),
        ] {
            let found = Step::parse(written).unwrap_err().to_string();
            assert!(found.contains(message), "{written}: {found}");
        }
    }
}
