//! The model that a command is given: read, with what sets its keys.

use std::io::{self, Read};
use std::path::{Path, PathBuf};

use slipstick::error::InputError;
use slipstick::input::{self, Analysis, Override};
use slipstick_files::{FileError, InputFiles, modes_beside, read_at_most};

use crate::failure::{Failure, say};

/// The model file as it was read.
pub struct ModelFile {
    /// What messages call it.
    pub name: String,
    /// Where it is; empty for standard input.
    pub path: PathBuf,
    /// All of it.
    pub bytes: Vec<u8>,
    /// The table of modes that it names.
    pub modes: Option<Override>,
}

impl ModelFile {
    fn new(name: String, path: PathBuf, bytes: Vec<u8>) -> Result<Self, Failure> {
        let modes = modes_beside(&path, &name, &bytes)
            .map_err(|error| Failure::input(error, &String::from_utf8_lossy(&bytes)))?;
        Ok(Self { name, path, bytes, modes })
    }

    /// The table of modes, then the options that set keys of the model.
    pub fn overrides(&self, set: &[String]) -> Result<Vec<Override>, Failure> {
        Ok(self.modes.iter().cloned().chain(overrides(set)?).collect())
    }

    /// What is wrong with it: with the line in question, unless that is one of the table of modes.
    pub fn failure(&self, error: InputError) -> Failure {
        let named = |modes: &Override| modes.text().ends_with(&error.place.source_name);
        match self.modes.as_ref().filter(|_| !error.place.source_name.is_empty()).is_some_and(named)
        {
            true => Failure::Message(error.to_string()),
            false => Failure::input(error, &self.text()),
        }
    }

    /// The name that is given to the model, else the stem of its file.
    pub fn model_name(&self, given: Option<&str>) -> String {
        let stem = self.path.file_stem().map(|stem| stem.to_string_lossy().into_owned());
        given.map(str::to_owned).or(stem).unwrap_or_else(|| "model".to_owned())
    }

    /// What a result on it is made from.
    pub fn inputs(&self) -> InputFiles {
        InputFiles::model(&self.name, &self.bytes)
    }

    /// All of it as text.
    pub fn text(&self) -> String {
        String::from_utf8_lossy(&self.bytes).into_owned()
    }
}

/// Reads a model from a file, or from standard input where the path is `-`.
pub fn read_model(path: &Path) -> Result<ModelFile, Failure> {
    let limit = input::MAX_TEXT_BYTES as u64;
    if path != Path::new("-") {
        let name = path.display().to_string();
        return ModelFile::new(name, path.to_owned(), read_at_most(path, limit)?);
    }
    let path = PathBuf::from("standard input");
    let mut bytes = Vec::new();
    let read = io::stdin().lock().take(limit + 1).read_to_end(&mut bytes);
    if let Err(source) = read {
        return Err(FileError::Read { path, source }.into());
    }
    if bytes.len() as u64 > limit {
        return Err(FileError::TooLarge { path, limit }.into());
    }
    ModelFile::new(path.display().to_string(), PathBuf::new(), bytes)
}

/// The options that set keys of the model.
pub fn overrides(set: &[String]) -> Result<Vec<Override>, Failure> {
    let read = |text: &String| Override::of_option("--set", text);
    let all: Result<_, InputError> = set.iter().map(read).collect();
    all.map_err(|error| Failure::Message(error.to_string()))
}

/// Says what a key that was set takes the place of.
pub fn tell_replaced(model: &ModelFile, overrides: &[Override], analysis: &Analysis, quiet: bool) {
    let (modes, set): (Vec<Override>, Vec<Override>) =
        overrides.iter().cloned().partition(Override::is_modes);
    if quiet || set.is_empty() {
        return;
    }
    let Ok(written) = input::from_bytes(&model.name, &model.bytes, &modes) else { return };
    let kept: Vec<&str> = analysis.inputs().map(|input| input.path).collect();
    let gone: Vec<&str> =
        written.inputs().map(|input| input.path).filter(|path| !kept.contains(path)).collect();
    if !gone.is_empty() {
        let set: Vec<&str> = set.iter().map(Override::path).collect();
        say(format_args!("note: {} replaces {} of the model", set.join(", "), gone.join(", ")));
    }
}
