//! Keys set from outside the file: `--set PATH=VALUE`, and the paths that a study varies.

use std::sync::Arc;

use super::keys::MODEL;
use super::modes;
use super::paths::{NearestKey, join, matching, nearest_key, several};
use super::schema::{Kind, Section};
use super::tree::{self, Entry, Node, SourceSpan, Sources, TomlTable, Value};
use crate::error::{InputError, cut};
use crate::units::Dimension;

/// A key set to a value.
#[derive(Clone, Debug, PartialEq)]
pub struct Override {
    /// `PATH=VALUE` as it was given, or as it would be.
    text: String,
    /// Where the value starts in it.
    value_at: usize,
    /// The value where it was given as a number, in SI where the key has a unit.
    number: Option<f64>,
    /// The option that gave it, for errors; empty where none did.
    option: String,
    /// What it does where the path is in a tree.
    put: Put,
    /// The table of modes that stands in the place of the file that the path names.
    modes: Option<Arc<str>>,
}

/// A value of a key: a number in SI, or text as a person writes it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum InputValue<'a> {
    /// A number, in SI where the key has a unit.
    Number(f64),
    /// Text, of a quantity with its unit: `"150 mm"`.
    Text(&'a str),
}

impl Override {
    /// Reads `PATH=VALUE`, where the path is keys joined by dots, storeys counted from 1, and the
    /// value is TOML if it reads as TOML, else text: `slider.gap=150 mm` needs no quotes.
    ///
    /// # Errors
    /// [`InputError`] for text without `=`, and for a path that no model has; it names the key alone.
    pub fn parse(text: &str) -> Result<Self, InputError> {
        Self::of_option("", text)
    }

    /// As [`Override::parse`], for an option of a command, which errors then name with its place.
    ///
    /// # Errors
    /// As [`Override::parse`].
    pub fn of_option(option: &str, text: &str) -> Result<Self, InputError> {
        let named = |what: String| match option {
            "" => what,
            option => format!("{option} {what}"),
        };
        let Some(equals) = text.find('=') else {
            let mut sources = Sources::default();
            let source = sources.add(&named(cut(text)), text);
            let spot = SourceSpan { source, span: text.len()..text.len() };
            return Err(sources.error(&spot, "", "PATH=VALUE", "no \"=\""));
        };
        let (text, option) = (text.to_owned(), option.to_owned());
        let (number, put, modes) = (None, Put::Set, None);
        let this = Self { text, value_at: equals + 1, number, option, put, modes };
        this.check_path()?;
        Ok(this)
    }

    /// Sets the key at a path to a number, in SI where the key has a unit.
    ///
    /// # Errors
    /// [`InputError`] for a path that no model has.
    pub fn number(path: &str, si_value: f64) -> Result<Self, InputError> {
        let unit = si_unit(path);
        let space = if unit.is_empty() { "" } else { " " };
        // `{:?}` is the shortest text that reads back as the same number.
        let text = format!("{path}={si_value:?}{space}{unit}");
        Self::given(path, text, Some(si_value))
    }

    /// Sets the key at a path to text as a person writes it.
    ///
    /// # Errors
    /// [`InputError`] for a path that no model has.
    pub fn text_value(path: &str, text: &str) -> Result<Self, InputError> {
        Self::given(path, format!("{path}={text}"), None)
    }

    /// Takes the key at a path out, with those that mean nothing without it; an item of a list too.
    ///
    /// # Errors
    /// [`InputError`] for a path that no model has.
    pub fn removal(path: &str) -> Result<Self, InputError> {
        Ok(Self { put: Put::Remove, ..Self::given(path, format!("{path}="), None)? })
    }

    /// The same where a list may become one item longer: a storey above the last.
    #[must_use]
    pub fn growing(self) -> Self {
        Self { put: Put::Grow, ..self }
    }

    /// Puts a table of modes in the place of `structure.modes`: its file's name, as errors call it, and its
    /// text.
    #[must_use]
    pub fn modes(name: &str, table: &str) -> Self {
        let path = "structure.modes";
        let (text, value_at) = (format!("{path}={name}"), path.len() + 1);
        let (number, option) = (None, String::new());
        Self { text, value_at, number, option, put: Put::Set, modes: Some(table.into()) }
    }

    /// Whether it is a table of modes, which sets no key of its own.
    #[must_use]
    pub fn is_modes(&self) -> bool {
        self.modes.is_some()
    }

    fn given(path: &str, text: String, number: Option<f64>) -> Result<Self, InputError> {
        let (value_at, option) = (path.len() + 1, String::new());
        let this = Self { text, value_at, number, option, put: Put::Set, modes: None };
        this.check_path()?;
        Ok(this)
    }

    /// The path that it sets.
    #[must_use]
    pub fn path(&self) -> &str {
        self.text.get(..self.value_at.saturating_sub(1)).unwrap_or("").trim()
    }

    /// It as it was given, `PATH=VALUE`.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    fn sources(&self) -> Sources {
        let mut sources = Sources::default();
        sources.add(&self.source_name(), &self.text);
        sources
    }

    /// What errors call the text: nothing where it is not an option's, so that they name the key
    /// alone.
    fn source_name(&self) -> String {
        match self.option.as_str() {
            "" => String::new(),
            option => format!("{option} {}=…", cut(self.path())),
        }
    }

    fn path_spot(&self, source: usize) -> SourceSpan {
        let start = self.text.len() - self.text.trim_start().len();
        SourceSpan { source, span: start..start + self.path().len() }
    }

    fn check_path(&self) -> Result<(), InputError> {
        let Err((expected, nearest)) = find_kind(self.path()) else { return Ok(()) };
        let found = format!("\"{}\"", cut(self.path()));
        let error = self.sources().error(&self.path_spot(0), "", expected, found);
        Err(InputError { nearest, ..error })
    }

    /// Sets the key in a tree; what excludes it is removed.
    pub(super) fn apply(
        &self,
        sources: &mut Sources,
        root: &mut TomlTable,
    ) -> Result<(), InputError> {
        match self.put {
            Put::Remove => self.take_out(sources, root),
            put => self.put(sources, root, put),
        }
    }

    fn take_out(&self, sources: &mut Sources, root: &mut TomlTable) -> Result<(), InputError> {
        let source = sources.add(&self.source_name(), &self.text);
        let spot = self.path_spot(source);
        let keys: Vec<&str> = self.path().split('.').collect();
        if taken_out(root, &MODEL, &keys) {
            return Ok(());
        }
        let found = format!("\"{}\"", cut(self.path()));
        Err(sources.error(&spot, self.path(), "a key that stands in the model", found))
    }

    /// The same where all lists are as long as they shall be.
    pub(super) fn replace(
        &self,
        sources: &mut Sources,
        root: &mut TomlTable,
    ) -> Result<(), InputError> {
        self.put(sources, root, Put::Replace)
    }

    /// Adds the key to a tree, in which nothing may exclude it.
    pub(super) fn add(
        &self,
        sources: &mut Sources,
        root: &mut TomlTable,
    ) -> Result<(), InputError> {
        self.put(sources, root, Put::Add)
    }

    fn put(&self, sources: &mut Sources, root: &mut TomlTable, put: Put) -> Result<(), InputError> {
        if let Some(table) = &self.modes {
            let name = self.text.get(self.value_at..).unwrap_or("");
            return modes::expand(sources, root, name, table);
        }
        self.check_path()?;
        let source = sources.add(&self.source_name(), &self.text);
        let value = self.text.get(self.value_at..).unwrap_or("");
        let value_at = self.value_at + (value.len() - value.trim_start().len());
        let node = match self.number {
            None => tree::parse_value(value.trim(), source, value_at),
            Some(number) => {
                let written = value.trim().to_owned();
                let spot = SourceSpan { source, span: value_at..value_at + written.len() };
                let value = match si_unit(self.path()) {
                    "" => Value::Number(number, written),
                    _ => Value::Si(number, written),
                };
                Node { spot, value }
            }
        };
        let spot = self.path_spot(source);
        let keys: Vec<&str> = self.path().split('.').collect();
        set(root, &MODEL, &keys, &spot, node, put)
            .map_err(|(expected, found)| sources.error(&spot, self.path(), expected, found))
    }
}

/// The SI unit of a number at a path; empty where it has none.
fn si_unit(path: &str) -> &'static str {
    match kind_of(path) {
        Some(
            Kind::Quantity(dimension, _)
            | Kind::QuantityOr(dimension, ..)
            | Kind::QuantityOrRatio(dimension, _)
            | Kind::Quantities(dimension, ..)
            | Kind::Vector(dimension, _)
            | Kind::Vectors(dimension, ..),
        ) => dimension.si_unit(),
        _ => "",
    }
}

/// The SI unit of a bare number that a program gives at a path; empty where a number is complete without one, where a
/// bare one is a ratio, and at a path that no model has.
#[must_use]
pub fn unit_of_bare(path: &str) -> &'static str {
    match find_kind(path) {
        Ok(Kind::QuantityOrRatio(..)) | Err(_) => "",
        Ok(_) => si_unit(path),
    }
}

/// The source of a model's own text; keys that are set have sources of their own.
const FILE: usize = 0;

/// How a key is set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Put {
    /// What excludes it is removed; lists keep their length.
    Replace,
    /// The same, but lists that the file does not have are made item by item.
    Set,
    /// The same, and the next item of any list is made.
    Grow,
    /// Nothing is removed; the next item of a list is made.
    Add,
    /// The key is taken out.
    Remove,
}

/// What the number at a path measures; `None` for a ratio.
///
/// # Errors
/// [`InputError`] for a path that no model has, and for one whose value is no number.
pub fn dimension_of(path: &str) -> Result<Option<Dimension>, InputError> {
    match find_kind(path) {
        Ok(
            Kind::Quantity(dimension, _)
            | Kind::QuantityOr(dimension, ..)
            | Kind::QuantityOrRatio(dimension, _)
            | Kind::Vector(dimension, _),
        ) => Ok(Some(*dimension)),
        Ok(Kind::Number(_) | Kind::NumberOr(..)) => Ok(None),
        found => {
            let set = Override::given(path, format!("{path}="), None)?;
            let expected = found.map_or(String::new(), |_| "a path to a number".to_owned());
            let place = set.path_spot(0);
            Err(set.sources().error(&place, "", expected, format!("\"{}\"", cut(path))))
        }
    }
}

/// What was expected and what was found.
type Mismatch = (String, String);

/// Sets the key at the end of a path of keys in a table.
fn set(
    table: &mut TomlTable,
    section: &'static Section,
    path: &[&str],
    spot: &SourceSpan,
    value: Node,
    put: Put,
) -> Result<(), Mismatch> {
    let [name, rest @ ..] = path else { return Ok(()) };
    let Some(key) = section.key(name) else { return Ok(()) };
    let as_table = !rest.is_empty() || matches!(value.value, Value::Table(_));
    if put != Put::Add {
        remove_excluded(table, section, name, as_table);
    }
    let index = table.0.iter().position(|entry| entry.name == *name);
    if rest.is_empty() {
        let entry = Entry { name: (*name).to_owned(), key: spot.clone(), node: value };
        match index.and_then(|index| table.0.get_mut(index)) {
            Some(existing) => *existing = entry,
            None => table.0.push(entry),
        }
        return Ok(());
    }
    let index = index.unwrap_or_else(|| {
        let empty = match key.kind.is_list() {
            true => Value::List(Vec::new()),
            false => Value::Table(TomlTable(Vec::new())),
        };
        let node = Node { spot: spot.clone(), value: empty };
        table.0.push(Entry { name: (*name).to_owned(), key: spot.clone(), node });
        table.0.len() - 1
    });
    let Some(entry) = table.0.get_mut(index) else { return Ok(()) };
    let made_here = entry.key.source != FILE;
    let grows = matches!(put, Put::Add | Put::Grow) || (put == Put::Set && made_here);
    // A value for both directions becomes a table of two before one of them is set.
    if let (Kind::NumberOr(_, both), Value::Number(..) | Value::Text(_))
    | (Kind::QuantityOr(_, _, both), Value::Text(_) | Value::Si(..)) =
        (&key.kind, &entry.node.value)
    {
        let same = entry.node.clone();
        let each = both.keys.iter().map(|key| Entry {
            name: key.name.to_owned(),
            key: entry.key.clone(),
            node: same.clone(),
        });
        entry.node.value = Value::Table(TomlTable(each.collect()));
    }
    match (&mut entry.node.value, key.kind.section()) {
        (Value::Table(inner), Some(section)) => set(inner, section, rest, spot, value, put),
        (Value::List(items), inner) => {
            set_item(items, inner, (name, rest), spot, value, (put, grows))
        }
        _ => Err((key.kind.expected(), entry.node.found())),
    }
}

/// Sets an item of a list of that name, or something inside it.
fn set_item(
    items: &mut Vec<Node>,
    inner: Option<&'static Section>,
    (name, path): (&str, &[&str]),
    spot: &SourceSpan,
    value: Node,
    (put, grows): (Put, bool),
) -> Result<(), Mismatch> {
    let [number, rest @ ..] = path else { return Ok(()) };
    if grows && *number == (items.len() + 1).to_string() {
        let empty = match inner {
            Some(_) => Value::Table(TomlTable(Vec::new())),
            None => Value::List(Vec::new()),
        };
        items.push(Node { spot: spot.clone(), value: empty });
    }
    let count = items.len();
    let item = number.parse::<usize>().ok().and_then(|n| items.get_mut(n.wrapping_sub(1)));
    match (item, inner) {
        (None, _) => {
            let expected = match count {
                0 => format!("{name}.1, for there is none yet"),
                _ if grows => format!("a number from 1 to {}", count + 1),
                1 => format!("{name}.1, for there is only one"),
                _ => format!("a number from 1 to {count}"),
            };
            Err((expected, format!("\"{number}\"")))
        }
        (Some(item), _) if rest.is_empty() => {
            *item = value;
            Ok(())
        }
        (Some(Node { value: Value::Table(inner), .. }), Some(section)) => {
            set(inner, section, rest, spot, value, put)
        }
        (Some(Node { value: Value::List(pair), .. }), None) => {
            set_item(pair, None, (number, rest), spot, value, (put, grows))
        }
        (Some(item), _) => Err(("a table".to_owned(), item.found())),
    }
}

/// Removes the keys that exclude the one about to be set, and those that mean nothing without them.
fn remove_excluded(table: &mut TomlTable, section: &'static Section, name: &str, as_table: bool) {
    for exclusive in section.choices {
        let is_set = |member: &&&str| match member.strip_suffix(".*") {
            Some(member) => as_table && member == name,
            None => **member == name,
        };
        if !exclusive.names.iter().any(|member| is_set(&member)) {
            continue;
        }
        for other in exclusive.names.iter().filter(|member| !is_set(member)) {
            if let Some(removed) = matching(table, other).map(|entry| entry.name.clone()) {
                remove(table, section, &removed);
            }
        }
    }
}

/// Removes a key and those that mean nothing without it.
fn remove(table: &mut TomlTable, section: &'static Section, name: &str) {
    table.0.retain(|entry| entry.name != name);
    for key in section.keys.iter().filter(|key| key.beside == Some(name)) {
        remove(table, section, key.name);
    }
}

/// Takes out what stands at the end of a path of keys; whether it stood there.
fn taken_out(table: &mut TomlTable, section: &'static Section, path: &[&str]) -> bool {
    let [name, rest @ ..] = path else { return false };
    let Some(entry) = table.0.iter_mut().find(|entry| entry.name == *name) else { return false };
    let inner = section.key(name).and_then(|key| key.kind.section());
    match (&mut entry.node.value, inner, rest) {
        (_, _, []) => remove(table, section, name),
        (Value::Table(table), Some(section), rest) => return taken_out(table, section, rest),
        (Value::List(items), inner, [number, rest @ ..]) => {
            let Some(item) = number.parse::<usize>().ok().and_then(|n| n.checked_sub(1)) else {
                return false;
            };
            if rest.is_empty() && item < items.len() {
                items.remove(item);
                if items.is_empty() {
                    remove(table, section, name);
                }
                return true;
            }
            return match (items.get_mut(item), inner) {
                (Some(Node { value: Value::Table(table), .. }), Some(section)) => {
                    taken_out(table, section, rest)
                }
                _ => false,
            };
        }
        _ => return false,
    }
    true
}

/// What the key at a path takes, if a model has it.
pub(super) fn kind_of(path: &str) -> Option<&'static Kind> {
    find_kind(path).ok()
}

/// As [`kind_of`]; else what was expected and the nearest path.
pub(super) fn find_kind(path: &str) -> Result<&'static Kind, (String, Option<String>)> {
    let mut section = &MODEL;
    let mut known = String::new();
    let mut keys = path.split('.').peekable();
    loop {
        let name = keys.next().unwrap_or("");
        let Some(key) = section.key(name) else {
            if let Some(expected) = several(name, section) {
                let inside = if known.is_empty() { String::new() } else { format!(" of {known}") };
                return Err((expected + &inside, None));
            }
            let nearest = nearest_key(name, section, &MODEL).map(|nearest| match nearest {
                NearestKey::Elsewhere(path) => path,
                NearestKey::Here(name) => valid_or_start(join(&known, name), keys),
            });
            return Err(("a path of the model".to_owned(), nearest));
        };
        known = join(&known, name);
        if keys.peek().is_none() {
            return Ok(&key.kind);
        }
        if key.kind.is_list() {
            let number = keys.next().unwrap_or("");
            if number.parse::<usize>().is_ok_and(|number| number > 0) {
                known = join(&known, number);
            } else {
                // The number was left out, or something else stands in its place.
                let first = join(&known, "1");
                let left_out = valid_or_start(join(&first, number), keys.clone());
                let nearest = match find_kind(&left_out) {
                    Ok(_) => left_out,
                    Err(_) => valid_or_start(first, keys),
                };
                return Err((format!("a number from 1 after {known}"), Some(nearest)));
            }
            let is_number = |key: &&str| key.parse::<usize>().is_ok_and(|number| number > 0);
            if matches!(key.kind, Kind::Vectors(..)) && keys.peek().is_some_and(is_number) {
                known = join(&known, keys.next().unwrap_or(""));
            }
            if keys.peek().is_none() {
                return Ok(&key.kind);
            }
        }
        let Some(inner) = key.kind.section() else {
            return Err((format!("no key inside {known}"), Some(known)));
        };
        section = inner;
    }
}

/// The corrected start of a path with the rest of it, where that is a path of the model; else the
/// start alone.
fn valid_or_start<'a>(start: String, rest: impl Iterator<Item = &'a str>) -> String {
    let mut whole = start.clone();
    for key in rest {
        whole.push('.');
        whole.push_str(key);
    }
    if find_kind(&whole).is_ok() { whole } else { start }
}
