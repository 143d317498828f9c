//! Which rows of a table are kept, how they fall into groups, and over what they average.

use super::columns::{Columns, Records};
use super::intensity::dimension;
use crate::assessment::{AssessmentError, refuse};
use crate::input::dimension_of;
use crate::numerics::sort;
use crate::table::{Cells, Table};
use crate::units::{Dimension, parse_quantity};

/// Designs that a result averages over.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Averaged {
    /// The paths that vary.
    pub paths: Vec<String>,
    /// Number of designs; 1 where nothing varies.
    pub designs: usize,
}

impl core::fmt::Display for Averaged {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "averaged over {}: {} designs", self.paths.join(", "), self.designs)
    }
}

/// The rows of one value.
pub(super) struct DesignGroup {
    pub(super) value: f64,
    pub(super) text: String,
    pub(super) rows: Vec<usize>,
}

/// Most curves that one figure shows.
const MOST_GROUPS: usize = 24;
/// Values closer than this share of them are one.
const SAME: f64 = 1e-9;

/// The designs of a table, numbered, and the paths that tell them apart.
pub(super) fn designs(
    columns: Columns<'_>,
) -> Result<(Vec<String>, Option<Records>), AssessmentError> {
    let mut paths = Vec::new();
    let mut values: Vec<Vec<f64>> = Vec::new();
    for column in &columns.table.columns {
        let cells = match &column.cells {
            Cells::Texts(texts) if column.name == FRICTION => numbered(texts),
            _ if is_path(&column.name) => columns.numbers_or_nan(&column.name)?,
            _ => continue,
        };
        let first = cells.first().map(|value| value.to_bits());
        if cells.iter().any(|value| Some(value.to_bits()) != first) {
            paths.push(column.name.clone());
            values.push(cells);
        }
    }
    if paths.is_empty() {
        return Ok((paths, None));
    }
    let key = |row: usize| values.iter().map(|cells| cells[row].to_bits()).collect::<Vec<_>>();
    let designs = Records::numbered((0..columns.table.rows()).map(key));
    Ok((paths, Some(designs)))
}

/// The column that names the bound of friction of a run.
pub const FRICTION: &str = "friction";

/// Texts as numbers, the same for the same text.
fn numbered(texts: &[String]) -> Vec<f64> {
    let mut known: Vec<&String> = texts.iter().collect();
    known.sort_unstable();
    known.dedup();
    let number = |text: &String| known.partition_point(|other| *other < text) as f64;
    texts.iter().map(number).collect()
}

pub(super) fn averaged(columns: Columns<'_>) -> Result<Averaged, AssessmentError> {
    let (paths, designs) = designs(columns)?;
    Ok(Averaged { paths, designs: designs.map_or(1, |designs| designs.count) })
}

/// Whether a column is a path of models.
fn is_path(name: &str) -> bool {
    name == "isolator.period" || name.contains('.') && dimension_of(name).is_ok()
}

/// The rows that satisfy all conditions; `None` where there are no conditions.
pub(super) fn keep(
    columns: Columns<'_>,
    conditions: &[String],
) -> Result<Option<Table>, AssessmentError> {
    if conditions.is_empty() {
        return Ok(None);
    }
    Ok(Some(columns.table.select(&kept(columns, conditions)?)))
}

/// The numbers of the rows that satisfy all conditions.
pub(super) fn kept(
    columns: Columns<'_>,
    conditions: &[String],
) -> Result<Vec<usize>, AssessmentError> {
    let mut kept: Vec<usize> = (0..columns.table.rows()).collect();
    for condition in conditions {
        let Some((path, wanted)) = condition.split_once('=') else {
            let found = format!("{condition:?}");
            return Err(refuse("where", "PATH=VALUE or PATH=FROM..TO", found));
        };
        let (path, wanted) = (path.trim(), wanted.trim());
        if let Some(texts) = texts_of(columns, "where", path)? {
            kept.retain(|&row| texts[row].trim() == wanted);
        } else {
            let values = columns.numbers_or_nan(path)?;
            let [low, high] = range(columns, path, wanted)?;
            let slack = |end: f64| SAME * end.abs();
            let inside = |v: f64| low - slack(low) <= v && v <= high + slack(high);
            kept.retain(|&row| inside(values[row]));
        }
        if kept.is_empty() {
            let expected = format!("a value that occurs in {}", columns.source_name);
            return Err(refuse(&format!("where {path}"), expected, format!("{wanted:?}")));
        }
    }
    Ok(kept)
}

/// The rows of each value of a column, in rising order, and the SI unit of the values.
pub(super) fn groups(
    columns: Columns<'_>,
    by: &str,
) -> Result<(Vec<DesignGroup>, String), AssessmentError> {
    let mut groups: Vec<DesignGroup> = Vec::new();
    if let Some(texts) = texts_of(columns, "by", by)? {
        for (row, text) in texts.iter().enumerate() {
            match groups.iter_mut().find(|group| group.text == *text) {
                Some(group) => group.rows.push(row),
                None => groups.push(DesignGroup {
                    value: f64::NAN,
                    text: text.clone(),
                    rows: vec![row],
                }),
            }
            few_enough(columns, by, &groups)?;
        }
    } else {
        for (row, value) in columns.numbers_or_nan(by)?.into_iter().enumerate() {
            let near = |group: &&mut DesignGroup| {
                (group.value - value).abs() <= SAME * value.abs()
                    || (group.value.is_nan() && value.is_nan())
            };
            match groups.iter_mut().find(near) {
                Some(group) => group.rows.push(row),
                None => groups.push(DesignGroup { value, text: String::new(), rows: vec![row] }),
            }
            few_enough(columns, by, &groups)?;
        }
        sort(&mut groups, |a, b| a.value.total_cmp(&b.value));
    }
    Ok((groups, unit_of(columns, by)))
}

fn few_enough(
    columns: Columns<'_>,
    by: &str,
    groups: &[DesignGroup],
) -> Result<(), AssessmentError> {
    if groups.len() <= MOST_GROUPS {
        return Ok(());
    }
    let expected = format!(
        "a column of {} with at most {MOST_GROUPS} values; `where` {by}=FROM..TO takes a part of it",
        columns.source_name
    );
    Err(refuse("by", expected, format!("{by:?} with more")))
}

/// The texts of a column that holds no numbers.
fn texts_of<'a>(
    columns: Columns<'a>,
    what: &str,
    name: &str,
) -> Result<Option<&'a [String]>, AssessmentError> {
    let Some(column) = columns.table.find(name) else {
        return Err(columns.lacking(what, name));
    };
    let Cells::Texts(texts) = &column.cells else { return Ok(None) };
    // Every cell of CSV is a text.
    let numbers = is_path(name) || columns.numbers_or_nan(name).is_ok();
    Ok((!numbers).then_some(&texts[..]))
}

/// What the values of a column measure.
fn dimension_of_column(columns: Columns<'_>, name: &str) -> Option<Dimension> {
    match dimension_of(name) {
        Ok(dimension) => dimension,
        Err(_) if name == "isolator.period" => Some(Dimension::Time),
        Err(_) => dimension(&columns.unit(name)?),
    }
}

fn unit_of(columns: Columns<'_>, name: &str) -> String {
    let dimension = dimension_of_column(columns, name);
    dimension.map_or("", |dimension| dimension.units()[0].name()).to_owned()
}

/// The ends of a range, or a value twice, in SI.
fn range(columns: Columns<'_>, path: &str, text: &str) -> Result<[f64; 2], AssessmentError> {
    let dimension = dimension_of_column(columns, path);
    let value = |text: &str| match dimension {
        Some(dimension) => parse_quantity(text, dimension).map_err(|error| {
            let crate::error::UnitError { expected, found, .. } = error;
            refuse(&format!("where {path}"), expected, found)
        }),
        None => text.trim().parse::<f64>().ok().filter(|v| v.is_finite()).ok_or_else(|| {
            refuse(&format!("where {path}"), "a number or FROM..TO", format!("{text:?}"))
        }),
    };
    let Some((from, to)) = text.split_once("..") else {
        let value = value(text)?;
        return Ok([value; 2]);
    };
    let (from, to) = (from.trim(), to.trim());
    // The unit of the range stands at its end: 1..2 m.
    let unit = to.trim_start_matches(|c: char| c.is_ascii_digit() || "+-.eE".contains(c)).trim();
    let bare = from.parse::<f64>().is_ok();
    let from = if bare { format!("{from} {unit}") } else { from.to_owned() };
    let ends = [value(from.trim())?, value(to)?];
    if ends[0] <= ends[1] {
        return Ok(ends);
    }
    Err(refuse(&format!("where {path}"), "a range that rises", format!("{text:?}")))
}
