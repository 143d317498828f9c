//! `modes.csv`: the modes of a structure as a table, a row a mode.

use std::collections::BTreeSet;

use super::keys::MAX_MODES;
use super::tree::{Entry, Node, SourceSpan, Sources, TomlTable, Value};
use crate::error::{InputError, cut, similar};

/// What a column holds.
#[derive(Clone, Debug, PartialEq)]
enum Column {
    /// A key of the mode, and the factor that makes SI of it where it has a unit.
    Mode(&'static str, bool),
    /// The shape at a point of this name along an axis, by its key.
    Point(String, &'static str),
    /// What counts rows: nothing of it is needed.
    Other,
}

/// A cell: its text and where it stands.
struct Cell<'a> {
    text: &'a str,
    spot: SourceSpan,
}

/// Columns of a mode by their names: the key of a mode, and whether it has a unit.
const COLUMNS: [(&str, &str, bool); 16] = [
    ("period_s", "period", true),
    ("frequency_hz", "frequency", true),
    ("damping_ratio", "damping_ratio", false),
    ("participation_x", "participation", false),
    ("participation", "participation", false),
    ("effective_mass_x_kg", "effective_mass", true),
    ("effective_mass_kg", "effective_mass", true),
    ("effective_mass_x", "effective_mass", true),
    ("effective_mass", "effective_mass", true),
    ("effective_mass_ratio_x", "effective_mass_ratio", false),
    ("effective_mass_ratio", "effective_mass_ratio", false),
    ("participation_y", "participation_y", false),
    ("effective_mass_y_kg", "effective_mass_y", true),
    ("effective_mass_y", "effective_mass_y", true),
    ("effective_mass_ratio_y", "effective_mass_ratio_y", false),
    ("mode", "", false),
];

/// Names that are nearly right, and what was meant.
const UNITLESS: [&str; 2] = ["period", "frequency"];

/// Puts the modes of a table in the place of `structure.modes`, which names it.
pub(super) fn expand(
    sources: &mut Sources,
    root: &mut TomlTable,
    name: &str,
    text: &str,
) -> Result<(), InputError> {
    let source = sources.add(name, text);
    let Some(structure) = root.0.iter_mut().find(|entry| entry.name == "structure") else {
        return Ok(());
    };
    let Value::Table(structure) = &mut structure.node.value else { return Ok(()) };
    let Some(place) = structure.0.iter().position(|entry| entry.name == "modes") else {
        return Ok(());
    };
    if let Some(entry) = structure.get("mode") {
        let (expected, found) = ("only one of modes, mode", "\"mode\" besides \"modes\"");
        return Err(sources.error(&entry.key, "structure.mode", expected, found));
    }
    let key = structure.0.remove(place).key;
    let (columns, rows) = read(sources, source, text)?;
    let table = |columns: &[Column], row: &[(f64, Cell<'_>)]| {
        let entries = columns.iter().zip(row).filter_map(|(column, (value, cell))| {
            let Column::Mode(name, has_unit) = column else { return None };
            let (value, written) = (*value, cell.text.to_owned());
            let unit = match *name {
                "period" => " s",
                "frequency" => " Hz",
                "effective_mass" | "effective_mass_y" => " kg",
                _ => "",
            };
            let value = match has_unit {
                true => Value::Si(value, format!("{value:?}{unit}")),
                false => Value::Number(value, written),
            };
            let spot = cell.spot.clone();
            let node = Node { spot: spot.clone(), value };
            Some(Entry { name: (*name).to_owned(), key: spot, node })
        });
        let spot = row.first().map_or(SourceSpan::default(), |(_, cell)| cell.spot.clone());
        Node { spot, value: Value::Table(TomlTable(entries.collect())) }
    };
    let modes = rows.iter().map(|row| table(&columns, row)).collect();
    let spot = SourceSpan { source, span: 0..0 };
    let list = |name: &str, nodes: Vec<Node>| Entry {
        name: name.to_owned(),
        key: key.clone(),
        node: Node { spot: spot.clone(), value: Value::List(nodes) },
    };
    structure.0.push(list("mode", modes));
    if !structure.0.iter().any(|entry| entry.name == "point") {
        structure.0.push(list("point", Vec::new()));
    }
    for (c, column) in columns.iter().enumerate() {
        let Column::Point(name, key) = column else { continue };
        let shape = rows.iter().map(|row| {
            let (value, cell) = &row[c];
            Node { spot: cell.spot.clone(), value: Value::Number(*value, cell.text.to_owned()) }
        });
        let shape = list(key, shape.collect());
        let Some(Value::List(points)) = structure
            .0
            .iter_mut()
            .find(|entry| entry.name == "point")
            .map(|entry| &mut entry.node.value)
        else {
            continue;
        };
        let named = points.iter_mut().find_map(|node| match &mut node.value {
            Value::Table(table) if is_named(table, name) => Some(table),
            _ => None,
        });
        match named {
            Some(table) => {
                if let Some(entry) = table.get(key) {
                    let expected = "no shape beside that of the table of modes";
                    return Err(sources.error(&entry.key, "structure.point", expected, *key));
                }
                table.0.push(shape);
            }
            None => {
                let value = Value::Text(name.clone());
                let node = Node { spot: spot.clone(), value };
                let named = Entry { name: "name".to_owned(), key: spot.clone(), node };
                let value = Value::Table(TomlTable(vec![named, shape]));
                points.push(Node { spot: spot.clone(), value });
            }
        }
    }
    Ok(())
}

/// Whether a point has a name, in lower case and with `_` for spaces.
fn is_named(point: &TomlTable, name: &str) -> bool {
    let Some(Value::Text(own)) = point.get("name").map(|entry| &entry.node.value) else {
        return false;
    };
    let own = own.to_lowercase();
    own == name || own.replace(' ', "_") == name
}

type Rows<'a> = Vec<Vec<(f64, Cell<'a>)>>;

/// The columns of a text and its rows.
fn read<'a>(
    sources: &Sources,
    source: usize,
    text: &'a str,
) -> Result<(Vec<Column>, Rows<'a>), InputError> {
    let mut lines = lines(text);
    let (at, header) = lines.next().unwrap_or((0, ""));
    let separator = [';', '\t', ','].into_iter().find(|c| header.contains(*c)).unwrap_or(',');
    let names = cells(header, at, separator, source);
    let mut columns: Vec<Column> = Vec::with_capacity(names.len());
    let (mut known, mut points) = (BTreeSet::new(), BTreeSet::new());
    for cell in &names {
        let column = column(&cell.text.trim_matches('"').to_lowercase()).map_err(|expected| {
            let error = sources.error(&cell.spot, "", expected, format!("{:?}", cut(cell.text)));
            InputError {
                nearest: similar(cell.text, COLUMNS.into_iter().map(|column| column.0)),
                ..error
            }
        })?;
        let key = match &column {
            Column::Mode(key, _) => Some((*key).to_owned()),
            Column::Point(name, key) => {
                points.insert(name.clone());
                Some(format!("{name}.{key}"))
            }
            Column::Other => None,
        };
        if points.len() > MAX_MODES {
            let (expected, found) = (format!("at most {MAX_MODES} points"), "more");
            return Err(sources.error(&cell.spot, "", expected, found));
        }
        if key.is_some_and(|key| !known.insert(key)) {
            let found = format!("a second column {:?}", cut(cell.text));
            return Err(sources.error(&cell.spot, "", "each column once", found));
        }
        columns.push(column);
    }
    let has = |wanted: &[&str]| {
        columns.iter().any(|c| matches!(c, Column::Mode(key, _) if wanted.contains(key)))
    };
    for (wanted, expected) in [
        (&["period", "frequency"][..], "a column period_s or frequency_hz"),
        (
            &[
                "participation",
                "effective_mass",
                "effective_mass_ratio",
                "participation_y",
                "effective_mass_y",
                "effective_mass_ratio_y",
            ],
            "a column participation_x, effective_mass_kg or effective_mass_ratio, or one along y",
        ),
    ] {
        if !has(wanted) {
            let spot = SourceSpan { source, span: at..at };
            return Err(sources.error(&spot, "", expected, "none"));
        }
    }
    let mut rows = Vec::new();
    for (at, line) in lines {
        if rows.len() == MAX_MODES {
            let spot = SourceSpan { source, span: at..at };
            return Err(sources.error(&spot, "", format!("at most {MAX_MODES} modes"), "more"));
        }
        let row = cells(line, at, separator, source);
        if row.len() != columns.len() {
            let spot = SourceSpan { source, span: at..at };
            let expected = format!("{} values, as the header has", columns.len());
            return Err(sources.error(&spot, "", expected, row.len().to_string()));
        }
        let value = |(cell, column): (Cell<'a>, &Column)| {
            let text = match separator {
                ',' => cell.text.to_owned(),
                _ => cell.text.replace(',', "."),
            };
            let value = text.parse::<f64>().ok().filter(|value| value.is_finite());
            match (value, column) {
                (Some(value), _) => Ok((value, cell)),
                (None, Column::Other) => Ok((0.0, cell)),
                (None, _) => {
                    let found = format!("{:?}", cut(cell.text));
                    Err(sources.error(&cell.spot, "", "a finite number", found))
                }
            }
        };
        rows.push(row.into_iter().zip(&columns).map(value).collect::<Result<_, _>>()?);
    }
    if rows.is_empty() {
        let spot = SourceSpan { source, span: text.len()..text.len() };
        return Err(sources.error(&spot, "", "a row for each mode", "none"));
    }
    Ok((columns, rows))
}

/// Lines that are neither empty nor a comment, with where they begin.
fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let mut at = 0;
    let all = text.split_inclusive('\n').map(move |line| {
        let from = at;
        at += line.len();
        let whole = line.trim_end();
        let bare = whole.trim_start_matches('\u{feff}');
        (from + whole.len() - bare.len(), bare)
    });
    all.filter(|(_, line)| !line.trim().is_empty() && !line.trim_start().starts_with('#'))
}

fn cells(line: &str, at: usize, separator: char, source: usize) -> Vec<Cell<'_>> {
    let mut from = at;
    let cell = |part| {
        let text = str::trim(part);
        let start = from + part.len() - part.trim_start().len();
        from += part.len() + separator.len_utf8();
        Cell { text, spot: SourceSpan { source, span: start..start + text.len() } }
    };
    line.split(separator).map(cell).collect()
}

/// What a column of this name holds.
fn column(name: &str) -> Result<Column, String> {
    if let Some((_, key, has_unit)) = COLUMNS.iter().find(|column| column.0 == name) {
        return Ok(if key.is_empty() { Column::Other } else { Column::Mode(key, *has_unit) });
    }
    if UNITLESS.contains(&name) {
        return Err("its unit in the name: period_s or frequency_hz".to_owned());
    }
    for (suffix, key) in [("_x", "shape"), ("_y", "shape_y")] {
        if let Some(point) = name.strip_suffix(suffix).filter(|point| !point.is_empty()) {
            return Ok(Column::Point(point.to_owned(), key));
        }
    }
    Err("period_s, frequency_hz, damping_ratio, participation_x, effective_mass_kg, \
         effective_mass_ratio, the same along y as participation_y, effective_mass_y_kg, \
         effective_mass_ratio_y, or the shape at a point, NAME_x and NAME_y"
        .to_owned())
}
