//! Text that SeismoSignal and SeismoMatch export: a line that names the accelerogram, a line
//! `Time Step: 0.02 s`, names of the columns `Time(sec)`, `Acc(g)`, and the columns.

use super::text::{Line, Text};
use super::volume::stated_number;
use super::{Channel, Format, Options, Record, RecordError, Sampling, delimited};

/// Lines among which the export's own are looked for.
const HEADER_LINES: usize = 10;

/// Whether a line names an accelerogram and another its step; or the spectra of one follow.
pub(super) fn recognises(text: &Text) -> bool {
    let has = |key: &str| text.lines().take(HEADER_LINES).any(|line| line.find(key, 0).is_some());
    has("ACCELEROGRAM:") && (has("TIME STEP") || has("PERIOD [SEC]"))
}

/// Reads the columns as delimited text and compares their times with the step that is stated.
pub(super) fn read(text: &Text, options: &Options) -> Result<Record, RecordError> {
    let header: Vec<Line> = text.lines().take(HEADER_LINES).collect();
    let line = |key: &str| header.iter().find_map(|line| Some((*line, line.find(key, 0)?)));
    if let Some((line, at)) = line("PERIOD [SEC]") {
        return Err(text.error(&line, at, "a time history, not a spectrum", &line.trimmed()));
    }
    let Some((step_line, at)) = line("TIME STEP") else {
        return Err(text.error_at_start("a line \"Time Step: … s\"", "none"));
    };
    let Some(step) = stated_number(&step_line, at + 9).filter(|step| step.value > 0.0) else {
        let end = step_line.bytes.len()..step_line.bytes.len();
        return Err(text.error_at(&step_line, &end, "a time step > 0 s"));
    };
    let mut record = delimited::read(text, options)?;
    let name = line("ACCELEROGRAM:").and_then(|(line, at)| {
        let name = line.str(&(at + 13..line.bytes.len())).trim().to_owned();
        (!name.is_empty()).then_some(name)
    });
    for Channel { event, sampling, .. } in &mut record.channels {
        *event = name.clone();
        let agrees =
            matches!(sampling, Sampling::Dt(dt_s) if (*dt_s - step.value).abs() <= 1e-6 * *dt_s);
        if !agrees {
            let found = match sampling {
                Sampling::Dt(dt_s) => format!("{dt_s} s"),
                Sampling::Times(_) => "uneven times".to_owned(),
            };
            let expected = format!("the step of the times below, {found}");
            return Err(text.error_at(&step_line, &step.word, expected));
        }
    }
    record.format = Format::SeismoSignal;
    record.layout = "SeismoSignal text".to_owned();
    Ok(record)
}
