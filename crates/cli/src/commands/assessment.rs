//! What spectrum, ida, fragility and design share: model and records in, sheets and tables out.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use slipstick::assessment::models::Models;
use slipstick::assessment::suite::{Scaling, Suite};
use slipstick::assessment::{AssessmentError, ChoiceError};
use slipstick::input::{self, Analysis, Bound, FrictionBounds, Override};
use slipstick::motion::intensity::Measure;
use slipstick::response::{Method, Warning};
use slipstick::study::engine::Engine;
use slipstick::table::Table;
use slipstick_files::{
    OpenJob, OpenSuite, OutputFolder, SuiteError, SuiteRequest, on_threads, sha256_hex, to_csv,
    to_parquet,
};
use slipstick_report::assessment::{Sheet, Went, key};
use slipstick_report::{FileNote, InputText};

use super::compare::name as model_name;
use super::run::{ModelFile, command_line, overrides, read_model, tell_replaced};
use crate::args::{BoundsArgs, BoundsName, ResultArgs, ScaleArgs, SuiteArgs};
use crate::failure::{Failure, print, say};
use crate::progress::counted;

/// A model and its suite, read.
pub struct Opened {
    pub file: ModelFile,
    pub name: String,
    pub analysis: Analysis,
    overrides: Vec<Override>,
    pub suite: Suite,
    /// What reading the records gave notice of.
    pub warnings: Vec<Warning>,
    sources: Vec<(String, String, String)>,
}

impl Opened {
    /// Reads the model and the records, or the model's own motion.
    pub fn open(args: &SuiteArgs) -> Result<Self, Failure> {
        Self::open_with(args, || open_records(args))
    }

    /// Reads the model, then the records by `records`; the model's own motion where it gives none.
    pub fn open_with(
        args: &SuiteArgs,
        records: impl FnOnce() -> Result<Option<OpenSuite>, Failure>,
    ) -> Result<Self, Failure> {
        let file = read_model(&args.model)?;
        let overrides = overrides(&args.set, None)?;
        let analysis = input::from_bytes(&file.name, &file.bytes, &overrides)
            .map_err(|error| Failure::input(error, &file.text()))?;
        tell_replaced(&file, &overrides, &analysis, args.result.quiet);
        if analysis.method != Method::Exact {
            let expected = "the exact method, which is the only one over a suite";
            let error = analysis.error_at("analysis.method", expected, "\"stepwise\"");
            return Err(Failure::input(error, &file.text()));
        }
        let name = model_name(&file, analysis.name.as_deref());
        let OpenSuite { suite, sources, warnings } = match records()? {
            Some(records) => records,
            None => {
                let job = OpenJob::new(&file.path, analysis.clone(), None)
                    .map_err(|error| Failure::job(error, &file.name, &file.text()))?;
                let made = job.loaded.sources.is_empty();
                let record = job.loaded.description.join("; ");
                OpenSuite::single(&record, job.loaded, made)
            }
        };
        Ok(Self { file, name, analysis, overrides, suite, warnings, sources })
    }

    /// The models of a grid, from options `(name, PATH=VALUES)`.
    pub fn models(&self, options: &[(&str, String)]) -> Result<Models, Failure> {
        let coupled = options.iter().any(|(option, _)| *option == "friction");
        let text = self.file.text();
        Models::new(&self.file.name, &text, &self.overrides, options, coupled)
            .map_err(|error| self.failure(error))
    }

    /// The bounds of friction to run; none for a model without them.
    pub fn bounds(&self, args: BoundsArgs) -> Result<Vec<Bound>, Failure> {
        let wanted = match args.bounds {
            BoundsName::All => None,
            BoundsName::Lower => Some("lower"),
            BoundsName::Nominal => Some("nominal"),
            BoundsName::Upper => Some("upper"),
        };
        FrictionBounds::chosen(self.analysis.friction_bounds, wanted)
            .map_err(|error| choice(&error))
    }

    /// An error of an analysis, with the model's text where it points into that.
    pub fn failure(&self, error: AssessmentError) -> Failure {
        match error {
            AssessmentError::Input(error) => Failure::input(error, &self.file.text()),
            other => failure(other),
        }
    }

    /// Runs something on the threads asked for, with a sign of life.
    pub fn compute<T: Send>(
        &self,
        args: &SuiteArgs,
        work: impl FnOnce(&Engine<'_>) -> Result<T, AssessmentError> + Send,
    ) -> Result<T, Failure> {
        let work = |engine: &Engine<'_>| on_threads(jobs(args), || work(engine));
        counted("computing", args.result.quiet, work).map_err(|error| self.failure(error))
    }

    /// Files that went in, model first.
    pub fn sources(&self) -> Vec<(String, String, String)> {
        let model = (self.file.name.clone(), sha256_hex(&self.file.bytes), "model".to_owned());
        std::iter::once(model).chain(self.sources.iter().cloned()).collect()
    }

    /// The folder for the results, refused where it would replace an input.
    pub fn folder(&self, args: &ResultArgs) -> Result<Option<OutputFolder>, Failure> {
        let inputs: Vec<PathBuf> =
            self.sources().into_iter().map(|(path, ..)| path.into()).collect();
        folder(args, &inputs)
    }

    /// Text of the model, as the report shows it.
    pub fn inputs(&self) -> Vec<(String, String)> {
        vec![(self.file.name.clone(), self.file.text())]
    }
}

/// Reads the records that are asked for; `None` where none are.
pub fn open_records(args: &SuiteArgs) -> Result<Option<OpenSuite>, Failure> {
    open_pairs(args, &[])
}

/// The same with the other components of pairs.
pub fn open_pairs(args: &SuiteArgs, second: &[String]) -> Result<Option<OpenSuite>, Failure> {
    if args.records.is_empty() {
        return Ok(None);
    }
    let request = SuiteRequest { second: second.to_vec(), ..suite_request(args)? };
    let read = |engine: &Engine<'_>| on_threads(jobs(args), || OpenSuite::open(&request, engine));
    let opened =
        counted("reading records", args.result.quiet, read).map_err(|error| match error {
            SuiteError::Choice(error) => choice(&error),
            SuiteError::File(error) => error.into(),
            SuiteError::Stopped(error) => Failure::Message(error.to_string()),
        })?;
    Ok(Some(opened))
}

/// The number of threads asked for.
fn jobs(args: &SuiteArgs) -> Option<usize> {
    args.jobs.map(usize::from)
}

/// An error of an analysis that has no model text to point into.
pub fn failure(error: AssessmentError) -> Failure {
    match error {
        AssessmentError::Choice(error) => choice(&error),
        other => Failure::Message(other.to_string()),
    }
}

/// What was chosen wrongly is an option of the command: only here does it get its dashes.
pub fn choice(error: &ChoiceError) -> Failure {
    let dashes = if error.what == SOURCE { "" } else { "--" };
    Failure::Message(format!("{dashes}{error}"))
}

/// The one choice that is no option.
const SOURCE: &str = "SOURCE";

/// The folder for results, made before any work is done.
pub fn folder(args: &ResultArgs, inputs: &[PathBuf]) -> Result<Option<OutputFolder>, Failure> {
    Ok(args.out.as_deref().map(|out| OutputFolder::create(out, inputs)).transpose()?)
}

fn suite_request(args: &SuiteArgs) -> Result<SuiteRequest, Failure> {
    args.record.only_with("--records <PATTERN>", !args.records.is_empty())?;
    let options = args.record.options(true)?;
    Ok(SuiteRequest {
        patterns: args.records.clone(),
        second: Vec::new(),
        vertical: args.vertical.clone(),
        units: options.units,
        dt_s: options.dt_s,
        channel: options.channel,
    })
}

/// How the records are scaled, and that in words.
pub fn scaling(args: &ScaleArgs) -> Result<(Scaling, String), Failure> {
    scaling_by("level", &args.measure, args.level.as_deref(), args.scale)
}

/// The same, the level being that of an option.
pub fn scaling_by(
    option: &str,
    name: &str,
    level: Option<&str>,
    factor: Option<f64>,
) -> Result<(Scaling, String), Failure> {
    let Some(level) = level else {
        let factor = factor.unwrap_or(1.0);
        if !(factor.is_finite() && factor != 0.0) {
            return Err(message("--scale", "a factor other than 0", &factor.to_string()));
        }
        let words = if factor == 1.0 { " as recorded".to_owned() } else { format!(" × {factor}") };
        return Ok((Scaling::Factor(factor), words));
    };
    Scaling::to_level(option, measure(name)?, level).map_err(failure)
}

/// A measure by its name.
pub fn measure(name: &str) -> Result<Measure, Failure> {
    Measure::parse(name).map_err(|error| Failure::Message(format!("--measure: {error}")))
}

/// A limit > 0 on a demand: with the unit that its key ends in, or a bare number.
pub fn limit(option: &str, text: &str, demand: &str) -> Result<f64, Failure> {
    key::limit(option, text, demand).map_err(|error| Failure::Message(error.to_string()))
}

/// A share strictly between 0 and 1.
pub fn share(option: &str, value: f64) -> Result<f64, Failure> {
    let inside = value > 0.0 && value < 1.0;
    if inside {
        Ok(value)
    } else {
        Err(message(option, "a share between 0 and 1", &value.to_string()))
    }
}

/// What was expected of an option, and what was found.
pub fn message(option: &str, expected: &str, found: &str) -> Failure {
    Failure::Message(format!("{option}: expected {expected}, found {found:?}"))
}

/// Writes tables, figures, summary and report, and prints the result; status 1 where it is not complete.
pub fn conclude(
    args: &ResultArgs,
    folder: Option<OutputFolder>,
    sheet: &Sheet,
    tables: &[(&str, &Table)],
    sources: &[(String, String, String)],
    inputs: &[(String, String)],
) -> Result<ExitCode, Failure> {
    if let Some(mut folder) = folder {
        folder.replaces(&["history.csv", "events.csv"]);
        for (name, table) in tables {
            match name.rsplit_once('.') {
                Some((_, "parquet")) => folder.write(name, &to_parquet(Path::new(name), table)?)?,
                _ => folder.write(name, to_csv(table).as_bytes())?,
            }
        }
        for figure in &sheet.figures {
            folder.write(&format!("{}.svg", figure.id), figure.svg.as_str().as_bytes())?;
        }
        let files: Vec<FileNote> = sources
            .iter()
            .map(|(path, sha256, description)| FileNote { path, sha256, description })
            .collect();
        let inputs: Vec<InputText> =
            inputs.iter().map(|(path, text)| InputText { path, text }).collect();
        let went = Went { command_line: &command_line(), files: &files, inputs: &inputs };
        folder.write("summary.json", sheet.to_json().as_bytes())?;
        folder.write("report.html", sheet.to_html(&went).as_bytes())?;
        folder.commit()?;
    }
    print(&if args.json { sheet.to_json() } else { sheet.to_text() })?;
    let status = ExitCode::from(u8::from(!sheet.complete));
    if args.quiet {
        return Ok(status);
    }
    if args.json {
        for warning in &sheet.warnings {
            say(format_args!("warning: {}: {}", warning.kind, warning.message));
        }
    }
    if let Some(out) = &args.out {
        say(format_args!("wrote {}", out.join("report.html").display()));
    }
    Ok(status)
}
