//! Keys set in a model's text, all else as it stands: comments, blanks, the order of the keys.
//!
//! By hand rather than by `toml_edit`, which writes ends of lines anew and moves dotted keys: see `decisions.md`
//! of the book.

use std::ops::Range;

use super::keys::MODEL;
use super::overrides::kind_of;
use super::reader::{LeafValue, Values};
use super::schema::Kind;
use super::tree::{self, Node, Sources, TomlTable, Value};
use super::{Override, build, write};
use crate::error::InputError;
use crate::numerics::sort;

/// A model's text with keys set in it, in their order; keys that exclude a new one are taken out.
/// The model is checked with all of them set, not in between.
///
/// What is not set stays as it was written, comments included. Where the text has no room for a key (a
/// table in braces over several lines, say), it is written anew from its values.
///
/// # Errors
/// [`InputError`], the one of [`parse`](super::parse) with the same keys set.
///
/// # Examples
/// ```
/// use slipstick::input::{Override, with_keys};
///
/// let text = "[block]\nmass = \"325 kg\"\n[slider]\nstatic_friction = 0.02 # measured\n\
///             kinetic_friction = 0.012\nradius = \"2 m\"\n";
/// let set = [Override::parse("slider.static_friction=0.03")?, Override::parse("slider.spring=19 kN/m")?];
/// let expected = "[block]\nmass = \"325 kg\"\n[slider]\nstatic_friction = 0.03 # measured\n\
///                 kinetic_friction = 0.012\nspring = \"19 kN/m\"\n";
/// assert_eq!(with_keys("model.toml", text, &set)?, expected);
/// # Ok::<(), slipstick::error::InputError>(())
/// ```
pub fn with_keys(source_name: &str, text: &str, set: &[Override]) -> Result<String, InputError> {
    if set.is_empty() {
        return Ok(text.to_owned());
    }
    let wanted = read(source_name, text, set)?;
    let in_place = |text: String, one: &Override| edited(source_name, &text, one);
    let edited = set
        .iter()
        .try_fold(text.to_owned(), in_place)
        .filter(|edited| read(source_name, edited, &[]).is_ok_and(|found| alike(&found, &wanted)));
    Ok(edited.unwrap_or_else(|| write::toml(&wanted, write::Motion::AsWritten)))
}

/// The checked values of a text with keys set.
fn read(source_name: &str, text: &str, set: &[Override]) -> Result<Values, InputError> {
    let (mut sources, mut root) = tree_of(source_name, text)?;
    for one in set {
        one.apply(&mut sources, &mut root)?;
    }
    let values = Values::read(sources, &root, &MODEL)?;
    build::analysis(values.clone())?;
    Ok(values)
}

fn tree_of(source_name: &str, text: &str) -> Result<(Sources, TomlTable), InputError> {
    let mut sources = Sources::default();
    let file = sources.add(source_name, text);
    let root = tree::parse_document(&sources, file)?;
    Ok((sources, root))
}

/// Whether two texts say the same.
fn alike(a: &Values, b: &Values) -> bool {
    let said = |values: &Values| -> Vec<(String, LeafValue)> {
        values.leaves.iter().map(|leaf| (leaf.path.clone(), leaf.given.clone())).collect()
    };
    said(a) == said(b)
}

/// The text with one key set in place; `None` where there is no place.
fn edited(source_name: &str, text: &str, set: &Override) -> Option<String> {
    let (_, before) = tree_of(source_name, text).ok()?;
    let literal = literal(set)?;
    if let Some(node) = find(&before, set.path())
        && matches!(node.value, Value::Text(_) | Value::Number(..))
    {
        return Some(replaced(text, node.spot.span.clone(), &literal));
    }
    let (head, name) = set.path().rsplit_once('.')?;
    let line = format!("{name} = {literal}");
    if let Some(list) = next_of(&before, head) {
        return Some(at_the_end(text, &format!("[[{list}]]\n{line}")));
    }
    let (mut sources, mut after) = tree_of(source_name, text).ok()?;
    set.apply(&mut sources, &mut after).ok()?;
    let mut gone = Vec::new();
    taken_out(&before, &after, &mut gone);
    // In the place of what it excludes, else below the last key of its table.
    let mut edits: Vec<(Range<usize>, String)> = Vec::new();
    for (i, span) in gone.iter().enumerate() {
        let lines = whole_lines(text, span)?;
        let instead = if i == 0 { format!("{line}\n") } else { String::new() };
        edits.push((lines, instead));
    }
    if edits.is_empty() {
        edits.push(match find(&before, head) {
            Some(node) => {
                let Value::Table(table) = &node.value else { return None };
                let last = table.0.iter().map(|entry| entry.node.spot.span.end).max();
                let end = end_of_line(text, last.unwrap_or(node.spot.span.end));
                (end..end, format!("\n{line}"))
            }
            None if head.contains('.') => return None,
            None => return Some(at_the_end(text, &format!("[{head}]\n{line}"))),
        });
    }
    sort(&mut edits, |a, b| a.0.start.cmp(&b.0.start));
    let mut text = text.to_owned();
    for (span, new) in edits.into_iter().rev() {
        text = replaced(&text, span, &new);
    }
    Some(text)
}

/// The list that a path would make one item longer: `storey` of `storey.3` where there are two.
fn next_of<'a>(root: &TomlTable, path: &'a str) -> Option<&'a str> {
    let (list, number) = path.split_once('.')?;
    let Kind::Sections(..) = kind_of(list)? else { return None };
    let count = match root.get(list).map(|entry| &entry.node.value) {
        None => 0,
        Some(Value::List(items)) => items.len(),
        Some(_) => return None,
    };
    (number == (count + 1).to_string()).then_some(list)
}

fn at_the_end(text: &str, table: &str) -> String {
    format!("{}\n\n{table}\n", text.trim_end())
}

fn replaced(text: &str, span: Range<usize>, new: &str) -> String {
    let (before, after) = (text.get(..span.start), text.get(span.end..));
    format!("{}{new}{}", before.unwrap_or(""), after.unwrap_or(""))
}

/// The value of an option as TOML.
fn literal(set: &Override) -> Option<String> {
    let (_, value) = set.text().split_once('=')?;
    let value = value.trim();
    match tree::parse_value(value, 0, 0).value {
        Value::Number(..) => Some(value.to_owned()),
        Value::Text(text) => Some(write::quoted(&text)),
        _ => None,
    }
}

/// What stands at a path, storeys counted from 1.
fn find<'a>(root: &'a TomlTable, path: &str) -> Option<&'a Node> {
    let mut keys = path.split('.');
    let mut node = &root.get(keys.next()?)?.node;
    for key in keys {
        node = match &node.value {
            Value::Table(table) => &table.get(key)?.node,
            Value::List(items) => items.get(key.parse::<usize>().ok()?.checked_sub(1)?)?,
            _ => return None,
        };
    }
    Some(node)
}

/// Where the keys stand that the first table has and the second has not.
fn taken_out(before: &TomlTable, after: &TomlTable, gone: &mut Vec<Range<usize>>) {
    for entry in &before.0 {
        let Some(other) = after.get(&entry.name) else {
            gone.push(entry.key.span.start..entry.node.spot.span.end);
            continue;
        };
        match (&entry.node.value, &other.node.value) {
            (Value::Table(a), Value::Table(b)) => taken_out(a, b, gone),
            (Value::List(a), Value::List(b)) => {
                for (a, b) in a.iter().zip(b) {
                    if let (Value::Table(a), Value::Table(b)) = (&a.value, &b.value) {
                        taken_out(a, b, gone);
                    }
                }
            }
            _ => {}
        }
    }
}

/// The lines of a key that has them to itself.
fn whole_lines(text: &str, span: &Range<usize>) -> Option<Range<usize>> {
    let start = text.get(..span.start)?.rfind('\n').map_or(0, |newline| newline + 1);
    let end = end_of_line(text, span.end);
    let after = text.get(span.end..end)?.trim_start();
    let alone = text.get(start..span.start)?.trim().is_empty();
    let ends = after.is_empty() || after.starts_with('#');
    (alone && ends).then_some(start..(end + 1).min(text.len()))
}

fn end_of_line(text: &str, from: usize) -> usize {
    text.get(from..).and_then(|rest| rest.find('\n')).map_or(text.len(), |newline| from + newline)
}

#[cfg(test)]
mod tests {
    use super::*;

    const MODEL: &str = "# A tank.\nname = \"Tank\"\n\n[block]\nmass = \"325 kg\" # weighed\n\n\
        [slider]\nstatic_friction  = 0.06\nkinetic_friction = 0.05\nradius = \"2 m\"  # bought\n\
        gap = \"150 mm\"\n\n[[storey]]\nmass = \"201 kg\"\nfrequency = \"2.15 Hz\"\n\
        damping_ratio = 0.01\n\n[motion]\nsine = { frequency = \"1 Hz\", amplitude = \"1 m/s2\", \
        duration = \"2 s\", dt = \"0.01 s\" }\n";

    fn set(options: &[&str]) -> String {
        let options: Vec<_> = options.iter().map(|text| Override::parse(text).unwrap()).collect();
        let edited = with_keys("model.toml", MODEL, &options).unwrap();
        let wanted = read("model.toml", MODEL, &options).unwrap();
        assert!(alike(&read("model.toml", &edited, &[]).unwrap(), &wanted), "{edited}");
        edited
    }

    #[test]
    fn value_is_replaced_where_it_stands() {
        let edited = set(&["slider.kinetic_friction=0.04", "block.mass=400 kg"]);
        let expected = MODEL.replace("0.05", "0.04").replace("325 kg", "400 kg");
        assert_eq!(edited, expected);
    }

    #[test]
    fn value_in_braces_and_of_a_storey() {
        let edited = set(&["motion.sine.frequency=1.5 Hz", "storey.1.mass=300 kg"]);
        assert_eq!(edited, MODEL.replace("\"1 Hz\"", "\"1.5 Hz\"").replace("201 kg", "300 kg"));
    }

    #[test]
    fn excluded_key_gives_its_line() {
        let edited = set(&["slider.spring=19 kN/m"]);
        assert_eq!(edited, MODEL.replace("radius = \"2 m\"  # bought", "spring = \"19 kN/m\""));
    }

    #[test]
    fn new_key_and_new_table() {
        let edited = set(&["slider.tilt=1 mrad", "analysis.tail=5 s"]);
        let expected = MODEL.replace("gap = \"150 mm\"\n", "gap = \"150 mm\"\ntilt = \"1 mrad\"\n");
        assert_eq!(edited, format!("{expected}\n[analysis]\ntail = \"5 s\"\n"));
    }

    #[test]
    fn keys_that_hold_only_together_are_set_together() {
        let edited = set(&["slider.kinetic_friction=0.08", "slider.static_friction=0.09"]);
        assert_eq!(edited, MODEL.replace("0.05", "0.08").replace("0.06", "0.09"));
    }

    #[test]
    fn contents_are_added_key_by_key() {
        let keys = ["floor=1", "mass=20 kg", "static_friction=0.3", "kinetic_friction=0.25"];
        let of = |number: usize| keys.map(|key| format!("contents.{number}.{key}"));
        let both = [of(1), of(2)].concat();
        let edited = set(&both.iter().map(String::as_str).collect::<Vec<_>>());
        let block = "\n[[contents]]\nfloor = 1\nmass = \"20 kg\"\nstatic_friction = 0.3\n\
            kinetic_friction = 0.25\n";
        assert_eq!(edited, format!("{MODEL}{block}{block}"));
        let options = of(1).map(|key| Override::parse(&key).unwrap());
        let wrong = with_keys("m", MODEL, &options[..2]).unwrap_err().to_string();
        assert!(wrong.contains("contents.1"), "{wrong}");
    }

    #[test]
    fn what_has_no_room_is_written_anew() {
        let text = MODEL.replace("0.05", "{ positive = 0.05, negative = 0.04 }");
        let options = [Override::parse("slider.kinetic_friction.positive=0.03").unwrap()];
        assert!(with_keys("m", &text, &options).unwrap().contains("{ positive = 0.03,"));
        let options = [Override::parse("motion.pulse.duration=1 s").unwrap()];
        assert!(with_keys("m", &text, &options).is_err());
    }
}
