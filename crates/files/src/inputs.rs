//! What a result is made from.

use std::path::PathBuf;

use slipstick::hash::sha256_hex;
use slipstick_report::assessment::{Provenance, Sheet};
use slipstick_report::{FileNote, InputText};

use crate::laboratory::TextFile;
use crate::load::SourceFile;

/// The files that a result is made from, and the texts among them that its page shows.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct InputFiles {
    /// Path, SHA-256 and what it is.
    pub files: Vec<(String, String, String)>,
    /// Path and text.
    pub texts: Vec<(String, String)>,
}

impl InputFiles {
    /// A model by its name and its bytes.
    #[must_use]
    pub fn model(name: &str, bytes: &[u8]) -> Self {
        let text = String::from_utf8_lossy(bytes).into_owned();
        Self {
            files: vec![(name.to_owned(), sha256_hex(bytes), "model".to_owned())],
            texts: vec![(name.to_owned(), text)],
        }
    }

    /// The same with the files of tests and their mapping.
    #[must_use]
    pub fn with_tests<'a>(
        mut self,
        measured: impl IntoIterator<Item = &'a SourceFile>,
        mapping: Option<&TextFile>,
    ) -> Self {
        let note = |file: &SourceFile, what: &str| {
            (file.path.display().to_string(), file.sha256.clone(), what.to_owned())
        };
        self.files.extend(measured.into_iter().map(|file| note(file, "measured")));
        self.files.extend(mapping.map(|file| note(&file.source, "mapping")));
        let shown = mapping.map(|file| (file.source.path.display().to_string(), file.text.clone()));
        self.texts.extend(shown);
        self
    }

    /// The paths, which no result may replace.
    #[must_use]
    pub fn paths(&self) -> Vec<PathBuf> {
        self.files.iter().map(|(path, ..)| path.into()).collect()
    }

    /// The page of a result that is made from these.
    #[must_use]
    pub fn page(&self, sheet: &Sheet, command_line: &str) -> String {
        let files = self.files.iter();
        let files: Vec<FileNote<'_>> = files
            .map(|(path, sha256, description)| FileNote { path, sha256, description })
            .collect();
        let inputs = self.texts.iter().map(|(path, text)| InputText { path, text });
        let inputs: Vec<InputText<'_>> = inputs.collect();
        sheet.to_html(&Provenance { command_line, files: &files, inputs: &inputs })
    }
}
