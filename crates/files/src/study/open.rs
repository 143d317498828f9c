//! From the path of a plan to a study that can be run.

use std::path::{Path, PathBuf};

use slipstick::error::listed;
use slipstick::hash::sha256_hex;
use slipstick::input::plan::{Plan, Records, Target};
use slipstick::input::{self, MAX_TEXT_BYTES, MotionSource};
use slipstick::motion::target::TargetSpectrum;
use slipstick::notice::Notice;
use slipstick::record;
use slipstick::study::engine::Engine;
use slipstick::study::{Record, Study};

use super::StudyError;
use crate::error::FileError;
use crate::globs::{expand, named_twice};
use crate::load::{LoadedMotion, RecordRequest, VerticalRequest, load_record};
use crate::read::{modes_beside, read_at_most, read_bytes, resolve};
use crate::records::PARQUET;
use crate::run::request;
use crate::table::{read_table, to_csv};
use crate::unfit::refuse_unfit;

/// A study with all its inputs read.
#[derive(Debug)]
pub struct OpenStudy {
    /// The plan.
    pub plan: Plan,
    /// Its runs.
    pub study: Study,
    /// Path of the plan as it was given.
    pub plan_path: PathBuf,
    /// Path of the model file.
    pub model_path: PathBuf,
    /// Every file that was read, named as plan and model name it, and its hash: the plan, the
    /// model, then the records.
    pub inputs: Vec<(String, String)>,
    /// Hash of the version and of all inputs: parts of one study have the same.
    pub id: String,
    /// The text of the plan.
    pub plan_text: String,
    /// Paths of the records, in the order of the study's.
    pub(super) record_paths: Vec<RecordPaths>,
    /// What a person should know before it runs.
    pub notices: Vec<String>,
}

/// Where a record and its vertical component are.
#[derive(Clone, Debug, Default)]
pub(super) struct RecordPaths {
    pub horizontal: PathBuf,
    pub vertical: Option<PathBuf>,
}

impl OpenStudy {
    /// Reads a plan, its model and its records.
    ///
    /// # Errors
    /// [`StudyError`] for a plan or a model that cannot be understood, and for records that are
    /// missing or are none; all that are missing are named.
    pub fn open(plan_path: &Path) -> Result<Self, StudyError> {
        Self::open_followed(plan_path, &Engine::unwatched())
    }

    /// The same on the threads of the caller's pool; the engine is told of every record.
    ///
    /// # Errors
    /// As [`OpenStudy::open`], and where it is stopped.
    pub fn open_followed(plan_path: &Path, engine: &Engine<'_>) -> Result<Self, StudyError> {
        Self::open_knowing(plan_path, &[], engine)
    }

    /// The same where more is known of records, by their names, than their files tell: that is noticed of them
    /// instead, and where it is something else the study is another one.
    ///
    /// # Errors
    /// As [`OpenStudy::open_followed`].
    pub fn open_knowing(
        plan_path: &Path,
        known: &[(String, Vec<Notice>)],
        engine: &Engine<'_>,
    ) -> Result<Self, StudyError> {
        let plan_name = plan_path.display().to_string();
        let plan_bytes = read_at_most(plan_path, MAX_TEXT_BYTES as u64)?;
        let plan_text = String::from_utf8_lossy(&plan_bytes).into_owned();
        let in_plan = |error| StudyError::input(error, &plan_text);
        let plan = Plan::from_bytes(&plan_name, &plan_bytes).map_err(in_plan)?;
        let folder = plan_path.parent().unwrap_or(Path::new(""));
        let model_path = resolve(folder, &plan.model);
        let model_bytes = read_at_most(&model_path, MAX_TEXT_BYTES as u64).map_err(|error| {
            let expected = "a model file that can be read";
            in_plan(plan.error_at("model", expected, error.to_string()))
        })?;
        let mut model_text = String::from_utf8_lossy(&model_bytes).into_owned();
        let modes = modes_beside(&model_path, &portable(&plan.model), &model_bytes)
            .map_err(|error| StudyError::input(error, &model_text))?;
        if let Some(modes) = modes {
            // The study reads one text: that of the model with its modes in it.
            let analysis = input::parse(&portable(&plan.model), &model_text, &[modes])
                .map_err(|error| StudyError::input(error, &model_text))?;
            model_text = analysis.to_toml_with_motion();
        }
        let in_model = |error| StudyError::input(error, &model_text);
        let mut inputs = vec![
            (file_name(plan_path), sha256_hex(&plan_bytes)),
            (portable(&plan.model), sha256_hex(&model_bytes)),
        ];
        let mut notices = Vec::new();
        let mut loaded = match &plan.records {
            Some(records) => load_all(&plan, records, folder, &in_plan, &mut notices, engine)?,
            None => own_record(&plan, &model_path, model_text.as_bytes(), &in_model)?,
        };
        let beyond_files = know(&mut loaded, known);
        let mut records = Vec::new();
        let mut record_paths = Vec::new();
        let mut target = None;
        if let Some(Records { target: Some((Target::File(path), _)), .. }) = &plan.records {
            let (read, sha256) = read_target(&resolve(folder, path)).map_err(|error| {
                let expected = "a spectrum: a CSV with the columns period_s and sa_g";
                in_plan(plan.error_at("records.target", expected, error))
            })?;
            inputs.push((portable(path), sha256));
            target = Some(read);
        }
        let pairs = plan.records.as_ref().is_some_and(|records| !records.second.is_empty());
        for (index, Loaded { name, vertical_name, paths, loaded }) in loaded.into_iter().enumerate()
        {
            let names = [Some(name.clone()), vertical_name].into_iter().flatten();
            inputs.extend(names.zip(loaded.sources.iter().map(|source| source.sha256.clone())));
            records.push(Record::read(name, loaded.loaded, pairs.then_some(index / 2)));
            record_paths.push(paths);
        }
        // The model's name in messages goes into rows: it is the one in the plan, on every machine.
        let name = portable(&plan.model);
        let study = Study::followed(&plan, &name, &model_text, records, target.as_ref(), engine)?;
        let study = study.map_err(|error| match &*error.place.source_name {
            name if name == plan_name => in_plan(error),
            _ => in_model(error),
        })?;
        let id = id(&inputs, &beyond_files, &study);
        let model_path = model_path.clone();
        let plan_path = plan_path.to_owned();
        Ok(Self {
            plan,
            study,
            plan_path,
            model_path,
            inputs,
            id,
            plan_text,
            record_paths,
            notices,
        })
    }
}

struct Loaded {
    name: String,
    vertical_name: Option<String>,
    paths: RecordPaths,
    loaded: LoadedMotion,
}

/// Puts what is known of records in place of what their files tell; what rows then say otherwise, as text.
fn know(records: &mut [Loaded], known: &[(String, Vec<Notice>)]) -> String {
    let mut beyond_files = String::new();
    for Loaded { name, loaded, .. } in records {
        let Some((_, notices)) = known.iter().find(|(known, _)| known == name) else { continue };
        if kinds(notices) != kinds(&loaded.warnings) {
            beyond_files.push_str(&format!("{name} {}\n", kinds(notices).join(" ")));
        }
        loaded.loaded.warnings.clone_from(notices);
    }
    beyond_files
}

/// All records of a plan.
fn load_all(
    plan: &Plan,
    records: &Records,
    folder: &Path,
    in_plan: &impl Fn(slipstick::error::InputError) -> StudyError,
    notices: &mut Vec<String>,
    engine: &Engine<'_>,
) -> Result<Vec<Loaded>, StudyError> {
    let files = find(plan, "records.files", &records.files, folder).map_err(in_plan)?;
    let second = find(plan, "records.second", &records.second, folder).map_err(in_plan)?;
    let alone = records.vertical.is_empty() && second.is_empty();
    let files = if alone { once(files, notices) } else { files };
    let count = (files.len(), "files");
    plan.one_each(("second", "other component"), second.len(), count).map_err(in_plan)?;
    let vertical = find(plan, "records.vertical", &records.vertical, folder).map_err(in_plan)?;
    plan.one_each(("vertical", "vertical motion"), vertical.len(), count).map_err(in_plan)?;
    let load = |index: usize| -> Result<Loaded, FileError> {
        // The components of a pair stand beside each other.
        let [pair, other] = if second.is_empty() { [index, 0] } else { [index / 2, index % 2] };
        let path = if other == 0 { files[pair].clone() } else { second[pair].clone() };
        let up = vertical.get(pair).cloned();
        let loaded = load_record(&RecordRequest {
            path: path.clone(),
            units: records.units,
            dt_s: records.dt_s,
            channel: records.channel.clone(),
            vertical: up.clone().map(|path| VerticalRequest {
                path,
                channel: None,
                factor: records.vertical_scale.unwrap_or(1.0),
            }),
            ..RecordRequest::default()
        })?;
        Ok(Loaded {
            name: name_from(folder, &path),
            vertical_name: up.as_deref().map(|path| name_from(folder, path)),
            paths: RecordPaths { horizontal: path, vertical: up },
            loaded,
        })
    };
    let all = engine.runs(files.len() + second.len(), load)?;
    let all = all.into_iter().collect::<Result<Vec<_>, FileError>>()?;
    let read: Vec<_> =
        all.iter().map(|one| (one.paths.horizontal.as_path(), &one.loaded.loaded)).collect();
    let pairs = !records.second.is_empty();
    notices.extend(refuse_unfit(&read, records.channel.is_some(), pairs)?);
    Ok(all)
}

/// What a file of a target spectrum holds.
pub const TARGET: &str = "a table of periods (T, Period) and spectral accelerations with their unit \
                          (Sa, PSA), such as the columns period_s and sa_g";

/// A target spectrum from such a table, CSV, text or Parquet, and the hash of its file.
///
/// # Errors
/// What is wrong with it, in words.
pub fn read_target(path: &Path) -> Result<(TargetSpectrum, String), String> {
    let text = |error: &dyn std::fmt::Display| error.to_string();
    let bytes = read_bytes(path).map_err(|error| text(&error))?;
    let sha256 = sha256_hex(&bytes);
    let table = match bytes.starts_with(PARQUET) {
        true => to_csv(&read_table(&[path.to_owned()]).map_err(|error| text(&error))?.table).into(),
        false => bytes,
    };
    let spectrum = record::target_spectrum(&path.display().to_string(), &table);
    Ok((spectrum.map_err(|error| text(&error))?, sha256))
}

/// Each file once, and a notice of those that are named more than once.
fn once(files: Vec<PathBuf>, notices: &mut Vec<String>) -> Vec<PathBuf> {
    let (mut kept, mut again): (Vec<PathBuf>, Vec<PathBuf>) = (Vec::new(), Vec::new());
    for file in files {
        let list = if kept.contains(&file) { &mut again } else { &mut kept };
        list.push(file);
    }
    again.dedup();
    notices.extend(named_twice(&again));
    kept
}

/// The files that patterns mean, in the order of the patterns; all that mean none are named at once.
fn find(
    plan: &Plan,
    place: &str,
    patterns: &[String],
    folder: &Path,
) -> Result<Vec<PathBuf>, slipstick::error::InputError> {
    let mut files = Vec::new();
    let mut missing = Vec::new();
    for pattern in patterns {
        match expand(folder, pattern) {
            Ok(found) => files.extend(found),
            Err(FileError::NoMatch { .. }) => missing.push(format!("\"{pattern}\"")),
            Err(error) => {
                return Err(plan.error_at(place, "files that can be read", error.to_string()));
            }
        }
    }
    if missing.is_empty() {
        return Ok(files);
    }
    let expected =
        format!("files beside the plan; {} of {} are missing", missing.len(), patterns.len());
    Err(plan.error_at(place, expected, format!("no {}", listed(missing))))
}

/// The model's own record, scaled as the model says, where it has one and the plan has none.
fn own_record(
    plan: &Plan,
    model_path: &Path,
    model_bytes: &[u8],
    in_model: &impl Fn(slipstick::error::InputError) -> StudyError,
) -> Result<Vec<Loaded>, StudyError> {
    let name = portable(&plan.model);
    // What is wrong with the model itself the study says, with the varied values in it.
    let Ok(analysis) = input::from_bytes(&name, model_bytes, &[]) else { return Ok(Vec::new()) };
    analysis.in_one_direction("a study varies").map_err(in_model)?;
    let Some(MotionSource::Record(source)) = &analysis.motion else { return Ok(Vec::new()) };
    let folder = model_path.parent().unwrap_or(Path::new(""));
    let request = request(source, folder);
    let loaded = load_record(&request).map_err(|error| {
        in_model(analysis.error_at("motion.record", "a record that can be read", error.to_string()))
    })?;
    let paths = RecordPaths {
        horizontal: request.path,
        vertical: request.vertical.map(|vertical| vertical.path),
    };
    let vertical_name = source.vertical.as_deref().map(portable);
    Ok(vec![Loaded { name: portable(&source.path), vertical_name, paths, loaded }])
}

/// A record's path as the plan might have named it: relative to it, divided by `/`.
fn name_from(folder: &Path, path: &Path) -> String {
    portable(&path.strip_prefix(folder).unwrap_or(path).display().to_string())
}

fn portable(path: &str) -> String {
    path.replace('\\', "/")
}

fn file_name(path: &Path) -> String {
    path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned())
}

/// What rows say of notices.
fn kinds(notices: &[Notice]) -> Vec<&'static str> {
    notices.iter().map(|notice| notice.kind.name()).collect()
}

/// Hash of the version, of the inputs in their order, of the bounds of friction that are run, where the model
/// has some, and of how pairs are run: an earlier version ran the nominal friction alone, and each component by
/// itself. What is known of records besides their files is hashed as well.
fn id(inputs: &[(String, String)], beyond_files: &str, study: &Study) -> String {
    let mut text = format!("slipstick {}\n", env!("CARGO_PKG_VERSION"));
    // The plan's own name does not matter.
    for (index, (name, sha256)) in inputs.iter().enumerate() {
        let name = if index == 0 { "plan" } else { name };
        text.push_str(&format!("{sha256} {name}\n"));
    }
    if study.has_bounds() {
        let names: Vec<&str> = study.bounds().iter().map(|bound| bound.name).collect();
        text.push_str(&format!("friction {}\n", names.join(" ")));
    }
    if study.is_in_plane() {
        text.push_str("pairs together\n");
    }
    text.push_str(beyond_files);
    sha256_hex(text.as_bytes())
}
