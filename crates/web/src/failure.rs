//! Errors as the page reads them.

use std::fmt::Display;

#[cfg(feature = "whole")]
use slipstick::assessment::AssessmentError;
#[cfg(feature = "whole")]
use slipstick::error::ChoiceError;
use slipstick::error::InputError;
#[cfg(feature = "whole")]
use slipstick::requests::FrontEnd;
use slipstick_report::json::pretty;
use slipstick_report::view;
use wasm_bindgen::JsValue;

/// What went wrong: a message, and where it points into a text that the page shows.
#[derive(Debug)]
pub struct Failure {
    message: String,
    place: Option<(String, [usize; 2])>,
    /// The path of a file that the model names and that is not there.
    missing: Option<String>,
}

impl Failure {
    /// An error that says all in its message.
    pub fn of(error: impl Display) -> Self {
        Self { message: error.to_string(), place: None, missing: None }
    }

    /// An error that points into a text.
    pub fn input(error: &InputError, text: &str) -> Self {
        // The page counts as its editor does, in units of UTF-16.
        let units = |byte: usize| text.get(..byte).unwrap_or(text).encode_utf16().count();
        let place = &error.place;
        let known = !place.source_name.is_empty() && place.span.end <= text.len();
        let at = || (place.source_name.clone(), [units(place.span.start), units(place.span.end)]);
        Self { message: error.to_string(), place: known.then(at), missing: None }
    }
}

impl Failure {
    /// The same, with the path of the file that is not there.
    pub fn missing(self, path: &str) -> Self {
        Self { missing: Some(path.to_owned()), ..self }
    }
}

#[cfg(feature = "whole")]
impl Failure {
    /// An error of an analysis over a suite.
    pub fn assessment(error: &AssessmentError, text: &str) -> Self {
        match error {
            AssessmentError::Input(error) => Self::input(error, text),
            AssessmentError::Choice(error) => Self::choice(error),
            other => Self::of(other),
        }
    }

    /// A field of a form that cannot be.
    pub fn choice(error: &ChoiceError) -> Self {
        Self::of(FrontEnd::Page.says(error))
    }
}

impl From<Failure> for JsValue {
    fn from(failure: Failure) -> Self {
        let place = failure.place.map(|(source, [start, end])| view! { source, start, end });
        let missing = failure.missing.map(|missing| view! { missing });
        let said =
            view! { message: failure.message, #[serde(flatten)] place, #[serde(flatten)] missing };
        Self::from_str(&pretty(&said))
    }
}
