//! Checks a tree against its description and gives its values by path.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::paths::{NearestKey, join, matching, nearest_key, several};
use super::schema::{Key, Kind, Range, Section};
use super::tree::{Entry, Node, SourceSpan, Sources, TomlTable, Value};
use crate::error::{InputError, UnitError, cut, similar};
use crate::numerics::sort;
use crate::record::{Quantity, Units};
use crate::units::{self, Unit};

/// What a key was given.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum LeafValue {
    /// A number, in SI where it has a unit.
    Number(f64),
    Text(String),
    Word(&'static str),
    Unit(&'static Unit),
}

/// A value, how it was written and where.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Leaf {
    pub path: String,
    pub given: LeafValue,
    pub written: String,
    /// The SI unit of the value, empty where it has none.
    pub unit: &'static str,
    pub spot: SourceSpan,
}

/// The checked values of a text by path, in the order of its description.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Values {
    pub leaves: Arc<Vec<Leaf>>,
    sources: Arc<Sources>,
    leaf_of_path: Arc<BTreeMap<String, usize>>,
    /// Tables and lists: where they stand and how many items a list has.
    tables: Arc<BTreeMap<String, (SourceSpan, usize)>>,
    /// What other readers are to judge, as it stands.
    specials: Arc<BTreeMap<String, Node>>,
    /// Numbers that took the place of those of leaves, by their index.
    replaced: Vec<(usize, f64)>,
    /// Whether the table moves in two horizontal directions by what comes from outside the text.
    pub in_plane: bool,
    root: Root,
}

/// The description of the whole text.
#[derive(Clone, Copy, Debug)]
struct Root(&'static Section);

impl Default for Root {
    fn default() -> Self {
        Self(&super::keys::MODEL)
    }
}

impl PartialEq for Root {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self.0, other.0)
    }
}

impl Values {
    /// Checks every key of a tree: known, not excluded, complete, of its type, unit and range.
    pub fn read(
        sources: Sources,
        root: &TomlTable,
        section: &'static Section,
    ) -> Result<Self, InputError> {
        let sources = Arc::new(sources);
        let mut values = Self { sources, root: Root(section), ..Self::default() };
        values.read_table("", &SourceSpan { source: 0, span: 0..0 }, root, section)?;
        Ok(values)
    }

    /// The number at a path, in SI.
    pub fn number(&self, path: &str) -> Option<f64> {
        let index = *self.leaf_of_path.get(path)?;
        if let Some((_, number)) = self.replaced.iter().find(|(of, _)| *of == index) {
            return Some(*number);
        }
        match self.leaves.get(index)?.given {
            LeafValue::Number(value) => Some(value),
            _ => None,
        }
    }

    /// The number at a path that must be there.
    pub fn required(&self, path: &str) -> Result<f64, InputError> {
        self.number(path).ok_or_else(|| self.error(path, "a number", "nothing"))
    }

    /// The text or word at a path.
    pub fn text(&self, path: &str) -> Option<&str> {
        match &self.leaf(path)?.given {
            LeafValue::Text(text) => Some(text),
            LeafValue::Word(word) => Some(word),
            _ => None,
        }
    }

    /// The value at a path.
    pub fn leaf(&self, path: &str) -> Option<&Leaf> {
        self.leaf_of_path.get(path).and_then(|index| self.leaves.get(*index))
    }

    /// Whether a key was given at a path.
    pub fn has(&self, path: &str) -> bool {
        self.leaf_of_path.contains_key(path) || self.tables.contains_key(path)
    }

    /// The number of items of the list at a path, 0 where there is none.
    pub fn count(&self, path: &str) -> usize {
        self.tables.get(path).map_or(0, |(_, count)| *count)
    }

    /// The numbers of a list in SI.
    pub fn numbers(&self, path: &str) -> Option<Vec<f64>> {
        let (_, count) = self.tables.get(path)?;
        Some((1..=*count).filter_map(|item| self.number(&format!("{path}.{item}"))).collect())
    }

    /// Components along x and y of a vector, in SI: a single number is along x.
    pub fn vector(&self, path: &str) -> Option<[f64; 2]> {
        let component = |i: usize| self.number(&format!("{path}.{i}"));
        match self.number(path) {
            Some(x) => Some([x, 0.0]),
            None => Some([component(1)?, component(2)?]),
        }
    }

    /// The same of a list of vectors.
    pub fn vectors(&self, path: &str) -> Option<Vec<[f64; 2]>> {
        let (_, count) = self.tables.get(path)?;
        (1..=*count).map(|item| self.vector(&format!("{path}.{item}"))).collect()
    }

    /// The texts of a list, or the one text that stands for it.
    pub fn texts(&self, path: &str) -> Option<Vec<String>> {
        if let Some(text) = self.text(path) {
            return Some(vec![text.to_owned()]);
        }
        let (_, count) = self.tables.get(path)?;
        let items = (1..=*count).filter_map(|item| self.text(&format!("{path}.{item}")));
        Some(items.map(str::to_owned).collect())
    }

    /// The value at a path that its own reader is to judge.
    pub fn special(&self, path: &str) -> Option<&Node> {
        self.specials.get(path)
    }

    /// Tells errors where a path stands that its own reader has found.
    pub fn mark(&mut self, path: &str, spot: &SourceSpan) {
        Arc::make_mut(&mut self.tables).insert(path.to_owned(), (spot.clone(), 0));
    }

    /// Replaces the number at a path; `false` where there is none.
    pub fn set_number(&mut self, path: &str, value: f64) -> bool {
        let Some(&index) = self.leaf_of_path.get(path) else { return false };
        if !matches!(self.leaves.get(index), Some(Leaf { given: LeafValue::Number(_), .. })) {
            return false;
        }
        match self.replaced.iter_mut().find(|(of, _)| *of == index) {
            Some((_, number)) => *number = value,
            None => self.replaced.push((index, value)),
        }
        true
    }

    /// An error at the value of a path or, where there is none, at the table that lacks it.
    pub fn error(
        &self,
        path: &str,
        expected: impl Into<String>,
        found: impl Into<String>,
    ) -> InputError {
        let nowhere = SourceSpan { source: 0, span: 0..0 };
        let mut at = path;
        loop {
            let here = self.leaf(at).map(|leaf| &leaf.spot);
            if let Some(spot) = here.or_else(|| self.tables.get(at).map(|(spot, _)| spot)) {
                return self.sources.error(spot, path, expected, found);
            }
            let Some((parent, _)) = at.rsplit_once('.') else { break };
            at = parent;
        }
        self.sources.error(&nowhere, path, expected, found)
    }

    /// An error at a place.
    pub fn error_spot(
        &self,
        spot: &SourceSpan,
        path: &str,
        expected: impl Into<String>,
        found: impl Into<String>,
    ) -> InputError {
        self.sources.error(spot, path, expected, found)
    }

    /// An error at the value of a path that says what was written there.
    pub fn wrong(&self, path: &str, expected: impl Into<String>) -> InputError {
        let found = self.leaf(path).map_or("nothing".to_owned(), |leaf| match leaf.given {
            // A number with a unit is text.
            LeafValue::Number(_) if leaf.unit.is_empty() => cut(&leaf.written),
            _ => format!("\"{}\"", cut(&leaf.written)),
        });
        self.error(path, expected, found)
    }

    /// Checks a table: every key known, none excluded by another, none missing, each of its type.
    pub fn read_table(
        &mut self,
        path: &str,
        spot: &SourceSpan,
        table: &TomlTable,
        section: &'static Section,
    ) -> Result<(), InputError> {
        Arc::make_mut(&mut self.tables).insert(path.to_owned(), (spot.clone(), 0));
        for entry in &table.0 {
            if section.key(&entry.name).is_none() {
                return Err(self.unknown_key(path, entry, section));
            }
        }
        self.check_exclusive(path, spot, table, section)?;
        for key in section.keys {
            let path = join(path, key.name);
            match table.get(key.name) {
                Some(entry) => {
                    self.check_beside(&path, entry, key, table, section)?;
                    self.read_node(&path, &entry.node, &key.kind)?;
                }
                None if key.required => {
                    let expected = match key.kind {
                        Kind::Section(_) => format!("a table [{path}]"),
                        _ => key.kind.expected(),
                    };
                    return Err(self.sources.error(spot, &path, expected, "nothing"));
                }
                None => {}
            }
        }
        Ok(())
    }

    fn read_node(
        &mut self,
        path: &str,
        node: &Node,
        kind: &'static Kind,
    ) -> Result<(), InputError> {
        match (kind, &node.value) {
            (Kind::Section(section) | Kind::NumberOr(_, section), Value::Table(table)) => {
                self.read_table(path, &node.spot, table, section)
            }
            (Kind::QuantityOr(_, _, section), Value::Table(table)) => {
                self.read_table(path, &node.spot, table, section)?;
                if table.0.is_empty() {
                    let expected =
                        format!("one of the keys {} or both", section.names().join(", "));
                    return Err(self.sources.error(&node.spot, path, expected, "an empty table"));
                }
                Ok(())
            }
            (Kind::Sections(section, most), Value::List(nodes)) => {
                self.begin_list(path, node, nodes, *most)?;
                for (index, item) in nodes.iter().enumerate() {
                    let path = join(path, &(index + 1).to_string());
                    let Value::Table(table) = &item.value else {
                        return Err(self.mistyped(&path, item, "a table of keys"));
                    };
                    self.read_table(&path, &item.spot, table, section)?;
                }
                Ok(())
            }
            (Kind::Quantities(dimension, range, most), Value::List(nodes)) => {
                self.begin_list(path, node, nodes, *most)?;
                for (index, item) in nodes.iter().enumerate() {
                    let path = join(path, &(index + 1).to_string());
                    let given = self.quantity(&path, item, *dimension, *range)?;
                    self.insert(path, item, given, dimension.si_unit());
                }
                Ok(())
            }
            (Kind::Vector(dimension, range), Value::List(pair)) => {
                self.read_vector(path, node, pair, *dimension, *range)
            }
            (Kind::Vectors(dimension, range, most), Value::List(nodes)) => {
                self.begin_list(path, node, nodes, *most)?;
                for (index, item) in nodes.iter().enumerate() {
                    let path = join(path, &(index + 1).to_string());
                    match &item.value {
                        Value::List(pair) => {
                            self.read_vector(&path, item, pair, *dimension, *range)?;
                        }
                        _ => {
                            let given = self.quantity(&path, item, *dimension, *range)?;
                            self.insert(path, item, given, dimension.si_unit());
                        }
                    }
                }
                Ok(())
            }
            (Kind::Texts(_), Value::List(nodes)) => {
                Arc::make_mut(&mut self.tables)
                    .insert(path.to_owned(), (node.spot.clone(), nodes.len()));
                for (index, item) in nodes.iter().enumerate() {
                    let path = join(path, &(index + 1).to_string());
                    match &item.value {
                        Value::Text(text) if !text.is_empty() => {
                            self.insert(path, item, LeafValue::Text(text.clone()), "");
                        }
                        _ => return Err(self.mistyped(&path, item, "text in quotes")),
                    }
                }
                Ok(())
            }
            (Kind::Numbers(range, most), Value::List(nodes)) => {
                self.begin_list(path, node, nodes, *most)?;
                for (index, item) in nodes.iter().enumerate() {
                    let path = join(path, &(index + 1).to_string());
                    let given = self.bare_number(&path, item, *range)?;
                    self.insert(path, item, given, "");
                }
                Ok(())
            }
            (Kind::Special(_), _) => {
                self.mark(path, &node.spot);
                Arc::make_mut(&mut self.specials).insert(path.to_owned(), node.clone());
                Ok(())
            }
            _ => self.read_leaf(path, node, kind),
        }
    }

    /// Reads the two components of a vector, along x and along y.
    fn read_vector(
        &mut self,
        path: &str,
        node: &Node,
        pair: &[Node],
        dimension: units::Dimension,
        range: Range,
    ) -> Result<(), InputError> {
        if pair.len() != 2 {
            let expected = "two values, along x and along y";
            return Err(self.sources.error(&node.spot, path, expected, pair.len().to_string()));
        }
        self.begin_list(path, node, pair, 2)?;
        for (index, item) in pair.iter().enumerate() {
            let path = join(path, &(index + 1).to_string());
            let given = self.quantity(&path, item, dimension, range)?;
            self.insert(path, item, given, dimension.si_unit());
        }
        Ok(())
    }

    /// Keeps the length of a list, which has no more items than its key takes.
    fn begin_list(
        &mut self,
        path: &str,
        node: &Node,
        nodes: &[Node],
        most: usize,
    ) -> Result<(), InputError> {
        if let Some(one_too_many) = nodes.get(most) {
            let path = join(path, &(most + 1).to_string());
            let (expected, found) = (format!("at most {most}"), nodes.len().to_string());
            return Err(self.sources.error(&one_too_many.spot, &path, expected, found));
        }
        Arc::make_mut(&mut self.tables).insert(path.to_owned(), (node.spot.clone(), nodes.len()));
        Ok(())
    }

    fn read_leaf(&mut self, path: &str, node: &Node, kind: &Kind) -> Result<(), InputError> {
        let mut unit = "";
        let given = match (kind, &node.value) {
            (Kind::Text(_) | Kind::NameOrIndex | Kind::Texts(_), Value::Text(text))
                if !text.is_empty() =>
            {
                LeafValue::Text(text.clone())
            }
            (Kind::Whole(least, most), Value::Number(value, _))
                if *value >= *least as f64 && *value <= *most as f64 && value.fract() == 0.0 =>
            {
                LeafValue::Number(*value)
            }
            (Kind::NameOrIndex, Value::Number(value, _))
                if *value >= 1.0 && *value <= f64::from(u32::MAX) && value.fract() == 0.0 =>
            {
                LeafValue::Number(*value)
            }
            (Kind::Word(words), Value::Text(text)) => {
                let Some(word) = words.iter().find(|word| *word == text) else {
                    let mut error = self.mistyped(path, node, kind.expected());
                    error.nearest = similar(text, words.iter().copied());
                    return Err(error);
                };
                LeafValue::Word(word)
            }
            (Kind::UnitOf(dimension), Value::Text(text)) => {
                let unit = units::parse_unit(after_count(text), *dimension);
                // Records know more spellings (%g, mGal, m.s-2): as it is written they read it.
                let of_records =
                    Units::parse(text).filter(|u| u.quantity() == Quantity::Acceleration);
                let si = || units::parse_unit(dimension.si_unit(), *dimension).ok();
                let unit = unit.or_else(|error| of_records.and_then(|_| si()).ok_or(error));
                LeafValue::Unit(unit.map_err(|error| self.bad_unit(path, node, error))?)
            }
            (Kind::QuantityOrRatio(_, range), Value::Number(value, _)) => {
                self.number_in_range(path, node, *value, *range)?
            }
            (Kind::Number(range) | Kind::NumberOr(range, _), _) if node.ratio().is_some() => {
                self.number_in_range(path, node, node.ratio().unwrap_or(f64::NAN), *range)?
            }
            (Kind::Sections(..), Value::Table(_)) => {
                let expected = format!("[[{path}]] in two brackets, one for each");
                return Err(self.sources.error(&node.spot, path, expected, format!("[{path}]")));
            }
            (Kind::Section(_), Value::List(items))
                if items.iter().all(|item| matches!(item.value, Value::Table(_))) =>
            {
                let expected = format!("[{path}] in single brackets: there is one");
                return Err(self.sources.error(&node.spot, path, expected, format!("[[{path}]]")));
            }
            (Kind::QuantityOr(dimension, range, _), Value::Text(_) | Value::Si(..))
            | (
                Kind::Quantity(dimension, range)
                | Kind::QuantityOrRatio(dimension, range)
                | Kind::Vector(dimension, range),
                _,
            ) => {
                unit = dimension.si_unit();
                self.quantity(path, node, *dimension, *range)?
            }
            _ => return Err(self.mistyped(path, node, kind.expected())),
        };
        self.insert(path.to_owned(), node, given, unit);
        Ok(())
    }

    fn insert(&mut self, path: String, node: &Node, given: LeafValue, unit: &'static str) {
        let written = match &node.value {
            Value::Text(text) => text.clone(),
            Value::Number(_, written) | Value::Si(_, written) => written.clone(),
            _ => String::new(),
        };
        Arc::make_mut(&mut self.leaf_of_path).insert(path.clone(), self.leaves.len());
        Arc::make_mut(&mut self.leaves).push(Leaf {
            path,
            given,
            written,
            unit,
            spot: node.spot.clone(),
        });
    }

    /// A number with its unit, in SI.
    pub fn quantity(
        &self,
        path: &str,
        node: &Node,
        dimension: units::Dimension,
        range: Range,
    ) -> Result<LeafValue, InputError> {
        let value = match &node.value {
            Value::Text(text) => units::parse_quantity(text, dimension)
                .map_err(|error| self.bad_unit(path, node, error))?,
            Value::Si(value, _) => *value,
            _ => {
                return Err(self.mistyped(path, node, Kind::Quantity(dimension, range).expected()));
            }
        };
        if range.contains(value) {
            return Ok(LeafValue::Number(value));
        }
        Err(self.mistyped(path, node, range.refusal(dimension.name(), value)))
    }

    /// A number without a unit, perhaps in percent.
    pub fn bare_number(
        &self,
        path: &str,
        node: &Node,
        range: Range,
    ) -> Result<LeafValue, InputError> {
        match node.ratio() {
            Some(value) => self.number_in_range(path, node, value, range),
            None => Err(self.mistyped(path, node, range.expected("number"))),
        }
    }

    fn number_in_range(
        &self,
        path: &str,
        node: &Node,
        value: f64,
        range: Range,
    ) -> Result<LeafValue, InputError> {
        if range.contains(value) {
            return Ok(LeafValue::Number(value));
        }
        Err(self.mistyped(path, node, range.refusal("number", value)))
    }

    /// The error for a value that is not what was expected.
    pub fn mistyped(&self, path: &str, node: &Node, expected: impl Into<String>) -> InputError {
        self.sources.error(&node.spot, path, expected, node.found())
    }

    fn bad_unit(&self, path: &str, node: &Node, error: UnitError) -> InputError {
        let UnitError { expected, found, nearest } = error;
        InputError { nearest, ..self.sources.error(&node.spot, path, expected, found) }
    }

    fn unknown_key(&self, path: &str, entry: &Entry, section: &'static Section) -> InputError {
        let path = join(path, &cut(&entry.name));
        let found = format!("\"{}\"", cut(&entry.name));
        if let Some(expected) = several(&entry.name, section) {
            return self.sources.error(&entry.key, &path, expected, found);
        }
        let expected = format!("one of the keys {}", section.names().join(", "));
        let error = self.sources.error(&entry.key, &path, expected, found);
        let nearest = nearest_key(&entry.name, section, self.root.0).map(|nearest| match nearest {
            NearestKey::Here(name) => name.to_owned(),
            NearestKey::Elsewhere(path) => path,
        });
        InputError { nearest, ..error }
    }

    fn check_exclusive(
        &self,
        path: &str,
        spot: &SourceSpan,
        table: &TomlTable,
        section: &'static Section,
    ) -> Result<(), InputError> {
        for exclusive in section.choices {
            let mut given: Vec<_> =
                exclusive.names.iter().filter_map(|name| matching(table, name)).collect();
            // The one that stands later is the one too many.
            let place = |entry: &Entry| (entry.key.source, entry.key.span.start);
            sort(&mut given, |a, b| place(a).cmp(&place(b)));
            let plain: Vec<_> =
                exclusive.names.iter().map(|name| name.trim_end_matches(".*")).collect();
            match given.as_slice() {
                [first, second, ..] => {
                    let expected = format!("only one of {}", plain.join(", "));
                    let found = format!("\"{}\" besides \"{}\"", second.name, first.name);
                    let path = join(path, &second.name);
                    return Err(self.sources.error(&second.key, &path, expected, found));
                }
                [] if exclusive.required => {
                    let expected = format!("one of the keys {}", plain.join(", "));
                    return Err(self.sources.error(spot, path, expected, "none"));
                }
                _ => {}
            }
        }
        Ok(())
    }

    fn check_beside(
        &self,
        path: &str,
        entry: &Entry,
        key: &Key,
        table: &TomlTable,
        section: &'static Section,
    ) -> Result<(), InputError> {
        let Some(other) = key.beside.filter(|other| table.get(other).is_none()) else {
            return Ok(());
        };
        // What stands in its place, if that key is one of several to choose from.
        let choices = section.choices.iter().filter(|choice| choice.names.contains(&other));
        let instead = choices.flat_map(|choice| choice.names).find_map(|name| table.get(name));
        let found = match instead {
            Some(instead) => format!("\"{}\" beside \"{}\"", key.name, instead.name),
            None => format!("\"{}\" alone", key.name),
        };
        let expected = format!("this key only beside \"{other}\"");
        Err(self.sources.error(&entry.key, path, expected, found))
    }
}

/// The unit of `4.67e-6 m/s2`, the value of one count, or all of the text.
fn after_count(text: &str) -> &str {
    let (number, unit) = text.trim().split_once(char::is_whitespace).unwrap_or(("", text));
    let is_count = number.parse::<f64>().is_ok_and(|value| value.is_finite() && value > 0.0);
    if is_count { unit } else { text }
}
