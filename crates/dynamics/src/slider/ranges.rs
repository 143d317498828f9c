//! Ranges of what a model is made of: each refuses a number by the name of its quantity.

use crate::error::ModelError;

pub(crate) fn finite(quantity: &'static str, found: f64) -> Result<(), ModelError> {
    in_range(quantity, "a finite number", found, found.is_finite())
}

pub(crate) fn positive(quantity: &'static str, found: f64) -> Result<(), ModelError> {
    in_range(quantity, "a finite number > 0", found, found.is_finite() && found > 0.0)
}

pub(crate) fn not_negative(quantity: &'static str, found: f64) -> Result<(), ModelError> {
    in_range(quantity, "a finite number ≥ 0", found, found.is_finite() && found >= 0.0)
}

pub(crate) fn optional_positive(
    quantity: &'static str,
    found: Option<f64>,
) -> Result<(), ModelError> {
    found.map_or(Ok(()), |value| positive(quantity, value))
}

pub(crate) fn in_range(
    quantity: &'static str,
    expected: &'static str,
    found: f64,
    holds: bool,
) -> Result<(), ModelError> {
    if holds { Ok(()) } else { Err(ModelError::OutOfRange { quantity, expected, found }) }
}
