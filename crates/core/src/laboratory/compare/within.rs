//! Bounds that a comparison must keep: `peak_ratio.sliding_displacement=0.9..1.1`.

use super::Metrics;
use crate::error::{ChoiceError, cut, similar};
use crate::input::Channel;

/// A bound on one figure of one quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct Within {
    /// One of [`Metrics::names`].
    pub metric: &'static str,
    /// The quantity.
    pub channel: Channel,
    /// Least value allowed, −∞ for none; in SI.
    pub least: f64,
    /// Largest value allowed, ∞ for none; in SI.
    pub most: f64,
}

impl Within {
    /// Reads `METRIC.QUANTITY=LEAST..MOST`; either end may be left out.
    ///
    /// # Errors
    /// [`ChoiceError`] for an unknown figure or quantity, and for ends that are no numbers or in
    /// the wrong order.
    pub fn parse(text: &str) -> Result<Self, ChoiceError> {
        let fault = |expected: String, found: &str, nearest: Option<String>| ChoiceError {
            what: format!("within {}", cut(text)),
            expected,
            found: format!("\"{}\"", cut(found)),
            nearest,
        };
        let form = || fault("METRIC.QUANTITY=LEAST..MOST".to_owned(), text, None);
        let (what, range) = text.split_once('=').ok_or_else(form)?;
        let (metric, quantity) = what.trim().split_once('.').ok_or_else(form)?;
        let known = Metrics::names().find(|name| *name == metric).ok_or_else(|| {
            let names: Vec<&str> = Metrics::names().collect();
            let expected = format!("one of the figures {}", names.join(", "));
            fault(expected, metric, similar(metric, names.into_iter()))
        })?;
        let channel = Channel::parse(quantity).ok_or_else(|| {
            let names = [
                "block_acceleration",
                "sliding_displacement",
                "storey1_acceleration",
                "storey1_displacement",
            ];
            let expected = format!("a quantity such as {}", names.join(", "));
            fault(expected, quantity, similar(quantity, names.into_iter()))
        })?;
        let (least, most) = range.split_once("..").ok_or_else(form)?;
        let end =
            |word: &str, none: f64| match word.trim() {
                "" => Ok(none),
                word => word.parse::<f64>().ok().filter(|v| v.is_finite()).ok_or_else(|| {
                    fault("a number, in SI where it has a unit".to_owned(), word, None)
                }),
            };
        let (least, most) = (end(least, f64::NEG_INFINITY)?, end(most, f64::INFINITY)?);
        if least > most {
            return Err(fault("LEAST..MOST in this order".to_owned(), range, None));
        }
        Ok(Self { metric: known, channel, least, most })
    }

    /// `METRIC.QUANTITY`.
    #[must_use]
    pub fn name(&self) -> String {
        format!("{}.{}", self.metric, self.channel.name())
    }

    /// Whether a value keeps it; none does not.
    #[must_use]
    pub fn holds(&self, value: Option<f64>) -> bool {
        value.is_some_and(|value| value >= self.least && value <= self.most)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_are_read() {
        let bound = Within::parse("peak_ratio.sliding_displacement=0.9..1.1").unwrap();
        assert_eq!(bound.name(), "peak_ratio.sliding_displacement");
        assert!(bound.holds(Some(0.9)) && bound.holds(Some(1.1)));
        assert!(!bound.holds(Some(1.11)) && !bound.holds(None) && !bound.holds(Some(f64::NAN)));
        assert_eq!(
            Within::parse("correlation.storey1_acceleration=0.9..").unwrap().most,
            f64::INFINITY
        );
        for (text, part) in [
            ("peak_rato.sliding_displacement=0..1", "nearest is \"peak_ratio\""),
            ("peak_ratio.slidng_displacement=0..1", "nearest is \"sliding_displacement\""),
            ("peak_ratio.sliding_displacement=1..0", "in this order"),
            ("peak_ratio.sliding_displacement=a..1", "a number"),
            ("peak_ratio", "METRIC.QUANTITY=LEAST..MOST"),
            ("peak_ratio.sliding_displacement=5", "METRIC.QUANTITY=LEAST..MOST"),
        ] {
            let message = Within::parse(text).unwrap_err().to_string();
            assert!(message.contains(part), "{message}");
        }
    }
}
