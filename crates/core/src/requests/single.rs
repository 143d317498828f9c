//! What is asked of one model on one motion.

use super::fields::{Request, quantity, wrong};
use crate::assessment::code::PropertyFactors;
use crate::error::{ChoiceError, InputError};
use crate::input::{FrictionBounds, Override, Scale};
use crate::response::Method;
use crate::units::Dimension;

/// What is asked of one model on one motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Single {
    /// The method, where it is not that of the model.
    pub method: Option<Method>,
    /// Whether floor response spectra are wanted.
    pub floor_spectrum: bool,
    /// How the record is scaled, where it is not as it stands.
    pub scale: Option<Scale>,
    /// Bounds of friction, where they are not those of the model.
    pub bounds: Option<FrictionBounds>,
}

impl Single {
    /// The keys of the model that ask for the same: the method, bounds of friction, and the scale where it is
    /// that of the model's own record.
    ///
    /// # Errors
    /// [`InputError`] for a key that no model has, which is none of these.
    pub fn keys(&self, own_record: bool) -> Result<Vec<Override>, InputError> {
        let method = self.method.map(|method| ("analysis.method", method.name()));
        let method = method.map(|(path, name)| Override::text_value(path, name));
        let scale = self.scale.filter(|_| own_record).map(|scale| match scale {
            Scale::Factor(factor) => Override::number("motion.scale", factor),
            Scale::Peak(peak_m_per_s2) => Override::number("motion.scale_to", peak_m_per_s2),
        });
        let bounds = self.bounds.map(|FrictionBounds { lower, upper }| {
            [("slider.bounds.lower", lower), ("slider.bounds.upper", upper)]
        });
        let bounds = bounds.into_iter().flatten();
        let bounds = bounds.map(|(path, factor)| Override::number(path, factor));
        method.into_iter().chain(bounds).chain(scale).collect()
    }

    /// An error of a model with these keys: that of the scale where the motion is made.
    #[must_use]
    pub fn of_scale(&self, error: &InputError) -> Option<ChoiceError> {
        let (what, key) = match self.scale? {
            Scale::Factor(_) => ("scale", "motion.scale"),
            Scale::Peak(_) => ("scale-to", "motion.scale_to"),
        };
        let own = error.place.source_name.is_empty() && error.path == key;
        own.then(|| ChoiceError {
            what: what.to_owned(),
            expected: "a record to scale; of a made motion the amplitude is a key of the model"
                .to_owned(),
            found: error.found.clone(),
            nearest: None,
        })
    }
}

impl Request {
    /// What is asked of one model on one motion.
    ///
    /// # Errors
    /// [`ChoiceError`] for a scale that cannot be, and for two of them.
    pub fn single(&self) -> Result<Single, ChoiceError> {
        let scale = match (self.given("scale"), self.given("scale-to")) {
            (Some(_), Some(_)) => return Err(self.two_scales()),
            (Some(_), None) => Some(Scale::Factor(self.number("scale", "a factor", |_| true)?)),
            (None, Some(text)) => {
                let peak_m_per_s2 = quantity("scale-to", text, Dimension::Acceleration)?;
                if !(peak_m_per_s2 > 0.0) {
                    return Err(wrong("scale-to", "a peak > 0", text));
                }
                Some(Scale::Peak(peak_m_per_s2))
            }
            (None, None) => None,
        };
        Ok(Single {
            method: self.method(),
            floor_spectrum: self.given("floor-spectrum").is_some(),
            scale,
            bounds: self.property_factors()?.map(|factors| factors.bounds()),
        })
    }

    /// Property modification factors on friction.
    ///
    /// # Errors
    /// [`ChoiceError`] as [`PropertyFactors::parse`].
    pub(super) fn property_factors(&self) -> Result<Option<PropertyFactors>, ChoiceError> {
        self.given("property-factors").map(PropertyFactors::parse).transpose()
    }

    /// The method that is asked for.
    pub(super) fn method(&self) -> Option<Method> {
        self.given("method").map(|name| match name {
            "stepwise" => Method::Stepwise,
            _ => Method::Exact,
        })
    }

    /// A factor and a level.
    pub(super) fn two_scales(&self) -> ChoiceError {
        let (what, expected) =
            ("scale".to_owned(), "only one of `scale` and `scale-to`".to_owned());
        ChoiceError { what, expected, found: "both".to_owned(), nearest: None }
    }
}
