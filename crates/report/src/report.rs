//! What a report is made from.

use slipstick::assessment::floors::FloorSpectra;
use slipstick::check::Certificate;
use slipstick::model::Model;
use slipstick::motion::GroundMotion;
use slipstick::response::Response;

use crate::display::DisplayUnits;
use crate::html;
use crate::summary::Summary;

/// A call of the command with these words, with quotes where the shell needs them.
#[must_use]
pub fn command_line(words: impl IntoIterator<Item = String>) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./=,+:@%".contains(c);
    let quoted = |word: String| {
        if !word.is_empty() && word.chars().all(plain) {
            word
        } else {
            format!("'{}'", word.replace('\'', r"'\''"))
        }
    };
    let words = words.into_iter().map(quoted);
    core::iter::once("slipstick".to_owned()).chain(words).collect::<Vec<_>>().join(" ")
}

/// Everything that `report.html` shows. Nothing in it is trusted: all of it is escaped.
#[derive(Clone, Copy, Debug)]
pub struct Report<'a> {
    /// The figures, with those of the bounds and all warnings.
    pub summary: &'a Summary,
    /// The model that ran (nominal friction).
    pub model: &'a Model,
    /// The motion that it ran on, factors applied.
    pub motion: &'a GroundMotion,
    /// What was understood of the record: `PEER AT2, 2800 values, 0.005 s, g`.
    pub record: &'a str,
    /// The nominal answer; figures over time need its history.
    pub response: &'a Response,
    /// Its certificate, with the energy at the knots of that history.
    pub certificate: &'a Certificate,
    /// Answers with lower- and upper-bound friction, where they were asked for.
    pub bounds: Option<[&'a Response; 2]>,
    /// Floor spectra, where they were asked for.
    pub floor_spectra: Option<&'a FloorSpectra>,
    /// Texts that people wrote, shown in full: the model file.
    pub inputs: &'a [InputText<'a>],
    /// Files read, with their hashes.
    pub files: &'a [FileNote<'a>],
    /// The command as it was typed.
    pub command_line: &'a str,
    /// Units to show results in.
    pub display: DisplayUnits,
}

/// What a result was made from.
#[derive(Clone, Copy, Debug)]
pub struct Provenance<'a> {
    /// The command as it was typed.
    pub command_line: &'a str,
    /// Files read, with their hashes.
    pub files: &'a [FileNote<'a>],
    /// Texts that people wrote.
    pub inputs: &'a [InputText<'a>],
}

/// A text that a person wrote.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InputText<'a> {
    /// Its path as it was given.
    pub path: &'a str,
    /// All of it.
    pub text: &'a str,
}

/// A file that was read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FileNote<'a> {
    /// Its path as it was given.
    pub path: &'a str,
    /// SHA-256 of its bytes in hexadecimal digits.
    pub sha256: &'a str,
    /// What it is: `model`, `record, PEER AT2, 2800 values`.
    pub description: &'a str,
}

impl Report<'_> {
    /// The report as one self-contained HTML page: no other files, no network, no times of
    /// day, and complete without its script, which says values under the pointer. Prints on A4.
    #[must_use]
    pub fn to_html(&self) -> String {
        let Self { command_line, files, inputs, .. } = *self;
        html::sheet(self).to_html(&Provenance { command_line, files, inputs })
    }
}
