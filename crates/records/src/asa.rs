//! Standard acceleration file (ASA) 2.0 of the Instituto de Ingeniería, UNAM, Mexico.
//!
//! 109 lines of Spanish keys and values, of which those of channels are lists such as
//! `/V/N90E/N00E`, then a row a sample with one column a channel, usually F10.3, in gal.

use super::component::azimuth;
use super::fixed::{Cursor, Fields};
use super::keys::{self, Field, Keys};
use super::text::{Line, Text};
use super::{Channel, FilterCorners, Format, Options, Record, RecordError, Sampling, to_si};
use slipstick_dynamics::notice::{Notice, NoticeKind};

/// Lines among which the data are looked for.
const MAX_HEADER_LINES: usize = 200;
/// Title before the columns' names.
const DATA: &str = "DATOS DE ACELERACION";

/// Whether the title of the format and its keys are there.
pub(super) fn recognises(text: &Text) -> bool {
    let title = |line: Line| line.find("ARCHIVO ESTANDAR DE ACELERACION", 0).is_some();
    text.lines().take(30).any(title)
}

/// Reads the file: a channel a column.
pub(super) fn read(text: &Text, options: &Options) -> Result<Record, RecordError> {
    let mut cursor = Cursor::new(text);
    let mut header = Keys { lines: vec![] };
    while header.lines.last().is_none_or(|line| line.find(DATA, 0) != Some(0)) {
        let expected = format!("\"{DATA}:\" in the header");
        if header.lines.len() == MAX_HEADER_LINES {
            return Err(text.error_at_start(expected, "none"));
        }
        header.lines.push(cursor.next(&expected)?);
    }
    // A rule, the numbers and the names of the columns, a rule.
    let titles = cursor.take(4, "the names of the columns")?;
    if titles[3].find("----", 0) != Some(0) {
        let expected = "a rule \"----\" between the names of the columns and the values";
        return Err(text.error(&titles[3], 0, expected, &titles[3].trimmed()));
    }
    let channels = header.required(text, "NUMERO DE CANALES")?;
    let n = channels.positive(text, "a number of channels")? as usize;
    let names = list(&header, "ORIENTACION");
    if !(1..=12).contains(&n) || names.len() != n {
        let expected = format!("as many channels as orientations, {}", names.len());
        return Err(channels.error(text, expected));
    }
    let steps = list(&header, "INTERVALO DE MUESTREO");
    let counts = list(&header, "NUM. TOTAL DE MUESTRAS");
    let (Some(first_step), Some(first_count)) = (steps.first(), counts.first()) else {
        let expected = "\"INTERVALO DE MUESTREO\" and \"NUM. TOTAL DE MUESTRAS\" in the header";
        return Err(channels.error(text, expected));
    };
    let dt_s = first_step.step(text, "a time step > 0 s", options)?;
    let what = "a number of samples";
    let mut rows = 0;
    for (i, (step, count)) in steps.iter().zip(&counts).enumerate() {
        rows = count.count(text, what)?.max(rows);
        if i < n && step.positive(text, "a time step > 0 s")? != dt_s {
            return Err(step.error(text, "the same step for all channels"));
        }
    }
    if steps.len() != n || counts.len() != n {
        let field = if steps.len() == n { first_count } else { first_step };
        return Err(field.error(text, format!("a list of {n} numbers")));
    }
    let units = units(text, &header, options)?;
    let fields = header.get("FORMATO DATOS").or_else(|| colon(&header, "FORMATO DATOS"));
    let fields = fields.and_then(|f| Fields::parse(&f.text()?)).filter(|f| f.per_line == n);
    let fields = fields.unwrap_or(Fields::new(n, 10));
    let announced = first_count.line;
    let table = cursor.values(fields, n * rows, &announced)?;
    let last = table.get(n * (rows - 1)..).unwrap_or_default();
    let extra = extra_rows(&mut cursor, last, rows, &announced)?;

    let stated = list(&header, "ACEL. MAX.(Gal)");
    let durations = list(&header, "DURACION DEL REGISTRO");
    let rates = list(&header, "VEL. DE MUESTREO");
    let event = keys::join(&[
        header.text("FECHA DEL SISMO [GMT]"),
        header.text("HORA EPICENTRO (GMT)"),
        header.text("MAGNITUD(ES)").map(|m| m.trim_matches('/').to_owned()),
    ]);
    let station =
        keys::join(&[header.text("CLAVE DE LA ESTACION"), header.text("NOMBRE DE LA ESTACION")]);
    let mut all = Vec::with_capacity(n);
    for (i, name) in names.iter().enumerate() {
        let count = counts[i].count(text, what)?;
        let values: Vec<f64> = table.iter().skip(i).step_by(n).take(count).copied().collect();
        let mut warnings: Vec<Notice> = extra.clone().into_iter().collect();
        // Peaks are stated in gal, whatever the values are.
        let gal: Vec<f64> = values.iter().map(|v| v * units.si() / 0.01).collect();
        warnings.extend(keys::check_peak(text, stated.get(i), &gal, "gal", keys::PEAK_FACTOR)?);
        warnings.extend(keys::check_duration(durations.get(i), count, dt_s));
        if let Some((field, (rate, digit))) = rates.get(i).and_then(|f| Some((f, f.number()?)))
            && (rate * dt_s - 1.0).abs() > 0.501 * digit * dt_s + 1e-6
        {
            return Err(field.error(text, format!("the rate of a step of {dt_s} s")));
        }
        let name = name.text().unwrap_or_else(|| (i + 1).to_string());
        all.push(Channel {
            name: name.clone(),
            event: event.clone(),
            station: station.clone(),
            azimuth_deg: azimuth(&name),
            component: Some(name),
            units,
            values: to_si(values, &units),
            sampling: Sampling::Dt(dt_s),
            filter: FilterCorners::default(),
            warnings,
        });
    }
    let layout = "UNAM ASA 2.0".to_owned();
    Ok(Record { format: Format::Asa, layout, channels: all, warnings: vec![] })
}

/// What follows the first colon on a line that begins with a key.
fn colon<'a>(header: &Keys<'a>, key: &str) -> Option<Field<'a>> {
    let line = header.lines.iter().find(|line| line.find(key, 0) == Some(0))?;
    // Keys name units and formats in brackets, which hold no colon.
    Some(Field::from(*line, line.find(":", 0)? + 1))
}

/// The parts of the lists of a key, of channels 1 to 6 and then of 7 to 12.
fn list<'a>(header: &Keys<'a>, key: &str) -> Vec<Field<'a>> {
    let of_key = |line: &&Line| {
        let rest = line.find(key, 0) == Some(0);
        rest && line.find("EN LA MUESTRA", 0).is_none()
    };
    let fields = header.lines.iter().filter(of_key).filter_map(|line| {
        let field = Field::from(*line, line.find(":", 0)? + 1);
        Some(field.split(b'/').into_iter().skip(1).collect::<Vec<_>>())
    });
    let parts = fields.flatten();
    parts.filter(|part| !part.at.is_empty()).collect()
}

/// Units: `Gal (cm/s/s)`.
fn units(text: &Text, header: &Keys, options: &Options) -> Result<super::Units, RecordError> {
    let field = header.required(text, "UNIDADES DE LOS DATOS")?;
    field.first_word().units(text, options)
}

/// A warning where rows follow those announced, all alike the last of them: some files repeat it.
///
/// # Errors
/// For a row that is another.
fn extra_rows(
    cursor: &mut Cursor,
    last: &[f64],
    rows: usize,
    announced: &Line,
) -> Result<Option<Notice>, RecordError> {
    let mut extra = 0;
    while let Some(line) = cursor.peek() {
        let words = line.words().map(|word| cursor.text.number(&line, &word).ok());
        let row: Option<Vec<f64>> = words.collect();
        if row.as_deref() != Some(last) {
            break;
        }
        extra += 1;
        cursor.next("")?;
    }
    keys::end(cursor, rows, announced)?;
    Ok((extra > 0).then(|| {
        Notice::new(
            NoticeKind::DuplicateRows,
            format!(
                "{extra} rows past the {rows} that line {} states repeat the last one: left out",
                announced.number
            ),
        )
    }))
}
