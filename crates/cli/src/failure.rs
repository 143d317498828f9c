//! What ends a command early, and how it is told.

use std::fmt;
use std::io::{self, IsTerminal, Write};
use std::path::PathBuf;

use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet};
use slipstick::assessment::AssessmentError;
use slipstick::error::{ChoiceError, InputError, is_hidden, visible};
use slipstick::record;
use slipstick::requests::FrontEnd;
use slipstick_files::{FileError, JobError, LaboratoryError, StudyError};

/// Bad input, or an output that nobody reads any more.
#[derive(Debug)]
pub enum Failure {
    /// The reader of standard output has left: no error.
    ClosedPipe,
    /// A fault in model text, with the text to point into.
    Input {
        /// The fault.
        error: Box<InputError>,
        /// The text of the model file.
        text: String,
    },
    /// Data that tell nothing of what was asked: the input is in order, the answer is that there is
    /// none.
    CannotTell(String),
    /// Anything else, in one sentence.
    Message(String),
}

impl Failure {
    /// A fault of an input whose text is at hand.
    pub fn input(error: InputError, text: &str) -> Self {
        let name = &error.place.source_name;
        // No TOML: perhaps the numbers of another file.
        if error.path.is_empty()
            && let Some(what) = numbers(name, text)
        {
            let mend = "a record is given beside a model, with --motion or --records; what was measured \
                        stands before the model";
            let name = visible(name);
            return Self::Message(format!("{name}: expected a model, found {what} ({mend})"));
        }
        Self::Input { error: Box::new(error), text: text.to_owned() }
    }

    /// A fault of a job; `name` and `text` are those of its model file.
    pub fn job(error: JobError, name: &str, text: &str) -> Self {
        match error {
            JobError::Input(error) => Self::input(error, text),
            JobError::Solve(error) => Self::Message(format!("{}: {error}", visible(name))),
            JobError::File(error) => error.into(),
        }
    }

    /// Writes one message to standard error; where a person reads it, with the line in question.
    pub fn report(&self) {
        match self {
            Self::ClosedPipe => {}
            Self::Message(message) => say(format_args!("error: {message}")),
            Self::CannotTell(message) => {
                say(format_args!("cannot be determined from the data: {message}"))
            }
            Self::Input { error, text } => {
                say(format_args!("error: {error}"));
                if io::stderr().is_terminal()
                    && let Some(excerpt) = excerpt(error, text)
                {
                    let _ = writeln!(io::stderr(), "{excerpt}");
                }
            }
        }
    }
}

/// What a text is that holds numbers where a model was expected.
fn numbers(name: &str, text: &str) -> Option<&'static str> {
    // Units and step that a file states itself must not be given.
    let units = [None, record::Units::parse("g")];
    let mut options = units.into_iter().flat_map(|units| {
        [None, Some(1.0)].map(|dt_s| record::Options { units, dt_s, format: None })
    });
    let is_record = options.any(|options| record::read(name, text.as_bytes(), &options).is_ok());
    let columns = record::columns(name, text.as_bytes()).is_ok_and(|table| table.columns.len() > 1);
    if is_record { Some("a record") } else { columns.then_some("a table of numbers") }
}

/// A message to standard error, what would steer the terminal made visible. Where nobody can be told,
/// nobody is: that is no reason to stop.
pub fn say(message: fmt::Arguments<'_>) {
    let text = message.to_string();
    let lines: Vec<String> = text.split('\n').map(visible).collect();
    let _ = writeln!(io::stderr(), "{}", lines.join("\n"));
}

/// The line that an error points to, underlined; nothing where the error lies outside the text.
fn excerpt(error: &InputError, text: &str) -> Option<String> {
    let place = &error.place;
    let name = &place.source_name;
    if name.is_empty() || name.starts_with("--set") || text.get(place.span.clone()).is_none() {
        return None;
    }
    let renderer = match std::env::var_os("NO_COLOR") {
        Some(value) if !value.is_empty() => Renderer::plain(),
        _ => Renderer::styled(),
    };
    let label = visible(&format!("expected {}", error.expected));
    let name = visible(name);
    let snippet = Snippet::source(text)
        .path(&name)
        .annotation(AnnotationKind::Primary.span(place.span.clone()).label(&label));
    Some(renderer.render(&[Level::ERROR.primary_title(&error.found).element(snippet)]))
}

impl From<ChoiceError> for Failure {
    fn from(error: ChoiceError) -> Self {
        Self::Message(FrontEnd::Command.says(&error).to_string())
    }
}

/// An error of an analysis that has no model text to point into.
impl From<AssessmentError> for Failure {
    fn from(error: AssessmentError) -> Self {
        match error {
            AssessmentError::Choice(error) => error.into(),
            other => Self::Message(other.to_string()),
        }
    }
}

impl From<LaboratoryError> for Failure {
    fn from(error: LaboratoryError) -> Self {
        match error {
            LaboratoryError::Choice(error) => error.into(),
            other => Self::Message(other.to_string()),
        }
    }
}

impl From<StudyError> for Failure {
    fn from(error: StudyError) -> Self {
        match error {
            StudyError::Input { error, text } => Self::Input { error, text },
            other => Self::Message(other.to_string()),
        }
    }
}

impl From<FileError> for Failure {
    fn from(error: FileError) -> Self {
        Self::Message(error.to_string())
    }
}

impl Failure {
    /// What became of writing to standard output.
    pub fn stdout(source: io::Error) -> Self {
        if source.kind() == io::ErrorKind::BrokenPipe {
            Self::ClosedPipe
        } else {
            FileError::Write { path: PathBuf::from("standard output"), source }.into()
        }
    }
}

/// Text to standard output, ended by a line feed. What would steer the terminal is written as JSON and TOML
/// write it in texts, `\u001b`.
pub fn print(text: &str) -> Result<(), Failure> {
    let mut shown = String::with_capacity(text.len() + 1);
    for character in text.chars() {
        if is_hidden(character) && !matches!(character, '\n' | '\t') {
            shown.push_str(&format!("\\u{:04x}", u32::from(character)));
        } else {
            shown.push(character);
        }
    }
    if !shown.ends_with('\n') {
        shown.push('\n');
    }
    let mut out = io::stdout().lock();
    out.write_all(shown.as_bytes()).and_then(|()| out.flush()).map_err(Failure::stdout)
}
