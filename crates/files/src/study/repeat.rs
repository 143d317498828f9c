//! The command that reproduces a row.

use slipstick::error::is_hidden;
use slipstick::input::plan::Records;

use super::{OpenStudy, StudyError};

impl OpenStudy {
    /// The `slipstick run` line that gives the demands of a run, bit for bit; paths are relative to
    /// the folder that the plan's path is relative to. With bounds of friction it runs all of them, and
    /// a comment says which is the row's.
    ///
    /// # Errors
    /// [`StudyError::OutOfRange`] for a run that the study does not have.
    pub fn repeat(&self, run: u64) -> Result<String, StudyError> {
        let runs = self.study.runs();
        if run >= runs {
            return Err(StudyError::OutOfRange {
                expected: format!("a run from 0 to {}", runs.saturating_sub(1)),
                found: run.to_string(),
            });
        }
        let case = self.study.case(run);
        let mut words = vec!["slipstick".to_owned(), "run".to_owned()];
        words.push(self.model_path.display().to_string());
        let mut set = Vec::new();
        if let Some(records) = &self.plan.records {
            self.record(case.record, case.scale, records, (&mut words, &mut set));
        }
        let varied = self.study.overrides(&case);
        set.extend(varied.map_err(|error| StudyError::input(error, ""))?);
        for pair in set {
            words.extend(["--set".to_owned(), pair]);
        }
        let line = words.iter().map(|word| quoted(word)).collect::<Vec<_>>().join(" ");
        Ok(match self.study.bound(&case).name {
            "nominal" => line,
            name => {
                format!("{line}  # the row is that of {name} friction, bounds.{name} of --json")
            }
        })
    }

    /// The record by the options of `run`; with other components, which those do not have, by
    /// the keys of the model, whose paths start at the model's folder.
    fn record(
        &self,
        index: usize,
        factor: f64,
        records: &Records,
        (words, set): (&mut Vec<String>, &mut Vec<String>),
    ) {
        // The components of a pair stand beside each other.
        let components = 1 + usize::from(self.study.is_in_plane());
        let beside = self.record_paths.get(index * components..).unwrap_or_default();
        let Some((paths, others)) = beside.split_first() else { return };
        let along_y = others.first().filter(|_| components == 2).map(|other| &other.horizontal);
        let units = records.unit_name.clone();
        let dt = records.dt_s.map(|dt_s| format!("{dt_s:?} s"));
        if along_y.is_none() && paths.vertical.is_none() {
            let mut option = |name: &str, value: Option<String>| {
                if let Some(value) = value {
                    words.extend([name.to_owned(), value]);
                }
            };
            option("--motion", Some(paths.horizontal.display().to_string()));
            option("--units", units);
            option("--dt", dt);
            option("--channel", records.channel.clone());
            option("--scale", Some(format!("{factor:?}")));
            return;
        }
        let from_model = |path: &std::path::Path| {
            let absolute = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
            absolute.display().to_string()
        };
        set.push(format!("motion.record={}", from_model(&paths.horizontal)));
        let mut key = |name: &str, value: Option<String>| {
            if let Some(value) = value {
                set.push(format!("motion.{name}={value}"));
            }
        };
        key("units", units);
        key("dt", dt);
        key("channel", records.channel.clone());
        key("record_y", along_y.map(|path| from_model(path)));
        key("vertical", paths.vertical.as_deref().map(from_model));
        key("vertical_scale", records.vertical_scale.map(|scale| format!("{scale:?}")));
        key("scale", Some(format!("{factor:?}")));
    }
}

/// A word as a shell takes it, without characters that steer a terminal.
#[must_use]
pub fn quoted(word: &str) -> String {
    if word.chars().any(is_hidden) {
        let byte = |byte: &u8| match byte {
            b'\\' | b'\'' => format!("\\{}", char::from(*byte)),
            b' '..=b'~' => char::from(*byte).to_string(),
            other => format!("\\x{other:02x}"),
        };
        return format!("$'{}'", word.bytes().map(|b| byte(&b)).collect::<String>());
    }
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./=,+:@%".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        return word.to_owned();
    }
    format!("'{}'", word.replace('\'', r"'\''"))
}
